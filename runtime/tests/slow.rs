//! The error bounds of the solver where dozens of states are hardly ever left, against policy iteration in
//! fixed point with 400 binary digits.

use num_bigint::BigInt;
use num_rational::BigRational as Fraction;
use num_traits::{FromPrimitive, One, Signed, ToPrimitive, Zero};
use tltl::model;
use tltl::prelude::*;
use tltl::rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

const DIGITS: usize = 400;

/// The probability of a way out: 1e-9, as a power of two.
const SLOW: f64 = 1.0 / (1_u64 << 30) as f64;

const ACTIONS: usize = 2;

/// What is less is rounding: 2^-300.
fn tiny() -> BigInt {
    BigInt::one() << (DIGITS / 4)
}

fn wide(x: f64) -> BigInt {
    (Fraction::from_f64(x).expect("a finite number") * (BigInt::one() << DIGITS)).to_integer()
}

fn times(a: &BigInt, b: &BigInt) -> BigInt {
    (a * b) >> DIGITS
}

fn over(a: &BigInt, b: &BigInt) -> BigInt {
    (a << DIGITS) / b
}

/// Where it can be lost.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Trap {
    None,
    Somewhere,
    Everywhere,
}

/// `live` states, then the goal and the trap; by state and action.
struct World {
    live: usize,
    rows: Vec<[Vec<(usize, f64)>; ACTIONS]>,
}

impl World {
    /// Each way is hardly ever taken; else a state stays, or goes on to the next one, and all of these go
    /// round. It ends at the goal, or also in a trap, to which no way or some or all lead.
    fn new(live: usize, trap: Trap, rng: &mut impl Rng) -> Self {
        let ends = live + if trap == Trap::None { 1 } else { 2 };
        let mut row = |s: usize| {
            let mut row = vec![(if rng.random_bool(0.5) { s } else { (s + 1) % live }, 1.0 - SLOW)];
            let mut left = 16;
            while left > 0 {
                let part = rng.random_range(1..=left);
                let lost = trap == Trap::Everywhere && row.len() == 1;
                row.push((
                    if lost { live + 1 } else { rng.random_range(0..ends) },
                    SLOW * f64::from(part) / 16.0,
                ));
                left -= part;
            }
            row
        };
        let mut rows: Vec<_> = (0..live).map(|s| [row(s), row(s)]).collect();
        rows.extend((live..live + 2).map(|s| [vec![(s, 1.0)], vec![(s, 1.0)]]));
        Self { live, rows }
    }

    /// Σ p x, with `goal` the worth of the goal.
    fn backup(&self, (s, a): (usize, usize), x: &[BigInt], goal: &BigInt) -> BigInt {
        let worth = |to: usize| {
            x.get(to)
                .cloned()
                .unwrap_or_else(|| if to == self.live { goal.clone() } else { BigInt::zero() })
        };
        self.rows[s][a].iter().map(|&(to, p)| times(&wide(p), &worth(to))).sum()
    }

    /// x = costs + Σ p x of a policy, by elimination.
    fn worth(&self, policy: &[usize], costs: &[BigInt], goal: &BigInt) -> Vec<BigInt> {
        let n = self.live;
        let mut rows = vec![vec![BigInt::zero(); n]; n];
        let mut b = costs.to_vec();
        for s in 0..n {
            rows[s][s] += wide(1.0);
            for &(to, p) in &self.rows[s][policy[s]] {
                match rows[s].get_mut(to) {
                    Some(entry) => *entry -= wide(p),
                    None if to == n => b[s] += times(&wide(p), goal),
                    None => {}
                }
            }
        }
        for k in (0..n).rev() {
            let (above, own) = rows.split_at_mut(k);
            for (i, row) in above.iter_mut().enumerate().filter(|(_, row)| !row[k].is_zero()) {
                let part = over(&row[k], &own[0][k]);
                row[..k].iter_mut().zip(&own[0]).for_each(|(x, own)| *x -= times(&part, own));
                b[i] = &b[i] - times(&part, &b[k]);
            }
        }
        let mut x: Vec<BigInt> = Vec::new();
        for (row, b) in rows.iter().zip(b) {
            let later: BigInt = row.iter().zip(&x).map(|(p, x)| times(p, x)).sum();
            x.push(over(&(b - later), &row[x.len()]));
        }
        x
    }

    /// The best of all policies, from a first one on: where `largest`, of what is gained, else of what
    /// is paid.
    fn best(
        &self,
        mut policy: Vec<usize>,
        costs: &[BigInt],
        goal: &BigInt,
        largest: bool,
    ) -> Vec<BigInt> {
        loop {
            let x = self.worth(&policy, costs, goal);
            let mut changed = false;
            for (s, a) in (0..self.live).flat_map(|s| (0..ACTIONS).map(move |a| (s, a))) {
                let gain = &costs[s] + self.backup((s, a), &x, goal) - &x[s];
                if (if largest { gain } else { -gain }) > tiny() {
                    (policy[s], changed) = (a, true);
                }
            }
            if !changed {
                return x;
            }
        }
    }
}

/// Whether `x` is as near as is said, and that is near.
fn near(x: f64, exact: &BigInt, error: f64, what: &str) {
    let off = (wide(x) - exact).abs();
    let exact = Fraction::new(exact.clone(), BigInt::one() << DIGITS).to_f64().expect("a number");
    assert!(error <= 1e-3 * exact, "{what}: error {error:e} of {exact:e}");
    let off = Fraction::new(off, BigInt::one() << DIGITS).to_f64().expect("a number");
    assert!(off <= error, "{what}: {x:e}, off by {off:e}, error {error:e}");
}

#[test]
fn slow_worlds_have_bounds() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let traps = [Trap::None, Trap::Somewhere, Trap::Everywhere];
    for (live, trap) in
        [66, 80, 110, 66].into_iter().flat_map(|live| traps.map(|trap| (live, trap)))
    {
        let world = World::new(live, trap, &mut rng);
        let what = format!("{live} states, trap {trap:?}");
        let model = model::from_fn(live + 2, ACTIONS, |s, a| world.rows[s][a].clone());
        let task = tltl! { |s: &usize| ({ *s } != live + 1) U ({ *s } == live) };
        let task = Labelled::of_model(&model, &task).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let found = problem.best();
        let q = task.start(0);
        let policy: Vec<usize> = (0..live).map(|s| found.policy().act(q, s)).collect();
        let (nothing, one) = (vec![BigInt::zero(); live], wide(1.0));
        let best = world.best(policy.clone(), &nothing, &one, true);
        let largest = problem.largest_satisfied();
        for (s, best) in best.iter().enumerate() {
            near(largest.at(q, s), best, largest.error() + 1e-60, &format!("{what}, P of {s}"));
        }
        let own = world.worth(&policy, &nothing, &one);
        let zero = BigInt::zero();
        let weighted = if trap != Trap::None {
            world.worth(&policy, &own, &zero)
        } else {
            world.best(policy, &own, &zero, false)
        };
        let sum = |all: &[BigInt]| all.iter().sum::<BigInt>();
        let steps = over(&sum(&weighted), &(sum(&own) + one));
        let mean = found.mean_steps().unwrap();
        for (s, own) in own.iter().enumerate() {
            near(
                found.satisfied().at(q, s),
                own,
                found.satisfied().error() + 1e-60,
                &format!("{what}, own P of {s}"),
            );
        }
        let error = found.steps_error() + 4.0 * f64::EPSILON * mean;
        near(mean, &steps, error, &format!("{what}, steps"));
    }
}

//! The error bounds of the solver, against rational arithmetic: all policies of small worlds, enumerated.

use num_rational::BigRational as Fraction;
use num_traits::{FromPrimitive, One, Signed, ToPrimitive, Zero};
use tltl::model;
use tltl::prelude::*;
use tltl::rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::End;
use tltl::solve::Values;

/// The probability of leaving where a world is slow: 1e-9, as a power of two.
const SLOW: f64 = 1.0 / (1_u64 << 30) as f64;

/// By how much two ways differ where they are nearly tied.
const NEARLY: f64 = 1.0 / (1_u64 << 40) as f64;

const ACTIONS: usize = 2;

/// Outcomes by state, then action. All probabilities are multiples of a power of two, so that each row
/// sums to 1 without rounding.
type World = Vec<[Vec<(usize, f64)>; ACTIONS]>;

/// `n` random states, of which the last is the goal and the one before it the trap.
fn random(n: usize, rng: &mut impl Rng) -> World {
    let mut state = |s: usize| {
        [(); ACTIONS].map(|()| {
            if s + 2 >= n {
                return vec![(s, 1.0)];
            }
            let mut left = 16;
            let mut row = Vec::new();
            while left > 0 {
                let part = rng.random_range(1..=left);
                row.push((rng.random_range(0..n), f64::from(part) / 16.0));
                left -= part;
            }
            row
        })
    };
    (0..n).map(&mut state).collect()
}

/// What makes worlds hard.
fn worlds(kind: &str, rng: &mut impl Rng) -> World {
    let n = rng.random_range(4..=7);
    let mut world = random(n, rng);
    let live = n - 2;
    for (s, a) in (0..live).flat_map(|s| [(s, 0), (s, 1)]) {
        let first = world[s][0].clone();
        let row = &mut world[s][a];
        match kind {
            // Each way is hardly ever taken; else a pair stays, or goes round with others.
            "slow" => {
                let to = if rng.random_bool(0.5) { s } else { (s + 1) % live };
                row.iter_mut().for_each(|(_, p)| *p *= SLOW);
                row.push((to, 1.0 - SLOW));
            }
            // The second way is the first one but for a little.
            "tied" if a == 1 => {
                let mut near = first;
                near[0].1 -= NEARLY;
                near.push((rng.random_range(0..n), NEARLY));
                *row = near;
            }
            // One way goes round among the live states for ever.
            "going round" if a == 0 => {
                *row = vec![((s + 1) % live, 0.5), (s, 0.5)];
            }
            // It never goes elsewhere.
            "waiting" if a == 0 => *row = vec![(s, 1.0)],
            "sure" => *row = vec![((s + 1) % n, 1.0)],
            // The trap is hardly ever entered.
            "risky" => {
                row.iter_mut().for_each(|(to, _)| *to = if *to == n - 2 { 0 } else { *to });
                row[0].1 -= NEARLY;
                row.push((n - 2, NEARLY));
            }
            _ => {}
        }
    }
    world
}

const KINDS: [&str; 7] = ["any", "slow", "tied", "going round", "waiting", "sure", "risky"];

fn fraction(x: f64) -> Fraction {
    Fraction::from_f64(x).expect("a finite number")
}

/// x = b + A x by elimination.
fn solved(mut rows: Vec<Vec<Fraction>>) -> Vec<Fraction> {
    let n = rows.len();
    for i in 0..n {
        let pivot = (i..n).find(|&j| !rows[j][i].is_zero()).expect("one solution");
        rows.swap(i, pivot);
        let own = rows[i][i].clone();
        rows[i].iter_mut().for_each(|x| *x = &*x / &own);
        for j in (0..n).filter(|&j| j != i) {
            let factor = rows[j][i].clone();
            if !factor.is_zero() {
                let own = rows[i].clone();
                rows[j].iter_mut().zip(&own).for_each(|(x, own)| *x -= &factor * own);
            }
        }
    }
    rows.into_iter().map(|mut row| row.remove(n)).collect()
}

/// A task over a world, with everything about a policy as fractions.
struct Exact {
    world: World,
    task: Labelled,
}

impl Exact {
    fn pairs(&self) -> Vec<(u32, usize)> {
        let states = 0..self.world.len();
        self.task.live().flat_map(|q| states.clone().map(move |s| (q, s))).collect()
    }

    /// The outcomes of a pair, by pair.
    fn outcomes(&self, (q, s): (u32, usize), a: usize) -> impl Iterator<Item = (u32, usize, f64)> {
        self.world[s][a].iter().map(move |&(to, p)| (self.task.next(q, to), to, p))
    }

    /// P(an end is entered) under a policy, from every live pair.
    fn reaches(&self, end: End, policy: &[usize]) -> Vec<Fraction> {
        let pairs = self.pairs();
        let number = |q, s| pairs.iter().position(|&pair| pair == (q, s));
        // Where it is impossible, by the graph: the rest is one system.
        let mut possible = vec![false; pairs.len()];
        for _ in 0..pairs.len() {
            for (i, &pair) in pairs.iter().enumerate() {
                possible[i] |= self.outcomes(pair, policy[i]).any(|(q, s, p)| {
                    p > 0.0
                        && (self.task.end(q) == Some(end)
                            || number(q, s).is_some_and(|j| possible[j]))
                });
            }
        }
        self.system(&pairs, policy, &possible, &Fraction::one(), |q, _| {
            fraction(f64::from(u8::from(self.task.end(q) == Some(end))))
        })
    }

    /// x = Σ p (pay + γ x), where `open`.
    fn system(
        &self,
        pairs: &[(u32, usize)],
        policy: &[usize],
        open: &[bool],
        gamma: &Fraction,
        pay: impl Fn(u32, usize) -> Fraction,
    ) -> Vec<Fraction> {
        let number = |q, s| pairs.iter().position(|&pair| pair == (q, s));
        let mut rows = Vec::new();
        for (i, &pair) in pairs.iter().enumerate() {
            let mut row = vec![Fraction::zero(); pairs.len() + 1];
            row[i] += Fraction::one();
            if open[i] {
                for (q, s, p) in self.outcomes(pair, policy[i]) {
                    let p = fraction(p);
                    row[pairs.len()] += &p * pay(q, i);
                    if let Some(j) = number(q, s) {
                        row[j] -= &p * gamma;
                    }
                }
            }
            rows.push(row);
        }
        solved(rows)
    }

    /// E[steps · 1(success)] of a policy.
    fn weighted(&self, policy: &[usize], satisfied: &[Fraction]) -> Vec<Fraction> {
        let open: Vec<bool> = satisfied.iter().map(|p| !p.is_zero()).collect();
        let pay = |_, i: usize| satisfied[i].clone();
        self.system(&self.pairs(), policy, &open, &Fraction::one(), pay)
    }

    /// All policies of the live pairs.
    fn policies(&self) -> impl Iterator<Item = Vec<usize>> {
        let n = self.pairs().len();
        (0..ACTIONS.pow(n as u32)).map(move |code| (0..n).map(|i| code >> i & 1).collect())
    }
}

/// Where a world is not slow, the bound is of use.
fn near(x: f64, exact: &Fraction, error: f64, what: &str) {
    if error == f64::INFINITY {
        return assert!(what.contains("slow"), "{what}: no bound");
    }
    let off = (fraction(x) - exact).abs();
    // The numbers themselves are rounded.
    assert!(
        off <= fraction(error + 1e-300),
        "{what}: {x}, off by {:e}, error {error:e}",
        off.to_f64().unwrap_or(f64::NAN)
    );
    assert!(what.contains("slow") || error <= 1e-9 * x.max(1.0), "{what}: error {error:e} of {x}");
}

#[test]
fn bounds_hold() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(12);
    for (round, kind) in KINDS.iter().cycle().take(56).enumerate() {
        let world = worlds(kind, &mut rng);
        let n = world.len();
        let model = model::from_fn(n, ACTIONS, |s, a| world[s][a].clone());
        let task = tltl! { |s: &usize| ({ *s } != n - 2) U ({ *s } == n - 1) };
        let task = Labelled::of_model(&model, &task).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let exact = Exact { world, task: task.clone() };
        let pairs = exact.pairs();
        let all: Vec<_> = exact.policies().collect();
        let best = |values: &dyn Fn(&[usize]) -> Vec<Fraction>, larger: bool| {
            let mut best: Option<Vec<Fraction>> = None;
            for policy in &all {
                let own = values(policy);
                let better = |(a, b): (Fraction, Fraction)| if (a > b) == larger { a } else { b };
                best = Some(match best {
                    None => own,
                    Some(best) => best.into_iter().zip(own).map(better).collect(),
                });
            }
            best.unwrap()
        };
        let what = format!("world {round}, {kind}");
        let compare = |values: &Values, exact: &[Fraction], name: &str| {
            for (&(q, s), exact) in pairs.iter().zip(exact) {
                near(values.at(q, s), exact, values.error(), &format!("{what}, {name} at {s}"));
            }
        };
        let largest = problem.largest_satisfied();
        let reaches = |policy: &[usize]| exact.reaches(End::Accepted, policy);
        compare(&largest, &best(&reaches, true), "largest P");
        let least = problem.smallest_lost();
        compare(&least, &best(&|policy| exact.reaches(End::Lost, policy), false), "least lost");

        // Policies, among them the best one.
        let found = problem.best();
        let mut some: Vec<Vec<usize>> =
            (0..8).map(|_| all[rng.random_range(0..all.len())].clone()).collect();
        some.push(pairs.iter().map(|&(q, s)| found.policy().act(q, s)).collect());
        for actions in some {
            let place = |q, s| pairs.iter().position(|&pair| pair == (q, s));
            let policy =
                Policy::from_fn(&task, |q, s| place(q, s).map_or(0, |i| actions[i])).unwrap();
            let own = problem.evaluate(&policy).unwrap();
            let satisfied = exact.reaches(End::Accepted, &actions);
            compare(own.satisfied(), &satisfied, "P");
            compare(&problem.lost(&policy).unwrap(), &exact.reaches(End::Lost, &actions), "lost");
            let weighted = exact.weighted(&actions, &satisfied);
            let (mut p, mut w) = (Fraction::zero(), Fraction::zero());
            for (i, &(q, s)) in pairs.iter().enumerate() {
                if task.start(s) == q {
                    (p, w) = (p + &satisfied[i], w + &weighted[i]);
                }
            }
            // The goal is a start too.
            p += Fraction::one();
            let error = own.steps_error() + 4.0 * f64::EPSILON * own.mean_steps().unwrap();
            near(own.mean_steps().unwrap(), &(w / p), error, &format!("{what}, steps"));
        }
    }
}

//! First values of a component, and the order in which to sweep it.
//!
//! Pairs are settled as by Dijkstra (1959), the best first: at each settled pair the estimates of
//! those that lead to it are renewed from what is known by then, and what is not known yet is
//! extrapolated. The values are only a start; the order follows the flow of the optimal policy,
//! which the distance from the exits does not where a far exit is worth more than a near one.
//!
//! Sweeps in this order still correct relative errors only some seven steps further from the exits
//! than the last sweep did, for each pair also leans on those behind it, which are wrong in the same
//! way. Over-relaxation by 1 / (1 − γ(1 − m)), where m is the probability that the chosen action
//! leads to pairs settled before, makes the weight of what is known 1, so that one sweep carries
//! corrections over the whole world. That is what settling is for: its order alone saves a tenth of the
//! sweeps ([figures](mod@super::block)).
//!
//! What this is not: a solver. Nothing here bounds an error, and on worlds where the guesses are poor
//! (many unlikely outcomes that lead far away) the sweeps that follow have more to do. Cost: each pair
//! is settled once, and renewed once for each successor: one look at all its actions, and a heap
//! operation where that improves it.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Ordering;

use super::block::Block;
use super::rule::Rule;

/// What is known about the successors of a state while pairs are settled.
///
/// NaN and not a flag: the arrivals of one state are gathered into one slice anyway, and a sum that
/// met an unknown by mistake would show it.
pub(super) struct Lookahead<'a> {
    pub(super) matrix: &'a [f64],
    /// What arriving is worth; NaN: not known yet.
    pub(super) arrivals: &'a [f64],
    /// The column of the state itself.
    pub(super) own: usize,
}

/// An action as far as its outcomes are known.
///
/// The sums that all guesses need, so that each action is looked through once.
#[derive(Clone, Copy, Default)]
struct Blend {
    /// Σ p · arrival over the known ones.
    sum: f64,
    /// The probability of the known ones.
    known: f64,
    /// The probability of staying, if that is not known.
    own: f64,
    /// The arrival of the most probable known one, and that probability.
    main: f64,
    most: f64,
}

impl Lookahead<'_> {
    #[inline]
    fn blend(&self, action: usize) -> Blend {
        let n = self.arrivals.len();
        let row = &self.matrix[action * n..][..n];
        let mut blend = Blend::default();
        for (i, (&p, &arrival)) in row.iter().zip(self.arrivals).enumerate() {
            if !arrival.is_nan() {
                blend.sum += p * arrival;
                blend.known += p;
                if p > blend.most {
                    (blend.main, blend.most) = (arrival, p);
                }
            } else if i == self.own {
                blend.own = p;
            }
        }
        blend
    }

    #[inline]
    fn actions(&self) -> usize {
        self.matrix.len() / self.arrivals.len()
    }

    /// Discounted value of an action: what is not known is worth as much as the state itself.
    ///
    /// With the probability m of what is known and Σ p · arrival over it, v = Σ + γ (1 − m) v, so
    /// v = Σ / (1 − γ (1 − m)). The same factor is how far to over-relax.
    #[inline]
    pub(super) fn discounted(&self, action: usize, gamma: f64) -> Guess {
        let blend = self.blend(action);
        if blend.known <= 0.0 {
            return Guess::NONE;
        }
        let over = 1.0 / (1.0 - gamma * (1.0 - blend.known));
        Guess { value: over * blend.sum, over }
    }

    /// The largest discounted value of the actions.
    ///
    /// Comparisons with NaN are false, and [`Guess::or`] then keeps the one that is known.
    #[inline]
    pub(super) fn best(&self, gamma: f64) -> Guess {
        let all = (0..self.actions()).map(|a| self.discounted(a, gamma));
        all.fold(Guess::NONE, |best, e| if e.value <= best.value { best } else { e.or(best) })
    }

    /// Undiscounted cost of an action that pays `cost` now: what is not known costs as much more
    /// than the state itself as the state costs more than its main known successor.
    #[inline]
    pub(super) fn cost(&self, action: usize, cost: f64) -> Guess {
        let blend = self.blend(action);
        let unknown = 1.0 - blend.known - blend.own;
        let scale = 1.0 - blend.own - 2.0 * unknown;
        let over = 1.0 / blend.known;
        if blend.known <= 0.0 {
            Guess::NONE
        // Near 0 the extrapolation would blow a small error up; then what is not known costs as much
        // as the state itself.
        } else if scale > 0.25 {
            Guess { value: (cost + blend.sum - unknown * blend.main) / scale, over }
        } else {
            Guess { value: (cost + blend.sum) / blend.known, over }
        }
    }

    /// The least cost of the actions that are `allowed`.
    pub(super) fn least(&self, cost: f64, allowed: impl Fn(usize) -> bool) -> Guess {
        let all = (0..self.actions()).filter(|&a| allowed(a)).map(|a| self.cost(a, cost));
        all.fold(Guess::NONE, |best, e| if e.value >= best.value { best } else { e.or(best) })
    }
}

/// A first value of a pair.
#[derive(Clone, Copy)]
pub(super) struct Guess {
    /// NaN: nothing is known.
    pub(super) value: f64,
    /// How far to over-relax.
    pub(super) over: f64,
}

impl Guess {
    pub(super) const NONE: Self = Self { value: f64::NAN, over: 1.0 };

    /// This one, if it is one.
    #[inline]
    fn or(self, other: Self) -> Self {
        if self.value.is_nan() { other } else { self }
    }
}

/// The largest over-relaxation: a guard, for where little is known the factor above is large, and theory
/// allows less than 2 even of symmetric systems. On grids with slip 0.2 a bound of 1.9 changes nothing.
const MOST: f64 = 1.5;

/// Pairs as they were settled.
pub(super) struct Settled {
    pub(super) pairs: Vec<(u32, u32)>,
    /// How far to over-relax each of them.
    pub(super) over: Vec<f32>,
}

/// A pair that waits, the least key first.
///
/// A pair may wait more than once, each time with a better key; the first that comes out settles it,
/// and the others find it settled. That is cheaper than a heap that can change a key.
struct Waiting {
    key: f64,
    pair: (u32, u32),
    over: f32,
}

impl Ord for Waiting {
    #[inline]
    fn cmp(&self, other: &Self) -> Ordering {
        other.key.total_cmp(&self.key).then(other.pair.cmp(&self.pair))
    }
}

impl PartialOrd for Waiting {
    #[inline]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Waiting {}

/// How far a pair is.
///
/// `Outside` pairs cannot reach an exit, or are not asked for; `Open` ones wait for a value or have a
/// first one; `Settled` ones keep theirs.
#[derive(Clone, Copy, PartialEq)]
enum Stage {
    Outside,
    Open,
    Settled,
}

/// The search.
///
/// `arrivals` is NaN where a pair of the component is not settled yet, and the worth of leaving where
/// a move leaves it.
struct Front<'a> {
    block: &'a Block<'a>,
    rule: &'a Rule<'a>,
    stage: Vec<Stage>,
    arrivals: Vec<f64>,
    waiting: BinaryHeap<Waiting>,
    gathered: Vec<f64>,
}

impl Front<'_> {
    /// Renews the estimate of an open pair.
    #[inline]
    fn relax(&mut self, (k, s): (u32, u32), values: &mut [f64]) {
        let block = self.block;
        let dynamics = &block.problem.dynamics;
        let layer = &self.arrivals[k as usize * block.width()..];
        let successors = dynamics.successors(s as usize);
        self.gathered.clear();
        self.gathered.extend(successors.iter().map(|&to| layer[to as usize]));
        let own = successors.binary_search(&s).unwrap_or(usize::MAX);
        let known =
            Lookahead { matrix: dynamics.matrix(s as usize), arrivals: &self.gathered, own };
        let pair = block.pair(k, s);
        let Guess { value, over } = self.rule.guess(pair, &known, block.discount);
        let key = self.rule.key(pair, value);
        let better = values[pair].is_nan() || key < self.rule.key(pair, values[pair]);
        if !value.is_nan() && better {
            values[pair] = value;
            let over = over.min(MOST) as f32;
            self.waiting.push(Waiting { key, pair: (k, s), over });
        }
    }

    /// Makes the value of a pair known to all that lead to it.
    #[inline]
    fn settle(&mut self, (k, s): (u32, u32), values: &mut [f64]) {
        let block = self.block;
        let (first, list) = &*block.problem.predecessors;
        let from = first[s as usize] as usize..first[s as usize + 1] as usize;
        block.arrive(
            block.members[k as usize],
            s as usize,
            values[block.pair(k, s)],
            |at, value| {
                self.arrivals[at] = value;
            },
        );
        for (j, &member) in block.members.iter().enumerate() {
            if block.next(member, s as usize) == block.members[k as usize] {
                for &before in &list[from.clone()] {
                    if self.stage[j * block.states() + before as usize] == Stage::Open {
                        self.relax((j as u32, before), values);
                    }
                }
            }
        }
    }
}

/// Settles the pairs of `block` that can reach an exit: sets their values, and returns them in the
/// order in which they were settled.
///
/// Pairs of which nothing ever becomes known (all their ways lead through pairs that no rule
/// settles) come last, with the value of the last settled one: a start that is not absurd.
#[inline]
pub(super) fn settle(block: &Block<'_>, values: &mut [f64], rule: &Rule<'_>) -> Settled {
    let pairs = block.reached_pairs();
    let mut stage = alloc::vec![Stage::Outside; block.members.len() * block.states()];
    for &(k, s) in pairs {
        stage[k as usize * block.states() + s as usize] = Stage::Open;
        values[block.pair(k, s)] = f64::NAN;
    }
    let (arrivals, waiting) = (block.arrivals(values), BinaryHeap::new());
    let gathered = Vec::new();
    let mut front = Front { block, rule, stage, arrivals, waiting, gathered };
    block.seeds().iter().for_each(|&pair| front.relax(pair, values));
    let (n, over) = (pairs.len(), Vec::with_capacity(pairs.len()));
    let mut settled = Settled { pairs: Vec::with_capacity(n), over };
    let mut last = 0.0;
    while let Some(Waiting { pair, over, .. }) = front.waiting.pop() {
        let at = pair.0 as usize * block.states() + pair.1 as usize;
        if front.stage[at] == Stage::Open {
            front.stage[at] = Stage::Settled;
            last = values[block.pair(pair.0, pair.1)];
            settled.pairs.push(pair);
            settled.over.push(over);
            front.settle(pair, values);
        }
    }
    for &(k, s) in pairs {
        if front.stage[k as usize * block.states() + s as usize] == Stage::Open {
            values[block.pair(k, s)] = last;
            settled.pairs.push((k, s));
            settled.over.push(1.0);
        }
    }
    settled
}

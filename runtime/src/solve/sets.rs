//! What the graph of a component decides, whatever the probabilities are.
//!
//! From which pairs success is impossible, and from which it is sure, are facts about edges
//! (Baier and Katoen 2008, 10.6.1). They are found first, by searches, and are exact; numbers are computed
//! for the pairs between alone. There every policy of the *smallest* probability and every single policy
//! leaves in the end. Under the *largest* one may also stay for ever in an end component, whose pairs
//! are worth the same: one [plateau](plateaus).
//!
//! All searches are linear in the edges, but for the rounds of [`sure`] and [`plateaus`], which are as
//! many as sets are nested: one or two, as a rule.

use alloc::vec::Vec;

use super::component::{Component, NONE};
use super::rule::Choice;
use super::{Actions, Objective, Rule};

/// The pairs of a component, by what the graph says of the probability to leave well.
pub(super) struct Sets {
    /// Surely.
    pub(super) one: Vec<u32>,
    /// Possibly and not surely, the pairs nearest to an exit first.
    pub(super) between: Vec<u32>,
}

/// The sets of a component whose exits are worth probabilities. (What is in neither set is impossible.)
#[inline]
pub(super) fn sets(component: &Component<'_>, rule: &Rule<'_>) -> Sets {
    let uses = |code, at| leads(component, rule, code, at);
    match rule.objective {
        Objective::Largest => {
            let possible = reach(component, |worth| worth > 0.0, &[], uses);
            let one = sure(component, rule, &possible);
            let sure = marks(component, &one);
            let between = possible.into_iter().filter(|&code| !sure[code as usize]).collect();
            Sets { one, between }
        }
        Objective::Smallest => {
            let all: Vec<u32> = (0..component.codes() as u32).collect();
            let keeps = |_, target: u32, worth: f64| target != NONE || worth == 0.0;
            let zero = Alive::new(component, rule, &all, keeps).codes();
            let doubtful = reach(component, |worth| worth < 1.0, &zero, uses);
            let doubtful = marks(component, &doubtful);
            let never = marks(component, &zero);
            let one = all.into_iter().filter(|&c| !doubtful[c as usize] && !never[c as usize]);
            let between = reach(component, |worth| worth > 0.0, &[], uses).into_iter();
            let between = between.filter(|&c| doubtful[c as usize] && !never[c as usize]).collect();
            Sets { one: one.collect(), between }
        }
    }
}

/// All pairs: those nearest to an exit first, those that are worth something before others.
#[inline]
pub(super) fn outwards(component: &Component<'_>, rule: &Rule<'_>) -> Vec<u32> {
    let uses = |code, at| leads(component, rule, code, at);
    let mut all = reach(component, |worth| worth > 0.0, &[], uses);
    if all.len() < component.codes() {
        let others = reach(component, |_| true, &[], uses).into_iter();
        for codes in [others.collect(), (0..component.codes() as u32).collect::<Vec<_>>()] {
            let seen = marks(component, &all);
            all.extend(codes.into_iter().filter(|&code| !seen[code as usize]));
        }
    }
    all
}

/// The pairs from which an allowed action sequence leads out to where `seeds` is true, or to `goals`, the
/// nearest first, `goals` excepted.
#[inline]
pub(super) fn reach(
    component: &Component<'_>,
    seeds: impl Fn(f64) -> bool,
    goals: &[u32],
    uses: impl Fn(u32, u32) -> bool,
) -> Vec<u32> {
    let mut seen = marks(component, goals);
    let mut found = goals.to_vec();
    let mut arrive = |found: &mut Vec<u32>, arrival| {
        for (code, at) in component.before(arrival) {
            if !seen[code as usize] && uses(code, at) {
                seen[code as usize] = true;
                found.push(code);
            }
        }
    };
    for (arrival, worth) in component.exits() {
        if seeds(worth) {
            arrive(&mut found, arrival);
        }
    }
    let mut at = 0;
    while let Some(&code) = found.get(at) {
        component.entries(code).for_each(|arrival| arrive(&mut found, arrival));
        at += 1;
    }
    found.drain(..goals.len());
    found
}

/// Whether an allowed action of a pair may lead to a place in the world.
#[inline]
fn leads(component: &Component<'_>, rule: &Rule<'_>, code: u32, at: u32) -> bool {
    let outcomes = component.outcomes(code);
    match rule.choice {
        Choice::All => true,
        Choice::Policy(policy) => outcomes.leads(policy[component.pair(code)] as usize, at),
        Choice::Of(_) => component.allowed(rule, code).any(|a| outcomes.leads(a, at)),
    }
}

/// The pairs from which some policy leaves well almost surely.
///
/// The largest set in which it can stay with actions that leave it by sure exits alone, and from all
/// pairs of which such an exit can be reached.
#[inline]
fn sure(component: &Component<'_>, rule: &Rule<'_>, possible: &[u32]) -> Vec<u32> {
    let all = possible.len() == component.codes();
    if all && component.exits().all(|(_, worth)| worth == 1.0) {
        return possible.to_vec();
    }
    let inside = marks(component, possible);
    let keeps = |_, target: u32, worth: f64| {
        inside.get(target as usize).map_or(worth == 1.0, |inside| *inside)
    };
    let mut alive = Alive::new(component, rule, possible, keeps);
    loop {
        let left = alive.codes();
        let uses = |code, at| alive.leads(code, at);
        let seen = marks(component, &reach(component, |worth| worth == 1.0, &[], uses));
        let lost: Vec<u32> = left.iter().copied().filter(|&code| !seen[code as usize]).collect();
        if lost.is_empty() {
            return left;
        }
        alive.remove(lost);
    }
}

/// The maximal end components of the unknowns, with the actions whose outcomes all satisfy `level` of
/// where they start: sets within which a policy can go from each to each and stay for ever.
#[inline]
pub(super) fn plateaus(
    component: &Component<'_>,
    rule: &Rule<'_>,
    level: impl Fn(u32, u32) -> bool,
) -> Vec<Vec<u32>> {
    let keeps = |from: u32, target: u32, _| target != NONE && level(from, target);
    let mut alive = Alive::new(component, rule, component.unknowns(), keeps);
    loop {
        let components = alive.strong();
        if !alive.separate(&components) {
            let mut groups: Vec<Vec<u32>> = Vec::new();
            for code in alive.codes() {
                let number = components[component.number(code) as usize] as usize;
                groups.resize_with(groups.len().max(number + 1), Vec::new);
                groups[number].push(component.number(code));
            }
            groups.retain(|group| !group.is_empty());
            return groups;
        }
    }
}

/// Which codes are among `codes`.
#[inline]
fn marks(component: &Component<'_>, codes: &[u32]) -> Vec<bool> {
    let mut marks = alloc::vec![false; component.codes()];
    codes.iter().for_each(|&code| marks[code as usize] = true);
    marks
}

/// Pairs with the actions that stay among them. A pair that has none left is gone, and with it the
/// actions that may lead to it.
struct Alive<'a> {
    component: &'a Component<'a>,
    /// By code.
    actions: Actions,
    /// How many actions each pair has.
    left: Vec<u32>,
}

impl<'a> Alive<'a> {
    /// `codes` with their allowed actions of which `keeps` is true of every outcome.
    #[inline]
    fn new(
        component: &'a Component<'a>,
        rule: &Rule<'_>,
        codes: &[u32],
        keeps: impl Fn(u32, u32, f64) -> bool,
    ) -> Self {
        let actions = Actions::none(component.codes(), component.actions());
        let mut alive = Self { component, actions, left: alloc::vec![0; component.codes()] };
        let mut gone = Vec::new();
        for &code in codes {
            let outcomes = component.outcomes(code);
            for a in component.allowed(rule, code) {
                if outcomes
                    .of(a)
                    .all(|(_, target, worth)| keeps(component.number(code), target, worth))
                {
                    alive.actions.insert(code as usize, a);
                    alive.left[code as usize] += 1;
                }
            }
            if alive.left[code as usize] == 0 {
                gone.push(code);
            }
        }
        alive.remove(gone);
        alive
    }

    /// The pairs that are left.
    #[inline]
    fn codes(&self) -> Vec<u32> {
        (0..self.left.len() as u32).filter(|&code| self.left[code as usize] > 0).collect()
    }

    #[inline]
    fn of(&self, code: u32) -> impl Iterator<Item = usize> {
        (0..self.component.actions()).filter(move |&a| self.actions.contains(code as usize, a))
    }

    /// Whether an action that is left may lead to a place in the world.
    #[inline]
    fn leads(&self, code: u32, at: u32) -> bool {
        let outcomes = self.component.outcomes(code);
        self.of(code).any(|a| outcomes.leads(a, at))
    }

    /// Removes pairs, and all that then have no action left.
    #[inline]
    fn remove(&mut self, mut gone: Vec<u32>) {
        gone.iter().for_each(|&code| self.clear(code));
        while let Some(code) = gone.pop() {
            for arrival in self.component.entries(code) {
                for (from, at) in self.component.before(arrival) {
                    if self.left[from as usize] > 0 {
                        let outcomes = self.component.outcomes(from);
                        for a in 0..self.component.actions() {
                            if outcomes.leads(a, at) && self.actions.remove(from as usize, a) {
                                self.left[from as usize] -= 1;
                            }
                        }
                        if self.left[from as usize] == 0 {
                            gone.push(from);
                        }
                    }
                }
            }
        }
    }

    #[inline]
    fn clear(&mut self, code: u32) {
        (0..self.component.actions()).for_each(|a| {
            self.actions.remove(code as usize, a);
        });
        self.left[code as usize] = 0;
    }

    /// Takes away the actions that may lead from one of these components to another; whether there was
    /// one.
    #[inline]
    fn separate(&mut self, components: &[u32]) -> bool {
        let (mut gone, mut found) = (Vec::new(), false);
        for code in self.codes() {
            let outcomes = self.component.outcomes(code);
            let own = components[self.component.number(code) as usize];
            for a in 0..self.component.actions() {
                let leaves = |(_, target, _): (f64, u32, f64)| components[target as usize] != own;
                if self.actions.contains(code as usize, a) && outcomes.of(a).any(leaves) {
                    self.actions.remove(code as usize, a);
                    self.left[code as usize] -= 1;
                    found = true;
                }
            }
            if self.left[code as usize] == 0 {
                gone.push(code);
            }
        }
        self.remove(gone);
        found
    }

    /// The strongly connected component of each pair, by its number (Tarjan 1972, without recursion); of
    /// pairs that are gone [`NONE`].
    #[inline]
    fn strong(&self) -> Vec<u32> {
        let codes = self.left.len();
        let (mut index, mut low) = (alloc::vec![NONE; codes], alloc::vec![NONE; codes]);
        let (mut component, mut stack) = (alloc::vec![NONE; codes], Vec::new());
        let (mut entered, mut components) = (0, 0);
        for root in self.codes() {
            let root = self.component.number(root);
            if index[root as usize] != NONE {
                continue;
            }
            let mut path: Vec<(u32, Vec<u32>)> = Vec::new();
            let mut enter = Some(root);
            loop {
                if let Some(number) = enter.take() {
                    (index[number as usize], low[number as usize]) = (entered, entered);
                    entered += 1;
                    stack.push(number);
                    let code = self.component.code(number);
                    let outcomes = self.component.outcomes(code);
                    let next = self.of(code).flat_map(|a| outcomes.of(a).map(|(_, to, _)| to));
                    path.push((number, next.collect()));
                }
                let Some((number, next)) = path.last_mut() else { break };
                let number = *number as usize;
                if let Some(to) = next.pop() {
                    if index[to as usize] == NONE {
                        enter = Some(to);
                    } else if component[to as usize] == NONE {
                        low[number] = low[number].min(index[to as usize]);
                    }
                    continue;
                }
                path.pop();
                if let Some(&(parent, _)) = path.last() {
                    low[parent as usize] = low[parent as usize].min(low[number]);
                }
                if low[number] == index[number] {
                    while component[number] == NONE
                        && let Some(member) = stack.pop()
                    {
                        component[member as usize] = components;
                    }
                    components += 1;
                }
            }
        }
        component
    }
}

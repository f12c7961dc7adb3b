//! A trajectory that is being read.

use crate::online::{Online, Recorded};
use crate::report::{Row, Trajectory};
use crate::task::{Running, Verdict};

use super::reading::Reading;

/// A trajectory on its way through a task.
pub(super) struct Followed<'a> {
    /// What it is called among several.
    pub(super) name: String,
    way: Way<'a>,
    online: Online,
    /// What a page shows of it, where one is asked for.
    drawn: Option<Trajectory>,
}

/// How the verdict is found.
enum Way<'a> {
    /// State by state.
    Automaton(Running<'a>),
    /// By the formula, over truth values as ±1, for a task without an automaton; and the first row
    /// up to which it is known to be satisfied.
    Formula(Recorded, Option<usize>),
}

impl<'a> Followed<'a> {
    pub(super) fn new(name: String, reading: &'a Reading, is_drawn: bool) -> Self {
        let way = match &reading.automaton {
            Some(automaton) => Way::Automaton(Running::new(automaton)),
            None => Way::Formula(reading.truth(), None),
        };
        let drawn = is_drawn.then(|| Trajectory::new(&*name));
        Self { name, way, online: reading.online.clone(), drawn }
    }

    /// Reads one state: which propositions hold, and their robustness. Returns the progress of the
    /// automaton, if there is one.
    pub(super) fn step(&mut self, labels: &[bool], rho: &[f64]) -> Option<f64> {
        self.online.step(rho);
        let progress = match &mut self.way {
            Way::Automaton(running) => Some(running.step(labels, rho)),
            Way::Formula(recorded, _) => {
                let truths: Vec<f64> =
                    labels.iter().map(|&holds| if holds { 1.0 } else { -1.0 }).collect();
                recorded.step(&truths);
                None
            }
        };
        let (state, online) = (self.state(), &self.online);
        if let Some(drawn) = &mut self.drawn {
            let (robustness, greatest) = (online.at_hand(), online.greatest());
            drawn.push(&Row { state, holds: labels, rho, robustness, greatest });
        }
        progress
    }

    /// What a page shows of the trajectory, which has ended; `None` if no page was asked for.
    pub(super) fn drawn(&mut self) -> Option<Trajectory> {
        let (verdict, since) = (self.verdict(), self.since().unwrap_or_default());
        let robustness = Some(self.robustness());
        let mut drawn = self.drawn.take()?;
        drawn.end(verdict, since, robustness);
        Some(drawn)
    }

    /// Finds out whether the formula is satisfied by now. Without an automaton that is a pass over
    /// the trajectory, so it is done where somebody asks.
    pub(super) fn look(&mut self) {
        let Way::Formula(recorded, since @ None) = &mut self.way else { return };
        let satisfied = |rows: &usize| recorded.robustness(*rows) > 0.0;
        let rows = recorded.rows();
        if satisfied(&rows) {
            // What is satisfied stays satisfied, so the first such row is found by halving.
            let (mut open, mut known) = (0, rows);
            while open + 1 < known {
                let middle = usize::midpoint(open, known);
                *(if satisfied(&middle) { &mut known } else { &mut open }) = middle;
            }
            *since = Some(known - 1);
        }
    }

    /// The number of states that were read.
    pub(super) fn rows(&self) -> usize {
        match &self.way {
            Way::Automaton(running) => running.rows(),
            Way::Formula(recorded, _) => recorded.rows(),
        }
    }

    /// The automaton's state; `None` without an automaton.
    pub(super) fn state(&self) -> Option<u32> {
        match &self.way {
            Way::Automaton(running) => Some(running.state()),
            Way::Formula(..) => None,
        }
    }

    /// The verdict so far; `None` where it is not satisfied, and nobody knows whether it is lost.
    pub(super) fn verdict(&self) -> Option<Verdict> {
        match &self.way {
            Way::Automaton(running) => Some(running.verdict()),
            Way::Formula(_, since) => since.map(|_| Verdict::Satisfied),
        }
    }

    /// The first row after which the verdict was what it is now.
    pub(super) fn since(&self) -> Option<usize> {
        match &self.way {
            Way::Automaton(running) => running.since(),
            Way::Formula(_, since) => *since,
        }
    }

    /// The robustness of what was read. Zero has no sign here.
    pub(super) fn robustness(&self) -> f64 {
        self.online.robustness() + 0.0
    }
}

//! One episode, to be read: as text here, as a picture in [`strip`](crate::strip).

use std::fmt::Write as _;

use tltl::Monitor;
use tltl::task::Error;

use crate::action::Action;
use crate::known::Known;
use crate::layout::{Goal, Layout, NONE};
use crate::world::Kitchen;

/// A predicate of the specifications, with its arguments: what may hold in the kitchen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fact {
    /// `see(o)`.
    See(u8),
    /// `hold(o)`.
    Hold(u8),
    /// `open(r)`.
    Open(u8),
    /// `inside(o, r)`.
    Inside(u8, u8),
}

impl Fact {
    /// The four of each goal.
    #[must_use]
    pub fn of(goals: &[Goal]) -> Vec<Self> {
        let mut all = Vec::new();
        for &Goal { object: o, receptacle: r } in goals {
            for predicate in [Self::See(o), Self::Hold(o), Self::Open(r), Self::Inside(o, r)] {
                if !all.contains(&predicate) {
                    all.push(predicate);
                }
            }
        }
        all
    }

    /// Whether it holds.
    ///
    /// # Panics
    /// If an argument is not below [`MAX_IDS`](crate::MAX_IDS).
    #[must_use]
    pub fn holds(self, known: &Known) -> bool {
        match self {
            Self::See(o) => known.sees(o),
            Self::Hold(o) => known.holds(o),
            Self::Open(r) => known.opened(r),
            Self::Inside(o, r) => known.inside(o, r),
        }
    }

    /// What would be known were it false, and the other predicates as they are (but that what is
    /// in hand is not inside anything).
    fn denied(self, mut known: Known) -> Known {
        match self {
            Self::See(o) => known.in_view[o as usize] = false,
            Self::Open(r) => known.is_open[r as usize] = false,
            Self::Inside(o, _) => known.seen_in[o as usize] = NONE,
            Self::Hold(o) if known.hand == o => {
                known.hand = NONE;
                known.in_view[o as usize] = true;
                known.seen_in[o as usize] = NONE;
            }
            Self::Hold(_) => {}
        }
        known
    }

    /// As it is written: `inside(apple, fridge)`.
    #[must_use]
    pub fn name(self, layout: &Layout) -> String {
        let name = |id| layout.name(id);
        match self {
            Self::See(o) => format!("see({})", name(o)),
            Self::Hold(o) => format!("hold({})", name(o)),
            Self::Open(r) => format!("open({})", name(r)),
            Self::Inside(o, r) => format!("inside({}, {})", name(o), name(r)),
        }
    }
}

/// One instant of an episode.
#[derive(Clone, Debug)]
pub struct Moment {
    /// The action that led here; none at the start.
    pub action: Option<Action>,
    /// Whether it failed.
    pub failed: bool,
    /// What the agent knows now.
    pub known: Known,
    /// The state of the automaton, which has read what is known now.
    pub q: u32,
    /// Why it moved: the predicates but for each of which it would have gone elsewhere.
    pub reasons: Vec<Fact>,
}

/// An episode and the specification's predicates.
#[derive(Clone, Debug)]
pub struct Episode {
    /// What there is to be done.
    pub goals: Vec<Goal>,
    /// Its instants, the start first.
    pub moments: Vec<Moment>,
    /// Whether the specification was satisfied.
    pub satisfied: bool,
}

impl Episode {
    /// Runs `act` in `kitchen`, from where it is now, until `monitor` or the kitchen ends it. `act`
    /// is given the automaton state and what is known; `goals` are what to show.
    ///
    /// # Errors
    /// If a predicate is not a number, or the first error of `act`; no step is taken then.
    pub fn record<E: From<Error>>(
        kitchen: &mut Kitchen,
        monitor: &dyn Monitor<Known>,
        goals: &[Goal],
        mut act: impl FnMut(u32, &Known) -> Result<Action, E>,
    ) -> Result<Self, E> {
        let mut q = monitor.next(0, kitchen.known())?;
        let known = *kitchen.known();
        let reasons = reasons_for(monitor, goals, 0, &known)?;
        let start = Moment { action: None, failed: false, known, q, reasons };
        let mut moments = vec![start];
        let mut truncated = false;
        while !monitor.is_terminal(q) && !truncated {
            let action = act(q, kitchen.known())?;
            let step = kitchen.act(action);
            let reasons = reasons_for(monitor, goals, q, &step.state)?;
            q = monitor.next(q, &step.state)?;
            truncated = step.truncated;
            let (action, failed) = (Some(action), kitchen.failed());
            moments.push(Moment { action, failed, known: step.state, q, reasons });
        }
        Ok(Self { goals: goals.to_vec(), moments, satisfied: monitor.is_accepting(q) })
    }

    /// The number of actions.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.moments.len() - 1
    }

    /// The automaton state before instant `t`, if it was another; at the start that is 0.
    ///
    /// # Panics
    /// If there is no such instant.
    #[must_use]
    pub fn moved_from(&self, t: usize) -> Option<u32> {
        let before = if t == 0 { 0 } else { self.moments[t - 1].q };
        (before != self.moments[t].q).then_some(before)
    }

    /// The episode as a table: time, action, what is in view, what is in hand, and how the
    /// automaton moved and why.
    #[must_use]
    pub fn text(&self, layout: &Layout) -> String {
        let mut text = String::new();
        for goal in &self.goals {
            let (o, r) = (layout.name(goal.object), layout.name(goal.receptacle));
            let _ = writeln!(text, "wanted: {o} in {r}");
        }
        let rows: Vec<[String; 5]> = (0..self.moments.len()).map(|t| self.row(t, layout)).collect();
        let head = ["t", "action", "in view", "hand", "q"].map(String::from);
        let all = || std::iter::once(&head).chain(&rows);
        let widths: [usize; 5] =
            core::array::from_fn(|i| all().map(|row| row[i].chars().count()).max().unwrap_or(0));
        for row in all() {
            let cells = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}"));
            let line = cells.collect::<Vec<_>>().join("  ");
            let _ = writeln!(text, "{}", line.trim_end());
        }
        let failures = self.moments.iter().filter(|moment| moment.failed).count();
        let verdict = if self.satisfied { "satisfied" } else { "not satisfied" };
        let _ = writeln!(text, "{verdict} after {} steps, {failures} failed", self.steps());
        text
    }

    /// The cells of instant `t`.
    fn row(&self, t: usize, layout: &Layout) -> [String; 5] {
        let Moment { action, failed, known, q, reasons } = &self.moments[t];
        let action = action.map_or("(start)".into(), |action| action.name(layout));
        let moved = self.moved_from(t).map_or(q.to_string(), |before| {
            let reasons = reasons.iter().map(|p| p.name(layout));
            format!("{before} -> {q}  {}", reasons.collect::<Vec<_>>().join(" "))
        });
        let hand = if known.hand == NONE { "-" } else { layout.name(known.hand) };
        let failed = if *failed { "  failed" } else { "" };
        [t.to_string(), action + failed, view(known, layout), hand.into(), moved]
    }
}

/// The actions of an episode's [`text`](Episode::text), up to one that `layout` does not have.
#[must_use]
pub fn actions(text: &str, layout: &Layout) -> Vec<Action> {
    let all: Vec<Action> = (0..layout.actions()).map(Action::from_index).collect();
    let action = |line: &str| {
        let name = line.split_whitespace().nth(1)?;
        all.iter().copied().find(|action| action.name(layout) == name)
    };
    let start = text.lines().skip_while(|line| !line.starts_with("0 "));
    start.skip(1).map_while(action).collect()
}

/// The predicates that make the automaton move from `q` to where it moves; none if it stays.
fn reasons_for(
    monitor: &dyn Monitor<Known>,
    goals: &[Goal],
    q: u32,
    known: &Known,
) -> Result<Vec<Fact>, Error> {
    let to = monitor.next(q, known)?;
    let mut reasons = Vec::new();
    for predicate in Fact::of(goals) {
        if to != q && monitor.next(q, &predicate.denied(*known))? != to {
            reasons.push(predicate);
        }
    }
    Ok(reasons)
}

/// What is in view, in words: `fridge (closed)`, `sink: mug, fork`.
fn view(known: &Known, layout: &Layout) -> String {
    let r = known.focused_receptacle(layout);
    if r == NONE || !known.in_view[r as usize] {
        return "-".into();
    }
    if !known.is_open[r as usize] {
        return format!("{} (closed)", layout.name(r));
    }
    let contents = seen(known, layout);
    if contents.is_empty() {
        return format!("{}: nothing", layout.name(r));
    }
    let names: Vec<&str> = contents.into_iter().map(|o| layout.name(o)).collect();
    format!("{}: {}", layout.name(r), names.join(", "))
}

/// The objects in view.
pub(crate) fn seen(known: &Known, layout: &Layout) -> Vec<u8> {
    layout.object_ids().filter(|&o| known.in_view[o as usize]).collect()
}

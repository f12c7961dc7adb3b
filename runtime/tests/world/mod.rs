//! The paper's grid world, and tasks on it as hand-written tables.
#![allow(dead_code, reason = "not every test uses all of the world")]

use tltl::augmented::Labelled;
use tltl::automaton::{Automaton, Edge, Transitions};
use tltl::model::{Dynamics, FiniteModel};
use tltl::robustness::{NotANumber, Op, Predicates};
use tltl::{Formula, Task};

pub(crate) const GAMMA: f64 = 0.95;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cell {
    pub(crate) x: i32,
    pub(crate) y: i32,
}

/// The grid of Section 5.1; of any size.
pub(crate) struct Grid {
    pub(crate) width: usize,
    pub(crate) height: usize,
}

pub(crate) const PAPER: Grid = Grid { width: 8, height: 10 };

const MOVES: [(i32, i32); 5] = [(0, 1), (0, -1), (-1, 0), (1, 0), (0, 0)];

impl Grid {
    fn step(&self, s: usize, (dx, dy): (i32, i32)) -> usize {
        let (w, h) = (self.width as i32, self.height as i32);
        let (x, y) = (s as i32 % w + dx, s as i32 / w + dy);
        if (0..w).contains(&x) && (0..h).contains(&y) { (y * w + x) as usize } else { s }
    }
}

impl FiniteModel for Grid {
    type State = Cell;

    fn states(&self) -> usize {
        self.width * self.height
    }

    fn actions(&self) -> usize {
        5
    }

    fn state(&self, s: usize) -> Cell {
        Cell { x: (s % self.width) as i32, y: (s / self.width) as i32 }
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        outcome(self.step(s, MOVES[a]), 0.8);
        MOVES.iter().for_each(|&direction| outcome(self.step(s, direction), 0.04));
    }

    fn action_name(&self, a: usize) -> String {
        ["up", "down", "left", "right", "stay"][a].to_string()
    }
}

/// Point regions: predicate i is being within 1 of centre i.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regions(pub(crate) [Cell; 2]);

pub(crate) const A: Cell = Cell { x: 2, y: 2 };
pub(crate) const B: Cell = Cell { x: 5, y: 5 };
pub(crate) const C: Cell = Cell { x: 2, y: 7 };

impl Predicates<Cell> for Regions {
    fn robustness(&self, i: usize, s: &Cell) -> f64 {
        let centre = self.0[i];
        f64::from(1 - (s.x - centre.x).abs().max((s.y - centre.y).abs()))
    }

    fn holds(&self, i: usize, s: &Cell) -> Result<bool, NotANumber> {
        Ok(self.robustness(i, s) > 0.0)
    }

    fn with_scratch<R>(&self, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        f(&mut [0.0; 8], &mut [0.0; 8])
    }
}

const fn edge(from: u32, to: u32, guard: &'static [&'static [i32]]) -> Edge {
    Edge { from, to, guard }
}

/// ◇p ∧ ◇q.
pub(crate) static BOTH: Automaton = Automaton {
    propositions: &["p", "q"],
    states: 4,
    accepting: Some(3),
    trap: None,
    transitions: Transitions::Table {
        class: &[0, 1, 2, 3],
        width: 4,
        next: &[0, 1, 2, 3, 1, 1, 3, 3, 2, 3, 2, 3, 3, 3, 3, 3],
    },
    edges: &[
        edge(0, 0, &[&[-1, -2]]),
        edge(0, 1, &[&[1, -2]]),
        edge(0, 2, &[&[-1, 2]]),
        edge(0, 3, &[&[1, 2]]),
        edge(1, 1, &[&[-2]]),
        edge(1, 3, &[&[2]]),
        edge(2, 2, &[&[-1]]),
        edge(2, 3, &[&[1]]),
        edge(3, 3, &[&[]]),
    ],
    progress: &[&[&[1], &[2]], &[&[2]], &[&[1]], &[]],
    distance: &[1, 1, 1, 0],
};

/// ◇p.
pub(crate) static EVENTUALLY: Automaton = Automaton {
    propositions: &["p"],
    states: 2,
    accepting: Some(1),
    trap: None,
    transitions: Transitions::Table { class: &[0, 1], width: 2, next: &[0, 1, 1, 1] },
    edges: &[edge(0, 0, &[&[-1]]), edge(0, 1, &[&[1]]), edge(1, 1, &[&[]])],
    progress: &[&[&[1]], &[]],
    distance: &[1, 0],
};

/// ¬q U p: p before q, and never q until then.
pub(crate) static AVOID: Automaton = Automaton {
    propositions: &["p", "q"],
    states: 3,
    accepting: Some(1),
    trap: Some(2),
    transitions: Transitions::Table {
        class: &[0, 1, 2, 1],
        width: 3,
        next: &[0, 1, 2, 1, 1, 1, 2, 2, 2],
    },
    edges: &[
        edge(0, 0, &[&[-1, -2]]),
        edge(0, 1, &[&[1]]),
        edge(0, 2, &[&[-1, 2]]),
        edge(1, 1, &[&[]]),
        edge(2, 2, &[&[]]),
    ],
    progress: &[&[&[1]], &[], &[]],
    distance: &[1, 0, u32::MAX],
};

/// ◇(p ∧ ○q): the automaton has a cycle.
pub(crate) static NEXT: Automaton = Automaton {
    propositions: &["p", "q"],
    states: 3,
    accepting: Some(2),
    trap: None,
    transitions: Transitions::Table {
        class: &[0, 1, 2, 3],
        width: 4,
        next: &[0, 1, 0, 1, 0, 1, 2, 2, 2, 2, 2, 2],
    },
    edges: &[
        edge(0, 0, &[&[-1]]),
        edge(0, 1, &[&[1]]),
        edge(1, 0, &[&[-1, -2]]),
        edge(1, 1, &[&[1, -2]]),
        edge(1, 2, &[&[2]]),
        edge(2, 2, &[&[]]),
    ],
    progress: &[&[&[1]], &[&[-1], &[2]], &[]],
    distance: &[2, 1, 0],
};

static F_BOTH: Formula = Formula {
    text: "F p && F q",
    ops: &[Op::Is(0), Op::Eventually(0), Op::Is(1), Op::Eventually(2), Op::And(1, 3)],
};
static F_EVENTUALLY: Formula = Formula { text: "F p", ops: &[Op::Is(0), Op::Eventually(0)] };
static F_AVOID: Formula =
    Formula { text: "!q U p", ops: &[Op::Not(1), Op::Is(0), Op::Until(0, 1)] };
static F_NEXT: Formula = Formula {
    text: "F (p && X q)",
    ops: &[Op::Is(0), Op::Is(1), Op::Next(1), Op::And(0, 2), Op::Eventually(3)],
};

pub(crate) fn both(p: Cell, q: Cell) -> Task<Regions> {
    Task::from_parts("both", &F_BOTH, &BOTH, Regions([p, q]))
}

pub(crate) fn eventually(p: Cell) -> Task<Regions> {
    Task::from_parts("eventually", &F_EVENTUALLY, &EVENTUALLY, Regions([p, p]))
}

/// `!q U p`.
pub(crate) fn avoid(q: Cell, p: Cell) -> Task<Regions> {
    Task::from_parts("avoid", &F_AVOID, &AVOID, Regions([p, q]))
}

pub(crate) fn next(p: Cell, q: Cell) -> Task<Regions> {
    Task::from_parts("next", &F_NEXT, &NEXT, Regions([p, q]))
}

pub(crate) fn dynamics() -> Dynamics {
    Dynamics::new(&PAPER).unwrap()
}

pub(crate) fn on_paper(task: &(impl tltl::Monitor<Cell> + ?Sized)) -> Labelled {
    Labelled::of_model(&PAPER, task).unwrap()
}

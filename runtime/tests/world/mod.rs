//! The paper's grid world, and tasks on it as hand-written tables.
#![allow(dead_code, reason = "not every test uses all of the world")]

use tltl::augmented::Labelled;
use tltl::automaton::{Automaton, Tables, Transitions};
use tltl::model::{Dynamics, FiniteModel};
use tltl::robustness::{NotANumber, Op, Predicates};
use tltl::solve::Problem;
use tltl::{Formula, Shared, Task};

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
}

/// Guards as sums of products: cubes of literals.
type Sum<'a> = &'a [&'a [i32]];

/// An automaton with a table of transitions: the class of each valuation, the next states, the edges
/// `(from, to, guard)`, and for each state the guard of progress and the distance.
struct Written<'a> {
    propositions: &'a [&'static str],
    ends: [Option<u32>; 2],
    class: &'a [u16],
    next: &'a [u32],
    edges: &'a [(u32, u32, Sum<'a>)],
    progress: &'a [Sum<'a>],
    distance: &'a [u32],
}

impl Written<'_> {
    fn automaton(&self) -> Automaton {
        let states = self.distance.len() as u32;
        let sums = self.progress.iter().copied().chain(self.edges.iter().map(|edge| edge.2));
        let (mut guards, mut literals) = (vec![0], Vec::new());
        for sum in sums {
            for cube in sum {
                literals.extend(cube.iter().chain(&[0]));
            }
            guards.push(literals.len() as u32);
        }
        let before = |q| self.edges.iter().filter(|edge| edge.0 < q).count() as u32;
        let tables = Tables {
            propositions: self.propositions.iter().map(|&name| Shared::from(name)).collect(),
            states,
            accepting: self.ends[0],
            trap: self.ends[1],
            transitions: Transitions::Table {
                class: self.class.to_vec().into(),
                width: self.next.len() as u32 / states,
                next: self.next.to_vec().into(),
            },
            edges: (0..=states).map(before).collect(),
            targets: self.edges.iter().map(|edge| edge.1).collect(),
            guards: guards.into(),
            literals: literals.into(),
            distance: self.distance.to_vec().into(),
        };
        Automaton::new(tables).unwrap()
    }

    fn task(
        &self,
        name: &'static str,
        text: &'static str,
        ops: &[Op],
        places: [Cell; 2],
    ) -> Task<Regions> {
        let formula = Formula::new(text, ops.to_vec()).unwrap();
        Task::new(name, formula, self.automaton(), Regions(places)).unwrap()
    }
}

/// ◇p ∧ ◇q.
const BOTH: Written<'_> = Written {
    propositions: &["p", "q"],
    ends: [Some(3), None],
    class: &[0, 1, 2, 3],
    next: &[0, 1, 2, 3, 1, 1, 3, 3, 2, 3, 2, 3, 3, 3, 3, 3],
    edges: &[
        (0, 0, &[&[-1, -2]]),
        (0, 1, &[&[1, -2]]),
        (0, 2, &[&[-1, 2]]),
        (0, 3, &[&[1, 2]]),
        (1, 1, &[&[-2]]),
        (1, 3, &[&[2]]),
        (2, 2, &[&[-1]]),
        (2, 3, &[&[1]]),
        (3, 3, &[&[]]),
    ],
    progress: &[&[&[1], &[2]], &[&[2]], &[&[1]], &[]],
    distance: &[1, 1, 1, 0],
};

/// ◇p.
const EVENTUALLY: Written<'_> = Written {
    propositions: &["p"],
    ends: [Some(1), None],
    class: &[0, 1],
    next: &[0, 1, 1, 1],
    edges: &[(0, 0, &[&[-1]]), (0, 1, &[&[1]]), (1, 1, &[&[]])],
    progress: &[&[&[1]], &[]],
    distance: &[1, 0],
};

/// ¬q U p: p before q, and never q until then.
const AVOID: Written<'_> = Written {
    propositions: &["p", "q"],
    ends: [Some(1), Some(2)],
    class: &[0, 1, 2, 1],
    next: &[0, 1, 2, 1, 1, 1, 2, 2, 2],
    edges: &[
        (0, 0, &[&[-1, -2]]),
        (0, 1, &[&[1]]),
        (0, 2, &[&[-1, 2]]),
        (1, 1, &[&[]]),
        (2, 2, &[&[]]),
    ],
    progress: &[&[&[1]], &[], &[]],
    distance: &[1, 0, u32::MAX],
};

/// ◇(p ∧ ○p ∧ ○○p): p at three instants in a row; each that is not p begins anew.
const THRICE: Written<'_> = Written {
    propositions: &["p"],
    ends: [Some(3), None],
    class: &[0, 1],
    next: &[0, 1, 0, 2, 0, 3, 3, 3],
    edges: &[
        (0, 0, &[&[-1]]),
        (0, 1, &[&[1]]),
        (1, 0, &[&[-1]]),
        (1, 2, &[&[1]]),
        (2, 0, &[&[-1]]),
        (2, 3, &[&[1]]),
        (3, 3, &[&[]]),
    ],
    progress: &[&[&[1]], &[&[]], &[&[]], &[]],
    distance: &[3, 2, 1, 0],
};

/// ◇(p ∧ ○q): the automaton has a cycle.
const NEXT: Written<'_> = Written {
    propositions: &["p", "q"],
    ends: [Some(2), None],
    class: &[0, 1, 2, 3],
    next: &[0, 1, 0, 1, 0, 1, 2, 2, 2, 2, 2, 2],
    edges: &[
        (0, 0, &[&[-1]]),
        (0, 1, &[&[1]]),
        (1, 0, &[&[-1, -2]]),
        (1, 1, &[&[1, -2]]),
        (1, 2, &[&[2]]),
        (2, 2, &[&[]]),
    ],
    progress: &[&[&[1]], &[&[-1], &[2]], &[]],
    distance: &[2, 1, 0],
};

pub(crate) fn both(p: Cell, q: Cell) -> Task<Regions> {
    let ops = [Op::Is(0), Op::Eventually(0), Op::Is(1), Op::Eventually(2), Op::And(1, 3)];
    BOTH.task("both", "F p && F q", &ops, [p, q])
}

pub(crate) fn eventually(p: Cell) -> Task<Regions> {
    EVENTUALLY.task("eventually", "F p", &[Op::Is(0), Op::Eventually(0)], [p, p])
}

/// `!q U p`.
pub(crate) fn avoid(q: Cell, p: Cell) -> Task<Regions> {
    AVOID.task("avoid", "!q U p", &[Op::Not(1), Op::Is(0), Op::Until(0, 1)], [p, q])
}

pub(crate) fn thrice(p: Cell) -> Task<Regions> {
    let next = [Op::Is(0), Op::Next(0), Op::Next(1)];
    let ops = [&next[..], &[Op::And(0, 1), Op::And(3, 2), Op::Eventually(4)]].concat();
    THRICE.task("thrice", "F (p && X p && X X p)", &ops, [p, p])
}

pub(crate) fn next(p: Cell, q: Cell) -> Task<Regions> {
    let ops = [Op::Is(0), Op::Is(1), Op::Next(1), Op::And(0, 2), Op::Eventually(3)];
    NEXT.task("next", "F (p && X q)", &ops, [p, q])
}

pub(crate) fn dynamics() -> Dynamics {
    Dynamics::new(&PAPER).unwrap()
}

pub(crate) fn on_paper(task: &(impl tltl::Monitor<Cell> + ?Sized)) -> Labelled {
    Labelled::of_model(&PAPER, task).unwrap()
}

/// The paper's grid under a task that is labelled on it.
pub(crate) fn problem(task: &Labelled) -> Problem {
    Problem::new(&dynamics(), task).unwrap()
}

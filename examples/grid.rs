//! The paper's grid world (Section 5.1): a finite model in a few lines.

use tltl::model::FiniteModel;

/// Where the agent is: columns from the left, rows from below, both from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// The column.
    pub x: i32,
    /// The row.
    pub y: i32,
}

/// A grid with walls around it: a move into a wall stays where it is.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// The number of columns.
    pub width: i32,
    /// The number of rows.
    pub height: i32,
    /// The probability that a random action, uniform over all five, is carried out instead of the
    /// commanded one.
    pub slip: f64,
}

impl Grid {
    /// The grid of the paper: 8 × 10, slip 0.2.
    pub const PAPER: Self = Self { width: 8, height: 10, slip: 0.2 };

    /// The actions with their moves.
    pub const ACTIONS: [(&'static str, i32, i32); 5] =
        [("up", 0, 1), ("down", 0, -1), ("left", -1, 0), ("right", 1, 0), ("stay", 0, 0)];

    /// The number of a cell.
    #[must_use]
    pub fn index(&self, cell: Cell) -> usize {
        (cell.y * self.width + cell.x) as usize
    }

    fn moved(&self, s: usize, a: usize) -> usize {
        let (Cell { x, y }, (_, dx, dy)) = (self.state(s), Self::ACTIONS[a]);
        let cell =
            Cell { x: (x + dx).clamp(0, self.width - 1), y: (y + dy).clamp(0, self.height - 1) };
        self.index(cell)
    }
}

impl FiniteModel for Grid {
    type State = Cell;

    fn states(&self) -> usize {
        (self.width * self.height) as usize
    }

    fn actions(&self) -> usize {
        Self::ACTIONS.len()
    }

    fn state(&self, s: usize) -> Cell {
        Cell { x: s as i32 % self.width, y: s as i32 / self.width }
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        outcome(self.moved(s, a), 1.0 - self.slip);
        for other in 0..self.actions() {
            outcome(self.moved(s, other), self.slip / self.actions() as f64);
        }
    }

    fn action_name(&self, a: usize) -> String {
        Self::ACTIONS[a].0.to_owned()
    }
}

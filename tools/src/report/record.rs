//! A trajectory in as many pieces as a screen can show.
//!
//! A piece is a run of neighbouring rows. It has the smallest and the largest robustness of each
//! predicate in them, so no peak is lost, and everything else as of its last row. Pieces grow as
//! rows arrive, so the memory does not grow with the trajectory.

use serde::{Serialize, Serializer};
use tltl_compiler::source::visible;

use crate::task::Verdict;

/// The most pieces that a trajectory is shown in; one of no more rows is shown row by row.
///
/// A longer one is cut into pieces of equal length, and wherever the automaton's state changes. If
/// that makes too many, a piece may have several states, of which the last is shown.
pub const MOST_PIECES: usize = 4096;

/// One state of a trajectory, as the predicates and the automaton saw it.
#[derive(Clone, Copy, Debug)]
pub struct Row<'a> {
    /// The automaton's state after the row is read, if there is an automaton.
    pub state: Option<u32>,
    /// Which propositions hold, in their order.
    pub holds: &'a [bool],
    /// The robustness of each proposition, none of it NaN; empty, in every row, if only truth is
    /// known.
    pub rho: &'a [f64],
    /// The robustness of the trajectory up to here, if it is known in every row.
    pub robustness: Option<f64>,
    /// The greatest robustness that the trajectory can still have, if it is known in every row.
    pub greatest: Option<f64>,
}

/// A trajectory for a [`Page`](super::Page), read row by row.
///
/// ```
/// use tltlc::report::{MOST_PIECES, Row, Trajectory};
/// use tltlc::task::Verdict;
///
/// let mut long = Trajectory::new("a day in the kitchen");
/// for row in 0..100_000 {
///     let holds = [row >= 70_000];
///     let state = Some(u32::from(holds[0]));
///     long.push(&Row { state, holds: &holds, rho: &[], robustness: None, greatest: None });
/// }
/// long.end(Some(Verdict::Satisfied), 70_000, Some(0.25));
/// assert!((2_000..=MOST_PIECES).contains(&long.pieces()));
/// ```
#[derive(Clone, Debug)]
pub struct Trajectory {
    name: String,
    rows: usize,
    pieces: Vec<Piece>,
    /// The most rows of a piece.
    length: usize,
    /// Whether a piece may have several states of the automaton.
    is_mixed: bool,
    verdict: Option<Verdict>,
    since: usize,
    robustness: Option<f64>,
}

/// Neighbouring rows.
#[derive(Clone, Debug)]
struct Piece {
    first: usize,
    last: usize,
    state: Option<u32>,
    holds: Vec<bool>,
    /// For each proposition the smallest, the largest and the last robustness.
    rho: Vec<[f64; 3]>,
    robustness: Option<f64>,
    greatest: Option<f64>,
}

impl Piece {
    /// Takes in the piece behind it.
    fn join(&mut self, next: Self) {
        let range = |(a, b): (&[f64; 3], &[f64; 3])| [a[0].min(b[0]), a[1].max(b[1]), b[2]];
        let rho = self.rho.iter().zip(&next.rho).map(range).collect();
        *self = Self { first: self.first, rho, ..next };
    }
}

impl Trajectory {
    /// A trajectory without rows, which is open.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            rows: 0,
            pieces: Vec::new(),
            length: 1,
            is_mixed: false,
            verdict: Some(Verdict::Open),
            since: 0,
            robustness: None,
        }
    }

    /// The same under another name.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Reads the next row.
    pub fn push(&mut self, row: &Row<'_>) {
        let piece = Piece {
            first: self.rows,
            last: self.rows,
            state: row.state,
            holds: row.holds.to_vec(),
            rho: row.rho.iter().map(|&rho| [rho + 0.0; 3]).collect(),
            robustness: row.robustness,
            greatest: row.greatest,
        };
        self.rows += 1;
        self.add(piece);
        while self.pieces.len() > MOST_PIECES {
            self.length *= 2;
            let before = self.pieces.len();
            self.again();
            // States change almost as often as rows come.
            if self.pieces.len() > before / 4 * 3 && !self.is_mixed {
                self.is_mixed = true;
                self.again();
            }
        }
    }

    /// Adds a piece, to the last one if that may grow so far.
    fn add(&mut self, piece: Piece) {
        match self.pieces.last_mut() {
            Some(last)
                if piece.last - last.first < self.length
                    && (self.is_mixed || piece.state == last.state) =>
            {
                last.join(piece);
            }
            _ => self.pieces.push(piece),
        }
    }

    /// Joins the pieces by the rule as it is now.
    fn again(&mut self) {
        std::mem::take(&mut self.pieces).into_iter().for_each(|piece| self.add(piece));
    }

    /// Says how the trajectory ends: the verdict on all of it (`None` where it is not satisfied, and
    /// nobody knows whether it is lost), the first row after which that was so, and its robustness
    /// where that is known.
    pub fn end(&mut self, verdict: Option<Verdict>, since: usize, robustness: Option<f64>) {
        (self.verdict, self.since, self.robustness) = (verdict, since, robustness);
    }

    /// The number of pieces that it is shown in.
    #[must_use]
    pub fn pieces(&self) -> usize {
        self.pieces.len()
    }

    /// The states of the automaton that it shows, each once, in the order of their first rows.
    pub(super) fn states(&self) -> Vec<u32> {
        let mut seen = rustc_hash::FxHashSet::default();
        let states = self.pieces.iter().filter_map(|piece| piece.state);
        states.filter(|&state| seen.insert(state)).collect()
    }

    /// The rule by which it was thinned; `None` if every row is shown.
    pub(super) fn rule(&self) -> Option<String> {
        (self.length > 1).then(|| {
            let cut = match self.is_mixed {
                false => "cut where the state changes",
                true => "which may have several states, of which the last is shown",
            };
            format!(
                "{} rows, shown in {} pieces of at most {}, {cut}; lines span the smallest and \
                 the largest value of a piece, numbers are those of its last row",
                self.rows,
                self.pieces.len(),
                self.length
            )
        })
    }

    /// Its numbers, column by column, as the script of the page reads them.
    pub(super) fn columns(&self) -> Columns {
        let width = self.pieces.first().map_or(0, |piece| piece.holds.len());
        let column = |value: &dyn Fn(&Piece) -> Option<f64>| -> Option<Vec<Number>> {
            self.pieces.iter().map(|piece| value(piece).map(Number)).collect()
        };
        let rho = |which: usize| -> Option<Vec<Vec<Number>>> {
            let one = |p: usize| column(&|piece| Some(piece.rho.get(p)?[which]));
            (0..width).map(one).collect()
        };
        let is_thinned = self.length > 1;
        let holds = |p: usize| {
            let digit = |piece: &Piece| if piece.holds[p] { '1' } else { '0' };
            self.pieces.iter().map(digit).collect()
        };
        Columns {
            name: visible(&self.name).into_owned(),
            rule: self.rule(),
            verdict: self.verdict,
            since: self.since,
            robustness: self.robustness.map(Number),
            first: self.pieces.iter().map(|piece| piece.first).collect(),
            last: self.pieces.iter().map(|piece| piece.last).collect(),
            states: self.pieces.iter().map(|piece| piece.state).collect(),
            holds: (0..width).map(holds).collect(),
            low: rho(0).filter(|_| is_thinned),
            high: rho(1).filter(|_| is_thinned),
            rho: rho(2),
            so_far: column(&|piece| piece.robustness),
            greatest: column(&|piece| piece.greatest),
        }
    }
}

/// The columns of a trajectory: one entry for each piece.
#[derive(Serialize)]
pub(super) struct Columns {
    name: String,
    rule: Option<String>,
    verdict: Option<Verdict>,
    since: usize,
    robustness: Option<Number>,
    first: Vec<usize>,
    last: Vec<usize>,
    states: Vec<Option<u32>>,
    /// For each proposition a digit a piece.
    holds: Vec<String>,
    low: Option<Vec<Vec<Number>>>,
    high: Option<Vec<Vec<Number>>>,
    rho: Option<Vec<Vec<Number>>>,
    so_far: Option<Vec<Number>>,
    greatest: Option<Vec<Number>>,
}

/// A number as JavaScript's `Number` reads it: JSON has no infinite ones, so these are texts.
struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            f64::INFINITY => serializer.serialize_str("Infinity"),
            f64::NEG_INFINITY => serializer.serialize_str("-Infinity"),
            finite if finite.fract() == 0.0 && finite.abs() < 1e15 => {
                serializer.serialize_i64(finite as i64)
            }
            finite => serializer.serialize_f64(finite),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Row `row` has this state, and this robustness.
    fn row_of(row: usize, period: usize) -> (u32, f64) {
        let noise = (row as u64).wrapping_mul(6_364_136_223_846_793_005) >> 40;
        ((row / period) as u32, noise as f64)
    }

    #[test]
    fn no_row_and_no_peak_is_lost() {
        // States that last for long, for two rows, and for one; fewer and more rows than pieces.
        for (rows, period) in [(4096, 1), (4097, 1), (10_000, 700), (100_000, 2), (50_001, 1)] {
            let mut long = Trajectory::new("long");
            for row in 0..rows {
                let (state, rho) = row_of(row, period);
                let row = Row {
                    state: Some(state),
                    holds: &[true],
                    rho: &[rho],
                    robustness: None,
                    greatest: None,
                };
                long.push(&row);
            }
            let (pieces, mut next) = (&long.pieces, 0);
            let case = format!("{rows} rows, period {period}");
            assert!(
                pieces.len() <= MOST_PIECES && pieces.len() >= rows.min(MOST_PIECES / 3),
                "{case}"
            );
            assert_eq!(
                (long.length > 1, long.rule().is_some()),
                (rows > MOST_PIECES, rows > MOST_PIECES)
            );
            assert_eq!(long.is_mixed, rows > MOST_PIECES && period < 3, "{case}");
            for piece in pieces {
                assert_eq!(piece.first, next, "{case}");
                next = piece.last + 1;
                assert!(next - piece.first <= long.length, "{case}");
                let all: Vec<_> = (piece.first..next).map(|row| row_of(row, period)).collect();
                let rho = || all.iter().map(|(_, rho)| *rho);
                let (low, high) = (rho().fold(f64::MAX, f64::min), rho().fold(f64::MIN, f64::max));
                assert_eq!(piece.rho, [[low, high, all[all.len() - 1].1]], "{case}");
                assert_eq!(piece.state, all.last().map(|(state, _)| *state), "{case}");
                assert!(long.is_mixed || all.iter().all(|(state, _)| Some(*state) == piece.state));
            }
            assert_eq!(next, rows, "{case}");
        }
    }
}

//! Many moves in one call: of many states on a letter each, or of one state along a trajectory.
//!
//! The form of the transition function and that of the letters are looked at once a call and not
//! once a move, so what remains of a move is one or two look-ups.

use super::{Automaton, Transitions, shifted};

/// Letters, one for each row: which propositions hold there.
///
/// A slice of either kind is one, by `From`: pass `&letters[..]`.
///
/// ```
/// use tltl::automaton::Letters;
/// use tltl::{Monitor as _, tltl};
///
/// // Proposition 0, then proposition 1, as bits and as rows of truth values.
/// let task = tltl! { |s: &(bool, bool)| s.0 T s.1 };
/// let (bits, labels) = ([0b01_u64, 0b10], [true, false, false, true]);
/// for letters in [Letters::Bits(&bits), Letters::Labels(&labels)] {
///     let mut states = [0; 2];
///     assert_eq!(task.automaton().run(0, letters, &mut states), 2);
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Letters<'a> {
    /// Bit i is proposition i; bits beyond the propositions mean nothing. For up to 64
    /// propositions.
    Bits(&'a [u64]),
    /// Row after row, a truth value for each proposition.
    Labels(&'a [bool]),
}

impl<'a> From<&'a [u64]> for Letters<'a> {
    #[inline]
    fn from(bits: &'a [u64]) -> Self {
        Self::Bits(bits)
    }
}

impl<'a> From<&'a [bool]> for Letters<'a> {
    #[inline]
    fn from(labels: &'a [bool]) -> Self {
        Self::Labels(labels)
    }
}

impl Letters<'_> {
    #[track_caller]
    #[inline]
    pub(super) fn expect(self, rows: usize, propositions: usize) {
        match self {
            Self::Bits(bits) => {
                assert!(propositions <= 64, "bits tell at most 64 propositions");
                assert_eq!(bits.len(), rows, "a letter for each row");
            }
            Self::Labels(labels) => {
                assert_eq!(labels.len(), rows * propositions, "a label for each proposition");
            }
        }
    }
}

impl Automaton {
    /// Moves many states, each on its own letter: `q[i] = δ(q[i], letter i)`.
    ///
    /// # Panics
    /// If there is not a letter for each state, a letter of bits has to tell more than 64
    /// propositions, or one of `q` is not a state of this automaton.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// let task = tltl::tltl! { |s: &(bool, bool)| s.0 T s.1 };
    /// let mut q = [0, 0, 1];
    /// task.automaton().step_batch(&mut q, &[0b01_u64, 0b10, 0b10][..]);
    /// assert_eq!(q, [1, 0, 2]);
    /// task.automaton().step_batch(&mut q, &[false, true, true, true, false, false][..]);
    /// assert_eq!(q, [2, 1, 2]);
    /// # }
    /// ```
    #[track_caller]
    pub fn step_batch<'a>(&self, q: &mut [u32], letters: impl Into<Letters<'a>>) {
        self.walk(q.len(), letters.into(), Each(q));
    }

    /// Reads a trajectory from state `q`: `states[t]` becomes the state after letter t, the last of
    /// which is returned; `q` itself for an empty trajectory.
    ///
    /// # Panics
    /// If there is not a letter for each of `states`, a letter of bits has to tell more than 64
    /// propositions, or `q` is not a state of this automaton.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// use tltl::Acceptor;
    ///
    /// let task = tltl::tltl! { |s: &(bool, bool)| s.0 T s.1 };
    /// let mut states = [0; 3];
    /// let last = task.automaton().run(0, &[0b00_u64, 0b11, 0b10][..], &mut states);
    /// assert_eq!(states, [0, 1, 2]);
    /// assert!(task.is_accepting(last));
    /// # }
    /// ```
    #[track_caller]
    pub fn run<'a>(&self, q: u32, letters: impl Into<Letters<'a>>, states: &mut [u32]) -> u32 {
        self.walk(states.len(), letters.into(), Along { q, states: &mut *states });
        states.last().copied().unwrap_or(q)
    }

    /// Moves states of a table, each on the letter that is kept in its bits from `place` on.
    #[inline(always)]
    pub(crate) fn move_by_kept(&self, q: &mut [u32], place: u32) {
        let of = |q: u32| (q & ((1 << place) - 1), (q >> place) as usize);
        match self.shifts {
            Some(shifts) => q.iter_mut().for_each(|kept| {
                let (q, letter) = of(*kept);
                *kept = shifted(&shifts, q, letter);
            }),
            None => q.iter_mut().for_each(|kept| {
                let (q, letter) = of(*kept);
                *kept = self.look_up(q, letter);
            }),
        }
    }

    #[track_caller]
    #[inline]
    fn walk(&self, rows: usize, letters: Letters<'_>, walk: impl Walk) {
        let count = self.propositions().len();
        letters.expect(rows, count);
        walk.expect(self);
        match (&self.tables.transitions, letters) {
            (Transitions::Table { class, .. }, Letters::Bits(bits)) => {
                let mask = class.len() - 1;
                self.walk_letters(bits.iter().map(|&bits| bits as usize & mask), walk);
            }
            (Transitions::Table { .. }, Letters::Labels(labels)) => match count {
                0 => self.walk_letters((0..rows).map(|_| 0), walk),
                1 => self.walk_rows::<1>(labels, walk),
                2 => self.walk_rows::<2>(labels, walk),
                3 => self.walk_rows::<3>(labels, walk),
                4 => self.walk_rows::<4>(labels, walk),
                5 => self.walk_rows::<5>(labels, walk),
                6 => self.walk_rows::<6>(labels, walk),
                7 => self.walk_rows::<7>(labels, walk),
                8 => self.walk_rows::<8>(labels, walk),
                _ => self.walk_letters(labels.chunks_exact(count).map(letter), walk),
            },
            (Transitions::Diagram { nodes, roots }, Letters::Bits(bits)) => {
                let (nodes, roots): (&[[u32; 3]], &[u32]) = (nodes, roots);
                walk.walk(bits.iter(), |q, bits| {
                    descend(nodes, roots[q as usize], |i| bits >> i & 1 == 1)
                });
            }
            (Transitions::Diagram { nodes, roots }, Letters::Labels(labels)) => {
                let (nodes, roots): (&[[u32; 3]], &[u32]) = (nodes, roots);
                walk.walk((0..rows).map(|row| &labels[row * count..][..count]), |q, labels| {
                    descend(nodes, roots[q as usize], |i| labels[i])
                });
            }
        }
    }

    /// The same through a table, with a row of so many labels for each letter. The loop knows how many:
    /// if that is asked for in each row, three labels and their step take twice the time
    /// (`python/benches/bench.py`, rows of bool).
    #[inline]
    fn walk_rows<const N: usize>(&self, labels: &[bool], walk: impl Walk) {
        self.walk_letters(labels.as_chunks::<N>().0.iter().map(gathered), walk);
    }

    /// The same through a table, which has a letter for each row. What its form is, is asked once.
    #[inline]
    fn walk_letters(&self, letters: impl Iterator<Item = usize>, walk: impl Walk) {
        match self.shifts {
            Some(shifts) => walk.walk(letters, |q, letter| shifted(&shifts, q, letter)),
            None => walk.walk(letters, |q, letter| self.look_up(q, letter)),
        }
    }
}

/// Truth values as bits, the first as the lowest. Up to three are put together one by one; from four to
/// eight, one multiplication gathers them, which is faster from there on.
#[inline(always)]
fn gathered<const N: usize>(labels: &[bool; N]) -> usize {
    const { assert!(N <= 8, "a multiplication gathers the bits of eight bytes") };
    if N < 4 {
        return one_by_one(labels);
    }
    let mut eight = [0; 8];
    eight.iter_mut().zip(labels).for_each(|(byte, &holds)| *byte = u8::from(holds));
    (u64::from_le_bytes(eight).wrapping_mul(0x0102_0408_1020_4080) >> 56) as usize
}

/// The same of up to eight.
#[inline(always)]
pub(super) fn byte(labels: &[bool]) -> usize {
    labels.first_chunk::<8>().map_or_else(|| one_by_one(labels), gathered)
}

/// The same of any number.
#[inline(always)]
fn letter(labels: &[bool]) -> usize {
    labels.chunks(8).rev().fold(0, |bits, eight| bits << 8 | byte(eight))
}

#[inline(always)]
fn one_by_one(labels: &[bool]) -> usize {
    labels.iter().rev().fold(0, |bits, &holds| bits << 1 | usize::from(holds))
}

/// The state that a reference of a diagram leads to. To compute the next reference's place costs
/// less than to branch on what nobody can predict.
#[inline]
fn descend(nodes: &[[u32; 3]], mut at: u32, holds: impl Fn(usize) -> bool) -> u32 {
    while let Some(node) = nodes.get(at as usize) {
        at = node[1 + usize::from(holds(node[0] as usize))];
    }
    at & !Transitions::LEAF
}

/// A use of the transition function, which is given as the state after `q` has read a letter of a row,
/// and of the letters of all rows. A trait, for a closure cannot take a closure of any type.
trait Walk {
    /// Panics if it does not begin at states of the automaton.
    fn expect(&self, automaton: &Automaton);
    fn walk<L>(self, letters: impl Iterator<Item = L>, next: impl Fn(u32, L) -> u32);
}

/// Every state for itself.
struct Each<'a>(&'a mut [u32]);

impl Walk for Each<'_> {
    #[inline]
    fn expect(&self, automaton: &Automaton) {
        automaton.expect_states(self.0);
    }

    #[inline]
    fn walk<L>(self, letters: impl Iterator<Item = L>, next: impl Fn(u32, L) -> u32) {
        self.0.iter_mut().zip(letters).for_each(|(q, letter)| *q = next(*q, letter));
    }
}

/// Each state from the one before.
struct Along<'a> {
    q: u32,
    states: &'a mut [u32],
}

impl Walk for Along<'_> {
    #[inline]
    fn expect(&self, automaton: &Automaton) {
        automaton.expect_state(self.q);
    }

    #[inline]
    fn walk<L>(self, letters: impl Iterator<Item = L>, next: impl Fn(u32, L) -> u32) {
        let mut q = self.q;
        for (state, letter) in self.states.iter_mut().zip(letters) {
            q = next(q, letter);
            *state = q;
        }
    }
}

//! Diagrams that read eight propositions at once.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use super::batch::byte;
use super::{Automaton, Letters, Transitions};

/// A decision diagram as tables that are indexed by a byte of the letter: a step is one look-up for
/// every eight propositions, and none of them waits for a branch that nobody can predict.
///
/// ```
/// use tltl::tltl;
///
/// // Twelve goals, one after the other: too many propositions for one table.
/// let tour = tltl! { |s: &[bool; 12]| s[0] T s[1] T s[2] T s[3] T s[4] T s[5] T s[6] T s[7]
///     T s[8] T s[9] T s[10] T s[11] };
/// let bytes = tour.automaton().by_bytes().expect("this diagram is small");
/// let mut q = [0, 1, 11];
/// bytes.step_batch(&mut q, &[0b1_u64, 0b1, 0b1000_0000_0000][..]);
/// assert_eq!(q, [1, 1, 12]);
/// ```
#[derive(Clone, Debug)]
pub struct ByBytes {
    states: u32,
    propositions: usize,
    /// For each place between two bytes, and each value of the next byte: the next place. The first
    /// places are the states; what the last byte leads to is a state.
    rows: Vec<[u16; 256]>,
}

/// It has up to so many rows, which are 2 MB. Others leave the second-level cache, and then a walk
/// through the diagram is as fast.
const ROWS: usize = 4096;

impl Automaton {
    /// The automaton by bytes, for many steps; `None` for a table, for a diagram that would become too
    /// large, and for one that does not ask for propositions by rising number.
    ///
    /// Costs O(rows × 2,048) time, of up to 4,096 rows.
    #[must_use]
    pub fn by_bytes(&self) -> Option<ByBytes> {
        let Transitions::Diagram { nodes, roots } = &self.tables.transitions else { return None };
        let (mut rows, mut entries) = (Vec::new(), roots.to_vec());
        let propositions = self.propositions().len();
        let bytes = propositions.div_ceil(8);
        for byte in 0..bytes {
            let asked = 8 * byte as u32..8 * (byte as u32 + 1);
            let next_row = rows.len() + entries.len();
            let (mut places, mut next) = (BTreeMap::new(), Vec::new());
            for entry in entries {
                let mut row = [0; 256];
                for (bits, to) in row.iter_mut().enumerate() {
                    let mut at = entry;
                    while let Some(&[proposition, low, high]) = nodes.get(at as usize) {
                        if proposition >= asked.end {
                            break;
                        }
                        let bit = proposition.checked_sub(asked.start)?;
                        at = if bits >> bit & 1 == 1 { high } else { low };
                    }
                    *to = if byte + 1 == bytes {
                        u16::try_from(at.checked_sub(Transitions::LEAF)?).ok()?
                    } else {
                        *places.entry(at).or_insert_with(|| {
                            next.push(at);
                            (next_row + next.len() - 1) as u16
                        })
                    };
                }
                rows.push(row);
                if rows.len() + next.len() > ROWS {
                    return None;
                }
            }
            entries = next;
        }
        Some(ByBytes { states: self.tables.states, propositions, rows })
    }
}

impl ByBytes {
    /// Moves many states, each on its own letter, as [`Automaton::step_batch`].
    ///
    /// # Panics
    /// If there is not a letter for each state, a letter of bits has to tell more than 64
    /// propositions, or one of `q` is not a state of the automaton.
    #[track_caller]
    pub fn step_batch<'a>(&self, q: &mut [u32], letters: impl Into<Letters<'a>>) {
        let (letters, count) = (letters.into(), self.propositions);
        letters.expect(q.len(), count);
        let is_state = q.iter().all(|&q| q < self.states);
        assert!(is_state, "states are below {}", self.states);
        match count.div_ceil(8) {
            // A loop of two look-ups, which most diagrams need, is unrolled.
            2 => self.step_by(q, letters, 2),
            bytes => self.step_by(q, letters, bytes),
        }
    }

    #[inline(always)]
    fn step_by(&self, q: &mut [u32], letters: Letters<'_>, bytes: usize) {
        match letters {
            Letters::Bits(bits) => {
                for (q, bits) in q.iter_mut().zip(bits) {
                    *q = self.walk(*q, bytes, |byte| (bits >> (8 * byte)) as u8);
                }
            }
            Letters::Labels(labels) => {
                for (q, row) in q.iter_mut().zip(labels.chunks_exact(self.propositions.max(1))) {
                    *q = self.walk(*q, bytes, |at| {
                        byte(&row[8 * at..self.propositions.min(8 * at + 8)]) as u8
                    });
                }
            }
        }
    }

    #[inline(always)]
    fn walk(&self, q: u32, bytes: usize, letter: impl Fn(usize) -> u8) -> u32 {
        (0..bytes).fold(q, |at, byte| u32::from(self.rows[at as usize][usize::from(letter(byte))]))
    }
}

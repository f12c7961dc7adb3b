//! Whether tables from outside are an automaton, or operators a formula.
//!
//! The runtime reads tables without a doubt: it indexes by offsets, walks diagrams until they end,
//! and looks up where a move leads. All that this relies on is checked here, once, so that no
//! look-up of a checked automaton is out of range, every walk through it ends, and what reads it
//! (a product, a solver) meets no move that the edges do not have.
//!
//! Not checked: that states are numbered breadth-first, that the automaton is minimal (nothing
//! relies on either), and that guards agree with δ. To compare a sum of products with a decision
//! diagram takes time exponential in the number of propositions, and the valuations that arithmetic
//! rules out, on which they may differ, are not in the tables.
//!
//! The checks come in the order in which each relies on those before it; the first error is
//! reported, for what follows from it is not news.

use alloc::vec::Vec;
use core::fmt;

use super::{Tables, Transitions};

/// Why tables are not an automaton, or operators not a formula: the table, the entry, and what is
/// wrong with it.
///
/// ```
/// use tltl::{Formula, robustness::Op};
///
/// // The operand of an operator is an earlier one.
/// let error = Formula::new("F a", vec![Op::Eventually(1), Op::Is(0)]).unwrap_err();
/// assert_eq!(error.to_string(), "`operators`, entry 0: 1 is not less than 0");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableError(Kind);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    /// A table is longer or shorter than another one says.
    Length { table: &'static str, found: usize, expected: usize },
    /// An index points beyond its table.
    Limit { table: &'static str, at: usize, found: u64, limit: u64 },
    /// An entry breaks a rule, which `what` states.
    Entry { table: &'static str, at: usize, what: &'static str },
}

impl TableError {
    /// An entry breaks a rule, which `what` states.
    #[inline]
    fn entry(table: &'static str, at: usize, what: &'static str) -> Self {
        Self(Kind::Entry { table, at, what })
    }
}

impl fmt::Display for TableError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            Kind::Length { table, found, expected } => {
                write!(f, "`{table}` has {found} entries, not {expected}")
            }
            Kind::Limit { table, at, found, limit } => {
                write!(f, "`{table}`, entry {at}: {found} is not less than {limit}")
            }
            Kind::Entry { table, at, what } => write!(f, "`{table}`, entry {at}: {what}"),
        }
    }
}

impl core::error::Error for TableError {}

type Result<T = ()> = core::result::Result<T, TableError>;

/// Whether `tables` are an automaton.
#[inline]
pub(super) fn automaton(tables: &Tables) -> Result {
    ends(tables)?;
    transitions(tables)?;
    guards(tables)?;
    successors(tables)?;
    distances(tables)
}

/// Whether a table has as many entries as it should have.
#[inline]
pub(crate) fn length(table: &'static str, found: usize, expected: usize) -> Result {
    if found == expected {
        Ok(())
    } else {
        Err(TableError(Kind::Length { table, found, expected }))
    }
}

/// Whether an index is below the limit.
#[inline]
pub(crate) fn limit_of(table: &'static str, at: usize, found: u64, limit: usize) -> Result {
    let limit = limit as u64;
    if found < limit { Ok(()) } else { Err(TableError(Kind::Limit { table, at, found, limit })) }
}

/// Whether all entries of a table are below the limit.
#[inline]
fn all_below(table: &'static str, entries: &[u32], limit: u32) -> Result {
    let mut entries = entries.iter().enumerate();
    entries.try_for_each(|(at, &found)| limit_of(table, at, found.into(), limit as usize))
}

/// There are states, and the two ends are states, not the same one.
#[inline]
fn ends(tables: &Tables) -> Result {
    let Tables { states, accepting, trap, .. } = *tables;
    limit_of("states", 0, 0, states as usize)?;
    // A state and a leaf of a diagram share the 32 bits of a reference.
    limit_of("states", 0, states.into(), Transitions::LEAF as usize)?;
    all_below("accepting", accepting.as_slice(), states)?;
    all_below("trap", trap.as_slice(), states)?;
    if accepting.is_some() && accepting == trap {
        return Err(TableError::entry("trap", 0, "the accepting state is not the trap"));
    }
    Ok(())
}

/// δ is total and leads to states: a dense table has an entry for each state and class, and a class
/// for each valuation; in a diagram every node refers to states and to nodes before it.
#[inline]
fn transitions(tables: &Tables) -> Result {
    let (states, propositions) = (tables.states, tables.propositions.len());
    match &tables.transitions {
        Transitions::Table { class, width, next } => {
            // The number of valuations must be a number; a table of them is never that long.
            limit_of("propositions", 0, propositions as u64, usize::BITS as usize)?;
            length("class", class.len(), 1 << propositions)?;
            for (at, &class) in class.iter().enumerate() {
                limit_of("class", at, class.into(), *width as usize)?;
            }
            length("next", next.len(), (states as usize).saturating_mul(*width as usize))?;
            all_below("next", next, states)
        }
        Transitions::Diagram { nodes, roots } => {
            let reference = |table, at, found: u32, nodes: usize| match found < Transitions::LEAF {
                true => limit_of(table, at, found.into(), nodes),
                false => limit_of(table, at, (found - Transitions::LEAF).into(), states as usize),
            };
            for (at, &[proposition, low, high]) in nodes.iter().enumerate() {
                limit_of("nodes", at, proposition.into(), propositions)?;
                // Children come before their parents, so every walk ends.
                reference("nodes", at, low, at)?;
                reference("nodes", at, high, at)?;
            }
            length("roots", roots.len(), states as usize)?;
            let mut roots = roots.iter().enumerate();
            roots.try_for_each(|(at, &root)| reference("roots", at, root, nodes.len()))
        }
    }
}

/// The offsets lead to edges and guards, the literals to propositions, and every guard is a sequence
/// of cubes, each with a 0 after it.
#[inline]
fn guards(tables: &Tables) -> Result {
    let Tables { edges, targets, guards, literals, .. } = tables;
    let states = tables.states as usize;
    offsets("edges", edges, states, targets.len())?;
    offsets("guards", guards, states + targets.len(), literals.len())?;
    for (at, &end) in guards.iter().enumerate() {
        // Where one guard ends a cube does: also a guard without cubes, after another guard.
        if end > 0 && literals[end as usize - 1] != 0 {
            return Err(TableError::entry("guards", at, "a guard ends with a 0, as its cubes do"));
        }
    }
    for (at, &literal) in literals.iter().enumerate().filter(|(_, literal)| **literal != 0) {
        let proposition = u64::from(literal.unsigned_abs()) - 1;
        limit_of("literals", at, proposition, tables.propositions.len())?;
    }
    Ok(())
}

/// Offsets of `items` items in a table of `end` entries: from 0 to `end` without a fall, so that the
/// range of every item lies in the table.
#[inline]
fn offsets(table: &'static str, offsets: &[u32], items: usize, end: usize) -> Result {
    length(table, offsets.len(), items + 1)?;
    let falls = offsets.windows(2).position(|pair| pair[0] > pair[1]);
    if let Some(at) = falls {
        return Err(TableError::entry(table, at + 1, "offsets do not fall"));
    }
    let (first, last) = (offsets[0] as usize, offsets[items] as usize);
    if first != 0 {
        return Err(TableError::entry(table, 0, "offsets begin at 0"));
    }
    if last != end {
        return Err(TableError::entry(table, items, "the last offset is the end"));
    }
    Ok(())
}

/// The edges are those of δ, and the ends have a self-loop only: an episode that has ended stays so.
#[inline]
fn successors(tables: &Tables) -> Result {
    let mut leaves = Leaves::new(tables);
    for q in 0..tables.states {
        let at = q as usize;
        let targets = &tables.targets[tables.edges[at] as usize..tables.edges[at + 1] as usize];
        if leaves.of(q) != targets {
            let what = "the targets of a state are the states that it moves to, ascending";
            return Err(TableError::entry("edges", at, what));
        }
        let is_end = tables.accepting == Some(q) || tables.trap == Some(q);
        if is_end && targets != [q] {
            let what = "the accepting state and the trap have a self-loop only";
            return Err(TableError::entry("edges", at, what));
        }
    }
    Ok(())
}

/// Finds the states that δ leads to: those of one row of a table, those that a state's root reaches in
/// a diagram. Every node is visited once for each state, O(states × nodes) in all.
struct Leaves<'a> {
    tables: &'a Tables,
    /// For each node the last state (plus 1) from which it was met, so that nothing is cleared between
    /// two states.
    met: Vec<u32>,
    found: Vec<u32>,
}

impl<'a> Leaves<'a> {
    #[inline]
    fn new(tables: &'a Tables) -> Self {
        let nodes = match &tables.transitions {
            Transitions::Table { .. } => 0,
            Transitions::Diagram { nodes, .. } => nodes.len(),
        };
        Self { tables, met: alloc::vec![0; nodes], found: Vec::new() }
    }

    /// The states that `q` moves to under some valuation, ascending.
    #[inline]
    fn of(&mut self, q: u32) -> &[u32] {
        self.found.clear();
        match &self.tables.transitions {
            Transitions::Table { width, next, .. } => {
                let width = *width as usize;
                self.found.extend_from_slice(&next[q as usize * width..][..width]);
            }
            Transitions::Diagram { nodes, roots } => {
                let mut open = alloc::vec![roots[q as usize]];
                while let Some(reference) = open.pop() {
                    if reference >= Transitions::LEAF {
                        self.found.push(reference - Transitions::LEAF);
                        continue;
                    }
                    let met = &mut self.met[reference as usize];
                    if core::mem::replace(met, q + 1) != q + 1 {
                        let [_, low, high] = nodes[reference as usize];
                        open.extend([low, high]);
                    }
                }
            }
        }
        self.found.sort_unstable();
        self.found.dedup();
        &self.found
    }
}

/// The accepting state is at 0, and every other state is one move farther than the nearest state that
/// it moves to. Only the distance has this property, so nothing is computed to compare with: along
/// the nearest states it falls to 0 in as many moves as it says, and along no way can it fall
/// faster.
#[inline]
fn distances(tables: &Tables) -> Result {
    let Tables { edges, targets, distance, .. } = tables;
    length("distance", distance.len(), tables.states as usize)?;
    for (q, &found) in distance.iter().enumerate() {
        let next = targets[edges[q] as usize..edges[q + 1] as usize].iter();
        let nearest = next.map(|&to| distance[to as usize]).min().unwrap_or(u32::MAX);
        let expected = match tables.accepting == Some(q as u32) {
            true => 0,
            false => nearest.saturating_add(1),
        };
        if found != expected {
            return Err(TableError::entry(
                "distance",
                q,
                "not the distance to the accepting state",
            ));
        }
    }
    Ok(())
}

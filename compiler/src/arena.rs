//! Walks over arenas of ids, and maps from ids to ids.
//!
//! Expressions, conditions, terms, formulas and nodes of diagrams are all stored the same way: in a
//! vector, operands before the operators that use them, and known by an index that is a type of its
//! own. Equal entries are stored once (hash-consing; Filliâtre and Conchon, "Type-Safe Modular
//! Hash-Consing", 2006), so equality is equality of indices. That gives three things: a pass is a
//! loop over the vector and never recurses on what an author nested; a memo of a pass is a vector
//! or a [`Memo`]; dropping is flat.
//!
//! The walks here take plain numbers, so that each exists once in the binary rather than once for
//! each type of id.

use std::marker::PhantomData;

use crate::intern::{Index, hash_of_word};

/// A type that is a number: an index into an arena.
pub(crate) trait Id: Copy {
    /// The id of this number.
    fn new(number: u32) -> Self;
    /// The number of this id.
    fn number(self) -> u32;
}

impl Id for u32 {
    fn new(number: u32) -> Self {
        number
    }

    fn number(self) -> u32 {
        self
    }
}

/// Implements [`Id`] for a tuple struct of one `u32`.
macro_rules! id {
    ($id:ident) => {
        impl crate::arena::Id for $id {
            fn new(number: u32) -> Self {
                Self(number)
            }

            fn number(self) -> u32 {
                self.0
            }
        }
    };
}
pub(crate) use id;

/// A key of a [`Memo`]: one id, or two, packed into 64 bits without loss.
pub(crate) trait Key {
    /// The key as a number; different keys have different numbers.
    fn key(self) -> u64;
}

impl<A: Id> Key for A {
    fn key(self) -> u64 {
        self.number().into()
    }
}

impl<A: Id, B: Id> Key for (A, B) {
    fn key(self) -> u64 {
        u64::from(self.0.number()) << 32 | u64::from(self.1.number())
    }
}

/// A map from ids, or pairs of them, to ids.
///
/// Different keys have different hashes, so there is nothing to compare. `PhantomData<fn(K) -> V>`
/// keeps the map `Send` and `Sync` for all ids.
#[derive(Clone, Debug)]
pub(crate) struct Memo<K, V> {
    keys: Index,
    values: Vec<u32>,
    kinds: PhantomData<fn(K) -> V>,
}

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self { keys: Index::default(), values: Vec::new(), kinds: PhantomData }
    }
}

impl<K: Key, V: Id> Memo<K, V> {
    /// The value of `key`.
    pub(crate) fn get(&self, key: K) -> Option<V> {
        let place = self.keys.find(hash_of_word(key.key()), |_| true)?;
        Some(V::new(self.values[place as usize]))
    }

    /// Sets the value of `key`; an old one is replaced.
    pub(crate) fn insert(&mut self, key: K, value: V) {
        let place = self.place(key, value);
        self.values[place] = value.number();
    }

    /// The value of `key`; it becomes `fresh` if there is none. A caller that passes the next free
    /// number sees from the result whether the key was new.
    pub(crate) fn get_or_insert(&mut self, key: K, fresh: V) -> V {
        let place = self.place(key, fresh);
        V::new(self.values[place])
    }

    /// The place of `key`, which is added with the value `fresh` if there is none.
    fn place(&mut self, key: K, fresh: V) -> usize {
        let hash = hash_of_word(key.key());
        let known = self.keys.find(hash, |_| true);
        let place = known.unwrap_or_else(|| {
            self.values.push(fresh.number());
            self.keys.add(hash)
        });
        place as usize
    }
}

/// Ids that have been met.
#[derive(Clone, Debug, Default)]
pub(crate) struct Seen(Index);

impl Seen {
    /// Notes an id. Returns whether it is new.
    pub(crate) fn insert(&mut self, id: impl Id) -> bool {
        let hash = hash_of_word(id.number().into());
        let is_new = self.0.find(hash, |_| true).is_none();
        if is_new {
            self.0.add(hash);
        }
        is_new
    }
}

/// All ids that `roots` are made of, the roots included, rising. `operands` adds those of one id
/// and is called once for each.
///
/// Operands stand first in every arena, so the result is in the order in which a pass can go.
pub(crate) fn needed(roots: Vec<u32>, operands: &mut dyn FnMut(u32, &mut Vec<u32>)) -> Vec<u32> {
    let (mut seen, mut needed) = (Seen::default(), Vec::new());
    let mut open = roots;
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            needed.push(id);
            operands(id, &mut open);
        }
    }
    needed.sort_unstable();
    needed
}

/// Groups things that share ties, directly or by way of others: the connected components. The
/// result holds places in `ties`, in each group rising, and the groups by their first place.
///
/// Union–find (Galler and Fischer, 1964) with path halving; the smaller place always becomes the
/// root, which gives the order for free. Linking by rank would bring nothing: groups are of the
/// size of one formula.
pub(crate) fn groups(ties: &[Vec<u32>]) -> Vec<Vec<usize>> {
    // Each place points to an earlier one of its group; the first, to itself.
    let mut earlier: Vec<usize> = (0..ties.len()).collect();
    let mut holders: Memo<u32, u32> = Memo::default();
    for (place, ties) in ties.iter().enumerate() {
        for &tie in ties {
            let holder = holders.get_or_insert(tie, place as u32) as usize;
            let (a, b) = (first(&mut earlier, holder), first(&mut earlier, place));
            // The earlier place becomes the root: groups then come out in the order of their first
            // places.
            earlier[a.max(b)] = a.min(b);
        }
    }
    let mut groups: Vec<Vec<usize>> = vec![Vec::new(); ties.len()];
    for place in 0..ties.len() {
        groups[first(&mut earlier, place)].push(place);
    }
    groups.retain(|group| !group.is_empty());
    groups
}

/// The first place of the group of `place`; halves the path to it.
fn first(earlier: &mut [usize], mut place: usize) -> usize {
    while earlier[place] != place {
        earlier[place] = earlier[earlier[place]];
        place = earlier[place];
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arena_is_walked_once() {
        let mut walked = Vec::new();
        let found = needed(vec![6, 3], &mut |id, open| {
            walked.push(id);
            open.extend([id / 2, id / 3]);
        });
        assert_eq!(found, [0, 1, 2, 3, 6]);
        walked.sort_unstable();
        assert_eq!(walked, found);
    }

    #[test]
    fn what_shares_a_tie_is_one_group() {
        let ties = [vec![1], vec![], vec![2, 3], vec![1, 4], vec![3], vec![4, 2], vec![5]];
        assert_eq!(groups(&ties), [vec![0, 2, 3, 4, 5], vec![1], vec![6]]);
        assert!(groups(&[]).is_empty());
    }
}

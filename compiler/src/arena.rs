//! Walks over arenas of ids, and maps from ids to ids.

use std::marker::PhantomData;

use rustc_hash::{FxHashMap, FxHashSet};

/// The number of a thing.
pub(crate) trait Id: Copy {
    fn new(number: u32) -> Self;
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

/// Makes an id of a type that is a number.
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

/// One id, or two.
pub(crate) trait Key {
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

/// A map from ids, or pairs of them, to ids. Of whatever kinds these are, one type of table is
/// behind it, for each more would be built into every crate that uses the macros.
#[derive(Clone, Debug)]
pub(crate) struct Memo<K, V> {
    known: FxHashMap<u64, u32>,
    kinds: PhantomData<fn(K) -> V>,
}

impl<K, V> Default for Memo<K, V> {
    fn default() -> Self {
        Self { known: FxHashMap::default(), kinds: PhantomData }
    }
}

impl<K: Key, V: Id> Memo<K, V> {
    pub(crate) fn get(&self, key: K) -> Option<V> {
        self.known.get(&key.key()).map(|&number| V::new(number))
    }

    pub(crate) fn insert(&mut self, key: K, value: V) {
        self.known.insert(key.key(), value.number());
    }

    /// The value of `key`, which becomes `fresh` if there is none.
    pub(crate) fn get_or_insert(&mut self, key: K, fresh: V) -> V {
        V::new(*self.known.entry(key.key()).or_insert(fresh.number()))
    }

    pub(crate) fn len(&self) -> usize {
        self.known.len()
    }
}

/// All ids that `roots` are made of, these among them, rising; `operands` adds those of one id.
pub(crate) fn needed(roots: Vec<u32>, operands: &mut dyn FnMut(u32, &mut Vec<u32>)) -> Vec<u32> {
    let mut seen = FxHashSet::default();
    let mut open = roots;
    while let Some(id) = open.pop() {
        if seen.insert(id) {
            operands(id, &mut open);
        }
    }
    let mut needed: Vec<u32> = seen.into_iter().collect();
    needed.sort_unstable();
    needed
}

/// The things that share ties, directly or by way of others: groups of places in `ties`, by their
/// first place, each rising.
pub(crate) fn groups(ties: &[Vec<u32>]) -> Vec<Vec<usize>> {
    // Each place points to an earlier one of its group; the first, to itself.
    let mut earlier: Vec<usize> = (0..ties.len()).collect();
    let mut holders: Memo<u32, u32> = Memo::default();
    for (place, ties) in ties.iter().enumerate() {
        for &tie in ties {
            let holder = holders.get_or_insert(tie, place as u32) as usize;
            let (a, b) = (first(&mut earlier, holder), first(&mut earlier, place));
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

/// The first place of the group of `place`.
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

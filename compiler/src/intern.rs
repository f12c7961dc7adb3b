//! Things known by numbers: the hash tables of the compiler.
//!
//! An [`Interner`] stores each thing once and numbers things in the order in which they come; a
//! [`Map`] has a value beside each. Both keep the things in a vector and find them through an
//! [`Index`], which knows hashes and numbers only. So one table serves all types: the tables of the
//! standard library, one for each type of key, were a tenth of the code that rustc made of this
//! crate, and every user of the macros compiles it.
//!
//! Everything is in the order in which it came, never in that of hashes.

use std::borrow::Borrow;
use std::hash::{Hash, Hasher};

/// A hash table of numbers: 0 for the first thing, 1 for the next.
///
/// Open addressing with linear probing (Knuth, volume 3, 6.4), at most three quarters full. Hashes
/// are kept, so that growing hashes nothing again and most probes compare no things.
#[derive(Clone, Debug, Default)]
pub(crate) struct Index {
    /// A number or [`FREE`] in each slot; a power of two of them.
    slots: Vec<u32>,
    /// The hash of each thing.
    hashes: Vec<u64>,
}

/// A slot without a number.
const FREE: u32 = u32::MAX;

impl Index {
    /// The number of the thing of this hash that `is_it`.
    pub(crate) fn find(&self, hash: u64, is_it: impl Fn(u32) -> bool) -> Option<u32> {
        let mut slot = self.first(hash);
        loop {
            match *self.slots.get(slot)? {
                FREE => return None,
                number if self.hashes[number as usize] == hash && is_it(number) => {
                    return Some(number);
                }
                _ => slot = (slot + 1) & (self.slots.len() - 1),
            }
        }
    }

    /// Adds a thing that is not there yet, and returns its number.
    pub(crate) fn add(&mut self, hash: u64) -> u32 {
        let number = self.hashes.len() as u32;
        assert!(number < FREE, "fewer than 2^32 of a kind");
        self.hashes.push(hash);
        if self.hashes.len() * 4 > self.slots.len() * 3 {
            self.slots = vec![FREE; (self.slots.len() * 2).max(8)];
            (0..number).for_each(|number| self.place(number));
        }
        self.place(number);
        number
    }

    /// The slot at which a hash is looked for first: its upper bits, which depend on all that was
    /// hashed.
    fn first(&self, hash: u64) -> usize {
        let bits = self.slots.len().trailing_zeros();
        (hash >> 32) as usize >> (32 - bits.min(32))
    }

    /// Puts a number into the first slot that is free.
    fn place(&mut self, number: u32) {
        let mut slot = self.first(self.hashes[number as usize]);
        while self.slots[slot] != FREE {
            slot = (slot + 1) & (self.slots.len() - 1);
        }
        self.slots[slot] = number;
    }
}

/// The hash of Firefox and rustc (FxHash): fast, and good enough where nobody gains by collisions.
#[derive(Default)]
struct Fx(u64);

/// ⌊2^64 / φ⌋, made odd: multiplication by it spreads low bits to the top (Knuth, volume 3, 6.4).
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

impl Hasher for Fx {
    fn finish(&self) -> u64 {
        self.0
    }

    /// By index, not by chunks: macros run without optimization, where each call of an iterator
    /// costs more than a word.
    fn write(&mut self, bytes: &[u8]) {
        let mut at = 0;
        while at + 8 <= bytes.len() {
            let [a, b, c, d] = [bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]];
            let [e, f, g, h] = [bytes[at + 4], bytes[at + 5], bytes[at + 6], bytes[at + 7]];
            self.write_u64(u64::from_le_bytes([a, b, c, d, e, f, g, h]));
            at += 8;
        }
        while at < bytes.len() {
            self.write_u64(bytes[at].into());
            at += 1;
        }
    }

    fn write_u8(&mut self, byte: u8) {
        self.write_u64(byte.into());
    }

    fn write_u32(&mut self, number: u32) {
        self.write_u64(number.into());
    }

    fn write_u64(&mut self, word: u64) {
        self.0 = hash_of_word(self.0.rotate_left(5) ^ word);
    }

    fn write_usize(&mut self, number: usize) {
        self.write_u64(number as u64);
    }
}

/// The hash of 64 bits; no two words have the same.
pub(crate) fn hash_of_word(word: u64) -> u64 {
    word.wrapping_mul(GOLDEN)
}

/// The hash of anything.
pub(crate) fn hash_of<T: Hash + ?Sized>(thing: &T) -> u64 {
    let mut hasher = Fx::default();
    thing.hash(&mut hasher);
    hasher.finish()
}

/// Things of which equal ones are stored once.
#[derive(Clone, Debug)]
pub(crate) struct Interner<T> {
    things: Vec<T>,
    index: Index,
}

impl<T> Default for Interner<T> {
    fn default() -> Self {
        Self { things: Vec::new(), index: Index::default() }
    }
}

impl<T: Hash + Eq> Interner<T> {
    /// The number of a thing.
    pub(crate) fn find<Q: Hash + Eq + ?Sized>(&self, thing: &Q) -> Option<u32>
    where
        T: Borrow<Q>,
    {
        self.index.find(hash_of(thing), |number| self.things[number as usize].borrow() == thing)
    }

    /// The number of a thing, which is added if it is new.
    pub(crate) fn intern(&mut self, thing: T) -> u32 {
        let hash = hash_of(&thing);
        let known = self.index.find(hash, |number| self.things[number as usize] == thing);
        known.unwrap_or_else(|| {
            self.things.push(thing);
            self.index.add(hash)
        })
    }

    /// The things by number.
    pub(crate) fn things(&self) -> &[T] {
        &self.things
    }

    /// The things by number, no longer indexed.
    pub(crate) fn into_things(self) -> Vec<T> {
        self.things
    }
}

/// A value for each of some keys.
#[derive(Clone, Debug)]
pub(crate) struct Map<K, V> {
    keys: Interner<K>,
    values: Vec<V>,
}

impl<K, V> Default for Map<K, V> {
    fn default() -> Self {
        Self { keys: Interner::default(), values: Vec::new() }
    }
}

impl<K: Hash + Eq, V> Map<K, V> {
    /// The value of a key.
    pub(crate) fn get<Q: Hash + Eq + ?Sized>(&self, key: &Q) -> Option<&V>
    where
        K: Borrow<Q>,
    {
        self.keys.find(key).map(|number| &self.values[number as usize])
    }

    /// The value of a key; it becomes `fresh` if there is none.
    pub(crate) fn get_or_insert(&mut self, key: K, fresh: V) -> &mut V {
        let number = self.keys.intern(key) as usize;
        if number == self.values.len() {
            self.values.push(fresh);
        }
        &mut self.values[number]
    }
}

/// The places of some keys in rising order, those of equal keys as they stand. One sort serves all:
/// each further type that is sorted is a half percent of the code of this crate.
pub(crate) fn order(keys: impl Iterator<Item = (usize, usize)>) -> Vec<usize> {
    let mut places: Vec<((usize, usize), usize)> = Vec::new();
    for key in keys {
        places.push((key, places.len()));
    }
    places.sort_unstable();
    places.into_iter().map(|(_, place)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    /// Against a map of the standard library, with many collisions of slots and hashes.
    #[test]
    fn what_was_interned_is_found() {
        let mut map = Map::default();
        let mut expected = BTreeMap::new();
        let mut random = 1_u64;
        for step in 0..5_000_u32 {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let key = format!("{:x}", random >> 54);
            assert_eq!(map.get(key.as_str()), expected.get(&key));
            assert_eq!(*map.get_or_insert(key.clone(), step), *expected.entry(key).or_insert(step));
        }
        assert_eq!(map.keys.things().len(), expected.len());
    }

    #[test]
    fn equal_keys_keep_their_order() {
        assert_eq!(order([(2, 0), (1, 5), (2, 0), (1, 4)].into_iter()), [3, 1, 0, 2]);
    }

    #[test]
    fn equal_hashes_are_told_apart() {
        let mut index = Index::default();
        let numbers: Vec<u32> = (0..100).map(|_| index.add(7)).collect();
        for number in numbers {
            assert_eq!(index.find(7, |known| known == number), Some(number));
        }
        assert_eq!(index.find(8, |_| true), None);
    }
}

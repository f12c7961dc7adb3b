//! Numbers for slices: equal ones get the same number.
//!
//! Transition tables, matrices of probabilities and joint states are hash-consed by it. The numbers
//! are handed out in the order in which slices come first, so the same input gives the same numbers,
//! which a hash map with a random state would not promise.

use alloc::vec::Vec;

/// Slices, numbered in the order in which they came first.
///
/// A hash table with linear probing, for `alloc` has none; at most half full, so a look-up tries two
/// slots in the mean. The hash is that of Firefox (rotate, xor, multiply), which needs no key: what
/// is hashed is the user's own world.
///
/// A number is never taken back: nothing is removed, so an item keeps its number while others come.
/// Hostile input could make all items collide, which costs time and nothing else.
pub(crate) struct Interner<T> {
    items: Vec<Vec<T>>,
    /// The number of an item, near the place that its hash says; a power of two of them, of which
    /// at most half are taken.
    slots: Vec<u32>,
}

impl<T: Copy + Eq + Into<u64>> Interner<T> {
    const FREE: u32 = u32::MAX;

    pub(crate) const fn new() -> Self {
        Self { items: Vec::new(), slots: Vec::new() }
    }

    /// The slices, in the order of their numbers.
    pub(crate) fn items(&self) -> &[Vec<T>] {
        &self.items
    }

    /// The number of `item`, new or not.
    pub(crate) fn number(&mut self, item: &[T]) -> u32 {
        if 2 * self.items.len() >= self.slots.len() {
            self.grow();
        }
        let slot = self.slot(item);
        if self.slots[slot] == Self::FREE {
            self.slots[slot] = self.items.len() as u32;
            self.items.push(item.to_vec());
        }
        self.slots[slot]
    }

    /// The slot of `item`, or a free one for it.
    fn slot(&self, item: &[T]) -> usize {
        let mut hash: u64 = 0;
        for &part in item {
            hash = (hash.rotate_left(5) ^ part.into()).wrapping_mul(0x517c_c1b7_2722_0a95);
        }
        let mut slot = (hash >> 32) as usize;
        loop {
            slot &= self.slots.len() - 1;
            let number = self.slots[slot];
            if number == Self::FREE || self.items[number as usize] == item {
                return slot;
            }
            slot += 1;
        }
    }

    /// Doubles the slots: each item is moved a constant number of times in the mean.
    fn grow(&mut self) {
        self.slots = alloc::vec![Self::FREE; (2 * self.slots.len()).max(16)];
        for (number, item) in self.items.iter().enumerate() {
            let slot = self.slot(item);
            self.slots[slot] = number as u32;
        }
    }
}

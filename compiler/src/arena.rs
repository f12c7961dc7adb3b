//! Walks over arenas of ids.

use rustc_hash::{FxHashMap, FxHashSet};

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
    let mut holders = FxHashMap::default();
    for (place, ties) in ties.iter().enumerate() {
        for &tie in ties {
            let holder = *holders.entry(tie).or_insert(place as u32) as usize;
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

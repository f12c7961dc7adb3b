//! Many seeds on the cores that there are.
//!
//! One seed tells little of a learner; studies run twenty or a hundred. Each seed is one task for a
//! thread, taken from a counter, so uneven seeds do not leave cores idle.

use core::num::NonZero;
use core::ops::Range;
use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::Mutex;
use std::thread;
use std::vec::Vec;

/// Runs `work` once for each seed, on as many threads as there are cores; the results are in the
/// order of the seeds, whichever thread found them.
///
/// ```
/// assert_eq!(tltl::learn::seeds(3..6, |seed| seed * seed), [9, 16, 25]);
/// ```
///
/// # Panics
/// If `work` does.
pub fn seeds<T: Send>(seeds: Range<u64>, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    seeds_on(thread::available_parallelism().unwrap_or(NonZero::<usize>::MIN), seeds, work)
}

/// [`seeds`] on at most so many threads. The results do not depend on how many there are, as long as `work`
/// depends on the seed alone.
///
/// ```
/// use std::num::NonZero;
///
/// use tltl::learn::{seeds, seeds_on};
///
/// let square = |seed| seed * seed;
/// assert_eq!(seeds_on(NonZero::new(2).unwrap(), 3..6, square), seeds(3..6, square));
/// ```
///
/// # Panics
/// If `work` does.
pub fn seeds_on<T: Send>(
    threads: NonZero<usize>,
    seeds: Range<u64>,
    work: impl Fn(u64) -> T + Sync,
) -> Vec<T> {
    let count = seeds.end.saturating_sub(seeds.start) as usize;
    let results: Vec<Mutex<Option<T>>> = (0..count).map(|_| Mutex::new(None)).collect();
    let next = AtomicU64::new(seeds.start);
    let run = || {
        loop {
            // Only the counter is shared; results become visible when the threads are joined.
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds.end {
                return;
            }
            let result = work(seed);
            if let Ok(mut slot) = results[(seed - seeds.start) as usize].lock() {
                *slot = Some(result);
            }
        }
    };
    let threads = threads.get().min(count);
    thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(run))));
    let taken = results.into_iter().filter_map(|slot| slot.into_inner().ok().flatten());
    taken.collect()
}

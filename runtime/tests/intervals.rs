//! Confidence intervals: their values, and that they hold what they promise, by exact sums over all
//! that can be seen, or by simulation with a bound on how often a right interval may fail it.

use tltl::estimate::{Interval, Tally, Trials};
use tltl::rand::{RngExt as _, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::End;

fn near(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-12 + 1e-11 * expected.abs(), "{value}, not {expected}");
}

/// Values to 15 digits, from 25-digit arithmetic (mpmath), and closed forms.
#[test]
fn intervals_are_those_of_the_tables() {
    let exact = [
        (0, 10, 0.95, 0.0, 0.308_497_107_818_761),
        (3, 10, 0.95, 0.066_739_511_177_734_5, 0.652_452_850_059_997),
        (98, 100, 0.95, 0.929_616_067_528_93, 0.997_568_663_176_057),
        (7, 20, 0.99, 0.113_879_763_266_732, 0.656_568_584_231_921),
        (0, 1_000_000, 0.95, 0.0, 1.0 - 0.025_f64.powf(1e-6)),
        (1_000_000, 1_000_000, 0.95, 0.025_f64.powf(1e-6), 1.0),
    ];
    for (hits, trials, confidence, low, high) in exact {
        let interval = Interval::exact(hits, trials, confidence);
        near(interval.low, low);
        near(interval.high, high);
    }
    let anytime = [
        (0, 10, 0.95, 0.0, 0.376_987_350_990_677),
        (3, 10, 0.95, 0.032_515_139_788_059, 0.747_587_109_914_997),
        (98, 100, 0.95, 0.895_321_393_873_014, 0.999_524_726_605_564),
        (7, 20, 0.99, 0.073_188_606_552_509_4, 0.731_724_160_266_015),
    ];
    for (hits, trials, confidence, low, high) in anytime {
        let interval = Interval::anytime(hits, trials, confidence);
        near(interval.low, low);
        near(interval.high, high);
    }
    let student = [
        (1, 0.95, 12.706_204_736_174_7),
        (2, 0.95, 4.302_652_729_749_46),
        (10, 0.95, 2.228_138_851_986_27),
        (19, 0.99, 2.860_934_606_464_98),
    ];
    for (degrees, confidence, expected) in student {
        // Values of variance 1 and mean 0: the half width is t / √n.
        let n = degrees + 1;
        let interval = Interval::student(n, 0.0, degrees as f64, confidence).unwrap();
        near(interval.high * (n as f64).sqrt(), expected);
    }
}

/// P(k hits in n trials) for all k, by one product each.
fn binomial(n: u64, p: f64) -> Vec<f64> {
    let choose = |k: u64| (0..k).map(|i| (n - i) as f64 / (k - i) as f64).product::<f64>();
    (0..=n).map(|k| choose(k) * p.powi(k as i32) * (1.0 - p).powi((n - k) as i32)).collect()
}

/// Each end errs with at most half of the rest, for every probability, and with all of it at the end
/// itself: no shorter interval of this kind holds.
#[test]
fn exact_intervals_hold_exactly() {
    for (n, confidence) in [(1, 0.5), (5, 0.9), (20, 0.95), (60, 0.99)] {
        let tail = 0.5 * (1.0 - confidence);
        let intervals: Vec<_> = (0..=n).map(|k| Interval::exact(k, n, confidence)).collect();
        for p in (0..=200).map(|i| f64::from(i) / 200.0) {
            let chance = |misses: fn(&Interval, f64) -> bool| {
                let all = binomial(n, p).into_iter().zip(&intervals);
                all.filter(|(_, seen)| misses(seen, p)).map(|(chance, _)| chance).sum::<f64>()
            };
            assert!(chance(|seen, p| p < seen.low) <= tail + 1e-12, "n = {n}, p = {p}");
            assert!(chance(|seen, p| p > seen.high) <= tail + 1e-12, "n = {n}, p = {p}");
        }
        for k in 1..=n {
            near(binomial(n, intervals[k as usize].low)[k as usize..].iter().sum(), tail);
        }
    }
}

/// P(some interval of the first n misses p), by following all counts of hits at once, and the same of
/// intervals that were made for one look.
#[test]
fn anytime_intervals_hold_at_all_times() {
    let missed = |interval: fn(u64, u64, f64) -> Interval, p: f64| {
        let (mut chance, mut missed) = (vec![1.0], 0.0);
        for n in 1..=150_usize {
            let mut next = vec![0.0; n + 1];
            for (k, &mass) in chance.iter().enumerate() {
                next[k] += mass * (1.0 - p);
                next[k + 1] += mass * p;
            }
            for (k, mass) in next.iter_mut().enumerate() {
                let Interval { low, high, .. } = interval(k as u64, n as u64, 0.9);
                if !(low <= p && p <= high) {
                    missed += core::mem::take(mass);
                }
            }
            chance = next;
        }
        missed
    };
    for p in [0.02, 0.3, 0.5, 0.9] {
        let chance = missed(Interval::anytime, p);
        // At most α; but not nothing, or they would be wider than they need be.
        assert!(chance < 0.1 && chance > 0.01, "p = {p}: {chance}");
    }
    assert!(missed(Interval::exact, 0.5) > 0.25, "one look after another is not one look");
}

/// 200 streams of 400 episodes, a look after each. If the intervals hold in 95 % of streams, more
/// than 28 miss with probability below 1e-6.
#[test]
fn means_hold_at_all_times() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let trials = Trials::default().with_horizon(20).unwrap();
    let mut missed = 0;
    for _ in 0..200 {
        let mut tally = Tally::new(trials);
        // Two steps, or twenty one time in four: 6.5 in the mean. One in three fails.
        let holds = (0..400).all(|_| {
            let steps = if rng.random_range(0..4) == 0 { 20 } else { 2 };
            tally.count((rng.random_range(0..3) > 0).then_some(End::Accepted), steps);
            tally.anytime().steps.is_none_or(|seen| seen.low <= 6.5 && 6.5 <= seen.high)
        });
        let last = tally.anytime().steps.unwrap();
        assert!(!holds || last.high - last.low < 6.0, "{last:?}");
        missed += u32::from(!holds);
    }
    assert!(missed <= 28, "{missed}");
}

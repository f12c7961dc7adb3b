//! A first policy where steps cost something: as if all went well.
//!
//! The search of Dijkstra (1959) from the exits, over steps that cost c / p where p is the probability that an
//! action leads on. The policy that it gives leaves in the end, for each pair's action may lead to one that was
//! found before; and it knows which exit is near, all costs considered, which improving it step by step would
//! take long to find in a wide world.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Reverse;

use super::Rule;
use super::component::Component;

/// The pairs of positive `costs` in the order of what they cost, and an action for each; what cannot reach a
/// `good` exit comes last.
#[inline]
pub(super) fn cheapest(
    component: &Component<'_>,
    rule: &Rule<'_>,
    good: &[bool],
    costs: &[f64],
) -> (Vec<u32>, Vec<u32>) {
    let codes = component.codes();
    let (mut found, mut policy) = (alloc::vec![f64::INFINITY; codes], alloc::vec![0; codes]);
    let (mut order, mut queue) = (Vec::new(), BinaryHeap::new());
    let mut arrive = |found: &mut [f64], queue: &mut BinaryHeap<_>, arrival, worth: f64| {
        for (code, at) in component.before(arrival) {
            let cost = costs[component.pair(code)];
            if cost <= 0.0 || found[code as usize] <= worth {
                continue;
            }
            let outcomes = component.outcomes(code);
            let Ok(column) = outcomes.successors.binary_search(&at) else { continue };
            let all = component.allowed(rule, code).map(|a| (outcomes.row(a)[column], a));
            let best = all.reduce(|best, other| if other.0 > best.0 { other } else { best });
            let Some((p, a)) = best.filter(|(p, _)| *p > 0.0) else { continue };
            if worth + cost / p < found[code as usize] {
                (found[code as usize], policy[code as usize]) = (worth + cost / p, a as u32);
                // Positive numbers are in the order of their bits.
                queue.push(Reverse(((worth + cost / p).to_bits(), code)));
            }
        }
    };
    for (arrival, worth) in component.exits() {
        if good[arrival] {
            arrive(&mut found, &mut queue, arrival, worth);
        }
    }
    while let Some(Reverse((bits, code))) = queue.pop() {
        let worth = f64::from_bits(bits);
        if worth > found[code as usize] {
            continue;
        }
        order.push(code);
        component.entries(code).for_each(|arrival| arrive(&mut found, &mut queue, arrival, worth));
    }
    let positive = (0..codes as u32).filter(|&code| costs[component.pair(code)] > 0.0);
    order.extend(positive.filter(|&code| found[code as usize].is_infinite()));
    let first = order.iter().map(|&code| policy[code as usize]).collect();
    (order, first)
}

//! Ports: the points where edges touch nodes.
//!
//! Lines that meet a node at one point cannot be told apart. So each line touches the circle near
//! the height that it comes from, in the order of the neighbouring layer, and at a distance from
//! the next line.

use super::Graph;
use super::network::Network;
use super::place::rising;

/// The distance between two lines at a node, if there is room: about the width of an arrowhead.
const DISTANCE: f64 = 7.0;
/// The part of the radius that lines may touch: at the rim they would graze the circle.
const SPREAD: f64 = 0.86;
/// A line that climbs less than this is drawn to the middle, where it is straight.
const LEVEL: f64 = 12.0;
/// The part of its climb by which a line is drawn off the middle.
const PULL: f64 = 0.3;

/// For each link the two heights, below the anchors of its left and its right node, at which it
/// touches them.
pub(super) fn ports(graph: &Graph, network: &Network, y: &[f64]) -> Vec<[f64; 2]> {
    let mut ports = vec![[0.0; 2]; network.chains.len()];
    for side in [0, 1] {
        let mut at = vec![Vec::new(); graph.nodes.len()];
        for (link, chain) in network.chains.iter().enumerate() {
            let (node, next) = match side {
                0 => (chain[0], chain[1]),
                _ => (chain[chain.len() - 1], chain[chain.len() - 2]),
            };
            at[node].push((y[next] - y[node], link));
        }
        for mut lines in at {
            lines.sort_by(|a, b| a.0.total_cmp(&b.0));
            let climbs: Vec<f64> = lines.iter().map(|line| line.0).collect();
            for (&(_, link), port) in lines.iter().zip(spread(&climbs, graph.radius)) {
                ports[link][side] = port;
            }
        }
    }
    ports
}

/// The heights at a node for lines with these climbs, from top to bottom: isotonic regression
/// again, on each line's own wish.
fn spread(climbs: &[f64], radius: f64) -> Vec<f64> {
    let limit = SPREAD * radius;
    let gaps = climbs.len().saturating_sub(1) as f64;
    let distance = DISTANCE.min(2.0 * limit / gaps.max(1.0));
    let lowest = (limit - distance * gaps).max(-limit);
    let wish = |(i, climb): (usize, &f64)| {
        let pull = if climb.abs() < LEVEL { 0.0 } else { climb * PULL };
        (pull.clamp(-limit, limit) - distance * i as f64, 1.0)
    };
    let wishes: Vec<_> = climbs.iter().enumerate().map(wish).collect();
    let levels = rising(&wishes).into_iter().enumerate();
    levels.map(|(i, level)| level.clamp(-limit, lowest) + distance * i as f64).collect()
}

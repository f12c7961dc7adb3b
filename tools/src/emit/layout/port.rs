//! Where edges touch nodes.

use super::Graph;
use super::network::Network;
use super::place::rising;

/// Lines keep this distance at a node if there is room.
const DISTANCE: f64 = 7.0;
/// The part of a node's radius that lines may touch.
const SPREAD: f64 = 0.86;
/// A line that climbs less is drawn to the middle.
const LEVEL: f64 = 12.0;
/// How much a line that climbs is drawn off the middle.
const PULL: f64 = 0.3;

/// For each link how far below the anchors of its left and its right node it touches them: as near
/// as it can to where it comes from or goes to, in the order of the neighbouring layer.
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

/// Heights at a node for lines that climb so much, from top to bottom.
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

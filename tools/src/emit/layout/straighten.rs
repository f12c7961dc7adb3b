//! Last step: bends that no neighbour needs are taken out.
//!
//! Least squares spreads a height difference over all segments of a link, which draws it as a
//! staircase. One steep bend reads better than many flat ones, so the inner part of a link is made
//! level wherever its neighbours leave room.

use super::network::Network;
use super::place::distance;

/// Nodes whose heights differ by less are made level: the eye sees such a difference as an error.
const NEAR: f64 = 6.0;

/// Makes linked nodes that are nearly level exactly level, where their neighbours leave room.
pub(super) fn align(network: &Network, y: &mut [f64]) {
    let place = places(network);
    for chain in &network.chains {
        let ends = (chain[0], chain[chain.len() - 1]);
        if (y[ends.0] - y[ends.1]).abs() >= NEAR {
            continue;
        }
        for (moved, fixed) in [(ends.1, ends.0), ends] {
            let (low, high) = room(network, &place, &[moved], y);
            if (low..=high).contains(&y[fixed]) {
                y[moved] = y[fixed];
                break;
            }
        }
    }
}

/// The index of each vertex in its layer.
fn places(network: &Network) -> Vec<usize> {
    let mut places = vec![0; network.vertices.len()];
    for layer in &network.layers {
        layer.iter().enumerate().for_each(|(i, &vertex)| places[vertex] = i);
    }
    places
}

/// Makes the inner part of each link level where its neighbours leave room, at the height of one of
/// its ports if that is possible: then one bend is left, or none. A link that moves can make room
/// for another, hence three passes.
pub(super) fn straighten(network: &Network, ports: &[[f64; 2]], y: &mut [f64]) {
    let place = places(network);
    for _ in 0..3 {
        for (chain, port) in network.chains.iter().zip(ports) {
            let (Some(first), Some(last)) = (chain.first(), chain.last()) else { continue };
            let ends = [(*first, y[*first] + port[0]), (*last, y[*last] + port[1])];
            level_runs(network, &place, &chain[1..chain.len() - 1], ends, y);
        }
    }
}

/// Levels all inner vertices of a link at once; if they have no common height, the longest runs
/// that have one, from left to right.
fn level_runs(
    network: &Network,
    place: &[usize],
    inner: &[usize],
    mut ends: [(usize, f64); 2],
    y: &mut [f64],
) {
    let mut start = 0;
    while start < inner.len() {
        let fits = |end: &usize| {
            let (low, high) = room(network, place, &inner[start..*end], y);
            low <= high
        };
        let end = (start + 1..=inner.len()).take_while(fits).last().unwrap_or(start + 1);
        let run = &inner[start..end];
        let level = level(network, ends, room(network, place, run, y), mean(run, y));
        run.iter().for_each(|&vertex| y[vertex] = level);
        ends[0].1 = level;
        start = end;
    }
}

/// The mean height of some vertices.
fn mean(vertices: &[usize], y: &[f64]) -> f64 {
    vertices.iter().map(|&vertex| y[vertex]).sum::<f64>() / vertices.len() as f64
}

/// The least and the greatest height that all of `vertices` can have while their neighbours stay.
fn room(network: &Network, place: &[usize], vertices: &[usize], y: &[f64]) -> (f64, f64) {
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    for &vertex in vertices {
        let layer = &network.layers[network.vertices[vertex].layer];
        let apart = |a: usize, b: usize| distance(&network.vertices[a], &network.vertices[b]);
        if let Some(&above) = place[vertex].checked_sub(1).and_then(|i| layer.get(i)) {
            low = low.max(y[above] + apart(above, vertex));
        }
        if let Some(&below) = layer.get(place[vertex] + 1) {
            high = high.min(y[below] - apart(vertex, below));
        }
    }
    (low, high)
}

/// The height for a run: that of one of its ends, first of the one with fewer lines, where a bend
/// would be seen most; else the nearest to the present height.
fn level(network: &Network, mut ends: [(usize, f64); 2], (low, high): (f64, f64), now: f64) -> f64 {
    let lines = [network.vertices[ends[0].0].after.len(), network.vertices[ends[1].0].before.len()];
    if lines[1] <= lines[0] {
        ends.reverse();
    }
    let level = ends.into_iter().map(|(_, y)| y).find(|y| (low..=high).contains(y));
    level.unwrap_or(now.min(high).max(low))
}

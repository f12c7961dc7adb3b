//! Bends that are not needed are taken out.

use super::network::Network;
use super::place::distance;

/// Nodes whose heights differ less are put level.
const NEAR: f64 = 6.0;

/// Puts linked nodes that are nearly level quite level, where their neighbours leave room.
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

/// The place of each vertex in its layer.
fn places(network: &Network) -> Vec<usize> {
    let mut places = vec![0; network.vertices.len()];
    for layer in &network.layers {
        layer.iter().enumerate().for_each(|(i, &vertex)| places[vertex] = i);
    }
    places
}

/// Makes the inner part of each link level where its neighbours leave room, and, if it can, level
/// with where the link touches one of its nodes, so that one bend is left, or none.
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

/// Levels all inner vertices of a link, or, if they have not the room, as many in a row as have.
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

fn mean(vertices: &[usize], y: &[f64]) -> f64 {
    vertices.iter().map(|&vertex| y[vertex]).sum::<f64>() / vertices.len() as f64
}

/// The heights that all of `vertices` can have, their neighbours staying.
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

/// The height to take: that of an end, first of the one with fewer lines; else as it is.
fn level(network: &Network, mut ends: [(usize, f64); 2], (low, high): (f64, f64), now: f64) -> f64 {
    let lines = [network.vertices[ends[0].0].after.len(), network.vertices[ends[1].0].before.len()];
    if lines[1] <= lines[0] {
        ends.reverse();
    }
    let level = ends.into_iter().map(|(_, y)| y).find(|y| (low..=high).contains(y));
    level.unwrap_or(now.min(high).max(low))
}

//! Fourth step: coordinates, with edges as straight as order and sizes allow.
//!
//! Heights minimise the weighted sum of squares of the height differences along segments, subject
//! to the order and the distances in each layer. That is a convex problem. Block by block, with a
//! layer as a block, it is *isotonic regression*: each vertex wants the weighted mean height of its
//! neighbours, and pooling adjacent violators (Ayer et al., 1955) gives the exact best heights of a
//! layer in linear time. The sweeps converge to the optimum.
//!
//! The usual method is that of Brandes and Köpf (2001), which is faster and takes points for
//! vertices. Here labels differ in height, and the sizes are part of the problem.

use super::network::{Kind, Network, Vertex};
use super::straighten::{align, straighten};
use super::{Graph, Layout, Pass, Room, Route, port};

/// The most sweeps over the layers.
const SWEEPS: usize = 400;
/// The most vertices that all sweeps together visit.
const WORK: usize = 8_000_000;
/// Sweeps end when no height moves further, in pixels: a tenth of what the picture resolves.
const REST: f64 = 0.01;
/// The distance between two nodes.
const NODE_DISTANCE: f64 = 14.0;
/// The distance between other neighbours in a layer.
const DISTANCE: f64 = 5.0;
/// The least and the greatest gap between two layers.
const GAP: (f64, f64) = (20.0, 84.0);
/// The part of its climb by which a gap grows, so that a steep line still bends softly.
const SLOPE: f64 = 0.24;

/// Chooses all coordinates. Ports depend on heights and heights on ports, so both are computed
/// twice.
pub(super) fn place(graph: &Graph, network: &Network) -> Layout {
    let mut ports = vec![[0.0; 2]; network.chains.len()];
    let mut y = vec![0.0; network.vertices.len()];
    network.layers.iter().for_each(|layer| stack(network, layer, &mut y));
    for _ in 0..2 {
        heights(network, &ports, &mut y);
        align(network, &mut y);
        ports = port::ports(graph, network, &y);
    }
    straighten(network, &ports, &mut y);
    let top = network.vertices.iter().zip(&y).map(|(vertex, y)| y - vertex.room.up);
    let top = top.fold(f64::INFINITY, f64::min);
    y.iter_mut().for_each(|y| *y -= top);
    draw(graph, network, &ports, &y)
}

/// Turns heights and ports into the finished layout.
fn draw(graph: &Graph, network: &Network, ports: &[[f64; 2]], y: &[f64]) -> Layout {
    let columns = columns(network, y);
    let x = |vertex: usize| {
        let (left, right) = columns[network.vertices[vertex].layer];
        (left + right) / 2.0
    };
    let route = |link: usize| {
        let chain = &network.chains[link];
        let pass = |(i, &vertex): (usize, &usize)| {
            let (left, right) = columns[network.vertices[vertex].layer];
            let port = [(0, ports[link][0]), (chain.len() - 1, ports[link][1])];
            let port = port.iter().find(|port| port.0 == i).map_or(0.0, |port| port.1);
            Pass { left, right, y: y[vertex] + port }
        };
        let touch = |side: usize, vertex: usize| {
            let port = ports[link][side];
            let depth = (graph.radius * graph.radius - port * port).max(0.0).sqrt() + 0.6;
            (x(vertex) + if side == 0 { depth } else { -depth }, y[vertex] + port)
        };
        let label = chain.iter().find(|&&i| network.vertices[i].kind == Kind::Label);
        Route {
            backward: network.backward[link],
            start: touch(0, chain[0]),
            passes: chain.iter().enumerate().map(pass).collect(),
            end: touch(1, chain[chain.len() - 1]),
            label: label.map_or((0.0, 0.0), |&i| (x(i), y[i])),
        }
    };
    Layout {
        nodes: (0..graph.nodes.len()).map(|i| (x(i), y[i])).collect(),
        routes: (0..network.chains.len()).map(route).collect(),
        width: columns.last().map_or(0.0, |&(_, right)| right),
        height: (network.vertices.iter().zip(y))
            .map(|(vertex, y)| y + vertex.room.down)
            .fold(0.0, f64::max),
    }
}

/// Sweeps over the layers, to and fro, until the heights rest.
fn heights(network: &Network, ports: &[[f64; 2]], y: &mut [f64]) {
    let shifts = shifts(network, ports);
    let sweeps = (WORK / network.vertices.len().max(1)).clamp(4, SWEEPS);
    for sweep in 0..sweeps {
        let mut moved = 0.0_f64;
        for step in 0..network.layers.len() {
            let layer = if sweep % 2 == 0 { step } else { network.layers.len() - 1 - step };
            moved = moved.max(settle(network, &network.layers[layer], &shifts, y));
        }
        if moved < REST {
            break;
        }
    }
}

/// For each vertex the weighted sum of what its neighbours' heights have to be shifted by, since
/// lines end at ports and not at anchors.
fn shifts(network: &Network, ports: &[[f64; 2]]) -> Vec<f64> {
    let mut shifts = vec![0.0; network.vertices.len()];
    for (chain, port) in network.chains.iter().zip(ports) {
        let (first, last) = (chain[0], chain[chain.len() - 1]);
        let (second, previous) = (chain[1], chain[chain.len() - 2]);
        for (node, next, port) in [(first, second, port[0]), (last, previous, port[1])] {
            let vertex = &network.vertices[next];
            let both = vertex.before.iter().chain(&vertex.after);
            let weight = both.filter(|other| other.0 == node).map(|other| other.1).sum::<f64>();
            shifts[next] += weight * port;
            shifts[node] -= weight * port;
        }
    }
    shifts
}

/// The distance that the anchors of two neighbours in a layer must keep.
pub(super) fn distance(upper: &Vertex, lower: &Vertex) -> f64 {
    let nodes = upper.kind == Kind::Node && lower.kind == Kind::Node;
    upper.room.down + lower.room.up + if nodes { NODE_DISTANCE } else { DISTANCE }
}

/// For each vertex of a layer its least distance below the first.
fn offsets(network: &Network, layer: &[usize]) -> Vec<f64> {
    let mut offsets = vec![0.0; layer.len()];
    for i in 1..layer.len() {
        let (upper, lower) = (&network.vertices[layer[i - 1]], &network.vertices[layer[i]]);
        offsets[i] = offsets[i - 1] + distance(upper, lower);
    }
    offsets
}

/// Stacks a layer as tightly as it goes, around height 0.
fn stack(network: &Network, layer: &[usize], y: &mut [f64]) {
    let offsets = offsets(network, layer);
    let middle = offsets.last().map_or(0.0, |last| last / 2.0);
    layer.iter().zip(&offsets).for_each(|(&vertex, offset)| y[vertex] = offset - middle);
}

/// Gives the vertices of one layer their best heights while all others stay; returns the greatest
/// move. Subtracting the offsets turns "in order and apart" into "not falling".
fn settle(network: &Network, layer: &[usize], shifts: &[f64], y: &mut [f64]) -> f64 {
    let offsets = offsets(network, layer);
    let wishes: Vec<(f64, f64)> = (layer.iter().zip(&offsets))
        .map(|(&vertex, offset)| {
            let (wish, weight) = wish(&network.vertices[vertex], shifts[vertex], y, y[vertex]);
            (wish - offset, weight)
        })
        .collect();
    let mut moved = 0.0_f64;
    for ((&vertex, offset), level) in layer.iter().zip(&offsets).zip(rising(&wishes)) {
        moved = moved.max((y[vertex] - level - offset).abs());
        y[vertex] = level + offset;
    }
    moved
}

/// The height that a vertex wants, and the weight of the wish. A vertex without neighbours wants,
/// weakly, to stay.
fn wish(vertex: &Vertex, shift: f64, y: &[f64], here: f64) -> (f64, f64) {
    let neighbours = vertex.before.iter().chain(&vertex.after);
    let (sum, weight) = neighbours.fold((0.0, 0.0), |(sum, total), &(other, weight)| {
        (sum + weight * y[other], total + weight)
    });
    if weight == 0.0 { (here, 1e-3) } else { ((sum + shift) / weight, weight) }
}

/// The sequence that never falls and is nearest to weighted wishes in least squares, by pooling
/// adjacent violators. Each wish is pooled at most once, so it takes linear time.
pub(super) fn rising(wishes: &[(f64, f64)]) -> Vec<f64> {
    let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
    for &(wish, weight) in wishes {
        let mut block = (wish, weight, 1);
        while let Some(&last) = blocks.last().filter(|last| last.0 > block.0) {
            let weight = last.1 + block.1;
            block = ((last.0 * last.1 + block.0 * block.1) / weight, weight, last.2 + block.2);
            blocks.pop();
        }
        blocks.push(block);
    }
    blocks.iter().flat_map(|&(level, _, count)| std::iter::repeat_n(level, count)).collect()
}

/// The left and the right border of each layer.
fn columns(network: &Network, y: &[f64]) -> Vec<(f64, f64)> {
    let mut columns = Vec::new();
    let mut left = 0.0;
    for layer in &network.layers {
        let rooms = layer.iter().map(|&vertex| network.vertices[vertex].room);
        let right = left + rooms.map(|room: Room| room.width).fold(0.0, f64::max);
        columns.push((left, right));
        left = right + gap(network, layer, y);
    }
    columns
}

/// The width of the gap after a layer: wider where an edge climbs.
fn gap(network: &Network, layer: &[usize], y: &[f64]) -> f64 {
    let climbs = layer.iter().flat_map(|&vertex| {
        let after = network.vertices[vertex].after.iter();
        after.map(move |&(other, _)| (y[other] - y[vertex]).abs())
    });
    (GAP.0 + SLOPE * climbs.fold(0.0, f64::max)).min(GAP.1)
}

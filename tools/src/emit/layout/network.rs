//! Second step: the layered network, in which every segment joins neighbouring layers.
//!
//! Layers 0, 2, 4, … hold the nodes of rank 0, 1, 2, …; the layers between them hold the labels.
//! Where a link passes a layer it has a vertex there, its label in one of them and a bend in the
//! others.

use super::rank::Ranking;
use super::{Graph, Room};

/// The kind of a vertex: a node of the graph, the label of a link, or a place where a link passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    Label,
    Bend,
}

/// A vertex of the network, in its layer.
pub(super) struct Vertex {
    pub(super) kind: Kind,
    pub(super) layer: usize,
    pub(super) room: Room,
    /// The neighbours in the layer before, each with the weight of the segment.
    pub(super) before: Vec<(usize, f64)>,
    /// The neighbours in the layer after, likewise.
    pub(super) after: Vec<(usize, f64)>,
}

/// The network of a graph.
///
/// Vertices: the nodes come first, by number. Layers run from left to right, each from top to
/// bottom. The chain of a link has its vertices from left to right, both nodes included.
#[derive(Default)]
pub(super) struct Network {
    pub(super) vertices: Vec<Vertex>,
    pub(super) layers: Vec<Vec<usize>>,
    pub(super) chains: Vec<Vec<usize>>,
    pub(super) backward: Vec<bool>,
}

/// The weight of a segment between two vertices that are not nodes, over that of others: bends in
/// the middle of a line disturb most. Gansner, Koutsofios, North and Vo ("A Technique for Drawing
/// Directed Graphs", 1993) use 8 for segments without a node and 2 for those with one.
const MIDDLE: f64 = 6.0;
/// The room of a line that passes a layer.
const LINE: Room = Room { width: 0.0, up: 3.0, down: 3.0 };

/// Builds the network of a ranked graph. Layers are in the order of creation;
/// [`order`](super::order) sorts them.
pub(super) fn build(graph: &Graph, ranking: &Ranking) -> Network {
    let mut network = Network { backward: ranking.backward.clone(), ..Network::default() };
    let columns = ranking.rank.iter().max().map_or(0, |&last| last + 1);
    network.layers = vec![Vec::new(); (2 * columns).saturating_sub(1)];
    for (&room, rank) in graph.nodes.iter().zip(&ranking.rank) {
        network.vertex(Kind::Node, 2 * rank, room);
    }
    let labels = label_layers(graph, ranking);
    for (index, label) in labels.into_iter().enumerate() {
        let chain = network.chain(graph, index, ranking, label);
        network.connect(&chain, graph.links[index].weight);
        network.chains.push(chain);
    }
    network
}

impl Network {
    /// Adds a vertex to a layer.
    fn vertex(&mut self, kind: Kind, layer: usize, room: Room) -> usize {
        let index = self.vertices.len();
        let (before, after) = (Vec::new(), Vec::new());
        self.vertices.push(Vertex { kind, layer, room, before, after });
        self.layers[layer].push(index);
        index
    }

    /// Adds the vertices of a link between its nodes; the label goes into layer `label`.
    fn chain(&mut self, graph: &Graph, link: usize, ranking: &Ranking, label: usize) -> Vec<usize> {
        let (left, right) = ends(graph, link, ranking);
        let mut chain = vec![left];
        for layer in 2 * ranking.rank[left] + 1..2 * ranking.rank[right] {
            chain.push(if layer == label {
                self.vertex(Kind::Label, layer, graph.links[link].label)
            } else {
                self.vertex(Kind::Bend, layer, LINE)
            });
        }
        chain.push(right);
        chain
    }

    /// Joins the vertices of a chain by segments.
    fn connect(&mut self, chain: &[usize], weight: f64) {
        for pair in chain.windows(2) {
            let &[a, b] = pair else { continue };
            let inner = [a, b].iter().all(|&i| self.vertices[i].kind != Kind::Node);
            let weight = if inner { weight * MIDDLE } else { weight };
            self.vertices[a].after.push((b, weight));
            self.vertices[b].before.push((a, weight));
        }
    }
}

/// The left and the right node of a link.
fn ends(graph: &Graph, link: usize, ranking: &Ranking) -> (usize, usize) {
    let (from, to) = (graph.links[link].from, graph.links[link].to);
    if ranking.backward[link] { (to, from) } else { (from, to) }
}

/// The layer of each link's label: the one with the least height taken so far, of those that the
/// link passes. Short links choose first, since they have less choice.
fn label_layers(graph: &Graph, ranking: &Ranking) -> Vec<usize> {
    let ranks = |link: usize| {
        let (left, right) = ends(graph, link, ranking);
        ranking.rank[left]..ranking.rank[right]
    };
    let mut load = vec![0.0_f64; ranking.rank.iter().max().map_or(0, |&last| last)];
    let mut layers = vec![0; graph.links.len()];
    let mut order: Vec<usize> = (0..graph.links.len()).collect();
    order.sort_by_key(|&link| ranks(link).len());
    for link in order {
        let emptiest = ranks(link).min_by(|&a, &b| load[a].total_cmp(&load[b])).unwrap_or(0);
        load[emptiest] += graph.links[link].label.up + graph.links[link].label.down;
        layers[link] = 2 * emptiest + 1;
    }
    layers
}

//! The layered network: vertices, and segments between neighbouring layers.

use super::rank::Ranking;
use super::{Graph, Room};

/// What a vertex stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Node,
    Label,
    Bend,
}

pub(super) struct Vertex {
    pub(super) kind: Kind,
    pub(super) layer: usize,
    pub(super) room: Room,
    /// The vertices of the layer before, with the weight of the segment.
    pub(super) before: Vec<(usize, f64)>,
    /// The vertices of the layer after.
    pub(super) after: Vec<(usize, f64)>,
}

/// The vertices (nodes come first, by number), the layers from left to right, each from top to
/// bottom, and the vertices of each link from left to right.
#[derive(Default)]
pub(super) struct Network {
    pub(super) vertices: Vec<Vertex>,
    pub(super) layers: Vec<Vec<usize>>,
    pub(super) chains: Vec<Vec<usize>>,
    pub(super) backward: Vec<bool>,
}

/// How much more a link wants to be straight in its middle than at its ends.
const MIDDLE: f64 = 6.0;
/// The room of a line that passes.
const LINE: Room = Room { width: 0.0, up: 3.0, down: 3.0 };

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
    fn vertex(&mut self, kind: Kind, layer: usize, room: Room) -> usize {
        let index = self.vertices.len();
        let (before, after) = (Vec::new(), Vec::new());
        self.vertices.push(Vertex { kind, layer, room, before, after });
        self.layers[layer].push(index);
        index
    }

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

/// The layer of each link's label: the emptiest that it passes, shorter links first.
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

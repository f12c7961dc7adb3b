//! Third step: an order of the vertices in each layer with few crossings.
//!
//! Sweeps to and fro sort each layer by the barycentres of the neighbours in the layer before
//! (Sugiyama, Tagawa and Toda, 1981); after each sweep neighbours are exchanged as long as that
//! removes crossings, as in the *transpose* step of Gansner et al. (1993). The best order that was
//! met is kept, since a sweep can make things worse. Fewest crossings are NP-hard even for
//! two layers of which one is fixed (Eades and Wormald, 1994).
//!
//! Crossings are counted as inversions in a Fenwick tree, in O(e log v) for each pair of layers
//! (Barth, Mutzel and Jünger, "Simple and Efficient Bilayer Cross Counting", 2004).

use super::network::Network;

/// The segments that all sweeps together may look at: it bounds the time of large graphs, which get
/// fewer sweeps.
const WORK: usize = 4_000_000;
/// The most sweeps. Small graphs stop earlier, at an order without crossings, or find nothing
/// better long before.
const SWEEPS: usize = 40;

/// Sorts the layers of the network. The vertex `lowest` is kept at the bottom of its layer.
pub(super) fn order(network: &mut Network, lowest: Option<usize>) {
    let mut sorter = Sorter::new(network, lowest);
    sorter.start();
    let segments: usize = network.vertices.iter().map(|vertex| vertex.after.len()).sum();
    let sweeps = (WORK / segments.max(1)).clamp(2, SWEEPS);
    let mut best = (usize::MAX, Vec::new());
    for sweep in 0..sweeps {
        sorter.sweep(sweep % 2 == 0);
        sorter.exchange();
        let crossings = sorter.crossings();
        if crossings < best.0 {
            best = (crossings, sorter.layers.clone());
        }
        if crossings == 0 {
            break;
        }
    }
    if !best.1.is_empty() {
        network.layers = best.1;
    }
}

/// An order that is being improved.
struct Sorter<'a> {
    network: &'a Network,
    layers: Vec<Vec<usize>>,
    position: Vec<usize>,
    lowest: Option<usize>,
}

impl<'a> Sorter<'a> {
    fn new(network: &'a Network, lowest: Option<usize>) -> Self {
        let position = vec![0; network.vertices.len()];
        Self { network, layers: network.layers.clone(), position, lowest }
    }

    /// Begins with the links to the lowest node at the bottom, where they have to end.
    fn start(&mut self) {
        let mut low = vec![false; self.network.vertices.len()];
        for chain in &self.network.chains {
            let leads = chain.last() == self.lowest.as_ref();
            chain[1..].iter().filter(|_| leads).for_each(|&vertex| low[vertex] = true);
        }
        for layer in 0..self.layers.len() {
            self.layers[layer].sort_by_key(|&vertex| low[vertex]);
            self.number(layer);
        }
    }

    /// Writes down the positions of a layer that has changed.
    fn number(&mut self, layer: usize) {
        for (i, &vertex) in self.layers[layer].iter().enumerate() {
            self.position[vertex] = i;
        }
    }

    /// Sorts all layers once, from left to right or from right to left.
    fn sweep(&mut self, rightward: bool) {
        let count = self.layers.len();
        for step in 0..count {
            let layer = if rightward { step } else { count - 1 - step };
            self.sort(layer, rightward);
            self.number(layer);
        }
    }

    /// Sorts a layer by barycentres. The sort is stable, so ties keep their order and the result is
    /// the same on every machine.
    fn sort(&mut self, layer: usize, rightward: bool) {
        let mut keyed: Vec<(f64, usize)> = (self.layers[layer].iter())
            .map(|&vertex| (self.barycentre(vertex, rightward), vertex))
            .collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.layers[layer] = keyed.into_iter().map(|(_, vertex)| vertex).collect();
    }

    /// The mean position of the neighbours on one side; the own position if there are none.
    fn barycentre(&self, vertex: usize, rightward: bool) -> f64 {
        if self.lowest == Some(vertex) {
            return f64::INFINITY;
        }
        let here = &self.network.vertices[vertex];
        let neighbours = if rightward { &here.before } else { &here.after };
        if neighbours.is_empty() {
            return self.position[vertex] as f64;
        }
        let sum: usize = neighbours.iter().map(|&(other, _)| self.position[other]).sum();
        sum as f64 / neighbours.len() as f64
    }

    /// Exchanges neighbours as long as that removes crossings, at most eight times over.
    fn exchange(&mut self) {
        for _ in 0..8 {
            let mut better = false;
            for layer in 0..self.layers.len() {
                for i in 1..self.layers[layer].len() {
                    let (a, b) = (self.layers[layer][i - 1], self.layers[layer][i]);
                    if self.lowest != Some(b) && self.between(b, a) < self.between(a, b) {
                        self.layers[layer].swap(i - 1, i);
                        (self.position[b], self.position[a]) = (i - 1, i);
                        better = true;
                    }
                }
            }
            if !better {
                break;
            }
        }
    }

    /// The number of crossings between the segments of two neighbours if they stand in this order.
    fn between(&self, upper: usize, lower: usize) -> usize {
        let (upper, lower) = (&self.network.vertices[upper], &self.network.vertices[lower]);
        let count = |upper: &[(usize, f64)], lower: &[(usize, f64)]| -> usize {
            let below = |u: usize| lower.iter().filter(move |l| self.position[l.0] < u);
            upper.iter().map(|&(u, _)| below(self.position[u]).count()).sum()
        };
        count(&upper.before, &lower.before) + count(&upper.after, &lower.after)
    }

    /// The number of crossings of the whole order.
    fn crossings(&self) -> usize {
        self.layers.iter().map(|layer| self.crossings_after(layer)).sum()
    }

    /// The number of crossings between a layer and the next: the inversions among the ends of its
    /// segments, counted in a Fenwick tree.
    fn crossings_after(&self, layer: &[usize]) -> usize {
        let mut seen = vec![0_usize; self.network.vertices.len() + 1];
        let (mut crossings, mut total) = (0, 0);
        for &vertex in layer {
            let after = &self.network.vertices[vertex].after;
            for &(other, _) in after {
                crossings += total - prefix(&seen, self.position[other] + 1);
            }
            for &(other, _) in after {
                add(&mut seen, self.position[other] + 1);
                total += 1;
            }
        }
        crossings
    }
}

/// Counts one more entry at place `i` of a Fenwick tree.
fn add(tree: &mut [usize], mut i: usize) {
    while i < tree.len() {
        tree[i] += 1;
        i += i & i.wrapping_neg();
    }
}

/// The number of entries up to place `i` of a Fenwick tree.
fn prefix(tree: &[usize], mut i: usize) -> usize {
    let mut sum = 0;
    while i > 0 {
        sum += tree[i];
        i -= i & i.wrapping_neg();
    }
    sum
}

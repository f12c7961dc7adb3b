//! The order of the vertices in each layer: few crossings.
//!
//! Barycentre sweeps to and fro, each followed by exchanges of neighbours; the best order met is
//! kept.

use super::network::Network;

/// Work after which the sweeps stop, in segments looked at.
const WORK: usize = 4_000_000;
/// The most sweeps.
const SWEEPS: usize = 40;

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

    /// Puts what leads to the lowest node last.
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

    fn number(&mut self, layer: usize) {
        for (i, &vertex) in self.layers[layer].iter().enumerate() {
            self.position[vertex] = i;
        }
    }

    fn sweep(&mut self, rightward: bool) {
        let count = self.layers.len();
        for step in 0..count {
            let layer = if rightward { step } else { count - 1 - step };
            self.sort(layer, rightward);
            self.number(layer);
        }
    }

    fn sort(&mut self, layer: usize, rightward: bool) {
        let mut keyed: Vec<(f64, usize)> = (self.layers[layer].iter())
            .map(|&vertex| (self.barycentre(vertex, rightward), vertex))
            .collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.layers[layer] = keyed.into_iter().map(|(_, vertex)| vertex).collect();
    }

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

    /// Exchanges neighbours as long as that removes crossings.
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

    /// The crossings of segments of `upper` with segments of `lower` if they stand so.
    fn between(&self, upper: usize, lower: usize) -> usize {
        let (upper, lower) = (&self.network.vertices[upper], &self.network.vertices[lower]);
        let count = |upper: &[(usize, f64)], lower: &[(usize, f64)]| -> usize {
            let below = |u: usize| lower.iter().filter(move |l| self.position[l.0] < u);
            upper.iter().map(|&(u, _)| below(self.position[u]).count()).sum()
        };
        count(&upper.before, &lower.before) + count(&upper.after, &lower.after)
    }

    fn crossings(&self) -> usize {
        self.layers.iter().map(|layer| self.crossings_after(layer)).sum()
    }

    /// Inversions between a layer and the next, counted in a Fenwick tree.
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

fn add(tree: &mut [usize], mut i: usize) {
    while i < tree.len() {
        tree[i] += 1;
        i += i & i.wrapping_neg();
    }
}

fn prefix(tree: &[usize], mut i: usize) -> usize {
    let mut sum = 0;
    while i > 0 {
        sum += tree[i];
        i -= i & i.wrapping_neg();
    }
    sum
}

//! Positions for the states, edges and labels of a drawing: layers from left to right.
//!
//! It is the layered method of Sugiyama, Tagawa and Toda ("Methods for Visual Understanding of
//! Hierarchical System Structures", 1981), in five steps, a module each:
//!
//! 1. [`rank`] reverses a few edges so that no cycle is left, and gives each node a rank.
//! 2. [`network`] puts a layer for labels between every two ranks and cuts each edge into segments
//!    between neighbouring layers.
//! 3. [`order`] sorts each layer so that few segments cross.
//! 4. [`place`] chooses heights and columns, with [`port`] for the points where edges touch nodes.
//! 5. [`straighten`] takes bends out that no neighbour needs.
//!
//! # Labels are vertices
//!
//! Guards are long, and a drawing whose labels overlap is useless. So each label is a vertex of its
//! own with its true size, and edges bend only in the gaps between layers: no label can touch a
//! node, a label or another edge. The tests check exactly that, on random graphs. The price is
//! width: an edge over k ranks passes 2k - 1 layers.
//!
//! # Cost and weakness
//!
//! Steps 3 and 4 iterate; their number of sweeps falls as the graph grows, at the price of more
//! crossings. An automaton of 961 states and 2,760 edges is drawn in 0.12 s (CPU time of `tltlc
//! automaton --format svg`). The smallest set of reversed edges and the fewest crossings are
//! NP-hard, and both steps are heuristics. A graph in which every state leads back to every other
//! has no good layers, and none are found.
//!
//! Nothing here knows of automata. Everything is deterministic: ties break by index.

mod network;
mod order;
mod place;
mod port;
mod rank;
mod straighten;

/// The room that something takes around its anchor, which is in the middle of its width. All
/// lengths are pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Room {
    /// The width.
    pub(super) width: f64,
    /// How far it extends above its anchor.
    pub(super) up: f64,
    /// How far it extends below its anchor.
    pub(super) down: f64,
}

/// An edge between two different nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// The index of the node that the edge leaves.
    pub(super) from: usize,
    /// The index of the node that the edge enters.
    pub(super) to: usize,
    /// The room of its label, which stands on the line.
    pub(super) label: Room,
    /// How strongly it pulls its ends to one height; 1 is usual, edges into a trap have less.
    pub(super) weight: f64,
}

/// A graph to be laid out. Node 0 has the first rank alone.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    /// The room of each node.
    pub(super) nodes: Vec<Room>,
    /// The edges between different nodes, at most one from node to node.
    pub(super) links: Vec<Link>,
    /// The radius of the circle that each node is; its anchor is the centre.
    pub(super) radius: f64,
    /// The node to be furthest to the right: the accepting state.
    pub(super) last: Option<usize>,
    /// The node to be lowest in its layer: the trap.
    pub(super) lowest: Option<usize>,
}

/// A horizontal stretch of an edge within a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pass {
    /// The left border of the layer.
    pub(super) left: f64,
    /// The right border of the layer.
    pub(super) right: f64,
    /// The height of the edge in the layer; it grows downwards, as in SVG.
    pub(super) y: f64,
}

/// The way of an edge, from left to right whatever its direction.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    /// Whether the edge points from right to left, so that its arrowhead is at `start`.
    pub(super) backward: bool,
    /// The point at its left node.
    pub(super) start: (f64, f64),
    /// Its stretches in the layers of its two nodes and in all layers between them.
    pub(super) passes: Vec<Pass>,
    /// The point at its right node.
    pub(super) end: (f64, f64),
    /// The anchor of its label.
    pub(super) label: (f64, f64),
}

/// A finished layout. All coordinates are at least 0, and at most `width` or `height`.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// The anchor of each node.
    pub(super) nodes: Vec<(f64, f64)>,
    /// The way of each edge, in the order of the graph.
    pub(super) routes: Vec<Route>,
    /// The width of the whole.
    pub(super) width: f64,
    /// The height of the whole.
    pub(super) height: f64,
}

/// Lays a graph out.
#[must_use]
pub(super) fn layout(graph: &Graph) -> Layout {
    let ranking = rank::rank(graph);
    let mut network = network::build(graph, &ranking);
    order::order(&mut network, graph.lowest);
    place::place(graph, &network)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A deterministic stream of small numbers.
    fn numbers(mut seed: u64) -> impl FnMut(usize) -> usize {
        move |below| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963);
            (seed >> 33) as usize % below
        }
    }

    fn graph(seed: u64) -> Graph {
        let mut next = numbers(seed);
        let count = 1 + next(24);
        let node = |next: &mut dyn FnMut(usize) -> usize| Room {
            width: 40.0 + next(60) as f64,
            up: 20.0 + next(40) as f64,
            down: 20.0,
        };
        let nodes = (0..count).map(|_| node(&mut next)).collect();
        let mut links: Vec<Link> = Vec::new();
        for _ in 0..next(4 * count) {
            let (from, to) = (next(count), next(count));
            if from != to && !links.iter().any(|link| (link.from, link.to) == (from, to)) {
                let label = Room { width: 10.0 + next(120) as f64, up: 15.0, down: 3.0 };
                links.push(Link { from, to, label, weight: 1.0 });
            }
        }
        let lowest = (count > 2).then_some(1);
        Graph { nodes, links, radius: 18.0, last: None, lowest }
    }

    /// Left, right, top and bottom of what has room.
    fn boxed((x, y): (f64, f64), room: Room) -> [f64; 4] {
        [x - room.width / 2.0, x + room.width / 2.0, y - room.up, y + room.down]
    }

    fn boxes(graph: &Graph, layout: &Layout) -> Vec<[f64; 4]> {
        let nodes = layout.nodes.iter().zip(&graph.nodes).map(|(&at, &room)| boxed(at, room));
        let labels = layout.routes.iter().zip(&graph.links);
        nodes.chain(labels.map(|(route, link)| boxed(route.label, link.label))).collect()
    }

    #[test]
    fn nothing_overlaps() {
        for seed in 0..60 {
            let graph = graph(seed);
            let layout = layout(&graph);
            let boxes = boxes(&graph, &layout);
            for (i, a) in boxes.iter().enumerate() {
                assert!(a[0] > -1e-6 && a[2] > -1e-6, "seed {seed}: {a:?}");
                assert!(a[1] < layout.width + 1e-6 && a[3] < layout.height + 1e-6);
                for b in &boxes[i + 1..] {
                    let apart = a[1] < b[0] || b[1] < a[0] || a[3] < b[2] || b[3] < a[2];
                    assert!(apart, "seed {seed}: {a:?} and {b:?}");
                }
            }
        }
    }

    #[test]
    fn edges_pass_beside_what_is_not_theirs() {
        for seed in 0..60 {
            let graph = graph(seed);
            let layout = layout(&graph);
            let boxes = boxes(&graph, &layout);
            for (i, (link, route)) in graph.links.iter().zip(&layout.routes).enumerate() {
                let own = [link.from, link.to, graph.nodes.len() + i];
                for pass in &route.passes {
                    for (_, b) in boxes.iter().enumerate().filter(|(j, _)| !own.contains(j)) {
                        let beside = pass.right < b[0] || b[1] < pass.left;
                        assert!(beside || pass.y < b[2] || b[3] < pass.y, "seed {seed}: {link:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn edges_go_from_left_to_right_along_their_layers() {
        for seed in 0..60 {
            let graph = graph(seed);
            for route in layout(&graph).routes {
                let ends = [route.start.0, route.end.0];
                assert!(ends[0] < ends[1], "seed {seed}");
                assert!(route.passes.windows(2).all(|pair| pair[0].right < pair[1].left));
            }
        }
    }

    #[test]
    fn a_chain_is_straight() {
        let nodes = vec![Room { width: 40.0, up: 20.0, down: 20.0 }; 6];
        let label = Room { width: 20.0, up: 15.0, down: 3.0 };
        let link = |from| Link { from, to: from + 1, label, weight: 1.0 };
        let graph = Graph { nodes, links: (0..5).map(link).collect(), ..Graph::default() };
        let layout = layout(&graph);
        assert!(layout.nodes.iter().all(|node| (node.1 - layout.nodes[0].1).abs() < 0.1));
    }
}

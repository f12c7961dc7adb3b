//! Where the states, edges and labels of a drawing go: layers from left to right.
//!
//! After "Sugiyama, Tagawa and Toda, Methods for visual understanding of hierarchical system
//! structures, 1981", in steps, a module each: [`rank`] turns a few edges round so that no
//! cycle is left and gives each node a rank; [`network`] puts a label layer between every two
//! ranks and cuts each edge into segments between neighbouring layers; [`order`] sorts each layer
//! so that few segments cross; [`place`] chooses heights and columns, [`port`] where edges touch nodes,
//! and [`straighten`] takes needless bends out. A label is a vertex of its own with
//! its true size, and edges bend only in the gaps between layers, so that no label can touch
//! a node, a label or another edge. Cost is that of the crossings' sweeps, whose number
//! falls as the graph grows; nothing here knows of automata.

mod network;
mod order;
mod place;
mod port;
mod rank;
mod straighten;

/// The room that something takes around its anchor; the anchor is in the middle of the width.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Room {
    /// The width.
    pub(super) width: f64,
    /// How far it goes above its anchor.
    pub(super) up: f64,
    /// How far it goes below its anchor.
    pub(super) down: f64,
}

/// An edge between two different nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    /// From node.
    pub(super) from: usize,
    /// To node.
    pub(super) to: usize,
    /// Its label, which stands on the line.
    pub(super) label: Room,
    /// How much it wants to be straight; 1 is usual.
    pub(super) weight: f64,
}

/// What is to be drawn; node 0 comes first.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    /// The nodes.
    pub(super) nodes: Vec<Room>,
    /// The edges, at most one from node to node.
    pub(super) links: Vec<Link>,
    /// The radius of the circle that each node is; its anchor is the middle.
    pub(super) radius: f64,
    /// The node that shall be furthest to the right.
    pub(super) last: Option<usize>,
    /// The node that shall be lowest in its layer.
    pub(super) lowest: Option<usize>,
}

/// A horizontal stretch of an edge within a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pass {
    /// Where the layer begins.
    pub(super) left: f64,
    /// Where the layer ends.
    pub(super) right: f64,
    /// The height of the edge there.
    pub(super) y: f64,
}

/// The way of an edge from left to right.
#[derive(Clone, Debug, Default)]
pub(super) struct Route {
    /// Whether the edge itself goes from right to left.
    pub(super) backward: bool,
    /// Where it touches its left node.
    pub(super) start: (f64, f64),
    /// The layers of its two nodes and all between them.
    pub(super) passes: Vec<Pass>,
    /// Where it touches its right node.
    pub(super) end: (f64, f64),
    /// The anchor of its label.
    pub(super) label: (f64, f64),
}

/// A finished layout; all coordinates are positive.
#[derive(Clone, Debug, Default)]
pub(super) struct Layout {
    /// The anchor of each node.
    pub(super) nodes: Vec<(f64, f64)>,
    /// The way of each edge.
    pub(super) routes: Vec<Route>,
    /// The width of all.
    pub(super) width: f64,
    /// The height of all.
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

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

//! Walks over diagrams: the leaves of a function, and functions rewritten bottom-up.
//!
//! All walks use a stack of their own and visit each node once, so they are linear in the nodes and
//! do not recurse. Their order is that of a depth-first walk, low before high: it depends on the
//! functions alone, and with it everything that is numbered along the way.

use super::{Bdd, Diagram, Node};
use crate::arena::Seen;

/// The images of functions under a [fold](Diagram::fold).
///
/// The image of a leaf is computed when it is asked for: leaves are not stored in a diagram, so
/// there is no array of them.
pub struct Images<'a> {
    leaf: &'a dyn Fn(u32) -> Bdd,
    /// The image of each node, by its index; `Bdd::FALSE` for nodes outside the folded order.
    nodes: Vec<Bdd>,
}

impl Images<'_> {
    /// The image of `f`.
    #[must_use]
    pub fn of(&self, f: Bdd) -> Bdd {
        match self.nodes.get(f.0 as usize) {
            Some(&image) => image,
            None => (self.leaf)(f.0 & !Bdd::LEAF),
        }
    }
}

impl Diagram {
    /// The leaves of `f`, each once, in the lexicographic order of the first valuations that lead
    /// to them (level 0 first, false before true).
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let inner = diagram.node(1, Bdd::leaf(9), Bdd::leaf(4));
    /// let f = diagram.node(0, inner, Bdd::leaf(9));
    /// assert_eq!(diagram.leaves(f), [9, 4]);
    /// ```
    #[must_use]
    pub fn leaves(&self, f: Bdd) -> Vec<u32> {
        let (mut nodes, mut leaves) = (Seen::default(), Seen::default());
        let mut found = Vec::new();
        self.walk(f, &mut |node| nodes.insert(node), &mut |leaf| {
            if leaves.insert(leaf) {
                found.push(leaf);
            }
        });
        found
    }

    /// Visits what is below `f` depth-first, low before high. `enter` is asked for each node,
    /// by its place, whether to go below it; `leaf` gets each leaf that is met.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let shared = diagram.node(2, Bdd::leaf(5), Bdd::leaf(6));
    /// let f = diagram.node(0, shared, Bdd::leaf(6));
    /// // Entered always, a shared node is met once for each way to it; see [`Diagram::leaves`] for once.
    /// let mut met = Vec::new();
    /// diagram.walk(f, &mut |_| true, &mut |leaf| met.push(leaf));
    /// assert_eq!(met, [5, 6, 6]);
    /// ```
    pub fn walk(&self, f: Bdd, enter: &mut dyn FnMut(u32) -> bool, leaf: &mut dyn FnMut(u32)) {
        let mut stack = vec![f];
        while let Some(f) = stack.pop() {
            match self.get(f) {
                Some(node) if enter(f.0) => stack.extend([node.high, node.low]),
                Some(_) => {}
                None => leaf(f.0 & !Bdd::LEAF),
            }
        }
    }

    /// The indices of the nodes that `roots` need, children before parents: the order in which a
    /// depth-first walk from the first root to the last, low before high, leaves them.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let unused = diagram.variable(3);
    /// let inner = diagram.variable(1);
    /// let f = diagram.node(0, Bdd::FALSE, inner);
    /// let place = |f: Bdd| f.index().unwrap();
    /// assert_eq!(diagram.postorder(&[f]), [place(inner), place(f)]);
    /// assert_eq!(place(unused), 0);
    /// ```
    #[must_use]
    pub fn postorder(&self, roots: &[Bdd]) -> Vec<u32> {
        let mut seen = vec![false; self.nodes.len()];
        let mut order = Vec::new();
        let mut stack = Vec::new();
        for &root in roots {
            stack.push((root, false));
            while let Some((f, is_left)) = stack.pop() {
                let Some(node) = self.get(f) else { continue };
                if is_left {
                    order.push(f.0);
                } else if !std::mem::replace(&mut seen[f.0 as usize], true) {
                    stack.extend([(f, true), (node.high, false), (node.low, false)]);
                }
            }
        }
        order
    }

    /// Rewrites functions bottom-up: `leaf` makes the images of leaves, and `node` those of nodes,
    /// whose children it gets as images.
    ///
    /// `order` holds indices of nodes after those of their children, as
    /// [`postorder`](Self::postorder) gives them; other nodes have no image. The caller passes it,
    /// because one order serves several folds (each round of a minimization is one).
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram, Node};
    ///
    /// let mut diagram = Diagram::default();
    /// let [a, b] = [0, 1].map(|level| diagram.variable(level));
    /// let both = diagram.and(a, b);
    /// // ∃b: drop the nodes of level 1.
    /// let mut result = Diagram::default();
    /// let order = diagram.postorder(&[both]);
    /// let images = diagram.fold(&order, &Bdd::leaf, &mut |Node { level, low, high }| match level {
    ///     1 => result.or(low, high),
    ///     _ => result.node(level, low, high),
    /// });
    /// let projected = images.of(both);
    /// assert_eq!(projected, result.variable(0));
    /// ```
    #[must_use]
    pub fn fold<'a>(
        &self,
        order: &[u32],
        leaf: &'a dyn Fn(u32) -> Bdd,
        node: &mut dyn FnMut(Node) -> Bdd,
    ) -> Images<'a> {
        let mut images = Images { leaf, nodes: vec![Bdd::FALSE; self.nodes.len()] };
        for &place in order {
            let Node { level, low, high } = self.nodes[place as usize];
            let (low, high) = (images.of(low), images.of(high));
            images.nodes[place as usize] = node(Node { level, low, high });
        }
        images
    }

    /// The functions `roots` with other leaves, in a diagram of their own.
    ///
    /// Its nodes stand in the order of [`postorder`](Self::postorder), and nodes that `roots` do
    /// not need are gone: equal functions give equal diagrams, byte for byte. So this is also how a
    /// diagram is cleaned up.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let f = diagram.node(0, Bdd::leaf(5), Bdd::leaf(6));
    /// // States 5 and 6 become one: the node asks in vain and is gone.
    /// let (merged, roots) = diagram.map_leaves(&[f], &|_| Bdd::leaf(5));
    /// assert_eq!(roots, [Bdd::leaf(5)]);
    /// assert!(merged.nodes().is_empty());
    /// ```
    #[must_use]
    pub fn map_leaves(&self, roots: &[Bdd], leaf: &dyn Fn(u32) -> Bdd) -> (Self, Vec<Bdd>) {
        let mut mapped = Self::default();
        let order = self.postorder(roots);
        let node = &mut |Node { level, low, high }| mapped.node(level, low, high);
        let images = self.fold(&order, leaf, node);
        let roots = roots.iter().map(|&root| images.of(root)).collect();
        (mapped, roots)
    }

    /// The function `f` of another diagram, in this one. Levels and leaves keep their numbers.
    ///
    /// ```
    /// use tltl_compiler::bdd::Diagram;
    ///
    /// let [mut one, mut other] = [Diagram::default(), Diagram::default()];
    /// let a = one.variable(0);
    /// let not_a = one.not(a);
    /// let imported = other.import(&one, not_a);
    /// assert_eq!(other.evaluate(imported, &|_| false), 1);
    /// ```
    pub fn import(&mut self, from: &Self, f: Bdd) -> Bdd {
        let order = from.postorder(&[f]);
        let node = &mut |Node { level, low, high }| self.node(level, low, high);
        from.fold(&order, &Bdd::leaf, node).of(f)
    }
}

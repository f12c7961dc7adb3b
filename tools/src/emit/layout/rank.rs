//! First step: edges that are drawn backward, and the rank of each node.
//!
//! Reversing the edges of a *feedback arc set* leaves no cycle. The smallest set is NP-hard to
//! find; the greedy order of Eades, Lin and Smyth ("A Fast and Effective Heuristic for the Feedback
//! Arc Set Problem", 1993) leaves at most half of the edges less a sixth of the nodes. Ranks are
//! longest paths from the initial node, which gives the fewest ranks. Network simplex (Gansner et
//! al., 1993) would give shorter edges; automata have few long ones, and [`pull_right`] catches
//! those that show.
//!
//! The search for the next node of the order is linear, so the step is quadratic in the number of
//! nodes: at most a thousand are drawn.

use super::Graph;

/// The rank of each node, and for each link whether it is drawn from right to left.
pub(super) struct Ranking {
    pub(super) rank: Vec<usize>,
    pub(super) backward: Vec<bool>,
}

/// Ranks the nodes of a graph. All links between two ranks point to the right after those that are
/// marked backward are reversed.
pub(super) fn rank(graph: &Graph) -> Ranking {
    let order = order(graph);
    let mut position = vec![0; order.len()];
    order.iter().enumerate().for_each(|(i, &node)| position[node] = i);
    let backward: Vec<_> =
        graph.links.iter().map(|link| position[link.from] > position[link.to]).collect();
    let forward: Vec<_> = (graph.links.iter().zip(&backward))
        .map(|(link, &backward)| if backward { (link.to, link.from) } else { (link.from, link.to) })
        .collect();
    let neighbours = Neighbours::new(order.len(), &forward);
    let mut rank = longest_paths(&order, &neighbours);
    if let Some(last) = graph.last {
        rank[last] = rank.iter().copied().max().unwrap_or(0);
    }
    pull_right(&order, &neighbours, &mut rank);
    Ranking { rank, backward }
}

/// The neighbours of each node along links that all count as forward.
struct Neighbours {
    before: Vec<Vec<usize>>,
    after: Vec<Vec<usize>>,
}

impl Neighbours {
    fn new(count: usize, edges: &[(usize, usize)]) -> Self {
        let mut neighbours = Self { before: vec![vec![]; count], after: vec![vec![]; count] };
        for &(from, to) in edges {
            neighbours.after[from].push(to);
            neighbours.before[to].push(from);
        }
        neighbours
    }
}

/// An order of the nodes, node 0 first, against which few links point (Eades, Lin and Smyth, 1993).
///
/// Nodes without links out go to the end, nodes without links in to the front; of the others the
/// one with the largest surplus of links out over links in goes to the front.
fn order(graph: &Graph) -> Vec<usize> {
    let count = graph.nodes.len();
    let edges: Vec<_> = graph.links.iter().map(|link| (link.from, link.to)).collect();
    let neighbours = Neighbours::new(count, &edges);
    let mut degrees: Vec<(usize, usize)> =
        (0..count).map(|i| (neighbours.before[i].len(), neighbours.after[i].len())).collect();
    let mut left: Vec<usize> = (0..count).collect();
    let (mut front, mut back) = (Vec::new(), Vec::new());
    while !left.is_empty() {
        let sink = left.iter().rposition(|&i| degrees[i].1 == 0 && (i != 0 || left.len() == 1));
        let at = sink.unwrap_or_else(|| next(&left, &degrees));
        let node = left.remove(at);
        if sink.is_some() {
            back.push(node)
        } else {
            front.push(node)
        }
        neighbours.after[node].iter().for_each(|&i| degrees[i].0 -= 1);
        neighbours.before[node].iter().for_each(|&i| degrees[i].1 -= 1);
    }
    front.extend(back.into_iter().rev());
    front
}

/// The place in `left` of the node to be put at the front next.
fn next(left: &[usize], degrees: &[(usize, usize)]) -> usize {
    if left[0] == 0 {
        return 0;
    }
    let surplus = |&i: &usize| {
        let (before, after) = degrees[i];
        (before != 0, before as i64 - after as i64)
    };
    (0..left.len()).min_by_key(|&at| surplus(&left[at])).unwrap_or(0)
}

/// The rank of each node: the length of the longest path to it.
fn longest_paths(order: &[usize], neighbours: &Neighbours) -> Vec<usize> {
    let mut rank = vec![0; order.len()];
    for &node in order {
        let before = neighbours.before[node].iter().map(|&i| rank[i] + 1);
        rank[node] = before.max().unwrap_or(usize::from(node != 0));
    }
    rank
}

/// Moves nodes that have more links to the right than to the left towards their successors, as far
/// as these allow: that shortens more links than it lengthens.
fn pull_right(order: &[usize], neighbours: &Neighbours, rank: &mut [usize]) {
    for &node in order.iter().rev().filter(|&&node| node != 0) {
        let (before, after) = (&neighbours.before[node], &neighbours.after[node]);
        if after.len() > before.len()
            && let Some(first) = after.iter().map(|&i| rank[i]).min()
        {
            rank[node] = rank[node].max(first - 1);
        }
    }
}

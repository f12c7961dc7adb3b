//! Which edges go backward, and in which column each node stands.

use super::Graph;

/// The column of each node, and for each link whether it is drawn from right to left.
pub(super) struct Ranking {
    pub(super) rank: Vec<usize>,
    pub(super) backward: Vec<bool>,
}

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

/// An order of the nodes, node 0 first, against which few links go (Eades, Lin and Smyth, 1993):
/// sinks go to the end, sources to the front, and else the node with the most links out and the
/// fewest in.
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

/// The place in `left` of the next node from the left.
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

fn longest_paths(order: &[usize], neighbours: &Neighbours) -> Vec<usize> {
    let mut rank = vec![0; order.len()];
    for &node in order {
        let before = neighbours.before[node].iter().map(|&i| rank[i] + 1);
        rank[node] = before.max().unwrap_or(usize::from(node != 0));
    }
    rank
}

/// Moves nodes with more links to the right than to the left to the right, as far as they can go.
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

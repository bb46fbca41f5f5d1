//! The order of a net: neighbours are near each other, so that its matrix is a narrow band.
//!
//! Nodes are numbered in the order in which a search in breadth meets them, from one at the rim, neighbours of few neighbours first (Cuthill & McKee 1969,
//! doi 10.1145/800195.805928), and then backwards. A node at the rim is found by going to the last of the search, a few times (George & Liu 1979,
//! doi 10.1145/355841.355845). Of n × n meshes the band is about n nodes wide, where the tree of their joints would leave about n² loops to a border.

/// Searches for a node at the rim.
const SEARCHES: usize = 8;

/// An order of `count` nodes that are joined in `pairs`.
pub(super) fn order(count: usize, pairs: impl Iterator<Item = [usize; 2]>) -> Vec<usize> {
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); count];
    for [a, b] in pairs.filter(|[a, b]| a != b) {
        neighbours[a].push(b);
        neighbours[b].push(a);
    }
    for list in &mut neighbours {
        list.sort_unstable();
        list.dedup();
    }
    let degrees: Vec<usize> = neighbours.iter().map(Vec::len).collect();
    for list in &mut neighbours {
        list.sort_by_key(|i| (degrees[*i], *i));
    }
    let mut order = Vec::with_capacity(count);
    let mut levels = vec![usize::MAX; count];
    for start in 0..count {
        if levels[start] != usize::MAX {
            continue;
        }
        let begin = order.len();
        let (mut root, mut depth) = (start, 0);
        for _ in 0..SEARCHES {
            // Each search forgets the one before.
            for node in order.drain(begin..) {
                levels[node] = usize::MAX;
            }
            search(root, &neighbours, &mut levels, &mut order);
            let reached = order.last().map_or(0, |last| levels[*last]);
            if reached <= depth {
                break;
            }
            depth = reached;
            let farthest = order[begin..].iter().copied().filter(|node| levels[*node] == depth);
            root = farthest.min_by_key(|node| (degrees[*node], *node)).unwrap_or(root);
        }
    }
    order.reverse();
    order
}

/// Appends all nodes that are joined to `root`, and writes how far they are.
fn search(root: usize, neighbours: &[Vec<usize>], levels: &mut [usize], order: &mut Vec<usize>) {
    let mut next = order.len();
    levels[root] = 0;
    order.push(root);
    while next < order.len() {
        let node = order[next];
        for &other in &neighbours[node] {
            if levels[other] == usize::MAX {
                levels[other] = levels[node] + 1;
                order.push(other);
            }
        }
        next += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The widest pair of an order.
    fn width(count: usize, pairs: &[[usize; 2]]) -> usize {
        let order = order(count, pairs.iter().copied());
        let mut places = vec![usize::MAX; count];
        order.iter().enumerate().for_each(|(k, node)| places[*node] = k);
        assert!(places.iter().all(|place| *place < count), "{places:?}");
        pairs.iter().map(|[a, b]| places[*a].abs_diff(places[*b])).max().unwrap_or(0)
    }

    #[test]
    fn a_chain_keeps_its_neighbours_and_a_grid_is_as_wide_as_its_side() {
        let chain: Vec<[usize; 2]> = (1..100).map(|i| [(i - 1) * 37 % 100, i * 37 % 100]).collect();
        assert_eq!(width(100, &chain), 1);
        let n = 20;
        let grid: Vec<[usize; 2]> = (0..n * n)
            .flat_map(|i| {
                let right = (i % n + 1 < n).then_some([i, i + 1]);
                right.into_iter().chain((i + n < n * n).then_some([i, i + n]))
            })
            .collect();
        let found = width(n * n, &grid);
        assert!((n..=n + 1).contains(&found), "{found}");
    }

    #[test]
    fn parts_that_nothing_joins_follow_each_other() {
        assert_eq!(width(7, &[[0, 3], [3, 6], [1, 4], [5, 5]]), 1);
    }
}

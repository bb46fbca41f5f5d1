//! The order of the unknowns: bodies and multipliers along the tree of joints, so that the matrix of a tree is a band.
//!
//! Bodies follow each other from the tips of the tree to its root, and the multipliers of a joint stand between the body
//! outside it and the body inside it:
//!
//! ```text
//! … v_child, λ(child–parent), v_parent, λ(parent–grandparent), …
//! ```
//!
//! Eliminating v_child leaves −G (M*)⁻¹ Gᵀ as the pivot of λ, with the inertia M* of all that hangs on the child: every
//! pivot is definite and no rows are exchanged. It is the elimination of the articulated-body method (Featherstone,
//! *Rigid Body Dynamics Algorithms*, chapter 7, doi 10.1007/978-1-4899-7560-7).
//!
//! A joint that closes a loop has its multipliers in the border. A body that couples parts far from each other goes to the
//! border too, with the multipliers of the joint inside it, where that is cheaper. A net has too many loops for a border: bodies and multipliers then stand in
//! the order of Cuthill and McKee ([`net`]) and rows are exchanged, where that takes fewer multiplications.

use super::net;
use crate::linalg::Structure;

/// A coupling of two nodes, or of one with the ground, with a number of rows of constraints.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub(super) nodes: [Option<usize>; 2],
    pub(super) rows: usize,
    /// Whether the tree may lead along it: not along those of an element but from node to node.
    pub(super) along: bool,
}

impl Link {
    /// A link that the tree may lead along.
    pub(super) fn new(nodes: [Option<usize>; 2], rows: usize) -> Link {
        Link { nodes, rows, along: true }
    }
}

/// Order of the nodes and structure of the matrices.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    /// Number of the first velocity of each node.
    pub(super) first: Vec<usize>,
    /// Whether the rows of each link stand in the tree: the others close loops.
    pub(super) in_tree: Vec<bool>,
    /// Structures with no, one and two multipliers a row.
    pub(super) structures: [Structure; 3],
}

/// The layout of nodes with `sizes` velocities each. The first `bodies` of them are numbered in their order in the band, the
/// others, which are those of beams, behind them as they come.
pub(super) fn layout(sizes: &[usize], bodies: usize, links: &[Link]) -> Layout {
    let tree = Tree::new(sizes.len(), links);
    let mut cut = vec![false; sizes.len()];
    let mut plan = Plan::of_tree((sizes, bodies), links, &tree, &cut);
    // Bodies at the ends of the widest coupling are tried in the border, as long as it pays.
    while let Some([a, b]) = plan.widest {
        let tried = [a, b].map(|node| {
            let mut cut = cut.clone();
            cut[node] = true;
            (Plan::of_tree((sizes, bodies), links, &tree, &cut), cut)
        });
        let [first, second] = tried;
        let (best, chosen) = if first.0.cost(1) <= second.0.cost(1) { first } else { second };
        if !(best.cost(1) < plan.cost(1)) {
            break;
        }
        (plan, cut) = (best, chosen);
    }
    let net = Plan::of_net((sizes, bodies), links);
    if net.cost(1) < plan.cost(1) {
        plan = net;
    }
    let structures = [0, 1, 2].map(|k| plan.structure(k));
    Layout { first: plan.first, in_tree: tree.links, structures }
}

/// A spanning forest: the order from tips to roots, and the link of each node towards its root.
struct Tree {
    order: Vec<usize>,
    inboard: Vec<Option<usize>>,
    links: Vec<bool>,
}

impl Tree {
    fn new(nodes: usize, links: &[Link]) -> Tree {
        // Joints before mere forces.
        let mut sorted: Vec<usize> = (0..links.len()).filter(|k| links[*k].along).collect();
        sorted.sort_by_key(|k| links[*k].rows == 0);
        let mut neighbours: Vec<Vec<(usize, usize)>> = vec![Vec::new(); nodes];
        let mut roots = Vec::new();
        for &k in &sorted {
            match links[k].nodes {
                [Some(a), Some(b)] if a != b => {
                    neighbours[a].push((b, k));
                    neighbours[b].push((a, k));
                }
                [Some(a), None] | [None, Some(a)] => roots.push((a, Some(k))),
                _ => {}
            }
        }
        // What the ground holds most firmly is the root: without the rows of the border it should not move freely.
        roots.sort_by_key(|(_, link)| std::cmp::Reverse(link.map_or(0, |k| links[k].rows)));
        roots.extend((0..nodes).map(|a| (a, None)));
        let mut tree =
            Tree { order: Vec::new(), inboard: vec![None; nodes], links: vec![false; links.len()] };
        let (mut seen, mut parent) = (vec![false; nodes], vec![None; nodes]);
        for (root, link) in roots {
            if seen[root] {
                continue;
            }
            (seen[root], tree.inboard[root]) = (true, link);
            // Depth first: a node, and how many of its neighbours have been visited.
            let (mut path, mut visited) = (vec![(root, 0)], vec![root]);
            while let Some((node, next)) = path.last_mut() {
                let Some(&(other, link)) = neighbours[*node].get(*next) else {
                    path.pop();
                    continue;
                };
                *next += 1;
                if !seen[other] {
                    (seen[other], tree.inboard[other], parent[other]) = (true, Some(link), Some(*node));
                    visited.push(other);
                    path.push((other, 0));
                }
            }
            tree.append(root, &visited, &parent);
        }
        for link in tree.inboard.iter().flatten() {
            tree.links[*link] = true;
        }
        tree
    }

    /// Appends the nodes of the tree of `root`, tips first; of the branches of a node the smallest is the nearest.
    fn append(&mut self, root: usize, visited: &[usize], parent: &[Option<usize>]) {
        let mut weight = vec![1; parent.len()];
        let mut children = vec![Vec::new(); parent.len()];
        for &node in visited.iter().rev().filter(|node| **node != root) {
            if let Some(inside) = parent[node] {
                weight[inside] += weight[node];
                children[inside].push(node);
            }
        }
        let start = self.order.len();
        let mut open = vec![root];
        // From the root outwards, then reversed.
        while let Some(node) = open.pop() {
            self.order.push(node);
            children[node].sort_by_key(|child| std::cmp::Reverse(weight[*child]));
            open.append(&mut children[node]);
        }
        self.order[start..].reverse();
    }
}

/// What stands in a matrix at one place after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Item {
    /// The velocities of a node.
    Node(usize),
    /// The multipliers of a link.
    Rows(usize),
}

/// A structure that is tried.
struct Plan<'a> {
    sizes: &'a [usize],
    links: &'a [Link],
    /// What stands in the matrix in its order, that of the border last, and how many items are in the band.
    items: Vec<Item>,
    in_band: usize,
    first: Vec<usize>,
    /// The two nodes of the widest coupling in the band.
    widest: Option<[usize; 2]>,
    /// Whether pivots of multipliers stand before the bodies that they couple, so that rows are exchanged.
    exchanges: bool,
}

impl<'a> Plan<'a> {
    /// The order of a tree, without the nodes that are cut out of its band.
    fn of_tree(sizes: (&'a [usize], usize), links: &'a [Link], tree: &Tree, cut: &[bool]) -> Plan<'a> {
        let mut items = Vec::with_capacity(sizes.0.len() + links.len());
        let mut inside = vec![false; links.len()];
        for &node in tree.order.iter().filter(|node| !cut[**node]) {
            items.push(Item::Node(node));
            if let Some(link) = tree.inboard[node] {
                items.push(Item::Rows(link));
                inside[link] = true;
            }
        }
        let in_band = items.len();
        items.extend(tree.order.iter().filter(|node| cut[**node]).map(|node| Item::Node(*node)));
        items.extend((0..links.len()).filter(|link| !inside[*link]).map(Item::Rows));
        Plan::new(sizes, links, (items, in_band), false)
    }

    /// The [order of a net](net::order), all in the band.
    fn of_net(sizes: (&'a [usize], usize), links: &'a [Link]) -> Plan<'a> {
        let nodes = sizes.0.len();
        let pairs = links.iter().enumerate().flat_map(|(k, link)| {
            let [a, b] = link.nodes;
            [(a, b), (a, Some(nodes + k)), (b, Some(nodes + k))]
        });
        let pairs = pairs.filter_map(|(a, b)| Some([a?, b?]));
        let of = |i: usize| if i < nodes { Item::Node(i) } else { Item::Rows(i - nodes) };
        let items: Vec<Item> = net::order(nodes + links.len(), pairs).into_iter().map(of).collect();
        let in_band = items.len();
        Plan::new(sizes, links, (items, in_band), true)
    }

    fn new(
        (sizes, bodies): (&'a [usize], usize),
        links: &'a [Link],
        (items, in_band): (Vec<Item>, usize),
        exchanges: bool,
    ) -> Plan<'a> {
        let node = |item: &Item| match item {
            Item::Node(node) => Some(*node),
            Item::Rows(_) => None,
        };
        let mut first = vec![0; sizes.len()];
        let mut next = 0;
        for node in items.iter().filter_map(node).filter(|node| *node < bodies).chain(bodies..sizes.len()) {
            first[node] = next;
            next += sizes[node];
        }
        let mut inside = vec![false; sizes.len()];
        items[..in_band].iter().filter_map(node).for_each(|node| inside[node] = true);
        let mut plan = Plan { sizes, links, items, in_band, first, widest: None, exchanges };
        let (nodes, ..) = plan.places(1);
        let far = |[a, b]: [usize; 2]| nodes[a].abs_diff(nodes[b]);
        let pairs = links.iter().filter_map(|link| match link.nodes {
            [Some(a), Some(b)] if a != b && inside[a] && inside[b] => Some([a, b]),
            _ => None,
        });
        plan.widest = pairs.max_by_key(|pair| far(*pair));
        plan
    }

    /// First place of each node and of the rows of each link, with `multipliers` a row, and that of the border.
    fn places(&self, multipliers: usize) -> (Vec<usize>, Vec<usize>, usize) {
        let (mut nodes, mut rows) = (vec![0; self.sizes.len()], vec![0; self.links.len()]);
        let (mut next, mut border) = (0, 0);
        for (k, item) in self.items.iter().enumerate() {
            match *item {
                Item::Node(node) => {
                    nodes[node] = next;
                    next += self.sizes[node];
                }
                Item::Rows(link) => {
                    rows[link] = next;
                    next += multipliers * self.links[link].rows;
                }
            }
            if k < self.in_band {
                border = next;
            }
        }
        (nodes, rows, border)
    }

    /// Order, half-bandwidth and border.
    fn band(&self, multipliers: usize) -> [usize; 3] {
        let (nodes, rows, order) = self.places(multipliers);
        let total: usize =
            self.sizes.iter().sum::<usize>() + multipliers * self.links.iter().map(|l| l.rows).sum::<usize>();
        let mut half = 0;
        let mut join = |a: [usize; 2], b: [usize; 2]| {
            if a[0] < order && b[0] < order && a[1] > a[0] && b[1] > b[0] {
                half = half.max(b[1] - 1 - a[0].min(b[0])).max(a[1] - 1 - a[0].min(b[0]));
            }
        };
        let node = |i: usize| [nodes[i], nodes[i] + self.sizes[i]];
        let row = |k: usize| [rows[k], rows[k] + multipliers * self.links[k].rows];
        (0..self.sizes.len()).for_each(|i| join(node(i), node(i)));
        let mut touching: Vec<Vec<usize>> = vec![Vec::new(); self.sizes.len()];
        for (k, link) in self.links.iter().enumerate() {
            link.nodes.iter().flatten().for_each(|i| touching[*i].push(k));
        }
        for (k, link) in self.links.iter().enumerate() {
            join(row(k), row(k));
            for &i in link.nodes.iter().flatten() {
                join(row(k), node(i));
                link.nodes.iter().flatten().for_each(|j| join(node(i), node(*j)));
                if multipliers < 2 || link.rows == 0 {
                    continue;
                }
                // K Gᵀ and G Gᵀ reach one link farther.
                for &other in &touching[i] {
                    join(row(k), row(other));
                    self.links[other].nodes.iter().flatten().for_each(|j| join(row(k), node(*j)));
                }
            }
        }
        [order, half, total - order]
    }

    fn structure(&self, multipliers: usize) -> Structure {
        let [order, half, border] = self.band(multipliers);
        let band = Structure::band(order, half, half, border);
        let whole = order + border;
        let worthwhile = self.cost(multipliers) < (whole * whole * whole) as f64 / 3.0;
        if !worthwhile {
            return Structure::dense(whole);
        }
        let (nodes, rows, _) = self.places(multipliers);
        if multipliers == 0 && nodes == self.first {
            return band;
        }
        let mut places = Vec::with_capacity(whole);
        let mut velocities = vec![0; self.sizes.iter().sum()];
        for (i, size) in self.sizes.iter().enumerate() {
            (0..*size).for_each(|k| velocities[self.first[i] + k] = nodes[i] + k);
        }
        places.extend(velocities);
        for copy in 0..multipliers {
            for (link, first) in self.links.iter().zip(&rows) {
                places.extend((0..link.rows).map(|k| first + copy * link.rows + k));
            }
        }
        // Multipliers among the last rows are exchanged within the band.
        let velocities: usize = self.sizes.iter().sum();
        let exchanges = self.exchanges || places[velocities..].iter().any(|place| place + half + 1 < order);
        Structure::ordered(places.into_iter().map(|place| place as u32).collect(), band, exchanges)
    }

    /// Multiplications of a factorisation and a solution; where rows are exchanged, the upper half of a band is twice as wide.
    fn cost(&self, multipliers: usize) -> f64 {
        let [order, half, border] = self.band(multipliers).map(|x| x as f64);
        let wide = if self.exchanges { 2.0 * half } else { half };
        order * (half + border) * (wide + border + 2.0) + border * border * border / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn joint(a: usize, b: Option<usize>) -> Link {
        Link::new([Some(a), b], 5)
    }

    fn pieces(structure: &Structure) -> [usize; 3] {
        [structure.order(), structure.half_bandwidth(), structure.border()]
    }

    /// v of 6 and λ of 5 alternate: from the first velocity of a body to the last of the next are 16 places.
    #[test]
    fn a_chain_is_a_band_whatever_the_order_of_its_bodies() {
        for n in [20, 200] {
            // Body i is joined to i/2-th … in a shuffled order of names.
            let name = |i: usize| (i * 7) % n;
            let mut links = vec![joint(name(0), None)];
            links.extend((1..n).map(|i| joint(name(i - 1), Some(name(i)))));
            let plan = layout(&vec![6; n], n, &links);
            assert_eq!(pieces(&plan.structures[0]), [6 * n, 11, 0]);
            assert_eq!(pieces(&plan.structures[1]), [11 * n, 16, 0]);
            assert!(pieces(&plan.structures[2])[1] <= 48, "{:?}", pieces(&plan.structures[2]));
            assert!(plan.in_tree.iter().all(|tree| *tree));
        }
    }

    #[test]
    fn a_loop_goes_to_the_border() {
        let n = 60;
        let chain = (1..n).map(|i| joint(i - 1, Some(i)));
        let grounded: Vec<Link> =
            [joint(0, None), joint(n - 1, None)].into_iter().chain(chain.clone()).collect();
        let plan = layout(&vec![6; n], n, &grounded);
        // The tree begins at one of the two joints with the ground; the other closes the loop.
        assert_eq!(pieces(&plan.structures[1]), [6 * n + 5 * (n + 1), 16, 5]);
        assert_eq!(plan.in_tree.iter().filter(|tree| !**tree).count(), 1);
        let ring: Vec<Link> = [joint(n - 1, Some(0)), joint(0, None)].into_iter().chain(chain).collect();
        let [_, half, border] = pieces(&layout(&vec![6; n], n, &ring).structures[1]);
        assert!(half == 16 && border <= 16, "half-bandwidth {half}, border {border}");
    }

    /// Twelve arms of ten bodies on one hub, and a comb.
    #[test]
    fn a_tree_is_a_band_with_its_hub_in_the_border() {
        let (arms, length) = (12, 10);
        let mut links = vec![joint(0, None)];
        for arm in 0..arms {
            for k in 0..length {
                let node = 1 + arm * length + k;
                links.push(joint(node, Some(if k == 0 { 0 } else { node - 1 })));
            }
        }
        let [_, half, border] =
            pieces(&layout(&vec![6; 1 + arms * length], 1 + arms * length, &links).structures[1]);
        assert!(half <= 16 && border == 11, "half-bandwidth {half}, border {border}");
        let mut links = vec![joint(0, None)];
        for k in 0..50 {
            links.push(joint(2 * k + 1, Some(2 * k)));
            if k > 0 {
                links.push(joint(2 * k, Some(2 * k - 2)));
            }
        }
        let [_, half, border] = pieces(&layout(&vec![6; 100], 100, &links).structures[1]);
        assert!(half <= 27 && border == 0, "half-bandwidth {half}, border {border}");
    }

    #[test]
    fn every_unknown_has_a_place_of_its_own() {
        let links = [joint(2, Some(0)), joint(1, Some(2)), joint(0, Some(1)), joint(3, Some(1))];
        let many: Vec<Link> = (0..30)
            .flat_map(|k| links.iter().map(move |l| Link::new(l.nodes.map(|n| n.map(|n| n + 4 * k)), l.rows)))
            .collect();
        let plan = layout(&[6; 120], 120, &many);
        for (k, structure) in plan.structures.iter().enumerate().skip(1) {
            let Structure::Ordered { places, .. } = structure else { panic!("{structure:?}") };
            let mut sorted = places.to_vec();
            sorted.sort_unstable();
            assert!(sorted.iter().map(|place| *place as usize).eq(0..720 + 600 * k), "{sorted:?}");
        }
    }
}

//! Joining modes of neighbouring speeds by their shapes.

use super::degenerate::are_equal;
use super::diagram::{Branch, Point};
use super::mac::{mac, passes_zero};
use super::modes::Mode;
use super::solved::Solved;

/// Assurance above which two shapes are taken for one mode.
const CLEAR: f64 = 0.6;
/// Assurance below which nothing continues a mode.
const FOREIGN: f64 = 0.01;
/// Assurance above which no other shape can be more like.
const ORDERED: f64 = 0.9;

/// The mode at the next speed that continues a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Match {
    /// Number of the mode at the next speed, unless none is left.
    to: Option<usize>,
    assurance: f64,
    /// Whether the continuation may lie beyond the modes computed.
    edge: bool,
}

impl Match {
    /// Whether there is no doubt, or more speeds would not help.
    pub(super) fn is_clear(self) -> bool {
        self.assurance >= CLEAR || self.edge
    }

    fn is_certain(self) -> bool {
        self.assurance >= CLEAR
    }
}

/// The first `count` modes whose continuation is certain, each with its number at the next speed.
fn certain(matches: &[Match], count: usize) -> Vec<(usize, usize)> {
    let certain = matches.iter().take(count).enumerate().filter(|(_, m)| m.is_certain());
    certain.filter_map(|(i, m)| Some((i, m.to?))).collect()
}

/// Whether two of the first `count` modes change their order, or one passes through zero: they cross, or veer so far that the step passes over it.
/// Modes that are of one eigenvalue at both speeds have no order.
pub(super) fn changes_order(from: &Solved, to: &Solved, matches: &[Match], count: usize) -> bool {
    let are_one = |of: &Solved, i: usize, j: usize| are_equal(of.modes[i].eigenvalue, of.modes[j].eigenvalue);
    let certain = certain(matches, count);
    // At rest no gyroscopic forces tell a whirl from its mirror image; in the rotating frame it slows down by as much as the speed at most.
    let begins = from.gyroscopic.is_empty() && !to.gyroscopic.is_empty();
    let slow = |a: usize| begins && from.modes[a].frequency() < to.speed - from.speed;
    certain.iter().any(|(a, c)| passes_zero(from, *a, to, *c) || slow(*a))
        || certain.windows(2).any(|pair| {
            let [(a, c), (b, d)] = [pair[0], pair[1]];
            c > d && !(are_one(from, a, b) && are_one(to, c, d))
        })
}

/// The lowest speed at which two of the first `count` modes are expected to change their order, or one to pass through zero, if their
/// eigenvalues are linear in between.
pub(super) fn crossing(from: &Solved, to: &Solved, matches: &[Match], count: usize) -> Option<f64> {
    let size = |of: &Solved, i: usize| of.modes[i].eigenvalue.norm();
    let part = |pair: &[(usize, usize)]| {
        let [(a, c), (b, d)] = [pair[0], pair[1]];
        let [before, behind] = [size(from, b) - size(from, a), size(to, d) - size(to, c)];
        (c > d).then_some(before / (before - behind)).filter(|part| part.is_finite())
    };
    let zero = |(a, c): &(usize, usize)| {
        passes_zero(from, *a, to, *c).then(|| size(from, *a) / (size(from, *a) + size(to, *c)))
    };
    let certain = certain(matches, count);
    let first =
        certain.windows(2).filter_map(part).chain(certain.iter().filter_map(zero)).reduce(f64::min)?;
    Some(from.speed + first * (to.speed - from.speed))
}

/// For each mode at one speed, its continuation at the next: largest assurance first.
pub(super) fn match_shapes(from: &Solved, to: &Solved) -> Vec<Match> {
    let pairs = assurances(from, to);
    let n = from.modes.len();
    let mut matches = assign(&pairs, n, to.modes.len());
    let last = to.modes.last().map_or(0.0, |m| m.eigenvalue.norm());
    for (m, mode) in matches.iter_mut().zip(&from.modes) {
        // A mode that was within one part in ten of the last one may have left.
        m.edge = mode.eigenvalue.norm() > 0.9 * last;
    }
    matches
}

/// Each row and each column once, largest entries first.
fn assign(pairs: &[Vec<f64>], rows: usize, columns: usize) -> Vec<Match> {
    let mut order: Vec<(usize, usize)> = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j))).collect();
    order.sort_by(|a, b| pairs[b.0][b.1].total_cmp(&pairs[a.0][a.1]));
    let mut matches = vec![Match { to: None, assurance: 0.0, edge: false }; rows];
    let mut taken = vec![false; columns];
    for (i, j) in order {
        if matches[i].to.is_none() && !taken[j] {
            matches[i] = Match { to: Some(j), assurance: pairs[i][j], edge: false };
            taken[j] = true;
        }
    }
    matches
}

/// Likeness of all pairs. Where those of equal number are
/// alike, the others are left at zero: a mode is like one other at most.
fn assurances(from: &Solved, to: &Solved) -> Vec<Vec<f64>> {
    let (rows, columns) = (from.modes.len(), to.modes.len());
    let of = |i: usize, j: usize| mac(from, i, to, j);
    let mut pairs = vec![vec![0.0; columns]; rows];
    let mut in_order = true;
    for k in 0..rows.min(columns) {
        pairs[k][k] = of(k, k);
        in_order &= pairs[k][k] > ORDERED;
    }
    if !in_order {
        for (i, row) in pairs.iter_mut().enumerate() {
            for (j, entry) in row.iter_mut().enumerate().filter(|(j, _)| *j != i) {
                *entry = of(i, j);
            }
        }
    }
    pairs
}

/// Branches that grow speed by speed.
pub(super) struct Tracker {
    pub branches: Vec<Branch>,
    /// Number of each branch's mode at the last speed, while it is among those computed.
    at: Vec<Option<usize>>,
}

impl Tracker {
    pub(super) fn new(first: Option<&Solved>, count: usize) -> Tracker {
        let modes = first.map_or(&[][..], |s| &s.modes);
        let speed = first.map_or(0.0, |s| s.speed);
        let point =
            |(number, mode): (usize, &Mode)| Point { speed, mode: mode.clone(), number, assurance: 1.0 };
        let points = modes.iter().take(count).enumerate().map(point);
        let branches: Vec<Branch> = points.map(|point| Branch { points: vec![point] }).collect();
        Tracker { at: (0..branches.len()).map(Some).collect(), branches }
    }

    /// Goes on to the next speed by the matches of the modes.
    pub(super) fn step(&mut self, matches: &[Match], to: &Solved) {
        for (branch, at) in self.branches.iter_mut().zip(&mut self.at) {
            let next = at.and_then(|at| matches.get(at)).and_then(|m| {
                let lost = m.assurance < if m.edge { CLEAR } else { FOREIGN };
                m.to.filter(|_| !lost).map(|to| (to, m.assurance))
            });
            *at = next.map(|(to, _)| to);
            if let Some((number, assurance)) = next {
                let mode = to.modes[number].clone();
                branch.points.push(Point { speed: to.speed, mode, number, assurance });
            }
        }
    }
}

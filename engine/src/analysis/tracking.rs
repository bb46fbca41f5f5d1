//! Following modes by their shapes.

use super::campbell::{Branch, Point, Solved};
use num_complex::Complex64;

/// Assurance above which two shapes are taken for one mode.
const CLEAR: f64 = 0.6;

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
}

/// For each of the lowest `count` modes at one speed, its continuation at the next: largest assurance first.
pub(super) fn match_shapes(from: &Solved, to: &Solved, count: usize) -> Vec<Match> {
    let pairs = assurances(from, to);
    let n = from.modes.modes.len();
    let mut matches = assign(&pairs, n, to.modes.modes.len());
    let last = to.modes.modes.last().map_or(0.0, |m| m.eigenvalue.norm());
    for (m, mode) in matches.iter_mut().zip(&from.modes.modes) {
        // A mode that was within one part in ten of the last one may have left.
        m.edge = mode.eigenvalue.norm() > 0.9 * last;
    }
    matches.truncate(count.min(n));
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

/// |xᴴ M y|² of all pairs; the vectors have modal mass 1.
fn assurances(from: &Solved, to: &Solved) -> Vec<Vec<f64>> {
    let n = to.mass.order();
    let (mut part, mut product) = (vec![0.0; n], vec![0.0; n]);
    let mut times = |z: &[Complex64]| {
        let mut out = vec![Complex64::ZERO; n];
        for (of, unit) in [(0, Complex64::ONE), (1, Complex64::I)] {
            for (p, z) in part.iter_mut().zip(z) {
                *p = if of == 0 { z.re } else { z.im };
            }
            to.mass.multiply(&part, &mut product);
            for (out, p) in out.iter_mut().zip(&product) {
                *out += unit * p;
            }
        }
        out
    };
    let massed: Vec<Vec<Complex64>> = to.modes.modes.iter().map(|m| times(&m.vector)).collect();
    let of = |x: &[Complex64]| {
        let inner =
            |y: &Vec<Complex64>| x.iter().zip(y).map(|(x, y)| x.conj() * y).sum::<Complex64>().norm_sqr();
        massed.iter().map(inner).collect::<Vec<f64>>()
    };
    from.modes.modes.iter().map(|m| of(&m.vector)).collect()
}

/// Branches that grow speed by speed.
pub(super) struct Tracker {
    pub branches: Vec<Branch>,
    /// Number of each branch's mode at the last speed, while it is followed.
    at: Vec<Option<usize>>,
}

impl Tracker {
    pub(super) fn new(first: Option<&Solved>, count: usize) -> Tracker {
        let modes = first.map_or(&[][..], |s| &s.modes.modes);
        let speed = first.map_or(0.0, |s| s.speed);
        let branch =
            |mode: &_| Branch { points: vec![Point { speed, mode: Clone::clone(mode), assurance: 1.0 }] };
        let branches: Vec<Branch> = modes.iter().take(count).map(branch).collect();
        Tracker { at: (0..branches.len()).map(Some).collect(), branches }
    }

    pub(super) fn step(&mut self, from: &Solved, to: &Solved) {
        let matches = match_shapes(from, to, from.modes.modes.len());
        for (branch, at) in self.branches.iter_mut().zip(&mut self.at) {
            let next = at.and_then(|at| matches.get(at)).and_then(|m| {
                let lost = m.edge && m.assurance < CLEAR;
                m.to.filter(|_| !lost).map(|to| (to, m.assurance))
            });
            *at = next.map(|(to, _)| to);
            if let Some((number, assurance)) = next {
                let mode = to.modes.modes[number].clone();
                branch.points.push(Point { speed: to.speed, mode, assurance });
            }
        }
    }
}

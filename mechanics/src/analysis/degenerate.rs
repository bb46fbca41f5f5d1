//! Modes of one frequency: which of the vectors in their space are shown.
//!
//! Any combination of modes of one eigenvalue is a mode. From speed to speed they are chosen as the projections of the modes
//! before on their space, in the inner product of M, so that what stays degenerate keeps its shapes.

use super::mac::product;
use super::solved::Solved;
use num_complex::Complex64;
use std::ops::Range;

/// Difference of two eigenvalues over their size, up to which they count as one.
const EQUAL: f64 = 1e-7;
/// Least part of a mode within the space that it is to continue in.
const WITHIN: f64 = 0.5;

/// Chooses the vectors of degenerate modes of `of` that are most like modes of `like`.
pub(super) fn align(like: &Solved, of: &mut Solved) {
    let mut begin = 0;
    while begin < of.modes.len() {
        let equal = |pair: &[super::modes::Mode]| {
            let [a, b] = [pair[0].eigenvalue, pair[1].eigenvalue];
            (b - a).norm() <= EQUAL * b.norm()
        };
        let end = begin + 1 + of.modes[begin..].windows(2).take_while(|pair| equal(pair)).count();
        if end - begin > 1 {
            project(like, of, begin..end);
        }
        begin = end;
    }
}

/// Replaces modes of one eigenvalue by the projections of as many modes of `like`.
fn project(like: &Solved, of: &mut Solved, equal: Range<usize>) {
    make_orthonormal(of, equal.clone());
    let weights = |x: &[Complex64]| -> Vec<(usize, Complex64)> {
        equal.clone().map(|k| (k, product(&of.massed[k], x))).collect()
    };
    let all: Vec<_> = like.modes.iter().map(|mode| weights(&mode.vector)).collect();
    let size = |i: &usize| all[*i].iter().map(|(_, w)| w.norm_sqr()).sum::<f64>();
    let mut best: Vec<usize> = (0..all.len()).filter(|i| size(i) > WITHIN).collect();
    best.sort_by(|a, b| size(b).total_cmp(&size(a)));
    best.truncate(equal.len());
    if best.len() < equal.len() {
        return;
    }
    best.sort_unstable();
    let turned: Vec<_> = best.iter().map(|i| combined(of, &all[*i])).collect();
    for (k, turned) in equal.clone().zip(turned) {
        put(of, k, turned);
    }
    make_orthonormal(of, equal);
}

/// Makes modes orthonormal in M, one after the other.
fn make_orthonormal(of: &mut Solved, modes: Range<usize>) {
    for k in modes.clone() {
        let before = modes.start..k;
        let mut weights: Vec<_> = before.map(|l| (l, -product(&of.massed[l], &of.modes[k].vector))).collect();
        weights.push((k, Complex64::ONE));
        let turned = combined(of, &weights);
        let size = product(&turned[0], &turned[1]).re.sqrt();
        if size > EQUAL {
            put(of, k, turned.map(|x| x.into_iter().map(|x| x / size).collect()));
        }
    }
}

/// x, M x and G x of a combination of modes.
fn combined(of: &Solved, weights: &[(usize, Complex64)]) -> [Vec<Complex64>; 3] {
    [
        sum(weights, |k| &of.modes[k].vector),
        sum(weights, |k| &of.massed[k]),
        sum(weights, |k| of.gyroscopic.get(k).map_or(&[], |x| x.as_slice())),
    ]
}

fn sum<'a>(weights: &[(usize, Complex64)], part: impl Fn(usize) -> &'a [Complex64]) -> Vec<Complex64> {
    let mut out = Vec::new();
    for (k, weight) in weights {
        out.resize(part(*k).len(), Complex64::ZERO);
        out.iter_mut().zip(part(*k)).for_each(|(out, x)| *out += weight * x);
    }
    out
}

fn put(of: &mut Solved, k: usize, [vector, massed, gyroscopic]: [Vec<Complex64>; 3]) {
    of.modes[k].vector = vector;
    of.massed[k] = massed;
    if let Some(out) = of.gyroscopic.get_mut(k) {
        *out = gyroscopic;
    }
}

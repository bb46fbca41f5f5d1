//! Modes of one frequency: which of the vectors in their space are shown.
//!
//! Any combination of modes of one eigenvalue is a mode. From speed to speed they are chosen as the projections of the modes
//! before on their space, so that what stays degenerate keeps its shapes: in the form of [`forms`] with gyroscopic forces, in which whirls of
//! one shape and two frequencies are orthogonal, in the inner product of M without, and where the form is not definite.

use super::mac::{forms, norm, product};
use super::solved::Solved;
use num_complex::Complex64;
use std::ops::Range;

/// Difference of two eigenvalues over their size, up to which they count as one.
const EQUAL: f64 = 1e-7;
/// Least part of a mode within the space that it is to continue in.
const WITHIN: f64 = 0.5;

/// Square of the sine of the angle below which two projections count as one.
const PARALLEL: f64 = 1e-4;

/// Whether two eigenvalues count as one.
pub(super) fn are_equal(a: Complex64, b: Complex64) -> bool {
    (b - a).norm() <= EQUAL * b.norm()
}

/// Chooses the vectors of degenerate modes of `of` that are most like modes of `like`.
pub(super) fn align(like: &Solved, of: &mut Solved) {
    let mut begin = 0;
    while begin < of.modes.len() {
        let equal = |pair: &[super::modes::Mode]| are_equal(pair[0].eigenvalue, pair[1].eigenvalue);
        let end = begin + 1 + of.modes[begin..].windows(2).take_while(|pair| equal(pair)).count();
        if end - begin > 1 {
            project(like, of, begin..end);
        }
        begin = end;
    }
}

/// Replaces modes of one eigenvalue by the projections of as many modes of `like`.
fn project(like: &Solved, of: &mut Solved, equal: Range<usize>) {
    let norms: Option<Vec<f64>> = equal.clone().map(|k| norm(of, k)).collect();
    let by_form = norms.is_some_and(|n| n.iter().all(|a| a * n[0] > 0.0)) && !like.gyroscopic.is_empty();
    make_orthonormal(of, equal.clone(), by_form);
    let all: Vec<Projection> =
        (0..like.modes.len())
            .map(|j| {
                if by_form {
                    in_form(like, j, of, equal.clone())
                } else {
                    in_mass(like, j, of, equal.clone())
                }
            })
            .collect();
    let mut best: Vec<usize> = (0..all.len()).filter(|j| all[*j].part > WITHIN).collect();
    best.sort_by(|a, b| all[*b].part.total_cmp(&all[*a].part));
    best.truncate(equal.len());
    if best.len() < equal.len() {
        return;
    }
    best.sort_unstable();
    if best.iter().enumerate().any(|(k, j)| best[..k].iter().any(|i| are_parallel(&all[*i], &all[*j]))) {
        return;
    }
    let turned: Vec<_> = best.iter().map(|j| combined(of, &all[*j].weights)).collect();
    for (k, turned) in equal.clone().zip(turned) {
        put(of, k, turned);
    }
    make_orthonormal(of, equal, by_form);
}

/// What a mode leaves in the space of others.
struct Projection {
    weights: Vec<(usize, Complex64)>,
    /// Part of the mode that is within, from 0 to 1.
    part: f64,
}

/// Whether two modes leave the same, as both whirls beyond a critical speed leave of those at rest.
fn are_parallel(a: &Projection, b: &Projection) -> bool {
    let size = |x: &Projection| x.weights.iter().map(|(_, w)| w.norm_sqr()).sum::<f64>();
    let both: Complex64 = a.weights.iter().zip(&b.weights).map(|((_, a), (_, b))| a.conj() * b).sum();
    both.norm_sqr() > (1.0 - PARALLEL) * size(a) * size(b)
}

/// Mode `j` of `like` in the inner product of M.
fn in_mass(like: &Solved, j: usize, of: &Solved, equal: Range<usize>) -> Projection {
    let weights: Vec<_> = equal.map(|k| (k, product(&of.massed[k], &like.modes[j].vector))).collect();
    let part = weights.iter().map(|(_, w)| w.norm_sqr()).sum();
    Projection { weights, part }
}

/// Mode `j` of `like`, or its conjugate of −ω where more of that is within, in the form n.
fn in_form(like: &Solved, j: usize, of: &Solved, equal: Range<usize>) -> Projection {
    let Some(m) = norm(like, j) else {
        return Projection { weights: Vec::new(), part: 0.0 };
    };
    let mut both = [(); 2].map(|()| Projection { weights: Vec::new(), part: 0.0 });
    for k in equal {
        let Some(n) = norm(of, k) else { continue };
        let [same, conjugate] = forms(of, k, like, j);
        for (projection, form) in both.iter_mut().zip([same, -conjugate.conj()]) {
            projection.weights.push((k, form / n));
            projection.part += form.norm_sqr() / (n * m).abs();
        }
    }
    let [same, conjugate] = both;
    if same.part >= conjugate.part { same } else { conjugate }
}

/// Makes modes orthogonal in M, or in the form n, one after the other, and of modal mass 1.
fn make_orthonormal(of: &mut Solved, modes: Range<usize>, by_form: bool) {
    for k in modes.clone() {
        let weight = |l: usize| match norm(of, l).filter(|_| by_form) {
            Some(n) => forms(of, l, of, k)[0] / n,
            None => product(&of.massed[l], &of.modes[k].vector),
        };
        let mut weights: Vec<_> = (modes.start..k).map(|l| (l, -weight(l))).collect();
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

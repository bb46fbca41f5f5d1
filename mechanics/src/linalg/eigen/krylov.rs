//! The Krylov space of an operator, orthonormal in its inner product to working precision.

use super::EigenError;
use super::operators::{Operator, noise};
use super::pencil::dot;
use super::small::{Ritz, hessenberg, skew, symmetric};
use num_complex::Complex64;

/// Relative error estimate at which an eigenvalue has converged. The error of the eigenvalue of a symmetric or
/// skew operator is about its square.
const TOLERANCE: f64 = 1e-12;
/// Share of a vector left by orthogonalisation below which the space is invariant.
const INVARIANT: f64 = 1e-13;

/// What the operator is in its inner product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Projection {
    Symmetric,
    Skew,
    Hessenberg,
}

/// Orthonormal vectors and their duals.
#[derive(Clone, Debug, Default)]
pub(super) struct Space {
    vectors: Vec<Vec<f64>>,
    duals: Vec<Vec<f64>>,
}

impl Space {
    /// Adds a vector and its dual, normalised.
    pub(super) fn push(&mut self, mut z: Vec<f64>, mut dual: Vec<f64>) {
        let size = norm(&z, &dual);
        if size > 0.0 {
            scale(&mut z, 1.0 / size);
            scale(&mut dual, 1.0 / size);
        }
        self.vectors.push(z);
        self.duals.push(dual);
    }

    /// Adds the real and imaginary parts of a vector, as far as they are not there.
    pub(super) fn push_complex(&mut self, lifted: &Lifted) {
        let part = |z: &[Complex64], of: fn(&Complex64) -> f64| z.iter().map(of).collect::<Vec<f64>>();
        let of: [fn(&Complex64) -> f64; 2] = [|z| z.re, |z| z.im];
        for of in of {
            let (mut z, mut dual) = (part(&lifted.vector, of), part(&lifted.dual, of));
            let before = norm(&z, &dual);
            self.remove(&mut z, &mut dual, None);
            if norm(&z, &dual) > 1e-3 * before {
                self.push(z, dual);
            }
        }
    }

    /// Takes the part in the space away from w; adds the coefficients to `h`.
    fn remove(&self, w: &mut [f64], dual_w: &mut [f64], mut h: Option<&mut [f64]>) {
        for (j, (z, dual)) in self.vectors.iter().zip(&self.duals).enumerate() {
            let c = dot(w, dual);
            if let Some(h) = h.as_deref_mut() {
                h[j] += c;
            }
            for (w, z) in w.iter_mut().zip(z) {
                *w -= c * z;
            }
            for (w, z) in dual_w.iter_mut().zip(dual) {
                *w -= c * z;
            }
        }
    }
}

fn norm(z: &[f64], dual: &[f64]) -> f64 {
    dot(z, dual).max(0.0).sqrt()
}

fn scale(z: &mut [f64], c: f64) {
    z.iter_mut().for_each(|z| *z *= c);
}

/// Approximate eigenpairs of an operator, largest first.
pub(super) struct Approximate {
    pub pairs: Vec<Lifted>,
}

/// An eigenvalue of the operator, its vector, and the dual of that.
pub(super) struct Lifted {
    pub value: Complex64,
    pub vector: Vec<Complex64>,
    pub dual: Vec<Complex64>,
}

/// The `wanted` largest eigenpairs of `operator` orthogonal to `locked` (of conjugate pairs both count as one);
/// at least these are returned, if there are so many.
pub(super) fn krylov(
    operator: &mut dyn Operator,
    locked: &Space,
    wanted: usize,
    projection: Projection,
    seed: u64,
) -> Result<Approximate, EigenError> {
    let n = operator.len();
    let copies = if projection == Projection::Symmetric { 1 } else { 2 };
    let limit = (copies * (8 * wanted + 120)).min(n);
    let mut next_look = (copies * (2 * wanted + 6)).min(limit);
    let mut space = Space::default();
    // Columns of the projected matrix, each with the entry below.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let (mut w, mut dual_w) = (vec![0.0; n], vec![0.0; n]);
    let mut seeds = (0..u64::MAX).map(|k| 1 + 1000 * seed + k);
    // A fresh vector, orthogonal to everything, or none if everything is spanned.
    let mut fresh = |operator: &mut dyn Operator, space: &Space, w: &mut [f64], dual_w: &mut [f64]| {
        let r = noise(n, seeds.next().unwrap_or(1));
        operator.start(&r, w, dual_w);
        let before = norm(w, dual_w);
        for _ in 0..3 {
            locked.remove(w, dual_w, None);
            space.remove(w, dual_w, None);
        }
        norm(w, dual_w) > 1e-10 * before
    };
    if !fresh(operator, &space, &mut w, &mut dual_w) {
        return Ok(Approximate { pairs: Vec::new() });
    }
    let mut largest: f64 = 0.0;
    loop {
        space.push(w.clone(), dual_w.clone());
        let m = space.vectors.len();
        operator.apply(&space.vectors[m - 1], &space.duals[m - 1], &mut w, &mut dual_w);
        let before = norm(&w, &dual_w);
        largest = largest.max(before);
        let mut h = vec![0.0; m + 1];
        for _ in 0..2 {
            locked.remove(&mut w, &mut dual_w, None);
            space.remove(&mut w, &mut dual_w, Some(&mut h[..m]));
        }
        h[m] = norm(&w, &dual_w);
        if !before.is_finite() {
            return Err(EigenError::Projection(m));
        }
        let mut exhausted = m == limit && limit == n;
        if h[m] <= INVARIANT * largest {
            h[m] = 0.0;
            exhausted |= !fresh(operator, &space, &mut w, &mut dual_w);
        }
        columns.push(h);
        if m < next_look && !exhausted {
            continue;
        }
        next_look = (m + m / 4 + 2).min(limit);
        let ritz = match projection {
            Projection::Symmetric => symmetric(&columns),
            Projection::Skew => skew(&columns),
            Projection::Hessenberg => hessenberg(&columns)?,
        };
        // Of a conjugate pair the one in the upper half plane of λ, that is below the real axis of θ, counts.
        let counted: Vec<&Ritz> =
            ritz.iter().filter(|r| projection == Projection::Symmetric || r.value.im <= 0.0).collect();
        let good = |r: &Ritz| r.error <= TOLERANCE * r.value.norm();
        let converged = counted.iter().take(wanted).take_while(|r| good(r)).count();
        if converged >= wanted || exhausted {
            return Ok(Approximate {
                pairs: counted.iter().take(converged.max(wanted)).map(|r| lift(&space, r)).collect(),
            });
        }
        if m >= limit {
            return Err(EigenError::NotConverged { wanted, converged, dimension: m });
        }
    }
}

/// The vector of the space with the coefficients of a Ritz pair.
fn lift(space: &Space, ritz: &Ritz) -> Lifted {
    let combine = |vectors: &[Vec<f64>]| {
        let mut z = vec![Complex64::default(); vectors.first().map_or(0, Vec::len)];
        for (c, vector) in ritz.coefficients.iter().zip(vectors) {
            for (z, v) in z.iter_mut().zip(vector) {
                *z += c * v;
            }
        }
        z
    };
    Lifted { value: ritz.value, vector: combine(&space.vectors), dual: combine(&space.duals) }
}

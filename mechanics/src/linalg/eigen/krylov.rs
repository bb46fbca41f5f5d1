//! The Krylov space of an operator, orthonormal in its inner product to working precision.

use super::EigenError;
use super::operators::Operator;
use super::small::{Ritz, Spectrum, skew, symmetric};
use crate::linalg::vector::{add_four, axpy, dot, dots, noise, scale};
use num_complex::Complex64;

/// Relative error estimate at which an eigenvalue has converged. The error of the eigenvalue of a symmetric or
/// skew operator is about its square.
pub(super) const TOLERANCE: f64 = 1e-12;
/// Share of a vector left by orthogonalisation below which the space of a matrix that is not symmetric is invariant.
const INVARIANT: f64 = 1e-13;

/// Size of a product of the operator with a unit vector, over the largest, up to which it may be zero but for rounding: of an eigenvalue of a matrix that is not
/// symmetric, and of what is left of a vector, of which rounding may make any eigenvalue where all motions have been found.
const ROUNDING: f64 = 1e-11;

/// |Im θ|/|θ| = √(1 − ζ²) at a damping ratio of 0.99, below which a vibration that has not converged may be two motions that only decay.
const OVERDAMPED: f64 = 0.15;

/// Share of noise in a vector to begin with of which nothing is counted: no eigenvector is missing in it.
const STRAY: f64 = 1e-3;

/// Dimension up to which a space of a matrix that is not symmetric may become the whole one.
const WHOLE: usize = 600;

/// Form of the projected operator.
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
            scale(1.0 / size, &mut z);
            scale(1.0 / size, &mut dual);
        }
        self.vectors.push(z);
        self.duals.push(dual);
    }

    /// Adds the vectors of another space that have these coefficients, as far as they are not there.
    pub(super) fn push_from(&mut self, other: &Space, ritz: &Ritz) {
        for of in [|c: &Complex64| c.re, |c: &Complex64| c.im] {
            let part: Vec<f64> = ritz.coefficients.iter().map(of).collect();
            let (mut z, mut dual) = (combine(&other.vectors, &part), combine(&other.duals, &part));
            let before = norm(&z, &dual);
            self.remove(&mut z, Some(&mut dual), &mut []);
            if norm(&z, &dual) > 1e-3 * before {
                self.push(z, dual);
            }
        }
    }

    /// The first `n` entries of the vector with these coefficients.
    pub(super) fn vector(&self, ritz: &Ritz, n: usize) -> Vec<Complex64> {
        let [re, im] = [|c: &Complex64| c.re, |c: &Complex64| c.im].map(|of| {
            let mut out = vec![0.0; n];
            let coefficients: Vec<f64> = ritz.coefficients.iter().map(of).collect();
            add(&self.vectors, &coefficients, &mut out);
            out
        });
        re.into_iter().zip(im).map(|(re, im)| Complex64::new(re, im)).collect()
    }

    /// Removes the part of w in the space, from its dual too if that is given; adds the coefficients to `h`, as far as it reaches.
    ///
    /// All coefficients are those of w as it comes (classical Gram–Schmidt): done twice it leaves working precision.
    ///
    /// Source: L. Giraud, J. Langou, M. Rozložník & J. van den Eshof, *Numer. Math.* 101 (2005) 87–100, doi:10.1007/s00211-005-0615-4.
    fn remove(&self, w: &mut [f64], dual_w: Option<&mut [f64]>, h: &mut [f64]) {
        let (fours, rest) = self.duals.as_chunks::<4>();
        let mut c: Vec<f64> = Vec::with_capacity(self.duals.len());
        fours.iter().for_each(|duals| c.extend(dots(duals.each_ref().map(Vec::as_slice), w)));
        c.extend(rest.iter().map(|dual| dot(w, dual)));
        h.iter_mut().zip(&c).for_each(|(h, c)| *h += c);
        c.iter_mut().for_each(|c| *c = -*c);
        add(&self.vectors, &c, w);
        if let Some(dual_w) = dual_w {
            add(&self.duals, &c, dual_w);
        }
    }
}

fn norm(z: &[f64], dual: &[f64]) -> f64 {
    dot(z, dual).max(0.0).sqrt()
}

/// y ← y + Σ c z, as many entries as y has.
fn add(vectors: &[Vec<f64>], coefficients: &[f64], y: &mut [f64]) {
    let ((fours, rest), (of_fours, of_rest)) = (vectors.as_chunks::<4>(), coefficients.as_chunks::<4>());
    for (vectors, c) in fours.iter().zip(of_fours) {
        add_four(*c, vectors.each_ref().map(Vec::as_slice), y);
    }
    rest.iter().zip(of_rest).for_each(|(z, c)| axpy(*c, z, y));
}

/// Σ c z
fn combine(vectors: &[Vec<f64>], coefficients: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; vectors.first().map_or(0, Vec::len)];
    add(vectors, coefficients, &mut out);
    out
}

/// The eigenpairs to find.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    /// Number of the largest eigenpairs that count; of conjugate pairs both count as one.
    pub wanted: usize,
    /// Whether an eigenvalue θ counts.
    pub counts: &'a dyn Fn(Complex64) -> bool,
    pub projection: Projection,
    /// Relative error estimate |A z − θ z|/|θ| at which an eigenvalue has converged.
    pub tolerance: f64,
    /// A vector in which the eigenvectors are strong, if there is one.
    pub start: Option<&'a [f64]>,
    /// Number of the sequence of random start vectors.
    pub seed: u64,
}

/// Result: the largest eigenpairs in the coefficients of a space, those that do not count as far as they have converged; and how many
/// that count have converged.
pub(super) struct Found {
    pub space: Space,
    pub pairs: Vec<Ritz>,
    /// Number of pairs that count.
    pub counting: usize,
    /// Number of eigenvalues of the space that do not count, converged or not.
    pub others: usize,
    pub converged: usize,
}

impl Found {
    /// Itself, if as many as were `wanted` have converged.
    pub(super) fn all(self, wanted: usize) -> Result<Found, EigenError> {
        let (converged, dimension) = (self.converged, self.space.vectors.len());
        if converged < wanted {
            Err(EigenError::NotConverged { wanted, converged, dimension })
        } else {
            Ok(self)
        }
    }
}

/// The largest eigenpairs of `operator` orthogonal to `locked`, as many as `wanted`, or all.
pub(super) fn krylov(
    operator: &mut dyn Operator,
    locked: &Space,
    search: Search<'_>,
) -> Result<Found, EigenError> {
    let Search { wanted, projection, start, seed, .. } = search;
    let n = operator.dimension();
    let copies = if projection == Projection::Symmetric { 1 } else { 2 };
    let most = copies * (8 * wanted + 120);
    // A whole space of moderate size tells vibrations from many motions that decay alike.
    let limit = if projection == Projection::Hessenberg { most.max(WHOLE) } else { most }.min(n);
    let first_look = if start.is_some() { 2 * copies * wanted } else { copies * (2 * wanted + 6) };
    // The fewer steps are expected to be missing, the sooner the next look.
    let part = if projection == Projection::Hessenberg && start.is_some() { 8 } else { 4 };
    let mut next_look = first_look.min(limit);
    let mut space = Space::default();
    // Columns of the projected matrix, each with the entry below.
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let (mut w, mut dual_w) = (vec![0.0; n], vec![0.0; n]);
    let mut seeds = (0..u64::MAX).map(|k| 1 + 1000 * seed + k);
    // A new vector, orthogonal to everything, or none if what is left of noise is what rounding makes of the largest that A has made.
    let mut begin =
        |operator: &mut dyn Operator, space: &Space, largest: f64, w: &mut [f64], dual_w: &mut [f64]| {
            let mut dual = vec![0.0; n];
            let mut random = noise(n, seeds.next().unwrap_or(1));
            operator.dual(&random, &mut dual);
            let rounding = ROUNDING * largest * norm(&random, &dual);
            // Of what is spanned A may make so much more than of the rest that the rest would be lost in its rounding.
            for _ in 0..2 {
                locked.remove(&mut random, None, &mut []);
                space.remove(&mut random, None, &mut []);
            }
            let mut image = |r: &[f64], w: &mut [f64], dual_w: &mut [f64]| {
                operator.dual(r, &mut dual);
                operator.apply(r, &dual, w, dual_w);
                operator.dual(w, dual_w);
                norm(w, dual_w)
            };
            let size = image(&random, w, dual_w);
            if let Some(start) = start.filter(|_| space.vectors.is_empty()) {
                let (stray, dual_stray) = (w.to_vec(), dual_w.to_vec());
                let part = STRAY * image(start, w, dual_w) / size;
                if projection == Projection::Hessenberg && size > 0.0 {
                    axpy(part, &stray, w);
                    axpy(part, &dual_stray, dual_w);
                }
            }
            for _ in 0..3 {
                locked.remove(w, Some(dual_w), &mut []);
                space.remove(w, Some(dual_w), &mut []);
            }
            norm(w, dual_w) > rounding
        };
    if !begin(operator, &space, 0.0, &mut w, &mut dual_w) {
        return Ok(Found { space, pairs: Vec::new(), counting: 0, others: 0, converged: wanted });
    }
    let carries = !operator.knows_duals();
    let (mut largest, mut last): (f64, Option<Spectrum>) = (0.0, None);
    loop {
        space.push(w.clone(), dual_w.clone());
        let m = space.vectors.len();
        operator.apply(&space.vectors[m - 1], &space.duals[m - 1], &mut w, &mut dual_w);
        let mut h = vec![0.0; m + 1];
        for _ in 0..2 {
            locked.remove(&mut w, carries.then_some(&mut dual_w), &mut []);
            space.remove(&mut w, carries.then_some(&mut dual_w), &mut h[..m]);
        }
        operator.dual(&w, &mut dual_w);
        h[m] = norm(&w, &dual_w);
        let size = dot(&h, &h).sqrt();
        largest = largest.max(size);
        if !size.is_finite() {
            return Err(EigenError::Projection(m));
        }
        let mut exhausted = m == limit && limit == n;
        let invariant = if projection == Projection::Hessenberg { INVARIANT } else { ROUNDING };
        if h[m] <= invariant * largest {
            h[m] = 0.0;
            exhausted |= !begin(operator, &space, largest, &mut w, &mut dual_w);
        }
        columns.push(h);
        if m < next_look && !exhausted {
            continue;
        }
        next_look = (m + m / part + 2).min(limit);
        let mut is_last = exhausted || m >= limit;
        let spectrum = match (projection, last.take()) {
            (Projection::Symmetric, _) => Spectrum::from(symmetric(&columns)),
            (Projection::Skew, _) => Spectrum::from(skew(&columns)),
            (Projection::Hessenberg, last) => match (Spectrum::of(&columns), last) {
                (Ok(spectrum), _) => spectrum,
                // The iteration for the eigenvalues of a projected matrix may fail where the last one was solved.
                (Err(_), Some(spectrum)) => {
                    is_last = true;
                    spectrum
                }
                (Err(error), None) => return Err(error),
            },
        };
        let Selected { places, counting, others, converged } =
            select(&spectrum.ritz, &search, largest, is_last);
        if converged >= wanted || is_last {
            let pairs = spectrum.take(&places);
            let converged = if exhausted { wanted } else { converged };
            return Ok(Found { space, pairs, counting, others, converged });
        }
        last = Some(spectrum);
    }
}

/// What is taken of the eigenpairs of a projected matrix.
struct Selected {
    /// Places of the largest, ascending: those that count, and those that do not as far as they have converged.
    places: Vec<usize>,
    /// Number of those that count, and of those up to the last that do not.
    counting: usize,
    others: usize,
    /// Number of those that have converged, up to the first that has not.
    converged: usize,
}

/// Takes of eigenpairs in descending order so many as are wanted, and what lies between them.
fn select(ritz: &[Ritz], search: &Search<'_>, largest: f64, is_last: bool) -> Selected {
    let has_converged = |r: &Ritz| r.error <= search.tolerance * r.value.norm();
    // Of a conjugate pair the one in the upper half plane of λ, that is below the real axis of θ, counts.
    let is_upper = |r: &Ritz| search.projection == Projection::Symmetric || r.value.im <= 0.0;
    let noise = f64::EPSILON * ritz.len() as f64 * largest;
    let is_known = |r: &Ritz| {
        search.projection != Projection::Hessenberg || !is_unknown(r, search, [largest, noise], is_last)
    };
    let (mut places, mut counting, mut others, mut converged) = (Vec::new(), 0, 0, 0);
    for (k, r) in ritz.iter().enumerate().filter(|(_, r)| is_upper(r) && is_known(r)) {
        if (search.counts)(r.value) {
            if counting == search.wanted {
                break;
            }
            converged += usize::from(converged == counting && has_converged(r));
            counting += 1;
        } else {
            others += 1;
            if !has_converged(r) {
                continue;
            }
        }
        places.push(k);
    }
    Selected { places, counting, others, converged }
}

/// Whether an eigenvalue of a matrix that is not symmetric says too little to be counted or waited for.
///
/// Errors of the matrix are magnified by the condition number of the eigenvalue: where directions have no mass, or damping leaves many motions that decay
/// alike, what is real or zero comes out as a pair anywhere within them.
fn is_unknown(r: &Ritz, search: &Search<'_>, [largest, noise]: [f64; 2], is_last: bool) -> bool {
    let (size, across) = (r.value.norm(), r.value.im.abs());
    let counts = (search.counts)(r.value);
    let rounding = if counts { r.condition * noise } else { 0.0 };
    let is_zero = size <= f64::max(ROUNDING * largest, rounding);
    let error = if is_last && counts { r.condition * r.error + rounding } else { r.error };
    let has_no_digit = size < error;
    // As many are next to a cluster of overdamped motions.
    let decays = |sign: f64| !(search.counts)((r.value.re + sign * error).into());
    let may_be_real = counts && across < error && decays(-1.0) && decays(1.0);
    is_zero || is_last && (has_no_digit || may_be_real) || may_be_real && across < OVERDAMPED * size
}

/// The largest eigenvalue θ of a symmetric operator, from a Krylov space in which |A z − θ z| ≤ `tolerance`·θ, or of
/// the largest dimension allowed; approached from below. Zero for an operator that is zero.
///
/// # Errors
/// [`EigenError::Projection`] for numbers that are not finite.
pub fn largest(operator: &mut dyn Operator, tolerance: f64) -> Result<f64, EigenError> {
    let projection = Projection::Symmetric;
    let search = Search { wanted: 1, counts: &|_| true, projection, tolerance, start: None, seed: 0 };
    let found = krylov(operator, &Space::default(), search)?;
    Ok(found.pairs.first().map_or(0.0, |pair| pair.value.re))
}

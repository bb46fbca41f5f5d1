//! The three matrices of an eigenproblem, and its solutions.

use super::super::{Double, Matrix, Storage, Structure, negative_pivots_of};
use super::krylov::{Projection, Space, krylov};
use super::operators::{General, Gyroscopic, Symmetric};
use super::{EigenError, Pair};
use num_complex::Complex64;

/// What is known of the matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// M, K symmetric, C = 0.
    Symmetric,
    /// M, K symmetric, K positive definite, C skew.
    Gyroscopic,
    /// Anything else: damping, circulatory forces, an indefinite K with gyroscopic forces.
    General,
}

/// M, C, K of (λ² M + λ C + K) x = 0.
#[derive(Debug)]
pub struct Pencil {
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix<Double>,
    /// Q(σ), factored.
    factor: Matrix<Double>,
    shift: f64,
    kind: Kind,
    wide: Vec<Double>,
    solutions: usize,
}

/// Relative size at which an entry counts as zero.
const NOUGHT: f64 = 1e-12;

impl Pencil {
    /// The pencil of three matrices of equal structure, factored at the shift σ.
    ///
    /// # Errors
    /// [`EigenError::Singular`] when σ is an eigenvalue.
    pub fn new(
        mass: Matrix,
        damping: Matrix,
        stiffness: Matrix<Double>,
        shift: f64,
    ) -> Result<Pencil, EigenError> {
        let n = mass.order();
        let mut factor = stiffness.clone();
        if shift != 0.0 {
            each(&mass, |i, j| {
                let c = Double::from(damping.get(i, j)) * shift.into();
                let m = Double::from(mass.get(i, j)) * shift.into() * shift.into();
                factor.add(i, j, c + m);
            });
        }
        factor.factor()?;
        let mut pencil = Pencil {
            mass,
            damping,
            stiffness,
            factor,
            shift,
            kind: Kind::General,
            wide: vec![Double::ZERO; n],
            solutions: 0,
        };
        pencil.kind = pencil.find_kind();
        Ok(pencil)
    }

    /// Order n of the matrices.
    pub fn order(&self) -> usize {
        self.mass.order()
    }

    /// The mass matrix M.
    pub fn mass(&self) -> &Matrix {
        &self.mass
    }

    /// The matrix C of damping and gyroscopic forces.
    pub fn damping(&self) -> &Matrix {
        &self.damping
    }

    /// The shift σ.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// What the matrices are.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Number of solutions with Q(σ) so far, each O(n).
    pub fn solutions(&self) -> usize {
        self.solutions
    }

    /// b ← Q(σ)⁻¹ b, right to the rounding of the result.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.solutions += 1;
        for (wide, b) in self.wide.iter_mut().zip(b.iter()) {
            *wide = (*b).into();
        }
        self.factor.solve(&mut self.wide);
        for (b, wide) in b.iter_mut().zip(&self.wide) {
            *b = wide.value();
        }
    }

    fn find_kind(&self) -> Kind {
        let (mut m, mut c, mut k) = (Parts::default(), Parts::default(), Parts::default());
        each(&self.mass, |i, j| {
            m.look(self.mass.get(i, j), self.mass.get(j, i));
            c.look(self.damping.get(i, j), self.damping.get(j, i));
            k.look(self.stiffness.get(i, j).value(), self.stiffness.get(j, i).value());
        });
        if !(m.is_symmetric() && k.is_symmetric()) {
            Kind::General
        } else if c.largest == 0.0 {
            Kind::Symmetric
        } else if c.symmetric <= NOUGHT * c.largest
            && self.shift == 0.0
            && negative_eigenvalues(&self.stiffness) == Some(0)
        {
            Kind::Gyroscopic
        } else {
            Kind::General
        }
    }

    /// Number of eigenfrequencies below `frequency` [rad/s], from the inertia of K − ω² M + iω C, without computing
    /// them: for conservative systems ([`Kind::Symmetric`]: of ω² below the square, divergent ones included;
    /// [`Kind::Gyroscopic`]). `None` for others, and with a border.
    ///
    /// The Hermitian matrix is counted as a real one of twice the order. Its eigenvalues fall with ω > 0 through
    /// zero once each, since M ≥ 0 and K > 0.
    pub fn count_below(&self, frequency: f64) -> Option<usize> {
        let half = half_bandwidth(&self.stiffness)?;
        let square = Double::from(frequency) * frequency.into();
        let entry = |i: usize, j: usize| self.stiffness.get(i, j) - square * self.mass.get(i, j).into();
        let negative = |x: Double| x.value() < 0.0;
        match self.kind {
            Kind::Symmetric => Some(negative_pivots_of(self.order(), half, entry, negative)),
            Kind::General => None,
            Kind::Gyroscopic => {
                let skew = |i: usize, j: usize| {
                    Double::from(frequency) * (0.5 * (self.damping.get(i, j) - self.damping.get(j, i))).into()
                };
                // Re and Im of an unknown side by side: [[A, −B], [B, A]] for A + iB.
                let doubled = |i: usize, j: usize| match (i % 2, j % 2) {
                    (0, 1) => -skew(i / 2, j / 2),
                    (1, 0) => skew(i / 2, j / 2),
                    _ => entry(i / 2, j / 2),
                };
                Some(negative_pivots_of(2 * self.order(), 2 * half + 1, doubled, negative) / 2)
            }
        }
    }

    /// At least `count` eigenpairs next to the shift (fewer if there are fewer), ascending in |λ|, Im λ ≥ 0. Of a real
    /// pair ±λ of a symmetric pencil the growing one is given.
    ///
    /// # Errors
    /// [`EigenError`] when they do not converge.
    pub fn pairs(&mut self, count: usize) -> Result<Vec<Pair>, EigenError> {
        let found = match self.kind {
            Kind::Symmetric | Kind::Gyroscopic => self.conservative(count)?,
            Kind::General => self.general(count)?,
        };
        let mut pairs: Vec<Pair> = found
            .into_iter()
            .map(|(value, vector)| Pair { residual: self.residual(value, &vector), value, vector })
            .collect();
        pairs.sort_by(|a, b| a.value.norm().total_cmp(&b.value.norm()));
        Ok(pairs)
    }

    /// The pairs of a conservative pencil. Copies of a multiple eigenvalue are found one after the other, by a
    /// space that is orthogonal to what was found, until the count of frequencies says that none is missing.
    fn conservative(&mut self, count: usize) -> Result<Vec<(Complex64, Vec<Complex64>)>, EigenError> {
        let (n, shift) = (self.order(), self.shift);
        let mut found: Vec<(Complex64, Vec<Complex64>)> = Vec::new();
        let mut locked = Space::default();
        for round in 0..=count as u64 {
            // Copies are looked for one at a time.
            let wanted = if round == 0 { count } else { 1 };
            let ritz = if self.kind == Kind::Symmetric {
                krylov(&mut Symmetric(self), &locked, wanted, Projection::Symmetric, round)?
            } else {
                krylov(&mut Gyroscopic(self), &locked, wanted, Projection::Skew, round)?
            };
            let before = found.len();
            for mut lifted in ritz.pairs.into_iter().filter(|r| r.value.norm() > 0.0).take(wanted) {
                locked.push_complex(&lifted);
                let value = if self.kind == Kind::Symmetric {
                    let square = 1.0 / lifted.value.re - shift * shift;
                    let root = square.abs().sqrt();
                    if square < 0.0 { Complex64::new(root, 0.0) } else { Complex64::new(0.0, root) }
                } else {
                    Complex64::new(0.0, (1.0 / lifted.value).im)
                };
                lifted.vector.truncate(n);
                found.push((value, lifted.vector));
            }
            found.sort_by(|a, b| a.0.norm().total_cmp(&b.0.norm()));
            if found.len() == before || self.is_complete(&found, count) {
                break;
            }
        }
        Ok(found)
    }

    /// Whether nothing is missing among the first `count` eigenvalues found.
    fn is_complete(&self, found: &[(Complex64, Vec<Complex64>)], count: usize) -> bool {
        let Some((last, _)) = found.get(count.min(found.len()).saturating_sub(1)) else { return true };
        // With divergent eigenvalues those found need not be the lowest: nothing is counted.
        if found.iter().any(|(value, _)| value.re != 0.0) {
            return true;
        }
        let limit = last.im * (1.0 - 1e-8);
        let below = found.iter().filter(|(value, _)| value.im < limit).count();
        self.count_below(limit).is_none_or(|counted| counted <= below)
    }

    fn general(&mut self, count: usize) -> Result<Vec<(Complex64, Vec<Complex64>)>, EigenError> {
        let (n, shift) = (self.order(), self.shift);
        let mut operator = General::new(self);
        let ritz = krylov(&mut operator, &Space::default(), count, Projection::Hessenberg, 0)?;
        let values = ritz.pairs.into_iter().filter(|r| r.value.norm() > 0.0);
        Ok(values
            .map(|r| (1.0 / r.value + shift, r.vector))
            .filter(|(value, _)| value.im >= 0.0)
            .take(count)
            .map(|(value, mut z)| {
                z.truncate(n);
                (value, z)
            })
            .collect())
    }

    /// The residual of a pair seen through Q(|λ|) in the place of Q(σ). Where K is nearly singular, K⁻¹ magnifies by (λ/λ₁)²
    /// what rounding leaves of the lowest mode in the others; the inverse of K + |λ|C + |λ|²M magnifies nothing. O(n).
    pub fn residual_at_its_size(&self, value: Complex64, vector: &[Complex64]) -> f64 {
        let [mass, damping] = [self.mass.clone(), self.damping.clone()];
        let shifted = Pencil::new(mass, damping, self.stiffness.clone(), value.norm());
        shifted.map_or(f64::NAN, |mut pencil| pencil.residual(value, vector))
    }

    /// |x + Q(σ)⁻¹ (λ − σ)((λ + σ) M + C) x| / |x|, since Q(λ) = Q(σ) + (λ − σ)((λ + σ) M + C).
    fn residual(&mut self, value: Complex64, x: &[Complex64]) -> f64 {
        let n = x.len();
        let (mut mx, mut cx) = ([vec![0.0; n], vec![0.0; n]], [vec![0.0; n], vec![0.0; n]]);
        let parts: [Vec<f64>; 2] = [x.iter().map(|x| x.re).collect(), x.iter().map(|x| x.im).collect()];
        for part in 0..2 {
            self.mass.multiply(&parts[part], &mut mx[part]);
            self.damping.multiply(&parts[part], &mut cx[part]);
        }
        let shift = self.shift;
        let mut r = parts.clone();
        for i in 0..n {
            let (m, c) = (Complex64::new(mx[0][i], mx[1][i]), Complex64::new(cx[0][i], cx[1][i]));
            let f = (value - shift) * ((value + shift) * m + c);
            (r[0][i], r[1][i]) = (f.re, f.im);
        }
        let (mut off, mut size) = (0.0, 0.0);
        let mut mr = vec![0.0; n];
        for part in 0..2 {
            self.solve(&mut r[part]);
            for (r, x) in r[part].iter_mut().zip(&parts[part]) {
                *r += x;
            }
            self.mass.multiply(&r[part], &mut mr);
            off += dot(&r[part], &mr);
            size += dot(&parts[part], &mx[part]);
        }
        (off.abs() / size).sqrt()
    }
}

/// Size of a matrix and of its symmetric and skew parts.
#[derive(Default)]
struct Parts {
    largest: f64,
    symmetric: f64,
    skew: f64,
}

impl Parts {
    fn look(&mut self, a: f64, b: f64) {
        self.largest = self.largest.max(a.abs());
        self.symmetric = self.symmetric.max((a + b).abs());
        self.skew = self.skew.max((a - b).abs());
    }

    fn is_symmetric(&self) -> bool {
        self.skew <= NOUGHT * self.largest
    }
}

/// Calls `f` for every entry that the structure of a matrix stores.
pub fn each(matrix: &Matrix, mut f: impl FnMut(usize, usize)) {
    let n = matrix.order();
    match matrix.storage() {
        Storage::Dense(_) => (0..n * n).for_each(|k| f(k / n, k % n)),
        Storage::Band(a) => {
            let (band, lower, upper) = (a.band().order(), a.band().lower(), a.band().upper());
            for i in 0..n {
                let within =
                    if i < band { i.saturating_sub(lower)..(i + upper + 1).min(band) } else { 0..band };
                within.chain(band..n).for_each(|j| f(i, j));
            }
        }
    }
}

/// Half-bandwidth of a matrix without border.
fn half_bandwidth(matrix: &Matrix<Double>) -> Option<usize> {
    match matrix.storage() {
        Storage::Dense(a) => Some(a.order().saturating_sub(1)),
        Storage::Band(a) => (a.order() == a.band().order()).then(|| a.band().upper().max(a.band().lower())),
    }
}

/// Number of negative eigenvalues of a symmetric matrix; `None` with a border.
pub fn negative_eigenvalues(matrix: &Matrix<Double>) -> Option<usize> {
    let half = half_bandwidth(matrix)?;
    Some(negative_pivots_of(matrix.order(), half, |i, j| matrix.get(i, j), |x| x.value() < 0.0))
}

/// A matrix of doubles in wide numbers.
pub fn widen(matrix: &Matrix, structure: &Structure) -> Matrix<Double> {
    let mut wide = Matrix::new(structure);
    each(matrix, |i, j| wide.add(i, j, matrix.get(i, j).into()));
    wide
}

/// aᵀ b
#[inline]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, a_rest) = a.as_chunks::<4>();
    let (b4, b_rest) = b.as_chunks::<4>();
    for (a, b) in a4.iter().zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

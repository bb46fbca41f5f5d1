//! The three matrices of an eigenproblem, their kind, and counts of its eigenvalues.

use super::sparse::Sparse;
use super::{EigenError, Pair};
use crate::linalg::Matrix;
use crate::linalg::inertia::{negative_pivots_of, shape};
use crate::linalg::vector::{dot, noise};
use num_complex::Complex64;

/// Form of the matrices.
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
///
/// Of a system with multipliers K holds the jacobian too, [K −Gᵀ; −G 0], and M and C are zero there: M and C then are forms on
/// the motions x that G allows, and the solutions with K lie in them.
#[derive(Debug)]
pub struct Pencil {
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix,
    /// |K|, entry by entry.
    sizes: Sparse,
    /// The entries of M and C.
    entries: [Sparse; 2],
    /// Q(σ), factored.
    factor: Matrix,
    shift: f64,
    /// Multipliers of rows that hold.
    multipliers: usize,
    kind: Kind,
    /// Whether M and K are symmetric and C is skew.
    conservative: bool,
    /// Whether M and K are symmetric.
    symmetric: bool,
    solutions: usize,
}

/// The softest motion x of a stiffness K.
#[derive(Clone, Debug)]
pub struct Softest {
    /// x, with multipliers.
    pub motion: Vec<f64>,
    /// |xᵀKx|
    pub energy: f64,
    /// ½ε |x|ᵀ|K||x|
    pub rounding: f64,
    /// Whether the elimination makes rounding errors grow, as it does where only a border of rows stiffens the band.
    pub unstable: bool,
}

impl Softest {
    /// Whether rounding alone decides its energy.
    pub fn is_uncertain(&self) -> bool {
        self.rounding > UNCERTAIN * self.energy
    }
}

/// Relative size at which an entry counts as zero.
const ZERO: f64 = 1e-12;
/// Bound of the relative error by rounding above which an eigenvalue is one of a rigid motion.
pub const UNCERTAIN: f64 = 0.1;
/// Residual of a solution, over its right-hand side and over the rounding of its terms, above which an elimination is unstable.
const UNSTABLE: f64 = 1e-8;
const GROWTH: f64 = 1e3;
/// Inverse iterations that find the softest motion.
const INVERSE_ITERATIONS: usize = 3;
/// Residual of a vector that the inverse purifies.
const PURE: f64 = 1e-9;
/// Relative distance below a frequency at which others are counted.
const MARGIN: f64 = 1e-7;

impl Pencil {
    /// The pencil of three matrices of equal structure, factored at the shift σ; so many of the unknowns are multipliers of
    /// rows that hold.
    ///
    /// # Errors
    /// [`EigenError::Singular`] when σ is an eigenvalue.
    pub fn new(
        [mass, damping, stiffness]: [Matrix; 3],
        multipliers: usize,
        shift: f64,
    ) -> Result<Pencil, EigenError> {
        let mut factor = stiffness.clone();
        if shift != 0.0 {
            factor.combine([&stiffness, &damping, &mass], [1.0, shift, shift * shift]);
        }
        factor.factor_equilibrated()?;
        let sizes = Sparse::of(&stiffness).sizes();
        let (kind, conservative, symmetric, solutions) = (Kind::General, false, false, 0);
        let entries = [&mass, &damping].map(Sparse::of);
        let mut pencil = Pencil {
            sizes,
            entries,
            mass,
            damping,
            stiffness,
            factor,
            shift,
            multipliers,
            kind,
            conservative,
            symmetric,
            solutions,
        };
        (pencil.kind, pencil.conservative, pencil.symmetric) = pencil.find_kind();
        Ok(pencil)
    }

    /// Order n of the matrices.
    pub fn order(&self) -> usize {
        self.mass.order()
    }

    /// The mass matrix M.
    pub fn mass(&self) -> &Sparse {
        &self.entries[0]
    }

    /// The matrix C of damping and gyroscopic forces.
    pub fn damping(&self) -> &Sparse {
        &self.entries[1]
    }

    /// ½ (C + Cᵀ), unless its diagonal has a negative entry.
    pub(super) fn dissipation(&self) -> Option<Sparse> {
        let out = self.damping.symmetrized();
        (0..out.order()).all(|i| out.get(i, i) >= 0.0).then(|| Sparse::of(&out))
    }

    /// The shift σ.
    pub fn shift(&self) -> f64 {
        self.shift
    }

    /// Form of the matrices.
    pub fn kind(&self) -> Kind {
        self.kind
    }

    /// Whether M and K are symmetric and C is skew: eigenvalues lie on the imaginary axis, in real pairs ±λ, or in fours ±λ, ±λ̄.
    pub fn is_conservative(&self) -> bool {
        self.conservative
    }

    /// Number of solutions with Q(σ) so far, each O(n).
    pub fn solutions(&self) -> usize {
        self.solutions
    }

    /// b ← Q(σ)⁻¹ b
    pub fn solve(&mut self, b: &mut [f64]) {
        self.solutions += 1;
        self.factor.solve(b);
    }

    /// Whether rounding alone decides the softest motion of Q(0) = K, which was factored: a rigid motion; and whether the elimination
    /// makes rounding errors grow.
    pub fn doubts(&mut self) -> [bool; 2] {
        self.softest().map_or([true; 2], |softest| [softest.is_uncertain(), softest.unstable])
    }

    /// The softest motion of Q(0) = K, which was factored; `None` where there are no finite ones. Inverse iterations; O(n).
    pub fn softest(&mut self) -> Option<Softest> {
        let n = self.order();
        let (mut x, mut b, mut product) = (noise(n, 1), vec![0.0; n], vec![0.0; n]);
        for _ in 0..INVERSE_ITERATIONS {
            self.mass().multiply(&x, &mut b);
            x.copy_from_slice(&b);
            self.solve(&mut x);
            let size = x.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            if !(size > 0.0 && size.is_finite()) {
                return None;
            }
            [&mut x, &mut b].into_iter().flatten().for_each(|x| *x /= size);
        }
        self.stiffness.multiply(&x, &mut product);
        let energy = dot(&x, &b).abs();
        let sizes: Vec<f64> = x.iter().map(|x| x.abs()).collect();
        let off: f64 = b.iter().zip(&product).zip(&sizes).map(|((b, kx), x)| (b - kx).abs() * x).sum();
        self.sizes.multiply(&sizes, &mut product);
        let largest = dot(&sizes, &product);
        let rounding = 0.5 * f64::EPSILON * largest;
        Some(Softest { motion: x, energy, rounding, unstable: off > UNSTABLE * energy + GROWTH * rounding })
    }

    /// xᴴMx
    pub fn modal_mass(&self, x: &[Complex64]) -> f64 {
        hermitian_form(self.mass(), x).re
    }

    /// Bound of the relative error of an eigenvalue λ ≠ 0 with the vector x by the rounding of the entries of K,
    /// ½ε |x|ᵀ|K||x| / (|λ|² xᴴMx).
    pub fn rounding(&self, value: Complex64, x: &[Complex64]) -> f64 {
        let size: Vec<f64> = x.iter().map(|x| x.norm_sqr().sqrt()).collect();
        let mut product = size.clone();
        self.sizes.multiply(&size, &mut product);
        let energy = dot(&size, &product);
        let mass = self.modal_mass(x);
        0.5 * f64::EPSILON * energy / (value.norm_sqr() * mass)
    }

    /// The eigenvalue that the vector of a conservative pencil has with K replaced by a more accurate one of which
    /// `energy` = xᴴKx is given: the root of ω² xᴴMx − ω xᴴ(iC)x − xᴴKx = 0, right to the square of the error of x.
    /// `None` for other pencils.
    pub fn rayleigh(&self, energy: f64, x: &[Complex64]) -> Option<Complex64> {
        let mass = self.modal_mass(x);
        let square = energy / mass;
        match self.kind {
            Kind::General => None,
            Kind::Symmetric if square < 0.0 => Some((-square).sqrt().into()),
            Kind::Symmetric => Some(Complex64::new(0.0, square.sqrt())),
            Kind::Gyroscopic => {
                let c = -hermitian_form(self.damping(), x).im / mass;
                let root = 0.5 * (c + (c * c + 4.0 * square).sqrt());
                Some(Complex64::new(0.0, root)).filter(|root| root.im.is_finite())
            }
        }
    }

    fn find_kind(&self) -> (Kind, bool, bool) {
        let (mut m, mut c, mut k) = (Parts::default(), Parts::default(), Parts::default());
        self.mass.mirrored(|a, b| m.include(a, b));
        self.damping.mirrored(|a, b| c.include(a, b));
        self.stiffness.mirrored(|a, b| k.include(a, b));
        let symmetric = m.is_symmetric() && k.is_symmetric();
        let conservative = symmetric && c.symmetric <= ZERO * c.largest;
        let kind = if !conservative {
            Kind::General
        } else if c.largest == 0.0 {
            Kind::Symmetric
        } else if self.shift == 0.0 && negative_directions(&self.stiffness, self.multipliers) == 0 {
            Kind::Gyroscopic
        } else {
            Kind::General
        };
        (kind, conservative, symmetric)
    }

    /// Number of eigenfrequencies below `frequency` [rad/s], from the inertia of K − ω² M + iω C, without computing
    /// them: for conservative systems ([`Kind::Symmetric`]: of ω² below the square, divergent ones included;
    /// [`Kind::Gyroscopic`]). `None` for others.
    ///
    /// The eigenvalues of the Hermitian matrix fall with ω > 0 through zero once each, since M ≥ 0 and K > 0.
    pub fn count_below(&self, frequency: f64) -> Option<usize> {
        let [mass, stiffness] = [&self.mass, &self.stiffness].map(Matrix::storage);
        let negative = match self.kind {
            Kind::Symmetric => negative_pivots_of(shape(&self.stiffness), |i, j| {
                stiffness.get(i, j) - frequency * frequency * mass.get(i, j)
            }),
            Kind::General => return None,
            Kind::Gyroscopic => return Some(self.count_undamped(frequency)),
        };
        Some(negative.saturating_sub(self.multipliers))
    }

    /// Whether the frequencies that the pencil has without the symmetric part of C can be counted: M and K are symmetric, K is positive.
    pub(super) fn can_count(&self) -> bool {
        self.shift == 0.0 && self.symmetric && negative_directions(&self.stiffness, self.multipliers) == 0
    }

    /// Number of these frequencies below `frequency` [rad/s].
    pub(super) fn count_undamped(&self, frequency: f64) -> usize {
        let [mass, damping, stiffness] = [&self.mass, &self.damping, &self.stiffness].map(Matrix::storage);
        let negative = negative_pivots_of(shape(&self.stiffness), |i, j| {
            let skew = 0.5 * (damping.get(i, j) - damping.get(j, i));
            let re = stiffness.get(i, j) - frequency * frequency * mass.get(i, j);
            Complex64::new(re, frequency * skew)
        });
        negative.saturating_sub(self.multipliers)
    }

    /// A frequency below that of a pair by more than its rounding, for [`Pencil::count_below`].
    pub fn just_below(&self, value: Complex64, x: &[Complex64]) -> f64 {
        value.norm() * (1.0 - f64::max(MARGIN, 4.0 * self.rounding(value, x)))
    }

    /// A pair whose vector x becomes −Q(σ)⁻¹ (Q(λ) − Q(σ)) x, and the difference of both over |x| in the norm of M: the residual.
    ///
    /// The norm of M does not see errors of x in stiff directions of little mass; the inverse divides them by their stiffness. A vector
    /// with a large residual stays as it is: there the inverse magnifies errors along far softer modes.
    ///
    /// Source: B. Nour-Omid, B. N. Parlett, T. Ericsson & P. S. Jensen, *Math. Comp.* 48 (1987) 663–673,
    /// doi:10.1090/S0025-5718-1987-0878698-1 (purification).
    pub(super) fn purified(&mut self, value: Complex64, vector: Vec<Complex64>) -> Pair {
        self.solutions += 2;
        let matrices = self.entries.each_ref();
        let (off, residual) = residual(matrices, &mut self.factor, self.shift, value, &vector);
        let pair = Pair { value, vector, residual };
        if residual <= PURE { pair.less(&off) } else { pair }
    }

    /// The same by the inverse of Q(|λ|) in the place of Q(σ). Where K is nearly singular, K⁻¹ magnifies by (λ/λ₁)²
    /// what rounding leaves of the lowest mode in the others; the inverse of K + |λ|C + |λ|²M magnifies nothing. O(n).
    pub fn purified_at_its_size(&self, value: Complex64, vector: Vec<Complex64>) -> Pair {
        let (mut factor, shift) = (self.stiffness.clone(), value.norm());
        factor.combine([&self.stiffness, &self.damping, &self.mass], [1.0, shift, shift * shift]);
        if factor.factor_equilibrated().is_err() {
            return Pair { value, vector, residual: f64::NAN };
        }
        let (off, residual) = residual(self.entries.each_ref(), &mut factor, shift, value, &vector);
        Pair { value, vector, residual }.less(&off)
    }
}

impl Pair {
    fn less(mut self, off: &[Complex64]) -> Pair {
        self.vector.iter_mut().zip(off).for_each(|(x, off)| *x -= off);
        self
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
    fn include(&mut self, a: f64, b: f64) {
        self.largest = self.largest.max(a.abs());
        self.symmetric = self.symmetric.max((a + b).abs());
        self.skew = self.skew.max((a - b).abs());
    }

    fn is_symmetric(&self) -> bool {
        self.skew <= ZERO * self.largest
    }
}

/// Number of directions x, allowed by the rows of so many multipliers, in which the quadratic form xᵀKx of a stiffness is negative.
pub fn negative_directions(stiffness: &Matrix, multipliers: usize) -> usize {
    let of = stiffness.storage();
    let negative = negative_pivots_of(shape(stiffness), |i, j| 0.5 * (of.get(i, j) + of.get(j, i)));
    negative.saturating_sub(multipliers)
}

/// Whether a matrix is symmetric but for rounding.
pub fn is_symmetric(matrix: &Matrix) -> bool {
    let mut parts = Parts::default();
    matrix.mirrored(|a, b| parts.include(a, b));
    parts.is_symmetric()
}

/// xᴴ A x
fn hermitian_form(a: &Sparse, x: &[Complex64]) -> Complex64 {
    let [re, im] = parts(x);
    let (mut a_re, mut a_im) = (re.clone(), im.clone());
    a.multiply(&re, &mut a_re);
    a.multiply(&im, &mut a_im);
    Complex64::new(dot(&re, &a_re) + dot(&im, &a_im), dot(&re, &a_im) - dot(&im, &a_re))
}

/// r = x + Q(σ)⁻¹ (λ − σ)((λ + σ) M + C) x, and |r|/|x|, since Q(λ) = Q(σ) + (λ − σ)((λ + σ) M + C).
fn residual(
    [mass, damping]: [&Sparse; 2],
    factor: &mut Matrix,
    shift: f64,
    value: Complex64,
    x: &[Complex64],
) -> (Vec<Complex64>, f64) {
    let n = x.len();
    let (mut mx, mut cx) = ([vec![0.0; n], vec![0.0; n]], [vec![0.0; n], vec![0.0; n]]);
    let parts = parts(x);
    for part in 0..2 {
        mass.multiply(&parts[part], &mut mx[part]);
        damping.multiply(&parts[part], &mut cx[part]);
    }
    let mut r = parts.clone();
    for i in 0..n {
        let (m, c) = (Complex64::new(mx[0][i], mx[1][i]), Complex64::new(cx[0][i], cx[1][i]));
        let f = (value - shift) * ((value + shift) * m + c);
        (r[0][i], r[1][i]) = (f.re, f.im);
    }
    let (mut off, mut size) = (0.0, 0.0);
    let mut mr = vec![0.0; n];
    for part in 0..2 {
        factor.solve(&mut r[part]);
        for (r, x) in r[part].iter_mut().zip(&parts[part]) {
            *r += x;
        }
        mass.multiply(&r[part], &mut mr);
        off += dot(&r[part], &mr);
        size += dot(&parts[part], &mx[part]);
    }
    let [re, im] = r;
    let r = re.into_iter().zip(im).map(|(re, im)| Complex64::new(re, im)).collect();
    (r, (off.abs() / size).sqrt())
}

/// Real and imaginary part.
fn parts(x: &[Complex64]) -> [Vec<f64>; 2] {
    [x.iter().map(|x| x.re).collect(), x.iter().map(|x| x.im).collect()]
}

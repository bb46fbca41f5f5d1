//! Modes of a conservative system from those at a neighbouring speed, by Rayleigh quotient iteration.
//!
//! For M, K symmetric, K > 0 and C antisymmetric the matrix Q(ω) = K − ω² M + iω C is Hermitian, and a mode is x with
//! Q(ω) x = 0. From a vector near x and its Rayleigh functional ω(x), the positive root of
//! x*Q(ω)x = 0, Newton's step
//!
//! ```text
//! Q(ω) z = Q′(ω) x,   Q′(ω) = −2ω M + iC,   x ← z,   ω ← ω(z)
//! ```
//!
//! converges cubically: vectors extrapolated from two neighbouring speeds mostly need one. That costs one factorisation of
//! a band in doubles for each mode, where a Krylov space that begins anew needs hundreds of solutions.
//!
//! Nothing is believed: each pair shows its residual, and the inertia of Q just below the highest mode shows
//! that none is missing or twice there. Where that fails, or the stiffness in doubles has lost digits to a fine mesh,
//! there is no result, and the caller finds the modes [anew](super::modes::modes).
//!
//! Source: A. Ruhe, *SIAM J. Numer. Anal.* 10 (1973) 674–689, doi:10.1137/0710059 (Newton's method on the vector,
//! the Rayleigh functional).

use super::modes::{Mode, RESIDUAL, Shares};
use super::stiffness::stiffness;
use crate::linalg::{Band, Double, Hermitian, Matrix, Storage};
use crate::system::{Direction, State, System, Weights};
use num_complex::Complex64;

/// Iterations for a mode.
const ITERATIONS: usize = 6;
/// Residual of a pair that is accepted at once.
const CONVERGED: f64 = 1e-8;
/// Relative change of a frequency at which rounding lets it come no closer.
const STANDING: f64 = 1e-12;
/// Bound of the relative error of a frequency by the rounding of K in doubles beyond which it is corrected.
const ROUNDING: f64 = 1e-8;
/// That bound beyond which the vector is not good enough either.
const ROUGH: f64 = 1e-5;
/// Relative size at which an entry counts as zero.
const NOUGHT: f64 = 1e-12;
/// How far below the highest mode, relatively, others are counted.
const BELOW: f64 = 1e-7;

/// A mode and M x.
#[derive(Clone, Debug)]
pub(super) struct Found {
    pub mode: Mode,
    pub massed: Vec<Complex64>,
    /// Number of the vector it was found from.
    pub origin: usize,
}

impl Found {
    /// Whether another is the same mode.
    fn is_again(&self, other: &Found) -> bool {
        other.mode.frequency() <= self.mode.frequency() * (1.0 + 1e-6)
            && assurance(&self.mode.vector, &other.massed) > 0.99
    }
}

/// |xᴴ M y|² from x and M y.
pub(super) fn assurance(x: &[Complex64], my: &[Complex64]) -> f64 {
    let (mut re, mut im) = (0.0, 0.0);
    for (x, y) in x.iter().zip(my) {
        re += x.re * y.re + x.im * y.im;
        im += x.re * y.im - x.im * y.re;
    }
    re * re + im * im
}

/// Matrices and memory for modes at one speed after the other.
pub(super) struct Follower {
    mass: Matrix,
    damping: Matrix,
    stiffness: Matrix,
    /// Order of the band: the unknowns beyond it (a hub that is held) do not move.
    band: usize,
    shifted: Hermitian,
    /// K, factored.
    factor: Hermitian,
    /// K + ω² M, factored.
    sized: Hermitian,
    directions: Vec<Direction>,
    scale: Vec<f64>,
    work: Work,
}

/// Real and imaginary parts of vectors.
#[derive(Default)]
struct Work {
    x: [Vec<f64>; 2],
    mx: [Vec<f64>; 2],
    cx: [Vec<f64>; 2],
    kx: [Vec<f64>; 2],
    r: [Vec<f64>; 2],
    mr: Vec<f64>,
}

fn band(matrix: &Matrix) -> Option<&Band<f64>> {
    match matrix.storage() {
        Storage::Band(a) => Some(a.band()),
        _ => None,
    }
}

/// Inner product Re(x* y) and Im(x* y).
fn inner(x: &[Vec<f64>; 2], y: &[Vec<f64>; 2]) -> Complex64 {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    Complex64::new(dot(&x[0], &y[0]) + dot(&x[1], &y[1]), dot(&x[0], &y[1]) - dot(&x[1], &y[0]))
}

fn multiply(a: &Band<f64>, x: &[Vec<f64>; 2], y: &mut [Vec<f64>; 2], is_real: bool) {
    a.multiply(&x[0], &mut y[0]);
    if is_real {
        y[1].fill(0.0);
    } else {
        a.multiply(&x[1], &mut y[1]);
    }
}

impl Follower {
    /// For a system whose matrices are bands; `None` for others.
    pub(super) fn new(system: &dyn System) -> Option<Follower> {
        let matrix = Matrix::new(&system.structure(0));
        let (order, half) = match matrix.storage() {
            Storage::Band(a) if a.band().lower() == a.band().upper() => (a.band().order(), a.band().upper()),
            _ => return None,
        };
        let n = system.size().v;
        let pair = || [vec![0.0; order], vec![0.0; order]];
        Some(Follower {
            mass: matrix.clone(),
            damping: matrix.clone(),
            stiffness: matrix,
            band: order,
            shifted: Hermitian::new(order, half),
            factor: Hermitian::new(order, half),
            sized: Hermitian::new(order, half),
            directions: (0..n).map(|i| system.direction(i)).collect(),
            scale: system.scales().to_vec(),
            work: Work { x: pair(), mx: pair(), cx: pair(), kx: pair(), r: pair(), mr: vec![0.0; order] },
        })
    }

    /// The modes near `starts` at an equilibrium, ascending; at least `least` of them, the lowest there are, or `None`.
    pub(super) fn modes(
        &mut self,
        system: &mut dyn System,
        state: &State,
        starts: &[Vec<Complex64>],
        least: usize,
    ) -> Option<Vec<Found>> {
        let gyroscopic = self.prepare(system, state)?;
        let mut found = Vec::with_capacity(starts.len());
        for (origin, start) in starts.iter().enumerate() {
            found.push(self.mode(start, gyroscopic, origin)?);
        }
        self.correct(system, state, &mut found);
        found.sort_by(|a, b| a.mode.frequency().total_cmp(&b.mode.frequency()));
        if found.iter().enumerate().any(|(i, f)| found[i + 1..].iter().any(|g| f.is_again(g))) {
            return None;
        }
        // From the highest down to the first below which none is missing.
        while found.len() >= least.max(1) {
            let limit = found.last()?.mode.frequency() * (1.0 - BELOW);
            let below = found.iter().filter(|f| f.mode.frequency() < limit).count();
            if self.shift(limit, gyroscopic)? == below {
                return Some(found);
            }
            found.pop();
        }
        None
    }

    /// The mode near one vector.
    pub(super) fn one(
        &mut self,
        system: &mut dyn System,
        state: &State,
        start: &[Complex64],
    ) -> Option<Found> {
        let gyroscopic = self.prepare(system, state)?;
        let mut found = [self.mode(start, gyroscopic, 0)?];
        self.correct(system, state, &mut found);
        let [found] = found;
        Some(found)
    }

    /// Frequencies that the rounding of K may have moved, from x* K x with K in wide numbers: right to the square of the
    /// error of the vector. Nothing is to be gained where the model does not give the terms of K.
    fn correct(&self, system: &mut dyn System, state: &State, found: &mut [Found]) {
        if found.iter().all(|f| f.mode.rounding <= ROUNDING) {
            return;
        }
        let (wide, true) = stiffness(system, state) else { return };
        let Storage::Band(wide) = wide.storage() else { return };
        let Some(c) = band(&self.damping) else { return };
        for f in found.iter_mut().filter(|f| f.mode.rounding > ROUNDING) {
            let part =
                |of: fn(&Complex64) -> f64| f.mode.vector[..self.band].iter().map(of).collect::<Vec<f64>>();
            let x = [part(|z| z.re), part(|z| z.im)];
            let energy = wide_energy(wide.band(), &x[0]) + wide_energy(wide.band(), &x[1]);
            let mut cx = x.clone();
            multiply(c, &x, &mut cx, false);
            let frequency = root(-inner(&x, &cx).im, energy.value());
            if frequency.is_finite() {
                f.mode.eigenvalue.im = frequency;
                f.mode.rounding = 0.0;
            }
        }
    }

    /// Takes the matrices of a state; whether there are gyroscopic forces. `None` for a system that is not
    /// conservative, has a border that moves, or is not stable.
    fn prepare(&mut self, system: &mut dyn System, state: &State) -> Option<bool> {
        system.tangent(state, Weights::new(1.0, 0.0, 0.0), &mut self.mass);
        system.tangent(state, Weights::new(0.0, 1.0, 0.0), &mut self.damping);
        system.tangent(state, Weights::new(0.0, 0.0, 1.0), &mut self.stiffness);
        let matrices = [&self.mass, &self.damping, &self.stiffness];
        let n = self.mass.order();
        let couples = |m: &&Matrix| {
            (self.band..n).any(|j| (0..self.band).any(|i| m.get(i, j) != 0.0 || m.get(j, i) != 0.0))
        };
        if matrices.iter().any(couples) {
            return None;
        }
        let (m, c, k) = (band(&self.mass)?, band(&self.damping)?, band(&self.stiffness)?);
        let ([m_even, m_odd], [c_even, c_odd], [k_even, k_odd]) = (parts(m), parts(c), parts(k));
        let symmetric = |even: f64, odd: f64| odd <= NOUGHT * even;
        if !(symmetric(m_even, m_odd) && symmetric(k_even, k_odd) && symmetric(c_odd, c_even)) {
            return None;
        }
        self.factor.assign(k, (0.0, m), (0.0, c));
        (self.factor.factor()? == 0).then_some(c_odd > 0.0)
    }

    /// Factors Q(ω); the number of its negative eigenvalues, which is that of the frequencies below ω.
    fn shift(&mut self, frequency: f64, gyroscopic: bool) -> Option<usize> {
        let (m, c, k) = (band(&self.mass)?, band(&self.damping)?, band(&self.stiffness)?);
        let imaginary = if gyroscopic { frequency } else { 0.0 };
        self.shifted.assign(k, (-frequency * frequency, m), (imaginary, c));
        self.shifted.factor()
    }

    fn mode(&mut self, start: &[Complex64], gyroscopic: bool, origin: usize) -> Option<Found> {
        for (i, z) in start.iter().take(self.band).enumerate() {
            (self.work.x[0][i], self.work.x[1][i]) = (z.re, z.im);
        }
        let mut frequency = self.functional(gyroscopic)?;
        for _ in 0..ITERATIONS {
            self.shift(frequency, gyroscopic)?;
            let Work { x, mx, cx, .. } = &mut self.work;
            for i in 0..x[0].len() {
                // Q′ x: i C x has the parts (−Im, Re) of C x.
                x[0][i] = -2.0 * frequency * mx[0][i] - cx[1][i];
                x[1][i] = -2.0 * frequency * mx[1][i] + cx[0][i];
            }
            let [re, im] = x;
            self.shifted.solve(re, im);
            let before = frequency;
            frequency = self.functional(gyroscopic)?;
            if (frequency / before - 1.0).abs() > 1e-4 {
                continue;
            }
            let rounding = self.rounding(frequency)?;
            let mut residual = residual(&self.factor, &self.mass, &mut self.work, frequency, 0.0);
            if !(residual <= CONVERGED) {
                residual = self.residual_at_its_size(frequency)?;
            }
            let standing = (frequency / before - 1.0).abs() <= STANDING;
            if residual <= CONVERGED || (standing && residual <= RESIDUAL) {
                return (rounding <= ROUGH)
                    .then(|| self.found(frequency, residual, rounding, origin, start.len()));
            }
        }
        None
    }

    /// Normalises x to modal mass 1, and its Rayleigh functional; M x, C x and K x are those of x then.
    fn functional(&mut self, gyroscopic: bool) -> Option<f64> {
        let (m, c, k) = (band(&self.mass)?, band(&self.damping)?, band(&self.stiffness)?);
        let Work { x, mx, cx, kx, .. } = &mut self.work;
        let largest = x.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
        if !(largest > 0.0 && largest.is_finite()) {
            return None;
        }
        x.iter_mut().flatten().for_each(|x| *x /= largest);
        let is_real = x[1].iter().all(|x| *x == 0.0);
        multiply(m, x, mx, is_real);
        let size = inner(x, mx).re;
        if !(size > 0.0) {
            return None;
        }
        let factor = 1.0 / size.sqrt();
        for part in [&mut *x, mx] {
            part.iter_mut().flatten().for_each(|x| *x *= factor);
        }
        multiply(k, x, kx, is_real);
        let energy = inner(x, kx).re;
        // x* iC x, which is real.
        let turning = if gyroscopic {
            multiply(c, x, cx, is_real);
            -inner(x, cx).im
        } else {
            cx.iter_mut().flatten().for_each(|x| *x = 0.0);
            0.0
        };
        let root = root(turning, energy);
        (root > 0.0 && root.is_finite()).then_some(root)
    }

    /// Bound of the relative error of a frequency by the rounding of the entries of K, ½ε |x|ᵀ|K||x| / ω².
    fn rounding(&self, frequency: f64) -> Option<f64> {
        let k = band(&self.stiffness)?;
        let x = &self.work.x;
        let size: Vec<f64> = x[0].iter().zip(&x[1]).map(|(a, b)| (a * a + b * b).sqrt()).collect();
        let mut energy = 0.0;
        for (i, row) in k.data().chunks_exact(k.width()).enumerate() {
            let reach = (k.upper() + 1).min(size.len() - i);
            let row = &row[k.lower()..k.lower() + reach];
            let sum: f64 = row.iter().zip(&size[i..]).map(|(a, x)| a.abs() * x).sum();
            energy += size[i] * (2.0 * sum - row[0].abs() * size[i]);
        }
        Some(0.5 * f64::EPSILON * energy / (frequency * frequency))
    }

    /// The residual through K + ω² M: where the lowest mode is soft against ω, K⁻¹ magnifies what rounding leaves of it.
    fn residual_at_its_size(&mut self, frequency: f64) -> Option<f64> {
        let (m, c, k) = (band(&self.mass)?, band(&self.damping)?, band(&self.stiffness)?);
        let square = frequency * frequency;
        self.sized.assign(k, (square, m), (0.0, c));
        self.sized.factor()?;
        Some(residual(&self.sized, &self.mass, &mut self.work, frequency, square))
    }

    /// The mode x has become, its largest entry real and positive.
    fn found(&self, frequency: f64, residual: f64, rounding: f64, origin: usize, len: usize) -> Found {
        let Work { x, mx, .. } = &self.work;
        let entry = |v: &[Vec<f64>; 2], i: usize| Complex64::new(v[0][i], v[1][i]);
        let size = |i: usize| entry(x, i).norm() / self.scale[i];
        let largest =
            (1..self.band).fold(0, |best, i| if size(i) > size(best) * (1.0 + 1e-9) { i } else { best });
        let peak = entry(x, largest);
        let phase = peak.conj() / peak.norm();
        let mut shares = Shares::default();
        for i in 0..self.band {
            *shares.of(self.directions[i]) += x[0][i] * mx[0][i] + x[1][i] * mx[1][i];
        }
        let turned = |v: &[Vec<f64>; 2]| {
            let mut out = vec![Complex64::ZERO; len];
            out.iter_mut().take(self.band).enumerate().for_each(|(i, z)| *z = entry(v, i) * phase);
            out
        };
        let mode = Mode {
            eigenvalue: Complex64::new(0.0, frequency),
            vector: turned(x),
            residual,
            rounding,
            shares,
            shape: Default::default(),
            nodes: 0,
        };
        Found { mode, massed: turned(mx), origin }
    }
}

/// |P⁻¹ Q(ω) x| / |x| in the norm of M, with P = K + w M factored and P⁻¹ Q(ω) x = x + P⁻¹ (iω C − (ω² + w) M) x.
fn residual(factor: &Hermitian, mass: &Matrix, work: &mut Work, frequency: f64, w: f64) -> f64 {
    let Some(mass) = band(mass) else { return f64::NAN };
    let Work { x, mx, cx, r, mr, .. } = work;
    let square = frequency * frequency + w;
    for i in 0..x[0].len() {
        r[0][i] = -square * mx[0][i] - frequency * cx[1][i];
        r[1][i] = -square * mx[1][i] + frequency * cx[0][i];
    }
    let [re, im] = r;
    factor.solve(re, im);
    let mut off = 0.0;
    for part in 0..2 {
        r[part].iter_mut().zip(&x[part]).for_each(|(r, x)| *r += x);
        mass.multiply(&r[part], mr);
        off += r[part].iter().zip(mr.iter()).map(|(r, m)| r * m).sum::<f64>();
    }
    off.abs().sqrt()
}

/// The positive ω with k + c ω − ω² = 0.
fn root(c: f64, k: f64) -> f64 {
    0.5 * (c + (c * c + 4.0 * k).sqrt())
}

/// xᵀ K x
fn wide_energy(k: &Band<Double>, x: &[f64]) -> Double {
    let (width, lower) = (k.width(), k.lower());
    let mut energy = Double::ZERO;
    for (i, row) in k.data().chunks_exact(width).enumerate() {
        let reach = k.upper().min(x.len() - 1 - i);
        let mut sum = row[lower] * (0.5 * x[i]).into();
        for (a, x) in row[lower + 1..lower + 1 + reach].iter().zip(&x[i + 1..]) {
            sum += *a * (*x).into();
        }
        energy += sum * (2.0 * x[i]).into();
    }
    energy
}

/// Sizes of the symmetric and of the antisymmetric part of a band, as their largest entries.
fn parts(a: &Band<f64>) -> [f64; 2] {
    let (n, width, lower) = (a.order(), a.width(), a.lower());
    let data = a.data();
    let (mut even, mut odd) = (0.0_f64, 0.0_f64);
    for i in 0..n {
        even = even.max((2.0 * data[i * width + lower]).abs());
        for r in 1..=a.upper().min(n - 1 - i) {
            let (x, y) = (data[i * width + lower + r], data[(i + r) * width + lower - r]);
            even = even.max((x + y).abs());
            odd = odd.max((x - y).abs());
        }
    }
    [even, odd]
}

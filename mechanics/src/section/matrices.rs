//! Stiffness, damping and mass of a section.

/// A 6 × 6 matrix by rows.
pub type Matrix6 = [[f64; 6]; 6];

/// Stiffness, damping and mass per length of a section, in its axes: the first along the beam, the second along the height, the
/// third across.
///
/// The strains are e = (ε, γ₂, γ₃, κ₁, κ₂, κ₃): axial strain, two shears, torsion and two bendings, about the second and the third
/// axis; forces and moments are (N, Q₂, Q₃, M₁, M₂, M₃) = C e + D ė. All refer to the point of the section on the axis of the beam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Matrices {
    /// C, symmetric and positive definite. Entries \[N\], \[N·m\] and \[N·m²\].
    pub stiffness: Matrix6,
    /// D, symmetric and without negative eigenvalue. Entries \[N·s\], \[N·m·s\] and \[N·m²·s\].
    pub damping: Matrix6,
    /// The kinetic energy per length is ½ (u, Ω)ᵀ M (u, Ω) with the velocity u of the point and the angular velocity Ω, both
    /// along the axes of the section: M = [μ I, −μ c̃; μ c̃, J] with the mass μ \[kg/m\], the centre of mass c \[m\] and the
    /// moments of inertia J \[kg·m\] about the point.
    pub mass: Matrix6,
}

impl Matrices {
    /// A section without couplings: C = diag(EA, GA₂, GA₃, GJ, EI₂, EI₃) with the shear stiffnesses GA₂ and GA₃ along the second
    /// and the third axis, I₂ = ∫z² dA and I₃ = ∫y² dA for the places (y, z) along them; the mass per length and the moments of
    /// inertia about the three axes. There is no damping.
    pub fn principal(stiffness: [f64; 6], mass: f64, inertia: [f64; 3]) -> Matrices {
        let [first, second, third] = inertia;
        let mass = [mass, mass, mass, first, second, third];
        Matrices { stiffness: diagonal(stiffness), damping: [[0.0; 6]; 6], mass: diagonal(mass) }
    }

    /// The section whose tension centre, where a tension does not bend, is at the place (y, z) \[m\], and whose stiffnesses in
    /// bending are those about it: the axial strain there is ε + z κ₂ − y κ₃.
    #[must_use]
    pub fn with_tension_centre(mut self, [y, z]: [f64; 2]) -> Matrices {
        let mut shift = identity();
        (shift[0][4], shift[0][5]) = (z, -y);
        self.stiffness = congruent(&self.stiffness, &shift);
        self
    }

    /// The section whose shear centre, where a transverse force does not twist, is at the place (y, z) \[m\], and whose stiffness
    /// in torsion is that about it: the shears there are γ₂ − z κ₁ and γ₃ + y κ₁.
    #[must_use]
    pub fn with_shear_centre(mut self, [y, z]: [f64; 2]) -> Matrices {
        let mut shift = identity();
        (shift[1][3], shift[2][3]) = (-z, y);
        self.stiffness = congruent(&self.stiffness, &shift);
        self
    }

    /// The section whose centre of mass is at the place (y, z) \[m\], and whose moments of inertia are those about it: its
    /// velocity is u + Ω × (0, y, z).
    #[must_use]
    pub fn with_mass_centre(mut self, [y, z]: [f64; 2]) -> Matrices {
        let mut shift = identity();
        (shift[0][4], shift[0][5]) = (z, -y);
        (shift[1][3], shift[2][3]) = (-z, y);
        self.mass = congruent(&self.mass, &shift);
        self
    }

    /// The section with the damping D = H C H of its stiffness, H = diag(√η): a strain alone has the stress Cₖₖ (eₖ + ηₖ ėₖ),
    /// and equal times η \[s\] ≥ 0 are Kelvin's and Voigt's damping η C. D is positive for any C.
    #[must_use]
    pub fn with_damping_times(mut self, times: [f64; 6]) -> Matrices {
        self.damping = congruent(&self.stiffness, &diagonal(times.map(f64::sqrt)));
        self
    }

    /// The section rotated by `angle` \[rad\] about the axis of the beam: all three matrices in axes that are not rotated.
    #[must_use]
    pub fn rolled(self, angle: f64) -> Matrices {
        let (sin, cos) = libm::sincos(angle);
        let mut turn = identity();
        for at in [0, 3] {
            (turn[at + 1][at + 1], turn[at + 1][at + 2]) = (cos, sin);
            (turn[at + 2][at + 1], turn[at + 2][at + 2]) = (-sin, cos);
        }
        let of = |matrix: &Matrix6| congruent(matrix, &turn);
        Matrices { stiffness: of(&self.stiffness), damping: of(&self.damping), mass: of(&self.mass) }
    }

    /// The stiffness \[N\], \[N·m\] and \[N·m²\] for (ε, κ₁, κ₂, κ₃) at zero shear force, C_rr − C_rs C_ss⁻¹ C_sr with the shears s and
    /// the other strains r: that of a beam whose sections stay square to its axis.
    pub fn condensed(&self) -> [[f64; 4]; 4] {
        const KEPT: [usize; 4] = [0, 3, 4, 5];
        let c = &self.stiffness;
        let determinant = c[1][1] * c[2][2] - c[1][2] * c[2][1];
        let entry = |i: usize, j: usize| {
            let (a, b) = (c[1][j], c[2][j]);
            let shears = [c[2][2] * a - c[1][2] * b, c[1][1] * b - c[2][1] * a];
            c[i][j] - (c[i][1] * shears[0] + c[i][2] * shears[1]) / determinant
        };
        KEPT.map(|i| KEPT.map(|j| entry(i, j)))
    }

    /// Place (y, z) of the centre of mass \[m\].
    pub fn mass_centre(&self) -> [f64; 2] {
        let m = &self.mass;
        [-m[0][5] / m[0][0], m[0][4] / m[0][0]]
    }

    /// Product of inertia −∫ρ y z dA about the axes through the centre of mass \[kg m\].
    pub fn product_of_inertia(&self) -> f64 {
        let [y, z] = self.mass_centre();
        self.mass[4][5] + self.mass[0][0] * y * z
    }

    /// Moments of inertia about the three axes, through the centre of mass [kg·m].
    pub fn central_inertia(&self) -> [f64; 3] {
        let (m, [y, z]) = (&self.mass, self.mass_centre());
        let mass = m[0][0];
        [m[3][3] - mass * (y * y + z * z), m[4][4] - mass * z * z, m[5][5] - mass * y * y]
    }

    /// What is wrong with the numbers, if anything.
    pub fn fault(&self) -> Option<&'static str> {
        if !is_positive(&self.stiffness, false) {
            return Some("the stiffness matrix must be symmetric and positive definite");
        }
        if !is_positive(&self.damping, true) {
            return Some("the damping matrix must be symmetric and have no negative eigenvalue");
        }
        let m = &self.mass;
        if !is_positive(m, false) {
            return Some("the mass matrix must be symmetric and positive definite");
        }
        // μ I, and −μ c̃.
        let size = m[0][0];
        let equal = |i: usize, j: usize, x: f64| (m[i][j] - x).abs() <= SAME * size;
        let is_scalar = (0..3).all(|i| (0..3).all(|j| equal(i, j, if i == j { size } else { 0.0 })));
        let arm = (0..3).map(|i| m[i][3 + (i + 1) % 3].abs()).fold(0.0, f64::max);
        let is_skew = (0..3).all(|i| (0..3).all(|j| (m[i][3 + j] + m[j][3 + i]).abs() <= SAME * arm));
        let fault = "the mass matrix must be that of a mass: μ I, −μ c̃ and J with the centre of mass c";
        (!(is_scalar && is_skew)).then_some(fault)
    }
}

/// Relative difference of entries that are equal but for the digits with which they are given.
const SAME: f64 = 1e-9;

fn diagonal(entries: [f64; 6]) -> Matrix6 {
    let mut out = [[0.0; 6]; 6];
    (0..6).for_each(|k| out[k][k] = entries[k]);
    out
}

fn identity() -> Matrix6 {
    diagonal([1.0; 6])
}

/// Wᵀ A W
fn congruent(a: &Matrix6, w: &Matrix6) -> Matrix6 {
    let product = |i: usize, j: usize| -> f64 { (0..6).map(|k| a[i][k] * w[k][j]).sum() };
    let right: Matrix6 = std::array::from_fn(|i| std::array::from_fn(|j| product(i, j)));
    let left = |i: usize, j: usize| -> f64 { (0..6).map(|k| w[k][i] * right[k][j]).sum() };
    std::array::from_fn(|i| std::array::from_fn(|j| left(i, j)))
}

/// Whether a matrix is symmetric and all its pivots are positive, or, where it may be `singular`, not negative.
fn is_positive(matrix: &Matrix6, singular: bool) -> bool {
    let scale = |i: usize, j: usize| (matrix[i][i] * matrix[j][j]).abs().sqrt();
    let symmetric = |i: usize, j: usize| (matrix[i][j] - matrix[j][i]).abs() <= SAME * scale(i, j);
    let finite = matrix.as_flattened().iter().all(|x| x.is_finite());
    if !(finite && (0..6).all(|i| (0..i).all(|j| symmetric(i, j)))) {
        return false;
    }
    let mut a = *matrix;
    for k in 0..6 {
        if !(a[k][k] > 1e-12 * matrix[k][k] && a[k][k] > 0.0) {
            // A zero that rounding leaves has zeros beside it.
            let vanishes = |j: usize| a[k][j].abs() <= SAME * scale(k, j);
            if !(singular && (k..6).all(vanishes)) {
                return false;
            }
            continue;
        }
        for i in k + 1..6 {
            let factor = a[i][k] / a[k][k];
            for j in k..6 {
                a[i][j] -= factor * a[k][j];
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section() -> Matrices {
        Matrices::principal([9.0, 4.0, 3.0, 0.7, 1.1, 2.3], 1.5, [0.3, 0.1, 0.2])
    }

    fn form(a: &Matrix6, x: [f64; 6]) -> f64 {
        (0..6).map(|i| (0..6).map(|j| x[i] * a[i][j] * x[j]).sum::<f64>()).sum()
    }

    /// The energies are those of the strains and velocities at the centres.
    #[test]
    fn offsets_of_centres_are_those_of_strains_and_velocities_there() {
        let e = [0.3, -0.2, 0.5, 0.7, -0.4, 0.9];
        let [tension, shear, mass] = [[0.1, -0.3], [0.25, 0.15], [-0.2, 0.05]];
        let of = section().with_shear_centre(shear).with_tension_centre(tension).with_mass_centre(mass);
        let mut there = e;
        there[0] += tension[1] * e[4] - tension[0] * e[5];
        there[1] -= shear[1] * e[3];
        there[2] += shear[0] * e[3];
        assert!((form(&of.stiffness, e) - form(&section().stiffness, there)).abs() < 1e-14);
        let mut there = e;
        there[0] += mass[1] * e[4] - mass[0] * e[5];
        there[1] -= mass[1] * e[3];
        there[2] += mass[0] * e[3];
        assert!((form(&of.mass, e) - form(&section().mass, there)).abs() < 1e-14);
        assert_eq!(of.with_damping_times([0.1, 0.2, 0.0, 0.3, 0.4, 0.5]).fault(), None);
        // A section rotated by a right angle has its second axis where its third was.
        let rolled = section().rolled(0.5 * std::f64::consts::PI).stiffness;
        for (found, expected) in [(rolled[1][1], 3.0), (rolled[2][2], 4.0), (rolled[4][4], 2.3)] {
            assert!((found - expected).abs() < 1e-14);
        }
    }

    /// The energy for given (ε, κ) is least where the shear forces vanish.
    #[test]
    fn condensed_stiffness_is_that_without_shear_force() {
        let mut of = section().with_shear_centre([0.25, 0.15]).with_tension_centre([0.1, -0.3]);
        for (i, j, x) in [(1, 2, 0.9), (0, 1, 0.7), (2, 5, -0.4)] {
            of.stiffness[i][j] += x;
            of.stiffness[j][i] += x;
        }
        assert_eq!(of.fault(), None);
        let (c, least) = (of.stiffness, of.condensed());
        let kept = [0.4, -0.8, 0.5, 0.3];
        let mut e = [kept[0], 0.0, 0.0, kept[1], kept[2], kept[3]];
        // Relaxation of both shears in turn.
        for _ in 0..200 {
            for k in [1, 2] {
                e[k] -= (0..6).map(|j| c[k][j] * e[j]).sum::<f64>() / c[k][k];
            }
        }
        let energy: f64 = (0..4).map(|i| (0..4).map(|j| kept[i] * least[i][j] * kept[j]).sum::<f64>()).sum();
        assert!((energy - form(&c, e)).abs() < 1e-13, "{energy}");
    }

    #[test]
    fn matrices_that_no_section_has_are_refused() {
        assert_eq!(section().fault(), None);
        let with = |change: &dyn Fn(&mut Matrices)| {
            let mut of = section();
            change(&mut of);
            of.fault().is_some()
        };
        assert!(with(&|of| of.stiffness[0][1] = 0.1));
        assert!(with(&|of| (of.stiffness[0][1], of.stiffness[1][0]) = (7.0, 7.0)));
        assert!(with(&|of| of.stiffness[3][3] = f64::NAN));
        assert!(with(&|of| of.damping[2][2] = -1e-3));
        assert!(with(&|of| of.mass[5][5] = 0.0));
        assert!(with(&|of| of.mass[1][1] = 1.6));
        assert!(with(&|of| (of.mass[0][3], of.mass[3][0]) = (0.1, 0.1)));
        assert!(with(&|of| (of.mass[0][4], of.mass[4][0]) = (0.1, 0.1)));
    }
}

//! Whether the kinetic energy of a beam on a free hub is still positive.
//!
//! The effective inertia of the released hub, on which no torque of the beam acts, is the Schur complement
//!
//! ```text
//! J_e(q) = J_θθ(q) − m(q)ᵀ M⁻¹ m(q),      M v·v/2 + θ̇ m·v + J_θθ θ̇²/2 = T
//! ```
//!
//! M, m, J_θθ: the blocks of the mass matrix. The coupling `first` keeps the foreshortening in J_θθ and drops what
//! belongs to it in m and M: T is a sum of squares and J θ̇²/2, J the inertia of the hub alone, less qᵀN q θ̇²/2. A beam
//! of which the foreshortening takes more than J_e(0) has no positive kinetic energy any more, and its motion has no meaning.

use super::inertia::{Border, Inertia, Scratch};
use crate::linalg::{Matrix, Structure, eigen::each};
use crate::profile::HubKinematics;
use crate::system::{State, Weights};

/// Weights of the mass matrix.
fn inertial() -> Weights<'static> {
    Weights::new(1.0, 0.0, 0.0)
}

/// Effective inertia of a free hub.
#[derive(Clone, Debug)]
pub struct HubInertia {
    /// M, factored.
    mass: Matrix,
    /// Σ_j |N_ij| with N = M − D: qᵀN q ≤ Σ bound_i q_i².
    bounds: Vec<f64>,
    /// Inertia of the hub alone [kg·m²].
    hub: f64,
    /// J_e(0) [kg·m²].
    start: f64,
    border: Border,
    solution: Vec<f64>,
}

impl HubInertia {
    /// For the fields of `inertia`, whose mass has the given structure, on a hub of the given inertia alone [kg·m²]; `None` if
    /// that mass is singular.
    pub fn new(
        inertia: &Inertia,
        structure: &Structure,
        scratch: &mut Scratch,
        hub: f64,
    ) -> Option<HubInertia> {
        let n = inertia.len();
        let (whole, centrifugal, _) = inertia.matrices();
        let (mut mass, mut bounds) = (Matrix::new(structure), vec![0.0; n]);
        each(whole, |i, j| {
            if i < n && j < n {
                let entry = whole.get(i, j);
                bounds[i] += (entry - centrifugal.get(i, j)).abs();
                if entry != 0.0 {
                    mass.add(i, j, entry);
                }
            }
        });
        mass.factor().ok()?;
        let mut new =
            HubInertia { mass, bounds, hub, start: 0.0, border: Border::new(n), solution: vec![0.0; n] };
        let straight = State { q: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n], ..State::default() };
        new.start = new.left(inertia, scratch, &straight);
        Some(new)
    }

    /// J_e(q) [kg·m²].
    fn left(&mut self, inertia: &Inertia, scratch: &mut Scratch, s: &State) -> f64 {
        inertia.border(s, &HubKinematics::default(), &inertial(), scratch, &mut self.border);
        self.solution.copy_from_slice(&self.border.column);
        self.mass.solve(&mut self.solution);
        let taken: f64 = self.border.column.iter().zip(&self.solution).map(|(a, b)| a * b).sum();
        self.border.corner - taken
    }

    /// J_e(q) and J_e(0) [kg·m²] where at most the given part of J_e(0) is left; `None` otherwise.
    pub fn at_most(
        &mut self,
        part: f64,
        (inertia, scratch): (&Inertia, &mut Scratch),
        s: &State,
    ) -> Option<(f64, f64)> {
        let largest: f64 = self.bounds.iter().zip(&s.q).map(|(bound, q)| bound * q * q).sum();
        if self.hub - largest > part * self.start {
            return None;
        }
        let left = self.left(inertia, scratch, s);
        // Written so that NaN counts as lost.
        (!(left > part * self.start)).then_some((left, self.start))
    }

    /// J_e(0) over the inertia of hub and rigid beam together, J_θθ(0).
    pub fn share(&mut self, inertia: &Inertia, scratch: &mut Scratch) -> f64 {
        let n = inertia.len();
        let straight = State { q: vec![0.0; n], v: vec![0.0; n], a: vec![0.0; n], ..State::default() };
        inertia.border(&straight, &HubKinematics::default(), &inertial(), scratch, &mut self.border);
        self.start / self.border.corner
    }
}

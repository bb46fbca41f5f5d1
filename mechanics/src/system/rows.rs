//! The rows of constraints: their equations, and the sets of their multipliers.

use super::{Mode, State};

/// Weights c of the equation c₀ g + c₁ ġ + c₂ g̈ = 0 that takes the place of a constraint g = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RowWeights(pub [f64; 3]);

impl RowWeights {
    /// g = 0: index 3.
    pub const POSITION: RowWeights = RowWeights([1.0, 0.0, 0.0]);
    /// ġ = 0: index 2.
    pub const VELOCITY: RowWeights = RowWeights([0.0, 1.0, 0.0]);
    /// g̈ = 0: index 1.
    pub const ACCELERATION: RowWeights = RowWeights([0.0, 0.0, 1.0]);

    /// Baumgarte's stabilization g̈ + 2δ ġ + ε² g = 0 (δ, ε in 1/s).
    pub fn baumgarte(delta: f64, epsilon: f64) -> RowWeights {
        RowWeights([epsilon * epsilon, 2.0 * delta, 1.0])
    }

    /// c₀ g + c₁ ġ + c₂ g̈
    pub fn combine(self, g: f64, rate: f64, acceleration: f64) -> f64 {
        let [c0, c1, c2] = self.0;
        c0 * g + c1 * rate + c2 * acceleration
    }
}

/// The set in which a multiplier lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Set {
    /// λ ∈ ℝ: a joint, g = 0.
    Free,
    /// λ ≥ 0, g ≥ 0, λ g = 0: a contact that may open. A closing velocity ġ⁻ < 0 is thrown back as ġ⁺ ≥ −e ġ⁻.
    Unilateral {
        /// Newton's coefficient of restitution e, 0 … 1.
        restitution: f64,
    },
    /// |λ| ≤ μ λₙ: Coulomb friction of a contact; ġ is its sliding velocity, and g is not used.
    Friction {
        /// Coefficient μ ≥ 0.
        coefficient: f64,
        /// Number of the row of the normal contact.
        normal: usize,
    },
}

/// Whether a row imposes its constraint at this state: a joint always, a contact while it is closed, friction while it
/// sticks.
pub fn is_active(set: Set, mode: Mode) -> bool {
    set == Set::Free || mode == Mode::Closed
}

/// Replaces the equations of rows that are not active by those of their multipliers, λ = 0 or λ = ∓μ λₙ: `rows` holds
/// c₀ g + c₁ ġ + c₂ g̈ on entry.
pub fn replace_inactive(sets: &[Set], s: &State, rows: &mut [f64]) {
    for (i, (set, row)) in sets.iter().zip(rows).enumerate() {
        if !is_active(*set, s.mode[i]) {
            let (normal, slope) = slip(*set, s.mode[i]);
            *row = s.lambda[i] + slope * s.lambda[normal.unwrap_or(i)];
        }
    }
}

/// The normal row of a slipping contact and the factor ±μ in λ ± μ λₙ = 0; 0 for a contact that is open.
pub fn slip(set: Set, mode: Mode) -> (Option<usize>, f64) {
    match (set, mode) {
        (Set::Friction { coefficient, normal }, Mode::SlipForward) => (Some(normal), coefficient),
        (Set::Friction { coefficient, normal }, Mode::SlipBackward) => (Some(normal), -coefficient),
        _ => (None, 0.0),
    }
}

//! How well constraints hold: g, ġ and g̈ of the rows at a state.

use crate::system::{Dynamics, Mode, RowWeights, Set, State, is_active};

/// g, ġ, g̈ of every row. With `State::lambda` and `State::mode` they are what is to be recorded of constraints.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Violation {
    /// g \[m, rad\]; without meaning for friction.
    pub position: Vec<f64>,
    /// ġ \[m/s, rad/s\]
    pub velocity: Vec<f64>,
    /// g̈ \[m/s², rad/s²\]
    pub acceleration: Vec<f64>,
    /// Largest |g|, |ġ| and |g̈| of the rows that are active: of joints, closed contacts, and ġ and g̈ of friction that
    /// sticks, and of rows that are left out because they follow from others. A contact that is open counts with the penetration −g > 0.
    pub largest: [f64; 3],
}

impl Violation {
    /// With memory for the rows of `system`.
    pub fn new(system: &dyn Dynamics) -> Violation {
        let zeros = || vec![0.0; system.size().lambda];
        Violation { position: zeros(), velocity: zeros(), acceleration: zeros(), largest: [0.0; 3] }
    }

    /// Evaluates the rows at `s`; allocates nothing.
    pub fn evaluate(&mut self, system: &mut dyn Dynamics, s: &State) {
        self.largest = system.dropped(s);
        if self.position.is_empty() {
            return;
        }
        system.constraint(s, RowWeights::POSITION, &mut self.position);
        system.constraint(s, RowWeights::VELOCITY, &mut self.velocity);
        system.constraint(s, RowWeights::ACCELERATION, &mut self.acceleration);
        for (i, set) in system.rows().iter().enumerate() {
            let [g, rate, bend] = [self.position[i], self.velocity[i], self.acceleration[i]].map(f64::abs);
            let violated = match set {
                _ if !is_active(*set, s.mode[i]) => match set {
                    Set::Unilateral { .. } if s.mode[i] == Mode::Open => [-self.position[i], 0.0, 0.0],
                    _ => [0.0; 3],
                },
                Set::Friction { .. } => [0.0, rate, bend],
                _ => [g, rate, bend],
            };
            for (largest, x) in self.largest.iter_mut().zip(violated) {
                *largest = largest.max(x);
            }
        }
    }
}

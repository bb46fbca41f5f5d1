//! A load that rotates with a section of a curve, or does work on its rotation: forces and couples that depend on p′.
//!
//! With t, n = Jt the unit tangent and normal, ℓ = |p′|, and p the share at the point, a force F on p and a couple M
//! on the section do the work δW = F·δp + M δφ, δφ = n·δp′/ℓ:
//!
//! | nature | F | M |
//! |---|---|---|
//! | follower | f p (F_x t + F_y n) | 0 |
//! | couple | 0 | f p |
//! | eccentric dead force (V = −p n·d) | 0 | −p t·d |
//!
//! The torque on the hub is X F_y − Y F_x + M, and ∂(M n/ℓ)/∂p′ = n ⊗ (∂M/∂p′)/ℓ − M (t nᵀ + n tᵀ)/ℓ².

use super::components::Components;
use crate::hub_beam::fields::{Point, Shapes};
use crate::hub_beam::inertia::Border;
use crate::linalg::Storage;
use crate::linalg::vector::inner;
use crate::system::State;

/// What a load does to a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Nature {
    /// A force that rotates with it.
    Follower,
    /// A couple on it.
    Couple,
    /// A dead force off its axis, as a first moment.
    Eccentric,
}

/// A load on one section of a curve.
#[derive(Clone, Debug)]
pub(super) struct OnSection {
    nature: Nature,
    share: f64,
    /// a + x
    origin: f64,
    /// The fields X and Y.
    shapes: [Shapes; 2],
}

/// Force and couple on a section, with their derivatives by p′ and θ.
struct Wrench {
    t: [f64; 2],
    n: [f64; 2],
    stretch: f64,
    /// (X, Y)
    position: [f64; 2],
    force: [f64; 2],
    /// ∂F/∂φ, along n/ℓ of p′
    force_by_rotation: [f64; 2],
    couple: f64,
    couple_by_rotation: f64,
    couple_by_angle: f64,
}

impl OnSection {
    pub(super) fn new(point: &Point, nature: Nature, share: f64, radius: f64) -> OnSection {
        let shapes = [point.axial.clone(), point.transverse.clone()];
        OnSection { nature, share, origin: radius + point.x, shapes }
    }

    fn wrench(&self, s: &State, now: &Components) -> Wrench {
        let field = |c: usize, d: usize| self.shapes[c].field(d, &s.q);
        let position = [self.origin + field(0, 0), field(1, 0)];
        let (x1, y1) = (1.0 + field(0, 1), field(1, 1));
        let stretch = libm::hypot(x1, y1);
        let t = [x1 / stretch, y1 / stretch];
        let n = [-t[1], t[0]];
        let p = self.share;
        let mut out = Wrench {
            t,
            n,
            stretch,
            position,
            force: [0.0; 2],
            force_by_rotation: [0.0; 2],
            couple: 0.0,
            couple_by_rotation: 0.0,
            couple_by_angle: 0.0,
        };
        match self.nature {
            Nature::Follower => {
                let [x, y] = now.d;
                out.force = [0, 1].map(|c| p * (x * t[c] + y * n[c]));
                out.force_by_rotation = [0, 1].map(|c| p * (x * n[c] - y * t[c]));
            }
            Nature::Couple => out.couple = p * now.factor,
            Nature::Eccentric => {
                out.couple = -p * inner(t, now.d);
                out.couple_by_rotation = -p * inner(n, now.d);
                out.couple_by_angle = -p * inner(t, now.by_angle);
            }
        }
        out
    }

    pub(super) fn add_force(&self, s: &State, now: &Components, c: f64, out: &mut [f64]) {
        let w = self.wrench(s, now);
        for (axis, shapes) in self.shapes.iter().enumerate() {
            let (on_value, on_slope) = (c * w.force[axis], c * w.couple * w.n[axis] / w.stretch);
            for (k, &i) in shapes.index.iter().enumerate() {
                out[i] += on_value * shapes.value[0][k] + on_slope * shapes.value[1][k];
            }
        }
    }

    pub(super) fn add_tangent(&self, s: &State, now: &Components, c: f64, out: &mut Storage<f64>) {
        let w = self.wrench(s, now);
        let l = w.stretch;
        for (b, columns) in self.shapes.iter().enumerate() {
            let rotation = w.n[b] / l;
            for (a, rows) in self.shapes.iter().enumerate() {
                let on_value = c * w.force_by_rotation[a] * rotation;
                let on_slope = c
                    * (w.n[a] / l * w.couple_by_rotation * rotation
                        - w.couple * (w.t[a] * w.n[b] + w.n[a] * w.t[b]) / (l * l));
                for (k, &i) in rows.index.iter().enumerate() {
                    let row = on_value * rows.value[0][k] + on_slope * rows.value[1][k];
                    for (&j, slope) in columns.index.iter().zip(&columns.value[1]) {
                        out.add(i, j, row * slope);
                    }
                }
            }
        }
    }

    pub(super) fn torque(&self, s: &State, now: &Components) -> f64 {
        let w = self.wrench(s, now);
        w.position[0] * w.force[1] - w.position[1] * w.force[0] + w.couple
    }

    /// −p n·d of an eccentric dead force.
    pub(super) fn potential(&self, s: &State, now: &Components) -> f64 {
        match self.nature {
            Nature::Eccentric => -self.share * inner(self.wrench(s, now).n, now.d),
            _ => 0.0,
        }
    }

    pub(super) fn add_border(&self, s: &State, now: &Components, c: f64, out: &mut Border) {
        let w = self.wrench(s, now);
        let lever = w.position[0] * w.force_by_rotation[1] - w.position[1] * w.force_by_rotation[0]
            + w.couple_by_rotation;
        let by_position = [w.force[1], -w.force[0]];
        for (axis, shapes) in self.shapes.iter().enumerate() {
            let rotation = w.n[axis] / w.stretch;
            for (k, &i) in shapes.index.iter().enumerate() {
                let (value, slope) = (shapes.value[0][k], shapes.value[1][k]);
                out.row[i] += c * (by_position[axis] * value + lever * rotation * slope);
                out.column[i] += c * w.couple_by_angle * rotation * slope;
            }
        }
        out.corner += c * w.couple_by_angle;
    }
}

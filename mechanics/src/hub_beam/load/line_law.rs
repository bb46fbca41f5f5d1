//! A force law along the beam.
//!
//! At the points of the quadrature, with p = (X, Y) and v in the hub's frame, R its rotation, J that by 90° and w the weight of a
//! point,
//!
//! ```text
//! X = a + x + g_xᵀq,   Y = g_yᵀq,   v = (Ẋ − θ̇ Y, Ẏ + θ̇ X),   f = Rᵀ f(t, R p, R v)
//! Q_q = Σ w (f_x g_x + f_y g_y),   Q_θ = Σ w (J p)·f
//! ∂f/∂q = (D_r + θ̇ D_v J) g,   ∂f/∂q̇ = D_v g,   ∂f/∂θ = −J f + D_r J p + D_v J v,   ∂f/∂θ̇ = D_v J p
//! ```
//!
//! The displacement is its linear part: exact without foreshortening and on a curve, and to first order in q with
//! foreshortening.

use super::{Load, Site};
use crate::hub_beam::fields::Shapes;
use crate::hub_beam::inertia::Border;
use crate::law::{ForceLaw, Place, Response};
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::system::{State, Weights};
use std::sync::Arc;

/// A force per length of the beam by a [force law](crate::law).
#[derive(Clone, Debug)]
pub struct LineLaw {
    /// The law.
    pub law: Arc<dyn ForceLaw>,
    /// First and last station of the beam on which it acts \[m\].
    pub range: (f64, f64),
}

impl Load for LineLaw {
    fn sampled(&self, site: &Site<'_>) -> Option<Sampled> {
        let mut samples = Vec::new();
        site.fields.integrate_over(site.fields.cells(), |point| {
            if (self.range.0..=self.range.1).contains(&point.x) {
                let shapes = [point.axial.clone(), point.transverse.clone()];
                samples.push(Sample { weight: point.weight, origin: site.radius + point.x, shapes });
            }
        });
        let count = samples.len();
        Some(Sampled {
            law: Arc::clone(&self.law),
            samples: samples.into(),
            places: vec![Place::default(); count],
            responses: vec![Response::default(); count],
        })
    }
}

/// A point of the quadrature.
#[derive(Debug)]
struct Sample {
    weight: f64,
    /// a + x
    origin: f64,
    /// Functions of both fields.
    shapes: [Shapes; 2],
}

/// A force law at the points of a beam, ready to be evaluated.
#[derive(Clone, Debug)]
pub struct Sampled {
    law: Arc<dyn ForceLaw>,
    samples: Arc<[Sample]>,
    places: Vec<Place>,
    responses: Vec<Response>,
}

type Plane = [f64; 2];

/// A point with the force on it, in the hub's frame.
struct Acting<'a> {
    sample: &'a Sample,
    position: Plane,
    velocity: Plane,
    force: Plane,
    by_position: [Plane; 2],
    by_velocity: [Plane; 2],
}

/// J x
fn turned([x, y]: Plane) -> Plane {
    [-y, x]
}

fn dot(a: Plane, b: Plane) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn apply(m: &[Plane; 2], x: Plane) -> Plane {
    [dot(m[0], x), dot(m[1], x)]
}

impl Sampled {
    pub(super) fn is_affine(&self) -> bool {
        self.law.is_affine()
    }

    pub(super) fn dissipates(&self) -> bool {
        self.law.dissipates()
    }

    /// Calls `visit` for every point.
    fn each(&mut self, s: &State, hub: &HubKinematics, mut visit: impl FnMut(&Acting<'_>)) {
        let Sampled { law, samples, places, responses } = self;
        let (sin, cos) = libm::sincos(hub.angle);
        let inertial = |[x, y]: Plane| [cos * x - sin * y, sin * x + cos * y, 0.0];
        let moving = |sample: &Sample| {
            let [along, across] = &sample.shapes;
            let [x, y] = [sample.origin + along.field(0, &s.q), across.field(0, &s.q)];
            ([x, y], [along.field(0, &s.v) - hub.speed * y, across.field(0, &s.v) + hub.speed * x])
        };
        for (sample, place) in samples.iter().zip(places.iter_mut()) {
            let (position, velocity) = moving(sample);
            *place = Place { time: s.time(), position: inertial(position), velocity: inertial(velocity) };
        }
        law.responses(places, responses);
        // Rᵀ D R
        let in_hub = |m: &[[f64; 3]; 3]| {
            let columns = [[cos, sin], [-sin, cos]]
                .map(|e| [m[0][0] * e[0] + m[0][1] * e[1], m[1][0] * e[0] + m[1][1] * e[1]]);
            let row = |e: Plane| [dot(e, columns[0]), dot(e, columns[1])];
            [row([cos, sin]), row([-sin, cos])]
        };
        for (sample, response) in samples.iter().zip(responses.iter()) {
            let (position, velocity) = moving(sample);
            let [x, y, _] = response.force;
            visit(&Acting {
                sample,
                position,
                velocity,
                force: [cos * x + sin * y, cos * y - sin * x],
                by_position: in_hub(&response.by_position),
                by_velocity: in_hub(&response.by_velocity),
            });
        }
    }

    /// out += factor Q_q
    pub(super) fn add_force(&mut self, s: &State, hub: &HubKinematics, factor: f64, out: &mut [f64]) {
        self.each(s, hub, |at| {
            for (shapes, f) in at.sample.shapes.iter().zip(at.force) {
                shapes.add(factor * at.sample.weight * f, out);
            }
        });
    }

    /// Q_θ
    pub(super) fn torque(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let mut torque = 0.0;
        self.each(s, hub, |at| torque += at.sample.weight * dot(turned(at.position), at.force));
        torque
    }

    /// ∫ f·v dx \[W\]
    pub(super) fn power(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let mut power = 0.0;
        self.each(s, hub, |at| power += at.sample.weight * dot(at.force, at.velocity));
        power
    }

    /// out += factor (w.v ∂Q_q/∂q̇ + w.q ∂Q_q/∂q)
    pub(super) fn add_tangent(
        &mut self,
        s: &State,
        hub: &HubKinematics,
        w: &Weights<'_>,
        factor: f64,
        out: &mut Storage<f64>,
    ) {
        self.each(s, hub, |at| {
            let by = at.by_displacement(hub, w);
            for (row, by) in at.sample.shapes.iter().zip(by) {
                for (column, by) in at.sample.shapes.iter().zip(by) {
                    let weight = factor * at.sample.weight * by;
                    for (&i, a) in row.index.iter().zip(&row.value[0]) {
                        for (&j, b) in column.index.iter().zip(&column.value[0]) {
                            out.add(i, j, weight * a * b);
                        }
                    }
                }
            }
        });
    }

    /// Adds factor times the derivatives of Q_q by θ and of Q_θ by q and θ, weighted.
    pub(super) fn add_border(
        &mut self,
        s: &State,
        hub: &HubKinematics,
        w: &Weights<'_>,
        factor: f64,
        out: &mut Border,
    ) {
        self.each(s, hub, |at| {
            let (arm, c) = (turned(at.position), factor * at.sample.weight);
            let (swept, spun) = (apply(&at.by_position, arm), apply(&at.by_velocity, turned(at.velocity)));
            let (rotated, by_speed) = (turned(at.force), apply(&at.by_velocity, arm));
            // w.q ∂f/∂θ + w.v ∂f/∂θ̇
            let by_hub = [0, 1].map(|k: usize| w.q * (swept[k] + spun[k] - rotated[k]) + w.v * by_speed[k]);
            let by = at.by_displacement(hub, w);
            let own = [w.q * at.force[1], -w.q * at.force[0]];
            for (k, shapes) in at.sample.shapes.iter().enumerate() {
                shapes.add(c * by_hub[k], &mut out.column);
                shapes.add(c * (own[k] + arm[0] * by[0][k] + arm[1] * by[1][k]), &mut out.row);
            }
            out.corner += c * dot(arm, by_hub);
        });
    }
}

impl Acting<'_> {
    /// w.q ∂f/∂(X, Y) + w.v ∂f/∂(Ẋ, Ẏ) in the hub's frame.
    fn by_displacement(&self, hub: &HubKinematics, w: &Weights<'_>) -> [Plane; 2] {
        [0, 1].map(|k: usize| {
            let ([x, y], [along, across]) = (self.by_position[k], self.by_velocity[k]);
            let turning = [hub.speed * across, -hub.speed * along];
            [w.q * (x + turning[0]) + w.v * along, w.q * (y + turning[1]) + w.v * across]
        })
    }
}

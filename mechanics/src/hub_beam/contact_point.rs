//! A station of the beam that may touch an obstacle, in inertial axes or in the hub's frame.
//!
//! ```text
//! p = X e_X + Y e_Y,   ∂p/∂q = e_X ∂X/∂qᵀ + e_Y ∂Y/∂qᵀ,   ∂p/∂θ = X e_Y − Y e_X
//! X = a + x + g_xᵀq − ½ qᵀHq,   Y = g_yᵀq,   H = ∫₀ˣ φ′φ′ᵀ dξ with foreshortening, 0 without and on a curve
//! ```
//!
//! e_X and e_Y rotate with the hub; for an obstacle fixed to the hub they are constant, and θ does not appear.

use super::fields::{Fields, Shapes};
use super::load::Kinematics;
use crate::profile::HubKinematics;
use crate::system::State;
use std::sync::Arc;

/// What an obstacle is fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mount {
    /// The ground.
    Ground,
    /// The hub.
    Hub,
}

/// A station that may touch an obstacle.
#[derive(Clone, Debug)]
pub struct ContactPoint {
    pub(super) mount: Mount,
    /// a + x
    origin: f64,
    /// Functions of both fields at the station.
    pub(super) shapes: Arc<[Shapes; 2]>,
    /// H, with foreshortening, as a sum over the cells between root and station.
    pub(super) shortening: Arc<[Shortening]>,
    /// ∂X/∂q and ∂Ẋ/∂q with foreshortening.
    pub(super) by: [Vec<f64>; 2],
}

/// The part of H of neighbouring cells with the same transverse functions.
#[derive(Clone, Debug)]
pub(super) struct Shortening {
    unknowns: Vec<usize>,
    /// ∫ φ′φ′ᵀ dξ by rows \[1/m\].
    integral: Vec<f64>,
}

impl Shortening {
    /// Calls `f` with every unknown i and Σⱼ Hᵢⱼ xⱼ of every vector x.
    pub(super) fn multiply<const N: usize>(&self, x: [&[f64]; N], mut f: impl FnMut(usize, [f64; N])) {
        for (&i, row) in self.unknowns.iter().zip(self.integral.chunks_exact(self.unknowns.len().max(1))) {
            let mut sum = [0.0; N];
            for (&j, h) in self.unknowns.iter().zip(row) {
                for (sum, x) in sum.iter_mut().zip(x) {
                    *sum += h * x[j];
                }
            }
            f(i, sum);
        }
    }

    /// Calls `f` with every entry (i, j, Hᵢⱼ).
    pub(super) fn each(&self, mut f: impl FnMut(usize, usize, f64)) {
        let pairs = self.unknowns.iter().flat_map(|&i| self.unknowns.iter().map(move |&j| (i, j)));
        pairs.zip(&self.integral).for_each(|((i, j), &h)| f(i, j, h));
    }
}

/// X, Y and their rates, and the axes e_X, e_Y.
pub(super) struct Place {
    pub x: [f64; 3],
    pub y: [f64; 3],
    pub axes: [[f64; 2]; 2],
    pub speed: f64,
    pub acceleration: f64,
}

impl ContactPoint {
    /// The station `x` \[m\], a boundary of cells; `radius` is that of the hub \[m\].
    pub(super) fn new(
        fields: &Fields,
        kinematics: Kinematics,
        radius: f64,
        (x, mount): (f64, Mount),
    ) -> ContactPoint {
        let point = fields.point(x, 1.0);
        let mut shortening: Vec<Shortening> = Vec::new();
        if kinematics == Kinematics::Foreshortened {
            fields.integrate(|point| {
                if point.x >= x {
                    return;
                }
                let Shapes { index, value } = &point.transverse;
                if shortening.last().is_none_or(|last| last.unknowns != *index) {
                    let integral = vec![0.0; index.len() * index.len()];
                    shortening.push(Shortening { unknowns: index.clone(), integral });
                }
                let Some(last) = shortening.last_mut() else { return };
                let products = value[1].iter().flat_map(|a| value[1].iter().map(move |b| a * b));
                last.integral.iter_mut().zip(products).for_each(|(h, ab)| *h += point.weight * ab);
            });
        }
        let n = if shortening.is_empty() { 0 } else { fields.len() };
        let by = [vec![0.0; n], vec![0.0; n]];
        let shapes = Arc::new([point.axial, point.transverse]);
        ContactPoint { mount, origin: radius + x, shapes, shortening: shortening.into(), by }
    }

    pub(super) fn place(&self, s: &State, hub: &HubKinematics) -> Place {
        let field = |k: usize, q: &[f64]| self.shapes[k].field(0, q);
        let mut x = [self.origin + field(0, &s.q), field(0, &s.v), field(0, &s.a)];
        for part in self.shortening.iter() {
            part.multiply([&s.q, &s.v, &s.a], |i, [hq, hv, ha]| {
                x[0] -= 0.5 * s.q[i] * hq;
                x[1] -= s.q[i] * hv;
                x[2] -= s.q[i] * ha + s.v[i] * hv;
            });
        }
        let y = [&s.q, &s.v, &s.a].map(|q| field(1, q));
        let (axes, speed, acceleration) = match self.mount {
            Mount::Hub => ([[1.0, 0.0], [0.0, 1.0]], 0.0, 0.0),
            Mount::Ground => {
                let (sin, cos) = libm::sincos(hub.angle);
                ([[cos, sin], [-sin, cos]], hub.speed, hub.acceleration)
            }
        };
        Place { x, y, axes, speed, acceleration }
    }
}

impl Place {
    /// x e_X + y e_Y
    pub(super) fn vector(&self, x: f64, y: f64) -> [f64; 3] {
        let [along, across] = self.axes;
        [x * along[0] + y * across[0], x * along[1] + y * across[1], 0.0]
    }

    /// (Ẋ − ωY, Ẏ + ωX)
    pub(super) fn velocity(&self) -> [f64; 2] {
        [self.x[1] - self.speed * self.y[0], self.y[1] + self.speed * self.x[0]]
    }
}

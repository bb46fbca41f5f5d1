//! Force laws along beams in space.
//!
//! In each element at Gauss points, with the shape functions N of the cubic centreline:
//!
//! ```text
//! Q = ∫ Nᵀ f(t, N q, N q̇) ds,   ∂Q/∂q = ∫ Nᵀ D_r N ds,   ∂Q/∂q̇ = ∫ Nᵀ D_v N ds
//! ```

use super::slender::{Beam, ELEMENT_COORDINATES, ELEMENT_VELOCITIES};
use crate::law::{ForceLaw, Place, Response};
use crate::linalg::{Matrix, Vec3};
use crate::system::Weights;
use std::ops::Range;
use std::sync::Arc;

/// Points and weights of Gauss's rule of order 8 on [0, 1].
const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// A force per length of a beam by a [force law](crate::law).
#[derive(Clone, Debug)]
pub struct LineLaw {
    /// Name, unique in its model.
    pub name: String,
    /// Number of the beam.
    pub beam: usize,
    /// Elements on which it acts; `None` for all.
    pub elements: Option<Range<usize>>,
    /// The law.
    pub law: Arc<dyn ForceLaw>,
}

/// A force law at the points of its beam.
#[derive(Clone, Debug, Default)]
pub(super) struct Sampled {
    /// Of each point: number of its element, and shape functions of r₁, r′₁, r₂, r′₂, with the weight of the quadrature.
    points: Arc<[(usize, [f64; 4], f64)]>,
    places: Vec<Place>,
    responses: Vec<Response>,
}

/// Where r₁, r′₁, r₂, r′₂ of an element begin, of `step` numbers an element.
fn places(element: usize, step: usize) -> [usize; 4] {
    [0, 3, step, step + 3].map(|at| step * element + at)
}

impl Sampled {
    /// At the points of its beam.
    pub(super) fn new(law: &LineLaw, beam: &Beam) -> Sampled {
        let on = law.elements.clone().unwrap_or(0..usize::MAX);
        let mut points = Vec::new();
        for (e, element) in beam.elements().iter().enumerate().filter(|(e, _)| on.contains(e)) {
            let h = element.length();
            for (z, weight) in GAUSS {
                let (square, cube) = (z * z, z * z * z);
                let first = 1.0 - 3.0 * square + 2.0 * cube;
                let shapes = [first, h * (z - 2.0 * square + cube), 1.0 - first, h * (cube - square)];
                points.push((e, shapes, h * weight));
            }
        }
        let count = points.len();
        Sampled {
            points: points.into(),
            places: vec![Place::default(); count],
            responses: vec![Response::default(); count],
        }
    }

    /// Evaluates the law at the time `t`, with q and v of the beam.
    fn evaluate(&mut self, law: &dyn ForceLaw, t: f64, [q, v]: [&[f64]; 2]) {
        for ((element, shapes, _), place) in self.points.iter().zip(&mut self.places) {
            let at = |x: &[f64], step: usize| {
                let mut sum = Vec3::ZERO;
                for (n, at) in shapes.iter().zip(places(*element, step)) {
                    sum += *n * Vec3::at(x, at);
                }
                sum.0
            };
            let (position, velocity) = (at(q, ELEMENT_COORDINATES), at(v, ELEMENT_VELOCITIES));
            *place = Place { time: t, position, velocity };
        }
        law.responses(&self.places, &mut self.responses);
    }

    /// r += c Q
    pub(super) fn add_forces(
        &mut self,
        (law, t, c): (&dyn ForceLaw, f64, f64),
        state: [&[f64]; 2],
        r: &mut [f64],
    ) {
        self.evaluate(law, t, state);
        for ((element, shapes, weight), response) in self.points.iter().zip(&self.responses) {
            for (n, at) in shapes.iter().zip(places(*element, ELEMENT_VELOCITIES)) {
                (c * weight * n * Vec3(response.force)).add_to(r, at);
            }
        }
    }

    /// Adds c (w.q ∂Q/∂q + w.v ∂Q/∂q̇) to a matrix in which the velocities of the beam begin at `first`.
    pub(super) fn add_tangent(
        &mut self,
        (law, t, c): (&dyn ForceLaw, f64, f64),
        state: [&[f64]; 2],
        w: &Weights<'_>,
        (first, out): (usize, &mut Matrix),
    ) {
        self.evaluate(law, t, state);
        for ((element, shapes, weight), response) in self.points.iter().zip(&self.responses) {
            let at = places(*element, ELEMENT_VELOCITIES).map(|at| first + at);
            for i in 0..3 {
                for j in 0..3 {
                    let by = w.q * response.by_position[i][j] + w.v * response.by_velocity[i][j];
                    if by == 0.0 {
                        continue;
                    }
                    for (n, row) in shapes.iter().zip(at) {
                        for (m, column) in shapes.iter().zip(at) {
                            out.add(row + i, column + j, c * weight * n * m * by);
                        }
                    }
                }
            }
        }
    }

    /// ∫ f·ṙ ds \[W\]
    pub(super) fn power(&mut self, law: &dyn ForceLaw, t: f64, state: [&[f64]; 2]) -> f64 {
        self.evaluate(law, t, state);
        let of = |(((_, _, weight), place), response): (((_, _, &f64), &Place), &Response)| {
            weight * response.power(place)
        };
        let points = self.points.iter().map(|(e, n, w)| (e, n, w));
        points.zip(&self.places).zip(&self.responses).map(of).sum()
    }
}

//! Force laws along beams in space.
//!
//! In each element at Gauss points, with the [functions](super::beam) N of the axis:
//!
//! ```text
//! Q = ∫ Nᵀ f(t, N q, N q̇) ds,   ∂Q/∂q = ∫ Nᵀ D_r N ds,   ∂Q/∂q̇ = ∫ Nᵀ D_v N ds
//! ```

use super::beam::Beam;
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
    points: Arc<[Point]>,
    places: Vec<Place>,
    responses: Vec<Response>,
}

/// A point of a beam: where the four vectors of its element begin among coordinates and velocities, their functions N, and the weight
/// of the quadrature \[m\].
#[derive(Clone, Debug)]
struct Point {
    supports: [[usize; 2]; 4],
    shapes: [f64; 4],
    weight: f64,
}

impl Sampled {
    /// At the points of its beam.
    pub(super) fn new(law: &LineLaw, beam: &Beam) -> Sampled {
        let on = law.elements.clone().unwrap_or(0..usize::MAX);
        let mut points = Vec::new();
        for e in (0..beam.elements()).filter(|e| on.contains(e)) {
            for (z, weight) in GAUSS {
                let [shapes, ..] = beam.shapes(e, z);
                points.push(Point { supports: beam.supports(e), shapes, weight: beam.length(e) * weight });
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
        for (Point { supports, shapes, .. }, place) in self.points.iter().zip(&mut self.places) {
            let at = |x: &[f64], k: usize| {
                let mut sum = Vec3::ZERO;
                for (n, at) in shapes.iter().zip(supports) {
                    sum += *n * Vec3::at(x, at[k]);
                }
                sum.0
            };
            let (position, velocity) = (at(q, 0), at(v, 1));
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
        for (Point { supports, shapes, weight }, response) in self.points.iter().zip(&self.responses) {
            for (n, [_, at]) in shapes.iter().zip(supports) {
                (c * weight * n * Vec3(response.force)).add_to(r, *at);
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
        for (Point { supports, shapes, weight }, response) in self.points.iter().zip(&self.responses) {
            let at = supports.map(|[_, at]| first + at);
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
        let of =
            |((point, place), response): ((&Point, &Place), &Response)| point.weight * response.power(place);
        self.points.iter().zip(&self.places).zip(&self.responses).map(of).sum()
    }
}

//! A point on the axis of a beam: at a station, or the one that is nearest to an obstacle.
//!
//! With the signed distance g(r) of the obstacle, whose gradient is n,
//!
//! ```text
//! φ(s) = g(r(s)),   φ′ = n·r′ = 0,   φ″ = n·r″ + Σ κᵢ (tᵢ·r′)²
//! ```
//!
//! The least φ of the nodes and the middles of elements begins Newton's method for φ′ = 0 between its neighbours, with bisection where
//! it leaves them; φ′ is continuous where elements meet, but for the kink that an axis with shear may have there. Beyond an end of the beam, the end is nearest. Nothing is kept from state
//! to state: the point depends on the configuration alone.

use super::beam::Beam;
use super::contact_point::Along;
use crate::contact::Obstacle;
use crate::linalg::Vec3;

/// Most iterations: bisection of half an element down to rounding.
const ITERATIONS: usize = 60;

/// A point on the axis of a beam.
#[derive(Clone, Debug, Default)]
pub(super) struct OnAxis {
    /// Element, and place in it from 0 to 1.
    pub element: usize,
    pub place: f64,
    /// Whether it is the nearest point, and between the ends of the beam.
    pub inside: bool,
    /// N, N′ and N″ there.
    shapes: [[f64; 4]; 3],
    /// The nodes and the middles of elements, of a point that is sought.
    samples: Vec<Vec3>,
}

/// r, r′ and r″ at the place z of an element, by the coordinates of its beam.
fn curve(beam: &Beam, q: &[f64], element: usize, z: f64) -> [Vec3; 3] {
    beam.shapes(element, z).map(|n| beam.on_axis(&n, q, element))
}

impl OnAxis {
    /// Of a beam, with memory for its samples where the point is to be sought.
    pub fn new(beam: &Beam, along: Along) -> OnAxis {
        match along {
            Along::Nearest => {
                OnAxis { samples: vec![Vec3::ZERO; 2 * beam.elements() + 1], ..OnAxis::default() }
            }
            Along::Station(s) => {
                let (element, place) = beam.element(s);
                OnAxis { element, place, shapes: beam.shapes(element, place), ..OnAxis::default() }
            }
        }
    }

    /// Whether it is the point nearest to the obstacle.
    pub fn is_sought(&self) -> bool {
        !self.samples.is_empty()
    }

    /// Finds the point of `beam` with the coordinates `q`, if it is to be sought.
    pub fn find(&mut self, beam: &Beam, q: &[f64], obstacle: &dyn Obstacle, t: f64) {
        if !self.is_sought() {
            return;
        }
        let count = beam.elements();
        for (j, sample) in self.samples.iter_mut().enumerate() {
            let element = (j / 2).min(count - 1);
            let z = 0.5 * j as f64 - element as f64;
            *sample = curve(beam, q, element, z)[0];
        }
        // In numbers of elements from the first node.
        let mut at = 0.5 * obstacle.nearest(&self.samples, t) as f64;
        let (mut low, mut high) = ((at - 0.5).max(0.0), (at + 0.5).min(count as f64));
        for _ in 0..ITERATIONS {
            (self.element, self.place) = split(at, count);
            let h = beam.length(self.element);
            let [r, slope, curvature] = curve(beam, q, self.element, self.place);
            let surface = obstacle.surface(r, t);
            let gradient = surface.normal.dot(slope);
            let across = [0, 1].map(|i| surface.curvatures[i] * surface.tangents[i].dot(slope).powi(2));
            let second = surface.normal.dot(curvature) + across[0] + across[1];
            self.inside = second > 0.0 && at > 0.0 && at < count as f64;
            *(if gradient > 0.0 { &mut high } else { &mut low }) = at;
            let newton = at - gradient / (second * h);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - at).abs() <= 4.0 * f64::EPSILON * count as f64 {
                break;
            }
            at = next;
        }
        self.shapes = beam.shapes(self.element, self.place);
    }

    /// Hands the numbers of the velocities of the four vectors in those of the beam to `visit`, each with N, N′ and its direction.
    pub fn unknowns(&self, beam: &Beam, mut visit: impl FnMut(usize, Vec3, Vec3)) {
        let [value, slope, _] = self.shapes;
        for (i, [_, first]) in beam.supports(self.element).into_iter().enumerate() {
            for (k, axis) in Vec3::AXES.into_iter().enumerate() {
                visit(first + k, value[i] * axis, slope[i] * axis);
            }
        }
    }

    /// r there.
    pub fn position(&self, beam: &Beam, q: &[f64]) -> Vec3 {
        beam.on_axis(&self.shapes[0], q, self.element)
    }

    /// r, r′, r″ there by the coordinates of the beam.
    pub fn shape(&self, beam: &Beam, q: &[f64]) -> [Vec3; 3] {
        self.shapes.map(|n| beam.on_axis(&n, q, self.element))
    }

    /// The rates of r and r′ by those of the coordinates.
    pub fn rates(&self, beam: &Beam, v: &[f64]) -> [Vec3; 2] {
        let [value, slope, _] = self.shapes;
        [value, slope].map(|n| beam.rate_on_axis(&n, v, self.element))
    }

    /// Its arc length \[m\].
    pub fn station(&self, beam: &Beam) -> f64 {
        beam.end(self.element) + self.place * beam.length(self.element)
    }
}

/// The element and the place in it of a number of elements from the first node.
fn split(at: f64, count: usize) -> (usize, f64) {
    let element = (at as usize).min(count - 1);
    (element, at - element as f64)
}

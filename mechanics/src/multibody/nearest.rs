//! The point of a beam that is nearest to an obstacle.
//!
//! With the signed distance g(r) of the obstacle, whose gradient is n,
//!
//! ```text
//! φ(s) = g(r(s)),   φ′ = n·r′ = 0,   φ″ = n·r″ + Σ κᵢ (tᵢ·r′)²
//! ```
//!
//! The least φ of the nodes and the middles of elements begins Newton's method for φ′ = 0 between its neighbours, with bisection where
//! it leaves them; φ′ is continuous where elements meet. Beyond an end of the beam, the end is nearest. Nothing is kept from state
//! to state: the point depends on the configuration alone.

use super::slender::{Beam, ELEMENT_COORDINATES, ELEMENT_VELOCITIES, combined, hermite};
use crate::contact::Obstacle;
use crate::linalg::Vec3;

/// Most iterations: bisection of half an element down to rounding.
const ITERATIONS: usize = 60;

/// The point of a beam that is nearest to an obstacle.
#[derive(Clone, Debug, Default)]
pub(super) struct Nearest {
    /// Element, and place in it from 0 to 1.
    pub element: usize,
    pub place: f64,
    /// Whether it is between the ends of the beam.
    pub inside: bool,
    /// The nodes and the middles of elements.
    samples: Vec<Vec3>,
}

/// r₁, r′₁, r₂, r′₂ of an element, or their rates, whose nodes have `stride` entries in `x`.
fn ends(x: &[f64], stride: usize, element: usize) -> [Vec3; 4] {
    let (first, second) = (stride * element, stride * (element + 1));
    [first, first + 3, second, second + 3].map(|at| Vec3::at(x, at))
}

/// r, r′ and r″ at the place z of an element of the length h \[m\], by its coordinates.
fn curve(q: &[f64], element: usize, z: f64, h: f64) -> [Vec3; 3] {
    hermite(z, h).map(|n| combined(&n, &ends(q, ELEMENT_COORDINATES, element)))
}

impl Nearest {
    /// With memory for the samples of a beam.
    pub fn of(beam: &Beam) -> Nearest {
        Nearest { samples: vec![Vec3::ZERO; 2 * beam.elements().len() + 1], ..Nearest::default() }
    }

    /// Finds the point of `beam` with the coordinates `q`.
    pub fn find(&mut self, beam: &Beam, q: &[f64], obstacle: &dyn Obstacle, t: f64) {
        let elements = beam.elements();
        let count = elements.len();
        for (j, sample) in self.samples.iter_mut().enumerate() {
            let element = (j / 2).min(count - 1);
            let z = 0.5 * j as f64 - element as f64;
            *sample = curve(q, element, z, elements[element].length())[0];
        }
        // In numbers of elements from the first node.
        let mut at = 0.5 * obstacle.nearest(&self.samples, t) as f64;
        let (mut low, mut high) = ((at - 0.5).max(0.0), (at + 0.5).min(count as f64));
        for _ in 0..ITERATIONS {
            (self.element, self.place) = split(at, count);
            let h = elements[self.element].length();
            let [r, slope, curvature] = curve(q, self.element, self.place, h);
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
    }

    /// Hands the numbers of the velocities ṙ₁, ṙ′₁, ṙ₂, ṙ′₂ in those of the beam to `visit`, each with N, N′ and its direction.
    pub fn unknowns(&self, beam: &Beam, mut visit: impl FnMut(usize, Vec3, Vec3)) {
        let [value, slope, _] = hermite(self.place, beam.elements()[self.element].length());
        for i in 0..4 {
            let first = ELEMENT_VELOCITIES * (self.element + i / 2) + 3 * (i % 2);
            for (k, axis) in Vec3::AXES.into_iter().enumerate() {
                visit(first + k, value[i] * axis, slope[i] * axis);
            }
        }
    }

    /// r, r′, r″ there by the coordinates of the beam.
    pub fn shape(&self, beam: &Beam, q: &[f64]) -> [Vec3; 3] {
        curve(q, self.element, self.place, beam.elements()[self.element].length())
    }

    /// The rates of r and r′ by those of the coordinates.
    pub fn rates(&self, beam: &Beam, v: &[f64]) -> [Vec3; 2] {
        let [value, slope, _] = hermite(self.place, beam.elements()[self.element].length());
        [value, slope].map(|n| combined(&n, &ends(v, ELEMENT_VELOCITIES, self.element)))
    }

    /// Its arc length \[m\].
    pub fn station(&self, beam: &Beam) -> f64 {
        beam.nodes()[self.element] + self.place * beam.elements()[self.element].length()
    }
}

/// The element and the place in it of a number of elements from the first node.
fn split(at: f64, count: usize) -> (usize, f64) {
    let element = (at as usize).min(count - 1);
    (element, at - element as f64)
}

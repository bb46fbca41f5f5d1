//! What is at a station of a [beam](Beam), and whether its elements can show it.

use super::beam::Beam;
use super::shear::{self, NODE_VELOCITIES, NODES, POINTS};
use super::slender::{self, hermite};
use crate::linalg::Vec3;
use crate::system::Frame;

/// |r′| below which a beam has no direction.
const LEAST_STRETCH: f64 = 0.05;
/// Angle \[rad\] between sections of an element with shear from which on its rotation vector is close to a jump at π.
const LARGEST_TURN: f64 = 3.0;

/// Strains and stress resultants of a section; the shears and their forces are those of a beam with shear alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sample {
    /// (ε, γ₂, γ₃, κ₁, κ₂, κ₃) less those without stress \[1, 1/m\].
    pub strain: [f64; 6],
    /// (N, Q₂, Q₃, M₁, M₂, M₃) \[N, N·m\].
    pub stress: [f64; 6],
    /// ½ (κ₁² − κ₁₀²) of a slender beam \[1/m²\].
    pub winding: f64,
}

impl Beam {
    /// The element of the arc length `s` and the place 0 … 1 in it.
    pub(super) fn element(&self, s: f64) -> (usize, f64) {
        let nodes = self.nodes();
        let before = nodes.partition_point(|node| *node <= s).clamp(1, nodes.len() - 1) - 1;
        let element = before / self.steps();
        let (from, to) = (self.end(element), self.end(element + 1));
        (element, (s - from) / (to - from))
    }

    /// Length of an element \[m\].
    pub(super) fn length(&self, element: usize) -> f64 {
        match self {
            Beam::Slender(beam) => beam.elements()[element].length(),
            Beam::Shear(beam) => beam.elements()[element].length(),
        }
    }

    /// N, N′ and N″ of the four vectors at the place z of an element.
    pub(super) fn shapes(&self, element: usize, z: f64) -> [[f64; 4]; 3] {
        let h = self.length(element);
        match self {
            Beam::Slender(_) => hermite(z, h),
            Beam::Shear(_) => {
                let [n, slope, curvature] = shear::lagrange(z);
                [n, slope.map(|x| x / h), curvature.map(|x| x / (h * h))]
            }
        }
    }

    /// Where the four vectors of an element begin among the coordinates and among the velocities.
    pub(super) fn supports(&self, element: usize) -> [[usize; 2]; 4] {
        let first = self.steps() * element;
        match self {
            Beam::Slender(_) => {
                let ([q, v], [next_q, next_v]) = (self.place(first), self.place(first + 1));
                [[q, v], [q + 3, v + 3], [next_q, next_v], [next_q + 3, next_v + 3]]
            }
            Beam::Shear(_) => [0, 1, 2, 3].map(|i| self.place(first + i)),
        }
    }

    /// Σ Nᵢ xᵢ of the coordinates.
    #[inline]
    pub(super) fn on_axis(&self, n: &[f64; 4], q: &[f64], element: usize) -> Vec3 {
        slender::combined(n, &self.supports(element).map(|[at, _]| Vec3::at(q, at)))
    }

    /// Σ Nᵢ ẋᵢ of velocities or accelerations.
    #[inline]
    pub(super) fn rate_on_axis(&self, n: &[f64; 4], v: &[f64], element: usize) -> Vec3 {
        slender::combined(n, &self.supports(element).map(|[_, at]| Vec3::at(v, at)))
    }

    /// Position and axes at the arc length `s`.
    pub(super) fn frame(&self, q: &[f64], s: f64) -> Frame {
        let (element, z) = self.element(s);
        match self {
            Beam::Slender(beam) => {
                let (position, triad) = beam.section(q, element, z);
                Frame { position, rotation: triad.rotation() }
            }
            Beam::Shear(beam) => beam.section(q, element, z),
        }
    }

    /// Velocity of the axis at the arc length `s`.
    pub(super) fn velocity(&self, v: &[f64], s: f64) -> Vec3 {
        let (element, z) = self.element(s);
        self.rate_on_axis(&self.shapes(element, z)[0], v, element)
    }

    /// The angular velocity of the first section in space.
    pub(super) fn root_spin(&self, q: &[f64], v: &[f64]) -> Vec3 {
        match self {
            Beam::Slender(beam) => {
                let [spin, _] = beam.node(0, q).1.angular_motion([v[3], v[4], v[5], v[6]], [0.0; 4]);
                spin
            }
            Beam::Shear(beam) => beam.node(0, q).rotation * Vec3::at(v, 3),
        }
    }

    /// The direction of the first axis of a section at the arc length `s`, and its rate: r′ of a slender beam.
    pub(super) fn direction(&self, [q, v]: [&[f64]; 2], s: f64) -> [Vec3; 2] {
        let (element, z) = self.element(s);
        match self {
            Beam::Slender(beam) => {
                let (_, triad) = beam.section(q, element, z);
                let rate = self.rate_on_axis(&self.shapes(element, z)[1], v, element);
                [triad.length * triad.tangent, rate]
            }
            Beam::Shear(beam) => {
                let [n, ..] = shear::lagrange(z);
                let spin = |k: usize| {
                    let node = POINTS * element + k;
                    n[k] * (beam.node(node, q).rotation * Vec3::at(v, NODE_VELOCITIES * node + 3))
                };
                let along = beam.section(q, element, z).rotation.column(0);
                [along, (0..NODES).map(spin).sum::<Vec3>().cross(along)]
            }
        }
    }

    /// Strains and stress resultants at the arc length `s`, by the polynomial through quadrature points, where their errors are of higher order
    /// than elsewhere: those of the two elements next to it of a slender beam, those of the element of one with shear.
    pub(super) fn sample(&self, q: &[f64], s: f64) -> Sample {
        let mut samples = [(0.0, Sample::default()); 4];
        let mut count = 0;
        let mut add = |at: f64, sample: Sample| {
            samples[count] = (at, sample);
            count += 1;
        };
        let (element, z) = self.element(s);
        match self {
            Beam::Slender(beam) => {
                let first = if z < 0.5 { element.saturating_sub(1) } else { element };
                let first = first.min(beam.elements().len().saturating_sub(2));
                for e in (first..beam.elements().len()).take(2) {
                    for of in beam.samples(q, e) {
                        let wide = |x: [f64; 4]| [x[0], 0.0, 0.0, x[1], x[2], x[3]];
                        let (strain, stress) = (wide(of.strain), wide(of.stress));
                        add(
                            self.end(e) + of.place * self.length(e),
                            Sample { strain, stress, winding: of.winding },
                        );
                    }
                }
            }
            Beam::Shear(beam) => {
                for of in beam.samples(q, element) {
                    let place = self.end(element) + of.place * self.length(element);
                    add(place, Sample { strain: of.strain, stress: of.stress, winding: 0.0 });
                }
            }
        }
        let mut out = Sample::default();
        let used = &samples[..count];
        for (k, (own, value)) in used.iter().enumerate() {
            let others = used.iter().enumerate().filter(|(j, _)| *j != k);
            let part: f64 = others.map(|(_, (other, _))| (s - other) / (own - other)).product();
            for i in 0..6 {
                out.strain[i] += part * value.strain[i];
                out.stress[i] += part * value.stress[i];
            }
            out.winding += part * value.winding;
        }
        out
    }

    /// The node at which a slender beam is compressed to almost nothing, and its |r′| there.
    pub(super) fn compressed(&self, q: &[f64]) -> Option<(usize, f64)> {
        let stretch = |node: usize| match self {
            Beam::Slender(beam) => beam.node(node, q).1.length,
            Beam::Shear(_) => {
                // At the nodes the axis may have a kink: the least of what both elements have.
                let (steps, last) = (self.steps(), self.elements() - 1);
                let of = |element: usize| {
                    let z = shear::Element::places()[node - steps * element];
                    self.on_axis(&self.shapes(element, z)[1], q, element).norm()
                };
                let element = (node / steps).min(last);
                of(element)
            }
        };
        let lengths = (0..self.nodes().len()).map(|node| (node, stretch(node)));
        lengths.into_iter().find(|(_, length)| !(*length > LEAST_STRETCH))
    }

    /// The ends of an element that is twisted or bent by as much as its sections can show.
    pub(super) fn twisted(&self, q: &[f64]) -> Option<[f64; 2]> {
        let wound = |e: &usize| match self {
            Beam::Slender(beam) => beam.is_wound(q, *e),
            Beam::Shear(beam) => !(beam.turn(q, *e) < LARGEST_TURN),
        };
        let element = (0..self.elements()).find(wound)?;
        Some([self.end(element), self.end(element + 1)])
    }
}

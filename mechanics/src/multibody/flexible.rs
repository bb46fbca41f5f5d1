//! A slender beam as a part of a model, and loads along it.

use super::body::Twist;
use super::error::PartFault;
use super::force::Axes;
use super::slender::{
    Beam, COORDINATES, ELEMENT_COORDINATES, ELEMENT_VELOCITIES, LineDistribution, Sample, Triad,
    distributed_weights, uniform_weights,
};
use crate::linalg::{Mat3, Vec3};
use crate::profile::Profile;
use crate::system::Frame;
use std::ops::Range;
use std::sync::Arc;

/// A slender beam as it stands at the start: without stress, and moving as a rigid body.
#[derive(Clone, Debug)]
pub struct Flexible {
    /// Name, unique in its model.
    pub name: String,
    /// Centreline without stress, mesh and sections. Its own damping is replaced.
    pub beam: Beam,
    /// Velocity of its first node at the start, inertial axes \[m/s\].
    pub velocity: Option<Vec3>,
    /// Angular velocity at the start, inertial axes [rad/s].
    pub spin: Option<Vec3>,
    /// Damping β [1/s] in proportion to the mass: forces −β M v.
    pub damping: f64,
    /// Damping η \[s\] in proportion to the stiffness (Kelvin–Voigt): stresses C (γ − γ₀ + η γ̇) of the strains γ.
    pub viscosity: f64,
    /// Arc lengths \[m\] of the stations that are recorded.
    pub stations: Vec<f64>,
    /// Whether they are recorded in the axes of the root too, as those of a beam in the plane.
    pub in_root_axes: bool,
    /// Fibres whose strain is recorded.
    pub fibres: Vec<Fibre>,
}

/// A point of a section whose strain is recorded.
#[derive(Clone, Debug, PartialEq)]
pub struct Fibre {
    /// Name, unique in its beam.
    pub name: String,
    /// Arc length \[m\].
    pub station: f64,
    /// Place (y, z) along n and b \[m\].
    pub place: [f64; 2],
}

impl Flexible {
    /// A beam at rest and without damping, of which the last node is recorded.
    pub fn new(name: &str, beam: Beam) -> Flexible {
        let end = beam.nodes().last().copied().unwrap_or(0.0);
        Flexible {
            name: name.to_owned(),
            beam,
            velocity: None,
            spin: None,
            damping: 0.0,
            viscosity: 0.0,
            stations: vec![end],
            in_root_axes: false,
            fibres: Vec::new(),
        }
    }

    /// The same beam with damping β [1/s] in proportion to its mass.
    pub fn damped(self, damping: f64) -> Flexible {
        Flexible { damping, ..self }
    }

    /// The same beam with damping η \[s\] in proportion to its stiffness.
    pub fn viscous(self, viscosity: f64) -> Flexible {
        Flexible { viscosity, ..self }
    }

    /// The same beam, recorded at these arc lengths \[m\].
    pub fn recorded_at(self, stations: &[f64]) -> Flexible {
        Flexible { stations: stations.to_vec(), ..self }
    }

    /// The same beam, its stations recorded in the axes of its root too.
    #[must_use]
    pub fn seen_from_its_root(self) -> Flexible {
        Flexible { in_root_axes: true, ..self }
    }

    /// The same beam with the strain of a fibre recorded.
    #[must_use]
    pub fn with_fibre(mut self, name: &str, station: f64, place: [f64; 2]) -> Flexible {
        self.fibres.push(Fibre { name: name.to_owned(), station, place });
        self
    }

    /// What is wrong with the numbers, if anything.
    pub(super) fn fault(&self) -> Option<PartFault> {
        if !self.velocity.iter().chain(&self.spin).all(|x| x.is_finite()) {
            return Some(PartFault::NotFinite("number"));
        }
        for (what, value) in [("damping", self.damping), ("viscosity", self.viscosity)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Some(PartFault::Negative { what, value, unit: "" });
            }
        }
        let nodes = self.beam.nodes();
        let (first, last) = (nodes.first()?, nodes.last()?);
        let stations = self.stations.iter().chain(self.fibres.iter().map(|fibre| &fibre.station));
        for station in stations {
            if !(first..=last).contains(&station) {
                return Some(PartFault::Station { station: *station, first: *first, last: *last });
            }
        }
        let mut names: Vec<&str> = self.fibres.iter().map(|fibre| fibre.name.as_str()).collect();
        names.sort_unstable();
        let twice = names.windows(2).find(|pair| pair[0] == pair[1])?;
        Some(PartFault::Fibres(twice[0].to_owned()))
    }

    /// Writes the velocities of a rigid motion: the velocity of the root and the angular velocity.
    pub(super) fn set_twist(&self, [velocity, spin]: Twist, q: &[f64], v: &mut [f64]) {
        let (origin, _) = self.beam.node(0, q);
        for node in 0..self.beam.nodes().len() {
            let (position, triad) = self.beam.node(node, q);
            let at = ELEMENT_VELOCITIES * node;
            let slope = triad.length * triad.tangent;
            let velocity = velocity + spin.cross(position - origin);
            velocity.put(v, at);
            spin.cross(slope).put(v, at + 3);
            v[at + 6] = spin.dot(triad.tangent);
            if let Some(element) = self.beam.elements().get(node) {
                v[at + 7] = spin.dot(element.section(&coordinates(q, node), 0.5).1.tangent);
            }
        }
    }

    /// The element of the arc length `s` and the place 0 … 1 in it.
    pub(super) fn place(&self, s: f64) -> (usize, f64) {
        let nodes = self.beam.nodes();
        let element = nodes.partition_point(|node| *node <= s).clamp(1, nodes.len() - 1) - 1;
        (element, (s - nodes[element]) / (nodes[element + 1] - nodes[element]))
    }

    /// The rotation of node `i` from one configuration to another.
    pub(super) fn rotation(&self, node: usize, before: &[f64], now: &[f64]) -> Mat3 {
        let [before, now] = [before, now].map(|q| self.beam.node(node, q).1);
        now.rotation() * before.rotation().transpose()
    }

    /// Position and axes at the arc length `s`.
    pub(super) fn frame(&self, q: &[f64], s: f64) -> Frame {
        let (position, triad) = self.section(q, s);
        Frame { position, rotation: triad.rotation() }
    }

    /// Position and axes at the arc length `s`.
    pub(super) fn section(&self, q: &[f64], s: f64) -> (Vec3, Triad) {
        let (element, z) = self.place(s);
        self.beam.elements()[element].section(&coordinates(q, element), z)
    }

    /// Velocity of the centreline at the arc length `s`.
    pub(super) fn velocity(&self, v: &[f64], s: f64) -> Vec3 {
        let (element, z) = self.place(s);
        let v = std::array::from_fn(|k| v[ELEMENT_VELOCITIES * element + k]);
        self.beam.elements()[element].velocity(&v, z)
    }

    /// Strains and stress resultants at the arc length `s`: the cubic through the quadrature points of the two elements next to it,
    /// where their errors are of higher order than elsewhere. The place is the arc length.
    pub(super) fn sample(&self, q: &[f64], s: f64) -> Sample {
        let ((element, z), nodes) = (self.place(s), self.beam.nodes());
        let first =
            if z < 0.5 { element.saturating_sub(1) } else { element }.min(nodes.len().saturating_sub(3));
        let mut values = [Sample::default(); 4];
        let mut count = 0;
        for (e, element) in self.beam.elements().iter().enumerate().skip(first).take(2) {
            for sample in element.samples(&coordinates(q, e)) {
                values[count] = Sample { place: nodes[e] + sample.place * element.length(), ..sample };
                count += 1;
            }
        }
        let mut out = Sample { place: s, ..Sample::default() };
        for (k, value) in values[..count].iter().enumerate() {
            let others = values[..count].iter().enumerate().filter(|(j, _)| *j != k);
            let part: f64 =
                others.map(|(_, other)| (s - other.place) / (value.place - other.place)).product();
            for i in 0..4 {
                out.strain[i] += part * value.strain[i];
                out.stress[i] += part * value.stress[i];
            }
            out.winding += part * value.winding;
        }
        out
    }

    /// The strain ε + z κ₂ − y κ₃ + ½ (y² + z²) (κ₁² − κ₁₀²) of a fibre.
    pub(super) fn fibre_strain(&self, q: &[f64], fibre: &Fibre) -> f64 {
        let (of, [y, z]) = (self.sample(q, fibre.station), fibre.place);
        let [axial, _, second, third] = of.strain;
        axial + z * second - y * third + (y * y + z * z) * of.winding
    }

    /// The ends of an element that is twisted by more than half a turn.
    pub(super) fn twisted(&self, q: &[f64]) -> Option<[f64; 2]> {
        let mut elements = self.beam.elements().iter().enumerate();
        let (number, _) = elements.find(|(e, element)| element.is_wound(&coordinates(q, *e)))?;
        Some([self.beam.nodes()[number], self.beam.nodes()[number + 1]])
    }

    /// The name of a station in the names of its columns.
    pub(super) fn station_name(&self, s: f64) -> String {
        if self.beam.nodes().last() == Some(&s) { "tip".to_owned() } else { format!("s={s}") }
    }
}

/// The coordinates of an element.
fn coordinates(q: &[f64], element: usize) -> [f64; COORDINATES] {
    std::array::from_fn(|k| q[ELEMENT_COORDINATES * element + k])
}

/// A force per length along a beam.
#[derive(Clone, Debug)]
pub struct LineLoad {
    /// Name, unique in its model.
    pub name: String,
    /// Number of the beam.
    pub beam: usize,
    /// Elements on which it acts; `None` for all.
    pub elements: Option<Range<usize>>,
    /// Factor f(s) of the force by the arc length s \[m\]; 1 where there is none.
    pub distribution: Option<Arc<dyn Profile>>,
    /// Force per length without stress [N/m].
    pub force: Vec3,
    /// What the components refer to: inertial axes, or the axes of each section.
    pub axes: Axes,
    /// Factor f(t); 1 where there is none.
    pub amplitude: Option<Arc<dyn Profile>>,
}

impl LineLoad {
    /// Its weights on its beam.
    pub(super) fn along(&self, beam: &Beam) -> LineDistribution {
        let count = beam.elements().len();
        let on = self.elements.clone().map_or(0..count, |on| on.start.min(count)..on.end.min(count));
        let weights = |element: usize| {
            let (start, end, h) =
                (beam.nodes()[element], beam.nodes()[element + 1], beam.elements()[element].length());
            let Some(f) = &self.distribution else { return uniform_weights(h) };
            let within = f.breaks().iter().copied().filter(|s| *s > start && *s < end);
            let cuts: Vec<f64> = [start].into_iter().chain(within).chain([end]).collect();
            distributed_weights(h, start, &cuts, |s| f.value(s))
        };
        LineDistribution { first: on.start, weights: on.map(weights).collect() }
    }

    /// The components at the time `t` when `part` of the loads acts.
    pub(super) fn at(&self, t: f64, part: f64) -> Vec3 {
        part * self.amplitude.as_ref().map_or(1.0, |f| f.value(t)) * self.force
    }

    pub(super) fn follows(&self) -> bool {
        self.axes == Axes::Follower
    }
}

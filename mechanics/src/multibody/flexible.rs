//! A beam as a part of a model.

use super::beam::Beam;
use super::error::PartFault;
use crate::linalg::Vec3;
use crate::system::Frame;

/// A beam as it stands at the start: without stress, and moving as a rigid body.
#[derive(Clone, Debug)]
pub struct Flexible {
    /// Name, unique in its model.
    pub name: String,
    /// Axis without stress, mesh and sections. The damping of a slender one is replaced.
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
    /// Whether the root sees the other side of its section, as of a blade whose height points to its trailing edge: along −n and −b.
    pub turned: bool,
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
    pub fn new(name: &str, beam: impl Into<Beam>) -> Flexible {
        let beam = beam.into();
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
            turned: false,
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
        let length = last - first;
        for fibre in &self.fibres {
            let distance = libm::hypot(fibre.place[0], fibre.place[1]);
            if !(distance <= length) {
                return Some(PartFault::Fibre { name: fibre.name.clone(), distance, length });
            }
        }
        let mut names: Vec<&str> = self.fibres.iter().map(|fibre| fibre.name.as_str()).collect();
        names.sort_unstable();
        let twice = names.windows(2).find(|pair| pair[0] == pair[1])?;
        Some(PartFault::Fibres(twice[0].to_owned()))
    }

    /// Position and axes at the arc length `s`.
    pub(super) fn frame(&self, q: &[f64], s: f64) -> Frame {
        self.beam.frame(q, s)
    }

    /// The strain ε + z κ₂ − y κ₃ + ½ (y² + z²) (κ₁² − κ₁₀²) of a fibre.
    pub(super) fn fibre_strain(&self, q: &[f64], fibre: &Fibre) -> f64 {
        let (of, [y, z]) = (self.beam.sample(q, fibre.station), fibre.place);
        let [axial, _, _, _, second, third] = of.strain;
        axial + z * second - y * third + (y * y + z * z) * of.winding
    }

    /// The name of a station in the names of its columns.
    pub(super) fn station_name(&self, s: f64) -> String {
        if self.beam.nodes().last() == Some(&s) { "tip".to_owned() } else { format!("s={s}") }
    }
}

//! Axial force, bending moment, shear force and strains at stations, recovered to the order of the displacements.
//!
//! ```text
//! N = EA ε − ES κ,   M = EI κ − ES ε,   Q = −dM/dx;      ε(y) = ε − y κ
//! ```
//!
//! ε and κ are derivatives of the displacements, and in an element they are less accurate than these by one and two
//! orders, but not everywhere: the second derivative of cubic elements is better by an order at the two Gauss points
//! of each, where the first polynomial that it cannot represent vanishes, and so is the first derivative of elements of
//! degree p at their p Gauss points (Barlow 1976, doi 10.1002/nme.1620100202). N and M are taken there, and the cubic
//! through the four points next to the station gives their values and −Q. The strain of the exact coupling is taken at
//! nodes and midpoints, where its energy samples it. N and M go on where a section jumps; ε and κ at the
//! station follow from them by the section there. Measured for the cantilever: M of order 4, Q of order 3. A station
//! next to a point load, where Q jumps, has the order of κ. Other bases are smooth, and the cubic is laid through
//! their values close around the station, within a hundredth of the length.
//!
//! Q leaves out the rotary inertia of the section; ε(y) is the strain of the fibre at height y of a section that stays plane.

use super::coupling::Coupling;
use super::fields::{Fields, Point};
use crate::quadrature::Gauss;
use crate::section::{Resultants, Section};
use crate::system::{Channel, State};

/// Points through which a polynomial is laid.
const POINTS: usize = 4;

/// Half width, over the length, of the window in which smooth functions are looked at.
const WINDOW: f64 = 0.005;

/// Where the strains of a basis are at their best.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Close around the station.
    Station,
    /// In elements: the stretch at this many Gauss points of each, the curvature at two.
    Elements(usize),
    /// In elements: the stretch at nodes and midpoints, the curvature at two Gauss points.
    Curve,
}

/// Section forces at the stations of a system.
#[derive(Debug, Default)]
pub struct SectionForces {
    stations: Vec<Forces>,
    heights: Vec<f64>,
    /// Whether the forces themselves are recorded, and not only strains.
    forces: bool,
}

/// Forces at one station.
#[derive(Debug)]
struct Forces {
    name: String,
    axial: Vec<Sample>,
    bending: Vec<Sample>,
    section: Resultants,
}

/// A place where strains are taken, with its weights in the value and in the derivative at the station.
#[derive(Debug)]
struct Sample {
    point: Point,
    section: Resultants,
    value: f64,
    slope: f64,
}

impl SectionForces {
    /// Those of the stations `places` (name and x \[m\]) of a beam with elements between the cells of its transverse
    /// basis; `heights` \[m\] are those at which strains are recorded.
    pub fn new(
        fields: &Fields,
        section: &dyn Section,
        sampling: Sampling,
        places: &[(String, f64)],
        forces: bool,
        heights: &[f64],
    ) -> SectionForces {
        let nodes = fields.transverse().cells();
        let gauss = |count: usize| -> Vec<f64> {
            let rule = Gauss::new(count);
            nodes.windows(2).flat_map(|e| rule.on(e[0], e[1]).map(|(x, _)| x).collect::<Vec<_>>()).collect()
        };
        let middles = || nodes.windows(2).map(|e| 0.5 * (e[0] + e[1]));
        let (axial, bending) = match sampling {
            Sampling::Station => (Vec::new(), Vec::new()),
            Sampling::Elements(count) => (gauss(count), gauss(2)),
            Sampling::Curve => {
                let mut all: Vec<f64> = nodes.iter().copied().chain(middles()).collect();
                all.sort_by(f64::total_cmp);
                (all, gauss(2))
            }
        };
        let sample = |among: &[f64], x: f64| -> Vec<Sample> {
            let chosen = nearest(among, x);
            let at = if chosen.is_empty() { around(x, fields.length()) } else { chosen };
            let weights = at.iter().enumerate().map(|(i, _)| lagrange(&at, i, x));
            at.iter()
                .zip(weights)
                .map(|(&at, (value, slope))| Sample {
                    point: fields.point(at, 0.0),
                    section: section.resultants(at),
                    value,
                    slope,
                })
                .collect()
        };
        let stations = places
            .iter()
            .map(|(name, x)| Forces {
                name: name.clone(),
                axial: sample(&axial, *x),
                bending: sample(&bending, *x),
                section: section.resultants(*x),
            })
            .collect();
        SectionForces { stations, heights: heights.to_vec(), forces }
    }

    /// Number of values recorded.
    pub fn len(&self) -> usize {
        let forces = if self.forces { 3 } else { 0 };
        self.stations.len() * (forces + self.heights.len())
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The recorded quantities, in the order of [`SectionForces::record`].
    pub fn channels(&self) -> Vec<Channel> {
        let mut channels = Vec::new();
        for station in &self.stations {
            let name = &station.name;
            let mut add = |column: String, unit: &'static str, meaning: &str| {
                channels.push(Channel { name: column, unit, meaning: format!("{meaning} at {name}") });
            };
            if self.forces {
                add(format!("{name}.axial_force"), "N", "axial force N");
                add(format!("{name}.shear_force"), "N", "shear force Q = −dM/dx");
                add(format!("{name}.bending_moment"), "N*m", "bending moment M");
            }
            for y in &self.heights {
                add(format!("{name}.strain_y={y}"), "", &format!("strain of the fibre at the height {y} m"));
            }
        }
        channels
    }

    /// Writes one value for each channel.
    pub fn record(&self, coupling: &impl Coupling, s: &State, out: &mut [f64]) {
        let mut out = out.iter_mut();
        let mut put = |x: f64| {
            if let Some(out) = out.next() {
                *out = x;
            }
        };
        for station in &self.stations {
            let axial = station.axial.iter().map(|p| p.value * p.forces(coupling, s).0).sum();
            let (mut moment, mut slope) = (0.0, 0.0);
            for p in &station.bending {
                let m = p.forces(coupling, s).1;
                moment += p.value * m;
                slope += p.slope * m;
            }
            if self.forces {
                [axial, -slope, moment].into_iter().for_each(&mut put);
            }
            let r = &station.section;
            let (ea, es, ei) = (r.axial_stiffness, r.coupling_stiffness, r.bending_stiffness);
            let determinant = ea * ei - es * es;
            let stretch = (ei * axial + es * moment) / determinant;
            let curvature = (es * axial + ea * moment) / determinant;
            self.heights.iter().for_each(|y| put(stretch - y * curvature));
        }
    }
}

impl Sample {
    /// N and M.
    fn forces(&self, coupling: &impl Coupling, s: &State) -> (f64, f64) {
        let (stretch, curvature) = coupling.strains(s, &self.point);
        let r = &self.section;
        (
            r.axial_stiffness * stretch - r.coupling_stiffness * curvature,
            r.bending_stiffness * curvature - r.coupling_stiffness * stretch,
        )
    }
}

/// Points close around `x`, for smooth functions: the cubic through them is theirs.
fn around(x: f64, length: f64) -> Vec<f64> {
    let reach = WINDOW * length;
    let first = (x - reach).clamp(0.0, length - 2.0 * reach);
    Gauss::new(POINTS).on(first, first + 2.0 * reach).map(|(x, _)| x).collect()
}

/// The points of an ascending list that are next to `x`: as many on either side as there are.
fn nearest(among: &[f64], x: f64) -> Vec<f64> {
    let after = among.partition_point(|at| *at < x);
    let first = after.saturating_sub(POINTS / 2).min(among.len().saturating_sub(POINTS));
    among[first..among.len().min(first + POINTS)].to_vec()
}

/// Value and derivative at `x` of the Lagrange polynomial of point `i`.
fn lagrange(at: &[f64], i: usize, x: f64) -> (f64, f64) {
    let others = || at.iter().enumerate().filter(move |(j, _)| *j != i);
    let value = others().map(|(_, xj)| (x - xj) / (at[i] - xj)).product();
    let slope = others()
        .map(|(k, xk)| {
            let rest = others().filter(|(j, _)| *j != k);
            rest.map(|(_, xj)| (x - xj) / (at[i] - xj)).product::<f64>() / (at[i] - xk)
        })
        .sum();
    (value, slope)
}

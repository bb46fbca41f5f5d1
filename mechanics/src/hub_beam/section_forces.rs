//! Axial force, bending moment, shear force and strains at stations, recovered to the order of the displacements.
//!
//! ```text
//! N = EA ε − ES κ,   M = EI κ − ES ε,   Q = −dM/dx;      ε(y) = ε − y κ
//! ```
//!
//! ε and κ are derivatives of the displacements and less accurate than these by one and two orders at most places of an
//! element. Equilibrium, tested with w₂″ and w₁′ of the shape functions, gives moments of M and N in each element e: with
//! cubic transverse functions and axial ones of degree p,
//!
//! ```text
//! ∫ₑ (EI κ − ES ε) xᵏ dx = ∫ₑ M xᵏ dx,  k = 0, 1;      ∫ₑ (EA ε − ES κ) xᵏ dx = ∫ₑ N xᵏ dx,  k = 0 … p − 1
//! ```
//!
//! The recovered M̃ is the cubic with these moments in the two elements next to the station, Q̃ its slope, and the strains
//! there follow from the stiffness of the section:
//!
//! ```text
//! M̃ − M = O(h⁴),   Q̃ = −dM̃/dx = Q + O(h³);      ⎡ EA  −ES⎤ ⎡ε⎤   ⎡N⎤
//!                                                  ⎣−ES   EI⎦ ⎣κ⎦ = ⎣M⎦
//! ```
//!
//! For the exact coupling ε is the cubic through four of the samples of ε at nodes and midpoints. No
//! element beyond a node at which a load or a mass is, or the section jumps, is used: there Q or N jumps. Other bases are smooth: the cubic passes through their values within a
//! hundredth of the length around the station.
//!
//! Q leaves out the rotary inertia of the section; ε(y) is the strain of the fibre at height y of a section that stays plane.

use super::beam::Beam;
use super::coupling::Coupling;
use super::fields::{Fields, Point};
use crate::linalg::{Matrix, Structure};
use crate::quadrature::Gauss;
use crate::section::Resultants;
use crate::system::{Channel, Role, Sink, State};

/// Coefficients of the polynomials, and Gauss points of an element.
const POINTS: usize = 4;

/// Half width, over the length, of the window in which smooth functions are sampled.
const WINDOW: f64 = 0.005;

/// Where the strains of a basis are most accurate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// Close around the station.
    Station,
    /// In elements, by moments: this many of N in each, two of M.
    Elements(usize),
    /// In elements: the axial strain at nodes and midpoints, two moments of M.
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

/// A point where strains are sampled, with its weights in the value and in the derivative at the station.
#[derive(Debug)]
struct Sample {
    point: Point,
    section: Resultants,
    value: f64,
    slope: f64,
}

impl SectionForces {
    /// Those of the stations `at` (name and x \[m\]) of a beam with elements between the cells of its transverse
    /// basis; `heights` \[m\] are those at which strains are recorded.
    pub fn new(
        fields: &Fields,
        beam: &Beam<'_>,
        sampling: Sampling,
        at: &[(String, f64)],
        forces: bool,
        heights: &[f64],
    ) -> SectionForces {
        let section = beam.section;
        let nodes = fields.transverse().cells();
        let inside = |x: f64| smooth(nodes, &beam.breaks, x);
        let sample = |at: Vec<(f64, f64, f64)>| -> Vec<Sample> {
            let make = |(x, value, slope)| {
                let point = fields.point(x, 0.0);
                Sample { point, section: section.resultants(x), value, slope }
            };
            at.into_iter().map(make).collect()
        };
        let around = |x: f64| through(&around(x, fields.length()), x);
        let halves = |nodes: &[f64]| -> Vec<f64> {
            let middles = nodes.windows(2).map(|e| 0.5 * (e[0] + e[1]));
            let mut all: Vec<f64> = nodes.iter().copied().chain(middles).collect();
            all.sort_by(f64::total_cmp);
            all
        };
        let axial = |x: f64| match sampling {
            Sampling::Station => around(x),
            Sampling::Elements(count) => by_moments(inside(x), count, x),
            Sampling::Curve => through(&nearest(&halves(inside(x)), x), x),
        };
        let bending = |x: f64| match sampling {
            Sampling::Station => around(x),
            Sampling::Elements(_) | Sampling::Curve => by_moments(inside(x), 2, x),
        };
        let stations = at
            .iter()
            .map(|(name, x)| Forces {
                name: name.clone(),
                axial: sample(axial(*x)),
                bending: sample(bending(*x)),
                section: section.resultants(*x),
            })
            .collect();
        SectionForces { stations, heights: heights.to_vec(), forces }
    }

    /// Records forces and strains at a state.
    pub(super) fn observe(&self, coupling: &impl Coupling, s: &State, sink: &mut Sink<'_>) {
        for station in &self.stations {
            let axial = station.axial.iter().map(|p| p.value * p.forces(coupling, s).0).sum();
            let (mut moment, mut slope) = (0.0, 0.0);
            for p in &station.bending {
                let m = p.forces(coupling, s).1;
                moment += p.value * m;
                slope += p.slope * m;
            }
            let name = &station.name;
            let role = if name == "tip" { Role::Secondary } else { Role::Detail };
            if self.forces {
                let mut put = |value, quantity, unit: &'static str, meaning| {
                    let channel = || {
                        Channel::new(role, format!("{name}.{quantity}"), unit, format!("{meaning} at {name}"))
                    };
                    sink.put(value, channel);
                };
                put(axial, "axial_force", "N", "axial force N");
                put(-slope, "shear_force", "N", "shear force Q = −dM/dx");
                put(moment, "bending_moment", "N*m", "bending moment M");
            }
            let r = &station.section;
            let (ea, es, ei) = (r.axial_stiffness, r.coupling_stiffness, r.bending_stiffness);
            let determinant = ea * ei - es * es;
            let strain = (ei * axial + es * moment) / determinant;
            let curvature = (es * axial + ea * moment) / determinant;
            for y in &self.heights {
                sink.put(strain - y * curvature, || {
                    let meaning = format!("strain of the fibre at the height {y} m at {name}");
                    Channel::new(role, format!("{name}.strain_y={y}"), "", meaning)
                });
            }
        }
    }
}

impl Sample {
    /// N and M.
    fn forces(&self, coupling: &impl Coupling, s: &State) -> (f64, f64) {
        let (strain, curvature) = coupling.strains(s, &self.point);
        let r = &self.section;
        (
            r.axial_stiffness * strain - r.coupling_stiffness * curvature,
            r.bending_stiffness * curvature - r.coupling_stiffness * strain,
        )
    }
}

/// The nodes of the elements around `x` between which nothing jumps: from one break at a node to the next, behind a break at
/// x itself.
fn smooth<'n>(nodes: &'n [f64], breaks: &[f64], x: f64) -> &'n [f64] {
    let last = nodes.len() - 1;
    let near = 1e-9 * nodes[last];
    let (mut from, mut to) = (0, last);
    for (i, node) in nodes.iter().enumerate().take(last).skip(1) {
        if breaks.iter().any(|at| (at - node).abs() <= near) {
            if *node <= x + near {
                from = i;
            } else {
                to = to.min(i);
            }
        }
    }
    &nodes[from..=to]
}

/// Points close around `x`, for smooth functions: the cubic through them is theirs.
fn around(x: f64, length: f64) -> Vec<f64> {
    let half = WINDOW * length;
    let first = (x - half).clamp(0.0, length - 2.0 * half);
    Gauss::new(POINTS).on(first, first + 2.0 * half).map(|(x, _)| x).collect()
}

/// The points of an ascending list that are next to `x`: as many on either side as there are.
fn nearest(among: &[f64], x: f64) -> Vec<f64> {
    let after = among.partition_point(|at| *at < x);
    let first = after.saturating_sub(POINTS / 2).min(among.len().saturating_sub(POINTS));
    among[first..among.len().min(first + POINTS)].to_vec()
}

/// Points, with their weights in value and slope at `x` of the polynomial through them.
fn through(at: &[f64], x: f64) -> Vec<(f64, f64, f64)> {
    at.iter()
        .enumerate()
        .map(|(i, point)| {
            let (value, slope) = lagrange(at, i, x);
            (*point, value, slope)
        })
        .collect()
}

/// Gauss points of the elements next to `x`, with their weights in value and slope at `x` of the cubic whose first `count`
/// moments in each element are those of the function.
///
/// With ξ = (y − x)/H, P = Σ c_k ξᵏ and Legendre's polynomials ℓ_m of an element e the conditions are
/// Σ_k c_k ∫_e ξᵏ ℓ_m = Σ_g w_g ℓ_m(g) f(g): A c = B f. The weights of P(x) = c₀ are Bᵀ A⁻ᵀ e₀, those of P′(x) = c₁/H likewise.
fn by_moments(nodes: &[f64], count: usize, x: f64) -> Vec<(f64, f64, f64)> {
    let elements = nodes.len() - 1;
    let wanted = POINTS.div_ceil(count).min(elements);
    let node = (0..nodes.len()).min_by(|a, b| (nodes[*a] - x).abs().total_cmp(&(nodes[*b] - x).abs()));
    let first = node.unwrap_or(0).saturating_sub(wanted / 2).min(elements - wanted);
    let patch = &nodes[first..=first + wanted];
    let size = patch[wanted] - patch[0];
    let order = wanted * count;
    let gauss = Gauss::new(POINTS);
    let legendre = |m: usize, s: f64| [1.0, s, 1.5 * s * s - 0.5, 2.5 * s * s * s - 1.5 * s][m.min(3)];
    let mut transposed = Matrix::new(&Structure::dense(order));
    let mut tests = Vec::new();
    for (e, ends) in patch.windows(2).enumerate() {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        for (y, w) in gauss.on(ends[0], ends[1]) {
            let test: Vec<f64> = (0..count).map(|m| w / half * legendre(m, (y - middle) / half)).collect();
            for (m, test) in test.iter().enumerate() {
                for k in 0..order {
                    transposed.add(k, e * count + m, test * ((y - x) / size).powi(k as i32));
                }
            }
            tests.push((y, e, test));
        }
    }
    let (mut value, mut slope) = (vec![0.0; order], vec![0.0; order]);
    value[0] = 1.0;
    if let Some(slope) = slope.get_mut(1) {
        *slope = 1.0 / size;
    }
    if transposed.factor().is_err() {
        // Not for ascending nodes.
        return through(&[x], x);
    }
    transposed.solve(&mut value);
    transposed.solve(&mut slope);
    let weight = |solved: &[f64], e: usize, test: &[f64]| -> f64 {
        test.iter().enumerate().map(|(m, test)| test * solved[e * count + m]).sum()
    };
    tests.iter().map(|(y, e, test)| (*y, weight(&value, *e, test), weight(&slope, *e, test))).collect()
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

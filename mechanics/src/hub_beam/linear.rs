//! Couplings `zeroth` and `first`: small deflections, equations linear in the unknowns.
//!
//! `zeroth` (traditional hybrid coordinates) adds the small displacements w₁, w₂ to a rigidly rotating
//! beam. `first` also keeps, to first order, the shortening w_c = −½ ∫₀ˣ w₂′² dξ of the axis by
//! bending, whose product with the centrifugal force is the stiffening Ω² C that the zeroth-order model
//! lacks (Kane, Ryan & Banerjee 1987, doi 10.2514/3.20195; P1 equations 45–50). Without it the chordwise
//! stiffness K − ω² M is exhausted when ω reaches the first natural frequency: dynamic softening.

use super::beam::Beam;
use super::coupling::Coupling;
use super::damping::Damping;
use super::fields::Fields;
use super::hub::Hub;
use super::inertia::{Foreshortening, Inertia};
use super::load::Kinematics;
use super::station::{Placement, Station};
use crate::basis::Role;
use crate::linalg::{Matrix, negative_pivots};
use crate::system::{Limit, State};
use std::sync::Arc;

/// Deflection over length beyond which dropping higher-order terms is no longer harmless.
const SMALL: f64 = 0.1;

/// Rounding error of the deflection, over the deflection, that is worth a caution.
const ROUNDING: f64 = 1e-6;

/// Axial displacement over length beyond which a beam is not linear-elastic.
const LARGEST_EXTENSION: f64 = 0.5;

/// A beam whose equations are linear in the unknowns. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct LinearCoupling {
    name: &'static str,
    foreshortening: Foreshortening,
    fields: Arc<Fields>,
    inertia: Arc<Inertia>,
    /// Slopes at the quadrature points of each cell, for the foreshortening of a deflected beam.
    slopes: Arc<[SlopePoint]>,
    /// Stiffness at the quadrature points.
    stiffnesses: Arc<[StiffnessPoint]>,
    /// Unknowns that are displacements, and what they may not exceed \[m\].
    bounds: Arc<[(usize, f64)]>,
}

/// The slope w₂′ at a quadrature point, as weights of a few consecutive unknowns.
#[derive(Debug)]
struct SlopePoint {
    x: f64,
    weight: f64,
    index: Vec<usize>,
    slope: Vec<f64>,
}

/// ½∫ (EA w₁′² − 2 ES w₁′w₂″ + EI w₂″²) dx at a quadrature point as the sum of two squares,
/// ½ axial (w₁′ − offset w₂″)² + ½ bending w₂″².
#[derive(Clone, Copy, Debug)]
struct StiffnessPoint {
    /// EA times the weight.
    axial: f64,
    /// ES/EA
    offset: f64,
    /// EI − ES²/EA times the weight.
    bending: f64,
}

impl LinearCoupling {
    /// The coupling over `fields`, on a hub.
    pub fn new<'a>(
        fields: Fields,
        beam: impl Into<Beam<'a>>,
        hub: &Hub,
        foreshortening: Foreshortening,
    ) -> LinearCoupling {
        let beam = beam.into();
        let inertia = Inertia::new(&fields, &beam, hub, foreshortening);
        let mut slopes = Vec::new();
        if foreshortening == Foreshortening::First {
            fields.integrate(|p| {
                slopes.push(SlopePoint {
                    x: p.x,
                    weight: p.weight,
                    index: p.transverse.index.clone(),
                    slope: p.transverse.value[1].clone(),
                });
            });
        }
        let mut stiffnesses = Vec::new();
        fields.integrate(|p| {
            let r = beam.section.resultants(p.x);
            let offset = r.coupling_stiffness / r.axial_stiffness;
            stiffnesses.push(StiffnessPoint {
                axial: p.weight * r.axial_stiffness,
                offset,
                bending: p.weight * (r.bending_stiffness - offset * r.coupling_stiffness),
            });
        });
        let (axial, transverse) = fields.indices();
        let length = fields.length();
        let mut bounds = Vec::new();
        for (basis, index, bound) in
            [(fields.transverse(), transverse, length), (fields.axial(), axial, LARGEST_EXTENSION * length)]
        {
            let values = index.iter().enumerate().filter(|(i, _)| basis.role(*i) != Role::Slope);
            bounds.extend(values.map(|(_, &number)| (number, bound)));
        }
        let name = match foreshortening {
            Foreshortening::None => "zeroth",
            Foreshortening::First => "first",
        };
        LinearCoupling {
            name,
            foreshortening,
            fields: Arc::new(fields),
            inertia: Arc::new(inertia),
            slopes: slopes.into(),
            stiffnesses: stiffnesses.into(),
            bounds: bounds.into(),
        }
    }

    /// The coupling as the linear part of another one, by whose name its messages call it.
    pub(super) fn named(self, name: &'static str) -> LinearCoupling {
        LinearCoupling { name, ..self }
    }

    /// Rounding error of the deflection, over the deflection: the terms of K for elements of length h cancel in rigid motions to
    /// ε EI/h³ only, which holds the beam like springs from outside.
    ///
    /// ```text
    /// ε Σ (L/h)³ EI · (1/L) Σ h/EI,     n⁴ε for n equal elements
    /// ```
    ///
    /// Measured: 0.6 of this with 640 equal elements, 0.9 with 1280, 0.6 with 2560.
    fn rounding(&self) -> f64 {
        let length = self.fields.length();
        let cells = self.fields.cells().windows(2).map(|ends| ends[1] - ends[0]);
        let points = self.stiffnesses.chunks(self.fields.gauss().len());
        let (mut springs, mut flexibility) = (0.0, 0.0);
        for (h, points) in cells.zip(points) {
            let stiffness = points.iter().map(|p| p.bending).sum::<f64>() / h;
            springs += (length / h).powi(3) * stiffness;
            flexibility += h / stiffness;
        }
        f64::EPSILON * springs * flexibility / length
    }

    /// Whether K − ω² D is positive definite.
    fn is_stable(&self, speed: f64) -> bool {
        let (_, centrifugal, stiffness) = self.inertia.matrices();
        negative_pivots(stiffness, centrifugal, -speed * speed) == 0
    }
}

impl Coupling for LinearCoupling {
    fn name(&self) -> &'static str {
        self.name
    }

    fn fields(&self) -> &Fields {
        &self.fields
    }

    fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    fn is_affine(&self) -> bool {
        true
    }

    fn strain_forms(&mut self, _s: &State, vectors: &[Vec<f64>], out: &mut [f64]) {
        let mut stiffnesses = self.stiffnesses.iter();
        self.fields.integrate(|p| {
            let Some(stiffness) = stiffnesses.next() else { return };
            for (x, out) in vectors.iter().zip(&mut *out) {
                let curvature = p.transverse.field(2, x);
                let strain = p.axial.field(1, x) - stiffness.offset * curvature;
                *out += stiffness.axial * strain * strain + stiffness.bending * curvature * curvature;
            }
        });
    }

    fn strain(&mut self, s: &State) -> f64 {
        self.inertia.strain(&s.q)
    }

    fn kinematics(&self) -> Kinematics {
        match self.foreshortening {
            Foreshortening::None => Kinematics::Straight,
            Foreshortening::First => Kinematics::Foreshortened,
        }
    }

    fn damp(&mut self, damping: Damping) {
        Arc::make_mut(&mut self.inertia).damp(damping);
    }

    fn placements(&self, s: &State, stations: &[Station], out: &mut [Placement]) {
        let cells = self.fields.cells();
        let points = self.fields.gauss().len();
        // Running sums of ∫ w₂′² and ∫ w₂′ẇ₂′ up to the start of cell `cell`.
        let (mut square, mut product, mut cell) = (0.0, 0.0, 0);
        for (station, out) in stations.iter().zip(out) {
            let [w1, w2, _, slope, w1_rate, w2_rate, _, slope_rate] = station.fields(s);
            let (mut shortening, mut shortening_rate) = (0.0, 0.0);
            if self.foreshortening == Foreshortening::First {
                while cell + 1 < cells.len() && cells[cell + 1] <= station.point.x {
                    for p in &self.slopes[cell * points..(cell + 1) * points] {
                        debug_assert!(p.x < cells[cell + 1]);
                        let (mut slope, mut rate) = (0.0, 0.0);
                        for (&i, n) in p.index.iter().zip(&p.slope) {
                            slope += n * s.q[i];
                            rate += n * s.v[i];
                        }
                        square += p.weight * slope * slope;
                        product += p.weight * slope * rate;
                    }
                    cell += 1;
                }
                let mut rest = (0.0, 0.0);
                for p in station.rest.iter() {
                    let (slope, rate) = (p.transverse.field(1, &s.q), p.transverse.field(1, &s.v));
                    rest.0 += p.weight * slope * slope;
                    rest.1 += p.weight * slope * rate;
                }
                shortening = -0.5 * (square + rest.0);
                shortening_rate = -(product + rest.1);
            }
            *out = Placement {
                axial: w1 + shortening,
                deflection: w2,
                rotation: slope,
                axial_velocity: w1_rate + shortening_rate,
                deflection_velocity: w2_rate,
                rotation_velocity: slope_rate,
            };
        }
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        let length = self.fields.length();
        // Cheap and basis-free: no coefficient that is a displacement may exceed its bound.
        let beyond = |&(number, bound): &(usize, f64)| !(s.q[number].abs() <= bound);
        let Some(&(number, bound)) = self.bounds.iter().find(|bound| beyond(bound)) else { return Ok(()) };
        let (axial, transverse) = self.fields.indices();
        let (field, station) = match transverse.iter().position(|&i| i == number) {
            Some(i) => ("deflection", self.fields.transverse().anchor(i)),
            None => {
                let i = axial.iter().position(|&i| i == number).unwrap_or(0);
                ("axial displacement", self.fields.axial().anchor(i))
            }
        };
        let (size, coupling) = (s.q[number], self.name());
        Err(Limit::Displacement { field, size, station, bound, length, coupling })
    }

    fn has_positive_kinetic_energy(&self) -> bool {
        self.foreshortening == Foreshortening::None
    }

    fn cautions(&self, deflection: f64) -> Vec<String> {
        let ratio = deflection.abs() / self.fields.length();
        let large = (ratio > SMALL).then(|| {
            format!(
                "the tip deflects by {:.0} % of the length; the {}-order coupling is meant for less than {:.0} %: \
                 compare with the exact coupling",
                100.0 * ratio,
                self.name(),
                100.0 * SMALL
            )
        });
        let rounding = self.rounding();
        let fine = (rounding > ROUNDING).then(|| {
            let lengths = self.fields.cells().windows(2).map(|ends| ends[1] - ends[0]);
            let (elements, shortest) = (lengths.len(), lengths.fold(f64::INFINITY, f64::min));
            format!(
                "with {elements} elements, the shortest {shortest:.1e} m long, rounding of the assembled stiffness is up to {rounding:.1e} of \
                 the deflection (frequencies are not affected): use fewer elements, or the exact coupling"
            )
        });
        large.into_iter().chain(fine).collect()
    }

    fn critical_speed(&self, speed: f64) -> Option<f64> {
        if self.is_stable(speed) {
            return None;
        }
        let (mut low, mut high) = (0.0, speed);
        while high - low > 1e-9 * speed {
            let middle = 0.5 * (low + high);
            if self.is_stable(middle) { low = middle } else { high = middle }
        }
        Some(high)
    }
}

/// The matrices of a coupling.
impl LinearCoupling {
    /// M, D and K of the fields; see [`Inertia`].
    pub fn matrices(&self) -> (&Matrix, &Matrix, &Matrix) {
        self.inertia.matrices()
    }
}

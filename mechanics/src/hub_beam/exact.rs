//! Coupling `exact`: the axis as a planar curve p(x) = (X, Y) in the hub's frame, any size of rotation.
//!
//! Both components are C¹ cubic Hermite fields, and nothing is neglected but shear:
//!
//! ```text
//! ε = |p′| − 1,   κ = (X′Y″ − Y′X″)/|p′|²,   U = ½ ∫ EA ε̄² − 2 ES ε̄ κ + EI κ² dx
//! ```
//!
//! κ = dφ/dx with φ the angle of the tangent. The inertia ½∫ρA |ṗ + ω Jp|² is quadratic in the unknowns and
//! is [`Inertia`]; only the strain energy, and the rotary inertia where it is kept, are not quadratic.
//!
//! **No membrane locking.** A cubic curve cannot bend without axial strain at every point, and its energy EA ε² grows with
//! EA/EI·h². So ε is sampled at the two nodes and the middle of each element and
//! ε̄ is its quadratic interpolant, which leaves two constraints an element to four new unknowns (Meier, Popp
//! & Wall 2015, doi 10.1016/j.cma.2015.02.029). A straight element keeps its exact energy: no hourglass.
//!
//! Rotary inertia ρI and first mass moment ρS, with t, n the unit tangent and normal, Ω = ω + φ̇ the absolute
//! rotation rate of the section and A = p̈ + 2ωJṗ + ω̇Jp − ω²p the absolute acceleration of the axis:
//!
//! ```text
//! δW = ∫ ρI Ω̇ δφ + ρS [ −(Ω̇ t + Ω² n)·δp − (t·A) δφ ] dx,    δφ = n·δp′/|p′|,   φ̇ = n·ṗ′/|p′|,
//! φ̈ = (n·p̈′ − 2 φ̇ t·ṗ′)/|p′|
//! ```

use super::beam::{Beam, Mass};
use super::coupling::Coupling;
use super::damping::Damping;
use super::element::Element;
use super::fields::{Fields, Point};
use super::hub::Hub;
use super::inertia::{Border, Foreshortening, Inertia, Totals};
use super::load::Kinematics;
use super::lumped::LumpedRotation;
use super::rule::Rule;
use super::station::{Placement, Station};
use crate::basis::{BasisError, Field, Hermite, mesh};
use crate::linalg::Storage;
use crate::profile::HubKinematics;
use crate::section::{Resultants, Section};
use crate::system::{Corotation, Limit, State, Weights};
use std::sync::Arc;

/// Largest axial strain |ε| accepted for a linear-elastic beam.
const LARGEST_STRAIN: f64 = 0.5;
const LEAST_STRETCH: f64 = 1.0 - LARGEST_STRAIN;
const MOST_STRETCH: f64 = 1.0 + LARGEST_STRAIN;
/// Relative difference of lengths that are the same to rounding.
const SAME_LENGTH: f64 = 1e-12;

/// Geometrically exact planar beam. Its formulas head the source file.
#[derive(Clone, Debug)]
pub struct ExactCoupling {
    fields: Arc<Fields>,
    inertia: Arc<Inertia>,
    elements: Arc<[Element]>,
    /// Rules of elements of different lengths, and which of them each element has.
    rules: Arc<[Rule]>,
    rule_of: Arc<[usize]>,
    radius: f64,
    lumped: Arc<[LumpedRotation]>,
    /// Damping in proportion to the stiffness, η \[s\].
    viscosity: f64,
}

/// A section reduced to its mass: what is quadratic for this coupling.
#[derive(Debug)]
struct MassOnly<'a>(&'a dyn Section);

impl Section for MassOnly<'_> {
    fn resultants(&self, x: f64) -> Resultants {
        Resultants { mass: self.0.resultants(x).mass, ..Resultants::default() }
    }
}

impl ExactCoupling {
    /// A beam of `elements` equal Hermite elements on a hub.
    ///
    /// # Errors
    /// [`BasisError`] if length or number of elements make no mesh.
    pub fn new<'a>(
        length: f64,
        elements: usize,
        beam: impl Into<Beam<'a>>,
        hub: &Hub,
    ) -> Result<ExactCoupling, BasisError> {
        ExactCoupling::on(mesh(length, elements, &[])?, beam, hub)
    }

    /// A beam of Hermite elements between the given ascending boundaries, the first of which is 0 \[m\].
    ///
    /// # Errors
    /// [`BasisError`] if the boundaries make no mesh.
    pub fn on<'a>(
        nodes: Vec<f64>,
        beam: impl Into<Beam<'a>>,
        hub: &Hub,
    ) -> Result<ExactCoupling, BasisError> {
        let Beam { section, masses, breaks } = beam.into();
        let field = |field| Hermite::on(nodes.clone(), field).map(Box::new);
        let length = nodes.last().copied().unwrap_or_default();
        let fields = Fields::new(length, field(Field::Axial)?, field(Field::Transverse)?, &breaks);
        let lumped = LumpedRotation::of(&fields, &masses, hub.radius).into();
        let points = masses.into_iter().map(|m| Mass { inertia: 0.0, ..m }).collect();
        let quadratic = Beam { section: &MassOnly(section), masses: points, breaks };
        let inertia = Inertia::new(&fields, &quadratic, hub, Foreshortening::None);
        let mut rules: Vec<Rule> = Vec::new();
        let rule_of = nodes.windows(2).map(|ends| {
            let length = ends[1] - ends[0];
            let same = |rule: &Rule| (rule.length - length).abs() <= SAME_LENGTH * length;
            rules.iter().position(same).unwrap_or_else(|| {
                rules.push(Rule::new(length));
                rules.len() - 1
            })
        });
        let rule_of = rule_of.collect();
        let elements = (0..nodes.len() - 1).map(|e| Element::new(&fields, section, &nodes, e)).collect();
        let (radius, fields, inertia) = (hub.radius, Arc::new(fields), Arc::new(inertia));
        let rules = rules.into();
        Ok(ExactCoupling { fields, inertia, elements, rules, rule_of, radius, lumped, viscosity: 0.0 })
    }

    /// The elements with their rules.
    fn each(&self) -> impl Iterator<Item = (&Element, &Rule)> {
        self.elements.iter().zip(self.rule_of.iter().map(|rule| &self.rules[*rule]))
    }
}

impl ExactCoupling {
    /// [`Coupling::add_tangent`] with the stiffness of the strain energy weighted by `strain`.
    fn add_tangent_with(
        &self,
        strain: f64,
        s: &State,
        hub: &HubKinematics,
        w: &Weights<'_>,
        out: &mut Storage<f64>,
    ) {
        let viscous = self.viscosity > 0.0 && (w.q != 0.0 || w.v != 0.0);
        for (element, rule) in self.each() {
            if strain == 0.0 && !viscous && !element.has_section_inertia() {
                continue;
            }
            let mut tangent = [[0.0; 8]; 8];
            if strain != 0.0 {
                element.strain_tangent(rule, &element.part(&s.q), strain, &mut tangent);
            }
            if viscous || element.has_section_inertia() {
                let local = element.gather(s, self.radius);
                element.section_tangent(rule, &local, hub, w, &mut tangent);
                if viscous {
                    element.viscous_tangent(rule, &local, self.viscosity, w, &mut tangent);
                }
            }
            element.assemble(&tangent, out);
        }
        for mass in &*self.lumped {
            mass.add_tangent(s, hub, w, out);
        }
    }
}

impl Coupling for ExactCoupling {
    fn name(&self) -> &'static str {
        "exact"
    }

    fn fields(&self) -> &Fields {
        &self.fields
    }

    fn inertia(&self) -> &Inertia {
        &self.inertia
    }

    fn is_affine(&self) -> bool {
        false
    }

    fn add_forces(&mut self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        for (element, rule) in self.each() {
            let mut force = [0.0; 8];
            element.strain_force(rule, &element.part(&s.q), &mut force);
            if self.viscosity > 0.0 || element.has_section_inertia() {
                let local = element.gather(s, self.radius);
                element.section_force(rule, &local, hub, &mut force);
                if self.viscosity > 0.0 {
                    element.viscous_force(rule, &local, self.viscosity, &mut force);
                }
            }
            element.scatter(&force, r);
        }
        for mass in &*self.lumped {
            mass.add_forces(s, hub, r);
        }
    }

    fn add_tangent(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        self.add_tangent_with(w.q, s, hub, w, out);
    }

    fn strain_forms(&mut self, s: &State, vectors: &[Vec<f64>], out: &mut [f64]) {
        for (element, rule) in self.each() {
            element.strain_forms(rule, &element.part(&s.q), vectors, out);
        }
    }

    fn add_unstrained_stiffness(&mut self, s: &State, hub: &HubKinematics, out: &mut Storage<f64>) {
        self.add_tangent_with(0.0, s, hub, &Weights::new(0.0, 0.0, 1.0), out);
    }

    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        out.clear();
        for element in &*self.elements {
            element.end_rotation(&before.q, &now.q, out);
        }
    }

    fn strain(&mut self, s: &State) -> f64 {
        self.each().map(|(e, rule)| e.strain_energy(rule, &e.part(&s.q))).sum()
    }

    fn extra_totals(&mut self, s: &State, hub: &HubKinematics) -> Totals {
        let of = |(e, rule): (&Element, &Rule)| e.section_totals(rule, &e.gather(s, self.radius), hub);
        let rotating = self.each().filter(|(e, _)| e.has_section_inertia());
        let lumped = self.lumped.iter().map(|mass| mass.totals(s, hub));
        rotating.map(of).chain(lumped).fold(Totals::default(), |sum, t| sum + t)
    }

    fn add_border(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Border) {
        for (element, rule) in self.each().filter(|(element, _)| element.has_section_inertia()) {
            let (mut column, mut row) = ([0.0; 8], [0.0; 8]);
            let local = element.gather(s, self.radius);
            out.corner += element.section_border(rule, &local, hub, w, (&mut column, &mut row));
            element.scatter(&column, &mut out.column);
            element.scatter(&row, &mut out.row);
        }
        for mass in &*self.lumped {
            mass.add_border(s, hub, w, out);
        }
    }

    fn kinematics(&self) -> Kinematics {
        Kinematics::Curve
    }

    fn damp(&mut self, damping: Damping) {
        Arc::make_mut(&mut self.inertia).damp(damping);
        self.viscosity = damping.stiffness;
    }

    fn dissipated(&mut self, s: &State) -> f64 {
        let mut power = self.inertia.dissipated(&s.v);
        if self.viscosity > 0.0 {
            let of = |(e, rule): (&Element, &Rule)| {
                e.viscous_power(rule, &e.gather(s, self.radius), self.viscosity)
            };
            power += self.each().map(of).sum::<f64>();
        }
        power
    }

    fn placements(&self, s: &State, stations: &[Station], out: &mut [Placement]) {
        // The angle of the tangent is followed from the root, so that it may pass π. As long as the curve goes outward it lies within ±π/2,
        // and is found where that ends.
        let (mut node, mut angle) = (0, 0.0);
        let mut outward = Some((0.0, 0.0));
        let slope = |u: f64, v: f64| libm::atan2(v, 1.0 + u);
        let nearest = |angle: f64, to: f64| {
            angle + std::f64::consts::TAU * ((to - angle) / std::f64::consts::TAU).round()
        };
        for (station, out) in stations.iter().zip(out) {
            while node < self.elements.len() && self.elements[node].end() <= station.point.x {
                let (u, v) = self.elements[node].end_slopes(&s.q);
                if outward.is_some() && 1.0 + u > 0.0 {
                    outward = Some((u, v));
                } else {
                    let before = outward.take().map_or(angle, |(u, v)| slope(u, v));
                    angle = nearest(slope(u, v), before);
                }
                node += 1;
            }
            let angle = outward.map_or(angle, |(u, v)| slope(u, v));
            let [u, v, u1, v1, du, dv, du1, dv1] = station.fields(s);
            let square = (1.0 + u1) * (1.0 + u1) + v1 * v1;
            *out = Placement {
                axial: u,
                deflection: v,
                rotation: nearest(slope(u1, v1), angle),
                axial_velocity: du,
                deflection_velocity: dv,
                rotation_velocity: ((1.0 + u1) * dv1 - v1 * du1) / square,
            };
        }
    }

    fn strains(&self, s: &State, point: &Point) -> (f64, f64) {
        let (u, v) = (&point.axial, &point.transverse);
        let (u1, y1) = (u.field(1, &s.q), v.field(1, &s.q));
        let (x2, y2) = (u.field(2, &s.q), v.field(2, &s.q));
        let x1 = 1.0 + u1;
        let square = x1 * x1 + y1 * y1;
        ((u1 * (2.0 + u1) + y1 * y1) / (square.sqrt() + 1.0), (x1 * y2 - y1 * x2) / square)
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        for element in &*self.elements {
            let (u, v) = element.end_slopes(&s.q);
            let square = (1.0 + u) * (1.0 + u) + v * v;
            // NaN is refused too.
            if !(LEAST_STRETCH * LEAST_STRETCH..=MOST_STRETCH * MOST_STRETCH).contains(&square) {
                let (strain, station) = (square.sqrt() - 1.0, element.end());
                return Err(Limit::Strain { strain, station, largest: LARGEST_STRAIN });
            }
        }
        Ok(())
    }

    fn cautions(&self, _deflection: f64) -> Vec<String> {
        Vec::new()
    }
}

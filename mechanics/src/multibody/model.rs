//! What a user builds: bodies, joints, springs and loads, with their faults.

use super::body::Body;
use super::contact_point::{Along, ContactPoint};
use super::error::{ModelError, PartFault};
use super::flexible::Flexible;
use super::force::{Directions, Load, Spring};
use super::joint::{Joint, Kind};
use super::line_law::LineLaw;
use super::line_load::LineLoad;
use super::marker::{Marker, Part};
use super::rotation::frame;
use crate::linalg::{Mat3, Vec3};
use crate::system::Frame;
use std::collections::BTreeSet;

/// Bodies, beams, joints, springs and loads, as they stand at t = 0.
#[derive(Clone, Debug, Default)]
pub struct Model {
    pub(super) gravity: Vec3,
    pub(super) bodies: Vec<Body>,
    pub(super) beams: Vec<Flexible>,
    pub(super) joints: Vec<Joint>,
    pub(super) springs: Vec<Spring>,
    pub(super) loads: Vec<Load>,
    pub(super) line_loads: Vec<LineLoad>,
    pub(super) line_laws: Vec<LineLaw>,
    pub(super) points: Vec<ContactPoint>,
    pub(super) drop_redundant: bool,
    pub(super) in_plane: bool,
}

impl Model {
    /// A model without gravity.
    pub fn new() -> Model {
        Model::default()
    }

    /// The same model with the acceleration of gravity, e.g. (0, 0, −9.81) m/s².
    #[must_use]
    pub fn with_gravity(mut self, gravity: impl Into<Vec3>) -> Model {
        self.gravity = gravity.into();
        self
    }

    /// The same model, of which rows that follow from others are left out, where they would be an error. A run ends where
    /// they no longer follow.
    pub fn drop_redundant_rows(mut self) -> Model {
        self.drop_redundant = true;
        self
    }

    /// The same model, all of which stays in the plane of x and y: its modes are those in the plane, and no disturbance leads out
    /// of it. A body counts as one of the plane where one of its axes is that of z.
    #[must_use]
    pub fn in_plane(mut self) -> Model {
        self.in_plane = true;
        self
    }

    /// Adds a body.
    pub fn body(&mut self, body: Body) -> Part {
        self.bodies.push(body);
        Part::Body(self.bodies.len() - 1)
    }

    /// Adds a beam; gives its number for [`Part::Section`].
    pub fn beam(&mut self, beam: Flexible) -> usize {
        self.beams.push(beam);
        self.beams.len() - 1
    }

    /// Adds a joint.
    pub fn joint(&mut self, joint: Joint) {
        self.joints.push(joint);
    }

    /// Adds a spring.
    pub fn spring(&mut self, spring: Spring) {
        self.springs.push(spring);
    }

    /// Adds a load.
    pub fn load(&mut self, load: Load) {
        self.loads.push(load);
    }

    /// Adds a load along a beam.
    pub fn line_load(&mut self, load: LineLoad) {
        self.line_loads.push(load);
    }

    /// Adds a force law along a beam.
    pub fn line_law(&mut self, law: LineLaw) {
        self.line_laws.push(law);
    }

    /// Adds a point of a body or of a beam's section that may touch obstacles; gives its number for [contacts](crate::contact::Contact).
    pub fn contact_point(&mut self, point: Marker) -> usize {
        self.contact_ball(point, 0.0)
    }

    /// The same of a ball of this radius \[m\] about the point, which slides and rolls on obstacles with its surface.
    pub fn contact_ball(&mut self, at: Marker, radius: f64) -> usize {
        self.points.push(ContactPoint { at, radius, axis: None, carrier: None });
        self.points.len() - 1
    }

    /// The same of the point of a beam that is nearest to the obstacle, wherever it is. The beam is round with this radius \[m\];
    /// friction acts on its centreline.
    pub fn contact_beam(&mut self, beam: usize, radius: f64) -> usize {
        self.contact_along(beam, radius, Along::Nearest)
    }

    /// The same of the point of the axis of a beam at the arc length `station` \[m\], r = Σ Nᵢ xᵢ, at which the beam needs no node. The beam is
    /// round with this radius \[m\]; friction acts on its centreline.
    pub fn contact_station(&mut self, beam: usize, station: f64, radius: f64) -> usize {
        self.contact_along(beam, radius, Along::Station(station))
    }

    fn contact_along(&mut self, beam: usize, radius: f64, axis: Along) -> usize {
        let at = Marker::new(Part::Section { beam, node: 0 }, [0.0; 3]);
        self.points.push(ContactPoint { at, radius, axis: Some(axis), carrier: None });
        self.points.len() - 1
    }

    /// Fixes the obstacle of the contact point of this number to a part: its surface is given in the frame `carrier`, and what acts on the
    /// point acts back on the part.
    pub fn mount(&mut self, point: usize, carrier: Marker) {
        if let Some(point) = self.points.get_mut(point) {
            point.carrier = (carrier.part != Part::Ground).then_some(carrier);
        }
    }

    /// Adds a joint at a `point` of space, where both markers are at the start: their third axis along `axis`, their first
    /// towards `first` if that is given.
    ///
    /// # Errors
    /// [`ModelError::Part`] when the axis has no direction or a part is not there.
    pub fn join(
        &mut self,
        name: &str,
        kind: Kind,
        [from, to]: [Part; 2],
        point: impl Into<Vec3>,
        (axis, first): (impl Into<Vec3>, Option<Vec3>),
    ) -> Result<&mut Joint, ModelError> {
        let number = self.joints.len();
        let fault = |fault| ModelError::Part { kind: "joint", number, name: name.to_owned(), fault };
        let rotation = frame(axis.into(), first).ok_or_else(|| fault(PartFault::NoDirection))?;
        let space = Frame { position: point.into(), rotation };
        let marker = |part| self.marker(part, space).ok_or_else(|| fault(PartFault::NoPart));
        let joint = Joint::new(name, kind, marker(from)?, marker(to)?);
        self.joints.push(joint);
        self.joints.last_mut().ok_or(ModelError::Empty)
    }

    /// The marker of a part that is the frame `space` at the start; `None` for a part that is not there.
    pub fn marker(&self, part: Part, space: Frame) -> Option<Marker> {
        let own = self.frame(part)?;
        let inverse = own.rotation.transpose();
        let position = inverse * (space.position - own.position);
        Some(Marker { part, frame: Frame { position, rotation: inverse * space.rotation } })
    }

    /// Its bodies, lumped masses among them.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Its springs.
    pub fn springs(&self) -> &[Spring] {
        &self.springs
    }

    /// The frame of a part at the start.
    pub(super) fn frame(&self, part: Part) -> Option<Frame> {
        match part {
            Part::Ground => Some(Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }),
            Part::Body(i) => self.bodies.get(i).map(|body| body.frame),
            Part::Section { beam, node } => {
                let beam = &self.beams.get(beam)?.beam;
                (node < beam.nodes().len()).then(|| beam.node(node, beam.initial()))
            }
        }
    }

    /// The first thing that is wrong with a part.
    pub(super) fn check(&self) -> Result<(), ModelError> {
        if self.bodies.is_empty() && self.beams.is_empty() {
            return Err(ModelError::Empty);
        }
        let mut names = BTreeSet::new();
        for (i, body) in self.bodies.iter().enumerate() {
            self.examine(("body", i), &body.name, body.fault(), &[], &mut names)?;
        }
        for (i, beam) in self.beams.iter().enumerate() {
            self.examine(("beam", i), &beam.name, beam.fault(), &[], &mut names)?;
        }
        for (i, joint) in self.joints.iter().enumerate() {
            self.examine(("joint", i), &joint.name, joint.fault(), &[joint.from, joint.to], &mut names)?;
        }
        for (i, spring) in self.springs.iter().enumerate() {
            let Spring { stiffness, damping, length, .. } = spring;
            let sound = [stiffness, damping, length].iter().all(|x| **x >= 0.0 && x.is_finite());
            let fault = (!sound).then_some(PartFault::Spring).or_else(|| {
                let long = spring.directions == Directions::All && *length != 0.0;
                long.then_some(PartFault::Length(*length))
            });
            self.examine(("spring", i), &spring.name, fault, &[spring.from, spring.to], &mut names)?;
        }
        for (i, load) in self.loads.iter().enumerate() {
            let sound = load.force.is_finite() && load.moment.is_finite();
            let fault = (!sound).then_some(PartFault::NotFinite("component"));
            self.examine(("load", i), &load.name, fault, &[load.at], &mut names)?;
        }
        for (i, load) in (self.loads.len()..).zip(&self.line_loads) {
            let finite = load.force.is_finite();
            let fault = (!finite).then_some(PartFault::NotFinite("component"));
            let missing = (load.beam >= self.beams.len()).then_some(PartFault::NoBeam);
            self.examine(("load", i), &load.name, fault.or(missing), &[], &mut names)?;
        }
        for (i, law) in (self.loads.len() + self.line_loads.len()..).zip(&self.line_laws) {
            let missing = (law.beam >= self.beams.len()).then_some(PartFault::NoBeam);
            self.examine(("load", i), &law.name, missing, &[], &mut names)?;
        }
        for (k, point) in self.points.iter().enumerate() {
            let sound = point.radius >= 0.0 && point.radius.is_finite();
            let fault =
                (!sound).then_some(PartFault::Negative { what: "radius", value: point.radius, unit: "m" });
            let of_beam = |marker: &Marker| match marker.part {
                Part::Section { beam, .. } => Some(beam),
                _ => None,
            };
            let same =
                point.carrier.is_some_and(|on| of_beam(&on).is_some() && of_beam(&on) == of_beam(&point.at));
            let fault = fault.or_else(|| same.then_some(PartFault::SamePart));
            let markers: Vec<Marker> = [point.at].into_iter().chain(point.carrier).collect();
            let name = format!("contact point {k}");
            self.examine(("contact point", k), &name, fault, &markers, &mut names)?;
        }
        Ok(())
    }

    fn examine(
        &self,
        (kind, number): (&'static str, usize),
        name: &str,
        fault: Option<PartFault>,
        markers: &[Marker],
        names: &mut BTreeSet<String>,
    ) -> Result<(), ModelError> {
        let missing = markers.iter().any(|m| self.frame(m.part).is_none());
        let numbers = |m: &Marker| m.frame.position.is_finite() && m.frame.rotation.is_finite();
        let fault = fault
            .or_else(|| missing.then_some(PartFault::NoPart))
            .or_else(|| (!markers.iter().all(numbers)).then_some(PartFault::NotFinite("marker")))
            .or_else(|| match markers {
                [a, b] if a.part == b.part => Some(PartFault::SamePart),
                [a] if a.part == Part::Ground => Some(PartFault::OnGround),
                _ => None,
            })
            .or_else(|| (!names.insert(name.to_owned())).then_some(PartFault::NameTaken));
        match fault {
            Some(fault) => Err(ModelError::Part { kind, number, name: name.to_owned(), fault }),
            None => Ok(()),
        }
    }
}

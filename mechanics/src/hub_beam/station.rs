//! Stations: points of the axis at which displacements are recorded.

use super::fields::{Fields, Point};
use crate::system::{Channel, Kind, Role, Sink, State};
use std::sync::Arc;

/// A station on the axis, with the shape functions there.
#[derive(Clone, Debug)]
pub struct Station {
    /// Prefix of its columns: `tip`, or `x=2.5`.
    pub name: String,
    /// Both fields there.
    pub point: Point,
    /// Quadrature points between the start of its cell and the station, for integrals along the beam.
    pub rest: Arc<[Point]>,
}

impl Station {
    /// The station at `x` \[m\].
    pub fn new(fields: &Fields, x: f64) -> Station {
        let tip = x >= fields.length() * (1.0 - 1e-12);
        let name = if tip { "tip".to_owned() } else { format!("x={x}") };
        let start = fields.cells().iter().rev().find(|start| **start <= x).copied().unwrap_or(x);
        let rest = if start < x {
            fields.gauss().on(start, x).map(|(x, w)| fields.point(x, w)).collect()
        } else {
            Arc::default()
        };
        Station { name, point: fields.point(x, 0.0), rest }
    }

    /// Both displacement fields, their slopes and rates at the station.
    #[inline]
    pub fn fields(&self, s: &State) -> [f64; 8] {
        let (a, b) = (&self.point.axial, &self.point.transverse);
        [
            a.field(0, &s.q),
            b.field(0, &s.q),
            a.field(1, &s.q),
            b.field(1, &s.q),
            a.field(0, &s.v),
            b.field(0, &s.v),
            a.field(1, &s.v),
            b.field(1, &s.v),
        ]
    }
}

impl Station {
    /// Records where the section of the station is.
    pub(super) fn observe(&self, now: &Placement, sink: &mut Sink<'_>) {
        let Station { name, point, .. } = self;
        let tip = name == "tip";
        let [displacement, other] =
            if tip { [Role::Primary, Role::Secondary] } else { [Role::Detail, Role::Detail] };
        let channel = |role, quantity, unit: &'static str, what, frame| {
            let at = if tip { "of the tip".to_owned() } else { format!("at x = {} m", point.x) };
            Channel::new(role, format!("{name}.{quantity}"), unit, format!("{what} {at}{frame}"))
        };
        let frame = " in the hub's frame";
        sink.put(now.deflection, || {
            let what = "transverse displacement";
            channel(displacement, "deflection", "m", what, frame).with_kind(Kind::Deflection)
        });
        let mut put = |value, role, quantity, unit: &'static str, what, frame| {
            sink.put(value, || channel(role, quantity, unit, what, frame));
        };
        put(now.axial, displacement, "axial", "m", "axial displacement", frame);
        put(now.rotation, other, "rotation", "rad", "rotation of the section", " against the hub");
        let rate = "rate of the transverse displacement";
        put(now.deflection_velocity, other, "deflection_velocity", "m/s", rate, "");
        put(now.axial_velocity, other, "axial_velocity", "m/s", "rate of the axial displacement", "");
        put(now.rotation_velocity, other, "rotation_velocity", "rad/s", "rate of the rotation", "");
    }
}

/// Displacement and rotation of the section at a station, with their rates, in the hub's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// Axial displacement X − a − x \[m\].
    pub axial: f64,
    /// Transverse displacement Y \[m\].
    pub deflection: f64,
    /// Rotation of the section \[rad\].
    pub rotation: f64,
    /// Rate of the axial displacement [m/s].
    pub axial_velocity: f64,
    /// Rate of the transverse displacement [m/s].
    pub deflection_velocity: f64,
    /// Rate of the rotation [rad/s].
    pub rotation_velocity: f64,
}

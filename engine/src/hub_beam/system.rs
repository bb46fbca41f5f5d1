//! The hub–beam as a [`System`].

use super::coupling::Coupling;
use super::inertia::{Inertia, Scratch};
use super::station::{Placement, Station};
use crate::linalg::{Matrix, Structure};
use crate::profile::{HubKinematics, Motion};
use crate::system::{Channel, Energy, Frame, Label, Size, State, System, Weights};

/// The hub: a rigid body that turns about a fixed axis by a prescribed motion.
#[derive(Debug)]
pub struct Hub {
    /// Radius a at which the beam is clamped \[m\].
    pub radius: f64,
    /// Moment of inertia about the axis [kg·m²].
    pub inertia: f64,
    /// Prescribed motion θ(t).
    pub motion: Motion,
}

/// A flexible beam on a hub. See the [module documentation](super).
#[derive(Debug)]
pub struct HubBeam<C> {
    hub: Hub,
    coupling: C,
    labels: Vec<Label>,
    channels: Vec<Channel>,
    /// Recorded stations, ascending along the beam; the tip is the last.
    stations: Vec<Station>,
    placements: Vec<Placement>,
    /// Largest deflection of the tip that was recorded \[m\].
    largest_deflection: f64,
    scratch: Scratch,
    /// The time asked for last and the motion of the hub then: every step asks several times.
    latest: (f64, HubKinematics),
}

impl<C: Coupling> HubBeam<C> {
    /// The system; `stations` \[m\] are recorded besides the tip.
    pub fn new(hub: Hub, coupling: C, stations: &[f64]) -> HubBeam<C> {
        let fields = coupling.fields();
        let mut places: Vec<f64> = stations.iter().copied().filter(|x| *x < fields.length()).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        places.push(fields.length());
        let stations: Vec<Station> = places.iter().map(|&x| Station::new(fields, x)).collect();
        HubBeam {
            labels: fields.labels(),
            channels: channels(&stations),
            placements: vec![Placement::default(); stations.len()],
            stations,
            largest_deflection: 0.0,
            scratch: coupling.inertia().scratch(),
            latest: (0.0, hub.motion.at(0.0)),
            hub,
            coupling,
        }
    }

    /// The hub.
    pub fn hub(&self) -> &Hub {
        &self.hub
    }

    /// The coupling.
    pub fn coupling(&self) -> &C {
        &self.coupling
    }

    /// Torque that the prescribed motion needs [N·m].
    pub fn torque(&mut self, s: &State) -> f64 {
        let hub = self.motion_at(s.t);
        self.kinetic_and_torque(s, &hub).1
    }

    /// Motion of the hub at time `t`.
    fn motion_at(&mut self, t: f64) -> HubKinematics {
        if self.latest.0 != t {
            self.latest = (t, self.hub.motion.at(t));
        }
        self.latest.1
    }

    /// Kinetic energy of beam and hub, and torque that the motion needs.
    fn kinetic_and_torque(&mut self, s: &State, hub: &HubKinematics) -> (f64, f64) {
        let (kinetic, torque) = self.coupling.inertia().kinetic_and_torque(s, hub, &mut self.scratch);
        let (extra_kinetic, extra_torque) = self.coupling.extra_kinetic_and_torque(s, hub);
        (kinetic + extra_kinetic, torque + extra_torque)
    }
}

/// The recorded quantities, in the order of [`HubBeam::record`].
fn channels(stations: &[Station]) -> Vec<Channel> {
    let mut channels = Vec::new();
    let mut add = |name: String, unit: &'static str, meaning: String| {
        channels.push(Channel { name, unit, meaning });
    };
    // The tip first: it is what most people look for.
    for station in stations.iter().rev().take(1).chain(&stations[..stations.len() - 1]) {
        let (name, x) = (&station.name, station.point.x);
        let at = if name == "tip" { "of the tip".to_owned() } else { format!("at x = {x} m") };
        add(format!("{name}.deflection"), "m", format!("transverse displacement {at} in the hub's frame"));
        add(format!("{name}.axial"), "m", format!("axial displacement {at} in the hub's frame"));
        add(format!("{name}.rotation"), "rad", format!("rotation of the section {at} against the hub"));
        add(
            format!("{name}.deflection_velocity"),
            "m/s",
            format!("rate of the transverse displacement {at}"),
        );
        add(format!("{name}.axial_velocity"), "m/s", format!("rate of the axial displacement {at}"));
        add(format!("{name}.rotation_velocity"), "rad/s", format!("rate of the rotation {at}"));
    }
    add("hub.angle".into(), "rad", "angle of the hub".into());
    add("hub.speed".into(), "rad/s", "angular speed of the hub".into());
    add("hub.acceleration".into(), "rad/s^2", "angular acceleration of the hub".into());
    add("hub.torque".into(), "N*m", "torque that the motion of the hub needs".into());
    add("energy.kinetic".into(), "J", "kinetic energy of beam and hub".into());
    add("energy.strain".into(), "J", "strain energy of the beam".into());
    channels
}

impl<C: Coupling> System for HubBeam<C> {
    fn size(&self) -> Size {
        let n = self.coupling.fields().len();
        Size { q: n, v: n, lambda: 0 }
    }

    fn structure(&self) -> Structure {
        self.coupling.fields().structure(0)
    }

    fn labels(&self) -> &[Label] {
        &self.labels
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let hub = self.motion_at(s.t);
        self.coupling.inertia().residual(s, &hub, &mut self.scratch, r);
        self.coupling.add_forces(s, &hub, r);
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let hub = self.motion_at(s.t);
        if self.coupling.is_affine() {
            let stamp = Inertia::stamp(&w, &hub);
            if !out.holds(&stamp) {
                self.coupling.inertia().tangent(&w, &hub, out.begin());
                out.set_stamp(Some(stamp));
            }
        } else {
            let storage = out.begin();
            self.coupling.inertia().tangent(&w, &hub, storage);
            self.coupling.add_tangent(s, &hub, &w, storage);
        }
    }

    fn is_affine(&self) -> bool {
        self.coupling.is_affine()
    }

    fn energy(&mut self, s: &State) -> Energy {
        let hub = self.motion_at(s.t);
        let (kinetic, _) = self.kinetic_and_torque(s, &hub);
        Energy { kinetic, strain: self.coupling.strain(s), gravity: 0.0 }
    }

    fn power(&mut self, s: &State) -> f64 {
        self.torque(s) * self.motion_at(s.t).speed
    }

    fn shape(&mut self, s: &State, stations: &[f64], out: &mut [Frame]) {
        let stations: Vec<Station> =
            stations.iter().map(|&x| Station::new(self.coupling.fields(), x)).collect();
        let mut placements = vec![Placement::default(); stations.len()];
        self.coupling.placements(s, &stations, &mut placements);
        let angle = self.hub.motion.at(s.t).angle;
        for ((station, p), frame) in stations.iter().zip(&placements).zip(out) {
            let x = self.hub.radius + station.point.x + p.axial;
            let (sin, cos) = angle.sin_cos();
            let (sin_section, cos_section) = (angle + p.rotation).sin_cos();
            frame.position = [x * cos - p.deflection * sin, x * sin + p.deflection * cos, 0.0];
            frame.rotation =
                [[cos_section, -sin_section, 0.0], [sin_section, cos_section, 0.0], [0.0, 0.0, 1.0]];
        }
    }

    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn record(&mut self, s: &State, out: &mut [f64]) {
        self.coupling.placements(s, &self.stations, &mut self.placements);
        let tip = self.placements.last().map_or(0.0, |p| p.deflection.abs());
        self.largest_deflection = self.largest_deflection.max(tip);
        let hub = self.motion_at(s.t);
        let (kinetic, torque) = self.kinetic_and_torque(s, &hub);
        let strain = self.coupling.strain(s);
        let (tip, rest) = (self.placements.len() - 1, self.placements.len());
        let order = std::iter::once(tip).chain(0..rest - 1);
        let mut values = order
            .flat_map(|i| {
                let p = &self.placements[i];
                [
                    p.deflection,
                    p.axial,
                    p.rotation,
                    p.deflection_velocity,
                    p.axial_velocity,
                    p.rotation_velocity,
                ]
            })
            .chain([hub.angle, hub.speed, hub.acceleration, torque, kinetic, strain]);
        for out in out {
            *out = values.next().unwrap_or(f64::NAN);
        }
    }

    fn breaks(&self) -> &[f64] {
        self.hub.motion.breaks()
    }

    fn admissible(&mut self, s: &State) -> Result<(), String> {
        self.coupling.admissible(s)
    }

    fn cautions(&self) -> Vec<String> {
        self.coupling.caution(self.largest_deflection).into_iter().collect()
    }

    fn explain(&mut self, s: &State) -> Option<String> {
        let speed = self.hub.motion.at(s.t).speed.abs();
        let critical = self.coupling.critical_speed(speed)?;
        let passed = self.first_time_above(critical, s.t);
        Some(format!(
            "since t = {passed:.3} s the hub turns faster than {critical:.4} rad/s, where the stiffness K − ω²M of \
             the {}-order coupling is exhausted (dynamic softening: it leaves out the centrifugal stiffening); \
             use coupling = \"first\" or \"exact\"",
            self.coupling.name()
        ))
    }
}

impl<C: Coupling> HubBeam<C> {
    /// First time at which the hub is faster than `speed`, found on a fine grid and then by bisection.
    fn first_time_above(&self, speed: f64, until: f64) -> f64 {
        let above = |t: f64| self.hub.motion.at(t).speed.abs() > speed;
        let grid = 1000;
        let at = |i: usize| until * i as f64 / grid as f64;
        let hit = (0..=grid).find(|&i| above(at(i))).unwrap_or(grid);
        let (mut low, mut high) = (at(hit.saturating_sub(1)), at(hit));
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if above(middle) { high = middle } else { low = middle }
        }
        high
    }
}

//! The hub–beam as a [`System`](crate::system::System).

use super::beam::Beam;
use super::contact_point::ContactPoint;
use super::coupling::Coupling;
use super::damping::Damping;
use super::hub::{Drive, Hub, Recent};
use super::inertia::{Border, Scratch, Totals};
use super::load::{Load, Loads, Site};
use super::measured::Measured;
use super::positive::HubInertia;
use super::section_forces::{Sampling, SectionForces};
use super::station::{Placement, Station};
use crate::drive::motion_breaks;
use crate::linalg::{Mat3, Matrix, Storage, Structure, Vec3};
use crate::profile::HubKinematics;
use crate::system::{
    Break, Channel, Corotation, Direction, Dynamics, Energy, Events, Frame, Kind, Limit, LineForce, NotSet,
    Observed, Parameter, PointForce, Power, Role, Sink, Size, State, Steady, StiffnessForm, Weights, ordered,
};
use std::sync::Arc;

/// A flexible beam on a hub. See the [module documentation](super). A clone shares the constants and has work memory of
/// its own.
#[derive(Clone, Debug)]
pub struct HubBeam<C> {
    hub: Hub,
    coupling: C,
    scales: Arc<[f64]>,
    /// Recorded stations, ascending along the beam; the tip is the last.
    stations: Arc<[Station]>,
    /// Stations that were last requested by [`Observed::frames`].
    pub(super) shown: Vec<Station>,
    /// Stations at which loads are drawn, once they were asked for.
    pub(super) loaded: Vec<Station>,
    placements: Vec<Placement>,
    scratch: Scratch,
    recent: Recent,
    measured: Measured,
    border: Border,
    /// Times at which drive and loads are not smooth.
    breaks: Arc<[Break]>,
    /// Speed of a steady rotation instead of the drive's [rad/s], and whether the hub is held.
    steady: Option<f64>,
    pub(super) held: bool,
    /// Angle by which the hub is turned further against loads of a fixed direction \[rad\].
    azimuth: f64,
    pub(super) loads: Loads,
    /// Stations that may touch obstacles, and the torque of the contact forces on the hub [N·m].
    pub(super) contact_points: Vec<ContactPoint>,
    pub(super) contact_torque: f64,
    damped: bool,
    /// Forces in the sections at the stations, recorded last.
    section_forces: Arc<SectionForces>,
    /// Effective inertia of a free hub, for a coupling whose kinetic energy may become negative.
    hub_inertia: Option<HubInertia>,
    /// Effective inertia of the released hub over the inertia of hub and beam, where it is watched and small.
    small_share: Option<f64>,
}

/// Part of the inertia of hub and beam below which such a hub is reported by a caution.
const SMALL_SHARE: f64 = 0.01;
/// Part of the inertia of a free hub below which the failure of a run is attributed to its loss.
const VANISHING: f64 = 0.2;

impl<C: Coupling> HubBeam<C> {
    /// The system; `stations` \[m\] are recorded besides the tip.
    pub fn new(hub: Hub, coupling: C, stations: &[f64]) -> HubBeam<C> {
        let fields = coupling.fields();
        let mut at: Vec<f64> =
            stations.iter().copied().filter(|x| *x < fields.length() * (1.0 - 1e-12)).collect();
        at.sort_by(f64::total_cmp);
        at.dedup();
        at.push(fields.length());
        let stations: Vec<Station> = at.iter().map(|&x| Station::new(fields, x)).collect();
        let mut scales = fields.scales();
        let breaks = match &hub.drive {
            Drive::Prescribed(motion) => motion_breaks(motion),
            Drive::Free(free) => {
                scales.push(1.0);
                ordered(free.actuator.breaks())
            }
        };
        let mut scratch = coupling.inertia().scratch();
        let watched = matches!(hub.drive, Drive::Free(_)) && !coupling.has_positive_kinetic_energy();
        let mut hub_inertia = watched
            .then(|| HubInertia::new(coupling.inertia(), &coupling.structure(0), &mut scratch, hub.inertia))
            .flatten();
        let share = hub_inertia.as_mut().map(|watch| watch.share(coupling.inertia(), &mut scratch));
        HubBeam {
            hub_inertia,
            small_share: share.filter(|share| *share < SMALL_SHARE),
            scales: scales.into(),
            placements: vec![Placement::default(); stations.len()],
            stations: stations.into(),
            shown: Vec::new(),
            loaded: Vec::new(),
            scratch,
            recent: Recent::new(),
            measured: Measured::default(),
            border: Border::new(fields.len()),
            breaks: breaks.into(),
            steady: None,
            held: false,
            azimuth: 0.0,
            loads: Loads::default(),
            contact_points: Vec::new(),
            contact_torque: 0.0,
            damped: false,
            section_forces: Arc::default(),
            hub,
            coupling,
        }
    }

    /// The same system under `loads`; `beam` is the one the coupling was made of.
    #[must_use]
    pub fn with_loads<'a>(mut self, beam: impl Into<Beam<'a>>, loads: &[&dyn Load]) -> HubBeam<C> {
        let site = Site {
            fields: self.coupling.fields(),
            kinematics: self.coupling.kinematics(),
            beam: &beam.into(),
            radius: self.hub.radius,
            border: self.hub.unknowns(),
        };
        self.loads = Loads::new(&site, loads);
        self.breaks = ordered([&*self.breaks, self.loads.breaks()].concat()).into();
        self
    }

    /// The same system with damping of the beam.
    #[must_use]
    pub fn with_damping(mut self, damping: Damping) -> HubBeam<C> {
        self.coupling.damp(damping);
        self.damped = !damping.is_none();
        self
    }

    /// The same system, recording at its stations the section forces, if `forces`, and the strains at `heights` \[m\];
    /// `section` is the one the coupling was made of.
    #[must_use]
    pub fn with_section_forces(
        mut self,
        beam: &Beam<'_>,
        sampling: Sampling,
        forces: bool,
        heights: &[f64],
    ) -> HubBeam<C> {
        // The tip first, as for the displacements.
        let (tip, rest) = (self.stations.len() - 1, self.stations.len() - 1);
        let order = std::iter::once(tip).chain(0..rest);
        let at: Vec<(String, f64)> =
            order.map(|i| (self.stations[i].name.clone(), self.stations[i].point.x)).collect();
        let fields = self.coupling.fields();
        self.section_forces = Arc::new(SectionForces::new(fields, beam, sampling, &at, forces, heights));
        self
    }

    /// The hub.
    pub fn hub(&self) -> &Hub {
        &self.hub
    }

    /// The coupling.
    pub fn coupling(&self) -> &C {
        &self.coupling
    }

    /// Torque on the hub [N·m]: what a prescribed motion needs, or what drives a free hub.
    pub fn torque(&mut self, s: &State) -> f64 {
        let hub = self.kinematics(s);
        match &self.hub.drive {
            Drive::Prescribed(_) => self.reaction(s, &hub) - self.loads.torque(s, &hub),
            Drive::Free(free) => free.actuator.torque(&hub, s.time()).value,
        }
    }

    /// Torque of [`HubBeam::totals`].
    fn reaction(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        self.coupling.inertia().torque(s, hub, &mut self.scratch) + self.coupling.extra_torque(s, hub)
    }

    /// Power of drive, loads and dampers; `reaction` is the torque of [`HubBeam::totals`], where it is known.
    fn power_with(&mut self, s: &State, hub: &HubKinematics, reaction: Option<f64>) -> Power {
        let mut power = Power { loads: self.loads.power(s, hub), ..Power::default() };
        match &self.hub.drive {
            // A hub at rest takes no power.
            Drive::Prescribed(_) if hub.speed == 0.0 => {}
            Drive::Prescribed(_) => {
                let torque = reaction.unwrap_or_else(|| self.reaction(s, hub));
                power.drive = (torque - self.loads.torque(s, hub)) * hub.speed;
            }
            Drive::Free(free) => {
                power.drive = free.actuator.driving_torque(hub, s.time()) * hub.speed;
                power.dissipated = free.actuator.damping * hub.speed * hub.speed;
            }
        }
        if self.damped {
            power.dissipated += self.coupling.dissipated(s);
        }
        power.dissipated += self.loads.dissipated(s, hub);
        power
    }

    /// Angle, speed and acceleration of the hub.
    pub(super) fn kinematics(&mut self, s: &State) -> HubKinematics {
        let n = || self.coupling.fields().len();
        let mut hub = match (&self.hub.drive, self.steady) {
            (Drive::Free(free), steady) if self.held => {
                let speed = steady.unwrap_or(free.speed);
                HubKinematics { angle: s.q[n()], speed, acceleration: 0.0 }
            }
            (Drive::Free(_), _) => {
                let n = n();
                HubKinematics { angle: s.q[n], speed: s.v[n], acceleration: s.a[n] }
            }
            (Drive::Prescribed(_), Some(speed)) => {
                HubKinematics { angle: speed * s.t, speed, acceleration: 0.0 }
            }
            // The inertia of a hub that sets off is a load too.
            (Drive::Prescribed(motion), None) => {
                let hub = self.recent.at(motion, s.time());
                HubKinematics { acceleration: self.loads.part() * hub.acceleration, ..hub }
            }
        };
        hub.angle += self.azimuth;
        hub
    }

    /// Kinetic energy, angular momentum and torque of beam and hub.
    fn totals(&mut self, s: &State, hub: &HubKinematics) -> Totals {
        self.coupling.inertia().totals(s, hub, &mut self.scratch) + self.coupling.extra_totals(s, hub)
    }

    /// The same, and the strain energy of the beam and of the hub's spring \[J\].
    fn totals_and_strain(&mut self, s: &State, hub: &HubKinematics) -> (Totals, f64) {
        if let Some(found) = self.measured.of(s, hub) {
            return found;
        }
        let found = (self.totals(s, hub), self.strain(s, hub));
        self.measured.keep(s, hub, found);
        found
    }

    /// Residual of the beam alone, without loads.
    fn beam_forces(&mut self, s: &State, hub: &HubKinematics, r: &mut [f64]) {
        self.coupling.inertia().residual(s, hub, &mut self.scratch, r);
        self.coupling.add_forces(s, hub, r);
    }

    /// Writes the border of a free hub into the tangent.
    fn write_border(&mut self, s: &State, hub: &HubKinematics, w: &Weights<'_>, out: &mut Storage<f64>) {
        let Drive::Free(free) = &self.hub.drive else { return };
        let border = &mut self.border;
        if self.held {
            // The hub's equation is δθ = 0.
            border.column.fill(0.0);
            border.row.fill(0.0);
            border.corner = w.q;
        } else {
            self.coupling.inertia().border(s, hub, w, &mut self.scratch, border);
            self.coupling.add_border(s, hub, w, border);
            self.loads.subtract_border(s, hub, w, border);
            let torque = free.actuator.torque(hub, s.time());
            border.corner -= w.q * torque.by_angle + w.v * torque.by_speed;
        }
        out.set_border(0, &border.column, &border.row, border.corner);
    }
}

/// The storage of a tangent of `n` velocities, for writing: what else is in it is zero.
fn cleared(out: &mut Matrix, n: usize) -> &mut Storage<f64> {
    let more = out.order() > n;
    let storage = out.begin();
    if more {
        storage.clear();
    }
    storage
}

impl<C: Coupling> Dynamics for HubBeam<C> {
    fn size(&self) -> Size {
        let n = self.coupling.fields().len() + self.hub.unknowns();
        Size { q: n, v: n, lambda: 0, memory: 0 }
    }

    fn structure(&self, _multipliers: usize) -> Structure {
        self.coupling.structure(self.hub.unknowns())
    }

    fn scales(&self) -> &[f64] {
        &self.scales
    }

    fn unknown(&self, i: usize) -> String {
        let hub = || (i == self.coupling.fields().len()).then(|| "angle of the hub".to_owned());
        self.coupling.fields().name(i).or_else(hub).unwrap_or_else(|| format!("unknown {i}"))
    }

    fn initial(&self) -> State {
        let mut state = State::zeros(self.size(), 0.0);
        if let Drive::Free(free) = &self.hub.drive {
            let n = self.coupling.fields().len();
            (state.q[n], state.v[n]) = (free.angle, self.steady.unwrap_or(free.speed));
        }
        state
    }

    fn is_affine(&self) -> bool {
        self.coupling.is_affine() && self.hub.unknowns() == 0 && self.loads.is_affine()
    }

    fn residual(&mut self, s: &State, r: &mut [f64]) {
        let hub = self.kinematics(s);
        let n = self.coupling.fields().len();
        match &self.hub.drive {
            Drive::Free(free) if !self.held => {
                let inertia = self.coupling.inertia();
                let torque = inertia.residual_and_torque(s, &hub, &mut self.scratch, r);
                let applied = free.actuator.torque(&hub, s.time()).value + self.loads.torque(s, &hub);
                r[n] = torque + self.coupling.extra_totals(s, &hub).torque - applied;
            }
            _ => {
                self.coupling.inertia().residual(s, &hub, &mut self.scratch, r);
                r[n..].fill(0.0);
            }
        }
        self.coupling.add_forces(s, &hub, r);
        self.loads.subtract_forces(s, &hub, r);
    }

    fn tangent(&mut self, s: &State, w: Weights<'_>, out: &mut Matrix) {
        let hub = self.kinematics(s);
        if self.is_affine() {
            let mut stamp = self.coupling.inertia().stamp(&w, &hub);
            stamp[5] = if w.q == 0.0 { 0.0 } else { self.loads.stamp(s, &hub) };
            if !out.holds(&stamp) {
                let storage = cleared(out, s.v.len());
                self.coupling.inertia().tangent(&w, &hub, storage);
                self.loads.subtract_tangent(s, &hub, &w, storage);
                out.set_stamp(Some(stamp));
            }
        } else {
            let storage = cleared(out, s.v.len());
            self.coupling.inertia().tangent(&w, &hub, storage);
            self.coupling.add_tangent(s, &hub, &w, storage);
            self.loads.subtract_tangent(s, &hub, &w, storage);
            self.write_border(s, &hub, &w, storage);
        }
    }

    fn corotate(&self, before: &State, now: &State, out: &mut Corotation) {
        self.coupling.corotate(before, now, out);
    }

    fn stiffness_forms(&mut self, s: &State, vectors: &[Vec<f64>]) -> Option<Vec<StiffnessForm>> {
        let (hub, w) = (self.kinematics(s), Weights::new(0.0, 0.0, 1.0));
        let mut rest = Matrix::new(&self.structure(0));
        let storage = rest.begin();
        self.coupling.inertia().tangent_without_strain(&hub, storage);
        self.coupling.add_unstrained_stiffness(s, &hub, storage);
        self.loads.subtract_tangent(s, &hub, &w, storage);
        self.write_border(s, &hub, &w, storage);
        let (mut forms, mut strains) = (StiffnessForm::of(&rest, vectors), vec![0.0; vectors.len()]);
        self.coupling.strain_forms(s, vectors, &mut strains);
        forms.iter_mut().zip(strains).for_each(|(form, strain)| form.value += strain);
        Some(forms)
    }
}

impl<C: Coupling> Events for HubBeam<C> {
    fn breaks(&self) -> &[Break] {
        &self.breaks
    }

    /// M Δv = −m_θ Δω with m_θ = ∂²T/∂q̇∂θ̇, the part of the residual that θ̈ makes.
    fn impulse(&mut self, s: &State, p: &mut [f64]) -> bool {
        let Drive::Prescribed(motion) = &self.hub.drive else { return false };
        let (before, after) = (motion.at(s.t.next_down()).speed, motion.at(s.t).speed);
        let hub = HubKinematics { acceleration: 0.0, ..self.kinematics(s) };
        let mut without = vec![0.0; p.len()];
        self.beam_forces(s, &hub, &mut without);
        self.beam_forces(s, &HubKinematics { acceleration: 1.0, ..hub }, p);
        p.iter_mut().zip(&without).for_each(|(p, without)| *p = -(after - before) * (*p - without));
        after != before
    }

    fn turning(&mut self, s: &State) -> f64 {
        self.kinematics(s).speed.abs()
    }

    /// ½ (ω⁺ + ω⁻) times the change of angular momentum; 0 for a free hub, which nothing turns.
    fn impulse_work(&mut self, before: &State, after: &State) -> f64 {
        let Drive::Prescribed(_) = self.hub().drive else { return 0.0 };
        let (first, last) = (self.kinematics(before), self.kinematics(after));
        let change = self.totals(after, &last).momentum - self.totals(before, &first).momentum;
        0.5 * (first.speed + last.speed) * change
    }
}

impl<C: Coupling> Steady for HubBeam<C> {
    fn set(&mut self, parameter: Parameter, value: f64) -> Result<(), NotSet> {
        match parameter {
            Parameter::Speed => self.steady = Some(value),
            Parameter::LoadFactor => self.loads.set_part(value),
            Parameter::Azimuth => self.azimuth = value,
        }
        Ok(())
    }

    fn hold(&mut self, held: bool) {
        self.held = held;
    }

    fn release(&mut self) {
        (self.steady, self.held, self.azimuth) = (None, false, 0.0);
        self.loads.set_part(1.0);
    }
}

impl<C: Coupling> Observed for HubBeam<C> {
    fn direction(&self, i: usize) -> Direction {
        let fields = self.coupling.fields();
        if i >= fields.len() {
            Direction::Hub
        } else if fields.indices().0.binary_search(&i).is_ok() {
            Direction::Axial
        } else {
            Direction::Chord
        }
    }

    fn energy(&mut self, s: &State) -> Energy {
        let hub = self.kinematics(s);
        let (totals, strain) = self.totals_and_strain(s, &hub);
        Energy { kinetic: totals.kinetic, strain, gravity: self.loads.gravity(s, &hub), contact: 0.0 }
    }

    fn power(&mut self, s: &State) -> Power {
        let hub = self.kinematics(s);
        self.power_with(s, &hub, None)
    }

    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        let hub = self.kinematics(s);
        let (totals, strain) = self.totals_and_strain(s, &hub);
        let gravity = self.loads.gravity(s, &hub);
        let energy = Energy { kinetic: totals.kinetic, strain, gravity, contact: 0.0 };
        (energy, self.power_with(s, &hub, Some(totals.torque)))
    }

    fn frames(&mut self, _body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        // The same stations are requested repeatedly.
        if !self.shown.iter().map(|s| &s.point.x).eq(stations) {
            self.shown = stations.iter().map(|&x| Station::new(self.coupling.fields(), x)).collect();
        }
        let angle = self.kinematics(s).angle;
        let (sin, cos) = libm::sincos(angle);
        let stations = &self.shown;
        let mut placements = vec![Placement::default(); stations.len()];
        self.coupling.placements(s, stations, &mut placements);
        for ((station, p), frame) in stations.iter().zip(&placements).zip(out) {
            let x = self.hub.radius + station.point.x + p.axial;
            let (sin_section, cos_section) = libm::sincos(angle + p.rotation);
            frame.position = Vec3([x * cos - p.deflection * sin, x * sin + p.deflection * cos, 0.0]);
            frame.rotation =
                Mat3([[cos_section, -sin_section, 0.0], [sin_section, cos_section, 0.0], [0.0, 0.0, 1.0]]);
        }
    }

    fn point_forces(&mut self, s: &State) -> Vec<PointForce> {
        let mut all = self.loads_at_points(s);
        all.push(self.driving_torque(s));
        all
    }

    fn line_forces(&mut self, s: &State) -> Vec<LineForce> {
        self.loads_along(s)
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.coupling.placements(s, &self.stations, &mut self.placements);
        let hub = self.kinematics(s);
        let (totals, strain) = self.totals_and_strain(s, &hub);
        let torque = match &self.hub.drive {
            Drive::Prescribed(_) => totals.torque - self.loads.torque(s, &hub) - self.contact_torque,
            Drive::Free(free) => free.actuator.torque(&hub, s.time()).value,
        };
        let gravity = self.loads.has_gravity().then(|| self.loads.gravity(s, &hub));
        let target = self.hub.target(s.time());

        if let (Some((tip, stations)), Some((at_tip, placements))) =
            (self.stations.split_last(), self.placements.split_last())
        {
            tip.observe(at_tip, sink);
            stations.iter().zip(placements).for_each(|(station, placement)| station.observe(placement, sink));
        }
        let mut put = |value, role, name, unit: &'static str, meaning| {
            sink.put(value, || Channel::new(role, name, unit, meaning));
        };
        let controlled = target.is_some();
        let [of_angle, of_speed] =
            if controlled { [Role::Primary, Role::Secondary] } else { [Role::Secondary, Role::Primary] };
        put(hub.angle, of_angle, "hub.angle", "rad", "angle of the hub");
        put(hub.speed, of_speed, "hub.speed", "rad/s", "angular speed of the hub");
        put(
            hub.acceleration,
            Role::Secondary,
            "hub.acceleration",
            "rad/s^2",
            "angular acceleration of the hub",
        );
        let meaning = "torque on the hub: needed by its motion, or driving it";
        put(torque, Role::Primary, "hub.torque", "N*m", meaning);
        let meaning = "angular momentum of beam and hub about the axis";
        put(totals.momentum, Role::Secondary, "hub.angular_momentum", "kg*m^2/s", meaning);
        let energy = |kind, name, meaning| Channel::new(Role::Energy, name, "J", meaning).with_kind(kind);
        let meaning = "kinetic energy of beam and hub";
        sink.put(totals.kinetic, || energy(Kind::KineticEnergy, "energy.kinetic", meaning));
        sink.put(strain, || energy(Kind::StrainEnergy, "energy.strain", "strain energy of the beam"));
        if let Some(target) = target {
            let meaning = "angle that the controller of the hub wants";
            sink.put(target, || Channel::new(Role::Secondary, "hub.target", "rad", meaning));
        }
        if let Some(gravity) = gravity {
            let meaning = "potential energy of gravity on the beam, zero at the height of the axis";
            sink.put(gravity, || energy(Kind::Real, "energy.gravity", meaning));
        }
        self.section_forces.observe(&self.coupling, s, sink);
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.coupling.admissible(s)?;
        self.lost_inertia(s, 0.0).map_or(Ok(()), Err)
    }

    fn cautions(&self, peaks: &[f64]) -> Vec<String> {
        let share = self.small_share.map(|share| {
            format!(
                "the effective inertia of the free hub is {share:.1e} of the inertia of hub and beam: the \
                 {}-order coupling keeps its kinetic energy positive only while foreshortening takes less than that, and \
                 stops the run beyond; give the hub more inertia, or use the high-order or the exact coupling",
                self.coupling.name()
            )
        });
        share.into_iter().chain(self.coupling.cautions(peaks.first().copied().unwrap_or(0.0))).collect()
    }

    fn explain(&mut self, s: &State) -> Option<Limit> {
        if let Some(lost) = self.lost_inertia(s, VANISHING) {
            return Some(lost);
        }
        let speed = self.kinematics(s).speed.abs();
        let critical = self.coupling.critical_speed(speed)?;
        let since = match &self.hub.drive {
            Drive::Prescribed(motion) if s.t > 0.0 && self.steady.is_none() => {
                Some(motion.first_time_above(critical, s.t))
            }
            _ => None,
        };
        Some(match self.coupling.name() {
            "zeroth" => Limit::Softened { critical, since },
            _ => Limit::Overpowered { critical, since },
        })
    }
}

impl<C: Coupling> HubBeam<C> {
    /// Where a free hub has at most this part of its inertia left.
    fn lost_inertia(&mut self, s: &State, part: f64) -> Option<Limit> {
        if self.held {
            return None;
        }
        let watch = self.hub_inertia.as_mut()?;
        let (left, start) = watch.at_most(part, (self.coupling.inertia(), &mut self.scratch), s)?;
        Some(Limit::HubInertia { coupling: self.coupling.name(), start, left })
    }

    /// Strain energy of the beam and of the hub's spring.
    fn strain(&mut self, s: &State, hub: &HubKinematics) -> f64 {
        let spring = match &self.hub.drive {
            Drive::Prescribed(_) => 0.0,
            Drive::Free(free) => free.actuator.spring_energy(hub.angle),
        };
        self.coupling.strain(s) + spring + self.loads.spring(s, hub)
    }
}

//! Energies, power and recorded quantities.

use super::constants::nearest_turn;
use super::force::Interaction;
use super::joint::Drive;
use super::line_load::{LineDistribution, LineLoad};
use super::reason;
use super::row::Row;
use super::system::Multibody;
use crate::linalg::{Mat3, Vec3};
use crate::profile::HubKinematics;
use crate::system::{
    Direction, Energy, Frame, Limit, LineForce, Observed, PointForce, Power, Sink, Slender, State,
};

/// Size of a row that was left out, over the length of the system, at which it no longer follows from the others; and over the
/// largest of the rows that are kept.
const DEPARTED: [f64; 2] = [1e-6, 100.0];

impl Multibody {
    /// Momentum and angular momentum about the origin of all bodies and beams, inertial axes [kg·m/s, kg·m²/s].
    pub fn momenta(&mut self, s: &State) -> [Vec3; 2] {
        self.place(s);
        let constants = &self.constants;
        let mut sums = [Vec3::ZERO; 2];
        for (body, &place) in constants.model.bodies.iter().zip(&constants.place) {
            let placed = &self.placed[place];
            let linear = body.mass * placed.velocity;
            let own = placed.rotation * (body.inertia * placed.spin);
            sums[0] += linear;
            sums[1] = sums[1] + own + placed.position.cross(linear);
        }
        for (of, &[i, j]) in constants.model.beams.iter().zip(&constants.beams) {
            let [linear, angular] = of.beam.momenta(&s.q[i..], &s.v[j..]);
            sums = [sums[0] + linear, sums[1] + angular];
        }
        sums
    }

    /// Energies at a state for which bodies and markers are placed.
    pub(super) fn energies(&self, s: &State) -> Energy {
        let constants = &*self.constants;
        let mut energy = Energy::default();
        for (body, &place) in constants.model.bodies.iter().zip(&constants.place) {
            let placed = &self.placed[place];
            let spin = placed.spin.dot(body.inertia * placed.spin);
            energy.kinetic += 0.5 * (body.mass * placed.velocity.dot(placed.velocity) + spin);
            energy.gravity -= self.part * body.mass * constants.model.gravity.dot(placed.position);
        }
        for (of, &[i, j]) in constants.model.beams.iter().zip(&constants.beams) {
            energy.kinetic += of.beam.kinetic_energy(&s.q[i..], &s.v[j..]);
            energy.strain += of.beam.strain_energy(&s.q[i..]);
            energy.gravity -= self.part * constants.model.gravity.dot(of.beam.first_moment(&s.q[i..]));
        }
        for (k, spring) in constants.model.springs.iter().enumerate() {
            let (a, b) = self.spring_ends(k);
            energy.strain += spring.energy(a, b);
        }
        for k in 0..constants.model.joints.len() {
            if let (Drive::Actuated(actuator), Some((position, _))) =
                (&constants.model.joints[k].drive, self.coordinate(s, k))
            {
                energy.strain += actuator.spring_energy(position);
            }
        }
        energy
    }

    /// Coordinate of joint `k` and its rate.
    pub(super) fn coordinate(&self, s: &State, k: usize) -> Option<(f64, f64)> {
        let coordinate = self.constants.coordinates[k]?;
        let (a, b) = self.ends(k);
        // A prescribed angle says its turn by itself.
        let prescribed = matches!(self.constants.model.joints[k].drive, Drive::Prescribed(_));
        let turn = |angle: f64| if prescribed { nearest_turn(angle, self.motions[k].angle) } else { angle };
        let motion = coordinate.motion(a, b, self.constants.angle[k].map(|i| turn(s.q[i])));
        Some((motion.position, motion.rate))
    }

    /// Largest |g| of the rows that are kept, over the unit of each.
    fn largest_of_kept(&self, unit: impl Fn(Row) -> f64) -> f64 {
        self.constants.rows.iter().fold(0.0, |largest, (joint, row)| {
            let (a, b) = self.ends(*joint);
            largest.max(row.value(a, b, &self.motions[*joint]).g.abs() / unit(*row))
        })
    }

    fn powers(&mut self, s: &State) -> Power {
        let mut power = Power::default();
        for (law, sampled) in self.constants.model.line_laws.iter().zip(&mut self.sampled) {
            let [i, j] = self.constants.beams[law.beam];
            let of_law = self.part * sampled.power(law.law.as_ref(), s.time(), [&s.q[i..], &s.v[j..]]);
            if law.law.dissipates() {
                power.dissipated -= of_law;
            } else {
                power.loads += of_law;
            }
        }
        let constants = &*self.constants;
        let model = &constants.model;
        for (body, &place) in model.bodies.iter().zip(&constants.place) {
            let placed = &self.placed[place];
            let spin = placed.spin.dot(body.inertia * placed.spin);
            power.dissipated += body.damping * (body.mass * placed.velocity.dot(placed.velocity) + spin);
        }
        for (of, &[i, j]) in model.beams.iter().zip(&constants.beams) {
            // −β M v does the power −2 β T.
            power.dissipated += 2.0 * of.damping * of.beam.kinetic_energy(&s.q[i..], &s.v[j..]);
            power.dissipated += of.beam.viscous_power(&s.q[i..], &s.v[j..]);
        }
        for (load, on) in model.line_loads.iter().zip(&constants.lines) {
            let [i, j] = constants.beams[load.beam];
            let (beam, force) = (&model.beams[load.beam].beam, load.at(s.time(), self.part));
            power.loads += beam.line_power(on, [&s.q[i..], &s.v[j..]], force, load.follows());
        }
        for (i, (joint, row)) in constants.rows.iter().enumerate() {
            let (a, b) = self.ends(*joint);
            power.drive -= s.lambda[i] * row.value(a, b, &self.motions[*joint]).by_time;
        }
        for (k, joint) in model.joints.iter().enumerate() {
            if let (Drive::Actuated(actuator), Some((angle, speed))) = (&joint.drive, self.coordinate(s, k)) {
                let motion = HubKinematics { angle, speed, acceleration: 0.0 };
                power.drive += actuator.driving_torque(&motion, s.time()) * speed;
                power.dissipated += actuator.damping * speed * speed;
            }
        }
        for (k, spring) in model.springs.iter().enumerate() {
            let (a, b) = self.spring_ends(k);
            power.dissipated += spring.dissipation(a, b);
        }
        let mut work = Interaction::new();
        for (k, load) in model.loads.iter().enumerate() {
            work.clear(false);
            let b = self.load_end(k);
            load.interact(b, (s.time(), self.part), &mut work);
            power.loads += work.wrench[2].dot(b.velocity) + work.wrench[3].dot(b.spin);
        }
        power
    }
}

impl Observed for Multibody {
    fn energy(&mut self, s: &State) -> Energy {
        self.place(s);
        self.energies(s)
    }

    fn power(&mut self, s: &State) -> Power {
        self.place(s);
        self.powers(s)
    }

    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        self.place(s);
        (self.energies(s), self.powers(s))
    }

    /// `body` numbers the bodies, and behind them the beams.
    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        self.place(s);
        let constants = &self.constants;
        if let (Some(of), Some(place)) = (constants.model.bodies.get(body), constants.place.get(body)) {
            out.fill(self.placed[*place].frame(of.centre));
        }
        let beam = body.checked_sub(constants.place.len());
        if let Some((of, [i, _])) =
            beam.and_then(|k| constants.model.beams.get(k).zip(constants.beams.get(k)))
        {
            for (out, station) in out.iter_mut().zip(stations) {
                *out = of.frame(&s.q[*i..], *station);
            }
        }
    }

    fn point_forces(&mut self, s: &State) -> Vec<PointForce> {
        self.place(s);
        let model = &self.constants.model;
        let joints = model.joints.iter().map(|joint| &joint.name);
        let mut names = joints
            .chain(model.springs.iter().map(|spring| &spring.name))
            .chain(model.loads.iter().map(|load| &load.name));
        let mut all = Vec::new();
        self.interactions(s, false, |from, at, work| {
            let name = names.next().cloned().unwrap_or_default();
            let [.., force, moment] = work.wrench;
            all.push(PointForce { name, place: at.position, force, moment, transmitted: from.is_some() });
        });
        all
    }

    fn line_forces(&mut self, s: &State) -> Vec<LineForce> {
        let constants = &self.constants;
        let along = |(load, on): (&LineLoad, &LineDistribution)| {
            let ([q, _], beam) = (constants.beams[load.beam], &constants.model.beams[load.beam]);
            let components = load.at(s.time(), self.part);
            let at = |station: &f64| {
                let frame = beam.frame(&s.q[q..], *station);
                let axes = if load.follows() { frame.rotation } else { Mat3::IDENTITY };
                let share = load.distribution.as_ref().map_or(1.0, |f| f.value(*station));
                [frame.position, axes * (share * components)]
            };
            LineForce { name: load.name.clone(), points: on.stations.iter().map(at).collect() }
        };
        constants.model.line_loads.iter().zip(&constants.lines).map(along).collect()
    }

    /// The first beam.
    fn drawn(&self) -> usize {
        if self.constants.beams.is_empty() { 0 } else { self.constants.place.len() }
    }

    fn shares(&self, s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        self.shares_about(s, None, [x, mx], add);
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.put(s, sink);
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.place(s);
        for (number, (of, &[i, _])) in
            self.constants.model.beams.iter().zip(&self.constants.beams).enumerate()
        {
            self.bending.enter(number, &of.beam, &s.q[i..]);
            if let Some((node, stretch)) = of.beam.compressed(&s.q[i..]) {
                return Err(Limit::Compressed { beam: of.name.clone(), stretch, node });
            }
            if let Some([from, to]) = of.beam.twisted(&s.q[i..]) {
                return Err(Limit::Twisted { beam: of.name.clone(), from, to });
            }
        }
        // The row g = sin(θ − θ(t)) is zero half a turn away too.
        for (k, joint) in self.constants.model.joints.iter().enumerate() {
            let (a, b) = self.ends(k);
            let motion = &self.motions[k];
            let (sin, cos) = libm::sincos(motion.angle);
            let along = (cos * a.axis(0) + sin * a.axis(1)).dot(b.axis(0));
            let drives = matches!(joint.drive, Drive::Prescribed(_)) && self.constants.angle[k].is_some();
            if drives && along < 0.0 {
                return Err(Limit::HalfTurn { joint: joint.name.clone(), angle: motion.angle });
            }
        }
        let unit = |row: Row| if row.is_length() { self.constants.scales[0] } else { 1.0 };
        for (of, row, value) in self.values_of_dropped() {
            let size = value.g.abs() / unit(row);
            if size > DEPARTED[0] && size > DEPARTED[1] * self.largest_of_kept(unit) {
                let unit = if row.is_length() { "m" } else { "rad" };
                return Err(Limit::LeftOut { row: of.following(), violation: value.g.abs(), unit });
            }
        }
        for (k, spring) in self.constants.model.springs.iter().enumerate() {
            let (a, b) = self.spring_ends(k);
            if a.position == b.position && spring.length > 0.0 {
                return Err(Limit::SpringWithoutLength { spring: spring.name.clone() });
            }
        }
        Ok(())
    }

    fn explain(&mut self, s: &State) -> Option<Limit> {
        reason::singular(self, s)
    }

    fn slender(&self) -> Option<Slender> {
        reason::slender(&self.constants.model)
    }

    fn cautions(&self, _peaks: &[f64]) -> Vec<String> {
        let parts = reason::without_inertia(&self.constants).into_iter();
        let parts = parts
            .chain(reason::not_held(&self.constants.model))
            .chain(reason::rounded(&self.constants.model));
        let bending = self.bending.caution(|beam| &self.constants.model.beams[beam].name);
        self.changes.iter().cloned().chain(parts).chain(bending).collect()
    }
}

//! What a model with contacts shows of itself.

use super::{Contacting, Placed};
use crate::contact::law::{Contact, Law};
use crate::contact::points::Points;
use crate::system::{
    Channel, ContactInfo, ContactSample, Direction, Dynamics, Energy, Events, Frame, Kind, Limit, LineForce,
    Mode, Observed, PointForce, Power, Role, Sink, Slender, State,
};

impl<S: Points + Dynamics + Events + Observed> Contacting<S> {
    /// Tells the model the forces on its points.
    fn set_forces(&mut self, s: &State) {
        self.inner.begin_forces();
        for placed in &self.contacts {
            let Some(near) = placed.acting(&mut self.inner, s) else { continue };
            let force = placed.forces(&near, s, self.memory).vector(&near.surface);
            self.inner.add_force(placed.contact.point, s, force);
        }
    }

    /// Energy stored in contacts.
    fn stored(&mut self, s: &State) -> f64 {
        let mut stored = 0.0;
        self.each_acting(s, |placed, near, _| {
            if let Law::Force(law) = &placed.contact.law {
                stored += law.stored(-near.surface.gap);
            }
        });
        stored
    }

    /// Adds the power of the contacts: moving obstacles and the prescribed motion of the model drive, friction and damping lose.
    fn add_power(&mut self, s: &State, power: &mut Power) {
        self.each_acting(s, |placed, near, forces| {
            let force = forces.vector(&near.surface);
            power.drive += force.dot(near.surface.velocity - near.motion.prescribed);
            power.contact += placed.lost(near, forces);
        });
    }
}

impl<S: Points + Dynamics + Events + Observed> Observed for Contacting<S> {
    fn energy(&mut self, s: &State) -> Energy {
        let energy = self.inner.energy(s);
        Energy { contact: energy.contact + self.stored(s), ..energy }
    }

    fn power(&mut self, s: &State) -> Power {
        let mut power = self.inner.power(s);
        self.add_power(s, &mut power);
        power
    }

    fn energy_and_power(&mut self, s: &State) -> (Energy, Power) {
        let (mut energy, mut power) = self.inner.energy_and_power(s);
        energy.contact += self.stored(s);
        self.add_power(s, &mut power);
        (energy, power)
    }

    fn frames(&mut self, body: usize, s: &State, stations: &[f64], out: &mut [Frame]) {
        self.inner.frames(body, s, stations, out);
    }

    fn observe(&mut self, s: &State, sink: &mut Sink<'_>) {
        self.set_forces(s);
        self.inner.observe(s, sink);
        let mut stored = None;
        let directions = self.inner.directions();
        for placed in &self.contacts {
            let near = placed.proximity(&mut self.inner, s);
            let forces = placed.forces(&near, s, self.memory);
            let Contact { name, law, point, .. } = &placed.contact;
            let channel = |quantity, unit: &'static str, what| {
                let meaning = format!("{what} of the contact {name}");
                Channel::new(Role::Secondary, format!("{name}.{quantity}"), unit, meaning)
            };
            sink.put(near.surface.gap, || channel("gap", "m", "gap").with_kind(Kind::Gap));
            // −0 of a contact that is open becomes 0.
            sink.put(forces.normal + 0.0, || {
                channel("force", "N", "normal force").with_kind(Kind::NonNegative)
            });
            if law.has_friction() {
                let [first, second] = forces.friction;
                if directions == 1 {
                    sink.put(first + 0.0, || channel("friction", "N", "friction force"));
                } else {
                    let [t1, t2] = near.surface.tangents;
                    let force = self.inner.frame(*point, s).rotation * (first * t1 + second * t2);
                    let force = force.0.map(|x| x + 0.0);
                    let names = ["friction.x", "friction.y", "friction.z"];
                    sink.put_all(force, names, |name| channel(name, "N", "friction force"));
                }
            }
            if let Some(station) = near.station {
                sink.put(station, || channel("station", "m", "arc length of the nearest point"));
            }
            if let Law::Force(force) = law {
                *stored.get_or_insert(0.0) += force.stored(-near.surface.gap);
            }
        }
        if let Some(stored) = stored {
            let channel = || Channel::new(Role::Energy, "energy.contact", "J", "energy stored in contacts");
            sink.put(stored, channel);
        }
    }

    fn contacts(&mut self, s: &State) -> Vec<ContactInfo> {
        let (mut all, indicators) = (self.inner.contacts(s), self.indicators);
        self.each(s, |placed, near, _| {
            let (row, indicator) = match placed.contact.law {
                Law::Constraint { .. } => (Some(placed.place), None),
                Law::Force(_) => (None, Some(indicators + placed.place)),
            };
            let (gap, rate) = (near.surface.gap, near.rate);
            let name = placed.contact.name.clone();
            let speed = near.motion.velocity.norm() + near.surface.velocity.norm();
            let (friction, flat) = (placed.friction.clone(), near.surface.curvatures == [0.0; 2]);
            all.push(ContactInfo { name, row, friction, indicator, gap, rate, speed, flat });
        });
        all
    }

    fn contact_samples(&mut self, s: &State, out: &mut Vec<ContactSample>) {
        self.inner.contact_samples(s, out);
        self.each(s, |placed, near, forces| {
            let (place, gap) = (near.motion.position, near.surface.gap);
            let lost = placed.lost(near, forces);
            out.push(ContactSample { place, gap, rate: near.rate, force: forces.normal + 0.0, lost });
        });
    }

    fn point_forces(&mut self, s: &State) -> Vec<PointForce> {
        let mut all = self.inner.point_forces(s);
        for placed in &self.contacts {
            let near = placed.proximity(&mut self.inner, s);
            let force = placed.forces(&near, s, self.memory).vector(&near.surface);
            let Frame { position, rotation: axes } = self.inner.frame(placed.contact.point, s);
            let touching = near.motion.position - near.motion.radius * near.surface.normal;
            let name = placed.contact.name.clone();
            let (place, force) = (position + axes * touching, axes * force);
            all.push(PointForce { name, place, force, ..PointForce::default() });
        }
        all
    }

    fn line_forces(&mut self, s: &State) -> Vec<LineForce> {
        self.inner.line_forces(s)
    }

    fn direction(&self, i: usize) -> Direction {
        self.inner.direction(i)
    }

    fn shares(&self, s: &State, x: &[f64], mx: &[f64], add: &mut dyn FnMut(Direction, f64)) {
        self.inner.shares(s, x, mx, add);
    }

    fn drawn(&self) -> usize {
        self.inner.drawn()
    }

    fn admissible(&mut self, s: &State) -> Result<(), Limit> {
        self.inner.admissible(s)
    }

    fn slender(&self) -> Option<Slender> {
        self.inner.slender()
    }

    fn explain(&mut self, s: &State) -> Option<Limit> {
        let of_row = |placed: &&Placed| matches!(placed.contact.law, Law::Constraint { .. });
        let closed = self.contacts.iter().filter(of_row).filter(|placed| s.mode[placed.place] != Mode::Open);
        let contacts: Vec<String> = closed.map(|placed| placed.contact.name.clone()).collect();
        let own = self.inner.explain(s);
        own.or_else(|| (contacts.len() > 1).then_some(Limit::DependentContacts { contacts }))
    }

    fn cautions(&self, peaks: &[f64]) -> Vec<String> {
        self.inner.cautions(peaks)
    }
}

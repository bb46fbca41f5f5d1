//! What a model with contacts shows of itself.

use super::{Contacting, Law, Placed};
use crate::contact::points::Points;
use crate::system::{
    Channel, Direction, Dynamics, Energy, Events, Frame, Mode, Observed, Power, Pressing, State, Touch,
};

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

    fn channels(&self) -> &[Channel] {
        &self.channels
    }

    fn record(&mut self, s: &State, out: &mut [f64]) {
        let (own, contacts) = out.split_at_mut(self.recorded.min(out.len()));
        self.set_forces(s);
        self.inner.record(s, own);
        let mut next = contacts.iter_mut();
        let mut write = |x: f64| next.next().into_iter().for_each(|out| *out = x);
        let (mut stored, mut stores) = (0.0, false);
        let directions = self.inner.directions();
        self.each(s, |placed, touch, forces| {
            write(touch.surface.gap);
            // −0 of a contact that is open becomes 0.
            write(forces.normal + 0.0);
            let force = match &placed.contact.law {
                Law::Constraint { .. } => None,
                Law::Force(force) => Some(force),
            };
            if placed.contact.law.rubs() {
                let [first, second] = forces.friction;
                if directions == 1 {
                    write(first + 0.0);
                } else {
                    let [t1, t2] = touch.surface.tangents;
                    (0..3).for_each(|k| write(first * t1[k] + second * t2[k] + 0.0));
                }
            }
            touch.station.into_iter().for_each(&mut write);
            stores |= force.is_some();
            stored += force.map_or(0.0, |force| force.stored(-touch.surface.gap));
        });
        if stores {
            write(stored);
        }
    }

    fn contacts(&mut self, s: &State) -> Vec<Touch> {
        let (mut all, indicators) = (self.inner.contacts(s), self.indicators);
        self.each(s, |placed, touch, _| {
            let (row, indicator) = match placed.contact.law {
                Law::Constraint { .. } => (Some(placed.place), None),
                Law::Force(_) => (None, Some(indicators + placed.place)),
            };
            let (gap, rate) = (touch.surface.gap, touch.rate);
            let name = placed.contact.name.clone();
            all.push(Touch { name, row, friction: placed.friction.clone(), indicator, gap, rate });
        });
        all
    }

    fn pressing(&mut self, s: &State, out: &mut Vec<Pressing>) {
        self.inner.pressing(s, out);
        self.each(s, |placed, touch, forces| {
            let (place, gap) = (touch.motion.position, touch.surface.gap);
            let lost = placed.lost(touch, forces);
            out.push(Pressing { place, gap, rate: touch.rate, force: forces.normal + 0.0, lost });
        });
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

    fn admissible(&mut self, s: &State) -> Result<(), String> {
        self.inner.admissible(s)
    }

    fn explain(&mut self, s: &State) -> Option<String> {
        let of_row = |placed: &&Placed| matches!(placed.contact.law, Law::Constraint { .. });
        let closed = self.contacts.iter().filter(of_row).filter(|placed| s.mode[placed.place] != Mode::Open);
        let closed: Vec<&str> = closed.map(|placed| placed.contact.name.as_str()).collect();
        let own = self.inner.explain(s);
        let many = || {
            let names = closed.join(", ");
            format!(
                "the rigid contacts {names} are closed at once, and their forces may follow from each other, as those of four \
                 corners of a body do: use `moreau-jean` or `nonsmooth-generalized-alpha`, fewer contacts, or a continuous contact force"
            )
        };
        own.or_else(|| (closed.len() > 1).then(many))
    }

    fn cautions(&self, peaks: &[f64]) -> Vec<String> {
        self.inner.cautions(peaks.get(..self.recorded).unwrap_or(&[]))
    }
}

//! Contact of a tip without mass: no law of restitution, and no loss.
#![allow(missing_docs, clippy::unwrap_used)]

use super::falling_pendulum::{Watch, hub, run, section, with_ground};
use flexion::analysis::transient::{Ending, Plan};
use flexion::basis::{Field, Hermite, Modes};
use flexion::contact::Law;
use flexion::hub_beam::{ExactCoupling, Fields, HighCoupling};
use flexion::integrator::{GeneralizedAlpha, Integrator, Radau, Tolerance};
use flexion::system::System;

const STOP: Law = Law::Constraint { restitution: 0.0, friction: 0.0 };

fn modes(count: usize) -> Box<dyn System> {
    let fields = Fields::new(
        1.0,
        Box::new(Modes::new(1.0, count, Field::Axial).unwrap()),
        Box::new(Modes::with_residual(1.0, count).unwrap()),
        &[],
    );
    let fields = fields.with_massless_tip().unwrap();
    Box::new(with_ground(HighCoupling::new(fields, &section(), &hub()).unwrap(), STOP))
}

fn elements(count: usize) -> Box<dyn System> {
    let mesh = |field| Box::new(Hermite::new(1.0, count, field).unwrap());
    let fields = Fields::new(1.0, mesh(Field::Axial), mesh(Field::Transverse), &[]);
    let fields = fields.with_massless_tip().unwrap();
    Box::new(with_ground(HighCoupling::new(fields, &section(), &hub()).unwrap(), STOP))
}

fn exact(count: usize) -> Box<dyn System> {
    Box::new(with_ground(ExactCoupling::with_massless_tip(1.0, count, &section(), &hub()).unwrap(), STOP))
}

#[test]
fn probe() {
    for (name, system) in [
        ("modes 3", modes(3)),
        ("modes 5", modes(5)),
        ("elements 6", elements(6)),
        ("exact 6", exact(6)),
        ("exact 12", exact(12)),
    ] {
        let mut system = system;
        let mut method = Radau::new(Tolerance::uniform(1e-8)).unwrap();
        let plan = Plan { end: 0.6, step: None, longest_step: None, sample: 0.001 };
        let (watch, state, ending) = run(system.as_mut(), &mut method, &plan);
        println!("{name} {ending:?}"); if watch.energies.is_empty() { continue; }
        let (first, last) = (watch.energies[0].total(), watch.energies.last().unwrap().total());
        println!(
            "{name}: {ending:?} t {} events {} energy {first} {last} counters {:?}",
            state.t,
            watch.events.len(),
            method.counters()
        );
        for e in watch.events.iter().take(6) {
            println!("   {e:?}");
        }
    }
}

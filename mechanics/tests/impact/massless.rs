//! Contact of a tip without mass: no law of restitution, and no loss.
#![allow(missing_docs, clippy::unwrap_used)]

use super::falling_pendulum::{hub, run, section, with_ground};
use flexion::analysis::transient::{Ending, EventKind, Plan};
use flexion::basis::{Field, Hermite, Modes};
use flexion::contact::Law;
use flexion::hub_beam::{Fields, HighCoupling};
use flexion::integrator::{Radau, Tolerance};
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

/// Impulses vanish, nothing is lost, and the energy at the end is that of the start to the error of the method.
#[test]
fn a_tip_without_mass_bounces_without_impulses_and_keeps_the_energy() {
    for (name, mut system, bound) in [("3 modes", modes(3), 1e-6), ("6 elements", elements(6), 1e-5)] {
        let method = Radau::new(Tolerance { relative: 1e-10, absolute: 1e-11 }).unwrap();
        let plan = Plan::new(0.41, 0.001);
        let (watch, _, ending) = run(system.as_mut(), &method, &plan);
        assert_eq!(ending, Ending::Finished, "{name}");
        let mut touches = 0;
        for event in &watch.events {
            if let EventKind::Impact { impulses, lost, .. } = &event.kind {
                touches += 1;
                assert!(impulses[0].abs() < 1e-12 && lost.abs() < 1e-12, "{name}: {event:?}");
            }
        }
        assert!(touches >= 2, "{name}: {touches}");
        let first = watch.energies[0].total();
        let off = watch.energies.iter().fold(0.0_f64, |m, e| m.max((e.total() / first - 1.0).abs()));
        assert!(off < bound, "{name}: {off:e}");
    }
}

#[test]
fn a_basis_without_a_function_for_the_tip_alone_is_refused() {
    let modes = |field| Box::new(Modes::new(1.0, 2, field).unwrap());
    let fields = Fields::new(1.0, modes(Field::Axial), modes(Field::Transverse), &[]);
    assert!(fields.with_massless_tip().unwrap_err().to_string().contains("moves the tip alone"));
}

//! First integrals of the high-order coupling over long runs.
#![allow(missing_docs, clippy::unwrap_used)]

use super::integrators::drive;
use flexion::basis::{Field, Modes};
use flexion::drive::Actuator;
use flexion::hub_beam::{Coupling, Drive, Fields, FreeHub, HighCoupling, Hub, HubBeam};
use flexion::integrator::RungeKutta;
use flexion::profile::Constant;
use flexion::section::{Resultants, Uniform};
use flexion::system::{Dynamics, Observed, System};
use std::sync::Arc;

const LENGTH: f64 = 2.0;

/// A beam on a hub that nothing drives.
fn system() -> HubBeam<HighCoupling> {
    let resultants =
        Resultants { mass: 1.2, axial_stiffness: 200.0, bending_stiffness: 8.0, ..Default::default() };
    let section = Uniform::from_resultants(resultants).unwrap();
    let free = FreeHub {
        angle: 0.0,
        speed: 1.5,
        actuator: Actuator {
            torque: Arc::new(Constant::new(0.0).unwrap()),
            damping: 0.0,
            stiffness: 0.0,
            rest_angle: 0.0,
            controller: None,
        },
    };
    let hub = Hub { radius: 0.2, inertia: 3.0, drive: Drive::Free(free) };
    let fields = Fields::new(
        LENGTH,
        Box::new(Modes::new(LENGTH, 1, Field::Axial).unwrap()),
        Box::new(Modes::new(LENGTH, 2, Field::Transverse).unwrap()),
        &[],
    );
    let coupling = HighCoupling::new(fields, &section, &hub).unwrap();
    HubBeam::new(hub, coupling, &[])
}

/// Energy and angular momentum of a free hub with a beam set swinging by a fifth of its length.
#[test]
fn energy_and_angular_momentum_stay_for_twenty_seconds() {
    let mut system = system();
    let channels = system.channels().to_vec();
    let channel = |name: &str| channels.iter().position(|c| c.name == name).unwrap();
    let (momentum, tip) = (channel("hub.angular_momentum"), channel("tip.deflection"));
    let mut from = system.initial();
    let first = system.coupling().fields().indices().1[0];
    from.v[first] = 1.0;
    let mut row = vec![0.0; channels.len()];
    let mut measure = |system: &mut dyn System, s: &_| {
        system.record(s, &mut row);
        (system.energy(s).total(), row[momentum], row[tip])
    };
    let (energy, angular, _) = measure(&mut system, &from);
    let mut largest: f64 = 0.0;
    let mut drift = |steps: usize| {
        let mut off = (0.0_f64, 0.0_f64);
        // Explicit: no tolerance of an iteration leaves its mark on every step.
        let method = RungeKutta::new();
        drive::fixed(&method, &mut system, from.clone(), 20.0, steps, |_, system, _, to| {
            let (e, h, tip) = measure(system, to);
            off = (off.0.max((e / energy - 1.0).abs()), off.1.max((h / angular - 1.0).abs()));
            largest = largest.max(tip.abs());
        })
        .unwrap();
        off
    };
    let (coarse, fine) = (drift(8000), drift(32_000));
    // What is left is the method's, of order 4 in a step, 5 in the energy.
    assert!(coarse.0 / fine.0 > 200.0, "{coarse:?} {fine:?}");
    assert!(fine.0 < 1e-10 && fine.1 < 1e-10, "energy, angular momentum: {fine:?}");
    assert!(largest > 0.2 * LENGTH, "{largest}");
}

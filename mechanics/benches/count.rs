//! `count COUPLING INTEGRATOR ELEMENTS STEPS`: so many steps of the spin-up, for `benches/count.sh`.
//! With COUPLING = `solver`, so many factorisations and solutions. With INTEGRATOR = `modes`, so often the ten lowest modes at
//! 4 rad/s; with `campbell`, so many speeds up to that of a diagram of ten modes, on one thread. With `slender` or `shear` so often the
//! forces of a beam in space of so many elements, with INTEGRATOR = `forces`, or its tangent, with `tangent`.
#![allow(missing_docs, clippy::unwrap_used)]

mod spin_up;

use flexion::analysis::campbell::{HubState, Plan, campbell};
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate;
use std::hint::black_box;

/// Twice the steps of `benches/count.sh`.
const COPIES: usize = 200;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let [coupling, integrator, elements, steps] = arguments.as_slice() else { return };
    let (elements, steps): (usize, usize) = (elements.parse().unwrap(), steps.parse().unwrap());
    if ["slender", "shear"].contains(&coupling.as_str()) {
        spin_up::evaluate(coupling == "shear", integrator == "tangent", elements, steps);
    } else if coupling == "solver" {
        let (tangent, rhs) = spin_up::equations(elements);
        // As many copies whatever the number of steps: the difference of two counts is free of the copying.
        let mut copies: Vec<_> = (0..COPIES.max(steps)).map(|_| (tangent.clone(), rhs.clone())).collect();
        for (a, x) in copies.iter_mut().take(steps) {
            a.factor().unwrap();
            a.solve(x);
        }
        black_box(copies);
    } else if integrator == "modes" {
        let mut system = spin_up::system(coupling, elements);
        let mut state = system.initial();
        rotate(system.as_mut(), &mut state, 0.0, 4.0, &mut || true).unwrap();
        for _ in 0..steps {
            black_box(modes(system.as_mut(), &state, 10, &[]).unwrap());
        }
    } else if integrator == "campbell" {
        let plan = Plan {
            speeds: (0..steps).map(|i| 4.0 * (i + 1) as f64 / steps as f64).collect(),
            count: 10,
            stations: Vec::new(),
            hub: HubState::Held,
            revolutions: 4,
        };
        black_box(campbell(spin_up::system(coupling, elements), &plan, |_| true).unwrap());
    } else {
        let mut run = spin_up::Run::new(coupling, elements, integrator);
        run.steps(steps);
        black_box(&run.from);
        eprintln!("{:?}", run.integrator.counters());
    }
}

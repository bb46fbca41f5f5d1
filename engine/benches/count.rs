//! `count COUPLING INTEGRATOR ELEMENTS STEPS`: so many steps of the spin-up, for `benches/count.sh`.
//! With COUPLING = `solver`, so many factorisations and solutions.
#![allow(missing_docs, clippy::unwrap_used)]

mod spin_up;

use std::hint::black_box;

/// Twice the steps of `benches/count.sh`.
const COPIES: usize = 200;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with("--")).collect();
    let [coupling, integrator, elements, steps] = arguments.as_slice() else { return };
    let (elements, steps): (usize, usize) = (elements.parse().unwrap(), steps.parse().unwrap());
    if coupling == "solver" {
        let (tangent, rhs) = spin_up::equations(elements);
        // As many copies whatever the number of steps: the difference of two counts is free of the copying.
        let mut copies: Vec<_> = (0..COPIES.max(steps)).map(|_| (tangent.clone(), rhs.clone())).collect();
        for (a, x) in copies.iter_mut().take(steps) {
            a.factor().unwrap();
            a.solve(x);
        }
        black_box(copies);
    } else {
        let mut run = spin_up::Run::new(coupling, elements, integrator);
        run.steps(steps);
        black_box(&run.from);
        eprintln!("{:?}", run.integrator.counters());
    }
}

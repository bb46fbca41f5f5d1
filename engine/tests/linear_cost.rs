//! The cost of a step is linear in the number of elements: by counts, not by the clock.
#![allow(missing_docs, clippy::unwrap_used)]

#[path = "../benches/spin_up/mod.rs"]
mod spin_up;

use flexion::linalg::{Matrix, Storage};

/// Numbers stored for the tangent.
fn stored(matrix: &Matrix) -> usize {
    match matrix.storage() {
        Storage::Dense(a) => a.data().len(),
        Storage::Band(a) => a.band().data().len(),
        Storage::Condensed(a) => a.whole().band().data().len(),
    }
}

#[test]
fn the_tangent_takes_memory_in_proportion_to_the_elements() {
    for coupling in ["first", "high", "exact"] {
        let size = |n: usize| stored(&Matrix::new(&spin_up::system(coupling, n).structure()));
        let sizes: Vec<usize> = spin_up::sizes().map(size).collect();
        for pair in sizes.windows(2) {
            // `high` has hidden unknowns at the boundaries between elements, one less than there are elements.
            let hidden = if coupling == "high" { pair[0] / 10 } else { 0 };
            assert!(pair[1] <= 2 * pair[0] + hidden, "{coupling}: {sizes:?}");
        }
    }
}

/// With the work of one iteration linear in the elements, so is the work of a step if the number of
/// iterations, residuals and factorisations does not grow with them.
#[test]
fn the_iterations_of_a_step_do_not_grow_with_the_elements() {
    for (coupling, integrator) in
        ["first", "high", "exact"].into_iter().flat_map(|c| [(c, "newmark"), (c, "radau")])
    {
        for elements in [10, 40, 160] {
            let counters = spin_up::Run::new(coupling, elements, integrator).integrator.counters();
            let what = format!("{coupling}, {integrator}, {elements} elements: {counters:?}");
            assert!(counters.iterations <= 4 * counters.steps, "{what}");
            // One a step at most, and the mass matrix at the start.
            assert!(counters.factorizations <= counters.steps + 1, "{what}");
        }
    }
}

//! Instructions of the hot paths under valgrind. Needs valgrind and `cargo install gungraun-runner`, then
//! `cargo bench --bench instructions --features instructions`; `benches/count.sh` does without the runner.
#![allow(missing_docs, clippy::unwrap_used)]

mod spin_up;

use flexion::linalg::Matrix;
use gungraun::{library_benchmark, library_benchmark_group, main};
use spin_up::Run;
use std::hint::black_box;

#[library_benchmark]
#[benches::elements(args = [10, 100, 1000], setup = spin_up::equations)]
fn factor_and_solve((mut a, mut x): (Matrix, Vec<f64>)) -> (Matrix, Vec<f64>) {
    a.factor().unwrap();
    a.solve(&mut x);
    black_box((a, x))
}

fn run(coupling: &str, elements: usize, integrator: &str) -> Run {
    Run::new(coupling, elements, integrator)
}

#[library_benchmark]
#[bench::first_newmark_10(args = ("first", 10, "newmark"), setup = run)]
#[bench::first_newmark_1000(args = ("first", 1000, "newmark"), setup = run)]
#[bench::exact_newmark_10(args = ("exact", 10, "newmark"), setup = run)]
#[bench::exact_newmark_1000(args = ("exact", 1000, "newmark"), setup = run)]
#[bench::first_radau_10(args = ("first", 10, "radau"), setup = run)]
#[bench::exact_radau_10(args = ("exact", 10, "radau"), setup = run)]
#[bench::space_alpha_10(args = ("space", 10, "alpha"), setup = run)]
#[bench::space_alpha_1000(args = ("space", 1000, "alpha"), setup = run)]
#[bench::space_radau_10(args = ("space", 10, "radau"), setup = run)]
fn ten_steps(mut run: Run) -> Run {
    run.steps(10);
    black_box(run)
}

library_benchmark_group!(name = hot_paths, benchmarks = [factor_and_solve, ten_steps]);
main!(library_benchmark_groups = hot_paths);

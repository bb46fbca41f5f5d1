//! Wall time of the hot paths, over a doubling series of elements: `cargo bench --bench wall`.
#![allow(missing_docs, clippy::unwrap_used)]

mod spin_up;

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use flexion::analysis::transient::{Observer, Plan, Step, transient};
use flexion::system::{State, System};
use std::hint::black_box;
use std::time::Duration;

/// Factorisation and solution alone, the yardstick of a step.
fn solver(c: &mut Criterion) {
    let mut group = c.benchmark_group("factor and solve");
    for n in spin_up::sizes() {
        let (tangent, rhs) = spin_up::equations(n);
        group.throughput(Throughput::Elements(n as u64));
        group.bench_with_input(BenchmarkId::new("first", n), &n, |b, _| {
            let prepare = || (tangent.clone(), rhs.clone());
            b.iter_batched_ref(
                prepare,
                |(a, x)| {
                    a.factor().unwrap();
                    a.solve(x);
                },
                BatchSize::SmallInput,
            );
        });
    }
    group.finish();
}

/// One step of a fixed size, whatever it takes.
fn steps(c: &mut Criterion) {
    for (coupling, integrator) in
        [("first", "newmark"), ("exact", "newmark"), ("first", "radau"), ("exact", "radau")]
    {
        let mut group = c.benchmark_group(format!("step, {coupling}, {integrator}"));
        for n in spin_up::sizes() {
            group.throughput(Throughput::Elements(n as u64));
            group.bench_with_input(BenchmarkId::from_parameter(n), &n, |b, &n| {
                let mut run = spin_up::Run::new(coupling, n, integrator);
                b.iter(|| run.steps(1));
            });
        }
        group.finish();
    }
}

/// Keeps what a run records from being optimised away.
struct Watch(Vec<f64>);

impl Observer for Watch {
    fn sample(&mut self, system: &mut dyn System, state: &State, _step: &Step) {
        self.0.resize(system.channels().len(), 0.0);
        system.record(state, &mut self.0);
        black_box(&self.0);
    }
}

/// The whole run of 20 s with ten elements, recorded every 10 ms.
fn runs(c: &mut Criterion) {
    let mut group = c.benchmark_group("run of 20 s");
    for (coupling, name) in
        [("first", "newmark"), ("exact", "newmark"), ("first", "radau"), ("exact", "radau")]
    {
        let mut system = spin_up::system(coupling, 10);
        let integrator = spin_up::integrator(name);
        let step = (name == "newmark").then_some(spin_up::STEP);
        let plan =
            Plan { end: 20.0, step, longest_step: None, break_steps: 1, contact_step: None, sample: 0.01 };
        group.bench_function(format!("{coupling}, {name}"), |b| {
            b.iter(|| {
                let mut state = State::zeros(system.size(), 0.0);
                transient(&mut *system, &*integrator, &mut state, &plan, &mut Watch(Vec::new()))
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1));
    targets = solver, steps, runs
}
criterion_main!(benches);

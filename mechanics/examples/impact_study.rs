//! Prints the tables of `docs/src/impact_study.md`: P4's pendulum with every scheme, its convergence with the number of
//! modes, and the restitution that laws of contact forces deliver.
//!
//! `cargo run --release -p flexion --example impact_study [TABLE]`, with `restitution`, `first`, `orders`, `cost`, `baumgarte`, `modes`, `schemes` or
//! `schemes-with-restitution`; all without.

#![allow(missing_docs, dead_code, unused_imports, clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // what it is for

#[path = "../tests/impact/falling_pendulum.rs"]
mod falling_pendulum;

use falling_pendulum::{hub, pendulum, section, with_ground};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::basis::{Field, Modes};
use flexion::contact::{Dissipation, Law, delivered};
use flexion::hub_beam::{ExactCoupling, Fields, Foreshortening, LinearCoupling};
use flexion::integrator::{
    Adams, GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha, Radau, Tolerance,
};
use flexion::system::{Mode, State, System};
use std::ops::ControlFlow;
use std::time::Instant;

fn stop(restitution: f64) -> Law {
    Law::Constraint { restitution, friction: 0.0 }
}

/// What a run shows.
#[derive(Default)]
struct Watch {
    events: Vec<Event>,
    /// Energy of the last sample before the second burst, and the largest error of the balance.
    energy: f64,
    imbalance: f64,
    gained: f64,
    /// First time at which the tip touches after a flight of 0.2 s, in a scheme without events.
    touches: Vec<f64>,
    pressed: f64,
    last: Option<State>,
    steps: u64,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        true
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let energy = system.energy(state).total();
        if state.t < 0.6 {
            self.energy = energy;
        }
        self.imbalance =
            self.imbalance.max(step.balance.map_or(0.0, |balance| balance.imbalance(energy).abs()));
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        self.steps += 1;
        let closed = |s: &State| s.mode[0] != Mode::Open || s.lambda[0] > 0.0;
        if closed(state) {
            self.touches.push(state.t);
        }
        if let Some(last) = self.last.as_ref().filter(|last| closed(last) && last.t < 0.6) {
            let end = if closed(state) { state.lambda[0] } else { 0.0 };
            self.pressed += 0.5 * (state.t - last.t) * (last.lambda[0] + end);
        }
        self.last = Some(state.clone());
        ControlFlow::Continue(())
    }

    fn event(&mut self, event: &Event) {
        self.events.push(event.clone());
    }

    fn gained_energy(&mut self, excess: f64) {
        self.gained = excess;
    }
}

impl Watch {
    fn impacts(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        self.events.iter().filter_map(|event| match &event.kind {
            EventKind::Impact { impulses, .. } if impulses[0] > 1e-9 => Some((event.time, impulses[0])),
            _ => None,
        })
    }

    /// Time at which the second burst begins.
    fn second(&self) -> Option<f64> {
        let times = self.impacts().map(|(time, _)| time).chain(self.touches.iter().copied());
        times.filter(|time| *time > 0.6).fold(None, |first, t| Some(first.map_or(t, |f: f64| f.min(t))))
    }
}

fn run(system: &mut dyn System, method: &mut dyn Integrator, plan: &Plan) -> (Watch, Ending, f64) {
    let (mut state, mut watch) = (system.initial(), Watch::default());
    let clock = Instant::now();
    let ending = transient(system, method, &mut state, plan, &mut watch);
    (watch, ending, clock.elapsed().as_secs_f64())
}

fn plan(end: f64, steps: Option<(f64, f64)>) -> Plan {
    let (step, contact_step) = (steps.map(|s| s.0), steps.map(|s| s.1));
    Plan { end, step, contact_step, longest_step: None, sample: 0.01 }
}

fn short(ending: &Ending) -> String {
    match ending {
        Ending::Failed(error) => error.to_string().chars().take(150).collect(),
        _ => String::new(),
    }
}

type Method = Box<dyn Integrator>;

/// A method with its name and its steps in flight and near contacts.
type Scheme = (&'static str, Method, Option<(f64, f64)>);

fn schemes(e: f64) {
    println!(
        "\nSchemes, e = {e}: N | scheme | second touch | energy at 0.6 s | imbalance | gained | steps | s\n"
    );
    let p4 = Some((1e-4, 1e-6));
    for n in [3, 5, 9] {
        let baumgarte = |d: f64, e: f64| -> Method { Box::new(Adams::new().with_baumgarte(d, e)) };
        let hht = |alpha: f64| -> Method { Box::new(GeneralizedAlpha::hht(alpha).unwrap().stabilized()) };
        let small = Some((4e-6, 1e-6));
        let list: Vec<Scheme> = vec![
            ("Radau 1e-8", Box::new(Radau::new(Tolerance::uniform(1e-8)).unwrap()), None),
            ("HHT α 0", hht(0.0), p4),
            ("HHT α −0.15", hht(0.15), p4),
            ("HHT α −1/3", hht(1.0 / 3.0), p4),
            ("Adams, P4's steps", baumgarte(0.0, 0.0), p4),
            ("Adams (0, 0)", baumgarte(0.0, 0.0), small),
            ("Adams (10, 50)", baumgarte(10.0, 50.0), small),
            ("Adams (1000, 5000)", baumgarte(1000.0, 5000.0), small),
            (
                "nonsmooth α, decoupled, 0.8",
                Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()),
                Some((1e-5, 1e-5)),
            ),
            (
                "nonsmooth α, coupled, 0.8",
                Box::new(NonsmoothAlpha::coupled(0.8).unwrap()),
                Some((1e-5, 1e-5)),
            ),
            ("Moreau–Jean ½", Box::new(MoreauJean::new(0.5).unwrap()), Some((1e-5, 1e-5))),
        ];
        for (name, mut method, steps) in list {
            let mut system = pendulum(n, stop(e));
            let (watch, ending, time) = run(&mut system, method.as_mut(), &plan(0.9, steps));
            let second = watch.second().map_or("–".to_owned(), |t| format!("{t:.6}"));
            println!(
                "| {n} | {name} | {second} | {:.6} | {:.1e} | {:.1e} | {} | {time:.2} | {}",
                watch.energy,
                watch.imbalance,
                watch.gained,
                watch.steps,
                short(&ending)
            );
        }
    }
}

/// Second touch and energy behind the first burst with halved steps.
fn orders() {
    println!("\nHHT, α = 0, stabilized, N = 2, e = 0: step | second touch | energy\n");
    for k in 0..5 {
        let step = 2e-5 / f64::from(1 << k);
        let mut method = GeneralizedAlpha::hht(0.0).unwrap().stabilized();
        let mut system = pendulum(2, stop(0.0));
        let (watch, ending, _) = run(&mut system, &mut method, &plan(0.8, Some((step, step))));
        println!(
            "| {step:.2e} | {:.9} | {:.8} | {}",
            watch.second().unwrap_or(0.0),
            watch.energy,
            short(&ending)
        );
    }
    println!("\nRadau: tolerance | N = 2, e = 0: second touch | energy | e = ½: second touch | energy\n");
    for tolerance in [1e-8, 1e-9, 1e-10, 1e-11] {
        print!("| {tolerance:.0e} |");
        for e in [0.0, 0.5] {
            let mut method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
            let (watch, ..) = run(&mut pendulum(2, stop(e)), &mut method, &plan(0.8, None));
            print!(" {:.9} | {:.9} |", watch.second().unwrap_or(0.0), watch.energy);
        }
        println!();
    }
}

fn modes() {
    println!(
        "\nModes: coupling | e | N | first touch | first impulse | impulse of the burst | impacts | energy | second touch\n"
    );
    for e in [0.0, 0.5, 1.0] {
        for n in [1, 2, 3, 5, 7, 9] {
            let mut method = Radau::new(Tolerance::uniform(1e-8)).unwrap();
            let (watch, ending, _) = run(&mut pendulum(n, stop(e)), &mut method, &plan(0.85, None));
            line("high", e, n, &watch, &ending);
        }
    }
    for n in [2, 4, 8] {
        let coupling = ExactCoupling::new(1.0, n, &section(), &hub()).unwrap();
        let mut method = Radau::new(Tolerance::uniform(1e-7)).unwrap();
        let (watch, ending, _) = run(&mut with_ground(coupling, stop(0.0)), &mut method, &plan(0.85, None));
        line("exact", 0.0, n, &watch, &ending);
    }
}

fn line(coupling: &str, e: f64, n: usize, watch: &Watch, ending: &Ending) {
    let burst: Vec<(f64, f64)> = watch.impacts().filter(|(time, _)| *time < 0.6).collect();
    let (time, first) = burst.first().copied().unwrap_or_default();
    let total = burst.iter().map(|(_, impulse)| impulse).sum::<f64>() + watch.pressed;
    println!(
        "| {coupling} | {e} | {n} | {time:.8} | {first:.5} | {total:.5} | {} | {:.5} | {:.5} | {}",
        burst.len(),
        watch.energy,
        watch.second().unwrap_or(0.0),
        short(ending)
    );
}

/// The first-order coupling on a hub without inertia.
fn first_coupling() {
    println!("\nCoupling first, J = 0\n");
    for n in [1, 3, 5, 7, 9] {
        let basis = |field| Box::new(Modes::new(1.0, n, field).unwrap());
        let fields = Fields::new(1.0, basis(Field::Axial), basis(Field::Transverse), &[]);
        let coupling = LinearCoupling::new(fields, &section(), &hub(), Foreshortening::First);
        let mut method = Radau::new(Tolerance::uniform(1e-8)).unwrap();
        let (watch, ending, _) = run(&mut with_ground(coupling, stop(0.0)), &mut method, &plan(0.9, None));
        println!("| {n} | {} impacts | {}", watch.impacts().count(), short(&ending));
    }
}

fn restitution() {
    println!(
        "\nDelivered restitution: e | Hunt–Crossley | Lankarani–Nikravesh | Flores | Gonthier | matched\n"
    );
    for k in 1..10 {
        let e = f64::from(k) / 10.0;
        print!("| {e} |");
        for law in [
            Dissipation::HuntCrossley,
            Dissipation::LankaraniNikravesh,
            Dissipation::Flores,
            Dissipation::Gonthier,
            Dissipation::Matched,
        ] {
            print!(" {:.4} |", delivered(law.factor(e)));
        }
        println!();
    }
}

/// Baumgarte's form with the orders of table 1: Adams' method with steps below its limit.
fn baumgarte() {
    println!("\nAdams, e = 0: N | end | step | (δ, ε) | energy | imbalance | gained | s\n");
    for (n, end, step) in [(3, 0.45, 1e-6), (7, 0.375, 6e-7), (9, 0.375, 6e-7)] {
        for (delta, epsilon) in [(0.0, 0.0), (10.0, 50.0), (1000.0, 5000.0)] {
            let mut method = Adams::new().with_baumgarte(delta, epsilon);
            let (watch, ending, time) =
                run(&mut pendulum(n, stop(0.0)), &mut method, &plan(end, Some((step, step))));
            println!(
                "| {n} | {end} | {step:e} | ({delta}, {epsilon}) | {:.5} | {:.1e} | {:.1e} | {time:.1} | {}",
                watch.energy,
                watch.imbalance,
                watch.gained,
                short(&ending)
            );
        }
    }
}

/// What 1 s of P4's experiment costs.
fn cost() {
    println!(
        "\nCost of 1 s, N = 5, e = 0: scheme | energy at 0.6 s | events | steps | tangents | residuals | s\n"
    );
    let list: Vec<Scheme> = vec![
        ("Radau 1e-5", Box::new(Radau::new(Tolerance::uniform(1e-5)).unwrap()), None),
        ("Radau 1e-8", Box::new(Radau::new(Tolerance::uniform(1e-8)).unwrap()), None),
        ("HHT α −0.15", Box::new(GeneralizedAlpha::hht(0.15).unwrap()), Some((1e-4, 1e-6))),
        (
            "HHT α −0.15, stabilized",
            Box::new(GeneralizedAlpha::hht(0.15).unwrap().stabilized()),
            Some((1e-4, 1e-6)),
        ),
    ];
    for (name, mut method, steps) in list {
        let (watch, ending, time) = run(&mut pendulum(5, stop(0.0)), method.as_mut(), &plan(1.0, steps));
        let counters = method.counters();
        println!(
            "| {name} | {:.5} | {} | {} | {} | {} | {time:.2} | {}",
            watch.energy,
            watch.events.len(),
            watch.steps,
            counters.tangents,
            counters.residuals,
            short(&ending)
        );
    }
}

fn main() {
    let wanted = std::env::args().nth(1);
    let tables: [(&str, fn()); 8] = [
        ("restitution", restitution),
        ("first", first_coupling),
        ("orders", orders),
        ("cost", cost),
        ("baumgarte", baumgarte),
        ("modes", modes),
        ("schemes", || schemes(0.0)),
        ("schemes-with-restitution", || schemes(0.3)),
    ];
    for (_, table) in tables.iter().filter(|(name, _)| wanted.as_deref().is_none_or(|wanted| wanted == *name))
    {
        table();
    }
}

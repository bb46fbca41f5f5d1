//! Prints the tables of `docs/src/impact_study.md`: P4's pendulum with every scheme, its convergence with the number of
//! modes, and the restitution that laws of contact forces deliver.
//!
//! `cargo run --release -p flexion --example impact_study [TABLE]`, with `restitution`, `first`, `orders`, `modes`, `speed`, `table`, `table-exact`,
//! `table-massless` or `balance`; all without. `table N` is the table for N modes, `table N hht` its rows of this method: Adams' method takes 13 s a pair of constants with N = 3, 50 s, 130 s
//! and more than 4 min with N = 5, 7 and 9.

#![allow(missing_docs, dead_code, unused_imports, clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // what it is for

#[path = "../tests/impact/falling_pendulum.rs"]
mod falling_pendulum;

use falling_pendulum::{hub, pendulum, section, with_ground};
use flexion::analysis::transient::{Ending, Event, EventKind, Observer, Plan, Step, transient};
use flexion::basis::{Field, Modes};
use flexion::contact::{Dissipation, Law, delivered};
use flexion::hub_beam::{ExactCoupling, Fields, Foreshortening, HighCoupling, LinearCoupling};
use flexion::integrator::{
    Adams, GeneralizedAlpha, Integrator, MoreauJean, NonsmoothAlpha, Radau, RungeKutta, Tolerance,
};
use flexion::system::{Mode, State, System};
use std::ops::ControlFlow;

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
    /// Time, angular momentum about the hinge and moment of gravity at the last sample.
    turning: Option<[f64; 3]>,
    /// Largest angle of the hub between the first burst and the second touch.
    angle: f64,
    balanced: bool,
    steps: u64,
}

impl Observer for Watch {
    fn wants_energy_balance(&self) -> bool {
        self.balanced
    }

    fn sample(&mut self, system: &mut dyn System, state: &State, step: &Step) {
        let energy = system.energy(state).total();
        if state.t < 0.6 {
            self.energy = energy;
        }
        if (0.3..0.6001).contains(&state.t) {
            self.press(system, state);
        }
        self.imbalance =
            self.imbalance.max(step.balance.map_or(0.0, |balance| balance.imbalance(energy).abs()));
    }

    fn step(&mut self, state: &State) -> ControlFlow<()> {
        self.steps += 1;
        if state.mode[0] != Mode::Open || state.lambda[0] > 0.0 {
            self.touches.push(state.t);
        }
        if (0.45..0.7).contains(&state.t) {
            self.angle = state.q.last().map_or(0.0, |x| x.max(self.angle));
        }
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
    /// Adds to the impulse of the ground what changes the angular momentum beside gravity: Δ(∂T/∂θ̇) + ∫ ∂V/∂θ dt, on an
    /// arm of 1 m.
    fn press(&mut self, system: &mut dyn System, state: &State) {
        let (mut s, n) = (state.clone(), state.v.len() - 1);
        let mut slope =
            |f: &mut dyn FnMut(&mut State, f64) -> f64, d: f64| (f(&mut s, d) - f(&mut s, -d)) / (2.0 * d);
        let momentum = slope(
            &mut |s, d| {
                s.v[n] = state.v[n] + d;
                system.energy(s).kinetic
            },
            1.0,
        );
        let gravity = slope(
            &mut |s, d| {
                s.q[n] = state.q[n] + d;
                system.energy(s).gravity
            },
            1e-3,
        );
        if let Some([t, before, moment]) = self.turning {
            self.pressed += momentum - before + 0.5 * (state.t - t) * (moment + gravity);
        }
        self.turning = Some([state.t, momentum, gravity]);
    }

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

fn run(system: &mut dyn System, method: &dyn Integrator, plan: &Plan) -> (Watch, Ending, f64) {
    watched(system, method, plan, false)
}

fn watched(
    system: &mut dyn System,
    method: &dyn Integrator,
    plan: &Plan,
    balanced: bool,
) -> (Watch, Ending, f64) {
    let mut state = system.initial();
    let mut watch = Watch { balanced, ..Watch::default() };
    let start = clock();
    let ending = transient(system, method, &mut state, plan, &mut watch);
    (watch, ending, clock() - start)
}

/// Time of the processor in this program [s], where the system tells it.
fn clock() -> f64 {
    let told = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    told.split_whitespace().next().and_then(|x| x.parse::<f64>().ok()).map_or(f64::NAN, |x| 1e-9 * x)
}

fn plan(end: f64, steps: Option<(f64, f64)>, adaptive: bool) -> Plan {
    let (step, contact_step) = (steps.map(|s| s.0), steps.map(|s| s.1));
    let (step, longest_step) = if adaptive { (None, step) } else { (step, None) };
    Plan { end, step, contact_step, longest_step, break_steps: 1, sample: 0.005 }
}

fn is_adaptive(method: &dyn Integrator) -> bool {
    method.info().estimate_order.is_some()
}

fn short(ending: &Ending) -> String {
    match ending {
        Ending::Failed(error) => error.to_string().chars().take(500).collect(),
        _ => String::new(),
    }
}

type Method = Box<dyn Integrator>;

/// A method with its name and its steps in flight and near contacts.
type Scheme = (String, Method, Option<(f64, f64)>);

fn radau(tolerance: f64) -> Scheme {
    (format!("`radau`, {tolerance:.0e}"), Box::new(Radau::new(Tolerance::uniform(tolerance)).unwrap()), None)
}

fn hht(alpha: f64, steps: (f64, f64)) -> Scheme {
    let method = GeneralizedAlpha::hht(alpha).unwrap().stabilized();
    (
        format!("`hht`, α = {:.2}, {:.0e} s and {:.0e} s", -alpha, steps.0, steps.1),
        Box::new(method),
        Some(steps),
    )
}

/// P4's steps in flight and near contacts.
const P4: (f64, f64) = (1e-4, 1e-6);

/// The methods of table 1, and those of today; `step` is below the stability limit of Adams' method.
fn schemes(step: f64) -> Vec<Scheme> {
    let baumgarte = |d: f64, e: f64| -> Scheme {
        let method = Adams::new().with_baumgarte(d, e);
        (format!("`adams`, ({d}, {e}), {step:e} s"), Box::new(method), Some((step, step)))
    };
    let small = Some((1e-5, 1e-5));
    vec![
        hht(0.0, P4),
        hht(0.15, P4),
        hht(1.0 / 3.0, P4),
        baumgarte(0.0, 0.0),
        baumgarte(10.0, 50.0),
        baumgarte(1000.0, 5000.0),
        ("nonsmooth α, decoupled, 0.8".into(), Box::new(NonsmoothAlpha::decoupled(0.8).unwrap()), small),
        ("nonsmooth α, coupled, 0.8".into(), Box::new(NonsmoothAlpha::coupled(0.8).unwrap()), small),
        ("Moreau–Jean, ½".into(), Box::new(MoreauJean::new(0.5).unwrap()), small),
        radau(1e-4),
        radau(1e-5),
        radau(1e-8),
    ]
}

/// What the first rebound is: impulse of the burst, largest angle behind it, time of the second touch, energy at 0.6 s.
fn rebound(watch: &Watch) -> [f64; 4] {
    [watch.pressed, watch.angle, watch.second().unwrap_or(f64::NAN), watch.energy]
}

/// Table 1: every scheme against `radau` with a small tolerance, 1 s, e = 0.
fn compare(name: &str, make: impl Fn() -> Box<dyn System>, list: Vec<Scheme>) {
    let (_, mut method, _) = radau(1e-10);
    let (watch, ending, _) = run(make().as_mut(), method.as_mut(), &plan(1.0, None, true));
    let exact = rebound(&watch);
    println!("| {name} | `radau`, 1e-10 | {exact:.6?} | {}", short(&ending));
    for (scheme, mut method, steps) in list {
        let plan = plan(1.0, steps, is_adaptive(method.as_ref()));
        let (watch, ending, mut time) = run(make().as_mut(), method.as_mut(), &plan);
        // The clock ticks every few milliseconds: short runs are repeated.
        let more = (0.5 / time).clamp(0.0, 20.0) as u32;
        time += (0..more).map(|_| run(make().as_mut(), method.as_mut(), &plan).2).sum::<f64>();
        time /= f64::from(1 + more);
        let found = rebound(&watch);
        let errors = [0, 1, 2, 3].map(|k| format!("{:.2} %", 100.0 * (found[k] / exact[k] - 1.0)));
        println!(
            "| {name} | {scheme} | {} | {} | {time:.3} | {}",
            errors.join(" | "),
            watch.steps,
            short(&ending)
        );
    }
}

const COLUMNS: &str =
    "N | scheme | impulse | angle | second touch | energy at 0.6 s | steps | s of processor time";

fn table() {
    println!("\nTable 1, e = 0: {COLUMNS}\n");
    let wanted: Option<usize> = std::env::args().nth(2).and_then(|n| n.parse().ok());
    let of = std::env::args().nth(3).unwrap_or_default();
    let all = [(3, 2e-6), (5, 1.2e-6), (7, 8e-7), (9, 6e-7)];
    for (n, step) in all.into_iter().filter(|(n, _)| wanted.is_none_or(|wanted| wanted == *n)) {
        let list = schemes(step).into_iter().filter(|(name, ..)| name.contains(&of)).collect();
        compare(&format!("{n} modes"), || Box::new(pendulum(n, stop(0.0))), list);
    }
}

fn table_exact() {
    println!("\nTable 1 with `exact`, e = 0: {COLUMNS}\n");
    for (n, step) in [(2, 4e-7), (4, 1e-7)] {
        let make = || -> Box<dyn System> {
            let coupling = ExactCoupling::new(1.0, n, &section(), &hub()).unwrap();
            Box::new(with_ground(coupling, stop(0.0)))
        };
        // Not Adams' method: its steps would be shorter than {step} s.
        let list = schemes(step).into_iter().filter(|(name, ..)| !name.contains("adams")).collect();
        compare(&format!("{n} elements"), make, list);
    }
}

/// The pendulum with a tip without mass.
fn massless(n: usize) -> Box<dyn System> {
    let transverse = Box::new(Modes::with_residual(1.0, n).unwrap());
    let axial = Box::new(Modes::new(1.0, n, Field::Axial).unwrap());
    let fields = Fields::new(1.0, axial, transverse, &[]).with_massless_tip().unwrap();
    Box::new(with_ground(HighCoupling::new(fields, &section(), &hub()).unwrap(), stop(0.0)))
}

fn table_massless() {
    println!("\nTable 1, massless contact: {COLUMNS}\n");
    for n in [3, 5, 7, 9] {
        let list = vec![hht(0.0, P4), hht(0.15, P4), radau(1e-4), radau(1e-5), radau(1e-8)];
        compare(&format!("{n} modes"), || massless(n), list);
    }
}

/// Errors of the first rebound against time.
fn speed() {
    println!("\nSpeed, N = 5, e = 0: {COLUMNS}\n");
    let mut list = vec![
        (
            "`hht`, α = −0.15, not stabilized, P4's steps".into(),
            Box::new(GeneralizedAlpha::hht(0.15).unwrap()) as Method,
            Some(P4),
        ),
        hht(0.15, P4),
        hht(0.15, (2e-5, 1e-6)),
        hht(0.15, (1e-5, 1e-6)),
    ];
    list.extend([3e-4, 2e-4, 1e-4, 5e-5, 3e-5, 2e-5, 1e-5, 1e-6].map(radau));
    for (tolerance, short) in
        [(1e-3, 4.5e-4), (5e-4, 4e-4), (5e-4, 4.3e-4), (5e-4, 4.5e-4), (3e-4, 4.5e-4), (2e-4, 4.5e-4)]
    {
        let (name, method, _) = radau(tolerance);
        // Two recording intervals, as where nothing is asked for.
        list.push((format!("{name}, {short:.1e} s from the first impact on"), method, Some((1e-2, short))));
    }
    for longest in [8e-4, 4.5e-4] {
        let (name, method, _) = radau(1e-3);
        list.push((format!("{name}, {longest:.1e} s at most"), method, Some((longest, longest))));
    }
    compare("5 modes", || Box::new(pendulum(5, stop(0.0))), list);
}

/// Twenty seconds of bouncing.
fn balance() {
    println!(
        "\n20 s, N = 2: e | scheme | largest imbalance over the energy of the start | gained [J] | steps | s\n"
    );
    let sharp = |e: f64| -> Box<dyn System> { Box::new(pendulum(2, stop(e))) };
    let fixed = |name: &str, method: Method, step: f64| -> Scheme {
        (format!("{name}, {step:.0e} s"), method, Some((step, step)))
    };
    let moreau = |step| fixed("Moreau–Jean, ½", Box::new(MoreauJean::new(0.5).unwrap()), step);
    let trapezium = |step| {
        fixed("`hht`, α = 0, stabilized", Box::new(GeneralizedAlpha::hht(0.0).unwrap().stabilized()), step)
    };
    let limited = |longest: f64| -> Scheme {
        let (name, method, _) = radau(1e-8);
        (format!("{name}, {longest:.0e} s at most"), method, Some((longest, longest)))
    };
    let list: Vec<(f64, Scheme, Box<dyn System>)> = vec![
        (0.0, trapezium(5e-5), sharp(0.0)),
        (0.0, trapezium(2e-5), sharp(0.0)),
        (0.0, moreau(5e-5), sharp(0.0)),
        (0.0, moreau(2e-5), sharp(0.0)),
        (0.0, radau(1e-8), sharp(0.0)),
        (0.0, radau(1e-10), sharp(0.0)),
        (0.5, radau(1e-10), sharp(0.5)),
        (0.0, limited(5e-6), sharp(0.0)),
        (0.0, radau(1e-10), massless(2)),
        (0.0, radau(1e-11), massless(2)),
        (
            0.0,
            fixed("nonsmooth α, coupled, 1", Box::new(NonsmoothAlpha::coupled(1.0).unwrap()), 1e-5),
            sharp(0.0),
        ),
        (
            0.0,
            fixed("`runge-kutta-4`", Box::new(RungeKutta::new().with_baumgarte(0.0, 0.0)), 8e-6),
            sharp(0.0),
        ),
        (0.0, fixed("`adams`", Box::new(Adams::new().with_baumgarte(0.0, 0.0)), 3e-6), sharp(0.0)),
    ];
    for (e, (name, mut method, steps), mut system) in list {
        let plan = plan(20.0, steps, is_adaptive(method.as_ref()));
        let (watch, ending, time) = watched(system.as_mut(), method.as_mut(), &plan, true);
        let part = watch.imbalance / START;
        println!(
            "| {e} | {name} | {part:.1e} | {:.1e} | {} | {time:.1} | {}",
            watch.gained,
            watch.steps,
            short(&ending)
        );
    }
    let (name, mut method, steps) = hht(0.0, P4);
    let (watch, ..) = watched(massless(7).as_mut(), method.as_mut(), &plan(1.0, steps, false), true);
    println!("| massless, N = 7, 1 s | {name} | {:.1e} | {:.1e} |", watch.imbalance / START, watch.gained);
}

/// Energy of the pendulum at 45° \[J\], m g L/2 sin 45°.
const START: f64 = 2766.7 * 3.14e-4 * 9.81 * 0.5 * std::f64::consts::FRAC_1_SQRT_2;

/// Second touch and energy behind the first burst with halved steps.
fn orders() {
    println!("\nHHT, α = 0, stabilized, N = 2, e = 0: step | second touch | energy\n");
    for k in 0..5 {
        let step = 2e-5 / f64::from(1 << k);
        let method = GeneralizedAlpha::hht(0.0).unwrap().stabilized();
        let mut system = pendulum(2, stop(0.0));
        let (watch, ending, _) = run(&mut system, &method, &plan(0.8, Some((step, step)), false));
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
            let method = Radau::new(Tolerance::uniform(tolerance)).unwrap();
            let (watch, ..) = run(&mut pendulum(2, stop(e)), &method, &plan(0.8, None, true));
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
            let method = Radau::new(Tolerance::uniform(1e-8)).unwrap();
            let (watch, ending, _) = run(&mut pendulum(n, stop(e)), &method, &plan(0.85, None, true));
            line("high", e, n, &watch, &ending);
        }
    }
    for n in [2, 4, 8] {
        let coupling = ExactCoupling::new(1.0, n, &section(), &hub()).unwrap();
        let method = Radau::new(Tolerance::uniform(1e-7)).unwrap();
        let (watch, ending, _) = run(&mut with_ground(coupling, stop(0.0)), &method, &plan(0.85, None, true));
        line("exact", 0.0, n, &watch, &ending);
    }
}

fn line(coupling: &str, e: f64, n: usize, watch: &Watch, ending: &Ending) {
    let burst: Vec<(f64, f64)> = watch.impacts().filter(|(time, _)| *time < 0.6).collect();
    let (time, first) = burst.first().copied().unwrap_or_default();
    let total = watch.pressed;
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
        let method = Radau::new(Tolerance::uniform(1e-8)).unwrap();
        let (watch, ending, _) = run(&mut with_ground(coupling, stop(0.0)), &method, &plan(0.9, None, true));
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

fn main() {
    let wanted = std::env::args().nth(1);
    let tables: [(&str, fn()); 9] = [
        ("restitution", restitution),
        ("first", first_coupling),
        ("orders", orders),
        ("modes", modes),
        ("speed", speed),
        ("table", table),
        ("table-exact", table_exact),
        ("table-massless", table_massless),
        ("balance", balance),
    ];
    for (_, table) in tables.iter().filter(|(name, _)| wanted.as_deref().is_none_or(|wanted| wanted == *name))
    {
        table();
    }
}

//! Numbers of a run, asked for by name.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use flexion_case::{Effort, Quantity, Reading, Request, Run, read};
use std::ops::ControlFlow;
use std::path::Path;

fn case(name: &str, changes: &[&str]) -> Reading {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification").join(name);
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    read(&folder, &changes).unwrap()
}

fn run(reading: &Reading, names: &[&str], request: &Request) -> (Run, Vec<Quantity>) {
    let mut prepared = reading.prepare().unwrap();
    let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
    let quantities = prepared.quantities(&names).unwrap();
    (reading.calculate(prepared, request, &mut |_| ControlFlow::Continue(())).unwrap().run, quantities)
}

/// P1's spin-up: smallest deflection, its time and the amplitude after the spin-up are those of an independent program, within the errors that are stated.
#[test]
fn values_within_times_and_their_errors_are_those_of_an_independent_program() {
    let reading = case("p1_spin_up_4", &[]);
    let names = [
        "tip.deflection.min",
        "tip.deflection.time-of-min@..15",
        "tip.deflection.amplitude@15..20",
        "tip.deflection.at@7",
        "tip.deflection.largest@15..",
    ];
    let (run, quantities) = run(&reading, &names, &Request::default());
    let expected = [-0.400_337_216, 6.950_603_36, 0.004_073_497_18];
    let collected: Vec<_> = quantities.iter().map(|quantity| quantity.collect(&run).unwrap()).collect();
    for (collected, expected) in collected.iter().zip(expected) {
        let off = (collected.value - expected).abs();
        // Of the time, that of a parabola through three records is added.
        assert!(off <= collected.error.unwrap() + 1e-4 * expected.abs(), "{collected:?} {expected}");
        assert!(collected.error.unwrap() < 1e-4 * expected.abs(), "{collected:?}");
    }
    assert_eq!(quantities[1].unit, "s");
    let at = run.trajectory.at(run.trajectory.index("tip.deflection").unwrap(), 7.0).unwrap();
    assert_eq!(collected[3].value, at);
    assert!(collected[4].value > 0.004 && collected[4].value < 0.0041);
}

/// The falling pendulum: the second touch and the impulse of the first burst are those of the book, and what is behind the end of a run is refused.
#[test]
fn touches_and_impulses_are_those_of_the_events() {
    let changes = ["run.duration=0.8 s", "output.step=0.5 ms"];
    let reading = case("falling_pendulum", &changes);
    let names = [
        "ground.first-touch",
        "ground.first-touch@0.5..",
        "ground.impulse@..0.6",
        "ground.impacts@..0.6",
        "work.steps",
        "run.end",
        "hub.angle.at@0.9",
    ];
    let (run, quantities) = run(&reading, &names, &Request { effort: None, ..Request::default() });
    let value = |i: usize| quantities[i].collect(&run).unwrap();
    assert!((value(0).value - 0.370_010_1).abs() < 1e-6);
    assert!((value(1).value - 0.778_915_97).abs() < 1e-6);
    assert!((value(2).value - 2.2063).abs() < 1e-3);
    assert_eq!(value(3).value, 3.0);
    assert_eq!(value(4).value, run.counters.steps as f64);
    assert_eq!((value(5).value, value(5).error), (0.8, Some(0.0)));
    assert!(value(0).error.is_none());
    assert!(quantities[6].collect(&run).unwrap_err().contains("ends at t = 0.8 s"));
    let finer = case(
        "falling_pendulum",
        &[&changes[..], &["integrator.tolerance=1e-11", "integrator.absolute-tolerance=1e-13"]].concat(),
    );
    let (finer, _) = self::run(&finer, &["run.end"], &Request { effort: None, ..Request::default() });
    let against = quantities[1].collect_against(&run, &finer).unwrap();
    assert!(against.error.is_some_and(|error| error < 1e-5), "{against:?}");
}

/// Between two records a value is one of the line between them, and its error would not say so.
#[test]
fn values_between_records_are_refused() {
    let reading = case("p1_spin_up_4", &["run.duration=2 s"]);
    let names = ["tip.deflection.at@1.013", "tip.deflection.min@0..1.013", "tip.deflection.min@0.5..1"];
    let (run, quantities) = run(&reading, &names, &Request { effort: None, ..Request::default() });
    for quantity in &quantities[..2] {
        assert!(quantity.collect(&run).unwrap_err().contains("between two records"), "{quantity:?}");
    }
    assert!(quantities[2].collect(&run).is_ok());
}

#[test]
fn what_is_no_quantity_is_refused_with_the_nearest_name() {
    let reading = case("p1_spin_up_4", &[]);
    let mut prepared = reading.prepare().unwrap();
    let mut refused = |name: &str| prepared.quantities(&[name.to_owned()]).unwrap_err().to_string();
    assert!(refused("tip.deflektion.min").contains("tip.deflection"));
    assert!(refused("tip.deflection.min@3").contains("two times"));
    assert!(refused("tip.deflection.at").contains("a time"));
    assert!(refused("tip.deflection.min@5..3").contains("two times"));
    assert!(refused("ground.impulse").contains("ground"));
    assert!(refused("work.step").contains("work"));
}

/// Times of extremes are those of a fine run within their errors, of coarse meshes, loose tolerances and records far apart.
#[test]
fn times_of_extremes_have_errors_that_hold() {
    let names = [
        "tip.deflection.time-of-min",
        "tip.deflection.time-of-max@10..20",
        "tip.deflection.time-of-min@15..20",
        "tip.axial.time-of-min",
        "tip.deflection_velocity.time-of-max@5..10",
    ];
    let fine = [
        "basis.elements=40",
        "integrator={kind='radau',tolerance=1e-9,absolute-tolerance=1e-11}",
        "output.step=1 ms",
    ];
    let none = Request { effort: None, ..Request::default() };
    let full = Request { effort: Some(Effort::Full), ..Request::default() };
    for folder in ["p1_spin_up_4", "p1_spin_up_20"] {
        let (truth, quantities) = run(&case(folder, &fine), &names, &none);
        let exact: Vec<f64> = quantities.iter().map(|of| of.collect(&truth).unwrap().value).collect();
        for changes in [
            &["basis.elements=10"][..],
            &["basis.elements=4"],
            &["basis={kind='modes',axial=3,transverse=3}"],
            &["integrator={kind='radau',tolerance=1e-4,absolute-tolerance=1e-4}"],
            &["output.step=0.1 s"],
        ] {
            let (run, quantities) = run(&case(folder, changes), &names, &full);
            for (quantity, exact) in quantities.iter().zip(&exact) {
                let found = quantity.collect(&run).unwrap();
                let (off, error) = ((found.value - exact).abs(), found.error.unwrap_or(f64::INFINITY));
                println!(
                    "{folder} {changes:?} {}: {:.5} off {off:.1e}, stated {error:.1e}",
                    quantity.name(),
                    found.value
                );
                assert!(off <= error, "{folder} {changes:?} {}: {off:.2e} {error:.2e}", quantity.name());
            }
        }
    }
}

/// The impulse of a stop with e = ½ is that of the moment of momentum about the hinge: single impacts count, bursts not twice.
#[test]
fn the_impulse_of_a_contact_is_that_of_all_its_impacts() {
    for (restitution, expected) in [("0", 2.2057), ("0.5", 2.1798)] {
        let restitution = format!("contact.1.law.restitution={restitution}");
        let reading = case("falling_pendulum", &["run.duration=0.6 s", &restitution]);
        let names = ["ground.impulse@..0.6"];
        let (run, quantities) = run(&reading, &names, &Request { effort: None, ..Request::default() });
        let found = quantities[0].collect(&run).unwrap().value;
        assert!((found - expected).abs() < 2e-3, "{restitution}: {found}");
    }
}

/// Records that are far apart miss the crests of a vibration: what they leave is in the error.
#[test]
fn the_distance_of_records_is_in_the_error_of_extremes() {
    let none = Request { effort: None, ..Request::default() };
    let names = [
        "tip.deflection.amplitude@15..20",
        "tip.deflection_velocity.max@15..20",
        "tip.deflection.largest@15..20",
    ];
    let at = |step: &str| {
        let step = format!("output.step={step}");
        let (run, quantities) = run(&case("p1_spin_up_4", &[&step]), &names, &none);
        quantities.iter().map(|of| of.collect(&run).unwrap()).collect::<Vec<_>>()
    };
    let fine = at("2 ms");
    for step in ["1 s", "0.5 s", "0.2 s", "0.1 s", "0.05 s", "0.02 s"] {
        for ((found, fine), name) in at(step).iter().zip(&fine).zip(names) {
            let off = (found.value - fine.value).abs();
            println!("{step} {name}: off {off:.1e}, stated {:.1e}", found.records);
            assert!(
                off <= found.records + 1e-9 * fine.value.abs(),
                "{step} {name}: {off:.2e} {:.2e}",
                found.records
            );
            assert!(
                found.records <= fine.value.abs().max(100.0 * off),
                "{step} {name}: {off:.2e} {:.2e}",
                found.records
            );
        }
    }
}

/// The speed Ω(t/T − sin(2πt/T)/2π) of the hub until T has the mean Ω/2 and the mean square Ω²(1/3 + 5/(8π²)).
#[test]
fn means_are_integrals_over_time() {
    let none = Request { effort: None, ..Request::default() };
    let names =
        ["hub.speed.mean@0..15", "hub.speed.root-mean-square@0..15", "hub.speed.root-mean-square@15.."];
    let (run, quantities) = run(&case("p1_spin_up_4", &[]), &names, &none);
    let square = 1.0 / 3.0 + 5.0 / (8.0 * std::f64::consts::PI.powi(2));
    for (quantity, exact) in quantities.iter().zip([2.0, 4.0 * square.sqrt(), 4.0]) {
        let found = quantity.collect(&run).unwrap();
        let off = (found.value - exact).abs();
        assert!(off <= found.records + 1e-12 * exact && found.records < 1e-4 * exact, "{found:?} {exact}");
    }
}

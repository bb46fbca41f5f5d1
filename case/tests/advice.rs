//! Advice on the cheapest coupling, basis and integrator, over the whole ladder of couplings.

#![allow(clippy::unwrap_used)] // in helpers of tests

use crate::verification::run::root;
use crate::written::{STRIP, finished, reading};
use flexion_case::{Advice, Reading, Run, Target, read};
use std::ops::ControlFlow;

fn advice(reading: &Reading, tolerance: &str, quantity: &str) -> Advice {
    let target = Target::new(tolerance.to_owned(), Some(quantity.to_owned()));
    reading.advise(&target, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// P1's answer is known: −0.40034 m at the largest deflection, of which a thousandth is asked.
#[test]
fn advice_on_p1_is_cheap_and_keeps_what_is_asked() {
    let reading = read(&root().join("p1_spin_up_4"), &[]).unwrap();
    let advice = advice(&reading, "1e-3", "tip.deflection.min");
    let cheapest = &advice.tried[advice.cheapest.unwrap()];
    // The deflection is small: the linear coupling does, and with few functions. Without foreshortening it does not.
    assert_eq!(cheapest.coupling, "first", "{cheapest:?}");
    assert!(advice.tried.iter().all(|tried| tried.coupling != "zeroth" || !tried.holds()));
    // The case gives EA and EI alone: no motion in space can be trusted.
    let untried: Vec<_> = advice.untried.iter().map(|of| (of.coupling, of.key.as_str())).collect();
    let silent = [("space", "section"), ("space-shear", "section")];
    assert_eq!((advice.trusted.coupling, &untried[..]), ("exact", &silent[..]));
    let run = finished(&reading.with(&cheapest.changes).unwrap());
    let found = run.trajectory.extremes(run.trajectory.index("tip.deflection").unwrap()).min;
    assert!((found + 0.400_34).abs() < 1e-3 * 0.400_34, "{found}");
    let as_it_stands = finished(&reading);
    let work = |run: &Run| (run.counters.residuals as f64) * run.size.unknowns as f64;
    assert!(5.0 * work(&run) < work(&as_it_stands), "{} {}", work(&run), work(&as_it_stands));
    assert!((work(&run) - cheapest.work).abs() < 0.5, "the work that was counted");
    // It is the cheapest of those that hold, by the table.
    let least = advice
        .tried
        .iter()
        .filter(|tried| tried.holds())
        .map(|tried| tried.work)
        .fold(f64::INFINITY, f64::min);
    assert_eq!(least, cheapest.work);
}

/// A force that bends the beam by 0.8 of its length: no coupling but the exact one can follow.
#[test]
fn advice_on_a_large_deflection_is_the_exact_coupling() {
    let case = "[[load]]\non = '1 m'\nforce = [0, -140]\namplitude = { kind = 'ramp', time = 1 }\n[run]\nduration = 1.5\n";
    let reading = reading(&format!("{STRIP}{case}"), &[]);
    let advice = advice(&reading, "1e-3", "tip.deflection");
    let cheapest = &advice.tried[advice.cheapest.unwrap()];
    assert_eq!(cheapest.coupling, "exact", "{cheapest:?}");
    // The section says all that a motion in space with shear depends on.
    assert!(advice.trusted.coupling == "space-shear" && advice.untried.is_empty(), "{:?}", advice.untried);
    for coupling in ["zeroth", "first", "high"] {
        let mut others = advice.tried.iter().filter(|tried| tried.coupling == coupling);
        assert!(others.all(|tried| !tried.holds()), "{coupling}");
    }
    let run = finished(&reading.with(&cheapest.changes).unwrap());
    let refined = ["basis.elements=40", "integrator={kind='radau',tolerance=1e-8,absolute-tolerance=1e-9}"];
    let fine = finished(&reading.with(&refined.map(str::to_owned)).unwrap());
    let [a, b] = [&run, &fine].map(|run| run.trajectory.column("tip.deflection").unwrap());
    let off = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let largest = b.iter().fold(0.0, |m: f64, b| m.max(b.abs()));
    assert!(largest > 0.8 && off < 1.1e-3 * largest, "{off} of {largest}");
}

#[test]
fn advice_is_refused_where_there_is_none() {
    let target = Target::new("1e-3".to_owned(), None);
    let refused = |reading: &Reading| {
        reading.advise(&target, &mut |_| ControlFlow::Continue(())).unwrap_err().to_string()
    };
    let bouncing = read(&root().join("falling_pendulum"), &[]).unwrap();
    assert!(refused(&bouncing).contains("without contacts"));
    let p1 = read(&root().join("p1_spin_up_4"), &[]).unwrap();
    let unknown = Target::new("1e-3".to_owned(), Some("tip.defelction".to_owned()));
    let error = p1.advise(&unknown, &mut |_| ControlFlow::Continue(())).unwrap_err();
    assert!(error.to_string().contains("tip.deflection"), "{error}");
}

/// A ladder that is stopped says so, and keeps what was tried.
#[test]
fn advice_that_is_stopped_says_so() {
    let reading = read(&root().join("p1_spin_up_4"), &[]).unwrap();
    let target = Target::new("1e-3".to_owned(), Some("tip.deflection.min".to_owned()));
    // Each run begins anew at the time zero.
    let (mut last, mut runs) = (0.0, 0);
    let advice = reading
        .advise(&target, &mut |state| {
            runs += usize::from(state.t < last);
            last = state.t;
            if runs < 20 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })
        .unwrap();
    assert!(advice.stopped && !advice.bounded && !advice.tried.is_empty(), "{:?}", advice.tried.len());
    assert!(
        advice.tried.iter().all(|tried| tried
            .difference
            .as_ref()
            .err()
            .is_none_or(|why| !why.contains("user")))
    );
}

/// A case with bodies by name is that of one coupling, and the others are listed with the reason. By 1e-4 of the largest value of each
/// column some method of its ladder follows a free body.
#[test]
fn advice_on_a_system_in_space_is_of_space_alone() {
    let reading =
        read(&root().join("space_free_body"), &["run.duration=1", "output.step=0.01"].map(str::to_owned))
            .unwrap();
    let advice =
        reading.advise(&Target::new("1e-4".to_owned(), None), &mut |_| ControlFlow::Continue(())).unwrap();
    let untried: Vec<&str> = advice.untried.iter().map(|of| of.coupling).collect();
    let others = ["zeroth", "first", "high", "exact", "space-shear"];
    assert_eq!((advice.trusted.coupling, &untried[..]), ("space", &others[..]));
    assert!(advice.untried.iter().all(|of| of.key == "model.coupling"));
    assert!(advice.untried[..4].iter().all(|of| of.why.contains("by name")), "{:?}", advice.untried);
    let cheapest = &advice.tried[advice.cheapest.unwrap()];
    let run = finished(&reading.with(&cheapest.changes).unwrap());
    let work = run.counters.residuals as f64 * run.size.unknowns as f64;
    assert!((work - cheapest.work).abs() < 0.5, "{work} {cheapest:?}");
}

//! Cases at random over all kinds: what a run states as its error holds against a far finer run, or the run warns or ends with
//! an error. The program does the same for as many cases as one likes.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_calibration::families::{self, COUNT, crowds, pose};
use flexion_calibration::{Counts, Ending, Outcome, draw, draw_with_contacts, judge, study};
use flexion_results::Status;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

/// Cases of the test, of a seed that no study in the documentation has.
const CASES: u64 = 60;
const SEED: u64 = 5;
/// Seed of the cases of families: a record lies a ten-millionth of the run before an impact.
const FAMILIES: u64 = 3;
/// Seed of the crowds of contacts.
const CROWDS: u64 = 1;

#[test]
fn stated_errors_of_cases_at_random_hold_or_the_run_warns() {
    let outcomes = study(0..CASES, 0, &|number| judge(&draw(SEED, number), number));
    let refused: Vec<_> = outcomes
        .iter()
        .filter(|o| matches!(o.ending, Ending::Refused(_)))
        .map(|o| (o.number, &o.ending))
        .collect();
    assert!(refused.is_empty(), "legal cases are refused: {refused:?}");
    let counts = Counts::of(&outcomes);
    for row in counts.rows() {
        eprintln!("{}", row.join("  "));
    }
    assert!(counts.silent.is_empty() && counts.wrong.is_empty(), "{:?} {:?}", counts.silent, counts.wrong);
    assert!(2 * counts.known > counts.cases, "{counts:?}");
    assert!(counts.held as f64 >= 0.9 * counts.values as f64, "{counts:?}");
    assert!(counts.median <= 5.0, "{counts:?}");
}

/// One case of each family: none is wrong in silence, none is refused, and nearly all are judged.
#[test]
fn no_case_of_a_family_is_wrong_in_silence() {
    let outcomes = study(COUNT..2 * COUNT, 0, &|number| families::judge(&pose(FAMILIES, number), number));
    for outcome in &outcomes {
        let wrong: Vec<_> = outcome.silent().chain(outcome.wrong()).collect();
        assert!(wrong.is_empty(), "{} ({}): {wrong:?}", outcome.subject, outcome.number);
        assert!(!matches!(outcome.ending, Ending::Refused(_)), "{}: {:?}", outcome.subject, outcome.ending);
    }
    let judged = outcomes.iter().filter(|o| o.warnings.is_empty() && !o.values.is_empty()).count();
    // Warned are the rounding of short elements at kinks, a rotor that a method without events may let through, and a companion that takes long.
    assert!(judged + 3 >= outcomes.len(), "{judged} of {}", outcomes.len());
}

/// A case each of crowds of contacts: motions and sums are those of closed forms, no contact enters, no energy is made, with warnings or without.
#[test]
fn crowds_of_contacts_are_right() {
    for number in [1, 13, 16, 17, 25, 39, 57, 117] {
        let outcome = crowds::judge(&crowds::pose(CROWDS, number), number);
        let Outcome { subject, ending, broken, values, .. } = &outcome;
        assert!(*ending == Ending::Known && !values.is_empty(), "{subject} ({number}): {ending:?}");
        assert!(broken.is_empty(), "{subject} ({number}): {broken:?}");
        let wrong = values.iter().find(|v| !(v.off <= v.stated.max(0.01 * v.size) + v.rounding()));
        assert!(wrong.is_none(), "{subject} ({number}): {wrong:?}");
    }
}

/// All kinds are drawn that a case may choose, but those that a run cannot be judged by.
#[test]
fn all_kinds_are_drawn() {
    let drawn: Vec<String> = (0..1500).map(|k| draw(1, k).text).collect();
    let text = drawn.join("\n");
    let words: BTreeSet<&str> = text.split('"').collect();
    for choice in flexion_case::choices() {
        // Systems in space are drawn with parts of some kinds.
        if ["body.", "beam.", "joint."].iter().any(|table| choice.path().starts_with(table)) {
            continue;
        }
        // Blades do not run; a restart belongs to one run.
        let left_out = |kind: &str| match choice.path() {
            "blade.strain-energy" => true,
            "initial" => ["restart", "undeformed"].contains(&kind),
            "contact.law" => kind == "massless",
            // The default of systems in space, which are drawn.
            "model.coupling" => kind.starts_with("space"),
            // Decks are blades, of more elements than a random case has time for.
            "section" => kind == "deck",
            "section.format" => ["hawc2", "windio"].contains(&kind),
            "hub.motion.controller" => kind == "none",
            "load.distribution" => kind == "uniform",
            // Written between other quotation marks.
            "spring.kind" => kind == "point",
            _ => false,
        };
        for kind in choice.kinds() {
            assert!(left_out(kind.name) || words.contains(kind.name), "{} {}", choice.path(), kind.name);
        }
    }
}

/// Contacts in random cases: energy is not made, rigid obstacles are not entered, or the run ends with an error.
#[test]
fn random_contacts_make_no_energy_and_let_nothing_through() {
    let (mut touched, mut failed) = (0, 0);
    for seed in 0..30 {
        let drawn = draw_with_contacts(7_000_003 + seed);
        let set = ["integrator={kind='radau',tolerance=1e-7,absolute-tolerance=1e-9}".to_owned()];
        let reading =
            drawn.read(&set).unwrap_or_else(|problems| panic!("{seed}: {problems}\n{}", drawn.text));
        let Ok(prepared) = reading.prepare() else { continue };
        let mut steps = 0;
        let run = prepared.run(&mut |_| {
            steps += 1;
            if steps > 6_000 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        });
        failed += usize::from(run.status == Status::Failed);
        if run.events.impacts().next().is_none() {
            continue;
        }
        touched += 1;
        let columns = |name: &str| run.trajectory.column(name).unwrap();
        let total = columns("energy.total").into_iter().fold(0.0, f64::max);
        let work = columns("energy.drive").into_iter().chain(columns("energy.loads"));
        let scale = work.fold(total, |m, x| m.max(x.abs()));
        let gained = columns("energy.balance").into_iter().fold(0.0, f64::max);
        assert!(gained < 1e-3 * scale, "{seed}: {gained} of {scale}\n{}", drawn.text);
        let entered =
            run.trajectory.column("constraint.position").unwrap_or_default().into_iter().fold(0.0, f64::max);
        assert!(entered < 1e-6 * drawn.length, "{seed}: {entered} of {}\n{}", drawn.length, drawn.text);
    }
    eprintln!("{touched} cases touch, {failed} end with an error");
    assert!(touched > 10 && failed < 10, "{touched} cases touch, {failed} end with an error");
}

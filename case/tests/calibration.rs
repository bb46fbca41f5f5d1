//! Cases at random over all kinds: what a run states as its error holds against a far finer run, or the run warns or ends with
//! an error. `flexion calibrate` does the same for as many cases as one likes.

use flexion_case::calibration::{Counts, Ending, draw, study};
use std::collections::BTreeSet;

/// Cases of the test, of a seed that no study in the documentation has.
const CASES: u64 = 60;
const SEED: u64 = 5;

#[test]
fn stated_errors_of_cases_at_random_hold_or_the_run_warns() {
    let outcomes = study(SEED, 0..CASES, 0, &|| true);
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
            "hub.motion.controller" => kind == "none",
            "load.distribution" => kind == "uniform",
            // Written between other quotation marks.
            "spring.kind" => kind == "point",
            "contact.mount" => kind == "ground",
            _ => false,
        };
        for kind in choice.kinds() {
            assert!(left_out(kind.name) || words.contains(kind.name), "{} {}", choice.path(), kind.name);
        }
    }
}

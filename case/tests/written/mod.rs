//! Cases that a test writes itself: read, and run to their end.

#![allow(dead_code)] // each test binary uses its part
#![allow(clippy::unwrap_used, clippy::panic)]

use flexion_case::{Reading, Run, parse, read};
use flexion_results::Status;
use std::ops::ControlFlow;
use std::path::Path;

/// Two metres of a soft square bar; the rest of a case follows.
pub const SQUARE_BAR: &str = r#"
[beam]
length = "2 m"
[section]
kind = "rectangle"
modulus = "7 GPa"
density = "2700 kg/m^3"
width = "20 mm"
height = "20 mm"
"#;

/// A metre of aluminium strip on a hub at rest, geometrically exact; loads and the run of a case follow.
pub const STRIP: &str = "
[beam]
length = 1
[section]
kind = 'rectangle'
modulus = '70 GPa'
density = 2700
width = '20 mm'
height = '5 mm'
[hub]
motion = { kind = 'constant', speed = 0 }
[model]
coupling = 'exact'
";

/// P1's beam of ten metres; the rest of a case follows.
pub const P1_BEAM: &str = r#"
[beam]
length = 10
[section]
kind = "uniform"
modulus = "70 GPa"
density = 3000
area = "4 cm^2"
second-moment = "2e-7 m^4"
"#;

fn owned(set: &[&str]) -> Vec<String> {
    set.iter().map(|text| (*text).to_owned()).collect()
}

/// A case with overrides `KEY=VALUE`.
pub fn reading(text: &str, set: &[&str]) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &owned(set))
        .unwrap_or_else(|problems| panic!("{set:?}: {}", problems.render(false)))
}

/// The same of a file.
pub fn reading_of(case: &Path, set: &[&str]) -> Reading {
    read(case, &owned(set)).unwrap_or_else(|problems| panic!("{set:?}: {}", problems.render(false)))
}

/// A run, however it ends.
pub fn outcome(reading: &Reading) -> Run {
    let prepared = reading.prepare().unwrap_or_else(|problems| panic!("{}", problems.render(false)));
    prepared.run(&mut |_| ControlFlow::Continue(()))
}

/// A run that finishes.
pub fn finished(reading: &Reading) -> Run {
    let run = outcome(reading);
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    run
}

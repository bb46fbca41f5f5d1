//! The mechanics computes and does nothing else: it runs wherever there is memory, a browser included.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::architecture::{code_only, root, sources};

/// Parts of the standard library that need an operating system.
const SYSTEM: [&str; 6] = ["fs", "time", "thread", "net", "env", "process"];

/// What the library depends on: numbers and errors.
const DEPENDENCIES: [&str; 4] = ["libm", "nalgebra", "num-complex", "thiserror"];

/// The functions of `f64` that differ from platform to platform in the last digit, and so make different runs.
const ELEMENTARY: [&str; 25] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh",
    "acosh", "atanh", "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "cbrt",
    "hypot",
];

/// The parts of the operating system that a source text names.
fn system_parts(text: &str) -> Vec<&'static str> {
    let code: String = code_only(text).split_whitespace().collect();
    let group = |part: &str| {
        code.split("std::{").skip(1).any(|rest| {
            let names = rest.split(';').next().unwrap_or("");
            names.split([',', '{', '}']).any(|name| name == part || name.starts_with(&format!("{part}::")))
        })
    };
    let path = |part: &str| {
        code.split("std::").skip(1).any(|rest| {
            let name: String = rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            name == part
        })
    };
    SYSTEM.into_iter().filter(|part| path(part) || group(part)).collect()
}

/// The elementary functions of the standard library that a source text calls, up to its tests.
fn elementary_functions(text: &str) -> Vec<&'static str> {
    let code = code_only(text);
    let code = code.split("\nmod tests {").next().unwrap_or("");
    // Numbers with derivatives have functions of these names too, called on `self` or by their type.
    let called = |name: &&str| {
        let call = format!(".{name}(");
        let mut before = code.rsplit(&call).skip(1);
        let is_own = |text: &str| *name != "powf" && (text.ends_with("(self") || text.ends_with(" self"));
        before.any(|text| !is_own(text)) || code.split(&format!("f64::{name}")).skip(1).any(ends_a_word)
    };
    ELEMENTARY.into_iter().filter(called).collect()
}

fn ends_a_word(rest: &str) -> bool {
    !rest.starts_with(|c: char| c.is_alphanumeric() || c == '_')
}

#[test]
fn the_mechanics_needs_no_operating_system() {
    for (file, text) in sources(&root().join("mechanics/src")) {
        assert_eq!(system_parts(&text), [""; 0], "{}", file.display());
    }
}

#[test]
fn the_mechanics_depends_on_numbers_and_errors_only() {
    let manifest = std::fs::read_to_string(root().join("mechanics/Cargo.toml")).unwrap();
    let table = manifest.split("\n[dependencies]\n").nth(1).unwrap().split("\n[").next().unwrap();
    let names: Vec<&str> = table
        .lines()
        .filter_map(|line| line.split(['.', ' ', '=']).next())
        .filter(|n| !n.is_empty())
        .collect();
    assert_eq!(names, DEPENDENCIES);
    assert!(!manifest.contains("[target."), "a dependency of one platform");
}

#[test]
fn what_computes_has_the_same_elementary_functions_everywhere() {
    // Pictures and samples are drawn on one platform.
    let others = ["tests", "tests.rs", "checks.rs", "samples.rs", "plot", "sweep"];
    for folder in ["mechanics/src", "case/src", "output/src"] {
        for (file, text) in sources(&root().join(folder)) {
            let is_other = file.iter().any(|part| others.iter().any(|other| part == *other));
            assert!(
                is_other || elementary_functions(&text).is_empty(),
                "{}: use those of libm",
                file.display()
            );
        }
    }
}

#[test]
fn what_is_looked_for_is_found() {
    assert_eq!(system_parts("use std::fs;"), ["fs"]);
    assert_eq!(system_parts("use std::{fmt, time::Instant};"), ["time"]);
    assert_eq!(system_parts("fn f() { std::thread::spawn(g); }"), ["thread"]);
    assert_eq!(system_parts("use std::fmt; // std::fs\nuse std::network;"), [""; 0]);
    assert_eq!(elementary_functions("let y = x.sin() + f64::exp(x);"), ["sin", "exp"]);
    assert_eq!(elementary_functions("fn pow(self) { self.powf(2.0) }"), ["powf"]);
    assert_eq!(elementary_functions("let y = sin(x) + f64::expect(x) + x.powi(2);"), [""; 0]);
}

//! The program and a case for it.

#![allow(clippy::unwrap_used)]
#![allow(dead_code)] // each test binary uses its part

use std::path::Path;
use std::process::{Command, Output};

/// A beam that is spun up; basis, integrator and run follow.
pub const SPIN_UP: &str = r#"
title = "spin-up"
[beam]
length = "10 m"
[section]
kind = "uniform"
modulus = "70 GPa"
density = "3000 kg/m^3"
area = "4 cm^2"
second-moment = "2e-7 m^4"
[hub]
motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" }
"#;

/// The program in a folder.
pub fn flexion(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_flexion")).args(arguments).current_dir(folder).output().unwrap()
}

/// What it printed.
pub fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// What follows the beam.
const REST: &str = r#"[integrator]
kind = "newmark"
step = "5 ms"
[run]
duration = "20 s"
[output]
step = "10 ms"
"#;

/// A folder with the case in `spin-up/case.toml`.
pub fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("spin-up")).unwrap();
    std::fs::write(folder.path().join("spin-up/case.toml"), [SPIN_UP, REST].concat()).unwrap();
    folder
}

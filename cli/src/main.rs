//! `flexion`, the program.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(flexion_cli::program(std::env::args_os().collect()))
}

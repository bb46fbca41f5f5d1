//! `flexion`: runs, checks and describes cases.
//!
//! Exit codes: 0 finished; 1 the case or the command line is rejected; 2 a run failed or was stopped, and what
//! it had computed is kept.

mod case;
mod check;
mod list;
mod run;
mod screen;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// Dynamics of rotating flexible beams.
#[derive(Parser)]
#[command(name = "flexion", version, arg_required_else_help = true)]
#[command(after_help = "Example:\n  flexion run verification/p1_spin_up_4 --output results/p1")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run a case and write its trajectory, summary and plot
    Run(run::Arguments),
    /// Validate a case and show what would be run
    Check(check::Arguments),
    /// List the kinds of section, motion, coupling, basis and integrator
    List(list::Arguments),
    /// Print the JSON Schema of case files, for editors
    #[command(after_help = "Example:\n  flexion schema > docs/flexion.schema.json")]
    Schema,
}

/// How a command ends.
enum Outcome {
    /// All went well.
    Finished,
    /// The case or the command line is wrong.
    Rejected,
    /// A run ended early; what was computed is kept.
    Incomplete,
}

fn main() -> ExitCode {
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are no errors and go to standard output.
            let rejected = error.use_stderr();
            let _ = error.print();
            return ExitCode::from(u8::from(rejected));
        }
    };
    let outcome = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::List(arguments) => list::list(&arguments),
        Command::Schema => {
            screen::print(&flexion::case::schema());
            Outcome::Finished
        }
    };
    ExitCode::from(match outcome {
        Outcome::Finished => 0,
        Outcome::Rejected => 1,
        Outcome::Incomplete => 2,
    })
}

//! The program `flexion`: runs, checks and describes cases. It is a library, so that the package for Python carries it too.
//!
//! Exit codes: 0 finished; 1 the case or the command line is rejected; 2 a run failed or was stopped, and what
//! it had computed is kept, or runs differ by more than the tolerance, or not all could be written.

mod advise;
mod assembly;
mod campbell;
mod case;
mod check;
mod compare;
mod completions;
mod deck;
mod lab;
mod list;
mod man;
mod modes;
mod new;
mod plot;
mod reproduce;
mod run;
mod screen;
mod statics;
mod sweep;
mod vibration;
mod view;

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
use std::ffi::OsString;

/// Dynamics of rotating flexible beams.
#[derive(Parser)]
#[command(name = "flexion", version, arg_required_else_help = true)]
#[command(after_help = "Examples:
  flexion new spin-up --output case.toml
  flexion check case.toml
  flexion run case.toml --output results/spin-up
  flexion plot results/spin-up --columns 'tip.*' --output tip.svg

Exit codes: 0 finished, 1 case or command line rejected, 2 a run failed or was stopped, runs differ too much, or not all
could be written.")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write a commented case file to begin with
    New(new::Arguments),
    /// Run a case and write its trajectory, summary and plot
    Run(run::Arguments),
    /// Run a case with many values of some of its keys, one row a run
    Sweep(sweep::Arguments),
    /// Validate a case and show what would be run
    Check(check::Arguments),
    /// Show how far runs are apart
    Compare(compare::Arguments),
    /// Find the modes of vibration at a speed of rotation
    Modes(modes::Arguments),
    /// Follow the modes of vibration over a range of speeds
    Campbell(campbell::Arguments),
    /// Follow the equilibrium of a case at rest as its loads grow
    Statics(statics::Arguments),
    /// Write a beam of a case as a blade deck for BeamDyn or HAWC2
    Deck(deck::Arguments),
    /// Plot columns of one or several runs
    Plot(plot::Arguments),
    /// Write a page that plays the motion or the modes of a result
    View(view::Arguments),
    /// Open the lab, where a case is changed and computed in the browser
    Lab(lab::Arguments),
    /// Find the cheapest coupling, basis and integrator with which a case holds a tolerance
    Advise(advise::Arguments),
    /// Compute figures, tables and claims of papers again, and write a report
    Reproduce(reproduce::Arguments),
    /// List all kinds that a case may choose, with their keys
    List(list::Arguments),
    /// Print the JSON Schema of case files, for editors
    #[command(after_help = "Example:\n  flexion schema > docs/flexion.schema.json")]
    Schema,
    /// Print the completions for a shell
    Completions(completions::Arguments),
    /// Print the manual page, or write one for every command
    Man(man::Arguments),
}

/// How a command ends.
enum Outcome {
    /// All went well.
    Finished,
    /// The case or the command line is wrong.
    Rejected,
    /// A run ended early, and what was computed is kept; or runs differ too much; or not all could be written.
    Incomplete,
}

/// Does what a command line says, its first word the name of the program, and returns the exit code.
pub fn program(words: Vec<OsString>) -> u8 {
    let sets = words.iter().any(|word| word == "--set");
    let arguments = match Arguments::try_parse_from(words) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are no errors and go to standard output.
            let rejected = error.use_stderr();
            let _ = error.print();
            if error.kind() == ErrorKind::UnknownArgument && sets {
                screen::report(
                    "\nA value with a blank stands in quotation marks: --set 'section.modulus=30 GPa'\n",
                );
            }
            return u8::from(rejected);
        }
    };
    let outcome = match arguments.command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Reproduce(arguments) => reproduce::reproduce(&arguments),
        Command::Sweep(arguments) => sweep::sweep(&arguments),
        Command::New(arguments) => new::new(&arguments),
        Command::Compare(arguments) => compare::compare(&arguments),
        Command::Modes(arguments) => modes::modes(&arguments),
        Command::Campbell(arguments) => campbell::campbell(&arguments),
        Command::Statics(arguments) => statics::statics(&arguments),
        Command::Deck(arguments) => deck::deck(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Advise(arguments) => advise::advise(&arguments),
        Command::View(arguments) => view::view(&arguments),
        Command::Lab(arguments) => lab::lab(&arguments),
        Command::Completions(arguments) => completions::completions(&arguments),
        Command::Man(arguments) => man::man(&arguments),
        Command::Check(arguments) => check::check(&arguments),
        Command::List(arguments) => list::list(&arguments),
        Command::Schema => {
            screen::print(&flexion_case::schema());
            Outcome::Finished
        }
    };
    match outcome {
        Outcome::Finished if screen::incomplete() => 2,
        Outcome::Finished => 0,
        Outcome::Rejected => 1,
        Outcome::Incomplete => 2,
    }
}

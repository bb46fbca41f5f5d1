//! `flexion view`: the motion or the modes of a result as a page for the browser.

use crate::{Outcome, screen};
use flexion_results::{view_page, write_file};
use std::path::PathBuf;

/// The results to be seen.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion run verification/p1_spin_up_4 --output results/p1
  flexion view results/p1 --output p1.html
  flexion modes verification/p1_spin_up_4 --speed 4 --output results/modes
  flexion view results/modes --output modes.html

The page is one file and needs neither a server nor a network: open it in a browser. Space plays and pauses, the arrows step,
f shows everything.

Exit codes: 0 finished, 1 no such result, nothing to be seen in it, or the file could not be written.")]
pub struct Arguments {
    /// Directory of results of `flexion run`, or of `flexion modes --output`
    #[arg(value_name = "RESULT")]
    result: PathBuf,
    /// Columns of a run shown at first, e.g. tip.deflection,hub.speed or 'tip.*' [default: those of the plot of a run, energies and contacts aside]
    #[arg(long, short, value_name = "NAMES", value_delimiter = ',')]
    columns: Vec<String>,
    /// File to write, .html
    #[arg(long, short, value_name = "FILE", default_value = "view.html")]
    output: PathBuf,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

/// Writes the page.
pub fn view(arguments: &Arguments) -> Outcome {
    match written(arguments) {
        Ok(()) => {
            screen::print(&screen::table(&[vec!["page".to_owned(), arguments.output.display().to_string()]]));
            Outcome::Finished
        }
        Err(message) => {
            screen::report(&format!("error: {message}\n"));
            Outcome::Rejected
        }
    }
}

fn written(arguments: &Arguments) -> Result<(), String> {
    let name = arguments.output.display();
    if arguments.output.extension().is_none_or(|extension| extension != "html") {
        return Err(format!("the page {name} must end in .html"));
    }
    if arguments.output.exists() && !arguments.force {
        return Err(format!("{name} exists; choose another name with --output or replace it with --force"));
    }
    let page = view_page(&arguments.result, &arguments.columns).map_err(|error| error.to_string())?;
    write_file(&arguments.output, page.as_bytes()).map_err(|error| error.to_string())
}

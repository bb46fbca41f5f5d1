//! `flexion man`: manual pages.

use crate::{Outcome, screen};
use clap::CommandFactory;
use clap_mangen::Man;
use flexion_results::write_file;
use std::path::PathBuf;

/// Where the pages go.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion man | man -l -
  flexion man --output ~/.local/share/man/man1")]
pub struct Arguments {
    /// Directory for flexion.1 and a page for every command; without it flexion.1 is printed
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
}

/// Prints the manual page, or writes all of them.
pub fn man(arguments: &Arguments) -> Outcome {
    match pages(arguments) {
        Ok(text) => {
            screen::print(&text);
            Outcome::Finished
        }
        Err(message) => {
            screen::report(&format!("error: {message}\n"));
            Outcome::Rejected
        }
    }
}

fn pages(arguments: &Arguments) -> Result<String, String> {
    let mut root = crate::Arguments::command().disable_help_subcommand(true);
    root.build();
    let Some(directory) = &arguments.output else { return page(root).map(|page| page.1) };
    let commands: Vec<clap::Command> = root.get_subcommands().cloned().collect();
    let mut out = String::new();
    for command in std::iter::once(root).chain(commands) {
        let (name, text) = page(command)?;
        let file = directory.join(name);
        write_file(&file, text.as_bytes()).map_err(|error| error.to_string())?;
        out.push_str(&format!("  {}\n", file.display()));
    }
    Ok(out)
}

/// File name and text of the page of a command.
fn page(command: clap::Command) -> Result<(String, String), String> {
    let name = command.get_display_name().unwrap_or_else(|| command.get_name()).to_owned();
    let mut text = Vec::new();
    Man::new(command)
        .render(&mut text)
        .map_err(|error| format!("cannot make the manual page of {name}: {error}"))?;
    Ok((format!("{name}.1"), String::from_utf8_lossy(&text).into_owned()))
}

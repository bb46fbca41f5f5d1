//! `flexion new`: a commented case file to begin with.

use crate::{Outcome, screen};
use clap::builder::PossibleValuesParser;
use flexion_case::TEMPLATES;
use flexion_results::write_file;
use std::path::PathBuf;

/// The template.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion new --list
  flexion new spin-up --output case.toml
  flexion new blade --output blade.toml
  flexion new exact-large-deflection | less")]
pub struct Arguments {
    /// Name of a template; --list shows them
    #[arg(value_name = "TEMPLATE", required_unless_present = "list", value_parser = known())]
    template: Option<String>,
    /// File to write, with what it needs beside it; without it the case is printed
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// List the templates
    #[arg(long, conflicts_with_all = ["template", "output"])]
    list: bool,
    /// Replace a file that exists
    #[arg(long)]
    force: bool,
}

/// The names of the templates, which shells complete.
fn known() -> PossibleValuesParser {
    TEMPLATES.iter().map(|template| template.name).collect::<Vec<_>>().into()
}

/// Prints or writes a template, or lists them.
pub fn new(arguments: &Arguments) -> Outcome {
    match text(arguments) {
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

fn text(arguments: &Arguments) -> Result<String, String> {
    let Some(name) = &arguments.template else {
        let rows = TEMPLATES.iter().map(|t| vec![t.name.to_owned(), t.summary.to_owned()]);
        return Ok(screen::table(&rows.collect::<Vec<_>>()));
    };
    let template =
        TEMPLATES.iter().find(|template| template.name == name).ok_or("there is no such template")?;
    let text = template.render().map_err(|problems| problems.render(false))?;
    let Some(file) = &arguments.output else { return Ok(text) };
    let mut out = format!("  case  {}\n", file.display());
    let mut files = vec![(file.clone(), text.as_str())];
    if let Some((name, text)) = template.file {
        let beside = file.with_file_name(name);
        out.push_str(&format!("  file  {}\n", beside.display()));
        files.push((beside, text));
    }
    if let Some((existing, _)) = files.iter().find(|(file, _)| file.exists() && !arguments.force) {
        let name = existing.display();
        return Err(format!("{name} exists; choose another name or replace it with --force"));
    }
    for (file, text) in files {
        write_file(&file, text.as_bytes()).map_err(|error| error.to_string())?;
    }
    Ok(out)
}

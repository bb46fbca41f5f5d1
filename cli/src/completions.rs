//! `flexion completions`: what a shell needs to complete command lines.

use crate::{Outcome, screen};
use clap::CommandFactory;
use clap_complete::Shell;

/// The shell.
#[derive(clap::Args)]
#[command(after_help = "Examples:
  flexion completions bash > ~/.local/share/bash-completion/completions/flexion
  flexion completions fish > ~/.config/fish/completions/flexion.fish")]
pub struct Arguments {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

/// Prints the completions.
pub fn completions(arguments: &Arguments) -> Outcome {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut crate::Arguments::command(), "flexion", &mut text);
    screen::print(&String::from_utf8_lossy(&text));
    Outcome::Finished
}

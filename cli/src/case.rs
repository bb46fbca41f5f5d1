//! The argument that names a case, and reading it.

use crate::screen;
use flexion_case::Reading;
use std::path::PathBuf;

/// A case and changes to it.
#[derive(clap::Args)]
pub struct Selection {
    /// Case file, or a folder that holds a case.toml
    #[arg(value_name = "CASE")]
    pub case: PathBuf,
    /// Change a key, e.g. section.modulus="30 GPa"; may be repeated
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub set: Vec<String>,
}

impl Selection {
    /// Reads the case; what is wrong with it goes to standard error.
    pub fn read(&self) -> Option<Reading> {
        self.read_with(&[])
    }

    /// As [`Selection::read`], with further changes after those of the user.
    pub fn read_with(&self, further: &[&str]) -> Option<Reading> {
        let set: Vec<String> =
            self.set.iter().cloned().chain(further.iter().map(|s| (*s).to_owned())).collect();
        match flexion_case::read(&self.case, &set) {
            Ok(reading) => Some(reading),
            Err(problems) => {
                screen::report(&problems.render(screen::colour()));
                None
            }
        }
    }

    /// Name of the case: its folder, if it is a `case.toml`, or else its file without extension.
    pub fn name(&self) -> String {
        let path = std::path::absolute(&self.case).unwrap_or_else(|_| self.case.clone());
        let of_file =
            |path: &std::path::Path| path.file_stem().map(|name| name.to_string_lossy().into_owned());
        let of_folder =
            |path: &std::path::Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
        let name = if path.is_dir() {
            of_folder(&path)
        } else if path.file_name().is_some_and(|name| name == "case.toml") {
            path.parent().and_then(of_folder)
        } else {
            of_file(&path)
        };
        name.unwrap_or_else(|| "case".to_owned())
    }
}

//! Case files: the only module that knows every name.
//!
//! ```text
//! text ─▶ tree (spanned TOML) ─▶ values (by the declarations, in SI) ─▶ Case ─▶ live objects
//! ```
//!
//! Keys and kinds are declared once, in the language of [`declaration`]; reading, messages, the
//! listing ([`seams`]), the JSON Schema ([`schema`]) and the resolved case ([`Reading::resolved`])
//! follow from the declarations. All problems of a case are reported at once, as [`Problems`].
//!
//! To add a kind: write its code in a file of its own elsewhere, then in the file of its seam here
//! add one entry to the table of kinds and one arm to `read`, and one arm in `build`.

pub mod build;
pub mod declaration;
mod error;
pub mod units;

mod basis;
mod blade;
mod blade_file;
mod campbell;
mod elsewhere;
mod initial;
mod integrator;
mod layout;
mod load_build;
mod load_trial;
pub mod loads;
mod motion;
mod problem;
mod reader;
mod resolved;
mod restart;
mod run;
mod schema;
mod section;
mod section_file;
mod template;
mod torque;
mod tree;
mod trial;
mod values;

pub use basis::{Bases, Basis, RadialBasis};
pub use blade::{Blade, StrainEnergy};
pub use blade_file::BladeFormat;
pub use campbell::{Build, campbell};
pub use error::{ColumnError, Errors};
pub use initial::Initial;
pub use integrator::Integrator;
pub use layout::{Case, Coupling, Hub, Output};
pub use motion::{Motion, MotionOf};
pub use problem::{Place, Problem, Problems, Source};
pub use run::{Prepared, Run};
pub use schema::schema;
pub use section::{Interpolation, Section, Segment, Shape};
pub use template::{TEMPLATES, Template};
pub use torque::{Controller, Free, Torque};

use build::BuildError;
use declaration::Seam;
use flexion::system::{Dynamics, Events, State, System};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use tree::Raw;
use values::Values;

/// Largest case file that is read [bytes].
const LARGEST: u64 = 10_000_000;

/// Intervals of a run at whose ends the step of an explicit method is held against its stability limit.
const STABILITY_TIMES: usize = 8;

/// The live objects of a case.
pub struct Live {
    /// The mechanical system.
    pub system: Box<dyn System>,
    /// The integrator, not yet started.
    pub integrator: Box<dyn flexion::integrator::Integrator>,
}

/// A case that was read, with all that is known about how it was written.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The case, in SI.
    pub case: Case,
    /// The file.
    pub file: PathBuf,
    values: Values,
    sources: Vec<Source>,
}

impl Reading {
    /// The case as a file with every default filled in, in SI, that reads back as the same case.
    pub fn resolved(&self) -> String {
        resolved::resolved(&self.values, false)
    }

    /// As [`Reading::resolved`], beside copies of the tables that the case names: `motion.csv`, `torque.csv` and
    /// `section.csv`.
    pub fn resolved_with_copies(&self) -> String {
        resolved::resolved(&self.values, true)
    }

    /// The tables that the case names: dotted path of the key and file.
    fn tables(&self) -> Vec<(String, PathBuf)> {
        let folder = self.file.parent().unwrap_or(Path::new(""));
        let mut found = Vec::new();
        resolved::paths(&self.values, "", &mut found);
        found.into_iter().map(|(key, file)| (key, restart::state_file(&folder.join(file)))).collect()
    }

    /// The defaults in force: dotted path and value.
    pub fn defaults(&self) -> Vec<(String, String)> {
        let mut out = Vec::new();
        self.values.defaults("", &mut out);
        out
    }

    /// What a table of the case says, in SI and with its defaults, for a summary: `integrator`.
    pub fn settings(&self, table: &str) -> serde_json::Map<String, serde_json::Value> {
        let values = self.values.table(table).or_else(|| self.values.kind(table).map(|(_, values)| values));
        values.map(values::Values::to_json).unwrap_or_default()
    }

    /// The live objects: the mechanical system and the integrator, which has passed its stability limit for
    /// the undeformed beam at several times of the run if it is explicit.
    ///
    /// # Errors
    /// [`Problems`] at the key that is to blame.
    pub fn build(&self) -> Result<Live, Problems> {
        let case = &self.case;
        let mut system = build::system(case).map_err(|error| {
            let key = match &error {
                BuildError::Section(_) => "section",
                BuildError::Motion(_) => "hub.motion",
                BuildError::Basis(_) => "basis",
                BuildError::Load(_) => "force",
                BuildError::Blade(_) => "blade",
            };
            self.problem(key, error.to_string())
        })?;
        let integrator = || {
            build::integrator(&case.integrator).map_err(|error| self.problem("integrator", error.to_string()))
        };
        let mut trial = integrator()?;
        if let (false, Some(step)) = (trial.info().implicit, case.integrator.step()) {
            // The largest frequency changes with the speed of the hub.
            let among = (0..=STABILITY_TIMES).map(|k| case.duration * k as f64 / STABILITY_TIMES as f64);
            let within = system.breaks().iter().map(|b| b.time).filter(|t| *t <= case.duration);
            for t in among.chain(within).collect::<Vec<_>>() {
                let mut state = State { t, ..system.initial() };
                trial
                    .start(system.as_mut(), &mut state, step)
                    .map_err(|error| self.problem("integrator.step", error.to_string()))?;
            }
        }
        Ok(Live { system, integrator: integrator()? })
    }

    /// A problem with the case that was found later, when it was built: `key` is a dotted path.
    pub fn problem(&self, key: &str, message: impl Into<String>) -> Problems {
        let mut place = None;
        let mut values = Some(&self.values);
        for part in key.split('.') {
            let Some(table) = values else { break };
            place = table.place(part).or(place);
            values = table.table(part).or_else(|| table.kind(part).map(|(_, values)| values));
        }
        Problems { sources: self.sources.clone(), list: vec![Problem::new(key, place, message)] }
    }
}

/// Every place in a case where a kind is chosen, with the kinds.
pub fn seams() -> &'static [&'static Seam] {
    layout::SEAMS
}

/// Reads a case: a file, or a folder that holds a `case.toml`. Each override is `KEY=VALUE`.
///
/// # Errors
/// Everything that is wrong with the file, the case in it or the overrides.
pub fn read(path: &Path, overrides: &[String]) -> Result<Reading, Problems> {
    let file = if path.is_dir() { path.join("case.toml") } else { path.to_owned() };
    match load(&file) {
        Ok(text) => parse(text, &file, overrides),
        Err((message, help)) => {
            let source = Source { name: file.display().to_string(), text: String::new() };
            let mut problem = Problem::new("", None, message);
            problem.help.extend(help);
            Err(Problems { sources: vec![source], list: vec![problem] })
        }
    }
}

/// Reads a case from its text; `file` names it in messages, and paths in it are relative to its folder.
///
/// # Errors
/// Everything that is wrong with the case or the overrides.
pub fn parse(text: String, file: &Path, overrides: &[String]) -> Result<Reading, Problems> {
    let mut problems = Problems::default();
    problems.sources.push(Source { name: file.display().to_string(), text: text.clone() });
    let root = tree::read(&text, overrides, &mut problems);
    // What a broken file seems to say is not worth reporting: its syntax comes first.
    let mut reading = None;
    if let (true, Raw::Table(entries)) = (problems.list.is_empty(), &root.value) {
        let mut values = reader::table(entries, None, layout::KEYS, "", &mut problems);
        let folder = file.parent().unwrap_or(Path::new(""));
        if let Some(case) = layout::case(&mut values, folder, &mut problems) {
            reading =
                Some(Reading { case, file: file.to_owned(), values, sources: problems.sources.clone() });
        }
    }
    match reading {
        Some(reading) if problems.list.is_empty() => Ok(reading),
        _ => {
            problems.sort();
            Err(problems)
        }
    }
}

/// The text of a file, or what is wrong with it and what to do.
fn load(file: &Path) -> Result<String, (String, Option<String>)> {
    let name = file.display();
    let help = || Some("a case is a TOML file, or a folder that holds a case.toml".to_owned());
    let failed = |error: std::io::Error| {
        let folder = file.parent().filter(|folder| file.ends_with("case.toml") && folder.is_dir());
        match (error.kind() == std::io::ErrorKind::NotFound, folder) {
            (true, Some(folder)) if !folder.as_os_str().is_empty() => {
                (format!("the folder {} holds no case.toml", folder.display()), help())
            }
            (true, _) => (format!("cannot read {name}: {error}"), help()),
            (false, _) => (format!("cannot read {name}: {error}"), None),
        }
    };
    let metadata = std::fs::metadata(file).map_err(failed)?;
    if metadata.is_dir() {
        return Err((format!("{name} is not a file but a folder"), help()));
    }
    if !metadata.is_file() {
        return Err((format!("{name} is not a file but a pipe or a device"), help()));
    }
    // The size is checked on what is read: a file may grow, or have none until it is read.
    let mut bytes = Vec::new();
    File::open(file).and_then(|f| f.take(LARGEST + 1).read_to_end(&mut bytes)).map_err(failed)?;
    if bytes.len() as u64 > LARGEST {
        return Err((
            format!("{name} is larger than {} MB: a case file is text of a few kB", LARGEST / 1_000_000),
            None,
        ));
    }
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let line = error.as_bytes()[..at].iter().filter(|byte| **byte == b'\n').count() + 1;
        (
            format!("{name} is not UTF-8 text: byte {at}, on line {line}, is not"),
            Some("save it as UTF-8".to_owned()),
        )
    })
}

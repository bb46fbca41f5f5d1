//! A case that was read: how it was written, and the parts made of it.

use super::case::{self, Case};
use super::change::Change;
use super::declaration::Presence;
use super::fault::{Fault, Faults};
use super::files::deck;
use super::kind::Context;
use super::kinds::initial::Initial;
use super::kinds::integrator::Method;
use super::kinds::name::{PLAIN, is_plain};
use super::laws::{self, Law, Signals};
use super::layout::{self, INTEGRATOR};
use super::problem::{Problem, Problems, Source, inside};
use super::reader;
use super::resolved;
use super::short;
use super::sources::{Contents, Files, Folder, Sources};
use super::space::Space;
use super::tree::{self, Node, Raw};
use super::values::{Value, Values};
use flexion::command::Commanded;
use flexion::integrator::Integrator;
use flexion::system::{Jump, State, System};
use flexion_results::Artifact;
use std::cell::RefCell;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Largest case file that is read [bytes].
const LARGEST: u64 = 10_000_000;

/// Intervals of a run at whose ends the step of an explicit method is held against its stability limit.
const STABILITY_TIMES: usize = 8;

/// The live objects of a case.
pub struct Live {
    /// The mechanical system.
    pub system: Box<dyn System>,
    /// The integrator, not yet started.
    pub integrator: Box<dyn Integrator>,
}

/// A value of a sweep, laid over a case.
#[cfg(feature = "sweep")]
#[derive(Clone, Debug)]
pub(super) enum Laid {
    /// A number.
    Typed(Change),
    /// `KEY=VALUE`.
    Text(String),
}

/// A case that was read, with all that is known about how it was written.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The parts of the case.
    pub case: Case,
    /// The file.
    pub file: PathBuf,
    root: Node,
    pub(super) values: Values,
    /// The values of the short spelling, of a case that has one, and what its keys are called there.
    short: Option<(Values, Vec<[String; 2]>)>,
    sources: Vec<Source>,
    pub(super) files: Contents,
    /// Laws of a program, and what they command of the parts.
    laws: Arc<[Law]>,
    signals: Signals,
}

impl Reading {
    /// The case as a file with every default filled in, in SI, that reads back as the same case.
    pub fn resolved(&self) -> String {
        resolved::resolved(&self.values, None)
    }

    /// The case as it is written, in SI and without defaults, which reads back as the same case beside the same files.
    pub fn stated(&self) -> String {
        resolved::resolved(&self.written().written(), None).trim_start().to_owned()
    }

    /// The files that the case names, by their names in it.
    pub fn contents(&self) -> &Contents {
        &self.files
    }

    /// Whether both are the same case: the same values in SI, defaults included, and the same bytes of files, whatever these are called.
    pub fn means(&self, other: &Reading) -> bool {
        self.resolved_with_copies() == other.resolved_with_copies() && self.copied().eq(other.copied())
    }

    /// As [`Reading::resolved`], beside copies of the tables that the case names: `motion.csv`, `torque.csv` and
    /// `section.csv`.
    pub fn resolved_with_copies(&self) -> String {
        let files: Vec<String> = self.tables().into_iter().map(|(key, _)| key).collect();
        resolved::resolved(&self.values, Some(&files))
    }

    /// The long spelling of a system in space: what is written, in SI, without defaults. A short case is turned into it as it is computed.
    ///
    /// # Errors
    /// At the coupling of a case in the plane, which has no other spelling.
    pub fn long(&self) -> Result<String, Problems> {
        if layout::is_spatial(self.values.keys) {
            return Ok(resolved::resolved(&self.values.written(), None));
        }
        let message =
            "is a model of one beam on a hub in the plane, and the long spelling is of systems in space";
        let fault = Fault::new("model.coupling", message);
        Err(self
            .problems(fault.help("write `model.coupling = \"space\"` to compute the case in space").into()))
    }

    /// The files that the case names: dotted path of the table and bytes. Behind the primary file of a deck of BeamDyn stands the blade file that it names.
    pub(super) fn tables(&self) -> Vec<(String, &[u8])> {
        let mut found = Vec::new();
        resolved::paths(&self.values, "", &mut found);
        let found = found.into_iter().flat_map(|(key, name)| {
            let blade = self.blade_file(&key, &name).map(|blade| (resolved::of_blade(&key), blade));
            std::iter::once((key, name)).chain(blade)
        });
        let bytes = |(key, name): (String, String)| self.files.get(&name).map(|bytes| (key, &**bytes));
        found.filter_map(bytes).collect()
    }

    /// The name of the blade file that a file names, which the table at a dotted path gives as a deck of BeamDyn.
    fn blade_file(&self, table: &str, name: &str) -> Option<String> {
        let table = table.split('.').try_fold(&self.values, |table, part| table.inner(part))?;
        let is_beamdyn = matches!(&table.get("format")?.value, Value::Text(format) if format == "beamdyn");
        if is_beamdyn { deck::blade_file(self.files.get(name)?, name) } else { None }
    }

    /// Copies of these files, which name each other by their names among the results.
    pub(super) fn copies(&self) -> Vec<(Artifact, Vec<u8>)> {
        self.copied().filter_map(|(artifact, bytes)| Some((artifact?, bytes))).collect()
    }

    /// The bytes of these copies; of a file that is not copied they are its own.
    fn copied(&self) -> impl Iterator<Item = (Option<Artifact>, Vec<u8>)> {
        let tables = self.tables();
        let keys: Vec<String> = tables.iter().map(|(key, _)| key.clone()).collect();
        tables.into_iter().map(move |(key, bytes)| {
            let blade = resolved::of_blade(&key);
            let blade = if keys.contains(&blade) { resolved::copy(&blade, &keys) } else { None };
            let bytes = blade.map_or_else(
                || bytes.to_vec(),
                |blade| deck::with_blade_file(bytes, &blade.file_name()).into_bytes(),
            );
            (resolved::copy(&key, &keys), bytes)
        })
    }

    /// The files that the case is read from: its own and all that it names.
    pub fn inputs(&self) -> Vec<PathBuf> {
        let folder = Folder::of(&self.file);
        std::iter::once(self.file.clone()).chain(self.files.keys().map(|name| folder.file(name))).collect()
    }

    /// The defaults in force: dotted path and value.
    pub fn defaults(&self) -> Vec<(String, String)> {
        let mut out = Vec::new();
        resolved::defaults(&self.values, "", &mut out);
        out
    }

    /// What a table of the case says, in SI and with its defaults, for a summary: `integrator`.
    pub fn settings(&self, table: &str) -> serde_json::Map<String, serde_json::Value> {
        self.values.inner(table).map(Values::to_json).unwrap_or_default()
    }

    /// The same case with changes `KEY=VALUE`, read anew; the files that it names are those that were read.
    ///
    /// # Errors
    /// Everything that is wrong with the changes.
    pub fn with(&self, changes: &[String]) -> Result<Reading, Problems> {
        self.after(changes, |root, change, problems| tree::lay_over(root, change, problems))
    }

    /// The same case with changes of the program's own.
    ///
    /// # Errors
    /// Everything that is wrong with the changes.
    pub fn changed(&self, changes: &[Change]) -> Result<Reading, Problems> {
        self.after(changes, tree::change)
    }

    /// The same case with further loads, tables of TOML, of which some have the amplitude zero.
    pub(super) fn with_loads(&self, loads: &[(String, bool)]) -> Result<Reading, Problems> {
        self.after(loads, |root, (load, silent), problems| tree::push_load(root, load, *silent, problems))
    }

    /// The same case with laws of a program, which hold for runs alone: no file holds them. Laws of loads come with loads, whose amplitudes
    /// they are.
    ///
    /// # Errors
    /// What a law drives is not there, a load is wrong, or the case goes on from an earlier run.
    pub fn with_laws(&self, laws: Vec<Law>) -> Result<Reading, Problems> {
        let names: Vec<&str> = laws.iter().map(|law| law.name.as_str()).collect();
        if let Some((_, name)) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)) {
            return Err(self.problem("", format!("the law `{name}` is given twice")));
        }
        if let (Initial::Restart(_), false) = (&self.case.initial, laws.is_empty()) {
            let message = "a run with laws of a program begins at t = 0: what they remember of an earlier run is in no file";
            return Err(self.problem("initial.kind", message));
        }
        for law in &laws {
            let own = law.load.iter().map(|_| (&law.name, "law"));
            let states = law.states.iter().map(|state| (&state.name, "state"));
            if let Some((name, what)) = own.chain(states).find(|(name, _)| !name.split('.').all(is_plain)) {
                let message = format!(
                    "a {what} is called {name:?}, which cannot stand in the name of a column: {PLAIN}"
                );
                return Err(self.problem("", message));
            }
        }
        let loads: Vec<(String, bool)> =
            laws.iter().filter_map(|law| Some((law.load.clone()?, true))).collect();
        let loaded = self.without_laws()?.with_loads(&loads)?;
        let problems = Problems { sources: loaded.sources, ..Problems::default() };
        interpreted(loaded.root, &self.file, &self.files, problems, &laws.into())
    }

    /// The case without the laws of a program and their loads.
    ///
    /// # Errors
    /// None that the case has not had before.
    pub fn without_laws(&self) -> Result<Reading, Problems> {
        let mut root = self.root.clone();
        tree::pop_loads(&mut root, self.laws.iter().filter(|law| law.load.is_some()).count());
        let problems = Problems { sources: self.sources.clone(), ..Problems::default() };
        interpreted(root, &self.file, &self.files, problems, &Arc::default())
    }

    /// The laws of a program.
    pub fn laws(&self) -> &[Law] {
        &self.laws
    }

    /// The same case with values of a sweep.
    ///
    /// # Errors
    /// Everything that is wrong with the changes.
    #[cfg(feature = "sweep")]
    pub(super) fn laid(&self, values: &[Laid]) -> Result<Reading, Problems> {
        self.after(values, |root, value, problems| match value {
            Laid::Typed(change) => tree::change(root, change, problems),
            Laid::Text(text) => tree::lay_over(root, text, problems),
        })
    }

    /// The texts that the case was read from: a further change is the next one.
    pub(super) fn sources(&self) -> &[Source] {
        &self.sources
    }

    /// The key of this name that a change, a source by its number, has set.
    #[cfg(feature = "sweep")]
    pub(super) fn set_by(&self, source: usize, name: &str) -> Option<&super::values::Filled> {
        self.written().set_by(source, name)
    }

    fn after<C>(
        &self,
        changes: &[C],
        make: impl Fn(&mut Node, &C, &mut Problems),
    ) -> Result<Reading, Problems> {
        let mut problems = Problems { sources: self.sources.clone(), ..Problems::default() };
        let mut root = self.root.clone();
        changes.iter().for_each(|change| make(&mut root, change, &mut problems));
        interpreted(root, &self.file, &self.files, problems, &self.laws)
    }

    /// The live objects: the mechanical system and the integrator, which has passed its stability limit for
    /// the undeformed beam at several times of the run if it is explicit.
    ///
    /// # Errors
    /// [`Problems`] at the key that is to blame.
    pub fn build(&self) -> Result<Live, Problems> {
        if self.laws.is_empty() {
            return self.build_without_laws();
        }
        // Each run has signals and laws of its own.
        let own = self.after::<()>(&[], |_, (), _| {})?;
        let Live { system, integrator } = own.build_without_laws()?;
        let inputs = own.signals.inputs().map_err(|why| self.problem("", why))?;
        let commanded = Commanded::new(system, inputs, self.case.duration);
        let system = commanded.map_err(|fault| self.problem("", laws::said(&fault)))?;
        Ok(Live { system: Box::new(system), integrator })
    }

    fn build_without_laws(&self) -> Result<Live, Problems> {
        let case = &self.case;
        let mut system = case.system().map_err(|faults| self.problems(faults))?;
        let explicit = self.integrator()?;
        if let (false, Some(step)) = (explicit.info().implicit, case.steps.step()) {
            // The largest frequency changes with the speed of the hub.
            let among = (0..=STABILITY_TIMES).map(|k| case.duration * k as f64 / STABILITY_TIMES as f64);
            let breaks =
                system.breaks().iter().filter(|b| b.jump != Jump::Nothing && b.time <= case.duration);
            let within = breaks.map(|b| b.time);
            for t in among.chain(within).collect::<Vec<_>>() {
                let mut state = State { t, ..system.initial() };
                explicit
                    .start(system.as_mut(), &mut state, step)
                    .map_err(|error| self.problem("integrator.step", error.to_string()))?;
            }
        }
        Ok(Live { system, integrator: self.integrator()? })
    }

    /// Whether the vibrations of the case are those of all that it contains: a system in space is at rest or rotates as a whole.
    ///
    /// # Errors
    /// [`Problems`] at the tables that are to blame.
    pub fn fits_modes(&self) -> Result<(), Problems> {
        let fits = self.case.space().map_or(Ok(()), Space::moves_steadily);
        fits.map_err(|faults| self.problems(faults))
    }

    /// A new integrator: it belongs to one run.
    fn integrator(&self) -> Result<Box<dyn Integrator>, Problems> {
        let files = Files::new(&self.files);
        let length = self.case.hub_beam().map(|beam| beam.length);
        let cautions = RefCell::default();
        let context = Context {
            length,
            duration: Some(self.case.duration),
            parts: None,
            files: &files,
            cautions: &cautions,
            signals: &Signals::default(),
        };
        let method = INTEGRATOR.read(&self.values, &context);
        method.map(|Method { integrator, .. }| integrator).map_err(|faults| self.problems(faults))
    }

    /// A problem with the case that was found later, when it was built: `key` is a dotted path.
    pub fn problem(&self, key: &str, message: impl Into<String>) -> Problems {
        self.problems(Fault::new(key, message).into())
    }

    /// The values as they are spelled.
    pub(super) fn written(&self) -> &Values {
        self.short.as_ref().map_or(&self.values, |(values, _)| values)
    }

    /// What a run needs and the case leaves out, which modes and diagrams do without: none, if it can be run.
    ///
    /// # Errors
    /// [`Problems`] at the tables in which the keys are missing.
    pub fn missing_for_run(&self) -> Result<(), Problems> {
        let tables = self.written().entries.iter().filter_map(|filled| match &filled.value {
            Value::Table(values) => Some((filled.key.name, values)),
            _ => None,
        });
        let missing = tables.flat_map(|(name, values)| {
            let left_out = values
                .keys
                .iter()
                .filter(|key| key.presence == Presence::Run && values.get(key.name).is_none());
            left_out
                .map(move |key| reader::missing(key, &format!("{name}.{}", key.name), values.place.clone()))
        });
        let list: Vec<Problem> = missing.collect();
        if list.is_empty() {
            Ok(())
        } else {
            Err(Problems { sources: self.sources.clone(), list, misread: false })
        }
    }

    pub(super) fn problems(&self, faults: Faults) -> Problems {
        let mut problems = Problems { sources: self.sources.clone(), ..Problems::default() };
        let renamed = self.short.as_ref().map_or(&[][..], |(_, renamed)| renamed);
        report(faults, &self.values, renamed, &mut problems);
        problems
    }
}

/// Notes the faults of makers at the places of their keys, with the names that these have in the short spelling of a case.
fn report(faults: Faults, values: &Values, renamed: &[[String; 2]], problems: &mut Problems) {
    for fault in faults.0 {
        let (mut place, text) = values.find(&fault.key);
        if let (Some(span), Some(whole), Some(text)) = (fault.span, &place, text) {
            place = Some(inside(whole, text, span, problems));
        }
        let mut problem = Problem::new(named(&fault.key, renamed), place, fault.message);
        problem.help.extend(fault.help);
        problems.push(problem);
    }
}

/// The name of a key by the beginnings of paths that have another.
fn named(key: &str, renamed: &[[String; 2]]) -> String {
    let other = renamed.iter().find_map(|[long, short]| {
        let rest = key.strip_prefix(long.as_str())?;
        (rest.is_empty() || rest.starts_with('.')).then(|| format!("{short}{rest}"))
    });
    other.unwrap_or_else(|| key.to_owned())
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
            Err(Problems { sources: vec![source], list: vec![problem], misread: true })
        }
    }
}

/// Reads a case from its text; `file` names it in messages, and paths in it are relative to its folder.
///
/// # Errors
/// Everything that is wrong with the case or the overrides.
pub fn parse(text: String, file: &Path, overrides: &[String]) -> Result<Reading, Problems> {
    parse_with(text, file, overrides, &Folder::of(file))
}

/// As [`parse`]; the files that the case names are those of `sources`.
///
/// # Errors
/// As [`parse`].
pub fn parse_with(
    text: String,
    file: &Path,
    overrides: &[String],
    sources: &dyn Sources,
) -> Result<Reading, Problems> {
    let mut problems = Problems::default();
    problems.sources.push(Source { name: file.display().to_string(), text: text.clone() });
    let root = tree::read(&text, overrides, &mut problems);
    interpreted(root, file, sources, problems, &Arc::default())
}

/// Makes the case of its tree; `problems` are those of its text.
fn interpreted(
    root: Node,
    file: &Path,
    sources: &dyn Sources,
    mut problems: Problems,
    laws: &Arc<[Law]>,
) -> Result<Reading, Problems> {
    problems.misread = !problems.list.is_empty();
    // What a broken file seems to say is not worth reporting: its syntax comes first.
    if let (true, Raw::Table(entries)) = (problems.list.is_empty(), &root.value) {
        let mut values = reader::table(entries, None, layout::keys_of(entries), "", &mut problems);
        problems.misread = !problems.list.is_empty();
        let files = Files::new(sources);
        let (mut short, mut cautions) = (None, Vec::new());
        if short::asks_for_space(&values) && !layout::is_spatial(values.keys) && problems.list.is_empty() {
            match short::long(entries, &values, &files) {
                Ok(long) => {
                    let of = reader::table(&long.lines, None, layout::spatial_keys(), "", &mut problems);
                    short = Some((std::mem::replace(&mut values, of), long.renamed));
                    cautions = long.cautions;
                }
                Err(faults) => {
                    report(faults, &values, &[], &mut problems);
                    problems.sort();
                    return Err(problems);
                }
            }
        }
        let renamed = short.as_ref().map_or(&[][..], |(_, renamed)| renamed);
        let signals = Signals::new(laws);
        match case::case(&mut values, &files, &signals) {
            Ok(mut case) if problems.list.is_empty() => {
                case.cautions.append(&mut cautions);
                let files = files.into_contents();
                let (file, sources) = (file.to_owned(), problems.sources);
                let laws = Arc::clone(laws);
                return Ok(Reading { case, file, root, values, short, sources, files, laws, signals });
            }
            Ok(_) => {}
            Err(faults) => report(faults, &values, renamed, &mut problems),
        }
    }
    if problems.list.is_empty() {
        let message =
            "this is a mistake in the program: a part of the case is missing, and no maker says why";
        problems.push(Problem::new("", None, message));
    }
    problems.sort();
    Err(problems)
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

//! All rows of a sweep in a folder: on several threads, in parts, from wherever it was ended.

use super::identity::{self, difference};
use super::keeping::{Keeping, Totals};
use super::part::{Parts, own};
use super::row::{Row, Status};
use super::table::Named;
use super::{Sweep, SweepError, csv_file, table};
use flexion_results::resolved_case;
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// What the folder says of its sweep.
const MANIFEST: &str = "sweep.json";
/// The case that is varied.
const CASE: &str = "case.resolved.toml";
/// All rows as text.
const CSV: &str = "sweep.csv";

/// One of several processes, each of which computes some parts of a sweep: jobs of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Its number, from 1.
    pub number: usize,
    /// How many there are.
    pub of: usize,
}

/// How a sweep is computed; its rows do not depend on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct How {
    /// Number of threads; 0 for one a processor.
    pub threads: usize,
    /// Which parts are computed.
    pub shard: Shard,
    /// Whether it goes on where more than a tenth of the rows fail.
    pub keep_going: bool,
}

impl Default for How {
    fn default() -> How {
        How { threads: 0, shard: Shard { number: 1, of: 1 }, keep_going: false }
    }
}

/// How far a sweep is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Rows that are kept, and rows of this shard.
    pub rows: (usize, usize),
    /// Rows among them that did not finish.
    pub failures: usize,
}

/// Why a sweep ended before its last row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// Whoever watched it stopped it.
    Asked,
    /// More than a tenth of its rows had failed.
    Failures {
        /// Rows that had not finished.
        failures: usize,
        /// The rows, from the first of the shard on, among which they are.
        rows: usize,
    },
}

/// What became of a sweep.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What the rows that are kept say together.
    pub totals: Totals,
    /// Rows of this shard.
    pub rows: usize,
    /// Rows that were there before.
    pub found: usize,
    /// Why not all are kept, or too many have failed; `None` where all is well.
    pub stop: Option<Stop>,
    /// The file of all rows, where they are there, those of other shards too.
    pub csv: Option<PathBuf>,
}

/// What the threads share.
struct Shared<'a> {
    missing: Vec<(usize, usize)>,
    next: AtomicUsize,
    stop: AtomicBool,
    keeping: Mutex<(Keeping, Option<Stop>, Option<SweepError>)>,
    rows: usize,
    how: &'a How,
}

impl Sweep {
    /// Computes all rows of a shard that the folder does not hold yet and keeps them there, part by part. It may be ended at any moment: what is
    /// whole is not computed again. `watch` is called after every step, from all threads, and ends the sweep by `Break`; `said` is told how far
    /// it is whenever a part is kept.
    ///
    /// # Errors
    /// A folder that holds something else, with what differs; whatever the system says.
    pub fn run_all(
        &self,
        folder: &Path,
        how: &How,
        watch: &(dyn Fn() -> ControlFlow<()> + Sync),
        said: &(dyn Fn(Progress) + Sync),
    ) -> Result<Outcome, SweepError> {
        let Shard { number, of } = how.shard;
        if number == 0 || number > of {
            return Err(SweepError::Asked(format!(
                "there is no shard {number} of {of}: the first is 1/{of}"
            )));
        }
        let identity = self.identity();
        let parts = Parts::new(self, folder, identity::name(&identity));
        self.take(folder, &parts, &identity)?;
        let own: Vec<usize> = (0..parts.count()).filter(|part| part % of == number - 1).collect();
        let rows = own.iter().map(|part| parts.chunk(*part).count).sum();
        let (mut keeping, mut missing, mut stop) = (Keeping::default(), Vec::new(), None);
        for (place, part) in own.into_iter().enumerate() {
            match parts.read(part) {
                Some(found) => stop = keeping.add(place, &found, rows).or(stop),
                None => missing.push((place, part)),
            }
        }
        let found = keeping.totals.rows;
        let failures = |(failures, rows)| Stop::Failures { failures, rows };
        let stop = stop.filter(|_| !how.keep_going).map(failures);
        let mut shared = Shared {
            missing,
            next: AtomicUsize::new(0),
            stop: AtomicBool::new(stop.is_some()),
            keeping: Mutex::new((keeping, stop, None)),
            rows,
            how,
        };
        let threads = match how.threads {
            0 => thread::available_parallelism().map_or(1, usize::from),
            n => n,
        };
        thread::scope(|scope| {
            let work = || self.work(&parts, &shared, watch, said);
            let others: Vec<_> = (1..threads.min(shared.missing.len())).map(|_| scope.spawn(work)).collect();
            work();
            for other in others {
                other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
            }
        });
        let (keeping, stop, error) =
            std::mem::take(shared.keeping.get_mut().unwrap_or_else(|e| e.into_inner()));
        if let Some(error) = error {
            return Err(error);
        }
        let csv = if stop == Some(Stop::Asked) { None } else { self.merge(folder, &parts)? };
        parts.tidy();
        Ok(Outcome { totals: keeping.totals, rows, found, stop, csv })
    }

    /// Makes a folder one of this sweep: it holds the case and what is varied, and parts may be added.
    ///
    /// # Errors
    /// A folder that holds something else, with what differs; whatever the system says.
    pub fn open(&self, folder: &Path) -> Result<(), SweepError> {
        let identity = self.identity();
        let parts = Parts::new(self, folder, identity::name(&identity));
        self.take(folder, &parts, &identity)
    }

    /// The rows that a folder holds, in their order.
    pub fn kept(&self, folder: &Path) -> Vec<Row> {
        let parts = Parts::new(self, folder, identity::name(&self.identity()));
        (0..parts.count()).filter_map(|part| parts.read(part)).flatten().collect()
    }

    /// Numbers of the parts that a folder holds, torn ones aside.
    pub fn kept_parts(&self, folder: &Path) -> Vec<usize> {
        let parts = Parts::new(self, folder, identity::name(&self.identity()));
        (0..parts.count()).filter(|part| parts.read(*part).is_some()).collect()
    }

    /// Whether so many of the rows that a folder holds failed that the sweep stops, judged as [`Sweep::run_all`] does.
    pub fn fails(&self, folder: &Path) -> bool {
        let parts = Parts::new(self, folder, identity::name(&self.identity()));
        let mut keeping = Keeping::default();
        let mut judge = |part| parts.read(part).and_then(|rows| keeping.add(part, &rows, self.rows));
        (0..parts.count()).any(|part| judge(part).is_some())
    }

    /// Rows as columns, as they stand in files.
    pub fn table(&self, rows: &[Row]) -> Vec<Named> {
        table::columns(self, rows)
    }

    /// Computes part after part until none is missing, or the sweep stops.
    fn work(
        &self,
        parts: &Parts<'_>,
        shared: &Shared<'_>,
        watch: &(dyn Fn() -> ControlFlow<()> + Sync),
        said: &(dyn Fn(Progress) + Sync),
    ) {
        loop {
            if shared.stop.load(Ordering::Relaxed) {
                return;
            }
            let next = shared.next.fetch_add(1, Ordering::Relaxed);
            let Some((place, part)) = shared.missing.get(next).copied() else { return };
            let mut asked = false;
            let rows = self.run(parts.chunk(part), &mut || {
                if watch().is_break() {
                    asked = true;
                    shared.stop.store(true, Ordering::Relaxed);
                }
                let stop = asked || shared.stop.load(Ordering::Relaxed);
                if stop { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            let whole = rows.len() == parts.chunk(part).count && rows.last().is_none_or(is_kept);
            let written = if whole { parts.write(part, &rows) } else { Ok(()) };
            let mut keeping = shared.keeping.lock().unwrap_or_else(|error| error.into_inner());
            if asked {
                keeping.1 = Some(Stop::Asked);
            }
            match written {
                Ok(()) if whole => {
                    let too_many = keeping.0.add(place, &rows, shared.rows);
                    if let Some((failures, rows)) = too_many.filter(|_| !shared.how.keep_going) {
                        keeping.1 = keeping.1.or(Some(Stop::Failures { failures, rows }));
                        shared.stop.store(true, Ordering::Relaxed);
                    }
                    let totals = &keeping.0.totals;
                    said(Progress { rows: (totals.rows, shared.rows), failures: totals.failures() });
                }
                Ok(()) => {}
                Err(error) => {
                    keeping.2 = Some(error);
                    shared.stop.store(true, Ordering::Relaxed);
                }
            }
        }
    }

    /// Takes a folder: one that is new or empty, or one with this very sweep.
    fn take(
        &self,
        folder: &Path,
        parts: &Parts<'_>,
        identity: &Map<String, Value>,
    ) -> Result<(), SweepError> {
        let io = |what: &'static str| {
            move |source: std::io::Error| SweepError::Io { what, path: folder.to_owned(), source }
        };
        let refused = |what: String| SweepError::Folder { path: folder.to_owned(), what };
        if folder.exists() && !folder.is_dir() {
            return Err(refused("is not a folder".to_owned()));
        }
        fs::create_dir_all(folder).map_err(io("make the folder"))?;
        let manifest = folder.join(MANIFEST);
        if let Ok(text) = fs::read_to_string(&manifest) {
            let there = serde_json::from_str::<Value>(&text).ok();
            let there = there.as_ref().and_then(|there| there.get("identity")?.as_object());
            let there = there.ok_or_else(|| refused(format!("holds a {MANIFEST} that is not of a sweep")))?;
            if let Some(differs) = difference(there, identity) {
                return Err(refused(format!("holds another sweep: {differs}; take another folder")));
            }
        }
        let names = fs::read_dir(folder).map_err(io("read the folder"))?;
        let names: Vec<String> =
            names.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
        if let Some(name) = names.iter().find(|name| parts.is_foreign(name)) {
            return Err(refused(format!("holds {name}, a part of another sweep; take another folder")));
        }
        let is_known = |name: &String| Parts::is_any(name) || name.starts_with('.');
        if !manifest.is_file() {
            if let Some(name) = names.iter().find(|name| !is_known(name)) {
                return Err(refused(format!("holds {name}, which is not of a sweep; take another folder")));
            }
            // It comes first: a shard that begins meanwhile finds it beside whatever else there is.
            let text = serde_json::to_string_pretty(&self.manifest(identity)).unwrap_or_default();
            write(&manifest, |file| writeln!(file, "{text}"))?;
        }
        if !folder.join(CASE).is_file() {
            for (artifact, bytes) in self.reading.copies() {
                write(&folder.join(&*artifact.file_name()), |file| file.write_all(&bytes))?;
            }
            let case = resolved_case(&self.reading.resolved_with_copies());
            write(&folder.join(CASE), |file| file.write_all(case.as_bytes()))?;
        }
        parts.tidy();
        Ok(())
    }

    /// Writes all rows into one file of text, if all are there.
    fn merge(&self, folder: &Path, parts: &Parts<'_>) -> Result<Option<PathBuf>, SweepError> {
        if !(0..parts.count()).all(|part| parts.is_there(part)) {
            return Ok(None);
        }
        let path = folder.join(CSV);
        let mut whole = true;
        write(&path, |file| {
            for part in 0..parts.count() {
                let rows = parts.read(part);
                whole &= rows.is_some();
                csv_file::write(&table::columns(self, &rows.unwrap_or_default()), part == 0, &mut *file)?;
            }
            Ok(())
        })?;
        if !whole {
            // A part of another shard is torn.
            let _ = fs::remove_file(&path);
        }
        Ok(whole.then_some(path))
    }
}

/// Whether a row is kept: not one that was stopped.
fn is_kept(row: &Row) -> bool {
    row.status != Status::Stopped
}

/// Writes a file whole, under another name first.
fn write(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>,
) -> Result<(), SweepError> {
    let name = path.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
    let new = path.with_file_name(format!(".{name}-{}.new", own()));
    let attempt = || {
        let mut file = BufWriter::new(File::create(&new)?);
        fill(&mut file)?;
        file.flush()?;
        fs::rename(&new, path)
    };
    attempt().map_err(|source| {
        let _ = fs::remove_file(&new);
        SweepError::Io { what: "write", path: path.to_owned(), source }
    })
}

//! Beginning with the state of an earlier run.

use crate::files::deck::with_blade_file;
use crate::kinds::initial::Earlier;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::resolved::{flat, of_blade};
use flexion::integrator::Checkpoint;
use flexion::system::State;
use std::fmt::Write as _;

/// Tables of a case that say nothing about its model.
const BESIDES: &[&str] = &["title", "initial", "run", "output"];

impl Reading {
    /// What a state of this case belongs to: a line `key = value` for everything that makes the model and the
    /// integrator. Of the tables that the case names, their contents count and not their names.
    pub(super) fn identity(&self) -> String {
        let mut all = Vec::new();
        flat(&self.values, "", &mut all);
        let tables = self.tables();
        let mut out = String::new();
        for (key, value) in all {
            if BESIDES.contains(&key.split('.').next().unwrap_or(&key)) {
                continue;
            }
            let contents =
                |table: &str| tables.iter().find(|(other, _)| table == other).map(|(_, bytes)| *bytes);
            let table = key.strip_suffix(".file").unwrap_or_default();
            let value = match (contents(table), contents(&of_blade(table))) {
                // Whatever the blade file is called.
                (Some(primary), Some(blade)) => {
                    let primary = with_blade_file(primary, "");
                    format!("contents {:016x} {:016x}", digest(primary.as_bytes()), digest(blade))
                }
                (Some(bytes), None) => format!("contents {:016x}", digest(bytes)),
                (None, _) => value,
            };
            let _ = writeln!(out, "{key} = {value}");
        }
        out
    }
}

/// FNV-1a, 64 bits: distinguishes two tables.
fn digest(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Brings `state` to where the earlier run ended. Returns the history to go on with: none for another integrator, which
/// begins anew there.
///
/// # Errors
/// At `initial.file`, when the model differs, with the first keys that do, or the state does not fit; at `run.duration`,
/// when the earlier run has passed it.
pub(super) fn begin(
    earlier: &Earlier,
    reading: &Reading,
    state: &mut State,
) -> Result<Option<Checkpoint>, Problems> {
    let refuse = |message: String| reading.problem("initial.file", message);
    let (here, there) = (reading.identity(), earlier.identity.as_str());
    let defaults: Vec<String> = reading.defaults().into_iter().map(|(key, _)| key).collect();
    let differ = |integrator: bool| {
        let of = |text: &str| -> Vec<(String, String)> {
            let lines = text.lines().filter_map(|line| line.split_once(" = "));
            let wanted = lines.filter(|(key, _)| key.starts_with("integrator.") == integrator);
            wanted.map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
        };
        differences(&of(there), &of(&here), &defaults)
    };
    let different = differ(false);
    if !different.is_empty() {
        return Err(refuse(format!(
            "the state is one of another model: {}; a run can only go on with the model it began with",
            different.join("; ")
        )));
    }
    let filled = earlier.checkpoint.fill_state("", state);
    filled.map_err(|error| refuse(error.to_string()))?;
    if !state.is_finite() {
        return Err(refuse("the state is not finite".to_owned()));
    }
    let duration = reading.case.duration;
    if state.t >= duration {
        let message = format!(
            "the earlier run ended at t = {} s, and time goes on from there: the duration {duration} s must be longer",
            state.t
        );
        return Err(reading.problem("run.duration", message));
    }
    Ok(differ(true).is_empty().then(|| earlier.checkpoint.clone()))
}

/// The first keys that differ, with both values. A key that the state does not know and that has its default makes no
/// other model: a later version may know more.
fn differences(there: &[(String, String)], here: &[(String, String)], defaults: &[String]) -> Vec<String> {
    let value = |list: &[(String, String)], key: &str| {
        list.iter().find(|(known, _)| known == key).map_or("nothing".to_owned(), |(_, value)| value.clone())
    };
    let keys = there.iter().chain(here.iter().filter(|(key, _)| there.iter().all(|(known, _)| known != key)));
    let mut out = Vec::new();
    for (key, _) in keys {
        let (old, new) = (value(there, key), value(here, key));
        if old == "nothing" && defaults.contains(key) {
            continue;
        }
        if old != new && out.len() < 3 {
            out.push(format!("`{key}` was {old} and is {new}"));
        }
    }
    out
}

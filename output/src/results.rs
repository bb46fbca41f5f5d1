//! Results of former runs, read from their files.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use super::artifact::Artifact;
use super::csv::read_csv;
use super::staging::{current, written};
use super::written::LIST;
use super::{ResultsError, Trajectory};
use crate::nearest::nearest;
use flexion::system::{Kind, Role};

/// What a run left behind.
#[derive(Clone, Debug)]
pub struct Results {
    /// Name for tables and legends: the directory, or the file without extension.
    pub name: String,
    /// Where it was read from.
    pub path: PathBuf,
    /// What was recorded.
    pub trajectory: Trajectory,
    /// Warning for the reader: that the run did not finish.
    pub caution: Option<String>,
}

impl Results {
    /// Reads a directory of results, or a file of comma-separated values whose first column is `time [s]`.
    ///
    /// # Errors
    /// [`ResultsError::Missing`] and [`ResultsError::Unreadable`].
    pub fn read(path: &Path) -> Result<Results, ResultsError> {
        let file = if path.is_dir() { current(path, Artifact::TrajectoryCsv) } else { path.to_path_buf() };
        if !file.is_file() {
            return Err(ResultsError::Missing { path: path.to_path_buf() });
        }
        let unreadable = |reason: String| ResultsError::Unreadable { path: file.clone(), reason };
        if path.is_dir() {
            refuse_changed(path)?;
        }
        let opened = File::open(&file).map_err(|error| unreadable(error.to_string()))?;
        let mut trajectory = read_csv(BufReader::new(opened)).map_err(unreadable)?;
        if path.is_dir() {
            describe(path, &mut trajectory);
        }
        let times = trajectory.times();
        if times.is_empty() {
            let why = path.is_dir().then(|| caution(path, times)).flatten();
            let why = why.map(|why| format!(": {why}")).unwrap_or_default();
            return Err(unreadable(format!("it holds no records{why}")));
        }
        if let Some(pair) = times.windows(2).find(|pair| pair[1] < pair[0]) {
            return Err(unreadable(format!("its times do not ascend after t = {:e} s", pair[0])));
        }
        let caution =
            path.is_dir().then(|| caution(path, times)).flatten().or_else(|| not_finite(&trajectory, path));
        Ok(Results { name: name(path), path: path.to_path_buf(), trajectory, caution })
    }

    /// Reads several, and makes their names unique: by their paths, or by a number.
    ///
    /// # Errors
    /// Those of [`Results::read`].
    pub fn read_all(paths: &[PathBuf]) -> Result<Vec<Results>, ResultsError> {
        let mut all = paths.iter().map(|path| Results::read(path)).collect::<Result<Vec<_>, _>>()?;
        let twice = |all: &[Results], name: &str| all.iter().filter(|r| r.name == name).count() > 1;
        let longer: Vec<String> = all
            .iter()
            .map(|r| if twice(&all, &r.name) { r.path.display().to_string() } else { r.name.clone() })
            .collect();
        for (results, name) in all.iter_mut().zip(longer) {
            results.name = name;
        }
        for i in 1..all.len() {
            if all[..i].iter().any(|r| r.name == all[i].name) {
                all[i].name = format!("{} ({})", all[i].name, i + 1);
            }
        }
        Ok(all)
    }
}

/// What is read of a run.
const READ: [Artifact; 4] =
    [Artifact::TrajectoryCsv, Artifact::Summary, Artifact::Events, Artifact::ResolvedCase];

/// Refuses results of which a file is not as it was written.
fn refuse_changed(folder: &Path) -> Result<(), ResultsError> {
    let written = written(folder);
    for artifact in READ {
        let file = current(folder, artifact);
        // Results without a summary are not complete, which is said.
        if artifact == Artifact::Summary && !file.exists() {
            continue;
        }
        if let Some(defect) = written.defect(&artifact.file_name(), &file) {
            let reason = format!(
                "{defect}; run the case again, or remove {LIST} from the folder to read the files as they are"
            );
            return Err(ResultsError::Unreadable { path: file, reason });
        }
    }
    Ok(())
}

/// Takes what the columns are from the summary of the run.
fn describe(path: &Path, trajectory: &mut Trajectory) {
    let text = std::fs::read_to_string(current(path, Artifact::Summary)).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    for i in 0..trajectory.channels().len() {
        let column = &summary["columns"][&trajectory.channels()[i].name];
        let is = |key: &str, name: &str| column[key].as_str() == Some(name);
        let Some(role) = Role::ALL.into_iter().find(|role| is("role", role.name())) else { continue };
        let kind = Kind::ALL.into_iter().find(|kind| is("kind", kind.name())).unwrap_or_default();
        trajectory.describe(i, role, kind);
    }
}

fn name(path: &Path) -> String {
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let last = if path.is_dir() { absolute.file_name() } else { absolute.file_stem() };
    last.map_or_else(|| path.display().to_string(), |name| name.to_string_lossy().into_owned())
}

/// The warning that follows from the summary of a run whose records are of these times.
fn caution(path: &Path, times: &[f64]) -> Option<String> {
    let summary = current(path, Artifact::Summary);
    let Ok(text) = std::fs::read_to_string(&summary) else {
        return Some(format!("{} has no summary.json: the results may be incomplete", path.display()));
    };
    let value: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    match value["status"].as_str() {
        Some("finished") => {
            let (end, last) = (value["end_time"].as_f64()?, times.last().copied().unwrap_or_default());
            let differ = (end - last).abs() > 1e-9 * end.abs();
            differ.then(|| format!("the run in {} ends at {end} s, its records at {last} s: they are of another run, or not all are there", path.display()))
        }
        Some(status) => {
            let message = value["message"].as_str().map(|m| format!(": {m}")).unwrap_or_default();
            Some(format!("the run in {} {status}{message}", path.display()))
        }
        None => Some(format!("{} is not the summary of a run", summary.display())),
    }
}

/// The first value that is no finite number.
fn not_finite(trajectory: &Trajectory, path: &Path) -> Option<String> {
    trajectory.channels().iter().enumerate().find_map(|(i, channel)| {
        let (t, _) = trajectory.times().iter().zip(trajectory.values(i)).find(|(_, x)| !x.is_finite())?;
        Some(format!("{} in {} is not a finite number at t = {t} s", channel.name, path.display()))
    })
}

/// The columns whose names match one of the patterns, in the order of the patterns and then of the columns, each
/// once. `*` stands for any text, `?` for any character, `[ab]` for one of some.
///
/// # Errors
/// [`ResultsError::Pattern`], and [`ResultsError::NoColumn`] for a pattern that matches nothing; `of` says in
/// what was searched.
pub fn select<'n>(columns: &[&'n str], patterns: &[String], of: &str) -> Result<Vec<&'n str>, ResultsError> {
    let mut selected: Vec<&str> = Vec::new();
    for pattern in patterns {
        let compiled = glob::Pattern::new(pattern).map_err(|error| ResultsError::Pattern {
            pattern: pattern.clone(),
            reason: error.msg.to_owned(),
        })?;
        let mut matched = false;
        for name in columns.iter().filter(|name| **name == pattern || compiled.matches(name)) {
            matched = true;
            if !selected.contains(name) {
                selected.push(name);
            }
        }
        if !matched {
            return Err(ResultsError::NoColumn {
                pattern: pattern.clone(),
                of: of.to_owned(),
                nearest: nearest(pattern, columns.iter().copied()).map(str::to_owned),
                there: columns.join(", "),
            });
        }
    }
    Ok(selected)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::sample;
    use crate::write_csv;

    fn chosen(patterns: &[&str]) -> Result<Vec<&'static str>, String> {
        let columns = ["tip.deflection", "tip.axial", "x=2.5.axial", "hub.speed"];
        let patterns: Vec<String> = patterns.iter().map(|p| (*p).to_owned()).collect();
        select(&columns, &patterns, "the runs").map_err(|e| e.to_string())
    }

    #[test]
    fn columns_are_selected_by_name_and_pattern() {
        assert_eq!(chosen(&["hub.speed", "tip.*"]).unwrap(), ["hub.speed", "tip.deflection", "tip.axial"]);
        assert_eq!(chosen(&["*.axial", "tip.*"]).unwrap(), ["tip.axial", "x=2.5.axial", "tip.deflection"]);
        let error = chosen(&["tip.defelction"]).unwrap_err();
        assert!(error.contains("did you mean `tip.deflection`?") && error.contains("hub.speed"), "{error}");
        assert!(chosen(&["nose.*"]).unwrap_err().contains("no column of the runs is called `nose.*`"));
        assert!(chosen(&["tip.***"]).unwrap_err().contains("no pattern"));
    }

    #[test]
    fn results_are_read_as_they_were_written_or_not_at_all() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("run");
        let out = crate::Directory::create(&path, false).unwrap();
        out.write(Artifact::TrajectoryCsv, |f| write_csv(&sample(), f)).unwrap();
        out.write(Artifact::Summary, |f| f.write_all(br#"{"status":"finished"}"#)).unwrap();
        out.write(Artifact::Events, |f| f.write_all(b"time [s]\n")).unwrap();
        out.publish().unwrap();
        drop(out);
        Results::read(&path).unwrap();
        for name in ["trajectory.csv", "summary.json", "events.csv"] {
            let file = path.join(name);
            let whole = std::fs::read(&file).unwrap();
            let refused = |bytes: Option<&[u8]>| {
                match bytes {
                    Some(bytes) => std::fs::write(&file, bytes).unwrap(),
                    None => std::fs::remove_file(&file).unwrap(),
                }
                Results::read(&path).unwrap_err().to_string()
            };
            let mut flipped = whole.clone();
            *flipped.last_mut().unwrap() ^= 1;
            let error = refused(Some(&flipped));
            assert!(error.contains(name) && error.contains("not those that were written"), "{error}");
            refused(Some(&whole[..whole.len() - 1]));
            if name != "summary.json" {
                refused(None);
            }
            std::fs::write(&file, &whole).unwrap();
        }
        std::fs::write(path.join("summary.json"), r#"{"status":"failed"}"#).unwrap();
        std::fs::remove_file(path.join(LIST)).unwrap();
        assert!(Results::read(&path).unwrap().caution.is_some());
    }

    #[test]
    fn results_of_directories_and_files_have_unique_names() {
        let dir = tempfile::tempdir().unwrap();
        let make = |name: &str, summary: Option<&str>| {
            let path = dir.path().join(name);
            std::fs::create_dir_all(&path).unwrap();
            let mut csv = Vec::new();
            write_csv(&sample(), &mut csv).unwrap();
            std::fs::write(path.join("trajectory.csv"), csv).unwrap();
            if let Some(summary) = summary {
                std::fs::write(path.join("summary.json"), summary).unwrap();
            }
            path
        };
        let good = make("a/run", Some(r#"{"status":"finished"}"#));
        let bad = make("b/run", Some(r#"{"status":"failed","message":"it broke"}"#));
        let open = make("open", None);
        let paths = [good.clone(), bad, open, good.join("trajectory.csv"), good];
        let all = Results::read_all(&paths).unwrap();
        let names: std::collections::BTreeSet<&str> = all.iter().map(|r| r.name.as_str()).collect();
        assert_eq!(names.len(), 5, "{names:?}");
        assert!(names.contains("open") && names.contains("trajectory"));
        assert_eq!(all[0].trajectory.column("hub.speed"), sample().column("hub.speed"));
        assert_eq!(all[0].caution, None);
        let role = |r: &Results, name: &str| r.trajectory.channels()[r.trajectory.index(name).unwrap()].role;
        let columns = r#"{"status":"finished","columns":{"hub.speed":{"role":"detail"}}}"#;
        let told = Results::read(&make("told", Some(columns))).unwrap();
        assert_eq!((role(&told, "hub.speed"), role(&all[0], "hub.speed")), (Role::Detail, Role::Primary));
        let longer = Results::read(&make("longer", Some(r#"{"status":"finished","end_time":9}"#))).unwrap();
        assert!(longer.caution.unwrap().contains("ends at 9 s"));
        assert!(all[1].caution.as_ref().unwrap().ends_with("failed: it broke"));
        assert!(all[2].caution.as_ref().unwrap().contains("incomplete"));
        for (rows, words) in [("", "no records"), ("1,2\n0,3\n", "do not ascend after t = 1e0 s")] {
            let file = dir.path().join("rows.csv");
            std::fs::write(&file, format!("time [s],a [m]\n{rows}")).unwrap();
            let error = Results::read(&file).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        let file = dir.path().join("rows.csv");
        std::fs::write(&file, "time [s],a [m]\n0,2\n1,inf\n").unwrap();
        assert!(Results::read(&file).unwrap().caution.unwrap().contains("not a finite number at t = 1 s"));
        let error = Results::read(&dir.path().join("c")).unwrap_err().to_string();
        assert!(error.contains("holds no trajectory.csv"), "{error}");
    }
}

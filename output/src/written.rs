//! What the program wrote into a folder of results: only these files may a later run replace or remove.
//!
//! A hidden file lists them by the closing file of their results, for one folder may hold results of several kinds, each with the SHA-256 of its
//! bytes: who reads results knows by it that they are those that were written.

use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use super::artifact::Artifact;

/// The list.
pub(super) const LIST: &str = ".flexion-files";

/// Names, with `/` between folder and file, and hashes of the files.
pub(super) type Sealed = BTreeMap<String, String>;

/// What a list has of some results: the first ones had names alone.
#[derive(serde::Deserialize)]
#[serde(untagged)]
enum Listed {
    Sealed(Sealed),
    Names(Vec<String>),
}

/// Files that the program wrote, by the closing file of their results.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Written(BTreeMap<String, Sealed>);

impl Written {
    /// What the list in `folder` says; nothing where there is none. Names that no result has are left out, so that no list leads
    /// out of its folder.
    pub fn read(folder: &Path) -> Written {
        let text = fs::read_to_string(folder.join(LIST)).unwrap_or_default();
        let all: BTreeMap<String, Listed> = serde_json::from_str(&text).unwrap_or_default();
        let sealed = |listed| match listed {
            Listed::Sealed(names) => names,
            Listed::Names(names) => names.into_iter().map(|name| (name, String::new())).collect(),
        };
        let mut all: BTreeMap<String, Sealed> =
            all.into_iter().map(|(closing, listed)| (closing, sealed(listed))).collect();
        all.values_mut().for_each(|names| names.retain(|name, _| Artifact::is_name(name)));
        Written(all)
    }

    /// Whether one of its results has the file.
    pub fn holds(&self, name: &str) -> bool {
        self.0.values().any(|names| names.contains_key(name))
    }

    /// The files of the results with this closing file.
    pub fn of(&self, closing: &str) -> impl Iterator<Item = &str> {
        self.0.get(closing).into_iter().flatten().map(|(name, _)| name.as_str())
    }

    /// Why a file of results, which is here now, is not the one that was written, if the list has its name: it is not there, or other bytes are.
    pub fn defect(&self, name: &str, file: &Path) -> Option<String> {
        let written = self.0.values().find_map(|names| names.get(name)).filter(|hash| !hash.is_empty())?;
        match hash(file) {
            Ok(found) if found == *written => None,
            Ok(_) => Some(
                "its bytes are not those that were written: it is torn, changed or of other results"
                    .to_owned(),
            ),
            Err(error) => Some(format!("it was written, and cannot be read: {error}")),
        }
    }

    /// The list when the results with this closing file consist of `names`.
    pub fn with(mut self, closing: &str, names: Sealed) -> Written {
        self.0.values_mut().for_each(|of| of.retain(|name, _| !names.contains_key(name)));
        self.0.insert(closing.to_owned(), names);
        self.0.retain(|_, names| !names.is_empty());
        self
    }

    /// Writes the list into `folder`.
    pub fn write(&self, folder: &Path) -> io::Result<()> {
        let text = serde_json::to_string_pretty(&self.0)?;
        let mut file = fs::File::create(folder.join(LIST))?;
        io::Write::write_all(&mut file, text.as_bytes())?;
        file.sync_all()
    }
}

/// The hash of a file, but for the lines of a summary that say how long a run took: they are others whenever it is repeated.
pub(super) fn hash(file: &Path) -> io::Result<String> {
    let (mut from, mut digest, mut line) = (BufReader::new(fs::File::open(file)?), Sha256::new(), Vec::new());
    let is_summary = file.file_name().is_some_and(|name| *name == *Artifact::Summary.file_name());
    while from.read_until(b'\n', &mut line)? > 0 {
        let is_time = |key: &[u8]| line.windows(key.len()).any(|part| part == key);
        if !is_summary || !(is_time(b"wall_time\": ") || is_time(b"cpu_time\": ")) {
            digest.update(&line);
        }
        line.clear();
    }
    let mut out = String::new();
    for byte in digest.finalize() {
        let _ = write!(out, "{byte:02x}");
    }
    Ok(out)
}

/// Files whose bytes nobody looks at.
#[cfg(test)]
pub(super) fn unsealed<T: ToString>(names: impl IntoIterator<Item = T>) -> Sealed {
    names.into_iter().map(|name| (name.to_string(), String::new())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(names: &[&str]) -> Sealed {
        unsealed(names.iter().copied())
    }

    #[test]
    fn a_file_belongs_to_the_results_that_wrote_it_last() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Written::read(folder.path()), Written::default());
        let first = Written::default().with("summary.json", set(&["summary.json", "case.resolved.toml"]));
        let both = first.with("modes.json", set(&["modes.json", "case.resolved.toml"]));
        both.write(folder.path()).unwrap();
        let read = Written::read(folder.path());
        assert_eq!(read, both);
        assert_eq!(read.of("summary.json").collect::<Vec<_>>(), ["summary.json"]);
        assert!(read.holds("case.resolved.toml") && !read.holds("plot.svg"));
    }

    #[test]
    fn a_run_that_is_repeated_has_the_same_list_however_long_it_takes() {
        let folder = tempfile::tempdir().unwrap();
        let summary = folder.path().join("summary.json");
        let hash_of = |end: &str, time: &str| {
            let text = format!(
                "{{\n  \"end_time\": {end},\n  \"wall_time\": {time},\n  \"preparation_cpu_time\": {time}\n}}"
            );
            fs::write(&summary, text).unwrap();
            hash(&summary).unwrap()
        };
        assert_eq!(hash_of("2", "0.1"), hash_of("2", "0.25"));
        assert_ne!(hash_of("2", "0.1"), hash_of("3", "0.1"));
    }

    #[test]
    fn a_list_of_names_alone_is_a_list() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(LIST), r#"{ "summary.json": ["plot.svg", "summary.json"] }"#).unwrap();
        let read = Written::read(folder.path());
        assert_eq!(read.of("summary.json").collect::<Vec<_>>(), ["plot.svg", "summary.json"]);
        assert_eq!(read.defect("plot.svg", &folder.path().join("plot.svg")), None);
    }

    #[test]
    fn no_list_leads_out_of_its_folder() {
        let folder = tempfile::tempdir().unwrap();
        let text = r#"{ "summary.json": { "../case.toml": "", "/etc/hosts": "", "vtk/../../x": "", "notes.txt": "", "plot.svg": "" } }"#;
        fs::write(folder.path().join(LIST), text).unwrap();
        assert_eq!(Written::read(folder.path()).of("summary.json").collect::<Vec<_>>(), ["plot.svg"]);
        fs::write(folder.path().join(LIST), "no list").unwrap();
        assert_eq!(Written::read(folder.path()), Written::default());
    }
}

//! What a directory may not hold, so that results can be written into it.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::OutputError;
use super::artifact::Artifact;
use super::staging::NEW;
use super::written::{LIST, Written};

/// Refuses a directory that holds results or anything else but what an interrupted run had begun to write.
pub(super) fn refuse_contents(path: &Path) -> Result<(), OutputError> {
    if Artifact::closing().any(|closing| path.join(&*closing.file_name()).exists()) {
        return Err(OutputError::HoldsResults { path: path.to_path_buf() });
    }
    refuse_others(path, |name| name == NEW || name == LIST)
}

/// Refuses a directory that holds anything but what is `ours`.
pub(super) fn refuse_others(path: &Path, ours: impl Fn(&str) -> bool) -> Result<(), OutputError> {
    let entries = fs::read_dir(path).and_then(Iterator::collect::<io::Result<Vec<_>>>);
    let entries = entries.map_err(OutputError::io("read the directory", path))?;
    let names = entries.into_iter().map(|entry| entry.file_name().to_string_lossy().into_owned());
    match names.filter(|name| !ours(name)).min() {
        Some(found) => Err(OutputError::NotEmpty { path: path.to_path_buf(), found }),
        None => Ok(()),
    }
}

/// Refuses `names` of which no former run wrote the file.
pub(super) fn refuse_foreign(path: &Path, names: &[&str]) -> Result<(), OutputError> {
    let written = Written::read(path);
    match names.iter().find(|name| !written.holds(name)) {
        Some(name) => Err(OutputError::Foreign { path: path.join(name) }),
        None => Ok(()),
    }
}

/// Refuses `names` that are files of `inputs`, by the path that was given or by where it leads.
pub(super) fn refuse_inputs(path: &Path, names: &[&str], inputs: &[PathBuf]) -> Result<(), OutputError> {
    let named = |file: &Path| {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Some(folder.canonicalize().ok()?.join(file.file_name()?))
    };
    let read: Vec<PathBuf> =
        inputs.iter().flat_map(|file| [named(file), file.canonicalize().ok()]).flatten().collect();
    match names
        .iter()
        .map(|name| path.join(name))
        .find(|file| named(file).is_some_and(|file| read.contains(&file)))
    {
        Some(path) => Err(OutputError::Input { path }),
        None => Ok(()),
    }
}

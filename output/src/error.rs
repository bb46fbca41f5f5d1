//! Why results could not be written or read.

use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Why results could not be written. Every message says where, why and what to try.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The path of the directory is taken by something else.
    #[error("{} is a file, not a directory; choose another output directory", path.display())]
    NotADirectory {
        /// The path asked for.
        path: PathBuf,
    },
    /// The directory holds the results of a former run.
    #[error(
        "{} already holds results; choose another output directory or replace them with --force",
        path.display()
    )]
    HoldsResults {
        /// The directory.
        path: PathBuf,
    },
    /// The directory holds something else.
    #[error(
        "{} is not empty (it holds {found}); choose another output directory or write into it with --force",
        path.display()
    )]
    NotEmpty {
        /// The directory.
        path: PathBuf,
        /// Name of one of the things found in it.
        found: String,
    },
    /// A file of the directory has the name of a result, and no run wrote it.
    #[error(
        "no run is known to have written {}, and the new results may have a file of that name: move it away or choose another \
         output directory",
        path.display()
    )]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// The directory holds a file that marks results as complete, and no list says that the program wrote it.
    #[error(
        "no list in {} says that this program wrote {file}: a version before kept none, or it is not its own; move it away with \
         what belongs to it, or choose another output directory",
        path.display()
    )]
    Unlisted {
        /// The directory.
        path: PathBuf,
        /// Name of the file.
        file: String,
    },
    /// A file of the directory that the case is read from has the name of a result.
    #[error(
        "{} is read by the case, and the new results may have a file of that name: what a case reads is never replaced; choose \
         another output directory",
        path.display()
    )]
    Input {
        /// The file.
        path: PathBuf,
    },
    /// Another program is writing into the directory.
    #[error(
        "another run is writing its results into {}; wait for its end or choose another output directory",
        path.display()
    )]
    Busy {
        /// The directory.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("cannot {action} {}: {source}; {}", path.display(), advice(source))]
    Io {
        /// What was being done, e.g. `write`.
        action: &'static str,
        /// To which file or directory.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
    /// A figure could not be drawn.
    #[error(
        "cannot draw the plot: {reason}; the other files are not affected, draw it again from trajectory.csv"
    )]
    Draw {
        /// The reason of the drawing library.
        reason: String,
    },
}

impl OutputError {
    pub(super) fn io(action: &'static str, path: &Path) -> impl FnOnce(io::Error) -> OutputError {
        move |source| OutputError::Io { action, path: path.to_path_buf(), source }
    }
}

/// What to try when the system refuses.
fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        ErrorKind::PermissionDenied => {
            "choose a directory you may write to, or ask its owner for the permission"
        }
        ErrorKind::ReadOnlyFilesystem => "this file system is read-only: choose a directory on another one",
        ErrorKind::StorageFull => {
            "the disk is full: make room, choose a directory on another disk, or record less often"
        }
        ErrorKind::QuotaExceeded => {
            "the disk quota is used up: make room, choose a directory on another disk, or record less often"
        }
        ErrorKind::FileTooLarge => "record less often or for a shorter time",
        ErrorKind::NotADirectory | ErrorKind::AlreadyExists => {
            "part of the path is a file: choose another output directory"
        }
        ErrorKind::InvalidFilename => "choose a shorter or simpler name",
        ErrorKind::NotFound => "check the path; it cannot be made or was removed during the run",
        _ => "check the path and the disk, or choose another output directory",
    }
}

/// Why results could not be read or compared.
#[derive(Debug, thiserror::Error)]
pub enum ResultsError {
    /// There is no trajectory.
    #[error(
        "{} holds no trajectory.csv; give the directory of a run, or a CSV file whose first column is `time [s]`",
        path.display()
    )]
    Missing {
        /// Where it was looked for.
        path: PathBuf,
    },
    /// The file cannot be read.
    #[error("cannot read {}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// More columns are asked for than a figure shows.
    #[error("{count} columns are too many for one figure; choose at most {most} with --columns")]
    Columns {
        /// Columns asked for.
        count: usize,
        /// Columns that a figure shows.
        most: usize,
    },
    /// There is nothing to be seen in motion.
    #[error(
        "{} holds no motion and no modes; give the directory of results of `flexion run`, or of `flexion modes --output`",
        path.display()
    )]
    NoMotion {
        /// Where it was looked for.
        path: PathBuf,
    },
    /// No column matches.
    #[error("no column of {of} is called `{pattern}`{}; there are {there}", hint(nearest))]
    NoColumn {
        /// What was asked for.
        pattern: String,
        /// Which results were searched.
        of: String,
        /// The name that was perhaps meant.
        nearest: Option<String>,
        /// The names there are.
        there: String,
    },
    /// Something is no quantity.
    #[error("`{quantity}` is no quantity: {reason}")]
    Quantity {
        /// What was asked for.
        quantity: String,
        /// Why it is none.
        reason: String,
    },
    /// Something is no pattern.
    #[error("`{pattern}` is no pattern for columns ({reason}); write for example `tip.*`")]
    Pattern {
        /// What was asked for.
        pattern: String,
        /// What is wrong with it.
        reason: String,
    },
    /// Nothing can be compared.
    #[error("{first} and {second} cannot be compared: {reason}")]
    Incomparable {
        /// Name of the first.
        first: String,
        /// Name of the second.
        second: String,
        /// Why.
        reason: String,
    },
}

fn hint(nearest: &Option<String>) -> String {
    nearest.as_ref().map(|name| format!(", did you mean `{name}`?")).unwrap_or_default()
}

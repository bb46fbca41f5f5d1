//! Files: trajectory, summary, plots. Everything is written whole or not at all.
//!
//! [`Directory`] owns the files of one run; [`write_run`] fills it. The other items turn a
//! [`Trajectory`] into one format each and know nothing of directories.

mod csv;
mod directory;
mod npz;
pub mod plot;
mod provenance;
mod recorder;
mod run;
mod summary;
mod trajectory;

pub use self::csv::write_csv;
pub use self::directory::{Artifact, Directory, OutputError};
pub use self::npz::write_npz;
pub use self::provenance::resolved_case;
pub use self::recorder::{Recorder, Watch};
pub use self::run::write_run;
pub use self::summary::{Integration, ProblemSize, RunReport, Status, Summary, VERSION};
pub use self::trajectory::{Extremes, Trajectory};

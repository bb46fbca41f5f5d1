//! Files: trajectory, summary, plots. Everything is written whole or not at all.
//!
//! [`Directory`] owns the files of one run; [`write_run`] fills it. The other items turn a
//! [`Trajectory`] into one format each and know nothing of directories.

#[cfg(feature = "archives")]
mod archive;
mod arrays;
mod artifact;
mod columns;
mod compare;
mod contour;
mod csv;
mod directory;
mod error;
mod estimate;
mod events;
mod file;
mod forces;
mod frequencies;
mod load_path;
mod nearest;
#[cfg(feature = "archives")]
mod npz;
mod obstacles;
#[cfg(feature = "page")]
mod page;
#[cfg(feature = "figures")]
pub mod plot;
mod provenance;
mod refusal;
mod results;
mod run;
#[cfg(test)]
mod samples;
mod scene;
mod shapes;
mod shown;
mod solids;
mod spring;
mod staging;
mod state_file;
mod statics;
mod summary;
mod vibration;
mod view;
mod vtk;
mod written;

pub use self::arrays::{Arrays, Numbers};
pub use self::artifact::Artifact;
pub use self::columns::shown_columns;
pub use self::compare::{Comparison, Difference, compare, compare_csv, compare_json};
pub use self::contour::Contour;
pub use self::csv::{read_csv, write_csv};
pub use self::directory::{Directory, Sink};
pub use self::error::{OutputError, ResultsError};
pub use self::estimate::{Errors, Rung};
pub use self::events::write_events;
pub use self::file::{try_file, write_file};
pub use self::frequencies::{Frequencies, Units};
pub use self::load_path::{LoadPath, LoadPoint, PointError};
pub use self::nearest::nearest;
#[cfg(feature = "archives")]
pub use self::npz::write_npz;
pub use self::obstacles::{Carrier, Drawn};
#[cfg(feature = "page")]
pub use self::page::view_page;
pub use self::provenance::resolved_case;
pub use self::results::{Results, select};
pub use self::run::{Attachments, write_run};
pub use self::scene::{Part, Scene};
pub use self::shapes::{Shape, Shapes};
pub use self::shown::{with_error, with_error_of};
pub use self::solids::{write_film, write_solids};
pub use self::spring::Spring;
pub use self::state_file::read_state;
#[cfg(feature = "archives")]
pub use self::state_file::write_state;
pub use self::statics::{put_statics, statics_json, write_statics};
pub use self::summary::{Integration, ProblemSize, RunReport, Status, Summary, VERSION, outcome};
pub use self::vibration::{campbell_json, modes_json, put_campbell, put_modes, write_campbell, write_modes};
pub use self::view::{view_modes, view_run};
pub use self::vtk::{write_pvd, write_vtp, write_vtu};
pub use flexion::analysis::error::{ColumnError, Unstable};
pub use flexion::analysis::recording::{Entry, Events, Extremes, Trajectory};

//! All files of one run, in the order that makes an interrupted write recognisable.

use super::{
    Artifact, Directory, OutputError, RunReport, Scene, Shapes, Status, Summary, Trajectory, resolved_case,
    write_csv, write_events, write_film, write_pvd, write_vtp, write_vtu,
};
#[cfg(feature = "figures")]
use super::{plot::Figure, vibration::drawn};
#[cfg(feature = "archives")]
use super::{state_file::write_state, write_npz};
use flexion::integrator::Checkpoint;

/// What not every run has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Attachments<'a> {
    /// The plot.
    #[cfg(feature = "figures")]
    pub figure: Option<&'a Figure>,
    /// The tables that the case names, byte for byte.
    pub tables: &'a [(Artifact, Vec<u8>)],
    /// The last accepted step, and the text that says what it belongs to.
    pub state: Option<(&'a Checkpoint, &'a str)>,
    /// The shapes of the beam.
    pub shapes: Option<&'a Shapes>,
    /// The motion in space.
    pub scene: Option<&'a Scene>,
    /// Whether it is written for ParaView too.
    pub solids: bool,
}

/// Writes the files of a run into `directory`, publishes them, and returns the status that the
/// summary states: [`Status::Failed`] for a run that claims to have finished with a value that is
/// not finite, else the status of `report`. A plot that cannot be drawn is a warning in
/// the summary.
///
/// `case` is the resolved case as TOML.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk; former results are then still in place.
pub fn write_run(
    directory: &Directory,
    report: &RunReport<'_>,
    trajectory: &Trajectory,
    case: &str,
    attachments: Attachments<'_>,
) -> Result<Status, OutputError> {
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    for (artifact, bytes) in attachments.tables {
        directory.write(*artifact, |f| f.write_all(bytes))?;
    }
    #[cfg(feature = "archives")]
    if let Some((checkpoint, text)) = attachments.state {
        directory.write(Artifact::State, |f| write_state(checkpoint, text, f))?;
    }
    // The smaller one first: it may still fit on a disk that is nearly full.
    #[cfg(feature = "archives")]
    directory.write(Artifact::TrajectoryNpz, |f| write_npz(trajectory, f))?;
    directory.write(Artifact::TrajectoryCsv, |f| write_csv(trajectory, f))?;
    if let Some(events) = report.events {
        directory.write(Artifact::Events, |f| write_events(events, f))?;
    }
    let warnings = report.warnings.to_vec();
    #[cfg(feature = "figures")]
    let warnings = match attachments.figure {
        Some(figure) => drawn(directory, figure, [Artifact::PlotSvg, Artifact::PlotPng], warnings)?,
        None => warnings,
    };
    if let Some(shapes) = attachments.shapes {
        for (number, shape) in (0..).zip(shapes.iter()) {
            directory.write(Artifact::Shape(number), |f| write_vtu(&shape, f))?;
        }
        let outlines = shapes.outlines();
        for (number, lines) in (0..).zip(outlines) {
            directory.write(Artifact::Obstacles(number), |f| write_vtp(lines, f))?;
        }
        directory.write(Artifact::ShapeSeries, |f| write_pvd(shapes.times(), !outlines.is_empty(), f))?;
    }
    if let Some(scene) = attachments.scene.filter(|_| attachments.solids) {
        write_film(directory, scene, Artifact::ShapeSeries)?;
    }
    if let Some(scene) = attachments.scene.filter(|scene| !scene.is_empty()) {
        directory.write_arrays(Artifact::Scene, |to| scene.put(to))?;
    }
    let summary = Summary::of_run(&RunReport { warnings: &warnings, ..report.clone() }, trajectory);
    directory.write(Artifact::Summary, |f| f.write_all(summary.to_json().as_bytes()))?;
    directory.publish()?;
    Ok(summary.status())
}

#[cfg(all(feature = "archives", feature = "figures"))]
#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::trajectory_figure;
    use crate::samples::sample;
    use crate::summary::tests::report;
    use crate::written::LIST;

    fn with_figure(figure: &Figure) -> Attachments<'_> {
        Attachments { figure: Some(figure), ..Attachments::default() }
    }

    fn files(status: Status) -> Vec<(String, Vec<u8>)> {
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        let t = sample();
        let figure = trajectory_figure(&t, None);
        let stated = write_run(&out, &RunReport { status, ..report() }, &t, "a = 1\n", with_figure(&figure));
        assert_eq!(stated.unwrap(), status);
        let mut files: Vec<_> = std::fs::read_dir(dir.path())
            .unwrap()
            .map(|e| {
                let e = e.unwrap();
                (e.file_name().into_string().unwrap(), std::fs::read(e.path()).unwrap())
            })
            .collect();
        // What the program wrote is listed.
        files.retain(|(name, _)| name != LIST);
        files.sort();
        files
    }

    #[test]
    fn a_run_leaves_its_files_and_nothing_else() {
        let files = files(Status::Stopped);
        let names: Vec<&str> = files.iter().map(|(n, _)| n.as_str()).collect();
        let expected = vec![
            "case.resolved.toml",
            "plot.png",
            "plot.svg",
            "summary.json",
            "trajectory.csv",
            "trajectory.npz",
        ];
        assert_eq!(names, expected);
    }

    #[test]
    fn the_same_run_gives_the_same_bytes() {
        assert!(files(Status::Finished) == files(Status::Finished));
    }
}

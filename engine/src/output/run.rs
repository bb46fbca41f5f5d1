//! All files of one run, in the order that makes an interrupted write recognisable.

use std::io::Write;

use super::plot::Figure;
use super::{
    Artifact, Directory, OutputError, RunReport, Status, Summary, Trajectory, resolved_case, write_csv,
    write_npz,
};

/// Writes the files of a run into `directory`, the summary last, and returns the status that the
/// summary states: [`Status::Failed`] for a run that claims to have finished with a value that is
/// not finite, else the status of `report`. A plot that cannot be drawn costs a warning in the summary,
/// never the results.
///
/// `case` is the resolved case as TOML. `figure` is the plot; `None` leaves the plots out.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk; the directory then has no summary.
pub fn write_run(
    directory: &Directory,
    report: &RunReport<'_>,
    trajectory: &Trajectory,
    case: &str,
    figure: Option<&Figure>,
) -> Result<Status, OutputError> {
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    directory.write(Artifact::TrajectoryCsv, |f| write_csv(trajectory, f))?;
    directory.write(Artifact::TrajectoryNpz, |f| write_npz(trajectory, f))?;
    let mut warnings = report.warnings.to_vec();
    if let Some(figure) = figure {
        let drawing = figure.draw();
        directory.write(Artifact::PlotSvg, |f| f.write_all(drawing.svg().as_bytes()))?;
        match drawing.png() {
            Ok(png) => drop(directory.write(Artifact::PlotPng, |f| f.write_all(&png))?),
            Err(e) => warnings.push(e.to_string()),
        }
    }
    let summary = Summary::of_run(&RunReport { warnings: &warnings, ..report.clone() }, trajectory);
    directory.write(Artifact::Summary, |f| f.write_all(summary.to_json().as_bytes()))?;
    Ok(summary.status())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::plot::trajectory_figure;
    use crate::output::summary::tests::report;
    use crate::output::trajectory::tests::sample;

    fn files(status: Status) -> Vec<(String, Vec<u8>)> {
        let dir = tempfile::tempdir().unwrap();
        let out = Directory::create(dir.path(), false).unwrap();
        let t = sample();
        let figure = trajectory_figure(&t, None);
        let stated = write_run(&out, &RunReport { status, ..report() }, &t, "a = 1\n", Some(&figure));
        assert_eq!(stated.unwrap(), status);
        let mut files: Vec<_> = std::fs::read_dir(dir.path())
            .unwrap()
            .map(|e| {
                let e = e.unwrap();
                (e.file_name().into_string().unwrap(), std::fs::read(e.path()).unwrap())
            })
            .collect();
        files.sort();
        files
    }

    #[test]
    fn a_run_leaves_its_six_files_and_nothing_else() {
        let files = files(Status::Stopped);
        let names: Vec<&str> = files.iter().map(|(n, _)| n.as_str()).collect();
        assert_eq!(
            names,
            [
                "case.resolved.toml",
                "plot.png",
                "plot.svg",
                "summary.json",
                "trajectory.csv",
                "trajectory.npz"
            ]
        );
    }

    #[test]
    fn the_same_run_gives_the_same_bytes() {
        assert!(files(Status::Finished) == files(Status::Finished));
    }
}

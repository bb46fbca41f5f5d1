//! The files that results are made of.

use std::borrow::Cow;

/// The files that results are made of. Their names belong to the program: `--force` replaces them
/// and no other file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Artifact {
    /// `summary.json`: its presence says that the directory is complete.
    Summary,
    /// `case.resolved.toml`.
    ResolvedCase,
    /// `motion.csv`: the table that the case takes the motion of the hub from.
    MotionTable,
    /// `torque.csv`: the table that the case takes the torque on the hub from.
    TorqueTable,
    /// `section.csv`: the table that the case takes its section from.
    SectionTable,
    /// `initial.npz`: the state that the run began with, if the case takes it from a file.
    InitialState,
    /// `state.npz`: the last accepted step, from which a run can go on.
    State,
    /// `trajectory.csv`.
    TrajectoryCsv,
    /// `trajectory.npz`.
    TrajectoryNpz,
    /// `trajectory.parquet`: written with the feature `parquet`.
    TrajectoryParquet,
    /// `plot.svg`.
    PlotSvg,
    /// `plot.png`.
    PlotPng,
    /// `beam.pvd`: the times of the shapes, for ParaView.
    ShapeSeries,
    /// `vtk/frame_00000.vtu` and so on: the shape of the beam at one time.
    Shape(u32),
    /// `beam.vtkhdf`: the shapes of all times in one file, written with the feature `vtkhdf`.
    ShapeHdf,
    /// `compare.json`.
    CompareJson,
    /// `compare.csv`.
    CompareCsv,
    /// `compare.svg`.
    CompareSvg,
    /// `compare.png`.
    ComparePng,
    /// `modes.json`.
    ModesJson,
    /// `modes.csv`.
    ModesCsv,
    /// `modes.npz`.
    ModesNpz,
    /// `modes.svg`.
    ModesSvg,
    /// `modes.png`.
    ModesPng,
    /// `campbell.json`.
    CampbellJson,
    /// `campbell.csv`.
    CampbellCsv,
    /// `campbell.npz`.
    CampbellNpz,
    /// `campbell.svg`.
    CampbellSvg,
    /// `campbell.png`.
    CampbellPng,
}

/// Folder of the shapes.
pub(super) const SHAPES: &str = "vtk";

impl Artifact {
    /// The files of a run of which there is one; the first closes the directory.
    pub const RUN: &'static [Artifact] = &[
        Artifact::Summary,
        Artifact::ResolvedCase,
        Artifact::MotionTable,
        Artifact::TorqueTable,
        Artifact::SectionTable,
        Artifact::InitialState,
        Artifact::State,
        Artifact::TrajectoryCsv,
        Artifact::TrajectoryNpz,
        Artifact::TrajectoryParquet,
        Artifact::PlotSvg,
        Artifact::PlotPng,
        Artifact::ShapeSeries,
        Artifact::ShapeHdf,
    ];

    /// The files of a comparison; the first closes the directory.
    pub const COMPARISON: &'static [Artifact] =
        &[Artifact::CompareJson, Artifact::CompareCsv, Artifact::CompareSvg, Artifact::ComparePng];

    /// The files of modes of vibration; the first closes the directory.
    pub const MODES: &'static [Artifact] = &[
        Artifact::ModesJson,
        Artifact::ResolvedCase,
        Artifact::ModesCsv,
        Artifact::ModesNpz,
        Artifact::ModesSvg,
        Artifact::ModesPng,
    ];

    /// The files of a Campbell diagram; the first closes the directory.
    pub const CAMPBELL: &'static [Artifact] = &[
        Artifact::CampbellJson,
        Artifact::ResolvedCase,
        Artifact::CampbellCsv,
        Artifact::CampbellNpz,
        Artifact::CampbellSvg,
        Artifact::CampbellPng,
    ];

    /// The files of each kind of result; the first of each closes its directory.
    pub(super) const SETS: [&'static [Artifact]; 4] =
        [Artifact::RUN, Artifact::COMPARISON, Artifact::MODES, Artifact::CAMPBELL];

    /// The copy of a file that a case names in its table `key`: `motion`, `torque`, `section` or `initial`.
    pub fn table(key: &str) -> Option<Artifact> {
        match key {
            "motion" => Some(Artifact::MotionTable),
            "torque" => Some(Artifact::TorqueTable),
            "section" => Some(Artifact::SectionTable),
            "initial" => Some(Artifact::InitialState),
            _ => None,
        }
    }

    /// The file's name, relative to the directory, with `/` between folder and file.
    pub fn file_name(self) -> Cow<'static, str> {
        match self {
            Artifact::Summary => "summary.json".into(),
            Artifact::ResolvedCase => "case.resolved.toml".into(),
            Artifact::MotionTable => "motion.csv".into(),
            Artifact::TorqueTable => "torque.csv".into(),
            Artifact::SectionTable => "section.csv".into(),
            Artifact::InitialState => "initial.npz".into(),
            Artifact::State => "state.npz".into(),
            Artifact::TrajectoryCsv => "trajectory.csv".into(),
            Artifact::TrajectoryNpz => "trajectory.npz".into(),
            Artifact::TrajectoryParquet => "trajectory.parquet".into(),
            Artifact::PlotSvg => "plot.svg".into(),
            Artifact::PlotPng => "plot.png".into(),
            Artifact::ShapeSeries => "beam.pvd".into(),
            Artifact::ShapeHdf => "beam.vtkhdf".into(),
            Artifact::Shape(number) => format!("{SHAPES}/frame_{number:05}.vtu").into(),
            Artifact::CompareJson => "compare.json".into(),
            Artifact::CompareCsv => "compare.csv".into(),
            Artifact::CompareSvg => "compare.svg".into(),
            Artifact::ComparePng => "compare.png".into(),
            Artifact::ModesJson => "modes.json".into(),
            Artifact::ModesCsv => "modes.csv".into(),
            Artifact::ModesNpz => "modes.npz".into(),
            Artifact::ModesSvg => "modes.svg".into(),
            Artifact::ModesPng => "modes.png".into(),
            Artifact::CampbellJson => "campbell.json".into(),
            Artifact::CampbellCsv => "campbell.csv".into(),
            Artifact::CampbellNpz => "campbell.npz".into(),
            Artifact::CampbellSvg => "campbell.svg".into(),
            Artifact::CampbellPng => "campbell.png".into(),
        }
    }

    /// Whether a file of this name in the folder of the shapes is one of them.
    pub(super) fn is_shape(name: &str) -> bool {
        name.strip_prefix("frame_")
            .and_then(|rest| rest.strip_suffix(".vtu"))
            .is_some_and(|digits| digits.len() >= 5 && digits.bytes().all(|b| b.is_ascii_digit()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_shapes_are_recognised_and_no_other() {
        for number in [0, 7, 99_999, 123_456] {
            let name = Artifact::Shape(number).file_name();
            assert!(Artifact::is_shape(name.strip_prefix("vtk/").unwrap()), "{name}");
        }
        for name in
            ["frame_.vtu", "frame_00001.vtu.bak", "my_frame_00001.vtu", "frame_0000a.vtu", "notes.txt"]
        {
            assert!(!Artifact::is_shape(name), "{name}");
        }
    }
}

//! The files that results are made of.

use std::borrow::Cow;

/// Folder of the shapes.
pub(super) const SHAPES: &str = "vtk";

/// Declares the files: for each kind of result, variant, file name and description.
macro_rules! artifacts {
    ($($(#[$doc:meta])* $set:ident { $($variant:ident $file:literal $what:literal,)* })*) => {
        /// The files that results are made of. `--force` replaces those that the program wrote, and no other file.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Artifact {
            $($(#[doc = concat!("`", $file, "`: ", $what, ".")] $variant,)*)*
            /// `table1.csv` and so on, by the number from 0: a table that the parts of a system in space are taken from.
            Table(u32),
            /// `vtk/frame_00000.vtu` and so on: the shape of the beam at one time.
            Shape(u32),
            /// `vtk/obstacles_00000.vtp` and so on: the obstacles at the same time.
            Obstacles(u32),
        }

        impl Artifact {
            $($(#[$doc])* pub const $set: &'static [Artifact] = &[$(Artifact::$variant),*];)*

            /// The files of each kind of result.
            pub(super) const SETS: &'static [&'static [Artifact]] = &[$(Artifact::$set),*];

            /// The file's name, relative to the directory, with `/` between folder and file.
            pub fn file_name(self) -> Cow<'static, str> {
                match self {
                    $($(Artifact::$variant => $file.into(),)*)*
                    Artifact::Table(number) => format!("table{}.csv", u64::from(number) + 1).into(),
                    Artifact::Shape(number) => format!("{SHAPES}/frame_{number:05}.vtu").into(),
                    Artifact::Obstacles(number) => format!("{SHAPES}/obstacles_{number:05}.vtp").into(),
                }
            }
        }
    };
}

artifacts! {
    /// The files of a run, shapes aside; the first marks the directory as complete.
    RUN {
        Summary "summary.json" "how the run went",
        ResolvedCase "case.resolved.toml" "the case with every default, in results of any kind but a comparison",
        MotionTable "motion.csv" "the table that the case takes the motion of the hub from",
        TorqueTable "torque.csv" "the table that the case takes the torque on the hub from",
        SectionTable "section.csv" "the table that the case takes its section from",
        InitialState "initial.npz" "the state that the run began with, if the case takes it from a file",
        State "state.npz" "the last accepted step, from which a run can go on",
        TrajectoryCsv "trajectory.csv" "what was recorded, as text",
        TrajectoryNpz "trajectory.npz" "the same for NumPy",
        Scene "scene.npz" "the motion in space, for `flexion view`",
        Events "events.csv" "impacts, and contacts that close, open, slip or stick",
        PlotSvg "plot.svg" "the plot",
        PlotPng "plot.png" "the plot as pixels",
        ShapeSeries "beam.pvd" "the times of the shapes, for ParaView",
    }
    /// The files of a comparison; the first marks the directory as complete.
    COMPARISON {
        CompareJson "compare.json" "the differences",
        CompareCsv "compare.csv" "the differences as a table",
        CompareSvg "compare.svg" "the plot",
        ComparePng "compare.png" "the plot as pixels",
    }
    /// The files of modes of vibration; the first marks the directory as complete.
    MODES {
        ModesJson "modes.json" "frequencies, damping and residuals",
        ModesCsv "modes.csv" "the same as a table",
        ModesNpz "modes.npz" "frequencies and shapes for NumPy",
        ModesScene "equilibrium.npz" "the equilibrium, and displaced by every mode, for `flexion view`",
        ModesSvg "modes.svg" "the plot",
        ModesPng "modes.png" "the plot as pixels",
        ModesSeries "modes.pvd" "every mode in motion, for ParaView",
    }
    /// The files of a Campbell diagram; the first marks the directory as complete.
    CAMPBELL {
        CampbellJson "campbell.json" "branches, crossings and instabilities",
        CampbellCsv "campbell.csv" "the branches as a table",
        CampbellNpz "campbell.npz" "the branches for NumPy",
        CampbellSvg "campbell.svg" "the diagram",
        CampbellPng "campbell.png" "the diagram as pixels",
    }
    /// The files of a path of equilibria; the first marks the directory as complete.
    STATICS {
        StaticsJson "statics.json" "critical states, and the equilibria under all loads",
        StaticsCsv "statics.csv" "the path as a table",
        StaticsNpz "statics.npz" "the path for NumPy",
        StaticsSvg "statics.svg" "the plot of load and displacement",
        StaticsPng "statics.png" "the plot as pixels",
    }
    /// A deck for BeamDyn; the first marks the directory as complete.
    BEAMDYN {
        BeamDynPrimary "beamdyn_primary.dat" "the line of a blade, for BeamDyn",
        BeamDynBlade "beamdyn_blade.dat" "its sections",
    }
    /// A deck for HAWC2.
    HAWC2 {
        Hawc2Sections "hawc2.st" "the sections of a blade, for HAWC2",
    }
    /// The files of advice; the first marks the directory as complete.
    ADVICE {
        AdviceJson "advice.json" "the cheapest run that holds a tolerance, and all that were tried",
        AdviceCsv "advice.csv" "all that were tried as a table",
    }
    /// The files of a report on papers, the tables of their items aside; the first marks the directory as complete.
    REPORT {
        Report "report.html" "figures, tables and verdicts",
        Claims "claims.csv" "the claims with their verdicts",
    }
}

impl Artifact {
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

    /// The files that mark a directory as complete.
    pub(super) fn closing() -> impl Iterator<Item = Artifact> {
        Artifact::SETS.iter().filter_map(|set| set.first().copied())
    }

    /// Whether results of the kind `own` may have a file of this name.
    pub(super) fn may_be_of(own: &[Artifact], name: &str) -> bool {
        let without_case =
            [Artifact::COMPARISON, Artifact::BEAMDYN, Artifact::HAWC2, Artifact::REPORT].contains(&own);
        let case = (!without_case).then_some(&Artifact::ResolvedCase);
        let fixed = own.iter().chain(case).any(|artifact| artifact.file_name() == name);
        let shape = name.strip_prefix(SHAPES).and_then(|rest| rest.strip_prefix('/'));
        let of = |series| own.contains(&series);
        fixed
            || (of(Artifact::Report) && Artifact::is_value_table(name))
            || (of(Artifact::SectionTable) && Artifact::is_table(name))
            || ((of(Artifact::ShapeSeries) || of(Artifact::ModesSeries))
                && shape.is_some_and(Artifact::is_shape))
    }

    /// Whether results of any kind may have a file of this name.
    pub(super) fn is_name(name: &str) -> bool {
        Artifact::SETS.iter().any(|own| Artifact::may_be_of(own, name))
    }

    /// Whether a file of this name may be a table of an item of a paper: `P1_F4_curves.csv`.
    fn is_value_table(name: &str) -> bool {
        let stem = name.strip_suffix(".csv").unwrap_or_default();
        !name.contains(['/', '\\']) && ["_curves", "_points", "_table"].iter().any(|end| stem.ends_with(end))
    }

    /// Whether a file of this name is a [table](Artifact::Table).
    fn is_table(name: &str) -> bool {
        let number = name.strip_prefix("table").and_then(|rest| rest.strip_suffix(".csv"));
        let digits = number.filter(|digits| !digits.starts_with(['0', '+']));
        digits.is_some_and(|digits| digits.parse::<u32>().is_ok())
    }

    /// Whether a file of this name in the folder of the shapes is one of them.
    fn is_shape(name: &str) -> bool {
        let between = |first, last| name.strip_prefix(first).and_then(|rest| rest.strip_suffix(last));
        let number = between("frame_", ".vtu").or_else(|| between("obstacles_", ".vtp"));
        number.is_some_and(|digits| digits.len() >= 5 && digits.bytes().all(|b| b.is_ascii_digit()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_tables_are_recognised_and_no_other() {
        for number in [0, 8, 99] {
            let name = Artifact::Table(number).file_name();
            assert!(Artifact::is_table(&name), "{name}");
        }
        for name in
            ["table.csv", "table0.csv", "table01.csv", "mytable1.csv", "table1.csv.bak", "table+1.csv"]
        {
            assert!(!Artifact::is_table(name), "{name}");
        }
    }

    #[test]
    fn the_names_of_shapes_are_recognised_and_no_other() {
        for number in [0, 99_999, 123_456] {
            let name = Artifact::Shape(number).file_name();
            assert!(Artifact::is_shape(name.strip_prefix("vtk/").unwrap()), "{name}");
            let name = Artifact::Obstacles(number).file_name();
            assert!(Artifact::is_shape(name.strip_prefix("vtk/").unwrap()), "{name}");
        }
        for name in [
            "frame_.vtu",
            "frame_00001.vtu.bak",
            "my_frame_00001.vtu",
            "frame_0000a.vtu",
            "obstacles_00000.vtu",
        ] {
            assert!(!Artifact::is_shape(name), "{name}");
        }
    }
}

//! Files of a path of equilibria.

use super::archive;
use super::plot::statics_figure;
use super::vibration::{close, column, draw};
use super::{Artifact, Directory, OutputError, VERSION, resolved_case};
use flexion::analysis::Stability;
use flexion::analysis::path::Critical;
use flexion::system::{Channel, Role};
use serde_json::{Value, json};
use std::io::Write;

/// Equilibria under growing loads, in their order along the path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadPath {
    /// The recorded quantities.
    pub channels: Vec<Channel>,
    /// The equilibria.
    pub points: Vec<LoadPoint>,
    /// Load factor to which the path is followed.
    pub to: f64,
    /// Why the path ends before, if it does.
    pub end: Option<String>,
}

/// An equilibrium on a path.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadPoint {
    /// Factor of the loads.
    pub factor: f64,
    /// Length of the path to it: of displacements over their scales, and of the factor.
    pub length: f64,
    /// Its stability; `None` where it was not found.
    pub stability: Option<Stability>,
    /// What it is, if it is critical.
    pub critical: Option<Critical>,
    /// Value of each channel.
    pub values: Vec<f64>,
}

impl LoadPath {
    /// The channels that are printed and change along the path, and their numbers.
    pub fn printed(&self) -> impl Iterator<Item = (usize, &Channel)> {
        let main = |role| matches!(role, Role::Primary | Role::Secondary);
        let printed = self.channels.iter().enumerate().filter(move |(_, channel)| main(channel.role));
        printed.filter(|(i, _)| self.changes(*i))
    }

    /// Whether a channel changes along the path.
    pub(super) fn changes(&self, i: usize) -> bool {
        self.points.windows(2).any(|pair| pair[0].values[i] != pair[1].values[i])
    }

    /// The critical states.
    pub fn critical(&self) -> impl Iterator<Item = (&LoadPoint, Critical)> {
        self.points.iter().filter_map(|point| point.critical.map(|critical| (point, critical)))
    }

    fn json(&self, point: &LoadPoint) -> Value {
        let columns: serde_json::Map<String, Value> = self
            .printed()
            .map(|(i, channel)| (format!("{} [{}]", channel.name, channel.unit), json!(point.values[i])))
            .collect();
        json!({
            "load-factor": point.factor,
            "stability": point.stability.map(|found| found.to_string()),
            "unstable": point.stability.map(|found| found.unstable()),
            "critical": point.critical.map(Critical::name),
            "columns": columns,
        })
    }
}

/// Writes and publishes the files of a path. `case` is the resolved case; `cautions` are kept with the warnings.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_statics(
    directory: &Directory,
    path: &LoadPath,
    case: &str,
    title: Option<&str>,
    cautions: &[String],
) -> Result<(), OutputError> {
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    // Numbers of growing motions; −1 where they were not found.
    let unstable = |p: &LoadPoint| p.stability.map_or(-1, |found| found.unstable() as i64);
    directory.write(Artifact::StaticsCsv, |f| {
        write!(f, "load-factor,length,unstable,critical")?;
        path.channels.iter().try_for_each(|channel| write!(f, ",{} [{}]", channel.name, channel.unit))?;
        writeln!(f)?;
        for p in &path.points {
            let critical = p.critical.map_or("", Critical::name);
            write!(f, "{:?},{:?},{},{critical}", p.factor, p.length, unstable(p))?;
            p.values.iter().try_for_each(|value| write!(f, ",{value:?}"))?;
            writeln!(f)?;
        }
        Ok(())
    })?;
    directory.write(Artifact::StaticsNpz, |f| {
        let mut archive = archive::archive(f);
        let points = path.points.iter();
        column(&mut archive, "load_factor", points.clone().map(|p| p.factor))?;
        column(&mut archive, "length", points.clone().map(|p| p.length))?;
        column(&mut archive, "unstable", points.clone().map(|p| unstable(p) as f64))?;
        for (i, channel) in path.channels.iter().enumerate() {
            column(&mut archive, &channel.name, points.clone().map(|p| p.values[i]))?;
        }
        archive::finish(archive)
    })?;
    let mut warnings = cautions.to_vec();
    warnings.extend(draw(
        directory,
        &statics_figure(path, title),
        [Artifact::StaticsSvg, Artifact::StaticsPng],
    )?);
    let critical: Vec<Value> = path.critical().map(|(point, _)| path.json(point)).collect();
    let summary = json!({
        "version": VERSION,
        "points": path.points.len(),
        "to": path.to,
        "end": path.end,
        "last": path.points.last().map(|point| path.json(point)),
        "critical": critical,
        "warnings": warnings,
    });
    close(directory, Artifact::StaticsJson, &summary)
}

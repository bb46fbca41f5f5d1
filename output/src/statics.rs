//! Files of a path of equilibria.

use super::arrays::{Arrays, list};
#[cfg(feature = "figures")]
use super::plot::statics_figure;
use super::vibration::close;
#[cfg(feature = "figures")]
use super::vibration::drawn;
use super::{Artifact, Directory, LoadPath, LoadPoint, OutputError, VERSION, resolved_case};
use flexion::analysis::path::Critical;
use serde_json::{Value, json};
use std::io;

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
    directory.write_arrays(Artifact::StaticsNpz, |to| put_statics(to, path))?;
    #[cfg(not(feature = "figures"))]
    let (warnings, _) = (cautions.to_vec(), title);
    #[cfg(feature = "figures")]
    let warnings = {
        let figure = statics_figure(path, title);
        drawn(directory, &figure, [Artifact::StaticsSvg, Artifact::StaticsPng], cautions.to_vec())?
    };
    close(directory, Artifact::StaticsJson, &statics_json(path, &warnings))
}

/// Puts the arrays of a path: load factors, lengths, numbers of growing motions, and the recorded quantities.
///
/// # Errors
/// Whatever `to` returns.
pub fn put_statics(to: &mut dyn Arrays, path: &LoadPath) -> io::Result<()> {
    let points = path.points.iter();
    list(to, "load_factor", points.clone().map(|p| p.factor))?;
    list(to, "length", points.clone().map(|p| p.length))?;
    list(to, "unstable", points.clone().map(|p| unstable(p) as f64))?;
    for (i, channel) in path.channels.iter().enumerate() {
        list(to, &channel.name, points.clone().map(|p| p.values[i]))?;
    }
    Ok(())
}

/// Number of growing motions; −1 where it was not found.
fn unstable(point: &LoadPoint) -> i64 {
    point.stability.map_or(-1, |found| found.unstable() as i64)
}

/// What is found on a path, as it is written: the last equilibrium and the critical states.
pub fn statics_json(path: &LoadPath, warnings: &[String]) -> Value {
    let critical: Vec<Value> = path.critical().map(|(point, _)| json(path, point)).collect();
    json!({
        "version": VERSION,
        "points": path.points.len(),
        "to": path.to,
        "end": path.end,
        "last": path.points.last().map(|point| json(path, point)),
        "critical": critical,
        "errors": { "estimated": path.unknown.is_none(), "reason": path.unknown },
        "warnings": warnings,
    })
}

/// A point with the quantities that are printed.
fn json(path: &LoadPath, point: &LoadPoint) -> Value {
    let columns: serde_json::Map<String, Value> = path
        .printed()
        .map(|(i, channel)| (format!("{} [{}]", channel.name, channel.unit), json!(point.values[i])))
        .collect();
    let errors = point.error.as_ref().map(|error| {
        let columns = path
            .printed()
            .map(|(i, channel)| (format!("{} [{}]", channel.name, channel.unit), json!(error.values[i])));
        let mut all = serde_json::Map::from_iter([("load-factor".to_owned(), json!(error.factor))]);
        all.extend(columns);
        all
    });
    json!({
        "load-factor": point.factor,
        "stability": point.stability.map(|found| found.to_string()),
        "unstable": point.stability.map(|found| found.unstable()),
        "critical": point.critical.map(Critical::name),
        "columns": columns,
        "error": errors,
    })
}

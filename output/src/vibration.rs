//! Files of modes and of Campbell diagrams.

use super::arrays::{Arrays, Numbers, list};
use super::frequencies::{Frequencies, Units};
#[cfg(feature = "figures")]
use super::plot::{Figure, campbell_figure, modes_figure};
use super::{Artifact, Directory, OutputError, VERSION, resolved_case};
use flexion::analysis::campbell::{Branch, Campbell, Instability, Resonance};
use flexion::analysis::modes::{Mode, Modes};
use num_complex::Complex64;
use serde_json::{Value, json};
use std::io;

/// Writes displacements along the three axes of the sections, and the rotation about the first, in arrays of the given size.
fn write_shapes<'u>(
    to: &mut dyn Arrays,
    mode: &str,
    size: &[u64],
    movement: impl Iterator<Item = &'u [Complex64; 4]> + Clone,
) -> io::Result<()> {
    for (axis, name) in ["axial", "chord", "flap", "torsion"].iter().enumerate() {
        let u = movement.clone().map(|u| u[axis]);
        let (real, imaginary): (Vec<f64>, Vec<f64>) = u.map(|u| (u.re, u.im)).unzip();
        to.put(&format!("{mode}.{name}.real"), size, Numbers::Double(&real))?;
        to.put(&format!("{mode}.{name}.imaginary"), size, Numbers::Double(&imaginary))?;
    }
    Ok(())
}

/// Puts the arrays of modes: their frequencies, the stations of their shapes \[m\], and these.
///
/// # Errors
/// Whatever `to` returns.
pub fn put_modes(
    to: &mut dyn Arrays,
    modes: &[Mode],
    stations: &[f64],
    unit: &Frequencies,
) -> io::Result<()> {
    list(to, "frequency", modes.iter().map(|m| m.frequency() * unit.factor))?;
    let mesh = |m: &Mode| m.mesh.map_or(f64::NAN, |error| error * unit.factor);
    list(to, "mesh_error", modes.iter().map(mesh))?;
    list(to, "damping_ratio", modes.iter().map(Mode::damping_ratio))?;
    list(to, "station", stations.iter().copied())?;
    for (number, m) in modes.iter().enumerate() {
        let size = [stations.len() as u64];
        write_shapes(to, &format!("mode{}", number + 1), &size, m.shape.movement.iter())?;
    }
    Ok(())
}

/// The table of modes at a speed [rad/s], as it is written.
pub fn modes_json(
    modes: &Modes,
    speed: f64,
    units: &Units,
    title: Option<&str>,
    warnings: &[String],
) -> Value {
    let unit = &units.frequency;
    let list: Vec<Value> = modes.modes.iter().map(|m| mode_json(m, unit)).collect();
    json!({
        "version": VERSION,
        "title": title,
        "unit": unit.name,
        "speed-unit": units.speed.name,
        "speed": speed * units.speed.factor,
        "counted": modes.counted,
        "modes": list,
        "overdamped": modes.overdamped.iter().map(|m| -m.eigenvalue.re).collect::<Vec<f64>>(),
        "warnings": warnings,
    })
}

/// Writes and publishes the files of modes at a speed [rad/s], with the names of the three axes of sections. `case` is the resolved case; `cautions` are kept with
/// the warnings.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_modes(
    directory: &Directory,
    (modes, speed, axes): (&Modes, f64, [&str; 3]),
    stations: &[f64],
    units: &Units,
    case: &str,
    title: Option<&str>,
    cautions: &[String],
) -> Result<(), OutputError> {
    let unit = &units.frequency;
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    directory.write(Artifact::ModesCsv, |f| {
        let names = ["frequency", "residual"]
            .map(|name| if name == "frequency" { unit.column(name) } else { name.into() });
        write!(f, "mode,{},{},damping-ratio,nodes,{}", names[0], unit.column("mesh-error"), names[1])?;
        for (name, _) in modes.modes.first().map(shares).into_iter().flatten() {
            write!(f, ",{name}")?;
        }
        writeln!(f)?;
        for (number, m) in modes.modes.iter().enumerate() {
            let frequency = m.frequency() * unit.factor;
            let mesh = m.mesh.map_or(f64::NAN, |error| error * unit.factor);
            let damping = m.damping_ratio();
            write!(f, "{},{frequency:?},{mesh:?},{damping:?},{},{:?}", number + 1, m.nodes, m.residual)?;
            shares(m).iter().try_for_each(|(_, share)| write!(f, ",{share:?}"))?;
            writeln!(f)?;
        }
        Ok(())
    })?;
    directory.write_arrays(Artifact::ModesNpz, |to| put_modes(to, &modes.modes, stations, unit))?;
    #[cfg(not(feature = "figures"))]
    let (warnings, _) = (cautions.to_vec(), (axes, title));
    #[cfg(feature = "figures")]
    let warnings = {
        let figure = modes_figure(modes, (stations, axes), unit, title);
        drawn(directory, &figure, [Artifact::ModesSvg, Artifact::ModesPng], cautions.to_vec())?
    };
    let summary = modes_json(modes, speed, units, title, &warnings);
    close(directory, Artifact::ModesJson, &summary)
}

/// Writes and publishes the files of a Campbell diagram with the lines of 1 to `revolutions`; `case` and `cautions` as of
/// [`write_modes`].
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_campbell(
    directory: &Directory,
    (campbell, revolutions, resonances): (&Campbell, u32, &[Resonance]),
    units: &Units,
    stations: &[f64],
    case: &str,
    title: Option<&str>,
    cautions: &[String],
) -> Result<(), OutputError> {
    let (unit, speed) = (&units.frequency, &units.speed);
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    let curves: Vec<Curve> = (1..).zip(&campbell.branches).map(|(n, b)| Curve::new(n, b, unit)).collect();
    directory.write(Artifact::CampbellCsv, |f| {
        write!(f, "{}", speed.column("speed"))?;
        let columns = || curves.iter().flat_map(|curve| curve.columns.iter().map(move |c| (curve, c)));
        for (curve, (name, _)) in columns() {
            let name = format!("mode{}-{}.{name}", curve.number, curve.moves);
            write!(
                f,
                ",{}",
                if name.ends_with("frequency") || name.ends_with("mesh-error") {
                    unit.column(&name)
                } else {
                    name
                }
            )?;
        }
        writeln!(f)?;
        for &s in &campbell.speeds {
            write!(f, "{:?}", s * speed.factor)?;
            columns().try_for_each(|(_, (_, values))| write!(f, ",{:?}", at(values, s)))?;
            writeln!(f)?;
        }
        Ok(())
    })?;
    directory.write_arrays(Artifact::CampbellNpz, |to| put_campbell(to, campbell, units, Some(stations)))?;
    #[cfg(not(feature = "figures"))]
    let (warnings, _) = (cautions.to_vec(), (revolutions, title));
    #[cfg(feature = "figures")]
    let warnings = {
        let figure = campbell_figure(campbell, revolutions, units, title);
        drawn(directory, &figure, [Artifact::CampbellSvg, Artifact::CampbellPng], cautions.to_vec())?
    };
    let summary = campbell_json(campbell, resonances, units, &warnings);
    close(directory, Artifact::CampbellJson, &summary)
}

/// Puts the arrays of a Campbell diagram: speeds, and for each mode its frequency, damping ratio, error by the mesh and shares; with
/// stations \[m\] these, and the shapes at them.
///
/// # Errors
/// Whatever `to` returns.
pub fn put_campbell(
    to: &mut dyn Arrays,
    campbell: &Campbell,
    units: &Units,
    stations: Option<&[f64]>,
) -> io::Result<()> {
    let (unit, speed) = (&units.frequency, &units.speed);
    let curves: Vec<Curve> = (1..).zip(&campbell.branches).map(|(n, b)| Curve::new(n, b, unit)).collect();
    list(to, "speed", campbell.speeds.iter().map(|s| s * speed.factor))?;
    if let Some(stations) = stations {
        list(to, "station", stations.iter().copied())?;
    }
    for (curve, branch) in curves.iter().zip(&campbell.branches) {
        for (name, values) in &curve.columns {
            let name = format!("mode{}.{}", curve.number, name.replace('-', "_"));
            list(to, &name, campbell.speeds.iter().map(|&s| at(values, s)))?;
        }
        let Some(stations) = stations else { continue };
        // Speed by speed; a curve that has ended is not a number.
        let size = [campbell.speeds.len() as u64, stations.len() as u64];
        let missing = vec![[Complex64::new(f64::NAN, f64::NAN); 4]; stations.len()];
        let shapes = campbell.speeds.iter().enumerate().map(|(i, _)| match branch.points.get(i) {
            Some(point) if point.mode.shape.movement.len() == stations.len() => &point.mode.shape.movement,
            _ => &missing,
        });
        write_shapes(to, &format!("mode{}", curve.number), &size, shapes.flatten())?;
    }
    Ok(())
}

/// What is found in a Campbell diagram, as it is written: ends of branches, crossings, critical speeds, resonances, instabilities.
pub fn campbell_json(
    campbell: &Campbell,
    resonances: &[Resonance],
    units: &Units,
    warnings: &[String],
) -> Value {
    let (unit, speed) = (&units.frequency, &units.speed);
    let crossings: Vec<Value> = campbell
        .crossings
        .iter()
        .map(
            |c| json!({ "mode": c.branch + 1, "revolutions": c.revolutions, "speed": c.speed * speed.factor }),
        )
        .collect();
    let criticals: Vec<Value> = campbell
        .criticals
        .iter()
        .map(|c| json!({ "speed": c.speed * speed.factor, "directions": c.directions }))
        .collect();
    let near = |r: &Resonance| {
        let (from, to) = (r.from * speed.factor, r.to * speed.factor);
        json!({ "mode": r.branch + 1, "revolutions": r.revolutions, "from": from, "to": to })
    };
    let resonances: Vec<Value> = resonances.iter().map(near).collect();
    let instabilities: Vec<Value> = campbell
        .instabilities
        .iter()
        .map(|i| match i {
            Instability::Flutter { branch, from, to, until } => json!({
                "kind": "negative damping", "mode": branch + 1, "from": from * speed.factor, "to": to * speed.factor,
                "until": until.map(|until| until * speed.factor),
            }),
            Instability::Divergence { speed: at, until } => json!({
                "kind": "divergence", "speed": at * speed.factor, "until": until.map(|until| until * speed.factor),
            }),
            Instability::Lost { speed: at, reason } => {
                json!({ "kind": "no steady rotation", "speed": at * speed.factor, "reason": reason })
            }
        })
        .collect();
    let ends: Vec<Value> = campbell
        .branches
        .iter()
        .map(|b| {
            let end = |p: Option<&flexion::analysis::campbell::Point>| p.map(|p| mode_json(&p.mode, unit));
            let followed = b.points.last().map_or(0.0, |p| p.speed * speed.factor);
            json!({ "first": end(b.points.first()), "last": end(b.points.last()), "followed-to": followed })
        })
        .collect();
    json!({
        "version": VERSION,
        "unit": unit.name,
        "speed-unit": units.speed.name,
        "speeds": campbell.speeds.len(),
        "modes": ends,
        "critical-speeds": criticals,
        "crossings": crossings,
        "resonances": resonances,
        "instabilities": instabilities,
        "warnings": warnings,
    })
}

/// The value of a curve at a speed; a curve that has ended is not a number.
fn at(values: &[(f64, f64)], speed: f64) -> f64 {
    values.iter().find(|value| value.0 == speed).map_or(f64::NAN, |value| value.1)
}

/// What is written of a branch at each of its speeds.
struct Curve {
    number: usize,
    /// What moves most at its beginning.
    moves: &'static str,
    /// Names, and pairs of speed \[rad/s\] and value.
    columns: Vec<(String, Vec<(f64, f64)>)>,
}

impl Curve {
    fn new(number: usize, branch: &Branch, unit: &Frequencies) -> Curve {
        let values =
            |of: &dyn Fn(&Mode) -> f64| branch.points.iter().map(|p| (p.speed, of(&p.mode))).collect();
        let mut columns: Vec<(String, Vec<(f64, f64)>)> = vec![
            ("frequency".to_owned(), values(&|m| m.frequency() * unit.factor)),
            ("damping-ratio".to_owned(), values(&Mode::damping_ratio)),
            ("mesh-error".to_owned(), values(&|m| m.mesh.map_or(f64::NAN, |error| error * unit.factor))),
        ];
        let first = branch.points.first().map(|point| &point.mode);
        for (i, (name, _)) in first.into_iter().flat_map(shares).enumerate() {
            let share: Vec<(f64, f64)> = values(&|m| shares(m)[i].1);
            // What never moves is left out.
            if share.iter().any(|(_, share)| share.abs() > 1e-12) {
                columns.push((format!("share.{name}"), share));
            }
        }
        Curve { number, moves: first.map_or("", |mode| mode.shares.dominant()), columns }
    }
}

/// Names and values of what a mode moves, that of beams also along the axes of their sections.
fn shares(mode: &Mode) -> Vec<(String, f64)> {
    let named = mode.shares.named().map(|(name, share)| (name.to_owned(), share));
    let section = mode.shares.in_section().map(|(name, share)| (format!("section-{name}"), share));
    named.into_iter().chain(section).collect()
}

fn mode_json(m: &Mode, unit: &Frequencies) -> Value {
    let shares: serde_json::Map<String, Value> =
        shares(m).into_iter().map(|(name, share)| (name, json!(share))).collect();
    json!({
        "frequency": m.frequency() * unit.factor,
        "mesh-error": m.mesh.map(|error| error * unit.factor),
        "damping-ratio": m.damping_ratio(),
        "nodes": m.nodes,
        "residual": m.residual,
        "rounding": m.rounding,
        "shares": shares,
    })
}

/// Draws a figure, and gives the warnings with that of a picture that cannot be made.
#[cfg(feature = "figures")]
pub(super) fn drawn(
    directory: &Directory,
    figure: &Figure,
    [svg, png]: [Artifact; 2],
    mut warnings: Vec<String>,
) -> Result<Vec<String>, OutputError> {
    let drawing = figure.draw();
    directory.write(svg, |f| f.write_all(drawing.svg().as_bytes()))?;
    match drawing.png() {
        Ok(bytes) => directory.write(png, |f| f.write_all(&bytes))?,
        Err(error) => warnings.push(error.to_string()),
    }
    Ok(warnings)
}

pub(super) fn close(directory: &Directory, artifact: Artifact, summary: &Value) -> Result<(), OutputError> {
    let text = serde_json::to_string_pretty(summary).unwrap_or_default();
    directory.write(artifact, |f| writeln!(f, "{text}"))?;
    directory.publish()
}

//! Files of modes and of Campbell diagrams.

use super::archive::{self, Latched};
use super::frequencies::Frequencies;
use super::npz::write_array;
use super::plot::{Figure, campbell_figure, modes_figure};
use super::{Artifact, Directory, OutputError, VERSION, resolved_case};
use flexion::analysis::campbell::{Campbell, Instability};
use flexion::analysis::modes::{Mode, Modes};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use zip::ZipWriter;

/// Writes and publishes the files of modes at a speed [rad/s]. `case` is the resolved case; `cautions` are kept with
/// the warnings.
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_modes(
    directory: &Directory,
    (modes, speed): (&Modes, f64),
    stations: &[f64],
    unit: &Frequencies,
    case: &str,
    title: Option<&str>,
    cautions: &[String],
) -> Result<(), OutputError> {
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    directory.write(Artifact::ModesCsv, |f| {
        let names = ["frequency", "residual"]
            .map(|name| if name == "frequency" { unit.column(name) } else { name.into() });
        write!(f, "mode,{},damping-ratio,nodes,{}", names[0], names[1])?;
        let shares = |mode: &Mode| mode.shares.named();
        for (name, _) in modes.modes.first().map(shares).into_iter().flatten() {
            write!(f, ",{name}")?;
        }
        writeln!(f)?;
        for (number, m) in modes.modes.iter().enumerate() {
            let frequency = m.frequency() * unit.factor;
            write!(f, "{},{frequency:?},{:?},{},{:?}", number + 1, m.damping_ratio(), m.nodes, m.residual)?;
            shares(m).iter().try_for_each(|(_, share)| write!(f, ",{share:?}"))?;
            writeln!(f)?;
        }
        Ok(())
    })?;
    directory.write(Artifact::ModesNpz, |f| {
        let mut archive = archive::archive(f);
        let all = &modes.modes;
        column(&mut archive, "frequency", all.iter().map(|m| m.frequency() * unit.factor))?;
        column(&mut archive, "damping_ratio", all.iter().map(Mode::damping_ratio))?;
        column(&mut archive, "station", stations.iter().copied())?;
        for (number, m) in all.iter().enumerate() {
            for (axis, name) in ["tangent", "second", "third"].iter().enumerate() {
                let of = |name: &str| format!("mode{}.{name}", number + 1);
                let u = m.shape.displacement.iter().map(|u| u[axis]);
                column(&mut archive, &of(&format!("{name}.real")), u.clone().map(|u| u.re))?;
                column(&mut archive, &of(&format!("{name}.imaginary")), u.map(|u| u.im))?;
            }
        }
        archive::finish(archive)
    })?;
    let mut warnings = cautions.to_vec();
    warnings.extend(draw(
        directory,
        &modes_figure(modes, stations, unit, title),
        [Artifact::ModesSvg, Artifact::ModesPng],
    )?);
    let list: Vec<Value> = modes.modes.iter().map(|m| mode_json(m, unit)).collect();
    let summary = json!({
        "version": VERSION,
        "title": title,
        "unit": unit.name,
        "speed": speed * unit.factor,
        "counted": modes.counted,
        "modes": list,
        "warnings": warnings,
    });
    close(directory, Artifact::ModesJson, &summary)
}

/// Writes and publishes the files of a Campbell diagram; `case` and `cautions` as of [`write_modes`].
///
/// # Errors
/// [`OutputError`] for whatever goes wrong on disk.
pub fn write_campbell(
    directory: &Directory,
    campbell: &Campbell,
    revolutions: u32,
    unit: &Frequencies,
    case: &str,
    title: Option<&str>,
    cautions: &[String],
) -> Result<(), OutputError> {
    directory.write(Artifact::ResolvedCase, |f| f.write_all(resolved_case(case).as_bytes()))?;
    let at = |branch: usize, speed: f64| {
        let points = campbell.branches.get(branch).map_or(&[][..], |b| &b.points);
        points.iter().find(|p| p.speed == speed).map(|p| &p.mode)
    };
    let frequency = |branch, speed| at(branch, speed).map_or(f64::NAN, |m| m.frequency() * unit.factor);
    let damping = |branch, speed| at(branch, speed).map_or(f64::NAN, Mode::damping_ratio);
    let count = campbell.branches.len();
    directory.write(Artifact::CampbellCsv, |f| {
        write!(f, "{}", unit.column("speed"))?;
        for k in 1..=count {
            write!(f, ",{},mode{k}.damping-ratio", unit.column(&format!("mode{k}.frequency")))?;
        }
        writeln!(f)?;
        for &speed in &campbell.speeds {
            write!(f, "{:?}", speed * unit.factor)?;
            for branch in 0..count {
                write!(f, ",{:?},{:?}", frequency(branch, speed), damping(branch, speed))?;
            }
            writeln!(f)?;
        }
        Ok(())
    })?;
    directory.write(Artifact::CampbellNpz, |f| {
        let mut archive = archive::archive(f);
        column(&mut archive, "speed", campbell.speeds.iter().map(|s| s * unit.factor))?;
        for branch in 0..count {
            let name = |of: &str| format!("mode{}.{of}", branch + 1);
            let speeds = campbell.speeds.iter();
            column(&mut archive, &name("frequency"), speeds.clone().map(|&s| frequency(branch, s)))?;
            column(&mut archive, &name("damping_ratio"), speeds.map(|&s| damping(branch, s)))?;
        }
        archive::finish(archive)
    })?;
    let figure = campbell_figure(campbell, revolutions, unit, title);
    let mut warnings = cautions.to_vec();
    warnings.extend(draw(directory, &figure, [Artifact::CampbellSvg, Artifact::CampbellPng])?);
    let crossings: Vec<Value> = campbell
        .crossings
        .iter()
        .map(
            |c| json!({ "mode": c.branch + 1, "revolutions": c.revolutions, "speed": c.speed * unit.factor }),
        )
        .collect();
    let instabilities: Vec<Value> = campbell
        .instabilities
        .iter()
        .map(|i| match i {
            Instability::Flutter { branch, from, to } => json!({
                "kind": "negative damping", "mode": branch + 1, "from": from * unit.factor, "to": to * unit.factor,
            }),
            Instability::Divergence { speed, reason } => {
                json!({ "kind": "divergence", "speed": speed * unit.factor, "reason": reason })
            }
            Instability::Lost { speed, reason } => {
                json!({ "kind": "no steady rotation", "speed": speed * unit.factor, "reason": reason })
            }
        })
        .collect();
    let ends: Vec<Value> = campbell
        .branches
        .iter()
        .map(|b| {
            let end = |p: Option<&flexion::analysis::campbell::Point>| p.map(|p| mode_json(&p.mode, unit));
            let followed = b.points.last().map_or(0.0, |p| p.speed * unit.factor);
            json!({ "first": end(b.points.first()), "last": end(b.points.last()), "followed-to": followed })
        })
        .collect();
    let summary = json!({
        "version": VERSION,
        "unit": unit.name,
        "speeds": campbell.speeds.len(),
        "modes": ends,
        "crossings": crossings,
        "instabilities": instabilities,
        "warnings": warnings,
    });
    close(directory, Artifact::CampbellJson, &summary)
}

fn mode_json(m: &Mode, unit: &Frequencies) -> Value {
    let shares: serde_json::Map<String, Value> =
        m.shares.named().into_iter().map(|(name, share)| (name.to_owned(), json!(share))).collect();
    json!({
        "frequency": m.frequency() * unit.factor,
        "damping-ratio": m.damping_ratio(),
        "nodes": m.nodes,
        "residual": m.residual,
        "rounding": m.rounding,
        "shares": shares,
    })
}

fn column(
    archive: &mut ZipWriter<Latched<&mut BufWriter<&mut File>>>,
    name: &str,
    values: impl Iterator<Item = f64> + Clone,
) -> io::Result<()> {
    write_array(archive, name, values.clone().count(), values)
}

/// Draws a figure; a picture that cannot be made is a warning.
fn draw(
    directory: &Directory,
    figure: &Figure,
    [svg, png]: [Artifact; 2],
) -> Result<Vec<String>, OutputError> {
    let drawing = figure.draw();
    directory.write(svg, |f| f.write_all(drawing.svg().as_bytes()))?;
    match drawing.png() {
        Ok(bytes) => directory.write(png, |f| f.write_all(&bytes)).map(|()| Vec::new()),
        Err(error) => Ok(vec![error.to_string()]),
    }
}

fn close(directory: &Directory, artifact: Artifact, summary: &Value) -> Result<(), OutputError> {
    let text = serde_json::to_string_pretty(summary).unwrap_or_default();
    directory.write(artifact, |f| writeln!(f, "{text}"))?;
    directory.publish()
}

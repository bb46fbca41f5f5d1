//! A system in space in words: the tree of its parts, its masses and its freedoms.

use crate::screen::row;
use flexion::linalg::Matrix;
use flexion::section::BladeResultants;
use flexion::system::{Dynamics, Parameter, State, Steady, Weights};
use flexion_case::kinds::beam::Beam;
use flexion_case::{Link, Reading, Space};
use flexion_results::plot::assembly_figure;
use flexion_results::write_file;
use std::path::Path;

/// Most velocities for which motions without stiffness are counted: their number costs a dense elimination.
const COUNTED: usize = 200;
/// Entries below this are rounding, over the largest.
const ROUNDING: f64 = 1e-12;

/// The body or beam in the name of a place: `blade` of `blade.tip`.
fn part(place: &str) -> &str {
    place.split(['.', '@']).next().unwrap_or(place)
}

/// The parts as a tree from the ground: each on the first joint that leads to it, further joints of a loop behind.
pub fn tree(space: &Space) -> String {
    let mut out = String::new();
    let mut seen = vec!["ground"];
    let mut used = vec![false; space.joints.len()];
    out.push_str("ground\n");
    branch(space, "ground", 1, &mut seen, &mut used, &mut out);
    let bodies = space.bodies.iter().map(|body| body.name.as_str());
    for name in bodies.chain(space.beams.iter().map(|(beam, _)| beam.name.as_str())) {
        if !seen.contains(&name) {
            seen.push(name);
            out.push_str(&format!("{name} (free)\n"));
            branch(space, name, 1, &mut seen, &mut used, &mut out);
        }
    }
    out
}

fn branch<'s>(
    space: &'s Space,
    from: &str,
    depth: usize,
    seen: &mut Vec<&'s str>,
    used: &mut [bool],
    out: &mut String,
) {
    for (i, Link { name, kind, between, .. }) in space.joints.iter().enumerate() {
        let [a, b] = between;
        let (here, there) = if part(a) == from { (a, b) } else { (b, a) };
        if part(here) != from || used[i] {
            continue;
        }
        used[i] = true;
        let place = if here == from { String::new() } else { format!("{here} ") };
        let closes = if seen.contains(&part(there)) { ", closes a loop" } else { "" };
        out.push_str(&format!("{}└─ {place}[{name}: {kind}{closes}] {there}\n", "   ".repeat(depth - 1)));
        if closes.is_empty() {
            seen.push(part(there));
            branch(space, part(there), depth + 1, seen, used, out);
        }
    }
}

/// Draws the parts at the start.
pub fn draw(reading: &Reading, file: &Path) -> Result<(), String> {
    let Some(space) = reading.case.space() else {
        return Err("--draw is for a system in space, and the case is of a beam on a hub".to_owned());
    };
    let mut system = reading.case.system().map_err(|error| error.to_string())?;
    let state = system.initial();
    let mut scene = reading.case.scene();
    scene.finish(system.as_mut(), &state);
    let joints: Vec<_> = space.joints.iter().map(|joint| (joint.name.as_str(), joint.point)).collect();
    let turning = space.rotation.as_ref().ok().map(|of| (of.axis.point, of.axis.direction));
    let drawing = assembly_figure(&scene, &joints, &space.blades(), turning, reading.title()).draw();
    let extension = file.extension().map(|text| text.to_string_lossy().to_lowercase());
    let bytes = match extension.as_deref() {
        Some("svg") => drawing.svg().into_bytes(),
        Some("png") => drawing.png().map_err(|error| error.to_string())?,
        _ => return Err(format!("the drawing {} must end in .svg or .png", file.display())),
    };
    write_file(file, &bytes).map_err(|error| error.to_string())
}

/// Masses, degrees of freedom, constraints, and motions without stiffness.
pub fn described(space: &Space) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for body in space.multibody.model().bodies() {
        let [x, y, z] = body.frame.position.0;
        rows.push(row(&body.name, format!("{:.6} kg at ({x:.6}, {y:.6}, {z:.6}) m", body.mass)));
    }
    for (beam, built) in &space.beams {
        let (elements, length, mass) = (built.elements(), beam.length, beam.mass());
        rows.push(row(
            &beam.name,
            format!("{mass:.6} kg, {} m, {elements} elements", (1e9 * length).round() / 1e9),
        ));
        if beam.section.is_blade {
            rows.extend(of_blade(beam));
        }
    }
    let bodies = space.multibody.model().bodies().iter().map(|body| body.mass);
    let total: f64 = bodies.chain(space.beams.iter().map(|(beam, _)| beam.mass())).sum();
    rows.push(row("total mass", format!("{total:.6} kg")));
    let system = &space.multibody;
    let freedoms = system.freedoms();
    rows.push(row("degrees of freedom", format!("{freedoms}, by {} rows of joints", system.size().lambda)));
    if let Ok(rotation) = &space.rotation {
        rows.push(row("steady rotation", rotation.described(false)));
    }
    for dropped in system.dropped() {
        rows.push(row("left out", dropped.following()));
    }
    if system.size().v <= COUNTED {
        rows.push(row(
            "without stiffness",
            format!("{} of them, at the start and without loads", free(space)),
        ));
    }
    rows
}

/// What the deck of a beam says of its ends.
fn of_blade(beam: &Beam) -> Vec<Vec<String>> {
    let [root, tip] = [0.0, beam.length].map(|s| beam.blade.resultants(s));
    let stiffness = |of: fn(&BladeResultants) -> f64| {
        format!("{:.6e} N·m² at the root, {:.6e} at the tip", of(&root), of(&tip))
    };
    let mut rows = vec![
        row("flapwise stiffness", stiffness(|r| r.flap_stiffness)),
        row("edgewise stiffness", stiffness(|r| r.chord_stiffness)),
    ];
    if beam.section.deck.as_ref().is_none_or(|(_, has_line)| !has_line) {
        let [root, tip] = [root, tip].map(|of| (1e3 * of.twist.to_degrees()).round() / 1e3 + 0.0);
        let twist = format!("{root:.3}° at the root, {tip:.3}° at the tip, about the axis towards the tip");
        rows.push(row("twist", twist));
    }
    rows.push(row("torsion", if beam.torsion { "as its section says" } else { "held" }.to_owned()));
    rows
}

/// Number of motions x that no joint and no stiffness opposes: G x = 0 and K x = 0 without loads, n less the rank of both.
fn free(space: &Space) -> usize {
    let mut system = space.multibody.clone();
    let state = system.initial();
    let (n, scales) = (system.size().v, system.scales().to_vec());
    // Without loads: what is left has no limit that could refuse it.
    let _ = system.set(Parameter::LoadFactor, 0.0);
    let mut stiffness = Matrix::new(&system.structure(0));
    let rest = State { v: vec![0.0; n], ..state.clone() };
    system.tangent(&rest, Weights::new(0.0, 0.0, 1.0), &mut stiffness);
    let mut rows: Vec<Vec<f64>> =
        (0..n).map(|i| (0..n).map(|j| stiffness.get(i, j) * scales[i] * scales[j]).collect()).collect();
    let first = rows.len();
    rows.resize(first + system.size().lambda, vec![0.0; n]);
    system.jacobian(&rest, &mut |row, velocities, entries| {
        velocities.iter().zip(entries).for_each(|(j, x)| rows[first + row][*j] += x * scales[*j]);
    });
    let largest = |row: &[f64]| row.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let (stiffest, steepest) = (rows[..first].iter(), rows[first..].iter());
    let [stiffest, steepest] =
        [stiffest.map(|r| largest(r)).fold(0.0, f64::max), steepest.map(|r| largest(r)).fold(0.0, f64::max)];
    for (i, row) in rows.iter_mut().enumerate() {
        let size = if i < first { stiffest } else { steepest };
        row.iter_mut().for_each(|x| *x /= if size > 0.0 { size } else { 1.0 });
    }
    n - rank(rows)
}

/// Rank by Gaussian elimination with complete pivoting.
fn rank(mut rows: Vec<Vec<f64>>) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    for k in 0..columns.min(rows.len()) {
        let places = (k..rows.len()).flat_map(|i| (k..columns).map(move |j| (i, j)));
        let Some((i, j)) = places.max_by(|a, b| rows[a.0][a.1].abs().total_cmp(&rows[b.0][b.1].abs())) else {
            return k;
        };
        if rows[i][j].abs() <= ROUNDING {
            return k;
        }
        rows.swap(i, k);
        rows.iter_mut().for_each(|row| row.swap(j, k));
        let (above, below) = rows.split_at_mut(k + 1);
        let pivot = &above[k];
        for row in below {
            let factor = row[k] / pivot[k];
            (k..columns).for_each(|j| row[j] -= factor * pivot[j]);
        }
    }
    columns.min(rows.len())
}

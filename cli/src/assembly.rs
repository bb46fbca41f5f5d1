//! A system in space in words: the tree of its parts, its masses and its freedoms.

use crate::check::row;
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::modes;
use flexion::system::Dynamics;
use flexion_case::Space;

/// Most degrees of freedom for which motions without stiffness are counted: their number costs a dense eigenproblem.
const COUNTED: usize = 300;

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
    for (i, (name, kind, between)) in space.joints.iter().enumerate() {
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

/// Masses, degrees of freedom, constraints, and motions without stiffness.
pub fn described(space: &Space) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for body in &space.bodies {
        let [x, y, z] = body.frame.position;
        rows.push(row(&body.name, format!("{:.6} kg at ({x:.6}, {y:.6}, {z:.6}) m", body.mass)));
    }
    for (beam, built) in &space.beams {
        let (elements, length, mass) = (built.elements().len(), beam.length, beam.mass());
        rows.push(row(&beam.name, format!("{mass:.6} kg, {length} m, {elements} elements")));
    }
    let bodies = space.bodies.iter().map(|body| body.mass);
    let total: f64 = bodies.chain(space.beams.iter().map(|(beam, _)| beam.mass())).sum();
    rows.push(row("total mass", format!("{total:.6} kg")));
    let system = &space.multibody;
    let freedoms = system.freedoms();
    rows.push(row("degrees of freedom", format!("{freedoms}, by {} rows of joints", system.size().lambda)));
    for dropped in system.dropped() {
        rows.push(row("left out", dropped.clone()));
    }
    rows.extend(free(space, freedoms).map(|text| row("without stiffness", text)));
    rows
}

/// How many motions have no stiffness in the equilibrium.
fn free(space: &Space, freedoms: usize) -> Option<String> {
    if freedoms == 0 || freedoms > COUNTED {
        return None;
    }
    let mut system = space.multibody.clone();
    let mut state = system.initial();
    if let Err(error) = equilibrium(&mut system, &mut state) {
        return Some(format!("not counted: {error}"));
    }
    let found = modes(&mut system, &state, freedoms, &[]).ok()?;
    let highest = found.modes.iter().map(|mode| mode.frequency()).fold(0.0, f64::max);
    let soft = found.modes.iter().filter(|mode| mode.eigenvalue.norm() <= 1e-6 * highest || highest == 0.0);
    Some(format!("{} of {freedoms} motions, in the equilibrium", soft.count()))
}

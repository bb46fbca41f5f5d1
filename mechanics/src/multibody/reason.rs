//! What makes a run fail or go astray: bodies almost without inertia, parts that nothing holds, loops close to a singular configuration.

use super::beam::Beam;
use super::consistency::rows;
use super::constants::Constants;
use super::joint::{Joint, Kind};
use super::marker::Part;
use super::model::Model;
use super::system::Multibody;
use crate::linalg::vector::{axpy, dot};
use crate::system::{Dynamics, Limit, Slender, State};

/// Mass over the largest, and moment of inertia over m L² with the size L of the system, below which a body counts as one without.
const LIGHT: f64 = 1e-14;
/// Part of a row that is independent of the others, below which a configuration is close to a singular one.
const DEPENDENT: f64 = 0.1;
/// Most operations that are worth an explanation.
const COSTLY: usize = 1_000_000_000;

/// A body that has almost no mass or no moment of inertia, and is not fixed to another part.
pub(super) fn without_inertia(constants: &Constants) -> Option<String> {
    let bodies = &constants.model.bodies;
    let (size, largest) = (constants.scales.first()?, bodies.iter().map(|b| b.mass).fold(0.0, f64::max));
    let cure = "give it that of its shape, or join it to a body by `fixed`";
    let fixed = |i: usize| {
        let of = |joint: &Joint| {
            joint.kind == Kind::Fixed && [joint.from.part, joint.to.part].contains(&Part::Body(i))
        };
        constants.model.joints.iter().any(of)
    };
    bodies.iter().enumerate().filter(|(i, _)| !fixed(*i)).find_map(|(_, body)| {
        let least = (0..3).map(|i| body.inertia[i][i]).fold(f64::INFINITY, f64::min);
        let name = &body.name;
        if body.mass < LIGHT * largest {
            let part = body.mass / largest;
            return Some(format!(
                "body `{name}` has the mass {:.1e} kg, {part:.1e} of the largest: {cure}",
                body.mass
            ));
        }
        let part = least / (body.mass * size * size);
        (part < LIGHT).then(|| {
            format!(
                "body `{name}` has the moment of inertia {least:.1e} kg·m², {part:.1e} of m L² with the size {size:.2} m of the system, \
                 and any moment turns it at once: {cure}"
            )
        })
    })
}

/// Part of a deflection that rounding may take, from which on it is told.
const ROUNDED: f64 = 1e-2;

/// A beam with shear that is too slender for its elements: rounding of their stiffness in shear hides that in bending.
pub(super) fn rounded(model: &Model) -> Option<String> {
    let worst = model.beams.iter().map(|of| (of.beam.rounding(), of));
    let (part, of) = worst.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(part, _)| *part > ROUNDED)?;
    Some(format!(
        "beam `{}` is so slender that rounding of its stiffness in shear may take up to {part:.1e} of a deflection with {} elements: take fewer, or leave \
         the shear out",
        of.name,
        of.beam.elements()
    ))
}

/// L² times the stiffness in shear or along the axis over that in bending, from which on rounding of the larger one is looked for in frequencies.
const SLENDER: f64 = 1e10;

/// The most slender beam of those that are so slender that rounding counts.
pub(super) fn slender(model: &Model) -> Option<Slender> {
    let ratio = |beam: &Beam| {
        let [stiff, bending] = beam.stiffest_and_bending();
        let nodes = beam.nodes();
        let length = nodes.last().unwrap_or(&0.0) - nodes.first().unwrap_or(&0.0);
        length * length * stiff / bending
    };
    let worst = model.beams.iter().map(|of| (ratio(&of.beam), of));
    let (ratio, of) = worst.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(ratio, _)| *ratio > SLENDER)?;
    Some(Slender { beam: of.name.clone(), ratio, shear: of.beam.has_shear() })
}

/// Parts that no chain of joints and springs leads to the ground from, and that touch nothing: in a model in which others are held, one was
/// perhaps forgotten.
pub(super) fn not_held(model: &Model) -> Option<String> {
    let bodies = model.bodies.len();
    let number = |part: Part| match part {
        Part::Ground => 0,
        Part::Body(i) => 1 + i,
        Part::Section { beam, .. } => 1 + bodies + beam,
    };
    let joints = model.joints.iter().map(|joint| [joint.from.part, joint.to.part]);
    let springs = model.springs.iter().map(|spring| [spring.from.part, spring.to.part]);
    let links: Vec<[usize; 2]> = joints.chain(springs).map(|ends| ends.map(number)).collect();
    let mut held = vec![false; 1 + bodies + model.beams.len()];
    held[0] = true;
    model.points.iter().for_each(|point| held[number(point.at.part)] = true);
    while let Some(link) = links.iter().find(|[a, b]| held[*a] != held[*b]) {
        link.iter().for_each(|i| held[*i] = true);
    }
    let bodies = model.bodies.iter().map(|body| ("body", &body.name));
    let parts = bodies.chain(model.beams.iter().map(|beam| ("beam", &beam.name)));
    let free: Vec<String> = parts
        .zip(&held[1..])
        .filter(|(_, held)| !**held)
        .map(|((kind, name), _)| format!("{kind} `{name}`"))
        .collect();
    let all = held.len() - 1;
    (!free.is_empty() && free.len() < all).then(|| {
        let (is, it) = if free.len() == 1 { ("is", "it moves") } else { ("are", "they move") };
        format!(
            "{} {is} held by no joint or spring: {it} freely; name {} in the `between` of a joint to hold {}",
            free.join(", "),
            if free.len() == 1 { "it" } else { "them" },
            if free.len() == 1 { "it" } else { "them" }
        )
    })
}

/// The joints whose rows almost follow from each other at `s`.
pub(super) fn singular(system: &mut Multibody, s: &State) -> Option<Limit> {
    let constants = system.constants.clone();
    let (n, m) = (s.v.len(), s.lambda.len());
    if m.saturating_mul(m).saturating_mul(n) > COSTLY {
        return None;
    }
    let scale = system.scales().to_vec();
    // What the rows before leave of each, and the combination of rows that makes it.
    let mut basis: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut least = (DEPENDENT, None);
    for (i, row) in rows(system, s).iter().enumerate() {
        let (mut x, mut combination) = (vec![0.0; n], vec![0.0; m]);
        row.iter().for_each(|&(j, entry)| x[j] += entry * scale[j]);
        combination[i] = 1.0;
        let size = dot(&x, &x).sqrt();
        for (unit, of_unit) in &basis {
            let along = dot(&x, unit);
            axpy(-along, unit, &mut x);
            axpy(-along, of_unit, &mut combination);
        }
        let left = dot(&x, &x).sqrt();
        if left <= least.0 * size {
            least = (left / size, Some((i, combination.clone())));
        }
        if left > 0.0 {
            x.iter_mut().chain(&mut combination).for_each(|x| *x /= left);
            basis.push((x, combination));
        }
    }
    let (part, Some((row, combination))) = least else { return None };
    let joints = constants.joints_in(&combination, 1e-3).into_iter();
    let joints: Vec<String> = joints.map(|k| format!("`{}`", constants.model.joints[k].name)).collect();
    let joints = joints.join(", ");
    Some(Limit::Singular { joints, row: constants.row_name(row), part })
}

//! How rigid motions, which have no stiffness, are told from others.

use crate::linalg::Matrix;
use crate::linalg::eigen::{EigenError, Pencil, UNCERTAIN};
use crate::system::{State, StiffnessForm, System};
use num_complex::Complex64;

/// A rigid motion has |λ| below this part of the lowest frequency of the held system.
pub(super) const RIGID: f64 = 1e-4;
/// Shift, over a frequency that bounds all, with which rigid motions are told from others.
const SHIFT: f64 = 1e-3;
/// Shift, over the lowest frequency that is not of a rigid motion, from which the modes are seen where there are such motions.
pub(super) const BELOW: f64 = 0.3;
/// Rigid motions of a body.
pub(super) const RIGID_MOTIONS: usize = 6;

/// Eigenvalues next to zero among which rigid motions are looked for where there are negative ones.
const NEAREST: usize = 6;

/// Energy of the strains of a motion, over the rounding of the energy by an assembled stiffness, up to which it is rigid.
const STRAINED: f64 = 1e-3;

/// Standard deviations of a sum of random signs within which it is.
const DEVIATIONS: f64 = 3.0;

/// Part of the modal mass of a motion without stiffness, up to which it is rounding of others.
const DEFECTIVE: f64 = 2e-6;

/// Whether the pencil of K, which was factored, has a motion that rounding alone decides, by the strains where the system sums them; or whether the
/// elimination makes rounding errors grow.
pub(super) fn has_rigid_motions(pencil: &mut Pencil, system: &mut dyn System, state: &State) -> bool {
    let Some(softest) = pencil.softest() else { return true };
    if softest.unstable {
        return true;
    }
    let motion = softest.motion[..state.v.len()].to_vec();
    let of_joints = f64::EPSILON * joint_moment(system, state) * angle(&motion, system.scales()).powi(2);
    if softest.rounding + of_joints <= UNCERTAIN * softest.energy {
        return false;
    }
    let form = strain_form(system, state, vec![motion]);
    form.is_none_or(|form| form.is_zero_but_for(STRAINED * softest.rounding + of_joints))
}

/// Whether a motion has no stiffness by the strains, or a frequency below `rigid` [rad/s]; true where the system has its stiffness as a matrix only.
pub(super) fn is_without_form(
    system: &mut dyn System,
    state: &State,
    pencil: &Pencil,
    x: &[Complex64],
    rigid: f64,
) -> bool {
    let form = strain_form(system, state, parts(&x[..state.v.len()]).into());
    form.is_none_or(|form| form.is_zero_but_for(rigid * rigid * pencil.modal_mass(x)))
}

/// What a motion without stiffness has beyond those `known`, of modal mass 1, in the inner product of M; nothing where it is a combination of them.
pub(super) fn beyond<'a>(
    mut vector: Vec<Complex64>,
    known: impl Iterator<Item = &'a [Complex64]>,
    pencil: &Pencil,
) -> Option<Vec<Complex64>> {
    for known in known {
        let within = inner(known, &vector, pencil);
        vector.iter_mut().zip(known).for_each(|(x, y)| *x -= within * y);
    }
    // A defective eigenvalue has its vector to half the digits.
    (inner(&vector, &vector, pencil).re > DEFECTIVE).then_some(vector)
}

/// Real and imaginary part.
pub(super) fn parts(x: &[Complex64]) -> [Vec<f64>; 2] {
    [x.iter().map(|x| x.re).collect(), x.iter().map(|x| x.im).collect()]
}

/// xᴴ M y
fn inner(x: &[Complex64], y: &[Complex64], pencil: &Pencil) -> Complex64 {
    let ([re, im], mut my) = (parts(y), vec![0.0; y.len()]);
    let mut with = |part: &[f64]| -> Complex64 {
        pencil.mass().multiply(part, &mut my);
        x.iter().zip(&my).map(|(x, my)| x.conj() * my).sum()
    };
    with(&re) + Complex64::I * with(&im)
}

/// The form xᵀKx of a motion by the strains.
struct StrainForm {
    of: StiffnessForm,
    /// What the forces that an equilibrium leaves make of the form of a rigid motion.
    left: f64,
}

impl StrainForm {
    /// Whether it is zero but for rounding and for so much.
    fn is_zero_but_for(&self, small: f64) -> bool {
        self.of.value.abs() <= small + 0.5 * self.of.rounding / UNCERTAIN + self.left
    }
}

/// Largest of the forces Gᵀλ of joints, each times the scale of its unknown \[N m\]. Rounding of the multipliers, a part of this, is in the stiffness
/// Σ λᵀ ∂²g/∂q² where nothing else is.
fn joint_moment(system: &mut dyn System, state: &State) -> f64 {
    let mut free = state.clone();
    free.lambda.fill(0.0);
    let [with, without] = [state, &free].map(|state| {
        let mut forces = vec![0.0; state.v.len()];
        system.residual(state, &mut forces);
        forces
    });
    let forces = with.iter().zip(&without).zip(system.scales());
    forces.fold(0.0, |most, ((with, without), scale)| most.max(((with - without) * scale).abs()))
}

/// Largest entry of a motion over the scale of its unknown.
fn angle(x: &[f64], scales: &[f64]) -> f64 {
    x.iter().zip(scales).map(|(x, s)| (x / s).abs()).fold(0.0, f64::max)
}

/// Sum of the forms of motions; `None` where the system has its stiffness as a matrix only.
///
/// Along a rotation by an angle ϑ what is at a distance s moves by ϑ²s/2 to second order, and forces r that an equilibrium leaves work on it: the form of a
/// rigid motion is not zero but Σ r s ϑ², a sum of numbers of random signs where r is rounding.
fn strain_form(system: &mut dyn System, state: &State, motions: Vec<Vec<f64>>) -> Option<StrainForm> {
    let forms = system.stiffness_forms(state, &motions)?;
    let mut forces = vec![0.0; state.v.len()];
    system.residual(state, &mut forces);
    let scales = system.scales();
    let moment = forces.iter().zip(scales).map(|(r, s)| (r * s).powi(2)).sum::<f64>().sqrt();
    let square: f64 = motions.iter().map(|x| angle(x, scales).powi(2)).sum();
    let sum = |part: fn(&StiffnessForm) -> f64| forms.iter().map(part).sum::<f64>();
    let of = StiffnessForm { value: sum(|form| form.value), rounding: sum(|form| form.rounding) };
    Some(StrainForm { of, left: DEVIATIONS * moment * square })
}

/// Pencil whose shift is far above rounding and below most frequencies; `None` without masses or stiffness.
fn shifted(all: &[Matrix; 3], multipliers: usize) -> Result<Option<Pencil>, EigenError> {
    let largest = |k: usize| {
        let n = all[k].order() - multipliers;
        (0..n).map(|i| all[k].get(i, i).abs()).fold(0.0, f64::max)
    };
    let top = (largest(2) / largest(0)).sqrt();
    if top > 0.0 { Pencil::new(all.clone(), multipliers, SHIFT * top).map(Some) } else { Ok(None) }
}

/// Lowest frequency that is not of a rigid motion, of a system whose rigid motions nothing holds.
pub(super) fn elastic_frequency(
    all: &[Matrix; 3],
    multipliers: usize,
    count: usize,
) -> Result<f64, EigenError> {
    let Some(mut pencil) = shifted(all, multipliers)? else { return Ok(1.0) };
    let there = all[0].order() - 2 * multipliers;
    let found = pencil.pairs((count + RIGID_MOTIONS).min(there), &[])?;
    let last = found.iter().map(|pair| pair.value.norm()).fold(0.0, f64::max);
    let elastic = found.iter().filter(|pair| pencil.rounding(pair.value, &pair.vector) < UNCERTAIN);
    Ok(elastic.map(|pair| pair.value.norm()).filter(|size| *size > RIGID * last).fold(last, f64::min))
}

/// Number of directions in which a symmetric K is negative by more than rounding, where `negative` pivots of it are: of the eigenvalues
/// of K x = μ M x next to zero those that rounding decides do not count.
pub(super) fn certain_directions(
    [mass, damping, stiffness]: &[Matrix; 3],
    multipliers: usize,
    negative: usize,
) -> Result<usize, EigenError> {
    let mut none = damping.clone();
    none.clear();
    let all = [mass.clone(), none, stiffness.clone()];
    let Some(mut pencil) = shifted(&all, multipliers)? else { return Ok(0) };
    let there = mass.order() - 2 * multipliers;
    let (mut certain, mut rounded) = (0, 0);
    for pair in pencil.pairs((NEAREST + RIGID_MOTIONS).min(there), &[])? {
        if pencil.rounding(pair.value, &pair.vector) >= UNCERTAIN {
            rounded += 1;
        } else if pair.value.re > 0.0 {
            certain += 1;
        }
    }
    Ok(certain.max(negative.saturating_sub(rounded)))
}

//! Contacts of a case: before its run nothing begins inside an obstacle, and masses at contacts are those of the beam; behind it
//! nothing was pressed further than a beam bears.

use crate::kinds::contact::OnBeam;
use crate::kinds::cross_section::Section;
use crate::kinds::initial::Initial;
use crate::problem::Problems;
use crate::reading::Reading;
use crate::run::scene::drawn_height;
use flexion::contact::{ImpactMap, Law};
use flexion::system::{ContactInfo, Mode, State, System};
use flexion_results::Trajectory;

/// Gap over the length of the beam below which a contact touches at the start.
const TOUCHING: f64 = 1e-11;
/// Velocity, over the largest of the system, that counts as zero.
const STILL: f64 = 1e-9;
/// Force over EA from which a contact stretches a beam further than linear elasticity goes.
const STRETCHED: f64 = 0.05;
/// Change of an effective mass on doubling the basis that is worth a warning.
const CHANGE: f64 = 0.2;

impl Reading {
    /// Whether no contact begins inside its obstacle, closes at the start, or carries an equilibrium that moves past its obstacle.
    pub(super) fn check_contacts(&self, system: &mut dyn System, state: &State) -> Result<(), Problems> {
        let tolerance = TOUCHING * self.case.size();
        // An equilibrium may rest on elastic contacts.
        let at_rest = !matches!(self.case.initial, Initial::Undeformed);
        let fastest = system.fastest(&state.v);
        for (touch, key) in system.contacts(state).iter().zip(self.case.contact_keys()) {
            let ContactInfo { name, row, gap, rate, speed, .. } = touch;
            let still = STILL * fastest.max(*speed);
            if at_rest && row.is_none() {
                continue;
            }
            if *gap < -tolerance {
                let message = format!(
                    "the contact `{name}` begins {:.3e} m inside the obstacle: move the obstacle, or turn it to the other side",
                    -gap
                );
                return Err(self.problem(&format!("{key}.obstacle"), message));
            }
            if row.is_some_and(|row| state.mode[row] == Mode::Closed) {
                if rate.abs() > still {
                    let message = format!(
                        "the equilibrium presses on the obstacle of the contact `{name}`, which it leaves or enters with {:.3e} m/s: \
                         what rests on it must move with it",
                        rate.abs()
                    );
                    return Err(self.problem(&format!("{key}.obstacle"), message));
                }
                continue;
            }
            if *gap <= tolerance && *rate < -still && state.t == 0.0 {
                let message = format!(
                    "the contact `{name}` touches at the start and closes with {:.3e} m/s: begin with a gap, or at rest",
                    -rate
                );
                return Err(self.problem(&format!("{key}.obstacle"), message));
            }
        }
        Ok(())
    }

    /// What beams bear at their contacts.
    pub(super) fn limits(&self) -> Vec<Limit> {
        let limit = |name: &str, (section, length): (&Section, f64), station: f64, law: &Law| Limit {
            name: name.to_owned(),
            stiffness: section.planar.resultants(station).axial_stiffness,
            depth: if let Law::Force(_) = law { drawn_height(section, length) } else { f64::INFINITY },
        };
        if let Some(beam) = self.case.hub_beam() {
            let points = beam.contacts.iter().flat_map(|of| &of.points);
            return points
                .map(|(name, station, law)| limit(name, (&beam.section, beam.length), *station, law))
                .collect();
        }
        let Some(space) = self.case.space() else { return Vec::new() };
        let on_beams = space.contacts.iter().zip(&space.touching).filter_map(|(contact, (part, station))| {
            let (beam, _) = space.beams.get(part.checked_sub(space.bodies.len())?)?;
            Some(limit(&contact.name, (&beam.section, beam.length), *station, &contact.law))
        });
        on_beams.collect()
    }

    /// A warning where twice the functions have another effective mass at a contact with restitution.
    pub(super) fn effective_masses(&self, system: &mut dyn System, state: &State) -> Vec<String> {
        let rigid = |law: &Law| matches!(law, Law::Constraint { .. });
        let planar = |of: &OnBeam| !of.contact.massless && rigid(&of.contact.law);
        let planar = self.case.hub_beam().is_some_and(|beam| beam.contacts.iter().any(planar));
        let space = self.case.space().filter(|space| !space.beams.is_empty());
        if !planar && !space.is_some_and(|space| space.contacts.iter().any(|contact| rigid(&contact.law))) {
            return Vec::new();
        }
        let masses = |system: &mut dyn System, state: &State| -> Option<Vec<(String, f64)>> {
            let masses = ImpactMap::new(system).masses(system, state).ok()?;
            let contacts = system.contacts(state);
            Some(contacts.into_iter().filter_map(|touch| Some((touch.name, masses[touch.row?]))).collect())
        };
        let doubled = || {
            let mut system = self.changed(&self.case.finer()).ok()?.case.system().ok()?;
            let state = State { t: state.t, ..system.initial() };
            masses(system.as_mut(), &state)
        };
        let undeformed = State { t: state.t, ..system.initial() };
        let (Some(coarse), Some(fine)) = (masses(system, &undeformed), doubled()) else { return Vec::new() };
        let pairs = coarse.iter().zip(&fine).map(|((name, coarse), (_, fine))| (name, *coarse, *fine));
        let far = |(_, coarse, fine): &(&String, f64, f64)| (coarse - fine).abs() > CHANGE * coarse;
        let Some((name, coarse, fine)) = pairs.into_iter().find(far) else { return Vec::new() };
        vec![format!(
            "the effective mass at {name} is {coarse:.3e} kg at the start and with twice the functions {fine:.3e} kg: restitution \
             here is a parameter of the mesh; the impulse of a whole burst, the next touch and heights of rebound stay \
             within a few per cent for e < 1, single impulses and energies do not"
        )]
    }
}

/// What a beam bears at a contact.
#[derive(Clone, Debug)]
pub(super) struct Limit {
    /// Name of the contact.
    name: String,
    /// Axial stiffness EA \[N\].
    stiffness: f64,
    /// Largest indentation \[m\].
    depth: f64,
}

impl Limit {
    /// How far a force or an indentation is beyond it, over the limit, and what to say of it.
    fn exceeded(&self, trajectory: &Trajectory) -> Option<(f64, String)> {
        let extremes = |quantity: &str| {
            trajectory.index(&format!("{}.{quantity}", self.name)).map(|index| trajectory.extremes(index))
        };
        let (force, gap) = (extremes("force")?, extremes("gap")?);
        let (strain, depth) = (force.max / self.stiffness, -gap.min);
        let (excess, how) = if strain > STRETCHED {
            let (force, at) = (force.max, force.t_max);
            let how = format!("presses with {force:.3e} N at t = {at:.4} s, {:.0} % of EA", 100.0 * strain);
            (strain / STRETCHED, how)
        } else if depth > self.depth {
            let at = gap.t_min;
            let how =
                format!("is {depth:.3e} m inside its obstacle at t = {at:.4} s, more than the beam is high");
            (depth / self.depth, how)
        } else {
            return None;
        };
        Some((excess, format!("the contact `{}` {how}", self.name)))
    }
}

/// A warning of the contact that is furthest beyond what its beam bears: of an obstacle that moves on where the beam cannot follow.
pub(super) fn overloaded(limits: &[Limit], trajectory: &Trajectory) -> Option<String> {
    let exceeded: Vec<_> = limits.iter().filter_map(|limit| limit.exceeded(trajectory)).collect();
    let (_, worst) = exceeded.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let others = match exceeded.len() - 1 {
        0 => String::new(),
        1 => " (and another contact less so)".to_owned(),
        others => format!(" (and {others} other contacts less so)"),
    };
    Some(format!(
        "{worst}{others}, which no linear-elastic beam bears: does the obstacle move on where the beam cannot follow?"
    ))
}

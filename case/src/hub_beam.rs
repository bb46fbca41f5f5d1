//! A beam on a hub: its parts, and what is checked across them.

use super::fault::{At, Found, Made};
use super::kind::{Choice, Context, Table};
use super::kinds::basis::{self, Bases};
use super::kinds::blade::{BLADE, Blade};
use super::kinds::contact::{self, CONTACT, Contact};
use super::kinds::coupling::{COUPLING, Coupling, fits_whole_curve};
use super::kinds::integrator::Method;
use super::kinds::load::{self, LOADS, Load};
use super::kinds::motion::MOTION;
use super::kinds::section::{SECTION, Section};
use super::values::Values;
use flexion::hub_beam::{Damping, Drive, Hub};
use flexion::profile::{Constant, Motion};
use flexion::section::Resultants;
use std::sync::Arc;

/// A beam on a hub, in the plane of its rotation or as a blade.
#[derive(Clone, Debug)]
pub struct HubBeam {
    /// Length L of the beam \[m\].
    pub length: f64,
    /// The cross-section.
    pub section: Section,
    /// The hub.
    pub hub: Hub,
    /// What makes the beam a blade; `None` for a beam in the plane of rotation.
    pub blade: Option<Blade>,
    /// The kinematic model.
    pub coupling: Coupling,
    /// The bases of the two displacement fields.
    pub bases: Bases,
    /// What acts on the beam and what it carries.
    pub loads: Vec<Load>,
    /// What the beam may touch.
    pub contacts: Vec<Contact>,
    /// Damping of the beam.
    pub damping: Damping,
}

/// Speeds √(EA/ρA) of waves of stretch beyond which there is a caution; in soft rubber it is 30 m/s, in diamond 18 000 m/s \[m/s\].
const SLOWEST: f64 = 10.0;
const FASTEST: f64 = 30_000.0;
/// Slenderness L√(EA/EI) below which there is a caution: shear then bends a beam as much as its curvature does.
const THICKEST: f64 = 5.0;

/// Makes the beam of the values of its case, for a method of integration.
pub(super) fn make(v: &Values, c: &Context<'_>, method: Option<&Method>) -> Made<HubBeam> {
    let mut found = Found::default();
    let coupling = found.part(model(v, &COUPLING, c));
    let section = found.part(SECTION.make(v, "section", c));
    if let Some(section) = &section {
        // Stiffnesses that are given as such may stand for a beam that does not stretch.
        let fastest = if v.kind("section") == Some("resultants") { f64::INFINITY } else { FASTEST };
        implausible(section.planar.resultants(0.0), fastest, c);
    }
    let hub = found.part(hub(v, c));
    let loads = loads(v, c, &mut found);
    let jumps = section.iter().flat_map(|section| section.planar.jumps().iter().copied());
    let acting = loads.iter().flatten().flat_map(|load| load.nodes.iter().copied());
    let bases = found.part(basis::make(v, c, &jumps.chain(acting).collect::<Vec<_>>()));
    let contacts = found.part(CONTACT.make(v, c).and_then(contact::named));
    let damping = found.part(load::DAMPING.make(v, c)).map(|list| list.first().copied().unwrap_or_default());
    let blade = found.part(BLADE.make(v, c)).map(|list| list.into_iter().next());
    if let (Some(method), Some(damping)) = (method, damping) {
        overdamped(method, damping, &mut found);
    }
    if let (Some(coupling), Some(bases)) = (coupling, &bases)
        && coupling.whole_curve
    {
        let name = v.kind("basis").unwrap_or_default();
        found.part(fits_whole_curve(bases, name));
    }
    if let (Some(coupling), Some(bases), Some(section), Some(loads), Some(contacts), Some(length)) =
        (coupling, &bases, &section, &loads, &contacts, c.length)
    {
        let at_tip = |load: &Load| load.mass.is_some_and(|mass| mass.station == length);
        let has_mass = [
            (coupling.whole_curve, "the exact coupling needs it: use `first` or `high`"),
            (
                bases.massless.is_none(),
                "no function of this basis moves the tip alone: use finite elements or modes",
            ),
            (section.planar.resultants(length).rotary_inertia != 0.0, "the section has rotary inertia"),
            (loads.iter().any(at_tip), "a mass is fixed there"),
        ];
        let why_not = has_mass.iter().find(|(has, _)| *has).map(|(_, why)| *why);
        found.part(contact::fits_massless(contacts, why_not));
    }
    if let (Some(Some(blade)), Some(section)) = (&blade, &section) {
        found.part(blade.built(section, 0.0, &[]).map_err(|faults| faults.within("blade")));
    }
    let parts = || {
        Some(HubBeam {
            length: c.length?,
            section: section?,
            hub: hub?,
            blade: blade?,
            coupling: coupling?,
            bases: bases?,
            loads: loads?,
            contacts: contacts?,
            damping: damping?,
        })
    };
    match parts() {
        Some(beam) if found.0.0.is_empty() => Ok(beam),
        _ => Err(found.0),
    }
}

/// Cautions for a section at the root that no material or no slender beam has.
fn implausible(r: Resultants, fastest: f64, c: &Context<'_>) {
    let speed = (r.axial_stiffness / r.mass).sqrt();
    if !(SLOWEST..=fastest).contains(&speed) {
        c.cautions.borrow_mut().push(format!(
            "the stiffness of the section, EA = {:.3e} N and EI = {:.3e} N·m², lets waves of stretch run at {speed:.2} m/s \
             (steel: 5000 m/s): is a unit missing or wrong?",
            r.axial_stiffness, r.bending_stiffness
        ));
    }
    let radius = (r.bending_stiffness / r.axial_stiffness).sqrt();
    if let Some(length) = c.length.filter(|length| *length < THICKEST * radius) {
        c.cautions.borrow_mut().push(format!(
            "the radius of gyration of the section is {radius:.3} m on a beam of {length} m: the theory is for slender beams; is a \
             unit missing or wrong?"
        ));
    }
}

/// Damping that the method can follow.
fn overdamped(method: &Method, damping: Damping, found: &mut Found) {
    let overdamped = !method.integrator.info().implicit && damping.stiffness > 0.0;
    found.check(overdamped, "damping.stiffness-proportional", || {
        "damping in proportion to the stiffness overdamps the shortest waves, and no explicit method follows them: use \
         an implicit one, `radau` or `generalized-alpha`"
            .to_owned()
    });
}

fn model<T>(v: &Values, choice: &Choice<T>, c: &Context<'_>) -> Made<T> {
    choice.make(v.table("model")?, choice.name, c).map_err(|faults| faults.within("model"))
}

fn hub(v: &Values, c: &Context<'_>) -> Made<Hub> {
    let hub = v.table("hub")?;
    let drive = match hub.optional("motion")? {
        // A case without a motion has no run: its hub is at rest until a speed is given.
        None if hub.sound => Drive::Prescribed(Motion::Speed {
            profile: Arc::new(Constant::new(0.0).at("hub")?),
            initial_angle: 0.0,
        }),
        _ => MOTION.make(hub, "motion", c).map_err(|faults| faults.within("hub"))?,
    };
    Ok(Hub { radius: hub.number("radius")?, inertia: hub.number("inertia")?, drive })
}

fn loads(v: &Values, c: &Context<'_>, found: &mut Found) -> Option<Vec<Load>> {
    let named = |table: &Table<Load>| {
        let made = table.make(v, c);
        made.map(|list| {
            list.into_iter().map(|load| Load { table: table.key.name, ..load }).collect::<Vec<_>>()
        })
    };
    let made: Vec<_> = LOADS.iter().map(|table| found.part(named(table))).collect();
    let lists: Option<Vec<Vec<Load>>> = made.into_iter().collect();
    lists.map(|lists| lists.concat())
}

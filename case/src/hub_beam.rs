//! A beam on a hub: its parts, and what is checked across them.

use super::declaration::Key;
use super::driven;
use super::fault::{At, Fault, Faults, Found, Made};
use super::features;
use super::kind::{Context, Keys};
use super::kinds::basis::{self, Bases};
use super::kinds::contact::{OnBeam, on_beam};
use super::kinds::coupling::{Coupling, SPACE, SPACE_WITH_SHEAR, fits_whole_curve};
use super::kinds::cross_section::Section;
use super::kinds::damping::DAMPING;
use super::kinds::integrator::Method;
use super::kinds::load::{Acts, LOAD, Load};
use super::kinds::mass::MASS;
use super::kinds::spring::{Joins, SPRING, Spring};
use super::layout::{self, GRAVITY, HUB, MODEL_ON_HUB, ModelOnHub, OneBeam, SPATIAL_TABLES};
use super::places::Place;
use super::values::{Values, item, join};
use flexion::basis::mesh;
use flexion::hub_beam::load::{self as acting, Axes};
use flexion::hub_beam::{Damping, Drive, Hub, Mass};
use flexion::linalg::Vec3;
use flexion::profile::{Constant, Motion, changes};
use flexion::section::Resultants;
use std::sync::Arc;

/// A beam on a hub, in the plane of its rotation.
#[derive(Clone, Debug)]
pub struct HubBeam {
    /// Length L of the beam \[m\].
    pub length: f64,
    /// The cross-section.
    pub section: Section,
    /// The hub.
    pub hub: Hub,
    /// The kinematic model.
    pub coupling: Coupling,
    /// The bases of the two displacement fields.
    pub bases: Bases,
    /// What acts on the beam and what it carries.
    pub loads: Vec<Acting>,
    /// What the beam may touch.
    pub contacts: Vec<OnBeam>,
    /// Damping of the beam.
    pub damping: Damping,
}

/// What one table of a case puts onto the beam.
#[derive(Clone, Debug, Default)]
pub struct Acting {
    /// The table.
    pub table: String,
    /// What acts.
    pub load: Option<Arc<dyn acting::Load + Send + Sync>>,
    /// What the beam carries.
    pub mass: Option<Mass>,
    /// Stations at which cells of the quadrature must end \[m\].
    pub stations: Vec<f64>,
    /// Stations at which elements should end \[m\]: something acts or begins there.
    pub nodes: Vec<f64>,
    /// What it is called, if its direction is fixed in space: seen from a hub that rotates, it changes with every
    /// revolution.
    pub fixed_in_space: Option<&'static str>,
    /// How it changes with time.
    pub amplitude: acting::Amplitude,
}

impl HubBeam {
    /// Whether a load of a fixed direction changes its size up to the time `until` \[s\].
    pub fn load_changes(&self, until: f64) -> bool {
        let fixed = self.loads.iter().filter(|load| load.fixed_in_space.is_some());
        fixed.filter_map(|load| load.amplitude.as_deref()).any(|profile| changes(profile, until))
    }
}

impl Acting {
    /// A load that acts on `stations`, of which elements end at `nodes`.
    fn new(
        table: String,
        load: impl acting::Load + Send + Sync + 'static,
        [stations, nodes]: [Vec<f64>; 2],
        fixed_in_space: Option<&'static str>,
    ) -> Acting {
        let load = Some(Arc::new(load) as Arc<dyn acting::Load + Send + Sync>);
        Acting { table, load, stations, nodes, fixed_in_space, ..Acting::default() }
    }
}

/// Speeds √(EA/ρA) of waves of stretch beyond which there is a caution; in soft rubber it is 30 m/s, in diamond 18 000 m/s \[m/s\].
const SLOWEST: f64 = 10.0;
const FASTEST: f64 = 30_000.0;
/// Slenderness L√(EA/EI) below which there is a caution: shear then bends a beam as much as its curvature does.
const THICKEST: f64 = 5.0;

/// Makes the beam of the values of its case, for a method of integration.
pub(super) fn make(v: &Values, c: &Context<'_>, method: Option<&Method>) -> Made<HubBeam> {
    let mut found = Found::default();
    let coupling = found.part(MODEL_ON_HUB.read(v, c)).and_then(|model| {
        found.part(planar(v, &model));
        model.coupling.made
    });
    let section = found.part(layout::SECTION.read(v, c));
    if let Some(section) = &section {
        // Stiffnesses that are given as such may stand for a beam that does not stretch.
        let fastest =
            if layout::SECTION.chosen_in(v) == Some("resultants") { f64::INFINITY } else { FASTEST };
        implausible(section.planar.resultants(0.0), fastest, c);
    }
    let mut hub = found.part(hub(v, c));
    if let Some(hub) = &mut hub {
        found.part(driven::on_hub(c.signals, hub));
    }
    let loads = loads(v, c, &mut found);
    let acting: Vec<f64> = loads.iter().flatten().flat_map(|load| load.nodes.iter().copied()).collect();
    let ends = |elements: usize| {
        let mut ends = acting.clone();
        let Some((length, section)) = c.length.zip(section.as_ref()) else { return ends };
        // An end found may take the place of one of the equal elements' that did for another: until there is nothing to add.
        while let Ok(cells) = mesh(length, elements, &ends) {
            let of_section = section.planar.ends(&cells, length / elements as f64);
            let found = ends.len();
            ends.extend(of_section.into_iter().filter(|x| !acting.contains(x)));
            ends.sort_by(f64::total_cmp);
            ends.dedup();
            if ends.len() == found {
                break;
            }
        }
        ends
    };
    let bases = found.part(layout::BASIS.read(v, c).and_then(|basis| basis::make(&basis, c, &ends)));
    if let (Some(length), Some(section)) = (c.length, &section) {
        found.part(features::apart(section.planar.jumps(), length));
        let width = bases.as_ref().and_then(|bases| bases.width);
        c.cautions
            .borrow_mut()
            .extend(width.and_then(|width| features::hidden(&section.planar, length, width)));
    }
    let contacts = found.part(on_beam(v, c));
    let damping = found.part(DAMPING.make(v, c)).map(|list| list.first().copied().unwrap_or_default());
    if let (Some(damping), Some(coupling), Some(section), Some(loads)) = (damping, coupling, &section, &loads)
    {
        let turns = |load: &Acting| load.mass.is_some_and(|mass| mass.inertia > 0.0);
        let inertia = section.planar.resultants(0.0).rotary_inertia > 0.0 || loads.iter().any(turns);
        if damping.mass > 0.0 && coupling.whole_curve && inertia {
            let caution = "damping in proportion to the mass acts on the velocity of the axis here, and not on the rotation of sections and masses, as it does with `first` \
                           and `high`";
            c.cautions.borrow_mut().push(caution.to_owned());
        }
    }
    if let (Some(method), Some(damping)) = (method, damping) {
        overdamped(method, damping, &mut found);
    }
    if let (Some(coupling), Some(bases)) = (coupling, &bases)
        && coupling.whole_curve
    {
        let name = layout::BASIS.chosen_in(v).unwrap_or_default();
        found.part(fits_whole_curve(bases, name));
    }
    if let (Some(coupling), Some(bases), Some(section), Some(loads), Some(contacts), Some(length)) =
        (coupling, &bases, &section, &loads, &contacts, c.length)
    {
        let at_tip = |load: &Acting| load.mass.is_some_and(|mass| mass.station == length);
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
        found.part(fits_massless(contacts, why_not));
    }
    let parts = || {
        Some(HubBeam {
            length: c.length?,
            section: section?,
            hub: hub?,
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

/// Refuses what only a model in space carries.
fn planar(v: &Values, model: &ModelOnHub) -> Made<()> {
    let coupling = model.coupling.name;
    if model.coupling.made.is_none() {
        return Ok(());
    }
    let of_model = [
        (model.refine.is_some(), ModelOnHub::refine.key.name),
        (model.drop_redundant_rows.is_some(), ModelOnHub::drop_redundant_rows.key.name),
    ];
    let of_model = of_model.iter().filter(|(written, _)| *written).map(|(_, key)| join("model", key));
    let beam = layout::BEAM.values_in(v);
    let spatial = |key: &&Key| key.name != OneBeam::length.key.name;
    let written = |key: &&Key| beam.is_some_and(|beam| beam.is_written(key.name));
    let of_beam = OneBeam::KEYS.iter().filter(spatial).filter(written);
    let of_beam = of_beam.map(|key| join(layout::BEAM.key.name, key.name));
    let tables = SPATIAL_TABLES.iter().filter(|key| v.is_written(key.name)).map(|key| key.name.to_owned());
    let faults: Vec<Fault> = tables
        .chain(of_model)
        .chain(of_beam)
        .map(|path| {
            let message =
                format!("`{coupling}` is a model of one beam on a hub in the plane, and does not carry this");
            let carries = if path.ends_with(".shear") { SPACE_WITH_SHEAR } else { SPACE };
            Fault::new(path, message).help(format!("write `model.coupling = \"{carries}\"`, or leave it out"))
        })
        .collect();
    if faults.is_empty() { Ok(()) } else { Err(Faults(faults)) }
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
    found.check(overdamped, "damping.stiffness", || {
        "damping in proportion to the stiffness overdamps the shortest waves, and no explicit method follows them: use \
         an implicit one, `radau` or `generalized-alpha`"
            .to_owned()
    });
}

fn hub(v: &Values, c: &Context<'_>) -> Made<Hub> {
    let layout::Hub { radius, inertia, motion } = HUB.read(v, c)?;
    let drive = match motion {
        // A case without a motion has no run: its hub is at rest until a speed is given.
        None => Drive::Prescribed(Motion::Speed {
            profile: Arc::new(Constant::new(0.0).at("hub")?),
            initial_angle: 0.0,
        }),
        Some(drive) => drive,
    };
    Ok(Hub { radius, inertia, drive })
}

/// The components along x and y of what lies in the plane of motion.
fn in_plane(Vec3([x, y, z]): Vec3, key: &str) -> Made<[f64; 2]> {
    if z == 0.0 {
        return Ok([x, y]);
    }
    let fault = Fault::new(key, "points out of the plane of motion, that of x and y");
    Err(fault.help("leave the third component out").into())
}

/// What a force of these axes is called, if its direction is fixed in space.
fn in_space(axes: Axes) -> Option<&'static str> {
    (axes == Axes::Dead).then_some("forces of fixed direction")
}

/// Everything that acts on the beam and that it carries: the weight, masses, forces, couples, forces per length and springs.
fn loads(v: &Values, c: &Context<'_>, found: &mut Found) -> Option<Vec<Acting>> {
    let gravity = found.part(GRAVITY.read(v, c).and_then(gravity));
    let masses = found.part(MASS.make(v, c));
    let mut loads = found.part(LOAD.make(v, c));
    loads.iter_mut().for_each(|loads| driven::on_loads(c.signals, loads));
    let springs = found.part(SPRING.make(v, c));
    let (gravity, masses, loads, springs) = (gravity?, masses?, loads?, springs?);
    let mut all: Vec<Acting> = gravity.into_iter().collect();
    for (i, mass) in masses.iter().enumerate() {
        let carried = Mass { station: mass.station, mass: mass.mass, inertia: mass.inertia };
        let nodes = vec![mass.station];
        all.push(Acting { table: item("mass", i), mass: Some(carried), nodes, ..Acting::default() });
    }
    let mut made: [Vec<Acting>; 3] = Default::default();
    let mut whole = true;
    let mut within = |table: &str, made: Made<()>| {
        whole &= found.part(made.map_err(|faults| faults.within(table))).is_some();
    };
    for (i, load) in loads.iter().enumerate() {
        let table = item("load", i);
        within(&table, add_load(load, &table, &mut made));
    }
    all.extend(made.into_iter().flatten());
    for (i, of) in springs.iter().enumerate() {
        let table = item("spring", i);
        let made = spring(of, &table).map(|spring| all.push(spring));
        within(&table, made);
    }
    whole.then_some(all)
}

fn gravity(acceleration: Vec3) -> Made<Option<Acting>> {
    let [x, y] = in_plane(acceleration, GRAVITY.key.name)?;
    let gravity = acting::Gravity { acceleration: libm::hypot(x, y), direction: libm::atan2(y, x) };
    let acting = Acting::new(GRAVITY.key.name.to_owned(), gravity, Default::default(), Some("gravity"));
    Ok((gravity.acceleration != 0.0).then_some(acting))
}

/// Adds a load to the forces, the couples or the forces per length.
fn add_load(load: &Load, table: &str, [forces, couples, lines]: &mut [Vec<Acting>; 3]) -> Made<()> {
    let (axes, amplitude) = (load.axes, || load.amplitude.clone());
    match &load.acts {
        Acts::At { on, force, couple, .. } => {
            let &Place::Station { s, .. } = on else { return Err(Faults::default()) };
            let force = in_plane(*force, "force")?;
            if couple[0] != 0.0 || couple[1] != 0.0 {
                let fault =
                    Fault::new("couple", "turns the beam out of the plane of motion, that of x and y");
                return Err(fault.help("write one number, the couple about z").into());
            }
            let at = || [vec![s], vec![s]];
            if force != [0.0; 2] || couple[2] == 0.0 {
                let load = acting::Force { station: s, force, axes, amplitude: amplitude() };
                let acting = Acting::new(table.to_owned(), load, at(), in_space(axes));
                forces.push(Acting { amplitude: amplitude(), ..acting });
            }
            if couple[2] != 0.0 {
                let load = acting::Couple { station: s, couple: couple[2], amplitude: amplitude() };
                couples.push(Acting::new(table.to_owned(), load, at(), None));
            }
        }
        Acts::Along { range, force, distribution, .. } => {
            let force = in_plane(*force, "force-per-length")?;
            let distribution = distribution.clone();
            let load =
                acting::DistributedForce { force, axes, distribution, range: *range, amplitude: amplitude() };
            let at = [load.stations(), vec![range.0, range.1]];
            let acting = Acting::new(table.to_owned(), load, at, in_space(axes));
            lines.push(Acting { amplitude: amplitude(), ..acting });
        }
        Acts::By { range, law, .. } => {
            let fixed_in_space = (!law.is_isotropic()).then_some("force laws");
            let load = acting::LineLaw { law: Arc::clone(law), range: *range };
            let at = || vec![range.0, range.1];
            lines.push(Acting::new(table.to_owned(), load, [at(), at()], fixed_in_space));
        }
    }
    Ok(())
}

fn spring(spring: &Spring, table: &str) -> Made<Acting> {
    let Joins::Point { on: (_, station), to } = spring.joins else {
        return Err(Fault::new("kind", "a beam on a hub has springs of the kind `point` only").into());
    };
    let (stiffness, damping, anchor) = (spring.stiffness, spring.damping, in_plane(to, "to")?);
    let load = acting::Spring { station, stiffness, damping, anchor };
    let at = [vec![station], vec![station]];
    Ok(Acting::new(table.to_owned(), load, at, Some("springs to the ground")))
}

/// Whether the tip of a beam can do without mass where a contact wants it so; `why_not` says what gives it mass.
fn fits_massless(contacts: &[OnBeam], why_not: Option<&str>) -> Made<()> {
    match (contacts.iter().position(|of| of.contact.massless), why_not) {
        (Some(i), Some(why)) => {
            let message =
                format!("a contact without a law of its own takes the mass from the tip, but {why}");
            let help = "give it a law: `law = { kind = \"constraint\", restitution = 0.5 }`";
            Err(Fault::new(format!("contact[{}].law", i + 1), message).help(help).into())
        }
        _ => Ok(()),
    }
}

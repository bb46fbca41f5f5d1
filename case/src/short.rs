//! A beam on a hub as a system in space: the short spelling of a case turned into the long one.
//!
//! | short | long |
//! |---|---|
//! | `[beam]`, `[section]`, `basis.elements`, `[damping]` | the beam `beam`, which begins at the radius of the hub, with the height of its section along the motion, and against it for a deck, whose height points to the trailing edge |
//! | `[hub]` | the revolute joint `hub` about z, between the ground and the root |
//! | `hub.inertia` J | the body `hub-body` on the axis, to which the root is fixed; its mass J/L² moves nothing |
//! | `output.stations`, `.strain-heights` | stations in the axes of the root, and fibres |
//! | everything else | itself |
//!
//! The tree of the short spelling is turned, so that each value keeps the place where it was written. What space does not carry is
//! refused at its key.

use super::fault::{Fault, Faults, Found, Made};
use super::kind::{Context, Keys};
use super::kinds::basis::FiniteElements;
use super::kinds::contact::{self, CONTACT};
use super::kinds::coupling::{SPACE, SPACE_WITH_SHEAR};
use super::kinds::cross_section::{Assumed, Section};
use super::kinds::damping::DAMPING;
use super::kinds::load::{self, LOAD};
use super::kinds::obstacle::Stop;
use super::laws::Signals;
use super::layout::{
    self, BASIS, INITIAL, MODEL_ON_HUB, ModelOnHub, OUTPUT, OneBeam, RUN, Recorded, SECTION,
};
use super::length::length;
use super::problem::Place;
use super::sources::Files;
use super::tree::{Line, Node, Raw};
use super::values::{Values, item, join};
use flexion::hub_beam::Drive;
use flexion::linalg::Vec3;
use flexion::profile::HubKinematics;
use std::cell::RefCell;

/// Name of the beam.
const BEAM: &str = "beam";
/// Name of the joint.
const HUB: &str = "hub";
/// Name of the body.
const BODY: &str = "hub-body";
/// Name of the joint between body and root.
const CLAMP: &str = "clamp";
/// First moments over ρA √(EI/EA), or ES over √(EA EI), that are rounding.
const ROUNDING: f64 = 1e-12;

/// What to write instead of what space does not carry.
const PLANAR: &str = "take a planar model, `model.coupling = \"exact\"`";

/// A case in its long spelling.
pub(super) struct Long {
    /// Its tables.
    pub lines: Vec<Line>,
    /// What its keys are called in the short spelling: beginnings of dotted paths.
    pub renamed: Vec<[String; 2]>,
    /// What its reader should know.
    pub cautions: Vec<String>,
}

/// The coupling that a case of a beam on a hub asks for.
fn coupling(v: &Values) -> Option<&str> {
    MODEL_ON_HUB.values_in(v).and_then(|model| ModelOnHub::coupling.chosen_in(model))
}

/// Whether it asks for space.
pub(super) fn asks_for_space(v: &Values) -> bool {
    coupling(v).is_some_and(|name| [SPACE, SPACE_WITH_SHEAR].contains(&name))
}

/// The lines of a table that take the place of one that was written at a place.
struct Lines {
    place: Place,
    lines: Vec<Line>,
}

impl Lines {
    fn at(place: &Place) -> Lines {
        Lines { place: place.clone(), lines: Vec::new() }
    }

    fn raw(mut self, key: &str, value: Raw) -> Lines {
        let node = Node { place: self.place.clone(), value };
        self.lines.push(Line { key: key.to_owned(), place: self.place.clone(), node });
        self
    }

    fn text(self, key: &str, text: &str) -> Lines {
        self.raw(key, Raw::Text(text.to_owned()))
    }

    fn number(self, key: &str, x: f64) -> Lines {
        self.raw(key, Raw::Number(x))
    }

    fn texts<const N: usize>(self, key: &str, texts: [&str; N]) -> Lines {
        let node = |text: &str| Node { place: self.place.clone(), value: Raw::Text(text.to_owned()) };
        let list = texts.map(node).to_vec();
        self.raw(key, Raw::List(list))
    }

    fn vector(self, key: &str, x: [f64; 3]) -> Lines {
        let list = x.map(|x| Node { place: self.place.clone(), value: Raw::Number(x + 0.0) }).to_vec();
        self.raw(key, Raw::List(list))
    }

    /// A node that was written, under another key.
    fn node(mut self, key: &str, node: Option<&Node>) -> Lines {
        if let Some(node) = node {
            self.lines.push(Line { key: key.to_owned(), place: node.place.clone(), node: node.clone() });
        }
        self
    }

    fn table(self) -> Node {
        Node { place: self.place, value: Raw::Table(self.lines) }
    }
}

/// The node at a dotted path.
fn written<'n>(lines: &'n [Line], path: &str) -> Option<&'n Node> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let node = &lines.iter().find(|line| line.key == first)?.node;
    match (rest, &node.value) {
        (None, _) => Some(node),
        (Some(rest), Raw::Table(lines)) => written(lines, rest),
        _ => None,
    }
}

/// The tables of a list that were written, and how many.
fn tables(lines: &[Line], key: &str) -> Vec<Node> {
    match written(lines, key).map(|node| &node.value) {
        Some(Raw::List(nodes)) => nodes.clone(),
        _ => Vec::new(),
    }
}

/// How the hub moves at the start.
struct Start {
    angle: f64,
    /// Of a hub that is free; a prescribed speed is that of its joint.
    speed: f64,
    /// Whether it stays at the angle 0.
    rests: bool,
    /// Whether it sets off with an acceleration.
    sets_off: bool,
}

/// The start of a hub with this motion, which may be of a constant speed.
fn start(motion: Option<&Drive>, is_constant: bool) -> Start {
    match motion {
        None => Start { angle: 0.0, speed: 0.0, rests: true, sets_off: false },
        Some(Drive::Prescribed(motion)) => {
            let HubKinematics { angle, speed, acceleration } = motion.at(0.0);
            Start { angle, speed: 0.0, rests: is_constant && speed == 0.0, sets_off: acceleration != 0.0 }
        }
        Some(Drive::Free(hub)) => Start { angle: hub.angle, speed: hub.speed, rests: false, sets_off: false },
    }
}

/// The long spelling of a case whose short one is `lines`, with the values `v`.
///
/// # Errors
/// Faults at the keys of what space does not carry.
pub(super) fn long(lines: &[Line], v: &Values, files: &Files<'_>) -> Made<Long> {
    let mut found = Found::default();
    let cautions = RefCell::default();
    let signals = &Signals::default();
    let c = &Context { length: None, duration: None, parts: None, files, cautions: &cautions, signals };
    let OneBeam { pitch, precone, .. } = layout::BEAM.read(v, c)?;
    let duration = RUN.read(v, c)?.duration.unwrap_or(0.0);
    let length = found.part(length(v, c));
    let c = &Context { length, duration: Some(duration), ..*c };
    let section = found.part(SECTION.read(v, c));
    let hub = found.part(layout::HUB.read(v, c));
    let constant =
        layout::HUB.values_in(v).and_then(|hub| layout::Hub::motion.chosen_in(hub)) == Some("constant");
    let start = hub.as_ref().map(|hub| start(hub.motion.as_ref(), constant));
    let output = found.part(OUTPUT.read(v, c));
    if let Some(section) = &section {
        found.part(centred(section));
        found.part(turned(section, lines, output.as_ref()));
    }
    if let Some(start) = &start {
        found.part(turning(v, start, c));
        found.check(
            start.sets_off && matches!(INITIAL.chosen_in(v), Some("static" | "steady-rotation")),
            "initial.kind",
            || {
                "the hub sets off with an acceleration, which the equilibrium of a system in space leaves out"
                    .to_owned()
            },
        );
    }
    if let Some(output) = &output {
        found.part(carried(v, output));
    }
    found.part(apart(lines));
    let (Some(length), Some(section), Some(start), Some(hub), Some(output)) =
        (length, section, start, hub, output)
    else {
        return Err(found.0);
    };
    if !found.0.0.is_empty() {
        return Err(found.0);
    }
    let layout::Hub { radius, inertia, .. } = hub;
    let place = |key: &str| v.find(key).0.unwrap_or_default();
    let axes = axes(start.angle, precone.unwrap_or(0.0), pitch.unwrap_or(0.0));
    // A deck's height points to its trailing edge.
    let height = if section.deck.is_some() { -1.0 * axes[1] } else { axes[1] };
    let root_place = radius * axes[0];
    let kept =
        ["title", "gravity", "spring", "mass", "load", "contact", "rotation", "initial", "integrator", "run"];
    let kept = |line: &&Line| kept.contains(&line.key.as_str());
    let mut kept: Vec<Line> = lines.iter().filter(kept).cloned().collect();
    kept.iter_mut().filter(|line| line.key == "contact").for_each(orient);
    if start.rests {
        kept.iter_mut().for_each(|line| fix(line, v, c));
    }
    let mut long = Lines { place: Place::default(), lines: kept };

    let mut bodies = tables(lines, "body");
    let mut joints = tables(lines, "joint");
    let renamed = vec![
        ["beam[1].section".to_owned(), "section".to_owned()],
        ["beam[1].elements".to_owned(), "basis.elements".to_owned()],
        ["beam[1].damping".to_owned(), "damping".to_owned()],
        ["beam[1]".to_owned(), "beam".to_owned()],
        [item("body", bodies.len()), "hub".to_owned()],
        [format!("{}.motion", item("joint", joints.len())), "hub.motion".to_owned()],
        [item("joint", joints.len()), "hub".to_owned()],
        [item("joint", joints.len() + 1), "hub".to_owned()],
    ];

    let silent = is_silent(&section);
    let basis = BASIS.values_in(v).ok_or_else(Faults::default)?;
    let FiniteElements { elements, refine: parts, .. } = FiniteElements::read(basis, c)?;
    let mut beam = Lines::at(&place("beam"))
        .text("name", BEAM)
        .node("length", written(lines, "beam.length"))
        .vector("start", root_place.0)
        .vector("direction", axes[0].0)
        .vector("up", height.0)
        .node("section", written(lines, "section"))
        .raw("elements", Raw::Integer(elements as i64))
        .raw("planar", Raw::Boolean(silent))
        .node("damping", written(lines, "damping"));
    let turned = [OneBeam::length.key.name, OneBeam::pitch.key.name, OneBeam::precone.key.name];
    for key in OneBeam::KEYS.iter().filter(|key| !turned.contains(&key.name)) {
        beam = beam.node(key.name, written(lines, &join("beam", key.name)));
    }
    let spin = [0.0, 0.0, start.speed];
    if start.speed != 0.0 {
        beam = beam.vector("velocity", Vec3(spin).cross(root_place).0).vector("spin", spin);
    }

    let at_hub = place("hub");
    let root = format!("{BEAM}.root");
    let carrier = if inertia > 0.0 { BODY } else { root.as_str() };
    let joint = Lines::at(&at_hub)
        .text("name", HUB)
        .text("kind", "revolute")
        .texts("between", ["ground", carrier])
        .vector("at", [0.0; 3]);
    joints.push(
        match written(lines, "hub.motion") {
            Some(motion) => joint.node("motion", Some(&without(motion, "speed", start.speed != 0.0))),
            None => joint.node(
                "motion",
                Some(&Lines::at(&at_hub).text("kind", "constant").number("speed", 0.0).table()),
            ),
        }
        .table(),
    );
    if inertia > 0.0 {
        let moments = Lines::at(&at_hub).text("kind", "principal").vector("moments", [inertia; 3]).table();
        let mut body = Lines::at(&at_hub)
            .text("name", BODY)
            .number("mass", inertia / (length * length))
            .node("inertia", Some(&moments));
        if start.speed != 0.0 {
            body = body.vector("spin", spin);
        }
        bodies.push(body.table());
        let clamp = Lines::at(&at_hub)
            .text("name", CLAMP)
            .text("kind", "fixed")
            .texts("between", [BODY, &root])
            .table();
        joints.push(clamp);
    }

    let refine = MODEL_ON_HUB.read(v, c)?.refine.unwrap_or(1);
    let model = Lines::at(&place("model"))
        .text("coupling", coupling(v).unwrap_or(SPACE))
        .node("drop-redundant-rows", written(lines, "model.drop-redundant-rows"))
        .raw("refine", Raw::Integer(refine.saturating_mul(parts) as i64));
    let fibres = fibres(lines, v, &output);
    let mut output = Lines::at(&place("output")).raw("root-axes", Raw::Boolean(true));
    for key in ["step", "stations", "energy-balance", "plots", "vtk", "vtk-step"] {
        output = output.node(key, written(lines, &format!("output.{key}")));
    }
    let list = |nodes: Vec<Node>| Raw::List(nodes);
    long = long.raw("beam", list(vec![beam.table()])).raw("joint", list(joints));
    if !bodies.is_empty() {
        long = long.raw("body", list(bodies));
    }
    if !fibres.is_empty() {
        long = long.raw("fibre", list(fibres));
    }
    let long = long.node("model", Some(&model.table())).node("output", Some(&output.table()));
    let on_hub = CONTACT.tables_in(v).iter().any(|(_, contact)| is_on_hub(contact));
    let caution = "an obstacle of the hub, which is at rest, stands on the ground in space: `hub.torque` is without what pushes against it";
    let cautions = on_hub.then(|| caution.to_owned()).into_iter().collect();
    Ok(Long { lines: long.lines, renamed, cautions })
}

/// Writes the directions of obstacles that are left out, which are those of the plane of motion.
fn orient(contacts: &mut Line) {
    let Raw::List(tables) = &mut contacts.node.value else { return };
    for table in tables {
        let Raw::Table(lines) = &mut table.value else { continue };
        let Some(Line { place, node: Node { value: Raw::Table(lines), .. }, .. }) =
            lines.iter_mut().find(|line| line.key == "obstacle")
        else {
            continue;
        };
        // An empty list is left out too.
        let empty = |line: &Line| matches!(&line.node.value, Raw::List(list) if list.is_empty());
        lines.retain(|line| !(matches!(line.key.as_str(), "normal" | "axis") && empty(line)));
        let has = |key: &str| lines.iter().any(|line| line.key == key);
        let of = |kind: &str| {
            written(lines, "kind").is_some_and(|node| matches!(&node.value, Raw::Text(text) if text == kind))
        };
        let direction = Lines::at(place);
        if of("plane") && !has("normal") && !has("angle") {
            lines.extend(direction.vector("normal", [0.0, 1.0, 0.0]).lines);
        } else if of("cylinder") && !has("axis") {
            lines.extend(direction.vector("axis", [0.0, 0.0, 1.0]).lines);
        }
    }
}

/// Fixes to the ground what loads and contacts fix to a hub at rest: its axes are those of the ground.
fn fix(line: &mut Line, v: &Values, c: &Context<'_>) {
    let Raw::List(tables) = &mut line.node.value else { return };
    for (i, table) in tables.iter_mut().enumerate() {
        let Raw::Table(lines) = &mut table.value else { continue };
        let obstacle = v.inner(&item(&line.key, i)).and_then(|v| contact::Written::obstacle.values_in(v));
        let offset = obstacle.and_then(|obstacle| Stop::offset.read(obstacle, c).ok());
        for Line { key, node, .. } in lines {
            match (key.as_str(), &mut node.value, offset) {
                ("axes", Raw::Text(axes), _) if axes == HUB => *axes = "dead".to_owned(),
                ("mount", Raw::Text(mount), _) if mount == HUB => *mount = "ground".to_owned(),
                ("obstacle", Raw::Table(_), Some(offset)) => *node = plane(&node.place, offset),
                _ => {}
            }
        }
    }
}

/// The plane that a stop at a height over the axis is.
fn plane(place: &Place, offset: f64) -> Node {
    let plane = Lines::at(place).text("kind", "plane").vector("point", [0.0, offset, 0.0]);
    plane.vector("normal", [0.0, -offset.signum(), 0.0]).table()
}

/// A table less one of its keys.
fn without(node: &Node, key: &str, drop: bool) -> Node {
    let mut node = node.clone();
    if let (true, Raw::Table(lines)) = (drop, &mut node.value) {
        lines.retain(|line| line.key != key);
    }
    node
}

/// Direction of a beam whose hub has turned by `angle`, and of the height of its root section \[rad\].
fn axes(angle: f64, precone: f64, pitch: f64) -> [Vec3; 2] {
    let ((sin, cos), (out, along)) = (libm::sincos(angle), libm::sincos(precone));
    let tangent = Vec3([along * cos, along * sin, out]);
    let ahead = Vec3([-sin, cos, 0.0]);
    let (sin, cos) = libm::sincos(pitch);
    [tangent, cos * ahead + sin * tangent.cross(ahead)]
}

/// Whether a section says nothing of bending across and of torsion.
fn is_silent(section: &Section) -> bool {
    if section.is_blade {
        return false;
    }
    let assumed = Assumed { poisson_ratio: 0.0, shear_factor: None };
    section.blade(assumed).is_ok_and(|blade| !(blade.resultants(0.0).torsional_stiffness > 0.0))
}

/// Whether centre of mass and tension centre are on the axis, which is that of the centres of mass in space.
fn centred(section: &Section) -> Made<()> {
    let r = section.planar.resultants(0.0);
    let radius = (r.bending_stiffness / r.axial_stiffness).sqrt();
    let offset = [
        r.first_moment.abs() > ROUNDING * r.mass * radius,
        r.coupling_stiffness.abs() > ROUNDING * r.axial_stiffness * radius,
    ];
    if offset == [false; 2] {
        return Ok(());
    }
    let message = "has its centre of mass or its tension centre off the axis, and in space the axis goes through the centres of mass";
    Err(Fault::new("section", message).help(PLANAR).into())
}

/// Refuses what is given along the height of a deck, which in the plane points ahead and in space to the trailing edge.
fn turned(section: &Section, lines: &[Line], output: Option<&Recorded>) -> Made<()> {
    let mut faults = Faults::default();
    if section.deck.is_none() {
        return Ok(());
    }
    let follows = |node: &Node| match &node.value {
        Raw::Table(lines) => {
            matches!(written(lines, "axes"), Some(Node { value: Raw::Text(axes), .. }) if axes == "follower")
        }
        _ => false,
    };
    let mut refuse = |key: String| {
        let message = "is along the height of a deck, which points ahead in the plane and to the trailing edge in space";
        let help = "write the beam as one of [[beam]], whose section has the axes of the deck";
        faults.0.push(Fault::new(key, message).help(help));
    };
    let loads = tables(lines, "load");
    loads
        .iter()
        .enumerate()
        .filter(|(_, load)| follows(load))
        .for_each(|(i, _)| refuse(join(&item("load", i), "axes")));
    if output.is_some_and(|output| !output.strain_heights.is_empty()) {
        refuse("output.strain-heights".to_owned());
    }
    if faults.0.is_empty() { Ok(()) } else { Err(faults) }
}

/// Whether the hub carries the obstacle of a contact.
fn is_on_hub(contact: &Values) -> bool {
    contact::Written::mount.chosen_in(contact) == Some(HUB)
        || contact::Written::obstacle.chosen_in(contact) == Some("stop")
}

/// What turns with the hub is carried by a hub that stays at the angle 0 alone.
fn turning(v: &Values, start: &Start, c: &Context<'_>) -> Made<()> {
    if start.rests {
        return Ok(());
    }
    let mut faults = Faults::default();
    let mut refuse = |key: String, message: &str| faults.0.push(Fault::new(key, message).help(PLANAR));
    if DAMPING.make(v, c)?.iter().any(|damping| damping.mass > 0.0) {
        let message =
            "acts on velocities relative to the hub, which turns, and in space on those against the ground";
        refuse("damping.mass".to_owned(), message);
    }
    for (table, load) in LOAD.tables_in(v) {
        if load::Written::axes.chosen_in(load) == Some(HUB) {
            refuse(
                format!("{table}.axes"),
                "turns with the hub, and loads in space are `dead` or follow their section",
            );
        }
    }
    for (table, contact) in CONTACT.tables_in(v) {
        if is_on_hub(contact) {
            let mount = contact::Written::mount.chosen_in(contact);
            let key = if mount.is_some() { "mount" } else { "obstacle" };
            refuse(
                format!("{table}.{key}"),
                "turns with the hub, and obstacles in space are fixed to the ground or to a body, or moved",
            );
        }
    }
    if faults.0.is_empty() { Ok(()) } else { Err(faults) }
}

/// Refuses parts with the names of the beam, of its hub and of what it is fixed to.
fn apart(lines: &[Line]) -> Made<()> {
    let mut faults = Faults::default();
    for key in ["body", "joint", "mass", "spring", "load"] {
        for (i, table) in tables(lines, key).iter().enumerate() {
            let Raw::Table(lines) = &table.value else { continue };
            let Some(Node { value: Raw::Text(name), .. }) = written(lines, "name") else { continue };
            if [BEAM, HUB, BODY, CLAMP].contains(&name.as_str()) {
                let message = format!("`{name}` is a name that [beam] and [hub] give to a part of theirs");
                let fault = Fault::new(join(&item(key, i), "name"), message);
                faults.0.push(fault.help(format!("write another, for example `{name}-1`")));
            }
        }
    }
    if faults.0.is_empty() { Ok(()) } else { Err(faults) }
}

/// Refuses what belongs to the plane alone.
fn carried(v: &Values, output: &Recorded) -> Made<()> {
    let mut faults = Faults::default();
    let mut refuse =
        |key: &str, message: String, help: &str| faults.0.push(Fault::new(key, message).help(help));
    if let Some(kind) = BASIS.chosen_in(v).filter(|kind| *kind != "finite-elements") {
        let message =
            format!("`{kind}` is a basis of the planar models, and beams in space are of finite elements");
        refuse("basis", message, "write `kind = \"finite-elements\"` and the number of elements");
    }
    if output.modal_shares {
        refuse("output.modal-shares", "is of the basis `modes` of the planar models".to_owned(), PLANAR);
    }
    if output.section_forces {
        let message = "is of the planar models: in space axial force, torque and bending moments are recorded at every station, and the \
                       shear force is not";
        refuse("output.section-forces", message.to_owned(), "leave it out");
    }
    if faults.0.is_empty() { Ok(()) } else { Err(faults) }
}

/// The fibres that were written, and those at the stations and the tip at each height of `output.strain-heights`.
fn fibres(lines: &[Line], v: &Values, output: &Recorded) -> Vec<Node> {
    let mut all = tables(lines, "fibre");
    let place = v.find("output.strain-heights").0.unwrap_or_default();
    let mut stations = output.stations.clone();
    if !stations.iter().any(|station| station == "tip") {
        stations.push("tip".to_owned());
    }
    for (i, station) in stations.iter().enumerate() {
        for (k, height) in output.strain_heights.iter().enumerate() {
            let fibre = Lines::at(&place)
                .text("name", &format!("fibre{}-{}", i + 1, k + 1))
                .text("on", station)
                .number("y", *height);
            all.push(fibre.table());
        }
    }
    all
}

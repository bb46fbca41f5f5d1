//! Systems in space, drawn at random: trees of bodies and beams on joints of every kind, with springs, loads and contacts.

use super::random::Random;
use super::{Drawn, add};

/// The case of a seed, with contacts or without.
pub(super) fn case(random: &mut Random, touching: bool) -> Drawn {
    let subject = if touching { "space with contacts" } else { "space" };
    let mut drawn = Drawn { subject, length: 1.0, ..Drawn::default() };
    let duration = random.between(0.04..0.2);
    let integrator = match random.count(0..3) {
        0 => format!("{{ kind = \"generalized-alpha\", step = {} }}", duration / 400.0),
        _ => format!("{{ kind = \"radau\", tolerance = {:e} }}", random.scale(1e-7..1e-4)),
    };
    add!(
        drawn,
        "gravity = [0, 1, -9.81]\nintegrator = {integrator}\nrun = {{ duration = {duration} }}\noutput = {{ step = {} }}",
        duration / 50.0
    );
    let mut last = End { part: "ground".to_owned(), at: [0.0; 3], centre: [0.0; 3] };
    let mut ends = vec![last.clone()];
    for k in 0..random.count(1..4) {
        let from = ends[random.count(0..ends.len())].clone();
        last = part(random, &mut drawn, k, &from);
        ends.push(last.clone());
    }
    let End { part: last, at, centre } = last;
    if random.coin() {
        let axes = random.pick(&["dead", "follower"]);
        let force = random.vector(3.0);
        add!(drawn, "[[load]]\non = \"{last}\"\nforce = {force:?}\naxes = \"{axes}\"");
    }
    if random.coin() {
        let far = [at[0] + 0.5, at[1] - 0.4, at[2] + 0.7];
        add!(
            drawn,
            "[[spring]]\nkind = \"line\"\nbetween = [\"ground\", \"{last}\"]\nfrom = {far:?}\nstiffness = 20\ndamping = 1"
        );
    }
    if touching {
        let law = match random.count(0..3) {
            0 => "{ kind = \"hertz\", stiffness = 1e5 }".to_owned(),
            1 => format!(
                "{{ kind = \"hunt-crossley\", stiffness = 1e5, restitution = {} }}",
                random.between(0.2..0.9)
            ),
            _ => format!("{{ kind = \"constraint\", restitution = {} }}", random.between(0.0..1.0)),
        };
        // A floor below the centre of mass of what is last, or the tip.
        let low = centre[2].min(at[2]) - random.between(0.005..0.1);
        add!(
            drawn,
            "[[contact]]\non = \"{last}\"\nobstacle = {{ kind = \"plane\", normal = [0, 0, 1], point = [0, 0, {low}] }}\nlaw = {law}"
        );
    }
    drawn
}

/// The end of a part.
#[derive(Clone)]
struct End {
    part: String,
    at: [f64; 3],
    /// Its centre of mass.
    centre: [f64; 3],
}

/// A body or a beam and its joint to a part before it.
fn part(random: &mut Random, drawn: &mut Drawn, k: usize, from: &End) -> End {
    let End { part: from, at, .. } = from;
    let way = random.vector(1.0);
    let size = way.iter().map(|x| x * x).sum::<f64>().sqrt();
    let length = size.max(0.3);
    let flexible = random.one_in(3);
    let to = if flexible { format!("beam{k}.root") } else { format!("body{k}") };
    let end = if flexible {
        let up = random.vector(1.0);
        let (elements, width, height) =
            (random.count(1..4), random.between(0.01..0.03), random.between(0.004..0.02));
        let section = match random.count(0..3) {
            0 => {
                format!("{{ kind = \"circle\", modulus = 7e10, density = 2700, radius = {} }}", 0.5 * height)
            }
            1 => format!(
                "{{ kind = \"ellipse\", modulus = 7e10, density = 2700, semi-width = {width}, semi-height = {height} }}"
            ),
            _ => format!(
                "{{ kind = \"rectangle\", modulus = 7e10, density = 2700, width = {width}, height = {height} }}"
            ),
        };
        add!(
            drawn,
            "[[beam]]\nname = \"beam{k}\"\nlength = {length}\nstart = {at:?}\ndirection = {way:?}\nup = {up:?}\n\
             elements = {elements}\nshear = {}\nsection = {section}",
            (elements + k).is_multiple_of(2)
        );
        let tip = [0, 1, 2].map(|i| at[i] + way[i] / size * length);
        End { part: format!("beam{k}.tip"), at: tip, centre: tip }
    } else {
        let centre = [0, 1, 2].map(|i| at[i] + 0.5 * way[i]);
        let inertia = match random.count(0..3) {
            0 => format!("{{ kind = \"box\", size = [{length}, 0.1, 0.2] }}"),
            1 => format!("{{ kind = \"cylinder\", radius = 0.1, length = {length} }}"),
            _ => "{ kind = \"sphere\", radius = 0.2 }".to_owned(),
        };
        let (mass, damping) = (random.between(0.2..3.0), [0.0, 0.5][random.count(0..2)]);
        add!(
            drawn,
            "[[body]]\nname = \"body{k}\"\nmass = {mass}\nposition = {centre:?}\naxis = {way:?}\ninertia = {inertia}\n\
             damping = {{ mass = {damping} }}"
        );
        End { part: format!("body{k}"), at: [0, 1, 2].map(|i| at[i] + way[i]), centre }
    };
    let kinds = ["revolute", "spherical", "universal", "cylindrical", "fixed", "prismatic", "planar"];
    let kind = random.pick(&kinds[..if flexible { 5 } else { kinds.len() }]);
    let (axis, across) = (random.vector(1.0), random.vector(1.0));
    add!(
        drawn,
        "[[joint]]\nname = \"joint{k}\"\nkind = \"{kind}\"\nbetween = [\"{from}\", \"{to}\"]\nat = {at:?}\naxis = {axis:?}\nacross = {across:?}"
    );
    match (kind, random.count(0..3)) {
        ("revolute", 0) => {
            add!(
                drawn,
                "motion = {{ kind = \"expression\", of = \"angle\", formula = \"0.5*(1-cos(3*t))\" }}"
            );
        }
        ("revolute", 1) => add!(drawn, "motion = {{ kind = \"free\", stiffness = 5, damping = 0.1 }}"),
        ("prismatic", 0) => add!(drawn, "travel = {{ kind = \"free\", stiffness = 100 }}"),
        _ => {}
    }
    end
}

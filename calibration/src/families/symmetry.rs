//! Cases that say the same in two ways: two equal things, one thing in two halves, another order, a mirror, other units.

use super::times::method;
use super::{Answer, Posed, Relation};
use crate::random::Random;
use crate::{Drawn, add, space};

fn other(case: Drawn, other: Drawn, relation: Relation) -> Posed {
    Posed { case, answer: Answer::Other(Box::new(other), relation) }
}

/// Two pendulums of two bodies each, at the same place.
pub(super) fn two_equal_bodies(random: &mut Random) -> Posed {
    let (duration, mass, stiffness) =
        (random.between(0.2..2.0), random.scale(0.1..10.0), random.scale(1.0..100.0));
    let (inner, outer) = (random.vector(1.0), random.vector(1.0));
    let (axis, spring) = (random.vector(1.0), random.coin());
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(
        case,
        "gravity = [0, 1, -9.81]\nintegrator = {}\nrun = {{ duration = {duration} }}",
        method(random, 1e-3)
    );
    let mut tables = Vec::new();
    for name in ["one", "two"] {
        tables.push(format!("[[body]]\nname = '{name}'\nmass = {mass}\nposition = {inner:?}\ninertia = {{ kind = 'sphere', radius = 0.3 }}\n"));
        let further = [0, 1, 2].map(|i| inner[i] + outer[i]);
        tables.push(format!("[[body]]\nname = '{name}-b'\nmass = 1\nposition = {further:?}\ninertia = {{ kind = 'sphere', radius = 0.2 }}\n"));
        tables.push(format!("[[joint]]\nname = '{name}-j'\nkind = 'revolute'\nbetween = ['ground', '{name}']\nat = [0, 0, 0]\naxis = {axis:?}\n"));
        tables.push(format!("[[joint]]\nname = '{name}-k'\nkind = 'spherical'\nbetween = ['{name}', '{name}-b']\nat = {inner:?}\n"));
        if spring {
            tables.push(format!(
                "[[spring]]\nname = '{name}-s'\nkind = 'line'\nbetween = ['ground', '{name}-b']\nfrom = [2, 0, 0]\nstiffness = {stiffness}\n"
            ));
        }
    }
    shuffle(random, &mut tables);
    case.text += &tables.concat();
    Posed { case, answer: Answer::Pairs("one", "two") }
}

/// Two cantilevers at the same place, under equal loads.
pub(super) fn two_equal_beams(random: &mut Random) -> Posed {
    let (duration, force, way) = (random.between(0.02..0.2), random.vector(5.0), random.vector(1.0));
    let up = random.vector(1.0);
    let mut case = Drawn { length: 1.0, ..Drawn::default() };
    add!(
        case,
        "gravity = [0, 0, -9.81]\nintegrator = {}\nrun = {{ duration = {duration} }}",
        method(random, 5e-4)
    );
    let elements = random.count(1..4);
    let mut tables = Vec::new();
    for name in ["one", "two"] {
        tables.push(format!(
            "[[beam]]\nname = '{name}'\nlength = 1\ndirection = {way:?}\nup = {up:?}\nroot = 'clamped'\nelements = {elements}\n\
             section = {{ kind = 'rectangle', modulus = 7e10, density = 2700, width = 0.02, height = 0.01 }}\n"
        ));
        tables.push(format!("[[load]]\nname = '{name}-load'\non = '{name}.tip'\nforce = {force:?}\n"));
    }
    shuffle(random, &mut tables);
    case.text += &tables.concat();
    Posed { case, answer: Answer::Pairs("one", "two") }
}

/// Puts tables into another order.
fn shuffle(random: &mut Random, tables: &mut [String]) {
    for last in (1..tables.len()).rev() {
        tables.swap(last, random.count(0..last + 1));
    }
}

/// A beam in the plane with loads, a mass and a spring, each of the tables once or as two halves, in their order or another.
fn tables(random: &mut Random) -> (Drawn, Vec<(String, Vec<String>)>) {
    let (duration, size) = (random.between(0.05..0.5), random.scale(1.0..100.0));
    let coupling = random.pick(&["first", "high", "exact"]);
    let motion = random.pick(&[
        "{ kind = 'spin-up', speed = 2, time = 0.1 }",
        "{ kind = 'constant', speed = 0 }",
        "{ kind = 'free', torque = { kind = 'constant', torque = 3 } }",
    ]);
    let mut case = Drawn { length: 2.0, ..Drawn::default() };
    add!(
        case,
        "gravity = [0, -9.81]\nmodel = {{ coupling = '{coupling}' }}\nbasis = {{ kind = 'finite-elements', elements = 4 }}"
    );
    add!(
        case,
        "integrator = {{ kind = 'radau', tolerance = {:e} }}\nrun = {{ duration = {duration} }}",
        random.scale(1e-7..1e-4)
    );
    add!(case, "hub = {{ radius = 0.1, inertia = 2, motion = {motion} }}\nbeam = {{ length = 2 }}");
    add!(
        case,
        "section = {{ kind = 'rectangle', modulus = 7e10, density = 2700, width = 0.05, height = 0.04 }}"
    );
    let place = |random: &mut Random| {
        if random.coin() { "tip".to_owned() } else { format!("{} m", random.between(0.2..1.9)) }
    };
    let mut tables = Vec::new();
    for k in 0..2 {
        let on = place(random);
        let force = [0.1 * size, size * random.between(-1.0..1.0)];
        let axes = random.pick(&["dead", "hub", "follower"]);
        let of = |part: f64| {
            format!(
                "[[load]]\non = '{on}'\nforce = [{}, {}]\naxes = '{axes}'\n",
                part * force[0],
                part * force[1]
            )
        };
        tables.push((of(1.0), vec![of(0.5), of(0.5)]));
        let (on, mass) = (place(random), random.scale(0.1..5.0));
        let of = |part: f64| format!("[[mass]]\non = '{on}'\nmass = {}\n", part * mass);
        tables.push((of(1.0), vec![of(0.5), of(0.5)]));
        let (on, stiffness) = (place(random), random.scale(10.0..1e3));
        let of = |name: &str, part: f64| {
            format!(
                "[[spring]]\nname = '{name}{k}'\nkind = 'point'\non = '{on}'\nto = [3, 1]\nstiffness = {}\n",
                part * stiffness
            )
        };
        tables.push((of("whole", 1.0), vec![of("first", 0.5), of("second", 0.5)]));
    }
    (case, tables)
}

/// Loads, masses and springs of a beam as two halves each.
pub(super) fn halves(random: &mut Random) -> Posed {
    let (mut whole, tables) = tables(random);
    let mut halves = whole.clone();
    for (one, two) in tables {
        whole.text += &one;
        halves.text += &two.concat();
    }
    other(whole, halves, Relation::Equal)
}

/// Loads, masses and springs of a beam in another order.
pub(super) fn another_order(random: &mut Random) -> Posed {
    let (mut case, tables) = tables(random);
    let mut shuffled = case.clone();
    let mut tables: Vec<String> = tables.into_iter().map(|(one, _)| one).collect();
    case.text += &tables.concat();
    shuffle(random, &mut tables);
    shuffled.text += &tables.concat();
    other(case, shuffled, Relation::Equal)
}

/// The tables of a system in space in another order.
pub(super) fn another_order_in_space(random: &mut Random) -> Posed {
    let touching = random.one_in(3);
    let case = space::case(random, touching);
    let mut parts = case.text.split("\n[[");
    let head = parts.next().unwrap_or_default().to_owned();
    let mut tables: Vec<String> = parts.map(|part| format!("\n[[{part}")).collect();
    shuffle(random, &mut tables);
    let shuffled = Drawn { text: head + &tables.concat() + "\n", ..case.clone() };
    other(case, shuffled, Relation::Equal)
}

/// A ball that falls on a plane, once and twice declared.
pub(super) fn obstacle_twice(random: &mut Random) -> Posed {
    let (height, e) = (random.scale(0.05..1.0), random.between(0.2..1.0));
    let velocity = random.vector(1.0);
    let duration = 1.8 * (2.0 * height / 9.81_f64).sqrt();
    let integrator = method(random, duration / 500.0);
    let of = |names: &[&str]| {
        let mut drawn = Drawn { length: height, ..Drawn::default() };
        add!(drawn, "gravity = [0, 0, -9.81]\nintegrator = {integrator}\nrun = {{ duration = {duration} }}");
        add!(
            drawn,
            "[[body]]\nname = 'b'\nmass = 1\ninertia = {{ kind = 'sphere', radius = 0.1 }}\nposition = [0, 0, {height}]"
        );
        add!(drawn, "velocity = [{}, {}, 0]", velocity[0], velocity[1]);
        for name in names {
            add!(
                drawn,
                "[[contact]]\nname = '{name}'\non = 'b'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}"
            );
            add!(drawn, "law = {{ kind = 'constraint', restitution = {e} }}");
        }
        drawn
    };
    other(of(&["floor"]), of(&["once", "again"]), Relation::Equal)
}

/// A beam in the plane and its mirror image about the x axis.
pub(super) fn mirrored(random: &mut Random) -> Posed {
    let (duration, speed, size) =
        (random.between(0.05..0.5), random.between(0.2..3.0), random.scale(1.0..300.0));
    let (coupling, axes) =
        (random.pick(&["first", "high", "exact"]), random.pick(&["dead", "hub", "follower"]));
    let integrator = method(random, 5e-4);
    let force = [0.2 * size, size * random.between(-1.0..1.0)];
    let (couple, weight) = (size * random.between(-1.0..1.0), random.vector(9.81));
    let (motion, touching) = (random.count(0..3), random.one_in(3));
    let (angle, gap) = (random.between(-1.0..1.0), random.scale(1e-4..1e-2));
    let of = |s: f64| {
        let mut drawn = Drawn { length: 2.0, ..Drawn::default() };
        let motion = match motion {
            0 => format!("{{ kind = 'spin-up', speed = {}, time = {} }}", s * speed, 0.7 * duration),
            1 => format!(
                "{{ kind = 'free', angle = {}, torque = {{ kind = 'constant', torque = {} }} }}",
                s * angle,
                s * speed
            ),
            _ => format!("{{ kind = 'expression', of = 'speed', formula = '{}*sin(20*t)' }}", s * speed),
        };
        add!(drawn, "gravity = [{}, {}]\nmodel = {{ coupling = '{coupling}' }}", weight[0], s * weight[1]);
        add!(
            drawn,
            "basis = {{ kind = 'finite-elements', elements = 4 }}\nintegrator = {integrator}\nrun = {{ duration = {duration} }}"
        );
        add!(drawn, "hub = {{ radius = 0.1, inertia = 2, motion = {motion} }}\nbeam = {{ length = 2 }}");
        add!(
            drawn,
            "section = {{ kind = 'rectangle', modulus = 7e10, density = 2700, width = 0.05, height = 0.04 }}"
        );
        add!(drawn, "[[load]]\non = 'tip'\nforce = [{}, {}]\naxes = '{axes}'", force[0], s * force[1]);
        add!(drawn, "[[load]]\non = '1 m'\ncouple = {}", s * couple);
        if touching {
            add!(drawn, "[[contact]]\non = 'tip'\nobstacle = {{ kind = 'stop', offset = {} }}", s * gap);
            add!(drawn, "law = {{ kind = 'hunt-crossley', stiffness = 1e5, restitution = 0.5 }}");
        }
        drawn
    };
    other(of(1.0), of(-1.0), Relation::Mirrored)
}

/// Units of length, mass and time, powers of two, and what is made of them.
struct Units {
    length: f64,
    mass: f64,
    time: f64,
}

impl Units {
    fn drawn(random: &mut Random) -> Units {
        let mut power = |most: usize| 2_f64.powi(random.count(0..2 * most + 1) as i32 - most as i32);
        Units { length: power(8), mass: power(12), time: power(8) }
    }

    fn force(&self) -> f64 {
        self.mass * self.length / (self.time * self.time)
    }

    fn factors(&self) -> Relation {
        Relation::Scaled([self.length, self.mass, self.time])
    }
}

const ONE: Units = Units { length: 1.0, mass: 1.0, time: 1.0 };

/// A beam in the plane in units of another size.
pub(super) fn other_units(random: &mut Random) -> Posed {
    let (duration, speed, force) =
        (random.between(0.05..0.5), random.between(0.2..3.0), random.scale(1.0..100.0));
    let (coupling, free) = (random.pick(&["first", "high", "exact"]), random.coin());
    let tolerance = random.scale(1e-7..1e-4);
    let step = if random.coin() { Some(1e-3) } else { None };
    let stiff = [random.scale(1e6..1e8), random.scale(100.0..1e4)];
    let of = |u: &Units| {
        let mut drawn = Drawn { length: 2.0 * u.length, ..Drawn::default() };
        let torque = u.force() * u.length;
        let motion = if free {
            format!(
                "{{ kind = 'free', torque = {{ kind = 'constant', torque = {:e} }} }}",
                2.0 * speed * torque
            )
        } else {
            format!(
                "{{ kind = 'spin-up', speed = {:e}, time = {:e} }}",
                speed / u.time,
                0.7 * duration * u.time
            )
        };
        let integrator = match step {
            Some(step) => format!("{{ kind = 'generalized-alpha', step = {:e} }}", step * u.time),
            None => format!("{{ kind = 'radau', tolerance = {tolerance:e} }}"),
        };
        add!(
            drawn,
            "gravity = [0, {:e}]\nmodel = {{ coupling = '{coupling}' }}",
            -9.81 * u.length / (u.time * u.time)
        );
        add!(drawn, "basis = {{ kind = 'finite-elements', elements = 4 }}\nintegrator = {integrator}");
        add!(
            drawn,
            "run = {{ duration = {:e} }}\nbeam = {{ length = {:e} }}",
            duration * u.time,
            2.0 * u.length
        );
        add!(
            drawn,
            "hub = {{ radius = {:e}, inertia = {:e}, motion = {motion} }}",
            0.1 * u.length,
            2.0 * u.mass * u.length * u.length
        );
        let [axial, bending] = [stiff[0] * u.force(), stiff[1] * u.force() * u.length * u.length];
        add!(
            drawn,
            "section = {{ kind = 'resultants', mass-per-length = {:e}, axial-stiffness = {axial:e}, bending-stiffness = {bending:e} }}",
            u.mass / u.length
        );
        add!(drawn, "[[load]]\non = 'tip'\nforce = [{:e}, {:e}]", 0.1 * force * u.force(), force * u.force());
        drawn
    };
    let units = Units::drawn(random);
    other(of(&ONE), of(&units), units.factors())
}

/// A pendulum of a body and a beam in units of another size.
pub(super) fn other_units_in_space(random: &mut Random) -> Posed {
    let duration = random.between(0.05..0.3);
    let (axis, spin) = (random.vector(1.0), random.vector(3.0));
    let (flexible, tolerance) = (random.coin(), random.scale(1e-7..1e-4));
    let (stiff, height) = (random.scale(10.0..1e3), random.scale(0.05..0.5));
    let touching = random.one_in(3);
    let of = |u: &Units| {
        let mut drawn = Drawn { length: u.length, ..Drawn::default() };
        add!(
            drawn,
            "gravity = [0, 0, {:e}]\nintegrator = {{ kind = 'radau', tolerance = {tolerance:e} }}",
            -9.81 * u.length / (u.time * u.time)
        );
        add!(drawn, "run = {{ duration = {:e} }}", duration * u.time);
        add!(
            drawn,
            "[[body]]\nname = 'b'\nmass = {:e}\ninertia = {{ kind = 'box', size = [{:e}, {:e}, {:e}] }}",
            u.mass,
            u.length,
            0.5 * u.length,
            0.2 * u.length
        );
        add!(drawn, "position = [{:e}, 0, 0]", 0.5 * u.length);
        if flexible {
            add!(
                drawn,
                "[[joint]]\nname = 'j'\nkind = 'revolute'\nbetween = ['ground', 'b']\nat = [0, 0, 0]\naxis = {axis:?}"
            );
            let square = u.length * u.length;
            add!(
                drawn,
                "[[beam]]\nname = 'r'\nlength = {:e}\nstart = [{:e}, 0, 0]\nup = [0, 0, 1]\nelements = 2\npolar-inertia = {:e}",
                u.length,
                u.length,
                1e-3 * u.mass * u.length
            );
            add!(
                drawn,
                "section = {{ kind = 'general', mass-per-length = {:e}, axial-stiffness = {:e}, bending-stiffness = {:e}, bending-stiffness-across = {:e}, torsional-stiffness = {:e} }}",
                u.mass / u.length,
                1e6 * u.force(),
                stiff * u.force() * square,
                2.0 * stiff * u.force() * square,
                stiff * u.force() * square
            );
            add!(drawn, "[[joint]]\nname = 'k'\nkind = 'fixed'\nbetween = ['b', 'r.root']");
        } else {
            add!(drawn, "spin = [{:e}, {:e}, {:e}]", spin[0] / u.time, spin[1] / u.time, spin[2] / u.time);
            add!(
                drawn,
                "[[spring]]\nname = 's'\nkind = 'line'\nbetween = ['ground', 'b']\nfrom = [0, 0, {:e}]\nstiffness = {:e}",
                u.length,
                stiff * u.force() / u.length
            );
        }
        if touching && !flexible {
            add!(
                drawn,
                "[[contact]]\nname = 'k'\non = 'b'\nobstacle = {{ kind = 'plane', normal = [0, 0, 1], point = [0, 0, {:e}] }}",
                -height * u.length
            );
            add!(drawn, "law = {{ kind = 'constraint', restitution = 0.5 }}");
        }
        drawn
    };
    let units = Units::drawn(random);
    other(of(&ONE), of(&units), units.factors())
}

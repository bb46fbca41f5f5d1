//! Beams on a hub, drawn at random: sections, loads, masses, damping, hubs, couplings, bases, integrators, steps, contacts.
//!
//! Sizes follow from the beam: durations from the period of its first bending vibration, loads from what would bend it
//! by its length, speeds from its first natural frequency. What sets in at once excites axial vibrations too, and the
//! ratio of axial to bending frequencies is about 1.5 times the slenderness: suddenly loaded beams are less slender.

use super::random::Random;
use super::{Drawn, add};
use std::f64::consts::TAU;

/// Most slender beams, over their height: loaded smoothly and at once.
const SLENDER: f64 = 250.0;
const SLENDER_AND_SUDDEN: f64 = 40.0;
/// Rows of a table that is drawn.
const ROWS: usize = 9;

/// A uniform beam that is like the one drawn, and the time of the run.
#[derive(Clone, Copy)]
struct Beam {
    length: f64,
    height: f64,
    /// Mass per length.
    mass: f64,
    /// Bending stiffness.
    bending: f64,
    /// First natural frequency.
    frequency: f64,
    duration: f64,
    /// Whether loads may set in at once.
    sudden: bool,
    /// Whether the integrator is explicit, which stiff damping has no use for.
    explicit: bool,
    /// Whether it may touch something.
    touching: bool,
}

impl Beam {
    /// The force at the tip that would bend it by its length.
    fn force(&self) -> f64 {
        3.0 * self.bending / (self.length * self.length)
    }

    /// Its moment of inertia about the root.
    fn inertia(&self) -> f64 {
        self.mass * self.length.powi(3) / 3.0
    }
}

/// The case of a seed, with contacts or without.
pub(super) fn case(random: &mut Random, touching: bool) -> Drawn {
    let mut drawn =
        Drawn { subject: if touching { "beam with contacts" } else { "beam" }, ..Drawn::default() };
    let beam = Beam { touching, ..beam(random, &mut drawn) };
    drawn.length = beam.length;
    let spring = loads(random, &mut drawn, beam);
    hub(random, &mut drawn, beam, spring);
    model(random, &mut drawn, beam);
    integrator(random, &mut drawn, beam);
    if touching {
        contacts(random, &mut drawn, beam);
    }
    drawn
}

/// A beam with its section.
fn beam(random: &mut Random, drawn: &mut Drawn) -> Beam {
    let sudden = random.one_in(3);
    let explicit = random.one_in(6);
    let length = random.scale(0.3..20.0);
    let slender = if sudden || explicit { SLENDER_AND_SUDDEN } else { SLENDER };
    let height = length / random.scale(20.0..slender);
    let width = height * random.scale(0.5..5.0);
    let (modulus, density) =
        [(70e9, 2700.0), (210e9, 7850.0), (3e9, 1100.0), (40e9, 1900.0)][random.count(0..4)];
    add!(drawn, "[beam]\nlength = {length}\n[section]");
    let (area, second) = (width * height, width * height.powi(3) / 12.0);
    let (bending, mass) = (modulus * second, density * area);
    section(random, drawn, Material { modulus, density }, [length, width, height]);
    let frequency = 3.516 * (bending / (mass * length.powi(4))).sqrt();
    // Vibrations along the axis, and the waves of a mesh, are to be followed for a while, not for thousands of periods.
    let periods = match (explicit, sudden) {
        (true, _) => 0.05..0.2,
        (_, true) => 0.1..0.4,
        _ => 0.2..1.2,
    };
    let duration = TAU / frequency * random.between(periods);
    Beam { length, height, mass, bending, frequency, duration, sudden, explicit, touching: false }
}

struct Material {
    modulus: f64,
    density: f64,
}

/// A section of any kind, about as stiff and heavy as the rectangle of the same width and height.
fn section(random: &mut Random, drawn: &mut Drawn, material: Material, [length, width, height]: [f64; 3]) {
    let Material { modulus, density } = material;
    let (area, second) = (width * height, width * height.powi(3) / 12.0);
    let rotary = random.coin();
    let taper = random.between(0.4..1.0);
    let of = format!("modulus = {modulus}\ndensity = {density}");
    match random.count(0..16) {
        0 => add!(
            drawn,
            "kind = \"graded\"\nceramic-modulus = {}\nmetal-modulus = {modulus}\nceramic-density = {}\n\
             metal-density = {density}\nwidth = {width}\nheight = {height}\nexponent = {}\nfirst-moment = {}\n\
             rotary-inertia = {rotary}",
            modulus * random.between(1.0..2.5),
            density * random.between(0.6..1.4),
            random.between(0.0..6.0),
            // It needs the rotary inertia.
            random.coin() && rotary,
        ),
        1 => add!(
            drawn,
            "kind = \"tapered-rectangle\"\n{of}\nroot-width = {width}\nroot-height = {height}\ntip-width = {}\n\
             tip-height = {}\nrotary-inertia = {rotary}",
            width * random.between(0.4..1.0),
            height * taper,
        ),
        2 => add!(
            drawn,
            "kind = \"tube\"\n{of}\nouter-radius = {}\ninner-radius = {}\nrotary-inertia = {rotary}",
            0.5 * height,
            0.5 * height * random.between(0.3..0.9),
        ),
        3 => add!(
            drawn,
            "kind = \"piecewise\"\nends = [{}, {length}]\nmodulus = [{modulus}, {modulus}]\n\
             density = [{density}, {density}]\narea = [{area}, {}]\nsecond-moment = [{second}, {}]\nrotary-inertia = {rotary}",
            // Elements are cut there; functions of other bases are smooth across it.
            length * random.between(0.3..0.7),
            area * taper,
            second * taper.powi(3),
        ),
        4 => add!(
            drawn,
            "kind = \"resultants\"\nmass-per-length = {}\naxial-stiffness = {}\nbending-stiffness = {}",
            density * area,
            modulus * area,
            modulus * second,
        ),
        5 => add!(
            drawn,
            "kind = \"uniform\"\n{of}\narea = {area}\nsecond-moment = {second}\nrotary-inertia = {rotary}"
        ),
        6 => add!(drawn, "kind = \"circle\"\n{of}\nradius = {}\nrotary-inertia = {rotary}", 0.5 * height),
        7 => add!(
            drawn,
            "kind = \"ellipse\"\n{of}\nsemi-width = {}\nsemi-height = {}\nrotary-inertia = {rotary}",
            0.5 * width,
            0.5 * height
        ),
        8 => add!(
            drawn,
            "kind = \"general\"\nmass-per-length = {}\naxial-stiffness = {}\nbending-stiffness = {}\n\
             bending-stiffness-across = {}\ntorsional-stiffness = {}\nrotary-inertia = {}",
            density * area,
            modulus * area,
            modulus * second,
            modulus * second * 4.0,
            modulus * second,
            if rotary { density * second } else { 0.0 },
        ),
        9 => add!(
            drawn,
            "kind = \"tapered-circle\"\n{of}\nroot-radius = {}\ntip-radius = {}\nrotary-inertia = {rotary}",
            0.5 * height,
            0.5 * height * taper
        ),
        10 => {
            let (outer, hollow) = (0.5 * height, random.between(0.3..0.9));
            add!(
                drawn,
                "kind = \"tapered-tube\"\n{of}\nroot-outer-radius = {outer}\nroot-inner-radius = {}\n\
                 tip-outer-radius = {}\ntip-inner-radius = {}\nrotary-inertia = {rotary}",
                outer * hollow,
                outer * taper,
                outer * taper * hollow,
            );
        }
        11 | 12 => {
            let blade = random.coin();
            let mut file =
                if blade { "x,mass,EA,EI-flap,EI-chord,GJ\n" } else { "x,mass,EA,EI\n" }.to_owned();
            for row in 0..ROWS {
                let s = row as f64 / (ROWS - 1) as f64;
                let part = 1.0 - (1.0 - taper) * s * random.between(0.8..1.0);
                let (mass, axial) = (density * area * part, modulus * area * part);
                let bending = modulus * second * part.powi(3);
                file += &format!("{:e},{mass:e},{axial:e},{bending:e}", length * s);
                file += &if blade { format!(",{bending:e},{bending:e}\n") } else { "\n".to_owned() };
            }
            drawn.file("section.csv", file);
            let kind = if blade { "deck" } else { "table" };
            add!(drawn, "kind = \"{kind}\"\nfile = \"section.csv\"");
            if blade {
                add!(drawn, "format = \"csv\"");
            } else {
                add!(drawn, "interpolation = \"{}\"", random.pick(&["linear", "cubic"]));
            }
        }
        _ => add!(
            drawn,
            "kind = \"rectangle\"\n{of}\nwidth = {width}\nheight = {height}\nrotary-inertia = {rotary}"
        ),
    }
}

/// Loads that would bend the beam statically by up to a third of its length, masses and damping; and a spring, but for the
/// place of its other end.
fn loads(random: &mut Random, drawn: &mut Drawn, beam: Beam) -> Option<String> {
    let Beam { length, height, mass, duration, .. } = beam;
    let force = beam.force();
    let size = |random: &mut Random, reference: f64| reference * random.scale(1e-3..0.3);
    let place = |random: &mut Random| if random.coin() { length } else { length * random.between(0.3..1.0) };
    if beam.sudden && random.coin() {
        let acceleration = size(random, force / (mass * length)).min(9.81);
        let direction = random.between(-3.0..3.0);
        let [x, y] = [acceleration * direction.cos(), acceleration * direction.sin()];
        drawn.text.insert_str(0, &format!("gravity = [{x}, {y}]\n"));
    }
    let frame = random.pick(&["dead", "hub", "follower"]);
    let amplitude = amplitude(random, duration, beam.sudden);
    if random.coin() {
        let (along, across) = (0.3 * size(random, force), size(random, force));
        let station = place(random);
        add!(
            drawn,
            "[[load]]\non = \"{station} m\"\nforce = [{along}, {across}]\naxes = \"{frame}\"\namplitude = {amplitude}"
        );
    }
    if random.one_in(4) {
        let couple = size(random, force * length);
        let station = place(random);
        add!(drawn, "[[load]]\non = '{station} m'\ncouple = {couple}\namplitude = {amplitude}");
    }
    if random.one_in(6) {
        // Of a tip that goes a length in the duration.
        let speed = length / duration;
        let (kind, power) = if random.coin() { ("linear-drag", 1) } else { ("quadratic-drag", 2) };
        let coefficient = size(random, force / length) / speed.powi(power);
        add!(
            drawn,
            "[[load]]\non = \"beam\"\nlaw = {{ kind = \"{kind}\", coefficient = {coefficient} }}\nfrom = {}",
            length * random.between(0.0..0.5)
        );
    }
    if random.one_in(4) {
        let across = size(random, force / length);
        add!(
            drawn,
            "[[load]]\non = \"beam\"\nforce-per-length = [0, {across}]\naxes = \"{frame}\"\namplitude = {amplitude}"
        );
        match random.count(0..4) {
            0 => add!(
                drawn,
                "distribution = {{ kind = \"table\", stations = [0, {}, {length}], factors = [1, {}, {}] }}",
                length * random.between(0.2..0.8),
                random.between(0.0..1.0),
                random.between(-1.0..1.0),
            ),
            1 => add!(
                drawn,
                "distribution = {{ kind = \"expression\", formula = \"sin({}*x)^2\" }}",
                random.between(1.0..10.0) / length
            ),
            2 => add!(
                drawn,
                "from = {}\nto = {}",
                length * random.between(0.0..0.5),
                length * random.between(0.5..1.0)
            ),
            _ => {}
        }
    }
    if random.one_in(4) {
        let body = mass * length * random.scale(0.01..1.0);
        let station = place(random);
        let inertia = if random.coin() { body * height * height } else { 0.0 };
        add!(drawn, "[[mass]]\non = '{station} m'\nmass = {body}\ninertia = {inertia}");
    }
    let spring = random.one_in(10).then(|| {
        let stiffness = 3.0 * beam.bending / length.powi(3) * random.scale(0.01..1.0);
        let damping = [0.0, 0.1 * stiffness / beam.frequency][random.count(0..2)];
        format!("[[spring]]\nkind = 'point'\non = '{length} m'\nstiffness = {stiffness}\ndamping = {damping}")
    });
    if random.one_in(3) {
        let proportional = random.scale(0.01..3.0) / duration;
        add!(drawn, "[damping]\nmass = {proportional}");
        if random.coin() && !beam.explicit {
            add!(drawn, "stiffness = {}", random.scale(1e-4..0.05) / beam.frequency);
        }
    }
    spring
}

/// How a load changes: it sets in smoothly, or at once where that is wanted.
fn amplitude(random: &mut Random, duration: f64, sudden: bool) -> String {
    match random.count(0..if sudden { 7 } else { 4 }) {
        0 => format!(
            "{{ kind = \"expression\", formula = \"(1 - cos({}*t))/2\" }}",
            random.between(3.0..20.0) / duration
        ),
        // 10 s³ − 15 s⁴ + 6 s⁵ grows from 0 to 1 with two continuous derivatives.
        1 => {
            let time = duration * random.between(0.3..1.2);
            let grown = format!("(t/{time})^3*(10 - 15*t/{time} + 6*(t/{time})^2)");
            format!("{{ kind = \"expression\", formula = \"if(t < {time}, {grown}, 1)\" }}")
        }
        2 => format!(
            "{{ kind = \"expression\", formula = \"t*sin({0}*t)/{duration}\" }}",
            random.between(1.0..12.0) / duration
        ),
        3 => {
            let times: Vec<String> = (0..5).map(|k| format!("{:e}", duration * f64::from(k) / 4.0)).collect();
            let factors: Vec<String> =
                (0..5).map(|k| format!("{}", if k == 0 { 0.0 } else { random.between(-1.0..1.0) })).collect();
            format!(
                "{{ kind = \"table\", times = [{}], factors = [{}], interpolation = \"{}\" }}",
                times.join(", "),
                factors.join(", "),
                random.pick(&["linear", "monotone", "spline"])
            )
        }
        4 => format!("{{ kind = \"ramp\", time = {} }}", duration * random.between(0.1..0.8)),
        // A blow.
        5 => format!(
            "{{ kind = \"expression\", formula = \"exp(-((t - {})/{})^2)\" }}",
            duration * random.between(0.2..0.8),
            duration * random.scale(0.005..0.1)
        ),
        _ => "{ kind = \"constant\" }".to_owned(),
    }
}

/// A table of time and value that begins at rest.
fn table(random: &mut Random, duration: f64, size: f64) -> String {
    let rows = (0..ROWS).map(|row| {
        let s = row as f64 / (ROWS - 1) as f64;
        let rough = random.between(0.9..1.1);
        format!("{:e},{:e}\n", 1.001 * duration * s, size * rough * s * s * (3.0 - 2.0 * s))
    });
    "t,value\n".to_owned() + &rows.collect::<String>()
}

/// A hub that is moved, or is free under torques, springs, dampers and a controller.
fn hub(random: &mut Random, drawn: &mut Drawn, beam: Beam, spring: Option<String>) {
    let Beam { length, frequency, duration, .. } = beam;
    let inertia = beam.inertia() * random.scale(0.3..10.0);
    let radius = length * random.between(0.0..0.5);
    add!(drawn, "[hub]\nradius = {radius}\ninertia = {inertia}");
    let stiffness = beam.inertia() * frequency * frequency;
    let interpolation = random.pick(&["linear", "monotone", "spline"]);
    let speed = frequency * random.scale(0.1..3.0);
    let motion = match random.count(0..12) {
        0 => format!(
            "{{ kind = \"free\", damping = {}, torque = {{ kind = \"ramp\", torque = {}, time = {} }} }}",
            beam.inertia() * frequency * random.between(0.0..0.2),
            stiffness * random.between(-0.15..0.15),
            duration * random.between(0.2..1.0),
        ),
        1 => format!(
            "{{ kind = \"free\", stiffness = {}, torque = {{ kind = \"expression\", formula = \"{}*sin({}*t)\" }} }}",
            stiffness * random.scale(0.01..1.0),
            stiffness * random.between(0.0..0.15),
            random.between(1.0..10.0) / duration,
        ),
        2 => {
            let gain = stiffness * random.scale(0.03..0.5);
            let target = random.between(-1.0..1.0);
            let limit = match random.count(0..4) {
                0 => format!(", limit = {}", gain * random.between(0.02..0.3)),
                _ => String::new(),
            };
            format!(
                "{{ kind = \"free\", controller = {{ kind = \"pd\", proportional = {gain}, derivative = {}, \
                 target = {target}, rate = {}{limit} }} }}",
                gain * random.between(0.3..2.0) / frequency,
                target.abs().max(0.1) / (duration * random.between(0.3..1.0)),
            )
        }
        3 => format!("{{ kind = \"constant\", speed = {} }}", frequency * random.between(0.0..0.6)),
        4 => format!(
            "{{ kind = \"expression\", of = \"angle\", formula = \"{}*(1 - cos({}*t))\" }}",
            random.between(0.05..0.8),
            random.between(1.0..6.0) / duration,
        ),
        5 => format!(
            "{{ kind = \"expression\", of = \"speed\", formula = \"{speed}*sin({}*t)\" }}",
            random.between(1.0..8.0) / duration
        ),
        6 => {
            drawn.file("motion.csv", table(random, duration, speed));
            format!(
                "{{ kind = \"table\", of = \"speed\", file = \"motion.csv\", interpolation = \"{interpolation}\" }}"
            )
        }
        7 => {
            drawn.file("torque.csv", table(random, duration, 0.1 * stiffness));
            format!(
                "{{ kind = \"free\", torque = {{ kind = \"table\", file = \"torque.csv\", interpolation = \"{interpolation}\" }} }}"
            )
        }
        8 if beam.sudden => format!("{{ kind = \"ramp\", speed = {speed}, time = {} }}", 0.7 * duration),
        9 if beam.sudden => format!(
            "{{ kind = \"free\", torque = {{ kind = \"constant\", torque = {} }} }}",
            stiffness * random.between(-0.1..0.1)
        ),
        _ => format!(
            "{{ kind = \"spin-up\", speed = {speed}, time = {} }}",
            duration * random.between(0.5..1.2)
        ),
    };
    add!(drawn, "motion = {motion}");
    if let Some(spring) = spring {
        add!(drawn, "{spring}\nto = [{}, {}]", radius + 1.5 * length, 0.2 * length);
    }
    if beam.touching {
        return;
    }
    let steady = motion.contains("constant\", speed");
    if steady && !beam.sudden {
        // Straight at the start, it would vibrate along its axis.
        add!(drawn, "[initial]\nkind = \"steady-rotation\"");
    } else if random.one_in(10) {
        let kind = if steady { "steady-rotation" } else { "static" };
        add!(drawn, "[initial]\nkind = \"{kind}\"");
    } else if random.one_in(10) {
        let (first, second) = (length * random.scale(1e-3..0.05), length * random.scale(1e-4..2e-3));
        // A torque would leave no equilibrium to vibrate about.
        if !motion.contains("\"free\"") {
            add!(drawn, "[initial]\nkind = \"modes\"\namplitudes = [{first}, {second}]");
        }
    }
}

fn model(random: &mut Random, drawn: &mut Drawn, beam: Beam) {
    let coupling =
        random.pick(&["zeroth", "first", "first", "first", "high", "high", "high", "exact", "exact"]);
    add!(drawn, "[model]\ncoupling = \"{coupling}\"");
    let elements = random.count(3..13);
    let basis = match if coupling == "exact" { 0 } else { random.count(0..9) } {
        0..=2 => {
            let axial = random.count(1..3);
            format!("kind = \"finite-elements\"\nelements = {elements}\naxial-degree = {axial}")
        }
        3 => format!("kind = \"modes\"\naxial = {}\ntransverse = {}", random.count(1..5), random.count(2..7)),
        4 => format!("kind = \"radial\"\nnodes = {}", elements + 5),
        5 => format!("kind = \"b-spline\"\nelements = {elements}\ndegree = {}", random.count(2..6)),
        6 => format!("kind = \"bezier\"\ndegree = {}\nelements = {}", random.count(3..9), random.count(1..4)),
        7 => format!(
            "kind = \"mixed\"\naxial = {{ kind = \"finite-elements\", elements = {elements} }}\n\
             transverse = {{ kind = \"b-spline\", elements = {elements}, degree = 3 }}"
        ),
        _ => format!("kind = \"polynomial\"\nnodes = {}", elements + 3),
    };
    add!(drawn, "[basis]\n{basis}");
    if random.one_in(3) {
        add!(drawn, "[output]\nstations = ['{} m']", beam.length * random.between(0.1..0.9));
        add!(drawn, "section-forces = {}", random.coin());
    } else {
        add!(drawn, "[output]");
    }
    add!(drawn, "step = {}", beam.duration / 100.0);
}

fn integrator(random: &mut Random, drawn: &mut Drawn, beam: Beam) {
    let step = TAU / beam.frequency / random.scale(15.0..600.0);
    // Explicit methods begin with a step that is often refused.
    let kind = match (beam.explicit, beam.touching) {
        (true, false) => random.count(0..2),
        // No explicit method integrates closed contacts.
        (_, true) => random.count(2..11),
        _ => random.count(2..9),
    };
    let integrator = match kind {
        0 => format!("kind = \"runge-kutta-4\"\nstep = {}", 0.5 * step),
        1 => format!("kind = \"adams-4\"\nstep = {}", 0.5 * step),
        2 => format!("kind = \"newmark\"\nstep = {step}"),
        3 => format!("kind = \"hht\"\nalpha = {}\nstep = {step}", random.between(0.0..0.33)),
        4 => format!(
            "kind = \"generalized-alpha\"\nspectral-radius = {}\nstep = {step}",
            random.between(0.0..1.0)
        ),
        9 => format!("kind = \"moreau-jean\"\nstep = {}", 0.1 * step),
        10 => format!("kind = \"nonsmooth-generalized-alpha\"\nstep = {}", 0.1 * step),
        _ => format!("kind = \"radau\"\ntolerance = {:e}", random.scale(1e-8..1e-3)),
    };
    add!(drawn, "[integrator]\n{integrator}\n[run]\nduration = {}", beam.duration);
}

/// One to three contacts: stops beside the beam, planes on the hub, and a rim that the tip may touch.
fn contacts(random: &mut Random, drawn: &mut Drawn, beam: Beam) {
    let length = beam.length;
    for _ in 0..random.count(1..4) {
        let side = if random.coin() { 1.0 } else { -1.0 };
        let gap = length * random.scale(1e-5..1e-2);
        let obstacle = match random.count(0..3) {
            0 => format!("kind = \"stop\", offset = {}", side * gap),
            1 => format!(
                "kind = \"plane\", point = [0, {}], angle = \"{} deg\"",
                side * gap,
                if side > 0.0 { 180.0 } else { 0.0 }
            ),
            _ => format!(
                "kind = \"cylinder\", centre = [{length}, {}], radius = {length}",
                side * (length + gap)
            ),
        };
        let restitution = random.between(0.05..1.0);
        let friction = [0.0, random.between(0.0..0.5)][random.count(0..2)];
        let law = match random.count(0..4) {
            0 => {
                let laws = ["hunt-crossley", "lankarani-nikravesh", "flores", "gonthier", "matched", "hertz"];
                let law = random.pick(&laws);
                let stiffness = random.scale(1e3..1e7);
                let damped =
                    if law == "hertz" { String::new() } else { format!(", restitution = {restitution}") };
                format!("kind = \"{law}\", stiffness = {stiffness}{damped}, friction = {friction}")
            }
            _ => format!("kind = \"constraint\", restitution = {restitution}, friction = {friction}"),
        };
        let station = if random.coin() { length } else { length * random.between(0.3..1.0) };
        add!(
            drawn,
            "[[contact]]\non = '{station} m'\nmount = 'hub'\nobstacle = {{ {obstacle} }}\nlaw = {{ {law} }}"
        );
    }
}

//! Valid cases drawn at random: sections, loads, masses, damping, hubs, couplings, bases, integrators, steps.
//!
//! Sizes follow from the beam: durations from the period of its first bending vibration, loads from what would bend it
//! by its length, speeds from its first natural frequency. What sets in at once excites axial vibrations too, and the
//! ratio of axial to bending frequencies is about 1.5 times the slenderness: suddenly loaded beams are less slender.

use fastrand::Rng;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::ops::Range;

/// Most slender beams, over their height: loaded smoothly and at once.
const SLENDER: f64 = 250.0;
const SLENDER_AND_SUDDEN: f64 = 40.0;

/// A case, and the length of its beam.
pub struct Drawn {
    pub text: String,
    pub length: f64,
}

fn between(random: &mut Rng, range: Range<f64>) -> f64 {
    range.start + (range.end - range.start) * random.f64()
}

/// A number between two others, whose logarithm is evenly distributed.
fn scale(random: &mut Rng, range: Range<f64>) -> f64 {
    between(random, range.start.ln()..range.end.ln()).exp()
}

fn pick<'a>(random: &mut Rng, among: &[&'a str]) -> &'a str {
    among[random.usize(..among.len())]
}

fn one_in(random: &mut Rng, count: u8) -> bool {
    random.u8(..count) == 0
}

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

/// A beam with its section, written into `text`.
fn beam(random: &mut Rng, text: &mut String) -> Beam {
    let sudden = one_in(random, 3);
    let explicit = one_in(random, 6);
    let length = scale(random, 0.3..20.0);
    let height = length / scale(random, 20.0..if sudden || explicit { SLENDER_AND_SUDDEN } else { SLENDER });
    let width = height * scale(random, 0.5..5.0);
    let (modulus, density) =
        [(70e9, 2700.0), (210e9, 7850.0), (3e9, 1100.0), (40e9, 1900.0)][random.usize(..4)];
    let _ = writeln!(text, "[beam]\nlength = {length}\n[section]");
    let plate = format!("width = {width}\nheight = {height}");
    let (bending, mass) = (modulus * width * height.powi(3) / 12.0, density * width * height);
    let rotary = random.bool();
    let _ = match random.u8(..8) {
        0 => writeln!(
            text,
            "kind = \"graded\"\nceramic-modulus = {}\nmetal-modulus = {modulus}\nceramic-density = {}\n\
             metal-density = {density}\n{plate}\nexponent = {}",
            modulus * between(random, 1.0..2.5),
            density * between(random, 0.6..1.4),
            between(random, 0.0..6.0),
        ),
        1 => writeln!(
            text,
            "kind = \"tapered-rectangle\"\nmodulus = {modulus}\ndensity = {density}\nroot-width = {width}\n\
             root-height = {height}\ntip-width = {}\ntip-height = {}",
            width * between(random, 0.4..1.0),
            height * between(random, 0.4..1.0),
        ),
        2 => writeln!(
            text,
            "kind = \"tube\"\nmodulus = {modulus}\ndensity = {density}\nouter-radius = {}\ninner-radius = {}\n\
             rotary-inertia = {rotary}",
            0.5 * height,
            0.5 * height * between(random, 0.3..0.9),
        ),
        3 => {
            // Jumps where elements of every mesh end.
            let area = width * height;
            let ratio = between(random, 0.5..1.0);
            writeln!(
                text,
                "kind = \"piecewise\"\nends = [{}, {length}]\nmodulus = [{modulus}, {modulus}]\n\
                 density = [{density}, {density}]\narea = [{area}, {}]\nsecond-moment = [{}, {}]",
                0.5 * length,
                area * ratio,
                bending / modulus,
                bending / modulus * ratio.powi(3),
            )
        }
        4 => writeln!(
            text,
            "kind = \"resultants\"\nmass-per-length = {mass}\naxial-stiffness = {}\nbending-stiffness = {bending}",
            modulus * width * height,
        ),
        _ => writeln!(
            text,
            "kind = \"rectangle\"\nmodulus = {modulus}\ndensity = {density}\n{plate}\nrotary-inertia = {rotary}"
        ),
    };
    let frequency = 3.516 * (bending / (mass * length.powi(4))).sqrt();
    // Vibrations along the axis, and the waves of a mesh, are to be followed for a while, not for thousands of periods.
    let periods = match (explicit, sudden) {
        (true, _) => 0.05..0.2,
        (_, true) => 0.1..0.4,
        _ => 0.2..1.2,
    };
    let duration = TAU / frequency * between(random, periods);
    Beam { length, height, mass, bending, frequency, duration, sudden, explicit }
}

/// Loads that would bend the beam statically by up to a third of its length, masses and damping.
fn loads(random: &mut Rng, text: &mut String, beam: Beam) {
    let Beam { length, height, mass, duration, .. } = beam;
    let force = beam.force();
    let size = |random: &mut Rng, reference: f64| reference * scale(random, 1e-3..0.3);
    if beam.sudden && random.bool() {
        let acceleration = size(random, force / (mass * length)).min(9.81);
        let direction = between(random, -3.0..3.0);
        let _ = writeln!(text, "[gravity]\nacceleration = {acceleration}\ndirection = {direction}");
    }
    let frame = pick(random, &["dead", "hub", "follower"]);
    let amplitude = match random.u8(..if beam.sudden { 5 } else { 3 }) {
        0 => format!(
            "{{ kind = \"expression\", formula = \"(1 - cos({}*t))/2\" }}",
            between(random, 3.0..20.0) / duration
        ),
        // 10 s³ − 15 s⁴ + 6 s⁵ grows from 0 to 1 with two continuous derivatives.
        1 => {
            let time = duration * between(random, 0.3..1.2);
            let grown = format!("(t/{time})^3*(10 - 15*t/{time} + 6*(t/{time})^2)");
            format!("{{ kind = \"expression\", formula = \"if(t < {time}, {grown}, 1)\" }}")
        }
        2 => format!(
            "{{ kind = \"expression\", formula = \"t*sin({0}*t)/{duration}\" }}",
            between(random, 1.0..12.0) / duration
        ),
        3 => format!("{{ kind = \"ramp\", time = {} }}", duration * between(random, 0.1..0.8)),
        _ => "{ kind = \"constant\" }".to_owned(),
    };
    if random.bool() {
        let (along, across) = (0.3 * size(random, force), size(random, force));
        let _ = writeln!(
            text,
            "[[force]]\nstation = {}\nforce = [{along}, {across}]\nframe = \"{frame}\"\namplitude = {amplitude}",
            if random.bool() { length } else { length * between(random, 0.3..1.0) },
        );
    }
    if one_in(random, 4) {
        let couple = size(random, force * length);
        let _ = writeln!(text, "[[couple]]\nstation = {length}\ncouple = {couple}\namplitude = {amplitude}");
    }
    if one_in(random, 4) {
        let across = size(random, force / length);
        let _ = writeln!(
            text,
            "[[distributed-load]]\nforce = [0, {across}]\nframe = \"{frame}\"\namplitude = {amplitude}"
        );
    }
    if one_in(random, 4) {
        let body = mass * length * scale(random, 0.01..1.0);
        let _ = writeln!(
            text,
            "[[mass]]\nstation = {}\nmass = {body}\ninertia = {}",
            if random.bool() { length } else { length * between(random, 0.3..1.0) },
            if random.bool() { body * height * height } else { 0.0 },
        );
    }
    if one_in(random, 3) {
        let proportional = scale(random, 0.01..3.0) / duration;
        let _ = writeln!(text, "[damping]\nmass-proportional = {proportional}");
        if random.bool() && !beam.explicit {
            let _ = writeln!(text, "stiffness-proportional = {}", scale(random, 1e-4..0.05) / beam.frequency);
        }
    }
}

/// A hub that is moved, or is free under torques, springs, dampers and a controller.
fn hub(random: &mut Rng, text: &mut String, beam: Beam) {
    let Beam { length, frequency, duration, .. } = beam;
    let inertia = beam.inertia() * scale(random, 0.3..10.0);
    let _ = writeln!(text, "[hub]\nradius = {}\ninertia = {inertia}", length * between(random, 0.0..0.5));
    let stiffness = beam.inertia() * frequency * frequency;
    let motion = match random.u8(..7) {
        0 => format!(
            "{{ kind = \"free\", damping = {}, torque = {{ kind = \"ramp\", torque = {}, time = {} }} }}",
            beam.inertia() * frequency * between(random, 0.0..0.2),
            stiffness * between(random, -0.15..0.15),
            duration * between(random, 0.2..1.0),
        ),
        1 => format!(
            "{{ kind = \"free\", stiffness = {}, torque = {{ kind = \"expression\", formula = \"{}*sin({}*t)\" }} }}",
            stiffness * scale(random, 0.01..1.0),
            stiffness * between(random, 0.0..0.15),
            between(random, 1.0..10.0) / duration,
        ),
        2 => {
            let gain = stiffness * scale(random, 0.03..0.5);
            let target = between(random, -1.0..1.0);
            format!(
                "{{ kind = \"free\", controller = {{ kind = \"pd\", proportional = {gain}, derivative = {}, \
                 target = {target}, rate = {} }} }}",
                gain * between(random, 0.3..2.0) / frequency,
                target.abs().max(0.1) / (duration * between(random, 0.3..1.0)),
            )
        }
        3 => format!("{{ kind = \"constant\", speed = {} }}", frequency * between(random, 0.0..0.6)),
        4 => format!(
            "{{ kind = \"expression\", of = \"angle\", formula = \"{}*(1 - cos({}*t))\" }}",
            between(random, 0.05..0.8),
            between(random, 1.0..6.0) / duration,
        ),
        _ => format!(
            "{{ kind = \"spin-up\", speed = {}, time = {} }}",
            frequency * scale(random, 0.1..3.0),
            duration * between(random, 0.5..1.2),
        ),
    };
    let _ = writeln!(text, "motion = {motion}");
    if motion.contains("constant\", speed") && !beam.sudden {
        // Straight at the start, it would vibrate along its axis.
        let _ = writeln!(text, "[initial]\nkind = \"steady-rotation\"");
    }
}

fn model(random: &mut Rng, text: &mut String) {
    let coupling =
        pick(random, &["zeroth", "first", "first", "first", "high", "high", "high", "exact", "exact"]);
    let _ = writeln!(text, "[model]\ncoupling = \"{coupling}\"");
    // Even numbers: a section may jump in the middle.
    let elements = 2 * random.usize(2..6);
    let basis = match if coupling == "exact" { 0 } else { random.u8(..9) } {
        0..=2 => {
            format!("kind = \"finite-elements\"\nelements = {elements}\naxial-degree = {}", random.u8(1..3))
        }
        3 => format!("kind = \"modes\"\naxial = {}\ntransverse = {}", random.u8(1..5), random.u8(2..7)),
        4 => format!("kind = \"radial\"\nnodes = {}", elements + 5),
        5 => format!("kind = \"b-spline\"\nelements = {elements}\ndegree = {}", random.u8(2..6)),
        6 => format!("kind = \"bezier\"\ndegree = {}\nelements = {}", random.u8(3..9), random.u8(1..4)),
        7 => format!(
            "kind = \"mixed\"\naxial = {{ kind = \"finite-elements\", elements = {elements} }}\n\
             transverse = {{ kind = \"b-spline\", elements = {elements}, degree = 3 }}"
        ),
        _ => format!("kind = \"polynomial\"\nnodes = {}", elements + 3),
    };
    let _ = writeln!(text, "[basis]\n{basis}");
}

fn integrator(random: &mut Rng, text: &mut String, beam: Beam) {
    let step = TAU / beam.frequency / scale(random, 15.0..600.0);
    // Explicit methods begin with a step that is often refused.
    let integrator = match if beam.explicit { random.u8(..2) } else { random.u8(2..9) } {
        0 => format!("kind = \"runge-kutta-4\"\nstep = {}", 0.5 * step),
        1 => format!("kind = \"adams-4\"\nstep = {}", 0.5 * step),
        2 => format!("kind = \"newmark\"\nstep = {step}"),
        3 => format!("kind = \"hht\"\nalpha = {}\nstep = {step}", between(random, 0.0..0.33)),
        4 => format!("kind = \"generalized-alpha\"\nspectral-radius = {}\nstep = {step}", random.f64()),
        _ => format!("kind = \"radau\"\ntolerance = {:e}", scale(random, 1e-8..1e-3)),
    };
    let _ = writeln!(text, "[integrator]\n{integrator}");
    let duration = beam.duration;
    let _ = writeln!(text, "[run]\nduration = {duration}\n[output]\nstep = {}", duration / 100.0);
}

/// The case of a seed.
pub fn case(seed: u64) -> Drawn {
    let random = &mut Rng::with_seed(seed);
    let mut text = String::new();
    let beam = beam(random, &mut text);
    loads(random, &mut text, beam);
    hub(random, &mut text, beam);
    model(random, &mut text);
    integrator(random, &mut text, beam);
    Drawn { text, length: beam.length }
}

/// The case of a seed with one to three contacts: stops beside the beam, planes on the hub, and a rim that the tip may touch.
pub fn case_with_contacts(seed: u64) -> Drawn {
    let Drawn { mut text, length } = case(seed);
    let random = &mut Rng::with_seed(!seed);
    for _ in 0..random.usize(1..4) {
        let side = if random.bool() { 1.0 } else { -1.0 };
        let gap = length * scale(random, 1e-5..1e-2);
        let obstacle = match random.u8(..3) {
            0 => format!("kind = \"stop\", offset = {}", side * gap),
            1 => format!(
                "kind = \"plane\", mount = \"hub\", point = [0, {}], angle = \"{} deg\"",
                side * gap,
                if side > 0.0 { 180.0 } else { 0.0 }
            ),
            _ => format!(
                "kind = \"circle\", mount = \"hub\", centre = [{length}, {}], radius = {length}",
                side * (length + gap)
            ),
        };
        let restitution = between(random, 0.05..1.0);
        let friction = [0.0, between(random, 0.0..0.5)][random.usize(..2)];
        let law = match random.u8(..4) {
            0 => {
                let law =
                    pick(random, &["hunt-crossley", "lankarani-nikravesh", "flores", "gonthier", "matched"]);
                let stiffness = scale(random, 1e3..1e7);
                format!(
                    "kind = \"{law}\", stiffness = {stiffness}, restitution = {restitution}, friction = {friction}"
                )
            }
            _ => format!("kind = \"constraint\", restitution = {restitution}, friction = {friction}"),
        };
        let station = if random.bool() { length } else { length * between(random, 0.3..1.0) };
        let _ = writeln!(
            text,
            "[[contact]]\nstation = {station}\nobstacle = {{ {obstacle} }}\nlaw = {{ {law} }}"
        );
    }
    Drawn { text, length }
}

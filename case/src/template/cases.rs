//! The templates: values only.

use super::Template;

/// A blade of 20 m, invented: its mass and stiffness fall towards the tip as those of real blades do.
const BLADE: &str = "\
# An invented blade of 20 m. Columns have the units of their names; without one a column is in SI.
x [m],  mass [kg/m], EA [MN], EI-flap [kN*m^2], EI-chord [kN*m^2], GJ [kN*m^2], inertia-flap [kg*m], inertia-chord [kg*m], StrcTwst [deg]
0,      320,         4500,    380000,           420000,            150000,      25,                  30,                   12
2,      180,         2200,    130000,           240000,            40000,       9,                   20,                   12
5,      120,         1400,    45000,            120000,            9000,        3,                   12,                   8
10,     80,          800,     12000,            45000,             2500,        0.9,                 6,                    4
15,     45,          400,     2200,             14000,             600,         0.25,                2.2,                  1.5
18,     25,          180,     450,              4500,              160,         0.06,                0.8,                  0.4
20,     12,          70,      60,               900,               40,          0.01,                0.2,                  0
";

/// All templates.
pub static TEMPLATES: &[Template] = &[
    Template {
        name: "spin-up",
        summary: "a beam set into rotation smoothly, and its vibration afterwards",
        text: r#"
title = "Spin-up of a flexible beam"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 10 }
integrator = { kind = "radau", tolerance = 1e-6 }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
        file: None,
    },
    Template {
        name: "steady",
        summary: "a rectangular beam in steady rotation, started in its equilibrium",
        text: r#"
title = "Steady rotation"
beam = { length = "2 m" }
section = { kind = "rectangle", modulus = "210 GPa", density = "7850 kg/m^3", width = "40 mm", height = "10 mm" }
hub = { radius = "0.2 m", motion = { kind = "constant", speed = "30 rad/s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 10 }
initial = { kind = "steady-rotation" }
integrator = { kind = "radau", tolerance = 1e-8 }
run = { duration = "1 s" }
output = { step = "5 ms", stations = ["1 m"] }
"#,
        file: None,
    },
    Template {
        name: "blade",
        summary: "a blade from a table along its span, for its modes and its Campbell diagram",
        text: r#"
title = "A blade"
beam = { length = "20 m", pitch = "-2 deg", precone = "2.5 deg" }
section = { kind = "deck", file = "blade.csv", format = "csv" }
hub = { radius = "0.5 m" }
model = { coupling = "space" }
basis = { elements = 20 }
"#,
        file: Some(("blade.csv", BLADE)),
    },
    Template {
        name: "arm",
        summary: "a robot arm under gravity that a controller turns to a target angle, with a mass at its tip",
        text: r#"
title = "A flexible arm with a payload"
beam = { length = "1 m" }
section = { kind = "rectangle", modulus = "70 GPa", density = "2700 kg/m^3", width = "30 mm", height = "5 mm" }
gravity = [0, "-9.81 m/s^2"]
mass = [{ on = "tip", mass = "100 g" }]
damping = { stiffness = "0.5 ms" }
run = { duration = "5 s" }
output = { step = "0.01 s" }
[hub]
radius = "50 mm"
inertia = "0.05 kg*m^2"
motion = { kind = "free", controller = { kind = "pd", proportional = "80 N*m/rad", derivative = "12 N*m*s/rad", target = "60 deg", rate = "1 rad/s", limit = "20 N*m" } }
"#,
        file: None,
    },
    Template {
        name: "graded",
        summary: "a beam graded over its height from metal to ceramic, spun up on a hub",
        text: r#"
title = "Functionally graded beam"
beam = { length = "8 m" }
hub = { radius = "0.5 m", motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 12 }
integrator = { kind = "radau" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
[section]
kind = "graded"
ceramic-modulus = "151 GPa"
metal-modulus = "70 GPa"
ceramic-density = "3000 kg/m^3"
metal-density = "2707 kg/m^3"
width = "20 mm"
height = "40 mm"
exponent = 2.0
"#,
        file: None,
    },
    Template {
        name: "exact-large-deflection",
        summary: "a soft beam with large deflections, geometrically exact",
        text: r#"
title = "Large deflection of a soft beam"
beam = { length = "8 m" }
section = { kind = "uniform", modulus = "10 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "4 s" } }
model = { coupling = "exact" }
basis = { kind = "finite-elements", elements = 16 }
integrator = { kind = "generalized-alpha", step = "2 ms", spectral-radius = 0.8 }
run = { duration = "8 s" }
output = { step = "20 ms", vtk = true }
"#,
        file: None,
    },
    Template {
        name: "formula",
        summary: "a hub that swings to and fro by a formula in time",
        text: r#"
title = "Swinging hub"
beam = { length = "5 m" }
section = { kind = "tube", modulus = "70 GPa", density = "2700 kg/m^3", outer-radius = "30 mm", inner-radius = "26 mm" }
hub = { motion = { kind = "expression", formula = "0.5*(1 - cos(2*t))", of = "angle" } }
model = { coupling = "first" }
basis = { kind = "finite-elements", elements = 8 }
integrator = { kind = "radau" }
run = { duration = "10 s" }
output = { step = "10 ms" }
"#,
        file: None,
    },
    Template {
        name: "double-pendulum",
        summary: "two rigid bars on hinges fall in space",
        text: r#"
title = "Double pendulum"
gravity = [0, 0, "-9.81 m/s^2"]
integrator = { kind = "radau", tolerance = 1e-8 }
run = { duration = "5 s" }
output = { step = "0.01 s" }
[[body]]
name = "upper"
mass = "2 kg"
inertia = { kind = "box", size = ["1 m", "5 cm", "5 cm"] }
position = ["50 cm", 0, 0]
[[body]]
name = "lower"
mass = "1 kg"
inertia = { kind = "box", size = ["1 m", "3 cm", "3 cm"] }
position = ["150 cm", 0, 0]
[[joint]]
name = "shoulder"
kind = "revolute"
between = ["ground", "upper"]
at = [0, 0, 0]
axis = [0, -1, 0]
[[joint]]
name = "elbow"
kind = "revolute"
between = ["upper", "lower"]
at = ["1 m", 0, 0]
axis = [0, -1, 0]
"#,
        file: None,
    },
    Template {
        name: "robot-arm",
        summary: "a motor turns a slender beam in space that carries a mass",
        text: r#"
title = "A flexible arm in space"
gravity = [0, 0, "-9.81 m/s^2"]
integrator = { kind = "generalized-alpha", step = "1 ms" }
run = { duration = "2 s" }
output = { step = "5 ms", stations = ["50 cm"], vtk = true }
[[body]]
name = "payload"
mass = "200 g"
inertia = { kind = "sphere", radius = "3 cm" }
position = ["1 m", 0, 0]
[[beam]]
name = "arm"
length = "1 m"
up = [0, 0, 1]
section = { kind = "rectangle", modulus = "70 GPa", density = "2700 kg/m^3", width = "20 mm", height = "5 mm" }
elements = 8
[[joint]]
name = "motor"
kind = "revolute"
between = ["ground", "arm.root"]
motion = { kind = "spin-up", speed = "1 rad/s", time = "1 s" }
[[joint]]
name = "grip"
kind = "fixed"
between = ["arm.tip", "payload"]
at = ["1 m", 0, 0]
"#,
        file: None,
    },
    Template {
        name: "modes",
        summary: "a beam described by a few of its vibration modes, fixed steps",
        text: r#"
title = "Assumed modes"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "modes", axial = 3, transverse = 4 }
integrator = { kind = "newmark", step = "2 ms" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
        file: None,
    },
    Template {
        name: "radial",
        summary: "a beam described by meshfree radial point interpolation",
        text: r#"
title = "Radial point interpolation"
beam = { length = "10 m" }
section = { kind = "uniform", modulus = "70 GPa", density = "3000 kg/m^3", area = "4 cm^2", second-moment = "2e-7 m^4" }
hub = { motion = { kind = "spin-up", speed = "4 rad/s", time = "15 s" } }
model = { coupling = "first" }
basis = { kind = "radial", nodes = 13 }
integrator = { kind = "radau" }
run = { duration = "20 s" }
output = { step = "0.02 s" }
"#,
        file: None,
    },
];

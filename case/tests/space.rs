//! Systems in space: what their tables mean.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::{Problems, Reading, Run, parse};
use flexion_results::Status;
use flexion_results::plot::{Line, Panel, spatial_figure};
use std::ops::ControlFlow;
use std::path::Path;

const ROD: &str = "section = { kind = \"circle\", modulus = \"70 GPa\", density = 2700, radius = \"1 cm\" }";

fn read(text: &str) -> Result<Reading, Problems> {
    parse(text.to_owned(), Path::new("case.toml"), &[])
}

fn run(text: &str) -> Run {
    let reading = read(text).unwrap_or_else(|problems| panic!("{problems}"));
    let run = reading.prepare().unwrap_or_else(|p| panic!("{p}")).run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    run
}

fn last(run: &Run, column: &str) -> f64 {
    *run.trajectory.column(column).unwrap_or_else(|| panic!("no column {column}")).last().unwrap()
}

fn columns(run: &Run) -> Vec<&str> {
    run.trajectory.channels().iter().map(|channel| channel.name.as_str()).collect()
}

/// A motor whose target begins to move at once, on a bare root that follows within microseconds; and damping in proportion to the stiffness that takes all that a
/// blow of a tenth of a second has given. Powers between the ends of a step are those of its stages.
#[test]
fn the_energy_balance_closes_behind_sudden_torques_and_with_stiff_damping() {
    let arm = format!(
        "gravity = [0, 0, -9.81]\nrun = {{ duration = 1 }}\n[[beam]]\nname = \"arm\"\nlength = 1\nup = [0, 0, 1]\n{ROD}\n\
         [[joint]]\nkind = \"revolute\"\nbetween = [\"ground\", \"arm.root\"]\naxis = [0, -1, 0]\n\
         motion = {{ kind = \"free\", controller = {{ kind = \"pd\", proportional = 50, derivative = 10, target = \"45 deg\", rate = \"1 rad/s\" }} }}\n"
    );
    let damped = "run = { duration = 3 }\n[[beam]]\nlength = 1\nroot = \"clamped\"\nelements = 12\ndamping = { stiffness = 0.02, mass = 0.3 }\n\
                  section = { kind = \"general\", mass-per-length = 1, axial-stiffness = 1e6, torsional-stiffness = 1, bending-stiffness = 1, \
                  bending-stiffness-across = 1, rotary-inertia = 1e-4, rotary-inertia-across = 1e-4 }\n\
                  [[load]]\non = \"beam.tip\"\nforce = [0, 0, 0.01]\namplitude = { kind = \"expression\", formula = \"if(t < 0.1, 1, 0)\" }\n";
    for text in [arm.as_str(), damped] {
        let run = run(text);
        let most = |column: &str| {
            run.trajectory.column(column).unwrap().iter().fold(0.0, |m: f64, x| m.max(x.abs()))
        };
        let worked = most("energy.drive").max(most("energy.loads"));
        assert!(most("energy.balance") < 2e-3 * worked, "{} of {worked}", most("energy.balance"));
        assert!(run.warnings.iter().all(|warning| !warning.contains("energy")), "{:?}", run.warnings);
    }
}

/// The momentum of a ball behind half of a force that grows along a line from 0 to 1 N in 1 s: t²/2 = 1/8 N s. Monotone cubics give 0.1510.
#[test]
fn tables_of_loads_are_straight_lines_between_their_rows() {
    let text = "run = { duration = 0.5 }\n[[body]]\nname = \"ball\"\nmass = 2\ninertia = { kind = \"sphere\", radius = 0.1 }\n\
                [[load]]\non = \"ball\"\nforce = [1, 0, 0]\namplitude = { kind = \"table\", times = [0, 1, 2, 30], factors = [0, 1, 0, 0] }\n";
    let momentum = last(&run(text), "momentum.x");
    assert!((momentum - 0.125).abs() < 1e-9, "{momentum}");
}

/// A clamped beam of five lines sags by ρA g L⁴/(8 EI), with its height upwards and in the other direction too.
#[test]
fn five_lines_make_a_cantilever_under_its_weight() {
    let case = |up: &str| {
        let text = format!(
            "gravity = [0, 0, \"-9.81 m/s^2\"]\nrun = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n\
             beam = [{{ length = \"1 m\", root = \"clamped\", up = {up}, section = {{ kind = \"rectangle\", \
             modulus = \"70 GPa\", density = 2700, width = \"20 mm\", height = \"40 mm\" }} }}]"
        );
        last(&run(&text), "beam.tip.displacement.z")
    };
    for (up, height, width) in [("[0, 0, 1]", 0.04_f64, 0.02), ("[0, 1, 0]", 0.02, 0.04)] {
        let stiffness = 70e9 * width * height.powi(3) / 12.0;
        let sag = -2700.0 * width * height * 9.81 / (8.0 * stiffness);
        assert!((case(up) / sag - 1.0).abs() < 1e-5, "{up}: {} for {sag}", case(up));
    }
}

/// A place within a beam gets a node, and the load stands there: F a²(3L − a)/(6 EI) at the tip.
#[test]
fn a_load_stands_at_the_station_in_its_name() {
    let stiffness = 70e9 * std::f64::consts::PI * 1e-8 / 4.0;
    for a in [0.3, 0.71] {
        let text = format!(
            "run = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n[[beam]]\nlength = 1\nroot = \"clamped\"\n\
             elements = 3\n{ROD}\n[[load]]\non = \"beam@{} cm\"\nforce = [0, 0.001, 0]\n",
            100.0 * a
        );
        let found = last(&run(&text), "beam.tip.displacement.y");
        let exact = 0.001 * a * a * (3.0 - a) / (6.0 * stiffness);
        assert!((found / exact - 1.0).abs() < 1e-8, "{a}: {found} for {exact}");
    }
}

#[test]
fn a_station_given_twice_is_recorded_once() {
    let case = |stations: &str| {
        format!(
            "run = {{ duration = 0 }}\noutput.stations = {stations}\n[[beam]]\nlength = 1\nroot = \"clamped\"\n{ROD}\n"
        )
    };
    let (once, twice) = (run(&case("['0.5 m']")), run(&case("['0.5 m', 'tip', 'beam@50 cm']")));
    assert_eq!(columns(&twice), columns(&once));
}

/// Two coaxial rods with a joint between them are one rod.
#[test]
fn a_beam_in_two_pieces_is_one_beam() {
    let load = "[[load]]\non = \"b.tip\"\nforce = [0, 3, 20]\ncouple = [5, 0, 0]\n";
    let whole = format!(
        "run = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n[[beam]]\nname = \"b\"\nlength = 2\nroot = \"clamped\"\n\
         elements = 8\n{ROD}\n{load}"
    );
    let pieces = format!(
        "run = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n[[beam]]\nname = \"a\"\nlength = 1\nroot = \"clamped\"\n\
         elements = 4\n{ROD}\n[[beam]]\nname = \"b\"\nlength = 1\nstart = [1, 0, 0]\nelements = 4\n{ROD}\n\
         [[joint]]\nkind = \"fixed\"\nbetween = [\"a.tip\", \"b.root\"]\n{load}"
    );
    let (whole, pieces) = (run(&whole), run(&pieces));
    for column in ["x", "y", "z"].map(|axis| format!("b.tip.displacement.{axis}")) {
        let (one, two) = (last(&whole, &column), last(&pieces, &column));
        assert!((one - two).abs() < 1e-8, "{column}: {one} and {two}");
    }
    assert!(columns(&pieces).contains(&"joint.force.x"), "{:?}", columns(&pieces));
}

/// A prescribed angle that begins with 1 rad does not turn the body as it was drawn.
#[test]
fn a_joint_begins_with_the_angle_of_its_motion() {
    let text = "run = { duration = \"1 s\" }\n\
                body = [{ name = \"bar\", mass = 1, position = [1, 0, 0], inertia = { kind = \"sphere\", radius = 0.1 } }]\n\
                joint = [{ name = \"axle\", kind = \"revolute\", between = [\"ground\", \"bar\"], at = [0, 0, 0], \
                motion = { kind = \"expression\", of = \"angle\", formula = \"1 + t\" } }]";
    let run = run(text);
    assert_eq!(run.trajectory.column("bar.position.x").unwrap()[0], 1.0);
    assert!((last(&run, "axle.angle") - 2.0).abs() < 1e-9);
    assert!((last(&run, "bar.position.x") - 1.0_f64.cos()).abs() < 1e-7);
    assert!((last(&run, "bar.velocity.y") - 1.0_f64.cos()).abs() < 1e-6);
}

#[test]
fn refinement_cuts_every_element() {
    let case = |refine: usize| {
        let text = format!(
            "run = {{ duration = 0 }}\nmodel = {{ refine = {refine} }}\n[[beam]]\nlength = 1\nelements = 3\nroot = \"clamped\"\n{ROD}\n"
        );
        read(&text).unwrap().case.system().unwrap().size().v
    };
    assert_eq!([1, 2, 4].map(case), [3, 6, 12].map(|elements| 8 * elements + 7));
}

/// All problems at once, each at its line.
#[test]
fn several_faults_are_reported_together() {
    let text = format!(
        "run = {{ duration = 1 }}\n[[beam]]\nlength = 1\nroot = \"clampd\"\n{ROD}\n[[body]]\nname = \"ball\"\nmass = 1\n\
         inertia = {{ kind = \"sphere\", radius = 1 }}\n[[joint]]\nkind = \"revolut\"\nbetween = [\"ground\", \"ball\"]\n"
    );
    let problems = read(&text).map(|_| ()).unwrap_err();
    let keys: Vec<&str> = problems.list.iter().map(|problem| problem.key.as_str()).collect();
    assert_eq!(keys, ["beam[1].root", "joint[1].kind"], "{problems}");
    let text = text.replace("clampd", "free").replace("revolut", "revolute").replace("\"ball\"]", "\"bll\"]");
    let problems = read(&text).map(|_| ()).unwrap_err();
    assert!(problems.to_string().contains("did you mean `ball`?"), "{problems}");
    assert_eq!(problems.line_and_column(&problems.list[0]).unwrap().0, 12);
}

/// A loop of four hinges: two rows more than needed, which can be left out on request.
#[test]
fn redundant_rows_of_a_loop_are_named_and_can_be_left_out() {
    let bar = |name: &str, x: f64, z: f64, size: &str| {
        format!(
            "[[body]]\nname = \"{name}\"\nmass = 1\nposition = [{x}, 0, {z}]\ninertia = {{ kind = \"box\", size = {size} }}\n"
        )
    };
    let hinge = |between: &str, x: f64, z: f64| {
        format!(
            "[[joint]]\nkind = \"revolute\"\nbetween = [{between}]\nat = [{x}, 0, {z}]\naxis = [0, 1, 0]\n"
        )
    };
    let text = [
        "gravity = [1, 0, -9.81]\nrun = { duration = \"0.1 s\" }\n".to_owned(),
        bar("left", 0.0, 0.5, "[0.1, 0.1, 1]"),
        bar("top", 0.5, 1.0, "[1, 0.1, 0.1]"),
        bar("right", 1.0, 0.5, "[0.1, 0.1, 1]"),
        hinge("\"ground\", \"left\"", 0.0, 0.0),
        hinge("\"left\", \"top\"", 0.0, 1.0),
        hinge("\"top\", \"right\"", 1.0, 1.0),
        hinge("\"right\", \"ground\"", 1.0, 0.0),
    ]
    .concat();
    let problems = read(&text).map(|_| ()).unwrap_err();
    assert!(
        problems.to_string().contains("redundant") && problems.list[0].key.starts_with("joint["),
        "{problems}"
    );
    // Cranks that are driven at 1 and 2 rad/s.
    let motor =
        |speed: u32| format!("axis = [0, 1, 0]\nmotion = {{ kind = \"constant\", speed = {speed} }}\n");
    let driven = text.replacen("axis = [0, 1, 0]\n", &motor(1), 1) + &motor(2)["axis = [0, 1, 0]\n".len()..];
    for case in [driven.clone(), format!("model = {{ drop-redundant-rows = true }}\n{driven}")] {
        let problems = read(&case).map(|_| ()).unwrap_err();
        let (key, told) = (&problems.list[0].key, problems.to_string());
        assert!(
            key == "joint[4]" && told.contains("contradict each other") && !told.contains("drop-"),
            "{problems}"
        );
    }
    let run = run(&format!("model = {{ drop-redundant-rows = true }}\n{text}"));
    // A parallelogram: the top keeps its direction.
    assert!(last(&run, "top.spin.y").abs() < 1e-8 && last(&run, "top.velocity.x") > 1e-3);
}

/// A load between two stations: the elements end there, and a tip bends by q (b³ (4L − b) − a³ (4L − a))/(24 EI).
#[test]
fn a_distributed_load_acts_between_its_ends() {
    let stiffness = 70e9 * std::f64::consts::PI * 1e-8 / 4.0;
    let case = |range: &str| {
        format!(
            "run = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n[[beam]]\nlength = 1\nroot = \"clamped\"\n\
             elements = 4\n{ROD}\n[[load]]\non = \"beam\"\nforce-per-length = [0, 0.01, 0]\n{range}\n"
        )
    };
    for (range, a, b) in [("", 0.0, 1.0), ("from = 0.3\nto = \"65 cm\"", 0.3, 0.65), ("from = 0.4", 0.4, 1.0)]
    {
        let bent = |x: f64| x.powi(3) * (4.0 - x);
        let exact = 0.01 * (bent(b) - bent(a)) / (24.0 * stiffness);
        let found = last(&run(&case(range)), "beam.tip.displacement.y");
        assert!((found / exact - 1.0).abs() < 1e-5, "{range}: {found} for {exact}");
    }
    for (range, key) in [("from = 1.2", "from"), ("to = 1.2", "to"), ("from = 0.5\nto = 0.4", "from")] {
        let Err(problems) = read(&case(range)) else { panic!("{range}") };
        let text = problems.to_string();
        assert!(text.contains(key) && text.contains("load[1]"), "{range}: {text}");
    }
}

/// A beam through points of a quarter of a circle is that of `arc`: as long, and it bends as far.
#[test]
fn a_centreline_through_points_of_an_arc_is_the_arc() {
    let angle = std::f64::consts::FRAC_PI_2;
    let case = |curve: &str| {
        format!(
            "gravity = [0, 0, -9.81]\nrun = {{ duration = 0 }}\ninitial = {{ kind = \"static\" }}\n[[beam]]\nroot = \"clamped\"\n\
             elements = 6\n{ROD}\n{curve}\n"
        )
    };
    let arc = case("length = 2\ncurve = { kind = \"arc\", angle = \"90 deg\", towards = [0, 1, 0] }");
    let (radius, n) = (2.0 / angle, 20);
    let list = |f: &dyn Fn(f64) -> f64| {
        let of = |i: usize| format!("{:?}", radius * f(angle * i as f64 / n as f64));
        format!("[{}]", (0..=n).map(of).collect::<Vec<_>>().join(", "))
    };
    let (x, y) = (list(&|a| a.sin()), list(&|a| 1.0 - a.cos()));
    let zeros = format!("[{}]", vec!["0"; n + 1].join(", "));
    let points = case(&format!("curve = {{ kind = \"points\", x = {x}, y = {y}, z = {zeros} }}"));
    let (arc, points) = (run(&arc), run(&points));
    for column in ["x", "y", "z"].map(|axis| format!("beam.tip.displacement.{axis}")) {
        let (a, b) = (last(&arc, &column), last(&points, &column));
        let size = last(&arc, "beam.tip.displacement.z").abs();
        assert!((a - b).abs() < 1e-5 * size, "{column}: {a} and {b}");
    }
    for (curve, key) in [
        ("length = 1\ncurve = { kind = \"points\", x = [0, 1, 2], y = [0, 0, 1], z = [0, 0, 0] }", "length"),
        ("curve = { kind = \"points\", x = [0, 1, 2], y = [0, 0], z = [0, 0, 0] }", "curve.y"),
        ("curve = { kind = \"points\", x = [0, 1], y = [0, 0], z = [0, 0] }", "curve.x"),
        (
            "start = [0, 0, 1]\ncurve = { kind = \"points\", x = [0, 1, 2], y = [0, 0, 1], z = [0, 0, 0] }",
            "start",
        ),
        ("curve = { kind = \"straight\" }", "length"),
    ] {
        let Err(problems) = read(&case(curve)) else { panic!("{curve}") };
        assert!(problems.to_string().contains(key), "{curve}: {problems}");
    }
}

/// A block that slides over the floor comes to rest after v²/(2 μ g) in the direction of its velocity.
#[test]
fn friction_in_space_acts_against_the_velocity() {
    let case = |method: &str| {
        format!(
            "gravity = [0, 0, -10]\nrun = {{ duration = \"1 s\" }}\n[[body]]\nname = \"block\"\nmass = 1\n\
             inertia = {{ kind = \"sphere\", radius = 0.1 }}\nvelocity = [0.6, 0.8, 0]\n\
             [[contact]]\non = \"block\"\nobstacle = {{ kind = \"plane\", point = [0, 0, 0], normal = [0, 0, 1] }}\n\
             law = {{ kind = \"constraint\", restitution = 0, friction = 0.25 }}\n[integrator]\nkind = \"{method}\"\n\
             step = \"1 ms\"\n[output]\nstep = \"0.01 s\"\n"
        )
    };
    for method in ["nonsmooth-generalized-alpha", "moreau-jean", "generalized-alpha"] {
        let run = run(&case(method));
        for (axis, part) in [("x", 0.6), ("y", 0.8)] {
            // v²/(2 μ g) = 0.2 m.
            let way = last(&run, &format!("block.position.{axis}"));
            assert!((way - 0.2 * part).abs() < 1e-3, "{method}: {way} for {}", 0.2 * part);
        }
        let names = columns(&run);
        assert!(names.contains(&"contact.friction.x") && names.contains(&"contact.friction.z"), "{names:?}");
    }
}

/// Between the steps of a run with contacts too: the steps of a ball in flight are as long as the run allows, 1 + v²/2g.
#[test]
fn the_top_of_a_flight_between_steps_is_found() {
    let run = run("gravity = [0, 0, \"-9.81 m/s^2\"]\n\
        body = [{ name = \"ball\", mass = 1, inertia = { kind = \"sphere\", radius = 0.1 }, position = [0, 0, 1], \
        velocity = [0, 0, 3] }]\n\
        contact = [{ on = \"ball\", obstacle = { kind = \"plane\", normal = [0, 0, 1], point = [0, 0, 0] }, \
        law = { kind = \"constraint\", restitution = 0.5 } }]\n\
        integrator = { kind = \"radau\", tolerance = 1e-8, max-step = 0.2 }\n\
        run = { duration = \"2 s\" }\n\
        output = { step = \"1 s\" }\n");
    let top = run.trajectory.extremes(run.trajectory.index("ball.position.z").unwrap());
    assert!((top.max - 1.0 - 9.0 / 19.62).abs() < 1e-9, "{top:?}");
    assert!((top.t_max - 3.0 / 9.81).abs() < 1e-9, "{top:?}");
}

#[test]
fn a_plane_has_a_normal_with_a_direction() {
    for normal in ["[0, 0, 0]", "[0.1, 0, -1e308]", "[0, 0, 1e-300]"] {
        let text = format!(
            "run = {{ duration = 1 }}\n[[body]]\nname = \"ball\"\nmass = 1\nposition = [0, 0, 1]\ninertia = {{ kind = \"sphere\", radius = 1 }}\n\
             [[contact]]\non = \"ball\"\nobstacle = {{ kind = \"plane\", normal = {normal} }}\nlaw = {{ kind = \"constraint\", restitution = 0.5 }}\n"
        );
        let problems = read(&text).map(|_| ()).unwrap_err();
        assert!(problems.to_string().contains("has no direction"), "{problems}");
    }
}

#[test]
fn a_section_that_makes_no_beam_in_space_says_which_key_is_missing() {
    let beam = |section: &str| {
        let text = format!(
            "run = {{ duration = 1 }}\n[[beam]]\nname = \"arm\"\nlength = 2\nroot = \"clamped\"\nsection = {{ {section} }}\n"
        );
        read(&text).map(|_| ()).unwrap_err().to_string()
    };
    let general = "kind = \"general\", mass-per-length = 1, axial-stiffness = 1e6, bending-stiffness = 100, \
                   bending-stiffness-across = 100, torsional-stiffness = 100";
    let message = beam(general);
    for word in ["beam `arm`", "give `polar-inertia`"] {
        assert!(message.contains(word), "{message}");
    }
    let message = beam(
        "kind = \"graded\", width = 0.01, height = 0.02, ceramic-modulus = 380e9, metal-modulus = 70e9, \
         ceramic-density = 3800, metal-density = 2700, exponent = 1",
    );
    assert!(message.contains("beams in space and blades do without; take `general`"), "{message}");
}

/// A whole beam is struck by what bulges; by what is flat or hollow it is touched at many places.
#[test]
fn a_beam_is_struck_anywhere_by_what_bulges_alone() {
    let touched = |contact: &str| {
        let text = format!(
            "run = {{ duration = \"1 ms\" }}\n[[beam]]\nname = \"arm\"\nlength = 2\nroot = \"clamped\"\n{ROD}\nelements = 2\n\
             [[contact]]\nname = \"stop\"\non = \"arm\"\nlaw = {{ kind = \"constraint\", restitution = 0.5 }}\n{contact}\n"
        );
        text
    };
    let run = run(&touched(
        "radius = 0.01\nobstacle = { kind = \"sphere\", centre = [1.3, 0, -0.1], radius = 0.05 }",
    ));
    let last = |column: &str| last(&run, column);
    assert!((last("stop.gap") - 0.04).abs() < 1e-6 && (last("stop.station") - 1.3).abs() < 1e-6);
    for (contact, word) in [
        (
            "obstacle = { kind = \"plane\", point = [0, 0, -1], normal = [0, 0, 1] }",
            "let the beam touch by points",
        ),
        ("obstacle = { kind = \"sphere\", radius = 5, inside = true }", "let the beam touch by points"),
        (
            "at = [1, 0, 0]\nobstacle = { kind = \"sphere\", centre = [0, 0, 1], radius = 0.5 }",
            "is a point of a body",
        ),
    ] {
        let message = read(&touched(contact)).map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    }
}

/// The figure of a beam that falls on a floor by its tip: the points that press most, which points are in contact at every time, the
/// first burst, and the floor, once, where it is seen from its edge.
#[test]
fn the_figure_of_a_whole_beam_in_contact_shows_the_points_that_press() {
    let text = format!(
        "gravity = [0, 0, -9.81]\nintegrator = {{ kind = \"radau\", tolerance = 1e-4 }}\nrun = {{ duration = 0.1 }}\n\
         output = {{ step = 0.002 }}\n[[beam]]\nlength = 2\nstart = [0, 0, 0.02]\nroot = \"clamped\"\nelements = 5\n{ROD}\n\
         [[contact]]\nname = \"floor\"\non = \"beam\"\npoints = 10\n\
         obstacle = {{ kind = \"plane\", point = [0, 0, 0], normal = [0, 0, 1] }}\nlaw = {{ kind = \"hertz\", stiffness = 1e6 }}\n"
    );
    let run = run(&text);
    let panels = spatial_figure(&run.scene, &run.trajectory, &run.events, None).panels;
    let panel = |quantity: &str| panels.iter().find(|panel| panel.y.quantity == quantity).unwrap();
    let mut pressing: Vec<(f64, String)> = (1..=10)
        .map(|k| format!("floor.{k}"))
        .map(|name| (run.trajectory.column(&format!("{name}.force")).unwrap(), name))
        .map(|(force, name)| (force.iter().fold(0.0, |a: f64, b| a.max(*b)), name))
        .filter(|(force, _)| *force > 0.0)
        .collect();
    pressing.sort_by(|a, b| b.0.total_cmp(&a.0));
    assert!((2..10).contains(&pressing.len()), "{pressing:?}");
    let mut names: Vec<&str> = pressing.iter().take(4).map(|(_, name)| name.as_str()).collect();
    names.sort_by_key(|name| name[6..].parse::<u32>().unwrap());
    for quantity in ["Gap g", "Normal force λ"] {
        let shown: Vec<&str> = panel(quantity).series.iter().filter_map(|s| s.name.as_deref()).collect();
        assert_eq!(shown, names, "{quantity}");
    }
    let mut stations: Vec<f64> = panel("Station in contact").series[0].points.iter().map(|p| p.1).collect();
    stations.sort_by(f64::total_cmp);
    stations.dedup();
    let mut expected: Vec<f64> =
        pressing.iter().map(|(_, name)| 0.2 * name[6..].parse::<f64>().unwrap()).collect();
    expected.sort_by(f64::total_cmp);
    assert!(stations.len() == expected.len());
    assert!(stations.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12), "{stations:?} {expected:?}");
    assert!(!panel("Gap, first burst").series[0].points.is_empty());
    let dashed = |panel: &Panel| panel.series.iter().filter(|series| series.line == Line::Dashed).count();
    assert_eq!(panels[..3].iter().map(dashed).collect::<Vec<_>>(), [0, 1, 1]);
}

/// A spring is drawn from its place on the ground to its place on a ball, and has the length that the case gives it.
#[test]
fn a_spring_is_drawn_between_its_ends() {
    let text = "run = { duration = 1 }\noutput = { step = 0.1 }\n[[body]]\nname = \"ball\"\nmass = 1\nposition = [1, 0, 0]\n\
                inertia = { kind = \"sphere\", radius = 0.05 }\n\
                [[spring]]\nkind = \"line\"\nname = \"cord\"\nbetween = [\"ground\", \"ball\"]\nfrom = [0, 0, 0]\nto = [0.9, 0, 0]\nstiffness = 4\nlength = 0.5\n";
    let run = run(text);
    let panels = spatial_figure(&run.scene, &run.trajectory, &run.events, None).panels;
    let ends =
        panels[0].series.iter().filter(|series| series.points.len() == 2 && series.points[0] == (0.0, 0.0));
    let drawn: Vec<f64> = ends.map(|series| series.points[1].0).collect();
    let ball = run.trajectory.column("ball.position.x").unwrap();
    let near = |x: f64| ball.iter().any(|ball| (x - (ball - 0.1)).abs() < 1e-6);
    assert!(drawn.len() == 9 && drawn.iter().all(|x| near(*x)), "{drawn:?} {ball:?}");
    assert!(drawn.iter().any(|x| *x < 0.8), "{drawn:?}");
}

#[test]
fn a_fibre_outside_of_all_sections_is_refused() {
    let text = |y: &str| {
        format!(
            "run={{duration=0}}\n[[beam]]\nlength=1\nroot='clamped'\nsection={{kind='circle',modulus='70 GPa',density=2700,radius='1 cm'}}\n\
             [[fibre]]\nname='top'\non='root'\ny='{y}'\n"
        )
    };
    let read = |y: &str| {
        let read = flexion_case::parse(text(y), std::path::Path::new("case.toml"), &[]);
        read.and_then(|reading| reading.prepare().map(drop)).map_err(|problems| problems.render(false))
    };
    assert_eq!(read("5 mm"), Ok(()));
    let said = read("1e308 mm").unwrap_err();
    assert!(said.contains("has the fibre `top` 1.000e305 m from its axis"), "{said}");
}

/// A `general` section of a beam with shear needs rotary inertia: which is missing, and what it would be of one material, is said.
#[test]
fn a_general_section_without_rotary_inertia_says_what_to_write() {
    let text = |inertia: &str| {
        format!(
            "run.duration = 0\n[[beam]]\nname = 'b'\nlength = 1\nup = [0, 1, 0]\nroot = 'clamped'\nshear = true\nsection = {{ kind = 'general', mass-per-length = 1.2, \
             axial-stiffness = 28e6, torsional-stiffness = 700, bending-stiffness = 930, bending-stiffness-across = 800, shear-stiffness = 1e7, \
             shear-stiffness-across = 1e7{inertia} }}\n"
        )
    };
    let read = |inertia: &str| flexion_case::parse(text(inertia), std::path::Path::new("case.toml"), &[]);
    for (inertia, says, not) in [
        ("", "`rotary-inertia` and `rotary-inertia-across` is 0", "the mass matrix"),
        (", rotary-inertia = 4e-5", "`rotary-inertia-across` is 0", "`rotary-inertia` "),
        (", rotary-inertia-across = 4e-5", "`rotary-inertia` is 0", "`rotary-inertia-across`"),
    ] {
        let message = read(inertia).err().unwrap().to_string();
        assert!(message.contains(says) && !message.contains(not), "{message}");
        let written = message.split("here ").nth(1).unwrap().split(' ').next().unwrap();
        // m EI/EA of the height, 1.2·930/28e6, or across, 1.2·800/28e6.
        let expected = if says.starts_with("`rotary-inertia-across") { "3.4286e-5" } else { "3.9857e-5" };
        assert_eq!(written, expected, "{message}");
    }
    assert!(read(", rotary-inertia = 4e-5, rotary-inertia-across = 3e-5").is_ok());
}

/// A body beside the plane takes a beam out of it whose section is known in it alone: the run says so, and none where it stays.
#[test]
fn a_planar_beam_that_leaves_its_plane_is_told() {
    const CASE: &str = "
model.coupling = 'space'
hub.motion = { kind = 'spin-up', speed = 3, time = 1 }
beam.length = 1
section = { kind = 'resultants', mass-per-length = 1, axial-stiffness = 1e6, bending-stiffness = 10 }
run.duration = '0.3 s'
body = [{ name = 'x', mass = 3, position = [1, 0, 0], inertia = { kind = 'sphere', radius = 0.1 } }]
joint = [{ kind = 'fixed', between = ['beam.tip', 'x'] }]
";
    let told = |set: &[&str]| {
        let run = crate::written::finished(&crate::written::reading(CASE, set));
        run.all_warnings().any(|said| said.contains("leaves the plane of x and y"))
    };
    assert!(told(&["body.1.position=[1, 0, 0.2]"]));
    assert!(told(&["body.1.spin=[0, 1, 0]", "body.1.inertia={kind='principal', moments=[0.1, 0.2, 0.3]}"]));
    assert!(!told(&[]));
}

/// Damping in proportion to the mass is that of lumped masses too, ζ = β/2ω of a light beam with a mass at its tip.
#[test]
fn lumped_masses_are_damped_with_their_beam_in_the_plane_and_in_space() {
    const CASE: &str = "
beam.length = '1 m'
section = { kind = 'resultants', mass-per-length = 1e-3, axial-stiffness = 1e6, bending-stiffness = 50 }
hub.motion = { kind = 'constant', speed = 0 }
mass = [{ on = 'tip', mass = 0.1 }]
damping.mass = 0.5
load = [{ on = 'tip', force = [0, 1] }]
run.duration = '2 s'
";
    let finals = |coupling: &str| {
        let run = crate::written::finished(&crate::written::reading(CASE, &[coupling]));
        ["tip.deflection", "energy.dissipated"]
            .map(|name| run.trajectory.column(name).and_then(|column| column.last().copied()).unwrap())
    };
    let [deflection, lost] = finals("model.coupling=exact");
    assert!(lost > 1e-3, "{lost}");
    let [in_space, lost_in_space] = finals("model.coupling=space");
    assert!((deflection - in_space).abs() < 1e-3 * 0.0133, "{deflection} {in_space}");
    assert!((lost / lost_in_space - 1.0).abs() < 3e-3, "{lost} {lost_in_space}");
}

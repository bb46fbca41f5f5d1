//! Contacts by the hundred: beams that lie down on a floor.

#![allow(clippy::unwrap_used)] // in helpers of tests

use super::verification::run::integrate;
use flexion::contact::{Augmented, RowLaw};
use flexion_case::{Reading, Run, parse};
use problem::Problem;
use std::ops::ControlFlow;
use std::path::Path;

#[path = "../examples/cones/problem.rs"]
mod problem;

/// A rod that falls flat.
const ROD: &str = "
gravity = [0, 0, -9.81]
run = { duration = 0.075 }
output = { step = '1 ms' }
[[beam]]
name = 'rod'
start = [0, 0, '2 cm']
length = 1
elements = 20
section = { kind = 'circle', modulus = '2 GPa', density = 1200, radius = '5 mm' }
[[contact]]
name = 'floor'
on = 'rod'
points = 100
obstacle = { kind = 'plane', normal = [0, 0, 1] }
law = { kind = 'constraint', restitution = 0, friction = 0.3 }
[integrator]
kind = 'nonsmooth-generalized-alpha'
step = '0.2 ms'
";

/// An arm on a hinge 1 mm above a floor, which it meets at ten points.
const ARM: &str = "
gravity = [0, -9.81]
run = { duration = 2 }
output = { step = '5 ms' }
beam = { length = 1 }
damping = { stiffness = '0.2 ms' }
section = { kind = 'circle', modulus = '2 GPa', density = 1200, radius = '5 mm' }
hub = { motion = { kind = 'free', angle = '2 deg' } }
model = { coupling = 'exact' }
basis = { kind = 'finite-elements', elements = 20 }
integrator = { kind = 'radau', tolerance = 1e-4 }
[[contact]]
name = 'floor'
on = 'beam'
points = 10
obstacle = { kind = 'plane', point = [0, '-1 mm'] }
law = { kind = 'constraint', restitution = 0 }
";

/// A box of 0.3 × 0.2 × 0.1 m that falls, tilted, on its four corners.
const BOX: &str = "
gravity = [0, 0, -9.81]
run = { duration = 1 }
output = { step = 0.01 }
integrator = { kind = 'nonsmooth-generalized-alpha', step = 0.001 }
[[body]]
name = 'box'
mass = 1
inertia = { kind = 'box', size = [0.3, 0.2, 0.1] }
position = [0, 0, 0.15]
axis = [0.09970865087213879, -0.04997916927067833, 0.9937606691655043]
across = [0.9950041652780258, 0, -0.09983341664682815]
";

/// Its corners in the fixed axes at the start.
const CORNERS: [[f64; 3]; 4] = [
    [-0.15473501645825702, -0.09737606757596272, 0.11031403087860295],
    [-0.15373709821236461, 0.10237398450303055, 0.12025992719889506],
    [0.14376623312515072, -0.09737606757596272, 0.0803640058845545],
    [0.14476415137104312, 0.10237398450303055, 0.09030990220484661],
];

fn read(text: &str) -> Reading {
    parse(text.to_owned(), Path::new("case.toml"), &[]).unwrap()
}

/// 20 elements have 8 velocities a node but for the last middle, whatever touches.
#[test]
fn a_beam_needs_no_nodes_where_points_touch() {
    let reading = read(ROD);
    assert_eq!(reading.case.system().unwrap().size().v, 8 * 21 - 1);
    // But friction on a radius asks for the rotation of a section.
    let rolls = ROD.replace("on = 'rod'", "on = 'rod'\nradius = '5 mm'");
    let reading = read(&rolls);
    assert_eq!(reading.case.system().unwrap().size().v, 8 * 101 - 1);
}

/// At rest it lies on what carries a beam of EI and the weight w per length whose root is h above its supports: it is free for (24 EI h/w)^¼ = 0.3995 m, and the
/// root has half of the weight of that. On supports 0.1 m apart the equations of three moments give what each carries.
#[test]
fn an_arm_that_lies_down_comes_to_rest_on_the_floor() {
    let run = integrate(&read(ARM)).unwrap();
    assert_eq!(run.failure, None);
    assert!(run.warnings.iter().any(|warning| warning.contains("contacts chatter")), "{:?}", run.warnings);
    let carried = [0.0, 0.0, 0.0, 0.2245, 0.1016, 0.0898, 0.094, 0.089, 0.1049, 0.0365];
    for (k, carried) in carried.into_iter().enumerate() {
        let force = run.column(&format!("floor.{}.force", k + 1)).last().copied().unwrap();
        assert!((force - carried).abs() < 1e-4, "{}: {force} {carried}", k + 1);
    }
    let speed = run.column("tip.deflection_velocity").last().copied().unwrap();
    assert!(speed.abs() < 1e-6, "{speed}");
    // Dampers and contacts take no more than gravity gives, in bursts neither; a tolerance of 1e-4 leaves 1.4e-5 J before the first of these.
    let column = |name: &str| run.column(name);
    let (total, dissipated, contact) =
        (column("energy.total"), column("energy.dissipated"), column("energy.contact_loss"));
    let given = total[0] - total.last().unwrap();
    for ((d, c), e) in dissipated.iter().zip(&contact).zip(&total) {
        assert!(*c >= 0.0 && *d >= 0.0 && d + c <= (total[0] - e) + 2e-5, "{d} {c} of {}", total[0] - e);
    }
    let taken = (dissipated.last().unwrap() + contact.last().unwrap()) / given;
    assert!(taken > 0.9, "{taken}");
}

/// A rod that falls flat and comes to rest in bursts takes m g T from the floor in all, whichever steps follow it: the momentum of its weight.
#[test]
fn the_impulses_of_all_contacts_of_a_rod_that_falls_flat_are_its_momentum() {
    let text = ROD
        .replace("duration = 0.075", "duration = 0.4")
        .replace("elements = 20", "elements = 10")
        .replace("points = 100", "points = 10")
        .replace("restitution = 0, friction = 0.3", "restitution = 0.3")
        .replace("kind = 'nonsmooth-generalized-alpha'\nstep = '0.2 ms'", "kind = 'radau'\ntolerance = 1e-4");
    let run = integrate(&read(&text)).unwrap();
    assert!(run.warnings.iter().any(|warning| warning.contains("contacts chatter")), "{:?}", run.warnings);
    let expected = 1200.0 * std::f64::consts::PI * 25e-6 * 9.81 * 0.4;
    let found: f64 = run.events.impulses().map(|(_, impulse)| impulse).sum();
    // The trapezium rule over forces that vibrate.
    assert!((found / expected - 1.0).abs() < 3e-3, "{found} for {expected}");
}

/// 400 points that leave the floor one after the other within 1e-7 s, as the vibrations of a rod have it, do so in a few events: what the run costs is then
/// the points themselves, and the motion converges with them.
#[test]
fn many_points_that_leave_next_to_at_once_are_few_events() {
    let of = |points: &str| -> Run {
        let text = ROD
            .replace("points = 100", points)
            .replace(
                "kind = 'constraint', restitution = 0, friction = 0.3",
                "kind = 'hunt-crossley', stiffness = 1e6, restitution = 0.5",
            )
            .replace(
                "kind = 'nonsmooth-generalized-alpha'\nstep = '0.2 ms'",
                "kind = 'radau'\ntolerance = 1e-6",
            );
        read(&text).prepare().unwrap().run(&mut |_| ControlFlow::Continue(()))
    };
    let [few, more, many] = ["points = 20", "points = 100", "points = 400"].map(of);
    let residuals = [&few, &many].map(|run| run.counters.residuals);
    assert!(residuals[1] < 2 * residuals[0], "{residuals:?}");
    assert_eq!(many.events.list.len(), 2 * 401);
    let [few, more, many] = [few, more, many].map(|run| {
        let column = run.trajectory.index("rod.tip.velocity.z").unwrap();
        run.trajectory.extremes(column).last
    });
    // The force per length is summed up by the trapezium rule, whose error falls with the square of the spacing.
    let order = ((few - many) / (more - many)).ln() / 5.0_f64.ln();
    assert!((order - 2.0).abs() < 0.1 && (more / many - 1.0).abs() < 2e-3, "{few} {more} {many}: {order}");
}

/// A rod that falls flat on 49 points of 16 elements, more than the motions that they hold. By events, every other point strikes as the rest open, and 1e-7 s later the other way
/// round: nonsmooth steps take it to rest, with its weight ρAgL on the points.
#[test]
fn more_points_than_motions_are_left_to_nonsmooth_steps() {
    let text = ROD
        .replace("elements = 20", "elements = 16")
        .replace("points = 100", "points = 48")
        .replace(", friction = 0.3", "")
        .replace("kind = 'nonsmooth-generalized-alpha'\nstep = '0.2 ms'", "kind = 'radau'\ntolerance = 1e-5");
    let run = integrate(&read(&text)).unwrap();
    assert_eq!(run.failure, None);
    assert!(run.warnings.iter().any(|w| w.contains("more of them than motions")), "{:?}", run.warnings);
    let last = |k: usize, name: &str| {
        run.trajectory.extremes(run.trajectory.index(&format!("floor.{k}.{name}")).unwrap()).last
    };
    let weight: f64 = (1..=49).map(|k| last(k, "force")).sum();
    let exact = 1200.0 * std::f64::consts::PI * 25e-6 * 9.81;
    assert!((weight / exact - 1.0).abs() < 0.02, "{weight} {exact}");
    assert!((1..=49).all(|k| last(k, "gap").abs() < 1e-9));
}

/// Twelve rows with friction, six of which follow from the others: the box comes to rest on its face, bears its weight, m g, and has m g h/2 = 0.4905 J left.
#[test]
fn a_tilted_box_that_falls_on_its_corners_comes_to_rest() {
    let contacts: String = CORNERS
        .iter()
        .enumerate()
        .map(|(i, at)| {
            format!(
                "[[contact]]\nname = 'c{i}'\non = 'box'\nat = {at:?}\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\n\
                 law = {{ kind = 'constraint', restitution = 0, friction = 0.3 }}\n"
            )
        })
        .collect();
    let run = integrate(&read(&format!("{BOX}{contacts}"))).unwrap();
    assert_eq!(run.failure, None);
    let trajectory = &run.trajectory;
    let last = |name: &str| trajectory.extremes(trajectory.index(name).unwrap()).last;
    let weight: f64 = (0..4).map(|i| last(&format!("c{i}.force"))).sum();
    assert!((weight - 9.81).abs() < 1e-6, "{weight}");
    assert!((last("energy.total") - 0.4905).abs() < 1e-6, "{}", last("energy.total"));
    let energy: Vec<f64> = trajectory.values(trajectory.index("energy.total").unwrap()).collect();
    let gained = energy.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0_f64, f64::max);
    assert!(gained < 1e-9, "{gained:e}");
}

/// Cone problems of steps of twelve balls in a tube, 87 rows of rank 71, on which Newton's method goes to and fro: gradients settle one. Of the other, whose b lies beside the range
/// of W, no forces fit the motion, and it is told what is left.
#[test]
fn a_heap_settles() {
    let read = |text| Problem::read(text).unwrap();
    let problem = read(include_str!("../../benches/cones/problems/heap_87_rows_later.json"));
    let Problem { matrix, order, rows, laws, b, .. } = &problem;
    let mut factored = matrix.clone();
    factored.factor().unwrap();
    let mut many = Augmented::default();
    many.keep(matrix, *order);
    let [y, forces] = problem.solve(&mut many, &mut factored).unwrap();
    assert!(many.residual < 1e-10 && many.unsettled == 0.0);
    let largest = forces.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    for (i, _) in laws.iter().enumerate().filter(|(_, law)| **law == RowLaw::Unilateral) {
        let rate = |i: usize| b[i] + rows[i].iter().map(|(j, g)| g * y[*j]).sum::<f64>();
        let friction =
            || (0..laws.len()).filter(|k| matches!(laws[*k], RowLaw::Friction { normal, .. } if normal == i));
        let slides = friction().map(rate).fold(0.0, f64::hypot);
        let holds = friction().map(|k| forces[k]).fold(0.0, f64::hypot);
        assert!(forces[i] >= 0.0 && rate(i) > -1e-9 && forces[i] * rate(i).abs() < 1e-9 * largest);
        assert!(holds <= 0.3 * forces[i] * (1.0 + 1e-9));
        if slides > 1e-8 && forces[i] > 1e-6 * largest {
            assert!(holds > 0.3 * forces[i] * (1.0 - 1e-4), "{i}: {slides} {holds} {}", forces[i]);
        }
    }

    let problem = read(include_str!("../../benches/cones/problems/heap_87_rows_beside.json"));
    let mut factored = problem.matrix.clone();
    factored.factor().unwrap();
    many.keep(&problem.matrix, problem.order);
    assert!(problem.solve(&mut many, &mut factored).is_err());
    let mut many = Augmented::default().lenient();
    many.keep(&problem.matrix, problem.order);
    problem.solve(&mut many, &mut factored).unwrap();
    assert!(
        many.unsettled == many.residual && many.residual > 1e-8 && many.residual < 1e-5,
        "{}",
        many.residual
    );
}

/// A box that falls on its corner with friction: the impulse that e = 0.9 asks for adds energy there (Kane's paradox), and without restitution it takes some.
#[test]
fn an_impact_that_adds_energy_says_so() {
    let text = |restitution: f64| {
        let mut text = "gravity = [0, 0, -9.81]\nrun = { duration = 0.13 }\noutput = { step = '1 ms' }\nintegrator = { kind = 'radau' }\n[[body]]\nname = 'box'\nmass = 1\n\
            inertia = { kind = 'box', size = [0.1, 0.08, 0.06] }\nposition = [0, 0, 0.1]\nvelocity = [-0.466, -0.628, 0]\nspin = [1.77, -1.62, -0.36]\n"
            .to_owned();
        for (x, y, z) in [(0.05, 0.04, 0.07), (0.05, -0.04, 0.07), (-0.05, 0.04, 0.07), (-0.05, -0.04, 0.07)]
        {
            text.push_str(&format!(
                "[[contact]]\non = 'box'\nat = [{x}, {y}, {z}]\nobstacle = {{ kind = 'plane', normal = [0, 0, 1] }}\nlaw = {{ kind = 'constraint', restitution = {restitution}, friction = 0.4 }}\n"
            ));
        }
        text
    };
    for restitution in [0.9, 0.0] {
        let run = integrate(&read(&text(restitution))).unwrap();
        assert_eq!(run.failure, None);
        let total = run.column("energy.total");
        let gained = total.windows(2).any(|pair| pair[1] > pair[0] + 0.1);
        let told = run.warnings.iter().any(|warning| warning.contains("adds"));
        assert_eq!([gained, told], [restitution > 0.0; 2], "{restitution}: {:?}", run.warnings);
    }
}

/// So many balls of 2 cm and 0.26 kg that fall into a tube of 12 × 12 cm, three of them in a row from wall to wall, and touch each other.
fn heap(balls: usize, integrator: &str) -> String {
    let law = "law = { kind = 'constraint', restitution = 0.3, friction = 0.3 }\nradius = '2 cm'\n";
    let mut text = format!(
        "gravity = [0, 0, -9.81]\nintegrator = {integrator}\nrun = {{ duration = 0.9 }}\noutput = {{ step = '5 ms' }}\n"
    );
    let part = |i: usize, ratio: f64| 0.06 * ((ratio * i as f64).fract() - 0.5);
    for i in 0..balls {
        let place = [part(i, 0.618), part(i, 0.414), 0.03 + 0.045 * i as f64];
        text.push_str(&format!(
            "[[body]]\nname = 'b{i}'\nmass = 0.26\ninertia = {{ kind = 'sphere', radius = '2 cm' }}\nposition = {place:?}\n"
        ));
    }
    for i in 0..balls {
        let walls = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        for (k, normal) in walls.into_iter().enumerate() {
            let point = normal.map(|x: f64| if k == 0 { 0.0 } else { -0.06 * x });
            text.push_str(&format!(
                "[[contact]]\nname = 'w{k}-{i}'\non = 'b{i}'\nobstacle = {{ kind = 'plane', normal = {normal:?}, point = {point:?} }}\n{law}"
            ));
        }
        for j in i + 1..balls {
            text.push_str(&format!(
                "[[contact]]\nname = 'c{i}-{j}'\non = 'b{i}'\nmount = 'b{j}'\nobstacle = {{ kind = 'sphere', radius = '2 cm' }}\n{law}"
            ));
        }
    }
    text
}

/// A heap of 68 contacts, more of which close than its balls have motions, comes to rest by every method that resolves contacts in its steps, and the floor carries it.
#[test]
fn a_heap_comes_to_rest_and_the_floor_carries_its_weight() {
    for integrator in ["nonsmooth-generalized-alpha", "moreau-jean"] {
        let text = heap(8, &format!("{{ kind = '{integrator}', step = '0.5 ms' }}"));
        let run = integrate(&read(&text)).unwrap();
        assert_eq!(run.failure, None, "{integrator}");
        let last = |name: String| run.column(&name).last().copied().unwrap();
        let weight = 8.0 * 0.26 * 9.81;
        let carried: f64 = (0..8).map(|i| last(format!("w0-{i}.force"))).sum();
        assert!((carried / weight - 1.0).abs() < 1e-9, "{integrator}: {carried} of {weight}");
        assert!(last("energy.kinetic".to_owned()) < 2e-3, "{integrator}");
        // They have fallen by 3.7 J.
        let balance = run.column("energy.balance").iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        assert!(balance < 0.037, "{integrator}: {balance}");
    }
}

/// In one of six steps of a heap no forces fit the motion to 1e-8: what is left is told. (Another order of the operations may find some that do.)
#[test]
fn forces_that_do_not_settle_are_told() {
    let run = integrate(&read(include_str!("heap.toml"))).unwrap();
    assert_eq!(run.failure, None);
    let told = |warning: &String| warning.contains("the forces of contacts did not settle");
    assert!(run.warnings.iter().any(told), "{:?}", run.warnings);
}

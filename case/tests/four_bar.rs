//! Bauchau's flexible four-bar mechanism against a program with another formulation.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::parse;
use flexion_results::Status;
use std::ops::ControlFlow;
use std::path::Path;

/// Place of C from its start \[m\] at some times \[s\], by beams on SE(3) with shear, 8 elements of two nodes a bar and steps of 4 ms: rows of
/// `examples/beam_fourbar/beam_fourbar.h5` of V. Sonneville's `mb_sef_py` (github.com/vspsonn/mb_sef_py, 2021). The relative rotations in that
/// file have the axis (0, −sin 5°, cos 5°) at C.
const PLACES: [(f64, [f64; 3]); 11] = [
    (1.0, [0.0677484, -0.0209563, -0.000565]),
    (2.0, [0.1118235, -0.0765951, -0.002670]),
    (3.0, [0.0944681, -0.0461221, -0.003335]),
    (4.0, [-0.0325274, -0.0044973, -0.000811]),
    (5.0, [-0.0891286, -0.0396502, 0.000025]),
    (6.0, [-0.1101172, -0.0723144, -0.000517]),
    (7.0, [-0.1181727, -0.0992593, -0.001965]),
    (9.0, [-0.0927312, -0.0438568, -0.001577]),
    (10.0, [-0.0335268, -0.0047789, -0.000259]),
    (11.0, [0.0373809, -0.0059708, -0.000097]),
    (12.0, [0.0952253, -0.0470039, -0.001514]),
];

/// Bars of 16 mm × 16 mm and 8 mm × 8 mm of steel, and the speed of the crank: O. A. Bauchau & others (2016, doi 10.1007/s11044-016-9514-y).
fn mechanism() -> String {
    let thick = "{ kind = \"general\", mass-per-length = 1.997, axial-stiffness = 52.99e6, torsional-stiffness = 733.5, \
                 bending-stiffness = 1131, bending-stiffness-across = 1131 }\npolar-inertia = 85.2e-6";
    let thin = "{ kind = \"general\", mass-per-length = 0.4992, axial-stiffness = 13.25e6, torsional-stiffness = 45.84, \
                bending-stiffness = 70.66, bending-stiffness-across = 70.66 }\npolar-inertia = 5.324e-6";
    let bar = |name: &str, length: f64, start: &str, direction: &str, more: &str| {
        format!(
            "[[beam]]\nname = \"{name}\"\nlength = {length}\nelements = 8\nstart = {start}\ndirection = {direction}\n\
             section = {more}\n"
        )
    };
    let joint = |name: &str, parts: &str, more: &str| {
        format!("[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\nbetween = [{parts}]\n{more}\n")
    };
    let (sin, cos) = 5.0_f64.to_radians().sin_cos();
    [
        "run = { duration = 12 }\noutput = { step = 0.2, plots = false }\n\
         integrator = { kind = \"generalized-alpha\", step = \"4 ms\", spectral-radius = 0.0 }\n"
            .to_owned(),
        bar("crank", 0.12, "[0, 0, 0]", "[0, 1, 0]", &format!("{thick}\nspin = [0, 0, -0.6]")),
        bar("coupler", 0.24, "[0, 0.12, 0]", "[1, 0, 0]", &format!("{thick}\nvelocity = [0.072, 0, 0]")),
        bar(
            "rocker",
            0.12,
            "[0.24, 0.12, 0]",
            "[0, -1, 0]",
            &format!("{thin}\nvelocity = [0.072, 0, 0]\nspin = [0, 0, -0.6]"),
        ),
        joint("A", "\"ground\", \"crank.root\"", "motion = { kind = \"constant\", speed = -0.6 }"),
        joint("B", "\"crank.tip\", \"coupler.root\"", ""),
        joint("C", "\"coupler.tip\", \"rocker.root\"", &format!("axis = [0, {}, {cos}]", -sin)),
        joint("D", "\"rocker.tip\", \"ground\"", ""),
    ]
    .concat()
}

/// Shear, which the other program has, adds 3 EI/(kGA L²) = 1.4 % to the deflection of the crank, and less than a hundredth of a millimetre to
/// the place of C.
#[test]
fn a_joint_out_of_line_moves_a_four_bar_out_of_its_plane() {
    let reading =
        parse(mechanism(), Path::new("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let run = reading.prepare().unwrap_or_else(|p| panic!("{p}")).run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    let column = |name: &str| run.trajectory.column(name).unwrap();
    let times = run.trajectory.times();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let found = column(&format!("coupler.tip.displacement.{name}"));
        for (time, place) in PLACES {
            let row = times.iter().position(|t| (t - time).abs() < 1e-9).unwrap();
            let off = (found[row] - place[axis]).abs();
            assert!(off < 1e-5, "{name} at {time} s: {} for {}", found[row], place[axis]);
        }
    }
}

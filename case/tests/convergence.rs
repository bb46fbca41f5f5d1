//! Orders of convergence in the mesh and in the step, measured on P1's spin-up.

#![allow(clippy::unwrap_used, clippy::panic)]

use crate::verification::run::{Run, case, run};

/// A spin-up of P1's beam to 4 rad/s in a third of the time, which bends it more.
const QUICK: [&str; 3] = ["run.duration=6", "hub.motion.time=5", "output.step=0.1"];
/// Integration whose error is far below that of the meshes.
const EXACT_IN_TIME: &str = "integrator={kind='radau',tolerance=1e-10,absolute-tolerance=1e-13}";

fn quick(folder: &str, overrides: &[&str]) -> Run {
    let run = run(folder, &[&QUICK[..], overrides].concat());
    assert_eq!(run.failure, None, "{overrides:?}");
    run
}

/// Largest difference of a column.
fn distance(a: &Run, b: &Run, column: &str) -> f64 {
    let (a, b) = (a.column(column), b.column(column));
    assert_eq!(a.len(), b.len());
    a.iter().zip(&b).fold(0.0, |worst, (a, b)| worst.max((a - b).abs()))
}

/// Order between the last two of runs refined by a factor of 2.
fn order(errors: &[f64]) -> f64 {
    let [.., before, last] = errors else { panic!("one run has no order") };
    (before / last).log2()
}

fn meshes(folder: &str, axial_degree: Option<u32>, sizes: &[u32], column: &str) -> Vec<f64> {
    let basis = |elements: u32| {
        let degree = axial_degree.map_or(String::new(), |degree| format!(",axial-degree={degree}"));
        format!("basis={{kind='finite-elements',elements={elements}{degree}}}")
    };
    // Integrated to 1e-8 m.
    let fine = "integrator={kind='radau',tolerance=1e-8,absolute-tolerance=1e-10}";
    let reference = quick(folder, &[&basis(80), fine]);
    let error = |n: &u32| distance(&quick(folder, &[&basis(*n), fine]), &reference, column);
    sizes.iter().map(error).collect()
}

#[test]
fn the_tip_deflection_of_cubic_elements_converges_with_the_fourth_power_of_their_size() {
    for folder in ["p1_spin_up_4", "p1_spin_up_4/exact"] {
        let errors = meshes(folder, None, &[5, 10, 20], "tip.deflection");
        let order = order(&errors);
        eprintln!("{folder}: {errors:?}: order {order:.2}");
        assert!((3.7..4.4).contains(&order), "{folder}: order {order} from {errors:?}");
    }
}

/// At the tip of a straight beam in steady rotation, whose stretch is known in closed form. Linear elements
/// are of order 2 there, and quadratic ones of order 4.
#[test]
fn the_stretch_converges_with_the_square_of_the_size_of_linear_elements_and_the_fourth_power_of_quadratic_ones()
 {
    // A soft beam that rotates fast, so that errors stand out of rounding.
    let soft = ["section.modulus=0.7 GPa", "hub.motion.speed=40", "run.duration=0.01", "output.step=0.01"];
    let k = 40.0 / (0.7e9_f64 / 3000.0).sqrt();
    let stretch = (k * 10.0).tan() / k - 10.0;
    for (degree, expected) in [(1, 2.0), (2, 4.0)] {
        let error = |n: u32| {
            let basis = format!("basis={{kind='finite-elements',elements={n},axial-degree={degree}}}");
            let run = run("steady_rotation/first", &[&soft[..], &[&basis]].concat());
            (run.column("tip.axial")[0] - stretch).abs()
        };
        let errors = [2, 4, 8].map(error);
        let order = order(&errors);
        eprintln!("axial degree {degree}: {errors:?}: order {order:.2}");
        assert!((order - expected).abs() < 0.2, "degree {degree}: order {order} from {errors:?}");
    }
}

/// The error of bending modes falls with their number at least like n⁻⁴, because the moment vanishes at the tip.
#[test]
fn assumed_modes_converge_with_their_number() {
    let error = |n: u32| {
        let basis = format!("basis={{kind='modes',axial=10,transverse={n}}}");
        let reference = "basis={kind='modes',axial=10,transverse=24}";
        let reference = quick("p1_spin_up_4", &[reference, EXACT_IN_TIME]);
        distance(&quick("p1_spin_up_4", &[&basis, EXACT_IN_TIME]), &reference, "tip.deflection")
    };
    let errors = [3, 6, 12].map(error);
    eprintln!("modes: {errors:?}: order {:.2}", order(&errors));
    assert!(order(&errors) > 3.5, "{errors:?}");
}

#[test]
fn radial_point_interpolation_converges_with_its_nodes() {
    let basis = |nodes: u32| format!("basis={{kind='radial',nodes={nodes}}}");
    let elements = "basis={kind='finite-elements',elements=80,axial-degree=2}";
    let reference = quick("p1_spin_up_4", &[elements, EXACT_IN_TIME]);
    let error =
        |n: u32| distance(&quick("p1_spin_up_4", &[&basis(n), EXACT_IN_TIME]), &reference, "tip.deflection");
    let errors = [6, 11, 21].map(error);
    eprintln!("radial: {errors:?}: order {:.2}", order(&errors));
    assert!(order(&errors) > 2.0, "{errors:?}");
}

#[test]
fn the_three_bases_agree_when_refined() {
    let elements = quick("p1_spin_up_4", &["basis={kind='finite-elements',elements=40,axial-degree=2}"]);
    let peak = elements.trajectory.extremes(elements.trajectory.index("tip.deflection").unwrap()).min.abs();
    for basis in ["{kind='modes',axial=12,transverse=8}", "{kind='radial',nodes=21}"] {
        let other = quick("p1_spin_up_4", &[&format!("basis={basis}")]);
        let off = distance(&elements, &other, "tip.deflection") / peak;
        eprintln!("{basis}: {off:.2e} of the peak");
        assert!(off < 1e-3, "{basis}: {off:.2e}");
    }
}

/// Errors of a fixed-step method against Radau, at steps h, h/2 and h/4.
fn steps(folder: &str, basis: &str, kind: &str, h: f64) -> Vec<f64> {
    let reference = quick(folder, &[basis, EXACT_IN_TIME]);
    let error = |part: &f64| {
        let integrator = format!("integrator={{kind={kind},step={:?}}}", h / part);
        distance(&quick(folder, &[basis, &integrator]), &reference, "tip.deflection")
    };
    [1.0, 2.0, 4.0].iter().map(error).collect()
}

#[test]
fn implicit_methods_converge_with_the_square_of_the_step() {
    for (folder, h) in [("p1_spin_up_4", 0.02), ("p1_spin_up_4/exact", 0.01)] {
        for kind in ["'newmark'", "'hht',alpha=0.1", "'generalized-alpha',spectral-radius=0.5"] {
            let errors = steps(folder, "basis.elements=6", kind, h);
            let order = order(&errors);
            eprintln!("{folder} {kind}: {errors:?}: order {order:.2}");
            assert!((order - 2.0).abs() < 0.15, "{folder} {kind}: order {order} from {errors:?}");
        }
    }
}

#[test]
fn explicit_methods_converge_with_the_fourth_power_of_the_step() {
    // Soft along its axis, so that stable steps are long enough for errors to stand out of rounding.
    let section =
        "section={kind='resultants',mass-per-length=1.2,axial-stiffness=2e4,bending-stiffness=1.4e4}";
    let soft = [section, "hub.motion.speed=1"];
    for (kind, h) in [("'runge-kutta-4'", 16e-3), ("'adams-4'", 3.8e-3)] {
        let basis = "basis={kind='modes',axial=1,transverse=2}";
        let case = |integrator: &str| quick("p1_spin_up_4", &[&soft[..], &[basis, integrator]].concat());
        let reference = case(EXACT_IN_TIME);
        let error = |part: f64| {
            let integrator = format!("integrator={{kind={kind},step={:?}}}", h / part);
            distance(&case(&integrator), &reference, "tip.deflection")
        };
        let errors = [1.0, 2.0].map(error);
        let order = order(&errors);
        eprintln!("{kind}: {errors:?}: order {order:.2}");
        assert!((order - 4.0).abs() < 0.4, "{kind}: order {order} from {errors:?}");
    }
}

#[test]
fn the_error_of_radau_follows_its_tolerance() {
    for folder in ["p1_spin_up_4", "p1_spin_up_4/exact"] {
        let reference = quick(folder, &[EXACT_IN_TIME]);
        let error = |tolerance: f64| {
            let set = format!(
                "integrator={{kind='radau',tolerance={tolerance:?},absolute-tolerance={:?}}}",
                tolerance / 100.0
            );
            distance(&quick(folder, &[&set]), &reference, "tip.deflection")
        };
        let errors = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8].map(error);
        eprintln!("{folder}: tolerances 1e-4 to 1e-8: {errors:?}");
        for (error, tolerance) in errors.iter().zip([1e-4, 1e-5, 1e-6, 1e-7, 1e-8]) {
            // The tip deflects by about 1 m; the error accumulates over the run.
            assert!(*error < 10.0 * tolerance, "{folder}: {error:.2e} with the tolerance {tolerance:.0e}");
        }
        assert!(errors[4] < 1e-2 * errors[0], "{folder}: {errors:?}");
    }
}

/// The assembled stiffness of n elements, times their displacements, loses up to n⁴ε of the deflection: which the run
/// says. With a fixed step, whose error is the same on all meshes.
#[test]
fn fine_meshes_lose_no_more_than_their_caution_says() {
    let step = "integrator={kind='newmark',step='5 ms'}";
    for more in [&[] as &[&str], &["damping={stiffness='1 ms'}"]] {
        let mesh = |elements: u32| {
            let basis = format!("basis={{kind='finite-elements',elements={elements}}}");
            let set = [&[basis.as_str(), step, "hub.motion.time=2", "run.duration=1.5"], more].concat();
            let cautions = case("p1_spin_up_4", &set).unwrap().build().unwrap().system.cautions(&[]);
            assert_eq!(cautions.iter().any(|c| c.contains("rounding")), elements > 260, "{cautions:?}");
            let run = run("p1_spin_up_4", &set);
            assert_eq!(run.failure, None, "{set:?}");
            run
        };
        let coarse = mesh(100);
        let peak = coarse.column("tip.deflection").iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        for elements in [250, 640, 2560] {
            let off = distance(&coarse, &mesh(elements), "tip.deflection") / peak;
            let allowed = f64::from(elements).powi(4) * f64::EPSILON;
            assert!(peak > 0.1 && off < allowed, "{more:?}, {elements}: {off:.1e} of {peak} m");
        }
    }
}

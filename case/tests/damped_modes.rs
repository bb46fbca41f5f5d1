//! Modes of strongly damped beams, and the errors of frequencies by the mesh, of modes and of Campbell diagrams.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use super::decks::{BLADES, texts};
use crate::written::reading;
use flexion_case::{Contents, Diagram, DiagramRequest, FoundModes, ModesRequest, Reading, parse_with};
use flexion_results::{Frequencies, Units};
use std::path::Path;
use std::sync::Arc;

const UNITS: Units = Units { speed: Frequencies::RADIANS, frequency: Frequencies::RADIANS };

fn modes(reading: &Reading, speed: f64, count: usize) -> FoundModes {
    let request = ModesRequest { speed, count, free_hub: false, units: UNITS, film: false };
    reading.modes(&request).unwrap_or_else(|error| panic!("{error}"))
}

fn diagram(reading: &Reading, speeds: &[f64], count: usize) -> Diagram {
    let request = DiagramRequest {
        speeds: speeds.to_vec(),
        count,
        revolutions: 1,
        margin: 5.0,
        free_hub: false,
        threads: 1,
        units: UNITS,
    };
    reading.campbell(&request, &|_, _| true).unwrap_or_else(|error| panic!("{error}"))
}

/// A published blade whose damping is so many times that of its deck.
fn damped_blade(factor: f64) -> Reading {
    let [primary, blade] = texts(0);
    let mut lines: Vec<String> = blade.lines().map(str::to_owned).collect();
    let at = lines.iter().position(|line| line.contains("mu1")).unwrap() + 2;
    let mu = lines[at].split_whitespace().map(|mu| format!("{:e}", factor * mu.parse::<f64>().unwrap()));
    lines[at] = mu.collect::<Vec<_>>().join(" ");
    let files: Contents = BLADES[0]
        .into_iter()
        .zip([primary, lines.join("\n")])
        .map(|(name, text)| (name.to_owned(), Arc::from(text.into_bytes())))
        .collect();
    let text = format!(
        "run = {{ duration = 0 }}\n[[beam]]\nstart = [3.97, 0, 0]\nup = [0, 1, 0]\nroot = \"clamped\"\nshear = true\n\
         section = {{ kind = \"deck\", file = \"{}\", format = \"beamdyn\" }}\n[rotation]\naxis = [0, 0, -1]\n",
        BLADES[0][0]
    );
    parse_with(text, Path::new("case.toml"), &[], &files).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The damping of a blade differs from strain to strain, and its overdamped motions crowd about many rates, none of which a space of moderate dimension
/// holds: the vibrations that there are left are found, and a mesh of twice the elements has the same.
#[test]
fn a_blade_keeps_the_vibrations_that_strong_damping_leaves() {
    let found = modes(&damped_blade(100.0), 0.0, 13).modes.modes;
    assert_eq!(found.len(), 3);
    let diagram = diagram(&damped_blade(30.0), &[0.0, 1.0], 6);
    assert!(
        diagram.incomplete.is_empty() && diagram.campbell.branches.len() >= 6,
        "{:?}",
        diagram.incomplete
    );
    assert!(diagram.campbell.branches.iter().all(|branch| branch.points.len() >= 2));
    let points = diagram.campbell.branches.iter().flat_map(|branch| &branch.points);
    for mode in found.iter().chain(points.map(|point| &point.mode)) {
        assert!(mode.mesh.unwrap() < 1e-5 * mode.eigenvalue.norm(), "{:?}: {:?}", mode.eigenvalue, mode.mesh);
    }
}

/// The Coriolis forces couple motions along the beam with some across that decay as fast, about 1/η, and make pairs of them that would vibrate once in ten hours
/// and are gone in a second: they are no modes. Those of a finer mesh are others, and no error of a mode is one of them.
#[test]
fn what_fades_before_it_vibrates_is_no_mode_and_gives_no_error() {
    let case = |coupling: &str| {
        reading(
            &format!(
                "[beam]\nlength=10\n[section]\nkind='rectangle'\nmodulus=7e10\ndensity=2700\nwidth=0.1\nheight=0.1\n[hub]\nradius=1\n\
                 [model]\ncoupling='{coupling}'\n[basis]\nelements=16\n[damping]\nstiffness=0.01\n[run]\nduration=0\n"
            ),
            &[],
        )
    };
    let of = |coupling: &str| modes(&case(coupling), 10.334, 12).modes.modes;
    let (shear, slender) = (of("space-shear"), of("space"));
    assert_eq!([shear.len(), slender.len()], [8, 8]);
    for (a, b) in shear.iter().zip(&slender) {
        assert!(
            (a.frequency() / b.frequency() - 1.0).abs() < 0.01,
            "{} and {}",
            a.frequency(),
            b.frequency()
        );
        assert!(a.mesh.unwrap() < 1e-5 * a.frequency(), "{} ± {:?}", a.frequency(), a.mesh);
    }
}

/// A round shaft in two bearings with internal damping, whose whirls pass each other: the error of a frequency is that of its own whirl, in a diagram as by itself.
#[test]
fn a_whirl_has_the_error_of_the_mesh_in_a_diagram_that_it_has_by_itself() {
    let shaft = "run={duration=0}\nrotation={axis=[1,0,0]}\n[[beam]]\nname='s'\nlength=2\nup=[0,1,0]\nroot='free'\nelements=16\ndamping={stiffness=1e-4}\n\
                 section={kind='circle',modulus=210e9,density=7850,radius=0.02}\n[[joint]]\nkind='spherical'\nbetween=['ground','s.root']\n\
                 [[joint]]\nkind='cylindrical'\nbetween=['ground','s.tip']\naxis=[1,0,0]\n";
    let case = reading(shaft, &[]);
    let found = diagram(&case, &[0.0, 150.0, 300.0], 4);
    let alone = modes(&case, 150.0, 6).modes.modes;
    for branch in &found.campbell.branches {
        let point = branch.points.iter().find(|point| point.speed == 150.0).unwrap();
        let frequency = point.mode.frequency();
        let Some(mode) = alone.iter().find(|mode| (mode.frequency() - frequency).abs() < 1e-6 * frequency)
        else {
            continue;
        };
        let [error, expected] = [&point.mode, mode].map(|mode| mode.mesh.unwrap());
        assert!((error / expected - 1.0).abs() < 1e-2, "{frequency}: ± {error} and ± {expected}");
        assert!(expected < 1e-3 * frequency, "{frequency} ± {expected}");
    }
}

/// The full tangent of the coupling `high` takes 300 elements at most: of 200 there is no mesh of twice as many, and modes say so.
#[test]
fn errors_by_the_mesh_that_are_missing_have_a_reason() {
    let case = reading(
        "[beam]\nlength=10\n[section]\nkind='uniform'\nmodulus=7e10\ndensity=3000\narea=4e-4\nsecond-moment=2e-7\n[hub]\nmotion={kind='constant',speed=1}\n\
         [model]\ncoupling='high'\n[basis]\nelements=151\n[run]\nduration=1\n",
        &[],
    );
    let found = modes(&case, 0.0, 2);
    let says = |warnings: &[String]| {
        warnings.iter().any(|warning| {
            warning.contains("errors of the frequencies by the mesh are unknown") && warning.contains("300")
        })
    };
    assert!(found.modes.modes.iter().all(|mode| mode.mesh.is_none()));
    assert!(says(&found.warnings), "{:?}", found.warnings);
    let found = diagram(&case, &[0.0, 1.0], 2);
    assert!(says(&found.warnings), "{:?}", found.warnings);
}

/// A diagram of motions that do not vibrate says why it is empty.
#[test]
fn a_diagram_of_overdamped_motions_says_that_nothing_vibrates() {
    const BAR: &str = "
beam = { length = 1 }
damping = { stiffness = 1e3 }
section = { kind = 'rectangle', height = 0.01, width = 0.02, modulus = 7e10, density = 2700 }
model.coupling = 'exact'
basis.elements = 4
run.duration = 1
";
    let reading = reading(BAR, &[]);
    assert!(!modes(&reading, 0.0, 3).modes.overdamped.is_empty());
    let diagram = diagram(&reading, &[0.0, 1.0], 3);
    assert!(diagram.campbell.branches.is_empty());
    assert!(diagram.warnings.iter().any(|text| text.contains("nothing vibrates")), "{:?}", diagram.warnings);
}

//! The shapes for ParaView agree with the trajectory, read here as XML; `.ci/run` reads them with VTK itself.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flexion_case::{Run, read};
use flexion_results::{Directory, Status, write_solids};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Largest difference, over the length of the beam or in rad: rounding.
const TOLERANCE: f64 = 1e-12;

/// A beam that bends by more than half its length while it rotates.
fn results(folder: &Path) -> (PathBuf, Run) {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/p1_spin_up_4_at_5_gpa");
    let set = [
        "model.coupling=exact",
        "run.duration=6",
        "output={step=0.5,vtk=true,vtk-step=1,stations=['2.5 m', '7 m']}",
    ];
    let reading = read(&case, &set.map(str::to_owned)).unwrap();
    let run = reading.prepare().unwrap().run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    let out = folder.join("results");
    reading.write(&run, &Directory::create(&out, false).unwrap()).unwrap();
    (out, run)
}

/// The numbers of an array.
fn numbers(document: &roxmltree::Document<'_>, name: &str) -> Vec<f64> {
    let node = document.descendants().find(|n| n.attribute("Name") == Some(name)).unwrap();
    assert_eq!(
        (node.attribute("type"), node.attribute("format")),
        (Some("Float64"), Some("binary")),
        "{name}"
    );
    let block = STANDARD.decode(node.text().unwrap().trim()).unwrap();
    assert_eq!(u64::from_le_bytes(block[..8].try_into().unwrap()) as usize, block.len() - 8, "{name}");
    block[8..].chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

#[test]
fn points_and_arrays_of_every_frame_are_those_of_the_trajectory() {
    let folder = tempfile::tempdir().unwrap();
    let (out, run) = results(folder.path());
    let column = |name: &str| run.trajectory.column(name).unwrap();
    let index = std::fs::read_to_string(out.join("beam.pvd")).unwrap();
    let index = roxmltree::Document::parse(&index).unwrap();
    let sets: Vec<_> = index.descendants().filter(|n| n.has_tag_name("DataSet")).collect();
    assert_eq!(sets.len(), 7);
    let (angle, mut worst, mut bent) = (column("hub.angle"), 0.0_f64, 0.0_f64);
    for set in sets {
        let time: f64 = set.attribute("timestep").unwrap().parse().unwrap();
        let row = run.trajectory.times().iter().position(|t| *t == time).unwrap();
        let text = std::fs::read_to_string(out.join(set.attribute("file").unwrap())).unwrap();
        let grid = roxmltree::Document::parse(&text).unwrap();
        assert_eq!(numbers(&grid, "TimeValue"), [time]);
        let (points, stations) = (numbers(&grid, "Points"), numbers(&grid, "arc_length"));
        assert_eq!(points.len(), 3 * stations.len());
        let (sin, cos) = angle[row].sin_cos();
        for (name, at) in [("tip", 10.0), ("x=2.5", 2.5), ("x=7", 7.0)] {
            // Lower fibre, axis, upper fibre of each station.
            let i = (1..stations.len()).step_by(3).find(|&i| (stations[i] - at).abs() < 1e-9).unwrap();
            let [axial, deflection, rotation] =
                ["axial", "deflection", "rotation"].map(|of| column(&format!("{name}.{of}"))[row]);
            bent = bent.max(deflection.abs());
            let x = at + axial;
            let expected = [x * cos - deflection * sin, x * sin + deflection * cos, 0.0];
            for (c, expected) in expected.iter().enumerate() {
                worst = worst.max((points[3 * i + c] - expected).abs() / 10.0);
            }
            worst = worst.max((numbers(&grid, "axial")[i] - axial).abs() / 10.0);
            worst = worst.max((numbers(&grid, "deflection")[i] - deflection).abs() / 10.0);
            worst = worst.max((numbers(&grid, "rotation")[i] - rotation).abs());
        }
    }
    assert!(bent > 4.0, "{bent}");
    assert!(worst < TOLERANCE, "{worst:.1e}");
}

/// Beams along x with their heights upwards, whose tip sections are as wide and as high as their cases say: a shape that tapers; an
/// outline, which tapers with it; the rectangle of stiffnesses alone, √(12 EI/EA).
#[test]
fn sections_of_beams_in_space_have_the_sizes_of_their_cases() {
    let shape = r#"section={kind="tapered-rectangle", modulus=1e9, density=1000, root-width=0.4, tip-width=0.1, root-height=0.2, tip-height=0.1}"#;
    let general = r#"section={kind="general", mass-per-length=1, axial-stiffness=12, torsional-stiffness=1, bending-stiffness=0.09, bending-stiffness-across=0.04, rotary-inertia=1}"#;
    let outline = "outline={y=[-0.1, 0, 0.1], z=[0, 0.2, 0]}";
    let beams = [shape.to_owned(), format!("{shape}, {outline}"), general.to_owned()];
    let beams =
        (1..).zip(&beams).map(|(i, keys)| format!("{{name='beam{i}', length=2, up=[0, 0, 1], {keys}}}"));
    let text = format!("beam=[{}]\nrun.duration=1\n", beams.collect::<Vec<_>>().join(", "));
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("case.toml"), text).unwrap();
    let case = read(folder.path(), &[]).unwrap().case;
    let (mut system, mut scene) = (case.system().unwrap(), case.scene());
    let state = system.initial();
    scene.finish(system.as_mut(), &state);
    let mut grid = Vec::new();
    write_solids(&scene, 0, &mut grid).unwrap();
    let grid = String::from_utf8(grid).unwrap();
    let grid = roxmltree::Document::parse(&grid).unwrap();
    let (points, parts) = (numbers(&grid, "Points"), numbers(&grid, "part"));
    for (part, [wide, high]) in [[0.1, 0.1], [0.05, 0.1], [0.2, 0.3]].into_iter().enumerate() {
        let tip: Vec<&[f64]> = points
            .chunks(3)
            .zip(&parts)
            .filter(|(point, of)| **of == part as f64 && point[0] == 2.0)
            .map(|(point, _)| point)
            .collect();
        assert!(tip.len() > 2);
        for (k, size) in [(1, wide), (2, high)] {
            let of = tip.iter().map(|point| point[k]);
            let found = of.clone().fold(f64::NEG_INFINITY, f64::max) - of.fold(f64::INFINITY, f64::min);
            assert!((found - size).abs() < 1e-12, "beam {part}, axis {k}: {found} for {size}");
        }
    }
}

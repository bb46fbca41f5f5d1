//! Every kind by its own example: it is read, resolves to itself, and makes a model of its own. The resolved case among
//! the results repeats a run, byte for byte.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::{Contents, Reading, choices, examples_of_tables, parse_with, read};
use flexion_results::{Artifact, Directory, Status};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

const BASE: &str = r#"
title = "repeated"
[beam]
length = "2 m"
[section]
kind = "rectangle"
modulus = "70 GPa"
density = "2700 kg/m^3"
width = "20 mm"
height = "20 mm"
[hub]
motion = { kind = "spin-up", speed = "4 rad/s", time = "0.1 s" }
[integrator]
kind = "newmark"
step = "1 ms"
[run]
duration = "0.05 s"
[output]
step = "5 ms"
"#;

const IN_SPACE: &str = r#"
title = "in space"
gravity = [0, 1, -9.81]
[[body]]
name = "bar"
mass = "2 kg"
position = ["50 cm", 0, 0]
inertia = { kind = "box", size = ["1 m", "20 mm", "30 mm"] }
spin = [1, 0, 0]
[run]
duration = "0.05 s"
[output]
step = "5 ms"
"#;

const TABLE: &str = "# measured\ntime,speed\n0, 0\n0.02, 0.3\n0.05,1.1\n0.1, 4\n";

const SECTION: &str = "x,mass,EA,EI\n0,1.1,2.8e7,930\n1,1.0,2.6e7,900\n2,0.8,2.1e7,700\n";

const ELASTODYN: &str = "--- blade\n2 NBlInpSt\n1 AdjBlMs\n1 AdjFlSt\n1 AdjEdSt\nBlFract StrcTwst BMassDen FlpStff EdgStff\n(-) (deg) (kg/m) (Nm^2) (Nm^2)\n0 5 1.1 930 1200\n1 0 0.8 700 800\n";

fn run(case: &Path, set: &[&str], output: &Path) -> Reading {
    let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
    let reading = read(case, &set).unwrap_or_else(|problems| panic!("{}", problems.render(false)));
    let prepared = reading.prepare().unwrap_or_else(|problems| panic!("{}", problems.render(false)));
    let directory = Directory::create(output, true).unwrap();
    let run = prepared.run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(reading.write(&run, &directory).unwrap(), Status::Finished, "{set:?}: {:?}", run.message);
    reading
}

/// All files with their bytes, but the summary, which names the case and the time of computing.
fn written(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            all.extend(
                written(&entry.path()).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)),
            );
        } else if name != Artifact::Summary.file_name() && name != ".flexion-files" {
            // The list has the hash of the summary.
            all.push((name, fs::read(entry.path()).unwrap()));
        }
    }
    all.sort();
    all
}

/// A file of a real blade.
fn blade(name: &str) -> Vec<u8> {
    fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/blades").join(name)).unwrap()
}

/// A strip whose centre of mass lies beside its axis.
const SECTIONS: &str = "x, mass, EA, EI-flap, EI-chord, GJ, GA-chord, GA-flap, inertia-flap, inertia-chord, mass-y\n\
    0, 2, 5e6, 100, 900, 80, 1e6, 1e6, 1e-3, 9e-3, 0.01\n1, 1, 3e6, 60, 500, 50, 1e6, 1e6, 6e-4, 5e-3, 0.005\n";

/// The files that examples name, but the state of an earlier run.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("measured.csv", TABLE.into()),
        ("section.csv", SECTION.into()),
        ("elastodyn.dat", ELASTODYN.into()),
        ("beamdyn_primary.dat", blade("IEA-15-240-RWT_BeamDyn.dat")),
        ("IEA-15-240-RWT_BeamDyn_blade.dat", blade("IEA-15-240-RWT_BeamDyn_blade.dat")),
        ("hawc2.st", blade("IEA_15MW_RWT_Blade_st_FPM.st")),
        ("windio.yaml", blade("IEA-15-240-RWT_windIO.yaml")),
        ("sections.csv", SECTIONS.into()),
    ]
}

/// The same files in memory, with the state in which a run of the base case ends after 20 ms.
fn contents() -> Contents {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    fs::write(&case, BASE).unwrap();
    run(&case, &["run.duration='20 ms'"], &folder.path().join("earlier"));
    let state = fs::read(folder.path().join("earlier/state.npz")).unwrap();
    let all = files().into_iter().chain([("state.npz", state)]);
    all.map(|(name, bytes)| (name.to_owned(), bytes.into())).collect()
}

/// The base case of an example.
fn base(text: &str) -> &'static str {
    let spatial = ["'bar'", "body=", "beam=[", "joint=", "rotation="];
    if spatial.iter().any(|part| text.contains(part)) { IN_SPACE } else { BASE }
}

/// A base case with the changes of an example, one a line.
fn example(base: &str, text: &str, files: &Contents) -> Reading {
    let set: Vec<String> = text.lines().map(str::to_owned).collect();
    parse_with(base.to_owned(), Path::new("case.toml"), &set, files).unwrap_or_else(|p| panic!("{text}: {p}"))
}

/// Every recorded value of a run, and the axis of rotation of a system in space.
fn outcome(reading: &Reading) -> Vec<u64> {
    let run = reading.prepare().unwrap_or_else(|p| panic!("{p}")).run(&mut |_| ControlFlow::Continue(()));
    assert_eq!(run.status, Status::Finished, "{:?}", run.message);
    let trajectory = &run.trajectory;
    let columns = 0..trajectory.channels().len();
    let physical = columns.filter(|i| !trajectory.channels()[*i].name.starts_with("step."));
    let mut all: Vec<f64> = physical.flat_map(|i| trajectory.values(i).collect::<Vec<_>>()).collect();
    if let Some(Ok(rotation)) = reading.case.space().map(|space| &space.rotation) {
        all.extend(rotation.axis.direction.into_iter().chain(rotation.axis.point));
    }
    all.into_iter().map(f64::to_bits).collect()
}

#[test]
fn every_example_reads_chooses_its_kind_and_resolves_to_itself() {
    let files = contents();
    let kinds = choices().iter().flat_map(|choice| choice.kinds()).map(|kind| (kind.name, kind.example));
    for (name, text) in kinds.chain(examples_of_tables().into_iter().map(|text| ("", text))) {
        let reading = example(base(text), text, &files);
        let resolved = reading.resolved();
        assert!(resolved.contains(&format!("\"{name}\"")) || name.is_empty(), "{text} does not use {name}");
        let again = parse_with(resolved.clone(), Path::new("case.toml"), &[], &files).unwrap();
        assert_eq!(again.resolved(), resolved, "{text}");
        assert!(again.defaults().is_empty(), "{text}: {:?}", again.defaults());
    }
}

#[test]
fn every_kind_makes_a_model_of_its_own() {
    let files = contents();
    for choice in choices() {
        let mut outcomes: Vec<(&str, Vec<u64>)> = Vec::new();
        for kind in choice.kinds() {
            let found = outcome(&example(base(kind.example), kind.example, &files));
            if let Some((other, _)) = outcomes.iter().find(|(_, outcome)| *outcome == found) {
                panic!("the {} `{}` gives what `{other}` gives", choice.name(), kind.name);
            }
            outcomes.push((kind.name, found));
        }
    }
    let plain = [BASE, IN_SPACE].map(|base| outcome(&example(base, "title=base", &files)));
    for text in examples_of_tables() {
        let found = outcome(&example(base(text), text, &files));
        assert!(!plain.contains(&found), "{text}");
    }
}

/// The same of a system in space.
const WRITTEN_IN_SPACE: &[&str] = &[
    "joint=[{kind='prismatic', between=['ground', 'bar'], travel={kind='table', file='tables/measured.csv', of='speed'}}]",
    "beam=[{length=2, up=[0, 0, 1], root='clamped', elements=2, section={kind='rectangle', modulus=7e10, density=2700, width=0.01, height=0.02}}]\nfibre=[{name='top', on='root', y=0.01}]",
    "output={vtk=true, vtk-step='10 ms'}",
];

/// Changes to the base case whose runs are written: they name files, or are recorded in another way.
const WRITTEN: &[&str] = &[
    "title=base",
    "section={kind='table', file='tables/section.csv', interpolation='cubic'}",
    "section={kind='deck', file='tables/elastodyn.dat', format='elastodyn'}",
    "hub={inertia=5, motion={kind='free', torque={kind='table', file='tables/measured.csv'}}}",
    "hub.motion={kind='table', file='tables/measured.csv', of='angle'}",
    "initial={kind='restart', file='tables/state.npz'}",
    "initial={kind='restart', file='tables'}",
    "output={step='2 ms', vtk=true, vtk-step='7 ms'}",
    "output={stations=['0 m', '1 m'], section-forces=true, strain-heights=['0.01', '-5 mm'], energy-balance=false}",
];

#[test]
fn a_run_is_repeated_byte_for_byte_from_the_resolved_case_alone() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    fs::write(&case, BASE).unwrap();
    let earlier = folder.path().join("earlier");
    run(&case, &["run.duration='20 ms'"], &earlier);
    let (first, second) = (folder.path().join("first"), folder.path().join("elsewhere/second"));
    let space = folder.path().join("space.toml");
    fs::write(&space, IN_SPACE).unwrap();
    let planar = WRITTEN.iter().map(|variation| (&case, variation));
    for (case, variation) in planar.chain(WRITTEN_IN_SPACE.iter().map(|variation| (&space, variation))) {
        // What the case refers to is there for the first run only.
        fs::create_dir(folder.path().join("tables")).unwrap();
        for (name, bytes) in files() {
            fs::write(folder.path().join("tables").join(name), bytes).unwrap();
        }
        fs::copy(earlier.join("state.npz"), folder.path().join("tables/state.npz")).unwrap();
        run(case, &variation.lines().collect::<Vec<_>>(), &first);
        fs::remove_dir_all(folder.path().join("tables")).unwrap();
        run(&first.join("case.resolved.toml"), &[], &second);
        let (a, b) = (written(&first), written(&second));
        let names = |files: &[(String, Vec<u8>)]| files.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
        assert_eq!(names(&a), names(&b), "{variation}");
        for ((name, a), (_, b)) in a.iter().zip(&b) {
            assert!(a == b, "{variation}: {name} differs");
        }
        let copies = ["motion.csv", "torque.csv", "section.csv", "initial.npz", "table1.csv"]
            .map(|copy| names(&a).contains(&copy.to_owned()));
        assert_eq!(variation.contains("tables"), copies.contains(&true), "{variation}");
        assert_eq!(variation.contains("vtk=true"), names(&a).contains(&"beam.pvd".to_owned()));
        if variation.contains("tables/") {
            // In its own place, too: the table is replaced by itself.
            run(&first.join("case.resolved.toml"), &[], &first);
            assert!(written(&first) == b, "{variation} in place");
        }
    }
}

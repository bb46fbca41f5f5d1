//! The resolved case among the results repeats the run, byte for byte, whatever kinds it is made of.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion_case::{Reading, read, seams};
use flexion_results::{Artifact, Directory, Status};
use std::collections::BTreeSet;
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

const TABLE: &str = "# measured\ntime,speed\n0, 0\n0.02, 0.3\n0.05,1.1\n0.1, 4\n";

const SECTION: &str = "x,mass,EA,EI\n0,1.1,2.8e7,930\n1,1.0,2.6e7,900\n2,0.8,2.1e7,700\n";

const BLADE: &str = "x,mass,EA,EI-flap,EI-chord,twist\n0,1.1,2.8e7,930,1200,0.1\n2,0.8,2.1e7,700,800,0\n";

const ELASTODYN: &str = "--- blade\n2 NBlInpSt\nBlFract StrcTwst BMassDen FlpStff EdgStff\n(-) (deg) (kg/m) (Nm^2) (Nm^2)\n0 5 1.1 930 1200\n1 0 0.8 700 800\n";

/// A BeamDyn file of two equal stations.
fn beamdyn() -> String {
    let matrix = |entries: [f64; 6]| {
        let row = |i: usize| {
            (0..6).map(|j| format!("{} ", if i == j { entries[i] } else { 0.0 })).collect::<String>()
        };
        (0..6).map(|i| row(i) + "\n").collect::<String>() + "\n"
    };
    let station =
        matrix([1e6, 1e6, 2.8e7, 1200.0, 930.0, 500.0]) + &matrix([1.1, 1.1, 1.1, 0.01, 0.01, 0.02]);
    format!("--- blade\n2 station_total\n--- Distributed Properties\n0.0\n{station}1.0\n{station}")
}

/// Changes to the base case, which together use every kind there is.
const VARIATIONS: &[&str] = &[
    "title=base",
    "section={kind='uniform', modulus='7 GPa', density=2700, area='4 cm^2', second-moment='2e-8 m^4', rotary-inertia=true}",
    "section={kind='circle', modulus='70 GPa', density=2700, radius='1 cm'}",
    "section={kind='tube', modulus='70 GPa', density=2700, outer-radius='2 cm', inner-radius='1 cm'}",
    "section={kind='resultants', mass-per-length=1.0, axial-stiffness=2.8e7, bending-stiffness=930.0}",
    "section={kind='graded', ceramic-modulus='151 GPa', metal-modulus='70 GPa', ceramic-density=3000, metal-density=2707, width='2 cm', height='2 cm', exponent=1.5}",
    "section={kind='tapered-rectangle', modulus='70 GPa', density=2700, root-width='2 cm', tip-width='1 cm', root-height='3 cm', tip-height='1 cm'}",
    "section={kind='tapered-circle', modulus='70 GPa', density=2700, root-radius='2 cm', tip-radius='1 cm'}",
    "section={kind='tapered-tube', modulus='70 GPa', density=2700, root-outer-radius='2 cm', root-inner-radius='1 cm', tip-outer-radius='15 mm', tip-inner-radius='1 cm'}",
    "section={kind='piecewise', ends=[1, 2], modulus=['70 GPa', '60 GPa'], density=[2700, 2600], area=['4 cm^2', '3 cm^2'], second-moment=['2e-8 m^4', '1e-8 m^4']}",
    "section={kind='table', file='tables/section.csv', interpolation='linear'}",
    "section={kind='table', file='tables/section.csv', interpolation='cubic'}",
    "section={kind='blade', file='tables/blade.csv'}",
    "section={kind='blade', file='tables/blade_elastodyn.dat', format='elastodyn'}",
    "section={kind='blade', file='tables/blade_beamdyn.dat', format='beamdyn'}",
    "blade={pitch='5 deg', twist='-20 deg', strain-energy='linear', tip-mass='10 g'}",
    "blade={strain-energy='coupled',bending-second=false,stretched-inertia=false}",
    "blade={precone='2 deg', strain-energy='exact', torsion=false}",
    "hub={inertia=5, motion={kind='free', torque={kind='constant', torque=3}}}",
    "hub={inertia=5, motion={kind='free', torque={kind='ramp', torque=3, time='0.02 s'}, controller={kind='pd', proportional=3, derivative=1, target='0.1 rad'}}}",
    "hub={inertia=5, motion={kind='free', torque={kind='table', file='tables/measured.csv'}, controller={kind='none'}}}",
    "hub={inertia=5, motion={kind='free', torque={kind='expression', formula='2*sin(t)'}}}",
    "force=[{station=2, force=[0, 3], frame='dead', amplitude={kind='constant'}}, {station=1, force=[0, 3], frame='hub', amplitude={kind='ramp', time=0.1}}, {station=1, force=[0, 3], frame='follower', amplitude={kind='table', times=[0, 0.02, 0.05], factors=[0, 1, 2]}}]",
    "couple=[{station=2, couple=1, amplitude={kind='expression', formula='sin(t)'}}]",
    "distributed-load=[{force=[0, 3], distribution={kind='uniform'}}, {force=[0, 3], distribution={kind='table', stations=[0, 1, 2], factors=[0, 1, 0]}}, {force=[1, 0], distribution={kind='expression', formula='x'}}]",
    "hub.motion={kind='constant', speed='4 rad/s'}",
    "hub.motion={kind='ramp', speed='4 rad/s', time='0.1 s'}",
    "hub.motion={kind='table', file='tables/measured.csv', of='speed'}",
    "hub.motion={kind='table', file='tables/measured.csv', of='angle'}",
    "hub.motion={kind='expression', formula='sin(t)^2', of='angle'}",
    "hub.motion={kind='expression', formula='3*t', of='speed'}",
    "model.coupling=zeroth",
    "model.coupling=first",
    "model.coupling=high",
    "model.coupling=exact",
    "basis={kind='finite-elements', elements=7}",
    "basis={kind='modes', axial=2}",
    "basis={kind='radial'}",
    "basis={kind='polynomial'}",
    "basis={kind='b-spline'}",
    "basis={kind='bezier'}",
    "basis={kind='mixed', axial={kind='modes', count=2}, transverse={kind='radial'}}",
    "basis={kind='mixed', axial={kind='radial'}, transverse={kind='finite-elements'}}",
    "initial.kind=steady-rotation",
    "initial.kind=undeformed",
    "initial.kind=static",
    "initial={kind='modes', amplitudes=['1 mm', 0.001]}",
    "initial={kind='modes', amplitudes=[0, '1 mm'], velocities=['3 mm/s', 0]}",
    "initial={kind='restart', file='tables/state.npz'}",
    "initial={kind='restart', file='tables'}",
    "integrator={kind='radau'}",
    "integrator={kind='hht', step='1 ms'}",
    "integrator={kind='generalized-alpha', step='1 ms'}",
    "integrator={kind='runge-kutta-4', step='1 us'}",
    "integrator={kind='adams-4', step='1 us'}",
    "output.stations=[0.1, '150 cm']",
    "output={step='2 ms', vtk=true, vtk-step='7 ms'}",
    "output={stations=[0, 1], section-forces=true, strain-heights=['0.01', '-5 mm'], energy-balance=false}",
];

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
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = entry.file_name().into_string().unwrap();
        if entry.path().is_dir() {
            all.extend(
                files(&entry.path()).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)),
            );
        } else if name != Artifact::Summary.file_name() {
            all.push((name, fs::read(entry.path()).unwrap()));
        }
    }
    all.sort();
    all
}

#[test]
fn a_run_is_repeated_byte_for_byte_from_the_resolved_case_alone() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    fs::write(&case, BASE).unwrap();
    let earlier = folder.path().join("earlier");
    run(&case, &["run.duration='20 ms'"], &earlier);
    let (first, second) = (folder.path().join("first"), folder.path().join("elsewhere/second"));
    for variation in VARIATIONS {
        // What the case refers to is there for the first run only.
        fs::create_dir(folder.path().join("tables")).unwrap();
        fs::write(folder.path().join("tables/measured.csv"), TABLE).unwrap();
        fs::write(folder.path().join("tables/section.csv"), SECTION).unwrap();
        fs::copy(earlier.join("state.npz"), folder.path().join("tables/state.npz")).unwrap();
        fs::write(folder.path().join("tables/blade.csv"), BLADE).unwrap();
        fs::write(folder.path().join("tables/blade_elastodyn.dat"), ELASTODYN).unwrap();
        fs::write(folder.path().join("tables/blade_beamdyn.dat"), beamdyn()).unwrap();
        run(&case, &[variation], &first);
        fs::remove_dir_all(folder.path().join("tables")).unwrap();
        run(&first.join("case.resolved.toml"), &[], &second);
        let (a, b) = (files(&first), files(&second));
        let names = |files: &[(String, Vec<u8>)]| files.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
        assert_eq!(names(&a), names(&b), "{variation}");
        for ((name, a), (_, b)) in a.iter().zip(&b) {
            assert!(a == b, "{variation}: {name} differs");
        }
        let copies = ["motion.csv", "torque.csv", "section.csv", "initial.npz"]
            .map(|copy| names(&a).contains(&copy.to_owned()));
        assert_eq!(variation.contains("tables"), copies.contains(&true), "{variation}");
        assert_eq!(variation.contains("vtk=true"), names(&a).contains(&"beam.pvd".to_owned()));
        if variation.contains("tables/") {
            // In its own place, too: the table is replaced by itself.
            run(&first.join("case.resolved.toml"), &[], &first);
            assert!(files(&first) == b, "{variation} in place");
        }
    }
}

#[test]
fn every_kind_is_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.toml");
    fs::write(&case, BASE).unwrap();
    fs::create_dir(folder.path().join("tables")).unwrap();
    fs::write(folder.path().join("tables/measured.csv"), TABLE).unwrap();
    fs::write(folder.path().join("tables/section.csv"), SECTION).unwrap();
    fs::write(folder.path().join("tables/blade.csv"), BLADE).unwrap();
    fs::write(folder.path().join("tables/blade_elastodyn.dat"), ELASTODYN).unwrap();
    fs::write(folder.path().join("tables/blade_beamdyn.dat"), beamdyn()).unwrap();
    let mut used = BTreeSet::new();
    for variation in VARIATIONS {
        let reading = read(&case, &[(*variation).to_owned()]).unwrap();
        for line in reading.resolved().lines() {
            used.extend(line.split('"').nth(1).map(str::to_owned));
        }
    }
    for seam in seams() {
        for kind in seam.kinds {
            assert!(used.contains(kind.name), "no variation uses the {} `{}`", seam.name, kind.name);
        }
    }
}

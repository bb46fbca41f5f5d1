//! A BeamDyn file of full size: the same blade from both formats of OpenFAST gives the same Campbell diagram.

#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

use flexion::analysis::campbell::{Campbell, HubState, Plan};
use flexion_case::parse;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Published stations of the NREL 5 MW blade: fraction, mass per length, flapwise and edgewise stiffness.
fn stations() -> Vec<[f64; 4]> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/modes_blade_nrel_5mw/blade.dat");
    let text = std::fs::read_to_string(file).unwrap();
    let row = |line: &str| {
        let x: Vec<f64> = line.split_whitespace().map_while(|x| x.parse().ok()).collect();
        (x.len() == 5).then(|| [x[0], x[2], x[3], x[4]])
    };
    text.lines().filter_map(row).collect()
}

/// EA, GJ and the polar moments of mass, which the table of ElastoDyn leaves out, as of a thin box.
fn more([_, mass, flap, edge]: [f64; 4]) -> [f64; 4] {
    [10.0 * flap.max(edge), 0.1 * (flap * edge).sqrt(), mass * 0.3, mass * 0.7]
}

fn elastodyn() -> String {
    let rows = stations();
    let mut out =
        format!("--- ELASTODYN BLADE INPUT FILE ---\nwithout twist\n{} NBlInpSt - stations\n", rows.len());
    out.push_str(
        "1 AdjBlMs - mass\n1 AdjFlSt - flap\n1 AdjEdSt - edge\n--- DISTRIBUTED BLADE PROPERTIES ---\n",
    );
    out.push_str("BlFract StrcTwst BMassDen FlpStff EdgStff GJStff EAStff FlpIner EdgIner\n");
    out.push_str("(-) (deg) (kg/m) (Nm^2) (Nm^2) (Nm^2) (N) (kg m) (kg m)\n");
    for row @ [fraction, mass, flap, edge] in rows {
        let [ea, gj, flap_inertia, edge_inertia] = more(row);
        let (i, j) = (flap_inertia, edge_inertia);
        writeln!(out, "{fraction} 0.0 {mass} {flap:e} {edge:e} {gj:e} {ea:e} {i} {j}").unwrap();
    }
    out
}

/// As the files of OpenFAST's regression tests are set: shear stiffnesses, both halves of the matrices, blank lines.
fn beamdyn() -> String {
    let rows = stations();
    let mut out =
        String::from(" ------- BEAMDYN V1.00.* INDIVIDUAL BLADE INPUT FILE --------------------------\n");
    out.push_str(
        " 49 stations\n ---------------------- BLADE PARAMETERS --------------------------------------\n",
    );
    writeln!(out, "{}   station_total    - Number of blade input stations (-)", rows.len()).unwrap();
    out.push_str(" 1   damp_type        - Damping type: 0: no damping; 1: damped\n");
    out.push_str("  ---------------------- DAMPING COEFFICIENT------------------------------------\n");
    out.push_str("   mu1        mu2        mu3        mu4        mu5        mu6\n");
    out.push_str("   (-)        (-)        (-)        (-)        (-)        (-)\n");
    out.push_str("1.0E-03    1.0E-03    1.0E-03    0.0014    0.0022    0.0022\n");
    out.push_str(" ---------------------- DISTRIBUTED PROPERTIES---------------------------------\n");
    for row @ [fraction, mass, flap, edge] in rows {
        let [ea, gj, i, j] = more(row);
        writeln!(out, "  {fraction:.6}").unwrap();
        for diagonal in [[0.4 * ea, 0.4 * ea, ea, edge, flap, gj], [mass, mass, mass, j, i, i + j]] {
            for (k, x) in diagonal.iter().enumerate() {
                let entries: Vec<String> =
                    (0..6).map(|l| format!("{:.17E}", if k == l { *x } else { 0.0 })).collect();
                writeln!(out, "   {}", entries.join("   ")).unwrap();
            }
            out.push('\n');
        }
    }
    out
}

fn diagram(format: &str, text: &str) -> Campbell {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("blade.dat"), text).unwrap();
    let case = format!(
        "[beam]\nlength = '61.5 m'\n[section]\nkind = 'blade'\nfile = 'blade.dat'\nformat = '{format}'\n[hub]\nradius = '1.5 m'\n\
         motion = {{ kind = 'constant', speed = '12.1 rpm' }}\n[blade]\nelements = 40\n[run]\nduration = '1 s'\n"
    );
    let reading =
        parse(case, &folder.path().join("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let plan = Plan {
        speeds: (0..=40).map(|i| 0.05 * f64::from(i)).collect(),
        count: 8,
        stations: vec![0.0, 30.75, 61.5],
        hub: HubState::Held,
        revolutions: 6,
    };
    let on = |threads| {
        flexion_case::campbell(reading.case.vibrating(true).unwrap().0, None, &plan, threads, &|_| true)
            .unwrap()
    };
    let alone = on(1);
    assert_eq!(alone, on(3), "the number of threads changes nothing");
    alone
}

#[test]
fn a_blade_of_49_stations_has_the_same_campbell_diagram_from_beamdyn_and_elastodyn_files() {
    assert_eq!(stations().len(), 49);
    let (a, b) = (diagram("elastodyn", &elastodyn()), diagram("beamdyn", &beamdyn()));
    assert_eq!((a.branches.len(), b.branches.len()), (8, 8));
    for (a, b) in a.branches.iter().zip(&b.branches) {
        assert_eq!(a.points.len(), b.points.len());
        for (a, b) in a.points.iter().zip(&b.points) {
            let off = a.mode.frequency() / b.mode.frequency() - 1.0;
            assert!(off.abs() < 1e-9, "{off:e} at {} rad/s", a.speed);
            assert_eq!(a.mode.shares.dominant(), b.mode.shares.dominant());
        }
    }
    for (a, b) in a.crossings.iter().zip(&b.crossings) {
        assert_eq!((a.branch, a.revolutions), (b.branch, b.revolutions));
        assert!((a.speed / b.speed - 1.0).abs() < 1e-8);
    }
    // Flapwise and edgewise at rest as published (0.68 and 1.09 Hz with twist and 4.5 % more mass).
    let hertz: Vec<f64> = b.branches.iter().map(|b| b.points[0].mode.frequency() / TAU).collect();
    assert!((0.65..0.75).contains(&hertz[0]) && (1.0..1.2).contains(&hertz[1]), "{hertz:?}");
    assert!(b.branches.iter().any(|b| b.points[0].mode.shares.dominant() == "torsion"), "{hertz:?}");
}

/// The same blade as a beam in space: frequencies apart by no more than the errors of both meshes.
#[test]
fn a_blade_is_a_beam_in_space_at_every_speed() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("blade.dat"), elastodyn()).unwrap();
    let section = "kind = 'blade', file = 'blade.dat', format = 'elastodyn'";
    let room = format!(
        "section = {{ {section} }}\nrun = {{ duration = 0 }}\n[beam]\nlength = '61.5 m'\n[hub]\nradius = '1.5 m'\n\
         motion = {{ kind = 'constant', speed = '12.1 rpm' }}\n[blade]\nelements = 40\n"
    );
    let space = format!(
        "rotation = {{ axis = [0, 0, 1] }}\nrun = {{ duration = 0 }}\n[[beam]]\nlength = '61.5 m'\nstart = ['1.5 m', 0, 0]\n\
         up = [0, 1, 0]\nroot = 'clamped'\nelements = 40\nsection = {{ {section} }}\n"
    );
    let plan = Plan {
        speeds: (0..=5).map(|i| 0.4 * f64::from(i)).collect(),
        count: 7,
        stations: Vec::new(),
        hub: HubState::Held,
        revolutions: 0,
    };
    let [room, space] = [room, space].map(|text| {
        let file = folder.path().join("case.toml");
        let reading = parse(text, &file, &[]).unwrap_or_else(|problems| panic!("{problems}"));
        let finer = reading.with_finer_mesh().unwrap();
        let [coarse, finer] = [reading, finer].map(|reading| reading.case.vibrating(true).unwrap().0);
        flexion_case::campbell(coarse, Some((finer, 2.0)), &plan, 1, &|_| true).unwrap()
    });
    let names = ["flap", "chord", "flap", "chord", "flap", "torsion", "flap"];
    for (name, (a, b)) in names.into_iter().zip(room.branches.iter().zip(&space.branches)) {
        for speed in &plan.speeds {
            let [a, b] = [a, b].map(|branch| &branch.points.iter().find(|p| p.speed == *speed).unwrap().mode);
            assert_eq!([a.shares.dominant(), b.shares.dominant()], [name; 2], "{speed}");
            let off = (a.frequency() - b.frequency()).abs();
            let allowed = a.mesh.unwrap() + b.mesh.unwrap();
            assert!(
                off <= allowed && allowed < 1e-3 * a.frequency(),
                "{name} at {speed}: {off:e} of {allowed:e}"
            );
        }
    }
}

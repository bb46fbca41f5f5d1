//! Blade files of ElastoDyn: the same blade as a table of matrices has the same Campbell diagram.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::campbell::{Campbell, HubState, Plan};
use flexion_case::parse;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// Published stations of the NREL 5 MW blade: fraction, twist \[°\], mass per length, flapwise and edgewise stiffness.
fn stations() -> Vec<[f64; 5]> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/modes_blade_nrel_5mw/blade.dat");
    let text = std::fs::read_to_string(file).unwrap();
    let row = |line: &str| {
        let x: Vec<f64> = line.split_whitespace().map_while(|x| x.parse().ok()).collect();
        <[f64; 5]>::try_from(x).ok()
    };
    text.lines().filter_map(row).collect()
}

/// EA, GJ and the polar moments of mass, which the table of ElastoDyn leaves out, as of a thin box.
fn more([_, _, mass, flap, edge]: [f64; 5]) -> [f64; 4] {
    [10.0 * flap.max(edge), 0.1 * (flap * edge).sqrt(), mass * 0.3, mass * 0.7]
}

fn elastodyn() -> String {
    let rows = stations();
    let mut out =
        format!("--- ELASTODYN BLADE INPUT FILE ---\nall columns\n{} NBlInpSt - stations\n", rows.len());
    out.push_str(
        "1 AdjBlMs - mass\n1 AdjFlSt - flap\n1 AdjEdSt - edge\n--- DISTRIBUTED BLADE PROPERTIES ---\n",
    );
    out.push_str("BlFract StrcTwst BMassDen FlpStff EdgStff GJStff EAStff FlpIner EdgIner\n");
    out.push_str("(-) (deg) (kg/m) (Nm^2) (Nm^2) (Nm^2) (N) (kg m) (kg m)\n");
    for row @ [fraction, twist, mass, flap, edge] in rows {
        let [ea, gj, i, j] = more(row);
        writeln!(out, "{fraction} {twist} {mass} {flap:e} {edge:e} {gj:e} {ea:e} {i} {j}").unwrap();
    }
    out
}

/// The same as matrices, whose twist is positive about the axis towards the tip.
fn matrices() -> String {
    let mut out = String::from(
        "x [m], twist [deg], mass, EI-flap, EI-chord, GJ, EA, inertia-flap, inertia-chord, GA-chord, GA-flap\n",
    );
    for row @ [fraction, twist, mass, flap, edge] in stations() {
        let [ea, gj, i, j] = more(row);
        let (x, twist) = (61.5 * fraction, -twist);
        writeln!(out, "{x}, {twist}, {mass}, {flap:e}, {edge:e}, {gj:e}, {ea:e}, {i}, {j}, 1e9, 1e9")
            .unwrap();
    }
    out
}

fn diagram(format: &str, text: &str) -> Campbell {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("blade.dat"), text).unwrap();
    let case = format!(
        "[beam]\nlength = '61.5 m'\n[section]\nkind = 'deck'\nfile = 'blade.dat'\nformat = '{format}'\n[hub]\nradius = '1.5 m'\n\
         motion = {{ kind = 'constant', speed = '12.1 rpm' }}\n[model]\ncoupling = 'space'\n[basis]\nelements = 48\n[run]\nduration = '1 s'\n"
    );
    let reading =
        parse(case, &folder.path().join("case.toml"), &[]).unwrap_or_else(|problems| panic!("{problems}"));
    let plan = Plan {
        speeds: (0..=10).map(|i| 0.2 * f64::from(i)).collect(),
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
fn a_blade_of_49_stations_has_the_same_campbell_diagram_from_elastodyn_and_as_matrices() {
    assert_eq!(stations().len(), 49);
    let (a, b) = (diagram("elastodyn", &elastodyn()), diagram("csv", &matrices()));
    assert_eq!((a.branches.len(), b.branches.len()), (8, 8));
    for (a, b) in a.branches.iter().zip(&b.branches) {
        assert_eq!(a.points.len(), b.points.len());
        for (a, b) in a.points.iter().zip(&b.points) {
            let off = a.mode.frequency() / b.mode.frequency() - 1.0;
            let rounding = 2.0 * (a.mode.rounding + b.mode.rounding);
            assert!(off.abs() < 1e-9 + rounding, "{off:e} at {} rad/s, {rounding:e}", a.speed);
            assert_eq!(a.mode.shares.dominant(), b.mode.shares.dominant());
        }
    }
    for (a, b) in a.crossings.iter().zip(&b.crossings) {
        assert_eq!((a.branch, a.revolutions), (b.branch, b.revolutions));
        assert!((a.speed / b.speed - 1.0).abs() < 1e-7);
    }
    // Flapwise and edgewise at rest as published, 0.68 and 1.09 Hz with 4.5 % more mass.
    let hertz: Vec<f64> = b.branches.iter().map(|b| b.points[0].mode.frequency() / TAU).collect();
    assert!((0.65..0.75).contains(&hertz[0]) && (1.0..1.2).contains(&hertz[1]), "{hertz:?}");
    assert!(b.branches.iter().any(|b| b.points[0].mode.shares.dominant() == "torsion"), "{hertz:?}");
}

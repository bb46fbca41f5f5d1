//! Blade files of ElastoDyn: the same blade as a table of matrices has the same Campbell diagram.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use flexion::analysis::campbell::{Campbell, HubState, Plan};
use flexion_case::deck::{self, Deck, Format};
use flexion_case::parse;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

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
        flexion_case::campbell(reading.case.vibrating(true).unwrap().0, None, &plan, threads, &|_, _| true)
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

/// Titles, units and rows of the blade of the NREL 5 MW turbine, in the six columns of OpenFAST up to 4.
fn six(titles: &str, units: &str, change: impl Fn(usize, usize, f64) -> f64) -> Result<Deck, String> {
    let rows = stations();
    let mut text = format!(
        "---\ntitle\n---\n{} NBlInpSt\n1.5 BldFlDmp1\n0 BldFlDmp2\n1 AdjBlMs\n1 AdjFlSt\n1 AdjEdSt\n---\n{titles}\n{units}\n",
        rows.len()
    );
    for (i, [fraction, twist, mass, flap, edge]) in rows.into_iter().enumerate() {
        let row = [fraction, 0.3, twist, mass, flap, edge];
        let row: Vec<String> =
            row.into_iter().enumerate().map(|(k, x)| format!("{:e}", change(i, k, x))).collect();
        writeln!(text, "{}", row.join(" ")).unwrap();
    }
    text.push_str("--- MODES\n0.06 BldFl1Sh(2)\n");
    deck::read(&|_| Ok(Arc::from(text.as_bytes())), "f", Format::ElastoDyn { length: Some(61.5) })
}

const TITLES: &str = "BlFract PitchAxis StrcTwst BMassDen FlpStff EdgStff";
const UNITS: &str = "(-) (-) (deg) (kg/m) (Nm^2) (Nm^2)";

fn same(_: usize, _: usize, x: f64) -> f64 {
    x
}

/// What every ElastoDyn file has said of it.
fn others(deck: &Deck) -> Vec<&String> {
    let usual = |text: &&String| !text.contains("no axial stiffness") && !text.contains("assumed modes");
    deck.cautions.iter().filter(usual).collect()
}

/// OpenFAST up to 4 reads columns by their place and 5 by their titles: both must say the same.
#[test]
fn columns_are_those_of_their_place_and_titles_do_not_speak_against_it() {
    let whole = six(TITLES, UNITS, same).unwrap();
    assert_eq!(others(&whole), Vec::<&String>::new());
    assert!(whole.cautions.iter().any(|text| text.contains("(BldFlDmp(1) = 1.5 %)")), "{:?}", whole.cautions);
    for titles in [
        "r/R Pitch twist mass EI_flap EI_edge",
        "BlFract PitchAxis StrcTwst BMassDen FlpStff",
        "BlFract AeroCent StrcTwst mu EIf EdgStff",
        "(fraction of the blade, and so on)",
    ] {
        let deck = six(titles, UNITS, same).unwrap();
        assert_eq!(
            (deck.table.rows(), deck.frame(20.0)),
            (whole.table.rows(), whole.frame(20.0)),
            "{titles}"
        );
        let said = others(&deck);
        assert!(said.len() == 1 && said[0].contains("read by their place, as OpenFAST up to 4"), "{said:?}");
        assert!(said[0].contains("as `EdgStff`") != titles.ends_with("EdgStff"), "{said:?}");
    }
    for (titles, says) in [
        (
            "BlFract StrcTwst BMassDen FlpStff EdgStff",
            "line 11 of f: the title `StrcTwst` stands over column 2, which is read as `PitchAxis`; 5 titles stand over the 6 numbers of line 13",
        ),
        (
            "BlFract PitchAxis StrcTwst FlpStff EdgStff",
            "`FlpStff` stands over column 4, which is read as `BMassDen`",
        ),
        (
            "BlFract PitchAxis StrcTwst BMassDen EdgStff FlpStff",
            "`EdgStff` stands over column 5, which is read as `FlpStff`. OpenFAST",
        ),
        (
            "BlFract PitchAxis StrcTwst BMassDen FlpStff FlpStff",
            "`FlpStff` stands over column 6, which is read as `EdgStff`",
        ),
        ("BlFract StrcTwst PitchAxis BMassDen FlpStff EdgStff", "`StrcTwst` stands over column 2"),
    ] {
        let message = six(titles, UNITS, same).unwrap_err();
        assert!(message.contains(says), "{message}");
    }
    let deck = six(TITLES, "(-) (-) (deg) (kg/m) (kNm^2) (kNm^2)", same).unwrap();
    let says = "line 12 of f: `FlpStff` has the unit kNm^2";
    assert!(others(&deck).iter().any(|text| text.contains(says)), "{:?}", deck.cautions);
}

/// The 17 columns of FAST 7, by titles of any spelling.
#[test]
fn the_columns_of_fast_7_are_read_by_their_place() {
    let rows = stations();
    let text = |titles: &str| {
        let mut text =
            format!("---\n{} NBlInpSt\n1 AdjBlMs\n1 AdjFlSt\n1 AdjEdSt\n---\n{titles}\nunits\n", rows.len());
        for row @ [fraction, twist, mass, flap, edge] in &rows {
            let [ea, gj, i, j] = more(*row);
            writeln!(
                text,
                "{fraction} 0.25 {twist} {mass} {flap:e} {edge:e} {gj:e} {ea:e} 0 {i} {j} 0 0 0 0.1 0 0"
            )
            .unwrap();
        }
        text
    };
    let read = |text: &str| {
        let find = |_: &str| Ok(Arc::from(text.as_bytes()));
        deck::read(&find, "f", Format::ElastoDyn { length: Some(61.5) }).unwrap()
    };
    let (of_titles, of_places) = (read(&elastodyn()), read(&text("a b c")));
    assert_eq!(of_titles.table.rows(), of_places.table.rows());
    assert!(
        of_places.cautions.iter().any(|text| text.contains("not used here: `EdgcgOf`")),
        "{:?}",
        of_places.cautions
    );
}

/// Other units, a column from tip to root: a blade of its length has no such frequencies, and no such twist.
#[test]
fn an_elastodyn_file_in_other_units_is_told_at_its_line() {
    let scaled = |columns: &'static [usize], factor: f64| {
        move |_: usize, k: usize, x: f64| if columns.contains(&k) { factor * x } else { x }
    };
    let cases: [(&'static [usize], f64, &str); 7] = [
        (&[4, 5], 1e-3, "flapwise at 2.1"),
        (&[4, 5], 1e3, "flapwise at 2.1"),
        (&[4, 5], 1e6, "flapwise at 6.9"),
        (&[4], 1e-3, "with FlpStff = 1.811e7"),
        (&[5], 1e-3, "edgewise at 3.5"),
        (&[3], 1e-3, "BMassDen = 6.789e-1"),
        (&[3], 1e3, "flapwise at 2.1"),
    ];
    for (columns, factor, says) in cases {
        let deck = six(TITLES, UNITS, scaled(columns, factor)).unwrap();
        let is_told = |text: &&String| text.contains("line 13: with") && text.contains(says);
        assert!(
            others(&deck).into_iter().any(|text| is_told(&text)),
            "{columns:?} {factor}: {:?}",
            deck.cautions
        );
        assert!(deck.cautions.iter().all(|text| !text.contains("Iner")), "{:?}", deck.cautions);
    }
    let twists: Vec<f64> = stations().iter().rev().map(|row| row[1]).collect();
    let turned = six(TITLES, UNITS, |i, k, x| if k == 2 { twists[i] } else { x }).unwrap();
    let says = "line 61 of f: the twist grows from 0.0000° at the root to 13.3080° here";
    assert!(others(&turned).iter().any(|text| text.contains(says)), "{:?}", turned.cautions);
}

//! One slip at each place of two real decks: an exponent, a sign, a shifted point, exchanged rows. What must be told is told, wherever it stands.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::decks::{Matrix, Plain, is_true};
use flexion_case::deck::{self, Deck, Format};
use std::collections::BTreeMap;
use std::sync::Arc;

fn all(of: &mut Matrix, factor: f64) {
    of.as_flattened_mut().iter_mut().for_each(|x| *x *= factor);
}

/// Each kind of slip at each station and point of a deck, with the decks that it makes.
fn slips(of: &Plain) -> Vec<(String, Plain)> {
    let mut made: Vec<(String, Plain)> = Vec::new();
    let mut add = |kind: String, change: &dyn Fn(&mut Plain)| {
        let mut other = of.clone();
        change(&mut other);
        if other != *of {
            made.push((kind, other));
        }
    };
    for i in 0..of.eta.len() {
        for f in [10.0, 0.1] {
            for k in 0..6 {
                add(format!("K{0}{0} × {f}", k + 1), &|d| d.stiffness[i][k][k] *= f);
            }
            for k in 3..6 {
                add(format!("M{0}{0} × {f}", k + 1), &|d| d.mass[i][k][k] *= f);
            }
            add(format!("mass × {f}"), &|d| (0..3).for_each(|k| d.mass[i][k][k] *= f));
            add(format!("K × {f}"), &|d| all(&mut d.stiffness[i], f));
            add(format!("M × {f}"), &|d| all(&mut d.mass[i], f));
            if i + 1 < of.eta.len() {
                add(format!("two K × {f}"), &|d| d.stiffness[i..=i + 1].iter_mut().for_each(|k| all(k, f)));
                add(format!("two M × {f}"), &|d| d.mass[i..=i + 1].iter_mut().for_each(|m| all(m, f)));
            }
        }
        for (k, j) in (0..36).map(|at| (at / 6, at % 6)).filter(|(k, j)| j < k) {
            for f in [-1.0, 10.0] {
                add(format!("K off the diagonal × {f}"), &|d| {
                    d.stiffness[i][k][j] *= f;
                    d.stiffness[i][j][k] *= f;
                });
            }
        }
        if i + 1 < of.eta.len() {
            add("stations exchanged".to_owned(), &|d| {
                d.stiffness.swap(i, i + 1);
                d.mass.swap(i, i + 1);
            });
        }
    }
    for i in 0..of.keypoints.len() {
        for (k, name) in ["x", "y", "z", "twist"].into_iter().enumerate() {
            for f in [-1.0, 10.0, 0.1] {
                add(format!("{name} × {f}"), &|d| d.keypoints[i][k] *= f);
            }
            for shift in [1.0, -1.0] {
                add(format!("{name} + {shift}"), &|d| d.keypoints[i][k] += shift);
            }
        }
    }
    made
}

/// Of kinds that move frequencies by per cents none is silent anywhere, at the root and at the tip, too; of all slips there are 16 % silent: those of
/// couplings and of exchanged rows that differ little, of a twist by a degree, of points along the line.
#[test]
fn a_slip_anywhere_in_a_deck_is_told() {
    let mut table: BTreeMap<String, [usize; 2]> = BTreeMap::new();
    for blade in 0..2 {
        for (kind, broken) in slips(&Plain::of(blade)) {
            let silent = broken.read().is_ok_and(|deck| deck.cautions.iter().all(|caution| is_true(caution)));
            let count = table.entry(kind).or_default();
            count[usize::from(silent)] += 1;
        }
    }
    let loud = |kind: &str| {
        ["K11", "K22 × 10", "K33", "K44", "K55", "M", "mass", "K ×", "two", "x +", "y +"]
            .iter()
            .any(|start| kind.starts_with(start))
    };
    for (kind, [told, silent]) in &table {
        assert!(!loud(kind) || *silent == 0, "{kind}: {silent} silent of {}", told + silent);
    }
    let [told, silent] = table.values().fold([0, 0], |sum, count| [sum[0] + count[0], sum[1] + count[1]]);
    assert!(
        told + silent > 3500 && 6 * silent < told + silent,
        "{silent} silent of {}: {table:?}",
        told + silent
    );
}

/// A name, what its caution has, and how it is made.
type Slip<'a> = (&'a str, &'a [&'a str], &'a dyn Fn(&mut Plain));

/// The caution that names a slip, at its line.
#[test]
fn a_slip_is_told_at_its_line_with_its_number() {
    let of = Plain::of(0);
    let last = of.eta.len() - 1;
    let cases: [Slip<'_>; 12] = [
        ("mass of the tip", &["station 26 (eta 1)", "speed of waves", "M33 comes to"], &|d| {
            (0..3).for_each(|k| d.mass[last][k][k] *= 10.0)
        }),
        ("stiffness of the root", &["station 1 (eta 0)", "K33", "behind it, at this end"], &|d| {
            all(&mut d.stiffness[0], 0.1)
        }),
        ("two masses", &["station 12 (eta", "and the next"], &|d| {
            d.mass[11..=12].iter_mut().for_each(|m| all(m, 10.0))
        }),
        ("shear", &["K22 belongs to", "station 12"], &|d| d.stiffness[11][1][1] *= 10.0),
        ("torsion", &["K66 belongs to", "station 12"], &|d| d.stiffness[11][5][5] *= 10.0),
        ("a point aside", &["line 20 of primary.dat: point 13 makes a zigzag", "its x is"], &|d| {
            d.keypoints[12][0] += 1.0
        }),
        ("a sign of a point", &["line 42 of primary.dat: point 35 makes a zigzag"], &|d| {
            d.keypoints[34][0] *= -1.0
        }),
        ("z of a point", &["makes a zigzag"], &|d| d.keypoints[44][2] += 1.0),
        ("all prebend", &["of its length", "unit or a factor of x"], &|d| {
            d.keypoints.iter_mut().for_each(|point| point[0] *= 10.0)
        }),
        ("a twist", &["line 27 of primary.dat: the twist is"], &|d| d.keypoints[19][3] *= 10.0),
        ("K and M in other units", &["density", "no material has it"], &|d| {
            d.stiffness.iter_mut().chain(&mut d.mass).for_each(|of| all(of, 1e6))
        }),
        ("shear in kN", &["is a shear stiffness and", "other units?"], &|d| {
            for k in &mut d.stiffness {
                for (i, j) in (0..36).map(|at| (at / 6, at % 6)) {
                    k[i][j] *= [1e-3_f64, 1.0][usize::from(i > 1)].sqrt()
                        * [1e-3_f64, 1.0][usize::from(j > 1)].sqrt();
                }
            }
        }),
    ];
    for (name, says, change) in cases {
        let mut broken = of.clone();
        change(&mut broken);
        let cautions = broken.read().unwrap_or_else(|error| panic!("{name}: {error}")).cautions;
        let is_told = cautions.iter().any(|caution| says.iter().all(|says| caution.contains(says)));
        assert!(is_told, "{name}: {cautions:#?}");
    }
    // Sizes that no structure has are refused, and shown with few digits.
    for factor in [1e200, 1e-200] {
        let mut broken = of.clone();
        broken.stiffness.iter_mut().chain(&mut broken.mass).for_each(|of| all(of, factor));
        let message = broken.read().unwrap_err();
        assert!(
            message.contains("line 14") && message.contains("in SI units") && message.len() < 250,
            "{message}"
        );
    }
}

fn csv(text: &str) -> Result<Deck, String> {
    deck::read(&|_: &str| Ok(Arc::from(text.as_bytes())), "f", Format::Csv)
}

const TABLE: &str = "x,mass,EA,GJ,EI-flap,EI-chord\n";

/// Steps that a table writes as such, a thick part in the middle and a light tip are legal; a number cut off at the end of the file is none.
#[test]
fn steps_of_a_table_give_no_caution_and_a_cut_number_does() {
    let rows = |of: &[(f64, f64)]| -> String {
        of.iter()
            .map(|(x, d)| {
                let (area, inertia) = (d * d, d.powi(4));
                format!(
                    "{x},{},{:e},{:e},{:e},{:e}\n",
                    2700.0 * area,
                    7e10 * area,
                    1e10 * inertia,
                    6e9 * inertia,
                    7e9 * inertia
                )
            })
            .collect()
    };
    let (thin, thick) = (0.02, 0.06);
    let steps = [(0.0, thin), (1.0, thin), (1.0, thick), (3.0, thick), (3.0, thin), (4.0, thin)];
    let near = [(0.0, thin), (1.0, thin), (1.01, thick), (3.0, thick), (3.01, thin), (4.0, thin)];
    let root = [(0.0, thick), (0.2, thick), (0.25, thin), (1.0, thin), (2.0, 0.5 * thin), (2.1, 0.2 * thin)];
    for of in [&steps[..], &near, &root] {
        let deck = csv(&format!("{TABLE}{}", rows(of))).unwrap();
        assert_eq!(deck.cautions, Vec::<String>::new());
    }
    let cut = rows(&[(0.0, 0.6), (6.0, 0.55), (12.0, 0.5), (18.0, 0.45), (21.0, 0.4)]);
    let at = cut.rfind(',').unwrap() + 2;
    let cautions = csv(&format!("{TABLE}{}", &cut[..at])).unwrap().cautions;
    assert!(
        cautions.iter().any(|text| text.contains("line 6") && text.contains("K66 belongs to")),
        "{cautions:?}"
    );
    let message = csv(&format!(
        "{TABLE}{}",
        cut.replace("7e9", "1e300").replacen(
            &cut[cut.find(',').unwrap()..cut.find('\n').unwrap()],
            ",900,1e300,1e9,1e9,1e9",
            1
        )
    ))
    .unwrap_err();
    assert!(message.contains("line 2: K11 = 1.0000e300 is outside"), "{message}");
}

/// Where a file of `ElastoDyn` says no axial stiffness, a number stands for it of which nothing is said.
#[test]
fn nothing_is_said_of_a_stiffness_that_is_not_in_the_file() {
    let rows: String = (0..20)
        .map(|i| {
            let x = f64::from(i) / 19.0;
            let thin = (1.0 - 0.98 * x).powi(4);
            format!(
                "{x} {} {} {:e} {:e}\n",
                15.0 * (1.0 - x),
                1000.0 * (1.0 - x) + 4.0,
                2e10 * thin,
                2e10 * thin
            )
        })
        .collect();
    let text = format!(
        "---\n20 NBlInpSt\n1 AdjBlMs\n1 AdjFlSt\n1 AdjEdSt\nBlFract StrcTwst BMassDen FlpStff EdgStff\n- - - - -\n{rows}"
    );
    let find = |_: &str| Ok(Arc::from(text.as_bytes()));
    let deck = deck::read(&find, "f", Format::ElastoDyn { length: Some(100.0) }).unwrap();
    let other = |text: &&String| !text.contains("says no axial stiffness");
    assert_eq!(deck.cautions.iter().filter(other).collect::<Vec<_>>(), Vec::<&String>::new());
}

/// Numbers that no structure has, and files that end early or begin late, are refused at their line, with few digits.
#[test]
fn what_cannot_be_is_refused_at_its_line_with_few_digits() {
    let of = Plain::of(0);
    let cases: [Slip<'_>; 5] = [
        ("mu", &["line 9 of blade.dat: mu3 = 1e300 s"], &|d| d.mu[2] = 1e300),
        ("x", &["line 10 of primary.dat: kp_xr = 1.0000e300"], &|d| d.keypoints[2][0] = 1e300),
        ("twist", &["line 10 of primary.dat: initial_twist = -1.0000e300"], &|d| d.keypoints[2][3] = -1e300),
        ("z", &["line 57 of primary.dat: kp_zr"], &|d| d.keypoints[49][2] = 1e300),
        ("M33", &["line 21: M33 = 1.0000e300"], &|d| (0..3).for_each(|k| d.mass[0][k][k] = 1e300)),
    ];
    for (name, says, change) in cases {
        let mut broken = of.clone();
        change(&mut broken);
        let message = broken.read().unwrap_err();
        assert!(message.contains(says[0]) && message.len() < 250, "{name}: {message}");
    }
    let [primary, blade] = of.texts();
    let lines: Vec<&str> = blade.lines().take(40).collect();
    let cut = lines.join("\n");
    let files = [("primary.dat", primary.as_bytes()), ("blade.dat", cut.as_bytes())];
    let message = super::decks::read(&files).unwrap_err();
    assert!(
        message.contains("line 39 of blade.dat: the file ends before the place of station 3 of 26"),
        "{message}"
    );
    let row = |x: f64| format!("{x},600,1e10,4e9,1e10,1.5e10\n");
    for (rows, says) in [
        ([1.0, 2.0, 3.0], "line 2 of f: the rows run from x = 1 m"),
        ([0.0, 2.0, 1.0], "line 4 of f: x = 1 m comes behind 2 m"),
        ([3.0, 2.0, 0.0], "line 3 of f: x = 2 m comes behind 3 m"),
        ([0.0, 2.0, 1e300], "line 4 of f: x = 1.0000e300 is beyond"),
    ] {
        let message = csv(&format!("{TABLE}{}", rows.map(row).concat())).unwrap_err();
        assert!(message.contains(says), "{message}");
    }
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/blades");
    let text = std::fs::read_to_string(folder.join("IEA_15MW_RWT_Blade_st_FPM.st")).unwrap();
    for (from, to, says) in [
        ("-6.0000870286029e+00", "-1e300", "line 6 of f: pitch = -1.0000e300°"),
        ("1.1619906487403e-04", "-1e300", "line 6 of f: x_cg = -1.0000e300"),
    ] {
        assert!(text.contains(from));
        let broken = text.replacen(from, to, 1);
        let find = |_: &str| Ok(Arc::from(broken.as_bytes()));
        let message = deck::read(&find, "f", Format::Hawc2 { set: None, subset: None }).unwrap_err();
        assert!(message.contains(says), "{message}");
    }
}

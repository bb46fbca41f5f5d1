//! Decks of HAWC2, windIO and CSV, held to the decks of BeamDyn of the same blades.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::decks::{Matrix, Plain, read_texts, texts};
use flexion_case::deck::{self, Deck, Format};
use std::path::PathBuf;
use std::sync::Arc;

const HAWC2: Format = Format::Hawc2 { set: None, subset: None };

fn file(name: &str) -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../verification/blades");
    std::fs::read_to_string(folder.join(name)).unwrap()
}

fn read(text: &str, format: Format) -> Result<Deck, String> {
    let find = |_: &str| Ok(Arc::from(text.as_bytes()));
    deck::read(&find, "f", format)
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

/// K about the point (y, z) of the section.
fn about(k: &Matrix, [y, z]: [f64; 2]) -> Matrix {
    let mut w: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| f64::from(u8::from(i == j))));
    (w[0][4], w[0][5], w[1][3], w[2][3]) = (-z, y, z, -y);
    let transposed: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| w[j][i]));
    product(&transposed, &product(k, &w))
}

/// About the centre of the first moments K₁₅ and K₁₆.
fn centred(k: &Matrix) -> Matrix {
    about(k, [-k[0][5] / k[0][0], k[0][4] / k[0][0]])
}

fn assert_near(found: &Matrix, expected: &Matrix, part: f64, what: &str) {
    for i in 0..6 {
        for j in 0..6 {
            let size = (expected[i][i] * expected[j][j]).sqrt();
            assert!(
                (found[i][j] - expected[i][j]).abs() <= part * size,
                "{what} {i} {j}: {:e} {:e}",
                found[i][j],
                expected[i][j]
            );
        }
    }
}

/// The data for HAWC2 are those of another computation of the sections, from the half chord and by another length. About their centres they are the same
/// to 1 % (at the tip 5 %) of √(Kᵢᵢ Kⱼⱼ) with all couplings, their signs and the pitch; a centre on the other side, or a turn the other way, is off by more.
#[test]
fn full_matrices_of_hawc2_are_those_of_beamdyn_about_their_centres() {
    let beamdyn = read_texts(0, &texts(0)).unwrap();
    let hawc2 = read(&file("IEA_15MW_RWT_Blade_st_FPM.st"), HAWC2).unwrap();
    assert_eq!(hawc2.cautions, Vec::<String>::new());
    assert!((hawc2.length / beamdyn.length - 1.0).abs() < 1e-3, "{}", hawc2.length);
    let rows = beamdyn.table.rows().iter().zip(hawc2.table.rows()).enumerate();
    assert_eq!(rows.len(), 26);
    for (n, ((_, a), (_, b))) in rows {
        let part = if n < 25 { 0.01 } else { 0.05 };
        assert_near(&centred(&b.stiffness), &centred(&a.stiffness), part, &format!("K {n}"));
        // Mass and its flapwise moment; the radii of gyration of this file are not about the elastic centre, but about that of mass.
        let [m, of] = [centred(&a.mass), centred(&b.mass)];
        assert!((of[0][0] / m[0][0] - 1.0).abs() < 0.01, "{n}");
        let part = |i: usize| of[i][i] / m[i][i] - 1.0;
        assert!(
            (-0.15..0.01).contains(&part(3)) && (-0.15..0.15).contains(&part(4)),
            "{n}: {} {}",
            part(3),
            part(4)
        );
    }
}

/// The classical columns have no couplings; bending about the elastic centre and masses are those of the full matrices.
#[test]
fn classical_columns_of_hawc2_have_the_bending_of_the_full_matrices() {
    let full = read(&file("IEA_15MW_RWT_Blade_st_FPM.st"), HAWC2).unwrap();
    let text = file("IEA_15MW_RWT_Blade_st_noFPM.st");
    let classical = read(&text, Format::Hawc2 { set: Some(1), subset: Some(1) }).unwrap();
    for (n, ((_, a), (_, b))) in full.table.rows().iter().zip(classical.table.rows()).enumerate() {
        let [k, l] = [centred(&a.stiffness), centred(&b.stiffness)];
        for (i, j) in [(4, 4), (4, 5), (5, 5)] {
            assert!((k[i][j] - l[i][j]).abs() < 1e-6 * (k[i][i] * k[j][j]).sqrt(), "{n} {i} {j}");
        }
        assert_near(&a.mass, &b.mass, 1e-9, &format!("M {n}"));
    }
    assert!(read(&text, Format::Hawc2 { set: Some(2), subset: None }).is_ok());
    let message = read(&text, Format::Hawc2 { set: Some(3), subset: None }).unwrap_err();
    assert!(message.contains("it has 1 1, 2 1"), "{message}");
}

#[test]
fn a_deck_written_for_hawc2_is_read_as_itself() {
    for deck in
        [read_texts(0, &texts(0)).unwrap(), read(&file("IEA_15MW_RWT_Blade_st_FPM.st"), HAWC2).unwrap()]
    {
        let (text, [product, polar]) = deck::write_hawc2(&deck, "a title");
        let again = read(&text, HAWC2).unwrap();
        assert!((deck.length - again.length).abs() < 1e-10 * deck.length);
        let mut lost = [0.0_f64; 2];
        for (n, ((_, a), (_, b))) in deck.table.rows().iter().zip(again.table.rows()).enumerate() {
            assert_near(&b.stiffness, &a.stiffness, 1e-9, &format!("K {n}"));
            // The product of inertia about the axes x_e and y_e has no column: the moments about the mass centre keep their sum,
            // which the polar moment of the deck is to 1e-4.
            let [m, of] = [centred(&a.mass), centred(&b.mass)];
            assert!(
                (a.mass[0][4] - b.mass[0][4]).abs().max((a.mass[0][5] - b.mass[0][5]).abs())
                    < 1e-9 * a.mass[0][0],
                "M {n}"
            );
            assert!(
                (of[3][3] / m[3][3] - 1.0).abs() < 1e-4 && (of[4][4] - m[4][4]).abs() < 0.15 * m[3][3],
                "M {n}"
            );
            // In whatever axes, a product that is missing has the eigenvalues ± its size.
            let off = |i: usize, j: usize| m[i][j] - of[i][j];
            let (product, sum) = ((0.5 * (off(4, 4) - off(5, 5))).hypot(off(4, 5)), m[4][4] + m[5][5]);
            lost = [lost[0].max(product / sum), lost[1].max(off(3, 3).abs() / sum)];
        }
        assert!(
            (product - lost[0]).abs() < 1e-9 && (polar - lost[1]).abs() < 1e-9,
            "{product} {polar} {lost:?}"
        );
    }
}

/// The example of windIO has the sections of the deck of BeamDyn at the same stations.
#[test]
fn windio_has_the_line_and_the_sections_of_beamdyn() {
    let beamdyn = read_texts(0, &texts(0)).unwrap();
    let text = file("IEA-15-240-RWT_windIO.yaml");
    let windio = read(&text, Format::WindIo).unwrap();
    let [caution] = &windio.cautions[..] else { panic!("{:?}", windio.cautions) };
    assert!(caution.contains("gives no damping"), "{caution}");
    assert!((windio.length - beamdyn.length).abs() < 1e-3 && windio.damping.is_none());
    for (n, ((s, a), (t, b))) in beamdyn.table.rows().iter().zip(windio.table.rows()).enumerate() {
        assert!((s - t).abs() < 1e-3, "{n}: {s} {t}");
        assert_near(&b.stiffness, &a.stiffness, 1e-9, &format!("K {n}"));
        assert_near(&b.mass, &a.mass, 1e-9, &format!("M {n}"));
    }
    for k in 0..=20 {
        let s = 117.0 * f64::from(k) / 20.0;
        let (a, b) = (beamdyn.frame(s), windio.frame(s));
        // The deck of BeamDyn has been made of it with another interpolation.
        assert!((a.position - b.position).norm() < 2e-3, "{s}");
        assert!((a.rotation - b.rotation).0.as_flattened().iter().all(|x| x.abs() < 2e-3), "{s}");
    }
    // The words of the schema turn the blade by a right angle.
    let renamed = |text: &str, names: &[(&str, &str)]| {
        let first = names
            .iter()
            .fold(text.to_owned(), |text, (a, b)| text.replace(&format!("{a}:"), &format!("<{b}>:")));
        first.replace('<', "").replace(">:", ":")
    };
    let exchanged =
        renamed(&text, &[("K44", "K55"), ("K55", "K44"), ("i_edge", "i_flap"), ("i_flap", "i_edge")]);
    let message = read(&exchanged, Format::WindIo).unwrap_err();
    for says in ["K44 is smaller than K55", "chord, of up to 5.76", "exchange the rows"] {
        assert!(message.contains(says), "{message}");
    }
    for (from, to, says) in [
        ("elastic_properties:", "other:", "no `components.blade` with `elastic_properties`"),
        ("K66: [87489183048.03288", "K66: [x", "value 1 of `K66` is not a number"),
        ("K66: [87489183048.03288,", "K66: [", "`K66` has 25 values and its grid 26"),
        ("K33: [46051081603.60474", "K33: [-46051081603.60474", "K33 = -"),
        ("mass: [3127", "mass: [-3127", "mass = -"),
        ("reference_axis:", "axis:", "no `reference_axis`"),
        (
            "inertia_matrix:\n                    grid: [0.0, 0.01,",
            "inertia_matrix:\n                    grid: [0.0, 1.00,",
            "ascend from 0 to 1",
        ),
        ("mu: [0.0, 0.0,", "mu: [0.0,", "`mu` has 5 numbers"),
        ("mu: [0.0,", "mu: [-0.1,", "negative"),
        ("components:", "components: [", "is not YAML"),
    ] {
        assert!(text.contains(from), "{from}");
        let message = read(&text.replacen(from, to, 1), Format::WindIo).unwrap_err();
        assert!(message.contains(says), "{from}: {message}");
    }
    let damped = text.replace("mu: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0]", "mu: [1.0e-3, 0, 0, 0, 2e-3, 0]");
    assert_eq!(read(&damped, Format::WindIo).unwrap().damping, Some([0.0, 0.0, 1e-3, 0.0, 2e-3, 0.0]));
}

/// Version 1 of windIO: lists of 21 numbers, the twist in radians.
#[test]
fn older_windio_is_read_too() {
    let of = Plain::of(0);
    let list =
        |values: &[f64]| format!("[{}]", values.iter().map(f64::to_string).collect::<Vec<_>>().join(", "));
    let upper = |of: &Matrix| list(&(0..6).flat_map(|i| (i..6).map(move |j| of[i][j])).collect::<Vec<_>>());
    let rows = |of: &[Matrix]| of.iter().map(|k| format!("            - {}\n", upper(k))).collect::<String>();
    let grid = list(&of.eta);
    let along: Vec<f64> = of.keypoints.iter().map(|point| point[2] / 117.0).collect();
    let column = |k: usize| list(&of.keypoints.iter().map(|point| point[k]).collect::<Vec<_>>());
    let twist: Vec<f64> = of.keypoints.iter().map(|point| point[3].to_radians()).collect();
    let text = format!(
        "components:\n  blade:\n    outer_shape_bem:\n      twist: &t {{grid: &g {}, values: {}}}\n      reference_axis: &a\n        x: {{grid: *g, values: {}}}\n        \
         y: {{grid: [0, 1], values: [0, 0]}}\n        z: {{grid: *g, values: {}}}\n    elastic_properties_mb:\n      six_x_six:\n        reference_axis: *a\n        \
         twist: *t\n        stiff_matrix:\n          grid: {grid}\n          values:\n{}        inertia_matrix:\n          grid: {grid}\n          values:\n{}",
        list(&along),
        list(&twist),
        column(0),
        column(2),
        rows(&of.stiffness),
        rows(&of.mass),
    );
    let (found, expected) = (read(&text, Format::WindIo).unwrap(), read_texts(0, &texts(0)).unwrap());
    assert!((found.length - expected.length).abs() < 1e-9);
    for k in 0..=20 {
        let s = expected.length * f64::from(k) / 20.0;
        assert!((found.frame(s).position - expected.frame(s).position).norm() < 1e-8, "{s}");
        assert!(
            (found.frame(s).rotation - expected.frame(s).rotation)
                .0
                .as_flattened()
                .iter()
                .all(|x| x.abs() < 1e-8),
            "{s}"
        );
        assert_near(&found.matrices(s).stiffness, &expected.matrices(s).stiffness, 1e-8, "K");
    }
}

/// Tables in CSV: matrices in other units, and places of centres, of one section.
#[test]
fn tables_give_matrices_or_centres() {
    use flexion::section::Matrices;
    let plain = Matrices::principal([9e8, 4e7, 3e7, 7e6, 1.1e7, 2.3e7], 40.0, [1.5, 0.5, 1.0]);
    let of = plain
        .with_shear_centre([0.05, 0.01])
        .with_tension_centre([0.04, -0.02])
        .with_mass_centre([-0.03, 0.02]);
    let centres = "x,mass,mass-y [mm],mass-z,inertia-flap,inertia-chord,EA [MN],GA-chord,GA-flap,GJ,EI-flap [kN m^2],EI-chord,tension-y,tension-z,shear-y,\
        shear-z,twist [deg]\n0,40,-30,0.02,0.5,1,900,4e7,3e7,7e6,11000,2.3e7,0.04,-0.02,0.05,0.01,0\n\
        10,40,-30,0.02,0.5,1,900,4e7,3e7,7e6,11000,2.3e7,0.04,-0.02,0.05,0.01,90\n";
    let deck = read(centres, Format::Csv).unwrap();
    assert_eq!(deck.cautions, Vec::<String>::new());
    assert_near(&deck.matrices(3.0).stiffness, &of.stiffness, 1e-12, "K");
    assert_near(&deck.matrices(3.0).mass, &of.mass, 1e-12, "M");
    // Without twist the height is y of the blade; positive about z it turns towards −x.
    for (s, height) in [(0.0, [0.0, 1.0, 0.0]), (10.0, [-1.0, 0.0, 0.0])] {
        let found = deck.frame(s).rotation.column(1);
        assert!((0..3).all(|k| (found[k] - height[k]).abs() < 1e-12), "{s}: {found:?}");
    }
    let k = of.stiffness;
    let (mut titles, mut values) =
        ("x,mass,mass-y,mass-z,inertia-flap,inertia-chord".to_owned(), String::new());
    for i in 0..6 {
        for j in i..6 {
            let (unit, factor) =
                [("kN", 1e-3), ("kN*m", 1e-3), ("kN*m^2", 1e-3)][usize::from(i > 2) + usize::from(j > 2)];
            titles += &format!(",K{}{} [{unit}]", i + 1, j + 1);
            values += &format!(",{:e}", factor * k[i][j]);
        }
    }
    let row = format!(",40,-0.03,0.02,0.5,1{values}\n");
    let full = read(&format!("{titles}\n0{row}10{row}"), Format::Csv).unwrap();
    assert_near(&full.matrices(3.0).stiffness, &k, 1e-12, "K");
    assert_near(&full.matrices(3.0).mass, &of.mass, 1e-12, "M");
    for (text, says) in [
        (centres.replace("GA-flap", "GA"), "a column `GA`"),
        (centres.replace("x,mass,", "x [kg],mass,"), "`kg` is a unit of"),
        (centres.replace("\n10,", "\n-10,"), "line 3 of f: x = -10 m comes behind 0 m"),
        (centres.replace("900", "-900"), "K11 = -"),
        (centres.replacen("900", "inf", 1), "line 2 of f: `inf` under `EA [MN]` is not a number"),
        (centres.replace("tension-y", "tensiony2"), "a column `tensiony2` (did you mean `tension-y`?)"),
        (
            centres.replace("\n10,", "\n# tip\n\n-10,").replace("\n0,40", "\n-20,40"),
            "run from x = -20 m to -10 m",
        ),
        (centres.replacen("11000", "-11000", 1), "line 2: K55 = -"),
        (format!("# a blade\n\n{}", centres.replacen("7e6", "-7e6", 1)), "line 4: K44 = -"),
        (
            centres.replace("twist [deg]", "twist"),
            "line 3 of f: the twist is 90 rad, more than half a revolution: for degrees name the column `twist [deg]`",
        ),
        (centres.lines().take(2).collect::<Vec<_>>().join("\n"), "has 1 rows"),
    ] {
        let message = read(&text, Format::Csv).unwrap_err();
        assert!(message.contains(says), "{message}");
    }
}

/// A table with neither GA nor GJ nor moments of inertia, as those of blades without shear are.
const OLDER: &str = "# a blade\nStation [m], BMassDen, EA, EI_flap, EdgStff, StrcTwst\n0, 1, 2e6, 300, 400, 20\n4, 1, 2e6, 300, 400, 0\n";

#[test]
fn what_a_table_leaves_out_it_is_silent_on() {
    let deck = read(OLDER, Format::Csv).unwrap();
    assert_eq!(deck.silent, deck::Silent { axial: false, shear: true, torsion: true, inertia: [true; 3] });
    let c = deck.matrices(1.0).condensed();
    assert_eq!([c[0][0], c[2][2], c[3][3], deck.matrices(1.0).mass[0][0]], [2e6, 300.0, 400.0, 1.0]);
    assert_eq!(deck.inertia(1.0), [0.0; 3]);
    // ElastoDyn's is positive about the axis from tip to root: at the root the height, y without twist, is turned by 20° towards x; `twist` the other way.
    let named = |title: &str| read(&OLDER.replace("StrcTwst", title), Format::Csv).unwrap();
    let root = |deck: &Deck| deck.frame(0.0).rotation.column(1);
    let turned = 20_f64.to_radians().sin();
    assert!(
        (root(&deck)[0] - turned).abs() < 1e-12
            && (root(&named("strc_twst (deg)"))[0] - turned).abs() < 1e-12
    );
    let deck = named("twist [deg]");
    let (angle, height) = (20_f64.to_radians(), deck.frame(0.0).rotation.column(1));
    assert!((height[0] + angle.sin()).abs() < 1e-12 && (height[1] - angle.cos()).abs() < 1e-12, "{height:?}");
    assert!((deck.line.twist_rate(1.0) - angle / 4.0).abs() < 1e-12);
    // Two rows of a straight blade make one element.
    assert_eq!(deck.breaks(), Vec::<f64>::new());
    // Moments of inertia about one axis alone, and GJ.
    let chord = OLDER.replace("StrcTwst", "StrcTwst, inertia-chord, GJ");
    let chord =
        read(&chord.replace(", 20\n", ", 20, 0.5, 70\n").replace(", 0\n", ", 0, 0.5, 70\n"), Format::Csv)
            .unwrap();
    assert_eq!((chord.inertia(2.0), chord.silent.torsion), ([0.5, 0.0, 0.5], false));
    assert!((chord.matrices(2.0).condensed()[1][1] - 70.0).abs() < 1e-12);
    let radians = OLDER.replace("StrcTwst", "twist").replace(", 20\n", ", 1.2\n");
    let cautions = read(&radians, Format::Csv).unwrap().cautions;
    assert!(
        cautions.iter().any(|text| text.contains("line 3 of f: the twist is 1.2 rad, 68.8°")),
        "{cautions:?}"
    );
    assert!(
        read(&OLDER.replace("StrcTwst", "twist [deg]").replace(", 20\n", ", 200\n"), Format::Csv).is_ok()
    );
}

/// A cantilever by a deck, under a small force across at its tip, with more keys of its beam.
fn cantilever(deck: &str, keys: &str) -> Result<flexion_case::Reading, String> {
    let files: flexion_case::Contents = [("deck.csv".to_owned(), deck.as_bytes().to_vec().into())].into();
    let text = format!(
        "initial = {{ kind = 'static' }}\nrun = {{ duration = 0 }}\n[[beam]]\nname = 'b'\nroot = 'clamped'\nup = [0, 1, 0]\n{keys}\n\
         section = {{ kind = 'deck', file = 'deck.csv', format = 'csv' }}\n[[load]]\non = 'b.tip'\nforce = [0, 1e-3, 0]\n"
    );
    flexion_case::parse_with(text, std::path::Path::new("case.toml"), &[], &files)
        .map_err(|problems| problems.to_string())
}

#[test]
fn a_beam_asks_a_deck_for_what_it_needs_and_no_more() {
    let straight = OLDER.replace(", 20\n", ", 0\n");
    let with = |title: &str, value: &str| {
        straight
            .replace("StrcTwst", &format!("StrcTwst, {title}"))
            .replace(", 0\n", &format!(", 0, {value}\n"))
    };
    let torsion = with("GJ", "70");
    for (deck, keys, says) in [
        (&straight, "torsion = true", "says nothing of torsion"),
        (&torsion, "torsion = true", "give `polar-inertia` of the beam"),
        (&torsion, "shear = true", "does not say how stiff it is in shear"),
        (&torsion, "shear = true", "the columns `GA-chord` and `GA-flap`"),
        (
            &with("GJ, GA-chord, GA-flap", "70, 5e5, 5e5"),
            "shear = true",
            "has no rotary inertia: the column `inertia-chord` and the column `inertia-flap`",
        ),
        (&torsion, "polar-inertia = 1\npoisson-ratio = 0.3", "is of a shape, which this section has not"),
    ] {
        let message = cantilever(deck, keys).map(|_| ()).unwrap_err();
        assert!(message.contains(says), "{keys}: {message}");
    }
    // F L³/(3 EI) with the stiffness along the height.
    let both =
        [(&straight, "planar = true"), (&straight, ""), (&torsion, ""), (&torsion, "polar-inertia = 1")];
    for (deck, keys) in both {
        let run = crate::written::finished(&cantilever(deck, keys).unwrap());
        let tip = run.trajectory.column("b.tip.displacement.y").unwrap()[0];
        assert!((tip / (1e-3 * 64.0 / 1200.0) - 1.0).abs() < 1e-6, "{keys}: {tip}");
    }
}

/// Without shear a caution names what is left out of a deck, and nothing that it has not.
#[test]
fn a_beam_without_shear_says_what_it_leaves_out_of_a_deck() {
    let plain = "x,mass,mass-y,inertia-flap,inertia-chord,EA,GA-chord,GA-flap,GJ,EI-flap,EI-chord\n0,1,0,1e-4,1e-4,2e6,5e5,5e5,70,300,400\n\
                 4,1,0,1e-4,1e-4,2e6,5e5,5e5,70,300,400\n";
    let off = plain.replace(",1,0,", ",1,0.03,");
    let silent = off.replace("GA-chord,GA-flap,", "").replace("5e5,5e5,", "");
    let said = |deck: &str, keys: &str| {
        let cautions = cantilever(deck, keys).unwrap().case.unused_by_run();
        cautions.into_iter().filter(|text| text.contains("is without shear")).collect::<Vec<_>>().join("\n")
    };
    assert_eq!(
        said(plain, ""),
        "beam `b` is without shear: the 6 × 6 sections of its deck are condensed at zero shear force; write `shear = true` to keep all of it"
    );
    assert!(said(&off, "").contains(
        "at zero shear force; the centres of mass, up to 0.0300 m beside the axis, are put on it; write"
    ));
    let silent = said(&silent, "");
    assert!(
        silent.contains("shear: the centres of mass")
            && silent.contains("give the deck its stiffness in shear"),
        "{silent}"
    );
    assert_eq!(said(&off, "shear = true"), "");
}

/// A number that is left out is no zero: of the 21 entries of the stiffness and the seven of the mass each is asked for by its name.
#[test]
fn windio_without_one_of_its_entries_is_refused() {
    let text = file("IEA-15-240-RWT_windIO.yaml");
    for (from, to, says) in [
        ("K16:", "K_16:", "`stiffness_matrix` has no `K16` (is `K_16` meant for it?)"),
        ("K16:", "other:", "`stiffness_matrix` has no `K16`; it has K11, K12"),
        ("cm_x:", "cm_z:", "`inertia_matrix` has no `cm_x` (is `cm_z` meant for it?)"),
        ("i_plr:", "K11:", "`inertia_matrix` has no `i_plr`"),
        ("K16:", "K15:", "the key `K15` stands twice"),
        ("twist:", "torsion:", "the blade has no `outer_shape.twist`"),
        ("outer_shape:", "outer:", "the blade has no `outer_shape.twist`"),
    ] {
        assert!(text.contains(from));
        let message = read(&text.replacen(from, to, 1), Format::WindIo).unwrap_err();
        assert!(message.contains(says) && message.contains("line "), "{message}");
    }
}

/// The moment of inertia about the axis is named by its own column.
#[test]
fn a_polar_moment_of_inertia_that_is_no_sum_is_named() {
    let text = "x,mass,inertia-flap,inertia-chord,polar-inertia,EA,EI-flap,EI-chord\n0,1,1e-4,1e-4,4e-4,2e6,300,400\n4,1,1e-4,1e-4,4e-4,2e6,300,400\n";
    let cautions = read(text, Format::Csv).unwrap().cautions;
    assert!(
        cautions
            .iter()
            .any(|text| text.contains("polar-inertia is 2.0000 times inertia-flap + inertia-chord")),
        "{cautions:?}"
    );
}

/// A row more than the line of `$` announces would be dropped, and the tip with it.
#[test]
fn rows_of_hawc2_are_as_many_as_announced() {
    let text = file("IEA_15MW_RWT_Blade_st_FPM.st");
    let announces = |count: usize| {
        let line = text.lines().find(|line| line.trim_start().starts_with('$')).unwrap();
        let words: Vec<&str> = line.split_whitespace().collect();
        assert!(words[1].parse::<usize>().is_ok(), "{line}");
        let other = line.replacen(words[1], &count.to_string(), 1);
        read(&text.replacen(line, &other, 1), HAWC2)
    };
    let rows = read(&text, HAWC2).unwrap().table.rows().len();
    assert!(announces(rows).is_ok());
    for count in [rows - 1, rows - 6] {
        let message = announces(count).unwrap_err();
        assert!(message.contains(&format!("behind the {count} rows")), "{message}");
    }
    assert!(announces(rows + 1).is_err());
}

/// A line of windIO that does not begin at the origin is put at the start of the beam, which is said; that it is swept is not.
#[test]
fn windio_that_begins_beside_the_origin_is_told() {
    let text = file("IEA-15-240-RWT_windIO.yaml");
    let whole = read(&text, Format::WindIo).unwrap();
    let at = text.find("reference_axis").unwrap();
    let y = at + text[at..].find("y:").unwrap();
    let values = y + text[y..].find("values: [").unwrap() + "values: [".len();
    let end = values + text[values..].find(']').unwrap();
    let moved: Vec<String> =
        text[values..end].split(',').map(|x| (x.trim().parse::<f64>().unwrap() + 1.5).to_string()).collect();
    let broken = format!("{}{}{}", &text[..values], moved.join(", "), &text[end..]);
    let deck = read(&broken, Format::WindIo).unwrap();
    assert!((deck.length - whole.length).abs() < 1e-9);
    let new: Vec<&String> = deck.cautions.iter().filter(|text| !whole.cautions.contains(text)).collect();
    assert!(new.len() == 1 && new[0].contains("`reference_axis` begins at (0, 1.5, 0) m"), "{new:?}");
    let [primary, _] = deck::write_beamdyn(&deck, "t", "b.dat").unwrap();
    let first = primary.lines().skip_while(|line| !line.contains("initial_twist")).nth(2).unwrap();
    let numbers: Vec<f64> = first.split_whitespace().map(|x| x.parse().unwrap()).collect();
    assert_eq!(numbers[..3], [0.0; 3], "{first}");
}

/// Three blades of one deck have each caution once, with their names.
#[test]
fn what_holds_for_the_blades_of_a_rotor_is_said_once() {
    let beam = |name: &str, direction: &str| {
        format!(
            "[[beam]]\nname = '{name}'\ndirection = {direction}\nup = [0, 0, 1]\nroot = 'clamped'\nsection = {{ kind = 'deck', file = '../verification/blades/IEA-15-240-RWT_BeamDyn.dat', \
             format = 'beamdyn' }}\n"
        )
    };
    let text = format!(
        "run.duration = 0\n{}{}{}",
        beam("one", "[1, 0, 0]"),
        beam("two", "[-0.5, 0.8660254037844386, 0]"),
        beam("three", "[-0.5, -0.8660254037844386, 0]")
    );
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("case.toml");
    let cautions =
        flexion_case::parse(text, &folder, &[]).unwrap_or_else(|problems| panic!("{problems}")).case.cautions;
    let said = |what: &str| cautions.iter().filter(|text| text.contains(what)).collect::<Vec<_>>();
    assert_eq!(
        (said("settings of BeamDyn").len(), said("by rows, as the format").len()),
        (1, 1),
        "{cautions:#?}"
    );
    let of = said("without shear");
    assert!(
        of.len() == 1 && of[0].starts_with("each of the beams `one`, `two`, `three` is without shear"),
        "{of:#?}"
    );
}

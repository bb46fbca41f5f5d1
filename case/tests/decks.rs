//! Decks of blades: what is read of them, held to numbers of another program.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use flexion_case::deck::{self, Deck, Format};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

pub type Matrix = [[f64; 6]; 6];

/// A deck of BeamDyn as numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Plain {
    pub keypoints: Vec<[f64; 4]>,
    pub eta: Vec<f64>,
    pub stiffness: Vec<Matrix>,
    pub mass: Vec<Matrix>,
    pub mu: [f64; 6],
}

pub fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The primary and the blade file of two blades.
pub const BLADES: [[&str; 2]; 2] = [
    ["IEA-15-240-RWT_BeamDyn.dat", "IEA-15-240-RWT_BeamDyn_blade.dat"],
    ["NRELOffshrBsline5MW_BeamDyn.dat", "NRELOffshrBsline5MW_BeamDyn_Blade.dat"],
];

/// The texts of both files of a blade.
pub fn texts(blade: usize) -> [String; 2] {
    BLADES[blade].map(|name| std::fs::read_to_string(root().join("verification/blades").join(name)).unwrap())
}

/// The deck of files by name, of which the first is given.
pub fn read(files: &[(&str, &[u8])]) -> Result<Deck, String> {
    let all: BTreeMap<&str, Arc<[u8]>> =
        files.iter().map(|(name, bytes)| (*name, Arc::from(*bytes))).collect();
    let find = |name: &str| all.get(name).cloned().ok_or_else(|| format!("there is no file {name}"));
    deck::read(&find, files[0].0, Format::BeamDyn)
}

/// The deck of the texts of a blade.
pub fn read_texts(blade: usize, [primary, sections]: &[String; 2]) -> Result<Deck, String> {
    let [a, b] = BLADES[blade];
    read(&[(a, primary.as_bytes()), (b, sections.as_bytes())])
}

impl Plain {
    /// The numbers of a blade.
    pub fn of(blade: usize) -> Plain {
        let [primary, sections] = texts(blade);
        let numbers =
            |line: &str| -> Vec<f64> { line.split_whitespace().map_while(|x| x.parse().ok()).collect() };
        let keypoints = primary.lines().map(numbers).filter(|row| row.len() == 4);
        let lines: Vec<Vec<f64>> =
            sections.lines().map(numbers).filter(|row| matches!(row.len(), 1 | 6)).collect();
        let mu = lines.iter().find(|row| row.len() == 6).unwrap();
        let all: Vec<&Vec<f64>> = lines.iter().skip_while(|row| *row != mu).skip(1).collect();
        let mut of = Plain {
            keypoints: keypoints.map(|row| row.try_into().unwrap()).collect(),
            eta: Vec::new(),
            stiffness: Vec::new(),
            mass: Vec::new(),
            mu: mu.clone().try_into().unwrap(),
        };
        for station in all.chunks(13) {
            let matrix = |from: usize| -> Matrix {
                std::array::from_fn(|i| station[from + i].clone().try_into().unwrap())
            };
            of.eta.push(station[0][0]);
            of.stiffness.push(matrix(1));
            of.mass.push(matrix(7));
        }
        of
    }

    /// One of the random decks of `references/section_beam`.
    pub fn random(of: &Value) -> Plain {
        let list =
            |of: &Value| -> Vec<f64> { of.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() };
        let rows = |key: &str| -> Vec<Vec<f64>> { of[key].as_array().unwrap().iter().map(list).collect() };
        let stiffness = rows("stiffness").into_iter().map(|upper| {
            let (mut k, mut values) = ([[0.0; 6]; 6], upper.into_iter());
            for i in 0..6 {
                for j in i..6 {
                    k[i][j] = values.next().unwrap();
                    k[j][i] = k[i][j];
                }
            }
            k
        });
        let mass = rows("mass").into_iter().map(|values| {
            let [m, x, y, edge, flap, cross] = values.try_into().unwrap();
            let mut of = [[0.0; 6]; 6];
            (0..3).for_each(|i| of[i][i] = m);
            for (i, j, value) in
                [(0, 5, -m * y), (1, 5, m * x), (2, 3, m * y), (2, 4, -m * x), (3, 4, -cross)]
            {
                (of[i][j], of[j][i]) = (value, value);
            }
            (of[3][3], of[4][4], of[5][5]) = (edge, flap, edge + flap);
            of
        });
        Plain {
            keypoints: rows("keypoints").into_iter().map(|row| row.try_into().unwrap()).collect(),
            eta: list(&of["eta"]),
            stiffness: stiffness.collect(),
            mass: mass.collect(),
            mu: [0.0; 6],
        }
    }

    /// Primary file and blade file.
    pub fn texts(&self) -> [String; 2] {
        let row =
            |values: &[f64]| values.iter().map(|x| format!("{x:e}")).collect::<Vec<_>>().join(" ") + "\n";
        let count = self.keypoints.len();
        let keypoints: String = self.keypoints.iter().map(|point| row(point)).collect();
        let primary = format!(
            "--- primary\ntitle\n1 member_total\n{count} kp_total\n1 {count}\n kp_xr kp_yr kp_zr twist\n (m) (m) (m) (deg)\n{keypoints}--- MESH\n\
             5 order_elem\n--- MATERIAL\n\"blade.dat\" BldFile\n"
        );
        let matrix = |of: &Matrix| -> String { of.iter().map(|values| row(values)).collect() };
        let stations: String = (0..self.eta.len())
            .map(|i| format!("{}\n{}\n{}\n", self.eta[i], matrix(&self.stiffness[i]), matrix(&self.mass[i])))
            .collect();
        let damped = u8::from(self.mu != [0.0; 6]);
        let blade = format!(
            "--- blade\ntitle\n--- PARAMETERS\n{} station_total\n{damped} damp_type\n--- DAMPING\n mu1 mu2\n (s) (s)\n{}--- DISTRIBUTED\n{stations}",
            self.eta.len(),
            row(&self.mu)
        );
        [primary, blade]
    }

    /// The deck of these numbers.
    pub fn read(&self) -> Result<Deck, String> {
        let [primary, blade] = self.texts();
        read(&[("primary.dat", primary.as_bytes()), ("blade.dat", blade.as_bytes())])
    }
}

/// Whether a caution is true of the two real decks: the two senses of damping times differ.
pub fn is_true(caution: &str) -> bool {
    caution.contains("by rows, as the format has it")
}

/// Length, mass, centre of mass and frames are those of `references/section_beam/blades.py`, an implementation of its own with NumPy.
#[test]
fn real_decks_have_the_lines_and_masses_of_another_program() {
    let data = std::fs::read_to_string(root().join("references/section_beam/data/blades.json")).unwrap();
    let data: Value = serde_json::from_str(&data).unwrap();
    for (blade, key) in ["iea_15mw", "nrel_5mw"].into_iter().enumerate() {
        let deck = read_texts(blade, &texts(blade)).unwrap();
        let expected = |of: &Value| of.as_f64().unwrap();
        let of = &data[key];
        let near = |found: f64, value: &Value, part: f64| {
            assert!((found - expected(value)).abs() <= part, "{key}: {found} for {value}");
        };
        let (mass, centre) = deck.mass();
        near(deck.length, &of["length"], 1e-10);
        near(mass, &of["mass"], 1e-7);
        (0..3).for_each(|k| near(centre[k], &of["centre"][k], 1e-9));
        let frames = of["frames"].as_array().unwrap();
        assert_eq!(frames.len(), 10);
        for at in frames {
            let frame = deck.frame(expected(&at["s"]));
            for k in 0..3 {
                near(frame.position[k], &at["place"][k], 1e-9);
                (0..3).for_each(|j| near(frame.rotation.column(j)[k], &at["axes"][j][k], 1e-9));
            }
        }
        for caution in &deck.cautions {
            assert!(is_true(caution), "{key}: {caution}");
        }
        assert!(deck.notes[0].contains("order_elem"), "{:?}", deck.notes);
    }
}

/// A station has the file's entries in the axes tangent, height, across = (z, y, −x), and between stations those in proportion to z.
#[test]
fn sections_are_those_of_the_file_in_the_order_of_this_program() {
    let of = Plain::of(0);
    let deck = of.read().unwrap();
    let (place, sign) = ([2, 1, 0, 5, 4, 3], [1.0, 1.0, -1.0, 1.0, 1.0, -1.0]);
    for (n, (_, section)) in deck.table.rows().iter().enumerate() {
        for i in 0..6 {
            for j in 0..6 {
                for (found, file) in [(&section.stiffness, &of.stiffness[n]), (&section.mass, &of.mass[n])] {
                    let expected = sign[i] * sign[j] * file[place[i]][place[j]];
                    let size = (file[place[i]][place[i]] * file[place[j]][place[j]]).sqrt();
                    assert!(
                        (found[i][j] - expected).abs() <= 1e-9 * size,
                        "{n} {i} {j}: {} {expected}",
                        found[i][j]
                    );
                }
                let damping = (of.mu[place[i]] * of.mu[place[j]]).sqrt() * section.stiffness[i][j];
                assert!((section.damping[i][j] - damping).abs() <= 1e-12 * damping.abs(), "{n} {i} {j}");
            }
        }
    }
    let s = 0.895 * deck.length;
    let z = deck.frame(s).position[2];
    let share = (z / 117.0 - 0.85) / 0.05;
    let (a, b) = (
        of.mass[of.eta.iter().position(|eta| *eta == 0.85).unwrap()][0][0],
        of.mass[of.eta.iter().position(|eta| *eta == 0.9).unwrap()][0][0],
    );
    assert!(share > 0.9 && share < 1.0, "{share}");
    assert!((deck.matrices(s).mass[0][0] - (a + share * (b - a))).abs() < 1e-9);
    // 48 keypoints and 24 stations between root and tip.
    assert_eq!(deck.breaks().len(), 48 + 24);
}

/// No alarm for 200 decks drawn at random.
#[test]
fn legal_decks_give_no_caution() {
    let data = std::fs::read_to_string(root().join("references/section_beam/data/decks.json")).unwrap();
    let data: Value = serde_json::from_str(&data).unwrap();
    let decks = data.as_array().unwrap();
    assert_eq!(decks.len(), 200);
    for (number, of) in decks.iter().enumerate() {
        let deck = Plain::random(of).read().unwrap_or_else(|error| panic!("{number}: {error}"));
        assert_eq!(deck.cautions, Vec::<String>::new(), "{number}");
    }
}

/// What the format allows changes nothing.
#[test]
fn one_deck_in_many_spellings_is_one_deck() {
    let plain = texts(1);
    let expected = read_texts(1, &plain).unwrap();
    let same = |what: &str, bytes: [Vec<u8>; 2]| {
        let deck = read(&[(BLADES[1][0], &bytes[0]), (BLADES[1][1], &bytes[1])])
            .unwrap_or_else(|error| panic!("{what}: {error}"));
        assert_eq!(deck.table, expected.table, "{what}");
        assert_eq!((deck.length, deck.frame(31.0)), (expected.length, expected.frame(31.0)), "{what}");
    };
    let both = |of: &dyn Fn(&str) -> String| [of(&plain[0]).into_bytes(), of(&plain[1]).into_bytes()];
    same("CRLF", both(&|text| text.replace('\n', "\r\n")));
    same("tabs", both(&|text| text.replace("  ", "\t")));
    same("blank lines", both(&|text| text.replace('\n', "\n\n")));
    same("exponents with D", both(&|text| text.replace("E+", "D+").replace("E-", "d-")));
    same("comments", both(&|text| text.replace("E+00\n", "E+00  ! a comment, and 3 words\n")));
    same("commas", both(&|text| text.replace("E+00    ", "E+00,   ")));
    let keys = ["member_total", "kp_total", "station_total", "damp_type", "BldFile"];
    same(
        "upper case",
        both(&|text| keys.iter().fold(text.to_owned(), |text, key| text.replace(key, &key.to_uppercase()))),
    );
    same("apostrophes", both(&|text| text.replace('"', "'")));
    same("older key", both(&|text| text.replace("damp_type", "damp_flag")));
    let mut latin = both(&|text| text.to_owned());
    latin.iter_mut().for_each(|bytes| {
        bytes.splice(10..10, [0xfc, 0xe9]);
    });
    same("Latin-1", latin);
    same(
        "zeros repeated",
        both(&|text| text.replace("   0.000000E+00    0.000000E+00    0.000000E+00\n", " 3*0.0\n")),
    );
    same("no blank lines between matrices", both(&|text| text.replace("\n\n", "\n")));
    let words = |text: &str| text.replace("\n\n", "\nmass matrix or the next station\n");
    same("words between matrices", [plain[0].clone().into_bytes(), words(&plain[1]).into_bytes()]);
    let modal = "---- Modal Damping\n4 n_modes - number\n0.01 0.02 0.03 0.04 zeta\n ---------------------- DISTRIBUTED";
    let newer = plain[1].replace(" ---------------------- DISTRIBUTED", modal);
    assert!(newer.contains("n_modes"));
    same("modal damping beside it", [plain[0].clone().into_bytes(), newer.into_bytes()]);
    // A row over two lines.
    let halves = |text: &str| {
        text.replace("E+00    0.000000E+00    0.000000E+00\n", "E+00\n 0.000000E+00    0.000000E+00\n")
    };
    same("rows over two lines", [plain[0].clone().into_bytes(), halves(&plain[1]).into_bytes()]);
}

#[test]
fn a_blade_file_is_looked_for_beside_the_file_that_names_it() {
    let of = Plain::of(1);
    let [primary, blade] = of.texts();
    let with = |name: &str| primary.replace("blade.dat", name).into_bytes();
    for (first, named, second) in [
        ("decks/primary.dat", "blade.dat", "decks/blade.dat"),
        ("decks/primary.dat", "sub\\my blade.dat", "decks/sub/my blade.dat"),
        ("decks/primary.dat", "../blade.dat", "decks/../blade.dat"),
        ("decks/primary.dat", "/all/blade.dat", "/all/blade.dat"),
    ] {
        let deck = read(&[(first, &with(named)), (second, blade.as_bytes())]);
        assert!(deck.is_ok(), "{named}: {:?}", deck.err());
    }
    let message =
        read(&[("decks/primary.dat", &with("blade.dat")), ("blade.dat", blade.as_bytes())]).unwrap_err();
    assert!(message.contains("line 78 of decks/primary.dat") || message.contains("`BldFile`"), "{message}");
    assert!(message.contains("there is no file decks/blade.dat"), "{message}");
}

/// What is written is read again as the same deck, to the digits that are written.
#[test]
fn a_deck_written_for_beamdyn_is_read_as_itself() {
    let data = std::fs::read_to_string(root().join("references/section_beam/data/decks.json")).unwrap();
    let data: Value = serde_json::from_str(&data).unwrap();
    let random = data.as_array().unwrap().iter().step_by(20).map(Plain::random);
    for of in [Plain::of(0), Plain::of(1)].into_iter().chain(random) {
        let deck = of.read().unwrap();
        let [primary, blade] = deck::write_beamdyn(&deck, "a title", "sections.dat").unwrap();
        let again = read(&[("main.dat", primary.as_bytes()), ("sections.dat", blade.as_bytes())]).unwrap();
        assert_eq!((deck.damping, deck.cautions.len()), (again.damping, again.cautions.len()));
        assert!((deck.length - again.length).abs() < 1e-11 * deck.length);
        for k in 0..=40 {
            let s = deck.length * f64::from(k) / 40.0;
            let (a, b) = (deck.frame(s), again.frame(s));
            assert!((a.position - b.position).norm() < 1e-10 * deck.length, "{k}");
            let turned = (a.rotation - b.rotation).0;
            assert!(turned.as_flattened().iter().all(|x| x.abs() < 1e-9), "{k}: {turned:?}");
            let (a, b) = (deck.matrices(s), again.matrices(s));
            for (a, b) in [(a.stiffness, b.stiffness), (a.damping, b.damping), (a.mass, b.mass)] {
                for i in 0..6 {
                    for j in 0..6 {
                        assert!(
                            (a[i][j] - b[i][j]).abs() <= 1e-10 * (a[i][i] * a[j][j]).sqrt(),
                            "{k} {i} {j}"
                        );
                    }
                }
            }
        }
    }
}

/// A blade whose x is along the axis of rotation goes ahead with its leading edge, −y; turned by 180° with the trailing edge, by 90° with its flat side.
#[test]
fn a_blade_that_is_mounted_wrong_has_a_caution() {
    let deck = "{ kind = \"deck\", file = \"IEA-15-240-RWT_BeamDyn.dat\", format = \"beamdyn\" }";
    let read = |text: String| {
        let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../verification/blades/case.toml");
        flexion_case::parse(text, &file, &[]).unwrap().case.cautions
    };
    let of = |up: &str, axis: &str| {
        read(format!(
            "run.duration = 0\n[rotation]\naxis = {axis}\n[[beam]]\nstart = [4, 0, 0]\nup = {up}\nroot = \"clamped\"\nshear = true\nsection = {deck}\n"
        ))
    };
    let mounted = |all: &[String]| {
        all.iter().filter(|caution| caution.contains("the blade `")).cloned().collect::<Vec<_>>()
    };
    for (up, axis, says) in [
        ("[0, 1, 0]", "[0, 0, -1]", None),
        ("[0, -1, 0]", "[0, 0, 1]", None),
        ("[0, 1, 0]", "[0, 0, 1]", Some("goes ahead with its trailing edge")),
        ("[0, 0, 1]", "[0, 0, 1]", Some("has its chord across its motion")),
        ("[0, 1, 0]", "[1, 0, 0]", Some("rotates about its own axis")),
    ] {
        let found = mounted(&of(up, axis));
        match (says, &found[..]) {
            (None, []) => {}
            (Some(says), [caution]) if caution.contains(says) => {}
            _ => panic!("{up} {axis}: {found:?}"),
        }
    }
    // The hub of the short spelling carries it with its leading edge ahead, whatever the format.
    for section in [deck, "{ kind = \"deck\", file = \"IEA-15-240-RWT_windIO.yaml\", format = \"windio\" }"] {
        let short = |pitch: &str, motion: &str| {
            let motion = if motion.is_empty() { String::new() } else { format!(", motion = {motion}") };
            read(format!(
                "run.duration = 2\nbeam = {{ shear = true, pitch = {pitch} }}\nsection = {section}\nhub = {{ radius = 4{motion} }}\nmodel.coupling = \"space-shear\"\n"
            ))
        };
        for (sense, motions) in [
            (
                "positive",
                ["", "{ kind = \"constant\", speed = 0.8 }", "{ kind = \"spin-up\", speed = 0.8, time = 1 }"],
            ),
            (
                "negative",
                [
                    "{ kind = \"constant\", speed = -0.8 }",
                    "{ kind = \"spin-up\", speed = -0.8, time = 1 }",
                    "{ kind = \"ramp\", speed = -0.8, time = 1 }",
                ],
            ),
        ] {
            for motion in motions {
                let [ahead, behind] = if sense == "positive" { ["0", "3.14159"] } else { ["3.14159", "0"] };
                assert_eq!(mounted(&short(ahead, motion)), Vec::<String>::new(), "{motion}");
                let said = mounted(&short(behind, motion));
                assert!(said[0].contains("trailing edge") && said[0].contains(sense), "{motion}: {said:?}");
            }
        }
    }
}

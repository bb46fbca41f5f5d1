//! Broken decks: none is silent. Each is one of the two real decks with one thing wrong, and the message or the caution says what speaks for it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use super::decks::{BLADES, Matrix, Plain, is_true, read, read_texts, texts};

/// A name, what its message has, and how it is broken; the first station that is touched is the 11th.
type Broken = (&'static str, &'static str, fn(&mut Plain));

const AT: usize = 10;

fn scaled(of: &mut Matrix, rows: [f64; 6]) {
    (0..6).for_each(|i| (0..6).for_each(|j| of[i][j] *= (rows[i] * rows[j]).sqrt()));
}

/// All matrices in other units: rows of forces and of moments.
fn all(of: &mut [Matrix], force: f64, moment: f64) {
    of.iter_mut().for_each(|of| scaled(of, [force, force, force, moment, moment, moment]));
}

fn entry(of: &mut [Matrix], i: usize, j: usize, part: f64) {
    let of = &mut of[AT];
    let value = part * (of[i][i] * of[j][j]).sqrt();
    (of[i][j], of[j][i]) = (value, value);
}

fn reordered(of: &mut [Matrix], order: [usize; 6]) {
    for of in of {
        let old = *of;
        (0..6).for_each(|i| (0..6).for_each(|j| of[i][j] = old[order[i]][order[j]]));
    }
}

fn points(d: &mut Plain, factors: [f64; 4]) {
    d.keypoints.iter_mut().for_each(|point| (0..4).for_each(|k| point[k] *= factors[k]));
}

/// A quarter of a turn of the section's axes: x and y exchanged, with the signs of a rotation.
fn turned(of: &mut [Matrix]) {
    reordered(of, [1, 0, 2, 4, 3, 5]);
    for of in of {
        for i in [0, 3] {
            (0..6).for_each(|j| of[i][j] = -of[i][j]);
            (0..6).for_each(|j| of[j][i] = -of[j][i]);
        }
    }
}

const MM: f64 = 1e3;
const INCH: f64 = 1.0 / 0.0254;
const POUND: f64 = 1.0 / 4.448_221_615;
const POUND_MASS: f64 = 1.0 / 0.453_592_37;

static BROKEN: [Broken; 86] = [
    ("asymmetric K34", "K34", |d| {
        d.stiffness[AT][2][3] += 0.02 * (d.stiffness[AT][2][2] * d.stiffness[AT][3][3]).sqrt()
    }),
    ("asymmetric K53", "K53", |d| {
        d.stiffness[AT][4][2] += 0.02 * (d.stiffness[AT][2][2] * d.stiffness[AT][4][4]).sqrt()
    }),
    ("asymmetric K16", "K16", |d| {
        d.stiffness[AT][0][5] += 0.02 * (d.stiffness[AT][0][0] * d.stiffness[AT][5][5]).sqrt()
    }),
    ("asymmetric K62", "K62", |d| {
        d.stiffness[AT][5][1] += 0.02 * (d.stiffness[AT][1][1] * d.stiffness[AT][5][5]).sqrt()
    }),
    ("asymmetric K12", "K12", |d| {
        d.stiffness[AT][0][1] += 0.02 * (d.stiffness[AT][0][0] * d.stiffness[AT][1][1]).sqrt()
    }),
    ("asymmetric K45", "K45", |d| {
        d.stiffness[AT][3][4] += 0.02 * (d.stiffness[AT][3][3] * d.stiffness[AT][4][4]).sqrt()
    }),
    ("asymmetric M45", "M45", |d| d.mass[AT][3][4] += 0.02 * (d.mass[AT][3][3] * d.mass[AT][4][4]).sqrt()),
    ("lower triangle of M empty", "equal in the symmetric matrix", |d| {
        d.mass.iter_mut().for_each(|m| (0..6).for_each(|i| (0..i).for_each(|j| m[i][j] = 0.0)))
    }),
    ("sign of one entry of M", "M34", |d| d.mass[AT][2][3] = -d.mass[AT][2][3]),
    ("K34 too large", "K34", |d| entry(&mut d.stiffness, 2, 3, 1.1)),
    ("K35 too large", "K35", |d| entry(&mut d.stiffness, 2, 4, -1.3)),
    ("K12 too large", "K12", |d| entry(&mut d.stiffness, 0, 1, 2.0)),
    ("K16 too large", "K16", |d| entry(&mut d.stiffness, 0, 5, 1.01)),
    ("K45 too large", "K45", |d| entry(&mut d.stiffness, 3, 4, 30.0)),
    ("indefinite, each pair in bounds", "positive definite", |d| {
        [(2, 3, 0.9), (2, 4, 0.9), (3, 4, -0.5)]
            .into_iter()
            .for_each(|(i, j, x)| entry(&mut d.stiffness, i, j, x))
    }),
    ("K11 = 0", "K11 = 0", |d| d.stiffness[AT][0][0] = 0.0),
    ("K33 < 0", "K33 = -", |d| d.stiffness[AT][2][2] *= -1.0),
    ("K66 = 0", "K66 = 0", |d| d.stiffness[AT][5][5] = 0.0),
    ("K55 < 0", "K55 = -", |d| d.stiffness[AT][4][4] *= -1.0),
    ("negative mass", "the mass per length", |d| (0..3).for_each(|i| d.mass[AT][i][i] *= -1.0)),
    ("no mass", "the mass per length", |d| d.mass[AT] = [[0.0; 6]; 6]),
    ("negative moment of inertia", "M55 = -", |d| d.mass[AT][4][4] *= -1.0),
    ("no polar moment", "M66 = 0", |d| d.mass[AT][5][5] = 0.0),
    ("three masses", "M11, M22 and M33", |d| d.mass[AT][1][1] *= 1.5),
    ("M12 not zero", "M12", |d| entry(&mut d.mass, 0, 1, 0.3)),
    ("M36 not zero", "M36", |d| entry(&mut d.mass, 2, 5, 0.3)),
    ("M14 not zero", "M14", |d| entry(&mut d.mass, 0, 3, 0.3)),
    ("M34 unlike M16", "times an offset", |d| entry(&mut d.mass, 2, 3, 0.7)),
    ("M35 unlike M26", "times an offset", |d| entry(&mut d.mass, 2, 4, 0.7)),
    ("stations exchanged", "stations ascend", |d| d.eta.swap(AT, AT + 1)),
    ("three stations at one place", "does not ascend", |d| {
        (d.eta[AT + 1], d.eta[AT + 2]) = (d.eta[AT], d.eta[AT])
    }),
    ("stations in per cent", "per cent", |d| d.eta.iter_mut().for_each(|eta| *eta *= 100.0)),
    ("stations in metres", "in metres", |d| {
        let length = d.keypoints.last().unwrap()[2];
        d.eta.iter_mut().for_each(|eta| *eta *= length)
    }),
    ("stations in thousandths", "must run from 0 to 1", |d| d.eta.iter_mut().for_each(|eta| *eta *= 1000.0)),
    ("no station at the root", "must run from 0 to 1", |d| d.eta[0] = 0.002),
    ("no station at the tip", "must run from 0 to 1", |d| *d.eta.last_mut().unwrap() = 0.9995),
    ("keypoints exchanged", "kp_zr of keypoint 12", |d| d.keypoints.swap(AT, AT + 1)),
    ("a keypoint twice", "kp_zr of keypoint 12", |d| d.keypoints[AT + 1] = d.keypoints[AT]),
    ("keypoints from the tip", "keypoints ascend", |d| d.keypoints.reverse()),
    ("keypoints in mm", "in metres?", |d| points(d, [MM, MM, MM, 1.0])),
    ("keypoints in cm", "in metres?", |d| points(d, [100.0, 100.0, 100.0, 1.0])),
    ("keypoints in inches", "in metres?", |d| points(d, [INCH, INCH, INCH, 1.0])),
    ("keypoints in km", "ratio", |d| points(d, [1e-3, 1e-3, 1e-3, 1.0])),
    ("x of keypoints in mm", "inclined", |d| {
        d.keypoints[40][0] += 0.9;
        points(d, [MM, 1.0, 1.0, 1.0])
    }),
    ("prebend in the column of y", "are both exchanged?", |d| {
        d.keypoints.iter_mut().enumerate().for_each(|(i, k)| (k[0], k[1]) = (0.0, 1e-3 * (i * i) as f64))
    }),
    ("twist in radians", "radians", |d| points(d, [1.0, 1.0, 1.0, 1f64.to_radians()])),
    ("twist in degrees twice", "the twist reaches", |d| points(d, [1.0, 1.0, 1.0, 1f64.to_degrees()])),
    ("K in N mm²", "radius of gyration", |d| all(&mut d.stiffness, 1.0, MM * MM)),
    ("K in N cm²", "radius of gyration", |d| all(&mut d.stiffness, 1.0, 1e4)),
    ("K in kN", "speed √(EA/m)", |d| all(&mut d.stiffness, 1e-3, 1e-3)),
    ("K in MN", "speed √(EA/m)", |d| all(&mut d.stiffness, 1e-6, 1e-6)),
    ("K in lb and lb in²", "radius of gyration", |d| all(&mut d.stiffness, POUND, POUND * INCH * INCH)),
    ("K and M in lb and inches", "radius of gyration", |d| {
        all(&mut d.stiffness, POUND, POUND * INCH * INCH);
        all(&mut d.mass, POUND_MASS / INCH, POUND_MASS * INCH);
    }),
    ("all in lb and inches", "in metres?", |d| {
        all(&mut d.stiffness, POUND, POUND * INCH * INCH);
        all(&mut d.mass, POUND_MASS / INCH, POUND_MASS * INCH);
        points(d, [INCH, INCH, INCH, 1.0]);
    }),
    ("all in N, mm and t", "speed √(EA/m)", |d| {
        all(&mut d.stiffness, 1.0, MM * MM);
        all(&mut d.mass, 1e-3 / MM, 1e-3 * MM);
        points(d, [MM, MM, MM, 1.0]);
    }),
    ("all in N, mm and kg", "speed √(EA/m)", |d| {
        all(&mut d.stiffness, 1.0, MM * MM);
        all(&mut d.mass, 1.0 / MM, MM);
        points(d, [MM, MM, MM, 1.0]);
    }),
    ("M in t/m", "speed √(EA/m)", |d| all(&mut d.mass, 1e-3, 1e-3)),
    ("M in g/m", "speed √(EA/m)", |d| all(&mut d.mass, 1e3, 1e3)),
    ("moments of inertia in kg mm", "radius of gyration of the mass", |d| all(&mut d.mass, 1.0, MM * MM)),
    ("moments of inertia in kg cm", "radius of gyration of the mass", |d| all(&mut d.mass, 1.0, 1e4)),
    ("x and y exchanged in K", "are x and y exchanged?", |d| turned(&mut d.stiffness)),
    ("x and y exchanged in M", "are x and y exchanged?", |d| turned(&mut d.mass)),
    ("x and y exchanged", "are x and y exchanged?", |d| {
        turned(&mut d.stiffness);
        turned(&mut d.mass)
    }),
    ("shear stiffnesses exchanged", "are both exchanged?", |d| {
        d.stiffness.iter_mut().for_each(|k| (k[0][0], k[1][1]) = (k[1][1], k[0][0]))
    }),
    ("rows of both shears exchanged", "are both exchanged?", |d| {
        reordered(&mut d.stiffness, [1, 0, 2, 3, 4, 5])
    }),
    ("twist from the tip", "the twist grows from", |d| {
        let twist: Vec<f64> = d.keypoints.iter().rev().map(|point| point[3]).collect();
        d.keypoints.iter_mut().zip(twist).for_each(|(point, twist)| point[3] = twist)
    }),
    ("keypoints that begin beside the origin", "must be at the origin", |d| {
        d.keypoints.iter_mut().for_each(|point| point[1] += 1.5)
    }),
    ("K with the axial row first", "shear stiffness", |d| reordered(&mut d.stiffness, [2, 0, 1, 5, 3, 4])),
    ("K and M with the axial row first", "M24|shear stiffness", |d| {
        reordered(&mut d.stiffness, [2, 0, 1, 5, 3, 4]);
        reordered(&mut d.mass, [2, 0, 1, 5, 3, 4])
    }),
    ("K with torsion before bending", "are x and y exchanged?", |d| {
        reordered(&mut d.stiffness, [0, 1, 2, 5, 3, 4])
    }),
    ("K with the axial row first, torsion last", "shear stiffness", |d| {
        reordered(&mut d.stiffness, [2, 0, 1, 3, 4, 5])
    }),
    ("M with the polar moment first", "M14|M66 is", |d| reordered(&mut d.mass, [0, 1, 2, 5, 3, 4])),
    ("bending and torsion exchanged, K44 and K66", "K", |d| reordered(&mut d.stiffness, [0, 1, 2, 5, 4, 3])),
    ("bending and torsion exchanged, K55 and K66", "is large beside the bending", |d| {
        reordered(&mut d.stiffness, [0, 1, 2, 3, 5, 4])
    }),
    ("axial and torsion exchanged", "K", |d| reordered(&mut d.stiffness, [0, 1, 5, 3, 4, 2])),
    ("moments before forces", "K", |d| reordered(&mut d.stiffness, [3, 4, 5, 0, 1, 2])),
    ("K and M exchanged", "", |d| std::mem::swap(&mut d.stiffness, &mut d.mass)),
    ("mu in per cent", "in per cent?", |d| d.mu = [0.48; 6]),
    ("mu of one strain in per cent", "in per cent?", |d| d.mu[4] *= 100.0),
    ("mu in milliseconds", "mu is in seconds", |d| d.mu.iter_mut().for_each(|mu| *mu *= 1e3)),
    ("negative mu", "is negative", |d| d.mu[2] = -1e-3),
    ("one exponent of K33", "K33 belongs to", |d| d.stiffness[AT][2][2] *= 100.0),
    ("one exponent of K55", "K55 belongs to", |d| d.stiffness[AT][4][4] *= 100.0),
    ("one exponent of K66", "K66 belongs to", |d| d.stiffness[AT][5][5] *= 100.0),
    ("one exponent of M", "M33 belongs to", |d| scaled(&mut d.mass[AT], [10.0; 6])),
    ("sections from the tip", "begin at the tip?", |d| {
        d.stiffness.reverse();
        d.mass.reverse()
    }),
];

/// Each of the list, of both blades.
#[test]
fn no_broken_deck_is_silent() {
    let (mut count, mut silent) = (0, Vec::new());
    for blade in 0..2 {
        let of = Plain::of(blade);
        for (name, says, breaks) in &BROKEN {
            let mut broken = of.clone();
            breaks(&mut broken);
            if broken == of {
                continue;
            }
            count += 1;
            let messages = match broken.read() {
                Err(message) => vec![message],
                Ok(deck) => deck.cautions.into_iter().filter(|caution| !is_true(caution)).collect(),
            };
            if !says.split('|').any(|says| messages.iter().any(|message| message.contains(says))) {
                silent.push(format!("{blade}, {name}: {messages:#?}"));
            }
        }
    }
    assert!(silent.is_empty() && count > 150, "{count} {}", silent.join("\n"));
}

/// What is wrong with the text of a file is found at its line.
#[test]
fn broken_texts_are_refused_at_their_line() {
    let mut silent = Vec::new();
    for blade in 0..2 {
        let [primary, sections] = texts(blade);
        let line = |text: &str, with: &str| text.lines().position(|line| line.contains(with)).unwrap() + 1;
        let without = |text: &str, number: usize| -> String {
            text.lines()
                .enumerate()
                .filter(|(i, _)| i + 1 != number)
                .map(|(_, line)| format!("{line}\n"))
                .collect()
        };
        let with = |text: &str, number: usize, to: &str| -> String {
            text.lines()
                .enumerate()
                .map(|(i, line)| format!("{}\n", if i + 1 == number { to } else { line }))
                .collect()
        };
        let first = line(&sections, "DISTRIBUTED") + 1;
        let (count, kp) = (line(&sections, "station_total"), line(&primary, "kp_total"));
        let (mu, member) = (line(&sections, "mu1") + 2, line(&primary, "member_total"));
        let bldfile = line(&primary, "BldFile");
        let row = sections.lines().nth(first + 2).unwrap();
        let halved = sections.lines().count() / 2;
        let cut: String = sections.lines().take(halved).map(|line| format!("{line}\n")).collect();
        let of_blade = [
            (
                "a row left out",
                without(&sections, first + 3),
                "too few numbers for row 6 of the mass matrix of station 1|station 2 has its place alone",
            ),
            (
                "a number left out",
                with(&sections, first + 3, row.trim().rsplit_once(char::is_whitespace).unwrap().0),
                "too few numbers",
            ),
            ("a number too much", with(&sections, first + 3, &format!("{row} 7.0")), "has 7 numbers"),
            (
                "a decimal comma",
                with(&sections, first + 3, &row.replace('.', ",")),
                "write decimals with a point",
            ),
            ("two points", with(&sections, first + 3, &row.replacen('.', "..", 1)), "is not a number"),
            ("stars", with(&sections, first + 3, "********** 0 0 0 0 0"), "|"),
            (
                "NaN",
                with(
                    &sections,
                    first + 3,
                    &format!("NaN {}", row.trim().split_once(char::is_whitespace).unwrap().1),
                ),
                "`NaN` is not a number",
            ),
            ("the letter O", with(&sections, first + 3, &row.replacen('0', "O", 1)), "is not a number"),
            ("cut off", cut, "ends"),
            ("too many stations", with(&sections, count, "90 station_total"), "ends before"),
            ("too few stations", with(&sections, count, "12 station_total"), "must run from 0 to 1"),
            ("no station", with(&sections, count, "0 station_total"), "at least 2"),
            ("no number of stations", without(&sections, count), "no line with `station_total`"),
            ("modal damping", with(&sections, count + 1, "2 damp_type"), "`damp_type` is 2"),
            ("mu left out", with(&sections, mu, "0.001 0.001 0.001"), "|"),
            ("empty", String::new(), "no line with `station_total`"),
        ];
        for (name, text, says) in of_blade {
            let messages = match read_texts(blade, &[primary.clone(), text]) {
                Err(message) => vec![message],
                Ok(deck) => deck.cautions.into_iter().filter(|caution| !is_true(caution)).collect(),
            };
            let is_said = says.split('|').any(|says| messages.iter().any(|message| message.contains(says)));
            if !is_said {
                silent.push(format!("{blade}, {name}: {messages:#?}"));
            }
        }
        let of_primary = [
            ("two members", with(&primary, member, "2 member_total"), "`member_total` is 2"),
            ("too many keypoints", with(&primary, kp, "60 kp_total"), "and `kp_total`"),
            ("two keypoints", with(&primary, kp, "2 kp_total"), "at least 3"),
            ("a keypoint left out", without(&primary, kp + 6), "keypoint"),
            ("a keypoint of three numbers", with(&primary, kp + 6, "0 0 0.5"), "keypoint 3|too few"),
            ("a word", with(&primary, kp + 6, "0 0 x 0"), "`x` is not a number"),
            ("no blade file", without(&primary, bldfile), "no line with `BldFile`"),
            (
                "another blade file",
                with(&primary, bldfile, "\"other.dat\" BldFile"),
                "there is no file other.dat",
            ),
            (
                "a negative order",
                primary.replacen("         10   order_elem", "-3 order_elem", 1).replacen(
                    "          5   order_elem",
                    "-3 order_elem",
                    1,
                ),
                "`order_elem`",
            ),
            ("a word for the quadrature", primary.replacen(" 2 ", " two ", 1), "`quadrature`"),
            ("empty", String::new(), "no line with `member_total`"),
        ];
        for (name, text, says) in of_primary {
            let message = read_texts(blade, &[text, sections.clone()]).err().unwrap_or_default();
            let is_said = says.split('|').any(|says| message.contains(says));
            if !is_said {
                silent.push(format!("{blade}, {name}: {message}"));
            }
        }
        let [_, name] = BLADES[blade];
        let message = read(&[(name, sections.as_bytes())]).unwrap_err();
        assert!(message.contains("give the primary file"), "{message}");
    }
    assert!(silent.is_empty(), "{}", silent.join("\n"));
}

/// Bytes of a deck changed, left out, doubled and exchanged at random: something is read or refused, and never a panic.
#[test]
fn no_bytes_make_a_panic() {
    use flexion_case::deck::{self, Format};
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/blades");
    let mut random = fastrand::Rng::with_seed(23);
    let csv = "x,mass,inertia-flap,inertia-chord,EA,GA-chord,GA-flap,GJ,EI-flap,EI-chord,twist [deg]\n0,40,1,1,9e8,4e7,3e7,7e6,1e7,2e7,0\n\
               9,40,1,1,9e8,4e7,3e7,7e6,1e7,2e7,5\n";
    let hawc2 = Format::Hawc2 { set: None, subset: None };
    let texts = [
        (BLADES[0][0], Format::BeamDyn),
        (BLADES[0][1], Format::BeamDyn),
        ("IEA_15MW_RWT_Blade_st_FPM.st", hawc2),
        ("IEA-15-240-RWT_windIO.yaml", Format::WindIo),
        ("", Format::Csv),
    ];
    for (name, format) in texts {
        let whole =
            if name.is_empty() { csv.as_bytes().to_vec() } else { std::fs::read(folder.join(name)).unwrap() };
        for _ in 0..400 {
            let mut bytes = whole.clone();
            for _ in 0..random.usize(1..6) {
                let at = random.usize(0..bytes.len());
                let end = (at + random.usize(1..40)).min(bytes.len());
                match random.u8(0..5) {
                    0 => bytes[at] = random.u8(..),
                    1 => bytes[at] = *random.choice(b"0123456789eE+-.,*/'\"#$[]{}&: \n\t").unwrap(),
                    2 => drop(bytes.drain(at..end)),
                    3 => {
                        let part = bytes[at..end].to_vec();
                        drop(bytes.splice(at..at, part));
                    }
                    _ => bytes.truncate(end),
                }
            }
            let find = |asked: &str| {
                let other = std::fs::read(folder.join(asked)).map_err(|error| error.to_string());
                if asked == name || asked == "f" { Ok(bytes.clone().into()) } else { other.map(Into::into) }
            };
            let first = if format == Format::BeamDyn { BLADES[0][0] } else { "f" };
            if let Ok(deck) = deck::read(&find, first, format) {
                let at = deck.frame(0.3 * deck.length);
                assert!(at.position.is_finite() && deck.matrices(0.3 * deck.length).fault().is_none());
            }
        }
    }
}

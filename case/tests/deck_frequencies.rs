//! Frequencies and equilibria of blades by their decks, held to an independent program: `references/section_beam`.

#![allow(clippy::unwrap_used, clippy::panic)] // in helpers of tests

use super::decks::{BLADES, Plain, root, texts};
use flexion::analysis::equilibrium::equilibrium;
use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::rotation::Quaternion;
use flexion::system::{Fork, Frame, State};
use flexion_case::{Case, Contents, parse_with};
use serde_json::Value;
use std::sync::Arc;

/// A blade on a hub that rotates about x: files, radius of the hub \[m\], precone and pitch \[rad\].
struct Mounted<'a> {
    files: &'a [(&'a str, &'a [u8])],
    hub: f64,
    precone: f64,
    pitch: f64,
}

impl Mounted<'_> {
    fn case(&self, more: &str) -> Case {
        let (sin, cos) = self.precone.sin_cos();
        // The blade leans towards x, and its pitch turns it about its axis by minus that angle.
        let along = [sin, 0.0, cos];
        let x = [cos, 0.0, -sin];
        let (s, c) = (-self.pitch).sin_cos();
        let up = [-s * x[0], c, -s * x[2]];
        let start = along.map(|a| self.hub * a);
        let text = format!(
            "run = {{ duration = 0 }}\n[[beam]]\nstart = {start:?}\ndirection = {along:?}\nup = {up:?}\nroot = \"clamped\"\nshear = true\n\
             section = {{ kind = \"deck\", file = \"{}\" }}\n{more}\n[rotation]\naxis = [1, 0, 0]\n",
            self.files[0].0
        );
        let files: Contents =
            self.files.iter().map(|(name, bytes)| ((*name).to_owned(), Arc::from(*bytes))).collect();
        let name = std::path::Path::new("case.toml");
        parse_with(text, name, &[], &files).unwrap_or_else(|problems| panic!("{problems}")).case
    }
}

/// Moduli of the eigenvalues at a speed \[rad/s\], in Hz, and the displacement of the tip from its place without stress \[m\].
fn vibrations(case: &Case, speed: f64, count: usize) -> (Vec<f64>, Vec3) {
    let (mut system, _) = case.vibrating(speed > 0.0).unwrap();
    let (mut state, length) = (system.initial(), case.space().unwrap().beams[0].0.length);
    let tip = |system: &mut dyn Fork, state: &State| {
        let mut frame = [Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }];
        system.frames(system.drawn(), state, &[length], &mut frame);
        frame[0].position
    };
    let before = tip(system.as_mut(), &state);
    if speed > 0.0 {
        rotate_stably(system.as_mut(), &mut state, 0.0, speed).unwrap();
    }
    let moved = tip(system.as_mut(), &state) - before;
    let found = modes(system.as_mut(), &state, count, &[]).unwrap();
    let hertz = found.modes.iter().map(|mode| mode.eigenvalue.norm() / std::f64::consts::TAU);
    (hertz.collect(), moved)
}

/// Relative difference of the frequencies, and of the tip over the length, from a row of the table: number, speed, six frequencies, tip.
fn off(case: &Case, row: &[f64]) -> [f64; 2] {
    let (found, tip) = vibrations(case, row[1], 6);
    assert_eq!(found.len(), 6);
    let frequency =
        found.iter().zip(&row[2..8]).map(|(found, of)| (found / of - 1.0).abs()).fold(0.0, f64::max);
    let length = case.space().unwrap().beams[0].0.length;
    [frequency, (tip - Vec3([row[8], row[9], row[10]])).norm() / length]
}

/// 200 decks drawn at random, with all couplings, offsets of the mass, prebend, sweep and twist, at rest and in rotation.
#[test]
fn random_decks_have_the_frequencies_of_another_formulation() {
    let data =
        |name: &str| std::fs::read_to_string(root().join("references/section_beam/data").join(name)).unwrap();
    let decks: Value = serde_json::from_str(&data("decks.json")).unwrap();
    let table = data("frequencies_z.csv");
    let rows: Vec<Vec<f64>> =
        table.lines().skip(1).map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
    let (mut worst, mut furthest) = (0.0_f64, 0.0_f64);
    for (number, entry) in decks.as_array().unwrap().iter().enumerate() {
        let [primary, blade] = Plain::random(entry).texts();
        let value = |key: &str| entry[key].as_f64().unwrap();
        let mounted = Mounted {
            files: &[("primary.dat", primary.as_bytes()), ("blade.dat", blade.as_bytes())],
            hub: value("hub"),
            precone: value("precone").to_radians(),
            pitch: value("pitch").to_radians(),
        };
        // Sections that change much from station to station take more elements than others.
        let off = [24, 96].iter().find_map(|elements| {
            let case = mounted.case(&format!("elements = {elements}"));
            let off = rows.iter().filter(|row| row[0] == number as f64).map(|row| off(&case, row));
            let most = off.fold([0.0_f64; 2], |most, off| [0, 1].map(|k| most[k].max(off[k])));
            (most[0] < 1e-4 && most[1] < 1e-5 || *elements == 96).then_some(most)
        });
        let [frequency, tip] = off.unwrap();
        assert!(frequency < 1e-4 && tip < 1e-5, "deck {number}: {frequency:e}, {tip:e}");
        (worst, furthest) = (worst.max(frequency), furthest.max(tip));
    }
    println!("{worst:e} {furthest:e}");
}

/// Displacement of the tip over the length, and the vector of its turn, of the equilibrium of a case.
fn equilibrium_of(case: &Case) -> [Vec3; 2] {
    let mut system = case.space().unwrap().system();
    let (mut state, length) = (system.initial(), case.space().unwrap().beams[0].0.length);
    let tip = |system: &mut dyn Fork, state: &State| {
        let mut frame = [Frame { position: Vec3::ZERO, rotation: Mat3::IDENTITY }];
        system.frames(system.drawn(), state, &[length], &mut frame);
        frame[0]
    };
    let before = tip(system.as_mut(), &state);
    equilibrium(system.as_mut(), &mut state).unwrap();
    let now = tip(system.as_mut(), &state);
    let turned = Quaternion::from(now.rotation * before.rotation.transpose());
    [1.0 / length * (now.position - before.position), turned.logarithm()]
}

/// Of the first hundred decks one equilibrium each, under a dead force and a dead couple at the tip and a dead load along the blade, all together.
#[test]
fn random_decks_have_the_equilibria_of_another_formulation() {
    let data =
        |name: &str| std::fs::read_to_string(root().join("references/section_beam/data").join(name)).unwrap();
    let decks: Value = serde_json::from_str(&data("decks.json")).unwrap();
    let mut worst = [0.0_f64; 2];
    for line in data("statics.csv").lines().skip(1) {
        let row: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
        let number = row[0] as usize;
        let [primary, blade] = Plain::random(&decks[number]).texts();
        let files: &[(&str, &[u8])] = &[("primary.dat", primary.as_bytes()), ("blade.dat", blade.as_bytes())];
        // Where the tip is hardly stiff its rotation takes more elements than its place.
        let off = [40, 160].iter().find_map(|elements| {
            let loads = format!(
                "elements = {elements}\n[[load]]\non = \"tip\"\nforce = {:?}\ncouple = {:?}\n[[load]]\nname = \"along\"\non = \"beam\"\n\
                 force-per-length = {:?}",
                &row[1..4],
                &row[4..7],
                &row[7..10]
            );
            let case = Mounted { files, hub: 0.0, precone: 0.0, pitch: 0.0 }.case(&loads);
            let length = case.space().unwrap().beams[0].0.length;
            let [place, turn] = equilibrium_of(&case);
            let off = [
                (place - 1.0 / length * Vec3([row[10], row[11], row[12]])).norm(),
                (turn - Vec3([row[13], row[14], row[15]])).norm(),
            ];
            (off[0] < 2e-5 && off[1] < 2e-4 || *elements == 160).then_some(off)
        });
        let off = off.unwrap();
        // The tip of deck 81 is hardly stiff: two resolutions of the reference differ by 1.5e-5 there.
        assert!(off[0] < 2e-5 && off[1] < 2e-4, "deck {number}: {off:?}");
        worst = [0, 1].map(|k| worst[k].max(off[k]));
    }
    println!("{worst:?}");
}

/// Frequencies \[Hz\] and steady tip \[m\] of a real blade as director beams have them, whose digits reach 1e-3 (`verification/blades/README.md`).
struct Known {
    blade: usize,
    hub: f64,
    /// Revolutions a minute.
    speed: f64,
    frequencies: [f64; 6],
    tip: Option<[f64; 2]>,
}

#[test]
fn real_decks_have_the_frequencies_of_director_beams() {
    let known = [
        Known {
            blade: 0,
            hub: 3.97,
            speed: 0.0,
            frequencies: [0.50661, 0.69325, 1.47879, 2.13694, 2.92829, 4.08766],
            tip: None,
        },
        Known {
            blade: 0,
            hub: 3.97,
            speed: 7.56,
            frequencies: [0.53138, 0.70003, 1.50591, 2.15766, 2.95425, 4.07353],
            tip: Some([0.4056, -0.0129]),
        },
        Known {
            blade: 1,
            hub: 1.5,
            speed: 0.0,
            frequencies: [0.68582, 1.08057, 1.94681, 3.73930, 4.38517, 5.57593],
            tip: None,
        },
    ];
    for Known { blade, hub, speed, frequencies, tip } in known {
        let [primary, sections] = texts(blade);
        let [a, b] = BLADES[blade];
        let files: &[(&str, &[u8])] = &[(a, primary.as_bytes()), (b, sections.as_bytes())];
        let case = Mounted { files, hub, precone: 0.0, pitch: 0.0 }.case("");
        let (found, moved) = vibrations(&case, speed * std::f64::consts::PI / 30.0, 6);
        for (found, expected) in found.iter().zip(frequencies) {
            assert!((found / expected - 1.0).abs() < 2e-4, "{a} at {speed} rpm: {found} for {expected}");
        }
        if let Some([x, y]) = tip {
            assert!((moved[0] - x).abs() < 5e-5 && (moved[1] - y).abs() < 5e-5, "{a}: {moved:?}");
        }
    }
}

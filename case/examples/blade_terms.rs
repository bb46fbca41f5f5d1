//! Writes by how much each property of a blade changes its frequencies, as Markdown: what a model that leaves it out has, in per cent.
//! `cargo run --release --example blade_terms > docs/src/blade_terms.md`; draws `docs/src/blade_terms.png`, too.
//!
//! A program, since no case has a blade without what its deck says: its models are made here.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use flexion::analysis::modes::modes;
use flexion::analysis::rotation::rotate_stably;
use flexion::linalg::{Mat3, Vec3};
use flexion::multibody::{Axis, Flexible, Kind, Model, Multibody, Part, Rotating, shear};
use flexion::section::{Matrices, Matrix6};
use flexion::system::{Dynamics, Frame};
use flexion_case::deck::{self, Deck, Format};
use flexion_results::plot::{Axis as Scale, Figure, Line, Marker, Panel, Series, Words};
use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::Arc;

/// Frequencies that are compared.
const COUNT: usize = 6;

/// A model of a blade: the axis of its sections, and what is made of their matrices.
struct Blade<'d> {
    deck: &'d Deck,
    straight: bool,
    twisted: bool,
    section: fn(Matrices) -> Matrices,
}

impl<'d> Blade<'d> {
    fn of(deck: &'d Deck) -> Blade<'d> {
        Blade { deck, straight: false, twisted: true, section: |of| of }
    }

    fn frame(&self, s: f64) -> Frame {
        let frame = self.deck.frame(s);
        let phi = if self.twisted { self.deck.line.twist(s) } else { 0.0 };
        let t = if self.straight { Vec3::AXES[2] } else { frame.rotation.column(0) };
        let across = t[0].hypot(t[2]);
        let (e, (sin, cos)) = (Vec3([t[2] / across, 0.0, -t[0] / across]), phi.sin_cos());
        let height = cos * t.cross(e) + sin * e;
        let position = if self.straight { s * Vec3::AXES[2] } else { frame.position };
        Frame { position, rotation: Mat3::columns([t, height, t.cross(height)]) }
    }

    /// Moduli of the lowest eigenvalues \[Hz\] on a hub of a radius \[m\] that rotates about x \[rad/s\].
    fn frequencies(&self, hub: f64, speed: f64) -> Vec<f64> {
        let mut ends = vec![0.0, self.deck.length];
        ends.splice(1..1, self.deck.breaks());
        let undamped = |of: Matrices| Matrices { damping: [[0.0; 6]; 6], ..of };
        let section = |s| undamped((self.section)(self.deck.matrices(s)));
        let from_hub = Vec3([0.0, 0.0, hub]);
        let axes = |s| {
            let frame = self.frame(s);
            Frame { position: frame.position + from_hub, ..frame }
        };
        let mut model = Model::new();
        let beam = model.beam(Flexible::new("blade", shear::Beam::new(&ends, axes, section).unwrap()));
        let root = [Part::Ground, Part::Section { beam, node: 0 }];
        model.join("root", Kind::Fixed, root, axes(0.0).position, (Vec3::AXES[2], None)).unwrap();
        let axis = Axis { point: Vec3::ZERO, direction: Vec3::AXES[0] };
        let mut system = Rotating::new(Multibody::new(model).unwrap(), axis);
        let mut state = system.initial();
        rotate_stably(&mut system, &mut state, 0.0, speed).unwrap();
        let found = modes(&mut system, &state, COUNT, &[]).unwrap();
        found.modes.iter().map(|mode| mode.eigenvalue.norm() / TAU).collect()
    }
}

/// A matrix with these entries alone.
fn kept(of: &Matrix6, keeps: impl Fn(usize, usize) -> bool) -> Matrix6 {
    std::array::from_fn(|i| std::array::from_fn(|j| if keeps(i, j) { of[i][j] } else { 0.0 }))
}

/// As stiff in shear as in tension times a thousand, and otherwise as at zero shear force.
fn without_shear(of: Matrices) -> Matrices {
    let (c, place) = (of.condensed(), [0, 3, 4, 5]);
    let mut stiffness = [[0.0; 6]; 6];
    for (i, &row) in place.iter().enumerate() {
        place.iter().enumerate().for_each(|(j, &column)| stiffness[row][column] = c[i][j]);
    }
    (stiffness[1][1], stiffness[2][2]) = (1e3 * c[0][0], 1e3 * c[0][0]);
    Matrices { stiffness, ..of }
}

fn without_offset_mass(of: Matrices) -> Matrices {
    Matrices::principal([1.0; 6], of.mass[0][0], of.central_inertia()).with_stiffness_of(&of)
}

fn without_couplings(of: Matrices) -> Matrices {
    Matrices { stiffness: kept(&of.stiffness, |i, j| i == j), ..of }
}

trait WithStiffness {
    fn with_stiffness_of(self, other: &Matrices) -> Matrices;
}

impl WithStiffness for Matrices {
    fn with_stiffness_of(self, other: &Matrices) -> Matrices {
        Matrices { stiffness: other.stiffness, ..self }
    }
}

/// A blade as it stands in the repository: title, file, radius of its hub \[m\] and rated speed \[rpm\].
type Known = (&'static str, &'static str, f64, f64);

const BLADES: [Known; 2] = [
    ("IEA 15 MW", "IEA-15-240-RWT_BeamDyn.dat", 3.97, 7.56),
    ("NREL 5 MW", "NRELOffshrBsline5MW_BeamDyn.dat", 1.5, 12.1),
];

fn main() {
    println!(
        "# What each property of a blade does to its frequencies\n\n\
         What a model has that leaves one of them out, in per cent of the frequency that it should have; at rest and at the rated speed. `cargo run --release --example blade_terms` writes \
         this page. The decks are [those of BeamDyn](guide/decks.md), without damping; the straight blade has the length of the line, and the one without offsets of the mass the moments of inertia about the \
         centres of mass.\n\n\
         ![Change of each frequency by each property that is left out](blade_terms.png)\n\n\
         The frequencies at the rated speed: along, what they are; up, what they are off by without that property."
    );
    let markers = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross];
    let mut panels = Vec::new();
    for (title, file, hub, rated) in BLADES {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../verification/blades");
        let find =
            |name: &str| std::fs::read(folder.join(name)).map(Arc::from).map_err(|error| error.to_string());
        let deck = deck::read(&find, file, Format::BeamDyn).unwrap();
        let whole = Blade::of(&deck);
        let variants = [
            ("shear", Blade { section: without_shear, ..Blade::of(&deck) }),
            ("offsets of the mass", Blade { section: without_offset_mass, ..Blade::of(&deck) }),
            ("couplings of the stiffness", Blade { section: without_couplings, ..Blade::of(&deck) }),
            ("prebend and sweep", Blade { straight: true, ..Blade::of(&deck) }),
            ("twist", Blade { twisted: false, ..Blade::of(&deck) }),
            (
                "all but the twist",
                Blade {
                    straight: true,
                    section: |of| without_offset_mass(without_couplings(without_shear(of))),
                    ..Blade::of(&deck)
                },
            ),
        ];
        println!("\n## {title}");
        let mut panel = Panel {
            words: vec![Words { text: format!("{title}, {rated} rpm"), ..Words::default() }],
            x: Scale::new("Frequency", "Hz"),
            y: Scale::new("Error without it", "%"),
            ..Panel::default()
        };
        for speed in [0.0, rated] {
            let of = |blade: &Blade<'_>| blade.frequencies(hub, speed * PI / 30.0);
            let right = of(&whole);
            let names = ["flap 1", "edge 1", "flap 2", "edge 2", "flap 3", "torsion 1"];
            println!("\n| {speed} rpm | {} |\n|---|{}", names.join(" | "), "---|".repeat(COUNT));
            let hertz: Vec<String> = right.iter().map(|f| format!("{f:.4} Hz")).collect();
            println!("| everything | {} |", hertz.join(" | "));
            for (number, (name, blade)) in variants.iter().enumerate() {
                let off = of(blade).into_iter().zip(&right).map(|(f, right)| 100.0 * (f / right - 1.0));
                let off: Vec<f64> = off.collect();
                let cells: Vec<String> = off.iter().map(|off| format!("{off:+.2}")).collect();
                println!("| without {name} | {} |", cells.join(" | "));
                if let (true, Some(marker)) = (speed > 0.0, markers.get(number)) {
                    let points = right.iter().copied().zip(off).collect();
                    // One legend for both panels.
                    let name = panels.is_empty().then_some(*name);
                    let series =
                        Series { line: Line::None, marker: Some(*marker), ..Series::line(name, points) };
                    panel.series.push(series);
                }
            }
        }
        panels.push(panel);
    }
    let figure = Figure { title: None, panels, columns: 2, share_x: false };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/src/blade_terms.png");
    std::fs::write(file, figure.draw().png().unwrap()).unwrap();
}

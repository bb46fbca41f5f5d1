//! The first bending frequency against the speed for every strain energy of a rotating beam: draws the figure of
//! `docs/src/theory/strain_energy.md` and prints its table.
//!
//! `cargo run --release --example strain_energy [FOLDER]`

#![allow(clippy::print_stdout)] // what it is for

use flexion::strain_energy::{RotatingBeam, StrainEnergy, Terms};
use flexion_results::plot::{Axis, Figure, Line, Panel, Series};

/// Speeds of a curve.
const SPEEDS: usize = 24;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/src/theory".to_owned());
    let none = Terms::default();
    let options = [
        ("exact", StrainEnergy::Exact, Line::Solid),
        ("linear", StrainEnergy::Linear, Line::Dashed),
        ("all terms", StrainEnergy::Coupled(Terms::ALL), Line::Solid),
        (
            "EI terms only",
            StrainEnergy::Coupled(Terms { bending_first: true, bending_second: true, ..none }),
            Line::Dashed,
        ),
        (
            "EA terms only",
            StrainEnergy::Coupled(Terms { axial_first: true, axial_second: true, ..none }),
            Line::Dotted,
        ),
        (
            "EA terms and stretched inertia",
            StrainEnergy::Coupled(Terms {
                axial_first: true,
                axial_second: true,
                stretched_inertia: true,
                ..none
            }),
            Line::Dashed,
        ),
    ];
    let mut panels = Vec::new();
    // Slenderness and largest strain at the root, ½(Ω L)² ρ/E.
    for (slenderness, largest, range) in [(100.0, 0.002, (-0.06, 0.18)), (20.0, 0.08, (-3.0, 3.0))] {
        let beam = RotatingBeam {
            length: 1.0,
            hub_radius: 0.0,
            mass: 1.0,
            axial_stiffness: slenderness * slenderness,
            bending_stiffness: 1.0,
        };
        let mut panel = Panel {
            x: Axis { tight: true, ..Axis::new("Strain at the root ε₀", "%") },
            y: Axis { range: Some(range), ..Axis::new("ω₁ over that of linear, less one", "%") },
            series: Vec::new(),
            ..Panel::default()
        };
        println!("slenderness {slenderness}: strain, γ, then ω₁ by {:?}", options.map(|o| o.0));
        let mut curves: Vec<Vec<(f64, f64)>> = vec![Vec::new(); options.len()];
        for i in 0..=SPEEDS {
            let strain = largest * i as f64 / SPEEDS as f64;
            let speed = slenderness * (2.0 * strain).sqrt();
            let frequency = |energy| beam.flapwise(energy, speed, 1).map(|found| found[0]);
            let reference = frequency(StrainEnergy::Linear)?;
            let found: Vec<f64> = options.iter().map(|o| frequency(o.1)).collect::<Result<_, _>>()?;
            for (curve, found) in curves.iter_mut().zip(&found) {
                curve.push((100.0 * strain, 100.0 * (found / reference - 1.0)));
            }
            if i % 6 == 0 {
                let row: Vec<String> = found.iter().map(|w| format!("{w:.5}")).collect();
                println!("{:.4} {speed:.3} | {}", strain, row.join(" | "));
            }
        }
        // One legend for both panels.
        let named = panels.is_empty();
        for ((name, _, line), points) in options.iter().zip(curves) {
            panel.series.push(Series { line: *line, ..Series::line(named.then_some(*name), points) });
        }
        panels.push(panel);
    }
    let figure = Figure { title: None, panels, columns: 2, share_x: false };
    let drawing = figure.draw();
    std::fs::write(format!("{folder}/strain_energy.png"), drawing.png()?)?;
    Ok(())
}

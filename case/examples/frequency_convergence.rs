//! The error of the second frequency of a rotating beam against the number of unknowns, for every basis: draws the
//! figure of `docs/src/theory/frequency_convergence.md` and prints its table.
//!
//! `cargo run --release --example frequency_convergence [FOLDER]`
//!
//! A program, since it compares with a power series, which no case has; `case/tests/frequency_orders.rs` holds the orders by the same functions.

#![allow(clippy::print_stdout)] // what it is for

mod rotating;

use flexion_results::plot::{Axis, Figure, Line, Marker, Panel, Scale, Series};
use rotating::{families, frequency_error};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| "docs/src/theory".to_owned());
    let mut series = Vec::new();
    println!("| basis | cells | unknowns | error | order |\n|---|---|---|---|---|");
    let markers = [Marker::Circle, Marker::Square, Marker::Triangle, Marker::Diamond, Marker::Cross];
    for (number, (name, family, sizes)) in families().into_iter().enumerate() {
        let mut points: Vec<(f64, f64)> = Vec::new();
        for cells in sizes {
            let (unknowns, error) = frequency_error(family(cells)?)?;
            let point = (unknowns as f64, error.abs());
            let order = points.last().map_or(String::new(), |last| {
                format!("{:.1}", (last.1 / point.1).ln() / (point.0 / last.0).ln())
            });
            println!("| {name} | {cells} | {unknowns} | {error:.1e} | {order} |");
            points.push(point);
        }
        series.push(Series {
            line: if number < 5 { Line::Solid } else { Line::Dashed },
            marker: Some(markers[number % markers.len()]),
            ..Series::line(Some(name), points)
        });
    }
    let panel = Panel {
        x: Axis { scale: Scale::Logarithmic, ..Axis::new("Unknowns", "") },
        y: Axis {
            scale: Scale::Logarithmic,
            range: Some((1e-13, 1.0)),
            ..Axis::new("Relative error of ω₂ at γ = 10", "")
        },
        series,
        ..Panel::default()
    };
    let figure = Figure { title: None, panels: vec![panel], columns: 1, share_x: false };
    std::fs::write(format!("{folder}/frequency_convergence.png"), figure.draw().png()?)?;
    Ok(())
}

//! Natural frequencies [Hz] of the blade of a case at some speeds, without gyroscopic terms: by bisection on the
//! number of negative eigenvalues of K − ω²M.
//!
//! `cargo run --release --example blade_frequencies -- CASE COUNT SPEED…`, speeds in rad/s

#![allow(clippy::print_stdout)] // what it is for

use flexion::linalg::{Matrix, negative_pivots};
use flexion::system::{Dynamics, State, Weights};
use flexion_case::read;
use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [case, count, speeds @ ..] = arguments.as_slice() else {
        return Err("usage: blade_frequencies CASE COUNT SPEED…".into());
    };
    let count: usize = count.parse()?;
    let reading = read(Path::new(case), &[])?;
    let mut blade = reading.case.blade()?.ok_or("the case has no [blade]")?;
    for speed in speeds {
        blade.set_speed(speed.parse()?)?;
        let state = State::zeros(blade.size(), 0.0);
        let [m, k] = [(1.0, 0.0), (0.0, 1.0)].map(|(a, q)| {
            let mut matrix = Matrix::new(&blade.structure(0));
            blade.tangent(&state, Weights::new(a, 0.0, q), &mut matrix);
            matrix
        });
        let mut line = format!("{speed} rad/s:");
        for number in 1..=count {
            let (mut low, mut high) = (0.0, 1e6);
            while high - low > 1e-9 * high {
                let middle: f64 = 0.5 * (low + high);
                if negative_pivots(&k, &m, -middle * middle) >= number { high = middle } else { low = middle }
            }
            line += &format!(" {:.4}", low / std::f64::consts::TAU);
        }
        println!("{line}");
    }
    Ok(())
}

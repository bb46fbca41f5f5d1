//! Solves a stored cone problem of contacts, and prints the multipliers, the iterations and the time of one solution \[s\] as JSON.
//!
//!     cargo run --release -p flexion-case --example cones PROBLEM.json
//!
//! `benches/cones/compare.py` compares them with those of other methods.

#![allow(clippy::print_stdout)]

mod problem;

use flexion::contact::Augmented;
use problem::Problem;
use serde_json::json;
use std::error::Error;
use std::time::{Duration, Instant};

/// What is measured takes at least so long.
const LEAST: Duration = Duration::from_millis(200);

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("cones PROBLEM.json")?;
    let problem = Problem::read(&std::fs::read_to_string(file)?)?;
    let mut many = Augmented::default().lenient();
    many.keep(&problem.matrix, problem.order);
    let mut factored = problem.matrix.clone();
    factored.factor()?;
    let (mut count, began) = (0, Instant::now());
    let multipliers = loop {
        let [_, multipliers] = problem.solve(&mut many, &mut factored)?;
        count += 1;
        if began.elapsed() > LEAST {
            break multipliers;
        }
    };
    let seconds = began.elapsed().as_secs_f64() / f64::from(count);
    let (iterations, residual) = (many.iterations, many.residual);
    println!(
        "{}",
        json!({ "multipliers": multipliers, "iterations": iterations, "residual": residual, "seconds": seconds })
    );
    Ok(())
}

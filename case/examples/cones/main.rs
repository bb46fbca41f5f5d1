//! Solves a stored cone problem of contacts, and prints the multipliers, the iterations and the time of one solution \[s\] as JSON.
//!
//!     cargo run --release -p flexion-case --example cones PROBLEM.json
//!
//! `benches/cones/compare.py` compares them with those of other methods.

#![allow(clippy::print_stdout)]

use flexion::contact::{Augmented, RowLaw};
use flexion::linalg::{Matrix, Structure};
use serde_json::{Value, json};
use std::error::Error;
use std::time::{Duration, Instant};

/// What is measured takes at least so long.
const LEAST: Duration = Duration::from_millis(200);

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args().nth(1).ok_or("cones PROBLEM.json")?;
    let problem: Value = serde_json::from_str(&std::fs::read_to_string(file)?)?;
    let numbers =
        |value: &Value| -> Result<Vec<f64>, Box<dyn Error>> { Ok(serde_json::from_value(value.clone())?) };
    let order = problem["order"].as_u64().ok_or("no order")? as usize;
    let entries: Vec<(usize, usize, f64)> = serde_json::from_value(problem["matrix"].clone())?;
    let rows: Vec<Vec<(usize, f64)>> = serde_json::from_value(problem["rows"].clone())?;
    let law = |law: &Value| match (law[0].as_str(), law[1].as_f64(), law[2].as_u64()) {
        (Some("unilateral"), ..) => Ok(RowLaw::Unilateral),
        (Some("friction"), Some(coefficient), Some(normal)) => {
            Ok(RowLaw::Friction { coefficient, normal: normal as usize })
        }
        _ => Err("a law is [\"unilateral\"] or [\"friction\", coefficient, normal row]"),
    };
    let laws = problem["laws"].as_array().ok_or("no laws")?;
    let laws = laws.iter().map(law).collect::<Result<Vec<_>, _>>()?;
    let (b, start) = (numbers(&problem["b"])?, numbers(&problem["start"])?);
    let mut plain = Matrix::new(&Structure::dense(order));
    entries.iter().for_each(|(i, j, x)| plain.add(*i, *j, *x));
    let mut factored = plain.clone();
    factored.factor()?;
    let mut many = Augmented::default();
    many.keep(&plain, order);
    let (mut count, began) = (0, Instant::now());
    let multipliers = loop {
        many.begin(&laws);
        rows.iter().for_each(|row| many.push(row.iter().copied()));
        let (mut multipliers, mut motion) = (start.clone(), vec![0.0; order]);
        many.solve(&mut factored, &b, &mut multipliers, &mut motion)?;
        count += 1;
        if began.elapsed() > LEAST {
            break multipliers;
        }
    };
    let seconds = began.elapsed().as_secs_f64() / f64::from(count);
    println!(
        "{}",
        json!({ "multipliers": multipliers, "iterations": many.iterations, "residual": many.residual, "seconds": seconds })
    );
    Ok(())
}

//! Advice on the cheapest coupling, basis and integrator.

#![allow(clippy::unwrap_used)] // in helpers of tests

use crate::verification::run::folder;
use flexion_case::{Advice, Reading, Target, read};
use std::ops::ControlFlow;

fn advice(reading: &Reading, tolerance: &str, quantity: &str) -> Advice {
    let target = Target::new(tolerance.to_owned(), Some(quantity.to_owned()));
    reading.advise(&target, &mut |_| ControlFlow::Continue(())).unwrap()
}

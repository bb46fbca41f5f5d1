//! Answers a request natively, and prints times of one answer \[s\], of the processor where the system tells it: the mean of as many answers as take
//! a given time, after as many that are not counted.
//!
//!     cargo run --profile wasm -p flexion-lab --example answer REQUEST.json COUNT SECONDS
//!
//! `speed.mjs` compares them with those of the module.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::time::Instant;

/// Time of the processor of this thread \[s\].
fn of_processor() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    Some(1e-9 * text.split(' ').next()?.parse::<f64>().ok()?)
}

fn main() -> Result<(), Box<dyn Error>> {
    let [file, count, seconds] = std::env::args()
        .skip(1)
        .collect::<Vec<_>>()
        .try_into()
        .map_err(|_| "answer REQUEST COUNT SECONDS")?;
    let request = std::fs::read_to_string(file)?;
    let least: f64 = seconds.parse()?;
    for sample in 0..=count.parse::<usize>()? {
        let (started, before) = (Instant::now(), of_processor());
        let mut answers = 0.0;
        let mut took = 0.0;
        let mut length = 0;
        while took < least {
            length = flexion_lab::reply(&request, &mut |_| {}).len();
            answers += 1.0;
            took = of_processor()
                .zip(before)
                .map_or(started.elapsed().as_secs_f64(), |(now, before)| now - before);
        }
        if sample > 0 {
            println!("{} {length}", took / answers);
        }
    }
    Ok(())
}

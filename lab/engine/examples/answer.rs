//! Answers a request natively some times, and prints the time that each took \[s\]: of the processor, where the system tells it.
//!
//!     cargo run --profile wasm -p flexion-lab --example answer REQUEST.json COUNT
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
    let [file, count] =
        std::env::args().skip(1).collect::<Vec<_>>().try_into().map_err(|_| "answer REQUEST COUNT")?;
    let request = std::fs::read_to_string(file)?;
    for _ in 0..count.parse()? {
        let (started, before) = (Instant::now(), of_processor());
        let reply = flexion_lab::reply(&request, &mut |_| {});
        let took =
            of_processor().zip(before).map_or(started.elapsed().as_secs_f64(), |(now, before)| now - before);
        println!("{took} {}", reply.len());
    }
    Ok(())
}

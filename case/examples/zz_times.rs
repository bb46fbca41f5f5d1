//! Times of reading, preparing and running.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]
use std::ops::ControlFlow;
use std::time::Instant;
fn main() {
    let set: Vec<String> = ["model.coupling=first", "basis.elements=20"].map(str::to_owned).to_vec();
    let r = flexion_case::read(std::path::Path::new("verification/p1_spin_up_4"), &set).unwrap();
    let n = 2000;
    let mut best = [f64::INFINITY; 4];
    for _ in 0..5 {
        let t = Instant::now();
        for i in 0..n {
            std::hint::black_box(
                r.with(&[
                    format!("section.modulus={}", 7e10 + i as f64),
                    format!("hub.motion.speed={}", 4.0 + 1e-6 * i as f64),
                ])
                .unwrap(),
            );
        }
        best[0] = best[0].min(t.elapsed().as_secs_f64() / n as f64 * 1e6);
        let t = Instant::now();
        for _ in 0..n {
            std::hint::black_box(r.build().unwrap());
        }
        best[1] = best[1].min(t.elapsed().as_secs_f64() / n as f64 * 1e6);
        let t = Instant::now();
        for _ in 0..n {
            std::hint::black_box(r.prepare().unwrap());
        }
        best[2] = best[2].min(t.elapsed().as_secs_f64() / n as f64 * 1e6);
        let t = Instant::now();
        for _ in 0..50 {
            let p = r.prepare().unwrap();
            std::hint::black_box(p.run(&mut |_| ControlFlow::Continue(())));
        }
        best[3] = best[3].min(t.elapsed().as_secs_f64() / 50.0 * 1e6);
    }
    println!("with {:.1} build {:.1} prepare {:.1} prepare+run {:.1} us", best[0], best[1], best[2], best[3]);
}

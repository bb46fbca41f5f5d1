use super::derivatives::{far, general};
use flexion::system::Weights;
use std::hint::black_box;
#[test]
fn cost() {
    let beam = general();
    let (q, v, a) = far(&beam, 3);
    let n = 20000;
    for round in 0..3 {
        let t = std::time::Instant::now();
        let mut r = vec![0.0; beam.velocities()];
        for _ in 0..n {
            beam.add_forces(black_box(&q), black_box(&v), black_box(&a), &mut r);
        }
        let f = t.elapsed().as_secs_f64() / n as f64 / 3.0;
        let t = std::time::Instant::now();
        let mut x = 0.0;
        for _ in 0..n {
            beam.add_tangent(
                black_box(&q),
                black_box(&v),
                black_box(&a),
                &Weights::new(1.0, 0.0, 1.0),
                |_, b| x += b[3][4] + b[14][14],
            );
        }
        let k = t.elapsed().as_secs_f64() / n as f64 / 3.0;
        let t = std::time::Instant::now();
        for _ in 0..n {
            beam.add_tangent(
                black_box(&q),
                black_box(&v),
                black_box(&a),
                &Weights::new(0.0, 0.0, 1.0),
                |_, b| x += b[3][4] + b[14][14],
            );
        }
        let s = t.elapsed().as_secs_f64() / n as f64 / 3.0;
        println!(
            "{round}: force {:.2} us, tangent {:.2} us, of it strain {:.2} {}",
            f * 1e6,
            k * 1e6,
            s * 1e6,
            black_box(x) != 0.0
        );
    }
}

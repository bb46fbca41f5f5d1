//! A published benchmark with friction, and a cantilever that strikes a stop, against the modes of the continuous beam.

use super::models::{Linear, steps};
use super::nonsmooth::methods;
use crate::integrators::multibody::{BallsOnWall, GRAVITY};
use flexion::analysis::transient::{Ending, Observer, Plan, Step, transient};
use flexion::integrator::{GeneralizedAlpha, Integrator, MoreauJean, Radau, Tolerance};
use flexion::system::{Dynamics, Mode, State, System};

struct Blind;

impl Observer for Blind {
    fn sample(&mut self, _: &mut dyn System, _: &State, _: &Step) {}
}

/// Place, speed and spin of a ball that falls from y = 1 with the speed v and the spin ω onto a rough plane, at the time t:
/// impacts at √(2(1 − R)/g) (1 + 2e + 2e² + …) with the normal impulse (1 + e) m eᵏ v₀, friction μ of it or what makes the
/// ball roll; behind them it slides with μg until it rolls.
fn thrown([e, friction]: [f64; 2], [mut x, mut v, mut spin]: [f64; 3], t: f64) -> [f64; 3] {
    let (r, j) = (0.1, 0.4 * 0.01);
    let first = (2.0 * 0.9 / GRAVITY).sqrt();
    let (mut now, mut flight, mut part) = (0.0, first, 1.0);
    while part > 1e-12 && now + flight < t {
        (now, x) = (now + flight, x + v * flight);
        let slide: f64 = v + r * spin;
        let normal = (1.0 + e) * part * GRAVITY * first;
        let impulse = (friction * normal).min(slide.abs() / 3.5).copysign(slide);
        (v, spin) = (v - impulse, spin - r * impulse / j);
        part *= e;
        flight = 2.0 * part * first;
    }
    let slide: f64 = v + r * spin;
    let slides = (slide.abs() / (3.5 * friction * GRAVITY)).min(t - now);
    let brake = (friction * GRAVITY).copysign(slide);
    x += v * slides - 0.5 * brake * slides * slides;
    (v, spin) = (v - brake * slides, spin - r * brake * slides / j);
    [x + v * (t - now - slides), v, spin]
}

/// The rotating bouncing ball: mass 1 kg, radius 0.1 m, centre at the height 1 m, μ = 0.2. With e = 0 and the spin 50 rad/s
/// it slides through its impact and on until 0.728 s, with 10 rad/s it rolls from the impact on; with e = ½ and 50 rad/s,
/// thrown with 1 m/s, it rolls from the second impact on.
///
/// Source of the scenarios: Capobianco, Harsch, Eugster & Leine (2021, doi 10.1002/nme.6801), section 10.1. (They show
/// figures; the numbers are those of the laws of Newton and Coulomb.)
#[test]
fn the_rotating_bouncing_ball_slides_and_rolls() {
    for (e, start, end, rolls) in [
        (0.0, [0.0, 0.0, 50.0], 1.1, -10.0 / 7.0),
        (0.0, [0.0, 0.0, 10.0], 1.1, -2.0 / 7.0),
        (0.5, [-0.5, 1.0, 50.0], 1.5, -5.0 / 7.0),
    ] {
        let mut system = BallsOnWall::new(e, [0.2; 2]);
        system.mass = 1.0;
        let [x, v, spin] = start;
        let mut state = system.initial();
        state.q = vec![x, 1.0, 0.0, x + system.length, 1.0, 0.0];
        state.v = vec![v, 0.0, spin, v, 0.0, spin];
        state.mode[..4].fill(Mode::Open);
        let exact = thrown([e, 0.2], start, end);
        assert!((exact[1] - rolls).abs() < 1e-12 && (exact[1] + 0.1 * exact[2]).abs() < 1e-12, "{exact:?}");
        let mut far = |method: &dyn Integrator, step: Option<f64>| {
            let mut last = state.clone();
            let plan =
                Plan { end, step, longest_step: None, break_steps: 1, contact_step: None, sample: end };
            assert_eq!(transient(&mut system, method, &mut last, &plan, &mut Blind), Ending::Finished);
            let found = [last.q[0], last.v[0], 0.1 * last.v[2]];
            let exact = [exact[0], exact[1], 0.1 * exact[2]];
            found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let radau = far(&mut Radau::new(Tolerance::uniform(1e-10)).unwrap(), None);
        let alpha = far(&mut GeneralizedAlpha::chung_hulbert(0.8).unwrap(), Some(1e-2));
        // Bounces below 1e-5 of the first speed are not followed.
        let allowed = if e == 0.0 { 1e-9 } else { 1e-6 };
        assert!(radau < allowed && alpha < allowed, "{e} {start:?}: {radau:e} {alpha:e}");
        for mut method in methods(0.8).into_iter().chain([Box::new(MoreauJean::new(0.5).unwrap()) as _]) {
            let [coarse, fine] = [2e-3, 1.25e-4].map(|step| far(method.as_mut(), Some(step)));
            let name = method.info().name;
            assert!(fine < 2e-3 && fine < 0.2 * coarse, "{name} {e} {start:?}: {coarse:e} {fine:e}");
        }
    }
}

/// Roots βL of cos βL cosh βL = −1 (first) and of tan βL = tanh βL, for the cantilever and the beam that is clamped and
/// pinned (Blevins, *Formulas for Natural Frequency and Mode Shape*, 1979, table 8-1).
const FREE: f64 = 1.875_104_068_711_961;
const PINNED: [f64; 3] = [3.926_602_312_047_919, 7.068_582_745_628_732, 10.210_176_122_813_03];

/// cosh βx − cos βx − σ (sinh βx − sin βx)
fn mode(beta: f64, sigma: f64, x: f64) -> f64 {
    let z = beta * x;
    z.cosh() - z.cos() - sigma * (z.sinh() - z.sin())
}

/// A cantilever of length, mass and EI 1 that swings in its first mode, V at its tip, comes back to its straight
/// position, where a stop touches its tip. The tip of the continuous beam has no mass and loses nothing: from then on it
/// is a clamped and pinned beam, w(x, t) = −Σ cₖ ψₖ(x) sin ωₖt / ωₖ with cₖ = ∫φψₖ dx / ∫ψₖ² dx, until the force of the
/// stop, −EI w‴(1, t), falls to zero for good. Deflections of finite elements come to that; the impulse stays within 8 %,
/// since the tip leaves for moments when the fastest waves come back from the clamp.
#[test]
fn a_swinging_cantilever_strikes_a_stop_as_a_clamped_and_pinned_beam() {
    let sigma = (FREE.cosh() + FREE.cos()) / (FREE.sinh() + FREE.sin());
    let free = |x: f64| mode(FREE, sigma, x) / 2.0;
    let betas: Vec<f64> =
        (0..40).map(|k| if k < 3 { PINNED[k] } else { (k as f64 + 1.25) * std::f64::consts::PI }).collect();
    // High modes without the difference of large numbers.
    let pinned = |beta: f64, x: f64| {
        let sigma = 1.0 / beta.tan();
        if beta < 12.0 {
            mode(beta, sigma, x)
        } else {
            // 1 − σ = −2 e^(−2β) to rounding.
            let (z, back) = (beta * x, (beta * (x - 2.0)).exp());
            (-z).exp() - back - z.cos() + z.sin()
        }
    };
    let points = 8000;
    let integral = |f: &dyn Fn(f64) -> f64| {
        let simpson = |i: usize| if i == 0 || i == points { 1.0 } else { 2.0 + 2.0 * (i % 2) as f64 };
        (0..=points).map(|i| simpson(i) * f(i as f64 / points as f64)).sum::<f64>() / (3.0 * points as f64)
    };
    let parts: Vec<f64> = betas
        .iter()
        .map(|b| integral(&|x| free(x) * pinned(*b, x)) / integral(&|x| pinned(*b, x).powi(2)))
        .collect();
    let deflection = |x: f64, t: f64| {
        let of = |(b, c): (&f64, &f64)| -c * pinned(*b, x) * (b * b * t).sin() / (b * b);
        betas.iter().zip(&parts).map(of).sum::<f64>()
    };
    // ψ‴ at the tip, and the impulse of the stop.
    let bend = |beta: f64| {
        let sigma = 1.0 / beta.tan();
        let hyperbolic = if beta < 12.0 { beta.sinh() - sigma * beta.cosh() } else { -2.0 * (-beta).exp() };
        beta.powi(3) * (hyperbolic - beta.sin() - sigma * beta.cos())
    };
    let impulse = |t: f64| {
        let of = |(b, c): (&f64, &f64)| c * bend(*b) * (1.0 - (b * b * t).cos()) / b.powi(4);
        betas.iter().zip(&parts).map(of).sum::<f64>()
    };
    let mut coarse = f64::INFINITY;
    for elements in [8, 16, 32] {
        let mut beam = Linear::beam(elements, 1.0, [1.0, 1.0], true).with_stop(2 * elements - 2, 0.0, 0.0);
        let mut state = beam.initial();
        state.mode.fill(Mode::Open);
        let h = 1.0 / elements as f64;
        for k in 1..=elements {
            let x = k as f64 * h;
            let slope = (free(x + 1e-5) - free(x - 1e-5)) / 2e-5;
            (state.v[2 * k - 2], state.v[2 * k - 1]) = (-free(x), -h * slope);
        }
        let method = MoreauJean::new(0.5).unwrap();
        let (mut worst, mut largest, mut pressed) = ([0.0_f64; 2], [0.0_f64; 2], 0.0);
        let middle = elements - 2;
        steps(&method, &mut beam, state, (0.035, 2e-5), |_, from, to| {
            pressed += to.lambda[0] * (to.t - from.t);
            let exact = [deflection(0.5, to.t), impulse(to.t)];
            for (k, found) in [to.q[middle], pressed].into_iter().enumerate() {
                largest[k] = largest[k].max(exact[k].abs());
                worst[k] = worst[k].max((found - exact[k]).abs());
            }
        });
        let [deflection, impulse] = [0, 1].map(|k| worst[k] / largest[k]);
        assert!(deflection < 0.02 && deflection < 0.8 * coarse, "{elements}: {deflection:e}");
        assert!(impulse < 0.15, "{elements}: {impulse:e}");
        coarse = deflection;
    }
    assert!(coarse < 0.01, "{coarse:e}");
}

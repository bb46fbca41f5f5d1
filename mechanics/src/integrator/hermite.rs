//! Dense output: Hermite polynomials in the space of increments.
//!
//! Over a step of size h from (q₀, v₀, a₀) to (q₁ = q₀ ⊞ D, v₁, a₁), with s = (t − t₀)/h,
//!
//! ```text
//! q(t) = q₀ ⊞ d(s),   v = d′/h,   a = d″/h²      (quintic: matches q, v and a at both ends)
//! q(t) = q₀ ⊞ d(s),   v = d′/h,   a linear       (cubic: matches q and v)
//! ```
//!
//! Off a vector space (rotations) the slope of d at the end is ḋ₁ = T(D)⁻¹ v₁, and v is the cubic through v and a of
//! both ends. On a vector space the interpolation errors are O(h⁶), O(h⁵), O(h⁴) of q, v, a for the quintic and
//! O(h⁴), O(h³), O(h²) for the cubic.

use crate::system::{Dynamics, Side, State};

/// Writes the cubic through q and v of both ends; `increment` is D.
pub(super) fn cubic(
    system: &dyn Dynamics,
    from: &State,
    to: &State,
    increment: &[f64],
    t: f64,
    out: &mut State,
) {
    let h = to.t - from.t;
    let s = fraction(from, to, t);
    // d = D·p + h v0·p0 + h v1·p1
    let (p, dp) = (s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s));
    let (p0, dp0) = (s * (1.0 - s) * (1.0 - s), (1.0 - s) * (1.0 - 3.0 * s));
    let (p1, dp1) = (s * s * (s - 1.0), s * (3.0 * s - 2.0));
    let flat = system.is_vector_space();
    if flat {
        out.v.copy_from_slice(&to.v);
    } else {
        system.rate(&from.q, increment, &to.v, &mut out.v);
    }
    for i in 0..increment.len() {
        let (d, v0, v1) = (increment[i], from.v[i], out.v[i]);
        // The acceleration's slot holds the increment until the configuration is retracted.
        out.a[i] = d * p + h * (v0 * p0 + v1 * p1);
        out.v[i] = if h > 0.0 { d * dp / h + v0 * dp0 + v1 * dp1 } else { v1 };
    }
    system.retract(&from.q, &out.a, &mut out.q);
    if !flat {
        velocities(from, to, h, s, out);
    }
    for i in 0..increment.len() {
        out.a[i] = from.a[i] + s * (to.a[i] - from.a[i]);
    }
    finish(from, to, s, t, out);
}

/// Writes the quintic through q, v and a of both ends; `increment` is D.
pub(super) fn quintic(
    system: &dyn Dynamics,
    from: &State,
    to: &State,
    increment: &[f64],
    t: f64,
    out: &mut State,
) {
    if !system.is_vector_space() {
        return cubic(system, from, to, increment, t, out);
    }
    let h = to.t - from.t;
    let s = fraction(from, to, t);
    let (by_time, by_square) = if h > 0.0 { (1.0 / h, 1.0 / (h * h)) } else { (0.0, 0.0) };
    // In the order of the weights: increment, then v and a of both ends.
    let scaled = |scale: f64, w: [f64; 5]| {
        let (v, a) = (scale * h, scale * h * h);
        [scale * w[0], v * w[1], v * w[2], a * w[3], a * w[4]]
    };
    let [value, slope, bend] = quintic_weights(s);
    let weights = [scaled(1.0, value), scaled(by_time, slope), scaled(by_square, bend)];
    let n = increment.len();
    let ends = [increment, &from.v[..n], &to.v[..n], &from.a[..n], &to.a[..n]];
    let sum = |w: &[f64; 5], out: &mut [f64]| {
        let [d, v0, v1, a0, a1] = ends;
        for (i, out) in out[..n].iter_mut().enumerate() {
            *out = w[0] * d[i] + (w[1] * v0[i] + w[2] * v1[i]) + (w[3] * a0[i] + w[4] * a1[i]);
        }
    };
    // The acceleration's slot holds the increment until the configuration is retracted.
    sum(&weights[0], &mut out.a);
    system.retract(&from.q, &out.a, &mut out.q);
    sum(&weights[1], &mut out.v);
    sum(&weights[2], &mut out.a);
    if h <= 0.0 {
        out.v.copy_from_slice(&to.v);
        out.a.copy_from_slice(&to.a);
    }
    finish(from, to, s, t, out);
}

/// Writes a step whose increment tells nothing of its velocities and accelerations, or whose accelerations tell nothing of its velocities: they are
/// linear between both ends, and the configuration is the cubic through q and v.
pub(super) fn line(
    system: &dyn Dynamics,
    from: &State,
    to: &State,
    increment: &[f64],
    t: f64,
    out: &mut State,
) {
    cubic(system, from, to, increment, t, out);
    linear(from, to, t, out);
}

/// Writes velocities and accelerations that are linear between both ends, with all but the configuration: for steps in which velocities
/// may jump.
pub(super) fn linear(from: &State, to: &State, t: f64, out: &mut State) {
    let s = fraction(from, to, t);
    for i in 0..out.v.len() {
        out.v[i] = from.v[i] + s * (to.v[i] - from.v[i]);
        out.a[i] = from.a[i] + s * (to.a[i] - from.a[i]);
    }
    finish(from, to, s, t, out);
}

/// Writes the middle of a step with its mean velocities, accelerations and multipliers; `increment` is D.
pub(super) fn middle(system: &dyn Dynamics, from: &State, to: &State, increment: &[f64], out: &mut State) {
    out.a.iter_mut().zip(increment).for_each(|(half, d)| *half = 0.5 * d);
    system.retract(&from.q, &out.a, &mut out.q);
    means(from, to, out);
}

/// Writes all but the configuration of the middle of a step.
pub(super) fn means(from: &State, to: &State, out: &mut State) {
    let h = to.t - from.t;
    for i in 0..out.v.len() {
        out.v[i] = 0.5 * (from.v[i] + to.v[i]);
        out.a[i] = (to.v[i] - from.v[i]) / h;
    }
    finish(from, to, 0.5, from.t + 0.5 * h, out);
}

/// Values, first and second derivatives at s of the quintics that take, one each and of the others nothing, the value
/// at 1, the slopes at 0 and 1, and the second derivatives at 0 and 1.
fn quintic_weights(s: f64) -> [[f64; 5]; 3] {
    // Coefficients of s³, s⁴, s⁵, and those of s and s².
    const HIGH: [[f64; 3]; 5] =
        [[10.0, -15.0, 6.0], [-6.0, 8.0, -3.0], [-4.0, 7.0, -3.0], [-1.5, 1.5, -0.5], [0.5, -1.0, 0.5]];
    const LOW: [[f64; 2]; 5] = [[0.0; 2], [1.0, 0.0], [0.0; 2], [0.0, 0.5], [0.0; 2]];
    let mut weights = [[0.0; 5]; 3];
    for (k, ([c3, c4, c5], [c1, c2])) in HIGH.into_iter().zip(LOW).enumerate() {
        weights[0][k] = s * (c1 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
        weights[1][k] = c1 + s * (2.0 * c2 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
        weights[2][k] = 2.0 * c2 + s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5));
    }
    weights
}

/// (t − t₀)/h, 1 for an empty step.
pub(super) fn fraction(from: &State, to: &State, t: f64) -> f64 {
    let h = to.t - from.t;
    if h > 0.0 { (t - from.t) / h } else { 1.0 }
}

/// The cubic through v and a of both ends.
fn velocities(from: &State, to: &State, h: f64, s: f64, out: &mut State) {
    let (p, p0, p1) = (s * s * (3.0 - 2.0 * s), s * (1.0 - s) * (1.0 - s), s * s * (s - 1.0));
    for i in 0..out.v.len() {
        let change = to.v[i] - from.v[i];
        out.v[i] = from.v[i] + change * p + h * (from.a[i] * p0 + to.a[i] * p1);
    }
}

/// Multipliers (linear), modes and time.
fn finish(from: &State, to: &State, s: f64, t: f64, out: &mut State) {
    for i in 0..out.lambda.len() {
        out.lambda[i] = from.lambda[i] + s * (to.lambda[i] - from.lambda[i]);
    }
    out.copy_modes(from);
    (out.t, out.side) = (t, Side::Right);
}

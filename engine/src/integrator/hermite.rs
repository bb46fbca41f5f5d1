//! Dense output: Hermite polynomials in the space of increments.
//!
//! Over a step of size h from (q₀, v₀, a₀) to (q₁ = q₀ ⊞ D, v₁, a₁), with s = (t − t₀)/h,
//!
//! ```text
//! q(t) = q₀ ⊞ d(s),   v = d′/h,   a = d″/h²      (quintic: matches q, v and a at both ends)
//! q(t) = q₀ ⊞ d(s),   v = d′/h,   a linear       (cubic: matches q and v)
//! ```
//!
//! On a vector space the interpolation errors are O(h⁶), O(h⁵), O(h⁴) of q, v, a for the quintic and
//! O(h⁴), O(h³), O(h²) for the cubic.

use crate::system::{State, System};

/// Writes the cubic through q and v of both ends; `increment` is D.
pub(super) fn cubic(
    system: &dyn System,
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
    for i in 0..increment.len() {
        let (d, v0, v1) = (increment[i], from.v[i], to.v[i]);
        // The acceleration's slot holds the increment until the configuration is retracted.
        out.a[i] = d * p + h * (v0 * p0 + v1 * p1);
        out.v[i] = if h > 0.0 { d * dp / h + v0 * dp0 + v1 * dp1 } else { v1 };
    }
    system.retract(&from.q, &out.a, &mut out.q);
    for i in 0..increment.len() {
        out.a[i] = from.a[i] + s * (to.a[i] - from.a[i]);
    }
    finish(from, to, s, t, out);
}

/// Writes the quintic through q, v and a of both ends; `increment` is D.
pub(super) fn quintic(
    system: &dyn System,
    from: &State,
    to: &State,
    increment: &[f64],
    t: f64,
    out: &mut State,
) {
    let h = to.t - from.t;
    let s = fraction(from, to, t);
    for i in 0..increment.len() {
        let [c3, c4, c5] = coefficients(h, increment[i], from, to, i);
        let (v0, a0) = (h * from.v[i], 0.5 * h * h * from.a[i]);
        out.a[i] = s * (v0 + s * (a0 + s * (c3 + s * (c4 + s * c5))));
        let slope = v0 + s * (2.0 * a0 + s * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)));
        out.v[i] = if h > 0.0 { slope / h } else { to.v[i] };
    }
    system.retract(&from.q, &out.a, &mut out.q);
    for i in 0..increment.len() {
        let [c3, c4, c5] = coefficients(h, increment[i], from, to, i);
        let bend = s * (6.0 * c3 + s * (12.0 * c4 + s * 20.0 * c5));
        out.a[i] = if h > 0.0 { from.a[i] + bend / (h * h) } else { to.a[i] };
    }
    finish(from, to, s, t, out);
}

/// Coefficients of s³, s⁴, s⁵.
fn coefficients(h: f64, d: f64, from: &State, to: &State, i: usize) -> [f64; 3] {
    let (v0, v1) = (h * from.v[i], h * to.v[i]);
    let (a0, a1) = (0.5 * h * h * from.a[i], 0.5 * h * h * to.a[i]);
    // Remainders of value, slope and half bend at s = 1 once the first three coefficients are taken.
    let value = d - v0 - a0;
    let slope = v1 - v0 - 2.0 * a0;
    let bend = a1 - a0;
    [
        10.0 * value - 4.0 * slope + bend,
        -15.0 * value + 7.0 * slope - 2.0 * bend,
        6.0 * value - 3.0 * slope + bend,
    ]
}

/// (t − t₀)/h, 1 for an empty step.
fn fraction(from: &State, to: &State, t: f64) -> f64 {
    let h = to.t - from.t;
    if h > 0.0 { (t - from.t) / h } else { 1.0 }
}

/// Multipliers (linear) and time.
fn finish(from: &State, to: &State, s: f64, t: f64, out: &mut State) {
    for i in 0..out.lambda.len() {
        out.lambda[i] = from.lambda[i] + s * (to.lambda[i] - from.lambda[i]);
    }
    out.t = t;
}

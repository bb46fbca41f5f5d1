//! The section of a blade in space: its frame, and its strains, as jets.
//!
//! The axis is r(x) with r′ = (1 + u′, v′, w′) in the blade's frame, λ = |r′|, t = r′/λ. The frame (t, n, b) is
//! the undeformed frame (e₁, e₂, e₃) moved by the smallest rotation that takes e₁ to t, and the section's axes
//! are rotated from it by the angle ψ = θ + φ about t:
//!
//! ```text
//! n = e₂ − t₂/(1+t₁) (e₁ + t),     b = e₃ − t₃/(1+t₁) (e₁ + t)
//! d₂ = cos ψ n + sin ψ b,          d₃ = −sin ψ n + cos ψ b
//! ```
//!
//! With t′ = (r″ − t (t·r″))/λ the curvatures along the section's axes and the rate of twist are
//!
//! ```text
//! κ₂ = t′·d₂,  κ₃ = t′·d₃,     d₂′·d₃ = θ′ + τ,   τ = φ′ + (t₃ t₂′ − t₂ t₃′)/(1 + t₁)
//! ```
//!
//! The smallest rotation fails only where the axis reverses, t = −e₁.
//!
//! Source: C. Meier, A. Popp & W. A. Wall, *Comput. Methods Appl. Mech. Eng.* 278 (2014) 445–478,
//! doi:10.1016/j.cma.2014.05.017.

use super::jet::Jet;

/// A vector of jets.
pub type Vector<const N: usize> = [Jet<N>; 3];

/// Axes t, d₂, d₃ of the section at slopes r′ and the angle ψ from the smallest rotation.
pub fn axes<const N: usize>(slope: &Vector<N>, angle: &Jet<N>) -> [Vector<N>; 3] {
    let (_, t) = unit(slope);
    let shape = Jet::constant(1.0);
    let (zero, inverse) = (Jet::constant(0.0), (shape + t[0]).inverse());
    let lean = [t[0] + shape, t[1], t[2]];
    let (c2, c3) = (t[1] * inverse, t[2] * inverse);
    let n = [zero - c2 * lean[0], shape - c2 * lean[1], zero - c2 * lean[2]];
    let b = [zero - c3 * lean[0], zero - c3 * lean[1], shape - c3 * lean[2]];
    let (sin, cos) = Jet::sin_cos(angle);
    let d2 = std::array::from_fn(|k| cos * n[k] + sin * b[k]);
    let d3 = std::array::from_fn(|k| cos * b[k] - sin * n[k]);
    [t, d2, d3]
}

/// Stretch λ and unit tangent t.
pub fn unit<const N: usize>(slope: &Vector<N>) -> (Jet<N>, Vector<N>) {
    let [x, y, z] = *slope;
    let stretch = (x * x + y * y + z * z).sqrt();
    let inverse = stretch.inverse();
    (stretch, [x * inverse, y * inverse, z * inverse])
}

/// Strains of a section.
#[derive(Clone, Copy, Debug)]
pub struct Strains<const N: usize> {
    /// Stretch λ of the axis.
    pub stretch: Jet<N>,
    /// Curvatures κ₂ and κ₃ [1/m].
    pub curvature: [Jet<N>; 2],
    /// Change τ of the rate of twist [rad/m].
    pub twist: Jet<N>,
}

/// What the strains need of the slopes r′ = (x, y, z), functions of these three numbers only.
#[derive(Clone, Copy, Debug)]
pub struct Tangent<const N: usize> {
    stretch: Jet<N>,
    /// 1/λ
    inverse: Jet<N>,
    t: Vector<N>,
    /// t₂/(1 + t₁), t₃/(1 + t₁)
    lean: [Jet<N>; 2],
}

impl<const N: usize> Tangent<N> {
    /// At slopes r′.
    pub fn new(slope: &Vector<N>) -> Tangent<N> {
        let (stretch, t) = unit(slope);
        let scale = (Jet::constant(1.0) + t[0]).inverse();
        Tangent { stretch, inverse: stretch.inverse(), t, lean: [t[1] * scale, t[2] * scale] }
    }

    /// The same as a function of more variables, of which its own are the first.
    pub fn among<const M: usize>(&self) -> Tangent<M> {
        Tangent {
            stretch: self.stretch.among(),
            inverse: self.inverse.among(),
            t: self.t.map(|t| t.among()),
            lean: self.lean.map(|lean| lean.among()),
        }
    }
}

/// Strains at a tangent and derivatives r″ of the slopes, the angle ψ and the derivative φ′.
pub fn strains<const N: usize>(
    tangent: &Tangent<N>,
    bend: &Vector<N>,
    angle: &Jet<N>,
    twist: &Jet<N>,
) -> Strains<N> {
    let Tangent { stretch, inverse, t, lean } = *tangent;
    let along = t[0] * bend[0] + t[1] * bend[1] + t[2] * bend[2];
    let rate: Vector<N> = std::array::from_fn(|k| (bend[k] - t[k] * along) * inverse);
    let n = rate[1] - lean[0] * rate[0];
    let b = rate[2] - lean[1] * rate[0];
    let (sin, cos) = Jet::sin_cos(angle);
    Strains {
        stretch,
        curvature: [cos * n + sin * b, cos * b - sin * n],
        twist: *twist + lean[1] * rate[1] - lean[0] * rate[2],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(v: &Vector<1>) -> [f64; 3] {
        [v[0].x, v[1].x, v[2].x]
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    /// r′ and ψ along a curve in space.
    fn curve(x: f64) -> ([f64; 3], f64) {
        ([1.1 + 0.2 * (0.7 * x).sin(), 0.6 * x * x - 0.3, (1.3 * x).cos()], 0.4 + 0.9 * x + 0.3 * x * x)
    }

    fn frame(x: f64) -> [[f64; 3]; 3] {
        let (slope, angle) = curve(x);
        let axes = axes::<1>(&slope.map(Jet::constant), &Jet::constant(angle));
        axes.map(|axis| numbers(&axis))
    }

    #[test]
    fn the_axes_are_orthonormal_and_right_handed() {
        let [t, d2, d3] = frame(0.8);
        for (a, b, expected) in
            [(t, t, 1.0), (d2, d2, 1.0), (d3, d3, 1.0), (t, d2, 0.0), (t, d3, 0.0), (d2, d3, 0.0)]
        {
            assert!((dot(a, b) - expected).abs() < 1e-15);
        }
        let cross = [t[1] * d2[2] - t[2] * d2[1], t[2] * d2[0] - t[0] * d2[2], t[0] * d2[1] - t[1] * d2[0]];
        assert!((dot(cross, d3) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn strains_are_the_rates_at_which_the_axes_rotate() {
        let (x, d) = (0.8, 1e-5);
        let (before, at, after) = (frame(x - d), frame(x), frame(x + d));
        let rate =
            |k: usize| -> [f64; 3] { std::array::from_fn(|i| (after[k][i] - before[k][i]) / (2.0 * d)) };
        let (slope, angle) = curve(x);
        let bend: [f64; 3] = std::array::from_fn(|i| (curve(x + d).0[i] - curve(x - d).0[i]) / (2.0 * d));
        let found = strains::<1>(
            &Tangent::new(&slope.map(Jet::constant)),
            &bend.map(Jet::constant),
            &Jet::constant(angle),
            &Jet::constant(0.9 + 0.6 * x),
        );
        for (found, expected) in [
            (found.curvature[0].x, dot(rate(0), at[1])),
            (found.curvature[1].x, dot(rate(0), at[2])),
            (found.twist.x, dot(rate(1), at[2])),
        ] {
            assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
        }
    }
}

//! Continuous contact forces: the force as a function of indentation δ = −g > 0 and its rate.
//!
//! ```text
//! F = max(0, K δⁿ (1 + χ δ̇/v₀)),   v₀ the closing speed at touch;   stored K δⁿ⁺¹/(n + 1)
//! ```
//!
//! The force is never adhesive. With m the mass that rebounds, m v dv = −F dδ gives the coefficient of restitution that
//! the law delivers, e′ ≠ e: v₀ → −e′ v₀ with
//!
//! ```text
//! χ (1 + e′) = ln[ (1 + χ)/(1 − χ e′) ]
//! ```
//!
//! | damping | χ(e) | source |
//! |---|---|---|
//! | none | 0 | Hertz |
//! | Hunt–Crossley | 3(1 − e)/2 | Hunt & Crossley (1975), doi 10.1115/1.3423596 |
//! | Lankarani–Nikravesh | 3(1 − e²)/4 | Lankarani & Nikravesh (1990), doi 10.1115/1.2912617 |
//! | Flores | 8(1 − e)/(5e) | Flores et al. (2011), doi 10.1007/s11044-010-9237-4 |
//! | Gonthier | (1 − e²)/e | Gonthier et al. (2004), doi 10.1023/B:MUBO.0000029392.21648.bc |
//! | matched | the root of the equation above with e′ = e | the same, without its approximation |

/// How a contact force loses energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dissipation {
    /// Not at all.
    Hertz,
    /// χ = 3(1 − e)/2
    HuntCrossley,
    /// χ = 3(1 − e²)/4
    LankaraniNikravesh,
    /// χ = 8(1 − e)/(5e)
    Flores,
    /// χ = (1 − e²)/e
    Gonthier,
    /// χ of which e is delivered.
    Matched,
}

impl Dissipation {
    /// χ for a nominal coefficient of restitution e, 0 < e ≤ 1 (0 too where the formula allows it).
    pub fn factor(self, e: f64) -> f64 {
        match self {
            Dissipation::Hertz => 0.0,
            Dissipation::HuntCrossley => 1.5 * (1.0 - e),
            Dissipation::LankaraniNikravesh => 0.75 * (1.0 - e * e),
            Dissipation::Flores => 1.6 * (1.0 - e) / e,
            Dissipation::Gonthier => (1.0 - e * e) / e,
            Dissipation::Matched => matched(e),
        }
    }

    /// Whether e = 0 has no finite factor.
    pub fn needs_rebound(self) -> bool {
        matches!(self, Dissipation::Flores | Dissipation::Gonthier | Dissipation::Matched)
    }
}

/// χ (1 + e) − ln[ (1 + χ)/(1 − χ e) ]: positive where the factor delivers more than e.
fn excess(factor: f64, e: f64) -> f64 {
    factor * (1.0 + e) - libm::log((1.0 + factor) / (1.0 - factor * e))
}

/// The coefficient of restitution that a factor χ delivers to one mass.
pub fn delivered(factor: f64) -> f64 {
    if factor <= 0.0 { 1.0 } else { last_positive(|e| excess(factor, e), 1.0_f64.min(1.0 / factor)) }
}

/// The factor that delivers e.
fn matched(e: f64) -> f64 {
    if e >= 1.0 { 0.0 } else { last_positive(|factor| excess(factor, e), 1.0 / e) }
}

/// Where f, positive behind 0, falls to zero before `end`.
fn last_positive(f: impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    // Until the bracket is two neighbouring numbers.
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// A continuous normal force with friction. Its formulas head the source file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactForce {
    /// K [N/mⁿ]
    pub stiffness: f64,
    /// n ≥ 1; 3/2 for Hertz's contact of spheres.
    pub exponent: f64,
    /// χ
    pub factor: f64,
    /// Coefficient of friction μ.
    pub friction: f64,
    /// Sliding speed v_s of the regularised friction −μ F tanh(|v|/v_s) v/|v| \[m/s\].
    pub slip_speed: f64,
}

/// A force with its derivatives by indentation and rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Response {
    /// F \[N\]
    pub value: f64,
    /// ∂F/∂δ \[N/m\]
    pub by_indentation: f64,
    /// ∂F/∂δ̇ \[N·s/m\]
    pub by_rate: f64,
}

impl ContactForce {
    /// The normal force at the indentation δ \[m\], its rate δ̇ and the closing speed v₀ \[m/s\]: where that is zero, the
    /// contact began at rest and is not damped.
    pub fn normal(&self, indentation: f64, rate: f64, closing: f64) -> Response {
        if indentation <= 0.0 {
            return Response::default();
        }
        let power = libm::pow(indentation, self.exponent);
        let (elastic, slope) = (self.stiffness * power, self.stiffness * self.exponent * power / indentation);
        let damping = if closing > 0.0 { self.factor / closing } else { 0.0 };
        let factor = 1.0 + damping * rate;
        if factor <= 0.0 {
            return Response::default();
        }
        Response { value: elastic * factor, by_indentation: slope * factor, by_rate: elastic * damping }
    }

    /// K δⁿ⁺¹/(n + 1) \[J\]
    pub fn stored(&self, indentation: f64) -> f64 {
        let power = libm::pow(indentation.max(0.0), self.exponent + 1.0);
        self.stiffness * power / (self.exponent + 1.0)
    }

    /// Friction over normal force, −μ tanh(|v|/v_s) v/|v|, and its derivatives by the components of the sliding velocity v \[m/s\].
    pub fn friction(&self, sliding: [f64; 2]) -> ([f64; 2], [[f64; 2]; 2]) {
        if self.friction == 0.0 {
            return ([0.0; 2], [[0.0; 2]; 2]);
        }
        let speed = libm::hypot(sliding[0], sliding[1]);
        let part = libm::tanh(speed / self.slip_speed);
        let slope = (1.0 - part * part) / self.slip_speed;
        let (over, along) = if speed > 0.0 {
            (part / speed, sliding.map(|v| v / speed))
        } else {
            (1.0 / self.slip_speed, [0.0; 2])
        };
        let entry = |i: usize, j: usize| {
            let across = if i == j { over } else { 0.0 };
            -self.friction * (across + (slope - over) * along[i] * along[j])
        };
        (sliding.map(|v| -self.friction * over * v), [0, 1].map(|i| [0, 1].map(|j| entry(i, j))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// m δ̈ = −F from touch to leaving, by small steps.
    fn rebound(law: &ContactForce, speed: f64) -> f64 {
        let (mut x, mut v) = (0.0, speed);
        let h = 2e-8;
        let f = |x: f64, v: f64| -law.normal(x, v, speed).value;
        loop {
            let (k1, l1) = (v, f(x, v));
            let (k2, l2) = (v + 0.5 * h * l1, f(x + 0.5 * h * k1, v + 0.5 * h * l1));
            let (k3, l3) = (v + 0.5 * h * l2, f(x + 0.5 * h * k2, v + 0.5 * h * l2));
            let (k4, l4) = (v + h * l3, f(x + h * k3, v + h * l3));
            x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            v += h / 6.0 * (l1 + 2.0 * l2 + 2.0 * l3 + l4);
            if x <= 0.0 {
                return -v / speed;
            }
        }
    }

    #[test]
    fn each_law_delivers_what_the_equation_says_and_the_matched_one_its_nominal_restitution() {
        for e in [0.3, 0.7, 0.95] {
            for kind in [
                Dissipation::Hertz,
                Dissipation::HuntCrossley,
                Dissipation::LankaraniNikravesh,
                Dissipation::Flores,
                Dissipation::Gonthier,
                Dissipation::Matched,
            ] {
                let factor = kind.factor(e);
                let law =
                    ContactForce { stiffness: 1e6, exponent: 1.5, factor, friction: 0.0, slip_speed: 1.0 };
                let found = rebound(&law, 0.7);
                assert!(
                    (found - delivered(factor)).abs() < 2e-5,
                    "{kind:?} {e}: {found} {}",
                    delivered(factor)
                );
                if kind == Dissipation::Matched {
                    assert!((found - e).abs() < 2e-5, "{e}: {found}");
                }
            }
        }
    }

    #[test]
    fn derivatives_are_those_of_the_force() {
        let law =
            ContactForce { stiffness: 1e6, exponent: 1.5, factor: 0.6, friction: 0.4, slip_speed: 0.01 };
        let (x, v, d) = (1e-3, -0.2, 1e-7);
        let now = law.normal(x, v, 0.5);
        let by_x = (law.normal(x + d, v, 0.5).value - law.normal(x - d, v, 0.5).value) / (2.0 * d);
        let by_v = (law.normal(x, v + d, 0.5).value - law.normal(x, v - d, 0.5).value) / (2.0 * d);
        assert!((now.by_indentation / by_x - 1.0).abs() < 1e-6);
        assert!((now.by_rate / by_v - 1.0).abs() < 1e-6);
        for v in [[0.004, 0.0], [0.004, -0.007], [0.0, 0.0]] {
            let (_, slope) = law.friction(v);
            for j in 0..2 {
                let moved = |d: f64| law.friction([0, 1].map(|i| if i == j { v[i] + d } else { v[i] })).0;
                let (more, less) = (moved(d), moved(-d));
                for i in 0..2 {
                    let by = (more[i] - less[i]) / (2.0 * d);
                    assert!((slope[i][j] - by).abs() < 1e-6 * 0.4 / 0.01, "{v:?} {i} {j}");
                }
            }
        }
        let stored = (law.stored(x + d) - law.stored(x - d)) / (2.0 * d);
        assert!((stored / law.normal(x, 0.0, 0.5).value - 1.0).abs() < 1e-6);
        // Never adhesive.
        assert_eq!(law.normal(x, -2.0, 0.5), Response::default());
    }
}

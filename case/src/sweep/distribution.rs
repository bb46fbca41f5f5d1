//! Distributions of an input, by their inverse distribution functions x(u), 0 < u < 1.

use statrs::distribution::{ContinuousCDF, Normal, Triangular, Weibull};

/// A distribution and its parameters, in the unit of its input but for shapes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// x = a + u (b − a).
    Uniform(f64, f64),
    /// Mean µ and standard deviation σ: x = µ + σ Φ⁻¹(u).
    Normal(f64, f64),
    /// Mean m and standard deviation s of x itself: x = exp(µ + σ Φ⁻¹(u)), with σ² = ln(1 + s²/m²) and µ = ln m − σ²/2.
    LogNormal(f64, f64),
    /// Smallest value, mode and largest value.
    Triangular(f64, f64, f64),
    /// Scale λ and shape k: x = λ (−ln(1 − u))^(1/k).
    Weibull(f64, f64),
}

/// Names, with what their parameters are called.
const NAMES: [(&str, &[&str]); 5] = [
    ("uniform", &["smallest", "largest"]),
    ("normal", &["mean", "standard deviation"]),
    ("lognormal", &["mean", "standard deviation"]),
    ("triangular", &["smallest", "mode", "largest"]),
    ("weibull", &["scale", SHAPE]),
];

/// The parameter that has no unit.
pub(super) const SHAPE: &str = "shape";

/// What the parameters of a distribution are called.
pub(super) fn parameters(name: &str) -> Option<&'static [&'static str]> {
    NAMES.iter().find(|(other, _)| *other == name).map(|(_, parameters)| *parameters)
}

/// The names of the distributions.
pub(super) fn names() -> impl Iterator<Item = &'static str> {
    NAMES.iter().map(|(name, _)| *name)
}

/// All distributions as they are written.
pub(super) fn written() -> String {
    let one = |(name, parameters): &(&str, &[&str])| format!("`{name}({})`", parameters.join(", "));
    NAMES.iter().map(one).collect::<Vec<_>>().join(", ")
}

impl Distribution {
    /// The distribution of a name and its parameters.
    ///
    /// # Errors
    /// What is wrong with them, in one sentence.
    pub(super) fn new(name: &str, parameters: &[f64]) -> Result<Distribution, String> {
        let positive = |x: f64, what: &str| {
            if x > 0.0 && x.is_finite() {
                Ok(())
            } else {
                Err(format!("the {what} must be positive, but is {x:e}"))
            }
        };
        let ascend = |low: f64, high: f64| {
            if low < high && (high - low).is_finite() {
                Ok(())
            } else {
                Err(format!("the smallest value {low:e} must be below the largest, {high:e}"))
            }
        };
        match (name, parameters) {
            ("uniform", &[low, high]) => ascend(low, high).map(|()| Distribution::Uniform(low, high)),
            ("normal", &[mean, deviation]) => {
                positive(deviation, "standard deviation").map(|()| Distribution::Normal(mean, deviation))
            }
            ("lognormal", &[mean, deviation]) => {
                positive(mean, "mean")?;
                positive(deviation, "standard deviation").map(|()| Distribution::LogNormal(mean, deviation))
            }
            ("triangular", &[low, mode, high]) => {
                ascend(low, high)?;
                if (low..=high).contains(&mode) {
                    Ok(Distribution::Triangular(low, mode, high))
                } else {
                    Err(format!("the mode {mode:e} must lie from {low:e} to {high:e}"))
                }
            }
            ("weibull", &[scale, shape]) => {
                positive(scale, "scale")?;
                positive(shape, SHAPE).map(|()| Distribution::Weibull(scale, shape))
            }
            _ => Err(format!("the distributions are {}", written())),
        }
    }

    /// The value x(u) below which the part u, 0 < u < 1, of all values lies.
    pub fn quantile(&self, u: f64) -> f64 {
        // The parameters of the standard forms are those that the constructors take.
        let standard = |u: f64| Normal::standard().inverse_cdf(u);
        match *self {
            Distribution::Uniform(low, high) => low + u * (high - low),
            Distribution::Normal(mean, deviation) => mean + deviation * standard(u),
            Distribution::LogNormal(mean, deviation) => {
                let variance = libm::log1p((deviation / mean) * (deviation / mean));
                mean * libm::exp(variance.sqrt() * standard(u) - 0.5 * variance)
            }
            Distribution::Triangular(low, mode, high) => {
                let of = Triangular::new(0.0, 1.0, (mode - low) / (high - low));
                low + (high - low) * of.map_or(f64::NAN, |of| of.inverse_cdf(u))
            }
            Distribution::Weibull(scale, shape) => {
                scale * Weibull::new(shape, 1.0).map_or(f64::NAN, |of| of.inverse_cdf(u))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables_and_of_integrals_of_the_density() {
        let near = |a: f64, b: f64| assert!((a - b).abs() <= 1e-12 * b.abs().max(1.0), "{a} {b}");
        // Abramowitz & Stegun, table 26.5: the quantile 0.975 of the normal distribution.
        near(Distribution::Normal(2.0, 3.0).quantile(0.975), 2.0 + 3.0 * 1.959_963_984_540_054);
        near(Distribution::Uniform(-1.0, 3.0).quantile(0.25), 0.0);
        near(Distribution::Triangular(0.0, 1.0, 2.0).quantile(0.125), 0.5);
        near(Distribution::Weibull(7e10, 40.0).quantile(1.0 - (-1.0f64).exp()) / 7e10, 1.0);
        // The mean and the deviation of the quantiles are those that were asked for.
        for of in [Distribution::Normal(5.0, 0.5), Distribution::LogNormal(5.0, 0.5)] {
            let n = 200_000;
            let all = || (0..n).map(|i| of.quantile((f64::from(i) + 0.5) / f64::from(n)));
            let mean = all().sum::<f64>() / f64::from(n);
            let variance = all().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(n);
            assert!(
                (mean - 5.0).abs() < 1e-5 && (variance.sqrt() - 0.5).abs() < 1e-4,
                "{of:?} {mean} {variance}"
            );
        }
    }

    #[test]
    fn parameters_of_no_distribution_are_refused() {
        let refused = |name, of: &[f64]| Distribution::new(name, of).unwrap_err();
        assert!(refused("normal", &[1.0, -1.0]).contains("standard deviation must be positive"));
        assert!(refused("uniform", &[2.0, 1.0]).contains("below the largest"));
        assert!(refused("triangular", &[0.0, 3.0, 2.0]).contains("the mode"));
        assert!(refused("lognormal", &[-1.0, 1.0]).contains("the mean must be positive"));
        assert!(refused("uniform", &[1.0]).contains("`uniform(smallest, largest)`"));
    }
}

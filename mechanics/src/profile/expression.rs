//! Profiles written as a formula, with exact derivatives.

use super::program::Program;
use super::{Profile, ProfileError, positive};
use crate::quadrature::Gauss;

/// Intervals scanned for changes of branch.
const SCAN: usize = 4096;
/// Intervals of the integral, besides the breaks.
const PANELS: usize = 512;
/// Gauss points an interval.
const POINTS: usize = 12;

/// A formula in one variable, e.g. `2*sin(pi*t) + if(t < 3, 0, t - 3)`.
///
/// Operators `+ - * / ^ < <= > >=`, constants `pi tau e`, functions `sin cos tan asin acos atan sinh cosh
/// tanh exp ln log10 sqrt abs sign step floor min max if`. Value and derivatives are exact (automatic
/// differentiation); the integral is composite Gauss quadrature on a grid fixed by the duration and the
/// breaks, and so a pure function of time. Breaks (changes of branch) are found by scanning 4096 equal
/// intervals and bisecting; a branch that opens and closes within one interval may be missed.
#[derive(Clone, Debug)]
pub struct Expression {
    program: Program,
    breaks: Vec<f64>,
    grid: Vec<f64>,
    /// ∫ from 0 to each boundary of the grid.
    sums: Vec<f64>,
    gauss: Gauss,
}

impl Expression {
    /// Reads `text` as a formula in `variable` (usually `t`) for values from 0 to `extent`, the duration of
    /// the run \[s\].
    ///
    /// # Errors
    /// [`ProfileError::Expression`] says where the text is no formula; [`ProfileError::NotFinite`] when value
    /// or first derivative is not finite somewhere on the scanned grid.
    pub fn new(text: &str, variable: &str, extent: f64) -> Result<Expression, ProfileError> {
        positive("duration over which an expression is needed [s]", extent)?;
        let program = Program::parse(text, variable)?;
        let station = |k: usize, n: usize| if k == n { extent } else { extent * (k as f64 / n as f64) };
        let mut breaks = Vec::new();
        for k in 0..=SCAN {
            let time = station(k, SCAN);
            let (jet, branch) = program.eval(time);
            for (what, value) in [("itself", jet.value), ("differentiated", jet.rate)] {
                if !value.is_finite() {
                    return Err(ProfileError::NotFinite {
                        text: text.into(),
                        what,
                        value,
                        time,
                        duration: extent,
                    });
                }
            }
            let mut from = if k == 0 { time } else { station(k - 1, SCAN) };
            for _ in 0..16 {
                match first_change(&program, from, time, branch) {
                    Some(t) => {
                        breaks.push(t);
                        from = t;
                    }
                    None => break,
                }
            }
        }
        let mut grid: Vec<f64> =
            (0..=PANELS).map(|k| station(k, PANELS)).chain(breaks.iter().copied()).collect();
        grid.sort_by(f64::total_cmp);
        grid.dedup();
        let gauss = Gauss::new(POINTS);
        let mut sums = vec![0.0; grid.len()];
        for i in 1..grid.len() {
            sums[i] = sums[i - 1] + gauss.integrate(grid[i - 1], grid[i], |t| program.value(t));
        }
        Ok(Expression { program, breaks, grid, sums, gauss })
    }
}

/// The first double after `from` on which the branch differs from that of `from`, if `to` (whose branch is
/// given) differs.
fn first_change(program: &Program, from: f64, to: f64, branch: u64) -> Option<f64> {
    let start = program.eval(from).1;
    if start == branch {
        return None;
    }
    let (mut same, mut other) = (from, to);
    loop {
        let middle = 0.5 * (same + other);
        if middle <= same || middle >= other {
            return Some(other);
        }
        if program.eval(middle).1 == start { same = middle } else { other = middle }
    }
}

impl Profile for Expression {
    fn value(&self, t: f64) -> f64 {
        self.program.value(t)
    }

    fn rate(&self, t: f64) -> f64 {
        self.program.eval(t).0.rate
    }

    fn acceleration(&self, t: f64) -> f64 {
        self.program.eval(t).0.bend
    }

    fn integral(&self, t: f64) -> f64 {
        let i = self.grid.partition_point(|&start| start <= t).saturating_sub(1);
        self.sums[i] + self.gauss.integrate(self.grid[i], t, |t| self.value(t))
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    fn value(text: &str, t: f64) -> f64 {
        Expression::new(text, "t", 10.0).unwrap_or_else(|e| panic!("{e}")).value(t)
    }

    #[test]
    fn a_value_alone_is_that_of_value_and_derivatives_together() {
        let names = "sin cos tan asin acos atan sinh cosh tanh exp ln log10 sqrt abs sign step floor";
        let mut texts: Vec<String> =
            names.split(' ').map(|name| format!("3*pi/4*{name}(t/10) + 2^(1+1)")).collect();
        texts.extend(
            ["min(t, 2) - max(2, t^2)", "if(t < 1 + 1, t^t, (-t)^3)", "(2 <= 1) + (1 > 0)*t"]
                .map(String::from),
        );
        for text in texts {
            let program = Program::parse(&text, "t").unwrap();
            for t in [0.1, 0.5, 2.0, 7.0] {
                let (alone, together) = (program.value(t), program.eval(t).0.value);
                assert!(
                    (alone - together).abs() <= 4.0 * f64::EPSILON * alone.abs(),
                    "{text}: {alone} {together}"
                );
            }
        }
    }

    #[test]
    fn signs_and_powers_bind_as_in_mathematics() {
        for (text, expected) in [
            ("-t^2", -9.0),
            ("2^-1", 0.5),
            ("2^3^2", 512.0),
            ("1 - 2 - 3", -4.0),
            ("8/2/2", 2.0),
            ("2*-t", -6.0),
            ("exp(-t^2)", (-9.0_f64).exp()),
            ("1.5e-1*t + .5", 0.95),
            ("2e", f64::NAN),
            ("-(t - 1)*(t + 1)", -8.0),
            ("if(t >= 3, 1, 2) + (t < 3)", 1.0),
            ("max(t, 5) - min(t, 5) + abs(-t) + floor(2.7) + step(t - 3) + sign(-t)", 7.0),
        ] {
            if expected.is_nan() {
                assert!(Expression::new(text, "t", 10.0).is_err(), "{text}");
            } else {
                assert!((value(text, 3.0) - expected).abs() < 1e-15 * (1.0 + expected.abs()), "{text}");
            }
        }
    }

    #[test]
    fn derivatives_and_integral_belong_to_the_values() {
        for text in [
            "3",
            "t",
            "t^2 - 4*t^3 + t^0",
            "2*sin(3*t)*cos(t)/(1 + t^2)",
            "exp(-t)*sqrt(1 + t)*tanh(t)",
            "(1 + t)^(t/3)",
            "ln(2 + t) + log10(1 + t^2) + atan(t) + asin(t/4) - acos(t/5) + tan(t/3)",
            "sinh(t/2) - cosh(t/2) + (t - 1)^3 + pi*tau*e",
            "if(t < 1.234, t^3, 2 - t)",
            "abs(sin(5*t)) + max(t, 1.7) + min(t^2, 2) + t*floor(t)",
            "4/3*t - 4/(2*pi)*sin(2*pi*t/3)",
        ] {
            let profile = Expression::new(text, "t", 3.0).unwrap_or_else(|e| panic!("{e}"));
            checks::derivatives_and_integral(&profile, 3.0);
        }
    }

    #[test]
    fn integral_is_that_of_the_closed_form() {
        let profile = Expression::new("4/15*t - 4/(2*pi)*sin(2*pi*t/15)", "t", 20.0).unwrap();
        let spin = super::super::SpinUp::new(4.0, 15.0).unwrap();
        for t in [0.1, 3.3, 7.5, 14.99] {
            assert!((profile.integral(t) - spin.integral(t)).abs() < 1e-13);
            assert!((profile.acceleration(t) - spin.acceleration(t)).abs() < 1e-14);
        }
    }

    #[test]
    fn kinks_are_found_to_the_last_digit() {
        let profile = Expression::new("if(t < 0.3, 0, abs(t - 1.7)) + max(t, 2)", "t", 3.0).unwrap();
        assert_eq!(profile.breaks().len(), 3);
        for (found, expected) in profile.breaks().iter().zip([0.3, 1.7, 2.0]) {
            assert!((found - expected).abs() < 1e-15, "{found}");
        }
    }

    #[test]
    fn faults_are_placed_and_explained() {
        for (text, column, words) in [
            ("2*omega*t", 3, "`omega` is not known; the names are t, pi"),
            ("sin t", 5, "needs its argument"),
            ("t**2", 3, "powers are written with `^`"),
            ("(t + 1", 7, "closing"),
            ("min(t)", 6, "takes 2 arguments"),
            ("t t", 3, "does not continue"),
            ("", 1, "missing at the end"),
            ("1e999", 1, "not a finite number"),
            ("3 + é", 5, "not known"),
        ] {
            let message = Expression::new(text, "t", 1.0).unwrap_err().to_string();
            assert!(
                message.contains(&format!("column {column}")) && message.contains(words),
                "{text}: {message}"
            );
        }
        for text in ["1/(t - 0.5)", "sqrt(t)", "ln(t)"] {
            let message = Expression::new(text, "t", 1.0).unwrap_err().to_string();
            assert!(message.contains("must be finite"), "{message}");
        }
        assert!(Expression::new(&"(".repeat(100_000), "t", 1.0).is_err());
        assert!(Expression::new(&"1+(".repeat(100), "t", 1.0).is_err());
    }
}

//! Profiles written as a formula, with exact derivatives.

use super::panels::{Panels, Refused};
use super::program::Program;
use super::{Profile, ProfileError, positive};

/// A formula in one variable, e.g. `2*sin(pi*t) + if(t < 3, 0, t - 3)`.
///
/// Operators `+ - * / ^ < <= > >=`, constants `pi tau e`, functions `sin cos tan asin acos atan sinh cosh
/// tanh exp ln log10 sqrt abs sign step floor min max if`. Value and derivatives are exact (automatic
/// differentiation); the integral is composite Gauss quadrature on panels that are halved until the formula is
/// integrated to 10⁻¹³ of ∫|f|, and so a pure function of time. Bounds by interval arithmetic see to it that nothing is
/// missed between samples: neither a short pulse nor a branch that opens and closes, down to 10⁻⁹ of the time at which it does; what
/// is shorter is refused where it counts.
#[derive(Clone, Debug)]
pub struct Expression {
    program: Program,
    panels: Panels,
}

impl Expression {
    /// Reads `text` as a formula in `variable` (usually `t`) for values from 0 to `extent`, the duration of
    /// the run \[s\].
    ///
    /// # Errors
    /// [`ProfileError::Expression`] says where the text is no formula; [`ProfileError::NotFinite`] and
    /// [`ProfileError::Pole`] where it has no finite value or grows beyond all bounds; [`ProfileError::TooShort`] and
    /// [`ProfileError::TooFast`] where it cannot be followed.
    pub fn new(text: &str, variable: &str, extent: f64) -> Result<Expression, ProfileError> {
        positive("duration over which an expression is needed [s]", extent)?;
        let program = Program::parse(text, variable)?;
        let (text, variable) = (text.to_owned(), variable.to_owned());
        match Panels::new(&program, extent) {
            Ok(panels) => Ok(Expression { program, panels }),
            Err(Refused::NotFinite(value, at)) => {
                Err(ProfileError::NotFinite { text, variable, value, at, extent })
            }
            Err(Refused::Pole(at)) => Err(ProfileError::Pole { text, variable, at, extent }),
            Err(Refused::TooShort { at, within }) => {
                Err(ProfileError::TooShort { text, variable, at, within, extent })
            }
            Err(Refused::TooFast) => Err(ProfileError::TooFast { text, variable, extent }),
        }
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
        self.panels.integral(&self.program, t)
    }

    fn breaks(&self) -> &[f64] {
        &self.panels.breaks
    }

    fn resolution(&self) -> &[f64] {
        &self.panels.resolution
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
    fn a_jump_is_a_break_however_near_to_the_start() {
        for k in 0..200 {
            let late = 10.0 * libm::pow(10.0, -13.0 + 0.05 * f64::from(k));
            let found = Expression::new(&format!("if(t > {late:e}, 1, 0)"), "t", 10.0).unwrap();
            let expected = late.next_up();
            assert!(found.breaks().contains(&expected), "{late:e}: {:?}", found.breaks());
            assert!((found.integral(10.0) - (10.0 - late)).abs() < 1e-8, "{late:e}");
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
            "if(t < 1, 0, if(t < 1.001, 1e2, 0))",
            "exp(-((t - 1.3)/0.1)^2) + sin(9*t)",
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
        for text in ["1/(t - 0.5)", "sqrt(t - 1e-5)", "ln(t)"] {
            let message = Expression::new(text, "t", 1.0).unwrap_err().to_string();
            assert!(message.contains("must be finite"), "{message}");
        }
        assert!(Expression::new(&"(".repeat(100_000), "t", 1.0).is_err());
        assert!(Expression::new(&"1+(".repeat(100), "t", 1.0).is_err());
    }

    #[test]
    fn integrals_of_fast_and_short_functions_are_those_of_their_closed_forms() {
        let root = std::f64::consts::PI.sqrt();
        for (text, extent, exact) in [
            ("sin(100*t)", 600.0, (1.0 - (6e4_f64).cos()) / 100.0),
            ("exp(-((t-50.05)/0.005)^2)", 100.0, 0.005 * root),
            ("1e5*exp(-((t-50)/1e-5)^2)", 100.0, root),
            ("if(t < 50, 0, if(t < 50.001, 1e5, 0))", 100.0, 100.0),
            ("sqrt(1 - (t/10)^2)", 10.0, 2.5 * std::f64::consts::PI),
            ("sqrt(t)", 9.0, 18.0),
            ("if(t > 0, sin(t)/t, 1)", 1.0, 0.946_083_070_367_183),
            ("abs(t - 1/3)^0.5", 1.0, ((1.0_f64 / 3.0).powf(1.5) + (2.0_f64 / 3.0).powf(1.5)) / 1.5),
        ] {
            let profile = Expression::new(text, "t", extent).unwrap_or_else(|e| panic!("{e}"));
            let found = profile.integral(extent);
            assert!((found - exact).abs() < 1e-11 * exact.abs().max(1.0), "{text}: {found} for {exact}");
        }
    }

    #[test]
    fn poles_between_samples_are_refused_and_infinite_slopes_are_not() {
        for text in ["1/(x - 3.3)", "tan(x)", "1/(x - 3.3)^2", "if(x < 4, 1/(4 - x), 0)", "x/(x^2 - 2)"] {
            let message = Expression::new(text, "x", 10.0).unwrap_err().to_string();
            assert!(message.contains("finite") && message.contains("x = "), "{text}: {message}");
        }
        for text in [
            "x^2/x + 1",
            "sqrt(10 - x)",
            "x^(1/3)",
            "abs(sin(x))^0.5",
            "1/(x + 1e-3)",
            "1/(x^2 - 2*x + 1.001)",
        ] {
            let text = if text == "x^2/x + 1" { "if(x > 0, x^2/x, 0)" } else { text };
            assert!(Expression::new(text, "x", 10.0).is_ok(), "{text}");
        }
        let message = Expression::new("sin(1e7*t)", "t", 100.0).unwrap_err().to_string();
        assert!(message.contains("too fast"), "{message}");
    }

    /// A triangle of 2 s in ages, and pulses whose integrals are 1.5e-7 and, early, 1.5e-8 of that of the rest.
    #[test]
    fn a_short_pulse_is_seen_however_long_the_range_is() {
        for extent in [10.0, 1e8, 1e9, 1e10, 1e11, 1e12] {
            let found =
                Expression::new("max(0, 1 - abs(t - 1))", "t", extent).unwrap_or_else(|e| panic!("{e}"));
            assert!(found.breaks().iter().filter(|t| **t > 1e-9).eq(&[1.0, 2.0]), "{:?}", found.breaks());
            assert!((found.integral(extent) - 1.0).abs() < 1e-12, "{extent}");
        }
        for (start, width) in [(3e4, 1e-3), (3e4 + 7.0, 1e-3), (3.0, 1e-4)] {
            let text = format!("1 + 5*exp(-((t - {start})/{width})^2)");
            let found = Expression::new(&text, "t", 6e4).unwrap_or_else(|e| panic!("{e}"));
            let near = found.resolution().iter().filter(|t| (*t - start).abs() < 10.0 * width).count();
            let area =
                found.integral(start + 10.0 * width) - found.integral(start - 10.0 * width) - 20.0 * width;
            let exact = 5.0 * width * std::f64::consts::PI.sqrt();
            assert!(
                near > 4 && (area - exact).abs() < 1e-4 * exact.max(1e-7),
                "{text}: {near}, {area} for {exact}"
            );
        }
        // A crest between two panels.
        let found =
            Expression::new("1 + 5*exp(-((t - 5)/1e-4)^2)", "t", 10.0).unwrap_or_else(|e| panic!("{e}"));
        assert!((found.integral(10.0) - 10.0 - 5e-4 * std::f64::consts::PI.sqrt()).abs() < 1e-12);
    }

    /// ∫ sin(ωt) e^(−t/τ) = ω/(ω² + 1/τ²), and that of a bell.
    #[test]
    fn a_vibration_that_decays_is_followed_as_long_as_it_counts() {
        let exact = 2000.0 / (4e6 + 1e4);
        let bell = 0.01 * std::f64::consts::PI.sqrt();
        for extent in [1.0, 1e3, 1e5, 1e6] {
            for (text, exact) in [("sin(2000*t)*exp(-t/0.01)", exact), ("exp(-((t-0.5)/0.01)^2)", bell)] {
                let found =
                    Expression::new(text, "t", extent).unwrap_or_else(|e| panic!("{text} {extent}: {e}"));
                let off = found.integral(extent) / exact - 1.0;
                assert!(off.abs() < 1e-6, "{text}, {extent} s: {off:e}");
            }
        }
    }

    #[test]
    fn a_pulse_that_is_too_short_to_be_seen_is_refused() {
        for text in [
            "exp(-((t - 0.3)/1e-12)^2)",
            "1 - tanh((t - 0.7)/1e-14)^2",
            "if(abs(t - 0.5) < 1e-14, 1e10, 0)",
            "if(t < 0.5, 0, if(t < 0.5 + 1e-12, 1e10, 0))",
        ] {
            let message = Expression::new(text, "t", 1.0).map(|_| ()).unwrap_err().to_string();
            assert!(message.contains("too short to be followed"), "{text}: {message}");
        }
    }

    #[test]
    fn every_branch_is_found() {
        let breaks = |text: &str, extent: f64| Expression::new(text, "t", extent).unwrap().breaks().to_vec();
        assert_eq!(breaks("if(t < 50, 0, if(t < 50.001, 1e5, 0))", 100.0), [50.0, 50.001]);
        assert_eq!(breaks("floor(t)", 4.5), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(breaks("step(sin(100*t)) + 0*t", 6.0).len(), 190);
        assert_eq!(breaks("t + (t > 3)*(t < 3.0000001)", 10.0).len(), 2);
        assert_eq!(breaks("abs((t - 1)^2) + abs(t)", 3.0), [] as [f64; 0]);
    }

    #[test]
    fn three_points_between_the_times_of_the_resolution_see_the_function() {
        let resolution = |text: &str| Expression::new(text, "t", 100.0).unwrap().resolution().to_vec();
        for text in ["1", "t", "1 + 2*t - t^2", "sin(pi*t/50)", "if(t < 30.3, t, 0)", "if(t < 50, 0, 1)"] {
            assert_eq!(resolution(text), [] as [f64; 0], "{text}");
        }
        for text in ["exp(-((t-50.05)/0.005)^2)", "3*t + 1e-3*exp(-((t-50.05)/0.005)^2)"] {
            let times = resolution(text);
            let near = times.iter().filter(|t| (*t - 50.05).abs() < 0.005).count();
            assert!(near > 0 && times.len() < 60, "{text}: {near} of {}", times.len());
        }
        let many = resolution("sin(10*t)").len();
        assert!((160..1500).contains(&many), "{many}");
    }
}

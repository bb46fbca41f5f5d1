//! Profiles in closed form: constant, ramp and smooth spin-up.

use super::{Profile, ProfileError, finite, positive};
use std::f64::consts::{PI, TAU};

/// Parts of a run at whose ends these are looked at: they are largest at the ends of their pieces, or in the middle.
const PARTS: usize = 64;

/// f(t) = c.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Constant {
    value: f64,
}

impl Constant {
    /// The constant c.
    ///
    /// # Errors
    /// [`ProfileError::Quantity`] if it is not finite.
    pub fn new(value: f64) -> Result<Constant, ProfileError> {
        finite("constant value", value)?;
        Ok(Constant { value })
    }
}

impl Profile for Constant {
    fn value(&self, _t: f64) -> f64 {
        self.value
    }

    fn rate(&self, _t: f64) -> f64 {
        0.0
    }

    fn acceleration(&self, _t: f64) -> f64 {
        0.0
    }

    fn integral(&self, t: f64) -> f64 {
        self.value * t
    }

    fn parts(&self) -> usize {
        PARTS
    }
}

/// A straight line from one value at t = 0 to another at t = T, constant before and after.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramp {
    from: f64,
    to: f64,
    breaks: [f64; 2],
}

impl Ramp {
    /// From `from` at t = 0 to `to` at t = `time` \[s\].
    ///
    /// # Errors
    /// [`ProfileError::Quantity`] if a value is not finite or the time is not positive.
    pub fn new(from: f64, to: f64, time: f64) -> Result<Ramp, ProfileError> {
        finite("value at the start of the ramp", from)?;
        finite("value at the end of the ramp", to)?;
        positive("time of the ramp [s]", time)?;
        Ok(Ramp { from, to, breaks: [0.0, time] })
    }
}

impl Profile for Ramp {
    fn value(&self, t: f64) -> f64 {
        let time = self.breaks[1];
        if t >= time { self.to } else { self.from + (self.to - self.from) * (t.max(0.0) / time) }
    }

    fn rate(&self, t: f64) -> f64 {
        let time = self.breaks[1];
        if (0.0..time).contains(&t) { (self.to - self.from) / time } else { 0.0 }
    }

    fn acceleration(&self, _t: f64) -> f64 {
        0.0
    }

    fn integral(&self, t: f64) -> f64 {
        let time = self.breaks[1];
        let inside = t.clamp(0.0, time);
        let ramp = self.from * inside + 0.5 * (self.to - self.from) * inside * (inside / time);
        ramp + self.from * t.min(0.0) + self.to * (t - time).max(0.0)
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn parts(&self) -> usize {
        PARTS
    }
}

/// Smooth rise from rest to Ω in the time T, the spin-up of the rotating-beam literature:
///
/// ```text
/// f = Ω/T t − Ω/(2π) sin(2πt/T)   for 0 ≤ t ≤ T,   then Ω
/// ```
///
/// C² everywhere (f‴ jumps at T). Source: Kane, Ryan & Banerjee, *J. Guid. Control Dyn.* 10 (1987)
/// 139–151, doi:10.2514/3.20195.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpinUp {
    value: f64,
    breaks: [f64; 1],
}

impl SpinUp {
    /// Up to `value` Ω in the time `time` T \[s\].
    ///
    /// # Errors
    /// [`ProfileError::Quantity`] if Ω is not finite or T is not positive.
    pub fn new(value: f64, time: f64) -> Result<SpinUp, ProfileError> {
        finite("value at the end of the spin-up", value)?;
        positive("time of the spin-up [s]", time)?;
        Ok(SpinUp { value, breaks: [time] })
    }
}

impl Profile for SpinUp {
    fn value(&self, t: f64) -> f64 {
        let s = (t / self.breaks[0]).clamp(0.0, 1.0);
        if s >= 1.0 { self.value } else { self.value * (s - libm::sin(TAU * s) / TAU) }
    }

    fn rate(&self, t: f64) -> f64 {
        let time = self.breaks[0];
        let s = (t / time).clamp(0.0, 1.0);
        if s >= 1.0 { 0.0 } else { self.value / time * 2.0 * libm::sin(PI * s).powi(2) }
    }

    fn acceleration(&self, t: f64) -> f64 {
        let time = self.breaks[0];
        let s = (t / time).clamp(0.0, 1.0);
        if s >= 1.0 { 0.0 } else { self.value / (time * time) * TAU * libm::sin(TAU * s) }
    }

    fn integral(&self, t: f64) -> f64 {
        let time = self.breaks[0];
        let s = (t / time).clamp(0.0, 1.0);
        let wave = libm::sin(PI * s) / PI;
        self.value * time * 0.5 * (s * s - wave * wave) + self.value * (t - time).max(0.0)
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn parts(&self) -> usize {
        PARTS
    }
}

#[cfg(test)]
mod tests {
    use super::super::checks;
    use super::*;

    #[test]
    fn derivatives_and_integrals_belong_to_the_values() {
        checks::derivatives_and_integral(&Constant::new(-2.5).unwrap(), 3.0);
        checks::derivatives_and_integral(&Ramp::new(1.0, -4.0, 2.0).unwrap(), 3.0);
        checks::derivatives_and_integral(&SpinUp::new(4.0, 15.0).unwrap(), 20.0);
    }

    #[test]
    fn spin_up_is_the_published_formula_and_turns_by_half_of_omega_t() {
        let (omega, time) = (4.0, 15.0);
        let spin = SpinUp::new(omega, time).unwrap();
        for t in [0.0, 1.0, 7.5, 14.9] {
            let formula = omega / time * t - omega / TAU * (TAU * t / time).sin();
            assert!((spin.value(t) - formula).abs() < 1e-14);
        }
        assert_eq!((spin.value(15.0), spin.value(99.0), spin.rate(15.0)), (omega, omega, 0.0));
        assert!((spin.integral(time) - omega * time / 2.0).abs() < 1e-13);
        assert!((spin.integral(20.0) - 50.0).abs() < 1e-13);
    }

    #[test]
    fn numbers_that_make_no_profile_are_refused() {
        assert!(Constant::new(f64::NAN).is_err());
        assert!(Ramp::new(0.0, 1.0, 0.0).is_err());
        assert!(SpinUp::new(f64::INFINITY, 1.0).is_err());
        assert!(SpinUp::new(1.0, -1.0).is_err());
    }
}

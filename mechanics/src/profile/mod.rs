//! Functions of time: speeds, angles and loads, with their derivatives and integral.

mod expression;
mod interval;
mod jet;
mod motion;
mod number;
mod panels;
mod pieces;
mod program;
mod simple;
mod table;

pub use expression::Expression;
pub use motion::{HubKinematics, Motion};
pub use pieces::Pieces;
pub use simple::{Constant, Ramp, SpinUp};
pub use table::{End, Table};

/// A function f of time t \[s\], smooth between its [`breaks`](Profile::breaks).
pub trait Profile: Send + Sync + std::fmt::Debug {
    /// f(t).
    fn value(&self, t: f64) -> f64;

    /// f′(t) [per s].
    fn rate(&self, t: f64) -> f64;

    /// f″(t) [per s²].
    fn acceleration(&self, t: f64) -> f64;

    /// ∫₀ᵗ f dt [times s].
    fn integral(&self, t: f64) -> f64;

    /// Times at which f, f′ or f″ jumps or kinks, ascending \[s\].
    fn breaks(&self) -> &[f64] {
        &[]
    }

    /// Times besides the breaks at which steps should end, ascending \[s\]: between two neighbours of them and of the
    /// breaks three points see f. A function without short features needs none.
    fn resolution(&self) -> &[f64] {
        &[]
    }

    /// Equal parts of a run at whose ends f is looked at for its largest value, and for numbers that are not finite.
    fn parts(&self) -> usize {
        4096
    }

    /// First and last time at which f is given \[s\]: a run lies between them.
    fn range(&self) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }
}

/// Differences of the values of a profile, over the largest, that are rounding.
const SAME: f64 = 1e-12;
/// Equal intervals whose ends are looked at for a change.
const LOOKS: u32 = 64;

/// Whether a profile has other values than f(0) up to the time `until` \[s\]: at the ends of 64 equal intervals, at the breaks, and where the
/// resolution sees it.
pub fn changes(profile: &dyn Profile, until: f64) -> bool {
    let until = until.min(profile.range().1);
    let start = profile.value(0.0);
    let differs = |t: f64| {
        let value = profile.value(t);
        (value - start).abs() > SAME * f64::max(value.abs(), start.abs())
    };
    let within = |t: &&f64| (0.0..=until).contains(*t);
    let marked = profile.breaks().iter().chain(profile.resolution()).filter(within).copied();
    (1..=LOOKS).map(|k| until * f64::from(k) / f64::from(LOOKS)).chain(marked).any(differs)
}

/// Equal parts of a beam at whose ends a distribution over all of it is drawn.
const PARTS: f64 = 16.0;

/// Stations from `from` to `to` of a beam of this length at which a distribution is drawn \[m\]: ends of equal parts, and the place of the largest |f|
/// where it is larger than at these.
pub fn drawn(profile: Option<&dyn Profile>, [from, to]: [f64; 2], length: f64) -> Vec<f64> {
    let parts = (PARTS * (to - from) / length).ceil().clamp(2.0, PARTS) as u32;
    let equal = |count: u32| (0..=count).map(move |k| from + (to - from) * f64::from(k) / f64::from(count));
    let mut all: Vec<f64> = equal(parts).collect();
    let Some(profile) = profile else { return all };
    let size = |x: &f64| profile.value(*x).abs();
    let within = |x: &&f64| (from..=to).contains(*x);
    let marked = profile.breaks().iter().chain(profile.resolution()).filter(within).copied();
    let looks = equal(parts * LOOKS).chain(marked);
    let larger = |a: f64, b: f64| if size(&b) > size(&a) { b } else { a };
    // Of those that are as large the first, which are the equal ones.
    let most = all.iter().copied().chain(looks).fold(from, larger);
    if !all.contains(&most) {
        all.push(most);
        all.sort_by(f64::total_cmp);
    }
    all
}

/// The lowest derivative of a profile that jumps at time `t` \[s\]: 0 for f itself, 1 for f′, 2 for f″, 3 if none of them
/// does. Limits are compared to rounding: to 10⁻⁹ of what is found near t.
pub fn jumping_derivative(profile: &dyn Profile, t: f64) -> usize {
    let (first, last) = profile.range();
    let derivative = |k: usize, t: f64| match k {
        0 => profile.value(t),
        1 => profile.rate(t),
        _ => profile.acceleration(t),
    };
    (0..3)
        .find(|&k| {
            let jump = (derivative(k, t) - derivative(k, t.next_down())).abs();
            let near = [1e-6, 1e-3, 0.1]
                .into_iter()
                .flat_map(|d| [t - d * (1.0 + t.abs()), t + d * (1.0 + t.abs())]);
            let scale = near.map(|t| derivative(k, t.clamp(first, last)).abs()).fold(0.0, f64::max);
            !(jump <= 1e-9 * scale)
        })
        .unwrap_or(3)
}

/// A profile that cannot be built, or does not cover a run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// A quantity is out of its range.
    #[error("the {quantity} is {value} and must be {needed}")]
    Quantity {
        /// Quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        needed: &'static str,
    },
    /// The rows make no table.
    #[error("row {row} of the table, {time} with the value {value}, {fault}")]
    Row {
        /// Row, from 1.
        row: usize,
        /// Its time \[s\].
        time: f64,
        /// Its value.
        value: f64,
        /// What is wrong with it.
        fault: &'static str,
    },
    /// The table is too short.
    #[error("the table has {rows} rows and needs at least {least}")]
    TooFewRows {
        /// Number of rows.
        rows: usize,
        /// How many it needs.
        least: usize,
    },
    /// The text is not an expression. The byte offset says where.
    #[error("in the expression `{text}`, column {}: {fault}", .offset + 1)]
    Expression {
        /// The whole text.
        text: String,
        /// Byte offset of the fault.
        offset: usize,
        /// What is wrong.
        fault: String,
    },
    /// The expression is not a finite number somewhere.
    #[error("the expression `{text}` is {value} at {variable} = {at}; it must be finite from 0 to {extent}")]
    NotFinite {
        /// The whole text.
        text: String,
        /// Its variable.
        variable: String,
        /// Its value.
        value: f64,
        /// Where.
        at: f64,
        /// Largest value of the variable.
        extent: f64,
    },
    /// The expression grows beyond all bounds.
    #[error(
        "the expression `{text}` grows beyond all bounds near {variable} = {at:.9}, and so does its integral; it must be \
         finite from 0 to {extent}"
    )]
    Pole {
        /// The whole text.
        text: String,
        /// Its variable.
        variable: String,
        /// Where.
        at: f64,
        /// Largest value of the variable.
        extent: f64,
    },
    /// The expression rises and falls in a time that is too short to be seen.
    #[error(
        "the expression `{text}` changes within less than {within:.1e} near {variable} = {at:.9}, which is too short to be \
         followed from {variable} = 0 to {extent}: let it change in a longer time, or shorten the range"
    )]
    TooShort {
        /// The whole text.
        text: String,
        /// Its variable.
        variable: String,
        /// Where.
        at: f64,
        /// What is too short.
        within: f64,
        /// Largest value of the variable.
        extent: f64,
    },
    /// The expression has too many waves or branches.
    #[error(
        "the expression `{text}` varies too fast to be followed from {variable} = 0 to {extent}: more than 131072 pieces \
         are needed; shorten the range, or leave out what is that fast"
    )]
    TooFast {
        /// The whole text.
        text: String,
        /// Its variable.
        variable: String,
        /// Largest value of the variable.
        extent: f64,
    },
    /// A prescribed motion is not a finite number at some time.
    #[error("the {quantity} is {value} at t = {time} s and must be finite all through the run")]
    Motion {
        /// Quantity.
        quantity: &'static str,
        /// Its value.
        value: f64,
        /// Time \[s\].
        time: f64,
    },
    /// A prescribed angle jumps.
    #[error(
        "the angle of the hub jumps by {size} rad at t = {time} s, which no motion does: prescribe the speed, or a continuous angle"
    )]
    AngleJumps {
        /// Time \[s\].
        time: f64,
        /// Size of the jump \[rad\].
        size: f64,
    },
    /// The run leaves the times at which the profile is given.
    #[error("the profile is given from {first} s to {last} s and the run needs it from 0 s to {duration} s")]
    OutOfRange {
        /// First time \[s\].
        first: f64,
        /// Last time \[s\].
        last: f64,
        /// Duration of the run \[s\].
        duration: f64,
    },
}

/// Whether a profile covers a run from 0 to `duration` \[s\].
///
/// # Errors
/// [`ProfileError::OutOfRange`] if it does not.
pub fn covers(profile: &dyn Profile, duration: f64) -> Result<(), ProfileError> {
    let (first, last) = profile.range();
    if first <= 0.0 && duration <= last {
        return Ok(());
    }
    Err(ProfileError::OutOfRange { first, last, duration })
}

/// Abscissae and values of at least `least` rows, which ascend strictly and are finite.
fn checked_rows(rows: &[(f64, f64)], least: usize) -> Result<(Vec<f64>, Vec<f64>), ProfileError> {
    if rows.len() < least {
        return Err(ProfileError::TooFewRows { rows: rows.len(), least });
    }
    for (i, &(time, value)) in rows.iter().enumerate() {
        let fault = if !time.is_finite() || !value.is_finite() {
            "is not finite"
        } else if i > 0 && time <= rows[i - 1].0 {
            "must lie behind the row before it"
        } else {
            continue;
        };
        return Err(ProfileError::Row { row: i + 1, time, value, fault });
    }
    Ok(rows.iter().copied().unzip())
}

fn finite(quantity: &'static str, value: f64) -> Result<(), ProfileError> {
    if value.is_finite() {
        return Ok(());
    }
    Err(ProfileError::Quantity { quantity, value, needed: "finite" })
}

fn positive(quantity: &'static str, value: f64) -> Result<(), ProfileError> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(ProfileError::Quantity { quantity, value, needed: "positive and finite" })
}

#[cfg(test)]
mod checks {
    use super::{Expression, Profile, drawn};
    use crate::quadrature::Gauss;

    /// A bump narrower than the parts, which no end of them sees.
    #[test]
    fn the_largest_value_of_a_distribution_is_drawn() {
        assert_eq!(drawn(None, [1.0, 2.0], 8.0), [1.0, 1.5, 2.0]);
        let bump = Expression::new("exp(-((x - 0.71)/0.004)^2)", "x", 2.0).unwrap();
        let stations = drawn(Some(&bump), [0.0, 2.0], 2.0);
        assert_eq!(stations.len(), 18);
        let most = stations.iter().map(|s| bump.value(*s)).fold(0.0, f64::max);
        assert!(most > 0.9, "{most}");
    }

    #[test]
    fn profiles_take_the_right_limit_at_their_breaks() {
        let ramp = super::Ramp::new(0.0, 4.0, 15.0).unwrap();
        assert_eq!([0.0, 15.0].map(|t| super::jumping_derivative(&ramp, t)), [1, 1]);
        assert_eq!(ramp.rate(15.0), 0.0);
        let spin_up = super::SpinUp::new(4.0, 15.0).unwrap();
        assert_eq!(super::jumping_derivative(&spin_up, 15.0), 3);
    }

    /// Derivatives against differences, and the integral against quadrature between breaks.
    pub fn derivatives_and_integral(profile: &dyn Profile, duration: f64) {
        let h = duration * 1e-4;
        let mut stations = vec![0.0];
        stations.extend(profile.breaks().iter().copied().filter(|&t| t > 0.0 && t < duration));
        stations.push(duration);
        let mut sum = 0.0;
        for part in stations.windows(2) {
            for k in 0..200 {
                let (a, width) = (part[0], (part[1] - part[0]) / 200.0);
                let t = a + k as f64 * width;
                sum += Gauss::new(16).integrate(t, t + width, |t| profile.value(t));
                let end = t + width;
                let scale = 1.0 + profile.value(end).abs() * duration;
                assert!((profile.integral(end) - sum).abs() < 1e-11 * scale, "integral to {end}");
                let t = t + 0.37 * width;
                if t - part[0] < 3.0 * h || part[1] - t < 3.0 * h {
                    continue;
                }
                let slope = |f: &dyn Fn(f64) -> f64| {
                    (f(t - 2.0 * h) - 8.0 * f(t - h) + 8.0 * f(t + h) - f(t + 2.0 * h)) / (12.0 * h)
                };
                let (rate, acceleration) = (slope(&|t| profile.value(t)), slope(&|t| profile.rate(t)));
                let near = |a: f64, b: f64| (a - b).abs() < 1e-7 * (1.0 + b.abs());
                assert!(near(profile.rate(t), rate), "rate at {t}: {} for {rate}", profile.rate(t));
                let found = profile.acceleration(t);
                assert!(near(found, acceleration), "acceleration at {t}: {found} for {acceleration}");
            }
        }
    }
}

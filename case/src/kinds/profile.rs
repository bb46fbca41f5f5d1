//! Profiles of a case: tables in files and formulas, for whatever changes with time or along the beam.

use crate::fault::{At, Fault, Made};
use crate::files;
use crate::keys::{Field, File, choice};
use crate::kind::{Choice, Context, Is, Kind};
use crate::units::{Measure, TIME};
use flexion::profile::{End, Expression, Motion, Pieces, Profile, ProfileError, Table, covers};
use std::sync::Arc;

/// Whatever changes with one variable.
pub(super) type Shared = Arc<dyn Profile>;

/// The quantity of a motion that a table or a formula gives.
#[derive(Clone, Copy)]
pub struct Given {
    /// Makes the motion of its profile.
    pub motion: fn(Shared) -> Motion,
    /// What it measures.
    pub measure: &'static Measure,
}

/// The motion with a speed in time.
pub(super) fn speed(profile: Shared) -> Motion {
    Motion::Speed { profile, initial_angle: 0.0 }
}

/// The motion that a table in a file gives.
pub(super) fn tabled(file: &File, of: Given, curve: Through, c: &Context<'_>) -> Made<Motion> {
    validated((of.motion)(table(file, of.measure, curve, c)?), c, "file")
}

/// The motion that a formula in time gives.
pub(super) fn formulated(text: &str, of: Given, c: &Context<'_>) -> Made<Motion> {
    validated((of.motion)(of_time(text, c)?), c, "formula")
}

/// A motion that is validated over the run, with what is wrong with it at `key`.
pub(super) fn validated(motion: Motion, c: &Context<'_>, key: &str) -> Made<Motion> {
    checked(motion.validate(c.duration()?), key)?;
    Ok(motion)
}

/// The value, or what is wrong with the profile at `key`: in a formula at the character that is to blame.
pub(super) fn checked<T>(result: Result<T, ProfileError>, key: &str) -> Made<T> {
    result.map_err(|error| {
        let fault = Fault::new(key, error.to_string());
        match error {
            ProfileError::Expression { text, offset, fault: message } => {
                Fault { message, span: Some(offset..text.len().min(offset + 1)), ..fault }
            }
            ProfileError::OutOfRange { .. } => {
                fault.help("shorten the run, or extend the table over all of it")
            }
            _ => fault,
        }
        .into()
    })
}

/// A curve through rows, and a caution.
pub(super) type Through = fn(&[(f64, f64)]) -> Result<(Shared, Option<String>), ProfileError>;

/// Part of the range of its rows by which a spline may leave it without a word.
const OVERSHOOT: f64 = 0.05;

fn linear(rows: &[(f64, f64)]) -> Result<(Shared, Option<String>), ProfileError> {
    Ok((Arc::new(Pieces::linear(rows)?), None))
}

fn monotone(rows: &[(f64, f64)]) -> Result<(Shared, Option<String>), ProfileError> {
    Ok((Arc::new(Pieces::monotone(rows)?), None))
}

fn spline(rows: &[(f64, f64)]) -> Result<(Shared, Option<String>), ProfileError> {
    let table = Table::new(rows, End::default())?;
    let (overshoot, time) = table.overshoot();
    let caution = (overshoot > OVERSHOOT).then(|| {
        format!(
            "the spline through a table leaves the values of its rows by {:.0} % of their range at t = {time:.4} s; \
             `interpolation = \"monotone\"` does not",
            100.0 * overshoot
        )
    });
    Ok((Arc::new(table), caution))
}

/// The kinds of curve through the rows of a table in time.
pub static THROUGH: Choice<Through> = Choice {
    name: "curve through a table",
    path: "hub.motion.interpolation",
    summary: "values between the rows of a table of times",
    kinds: &[
        Kind {
            name: "linear",
            summary: "straight lines",
            source: "",
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1], factors=[0, 1], interpolation='linear'}}]",
            make: &Is(linear as Through),
        },
        Kind {
            name: "monotone",
            summary: "monotone cubics, with continuous slopes, which never leave the values of neighbouring rows",
            source: "Fritsch & Butland 1984, doi:10.1137/0905021",
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1], factors=[0, 1], interpolation='monotone'}}]",
            make: &Is(monotone as Through),
        },
        Kind {
            name: "spline",
            summary: "a cubic spline, with continuous curvatures, for smooth and dense rows: it overshoots where rows change abruptly",
            source: "de Boor 2001, chapter IV",
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1, 2], factors=[0, 1, 4], interpolation='spline'}}]",
            make: &Is(spline as Through),
        },
    ],
};

const fn between(default: &'static str) -> Field<Through> {
    choice(&THROUGH).or_name(default).called("interpolation", "values between the rows")
}

/// The key of the curve through a table of a motion, which must be smooth, and of a load, which is what its rows and straight lines between
/// them say.
pub(super) const INTERPOLATION: Field<Through> = between("monotone");
pub(super) const OF_LOADS: Field<Through> = between("linear");

/// The curve through rows of times [s] and values that are at `key`.
pub(super) fn through(rows: &[(f64, f64)], curve: Through, c: &Context<'_>, key: &str) -> Made<Shared> {
    let (profile, caution) = checked(curve(rows), key)?;
    c.cautions.borrow_mut().extend(caution);
    Ok(profile)
}

/// The curve through the rows of the file at `file`: times and values of a measure, in SI or with the units of their titles.
pub(super) fn table(file: &File, measure: &'static Measure, curve: Through, c: &Context<'_>) -> Made<Shared> {
    let what = "two numbers with a comma between: a time and a value";
    let columns = [(&["t", "time"][..], &TIME), (&[][..], measure)];
    let rows = files::rows::read(&file.bytes, &file.name, what, columns).at("file")?;
    through(&rows.into_iter().map(<(f64, f64)>::from).collect::<Vec<_>>(), curve, c, "file")
}

/// The formula at `formula` in time t [s].
pub(super) fn of_time(text: &str, c: &Context<'_>) -> Made<Shared> {
    let duration = c.duration()?;
    // Of a run without duration, its start and what follows at once.
    formula(text, "t", if duration > 0.0 { duration } else { 1e-3 })
}

/// The formula at `formula` in a variable, which goes from 0 to `extent`.
pub(super) fn formula(text: &str, variable: &str, extent: f64) -> Made<Shared> {
    Ok(Arc::new(checked(Expression::new(text, variable, extent), "formula")?))
}

/// The profile, if it covers the run.
pub(super) fn covering(profile: Shared, c: &Context<'_>, key: &str) -> Made<Shared> {
    checked(covers(profile.as_ref(), c.duration()?), key)?;
    Ok(profile)
}

/// Rows of a place or time, and a factor.
pub(super) fn factors(places: &[f64], factors: &[f64]) -> Made<Vec<(f64, f64)>> {
    if places.len() != factors.len() {
        let message = format!("there are {} factors for {} rows", factors.len(), places.len());
        return Err(Fault::new("factors", message).into());
    }
    Ok(places.iter().copied().zip(factors.iter().copied()).collect())
}

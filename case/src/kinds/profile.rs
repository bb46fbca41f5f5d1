//! Profiles of a case: tables in files and formulas, for whatever changes with time or along the beam.

use crate::declaration::{Key, Presence as Default, Type, key};
use crate::fault::{At, Fault, Made};
use crate::files;
use crate::kind::{Choice, Context, Kind};
use crate::values::Values;
use flexion::profile::{End, Expression, Pieces, Profile, ProfileError, Table, covers};
use std::sync::Arc;

/// Whatever changes with one variable.
pub(super) type Shared = Arc<dyn Profile>;

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
type Through = fn(&[(f64, f64)]) -> Result<(Shared, Option<String>), ProfileError>;

/// Part of the range of its rows by which a spline may leave it without a word.
const OVERSHOOT: f64 = 0.05;

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
            keys: &[],
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1], factors=[0, 1], interpolation='linear'}}]",
            make: |_, _| Ok(|rows| Ok((Arc::new(Pieces::linear(rows)?), None))),
        },
        Kind {
            name: "monotone",
            summary: "monotone cubics, with continuous slopes, which never leave the values of neighbouring rows",
            source: "Fritsch & Butland 1984, doi:10.1137/0905021",
            keys: &[],
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1], factors=[0, 1], interpolation='monotone'}}]",
            make: |_, _| Ok(|rows| Ok((Arc::new(Pieces::monotone(rows)?), None))),
        },
        Kind {
            name: "spline",
            summary: "a cubic spline, with continuous curvatures, for smooth and dense rows: it overshoots where rows change abruptly",
            source: "de Boor 2001, chapter IV",
            keys: &[],
            example: "load=[{on='2 m', force=[0, 3], amplitude={kind='table', times=[0, 1, 2], factors=[0, 1, 4], interpolation='spline'}}]",
            make: |_, _| Ok(spline),
        },
    ],
};

const fn between(default: &'static str) -> Key {
    key("interpolation", Type::Choice(&THROUGH), Default::Name(default), "values between the rows")
}

/// The key of the curve through a table of a motion, which must be smooth, and of a load, which is what its rows and straight lines between
/// them say.
pub(super) const INTERPOLATION: Key = between("monotone");
pub(super) const OF_LOADS: Key = between("linear");

/// The curve through rows of times [s] and values that are at `key`.
pub(super) fn through(rows: &[(f64, f64)], v: &Values, c: &Context<'_>, key: &str) -> Made<Shared> {
    let (profile, caution) = checked(THROUGH.make(v, "interpolation", c)?(rows), key)?;
    c.cautions.borrow_mut().extend(caution);
    Ok(profile)
}

/// The curve through the rows of the file at `file`: times [s] and values.
pub(super) fn table(v: &Values, c: &Context<'_>) -> Made<Shared> {
    let (name, bytes) = c.file(v, "file")?;
    let what = "two numbers with a comma between: a time in s and a value";
    let rows = files::rows::read(&bytes, name, what).at("file")?;
    through(&rows.into_iter().map(<(f64, f64)>::from).collect::<Vec<_>>(), v, c, "file")
}

/// The formula at `formula` in time t [s].
pub(super) fn of_time(v: &Values, c: &Context<'_>) -> Made<Shared> {
    let duration = c.duration()?;
    // Of a run without duration, its start and what follows at once.
    formula(v, "t", if duration > 0.0 { duration } else { 1e-3 })
}

/// The formula at `formula` in a variable, which goes from 0 to `extent`.
pub(super) fn formula(v: &Values, variable: &str, extent: f64) -> Made<Shared> {
    Ok(Arc::new(checked(Expression::new(v.text("formula")?, variable, extent), "formula")?))
}

/// The profile, if it covers the run.
pub(super) fn covering(profile: Shared, c: &Context<'_>, key: &str) -> Made<Shared> {
    checked(covers(profile.as_ref(), c.duration()?), key)?;
    Ok(profile)
}

/// Rows of a place or time, and a factor.
pub(super) fn factors(v: &Values, places: &str) -> Made<Vec<(f64, f64)>> {
    let (places, factors) = (v.numbers(places)?, v.numbers("factors")?);
    if places.len() != factors.len() {
        let message = format!("there are {} factors for {} rows", factors.len(), places.len());
        return Err(Fault::new("factors", message).into());
    }
    Ok(places.iter().copied().zip(factors.iter().copied()).collect())
}

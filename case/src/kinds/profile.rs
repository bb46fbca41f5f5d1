//! Profiles of a case: tables in files and formulas, for whatever changes with time or along the beam.

use crate::fault::{At, Fault, Made};
use crate::files;
use crate::kind::Context;
use crate::values::Values;
use flexion::profile::{End, Expression, Profile, ProfileError, Table, covers};
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

/// The spline through the rows of the file at `file`: times [s] and values.
pub(super) fn table(v: &Values, c: &Context<'_>) -> Made<Shared> {
    let (name, bytes) = c.file(v, "file")?;
    let rows = files::rows::read(&bytes, name).at("file")?;
    Ok(Arc::new(checked(Table::new(&rows, End::default()), "file")?))
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

//! The stations of beams that a case records.

use super::fault::{Fault, Faults, Made};
use super::kind::Context;
use super::places::Place;

/// The stations of these names, which are recorded besides the tips of beams: number of the beam and arc length \[m\].
pub(super) fn stations(names: &[String], c: &Context<'_>) -> Made<Vec<(usize, f64)>> {
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let parts = c.parts()?;
    let station = |name: &String| match parts.find(name) {
        Ok(Place::Station { beam, s }) => Ok((beam, s)),
        Ok(_) => {
            let fault = Fault::new("stations", format!("`{name}` is no station of a beam"));
            Err(fault.help("write for example `stations = [\"2 m\"]`").into())
        }
        Err(fault) => Err(Faults::from(fault).within("stations")),
    };
    names.iter().map(station).collect()
}

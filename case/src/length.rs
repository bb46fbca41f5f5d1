//! The length of a beam on a hub.

use super::fault::{Faults, Made};
use super::kind::Context;
use super::layout::{BEAM, OneBeam, SECTION};
use super::reader;
use super::values::Values;
use std::cell::RefCell;

/// The length of the beam \[m\]: as it is written, or as its deck has it.
///
/// # Errors
/// Where neither says it; none of a deck that cannot be read, which is reported where the section is made.
pub(super) fn length(v: &Values, c: &Context<'_>) -> Made<f64> {
    if let Some(length) = BEAM.read(v, c)?.length {
        return Ok(length);
    }
    let of_deck = if SECTION.chosen_in(v) == Some("deck") {
        let cautions = RefCell::default();
        SECTION.read(v, &Context { cautions: &cautions, ..*c }).map_err(|_| Faults::default())?.length
    } else {
        None
    };
    of_deck.ok_or_else(|| reader::left_out(&OneBeam::length.key, "beam.length").into())
}

//! Vibrations of a case, at rest or in steady rotation: modes at one speed, and their diagram over speeds.

mod comparison;
mod diagram;
mod linear;
mod modes;
mod place_stiffness;
mod speeds;
mod threads;

pub use diagram::{Diagram, DiagramRequest};
pub use linear::{Linear, LinearRequest};
pub use modes::{FoundModes, ModesRequest};
pub use place_stiffness::PlaceStiffness;
pub use speeds::{Speed, Speeds, Wanted};
pub use threads::campbell;

use super::case::{Case, suspected};
use super::problem::Problems;
use super::reading::Reading;
use flexion::analysis::campbell::{HubState, NoCampbell};
use flexion::hub_beam::Drive;
use flexion::system::{Fork, Slender};
use flexion_results::Frequencies;

/// Relative error of a frequency by the mesh above which there is a warning.
const COARSE: f64 = 0.01;

/// Relative error of a frequency by rounding above which there is a warning.
const ROUNDED: f64 = 1e-6;

/// Why a case has no modes.
#[derive(Debug, thiserror::Error)]
pub enum VibrationError {
    /// The case is to blame, at its lines.
    #[error(transparent)]
    Case(#[from] Problems),
    /// The speeds, or what was asked of the hub.
    #[error("{0}")]
    Request(String),
    /// No equilibrium or no modes were found.
    #[error("{0}")]
    NotFound(String),
}

impl VibrationError {
    fn not_found(error: impl std::fmt::Display) -> VibrationError {
        VibrationError::NotFound(error.to_string())
    }

    /// With the cautions of the case, which may name the cause.
    fn suspecting(self, case: &Case) -> VibrationError {
        match (self, suspected(&case.cautions)) {
            (VibrationError::NotFound(message), Some(caution)) => {
                VibrationError::NotFound(format!("{message}\n{caution}"))
            }
            (error, _) => error,
        }
    }
}

impl From<NoCampbell> for VibrationError {
    fn from(error: NoCampbell) -> VibrationError {
        VibrationError::not_found(error)
    }
}

impl Case {
    /// The hub, in space the joint that is the axis, as it is `free` to rotate with the beam under its torques or keeps its speed.
    ///
    /// # Errors
    /// A case whose hub cannot be free.
    pub fn hub_state(&self, free: bool) -> Result<HubState, VibrationError> {
        if !free {
            return Ok(HubState::Held);
        }
        let Some(beam) = self.hub_beam() else {
            let rotation = self.space().and_then(|space| space.rotation.as_ref().ok());
            return match rotation.and_then(|rotation| rotation.keeps.as_ref()) {
                Some(_) => Ok(HubState::Free),
                None => Err(VibrationError::Request(
                    "--free-hub needs a revolute or cylindrical joint with the ground about the axis of rotation: the case has none \
                     that could be free"
                        .to_owned(),
                )),
            };
        };
        match beam.hub.drive {
            Drive::Free(_) => Ok(HubState::Free),
            Drive::Prescribed(_) => Err(VibrationError::Request(
                "--free-hub needs a case whose hub is free: its hub.motion is prescribed".to_owned(),
            )),
        }
    }

    /// The unit √(EI/ρAL⁴) of frequencies, by the section at the root of the one beam, EI that of bending along its height.
    ///
    /// # Errors
    /// A system of several beams, or of none, and a deck.
    pub fn dimensionless(&self) -> Result<Frequencies, VibrationError> {
        let of_hub = self.hub_beam().map(|beam| (beam.length, &beam.section));
        let of_space = self.space().and_then(|space| match &space.beams[..] {
            [(beam, _)] if beam.section.deck.is_none() => Some((beam.length, &beam.section)),
            _ => None,
        });
        let resultants =
            of_hub.or(of_space).map(|(length, section)| (length, section.planar.resultants(0.0)));
        let (length, r) = resultants.ok_or_else(|| {
            let message = "--dimensionless is for one beam whose section is no deck: a system of several has no one section";
            VibrationError::Request(message.to_owned())
        })?;
        Ok(Frequencies::dimensionless((r.mass * length.powi(4) / r.bending_stiffness).sqrt()))
    }

    /// What vibrates, and a warning that names the loads that are left out: in the frame of a rotating hub those fixed in space are
    /// periodic, and there is no steady state to linearize about. Their mean over a revolution is zero: the modes are those about
    /// this mean.
    fn vibrates(&self, rotates: bool) -> Result<(Box<dyn Fork>, Vec<String>), VibrationError> {
        let (system, left_out) = self.vibrating(rotates).map_err(VibrationError::not_found)?;
        let across = if self.space().is_some() { "the part across the axis of " } else { "" };
        let caution = format!(
            "without {across}{}: seen from a hub that rotates it changes with every revolution, a state that is not steady has no modes, \
             and its mean over a revolution is zero",
            left_out.join(" and ")
        );
        let mut cautions = if left_out.is_empty() { Vec::new() } else { vec![caution] };
        cautions.extend(self.has_contacts().then(|| WITHOUT_CONTACTS.to_owned()));
        cautions.extend(self.unused_by_modes());
        Ok((system, cautions))
    }

    /// The error of a frequency by the mesh over its difference to that of twice the elements or functions.
    fn safety_of_frequencies(&self) -> f64 {
        self.hub_beam().map_or(2.0, |beam| beam.bases.safety)
    }

    /// Stations of the shapes: the ends of so many equal parts of the beam on a hub, or of the first beam in space \[m\].
    fn stations_of_shapes(&self, parts: u32) -> Vec<f64> {
        let equal = |length: f64| (0..=parts).map(|i| length * f64::from(i) / f64::from(parts)).collect();
        let of_space = self.space().and_then(|space| space.beams.first());
        let length = self.hub_beam().map(|beam| beam.length).or(of_space.map(|(beam, _)| beam.length));
        length.map_or_else(Vec::new, equal)
    }
}

const WITHOUT_CONTACTS: &str = "without contacts: a contact that opens and closes has no small vibrations, and the modes are those of the free beam";

impl Reading {
    /// The title of the case, where it has one.
    pub fn title(&self) -> Option<&str> {
        Some(self.case.title.as_str()).filter(|title| !title.is_empty())
    }
}

/// A warning that frequencies may be off by rounding, of the numbers of modes and their errors, with the beam that is to blame.
fn rounded(modes: impl Iterator<Item = (usize, f64)>, slender: Option<&Slender>) -> Option<String> {
    let (mut numbers, mut largest): (Vec<usize>, f64) = (Vec::new(), 0.0);
    for (number, error) in modes.filter(|(_, error)| *error > ROUNDED) {
        largest = largest.max(error);
        if numbers.last() != Some(&number) {
            numbers.push(number);
        }
    }
    let (first, last) = (numbers.first()?, numbers.last()?);
    let which = match numbers.len() {
        1 => format!("the frequency of mode {first}"),
        n if last - first + 1 == n => format!("the frequencies of modes {first} to {last}"),
        _ => {
            let numbers: Vec<String> = numbers.iter().map(usize::to_string).collect();
            format!("the frequencies of modes {}", numbers.join(", "))
        }
    };
    let why = slender.map_or_else(
        || "the mesh is too fine for this coupling; use fewer elements".to_owned(),
        Slender::to_string,
    );
    Some(format!("{which} may be off by {largest:.1e} of it by rounding: {why}"))
}

/// What a mode moves, in words: its shares above one in a hundred, the largest first, `flap 98 %, chord 2 %`.
pub fn moves(shares: &[(&str, f64)]) -> String {
    let mut shares: Vec<(&str, f64)> = shares.iter().copied().filter(|s| s.1.abs() > 0.01).collect();
    shares.sort_by(|a, b| b.1.total_cmp(&a.1));
    let words: Vec<String> =
        shares.iter().map(|(name, share)| format!("{name} {:.0} %", 100.0 * share)).collect();
    words.join(", ")
}

/// A warning that errors by the mesh are missing, and why.
fn unestimated(why: &str) -> String {
    format!(
        "the errors of the frequencies by the mesh are unknown, for modes of a mesh of twice the elements or functions were not found: {why}"
    )
}

/// A warning of the mesh, of a mode by its number and its relative error.
fn coarse(mode: usize, at: Option<String>, error: f64) -> String {
    let at = at.map_or_else(String::new, |speed| format!(" at {speed}"));
    format!(
        "by the mesh the frequency of mode {mode}{at} may be off by {:.1} %: use more elements or functions",
        100.0 * error
    )
}

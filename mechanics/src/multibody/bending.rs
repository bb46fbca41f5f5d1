//! Where beams without shear are bent so much that the interpolated axial strain shows it.
//!
//! Inside an element r′ is a parabola. An axial strain ε₂ (z² − z + 1/6) turns it there by κ h ε₂ z (z − ½)(z − 1), which changes the curvature at
//! the two Gauss points by κ ε₂²/36. Per length the energy of this strain is
//!
//! ```text
//! EA ε₂²/360 − κ M ε₂²/36 = (1 − 10 κ M/EA) EA ε₂²/360
//! ```
//!
//! whatever the mesh: it is lost at κ √(EI/EA) = 0.316 in a beam that is straight without stress.

use super::beam::Beam;

/// κ M/EA from which on a caution is due: a tenth of the stiffness of this strain is lost.
const BENT: f64 = 0.01;

/// κ M/EA at which the stiffness is lost.
const LOST: f64 = 0.1;

/// The strongest bending that a run or a path has shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bending {
    /// κ M/EA.
    value: f64,
    beam: usize,
    /// Arc length \[m\].
    place: f64,
}

impl Bending {
    /// Takes the beam of this number at its coordinates.
    pub(super) fn enter(&mut self, number: usize, beam: &Beam, q: &[f64]) {
        let Beam::Slender(of) = beam else { return };
        for element in 0..beam.elements() {
            if let Some((value, z)) = of.bending(q, element, self.value.max(BENT)) {
                let place = beam.end(element) + z * beam.length(element);
                *self = Bending { value, beam: number, place };
            }
        }
    }

    /// What the reader of a run should know; `name` is that of a beam.
    pub(super) fn caution<'a>(&self, name: impl Fn(usize) -> &'a str) -> Option<String> {
        (self.value >= BENT).then(|| {
            format!(
                "beam `{}` is bent to κ·√(EI/EA) = {:.2} at {:.4} m: its axial strains are then inaccurate inside elements, and from {:.2} on it \
                 loses its stability whatever the mesh, which no beam does; from 0.1 on use the coupling `exact` for a motion in the plane, \
                 or `space-shear`; a section this strongly bent has strains that are hardly elastic, so check modulus, section and load",
                name(self.beam),
                self.value.sqrt(),
                self.place,
                LOST.sqrt()
            )
        })
    }
}

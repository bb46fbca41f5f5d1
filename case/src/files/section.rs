//! Files of sections: a CSV table of resultants along the beam, with named columns.

use super::columns::{self, Column, column};
use crate::units::{
    AXIAL_STIFFNESS, BENDING_STIFFNESS, COUPLING_STIFFNESS, FIRST_MASS_MOMENT, LENGTH, MASS_PER_LENGTH,
    ROTARY_INERTIA,
};
use flexion::section::Resultants;

static COLUMNS: [Column; 7] = [
    column("x", &["s", "span", "station"], &LENGTH, true),
    column("mass", &["massperlength", "rhoa"], &MASS_PER_LENGTH, true),
    column("EA", &["axialstiffness"], &AXIAL_STIFFNESS, true),
    column("EI", &["bendingstiffness"], &BENDING_STIFFNESS, true),
    column("ES", &["couplingstiffness"], &COUPLING_STIFFNESS, false),
    column("first-moment", &[], &FIRST_MASS_MOMENT, false),
    column("rotary-inertia", &["rhoi"], &ROTARY_INERTIA, false),
];

/// The rows (x \[m\], resultants) of a file that the case calls `name`.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn read(bytes: &[u8], name: &str) -> Result<Vec<(f64, Resultants)>, String> {
    let rows = columns::read(&String::from_utf8_lossy(bytes), name, &COLUMNS)?;
    let named = |[
        x,
        mass,
        axial_stiffness,
        bending_stiffness,
        coupling_stiffness,
        first_moment,
        rotary_inertia,
    ]: [f64; 7]| {
        let resultants = Resultants {
            mass,
            first_moment,
            rotary_inertia,
            axial_stiffness,
            coupling_stiffness,
            bending_stiffness,
        };
        (x, resultants)
    };
    Ok(rows.into_iter().map(named).collect())
}

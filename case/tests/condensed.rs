//! What a beam without shear leaves out of a section whose shear and bending couple.

#![allow(clippy::unwrap_used, clippy::panic)]

use flexion::analysis::modes::modes;
use flexion_case::{Contents, parse_with};
use std::path::Path;
use std::sync::Arc;

/// The first frequency \[rad/s\] in the plane of the height of a cantilever whose radius of gyration is 10 mm and whose C₂₆ = `part` √(C₂₂ C₆₆).
fn frequency(length: f64, part: f64, shear: bool) -> f64 {
    let (axial, mass) = (2.8e7, 1.08);
    let (along, bends, inertia) = (axial / 7.0, axial * 1e-4, mass * 1e-4);
    let coupling = part * f64::sqrt(along * bends);
    // Stiff across, so that the first mode is along the height.
    let row = |x: f64| {
        format!(
            "{x},{mass},{inertia},{inertia},{axial},{along},{along},{bends},{},{bends},{coupling}\n",
            4.0 * bends
        )
    };
    let table =
        format!("x,mass,inertia-flap,inertia-chord,K11,K22,K33,K44,K55,K66,K26\n{}{}", row(0.0), row(length));
    let files: Contents = [("k.csv".to_owned(), Arc::from(table.into_bytes()))].into_iter().collect();
    let text = format!(
        "run.duration = 0\n[[beam]]\nup = [0, 1, 0]\nroot = 'clamped'\nelements = 20\nshear = {shear}\n\
         section = {{ kind = 'deck', file = 'k.csv', format = 'csv' }}\n"
    );
    let reading =
        parse_with(text, Path::new("case.toml"), &[], &files).unwrap_or_else(|problems| panic!("{problems}"));
    let (mut system, _) = reading.case.vibrating(false).unwrap();
    let state = system.initial();
    modes(system.as_mut(), &state, 1, &[]).unwrap().modes[0].frequency()
}

/// The energy ∫s_QM M M′ ds = ½ s_QM [M²] of a cantilever, M₀² = (4/L)∫M² ds in each of its modes, changes frequencies by 2c/L with c = C₂₆/C₂₂; what is left is of the
/// second order, as that of shear without coupling, (π²/2)·4 EI/(GA L²) at most.
#[test]
fn a_coupling_of_shear_and_bending_counts_in_the_first_order_of_thickness_over_length() {
    for part in [0.5, -0.5] {
        for length in [1.0, 2.0, 4.0] {
            let change = frequency(length, part, true) / frequency(length, part, false) - 1.0;
            let arm = part * f64::sqrt(7.0) * 0.01;
            let second = 20.0 * 7.0 * 1e-4 / (length * length);
            assert!(
                (change - 2.0 * arm / length).abs() < second,
                "{part} {length}: {change:e} {:e}",
                2.0 * arm / length
            );
            assert!(second < 0.6 * change.abs(), "{second:e} {change:e}");
        }
    }
}

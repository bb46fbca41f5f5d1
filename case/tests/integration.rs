//! Cases as a whole, from the file to the results. `verification` and `no_allocation` are programs of their own.

mod advice;
mod behind_events;
mod blade;
mod broken_cases;
mod broken_decks;
mod case_files;
mod condensed;
mod contact;
mod contact_in_space;
mod convergence;
mod crowds;
mod damped_modes;
mod deck_formats;
mod deck_frequencies;
mod deck_slips;
mod decks;
mod disturbance;
mod docs;
mod elastodyn;
mod energy;
mod extremes;
mod first_look;
mod four_bar;
mod frequency_orders;
mod fuzz;
mod jumps;
mod kinds;
mod loads;
mod modal_release;
mod papers;
mod pendulum;
mod pressed;
mod quantities;
mod reported_errors;
mod restart;
mod resting;
mod rotor;
mod scales;
mod section_forces;
mod shafts;
mod short_features;
mod short_in_space;
mod space;
mod space_modes;
mod spring;
mod statics;
mod supports;
mod sweep;
mod twenty_seconds;
mod verification {
    pub mod run;
}
mod vtk_read_back;
mod written;

/// Cargo does not look for tests beside this file.
#[test]
fn no_file_of_tests_is_left_out() {
    let tests = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    for entry in std::fs::read_dir(tests).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        let Some(name) = file.strip_suffix(".rs") else { continue };
        let other = ["integration", "no_allocation"].contains(&name);
        assert!(other || include_str!("integration.rs").contains(&format!("\nmod {name};")), "{file}");
    }
}

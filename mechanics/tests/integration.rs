//! The mechanics as a whole, and the rules that its sources keep.

mod architecture;
mod basis_orders;
mod campbell;
mod command;
mod drag;
mod errors;
mod high_coupling;
mod impact;
mod integrators;
mod kept_tangents;
mod linear_cost;
mod modes;
mod multibody_systems;
mod shear;
mod slender;
mod surroundings;
mod tapered_beam;

/// Cargo does not look for tests beside this file.
#[test]
fn no_file_of_tests_is_left_out() {
    let tests = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    for entry in std::fs::read_dir(tests).unwrap() {
        let file = entry.unwrap().file_name().into_string().unwrap();
        let Some(name) = file.strip_suffix(".rs") else { continue };
        assert!(
            name == "integration" || include_str!("integration.rs").contains(&format!("\nmod {name};")),
            "{file}"
        );
    }
}

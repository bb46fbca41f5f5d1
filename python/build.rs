//! Lets the extension link without Python on macOS, where that takes an option of the linker.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}

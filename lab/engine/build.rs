//! Leaves the names of functions out of the module, a fifth of it, which `strip` of a profile keeps in WebAssembly.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    if std::env::var("CARGO_CFG_TARGET_ARCH").is_ok_and(|arch| arch == "wasm32") {
        println!("cargo:rustc-link-arg-cdylib=--strip-all");
    }
}

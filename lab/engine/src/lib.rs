//! Cases in a browser: a request as JSON, and its reply as JSON.
//!
//! The module of WebAssembly that is made of this crate has a raw interface, which `exports` describes; [`reply`] is behind it, and answers in
//! a program too. What a request may ask is listed at [`Request`].

#[cfg(target_family = "wasm")]
// A `no_mangle` name counts as unsafe code, and memory of a caller is read and written by its address.
#[allow(unsafe_code)]
mod exports;

mod changed;
mod checked;
mod files;
mod keys;
mod memory;
mod ran;
mod request;
mod vibrating;
mod work;

pub use request::Request;
pub use work::Progress;

use serde_json::{Value, json};

/// The reply to a request; `progress` gets JSON while it is computed.
pub fn reply(request: &str, progress: &mut Progress<'_>) -> String {
    let value = match serde_json::from_str::<Value>(request) {
        Ok(value) => answered(value, progress),
        Err(error) => Err(format!("the request is no JSON: {error}")),
    };
    value.unwrap_or_else(|message| json!({ "status": "refused", "message": message })).to_string()
}

fn answered(value: Value, progress: &mut Progress<'_>) -> Result<Value, String> {
    let request = Request::of(value)?;
    memory::allow(request.memory);
    // What computes wants a case that is sound.
    let read = || request.read().map_err(|problems| work::rejected(&problems));
    let given = |found: Result<Value, Value>| Ok(found.unwrap_or_else(|refused| refused));
    match request.what.as_str() {
        "version" => Ok(json!({ "version": flexion_results::VERSION })),
        "keys" => Ok(keys::keys()),
        "check" => Ok(checked::check(&request)),
        "run" => given(read().and_then(|reading| ran::run(&request, &reading, progress))),
        "modes" => given(read().and_then(|reading| {
            vibrating::modes(&request, &reading).map(|found| vibrating::told_modes(&reading, &found))
        })),
        "campbell" => given(read().and_then(|reading| {
            vibrating::campbell(&request, &reading, progress)
                .map(|found| vibrating::told_campbell(&request, &found))
        })),
        "statics" => given(read().and_then(|reading| {
            vibrating::statics(&request, &reading, progress).map(|path| vibrating::told_statics(&path))
        })),
        "change" => Ok(changed::change(&request)),
        "difference" => changed::difference(&request),
        "files" => files::files(&request, progress),
        other => Err(format!("`{other}` is nothing that can be asked")),
    }
}

//! Cases in a browser: a request as JSON, and its reply as JSON.
//!
//! The module of WebAssembly that is made of this crate has a raw interface, which `exports` describes; [`reply`] is behind it, and answers in
//! a program too. What a request may ask is listed at [`Request`].

#[cfg(target_family = "wasm")]
// A `no_mangle` name counts as unsafe code, and memory of a caller is read and written by its address.
#[allow(unsafe_code)]
mod exports;

mod checked;
mod keys;
mod memory;
mod ran;
mod request;
mod work;

pub use request::Request;
pub use work::Progress;

use serde_json::{Value, json};

/// The reply to a request; `progress` gets JSON while it is computed.
pub fn reply(request: &str, progress: &mut dyn FnMut(&str)) -> String {
    let value = match serde_json::from_str::<Value>(request) {
        Ok(value) => answered(value, progress),
        Err(error) => Err(format!("the request is no JSON: {error}")),
    };
    value.unwrap_or_else(|message| json!({ "status": "refused", "message": message })).to_string()
}

fn answered(value: Value, progress: &mut dyn FnMut(&str)) -> Result<Value, String> {
    let request = Request::of(value)?;
    memory::allow(request.memory);
    match request.what.as_str() {
        "version" => Ok(json!({ "version": flexion_results::VERSION })),
        "keys" => Ok(keys::keys()),
        "check" => Ok(checked::check(&request)),
        "run" => ran::run(&request, progress),
        other => Err(format!("`{other}` is nothing that can be asked")),
    }
}

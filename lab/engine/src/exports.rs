//! The functions that the module of WebAssembly exports, and those that it imports from `env`.
//!
//! | function | what it does |
//! |---|---|
//! | `allocate(bytes)` | gives the address of so many bytes, for a request |
//! | `release(address, bytes)` | takes them back |
//! | `call(address, bytes)` | answers the request in JSON, UTF-8, at an address, and returns the address of the reply |
//! | `reply_length()` | bytes of the reply, which is there until the next call |
//! | `env.clock()` | seconds, from any time on |
//! | `env.progress(address, bytes)` | is shown JSON, UTF-8, while a request is answered |
//! | `env.exhausted()` | is called where memory is asked for and there is none, and throws |
//!
//! A panic is a trap, which `env.progress` is told before. What the module holds behind that, or behind `env.exhausted`, is of no use: the next
//! request wants another instance.

use std::alloc::{Layout, alloc, dealloc};
use std::sync::{Mutex, Once, PoisonError};

#[link(wasm_import_module = "env")]
unsafe extern "C" {
    safe fn clock() -> f64;
    safe fn progress(address: *const u8, bytes: usize);
    safe fn exhausted();
}

/// Ends the request for want of memory.
pub(crate) fn end() {
    exhausted();
}

static REPLY: Mutex<String> = Mutex::new(String::new());
static BEGIN: Once = Once::new();

fn seconds() -> f64 {
    clock()
}

fn show(text: &str) {
    progress(text.as_ptr(), text.len());
}

/// Gives the address of so many bytes; zero if there are none.
#[unsafe(no_mangle)]
pub extern "C" fn allocate(bytes: usize) -> *mut u8 {
    // SAFETY: the layout has a size above zero.
    Layout::array::<u8>(bytes.max(1)).map_or(std::ptr::null_mut(), |layout| unsafe { alloc(layout) })
}

/// Takes bytes back.
///
/// # Safety
/// They are of [`allocate`], with the same number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn release(address: *mut u8, bytes: usize) {
    if let Ok(layout) = Layout::array::<u8>(bytes.max(1)) {
        // SAFETY: as the caller promises.
        unsafe { dealloc(address, layout) };
    }
}

/// Answers the request at an address, and returns the address of the reply.
///
/// # Safety
/// So many bytes can be read there.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn call(address: *const u8, bytes: usize) -> *const u8 {
    BEGIN.call_once(|| {
        flexion_case::use_clock(seconds);
        std::panic::set_hook(Box::new(|panic| {
            show(&serde_json::json!({ "phase": "panic", "message": panic.to_string() }).to_string());
        }));
    });
    // SAFETY: as the caller promises.
    let request = unsafe { std::slice::from_raw_parts(address, bytes) };
    let text = match std::str::from_utf8(request) {
        Ok(request) => crate::reply(request, &mut show),
        Err(_) => r#"{"status":"refused","message":"the request is no UTF-8"}"#.to_owned(),
    };
    let mut reply = REPLY.lock().unwrap_or_else(PoisonError::into_inner);
    *reply = text;
    reply.as_ptr()
}

/// Bytes of the reply.
#[unsafe(no_mangle)]
pub extern "C" fn reply_length() -> usize {
    REPLY.lock().unwrap_or_else(PoisonError::into_inner).len()
}

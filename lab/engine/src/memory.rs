//! The memory that a request takes: counted, and bounded.

#[cfg(target_family = "wasm")]
pub(crate) use counted::{allow, exceeded};

#[cfg(not(target_family = "wasm"))]
pub(crate) fn allow(_: f64) {}

#[cfg(not(target_family = "wasm"))]
pub(crate) fn exceeded() -> bool {
    false
}

/// One thread allocates here, so that counting costs an addition.
#[cfg(target_family = "wasm")]
#[allow(unsafe_code)]
mod counted {
    use std::alloc::{GlobalAlloc, Layout, System};
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    static USED: AtomicUsize = AtomicUsize::new(0);
    static LIMIT: AtomicUsize = AtomicUsize::new(usize::MAX);

    struct Counted;

    #[global_allocator]
    static ALLOCATOR: Counted = Counted;

    // SAFETY: memory is that of `System`; beyond twice the limit there is none.
    unsafe impl GlobalAlloc for Counted {
        unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
            let used = USED.load(Relaxed).saturating_add(layout.size());
            if used / 2 <= LIMIT.load(Relaxed) {
                USED.store(used, Relaxed);
                // SAFETY: as the caller promises.
                let address = unsafe { System.alloc(layout) };
                if !address.is_null() {
                    return address;
                }
            }
            crate::exports::end();
            std::ptr::null_mut()
        }

        unsafe fn dealloc(&self, address: *mut u8, layout: Layout) {
            USED.store(USED.load(Relaxed).saturating_sub(layout.size()), Relaxed);
            // SAFETY: as the caller promises.
            unsafe { System.dealloc(address, layout) }
        }
    }

    /// Sets the most bytes that may be used.
    pub(crate) fn allow(bytes: f64) {
        LIMIT.store(bytes as usize, Relaxed);
    }

    /// Whether more are used.
    pub(crate) fn exceeded() -> bool {
        USED.load(Relaxed) > LIMIT.load(Relaxed)
    }
}

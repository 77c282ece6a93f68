//! Registration of blocking work: a filter, the layout of a table, a write to a reader that does not read. The signal
//! handler uses the registration to detect that the process cannot react to a signal.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

static DEPTH: AtomicUsize = AtomicUsize::new(0);
static WORK_NUMBER: AtomicU64 = AtomicU64::new(0);

/// Blocking work. It ends when this value is dropped.
#[derive(Debug)]
pub struct BusyWork(());

/// Registers blocking work. Registrations can be nested.
pub fn register() -> BusyWork {
    if DEPTH.fetch_add(1, Ordering::SeqCst) == 0 {
        WORK_NUMBER.fetch_add(1, Ordering::SeqCst);
    }
    BusyWork(())
}

impl Drop for BusyWork {
    fn drop(&mut self) {
        DEPTH.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Returns the number of the current blocking work. If the number is the same later, the work is still the same.
pub fn current() -> Option<u64> {
    (DEPTH.load(Ordering::SeqCst) > 0).then(|| WORK_NUMBER.load(Ordering::SeqCst))
}

//! Registration of blocking work: a filter, the layout of a table, a reader of stdout that does not read. The signal
//! handler uses it to detect that the process cannot react.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

static DEPTH: AtomicUsize = AtomicUsize::new(0);
static TURN: AtomicU64 = AtomicU64::new(0);

/// Blocking work, until it is dropped.
#[derive(Debug)]
pub struct Busy(());

/// Registers blocking work; can be nested.
pub fn busy() -> Busy {
    if DEPTH.fetch_add(1, Ordering::SeqCst) == 0 {
        TURN.fetch_add(1, Ordering::SeqCst);
    }
    Busy(())
}

impl Drop for Busy {
    fn drop(&mut self) {
        DEPTH.fetch_sub(1, Ordering::SeqCst);
    }
}

/// Number of the current blocking work. The same number later means that it is still the same work.
pub fn under_way() -> Option<u64> {
    (DEPTH.load(Ordering::SeqCst) > 0).then(|| TURN.load(Ordering::SeqCst))
}

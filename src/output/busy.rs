//! Work that nothing can interrupt from within: a filter that is waited for, a table that is laid out, a reader of stdout
//! that does not read. Who hears signals looks here whether the rest of the process can still hear him.

use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

static DEPTH: AtomicUsize = AtomicUsize::new(0);
static TURN: AtomicU64 = AtomicU64::new(0);

/// Such work, until dropped.
#[derive(Debug)]
pub struct Busy(());

/// Begins such work; it may nest.
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

/// The number of the work that is under way, if any is: the same number later is the same work still.
pub fn under_way() -> Option<u64> {
    (DEPTH.load(Ordering::SeqCst) > 0).then(|| TURN.load(Ordering::SeqCst))
}

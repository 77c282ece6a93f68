//! Storage of records while the broker is away: when they are written and flushed, and reports of losses.

use std::time::Duration;

use tokio::task::spawn_blocking;
use tokio::time::Instant;

use super::{Broker, ConnectionState, Delivery};
use armctl_frame::failure::plain;
use armctl_frame::output::log::Level;

/// Time without a connection or an acknowledgement after which waiting records are written to disk. A lost connection
/// is noticed at once.
const STALL_TIME: Duration = Duration::from_secs(2);

impl<'a, B: Broker + 'a> Delivery<'a, B> {
    /// Whether the broker acknowledges the records.
    pub(super) fn is_flowing(&self) -> bool {
        let ConnectionState::Open(open) = &self.connection else { return false };
        let has_progress = open.is_idle() || open.progress.elapsed() < STALL_TIME;
        open.is_accepted && self.format.is_ready() && has_progress
    }

    /// Whether records have waited for some time. The first connection needs a moment.
    pub(super) fn is_stalled(&self) -> bool {
        !self.is_flowing() && self.began.elapsed() >= STALL_TIME
    }

    /// Flushes the records on disk, in another thread, so that a slow disk does not delay robots.
    pub(super) fn flush(&mut self) {
        self.next_flush = self.outbox.sync_interval().map(|interval| Instant::now() + interval);
        if self.outbox.is_away() || self.is_stalled() {
            // This also writes records that an error of the disk has left in memory.
            self.outbox.set_away(true);
        }
        self.flushing = self.outbox.take_unflushed().map(|file| spawn_blocking(move || file.sync_data()));
        self.report_disk_error();
    }

    pub(super) fn report_disk_error(&mut self) {
        if let Some(error) = self.outbox.take_disk_error() {
            let why = plain(&error);
            self.listener.log(
                Level::Error,
                &format!("cannot write messages to disk ({why}): messages that do not fit into memory are dropped"),
            );
        }
    }

    pub(super) fn report_dropped(&mut self) {
        let dropped = self.outbox.take_dropped();
        self.counts.dropped += dropped.overflow + dropped.damaged;
        if dropped.overflow > 0 {
            let what = if dropped.overflow == 1 { "message was" } else { "messages were" };
            self.listener.log(
                Level::Warning,
                &format!("{} {what} dropped, the oldest first: the buffer was full", dropped.overflow),
            );
        }
        if dropped.damaged > 0 {
            self.listener.log(Level::Error, "a part of the buffer on disk was damaged and is lost");
        }
    }
}

//! Fence before an order, and reopening of a lost line.
//!
//! An `@OK` does not identify the order that it answers. A late `@OK` may arrive: the answer to an order that timed
//! out, or to an order of another client of a device server. The fence is a read before the order. A controller answers
//! in the order of the requests, and the answer to a read cannot be mistaken for an `@OK`. After the answer to the
//! read, no `@OK` of an earlier order can arrive, and it is safe to send the next order.

use armctl_controller::Risk;

use super::temporary_changes::HostState;
use super::{Client, Error, Event, Transport, status_page};
use crate::Reason;

/// Purpose of the fence in a plan.
#[doc(hidden)]
pub const FENCE: &str = "check that the line is quiet";

impl Client {
    /// Sends a harmless read before an order. The fence is not needed if the last exchange was a read that was
    /// answered.
    pub(super) async fn fence(&mut self) -> Result<(), Error> {
        if self.is_fenced {
            return Ok(());
        }
        if self.is_dry_run() {
            self.plan_fence();
            return Ok(());
        }
        Box::pin(self.transact_fenced(&status_page(0)))
            .await
            .map(|_| ())
            .map_err(|error| Error::NotSent(Box::new(error)))
    }

    /// Plans the fence in a dry run. If an earlier answer decides whether the frame before the fence is sent, the same
    /// answer decides whether the fence is sent.
    pub(super) fn plan_fence(&mut self) {
        if self.is_fenced {
            return;
        }
        let about = Reason::about(FENCE);
        let on = self.plan_condition.take();
        let reason = on.as_deref().map_or(about, |on| about.depending_on(on));
        self.plan_depending(&status_page(0).text(), reason);
    }

    /// Reopens a lost line before a read, for example after the cable was plugged in again or the device server
    /// restarted. The line stays closed if this client has a motion to stop or a change to undo: the user must then see
    /// the error, and its hints explain what to do.
    pub(super) async fn reopen_for_read(&mut self, risk: Risk) -> Result<(), Error> {
        let owes = self.moving.is_some() || self.host == HostState::SwitchedOn || !self.undo_requests.is_empty();
        if !self.is_line_lost || risk > Risk::Read || owes {
            return Ok(());
        }
        let Some(opener) = &self.opener else { return Ok(()) };
        let opening = (opener.0)();
        let line = opening.await.map_err(|error| Error::NotReopened(Box::new(error)))?;
        self.transport = Transport::Line(Box::new(line));
        self.address_pair = self.transport.address_pair();
        self.session.reset();
        self.is_line_lost = false;
        self.host = HostState::Unknown;
        self.is_fenced = false;
        // The reopened line may lead to another machine, with other axis letters.
        self.letters = None;
        self.watcher.event(Event::Reopened);
        Ok(())
    }
}

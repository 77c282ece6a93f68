//! Fence before an order, and reopening of a lost line.
//!
//! `@OK` does not identify the order that it answers. A late one may arrive: of an order that timed out, or of
//! another client of a device server. A controller answers in order, and no `@OK` can be mistaken for the answer to a
//! read. So once a read is answered, no older `@OK` can arrive, and the order is safe to send.

use armctl_controller::Risk;

use super::temporary_changes::HostState;
use super::{Client, Error, Event, Transport, status_page};
use crate::Reason;

/// Purpose of the fence in a plan.
pub const FENCE: &str = "check that the line is quiet";

impl Client {
    /// Sends a harmless read before an order, unless the last exchange was an answered read.
    pub(super) async fn fence(&mut self) -> Result<(), Error> {
        if self.is_fenced {
            return Ok(());
        }
        if self.is_dry() {
            self.plan_fence();
            return Ok(());
        }
        Box::pin(self.transact_fenced(&status_page(0)))
            .await
            .map(|_| ())
            .map_err(|error| Error::NotSent(Box::new(error)))
    }

    /// Plans the fence of a dry run. It depends on the same answer as the frame before it.
    pub(super) fn plan_fence(&mut self) {
        if self.is_fenced {
            return;
        }
        let about = Reason::about(FENCE);
        let on = self.plan_condition.take();
        let reason = on.as_deref().map_or(about, |on| about.depending_on(on));
        self.plan_depending(&status_page(0).text(), reason);
    }

    /// Reopens a lost line for a read: after a re-plug, or a restart of the device server. Not if this client has a
    /// motion to stop or a change to undo: hints explain that to the user.
    pub(super) async fn reopen_for_read(&mut self, risk: Risk) -> Result<(), Error> {
        let owes = self.moving.is_some() || self.host == HostState::SwitchedOn || !self.undo_requests.is_empty();
        if !self.is_line_lost || risk > Risk::Read || owes {
            return Ok(());
        }
        let Some(opener) = &self.opener else { return Ok(()) };
        let opening = (opener.0)();
        let line = opening.await.map_err(|error| Error::NotReopened(Box::new(error)))?;
        self.transport = Transport::Line(Box::new(line));
        self.ends = self.transport.ends();
        self.session.reset();
        self.is_line_lost = false;
        self.host = HostState::Unknown;
        self.is_fenced = false;
        // The reopened line may lead to another machine.
        self.letters = None;
        self.watcher.event(Event::Reopened);
        Ok(())
    }
}

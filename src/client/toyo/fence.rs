//! What makes sure that an answer is the answer to what was asked, and that a line that is gone comes back.
//!
//! `@OK` says nothing of the order it answers, and a line may bring one late: of an order whose answer was given up, or of
//! another client of a device server. A controller answers one block after the other. So once it has answered a question,
//! which no `@OK` can be taken for, nothing older can come any more: then an order goes out.

use armctl_controller::Risk;

use super::borrowed::Host;
use super::{Client, Error, Event, Transport, status_page};
use crate::Reason;

/// What it is about.
pub const FENCE: &str = "whether the line is at peace";

impl Client {
    /// Asks something harmless before an order, unless an answered question was the last on the line.
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

    /// Notes it in a dry run. Behind an order that is sent or not, so is this.
    pub(super) fn plan_fence(&mut self) {
        if self.is_fenced {
            return;
        }
        let about = Reason::about(FENCE);
        let on = self.hangs_on.take();
        let reason = on.as_deref().map_or(about, |on| about.depending_on(on));
        self.plan_depending(&status_page(0).text(), reason);
    }

    /// Opens a line again that is gone, for what only reads: after a re-plug, or a device server that was started anew.
    /// What this client has changed is left to the hints that tell how to undo it.
    pub(super) async fn revive(&mut self, risk: Risk) -> Result<(), Error> {
        let owes = self.moving.is_some() || self.host == Host::Taken || !self.borrowed.is_empty();
        if !self.is_gone || risk > Risk::Read || owes {
            return Ok(());
        }
        let Some(opener) = &self.opener else { return Ok(()) };
        let opening = (opener.0)();
        let line = opening.await.map_err(|error| Error::NotReopened(Box::new(error)))?;
        self.transport = Transport::Line(Box::new(line));
        self.ends = self.transport.ends();
        self.session.renew();
        self.is_gone = false;
        self.host = Host::Unknown;
        self.is_fenced = false;
        // It may be another machine now.
        self.letters = None;
        self.watcher.event(Event::Reopened);
        Ok(())
    }
}

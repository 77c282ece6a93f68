//! What makes sure that an answer is the answer to what was asked, and that a line that is gone comes back.
//!
//! `@OK` says nothing of the order it answers, and a line may bring one late: of an order whose answer was given up, or of
//! another client of a device server. A controller answers one block after the other. So once it has answered a question,
//! which no `@OK` can be taken for, nothing older can come any more: then an order goes out.

use super::{Link, Transport, status_page};
use crate::command::frame::dry_run::Reason;
use crate::command::toyo::connect;
use crate::controller::Risk;
use crate::failure::{Failure, Kind};

use super::borrowed::Host;

/// What it is about.
pub const FENCE: &str = "whether the line is at peace";

impl Link {
    /// Asks something harmless before an order, unless an answered question was the last on the line.
    pub(in crate::command::toyo) async fn fence(&mut self) -> Result<(), Failure> {
        if self.is_fenced {
            return Ok(());
        }
        if self.is_dry() {
            self.plan_fence();
            return Ok(());
        }
        Box::pin(self.converse(&status_page(0), true)).await.map(|_| ()).map_err(|failure| {
            let message = format!("the order was not sent: {}", failure.message);
            Failure { message, ..failure }
        })
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
    /// What this link has changed is left to the hints that tell how to undo it.
    pub(super) async fn revive(&mut self, risk: Risk) -> Result<(), Failure> {
        let owes = self.moving.is_some() || self.host == Host::Taken || !self.borrowed.is_empty();
        if !self.is_gone || risk > Risk::Read || owes {
            return Ok(());
        }
        let Some((robot, access)) = self.again.clone() else { return Ok(()) };
        let opened = Box::pin(connect::open(&robot, &access, &self.screen)).await;
        // Whatever is in the way, such as rights that a port gets a moment after it is there: it may pass.
        let stream = opened.map_err(|failure| Failure { kind: Kind::NoAnswer, ..failure })?;
        self.transport = Transport::Stream(Box::new(stream));
        self.line.renew();
        self.is_gone = false;
        self.host = Host::Unknown;
        self.is_fenced = false;
        // It may be another machine now.
        self.letters = None;
        self.screen.detail(1, "the line is there again");
        Ok(())
    }
}

//! What a link changes for a while, and puts back as it was found: who commands, and modes.

use super::{Link, Refusal, Transport, status_page};
use crate::command::frame::dry_run::Reason;
use crate::command::toyo::refusal;
use crate::controller::Risk;
use crate::controller::toyo::request::{Answer, Request};
use crate::controller::toyo::table::commands::Command;
use crate::failure::{Failure, Kind};

/// Who commands the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Host {
    /// Not asked yet.
    Unknown,
    /// The host was ON before.
    Found,
    /// This link switched it ON, and gives it back.
    Taken,
    /// In a dry run: it was asked, and switched ON, if an answer before wants that.
    Perhaps,
}

/// What decides whether the host is switched.
const HOST: &str = "whether the host was ON";

impl Link {
    /// Makes sure that the host commands, and remembers who did before.
    pub async fn take_host(&mut self) -> Result<(), Failure> {
        if let Transport::Notes(_) = self.transport {
            self.plan_to_take_host(None);
            return Ok(());
        }
        if self.host != Host::Unknown {
            return Ok(());
        }
        let status = self.status_of(&[2]).await?;
        if status.host_on() {
            self.host = Host::Found;
            return Ok(());
        }
        if status.pendant_on() {
            return Err(refusal::pendant());
        }
        self.debts.host(true);
        match self.converse(&Request::bare(Command::Hson), false).await? {
            Answer::Refused => {
                self.debts.host(false);
                Err(refusal::pendant())
            }
            Answer::Done | Answer::Data(_) => {
                self.host = Host::Taken;
                Ok(())
            }
        }
    }

    /// Notes in a dry run that the host is taken, if an answer before wants that.
    pub(super) fn plan_to_take_host(&mut self, on: Option<&str>) {
        let asked = Reason::about("whether the host is ON");
        let asked = match (self.host, on) {
            (Host::Taken | Host::Found, _) => return,
            (_, Some(on)) => asked.depending_on(on),
            (Host::Perhaps, None) => asked.depending_on("whether it was asked before"),
            (Host::Unknown, None) => asked,
        };
        self.note(&status_page(2), asked);
        self.note(&Request::bare(Command::Hson), Reason::default().depending_on(HOST));
        self.host = if on.is_some() { Host::Perhaps } else { Host::Taken };
    }

    /// Notes in a dry run that something is changed for a while; `back` is what puts it back, with `?` for what was found.
    pub async fn plan_to_borrow(&mut self, change: &Request, back: &str, on: &str) -> Result<(), Failure> {
        self.plan_to_take_host(Some(on));
        self.fence().await?;
        self.plan_if(change, on);
        self.owed.push(back.to_owned());
        Ok(())
    }

    /// Changes something for a while: `back` makes it as it was, in [`Link::put_back`] or when the link ends.
    pub async fn borrow(&mut self, change: &Request, back: Request) -> Result<(), Failure> {
        // Before it is sent: if the answer is lost, it may have been done.
        self.debts.push(&back.text());
        self.borrowed.push(back);
        match self.try_order(change).await? {
            Ok(()) => Ok(()),
            Err(Refusal(request)) => {
                if let Some(back) = self.borrowed.pop() {
                    self.debts.pop(&back.text());
                }
                Err(refusal::explained(self, &request).await)
            }
        }
    }

    /// Makes everything as it was before [`Link::borrow`]. All of it is tried; the first failure counts.
    pub async fn put_back(&mut self) -> Result<(), Failure> {
        self.plan_put_back();
        let mut outcome = Ok(());
        while let Some(back) = self.borrowed.pop() {
            let text = back.text();
            let kept = |why: String| {
                Failure::new(Kind::Refused, format!("what was changed for a while was not put back by {text}: {why}"))
                    .hint("`toyo mode` and `toyo task` set it; `toyo status` tells how the controller stands")
            };
            if self.is_gone {
                self.screen.note(&kept("the line is gone".to_owned()).message);
                continue;
            }
            // A line that is still out of order shows in what follows.
            self.fence().await.unwrap_or_default();
            let failure = match self.converse(&back, true).await {
                Ok(Answer::Refused) => kept("@NG".to_owned()),
                Ok(_) => {
                    self.debts.pop(&back.text());
                    continue;
                }
                Err(failure) => Failure { kind: failure.kind, ..kept(failure.message) },
            };
            outcome = outcome.and(Err(failure));
        }
        outcome
    }

    /// The host stays as it is when the link ends: somebody asked for that.
    pub fn keep_host(&mut self) {
        self.host = Host::Found;
    }

    /// Gives the host back as it was found.
    pub(in crate::command::toyo) async fn give_back(&mut self) -> Result<(), Failure> {
        if self.host != Host::Taken || self.is_dry() || self.is_gone {
            return Ok(());
        }
        self.host = Host::Unknown;
        let kept = |why: String| {
            Failure::new(Kind::Refused, format!("the host was switched ON and could not be switched OFF again: {why}"))
                .hint("`toyo host off` gives the start input back")
        };
        self.fence().await.unwrap_or_default();
        match self.converse(&Request::bare(Command::Hsof), false).await {
            Ok(Answer::Refused) => Err(kept("@NG".to_owned())),
            Ok(_) => {
                self.debts.host(false);
                Ok(())
            }
            Err(failure) => Err(Failure { kind: failure.kind, ..kept(failure.message) }),
        }
    }

    /// Notes in a dry run what puts things back.
    fn plan_put_back(&mut self) {
        while let Some(back) = self.owed.pop() {
            self.plan_fence();
            let reason = Reason::about("to put back what was found");
            self.plan_depending(&back, reason.depending_on("what was found"));
        }
    }

    /// Notes in a dry run what is sent when the link ends.
    pub(super) fn plan_end(&mut self) {
        self.plan_put_back();
        if !self.is_dry() || !matches!(self.host, Host::Taken | Host::Perhaps) {
            return;
        }
        self.host = Host::Unknown;
        self.plan_fence();
        self.note(&Request::bare(Command::Hsof), Reason::default().depending_on(HOST));
    }
}

/// Whether the host must be ON. Only reads do without for sure (ambiguity C14); a stop must not wait for it.
pub(super) fn wants_host(request: &Request) -> bool {
    request.risk() > Risk::Read && !matches!(request.command(), Command::Hson | Command::Hsof | Command::Stop)
}

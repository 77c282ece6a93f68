//! Temporary changes that the client undoes at its end: host control and modes.

use armctl_controller::Risk;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::table::commands::Command;

use super::{Client, Error, Event, HOST_PAGE, status_page};
use crate::{Grant, Reason};

/// State of host control (host ON / OFF).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum HostState {
    /// Not read yet.
    Unknown,
    /// The host was ON already.
    AlreadyOn,
    /// This client switched the host ON, and must switch it OFF at its end.
    SwitchedOn,
    /// Dry run: the host state is read and the host switched ON only if an earlier answer requires it.
    Conditional,
}

/// `depends_on` of the order that switches the host ON.
const HOST: &str = "whether the host was ON";

impl Client {
    /// Switches the host ON if it is OFF, and records the earlier state.
    ///
    /// # Errors
    /// [`Error::PendantOn`] if the teach pendant is ON.
    pub async fn take_host(&mut self) -> Result<(), Error> {
        let grant = self.grant.clone();
        self.take_host_by(&grant).await
    }

    /// [`Self::take_host`] with another grant.
    pub(super) async fn take_host_by(&mut self, grant: &Grant) -> Result<(), Error> {
        if self.is_dry() {
            self.plan_to_take_host(None);
            return Ok(());
        }
        if self.host != HostState::Unknown {
            return Ok(());
        }
        let status = self.status_of(&[HOST_PAGE]).await?;
        if status.host_on() {
            self.host = HostState::AlreadyOn;
            return Ok(());
        }
        if status.pendant_on() {
            return Err(Error::PendantOn);
        }
        let order = Request::bare(Command::Hson);
        grant.check(order.risk(), &order.text())?;
        self.watcher.event(Event::HostSwitch(true));
        let answer = match self.transact(&order, false).await {
            // The host status shows whether the order was carried out.
            Err(error @ Error::OutcomeUnknown(_)) => match self.is_host_on().await {
                Ok(true) => Answer::Done,
                Ok(false) => {
                    self.watcher.event(Event::HostSwitch(false));
                    return Err(Error::NotSent(Box::new(error)));
                }
                Err(_) => return Err(error),
            },
            answer => answer?,
        };
        match answer {
            Answer::Refused => {
                self.watcher.event(Event::HostSwitch(false));
                Err(Error::PendantOn)
            }
            Answer::Done | Answer::Data(_) => {
                self.host = HostState::SwitchedOn;
                Ok(())
            }
        }
    }

    /// Plans the host switch of a dry run; `on` is the earlier answer that decides whether it is sent.
    pub(super) fn plan_to_take_host(&mut self, on: Option<&str>) {
        let host_read = Reason::about("whether the host is ON");
        let host_read = match (self.host, on) {
            (HostState::SwitchedOn | HostState::AlreadyOn, _) => return,
            (_, Some(on)) => host_read.depending_on(on),
            (HostState::Conditional, None) => host_read.depending_on("whether the host state was read before"),
            (HostState::Unknown, None) => host_read,
        };
        self.note(&status_page(HOST_PAGE), host_read);
        self.note(&Request::bare(Command::Hson), Reason::default().depending_on(HOST));
        self.host = if on.is_some() { HostState::Conditional } else { HostState::SwitchedOn };
    }

    /// Plans a temporary change. `back` is the block that undoes it, with `?` for the value found.
    pub async fn plan_to_borrow(&mut self, change: &Request, back: &str, on: &str) -> Result<(), Error> {
        self.plan_to_take_host(Some(on));
        self.fence().await?;
        self.plan_if(change, on);
        self.planned_undo_blocks.push(back.to_owned());
        Ok(())
    }

    /// Makes a temporary change. `back` undoes it, in [`Client::put_back`] or when the client ends.
    pub async fn borrow(&mut self, change: &Request, back: Request) -> Result<(), Error> {
        // Recorded before sending: if the answer is lost, the change may have been made.
        self.watcher.event(Event::TemporaryChange(back.clone()));
        self.undo_requests.push(back);
        match self.try_ask(change).await? {
            Ok(_) => Ok(()),
            Err(refusal) => {
                if let Some(back) = self.undo_requests.pop() {
                    self.watcher.event(Event::Undone(back));
                }
                Err(refusal.into())
            }
        }
    }

    /// Undoes all changes of [`Client::borrow`], without a check of the grant. An error does not stop the rest; the
    /// first one is returned.
    ///
    /// # Errors
    /// [`Error::NotUndone`].
    pub async fn put_back(&mut self) -> Result<(), Error> {
        self.plan_put_back();
        let mut outcome = Ok(());
        while let Some(back) = self.undo_requests.pop() {
            if self.is_line_lost {
                self.watcher.event(Event::NotUndone(back));
                continue;
            }
            outcome = outcome.and(self.fence_at_end().await);
            let block = back.text();
            match undo_result(self.transact(&back, true).await) {
                Ok(()) => self.watcher.event(Event::Undone(back)),
                Err(cause) => outcome = outcome.and(Err(Error::NotUndone { block, cause })),
            }
        }
        outcome
    }

    /// Leaves the host ON when the client ends, as the user requested.
    pub fn keep_host(&mut self) {
        self.host = HostState::AlreadyOn;
    }

    /// Switches the host OFF again if this client switched it ON, without a check of the grant.
    ///
    /// # Errors
    /// [`Error::HostNotReleased`].
    pub async fn give_back(&mut self) -> Result<(), Error> {
        if self.host != HostState::SwitchedOn || self.is_dry() || self.is_line_lost {
            return Ok(());
        }
        self.host = HostState::Unknown;
        let fenced = self.fence_at_end().await;
        let answer = match self.transact(&Request::bare(Command::Hsof), false).await {
            // The status shows whether the order was executed.
            Err(Error::OutcomeUnknown(_)) if matches!(self.is_host_on().await, Ok(false)) => Ok(Answer::Done),
            answer => answer,
        };
        undo_result(answer).map_err(Error::HostNotReleased)?;
        self.watcher.event(Event::HostSwitch(false));
        fenced
    }

    /// Whether the host is ON after an order of this client to switch it. The watcher gets no event of a foreign host.
    async fn is_host_on(&mut self) -> Result<bool, Error> {
        let old = std::mem::replace(&mut self.host, HostState::SwitchedOn);
        let status = self.status_of(&[HOST_PAGE]).await;
        self.host = old;
        Ok(status?.host_on())
    }

    /// Fence at the end of a client. Returns only a late refusal of an order that seemed confirmed: later requests
    /// report every other fault.
    pub(super) async fn fence_at_end(&mut self) -> Result<(), Error> {
        match self.fence().await {
            Err(Error::NotSent(cause)) if matches!(*cause, Error::OutcomeUnknown(_)) => Err(*cause),
            _ => Ok(()),
        }
    }

    fn plan_put_back(&mut self) {
        while let Some(back) = self.planned_undo_blocks.pop() {
            self.plan_fence();
            let reason = Reason::about("restore the earlier setting");
            self.plan_depending(&back, reason.depending_on("the earlier setting"));
        }
    }

    pub(super) fn plan_end(&mut self) {
        self.plan_put_back();
        if !self.is_dry() || !matches!(self.host, HostState::SwitchedOn | HostState::Conditional) {
            return;
        }
        self.host = HostState::Unknown;
        self.plan_fence();
        self.note(&Request::bare(Command::Hsof), Reason::default().depending_on(HOST));
    }
}

/// Result of an undo request. The error is `None` if the controller refused.
fn undo_result(answer: Result<Answer, Error>) -> Result<(), Option<Box<Error>>> {
    match answer {
        Ok(Answer::Refused) => Err(None),
        Ok(Answer::Done | Answer::Data(_)) => Ok(()),
        Err(error) => Err(Some(Box::new(error))),
    }
}

/// Whether the host must be ON. Only reads certainly work without it (ambiguity C14). A stop must not wait for it.
pub(super) fn needs_host(request: &Request) -> bool {
    request.risk() > Risk::Read && !matches!(request.command(), Command::Hson | Command::Hsof | Command::Stop)
}

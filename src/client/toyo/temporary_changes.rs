//! Temporary changes: the client takes host control or changes a mode, and undoes these changes before it closes.

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
    /// This client switched the host ON, and must switch the host OFF when it closes.
    SwitchedOn,
    /// Dry run: the client reads the host state and switches the host ON only if an earlier answer requires it.
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

    /// Takes host control like [`Self::take_host`], but checks `grant` instead of the grant of the client.
    pub(super) async fn take_host_by(&mut self, grant: &Grant) -> Result<(), Error> {
        if self.is_dry_run() {
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
            // The answer to the order is unknown, but the host status shows whether the controller carried out the
            // order.
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

    /// Dry run: plans the orders that switch the host ON. `on` is the earlier answer that decides whether they are
    /// sent.
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

    /// Dry run: plans a temporary change. `back` is the block that undoes the change, with `?` for the value that the
    /// client would read before.
    pub async fn plan_to_borrow(&mut self, change: &Request, back: &str, on: &str) -> Result<(), Error> {
        self.plan_to_take_host(Some(on));
        self.fence().await?;
        self.plan_if(change, on);
        self.planned_undo_blocks.push(back.to_owned());
        Ok(())
    }

    /// Makes a temporary change. The request `back` undoes the change. The client sends `back` in [`Client::put_back`]
    /// or when it closes.
    pub async fn borrow(&mut self, change: &Request, back: Request) -> Result<(), Error> {
        // The undo request is recorded before the change is sent: if the answer is lost, the controller may have made
        // the change.
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

    /// Undoes all changes of [`Client::borrow`], without a check of the grant. After an error, the other changes are
    /// still undone. The first error is returned.
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

    /// Leaves the host ON at the end of the client.
    pub fn keep_host(&mut self) {
        self.host = HostState::AlreadyOn;
    }

    /// Switches the host OFF again if this client switched it ON, without a check of the grant.
    ///
    /// # Errors
    /// [`Error::HostNotReleased`].
    pub async fn give_back(&mut self) -> Result<(), Error> {
        if self.host != HostState::SwitchedOn || self.is_dry_run() || self.is_line_lost {
            return Ok(());
        }
        self.host = HostState::Unknown;
        let fenced = self.fence_at_end().await;
        let answer = match self.transact(&Request::bare(Command::Hsof), false).await {
            // The answer to the order is unknown, but the status shows whether the controller carried out the order.
            Err(Error::OutcomeUnknown(_)) if matches!(self.is_host_on().await, Ok(false)) => Ok(Answer::Done),
            answer => answer,
        };
        undo_result(answer).map_err(Error::HostNotReleased)?;
        self.watcher.event(Event::HostSwitch(false));
        fenced
    }

    /// Reads whether the host is ON, after an order of this client to switch it. During the read, the host state is
    /// [`HostState::SwitchedOn`], so that the event names this client as the one that switched the host ON.
    async fn is_host_on(&mut self) -> Result<bool, Error> {
        let old = std::mem::replace(&mut self.host, HostState::SwitchedOn);
        let status = self.status_of(&[HOST_PAGE]).await;
        self.host = old;
        Ok(status?.host_on())
    }

    /// Sends the fence when the client closes. This function returns only one kind of error: a late refusal of an order
    /// that seemed confirmed. Later requests report every other fault.
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
        if !self.is_dry_run() || !matches!(self.host, HostState::SwitchedOn | HostState::Conditional) {
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

/// Whether the host must be ON for this request. Only reads are known to work while the host is OFF (ambiguity C14). A
/// stop must not wait for host control.
pub(super) fn needs_host(request: &Request) -> bool {
    request.risk() > Risk::Read && !matches!(request.command(), Command::Hson | Command::Hsof | Command::Stop)
}

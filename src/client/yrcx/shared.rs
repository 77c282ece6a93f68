//! Shared link of a session: the output of other clients, and the turns of the clients.

use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{Image, Output};
use armctl_controller::yrcx::order::Order;
use armctl_controller::{Now, Risk};
use armctl_transport::session::client::SessionBusy;
use armctl_transport::session::wire::Change;
use tokio::time::Instant;

use super::error::Error;
use super::{Client, Event, Transport};

impl Client {
    /// Replaces the output image of this client with the image of the session, if a session owns the link. Only the
    /// session sends images to the controller.
    pub(super) fn join(&mut self) {
        let Transport::Image(link) = &self.transport else { return };
        if link.output().is_none() {
            return;
        }
        (self.is_shared, self.is_held, self.is_up) = (true, true, link.is_up());
        self.adopt_session_output();
    }

    pub(super) fn adopt_session_output(&mut self) {
        let Transport::Image(link) = &self.transport else { return };
        let Some(image) = link.output().and_then(image) else { return };
        self.output = Output::new(image);
        if self.is_up {
            let now = self.now();
            self.output.sent(now);
            self.last_output = Some(image);
        }
    }

    /// Applies bits or a command that another client has sent.
    pub(super) fn apply_change(&mut self, now: Now, change: &Change) {
        let (Some(mask), Some(value)) = (image(&change.mask), image(&change.value)) else { return };
        let mut last_output = Output::new(self.last_output.unwrap_or_default());
        last_output.changed(now, &mask, &value);
        self.last_output = self.last_output.map(|_| last_output.next);
        self.output.changed(now, &mask, &value);
    }

    /// Reserves motion for this client, before it sends a motion.
    pub(super) async fn claim_motion(&mut self, risk: Risk) -> Result<(), Error> {
        let Transport::Image(link) = &mut self.transport else { return Ok(()) };
        if risk < Risk::Motion {
            return Ok(());
        }
        link.claim_motion().await.map_err(Error::Session)
    }

    /// Reserves motion before the client reads the values that an order replaces. If another client moves the robot,
    /// this call fails at once and does not wait for a turn. Sends nothing to the controller.
    ///
    /// # Errors
    /// [`Error::Session`].
    pub async fn reserve(&mut self, order: &Order) -> Result<(), Error> {
        self.claim_motion(order.risk()).await
    }

    /// Waits for the turn to send a remote command, and applies all changes that other clients sent before. With an
    /// older image, the client could mistake its new command for one that was already sent.
    pub(super) async fn acquire(&mut self) -> Result<(), Error> {
        self.is_turn_over = false;
        let Transport::Image(link) = &mut self.transport else { return Ok(()) };
        link.acquire(Instant::now() + self.timeout).await.map_err(Error::Session)?;
        self.catch_up().await
    }

    /// Passes the turn to another client after the last command has ended.
    pub(super) fn release(&mut self) {
        if std::mem::take(&mut self.is_turn_over)
            && let Transport::Image(link) = &mut self.transport
        {
            link.release();
        }
    }

    /// Returns an error if the session has ended. The link of an ended session does not open again.
    pub(super) fn check_session(&self) -> Result<(), Error> {
        let Transport::Image(link) = &self.transport else { return Ok(()) };
        match link.ended() {
            Some(why) => Err(Error::Session(SessionBusy::Ended(why.to_owned()))),
            None => Ok(()),
        }
    }

    /// Checks that the last command of another client has ended, because a new command would stop it. Returns
    /// [`Error::OtherClientRunning`] if that command is still running.
    pub(super) async fn check_other_commands(&mut self) -> Result<(), Error> {
        let words = self.output.next.command();
        if !self.is_shared || self.exchange.is_some() || words[0] == Status::Ready.word() {
            return Ok(());
        }
        let until = Instant::now() + self.policy.accept;
        loop {
            let seen = self.input.unwrap_or_default().command();
            match Status::from_word(seen[0]) {
                Status::Running => {
                    self.is_turn_over = true;
                    self.release();
                    return Err(Error::OtherClientRunning { words: Box::new(words) });
                }
                // The controller may not have accepted the other command yet.
                Status::Ready if Instant::now() < until && self.is_up => self.run_until(until).await?,
                _ => {
                    self.watcher.event(Event::OtherCommandEnded { words, answer: seen });
                    return Ok(());
                }
            }
        }
    }
}

fn image(bytes: &[u8]) -> Option<Image> {
    Image::from_link(bytes)
}

//! The signals beside remote commands (chapter 1): procedures that switch them, and what the controller shows.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::sequence::{self, Sequence};
use tokio::time::Instant;

use super::Client;
use super::error::Error;
use crate::STOP_WITHIN;

impl Client {
    /// Carries out a procedure of signals, such as [`Procedure::run`], and says how long it took. A dry run notes what
    /// each edge shows.
    ///
    /// # Errors
    /// [`Error::Unfinished`] if the controller did not confirm it.
    pub async fn carry_out(&mut self, procedure: Procedure) -> Result<Duration, Error> {
        if !procedure.only_awaits() {
            self.authorize_command(procedure.name, procedure.risk)?;
        }
        if self.is_dry() {
            self.note_steps(&procedure);
            return if procedure.risk == Risk::Read { Err(Error::NotKnown) } else { Ok(Duration::ZERO) };
        }
        let longest = if procedure.stops() { STOP_WITHIN } else { Duration::MAX };
        self.switch(procedure, longest).await
    }

    /// The same in this time and without the check: a stop is always allowed.
    pub(super) async fn switch(&mut self, procedure: Procedure, longest: Duration) -> Result<Duration, Error> {
        self.catch_up().await?;
        self.claim_motion(procedure.risk).await?;
        let name = procedure.name;
        self.has_started |= procedure.risk == Risk::Motion;
        let began = Instant::now();
        self.start_sequence(Sequence::new(procedure, self.patience).within(longest))?;
        match self.until_finished().await? {
            sequence::Outcome::Done => Ok(began.elapsed()),
            outcome => Err(Error::Unfinished { name, outcome }),
        }
    }

    /// What the controller shows now.
    ///
    /// # Errors
    /// [`Error::Silent`] if it shows nothing within the time-out.
    pub async fn look(&mut self) -> Result<Image, Error> {
        if self.is_dry() {
            return Err(Error::NotKnown);
        }
        self.catch_up().await?;
        let until = Instant::now() + self.timeout;
        loop {
            if let Some(image) = self.input {
                return Ok(image);
            }
            if Instant::now() >= until {
                return Err(Error::Silent);
            }
            self.turn_until(until).await?;
        }
    }

    /// Waits until what the controller shows matters, and returns it, as long as it takes.
    ///
    /// # Errors
    /// [`Error::Silent`] when the link is lost; the next call waits for it to be open again.
    pub async fn look_until(&mut self, mut matters: impl FnMut(&Image) -> bool) -> Result<Image, Error> {
        loop {
            let was_up = self.is_up;
            if let Some(image) = self.input.filter(|image| matters(image)) {
                return Ok(image);
            }
            self.turn().await?;
            if was_up && !self.is_up {
                return Err(Error::Silent);
            }
        }
    }

    /// What the controller is shown; `None` where that is for somebody else to show.
    pub fn shown(&self) -> Option<&Image> {
        (self.is_owner || self.is_shared).then_some(&self.output.next)
    }
}

//! Dedicated signals (chapter 1): the procedures that switch them, and the input image.

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yrcx::image::Image;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_controller::yrcx::recording::{IMAGE, signals_text};
use armctl_controller::yrcx::sequence::{self, Sequence};
use tokio::time::Instant;

use super::Client;
use super::error::Error;
use crate::STOP_TIMEOUT;

impl Client {
    /// Runs a signal procedure, for example [`Procedure::run`], and returns its duration. A dry run plans the image of
    /// each step.
    ///
    /// # Errors
    /// [`Error::Unfinished`] without confirmation by the controller.
    pub async fn run_procedure(&mut self, procedure: Procedure) -> Result<Duration, Error> {
        if !procedure.only_awaits() {
            self.authorize_command(procedure.name, procedure.risk)?;
        }
        if self.is_dry_run() {
            self.plan_steps(&procedure);
            return if procedure.risk == Risk::Read { Err(Error::DryRun) } else { Ok(Duration::ZERO) };
        }
        let limit = if procedure.stops() { STOP_TIMEOUT } else { Duration::MAX };
        self.switch(procedure, limit).await
    }

    /// Runs a procedure like [`run_procedure`](Self::run_procedure), with its own time limit and without a check of the
    /// grant: a stop is always allowed.
    pub(super) async fn switch(&mut self, procedure: Procedure, limit: Duration) -> Result<Duration, Error> {
        self.catch_up().await?;
        self.claim_motion(procedure.risk).await?;
        let name = procedure.name;
        self.has_started |= procedure.risk == Risk::Motion;
        let start = Instant::now();
        self.start_sequence(Sequence::new(procedure, self.procedure_timeout).within(limit))?;
        match self.wait_for_procedure().await? {
            sequence::Outcome::Done => Ok(start.elapsed()),
            outcome => Err(Error::Unfinished { name, outcome }),
        }
    }

    /// Returns the current input image. Waits for the image if there is none yet, and for the end of a status reset, so
    /// that the image does not have the status of an answered command.
    ///
    /// # Errors
    /// [`Error::Silent`] without an image within the time limit.
    pub async fn input_image(&mut self) -> Result<Image, Error> {
        if self.is_dry_run() {
            return Err(Error::DryRun);
        }
        self.catch_up().await?;
        let until = Instant::now() + self.timeout;
        loop {
            let is_over = Instant::now() >= until;
            if let Some(image) = self.input.filter(|_| is_over || !self.is_resetting()) {
                self.watcher.answered(&|| (IMAGE.to_owned(), signals_text(&image)));
                return Ok(image);
            }
            if is_over {
                return Err(Error::Silent);
            }
            self.run_until(until).await?;
        }
    }

    /// Waits, without a time limit, for an input image that meets the condition.
    ///
    /// # Errors
    /// [`Error::Silent`] if the link is lost. The next call waits until the link is open again.
    pub async fn wait_for_input(&mut self, mut condition: impl FnMut(&Image) -> bool) -> Result<Image, Error> {
        loop {
            let was_up = self.is_up;
            if let Some(image) = self.input.filter(|image| condition(image)) {
                return Ok(image);
            }
            self.run_turn().await?;
            if was_up && !self.is_up {
                return Err(Error::Silent);
            }
        }
    }

    /// The output image; `None` if this is a monitoring connection.
    pub fn output_image(&self) -> Option<&Image> {
        (self.is_owner || self.is_shared).then_some(&self.output.next)
    }
}

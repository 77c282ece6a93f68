//! General-purpose words. They share the words of the image with remote commands.

use armctl_controller::Risk;
use armctl_controller::yrcx::register::{Register, general};
use serde_json::json;
use tokio::time::Instant;

use super::error::Error;
use super::{Client, hex};
use crate::Reason;

impl Client {
    /// Sets general-purpose words. All changes are sent in one image. The words keep their values until other values
    /// replace them. A remote command uses these words while it runs, and the client restores them when the command
    /// ends.
    ///
    /// # Errors
    /// [`Error::WordsNotSent`] if the words were not sent within the time limit.
    pub async fn set_words(&mut self, changes: &[(Register, u32)]) -> Result<(), Error> {
        self.authorize_command("set-words", Risk::Write)?;
        if self.is_dry_run() {
            let mut words = self.output.next.command();
            for (register, value) in changes {
                register.write(&mut words, *value);
            }
            self.output.next.set_command(&words);
            let about: Vec<String> = changes.iter().map(|(register, value)| format!("{register} = {value}")).collect();
            self.plan_frame(json!({ "wi": hex(&words) }), Reason::about(&about.join(", ")));
            return Ok(());
        }
        self.catch_up().await?;
        self.reserve_words().await?;
        let result = self.send_words(changes).await;
        self.is_turn_over = true;
        self.release();
        result
    }

    async fn send_words(&mut self, changes: &[(Register, u32)]) -> Result<(), Error> {
        let mut words = general(&self.output.next.command());
        for (register, value) in changes {
            register.write(&mut words, *value);
        }
        self.output.next.set_command(&words);
        let until = Instant::now() + self.timeout;
        while self.output.last_sent().is_none_or(|sent| sent.command() != words) {
            if !self.is_up || Instant::now() >= until {
                return Err(Error::WordsNotSent);
            }
            self.run_until(until).await?;
        }
        Ok(())
    }
}

//! General-purpose words, which are shown where remote commands are: one at a time has them.

use serde_json::json;
use tokio::time::Instant;

use super::{Link, Transport, hex};
use crate::command::frame::dry_run::Reason;
use crate::controller::Risk;
use crate::controller::yrcx::register::{Register, general};
use crate::failure::{Failure, Kind};

impl Link {
    /// Shows these values in general-purpose words, all in one image. They stay until something else is shown there: a
    /// remote command has the words for itself as long as it lasts, and puts them back.
    pub async fn set_words(&mut self, changes: &[(Register, u32)]) -> Result<(), Failure> {
        self.no_unit("words are those of the whole controller")?;
        self.admit("set-words", Risk::Write)?;
        if let Transport::Notes(plan) = &mut self.transport {
            let mut words = self.output.next.command();
            for (register, value) in changes {
                register.write(&mut words, *value);
            }
            self.output.next.set_command(&words);
            let about: Vec<String> = changes.iter().map(|(register, value)| format!("{register} = {value}")).collect();
            plan.note(json!({ "wi": hex(&words) }), Reason::about(&about.join(", ")));
            return Ok(());
        }
        self.catch_up().await?;
        self.have_words().await?;
        let shown = self.show_words(changes).await;
        self.is_over = true;
        self.give_turn();
        shown
    }

    async fn show_words(&mut self, changes: &[(Register, u32)]) -> Result<(), Failure> {
        let mut words = general(&self.output.next.command());
        for (register, value) in changes {
            register.write(&mut words, *value);
        }
        self.output.next.set_command(&words);
        let until = Instant::now() + self.timeout;
        while self.output.last_sent().is_none_or(|sent| sent.command() != words) {
            if !self.is_up || Instant::now() >= until {
                let message = format!("{}: the words did not leave", self.label);
                return Err(Failure::new(Kind::NoAnswer, message).hint("`yrcx io get SIW2` tells what is shown"));
            }
            self.turn_until(until).await?;
        }
        Ok(())
    }
}

//! Continuous output (4.7.4): a remote command that the controller answers repeatedly.

use std::time::Duration;

use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::value::Value;
use tokio::time::Instant;

use super::error::Error;
use super::{Client, CompletedCommand};

/// The controller may set the running status before it sets the data. Until this time after the status, zeros count as
/// missing data.
const DATA_TIMEOUT: Duration = Duration::from_millis(100);

impl Client {
    /// Returns the next values of continuous output (4.7.4). The first call starts the output. The output runs until
    /// another command resets the status, or until the link ends.
    pub async fn next_output(&mut self, order: &Order) -> Result<CompletedCommand, Error> {
        let is_running = self.exchange.as_ref().is_some_and(|exchange| exchange.order() == order);
        if self.is_dry_run() || !is_running {
            self.authorize_command(order.row().id, order.risk())?;
            if self.is_dry_run() {
                return self.ask(order).await;
            }
            self.start(order).await?;
            self.totals.commands += 1;
        }
        let mut pending: Option<(CompletedCommand, Instant)> = None;
        loop {
            if let Some(outcome) = self.ended.take() {
                return self.reply(outcome)?.done(order);
            }
            let now = self.now();
            if let Some(exchange) = &mut self.exchange
                && let Some(Answer::Running(values)) = exchange.running()
            {
                let is_empty = values.iter().all(|(_, value)| *value == Value::Int(0));
                let done = CompletedCommand { values, elapsed: exchange.elapsed(now) };
                if is_running || !is_empty {
                    return Ok(done);
                }
                pending = Some((done, Instant::now() + DATA_TIMEOUT));
            }
            match pending {
                Some((done, until)) if Instant::now() >= until => return Ok(done),
                Some((_, until)) => self.run_until(until).await?,
                None => self.run_turn().await?,
            }
        }
    }
}

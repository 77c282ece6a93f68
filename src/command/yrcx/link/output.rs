//! Continuous output: a remote command whose answer goes on (4.7.4).

use std::time::Duration;

use tokio::time::Instant;

use super::{Done, Link};
use crate::controller::yrcx::answer::Answer;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::value::Value;
use crate::failure::Failure;

/// The run status may come before what is output with it: so long, zeros are taken for that.
const FILLS_WITHIN: Duration = Duration::from_millis(100);

impl Link {
    /// What continuous output shows next (4.7.4). The first call begins it; it goes on until another command, or the end of
    /// the link, ends it with the status reset.
    pub async fn next_output(&mut self, order: &Order) -> Result<Done, Failure> {
        let is_under_way = self.exchange.as_ref().is_some_and(|exchange| exchange.order() == order);
        if self.is_dry() || !is_under_way {
            self.admit(order.row().id, order.risk())?;
            if self.is_dry() {
                return self.run(order).await;
            }
            self.start(order).await?;
            self.totals.commands += 1;
        }
        let mut held: Option<(Done, Instant)> = None;
        loop {
            if let Some(outcome) = self.ended.take() {
                return self.given(order.row(), outcome)?.done(order);
            }
            let now = self.now();
            if let Some(exchange) = &mut self.exchange
                && let Some(Answer::Running(values)) = exchange.running()
            {
                let is_empty = values.iter().all(|(_, value)| *value == Value::Int(0));
                let done = Done { values, elapsed: exchange.elapsed(now), replaced: None };
                if is_under_way || !is_empty {
                    return Ok(done);
                }
                held = Some((done, Instant::now() + FILLS_WITHIN));
            }
            match held {
                Some((done, until)) if Instant::now() >= until => return Ok(done),
                Some((_, until)) => self.turn_until(until).await?,
                None => self.turn().await?,
            }
        }
    }
}

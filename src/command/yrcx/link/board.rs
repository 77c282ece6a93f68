//! A link that asks only the network board.

use serde_json::Value as Json;

use super::{Board, Link, Transport};
use crate::command::frame::dry_run::{Reason, unknown};
use crate::failure::Failure;
use crate::transport::tap::Direction;

impl Link {
    /// The network board, of a link that is for it alone.
    pub fn board(&mut self) -> Result<&mut Board, Failure> {
        match &mut self.transport {
            Transport::Board(board) => Ok(board),
            Transport::Notes(_) => Err(unknown()),
            Transport::Image(_) => Err(Failure::local("this link carries images, not messages")),
        }
    }

    /// Tells at `-vv` what was asked of the board, and what it answered.
    pub fn tell_message(&mut self, sent: &[u8], received: &[u8], about: &str) {
        self.trace.message(Direction::Sent, sent, about);
        self.trace.message(Direction::Received, received, "done");
    }

    /// In a dry run, notes a message, whose answer is not known then.
    pub fn rehearse_frame(&mut self, frame: Json) -> Result<(), Failure> {
        let Transport::Notes(plan) = &mut self.transport else { return Ok(()) };
        plan.note(frame, Reason::default());
        Err(unknown())
    }
}

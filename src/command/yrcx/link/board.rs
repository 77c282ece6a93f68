//! A link that asks only the device on the fieldbus.

use std::any::Any;

use serde_json::Value as Json;

use super::Link;
use crate::command::frame::dry_run::{Reason, unknown};
use crate::command::frame::trace::locked;
use crate::command::yrcx::fieldbus::Board;
use crate::failure::Failure;
use crate::transport::tap::Direction;

impl Link {
    /// The device, of a link that is for it alone, whatever its fieldbus.
    pub fn any_board(&mut self) -> Result<&mut dyn Board, Failure> {
        match &mut self.board {
            Some((board, _)) => Ok(&mut **board),
            None if self.client.is_dry() => Err(unknown()),
            None => Err(Failure::local("this link carries images, not messages")),
        }
    }

    /// The device as this fieldbus knows it.
    pub fn board<B: Board>(&mut self, fieldbus: &str) -> Result<&mut B, Failure> {
        let label = self.label.clone();
        let board: &mut dyn Any = self.any_board()?;
        board.downcast_mut().ok_or_else(|| {
            Failure::usage(format!("{label} is on another fieldbus than {fieldbus}"))
                .hint("`armctl yrcx --help` lists the commands of each fieldbus")
        })
    }

    /// Tells at `-vv` what was asked of the device, and what it answered.
    pub fn tell_message(&mut self, sent: &[u8], received: &[u8], about: &str) {
        let mut trace = locked(&self.trace);
        trace.message(Direction::Sent, sent, about);
        trace.message(Direction::Received, received, "done");
    }

    /// In a dry run, notes a message, whose answer is not known then.
    pub fn plan_frame(&mut self, frame: Json) -> Result<(), Failure> {
        self.client.plan_frame(frame, Reason::default());
        if self.client.is_dry() { Err(unknown()) } else { Ok(()) }
    }
}

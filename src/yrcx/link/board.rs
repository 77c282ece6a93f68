//! Link with only the explicit messaging client.

use std::any::Any;

use serde_json::Value as Json;

use super::Link;
use crate::fieldbus::{Board, BusBoard};
use armctl_frame::dry_run::{Reason, unknown};
use armctl_frame::failure::Failure;
use armctl_frame::trace::lock_writer;
use armctl_transport::tap::Direction;

impl Link {
    /// Explicit messaging client of any fieldbus.
    pub fn any_board(&mut self) -> Result<&mut dyn Board, Failure> {
        match &mut self.board {
            Some((board, _)) => Ok(&mut **board),
            None if self.client.is_dry_run() => Err(unknown()),
            None => Err(Failure::local("internal error: this link carries images, not messages")),
        }
    }

    /// Explicit messaging client of a specific fieldbus.
    pub fn board<B: BusBoard>(&mut self) -> Result<&mut B, Failure> {
        let label = self.label.clone();
        let board: &mut dyn Any = self.any_board()?;
        board.downcast_mut().ok_or_else(|| {
            Failure::usage(format!("{label} is not on {}", B::BUS))
                .hint("use `armctl yrcx --help` to list the commands of each fieldbus")
        })
    }

    /// Rejects `--unit`, because the device of the fieldbus belongs to the whole controller.
    pub fn reject_unit_of<B: BusBoard>(&self) -> Result<(), Failure> {
        self.reject_unit(&format!("the {} belongs to the whole controller", B::DEVICE))
    }

    /// Prints a request and its answer at `-vv`.
    pub fn plan_message_frame(&mut self, sent: &[u8], received: &[u8], about: &str) {
        let mut trace = lock_writer(&self.trace);
        trace.message(Direction::Sent, sent, about);
        trace.message(Direction::Received, received, "done");
    }

    /// Notes a message in a dry run. In a dry run, the answer is unknown.
    pub fn plan_frame(&mut self, frame: Json) -> Result<(), Failure> {
        self.client.plan_frame(frame, Reason::default());
        if self.client.is_dry_run() { Err(unknown()) } else { Ok(()) }
    }
}

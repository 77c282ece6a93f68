//! Trace of the datagrams of a link.

use std::net::SocketAddr;

use crate::prelude::basics::*;
use armctl_controller::yerc::describe::{Sender, summary};
use armctl_controller::yerc::wire::RequestFrame;
use armctl_frame::trace;
use armctl_transport::tap::Direction;

/// Trace of one link.
#[derive(Debug)]
pub struct Trace {
    record: trace::Trace,
    /// Last request. It is stored because an answer does not name its command.
    asked: Option<Request>,
}

impl Trace {
    /// Opens the trace that the options request.
    pub fn open(access: &Access, screen: &Screen) -> Result<Self> {
        Ok(Self { record: trace::Trace::of_network(access, screen)?, asked: None })
    }

    /// Records a datagram. The first address in `ends` is the address of this computer.
    pub fn record(&mut self, direction: Direction, ends: (SocketAddr, SocketAddr), bytes: &[u8]) {
        if self.record.level() > 0 {
            let sender = match direction {
                Direction::Sent => Sender::Client,
                Direction::Received => Sender::Controller,
            };
            self.record.message(direction, &summary(bytes, sender, self.asked.as_ref()), bytes);
            if direction == Direction::Sent {
                self.asked = RequestFrame::parse(bytes).ok().map(Request::from);
            }
        }
        self.record.datagram(direction, ends, bytes);
    }

    /// See [`trace::Trace::answered`].
    pub fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        self.record.answered(exchange);
    }

    /// Closes the trace. Returns a failure if the trace is incomplete.
    pub fn finish(&mut self) -> Result<()> {
        self.record.finish()
    }
}

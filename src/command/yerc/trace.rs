//! Datagrams in the record of the traffic.

use std::net::SocketAddr;

use crate::command::Access;
use crate::command::frame::trace;
use crate::controller::text::hex;
use crate::controller::yerc::describe::{Sender, summary};
use crate::controller::yerc::request::Request;
use crate::controller::yerc::wire::RequestFrame;
use crate::failure::Failure;
use crate::output::Screen;
use crate::transport::tap::Direction;

/// The record of one link.
#[derive(Debug)]
pub struct Trace {
    record: trace::Trace,
    /// The last request: an answer does not repeat what it is about.
    asked: Option<Request>,
}

impl Trace {
    /// As flags want it.
    pub fn open(access: &Access, screen: &Screen) -> Result<Self, Failure> {
        Ok(Self { record: trace::Trace::of_network(access, screen)?, asked: None })
    }

    /// Records a datagram between the two addresses, own one first.
    pub fn record(&mut self, direction: Direction, ends: (SocketAddr, SocketAddr), bytes: &[u8]) {
        if self.record.level() > 0 {
            self.record.line(&self.text(direction, bytes));
            if direction == Direction::Sent {
                self.asked = RequestFrame::parse(bytes).ok().map(Request::from);
            }
        }
        let (from, to) = if direction == Direction::Sent { ends } else { (ends.1, ends.0) };
        self.record.capture(|capture, time| capture.datagram(time, from, to, bytes));
    }

    /// Tells whether the record is whole.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.record.finish()
    }

    fn text(&self, direction: Direction, bytes: &[u8]) -> String {
        let (arrow, sender) = match direction {
            Direction::Sent => ("->", Sender::Client),
            Direction::Received => ("<-", Sender::Controller),
        };
        let line = format!("{arrow} {}", summary(bytes, sender, self.asked.as_ref()));
        if self.record.level() > 1 { format!("{line}\n   {}", hex(bytes)) } else { line }
    }
}

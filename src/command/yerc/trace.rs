//! `--trace` and `-vv`: what goes over the line, as text and as a capture file.

use std::net::SocketAddr;
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

use crate::command::Access;
use crate::controller::text::hex;
use crate::controller::yerc::describe::{Sender, summary};
use crate::controller::yerc::request::Request;
use crate::controller::yerc::wire::RequestFrame;
use crate::failure::{Failure, plain};
use crate::output::Screen;
use crate::transport::tap::{Capture, Direction};

/// Where frames are recorded beside being sent.
#[derive(Debug)]
pub struct Trace {
    screen: Screen,
    /// Text on stderr: 0 nothing, 1 a line a frame, 2 the bytes too.
    text: u8,
    capture: Option<Capture>,
    /// Why the record is not whole.
    broken: Option<Failure>,
    /// The last request: an answer does not repeat what it is about.
    asked: Option<Request>,
}

impl Trace {
    /// As flags want it; a capture file is made at once.
    pub fn open(access: &Access, screen: &Screen) -> Result<Self, Failure> {
        let mut text = screen.verbosity.saturating_sub(1);
        let capture = match access.trace.as_deref() {
            Some(path) if path == Path::new("-") => {
                text = text.max(2);
                None
            }
            Some(path) if !access.dry_run => {
                Some(Capture::append(path).map_err(|error| Failure::io(path.display(), &error))?)
            }
            _ => None,
        };
        Ok(Self { screen: *screen, text, capture, broken: None, asked: None })
    }

    /// Records a datagram between the two addresses, own one first. A full disk ends the record, not the conversation:
    /// a robot may be moving.
    pub fn record(&mut self, direction: Direction, ends: (SocketAddr, SocketAddr), bytes: &[u8]) {
        if self.text > 0 {
            self.screen.note(&self.line(direction, bytes));
        }
        if direction == Direction::Sent && self.text > 0 {
            self.asked = RequestFrame::parse(bytes).ok().map(Request::from);
        }
        let Some(capture) = &mut self.capture else { return };
        let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let (from, to) = if direction == Direction::Sent { ends } else { (ends.1, ends.0) };
        if let Err(error) = capture.datagram(time, from, to, bytes) {
            self.capture = None;
            self.broken = Some(Failure::local(format!("the record of --trace is not whole: {}", plain(&error))));
        }
    }

    /// Tells whether the record is whole.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.broken.take().map_or(Ok(()), Err)
    }

    fn line(&self, direction: Direction, bytes: &[u8]) -> String {
        let (arrow, sender) = match direction {
            Direction::Sent => ("->", Sender::Client),
            Direction::Received => ("<-", Sender::Controller),
        };
        let line = format!("{arrow} {}", summary(bytes, sender, self.asked.as_ref()));
        if self.text > 1 { format!("{line}\n   {}", hex(bytes)) } else { line }
    }
}

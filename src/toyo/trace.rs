//! Trace of the traffic, block by block.

use std::net::SocketAddr;

use crate::prelude::basics::*;
use armctl_controller::toyo::describe::{Sender, summary};
use armctl_frame::trace;
use armctl_transport::tap::Direction;

/// Trace of one link.
#[derive(Debug)]
pub struct Trace {
    record: trace::Trace,
    /// Address of this computer, and address of the device server; `None` without a device server.
    address_pair: Option<(SocketAddr, SocketAddr)>,
    /// Characters that the controller sent since its last line end.
    pending: Vec<u8>,
    /// Last request. It is stored because `@OK` and `@NG` do not name their request.
    last_request: Option<Request>,
}

/// Maximum number of characters in a line of text.
const MAX_LINE_CHARS: usize = 512;

impl Trace {
    /// Opens the trace that the options request. `ends` are the addresses of a TCP connection.
    pub fn open(access: &Access, screen: &Screen, address_pair: Option<(SocketAddr, SocketAddr)>) -> Result<Self> {
        let record = match address_pair {
            Some(_) => trace::Trace::of_network(access, screen)?,
            None => trace::Trace::of_lines(access, screen)?,
        };
        Ok(Self { record, address_pair, pending: Vec::new(), last_request: None })
    }

    /// Records characters.
    pub fn record(&mut self, direction: Direction, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        self.record.piece(direction, self.address_pair, bytes);
        if self.record.level() > 0 {
            match direction {
                Direction::Sent => self.sent(bytes),
                Direction::Received => self.received(bytes),
            }
        }
    }

    /// See [`trace::Trace::pause`].
    pub fn pause(&mut self) {
        self.record.pause();
    }

    /// See [`trace::Trace::resume`].
    pub fn resume(&mut self) {
        self.record.resume();
    }

    /// See [`trace::Trace::answered`].
    pub fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        self.record.answered(exchange);
    }

    /// Closes the trace. Returns a failure if it is incomplete.
    pub fn finish(&mut self) -> Result<()> {
        self.flush();
        self.record.finish()
    }

    /// Writes a request at once, because the client sends whole blocks.
    fn sent(&mut self, bytes: &[u8]) {
        self.flush();
        self.line(Direction::Sent, bytes);
        self.last_request = Request::parse(&text(bytes)).ok();
    }

    /// Characters arrive in pieces of any size, but a line of text must contain a whole block.
    fn received(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.pending.push(*byte);
            if *byte == b'\n' || self.pending.len() >= MAX_LINE_CHARS {
                self.flush();
            }
        }
    }

    /// Prints characters that have no line end yet, before other text follows.
    fn flush(&mut self) {
        let pending = std::mem::take(&mut self.pending);
        if !pending.is_empty() {
            self.line(Direction::Received, &pending);
        }
    }

    fn line(&mut self, direction: Direction, bytes: &[u8]) {
        let sender = match direction {
            Direction::Sent => Sender::Host,
            Direction::Received => Sender::Controller,
        };
        let text = text(bytes);
        let summary = summary(&text, sender, self.last_request.as_ref());
        self.record.message(direction, &format!("{text}  # {summary}"), bytes);
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).trim_end_matches(['\r', '\n']).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::output::{ColorChoice, Format};

    /// Content of a capture file with a request and its answer.
    fn recorded(address_pair: Option<(SocketAddr, SocketAddr)>) -> Vec<u8> {
        let file = tempfile::NamedTempFile::new().unwrap();
        let access = Access { trace: Some(file.path().to_owned()), ..Access::reading(ConnectMode::Control) };
        let mut trace =
            Trace::open(&access, &Screen::new(Format::Json, ColorChoice::Never, true, 0), address_pair).unwrap();
        trace.record(Direction::Sent, b"@HSON\r\n");
        trace.record(Direction::Received, b"");
        trace.record(Direction::Received, b"@OK\r\n");
        trace.finish().unwrap();
        std::fs::read(file.path()).unwrap()
    }

    fn holds(record: &[u8], bytes: &[u8]) -> bool {
        record.windows(bytes.len()).any(|window| window == bytes)
    }

    #[test]
    fn blocks_on_a_serial_line_are_recorded_with_direction() {
        let record = recorded(None);
        assert!(holds(&record, b"\0@HSON\r\n") && holds(&record, b"\x01@OK\r\n"), "{record:?}");
    }

    #[test]
    fn blocks_to_a_device_server_are_recorded_with_addresses_and_ports() {
        let address_pair = ("10.0.0.1:40000".parse().unwrap(), "10.0.0.2:4001".parse().unwrap());
        let record = recorded(Some(address_pair));
        let [sent, received] = [[0x9C, 0x40, 0x0F, 0xA1], [0x0F, 0xA1, 0x9C, 0x40]];
        assert!(holds(&record, &sent) && holds(&record, &received), "{record:?}");
        assert!(holds(&record, b"@HSON\r\n") && holds(&record, b"@OK\r\n"), "{record:?}");
        assert!(!holds(&record, b"\x01@OK\r\n"));
    }
}

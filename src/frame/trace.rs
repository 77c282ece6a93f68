//! `--trace` and `-vv`: traffic as text and as a capture file. Each family supplies the text of its frames.

use std::io;
use std::net::SocketAddr;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

use super::connection::Access;
use crate::failure::plain;
use crate::prelude::basics::*;
use armctl_controller::simulator::recording::AnswerLog;
use armctl_controller::text::hex;
use armctl_transport::tap::{CaptureWriter, Direction};

/// Recording of sent and received data.
#[derive(Debug)]
pub struct Trace {
    screen: Screen,
    /// Text on stderr: 0 is nothing, 1 is one line per frame, 2 is also the bytes.
    level: u8,
    capture: Option<CaptureWriter>,
    /// Text lines that must still be written.
    pending: Option<Vec<String>>,
    /// Reason why the trace is incomplete.
    failure: Option<Failure>,
    answers: Option<AnswerLog>,
}

impl Trace {
    /// Trace of packets with addresses, as the options request it. The capture file is created at once.
    pub fn of_network(access: &Access, screen: &Screen) -> Result<Self> {
        Self::open(access, screen, CaptureWriter::append)
    }

    /// Trace of whole packets with this link type.
    pub fn of_packets(access: &Access, screen: &Screen, link_type: u16) -> Result<Self> {
        Self::open(access, screen, |path| CaptureWriter::append_packets(path, link_type))
    }

    /// Trace of data without addresses.
    pub fn of_lines(access: &Access, screen: &Screen) -> Result<Self> {
        Self::open(access, screen, CaptureWriter::append_streams)
    }

    fn open(access: &Access, screen: &Screen, begin: impl Fn(&Path) -> io::Result<CaptureWriter>) -> Result<Self> {
        let mut level = screen.verbosity.saturating_sub(1);
        let capture = match access.trace.as_deref() {
            Some(path) if path == Path::new("-") => {
                level = level.max(2);
                None
            }
            Some(path) if !access.dry_run => Some(begin(path).with_context(|| path.display().to_string())?),
            _ => None,
        };
        Ok(Self { screen: *screen, level, capture, pending: None, failure: None, answers: access.answers.clone() })
    }

    /// Text that the user requested: 0 is nothing, 1 is one line per frame, 2 is also the bytes.
    pub fn level(&self) -> u8 {
        self.level
    }

    /// Writes a line of text.
    pub fn line(&mut self, direction: Direction, text: &str) {
        let line = format!("{} {text}", direction.arrow());
        match &mut self.pending {
            Some(held) => held.push(line),
            None => self.screen.note(&line),
        }
    }

    /// Writes a line of text, and also its bytes if the user requested them.
    pub fn message(&mut self, direction: Direction, text: &str, bytes: &[u8]) {
        if self.level > 1 {
            self.line(direction, &format!("{text}\n   {}", hex(bytes)));
        } else {
            self.line(direction, text);
        }
    }

    /// Keeps text back until [`Trace::resume`], because stderr can block.
    pub fn pause(&mut self) {
        self.pending.get_or_insert_default();
    }

    /// Writes the text that was kept back.
    pub fn resume(&mut self) {
        for line in self.pending.take().unwrap_or_default() {
            self.screen.note(&line);
        }
    }

    /// Adds a datagram to the capture file. The first address in `ends` is the address of this computer.
    pub fn datagram(&mut self, direction: Direction, ends: (SocketAddr, SocketAddr), bytes: &[u8]) {
        let (from, to) = write_in_order(direction, ends);
        self.capture(|capture, time| capture.datagram(time, from, to, bytes));
    }

    /// Adds a piece of a stream to the capture file: TCP between two addresses (the address of this computer first), or
    /// a serial line.
    pub fn piece(&mut self, direction: Direction, ends: Option<(SocketAddr, SocketAddr)>, bytes: &[u8]) {
        self.capture(|capture, time| match ends.map(|ends| write_in_order(direction, ends)) {
            Some((from, to)) => capture.segment(time, from, to, bytes),
            None => capture.line(time, direction, bytes),
        });
    }

    /// Adds data to the capture file, with the time. A full disk ends the trace but not the communication, because a
    /// robot may be moving.
    pub fn capture(&mut self, add: impl FnOnce(&mut CaptureWriter, Duration) -> io::Result<()>) {
        let Some(capture) = &mut self.capture else { return };
        if let Err(error) = add(capture, now()) {
            self.capture = None;
            self.failure = Some(incomplete(&plain(&error)));
        }
    }

    /// Adds the answer to a read to the log of answers, if there is one.
    pub fn answered(&mut self, exchange: &dyn Fn() -> (String, String)) {
        if let Some(answers) = &self.answers {
            let (request, answer) = exchange();
            answers.insert(request, answer);
        }
    }

    /// Closes the trace. Returns a failure if the trace is incomplete.
    pub fn finish(&mut self) -> Result<()> {
        self.failure.take().map_or(Ok(()), Err)
    }
}

/// Locks data that a link shares with the observer of its client, such as the trace. Each frame is written as a whole,
/// so the data is valid even if a panic has poisoned the lock.
pub fn lock_writer<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Sender and receiver address, in this order.
fn write_in_order(direction: Direction, (own, other): (SocketAddr, SocketAddr)) -> (SocketAddr, SocketAddr) {
    match direction {
        Direction::Sent => (own, other),
        Direction::Received => (other, own),
    }
}

/// Time for the trace: the duration since 1970.
pub fn now() -> Duration {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default()
}

/// Failure: the trace is incomplete.
pub fn incomplete(why: &str) -> Failure {
    Failure::local(format!("the --trace file is incomplete: {why}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ConnectMode;
    use crate::output::{ColorChoice, Format};

    #[test]
    fn buffers_text_while_paused() {
        let access = Access::reading(ConnectMode::Control);
        let screen = Screen::new(Format::Json, ColorChoice::Never, true, 2);
        let mut trace = Trace::of_lines(&access, &screen).unwrap();
        trace.pause();
        trace.line(Direction::Sent, "@HSON");
        trace.message(Direction::Received, "@OK", b"@OK\r\n");
        assert_eq!(trace.pending.as_deref(), Some(&["-> @HSON".to_owned(), "<- @OK".to_owned()][..]));
        trace.resume();
        assert_eq!(trace.pending, None);
    }
}

//! SLCAN adapter on a serial port or behind TCP.

use std::collections::VecDeque;
use std::io;
use std::time::Duration;

use tokio::time::{Instant, sleep_until, timeout_at};

use super::pipe::Pipe;
use super::slcan::{AdapterMessage, Lines, bitrate_command, emit, flag};
use super::{Bitrate, BoxedFuture, BusState, CanPort, Frame, Health, PortError, PortEvent};
use crate::image::tap::{Tap, TrafficRecord};
use crate::tap::Direction;

/// If nothing arrives for this time, all bytes of an earlier use have been read.
const QUIET: Duration = Duration::from_millis(50);
/// Time limit for reading the bytes of an earlier use. The channel is closed at this time, so the adapter adds no new
/// bytes.
const LEFTOVERS: Duration = Duration::from_millis(400);
/// Maximum number of bytes per [`WINDOW`]. A full bus of 500 kbit/s produces 250 kB of text per second. After this
/// computer was suspended, the text of some seconds can arrive at once.
const MAX_UNREAD_BYTES: usize = 8 * 1024 * 1024;
const WINDOW: Duration = Duration::from_secs(1);
/// Maximum number of lines that arrive while a command waits for its answer.
const MAX_PENDING_LINES: usize = 4096;
/// Time limit for the answer to a command.
const ANSWER: Duration = Duration::from_millis(300);
/// Interval of the requests for status flags.
const FLAGS: Duration = Duration::from_secs(1);
/// Maximum number of unwritten bytes. With more bytes, the adapter counts as blocked.
const MAX_UNWRITTEN_BYTES: usize = 16 * 1024;

/// An SLCAN adapter.
#[derive(Debug)]
pub struct SlcanPort {
    path: String,
    pipe: Pipe,
    lines: Lines,
    adapter_messages: VecDeque<AdapterMessage>,
    health: Health,
    /// Time of the next request for status flags; `None` if the adapter does not support the request.
    flags_due: Option<Instant>,
    /// Start of the current window, and the number of bytes received in it.
    received: (Instant, usize),
    /// Whether the adapter has sent anything since its setup.
    has_received: bool,
    /// Records the bytes during the setup of the adapter.
    tap: Tap,
}

impl SlcanPort {
    /// Sets up an adapter: closes the channel, sets the bit rate, and opens the channel (in listen-only mode if
    /// `listens`). `tap` records the commands and answers.
    pub async fn start(path: String, pipe: Pipe, bitrate: Bitrate, listens: bool, tap: Tap) -> Result<Self, PortError> {
        let mut port = Self {
            path,
            pipe,
            lines: Lines::default(),
            adapter_messages: VecDeque::new(),
            health: Health::default(),
            flags_due: None,
            received: (Instant::now(), 0),
            has_received: false,
            tap,
        };
        // The CRs end a line that an earlier use left incomplete.
        port.write(b"\r\r\r")?;
        port.write(b"C\r")?;
        let begun = Instant::now();
        while port.read(Instant::now() + QUIET).await? {
            port.adapter_messages.clear();
            if begun.elapsed() > LEFTOVERS {
                return Err(PortError::Flooded(port.path.clone()));
            }
        }
        port.has_received = false;
        let about = port.ask(b"V\r", |adapter_messages| matches!(adapter_messages, AdapterMessage::About(_))).await?;
        let rate =
            port.ask(bitrate_command(bitrate), |adapter_messages| *adapter_messages == AdapterMessage::Done).await?;
        if rate == Some(AdapterMessage::No) {
            return Err(port.wrong(&format!("the adapter refuses the bit rate {bitrate}")));
        }
        let open = if listens { b"L\r" } else { b"O\r" };
        let opened = port.ask(open, |adapter_messages| *adapter_messages == AdapterMessage::Done).await?;
        match (about, rate, opened) {
            (_, _, Some(AdapterMessage::No)) => {
                let what = if listens { "listen only" } else { "connect to the bus" };
                return Err(port.wrong(&format!("the adapter refuses to {what}")));
            }
            (None, None, None) if port.has_received => {
                return Err(port.wrong("it does not answer as an SLCAN adapter"));
            }
            (None, None, None) => return Err(PortError::Mute(port.path.clone())),
            _ => {}
        }
        if let Some(AdapterMessage::Flags(flags)) =
            port.ask(b"F\r", |adapter_messages| matches!(adapter_messages, AdapterMessage::Flags(_))).await?
        {
            port.read_flags(flags);
            port.flags_due = Some(Instant::now() + FLAGS);
        }
        port.tap = Tap::default();
        Ok(port)
    }

    /// Sends a command and waits for its answer, positive or negative. Frames that arrive before the answer are kept.
    async fn ask(
        &mut self,
        command: &[u8],
        wanted: impl Fn(&AdapterMessage) -> bool,
    ) -> Result<Option<AdapterMessage>, PortError> {
        let mut before = self.adapter_messages.len();
        self.write(command)?;
        let until = Instant::now() + ANSWER;
        loop {
            let is_answer =
                |adapter_messages: &AdapterMessage| wanted(adapter_messages) || *adapter_messages == AdapterMessage::No;
            if let Some(at) =
                (before..self.adapter_messages.len()).find(|at| self.adapter_messages.get(*at).is_some_and(is_answer))
            {
                return Ok(self.adapter_messages.remove(at));
            }
            if self.adapter_messages.len() > MAX_PENDING_LINES {
                self.adapter_messages.clear();
                before = 0;
                self.health.overruns += 1;
            }
            if !self.read(until).await? {
                return Ok(None);
            }
        }
    }

    fn wrong(&self, why: &str) -> PortError {
        PortError::Setup { path: self.path.clone(), why: why.to_owned() }
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), PortError> {
        if self.pipe.writer.waiting() > MAX_UNWRITTEN_BYTES {
            return Err(PortError::Stuck(self.path.clone()));
        }
        self.tap.pass(|| TrafficRecord::Adapter { direction: Direction::Sent, bytes: bytes.to_vec() });
        // If the stream is closed, the next read reports the error.
        self.pipe.writer.write(bytes);
        Ok(())
    }

    /// Reads available bytes. Returns whether bytes arrived in time.
    async fn read(&mut self, until: Instant) -> Result<bool, PortError> {
        // The deadline is checked first. An adapter that never stops sending always has bytes ready.
        if Instant::now() >= until {
            return Ok(false);
        }
        let Ok(read) = timeout_at(until, self.pipe.read()).await else { return Ok(false) };
        self.take(read).map(|()| true)
    }

    fn take(&mut self, read: io::Result<Vec<u8>>) -> Result<(), PortError> {
        let bytes = read.map_err(|error| PortError::Gone { path: self.path.clone(), why: error.to_string() })?;
        self.tap.pass(|| TrafficRecord::Adapter { direction: Direction::Received, bytes: bytes.clone() });
        if self.received.0.elapsed() > WINDOW {
            self.received = (Instant::now(), 0);
        }
        self.received.1 += bytes.len();
        self.has_received |= !bytes.is_empty();
        if self.received.1 > MAX_UNREAD_BYTES {
            return Err(PortError::Flooded(self.path.clone()));
        }
        let Self { lines, adapter_messages, .. } = self;
        adapter_messages
            .extend(bytes.iter().filter_map(|byte| lines.push(*byte)).filter_map(|line| line.adapter_messages()));
        Ok(())
    }

    fn read_flags(&mut self, flags: u8) {
        // SLCAN has no flag for bus-off. An adapter in this state sets all three of these flags.
        const BUS_OFF_FLAGS: u8 = flag::BUS_ERROR | flag::PASSIVE | flag::WARNING;
        self.health.state = match flags {
            _ if flags & BUS_OFF_FLAGS == BUS_OFF_FLAGS => BusState::Off,
            _ if flags & flag::PASSIVE != 0 => BusState::Passive,
            _ if flags & flag::WARNING != 0 => BusState::Warning,
            _ => BusState::Active,
        };
        self.health.overruns += u64::from(flags & (flag::OVERRUN | flag::RECEIVE_FULL) != 0);
        self.health.rejected += u64::from(flags & flag::SEND_FULL != 0);
    }

    async fn wait(&mut self) -> Result<PortEvent, PortError> {
        loop {
            while let Some(adapter_messages) = self.adapter_messages.pop_front() {
                let before = self.health;
                match adapter_messages {
                    AdapterMessage::Frame(frame) => return Ok(PortEvent::Frame(frame)),
                    AdapterMessage::Flags(flags) => self.read_flags(flags),
                    AdapterMessage::No => self.health.rejected += 1,
                    AdapterMessage::Other | AdapterMessage::About(_) | AdapterMessage::Done => {}
                }
                if self.health != before {
                    return Ok(PortEvent::Health(self.health));
                }
            }
            let due = self.flags_due;
            tokio::select! {
                read = self.pipe.read() => self.take(read)?,
                () = async { sleep_until(due.unwrap_or_else(Instant::now)).await }, if due.is_some() => {
                    self.flags_due = Some(Instant::now() + FLAGS);
                    self.write(b"F\r")?;
                }
            }
        }
    }
}

impl CanPort for SlcanPort {
    fn send(&mut self, frame: &Frame) -> Result<(), PortError> {
        self.write(&emit(frame))
    }

    fn next(&mut self) -> BoxedFuture<'_, Result<PortEvent, PortError>> {
        Box::pin(self.wait())
    }

    fn health(&self) -> Health {
        self.health
    }
}

impl Drop for SlcanPort {
    /// Closes the channel. Otherwise the adapter would continue to acknowledge frames.
    fn drop(&mut self) {
        self.pipe.writer.write(b"C\r");
    }
}

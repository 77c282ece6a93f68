//! `--trace` and `-vv`: what goes over the line, as text and as a capture file. Each family has words of its own for it.

use std::io;
use std::path::Path;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use super::Access;
use crate::failure::{Failure, plain};
use crate::output::Screen;
use crate::transport::tap::Capture;

/// Where traffic is recorded beside being sent.
#[derive(Debug)]
pub struct Trace {
    screen: Screen,
    /// Text on stderr: 0 nothing, 1 a line a frame, 2 the bytes too.
    level: u8,
    capture: Option<Capture>,
    /// Why the record is not whole.
    broken: Option<Failure>,
}

impl Trace {
    /// Of packets with addresses, as flags want it; a capture file is made at once.
    pub fn of_network(access: &Access, screen: &Screen) -> Result<Self, Failure> {
        Self::open(access, screen, Capture::append)
    }

    /// The same of whole packets of a kind, by its number in capture files.
    pub fn of_packets(access: &Access, screen: &Screen, link_type: u16) -> Result<Self, Failure> {
        Self::open(access, screen, |path| Capture::append_packets(path, link_type))
    }

    /// The same of lines without addresses.
    pub fn of_lines(access: &Access, screen: &Screen) -> Result<Self, Failure> {
        Self::open(access, screen, Capture::append_streams)
    }

    fn open(access: &Access, screen: &Screen, begin: impl Fn(&Path) -> io::Result<Capture>) -> Result<Self, Failure> {
        let mut level = screen.verbosity.saturating_sub(1);
        let capture = match access.trace.as_deref() {
            Some(path) if path == Path::new("-") => {
                level = level.max(2);
                None
            }
            Some(path) if !access.dry_run => Some(begin(path).map_err(|error| Failure::io(path.display(), &error))?),
            _ => None,
        };
        Ok(Self { screen: *screen, level, capture, broken: None })
    }

    /// How much text is wanted: 0 nothing, 1 a line a frame, 2 the bytes too.
    pub fn level(&self) -> u8 {
        self.level
    }

    /// Writes text.
    pub fn line(&self, text: &str) {
        self.screen.note(text);
    }

    /// Adds to the capture file, with the time. A full disk ends the record, not the conversation: a robot may be moving.
    pub fn capture(&mut self, add: impl FnOnce(&mut Capture, Duration) -> io::Result<()>) {
        let Some(capture) = &mut self.capture else { return };
        let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        if let Err(error) = add(capture, time) {
            self.capture = None;
            self.broken = Some(Failure::local(format!("the record of --trace is not whole: {}", plain(&error))));
        }
    }

    /// Tells whether the record is whole.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.broken.take().map_or(Ok(()), Err)
    }
}

//! Blocks in the record of the traffic.

use crate::command::{Access, trace};
use crate::controller::text::hex;
use crate::failure::Failure;
use crate::output::Screen;
use crate::transport::tap::Direction;

/// The record of one link.
#[derive(Debug)]
pub struct Trace {
    record: trace::Trace,
    /// Characters of the controller since its last line end.
    coming: Vec<u8>,
}

/// Longest piece that is kept for a line of text.
const MOST: usize = 512;

impl Trace {
    /// As flags want it.
    pub fn open(access: &Access, screen: &Screen) -> Result<Self, Failure> {
        Ok(Self { record: trace::Trace::open(access, screen)?, coming: Vec::new() })
    }

    /// Records characters.
    pub fn record(&mut self, direction: Direction, bytes: &[u8]) {
        if bytes.is_empty() {
            return;
        }
        if self.record.level() > 0 {
            match direction {
                Direction::Sent => self.line("->", bytes),
                Direction::Received => self.received(bytes),
            }
        }
    }

    /// Tells whether the record is whole.
    pub fn finish(&mut self) -> Result<(), Failure> {
        self.record.finish()
    }

    /// Characters come in pieces of any size; a line of text is for a whole block.
    fn received(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.coming.push(*byte);
            if *byte == b'\n' || self.coming.len() >= MOST {
                let coming = std::mem::take(&mut self.coming);
                self.line("<-", &coming);
            }
        }
    }

    fn line(&self, arrow: &str, bytes: &[u8]) {
        let text = String::from_utf8_lossy(bytes);
        let line = format!("{arrow} {}", text.trim_end_matches(['\r', '\n']));
        self.record.line(&if self.record.level() > 1 { format!("{line}\n   {}", hex(bytes)) } else { line });
    }
}

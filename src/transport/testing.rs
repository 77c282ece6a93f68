//! Helpers for tests of transports.

use std::collections::VecDeque;
use std::time::Duration;

use tokio::time::Instant;

use super::sim::Peer;

/// Returns a deadline that no successful operation reaches.
pub fn soon() -> Instant {
    Instant::now() + Duration::from_secs(60)
}

/// Bytes from hexadecimal digits; all other characters are separators.
pub fn hex(text: &str) -> Vec<u8> {
    let digits: Vec<u8> = text.bytes().filter(u8::is_ascii_hexdigit).collect();
    let byte = |pair: &[u8]| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap();
    digits.chunks(2).map(byte).collect()
}

/// A peer that reverses each line and returns it without delay. It records the bytes that it receives.
#[derive(Debug, Default)]
pub struct Mirror {
    pub line: Vec<u8>,
    pub heard: Vec<(Duration, Vec<u8>)>,
    pub damaged: usize,
    pub answers: VecDeque<Vec<u8>>,
}

impl Peer for Mirror {
    fn receive(&mut self, now: Duration, _channel: usize, bytes: &[u8]) {
        for byte in bytes {
            self.line.push(*byte);
            if *byte == b'\n' {
                let mut line = std::mem::take(&mut self.line);
                self.heard.push((now, line.clone()));
                line.reverse();
                self.answers.push_back(line);
            }
        }
    }

    fn damaged(&mut self, _now: Duration, _channel: usize) {
        self.damaged += 1;
    }

    fn transmit(&mut self, _now: Duration) -> Option<(usize, Vec<u8>)> {
        self.answers.pop_front().map(|answer| (0, answer))
    }

    fn wake(&self) -> Option<Duration> {
        // All answers are due at once.
        (!self.answers.is_empty()).then_some(Duration::ZERO)
    }
}

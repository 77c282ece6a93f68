//! Messages in the order of their packets: those of a TCP stream that overtook each other are heard late.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::transport::capture::{Carrier, Message};

/// Bytes of messages that may wait for earlier ones. What waits longer comes out of turn.
const ROOM: usize = 16 << 20;

/// Puts messages in order.
#[derive(Debug, Default)]
pub struct Order {
    /// How many packets a message may be late.
    lag: u64,
    newest: u64,
    count: u64,
    waiting: BTreeMap<(u64, u64), Waiting>,
    bytes: usize,
}

#[derive(Debug)]
struct Waiting {
    time: Duration,
    carrier: Carrier,
    bytes: Vec<u8>,
    is_cut: bool,
}

impl Order {
    /// For messages that are so many packets late at most.
    pub fn new(lag: u64) -> Self {
        Self { lag, ..Self::default() }
    }

    /// Takes a message, and hands on those whose turn it is.
    pub fn take(&mut self, message: &Message<'_>, mut hear: impl FnMut(&Message<'_>)) {
        if self.lag == 0 {
            return hear(message);
        }
        self.newest = self.newest.max(message.number);
        self.count += 1;
        self.bytes += message.bytes.len() + size_of::<Waiting>();
        let Message { number, time, carrier, bytes, is_cut } = *message;
        self.waiting.insert((number, self.count), Waiting { time, carrier, bytes: bytes.to_vec(), is_cut });
        while let Some(first) = self.waiting.first_entry()
            && (first.key().0 + self.lag <= self.newest || self.bytes > ROOM)
        {
            self.bytes -= first.get().bytes.len() + size_of::<Waiting>();
            let ((number, _), waiting) = first.remove_entry();
            waiting.hand_on(number, &mut hear);
        }
    }

    /// Hands on the rest.
    pub fn finish(self, mut hear: impl FnMut(&Message<'_>)) {
        for ((number, _), waiting) in self.waiting {
            waiting.hand_on(number, &mut hear);
        }
    }
}

impl Waiting {
    fn hand_on(&self, number: u64, hear: &mut impl FnMut(&Message<'_>)) {
        let Self { time, carrier, bytes, is_cut } = self;
        hear(&Message { number, time: *time, carrier: *carrier, bytes, is_cut: *is_cut });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transport::tap::Direction;

    #[test]
    fn late_messages_come_in_their_turn() {
        let carrier = Carrier::Line { direction: Direction::Sent, section: 0 };
        let mut heard = Vec::new();
        let mut order = Order::new(3);
        for (number, byte) in [(1, 1), (2, 2), (5, 5), (3, 3), (3, 4), (9, 9), (6, 6)] {
            let message = Message { number, time: Duration::ZERO, carrier, bytes: &[byte], is_cut: false };
            order.take(&message, |message| heard.push(message.bytes[0]));
        }
        assert_eq!(heard, [1, 2, 3, 4, 5, 6]);
        order.finish(|message| heard.push(message.bytes[0]));
        assert_eq!(heard.last(), Some(&9));
    }
}

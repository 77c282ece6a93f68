//! In-process CAN bus with bit timing and arbitration. The bus has no clock: the caller passes the time.

use std::collections::VecDeque;
use std::time::Duration;

use super::{Bitrate, Frame};

/// A CAN bus.
#[derive(Debug)]
pub struct Bus {
    bitrate: Bitrate,
    queues: Vec<VecDeque<(Duration, Frame)>>,
    /// Time when the last frame ended.
    idle_since: Duration,
    /// Frame that is being sent: time of its end, its sender, the frame.
    current: Option<(Duration, usize, Frame)>,
    /// Total transmission time of all frames.
    busy: Duration,
}

/// A transmitted frame. All nodes except the sender receive it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TransmittedFrame {
    /// Time at which the last bit of the frame ends.
    pub at: Duration,
    /// Node that sent the frame.
    pub from: usize,
    /// The frame.
    pub frame: Frame,
}

impl Bus {
    /// Creates a bus with `nodes` nodes.
    pub fn new(bitrate: Bitrate, nodes: usize) -> Self {
        let queues = vec![VecDeque::new(); nodes];
        Self { bitrate, queues, idle_since: Duration::ZERO, current: None, busy: Duration::ZERO }
    }

    /// Queues a frame of a node.
    pub fn send(&mut self, now: Duration, node: usize, frame: Frame) {
        if let Some(queue) = self.queues.get_mut(node) {
            queue.push_back((now, frame));
        }
    }

    /// Returns the next frame that was complete at `now`. The caller repeats the call until it returns `None`.
    pub fn pass(&mut self, now: Duration) -> Option<TransmittedFrame> {
        self.arbitrate(now);
        let (at, from, frame) = self.current.filter(|(end, ..)| *end <= now)?;
        self.current = None;
        self.idle_since = at;
        Some(TransmittedFrame { at, from, frame })
    }

    /// Time when the next frame is complete; `None` if no frame is waiting.
    pub fn wake(&self) -> Option<Duration> {
        let first =
            || self.queues.iter().filter_map(|queue| queue.front().map(|(at, _)| (*at).max(self.idle_since))).min();
        self.current.map(|(end, ..)| end).or_else(first)
    }

    /// Total time that the bus was in use.
    pub const fn busy(&self) -> Duration {
        self.busy
    }

    /// Starts the next frame if the bus is free. The waiting frame with the lowest identifier is sent first
    /// (arbitration).
    fn arbitrate(&mut self, now: Duration) {
        if self.current.is_some() {
            return;
        }
        let begin =
            self.queues.iter().filter_map(|queue| queue.front().map(|(at, _)| (*at).max(self.idle_since))).min();
        let Some(begin) = begin.filter(|begin| *begin <= now) else { return };
        let waiting = self.queues.iter().enumerate().filter_map(|(node, queue)| {
            queue.front().filter(|(at, _)| *at <= begin).map(|(_, frame)| (frame.id(), node))
        });
        let Some((_, node)) = waiting.min() else { return };
        if let Some((_, frame)) = self.queues.get_mut(node).and_then(VecDeque::pop_front) {
            let time = frame.time(self.bitrate);
            self.busy += time;
            self.current = Some((begin + time, node, frame));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lowest_identifier_wins_arbitration() {
        let frame = |id| Frame::new(id, &[0x55; 8]).unwrap();
        let mut bus = Bus::new(Bitrate::K500, 3);
        bus.send(Duration::ZERO, 0, frame(0x42D));
        bus.send(Duration::ZERO, 1, frame(0x3C5));
        bus.send(Duration::from_micros(1), 2, frame(0x001));
        let all = Duration::from_secs(1);
        let transmitted: Vec<TransmittedFrame> = std::iter::from_fn(|| bus.pass(all)).collect();
        let ids: Vec<u16> = transmitted.iter().map(|transmitted| transmitted.frame.id()).collect();
        // Frame 001 was queued after the transmission of frame 3C5 had started, so it is sent second.
        assert_eq!(ids, [0x3C5, 0x001, 0x42D]);
        assert_eq!(transmitted[0].at, frame(0x3C5).time(Bitrate::K500));
        assert_eq!(transmitted[2].at, bus.busy());
        assert_eq!(bus.wake(), None);
    }

    #[test]
    fn frames_take_their_transmission_time() {
        let frame = Frame::new(0x42D, &[]).unwrap();
        let mut bus = Bus::new(Bitrate::K125, 2);
        bus.send(Duration::from_millis(1), 0, frame);
        assert_eq!(bus.wake(), Some(Duration::from_millis(1)));
        assert_eq!(bus.pass(Duration::from_millis(1)), None);
        let end = Duration::from_millis(1) + frame.time(Bitrate::K125);
        assert_eq!(bus.wake(), Some(end));
        assert_eq!(bus.pass(end).map(|transmitted| transmitted.from), Some(0));
    }
}

//! Passive monitor: reassembles the images between a master and its slaves.

use std::collections::BTreeMap;

use super::Now;
use super::can::Frame;
use super::wire::{Assembler, Fragment, Id, Kind, Mac, Piece};

/// Size in bytes of an image that is sent in fragments. Images of any other size are sent in a single frame.
const WHOLE: usize = 48;
/// Size in bytes of an image in a single frame.
const BARE: usize = 4;

/// An image seen on the bus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Seen {
    /// Time of the last frame of the image.
    pub at: Now,
    /// Bytes of the image.
    pub image: Vec<u8>,
}

/// Traffic of a slave and its master, as seen on the bus.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Sight {
    /// The newest image to the slave.
    pub output: Option<Seen>,
    /// The newest image from the slave.
    pub input: Option<Seen>,
    /// Time of the last frame from the slave.
    pub heard: Option<Now>,
    /// Time of the last frame from the master of the slave.
    pub asked: Option<Now>,
}

impl Sight {
    /// Whether images were seen in both directions.
    pub const fn is_whole(&self) -> bool {
        self.output.is_some() && self.input.is_some()
    }
}

/// Passive monitor of a bus.
#[derive(Debug, Default)]
pub struct Monitor {
    slaves: BTreeMap<Mac, Slave>,
}

#[derive(Debug)]
struct Slave {
    output: Assembler,
    input: Assembler,
    sight: Sight,
}

impl Default for Slave {
    fn default() -> Self {
        Self { output: Assembler::new(WHOLE), input: Assembler::new(WHOLE), sight: Sight::default() }
    }
}

impl Monitor {
    /// Handles a frame. If the frame completes an image, returns the slave, whether the image comes from the slave, and
    /// the image.
    pub fn hear(&mut self, now: Now, frame: &Frame) -> Option<(Mac, bool, Vec<u8>)> {
        let (mac, is_input) = match Id::parse(frame.id())? {
            Id::Poll(mac) => (mac, false),
            Id::PollAnswer(mac) => (mac, true),
            Id::Answer(mac) => {
                self.slaves.entry(mac).or_default().sight.heard = Some(now);
                return None;
            }
            Id::Request(mac) | Id::Unconnected(mac) => {
                self.slaves.entry(mac).or_default().sight.asked = Some(now);
                return None;
            }
            _ => return None,
        };
        let slave = self.slaves.entry(mac).or_default();
        *(if is_input { &mut slave.sight.heard } else { &mut slave.sight.asked }) = Some(now);
        let assembler = if is_input { &mut slave.input } else { &mut slave.output };
        let image = match frame.data() {
            // As a fragment, a frame of this length would be the last fragment of a 45-byte image. No image has 45
            // bytes, so the frame is a 4-byte image.
            data @ [_, _, _, _] if data.len() == BARE && !assembler.is_partial() => data.to_vec(),
            data => match assembler.take(data) {
                Piece::Whole(image) => image,
                Piece::Part | Piece::Idle | Piece::Wrong => return None,
            },
        };
        let seen = Some(Seen { at: now, image: image.clone() });
        *(if is_input { &mut slave.sight.input } else { &mut slave.sight.output }) = seen;
        Some((mac, is_input, image))
    }

    /// Returns the last traffic of a slave and its master.
    pub fn sight(&self, slave: Mac) -> Sight {
        self.slaves.get(&slave).map(|slave| slave.sight.clone()).unwrap_or_default()
    }

    /// Slaves whose traffic was seen.
    pub fn slaves(&self) -> Vec<Mac> {
        self.slaves.keys().copied().collect()
    }
}

/// Describes a frame for traces, for example `MAC 5: poll by the master, fragment 0 (first)`.
pub fn describe(frame: &Frame) -> String {
    let Some(id) = Id::parse(frame.id()) else { return format!("{:03X}: not a DeviceNet identifier", frame.id()) };
    let mut text = id.to_string();
    if let (Id::Poll(_) | Id::PollAnswer(_), [first, _, _, _, _, ..]) = (id, frame.data()) {
        let Fragment { kind, count } = Fragment::parse(*first);
        let kind = match kind {
            Kind::First => "first",
            Kind::Middle => "middle",
            Kind::Last => "last",
            Kind::Acknowledge => "acknowledge",
        };
        text.push_str(&format!(", fragment {count} ({kind})"));
    }
    text
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::devicenet::wire::split;

    fn frames(id: u16, image: &[u8]) -> Vec<Frame> {
        split(image).iter().map(|bytes| Frame::new(id, bytes).unwrap()).collect()
    }

    #[test]
    fn both_images_are_put_together() {
        let mac = Mac::new(5).unwrap();
        for size in [48u8, 4] {
            let mut monitor = Monitor::default();
            let (out, back): (Vec<u8>, Vec<u8>) = ((0..size).collect(), (0..size).rev().collect());
            for frame in frames(0x42D, &out).iter().chain(&frames(0x3C5, &back)) {
                monitor.hear(Now::ZERO, frame);
            }
            let sight = monitor.sight(mac);
            assert!(sight.is_whole());
            assert_eq!((sight.output.unwrap().image, sight.input.unwrap().image), (out, back));
            assert_eq!(monitor.slaves(), [mac]);
        }
        assert_eq!(Monitor::default().sight(mac), Sight::default());
    }

    proptest! {
        #[test]
        fn no_frames_panic(frames in proptest::collection::vec((0u16..0x800, proptest::collection::vec(any::<u8>(), 0..=8)), 0..60)) {
            let mut monitor = Monitor::default();
            for (id, data) in frames {
                let frame = Frame::new(id, &data).unwrap();
                let _ = (monitor.hear(Now::ZERO, &frame), describe(&frame));
            }
        }
    }
}

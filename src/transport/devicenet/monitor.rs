//! Passive monitor: reassembles the images between a master and its slaves.

use std::collections::BTreeMap;

use super::Now;
use super::can::Frame;
use super::wire::{Assembler, AssemblyResult, Fragment, Id, Kind, Mac};

/// Size in bytes of an image that is sent in fragments. Images of any other size are sent in a single frame.
const WHOLE: usize = 48;
/// Size in bytes of an image in a single frame.
const BARE: usize = 4;

/// An image seen on the bus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ObservedImage {
    /// Time of the last frame of the image.
    pub at: Now,
    /// Bytes of the image.
    pub image: Vec<u8>,
}

/// Traffic of a slave and its master, as seen on the bus.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LastTraffic {
    /// The newest image to the slave.
    pub output: Option<ObservedImage>,
    /// The newest image from the slave.
    pub input: Option<ObservedImage>,
    /// Time of the last frame from the slave.
    pub slave_seen_at: Option<Now>,
    /// Time of the last frame from the master of the slave.
    pub master_seen_at: Option<Now>,
}

impl LastTraffic {
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
    last_traffic: LastTraffic,
}

impl Default for Slave {
    fn default() -> Self {
        Self { output: Assembler::new(WHOLE), input: Assembler::new(WHOLE), last_traffic: LastTraffic::default() }
    }
}

impl Monitor {
    /// Handles a frame. If the frame completes an image, returns the slave, whether the image comes from the slave, and
    /// the image.
    pub fn handle_frame(&mut self, now: Now, frame: &Frame) -> Option<(Mac, bool, Vec<u8>)> {
        let (mac, is_input) = match Id::parse(frame.id())? {
            Id::Poll(mac) => (mac, false),
            Id::PollAnswer(mac) => (mac, true),
            Id::Answer(mac) => {
                self.slaves.entry(mac).or_default().last_traffic.slave_seen_at = Some(now);
                return None;
            }
            Id::Request(mac) | Id::Unconnected(mac) => {
                self.slaves.entry(mac).or_default().last_traffic.master_seen_at = Some(now);
                return None;
            }
            _ => return None,
        };
        let slave = self.slaves.entry(mac).or_default();
        *(if is_input { &mut slave.last_traffic.slave_seen_at } else { &mut slave.last_traffic.master_seen_at }) =
            Some(now);
        let assembler = if is_input { &mut slave.input } else { &mut slave.output };
        let image = match frame.data() {
            // As a fragment, a frame of this length would be the last fragment of a 45-byte image. No image has 45
            // bytes, so the frame is a 4-byte image.
            data @ [_, _, _, _] if data.len() == BARE && !assembler.is_partial() => data.to_vec(),
            data => match assembler.take(data) {
                AssemblyResult::Whole(image) => image,
                AssemblyResult::Part | AssemblyResult::Idle | AssemblyResult::Wrong => return None,
            },
        };
        let seen = Some(ObservedImage { at: now, image: image.clone() });
        *(if is_input { &mut slave.last_traffic.input } else { &mut slave.last_traffic.output }) = seen;
        Some((mac, is_input, image))
    }

    /// Returns the last traffic of a slave and its master.
    pub fn last_traffic(&self, slave: Mac) -> LastTraffic {
        self.slaves.get(&slave).map(|slave| slave.last_traffic.clone()).unwrap_or_default()
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
    fn assembles_both_images() {
        let mac = Mac::new(5).unwrap();
        for size in [48u8, 4] {
            let mut monitor = Monitor::default();
            let (out, back): (Vec<u8>, Vec<u8>) = ((0..size).collect(), (0..size).rev().collect());
            for frame in frames(0x42D, &out).iter().chain(&frames(0x3C5, &back)) {
                monitor.handle_frame(Now::ZERO, frame);
            }
            let last_traffic = monitor.last_traffic(mac);
            assert!(last_traffic.is_whole());
            assert_eq!((last_traffic.output.unwrap().image, last_traffic.input.unwrap().image), (out, back));
            assert_eq!(monitor.slaves(), [mac]);
        }
        assert_eq!(Monitor::default().last_traffic(mac), LastTraffic::default());
    }

    proptest! {
        #[test]
        fn no_frames_panic(frames in proptest::collection::vec((0u16..0x800, proptest::collection::vec(any::<u8>(), 0..=8)), 0..60)) {
            let mut monitor = Monitor::default();
            for (id, data) in frames {
                let frame = Frame::new(id, &data).unwrap();
                let _ = (monitor.handle_frame(Now::ZERO, &frame), describe(&frame));
            }
        }
    }
}

//! Codec for cyclic data: a single frame if the image fits, otherwise unacknowledged fragments.

use super::{Fragment, Kind};
use crate::devicenet::can::MAX_DATA;

/// Data bytes per fragment.
const FRAGMENT_DATA: usize = MAX_DATA - 1;

/// Splits an image into frames. The length of the image must be the size of the connection.
pub fn split(image: &[u8]) -> Vec<Vec<u8>> {
    if image.len() <= MAX_DATA {
        return vec![image.to_vec()];
    }
    let pieces = image.len().div_ceil(FRAGMENT_DATA);
    let piece = |(index, part): (usize, &[u8])| {
        let mut bytes = vec![Fragment::of(index, pieces).emit()];
        bytes.extend(part);
        bytes
    };
    image.chunks(FRAGMENT_DATA).enumerate().map(piece).collect()
}

/// Effect of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AssemblyResult {
    /// The image is complete.
    Whole(Vec<u8>),
    /// More fragments follow.
    Part,
    /// An empty frame: the sender is in idle mode.
    Idle,
    /// The frame has a wrong count or size. The partial image is dropped.
    Wrong,
}

/// Reassembly of the images of a connection of known size. After a missing frame, all frames up to the next first
/// fragment are dropped.
#[derive(Debug, Clone)]
pub struct Assembler {
    size: usize,
    parts: Vec<u8>,
    /// Expected count of the next fragment; `None` before a first fragment.
    next: Option<u8>,
}

impl Assembler {
    /// Creates an assembler for images of `size` bytes.
    pub const fn new(size: usize) -> Self {
        Self { size, parts: Vec::new(), next: None }
    }

    /// Whether an image is partially received.
    pub const fn is_partial(&self) -> bool {
        self.next.is_some()
    }

    /// Handles the data of a frame.
    pub fn take(&mut self, bytes: &[u8]) -> AssemblyResult {
        let Some((first, part)) = bytes.split_first() else {
            self.next = None;
            return AssemblyResult::Idle;
        };
        if self.size <= MAX_DATA {
            return if bytes.len() == self.size {
                AssemblyResult::Whole(bytes.to_vec())
            } else {
                AssemblyResult::Wrong
            };
        }
        let Fragment { kind, count } = Fragment::parse(*first);
        let expected = self.next.take();
        match kind {
            // A first fragment starts a new image, even if the last image is incomplete. But if two first fragments
            // follow each other, the next fragments may belong to either image. In this case, both images are dropped.
            Kind::First if count == 0 && part.len() < self.size && expected != Some(1) => {
                self.parts = part.to_vec();
                self.next = Some(1);
                AssemblyResult::Part
            }
            Kind::Middle if expected == Some(count) && self.parts.len() + part.len() < self.size => {
                self.parts.extend(part);
                self.next = Some((count + 1) % 64);
                AssemblyResult::Part
            }
            Kind::Last if expected == Some(count) && self.parts.len() + part.len() == self.size => {
                self.parts.extend(part);
                AssemblyResult::Whole(std::mem::take(&mut self.parts))
            }
            _ => AssemblyResult::Wrong,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn an_image_of_48_bytes_takes_seven_frames() {
        let image: Vec<u8> = (0..48).collect();
        let frames = split(&image);
        let heads: Vec<(u8, usize)> = frames.iter().map(|frame| (frame[0], frame.len() - 1)).collect();
        assert_eq!(heads, [(0x00, 7), (0x41, 7), (0x42, 7), (0x43, 7), (0x44, 7), (0x45, 7), (0x86, 6)]);
        let mut assembler = Assembler::new(48);
        for frame in &frames[..6] {
            assert_eq!(assembler.take(frame), AssemblyResult::Part);
        }
        assert_eq!(assembler.take(&frames[6]), AssemblyResult::Whole(image));
    }

    /// A faulty adapter may change the order of frames. The rest of an image could then follow an older first fragment.
    #[test]
    fn two_first_fragments_in_a_row_are_dropped() {
        let (older, newer) = (split(&[1; 48]), split(&[2; 48]));
        let mut assembler = Assembler::new(48);
        let mixed = [&newer[..1], &older[..1], &newer[1..]].concat();
        assert!(mixed.iter().all(|frame| !matches!(assembler.take(frame), AssemblyResult::Whole(_))));
        let last = newer.iter().map(|frame| assembler.take(frame)).last();
        assert_eq!(last, Some(AssemblyResult::Whole(vec![2; 48])));
    }

    #[test]
    fn image_of_4_bytes_is_not_fragmented() {
        assert_eq!(split(&[1, 2, 3, 4]), [[1, 2, 3, 4]]);
        let mut assembler = Assembler::new(4);
        assert_eq!(assembler.take(&[1, 2, 3, 4]), AssemblyResult::Whole(vec![1, 2, 3, 4]));
        assert_eq!(assembler.take(&[1, 2, 3]), AssemblyResult::Wrong);
        assert_eq!(assembler.take(&[]), AssemblyResult::Idle);
    }

    /// A lost, doubled or exchanged frame damages only its own image.
    #[test]
    fn drops_a_damaged_image_and_accepts_the_next() {
        let image: Vec<u8> = (0..48).collect();
        let frames = split(&image);
        for at in 0..7 {
            let mut damaged = Vec::new();
            let mut lost = frames.clone();
            lost.remove(at);
            damaged.push(lost);
            let mut doubled = frames.clone();
            doubled.insert(at, frames[at].clone());
            damaged.push(doubled);
            if at < 6 {
                let mut swapped = frames.clone();
                swapped.swap(at, at + 1);
                damaged.push(swapped);
            }
            for frames_in in damaged {
                let mut assembler = Assembler::new(48);
                for frame in &frames_in {
                    match assembler.take(frame) {
                        // Only a doubled first or last fragment still gives a complete image.
                        AssemblyResult::Whole(got) => assert_eq!(got, image),
                        AssemblyResult::Part | AssemblyResult::Wrong => {}
                        AssemblyResult::Idle => panic!("no frame was empty"),
                    }
                }
                let whole = frames.iter().map(|frame| assembler.take(frame)).last();
                assert_eq!(whole, Some(AssemblyResult::Whole(image.clone())), "{at} {frames_in:?}");
            }
        }
    }

    proptest! {
        #[test]
        fn images_of_any_size_round_trip(image in proptest::collection::vec(any::<u8>(), 1..600)) {
            let mut assembler = Assembler::new(image.len());
            let last = split(&image).iter().map(|frame| assembler.take(frame)).last();
            prop_assert_eq!(last, Some(AssemblyResult::Whole(image)));
        }

        #[test]
        fn no_frames_panic_or_give_another_size(
            size in 0usize..64,
            frames in proptest::collection::vec(proptest::collection::vec(any::<u8>(), 0..=8), 0..40),
        ) {
            let mut assembler = Assembler::new(size);
            for frame in frames {
                if let AssemblyResult::Whole(image) = assembler.take(&frame) {
                    prop_assert_eq!(image.len(), size);
                }
            }
        }
    }
}

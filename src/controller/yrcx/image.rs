//! Process image (chapter 1, section 1): 16 command words, 7 words of bits, one reserved word.

use crate::Now;

/// Number of words of a remote command or its answer: WI0 to WI15, WO0 to WO15.
pub const COMMAND_WORDS: usize = 16;

/// Number of words of the whole image, including the reserved word.
pub const IMAGE_WORDS: usize = 24;

/// Word of the dedicated signals (SI(00) to SI(17), SO(00) to SO(17)).
pub const DEDICATED_WORD: usize = 16;

/// Byte offset of the signals in the image.
const SIGNALS_AT: usize = DEDICATED_WORD * 2;

/// Words of a remote command or of its answer: WI0 to WI15, or WO0 to WO15.
pub type Words = [u16; COMMAND_WORDS];

/// Image of one direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Image(pub [u16; IMAGE_WORDS]);

impl Image {
    /// Size of an image in bytes.
    pub const BYTES: usize = IMAGE_WORDS * 2;

    /// Decodes an image of exactly [`Self::BYTES`] bytes, low byte first.
    pub fn from_bytes(bytes: &[u8]) -> Option<Self> {
        let bytes: &[u8; Self::BYTES] = bytes.try_into().ok()?;
        let mut words = [0; IMAGE_WORDS];
        for (word, pair) in words.iter_mut().zip(bytes.chunks_exact(2)) {
            *word = u16::from_le_bytes([pair[0], pair[1]]);
        }
        Some(Self(words))
    }

    /// Encodes the image, low byte first.
    pub fn to_bytes(self) -> [u8; Self::BYTES] {
        let mut bytes = [0; Self::BYTES];
        for (pair, word) in bytes.chunks_exact_mut(2).zip(self.0) {
            pair.copy_from_slice(&word.to_le_bytes());
        }
        bytes
    }

    /// Size in bytes of an image with signals only (DeviceNet, I/O size "Compact"): the words of the dedicated signals
    /// and of the first 16 general-purpose signals.
    pub const SIGNAL_BYTES: usize = 4;

    /// Whether an image of this size contains remote commands.
    pub const fn has_commands(bytes: usize) -> bool {
        bytes >= Self::BYTES
    }

    /// Decodes link data. The data is a whole image, perhaps with more data after it, or only signals. In the second
    /// case, all other words are 0.
    pub fn from_link(bytes: &[u8]) -> Option<Self> {
        if bytes.len() != Self::SIGNAL_BYTES {
            return Self::from_bytes(bytes.get(..Self::BYTES)?);
        }
        let mut whole = [0; Self::BYTES];
        whole[SIGNALS_AT..SIGNALS_AT + Self::SIGNAL_BYTES].copy_from_slice(bytes);
        Self::from_bytes(&whole)
    }

    /// Encodes the image as link data of this size. Bytes after the image are 0.
    pub fn to_link(self, bytes: usize) -> Vec<u8> {
        let whole = self.to_bytes();
        if bytes == Self::SIGNAL_BYTES {
            return whole[SIGNALS_AT..SIGNALS_AT + Self::SIGNAL_BYTES].to_vec();
        }
        let mut link = whole.to_vec();
        link.resize(bytes, 0);
        link
    }

    /// The words of the remote command.
    pub fn command(&self) -> Words {
        let mut words = [0; COMMAND_WORDS];
        words.copy_from_slice(&self.0[..COMMAND_WORDS]);
        words
    }

    /// Replaces the words of the remote command. The bits stay unchanged.
    pub fn set_command(&mut self, words: &Words) {
        self.0[..COMMAND_WORDS].copy_from_slice(words);
    }
}

/// Output image of the master, with a record of what was sent and when.
///
/// The driver sends [`next`](Self::next) cyclically, and calls [`sent`](Self::sent) after each sending. Sessions change
/// `next` and check what was sent: a command word must not be sent before its data, and edges of inputs need a minimum
/// interval.
#[derive(Debug, Clone, Default)]
pub struct Output {
    /// Image to send in the next cycle.
    pub next: Image,
    sent: Option<Image>,
    /// Time of the last change of each word after the command words.
    edges: [Option<Now>; IMAGE_WORDS - COMMAND_WORDS],
}

impl Output {
    /// Starts with `image`, which has not been sent yet.
    pub fn new(image: Image) -> Self {
        Self { next: image, ..Self::default() }
    }

    /// Records that `next` was sent at `now`.
    pub fn sent(&mut self, now: Now) {
        for (at, edge) in (COMMAND_WORDS..).zip(&mut self.edges) {
            // In the first image, the controller sees every word as a possible change.
            if self.sent.is_none_or(|sent| sent.0[at] != self.next.0[at]) {
                *edge = Some(now);
            }
        }
        self.sent = Some(self.next);
    }

    /// Records that another client of the same image changed the bits under `mask` at `now`.
    pub fn changed(&mut self, now: Now, mask: &Image, value: &Image) {
        for (at, mask) in mask.0.iter().enumerate() {
            let bits = |word: u16| (word & !mask) | (value.0[at] & mask);
            self.next.0[at] = bits(self.next.0[at]);
            if let Some(sent) = &mut self.sent {
                let before = sent.0[at];
                sent.0[at] = bits(before);
                if sent.0[at] != before
                    && let Some(edge) = at.checked_sub(COMMAND_WORDS).and_then(|at| self.edges.get_mut(at))
                {
                    *edge = Some(now);
                }
            }
        }
    }

    /// Records that the link is down. For the controller, the next image is then a first image.
    pub fn unlinked(&mut self) {
        self.sent = None;
    }

    /// The last sent image; `None` before the first image and while the link is down.
    pub fn last_sent(&self) -> Option<&Image> {
        self.sent.as_ref()
    }

    /// Time of the last change of a word (16 to 23).
    pub fn last_edge(&self, word: usize) -> Option<Now> {
        self.edges.get(word.checked_sub(COMMAND_WORDS)?).copied().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_low_byte_comes_first() {
        // Examples of chapter 2, 1.1: the text "12" in WI4 is 0x3231; the number 0x01234567 from WI4 on is 0x4567,
        // 0x0123.
        let mut image = Image::default();
        image.0[4] = 0x3231;
        let bytes = image.to_bytes();
        assert_eq!(&bytes[8..10], b"12");
        assert_eq!(Image::from_bytes(&bytes), Some(image));
        assert_eq!(Image::from_bytes(&bytes[..47]), None);
        assert_eq!(Image::from_bytes(&[0; 50]), None);
    }

    #[test]
    fn accepts_an_image_of_signals_only() {
        // DeviceNet, I/O size Compact: word 0 contains the dedicated signals, word 1 the first general-purpose signals.
        let mut image = Image::default();
        (image.0[0], image.0[DEDICATED_WORD], image.0[17], image.0[18]) = (1, 0x0041, 0x8001, 7);
        assert_eq!(image.to_link(4), [0x41, 0, 0x01, 0x80]);
        let read = Image::from_link(&[0x41, 0, 0x01, 0x80]).unwrap();
        assert_eq!((read.0[0], read.0[DEDICATED_WORD], read.0[17], read.0[18]), (0, 0x0041, 0x8001, 0));
        assert_eq!(Image::from_link(&image.to_link(50)), Some(image));
        assert_eq!((image.to_link(50).len(), Image::from_link(&[0; 47])), (50, None));
        assert!(Image::has_commands(48) && !Image::has_commands(4));
    }

    #[test]
    fn keeps_changes_of_other_clients() {
        let at = Duration::from_millis;
        let mut output = Output::default();
        output.sent(at(1));
        output.next.0[DEDICATED_WORD] = 0b100;
        let (mut mask, mut value) = (Image::default(), Image::default());
        (mask.0[DEDICATED_WORD], value.0[DEDICATED_WORD]) = (0b011, 0b101);
        output.changed(at(2), &mask, &value);
        assert_eq!(output.next.0[DEDICATED_WORD], 0b101, "what waits to leave stays");
        assert_eq!(output.last_sent().unwrap().0[DEDICATED_WORD], 0b001);
        assert_eq!((output.last_edge(DEDICATED_WORD), output.last_edge(17)), (Some(at(2)), Some(at(1))));
    }

    #[test]
    fn edges_are_counted_per_word() {
        let at = Duration::from_millis;
        let mut output = Output::default();
        output.sent(at(1));
        assert_eq!(output.last_edge(DEDICATED_WORD), Some(at(1)), "the first image is an edge");
        output.next.0[0] = 1;
        output.next.0[17] = 1;
        output.sent(at(2));
        assert_eq!(output.last_edge(DEDICATED_WORD), Some(at(1)));
        assert_eq!(output.last_edge(17), Some(at(2)));
        output.next.0[DEDICATED_WORD] = 1;
        assert_eq!(output.last_sent().unwrap().0[DEDICATED_WORD], 0);
        output.sent(at(3));
        assert_eq!(output.last_edge(DEDICATED_WORD), Some(at(3)));
        assert_eq!((output.last_edge(0), output.last_edge(24)), (None, None));
    }
}

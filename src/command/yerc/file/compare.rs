//! A transfer against a local file, block by block and without holding either.

use super::content::Pieces;
use crate::failure::Failure;

/// How two files compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Comparison {
    /// Size of the controller's.
    pub controller_bytes: u64,
    /// Size of the local one.
    pub local_bytes: u64,
    /// Where the first difference is, counted from 0; the shorter size if one is the beginning of the other.
    pub first_difference: Option<u64>,
}

/// A comparison under way.
#[derive(Debug)]
pub struct Comparer<'a> {
    pieces: Pieces<'a>,
    /// Local bytes that have been read and not compared yet, from `at` on.
    ahead: Vec<u8>,
    at: usize,
    so_far: Comparison,
    local_ended: bool,
    /// What is left out of either side.
    without: Option<[WithoutDate; 2]>,
}

/// The lines of a job without `///DATE`, which a controller writes anew when it stores a job.
#[derive(Debug, Default)]
pub struct WithoutDate {
    at: LineState,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum LineState {
    /// Before a line.
    #[default]
    Start,
    /// After so many bytes of a line, which are those of the one left out.
    Begun(usize),
    Kept,
    Dropped,
}

const DATE: &[u8] = b"///DATE";

impl WithoutDate {
    /// What stays of the next bytes.
    pub fn take(&mut self, piece: &[u8]) -> Vec<u8> {
        let mut kept = Vec::with_capacity(piece.len());
        for &byte in piece {
            let begun = match self.at {
                LineState::Start => Some(0),
                LineState::Begun(count) => Some(count),
                LineState::Kept | LineState::Dropped => None,
            };
            if let Some(count) = begun {
                if DATE.get(count) == Some(&byte) {
                    self.at = if count + 1 == DATE.len() { LineState::Dropped } else { LineState::Begun(count + 1) };
                    continue;
                }
                kept.extend_from_slice(DATE.get(..count).unwrap_or_default());
                self.at = LineState::Kept;
            }
            if self.at == LineState::Kept {
                kept.push(byte);
            }
            if byte == b'\n' {
                self.at = LineState::Start;
            }
        }
        kept
    }

    /// What stays at the end.
    pub fn rest(&mut self) -> &'static [u8] {
        match std::mem::take(&mut self.at) {
            LineState::Begun(count) => DATE.get(..count).unwrap_or_default(),
            LineState::Start | LineState::Kept | LineState::Dropped => &[],
        }
    }

    /// What stays of all of it.
    pub fn of(whole: &[u8]) -> Vec<u8> {
        let mut filter = Self::default();
        let mut kept = filter.take(whole);
        kept.extend_from_slice(filter.rest());
        kept
    }
}

impl<'a> Comparer<'a> {
    /// Compares with a local file from its beginning; on request without the lines that controllers rewrite, which then
    /// count neither as differences nor as bytes.
    pub fn new(pieces: Pieces<'a>, ignore_header: bool) -> Self {
        let so_far = Comparison { controller_bytes: 0, local_bytes: 0, first_difference: None };
        Self {
            pieces,
            ahead: Vec::new(),
            at: 0,
            so_far,
            local_ended: false,
            without: ignore_header.then(Default::default),
        }
    }

    /// Takes the next bytes of the controller's file.
    pub fn take(&mut self, block: &[u8]) -> Result<(), Failure> {
        match &mut self.without {
            Some([theirs, _]) => {
                let kept = theirs.take(block);
                self.compare(&kept)
            }
            None => self.compare(block),
        }
    }

    fn compare(&mut self, mut block: &[u8]) -> Result<(), Failure> {
        while !block.is_empty() {
            self.fill()?;
            let ahead = self.ahead.get(self.at..).unwrap_or_default();
            let size = if self.local_ended { block.len() } else { block.len().min(ahead.len()) };
            let (theirs, rest) = block.split_at(size);
            let ours = ahead.get(..size).unwrap_or_default();
            let same = theirs.iter().zip(ours).take_while(|(a, b)| a == b).count();
            if same < size {
                let at = self.so_far.controller_bytes.saturating_add(same as u64);
                self.so_far.first_difference.get_or_insert(at);
            }
            self.so_far.controller_bytes = self.so_far.controller_bytes.saturating_add(size as u64);
            self.at += ours.len();
            block = rest;
        }
        Ok(())
    }

    /// The result, after the last block.
    pub fn finish(mut self) -> Result<Comparison, Failure> {
        let rest = self.without.as_mut().map_or(&[][..], |[theirs, _]| theirs.rest());
        self.compare(rest)?;
        self.fill()?;
        if !self.local_ended {
            self.so_far.first_difference.get_or_insert(self.so_far.controller_bytes);
        }
        while !self.local_ended {
            self.at = self.ahead.len();
            self.fill()?;
        }
        Ok(self.so_far)
    }

    fn fill(&mut self) -> Result<(), Failure> {
        if self.at < self.ahead.len() || self.local_ended {
            return Ok(());
        }
        self.at = 0;
        loop {
            let piece = self.pieces.next_piece()?;
            self.local_ended = piece.is_empty();
            self.ahead = match &mut self.without {
                Some([_, ours]) if self.local_ended => ours.rest().to_vec(),
                Some([_, ours]) => ours.take(&piece),
                None => piece,
            };
            if self.local_ended || !self.ahead.is_empty() {
                break;
            }
        }
        // What a filter held back comes before the end.
        self.local_ended = self.ahead.is_empty();
        self.so_far.local_bytes = self.so_far.local_bytes.saturating_add(self.ahead.len() as u64);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::super::content::Content;
    use super::*;

    fn compared(local: &[u8], blocks: &[&[u8]]) -> Comparison {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(local).unwrap();
        let mut content = Content::open_any(file.path()).unwrap();
        let mut comparer = Comparer::new(content.pieces().unwrap(), false);
        for block in blocks {
            comparer.take(block).unwrap();
        }
        comparer.finish().unwrap()
    }

    #[test]
    fn the_first_difference_is_found_wherever_it_is() {
        for (local, blocks, difference) in [
            (&b"abcdef"[..], vec![&b"abc"[..], b"def"], None),
            (b"", vec![], None),
            (b"abcdef", vec![b"abc", b"dxx"], Some(4)),
            (b"abcdef", vec![b"abcd"], Some(4)),
            (b"abc", vec![b"ab", b"cd"], Some(3)),
            (b"", vec![b"a"], Some(0)),
            (b"a", vec![], Some(0)),
            (b"xb", vec![b"a", b"x"], Some(0)),
        ] {
            let theirs: usize = blocks.iter().map(|block| block.len()).sum();
            let expected = Comparison {
                controller_bytes: theirs as u64,
                local_bytes: local.len() as u64,
                first_difference: difference,
            };
            assert_eq!(compared(local, &blocks), expected, "{local:?} {blocks:?}");
        }
    }

    #[test]
    fn long_files_are_compared_across_pieces() {
        let local: Vec<u8> = (0..100_000u32).map(|n| n.to_le_bytes()[0]).collect();
        let mut other = local.clone();
        other[70_000] ^= 1;
        let blocks: Vec<&[u8]> = other.chunks(479).collect();
        assert_eq!(compared(&local, &blocks).first_difference, Some(70_000));
        let blocks: Vec<&[u8]> = local.chunks(479).collect();
        assert_eq!(compared(&local, &blocks).first_difference, None);
    }

    #[test]
    fn the_date_of_a_job_can_be_left_out() {
        let job = |date: &str| format!("/JOB\r\n//INST\r\n{date}///ATTR SC,RW\r\nNOP\r\nEND\r\n///DA").into_bytes();
        let (old, new) = (job("///DATE 2026/03/14 08:00\r\n"), job("///DATE 2026/11/22 11:00\r\n"));
        assert_eq!(WithoutDate::of(&old), job(""));
        for (theirs, ours) in [(&old, &new), (&old, &job("")), (&job(""), &new)] {
            let mut file = tempfile::NamedTempFile::new().unwrap();
            file.write_all(ours).unwrap();
            let mut content = Content::open_any(file.path()).unwrap();
            for size in [1, 7, 479] {
                let mut comparer = Comparer::new(content.pieces().unwrap(), true);
                theirs.chunks(size).for_each(|block| comparer.take(block).unwrap());
                let found = comparer.finish().unwrap();
                let bytes = job("").len() as u64;
                let expected = Comparison { controller_bytes: bytes, local_bytes: bytes, first_difference: None };
                assert_eq!(found, expected);
            }
        }
    }
}

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
}

impl<'a> Comparer<'a> {
    /// Compares with a local file from its beginning.
    pub fn new(pieces: Pieces<'a>) -> Self {
        let so_far = Comparison { controller_bytes: 0, local_bytes: 0, first_difference: None };
        Self { pieces, ahead: Vec::new(), at: 0, so_far, local_ended: false }
    }

    /// Takes the next bytes of the controller's file.
    pub fn take(&mut self, mut block: &[u8]) -> Result<(), Failure> {
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
        self.ahead = self.pieces.next_piece()?;
        self.at = 0;
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
        let mut comparer = Comparer::new(content.pieces().unwrap());
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
}

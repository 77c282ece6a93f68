//! Comparison of a transfer with a local file, block by block, with neither file in memory.

use super::content::Pieces;
use crate::command::backup::job_date::DateFilter;
use crate::command::backup::manifest::Hash;
use crate::failure::Failure;

/// Result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Comparison {
    /// Size of the controller's file.
    pub controller_bytes: u64,
    /// Size of the local file.
    pub local_bytes: u64,
    /// Offset of the first difference; the shorter size if one file is the start of the other.
    pub first_difference: Option<u64>,
    /// Whether the ignored dates differ.
    pub dates_differ: bool,
}

/// Comparison in progress.
#[derive(Debug)]
pub struct Comparer<'a> {
    pieces: Pieces<'a>,
    /// Local bytes that are not compared yet, starting at `at`.
    ahead: Vec<u8>,
    at: usize,
    so_far: Comparison,
    local_ended: bool,
    /// Date filters of both sides.
    without: Option<[DateFilter; 2]>,
}

impl<'a> Comparer<'a> {
    /// Starts a comparison with a local file. On request, it ignores the lines that controllers rewrite.
    pub fn new(pieces: Pieces<'a>, ignore_header: bool) -> Self {
        let so_far = Comparison { controller_bytes: 0, local_bytes: 0, first_difference: None, dates_differ: false };
        Self {
            pieces,
            ahead: Vec::new(),
            at: 0,
            so_far,
            local_ended: false,
            without: ignore_header.then(Default::default),
        }
    }

    /// Compares the next bytes of the controller's file.
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

    /// Result after the last block, with the hash of the local file.
    pub fn finish(mut self) -> Result<(Comparison, Hash), Failure> {
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
        if let Some([theirs, ours]) = &self.without {
            let Comparison { controller_bytes, local_bytes, first_difference, dates_differ } = &mut self.so_far;
            *dates_differ = theirs.left_out() != ours.left_out();
            *first_difference = first_difference.map(|at| theirs.is_complete(at));
            *controller_bytes = controller_bytes.saturating_add(theirs.is_date_left_out());
            *local_bytes = local_bytes.saturating_add(ours.is_date_left_out());
        }
        Ok((self.so_far, self.pieces.hash))
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
        // Bytes that the filter held back are compared before the end.
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
    use crate::command::backup::job_date::align_files;

    fn compared(local: &[u8], blocks: &[&[u8]]) -> Comparison {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(local).unwrap();
        let mut content = Content::open_any(file.path()).unwrap();
        let mut comparer = Comparer::new(content.pieces().unwrap(), false);
        for block in blocks {
            comparer.take(block).unwrap();
        }
        comparer.finish().unwrap().0
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
                dates_differ: false,
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
    fn a_difference_behind_the_date_is_told_where_it_is() {
        let (theirs, ours) = (b"/JOB\r\n///DATE 2026\r\nNOP\r\n", b"/JOB\r\n///DATE 27\r\nNOW\r\n");
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(ours).unwrap();
        let mut content = Content::open_any(file.path()).unwrap();
        let mut comparer = Comparer::new(content.pieces().unwrap(), true);
        comparer.take(theirs).unwrap();
        assert_eq!(comparer.finish().unwrap().0.first_difference, Some(22));
        let ([old, new], dates_differ) = align_files(theirs.to_vec(), ours.to_vec());
        assert_eq!((&old[..], &new[..], dates_differ), (&theirs[..], &b"/JOB\r\n///DATE 2026\r\nNOW\r\n"[..], true));
    }

    #[test]
    fn the_date_of_a_job_can_be_left_out() {
        let job = |date: &str| format!("/JOB\r\n//INST\r\n{date}///ATTR SC,RW\r\nNOP\r\nEND\r\n///DA").into_bytes();
        let (old, new) = (job("///DATE 2026/03/14 08:00\r\n"), job("///DATE 2026/11/22 11:00\r\n"));
        assert_eq!(DateFilter::align(&old), job(""));
        for (theirs, ours, dates_differ) in
            [(&old, &new, true), (&old, &job(""), true), (&job(""), &new, true), (&old, &old, false)]
        {
            let mut file = tempfile::NamedTempFile::new().unwrap();
            file.write_all(ours).unwrap();
            let mut content = Content::open_any(file.path()).unwrap();
            for size in [1, 7, 479] {
                let mut comparer = Comparer::new(content.pieces().unwrap(), true);
                theirs.chunks(size).for_each(|block| comparer.take(block).unwrap());
                let found = comparer.finish().unwrap().0;
                let expected = Comparison {
                    controller_bytes: theirs.len() as u64,
                    local_bytes: ours.len() as u64,
                    first_difference: None,
                    dates_differ,
                };
                assert_eq!(found, expected);
            }
        }
    }
}

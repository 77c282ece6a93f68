//! Compares a transfer with a local file, block by block. Neither file is completely in memory.

use super::content::ContentReader;
use armctl_frame::backup::job_date::DateFilter;
use armctl_frame::backup::manifest::Hash;
use armctl_frame::failure::Failure;

/// Result of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Comparison {
    /// Size of the controller's file.
    pub controller_bytes: u64,
    /// Size of the local file.
    pub local_bytes: u64,
    /// Offset of the first difference. If one file is the start of the other, the size of the shorter file.
    pub first_difference: Option<u64>,
    /// Whether the ignored date lines differ.
    pub dates_differ: bool,
}

/// Comparison in progress.
#[derive(Debug)]
pub struct Comparer<'a> {
    pieces: ContentReader<'a>,
    /// Bytes of the local file that are not compared yet. They start at offset `at`.
    buffered: Vec<u8>,
    offset: usize,
    comparison: Comparison,
    local_ended: bool,
    /// Filters that remove the date lines, for the controller's file and the local file.
    date_filter: Option<[DateFilter; 2]>,
}

impl<'a> Comparer<'a> {
    /// Starts a comparison with a local file. With `ignore_header`, lines that controllers rewrite are ignored.
    pub fn new(pieces: ContentReader<'a>, ignore_header: bool) -> Self {
        let comparison =
            Comparison { controller_bytes: 0, local_bytes: 0, first_difference: None, dates_differ: false };
        Self {
            pieces,
            buffered: Vec::new(),
            offset: 0,
            comparison,
            local_ended: false,
            date_filter: ignore_header.then(Default::default),
        }
    }

    /// Compares the next bytes of the controller's file.
    pub fn take(&mut self, block: &[u8]) -> Result<(), Failure> {
        match &mut self.date_filter {
            Some([theirs, _]) => {
                let kept = theirs.take(block);
                self.compare(&kept)
            }
            None => self.compare(block),
        }
    }

    fn compare(&mut self, mut block: &[u8]) -> Result<(), Failure> {
        while !block.is_empty() {
            self.fill_buffer()?;
            let ahead = self.buffered.get(self.offset..).unwrap_or_default();
            let size = if self.local_ended { block.len() } else { block.len().min(ahead.len()) };
            let (theirs, rest) = block.split_at(size);
            let local_bytes = ahead.get(..size).unwrap_or_default();
            let same = theirs.iter().zip(local_bytes).take_while(|(a, b)| a == b).count();
            if same < size {
                let at = self.comparison.controller_bytes.saturating_add(same as u64);
                self.comparison.first_difference.get_or_insert(at);
            }
            self.comparison.controller_bytes = self.comparison.controller_bytes.saturating_add(size as u64);
            self.offset += local_bytes.len();
            block = rest;
        }
        Ok(())
    }

    /// Result after the last block, and the hash of the local file.
    pub fn finish(mut self) -> Result<(Comparison, Hash), Failure> {
        let rest = self.date_filter.as_mut().map_or(&[][..], |[theirs, _]| theirs.rest());
        self.compare(rest)?;
        self.fill_buffer()?;
        if !self.local_ended {
            self.comparison.first_difference.get_or_insert(self.comparison.controller_bytes);
        }
        while !self.local_ended {
            self.offset = self.buffered.len();
            self.fill_buffer()?;
        }
        if let Some([theirs, ours]) = &self.date_filter {
            let Comparison { controller_bytes, local_bytes, first_difference, dates_differ } = &mut self.comparison;
            *dates_differ = theirs.left_out() != ours.left_out();
            *first_difference = first_difference.map(|at| theirs.is_complete(at));
            *controller_bytes = controller_bytes.saturating_add(theirs.is_date_left_out());
            *local_bytes = local_bytes.saturating_add(ours.is_date_left_out());
        }
        Ok((self.comparison, self.pieces.hash))
    }

    fn fill_buffer(&mut self) -> Result<(), Failure> {
        if self.offset < self.buffered.len() || self.local_ended {
            return Ok(());
        }
        self.offset = 0;
        loop {
            let piece = self.pieces.next_piece()?;
            self.local_ended = piece.is_empty();
            self.buffered = match &mut self.date_filter {
                Some([_, ours]) if self.local_ended => ours.rest().to_vec(),
                Some([_, ours]) => ours.take(&piece),
                None => piece,
            };
            if self.local_ended || !self.buffered.is_empty() {
                break;
            }
        }
        // Bytes that the date filter kept back are compared before the end.
        self.local_ended = self.buffered.is_empty();
        self.comparison.local_bytes = self.comparison.local_bytes.saturating_add(self.buffered.len() as u64);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write as _;

    use super::super::content::Content;
    use super::*;
    use armctl_frame::backup::job_date::align_files;

    fn compared(local: &[u8], blocks: &[&[u8]]) -> Comparison {
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(local).unwrap();
        let mut content = Content::open_file(file.path()).unwrap();
        let mut comparer = Comparer::new(content.pieces().unwrap(), false);
        for block in blocks {
            comparer.take(block).unwrap();
        }
        comparer.finish().unwrap().0
    }

    #[test]
    fn finds_the_first_difference_everywhere() {
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
    fn compares_long_files_across_pieces() {
        let local: Vec<u8> = (0..100_000u32).map(|n| n.to_le_bytes()[0]).collect();
        let mut other = local.clone();
        other[70_000] ^= 1;
        let blocks: Vec<&[u8]> = other.chunks(479).collect();
        assert_eq!(compared(&local, &blocks).first_difference, Some(70_000));
        let blocks: Vec<&[u8]> = local.chunks(479).collect();
        assert_eq!(compared(&local, &blocks).first_difference, None);
    }

    #[test]
    fn reports_the_offset_of_a_difference_after_the_date() {
        let (theirs, ours) = (b"/JOB\r\n///DATE 2026\r\nNOP\r\n", b"/JOB\r\n///DATE 27\r\nNOW\r\n");
        let mut file = tempfile::NamedTempFile::new().unwrap();
        file.write_all(ours).unwrap();
        let mut content = Content::open_file(file.path()).unwrap();
        let mut comparer = Comparer::new(content.pieces().unwrap(), true);
        comparer.take(theirs).unwrap();
        assert_eq!(comparer.finish().unwrap().0.first_difference, Some(22));
        let ([old, new], dates_differ) = align_files(theirs.to_vec(), ours.to_vec());
        assert_eq!((&old[..], &new[..], dates_differ), (&theirs[..], &b"/JOB\r\n///DATE 2026\r\nNOW\r\n"[..], true));
    }

    #[test]
    fn can_ignore_the_date_of_a_job() {
        let job = |date: &str| format!("/JOB\r\n//INST\r\n{date}///ATTR SC,RW\r\nNOP\r\nEND\r\n///DA").into_bytes();
        let (old, new) = (job("///DATE 2026/03/14 08:00\r\n"), job("///DATE 2026/11/22 11:00\r\n"));
        assert_eq!(DateFilter::align(&old), job(""));
        for (theirs, ours, dates_differ) in
            [(&old, &new, true), (&old, &job(""), true), (&job(""), &new, true), (&old, &old, false)]
        {
            let mut file = tempfile::NamedTempFile::new().unwrap();
            file.write_all(ours).unwrap();
            let mut content = Content::open_file(file.path()).unwrap();
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

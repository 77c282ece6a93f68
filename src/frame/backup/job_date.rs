//! Filter for the line `///DATE` of a job, which a controller rewrites each time it stores the job.

/// Filter that removes the line `///DATE` from a job.
#[derive(Debug, Default)]
pub struct DateFilter {
    at: LineState,
    left_out: Vec<u8>,
    kept_len: u64,
    dropped: u64,
    /// Offset of the first removed line in the remaining bytes.
    cut: Option<u64>,
}

#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
enum LineState {
    /// At the start of a line.
    #[default]
    Start,
    /// Inside a line, after this number of bytes that match the prefix.
    Incomplete(usize),
    Other,
    Date,
}

/// Prefix of the removed line.
pub const DATE_LINE: &str = "///DATE";
const DATE: &[u8] = DATE_LINE.as_bytes();
/// Maximum number of removed bytes to keep, enough to distinguish dates.
const MAX_LEFT_OUT: usize = 256;

impl DateFilter {
    /// Remaining bytes of the next piece.
    pub fn take(&mut self, piece: &[u8]) -> Vec<u8> {
        let mut kept = Vec::with_capacity(piece.len());
        for &byte in piece {
            let begun = match self.at {
                LineState::Start => Some(0),
                LineState::Incomplete(count) => Some(count),
                LineState::Other | LineState::Date => None,
            };
            if let Some(count) = begun {
                if DATE.get(count) == Some(&byte) {
                    self.at = LineState::Incomplete(count + 1);
                    if count + 1 == DATE.len() {
                        self.at = LineState::Date;
                        self.dropped = self.dropped.saturating_add(DATE.len() as u64);
                        self.cut.get_or_insert(self.kept_len.saturating_add(kept.len() as u64));
                    }
                    continue;
                }
                kept.extend_from_slice(DATE.get(..count).unwrap_or_default());
                self.at = LineState::Other;
            }
            match self.at {
                LineState::Other => kept.push(byte),
                LineState::Date => {
                    self.dropped = self.dropped.saturating_add(1);
                    if self.left_out.len() < MAX_LEFT_OUT {
                        self.left_out.push(byte);
                    }
                }
                LineState::Start | LineState::Incomplete(_) => {}
            }
            if byte == b'\n' {
                self.at = LineState::Start;
            }
        }
        self.kept_len = self.kept_len.saturating_add(kept.len() as u64);
        kept
    }

    /// Number of bytes removed so far.
    pub fn is_date_left_out(&self) -> u64 {
        self.dropped
    }

    /// Offset in the original of a remaining byte.
    pub fn is_complete(&self, at: u64) -> u64 {
        if self.cut.is_some_and(|cut| cut <= at) { at.saturating_add(self.dropped) } else { at }
    }

    /// Remaining bytes at the end.
    pub fn rest(&mut self) -> &'static [u8] {
        match std::mem::take(&mut self.at) {
            LineState::Incomplete(count) => DATE.get(..count).unwrap_or_default(),
            LineState::Start | LineState::Other | LineState::Date => &[],
        }
    }

    /// Removed bytes so far: the dates.
    pub fn left_out(&self) -> &[u8] {
        &self.left_out
    }

    /// Remaining bytes of a whole file.
    pub fn align(whole: &[u8]) -> Vec<u8> {
        let mut filter = Self::default();
        let mut kept = filter.take(whole);
        kept.extend_from_slice(filter.rest());
        kept
    }
}

/// Returns both jobs with the date of the first job, so that line numbers stay valid. Also returns whether the dates
/// differed. If only one job has a date, that date is removed.
pub fn align_files(old: Vec<u8>, new: Vec<u8>) -> ([Vec<u8>; 2], bool) {
    let dates = |text: &[u8]| -> Vec<Vec<u8>> {
        lines(text).filter(|line| line.starts_with(DATE)).map(<[u8]>::to_vec).collect()
    };
    let (before, after) = (dates(&old), dates(&new));
    if before == after {
        return ([old, new], false);
    }
    if before.len() != after.len() {
        return ([DateFilter::align(&old), DateFilter::align(&new)], true);
    }
    let mut before = before.into_iter();
    let mut with_date =
        |line: &[u8]| if line.starts_with(DATE) { before.next() } else { None }.unwrap_or_else(|| line.to_vec());
    let new = lines(&new).flat_map(&mut with_date).collect();
    ([old, new], true)
}

fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    text.split_inclusive(|byte| *byte == b'\n')
}

//! Test support: a capture file in memory.

use super::{Capture, CaptureDecoder, Detail, MEMORY_LIMIT, Selection, Source};
use crate::failure::Failure;

fn complete_capture<D: CaptureDecoder>(
    file: &[u8],
    selection: &Selection,
    decoder: D,
) -> Result<Capture<D::Field>, Failure> {
    let source = Source { name: "file", open: || Ok(file), selection };
    let (capture, _) = source.capture(decoder, MEMORY_LIMIT, Detail::Fields)?;
    Ok(capture.expect("there is room"))
}

/// Number of messages and of packets without a message; `None` for a file that is not a capture of this family.
pub fn message_count<D: CaptureDecoder>(file: &[u8], selection: &Selection, decoder: D) -> Option<(usize, u64)> {
    let capture = complete_capture(file, selection, decoder).ok()?;
    // Views must accept any content.
    capture.list();
    capture.details();
    Some((capture.messages.len(), capture.other_packets))
}

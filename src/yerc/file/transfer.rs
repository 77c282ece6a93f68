//! File and list transfers over the link. Each way in which a transfer can end has its own message.

use super::compare::Comparer;
use super::content::Content;
use crate::failure::refusal_failure;
use crate::link::Refusal;
use crate::prelude::*;
use armctl_controller::yerc::files;
use armctl_controller::yerc::files::split_list;
use armctl_controller::yerc::session::{DownloadEnd, UploadEnd};
use armctl_controller::yerc::table::service;
use armctl_controller::yerc::wire::Status;
use armctl_frame::backup::manifest::Hash;
pub use armctl_frame::items::describe_request;
use armctl_frame::local_names::Target;
use armctl_frame::output::progress::Progress;

/// Maximum size of a file from a controller. Real files have a few megabytes.
const MAX_FILE: u64 = 1 << 30;
/// Maximum size of a list. It is large enough for some hundred thousand names.
const MAX_LIST: u64 = 4 << 20;

/// Added status: no file of the requested type (DX 3.1).
const NOTHING_LISTED: u32 = 0xE2A7;
/// Added status: the file does not exist or is empty (DX 3.1).
const NO_FILE_OR_EMPTY: u32 = 0xE29C;
/// Added status: a job with this name exists.
const JOB_EXISTS: &str = "0x4030";

/// Reads the file names of one type, in the order of the controller.
pub async fn list(link: &mut Link, kind: FileType) -> Result<Vec<Vec<u8>>> {
    list_by(link, &files::list(kind)).await
}

/// Reads the file names that answer this list request.
pub async fn list_by(link: &mut Link, request: &Request) -> Result<Vec<Vec<u8>>> {
    let mut data = Vec::new();
    let end = link
        .download(request, MAX_LIST, None, |piece| {
            data.extend_from_slice(piece);
            Ok(())
        })
        .await?;
    match end {
        DownloadEnd::Finished => Ok(Vec::new()),
        DownloadEnd::Nothing(status) | DownloadEnd::Refused { status, bytes: 0 } if status.added == NOTHING_LISTED => {
            Ok(Vec::new())
        }
        end => {
            name_taken(service::LIST, &end)?;
            let names = split_list(&data).map_err(|error| {
                Failure::new(Kind::Malformed, error.to_string())
                    .hint("record the transfer with --trace and report the problem")
            })?;
            Ok(names.into_iter().map(<[u8]>::to_vec).collect())
        }
    }
}

/// Downloads a file. Every block is passed to `take`.
pub async fn fetch(link: &mut Link, file: &FileName, take: impl FnMut(&[u8]) -> Result<()>) -> Result<u64> {
    name_taken(service::SAVE, &link.download(&file.save(), MAX_FILE, None, take).await?)
}

/// Like [`fetch`], but for a file that was just listed. If such a file has no content, it is empty, and not missing.
pub async fn fetch_listed(link: &mut Link, file: &FileName, take: impl FnMut(&[u8]) -> Result<()>) -> Result<u64> {
    match link.download(&file.save(), MAX_FILE, None, take).await? {
        DownloadEnd::Nothing(Status { added: NO_FILE_OR_EMPTY, .. }) => Ok(0),
        end => name_taken(service::SAVE, &end),
    }
}

/// Whether the controller has a file with this content. A file that the controller does not send counts as different.
pub async fn is_same(
    link: &mut Link,
    screen: &Screen,
    file: &FileName,
    content: &mut Content,
    ignore_header: bool,
) -> Result<bool> {
    let name = link.encoding.decode(file.as_bytes());
    let mut progress = screen.bytes_progress(&format!("{name} (comparing)"), Some(content.size()));
    let mut comparer = Comparer::new(content.pieces()?, ignore_header);
    let fetched = fetch(link, file, |block| {
        progress.advance(block.len() as u64);
        comparer.take(block)
    });
    match fetched.await {
        Ok(_) => Ok(comparer.finish()?.0.first_difference.is_none()),
        Err(failure) if failure.kind == Kind::Refused => Ok(false),
        Err(failure) => Err(failure),
    }
}

/// Downloads a file to a local file.
pub async fn save(
    link: &mut Link,
    screen: &Screen,
    label: &str,
    target: &Target,
    download: Download<'_>,
) -> Result<Hash> {
    let mut draft = target.begin()?;
    let mut progress = screen.bytes_progress(label, None);
    let mut hash = Hash::default();
    let take = |block: &[u8]| {
        progress.advance(block.len() as u64);
        hash.take(block);
        draft.write(block)
    };
    match download {
        Download::Named(file) => fetch(link, file, take).await?,
        Download::Listed(file) => fetch_listed(link, file, take).await?,
    };
    draft.commit()?;
    Ok(hash)
}

/// A file to download.
#[derive(Debug, Clone, Copy)]
pub enum Download<'a> {
    /// A file that may be missing.
    Named(&'a FileName),
    /// A file that was just listed. The file may be empty.
    Listed(&'a FileName),
}

/// Result for the batch backup: `None` if the controller has created it, or its size if it was received.
pub async fn fetch_backup(
    link: &mut Link,
    wait: Duration,
    take: impl FnMut(&[u8]) -> Result<()>,
) -> Result<Option<u64>> {
    match link.download(&files::batch_backup(), MAX_FILE, Some(wait), take).await? {
        DownloadEnd::Finished => Ok(None),
        end => name_taken(service::SAVE, &end).map(Some),
    }
}

/// Deletes a file.
pub async fn remove(link: &mut Link, file: &FileName) -> Result<()> {
    let reply = link.raw(&file.delete()).await.map_err(|failure| match failure.kind {
        Kind::OutcomeUnknown => failure.hint("use `yerc file list` to see whether the file still exists"),
        _ => failure,
    })?;
    match reply.status {
        // Success with an added status means that the file does not exist (DX 3.1).
        status if status.is_ok() && status.added == 0 => Ok(()),
        status => Err(refusal_failure(Refusal::of_file(service::DELETE, status))),
    }
}

/// Uploads a file. Returns the hash of the content that was sent.
pub async fn send(link: &mut Link, file: &FileName, content: &mut Content, progress: &mut Progress) -> Result<Hash> {
    let total = content.size();
    let path = content.path().display().to_string();
    let mut pieces = content.pieces()?;
    let end = link
        .upload(&file.load(), || {
            let piece = pieces.next_piece()?;
            progress.advance(piece.len() as u64);
            Ok(piece)
        })
        .await?;
    let name = link.encoding.decode(file.as_bytes());
    match end {
        UploadEnd::Unnumbered { .. } if is_listed(link, file).await => {}
        end => drop(name_sent(&end, total, &name, &path)?),
    }
    Ok(pieces.hash)
}

/// Whether a list of the controller contains a file with this name.
async fn is_listed(link: &mut Link, file: &FileName) -> bool {
    let Some(kind) = file.file_type() else { return false };
    list(link, kind).await.is_ok_and(|names| names.iter().any(|name| name.eq_ignore_ascii_case(file.as_bytes())))
}

/// In a dry run, records the requests of [`send`].
pub fn plan_send(link: &mut Link, file: &FileName, content: &mut Content, reason: Reason<'_>) -> Result<()> {
    let mut pieces = content.pieces()?;
    link.plan_upload(&file.load(), reason, || pieces.next_piece())?;
    let Some(kind) = file.file_type() else { return Ok(()) };
    let without_block_number =
        Reason::about("whether the file exists, if the last acknowledgement has no block number");
    let mark = "whether the last acknowledgement has a block number";
    let depends_on = reason.depends_on.map_or_else(|| mark.to_owned(), |before| format!("{before}, and {mark}"));
    Ok(link.plan_download(&files::list(kind), without_block_number.depending_on(&depends_on))?)
}

/// In a dry run, records several downloads, one after another.
pub fn plan_all(link: &mut Link, about: &str, requests: impl IntoIterator<Item = Request>) -> Result<()> {
    Ok(requests.into_iter().try_for_each(|request| link.plan_download(&request, Reason::about(about)))?)
}

/// Purpose of list requests, as a dry run shows it.
pub const LISTS: &str = "existing files";

/// Whether the controller refused a file because a job with the same name exists.
pub fn is_job_exists(failure: &Failure) -> bool {
    failure.kind == Kind::Refused && failure.code.as_deref() == Some(JOB_EXISTS)
}

/// Failure: the controller does not list the file.
pub fn not_listed() -> Failure {
    Failure::new(Kind::Refused, "the file does not exist on the controller")
        .hint("use `yerc file list` to see the names; names are case-sensitive")
}

/// Size of the received data, or the failure of the transfer.
pub fn name_taken(service: u8, end: &DownloadEnd) -> Result<u64> {
    match *end {
        DownloadEnd::Complete { bytes, .. } => Ok(bytes),
        DownloadEnd::Nothing(status) | DownloadEnd::Refused { status, bytes: 0 } => {
            Err(refusal_failure(Refusal::of_file(service, status)))
        }
        DownloadEnd::Refused { status, bytes } => Err(describe_request(
            &format!("the transfer ended after {bytes} bytes"),
            refusal_failure(Refusal::of_file(service, status)),
        )),
        DownloadEnd::Finished => {
            Err(Failure::new(Kind::Malformed, "the controller reported success, but it sent no data")
                .hint("use `yerc file list` to see whether the file exists; the file may be empty"))
        }
        DownloadEnd::Violated { violation, bytes } => {
            Err(Failure::new(Kind::Malformed, format!("the transfer failed after {bytes} bytes: {violation}"))
                .hint("repeat the command, and record it with --trace if the problem persists; no data was saved"))
        }
        DownloadEnd::TooLarge { limit, .. } => {
            Err(Failure::new(Kind::Malformed, format!("the controller sends more than {limit} bytes")).hint(
                "record the transfer with --trace and report the problem; no known controller has such large files",
            ))
        }
        DownloadEnd::NoAnswer { bytes, counters } => {
            Err(Failure::new(Kind::NoAnswer, format!("no answer after {bytes} bytes ({counters})"))
                .hint("repeat the command, or set a longer --timeout; no data was saved"))
        }
    }
}

fn name_sent(end: &UploadEnd, total: u64, name: &str, path: &str) -> Result<u64> {
    let unknown = |message: String| {
        Err(Failure::new(Kind::OutcomeUnknown, message)
            .hint(format!("use `yerc file diff {name} {path}` to see what the controller has now")))
    };
    match *end {
        UploadEnd::Complete { bytes, .. } => Ok(bytes),
        UploadEnd::Unnumbered { .. } => unknown(format!(
            "all data was sent, but the last acknowledgement has no block number, and the controller does not list \
             {name}"
        )),
        UploadEnd::Empty => {
            Err(Failure::usage("an empty file cannot be sent").hint("check whether this is the right file"))
        }
        UploadEnd::TooLong { .. } => {
            Err(Failure::usage("the file is too long for a transfer").hint("check whether this is the right file"))
        }
        UploadEnd::Refused { status, sent, repeated: true, .. } if sent >= total => {
            let Failure { message, .. } = refusal_failure(Refusal::of_file(service::LOAD, status));
            unknown(format!(
                "armctl sent the last block again, and the controller refused the block: {message} The file may exist"
            ))
        }
        // The controller refused the file at the start, or refused the whole file at the end.
        UploadEnd::Refused { status, sent, .. } if sent == 0 || sent >= total => {
            Err(refusal_failure(Refusal::of_file(service::LOAD, status)))
        }
        UploadEnd::Refused { status, taken, .. } => Err(describe_request(
            &format!("after {taken} of {total} bytes"),
            refusal_failure(Refusal::of_file(service::LOAD, status)),
        )),
        UploadEnd::OutcomeUnknown { sent: 0, counters, .. } => {
            let seen = if counters.heard_something() { format!(" ({counters})") } else { String::new() };
            unknown(format!(
                "the request was sent once, with no answer{seen}: armctl sent no data, but the controller may wait \
                 for data"
            ))
        }
        UploadEnd::OutcomeUnknown { sent, .. } if sent >= total => {
            unknown("all data was sent, but the last acknowledgement is missing: the file may exist".to_owned())
        }
        UploadEnd::OutcomeUnknown { taken, .. } => {
            unknown(format!("no acknowledgement after {taken} of {total} bytes: part of the file may exist"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yerc::session::Counters;
    use armctl_controller::yerc::table::service;

    #[test]
    fn refused_repeat_of_the_last_block_leaves_the_outcome_unknown() {
        let status = Status::refused(0xE4A1);
        let end = |sent, repeated| {
            name_sent(&UploadEnd::Refused { status, sent, taken: 0, repeated }, 9, "A.JBI", "a.jbi").unwrap_err()
        };
        assert_eq!(end(9, true).kind, Kind::OutcomeUnknown);
        assert_eq!(
            end(9, true).hint.as_deref(),
            Some("use `yerc file diff A.JBI a.jbi` to see what the controller has now")
        );
        assert_eq!(end(9, false).kind, Kind::Refused);
        assert_eq!(end(0, true).kind, Kind::Refused);
        let counters = Counters::default();
        let lost = name_sent(&UploadEnd::OutcomeUnknown { sent: 9, taken: 0, counters }, 9, "A.JBI", "a.jbi");
        assert_eq!(lost.unwrap_err().kind.exit(), 6);
    }

    #[test]
    fn missing_file_is_a_refusal_with_a_hint() {
        for status in
            [Status { code: 0, added_size: 1, added: 0xE29C }, Status::refused(0x4040), Status::refused(0xE2B3)]
        {
            let end =
                if status.is_ok() { DownloadEnd::Nothing(status) } else { DownloadEnd::Refused { status, bytes: 0 } };
            let failure = name_taken(service::SAVE, &end).unwrap_err();
            assert_eq!(failure.kind, Kind::Refused);
            assert!(failure.hint.unwrap().contains("file list"));
        }
    }

    #[test]
    fn broken_transfer_creates_no_file() {
        let status = Status::refused(0xE28B);
        for (end, kind) in [
            (DownloadEnd::Refused { status, bytes: 479 }, Kind::Refused),
            (DownloadEnd::Finished, Kind::Malformed),
            (DownloadEnd::TooLarge { limit: 5, bytes: 4 }, Kind::Malformed),
        ] {
            assert_eq!(name_taken(service::SAVE, &end).unwrap_err().kind, kind);
        }
    }
}

//! Jobs of a controller or of a folder, for commands that read all jobs.

use std::path::Path;

use super::without_suffix;
use crate::file::{Manifest, exact, fetch_listed, list, plan_all};
use crate::link::Link;
use crate::prelude::*;
use armctl_controller::yerc::files;
use armctl_frame::backup::continues_after;
use armctl_frame::items::{ItemError, describe_request};
use armctl_frame::programs::source::{FolderFilter, ProgramFile, ProgramSet, read_folder};

const JOBS: FolderFilter = FolderFilter { holds: "jbi", is_program: is_job, expected: "jobs (*.JBI)" };

/// Whether a file name has the ending of a job.
fn is_job(name: &str) -> bool {
    without_suffix(name) != name
}

/// Reads the jobs in the folder of a backup, or in any folder with files `*.JBI`. Also returns the encoding of the
/// texts. A folder without a manifest has the encoding `otherwise`.
///
/// # Errors
/// A file cannot be read, or the folder has no jobs.
pub fn jobs_in(folder: &Path, otherwise: Encoding) -> Result<(ProgramSet, Encoding), Failure> {
    let (set, manifest): (ProgramSet, Option<Manifest>) = read_folder(folder, JOBS)?;
    let encoding = manifest.and_then(|manifest| manifest.controller.encoding.parse().ok()).unwrap_or(otherwise);
    Ok((set, encoding))
}

/// Reads all jobs of a controller, each once and in order. A job that the controller refuses is listed as unread. In a
/// dry run, records the request and returns `None`.
///
/// # Errors
/// The list of jobs cannot be read, or the connection is lost.
pub async fn jobs_of(link: &mut Link, screen: &Screen) -> Result<Option<ProgramSet>, Failure> {
    if link.is_dry_run() {
        plan_all(link, "the jobs of the controller", [files::list(FileType::Jbi)])?;
        link.then("armctl downloads every listed job, and acknowledges each block");
        return Ok(None);
    }
    let looking = screen.spinner("looking for jobs");
    let names = list(link, FileType::Jbi).await?;
    drop(looking);
    let mut set = ProgramSet::default();
    let mut progress = screen.parts_progress("jobs read", names.len());
    for bytes in names {
        let name = link.encoding.decode(&bytes);
        let mut content = Vec::new();
        let read = async {
            let file = exact(bytes).map_err(|failure| Failure { kind: Kind::Malformed, ..failure })?;
            fetch_listed(link, &file, |block| {
                content.extend_from_slice(block);
                Ok(())
            })
            .await
        };
        match read.await {
            Ok(_) => set.files.push(ProgramFile { file: name.clone(), name, bytes: content }),
            Err(failure) if continues_after(&failure) => set.unread.push(ItemError::new(name, failure)),
            Err(failure) => return Err(describe_request(&name, failure)),
        }
        progress.advance(1);
    }
    Ok(Some(set))
}

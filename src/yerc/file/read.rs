//! Reads small files from the controller, for commands that need their content.

use super::existence::{Existence, Lists};
use super::transfer;
use crate::prelude::*;
use armctl_frame::backup::continues_after;

/// Result of reading a file.
#[derive(Debug)]
pub enum FileReading {
    /// Content of the file.
    Read(Vec<u8>),
    /// The controller does not have the file.
    Missing,
    /// The file could not be read.
    Failed(Failure),
}

/// Reads files of at most `most` bytes, in order. Each file has its own result. In a dry run, records the requests and
/// returns `None`.
pub async fn read_files(
    link: &mut Link,
    screen: &Screen,
    names: &[&str],
    most: u64,
) -> Result<Option<Vec<FileReading>>> {
    let files = names
        .iter()
        .map(|name| FileName::new(*name).map_err(|error| Failure::local(format!("internal error: {name}: {error}"))));
    let files = files.collect::<Result<Vec<FileName>>>()?;
    let looking = screen.spinner("looking for files");
    let Some(lists) = Lists::ask(link, &files).await? else {
        transfer::plan_all(link, "if the controller has the file", files.iter().map(FileName::save))?;
        return Ok(None);
    };
    drop(looking);
    let mut answers = Vec::with_capacity(files.len());
    for (file, name) in files.iter().zip(names) {
        if lists.existence(file) == Existence::No {
            answers.push(FileReading::Missing);
            continue;
        }
        let mut bytes = Vec::new();
        let mut progress = screen.bytes_progress(name, None);
        let read = transfer::fetch_listed(link, file, |block| {
            progress.advance(block.len() as u64);
            bytes.extend_from_slice(block);
            if bytes.len() as u64 > most {
                return Err(Failure::new(Kind::Malformed, format!("{name} has more than {most} bytes")).hint(
                    "record the transfer with --trace and report the problem; no known controller has such a large \
                     file",
                ));
            }
            Ok(())
        });
        match read.await {
            Ok(0) => answers.push(FileReading::Missing),
            Ok(_) => answers.push(FileReading::Read(bytes)),
            Err(failure) if continues_after(&failure) => answers.push(FileReading::Failed(failure)),
            Err(failure) => return Err(transfer::describe_request(name, failure)),
        }
    }
    Ok(Some(answers))
}

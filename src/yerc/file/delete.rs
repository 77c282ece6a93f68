//! `yerc file delete` (FS and DX 3.4.1).

use super::existence::{Existence, Lists};
use super::name::{self, ReportedName};
use super::transfer;
use crate::prelude::*;
use armctl_frame::robot::file::{FileItem, Files};

/// Deletes files on the controller.
#[derive(Debug, Args)]
pub struct Delete {
    /// Full file names, such as TESTJOB.JBI
    #[arg(required = true, value_name = "NAME", add = complete::FILE)]
    names: Vec<String>,
}

/// Report of the deletions.
fn report(files: Vec<FileItem>) -> Files {
    Files::new(files, |files| FileItem::transfers(files, "deleted"))
}

impl Command for Delete {
    type Family = Yerc;
    type Report = Files;
    const ID: &'static str = "yerc.file.delete";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "delete files";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Files> {
        let Context { link, confirmer, .. } = context;
        let files = name::parse_names(link.encoding, &self.names)?;
        let pending = |file: &FileName| ReportedName::new(link.encoding, file.as_bytes()).pending();
        let mut results: Vec<FileItem> = files.iter().map(pending).collect();
        let lists = Lists::ask(link, &files).await?;
        confirmer.confirm(&change(link.encoding, lists.as_ref(), &files)).await?;
        let Some(lists) = lists else {
            for file in &files {
                let reason = Reason::about("if the file is listed").depending_on("whether the file is listed");
                link.plan_if(&file.delete(), reason);
            }
            return Ok(report(results));
        };
        for (file, result) in files.iter().zip(&mut results) {
            let outcome = match lists.existence(file) {
                Existence::No => Err(transfer::not_listed()),
                Existence::Yes | Existence::Unlisted => transfer::remove(link, file).await,
            };
            if !result.finish(outcome.map(|()| None)) {
                break;
            }
        }
        report(results).single_failure()
    }
}

/// Confirmation that names the files to delete, and the files that do not exist.
fn change(encoding: Encoding, lists: Option<&Lists>, files: &[FileName]) -> Change {
    let tell = |file: &FileName| lists.map_or(Existence::No, |lists| lists.existence(file));
    let name = |file: &FileName| encoding.decode(file.as_bytes());
    let mut items = Vec::new();
    let mut missing = Vec::new();
    for file in files {
        match tell(file) {
            Existence::Yes => items.push(name(file)),
            Existence::Unlisted => {
                items.push(format!("{} (armctl could not check whether the file exists)", name(file)));
            }
            Existence::No => missing.push(name(file)),
        }
    }
    if items.is_empty() {
        return Change::none();
    }
    let plural = if items.len() == 1 { "" } else { "s" };
    let change = Change::new(format!("delete {} file{plural} on the controller", items.len()));
    let change = items.into_iter().fold(change, Change::item);
    if missing.is_empty() { change } else { change.note(format!("Not there: {}.", missing.join(", "))) }
}

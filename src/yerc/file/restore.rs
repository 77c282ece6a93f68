//! `yerc restore`: uploads the files of a backup.

use super::content::Content;
use super::existence::{Existence, Lists};
use super::manifest::{Manifest, controller_file};
use super::name::ReportedName;
use super::transfer;
use super::upload::{self, Delivery, UploadOptions, upload};
use crate::prelude::*;
use armctl_frame::backup::manifest;
use armctl_frame::backup::manifest::Entry;
use armctl_frame::backup::{NOT_CHOSEN, Only, RestoreReport, RestoreSelection, would_leave, would_write};
use armctl_frame::local_names::private_folder;
use armctl_frame::robot::file::{FileItem, State};

/// Selection of the files of a backup to upload.
#[derive(Debug)]
pub struct Restore {
    folder: PathBuf,
    /// File types to send.
    types: Vec<FileType>,
    /// Patterns for file names.
    patterns: Only,
    /// Whether to send a backup of another model.
    force: bool,
}

/// Options for each upload: a job is replaced if the controller itself does not overwrite it.
const OPTIONS: UploadOptions = UploadOptions { verify: false, ignore_header: false, replace: true };

/// Order in which types are sent. Jobs need their data and conditions first. After parameters, a controller may need a
/// restart.
const ORDER: [FileType; 6] = [FileType::Dat, FileType::Cnd, FileType::Jbi, FileType::Lst, FileType::Sys, FileType::Prm];
/// Types that are sent by default. Parameters and system data are not sent by default, because they change the
/// controller itself.
const DEFAULT_TYPES: [FileType; 3] = [FileType::Dat, FileType::Cnd, FileType::Jbi];

impl Restore {
    /// Converts the options of the `restore` command that all families have.
    pub fn of(restoring: &RestoreSelection) -> Self {
        let RestoreSelection { folder, only: patterns, machine, force } = restoring.clone();
        let mut types = DEFAULT_TYPES.to_vec();
        if patterns != Only::default() || machine {
            types.push(FileType::Lst);
        }
        if machine {
            types.extend([FileType::Sys, FileType::Prm]);
        }
        Self { folder, types, patterns, force }
    }

    /// Sends the files that differ.
    pub async fn run(&self, context: Context<'_, Yerc>) -> Result<RestoreReport> {
        let Context { link, screen, robot, several, confirmer } = context;
        let folder = private_folder(&self.folder, &robot.name, several);
        manifest::check_origin(&manifest::open_existing::<Value>(&folder)?, robot, self.force)?;
        let manifest: Manifest = manifest::open_existing(&folder)?;
        let (taken_of, model) = (manifest.controller.description_of(), link.model().await?);
        if taken_of != model.name() && !link.is_dry_run() && !self.force {
            let message = format!("the backup is from a {taken_of}, but {} is a {model}", robot.label());
            return Err(Failure::new(Kind::Rejected, message)
                .hint("check the model (?model=…), or add --force to send the files anyway"));
        }
        let chosen = self.select_entries(&manifest)?;
        let (mut deliveries, mut results) = (Vec::with_capacity(chosen.len()), Vec::with_capacity(chosen.len()));
        for (file, entry) in chosen {
            let Some(copy) = &entry.copy else { continue };
            copy.check(&folder)?;
            if copy.bytes > 0 {
                results.push(ReportedName::new(link.encoding, file.as_bytes()).pending().from_copy(&folder, copy));
                deliveries.push(Delivery { file, content: Content::open(&folder.join(&copy.file))? });
            } else {
                screen.note(&format!("{} is empty and cannot be sent", entry.name));
            }
        }
        if link.is_dry_run() {
            Self::plan_items(link, &manifest, &deliveries);
        }
        let lists = Lists::ask(link, deliveries.iter().map(|delivery| &delivery.file)).await?;
        let Some(lists) = lists else {
            plan(link, &mut deliveries, &confirmer).await?;
            return Ok(RestoreReport::new(&folder, results));
        };
        if !compare(link, screen, &lists, &mut deliveries, &mut results).await? {
            return Ok(RestoreReport::new(&folder, results));
        }
        // Equal files are skipped. Files that could not be compared are not sent.
        let mut open: Vec<(Delivery, &mut FileItem)> = deliveries
            .into_iter()
            .zip(&mut results)
            .filter(|(_, result)| result.more.state == State::NotTried)
            .collect();
        upload::confirm_uploads(&confirmer, link.encoding, Some(&lists), open.iter().map(|(delivery, _)| delivery))
            .await?;
        let mut sent = screen.parts_progress("files sent", open.len());
        for (delivery, result) in &mut open {
            // A file that was not in a list was not confirmed, so it is not deleted.
            let replace = lists.existence(&delivery.file) != Existence::No;
            let outcome =
                upload(link, screen, delivery, UploadOptions { replace, ..OPTIONS }, &mut result.more.notes).await;
            if !result.finish(outcome.map(Some)) {
                break;
            }
            sent.advance(1);
        }
        drop(open);
        Ok(RestoreReport::new(&folder, results))
    }
}

impl Restore {
    /// In a dry run, records each file of the backup.
    fn plan_items(link: &mut Link, manifest: &Manifest, deliveries: &[Delivery]) {
        let enabled = "whether the controller's file differs";
        for entry in &manifest.files {
            let Some(copy) = &entry.copy else { continue };
            let file = controller_file(entry).ok();
            let is_sent = deliveries.iter().any(|delivery| Some(&delivery.file) == file.as_ref());
            let is_usual = file.and_then(|file| file.file_type()).is_some_and(|kind| DEFAULT_TYPES.contains(&kind));
            link.plan_item(match (is_sent, is_usual) {
                (true, _) => would_write(&entry.name, ("bytes", copy.bytes), enabled),
                (false, true) => would_leave(&entry.name, NOT_CHOSEN),
                (false, false) => {
                    would_leave(&entry.name, "parameters or system data, which armctl writes only with --machine")
                }
            });
        }
    }

    /// Files to send, in the order of sending.
    fn select_entries<'a>(&self, manifest: &'a Manifest) -> Result<Vec<(FileName, &'a Entry)>> {
        let copied = || manifest.files.iter().filter(|entry| entry.copy.is_some());
        self.patterns.check(&copied().map(|entry| entry.name.as_str()).collect::<Vec<_>>())?;
        let mut chosen = Vec::new();
        for entry in copied().filter(|entry| self.patterns.has(&entry.name)) {
            let file = controller_file(entry)?;
            if file.file_type().is_some_and(|kind| self.types.contains(&kind)) {
                chosen.push((file, entry));
            }
        }
        if chosen.is_empty() {
            let message = "the backup contains only lists, parameters or system data, which change the controller";
            return Err(Failure::usage(message).hint("add --machine to send these files"));
        }
        let place = |file: &FileName| ORDER.iter().position(|kind| Some(*kind) == file.file_type());
        chosen.sort_by_key(|(file, _)| place(file));
        Ok(chosen)
    }
}

/// Finds the files that are equal on the controller. Returns `false` if the work cannot continue.
async fn compare(
    link: &mut Link,
    screen: &Screen,
    lists: &Lists,
    deliveries: &mut [Delivery],
    results: &mut [FileItem],
) -> Result<bool> {
    for (Delivery { file, content }, result) in deliveries.iter_mut().zip(results) {
        if lists.existence(file) == Existence::No {
            continue;
        }
        match transfer::is_same(link, screen, file, content, OPTIONS.ignore_header).await {
            Ok(true) => result.succeed(State::Kept),
            Ok(false) => {}
            Err(failure) => {
                if !result.fail(failure) {
                    return Ok(false);
                }
            }
        }
    }
    Ok(true)
}

/// In a dry run, records the requests that a restore sends after it has read the file lists.
async fn plan(link: &mut Link, deliveries: &mut [Delivery], confirmer: &Confirmer<'_>) -> Result<()> {
    confirmer.confirm(&Change::none()).await?;
    for Delivery { file, .. } in &*deliveries {
        let reason =
            Reason::about("content of the file, for the comparison").depending_on("whether the file is listed");
        link.plan_download(&file.save(), reason)?;
    }
    let reason = Reason::about("if the file differs").depending_on("whether the file differs");
    for delivery in deliveries {
        upload::plan(link, delivery, OPTIONS, reason)?;
    }
    Ok(())
}

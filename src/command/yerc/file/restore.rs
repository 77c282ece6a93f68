//! `yerc file restore`: upload of the files of a backup.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::content::Content;
use super::deliver::{self, Delivery, Manner, deliver};
use super::lists::{Lists, There};
use super::manifest::{Manifest, controller_file};
use super::name::{self, Shown, TypeArg};
use super::results::{FileResult, Results, Shape};
use super::transfer;
use crate::command::backup::manifest;
use crate::command::backup::manifest::{Entry, MANIFEST, State};
use crate::command::backup::{NOT_CHOSEN, Only, Restoring, would_leave, would_write};
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::Reason;
use crate::command::frame::local::own_folder;
use crate::command::yerc::link::Link;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::yerc::files::{FileName, FileType};
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation};
use crate::output::Screen;

/// Uploads the files of a backup.
#[derive(Debug, Args)]
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
pub struct Restore {
    /// Folder of the backup
    folder: PathBuf,
    /// Only these files
    #[arg(long, value_name = "NAME", num_args = 1..)]
    only: Vec<String>,
    /// File types, such as jbi,dat; parameters and system data only if listed
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true)]
    types: Vec<TypeArg>,
    /// Read every file back and compare it
    #[arg(long)]
    verify: bool,
    /// Ignore the line ///DATE, which controllers rewrite
    #[arg(long)]
    ignore_header: bool,
    /// Delete and send jobs that the controller does not overwrite
    #[arg(long)]
    replace: bool,
    /// Compare first and send only differing files
    #[arg(long)]
    differing: bool,
    /// Patterns of file names
    #[arg(skip)]
    patterns: Only,
    /// Send a backup to another model
    #[arg(long)]
    force: bool,
}

const SHAPE: Shape = Shape { done: "sent", has_paths: true, has_bytes: true };

/// Order of sending: jobs need their data and conditions first, and after parameters a controller may need a restart.
const ORDER: [FileType; 6] = [FileType::Dat, FileType::Cnd, FileType::Jbi, FileType::Lst, FileType::Sys, FileType::Prm];
/// Types that are sent by default. Parameters and system data change the controller itself.
const USUAL: [FileType; 3] = [FileType::Dat, FileType::Cnd, FileType::Jbi];

impl Restore {
    /// Options from those of the `restore` command of all families.
    pub fn of(restoring: &Restoring) -> Self {
        let Restoring { folder, only: patterns, machine, force } = restoring.clone();
        let mut types = vec![TypeArg::Dat, TypeArg::Cnd, TypeArg::Jbi];
        if patterns != Only::default() {
            types.push(TypeArg::Lst);
        }
        if machine {
            types.extend([TypeArg::Lst, TypeArg::Prm, TypeArg::Sys]);
        }
        Self {
            folder,
            only: Vec::new(),
            types,
            verify: false,
            ignore_header: false,
            replace: true,
            differing: true,
            patterns,
            force,
        }
    }
}

impl Command for Restore {
    type Family = Yerc;
    type Report = Results;
    const ID: &'static str = "yerc.file.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite files with those of the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Results, Failure> {
        let Context { link, screen, robot, several, authority } = context;
        let folder = own_folder(&self.folder, &robot.name, several);
        manifest::check_origin(&manifest::existing::<Value>(&folder)?, robot, self.force)?;
        let manifest: Manifest = manifest::existing(&folder)?;
        let (taken_of, model) = (manifest.controller.taken_of(), link.model().await?);
        if taken_of != model.name() && !link.is_dry() && !self.force {
            let message = format!("the backup is of a {taken_of}, {} is a {model}", robot.label());
            return Err(Failure::new(Kind::Rejected, message)
                .hint("check the model (?model=…); --force sends the files anyway"));
        }
        let chosen = self.chosen(link, &manifest)?;
        let mut deliveries = Vec::with_capacity(chosen.len());
        for (file, entry) in chosen {
            let Some(copy) = &entry.copy else { continue };
            copy.check(&folder)?;
            if copy.bytes > 0 {
                deliveries.push(Delivery { file, content: Content::open(&folder.join(&copy.file))? });
            } else {
                screen.note(&format!("{} is empty and cannot be sent", entry.name));
            }
        }
        let mut results = Vec::with_capacity(deliveries.len());
        for Delivery { file, content } in &deliveries {
            results.push(FileResult::pending(Shown::new(link.encoding, file.as_bytes()), Some(content.path())));
        }
        if link.is_dry() {
            self.plan_items(link, &manifest, &deliveries);
        }
        let manner = Manner { verify: self.verify, ignore_header: self.ignore_header, replace: self.replace };
        let lists = Lists::ask(link, deliveries.iter().map(|delivery| &delivery.file)).await?;
        let Some(lists) = lists else {
            self.plan(link, &mut deliveries, manner, &authority).await?;
            return Ok(Results::new(results, SHAPE));
        };
        if self.differing && !self.compare(link, screen, &lists, &mut deliveries, &mut results).await? {
            return Results::new(results, SHAPE).report();
        }
        // Equal files are skipped, and files that could not be compared are not sent.
        let mut open: Vec<(Delivery, &mut FileResult)> =
            deliveries.into_iter().zip(&mut results).filter(|(_, result)| result.state == State::NotTried).collect();
        deliver::confirm(&authority, link.encoding, Some(&lists), open.iter().map(|(delivery, _)| delivery)).await?;
        let mut sent = screen.parts_progress("files sent", open.len());
        for (delivery, result) in &mut open {
            // An unlisted file was not confirmed, so it is not deleted.
            let replace = manner.replace && lists.tell(&delivery.file) != There::No;
            let outcome = deliver(link, screen, delivery, Manner { replace, ..manner }, result).await;
            if !result.settle(outcome) {
                break;
            }
            sent.advance(1);
        }
        drop(open);
        Results::new(results, SHAPE).report()
    }
}

impl Restore {
    /// Finds the files that are equal on the controller; `false` if the work cannot continue.
    async fn compare(
        &self,
        link: &mut Link,
        screen: &Screen,
        lists: &Lists,
        deliveries: &mut [Delivery],
        results: &mut [FileResult],
    ) -> Result<bool, Failure> {
        for (Delivery { file, content }, result) in deliveries.iter_mut().zip(results) {
            if lists.tell(file) == There::No {
                continue;
            }
            match transfer::is_same(link, screen, file, content, self.ignore_header).await {
                Ok(true) => result.state = State::Kept,
                Ok(false) => {}
                Err(failure) => {
                    if !result.settle(Err(failure)) {
                        return Ok(false);
                    }
                }
            }
        }
        Ok(true)
    }

    /// Notes each file of the backup in a dry run.
    fn plan_items(&self, link: &mut Link, manifest: &Manifest, deliveries: &[Delivery]) {
        let on = match (self.differing, self.replace) {
            (true, _) => "whether the controller's file differs",
            (false, true) => "whether a file with this name exists: it is replaced",
            (false, false) => "whether a file with this name exists: it is overwritten",
        };
        for entry in &manifest.files {
            let Some(copy) = &entry.copy else { continue };
            let file = controller_file(entry).ok();
            let is_sent = deliveries.iter().any(|delivery| Some(&delivery.file) == file.as_ref());
            let is_usual = file.and_then(|file| file.file_type()).is_some_and(|kind| USUAL.contains(&kind));
            link.plan_item(match (is_sent, is_usual) {
                (true, _) => would_write(&entry.name, ("bytes", copy.bytes), on),
                (false, true) => would_leave(&entry.name, NOT_CHOSEN),
                (false, false) => {
                    would_leave(&entry.name, "parameters or system data; written only with --machine or --type")
                }
            });
        }
    }

    /// Notes in a dry run the requests after the lists.
    async fn plan(
        &self,
        link: &mut Link,
        deliveries: &mut [Delivery],
        manner: Manner,
        authority: &Authority<'_>,
    ) -> Result<(), Failure> {
        authority.confirm(&Change::nothing()).await?;
        let reason = if self.differing {
            for Delivery { file, .. } in &*deliveries {
                let reason =
                    Reason::about("if the file is listed: compares").depending_on("whether the file is listed");
                link.plan_download(&file.save(), reason)?;
            }
            Reason::about("if it differs").depending_on("whether the file differs")
        } else {
            Reason::default()
        };
        for delivery in deliveries {
            deliver::plan(link, delivery, manner, reason)?;
        }
        Ok(())
    }

    /// Files to send, in the order of sending.
    fn chosen<'a>(&self, link: &Link, manifest: &'a Manifest) -> Result<Vec<(FileName, &'a Entry)>, Failure> {
        let only = name::all_typed(link.encoding, &self.only)?;
        let types = match &self.types[..] {
            // A file selected by name is sent whatever its type; parameters and system data also need their type.
            [] if only.is_empty() => USUAL.to_vec(),
            [] => [&USUAL[..], &[FileType::Lst]].concat(),
            types => TypeArg::chosen(types),
        };
        for file in &only {
            let shown = link.encoding.decode(file.as_bytes());
            if manifest.entry_of(file.as_bytes()).and_then(|entry| entry.copy.as_ref()).is_none() {
                return Err(Failure::usage(format!("the backup has no {shown}"))
                    .hint(format!("see the list of files in {MANIFEST}")));
            }
            let kind = file.file_type();
            if !kind.is_some_and(|kind| types.contains(&kind)) {
                let kind = kind.map_or("of another extension", name::type_word);
                return Err(Failure::usage(format!("{shown} has type {kind}, which is not selected"))
                    .hint(format!("add --type {kind}; parameters and system data change the controller itself")));
            }
        }
        let copied = || manifest.files.iter().filter(|entry| entry.copy.is_some());
        self.patterns.check(&copied().map(|entry| entry.name.as_str()).collect::<Vec<_>>())?;
        let mut chosen = Vec::new();
        for entry in copied().filter(|entry| self.patterns.has(&entry.name)) {
            let file = controller_file(entry)?;
            if file.file_type().is_some_and(|kind| types.contains(&kind)) && (only.is_empty() || only.contains(&file)) {
                chosen.push((file, entry));
            }
        }
        if chosen.is_empty() {
            let message = "the backup has only lists, parameters or system data, which change the controller";
            return Err(Failure::usage(message)
                .hint("add --machine to send them, or use `yerc file restore` with --type, as in --type lst"));
        }
        let place = |file: &FileName| ORDER.iter().position(|kind| Some(*kind) == file.file_type());
        chosen.sort_by_key(|(file, _)| place(file));
        Ok(chosen)
    }
}

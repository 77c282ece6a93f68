//! `yerc file backup`: every file of the controller in a folder, with a list of itself.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::time::Instant;

use super::manifest::{Entry, Manifest};
use super::name::{self, Shown, TypeArg, type_word};
use super::results::{FileResult, Results, Shape};
use super::transfer;
use crate::command::local::{LocalNames, Target, make_folder, own_folder};
use crate::command::manifest::{self, Hash, MANIFEST, Reason, Saved, State};
use crate::command::yerc::Family;
use crate::command::yerc::link::Link;
use crate::command::{Command, Context, Report};
use crate::controller::text::hex;
use crate::controller::yerc::files::{self, FileType};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::View;

/// Fetches every file into a folder.
#[derive(Debug, Args)]
pub struct Backup {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Which types, such as jbi,dat
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true, default_value = "all")]
    types: Vec<TypeArg>,
    /// Go on with a backup that is not whole; files that are there already are kept
    #[arg(long, conflicts_with = "force")]
    resume: bool,
    /// Make a new backup over the one in the folder
    #[arg(long)]
    force: bool,
}

const SHAPE: Shape = Shape { done: "saved", has_paths: false, has_bytes: true };
/// How much work may be lost from the list when the power fails.
const WRITE_EVERY: Duration = Duration::from_secs(1);

impl Command for Backup {
    type Family = Family;
    type Report = BackedUp;
    const ID: &'static str = "yerc.file.backup";

    async fn run(&self, context: Context<'_, Family>) -> Result<BackedUp, Failure> {
        let Context { link, screen, robot, several } = context;
        let types = TypeArg::chosen(&self.types);
        let folder = own_folder(&self.folder, &robot.name, several);
        let earlier: Option<Manifest> = manifest::earlier(&folder, robot.target.value.url(), self.resume, self.force)?;
        if link.is_dry() {
            transfer::foresee_all(link, types.iter().map(|kind| files::list(*kind)));
            return Ok(BackedUp::new(&folder, Results::new(Vec::new(), SHAPE), false));
        }
        let mut work = Vec::new();
        let mut refused = Vec::new();
        for kind in &types {
            match transfer::list(link, *kind).await {
                Ok(names) => work.extend(names.into_iter().map(|name| (*kind, name))),
                Err(failure) if failure.kind == Kind::Refused => refused.push((*kind, failure)),
                Err(failure) => return Err(transfer::about(&kind.filter(), failure)),
            }
        }
        make_folder(&folder)?;
        let words = types.iter().map(|kind| type_word(*kind).to_owned()).collect();
        let target = robot.target.value.url().to_owned();
        let encoding = link.encoding.label().to_owned();
        let manifest = Manifest::new(robot.name.clone(), target, link.model.to_string(), encoding, words);
        let mut ledger = Ledger::open(&folder, manifest, work.len(), screen)?;
        let mut results: Vec<FileResult> =
            work.iter().map(|(_, name)| FileResult::pending(Shown::new(link.encoding, name), None)).collect();
        let mut names = LocalNames::new(link.encoding);
        for (number, ((kind, name), result)) in work.iter().zip(&mut results).enumerate() {
            let file_type = type_word(FileType::of(name).unwrap_or(*kind)).to_owned();
            let mut entry =
                Entry { name: result.name.name.clone(), name_hex: hex(name), file_type, copy: None, error: None };
            let local = names.assign(name);
            let kept = earlier.as_ref().and_then(|list| list.entry(name)?.copy.clone());
            let kept = kept.filter(|copy| local.as_ref() == Ok(&copy.file) && copy.check(&folder).is_ok());
            let goes_on = if let Some(copy) = kept {
                result.state = State::Kept;
                result.bytes = Some(copy.bytes);
                entry.copy = Some(copy);
                true
            } else {
                let label = format!("{}/{} {}", number + 1, work.len(), result.name.name);
                let outcome = match local {
                    Ok(local) => fetch(link, screen, &label, name, &folder, local).await,
                    Err(failure) => Err(Failure { kind: Kind::Malformed, ..failure }),
                };
                if let Ok(Saved { bytes: 0, .. }) = &outcome {
                    result.notes.push("empty");
                }
                entry.error = outcome.as_ref().err().map(Reason::from);
                entry.copy = outcome.as_ref().ok().cloned();
                result.settle(outcome.map(|copy| Some(copy.bytes)))
            };
            ledger.record(entry)?;
            if !goes_on {
                break;
            }
        }
        for (kind, failure) in refused {
            let mut list = FileResult::pending(Shown { name: kind.filter(), name_hex: None }, None);
            list.settle(Err(failure));
            results.push(list);
        }
        let results = Results::new(results, SHAPE);
        let complete = results.failed + results.not_tried == 0;
        ledger.close(complete)?;
        Ok(BackedUp::new(&folder, results, complete))
    }
}

async fn fetch(
    link: &mut Link,
    screen: &Screen,
    label: &str,
    name: &[u8],
    folder: &Path,
    local: String,
) -> Result<Saved, Failure> {
    // A name that a controller lists and that must not be sent is the controller's fault, not the operator's.
    let file = name::exact(name.to_vec()).map_err(|failure| Failure { kind: Kind::Malformed, ..failure })?;
    let mut draft = Target::new(folder.join(&local), true)?.begin()?;
    screen.step(label);
    let mut progress = screen.bytes_progress(label, None);
    let mut hash = Hash::default();
    transfer::fetch_listed(link, &file, |block| {
        progress.advance(block.len() as u64);
        hash.take(block);
        draft.write(block)
    })
    .await?;
    draft.commit()?;
    Ok(Saved { file: local, bytes: hash.bytes, sha256: hash.hex() })
}

/// The list under way, which is written even if the work is cut off.
struct Ledger<'a> {
    manifest: Manifest,
    folder: &'a Path,
    screen: &'a Screen,
    total: usize,
    written: Instant,
    is_closed: bool,
}

impl<'a> Ledger<'a> {
    /// Writes the list at once, to learn whether it can be written.
    fn open(folder: &'a Path, mut manifest: Manifest, total: usize, screen: &'a Screen) -> Result<Self, Failure> {
        manifest.write(folder)?;
        Ok(Self { manifest, folder, screen, total, written: Instant::now(), is_closed: false })
    }

    fn record(&mut self, entry: Entry) -> Result<(), Failure> {
        self.manifest.files.push(entry);
        if self.written.elapsed() >= WRITE_EVERY {
            self.manifest.write(self.folder)?;
            self.written = Instant::now();
        }
        Ok(())
    }

    fn close(mut self, complete: bool) -> Result<(), Failure> {
        self.is_closed = true;
        self.manifest.complete = complete;
        self.manifest.write(self.folder)
    }
}

impl Drop for Ledger<'_> {
    /// Ctrl-C, or an error that ended the work early.
    fn drop(&mut self) {
        if self.is_closed {
            return;
        }
        let copies = self.manifest.files.iter().filter(|entry| entry.copy.is_some()).count();
        match self.manifest.write(self.folder) {
            Ok(()) => self.screen.note(&format!(
                "{copies} of {} files are in {}; --resume goes on from here",
                self.total,
                self.folder.display()
            )),
            Err(failure) => self.screen.note(&format!("{MANIFEST} was not written: {failure}")),
        }
    }
}

/// What is in the folder now.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BackedUp {
    /// The folder.
    folder: String,
    /// The list of what is in it.
    manifest: String,
    /// Whether nothing is missing.
    complete: bool,
    #[serde(flatten)]
    results: Results,
}

impl BackedUp {
    fn new(folder: &Path, results: Results, complete: bool) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        Self { folder: folder.display().to_string(), manifest, complete, results }
    }
}

impl Report for BackedUp {
    fn view(&self) -> View {
        View::table(self.results.table())
    }

    fn failure(&self) -> Option<Failure> {
        let failure = self.results.failure()?;
        let hint = match &failure.hint {
            Some(hint) => format!("{hint}\n--resume fetches what is missing"),
            None => "--resume fetches what is missing".to_owned(),
        };
        Some(failure.hint(hint))
    }
}

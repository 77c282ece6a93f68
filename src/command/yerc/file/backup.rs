//! `yerc file backup`: every file of the controller in a folder, with a list of itself.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::time::Instant;

use super::manifest::{Controller, Manifest};
use super::name::{self, Shown, TypeArg, type_word};
use super::results::{FileResult, Results, Shape};
use super::transfer;
use crate::command::backup::manifest;
use crate::command::backup::manifest::{Entry, Hash, MANIFEST, Reason, Saved, State};
use crate::command::backup::{self, Items, Making, Only};
use crate::command::frame::local::{LocalNames, Target, make_folder, own_folder};
use crate::command::yerc::link::Link;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context, Report};
use crate::controller::text::hex;
use crate::controller::yerc::files::{self, FileType};
use crate::controller::yerc::query::Query as _;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::View;

/// Fetches every file into a folder.
#[derive(Debug, Args)]
pub struct Backup {
    /// Folder, made if it is not there
    folder: PathBuf,
    /// Which types, such as jbi,dat [default: all, or those of the backup that goes on]
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true)]
    types: Vec<TypeArg>,
    /// What is asked for, where that was said for all families
    #[arg(skip)]
    scope: Option<Vec<String>>,
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

impl Backup {
    /// Of what is asked for in any family.
    pub fn of(making: &Making) -> Self {
        let Making { folder, scope, resume, force } = making.clone();
        Self { folder, types: Vec::new(), scope, resume, force }
    }

    /// What is asked for, as the list says it; `None` if nobody says.
    fn scope(&self) -> Option<Vec<String>> {
        let types = TypeArg::chosen(&self.types);
        match types.len() {
            0 => self.scope.clone(),
            all if all == FileType::ALL.len() => Some(Vec::new()),
            _ => Some(types.into_iter().map(|kind| format!("{TYPE}{}", type_word(kind))).collect()),
        }
    }
}

/// What was asked for, read back.
fn asked(scope: &[String]) -> (Vec<FileType>, Only) {
    let word = |kind: &FileType| scope.iter().any(|word| word.strip_prefix(TYPE) == Some(type_word(*kind)));
    let types: Vec<FileType> = FileType::ALL.into_iter().filter(word).collect();
    (if types.is_empty() { FileType::ALL.into() } else { types }, Only::of_scope(scope))
}

/// Before a type, in the scope of a backup.
const TYPE: &str = "type ";

impl Command for Backup {
    type Family = Yerc;
    type Report = BackedUp;
    const ID: &'static str = "yerc.file.backup";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<BackedUp, Failure> {
        let Context { link, screen, robot, several, .. } = context;
        let folder = own_folder(&self.folder, &robot.name, several);
        let scope = self.scope();
        let earlier: Option<Manifest> = manifest::earlier(&folder, robot, scope.as_deref(), self.resume, self.force)?;
        let scope = scope.or_else(|| earlier.as_ref().map(|earlier| earlier.scope.clone())).unwrap_or_default();
        let (types, only) = asked(&scope);
        if link.is_dry() {
            let question = Controller::question(link)?.request();
            link.plan_next(&question)?;
            transfer::plan_all(link, transfer::LISTS, types.iter().map(|kind| files::list(*kind)))?;
            link.then("fetches every file that the lists name (service 0x16), and acknowledges each of its blocks");
            return Ok(BackedUp::new(&folder, Results::new(Vec::new(), SHAPE), &scope, false));
        }
        let controller = Controller::ask(link).await?;
        let mut work = Vec::new();
        let mut refused = Vec::new();
        // The file service may be busy with what somebody else broke off.
        let looking = screen.spinner("looking for files");
        for kind in &types {
            match transfer::list(link, *kind).await {
                Ok(names) => work.extend(names.into_iter().map(|name| (*kind, name))),
                Err(failure) if failure.kind == Kind::Refused => refused.push((*kind, failure)),
                Err(failure) => return Err(transfer::about(&kind.filter(), failure)),
            }
        }
        drop(looking);
        let shown = |name: &[u8]| link.encoding.decode(name);
        let names: Vec<String> = work.iter().map(|(_, name)| shown(name)).collect();
        only.check(&names)?;
        work.retain(|(_, name)| only.has(&shown(name)));
        make_folder(&folder)?;
        let mut manifest = Manifest::new(robot, controller, scope.clone());
        // What was saved before stays in the list until its turn, so that it is kept whenever this is cut off.
        let is_wanted = |entry: &&Entry| entry.copy.is_some() && work.iter().any(|(_, name)| is_of(entry, name));
        manifest.files = earlier.iter().flat_map(|list| &list.files).filter(is_wanted).cloned().collect();
        let mut ledger = Ledger::open(&folder, manifest, work.len(), screen)?;
        let mut results: Vec<FileResult> =
            work.iter().map(|(_, name)| FileResult::pending(Shown::new(link.encoding, name), None)).collect();
        let mut names = LocalNames::new(link.encoding);
        for (number, ((kind, name), result)) in work.iter().zip(&mut results).enumerate() {
            let file_type = type_word(FileType::from_name(name).unwrap_or(*kind)).to_owned();
            let mut entry = Entry {
                name: result.name.name.clone(),
                name_hex: Some(hex(name)),
                holds: file_type,
                ..Entry::default()
            };
            let local = names.assign(name);
            let kept = earlier.as_ref().and_then(|list| list.entry_of(name)?.copy.clone());
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
        Ok(BackedUp::new(&folder, results, &scope, complete))
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

fn is_of(entry: &Entry, name: &[u8]) -> bool {
    entry.name_hex.as_deref() == Some(&*hex(name))
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
        match self.manifest.files.iter_mut().find(|known| known.name_hex == entry.name_hex) {
            Some(known) => *known = entry,
            None => self.manifest.files.push(entry),
        }
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
    #[serde(skip)]
    of: (PathBuf, Vec<String>),
}

impl BackedUp {
    fn new(folder: &Path, results: Results, scope: &[String], complete: bool) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        let of = (folder.to_owned(), scope.to_vec());
        Self { folder: folder.display().to_string(), manifest, complete, results, of }
    }
}

impl From<BackedUp> for backup::BackedUp {
    fn from(BackedUp { complete, results, of: (folder, scope), .. }: BackedUp) -> Self {
        Self::new(&folder, scope, complete, Items::from(results))
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

//! `yerc names`: user-defined names of signals, variables and registers.

use jiff::Timestamp;

use super::check::software;
use super::file::{FileReading, read_files};
use crate::prelude::*;
use armctl_controller::yerc::names::{FILES, FileNames, read};
use armctl_frame::items::{self, ItemError};
use armctl_frame::settings::names::{CacheFile, CachedNames, KeptFile};

commands! {
    /// Commands for names.
    pub enum Names {
        /// Read the names from the controller and store them
        Get(Get),
        /// Remove the stored names
        Forget(Forget),
    }
}

/// Reads the names in the files of the controller, and stores them on this computer under the address of the
/// controller.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl reads the files IONAME.DAT, EXIONAME.DAT, VARNAME.DAT and IOMNAME.DAT. It skips a file that \
                  the controller does not have. After that, you can type a name instead of a number: `io get`, `io \
                  set`, `var get`, `var set`, `register get`, `teach`, `move --to`. The robot's names in robots.toml \
                  have priority (`armctl help inventory`). `armctl names list` shows all names. After a change on the \
                  controller, run this command again."
)]
pub struct Get {}

/// Removes the stored names of the controller. Names in robots.toml are not removed.
#[derive(Debug, Args)]
pub struct Forget {}

impl Command for Get {
    type Family = Yerc;
    type Report = Fetched;
    const ID: &'static str = "yerc.names.get";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Fetched> {
        let Context { link, robot, screen, .. } = context;
        let Some(answers) = read_files(link, screen, &FILES, MAX_FILE_SIZE).await? else {
            return Ok(Fetched::default());
        };
        let (mut files, mut kept, mut names) = (Vec::new(), Vec::new(), Vec::new());
        for (file, answer) in FILES.into_iter().zip(answers) {
            let found = match answer {
                FileReading::Read(bytes) => read(file, &bytes, link.encoding)
                    .map(|found| (found, bytes))
                    .map_err(|why| Failure::new(Kind::Malformed, format!("{file}: {why}")).hint(ANOTHER_FORM)),
                FileReading::Missing => {
                    files.push(OfFile { file, state: State::Missing, names: 0, passed_over: 0, error: None });
                    continue;
                }
                FileReading::Failed(failure) => Err(failure),
            };
            files.push(match found {
                Ok((FileNames { names: found, passed_over }, bytes)) => {
                    kept.push(KeptFile::new(file, &bytes, found.len()));
                    let row = OfFile { file, state: State::Read, names: found.len(), passed_over, error: None };
                    names.extend(found);
                    row
                }
                Err(failure) => {
                    let error = Some(ItemError::new(file, failure));
                    OfFile { file, state: State::Failed, names: 0, passed_over: 0, error }
                }
            });
        }
        items::all_failed(files.len(), files.iter().filter_map(|file| file.error.as_ref()))?;
        let mut report = Fetched { files, names: names.len(), kept: false, read_at: None };
        // An incomplete set of names must not replace a complete set.
        if report.failure().is_none()
            && let Some(place) = robot.names.cache_file()
        {
            let stored = CachedNames::new(place, link.encoding, reported_software(link).await, (kept, &names));
            place.write(&stored)?;
            (report.kept, report.read_at) = (true, Some(stored.read_at));
        }
        if !report.kept && robot.target.value.is_simulated() {
            screen.note(
                "Names of a simulator in this process are not stored: the simulator always reads the names from its \
                 start files.",
            );
        }
        Ok(report)
    }
}

/// Software version of the controller; `None` if the controller refuses to report it.
async fn reported_software(link: &mut Link) -> Option<String> {
    if link.reported_software().is_none() {
        // The names are valid without the software version.
        let _refused = software(link).await;
    }
    link.reported_software()
}

/// Maximum size of a file with names. Such a file has some ten thousand lines.
const MAX_FILE_SIZE: u64 = 8 << 20;
const ANOTHER_FORM: &str =
    "define names in robots.toml instead; armctl reads only the format of FS100, DX200 and YRC1000";

/// Names that were read from the controller.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Fetched {
    files: Vec<OfFile>,
    /// Number of names in all files.
    names: usize,
    /// Whether the names are stored for later commands.
    kept: bool,
    /// Time at which the names were read, if they are stored.
    #[schemars(with = "Option<String>", extend("format" = "date-time"))]
    read_at: Option<Timestamp>,
}

/// A file, and how many names it contains.
#[derive(Debug, Serialize, JsonSchema)]
struct OfFile {
    file: &'static str,
    state: State,
    names: usize,
    /// Number of lines that were skipped because they have another format.
    passed_over: usize,
    /// Reason why the file was not read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum State {
    Read,
    /// The file does not exist, or is empty.
    Missing,
    Failed,
}

impl Report for Fetched {
    fn view(&self) -> View {
        let mut table = Table::new(&["file", "names", "skipped", "result"], "no files");
        for file in &self.files {
            let result = match (file.state, &file.error) {
                (State::Missing, _) => "no such file".into(),
                (_, Some(error)) => error.cell(),
                (_, None) if self.kept => "kept".into(),
                (_, None) => "read".into(),
            };
            let passed_over = Cell::optional(Some(file.passed_over).filter(|lines| *lines > 0));
            table.row([file.file.into(), file.names.into(), passed_over, result]);
        }
        View::table(table.without_blank("skipped"))
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.files.len(), self.files.iter().filter_map(|file| file.error.as_ref()))
    }
}

impl Command for Forget {
    type Family = Yerc;
    type Report = Forgotten;
    const ID: &'static str = "yerc.names.forget";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Forgotten> {
        let place = context.robot.names.cache_file().filter(|_| !context.link.is_dry_run());
        Ok(Forgotten { forgotten: place.map_or(Ok(false), CacheFile::forget)? })
    }
}

/// Result of removing the stored names.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Forgotten {
    /// Whether there were stored names.
    forgotten: bool,
}

impl Report for Forgotten {
    fn view(&self) -> View {
        View::text(if self.forgotten { "forgotten" } else { "no names were stored" })
    }
}

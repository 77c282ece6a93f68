//! Robots of a fleet backup as simulators: `armctl sim --cell`.

use std::ffi::OsString;
use std::fmt::Write as _;

use clap::ValueHint;
use toml_edit::{Table as TomlTable, value};

use crate::command::families;
use armctl_controller::simulator::run_options::Speed;
use armctl_frame::SchemaEntry;
use armctl_frame::backup::manifest::{self, Manifest};
use armctl_frame::backup::recording::{self, Head, Recorded};
use armctl_frame::local_names::Target;
use armctl_frame::prelude::*;
use armctl_frame::serve;
use armctl_frame::settings::document::Document;
use armctl_frame::settings::inventory::{Inventory, is_name};

/// Simulators for the robots of a backup.
#[derive(Debug, Args)]
pub struct CellArguments {
    /// Simulate every robot of this backup on free ports of this computer; print the robots.toml that reaches them
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    cell: Option<PathBuf>,
    /// Write the robots.toml to this file
    #[arg(long, value_name = "FILE", requires = "cell")]
    inventory: Option<PathBuf>,
    /// Speed of the simulated time, such as 10x
    #[arg(long, value_name = "FACTOR", requires = "cell")]
    speed: Option<Speed>,
    /// Read console lines on stdin, for example `cell3 alarm 4315`; `help` lists the robots
    #[arg(long, requires = "cell")]
    console: bool,
    /// Give the answers of the recordings in the folder (`armctl record`) at the same times, also without a backup
    #[arg(long, requires = "cell")]
    replay: bool,
    /// Start the recordings again at their end [default: keep the last state]
    #[arg(long = "loop", requires = "replay")]
    is_loop: bool,
}

/// First words of a robots.toml that this command may replace.
const HEADER: &str = "# Simulated robots of the backup";

impl CellArguments {
    /// Whether the command serves a backup.
    pub fn is_named(&self) -> bool {
        self.cell.is_some()
    }

    /// Serves the robots until Ctrl-C.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        let folder = self.cell.unwrap_or_default();
        let inventory = self.inventory.map(replaceable).transpose()?;
        let (mut servers, mut robots, mut tables) = (Vec::new(), Vec::new(), Vec::new());
        let saved = if self.replay { recorded_robots_in(&folder)? } else { robots_in(&folder)? };
        // All robots start again together.
        let pass = if self.is_loop { Some(longest_recording(&saved)?) } else { None };
        for robot in saved {
            let named = |failure: Failure| {
                let message = format!("{}: {}", robot.name, failure.message);
                Failure { message, ..failure }
            };
            let server = robot.serve(self.speed.unwrap_or_default(), pass).await.map_err(named)?;
            tables.push(robot.entry(&server.target).map_err(named)?);
            robots.push(robot.report(&server.target));
            servers.push(server);
        }
        let text = inventory_text(&folder, tables)?;
        if let Some(target) = &inventory {
            let mut draft = target.begin()?;
            draft.write(text.as_bytes())?;
            draft.commit()?;
        }
        let inventory = inventory.map(|target| target.path().display().to_string());
        let shown = inventory.clone().unwrap_or_else(|| "FILE".to_owned());
        run.local(ID, &CellReport { inventory, robots, text })?;
        for server in &servers {
            if let Some(replay) = &server.replay {
                run.screen.note(&format!("{}: {replay}", server.name));
            }
        }
        if !run.screen.is_json() {
            let console = if self.console { " or `quit`; `help` lists the robots" } else { "" };
            run.screen.note(&format!("reach them: armctl --config {shown} status --all\nend them:   Ctrl-C{console}"));
        }
        serve::serve(servers, self.console, run).await
    }
}

/// Name in envelopes and schemas.
const ID: &str = "sim.cell";

/// Schema of the report.
pub fn schema() -> SchemaEntry {
    SchemaEntry::of::<CellReport>(ID)
}

/// A file that does not exist, or that this command has written.
fn replaceable(path: PathBuf) -> Result<Target> {
    let is_own = files::text(&path, files::SETTINGS).is_ok_and(|text| text.starts_with(HEADER));
    Target::new(path, is_own).map_err(|failure| failure.hint("use another path for the robots.toml of the cell"))
}

/// A robot of a backup.
#[derive(Debug)]
pub struct SavedRobot {
    /// Name of the robot.
    pub name: String,
    /// Family.
    pub family: Family,
    /// Folder of its backup.
    pub folder: PathBuf,
    /// Manifest of its backup; without a backup, of its recording.
    pub manifest: Manifest,
    /// Recording that its simulator replays.
    recording: Option<Head>,
}

/// Settings of an inventory entry that a manifest does not decide.
const OWN_KEYS: [&str; 3] = ["name", "target", "family"];

/// Robots of a backup: of one robot, or of a fleet with a subfolder for each robot.
pub fn robots_in(folder: &Path) -> Result<Vec<SavedRobot>> {
    saved_robots(folder, &[manifest::MANIFEST])
}

/// Robots of recordings and backups, in the same folders. At least one robot has a recording.
fn recorded_robots_in(folder: &Path) -> Result<Vec<SavedRobot>> {
    if !folder.join(recording::FILE).exists() && manifest::folders_with(folder, &[recording::FILE]).is_empty() {
        return Err(Failure::local(format!("{} contains no {}", folder.display(), recording::FILE))
            .hint(format!("record the robots: `armctl record {} --all`", folder.display())));
    }
    saved_robots(folder, &[manifest::MANIFEST, recording::FILE])
}

/// Duration of the longest recording.
fn longest_recording(robots: &[SavedRobot]) -> Result<Duration> {
    let passes = robots.iter().filter_map(SavedRobot::recording_path).map(|path| Ok(Recorded::read(&path)?.pass()));
    passes.collect::<Result<Vec<_>>>().map(|passes| passes.into_iter().max().unwrap_or_default())
}

/// Robots of the folders that contain one of these files.
fn saved_robots(folder: &Path, files: &[&str]) -> Result<Vec<SavedRobot>> {
    let is_saved = |folder: &Path| files.iter().any(|file| folder.join(file).exists());
    let folders = if is_saved(folder) { Vec::new() } else { manifest::folders_with(folder, files) };
    let folders = if folders.is_empty() { vec![folder.to_owned()] } else { folders };
    let mut robots: Vec<SavedRobot> = Vec::new();
    for folder in folders {
        let file = folder.join(recording::FILE);
        let recording = (files.contains(&recording::FILE) && file.exists()).then(|| Head::read(&file)).transpose()?;
        let manifest = match &recording {
            Some(head) if !folder.join(manifest::MANIFEST).exists() => head.manifest.clone(),
            _ => manifest::open_existing(&folder)?,
        };
        if let Some(Head { manifest: recorded, .. }) = &recording
            && (&recorded.robot, &recorded.family) != (&manifest.robot, &manifest.family)
        {
            let (backup, recorded) = (&manifest.robot, &recorded.robot);
            return Err(Failure::local(format!("{}: the recording is of {recorded}, not of {backup}", file.display()))
                .hint("move the recording to the folder of its robot"));
        }
        let family = manifest.family.parse().map_err(|why| Failure::local(format!("{}: {why}", folder.display())))?;
        let name = manifest.robot.clone();
        let invalid = |why: &str| {
            Err(Failure::local(format!("{}: {why}", folder.display())).hint("correct `robot` in the manifest.json"))
        };
        if !is_name(&name) {
            return invalid(&format!("'{name}' is not a valid robot name"));
        }
        if robots.iter().any(|known| known.name == name) {
            return invalid(&format!("two backups are of a robot '{name}'"));
        }
        robots.push(SavedRobot { name, family, folder, manifest, recording });
    }
    Ok(robots)
}

impl SavedRobot {
    /// Serves the robot on free ports of the loopback interface.
    async fn serve(&self, speed: Speed, pass: Option<Duration>) -> Result<serve::NamedServer> {
        let mut arguments: Vec<OsString> = ["--bind", "127.0.0.1:0", "--speed"].map(OsString::from).into();
        arguments.push(speed.to_string().into());
        if self.folder.join(manifest::MANIFEST).exists() {
            arguments.extend(["--from".into(), self.folder.clone().into()]);
        } else if let Some(model) = self.recording.as_ref().and_then(|head| head.model.as_ref()) {
            arguments.extend(["--model".into(), model.into()]);
        }
        if let Some(recording) = self.recording_path() {
            arguments.extend(["--replay".into(), recording.into()]);
            arguments.extend(pass.map(|pass| format!("--loop={}", duration::display(pass)).into()));
        }
        (families::of(self.family).serve)(self.name.clone(), arguments).await
    }

    fn recording_path(&self) -> Option<PathBuf> {
        self.recording.as_ref().map(|_| self.folder.join(recording::FILE))
    }

    /// URL of the simulator of the robot in this process.
    pub fn simulator_url(&self) -> Result<String> {
        let path = std::path::absolute(&self.folder).map_err(|error| Failure::io(self.folder.display(), &error))?;
        let mut url = "sim:?from=".to_owned();
        for byte in path.as_os_str().as_encoded_bytes() {
            if byte.is_ascii_alphanumeric() || b"/-_.:\\".contains(byte) {
                url.push(char::from(*byte));
            } else {
                let _ = write!(url, "%{byte:02X}");
            }
        }
        Ok(url)
    }

    /// Inventory entry of the robot at another target.
    pub fn entry(&self, target: &str) -> Result<TomlTable> {
        let mut table = TomlTable::new();
        table["name"] = value(&self.name);
        table["target"] = value(target);
        table["family"] = value(self.family.name());
        let settings = toml_edit::ser::to_document(&self.manifest.inventory).map_err(|error| self.damaged(&error))?;
        for (key, setting) in settings.iter().filter(|(key, _)| !OWN_KEYS.contains(key)) {
            table.insert(key, setting.clone());
        }
        Ok(table)
    }

    fn damaged(&self, why: &dyn fmt::Display) -> Failure {
        Failure::local(format!("{}: `inventory` is damaged: {why}", self.folder.join(manifest::MANIFEST).display()))
            .hint("remove `inventory` from the manifest.json")
    }

    fn report(&self, target: &str) -> CellRobot {
        CellRobot {
            robot: self.name.clone(),
            family: self.family.name(),
            target: target.to_owned(),
            backup: self.folder.display().to_string(),
            recording: self.recording_path().map(|path| path.display().to_string()),
            taken_at: self.manifest.taken_at.to_string(),
            replaces: self.manifest.target.clone(),
        }
    }
}

/// A `robots.toml` with these entries. It has the settings that the backup contains.
pub fn inventory_text(folder: &Path, entries: Vec<TomlTable>) -> Result<String> {
    let broken = |why: &str| Failure::local(format!("internal error: {why}"));
    let mut document = Document::parse("").map_err(|error| broken(&error.to_string()))?;
    let (count, mut has_default) = (entries.len(), false);
    for mut entry in entries {
        let is_default = entry.remove(manifest::DEFAULT).is_some_and(|item| item.as_bool() == Some(true));
        has_default |= is_default;
        document.add(entry, is_default).map_err(broken)?;
    }
    // Without a default robot in the plant, a command that names no robot is refused, here as there.
    if count > 1 && !has_default {
        document.remove_default();
    }
    let shown = folder.display().to_string().replace(char::is_control, "?");
    let text = format!("{HEADER} {shown}, served by `armctl sim --cell`\n{document}");
    Inventory::parse(&text, "robots.toml of the cell")?;
    Ok(text)
}

/// Simulated robots of a backup.
#[derive(Debug, Serialize, JsonSchema)]
struct CellReport {
    /// File with the robots.toml; null if the robots.toml was printed.
    inventory: Option<String>,
    /// Robots.
    robots: Vec<CellRobot>,
    /// Content of the robots.toml. Programs read the robots instead.
    #[serde(skip)]
    text: String,
}

/// A simulated robot of a backup.
#[derive(Debug, Serialize, JsonSchema)]
struct CellRobot {
    robot: String,
    family: &'static str,
    /// URL of the simulator.
    target: String,
    /// Folder of the backup and the recording.
    backup: String,
    /// File with the recording that the simulator replays; null without --replay.
    recording: Option<String>,
    /// Time when the backup started; without a backup, the recording.
    taken_at: String,
    /// URL of the robot in the backup.
    replaces: String,
}

impl Report for CellReport {
    fn view(&self) -> View {
        if self.inventory.is_none() {
            return View::text(self.text.trim_end());
        }
        let has_recordings = self.robots.iter().any(|robot| robot.recording.is_some());
        let last = if has_recordings { "recording" } else { "backup of" };
        let mut table = Table::new(&["robot", "target", "replaces", last], "");
        for robot in &self.robots {
            let target = Cell::from(robot.target.as_str()).whole();
            let replaces = Cell::from(robot.replaces.as_str()).whole();
            let last = if has_recordings {
                Cell::optional(robot.recording.as_deref())
            } else {
                robot.taken_at.as_str().into()
            };
            table.row([robot.robot.as_str().into(), target, replaces, last]);
        }
        View::table(table)
    }
}

//! Sessions in a background process.

use std::ffi::OsString;

use serde::Deserialize;
use tokio::task::spawn_blocking;

use super::interrupt::interruptible;
use super::session_client::{folder_failure, session_key};
use crate::prelude::basics::*;
use armctl_transport::session::location::SessionFolder;
use armctl_transport::session::{detach, process, start_file, terminate};

/// Flag of the process in the background.
pub const DETACHED: &str = "--detached";

/// Result of opening a session.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub struct Opened {
    robot: String,
    family: String,
    target: String,
    /// Process that has the link.
    pid: u32,
    /// Whether the process runs in the background.
    background: bool,
    /// Log file of a background session.
    log: Option<String>,
}

impl Opened {
    /// A session in this process.
    pub fn here(robot: &Robot, background: bool, log: Option<&Path>) -> Self {
        Self {
            robot: robot.name.clone(),
            family: robot.family.name().to_owned(),
            target: robot.target.value.url().to_owned(),
            pid: process(),
            background,
            log: log.map(|log| log.display().to_string()),
        }
    }
}

/// Start message of the background process, in one line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// The link is open.
    Opened(Opened),
    /// The link could not be opened.
    Failed(Failure),
}

/// Reports the start of this background process to the process that started it.
pub fn report_start(screen: &Screen, start: &Start) -> Result<()> {
    let Some(path) = start_file() else { return screen.json(start) };
    let line = serde_json::to_vec(start).context("internal error")?;
    files::replace(&path, &line).with_context(|| path.display().to_string())?;
    Ok(())
}

impl Report for Opened {
    fn view(&self) -> View {
        let log = self.log.as_ref().map(|log| format!("; log: {log}")).unwrap_or_default();
        View::text(format!("{} ({}): held by process {}{log}", self.robot, self.target, self.pid))
    }
}

/// Opens a background session for a robot. Its inventory entry has `hold = true`.
pub async fn open_session(robot: &Robot, inventory: Option<&Path>, screen: &Screen) -> Result<()> {
    let mut words: Vec<OsString> = Vec::new();
    if let Some(path) = inventory {
        words.extend(["--config".into(), path.into()]);
    }
    words.extend(["-r", &robot.name, "session", "open", DETACHED].map(OsString::from));
    let opened = start(robot, words.into_iter()).await?;
    screen.note(&format!(
        "{}: session opened (process {}); use `armctl session close {}` to close it",
        robot.label(),
        opened.pid,
        robot.name
    ));
    Ok(())
}

/// Closes the files that the starter of this process left open. A lock or pipe of another program must not stay open as
/// long as the session. Only a process that has not opened a file itself may call this function.
#[cfg(unix)]
pub fn close_inherited_files() {
    // Without this folder, the process cannot list its open files.
    let Ok(open) = std::fs::read_dir("/dev/fd") else { return };
    let open: Vec<i32> = open.filter_map(|file| file.ok()?.file_name().to_str()?.parse().ok()).collect();
    for file in open.into_iter().filter(|file| *file > 2) {
        // One of these descriptors was open only for the list of the folder, and is closed already. Its error is
        // ignored.
        let _ = nix::unistd::close(file);
    }
}

/// Starts this program in the background with these arguments, and waits until the background process has opened its
/// link.
pub async fn start(robot: &Robot, words: impl Iterator<Item = OsString>) -> Result<Opened> {
    let folder = SessionFolder::create().map_err(|error| folder_failure(&error))?;
    let log = folder.location(&session_key(robot)).log();
    let mut child = detach(words, &log).context("cannot start armctl in the background")?;
    let pid = child.pid();
    let line = match interruptible(spawn_blocking(move || child.line())).await {
        Ok(line) => {
            line.map_err(|error| Failure::local(format!("cannot read from armctl in the background: {error}")))?
        }
        Err(interrupt) => {
            // The process may have ended already.
            let _ = terminate(pid);
            return Err(interrupt);
        }
    };
    let line = line.context("no answer from armctl in the background")?;
    match serde_json::from_str(&line) {
        Ok(Start::Opened(opened)) => Ok(opened),
        Ok(Start::Failed(failure)) => Err(failure),
        Err(_) => {
            Err(Failure::local(format!("{}: the session process failed", robot.label())).hint(if cfg!(windows) {
                "open the session without --background to see the reason".to_owned()
            } else {
                format!("see {} for the reason", log.display())
            }))
        }
    }
}

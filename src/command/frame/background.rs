//! Sessions of another process, which goes on behind the terminal.

use std::ffi::OsString;
use std::path::Path;

use anyhow::Context as _;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use tokio::task::spawn_blocking;

use super::attach::{key_of, no_place};
use super::interrupt::interruptible;
use super::report::Report;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::View;
use crate::settings::Robot;
use crate::transport::session::place::Place;
use crate::transport::session::{detach, process, terminate};

/// A session that holds a link.
#[derive(Debug, Serialize, Deserialize, JsonSchema)]
pub struct Opened {
    robot: String,
    family: String,
    target: String,
    /// The process that holds it.
    pid: u32,
    /// Whether it goes on behind the terminal.
    background: bool,
    /// Where it then writes what happens.
    log: Option<String>,
}

impl Opened {
    /// One that this process holds.
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

/// What the process behind the terminal tells the one in front of it, in a line.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Start {
    /// The link is up.
    Opened(Opened),
    /// It is not, and why.
    Failed(Failure),
}

impl Report for Opened {
    fn view(&self) -> View {
        let log = self.log.as_ref().map(|log| format!("; log: {log}")).unwrap_or_default();
        View::text(format!("{} ({}): held by process {}{log}", self.robot, self.target, self.pid))
    }
}

/// Opens a session in the background for a robot of the inventory whose entry wants one (`hold = true`).
pub async fn open_for(robot: &Robot, inventory: Option<&Path>, screen: &Screen) -> Result<(), Failure> {
    let mut words: Vec<OsString> = Vec::new();
    if let Some(path) = inventory {
        words.extend(["--config".into(), path.into()]);
    }
    words.extend(["-r", &robot.name, "session", "open", "--detached"].map(OsString::from));
    let opened = start(robot, words.into_iter()).await?;
    screen.note(&format!(
        "{}: a session was opened (process {}); `armctl session close {}` ends it",
        robot.label(),
        opened.pid,
        robot.name
    ));
    Ok(())
}

/// Starts this program again behind the terminal with these words, and waits until its link is up.
pub async fn start(robot: &Robot, words: impl Iterator<Item = OsString>) -> Result<Opened, Failure> {
    let place = Place::make().map_err(|error| no_place(&error))?;
    let log = place.spot(&key_of(robot)).log();
    let mut child = detach(words, &log).context("this program, in the background")?;
    let pid = child.pid();
    let line = match interruptible(spawn_blocking(move || child.line())).await {
        Ok(line) => line.map_err(|error| Failure::local(format!("the background: {error}")))?,
        Err(interrupt) => {
            terminate(pid);
            return Err(interrupt);
        }
    };
    let line = line.context("the background")?;
    match serde_json::from_str(&line) {
        Ok(Start::Opened(opened)) => Ok(opened),
        Ok(Start::Failed(failure)) => Err(failure),
        Err(_) => Err(Failure::local(format!("{}: the session broke down", robot.label()))
            .hint(format!("{} may tell why", log.display()))),
    }
}

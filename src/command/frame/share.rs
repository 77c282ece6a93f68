//! Links that take one client: what goes on looking opens a session, so that other commands are not in its way.

use std::ffi::OsString;
use std::time::Duration;

use super::attach::is_held;
use super::background::start;
use super::connection::Driver;
use crate::failure::{Failure, Kind};
use crate::settings::{Origin, Robot, Sessions, duration};

/// How long such a session goes on once nobody uses it.
const IDLE: Duration = Duration::from_secs(5);

/// Whether the link of a robot takes one client, and others may share it.
pub fn is_to_share(driver: &dyn Driver, robot: &Robot) -> bool {
    robot.sessions == Sessions::Shared && driver.takes_one_client(robot)
}

/// Has a session hold the link of a robot which takes one client: that of somebody else, or a new one in the background.
/// The robot as it is to be reached then.
///
/// # Errors
/// Why the link cannot be opened.
pub async fn shared(driver: &dyn Driver, robot: &Robot) -> Result<Robot, Failure> {
    if !is_to_share(driver, robot) {
        return Ok(robot.clone());
    }
    if !is_held(robot) {
        match start(robot, words(robot).into_iter()).await {
            Ok(_) => {}
            // Somebody else was faster.
            Err(_) if is_held(robot) => {}
            // There is no place for sessions, or no room for another process.
            Err(failure) if failure.kind == Kind::Local => return Ok(robot.clone()),
            Err(failure) => return Err(failure),
        }
    }
    Ok(Robot { sessions: Sessions::Only, ..robot.clone() })
}

/// The words that open a session which ends by itself.
fn words(robot: &Robot) -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    if let Some(path) = &robot.inventory {
        words.extend(["--config".into(), path.into()]);
    }
    let (idle, family, url) = (duration::display(IDLE), robot.family.name(), robot.target.value.url());
    let (flag, name) = if robot.target.origin == Origin::Robot { ("-r", &robot.name[..]) } else { ("-t", url) };
    let opens = [flag, name, "session", "open", "--detached", "--idle", &idle, "--family", family];
    words.extend(opens.map(OsString::from));
    words
}

//! Session for long reads on a link that accepts only one client, so that other commands can run at the same time.

use std::ffi::OsString;
use std::time::Duration;

use super::background::{DETACHED, start};
use super::connection::Driver;
use super::session_client::is_held;
use crate::failure::{Failure, Kind};
use crate::settings::{Origin, Robot, Sessions, duration};

/// Idle time after which a session that was opened for a long read closes.
const IDLE_TIMEOUT: Duration = Duration::from_secs(5);

/// Whether the robot accepts only one client, and other commands may share its link.
pub fn can_share(driver: &Driver, robot: &Robot) -> bool {
    robot.sessions == Sessions::Shared && (driver.takes_one_client)(robot)
}

/// Opens a background session for a robot that accepts only one client, or uses an existing session. Returns the robot
/// with the setting to use this session.
///
/// # Errors
/// If the link cannot be opened.
pub async fn open_shared_session(driver: &Driver, robot: &Robot) -> Result<Robot, Failure> {
    if !can_share(driver, robot) {
        return Ok(robot.clone());
    }
    if !is_held(robot) {
        match start(robot, session_arguments(robot).into_iter()).await {
            Ok(_) => {}
            // Another process opened a session in the meantime.
            Err(_) if is_held(robot) => {}
            // The session folder or a background process is not possible here, so the command uses its own link.
            Err(failure) if failure.kind == Kind::Local => return Ok(robot.clone()),
            Err(failure) => return Err(failure),
        }
    }
    Ok(Robot { sessions: Sessions::Only, ..robot.clone() })
}

/// Command-line arguments that open a session with an idle timeout.
fn session_arguments(robot: &Robot) -> Vec<OsString> {
    let mut words: Vec<OsString> = Vec::new();
    if let Some(path) = &robot.inventory {
        words.extend(["--config".into(), path.into()]);
    }
    let (idle, family, url) = (duration::display(IDLE_TIMEOUT), robot.family.name(), robot.target.value.url());
    let (flag, name) = if robot.target.origin == Origin::Robot { ("-r", &robot.name[..]) } else { ("-t", url) };
    let opens = [flag, name, "session", "open", DETACHED, "--idle", &idle, "--family", family];
    words.extend(opens.map(OsString::from));
    words
}

//! Completion values that only a controller has.
//!
//! The values come from reports of read commands, through an open session or from a simulator. A key press must never
//! open a link to a real controller, change anything, or wait long. Values that arrive too late are not offered.

use std::sync::mpsc::{self, Sender};
use std::time::Instant;

use tokio::time::timeout;

use crate::app::parser::Parser;
use crate::app::prepare::{Invocation, Task};
use armctl_frame::output::{ColorChoice, Format, escape};
use armctl_frame::prelude::*;
use armctl_frame::settings::{Sessions, Setting, Sources};
use armctl_frame::value_kind::{Ask, CandidateFunction};
use armctl_frame::{AnyContext, Candidate, ConnectionEffect};

/// Maximum time to wait for a robot.
pub(super) const ASK_TIMEOUT: Duration = Duration::from_millis(300);

/// Returns the values that the robot of the line reports in time.
pub(super) fn values(
    family: Family,
    ask: CandidateFunction,
    sources: &Sources,
    (time_limit, connects): (Duration, bool),
) -> Vec<Candidate> {
    let Some(robot) = robot(family, sources, time_limit, connects) else { return Vec::new() };
    let until = Instant::now() + time_limit;
    let (found, arrived) = mpsc::channel();
    // The request runs on its own thread: the line editor may call this function from any context, and the wait must be
    // limited.
    let asking = move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        if let Ok(runtime) = runtime {
            // A timeout is not an error: the values that were found before are used.
            let _ = runtime.block_on(async { timeout(time_limit, ask(&LiveReader::new(robot, found))).await });
            runtime.shutdown_background();
        }
    };
    if std::thread::Builder::new().name("completion".to_owned()).spawn(asking).is_err() {
        return Vec::new();
    }
    let mut values: Vec<Candidate> = Vec::new();
    while let Ok(value) = arrived.recv_timeout(until.saturating_duration_since(Instant::now())) {
        values.push(value);
    }
    // Values with control characters are removed, because they cannot be typed.
    values.retain(|value| escape::line(&value.value) == value.value);
    values
}

/// Returns the robot of the line, if there is exactly one. A real controller is reached only through a session, unless
/// `connects` is `true`.
fn robot(family: Family, sources: &Sources, time_limit: Duration, connects: bool) -> Option<Robot> {
    let [robot] = <[Robot; 1]>::try_from(sources.robots(Some(family)).ok()?).ok()?;
    let sessions = match (robot.target.value.is_simulated(), robot.sessions) {
        (true, sessions) => sessions,
        (false, sessions) if connects => sessions,
        (false, Sessions::None) => return None,
        (false, _) => Sessions::Only,
    };
    let time_limit = Setting { value: time_limit, ..robot.timeout };
    let retries = Setting { value: 0, ..robot.retries };
    Some(Robot { sessions, timeout: time_limit, retries, ..robot })
}

/// Reader of values from one robot.
struct LiveReader {
    robot: Robot,
    found: Sender<Candidate>,
    start: Instant,
}

impl LiveReader {
    fn new(robot: Robot, found: Sender<Candidate>) -> Self {
        Self { robot, found, start: Instant::now() }
    }

    async fn report(&self, words: &[&str]) -> Option<Value> {
        // Send no request that the time limit would probably interrupt.
        if self.start.elapsed() > self.robot.timeout.value / 2 {
            return None;
        }
        let args: Vec<_> = ["armctl"].iter().chain(words).map(Into::into).collect();
        let Invocation::Task(Task::Family(_, command)) = Parser::default().parse(&args).ok()?.command.into() else {
            return None;
        };
        let typed = Some(Arc::from("completion of a command line"));
        let robot = &self.robot;
        // If the end of a connection stops the controller, only a session may be used.
        if robot.sessions != Sessions::Only && command.connection_effect(robot) != ConnectionEffect::Harmless {
            return None;
        }
        let access = Access { typed, ..Access::reading(command.connect_mode(robot)) };
        let screen = Screen::new(Format::Json, ColorChoice::Never, true, 0).silenced();
        let mut connection = command.connect(robot, access, &screen).await.ok()?;
        let confirmer = Confirmer::reading(&screen, robot);
        let context = AnyContext { robot, connection: &mut *connection, screen: &screen, several: false, confirmer };
        let report = command.run(context).await;
        connection.close(&screen).await.ok()?;
        report.ok()?.data().ok()
    }
}

impl Ask for LiveReader {
    fn data<'a>(&'a self, words: &'a [&'a str]) -> LocalBoxFuture<'a, Option<Value>> {
        self.report(words).boxed_local()
    }

    fn add_candidate(&self, candidate: Candidate) {
        // An error is ignored: the receiver may already be gone.
        let _ = self.found.send(candidate);
    }
}

//! Common parts of long-running services: log of robot events, and notifications to the service manager.

use std::cell::RefCell;
use std::io;
use std::time::Instant;

use tokio::time::sleep;

use super::poll::{Event, RobotId};
use armctl_frame::output::log::Level;
#[cfg(unix)]
use armctl_frame::output::{escape, log};
use armctl_frame::prelude::*;
use armctl_frame::repeat_limiter::{Line, RepeatLimiter};
#[cfg(unix)]
use armctl_transport::journal::{Journal, PLACE};
use armctl_transport::supervisor::Supervisor;

/// Time limit for a service to stop.
pub const END_TIMEOUT: Duration = Duration::from_millis(800);

/// A running service with its log and service manager.
#[derive(Debug)]
pub struct Service {
    log: Log,
    supervisor: Supervisor,
    state: RefCell<ServiceState>,
}

impl Service {
    /// Finds the service manager of the environment, and raises the limit of open files.
    pub fn begin(screen: Screen) -> Result<Self> {
        make_room();
        let supervisor = Supervisor::find().map_err(|error| unreachable(&error))?;
        Ok(Self { log: Log::new(screen), supervisor, state: RefCell::default() })
    }

    /// Logs a poller event.
    pub fn note(&self, event: &Event) {
        self.state.borrow_mut().note(&self.log, event);
    }

    /// Logs a message with journal fields.
    pub fn log_line(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        self.log.say(level, text, fields);
    }

    /// Status line of the robots: `3 robots, 2 answer`.
    pub fn robots(&self) -> String {
        self.state.borrow().status()
    }

    /// Reports to the service manager that polling has started.
    pub fn notify_ready(&self, robots: usize) -> Result<()> {
        let plural = if robots == 1 { "" } else { "s" };
        self.supervisor.ready(&format!("{robots} robot{plural}")).map_err(|error| unreachable(&error))
    }

    /// Sends watchdog messages with the status to the service manager. Does not end.
    pub async fn watchdog_interval(&self, status: impl Fn() -> String) {
        /// Interval of the status without a watchdog.
        const STATUS: Duration = Duration::from_secs(30);

        let every = self.supervisor.keepalive_interval().unwrap_or(STATUS);
        let mut notification = true;
        loop {
            sleep(every).await;
            self.log.summarize(false);
            let now = self.supervisor.send_keepalive(&status());
            if let (Err(error), true) = (&now, notification) {
                self.log_line(Level::Error, &format!("cannot reach the service manager: {error}"), &[]);
            }
            notification = now.is_ok();
        }
    }

    /// Reports to the service manager that the service stops.
    pub fn notify_stopping(&self) {
        self.log.summarize(true);
        // The error can no longer be reported.
        let _told = self.supervisor.stopping();
    }
}

fn unreachable(error: &io::Error) -> Failure {
    Failure::io("NOTIFY_SOCKET", error)
}

/// Log of a service: the systemd journal if stderr is connected to it, otherwise stderr.
#[derive(Debug)]
struct Log {
    screen: Screen,
    limiter: RefCell<RepeatLimiter>,
    #[cfg(unix)]
    journal: Option<Journal>,
}

impl Log {
    #[cfg(unix)]
    fn new(screen: Screen) -> Self {
        // If the journal cannot be opened, use stderr.
        let journal = log::is_journal_socket().then(|| Journal::at(Path::new(PLACE)).ok()).flatten();
        Self { screen, limiter: RefCell::default(), journal }
    }

    #[cfg(not(unix))]
    fn new(screen: Screen) -> Self {
        Self { screen, limiter: RefCell::default() }
    }

    fn say(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        if self.screen.is_enabled(level) {
            let lines = self.limiter.borrow_mut().lines(Line::new(level, text, fields), Instant::now());
            self.print_all(lines);
        }
    }

    /// Prints the number of repeated lines.
    fn summarize(&self, is_end: bool) {
        let due = self.limiter.borrow_mut().due(Instant::now(), is_end);
        self.print_all(due);
    }

    fn print_all(&self, lines: Vec<Line>) {
        for Line { level, text, fields } in lines {
            let fields: Vec<_> = fields.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
            self.print(level, &text, &fields);
        }
    }

    fn print(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        if !self.is_written(level, text, fields) {
            self.screen.log(level, text, fields);
        }
    }

    /// Writes a journal entry. Returns whether it succeeded.
    #[cfg(unix)]
    fn is_written(&self, level: Level, text: &str, fields: &[(&str, &str)]) -> bool {
        let Some(journal) = &self.journal else { return false };
        let (message, priority) = (escape::line(text), level.priority().to_string());
        let values: Vec<String> = fields.iter().map(|(_, value)| log::value(value)).collect();
        let mut entry = vec![("MESSAGE", &message[..]), ("PRIORITY", &priority), ("SYSLOG_IDENTIFIER", "armctl")];
        entry.extend(fields.iter().map(|(name, _)| *name).zip(values.iter().map(String::as_str)));
        journal.write(&entry).is_ok()
    }

    #[cfg(not(unix))]
    fn is_written(&self, _level: Level, _text: &str, _fields: &[(&str, &str)]) -> bool {
        false
    }
}

/// Logs changes only once, however often they are seen.
#[derive(Debug, Default)]
struct ServiceState {
    /// Whether each robot answers; `None` if unknown.
    answering: BTreeMap<RobotId, Option<bool>>,
    /// Last read errors of the inventory and of the alarm texts.
    inventory_error: [Option<String>; 2],
    /// Whether the start is over. A robot that appears later was added by a change of the inventory.
    has_begun: bool,
}

impl ServiceState {
    fn note(&mut self, log: &Log, event: &Event) {
        match event {
            Event::Appeared(robot) => {
                self.answering.insert(RobotId::for_robot(robot), None);
                if self.has_begun {
                    say(log, Level::Notice, robot, "is polled from now on");
                }
            }
            Event::Gone(robot) => {
                self.answering.remove(&RobotId::for_robot(robot));
                say(log, Level::Notice, robot, "is no longer polled");
            }
            Event::Polled(look) => {
                if self.answering.insert(RobotId::for_robot(&look.robot), Some(true)) == Some(Some(false)) {
                    say(log, Level::Notice, &look.robot, "answers again");
                }
                self.unread(log, 1, look.unexplained.as_ref());
            }
            Event::Failed { robot, failure, .. } => {
                if self.answering.insert(RobotId::for_robot(robot), Some(false)) != Some(Some(false)) {
                    failed(log, robot, failure);
                }
            }
            Event::Inventory(read) => {
                self.has_begun = true;
                if read.is_ok() {
                    log.say(Level::Notice, "the inventory has changed and was read again", &[]);
                }
                self.unread(log, 0, read.as_ref().err());
            }
        }
    }

    fn status(&self) -> String {
        let answer = self.answering.values().filter(|answers| **answers == Some(true)).count();
        let robots = self.answering.len();
        let (plural, verb) = (if robots == 1 { "" } else { "s" }, if answer == 1 { "answers" } else { "answer" });
        format!("{robots} robot{plural}, {answer} {verb}")
    }

    /// Logs a read error, once per text.
    fn unread(&mut self, log: &Log, which: usize, why: Option<&Failure>) {
        let Some(failure) = why else {
            // A poll without a fault does not need alarm texts, so it does not clear the error of `alarms.toml`.
            if which == 0 {
                self.inventory_error[which] = None;
            }
            return;
        };
        if self.inventory_error[which].as_ref() != Some(&failure.message) {
            let effect = if which == 0 {
                "armctl keeps the earlier robots"
            } else {
                "armctl does not use the texts of this file"
            };
            log.say(Level::Warning, &format!("{}; {effect}", failure.message), &[("kind", &kind(failure))]);
            self.inventory_error[which] = Some(failure.message.clone());
        }
    }
}

/// Logs a message about a robot.
fn say(log: &Log, level: Level, robot: &Robot, what: &str) {
    log.say(level, &format!("{}: {what}", robot.label()), &fields_of(robot));
}

/// Journal fields of a robot.
fn fields_of(robot: &Robot) -> [(&'static str, &str); 2] {
    [("robot", robot.name.as_str()), ("family", robot.family.name())]
}

/// Logs a failed poll.
fn failed(log: &Log, robot: &Robot, failure: &Failure) {
    let kind = kind(failure);
    let mut fields = fields_of(robot).to_vec();
    fields.push(("kind", &kind));
    fields.extend(failure.code.as_deref().map(|code| ("code", code)));
    let label = robot.label();
    let message = &failure.message;
    let text = if message.contains(&label) { message.clone() } else { format!("{label}: {message}") };
    log.say(Level::Warning, &text, &fields);
}

/// Kind of a failure, as in the envelope: `no_answer`.
pub fn kind(failure: &Failure) -> String {
    let name = serde_json::to_value(failure.kind).ok();
    name.as_ref().and_then(Value::as_str).unwrap_or("other").to_owned()
}

/// Raises the soft limit of open files to the hard limit, because each robot needs a socket.
pub fn make_room() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

        let Rlimit { maximum, .. } = getrlimit(Resource::Nofile);
        // If this fails, the robot that gets no socket reports the failure.
        let _refused = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum });
    }
}

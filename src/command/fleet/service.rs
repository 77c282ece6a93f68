//! What those have in common that run as services: what they say of robots as they run, and to the service manager.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::time::Duration;

use tokio::time::sleep;

use super::poll::{Event, RobotId};
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::log::Level;
use crate::settings::Robot;
use crate::transport::supervisor::Supervisor;

/// A service as it runs: what it says, and who is told how it is.
#[derive(Debug)]
pub struct Service {
    screen: Screen,
    supervisor: Supervisor,
    journal: RefCell<Journal>,
}

impl Service {
    /// Finds the service manager that the environment names, and room for a socket each robot.
    pub fn begin(screen: Screen) -> Result<Self, Failure> {
        make_room();
        let supervisor = Supervisor::find().map_err(|error| unreached(&error))?;
        Ok(Self { screen, supervisor, journal: RefCell::new(Journal::new(screen)) })
    }

    /// Notes what was told of a poll.
    pub fn note(&self, event: &Event) {
        self.journal.borrow_mut().note(event);
    }

    /// Says what happens, with fields for the journal.
    pub fn say(&self, level: Level, text: &str, fields: &[(&str, &str)]) {
        self.screen.log(level, text, fields);
    }

    /// How the robots are, in a line: `3 robots, 2 answer`.
    pub fn robots(&self) -> String {
        self.journal.borrow().status()
    }

    /// Tells the service manager that so many robots are looked at from now on.
    pub fn ready(&self, robots: usize) -> Result<(), Failure> {
        let plural = if robots == 1 { "" } else { "s" };
        self.supervisor.ready(&format!("{robots} robot{plural}")).map_err(|error| unreached(&error))
    }

    /// Tells it again and again that this process is alive, and how: as long as it is, this is polled. Does not end.
    pub async fn pulses(&self, status: impl Fn() -> String) {
        /// How often the status is told where nobody waits for it.
        const STATUS: Duration = Duration::from_secs(30);

        let every = self.supervisor.pulse().unwrap_or(STATUS);
        let mut told = true;
        loop {
            sleep(every).await;
            let now = self.supervisor.alive(&status());
            if let (Err(error), true) = (&now, told) {
                self.say(Level::Error, &format!("the service manager is not reached: {error}"), &[]);
            }
            told = now.is_ok();
        }
    }

    /// Tells it that this comes to its end.
    pub fn stopping(&self) {
        // Nobody is left to be told that this cannot be told.
        let _told = self.supervisor.stopping();
    }
}

fn unreached(error: &io::Error) -> Failure {
    Failure::io("NOTIFY_SOCKET", error)
}

/// Says once when something begins or ends, however often it is seen.
#[derive(Debug)]
struct Journal {
    screen: Screen,
    /// Whether each robot answers; nothing where that is not known yet.
    answers: BTreeMap<RobotId, Option<bool>>,
    /// What could not be read, of the inventory and of the texts of alarms.
    unread: [Option<String>; 2],
    /// Whether robots come and go, and not only begin.
    has_begun: bool,
}

impl Journal {
    fn new(screen: Screen) -> Self {
        Self { screen, answers: BTreeMap::new(), unread: [None, None], has_begun: false }
    }

    fn note(&mut self, event: &Event) {
        match event {
            Event::Appeared(robot) => {
                self.answers.insert(RobotId::of(robot), None);
                if self.has_begun {
                    self.say(Level::Notice, robot, "is looked at from now on", &[]);
                }
            }
            Event::Gone(robot) => {
                self.answers.remove(&RobotId::of(robot));
                self.say(Level::Notice, robot, "is looked at no more", &[]);
            }
            Event::Looked(look) => {
                if self.answers.insert(RobotId::of(&look.robot), Some(true)) == Some(Some(false)) {
                    self.say(Level::Notice, &look.robot, "answers again", &[]);
                }
                self.unread(1, look.unexplained.as_ref());
            }
            Event::Failed { robot, failure, .. } => {
                if self.answers.insert(RobotId::of(robot), Some(false)) != Some(Some(false)) {
                    self.failed(robot, failure);
                }
            }
            Event::Inventory(read) => {
                self.has_begun = true;
                if read.is_ok() {
                    self.screen.log(Level::Notice, "the inventory has changed, and was read", &[]);
                }
                self.unread(0, read.as_ref().err());
            }
        }
    }

    fn status(&self) -> String {
        let answer = self.answers.values().filter(|answers| **answers == Some(true)).count();
        let robots = self.answers.len();
        let (plural, verb) = (if robots == 1 { "" } else { "s" }, if answer == 1 { "answers" } else { "answer" });
        format!("{robots} robot{plural}, {answer} {verb}")
    }

    fn say(&self, level: Level, robot: &Robot, what: &str, fields: &[(&str, &str)]) {
        let own = [("robot", robot.name.as_str()), ("family", robot.family.name())];
        self.screen.log(level, &format!("{}: {what}", robot.label()), &[&own, fields].concat());
    }

    fn failed(&self, robot: &Robot, failure: &Failure) {
        let kind = kind(failure);
        let mut fields = vec![("robot", robot.name.as_str()), ("family", robot.family.name()), ("kind", &kind)];
        fields.extend(failure.code.as_deref().map(|code| ("code", code)));
        let label = robot.label();
        let message = &failure.message;
        let text = if message.contains(&label) { message.clone() } else { format!("{label}: {message}") };
        self.screen.log(Level::Warning, &text, &fields);
    }

    /// Says why something cannot be read, once for each reason.
    fn unread(&mut self, which: usize, why: Option<&Failure>) {
        let Some(failure) = why else {
            // A look at a robot without a fault needs no texts, and says nothing of them.
            if which == 0 {
                self.unread[which] = None;
            }
            return;
        };
        if self.unread[which].as_ref() != Some(&failure.message) {
            let effect = if which == 0 { "the robots stay as they were" } else { "its texts are left out" };
            self.screen.log(Level::Warning, &format!("{}; {effect}", failure.message), &[("kind", &kind(failure))]);
            self.unread[which] = Some(failure.message.clone());
        }
    }
}

/// The class of a failure, as the envelope has it: `no_answer`.
pub fn kind(failure: &Failure) -> String {
    let name = serde_json::to_value(failure.kind).ok();
    name.as_ref().and_then(serde_json::Value::as_str).unwrap_or("other").to_owned()
}

/// Lets this process have as many files and sockets open as it may: there is one for each robot, and what a process
/// begins with is meant for less.
pub fn make_room() {
    #[cfg(unix)]
    {
        use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};

        let Rlimit { maximum, .. } = getrlimit(Resource::Nofile);
        // Where that cannot be, a robot that finds no room says so.
        let _refused = setrlimit(Resource::Nofile, Rlimit { current: maximum, maximum });
    }
}

//! Values that only a controller knows.
//!
//! They are what commands report that read them, asked through a session that is open, or of a simulator. No key at a
//! prompt opens a link to a controller, sends anything but a read, or waits for long: whatever is not there in time is no
//! candidate.

use std::sync::Arc;
use std::sync::mpsc::{self, Sender};
use std::time::{Duration, Instant};

use serde_json::Value;
use tokio::time::timeout;

use super::Candidate;
use crate::app::parser::Parser;
use crate::app::prepared::{Invocation, Task};
use crate::command::frame::authority::Authority;
use crate::command::{Access, AnyContext};
use crate::output::{ColorChoice, Format, Screen, escape};
use crate::settings::target::Family;
use crate::settings::{Robot, Sessions, Setting, Sources};

/// The longest that somebody waits.
pub(super) const PATIENCE: Duration = Duration::from_millis(300);

/// What can be asked for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Wish {
    /// Jobs of a yerc controller.
    Jobs,
    /// All its files.
    Files,
    /// Tasks of a YRCX with a program in them.
    Tasks,
    /// Numbers of the programs in them.
    Programs,
    /// Names of the programs in them.
    ProgramNames,
}

impl Wish {
    const fn family(self) -> Family {
        match self {
            Self::Jobs | Self::Files => Family::Yerc,
            Self::Tasks | Self::Programs | Self::ProgramNames => Family::Yrcx,
        }
    }
}

/// What the robot of the line answers in time.
pub(super) fn values(wish: Wish, sources: &Sources, patience: Duration) -> Vec<Candidate> {
    let Some(robot) = robot(wish.family(), sources, patience) else { return Vec::new() };
    let until = Instant::now() + patience;
    let (found, arrived) = mpsc::channel();
    // A thread of its own: the line editor may ask from within anything, and nothing is waited for longer than this.
    let asking = move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        if let Ok(runtime) = runtime {
            // What has been found until then counts.
            let _ = runtime.block_on(async { timeout(patience, Asker::new(robot, found).ask(wish)).await });
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
    // What would do something to the terminal can be typed by nobody.
    values.retain(|value| escape::line(&value.value) == value.value);
    values
}

/// The robot that the line is for, if it is one, reached by no other way than a session.
fn robot(family: Family, sources: &Sources, patience: Duration) -> Option<Robot> {
    let [robot] = <[Robot; 1]>::try_from(sources.robots(Some(family)).ok()?).ok()?;
    let sessions = match (robot.target.value.is_simulated(), robot.sessions) {
        (true, sessions) => sessions,
        (false, Sessions::None) => return None,
        (false, _) => Sessions::Only,
    };
    let patience = Setting { value: patience, ..robot.timeout };
    let retries = Setting { value: 0, ..robot.retries };
    Some(Robot { sessions, timeout: patience, retries, ..robot })
}

/// Asks one robot.
struct Asker {
    robot: Robot,
    found: Sender<Candidate>,
    began: Instant,
}

impl Asker {
    fn new(robot: Robot, found: Sender<Candidate>) -> Self {
        Self { robot, found, began: Instant::now() }
    }

    async fn ask(&self, wish: Wish) {
        match wish {
            Wish::Jobs => {
                for (name, _) in self.files("jbi").await {
                    let name = name.strip_suffix(".JBI").unwrap_or(&name);
                    self.tell(name, String::new());
                }
            }
            Wish::Files => {
                for kind in ["jbi", "dat", "cnd", "prm", "sys", "lst"] {
                    for (name, kind) in self.files(kind).await {
                        self.tell(&name, kind);
                    }
                }
            }
            Wish::Tasks => {
                for (task, state) in self.tasks().await {
                    self.tell(&task, state);
                }
            }
            Wish::Programs | Wish::ProgramNames => {
                for (task, state) in self.tasks().await {
                    let shown = self.data(&["yrcx", "program", "show", "--task", &task]).await;
                    let Some(shown) = shown else { continue };
                    let (number, name) = (text(&shown, "program"), text(&shown, "name"));
                    let about = format!("task {task}, {state}");
                    match wish {
                        Wish::Programs => self.tell(&number, format!("{name}: {about}")),
                        _ => self.tell(&name, format!("program {number}: {about}")),
                    }
                }
            }
        }
    }

    fn tell(&self, value: &str, help: String) {
        // Nobody may listen any more.
        let _ = self.found.send(Candidate::new(value, help));
    }

    /// Names and types.
    async fn files(&self, kind: &str) -> Vec<(String, String)> {
        let data = self.data(&["yerc", "file", "list", "--type", kind]).await;
        rows(data.as_ref(), "files").map(|file| (text(file, "name"), text(file, "type"))).collect()
    }

    /// Numbers and states of the tasks with a program.
    async fn tasks(&self) -> Vec<(String, String)> {
        let data = self.data(&["yrcx", "info", "tasks", "1..8"]).await;
        let tasks = rows(data.as_ref(), "tasks").map(|task| (text(task, "task"), text(task, "state")));
        tasks.filter(|(_, state)| state != "no task").collect()
    }

    /// What a command that reads reports.
    async fn data(&self, words: &[&str]) -> Option<Value> {
        // No question is begun that may have to be broken off.
        if self.began.elapsed() > self.robot.timeout.value / 2 {
            return None;
        }
        let args: Vec<_> = ["armctl"].iter().chain(words).map(Into::into).collect();
        let Invocation::Task(Task::Family(_, command)) = Parser::default().parse(&args).ok()?.command.into() else {
            return None;
        };
        let typed = Some(Arc::from("completion of a command line"));
        let access = Access { typed, ..Access::reading(command.connect_mode()) };
        let screen = Screen::new(Format::Json, ColorChoice::Never, true, 0).silenced();
        let robot = &self.robot;
        let mut connection = command.connect(robot, access, &screen).await.ok()?;
        let authority = Authority::reading(&screen, robot);
        let context = AnyContext { robot, connection: &mut *connection, screen: &screen, several: false, authority };
        let report = command.run(context).await;
        connection.close(&screen).await.ok()?;
        report.ok()?.data().ok()
    }
}

fn rows<'a>(data: Option<&'a Value>, list: &str) -> impl Iterator<Item = &'a Value> {
    data.and_then(|data| data.get(list)?.as_array()).into_iter().flatten()
}

fn text(row: &Value, field: &str) -> String {
    match row.get(field) {
        Some(Value::String(text)) => text.clone(),
        Some(Value::Null) | None => String::new(),
        Some(other) => other.to_string(),
    }
}

//! `armctl record`: keeps what robots answer, for a replay by simulators. It only reads.

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::future::pending;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use clap::ValueHint;
use serde_json::{Map, Value};
use tokio::time::{Instant, sleep, timeout};

use super::axes::Axes;
use super::byte_size::size;
use super::poll::{Event, Extra, Poll, PollCounter, PollRequest, PollResult, RobotId};
use armctl_controller::simulator::recording::Answers;
use armctl_files as files;
use armctl_frame::SchemaEntry;
use armctl_frame::backup::recording::{FILE, Head};
use armctl_frame::face::overview::OverviewReport;
use armctl_frame::face::sample::{Detail, Whole};
use armctl_frame::interrupt::{catch_interrupts, interruptible};
use armctl_frame::local_names::{make_folder, private_folder};
use armctl_frame::output::envelope::ErrorBody;
use armctl_frame::output::escape;
use armctl_frame::prelude::*;
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::settings::duration;
use armctl_frame::settings::inventory::is_name;

/// Record what robots answer, for a replay by simulators.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl polls the robots like `armctl top`, and only reads. FOLDER/ROBOT/recording.jsonl gets one line \
                  of JSON for each poll: the state, the alarms, the axes, the signals, and the answers of the \
                  controller, or the reason why it did not answer. `armctl sim --cell FOLDER --replay` gives these \
                  answers again. FOLDER can be the folder of `armctl backup`: the simulators then also have the data \
                  of the backup.\n\n--watch INTERVAL sets how often armctl polls the robots (1s). A poll without \
                  changes needs about 1 KiB. record runs until Ctrl-C (exit code 0), --for, --count or --max-size."
)]
pub struct Record {
    /// Folder for the recordings; each robot has a folder with its name
    #[arg(value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    folder: PathBuf,
    /// End after this time
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
    /// End when the recordings have this size together
    #[arg(long, value_name = "SIZE", default_value = "1G", value_parser = size)]
    max_size: u64,
    /// A read command whose answer is also recorded, such as 'yerc var get B0..B9' (repeatable)
    #[arg(long, value_name = "LINE")]
    also: Vec<String>,
}

/// Name in envelopes and schemas.
const ID: &str = "record";
/// Default and minimum polling interval.
const DEFAULT_INTERVAL: Duration = Duration::from_secs(1);
const MIN_INTERVAL: Duration = Duration::from_millis(50);
/// Longest pause between two polls of a robot that does not answer.
const LONGEST_PAUSE: Duration = Duration::from_secs(10);
/// Time limit for closing the links.
const END_TIMEOUT: Duration = Duration::from_millis(800);

/// Schema of the report.
pub fn schema() -> SchemaEntry {
    SchemaEntry::of::<RecordReport>(ID)
}

/// Report of `record` at its end.
#[derive(Debug, Serialize, JsonSchema)]
struct RecordReport {
    /// Why the recording ended.
    ended: End,
    /// Duration of the recording.
    elapsed_ms: u64,
    /// Robots.
    robots: Vec<RecordedRobot>,
}

/// Why a recording ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum End {
    /// Ctrl-C or SIGTERM.
    Interrupted,
    /// `--for`.
    Time,
    /// `--count`.
    Count,
    /// `--max-size`.
    Size,
}

/// Recording of a robot.
#[derive(Debug, Serialize, JsonSchema)]
struct RecordedRobot {
    robot: String,
    family: &'static str,
    /// File with the recording.
    path: String,
    /// Number of recorded polls.
    polls: u64,
    /// Number of polls without an answer. They are among the recorded polls.
    failed: u64,
    /// Size of the file.
    bytes: u64,
}

impl Report for RecordReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["robot", "family", "polls", "without answer", "bytes", "file"], "no robots");
        for robot in &self.robots {
            let failed = Cell::from(robot.failed).tone(if robot.failed == 0 { Tone::Plain } else { Tone::Warning });
            table.row([
                robot.robot.as_str().into(),
                robot.family.into(),
                robot.polls.into(),
                failed,
                robot.bytes.into(),
                Cell::from(robot.path.as_str()).whole(),
            ]);
        }
        View::table(table)
    }
}

impl Record {
    /// Runs the command.
    pub async fn run(&self, run: &Run) -> Result<(), RunError> {
        let every = run.repeat.every.unwrap_or(DEFAULT_INTERVAL);
        check_globals(run, every)?;
        let poll = Poll::new(&run.sources, run.screen.silenced())?;
        catch_interrupts();
        let report = self.record(poll, (every, run.repeat.count), &run.screen).await?;
        run.local(ID, &report)
    }

    /// Records the robots of a poller at an interval, up to a number of polls of each robot.
    async fn record(
        &self,
        mut poll: Poll,
        (every, count): (Duration, Option<u64>),
        screen: &Screen,
    ) -> Result<RecordReport, Failure> {
        let extras = self.also.iter().map(|line| Extra::parse(line).map(Rc::new)).collect::<Result<Rc<[_]>, _>>();
        let extras =
            extras.map_err(|failure| Failure { message: format!("--also: {}", failure.message), ..failure })?;
        let mut recorder = Recorder { folder: &self.folder, every, start: Instant::now(), files: BTreeMap::new() };
        // All files are checked before the first one is created.
        for robot in poll.robots() {
            recorder.path(robot)?;
        }
        for robot in poll.robots() {
            recorder.add(robot)?;
        }
        let (robots, folder) = (poll.robots().len(), self.folder.display());
        let plural = if robots == 1 { "" } else { "s" };
        screen.note(&format!("recording {robots} robot{plural} in {folder}; end it with Ctrl-C"));
        let ids: Vec<RobotId> = poll.robots().iter().map(RobotId::for_robot).collect();
        let mut counter = PollCounter::new(&ids, count);
        let request = PollRequest { detail: Detail::Full, extras, answers: true, ..PollRequest::every(every) };
        let mut events = poll.subscribe(PollRequest { longest_pause: LONGEST_PAUSE.max(every), ..request });
        let mut polled = Box::pin(poll.run());
        let ended = {
            let record = async {
                while let Some(event) = counter.next(&mut events).await {
                    recorder.note(&event, screen)?;
                    if recorder.bytes() >= self.max_size {
                        return Ok(End::Size);
                    }
                }
                Ok(End::Count)
            };
            let time = async {
                match self.within {
                    Some(time) => sleep(time).await,
                    None => pending().await,
                }
            };
            let until_end = interruptible(async {
                tokio::select! {
                    ended = record => ended,
                    () = time => Ok(End::Time),
                    () = &mut polled => Err(Failure::local("internal error: polling has ended")),
                }
            });
            // Ctrl-C or SIGTERM is the normal end of a recording.
            until_end.await.unwrap_or(Ok(End::Interrupted))?
        };
        drop(events);
        let _in_time = timeout(END_TIMEOUT, polled).await;
        Ok(recorder.report(ended))
    }
}

/// Rejects options that do not apply to this command.
fn check_globals(run: &Run, every: Duration) -> Result<(), Failure> {
    let wrong = |what: &str, hint: &str| Err(Failure::usage(format!("record {what}")).hint(hint));
    if run.repeat.until.is_some() {
        return wrong("ends with --for, --count or Ctrl-C", "use --for TIME, for example --for 10m");
    }
    if run.trace.is_some() {
        return wrong("does not record its traffic", "use --trace with `armctl status --watch`");
    }
    if every < MIN_INTERVAL {
        return wrong("polls at most every 50ms", "use --watch 50ms or more");
    }
    Ok(())
}

/// Writes the recordings.
struct Recorder<'a> {
    folder: &'a Path,
    every: Duration,
    start: Instant,
    files: BTreeMap<RobotId, RobotFile>,
}

impl Recorder<'_> {
    /// Path of the recording of a robot, which must not exist. A recording is never overwritten.
    fn path(&self, robot: &Robot) -> Result<PathBuf, Failure> {
        if !is_name(&robot.name) {
            let message = format!("'{}' is not a valid name for the folder of a recording", robot.name);
            return Err(
                Failure::usage(message).hint("add the robot with `armctl robots add NAME URL`, and use -r NAME")
            );
        }
        let path = private_folder(self.folder, &robot.name, true).join(FILE);
        if path.exists() {
            return Err(Failure::local(format!("{} already exists and was not changed", path.display()))
                .hint("record in another folder, or move this file"));
        }
        Ok(path)
    }

    /// Creates the file of a robot, unless this command has created it before.
    fn add(&mut self, robot: &Robot) -> Result<(), Failure> {
        let id = RobotId::for_robot(robot);
        if self.files.contains_key(&id) {
            return Ok(());
        }
        let path = self.path(robot)?;
        make_folder(&files::folder_of(&path))?;
        self.files.insert(id, RobotFile::create(path, &Head::new(robot, self.every))?);
        Ok(())
    }

    /// Writes a poll.
    fn note(&mut self, event: &Event, screen: &Screen) -> Result<(), Failure> {
        let (robot, line) = match event {
            Event::Appeared(robot) => {
                return self.add(robot).or_else(|failure| {
                    screen.failure(&failure);
                    Ok(())
                });
            }
            Event::Polled(look) => (&look.robot, Line::polled(look)),
            Event::Failed { robot, failure, .. } => (robot, Line::failed(failure)),
            Event::Gone(_) | Event::Inventory(_) => return Ok(()),
        };
        let Some(file) = self.files.get_mut(&RobotId::for_robot(robot)) else { return Ok(()) };
        match event {
            Event::Failed { failure, .. } if !file.is_silent => screen.note(&failure.message),
            Event::Polled(_) if file.is_silent => screen.note(&format!("{}: answers again", robot.label())),
            _ => {}
        }
        file.is_silent = line.error.is_some();
        let took = if let Event::Polled(look) = event { look.took } else { Duration::ZERO };
        file.write(self.start.elapsed().saturating_sub(took), line)
    }

    fn bytes(&self) -> u64 {
        self.files.values().map(|file| file.bytes).sum()
    }

    fn report(&self, ended: End) -> RecordReport {
        let robot = |(id, file): (&RobotId, &RobotFile)| RecordedRobot {
            robot: id.name.clone(),
            family: id.family.name(),
            path: file.path.display().to_string(),
            polls: file.polls,
            failed: file.failed,
            bytes: file.bytes,
        };
        RecordReport { ended, elapsed_ms: ms(self.start.elapsed()), robots: self.files.iter().map(robot).collect() }
    }
}

/// The recording of one robot.
struct RobotFile {
    path: PathBuf,
    file: File,
    /// Answers of the last poll. A line has only the answers that differ from them.
    last: Answers,
    is_silent: bool,
    polls: u64,
    failed: u64,
    bytes: u64,
}

impl RobotFile {
    fn create(path: PathBuf, head: &Head) -> Result<Self, Failure> {
        let file = OpenOptions::new().write(true).create_new(true).open(&path);
        let file = file.map_err(|error| Failure::io(path.display(), &error))?;
        let mut file = Self { path, file, last: Answers::new(), is_silent: false, polls: 0, failed: 0, bytes: 0 };
        file.append(head)?;
        Ok(file)
    }

    fn write(&mut self, at: Duration, line: Line) -> Result<(), Failure> {
        self.polls += 1;
        self.failed += u64::from(line.error.is_some());
        let answers = line.answers.unwrap_or_default();
        let is_new = |(request, answer): &(&String, &String)| self.last.get(*request) != Some(answer);
        let changed =
            answers.iter().filter(is_new).map(|(request, answer)| (request.clone(), answer.clone())).collect();
        // After a failure, the next line has all answers.
        self.last = answers;
        let changed = line.error.is_none().then_some(changed);
        self.append(&Line { at_ms: ms(at), answers: changed, ..line })
    }

    /// Appends a line at once. If the process is killed, only this line can be incomplete.
    fn append(&mut self, line: &impl Serialize) -> Result<(), Failure> {
        let mut text = escape::json_line(line).map_err(|error| Failure::local(format!("{FILE}: {error}")))?;
        text.push('\n');
        self.file.write_all(text.as_bytes()).map_err(|error| Failure::io(self.path.display(), &error))?;
        self.bytes += u64::try_from(text.len()).unwrap_or_default();
        Ok(())
    }
}

/// A poll. Only time and answers are replayed. The other keys are for people and programs.
#[derive(Debug, Default, Serialize)]
struct Line {
    /// Start of the poll after the start of the recording; without an answer, its end.
    at_ms: u64,
    status: Option<OverviewReport>,
    alarms: Vec<Alarm>,
    #[serde(flatten)]
    axes: Option<Axes>,
    /// Signals by kind and group, in the order of the manual: `{"inputs": {"#10": "10000000"}}`.
    signals: BTreeMap<&'static str, BTreeMap<String, String>>,
    /// Data of `--also`, by command line.
    also: Map<String, Value>,
    /// Why the robot did not answer; null if it answered.
    error: Option<ErrorBody>,
    /// Answers that differ from the poll before; null if the robot did not answer.
    answers: Option<Answers>,
}

impl Line {
    fn polled(look: &PollResult) -> Self {
        let sample = &look.sample;
        let also = |(text, result): &(Arc<str>, Result<Value, Failure>)| {
            let failed = |failure: &Failure| serde_json::json!({"error": ErrorBody::from(failure.clone())});
            (text.to_string(), result.as_ref().map_or_else(failed, Value::clone))
        };
        Self {
            status: Some(OverviewReport { family: look.robot.family.name(), ..sample.line.clone() }),
            alarms: sample.alarms.clone(),
            axes: Some(Axes::of(sample)),
            signals: sample.full.as_ref().map(signals).unwrap_or_default(),
            also: look.extras.iter().map(also).collect(),
            answers: Some(look.answers.clone()),
            ..Self::default()
        }
    }

    fn failed(failure: &Failure) -> Self {
        Self { error: Some(failure.clone().into()), ..Self::default() }
    }
}

fn signals(whole: &Whole) -> BTreeMap<&'static str, BTreeMap<String, String>> {
    let digits = |signals: &[bool; 8]| signals.map(|is_on| if is_on { '1' } else { '0' }).iter().collect();
    let groups = whole.banks.iter().map(|bank| {
        (bank.name, bank.groups.iter().map(|group| (group.label.clone(), digits(&group.signals))).collect())
    });
    groups.collect()
}

fn ms(time: Duration) -> u64 {
    u64::try_from(time.as_millis()).unwrap_or(u64::MAX)
}

//! Test bench: the blocks of a command line, and their effect on a simulator in virtual time.

use std::collections::{HashMap, VecDeque};
use std::sync::{RwLock, RwLockReadGuard, RwLockWriteGuard};

use serde_json::Value;

use super::connect;
use super::simulated::Simulated;
use crate::face::FACE;
use crate::prelude::*;
use armctl_client::toyo::{Client, FENCE};
use armctl_controller::toyo::simulator::Start;
use armctl_frame::gate::{Gate, Grant, Intent};
use armctl_frame::output::{ColorChoice, Format};
use armctl_frame::testing::{self, QUIET, context, frames, planned, unlimited_access};
use armctl_frame::{AnyCommand, Family as _};
use armctl_transport::line::{InProcessLine, Pace};
use armctl_transport::sim::Peer;
use armctl_transport::stream::Stream;

/// Error message of the command line parser.
pub(super) fn objection(words: &[&str]) -> String {
    testing::parse(&FACE, "sim:", words).err().expect("the parser objects").to_string()
}

/// Input of the gate for a command line: intent and command name.
pub(super) fn gate_input(words: &[&str]) -> (Intent, &'static str) {
    let (robot, command) = resolved("tcp://127.0.0.1:1", words).expect("a command line");
    let intent = command.intent(Some(&robot));
    (intent, command.id())
}

/// Text of the confirmation without "This will".
pub(super) fn intent(words: &[&str]) -> String {
    resolved("sim:", words).unwrap().1.intent(None).text
}

/// Blocks of `armctl toyo WORDS…` without the requests that precede and follow every command.
pub(super) fn blocks(words: &[&str]) -> Result<Vec<String>> {
    let mut frames = frames(&plan(words)?);
    frames.retain(|frame| frame["about"] != FENCE && !asks_letters(frame));
    let blocks = frames.iter().map(text);
    Ok(blocks.filter(|block| !matches!(&block[..], "@STAS SNO=2" | "@HSON" | "@HSOF")).collect())
}

/// Whether a frame reads the letters of the axes.
fn asks_letters(frame: &Value) -> bool {
    let is_system = frame["about"].as_str().is_some_and(|about| about.starts_with("the letters of the axes"));
    is_system || (text(frame) == "@RPAR E01" && !frame["depends_on"].is_null())
}

/// All blocks of `armctl toyo WORDS…`.
pub(super) fn all_blocks(words: &[&str]) -> Result<Vec<String>> {
    Ok(frames(&plan(words)?).iter().map(text).collect())
}

/// Report of a dry run.
pub(super) fn plan(words: &[&str]) -> Result<Value> {
    let (robot, command) = resolved("tcp://127.0.0.1:1", words)?;
    planned::<Toyo>(&robot, &*command, |_| ())
}

/// Block of a frame.
pub(super) fn text(frame: &Value) -> String {
    frame["text"].as_str().expect("blocks are text").to_owned()
}

/// A simulated controller with a link for several command lines, in virtual time.
pub(super) struct Bench {
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
}

/// What happens on the line to a block or its answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// No fault.
    None,
    /// The block is lost.
    Lost,
    /// The answer is lost.
    Unanswered,
    /// The answer arrives late, by this time.
    Late(Duration),
    /// The test sends this answer, and the controller does not receive the block.
    Answered(&'static str),
}

/// Blocks that were sent, in their order. Lost blocks are included.
#[derive(Debug, Clone, Default)]
pub(super) struct ReceivedBlocks(Arc<RwLock<Vec<String>>>);

impl ReceivedBlocks {
    pub(super) fn borrow(&self) -> RwLockReadGuard<'_, Vec<String>> {
        self.0.read().expect("no test has panicked with it")
    }

    pub(super) fn borrow_mut(&self) -> RwLockWriteGuard<'_, Vec<String>> {
        self.0.write().expect("no test has panicked with it")
    }
}

/// A simulated controller behind a line with faults.
struct FaultyLine<F> {
    controller: Simulated,
    incoming: Vec<u8>,
    answers: VecDeque<(Duration, Vec<u8>)>,
    received: ReceivedBlocks,
    counts: HashMap<String, usize>,
    /// Decides what happens to a block, from its text and the number of times it was sent, from 1.
    fault: F,
}

impl<F> fmt::Debug for FaultyLine<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FaultyLine").finish_non_exhaustive()
    }
}

impl<F: FnMut(&str, usize) -> Fault + Send> Peer for FaultyLine<F> {
    fn receive(&mut self, now: Duration, channel: usize, bytes: &[u8]) {
        for byte in bytes {
            self.incoming.push(*byte);
            if *byte != b'\n' {
                continue;
            }
            let incoming = std::mem::take(&mut self.incoming);
            let block = String::from_utf8_lossy(&incoming).trim_end().to_owned();
            self.received.borrow_mut().push(block.clone());
            let count = self.counts.entry(block.clone()).or_default();
            *count += 1;
            let fault = (self.fault)(&block, *count);
            match fault {
                Fault::Lost => continue,
                Fault::Answered(answer) => self.answers.push_back((now, format!("{answer}\r\n").into_bytes())),
                _ => self.controller.receive(now, channel, &incoming),
            }
            while let Some((_, answer)) = self.controller.transmit(now) {
                match fault {
                    Fault::Unanswered => {}
                    Fault::Late(by) => self.answers.push_back((now + by, answer)),
                    _ => self.answers.push_back((now, answer)),
                }
            }
        }
    }

    fn transmit(&mut self, now: Duration) -> Option<(usize, Vec<u8>)> {
        let due = self.answers.iter().position(|(at, _)| *at <= now)?;
        self.answers.remove(due).map(|(_, answer)| (0, answer))
    }

    fn wake(&self) -> Option<Duration> {
        self.answers.iter().map(|(at, _)| *at).min()
    }
}

impl Bench {
    /// A simulator in a start state (TOML) behind a line with faults, and the blocks that are sent to it.
    pub(super) fn with_faults(
        state: &str,
        fault: impl FnMut(&str, usize) -> Fault + Send + 'static,
    ) -> (Self, ReceivedBlocks) {
        Self::over(Simulated::new(Start::parse(state).expect("a start state")), fault)
    }

    /// A simulator in a start state (TOML) that has received these blocks.
    pub(super) fn after(state: &str, blocks: &[String]) -> (Self, ReceivedBlocks) {
        let mut controller = Simulated::new(Start::parse(state).expect("a start state"));
        for block in blocks {
            controller.receive(Duration::ZERO, 0, format!("{block}\r\n").as_bytes());
            while controller.transmit(Duration::ZERO).is_some() {}
        }
        Self::over(controller, |_, _| Fault::None)
    }

    fn over(controller: Simulated, fault: impl FnMut(&str, usize) -> Fault + Send + 'static) -> (Self, ReceivedBlocks) {
        let received = ReceivedBlocks::default();
        let (incoming, answers) = (Vec::new(), VecDeque::new());
        let peer = Box::new(FaultyLine {
            controller,
            incoming,
            answers,
            received: received.clone(),
            counts: HashMap::new(),
            fault,
        });
        let (robot, _) = resolved("sim:", &["status"]).expect("a robot");
        let runtime = runtime();
        let link = runtime
            .block_on(async {
                let (pace, access) = (Pace::new(9600, 11), unlimited_access());
                let line =
                    Stream::InProcess(Box::new(InProcessLine::new(peer as Box<dyn Peer + Send>, Some(pace), None)));
                let client = Client::over(line, pace.time(1), connect::options(&robot, &access));
                Link::of(client, &robot, &access, &quiet())
            })
            .expect("a link");
        (Self { runtime, robot, link }, received)
    }

    /// Runs `armctl toyo WORDS…`, and interrupts it with Ctrl-C after a time. Returns the message of the stop.
    pub(super) fn run_and_interrupt(&mut self, words: &[&str], after: Duration) -> Result<String> {
        self.run_and_abandon(words, after);
        self.runtime.block_on(Toyo::halt(&mut self.link))
    }

    /// Runs `armctl toyo WORDS…` for a time, and then abandons it. Returns whether a stop is required.
    pub(super) fn run_and_abandon(&mut self, words: &[&str], after: Duration) -> bool {
        let (_, command) = resolved("sim:", words).expect("a command");
        let Self { runtime, robot, link } = self;
        runtime.block_on(async {
            let context = context(robot, link);
            if let Ok(done) = tokio::time::timeout(after, testing::run::<Toyo>(&*command, context)).await {
                panic!("{words:?} has ended before: {:?}", done.map(|report| report.data()));
            }
        });
        Toyo::needs_halt(&self.link)
    }

    /// Lets time pass.
    pub(super) fn wait(&self, time: Duration) {
        self.runtime.block_on(async { tokio::time::sleep(time).await });
    }

    /// Restores the changes of the link, as when the link is closed. The link can still be used.
    pub(super) fn end(&mut self) {
        let Self { runtime, link, .. } = self;
        runtime.block_on(async {
            link.put_back().await.unwrap_or_default();
            link.give_back().await.unwrap_or_default();
        });
    }

    /// Closes the link.
    pub(super) fn close(self) -> Result<()> {
        self.runtime.block_on(Toyo::close(self.link, &quiet()))
    }

    /// Creates a bench with a simulator for this URL.
    pub(super) fn new(target: &str) -> Self {
        let runtime = runtime();
        let (robot, _) = resolved(target, &["status"]).expect("a robot");
        let link = runtime.block_on(Toyo::connect(&robot, unlimited_access(), &quiet())).expect("a link");
        Self { runtime, robot, link }
    }

    /// Runs `armctl toyo WORDS…`. Returns the data of the report, and the failure that the report states.
    pub(super) fn run(&mut self, words: &[&str]) -> Result<(Value, Option<Failure>)> {
        let (_, command) = resolved("sim:", words)?;
        let Self { runtime, robot, link } = self;
        let report = runtime.block_on(testing::run::<Toyo>(&*command, context(robot, link)))?;
        Ok((report.data()?, report.failure()))
    }

    /// Runs `armctl toyo WORDS…` on a robot that counts as real. There is no terminal, so no question can be answered.
    pub(super) fn run_without_confirmation(&mut self, words: &[&str]) -> Result<Value> {
        let (robot, command) = resolved("tcp://127.0.0.1:1", words)?;
        let intent = command.intent(Some(&robot));
        Gate::default().must_ask(&QUIET, &robot, &intent)?;
        let grant = Grant::up_to(intent.initial_risk());
        self.link.grant(grant.clone());
        let confirmer = Confirmer::new(Gate::default(), &QUIET, &robot, intent.risk, grant);
        let context = Context { robot: &robot, link: &mut self.link, screen: &QUIET, several: false, confirmer };
        let outcome = self.runtime.block_on(testing::run::<Toyo>(&*command, context)).and_then(|report| report.data());
        self.link.grant(Grant::up_to(Risk::Motion));
        outcome
    }

    /// Runs a command line that must succeed, and returns its data.
    #[track_caller]
    pub(super) fn data(&mut self, words: &[&str]) -> Value {
        match self.run(words) {
            Ok((data, None)) => data,
            other => panic!("{words:?}: {other:?}"),
        }
    }
}

/// Runs a command line that needs no robot.
pub(super) fn without_robot(words: &[&str]) -> Result<(Value, Option<Failure>)> {
    let (_, command) = resolved("sim:", words)?;
    let report = command.without_robot(&quiet()).expect("the command needs no robot")?;
    Ok((report.data()?, report.failure()))
}

fn runtime() -> tokio::runtime::Runtime {
    tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().expect("a runtime")
}

/// Robot and command of a command line.
fn resolved(target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand>)> {
    testing::resolve(&FACE, target, words)
}

/// A screen without output.
fn quiet() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}

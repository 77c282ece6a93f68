//! For tests: what a command line would send, and what becomes of it on a simulator in virtual time.

use std::collections::{HashMap, VecDeque};
use std::fmt;
use std::sync::{Arc, RwLock, RwLockReadGuard, RwLockWriteGuard};
use std::time::Duration;

use clap::Parser as _;
use serde_json::Value;

use super::connect;
use super::link::Link;
use super::link::Toyo;
use super::simulated::Simulated;
use crate::cli::{Cli, FamilyWord, Top};
use crate::client::toyo::{Client, FENCE};
use crate::command::face::words::{Typed, Wish};
use crate::command::frame::authority::Authority;
use crate::command::frame::testing::{self, QUIET, context, everything, frames, planned};
use crate::command::{AnyCommand, Context, Family as _};
use crate::controller::Risk;
use crate::controller::toyo::simulator::Start;
use crate::failure::Failure;
use crate::gate::{Gate, Grant, Intent};
use crate::output::{ColorChoice, Format, Screen};
use crate::settings::target::Family as Name;
use crate::settings::{Robot, Selection, Sources};
use crate::transport::line::{InProcessLine, Pace};
use crate::transport::sim::Peer;
use crate::transport::stream::Stream;

/// What the parser of the command line objects to.
pub(super) fn objection(words: &[&str]) -> String {
    parsed("sim:", words).expect_err("the parser objects").to_string()
}

/// What the gate is told of a command line.
pub(super) fn gated(words: &[&str]) -> (Robot, Intent, &'static str) {
    let (robot, command) = resolved("tcp://127.0.0.1:1", words).expect("a command line");
    let intent = command.intent(Some(&robot));
    (robot, intent, command.id())
}

/// The question before the command, without "This will".
pub(super) fn intent(words: &[&str]) -> String {
    resolved("sim:", words).unwrap().1.intent(None).text
}

/// The blocks that `armctl toyo WORDS…` would send, those apart that go before and behind any order.
pub(super) fn blocks(words: &[&str]) -> Result<Vec<String>, Failure> {
    let mut frames = frames(&plan(words)?);
    frames.retain(|frame| frame["about"] != FENCE && !asks_letters(frame));
    let blocks = frames.iter().map(text);
    Ok(blocks.filter(|block| !matches!(&block[..], "@STAS SNO=2" | "@HSON" | "@HSOF")).collect())
}

/// Whether a frame asks for the letters of the axes.
fn asks_letters(frame: &Value) -> bool {
    let is_system = frame["about"].as_str().is_some_and(|about| about.starts_with("the letters of the axes"));
    is_system || (text(frame) == "@RPAR E01" && !frame["depends_on"].is_null())
}

/// All blocks that `armctl toyo WORDS…` would send.
pub(super) fn all_blocks(words: &[&str]) -> Result<Vec<String>, Failure> {
    Ok(frames(&plan(words)?).iter().map(text).collect())
}

/// The report of a dry run.
pub(super) fn plan(words: &[&str]) -> Result<Value, Failure> {
    let (robot, command) = resolved("tcp://127.0.0.1:1", words)?;
    planned::<Toyo>(&robot, &*command, |_| ())
}

/// The block of a frame of it.
pub(super) fn text(frame: &Value) -> String {
    frame["text"].as_str().expect("blocks are text").to_owned()
}

/// A simulated controller and a link to it that last for several command lines, in virtual time.
pub(super) struct Bench {
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
}

/// What happens to a block and its answer on the line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fault {
    /// Both arrive.
    None,
    /// The block never arrives.
    Lost,
    /// The block arrives, its answer does not.
    Unanswered,
    /// The answer comes later.
    Late(Duration),
    /// This is answered, and nothing done.
    Answered(&'static str),
}

/// Blocks that arrived at the end of the line, or were lost before it, in their order.
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

/// A simulated controller behind a line that loses what a test wants to be lost.
struct FaultyLine<F> {
    controller: Simulated,
    coming: Vec<u8>,
    answers: VecDeque<(Duration, Vec<u8>)>,
    heard: ReceivedBlocks,
    counts: HashMap<String, usize>,
    /// The fault for a block, by its text and how often it came, from 1.
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
            self.coming.push(*byte);
            if *byte != b'\n' {
                continue;
            }
            let coming = std::mem::take(&mut self.coming);
            let block = String::from_utf8_lossy(&coming).trim_end().to_owned();
            self.heard.borrow_mut().push(block.clone());
            let count = self.counts.entry(block.clone()).or_default();
            *count += 1;
            let fault = (self.fault)(&block, *count);
            match fault {
                Fault::Lost => continue,
                Fault::Answered(answer) => self.answers.push_back((now, format!("{answer}\r\n").into_bytes())),
                _ => self.controller.receive(now, channel, &coming),
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
    /// A simulator in a start state (TOML), behind a line with faults; and the blocks that it receives.
    pub(super) fn with_faults(
        state: &str,
        fault: impl FnMut(&str, usize) -> Fault + Send + 'static,
    ) -> (Self, ReceivedBlocks) {
        let controller = Simulated::new(Start::parse(state).expect("a start state"));
        let heard = ReceivedBlocks::default();
        let (coming, answers) = (Vec::new(), VecDeque::new());
        let peer =
            Box::new(FaultyLine { controller, coming, answers, heard: heard.clone(), counts: HashMap::new(), fault });
        let (robot, _) = resolved("sim:", &["status"]).expect("a robot");
        let runtime = runtime();
        let link = runtime
            .block_on(async {
                let (pace, access) = (Pace::new(9600, 11), everything());
                let line =
                    Stream::InProcess(Box::new(InProcessLine::new(peer as Box<dyn Peer + Send>, Some(pace), None)));
                let client = Client::over(line, pace.time(1), connect::options(&robot, &access));
                Link::of(client, &robot, &access, &quiet())
            })
            .expect("a link");
        (Self { runtime, robot, link }, heard)
    }

    /// Runs `armctl toyo WORDS…` until Ctrl-C comes after a while; what is said then.
    pub(super) fn interrupted(&mut self, words: &[&str], after: Duration) -> Result<String, Failure> {
        self.left(words, after);
        self.runtime.block_on(Toyo::halt(&mut self.link))
    }

    /// Runs `armctl toyo WORDS…` for a while and leaves it there; whether that must not be.
    pub(super) fn left(&mut self, words: &[&str], after: Duration) -> bool {
        let (_, command) = resolved("sim:", words).expect("a command");
        let Self { runtime, robot, link } = self;
        runtime.block_on(async {
            let context = context(robot, link);
            if let Ok(done) = tokio::time::timeout(after, testing::run::<Toyo>(&*command, context)).await {
                panic!("{words:?} has ended before: {:?}", done.map(|report| report.data()));
            }
        });
        Toyo::must_halt(&self.link)
    }

    /// Lets time pass.
    pub(super) fn wait(&self, time: Duration) {
        self.runtime.block_on(async { tokio::time::sleep(time).await });
    }

    /// Puts back what the link has changed, as its end does; it may be used on.
    pub(super) fn end(&mut self) {
        let Self { runtime, link, .. } = self;
        runtime.block_on(async {
            link.put_back().await.unwrap_or_default();
            link.give_back().await.unwrap_or_default();
        });
    }

    /// Closes the link.
    pub(super) fn close(self) -> Result<(), Failure> {
        self.runtime.block_on(Toyo::close(self.link, &quiet()))
    }

    /// A simulator by its URL.
    pub(super) fn new(target: &str) -> Self {
        let runtime = runtime();
        let (robot, _) = resolved(target, &["status"]).expect("a robot");
        let link = runtime.block_on(Toyo::connect(&robot, everything(), &quiet())).expect("a link");
        Self { runtime, robot, link }
    }

    /// Runs `armctl toyo WORDS…`: the data of the report, and why it is not a success although there is one.
    pub(super) fn run(&mut self, words: &[&str]) -> Result<(Value, Option<Failure>), Failure> {
        let (_, command) = resolved("sim:", words)?;
        let Self { runtime, robot, link } = self;
        let report = runtime.block_on(testing::run::<Toyo>(&*command, context(robot, link)))?;
        Ok((report.data()?, report.failure()))
    }

    /// Runs `armctl toyo WORDS…` on what counts as a real robot, where nobody can be asked.
    pub(super) fn unasked(&mut self, words: &[&str]) -> Result<Value, Failure> {
        let (robot, command) = resolved("tcp://127.0.0.1:1", words)?;
        let intent = command.intent(Some(&robot));
        Gate::default().must_ask(&QUIET, &robot, &intent)?;
        let grant = Grant::up_to(intent.granted_at_first());
        self.link.grant(grant.clone());
        let authority = Authority::new(Gate::default(), &QUIET, &robot, intent.risk, grant);
        let context = Context { robot: &robot, link: &mut self.link, screen: &QUIET, several: false, authority };
        let came = self.runtime.block_on(testing::run::<Toyo>(&*command, context)).and_then(|report| report.data());
        self.link.grant(Grant::up_to(Risk::Motion));
        came
    }

    /// The data of a command line that must succeed.
    #[track_caller]
    pub(super) fn data(&mut self, words: &[&str]) -> Value {
        match self.run(words) {
            Ok((data, None)) => data,
            other => panic!("{words:?}: {other:?}"),
        }
    }
}

fn runtime() -> tokio::runtime::Runtime {
    tokio::runtime::Builder::new_current_thread().enable_all().start_paused(true).build().expect("a runtime")
}

fn parsed(target: &str, words: &[&str]) -> Result<Cli, clap::Error> {
    Cli::try_parse_from([&["armctl", "-t", target, "toyo"], words].concat())
}

/// Robot and command of a line.
fn resolved(target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand>), Failure> {
    let cli = parsed(target, words).map_err(|error| Failure::usage(error.to_string()))?;
    let selection = Selection { target: cli.globals.target, ..Selection::default() };
    let robot = Sources { selection, ..Sources::default() }.robots(Some(Name::Toyo))?.remove(0);
    match cli.command {
        Top::Family(FamilyWord { typed: Typed { wish: Wish::Command(command), .. }, .. }) => Ok((robot, command)),
        _ => unreachable!("the words follow toyo"),
    }
}

/// Where tests write: nowhere.
fn quiet() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}

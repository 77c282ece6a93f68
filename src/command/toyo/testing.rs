//! For tests: what a command line would send, and what becomes of it on a simulator in virtual time.

use clap::Parser as _;
use futures_util::FutureExt as _;
use serde_json::Value;

use super::Family;
use super::link::Link;
use crate::cli::{Cli, Top};
use crate::command::{Access, AnyCommand, Context, Family as _, Noun as _};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::output::{ColorChoice, Format, Screen};
use crate::settings::target::Family as Name;
use crate::settings::{Robot, Selection, Sources};

/// What the parser of the command line objects to.
pub(super) fn objection(words: &[&str]) -> String {
    parsed("sim:", words).expect_err("the parser objects").to_string()
}

/// The question before the command, without "This will".
pub(super) fn intent(words: &[&str]) -> String {
    resolved("sim:", words).unwrap().1.intent()
}

/// The blocks that `armctl toyo WORDS…` would send, those for the host apart.
pub(super) fn blocks(words: &[&str]) -> Result<Vec<String>, Failure> {
    let blocks = all_blocks(words)?;
    Ok(blocks.into_iter().filter(|block| !matches!(&block[..], "@STAS SNO=2" | "@HSON" | "@HSOF")).collect())
}

/// All blocks that `armctl toyo WORDS…` would send.
pub(super) fn all_blocks(words: &[&str]) -> Result<Vec<String>, Failure> {
    let (robot, command) = resolved("tcp://127.0.0.1:1", words)?;
    let access = Access { granted: command.risk(), dry_run: true, trace: None };
    let mut link = Family::connect(&robot, access, &quiet()).now_or_never().expect("a dry run opens nothing")?;
    let context = Context { robot: &robot, link: &mut link, screen: &quiet(), several: false };
    if let Some(Err(failure)) = command.run(context).now_or_never() {
        return Err(failure);
    }
    let blocks = Family::rehearsed(&mut link);
    Ok(blocks.iter().map(|block| block["text"].as_str().expect("blocks are text").to_owned()).collect())
}

/// A simulated controller and a link to it that last for several command lines, in virtual time.
pub(super) struct Bench {
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
}

impl Bench {
    /// A simulator by its URL.
    pub(super) fn new(target: &str) -> Self {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_all().start_paused(true).build().expect("a runtime");
        let (robot, _) = resolved(target, &["status"]).expect("a robot");
        let link = runtime.block_on(Family::connect(&robot, EVERYTHING, &quiet())).expect("a link");
        Self { runtime, robot, link }
    }

    /// Runs `armctl toyo WORDS…`: the data of the report, and why it is not a success although there is one.
    pub(super) fn run(&mut self, words: &[&str]) -> Result<(Value, Option<Failure>), Failure> {
        let (_, command) = resolved("sim:", words)?;
        let Self { runtime, robot, link } = self;
        let report = runtime.block_on(command.run(Context { robot, link, screen: &quiet(), several: false }))?;
        Ok((report.data()?, report.failure()))
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

/// A link that may do anything.
const EVERYTHING: Access = Access { granted: Risk::Motion, dry_run: false, trace: None };

fn parsed(target: &str, words: &[&str]) -> Result<Cli, clap::Error> {
    Cli::try_parse_from([&["armctl", "-t", target, "toyo"], words].concat())
}

/// Robot and command of a line.
fn resolved(target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand<Family>>), Failure> {
    let cli = parsed(target, words).map_err(|error| Failure::usage(error.to_string()))?;
    let selection = Selection { target: cli.globals.target, ..Selection::default() };
    let robot = Sources { selection, ..Sources::default() }.robots(Some(Name::Toyo))?.remove(0);
    let Top::Toyo(noun) = cli.command else { unreachable!("the words follow toyo") };
    Ok((robot, noun.command()))
}

/// Where tests write: nowhere.
fn quiet() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}

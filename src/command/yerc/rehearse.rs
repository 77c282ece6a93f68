//! For tests: what a command line would send, and what becomes of it on a simulator.

use clap::Parser as _;
use futures_util::FutureExt as _;
use serde_json::Value;

use super::Family as Yerc;
use super::link::hex;
use crate::cli::{Cli, Top};
use crate::command::{Access, AnyCommand, Context, Family as _, Noun as _};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::output::{ColorChoice, Format, Screen};
use crate::settings::inventory::Options;
use crate::settings::{Robot, Selection, Sources, target};

/// The words of a command line after the program's name, for a robot that is never reached.
fn parsed(target: &str, words: &str) -> Result<Cli, clap::Error> {
    let words = format!("armctl -t {target} --dry-run yerc {words}");
    Cli::try_parse_from(words.split_ascii_whitespace())
}

/// What the parser of the command line objects to.
pub(super) fn objection(words: &str) -> String {
    parsed("udp://127.0.0.1", words).expect_err(words).to_string()
}

/// The question before the command, without "This will".
pub(super) fn intent(words: &str) -> String {
    match parsed("udp://127.0.0.1", words).unwrap().command {
        Top::Yerc(noun) => noun.command().intent(),
        Top::Common(_) => unreachable!("the words follow yerc"),
    }
}

/// The frames of a dry run, in hexadecimal, without the header: command, instance, attribute, service, padding, data.
pub(super) fn frames_on(target: &str, words: &str) -> Result<Vec<String>, Failure> {
    let (robot, command) = resolved(target, words)?;
    let access = Access { granted: command.risk(), dry_run: true, trace: None };
    let mut link = Yerc::connect(&robot, access, &screen()).now_or_never().expect("a dry run opens nothing")?;
    let context = Context { robot: &robot, link: &mut link, screen: &screen(), several: false };
    if let Some(Err(failure)) = command.run(context).now_or_never() {
        return Err(failure);
    }
    Ok(Yerc::rehearsed(&mut link).iter().map(of_frame).collect())
}

/// The data of the reports of command lines, one after the other on one simulator that starts in `state` (TOML).
pub(super) async fn reports(state: &str, lines: &[&str]) -> Vec<Result<Value, Failure>> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    std::io::Write::write_all(&mut file, state.as_bytes()).unwrap();
    let target = format!("sim:?state={}", file.path().display());
    let mut link = None;
    let mut reports = Vec::new();
    for words in lines {
        let (robot, command) = resolved(&target, words).unwrap();
        if link.is_none() {
            let access = Access { granted: Risk::Motion, dry_run: false, trace: None };
            link = Some(Yerc::connect(&robot, access, &screen()).await.unwrap());
        }
        let link = link.as_mut().expect("connected by the first line");
        let context = Context { robot: &robot, link, screen: &screen(), several: false };
        reports.push(match command.run(context).await {
            Ok(report) => report.failure().map_or_else(|| report.data(), Err),
            Err(failure) => Err(failure),
        });
    }
    reports
}

/// Robot and command of a line.
fn resolved(target: &str, words: &str) -> Result<(Robot, Box<dyn AnyCommand<Yerc>>), Failure> {
    let cli = parsed(target, words).unwrap_or_else(|error| panic!("{words}: {error}"));
    let selection = Selection { target: cli.globals.target, ..Selection::default() };
    let flags = Options { encoding: cli.globals.encoding, ..Options::default() };
    let sources = Sources { selection, flags, ..Sources::default() };
    let robot = sources.robots(Some(target::Family::Yerc))?.remove(0);
    let Top::Yerc(noun) = cli.command else { unreachable!("the words follow yerc") };
    Ok((robot, noun.command()))
}

/// Where tests write: nowhere.
fn screen() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}

/// [`frames_on`] a DX200.
pub(super) fn frames(words: &str) -> Result<Vec<String>, Failure> {
    frames_on("udp://127.0.0.1", words)
}

/// A golden frame of the manuals, in the same form.
pub(super) fn golden(id: &str) -> String {
    let frames: Vec<Value> = serde_json::from_str(include_str!("../../../tests/data/yerc-frames.json")).unwrap();
    let frame = frames.iter().find(|frame| frame["id"] == id).unwrap_or_else(|| panic!("no golden frame {id}"));
    of_frame(frame)
}

fn of_frame(frame: &Value) -> String {
    let frame = frame["hex"].as_str().expect("frames are hexadecimal").to_owned();
    assert_eq!(&frame[..12], hex(b"YERC\x20\0"));
    frame[48..].to_owned()
}

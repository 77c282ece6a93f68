//! Test support: the frames that a command line sends, and commands that run on a simulator in virtual time.

use crate::face::FACE;
use crate::prelude::*;
use armctl_controller::text::hex;
use armctl_frame::output::{ColorChoice, Format};
use armctl_frame::settings_report::IF_DIFFERENT;
use armctl_frame::testing;
use armctl_frame::testing::{context, planned, unlimited_access};
use armctl_frame::{AnyCommand, Family as _};

pub(super) const DX200: &str = "udp://127.0.0.1?model=dx200";
pub(super) const FS100: &str = "udp://127.0.0.1?model=fs100";

/// Error of the command-line parser.
pub(super) fn error_text(words: &str) -> String {
    let words: Vec<&str> = words.split_ascii_whitespace().collect();
    testing::parse(&FACE, DX200, &words).err().expect("the parser objects").to_string()
}

/// Text of the question before the command runs, without "This will".
pub(super) fn intent(words: &str) -> String {
    resolve_robot(DX200, &words.split_ascii_whitespace().collect::<Vec<_>>()).unwrap().1.intent(None).text
}

/// Frames that `armctl yerc -t TARGET WORDS…` would send (`data.frames` of a dry run). An error of the parser is
/// returned as a failure.
pub(super) fn dry_run(target: &str, words: &[&str]) -> Result<Vec<Value>> {
    let (robot, command) = resolve_robot(target, words)?;
    Ok(testing::frames(&planned::<Yerc>(&robot, &*command, |_| ())?))
}

/// Frames of a dry run in hexadecimal, without the header: command, instance, attribute, service, padding, data.
pub(super) fn frames_on(target: &str, words: &str) -> Result<Vec<String>> {
    let frames = dry_run(target, &words.split_ascii_whitespace().collect::<Vec<_>>())?;
    Ok(frames.iter().map(without_header).collect())
}

/// Frames as in [`frames_on`], for a DX200.
pub(super) fn frames(words: &str) -> Result<Vec<String>> {
    frames_on(DX200, words)
}

/// Golden frame of the manuals, in the same form as [`frames`].
pub(super) fn golden(id: &str) -> String {
    without_header(&golden_frame(id))
}

/// Asserts that a command line sends exactly one frame, apart from the read of an old value. The frame must be equal to
/// the golden frame, except for the request id.
#[track_caller]
pub(super) fn same(id: &str, target: &str, words: &[&str]) {
    let frames = dry_run(target, words).unwrap_or_else(|failure| panic!("{words:?}: {failure:?}"));
    let certain_frames =
        frames.iter().filter(|frame| frame["depends_on"].is_null() || frame["depends_on"] == IF_DIFFERENT);
    let (golden, sent) = (golden_frame(id), certain_frames.map(digits).collect::<Vec<_>>());
    let golden = digits(&golden);
    let sent = sent.iter().map(|frame| format!("{}{}{}", &frame[..22], &golden[22..24], &frame[24..]));
    assert_eq!(sent.collect::<Vec<_>>(), [golden], "{id}: {words:?}");
}

/// Runs several command lines on one simulator, which starts in `state` (TOML). Returns the data of their reports.
pub(super) async fn reports(state: &str, lines: &[&str]) -> Vec<Result<Value>> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    std::io::Write::write_all(&mut file, state.as_bytes()).unwrap();
    let target = format!("sim:?state={}", file.path().display());
    let mut link = None;
    let mut reports = Vec::new();
    for words in lines {
        let (robot, command) = resolve_robot(&target, &words.split_ascii_whitespace().collect::<Vec<_>>()).unwrap();
        if link.is_none() {
            link = Some(Yerc::connect(&robot, unlimited_access(), &quiet()).await.unwrap());
        }
        let link = link.as_mut().expect("connected by the first line");
        let context = context(&robot, link);
        reports.push(match testing::run::<Yerc>(&*command, context).await {
            Ok(report) => report.failure().map_or_else(|| report.data(), Err),
            Err(failure) => Err(failure),
        });
    }
    reports
}

/// Simulated controller with a link, for several command lines in virtual time.
pub(super) struct Bench {
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
}

impl Bench {
    /// Creates a bench for the simulator of a URL.
    pub(super) fn new(target: &str) -> Self {
        let runtime =
            tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().expect("a runtime");
        let (robot, _) = resolve_robot(target, &["status"]).expect("a robot");
        let link = runtime.block_on(Yerc::connect(&robot, unlimited_access(), &quiet())).expect("a link");
        Self { runtime, robot, link }
    }

    /// Runs `armctl yerc WORDS…`. Returns the data of the report. If the report contains a failure, it is returned as
    /// well.
    pub(super) fn run(&mut self, words: &[&str]) -> Result<(Value, Option<Failure>)> {
        let (_, command) = resolve_robot("sim:", words)?;
        let Self { runtime, robot, link } = self;
        let report = runtime.block_on(testing::run::<Yerc>(&*command, context(robot, link)))?;
        Ok((report.data()?, report.failure()))
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

/// Robot and command of a command line.
pub(super) fn resolve_robot(target: &str, words: &[&str]) -> Result<(Robot, Box<dyn AnyCommand>)> {
    testing::resolve(&FACE, target, words)
}

/// Screen without output.
pub(super) fn quiet() -> Screen {
    Screen::new(Format::Json, ColorChoice::Never, true, 0)
}

fn golden_frame(id: &str) -> Value {
    let frames: Vec<Value> = serde_json::from_str(include_str!("../../tests/data/yerc-frames.json")).unwrap();
    frames.into_iter().find(|frame| frame["id"] == id).unwrap_or_else(|| panic!("no golden frame {id}"))
}

fn digits(frame: &Value) -> String {
    frame["hex"].as_str().expect("frames are hexadecimal").to_owned()
}

/// Digits of a frame after its header.
pub(super) fn without_header(frame: &Value) -> String {
    let frame = digits(frame);
    assert_eq!(&frame[..12], hex(b"YERC\x20\0"));
    frame[48..].to_owned()
}

//! Recording of a robot: the file `recording.jsonl` in the folder of the robot, next to its backup if there is one.
//!
//! The first line describes the robot. Each other line is a poll with its time, the state for people, and the answers
//! that differ from the poll before. A simulator replays these answers.

use std::io::{BufRead as _, BufReader, Read as _};

use serde::Deserialize;

use super::manifest::Manifest;
use crate::prelude::basics::*;
use armctl_controller::simulator::recording::{Answers, Recording, Replayable, Sample};

/// Name of the file.
pub const FILE: &str = "recording.jsonl";

/// Format name, for programs that find the file.
const FORMAT: &str = "armctl recording";
/// Incremented if older programs would misread a newer recording.
const VERSION: u32 = 1;
/// Maximum length of a line in bytes.
const MAX_LINE: u64 = 16 << 20;

/// Arguments of a simulator for a replay.
#[derive(Debug, Default, Args)]
#[group(skip)]
pub struct ReplayArguments {
    /// Recording of a robot (`armctl record`), whose answers the simulator gives at the same times
    #[arg(long, value_name = "FILE", conflicts_with = "state")]
    replay: Option<PathBuf>,
    /// Start the recording again at its end, or after this time [default: keep the last state]
    #[arg(
        long = "loop", value_name = "TIME", num_args = 0..=1, require_equals = true,
        value_parser = duration::parse, default_missing_value = "0s", requires = "replay"
    )]
    pass: Option<Duration>,
}

impl ReplayArguments {
    /// Start state that replays the recording, with a text about the recording. Without a recording, the start state
    /// stays the same.
    pub fn apply<S: Replayable>(&self, start: S, family: Family) -> Result<(S, Option<String>)> {
        let Some(path) = &self.replay else { return Ok((start, None)) };
        let recorded = Recorded::of_family(path, family)?;
        let note = recorded.note(path);
        // Without a time, the pass is the whole recording.
        let pass = self.pass.map(|pass| if pass.is_zero() { recorded.pass() } else { pass });
        Ok((start.with_recording(Recording::new(recorded.samples, pass)), Some(note)))
    }
}

/// Start state that replays a recording, if there is one, for the simulator of a URL.
pub fn with_replay<S: Replayable>(start: S, path: Option<&Path>, family: Family) -> Result<S> {
    let Some(path) = path else { return Ok(start) };
    let recorded = Recorded::of_family(path, family)?;
    Ok(start.with_recording(Recording::new(recorded.samples, None)))
}

/// First line of a recording.
#[derive(Debug, Serialize, Deserialize)]
pub struct Head {
    /// Format name, always the same.
    format: String,
    version: u32,
    /// Polling interval.
    pub interval_ms: u64,
    /// Model of the controller, if it is known (yerc).
    pub model: Option<String>,
    /// The robot, in the form of a backup without files.
    pub manifest: Manifest,
}

impl Head {
    /// First line of a new recording of a robot.
    pub fn new(robot: &Robot, interval: Duration) -> Self {
        let model = (robot.family == Family::Yerc).then(|| robot.likely_model()).flatten();
        Self {
            format: FORMAT.to_owned(),
            version: VERSION,
            interval_ms: u64::try_from(interval.as_millis()).unwrap_or(u64::MAX),
            model: model.map(|model| model.name().to_owned()),
            manifest: Manifest::new(robot, Value::Null, Vec::new()),
        }
    }

    /// Reads the first line of a recording.
    pub fn read(path: &Path) -> Result<Self> {
        Lines::open(path)?.head()
    }
}

/// What a replay needs of a line.
#[derive(Debug, Deserialize)]
struct Line {
    at_ms: u64,
    answers: Option<Answers>,
}

/// A recording of a robot.
#[derive(Debug)]
pub struct Recorded {
    /// First line.
    pub head: Head,
    /// Polls.
    pub samples: Vec<Sample>,
    /// Whether the last line was incomplete, because the recorder was killed. That line is not in the samples.
    pub is_torn: bool,
}

impl Recorded {
    /// Reads a recording.
    pub fn read(path: &Path) -> Result<Self> {
        let mut lines = Lines::open(path)?;
        let head = lines.head()?;
        let mut samples: Vec<Sample> = Vec::new();
        let mut is_torn = false;
        while let Some(text) = lines.next()? {
            let Line { at_ms, answers } = match serde_json::from_str(&text) {
                Ok(line) => line,
                Err(_) if !text.ends_with('\n') => {
                    is_torn = true;
                    break;
                }
                Err(error) => return Err(lines.damaged(&error.to_string())),
            };
            let at = Duration::from_millis(at_ms);
            if samples.last().is_some_and(|last| last.at > at) {
                return Err(lines.damaged("its time is before the time of the line before"));
            }
            samples.push(Sample { at, answers });
        }
        if samples.is_empty() {
            return Err(Failure::local(format!("{} contains no complete poll", path.display()))
                .hint("record the robot again with `armctl record`"));
        }
        Ok(Self { head, samples, is_torn })
    }

    /// Reads a recording of a family.
    fn of_family(path: &Path, family: Family) -> Result<Self> {
        let recorded = Self::read(path)?;
        let found = &recorded.head.manifest.family;
        if found != family.name() {
            let message = format!("{} is a recording of a {found} controller", path.display());
            return Err(Failure::usage(message).hint(format!("replay it with `armctl sim {found} --replay FILE`")));
        }
        Ok(recorded)
    }

    /// Duration of the recording. The last poll lasts one interval.
    pub fn pass(&self) -> Duration {
        let end = self.samples.last().map_or(Duration::ZERO, |last| last.at);
        end + Duration::from_millis(self.head.interval_ms.max(1))
    }

    /// What the recording contains, and what a replay leaves out.
    fn note(&self, path: &Path) -> String {
        let polls = self.samples.len();
        let seconds = self.samples.last().map_or(0.0, |last| last.at.as_secs_f64());
        let silent = self.samples.iter().filter(|sample| sample.answers.is_none()).count();
        let silent = if silent == 0 { String::new() } else { format!(", {silent} without an answer") };
        let torn = if self.is_torn { "; the last line is incomplete and is not used" } else { "" };
        format!("replays {}: {polls} polls in {seconds:.1} s{silent}{torn}", path.display())
    }
}

/// Lines of a recording.
struct Lines<'a> {
    path: &'a Path,
    reader: BufReader<std::fs::File>,
    number: u64,
}

impl<'a> Lines<'a> {
    fn open(path: &'a Path) -> Result<Self> {
        let file = files::open(path).with_context(|| path.display().to_string())?;
        Ok(Self { path, reader: BufReader::new(file), number: 0 })
    }

    /// Next line with its line end, which a torn line does not have.
    fn next(&mut self) -> Result<Option<String>> {
        self.number += 1;
        let mut text = Vec::new();
        let mut limited = (&mut self.reader).take(MAX_LINE);
        let length = limited.read_until(b'\n', &mut text).with_context(|| self.path.display().to_string())?;
        if u64::try_from(length).is_ok_and(|length| length == MAX_LINE) {
            return Err(self.damaged("the line is longer than 16 MiB"));
        }
        // A torn line can end inside a character. Such a line is not valid JSON.
        Ok((length > 0).then(|| String::from_utf8_lossy(&text).into_owned()))
    }

    fn head(&mut self) -> Result<Head> {
        let text = self.next()?.unwrap_or_default();
        match serde_json::from_str::<Head>(&text) {
            Ok(Head { version, .. }) if version > VERSION => {
                Err(self.damaged(&format!("the version is {version}; this armctl supports up to {VERSION}")))
            }
            Ok(head) if head.format == FORMAT => Ok(head),
            _ => Err(self.damaged("it is not the first line of a recording")),
        }
    }

    fn damaged(&self, why: &str) -> Failure {
        Failure::local(format!("{}: line {}: {why}", self.path.display(), self.number))
            .hint("use a recording of `armctl record`, or record the robot again")
    }
}

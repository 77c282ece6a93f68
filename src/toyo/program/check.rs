//! `toyo program check`.

use std::path::PathBuf;

use super::text::{self, Remark};
use crate::files;
use crate::point::Points;
use crate::prelude::*;
use crate::sim::{self, Stop};
use armctl_controller::findings::{Finding, Severity};
use armctl_controller::names::{Name, Names};
use armctl_controller::toyo::errors;
use armctl_controller::toyo::program::{self, Checked, ControllerData, MAX_STEPS};
use armctl_frame::OfflineCommand;
use armctl_frame::store::keys_of;

/// Check program files and print each error with line and column. Needs no robot.
#[derive(Debug, Args)]
#[command(
    after_help = "The exit code is 0 if all files are valid programs, 8 if a file has errors, and 1 if a file cannot \
                  be read. `program put` and `sim run` also check the file, and end with exit code 2 after an \
                  error.\n\nForm of a file: one step per line, # or ; begins a comment, a label can replace a tag, \
                  numbers need no leading zeros. Warnings show where a controller stops: a RET without a call, a call \
                  that leads back to itself, an incomplete arc, a missing point, or an error in an offline run of \
                  some seconds.\n\n      SPD V=5\nnext: MOVP a PT=1 CN=0 S V=0 POST\n      JMPI TAG=next STN=0 \
                  PN1=.......1   ; while the gripper is full\n      END"
)]
pub struct Check {
    /// Program files; - means stdin
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Number of steps of the task
    #[arg(long, value_name = "STEPS", default_value_t = 5000, value_parser = clap::value_parser!(u16).range(1..=5000))]
    room: u16,
    /// CSV file of the taught points from `point dump`. A move to a point that is not in this file causes a warning
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Name of a point, a counter or a timer, in the form of robots.toml, for example pick=PT1 (repeatable)
    #[arg(long, value_name = "NAME=ADDRESS", value_parser = text::name)]
    name: Vec<Name>,
    /// Treat warnings as errors
    #[arg(long)]
    strict: bool,
}

/// Error code of a TSTR step for a task that has no program.
const NO_TASK: u8 = 0x63;

impl OfflineCommand for Check {
    type Report = Verdict;
    const ID: &'static str = "toyo.program.check";

    fn run(&self, _screen: &Screen) -> Result<Verdict, Failure> {
        let room = usize::from(self.room).min(MAX_STEPS);
        let names = Names::new(self.name.clone());
        let points = self.points.as_ref().map(|path| keys_of::<Points>(path, &files::read(path)?));
        let known = ControllerData { points: points.transpose()?.map(|points| points.into_iter().collect()) };
        let verdict = |path: &PathBuf| {
            let (bytes, name) = (files::read(path)?, files::display_path(path));
            let mut checked = program::check_known(&bytes, room, None, &names, &known);
            if let Some(program) = &checked.program {
                let stop = sim::rehearse(&name, program, self.points.as_deref())?;
                rehearsed(&mut checked.findings, stop.as_ref());
            }
            Ok(FileVerdict::new(&name, &bytes, &checked))
        };
        let files = self.files.iter().map(verdict);
        Ok(Verdict { files: files.collect::<Result<_, Failure>>()?, strict: self.strict })
    }
}

/// Adds the step at which an offline run stops with an error, unless there is already a finding for this step.
fn rehearsed(findings: &mut Vec<Finding>, stop: Option<&Stop>) {
    let Some(Stop { code, after_s, line }) = stop else { return };
    let said = findings.iter().filter(|finding| finding.line == *line).map(|finding| finding.severity).min();
    let severity = match said {
        Some(Severity::Error | Severity::Warning) => return,
        // Here the result depends on the controller, or the program of the task is in another file.
        Some(Severity::Note) => Severity::Note,
        None if code.is_none_or(|code| code == NO_TASK) => Severity::Note,
        None => Severity::Warning,
    };
    let what = match code {
        Some(code) => {
            format!("a controller stops here after {after_s:.3} s: error {}", errors::explain(*code).in_a_line())
        }
        None => format!("all tasks wait here after {after_s:.3} s"),
    };
    let at = findings.iter().position(|finding| finding.line > *line).unwrap_or(findings.len());
    findings.insert(
        at,
        Finding {
            severity,
            line: *line,
            column: 1,
            message: format!("in an offline run {what}"),
            hint: Some(
                "use `toyo sim run` to see the earlier steps; counters begin at 0, and inputs are off".to_owned(),
            ),
        },
    );
}

/// Result for all files.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Verdict {
    files: Vec<FileVerdict>,
    #[serde(skip)]
    strict: bool,
}

/// Result for a file.
#[derive(Debug, Serialize, JsonSchema)]
struct FileVerdict {
    file: String,
    /// Whether the file is a program.
    ok: bool,
    /// Number of steps; null if the file is not a program.
    steps: Option<usize>,
    /// Labels with their tags.
    labels: Vec<Labelled>,
    errors: usize,
    warnings: usize,
    /// Findings in the order of the text.
    findings: Vec<Remark>,
}

/// A label of a program file, with the tag that it becomes.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Labelled {
    name: String,
    /// Tag number of the label.
    tag: i32,
    /// Number of the step that contains the tag.
    step: usize,
    /// Line of the label in the file.
    line: usize,
}

impl Labelled {
    /// The labels of a program.
    pub fn of(program: &program::Program) -> Vec<Self> {
        let labelled = |label: &program::Label| {
            let program::Label { name, tag, step, line } = label.clone();
            Self { name, tag, step, line }
        };
        program.labels.iter().map(labelled).collect()
    }

    /// Describes the label, for example `next = tag 001, step 2`.
    pub fn in_a_line(&self) -> String {
        format!("{} = tag {:03}, step {}", self.name, self.tag, self.step)
    }
}

impl FileVerdict {
    fn new(file: &str, bytes: &[u8], checked: &Checked) -> Self {
        let text = String::from_utf8_lossy(bytes);
        let lines: Vec<&str> = text.lines().collect();
        let findings: Vec<Remark> = checked.findings.iter().map(|finding| Remark::new(finding, &lines)).collect();
        let count = |severity| findings.iter().filter(|remark| remark.severity == severity).count();
        Self {
            file: file.to_owned(),
            ok: checked.program.is_some(),
            steps: checked.program.as_ref().map(|program| program.steps.len()),
            labels: checked.program.as_ref().map(Labelled::of).unwrap_or_default(),
            errors: count("error"),
            warnings: count("warning"),
            findings,
        }
    }

    /// Describes the result, for example `pick.txt: 12 steps, 2 labels, 1 warning`.
    fn in_a_line(&self) -> Cell {
        let counted = |count: usize, what: &str| match count {
            0 => None,
            1 => Some(format!("1 {what}")),
            _ => Some(format!("{count} {what}s")),
        };
        let parts = [
            self.steps.and_then(|steps| counted(steps, "step")),
            counted(self.labels.len(), "label"),
            counted(self.errors, "error"),
            counted(self.warnings, "warning"),
        ];
        let text = format!("{}: {}", self.file, parts.into_iter().flatten().collect::<Vec<_>>().join(", "));
        Cell::from(text).tone(match self {
            Self { ok: false, .. } => Tone::Bad,
            Self { warnings: 0, .. } => Tone::Good,
            _ => Tone::Warning,
        })
    }
}

impl Report for Verdict {
    fn view(&self) -> View {
        let remarks = |file: &FileVerdict| {
            let mut lines: Vec<Cell> = file.findings.iter().flat_map(|remark| remark.lines(&file.file)).collect();
            lines.push(file.in_a_line());
            lines
        };
        View { sections: vec![Section::Lines(self.files.iter().flat_map(remarks).collect())] }
    }

    fn failure(&self) -> Option<Failure> {
        let bad = |file: &&FileVerdict| !file.ok || (self.strict && file.warnings > 0);
        let bad: Vec<&str> = self.files.iter().filter(bad).map(|file| file.file.as_str()).collect();
        let what = match (&bad[..], self.strict) {
            ([], _) => return None,
            ([one], false) => format!("{one} has errors"),
            ([one], true) => format!("{one} has warnings"),
            (many, _) => format!("{} of {} files have errors: {}", many.len(), self.files.len(), many.join(", ")),
        };
        Some(Failure::new(Kind::ConditionNotMet, what))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::output::render;

    fn verdict(texts: &[(&str, &str)], strict: bool) -> Verdict {
        let files = texts
            .iter()
            .map(|(name, text)| FileVerdict::new(name, text.as_bytes(), &program::check(text.as_bytes(), MAX_STEPS)));
        Verdict { files: files.collect(), strict }
    }

    #[test]
    fn shows_errors_at_their_position() {
        let verdict = verdict(&[("a.txt", "SPD V=11\nEMD\n"), ("b.txt", "x: JMP TAG=x\n")], false);
        assert_eq!(
            render::text(&verdict.view(), 80, false),
            "error: speed: 11 is out of range (a number, 1 to 10)
 --> a.txt:1:7
  |
1 | SPD V=11
  |       \
             ^

error: unknown instruction 'EMD'
 --> a.txt:2:1
  |
2 | EMD
  | ^
  = did you mean END?

a.txt: 2 \
             errors
b.txt: 2 steps, 1 label
"
        );
        let failure = verdict.failure().unwrap();
        assert_eq!((failure.kind.exit(), failure.message.as_str()), (8, "a.txt has errors"));
    }

    /// A run finds errors that the steps alone do not show.
    #[test]
    fn simulated_run_finds_further_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let findings = |text: &str| {
            std::fs::write(&path, text).unwrap();
            let check = Check { files: vec![path.clone()], room: 5000, points: None, name: Vec::new(), strict: false };
            let screen =
                Screen::new(armctl_frame::output::Format::Json, armctl_frame::output::ColorChoice::Never, true, 0);
            let verdict = check.run(&screen).unwrap();
            let told =
                verdict.files[0].findings.iter().filter(|remark| remark.message.starts_with("in an offline run"));
            told.map(|remark| (remark.severity, remark.line, remark.message.clone())).collect::<Vec<_>>()
        };
        let error = |code: &str| format!("in an offline run a controller stops here after 0.001 s: error {code}");
        assert_eq!(
            findings("CNT+ CN1=9999\nCNT+ CN1=1\nEND\n"),
            [("warning", 2, error("A7: calculation error"))],
            "a counter that is too large"
        );
        assert_eq!(findings("NOP\nTSTR TASK=2\nEND\n"), [("note", 2, error("63: task cannot be started"))]);
        assert_eq!(
            findings("NOP\nIN STN=0 PN1=.......1 AND\nEND\n"),
            [("note", 2, "in an offline run all tasks wait here after 0.001 s".to_owned())]
        );
        for text in ["RET\n", "a: SPD V=1\nJMP TAG=a\n", "SPD V=1\nEND\n"] {
            assert_eq!(findings(text), [], "{text}: it is said already, or nothing stops");
        }
    }

    #[test]
    fn strict_check_fails_on_warnings() {
        let texts = [("a.txt", "SPD V=1\n")];
        assert!(verdict(&texts, false).failure().is_none());
        assert_eq!(verdict(&texts, true).failure().unwrap().message, "a.txt has warnings");
    }
}

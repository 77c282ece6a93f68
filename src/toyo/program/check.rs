//! `toyo program check`.

use super::folder::{add_speeds, check_file, parameters_of, points_of, program_of, programs_in, read_program};
use super::robot_data::{RobotData, Wanted, read_data};
use super::text;
use crate::files;
use crate::point::Points;
use crate::prelude::*;
use crate::sim::{self, Stop};
use armctl_controller::findings::{Finding, Rule, Severity};
use armctl_controller::names::{Name, Names};
use armctl_controller::references::Role;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::program::{self, ControllerData, MAX_STEPS};
use armctl_frame::programs::Program;
use armctl_frame::programs::check::{CheckArguments, CheckContext, check, moved, unused_positions};
use armctl_frame::programs::settings::{self, CheckSettings};
use armctl_frame::programs::source::{ProgramFile, ProgramSet};
use armctl_frame::programs::verdict::{self, FileVerdict};
use armctl_frame::store::keys_of;

/// Check programs of files, a folder or the controller, and print each finding with line and column.
#[derive(Debug, Args)]
#[command(after_help = help())]
pub struct Check {
    /// Program files; - means stdin [default: the program of the current task]
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Check the programs in this folder: a backup, or files program-N.txt and *.toyo. With files: check them with the
    /// points, parameters and names of this backup
    #[arg(long, value_name = "FOLDER")]
    from: Option<PathBuf>,
    /// Number of steps of the task
    #[arg(long, value_name = "STEPS", default_value_t = 5000, value_parser = clap::value_parser!(u16).range(1..=5000))]
    room: u16,
    /// CSV file of the taught points from `point dump`. A move to a point that is not in this file causes a warning
    #[arg(long, value_name = "FILE")]
    points: Option<PathBuf>,
    /// Name of a point, a counter or a timer, in the form of robots.toml, for example pick=PT1 (repeatable)
    #[arg(long, value_name = "NAME=ADDRESS", value_parser = text::name)]
    name: Vec<Name>,
    #[command(flatten)]
    limits: CheckArguments,
}

fn help() -> String {
    format!(
        "The exit code is 0 if all files are valid programs, 8 if a file has errors, and 1 if a file cannot be read. \
         `program put` and `sim run` also check the file, and end with exit code 2 after an error.\n\nForm of a file: \
         one step per line, # or ; begins a comment, a label can replace a tag, numbers need no leading zeros. \
         Warnings show where a controller stops: a RET without a call, a call that leads back to itself, an \
         incomplete arc, a missing point, or an error in an offline run of some seconds. In a backup, the points of \
         the task are checked too.\n\n      SPD V=5\nnext: MOVP a PT=1 CN=0 S V=0 POST\n      JMPI TAG=next STN=0 \
         PN1=.......1   ; while the gripper is full\n      END\n\n{}",
        settings::help()
    )
}

/// Error code of a TSTR step for a task that has no program.
const NO_TASK: u8 = 0x63;

impl Command for Check {
    type Family = Toyo;
    type Report = Verdict;
    const ID: &'static str = "toyo.program.check";

    fn takes_robot(&self) -> bool {
        self.files.is_empty() && self.from.is_none()
    }

    fn run_alone(&self) -> Result<Verdict> {
        let of_folder = self.from.as_deref().map(programs_in).transpose()?;
        let names = of_folder.as_ref().map(|set| set.names.clone()).unwrap_or_default();
        if let Some(set) = of_folder.filter(|_| self.files.is_empty()) {
            return self.check(set, &self.source(), &names);
        }
        let read = |path: &PathBuf| {
            let file = files::display_path(path);
            Ok(ProgramFile { name: file.clone(), file, bytes: files::read(path)? })
        };
        let files = self.files.iter().map(read).collect::<Result<_>>()?;
        self.check(ProgramSet { files, is_partial: true, ..ProgramSet::default() }, &self.source(), &names)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Verdict> {
        let Context { robot, link, screen, .. } = context;
        let settings = self.limits.settings(None)?;
        let needs_data = !settings.max_speed.is_empty() || self.limits.compare.is_some();
        let set = program_of(link, screen, None).await;
        if link.is_dry_run() && needs_data {
            link.then("reads of the speeds and points that the program uses");
        }
        let set = set?;
        let mut data = RobotData::default();
        if let Some(file) = set.files.first().filter(|_| needs_data)
            && let Some(program) = check_file(file, MAX_STEPS, &Names::default(), &ControllerData::default()).program
        {
            data = read_data(link, screen, None, &program, Wanted::Used).await?;
        }
        let names: Vec<Name> = names::of_robot(robot, screen).iter().cloned().collect();
        self.check(set, &Source::Robot(data), &names)
    }
}

/// Where the points and the speeds of the programs are.
enum Source {
    Folder(PathBuf),
    Robot(RobotData),
    Nowhere,
}

impl Check {
    /// The folder of --from or of the files.
    fn source(&self) -> Source {
        let of_files = || self.files.first().and_then(|path| path.parent());
        self.from.as_deref().or_else(of_files).map_or(Source::Nowhere, |folder| Source::Folder(folder.to_owned()))
    }

    /// File with the points of a program in a backup. A file with another name is a program of task 1.
    fn points_in(&self, folder: &Path, name: &str) -> Option<PathBuf> {
        let of_task_1 = || points_of(folder, "program-1").filter(|_| !self.files.is_empty());
        points_of(folder, name).or_else(of_task_1)
    }

    fn check(&self, set: ProgramSet, source: &Source, names: &[Name]) -> Result<Verdict> {
        let folder = if let Source::Folder(folder) = source { Some(folder.as_path()) } else { None };
        let names = Names::new(self.name.iter().chain(names).cloned().collect());
        let mut settings = self.limits.settings(folder)?;
        // Every program of a task can be started from outside.
        settings.master = vec!["*".to_owned()];
        let (mut programs, mut parsed) = (Vec::new(), Vec::new());
        for file in &set.files {
            let points = self.points.clone().or_else(|| self.points_in(folder?, &file.name));
            let taught = points.as_ref().map(|path| keys_of::<Points>(path, &files::read(path)?)).transpose()?;
            let known = ControllerData { points: taught.map(|points| points.into_iter().collect()) };
            let mut checked = check_file(file, usize::from(self.room).min(MAX_STEPS), &names, &known);
            if let Some(program) = &checked.program {
                let stop = sim::rehearse(&file.file, program, points.as_deref())?;
                rehearsed(&mut checked.findings, stop.as_ref());
            }
            let mut program = read_program(file, &checked);
            for line in &mut program.lines {
                // A check of all paths already reports calls of subroutines.
                line.references.retain(|reference| reference.role != Role::Call);
            }
            let data = match source {
                Source::Folder(folder) => &RobotData::of_files(points.as_deref(), parameters_of(folder).as_deref())?,
                Source::Robot(data) => data,
                Source::Nowhere => &RobotData::of_files(points.as_deref(), None)?,
            };
            if let Some(parsed) = &checked.program {
                add_speeds(&mut program, parsed, &data.speeds);
                let unused = data.unused_points(parsed);
                program.findings.extend(unused_positions(1, &unused));
            }
            if let Some(other) = &self.limits.compare {
                let old = RobotData::of_files(self.points_in(other, &file.name).as_deref(), None)?;
                let found = moved_points(data, &old, other, &settings);
                program.findings.extend(at_uses(&program, found));
            }
            programs.push(program);
            parsed.push(checked.program);
        }
        let context =
            CheckContext { settings, unread: set.unread, is_partial: set.is_partial, ..CheckContext::default() };
        check(&mut programs, &context);
        let verdicts = programs.iter().zip(&parsed);
        let verdicts = verdicts.map(|(program, parsed)| FileVerdict::new(program, Contents::new(parsed.as_ref())));
        Ok(Verdict::new(verdicts.collect(), context.unread, self.limits.strict))
    }
}

/// Points that differ from the points of the same numbers in a backup.
fn moved_points(data: &RobotData, old: &RobotData, folder: &Path, settings: &CheckSettings) -> Vec<(String, Finding)> {
    let old = old.positions();
    let of_name = |name: &str| old.iter().find(|one| one.name == name).cloned();
    let pairs = data.positions().into_iter().filter_map(|new| Some((of_name(&new.name)?, new)));
    pairs.flat_map(|(old, new)| moved(&[new], &[old], &folder.display().to_string(), settings)).collect()
}

/// Moves findings about points to the first lines that use these points.
fn at_uses(program: &Program, found: Vec<(String, Finding)>) -> Vec<Finding> {
    let line_of = |point: &str| program.references().find(|(_, one)| one.name == point).map(|(line, _)| line.number);
    found.into_iter().filter_map(|(point, finding)| Some(Finding { line: line_of(&point)?, ..finding })).collect()
}

/// Adds the step at which an offline run stops with an error, unless there is already a finding for this step.
fn rehearsed(findings: &mut Vec<Finding>, stop: Option<&Stop>) {
    let Some(Stop { code, after_s, line }) = stop else { return };
    let said = findings.iter().filter(|finding| finding.line == *line).map(|finding| finding.severity).min();
    let (rule, severity) = match said {
        Some(Severity::Error | Severity::Warning) => return,
        // Here the result depends on the controller, or the program of the task is in another file.
        Some(Severity::Note) => (Rule::Unchecked, Severity::Note),
        None if code.is_none_or(|code| code == NO_TASK) => (Rule::Unchecked, Severity::Note),
        None => (Rule::Stops, Severity::Warning),
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
            rule,
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

/// Verdict of a check.
pub type Verdict = verdict::Verdict<Contents>;

/// What a file contains.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Verdict")]
pub struct Contents {
    /// Number of steps; null if the file is not a program.
    steps: Option<usize>,
    /// Labels with their tags.
    labels: Vec<Labelled>,
}

impl Contents {
    fn new(program: Option<&program::Program>) -> Self {
        Self {
            steps: program.map(|program| program.steps.len()),
            labels: program.map(Labelled::of).unwrap_or_default(),
        }
    }
}

impl verdict::Summary for Contents {
    fn counts(&self) -> Vec<(usize, &'static str)> {
        vec![(self.steps.unwrap_or_default(), "step"), (self.labels.len(), "label")]
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::without_robot;
    use armctl_frame::output::render;

    fn verdict(texts: &[(&str, &str)], strict: bool) -> Verdict {
        let files = texts.iter().map(|(name, text)| {
            let name = (*name).to_owned();
            let file = ProgramFile { name: name.clone(), file: name, bytes: text.as_bytes().to_vec() };
            let checked = program::check(text.as_bytes(), MAX_STEPS);
            FileVerdict::new(&read_program(&file, &checked), Contents::new(checked.program.as_ref()))
        });
        Verdict::new(files.collect(), Vec::new(), strict)
    }

    #[test]
    fn shows_errors_at_their_position() {
        let verdict = verdict(&[("a.txt", "SPD V=11\nEMD\n"), ("b.txt", "x: JMP TAG=x\n")], false);
        assert_eq!(
            render::text(&verdict.view(), 80, false),
            "error[syntax]: speed: 11 is out of range (a number, 1 to 10)
 --> a.txt:1:7
  |
1 | SPD V=11
  |       \
             ^

error[syntax]: unknown instruction 'EMD'
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
            let (data, _) = without_robot(&["program", "check", path.to_str().unwrap()]).unwrap();
            let findings = data["files"][0]["findings"].as_array().unwrap().clone().into_iter();
            let text = |value: &serde_json::Value| value.as_str().unwrap().to_owned();
            let run = findings.filter(|one| text(&one["message"]).starts_with("in an offline run"));
            run.map(|one| (text(&one["severity"]), one["line"].as_u64().unwrap(), text(&one["message"])))
                .collect::<Vec<_>>()
        };
        let error = |code: &str| format!("in an offline run a controller stops here after 0.001 s: error {code}");
        assert_eq!(
            findings("CNT+ CN1=9999\nCNT+ CN1=1\nEND\n"),
            [("warning".to_owned(), 2, error("A7: calculation error"))],
            "a counter that is too large"
        );
        assert_eq!(findings("NOP\nTSTR TASK=2\nEND\n"), [("note".to_owned(), 2, error("63: task cannot be started"))]);
        assert_eq!(
            findings("NOP\nIN STN=0 PN1=.......1 AND\nEND\n"),
            [("note".to_owned(), 2, "in an offline run all tasks wait here after 0.001 s".to_owned())]
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

//! `toyo program get`.

use super::source_texts::Source;
use crate::item_reads::Answers;
use crate::link::misuse;
use crate::prelude::*;
use armctl_controller::toyo::program::{self, Rows, Style, Unread, listing_named, not_read};
use armctl_controller::toyo::table::Op;
use armctl_frame::backup::manifest::Hash;
use armctl_frame::items::{ItemOutcome, verdict};
use armctl_frame::local_names::Target;
use armctl_frame::output::escape;
use armctl_frame::robot::file::FileItem;
use armctl_frame::robot::item::Plain;

/// Read the program of a task as text, which `program put` writes back.
#[derive(Debug, Args)]
#[command(
    after_help = "All steps are read, because subroutines can follow END. The text omits NOPs at the end. A step \
                  takes about 35 ms at 9600 baud. If the task is not the current task, armctl selects the task \
                  temporarily. A read-only robot does not allow this change.\n\nA controller stores neither labels \
                  nor comments. If the controller has the steps that the last `program put` on this computer wrote, \
                  the command prints the text of that file. Otherwise the command prints a note and the steps.\n\nIf \
                  the controller refuses a step, the text has ? in its place. Such a text is not a valid program, and \
                  armctl writes no file."
)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag")]
pub struct Get {
    /// New file for the program [default: stdout]
    #[arg(value_parser = parse_file)]
    file: Option<PathBuf>,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
    /// First step to read
    #[arg(long, value_name = "STEP", default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=5000))]
    from: u16,
    /// Last step to read [default: the last step of the task]
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u16).range(1..=5000))]
    to: Option<u16>,
    /// Stop at the first END
    #[arg(long)]
    until_end: bool,
    /// Print step numbers before the instructions
    #[arg(long)]
    numbers: bool,
    /// Add comments with the points, speeds and other table rows of the program
    #[arg(long)]
    explain: bool,
    /// Print only the steps of the controller, without labels and comments of the text that `program put` wrote
    #[arg(long)]
    plain: bool,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
}

/// Parses the name of a file. A word with the form of a step number is rejected, because the user probably means a
/// step.
fn parse_file(text: &str) -> Result<PathBuf, String> {
    let is_step = text.starts_with(|first: char| first.is_ascii_digit())
        && text.chars().all(|one| one.is_ascii_digit() || ",.-".contains(one));
    if is_step {
        return Err(format!(
            "a task is selected with --task, steps with --from and --to; a file of this name is ./{text}"
        ));
    }
    Ok(text.into())
}

impl Command for Get {
    type Family = Toyo;
    type Report = Got;
    const ID: &'static str = "toyo.program.get";

    fn risk(&self) -> Risk {
        if self.task.is_some() { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Got> {
        let Context { robot, link, screen, several, .. } = context;
        if let Some(to) = self.to.filter(|to| *to < self.from) {
            return Err(Failure::usage(format!("--to {to} is before --from {}", self.from))
                .hint("type the lower step with --from"));
        }
        if let Some(file) = self.file.as_ref().filter(|_| several) {
            return Err(Failure::usage(format!("{} needs one robot", file.display()))
                .hint("run the command once for each robot, or `toyo backup` for all robots"));
        }
        let target = self.file.clone().map(|file| Target::new(file, self.force)).transpose()?;
        if link.is_dry_run() {
            return self.dry_run(link).await;
        }
        let outcome = self.read(link, screen).await;
        let (task, room, answers) = task_selection::restore_task(link, outcome).await?;
        let unread = unread(&answers);
        let read: Vec<Record> = answers.iter().map(|answer| answer.clone().unwrap_or_else(|_| not_read())).collect();
        let rows = if self.explain { rows(link, &read).await? } else { Rows::new() };
        let last = usize::from(self.from) + read.len() - 1;
        let is_whole = self.from == 1 && last == usize::from(room);
        let style = Style { first: self.from.into(), is_whole, is_numbered: self.numbers };
        let source = link.sources.get(task).filter(|_| is_whole && unread.is_empty() && !self.changes_text());
        let differences = source.as_ref().map_or(0, |source| source.differences(&read));
        let (text, is_source) = match source {
            Some(source) if differences == 0 => (source.text, true),
            source => {
                if let Some(source) = source {
                    screen.note(&other_program(&source, differences));
                }
                (listing_named(&read, &unread, style, &rows, names::of_robot(robot, screen)).text, false)
            }
        };
        let is_written = target.is_some() && unread.is_empty();
        let written = match &target {
            Some(target) if is_written => {
                let mut draft = target.begin()?;
                draft.write(text.as_bytes())?;
                draft.commit()
            }
            // A program file must be complete. An incomplete program must not replace it.
            Some(_) => Err(Failure::new(Kind::ConditionNotMet, NOT_WRITTEN)),
            None => Ok(()),
        };
        let file = FileItem::new(format!("program-{task}"), Plain {}, written).with_content(Hash::of(text.as_bytes()));
        let file = target.iter().fold(file, |file, target| file.with_path(target.path()));
        let shown = if is_whole { program::used(&read) } else { read.len() };
        let step = |(step, answer): (u16, Result<Record>)| {
            let outcome = answer.map(|record| Instruction::of(&record));
            ReadStep { step, outcome: ItemOutcome::new(format!("step {step}"), outcome) }
        };
        Ok(Got {
            task,
            room_steps: room,
            first_step: self.from,
            last_step: last,
            used_steps: program::used(&read),
            tags: program::tags(&read, self.from.into()).into_iter().map(|(tag, step)| Tag { tag, step }).collect(),
            steps: (self.from..).zip(answers).take(shown).map(step).collect(),
            is_source,
            text: (!is_written).then_some(text),
            files: [file],
            read_steps: read.len(),
        })
    }
}

impl Get {
    /// Whether the options require a text other than the stored source text.
    fn changes_text(&self) -> bool {
        self.plain || self.numbers || self.explain
    }

    /// Returns a command that reads all steps of this task, or of the current task.
    pub fn whole(task: Option<u8>) -> Self {
        Self {
            file: None,
            task,
            from: 1,
            to: None,
            until_end: false,
            numbers: false,
            explain: false,
            plain: false,
            force: false,
        }
    }

    /// Reads the steps. Returns their task, the number of steps of this task, and each step.
    pub async fn read(&self, link: &mut Link, screen: &Screen) -> Result<(u8, u16, Answers)> {
        let task = task_selection::select_task(link, self.task).await?;
        let room = steps::room(link, task, self.to.unwrap_or(self.from)).await?;
        let is_end = |record: &Record| self.until_end && record.layout() == Op::End.row().layout;
        let read = steps::read_each(link, screen, self.from..=self.to.unwrap_or(room), is_end).await?;
        Ok((task, room, read))
    }

    /// Records the requests in a dry run.
    pub async fn dry_run(&self, link: &mut Link) -> Result<Got> {
        task_selection::select_task(link, self.task).await?;
        link.plan(&steps::rooms_request(), "number of steps of the task");
        link.plan(&steps::read_request(self.from), "the first step");
        link.then("the later steps are read in order");
        Err(unknown())
    }
}

/// Note: the program differs from the text that was last written.
fn other_program(source: &Source, differences: usize) -> String {
    let Source { file, put_at, .. } = source;
    let steps = if differences == 1 { "1 step differs".to_owned() } else { format!("{differences} steps differ") };
    format!(
        "note: the program differs from the text of {}, written on {put_at}: {steps}. The output shows the steps of \
         the controller, without labels and comments",
        escape::line(file)
    )
}

/// Reason why no file was written.
const NOT_WRITTEN: &str = "was not written, because the program is incomplete";

/// Reasons why steps were not read.
fn unread(answers: &Answers) -> Unread {
    let why = |failure: &Failure| match failure.kind {
        // Steps that were not requested have one common reason.
        Kind::NoAnswer => "no answer".to_owned(),
        _ => escape::line(&failure.message).into_owned(),
    };
    let failed = answers.iter().enumerate().filter_map(|(index, answer)| Some((index, answer.as_ref().err()?)));
    failed.map(|(index, failure)| (index, why(failure))).collect()
}

/// Table rows that the steps use. Rows that the controller refuses are omitted.
async fn rows(link: &mut Link, steps: &[Record]) -> Result<Rows> {
    let mut rows = Rows::new();
    for (id, row) in program::uses(steps) {
        let parameter =
            Parameter::named(id).ok_or_else(|| Failure::local(format!("internal error: unknown table {id}")))?;
        let request = Request::read_parameter(parameter, Some(row)).map_err(|error| misuse(&error.into()))?;
        rows.extend(link.try_ask(&request).await?.ok().map(|content| ((id, row), content)));
    }
    Ok(rows)
}

/// Report of the program of a task, or of a part of it.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Got {
    task: u8,
    /// Number of steps of the task.
    room_steps: u16,
    /// Number of the first step that was read.
    first_step: u16,
    /// Number of the last step that was read.
    last_step: usize,
    /// Number of steps up to the last step that is not a NOP, or that was not read.
    used_steps: usize,
    /// Tags of the program, with their steps.
    tags: Vec<Tag>,
    /// Each step. The NOPs at the end of the task are omitted.
    steps: Vec<ReadStep>,
    /// Whether the text is the stored source text, with its labels and comments.
    is_source: bool,
    /// Text of the file, with `?` for steps that were not read; null if the text was written to a file.
    text: Option<String>,
    /// Text, and the file that was written. If a step was not read, no file is written.
    files: [FileItem<Plain>; 1],
    #[serde(skip)]
    read_steps: usize,
}

/// A tag and its step.
#[derive(Debug, Serialize, JsonSchema)]
struct Tag {
    tag: i32,
    step: usize,
}

/// A step, or why it was not read.
#[derive(Debug, Serialize, JsonSchema)]
struct ReadStep {
    /// Number of the step, starting with 1.
    step: u16,
    #[serde(flatten)]
    outcome: ItemOutcome<Instruction>,
}

/// A step.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Step {
    /// From 1.
    step: usize,
    #[serde(flatten)]
    content: Instruction,
}

/// Content of a step.
#[derive(Debug, Serialize, JsonSchema)]
struct Instruction {
    /// Instruction in the controller.
    instruction: String,
    /// Whether the manual lists the instruction. Other instructions cannot be written.
    in_manual: bool,
}

impl Instruction {
    fn of(record: &Record) -> Self {
        Self { instruction: record.written(), in_manual: record.is_listed() }
    }
}

impl Step {
    /// Creates a step from a record that was read.
    pub fn of(step: usize, record: &Record) -> Self {
        Self { step, content: Instruction::of(record) }
    }

    /// Number and instruction: `0003  MOVP`.
    pub fn line(&self) -> String {
        format!("{:04}  {}", self.step, self.content.instruction)
    }
}

impl Report for Got {
    const ROWS: RowsOf = RowsOf::List("steps");

    fn view(&self) -> View {
        if let Some(text) = &self.text {
            return View::text(text.clone());
        }
        View::fields([
            ("file", Cell::optional(self.files[0].path.as_deref())),
            ("task", self.task.into()),
            ("steps read", format!("{} to {}", self.first_step, self.last_step).into()),
            ("used steps", self.used_steps.into()),
        ])
    }

    fn failure(&self) -> Option<Failure> {
        let failure = verdict(self.read_steps, self.steps.iter().filter_map(|step| step.outcome.error()))?;
        let [FileItem { error: Some(_), path: Some(file), .. }] = &self.files else { return Some(failure) };
        let message = format!("{}; {file} {NOT_WRITTEN}", failure.message);
        Some(Failure { message, ..failure })
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault, blocks};
    use armctl_frame::failure::Kind;

    /// Returns a controller with this fault at step 2 of three steps.
    fn with_step_2(fault: Fault) -> Bench {
        let state = "steps = { 1 = [\"SPD V=05\", \"NOP\", \"END\"] }";
        Bench::with_faults(state, move |block, _| if block == "@RSTX 0002" { fault } else { Fault::None }).0
    }

    #[test]
    fn refused_step_prevents_the_program_but_not_other_steps() {
        let mut bench = with_step_2(Fault::Answered("@NG"));
        let (got, failure) = bench.run(&["program", "get"]).unwrap();
        let failure = failure.unwrap();
        let why = "the controller refused RSTX 0002 (@NG): the status shows no reason";
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Mixed, Some("NG")));
        assert_eq!(failure.message, format!("1 of 2000 failed: step 2: {why}"));
        let steps = got["steps"].as_array().unwrap();
        assert_eq!(
            steps[0],
            serde_json::json!({ "ok": true, "step": 1, "instruction": "SPD V=05", "in_manual": true })
        );
        assert_eq!((&steps[1]["ok"], &steps[1]["step"]), (&false.into(), &2.into()), "{got}");
        assert_eq!((&steps[1]["error"]["code"], &steps[2]["instruction"]), (&"NG".into(), &"END".into()), "{got}");
        let text = format!(
            "# INCOMPLETE: 1 of 2000 steps were not read\nSPD V=05\n?  # step 2 was not read: {why}\nEND\n# 1997 NOP \
             at the end of the program are omitted\n"
        );
        assert_eq!(got["text"], text);
        // `program put` does not accept the text as a program.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("partial.txt");
        std::fs::write(&path, text).unwrap();
        let failure = bench.run(&["program", "put", path.to_str().unwrap()]).unwrap_err();
        assert_eq!(failure.kind, Kind::Usage);
        assert!(failure.message.contains(":3:1: this step was not read from the controller"), "{failure}");
    }

    #[test]
    fn a_program_with_a_gap_replaces_no_file() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), "whole").unwrap();
        let path = file.path().to_str().unwrap();
        let words = ["program", "get", path, "--force"];
        let (got, failure) = with_step_2(Fault::Answered("@NG")).run(&words).unwrap();
        assert!(got["files"][0]["ok"] == false && got["text"].as_str().unwrap().contains("\n?  # step 2"), "{got}");
        let failure = failure.unwrap();
        assert!(failure.message.ends_with("was not written, because the program is incomplete"), "{failure}");
        assert_eq!(std::fs::read_to_string(path).unwrap(), "whole");
        let (got, _) = with_step_2(Fault::Lost).run(&["program", "get", "--to", "9"]).unwrap();
        assert_eq!(
            got["text"],
            "# INCOMPLETE: 8 of 9 steps were not read\nSPD V=05\n?  # steps 2 to 9 were not read: no answer\n"
        );
        assert_eq!(got["steps"].as_array().unwrap().len(), 9);
        let failure = with_step_2(Fault::Answered("@NG")).run(&["program", "get", "--from", "2", "--to", "2"]);
        assert_eq!(failure.unwrap_err().kind, Kind::Refused, "nothing was answered");
    }

    #[test]
    fn keeps_an_existing_program_file() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let failure = blocks(&["program", "get", file.path().to_str().unwrap()]).unwrap_err();
        assert_eq!(failure.kind.exit(), 1);
    }
}

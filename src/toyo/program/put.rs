//! `toyo program put`.

use std::ops::RangeInclusive;

use super::and_mode;
use super::check::Labelled;
use super::text;
use crate::eeprom::{Cells, STORED_VALUE};
use crate::files;
use crate::prelude::*;
use armctl_controller::names::Names;
use armctl_controller::toyo::program::{self, MAX_STEPS, Part, Program, check_named};
use armctl_frame::backup::manifest::Hash;
use armctl_frame::interrupt::interruptible;
use armctl_frame::robot::file::{FILES, FileItem};
use armctl_frame::robot::item::Plain;

/// Write a program from a text file to the controller.
#[derive(Debug, Args)]
#[command(after_help = and_mode(HELP))]
pub struct Put {
    /// File from `program get` or an editor; - means stdin
    file: PathBuf,
    /// Task, 1 to 4 [default: the current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
    /// Write the file as a part of a program, from this step on. Other steps do not change
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u16).range(1..=5000))]
    at: Option<u16>,
    /// Keep the steps after the last step of the file
    #[arg(long, conflicts_with = "at")]
    keep_rest: bool,
    /// Continue an interrupted put. With a step number, do not compare the steps before this step
    #[arg(long, value_name = "STEP", num_args = 0..=1, require_equals = true, default_missing_value = "1",
          value_parser = clap::value_parser!(u16).range(1..=5000))]
    resume: Option<u16>,
    /// Read every step of the task, even if armctl wrote the previous program with NOPs after it
    #[arg(long, conflicts_with_all = ["at", "keep_rest"])]
    read_all: bool,
    /// Program that the controller must still have before the write.
    #[arg(skip)]
    expected: Option<Vec<Record>>,
}

const HELP: &str = "armctl checks the whole file before it sends anything. The file is the whole program of the task: \
                    later steps of the task become NOP, so that no tag of an older program exists twice. With --at, \
                    the file is only a part of the program, and the other steps stay.\n\narmctl reads the steps of \
                    the file and the later steps, and writes only different steps. If the controller has the program \
                    that armctl wrote last, the later steps are NOP. armctl then does not read the later steps, \
                    unless the new program has other tags or continues after its last step. With --read-all, armctl \
                    always reads the later steps. This computer stores the text, so that `program get` shows labels \
                    and comments again.\n\nNames of points, counters and timers (robots.toml) can replace their \
                    numbers: PT=pick.";

/// A step to write.
struct Edit {
    step: u16,
    instruction: Record,
    /// Instruction that the step has now.
    found: Record,
}

impl Command for Put {
    type Family = Toyo;
    type Report = Stored;
    const ID: &'static str = "toyo.program.put";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let name = self.name();
        let bytes = files::read(&self.file)?;
        let names = names::of_robot(robot, screen);
        // The tags around a part are only known later.
        let around = self.at.map(|at| part(at, None));
        let room = MAX_STEPS + 1 - usize::from(self.at.unwrap_or(1));
        let program = text::program(&name, check_named(&bytes, room, around.as_ref(), names), screen)?;
        let first = self.at.unwrap_or(1);
        let last = last_of(first, &program);
        let from = self.resume.unwrap_or(first).max(first);
        if from > last {
            return Err(Failure::usage(format!("--resume={from} is after step {last}, the last step of the file"))
                .hint("remove --resume to write the whole file"));
        }
        if link.is_dry_run() {
            return self.dry_run(link, &program, from).await;
        }
        let outcome = self.store((link, screen, &confirmer), (&bytes, names), &program, from..=last).await;
        task_selection::restore_task(link, outcome).await
    }
}

impl Put {
    /// Creates a `put` for an edited program, which replaces the program that was read.
    pub fn edited(file: PathBuf, task: Option<u8>, expected: Vec<Record>) -> Self {
        Self { file, task, at: None, keep_rest: false, resume: None, read_all: true, expected: Some(expected) }
    }

    /// Returns the name of the text for messages.
    fn name(&self) -> String {
        if self.expected.is_some() { "edited".to_owned() } else { files::display_path(&self.file) }
    }

    async fn store(
        &self,
        (link, screen, confirmer): (&mut Link, &Screen, &Confirmer<'_>),
        (bytes, names): (&[u8], &Names),
        program: &Program,
        steps: RangeInclusive<u16>,
    ) -> Result<Stored> {
        let name = self.name();
        let first = self.at.unwrap_or(1);
        let (from, last) = (*steps.start(), *steps.end());
        let task = task_selection::select_task(link, self.task).await?;
        let room = steps::room(link, task, last).await?;
        let program = match self.at {
            None => {
                let checked = check_named(bytes, room.into(), None, names);
                text::program(&name, checked, &screen.silenced())?
            }
            // A part that uses no tags does not depend on the tags around it.
            Some(_) if !names_tags(program) => program.clone(),
            Some(at) => {
                let tags = tags_around(link, screen, first, last, room).await?;
                let checked = check_named(bytes, usize::from(room - at) + 1, Some(&part(at, Some(tags))), names);
                text::program(&name, checked, &screen.silenced())?
            }
        };
        let end = if self.at.is_some() || self.keep_rest { last } else { room };
        let found = self.found((link, screen), task, &program, (from, last, end)).await?;
        let end = from.saturating_add(u16::try_from(found.len()).unwrap_or(u16::MAX)).saturating_sub(1).max(last);
        if self.expected.as_ref().is_some_and(|expected| *expected != found) {
            return Err(Failure::new(Kind::Rejected, "another client changed the program on the controller")
                .hint("edit the new program again"));
        }
        let wanted = program.steps.iter().map(|step| step.record.clone()).chain(std::iter::repeat_with(steps::nop));
        let wanted = (first..=end).zip(wanted).skip_while(|(step, _)| *step < from);
        let changes: Vec<Edit> = wanted
            .zip(&found)
            .filter(|((_, wanted), found)| wanted != *found)
            .map(|((step, instruction), found)| Edit { step, instruction, found: found.clone() })
            .collect();
        confirmer.confirm(&replacing(&changes, task)).await?;
        let mut cells = Cells::default();
        if !changes.is_empty() {
            steps::open(link).await?;
            let mut progress = screen.items_progress("writing steps", changes.len() as u64);
            // The caller also waits for Ctrl-C, but polls this work first. The work therefore ends here, so that the
            // failure can state the number of written steps.
            let outcome = interruptible(async {
                for Edit { step, instruction, .. } in &changes {
                    link.overwrite(screen, &steps::cell(*step, instruction)?, &mut cells).await?;
                    progress.advance(1);
                }
                Ok(())
            })
            .await
            .and_then(|outcome| outcome);
            drop(progress);
            let done = usize::try_from(cells.cells_written).unwrap_or(usize::MAX);
            if let (Err(failure), Some(change)) = (outcome, changes.get(done)) {
                return Err(account(failure, &name, first, change.step, changes.len() - done));
            }
        }
        let cleared = changes.iter().filter(|change| change.step > last).count();
        if self.at.is_none() && !self.keep_rest && from == 1 {
            self.keep(link, screen, (task, room), bytes, &program);
        }
        cells.cells_unchanged = u32::try_from(found.len() - changes.len()).unwrap_or(u32::MAX);
        let path = (self.expected.is_none() && self.file != Path::new("-")).then(|| name.clone());
        let file = FileItem::new(format!("program-{task}"), Plain {}, Ok(())).with_content(Hash::of(bytes));
        Ok(Stored {
            files: [FileItem { path, ..file }],
            shown: name,
            task,
            first_step: first,
            last_step: last,
            cleared_steps: cleared,
            unread_steps: if self.at.is_some() || self.keep_rest { 0 } else { usize::from(room - end) },
            labels: Labelled::of(&program),
            cells,
        })
    }

    /// Reads the current steps, from the first step that is compared. If the controller still has the program that was
    /// last written, followed only by NOPs, the later steps are not read. The first later step is read, because someone
    /// may have extended the program there on the pendant.
    async fn found(
        &self,
        (link, screen): (&mut Link, &Screen),
        task: u8,
        program: &Program,
        (from, last, end): (u16, u16, u16),
    ) -> Result<Vec<Record>> {
        let whole = from == 1 && end > last && !self.read_all;
        let steps = records(program);
        let source = link.sources.get(task).filter(|source| whole && source.has_all_steps(&steps, end));
        let known = source.and_then(|source| Some((u16::try_from(source.len()).ok()?.max(last) + 1, source)));
        let Some((known, source)) = known.filter(|(known, _)| *known < end) else {
            return steps::read_all(link, screen, from..=end).await;
        };
        let mut found = steps::read_all(link, screen, from..=known).await?;
        if !source.is(&found) {
            found.extend(steps::read_all(link, screen, known + 1..=end).await?);
        }
        Ok(found)
    }

    /// Saves the text for a later `program get`.
    fn keep(&self, link: &mut Link, screen: &Screen, (task, room): (u8, u16), bytes: &[u8], program: &Program) {
        let Ok(text) = std::str::from_utf8(bytes) else { return };
        let steps = records(program);
        link.sources.mark_certain();
        if let Err(error) = link.sources.keep(task, (&self.name(), text), &steps, room) {
            screen.detail(1, &format!("the text of the program was not saved: {error}"));
        }
    }

    async fn dry_run(&self, link: &mut Link, program: &Program, from: u16) -> Result<Stored> {
        let first = self.at.unwrap_or(1);
        let last = last_of(first, program);
        task_selection::select_task(link, self.task).await?;
        link.plan(&steps::rooms_request(), "number of steps of the task");
        if let Some(at) = self.at.filter(|_| names_tags(program)) {
            let around = (1..at).chain(last.saturating_add(1)..=5000).next();
            if let Some(step) = around {
                link.plan(&steps::read_request(step), "and so on: the tags of the other steps");
            }
        }
        let wanted = (first..).zip(&program.steps).filter(|(step, _)| *step >= from);
        let cells = wanted.map(|(step, wanted)| steps::cell(step, &wanted.record)).collect::<Result<Vec<_>, _>>()?;
        for cell in &cells {
            link.plan(&cell.read, STORED_VALUE);
        }
        let clears = self.at.is_none() && !self.keep_rest && usize::from(last) < MAX_STEPS;
        if clears {
            link.plan(&steps::read_request(last + 1), "and so on to the last step of the task");
        }
        steps::plan_open(link).await?;
        for cell in &cells {
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
        }
        if clears {
            let cell = steps::cell(last + 1, &steps::nop())?;
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
            link.then("steps after the last step of the file become NOP, to the end of the task");
        }
        link.put_back().await?;
        Err(unknown())
    }
}

/// Builds the change that the user must confirm.
fn replacing(edits: &[Edit], task: u8) -> Change {
    let lost = edits.iter().filter(|edit| edit.found != steps::nop());
    let lost: Vec<[String; 3]> = lost
        .map(|Edit { step, instruction, found }| [format!("step {step}"), found.written(), instruction.written()])
        .collect();
    steps::overwriting(task, &lost)
}

/// Whether a step of the program defines or uses a tag.
fn names_tags(program: &Program) -> bool {
    let is_tag = |name: &str| matches!(name, "tag" | "then" | "else");
    program.steps.iter().any(|step| step.record.pairs().any(|(field, _)| is_tag(field.name)))
}

fn records(program: &Program) -> Vec<Record> {
    program.steps.iter().map(|step| step.record.clone()).collect()
}

fn last_of(first: u16, program: &Program) -> u16 {
    u16::try_from(program.steps.len() - 1).unwrap_or(u16::MAX).saturating_add(first)
}

fn part(at: u16, tags: Option<BTreeSet<i32>>) -> Part {
    Part { first: at.into(), tags }
}

/// Reads the tags of the steps before and after a part.
async fn tags_around(link: &mut Link, screen: &Screen, first: u16, last: u16, room: u16) -> Result<BTreeSet<i32>> {
    let mut around = steps::read_all(link, screen, 1..=first - 1).await?;
    around.extend(steps::read_all(link, screen, last + 1..=room).await?);
    Ok(program::tags(&around, 1).into_keys().collect())
}

/// Failure of the write at a step. It states which steps were written, and has a hint how to continue.
fn account(failure: Failure, name: &str, first: u16, next: u16, left: usize) -> Failure {
    let rest = if left == 1 { "1 step is".to_owned() } else { format!("{left} steps are") };
    let state = match next - first {
        0 => format!("it is not known whether a step of {name} was written; {rest} still to be written"),
        1 => format!("step {first} equals {name}; {rest} still to be written"),
        _ => format!("steps {first} to {} equal {name}; {rest} still to be written", next - 1),
    };
    let again =
        format!("use --resume={next} to continue at that step; without --resume, armctl compares all steps again");
    let hint = failure.hint.as_ref().map_or(again.clone(), |hint| format!("{hint}; then {again}"));
    Failure { message: format!("{}; {state}", failure.message.trim_end_matches('.')), ..failure }.hint(hint)
}

/// Report of a program that was written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stored {
    /// The program file.
    files: [FileItem<Plain>; 1],
    #[serde(skip)]
    shown: String,
    task: u8,
    first_step: u16,
    /// Number of the last step of the file.
    last_step: u16,
    /// Number of later steps that became NOP.
    cleared_steps: usize,
    /// Number of later steps that were not read, because armctl wrote the previous program and NOPs after it.
    unread_steps: usize,
    /// Labels with their tags.
    labels: Vec<Labelled>,
    #[serde(flatten)]
    cells: Cells,
}

impl Report for Stored {
    fn view(&self) -> View {
        let Self { shown, task, first_step, last_step, cleared_steps, unread_steps, labels, cells, .. } = self;
        let mut fields = vec![
            ("file", shown.as_str().into()),
            ("task", (*task).into()),
            ("steps", format!("{first_step} to {last_step}").into()),
            ("cleared behind", (*cleared_steps).into()),
            ("result", cells.in_words().into()),
        ];
        if *unread_steps > 0 {
            fields.push(("not read", format!("{unread_steps} later steps, NOP since the last put").into()));
        }
        fields.extend(labels.iter().map(|label| ("label", label.in_a_line().into())));
        View { sections: vec![Section::Fields(fields)] }
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

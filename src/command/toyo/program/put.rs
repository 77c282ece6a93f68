//! `toyo program put`.

use std::collections::BTreeSet;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::and_mode;
use super::check::Labelled;
use super::steps;
use super::text;
use crate::command::backup::manifest::Hash;
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::unknown;
use crate::command::frame::interrupt::interruptible;
use crate::command::frame::names;
use crate::command::robot::file::{FILES, FileItem};
use crate::command::robot::item::Plain;
use crate::command::toyo::eeprom::{Cells, THERE};
use crate::command::toyo::link::Link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::stores::{Replaced, overwriting};
use crate::command::toyo::{files, tasks};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::names::Names;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::program::{self, MOST_STEPS, Part, Program, check_named};
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation};
use crate::output::Screen;
use crate::output::csv::RowsOf;
use crate::output::view::{Section, View};

/// Writes a program from a text file.
#[derive(Debug, Args)]
#[command(after_help = and_mode(HELP))]
pub struct Put {
    /// What `program get` wrote, or somebody with an editor; - is stdin
    file: PathBuf,
    /// Task, 1 to 4, instead of the current one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
    /// Write a part of a program, with this as its first step; the other steps stay
    #[arg(long, value_name = "STEP", value_parser = clap::value_parser!(u16).range(1..=5000))]
    at: Option<u16>,
    /// Leave the steps behind the last one of the file as they are
    #[arg(long, conflicts_with = "at")]
    keep_rest: bool,
    /// Go on with a put that was cut off; with a step, those before it are not even compared
    #[arg(long, value_name = "STEP", num_args = 0..=1, require_equals = true, default_missing_value = "1",
          value_parser = clap::value_parser!(u16).range(1..=5000))]
    resume: Option<u16>,
    /// Read every step of the task, also where armctl wrote the program and left NOP behind it
    #[arg(long, conflicts_with_all = ["at", "keep_rest"])]
    read_all: bool,
    /// What the controller has to hold for it to be written.
    #[arg(skip)]
    expected: Option<Vec<Record>>,
}

const HELP: &str = "The whole file is checked before anything is sent. It is the program of the task: steps behind its \
                    last one become NOP, as a tag in what is left of an older program would be there twice. With --at \
                    it is a part of the program, and the other steps stay.\n\nThe steps of the file are read, and \
                    those behind it; only what differs is written. Where the controller holds the program that armctl \
                    put there last, the steps behind it are known to be NOP and are not read, unless the new one has \
                    other tags or runs on behind its last step; --read-all reads them. \
                    The text is kept on this machine, so that `program get` shows labels and comments again.\n\nNames \
                    of points, counters and timers (robots.toml) stand for their numbers: PT=pick.";

/// A step that is to be written.
struct Edit {
    step: u16,
    instruction: Record,
    /// What is there.
    found: Record,
}

impl Command for Put {
    type Family = Toyo;
    type Report = Stored;
    const ID: &'static str = "toyo.program.put";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored, Failure> {
        let Context { robot, link, screen, authority, .. } = context;
        let name = self.name();
        let bytes = files::read(&self.file)?;
        let names = names::of(robot, screen);
        // Which tags are around a part is known later.
        let around = self.at.map(|at| part(at, None));
        let room = MOST_STEPS + 1 - usize::from(self.at.unwrap_or(1));
        let program = text::program(&name, check_named(&bytes, room, around.as_ref(), names), screen)?;
        let first = self.at.unwrap_or(1);
        let last = last_of(first, &program);
        let from = self.resume.unwrap_or(first).max(first);
        if from > last {
            return Err(Failure::usage(format!("--resume={from} is behind step {last}, the last one of the file"))
                .hint("leave --resume away to write the whole file"));
        }
        if link.is_dry() {
            return self.dry_run(link, &program, from).await;
        }
        let outcome = self.store((link, screen, &authority), (&bytes, names), &program, from..=last).await;
        tasks::done(link, outcome).await
    }
}

impl Put {
    /// A program that was edited, in the place of what it was.
    pub fn edited(file: PathBuf, task: Option<u8>, expected: Vec<Record>) -> Self {
        Self { file, task, at: None, keep_rest: false, resume: None, read_all: true, expected: Some(expected) }
    }

    /// What the text is called in messages.
    fn name(&self) -> String {
        if self.expected.is_some() { "edited".to_owned() } else { files::shown(&self.file) }
    }

    async fn store(
        &self,
        (link, screen, authority): (&mut Link, &Screen, &Authority<'_>),
        (bytes, names): (&[u8], &Names),
        program: &Program,
        steps: RangeInclusive<u16>,
    ) -> Result<Stored, Failure> {
        let name = self.name();
        let first = self.at.unwrap_or(1);
        let (from, last) = (*steps.start(), *steps.end());
        let task = tasks::choose(link, self.task).await?;
        let room = steps::room(link, task, last).await?;
        let program = match self.at {
            None => {
                let checked = check_named(bytes, room.into(), None, names);
                text::program(&name, checked, &screen.silenced())?
            }
            // Without a tag, those around it do not matter.
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
            return Err(Failure::new(Kind::Rejected, "the program was changed on the controller meanwhile")
                .hint("edit it again, and put both together"));
        }
        let wanted = program.steps.iter().map(|step| step.record.clone()).chain(std::iter::repeat_with(steps::nop));
        let wanted = (first..=end).zip(wanted).skip_while(|(step, _)| *step < from);
        let changes: Vec<Edit> = wanted
            .zip(&found)
            .filter(|((_, wanted), found)| wanted != *found)
            .map(|((step, instruction), found)| Edit { step, instruction, found: found.clone() })
            .collect();
        authority.confirm(&replacing(&changes, task)).await?;
        let mut cells = Cells::default();
        if !changes.is_empty() {
            steps::open(link).await?;
            let mut progress = screen.items_progress("writing steps", changes.len() as u64);
            // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with the account.
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
        let file = FileItem::new(format!("program-{task}"), Plain {}, Ok(())).holding(Hash::of(bytes));
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

    /// The steps that are there, from the first that is compared on. Those behind the program are left out where the
    /// controller holds what was put there last, and nothing but NOP was behind it: all but the first, where a program goes
    /// on that was made longer on the pendant.
    async fn found(
        &self,
        (link, screen): (&mut Link, &Screen),
        task: u8,
        program: &Program,
        (from, last, end): (u16, u16, u16),
    ) -> Result<Vec<Record>, Failure> {
        let whole = from == 1 && end > last && !self.read_all;
        let steps = records(program);
        let source = link.sources.get(task).filter(|source| whole && source.knows_rest(&steps, end));
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

    /// Keeps the text, for a `get` to come.
    fn keep(&self, link: &mut Link, screen: &Screen, (task, room): (u8, u16), bytes: &[u8], program: &Program) {
        let Ok(text) = std::str::from_utf8(bytes) else { return };
        let steps = records(program);
        link.sources.trust();
        if let Err(error) = link.sources.keep(task, (&self.name(), text), &steps, room) {
            screen.detail(1, &format!("the text of the program was not kept: {error}"));
        }
    }

    async fn dry_run(&self, link: &mut Link, program: &Program, from: u16) -> Result<Stored, Failure> {
        let first = self.at.unwrap_or(1);
        let last = last_of(first, program);
        tasks::choose(link, self.task).await?;
        link.plan(&steps::rooms_request(), "whether there is room");
        if let Some(at) = self.at.filter(|_| names_tags(program)) {
            let around = (1..at).chain(last.saturating_add(1)..=5000).next();
            if let Some(step) = around {
                link.plan(&steps::read_request(step), "and so on, the steps around: their tags");
            }
        }
        let wanted = (first..).zip(&program.steps).filter(|(step, _)| *step >= from);
        let cells = wanted.map(|(step, wanted)| steps::cell(step, &wanted.record)).collect::<Result<Vec<_>, _>>()?;
        for cell in &cells {
            link.plan(&cell.read, THERE);
        }
        let clears = self.at.is_none() && !self.keep_rest && usize::from(last) < MOST_STEPS;
        if clears {
            link.plan(&steps::read_request(last + 1), "and so on to the end of the task");
        }
        steps::plan_open(link).await?;
        for cell in &cells {
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
        }
        if clears {
            let cell = steps::cell(last + 1, &steps::nop())?;
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
            link.then("what is behind the last step of the file and no NOP becomes one, to the end of the task");
        }
        link.put_back().await?;
        Err(unknown())
    }
}

/// What is replaced, for a person to confirm.
fn replacing(edits: &[Edit], task: u8) -> Change {
    let lost = edits.iter().filter(|edit| edit.found != steps::nop());
    let lost: Vec<Replaced> = lost
        .map(|Edit { step, instruction, found }| [format!("step {step}"), found.written(), instruction.written()])
        .collect();
    overwriting(["a step", "steps"], &lost, &format!(" of task {task}"))
}

/// Whether a step defines a tag or names one.
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

/// The tags of the steps before and behind a part.
async fn tags_around(
    link: &mut Link,
    screen: &Screen,
    first: u16,
    last: u16,
    room: u16,
) -> Result<BTreeSet<i32>, Failure> {
    let mut around = steps::read_all(link, screen, 1..=first - 1).await?;
    around.extend(steps::read_all(link, screen, last + 1..=room).await?);
    Ok(program::tags(&around, 1).into_keys().collect())
}

/// The failure that ended the writing at a step, with what is as in the file and how to go on.
fn account(failure: Failure, name: &str, first: u16, next: u16, left: usize) -> Failure {
    let rest = if left == 1 { "1 step is".to_owned() } else { format!("{left} steps are") };
    let state = match next - first {
        0 => format!("no step is known to be as in {name}, {rest} still to be written"),
        1 => format!("step {first} is as in {name}; {rest} still to be written"),
        _ => format!("steps {first} to {} are as in {name}; {rest} still to be written", next - 1),
    };
    let again = format!("--resume={next} goes on there; without it, all is compared again and what differs is written");
    let hint = failure.hint.as_ref().map_or(again.clone(), |hint| format!("{hint}; then {again}"));
    Failure { message: format!("{}; {state}", failure.message.trim_end_matches('.')), ..failure }.hint(hint)
}

/// A program that is on the controller now.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stored {
    /// The file with the program.
    files: [FileItem<Plain>; 1],
    #[serde(skip)]
    shown: String,
    task: u8,
    first_step: u16,
    /// The last step of the file.
    last_step: u16,
    /// Steps behind it that became NOP.
    cleared_steps: usize,
    /// Steps behind those that were not read: armctl put the program that was there, and left NOP behind it.
    unread_steps: usize,
    /// Labels with the tags they stand for.
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
            fields.push(("not read", format!("{unread_steps} steps behind, NOP since the last put").into()));
        }
        fields.extend(labels.iter().map(|label| ("label", label.in_a_line().into())));
        View { sections: vec![Section::Fields(fields)] }
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

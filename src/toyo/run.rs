//! `toyo run`: start of programs, and moves to a point.

use std::marker::PhantomData;

use super::number_arguments::saturated_byte;
use super::numbered_programs::NumberedProgram;
use super::point::{parse_point, table as point_table};
use super::position::{Coordinates, UNIT, titled};
use super::wait::{AcceptedWork, End, Work, step};
use super::{easy, palletizing};
use crate::prelude::*;
use armctl_controller::toyo::status::RunMode;
use armctl_frame::gate::data_changed;
use armctl_frame::repeated_runs::{Repeat, Runs};
use armctl_frame::robot::motion::Motion;
use armctl_frame::robot::position::Position;
use armctl_frame::robot::program::{self as robot, ProgramState};
use armctl_frame::wait_arguments::{MotionEnd, ProgramEnd};

commands! {
    /// Commands that start programs and moves.
    pub enum Run {
        /// Start the sequential program
        Sequential(Sequential),
        /// Start palletizing
        Palletizing(Numbered<palletizing::Numbered>),
        /// Start the easy program
        Easy(Numbered<easy::Numbered>),
        /// Move to a row of the coordinate table
        Point(Point),
    }
}

/// Start the sequential program (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = "Without STEP the program continues at the current step: the step of the last stop, or the \
                        first step after `toyo reset`. The command does not change mode, servo power or origin; `toyo \
                        status` shows them.")]
pub struct Sequential {
    /// Step to start with [default: the current step]
    #[arg(value_name = "STEP", value_parser = clap::value_parser!(i32).range(1..=5000))]
    step: Option<i32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

impl Command for Sequential {
    type Family = Toyo;
    type Report = RunReport;
    const ID: &'static str = "toyo.run.sequential";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        match self.step {
            Some(step) => format!("run the sequential program from step {step}{}", self.repeat.describe()),
            None => "run the sequential program from its current step".to_owned(),
        }
    }

    async fn run(&self, mut context: Context<'_, Toyo>) -> Result<RunReport> {
        if self.repeat.repeat.is_some() && self.step.is_none() {
            return Err(Failure::usage("--repeat needs the first step of each run")
                .hint("type the step, for example `toyo run sequential 1 --repeat 20`; nothing was started"));
        }
        confirm_start(&mut context, Change::new(self.intent()), Program::Sequential(self.step)).await?;
        let start = Request::of(table::Command::Spst, [Value::Number(self.step.unwrap_or(0))]);
        Ok(start_and_wait(context, &start, self.end.limit(), self.repeat).await?.of("sequential", None))
    }
}

/// Start palletizing or the easy program, or continue after a stop (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = K::RUN_HELP)]
pub struct Numbered<K: NumberedProgram> {
    /// Program to select first [default: the current program]
    #[arg(value_name = "NUMBER", value_parser = clap::value_parser!(i32).range(1..=K::COUNT))]
    number: Option<i32>,
    /// Program to select before the start, the same as NUMBER
    #[arg(long, value_name = "N", conflicts_with = "number", value_parser = clap::value_parser!(i32).range(1..=K::COUNT))]
    program: Option<i32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
    #[arg(skip)]
    of: PhantomData<K>,
}

impl<K: NumberedProgram> Command for Numbered<K> {
    type Family = Toyo;
    type Report = RunReport;
    const ID: &'static str = K::RUN_ID;
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        let program = match self.number.or(self.program) {
            Some(number) => format!("{} {number}", K::TYPE_NAME),
            None => format!("the last selected {}", K::TYPE_NAME),
        };
        format!("run {program}{}", self.repeat.describe())
    }

    async fn run(&self, mut context: Context<'_, Toyo>) -> Result<RunReport> {
        let program = self.number.or(self.program);
        confirm_start(&mut context, Change::new(self.intent()), Program::Numbered(K::WORD, K::SELECTED, program))
            .await?;
        if let Some(number) = program {
            context.link.ask(&Request::of(K::SELECT, [Value::Number(number)])).await?;
        }
        let report = start_and_wait(context, &Request::bare(K::START), self.end.limit(), self.repeat).await?;
        Ok(report.of(K::WORD, program))
    }
}

/// Move to a row of the coordinate table, and wait for the end of the move (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = "Parameter M10 selects external point mode: `armctl toyo param set M10 P`. A single move \
    cannot have its own speed. To move slowly, set the override: `armctl toyo override set 10`. It applies to all moves, \
    and stays stored.")]
pub struct Point {
    /// Row of the coordinate table, 1 to 999, or the name of a point
    #[arg(value_name = "N", value_parser = parse_point, add = complete::POINT)]
    point: i32,
    #[command(flatten)]
    end: MotionEnd,
}

impl Command for Point {
    type Family = Toyo;
    type Report = PointMoveReport;
    const ID: &'static str = "toyo.run.point";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("move the axes to point {} of the coordinate table", self.point)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<PointMoveReport> {
        let Context { link, confirmer, .. } = context;
        let (mut from, mut to) = (None, None);
        if confirmer.asks_user() {
            let letters = link.letters().await?;
            let current = Coordinates::of(&link.ask(&Request::bare(table::Command::Mpst)).await?, letters);
            let target = self.read_point(link).await?;
            let change = self.change(link, current, target).await?;
            confirmer.confirm(&change).await?;
            if self.read_point(link).await? != target {
                let message = format!("point {} changed after the confirmation; the robot did not move", self.point);
                return Err(data_changed(message));
            }
            (from, to) = (Some(current.position()), target.map(|target| target.position()));
        } else {
            confirmer.confirm(&Change::new(Command::intent(self))).await?;
        }
        let context = Context { link, confirmer, ..context };
        let start = Request::of(table::Command::Extp, [Value::Number(self.point)]);
        let result = start_and_wait(context, &start, (!self.end.no_wait()).then_some(None), Repeat::once()).await?;
        let robot::Program { state, elapsed_ms, more: StepReport { position, .. }, .. } = result.program;
        let reached = (state != Some(ProgramState::Running)).then_some(state == Some(ProgramState::Ended));
        let group = Some(UNIT.to_owned());
        Ok(PointMoveReport(Motion {
            accepted: true,
            group,
            from,
            to,
            reached,
            position,
            elapsed_ms,
            ..Motion::default()
        }))
    }
}

/// Result of a move to a point. `from` and `to` are null if no confirmation was needed.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct PointMoveReport(Motion);

impl Report for PointMoveReport {
    fn view(&self) -> View {
        let Self(Motion { reached, position, elapsed_ms, .. }) = self;
        let state = match reached {
            None => ProgramState::Running,
            Some(true) => ProgramState::Ended,
            Some(false) => ProgramState::Held,
        };
        let mut fields = vec![("run", state.cell())];
        fields.extend(position.as_ref().map(|position| ("at", position.line().into())));
        fields.extend(elapsed_ms.map(|elapsed| ("elapsed (ms)", elapsed.into())));
        View { sections: vec![Section::Fields(fields)] }
    }
}

impl Point {
    /// Reads the position of the point; `None` if the controller refuses to report it.
    async fn read_point(&self, link: &mut Link) -> Result<Option<Coordinates>> {
        let request = Request::read_parameter(point_table(), Some(self.point)).map_err(|error| wrong(&error))?;
        let letters = link.letters().await?;
        Ok(link.try_ask(&request).await?.ok().map(|record| Coordinates::of(&record, letters)))
    }

    /// Change to confirm: the current position and the target of each axis.
    async fn change(&self, link: &mut Link, current: Coordinates, target: Option<Coordinates>) -> Result<Change> {
        let letters = link.letters().await?;
        let percent = saturated_byte(&link.ask(&Request::bare(table::Command::Rovr)).await?, "override");
        let mut change = Change::new(Command::intent(self));
        let mut distance = 0.0;
        for (at, (old, new)) in current.mm().into_iter().zip(target.iter().flat_map(Coordinates::mm)).enumerate() {
            let letter = letters.of(at);
            if ["X", "Y", "Z"].contains(&letter) {
                distance = f64::hypot(distance, new - old);
            }
            change = change.replaces(&titled(at, letter), &format!("{old:.2}"), &format!("{new:.2} mm"));
        }
        change = match target {
            Some(_) => change.note(format!("The point is {distance:.2} mm away.")),
            None => change.note(format!("The position of point {} could not be read.", self.point)),
        };
        Ok(change.note(format!("The speed override is {percent} %.")))
    }
}

/// Program to start: at a step, with a number, or the current program.
enum Program {
    Sequential(Option<i32>),
    /// Word of the type, command that reports the progress, and number.
    Numbered(&'static str, table::Command, Option<i32>),
}

impl Program {
    /// Describes the program and its step, for the confirmation.
    async fn note(&self, link: &mut Link) -> Result<String> {
        match self {
            Self::Sequential(step) => {
                let task = task_selection::select_task(link, None).await?;
                let number = u16::try_from(step.unwrap_or(0)).unwrap_or(0);
                Ok(match steps::numbered(link, number).await? {
                    Ok(record) => {
                        let (step, text) =
                            (record.number("step").unwrap_or(0), record.text("text").unwrap_or_default());
                        format!("The program of task {task} begins at step {step}: {text}.")
                    }
                    Err(_) => format!("It is the program of task {task}; the controller did not report the step."),
                })
            }
            Self::Numbered(kind, question, number) => progress(link, *question, (kind, *number)).await,
        }
    }
}

/// Program and step that will start: `selected`, or the program and step that the controller reports.
async fn progress(link: &mut Link, question: table::Command, (kind, selected): (&str, Option<i32>)) -> Result<String> {
    let Ok(progress) = link.try_ask(&Request::bare(question)).await? else {
        let number = selected.map(|number| format!(" {number}")).unwrap_or_default();
        return Ok(format!("It is {kind} program{number}; the controller did not report the step."));
    };
    let (number, step) = (progress.number("program").unwrap_or(0), progress.number("step").unwrap_or(0));
    Ok(match selected.filter(|selected| *selected != number) {
        None => format!("It is {kind} program {number}, at step {step}."),
        Some(selected) => {
            format!("It is {kind} program {selected}; now the controller is at program {number}, step {step}.")
        }
    })
}

/// Asks for confirmation. The question has the number and step of the program, the position and the speed.
async fn confirm_start(context: &mut Context<'_, Toyo>, change: Change, program: Program) -> Result<()> {
    let Context { link, confirmer, .. } = context;
    let mut change = change;
    if confirmer.asks_user() {
        let letters = link.letters().await?;
        change = change.note(program.note(link).await?);
        let coordinates = Coordinates::of(&link.ask(&Request::bare(table::Command::Mpst)).await?, letters);
        let percent = saturated_byte(&link.ask(&Request::bare(table::Command::Rovr)).await?, "override");
        change = change.note(format!("The axes are at {} (mm).", coordinates.in_a_line()));
        change = change.note(format!("The speed override is {percent} %."));
    }
    confirmer.confirm(&change).await
}

/// Starts the program. If requested, waits for its end up to a time limit. A repetition begins only after the end was
/// confirmed.
#[expect(clippy::option_option, reason = "absent, without a limit, with one")]
async fn start_and_wait(
    context: Context<'_, Toyo>,
    start: &Request,
    limit: Option<Option<Duration>>,
    repeat: Repeat,
) -> Result<RunReport> {
    let Context { link, screen, .. } = context;
    let mut runs = Runs::new(repeat);
    // A repeated run must also wait for the end of the program.
    let limit = limit.or(repeat.repeat.map(|_| None));
    let letters = if limit.is_none() { Letters::UNKNOWN } else { link.letters().await? };
    loop {
        link.ask(start).await.map_err(|failure| runs.add_to_failure(failure))?;
        let Some(limit) = limit else {
            return Ok(RunReport::new(robot::Program {
                state: Some(ProgramState::Running),
                ..robot::Program::default()
            }));
        };
        let report = within(limit, wait(link, screen, start.command(), letters)).await;
        let report =
            report.map_err(|failure| if link.is_dry_run() { failure } else { runs.add_to_failure(failure) })?;
        if repeat.repeat.is_none() {
            return Ok(report);
        }
        if report.program.state == Some(ProgramState::Held) {
            let failure = Failure::new(Kind::ConditionNotMet, "the program is paused at a stop or after a step")
                .hint("to continue, start the program without a step or program number");
            return Err(runs.add_to_failure(failure));
        }
        runs.add(report.program.elapsed_ms.unwrap_or(0));
        if runs.is_complete() {
            return Ok(RunReport::new(robot::Program { cycle: runs.cycle(), ..report.program }));
        }
    }
}

/// Waits for the end, up to a time limit. After the time limit, the program continues.
async fn within(limit: Option<Duration>, end: impl Future<Output = Result<RunReport>>) -> Result<RunReport> {
    let Some(limit) = limit else { return end.await };
    tokio::time::timeout(limit, end).await.unwrap_or_else(|_| {
        let message = format!("{DONE}, and the program still runs after {}", duration::display(limit));
        Err(Failure::new(Kind::ConditionNotMet, message)
            .hint("use `toyo status` to see the state; the program continues"))
    })
}

async fn wait(link: &mut Link, screen: &Screen, order: table::Command, letters: Letters) -> Result<RunReport> {
    let work = AcceptedWork { work: Work::Program, order, done: DONE, doing: "running" };
    let ended = work.wait(link, screen, letters).await.known()?;
    let Some(End { coordinates, elapsed_ms, is_paused }) = ended else { return Err(plan_end(link, order)) };
    // A move to a point runs no steps.
    let last = match order {
        table::Command::Extp => None,
        _ => step(link).await.map_err(|failure| after(&failure))?,
    };
    if is_paused && !is_at_stop_instruction(link, last.as_ref()).await.map_err(|failure| after(&failure))? {
        return Err(stopped(last.as_ref(), coordinates));
    }
    let (step, instruction) = last.unzip();
    let position = coordinates.map(|coordinates| coordinates.position().of_group(UNIT));
    let state = Some(if is_paused { ProgramState::Held } else { ProgramState::Ended });
    let more = StepReport { instruction, position };
    let step = step.map(i64::from);
    Ok(RunReport::new(robot::Program { step, state, elapsed_ms, more, ..robot::Program::default() }))
}

/// In a dry run, records the requests at the end of the program.
fn plan_end(link: &mut Link, order: table::Command) -> Failure {
    let step = |step| Request::of(table::Command::Rstx, [Value::Number(step)]);
    if order != table::Command::Extp {
        link.plan(&step(0), "the last step");
    }
    let stop_check = Reason::about("whether the program contains a stop").depending_on("whether the program is paused");
    link.plan_depending("@STAS SNO=2", stop_check);
    link.plan_depending("@RSTX ?", stop_check);
    unknown()
}

const DONE: &str = "the start was accepted";

/// Whether a program is paused as intended: after a STOP step, or in step mode.
async fn is_at_stop_instruction(link: &mut Link, last: Option<&(i32, String)>) -> Result<bool> {
    if link.status_of(&[2]).await?.run_mode() == Some(RunMode::Step) {
        return Ok(true);
    }
    let previous = last.and_then(|(step, _)| u16::try_from(step - 1).ok()).filter(|previous| *previous > 0);
    let Some(previous) = previous else { return Ok(false) };
    let Ok(record) = steps::numbered(link, previous).await? else { return Ok(false) };
    Ok(record.text("text") == Some("STOP"))
}

fn stopped(last: Option<&(i32, String)>, coordinates: Option<Coordinates>) -> Failure {
    let step = last.map(|(step, text)| format!(" at step {step} ({text})")).unwrap_or_default();
    let coordinates =
        coordinates.map(|coordinates| format!("; the axes are at {}", coordinates.in_a_line())).unwrap_or_default();
    Failure::new(Kind::ConditionNotMet, format!("{DONE}, but the program was stopped{step}{coordinates}")).hint(
        "find the reason; to continue, start the program without a step or program number; to start again from the \
         first step, use `toyo reset`",
    )
}

/// Failure after a run. The outcome of the run is unknown.
fn after(failure: &Failure) -> Failure {
    let message = format!("the run has ended, but its result is unknown: {}", failure.message);
    Failure { message, ..failure.clone() }.hint("use `toyo status` and `toyo position` to see the state")
}

/// Result of a start. A program that is at a STOP, or has run one step in step mode, is held.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RunReport {
    /// Whether the controller accepted the start.
    accepted: bool,
    #[serde(flatten)]
    program: robot::Program<StepReport>,
}

/// Step of the program; null if the command did not wait.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct StepReport {
    /// Instruction of the step.
    instruction: Option<String>,
    /// Position of the axes.
    position: Option<Position>,
}

impl RunReport {
    fn new(program: robot::Program<StepReport>) -> Self {
        Self { accepted: true, program }
    }

    /// Adds the name of the program, for example `easy 3`.
    fn of(mut self, kind: &str, number: Option<i32>) -> Self {
        let name = number.map_or_else(|| kind.to_owned(), |number| format!("{kind} {number}"));
        self.program.program = Some(name);
        self
    }
}

impl Report for RunReport {
    fn view(&self) -> View {
        let StepReport { instruction, position } = &self.program.more;
        let step = self.program.step.zip(instruction.as_ref()).map(|(step, text)| format!("{step}: {text}"));
        let step = step.map(|step| ("step", step.into()));
        let at = position.as_ref().map(|position| ("at", position.line().into()));
        View { sections: vec![Section::Fields(self.program.fields(step.into_iter().chain(at).collect()))] }
    }
}

#[cfg(test)]
mod tests;

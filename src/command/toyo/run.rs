//! `toyo run`: start of programs, and moves to a point.

use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::complete;
use super::link::{self, Link, Toyo};
use super::numbers::small;
use super::point::parse_point;
use super::position::{Coordinates, UNIT, titled};
use super::program::steps;
use super::tasks;
use super::waiting::{Accepted, End, Work, step};
use crate::client::toyo::Letters;
use crate::command::frame::cycle::{Repeat, Runs};
use crate::command::frame::dry_run::{Known as _, Reason, unknown};
use crate::command::frame::wait_arguments::{MotionEnd, ProgramEnd};
use crate::command::robot::motion::Motion;
use crate::command::robot::position::Position;
use crate::command::robot::program::{self as robot, ProgramState};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::toyo::bulk::points;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::RunMode;
use crate::controller::toyo::table;
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation, data_changed};
use crate::output::Screen;
use crate::output::view::{Section, View};
use crate::settings::duration;

commands! {
    /// Commands that start programs and moves.
    pub enum Run {
        /// Start the sequential program
        Sequential(Sequential),
        /// Start palletizing
        Palletizing(Palletizing),
        /// Start the easy program
        Easy(Easy),
        /// Move to a row of the coordinate table
        Point(Point),
    }
}

/// Start the sequential program (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = "Without STEP the program continues at the current step: the step of the last stop, \
    or the first step after `toyo reset`. `toyo status` shows mode, servo and origin, which the command does \
    not change.")]
pub struct Sequential {
    /// First step; default: the current step
    #[arg(value_name = "STEP", value_parser = clap::value_parser!(i32).range(1..=5000))]
    step: Option<i32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

impl Command for Sequential {
    type Family = Toyo;
    type Report = Ran;
    const ID: &'static str = "toyo.run.sequential";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        match self.step {
            Some(step) => format!("run the sequential program from step {step}{}", self.repeat.describe()),
            None => "run the sequential program from its current step".to_owned(),
        }
    }

    async fn run(&self, mut context: Context<'_, Toyo>) -> Result<Ran, Failure> {
        if self.repeat.repeat.is_some() && self.step.is_none() {
            return Err(Failure::usage("--repeat needs the first step of each run")
                .hint("type the step, as in `toyo run sequential 1 --repeat 20`; nothing was started"));
        }
        ask_first(&mut context, Change::new(self.intent()), Program::Sequential(self.step)).await?;
        let start = Request::of(table::Command::Spst, [Value::Number(self.step.unwrap_or(0))]);
        Ok(go(context, &start, self.end.limit(), self.repeat).await?.of("sequential", None))
    }
}

/// Start palletizing, or continue it after a stop (TO 2-7).
#[derive(Debug, Args)]
pub struct Palletizing {
    /// Program to select first; default: the current program
    #[arg(value_name = "NUMBER", value_parser = clap::value_parser!(i32).range(1..=16))]
    number: Option<i32>,
    /// Program number as a flag
    #[arg(long, value_name = "N", conflicts_with = "number", value_parser = clap::value_parser!(i32).range(1..=16))]
    program: Option<i32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

impl Command for Palletizing {
    type Family = Toyo;
    type Report = Ran;
    const ID: &'static str = "toyo.run.palletizing";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("run {}{}", chosen("palletizing", self.number.or(self.program)), self.repeat.describe())
    }

    async fn run(&self, mut context: Context<'_, Toyo>) -> Result<Ran, Failure> {
        let program = self.number.or(self.program);
        ask_first(&mut context, Change::new(self.intent()), Program::Palletizing(program)).await?;
        choose(context.link, table::Command::Spln, program).await?;
        let ran = go(context, &Request::bare(table::Command::Ppst), self.end.limit(), self.repeat).await?;
        Ok(ran.of("palletizing", program))
    }
}

/// Start the easy program, or continue it after a stop (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = "Parameter M10 selects easy mode: `toyo param set M10 E`.")]
pub struct Easy {
    /// Program to select first; default: the current program
    #[arg(value_name = "NUMBER", value_parser = clap::value_parser!(i32).range(1..=8))]
    number: Option<i32>,
    /// Program number as a flag
    #[arg(long, value_name = "N", conflicts_with = "number", value_parser = clap::value_parser!(i32).range(1..=8))]
    program: Option<i32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

impl Command for Easy {
    type Family = Toyo;
    type Report = Ran;
    const ID: &'static str = "toyo.run.easy";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("run {}{}", chosen("easy", self.number.or(self.program)), self.repeat.describe())
    }

    async fn run(&self, mut context: Context<'_, Toyo>) -> Result<Ran, Failure> {
        let program = self.number.or(self.program);
        ask_first(&mut context, Change::new(self.intent()), Program::Easy(program)).await?;
        choose(context.link, table::Command::Sesn, program).await?;
        let ran = go(context, &Request::bare(table::Command::Sesy), self.end.limit(), self.repeat).await?;
        Ok(ran.of("easy", program))
    }
}

/// Move to a row of the coordinate table, and wait for the end of the move (TO 2-7).
#[derive(Debug, Args)]
#[command(after_help = "Parameter M10 selects external point mode: `toyo param set M10 P`.")]
pub struct Point {
    /// Row of the coordinate table, 1 to 999, or a name
    #[arg(value_name = "N", value_parser = parse_point, add = complete::POINT)]
    point: i32,
    #[command(flatten)]
    end: MotionEnd,
}

impl Command for Point {
    type Family = Toyo;
    type Report = Moved;
    const ID: &'static str = "toyo.run.point";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("move the axes to point {} of the coordinate table", self.point)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Moved, Failure> {
        let Context { link, authority, .. } = context;
        let (mut from, mut to) = (None, None);
        if authority.asks() {
            let letters = link.letters().await?;
            let here = Coordinates::of(&link.ask(&Request::bare(table::Command::Mpst)).await?, letters);
            let there = self.place(link).await?;
            let change = self.change(link, here, there).await?;
            authority.confirm(&change).await?;
            if self.place(link).await? != there {
                let message = format!("point {} changed after the confirmation; the robot did not move", self.point);
                return Err(data_changed(message));
            }
            (from, to) = (Some(here.position()), there.map(|there| there.position()));
        } else {
            authority.confirm(&Change::new(Command::intent(self))).await?;
        }
        let context = Context { link, authority, ..context };
        let start = Request::of(table::Command::Extp, [Value::Number(self.point)]);
        let ran = go(context, &start, (!self.end.no_wait()).then_some(None), Repeat::once()).await?;
        let robot::Program { state, elapsed_ms, more: Place { position, .. }, .. } = ran.program;
        let reached = (state != Some(ProgramState::Running)).then_some(state == Some(ProgramState::Ended));
        let group = Some(UNIT.to_owned());
        Ok(Moved(Motion { accepted: true, group, from, to, reached, position, elapsed_ms, ..Motion::default() }))
    }
}

/// Result of a move to a point. From and to are null if no confirmation was necessary.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Moved(Motion);

impl Report for Moved {
    fn view(&self) -> View {
        let Self(Motion { reached, position, elapsed_ms, .. }) = self;
        let state = match reached {
            None => ProgramState::Running,
            Some(true) => ProgramState::Ended,
            Some(false) => ProgramState::Held,
        };
        let mut fields = vec![("run", state.cell())];
        fields.extend(position.as_ref().map(|place| ("at", place.line().into())));
        fields.extend(elapsed_ms.map(|elapsed| ("elapsed (ms)", elapsed.into())));
        View { sections: vec![Section::Fields(fields)] }
    }
}

impl Point {
    /// Position of the point; `None` if the controller refuses to report it.
    async fn place(&self, link: &mut Link) -> Result<Option<Coordinates>, Failure> {
        let request =
            Request::read_parameter(points::table(), Some(self.point)).map_err(|error| link::wrong(&error))?;
        let letters = link.letters().await?;
        Ok(link.try_ask(&request).await?.ok().map(|record| Coordinates::of(&record, letters)))
    }

    /// Change to confirm: present position and target of each axis.
    async fn change(&self, link: &mut Link, here: Coordinates, there: Option<Coordinates>) -> Result<Change, Failure> {
        let letters = link.letters().await?;
        let percent = small(&link.ask(&Request::bare(table::Command::Rovr)).await?, "override");
        let mut change = Change::new(Command::intent(self));
        let mut way = 0.0;
        for (at, (old, new)) in here.mm().into_iter().zip(there.iter().flat_map(Coordinates::mm)).enumerate() {
            let letter = letters.of(at);
            if ["X", "Y", "Z"].contains(&letter) {
                way = f64::hypot(way, new - old);
            }
            change = change.replaces(&titled(at, letter), &format!("{old:.2}"), &format!("{new:.2} mm"));
        }
        change = match there {
            Some(_) => change.note(format!("The point is {way:.2} mm away.")),
            None => change.note(format!("The position of point {} could not be read.", self.point)),
        };
        Ok(change.note(format!("The speed override is {percent} %.")))
    }
}

/// Program to start: a step, a number, or the current one.
enum Program {
    Sequential(Option<i32>),
    Palletizing(Option<i32>),
    Easy(Option<i32>),
}

impl Program {
    /// Sentence about the program and its step.
    async fn note(&self, link: &mut Link) -> Result<String, Failure> {
        match self {
            Self::Sequential(step) => {
                let task = tasks::choose(link, None).await?;
                let number = u16::try_from(step.unwrap_or(0)).unwrap_or(0);
                Ok(match steps::numbered(link, number).await? {
                    Ok(record) => {
                        let (step, text) =
                            (record.number("step").unwrap_or(0), record.text("text").unwrap_or_default());
                        format!("It is the program of task {task}; it begins at step {step}: {text}.")
                    }
                    Err(_) => format!("It is the program of task {task}; the controller did not report the step."),
                })
            }
            Self::Palletizing(wanted) => progress(link, table::Command::Rpld, ("palletizing", *wanted)).await,
            Self::Easy(wanted) => progress(link, table::Command::Resd, ("easy", *wanted)).await,
        }
    }
}

/// Program and step that will start: `wanted`, or those of the controller.
async fn progress(
    link: &mut Link,
    question: table::Command,
    (kind, wanted): (&str, Option<i32>),
) -> Result<String, Failure> {
    let Ok(at) = link.try_ask(&Request::bare(question)).await? else {
        let number = wanted.map(|number| format!(" {number}")).unwrap_or_default();
        return Ok(format!("It is {kind} program{number}; the controller did not report the step."));
    };
    let (number, step) = (at.number("program").unwrap_or(0), at.number("step").unwrap_or(0));
    Ok(match wanted.filter(|wanted| *wanted != number) {
        None => format!("It is {kind} program {number}, at step {step}."),
        Some(wanted) => {
            format!("It is {kind} program {wanted}; now the controller is at program {number}, step {step}.")
        }
    })
}

/// Asks for confirmation with number and step of the program, position and speed.
async fn ask_first(context: &mut Context<'_, Toyo>, change: Change, program: Program) -> Result<(), Failure> {
    let Context { link, authority, .. } = context;
    let mut change = change;
    if authority.asks() {
        let letters = link.letters().await?;
        change = change.note(program.note(link).await?);
        let place = Coordinates::of(&link.ask(&Request::bare(table::Command::Mpst)).await?, letters);
        let percent = small(&link.ask(&Request::bare(table::Command::Rovr)).await?, "override");
        change = change.note(format!("The axes are at {} (mm).", place.in_a_line()));
        change = change.note(format!("The speed override is {percent} %."));
    }
    authority.confirm(&change).await
}

fn chosen(kind: &str, program: Option<i32>) -> String {
    match program {
        Some(number) => format!("{kind} program {number}"),
        None => format!("the last selected {kind} program"),
    }
}

async fn choose(link: &mut Link, command: table::Command, program: Option<i32>) -> Result<(), Failure> {
    match program {
        Some(number) => link.ask(&Request::of(command, [Value::Number(number)])).await.map(|_| ()),
        None => Ok(()),
    }
}

/// Starts, and waits for the end up to a time limit if requested. A repetition begins only after a confirmed end.
#[expect(clippy::option_option, reason = "absent, without a limit, with one")]
async fn go(
    context: Context<'_, Toyo>,
    start: &Request,
    limit: Option<Option<Duration>>,
    repeat: Repeat,
) -> Result<Ran, Failure> {
    let Context { link, screen, .. } = context;
    let mut runs = Runs::new(repeat);
    // The wait begins with the start.
    let limit = limit.or(repeat.repeat.map(|_| None));
    let letters = if limit.is_none() { Letters::UNKNOWN } else { link.letters().await? };
    loop {
        link.ask(start).await.map_err(|failure| runs.add_to_failure(failure))?;
        let Some(limit) = limit else {
            return Ok(Ran::new(robot::Program { state: Some(ProgramState::Running), ..robot::Program::default() }));
        };
        let ran = within(limit, wait(link, screen, start.command(), letters)).await;
        let ran = ran.map_err(|failure| if link.is_dry() { failure } else { runs.add_to_failure(failure) })?;
        if repeat.repeat.is_none() {
            return Ok(ran);
        }
        if ran.program.state == Some(ProgramState::Held) {
            let failure = Failure::new(Kind::ConditionNotMet, "the program is paused at a stop or after a step")
                .hint("to continue, start it without a step or program");
            return Err(runs.add_to_failure(failure));
        }
        runs.add(ran.program.elapsed_ms.unwrap_or(0));
        if runs.is_complete() {
            return Ok(Ran::new(robot::Program { cycle: runs.cycle(), ..ran.program }));
        }
    }
}

/// Waits for the end up to a time limit. The program continues afterwards.
async fn within(limit: Option<Duration>, end: impl Future<Output = Result<Ran, Failure>>) -> Result<Ran, Failure> {
    let Some(limit) = limit else { return end.await };
    tokio::time::timeout(limit, end).await.unwrap_or_else(|_| {
        let message = format!("{DONE}, and the program still runs after {}", duration::display(limit));
        Err(Failure::new(Kind::ConditionNotMet, message).hint("the program continues; `toyo status` shows its state"))
    })
}

async fn wait(link: &mut Link, screen: &Screen, order: table::Command, letters: Letters) -> Result<Ran, Failure> {
    let work = Accepted { work: Work::Program, order, done: DONE, doing: "running" };
    let ended = work.wait(link, screen, letters).await.known()?;
    let Some(End { place, elapsed_ms, is_paused }) = ended else { return Err(plan_end(link, order)) };
    // A move to a point runs no steps.
    let last = match order {
        table::Command::Extp => None,
        _ => step(link).await.map_err(|failure| after(&failure))?,
    };
    if is_paused && !is_at_a_stop(link, last.as_ref()).await.map_err(|failure| after(&failure))? {
        return Err(stopped(last.as_ref(), place));
    }
    let (step, instruction) = last.unzip();
    let position = place.map(|place| place.position().of_group(UNIT));
    let state = Some(if is_paused { ProgramState::Held } else { ProgramState::Ended });
    let more = Place { instruction, position };
    let step = step.map(i64::from);
    Ok(Ran::new(robot::Program { step, state, elapsed_ms, more, ..robot::Program::default() }))
}

/// Records in a dry run the requests at the end.
fn plan_end(link: &mut Link, order: table::Command) -> Failure {
    let step = |step| Request::of(table::Command::Rstx, [Value::Number(step)]);
    if order != table::Command::Extp {
        link.plan(&step(0), "the last step");
    }
    let stands = Reason::about("whether the program contains a stop").depending_on("whether it is paused");
    link.plan_depending("@STAS SNO=2", stands);
    link.plan_depending("@RSTX ?", stands);
    unknown()
}

const DONE: &str = "the start was accepted";

/// Whether a paused program was meant to stop: after a STOP step, or in step mode.
async fn is_at_a_stop(link: &mut Link, last: Option<&(i32, String)>) -> Result<bool, Failure> {
    if link.status_of(&[2]).await?.run_mode() == Some(RunMode::Step) {
        return Ok(true);
    }
    let before = last.and_then(|(step, _)| u16::try_from(step - 1).ok()).filter(|before| *before > 0);
    let Some(before) = before else { return Ok(false) };
    let Ok(record) = steps::numbered(link, before).await? else { return Ok(false) };
    Ok(record.text("text") == Some("STOP"))
}

fn stopped(last: Option<&(i32, String)>, place: Option<Coordinates>) -> Failure {
    let step = last.map(|(step, text)| format!(" at step {step} ({text})")).unwrap_or_default();
    let place = place.map(|place| format!("; the axes are at {}", place.in_a_line())).unwrap_or_default();
    Failure::new(Kind::ConditionNotMet, format!("{DONE}, but the program was stopped{step}{place}"))
        .hint("find the reason; then start it without a step or program to continue, or use `toyo reset`")
}

/// Failure after a run whose result is unknown.
fn after(failure: &Failure) -> Failure {
    let message = format!("the run has ended, but its result is unknown: {}", failure.message);
    Failure { message, ..failure.clone() }.hint("`toyo status` and `toyo position` show the state")
}

/// Result of a start. A program at a STOP, or after a step in step mode, is held.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Ran {
    /// Whether the controller accepted the command.
    accepted: bool,
    #[serde(flatten)]
    program: robot::Program<Place>,
}

/// Step of the program; null without a wait.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Place {
    /// Instruction of the step.
    instruction: Option<String>,
    /// Position of the axes.
    position: Option<Position>,
}

impl Ran {
    fn new(program: robot::Program<Place>) -> Self {
        Self { accepted: true, program }
    }

    /// Adds the name of the program: `easy 3`.
    fn of(mut self, kind: &str, number: Option<i32>) -> Self {
        let name = number.map_or_else(|| kind.to_owned(), |number| format!("{kind} {number}"));
        self.program.program = Some(name);
        self
    }
}

impl Report for Ran {
    fn view(&self) -> View {
        let Place { instruction, position } = &self.program.more;
        let step = self.program.step.zip(instruction.as_ref()).map(|(step, text)| format!("{step}: {text}"));
        let step = step.map(|step| ("step", step.into()));
        let at = position.as_ref().map(|place| ("at", place.line().into()));
        View { sections: vec![Section::Fields(self.program.fields(step.into_iter().chain(at).collect()))] }
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::command::toyo::testing::{Bench, Fault, all_blocks, blocks, intent, objection};

    /// Half a second, then 100 mm at 100 mm/s.
    const PROGRAM: &str = "origin = true\nspeeds = { 1 = 100.0 }\npoints = { 1 = { 1 = [100.0, 0.0, 0.0, 0.0] } }\n\
        steps = { 1 = [\"TIM TM=000.5\", \"MOVP a PT=001 CN=00 S V=01 POST\", \"OUT STN=0 PN01=.......1\", \"END\"] }\n";

    #[test]
    fn dry_runs_show_the_start_and_what_is_asked_meanwhile() {
        assert_eq!(
            all_blocks(&["run", "sequential", "12", "--wait"]).unwrap(),
            [
                "@SYSP",
                "@RPAR E01",
                "@STAS SNO=2",
                "@HSON",
                "@STAS SNO=0",
                "@SPST 0012",
                "@STAS SNO=0",
                "@MPST",
                "@STAS SNO=4",
                "@RSTX 0000",
                "@STAS SNO=1",
                "@RSTX 0000",
                "@STAS SNO=2",
                "@RSTX ?",
                "@HSOF"
            ]
        );
        assert_eq!(blocks(&["run", "sequential"]).unwrap(), ["@SPST 0000"]);
        assert_eq!(blocks(&["run", "palletizing", "--program", "3", "--no-wait"]).unwrap(), ["@SPLN PR=03", "@PPST"]);
        assert_eq!(blocks(&["run", "palletizing", "--no-wait"]).unwrap(), ["@PPST"]);
        assert_eq!(blocks(&["run", "easy", "--program", "8", "--no-wait"]).unwrap(), ["@SESN PR=08", "@SESY"]);
        assert_eq!(blocks(&["run", "point", "7", "--no-wait"]).unwrap(), ["@EXTP PT=007"]);
        assert_eq!(intent(&["run", "easy", "--program", "8"]), "run easy program 8");
        assert!(objection(&["run", "sequential", "5001"]).contains("1..=5000"));
        assert!(objection(&["run", "point", "0"]).contains("1 to 999"));
    }

    #[test]
    fn a_program_is_waited_for() {
        let (mut bench, heard) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
        let data = bench.data(&["run", "sequential", "1", "--wait"]);
        assert_eq!((&data["state"], &data["position"]["x_mm"]), (&"ended".into(), &100.0.into()));
        let elapsed = data["elapsed_ms"].as_u64().unwrap();
        assert!((1600..2000).contains(&elapsed), "{elapsed}");
        assert_eq!(heard.borrow().iter().filter(|block| block.starts_with("@SPST")).count(), 1);
    }

    #[test]
    fn a_program_that_was_never_seen_to_run_has_not_ended() {
        let state = "origin = true\nsteps = { 1 = [\"OUT STN=0 PN01=.......1\", \"END\"] }\n";
        let failure =
            Bench::with_faults(state, |_, _| Fault::None).0.run(&["run", "sequential", "--wait"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert!(failure.message.contains("the status did not show it"), "{}", failure.message);
    }

    #[test]
    fn a_stop_of_the_program_is_an_end_and_one_of_somebody_is_not() {
        let state = "origin = true\nsteps = { 1 = [\"NOP\", \"STOP\", \"NOP\", \"TIM TM=010.0\", \"END\"] }\n\
            [[event]]\nat_ms = 3000\ndo = \"stop\"\n";
        let (mut bench, _) = Bench::with_faults(state, |_, _| Fault::None);
        let data = bench.data(&["run", "sequential", "1", "--wait"]);
        assert_eq!((&data["state"], &data["step"]), (&"held".into(), &3.into()));
        let failure = bench.run(&["run", "sequential", "--wait"]).unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert!(failure.message.contains("somebody stopped it at step 4 (TIM TM=010.0)"), "{}", failure.message);
    }

    #[test]
    fn in_step_mode_every_step_is_an_end() {
        let (mut bench, _) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
        bench.data(&["mode", "step"]);
        assert_eq!(bench.data(&["run", "sequential", "1", "--wait"])["state"], "held");
    }

    #[test]
    fn an_error_that_comes_up_is_a_failure() {
        let state = format!("{PROGRAM}[[event]]\nat_ms = 1000\ndo = \"estop\"\n");
        let failure =
            Bench::with_faults(&state, |_, _| Fault::None).0.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("13")));
        assert!(
            failure
                .message
                .starts_with("the start was accepted, but an error came up (13: emergency stop); it stands at X "),
            "{}",
            failure.message
        );
        assert!(failure.hint.unwrap().contains("toyo alarm reset"));
    }

    #[test]
    fn what_a_run_needs_is_told_and_not_changed() {
        let refused = |state: &str| {
            let (mut bench, heard) = Bench::with_faults(state, |_, _| Fault::None);
            let failure = bench.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
            assert_eq!(failure.kind, Kind::Refused);
            let changes = ["@MAUT", "@SVON", "@HOME", "@CERR", "@MSEQ"];
            assert!(!heard.borrow().iter().any(|block| changes.contains(&block.as_str())), "{heard:?}");
            failure.message
        };
        assert!(refused(&format!("mode = \"program\"\n{PROGRAM}")).ends_with("the controller is in program mode"));
        assert!(refused(&format!("palletizing = true\n{PROGRAM}")).ends_with("the controller is in palletizing mode"));
        assert!(refused(&format!("error = \"A1\"\n{PROGRAM}")).ends_with("error A1: tag undefined"));
        assert!(refused(&format!("pendant = true\n{PROGRAM}")).contains("the teach pendant is ON"));
    }

    #[test]
    fn a_start_whose_answer_is_lost_is_sent_once() {
        for fate in [Fault::Lost, Fault::Unanswered, Fault::Answered("@O")] {
            let (mut bench, heard) =
                Bench::with_faults(
                    PROGRAM,
                    move |block, _| if block.starts_with("@SPST") { fate } else { Fault::None },
                );
            let failure = bench.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
            assert_eq!(failure.kind, Kind::OutcomeUnknown, "{fate:?}");
            assert!(failure.hint.unwrap().contains("`toyo status`"));
            assert_eq!(heard.borrow().iter().filter(|block| block.starts_with("@SPST")).count(), 1);
        }
    }

    #[test]
    fn a_lost_contact_leaves_the_outcome_open() {
        let lost = |block: &str, count| if block == "@STAS SNO=0" && count > 2 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults(PROGRAM, lost).0.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert!(
            failure.message.starts_with("the start was accepted, but its end was not seen: "),
            "{}",
            failure.message
        );
        assert!(failure.hint.unwrap().starts_with("do not send it again: keep clear; `toyo status`"));
    }

    #[test]
    fn a_busy_controller_is_asked_again() {
        let busy = |block: &str, count| {
            if block == "@STAS SNO=0" && count % 2 == 0 { Fault::Answered("@NG") } else { Fault::None }
        };
        assert_eq!(
            Bench::with_faults(PROGRAM, busy).0.data(&["run", "sequential", "1", "--wait"])["position"]["x_mm"],
            100.0
        );
    }

    #[test]
    fn ctrl_c_stops_what_runs() {
        for (words, state) in
            [(&["run", "sequential", "1", "--wait"][..], PROGRAM), (&["home"], "position = [300.0, 0.0, 0.0, 0.0]\n")]
        {
            for ms in (200..1400).step_by(170) {
                let (mut bench, heard) = Bench::with_faults(state, |_, _| Fault::None);
                let said = bench.interrupted(words, Duration::from_millis(ms)).unwrap();
                assert!(said.starts_with("the robot was stopped (@STOP); it stands at X "), "{words:?} {ms}: {said}");
                assert!(heard.borrow().iter().any(|block| block == "@STOP"));
                let here = bench.data(&["position"]);
                bench.wait(Duration::from_secs(10));
                assert_eq!(bench.data(&["position"]), here, "{words:?} {ms}");
                assert_eq!(bench.data(&["status"])["running"], false);
            }
        }
    }

    #[test]
    fn a_late_ok_to_the_start_is_not_that_to_the_stop() {
        // The start is answered after 400 ms; Ctrl-C comes before that, and the first stop is lost.
        let (mut bench, heard) = Bench::with_faults(PROGRAM, |block, count| match block {
            "@SPST 0001" => Fault::Late(Duration::from_millis(400)),
            "@STOP" if count == 1 => Fault::Lost,
            _ => Fault::None,
        });
        bench.interrupted(&["run", "sequential", "1", "--wait"], Duration::from_millis(250)).unwrap();
        assert!(heard.borrow().iter().filter(|block| *block == "@STOP").count() >= 2);
        assert_eq!(bench.data(&["status"])["running"], false);
    }

    #[test]
    fn only_a_jog_is_stopped_although_it_was_to_be_left() {
        let must_halt = |words: &[&str]| {
            let (mut bench, _) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
            bench.left(words, Duration::from_millis(450))
        };
        assert!(!must_halt(&["run", "sequential", "1", "--wait"]));
        assert!(must_halt(&["jog", "X", "+", "low", "--for", "5s"]));
    }

    #[test]
    fn the_host_is_given_back_while_a_program_runs() {
        let (mut bench, heard) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
        assert_eq!(bench.data(&["run", "sequential", "1", "--no-wait"])["state"], "running");
        bench.close().unwrap();
        assert_eq!(heard.borrow().last().unwrap(), "@HSOF");
    }
}

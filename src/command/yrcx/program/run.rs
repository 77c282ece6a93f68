//! `yrcx program run` (4.6.2): starts a program, and waits for its end where that is wanted.

use std::time::Duration;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use tokio::time::{Instant, timeout};

use super::WhichOrAll;
use crate::command::frame::cycle::{Cycle, Repeat, Runs};
use crate::command::frame::dry_run::unknown;
use crate::command::frame::ending::ProgramEnd;
use crate::command::robot::program::{Program, ProgramState};
use crate::command::yrcx::link::{Link, Yrcx};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::yrcx::signal::output;
use crate::controller::yrcx::table;
use crate::failure::{Failure, Kind};
use crate::output::view::{Section, View};
use crate::settings::duration;

/// Runs a program, or all that are registered. The controller answers as soon as it has accepted that.
#[derive(Debug, Args)]
#[command(
    after_help = "--wait looks at SO(13) until no program runs. `yrcx io get program-running` tells the same; `yrcx \
    stop` stops programs, and so does the end of the connection. A program must be in a task: `yrcx program select`."
)]
pub struct Run {
    #[command(flatten)]
    which: WhichOrAll,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

/// How long a program may take to show that it runs; what was not seen by then was over before.
const BEGIN_WITHIN: Duration = Duration::from_secs(1);

impl Command for Run {
    type Family = Yrcx;
    type Report = Ran;
    const ID: &'static str = "yrcx.program.run";

    fn risk(&self) -> Risk {
        table::Command::ProgramRun.row().risk
    }

    fn intent(&self) -> String {
        format!("run {}{}", self.which.describe(), self.repeat.in_words())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Ran, Failure> {
        let Context { link, screen, .. } = context;
        let order = self.which.put(link.draft(table::Command::ProgramRun)?).build()?;
        let what = self.which.describe();
        let report = |state: ProgramState, elapsed_ms: Option<u64>, cycle: Cycle| {
            let program = self.which.program().or_else(|| self.which.name()).cloned();
            let task = self.which.task.as_ref().and_then(|task| task.parse().ok());
            let more = Started { task, all_programs: self.which.all_programs, words: what.clone() };
            let program = Program { program, state: Some(state), elapsed_ms, cycle, more, ..Program::default() };
            Ran { accepted: true, program }
        };
        let limit = self.end.limit().or(self.repeat.repeat.map(|_| None));
        let mut runs = Runs::new(self.repeat);
        for _ in 0..self.repeat.count() {
            let early = |failure| runs.early(failure);
            link.ask(&order).await.map_err(early)?;
            let began = Instant::now();
            let Some(limit) = limit else {
                return Ok(report(ProgramState::Running, None, Cycle::default()));
            };
            if link.is_dry() {
                return Err(self.plan(link));
            }
            let doing = runs.next().map_or_else(|| format!("{what} runs"), |run| format!("{what}: {run}"));
            let _progress = screen.spinner(&doing);
            let seen = wait(link, &what, began, limit).await.map_err(early)?;
            let elapsed_ms = u64::try_from(began.elapsed().as_millis()).unwrap_or(u64::MAX);
            if seen {
                runs.ended(elapsed_ms);
            } else if self.repeat.repeat.is_some() {
                // Nobody knows whether it ended or has not begun: it is not started on top of that.
                return Err(early(not_seen(&what)));
            }
        }
        Ok(report(ProgramState::Ended, runs.last_ms(), runs.cycle()))
    }
}

impl Run {
    /// Says in a dry run what follows a start.
    fn plan(&self, link: &mut Link) -> Failure {
        link.then("what the controller shows is looked at until SO(13) tells that no program runs");
        if let Some(count) = self.repeat.repeat {
            link.then(&format!("after each end that was seen it is started again, {count} starts in all"));
        }
        unknown()
    }
}

fn not_seen(what: &str) -> Failure {
    let limit = duration::display(BEGIN_WITHIN);
    let message =
        format!("{what} was started, and was not seen running within {limit}: it may have ended at once, or not begun");
    Failure::new(Kind::ConditionNotMet, message).hint("`yrcx info tasks` and `yrcx info line` tell how it stands")
}

/// Waits until no program runs; whether one was seen running.
async fn wait(link: &mut Link, what: &str, began: Instant, limit: Option<Duration>) -> Result<bool, Failure> {
    let lost = |failure: Failure| {
        let message = format!("{what} was started, but its end was not seen: {}", failure.message);
        Failure { kind: Kind::OutcomeUnknown, message, ..failure }.hint(
            "do not send it again; `yrcx status` tells what came of it. A controller whose master goes away stops",
        )
    };
    let is_over = |image: &_| output::ALARM.is_on(image) || output::EMERGENCY_STOP.is_on(image);
    let begins = link.look_until(|image| output::PROGRAM_RUNNING.is_on(image) || is_over(image));
    let seen = match timeout(BEGIN_WITHIN, begins).await {
        Ok(image) => output::PROGRAM_RUNNING.is_on(&image.map_err(lost)?),
        Err(_) => false,
    };
    let ends = link.look_until(|image| !output::PROGRAM_RUNNING.is_on(image) || is_over(image));
    let rest = limit.map(|limit| limit.saturating_sub(began.elapsed()));
    let image = match rest {
        None => ends.await,
        Some(rest) => timeout(rest, ends).await.map_err(|_| {
            let limit = duration::display(limit.unwrap_or_default());
            Failure::new(Kind::ConditionNotMet, format!("{what} still runs after {limit}"))
                .hint("`yrcx info line` tells how far it is; the end of this connection stops it")
        })?,
    };
    let image = image.map_err(lost)?;
    let stopped = if output::EMERGENCY_STOP.is_on(&image) {
        Some(("the emergency stop came on", "release it, then `yrcx recover`"))
    } else if output::ALARM.is_on(&image) {
        Some(("an alarm came up", "`yrcx alarm list` names it, `yrcx alarm reset` resets it"))
    } else {
        None
    };
    match stopped {
        None => Ok(seen),
        Some((why, hint)) => {
            Err(Failure::new(Kind::ConditionNotMet, format!("{what} was started, but {why}")).hint(hint))
        }
    }
}

/// A program that was started.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Ran {
    /// The controller took the order.
    accepted: bool,
    #[serde(flatten)]
    program: Program<Started>,
}

/// What was started.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Started {
    /// The task by which it was named.
    task: Option<i64>,
    /// All registered programs.
    all_programs: bool,
    /// In words.
    #[serde(skip)]
    words: String,
}

impl Report for Ran {
    fn view(&self) -> View {
        if self.program.state == Some(ProgramState::Running) {
            return View::text(format!("started {}", self.program.more.words));
        }
        View { sections: vec![Section::Fields(self.program.fields(Vec::new()))] }
    }
}

//! `yrcx program run` (4.6.2): starts a program and optionally waits for its end.

use tokio::time::{Instant, timeout};

use super::WhichOrAll;
use crate::alarm;
use crate::info::Part;
use crate::prelude::*;
use armctl_frame::repeated_runs::{Cycle, Repeat, Runs};
use armctl_frame::robot::alarm::{AlarmEntry, hint_after};
use armctl_frame::robot::program::{Program, ProgramState};
use armctl_frame::wait_arguments::ProgramEnd;

/// Runs a program, or all registered programs. The controller answers when it has accepted the start.
#[derive(Debug, Args)]
#[command(
    after_help = "--wait waits until no program runs (SO(13), as in `yrcx io get program-running`). `yrcx stop` stops \
                  programs. The end of the connection also stops programs. A program must be in a task: use `yrcx \
                  program select`."
)]
pub struct Run {
    #[command(flatten)]
    which: WhichOrAll,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

/// Time in which a program must start to run. If armctl does not see the program running in this time, the program may
/// have ended already.
const START_TIMEOUT: Duration = Duration::from_secs(1);

impl Command for Run {
    type Family = Yrcx;
    type Report = RunReport;
    const ID: &'static str = "yrcx.program.run";

    fn risk(&self) -> Risk {
        table::Command::ProgramRun.row().risk
    }

    fn intent(&self) -> String {
        format!("run {}{}", self.which.describe(), self.repeat.describe())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<RunReport> {
        let Context { link, screen, .. } = context;
        let order = self.which.apply_to(link.draft(table::Command::ProgramRun)?).valid_order()?;
        let what = self.which.describe();
        let report = |state: ProgramState, elapsed_ms: Option<u64>, cycle: Cycle| {
            let program = self.which.program().or_else(|| self.which.name()).cloned();
            let task = self.which.task.as_ref().and_then(|task| task.parse().ok());
            let more = Started { task, all_programs: self.which.all_programs, words: what.clone() };
            let program = Program { program, state: Some(state), elapsed_ms, cycle, more, ..Program::default() };
            RunReport { accepted: true, program }
        };
        let limit = self.end.limit().or(self.repeat.repeat.map(|_| None));
        let mut runs = Runs::new(self.repeat);
        for _ in 0..self.repeat.count() {
            let early = |failure| runs.add_to_failure(failure);
            let before = match limit {
                Some(_) => alarm::latest(link).await.map_err(early)?,
                None => None,
            };
            link.ask(&order).await.map_err(early)?;
            let began = Instant::now();
            let Some(limit) = limit else {
                return Ok(report(ProgramState::Running, None, Cycle::default()));
            };
            if link.is_dry_run() {
                return Err(self.plan(link));
            }
            let doing = runs.next().map_or_else(|| format!("{what} runs"), |run| format!("{what}: {run}"));
            let _progress = screen.spinner(&doing);
            let seen = wait(link, &what, began, limit).await.map_err(early)?;
            alarmed(link, &what, before.as_ref()).await.map_err(early)?;
            let elapsed_ms = u64::try_from(began.elapsed().as_millis()).unwrap_or(u64::MAX);
            if seen {
                runs.add(elapsed_ms);
            } else if self.repeat.repeat.is_some() {
                // The program may have ended, or may not have started. Because armctl does not know which, it does not
                // start the program again.
                return Err(early(never_observed(&what)));
            }
        }
        Ok(report(ProgramState::Ended, runs.last_ms(), runs.cycle()))
    }
}

impl Run {
    /// Notes what follows a start, in a dry run.
    fn plan(&self, link: &mut Link) -> Failure {
        link.then(
            "armctl reads the signals until SO(13) shows that no program is running, then reads the latest alarm \
             again",
        );
        if let Some(count) = self.repeat.repeat {
            link.then(&format!("after each end, armctl starts the program again, {count} starts in total"));
        }
        unknown()
    }
}

fn never_observed(what: &str) -> Failure {
    let limit = duration::display(START_TIMEOUT);
    let message = format!(
        "{what} was started, but the controller reported no running program within {limit}: the program ended at \
         once, or did not start"
    );
    Failure::new(Kind::ConditionNotMet, message).hint("check the program with `yrcx info tasks` and `yrcx info line`")
}

/// Waits until no program runs. Returns whether a program was seen running.
async fn wait(link: &mut Link, what: &str, began: Instant, limit: Option<Duration>) -> Result<bool> {
    let lost = |failure: Failure| {
        let message = format!("{what} was started, but armctl could not read the result: {}", failure.message);
        Failure { kind: Kind::OutcomeUnknown, message, ..failure }.hint(
            "do not send the command again; use `yrcx status` to see the result. A controller stops when the \
             connection ends",
        )
    };
    let is_over = |image: &_| output::ALARM.is_on(image) || output::EMERGENCY_STOP.is_on(image);
    let begins = link.wait_for_image(|image| output::PROGRAM_RUNNING.is_on(image) || is_over(image));
    let seen = match timeout(START_TIMEOUT, begins).await {
        Ok(image) => output::PROGRAM_RUNNING.is_on(&image.map_err(lost)?),
        Err(_) => false,
    };
    let ends = link.wait_for_image(|image| !output::PROGRAM_RUNNING.is_on(image) || is_over(image));
    let rest = limit.map(|limit| limit.saturating_sub(began.elapsed()));
    let image = match rest {
        None => ends.await,
        Some(rest) => timeout(rest, ends).await.map_err(|_| {
            let limit = duration::display(limit.unwrap_or_default());
            Failure::new(Kind::ConditionNotMet, format!("{what} is still running after {limit}"))
                .hint("use `yrcx info line` to see the current line; the end of this connection stops the program")
        })?,
    };
    image.map_err(lost).map(|_| seen)
}

/// Fails if an emergency stop or an alarm ended the program. An error in a program stops the program, but does not
/// switch SO(03) on. Then only the alarm history shows that the program did not reach its end; `before` is its latest
/// entry before the start.
async fn alarmed(link: &mut Link, what: &str, before: Option<&AlarmEntry<Part>>) -> Result<()> {
    let image = link.look().await?;
    let latest = alarm::latest(link).await?;
    let is_new = latest.as_ref().is_some_and(|latest| before != Some(latest));
    let (why, hint) = if output::EMERGENCY_STOP.is_on(&image) {
        (
            "the emergency stop was triggered".to_owned(),
            "release the emergency stop, then use `yrcx recover`".to_owned(),
        )
    } else if output::ALARM.is_on(&image) || is_new {
        let alarm = latest.as_ref().and_then(|latest| Some((latest.alarm.code.as_ref()?, latest.alarm.text.as_ref()?)));
        let why = alarm.map_or_else(|| "an alarm".to_owned(), |(code, text)| format!("alarm {code} ({text})"));
        let code = latest.as_ref().and_then(|latest| latest.alarm.code.as_deref());
        (format!("{why} occurred"), hint_after(Family::Yrcx, code))
    } else {
        return Ok(());
    };
    let failure = Failure::new(Kind::ConditionNotMet, format!("{what} was started, but {why}")).hint(hint);
    Err(Failure { code: latest.and_then(|latest| latest.alarm.code), ..failure })
}

/// Result of a program start.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RunReport {
    /// Whether the controller accepted the start.
    accepted: bool,
    #[serde(flatten)]
    program: Program<Started>,
}

/// Which programs were started.
#[derive(Debug, Default, Serialize, JsonSchema)]
struct Started {
    /// Task, if the user selected the program by its task.
    task: Option<i64>,
    /// Whether all registered programs were started.
    all_programs: bool,
    /// Description of the programs.
    #[serde(skip)]
    words: String,
}

impl Report for RunReport {
    fn view(&self) -> View {
        if self.program.state == Some(ProgramState::Running) {
            return View::text(format!("started {}", self.program.more.words));
        }
        View { sections: vec![Section::Fields(self.program.fields(Vec::new()))] }
    }
}

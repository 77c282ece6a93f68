//! `yerc job start`: starts the selected job, or a job by name, once or several times, and can wait for its end.

use tokio::time::Instant;

use super::{Select, about, without_suffix};
use crate::motion::{POLL_INTERVAL, START_TIMEOUT, StandstillCause, lost_contact, plan_alarm};
use crate::number_arguments::parse_in_range;
use crate::prelude::*;
use crate::selected_job::SelectedJob;
use armctl_controller::yerc::payload::{ControllerStatus, StatusBit};
use armctl_controller::yerc::query::{Query as _, ReadJob, ReadStatus, SelectJob, StartJob};
use armctl_frame::gate::data_changed;
use armctl_frame::repeated_runs::{Repeat, Runs};
use armctl_frame::robot::program::{Program, ProgramState};
use armctl_frame::wait_arguments::ProgramEnd;

/// Starts the selected job, or selects a job and starts it (FS and DX 3.3.23, 3.3.24).
#[derive(Debug, Args)]
#[command(
    after_help = "You confirm the job name once; then armctl selects and starts the job. --wait and --repeat read the \
                  status until the job reaches END or is stopped. --repeat starts the same job again at the same \
                  line, but only after the controller reported the end. Any other event ends the command. After a \
                  lost answer, armctl does not start the job again."
)]
pub struct Start {
    /// Job name without .JBI [default: the selected job]
    #[arg(add = complete::JOB)]
    name: Option<String>,
    /// Start line
    #[arg(long, value_name = "N", requires = "name", conflicts_with = "repeat", value_parser = parse_in_range::<u32>(0, 9999))]
    line: Option<u32>,
    #[command(flatten)]
    end: ProgramEnd,
    #[command(flatten)]
    repeat: Repeat,
}

impl Command for Start {
    type Family = Yerc;
    type Report = Started;
    const ID: &'static str = "yerc.job.start";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn risk(&self) -> Risk {
        StartJob.risk()
    }

    fn intent(&self) -> String {
        let times = self.repeat.describe();
        match &self.name {
            Some(name) => format!("select and start job {}{times}", without_suffix(name)),
            None => format!("start the selected job{times}"),
        }
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Started> {
        let Context { link, screen, confirmer, .. } = context;
        let named = match self.name.as_deref() {
            Some(name) => Some(self.selection(link, without_suffix(name)).await?),
            None => None,
        };
        if self.repeat.repeat.is_some() {
            check_cycle(link).await?;
        }
        let mut selected = SelectedJob::ask(link).await?;
        let is_asked = confirmer.asks_user();
        confirmer.confirm(&self.change(&selected, link)).await?;
        if is_asked {
            selected.check_unchanged(link).await?;
        }
        if let Some((name, select)) = named {
            let outcome = link.for_purpose("selects it").ask(&select).await;
            outcome.map_err(|failure| about(self.name.as_deref().unwrap_or_default(), failure))?;
            if let Some(now) = SelectedJob::ask(link.for_purpose("selected job")).await.known()?
                && !link.is_dry_run()
            {
                check_selected(link, &name, &selected, &now)?;
                selected = now;
            }
        }
        let job = selected.name(link.encoding);
        let limit = self.end.limit().or(self.repeat.repeat.map(|_| None));
        let mut runs = Runs::new(self.repeat);
        let mut line = None;
        for _ in 0..self.repeat.count() {
            let too_early = |failure| runs.add_to_failure(failure);
            // A job is started again only if the state of the controller is the same as before the previous run.
            if runs.last_ms().is_some() {
                selected.check_unchanged(link).await.map_err(too_early)?;
            }
            link.for_purpose("starts it").ask(&StartJob).await.map_err(too_early)?;
            let Some(limit) = limit else {
                return Ok(Started {
                    accepted: true,
                    program: Program { program: job, state: Some(ProgramState::Running), ..Program::default() },
                });
            };
            if link.is_dry_run() {
                return Err(self.plan(link).await?);
            }
            let what = runs.next().unwrap_or_else(|| "the job is running".to_owned());
            let (elapsed_ms, at) = wait(link, screen, limit, &what, &selected).await.map_err(too_early)?;
            runs.add(elapsed_ms);
            line = at;
        }
        let elapsed_ms = runs.last_ms();
        let state = Some(ProgramState::Ended);
        let (line, cycle) = (line.map(i64::from), runs.cycle());
        let program = Program { program: job, line, state, elapsed_ms, cycle, ..Program::default() };
        Ok(Started { accepted: true, program })
    }
}

impl Start {
    async fn selection(&self, link: &mut Link, name: &str) -> Result<(Vec<u8>, SelectJob)> {
        let select = Select { name: name.to_owned(), line: self.line.unwrap_or(0), task: None };
        let query = select.query(name, link).await?;
        Ok((link.encode("the job name", name)?, query))
    }

    /// Text of the confirmation.
    fn change(&self, chosen: &SelectedJob, link: &Link) -> Change {
        let times = self.repeat.describe();
        let Some(name) = &self.name else { return chosen.change(link.encoding, &times) };
        let from = self.line.filter(|line| *line > 0).map(|line| format!(" from line {line}")).unwrap_or_default();
        let change = Change::new(format!("select and start job {}{from}{times}", without_suffix(name)));
        chosen.item_name(change, link.encoding)
    }

    /// In a dry run, records what follows a start.
    async fn plan(&self, link: &mut Link) -> Result<Failure> {
        link.plan(&ReadStatus.request(), "repeatedly until the job has ended");
        let job = link.by_model(|model| ReadJob::new(model, 0)).await?;
        link.plan(&job.request(), "line at the end");
        plan_alarm(link)?;
        if let Some(count) = self.repeat.repeat {
            link.then(&format!(
                "after each reported end, armctl checks the job and starts it again, {count} starts in total"
            ));
        }
        Ok(unknown())
    }
}

/// Rejects repeated starts in a cycle mode in which the job does not end, or ends after each line.
async fn check_cycle(link: &mut Link) -> Result<()> {
    let Some(status) = link.for_purpose("cycle mode").ask(&ReadStatus).await.known()? else {
        return Ok(());
    };
    let why = if status.has(StatusBit::Continuous) {
        "the cycle mode is continuous, so the job does not end"
    } else if status.has(StatusBit::Step) {
        "the cycle mode is step, so each start runs one line"
    } else {
        return Ok(());
    };
    Err(Failure::new(Kind::ConditionNotMet, format!("{why}; no job was started"))
        .hint("set `yerc cycle once`, so that each start runs the job once"))
}

/// Rejects the start if the selected job is not the confirmed job.
fn check_selected(link: &Link, name: &[u8], before: &SelectedJob, now: &SelectedJob) -> Result<()> {
    let shown = |chosen: &SelectedJob| chosen.name(link.encoding).unwrap_or_else(|| "an unknown job".to_owned());
    if !now.is(name) {
        return Err(data_changed(format!(
            "{} is selected now, not {}; no job was started",
            shown(now),
            link.encoding.decode(name)
        )));
    }
    match (before.speed_override(), now.speed_override()) {
        (Some(before), Some(now)) if before != now => {
            Err(data_changed("the speed override changed after the confirmation; no job was started"))
        }
        _ => Ok(()),
    }
}

/// Waits until a started job ends. Returns the duration, and the line at the end.
async fn wait(
    link: &mut Link,
    screen: &Screen,
    limit: Option<Duration>,
    what: &str,
    chosen: &SelectedJob,
) -> Result<(u64, Option<u32>)> {
    let progress = screen.spinner(what);
    let began = Instant::now();
    let mut watch = Watch::new(limit);
    loop {
        let status = link.ask(&ReadStatus).await.map_err(|failure| lost_contact("the job was started", failure))?;
        let look = watch.look(began.elapsed(), status);
        // A short job may end before the first status read. In that case its line has changed.
        if !watch.was_running
            && matches!(look, JobProgress::Running | JobProgress::NeverStarted)
            && has_changed(link, chosen).await?
        {
            break;
        }
        match look {
            JobProgress::Running => {}
            JobProgress::Ended => break,
            JobProgress::Stopped(trouble) => return Err(trouble.failure(link, "the job was started", None).await),
            JobProgress::NeverStarted => return Err(never_started()),
            JobProgress::Timeout(limit) => {
                let message = format!("the job is still running after {}", duration::display(limit));
                return Err(Failure::new(Kind::ConditionNotMet, message)
                    .hint("see `yerc status` and `yerc job show` for the progress; the job continues"));
            }
        }
        if let Some(line) = line(link, screen.can_redraw()).await? {
            progress.print_line(&format!("{what}: {line}"));
        }
        tokio::time::sleep(POLL_INTERVAL).await;
    }
    let elapsed_ms = u64::try_from(began.elapsed().as_millis()).unwrap_or(u64::MAX);
    // The job has certainly ended, even if the controller refuses to report the line.
    let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
    let at = link.ask(&question).await;
    Ok((elapsed_ms, at.ok().map(|job| job.line)))
}

/// Whether the job is at another line than before the start.
async fn has_changed(link: &mut Link, chosen: &SelectedJob) -> Result<bool> {
    let SelectedJob::Job(before) = chosen else { return Ok(false) };
    let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
    let now = link.ask_optional(&question).await.map_err(|failure| lost_contact("the job was started", failure))?;
    Ok(now.is_ok_and(|now| now.name == before.name && now.line != before.line))
}

/// Job and line for the progress display, if there is such a display. A refusal is ignored here.
async fn line(link: &mut Link, is_seen: bool) -> Result<Option<String>> {
    if !is_seen {
        return Ok(None);
    }
    let question = link.by_model(|model| ReadJob::new(model, 0)).await?;
    let answer = link.ask_optional(&question).await.map_err(|failure| lost_contact("the job was started", failure))?;
    let encoding = link.encoding;
    Ok(answer.ok().map(|job| format!("{} line {}", encoding.decode(job.name.as_bytes()), job.line)))
}

fn never_started() -> Failure {
    let message = format!(
        "the start was accepted, but the controller reported no running job within {}: the job ended at once, or did \
         not start",
        duration::display(START_TIMEOUT)
    );
    Failure::new(Kind::ConditionNotMet, message)
        .hint("use `yerc job show` to see the line, and `yerc status` to see what holds the robot")
}

/// Watches a job from its start to its end.
#[derive(Debug)]
pub(super) struct Watch {
    limit: Option<Duration>,
    was_running: bool,
}

/// State of the job, derived from a status.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum JobProgress {
    /// The job is still running.
    Running,
    /// The job has ended.
    Ended,
    /// The job was stopped. Contains the cause.
    Stopped(StandstillCause),
    /// The job was not running in any status read within the time limit.
    NeverStarted,
    /// The job runs longer than the time limit.
    Timeout(Duration),
}

impl Watch {
    pub(super) fn new(limit: Option<Duration>) -> Self {
        Self { limit, was_running: false }
    }

    pub(super) fn look(&mut self, elapsed: Duration, status: ControllerStatus) -> JobProgress {
        self.was_running |= status.running();
        match StandstillCause::of(status) {
            // An error is a message on the pendant. The job may continue.
            Some(StandstillCause::Error) if status.running() => {}
            Some(trouble) => return JobProgress::Stopped(trouble),
            None if self.was_running && !status.running() => return JobProgress::Ended,
            None => {}
        }
        match self.limit {
            _ if !self.was_running && elapsed >= START_TIMEOUT => JobProgress::NeverStarted,
            Some(limit) if elapsed >= limit => JobProgress::Timeout(limit),
            _ => JobProgress::Running,
        }
    }
}

/// Result of a start.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Started {
    /// Whether the controller accepted the start.
    accepted: bool,
    /// The job. Its line is the line at the end of the run. Line 0 is the first line, and the job returns to it at END.
    #[serde(flatten)]
    program: Program,
}

impl Report for Started {
    fn view(&self) -> View {
        View { sections: vec![Section::Fields(self.program.fields(Vec::new()))] }
    }
}

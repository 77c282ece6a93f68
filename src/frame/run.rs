//! Run loop for robot commands: selects the robots, passes the gate, runs the command, prints the report, and repeats.

mod failure_log;
mod print;
mod rounds;
mod several;

use futures_util::StreamExt as _;
use futures_util::stream;

use self::failure_log::FailureLog;
pub use self::print::as_value;
use self::print::{ReportPosition, with_time};
pub use self::rounds::Repeat;
use self::rounds::{Deadline, Rounds};
use super::background;
use super::command::{AnyCommand, AnyContext};
use super::confirmation::{self, Confirmer};
use super::connection::{Access, Connection, ConnectionEffect, FamilyArguments};
use super::dry_run::{DryRun, Plan, is_end};
use super::interrupt::{MotionInProgress, catch_interrupts, interruptible};
use super::report::{AnyReport, Outcome};
use super::script_line::Line;
use super::session_client::{identify, is_held_by_other_process};
use super::shared_session::open_shared_session;
use crate::gate::{Gate, Grant, Intent, OnInterrupt};
use crate::guardian::Guardian;
use crate::output::envelope::Envelope;
use crate::output::jq::{Filter, failure_after_change};
use crate::output::redraw::Redraw;
use crate::prelude::basics::*;
use crate::settings::{Sessions, Sources};

/// Run options of the command line.
#[derive(Debug)]
pub struct Run {
    /// Screen for the output.
    pub screen: Screen,
    /// Robots and their settings.
    pub sources: Sources,
    /// Permissions of the command line.
    pub gate: Gate,
    /// Options for repetition.
    pub repeat: Repeat,
    /// Filter of `--jq`.
    pub filter: Option<Filter>,
    /// Trace file of `--trace`.
    pub trace: Option<PathBuf>,
    /// Context if the command is a line in a REPL or batch.
    pub line: Option<Line>,
    /// What a watch has on the screen.
    pub redraw: Redraw,
    /// Arguments of the family that precede the command.
    pub own: FamilyArguments,
}

/// A failure with the data for its envelope.
#[derive(Debug)]
pub struct RunError {
    /// Failure.
    pub failure: Failure,
    /// Envelope that names robot and command.
    pub envelope: Option<Box<Envelope>>,
    /// Whether the report on stdout already contains the failure. In that case, only the exit code is set.
    pub is_reported: bool,
}

impl From<Failure> for RunError {
    fn from(failure: Failure) -> Self {
        Self { failure, envelope: None, is_reported: false }
    }
}

impl From<anyhow::Error> for RunError {
    fn from(error: anyhow::Error) -> Self {
        Failure::from(error).into()
    }
}

impl RunError {
    /// Failure of a command on a robot.
    pub fn for_robot(robot: &Robot, command: &dyn AnyCommand, failure: Failure) -> Self {
        let envelope = Some(Box::new(Envelope::of(robot, command.id(), Err(failure.clone()))));
        Self { failure, envelope, is_reported: false }
    }
}

/// Default interval between reads.
const DEFAULT_INTERVAL: Duration = Duration::from_secs(1);
/// Maximum number of robots in parallel. It is large enough that a plant with many switched-off robots takes only one
/// timeout, and small enough for a limit of 256 open files.
const MAX_PARALLEL: usize = 128;

/// Connection, and the risk that is granted for it.
type Granted = (Box<dyn Connection>, Grant);

impl Run {
    /// Runs `command` on its robots and prints the reports.
    pub async fn robots(&self, command: &dyn AnyCommand) -> Result<(), RunError> {
        if let Some(outcome) = command.without_robot(&self.screen) {
            return self.local(command.id(), &*outcome?);
        }
        let robots = self.authorize_robots(command).await?;
        if robots.iter().any(|robot| robot.target.value.is_simulated()) && self.line.is_none() {
            self.screen.note_simulator();
        }
        match &robots[..] {
            [robot] if !self.sources.selection.is_plural() => self.run_one(command, robot).await,
            robots => self.run_many(command, robots).await,
        }
    }

    /// Robots for a command, after the command was authorized for all of them.
    pub async fn authorize_robots(&self, command: &dyn AnyCommand) -> Result<Vec<Robot>, RunError> {
        let mut robots = self.select_robots(command)?;
        let asks = |robot: &Robot| {
            let intent = self.intent(command, robot);
            intent.risk == Risk::Motion || intent.confirmation != Confirmation::Question
        };
        if robots.iter().any(asks) {
            // From now on, Ctrl-C (also at a question) ends the command with a message and an exit code. It does not
            // kill the process.
            catch_interrupts();
            for robot in &robots {
                self.check_model(command, robot)
                    .await
                    .map_err(|failure| RunError::for_robot(robot, command, failure))?;
            }
        }
        for robot in &robots {
            let intent = self.intent(command, robot);
            let authorized = confirmation::confirm_intent(self.gate, &self.screen, robot, &intent).await;
            authorized.map_err(|failure| RunError::for_robot(robot, command, failure))?;
        }
        for robot in robots.iter_mut().filter(|robot| self.opens_session(command, robot)) {
            let opened = background::open_session(robot, self.sources.inventory.path.as_deref(), &self.screen).await;
            opened.map_err(|failure| RunError::for_robot(robot, command, failure))?;
            robot.sessions = Sessions::Only;
        }
        self.begin_trace()?;
        Ok(robots)
    }

    /// Runs a command once on [authorized](Self::authorize_robots) robots. Prints no report.
    pub async fn collect(&self, command: &dyn AnyCommand, robots: &[Robot]) -> Vec<Outcome> {
        run_parallel(robots.iter().map(|robot| self.run_once(command, robot))).await
    }

    /// Robots for a command. The command must be valid for them.
    fn select_robots(&self, command: &dyn AnyCommand) -> Result<Vec<Robot>> {
        if command.intent(None).risk > Risk::Read && (self.repeat.is_wanted() || self.repeat.check.is_some()) {
            return Err(Failure::usage("--watch, --count, --until and --check need a command that only reads")
                .hint("run this command once and watch `status` or `position`"));
        }
        if command.moves_until_stopped() && !self.gate.dry_run && !self.screen.can_interrupt() {
            return Err(Failure::usage("this motion needs a limit, because there is no terminal for Ctrl-C")
                .hint("add --for TIME, such as --for 500ms"));
        }
        let mut robots = self.sources.robots(command.family())?;
        self.identify(command, &mut robots)?;
        for robot in &mut robots {
            // If the session ends before the command runs, a direct connection must not be used without confirmation.
            if !self.gate.dry_run && command.connection_effect(robot) == ConnectionEffect::ThroughSession {
                robot.sessions = Sessions::Only;
            }
        }
        if command.is_endless() && robots.len() > MAX_PARALLEL {
            return Err(Failure::usage(format!(
                "at most {MAX_PARALLEL} robots can be watched at a time, not {}",
                robots.len()
            ))
            .hint("select fewer robots with -r or --tag"));
        }
        let intents: Vec<_> = robots.iter().map(|robot| (robot, self.intent(command, robot))).collect();
        Gate::check_named_robots(&intents, |robot| self.sources.selection.is_typed(&robot.name))?;
        Ok(robots)
    }

    /// Resolves the addresses of the robots for which an alias address matters. A dry run sends no request for this.
    fn identify(&self, command: &dyn AnyCommand, robots: &mut [Robot]) -> Result<()> {
        let Some(driver) = command.driver().filter(|_| !self.gate.dry_run) else { return Ok(()) };
        for robot in robots {
            let intent = self.intent(command, robot);
            let changes = intent.risk > Risk::Read && !intent.is_stop;
            match identify(&self.sources, driver, robot, changes) {
                Err(failure) if changes => return Err(failure),
                // For a read or a stop, the identity of the robot does not matter.
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether a session is opened for a command, because the inventory entry of the robot requires it.
    fn opens_session(&self, command: &dyn AnyCommand, robot: &Robot) -> bool {
        let is_wanted = robot.hold.value && !robot.read_only.value && robot.sessions == Sessions::Shared;
        is_wanted
            && !self.gate.dry_run
            && !command.intent(Some(robot)).is_stop
            && matches!(command.connection_effect(robot), ConnectionEffect::Stops(_))
    }

    /// Intent for the gate: the effects of the command and of its connection.
    fn intent(&self, command: &dyn AnyCommand, robot: &Robot) -> Intent {
        let intent = self.own.complete(command.intent(Some(robot)));
        let is_free = self.gate.dry_run || intent.is_stop || self.opens_session(command, robot);
        let entry = if is_free { ConnectionEffect::Harmless } else { command.connection_effect(robot) };
        let ConnectionEffect::Stops(entry) = entry else { return intent };
        // If a command confirms its own action later, this question is only about the connection. Otherwise the action
        // is part of this question.
        let (asks, confirmation) = match intent.confirmation {
            Confirmation::Word(_) => (true, intent.confirmation),
            Confirmation::Question => (intent.risk >= Risk::Destroy, Confirmation::Question),
            Confirmation::WhenKnown => (intent.risk == Risk::Motion, Confirmation::Question),
        };
        let text = if asks { format!("{}, and {entry}", intent.text) } else { entry };
        Intent { risk: Risk::Motion, text, confirmation, ..intent }
    }

    /// Finds rejections for which no question is needed: unknown robots, missing permissions.
    pub fn check_gate(&self, command: &dyn AnyCommand) -> Result<()> {
        if command.driver().is_none() {
            return Ok(());
        }
        let robots = self.select_robots(command)?;
        let mut asked = robots.iter().map(|robot| (robot, self.intent(command, robot)));
        asked.try_for_each(|(robot, intent)| self.gate.must_ask(&self.screen, robot, &intent).map(|_| ()))
    }

    async fn run_one(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<(), RunError> {
        if (self.repeat.is_wanted() || command.is_endless()) && !self.gate.dry_run {
            return self.watch(command, robot, None).await;
        }
        let report =
            self.run_once(command, robot).await.map_err(|failure| RunError::for_robot(robot, command, failure))?;
        let printed = self.print(robot, command.id(), &*report, ReportPosition::Alone);
        self.note_default_robot(command, robot);
        if let Some(failure) = report.failure() {
            // If stdout is closed or full, the failure stays the same.
            let is_reported = printed.is_ok() && self.screen.is_json();
            return Err(RunError { failure, envelope: None, is_reported });
        }
        printed.map_err(|failure| self.mark_unprinted(command.intent(None).risk, failure))?;
        let checked = self.check(&Envelope::of(robot, command.id(), report.data()));
        checked.map_err(|failure| RunError::for_robot(robot, command, failure))
    }

    /// After a stop or a change by a command of all families: says that the command was only for the default robot.
    fn note_default_robot(&self, command: &dyn AnyCommand, robot: &Robot) {
        let intent = command.intent(Some(robot));
        let others = self.sources.inventory.robots.len().saturating_sub(1);
        let is_change = intent.is_stop || intent.risk > Risk::Read;
        if others > 0 && command.family().is_none() && is_change && self.sources.selects_default() {
            let robots = if others == 1 { "robot" } else { "robots" };
            self.screen.note(&format!(
                "only for {}, the default robot; --all includes the other {others} {robots}",
                robot.name
            ));
        }
    }

    /// Evaluates the condition of `--check`.
    fn check(&self, envelopes: &impl Serialize) -> Result<()> {
        let Some(check) = self.repeat.check.as_ref().filter(|_| !self.gate.dry_run) else { return Ok(()) };
        let envelopes = as_value(envelopes)?;
        if check.is_met(&envelopes)? {
            return Ok(());
        }
        let failure = Failure::new(Kind::ConditionNotMet, format!("the condition '{check}' is not met"));
        Err(match check.check_keys(&envelopes) {
            Some(why) => failure.hint(why),
            None => failure,
        })
    }

    /// If the report of a completed action cannot be printed, adds a note to the failure not to repeat the action.
    fn mark_unprinted(&self, risk: Risk, failure: Failure) -> Failure {
        if risk == Risk::Read || failure.kind == Kind::PipeClosed || self.gate.dry_run {
            return failure;
        }
        failure_after_change(failure)
    }

    /// Repeats a read command on one connection. `among` is set if other robots are also watched.
    async fn watch(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        among: Option<ReportPosition<'_>>,
    ) -> Result<(), RunError> {
        let stopped = |failure| RunError::for_robot(robot, command, failure);
        let every = if command.is_endless() { Duration::ZERO } else { DEFAULT_INTERVAL };
        let rounds = Rounds::new(&self.repeat, every);
        let (mut link, _) = match self.connect(command, robot, rounds.deadline()).await {
            Ok(link) => link,
            Err(failure) => {
                let report = command.without_answer(robot, failure).map_err(stopped)?;
                return self.end_unconnected(command, robot, &*report, &rounds);
            }
        };
        let watched = self.watch_over(command, robot, &mut *link, (rounds, among)).await;
        let closed = link.close(&self.screen).await;
        watched?;
        closed.map_err(stopped)
    }

    async fn watch_over(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        (mut rounds, among): (Rounds<'_>, Option<ReportPosition<'_>>),
    ) -> Result<(), RunError> {
        let stopped = |failure| RunError::for_robot(robot, command, failure);
        let mut silences = FailureLog::new(self, robot);
        let mut last = None;
        loop {
            let grant = Grant::up_to(Risk::Read);
            let outcome = self.attempt(command, robot, link, (&grant, rounds.deadline())).await;
            if failure_of(&outcome).is_some_and(|failure| rounds.is_cut(&failure)) {
                break;
            }
            match &outcome {
                Ok(report) => {
                    silences.end();
                    let position = among.unwrap_or_else(|| self.round(rounds.is_first(), command.is_endless()));
                    if !self.repeat.is_quiet {
                        self.print(robot, command.id(), &**report, position)?;
                    }
                    if rounds.is_met(&Envelope::of(robot, command.id(), report.data()), &self.screen)? {
                        return if self.repeat.is_quiet { self.print_last(command, robot, &**report) } else { Ok(()) };
                    }
                }
                // A watch continues while a robot does not answer. Any other failure ends the watch.
                Err(failure)
                    if failure.kind == Kind::NoAnswer && !self.repeat.ends_with(failure, rounds.is_first()) =>
                {
                    if self.repeat.is_quiet {
                        // If the robot still does not answer at the end, the failure is reported then.
                    } else if self.is_for_people() {
                        silences.report(failure);
                    } else {
                        self.emit(with_time(Envelope::of(robot, command.id(), Err(failure.clone()))))?;
                    }
                }
                Err(failure) => return Err(self.interrupted(robot, command, failure.clone())?),
            }
            let ends = self.silence(&outcome).is_some_and(|silence| self.repeat.ends_with(&silence, rounds.is_first()));
            last = Some(outcome);
            if ends || !rounds.next().await.map_err(stopped)? {
                break;
            }
        }
        let Some(last) = last else { return rounds.end().map_err(stopped) };
        match (self.silence(&last), last) {
            (Some(failure), Err(_)) if !self.repeat.is_quiet => {
                Err(RunError { failure, envelope: None, is_reported: true })
            }
            (Some(failure), _) => Err(stopped(failure)),
            (None, last) => {
                if let Ok(report) = last
                    && self.repeat.is_quiet
                {
                    self.print_last(command, robot, &*report)?;
                }
                rounds.end().map_err(stopped)
            }
        }
    }

    /// Ends a watch with a single read, whose time ended before there was a connection.
    fn end_unconnected(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        report: &dyn AnyReport,
        rounds: &Rounds<'_>,
    ) -> Result<(), RunError> {
        let is_met = rounds.is_met(&Envelope::of(robot, command.id(), report.data()), &self.screen)?;
        if is_met || !self.repeat.is_quiet {
            self.print_last(command, robot, report)?;
        }
        if is_met {
            return Ok(());
        }
        let stopped = |failure| Err(RunError::for_robot(robot, command, failure));
        report.failure().map_or_else(|| rounds.end().or_else(stopped), stopped)
    }

    /// Failure of a robot that did not answer, if this failure decides how the watch ends. Without `--until`, a report
    /// can also show the missing answer as a state. Such a report does not end the watch.
    fn silence(&self, outcome: &Outcome) -> Option<Failure> {
        let counts = outcome.is_err() || self.repeat.until.is_some();
        let failure = failure_of(outcome).filter(|failure| counts && failure.kind == Kind::NoAnswer)?;
        (!self.repeat.allows(&failure)).then_some(failure)
    }

    /// Prints the last report of a wait.
    fn print_last(&self, command: &dyn AnyCommand, robot: &Robot, report: &dyn AnyReport) -> Result<(), RunError> {
        Ok(self.print(robot, command.id(), report, ReportPosition::Alone)?)
    }

    /// Failure that ends a watch. In a stream for programs, it is written to stdout in the order of the reports.
    fn interrupted(&self, robot: &Robot, command: &dyn AnyCommand, failure: Failure) -> Result<RunError> {
        // A wait reports only once, like a command without repetition.
        if self.is_for_people() || self.repeat.is_quiet || failure.kind == Kind::Interrupted {
            return Ok(RunError::for_robot(robot, command, failure));
        }
        self.emit(with_time(Envelope::of(robot, command.id(), Err(failure.clone()))))?;
        Ok(RunError { failure, envelope: None, is_reported: true })
    }

    /// Runs the command once, on its own connection.
    async fn run_once(&self, command: &dyn AnyCommand, robot: &Robot) -> Outcome {
        if self.gate.dry_run {
            return Ok(Box::new(DryRun::from(self.plan(command, robot, &self.screen).await?)));
        }
        let (mut link, grant) = self.connect(command, robot, Deadline::NONE).await?;
        let outcome = self.attempt(command, robot, &mut *link, (&grant, Deadline::NONE)).await;
        // The result of the command is more important than the result of its trace.
        let closed = link.close(&self.screen).await;
        let report = outcome?;
        closed.map_err(|failure| Failure { message: format!("succeeded, but {}", failure.message), ..failure })?;
        Ok(report)
    }

    async fn connect(&self, command: &dyn AnyCommand, robot: &Robot, end: Deadline) -> Result<Granted> {
        end.bound(robot, self.connect_unbounded(command, robot)).await
    }

    async fn connect_unbounded(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<Granted> {
        let access = self.access(command, robot);
        let grant = access.grant.clone();
        let access = match &self.line {
            Some(line) => line.connect(robot, access, &self.screen).await?,
            None => access,
        };
        let goes_on = self.repeat.is_wanted() || command.is_endless();
        let robot = &match command.driver().filter(|_| goes_on) {
            Some(driver) => match open_shared_session(driver, robot).await {
                // In a command for all families, a robot that does not answer also has a line in the table.
                Err(failure) if failure.kind == Kind::NoAnswer && driver.family.is_none() => robot.clone(),
                robot => robot?,
            },
            None => robot.clone(),
        };
        let link = interruptible(command.connect(robot, access, &self.screen)).await??;
        Ok((link, grant))
    }

    /// Access to the robot at the start of a command.
    fn access(&self, command: &dyn AnyCommand, robot: &Robot) -> Access {
        Access {
            grant: Grant::up_to(command.intent(Some(robot)).initial_risk()),
            dry_run: self.gate.dry_run,
            trace: self.trace.clone(),
            answers: None,
            mode: command.connect_mode(robot),
            typed: None,
            own: self.own.clone(),
            leaves_motion: self.leaves_motion(command),
            is_stop: command.intent(Some(robot)).is_stop,
            session: None,
        }
    }

    fn context<'a>(
        &'a self,
        command: &dyn AnyCommand,
        robot: &'a Robot,
        connection: &'a mut dyn Connection,
        (screen, grant): (&'a Screen, &Grant),
    ) -> AnyContext<'a> {
        let most = command.intent(Some(robot)).risk;
        let confirmer = Confirmer::new(self.gate, screen, robot, most, grant.clone());
        AnyContext { robot, connection, screen, several: self.sources.selection.is_plural(), confirmer }
    }

    /// Whether a motion continues when this process ends. A jog never continues.
    fn leaves_motion(&self, command: &dyn AnyCommand) -> bool {
        self.gate.on_interrupt == OnInterrupt::Leave && !command.jogs()
    }

    /// Runs the command once, at most until the end of `--for`. If this time ends first, the robot counts as a robot
    /// that does not answer.
    async fn attempt(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        (grant, end): (&Grant, Deadline),
    ) -> Outcome {
        let attempt = async { Ok(self.attempt_guarded(command, robot, link, grant).await) };
        end.bound(robot, attempt).await.unwrap_or_else(|failure| command.without_answer(robot, failure))
    }

    /// Runs the command once. If the robot may move, a guardian is started first.
    async fn attempt_guarded(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        grant: &Grant,
    ) -> Outcome {
        let guardian = self.guardian(command, robot)?;
        let attempt = self.attempt_alone(command, robot, link, grant);
        let Some(guardian) = guardian else { return attempt.await };
        grant.on_motion(guardian.before_motion());
        guardian.guard(attempt).await
    }

    /// Starts a guardian that stops the robot if this process dies or hangs. If a session of another process, or a
    /// fieldbus adapter, detects that the master is missing, this session or adapter stops the robot. In that case, the
    /// guardian only kills a process that hangs.
    fn guardian(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<Option<Guardian>> {
        let intent = command.intent(Some(robot));
        let moves = intent.risk == Risk::Motion && !intent.is_stop && !self.leaves_motion(command);
        let Some(driver) = command.driver().filter(|_| moves && !robot.target.value.is_simulated()) else {
            return Ok(None);
        };
        let stops = command.connection_effect(robot) == ConnectionEffect::Harmless && !is_held_by_other_process(robot);
        Guardian::start(robot, driver.stop, stops).map(Some)
    }

    /// Runs the command once. Ctrl-C during a motion first stops the robot.
    async fn attempt_alone(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        grant: &Grant,
    ) -> Outcome {
        let Intent { risk, is_stop, .. } = command.intent(Some(robot));
        let _under_way =
            (risk == Risk::Motion && !is_stop && !robot.target.value.is_simulated()).then(MotionInProgress::begin);
        let context = self.context(command, robot, link, (&self.screen, grant));
        match interruptible(command.run(context)).await {
            Ok(outcome) => outcome,
            Err(_) if risk == Risk::Motion && (self.gate.on_interrupt == OnInterrupt::Stop || link.needs_halt()) => {
                Err(match link.halt().await {
                    Ok(done) => Failure::new(Kind::Interrupted, done),
                    Err(failure) => Failure::new(Kind::Interrupted, format!("the robot may still move: {failure}"))
                        .hint("use the pendant or the emergency stop if the robot must not move"),
                })
            }
            Err(interrupt) if risk == Risk::Motion => Err(Failure {
                message: format!("{}: not stopped; the motion or program continues", interrupt.message),
                ..interrupt
            }),
            Err(interrupt) if risk > Risk::Read => Err(Failure {
                message: format!("{}; the command may have been executed completely or in part", interrupt.message),
                ..interrupt
            }
            .hint("read the values that this command writes before you repeat the command")),
            Err(interrupt) => Err(interrupt),
        }
    }

    /// Frames that `command` would send. The command runs to its end on a link that records the frames and has no
    /// answers.
    async fn plan(&self, command: &dyn AnyCommand, robot: &Robot, screen: &Screen) -> Result<Plan> {
        let access = Access { dry_run: true, ..self.access(command, robot) };
        let grant = access.grant.clone();
        let mut link = command.connect(robot, access, screen).await?;
        let gate = Gate { dry_run: true, ..self.gate };
        let several = self.sources.selection.is_plural();
        let confirmer = Confirmer::new(gate, screen, robot, command.intent(Some(robot)).risk, grant);
        let ended = command.run(AnyContext { robot, connection: &mut *link, screen, several, confirmer }).await;
        match ended {
            Err(failure) if !is_end(&failure) => Err(failure),
            Ok(_) | Err(_) => Ok(link.planned()),
        }
    }

    /// Checks whether the controller model supports the command. This check comes before any question, so that the user
    /// does not clear a cell for a mistyped command. Simulators are not checked: they need no question, and may have
    /// another model than the model in the settings.
    async fn check_model(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<()> {
        if self.gate.dry_run || robot.target.value.is_simulated() {
            return Ok(());
        }
        self.plan(command, robot, &self.screen.silenced()).await.map(|_| ())
    }

    /// Truncates the `--trace` file. Every connection of this command appends to it. With several lines, only the first
    /// line truncates the file.
    pub fn begin_trace(&self) -> Result<()> {
        begin_trace(self.trace.as_deref().filter(|_| !self.gate.dry_run && self.line.is_none()))
    }
}

/// Failure of a robot, or of its report.
fn failure_of(outcome: &Outcome) -> Option<Failure> {
    outcome.as_ref().map_or_else(|failure| Some(failure.clone()), |report| report.failure())
}

/// Truncates the `--trace` file. `-` is not a file.
pub fn begin_trace(file: Option<&Path>) -> Result<()> {
    if let Some(path) = file.filter(|path| path.as_os_str() != "-") {
        std::fs::File::create(path).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Runs the work of all robots with limited parallelism, and returns the results in their order. A slow robot delays
/// only itself.
async fn run_parallel<T>(work: impl Iterator<Item = impl Future<Output = T>>) -> Vec<T> {
    let numbered = work.enumerate().map(|(number, work)| async move { (number, work.await) });
    let mut done: Vec<(usize, T)> = stream::iter(numbered).buffer_unordered(MAX_PARALLEL).collect().await;
    done.sort_unstable_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, came)| came).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn runs_robots_in_parallel() {
        // Half of the robots do not answer, as in a plant with switched-off robots. They are mixed with the robots that
        // answer.
        let silent = |robot: usize| robot.is_multiple_of(2);
        let ask = |robot| async move {
            tokio::time::sleep(Duration::from_millis(if silent(robot) { 2000 } else { 10 })).await;
            robot
        };
        let start = tokio::time::Instant::now();
        let robots = run_parallel((0..200).map(ask)).await;
        assert!(robots.is_sorted() && robots.len() == 200);
        assert!(start.elapsed() < Duration::from_millis(2100), "{:?}", start.elapsed());
    }
}

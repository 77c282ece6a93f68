//! The one loop that every robot command goes through: choose robots, pass the gate, run, report, repeat.

mod print;
mod rounds;
mod several;
mod silences;

use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::Context as _;
use futures_util::StreamExt as _;
use futures_util::stream;
use serde::Serialize;
use tokio::time::timeout_at;

pub use self::print::as_value;
use self::print::{ReportPosition, timed};
pub use self::rounds::Repeat;
use self::rounds::Rounds;
use self::silences::Silences;
use super::attach::{identify, is_held_by_another};
use super::authority::{self, Authority};
use super::background;
use super::command::{AnyCommand, AnyContext};
use super::connection::{Access, Connection, Entry, Own};
use super::dry_run::{DryRun, Plan, is_end};
use super::interrupt::{UnderWay, catch_interrupts, interruptible};
use super::report::Outcome;
use super::script_line::Line;
use super::share::shared;
use crate::controller::Risk;
use crate::failure::{Failure, Kind};
use crate::gate::{Confirmation, Gate, Grant, Intent, OnInterrupt};
use crate::guardian::Guardian;
use crate::output::Screen;
use crate::output::envelope::Envelope;
use crate::output::jq::{Filter, after_a_change};
use crate::output::redraw::Redraw;
use crate::settings::{Robot, Sessions, Sources};

/// What the command line says about how to run a command.
#[derive(Debug)]
pub struct Run {
    /// Where to write.
    pub screen: Screen,
    /// Which robots, and their settings.
    pub sources: Sources,
    /// What is allowed.
    pub gate: Gate,
    /// How often.
    pub repeat: Repeat,
    /// `--jq`.
    pub filter: Option<Filter>,
    /// `--trace`.
    pub trace: Option<PathBuf>,
    /// What is around it, where it is one of several lines.
    pub line: Option<Line>,
    /// What a watch has on the screen.
    pub redraw: Redraw,
    /// What was typed between the word of a family and the command.
    pub own: Own,
}

/// A failure on its way to stderr, with what the envelope needs to know.
#[derive(Debug)]
pub struct RunError {
    /// What happened.
    pub failure: Failure,
    /// To whom, in doing what.
    pub envelope: Option<Box<Envelope>>,
    /// The report on stdout tells it already: only the exit code is left.
    pub told: bool,
}

impl From<Failure> for RunError {
    fn from(failure: Failure) -> Self {
        Self { failure, envelope: None, told: false }
    }
}

impl From<anyhow::Error> for RunError {
    fn from(error: anyhow::Error) -> Self {
        Failure::from(error).into()
    }
}

impl RunError {
    /// The failure of a command on a robot.
    pub fn at(robot: &Robot, command: &dyn AnyCommand, failure: Failure) -> Self {
        let envelope = Some(Box::new(Envelope::of(robot, command.id(), Err(failure.clone()))));
        Self { failure, envelope, told: false }
    }
}

/// Pause between runs where only a condition or a count is given.
const EVERY: Duration = Duration::from_secs(1);
/// Robots talked to at the same time: enough that a plant of which half is switched off takes one wait for an answer, and
/// no more than the files that a process may have open where that is least, 256.
const PARALLEL: usize = 128;

/// A connection, and what may pass.
type Granted = (Box<dyn Connection>, Grant);

impl Run {
    /// Runs `command` on the robots it is for, and reports.
    pub async fn robots(&self, command: &dyn AnyCommand) -> Result<(), RunError> {
        if let Some(outcome) = command.without_robot(&self.screen) {
            return self.local(command.id(), &*outcome?);
        }
        let robots = self.ready(command).await?;
        if robots.iter().any(|robot| robot.target.value.is_simulated()) && self.line.is_none() {
            self.screen.note_simulator();
        }
        match &robots[..] {
            [robot] if !self.sources.selection.is_plural() => self.one(command, robot).await,
            robots => self.many(command, robots).await,
        }
    }

    /// The robots that a command is for, once it may run on all of them.
    pub async fn ready(&self, command: &dyn AnyCommand) -> Result<Vec<Robot>, RunError> {
        let mut robots = self.chosen(command)?;
        let asks = |robot: &Robot| {
            let intent = self.intent(command, robot);
            intent.risk == Risk::Motion || intent.confirmation != Confirmation::Question
        };
        if robots.iter().any(asks) {
            // From here on Ctrl-C, at a question too, ends in a message and an exit code instead of a killed process.
            catch_interrupts();
            for robot in &robots {
                self.check_model(command, robot).await.map_err(|failure| RunError::at(robot, command, failure))?;
            }
        }
        for robot in &robots {
            let intent = self.intent(command, robot);
            let passed = authority::pass(self.gate, &self.screen, robot, &intent).await;
            passed.map_err(|failure| RunError::at(robot, command, failure))?;
        }
        for robot in robots.iter_mut().filter(|robot| self.opens_session(command, robot)) {
            let opened = background::open_for(robot, self.sources.inventory.path.as_deref(), &self.screen).await;
            opened.map_err(|failure| RunError::at(robot, command, failure))?;
            robot.sessions = Sessions::Only;
        }
        self.begin_trace()?;
        Ok(robots)
    }

    /// Runs a command once on robots that are [`ready`](Self::ready), and reports nothing.
    pub async fn gather(&self, command: &dyn AnyCommand, robots: &[Robot]) -> Vec<Outcome> {
        at_a_time(robots.iter().map(|robot| self.once(command, robot))).await
    }

    /// The robots that a command is for, if it can be for these.
    fn chosen(&self, command: &dyn AnyCommand) -> Result<Vec<Robot>, Failure> {
        if command.intent(None).risk > Risk::Read && (self.repeat.is_wanted() || self.repeat.check.is_some()) {
            return Err(Failure::usage("--watch, --count, --until and --check are for commands that only read")
                .hint("run this command once, and watch `status` or `position`"));
        }
        if command.moves_until_stopped() && !self.gate.dry_run && !self.screen.can_interrupt() {
            return Err(Failure::usage("nothing would end this motion: there is no terminal for Ctrl-C")
                .hint("add --for TIME, such as --for 500ms"));
        }
        let mut robots = self.sources.robots(command.family())?;
        self.identify(command, &mut robots)?;
        for robot in &mut robots {
            // A session that ends meanwhile must not leave the way that nobody was asked about.
            if !self.gate.dry_run && command.entry(robot) == Entry::ThroughSession {
                robot.sessions = Sessions::Only;
            }
        }
        if command.is_endless() && robots.len() > PARALLEL {
            return Err(Failure::usage(format!("this watches {PARALLEL} robots at a time, not {}", robots.len()))
                .hint("choose some with -r or --tag"));
        }
        let intents: Vec<_> = robots.iter().map(|robot| (robot, self.intent(command, robot))).collect();
        Gate::pass_many(&intents, |robot| self.sources.selection.is_typed(&robot.name))?;
        Ok(robots)
    }

    /// Finds out which robots have another address that counts. A dry run sends nothing for that.
    fn identify(&self, command: &dyn AnyCommand, robots: &mut [Robot]) -> Result<(), Failure> {
        let Some(driver) = command.driver().filter(|_| !self.gate.dry_run) else { return Ok(()) };
        for robot in robots {
            let intent = self.intent(command, robot);
            let changes = intent.risk > Risk::Read && !intent.is_stop;
            match identify(&self.sources, driver, robot, changes) {
                Err(failure) if changes => return Err(failure),
                // A robot that is only read, or stopped, need not be told from others.
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether a session is to be opened for what a command does, because the robot's entry says so.
    fn opens_session(&self, command: &dyn AnyCommand, robot: &Robot) -> bool {
        let is_wanted = robot.hold.value && !robot.read_only.value && robot.sessions == Sessions::Shared;
        is_wanted
            && !self.gate.dry_run
            && !command.intent(Some(robot)).is_stop
            && matches!(command.entry(robot), Entry::Stops(_))
    }

    /// What the gate is told of a command for a robot: what it does, and what its connection does.
    fn intent(&self, command: &dyn AnyCommand, robot: &Robot) -> Intent {
        let intent = self.own.complete(command.intent(Some(robot)));
        let is_free = self.gate.dry_run || intent.is_stop || self.opens_session(command, robot);
        let entry = if is_free { Entry::Harmless } else { command.entry(robot) };
        let Entry::Stops(entry) = entry else { return intent };
        // What asks by itself, later, says then what it does; whatever else needs a yes says it in this question.
        let (asks, confirmation) = match intent.confirmation {
            Confirmation::Word(_) => (true, intent.confirmation),
            Confirmation::Question => (intent.risk >= Risk::Destroy, Confirmation::Question),
            Confirmation::WhenKnown => (intent.risk == Risk::Motion, Confirmation::Question),
        };
        let text = if asks { format!("{}, and {entry}", intent.text) } else { entry };
        Intent { risk: Risk::Motion, text, confirmation, ..intent }
    }

    /// Finds what is refused without asking anybody: robots that are not there, a gate that stays closed.
    pub fn check_gate(&self, command: &dyn AnyCommand) -> Result<(), Failure> {
        if command.driver().is_none() {
            return Ok(());
        }
        let robots = self.chosen(command)?;
        let mut asked = robots.iter().map(|robot| (robot, self.intent(command, robot)));
        asked.try_for_each(|(robot, intent)| self.gate.must_ask(&self.screen, robot, &intent).map(|_| ()))
    }

    async fn one(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<(), RunError> {
        if (self.repeat.is_wanted() || command.is_endless()) && !self.gate.dry_run {
            return self.watch(command, robot, None).await;
        }
        let report = self.once(command, robot).await.map_err(|failure| RunError::at(robot, command, failure))?;
        let printed = self.print(robot, command.id(), &*report, ReportPosition::Alone);
        if let Some(failure) = report.failure() {
            // A reader that went away, or a full disk behind stdout, does not turn a failure into something else.
            let told = printed.is_ok() && self.screen.is_json();
            return Err(RunError { failure, envelope: None, told });
        }
        printed.map_err(|failure| self.unprinted(command.intent(None).risk, failure))?;
        let checked = self.check(&Envelope::of(robot, command.id(), report.data()));
        checked.map_err(|failure| RunError::at(robot, command, failure))
    }

    /// Whether what `--check` asks for holds.
    fn check(&self, envelopes: &impl Serialize) -> Result<(), Failure> {
        let Some(check) = self.repeat.check.as_ref().filter(|_| !self.gate.dry_run) else { return Ok(()) };
        let envelopes = as_value(envelopes)?;
        if check.holds(&envelopes)? {
            return Ok(());
        }
        let failure = Failure::new(Kind::ConditionNotMet, format!("the condition '{check}' is not met"));
        Err(match check.never(&envelopes) {
            Some(why) => failure.hint(why),
            None => failure,
        })
    }

    /// A failure to report what was done: nobody should do it again for that.
    fn unprinted(&self, risk: Risk, failure: Failure) -> Failure {
        if risk == Risk::Read || failure.kind == Kind::PipeClosed || self.gate.dry_run {
            return failure;
        }
        after_a_change(failure)
    }

    /// Repeats a reading command over one connection; `among` stands where other robots are watched beside this one.
    async fn watch(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        among: Option<ReportPosition<'_>>,
    ) -> Result<(), RunError> {
        let stopped = |failure| RunError::at(robot, command, failure);
        let (mut link, _) = self.connect(command, robot).await.map_err(stopped)?;
        let watched = self.watch_over(command, robot, &mut *link, among).await;
        let closed = link.close(&self.screen).await;
        watched?;
        closed.map_err(stopped)
    }

    async fn watch_over(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        among: Option<ReportPosition<'_>>,
    ) -> Result<(), RunError> {
        let stopped = |failure| RunError::at(robot, command, failure);
        let mut silences = Silences::new(self, robot);
        let mut rounds = Rounds::new(&self.repeat, if command.is_endless() { Duration::ZERO } else { EVERY });
        loop {
            let grant = Grant::of(Risk::Read);
            let attempt = self.attempt(command, robot, link, &grant);
            let attempted = match rounds.deadline().filter(|_| command.is_endless()) {
                Some(deadline) => timeout_at(deadline, attempt).await,
                None => Ok(attempt.await),
            };
            let Ok(outcome) = attempted else { return rounds.end().map_err(stopped) };
            let silence = match outcome {
                Ok(report) => {
                    silences.end();
                    let place = among.unwrap_or_else(|| self.round(rounds.is_first(), command.is_endless()));
                    if !self.repeat.is_quiet {
                        self.print(robot, command.id(), &*report, place)?;
                    }
                    let is_met = rounds.is_met(&Envelope::of(robot, command.id(), report.data()), &self.screen)?;
                    if self.repeat.is_quiet && (is_met || rounds.is_last()) {
                        self.print(robot, command.id(), &*report, ReportPosition::Alone)?;
                    }
                    if is_met {
                        return Ok(());
                    }
                    None
                }
                // A robot that is silent for a while is what one watches for; anything else ends the watch.
                Err(failure) if failure.kind == Kind::NoAnswer => {
                    if self.repeat.is_quiet {
                        // It is told at the end, if it is silent then.
                    } else if self.is_for_people() {
                        silences.say(&failure);
                    } else {
                        self.emit(timed(Envelope::of(robot, command.id(), Err(failure.clone()))))?;
                    }
                    Some(failure)
                }
                Err(failure) => return Err(self.broken_off(robot, command, failure)?),
            };
            if !rounds.next().await.map_err(stopped)? {
                return match silence {
                    Some(failure) if self.repeat.is_quiet => Err(stopped(failure)),
                    Some(failure) => Err(RunError { failure, envelope: None, told: true }),
                    None => rounds.end().map_err(stopped),
                };
            }
        }
    }

    /// A failure that ends a watch: in a stream for programs it stands in its place on stdout.
    fn broken_off(&self, robot: &Robot, command: &dyn AnyCommand, failure: Failure) -> Result<RunError, Failure> {
        if self.is_for_people() || failure.kind == Kind::Interrupted {
            return Ok(RunError::at(robot, command, failure));
        }
        self.emit(timed(Envelope::of(robot, command.id(), Err(failure.clone()))))?;
        Ok(RunError { failure, envelope: None, told: true })
    }

    /// One connection, one run.
    async fn once(&self, command: &dyn AnyCommand, robot: &Robot) -> Outcome {
        if self.gate.dry_run {
            return Ok(Box::new(DryRun::from(self.plan(command, robot, &self.screen).await?)));
        }
        let (mut link, grant) = self.connect(command, robot).await?;
        let outcome = self.attempt(command, robot, &mut *link, &grant).await;
        // What became of the command is worth more than what became of the record of it.
        let closed = link.close(&self.screen).await;
        let report = outcome?;
        closed.map_err(|failure| Failure { message: format!("it was done, but {}", failure.message), ..failure })?;
        Ok(report)
    }

    async fn connect(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<Granted, Failure> {
        let access = self.access(command, robot);
        let grant = access.granted.clone();
        let access = match &self.line {
            Some(line) => line.connecting(robot, access, &self.screen).await?,
            None => access,
        };
        let goes_on = self.repeat.is_wanted() || command.is_endless();
        let robot = &match command.driver().filter(|_| goes_on) {
            Some(driver) => match shared(driver, robot).await {
                // Without a family in common, a robot that is not there has a line as well.
                Err(failure) if failure.kind == Kind::NoAnswer && driver.family().is_none() => robot.clone(),
                robot => robot?,
            },
            None => robot.clone(),
        };
        let link = interruptible(command.connect(robot, access, &self.screen)).await??;
        Ok((link, grant))
    }

    /// How a command may use its link when it begins.
    fn access(&self, command: &dyn AnyCommand, robot: &Robot) -> Access {
        Access {
            granted: Grant::of(command.intent(Some(robot)).granted_at_first()),
            dry_run: self.gate.dry_run,
            trace: self.trace.clone(),
            mode: command.connect_mode(robot),
            typed: None,
            own: self.own.clone(),
            leaves_motion: self.leaves_motion(command),
            is_stop: command.intent(Some(robot)).is_stop,
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
        let authority = Authority::new(self.gate, screen, robot, most, grant.clone());
        AnyContext { robot, connection, screen, several: self.sources.selection.is_plural(), authority }
    }

    /// Whether what a command sets in motion goes on when this process ends. A jog never does.
    fn leaves_motion(&self, command: &dyn AnyCommand) -> bool {
        self.gate.on_interrupt == OnInterrupt::Leave && !command.jogs()
    }

    /// One run, with a guardian where the robot may move.
    async fn attempt(
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

    /// What stops the robot when this process dies or hangs: the guardian, a session of another process, or the adapter of
    /// a fieldbus, which misses its master. For those the guardian only ends a process that hangs.
    fn guardian(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<Option<Guardian>, Failure> {
        let intent = command.intent(Some(robot));
        let moves = intent.risk == Risk::Motion && !intent.is_stop && !self.leaves_motion(command);
        let Some(driver) = command.driver().filter(|_| moves && !robot.target.value.is_simulated()) else {
            return Ok(None);
        };
        let stops = command.entry(robot) == Entry::Harmless && !is_held_by_another(robot);
        Guardian::start(robot, driver.stop(), stops).map(Some)
    }

    /// One run. Ctrl-C during a motion stops the robot first.
    async fn attempt_alone(
        &self,
        command: &dyn AnyCommand,
        robot: &Robot,
        link: &mut dyn Connection,
        grant: &Grant,
    ) -> Outcome {
        let Intent { risk, is_stop, .. } = command.intent(Some(robot));
        let _under_way = (risk == Risk::Motion && !is_stop && !robot.target.value.is_simulated()).then(UnderWay::begin);
        let context = self.context(command, robot, link, (&self.screen, grant));
        match interruptible(command.run(context)).await {
            Ok(outcome) => outcome,
            Err(_) if risk == Risk::Motion && (self.gate.on_interrupt == OnInterrupt::Stop || link.must_halt()) => {
                Err(match link.halt().await {
                    Ok(done) => Failure::new(Kind::Interrupted, done),
                    Err(failure) => Failure::new(Kind::Interrupted, format!("the robot may still move: {failure}"))
                        .hint("use the pendant or the emergency stop if it must not"),
                })
            }
            Err(interrupt) if risk == Risk::Motion => Err(Failure {
                message: format!("{}: left as it is; what was started goes on", interrupt.message),
                ..interrupt
            }),
            Err(interrupt) if risk > Risk::Read => Err(Failure {
                message: format!("{}; what was sent may have been done, in whole or in part", interrupt.message),
                ..interrupt
            }
            .hint("look before you repeat it, with the command that reads what this one writes")),
            Err(interrupt) => Err(interrupt),
        }
    }

    /// What `command` would send: it runs to its end against a link that takes notes and has no answers.
    async fn plan(&self, command: &dyn AnyCommand, robot: &Robot, screen: &Screen) -> Result<Plan, Failure> {
        let access = Access { dry_run: true, ..self.access(command, robot) };
        let grant = access.granted.clone();
        let mut link = command.connect(robot, access, screen).await?;
        let gate = Gate { dry_run: true, ..self.gate };
        let several = self.sources.selection.is_plural();
        let authority = Authority::new(gate, screen, robot, command.intent(Some(robot)).risk, grant);
        let ended = command.run(AnyContext { robot, connection: &mut *link, screen, several, authority }).await;
        match ended {
            Err(failure) if !is_end(&failure) => Err(failure),
            Ok(_) | Err(_) => Ok(link.planned()),
        }
    }

    /// Finds before anybody is asked what this controller's model cannot do: nobody should clear a cell for a mistyped
    /// command. Simulators ask nobody, and may be of another model than their settings say.
    async fn check_model(&self, command: &dyn AnyCommand, robot: &Robot) -> Result<(), Failure> {
        if self.gate.dry_run || robot.target.value.is_simulated() {
            return Ok(());
        }
        self.plan(command, robot, &self.screen.silenced()).await.map(|_| ())
    }

    /// Empties the file of `--trace`, to which every connection of this command then appends. Of several lines the first
    /// one has done it.
    pub fn begin_trace(&self) -> Result<(), Failure> {
        begin_trace(self.trace.as_deref().filter(|_| !self.gate.dry_run && self.line.is_none()))
    }
}

/// Empties the file of `--trace`; `-` is none.
pub fn begin_trace(file: Option<&Path>) -> Result<(), Failure> {
    if let Some(path) = file.filter(|path| path.as_os_str() != "-") {
        std::fs::File::create(path).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

/// Does the work of all robots, of so many at the same time, and gives what came of it in their order. One that waits long
/// holds up nobody but itself.
async fn at_a_time<T>(work: impl Iterator<Item = impl Future<Output = T>>) -> Vec<T> {
    let numbered = work.enumerate().map(|(number, work)| async move { (number, work.await) });
    let mut done: Vec<(usize, T)> = stream::iter(numbered).buffer_unordered(PARALLEL).collect().await;
    done.sort_unstable_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, came)| came).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_fleet_takes_as_long_as_its_slowest() {
        // As many as half a plant that is switched off do not answer, here and there among the others.
        let silent = |robot: usize| robot.is_multiple_of(2);
        let ask = |robot| async move {
            tokio::time::sleep(Duration::from_millis(if silent(robot) { 2000 } else { 10 })).await;
            robot
        };
        let start = tokio::time::Instant::now();
        let robots = at_a_time((0..200).map(ask)).await;
        assert!(robots.is_sorted() && robots.len() == 200);
        assert!(start.elapsed() < Duration::from_millis(2100), "{:?}", start.elapsed());
    }
}

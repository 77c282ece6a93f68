//! Wait for the end of work that the controller accepted: a return to origin, a program, a transfer of the memory card.

use tokio::time::Instant;

use super::position::Coordinates;
use super::refusal;
use crate::prelude::*;
pub(super) use armctl_client::toyo::status_page;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::table::Command;
use armctl_frame::output::progress::Progress;

/// Interval between two reads of the status.
pub(super) const POLL_INTERVAL: Duration = Duration::from_millis(100);
/// Time limit for the controller to show that accepted work began. If the status does not show the work within this
/// time, the work ended before the first read.
const START_TIMEOUT: Duration = Duration::from_secs(1);
/// Number of status reads per read of the current step and of the inputs that it waits for.
const READS_PER_STEP_READ: u32 = 5;
/// Maximum number of consecutive refused reads: two seconds with a busy controller.
const MAX_REFUSALS: u32 = 20;
/// Maximum number of reads until the axes have come to rest: two seconds.
const MAX_READS_TO_REST: u32 = 20;

/// Type of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Work {
    /// A return to origin.
    Home,
    /// Search for the origin of synchronized axes.
    Search,
    /// The execution of a program or of a move.
    Program,
    /// A transfer from or to the memory card.
    Card,
}

/// Work that the controller accepted.
#[derive(Debug, Clone, Copy)]
pub(super) struct AcceptedWork {
    /// Type of work.
    pub work: Work,
    /// Command that started the work.
    pub order: Command,
    /// Sentence about the acceptance, such as `the return to origin was accepted`.
    pub done: &'static str,
    /// Sentence during the work, such as `the axes return to the origin`.
    pub doing: &'static str,
}

/// Result at the end of the work.
#[derive(Debug)]
pub(super) struct End {
    /// Final position; `None` if the work moves nothing.
    pub coordinates: Option<Coordinates>,
    /// Time in ms from acceptance to end; `None` if the work ended before the first read.
    pub elapsed_ms: Option<u64>,
    /// Whether the program is paused and can continue.
    pub is_paused: bool,
}

impl AcceptedWork {
    /// Waits for the end. The progress display uses the letters of the axes. A dry run records the requests.
    ///
    /// # Errors
    /// [`Kind::ConditionNotMet`] if the work did not complete, [`Kind::OutcomeUnknown`] if the connection was lost.
    pub(super) async fn wait(self, link: &mut Link, screen: &Screen, letters: Letters) -> Result<End> {
        if link.is_dry_run() {
            self.plan(link);
            return Err(unknown());
        }
        let mut reporter = ProgressReporter::new(self.doing, screen);
        let began = Instant::now();
        let mut work_state = WorkState::new(self.work);
        let (mut reads, mut refusals) = (0_u32, 0);
        loop {
            let next = Instant::now() + POLL_INTERVAL;
            reads = reads.wrapping_add(1);
            match self.read_state(link, &mut reporter, reads.is_multiple_of(READS_PER_STEP_READ)).await {
                Ok((status, record)) => {
                    refusals = 0;
                    let coordinates = record.as_ref().map(|record| Coordinates::of(record, letters));
                    match work_state.evaluate(began.elapsed(), status, record) {
                        // Before that, the status can still be the status from before the start.
                        WorkEvent::Running if !work_state.has_started => {}
                        WorkEvent::Running => reporter.report(status, coordinates),
                        WorkEvent::Ended => {
                            link.end_motion();
                            let elapsed_ms = u64::try_from(began.elapsed().as_millis()).unwrap_or(u64::MAX);
                            let elapsed_ms = work_state.has_started.then_some(elapsed_ms);
                            return Ok(End { coordinates, elapsed_ms, is_paused: status.paused() });
                        }
                        WorkEvent::Failed(reason) => {
                            let coordinates = wait_for_rest(link, coordinates, letters).await;
                            link.end_motion();
                            return Err(self.failed(link, reason, coordinates).await);
                        }
                    }
                }
                Err(failure) if failure.kind == Kind::Refused && refusals < MAX_REFUSALS => refusals += 1,
                Err(failure) => return Err(self.lost(failure)),
            }
            tokio::time::sleep_until(next).await;
        }
    }

    /// Reads status and position. At intervals, also reads the step and its wait condition.
    async fn read_state(
        self,
        link: &mut Link,
        reporter: &mut ProgressReporter,
        is_thorough: bool,
    ) -> Result<(Status, Option<Record>)> {
        let status = link.status_of(self.pages()).await?;
        if status.paused() || (is_thorough && self.work == Work::Program) {
            reporter.inputs = link.status_of(&[4]).await?.inputs;
            reporter.step = step(link).await?.map_or(String::new(), |(number, text)| format!("step {number} {text}"));
        }
        let coordinates = if self.work == Work::Card { None } else { Some(link.read_position().await?) };
        Ok((Status { inputs: reporter.inputs, ..status }, coordinates))
    }

    /// Pages of the status to read. The page with the error bit is last, so that an error that ends the work is not
    /// missed.
    const fn pages(self) -> &'static [u8] {
        if matches!(self.work, Work::Card) { &[3, 0] } else { &[0] }
    }

    fn plan(self, link: &mut Link) {
        for page in self.pages() {
            link.plan(&status_page(*page), "every 100 ms until the command has ended");
        }
        if self.work != Work::Card {
            link.plan(&position_request(), "every 100 ms until the command has ended: position of the axes");
        }
        if self.work == Work::Program {
            let about = Reason::about(
                "every 500 ms until the command has ended: current step, and whether the step waits for an input",
            );
            for request in [status_page(4), steps::read_request(0)] {
                link.plan_depending(&request.text(), about.depending_on("duration of the command"));
            }
        }
        link.plan_if(&status_page(1), "whether an error occurs");
    }

    /// Failure: the work did not complete.
    async fn failed(self, link: &mut Link, reason: WaitFailure, coordinates: Option<Coordinates>) -> Failure {
        let coordinates =
            coordinates.map(|coordinates| format!("; the axes are at {}", coordinates.in_a_line())).unwrap_or_default();
        let fail = |what: &str| Failure::new(Kind::ConditionNotMet, format!("{}, but {what}{coordinates}", self.done));
        match reason {
            WaitFailure::Error => explain_present_error(link, &fail).await,
            WaitFailure::NoOrigin => fail("the status shows no origin after the end of the command")
                .hint("check why the machine stopped without an error; then repeat `toyo home`"),
            WaitFailure::NeverStarted => Failure {
                kind: Kind::OutcomeUnknown,
                ..fail("the status never showed that the controller executed the command")
            }
            .hint("check `toyo status` and the robot: the execution ended at once, or it did not begin"),
            WaitFailure::NoStart => fail("the status did not show the start").hint(
                "keep clear of the robot, because the motion can still begin; check `toyo status` and the teach \
                 pendant",
            ),
        }
    }

    /// Failure: the connection was lost. The accepted work continues.
    fn lost(self, failure: Failure) -> Failure {
        let message = format!("{}, but its result is unknown: {}", self.done, failure.message);
        Failure { kind: Kind::OutcomeUnknown, message, ..failure }
            .hint(format!("do not send the command again; {}", refusal::verification_hint(self.order)))
    }
}

/// Failure for the present error. `fail` creates the failure from the text of the error.
pub(super) async fn explain_present_error(link: &mut Link, fail: &impl Fn(&str) -> Failure) -> Failure {
    match link.status_of(&[1]).await {
        Ok(Status { error: errors::NONE, .. }) => {
            fail("an error occurred and was cancelled").hint("use `toyo alarm history` to look for the error")
        }
        Ok(Status { error: code, .. }) => {
            let error = errors::explain(code);
            fail(&format!("an error occurred ({})", error.in_a_line()))
                .hint(format!("{}; see `armctl explain toyo {code:02X}`", refusal::cure(error.remedy)))
                .code(format!("{code:02X}"))
        }
        Err(failure) => fail(&format!("an error occurred, but its code could not be read: {}", failure.message))
            .hint("use `toyo alarm list` to see the error"),
    }
}

/// Position at rest of axes that are being stopped. If the position cannot be read, returns the last known position.
async fn wait_for_rest(link: &mut Link, last_position: Option<Coordinates>, letters: Letters) -> Option<Coordinates> {
    let mut last = last_position?;
    for _ in 0..MAX_READS_TO_REST {
        tokio::time::sleep(POLL_INTERVAL).await;
        let Ok(record) = link.read_position().await else { break };
        let current = Coordinates::of(&record, letters);
        let is_at_rest = current == last;
        last = current;
        if is_at_rest {
            break;
        }
    }
    Some(last)
}

/// Reads the current step and its number; `None` if the controller does not report the step.
pub(super) async fn step(link: &mut Link) -> Result<Option<(i32, String)>> {
    let Ok(record) = steps::numbered(link, 0).await? else { return Ok(None) };
    let text = record.text("text").unwrap_or_default().to_owned();
    Ok(record.number("step").map(|number| (number, text)))
}

/// Waits up to a second until the status meets the condition, and returns whether it does. A dry run records the
/// request.
pub(super) async fn wait_for_status(
    link: &mut Link,
    (page, about): (u8, &str),
    condition: impl Fn(Status) -> bool,
) -> Result<bool> {
    if link.is_dry_run() {
        link.plan(&status_page(page), &format!("every 100 ms, at most 1s: {about}"));
        return Err(unknown());
    }
    let until = Instant::now() + START_TIMEOUT;
    loop {
        let is_late = Instant::now() >= until;
        match link.status_of(&[page]).await {
            Ok(status) if condition(status) => return Ok(true),
            Ok(_) if is_late => return Ok(false),
            Err(failure) if is_late || failure.kind != Kind::Refused => {
                let message = format!("the command was accepted, but its result is unknown: {}", failure.message);
                return Err(Failure { kind: Kind::OutcomeUnknown, message, ..failure }
                    .hint("use `toyo status` to see the state of the controller"));
            }
            _ => tokio::time::sleep(POLL_INTERVAL).await,
        }
    }
}

pub(super) fn position_request() -> Request {
    Request::bare(Command::Mpst)
}

/// Progress output. On a terminal it is continuous; otherwise it is printed only when the work halts.
struct ProgressReporter {
    doing: &'static str,
    progress: Progress,
    screen: Screen,
    /// Inputs page of the status, as it was read last.
    inputs: u8,
    step: String,
    halted: Option<&'static str>,
}

impl ProgressReporter {
    fn new(doing: &'static str, screen: &Screen) -> Self {
        let (progress, step) = (screen.spinner(doing), String::new());
        Self { doing, progress, screen: *screen, inputs: 0, step, halted: None }
    }

    fn report(&mut self, status: Status, coordinates: Option<Coordinates>) {
        let halted = match (status.paused(), status.waits_for_input()) {
            (true, _) => Some("paused"),
            (_, true) => Some("waiting for an input"),
            _ => None,
        };
        let coordinates = coordinates.map(|coordinates| coordinates.in_a_line()).unwrap_or_default();
        self.progress.print_line(&format!("{} {coordinates} {}", halted.unwrap_or(self.doing), self.step));
        if halted != self.halted {
            self.halted = halted;
            if let Some(halted) = halted {
                self.screen.step(format!("{halted} {}", self.step).trim_end());
            }
        }
    }
}

/// State of the work that is watched, from its acceptance to its end.
#[derive(Debug)]
struct WorkState {
    work: Work,
    /// Whether a read of the status has shown the work.
    has_started: bool,
    last: Option<Record>,
}

/// Result of one read.
#[derive(Debug, PartialEq, Eq)]
enum WorkEvent {
    /// The work continues.
    Running,
    /// The work has ended.
    Ended,
    /// The work did not complete.
    Failed(WaitFailure),
}

/// Why work does not complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WaitFailure {
    /// An error occurred.
    Error,
    /// The return to origin has ended, but the origin is unknown.
    NoOrigin,
    /// The status did not show that the return to the origin began.
    NoStart,
    /// The status did not show the work. The work may have ended before the first read.
    NeverStarted,
}

impl WorkState {
    fn new(work: Work) -> Self {
        Self { work, has_started: false, last: None }
    }

    /// Evaluates one read. The position was read after the status, so it is final when the status shows no execution.
    /// The status can show the start late, and may not show short work at all.
    fn evaluate(&mut self, elapsed: Duration, status: Status, coordinates: Option<Record>) -> WorkEvent {
        let moves = self.last.is_some() && self.last != coordinates;
        self.last = coordinates;
        if status.has_error() {
            return WorkEvent::Failed(WaitFailure::Error);
        }
        let busy = match self.work {
            Work::Card => status.card_reading() || status.card_writing(),
            _ => moves || status.executing() || status.homing(),
        };
        // A pause by an input ends without a command. A stop ends only with a command.
        if busy || (status.paused() && status.pause_input()) {
            self.has_started = true;
            return WorkEvent::Running;
        }
        let is_over = self.has_started || elapsed >= START_TIMEOUT;
        match (self.work, self.has_started) {
            _ if !is_over => WorkEvent::Running,
            (Work::Home, true) if !status.homed() => WorkEvent::Failed(WaitFailure::NoOrigin),
            (Work::Home, false) if !status.homed() => WorkEvent::Failed(WaitFailure::NoStart),
            // If a program is paused at a STOP, it has run.
            (Work::Program, false) if !status.paused() => WorkEvent::Failed(WaitFailure::NeverStarted),
            _ => WorkEvent::Ended,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const IDLE: u8 = 0x30;
    const RUNS: u8 = 0x32;

    fn at(hundredths: i32) -> Record {
        let axis = |of| Value::Number(if of == 0 { hundredths } else { 0 });
        Command::Mpst.row().answers[0].record((0..4).map(axis).collect()).unwrap()
    }

    fn page0(state: u8) -> Status {
        Status::default().with(0, state)
    }

    fn evaluate_reads<const N: usize>(work: Work, reads: [(u64, Status, i32); N]) -> WorkEvent {
        let mut work_state = WorkState::new(work);
        let events = reads.map(|(ms, status, coordinates)| {
            work_state.evaluate(Duration::from_millis(ms), status, Some(at(coordinates)))
        });
        let [earlier @ .., last] = &events[..] else { panic!("one read at least") };
        assert!(earlier.iter().all(|event| *event == WorkEvent::Running), "{events:?}");
        match last {
            WorkEvent::Running => WorkEvent::Running,
            WorkEvent::Ended => WorkEvent::Ended,
            WorkEvent::Failed(reason) => WorkEvent::Failed(*reason),
        }
    }

    #[test]
    fn a_late_start_is_awaited() {
        let (idle, runs) = (page0(IDLE), page0(RUNS));
        assert_eq!(
            evaluate_reads(Work::Program, [(0, idle, 0), (900, idle, 0), (950, runs, 0), (999_999, runs, 0)]),
            WorkEvent::Running
        );
        assert_eq!(evaluate_reads(Work::Program, [(0, idle, 0), (100, runs, 0), (200, idle, 0)]), WorkEvent::Ended);
        assert_eq!(evaluate_reads(Work::Program, [(0, idle, 0), (999, idle, 0)]), WorkEvent::Running);
    }

    #[test]
    fn work_that_never_started_has_not_ended() {
        let idle = page0(IDLE);
        assert_eq!(
            evaluate_reads(Work::Program, [(0, idle, 0), (1000, idle, 0)]),
            WorkEvent::Failed(WaitFailure::NeverStarted)
        );
        assert_eq!(evaluate_reads(Work::Home, [(0, idle, 0), (1000, idle, 0)]), WorkEvent::Ended);
        assert_eq!(
            evaluate_reads(Work::Home, [(0, page0(0x20), 0), (1000, page0(0x20), 0)]),
            WorkEvent::Failed(WaitFailure::NoStart)
        );
    }

    #[test]
    fn moving_axes_count_as_running() {
        let idle = page0(IDLE);
        assert_eq!(evaluate_reads(Work::Search, [(0, idle, 0), (100, idle, 5), (5000, idle, 6)]), WorkEvent::Running);
        assert_eq!(evaluate_reads(Work::Search, [(0, idle, 0), (100, idle, 5), (200, idle, 5)]), WorkEvent::Ended);
    }

    #[test]
    fn a_return_to_origin_ends_with_the_origin() {
        let homing = page0(0x0A);
        assert_eq!(
            evaluate_reads(Work::Home, [(0, homing, 0), (100, page0(0x30), 1), (200, page0(0x30), 1)]),
            WorkEvent::Ended
        );
        assert_eq!(
            evaluate_reads(Work::Home, [(0, homing, 0), (100, page0(0x20), 0)]),
            WorkEvent::Failed(WaitFailure::NoOrigin)
        );
    }

    #[test]
    fn an_error_ends_the_wait() {
        assert_eq!(
            evaluate_reads(Work::Program, [(0, page0(RUNS), 0), (100, page0(RUNS | 1), 0)]),
            WorkEvent::Failed(WaitFailure::Error)
        );
    }

    #[test]
    fn the_pause_input_continues_the_wait_and_a_stop_ends_it() {
        let paused = page0(IDLE | 4);
        let paused_by_input = paused.with(4, 0x08);
        assert_eq!(
            evaluate_reads(
                Work::Program,
                [(0, page0(RUNS), 0), (100, paused_by_input, 0), (9_999, paused_by_input, 0)]
            ),
            WorkEvent::Running
        );
        assert_eq!(evaluate_reads(Work::Program, [(0, page0(RUNS), 0), (100, paused, 0)]), WorkEvent::Ended);
    }

    #[test]
    fn a_card_transfer_is_watched_by_the_card_bits() {
        let (idle, writes) = (page0(IDLE), page0(IDLE).with(3, 0x80));
        assert_eq!(
            evaluate_reads(Work::Card, [(0, idle, 0), (100, writes, 0), (9_999, writes, 3)]),
            WorkEvent::Running
        );
        assert_eq!(evaluate_reads(Work::Card, [(0, writes, 0), (100, idle, 0)]), WorkEvent::Ended);
    }
}

//! Waiting for the end of what a controller has accepted: a return to origin, a program, a transfer of its memory card.

use std::time::Duration;

use tokio::time::Instant;

use super::link::Link;
use super::position::Coordinates;
use super::program::steps;
use super::refusal;
use crate::client::toyo::Letters;
pub(super) use crate::client::toyo::status_page;
use crate::command::frame::dry_run::{Reason, unknown};
use crate::controller::toyo::errors;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table::Command;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::progress::Progress;

/// From one look at the status to the next.
pub(super) const LOOK_EVERY: Duration = Duration::from_millis(100);
/// How long a controller may take to show that it began what it has accepted. What was not seen by then was over before
/// the first look.
const BEGIN_WITHIN: Duration = Duration::from_secs(1);
/// A step and what it waits for are asked at every so many looks.
const STEP_EVERY: u32 = 5;
/// Looks that a busy controller may refuse in a row, two seconds.
const MOST_REFUSED: u32 = 20;
/// Looks that axes get to come to rest, two seconds.
const LOOKS_TO_REST: u32 = 20;

/// What is waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Work {
    /// A return to origin.
    Home,
    /// The search for the origin of synchronized axes.
    Search,
    /// Anything that runs steps.
    Program,
    /// A transfer from or to the memory card.
    Card,
}

/// Work that the controller has accepted.
#[derive(Debug, Clone, Copy)]
pub(super) struct Accepted {
    /// What.
    pub work: Work,
    /// The order.
    pub order: Command,
    /// In a sentence: `the return to origin was accepted`.
    pub done: &'static str,
    /// While it goes on: `the axes return to the origin`.
    pub doing: &'static str,
}

/// How it ended.
#[derive(Debug)]
pub(super) struct End {
    /// Where the axes stand; `None` where nothing moves.
    pub place: Option<Coordinates>,
    /// From the acceptance to the end; `None` if it was over before the first look.
    pub elapsed_ms: Option<u64>,
    /// Whether it stands at a stop, and can go on.
    pub is_paused: bool,
}

impl Accepted {
    /// Waits for the end, with the letters of the axes for what is told. A dry run notes what is asked meanwhile.
    ///
    /// # Errors
    /// [`Kind::ConditionNotMet`] if it did not get to its end, [`Kind::OutcomeUnknown`] if contact was lost.
    pub(super) async fn wait(self, link: &mut Link, screen: &Screen, letters: Letters) -> Result<End, Failure> {
        if link.is_dry() {
            self.plan(link);
            return Err(unknown());
        }
        let mut teller = Teller::new(self.doing, screen);
        let began = Instant::now();
        let mut watch = Watch::new(self.work);
        let (mut looks, mut refused) = (0_u32, 0);
        loop {
            let next = Instant::now() + LOOK_EVERY;
            looks = looks.wrapping_add(1);
            match self.look(link, &mut teller, looks.is_multiple_of(STEP_EVERY)).await {
                Ok((status, record)) => {
                    refused = 0;
                    let place = record.as_ref().map(|record| Coordinates::of(record, letters));
                    match watch.look(began.elapsed(), status, record) {
                        // Until it was seen, the status may be that of before.
                        Look::Running if !watch.seen => {}
                        Look::Running => teller.tell(status, place),
                        Look::Ended => {
                            link.has_ended();
                            let elapsed_ms = u64::try_from(began.elapsed().as_millis()).unwrap_or(u64::MAX);
                            let elapsed_ms = watch.seen.then_some(elapsed_ms);
                            return Ok(End { place, elapsed_ms, is_paused: status.paused() });
                        }
                        Look::Failed(trouble) => {
                            let place = resting_place(link, place, letters).await;
                            link.has_ended();
                            return Err(self.failed(link, trouble, place).await);
                        }
                    }
                }
                Err(failure) if failure.kind == Kind::Refused && refused < MOST_REFUSED => refused += 1,
                Err(failure) => return Err(self.lost(failure)),
            }
            tokio::time::sleep_until(next).await;
        }
    }

    /// Status and place; now and then the step, and what it waits for.
    async fn look(
        self,
        link: &mut Link,
        teller: &mut Teller,
        is_thorough: bool,
    ) -> Result<(Status, Option<Record>), Failure> {
        let status = link.status_of(self.pages()).await?;
        if status.paused() || (is_thorough && self.work == Work::Program) {
            teller.inputs = link.status_of(&[4]).await?.inputs;
            teller.step = step(link).await?.map_or(String::new(), |(number, text)| format!("step {number} {text}"));
        }
        let place = if self.work == Work::Card { None } else { Some(link.place().await?) };
        Ok((Status { inputs: teller.inputs, ..status }, place))
    }

    /// Errors are asked for last: one that ends the work is not missed.
    const fn pages(self) -> &'static [u8] {
        if matches!(self.work, Work::Card) { &[3, 0] } else { &[0] }
    }

    fn plan(self, link: &mut Link) {
        for page in self.pages() {
            link.plan(&status_page(*page), "every 100 ms until it has ended");
        }
        if self.work != Work::Card {
            link.plan(&position(), "every 100 ms until it has ended: where the axes are");
        }
        if self.work == Work::Program {
            let about = Reason::about("now and then until it has ended: whether it waits for an input, and which step");
            for request in [status_page(4), steps::read_request(0)] {
                link.plan_depending(&request.text(), about.depending_on("how long it takes"));
            }
        }
        link.plan_if(&status_page(1), "whether an error comes up");
    }

    /// What kept it from its end.
    async fn failed(self, link: &mut Link, trouble: WaitFailure, place: Option<Coordinates>) -> Failure {
        let place = place.map(|place| format!("; it stands at {}", place.in_a_line())).unwrap_or_default();
        let tell = |what: &str| Failure::new(Kind::ConditionNotMet, format!("{}, but {what}{place}", self.done));
        match trouble {
            WaitFailure::Error => present_error(link, &tell).await,
            WaitFailure::NoOrigin => tell("it ended without the origin").hint(
                "somebody or something stopped it without an error: look at the machine, then repeat `toyo home`",
            ),
            WaitFailure::NotSeen => Failure { kind: Kind::OutcomeUnknown, ..tell("it was not seen to run") }
                .hint("it was over before the first look, or it never began: look at `toyo status` and at the robot"),
            WaitFailure::NotBegun => tell("it was not seen to begin")
                .hint("it may still begin: keep clear, and look at `toyo status` and the teach pendant"),
        }
    }

    /// Contact lost: what was accepted goes on unseen.
    fn lost(self, failure: Failure) -> Failure {
        let message = format!("{}, but its end was not seen: {}", self.done, failure.message);
        Failure { kind: Kind::OutcomeUnknown, message, ..failure }
            .hint(format!("do not send it again: {}", refusal::verification_hint(self.order)))
    }
}

/// The error that is present, as a failure that `tell` words.
pub(super) async fn present_error(link: &mut Link, tell: &impl Fn(&str) -> Failure) -> Failure {
    match link.status_of(&[1]).await {
        Ok(Status { error: errors::NONE, .. }) => {
            tell("an error came up and is gone again").hint("`toyo alarm history` may tell which")
        }
        Ok(Status { error: code, .. }) => {
            let error = errors::explain(code);
            tell(&format!("an error came up ({})", error.in_a_line()))
                .hint(refusal::cure(error.remedy))
                .code(format!("{code:02X}"))
        }
        Err(failure) => tell(&format!("an error came up, which could not be read: {}", failure.message))
            .hint("`toyo alarm list` tells which"),
    }
}

/// Where axes that are being stopped come to rest; where they were seen last if they cannot be asked.
async fn resting_place(link: &mut Link, seen: Option<Coordinates>, letters: Letters) -> Option<Coordinates> {
    let mut last = seen?;
    for _ in 0..LOOKS_TO_REST {
        tokio::time::sleep(LOOK_EVERY).await;
        let Ok(record) = link.place().await else { break };
        let here = Coordinates::of(&record, letters);
        let is_at_rest = here == last;
        last = here;
        if is_at_rest {
            break;
        }
    }
    Some(last)
}

/// The current step with its number, unless the controller does not tell.
pub(super) async fn step(link: &mut Link) -> Result<Option<(i32, String)>, Failure> {
    let Ok(record) = steps::numbered(link, 0).await? else { return Ok(None) };
    let text = record.text("text").unwrap_or_default().to_owned();
    Ok(record.number("step").map(|number| (number, text)))
}

/// Whether the status becomes as it was ordered, within a second. A dry run notes the question.
pub(super) async fn becomes(
    link: &mut Link,
    (page, about): (u8, &str),
    is_so: impl Fn(Status) -> bool,
) -> Result<bool, Failure> {
    if link.is_dry() {
        link.plan(&status_page(page), &format!("every 100 ms until it is so, at most 1s: {about}"));
        return Err(unknown());
    }
    let until = Instant::now() + BEGIN_WITHIN;
    loop {
        let is_late = Instant::now() >= until;
        match link.status_of(&[page]).await {
            Ok(status) if is_so(status) => return Ok(true),
            Ok(_) if is_late => return Ok(false),
            Err(failure) if is_late || failure.kind != Kind::Refused => {
                let message = format!("the order was accepted, but what came of it was not seen: {}", failure.message);
                return Err(Failure { kind: Kind::OutcomeUnknown, message, ..failure }
                    .hint("`toyo status` tells how the controller stands"));
            }
            _ => tokio::time::sleep(LOOK_EVERY).await,
        }
    }
}

pub(super) fn position() -> Request {
    Request::bare(Command::Mpst)
}

/// Says how it goes: all the time on a terminal, elsewhere when it comes to a halt.
struct Teller {
    doing: &'static str,
    progress: Progress,
    screen: Screen,
    /// As they were asked last.
    inputs: u8,
    step: String,
    halted: Option<&'static str>,
}

impl Teller {
    fn new(doing: &'static str, screen: &Screen) -> Self {
        let (progress, step) = (screen.spinner(doing), String::new());
        Self { doing, progress, screen: *screen, inputs: 0, step, halted: None }
    }

    fn tell(&mut self, status: Status, place: Option<Coordinates>) {
        let halted = match (status.paused(), status.waits_for_input()) {
            (true, _) => Some("paused"),
            (_, true) => Some("waiting for an input"),
            _ => None,
        };
        let place = place.map(|place| place.in_a_line()).unwrap_or_default();
        self.progress.say(&format!("{} {place} {}", halted.unwrap_or(self.doing), self.step));
        if halted != self.halted {
            self.halted = halted;
            if let Some(halted) = halted {
                self.screen.step(format!("{halted} {}", self.step).trim_end());
            }
        }
    }
}

/// Watches work from its acceptance to its end.
#[derive(Debug)]
struct Watch {
    work: Work,
    seen: bool,
    last: Option<Record>,
}

/// What a look says.
#[derive(Debug, PartialEq, Eq)]
enum Look {
    /// Look again.
    Running,
    /// It has ended.
    Ended,
    /// It did not get to its end.
    Failed(WaitFailure),
}

/// What keeps work from its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum WaitFailure {
    /// An error is present.
    Error,
    /// A return to origin is over, and the origin is not known.
    NoOrigin,
    /// Nothing of it was seen.
    NotBegun,
    /// Nothing of it was seen, and it may have been over before the first look.
    NotSeen,
}

impl Watch {
    fn new(work: Work) -> Self {
        Self { work, seen: false, last: None }
    }

    /// The place was read after the status: once the status says that nothing is executed, it is the last one. The
    /// start may show late, and work that is over before the first look may not show at all.
    fn look(&mut self, elapsed: Duration, status: Status, place: Option<Record>) -> Look {
        let moves = self.last.is_some() && self.last != place;
        self.last = place;
        if status.has_error() {
            return Look::Failed(WaitFailure::Error);
        }
        let busy = match self.work {
            Work::Card => status.card_reading() || status.card_writing(),
            _ => moves || status.executing() || status.homing(),
        };
        // A pause ends by itself; a stop does not.
        if busy || (status.paused() && status.pause_input()) {
            self.seen = true;
            return Look::Running;
        }
        let is_over = self.seen || elapsed >= BEGIN_WITHIN;
        match (self.work, self.seen) {
            _ if !is_over => Look::Running,
            (Work::Home, true) if !status.homed() => Look::Failed(WaitFailure::NoOrigin),
            (Work::Home, false) if !status.homed() => Look::Failed(WaitFailure::NotBegun),
            // Where it is paused at a stop, it has run.
            (Work::Program, false) if !status.paused() => Look::Failed(WaitFailure::NotSeen),
            _ => Look::Ended,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::toyo::field::Value;

    const IDLE: u8 = 0x30;
    const RUNS: u8 = 0x32;

    fn at(hundredths: i32) -> Record {
        let axis = |of| Value::Number(if of == 0 { hundredths } else { 0 });
        Command::Mpst.row().answers[0].record((0..4).map(axis).collect()).unwrap()
    }

    fn page0(state: u8) -> Status {
        Status::default().with(0, state)
    }

    fn looks<const N: usize>(work: Work, looks: [(u64, Status, i32); N]) -> Look {
        let mut watch = Watch::new(work);
        let looks = looks.map(|(ms, status, place)| watch.look(Duration::from_millis(ms), status, Some(at(place))));
        let [before @ .., last] = &looks[..] else { panic!("one look at least") };
        assert!(before.iter().all(|look| *look == Look::Running), "{looks:?}");
        match last {
            Look::Running => Look::Running,
            Look::Ended => Look::Ended,
            Look::Failed(trouble) => Look::Failed(*trouble),
        }
    }

    #[test]
    fn a_start_may_show_late() {
        let (idle, runs) = (page0(IDLE), page0(RUNS));
        assert_eq!(
            looks(Work::Program, [(0, idle, 0), (900, idle, 0), (950, runs, 0), (999_999, runs, 0)]),
            Look::Running
        );
        assert_eq!(looks(Work::Program, [(0, idle, 0), (100, runs, 0), (200, idle, 0)]), Look::Ended);
        assert_eq!(looks(Work::Program, [(0, idle, 0), (999, idle, 0)]), Look::Running);
    }

    #[test]
    fn what_was_never_seen_has_not_ended() {
        let idle = page0(IDLE);
        assert_eq!(looks(Work::Program, [(0, idle, 0), (1000, idle, 0)]), Look::Failed(WaitFailure::NotSeen));
        assert_eq!(looks(Work::Home, [(0, idle, 0), (1000, idle, 0)]), Look::Ended);
        assert_eq!(
            looks(Work::Home, [(0, page0(0x20), 0), (1000, page0(0x20), 0)]),
            Look::Failed(WaitFailure::NotBegun)
        );
    }

    #[test]
    fn axes_that_move_are_not_at_the_end_whatever_the_bits_say() {
        let idle = page0(IDLE);
        assert_eq!(looks(Work::Search, [(0, idle, 0), (100, idle, 5), (5000, idle, 6)]), Look::Running);
        assert_eq!(looks(Work::Search, [(0, idle, 0), (100, idle, 5), (200, idle, 5)]), Look::Ended);
    }

    #[test]
    fn a_return_to_origin_ends_with_the_origin() {
        let homing = page0(0x0A);
        assert_eq!(looks(Work::Home, [(0, homing, 0), (100, page0(0x30), 1), (200, page0(0x30), 1)]), Look::Ended);
        assert_eq!(looks(Work::Home, [(0, homing, 0), (100, page0(0x20), 0)]), Look::Failed(WaitFailure::NoOrigin));
    }

    #[test]
    fn an_error_ends_the_waiting() {
        assert_eq!(
            looks(Work::Program, [(0, page0(RUNS), 0), (100, page0(RUNS | 1), 0)]),
            Look::Failed(WaitFailure::Error)
        );
    }

    #[test]
    fn a_pause_input_holds_and_a_stop_ends() {
        let paused = page0(IDLE | 4);
        let held = paused.with(4, 0x08);
        assert_eq!(looks(Work::Program, [(0, page0(RUNS), 0), (100, held, 0), (9_999, held, 0)]), Look::Running);
        assert_eq!(looks(Work::Program, [(0, page0(RUNS), 0), (100, paused, 0)]), Look::Ended);
    }

    #[test]
    fn a_card_is_watched_by_its_own_bits() {
        let (idle, writes) = (page0(IDLE), page0(IDLE).with(3, 0x80));
        assert_eq!(looks(Work::Card, [(0, idle, 0), (100, writes, 0), (9_999, writes, 3)]), Look::Running);
        assert_eq!(looks(Work::Card, [(0, writes, 0), (100, idle, 0)]), Look::Ended);
    }
}

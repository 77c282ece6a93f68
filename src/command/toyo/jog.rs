//! `toyo jog`: motion of one axis for a time or by inching steps. The stop is always sent at the end.

use std::convert::Infallible;
use std::fmt;
use std::sync::mpsc::{self, Sender};
use std::time::Duration;

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;
use tokio::time::{Instant, sleep, sleep_until, timeout_at};

use super::link::Toyo;
use super::link::{Link, Moving, jog};
use super::position::{Coordinates, UNIT, titled};
use super::refusal;
use super::values::machine;
use super::waiting::{LOOK_EVERY, position, present_error, status_page};
use crate::client::toyo::Letters;
use crate::command::frame::dry_run::Reason;
use crate::command::robot::motion::Motion;
use crate::command::robot::position::Position;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::request::Request;
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation};
use crate::output::Screen;
use crate::output::view::{Cell, View};
use crate::settings::duration;

/// Jog one axis, and stop it (TO 2-7, 3-2).
///
/// The controller has no dead man's switch. This command stops the axis after its time, after an error or a lost
/// answer, and at Ctrl-C, Ctrl-\ and Ctrl-Z. If it is killed or frozen, its guardian stops the axis. If the computer
/// fails or sleeps, or the cable is unplugged, the axis continues: keep the emergency stop at hand. Afterwards use
/// `toyo stop --jog`.
#[derive(Debug, Args)]
pub struct Jog {
    /// Axis, by its letter on the teach pendant or its number
    #[arg(value_name = "X|Y|Z|R|1-4", value_parser = axis)]
    axis: Axis,
    /// Direction
    direction: Direction,
    /// Speed: high, low, or inching steps (parameter P12)
    speed: Speed,
    /// Duration, 100ms to 60s (high and low)
    #[arg(long = "for", value_name = "TIME", value_parser = hold, required_if_eq_any([("speed", "low"), ("speed", "high")]))]
    within: Option<Duration>,
    /// Number of inching steps
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100), conflicts_with = "within")]
    steps: Option<u8>,
}

/// An axis as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Axis {
    /// By its index, 0 to 3, regardless of its letter.
    Place(usize),
    /// By its letter on the teach pendant (E01).
    Letter(String),
}

/// Possible letters (TO 2-4, E01).
const LETTERS: [&str; 4] = ["X", "Y", "Z", "R"];

fn axis(text: &str) -> Result<Axis, String> {
    if let Some(place) = ["1", "2", "3", "4"].iter().position(|number| *number == text) {
        return Ok(Axis::Place(place));
    }
    let letter = LETTERS.iter().find(|letter| letter.eq_ignore_ascii_case(text));
    letter.map(|letter| Axis::Letter((*letter).to_owned())).ok_or_else(|| "axes are X, Y, Z, R or 1 to 4".to_owned())
}

impl Axis {
    /// Index of the axis, 0 to 3, on a machine with these letters.
    fn place(&self, letters: Letters) -> Result<usize, Failure> {
        match self {
            Self::Place(place) => Ok(*place),
            Self::Letter(letter) => letters.axis(letter).ok_or_else(|| {
                Failure::usage(format!("the axis of {letter} is unknown: {}", machine(&letters)))
                    .hint("type the number of the axis, 1 to 4; `toyo param get axis-letters` shows the letters")
            }),
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Place(place) => write!(f, "{}", place + 1),
            Self::Letter(letter) => f.write_str(letter),
        }
    }
}

/// An axis of this machine.
#[derive(Debug, Clone)]
struct Known {
    /// Index, 0 to 3.
    index: usize,
    letters: Letters,
}

impl Known {
    /// `2 (Z)`; the number alone if the controller reports no letter.
    fn in_words(&self) -> String {
        match self.letters.of(self.index) {
            "" => (self.index + 1).to_string(),
            letter => format!("{} ({letter})", self.index + 1),
        }
    }

    fn of(&self, place: &Coordinates) -> f64 {
        place.mm()[self.index]
    }
}

/// Direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Direction {
    /// Plus
    #[value(name = "+", alias = "plus")]
    Plus,
    /// Minus
    #[value(name = "-", alias = "minus")]
    Minus,
}

/// Speed of a jog.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Speed {
    /// At the high speed of parameters P08 to P11
    High,
    /// At the low speed of parameters P08 to P11
    Low,
    /// By inching steps (parameter P12)
    Inch,
}

/// A jog takes at least the time of an answer, and at most the time that a person can watch it.
const SHORTEST: Duration = Duration::from_millis(100);
const LONGEST: Duration = Duration::from_secs(60);

fn hold(text: &str) -> Result<Duration, String> {
    let time = duration::parse(text)?;
    if (SHORTEST..=LONGEST).contains(&time) {
        return Ok(time);
    }
    Err(format!("a jog takes {} to {}", duration::display(SHORTEST), duration::display(LONGEST)))
}

/// Time limit for the begin of a step.
const BEGIN_WITHIN: Duration = Duration::from_secs(1);
/// Time after which an axis at the lowest speed has moved.
const AT_REST: Duration = Duration::from_millis(500);
/// Interval between two reads during a step.
const STEP_LOOK_EVERY: Duration = Duration::from_millis(20);
/// Limit of refused reads in a row while an axis moves.
const MOST_REFUSED: u32 = 3;

/// Early end of a motion.
#[derive(Debug)]
enum Cut {
    /// The command was refused.
    Refused,
    /// An error occurred.
    Error,
    /// Another failure.
    Failed(Failure),
}

impl From<Failure> for Cut {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Jog {
    /// Word of the protocol for this motion.
    const fn word(&self) -> &'static str {
        match (self.direction, self.speed) {
            (Direction::Plus, Speed::High) => "+H",
            (Direction::Plus, Speed::Low) => "+L",
            (Direction::Plus, Speed::Inch) => "+C",
            (Direction::Minus, Speed::High) => "-H",
            (Direction::Minus, Speed::Low) => "-L",
            (Direction::Minus, Speed::Inch) => "-C",
        }
    }

    fn order(&self, axis: &Known) -> Request {
        jog(self.word(), Some(axis.index))
    }

    /// Records all requests from the jog command on. The number of an axis is known after the letters were read.
    fn plan(&self, link: &mut Link) {
        link.plan(&position(), "position before the jog");
        let steps = self.steps.unwrap_or(1);
        let about = match self.within {
            Some(time) => format!("then {} pass", duration::display(time)),
            None if steps > 1 => format!("{steps} times, each after the axis stands still"),
            None => "once".to_owned(),
        };
        match &self.axis {
            Axis::Place(place) => link.plan(&jog(self.word(), Some(*place)), &about),
            Axis::Letter(letter) => {
                let about = format!("{} for axis {letter}, SP for the others; {about}", self.word());
                let reason = Reason::about(&about).depending_on("letters of the axes");
                link.plan_depending("@JGST X=? Y=? Z=? R=?", reason);
            }
        }
        link.plan(&status_page(0), "until the stop: whether there is an error");
        link.plan(&position(), "until the stop: position");
    }

    /// Text after "This will …".
    fn in_words(&self, axis: &str) -> String {
        let way = if self.direction == Direction::Plus { "plus" } else { "minus" };
        match (self.speed, self.within) {
            (Speed::High, Some(time)) => {
                format!("move axis {axis} fast in {way} direction for {}", duration::display(time))
            }
            (_, Some(time)) => format!("move axis {axis} slowly in {way} direction for {}", duration::display(time)),
            (_, None) => match self.steps {
                None | Some(1) => format!("move axis {axis} by an inching step in {way} direction"),
                Some(steps) => format!("move axis {axis} by {steps} inching steps in {way} direction"),
            },
        }
    }

    /// Moves for the time or by all steps. Returns the number of completed steps.
    async fn go(&self, link: &mut Link, live: &Live, axis: &Known, start: Coordinates) -> Result<u8, Cut> {
        let Some(time) = self.within else { return self.inch(link, live, axis, start).await };
        link.use_short_timeouts();
        let until = Instant::now() + time;
        let mut is_accepted = false;
        match timeout_at(until, self.hold(link, live, axis, (start, until), &mut is_accepted)).await {
            Ok(Err(cut)) => Err(cut),
            Err(_) if is_accepted => Ok(0),
            Err(_) => Err(Cut::Failed(Failure::new(Kind::OutcomeUnknown, "the jog command was not answered in time"))),
        }
    }

    /// Moves without an end and watches the axis.
    async fn hold(
        &self,
        link: &mut Link,
        live: &Live,
        axis: &Known,
        (start, until): (Coordinates, Instant),
        is_accepted: &mut bool,
    ) -> Result<Infallible, Cut> {
        let began = Instant::now();
        link.try_ask(&self.order(axis)).await?.map_err(|_| Cut::Refused)?;
        *is_accepted = true;
        // One read of the state is two requests.
        let mut longest = 2 * began.elapsed();
        let mut watch = Watch { start, last: start, was_busy: false, since: Instant::now() };
        loop {
            let began = Instant::now();
            if began + longest > until {
                // No request must be pending when the stop is sent.
                return std::future::pending().await;
            }
            let (is_busy, place) = look(link, axis).await?;
            if watch.has_come_to_rest(is_busy, place) {
                let message = "the axis stopped early: another client stopped it";
                return Err(Cut::Failed(Failure::new(Kind::ConditionNotMet, message)));
            }
            live.say(format!("jogging {}", place.in_a_line()));
            longest = longest.max(began.elapsed());
            sleep_until(began + LOOK_EVERY.max(longest)).await;
        }
    }

    /// Moves by inching steps, each after the axis stands still.
    async fn inch(&self, link: &mut Link, live: &Live, axis: &Known, start: Coordinates) -> Result<u8, Cut> {
        let steps = self.steps.unwrap_or(1);
        let mut last = start;
        for step in 1..=steps {
            last = self.step(link, axis, last).await.map_err(|cut| match cut {
                Cut::Failed(failure) => {
                    Cut::Failed(Failure { message: format!("step {step} of {steps}: {}", failure.message), ..failure })
                }
                cut => cut,
            })?;
            live.say(format!("step {step} of {steps} {}", last.in_a_line()));
        }
        Ok(steps)
    }

    /// Moves by one inching step, and returns the position afterwards.
    async fn step(&self, link: &mut Link, axis: &Known, start: Coordinates) -> Result<Coordinates, Cut> {
        link.try_ask(&self.order(axis)).await?.map_err(|_| Cut::Refused)?;
        let (mut last, began) = (start, Instant::now());
        loop {
            let (is_busy, here) = look(link, axis).await?;
            let stands = !is_busy && here == last;
            last = here;
            if stands && here != start {
                return Ok(here);
            }
            if stands && began.elapsed() >= BEGIN_WITHIN {
                let message = "the step was accepted, but the axis did not move";
                return Err(Cut::Failed(
                    Failure::new(Kind::ConditionNotMet, message)
                        .hint("`toyo param get P12` shows the size of a step, `toyo status` shows the reason"),
                ));
            }
            sleep(STEP_LOOK_EVERY).await;
        }
    }
}

/// Detector for an axis that has come to rest early.
struct Watch {
    start: Coordinates,
    last: Coordinates,
    was_busy: bool,
    /// Time of the last observed motion.
    since: Instant,
}

impl Watch {
    /// Whether the axis has come to rest: no execution, or the same position in several reads after some motion.
    fn has_come_to_rest(&mut self, is_busy: bool, place: Coordinates) -> bool {
        if place != self.last {
            self.since = Instant::now();
        }
        let stands = place == self.last && place != self.start;
        let is_at_rest = stands && ((self.was_busy && !is_busy) || self.since.elapsed() >= AT_REST);
        self.was_busy |= is_busy;
        self.last = place;
        is_at_rest
    }
}

/// Reads whether the controller executes, and the position. Refusals of a busy controller are repeated.
async fn look(link: &mut Link, axis: &Known) -> Result<(bool, Coordinates), Cut> {
    let mut refused = 0;
    loop {
        match try_look(link, axis).await {
            Err(Cut::Failed(failure)) if failure.kind == Kind::Refused && refused < MOST_REFUSED => refused += 1,
            looked => return looked,
        }
    }
}

async fn try_look(link: &mut Link, axis: &Known) -> Result<(bool, Coordinates), Cut> {
    let status = link.status_of(&[0]).await?;
    if status.has_error() {
        return Err(Cut::Error);
    }
    Ok((status.executing(), Coordinates::of(&link.place().await?, axis.letters)))
}

impl Command for Jog {
    type Family = Toyo;
    type Report = Jogged;
    const ID: &'static str = "toyo.jog";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        self.in_words(&self.axis.to_string())
    }

    fn jogs(&self) -> bool {
        true
    }

    /// The controller reports the letters of the axes.
    async fn run(&self, context: Context<'_, Toyo>) -> Result<Jogged, Failure> {
        if self.within.is_some() && self.speed == Speed::Inch {
            return Err(Failure::usage("an inching step has no duration")
                .hint("remove --for, or use --steps for several steps"));
        }
        if self.steps.is_some() && self.speed != Speed::Inch {
            return Err(Failure::usage("only inching uses --steps").hint("set the duration with --for"));
        }
        let Context { link, screen, authority, .. } = context;
        let letters = link.letters().await?;
        let index = self.axis.place(letters)?;
        let axis = Known { index, letters };
        authority.confirm(&Change::new(self.in_words(&axis.in_words()))).await?;
        link.ask(&jog("RS", None)).await?;
        if link.is_dry() {
            self.plan(link);
            link.stop(Moving::Jog).await?;
        }
        let start = Coordinates::of(&link.ask(&position()).await?, letters);
        let live = Live::new(screen);
        let began = Instant::now();
        let gone = self.go(link, &live, &axis, start).await;
        if let Err(Cut::Refused) = gone {
            // This command caused no motion. Other motion belongs to another client and needs no wait for a stop.
            link.give_up(Moving::Jog).await;
            live.end();
            return Err(refusal::explained(link, &self.order(&axis)).await);
        }
        // The stop is sent in any case.
        let elapsed = began.elapsed();
        let end = Coordinates::of(
            &link.stop(Moving::Jog).await.map_err(|failure| still_moving(gone.as_ref().err(), failure))?,
            letters,
        );
        live.end();
        match gone {
            Ok(steps) => Ok(Jogged::of(self, &axis, (start, end), elapsed, steps)),
            Err(cut) => Err(cut_short(link, cut, &end).await),
        }
    }
}

/// Reason of the early end, after the axis has stopped.
async fn cut_short(link: &mut Link, cut: Cut, place: &Coordinates) -> Failure {
    let stopped = format!("the axis was stopped at {}", place.in_a_line());
    match cut {
        Cut::Refused => refusal::explained(link, &jog("RS", None)).await,
        Cut::Error => {
            let tell = |what: &str| Failure::new(Kind::ConditionNotMet, format!("{what}; {stopped}"));
            present_error(link, &tell).await
        }
        Cut::Failed(failure) => Failure { message: format!("{}; {stopped}", failure.message), ..failure },
    }
}

/// Failure because the stop was not confirmed.
fn still_moving(cut: Option<&Cut>, failure: Failure) -> Failure {
    let why = match cut {
        Some(Cut::Failed(cut)) => format!("{}; ", cut.message),
        _ => String::new(),
    };
    Failure { message: format!("{why}the axis can still move: {}", failure.message), ..failure }
        .hint("press the emergency stop; after the controller answers again, use `toyo stop --jog` first")
}

/// Live display of the position in its own thread, because a blocked terminal must not delay the stop.
struct Live {
    texts: Sender<String>,
    thread: std::thread::JoinHandle<()>,
}

impl Live {
    fn new(screen: &Screen) -> Self {
        let (texts, said) = mpsc::channel::<String>();
        let screen = *screen;
        let thread = std::thread::spawn(move || {
            let progress = screen.spinner("jogging");
            for text in said {
                progress.print_line(&text);
            }
        });
        Self { texts, thread }
    }

    fn say(&self, text: String) {
        // If the thread has ended, only the display is lost.
        self.texts.send(text).unwrap_or_default();
    }

    /// Clears the display after the motion.
    fn end(self) {
        drop(self.texts);
        self.thread.join().unwrap_or_default();
    }
}

/// Result of a jog.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Jogged {
    /// Letter of the axis: `X`, `Y`, `Z` or `R`; empty if the controller does not report it.
    axis: &'static str,
    /// Number of the axis, 1 to 4.
    axis_number: usize,
    /// Word of the protocol: `+L`.
    word: &'static str,
    /// Completed inching steps; null for low and high.
    steps: Option<u8>,
    /// Distance; negative in minus direction.
    moved_mm: f64,
    #[serde(flatten)]
    motion: Motion,
}

impl Jogged {
    fn of(jog: &Jog, axis: &Known, (start, end): (Coordinates, Coordinates), elapsed: Duration, steps: u8) -> Self {
        let moved = axis.of(&end) - axis.of(&start);
        let place = |place: Coordinates| Some(place.position().of_group(UNIT));
        let motion = Motion {
            accepted: true,
            group: Some(UNIT.to_owned()),
            from: place(start),
            position: place(end),
            elapsed_ms: u64::try_from(elapsed.as_millis()).ok(),
            ..Motion::default()
        };
        Self {
            axis_number: axis.index + 1,
            axis: axis.letters.of(axis.index),
            word: jog.word(),
            steps: (jog.speed == Speed::Inch).then_some(steps),
            moved_mm: (moved * 100.0).round() / 100.0,
            motion,
        }
    }
}

impl Report for Jogged {
    fn view(&self) -> View {
        let steps = self.steps.map_or_else(|| "-".into(), Cell::from);
        let line = |place: &Option<Position>| Cell::optional(place.as_ref().map(Position::line));
        View::fields([
            ("axis", titled(self.axis_number - 1, self.axis).into()),
            ("moved (mm)", Cell::number(format!("{:.2}", self.moved_mm))),
            ("steps", steps),
            ("elapsed (ms)", Cell::optional(self.motion.elapsed_ms)),
            ("from", line(&self.motion.from)),
            ("to", line(&self.motion.position)),
        ])
    }
}

#[cfg(test)]
mod tests;

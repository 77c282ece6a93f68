//! `toyo jog`: moves one axis for a time or by inching steps. The stop is always sent at the end.

use std::convert::Infallible;
use std::sync::mpsc::{self, Sender};

use tokio::time::{Instant, sleep, sleep_until, timeout_at};

use super::field_values::machine;
use super::link::{MotionKind, jog};
use super::position::{Coordinates, UNIT, titled};
use super::refusal;
use super::wait::{POLL_INTERVAL, explain_present_error, position_request, status_page};
use crate::prelude::*;
use armctl_frame::robot::motion::Motion;
use armctl_frame::robot::position::Position;

/// Jog one axis, and stop it (TO 2-7, 3-2).
///
/// The controller has no dead man's switch. This command stops the axis after its time, after an error or a lost
/// answer, and at Ctrl-C, Ctrl-\ and Ctrl-Z. If the command is killed or frozen, its guardian stops the axis. If the
/// computer fails or sleeps, or the cable is unplugged, the axis continues to move. Keep the emergency stop at hand.
/// After such a failure, use `toyo stop --jog`.
#[derive(Debug, Args)]
pub struct Jog {
    /// Axis: its letter on the teach pendant, or its number
    #[arg(value_name = "X|Y|Z|R|1-4", value_parser = parse_axis)]
    axis: Axis,
    /// Direction
    direction: Direction,
    /// Speed: `high`, `low`, or `inch` for inching steps (parameter P12)
    speed: Speed,
    /// Duration of the jog, 100ms to 60s (only for `high` and `low`)
    #[arg(long = "for", value_name = "TIME", value_parser = parse_duration, required_if_eq_any([("speed", "low"), ("speed", "high")]))]
    within: Option<Duration>,
    /// Number of inching steps (only for `inch`)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=100), conflicts_with = "within")]
    steps: Option<u8>,
}

/// An axis as the user typed it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Axis {
    /// Index of the axis, 0 to 3, regardless of its letter.
    Index(usize),
    /// Letter of the axis on the teach pendant (parameter E01).
    Letter(String),
}

/// Letters that an axis can have (TO 2-4, parameter E01).
const LETTERS: [&str; 4] = ["X", "Y", "Z", "R"];

fn parse_axis(text: &str) -> Result<Axis, String> {
    if let Some(index) = ["1", "2", "3", "4"].iter().position(|number| *number == text) {
        return Ok(Axis::Index(index));
    }
    let letter = LETTERS.iter().find(|letter| letter.eq_ignore_ascii_case(text));
    letter.map(|letter| Axis::Letter((*letter).to_owned())).ok_or_else(|| "axes are X, Y, Z, R or 1 to 4".to_owned())
}

impl Axis {
    /// Index of the axis, 0 to 3, on a machine with these letters.
    fn index(&self, letters: Letters) -> Result<usize> {
        match self {
            Self::Index(index) => Ok(*index),
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
            Self::Index(index) => write!(f, "{}", index + 1),
            Self::Letter(letter) => f.write_str(letter),
        }
    }
}

/// An axis of this machine.
#[derive(Debug, Clone)]
struct MachineAxis {
    /// Index of the axis, 0 to 3.
    index: usize,
    letters: Letters,
}

impl MachineAxis {
    /// Text such as `2 (Z)`. If the controller reports no letter, the text is only the number.
    fn in_words(&self) -> String {
        match self.letters.of(self.index) {
            "" => (self.index + 1).to_string(),
            letter => format!("{} ({letter})", self.index + 1),
        }
    }

    fn of(&self, coordinates: &Coordinates) -> f64 {
        coordinates.mm()[self.index]
    }
}

/// Direction of a jog.
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
    /// Inching steps (parameter P12)
    Inch,
}

/// Minimum duration of a jog, which is longer than an answer takes. `LONGEST` is the longest time for which a person
/// can watch the axis.
const MIN_JOG_TIME: Duration = Duration::from_millis(100);
const MAX_JOG_TIME: Duration = Duration::from_secs(60);

fn parse_duration(text: &str) -> Result<Duration, String> {
    let time = duration::parse(text)?;
    if (MIN_JOG_TIME..=MAX_JOG_TIME).contains(&time) {
        return Ok(time);
    }
    Err(format!(
        "the duration of a jog is from {} to {}",
        duration::display(MIN_JOG_TIME),
        duration::display(MAX_JOG_TIME)
    ))
}

/// Time limit for the start of a step.
const START_TIMEOUT: Duration = Duration::from_secs(1);
/// Time within which an axis at the lowest speed must have moved.
const REST_TIME: Duration = Duration::from_millis(500);
/// Interval between two reads during a step.
const STEP_POLL_INTERVAL: Duration = Duration::from_millis(20);
/// Maximum number of consecutive reads that may be refused while an axis moves.
const MAX_REFUSALS: u32 = 3;

/// Why a motion ended early.
#[derive(Debug)]
enum JogError {
    /// The controller refused the command.
    Refused,
    /// An error occurred in the controller.
    Error,
    /// Another failure.
    Failed(Failure),
}

impl From<Failure> for JogError {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Jog {
    /// Protocol word for this motion.
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

    fn order(&self, axis: &MachineAxis) -> Request {
        jog(self.word(), Some(axis.index))
    }

    /// In a dry run, records all requests from the jog command on. The number of the axis depends on the letters, which
    /// must be read first.
    fn plan(&self, link: &mut Link) {
        link.plan(&position_request(), "position before the jog");
        let steps = self.steps.unwrap_or(1);
        let about = match self.within {
            Some(time) => format!("then {} pass", duration::display(time)),
            None if steps > 1 => format!("{steps} times, each time after the axis has stopped"),
            None => "once".to_owned(),
        };
        match &self.axis {
            Axis::Index(index) => link.plan(&jog(self.word(), Some(*index)), &about),
            Axis::Letter(letter) => {
                let about = format!("{} for axis {letter}, SP for the other axes; {about}", self.word());
                let reason = Reason::about(&about).depending_on("letters of the axes");
                link.plan_depending("@JGST X=? Y=? Z=? R=?", reason);
            }
        }
        link.plan(&status_page(0), "until the stop: whether there is an error");
        link.plan(&position_request(), "until the stop: position");
    }

    /// Text that completes "This will …".
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
    async fn run_jog(
        &self,
        link: &mut Link,
        display: &LiveDisplay,
        axis: &MachineAxis,
        start: Coordinates,
    ) -> Result<u8, JogError> {
        let Some(time) = self.within else { return self.run_inching_steps(link, display, axis, start).await };
        link.use_short_timeouts();
        let until = Instant::now() + time;
        let mut is_accepted = false;
        match timeout_at(until, self.jog_until(link, display, axis, (start, until), &mut is_accepted)).await {
            Ok(Err(error)) => Err(error),
            Err(_) if is_accepted => Ok(0),
            Err(_) => {
                Err(JogError::Failed(Failure::new(Kind::OutcomeUnknown, "the jog command was not answered in time")))
            }
        }
    }

    /// Moves without an end, and watches the axis until it must stop.
    async fn jog_until(
        &self,
        link: &mut Link,
        display: &LiveDisplay,
        axis: &MachineAxis,
        (start, until): (Coordinates, Instant),
        is_accepted: &mut bool,
    ) -> Result<Infallible, JogError> {
        let began = Instant::now();
        link.try_ask(&self.order(axis)).await?.map_err(|_| JogError::Refused)?;
        *is_accepted = true;
        // A read of the state consists of two requests.
        let mut longest = 2 * began.elapsed();
        let mut detector = RestDetector { start, last: start, was_busy: false, since: Instant::now() };
        loop {
            let began = Instant::now();
            if began + longest > until {
                // When the stop is sent, no request may be pending.
                return std::future::pending().await;
            }
            let (is_busy, coordinates) = read_state(link, axis).await?;
            if detector.has_come_to_rest(is_busy, coordinates) {
                let message = "the axis stopped early: another client stopped it";
                return Err(JogError::Failed(Failure::new(Kind::ConditionNotMet, message)));
            }
            display.say(format!("jogging {}", coordinates.in_a_line()));
            longest = longest.max(began.elapsed());
            sleep_until(began + POLL_INTERVAL.max(longest)).await;
        }
    }

    /// Moves by inching steps. Each step begins after the axis has come to rest.
    async fn run_inching_steps(
        &self,
        link: &mut Link,
        display: &LiveDisplay,
        axis: &MachineAxis,
        start: Coordinates,
    ) -> Result<u8, JogError> {
        let steps = self.steps.unwrap_or(1);
        let mut last = start;
        for step in 1..=steps {
            last = self.step(link, axis, last).await.map_err(|error| match error {
                JogError::Failed(failure) => JogError::Failed(Failure {
                    message: format!("step {step} of {steps}: {}", failure.message),
                    ..failure
                }),
                error => error,
            })?;
            display.say(format!("step {step} of {steps} {}", last.in_a_line()));
        }
        Ok(steps)
    }

    /// Moves by one inching step. Returns the position after the step.
    async fn step(&self, link: &mut Link, axis: &MachineAxis, start: Coordinates) -> Result<Coordinates, JogError> {
        link.try_ask(&self.order(axis)).await?.map_err(|_| JogError::Refused)?;
        let (mut last, began) = (start, Instant::now());
        loop {
            let (is_busy, current) = read_state(link, axis).await?;
            let is_at_rest = !is_busy && current == last;
            last = current;
            if is_at_rest && current != start {
                return Ok(current);
            }
            if is_at_rest && began.elapsed() >= START_TIMEOUT {
                let message = "the controller accepted the step, but the axis did not move";
                return Err(JogError::Failed(
                    Failure::new(Kind::ConditionNotMet, message).hint(
                        "use `toyo param get P12` to see the size of a step, and `toyo status` to see the reason",
                    ),
                ));
            }
            sleep(STEP_POLL_INTERVAL).await;
        }
    }
}

/// Detects that an axis has come to rest before the end of the jog.
struct RestDetector {
    start: Coordinates,
    last: Coordinates,
    was_busy: bool,
    /// Time of the last observed motion.
    since: Instant,
}

impl RestDetector {
    /// Whether the axis has come to rest: the controller executes nothing, or several reads show the same position
    /// after some motion.
    fn has_come_to_rest(&mut self, is_busy: bool, coordinates: Coordinates) -> bool {
        if coordinates != self.last {
            self.since = Instant::now();
        }
        let is_at_rest = coordinates == self.last && coordinates != self.start;
        let is_at_rest = is_at_rest && ((self.was_busy && !is_busy) || self.since.elapsed() >= REST_TIME);
        self.was_busy |= is_busy;
        self.last = coordinates;
        is_at_rest
    }
}

/// Reads whether the controller executes something, and the position. If a busy controller refuses a read, it is
/// repeated.
async fn read_state(link: &mut Link, axis: &MachineAxis) -> Result<(bool, Coordinates), JogError> {
    let mut refused = 0;
    loop {
        match try_read_state(link, axis).await {
            Err(JogError::Failed(failure)) if failure.kind == Kind::Refused && refused < MAX_REFUSALS => refused += 1,
            state => return state,
        }
    }
}

async fn try_read_state(link: &mut Link, axis: &MachineAxis) -> Result<(bool, Coordinates), JogError> {
    let status = link.status_of(&[0]).await?;
    if status.has_error() {
        return Err(JogError::Error);
    }
    Ok((status.executing(), Coordinates::of(&link.read_position().await?, axis.letters)))
}

impl Command for Jog {
    type Family = Toyo;
    type Report = JogReport;
    const ID: &'static str = "toyo.jog";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;
    const JOGS: bool = true;

    fn intent(&self) -> String {
        self.in_words(&self.axis.to_string())
    }

    /// Reads the letters of the axes first, because the user can name an axis by its letter.
    async fn run(&self, context: Context<'_, Toyo>) -> Result<JogReport> {
        if self.within.is_some() && self.speed == Speed::Inch {
            return Err(Failure::usage("an inching step has no duration")
                .hint("remove --for, or use --steps for several steps"));
        }
        if self.steps.is_some() && self.speed != Speed::Inch {
            return Err(Failure::usage("only inching uses --steps").hint("set the duration with --for"));
        }
        let Context { link, screen, confirmer, .. } = context;
        let letters = link.letters().await?;
        let index = self.axis.index(letters)?;
        let axis = MachineAxis { index, letters };
        confirmer.confirm(&Change::new(self.in_words(&axis.in_words()))).await?;
        link.ask(&jog("RS", None)).await?;
        if link.is_dry_run() {
            self.plan(link);
            link.stop(MotionKind::Jog).await?;
        }
        let start = Coordinates::of(&link.ask(&position_request()).await?, letters);
        let display = LiveDisplay::new(screen);
        let began = Instant::now();
        let outcome = self.run_jog(link, &display, &axis, start).await;
        if let Err(JogError::Refused) = outcome {
            // This command caused no motion. If the axis moves, another client moves it, and this command need not wait
            // for a stop.
            link.stop_refused_motion(MotionKind::Jog).await;
            display.end();
            return Err(refusal::with_reason(link, &self.order(&axis)).await);
        }
        // The stop is sent, whatever happened before.
        let elapsed = began.elapsed();
        let end = Coordinates::of(
            &link.stop(MotionKind::Jog).await.map_err(|failure| still_moving(outcome.as_ref().err(), failure))?,
            letters,
        );
        display.end();
        match outcome {
            Ok(steps) => Ok(JogReport::of(self, &axis, (start, end), elapsed, steps)),
            Err(error) => Err(stopped_early(link, error, &end).await),
        }
    }
}

/// Failure with the reason for the early end, after the axis has stopped.
async fn stopped_early(link: &mut Link, error: JogError, coordinates: &Coordinates) -> Failure {
    let stopped = format!("the axis was stopped at {}", coordinates.in_a_line());
    match error {
        JogError::Refused => refusal::with_reason(link, &jog("RS", None)).await,
        JogError::Error => {
            let fail = |what: &str| Failure::new(Kind::ConditionNotMet, format!("{what}; {stopped}"));
            explain_present_error(link, &fail).await
        }
        JogError::Failed(failure) => Failure { message: format!("{}; {stopped}", failure.message), ..failure },
    }
}

/// Failure: the stop was not confirmed.
fn still_moving(error: Option<&JogError>, failure: Failure) -> Failure {
    let why = match error {
        Some(JogError::Failed(error)) => format!("{}; ", error.message),
        _ => String::new(),
    };
    Failure { message: format!("{why}the axis can still move: {}", failure.message), ..failure }
        .hint("press the emergency stop; after the controller answers again, use `toyo stop --jog` first")
}

/// Live display of the position. It has its own thread, because a blocked terminal must not delay the stop.
struct LiveDisplay {
    texts: Sender<String>,
    thread: std::thread::JoinHandle<()>,
}

impl LiveDisplay {
    fn new(screen: &Screen) -> Self {
        let (texts, updates) = mpsc::channel::<String>();
        let screen = *screen;
        let thread = std::thread::spawn(move || {
            let progress = screen.spinner("jogging");
            for text in updates {
                progress.print_line(&text);
            }
        });
        Self { texts, thread }
    }

    fn say(&self, text: String) {
        // If the thread has ended, the display is lost, but nothing else.
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
pub struct JogReport {
    /// Letter of the axis: `X`, `Y`, `Z` or `R`; empty if the controller does not report one.
    axis: &'static str,
    /// Number of the axis, 1 to 4.
    axis_number: usize,
    /// Protocol word, such as `+L`.
    word: &'static str,
    /// Number of completed inching steps; null for low and high speed.
    steps: Option<u8>,
    /// Distance in mm; negative in minus direction.
    moved_mm: f64,
    #[serde(flatten)]
    motion: Motion,
}

impl JogReport {
    fn of(
        jog: &Jog,
        axis: &MachineAxis,
        (start, end): (Coordinates, Coordinates),
        elapsed: Duration,
        steps: u8,
    ) -> Self {
        let moved = axis.of(&end) - axis.of(&start);
        let report_position = |coordinates: Coordinates| Some(coordinates.position().of_group(UNIT));
        let motion = Motion {
            accepted: true,
            group: Some(UNIT.to_owned()),
            from: report_position(start),
            position: report_position(end),
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

impl Report for JogReport {
    fn view(&self) -> View {
        let steps = self.steps.map_or_else(|| "-".into(), Cell::from);
        let line = |position: &Option<Position>| Cell::optional(position.as_ref().map(Position::line));
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

//! A motion from the confirmation to its end: reads before the start, and supervision after the start.

use tokio::time::Instant;

use super::question::{Question, moved_during_question};
use crate::failure::refusal_failure;
use crate::link::Refusal;
use crate::motion::{POLL_INTERVAL, START_TIMEOUT, StandstillCause, lost_contact, plan_alarm};
use crate::position::{self, as_reported, in_a_line};
use crate::prelude::*;
use armctl_client::yerc::AxisSet;
use armctl_controller::units::{self, Unit};
use armctl_controller::yerc::payload::{Axes, ControllerStatus, ExtendedForm, Form};
use armctl_controller::yerc::query::{Coordinates, Query, ReadPosition, ReadStatus};
use armctl_controller::yerc::status::is_absent;
use armctl_frame::robot::motion::Motion;
use armctl_frame::robot::position as robot;

/// A motion whose arguments have been checked.
#[derive(Debug)]
pub(super) struct Execution<Q> {
    /// Request that starts the motion.
    pub(super) order: Q,
    /// Group that moves.
    pub(super) group: Group,
    /// Target, in a form that can be compared with a position if possible.
    pub(super) goal: Goal,
    /// Groups with axes that the request would move to 0, because the user did not give values for them. Each entry has
    /// the group, the number of axes with values, and the option that gives the values.
    pub(super) unnamed: Vec<(Group, usize, &'static str)>,
    /// Whether the command returns as soon as the controller accepts the motion.
    pub(super) no_wait: bool,
}

/// Target of a motion, for a comparison with positions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Goal {
    /// A target in pulses.
    Pulses(Vec<i32>),
    /// A target in base coordinates, with this tool number.
    Base([i32; 6], u32),
    /// A distance along the base coordinates, without rotation, with this tool number.
    Relative([i32; 3], u32),
    /// A target that cannot be compared with a position. The position is read in these coordinates.
    Unknown(Coordinates),
}

impl Goal {
    const fn coordinates(&self) -> Coordinates {
        match self {
            Self::Pulses(_) => Coordinates::Pulse,
            Self::Base(..) | Self::Relative(..) => Coordinates::Base,
            Self::Unknown(coordinates) => *coordinates,
        }
    }

    /// Converts a distance to a target, from the start position.
    fn from(self, start: &Position) -> Self {
        let Self::Relative(by, tool) = self else { return self };
        let mut target = [0; 6];
        for (axis, value) in target.iter_mut().enumerate() {
            let at_start = start.axes.padded()[axis];
            let Some(there) = at_start.checked_add(by.get(axis).copied().unwrap_or(0)) else {
                return Self::Unknown(Coordinates::Base);
            };
            *value = there;
        }
        Self::Base(target, tool)
    }

    /// Target position; `None` if it cannot be compared.
    fn position(&self) -> Option<Position> {
        let (kind, axes, tool) = match self {
            Self::Pulses(axes) => (PositionKind::Pulse, &axes[..], 0),
            Self::Base(axes, tool) => (PositionKind::Base, &axes[..], *tool),
            Self::Relative(..) | Self::Unknown(_) => return None,
        };
        let (form, extended) = (Form(0), ExtendedForm(0));
        Some(Position { kind, form, tool, user: 0, extended, axes: Axes::new(axes)? })
    }

    /// Whether this position is the target; `None` if this is unknown.
    fn is_reached(&self, here: &Position) -> Option<bool> {
        let axes = here.axes.as_slice();
        match self {
            Self::Pulses(target) => Some(target.iter().zip(axes).all(|(t, h)| is_near(units::PULSE, *t, *h))),
            // Coordinates with another tool cannot be compared.
            Self::Base(target, tool) if here.tool == *tool && axes.len() >= target.len() => {
                let unit = |axis| PositionKind::Base.unit(axis);
                let mut nearest_turn =
                    target.iter().zip(axes).enumerate().map(|(axis, (t, h))| is_near(unit(axis), *t, *h));
                let (place, turn) = (nearest_turn.by_ref().take(3).all(|near| near), nearest_turn.all(|near| near));
                match (place, turn) {
                    (false, _) => Some(false),
                    (true, true) => Some(true),
                    // The angles differ, but different angles can describe the same orientation.
                    (true, false) => None,
                }
            }
            Self::Base(..) | Self::Relative(..) | Self::Unknown(_) => None,
        }
    }
}

/// Whether a position is near the target. The tolerance is 0.1 mm, 0.1 degree, or 100 pulses (less than 0.1 degree on
/// usual axes). It is larger than the accuracy of a robot and smaller than a useful motion.
fn is_near(unit: Unit, target: i32, here: i32) -> bool {
    is_within_tolerance(unit, target, here, 100, 1000)
}

/// Whether two positions of a robot at rest are the same. The tolerance is 0.02 mm, 0.02 degree, or 20 pulses.
fn is_same(unit: Unit, one: i32, other: i32) -> bool {
    is_within_tolerance(unit, one, other, 20, 200)
}

fn is_within_tolerance(unit: Unit, one: i32, other: i32, others: i64, degrees: i64) -> bool {
    const TURN: i64 = 3_600_000;
    let difference = (i64::from(one) - i64::from(other)).abs();
    if unit == units::DEGREE {
        // 180 and -180 degrees are the same angle.
        let difference = difference % TURN;
        return difference.min(TURN - difference) <= degrees;
    }
    difference <= others
}

impl<Q: Query<Answer = ()>> Execution<Q> {
    /// Confirms the motion and starts it. Unless `--no-wait` is set, waits for its end.
    pub(super) async fn run(self, context: Context<'_, Yerc>, question: &Question<'_>) -> Result<MotionReport> {
        let Context { link, screen, confirmer, .. } = context;
        let Self { order, group, mut goal, unnamed, no_wait } = self;
        let coordinates = goal.coordinates();
        let mut start = None;
        for (group, named, flag) in unnamed {
            refuse_implicit_zeros(link, group, named, flag).await?;
        }
        if link.known_model() == Some(Model::Dx100) {
            screen.note("warning: moves are not tested on a dx100; armctl uses the layout of a DX200");
        }
        let is_asked = confirmer.asks_user();
        if (is_asked || !no_wait)
            && let Some((position, _)) =
                position::ask(link.for_purpose("current position"), group, coordinates).await.known()?
        {
            goal = goal.from(&position);
            start = Some(position);
        }
        confirmer.confirm(&question.change(group, start.as_ref(), &goal, link.pulses_per_degree(group))).await?;
        if let (Some(asked), true) = (&start, is_asked) {
            let (now, _) = position::ask(link, group, coordinates).await?;
            if !is_standing(asked, &now) {
                return Err(moved_during_question(group, &now));
            }
        }
        let start = start.filter(|_| !no_wait);
        link.for_purpose("starts the motion").ask(&order).await?;
        if link.is_dry_run() && !no_wait {
            plan_looks(link, group, coordinates).await?;
        }
        let per_degree = link.pulses_per_degree(group).to_vec();
        let motion = Motion {
            accepted: true,
            group: Some(group.to_string()),
            from: start.map(|start| as_reported(group, start, AxisSet::ALL, &per_degree).of_group(group.to_string())),
            to: goal.position().map(|target| as_reported(group, target, AxisSet::ALL, &per_degree)),
            speed: Some(question.speed.reported()),
            ..Motion::default()
        };
        let mut moved = MotionReport { motion, variable: None };
        let Some(start) = start else { return Ok(moved) };

        let outcome = format!("the motion of {group} was accepted");
        let progress = screen.spinner(&format!("{group} moves"));
        let began = Instant::now();
        let mut watch = Watch::new(start);
        loop {
            let status = link.ask(&ReadStatus).await.map_err(|failure| lost_contact(&outcome, failure))?;
            let asked = position::ask(link, group, coordinates).await;
            let (here, report) = asked.map_err(|failure| lost_contact(&outcome, failure))?;
            let is_at_target = goal.is_reached(&here);
            let place = in_a_line(here.kind, here.axes.as_slice(), matches!(group, Group::Robot(_)));
            match watch.look(began.elapsed(), status, here, is_at_target) {
                Progress::Moving => progress.print_line(&format!("{group} {place}")),
                Progress::Ended if is_at_target == Some(false) => {
                    return Err(Failure::new(
                        Kind::ConditionNotMet,
                        format!("{outcome}, but the motion ended before its target; position: {place}"),
                    )
                    .hint("check the pendant before you continue; the motion was stopped without an alarm"));
                }
                Progress::Ended => {
                    let motion = &mut moved.motion;
                    (motion.reached, motion.position) = (is_at_target, Some(report));
                    motion.elapsed_ms = u64::try_from(began.elapsed().as_millis()).ok();
                    return Ok(moved);
                }
                Progress::Stopped(trouble) => {
                    let place = resting_place(link, group, coordinates, here, place).await;
                    return Err(trouble.failure(link, &outcome, Some(&place)).await);
                }
                Progress::NotStarted => {
                    let within = duration::display(START_TIMEOUT);
                    return Err(Failure::new(
                        Kind::ConditionNotMet,
                        format!("{outcome}, but the motion has not started within {within}; position: {place}"),
                    )
                    .hint(
                        "keep clear of the robot, because the motion may still start; check `yerc status` and the \
                         pendant",
                    ));
                }
            }
            tokio::time::sleep(POLL_INTERVAL).await;
        }
    }
}

/// In a dry run, records the requests during the motion.
pub(super) async fn plan_looks(link: &mut Link, group: Group, coordinates: Coordinates) -> Result<()> {
    let about = "repeatedly until the motion has ended";
    link.plan(&ReadStatus.request(), about);
    let question = link.by_model(|model| ReadPosition::new(model, group, coordinates)).await?;
    link.plan(&question.request(), about);
    plan_alarm(link)
}

/// Maximum number of reads until a robot is at rest. They take two seconds.
const REST_POLLS: u32 = 40;

/// Position of a robot after a stop, as text. If the position cannot be read, the text contains the last known
/// position.
async fn resting_place(
    link: &mut Link,
    group: Group,
    coordinates: Coordinates,
    mut last: Position,
    mut place: String,
) -> String {
    for _ in 0..REST_POLLS {
        tokio::time::sleep(POLL_INTERVAL).await;
        let Ok((here, _)) = position::ask(link, group, coordinates).await else { break };
        let is_at_rest = is_standing(&last, &here);
        place = in_a_line(here.kind, here.axes.as_slice(), matches!(group, Group::Robot(_)));
        last = here;
        if is_at_rest {
            break;
        }
    }
    place
}

/// Refuses a move that would move axes to 0 because the user did not give values for them. A move has words for every
/// axis. A 0 for an axis without a value is correct only if the axis is not fitted, or is at 0.
async fn refuse_implicit_zeros(link: &mut Link, group: Group, named: usize, flag: &str) -> Result<()> {
    if named >= words(group) {
        return Ok(());
    }
    let question = link.by_model(|model| ReadPosition::new(model, group, Coordinates::Pulse)).await?;
    let Some(answer) =
        link.for_purpose("current position of the axes without a target").ask_optional(&question).await.known()?
    else {
        link.plan_existing_axes(group, Coordinates::Pulse);
        return Ok(());
    };
    match answer {
        Ok(position) => {
            let (axes, _) = link.existing_axes(group, Coordinates::Pulse, position.axes).await;
            implicit_zero(group, &Position { axes, ..position }, named, flag).map_or(Ok(()), Err)
        }
        // A group that does not exist cannot move.
        Err(Refusal { status, .. }) if is_absent(status) => Ok(()),
        // After any other refusal, the position of the axes is unknown.
        Err(refusal) => {
            let failure = refusal_failure(refusal);
            let message = format!("the axes of {group} that are not in {flag} could not be read: {}", failure.message);
            Err(Failure { message, ..failure }.hint(format!(
                "repeat the command, or type {} axes with {flag}, with 0 for axes that are not fitted; nothing was \
                 sent, because axes without a target could move to 0",
                words(group)
            )))
        }
    }
}

/// Number of axes that a move has for a group (FS and DX 3.3.39, 3.3.40).
const fn words(group: Group) -> usize {
    match group {
        Group::Robot(_) => 8,
        Group::Base(_) => 3,
        Group::Station(_) => 6,
    }
}

fn implicit_zero(group: Group, position: &Position, named: usize, flag: &str) -> Option<Failure> {
    let (axis, value) = position.axes.as_slice().iter().enumerate().skip(named).find(|(_, value)| **value != 0)?;
    let message = format!("axis {} of {group} is at {value} pulses and has no target, so it would move to 0", axis + 1);
    Some(Failure::usage(message).hint(format!("type every axis of {group} with {flag}; nothing was sent")))
}

/// Watches a motion from its acceptance to its end.
#[derive(Debug)]
struct Watch {
    start: Position,
    last: Position,
    polls: bool,
    has_moved: bool,
}

/// State of the motion, derived from a status and a position.
#[derive(Debug, PartialEq, Eq)]
enum Progress {
    /// The robot still moves.
    Moving,
    /// The motion has ended.
    Ended,
    /// The motion was stopped. Contains the cause.
    Stopped(StandstillCause),
    /// No motion started within the time limit.
    NotStarted,
}

impl Watch {
    fn new(start: Position) -> Self {
        Self { start, last: start, polls: false, has_moved: false }
    }

    /// The position is read after the status. If the status shows that nothing is running, the position is final. But
    /// the controller may set the running bit only shortly after the acceptance. For this reason, a standstill counts
    /// only from the second read, and only if a motion was observed or the robot is at its target.
    fn look(
        &mut self,
        elapsed: Duration,
        status: ControllerStatus,
        here: Position,
        at_target: Option<bool>,
    ) -> Progress {
        self.has_moved |= status.running() || !is_standing(&self.start, &here);
        let is_still = !status.running() && self.polls && is_standing(&self.last, &here);
        self.polls = true;
        self.last = here;
        if let Some(trouble) = StandstillCause::of(status) {
            return Progress::Stopped(trouble);
        }
        match (is_still, self.has_moved || at_target == Some(true)) {
            (true, true) => Progress::Ended,
            (_, false) if elapsed >= START_TIMEOUT => Progress::NotStarted,
            _ => Progress::Moving,
        }
    }
}

/// Whether both readings show a group at rest.
pub(crate) fn is_standing(one: &Position, other: &Position) -> bool {
    let axes = one.axes.as_slice().iter().zip(other.axes.as_slice()).enumerate();
    axes.into_iter().all(|(axis, (a, b))| is_same(one.kind.unit(axis), *a, *b))
}

/// Result of a motion.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct MotionReport {
    #[serde(flatten)]
    motion: Motion,
    /// Name of the variable that contains the target; null if the user typed the target.
    variable: Option<String>,
}

impl MotionReport {
    /// Adds the target position, which comes from a variable or from degrees.
    pub(super) fn leads_to(&mut self, name: Option<String>, target: robot::Position) {
        (self.variable, self.motion.to) = (name, Some(target));
    }
}

impl Report for MotionReport {
    fn view(&self) -> View {
        let Motion { group, reached, position, elapsed_ms, .. } = &self.motion;
        let motion = match (position, reached) {
            (None, _) => Cell::from("accepted"),
            (Some(_), Some(true)) => Cell::from("target reached").tone(Tone::Good),
            (Some(_), _) => Cell::from("ended").tone(Tone::Good),
        };
        View::fields([
            ("group", Cell::optional(group.as_deref())),
            ("motion", motion),
            ("position", Cell::optional(position.as_ref().map(robot::Position::line))),
            ("elapsed (ms)", Cell::optional(*elapsed_ms)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yerc::payload::StatusBit;

    const HOME: [i32; 6] = [100_000, 0, 500_000, 1_800_000, 0, 0];

    fn at(axes: [i32; 6]) -> Position {
        Position {
            kind: PositionKind::Base,
            form: Form(0),
            tool: 1,
            user: 0,
            extended: ExtendedForm(0),
            axes: Axes::new(&axes).unwrap(),
        }
    }

    fn status(running: bool) -> ControllerStatus {
        ControllerStatus::default().with(StatusBit::ServoOn, true).with(StatusBit::Running, running)
    }

    fn after(millis: u64) -> Duration {
        Duration::from_millis(millis)
    }

    #[test]
    fn distinguishes_target_from_other_positions() {
        let goal = Goal::Base(HOME, 1);
        assert_eq!(goal.is_reached(&at(HOME)), Some(true));
        assert_eq!(goal.is_reached(&at([100_050, 0, 500_000, -1_800_000, 0, 0])), Some(true), "180 is -180");
        assert_eq!(goal.is_reached(&at([100_101, 0, 500_000, 1_800_000, 0, 0])), Some(false));
        assert_eq!(goal.is_reached(&at([100_000, 0, 500_000, 0, 1_800_000, 0])), None, "other angles may be the same");
        assert_eq!(Goal::Base(HOME, 2).is_reached(&at(HOME)), None, "another tool");
        let pulses = Goal::Pulses(vec![1000, -1000]);
        let here = Position { kind: PositionKind::Pulse, axes: Axes::new(&[1050, -1000, 7]).unwrap(), ..at(HOME) };
        assert_eq!(pulses.is_reached(&here), Some(true));
        let here = Position { axes: Axes::new(&[1101, -1000]).unwrap(), ..here };
        assert_eq!(pulses.is_reached(&here), Some(false));
    }

    #[test]
    fn computes_the_target_of_a_relative_move() {
        let goal = Goal::Relative([0, 0, -500], 1).from(&at(HOME));
        assert_eq!(goal, Goal::Base([100_000, 0, 499_500, 1_800_000, 0, 0], 1));
        assert_eq!(Goal::Relative([i32::MAX, 0, 0], 1).from(&at(HOME)), Goal::Unknown(Coordinates::Base));
    }

    #[test]
    fn accepts_a_late_running_bit() {
        let mut watch = Watch::new(at(HOME));
        let at_target = [200_000, 0, 500_000, 1_800_000, 0, 0];
        assert_eq!(watch.look(after(0), status(false), at(HOME), Some(false)), Progress::Moving);
        assert_eq!(watch.look(after(100), status(false), at(HOME), Some(false)), Progress::Moving);
        assert_eq!(watch.look(after(200), status(true), at(HOME), Some(false)), Progress::Moving);
        assert_eq!(watch.look(after(300), status(true), at(at_target), Some(true)), Progress::Moving);
        assert_eq!(watch.look(after(400), status(false), at(at_target), Some(true)), Progress::Ended);
    }

    #[test]
    fn detects_a_short_motion_by_its_position() {
        let mut watch = Watch::new(at(HOME));
        let there = [101_000, 0, 500_000, 1_800_000, 0, 0];
        assert_eq!(watch.look(after(0), status(false), at(there), None), Progress::Moving);
        assert_eq!(watch.look(after(100), status(false), at(there), None), Progress::Ended);
    }

    #[test]
    fn target_at_the_start_is_reached_at_once() {
        let mut watch = Watch::new(at(HOME));
        assert_eq!(watch.look(after(0), status(false), at(HOME), Some(true)), Progress::Moving);
        assert_eq!(watch.look(after(100), status(false), at(HOME), Some(true)), Progress::Ended);
    }

    #[test]
    fn reports_a_motion_that_does_not_start() {
        let mut watch = Watch::new(at(HOME));
        assert_eq!(watch.look(after(0), status(false), at(HOME), None), Progress::Moving);
        assert_eq!(watch.look(START_TIMEOUT, status(false), at(HOME), None), Progress::NotStarted);
    }

    #[test]
    fn alarm_and_hold_end_the_wait() {
        let mut watch = Watch::new(at(HOME));
        let alarmed = status(true).with(StatusBit::Alarm, true);
        assert_eq!(watch.look(after(0), alarmed, at(HOME), None), Progress::Stopped(StandstillCause::Alarm));
        let held = status(false).with(StatusBit::HoldPendant, true);
        assert_eq!(watch.look(after(100), held, at(HOME), None), Progress::Stopped(StandstillCause::Hold("pendant")));
    }

    #[test]
    fn requires_unnamed_axes_at_zero() {
        let base = |axes: &[i32]| Position { kind: PositionKind::Pulse, axes: Axes::new(axes).unwrap(), ..at(HOME) };
        assert!(implicit_zero(Group::Base(1), &base(&[0, 0]), 0, "--base-axes").is_none());
        assert!(implicit_zero(Group::Base(1), &base(&[5, 0]), 1, "--base-axes").is_none());
        let failure = implicit_zero(Group::Base(1), &base(&[5, 7]), 1, "--base-axes").unwrap();
        assert!(failure.message.starts_with("axis 2 of B1 is at 7 pulses"), "{failure}");
        assert_eq!(failure.kind, Kind::Usage);
    }
}

//! Motions by remote commands (4.2): code and reports that all motions use.

mod absolute;
mod drive;
mod inch;
mod jog;
mod moves;
mod origin;
mod pallet;
mod push;
mod question;
mod relative;
mod tool;

use std::sync::mpsc::{self, Sender};
use std::thread::{self, JoinHandle};

use super::arguments::{Axes, EndOptions, UnitArgument};
use super::link::CommandResult;
use super::position::{Unit, group, position};
use crate::prelude::*;
use armctl_frame::robot::motion::{self as robot, Target};
use armctl_frame::robot::position::joint_table;

pub use absolute::AbsReset;
pub use drive::{Drive, Drivei};
pub use inch::Inch;
pub use jog::Jog;
pub use moves::Move;
pub use origin::Origin;
pub use pallet::Pallet;
pub use push::Push;
pub use relative::Movei;
pub use tool::Movet;

/// A motion that ends on its own and can report the position; [`Moving`] makes a command of it.
pub trait Motion: Args {
    /// Report type.
    type Report: FromMotion + 'static;
    /// Name in envelopes and schemas, for example `yrcx.move`.
    const ID: &'static str;
    /// Forms of the verb: move, moving, moved.
    const VERB: [&'static str; 3] = ["move", "moving", "moved"];

    /// Row of the command table.
    fn command(&self) -> table::Command;

    /// Sets the fields from the arguments that the user typed.
    fn fill(&self, draft: Draft) -> Result<Draft>;

    /// Describes the axis of a single-axis motion, for example `axis 3`.
    fn axis(&self) -> Option<String> {
        None
    }

    /// Describes the target, for example `to point 19 in a straight line`.
    fn target(&self) -> String;

    /// Describes axes and speed, for example `all axes, at 50 %`.
    fn axes_and_speed(&self) -> String;

    /// Returns the axes that the user did not name and that would move. armctl sends their current position as the
    /// target, so that they stay in place (4.2.1).
    fn stays(&self) -> Vec<usize> {
        Vec::new()
    }

    /// Returns the coordinates or distances that the user typed, per axis.
    fn targets(&self) -> Vec<Target> {
        Vec::new()
    }

    /// Returns the unit of the reported position, if the user does not select a unit.
    fn usual_unit(&self) -> Option<Unit> {
        None
    }
}

/// Report of a motion.
pub trait FromMotion: Report {
    /// Builds the report of the motion. `values` are the values of the answer, if the motion has ended.
    fn from_motion(moved: MotionReport, values: Option<&Values>) -> Self;
}

impl FromMotion for MotionReport {
    fn from_motion(moved: MotionReport, _values: Option<&Values>) -> Self {
        moved
    }
}

/// Command that executes a motion.
#[derive(Debug, Args)]
pub struct Moving<M: Args> {
    #[command(flatten)]
    motion: M,
    #[command(flatten)]
    ending: EndOptions,
    #[command(flatten)]
    which: UnitArgument,
}

impl<M: Motion> Moving<M> {
    fn unit(&self) -> Option<Unit> {
        self.ending.report.or(self.motion.usual_unit())
    }

    /// Describes the target; for a single-axis motion, the axis and the target.
    fn object(&self) -> String {
        self.motion.axis().map_or_else(|| self.motion.target(), |axis| format!("{axis} {}", self.motion.target()))
    }
}

impl<M: Motion> Command for Moving<M> {
    type Family = Yrcx;
    type Report = M::Report;
    const ID: &'static str = M::ID;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn risk(&self) -> Risk {
        self.motion.command().row().risk
    }

    fn intent(&self) -> String {
        let axis = self.motion.axis().map(|axis| format!("{axis} of ")).unwrap_or_default();
        let [verb, ..] = M::VERB;
        format!("{verb} {axis}{} {} ({})", self.which.name(), self.motion.target(), self.motion.axes_and_speed())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<M::Report> {
        let draft = context.link.draft(self.motion.command())?;
        let draft = EndOptions::apply_to(self.motion.fill(draft)?, self.unit());
        let order = staying(context.link, draft, &self.motion.stays()).await?;
        question::confirm(context.link, &context.confirmer, &order, Command::intent(self)).await?;
        let [_, moving, moved] = M::VERB;
        let object = self.object();
        let doing = format!("{moving} {object}");
        let done = execute_motion(context.link, context.screen, &order, self.ending.end.no_wait(), &doing).await?;
        let has_done = format!("{moved} {object}");
        let words = if done.is_some() { has_done } else { doing };
        let mut report = MotionReport::new(words, &order, done.as_ref(), self.unit());
        report.motion.targets = self.motion.targets();
        Ok(M::Report::from_motion(report, done.as_ref().map(|done| &done.values)))
    }
}

/// Adds the current position of `axes` to the command. Without these positions, a SCARA moves these axes to the target
/// position although the user did not name them.
async fn staying(link: &mut Link, draft: Draft, axes: &[usize]) -> Result<Order> {
    let order = draft.clone().valid_order()?;
    if axes.is_empty() {
        return Ok(order);
    }
    let present = link.draft(table::Command::PositionMm)?.valid_order()?;
    if link.is_dry_run() {
        let names = axes.iter().map(usize::to_string).collect::<Vec<_>>().join(" and ");
        link.plan(&present, "current position");
        let one = draft.clone();
        let keys: Vec<Key> = axes.iter().filter_map(|axis| Key::AXES.get(axis - 1).copied()).collect();
        let other = keys.into_iter().fold(one, |draft, key| draft.with(key, -1)).valid_order()?;
        let kept = format!("current position of the axes without a target: {names}");
        link.plan_depending(&order, &other, Reason::default().depending_on(&kept));
        return Err(unknown());
    }
    let not_moved = |failure: Failure| Failure {
        message: format!(
            "the robot did not move: the current position of the axes without a target is unknown: {}",
            failure.message
        ),
        ..failure.hint("type axes 1 and 2 as well, or use `yrcx drive`")
    };
    let place = link.ask(&present).await.map_err(not_moved)?.values.axes();
    let place = place.ok_or_else(|| not_moved(Failure::new(Kind::Malformed, "the answer has no position")))?;
    let keys = axes.iter().filter_map(|axis| Some((*Key::AXES.get(axis - 1)?, *place.get(axis - 1)?)));
    keys.fold(draft, |draft, (key, steps)| draft.with(key, steps)).valid_order()
}

/// Executes a motion and waits for its end, unless `--no-wait` is set.
async fn execute_motion(
    link: &mut Link,
    screen: &Screen,
    order: &Order,
    no_wait: bool,
    doing: &str,
) -> Result<Option<CommandResult>> {
    if no_wait {
        return link.begin(order).await;
    }
    let live = Live::new(link, screen, doing);
    let done = link.ask(order).await;
    live.end();
    done.map(Some)
}

/// Shows the motion and its duration. The display has its own thread, because a blocked terminal must not delay the
/// stop.
struct Live(Option<(Sender<()>, JoinHandle<()>)>);

impl Live {
    /// Starts the display, except in a dry run, in which nothing moves.
    fn new(link: &Link, screen: &Screen, doing: &str) -> Self {
        let (screen, doing) = (*screen, doing.to_owned());
        Self((!link.is_dry_run()).then(|| {
            let (end, ended) = mpsc::channel();
            let show = move || {
                let _progress = screen.spinner(&doing);
                // The channel carries no messages: `recv` returns when the sender is dropped.
                ended.recv().unwrap_or_default();
            };
            (end, thread::spawn(show))
        }))
    }

    /// Clears the display after the motion.
    fn end(self) {
        if let Some((end, thread)) = self.0 {
            drop(end);
            thread.join().unwrap_or_default();
        }
    }
}

/// Result of a motion.
#[derive(Debug, Serialize, JsonSchema)]
pub struct MotionReport {
    /// Kind of motion, for example `move-ptp`.
    #[serde(rename = "motion")]
    kind: &'static str,
    #[serde(flatten)]
    motion: robot::Motion,
    /// Axes that the user named; empty for all axes.
    axes: Vec<u32>,
    /// Target point; null for a motion without a point.
    point: Option<i32>,
    /// Pallet, and the position on the pallet; null for other motions.
    pallet: Option<i32>,
    work_position: Option<i32>,
    /// Direction of a jog or a similar motion: `plus` or `minus`; null for other motions.
    direction: Option<&'static str>,
    #[serde(skip)]
    words: String,
}

/// Targets of axes, in mm or in pulses.
fn targets(axes: &Axes, mm: &[String], pulses: &[String]) -> Vec<Target> {
    let (numbers, unit) = if mm.is_empty() { (pulses, Unit::Pulse) } else { (mm, Unit::Mm) };
    let pairs = axes.pairs(numbers).unwrap_or_default();
    pairs.into_iter().map(|(axis, text)| target(axis.to_string(), text, unit)).collect()
}

/// Returns the target of one axis; empty for a motion to a point.
fn single_target(axis: &str, mm: Option<&String>, pulses: Option<&String>) -> Vec<Target> {
    let mm = mm.map(|text| target(axis.to_owned(), text, Unit::Mm));
    mm.or_else(|| pulses.map(|text| target(axis.to_owned(), text, Unit::Pulse))).into_iter().collect()
}

fn target(axis: String, text: &str, unit: Unit) -> Target {
    Target { axis, from: None, to: text.parse().ok(), unit: unit.symbol() }
}

/// Fields that can contain the speed of a command: the key, the divisor of its value, and the unit.
const SPEEDS: [(Key, f64, &str); 3] =
    [(Key::SpeedPercent, 1.0, "%"), (Key::SpeedMmS, 1.0, "mm/s"), (Key::SpeedOfMax, 100.0, "%")];

impl MotionReport {
    fn new(words: String, order: &Order, answer: Option<&CommandResult>, unit: Option<Unit>) -> Self {
        let values = order.values();
        let field = |key| values.int(key);
        let axes = values.int(Key::Axes).unwrap_or_default();
        let robot = values.int(Key::Robot).filter(|robot| *robot > 0);
        let place = answer.zip(unit).and_then(|(answer, unit)| position(&answer.values, unit));
        let motion = robot::Motion {
            accepted: true,
            group: robot.map(|robot| group(Some(robot))),
            speed: SPEEDS.iter().find_map(|(key, by, unit)| {
                field(*key).map(|speed| robot::Speed { value: f64::from(speed) / by, unit })
            }),
            reached: answer.map(|_| true),
            position: place.map(|place| place.of_group(group(robot))),
            elapsed_ms: answer.map(|answer| u64::try_from(answer.elapsed.as_millis()).unwrap_or(u64::MAX)),
            ..robot::Motion::default()
        };
        Self {
            words,
            kind: order.row().id,
            motion,
            axes: (0..6).filter(|bit| axes >> bit & 1 == 1).map(|bit| bit + 1).collect(),
            point: field(Key::Point),
            pallet: field(Key::Pallet),
            work_position: field(Key::WorkPosition),
            direction: values.int(Key::Direction).map(|minus| if minus == 0 { "plus" } else { "minus" }),
        }
    }

    /// View with additional text after the duration.
    fn view_with(&self, more: &str) -> View {
        let elapsed = self.motion.elapsed_ms.map(|ms| format!(" in {}.{:03} s", ms / 1000, ms % 1000));
        let view = View::text(format!("{}{}{more}", self.words, elapsed.unwrap_or_default()));
        match &self.motion.position {
            Some(position) => view.append(Section::Table(joint_table(&position.joints))),
            None => view,
        }
    }
}

impl Report for MotionReport {
    fn view(&self) -> View {
        self.view_with("")
    }
}

#[cfg(test)]
pub mod tests;

//! `yrcx move` (4.2.1): to a point or two, or to coordinates.

use clap::{ArgGroup, Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::arguments::{Ending, Pace, Ramps, Speed};
use super::link::{Done, Link};
use super::position::Position;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::yrcx::order::{Draft, Order};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::{Section, View};

/// Moves to a point, or to coordinates.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("destination").required(true), after_help = "Without --speed the robot moves at the program speed. \
    While it moves the controller tells that it does and no position: it carries out one remote command at a time.")]
pub struct Move {
    /// Point to move to; two points of an arc with --circular, as in 100,101
    #[arg(long, value_name = "POINT", group = "destination", value_delimiter = ',')]
    point: Vec<u16>,
    /// Coordinates of the axes in mm, of all four or of those of --axes
    #[arg(long, value_name = "MM,…", group = "destination", value_delimiter = ',', allow_hyphen_values = true)]
    to: Vec<String>,
    /// Coordinates of the axes in pulses, likewise
    #[arg(long, value_name = "PULSES,…", group = "destination", value_delimiter = ',', allow_hyphen_values = true)]
    to_pulse: Vec<String>,
    /// In a straight line
    #[arg(long, group = "way", conflicts_with_all = ["to", "to_pulse"])]
    linear: bool,
    /// In an arc over the first point to the second
    #[arg(long, group = "way", conflicts_with_all = ["to", "to_pulse", "axes"])]
    circular: bool,
    /// In an arch: this axis goes to this position first, as in 3:10.0
    #[arg(long, group = "way", value_name = "AXIS:POS", conflicts_with_all = ["to", "to_pulse"], value_parser = arch)]
    arch: Option<Arch>,
    /// Where the arch begins; 0 unless given
    #[arg(long, value_name = "POS", requires = "arch", allow_hyphen_values = true)]
    arch_start: Option<String>,
    /// Where the arch ends; 0 unless given
    #[arg(long, value_name = "POS", requires = "arch", allow_hyphen_values = true)]
    arch_end: Option<String>,
    /// What positions of the arch are measured in
    #[arg(long, value_name = "UNIT", requires = "arch", default_value = "mm", hide_default_value = true)]
    arch_unit: super::position::Unit,
    /// Axes that move, as in 1,3; all unless given
    #[arg(long, value_name = "AXES")]
    axes: Option<String>,
    #[command(flatten)]
    pace: Pace,
    #[command(flatten)]
    ramps: Ramps,
    /// Hand system of the coordinates of --to
    #[arg(long, value_name = "HAND", conflicts_with_all = ["point", "to_pulse"])]
    hand: Option<Hand>,
    #[command(flatten)]
    ending: Ending,
}

/// On which side the elbow is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Hand {
    /// Right-handed
    Right,
    /// Left-handed
    Left,
}

/// An axis and a position as typed.
#[derive(Debug, Clone)]
struct Arch {
    axis: String,
    position: String,
}

fn arch(text: &str) -> Result<Arch, String> {
    let (axis, position) = text.split_once(':').ok_or("an arch is an axis and a position, as in 3:10.0")?;
    Ok(Arch { axis: axis.to_owned(), position: position.to_owned() })
}

impl Move {
    fn command(&self) -> table::Command {
        match self {
            Self { to, .. } if !to.is_empty() => table::Command::MoveMm,
            Self { to_pulse, .. } if !to_pulse.is_empty() => table::Command::MovePulse,
            Self { linear: true, .. } => table::Command::MoveLinear,
            Self { circular: true, .. } => table::Command::MoveCircular,
            Self { arch: Some(_), .. } => table::Command::MoveArch,
            _ => table::Command::MovePtp,
        }
    }

    fn order(&self, link: &Link) -> Result<Order, Failure> {
        let command = self.command();
        if let (Some(Speed::MmS(_)), false) = (&self.pace.speed, self.linear || self.circular) {
            return Err(
                Failure::usage("a speed in mm/s is for --linear and --circular").hint("give percent, as in --speed 50")
            );
        }
        let draft = self.target(link.draft(command)?.with_some(Key::Axes, self.axes.clone()))?;
        let draft = self.pace.put(self.ramps.put(draft));
        let draft = match &self.arch {
            None => draft,
            Some(Arch { axis, position }) => draft
                .with(Key::ArchUnit, i32::from(self.arch_unit == super::position::Unit::Mm))
                .with(Key::ArchAxis, axis.as_str())
                .with(Key::ArchPosition, position.as_str())
                .with_some(Key::ArchStart, self.arch_start.clone())
                .with_some(Key::ArchEnd, self.arch_end.clone()),
        };
        let hand = self.hand.map(|hand| if hand == Hand::Right { 1 } else { 2 });
        Ok(self.ending.put(draft.with_some(Key::HandSystem, hand)).build()?)
    }

    fn target(&self, draft: Draft) -> Result<Draft, Failure> {
        match (&self.point[..], self.circular) {
            ([], _) => {
                coordinates(draft, if self.to.is_empty() { &self.to_pulse } else { &self.to }, self.axes.as_deref())
            }
            ([point], false) => Ok(draft.with(Key::Point, *point)),
            ([first, second], true) => Ok(draft.with(Key::Point, *first).with(Key::Point2, *second)),
            (_, true) => Err(Failure::usage("an arc has two points").hint("name both: --point 100,101 --circular")),
            (_, false) => Err(Failure::usage("a motion has one point").hint("an arc has two: add --circular")),
        }
    }

    fn told(&self) -> String {
        let place = match (&self.point[..], &self.to[..], &self.to_pulse[..]) {
            ([first, second], ..) => format!("over point {first} to point {second}"),
            ([point, ..], ..) => format!("to point {point}"),
            (_, [_, ..], _) => format!("to {} mm", self.to.join(", ")),
            _ => format!("to {} pulses", self.to_pulse.join(", ")),
        };
        let way = match self.command() {
            table::Command::MoveLinear => ", in a straight line",
            table::Command::MoveCircular => ", in an arc",
            table::Command::MoveArch => ", in an arch",
            _ => "",
        };
        let axes = self.axes.as_ref().map(|axes| format!(" with axes {axes} alone")).unwrap_or_default();
        format!("{place}{way}{axes}{}", self.pace.told())
    }
}

/// A coordinate an axis: of all four, or of those that are named, in ascending order.
fn coordinates(draft: Draft, given: &[String], axes: Option<&str>) -> Result<Draft, Failure> {
    let named: Vec<usize> = match axes {
        None => vec![1, 2, 3, 4],
        Some(axes) => {
            let named: Result<Vec<usize>, _> = axes.split(',').map(|axis| axis.trim().parse()).collect();
            let mut named = named.map_err(|_| Failure::usage(format!("'{axes}' is no list of axes, such as 1,3")))?;
            named.sort_unstable();
            named
        }
    };
    if named.len() != given.len() {
        let message = format!("{} coordinates for {} axes", given.len(), named.len());
        return Err(Failure::usage(message).hint("give one for each axis; name the axes with --axes if not all move"));
    }
    let keys = named.iter().map(|axis| axis.checked_sub(1).and_then(|at| Key::AXES.get(at)).copied());
    keys.zip(given).try_fold(draft, |draft, (key, text)| match key {
        Some(key) => Ok(draft.with(key, text.trim())),
        None => Err(Failure::usage("axes are 1 to 4")),
    })
}

impl Command for Move {
    type Family = Family;
    type Report = Moved;
    const ID: &'static str = "yrcx.move";

    fn risk(&self) -> Risk {
        self.command().row().risk
    }

    fn intent(&self) -> String {
        format!("move the robot {}", self.told())
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Moved, Failure> {
        let order = self.order(context.link)?;
        carry_out(context.link, context.screen, &order, &self.ending, &self.told()).await
    }
}

/// Carries out a motion and waits for its end, unless that is not wanted.
pub(super) async fn carry_out(
    link: &mut Link,
    screen: &Screen,
    order: &Order,
    ending: &Ending,
    told: &str,
) -> Result<Moved, Failure> {
    let done = if ending.no_wait {
        link.begin_run(order).await?
    } else {
        let _progress = (!link.is_dry()).then(|| screen.spinner(&format!("moving {told}")));
        Some(link.run(order).await?)
    };
    Ok(Moved::new(told, done.as_ref(), ending))
}

/// What came of a motion.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Moved {
    /// In words.
    done: String,
    /// Whether the motion has ended; false only with --no-wait.
    ended: bool,
    /// From sending the command to its end; null unless it has ended.
    elapsed_ms: Option<u64>,
    /// Where the robot is at the end, with --report.
    #[serde(flatten)]
    position: Position,
}

impl Moved {
    fn new(told: &str, done: Option<&Done>, ending: &Ending) -> Self {
        Self {
            done: format!("{} {told}", if done.is_some() { "moved" } else { "moving" }),
            ended: done.is_some(),
            elapsed_ms: done.map(|done| u64::try_from(done.elapsed.as_millis()).unwrap_or(u64::MAX)),
            position: done.map(|done| Position::of(&done.values, ending.report)).unwrap_or_default(),
        }
    }
}

impl Report for Moved {
    fn view(&self) -> View {
        let elapsed = self.elapsed_ms.map(|ms| format!(" in {}.{:03} s", ms / 1000, ms % 1000)).unwrap_or_default();
        let view = View::text(format!("{}{elapsed}", self.done));
        match self.position.table() {
            Some(table) => view.and(Section::Table(table)),
            None => view,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{example, intent, objection, words};
    use crate::failure::Kind;

    #[test]
    fn the_walk_through_of_the_manual() {
        let sent = words(&["move", "--point", "19", "--speed", "50"]).unwrap();
        assert_eq!(sent, [example("2-ptp-walkthrough")]);
        assert_eq!(sent[0][..5], ["0x0001", "0x0004", "0x0000", "0x0032", "0x0013"]);
    }

    #[test]
    fn the_examples_of_the_manual() {
        for (id, line) in [
            ("4.2.1-ptp", "move --point 100 --speed 50 --report pulse"),
            ("4.2.1-arch", "move --point 100 --speed 50 --arch 3:1.000 --arch-start 0 --arch-end 0 --report mm"),
            ("4.2.1-linear", "move --point 100 --linear --speed 200mm/s --accel 50 --report mm"),
            ("4.2.1-circular", "move --point 100,101 --circular --speed 20 --decel 50 --report mm"),
            ("4.2.1-direct-mm", "move --to 10,-20,5,-18 --speed 50 --report mm"),
        ] {
            assert_eq!(words(&line.split(' ').collect::<Vec<_>>()).unwrap(), [example(id)], "{id}");
        }
    }

    #[test]
    fn some_axes_and_another_robot() {
        let sent = words(&["--unit", "2", "move", "--to", "1.5,-2", "--axes", "1,3", "--hand", "left"]).unwrap();
        assert_eq!(
            sent[0][..10],
            ["0x2006", "0x0011", "0x0005", "0x0000", "0x05DC", "0x0000", "0x0000", "0x0000", "0xF830", "0xFFFF"]
        );
        let sent = words(&["move", "--point", "1", "--unit=4", "--speed-of-max", "12.34"]).unwrap();
        assert_eq!(sent[0][..5], ["0x4001", "0x0002", "0x0000", "0x04D2", "0x0001"]);
    }

    #[test]
    fn what_cannot_be_meant_is_refused_here() {
        for (line, part) in [
            ("move --to 1,2,3", "3 coordinates for 4 axes"),
            ("move --to 1,2 --axes 1", "2 coordinates for 1 axes"),
            ("move --to 1 --axes 5", "axes are 1 to 4"),
            ("move --to 1.0005,2,3,4", "axis_1"),
            ("move --point 30000", "point: 30000 is out of range"),
            ("move --point 1 --speed 101", "speed_percent: 101 is out of range"),
            ("move --point 1 --speed 100mm/s", "--linear and --circular"),
            ("move --point 1 --circular", "two points"),
            ("move --point 1,2", "one point"),
            ("move --point 1 --arch 1,2:5", "arch_axis"),
            ("move --point 1 --arch 1:5 --accel 5", "accel_percent"),
        ] {
            let failure = words(&line.split(' ').collect::<Vec<_>>()).unwrap_err();
            assert_eq!(failure.kind, Kind::Usage, "{line}");
            assert!(failure.message.contains(part), "{line}: {failure}");
        }
        for (line, part) in [
            ("move", "--point"),
            ("move --point 1 --to 1,2,3,4", "cannot be used with"),
            ("move --to 1,2,3,4 --linear", "cannot be used with"),
            ("move --point 1 --hand left", "cannot be used with"),
            ("move --point 1 --unit 5", "0..=4"),
        ] {
            let objection = objection(&line.split(' ').collect::<Vec<_>>());
            assert!(objection.contains(part), "{line}: {objection}");
        }
    }

    #[test]
    fn the_question_names_target_and_speed() {
        assert_eq!(intent(&["move", "--point", "19", "--speed", "50"]), "move the robot to point 19 at 50 %");
        assert_eq!(
            intent(&["--unit", "2", "move", "--to", "1,2", "--axes", "1,2"]),
            "move the robot to 1, 2 mm with axes 1,2 alone, robot 2"
        );
    }
}

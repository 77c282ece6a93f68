//! Arguments that several motion commands use. Numbers stay text: the codec parses each number in the unit of its field
//! and checks the range.

use super::position::Unit;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_frame::wait_arguments::MotionEnd;

/// Robot that `--unit` selects, for the confirmation question before a motion.
#[derive(Debug, Clone, Copy, Args)]
pub struct UnitArgument {
    #[arg(from_global)]
    unit: u8,
}

impl UnitArgument {
    /// Name of the robot, for example `robot 2`; without `--unit`, `robot 1`.
    pub fn name(self) -> String {
        format!("robot {}", self.unit.max(1))
    }

    /// Name of the robot, for example `robot 2`; without `--unit`, `all robots`.
    pub fn name_or_all(self) -> String {
        if self.unit == 0 { "all robots".to_owned() } else { self.name() }
    }
}

/// Speed options.
#[derive(Debug, Args)]
pub struct SpeedArguments {
    /// Speed in percent, for example 50 or 50%. It replaces the program speed
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    pub speed: Option<Speed>,
    /// Speed in percent of the robot's maximum, in steps of 0.01
    #[arg(long, value_name = "PERCENT", conflicts_with = "speed")]
    pub speed_of_max: Option<String>,
}

/// A speed as the user typed it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Speed {
    /// Speed in percent, instead of the program speed.
    Percent(String),
    /// Speed of the tool in mm/s.
    MmS(String),
}

const WHOLE: &str = "a speed is a whole percentage such as 50 or 50%, or a speed such as 200mm/s; --speed-of-max \
                     accepts steps of 0.01 %";

fn speed(text: &str) -> Result<Speed, String> {
    let number = |text: &str| {
        let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if is_number { Ok(text.to_owned()) } else { Err(WHOLE) }
    };
    let speed = match text.strip_suffix("mm/s") {
        Some(text) => number(text).map(Speed::MmS),
        None => number(text.strip_suffix('%').unwrap_or(text)).map(Speed::Percent),
    };
    speed.map_err(str::to_owned)
}

impl SpeedArguments {
    /// Sets the speed for a motion of axes; a speed in mm/s is an error.
    pub fn apply_to(&self, draft: Draft) -> Result<Draft> {
        match &self.speed {
            Some(Speed::MmS(_)) => Err(Failure::usage("a speed in mm/s needs a linear or circular move")
                .hint("use percent, such as --speed 50, or add --linear")),
            _ => Ok(self.apply_linear(draft)),
        }
    }

    /// Sets the speed for a linear or circular motion.
    pub fn apply_linear(&self, draft: Draft) -> Draft {
        let draft = draft.with_some(Key::SpeedOfMax, self.speed_of_max.clone());
        match self.speed.clone() {
            None => draft,
            Some(Speed::Percent(text)) => draft.with(Key::SpeedPercent, text),
            Some(Speed::MmS(text)) => draft.with(Key::SpeedMmS, text),
        }
    }

    /// Describes the speed, for example `at 50 %`.
    pub fn describe(&self) -> String {
        match (&self.speed, &self.speed_of_max) {
            (Some(Speed::Percent(percent)), _) => format!("at {percent} %"),
            (Some(Speed::MmS(mm_s)), _) => format!("at {mm_s} mm/s"),
            (None, Some(percent)) => format!("at {percent} % of the maximum"),
            (None, None) => "at the program speed".to_owned(),
        }
    }
}

/// Acceleration and deceleration options.
#[derive(Debug, Args)]
pub struct Ramps {
    /// Acceleration in percent
    #[arg(long, value_name = "PERCENT")]
    accel: Option<String>,
    /// Deceleration in percent
    #[arg(long, value_name = "PERCENT")]
    decel: Option<String>,
}

impl Ramps {
    /// Sets acceleration and deceleration, if the command has the fields.
    pub fn apply_to(&self, draft: Draft, command: Command) -> Result<Draft> {
        let row = command.row();
        if (self.accel.is_some() || self.decel.is_some()) && row.request().all(|field| field.key != Key::Accel) {
            return Err(Failure::usage(format!("{} has neither --accel nor --decel", row.id)).hint(
                "remove --accel and --decel: moves to coordinates and moves with --arch do not accept them, and use \
                 the robot's parameters",
            ));
        }
        Ok(draft.with_some(Key::Accel, self.accel.clone()).with_some(Key::Decel, self.decel.clone()))
    }
}

/// Selection of the axes that move.
#[derive(Debug, Args)]
pub struct Axes {
    /// Axes that move, for example 1,3 [default: all axes]
    #[arg(long, value_name = "AXES")]
    axes: Option<String>,
}

impl Axes {
    /// Sets the axes that move.
    pub fn apply_to(&self, draft: Draft) -> Draft {
        draft.with_some(Key::Axes, self.axes.clone())
    }

    /// Sets the axes that move, and a number for each axis; see [`Axes::pairs`].
    pub fn apply_numbers(&self, draft: Draft, given: &[String]) -> Result<Draft> {
        let pairs = self.pairs(given)?;
        let draft = if self.names_axes(given) {
            let axes: Vec<String> = pairs.iter().map(|(axis, _)| axis.to_string()).collect();
            draft.with(Key::Axes, axes.join(","))
        } else {
            draft
        };
        Ok(pairs.into_iter().fold(draft, |draft, (axis, text)| draft.with(Key::AXES[axis - 1], text)))
    }

    /// Returns a pair of axis (1 to 4) and number for each number, in the order typed. `--axes 3,2 --to 10,20` and
    /// `--to 3=10,2=20` give equal pairs.
    pub fn pairs<'a>(&self, given: &'a [String]) -> Result<Vec<(usize, &'a str)>> {
        let named: Vec<Option<(&str, &str)>> = given.iter().map(|text| text.split_once('=')).collect();
        let pairs: Vec<(usize, &str)> = match named.into_iter().collect::<Option<Vec<_>>>() {
            Some(_) if self.axes.is_some() => {
                return Err(Failure::usage("the axes are typed twice: with --axes and with the numbers")
                    .hint("type each axis once, such as --to 1=300,3=10"));
            }
            Some(named) => {
                let pairs = named.into_iter().map(|(name, text)| axis(name).map(|axis| (axis, text.trim())));
                pairs.collect::<Result<_>>()?
            }
            None if given.iter().any(|text| text.contains('=')) => {
                return Err(Failure::usage("some numbers have an axis, and other numbers have no axis")
                    .hint("type the axis of each number, such as --to 1=300,3=10"));
            }
            None => {
                let axes = self.numbers()?;
                if axes.len() != given.len() {
                    let message = format!("{} numbers for {} axes", given.len(), axes.len());
                    return Err(Failure::usage(message)
                        .hint("type one number for each axis, or type the axes that move, such as --to 1=300,3=10"));
                }
                axes.into_iter().zip(given.iter().map(|text| text.trim())).collect()
            }
        };
        let mut seen = [false; 4];
        for (axis, _) in &pairs {
            if std::mem::replace(&mut seen[axis - 1], true) {
                return Err(Failure::usage(format!("axis {axis} appears twice")).hint("type each axis once"));
            }
        }
        Ok(pairs)
    }

    /// Whether the user named the axes; axes without a name then do not move.
    fn names_axes(&self, given: &[String]) -> bool {
        self.axes.is_some() || given.iter().any(|text| text.contains('='))
    }

    fn numbers(&self) -> Result<Vec<usize>> {
        let Some(axes) = &self.axes else { return Ok((1..=4).collect()) };
        let wrong = || format!("'{axes}' is not a valid list of axes from 1 to 4, such as 1,3");
        let number = |text: &str| axis(text).map_err(|_| wrong());
        let ranges = axes.split(',').map(|text| user_input::range(text, number)).collect::<Result<Vec<_>, String>>();
        let ranges = ranges.map_err(|why| Failure::usage(why).hint("type axis numbers with commas, such as 1,3"))?;
        Ok(ranges.into_iter().flatten().collect())
    }

    /// Returns axis 1, axis 2 or both axes, if the numbers do not name them (4.2.1); empty if all axes move.
    pub fn unnamed_axes(&self, given: &[String]) -> Vec<usize> {
        let named = self.pairs(given).unwrap_or_default();
        let is_named = |axis: &usize| named.iter().any(|(named, _)| named == axis);
        if named.is_empty() { Vec::new() } else { (1..=2).filter(|axis| !is_named(axis)).collect() }
    }

    /// Whether axis 1 or 2 does not move in a motion to these points.
    pub fn omits_axis(&self, points: &[String]) -> bool {
        let named = self.numbers().unwrap_or_default();
        !points.is_empty() && self.axes.is_some() && !(named.contains(&1) && named.contains(&2))
    }

    /// Describes the axes and their numbers, for example `axis 3: 10 mm, axis 2: 20 mm`.
    pub fn describe_numbers(&self, given: &[String], unit: Unit) -> String {
        match self.pairs(given) {
            Ok(pairs) => {
                let told = pairs.iter().map(|(axis, text)| format!("axis {axis}: {text} {}", unit.symbol()));
                told.collect::<Vec<_>>().join(", ")
            }
            // The codec rejects an invalid number before anything moves.
            Err(_) => format!("{} {}", given.join(", "), unit.symbol()),
        }
    }

    /// Describes the axes that move, for example `all axes` or `axes 3, 1 alone`. The numbers in `given` may name the
    /// axes.
    pub fn describe(&self, given: &[String]) -> String {
        let axes = match (&self.axes, self.pairs(given)) {
            (_, Ok(pairs)) if !given.is_empty() && self.names_axes(given) => {
                pairs.iter().map(|(axis, _)| axis.to_string()).collect::<Vec<_>>().join(", ")
            }
            (Some(axes), _) => axes.clone(),
            (None, _) => return "all axes".to_owned(),
        };
        let noun = if axes.contains(',') { "axes" } else { "axis" };
        format!("{noun} {axes} alone")
    }
}

/// Parses an axis number.
fn axis(text: &str) -> Result<usize> {
    match text.trim().parse() {
        Ok(axis @ 1..=4) => Ok(axis),
        _ => {
            Err(Failure::usage(format!("'{text}' is not a valid axis; the axes are 1 to 4")).hint("use an axis number"))
        }
    }
}

/// Options of an arch motion.
#[derive(Debug, Args)]
pub struct Arch {
    /// Arch motion: arch axis and its arch position, for example 3:10.0
    #[arg(long = "arch", group = "way", value_name = "AXIS:POS", value_parser = peak)]
    peak: Option<ArchPeak>,
    /// Start of the arch [default: 0]
    #[arg(long, value_name = "POS", requires = "peak", allow_hyphen_values = true)]
    arch_start: Option<String>,
    /// End of the arch [default: 0]
    #[arg(long, value_name = "POS", requires = "peak", allow_hyphen_values = true)]
    arch_end: Option<String>,
    /// Unit of the arch positions
    #[arg(long, value_name = "UNIT", requires = "peak", default_value = "mm", hide_default_value = true)]
    arch_unit: Unit,
}

/// An axis and a position as the user typed them.
#[derive(Debug, Clone)]
struct ArchPeak {
    axis: String,
    position: String,
}

fn peak(text: &str) -> Result<ArchPeak, String> {
    let (axis, position) = text.split_once(':').ok_or("an arch is an axis and a position, such as 3:10.0")?;
    Ok(ArchPeak { axis: axis.to_owned(), position: position.to_owned() })
}

impl Arch {
    /// Whether the user requested an arch.
    pub fn is_wanted(&self) -> bool {
        self.peak.is_some()
    }

    /// Sets the arch, if the user requested one.
    pub fn apply_to(&self, draft: Draft) -> Draft {
        let Some(ArchPeak { axis, position }) = &self.peak else { return draft };
        draft
            .with(Key::ArchUnit, i32::from(self.arch_unit == Unit::Mm))
            .with(Key::ArchAxis, axis.as_str())
            .with(Key::ArchPosition, position.as_str())
            .with_some(Key::ArchStart, self.arch_start.clone())
            .with_some(Key::ArchEnd, self.arch_end.clone())
    }

    /// Describes the arch, for example ` in an arch over axis 3 at 10.0 mm`; empty without an arch.
    pub fn describe(&self) -> String {
        let Some(ArchPeak { axis, position }) = &self.peak else { return String::new() };
        format!(" in an arch over axis {axis} at {position} {}", self.arch_unit.symbol())
    }
}

/// Arm side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Hand {
    /// Right-handed
    Right,
    /// Left-handed
    Left,
}

impl Hand {
    /// Returns the field value for a target in mm. The command that selects the arm uses other values.
    pub fn of_target(self) -> i32 {
        match self {
            Self::Right => 1,
            Self::Left => 2,
        }
    }
}

/// Coordinate system of a jog or an inching motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum System {
    /// A single axis of the robot
    Pulse,
    /// Along an axis of the Cartesian coordinates
    Cartesian,
    /// Along an axis of the tool coordinates
    Tool,
}

impl System {
    /// Returns the unit in which the controller reports positions.
    pub fn unit(self) -> Unit {
        if self == Self::Pulse { Unit::Pulse } else { Unit::Mm }
    }

    /// Describes the coordinate system, for example ` in Cartesian coordinates`; empty for a single axis.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Pulse => "",
            Self::Cartesian => " in Cartesian coordinates",
            Self::Tool => " in tool coordinates",
        }
    }
}

/// Direction of a motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Direction {
    /// Plus
    #[value(name = "+", alias = "plus")]
    Plus,
    /// Minus
    #[value(name = "-", alias = "minus")]
    Minus,
}

impl Direction {
    /// Returns the value of the direction field.
    pub fn value(self) -> i32 {
        (self == Self::Minus).into()
    }

    /// Describes the direction, for example `in plus direction`.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Plus => "in plus direction",
            Self::Minus => "in minus direction",
        }
    }
}

/// Options for the position report and the end of a motion.
#[derive(Debug, Args)]
pub struct EndOptions {
    /// Report the position after the motion, in this unit
    #[arg(long, value_name = "UNIT")]
    pub report: Option<Unit>,
    #[command(flatten)]
    pub end: MotionEnd,
}

impl EndOptions {
    /// Requests the position after the motion in `unit`, if there is one.
    pub fn apply_to(draft: Draft, unit: Option<Unit>) -> Draft {
        draft.with_some(Key::Report, unit.map(Unit::report))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_require_a_unit() {
        assert_eq!(speed("50"), Ok(Speed::Percent("50".to_owned())));
        assert_eq!(speed("50%"), Ok(Speed::Percent("50".to_owned())));
        assert_eq!(speed("200mm/s"), Ok(Speed::MmS("200".to_owned())));
        for wrong in ["", "%", "mm/s", "-5", "5.5", "fast", "5 %"] {
            assert!(speed(wrong).is_err(), "{wrong}");
        }
    }
}

//! Arguments of a move. They are converted exactly to the integers of the protocol.

use crate::number_arguments::parse_in_range;
use crate::position::{extended_words, form_words, in_a_line};
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::units::{self, Unit};
use armctl_controller::yerc::payload::{ExtendedForm, Form, SpeedClass};
use armctl_controller::yerc::variables::Reference;
use armctl_frame::robot::motion;
use armctl_frame::wait_arguments::MotionEnd;

/// Group that moves, and the options for the wait.
#[derive(Debug, Args)]
pub(super) struct Mover {
    /// Robot (R1 …) or station (S1 …) that moves
    #[arg(long, default_value = "R1", value_parser = mover)]
    pub(super) group: Group,
    #[command(flatten)]
    pub(super) end: MotionEnd,
}

impl Mover {
    /// Words of the frame: robot number and station number. One of them is 0.
    pub(super) fn words(&self) -> (u32, u32) {
        match self.group {
            Group::Robot(number) => (number.into(), 0),
            Group::Base(_) => (0, 0),
            Group::Station(number) => (0, number.into()),
        }
    }
}

fn mover(text: &str) -> Result<Group, String> {
    match text.parse()? {
        group @ Group::Base(_) => Err(format!("{group} moves with its robot: select the robot and use --base-axes")),
        group => Ok(group),
    }
}

/// Target of a move.
#[derive(Debug, Args)]
pub(super) struct To {
    /// Target: x, y, z in mm and rx, ry, rz in degrees; or a position variable, such as P2 or its name
    #[arg(long, value_name = "X,Y,Z,RX,RY,RZ|REF", allow_hyphen_values = true, value_parser = parse_target, add = complete::VARIABLE,
        conflicts_with_all = ["x", "y", "z", "rx", "ry", "rz"])]
    to: Option<ParsedTarget>,
    /// Target as axis angles in degrees. The robot must have the setting pulses_per_degree in robots.toml
    #[arg(long, value_name = "S,L,U,R,B,T[,E]", allow_hyphen_values = true, value_parser = axis_degrees,
        conflicts_with_all = ["to", "x", "y", "z", "rx", "ry", "rz"])]
    deg: Option<Destination>,
    #[command(flatten)]
    single: Single<true>,
}

impl To {
    /// The six coordinates; `None` if the user gave none. This is valid only for a station.
    pub(super) fn coordinates(&self) -> Option<[i32; 6]> {
        if let Some(ParsedTarget::Coordinates(to)) = &self.to {
            return Some(*to);
        }
        let [x, y, z, rx, ry, rz] = self.single.values();
        Some([x?, y?, z?, rx?, ry?, rz?])
    }

    /// Target that is not given as coordinates.
    pub(super) fn destination(&self) -> Option<Destination> {
        match &self.to {
            Some(ParsedTarget::Variable(variable)) => Some(Destination::Variable(*variable)),
            Some(ParsedTarget::Coordinates(_)) | None => self.deg.clone(),
        }
    }
}

/// Value of `--to`.
#[derive(Debug, Clone, PartialEq)]
enum ParsedTarget {
    Coordinates([i32; 6]),
    Variable(Reference),
}

/// Target of a move that is not given as coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Destination {
    /// The position in a variable.
    Variable(Reference),
    /// Axis angles in degrees.
    Degrees(Vec<f64>),
}

impl fmt::Display for Destination {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Variable(variable) => variable.fmt(f),
            Self::Degrees(degrees) => {
                let degrees: Vec<String> = degrees.iter().map(f64::to_string).collect();
                write!(f, "{} deg", degrees.join(","))
            }
        }
    }
}

fn parse_target(text: &str) -> Result<ParsedTarget, String> {
    names::parse_or_name(&[Kind::Variable], "P0", text, coordinates_or_variable)
}

fn coordinates_or_variable(text: &str) -> Result<ParsedTarget, String> {
    if !text.starts_with(|first: char| first.is_ascii_alphabetic()) {
        return coordinates(text).map(ParsedTarget::Coordinates);
    }
    let variable: Reference = text.parse().map_err(|error| format!("{error}"))?;
    if !variable.kind.is_position() {
        return Err(format!("{variable} is not a position variable; use P or EX"));
    }
    Ok(ParsedTarget::Variable(variable))
}

/// Angles in degrees. There must be as many angles as a robot requires axes.
fn axis_degrees(text: &str) -> Result<Destination, String> {
    let degrees: Vec<f64> = text
        .split(',')
        .map(|angle| match angle.trim().parse::<f64>() {
            Ok(degrees) if degrees.is_finite() => Ok(degrees),
            _ => Err(format!("'{angle}' is not a number of degrees")),
        })
        .collect::<Result<_, _>>()?;
    if ROBOT.contains(&degrees.len()) {
        return Ok(Destination::Degrees(degrees));
    }
    Err(format!("expected {} to {} numbers of degrees, {} given", ROBOT.start(), ROBOT.end(), degrees.len()))
}

/// Distance of a relative move.
#[derive(Debug, Args)]
pub(super) struct By {
    /// Distance: x, y, z in mm and rx, ry, rz in degrees
    #[arg(long, alias = "to", value_name = "X,Y,Z,RX,RY,RZ", allow_hyphen_values = true, value_parser = coordinates,
        conflicts_with_all = ["x", "y", "z", "rx", "ry", "rz"],
        required_unless_present_any = ["x", "y", "z", "rx", "ry", "rz", "base_axes", "station_axes"])]
    by: Option<[i32; 6]>,
    #[command(flatten)]
    single: Single<false>,
}

impl By {
    /// The six distances. Missing distances are 0.
    pub(super) fn distances(&self) -> [i32; 6] {
        self.by.unwrap_or_else(|| self.single.values().map(Option::unwrap_or_default))
    }
}

/// Single coordinates. A target requires all six, because a missing coordinate must not become 0.
#[derive(Debug)]
struct Single<const ALL: bool>([Option<i32>; 6]);

impl<const ALL: bool> Single<ALL> {
    fn values(&self) -> [Option<i32>; 6] {
        self.0
    }
}

/// Argument id of each coordinate.
const COORDINATES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl<const ALL: bool> Args for Single<ALL> {
    fn augment_args(command: clap::Command) -> clap::Command {
        COORDINATES.iter().enumerate().fold(command, |command, (axis, id)| {
            let arg = clap::Arg::new(*id).long(*id).allow_hyphen_values(true);
            let arg = match axis {
                0..=2 => arg.value_name("MM").value_parser(millimetres).help("Coordinate in mm"),
                _ => arg.value_name("DEG").value_parser(degrees).help("Angle in degrees"),
            };
            command.arg(if ALL { arg.required_unless_present_any(["to", "deg", "station_axes"]) } else { arg })
        })
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl<const ALL: bool> clap::FromArgMatches for Single<ALL> {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self(COORDINATES.map(|id| matches.get_one(id).copied())))
    }

    fn update_from_arg_matches(&mut self, matches: &clap::ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Coordinate system, tool and user coordinate of the coordinates.
#[derive(Debug, Args)]
pub(super) struct Frame {
    /// Coordinate system of the numbers [default: base]
    #[arg(long, value_enum)]
    pub(super) coordinate: Option<Coordinate>,
    /// Tool number [default: 0]
    #[arg(long, value_name = "N", value_parser = parse_in_range::<u32>(0, 63))]
    pub(super) tool: Option<u32>,
    /// User coordinate number [default: 0]
    #[arg(long, value_name = "N", required_if_eq("coordinate", "user"), value_parser = parse_in_range::<u32>(0, 63))]
    pub(super) user: Option<u32>,
}

/// Coordinate system of a move.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Coordinate {
    /// Base coordinates
    Base,
    /// Robot coordinates
    Robot,
    /// User coordinates, selected with --user
    User,
    /// Tool coordinates
    Tool,
}

impl From<Coordinate> for PositionKind {
    fn from(coordinate: Coordinate) -> Self {
        match coordinate {
            Coordinate::Base => Self::Base,
            Coordinate::Robot => Self::Robot,
            Coordinate::User => Self::User,
            Coordinate::Tool => Self::Tool,
        }
    }
}

impl Frame {
    /// Type of the position with these coordinates.
    pub(super) fn kind(&self) -> PositionKind {
        self.coordinate.unwrap_or(Coordinate::Base).into()
    }

    pub(super) fn tool(&self) -> u32 {
        self.tool.unwrap_or(0)
    }

    pub(super) fn user(&self) -> u32 {
        self.user.unwrap_or(0)
    }

    /// Coordinate system and tool as text for the confirmation.
    pub(super) fn describe(&self) -> String {
        let name = match self.coordinate.unwrap_or(Coordinate::Base) {
            Coordinate::Base => "base coordinates".to_owned(),
            Coordinate::Robot => "robot coordinates".to_owned(),
            Coordinate::User => format!("user coordinates {}", self.user()),
            Coordinate::Tool => "tool coordinates".to_owned(),
        };
        format!("{name}, tool {}", self.tool())
    }
}

/// Arm configuration at the target.
#[derive(Debug, Args)]
pub(super) struct Forms {
    /// Arm form: front|back, upper|lower, flip|noflip, r-lt180|r-ge180, t-lt180|t-ge180, s-lt180|s-ge180. The first
    /// word of each pair is the default [default: front,upper,flip]
    #[arg(long, value_name = "WORD,…", value_parser = form)]
    pub(super) form: Option<Form>,
    /// Extended form, in the same way: l-lt180|l-ge180, and the same two words with u-, b-, e- and w- [default:
    /// l-lt180]
    #[arg(long, value_name = "WORD,…", value_parser = extended_form)]
    pub(super) extended_form: Option<ExtendedForm>,
}

impl Forms {
    pub(super) fn form(&self) -> Form {
        self.form.unwrap_or_default()
    }

    pub(super) fn extended_form(&self) -> ExtendedForm {
        self.extended_form.unwrap_or_default()
    }

    /// Arm form as text for the confirmation.
    pub(super) fn describe(&self) -> String {
        let extended = extended_words(self.extended_form());
        let plus = if extended.is_empty() { "" } else { "+" };
        format!("form {}{plus}{extended}", form_words(self.form()))
    }
}

/// Number of bits that a move defines. The other bits are reserved (FS and DX 3.3.39).
const MOVE_FORM_BITS: usize = 6;
const MOVE_EXTENDED_FORM_BITS: usize = 5;

fn form(text: &str) -> Result<Form, String> {
    bits(text, MOVE_FORM_BITS, |word| Form(word).words().collect()).map(Form)
}

fn extended_form(text: &str) -> Result<ExtendedForm, String> {
    bits(text, MOVE_EXTENDED_FORM_BITS, |word| ExtendedForm(word).words().collect()).map(ExtendedForm)
}

/// Parses words of a form. `words` returns the words for a value, bit 0 first.
fn bits(text: &str, count: usize, words: impl Fn(u32) -> Vec<&'static str>) -> Result<u32, String> {
    let (clear, set) = (words(0), words(u32::MAX));
    let pairs = clear.iter().zip(&set).take(count);
    let (mut given, mut value) = (0_u32, 0_u32);
    for word in text.split([',', '+']).map(str::trim) {
        let found =
            pairs.clone().position(|(clear, set)| word.eq_ignore_ascii_case(clear) || word.eq_ignore_ascii_case(set));
        let Some(bit) = found else {
            let all: Vec<String> = pairs.map(|(clear, set)| format!("{clear}|{set}")).collect();
            return Err(format!("'{word}' is not one of {}", all.join(", ")));
        };
        if given >> bit & 1 == 1 {
            return Err(format!("'{word}': {}|{} appears twice", clear[bit], set[bit]));
        }
        given |= 1 << bit;
        value |= u32::from(word.eq_ignore_ascii_case(set[bit])) << bit;
    }
    Ok(value)
}

/// Speed as integer and class of the protocol.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Speed {
    pub(super) class: SpeedClass,
    pub(super) word: u32,
}

/// Full speed: 100 % in units of 0.01 %.
const FULL_SPEED: u32 = 10_000;
/// Suffix, class and unit for each way to write a speed.
const SPEEDS: [(&str, SpeedClass, Unit); 3] = [
    ("%", SpeedClass::Percent, units::PERCENT),
    ("mm/s", SpeedClass::Linear, units::MILLIMETRE_PER_SECOND),
    ("deg/s", SpeedClass::Angular, units::DEGREE_PER_SECOND),
];

impl Speed {
    /// Parses the speed of a joint move, for example `10%`.
    pub(super) fn percent(text: &str) -> Result<Self, String> {
        // A number without a unit is in percent.
        let bare = text.trim_end().ends_with(|last: char| last.is_ascii_digit()).then(|| format!("{text}%"));
        match Self::parse(bare.as_deref().unwrap_or(text))? {
            Self { class: SpeedClass::Percent, word } if word > FULL_SPEED => {
                Err(format!("'{text}' is more than 100%"))
            }
            speed @ Self { class: SpeedClass::Percent, .. } => Ok(speed),
            _ => Err("the speed of a joint move must be in percent, such as 10%".to_owned()),
        }
    }

    /// Parses the speed of a linear move, for example `100mm/s` or `20deg/s`.
    pub(super) fn path(text: &str) -> Result<Self, String> {
        match Self::parse(text)? {
            Self { class: SpeedClass::Percent, .. } => {
                Err("the speed of a linear move must be in mm/s or deg/s, such as 100mm/s".to_owned())
            }
            speed => Ok(speed),
        }
    }

    /// Speed for reports.
    pub(super) fn reported(self) -> motion::Speed {
        let (unit, by) = SPEEDS
            .iter()
            .find(|(_, class, _)| *class == self.class)
            .map_or(("", 1), |(unit, _, decimal)| (*unit, 10_u32.pow(decimal.decimals.into())));
        motion::Speed { value: f64::from(self.word) / f64::from(by), unit }
    }

    fn parse(text: &str) -> Result<Self, String> {
        let found = SPEEDS.iter().find_map(|(suffix, class, unit)| Some((text.strip_suffix(suffix)?, *class, *unit)));
        let (number, class, unit) = found.ok_or("a speed needs a unit: 10%, 100mm/s or 20deg/s")?;
        let word = unit.parse(number.trim_end()).map_err(|error| error.to_string())?;
        match u32::try_from(word) {
            Ok(word @ 1..) => Ok(Self { class, word }),
            _ => Err(format!("'{text}' is not a valid speed: a speed must be more than 0")),
        }
    }
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = SPEEDS.iter().find(|row| row.1 == self.class).map_or(units::PERCENT, |row| row.2);
        write!(f, "{} {}", unit.show_unsigned(self.word), unit.symbol)
    }
}

/// Values of axes, in protocol units.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Values(pub(super) Vec<i32>);

impl Values {
    /// Values for a field of `N` words. Missing values are 0.
    pub(super) fn with_zeros<const N: usize>(&self) -> [i32; N] {
        let mut words = [0; N];
        for (word, value) in words.iter_mut().zip(&self.0) {
            *word = *value;
        }
        words
    }
}

/// Maximum number of base axes in a move.
const MAX_BASE: usize = 3;
/// Maximum number of station axes in a move.
const MAX_STATION: usize = 6;
/// Numbers of robot axes that a target can have, from the required number to the maximum.
const ROBOT: std::ops::RangeInclusive<usize> = 6..=8;

/// Parses the base axes of a cartesian move, in mm.
pub(super) fn base_lengths(text: &str) -> Result<Values, String> {
    list(text, units::MILLIMETRE, 1..=MAX_BASE)
}

/// Parses the base axes of a pulse move.
pub(super) fn base_pulses(text: &str) -> Result<Values, String> {
    list(text, units::PULSE, 1..=MAX_BASE)
}

/// Parses station axes.
pub(super) fn station_pulses(text: &str) -> Result<Values, String> {
    list(text, units::PULSE, 1..=MAX_STATION)
}

/// Parses robot axes.
pub(super) fn robot_pulses(text: &str) -> Result<Values, String> {
    list(text, units::PULSE, ROBOT)
}

fn list(text: &str, unit: Unit, count: std::ops::RangeInclusive<usize>) -> Result<Values, String> {
    let values = text.split(',').map(|value| unit.parse_steps(value.trim())).collect::<Result<Vec<_>, _>>();
    let values = values.map_err(|error| error.to_string())?;
    if count.contains(&values.len()) {
        return Ok(Values(values));
    }
    Err(format!("expected {} to {} numbers of {}, {} given", count.start(), count.end(), unit.symbol, values.len()))
}

fn coordinates(text: &str) -> Result<[i32; 6], String> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    let invalid = || format!("expected six numbers x,y,z,rx,ry,rz; {} given", parts.len());
    let parts: [&str; 6] = parts.as_slice().try_into().map_err(|_| invalid())?;
    let mut values = [0; 6];
    for (axis, (value, part)) in values.iter_mut().zip(parts).enumerate() {
        let read = PositionKind::Base.unit(axis).parse(part);
        *value = read.map_err(|error| format!("{}: {error}", COORDINATES[axis]))?;
    }
    Ok(values)
}

fn millimetres(text: &str) -> Result<i32, String> {
    units::MILLIMETRE.parse(text).map_err(|error| error.to_string())
}

fn degrees(text: &str) -> Result<i32, String> {
    units::DEGREE.parse(text).map_err(|error| error.to_string())
}

/// Part of the target that a group uses. A robot uses the `robot` values and its base; a station uses only its own
/// axes.
pub(super) fn split<'a, T>(
    group: Group,
    robot: Option<T>,
    flag: &str,
    base: Option<&'a Values>,
    station: Option<&'a Values>,
) -> Result<Part<'a, T>> {
    let wrong = |message: String| {
        Err(Failure::usage(message).hint(
            "use one command for the robot and one command for the station: they cannot move in one command (FS and \
             DX 3.3.39)",
        ))
    };
    match (group, robot, station) {
        (Group::Station(_), Some(_), _) => wrong(format!("{group} is a station: use --station-axes, not {flag}")),
        (Group::Station(_), None, _) if base.is_some() => wrong(format!("{group} is a station and has no --base-axes")),
        (Group::Station(_), None, Some(station)) => Ok(Part::Station(station)),
        (Group::Station(_), None, None) => wrong(format!("the target of {group} is missing: add --station-axes")),
        (_, Some(_), Some(_)) => {
            wrong(format!("{group} is a robot: --station-axes needs a station, such as --group S1"))
        }
        (_, None, _) => wrong(format!("the target of {group} is missing: add {flag}")),
        (_, Some(robot), None) => Ok(Part::Robot(robot, base)),
    }
}

/// Target of one group.
#[derive(Debug)]
pub(super) enum Part<'a, T> {
    /// Target of a robot, and of its base if the user gave values for the base.
    Robot(T, Option<&'a Values>),
    /// Target of a station.
    Station(&'a Values),
}

/// Target as text for the confirmation.
pub(super) fn describe(
    kind: PositionKind,
    robot: Option<&[i32]>,
    base: Option<String>,
    station: Option<&Values>,
) -> String {
    let robot = robot.map(|axes| in_a_line(kind, axes, true));
    let station = station.map(|axes| in_a_line(PositionKind::Pulse, &axes.0, false));
    [robot, base.map(|base| format!("base {base}")), station].into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Base axes as text for the confirmation.
pub(super) fn base_is_given(base: Option<&Values>, unit: Unit) -> Option<String> {
    let values: Vec<String> = base?.0.iter().map(|value| unit.show(*value).to_string()).collect();
    Some(format!("{} {}", values.join(" "), unit.symbol))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_units_and_classes_of_speeds() {
        assert_eq!(Speed::percent("10%"), Ok(Speed { class: SpeedClass::Percent, word: 1000 }));
        assert_eq!(Speed::percent("0.01%").map(|speed| speed.word), Ok(1));
        assert_eq!(Speed::percent("100.00 %").map(|speed| speed.word), Ok(10_000));
        assert_eq!(Speed::path("70mm/s"), Ok(Speed { class: SpeedClass::Linear, word: 700 }));
        assert_eq!(Speed::path("20.5deg/s"), Ok(Speed { class: SpeedClass::Angular, word: 205 }));
        assert_eq!(Speed::percent("10"), Speed::percent("10%"));
        for wrong in ["101", "100.01%", "0%", "-1%", "1.234%", "100mm/s", "%", "fast"] {
            assert!(Speed::percent(wrong).is_err(), "{wrong}");
        }
        for wrong in ["10%", "0mm/s", "0.05mm/s", "10mm", "1e3mm/s", "10cm/s"] {
            assert!(Speed::path(wrong).is_err(), "{wrong}");
        }
        assert_eq!(Speed::path("70mm/s").unwrap().to_string(), "70.0 mm/s");
    }

    #[test]
    fn parses_forms() {
        assert_eq!(form("front,lower,noflip"), Ok(Form(0b110)));
        assert_eq!(form("noflip+s-ge180"), Ok(Form(0b10_0100)));
        assert_eq!(extended_form("w-ge180,l-lt180"), Ok(ExtendedForm(0b1_0000)));
        assert!(form("front,back").unwrap_err().contains("front|back appears twice"));
        assert!(form("redundant-back").unwrap_err().contains("noflip"), "bits 6 and 7 are reserved in moves");
        assert!(form("").is_err());
    }

    #[test]
    fn parses_exact_lists_of_the_right_length() {
        assert_eq!(coordinates("-1,0,+2.5,180,0,-0.0001"), Ok([-1000, 0, 2500, 1_800_000, 0, -1]));
        assert!(coordinates("1,2,3").unwrap_err().contains("3 given"));
        assert!(coordinates("1,2,3,4,5,6.00001").unwrap_err().starts_with("rz: "));
        assert_eq!(robot_pulses("1,2,3,4,5,-6"), Ok(Values(vec![1, 2, 3, 4, 5, -6])));
        assert_eq!(robot_pulses("0x10,2,3,4,5,-0x6"), Ok(Values(vec![16, 2, 3, 4, 5, -6])));
        assert!(robot_pulses("1,2,3,4,5").is_err());
        assert!(robot_pulses("1,2,3,4,5,6.5").is_err());
        assert!(base_lengths("1,2,3,4").is_err());
        assert_eq!(base_lengths("1.5").unwrap().with_zeros::<3>(), [1500, 0, 0]);
    }
}

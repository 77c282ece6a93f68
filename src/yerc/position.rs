//! `yerc position`, and positions in reports.

use std::fmt::Write as _;

use schemars::{Schema, SchemaGenerator, json_schema};
use serde::Serializer;
use serde_json::Map;

use super::var::{PositionData, as_position, stored_position};
use crate::prelude::*;
use armctl_client::yerc::AxisSet;
use armctl_controller::units::{self, Unit};
use armctl_controller::yerc::payload;
use armctl_controller::yerc::payload::{Axes, ExtendedForm, Form, MAX_AXES};
use armctl_controller::yerc::query::{Coordinates, ReadPosition};
use armctl_controller::yerc::variables;
use armctl_frame::items;
use armctl_frame::plot::SeriesHistory;
use armctl_frame::robot::position::{self as robot, Joint, Positions, Row};

/// Reads the current position of a group (FS and DX 3.3.6).
#[derive(Debug, Args)]
pub struct Position {
    /// Control group: a robot (R1 …), a base (B1 …) or a station (S1 …)
    #[arg(long, default_value = "R1")]
    group: Group,
    /// Pulses, base coordinates (robots only), or both [default: all that the group has]
    #[arg(long, value_enum)]
    coordinates: Option<Which>,
    /// Show a small chart of each axis over the rounds of --watch
    #[arg(long)]
    plot: bool,
    #[arg(skip)]
    past: SeriesHistory,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Pulses of each axis
    Pulse,
    /// X, Y, Z, Rx, Ry and Rz in base coordinates
    Base,
    /// Both
    Both,
}

impl Command for Position {
    type Family = Yerc;
    type Report = Positions;
    const ID: &'static str = "yerc.position";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Positions> {
        let link = context.link;
        let which = match (self.coordinates, self.group) {
            (Some(which), _) => which,
            (None, Group::Robot(_)) => Which::Both,
            (None, _) => Which::Pulse,
        };
        let wanted: &[Coordinates] = match which {
            Which::Pulse => &[Coordinates::Pulse],
            Which::Base => &[Coordinates::Base],
            Which::Both => &[Coordinates::Pulse, Coordinates::Base],
        };
        let questions = |model| {
            wanted
                .iter()
                .map(|coordinates| ReadPosition::new(model, self.group, *coordinates))
                .collect::<Result<Vec<_>, _>>()
        };
        let questions = link.by_model(questions).await?;
        let Some(outcomes) = link.ask_each(&questions).await.known()? else {
            for coordinates in wanted {
                link.plan_existing_axes(self.group, *coordinates);
            }
            return Err(unknown());
        };
        let per_degree = link.pulses_per_degree(self.group).to_vec();
        let mut rows = Vec::with_capacity(wanted.len());
        for (coordinates, outcome) in wanted.iter().zip(outcomes) {
            let position = match outcome {
                Ok(position) => {
                    let (axes, fitted) = link.existing_axes(self.group, *coordinates, position.axes).await;
                    Ok((payload::Position { axes, ..position }, fitted))
                }
                Err(denied) => Err(read_failure(denied)),
            };
            rows.push(row(self.group, *coordinates, position, &per_degree));
        }
        let report = Positions::new(rows);
        items::all_failed(wanted.len(), report.errors())?;
        Ok(report.plotted(self.plot, &self.past))
    }
}

/// Reads the position of a group.
pub(super) async fn ask(
    link: &mut Link,
    group: Group,
    coordinates: Coordinates,
) -> Result<(payload::Position, robot::Position)> {
    let question = link.by_model(|model| ReadPosition::new(model, group, coordinates)).await?;
    let Some(position) = link.ask(&question).await.known()? else {
        link.plan_existing_axes(group, coordinates);
        return Err(unknown());
    };
    let (axes, fitted) = link.existing_axes(group, coordinates, position.axes).await;
    let position = payload::Position { axes, ..position };
    let report = reported(group, coordinates, (position, fitted), link.pulses_per_degree(group))?;
    Ok((position, report.of_group(group.to_string())))
}

/// Name of the frame in the report. Pulses have the frame `joint`.
const fn frame(coordinates: Coordinates) -> &'static str {
    match coordinates {
        Coordinates::Pulse => "joint",
        Coordinates::Base => "base",
    }
}

/// Row of the report for a group in these coordinates.
fn row(
    group: Group,
    coordinates: Coordinates,
    outcome: Result<(payload::Position, AxisSet)>,
    per_degree: &[f64],
) -> Row {
    let position = outcome.and_then(|read| reported(group, coordinates, read, per_degree));
    Row::new(&group.to_string(), frame(coordinates), position)
}

/// Position in the report; `None` if it does not have the requested coordinates.
fn reported(
    group: Group,
    coordinates: Coordinates,
    (position, fitted): (payload::Position, AxisSet),
    per_degree: &[f64],
) -> Result<robot::Position> {
    match (coordinates, position.kind) {
        (Coordinates::Pulse, PositionKind::Pulse) | (Coordinates::Base, PositionKind::Base) => {
            Ok(as_reported(group, position, fitted, per_degree))
        }
        (_, kind) => {
            let message = format!("unexpected answer: position type {} was not requested", kind.word());
            Err(Failure::new(Kind::Malformed, message).hint("use -vvv to see the bytes"))
        }
    }
}

/// Position in a variable of a group. Unused axes are omitted.
pub(super) fn has_taught_axes(group: Group, value: &variables::Value, per_degree: &[f64]) -> robot::Position {
    let position = as_position(value);
    let used = &position.axes.as_slice()[..position.shown_axes().min(position.axes.as_slice().len())];
    let axes = Axes::new(used).unwrap_or(position.axes);
    as_reported(group, payload::Position { axes, ..position }, AxisSet::ALL, per_degree)
}

/// Position of a group in the coordinate system in which it was reported.
pub(super) fn as_reported(
    group: Group,
    position: payload::Position,
    checked_length: AxisSet,
    per_degree: &[f64],
) -> robot::Position {
    if position.kind.is_cartesian() {
        cartesian(group, position, checked_length)
    } else {
        pulses(group, position, checked_length, per_degree)
    }
}

/// Position by axis. If the pulses per degree are known, the position is also in degrees.
fn pulses(group: Group, position: payload::Position, fitted: AxisSet, per_degree: &[f64]) -> robot::Position {
    let axes = ByAxis::new(position.axes, matches!(group, Group::Robot(_)), fitted);
    let per_degree = per_degree.iter().copied().map(Some).chain(std::iter::repeat(None));
    let joint = |((name, pulses), per): ((&'static str, i32), Option<f64>)| Joint {
        axis: name.to_owned(),
        pulses: Some(pulses),
        // Rounded to 0.0001 degree, which is the resolution of the controllers.
        degrees: per.map(|per| (f64::from(pulses) / per * 1e4).round() / 1e4),
        ..Joint::default()
    };
    robot::Position {
        frame: "joint".to_owned(),
        joints: axes.rows().zip(per_degree).map(joint).collect(),
        tool: Some(position.tool),
        text: Some(text(group, position)),
        ..robot::Position::default()
    }
}

/// Position in cartesian coordinates.
fn cartesian(group: Group, position: payload::Position, fitted: AxisSet) -> robot::Position {
    let axes = position.axes.as_slice();
    let value = |axis: usize| {
        let value = axes.get(axis).filter(|_| fitted.has(axis));
        value.map(|value| decimal(*value, position.kind.unit(axis)))
    };
    robot::Position {
        frame: match position.kind {
            PositionKind::User => format!("user {}", position.user),
            kind => PositionKind::ALL.iter().find(|row| row.0 == kind).map_or("type", |row| row.2).to_owned(),
        },
        x_mm: value(0),
        y_mm: value(1),
        z_mm: value(2),
        rx_deg: value(3),
        ry_deg: value(4),
        rz_deg: value(5),
        re_deg: value(6),
        tool: Some(position.tool),
        user_frame: Some(position.user),
        form: Some(form_words(position.form)),
        extended_form: Some(extended_words(position.extended)).filter(|words| !words.is_empty()),
        text: Some(text(group, position)),
        ..robot::Position::default()
    }
}

/// Text of the position of a group, in the notation of `var set`.
fn text(group: Group, position: payload::Position) -> String {
    PositionData::of(&stored_position(group, position)).map(|data| data.text().to_owned()).unwrap_or_default()
}

/// Converts a protocol integer to a number in its unit. The result is the binary number nearest to the decimal number,
/// so it is printed with the same digits.
pub(super) fn decimal(value: i32, unit: Unit) -> f64 {
    f64::from(value) / 10_f64.powi(unit.decimals.into())
}

/// Axis names of a robot. The axes of other groups have numbers (FS and DX 3.3.5). The manuals do not name an eighth
/// axis.
pub(super) const ROBOT_AXES: [&str; MAX_AXES] = ["S", "L", "U", "R", "B", "T", "E", "8"];
pub(super) const CARTESIAN_AXES: [&str; MAX_AXES] = ["X", "Y", "Z", "Rx", "Ry", "Rz", "Re", "8"];
const NUMBERED_AXES: [&str; MAX_AXES] = ["1", "2", "3", "4", "5", "6", "7", "8"];

/// A number for each axis, with the axis name as key.
#[derive(Debug, Clone, Copy)]
pub(super) struct ByAxis {
    axes: Axes,
    is_robot: bool,
    fitted: AxisSet,
}

impl ByAxis {
    /// Creates the values. `is_robot` selects the names of the axes.
    pub(super) fn new(axes: Axes, is_robot: bool, fitted: AxisSet) -> Self {
        Self { axes, is_robot, fitted }
    }

    /// Names and values of the axes that exist.
    pub(super) fn rows(&self) -> impl Iterator<Item = (&'static str, i32)> {
        let names = if self.is_robot { ROBOT_AXES } else { NUMBERED_AXES };
        let rows = names.into_iter().zip(self.axes.as_slice().iter().copied()).enumerate();
        rows.filter(|(axis, _)| self.fitted.has(*axis)).map(|(_, row)| row)
    }
}

impl Serialize for ByAxis {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.rows().map(|(name, value)| (key(name), value)))
    }
}

impl JsonSchema for ByAxis {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "ByAxis".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = i32::json_schema(generator);
        let names = ROBOT_AXES.into_iter().take(MAX_AXES - 1).chain(NUMBERED_AXES).map(key);
        let properties: Map<String, Value> = names.map(|name| (name, value.clone().to_value())).collect();
        json_schema!({ "type": "object", "properties": properties, "additionalProperties": false })
    }
}

/// JSON key of an axis.
fn key(name: &str) -> String {
    let is_number = name.starts_with(|first: char| first.is_ascii_digit());
    if is_number { format!("axis_{name}") } else { name.to_lowercase() }
}

/// The first `always` words of a form in any case, and the other words only if their bits are set.
fn short(words: &[&str], bits: u32, always: usize) -> String {
    let described = words.iter().enumerate().filter(|(bit, _)| *bit < always || bits >> bit & 1 == 1);
    described.map(|(_, word)| *word).collect::<Vec<_>>().join("+")
}

/// Words of a form in short, as `--form` accepts them.
pub(super) fn form_words(form: Form) -> String {
    short(&form.words().collect::<Vec<_>>(), form.0, 3)
}

/// Words of an extended form whose bits are set.
pub(super) fn extended_words(form: ExtendedForm) -> String {
    short(&form.words().collect::<Vec<_>>(), form.0, 0)
}

/// Axis names of a group.
pub(super) fn axis_names(kind: PositionKind, group: Group) -> [&'static str; MAX_AXES] {
    names(kind, matches!(group, Group::Robot(_)))
}

fn names(kind: PositionKind, is_robot: bool) -> [&'static str; MAX_AXES] {
    match (kind.is_cartesian(), is_robot) {
        (true, _) => CARTESIAN_AXES,
        (false, true) => ROBOT_AXES,
        (false, false) => NUMBERED_AXES,
    }
}

/// Axes in one line, for example `x=100.000 y=0.000 z=0.000 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg`, or `s=0 l=0`.
pub(super) fn in_a_line(kind: PositionKind, axes: &[i32], is_robot: bool) -> String {
    let names = names(kind, is_robot);
    let mut line = String::new();
    let mut last = None;
    for (axis, (name, value)) in names.iter().zip(axes).enumerate() {
        let unit = kind.unit(axis);
        if let Some(last) = last.filter(|last: &Unit| *last != unit) {
            // Writing to a string cannot fail.
            let _ = write!(line, " {},", last.symbol);
        }
        let space = if axis == 0 { "" } else { " " };
        let _ = write!(line, "{space}{}={}", name.to_lowercase(), unit.show(*value));
        last = Some(unit);
    }
    if let Some(unit) = last.filter(|unit| *unit != units::PULSE) {
        let _ = write!(line, " {}", unit.symbol);
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{error_text, frames, frames_on, golden};

    fn base(axes: &[i32]) -> payload::Position {
        payload::Position {
            kind: PositionKind::Base,
            form: Form(0b100),
            tool: 2,
            user: 0,
            extended: ExtendedForm(0),
            axes: Axes::new(axes).unwrap(),
        }
    }

    fn pulses(axes: &[i32]) -> payload::Position {
        payload::Position { kind: PositionKind::Pulse, form: Form(0), ..base(axes) }
    }

    #[test]
    fn reads_robots_in_both_coordinates_and_others_in_pulses() {
        let axes = ["7400010000010000", "7400650000010000"].map(ToOwned::to_owned);
        assert_eq!(frames("position").unwrap(), [&["7500010000010000".to_owned(), golden("R13")], &axes[..]].concat());
        assert_eq!(frames("position --coordinates base --group r2").unwrap(), ["7500660000010000", "7400660000010000"]);
        assert_eq!(frames("position --group S24").unwrap(), ["75002c0000010000", "74002c0000010000"]);
        for wrong in ["position --group B1 --coordinates base", "position --group S1 --coordinates both"] {
            assert_eq!(frames(wrong).unwrap_err().kind, Kind::Usage, "{wrong}");
        }
        let failure = frames_on("udp://h?model=fs100", "position --group S4").unwrap_err();
        assert!(failure.message.contains("S4 does not exist on a fs100"), "{failure}");
        assert!(error_text("position --group X1").contains("R1 to R8"));
    }

    fn read(group: Group, coordinates: Coordinates, position: payload::Position) -> Value {
        let row = row(group, coordinates, Ok((position, AxisSet::ALL)), &[90.0]);
        serde_json::to_value(row).unwrap()
    }

    #[test]
    fn position_is_exact_in_json() {
        let joint = read(Group::R1, Coordinates::Pulse, pulses(&[-90000, 1, 2]));
        let axes: Vec<String> = joint["joints"].as_array().unwrap().iter().map(ToString::to_string).collect();
        assert_eq!(axes[0], r#"{"axis":"S","pulses":-90000,"degrees":-1000.0,"mm":null}"#);
        assert_eq!(axes[1], r#"{"axis":"L","pulses":1,"degrees":null,"mm":null}"#);
        let base = read(Group::R1, Coordinates::Base, base(&[185_001, -1, 600_000, 1_800_000, 0, -1]));
        assert_eq!(base["x_mm"].to_string(), "185.001");
        assert_eq!(base["y_mm"].to_string(), "-0.001");
        assert_eq!(base["rz_deg"].to_string(), "-0.0001");
        assert_eq!((&base["form"], &base["frame"]), (&"front+upper+noflip".into(), &"base".into()));
        assert!(base["re_deg"].is_null() && base["extended_form"].is_null());
    }

    #[test]
    fn numbers_the_axes_of_other_groups() {
        let station = read(Group::Station(1), Coordinates::Pulse, pulses(&[7, -8]));
        assert_eq!((&station["group"], &station["joints"][1]["axis"]), (&"S1".into(), &"2".into()));
        assert_eq!(station["text"], "pulse:1=7,2=-8");
    }

    #[test]
    fn rejects_an_answer_in_other_coordinates() {
        let row = read(Group::R1, Coordinates::Base, pulses(&[1]));
        assert_eq!((&row["ok"], &row["error"]["kind"]), (&false.into(), &"malformed".into()));
    }

    #[test]
    fn formats_lines_for_messages() {
        let line = in_a_line(PositionKind::Base, &[100_000, 0, -1, 1_800_000, 0, 0], true);
        assert_eq!(line, "x=100.000 y=0.000 z=-0.001 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg");
        assert_eq!(in_a_line(PositionKind::Pulse, &[1, 2], true), "s=1 l=2");
        assert_eq!(in_a_line(PositionKind::Pulse, &[1, 2], false), "1=1 2=2");
        assert_eq!(form_words(Form(0b1001)), "back+upper+flip+r-ge180");
        assert_eq!(extended_words(ExtendedForm(0b10)), "u-ge180");
    }
}

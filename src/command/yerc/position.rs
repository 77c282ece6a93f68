//! `yerc position`, and positions in reports.

use std::fmt::Write as _;

use clap::{Args, ValueEnum};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Serialize, Serializer};
use serde_json::{Map, Value};

use super::link::Link;
use super::link::Yerc;
use super::var::{PositionData, held};
use crate::client::yerc::Fitted;
use crate::command::frame::dry_run::{Known as _, unknown};
use crate::command::frame::items;
use crate::command::frame::items::{ItemError, ItemOutcome};
use crate::command::frame::plot::{Past, Plot};
use crate::command::{Command, Context, Report};
use crate::controller::units::{self, Unit};
use crate::controller::yerc::group::Group;
use crate::controller::yerc::payload::{self, Axes, ExtendedForm, Form, MAX_AXES, PositionKind};
use crate::controller::yerc::query::{Coordinates, ReadPosition};
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Section, Table, View};

/// Where a group stands (FS and DX 3.3.6).
#[derive(Debug, Args)]
pub struct Position {
    /// Control group: R1 …, B1 …, S1 …
    #[arg(long, default_value = "R1")]
    group: Group,
    /// In pulses, in base coordinates (robots only), or both [default: what the group has]
    #[arg(long, value_enum)]
    coordinates: Option<Which>,
    /// Show a small chart of each axis over the rounds of --watch
    #[arg(long)]
    plot: bool,
    #[arg(skip)]
    past: Past,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Pulses of each axis
    Pulse,
    /// X Y Z Rx Ry Rz in base coordinates
    Base,
    /// Both
    Both,
}

impl Command for Position {
    type Family = Yerc;
    type Report = PositionReport;
    const ID: &'static str = "yerc.position";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<PositionReport, Failure> {
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
        let mut report = PositionReport::nowhere(self.group);
        let Some(outcomes) = link.ask_each(&questions).await.known()? else {
            for coordinates in wanted {
                link.plan_fit(self.group, *coordinates);
            }
            return Err(unknown());
        };
        for (coordinates, outcome) in wanted.iter().zip(outcomes) {
            let position = match outcome {
                Ok(position) => {
                    let (axes, fitted) = link.fit(self.group, *coordinates, position.axes).await;
                    Ok((payload::Position { axes, ..position }, fitted))
                }
                Err(denied) => Err(denied.into()),
            };
            report.take(*coordinates, position);
        }
        items::nothing(wanted.len(), report.errors())?;
        report.turned(link.pulses_per_degree(self.group));
        report.plot = self.plot.then(|| self.past.add(report.values()));
        Ok(report)
    }
}

/// Asks where a group stands.
pub(super) async fn ask(
    link: &mut Link,
    group: Group,
    coordinates: Coordinates,
) -> Result<(payload::Position, PositionReport), Failure> {
    let question = link.by_model(|model| ReadPosition::new(model, group, coordinates)).await?;
    let Some(position) = link.ask(&question).await.known()? else {
        link.plan_fit(group, coordinates);
        return Err(unknown());
    };
    let (axes, fitted) = link.fit(group, coordinates, position.axes).await;
    let position = payload::Position { axes, ..position };
    let mut report = PositionReport::nowhere(group);
    report.take(coordinates, Ok((position, fitted)));
    items::nothing(1, report.errors())?;
    report.turned(link.pulses_per_degree(group));
    Ok((position, report))
}

/// Where a control group stands.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PositionReport {
    /// Control group, such as `R1`.
    #[schemars(with = "String")]
    #[serde(serialize_with = "as_text")]
    group: Group,
    /// By axis; null if not asked for.
    pulse: Option<ItemOutcome<PulsePosition>>,
    /// In base coordinates; null if not asked for.
    base: Option<ItemOutcome<CartesianPosition>>,
    #[serde(skip)]
    plot: Option<Plot>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct PulsePosition {
    /// By axis: `s`, `l`, `u`, `r`, `b`, `t`, `e` of a robot, `axis_1` and so on of other groups; only axes answered.
    pulses: ByAxis,
    /// The same in degrees, where the inventory says the pulses of a degree.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "std::collections::BTreeMap<String, f64>")]
    degrees: Option<Degrees>,
    tool: u32,
    /// As `var set` takes it: `P5=pulse:s=…`.
    text: String,
}

/// Six coordinates and how the arm reaches them.
#[derive(Debug, Serialize, JsonSchema)]
struct CartesianPosition {
    x_mm: Option<f64>,
    y_mm: Option<f64>,
    z_mm: Option<f64>,
    rx_deg: Option<f64>,
    ry_deg: Option<f64>,
    rz_deg: Option<f64>,
    /// The angle of a seventh axis.
    #[serde(skip_serializing_if = "Option::is_none")]
    re_deg: Option<f64>,
    tool: u32,
    user: u32,
    /// A word for each bit of the form.
    form: Vec<&'static str>,
    /// The word of the form as received.
    form_code: u32,
    /// A word for each bit of the extended form.
    extended_form: Vec<&'static str>,
    /// The word of the extended form as received.
    extended_form_code: u32,
    /// As `var set` takes it: `P5=base:x=…`.
    text: String,
    #[serde(skip)]
    axes: Axes,
    #[serde(skip)]
    fitted: Fitted,
}

impl PositionReport {
    fn nowhere(group: Group) -> Self {
        Self { group, pulse: None, base: None, plot: None }
    }

    fn pulses(&self) -> Option<&PulsePosition> {
        self.pulse.as_ref().and_then(ItemOutcome::data)
    }

    fn cartesian(&self) -> Option<&CartesianPosition> {
        self.base.as_ref().and_then(ItemOutcome::data)
    }

    fn errors(&self) -> impl Iterator<Item = &ItemError> {
        let pulse = self.pulse.as_ref().and_then(ItemOutcome::error);
        pulse.into_iter().chain(self.base.as_ref().and_then(ItemOutcome::error))
    }

    /// Where it stands, in a line.
    pub(super) fn line(&self) -> String {
        let pulses = self
            .pulses()
            .map(|pulse| in_a_line(PositionKind::Pulse, pulse.pulses.axes.as_slice(), pulse.pulses.is_robot));
        let base = self.cartesian().map(|base| in_a_line(PositionKind::Base, base.axes.as_slice(), true));
        pulses.into_iter().chain(base).collect::<Vec<_>>().join(", ")
    }

    /// What a chart shows: base coordinates, or pulses where there are none.
    fn values(&self) -> Vec<(String, &'static str, usize, f64)> {
        let (kind, axes) = match (self.cartesian(), self.pulses()) {
            (Some(base), _) => (PositionKind::Base, base.axes),
            (None, Some(pulse)) => (PositionKind::Pulse, pulse.pulses.axes),
            (None, None) => return Vec::new(),
        };
        let names = axis_names(kind, self.group).into_iter().zip(axes.as_slice()).enumerate();
        let value = |(at, (name, value)): (usize, (&str, &i32))| {
            let unit = kind.unit(at);
            (name.to_owned(), unit.symbol, usize::from(unit.decimals), decimal(*value, unit))
        };
        names.map(value).collect()
    }

    /// Adds degrees, where the pulses of a degree are known.
    fn turned(&mut self, per_degree: &[f64]) {
        let pulse = self.pulse.as_mut().and_then(ItemOutcome::data_mut).filter(|_| !per_degree.is_empty());
        if let Some(pulse) = pulse {
            let rows = pulse.pulses.rows().zip(per_degree);
            pulse.degrees = Some(Degrees(rows.map(|((name, pulses), per)| (name, f64::from(pulses) / per)).collect()));
        }
    }

    /// Takes the outcome for the coordinates that were asked for.
    fn take(&mut self, asked: Coordinates, position: Result<(payload::Position, Fitted), Failure>) {
        let what = |coordinates: &str| format!("position of {} in {coordinates}", self.group);
        let position = position.and_then(|(position, fitted)| match (asked, position.kind) {
            (Coordinates::Pulse, PositionKind::Pulse) | (Coordinates::Base, PositionKind::Base) => {
                Ok((position, fitted))
            }
            (_, kind) => {
                let message = format!("unexpected answer: a position of type {} was not asked for", kind.word());
                Err(Failure::new(Kind::Malformed, message).hint("-vvv shows the bytes"))
            }
        });
        match asked {
            Coordinates::Pulse => {
                let is_robot = matches!(self.group, Group::Robot(_));
                let pulse = position.map(|(position, fitted)| PulsePosition {
                    text: text(self.group, position),
                    pulses: ByAxis::new(position.axes, is_robot, fitted),
                    degrees: None,
                    tool: position.tool,
                });
                self.pulse = Some(ItemOutcome::new(what("pulses"), pulse));
            }
            Coordinates::Base => {
                let base = position.map(|(position, fitted)| CartesianPosition::new(self.group, &position, fitted));
                self.base = Some(ItemOutcome::new(what("base coordinates"), base));
            }
        }
    }
}

impl CartesianPosition {
    fn new(group: Group, position: &payload::Position, fitted: Fitted) -> Self {
        let axes = position.axes.as_slice();
        let value = |axis: usize| {
            let value = axes.get(axis).filter(|_| fitted.has(axis));
            value.map(|value| decimal(*value, position.kind.unit(axis)))
        };
        Self {
            text: text(group, *position),
            x_mm: value(0),
            y_mm: value(1),
            z_mm: value(2),
            rx_deg: value(3),
            ry_deg: value(4),
            rz_deg: value(5),
            re_deg: value(6),
            tool: position.tool,
            user: position.user,
            form: position.form.words().collect(),
            form_code: position.form.0,
            extended_form: position.extended.words().collect(),
            extended_form_code: position.extended.0,
            axes: position.axes,
            fitted,
        }
    }
}

/// Degrees under the names of the axes.
#[derive(Debug, Clone)]
struct Degrees(Vec<(&'static str, f64)>);

impl Serialize for Degrees {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        // To a ten-thousandth, as controllers tell angles.
        serializer
            .collect_map(self.0.iter().map(|(name, degrees)| (name.to_lowercase(), (degrees * 1e4).round() / 1e4)))
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
fn as_text<S: Serializer>(group: &Group, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_str(group)
}

/// A position of a group as `var set` takes it.
fn text(group: Group, position: payload::Position) -> String {
    PositionData::of(&held(group, position)).map(|data| data.text().to_owned()).unwrap_or_default()
}

/// The value of a wire integer. It is the binary number nearest to the decimal one, so it prints with the same digits.
pub(super) fn decimal(value: i32, unit: Unit) -> f64 {
    f64::from(value) / 10_f64.powi(unit.decimals.into())
}

/// Names of the axes of a robot; other groups have numbers (FS and DX 3.3.5). An eighth is not named by the manuals.
pub(super) const ROBOT_AXES: [&str; MAX_AXES] = ["S", "L", "U", "R", "B", "T", "E", "8"];
pub(super) const CARTESIAN_AXES: [&str; MAX_AXES] = ["X", "Y", "Z", "Rx", "Ry", "Rz", "Re", "8"];
const NUMBERED_AXES: [&str; MAX_AXES] = ["1", "2", "3", "4", "5", "6", "7", "8"];

/// A number for each axis, under its name.
#[derive(Debug, Clone, Copy)]
pub(super) struct ByAxis {
    axes: Axes,
    is_robot: bool,
    fitted: Fitted,
}

impl ByAxis {
    /// `is_robot` decides about the names.
    pub(super) fn new(axes: Axes, is_robot: bool, fitted: Fitted) -> Self {
        Self { axes, is_robot, fitted }
    }

    /// Names as people know them, and the values that are there.
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

/// The key of an axis in JSON.
fn key(name: &str) -> String {
    let is_number = name.starts_with(|first: char| first.is_ascii_digit());
    if is_number { format!("axis_{name}") } else { name.to_lowercase() }
}

impl Report for PositionReport {
    fn view(&self) -> View {
        if let Some(plot) = &self.plot {
            return View { sections: vec![plot.section()] };
        }
        let pulses = self.pulses().into_iter().flat_map(|pulse| pulse.pulses.rows());
        let pulses: Vec<[Cell; 2]> = pulses.map(pulse_row).collect();
        let base: Vec<[Cell; 3]> = self.cartesian().into_iter().flat_map(CartesianPosition::rows).collect();
        let mut table = Table { empty: "the controller answered no axis", ..Table::default() };
        let blank = || Cell::from("");
        if self.pulses().is_some() {
            table.columns.extend(["axis", "pulses"]);
        }
        let degrees = self.pulses().and_then(|pulse| pulse.degrees.as_ref());
        if degrees.is_some() {
            table.columns.push("deg");
        }
        if self.cartesian().is_some() {
            table.columns.extend(["base", "value", "unit"]);
        }
        for index in 0..pulses.len().max(base.len()) {
            let mut row = Vec::new();
            if self.pulses().is_some() {
                row.extend(pulses.get(index).cloned().unwrap_or_else(|| [blank(), blank()]));
            }
            if let Some(Degrees(degrees)) = degrees {
                row.push(degrees.get(index).map_or_else(blank, |(_, degrees)| Cell::number(format!("{degrees:.4}"))));
            }
            if self.cartesian().is_some() {
                row.extend(base.get(index).cloned().unwrap_or_else(|| [blank(), blank(), blank()]));
            }
            table.rows.push(row);
        }
        let texts = self.pulses().map(|pulse| &pulse.text).into_iter();
        let texts = texts.chain(self.cartesian().map(|base| &base.text)).map(|text| ("text", text.as_str().into()));
        View { sections: vec![Section::Table(table), Section::Fields(texts.collect())] }
    }

    fn failure(&self) -> Option<Failure> {
        let asked = [self.pulse.is_some(), self.base.is_some()].iter().filter(|is_asked| **is_asked).count();
        items::verdict(asked, self.errors())
    }
}

fn pulse_row((name, value): (&'static str, i32)) -> [Cell; 2] {
    [name.into(), value.into()]
}

impl CartesianPosition {
    /// Name, value and unit of everything.
    fn rows(&self) -> Vec<[Cell; 3]> {
        let axes = CARTESIAN_AXES.iter().zip(self.axes.as_slice()).enumerate();
        let mut rows: Vec<[Cell; 3]> = axes
            .filter(|(axis, _)| self.fitted.has(*axis))
            .map(|(axis, (name, value))| {
                let unit = PositionKind::Base.unit(axis);
                [(*name).into(), Cell::number(unit.show(*value).to_string()), unit.symbol.into()]
            })
            .collect();
        rows.push(["tool".into(), self.tool.into(), "".into()]);
        rows.push(["user".into(), self.user.into(), "".into()]);
        rows.push(["form".into(), short(&self.form, self.form_code, 3).into(), "".into()]);
        if self.extended_form_code != 0 {
            let words = short(&self.extended_form, self.extended_form_code, 0);
            rows.push(["extended".into(), words.into(), "".into()]);
        }
        rows
    }
}

/// The first `always` words of a form whatever they are, the others where they are set.
fn short(words: &[&str], bits: u32, always: usize) -> String {
    let told = words.iter().enumerate().filter(|(bit, _)| *bit < always || bits >> bit & 1 == 1);
    told.map(|(_, word)| *word).collect::<Vec<_>>().join("+")
}

/// The words of a form in short, as `--form` takes them.
pub(super) fn form_words(form: Form) -> String {
    short(&form.words().collect::<Vec<_>>(), form.0, 3)
}

/// The words of an extended form that are set.
pub(super) fn extended_words(form: ExtendedForm) -> String {
    short(&form.words().collect::<Vec<_>>(), form.0, 0)
}

/// What the axes of a group are called.
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

/// Axes in a line for messages: `x=100.000 y=0.000 z=0.000 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg`, or `s=0 l=0`.
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
    use crate::command::yerc::testing::{frames, frames_on, golden, objection};
    use crate::output::render;

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
    fn a_robot_is_read_in_both_coordinates_and_others_in_pulses() {
        let axes = ["7400010000010000", "7400650000010000"].map(ToOwned::to_owned);
        assert_eq!(frames("position").unwrap(), [&["7500010000010000".to_owned(), golden("R13")], &axes[..]].concat());
        assert_eq!(frames("position --coordinates base --group r2").unwrap(), ["7500660000010000", "7400660000010000"]);
        assert_eq!(frames("position --group S24").unwrap(), ["75002c0000010000", "74002c0000010000"]);
        for wrong in ["position --group B1 --coordinates base", "position --group S1 --coordinates both"] {
            assert_eq!(frames(wrong).unwrap_err().kind, Kind::Usage, "{wrong}");
        }
        let failure = frames_on("udp://h?model=fs100", "position --group S4").unwrap_err();
        assert!(failure.message.contains("S4 does not exist on a fs100"), "{failure}");
        assert!(objection("position --group X1").contains("R1 to R8"));
    }

    #[test]
    fn a_position_is_exact_in_json() {
        let mut report = PositionReport::nowhere(Group::R1);
        report.take(Coordinates::Pulse, Ok((pulses(&[-90000, 1, 2, 3, 4, 5]), Fitted::ALL)));
        report.take(Coordinates::Base, Ok((base(&[185_001, -1, 600_000, 1_800_000, 0, -1]), Fitted::ALL)));
        let json = serde_json::to_value(&report).unwrap();
        assert_eq!(json["pulse"]["pulses"].to_string(), r#"{"s":-90000,"l":1,"u":2,"r":3,"b":4,"t":5}"#);
        assert_eq!(json["base"]["x_mm"].to_string(), "185.001");
        assert_eq!(json["base"]["y_mm"].to_string(), "-0.001");
        assert_eq!(json["base"]["rz_deg"].to_string(), "-0.0001");
        assert_eq!(json["base"]["form"][2], "noflip");
        assert_eq!(json["base"]["form_code"], 4);
        assert!(json["base"].get("re_deg").is_none());
    }

    #[test]
    fn both_coordinates_stand_side_by_side() {
        let mut report = PositionReport::nowhere(Group::R1);
        report.take(Coordinates::Pulse, Ok((pulses(&[1, 2, 3, 4, 5, 6]), Fitted::ALL)));
        report.take(Coordinates::Base, Ok((base(&[100_000, 0, 0, 1_800_000, 0, 0]), Fitted::ALL)));
        assert_eq!(
            render::csv(&report.view()),
            "axis,pulses,base,value,unit\nS,1,X,100.000,mm\nL,2,Y,0.000,mm\nU,3,Z,0.000,mm\nR,4,Rx,180.0000,deg\n\
             B,5,Ry,0.0000,deg\nT,6,Rz,0.0000,deg\n,,tool,2,\n,,user,0,\n,,form,front+upper+noflip,\n\
             text,text\n\"pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=2,user=0\",\"base:x=100.000,y=0.000,z=0.000,rx=180.0000,\
             ry=0.0000,rz=0.0000,tool=2,user=0,form=front+upper+noflip\"\n"
        );
    }

    #[test]
    fn other_groups_have_numbered_axes() {
        let mut report = PositionReport::nowhere(Group::Station(1));
        report.take(Coordinates::Pulse, Ok((pulses(&[7, -8]), Fitted::ALL)));
        assert_eq!(
            serde_json::to_value(&report).unwrap()["pulse"]["pulses"].to_string(),
            r#"{"axis_1":7,"axis_2":-8}"#
        );
        assert_eq!(render::csv(&report.view()), "axis,pulses\n1,7\n2,-8\ntext\n\"pulse:1=7,2=-8\"\n");
    }

    #[test]
    fn an_answer_in_other_coordinates_is_malformed() {
        let mut report = PositionReport::nowhere(Group::R1);
        report.take(Coordinates::Base, Ok((pulses(&[1]), Fitted::ALL)));
        let failure = report.failure().unwrap();
        assert_eq!(failure.kind, Kind::Malformed);
    }

    #[test]
    fn lines_for_messages() {
        let line = in_a_line(PositionKind::Base, &[100_000, 0, -1, 1_800_000, 0, 0], true);
        assert_eq!(line, "x=100.000 y=0.000 z=-0.001 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg");
        assert_eq!(in_a_line(PositionKind::Pulse, &[1, 2], true), "s=1 l=2");
        assert_eq!(in_a_line(PositionKind::Pulse, &[1, 2], false), "1=1 2=2");
        assert_eq!(form_words(Form(0b1001)), "back+upper+flip+r-ge180");
        assert_eq!(extended_words(ExtendedForm(0b10)), "u-ge180");
    }
}

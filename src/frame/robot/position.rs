//! Positions: common keys of `position` in every family, `armctl position`, motions and taught points.

use std::borrow::Cow;
use std::fmt::Write as _;

use schemars::{Schema, SchemaGenerator};

use crate::face::shared_commands::CommonReport;
use crate::items::{ItemError, verdict};
use crate::plot::{Plot, SeriesHistory};
use crate::prelude::basics::*;

/// A position of a robot in one frame. A field is null if the frame has no such coordinate, or if the protocol does not
/// report it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Position {
    /// Group: `R1` (yerc), `unit 1` (yrcx, toyo); null for a stored point.
    pub group: Option<String>,
    /// Frame of the coordinates: `base`, `robot`, `user 2`, `tool`; `joint` if there are only axes.
    pub frame: String,
    /// X.
    pub x_mm: Option<f64>,
    /// Y.
    pub y_mm: Option<f64>,
    /// Z.
    pub z_mm: Option<f64>,
    /// Rotation about X.
    pub rx_deg: Option<f64>,
    /// Rotation about Y.
    pub ry_deg: Option<f64>,
    /// Rotation about Z.
    pub rz_deg: Option<f64>,
    /// Angle of a seventh axis.
    pub re_deg: Option<f64>,
    /// Axes in the order of the controller.
    #[schemars(length(max = 8))]
    pub joints: Vec<Joint>,
    /// Tool number.
    pub tool: Option<u32>,
    /// User frame number.
    pub user_frame: Option<u32>,
    /// Arm form in typed notation: `front+upper+flip` (yerc), `right` (yrcx).
    pub form: Option<String>,
    /// Extended form (yerc), in the notation of `--extended-form`.
    pub extended_form: Option<String>,
    /// Position in typed notation.
    pub text: Option<String>,
}

/// Position of a controller with at most four axes: the same keys, with fewer columns in CSV.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct FourAxes(pub Position);

impl JsonSchema for FourAxes {
    fn schema_name() -> Cow<'static, str> {
        "FourAxes".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = Position::json_schema(generator);
        if let Some(longest) = schema.pointer_mut("/properties/joints/maxItems") {
            *longest = 4.into();
        }
        schema
    }
}

/// Position of an axis.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Joint {
    /// Name on the teach pendant, or number.
    pub axis: String,
    /// Encoder pulses.
    pub pulses: Option<i32>,
    /// Degrees.
    pub degrees: Option<f64>,
    /// Millimeters; degrees for a rotary axis of a YRCX or Toyo.
    pub mm: Option<f64>,
    /// Number of decimals of the controller.
    #[serde(skip)]
    pub decimals: usize,
}

impl Position {
    /// Position of the axes in millimeters.
    pub fn of_axes(names: [String; 4], mm: [f64; 4], decimals: usize) -> Self {
        let joints =
            names.into_iter().zip(mm).map(|(axis, mm)| Joint { axis, mm: Some(mm), decimals, ..Joint::default() });
        Self { frame: "base".to_owned(), joints: joints.collect(), ..Self::default() }
    }

    /// Adds the group.
    #[must_use]
    pub fn of_group(self, group: impl Into<String>) -> Self {
        Self { group: Some(group.into()), ..self }
    }

    /// Existing coordinates: name, value, unit, decimals.
    fn coordinates(&self) -> impl Iterator<Item = (&'static str, f64, &'static str, usize)> {
        let mm = [("X", self.x_mm), ("Y", self.y_mm), ("Z", self.z_mm)].map(|(name, mm)| (name, mm, "mm", 3));
        let degrees = [("Rx", self.rx_deg), ("Ry", self.ry_deg), ("Rz", self.rz_deg), ("Re", self.re_deg)];
        let degrees = degrees.map(|(name, degrees)| (name, degrees, "deg", 4));
        let all = mm.into_iter().chain(degrees);
        all.filter_map(|(name, value, unit, decimals)| Some((name, value?, unit, decimals)))
    }

    /// All values: name, unit, decimals, value. Axes have priority, because coordinates and axes are equivalent.
    fn values(&self) -> Vec<(String, &'static str, usize, f64)> {
        let joint = |joint: &Joint| {
            let (value, unit, decimals) = match (joint.mm, joint.pulses) {
                (Some(mm), _) => (mm, "mm", joint.decimals),
                (None, pulses) => (f64::from(pulses?), "pulses", 0),
            };
            Some((joint.axis.clone(), unit, decimals, value))
        };
        if self.joints.is_empty() {
            let all = self.coordinates();
            return all.map(|(name, value, unit, decimals)| (name.to_owned(), unit, decimals, value)).collect();
        }
        self.joints.iter().filter_map(joint).collect()
    }

    /// One line: `x=100.000 y=0.000 z=0.000 mm, rx=180.0000 ry=0.0000 rz=0.0000 deg`, or `s=0 l=0 pulses`.
    pub fn line(&self) -> String {
        let mut line = String::new();
        let values = self.values();
        for (at, (name, unit, decimals, value)) in values.iter().enumerate() {
            let ends = values.get(at + 1).is_none_or(|next| next.1 != *unit);
            let has_more = at + 1 < values.len();
            // Writing to a string cannot fail.
            let _ = write!(line, "{}={value:.decimals$}", name.to_lowercase());
            if ends {
                let _ = write!(line, " {unit}{}", if has_more { "," } else { "" });
            }
            if has_more {
                line.push(' ');
            }
        }
        line
    }

    /// Rows with name, value and unit of everything except the axes.
    fn coordinate_rows(&self) -> Vec<Vec<Cell>> {
        let number = |(name, value, unit, decimals): (&'static str, f64, &'static str, usize)| {
            vec![name.into(), Cell::number(format!("{value:.decimals$}")), unit.into()]
        };
        let words = [("form", &self.form), ("extended", &self.extended_form)];
        let words = words.into_iter().filter_map(|(name, word)| Some((name, Cell::from(word.as_deref()?))));
        let numbers = [("tool", self.tool), ("user", self.user_frame)];
        let numbers = numbers.into_iter().filter_map(|(name, number)| Some((name, Cell::from(number?))));
        let add_note = numbers.chain(words).map(|(name, cell)| vec![name.into(), cell, "".into()]);
        self.coordinates().map(number).chain(add_note).collect()
    }
}

impl Joint {
    /// Value in its unit: millimeters, or pulses.
    pub fn cell(&self) -> Cell {
        let Self { decimals, .. } = self;
        match (self.mm, self.pulses) {
            (Some(mm), _) => Cell::number(format!("{mm:.decimals$}")),
            (None, pulses) => Cell::optional(pulses),
        }
    }
}

/// Table with one row per axis and only the columns that have a value.
pub fn joint_table(joints: &[Joint]) -> Table {
    let has = |value: fn(&Joint) -> bool| joints.iter().any(value);
    let (pulses, degrees) = (has(|joint| joint.pulses.is_some()), has(|joint| joint.degrees.is_some()));
    let mm = has(|joint| joint.mm.is_some());
    let columns = [("axis", true), ("pulses", pulses), ("deg", degrees), ("mm", mm)];
    let columns = columns.into_iter().filter(|(_, is_there)| *is_there).map(|(name, _)| name).collect();
    let row = |joint: &Joint| {
        let mut row = vec![Cell::from(joint.axis.as_str())];
        row.extend((pulses || mm).then(|| joint.cell()));
        let degrees = degrees.then(|| Cell::optional(joint.degrees.map(|value| Cell::number(format!("{value:.4}")))));
        row.extend(degrees);
        row
    };
    Table { columns, rows: joints.iter().map(row).collect(), empty: "no axes" }
}

/// A position, or the reason why it was not read.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Row {
    /// Position. Its group and frame are present even if the position was not read.
    #[serde(flatten)]
    pub position: Position,
    /// Whether the position was read.
    ok: bool,
    /// Reason why the position was not read.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
}

impl Row {
    /// Position of a group in a frame.
    pub fn new(group: &str, frame: &str, outcome: Result<Position>) -> Self {
        match outcome {
            Ok(position) => Self { position: position.of_group(group), ok: true, error: None },
            Err(failure) => Self {
                position: Position { frame: frame.to_owned(), ..Position::default() }.of_group(group),
                ok: false,
                error: Some(ItemError::new(format!("position of {group} ({frame})"), failure)),
            },
        }
    }
}

/// Positions of a robot: one row per group and frame.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Positions {
    /// Each group in each requested frame.
    pub positions: Vec<Row>,
    #[serde(skip)]
    plot: Option<Plot>,
}

impl Positions {
    /// Report of these rows.
    pub fn new(positions: Vec<Row>) -> Self {
        Self { positions, plot: None }
    }

    /// Report of a single position.
    pub fn one(group: &str, position: Position) -> Self {
        Self::new(vec![Row::new(group, "", Ok(position))])
    }

    /// Positions that were read.
    pub fn read(&self) -> impl Iterator<Item = &Position> {
        self.positions.iter().filter(|row| row.ok).map(|row| &row.position)
    }

    /// Errors of positions that were not read.
    pub fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.positions.iter().filter_map(|row| row.error.as_ref())
    }

    /// Replaces the table with a chart of the rounds so far, if requested; coordinates have priority over axes.
    #[must_use]
    pub fn plotted(self, is_asked: bool, past: &SeriesHistory) -> Self {
        let has_coordinates = |position: &&Position| position.joints.is_empty();
        let shown = self.read().find(has_coordinates).or(self.read().next());
        let plot = shown.filter(|_| is_asked).map(|position| past.add(position.values()));
        Self { plot, ..self }
    }

    /// One line for messages and fields.
    pub fn line(&self) -> String {
        self.read().map(Position::line).collect::<Vec<_>>().join(", ")
    }

    /// Table with axes on the left and coordinates on the right.
    fn table(&self) -> Table {
        // Coordinates and axes of the same position are equivalent.
        let joints = self.read().find(|position| !position.joints.is_empty());
        let coordinates = self.read().find(|position| position.joints.is_empty());
        let left = joint_table(joints.map_or(&[], |position| &position.joints));
        let (mut columns, left) = (if joints.is_some() { left.columns } else { Vec::new() }, left.rows);
        let right = coordinates.map(Position::coordinate_rows).unwrap_or_default();
        if coordinates.is_some() {
            columns.extend(["base", "value", "unit"]);
        }
        let (width, rows) = (columns.len(), left.len().max(right.len()));
        let first = left.first().map_or(0, Vec::len);
        let rows = (0..rows).map(|at| {
            let mut row = left.get(at).cloned().unwrap_or_default();
            row.resize(first, "".into());
            row.extend(right.get(at).cloned().unwrap_or_default());
            row.resize(width, "".into());
            row
        });
        Table { columns, rows: rows.collect(), empty: "no axes" }
    }
}

impl CommonReport for Positions {
    type Core = AllPositions;

    fn core(&self) -> AllPositions {
        AllPositions { positions: self.positions.clone() }
    }
}

impl Report for Positions {
    fn view(&self) -> View {
        if let Some(plot) = &self.plot {
            return View { sections: vec![plot.section()] };
        }
        let view = View::table(self.table());
        let joints = self.read().filter(|position| !position.joints.is_empty());
        let form = joints.filter_map(|position| Some(("form", position.form.as_deref()?.into())));
        let texts = self.read().filter_map(|position| Some(("text", position.text.as_deref()?.into())));
        let fields: Vec<(&'static str, Cell)> = form.chain(texts).collect();
        if fields.is_empty() { view } else { view.append(Section::Fields(fields)) }
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.positions.len(), self.errors())
    }
}

/// Positions of a robot of any family.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct AllPositions {
    /// Each group in each frame.
    positions: Vec<Row>,
}

impl Report for AllPositions {
    /// Table for several robots.
    fn view(&self) -> View {
        let mut table = Table::new(&["group", "frame", "position"], "no position");
        for Row { position, error, .. } in &self.positions {
            let described = error.as_ref().map_or_else(|| position.line().into(), ItemError::cell);
            table.row([Cell::optional(position.group.as_deref()), position.frame.as_str().into(), described]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.positions.len(), self.positions.iter().filter_map(|row| row.error.as_ref()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::csv::Sheet;
    use crate::output::render;
    use crate::report::sheet_of;
    use crate::robot::item::Items;

    fn cartesian() -> Position {
        Position {
            frame: "base".to_owned(),
            x_mm: Some(185.001),
            y_mm: Some(-0.001),
            z_mm: Some(600.0),
            rx_deg: Some(180.0),
            ry_deg: Some(0.0),
            rz_deg: Some(-0.0001),
            tool: Some(1),
            user_frame: Some(0),
            form: Some("front+upper+noflip".to_owned()),
            ..Position::default()
        }
    }

    fn pulses(values: &[i32]) -> Position {
        let joint =
            |(name, pulses): (&str, &i32)| Joint { axis: name.to_owned(), pulses: Some(*pulses), ..Joint::default() };
        let joints = ["S", "L", "U"].into_iter().zip(values).map(joint).collect();
        Position { frame: "joint".to_owned(), joints, ..Position::default() }
    }

    #[test]
    fn four_axes_have_the_columns_of_a_position_without_the_last_axes() {
        let columns = |sheet: Sheet| sheet.columns().map(ToOwned::to_owned).collect::<Vec<_>>();
        let (all, four) = (columns(sheet_of::<Items<Position>>()), columns(sheet_of::<Items<FourAxes>>()));
        let is_kept = |column: &&String| !["_5_", "_6_", "_7_", "_8_"].iter().any(|axis| column.contains(axis));
        assert_eq!((four.len(), all.len()), (all.iter().filter(is_kept).count(), four.len() + 16));
        assert!(all.iter().filter(is_kept).eq(&four), "{four:?}");
    }

    #[test]
    fn shows_axes_and_coordinates_together() {
        let both =
            Positions::new(vec![Row::new("R1", "joint", Ok(pulses(&[1, 2]))), Row::new("R1", "base", Ok(cartesian()))]);
        assert_eq!(
            render::csv(&both.view()),
            "axis,pulses,base,value,unit\nS,1,X,185.001,mm\nL,2,Y,-0.001,mm\n,,Z,600.000,mm\n,,Rx,180.0000,deg\n\
             ,,Ry,0.0000,deg\n,,Rz,-0.0001,deg\n,,tool,1,\n,,user,0,\n,,form,front+upper+noflip,\n"
        );
        assert_eq!(
            both.line(),
            "s=1 l=2 pulses, x=185.001 y=-0.001 z=600.000 mm, rx=180.0000 ry=0.0000 rz=-0.0001 deg"
        );
    }

    #[test]
    fn failed_row_has_every_key() {
        let failed = Row::new("R2", "base", Err(Failure::new(Kind::Refused, "no")));
        let keys = |row: &Row| {
            let json = serde_json::to_value(row).unwrap();
            json.as_object().unwrap().keys().filter(|key| *key != "error").cloned().collect::<Vec<_>>()
        };
        assert_eq!(keys(&failed), keys(&Row::new("R2", "base", Ok(cartesian()))));
        let both = Positions::new(vec![Row::new("R2", "joint", Ok(pulses(&[1]))), failed]);
        assert_eq!(both.failure().unwrap().kind, Kind::Mixed);
    }
}

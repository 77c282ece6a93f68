//! `toyo position`: current position of the axes.

use super::link::Toyo;
use crate::prelude::basics::*;
use armctl_frame::plot::SeriesHistory;
use armctl_frame::robot::position::{self as robot, Positions};

/// Show the current position.
#[derive(Debug, Args)]
pub struct Position {
    /// Show a small chart of each axis over the rounds of --watch
    #[arg(long)]
    plot: bool,
    #[arg(skip)]
    past: SeriesHistory,
}

impl Command for Position {
    type Family = Toyo;
    type Report = Positions;
    const ID: &'static str = "toyo.position";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Positions> {
        let link = context.link;
        let letters = link.letters().await?;
        let record = link.ask(&Request::bare(table::Command::Mpst)).await?;
        let position = Coordinates::of(&record, letters).position();
        Ok(Positions::one(UNIT, position).plotted(self.plot, &self.past))
    }
}

/// Group name of the axes. A controller has only one robot.
pub const UNIT: &str = "unit 1";

/// Returns the heading for the coordinates of an axis, 0 to 3.
pub fn heading(index: usize, letter: &str) -> &'static str {
    const HEADINGS: [[&str; 5]; 4] = [
        ["X (mm)", "axis 1: Y (mm)", "axis 1: Z (mm)", "axis 1: R (mm)", "axis 1 (mm)"],
        ["axis 2: X (mm)", "Y (mm)", "axis 2: Z (mm)", "axis 2: R (mm)", "axis 2 (mm)"],
        ["axis 3: X (mm)", "axis 3: Y (mm)", "Z (mm)", "axis 3: R (mm)", "axis 3 (mm)"],
        ["axis 4: X (mm)", "axis 4: Y (mm)", "axis 4: Z (mm)", "R (mm)", "axis 4 (mm)"],
    ];
    let column = ["X", "Y", "Z", "R"].iter().position(|usual| *usual == letter).unwrap_or(4);
    HEADINGS[index.min(3)][column]
}

/// Title of an axis (0 to 3): its letter. If the letter is unusual for this axis, the title also contains the number of
/// the axis.
pub fn titled(index: usize, letter: &str) -> String {
    match letter {
        _ if ["X", "Y", "Z", "R"].get(index) == Some(&letter) => letter.to_owned(),
        "" => format!("axis {}", index + 1),
        _ => format!("axis {} ({letter})", index + 1),
    }
}

/// Coordinates of the four axes, with the letters of the teach pendant. The protocol calls axes 1 to 4 X, Y, Z and R,
/// whatever their letters are. The manual gives no unit for coordinates (ambiguity R13).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    /// Coordinates of axes 1 to 4.
    mm: [f64; 4],
    letters: Letters,
}

/// Coordinates by the letters on the teach pendant (parameter E01). If the controller does not report a letter, or
/// reports it twice, the keys are `ax1_mm` to `ax4_mm`.
#[derive(JsonSchema)]
#[schemars(rename = "Coordinates")]
#[expect(dead_code, reason = "the shape of what is written below")]
struct CoordinateShape {
    /// Coordinate of axis X.
    x_mm: Option<f64>,
    /// Coordinate of axis Y.
    y_mm: Option<f64>,
    /// Coordinate of axis Z.
    z_mm: Option<f64>,
    /// Coordinate of axis R, in the same unit as the others.
    r_mm: Option<f64>,
}

impl JsonSchema for Coordinates {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        CoordinateShape::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        CoordinateShape::json_schema(generator)
    }

    fn inline_schema() -> bool {
        CoordinateShape::inline_schema()
    }
}

impl Serialize for Coordinates {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map((0..4).map(|axis| (format!("{}_mm", self.letters.name(axis)), self.mm[axis])))
    }
}

impl Coordinates {
    /// Takes the fields `x`, `y`, `z` and `r` of a record, for axes with these letters. A missing field gives 0.
    pub fn of(record: &Record, letters: Letters) -> Self {
        let mm = |name| f64::from(record.number(name).unwrap_or(0)) / 100.0;
        Self { mm: ["x", "y", "z", "r"].map(mm), letters }
    }

    /// Coordinates in mm on a machine with the usual letters, with two decimals as a controller has them.
    pub fn at(mm: [f64; 4]) -> Self {
        // Adding 0 converts -0 to 0.
        Self { mm: mm.map(|mm| (mm * 100.0).round() / 100.0 + 0.0), letters: Letters::USUAL }
    }

    /// Converts the coordinates to a position for a report. X, Y and Z are the axes with these letters.
    pub fn position(&self) -> robot::Position {
        let name = |axis: usize| match self.letters.of(axis) {
            "" => (axis + 1).to_string(),
            letter => letter.to_owned(),
        };
        let text = (0..4).map(|axis| format!("{}={:.2}", self.letters.name(axis), self.mm[axis]));
        let position = robot::Position::of_axes([0, 1, 2, 3].map(name), self.mm, 2);
        let [x_mm, y_mm, z_mm] = ["x", "y", "z"].map(|letter| self.of_letter(letter));
        robot::Position { x_mm, y_mm, z_mm, text: Some(text.collect::<Vec<_>>().join(" ")), ..position }
    }

    /// Coordinates of axes 1 to 4 in mm.
    pub fn mm(&self) -> [f64; 4] {
        self.mm
    }

    /// Coordinate of the axis with this letter; `None` if several axes have it.
    pub fn of_letter(&self, letter: &str) -> Option<f64> {
        self.letters.axis(letter).map(|axis| self.mm[axis])
    }

    /// Coordinates with their names, in one line.
    pub fn in_a_line(&self) -> String {
        let axes = self.mm.iter().enumerate().map(|(axis, mm)| match self.letters.name(axis) {
            numbered if numbered.starts_with("ax") => format!("{} {mm:.2}", titled(axis, self.letters.of(axis))),
            letter => format!("{} {mm:.2}", letter.to_uppercase()),
        });
        axes.collect::<Vec<_>>().join(", ")
    }
}

impl Report for Coordinates {
    fn view(&self) -> View {
        let axes = self.mm.iter().enumerate();
        let fields = axes.map(|(axis, mm)| (heading(axis, self.letters.of(axis)), Cell::number(format!("{mm:.2}"))));
        View { sections: vec![Section::Fields(fields.collect())] }
    }
}

//! `toyo position`: where the axes are.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::link::Toyo;
use crate::client::toyo::Letters;
use crate::command::frame::plot::Past;
use crate::command::robot::position::{self as robot, Positions};
use crate::command::{Command, Context, Report};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::{Cell, Section, View};

/// Asks for the present position.
#[derive(Debug, Args)]
pub struct Position {
    /// Show a small chart of each axis over the rounds of --watch
    #[arg(long)]
    plot: bool,
    #[arg(skip)]
    past: Past,
}

impl Command for Position {
    type Family = Toyo;
    type Report = Positions;
    const ID: &'static str = "toyo.position";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Positions, Failure> {
        let link = context.link;
        let letters = link.letters().await?;
        let record = link.ask(&Request::bare(table::Command::Mpst)).await?;
        let position = Coordinates::of(&record, letters).position();
        Ok(Positions::one(UNIT, position).plotted(self.plot, &self.past))
    }
}

/// What has the axes: a controller has one robot.
pub const UNIT: &str = "unit 1";

/// What stands before or above the coordinates of an axis, 0 to 3.
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

/// How an axis (0 to 3) is called: by its letter, and by its number where others have it in another place.
pub fn titled(index: usize, letter: &str) -> String {
    match letter {
        _ if ["X", "Y", "Z", "R"].get(index) == Some(&letter) => letter.to_owned(),
        "" => format!("axis {}", index + 1),
        _ => format!("axis {} ({letter})", index + 1),
    }
}

/// Coordinates of the four axes, each with the letter that the teach pendant shows for it. On the line they are X, Y, Z
/// and R for axes 1 to 4 whatever their letters are (the manual gives no unit; ambiguity R13).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    /// Of axes 1 to 4.
    mm: [f64; 4],
    letters: Letters,
}

/// Coordinates by the letters that the teach pendant shows (E01). A machine that does not tell its letters, or has one of
/// them twice, has `ax1_mm` to `ax4_mm` in place of those that no letter means alone.
#[derive(JsonSchema)]
#[schemars(rename = "Coordinates")]
#[expect(dead_code, reason = "the shape of what is written below")]
struct Shape {
    /// Of the axis that is X.
    x_mm: Option<f64>,
    /// Of the axis that is Y.
    y_mm: Option<f64>,
    /// Of the axis that is Z.
    z_mm: Option<f64>,
    /// Of the axis that is R, in the same unit as the others.
    r_mm: Option<f64>,
}

impl JsonSchema for Coordinates {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        Shape::schema_name()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        Shape::json_schema(generator)
    }

    fn inline_schema() -> bool {
        Shape::inline_schema()
    }
}

impl Serialize for Coordinates {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map((0..4).map(|axis| (format!("{}_mm", self.letters.name(axis)), self.mm[axis])))
    }
}

impl Coordinates {
    /// The fields `x`, `y`, `z` and `r` of a record, of axes with these letters; 0 for those it does not have.
    pub fn of(record: &Record, letters: Letters) -> Self {
        let mm = |name| f64::from(record.number(name).unwrap_or(0)) / 100.0;
        Self { mm: ["x", "y", "z", "r"].map(mm), letters }
    }

    /// Coordinates of the four axes in mm, to the hundredth as a controller tells them, of a machine with the usual letters.
    pub fn at(mm: [f64; 4]) -> Self {
        // A tiny negative one is 0.
        Self { mm: mm.map(|mm| (mm * 100.0).round() / 100.0 + 0.0), letters: Letters::USUAL }
    }

    /// As reports have them: X, Y and Z by the letters of the axes.
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

    /// Of axes 1 to 4 in mm.
    pub fn mm(&self) -> [f64; 4] {
        self.mm
    }

    /// Of the axis that has this letter alone.
    pub fn of_letter(&self, letter: &str) -> Option<f64> {
        self.letters.axis(letter).map(|axis| self.mm[axis])
    }

    /// With names, in a line.
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

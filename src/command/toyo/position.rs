//! `toyo position`: where the axes are.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::link::Toyo;
use crate::command::frame::plot::{Past, Plot};
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
    type Report = Stands;
    const ID: &'static str = "toyo.position";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stands, Failure> {
        let link = context.link;
        let letters = link.letters().await?;
        let record = link.ask(&Request::bare(table::Command::Mpst)).await?;
        let (place, axes) = (Coordinates::of(&record), letters.all());
        let values = axes.iter().zip(place.mm()).map(|(letter, mm)| (letter.clone(), "mm", 2, mm));
        let plot = self.plot.then(|| self.past.add(values));
        Ok(Stands { place, axes, plot })
    }
}

/// Where the axes are, with their letters.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stands {
    #[serde(flatten)]
    place: Coordinates,
    /// The letters that the teach pendant shows for axes 1 to 4, of which `x_mm`, `y_mm`, `z_mm` and `r_mm` are the
    /// coordinates in this order.
    axes: [String; 4],
    #[serde(skip)]
    plot: Option<Plot>,
}

impl Report for Stands {
    fn view(&self) -> View {
        if let Some(plot) = &self.plot {
            return View { sections: vec![plot.section()] };
        }
        let Coordinates { x_mm, y_mm, z_mm, r_mm } = self.place;
        let axes = self.axes.iter().zip([x_mm, y_mm, z_mm, r_mm]).enumerate();
        let fields = axes.map(|(index, (letter, mm))| (heading(index, letter), Cell::number(format!("{mm:.2}"))));
        View { sections: vec![Section::Fields(fields.collect())] }
    }
}

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
    if ["X", "Y", "Z", "R"].get(index) == Some(&letter) {
        letter.to_owned()
    } else {
        format!("axis {} ({letter})", index + 1)
    }
}

/// Coordinates of the four axes, which are X, Y, Z and R on the line whatever their letters are (the manual gives no unit; ambiguity R13).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Coordinates {
    /// Axis 1.
    pub x_mm: f64,
    /// Axis 2.
    pub y_mm: f64,
    /// Axis 3.
    pub z_mm: f64,
    /// Axis 4, in the same unit as the others.
    pub r_mm: f64,
}

impl Coordinates {
    /// The fields `x`, `y`, `z` and `r` of a record; 0 for those it does not have.
    pub fn of(record: &Record) -> Self {
        let mm = |name| f64::from(record.number(name).unwrap_or(0)) / 100.0;
        Self { x_mm: mm("x"), y_mm: mm("y"), z_mm: mm("z"), r_mm: mm("r") }
    }

    /// Coordinates of the four axes in mm, to the hundredth as a controller tells them.
    pub fn at(mm: [f64; 4]) -> Self {
        // A tiny negative one is 0.
        let [x_mm, y_mm, z_mm, r_mm] = mm.map(|mm| (mm * 100.0).round() / 100.0 + 0.0);
        Self { x_mm, y_mm, z_mm, r_mm }
    }

    /// Coordinates of the four axes in mm.
    pub fn mm(&self) -> [f64; 4] {
        [self.x_mm, self.y_mm, self.z_mm, self.r_mm]
    }

    /// With names, in a line.
    pub fn in_a_line(&self) -> String {
        let Self { x_mm, y_mm, z_mm, r_mm } = self;
        format!("X {x_mm:.2}, Y {y_mm:.2}, Z {z_mm:.2}, R {r_mm:.2}")
    }
}

impl Report for Coordinates {
    fn view(&self) -> View {
        let mm = |value: f64| Cell::number(format!("{value:.2}"));
        View::fields([
            ("X (mm)", mm(self.x_mm)),
            ("Y (mm)", mm(self.y_mm)),
            ("Z (mm)", mm(self.z_mm)),
            ("R (mm)", mm(self.r_mm)),
        ])
    }
}

//! `toyo position`: where the axes are.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::{Cell, View};

/// Asks for the present position.
#[derive(Debug, Args)]
pub struct Position {}

impl Command for Position {
    type Family = Family;
    type Report = Place;
    const ID: &'static str = "toyo.position";

    async fn run(&self, context: Context<'_, Family>) -> Result<Place, Failure> {
        let record = context.link.read(&Request::bare(table::Command::Mpst)).await?;
        Ok(Place::of(&record))
    }
}

/// Coordinates of the four axes (the manual gives no unit; ambiguity R13).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Place {
    /// Axis X.
    pub x_mm: f64,
    /// Axis Y.
    pub y_mm: f64,
    /// Axis Z.
    pub z_mm: f64,
    /// Axis R, in the same unit as the others.
    pub r_mm: f64,
}

impl Place {
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

    /// With names, in a line.
    pub fn in_a_line(&self) -> String {
        let Self { x_mm, y_mm, z_mm, r_mm } = self;
        format!("X {x_mm:.2}, Y {y_mm:.2}, Z {z_mm:.2}, R {r_mm:.2}")
    }
}

impl Report for Place {
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

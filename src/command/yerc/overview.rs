//! `armctl status`: one line a robot.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use crate::command::{Command, Context, Report};
use crate::controller::yerc::group::Group;
use crate::controller::yerc::payload::{ControllerStatus, StatusBit};
use crate::controller::yerc::query::{Coordinates, ReadPosition, ReadStatus};
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Table, Tone, View};

/// Whether robots answer, their mode, servo, alarm and position.
#[derive(Debug, Args)]
pub struct Overview {}

impl Command for Overview {
    type Family = Family;
    type Report = OverviewReport;
    const ID: &'static str = "status";

    async fn run(&self, context: Context<'_, Family>) -> Result<OverviewReport, Failure> {
        let status = match context.link.ask(&ReadStatus).await {
            Ok(status) => status,
            Err(failure) if failure.kind == Kind::NoAnswer => return Ok(OverviewReport::absent(failure)),
            Err(failure) => return Err(failure),
        };
        let query = ReadPosition::new(context.link.model, Group::R1, Coordinates::Base);
        let query = query.map_err(|error| Failure::local(error.to_string()))?;
        // A controller without a first robot has no position to show; that is no failure.
        let position = context.link.try_ask(&query).await?.ok().map(|position| {
            let axes = position.axes.padded();
            let mm = |axis: usize| f64::from(axes[axis]) / 1000.0;
            PositionMm { x_mm: mm(0), y_mm: mm(1), z_mm: mm(2) }
        });
        Ok(OverviewReport::of(status, position))
    }
}

/// The state of one robot in a line.
#[derive(Debug, Serialize, JsonSchema)]
pub struct OverviewReport {
    /// Where it is false, all that follows is null.
    reachable: bool,
    /// `teach` or `play`; null if unknown.
    mode: Option<&'static str>,
    servo_on: Option<bool>,
    running: Option<bool>,
    held: Option<bool>,
    alarm: Option<bool>,
    error: Option<bool>,
    /// The first robot in base coordinates.
    position: Option<PositionMm>,
    #[serde(skip)]
    failure: Option<Failure>,
}

/// A place in base coordinates.
#[derive(Debug, Serialize, JsonSchema)]
#[expect(clippy::struct_field_names, reason = "the unit stands in the name")]
struct PositionMm {
    x_mm: f64,
    y_mm: f64,
    z_mm: f64,
}

impl OverviewReport {
    fn of(status: ControllerStatus, position: Option<PositionMm>) -> Self {
        Self {
            reachable: true,
            mode: super::status::mode(status),
            servo_on: Some(status.servo_on()),
            running: Some(status.has(StatusBit::Running)),
            held: Some(status.held()),
            alarm: Some(status.alarm()),
            error: Some(status.error()),
            position,
            failure: None,
        }
    }

    fn absent(failure: Failure) -> Self {
        Self {
            reachable: false,
            mode: None,
            servo_on: None,
            running: None,
            held: None,
            alarm: None,
            error: None,
            position: None,
            failure: Some(failure),
        }
    }
}

impl Report for OverviewReport {
    fn view(&self) -> View {
        let mut table = Table::new(&["reachable", "mode", "servo", "state", "alarm", "x y z (mm)"], "");
        if !self.reachable {
            let dash = || Cell::from("-");
            table.row([Cell::from("no").tone(Tone::Bad), dash(), dash(), dash(), dash(), dash()]);
            return View::table(table);
        }
        let state = match (self.held, self.running) {
            (Some(true), _) => Cell::from("hold").tone(Tone::Warning),
            (_, Some(true)) => Cell::from("running").tone(Tone::Good),
            _ => "stopped".into(),
        };
        let alarm = match (self.alarm, self.error) {
            (Some(true), _) => Cell::from("alarm").tone(Tone::Bad),
            (_, Some(true)) => Cell::from("error").tone(Tone::Bad),
            _ => "none".into(),
        };
        table.row([
            Cell::from("yes").tone(Tone::Good),
            Cell::maybe(self.mode),
            Cell::maybe(self.servo_on.map(Cell::switch)),
            state,
            alarm,
            Cell::maybe(self.position.as_ref().map(|at| format!("{:.3} {:.3} {:.3}", at.x_mm, at.y_mm, at.z_mm))),
        ]);
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}

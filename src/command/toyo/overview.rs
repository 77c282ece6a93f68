//! A robot of the family in the line that `armctl status` prints.

use super::link::Link;
use super::position::Coordinates;
use super::top::alarms;
use crate::command::face::overview::{Fault, LeftOver, OverviewReport, PositionMm};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::{RunMode, Status};
use crate::controller::toyo::table::Command;
use crate::failure::Failure;

/// Asks for status and position.
pub async fn overview(link: &mut Link) -> Result<OverviewReport, Failure> {
    let status = link.status_of(&[0, 1, 2, 3]).await?;
    let place = Coordinates::of(&link.ask(&Request::bare(Command::Mpst)).await?);
    Ok(report(status, fault(status), Some(place)))
}

/// What the answers say.
pub(super) fn report(status: Status, fault: Fault, place: Option<Coordinates>) -> OverviewReport {
    OverviewReport {
        reachable: true,
        mode: status.run_mode().map(RunMode::name),
        servo_on: Some(status.servo_on()),
        running: Some(status.executing() || status.homing()),
        held: Some(status.paused()),
        error: Some(status.has_error()),
        fault,
        position: place.map(|place| PositionMm { x_mm: place.x_mm, y_mm: place.y_mm, z_mm: place.z_mm }),
        left_over: left_over(status),
        ..OverviewReport::default()
    }
}

/// What a client that is gone left behind, as far as the status tells it.
pub(super) fn left_over(status: Status) -> Vec<LeftOver> {
    let is_program = status.run_mode() == Some(RunMode::Program);
    [
        LeftOver::new(status.host_on(), "the host is ON", "`toyo host off` gives the start input back"),
        LeftOver::new(is_program, "the controller is in program mode", "`toyo mode auto` or `toyo mode step`"),
        LeftOver::new(
            status.paused(),
            "a program stands in its midst",
            "`toyo reset` puts programs to their beginning",
        ),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// What is wrong: the error that is present.
pub(super) fn fault(status: Status) -> Fault {
    Fault::new(status.has_error(), alarms(status).first())
}

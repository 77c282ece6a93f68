//! A robot of the family in the line that `armctl status` prints.

use super::alarm::plan_latest;
use super::link::Link;
use super::status;
use crate::command::face::overview::{Fault, LeftOver, OverviewReport, PositionMm};
use crate::command::frame::dry_run::{Known as _, unknown};
use crate::controller::yerc::group::Group;
use crate::controller::yerc::payload::{ControllerStatus, Position, StatusBit};
use crate::controller::yerc::query::{Coordinates, ReadPosition, ReadStatus};
use crate::failure::Failure;

/// Asks for status and position.
pub async fn overview(link: &mut Link) -> Result<OverviewReport, Failure> {
    let status = link.ask(&ReadStatus).await.known()?;
    let fault = match status {
        Some(status) => status::fault(link, status).await?,
        None => plan_latest(link).map(|()| Fault::default())?,
    };
    let query = link.by_model(|model| ReadPosition::new(model, Group::R1, Coordinates::Base)).await?;
    // A controller without a first robot has no position to show; that is no failure.
    let position = link.try_ask(&query).await.known()?.and_then(Result::ok);
    Ok(report(status.ok_or_else(unknown)?, fault, position.as_ref()))
}

/// What the answers say.
pub(super) fn report(status: ControllerStatus, fault: Fault, base: Option<&Position>) -> OverviewReport {
    let position = base.map(|position| {
        let axes = position.axes.padded();
        let mm = |axis: usize| f64::from(axes[axis]) / 1000.0;
        PositionMm { x_mm: mm(0), y_mm: mm(1), z_mm: mm(2) }
    });
    OverviewReport {
        reachable: true,
        mode: status::mode(status),
        servo_on: Some(status.servo_on()),
        running: Some(status.has(StatusBit::Running)),
        held: Some(status.held()),
        alarm: Some(status.alarm()),
        error: Some(status.error()),
        fault,
        position,
        left_over: left_over(status),
        ..OverviewReport::default()
    }
}

/// What a client that is gone left behind, as far as the status tells it.
pub(super) fn left_over(status: ControllerStatus) -> Vec<LeftOver> {
    let is_held = status.has(StatusBit::HoldCommand);
    let with_power = is_held && status.servo_on();
    [
        LeftOver::new(is_held, "HOLD by a command is on", "`yerc hold off` releases it: what it holds may go on"),
        LeftOver::new(with_power, "servo power is on meanwhile", "`yerc servo off` takes it away"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

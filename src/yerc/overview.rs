//! Summary of a robot for `armctl status`.

use super::alarm::plan_latest;
use super::link::Link;
use super::status;
use crate::prelude::basics::*;
use armctl_controller::yerc::payload::{ControllerStatus, StatusBit};
use armctl_controller::yerc::query::{Coordinates, ReadPosition, ReadStatus};
use armctl_frame::face::overview::{LeftOver, OverviewReport};
use armctl_frame::robot::state::{Fault, Mode, PositionMm, State};

/// Reads status and position.
pub async fn overview(link: &mut Link) -> Result<OverviewReport> {
    let status = link.ask(&ReadStatus).await.known()?;
    let fault = match status {
        Some(status) => status::fault(link, status).await?,
        None => plan_latest(link).map(|()| Fault::default())?,
    };
    let query = link.by_model(|model| ReadPosition::new(model, Group::R1, Coordinates::Base)).await?;
    // A controller without a first robot has no position. This is not a failure.
    let position = link.ask_optional(&query).await.known()?.and_then(Result::ok);
    Ok(report(status.ok_or_else(unknown)?, fault, position.as_ref()))
}

/// Report from the answers.
pub(super) fn report(status: ControllerStatus, fault: Fault, base: Option<&Position>) -> OverviewReport {
    OverviewReport { state: state(status, fault, base), left_over: left_over(status), ..OverviewReport::default() }
}

/// State from the status words (FS and DX 3.3.3).
pub(super) fn state(status: ControllerStatus, fault: Fault, base: Option<&Position>) -> State {
    let position = base.map(|position| {
        let axes = position.axes.padded();
        let mm = |axis: usize| f64::from(axes[axis]) / 1000.0;
        PositionMm { x_mm: mm(0), y_mm: mm(1), z_mm: mm(2) }
    });
    let is_play = match (status.has(StatusBit::Teach), status.has(StatusBit::Play)) {
        (true, false) => Some(false),
        (false, true) => Some(true),
        // The controller reports neither of the two modes, or both.
        _ => None,
    };
    State {
        reachable: true,
        mode: is_play.map(Mode::automatic),
        controller_mode: is_play.map(|is_play| if is_play { "play" } else { "teach" }),
        servo_on: Some(status.servo_on()),
        running: Some(status.running()),
        held: Some(status.held()),
        fault,
        position,
        ..State::default()
    }
}

/// State that an earlier client left on the controller, derived from the status.
pub(super) fn left_over(status: ControllerStatus) -> Vec<LeftOver> {
    let is_held = status.has(StatusBit::HoldCommand);
    let with_power = is_held && status.servo_on();
    [
        LeftOver::new(
            is_held,
            "HOLD by a command is on",
            "use `yerc hold off` to release HOLD; the held motion may continue",
        ),
        LeftOver::new(with_power, "servo power is on", "use `yerc servo off` to switch servo power off"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

//! Summary of a controller for `armctl status`.

use super::link::Link;
use super::position::Coordinates;
use super::top::alarms;
use crate::prelude::basics::*;
use armctl_controller::toyo::status::RunMode;
use armctl_controller::toyo::table::Command;
use armctl_frame::face::overview::{LeftOver, OverviewReport};
use armctl_frame::robot::state::{Fault, Mode, PositionMm, State};

/// Reads status and position.
pub async fn overview(link: &mut Link) -> Result<OverviewReport> {
    let status = link.status_of(&[0, 1, 2, 3]).await?;
    let letters = link.letters().await?;
    let coordinates = Coordinates::of(&link.ask(&Request::bare(Command::Mpst)).await?, letters);
    Ok(report(status, Some(coordinates)))
}

/// Creates the report from the answers.
pub(super) fn report(status: Status, coordinates: Option<Coordinates>) -> OverviewReport {
    // X, Y and Z are the axes that have these letters on the teach pendant.
    let position = coordinates.and_then(|coordinates| {
        let of = |letter| coordinates.of_letter(letter);
        Some(PositionMm { x_mm: of("X")?, y_mm: of("Y")?, z_mm: of("Z")? })
    });
    let state = State { position, ..state(status) };
    OverviewReport { state, left_over: left_over(status), ..OverviewReport::default() }
}

/// State according to the pages of the status.
pub(super) fn state(status: Status) -> State {
    let mode = status.run_mode();
    State {
        reachable: true,
        mode: mode.map(|mode| Mode::automatic(mode == RunMode::Automatic)),
        controller_mode: mode.map(RunMode::name),
        servo_on: Some(status.servo_on()),
        running: Some(status.executing() || status.homing()),
        held: Some(status.paused()),
        homed: Some(status.homed()),
        fault: Fault::new(status.has_error(), alarms(status).first()),
        ..State::default()
    }
}

/// Settings that a client left when it ended, if the status shows them.
pub(super) fn left_over(status: Status) -> Vec<LeftOver> {
    let is_program = status.run_mode() == Some(RunMode::Program);
    [
        LeftOver::new(status.host_on(), "the host is ON", "use `toyo host off` to release the host"),
        LeftOver::new(is_program, "the controller is in program mode", "use `toyo mode auto` or `toyo mode step`"),
        LeftOver::new(status.paused(), "a program is paused", "use `toyo reset` to reset programs to the first step"),
    ]
    .into_iter()
    .flatten()
    .collect()
}

//! A robot of the family in the line that `armctl status` prints.

use super::link::Link;
use super::position::Coordinates;
use super::top::alarms;
use crate::command::face::overview::{LeftOver, OverviewReport};
use crate::command::robot::state::{Fault, Mode, PositionMm, State};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::{RunMode, Status};
use crate::controller::toyo::table::Command;
use crate::failure::Failure;

/// Asks for status and position.
pub async fn overview(link: &mut Link) -> Result<OverviewReport, Failure> {
    let status = link.status_of(&[0, 1, 2, 3]).await?;
    let letters = link.letters().await?;
    let place = Coordinates::of(&link.ask(&Request::bare(Command::Mpst)).await?, letters);
    Ok(report(status, Some(place)))
}

/// What the answers say.
pub(super) fn report(status: Status, place: Option<Coordinates>) -> OverviewReport {
    // Where the axes are X, Y and Z by the letters of the pendant.
    let position = place.and_then(|place| {
        let of = |letter| place.of_letter(letter);
        Some(PositionMm { x_mm: of("X")?, y_mm: of("Y")?, z_mm: of("Z")? })
    });
    let state = State { position, ..state(status) };
    OverviewReport { state, left_over: left_over(status), ..OverviewReport::default() }
}

/// The state that the pages tell.
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

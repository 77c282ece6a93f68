//! A robot of the family in the line that `armctl status` prints.

use super::link::Link;
use super::status::position_mm;
use crate::command::overview::{OverviewReport, PositionMm};
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::signal::{input, output};
use crate::failure::Failure;

/// Why there is no position.
const NOT_ASKED: &str = "asking for the position takes command of the controller: `yrcx status --full`, or a session";

/// The same while a session gives somebody else's command.
const BUSY: &str = "another client's remote command is under way, and there is one at a time";

/// Looks at the signals, and asks for the position where that does not take command of the controller first.
pub async fn overview(link: &mut Link) -> Result<OverviewReport, Failure> {
    let image = link.look().await?;
    // Somebody else's remote command is not waited for: it may be a motion.
    let is_busy = link.is_shared() && Status::of(image.0[0]) == Status::Running;
    let position = if link.commands() && !is_busy { position_mm(link).await? } else { None };
    Ok(OverviewReport {
        reachable: true,
        mode: Some(if output::AUTO_MODE.is_on(&image) { "auto" } else { "manual" }),
        servo_on: Some(output::SERVO_ON.is_on(&image)),
        running: Some(output::PROGRAM_RUNNING.is_on(&image)),
        held: link.shown().map(|shown| !input::STOP.is_on(shown)),
        alarm: Some(output::ALARM.is_on(&image)),
        error: None,
        position: position.map(|[x_mm, y_mm, z_mm, _]| PositionMm { x_mm, y_mm, z_mm }),
        not_asked: if is_busy { Some(BUSY) } else { (!link.commands()).then_some(NOT_ASKED) },
        failure: None,
    })
}

//! A robot of the family in the line that `armctl status` prints.

use super::info::AlarmReport;
use super::link::Link;
use super::status::position_mm;
use crate::command::face::overview::{Fault, LeftOver, OverviewReport, PositionMm};
use crate::command::face::sample::Alarm;
use crate::controller::yrcx::answer::Status;
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::signal::{input, output};
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;

/// Why there is no position.
const NOT_ASKED: &str =
    "servos and position are remote commands, which take command of the controller: `yrcx status --full`, or a session";

/// The same where there are no remote commands.
const NO_COMMANDS: &str =
    "servos and position are remote commands, for which the fieldbus unit has no words (I/O size \"Compact\")";

/// The same while a session gives somebody else's command.
const BUSY: &str =
    "servos and position were not asked for: another client's remote command is under way, and there is one at a time";

/// Looks at the signals, and asks for the position where that does not take command of the controller first.
pub async fn overview(link: &mut Link) -> Result<OverviewReport, Failure> {
    let image = link.look().await?;
    let not_asked = not_asked(link, &image);
    let position = if not_asked.is_none() { position_mm(link).await? } else { None };
    let position = position.map(|[x_mm, y_mm, z_mm, _]| PositionMm { x_mm, y_mm, z_mm });
    let has_alarm = output::ALARM.is_on(&image);
    let alarm = if has_alarm && not_asked.is_none() { latest_alarm(link).await? } else { None };
    Ok(OverviewReport { position, not_asked, ..report(link, &image, alarm.as_ref()) })
}

/// Asks for what the signal of an alarm does not tell.
async fn latest_alarm(link: &mut Link) -> Result<Option<Alarm>, Failure> {
    let order = latest(link)?;
    Ok(link.try_ask(&order).await?.ok().and_then(|done| alarm(&done.values)))
}

/// The question for the latest alarm. That entry 1 of the history is the latest is not in the manual.
pub(super) fn latest(link: &Link) -> Result<Order, Failure> {
    Ok(link.draft(Command::AlarmHistory)?.with(Key::History, 1).build()?)
}

/// What the answer to it tells.
pub(super) fn alarm(values: &Values) -> Option<Alarm> {
    let AlarmReport { code, meaning, remedies, .. } = AlarmReport::of(values);
    let text = format!("{} (entry 1 of the history)", meaning.unwrap_or_default());
    Some(Alarm { code: code?, text, remedy: remedies.join("; ") })
}

/// Why no remote command may be given only to look. Somebody else's is not waited for: it may be a motion.
pub(super) fn not_asked(link: &Link, image: &Image) -> Option<&'static str> {
    if link.is_shared() && Status::from_word(image.0[0]) == Status::Running {
        return Some(BUSY);
    }
    if !link.has_commands() {
        return Some(NO_COMMANDS);
    }
    (!link.commands()).then_some(NOT_ASKED)
}

/// What the signals say, and what is known of the alarm.
pub(super) fn report(link: &Link, image: &Image, alarm: Option<&Alarm>) -> OverviewReport {
    OverviewReport {
        reachable: true,
        mode: Some(if output::AUTO_MODE.is_on(image) { "auto" } else { "manual" }),
        servo_on: Some(output::SERVO_ON.is_on(image)),
        running: Some(output::PROGRAM_RUNNING.is_on(image)),
        held: link.shown().map(|shown| !input::STOP.is_on(shown)),
        alarm: Some(output::ALARM.is_on(image)),
        fault: Fault::new(output::ALARM.is_on(image), alarm),
        left_over: left_over(image),
        ..OverviewReport::default()
    }
}

/// What a client that is gone left behind, as far as the signals tell it.
pub(super) fn left_over(image: &Image) -> Vec<LeftOver> {
    let status = Status::from_word(image.0[0]);
    // A program that runs may be anybody's, and is as it should be.
    let is_command = !matches!(status, Status::Ready | Status::Running);
    let what = format!("a remote command left its status: {status}");
    LeftOver::new(is_command, &what, "`yrcx status-reset` clears it").into_iter().collect()
}

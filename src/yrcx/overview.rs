//! Summary of a robot for `armctl status`.

use super::info::entry;
use super::status::position_mm;
use crate::prelude::*;
use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::signal::input;
use armctl_controller::yrcx::table::Command;
use armctl_frame::face::overview::{LeftOver, OverviewReport};
use armctl_frame::robot::alarm::{Alarm, Kind, Source};
use armctl_frame::robot::state::{Fault, Mode, PositionMm, State};

/// Reason why a read-only client did not read the position.
const NOT_ASKED: &str = "servos and position need remote commands, which take control of the controller: use `yrcx \
                         status --full` or a session";

/// Reason if the fieldbus unit does not support remote commands.
const NO_COMMANDS: &str =
    "servos and position need remote commands, which the fieldbus unit does not support (I/O size \"Compact\")";

/// Reason if a remote command of another client is running.
const BUSY: &str = "servos and position were not read: another client's remote command is running";

/// Reads the signals. Also reads the position, if that does not take control of the controller.
pub async fn overview(link: &mut Link) -> Result<OverviewReport> {
    let image = link.look().await?;
    let not_asked = not_asked(link, &image);
    let position = if not_asked.is_none() { position_mm(link).await? } else { None };
    let position = position.map(PositionMm::of_axes);
    let has_alarm = output::ALARM.is_on(&image);
    let alarm = if has_alarm && not_asked.is_none() { latest_alarm(link).await? } else { None };
    Ok(report(link, &image, alarm.as_ref(), position, not_asked))
}

/// Present alarm. Its number is not read if that would take control of the controller.
pub(super) async fn alarms(link: &mut Link) -> Result<Vec<Alarm>> {
    let image = link.look().await?;
    let (alarm, warning) = (output::ALARM.is_on(&image), output::WARNING.is_on(&image));
    let kind = match (alarm, warning) {
        (false, false) => return Ok(Vec::new()),
        (true, _) => Kind::Alarm,
        (false, true) => Kind::Warning,
    };
    let known = if not_asked(link, &image).is_none() { latest_alarm(link).await? } else { None };
    let untold = || {
        Alarm {
        text: Some(
            "the alarm number was not read; `yrcx alarm list` of this robot reads it, and takes control of the controller"
                .to_owned(),
        ),
        source: Source::Armctl,
        ..Alarm::default()
    }
    };
    Ok(vec![Alarm { kind: Some(kind), ..known.unwrap_or_else(untold) }])
}

/// Reads which alarm is present, because the signal does not identify the alarm.
async fn latest_alarm(link: &mut Link) -> Result<Option<Alarm>> {
    let order = latest()?;
    Ok(link.try_ask(&order).await?.ok().and_then(|done| alarm(&done.values)))
}

/// Request for the latest alarm of the controller, whatever robot `--unit` selects. The manual does not say that entry 1
/// of the history is the latest.
pub(super) fn latest() -> Result<Order> {
    Command::AlarmHistory.order().with(Key::History, 1).valid_order()
}

/// Takes the alarm from an answer.
pub(super) fn alarm(values: &Values) -> Option<Alarm> {
    let alarm = entry(values, Kind::Alarm)?.alarm;
    let text = format!("{} (entry 1 of the history)", alarm.text.unwrap_or_default());
    Some(Alarm { text: Some(text), ..alarm })
}

/// Returns the reason why armctl sends no remote command for a summary; `None` if it can send one. armctl does not wait
/// for a remote command of another client, because that command may be a motion.
pub(super) fn not_asked(link: &Link, image: &Image) -> Option<&'static str> {
    if link.is_shared() && Status::from_word(image.0[0]) == Status::Running {
        return Some(BUSY);
    }
    if !link.has_commands() {
        return Some(NO_COMMANDS);
    }
    (!link.commands()).then_some(NOT_ASKED)
}

/// Report from the signals, the alarm and the position.
pub(super) fn report(
    link: &Link,
    image: &Image,
    alarm: Option<&Alarm>,
    position: Option<PositionMm>,
    not_asked: Option<&'static str>,
) -> OverviewReport {
    let state = State { position, ..state(link, image, alarm) };
    OverviewReport { state, not_asked, left_over: left_over(image), ..OverviewReport::default() }
}

/// Derives the state from the signals (chapter 1, section 2).
pub(super) fn state(link: &Link, image: &Image, alarm: Option<&Alarm>) -> State {
    let is_auto = output::AUTO_MODE.is_on(image);
    State {
        reachable: true,
        mode: Some(Mode::automatic(is_auto)),
        controller_mode: Some(if is_auto { "auto" } else { "manual" }),
        servo_on: Some(output::SERVO_ON.is_on(image)),
        running: Some(output::PROGRAM_RUNNING.is_on(image)),
        held: link.output_image().map(|shown| !input::STOP.is_on(shown)),
        homed: Some(output::ORIGIN_COMPLETE.is_on(image)),
        emergency_stop: Some(output::EMERGENCY_STOP.is_on(image)),
        fault: Fault::new(output::ALARM.is_on(image), alarm),
        ..State::default()
    }
}

/// Finds in the signals what a previous client left behind.
pub(super) fn left_over(image: &Image) -> Vec<LeftOver> {
    let status = Status::from_word(image.0[0]);
    // A running program is normal: the client that started the program does not have to be connected.
    let is_command = !matches!(status, Status::Ready | Status::Running);
    let what = format!("a remote command left its status: {status}");
    LeftOver::new(is_command, &what, "use `yrcx status-reset` to reset the status").into_iter().collect()
}

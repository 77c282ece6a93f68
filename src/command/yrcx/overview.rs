//! A robot of the family in the line that `armctl status` prints.

use super::info::entry;
use super::link::Link;
use super::status::position_mm;
use crate::command::face::overview::{LeftOver, OverviewReport};
use crate::command::robot::alarm::{Alarm, Kind, Source};
use crate::command::robot::state::{Fault, Mode, PositionMm, State};
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
    let position = position.map(PositionMm::of_axes);
    let has_alarm = output::ALARM.is_on(&image);
    let alarm = if has_alarm && not_asked.is_none() { latest_alarm(link).await? } else { None };
    Ok(report(link, &image, alarm.as_ref(), position, not_asked))
}

/// The alarm that is present; which one it is is not asked where that takes command of the controller.
pub(super) async fn alarms(link: &mut Link) -> Result<Vec<Alarm>, Failure> {
    let image = link.look().await?;
    let (alarm, warning) = (output::ALARM.is_on(&image), output::WARNING.is_on(&image));
    let kind = match (alarm, warning) {
        (false, false) => return Ok(Vec::new()),
        (true, _) => Kind::Alarm,
        (false, true) => Kind::Warning,
    };
    let known = if not_asked(link, &image).is_none() { latest_alarm(link).await? } else { None };
    let untold = || Alarm {
        text: Some("which one is not told here; `yrcx alarm list` asks, which takes command".to_owned()),
        source: Source::Armctl,
        ..Alarm::default()
    };
    Ok(vec![Alarm { kind: Some(kind), ..known.unwrap_or_else(untold) }])
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
    let alarm = entry(values, Kind::Alarm)?.alarm;
    let text = format!("{} (entry 1 of the history)", alarm.text.unwrap_or_default());
    Some(Alarm { text: Some(text), ..alarm })
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

/// What the signals say, and what is known of the alarm and the position.
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

/// The state that the signals tell (chapter 1, section 2).
pub(super) fn state(link: &Link, image: &Image, alarm: Option<&Alarm>) -> State {
    let is_auto = output::AUTO_MODE.is_on(image);
    State {
        reachable: true,
        mode: Some(Mode::automatic(is_auto)),
        controller_mode: Some(if is_auto { "auto" } else { "manual" }),
        servo_on: Some(output::SERVO_ON.is_on(image)),
        running: Some(output::PROGRAM_RUNNING.is_on(image)),
        held: link.shown().map(|shown| !input::STOP.is_on(shown)),
        homed: Some(output::ORIGIN_COMPLETE.is_on(image)),
        emergency_stop: Some(output::EMERGENCY_STOP.is_on(image)),
        fault: Fault::new(output::ALARM.is_on(image), alarm),
        ..State::default()
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

//! Events that can stop a motion or a job while a command waits for its end.

use super::alarm;
use crate::prelude::*;
use armctl_controller::yerc::payload::{ControllerStatus, StatusBit};
use armctl_controller::yerc::query::{Query as _, ReadAlarm};
use armctl_frame::robot::alarm::hint_after;

/// Interval of status reads. A controller answers in 5 to 20 ms, and a shorter interval has no benefit.
pub(super) const POLL_INTERVAL: Duration = Duration::from_millis(50);
/// Maximum time until a controller starts an accepted motion or job.
pub(super) const START_TIMEOUT: Duration = Duration::from_secs(3);

/// Cause for which the controller moves nothing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StandstillCause {
    /// An alarm is present.
    Alarm,
    /// An error is present.
    Error,
    /// A HOLD is active. Contains its source.
    Hold(&'static str),
    /// Servo power is off.
    ServoOff,
    /// The mode switch is in teach position.
    Teach,
}

/// Sources of a hold, each with how to release it.
const HOLDS: [(StatusBit, &str, &str); 3] = [
    (StatusBit::HoldPendant, "pendant", "release HOLD on the pendant"),
    (StatusBit::HoldExternal, "external signal", "clear the external hold (PLC, door, interlock)"),
    (StatusBit::HoldCommand, "command", "use `yerc hold off` to release the hold"),
];

impl StandstillCause {
    /// Most important cause of standstill in a status. There was no such cause when the controller accepted the
    /// request.
    pub(super) fn of(status: ControllerStatus) -> Option<Self> {
        let hold = HOLDS.iter().find(|row| status.has(row.0));
        if status.alarm() {
            Some(Self::Alarm)
        } else if let Some((_, by, _)) = hold {
            Some(Self::Hold(by))
        } else if status.error() {
            Some(Self::Error)
        } else if !status.servo_on() {
            Some(Self::ServoOff)
        } else if status.has(StatusBit::Teach) {
            Some(Self::Teach)
        } else {
            None
        }
    }

    /// Failure that contains the result so far (`done`) and the current position.
    pub(super) async fn failure(self, link: &mut Link, done: &str, place: Option<&str>) -> Failure {
        let (what, code) = match self {
            Self::Alarm => present_alarm(link).await,
            Self::Error => ("an error occurred".to_owned(), None),
            Self::Hold(by) => (format!("hold by {by} was switched on"), None),
            Self::ServoOff => ("servo power was switched off".to_owned(), None),
            Self::Teach => ("the mode was switched to teach".to_owned(), None),
        };
        let place = place.map(|place| format!("; position: {place}")).unwrap_or_default();
        let hint = match self {
            Self::Alarm => hint_after(Family::Yerc, code.as_deref()),
            Self::Error => "read the display of the pendant; use `yerc alarm cancel` to clear the error".to_owned(),
            Self::Hold(by) => {
                let how = HOLDS.iter().find(|row| row.1 == by).map_or("release it", |row| row.2);
                format!("{how}; the interrupted motion may then continue")
            }
            Self::ServoOff => "check for a stop or an open door before `yerc servo on`".to_owned(),
            Self::Teach => "check whether another person is at the pendant, and ask before you continue".to_owned(),
        };
        let failure = Failure::new(Kind::ConditionNotMet, format!("{done}, but {what}{place}")).hint(hint);
        Failure { code, ..failure }
    }
}

/// Text and code of the latest alarm. If the alarm cannot be read, the text states only that there is an alarm.
async fn present_alarm(link: &mut Link) -> (String, Option<String>) {
    let question = match ReadAlarm::new(1, false).map_err(usage) {
        Ok(question) => question,
        Err(failure) => return (format!("an alarm occurred ({failure})"), None),
    };
    match link.ask(&question).await {
        Ok(alarm) if !alarm.is_none() => {
            let words = alarm::in_a_line(&alarm, link.encoding, link.model_for_display());
            (format!("{words} occurred"), Some(alarm.code.to_string()))
        }
        Ok(_) => ("an alarm occurred and was reset".to_owned(), None),
        Err(failure) => (format!("an alarm occurred but could not be read: {failure}"), None),
    }
}

/// In a dry run, records the request that follows an alarm.
pub(super) fn plan_alarm(link: &mut Link) -> Result<()> {
    let question = ReadAlarm::new(1, false).map_err(usage)?;
    let reason = Reason::about("alarm number, after an alarm").depending_on("whether the status shows an alarm");
    link.plan_if(&question.request(), reason);
    Ok(())
}

/// Failure: the connection was lost during a wait. The action continues without supervision, so its outcome is unknown.
pub(super) fn lost_contact(done: &str, failure: Failure) -> Failure {
    let message = format!("{done}, but armctl could not read the result: {failure}");
    Failure { kind: Kind::OutcomeUnknown, message, ..failure }
        .hint("do not send the command again; use `yerc status` and `yerc position` to see the result")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_the_most_severe_cause() {
        let fine = ControllerStatus::default().with(StatusBit::ServoOn, true).with(StatusBit::Play, true);
        let with =
            |bits: &[StatusBit]| StandstillCause::of(bits.iter().fold(fine, |status, bit| status.with(*bit, true)));
        assert_eq!(with(&[]), None);
        assert_eq!(with(&[StatusBit::Running, StatusBit::CommandRemote]), None);
        assert_eq!(with(&[StatusBit::HoldCommand, StatusBit::Alarm]), Some(StandstillCause::Alarm));
        assert_eq!(with(&[StatusBit::HoldCommand, StatusBit::Error]), Some(StandstillCause::Hold("command")));
        assert_eq!(with(&[StatusBit::Teach]), Some(StandstillCause::Teach));
        assert_eq!(StandstillCause::of(ControllerStatus::default()), Some(StandstillCause::ServoOff));
    }

    #[test]
    fn lost_contact_leaves_the_outcome_unknown() {
        let failure = lost_contact("the job was started", Failure::new(Kind::NoAnswer, "silence").code("0x1"));
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert_eq!(failure.message, "the job was started, but armctl could not read the result: silence");
    }
}

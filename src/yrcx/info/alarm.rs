//! Command `yrcx info alarm` (4.7.17), and the conversion of alarms in answers.

use crate::prelude::*;
use crate::single_command::{format_field, one_row};
use armctl_controller::yrcx::alarm;
use armctl_controller::yrcx::table::Command;
use armctl_frame::robot::alarm::{
    Alarm as CommandResults, AlarmEntry, Alarms, ExtraColumns, Kind, Nothing, Row, Source,
};

one_row! {
    /// Reads the last alarm that a remote command caused.
    Alarm(self) "yrcx.info.alarm" -> Alarms<Part> {}
    gives Command::LatestAlarm,
    done as answer => {
        let row = entry(&answer.values, Kind::Alarm).map(|entry| Row::new(1, "alarm", Ok(entry)));
        Alarms { alarms: row.into_iter().collect(), standing: Nothing {}, asked: 1 }
    };
}

/// Source of an alarm.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Part {
    /// Robot, controller or task that the alarm concerns.
    place: Option<String>,
    /// Axis, motor, option slot or program task that the alarm concerns.
    part: Option<String>,
}

impl ExtraColumns for Part {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        vec![("place", self.place.clone()), ("part", self.part.clone())]
    }
}

/// Takes the alarm from an answer; `None` if the alarm number is 0.0.
pub fn entry(values: &Values, kind: Kind) -> Option<AlarmEntry<Part>> {
    let number = |key| values.int(key).and_then(|number| u16::try_from(number).ok()).unwrap_or_default();
    let found = alarm::Alarm::new(number(Key::AlarmGroup), number(Key::AlarmCategory));
    if found == alarm::Alarm::new(0, 0) {
        return None;
    }
    let place = |kind, count| {
        let kind = format_field(Command::LatestAlarm, values, kind)?;
        match values.int(count) {
            // If the number is 0 or missing, the source is all objects of this kind, or a task that has no number.
            Some(0) | None => Some(kind),
            Some(number) => Some(format!("{kind} {number}")),
        }
    };
    let part = Part { place: place(Key::Place1, Key::Place1Number), part: place(Key::Place2, Key::Place2Number) };
    Some(AlarmEntry { alarm: CommandResults { kind: Some(kind), ..describe_alarm(found) }, own: part })
}

/// Adds text, cause and remedy from the built-in table to an alarm number.
pub fn describe_alarm(alarm: alarm::Alarm) -> CommandResults {
    let known = alarm.known();
    let line = |lines: &[&str]| Some(lines.join("; ")).filter(|line| !line.is_empty());
    CommandResults {
        code: Some(alarm.to_string()),
        text: Some(alarm.text().to_owned()),
        kind: Some(Kind::Alarm),
        cause: known.and_then(|known| line(known.causes)),
        remedy: known.and_then(|known| line(known.remedies)),
        source: Source::Armctl,
        ..CommandResults::default()
    }
}

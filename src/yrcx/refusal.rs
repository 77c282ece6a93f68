//! Conversion of commands that armctl rejected or the controller refused to failures.

use crate::prelude::basics::*;
use armctl_client::yrcx::Refusal;
use armctl_controller::yrcx::alarm::STOP_INPUT;
use armctl_controller::yrcx::codec::WordError;
use armctl_controller::yrcx::table::{DurationClass, Row};
use armctl_controller::yrcx::value::Value;

/// Builds the order of a command line.
pub trait BuildOrder {
    /// Returns the order. A field that the manual does not allow is an error of the command line.
    fn valid_order(self) -> Result<Order>;
}

impl BuildOrder for Draft {
    fn valid_order(self) -> Result<Order> {
        self.build().map_err(|error| invalid_words(&error))
    }
}

/// Failure for words that the manual does not allow: an error of the command line.
pub fn invalid_words(error: &WordError) -> Failure {
    // The user typed the field, so the message names the field. Only raw words need the word index.
    let message = match error.place.key {
        Some(key) => format!("{key}: {}", error.problem),
        None => error.to_string(),
    };
    let failure = Failure::usage(message);
    match error.alarm {
        Some(alarm) => failure.hint(format!(
            "correct the value; the controller would refuse this value with alarm {alarm}, {}",
            alarm.text()
        )),
        None => failure.hint("see `--help` for the valid values"),
    }
}

/// Failure for a refusal by the controller, at once or during execution, with the name of the object.
pub fn refusal_failure(Refusal { order, alarm, .. }: Refusal) -> Failure {
    refused_order(&order, alarm)
}

fn refused_order(order: &Order, alarm: Alarm) -> Failure {
    let failure = refused(order.row(), alarm);
    let (id, object) = (order.row().id, object(order));
    if object.is_empty() {
        return failure;
    }
    let named = format!("{id} ({object}): alarm");
    Failure { message: failure.message.replacen(&format!("{id}: alarm"), &named, 1), ..failure }
}

/// Object of a command, for example `pallet 3`; empty if the command has no object.
pub fn object(order: &Order) -> String {
    let instances = order.row().request().filter(|field| INSTANCES.contains(&field.key));
    let named = instances.filter_map(|field| {
        let value = order.values().value(field.key)?;
        // Robot 0 means the first robot, so the message does not name it.
        let is_named = field.key != Key::Robot || *value != Value::Int(0);
        is_named.then(|| format!("{} {}", field.key.name().replace('_', " "), field.show(value)))
    });
    named.collect::<Vec<_>>().join(", ")
}

/// Fields that select the object of a command.
const INSTANCES: [Key; 12] = [
    Key::Robot,
    Key::Point,
    Key::Point2,
    Key::Pallet,
    Key::WorkPosition,
    Key::Shift,
    Key::Hand,
    Key::Variable,
    Key::Parameter,
    Key::PortType,
    Key::Port,
    Key::History,
];

/// Refusal of a command by the controller.
pub fn refused(row: &Row, alarm: Alarm) -> Failure {
    let what = match (row.risk, row.pace) {
        (Risk::Motion, DurationClass::Motion | DurationClass::Jog) => "refused or aborted",
        _ => "refused",
    };
    let remedy = match alarm.known().and_then(|known| known.remedies.first()) {
        Some(remedy) => (*remedy).to_owned(),
        None => format!("look up {alarm} in the controller's manual; use `yrcx info alarm` to see the source"),
    };
    let way_out = WAYS_OUT.iter().find(|(_, alarms)| alarms.contains(&alarm)).map(|(way, _)| *way).unwrap_or_default();
    let relative_motion_warning = relative_motion_warning(row, "if the robot had started to move, ");
    Failure::new(Kind::Refused, format!("the controller {what} {}: alarm {alarm}, {}", row.id, alarm.text()))
        .code(alarm.to_string())
        .hint(format!("{remedy}{way_out}{relative_motion_warning}"))
}

/// Hints with the commands that remove the cause of an alarm.
const WAYS_OUT: [(&str, &[Alarm]); 2] =
    [(": use `yrcx io set stop=on`", &[STOP_INPUT]), ("; use `yrcx recover` to clear the alarm", &RECOVERABLE)];

/// Alarms that `yrcx recover` clears: a lost link, with its numbers on each fieldbus, and an emergency stop.
const RECOVERABLE: [Alarm; 9] = [
    Alarm::new(12, 541),
    Alarm::new(12, 542),
    Alarm::new(12, 551),
    Alarm::new(12, 552),
    Alarm::new(12, 561),
    Alarm::new(12, 562),
    Alarm::new(12, 571),
    Alarm::new(12, 572),
    Alarm::new(12, 600),
];

/// Warns how a relative motion behaves if it is repeated after a stop (4.2.2, 4.2.4); empty for other commands.
pub fn relative_motion_warning(row: &Row, condition: &str) -> String {
    if !row.keeps_target() {
        return String::new();
    }
    format!(
        "; {condition}the same command moves to the old target, unless the controller's \"MOVEI/DRIVEI start \
         position\" is Reset"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yrcx::alarm::INPUT_FORMAT;
    use armctl_controller::yrcx::table::Command;

    #[test]
    fn an_alarm_has_its_number_and_a_remedy() {
        let failure = refused(Command::MovePtp.row(), Alarm::new(2, 334));
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("2.334")));
        assert_eq!(failure.message, "the controller refused or aborted move-ptp: alarm 2.334, over soft limit");
        assert_eq!(failure.hint.as_deref(), Some("check the point and the soft limits"));
        let unknown = refused(Command::VarGet.row(), Alarm::new(17, 1));
        assert_eq!(unknown.message, "the controller refused var-get: alarm 17.1, motor control");
        assert!(unknown.hint.unwrap().starts_with("look up 17.1"));
        let stopped = refused(Command::JogPulse.row(), STOP_INPUT);
        assert!(stopped.message.contains("12.400") && stopped.hint.unwrap().ends_with("`yrcx io set stop=on`"));
        assert!(refused(Command::MovePtp.row(), Alarm::new(12, 551)).hint.unwrap().contains("yrcx recover"));
    }

    #[test]
    fn invalid_words_are_a_usage_error() {
        let error = Command::MovePtp.order().with(Key::Point, 30_000).build().unwrap_err();
        let failure = invalid_words(&WordError { alarm: Some(INPUT_FORMAT), ..error });
        assert_eq!(failure.kind, Kind::Usage);
        assert_eq!(failure.message, "point: 30000 is out of range; allowed: 0 to 29999");
        assert_eq!(
            failure.hint.unwrap(),
            "correct the value; the controller would refuse this value with alarm 4.202, input format error"
        );
    }
}

//! Why an order was not carried out, in words: rejected by armctl, refused by the controller, or nobody knows.

use super::io::named;
use super::position::Unit;
use crate::controller::Risk;
use crate::controller::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::controller::yrcx::codec::WordError;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::sequence;
use crate::controller::yrcx::session::{Ended, NotSentReason, Outcome, Silence};
use crate::controller::yrcx::table::{Command, Pace, Row};
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::{Failure, Kind};

/// Words that the manual does not allow to be sent are a mistake of the command line.
impl From<WordError> for Failure {
    fn from(error: WordError) -> Self {
        let failure = Self::usage(error.to_string());
        match error.alarm {
            Some(alarm) => failure.hint(format!("the controller would refuse it with alarm {alarm}, {}", alarm.text())),
            None => failure.hint("`--help` tells what may be given"),
        }
    }
}

/// The controller's "no" to an order, be it at once or in the middle; it names what the order was about.
pub fn refused_order(order: &Order, alarm: Alarm) -> Failure {
    let failure = refused(order.row(), alarm);
    let id = order.row().id;
    let about = order.row().request().filter(|field| INSTANCES.contains(&field.key));
    let about = about.filter_map(|field| {
        let value = order.values().value(field.key)?;
        // The first robot is named by 0 as well, and then not at all.
        let is_named = field.key != Key::Robot || *value != Value::Int(0);
        is_named.then(|| format!("{} {}", field.key.name().replace('_', " "), field.show(value)))
    });
    let about: Vec<String> = about.collect();
    if about.is_empty() {
        return failure;
    }
    let named = format!("{id} ({}): alarm", about.join(", "));
    Failure { message: failure.message.replacen(&format!("{id}: alarm"), &named, 1), ..failure }
}

/// The fields that say which one of several a command is about.
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

/// The controller's "no" to a command, whatever it was about.
pub fn refused(row: &Row, alarm: Alarm) -> Failure {
    let what = match (row.risk, row.pace) {
        (Risk::Motion, Pace::Motion | Pace::Jog) => "refused or broke off",
        _ => "refused",
    };
    let remedy = match alarm.known().and_then(|known| known.remedies.first()) {
        Some(remedy) => (*remedy).to_owned(),
        None => format!("look up {alarm} in the controller's manual; `yrcx info alarm` tells where it came up"),
    };
    let way_out = WAYS_OUT.iter().find(|(_, alarms)| alarms.contains(&alarm)).map(|(way, _)| *way).unwrap_or_default();
    let kept = kept(row, "if it had begun to move, ");
    Failure::new(Kind::Refused, format!("the controller {what} {}: alarm {alarm}, {}", row.id, alarm.text()))
        .code(alarm.to_string())
        .hint(format!("{remedy}{way_out}{kept}"))
}

/// Commands that end what an alarm is about.
const WAYS_OUT: [(&str, &[Alarm]); 2] =
    [(": `yrcx io set stop=on`", &[STOP_INPUT]), ("; `yrcx recover` ends the alarm", &RECOVERABLE)];

/// Alarms of a lost link, on each fieldbus, and of an emergency stop.
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

/// What a relative motion that was stopped does when it is given again (4.2.2, 4.2.4); empty for others.
fn kept(row: &Row, condition: &str) -> String {
    if !row.keeps_target() {
        return String::new();
    }
    format!(
        "; {condition}the same command again goes on to its old target, unless the controller's \"MOVEI/DRIVEI start \
         position\" is Reset"
    )
}

/// How an order that the stop input ended leaves the robot: what is known of where it stands, and what comes next.
pub fn stopped(order: &Order, values: &Values) -> String {
    let position = match (values.axes(), order.values().int(Key::Report)) {
        (Some(axes), Some(report)) if report == Unit::Mm.report() => {
            let mm = axes.map(|steps| format!("{:.3}", f64::from(steps) / 1000.0));
            format!("; it stands at {} mm", mm.join(", "))
        }
        (Some(axes), _) => format!("; it stands at {} pulses", axes.map(|pulses| pulses.to_string()).join(", ")),
        (None, _) => String::new(),
    };
    format!("{position}{}", kept(order.row(), ""))
}

/// An exchange that ended without an answer; `stop` is how the stop input stands now, `None` while the link is down.
pub fn unanswered(label: &str, row: &Row, outcome: &Outcome, stop: Option<bool>) -> Failure {
    match outcome.ended {
        Ended::NotSent(hindrance) => not_sent(label, row, hindrance),
        Ended::NoAnswer(silence) => {
            let kind = if let Silence::Undocumented(_) = silence { Kind::Malformed } else { Kind::NoAnswer };
            Failure::new(kind, format!("{label}: no answer to {}: {}", row.id, why(silence)))
                .hint("`yrcx status` tells how the controller stands")
        }
        Ended::OutcomeUnknown(silence) => {
            let held = match (silence, stop) {
                (Silence::LinkLost, None) => "; it is still down",
                (Silence::LinkLost, Some(true)) => "; it is up again, and the stop input SI(06) is on",
                (Silence::LinkLost, Some(false)) => "; it is up again, and the stop input SI(06) is off",
                (_, Some(false)) if outcome.stop_held => "; the stop input SI(06) stays off",
                _ => "",
            };
            let message = format!(
                "{label}: {} was sent, but whether it was carried out is unknown: {}{held}",
                row.id,
                why(silence)
            );
            Failure::new(Kind::OutcomeUnknown, message).hint(telltale(row.command))
        }
        Ended::Answered(_) | Ended::Stopped => Failure::local(format!("{label}: {} ended without a report", row.id)),
    }
}

/// A remote command where the fieldbus carries signals alone.
pub fn no_commands(label: &str, row: &Row) -> Failure {
    let message = format!(
        "{label}: the fieldbus unit carries signals alone (I/O size \"Compact\"), and {} is a remote command",
        row.id
    );
    Failure::new(Kind::Rejected, message).hint(
        "set the unit's I/O size to Normal for remote commands; signals work: `yrcx status`, `yrcx io`, `yrcx run`, \
         `yrcx stop`, `yrcx recover`",
    )
}

fn not_sent(label: &str, row: &Row, hindrance: NotSentReason) -> Failure {
    let (why, hint) = match hindrance {
        NotSentReason::NoImage => (
            "the controller shows nothing".to_owned(),
            "check the link: `-v` counts what came; the sizes in the URL may be wrong (`armctl robots check`)",
        ),
        NotSentReason::LinkLost => {
            ("the link is down".to_owned(), "look at the controller; the link opens again by itself")
        }
        NotSentReason::NotReady(status) => (
            format!("the controller is not ready for a command, its status is: {status}"),
            "another command may still run; `yrcx io set stop=off` stops what moves",
        ),
        NotSentReason::Interrupted => ("interrupted".to_owned(), "nothing was done"),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {} was not sent: {why}", row.id)).hint(hint)
}

fn why(silence: Silence) -> String {
    match silence {
        Silence::LinkLost => "the link went down".to_owned(),
        Silence::NotTaken => "the controller did not take it".to_owned(),
        Silence::TooLong => "it still ran when patience was over".to_owned(),
        Silence::Vanished => "the controller stopped showing that it runs, and showed no end".to_owned(),
        Silence::Undocumented(word) => format!("the controller shows the undocumented status {word:#06x}"),
        Silence::Interrupted => "its end was not seen after the stop input went off".to_owned(),
    }
}

/// A procedure that was not carried out to its end.
pub fn unfinished(label: &str, name: &str, outcome: sequence::Outcome) -> Failure {
    use sequence::Outcome;

    let state = |on: bool| if on { "on" } else { "off" };
    match outcome {
        Outcome::NotPossible { signal, on, hint, begun } => {
            let after = if begun { ", after inputs were switched" } else { "; nothing was switched" };
            let message = format!("{name}: {} is not {}{after}", named(signal), state(on));
            Failure::new(Kind::Refused, message).hint(hint)
        }
        Outcome::TimedOut { signal, on } => {
            Failure::new(Kind::OutcomeUnknown, format!("{name}: {} did not go {} in time", named(signal), state(on)))
                .hint("`yrcx status` tells how the controller stands; --timeout sets how long to wait")
        }
        Outcome::Broken { signal } => {
            Failure::new(Kind::Refused, format!("{name}: {} came on meanwhile", named(signal)))
                .hint("`yrcx info alarm` tells which alarm it is")
        }
        Outcome::NoImage => Failure::new(Kind::NoAnswer, format!("{label}: {name}: the controller shows nothing"))
            .hint("check the link: `-v` counts what came"),
        Outcome::LinkLost { begun: false } => {
            Failure::new(Kind::NoAnswer, format!("{label}: {name}: the link went down before anything was switched"))
        }
        Outcome::LinkLost { begun: true } => {
            let message = format!("{label}: {name}: the link went down in the middle");
            Failure::new(Kind::OutcomeUnknown, message).hint("`yrcx status` tells how the controller stands")
        }
        Outcome::Done => Failure::local(format!("{label}: {name} ended without a report")),
    }
}

/// What tells whether an order was carried out whose answer was lost.
fn telltale(command: Command) -> String {
    let row = command.row();
    match (row.category(), row.pace) {
        (1, Pace::Motion | Pace::Jog) => {
            let kept = kept(row, "");
            format!("keep clear; do not send it again; `yrcx info position` tells where the robot is{kept}")
        }
        (1, Pace::Power) => "`yrcx status` tells whether servos and motor power are on".to_owned(),
        (5, _) => "keep clear; `yrcx info tasks` tells what runs".to_owned(),
        _ => match TELLTALES.iter().find(|(commands, _)| commands.contains(&command)) {
            Some((_, words)) => format!("`yrcx {words}` tells"),
            None => "`yrcx status` tells how the controller stands".to_owned(),
        },
    }
}

/// Which command reads what others write.
const TELLTALES: [(&[Command], &str); 12] = [
    (&[Command::InchAmountSet], "info inch"),
    (
        &[
            Command::Teach,
            Command::PointSet,
            Command::PointCopy,
            Command::PointAdd,
            Command::PointSub,
            Command::PointPallet,
            Command::PointElementPulse,
            Command::PointElementMm,
        ],
        "point get",
    ),
    (&[Command::SpeedManual, Command::SpeedAuto, Command::SpeedProgram], "info speed"),
    (&[Command::ArmSelect], "info arm"),
    (&[Command::CommentSet], "comment get"),
    (&[Command::PalletSet], "pallet-data get"),
    (&[Command::ShiftSet, Command::ShiftElement], "shift-data get"),
    (&[Command::HandSet], "hand-data get"),
    (
        &[
            Command::VarSet,
            Command::VarSetVar,
            Command::VarAdd,
            Command::VarAddVar,
            Command::VarSub,
            Command::VarSubVar,
            Command::VarMul,
            Command::VarMulVar,
            Command::VarDiv,
            Command::VarDivVar,
        ],
        "var get",
    ),
    (&[Command::ParamSet], "param get"),
    (&[Command::PortSet, Command::PortSetBit], "port get"),
    (&[Command::DateSet, Command::TimeSet], "clock get"),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::yrcx::alarm::INPUT_FORMAT;

    #[test]
    fn an_alarm_has_its_number_and_a_remedy() {
        let failure = refused(Command::MovePtp.row(), Alarm::new(2, 334));
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("2.334")));
        assert_eq!(failure.message, "the controller refused or broke off move-ptp: alarm 2.334, over soft limit");
        assert_eq!(failure.hint.as_deref(), Some("check the point and the soft limits"));
        let unknown = refused(Command::VarGet.row(), Alarm::new(17, 1));
        assert_eq!(unknown.message, "the controller refused var-get: alarm 17.1, motor control");
        assert!(unknown.hint.unwrap().starts_with("look up 17.1"));
        let stopped = refused(Command::JogPulse.row(), STOP_INPUT);
        assert!(stopped.message.contains("12.400") && stopped.hint.unwrap().ends_with("`yrcx io set stop=on`"));
        assert!(refused(Command::MovePtp.row(), Alarm::new(12, 551)).hint.unwrap().contains("yrcx recover"));
    }

    #[test]
    fn words_that_must_not_be_sent_are_a_mistake_of_the_command_line() {
        let error = Command::MovePtp.order().with(Key::Point, 30_000).build().unwrap_err();
        let failure = Failure::from(WordError { alarm: Some(INPUT_FORMAT), ..error });
        assert_eq!(failure.kind, Kind::Usage);
        assert_eq!(failure.message, "WI4 point: 30000 is out of range; allowed: 0 to 29999");
        assert_eq!(failure.hint.unwrap(), "the controller would refuse it with alarm 4.202, input format error");
    }

    #[test]
    fn what_changes_something_names_what_tells() {
        assert_eq!(telltale(Command::PointAdd), "`yrcx point get` tells");
        assert!(telltale(Command::MoveArch).contains("info position"));
        assert!(telltale(Command::ProgramRun).contains("info tasks"));
        assert!(telltale(Command::MotorOn).contains("motor power"));
        assert!(telltale(Command::AlarmReset).contains("status"));
    }
}

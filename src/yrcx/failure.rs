//! Conversion of client errors to command failures: what failed on which robot, and what to do. Includes the result
//! of a stop.

use super::position::Unit;
use super::refusal::relative_motion_warning;
use crate::prelude::basics::*;
use crate::refusal::refusal_failure;
use armctl_client::yrcx::{Error, StopResult};
use armctl_controller::yrcx::describe::command_summary;
use armctl_controller::yrcx::sequence;
use armctl_controller::yrcx::session::{NotSentReason, Silence};
use armctl_controller::yrcx::table::{Command, DurationClass};
use armctl_frame::session_client::session_busy;

/// Failure for an error of the client; `label` is the robot.
pub fn failure(label: &str, error: Error) -> Failure {
    let about = |kind, what: &dyn fmt::Display| Failure::new(kind, format!("{label}: {what}"));
    match error {
        Error::Refused(refusal) => refusal_failure(*refusal),
        Error::NotSent { why, .. } => about(Kind::NoAnswer, &error).hint(match why {
            NotSentReason::NoImage => {
                "check the connection: use `-v` to count received packets. The sizes in the URL may be wrong (`armctl \
                 robots check`)"
            }
            NotSentReason::LinkLost => "check the controller; armctl reopens the connection automatically",
            NotSentReason::NotReady(_) => {
                "wait, because another command may still be running; use `yrcx io set stop=off` to stop a motion"
            }
            NotSentReason::Interrupted => "repeat the command; nothing was done",
        }),
        Error::NoAnswer { why, .. } => {
            let kind = if let Silence::Undocumented(_) = why { Kind::Malformed } else { Kind::NoAnswer };
            about(kind, &error).hint("use `yrcx status` to see the state of the controller")
        }
        Error::OutcomeUnknown { command, why, stop, is_stop_held, ended } => {
            let held = match (why, stop) {
                (Silence::LinkLost, None) => match ended {
                    Some(ended) => format!("; {ended}"),
                    None => "; the connection is still down".to_owned(),
                },
                (Silence::LinkLost, Some(true)) => {
                    "; the connection is up again, and the stop input SI(06) is on".to_owned()
                }
                (Silence::LinkLost, Some(false)) => {
                    "; the connection is up again, and the stop input SI(06) is off".to_owned()
                }
                (_, Some(false)) if is_stop_held => "; the stop input SI(06) stays off".to_owned(),
                _ => String::new(),
            };
            let id = command.row().id;
            let what = format!("{id} was sent, but the result is unknown: {why}{held}");
            about(Kind::OutcomeUnknown, &what).hint(verification_hint(command))
        }
        Error::Unfinished { name, outcome } => unfinished(label, name, outcome),
        Error::EndedEarly { by, order, ended } => {
            let early_end = failure(label, *by);
            match ended {
                Ok(values) => {
                    let message = format!("{}; {STOPPED}{}", early_end.message, place(&order, &values));
                    Failure { message, ..early_end }
                }
                Err(error) => {
                    let failure = failure(label, *error);
                    Failure { message: format!("{}; {}", early_end.message, failure.message), ..failure }
                }
            }
        }
        Error::StillMoving { early_end: by } => {
            let why = by.map(|by| format!("{}; ", failure(label, *by).message)).unwrap_or_default();
            let message = format!("{why}the axis may still move: the connection to the controller is down");
            Failure::new(Kind::OutcomeUnknown, message).hint("press the emergency stop")
        }
        Error::CommandRunning { .. } => about(Kind::NoAnswer, &error).hint(
            "wait until the running command ends, because the controller executes one remote command at a time; use \
             `yrcx io set stop=off` to stop a motion",
        ),
        Error::OtherClientRunning { words } => {
            about(Kind::NoAnswer, &format!("another client's command is still running: {}", command_summary(&words)))
                .hint(
                    "wait until that command ends; use `yrcx stop` to stop a motion, and `yrcx io get` to see the \
                     state of the controller",
                )
        }
        Error::ProcedureRunning => about(Kind::NoAnswer, &error).hint("wait until the procedure ends"),
        Error::WordsNotSent => about(Kind::NoAnswer, &error).hint("use `yrcx io get SIW2` to see the current words"),
        Error::SignalsOnly { command } => {
            let id = command.row().id;
            let what = "the fieldbus unit supports only signals (I/O size \"Compact\")";
            about(Kind::Rejected, &format!("{what}, and {id} is a remote command")).hint(
                "set the unit's I/O size to Normal to use remote commands. These commands use only signals: `yrcx \
                 status`, `yrcx io`, `yrcx run`, `yrcx stop`, `yrcx recover`",
            )
        }
        Error::MonitorOnly { .. } => Failure::usage(error.to_string())
            .hint("remove `role=` from the URL; input_only and listen_only can only read signals: `yrcx io get`"),
        Error::NotHeld => Failure::usage(format!("without waiting, {error}"))
            .hint("remove --no-wait, or keep a connection open with `armctl session open` first"),
        Error::Silent => about(Kind::NoAnswer, &error).hint("check the connection: use `-v` to count received packets"),
        Error::NoImage { .. } => {
            about(Kind::Malformed, &error).hint("check the sizes in the URL: `armctl robots check`")
        }
        Error::NotAuthorized(error) => error.into(),
        Error::Session(busy) => session_busy(label, &busy),
        Error::DryRun => unknown(),
        Error::NoReport { .. } => Failure::local(format!("{label}: {error}")),
        _ => Failure::local(error.to_string()),
    }
}

/// Text for a motion that was stopped.
const STOPPED: &str = "the robot was stopped by the stop input SI(06), which is on again";

/// Describes the result of a stop.
pub fn stopped(stopped: StopResult) -> String {
    match stopped {
        StopResult::Nothing => "no motion command was sent".to_owned(),
        StopResult::Motion { order, positions } => format!("{STOPPED}{}", place(&order, &positions)),
        StopResult::Started => STOPPED.to_owned(),
        StopResult::Command(command) => format!("{} was ended", command.row().id),
        StopResult::AlreadyEnded(command, None) => format!("{} had already completed", command.row().id),
        StopResult::AlreadyEnded(command, Some(alarm)) => {
            format!("{} had already ended: alarm {alarm}, {}", command.row().id, alarm.text())
        }
    }
}

/// Describes the position, if known, after the stop input ended a command, and what to do next.
fn place(order: &Order, values: &Values) -> String {
    let position = match (values.axes(), order.values().int(Key::Report)) {
        (Some(axes), Some(report)) if report == Unit::Mm.report() => {
            let mm = axes.map(|steps| format!("{:.3}", f64::from(steps) / 1000.0));
            format!("; position: {} mm", mm.join(", "))
        }
        (Some(axes), _) => format!("; position: {} pulses", axes.map(|pulses| pulses.to_string()).join(", ")),
        (None, _) => String::new(),
    };
    format!("{position}{}", relative_motion_warning(order.row(), ""))
}

/// Failure for a procedure that did not complete.
fn unfinished(label: &str, name: &str, outcome: sequence::Outcome) -> Failure {
    use sequence::Outcome;

    let here = |kind| Failure::new(kind, format!("{name}: {outcome}"));
    let there = |kind| Failure::new(kind, format!("{label}: {name}: {outcome}"));
    match outcome {
        Outcome::NotPossible { hint, .. } => here(Kind::Refused).hint(hint),
        Outcome::TimedOut { .. } => here(Kind::OutcomeUnknown)
            .hint("use `yrcx status` to see the state of the controller; set a longer wait with --timeout"),
        Outcome::Broken { .. } => here(Kind::Refused).hint("use `yrcx info alarm` to see the alarm"),
        Outcome::NoImage => there(Kind::NoAnswer).hint("check the connection: use `-v` to count received packets"),
        Outcome::LinkLost { begun: false } => there(Kind::NoAnswer),
        Outcome::LinkLost { begun: true } => {
            there(Kind::OutcomeUnknown).hint("use `yrcx status` to see the state of the controller")
        }
        // The client never reports this outcome as an error.
        Outcome::Done => there(Kind::Local),
    }
}

/// Returns the hint for a lost answer: how to find out whether the command took effect.
fn verification_hint(command: Command) -> String {
    let row = command.row();
    match (row.category(), row.pace) {
        (1, DurationClass::Motion | DurationClass::Jog) => {
            let relative_motion_warning = relative_motion_warning(row, "");
            format!(
                "keep clear of the robot; do not send the command again; use `yrcx position` to see the position of \
                 the robot{relative_motion_warning}"
            )
        }
        (1, DurationClass::Power) => "use `yrcx status` to see whether servos and motor power are on".to_owned(),
        (5, _) => "keep clear of the robot; use `yrcx info tasks` to see the running tasks".to_owned(),
        _ => match VERIFICATION_HINTS.iter().find(|(commands, _)| commands.contains(&command)) {
            Some((_, words)) => format!("check with `yrcx {words}`"),
            None => "use `yrcx status` to see the state of the controller".to_owned(),
        },
    }
}

/// For commands that write values, the command that reads the values back.
const VERIFICATION_HINTS: [(&[Command], &str); 12] = [
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

    #[test]
    fn changes_have_a_verification_hint() {
        assert_eq!(verification_hint(Command::PointAdd), "check with `yrcx point get`");
        assert!(verification_hint(Command::MoveArch).contains("yrcx position"));
        assert!(verification_hint(Command::ProgramRun).contains("info tasks"));
        assert!(verification_hint(Command::MotorOn).contains("motor power"));
        assert!(verification_hint(Command::AlarmReset).contains("status"));
    }
}

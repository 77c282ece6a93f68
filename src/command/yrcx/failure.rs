//! Errors of the client as failures of a command: what happened to which robot, and what to do about it. How a stop went
//! is told here as well.

use std::fmt;

use super::position::Unit;
use super::refusal::kept;
use crate::client::yrcx::{Error, Stopped};
use crate::command::frame::attach::session_busy;
use crate::command::frame::dry_run::unknown;
use crate::controller::yrcx::describe::command_summary;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::sequence;
use crate::controller::yrcx::session::{NotSentReason, Silence};
use crate::controller::yrcx::table::{Command, Pace};
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::{Failure, Kind};

/// An error of the client of the robot that is called `label`.
pub fn failure(label: &str, error: Error) -> Failure {
    let about = |kind, what: &dyn fmt::Display| Failure::new(kind, format!("{label}: {what}"));
    match error {
        Error::Refused(refusal) => (*refusal).into(),
        Error::NotSent { why, .. } => about(Kind::NoAnswer, &error).hint(match why {
            NotSentReason::NoImage => {
                "check the link: `-v` counts what came; the sizes in the URL may be wrong (`armctl robots check`)"
            }
            NotSentReason::LinkLost => "look at the controller; the link opens again by itself",
            NotSentReason::NotReady(_) => "another command may still run; `yrcx io set stop=off` stops what moves",
            NotSentReason::Interrupted => "nothing was done",
        }),
        Error::NoAnswer { why, .. } => {
            let kind = if let Silence::Undocumented(_) = why { Kind::Malformed } else { Kind::NoAnswer };
            about(kind, &error).hint("`yrcx status` tells how the controller stands")
        }
        Error::OutcomeUnknown { command, why, stop, is_stop_held, ended } => {
            let held = match (why, stop) {
                (Silence::LinkLost, None) => match ended {
                    Some(ended) => format!("; {ended}"),
                    None => "; it is still down".to_owned(),
                },
                (Silence::LinkLost, Some(true)) => "; it is up again, and the stop input SI(06) is on".to_owned(),
                (Silence::LinkLost, Some(false)) => "; it is up again, and the stop input SI(06) is off".to_owned(),
                (_, Some(false)) if is_stop_held => "; the stop input SI(06) stays off".to_owned(),
                _ => String::new(),
            };
            let id = command.row().id;
            let what = format!("{id} was sent, but whether it was carried out is unknown: {why}{held}");
            about(Kind::OutcomeUnknown, &what).hint(verification_hint(command))
        }
        Error::Unfinished { name, outcome } => unfinished(label, name, outcome),
        Error::Cut { by, order, ended } => {
            let cut = failure(label, *by);
            match ended {
                Ok(values) => {
                    let message = format!("{}; {STOPPED}{}", cut.message, place(&order, &values));
                    Failure { message, ..cut }
                }
                Err(error) => {
                    let failure = failure(label, *error);
                    Failure { message: format!("{}; {}", cut.message, failure.message), ..failure }
                }
            }
        }
        Error::StillMoving { cut: by } => {
            let why = by.map(|by| format!("{}; ", failure(label, *by).message)).unwrap_or_default();
            let message = format!("{why}the axis may still move: nothing reaches the controller any more");
            Failure::new(Kind::OutcomeUnknown, message).hint("press the emergency stop")
        }
        Error::UnderWay { .. } => about(Kind::NoAnswer, &error)
            .hint("a controller carries out one remote command at a time; `yrcx io set stop=off` stops a motion"),
        Error::OthersUnderWay { words } => {
            about(Kind::NoAnswer, &format!("another client's command is still under way: {}", command_summary(&words)))
                .hint("wait for its end; `yrcx stop` stops a motion, and `yrcx io get` tells how the controller stands")
        }
        Error::SignalsUnderWay => about(Kind::NoAnswer, &error).hint("wait for the end of it"),
        Error::WordsNotSent => about(Kind::NoAnswer, &error).hint("`yrcx io get SIW2` tells what is shown"),
        Error::SignalsAlone { command } => {
            let id = command.row().id;
            let what = "the fieldbus unit carries signals alone (I/O size \"Compact\")";
            about(Kind::Rejected, &format!("{what}, and {id} is a remote command")).hint(
                "set the unit's I/O size to Normal for remote commands; signals work: `yrcx status`, `yrcx io`, \
                 `yrcx run`, `yrcx stop`, `yrcx recover`",
            )
        }
        Error::NotCommanding { .. } => Failure::usage(error.to_string())
            .hint("leave role away from the URL; input_only and listen_only see the signals alone: `yrcx io get`"),
        Error::NotHeld => Failure::usage(format!("without waiting, {error}"))
            .hint("remove --no-wait, or keep a connection open with `armctl session open` first"),
        Error::Silent => about(Kind::NoAnswer, &error).hint("check the link: `-v` counts what came"),
        Error::NoImage { .. } => {
            about(Kind::Malformed, &error).hint("check the sizes in the URL: `armctl robots check`")
        }
        Error::NotAuthorized(error) => error.into(),
        Error::Session(busy) => session_busy(label, &busy),
        Error::NotKnown => unknown(),
        Error::NoReport { .. } => Failure::local(format!("{label}: {error}")),
        _ => Failure::local(error.to_string()),
    }
}

/// Result of what was stopped.
const STOPPED: &str = "the robot was stopped by the stop input SI(06), which is on again";

/// How a stop went.
pub fn stopped(stopped: Stopped) -> String {
    match stopped {
        Stopped::Nothing => "nothing was sent that moves the robot".to_owned(),
        Stopped::Motion { order, positions } => format!("{STOPPED}{}", place(&order, &positions)),
        Stopped::Started => STOPPED.to_owned(),
        Stopped::Command(command) => format!("{} was ended", command.row().id),
        Stopped::HadEnded(command, None) => format!("{} had been carried out already", command.row().id),
        Stopped::HadEnded(command, Some(alarm)) => {
            format!("{} had ended already: alarm {alarm}, {}", command.row().id, alarm.text())
        }
    }
}

/// How an order that the stop input ended leaves the robot: what is known of where it stands, and what comes next.
fn place(order: &Order, values: &Values) -> String {
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

/// A procedure that was not carried out to its end.
fn unfinished(label: &str, name: &str, outcome: sequence::Outcome) -> Failure {
    use sequence::Outcome;

    let here = |kind| Failure::new(kind, format!("{name}: {outcome}"));
    let there = |kind| Failure::new(kind, format!("{label}: {name}: {outcome}"));
    match outcome {
        Outcome::NotPossible { hint, .. } => here(Kind::Refused).hint(hint),
        Outcome::TimedOut { .. } => here(Kind::OutcomeUnknown)
            .hint("`yrcx status` tells how the controller stands; --timeout sets how long to wait"),
        Outcome::Broken { .. } => here(Kind::Refused).hint("`yrcx info alarm` tells which alarm it is"),
        Outcome::NoImage => there(Kind::NoAnswer).hint("check the link: `-v` counts what came"),
        Outcome::LinkLost { begun: false } => there(Kind::NoAnswer),
        Outcome::LinkLost { begun: true } => {
            there(Kind::OutcomeUnknown).hint("`yrcx status` tells how the controller stands")
        }
        // The client takes it for none.
        Outcome::Done => there(Kind::Local),
    }
}

/// What tells whether an order was carried out whose answer was lost.
fn verification_hint(command: Command) -> String {
    let row = command.row();
    match (row.category(), row.pace) {
        (1, Pace::Motion | Pace::Jog) => {
            let kept = kept(row, "");
            format!("keep clear; do not send it again; `yrcx position` tells where the robot is{kept}")
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

    #[test]
    fn what_changes_something_names_what_tells() {
        assert_eq!(verification_hint(Command::PointAdd), "`yrcx point get` tells");
        assert!(verification_hint(Command::MoveArch).contains("yrcx position"));
        assert!(verification_hint(Command::ProgramRun).contains("info tasks"));
        assert!(verification_hint(Command::MotorOn).contains("motor power"));
        assert!(verification_hint(Command::AlarmReset).contains("status"));
    }
}

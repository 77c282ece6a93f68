//! Conversion of client errors to failures of a command, with robot, message and hint.

use std::io;

use super::ports;
use super::refusal;
use armctl_client::toyo::{ConnectError, Error, OpenError, Refusal, Unanswered};
use armctl_controller::toyo::layout::LayoutProblem;
use armctl_controller::toyo::request::{BlockError, Request};
use armctl_frame::dry_run::unknown;
use armctl_frame::failure::{Failure, Kind, plain};
use armctl_frame::session_client::session_busy;

/// Failure for an error of the client. `label` is the name of the robot. [`refusal::with_reason`] adds the reason for a
/// refusal.
pub fn failure(label: &str, error: Error) -> Failure {
    let about = |kind, what: String| Failure::new(kind, format!("{label}: {what}"));
    match error {
        Error::Refused(Refusal(request)) => refusal::of_question(&request),
        Error::StatusRefused => refusal::status_refused(),
        Error::PendantOn => refusal::pendant(),
        Error::NoAnswer(unanswered) => {
            let kind = if unanswered.invalid_answer.is_some() { Kind::Malformed } else { Kind::NoAnswer };
            about(kind, unanswered.to_string()).hint(silence(&unanswered))
        }
        Error::OutcomeUnknown(ref unanswered) => {
            about(Kind::OutcomeUnknown, error.to_string()).hint(verification_hint(unanswered.request.as_ref()))
        }
        Error::LostAfterSending(cause) => {
            let message = format!("{}; it is unknown whether the command was executed", failure(label, *cause).message);
            Failure::new(Kind::OutcomeUnknown, message)
                .hint("check the robot; when the connection is open again, use `toyo status`")
        }
        Error::NotSent(cause) => {
            let failure = failure(label, *cause);
            Failure { message: format!("the command was not sent: {}", failure.message), ..failure }
        }
        Error::Malformed { .. } => about(Kind::Malformed, error.to_string()).hint(
            "check baud rate and parity; use -vv to see the received bytes, and `armctl decode toyo` to explain them",
        ),
        Error::TooMuchData { .. } => about(Kind::Malformed, error.to_string())
            .hint("check for another client of the device server, and check the baud rate"),
        Error::InvalidRequest(error) => misuse(&error),
        Error::NotUndone { block, cause } => not_undone(label, &restore_failed_message(&block), cause).hint(
            "restore the setting with `toyo mode` or `toyo task`; use `toyo status` to see the state of the \
             controller",
        ),
        Error::HostNotReleased(cause) => {
            not_undone(label, "the host is still ON, because the command to switch it OFF failed", cause)
                .hint("use `toyo host off` to enable the start input again")
        }
        Error::StillMoving { .. } => not_stopped(Kind::ConditionNotMet, error.to_string()),
        Error::StopUnconfirmed(cause) => {
            let why = failure(label, *cause).message;
            not_stopped(Kind::OutcomeUnknown, format!("it is unknown whether the robot stopped: {why}"))
        }
        Error::NotAuthorized(error) => error.into(),
        Error::Session(busy) => session_busy(label, &busy),
        Error::Port { path, error } => not_open(label, &path, &error),
        Error::DeviceServer { host, port, error } => not_connected(label, &host, port, &error),
        // The cause may pass. For example, the system sets the permissions of a port only a moment after the port
        // appears.
        Error::NotReopened(cause) => Failure { kind: Kind::NoAnswer, ..failure(label, *cause) },
        Error::Opener(error) => match error.downcast_ref::<Failure>() {
            Some(failure) => failure.clone(),
            None => about(Kind::NoAnswer, error.to_string()),
        },
        Error::Io { is_shared, error } => broken(label, is_shared, &error),
        Error::DryRun => unknown(),
        // The enum can get more variants.
        _ => Failure::local(error.to_string()),
    }
}

/// Hint after a request without an answer.
fn silence(Unanswered { counters, invalid_answer, .. }: &Unanswered) -> &'static str {
    if counters.echoes > 0 {
        "check for a loop-back plug, or an RS-485 adapter without a controller: armctl received only an echo"
    } else if counters.noise > 0 || invalid_answer.is_some() {
        "check baud rate and parity: the controller uses 9600 baud, 8 data bits, even parity, 1 stop bit"
    } else {
        "check that the controller is on, and that the cable crosses TXD and RXD without handshake"
    }
}

/// Hint with the command that shows whether a command was executed.
fn verification_hint(request: Option<&Request>) -> &'static str {
    request.map_or("use `toyo status` to see the state of the controller", |request| {
        refusal::verification_hint(request.command())
    })
}

/// Message for a setting that the block `block` did not restore.
pub fn restore_failed_message(block: &str) -> String {
    format!("armctl could not undo a temporary change: {block} failed")
}

/// Failure: a change could not be undone, because the controller refused or for another cause.
fn not_undone(label: &str, what: &str, cause: Option<Box<Error>>) -> Failure {
    let (kind, why) = match cause.map(|cause| failure(label, *cause)) {
        Some(cause) => (cause.kind, cause.message),
        None => (Kind::Refused, "@NG".to_owned()),
    };
    Failure::new(kind, format!("{what}: {why}"))
}

fn not_stopped(kind: Kind, message: String) -> Failure {
    Failure::new(kind, message).hint(
        "press the emergency stop if the robot moves; after the controller answers again, use `toyo stop`, \
         or `toyo stop --jog` for a jog",
    )
}

/// Failure: the connection was lost.
fn broken(label: &str, is_shared: bool, error: &io::Error) -> Failure {
    let what = match error.kind() {
        io::ErrorKind::NotConnected if is_shared => format!("the connection is lost: {error}"),
        io::ErrorKind::NotConnected => {
            "the connection is lost: the cable was unplugged, or the other side closed the connection".to_owned()
        }
        _ => format!("the connection failed: {}", plain(error)),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {what}")).hint(if is_shared {
        "use `armctl session list` to see the state of the session"
    } else {
        "use `toyo ports` to list the serial ports"
    })
}

fn not_open(label: &str, path: &str, error: &OpenError) -> Failure {
    let (kind, what, hint) = match error {
        OpenError::Absent => (
            Kind::NoAnswer,
            format!("the port {path} does not exist"),
            "plug the adapter in; `armctl toyo ports` lists the serial ports",
        ),
        OpenError::Busy => return ports::in_use(label, path),
        OpenError::Forbidden => (Kind::Local, format!("no permission to open {path}"), OpenError::PERMISSION),
        OpenError::NotSerial => {
            (Kind::Usage, format!("{path} is not a serial port"), "use `armctl toyo ports` to list the serial ports")
        }
        OpenError::Unsupported(why) => (
            Kind::Usage,
            format!("{path} does not support these settings: {why}"),
            "use other settings in the target URL",
        ),
        OpenError::Io(error) => {
            (Kind::NoAnswer, format!("{path}: {}", plain(error)), "use `armctl toyo ports` to list the serial ports")
        }
    };
    Failure::new(kind, format!("{label}: {what}")).hint(hint)
}

fn not_connected(label: &str, host: &str, port: u16, error: &ConnectError) -> Failure {
    let (what, hint) = match error {
        ConnectError::NotFound => {
            (format!("cannot find host '{host}'"), "check the name, or use the address of the device server")
        }
        ConnectError::Refused => (
            format!("nothing listens on TCP port {port}"),
            "check the port, and that the device server passes bytes unchanged (raw TCP)",
        ),
        ConnectError::Unreachable => {
            ("the host cannot be reached".to_owned(), "check the address and the network settings of this computer")
        }
        ConnectError::TimedOut => (
            "the device server does not answer".to_owned(),
            "check the address of the device server, and check that the device server is on",
        ),
        ConnectError::Io(error) => (plain(error), "check the network"),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {what}")).hint(hint)
}

/// Failure: the values on the command line cannot be sent.
pub fn wrong(error: &LayoutProblem) -> Failure {
    Failure::usage(error.to_string()).hint("use `--help` to see the valid values")
}

/// Failure: the request cannot be sent.
pub fn misuse(error: &BlockError) -> Failure {
    Failure::usage(error.to_string()).hint("use `--help` to see the valid values")
}

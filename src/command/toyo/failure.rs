//! Errors of the client as failures of a command: what happened to which robot, and what to do about it.

use std::io;

use super::ports;
use super::refusal;
use crate::client::toyo::{ConnectError, Error, OpenError, Refusal, Unanswered};
use crate::command::frame::attach::session_busy;
use crate::command::frame::dry_run::unknown;
use crate::controller::toyo::layout::LayoutProblem;
use crate::controller::toyo::request::{BlockError, Request};
use crate::failure::{Failure, Kind, plain};

/// An error of the client of the robot that is called `label`. Why something was refused, [`refusal::explained`] finds out.
pub fn failure(label: &str, error: Error) -> Failure {
    let about = |kind, what: String| Failure::new(kind, format!("{label}: {what}"));
    match error {
        Error::Refused(Refusal(request)) => refusal::of_question(&request),
        Error::Mute => refusal::mute(),
        Error::PendantOn => refusal::pendant(),
        Error::NoAnswer(unanswered) => {
            let kind = if unanswered.unfitting.is_some() { Kind::Malformed } else { Kind::NoAnswer };
            about(kind, unanswered.to_string()).hint(silence(&unanswered))
        }
        Error::OutcomeUnknown(ref unanswered) => {
            about(Kind::OutcomeUnknown, error.to_string()).hint(verification_hint(unanswered.request.as_ref()))
        }
        Error::CutShort(cause) => {
            let message = format!("{}; whether the order was carried out is unknown", failure(label, *cause).message);
            Failure::new(Kind::OutcomeUnknown, message)
                .hint("look at the robot; once the line is back, `toyo status` tells")
        }
        Error::NotSent(cause) => {
            let failure = failure(label, *cause);
            Failure { message: format!("the order was not sent: {}", failure.message), ..failure }
        }
        Error::Malformed { .. } => about(Kind::Malformed, error.to_string())
            .hint("check baud rate and parity; -vv shows what came, `armctl decode toyo` explains it"),
        Error::Flooded { .. } => about(Kind::Malformed, error.to_string()).hint(
            "something on this line sends without end: another client of the device server, or a wrong baud rate",
        ),
        Error::Unsendable(error) => misuse(&error),
        Error::NotPutBack { block, cause } => not_undone(label, &not_put_back(&block), cause)
            .hint("`toyo mode` and `toyo task` set it; `toyo status` tells how the controller stands"),
        Error::HostKept(cause) => {
            not_undone(label, "the host was switched ON and could not be switched OFF again", cause)
                .hint("`toyo host off` gives the start input back")
        }
        Error::MovesOn { .. } => not_stopped(Kind::ConditionNotMet, error.to_string()),
        Error::StandUnseen(cause) => {
            let why = failure(label, *cause).message;
            not_stopped(Kind::OutcomeUnknown, format!("nothing tells that it stands: {why}"))
        }
        Error::NotAuthorized(error) => error.into(),
        Error::Session(busy) => session_busy(label, &busy),
        Error::Port { path, error } => not_open(label, &path, &error),
        Error::DeviceServer { host, port, error } => not_connected(label, &host, port, &error),
        // Whatever is in the way, such as rights that a port gets a moment after it is there: it may pass.
        Error::NotReopened(cause) => Failure { kind: Kind::NoAnswer, ..failure(label, *cause) },
        Error::Opener(error) => match error.downcast_ref::<Failure>() {
            Some(failure) => failure.clone(),
            None => about(Kind::NoAnswer, error.to_string()),
        },
        Error::Io { is_shared, error } => broken(label, is_shared, &error),
        Error::DryRun => unknown(),
        _ => about(Kind::Malformed, error.to_string()),
    }
}

/// What to look at where nothing answers.
fn silence(Unanswered { counters, unfitting, .. }: &Unanswered) -> &'static str {
    if counters.echoes > 0 {
        "a loop-back plug, or an RS-485 adapter that hears itself and no controller"
    } else if counters.noise > 0 || unfitting.is_some() {
        "check baud rate and parity: the controller has 9600 baud, 8 data bits, even parity, 1 stop bit"
    } else {
        "check that the controller is on, and the cable: TXD and RXD cross over, there is no handshake"
    }
}

/// What tells whether an order was carried out.
fn verification_hint(request: Option<&Request>) -> &'static str {
    request.map_or("`toyo status` tells how the controller stands", |request| {
        refusal::verification_hint(request.command())
    })
}

/// That something was not put back by a block.
pub fn not_put_back(block: &str) -> String {
    format!("what was changed for a while was not put back by {block}")
}

/// What was not undone, as the controller refused or for another cause.
fn not_undone(label: &str, what: &str, cause: Option<Box<Error>>) -> Failure {
    let (kind, why) = match cause.map(|cause| failure(label, *cause)) {
        Some(cause) => (cause.kind, cause.message),
        None => (Kind::Refused, "@NG".to_owned()),
    };
    Failure::new(kind, format!("{what}: {why}"))
}

fn not_stopped(kind: Kind, message: String) -> Failure {
    Failure::new(kind, message).hint(
        "press the emergency stop if anything moves; once the controller answers again, `toyo stop` stops a program, \
         `toyo stop --jog` an axis that was jogged",
    )
}

/// The line has bad news.
fn broken(label: &str, is_shared: bool, error: &io::Error) -> Failure {
    let what = match error.kind() {
        io::ErrorKind::NotConnected if is_shared => format!("the line is gone: {error}"),
        io::ErrorKind::NotConnected => "the line is gone: unplugged, or closed by the other side".to_owned(),
        _ => format!("the line is broken: {}", plain(error)),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {what}")).hint(if is_shared {
        "`armctl session list` tells how it stands"
    } else {
        "`toyo ports` lists the ports there are"
    })
}

fn not_open(label: &str, path: &str, error: &OpenError) -> Failure {
    let (kind, what, hint) = match error {
        OpenError::Absent => (
            Kind::NoAnswer,
            format!("there is no port {path}"),
            "plug the adapter in; `armctl toyo ports` lists the ports there are",
        ),
        OpenError::Busy => return ports::in_use(label, path),
        OpenError::Forbidden => (
            Kind::Local,
            format!("this user may not open {path}"),
            "add the user to the group of the port, mostly dialout (`sudo usermod -aG dialout $USER`), and log in again",
        ),
        OpenError::NotSerial => {
            (Kind::Usage, format!("{path} is not a serial port"), "`armctl toyo ports` lists the ports there are")
        }
        OpenError::Unsupported(why) => {
            (Kind::Usage, format!("{path} does not take these settings: {why}"), "choose others in the target URL")
        }
        OpenError::Io(error) => {
            (Kind::NoAnswer, format!("{path}: {}", plain(error)), "`armctl toyo ports` lists the ports there are")
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
            "check the port, and that the device server passes bytes on as they are (raw TCP)",
        ),
        ConnectError::Unreachable => {
            ("the host cannot be reached".to_owned(), "check the address and this machine's own network settings")
        }
        ConnectError::TimedOut => {
            ("the device server does not answer".to_owned(), "check that it is on, and its address")
        }
        ConnectError::Io(error) => (plain(error), "check the network"),
    };
    Failure::new(Kind::NoAnswer, format!("{label}: {what}")).hint(hint)
}

/// Values that cannot be sent, as a failure of the command line.
pub fn wrong(error: &LayoutProblem) -> Failure {
    Failure::usage(error.to_string()).hint("`--help` tells what may be given")
}

/// A request that cannot be sent.
pub fn misuse(error: &BlockError) -> Failure {
    Failure::usage(error.to_string()).hint("`--help` tells what may be given")
}

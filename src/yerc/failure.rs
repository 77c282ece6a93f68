//! Conversion of client errors to command failures. A failure contains what failed, on which robot, and what to do.

use std::io;

use crate::prelude::basics::*;
use armctl_client::yerc::{Error, Refusal};
use armctl_controller::yerc::status;
use armctl_frame::failure::plain;
use armctl_frame::session_client::session_busy;

/// Failure for an error of the client. `label` is the name of the robot.
pub fn failure(label: &str, error: Error) -> Failure {
    let about = |kind, what: String| Failure::new(kind, format!("{label}: {what}"));
    let error_text = error.to_string();
    match error {
        Error::Refused(refusal) => refusal_failure(refusal),
        Error::NoAnswer { .. } => about(Kind::NoAnswer, error.to_string()).hint(
            "check address, cable and firewall; on the controller, check the Ethernet server function, RS022, RS029 \
             and #82015 CMD REMOTE SEL; see `armctl help yerc-setup` for the settings",
        ),
        Error::Garbage { .. } => about(Kind::Malformed, error.to_string())
            .hint("check that the address belongs to a high-speed Ethernet server; use -vvv to see the bytes"),
        Error::Unexpected(_) => about(Kind::Malformed, error.to_string())
            .hint("check the model (?model=fs100, dx100, dx200 or yrc1000); use -vvv to see the bytes"),
        Error::OutcomeUnknown { request, waited, counters } => {
            let is_seen = if counters.heard_something() { format!(" ({counters})") } else { String::new() };
            let what =
                format!("the request was sent once, with no answer within {waited:?}{is_seen}: the result is unknown");
            about(Kind::OutcomeUnknown, what)
                .hint(format!("check before you repeat the command: {}", verification_hint(&request)))
        }
        Error::Unconfirmed { .. } => about(Kind::OutcomeUnknown, error_text).hint(
            "use the pendant or the emergency stop if the robot must not move; use `yerc status` to see whether the \
             robot is held",
        ),
        Error::CutShort { request, cause } => {
            let cause = failure(label, *cause).message;
            let message = format!("{cause}; the request was sent, and the result is unknown");
            Failure::new(Kind::OutcomeUnknown, message)
                .hint(format!("check before you repeat the command: {}", verification_hint(&request)))
        }
        Error::NotAuthorized(error) => error.into(),
        Error::Session(busy) => session_busy(label, &busy),
        Error::HostNotFound { .. } => {
            about(Kind::NoAnswer, error.to_string()).hint("check the name, or use the address of the controller")
        }
        Error::Io { port, error } => broken_link(label, port, &error),
        Error::ModelRefused(refusal) => {
            let failure = refusal_failure(refusal);
            let message = format!("{error_text}; the request depends on the model and was not sent");
            Failure { message: format!("{label}: {message}"), ..failure }.hint(NAME_MODEL)
        }
        Error::UnknownSoftware { .. } => {
            about(Kind::Malformed, format!("{error_text}; the request depends on the model and was not sent"))
                .hint(NAME_MODEL)
        }
        Error::AnotherModel { .. } => {
            about(Kind::Refused, error_text).hint("repeat the command: armctl now uses the right model")
        }
        Error::DryRun => unknown(),
        _ => about(Kind::Malformed, error.to_string()).hint("use -vvv to see the bytes"),
    }
}

/// Hint for a controller that does not report its model.
const NAME_MODEL: &str =
    "set the model: ?model=fs100, dx100, dx200 or yrc1000 in the URL, or `armctl robots set NAME model=…`";

/// Failure for a socket error.
fn broken_link(label: &str, port: Option<u16>, error: &io::Error) -> Failure {
    use io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable};

    let port = port.map_or_else(|| "of the session".to_owned(), |port| port.to_string());
    let about = |what: String| Failure::new(Kind::NoAnswer, format!("{label}: {what}"));
    match error.kind() {
        ConnectionRefused => about(format!("nothing listens on UDP port {port}")).hint(
            "check the port and the Ethernet server function of the controller: the host answers, but the server does \
             not",
        ),
        HostUnreachable | NetworkUnreachable => about(format!("the host cannot be reached: {}", plain(error)))
            .hint("check the address and the network settings of this computer"),
        _ => about(format!("UDP port {port}: {}", plain(error))).hint("check the network of this computer"),
    }
}

/// Command with which the user can check whether a request took effect.
fn verification_hint(request: &Request) -> &'static str {
    match request.command {
        0 => "use `yerc file list` to see the files",
        0x78 | 0x300 => "use `yerc io get` to see the signals",
        0x79 | 0x301 => "use `yerc register get` to see the registers",
        0x7A..=0x81 | 0x8C | 0x302..=0x309 | 0x30C => "use `yerc var get` to see the variables",
        0x82 => "use `yerc alarm list` and `yerc status` to see the alarm state",
        0x83 | 0x84 => "use `yerc status` to see the state",
        0x85 => "read the display of the pendant; it is safe to send the message again",
        0x86 => "use `yerc status` and `yerc job show` to see whether the job runs",
        0x87 => "use `yerc job show` to see the job",
        0x8A | 0x8B => "keep clear of the robot; use `yerc status` and `yerc position` to see motion and position",
        _ => "use `yerc status` to see the state of the controller",
    }
}

/// Failure for a refusal of a request with this risk. A motion may be in progress although the request was refused: the
/// network can duplicate a request, and the controller then refuses the second copy during the motion of the first
/// copy.
pub fn refused(refusal: Refusal, risk: Risk) -> Failure {
    let failure = refusal_failure(refusal);
    match &failure.hint {
        Some(hint) if risk == Risk::Motion && refusal.status.added == MOVING => {
            let hint = format!(
                "{hint}\nIf the robot did not move before, this request may have started the motion: the network may \
                 have duplicated the request, and the controller refused only the second copy"
            );
            failure.hint(hint)
        }
        _ => failure,
    }
}

/// Added status for "manipulator moving" (DX 5).
const MOVING: u32 = 0x2010;

/// Failure for a refusal, with its cause and the remedy from the manual.
pub fn refusal_failure(Refusal { status, to }: Refusal) -> Failure {
    let explanation = status::explain(status);
    Failure::new(Kind::Refused, format!("the controller refused {to}: {}. {}", explanation.name, explanation.cause))
        .hint(explanation.remedy.into_owned())
        .code(explanation.code_text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_client::yerc::RefusedRequest;
    use armctl_controller::yerc::wire::Status;

    #[test]
    fn refusal_during_motion_hints_at_the_running_motion() {
        let to = RefusedRequest::Robot { command: 0x8B, instance: 1 };
        let hint = |added, risk| refused(Refusal { status: Status::refused(added), to }, risk).hint.unwrap();
        assert!(hint(0x2010, Risk::Motion).contains("duplicated the request"));
        assert!(!hint(0x2060, Risk::Motion).contains("duplicated"));
        assert!(!hint(0x2010, Risk::Write).contains("duplicated"));
    }

    #[test]
    fn refusal_names_the_request() {
        let message = |to| refusal_failure(Refusal { status: Status::refused(0xA001), to }).message;
        let robot = message(RefusedRequest::from(&Request {
            command: 0x7A,
            instance: 300,
            attribute: 1,
            service: 0x0E,
            data: Vec::new(),
        }));
        assert!(robot.starts_with("the controller refused 0x7A (instance 300): "), "{robot}");
        let file = message(RefusedRequest::from(&Request::file(0x16, *b"A.JBI")));
        assert!(file.starts_with("the controller refused file service 0x16: "), "{file}");
    }
}

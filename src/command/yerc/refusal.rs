//! A controller's "no" as a failure of a command.

use std::fmt;

use crate::controller::Risk;
use crate::controller::yerc::request::Request;
use crate::controller::yerc::status;
use crate::controller::yerc::wire::{Division, Status};
use crate::failure::{Failure, Kind};

/// A controller's "no".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refusal {
    /// Why.
    pub status: Status,
    /// To what.
    pub to: Asked,
}

/// What a controller said no to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Asked {
    /// A request to the robot server.
    Robot {
        /// Its command number.
        command: u16,
        /// Which of the things the command addresses.
        instance: u16,
    },
    /// A request to the file server, by its service.
    File(u8),
}

impl From<&Request> for Asked {
    fn from(request: &Request) -> Self {
        match request.division() {
            Division::Robot => Self::Robot { command: request.command, instance: request.instance },
            Division::File => Self::File(request.service),
        }
    }
}

impl fmt::Display for Asked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Robot { command, instance } => write!(f, "0x{command:02X} (instance {instance})"),
            Self::File(service) => write!(f, "file service 0x{service:02X}"),
        }
    }
}

impl Refusal {
    /// Of a request to the file server.
    pub const fn of_file(service: u8, status: Status) -> Self {
        Self { status, to: Asked::File(service) }
    }

    /// The refusal of something so risky. A motion that is refused because the robot moves may be moving it: the
    /// network can double an order, and then the second copy meets the motion of the first.
    pub fn of(self, risk: Risk) -> Failure {
        let failure = Failure::from(self);
        match &failure.hint {
            Some(hint) if risk == Risk::Motion && self.status.added == MOVING => {
                let hint = format!(
                    "{hint}\nIf it stood still before, this order itself may be what moves it: then the network \
                     doubled the order, and only the second copy was refused"
                );
                failure.hint(hint)
            }
            _ => failure,
        }
    }
}

/// Added status: the manipulator moves (DX 5).
const MOVING: u32 = 0x2010;

impl From<Refusal> for Failure {
    fn from(Refusal { status, to }: Refusal) -> Self {
        let explanation = status::explain(status);
        Failure::new(Kind::Refused, format!("the controller refused {to}: {}. {}", explanation.name, explanation.cause))
            .hint(explanation.remedy.into_owned())
            .code(explanation.code_text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_that_is_refused_for_motion_may_be_that_motion() {
        let to = Asked::Robot { command: 0x8B, instance: 1 };
        let hint = |added, risk| Refusal { status: Status::refused(added), to }.of(risk).hint.unwrap();
        assert!(hint(0x2010, Risk::Motion).contains("doubled the order"));
        assert!(!hint(0x2010, Risk::Write).contains("doubled"));
        assert!(!hint(0x2060, Risk::Motion).contains("doubled"));
    }

    #[test]
    fn a_refusal_names_the_request() {
        let message = |to| Failure::from(Refusal { status: Status::refused(0xA001), to }).message;
        let robot = message(Asked::from(&Request {
            command: 0x7A,
            instance: 300,
            attribute: 1,
            service: 0x0E,
            data: Vec::new(),
        }));
        assert!(robot.starts_with("the controller refused 0x7A (instance 300): "), "{robot}");
        let file = message(Asked::from(&Request::file(0x16, *b"A.JBI")));
        assert!(file.starts_with("the controller refused file service 0x16: "), "{file}");
    }
}

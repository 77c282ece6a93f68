//! A controller's "no" as a failure of a command.

use crate::controller::Risk;
use crate::controller::yerc::status;
use crate::controller::yerc::wire::Status;
use crate::failure::{Failure, Kind};

/// A controller's "no".
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Refusal(pub Status);

impl Refusal {
    /// The refusal of something so risky. A motion that is refused because the robot moves may be moving it: the
    /// network can double an order, and then the second copy meets the motion of the first.
    pub fn of(self, risk: Risk) -> Failure {
        let failure = Failure::from(self);
        match &failure.hint {
            Some(hint) if risk == Risk::Motion && self.0.added == MOVING => {
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
    fn from(Refusal(status): Refusal) -> Self {
        let explanation = status::explain(status);
        Failure::new(Kind::Refused, format!("the controller refused: {}. {}", explanation.name, explanation.cause))
            .hint(explanation.remedy.into_owned())
            .code(explanation.code_text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_that_is_refused_for_motion_may_be_that_motion() {
        let hint = |added, risk| Refusal(Status::refused(added)).of(risk).hint.unwrap();
        assert!(hint(0x2010, Risk::Motion).contains("doubled the order"));
        assert!(!hint(0x2010, Risk::Write).contains("doubled"));
        assert!(!hint(0x2060, Risk::Motion).contains("doubled"));
    }
}

//! Why there is no answer, or none that makes sense, in words.

use std::io;

use super::Link;
use crate::controller::Risk;
use crate::controller::toyo::layout::LayoutProblem;
use crate::controller::toyo::request::BlockError;
use crate::controller::toyo::session::Ended;
use crate::failure::{Failure, Kind, plain};

impl Link {
    /// An answer that makes no sense.
    pub fn malformed(&self, block: &str, why: &str) -> Failure {
        Failure::new(Kind::Malformed, format!("{}: unexpected answer '{block}': {why}", self.label))
            .hint("check baud rate and parity; -vv shows what came, `armctl decode toyo` explains it")
    }

    /// No answer, or none that fits.
    pub(super) fn unanswered(&self, ended: Ended, risk: Risk, telltale: &str) -> Failure {
        let counters = self.line.counters();
        let (kind, what) = match ended {
            Ended::Unfitting { block, why } => (Kind::Malformed, format!("unexpected answer '{block}': {why}")),
            _ if counters.received == counters.echoes && counters.echoes > 0 => {
                (Kind::NoAnswer, "only what was sent came back".to_owned())
            }
            _ if counters.received == 0 && counters.noise > 0 => {
                (Kind::NoAnswer, format!("no answer, but {} stray characters", counters.noise))
            }
            _ => (Kind::NoAnswer, format!("no answer within {:.1?}", self.policy.timeout)),
        };
        let failure = Failure::new(kind, format!("{}: {what}", self.label));
        if risk > Risk::Read {
            let message =
                format!("{}: the order was sent, but whether it was carried out is unknown: {what}", self.label);
            return Failure { kind: Kind::OutcomeUnknown, message, ..failure }.hint(telltale);
        }
        failure.hint(if counters.echoes > 0 {
            "a loop-back plug, or an RS-485 adapter that hears itself and no controller"
        } else if counters.noise > 0 || kind == Kind::Malformed {
            "check baud rate and parity: the controller has 9600 baud, 8 data bits, even parity, 1 stop bit"
        } else {
            "check that the controller is on, and the cable: TXD and RXD cross over, there is no handshake"
        })
    }

    /// The line has bad news.
    pub(super) fn broken(&mut self, error: &io::Error, is_open: bool) -> Failure {
        self.is_gone = true;
        let what = match error.kind() {
            io::ErrorKind::NotConnected if self.is_shared() => format!("the line is gone: {error}"),
            io::ErrorKind::NotConnected => "the line is gone: unplugged, or closed by the other side".to_owned(),
            _ => format!("the line is broken: {}", plain(error)),
        };
        if is_open {
            let message = format!("{}: {what}; whether the order was carried out is unknown", self.label);
            return Failure::new(Kind::OutcomeUnknown, message)
                .hint("look at the robot; once the line is back, `toyo status` tells");
        }
        Failure::new(Kind::NoAnswer, format!("{}: {what}", self.label)).hint(if self.is_shared() {
            "`armctl session list` tells how it stands"
        } else {
            "`toyo ports` lists the ports there are"
        })
    }
}

/// Values that cannot be sent, as a failure of the command line.
pub fn wrong(error: &LayoutProblem) -> Failure {
    Failure::usage(error.to_string()).hint("`--help` tells what may be given")
}

/// A request that cannot be sent.
pub fn misuse(error: &BlockError) -> Failure {
    Failure::usage(error.to_string()).hint("`--help` tells what may be given")
}

//! What can go wrong between a client and a controller, and a controller's "no".

use armctl_controller::yrcx::alarm::Alarm;
use armctl_controller::yrcx::image::Words;
use armctl_controller::yrcx::order::Order;
use armctl_controller::yrcx::sequence;
use armctl_controller::yrcx::session::{NotSentReason, Silence};
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Values;
use armctl_transport::image::LinkError;
use armctl_transport::session::client::SessionBusy;
use thiserror::Error;

use crate::NotAuthorized;

/// Why there is no answer, or none to go on with.
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller said no, at once or in the middle.
    #[error(transparent)]
    Refused(#[from] Box<Refusal>),
    /// A command did not leave. Nothing was done.
    #[error("{} was not sent: {why}", .command.row().id)]
    NotSent {
        /// Which command.
        command: Command,
        /// What was in the way.
        why: NotSentReason,
    },
    /// Nobody answered a command that may be given again without harm.
    #[error("no answer to {}: {why}", .command.row().id)]
    NoAnswer {
        /// Which command.
        command: Command,
        /// What was seen instead.
        why: Silence,
    },
    /// Nobody confirmed a command that changes something: it may or may not have been carried out, or still be under way.
    /// It was given once.
    #[error("{} was sent, and may or may not have been done: {why}", .command.row().id)]
    OutcomeUnknown {
        /// Which command.
        command: Command,
        /// What was seen instead.
        why: Silence,
        /// How the stop input SI(06) is shown now; `None` while the link is down.
        stop: Option<bool>,
        /// Whether it was left off, because the end of a motion was not seen.
        is_stop_held: bool,
        /// Why the session has ended that held the link, if it has.
        ended: Option<String>,
    },
    /// Signals were not switched to the end.
    #[error("{name}: {outcome}")]
    Unfinished {
        /// The name of the procedure.
        name: &'static str,
        /// What happened.
        outcome: sequence::Outcome,
    },
    /// A jog was ended before its time.
    #[error("{by}; the jog was ended for that")]
    Cut {
        /// What ended it.
        by: Box<Error>,
        /// The jog.
        order: Box<Order>,
        /// Where the robot stands, or what went wrong in stopping it.
        ended: Result<Values, Box<Self>>,
    },
    /// A jog was not seen to end, and nothing reaches the controller any more: the axis may still move.
    #[error("the axis may still move: nothing reaches the controller any more")]
    StillMoving {
        /// What ended the jog before its time.
        cut: Option<Box<Error>>,
    },
    /// A remote command of this client, which goes on by itself, has not ended yet; the controller takes one at a time.
    #[error("{} is still under way", .command.row().id)]
    UnderWay {
        /// Which command.
        command: Command,
    },
    /// A remote command that another client of the same session left to itself has not ended yet.
    #[error("another client's command is still under way")]
    OthersUnderWay {
        /// WI0 to WI15 of it.
        words: Box<Words>,
    },
    /// A procedure is under way already.
    #[error("other signals are being switched")]
    SignalsUnderWay,
    /// Words did not leave in time.
    #[error("the words did not leave")]
    WordsNotSent,
    /// The fieldbus carries signals alone, without the words of remote commands.
    #[error("{} is a remote command, and the fieldbus carries signals alone", .command.row().id)]
    SignalsAlone {
        /// Which command.
        command: Command,
    },
    /// The client only sees what the controller shows ([`Options::commands`](super::Options::commands)).
    #[error("{what} needs a connection that commands the controller")]
    NotCommanding {
        /// What would have been done.
        what: String,
    },
    /// The connection ends with the client, and so would what shall go on ([`Options::is_held`](super::Options::is_held)).
    #[error("the connection would end now, and the controller stop the robot")]
    NotHeld,
    /// The link is there, but the controller shows nothing.
    #[error("the controller shows nothing")]
    Silent,
    /// The controller shows what is no image.
    #[error("the controller shows {bytes} bytes, fewer than an image")]
    NoImage {
        /// So many bytes.
        bytes: usize,
    },
    /// The link cannot do what it should.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// More than the client was granted.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session that holds the link has ended, or somebody else has the link.
    #[error("{0}")]
    Session(SessionBusy),
    /// A dry run sends nothing, and so has no answer.
    #[error("a dry run has no answer")]
    NotKnown,
    /// A fault of this client: what ended has no outcome.
    #[error("{what} ended without a report")]
    NoReport {
        /// The command or the procedure.
        what: &'static str,
    },
}

/// A controller's "no".
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the controller refused {}: alarm {alarm}, {}", .order.row().id, .alarm.text())]
pub struct Refusal {
    /// To what.
    pub order: Order,
    /// Why.
    pub alarm: Alarm,
    /// Where the robot is, after a jog that was stopped (4.2.6).
    pub positions: Values,
}

#[cfg(test)]
mod tests {
    use armctl_controller::yrcx::alarm::STOP_INPUT;
    use armctl_controller::yrcx::signal::output;

    use super::*;

    #[test]
    fn errors_are_a_sentence() {
        let order = Command::AlarmReset.order().build().unwrap();
        let refusal = Refusal { order, alarm: STOP_INPUT, positions: Values::default() };
        let refused = Error::from(Box::new(refusal));
        assert!(refused.to_string().starts_with("the controller refused alarm-reset: alarm 12.400, "), "{refused}");
        let lost = Error::OutcomeUnknown {
            command: Command::MovePtp,
            why: Silence::LinkLost,
            stop: None,
            is_stop_held: false,
            ended: None,
        };
        assert_eq!(lost.to_string(), "move-ptp was sent, and may or may not have been done: the link went down");
        let outcome = sequence::Outcome::Broken { signal: output::ALARM };
        let broken = Error::Unfinished { name: "run", outcome };
        assert_eq!(broken.to_string(), "run: alarm (SO(03)) came on meanwhile");
        let busy = Error::Session(SessionBusy::Busy(None));
        assert_eq!(busy.to_string(), "the line is in use by another client");
    }
}

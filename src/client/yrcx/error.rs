//! Errors of a client, and the refusal of a controller.

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

/// Why a request has no usable answer.
///
/// ```
/// use armctl_client::yrcx::{Client, Command, Error, Key, Options, Refusal, Start};
/// use armctl_client::Risk;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let start = Start::parse("mode = \"manual\"\nservo = false")?;
/// let mut robot = Client::simulated(start, Options::default().with_risk(Risk::Motion)).await?;
/// let go = Command::MovePtp.order().with(Key::Point, 1).with(Key::SpeedPercent, 10).build()?;
/// match robot.ask(&go).await {
///     Err(Error::Refused(refusal)) => {
///         let Refusal { alarm, .. } = *refusal;
///         println!("refused: {}.{}: {}", alarm.group, alarm.category, alarm.text());
///     }
///     Err(Error::OutcomeUnknown { why, .. }) => println!("{why}: the robot may move"),
///     other => println!("{other:?}"),
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone, Error)]
#[non_exhaustive]
pub enum Error {
    /// The controller refused, at the start or during execution.
    #[error(transparent)]
    Refused(#[from] Box<Refusal>),
    /// A command was not sent, so the controller did nothing.
    #[error("{} was not sent: {why}", .command.row().id)]
    NotSent {
        /// The command.
        command: Command,
        /// The reason.
        why: NotSentReason,
    },
    /// No answer to a command. The command can be repeated without harm.
    #[error("no answer to {}: {why}", .command.row().id)]
    NoAnswer {
        /// The command.
        command: Command,
        /// What was observed instead.
        why: Silence,
    },
    /// No confirmation of a command that changes something. The controller may or may not have carried out the command,
    /// or may still execute it. The command was sent once.
    #[error("{} was sent, and may or may not have been carried out: {why}", .command.row().id)]
    OutcomeUnknown {
        /// The command.
        command: Command,
        /// What was observed instead.
        why: Silence,
        /// Current state of the stop input SI(06); `None` while the link is down.
        stop: Option<bool>,
        /// Whether the client left the stop input off, because it did not observe the end of a motion.
        is_stop_held: bool,
        /// Why the session ended; `None` if the session has not ended, or if there is no session.
        ended: Option<String>,
    },
    /// A signal procedure was not completed.
    #[error("{name}: {outcome}")]
    Unfinished {
        /// Name of the procedure.
        name: &'static str,
        /// Outcome of the procedure.
        outcome: sequence::Outcome,
    },
    /// A jog ended early.
    #[error("{by}; armctl stopped the jog for this reason")]
    EndedEarly {
        /// The cause.
        by: Box<Error>,
        /// The jog command.
        order: Box<Order>,
        /// Final position, or the error of the stop.
        ended: Result<Values, Box<Self>>,
    },
    /// The link was lost before the client observed the end of a jog: the axis may still move.
    #[error("the axis may still move: armctl cannot reach the controller any longer")]
    StillMoving {
        /// The cause, if the jog ended early.
        early_end: Option<Box<Error>>,
    },
    /// An earlier command of this client is still running; the controller executes one command at a time.
    #[error("{} still runs", .command.row().id)]
    CommandRunning {
        /// The command.
        command: Command,
    },
    /// An earlier command of another client of the session is still running.
    #[error("a command of another client still runs")]
    OtherClientRunning {
        /// Words WI0 to WI15 of the other client's command.
        words: Box<Words>,
    },
    /// Another signal procedure is still running.
    #[error("another procedure is switching signals")]
    ProcedureRunning,
    /// The words were not sent within the time limit.
    #[error("the words were not sent in time")]
    WordsNotSent,
    /// The fieldbus carries only signals, not the words of remote commands.
    #[error("{} is a remote command, but this fieldbus connection carries only signals", .command.row().id)]
    SignalsOnly {
        /// The command.
        command: Command,
    },
    /// A monitoring client cannot send commands to the controller ([`Options::commands`](super::Options::commands)).
    #[error("{what} needs a connection that commands the controller")]
    MonitorOnly {
        /// The refused action.
        what: String,
    },
    /// Without a session, the connection ends when the client ends, and the controller then stops the robot
    /// ([`Options::is_held`](super::Options::is_held)).
    #[error("the connection ends with this command, and the controller would then stop the robot")]
    NotHeld,
    /// The link is up, but the controller sends no data.
    #[error("the controller sends no data")]
    Silent,
    /// The data of the controller is too short for an input image.
    #[error("the controller sends {bytes} bytes, too few for an image")]
    NoImage {
        /// Bytes received.
        bytes: usize,
    },
    /// An error of the link.
    #[error(transparent)]
    Link(#[from] LinkError),
    /// The risk of the request is higher than the authorized risk. Nothing was sent.
    #[error(transparent)]
    NotAuthorized(#[from] NotAuthorized),
    /// The session on the link has ended, or another client uses the link.
    #[error("{0}")]
    Session(SessionBusy),
    /// A dry run sends nothing and has no answer.
    #[error("a dry run has no answer")]
    DryRun,
    /// An internal error: an exchange ended without an outcome.
    #[error("internal error: {what} ended without a result")]
    NoReport {
        /// The command or procedure.
        what: &'static str,
    },
}

/// A refusal of a controller.
///
/// Example: [`enum@Error`]
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the controller refused {}: alarm {alarm}, {}", .order.row().id, .alarm.text())]
pub struct Refusal {
    /// The refused order.
    pub order: Order,
    /// The alarm.
    pub alarm: Alarm,
    /// Final position after a jog that was stopped (4.2.6).
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
        assert_eq!(
            lost.to_string(),
            "move-ptp was sent, and may or may not have been carried out: the connection was lost"
        );
        let outcome = sequence::Outcome::Broken { signal: output::ALARM };
        let line_error = Error::Unfinished { name: "run", outcome };
        assert_eq!(line_error.to_string(), "run: alarm (SO(03)) switched on during the procedure");
        let busy = Error::Session(SessionBusy::Busy(None));
        assert_eq!(busy.to_string(), "another client uses the connection");
    }
}

//! A line of a REPL or batch that contains a command.

use std::cell::RefCell;
use std::rc::Rc;

use super::connection::{Access, ConnectMode};
use super::session_manager::{HeldBy, SessionManager};
use crate::output::envelope::Envelope;
use crate::prelude::basics::*;
use crate::settings::Sessions;
use crate::settings::rehearsal::Rehearsals;

/// Context of a line in a REPL or batch.
#[derive(Debug, Clone)]
pub struct Line {
    /// Line as the user typed it, for other clients that wait for the robot.
    pub typed: Arc<str>,
    /// Manager of the links that stay open between lines.
    pub manager: SessionManager,
    /// Source location of the line in a batch.
    pub origin: Option<Origin>,
    /// Collects envelopes, if they are not written to stdout.
    pub results: Option<Rc<RefCell<Vec<Value>>>>,
    /// Records of the robots, if the line is rehearsed.
    pub rehearsal: Option<Rehearsals>,
}

/// Source location of a batch line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// File name; `-` for stdin.
    pub file: Arc<str>,
    /// Line number, starting with 1.
    pub line: usize,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = if &*self.file == "-" { "stdin" } else { &self.file };
        write!(f, "{file}:{}", self.line)
    }
}

impl Line {
    /// Opens the link to a robot for later lines.
    pub async fn hold(&self, robot: &Robot, trace: Option<&Path>, screen: &Screen) -> Result<()> {
        let trace = trace.map(Path::to_owned);
        let access = Access { trace, ..Access::reading(ConnectMode::Control) };
        self.connect(robot, access, screen).await.map(|_| ())
    }

    /// Opens the link for later lines if the command needs a link. The link to a simulator is always kept open, because
    /// the simulator exists only as long as its link. Returns the access for the command.
    pub async fn connect(&self, robot: &Robot, access: Access, screen: &Screen) -> Result<Access> {
        let access = Access { typed: Some(Arc::clone(&self.typed)), ..access };
        let needs_link = access.mode == ConnectMode::Control || robot.target.value.is_simulated();
        if !needs_link || robot.sessions == Sessions::None {
            return Ok(access);
        }
        // Some families record the trace in the process that has the link. Other families record the trace in each
        // line.
        let trace = access.trace.clone().filter(|path| path.as_os_str() != "-");
        let holding = Access { trace, mode: ConnectMode::Control, ..access.clone() };
        Ok(match self.manager.hold(robot, &holding, screen).await? {
            HeldBy::ThisProcess(session) => {
                let trace = access.trace.clone().filter(|_| !session.records || holding.trace.is_none());
                Access { trace, session: Some(session), ..access }
            }
            // Without a session, the simulator would forget everything at the end of the line.
            HeldBy::None(why) if robot.rehearsal.is_some() => return Err(why),
            HeldBy::OtherProcess | HeldBy::None(_) => access,
        })
    }

    /// Adds the source location to an envelope.
    pub fn marked(&self, envelope: Envelope) -> Envelope {
        match &self.origin {
            Some(Origin { file, line }) => Envelope { file: Some(file.to_string()), line: Some(*line), ..envelope },
            None => envelope,
        }
    }

    /// Stores the envelope if all envelopes are written at the end. Otherwise returns it, so that it is written now.
    pub fn stop_passing(&self, value: Value) -> Option<Value> {
        let Some(results) = &self.results else { return Some(value) };
        match value {
            Value::Array(values) => results.borrow_mut().extend(values),
            value => results.borrow_mut().push(value),
        }
        None
    }
}

//! A command line that is one of several in this process: of a REPL, or of a batch.

use std::cell::RefCell;
use std::fmt;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;

use serde_json::Value;

use super::connection::{Access, ConnectMode};
use super::session_manager::{By, SessionManager};
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::envelope::Envelope;
use crate::settings::Robot;

/// What such a line has that a single one has not.
#[derive(Debug, Clone)]
pub struct Line {
    /// As it was typed, for others who want the same robot.
    pub typed: Arc<str>,
    /// Who keeps links open from one line to the next.
    pub manager: SessionManager,
    /// Where it stands.
    pub origin: Option<Origin>,
    /// Where its envelopes go instead of stdout.
    pub results: Option<Rc<RefCell<Vec<Value>>>>,
}

/// Where a line of a batch stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Origin {
    /// The file, `-` for stdin.
    pub file: Arc<str>,
    /// Its line, from 1.
    pub line: usize,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = if &*self.file == "-" { "stdin" } else { &self.file };
        write!(f, "{file}:{}", self.line)
    }
}

impl Line {
    /// Has the link to a robot held from now on.
    pub async fn hold(&self, robot: &Robot, trace: Option<&Path>, screen: &Screen) -> Result<(), Failure> {
        let trace = trace.map(Path::to_owned);
        let access = Access { trace, ..Access::reading(ConnectMode::Control) };
        self.connecting(robot, access, screen).await.map(|_| ())
    }

    /// Has the link to a robot held if the command wants one, so that it stays open for the next line; simulators always,
    /// as they live no longer than their link. Says how the command is to connect.
    pub async fn connecting(&self, robot: &Robot, access: Access, screen: &Screen) -> Result<Access, Failure> {
        let access = Access { typed: Some(Arc::clone(&self.typed)), ..access };
        if access.mode != ConnectMode::Control && !robot.target.value.is_simulated() {
            return Ok(access);
        }
        // Some families record where the link is held, others in each line.
        let trace = access.trace.clone().filter(|path| path.as_os_str() != "-");
        let holding = Access { trace, mode: ConnectMode::Control, ..access.clone() };
        let is_traced = self.manager.hold(robot, &holding, screen).await? == By::This { records: true };
        Ok(Access { trace: access.trace.clone().filter(|_| !is_traced), ..access })
    }

    /// The envelope with where the line stands.
    pub fn marked(&self, envelope: Envelope) -> Envelope {
        match &self.origin {
            Some(Origin { file, line }) => Envelope { file: Some(file.to_string()), line: Some(*line), ..envelope },
            None => envelope,
        }
    }

    /// Keeps envelopes if they are wanted all at once. What is to be written now, if anything.
    pub fn pass(&self, value: Value) -> Option<Value> {
        let Some(results) = &self.results else { return Some(value) };
        match value {
            Value::Array(values) => results.borrow_mut().extend(values),
            value => results.borrow_mut().push(value),
        }
        None
    }
}

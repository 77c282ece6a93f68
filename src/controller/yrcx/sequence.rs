//! Execution of signal procedures. It keeps the minimum interval between edges of dedicated inputs, and waits for
//! confirmation by outputs (chapter 1, section 3).

use std::fmt;
use std::time::Duration;

use super::image::{Image, Output};
use super::procedure::{Procedure, Step};
use super::session::{ImageSession, Next, edge_due};
use super::signal::Signal;
use crate::Now;

/// Outcome of a procedure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// All steps were done and confirmed.
    Done,
    /// An output does not have the required state.
    NotPossible {
        /// The output.
        signal: Signal,
        /// Required state.
        on: bool,
        /// Hint for the user: what to do about the state of the output.
        hint: &'static str,
        /// Whether the procedure had already switched an input.
        begun: bool,
    },
    /// An output did not reach the expected state in time.
    TimedOut {
        /// The output.
        signal: Signal,
        /// Expected state.
        on: bool,
    },
    /// The output that aborts the procedure switched on.
    Broken {
        /// The output.
        signal: Signal,
    },
    /// No image was received.
    NoImage,
    /// The link was lost.
    LinkLost {
        /// Whether the procedure may already have switched an input.
        begun: bool,
    },
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let state = |on: bool| if on { "on" } else { "off" };
        match *self {
            Self::Done => f.write_str("done"),
            Self::NotPossible { signal, on, begun, .. } => {
                let after = if begun { ", after inputs were switched" } else { "; nothing was switched" };
                write!(f, "{} is not {}{after}", signal.named(), state(on))
            }
            Self::TimedOut { signal, on } => write!(f, "{} did not switch {} in time", signal.named(), state(on)),
            Self::Broken { signal } => write!(f, "{} switched on during the procedure", signal.named()),
            Self::NoImage => f.write_str("the controller sends no data"),
            Self::LinkLost { begun: false } => f.write_str("the connection was lost before the first switch"),
            Self::LinkLost { begun: true } => f.write_str("the connection was lost during the procedure"),
        }
    }
}

/// A running procedure.
#[derive(Debug, Clone)]
pub struct Sequence {
    procedure: Procedure,
    patience: Duration,
    /// Maximum total duration. The field below is the start time.
    longest: Duration,
    began: Option<Now>,
    at: usize,
    since: Option<Now>,
    input: Option<Image>,
    linked: bool,
    begun: bool,
    /// Input that the procedure pulses and that is still on. If the procedure fails, the session must switch this input
    /// off.
    raised: Option<Signal>,
    outcome: Option<Outcome>,
}

/// Result of a step.
enum Advance {
    Next,
    Wait(Option<Now>),
    End(Outcome),
}

impl Sequence {
    /// Creates a session for `procedure`. The session waits at most `patience` for each output.
    pub fn new(procedure: Procedure, patience: Duration) -> Self {
        Self {
            procedure,
            patience,
            longest: Duration::MAX,
            began: None,
            at: 0,
            since: None,
            input: None,
            linked: true,
            begun: false,
            raised: None,
            outcome: None,
        }
    }

    /// Limits the total duration.
    #[must_use]
    pub fn within(self, longest: Duration) -> Self {
        Self { longest, ..self }
    }

    /// The current step; `None` at the end of the procedure.
    pub fn step(&self) -> Option<Step> {
        self.procedure.steps.get(self.at).copied()
    }

    /// Switches an input after the minimum interval between edges. The step is done when the change was sent.
    fn switch(&mut self, now: Now, output: &mut Output, signal: Signal, on: bool) -> Advance {
        if signal.is_on(&output.next) != on {
            if let Some(due) = edge_due(now, output, signal) {
                return Advance::Wait(Some(due));
            }
            signal.set(&mut output.next, on);
            self.begun = true;
        }
        match output.last_sent() {
            Some(sent) if signal.is_on(sent) == on => Advance::Next,
            _ => Advance::Wait(None),
        }
    }

    fn advance(&mut self, now: Now, output: &mut Output, step: Step) -> Advance {
        match step {
            Step::Set { signal, on } => {
                let advance = self.switch(now, output, signal, on);
                if matches!(advance, Advance::Next) && !on && self.raised == Some(signal) {
                    self.raised = None;
                }
                advance
            }
            Step::Rise(signal) => {
                if self.raised != Some(signal) {
                    match self.switch(now, output, signal, false) {
                        Advance::Next => {}
                        other => return other,
                    }
                    if let Some(due) = edge_due(now, output, signal) {
                        return Advance::Wait(Some(due));
                    }
                    self.raised = Some(signal);
                }
                self.switch(now, output, signal, true)
            }
            Step::Require { signal, on, hint } => match self.input {
                Some(image) if signal.is_on(&image) == on => Advance::Next,
                Some(_) => Advance::End(Outcome::NotPossible { signal, on, hint, begun: self.begun }),
                None => Advance::Wait(None),
            },
            Step::Await { signal, on } => match self.input {
                Some(image) if signal.is_on(&image) == on => Advance::Next,
                Some(image) => match self.procedure.breaks_on {
                    Some(breaks) if breaks.is_on(&image) => Advance::End(Outcome::Broken { signal: breaks }),
                    _ => Advance::Wait(None),
                },
                None => Advance::Wait(None),
            },
        }
    }

    fn timed_out(&self, step: Step) -> Outcome {
        match step {
            Step::Await { signal, on } if self.input.is_some() => Outcome::TimedOut { signal, on },
            _ => Outcome::NoImage,
        }
    }

    /// Ends the procedure. An input that is being pulsed is switched off.
    fn end(&mut self, output: &mut Output, outcome: Outcome) {
        if let Some(signal) = self.raised.take() {
            signal.set(&mut output.next, false);
        }
        self.outcome = Some(outcome);
    }
}

impl ImageSession for Sequence {
    type Outcome = Outcome;

    fn poll(&mut self, now: Now, output: &mut Output) -> Next<Outcome> {
        while self.outcome.is_none() {
            let since = *self.since.get_or_insert(now);
            let Some(step) = self.step() else {
                self.end(output, Outcome::Done);
                break;
            };
            if !self.linked {
                let begun = self.begun;
                self.end(output, Outcome::LinkLost { begun });
                break;
            }
            let end = self.began.get_or_insert(now).saturating_add(self.longest);
            let deadline = since.saturating_add(self.patience).min(end);
            match self.advance(now, output, step) {
                Advance::Next => {
                    self.at += 1;
                    self.since = None;
                }
                Advance::Wait(_) if now >= deadline => {
                    let outcome = self.timed_out(step);
                    self.end(output, outcome);
                }
                Advance::Wait(due) => return Next::Wait(due.map_or(deadline, |due| due.min(deadline))),
                Advance::End(outcome) => self.end(output, outcome),
            }
        }
        match self.outcome {
            Some(outcome) => Next::Done(outcome),
            None => Next::Wait(now),
        }
    }

    fn handle(&mut self, _now: Now, input: &Image) {
        if self.linked {
            self.input = Some(*input);
        }
    }

    fn handle_link_loss(&mut self, _now: Now) {
        self.linked = false;
    }
}

#[cfg(test)]
mod tests;

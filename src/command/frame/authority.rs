//! Asks for a yes where the gate wants one, before a command begins and while it runs.

use std::sync::{Mutex, PoisonError};

use super::interrupt::{catch_interrupts, interruptible};
use crate::controller::Risk;
use crate::failure::{Failure, Kind};
use crate::gate::{Change, Confirmation, Gate, Grant, Intent, unasked};
use crate::output::Screen;
use crate::settings::Robot;

/// Lets a command through to `robot`, asking where the contract wants it before anything is sent.
pub async fn pass(gate: Gate, screen: &Screen, robot: &Robot, intent: &Intent) -> Result<(), Failure> {
    if !gate.must_ask(screen, robot, intent)? {
        return Ok(());
    }
    let question = match intent.confirmation {
        Confirmation::Word(word) => Question::Word(format!("This will {}.", intent.text), word),
        Confirmation::Question => Question::Yes(format!("This will {}. Continue?", intent.text)),
        Confirmation::WhenKnown => return Ok(()),
    };
    ask(screen, robot, Vec::new(), question, "nothing was sent").await
}

/// What a command may still be let through for while it runs.
#[derive(Debug, Clone)]
pub struct Authority<'a> {
    gate: Gate,
    screen: &'a Screen,
    robot: &'a Robot,
    /// The most that the command said it does.
    most: Risk,
    grant: Grant,
}

impl<'a> Authority<'a> {
    /// For a command that said it does no more than `most`.
    pub fn new(gate: Gate, screen: &'a Screen, robot: &'a Robot, most: Risk, grant: Grant) -> Self {
        Self { gate, screen, robot, most, grant }
    }

    /// For what only looks.
    pub fn reading(screen: &'a Screen, robot: &'a Robot) -> Self {
        Self::new(Gate::default(), screen, robot, Risk::Read, Grant::of(Risk::Read))
    }

    /// For a part of the work on another screen.
    #[must_use]
    pub fn clone_for<'b>(&self, screen: &'b Screen, robot: &'b Robot) -> Authority<'b> {
        Authority { gate: self.gate, screen, robot, most: self.most, grant: self.grant.clone() }
    }

    /// Whether a person is asked before a change: then time passes, in which others may change something.
    pub fn asks(&self) -> bool {
        self.gate.needs_yes(self.robot, self.most) && self.grant.get() < self.most
    }

    /// Asks whether `change` shall be made, and lets it through. Nothing has been changed so far; what changes nothing
    /// that a person wrote or taught is let through without a question.
    pub async fn confirm(&self, change: &Change) -> Result<(), Failure> {
        let risk = self.most;
        if !change.is_empty() && self.asks() {
            let text = change.in_a_line();
            if !self.screen.can_ask() {
                return Err(unasked(self.robot, risk, &text));
            }
            let question = Question::Yes("Continue?".to_owned());
            ask(self.screen, self.robot, change.lines(), question, "nothing was changed").await?;
        }
        self.grant.raise(risk);
        Ok(())
    }
}

/// What is asked.
enum Question {
    Yes(String),
    /// What will happen, and the word to type.
    Word(String, &'static str),
}

/// Who asks.
static TURN: Mutex<()> = Mutex::new(());

/// Asks on a thread of its own, so that Ctrl-C is heard meanwhile. `otherwise` is how things are after a no.
async fn ask(
    screen: &Screen,
    robot: &Robot,
    lines: Vec<String>,
    question: Question,
    otherwise: &str,
) -> Result<(), Failure> {
    // From here on Ctrl-C, at the question too, ends in a message and an exit code instead of a killed process.
    catch_interrupts();
    let screen = *screen;
    let who = format!("{} ({}, {})", robot.name, robot.family, robot.target.value.url());
    let asked = tokio::task::spawn_blocking(move || {
        // Several robots may have something to ask: one after the other.
        let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        screen.ask_title("REAL CONTROLLER:", &who);
        for line in &lines {
            screen.ask_note(line);
        }
        match question {
            Question::Yes(question) => screen.confirm(&question),
            Question::Word(what, word) => screen.confirm_word(&what, word),
        }
    });
    match interruptible(asked).await {
        Ok(Ok(Ok(true))) => Ok(()),
        Ok(Ok(Ok(false))) => Err(Failure::new(Kind::Rejected, format!("not confirmed; {otherwise}"))),
        Ok(Ok(Err(failure))) => Err(failure),
        Ok(Err(error)) => Err(Failure::local(format!("confirmation prompt failed: {error}"))),
        Err(failure) => {
            screen.ask_note("");
            Err(Failure { message: format!("{}; {otherwise}", failure.message), ..failure })
        }
    }
}

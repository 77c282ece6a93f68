//! Confirmation questions, before a command starts and while the command runs.

use std::sync::{Mutex, PoisonError};

use super::interrupt::{catch_interrupts, interruptible};
use crate::gate::{Gate, Grant, Intent, not_confirmed};
use crate::prelude::basics::*;

/// Authorizes a command for `robot` before anything is sent. Asks the user if the risk requires it.
pub async fn confirm_intent(gate: Gate, screen: &Screen, robot: &Robot, intent: &Intent) -> Result<()> {
    let asks = gate.must_ask(screen, robot, intent)?;
    if let Some(rehearsal) = &robot.rehearsal {
        let is_known = intent.confirmation != Confirmation::WhenKnown;
        if is_known && intent.risk >= Risk::Destroy && !gate.dry_run {
            rehearsal.ask(intent.text.clone(), gate.yes);
        }
        return Ok(());
    }
    if !asks {
        return Ok(());
    }
    let question = match intent.confirmation {
        Confirmation::Word(word) => Question::Word(format!("This will {}.", intent.text), word),
        Confirmation::Question => Question::Yes(format!("This will {}. Continue?", intent.text)),
        Confirmation::WhenKnown => return Ok(()),
    };
    ask(screen, robot, Vec::new(), question, "nothing was sent").await
}

/// Authority with which a running command confirms changes.
#[derive(Debug, Clone)]
pub struct Confirmer<'a> {
    gate: Gate,
    screen: &'a Screen,
    robot: &'a Robot,
    /// Maximum risk that the command declares.
    granted: Risk,
    grant: Grant,
}

impl<'a> Confirmer<'a> {
    /// Authority for a command with this maximum risk.
    pub fn new(gate: Gate, screen: &'a Screen, robot: &'a Robot, granted: Risk, grant: Grant) -> Self {
        Self { gate, screen, robot, granted, grant }
    }

    /// Authority for a read-only command.
    pub fn reading(screen: &'a Screen, robot: &'a Robot) -> Self {
        Self::new(Gate::default(), screen, robot, Risk::Read, Grant::up_to(Risk::Read))
    }

    /// Whether the user is asked before a change. While the question is open, other clients may change data.
    pub fn asks_user(&self) -> bool {
        self.gate.needs_yes(self.robot, self.granted) && self.grant.get() < self.granted
    }

    /// Confirms `change`. The command must not have changed the controller before this call. A change that overwrites
    /// no user data needs no question.
    pub async fn confirm(&self, change: &Change) -> Result<()> {
        let risk = self.granted;
        let is_open = !change.is_empty() && risk >= Risk::Destroy && self.grant.get() < risk;
        if let Some(rehearsal) = self.robot.rehearsal.as_ref().filter(|_| is_open && !self.gate.dry_run) {
            rehearsal.ask(change.format_line(), self.gate.yes);
        } else if !change.is_empty() && self.asks_user() {
            let text = change.format_line();
            if !self.screen.can_ask() {
                return Err(not_confirmed(self.robot, risk, &text));
            }
            let question = Question::Yes("Continue?".to_owned());
            ask(self.screen, self.robot, change.lines(), question, "the command changed nothing").await?;
        }
        self.grant.raise(risk);
        Ok(())
    }
}

/// Question to the user, and how the user confirms.
enum Question {
    Yes(String),
    /// Description, and the word that the user must type.
    Word(String, &'static str),
}

/// Only one question is asked at a time.
static QUESTION_LOCK: Mutex<()> = Mutex::new(());

/// Asks in a separate thread, so that Ctrl-C is handled. `otherwise` describes the state after the answer `no`.
async fn ask(screen: &Screen, robot: &Robot, lines: Vec<String>, question: Question, otherwise: &str) -> Result<()> {
    // From now on, Ctrl-C (also at the question) ends the command with a message and an exit code. It does not kill the
    // process.
    catch_interrupts();
    let screen = *screen;
    let who = format!("{} ({}, {})", robot.name, robot.family, robot.target.value.url());
    let asked = tokio::task::spawn_blocking(move || {
        // Questions for several robots are asked one after another.
        let _turn = QUESTION_LOCK.lock().unwrap_or_else(PoisonError::into_inner);
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

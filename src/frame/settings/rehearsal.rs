//! Record of a rehearsal: commands that run on simulators of a backup instead of robots.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

use schemars::JsonSchema;
use serde::Serialize;

use armctl_controller::simulator::run_options::{MotionLog, RunOptions, Speed};

/// Records of all robots, by name. Only these robots can be selected.
pub type Rehearsals = Arc<BTreeMap<String, Rehearsal>>;

/// Record of one robot. The run adds to it.
#[derive(Debug, Clone, Default)]
pub struct Rehearsal {
    speed: Speed,
    /// Motions of the simulator.
    pub motions: MotionLog,
    questions: Arc<Mutex<Vec<Question>>>,
}

/// A confirmation that a command needs on a robot.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Question {
    /// Text that completes "This will …".
    pub text: String,
    /// Whether `--yes` confirmed it. Otherwise the command asks at a terminal, and is rejected without one.
    pub confirmed_by_yes: bool,
}

impl Rehearsal {
    /// A new record for a simulator with this speed.
    pub fn new(speed: Speed) -> Self {
        Self { speed, ..Self::default() }
    }

    /// Options of the simulator.
    pub fn simulator_options(&self) -> RunOptions {
        RunOptions { speed: self.speed, motions: Some(self.motions.clone()) }
    }

    /// Adds a confirmation. The rehearsal continues as if the user had confirmed it.
    pub fn ask(&self, text: String, confirmed_by_yes: bool) {
        let mut questions = self.questions.lock().unwrap_or_else(PoisonError::into_inner);
        questions.push(Question { text, confirmed_by_yes });
    }

    /// Removes and returns the confirmations since the last call.
    pub fn take_questions(&self) -> Vec<Question> {
        std::mem::take(&mut *self.questions.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Two records are equal if they are the same record.
impl PartialEq for Rehearsal {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.questions, &other.questions)
    }
}

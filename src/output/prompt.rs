//! Questions to a person, on stderr.

use dialoguer::Input;

use super::Screen;
use crate::failure::{Failure, Kind};

impl Screen {
    /// Says what a question is about, even under `--quiet`.
    pub fn ask_note(&self, text: &str) {
        Self::stderr(&format!("{}\n", super::escape::lines(text)));
    }

    /// Asks `question` and takes yes or no; an empty answer is no.
    pub fn confirm(&self, question: &str) -> Result<bool, Failure> {
        let prompt = format!("{question} [y/N]");
        let answer: String = ask(Input::new().with_prompt(prompt).allow_empty(true))?;
        Ok(matches!(answer.trim().to_lowercase().as_str(), "y" | "yes"))
    }

    /// Asks for a word that must be typed as shown.
    pub fn confirm_word(&self, question: &str, word: &str) -> Result<bool, Failure> {
        let prompt = format!("{question} Type '{word}' to go on");
        let answer: String = ask(Input::new().with_prompt(prompt).allow_empty(true))?;
        Ok(answer.trim() == word)
    }
}

fn ask(input: Input<'_, String>) -> Result<String, Failure> {
    input.interact_text().map_err(|dialoguer::Error::IO(error)| match error.kind() {
        std::io::ErrorKind::Interrupted => Failure::new(Kind::Interrupted, "nothing was sent"),
        std::io::ErrorKind::NotConnected | std::io::ErrorKind::UnexpectedEof => {
            Failure::new(Kind::RefusedHere, "not confirmed").hint("answer the question, or use --yes")
        }
        _ => Failure::io("prompt", &error),
    })
}

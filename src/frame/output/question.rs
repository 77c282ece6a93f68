//! Questions whose answer is a line, a choice, or yes or no. They change the terminal settings. After an interruption,
//! the caller must call [`Screen::give_back`].

use std::fmt;
use std::io;

use dialoguer::console::Term;
use dialoguer::theme::Theme;
use dialoguer::{Confirm, Error, FuzzySelect, Input, Select};

use super::{Screen, escape, prompt};
use crate::failure::{Failure, Kind};

/// Maximum number of visible lines of a list.
const MAX_ROWS: usize = 12;

/// Theme of questions: plain text.
struct Plain;

impl Theme for Plain {
    fn format_prompt(&self, f: &mut dyn fmt::Write, prompt: &str) -> fmt::Result {
        f.write_str(prompt)
    }
}

impl Screen {
    /// Asks for a line. For an empty line, returns `usual`; without `usual`, asks again.
    pub fn ask_line(&self, question: &str, usual: Option<&str>) -> Result<String, Failure> {
        let question = escape::line(question);
        let input = Input::<String>::with_theme(&Plain).with_prompt(question);
        let input = match usual {
            Some(usual) => input.default(usual.to_owned()),
            None => input,
        };
        answer_of(|term| input.interact_text_on(term)).map(|line| line.trim().to_owned())
    }

    /// Asks for one entry of a list. The first entry is preselected. Returns the index of the entry.
    pub fn ask_choice(&self, question: &str, options: &[String]) -> Result<usize, Failure> {
        let select = Select::with_theme(&Plain).with_prompt(escape::line(question)).items(self.lines(options));
        let select = select.default(0).max_length(MAX_ROWS);
        answer_of(|term| select.interact_on_opt(term))?.ok_or_else(remaining)
    }

    /// Asks for one entry of a long list. The user can type a search text. The first entry is preselected only with
    /// `has_first`.
    pub fn ask_one_of(&self, question: &str, options: &[String], has_first: bool) -> Result<usize, Failure> {
        let select = FuzzySelect::with_theme(&Plain).with_prompt(escape::line(question)).items(self.lines(options));
        let select = if has_first { select.default(0) } else { select };
        answer_of(|term| select.max_length(MAX_ROWS).interact_on_opt(term))?.ok_or_else(remaining)
    }

    /// Asks for yes or no. `usual` is the result for an empty answer.
    pub fn ask_yes(&self, question: &str, usual: bool) -> Result<bool, Failure> {
        let confirm = Confirm::with_theme(&Plain).with_prompt(escape::line(question)).default(usual);
        answer_of(|term| confirm.wait_for_newline(true).interact_on_opt(term))?.ok_or_else(remaining)
    }

    /// Restores the terminal after a question was interrupted.
    pub fn give_back(&self) {
        Self::stderr("\x1b[?25h\r\n");
        prompt::restore();
    }

    /// Escapes the options, and shortens each to one line.
    fn lines(&self, options: &[String]) -> Vec<String> {
        let room = usize::from(self.width()).saturating_sub(4);
        options.iter().map(|option| escape::line(option).chars().take(room).collect()).collect()
    }
}

fn answer_of<T>(ask: impl FnOnce(&Term) -> Result<T, Error>) -> Result<T, Failure> {
    prompt::save();
    ask(&Term::stderr()).map_err(|Error::IO(error)| match error.kind() {
        // There is no terminal.
        io::ErrorKind::NotConnected => {
            Failure::new(Kind::Rejected, "no answer").hint("answer the question at a terminal")
        }
        // The user pressed Ctrl-C, or the terminal was closed and the signal has not arrived yet.
        _ => remaining(),
    })
}

/// Returns the failure after Esc or Ctrl-C.
fn remaining() -> Failure {
    Failure::new(Kind::Interrupted, "the question has no answer")
}

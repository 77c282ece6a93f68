//! Questions to a person, on stderr.

use std::io::BufRead as _;
#[cfg(unix)]
use std::sync::{Mutex, PoisonError};

use super::Screen;
use crate::failure::{Failure, Kind};

impl Screen {
    /// Says whom a question is about, with a word that nobody overlooks.
    pub fn ask_title(&self, word: &str, whom: &str) {
        Self::prose(&format!("{} {}\n", self.paint_stderr("1;31", word), super::escape::lines(whom)));
    }

    /// Says what a question is about, even under `--quiet`.
    pub fn ask_note(&self, text: &str) {
        Self::prose(&format!("{}\n", super::escape::lines(text)));
    }

    /// Asks `question` and takes yes or no; an empty answer is no. The terminal stays as it is, so that whatever ends the
    /// process leaves nothing behind.
    pub fn confirm(&self, question: &str) -> Result<bool, Failure> {
        Self::ask(&format!("{question} [y/N]")).map(|answer| is_yes(&answer))
    }

    /// Says what will happen, and goes on if the answer is `word`.
    pub fn confirm_word(&self, what: &str, word: &str) -> Result<bool, Failure> {
        Self::ask(&format!("{what} Type '{word}' to go on:")).map(|answer| answer.trim_ascii() == word.as_bytes())
    }

    pub(super) fn ask(question: &str) -> Result<Vec<u8>, Failure> {
        Self::prose(&format!("{} ", super::escape::line(question)));
        let mut answer = Vec::new();
        // A terminal that cannot be read any more, as it was closed, gives no answer either.
        if std::io::stdin().lock().read_until(b'\n', &mut answer).unwrap_or(0) == 0 {
            Self::stderr("\n");
            return Err(Failure::new(Kind::Rejected, "not confirmed: there was no answer; nothing was sent")
                .hint("answer the question, or use --yes"));
        }
        Ok(answer)
    }
}

/// The settings of the terminal that lines are typed at.
#[cfg(unix)]
static FOUND: Mutex<Option<rustix::termios::Termios>> = Mutex::new(None);

/// Takes note of how the terminal is set, before an editor of lines changes it.
#[cfg(unix)]
pub fn save() {
    *FOUND.lock().unwrap_or_else(PoisonError::into_inner) = rustix::termios::tcgetattr(std::io::stdin()).ok();
}

/// Sets the terminal as it was when it was noted, if it was.
#[cfg(unix)]
pub fn restore() {
    use rustix::termios::{LocalModes, tcgetattr};

    if let Some(found) = &*FOUND.lock().unwrap_or_else(PoisonError::into_inner) {
        // Whoever takes keys one by one has the terminal mark what is pasted, too.
        if tcgetattr(std::io::stdin()).is_ok_and(|now| !now.local_modes.contains(LocalModes::ICANON)) {
            Screen::stderr("\x1b[?2004l");
        }
        // A terminal that is gone needs no settings.
        let _ = rustix::termios::tcsetattr(std::io::stdin(), rustix::termios::OptionalActions::Now, found);
    }
}

/// The editor has its own way here.
#[cfg(not(unix))]
pub fn save() {}

/// There is nothing to restore.
#[cfg(not(unix))]
pub fn restore() {}

fn is_yes(answer: &[u8]) -> bool {
    let answer = answer.trim_ascii();
    answer.eq_ignore_ascii_case(b"y") || answer.eq_ignore_ascii_case(b"yes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_yes_is_yes() {
        for yes in ["y\n", "Y", " yes\r\n", "YES"] {
            assert!(is_yes(yes.as_bytes()), "{yes:?}");
        }
        for no in ["", "\n", "n", "ye", "yess", "y y", "\x1b[Ay", "ja"] {
            assert!(!is_yes(no.as_bytes()), "{no:?}");
        }
        assert!(!is_yes(b"\xff\n"));
    }
}

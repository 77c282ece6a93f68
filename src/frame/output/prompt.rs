//! Questions for confirmation on stderr.

use std::io::BufRead as _;
#[cfg(unix)]
use std::sync::{Mutex, PoisonError};

use super::Screen;
use crate::failure::{Failure, Kind};

impl Screen {
    /// Prints the robot to which a question applies, with a highlighted word.
    pub fn ask_title(&self, word: &str, whom: &str) {
        Self::prose(&format!("{} {}\n", self.paint_stderr("1;31", word), super::escape::lines(whom)));
    }

    /// Prints what a question is about, even with `--quiet`.
    pub fn ask_note(&self, text: &str) {
        Self::prose(&format!("{}\n", super::escape::lines(text)));
    }

    /// Asks a yes/no question. An empty answer means `no`. The terminal settings are not changed, so nothing must be
    /// restored afterwards.
    pub fn confirm(&self, question: &str) -> Result<bool, Failure> {
        Self::ask(&format!("{question} [y/N]")).map(|answer| is_yes(&answer))
    }

    /// Prints the effect of a command, and asks the user to type `word`.
    pub fn confirm_word(&self, what: &str, word: &str) -> Result<bool, Failure> {
        Self::ask(&format!("{what} Type '{word}' to continue:")).map(|answer| answer.trim_ascii() == word.as_bytes())
    }

    pub(super) fn ask(question: &str) -> Result<Vec<u8>, Failure> {
        Self::prose(&format!("{} ", super::escape::line(question)));
        let mut answer = Vec::new();
        // Without an answer, for example from a closed terminal, nothing is confirmed.
        if std::io::stdin().lock().read_until(b'\n', &mut answer).unwrap_or(0) == 0 {
            Self::stderr("\n");
            return Err(Failure::new(Kind::Rejected, "not confirmed: no answer; nothing was sent")
                .hint("answer the question, or use --yes"));
        }
        Ok(answer)
    }
}

/// The saved terminal settings.
#[cfg(unix)]
static SAVED_MODES: Mutex<Option<rustix::termios::Termios>> = Mutex::new(None);

/// Saves the terminal settings before a line editor changes them.
#[cfg(unix)]
pub fn save() {
    *SAVED_MODES.lock().unwrap_or_else(PoisonError::into_inner) = rustix::termios::tcgetattr(std::io::stdin()).ok();
}

/// Restores the saved terminal settings.
#[cfg(unix)]
pub fn restore() {
    use rustix::termios::{LocalModes, tcgetattr};

    if let Some(found) = &*SAVED_MODES.lock().unwrap_or_else(PoisonError::into_inner) {
        // A line editor that has set raw mode has also switched on bracketed paste, so bracketed paste is switched off
        // here.
        if tcgetattr(std::io::stdin()).is_ok_and(|now| !now.local_modes.contains(LocalModes::ICANON)) {
            Screen::stderr("\x1b[?2004l");
        }
        // An error is ignored: a closed terminal needs no settings.
        let _ = rustix::termios::tcsetattr(std::io::stdin(), rustix::termios::OptionalActions::Now, found);
    }
}

/// Does nothing, because this is not necessary on this system.
#[cfg(not(unix))]
pub fn save() {}

/// Does nothing, because this is not necessary on this system.
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
    fn only_yes_confirms() {
        for yes in ["y\n", "Y", " yes\r\n", "YES"] {
            assert!(is_yes(yes.as_bytes()), "{yes:?}");
        }
        for no in ["", "\n", "n", "ye", "yess", "y y", "\x1b[Ay", "ja"] {
            assert!(!is_yes(no.as_bytes()), "{no:?}");
        }
        assert!(!is_yes(b"\xff\n"));
    }
}

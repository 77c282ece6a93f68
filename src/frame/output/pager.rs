//! Pager for long texts.

use std::ffi::OsString;
use std::process::Command;

use dialoguer::console::Term;

use super::wrap::wrap;
use super::{Screen, is_dumb};
use crate::failure::Failure;

/// Maximum length of a text for the pager, in bytes. A text up to this length fits into a pipe before the pager reads
/// it.
const MAX_BYTES: usize = 60_000;

impl Screen {
    /// Prints a text. If the text is longer than the terminal, uses a pager.
    pub fn read(&self, text: &str) -> Result<(), Failure> {
        let (rows, _) = Term::stdout().size();
        let is_terminal = self.is_stdout_terminal();
        let text = if is_terminal { wrap(text, self.width().into()) } else { text.into() };
        let is_long = text.lines().count() >= rows.into() && text.len() < MAX_BYTES;
        let can_page = self.pager && is_long && is_terminal && self.can_interrupt() && !is_dumb();
        if can_page && show(&text) { Ok(()) } else { self.data(&text) }
    }
}

/// Shows the text in a pager. Returns `false` if there is no pager.
fn show(text: &str) -> bool {
    let words = match std::env::var("PAGER") {
        Ok(pager) => shlex::split(&pager).unwrap_or_default(),
        Err(_) if cfg!(unix) => vec!["less".to_owned()],
        Err(_) => Vec::new(),
    };
    let Some((program, arguments)) = words.split_first().filter(|(program, _)| *program != "cat") else { return false };
    let mut pager = Command::new(program);
    pager.args(arguments);
    // The pager shows colors, and exits at once if the text fits on one screen. `git` uses the same settings.
    if std::env::var_os("LESS").is_none() {
        pager.env("LESS", OsString::from("FRX"));
    }
    become_pager(pager, text)
}

/// Writes the text into a pipe, and replaces this process by the pager. The pager then gets the keys and Ctrl-C.
#[cfg(unix)]
fn become_pager(mut pager: Command, text: &str) -> bool {
    use std::io::Write as _;
    use std::os::unix::process::CommandExt as _;

    let Ok((reader, mut writer)) = std::io::pipe() else { return false };
    if writer.write_all(text.as_bytes()).is_ok() {
        drop(writer);
        let _ = pager.stdin(reader).exec();
    }
    false
}

#[cfg(not(unix))]
fn become_pager(mut pager: Command, text: &str) -> bool {
    use std::io::Write as _;

    let Ok(mut child) = pager.stdin(std::process::Stdio::piped()).spawn() else { return false };
    // If the write fails, the user has left the pager.
    let _ = child.stdin.take().map(|mut stdin| stdin.write_all(text.as_bytes()));
    child.wait().is_ok()
}

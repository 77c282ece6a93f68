//! Long texts to read, through a pager.

use std::ffi::OsString;
use std::process::Command;

use dialoguer::console::Term;

use super::{Screen, is_dumb};
use crate::failure::Failure;

/// What fits into a pipe before somebody reads from it.
const MOST: usize = 60_000;

impl Screen {
    /// Writes a text to read: through a pager where it is longer than the terminal.
    pub fn read(&self, text: &str) -> Result<(), Failure> {
        let (rows, _) = Term::stdout().size();
        let is_long = text.lines().count() >= rows.into() && text.len() < MOST;
        let can_page = self.pager && is_long && self.is_stdout_terminal() && self.can_interrupt() && !is_dumb();
        if can_page && show(text) { Ok(()) } else { self.data(text) }
    }
}

/// Shows it, if there is a pager.
fn show(text: &str) -> bool {
    let words = match std::env::var("PAGER") {
        Ok(pager) => shlex::split(&pager).unwrap_or_default(),
        Err(_) if cfg!(unix) => vec!["less".to_owned()],
        Err(_) => Vec::new(),
    };
    let Some((program, arguments)) = words.split_first().filter(|(program, _)| *program != "cat") else { return false };
    let mut pager = Command::new(program);
    pager.args(arguments);
    // Colours, and an end as soon as all of it has been seen: what git does.
    if std::env::var_os("LESS").is_none() {
        pager.env("LESS", OsString::from("FRX"));
    }
    become_pager(pager, text)
}

/// The text waits in the pipe, and the process becomes the pager: keys and Ctrl-C are its own then.
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
    // Who leaves before the end has read enough.
    let _ = child.stdin.take().map(|mut stdin| stdin.write_all(text.as_bytes()));
    child.wait().is_ok()
}

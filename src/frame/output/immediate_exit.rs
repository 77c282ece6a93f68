//! Immediate exit of the process from any thread. Prints the reason, and restores the terminal.

use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

use super::envelope::Envelope;
use super::{Screen, fullscreen, prompt};
use crate::failure::{Failure, Kind, exit_process};
use armctl_files as files;

/// Screen for the last message; `None` until it is set.
static SCREEN: Mutex<Option<Screen>> = Mutex::new(None);

/// Time limit for the last message. A write to a stopped terminal would block.
const MESSAGE_TIMEOUT: Duration = Duration::from_millis(200);

impl Screen {
    /// Sets this screen for the message of an immediate exit.
    pub fn use_for_exit(self) {
        *SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self);
    }
}

/// Restores the terminal, prints the reason, and exits with the exit code for an interruption.
pub fn exit_now(why: &str) -> ! {
    let (done, is_done) = mpsc::channel();
    let failure = Failure::new(Kind::Interrupted, why);
    // The message is printed on its own thread, because another thread may hold the lock of stdout or stderr.
    std::thread::spawn(move || {
        fullscreen::restore();
        prompt::restore();
        let screen = *SCREEN.lock().unwrap_or_else(PoisonError::into_inner);
        match screen {
            Some(screen) if screen.is_json() => screen.failure_json(&Envelope::failed(None, failure)),
            Some(screen) => screen.failure(&failure),
            None => {}
        }
        let _ = done.send(());
    });
    let _ = is_done.recv_timeout(MESSAGE_TIMEOUT);
    files::remove_drafts();
    exit_process(Kind::Interrupted)
}

/// Suspends the process group, as a shell expects after Ctrl-Z. Returns when the process continues. Returns at once if
/// no shell could continue the process.
#[cfg(unix)]
pub fn suspend() {
    use nix::unistd::{getpgid, getpgrp, getppid, getsid};
    use rustix::process::{Signal, kill_current_process_group};

    // In a container, the session leader may be outside of the container. Its process id is then 0. `rustix` would
    // panic in this case; `nix` does not.
    let parent = getppid();
    let is_same_session = getsid(Some(parent)).is_ok_and(|its| getsid(None) == Ok(its));
    if is_same_session && getpgid(Some(parent)).is_ok_and(|its| its != getpgrp()) {
        // SIGSTOP is sent, because our own signal handler would handle SIGTSTP.
        let _ = kill_current_process_group(Signal::STOP);
    }
}

//! Immediate exit from any thread: prints the reason, and restores the terminal.

use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

use super::envelope::Envelope;
use super::{Screen, fullscreen, prompt};
use crate::failure::{Failure, Kind, exit_process};
use armctl_files as files;

/// Screen for the last message, once known.
static SCREEN: Mutex<Option<Screen>> = Mutex::new(None);

/// Time limit for the last message, because a stopped terminal blocks.
const MESSAGE_TIMEOUT: Duration = Duration::from_millis(200);

impl Screen {
    /// Uses this screen for the message of an immediate exit.
    pub fn use_for_exit(self) {
        *SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self);
    }
}

/// Restores the terminal, prints the reason, and exits as interrupted.
pub fn exit_now(why: &str) -> ! {
    let (done, is_done) = mpsc::channel();
    let failure = Failure::new(Kind::Interrupted, why);
    // On its own thread, because another thread can hold the lock of stdout or stderr.
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

/// Suspends the process group, as a shell expects of Ctrl-Z. Returns when it continues; at once without a shell that
/// could continue it.
#[cfg(unix)]
pub fn suspend() {
    use nix::unistd::{getpgid, getpgrp, getppid, getsid};
    use rustix::process::{Signal, kill_current_process_group};

    // In a container, the session leader can be outside, with process id 0. rustix panics at that, nix does not.
    let parent = getppid();
    let is_same_session = getsid(Some(parent)).is_ok_and(|its| getsid(None) == Ok(its));
    if is_same_session && getpgid(Some(parent)).is_ok_and(|its| its != getpgrp()) {
        // SIGTSTP would be handled by our own signal handler.
        let _ = kill_current_process_group(Signal::STOP);
    }
}

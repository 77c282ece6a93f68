//! The end of the process at once, from any thread, whatever the others do: what is wrong is told, and the terminal is
//! left as it was found.

use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;

use super::envelope::Envelope;
use super::{Screen, fullscreen, prompt};
use crate::failure::{Failure, Kind, end};
use crate::files;

/// How failures are told, once that is known.
static SCREEN: Mutex<Option<Screen>> = Mutex::new(None);

/// How long the last words may take: a terminal that is stopped takes none.
const LAST_WORDS: Duration = Duration::from_millis(200);

impl Screen {
    /// From here on the end of the process at once is told on this screen.
    pub fn tells_the_end(self) {
        *SCREEN.lock().unwrap_or_else(PoisonError::into_inner) = Some(self);
    }
}

/// Restores the terminal, says why, and ends the process as interrupted.
pub fn at_once(why: &str) -> ! {
    let (done, is_done) = mpsc::channel();
    let failure = Failure::new(Kind::Interrupted, why);
    // Whoever holds stdout or stderr and does not get on must not hold up the end.
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
    let _ = is_done.recv_timeout(LAST_WORDS);
    files::remove_drafts();
    end(Kind::Interrupted)
}

/// Suspends the process and those beside it, as a shell expects it of Ctrl-Z. Returns when it goes on; at once where no
/// shell is there that could let it go on.
#[cfg(unix)]
pub fn suspend() {
    use nix::unistd::{getpgid, getpgrp, getppid, getsid};
    use rustix::process::{Signal, kill_current_process_group};

    // In a container the leader of the session may be outside, and its number 0. rustix panics at that, nix does not.
    let parent = getppid();
    let is_beside = getsid(Some(parent)).is_ok_and(|its| getsid(None) == Ok(its));
    if is_beside && getpgid(Some(parent)).is_ok_and(|its| its != getpgrp()) {
        // A process that hears SIGTSTP is not suspended by it.
        let _ = kill_current_process_group(Signal::STOP);
    }
}

//! How the terminal was set, to leave it as it was found: the editor may wait for a key when the process is asked to end.

use std::time::Duration;

use tokio::time::sleep;

/// How often it is looked whether the editor has the terminal.
const TRIES: u32 = 40;
const PAUSE: Duration = Duration::from_millis(5);

/// The settings of the terminal that lines are typed at.
#[derive(Debug)]
pub struct Terminal {
    #[cfg(unix)]
    found: Option<rustix::termios::Termios>,
}

impl Terminal {
    /// Takes note of the settings.
    pub fn save() -> Self {
        Self {
            #[cfg(unix)]
            found: rustix::termios::tcgetattr(std::io::stdin()).ok(),
        }
    }

    /// Sets it as it was, while the editor reads a line, or is about to: it takes the terminal first.
    pub async fn take_back(&self) {
        for _ in 0..TRIES {
            if Self::is_taken() {
                break;
            }
            sleep(PAUSE).await;
        }
        self.restore();
    }

    /// Whether keys come one by one.
    #[cfg(unix)]
    fn is_taken() -> bool {
        let now = rustix::termios::tcgetattr(std::io::stdin());
        // A terminal that is gone needs no settings.
        now.map_or(true, |now| !now.local_modes.contains(rustix::termios::LocalModes::ICANON))
    }

    #[cfg(unix)]
    fn restore(&self) {
        if let Some(found) = &self.found {
            let _ = rustix::termios::tcsetattr(std::io::stdin(), rustix::termios::OptionalActions::Drain, found);
        }
    }

    #[cfg(not(unix))]
    fn is_taken() -> bool {
        true
    }

    #[cfg(not(unix))]
    #[expect(clippy::unused_self, reason = "as where there is something to restore")]
    fn restore(&self) {}
}

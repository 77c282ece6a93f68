//! How the terminal was set, to leave it as it was found: the editor may wait for a key when the process is asked to end.

use std::time::Duration;

use tokio::time::sleep;

use crate::output::prompt;

/// How often it is looked whether the editor has the terminal.
const TRIES: u32 = 40;
const PAUSE: Duration = Duration::from_millis(5);

/// The terminal that lines are typed at.
#[derive(Debug)]
pub struct Terminal(());

impl Terminal {
    /// Takes note of the settings.
    pub fn save() -> Self {
        prompt::save();
        Self(())
    }

    /// Sets it as it was, while the editor reads a line, or is about to: it takes the terminal first.
    pub async fn take_back(&self) {
        for _ in 0..TRIES {
            if Self::is_taken() {
                break;
            }
            sleep(PAUSE).await;
        }
        prompt::restore();
    }

    /// Whether keys come one by one.
    #[cfg(unix)]
    fn is_taken() -> bool {
        let now = rustix::termios::tcgetattr(std::io::stdin());
        // A terminal that is gone needs no settings.
        now.map_or(true, |now| !now.local_modes.contains(rustix::termios::LocalModes::ICANON))
    }

    #[cfg(not(unix))]
    fn is_taken() -> bool {
        true
    }
}

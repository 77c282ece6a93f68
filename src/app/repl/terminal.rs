//! How the terminal was set, to leave it as it was found: the editor may wait for a key when the process is asked to end.

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

    /// Sets it as it was. A terminal that is gone needs no settings.
    pub fn restore(&self) {
        #[cfg(unix)]
        if let Some(found) = &self.found {
            let _ = rustix::termios::tcsetattr(std::io::stdin(), rustix::termios::OptionalActions::Drain, found);
        }
    }
}

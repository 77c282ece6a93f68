//! `armctl completions SHELL`.

use armctl_frame::prelude::*;

/// Print a completion script.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    shell: Shell,
}

/// A shell that can complete.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Shell {
    /// Bash 3.2 and later
    Bash,
    /// Elvish
    Elvish,
    /// Fish 3.1 and later
    Fish,
    /// PowerShell
    Powershell,
    /// Zsh
    Zsh,
}

impl Completions {
    /// Prints the script.
    pub fn run(self, run: &Run) -> Result<()> {
        run.screen.data(self.shell.script())
    }
}

impl Shell {
    /// Script that makes the shell call this program; `src/app/complete/shell.rs` answers.
    pub fn script(self) -> &'static str {
        match self {
            Self::Bash => include_str!("../../../completions/armctl.bash"),
            Self::Elvish => include_str!("../../../completions/armctl.elv"),
            Self::Fish => include_str!("../../../completions/armctl.fish"),
            Self::Powershell => include_str!("../../../completions/_armctl.ps1"),
            Self::Zsh => include_str!("../../../completions/_armctl"),
        }
    }
}

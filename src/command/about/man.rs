//! `armctl man`: the man pages, one a command.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::{Args, Command};

use crate::command::frame::run::Run;
use crate::failure::Failure;

/// Writes the man pages into a folder, or prints the one of `armctl`.
#[derive(Debug, Args)]
pub struct Man {
    /// The folder, such as /usr/local/share/man/man1; it must exist
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

impl Man {
    /// Does it; `root` makes the whole command line.
    pub fn run(self, run: &Run, root: fn() -> Command) -> Result<(), Failure> {
        let pages = pages(root())?;
        let Some(dir) = self.dir else {
            let first = pages.first().map(|(_, page)| page.as_slice()).unwrap_or_default();
            return run.screen.bytes(first);
        };
        for (name, page) in &pages {
            write(&dir.join(name), page)?;
        }
        run.screen.note(&format!("{} man pages written to {}", pages.len(), dir.display()));
        Ok(())
    }
}

fn write(path: &Path, page: &[u8]) -> Result<(), Failure> {
    Ok(std::fs::write(path, page).with_context(|| path.display().to_string())?)
}

/// File name and text of every man page: `armctl.1`, `armctl-yerc-status.1`, …
pub fn pages(mut root: Command) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    root.build();
    let mut pages = Vec::new();
    page(&root, "armctl", &mut pages)?;
    Ok(pages)
}

fn page(command: &Command, name: &str, pages: &mut Vec<(String, Vec<u8>)>) -> Result<(), Failure> {
    // Pages are named with hyphens; date and build are left out so that the committed pages depend on the text alone.
    let titled = command.clone().name(name.to_owned()).long_version(None::<&'static str>);
    let mut text = Vec::new();
    clap_mangen::Man::new(titled).date("").render(&mut text).with_context(|| format!("man page {name}"))?;
    pages.push((format!("{name}.1"), text));
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        page(sub, &format!("{name}-{}", sub.get_name()), pages)?;
    }
    Ok(())
}

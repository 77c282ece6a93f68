//! Symbolic link to the pseudo-terminal of a simulator.

use std::io;
use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Symbolic link to the pseudo-terminal, removed at the end.
#[derive(Debug)]
pub struct TerminalLink {
    name: PathBuf,
    leads_to: PathBuf,
}

impl TerminalLink {
    /// Creates the link. A dangling link of a killed simulator is replaced; any other file is not changed.
    pub fn create(name: &Path, leads_to: &str) -> Result<Self, Failure> {
        let failed = |error: io::Error| {
            let failure = Failure::io(name.display(), &error);
            match error.kind() {
                io::ErrorKind::AlreadyExists => {
                    failure.hint("remove the existing file, or use another name for --link")
                }
                _ => failure,
            }
        };
        let name = std::path::absolute(name).map_err(failed)?;
        if name.is_symlink() && !name.exists() {
            std::fs::remove_file(&name).map_err(failed)?;
        }
        let leads_to = PathBuf::from(leads_to);
        symlink(&leads_to, &name).map_err(failed)?;
        Ok(Self { name, leads_to })
    }

    /// Path of the link.
    pub fn name(&self) -> &Path {
        &self.name
    }
}

impl Drop for TerminalLink {
    fn drop(&mut self) {
        // A link of another process stays; a link that cannot be removed is replaced at the next start.
        if std::fs::read_link(&self.name).is_ok_and(|leads_to| leads_to == self.leads_to) {
            std::fs::remove_file(&self.name).unwrap_or_default();
        }
    }
}

#[cfg(unix)]
use std::os::unix::fs::symlink;

#[cfg(not(unix))]
fn symlink(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn link_exists_while_it_is_served() {
        let folder = tempfile::tempdir().unwrap();
        let (name, port) = (folder.path().join("toyo"), folder.path().join("pts"));
        std::fs::write(&port, "").unwrap();
        let leads_to = port.to_str().unwrap();
        let link = TerminalLink::create(&name, leads_to).unwrap();
        assert_eq!(std::fs::read_link(&name).unwrap(), port);
        let second = TerminalLink::create(&name, leads_to).unwrap_err();
        assert!(second.hint.unwrap().contains("--link"), "one that leads somewhere is somebody's");
        drop(link);
        assert!(!name.is_symlink());
    }

    #[test]
    fn replaces_links_of_killed_simulators_only() {
        let folder = tempfile::tempdir().unwrap();
        let (name, port) = (folder.path().join("toyo"), folder.path().join("pts"));
        symlink(folder.path().join("gone"), &name).unwrap();
        let link = TerminalLink::create(&name, port.to_str().unwrap()).unwrap();
        assert_eq!(std::fs::read_link(&name).unwrap(), port);
        std::fs::remove_file(&name).unwrap();
        std::fs::write(&name, "mine").unwrap();
        drop(link);
        assert_eq!(std::fs::read_to_string(&name).unwrap(), "mine");
        assert!(TerminalLink::create(&name, port.to_str().unwrap()).is_err());
    }
}

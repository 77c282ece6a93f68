//! Write access to `robots.toml`; only this module changes the file.

use armctl_frame::output::busy_work::register;
use armctl_frame::prelude::*;
use armctl_frame::settings::document::{Document, DocumentError};
use armctl_frame::settings::inventory::Inventory;

/// Path of the inventory file, whether it exists or not.
pub fn path(run: &Run) -> Result<&Path> {
    run.sources
        .inventory
        .path
        .as_deref()
        .ok_or_else(|| Failure::new(Kind::Usage, "no home folder for robots.toml").hint("set a file with --config"))
}

/// Content of the file; empty if it does not exist.
pub fn read(path: &Path) -> Result<String> {
    match files::text(path, files::SETTINGS) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(String::new()),
        text => Ok(text.with_context(|| path.display().to_string())?),
    }
}

/// Changes the file. A new version is written next to the file, and then renamed. Returns the path.
pub fn change(run: &Run, change: impl FnOnce(&mut Document) -> Result<(), DocumentError>) -> Result<String> {
    let path = path(run)?;
    replace(path, |text| {
        let invalid = |why: &dyn fmt::Display| {
            Failure::usage(format!("{}: {why}", path.display()))
                .hint("correct the file with `armctl robots edit`; see `armctl help inventory`")
        };
        let mut document = Document::parse(text).map_err(|error| invalid(&error))?;
        change(&mut document).map_err(|why| invalid(&why))?;
        Ok(document.to_string())
    })?;
    Ok(path.display().to_string())
}

/// Replaces the file with the result of `make`. A version that cannot be parsed is not written.
pub fn replace(path: &Path, make: impl FnOnce(&str) -> Result<String>) -> Result<Inventory> {
    let _busy = register();
    // Locks out other processes between the read and the write.
    let _turn = files::lock_file(path).with_context(|| path.display().to_string())?;
    let text = make(&read(path)?)?;
    let inventory = Inventory::parse(&text, &path.display().to_string())?;
    files::replace(path, text.as_bytes()).with_context(|| path.display().to_string())?;
    Ok(inventory)
}

//! The simulated controller as URLs name it.

use std::path::Path;

pub use crate::client::yrcx::Simulated;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::files;
use crate::settings::target::Sim;

/// A simulator in this process, in the start state that the URL names.
pub fn in_process(sim: &Sim) -> Result<Simulated, Failure> {
    Ok(Simulated::new(start(sim.state.as_deref())?))
}

/// Whether the URL asks for what only a network can do wrong.
pub fn has_faults(sim: &Sim) -> bool {
    sim.fault.is_some() || sim.mischief.is_some()
}

/// The start state: a file's, or the built-in one.
pub fn start(file: Option<&Path>) -> Result<Start, Failure> {
    let Some(path) = file else { return Ok(Start::default()) };
    let text = files::text(path, files::SETTINGS).map_err(|error| Failure::io(path.display(), &error))?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

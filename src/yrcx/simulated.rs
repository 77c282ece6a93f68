//! Simulated controller for a simulator URL.

use crate::prelude::basics::*;
pub use armctl_client::yrcx::Simulated;
use armctl_controller::simulator::run_options::RunOptions;
use armctl_controller::yrcx::simulator::Start;
use armctl_frame::backup::recording::with_replay;
use armctl_frame::backup::twin;
use armctl_frame::settings::target::Sim;
use armctl_transport::fault::{FaultNames, FaultText, SimulatorFaults};

/// Creates a simulator in this process, with the start state that the URL names.
pub fn in_process(sim: &Sim, options: RunOptions) -> Result<Simulated> {
    Ok(Simulated::new(start(sim)?.with_options(options)))
}

/// Whether the URL has faults. Faults need a simulated network.
pub fn has_faults(sim: &Sim) -> bool {
    sim.fault.is_some()
}

/// Start state that a URL names.
pub fn start(sim: &Sim) -> Result<Start> {
    with_replay(start_with(sim.state.as_deref(), sim.from.as_deref())?, sim.replay.as_deref(), Family::Yrcx)
}

/// Reads the start state from a state file or a backup, or returns the built-in state.
pub fn start_with(state: Option<&Path>, from: Option<&Path>) -> Result<Start> {
    if let Some(folder) = from {
        return twin::start(Family::Yrcx, folder);
    }
    let Some(path) = state else { return Ok(Start::default()) };
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("see `armctl help simulator` for the form of the file")
    })
}

/// Parses the faults of a URL.
pub fn faults_of_url<S: FaultText, D: Copy>(sim: &Sim, names: &FaultNames<D>) -> Result<SimulatorFaults<S, D>> {
    faults(sim.fault.as_deref(), names).map_err(|why| {
        Failure::usage(format!("fault: {why}"))
            .hint("write % as %25 in a URL; see `armctl help simulator` for a list of faults")
    })
}

/// Parses the faults of `--fault`.
pub fn faults_of_option<S: FaultText, D: Copy>(
    text: Option<&str>,
    names: &FaultNames<D>,
) -> Result<SimulatorFaults<S, D>> {
    faults(text, names).map_err(|why| {
        Failure::usage(format!("--fault: {why}")).hint("see `armctl help simulator` for a list of faults")
    })
}

/// Parses faults; `None` means no faults.
pub fn faults<S: FaultText, D: Copy>(
    text: Option<&str>,
    names: &FaultNames<D>,
) -> Result<SimulatorFaults<S, D>, String> {
    text.map_or_else(|| Ok(SimulatorFaults::default()), |text| names.parse(text)).map_err(|error| error.to_string())
}

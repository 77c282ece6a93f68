//! Simulated controller of a URL.

use std::path::Path;

use anyhow::Context as _;

pub use crate::client::yrcx::Simulated;
use crate::controller::yrcx::simulator::Start;
use crate::failure::Failure;
use crate::files;
use crate::settings::target::Sim;
use crate::transport::fault::FaultSpec;

/// Simulator in this process, in the start state of the URL.
pub fn in_process(sim: &Sim) -> Result<Simulated, Failure> {
    Ok(Simulated::new(start(sim.state.as_deref())?))
}

/// Whether the URL has network faults.
pub fn has_faults(sim: &Sim) -> bool {
    sim.fault.is_some() || sim.mischief.is_some()
}

/// Start state: from a file, or the built-in one.
pub fn start(file: Option<&Path>) -> Result<Start, Failure> {
    let Some(path) = file else { return Ok(Start::default()) };
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

/// Parses link faults that apply to a YRCX.
pub fn faults(text: &str) -> Result<FaultSpec, String> {
    let spec: FaultSpec = text.parse().map_err(|error| format!("{error}"))?;
    if spec.busy.per_10_000() > 0 { Err("the fault busy does not exist for yrcx".to_owned()) } else { Ok(spec) }
}

/// Parses faults of frames with a checksum, which cannot be corrupted.
pub fn faults_of_frames(text: &str, link: &str) -> Result<FaultSpec, String> {
    let spec = faults(text)?;
    if spec.corrupt.per_10_000() > 0 {
        return Err(format!("the fault corrupt does not exist for {link}, because its frames have a checksum"));
    }
    Ok(spec)
}

/// Parses the link faults and the device fault of a URL for a fieldbus.
pub fn wrongs<F, M>(
    sim: &Sim,
    faults: impl Fn(&str) -> Result<F, String>,
    mischief: impl Fn(&str) -> Result<M, String>,
) -> Result<(Option<F>, Option<M>), Failure> {
    let wrong = |why: String| Failure::usage(why).hint("write % as %25 in a URL; `armctl help simulator` lists faults");
    let faults = sim.fault.as_deref().map(faults).transpose().map_err(|why| wrong(format!("fault: {why}")))?;
    let mischief = sim.mischief.as_deref().map(mischief).transpose();
    Ok((faults, mischief.map_err(|why| wrong(format!("mischief: {why}")))?))
}

/// Finds a fault by its name.
pub fn fault_by_name<T: Copy>(known: &[(&'static str, T)], text: &str) -> Result<T, String> {
    let found = known.iter().find(|(name, _)| *name == text);
    found.map(|(_, fault)| *fault).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        format!("there are {}", names.join(", "))
    })
}

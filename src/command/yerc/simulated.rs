//! How a simulated controller starts.

use std::path::Path;

use anyhow::Context as _;

pub use crate::client::yerc::Simulated;
use crate::controller::yerc::Model;
use crate::controller::yerc::simulator::Start;
use crate::failure::Failure;
use crate::files;
use crate::transport::fault::FaultSpec;

/// The start state: a file's, or the built-in one of the model; busy as often as the faults say.
pub fn start(file: Option<&Path>, model: Model, faults: Option<&FaultSpec>) -> Result<Start, Failure> {
    let start = file.map_or_else(|| Ok(Start::for_model(model)), load)?;
    Ok(match faults {
        Some(faults) => start.with_busy(f64::from(faults.busy.per_10_000()) / 10_000.0),
        None => start,
    })
}

/// More than a controller has room for.
const MOST: u64 = 256 << 20;

fn load(path: &Path) -> Result<Start, Failure> {
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    // Files that the state names lie beside it.
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = |name: &str| {
        let path = folder.join(name);
        files::read(&path, MOST).map_err(|error| format!("{}: {error}", path.display()))
    };
    Start::parse(&text, read).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("`armctl help simulator` shows the form of the file")
    })
}

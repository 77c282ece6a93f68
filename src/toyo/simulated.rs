//! Start state of a simulated controller.

use crate::prelude::basics::*;
pub use armctl_client::toyo::Simulated;
use armctl_controller::toyo::simulator::Start;
use armctl_frame::backup::twin;
use armctl_transport::fault::LineFaultSpec;

/// Start state with the busy rate of the faults. It comes from a state file or a backup, or is the built-in state with
/// this number of axes.
pub fn start(
    state: Option<&Path>,
    from: Option<&Path>,
    axes: Option<u8>,
    faults: Option<&LineFaultSpec>,
) -> Result<Start> {
    let start = match (from, state, axes) {
        (None, None, None) => Start::default(),
        (None, None, Some(axes)) => Start::parse(&format!("axes = {axes}")).map_err(Failure::usage)?,
        (Some(folder), _, None) => twin::start(Family::Toyo, folder)?,
        (None, Some(file), None) => load(file)?,
        (Some(_), _, Some(_)) => {
            return Err(Failure::usage("--axes cannot be used with --from").hint("the backup has the number of axes"));
        }
        (None, Some(_), Some(_)) => {
            return Err(Failure::usage("--axes cannot be used with --state")
                .hint("write the number of axes into the state file"));
        }
    };
    Ok(match faults {
        Some(faults) => start.with_busy(faults.busy.fraction()),
        None => start,
    })
}

fn load(path: &Path) -> Result<Start> {
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    Start::parse(&text).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("see `armctl help simulator` for the form of the file")
    })
}

//! Start state of a simulated controller.

use crate::prelude::basics::*;
pub use armctl_client::yerc::Simulated;
use armctl_controller::yerc::simulator::Start;
use armctl_frame::backup::twin;
use armctl_transport::fault::FaultSpec;

/// Start state with the busy rate of the faults. It comes from a state file or a backup, or is the built-in state of
/// the model.
pub fn start(state: Option<&Path>, from: Option<&Path>, model: Model, faults: Option<&FaultSpec>) -> Result<Start> {
    let start = match (from, state) {
        (Some(folder), _) => twin::start(Family::Yerc, folder)?,
        (None, Some(file)) => load(file)?,
        (None, None) => Start::for_model(model),
    };
    Ok(match faults {
        Some(faults) => start.with_busy(faults.busy.fraction()),
        None => start,
    })
}

/// Checks that a start state is for the model that the user selected, if any.
pub fn check_model(start: &Start, selected: Option<Model>) -> Result<()> {
    let Some(selected) = selected.filter(|model| *model != start.model()) else { return Ok(()) };
    let message = format!("the start state is for model {}, but the selected model is {selected}", start.model());
    Err(Failure::usage(message).hint("remove --model, or change the file"))
}

/// Maximum size of a file. It is larger than the storage of a controller.
const MAX_FILE_SIZE: u64 = 256 << 20;

fn load(path: &Path) -> Result<Start> {
    let text = files::text(path, files::SETTINGS).with_context(|| path.display().to_string())?;
    // The paths of files that the state names are relative to the folder of the state.
    let folder = path.parent().unwrap_or(Path::new(""));
    let read = |name: &str| {
        let path = folder.join(name);
        files::read(&path, MAX_FILE_SIZE).map_err(|error| format!("{}: {error}", path.display()))
    };
    Start::parse(&text, read).map_err(|error| {
        Failure::usage(format!("{}: {error}", path.display()))
            .hint("see `armctl help simulator` for the form of the file")
    })
}

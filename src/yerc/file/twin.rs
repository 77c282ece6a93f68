//! Start state of a simulator from a backup.

use super::manifest::Manifest;
use crate::prelude::*;
use armctl_controller::text::unhex;
use armctl_controller::yerc::simulator::Start;
use armctl_frame::backup::manifest;
use armctl_frame::backup::twin::impossible;
use armctl_frame::text_files;

/// What a backup does not contain.
pub const UNKNOWN: &str = "a backup contains no positions of the axes, signals, registers, running times and active \
                           alarms; the twin has those of a new simulator. Position variables in the form of a real \
                           VAR.DAT are undefined";

/// Start state with the files of a backup.
pub fn start(folder: &Path) -> Result<Start> {
    let manifest: Manifest = manifest::open_existing(folder)?;
    let refused = |why: String| impossible(folder, &why);
    let controller = &manifest.controller;
    let mut state = format!("stock = false\nmodel = {:?}\n", controller.description_of());
    for (key, text) in [("software", &controller.software), ("robot_model", &controller.robot_model)] {
        state.extend(text.iter().map(|text| format!("{key} = {text:?}\n")));
    }
    let mut start = Start::parse(&state, |_| Err(String::new())).map_err(refused)?;
    for entry in &manifest.files {
        let Some(copy) = &entry.copy else { continue };
        let name = entry.name_hex.as_deref().and_then(unhex);
        let name = name.unwrap_or_else(|| entry.name.as_bytes().to_vec());
        let content = text_files::read(&folder.join(&copy.file))?;
        start = start.with_file(&name, content).map_err(|why| refused(format!("{}: {why}", copy.file)))?;
    }
    Ok(start)
}

//! Start state of a simulator from a backup.

use super::content::{Content, Table};
use super::manifest::Manifest;
use super::parts::Part;
use crate::prelude::*;
use armctl_controller::toyo::simulator::Start;
use armctl_controller::toyo::table::parameters::PARAMETERS;
use armctl_controller::toyo::table::{KCA, supports};
use armctl_frame::backup::manifest;
use armctl_frame::backup::twin::{frames, impossible, silent};

/// What a backup does not contain.
pub const UNKNOWN: &str = "a backup contains no positions of the axes, counters, signals and errors; the twin has those \
                           of a new simulator";

/// Start state with the data of a backup.
pub fn start(folder: &Path) -> Result<Start> {
    let manifest: Manifest = manifest::open_existing(folder)?;
    let screen = silent();
    let controller = &manifest.controller;
    let number = |text: &str| text.trim_start_matches('0').parse::<u32>().unwrap_or_default();
    let axes = controller.axis_letters.as_deref().map_or(4, |letters| letters.split(' ').count().clamp(1, 4));
    let state = format!(
        "model = {:?}\nversion = {:?}\nrobot_types = [{}]\naxes = {axes}",
        model(&manifest),
        controller.version,
        number(&controller.robot_type),
    );
    let refused = |why: String| impossible(folder, &why);
    let mut start = Start::parse(&state).map_err(refused)?;
    let tasks = [1, 2, 3, 4];
    for part in Part::all(&tasks, &tasks) {
        if manifest.entry(&part.to_string()).is_none_or(|entry| entry.copy.is_none()) {
            continue;
        }
        let content = Content::load(part, folder, controller.letters(), &screen)?;
        let task = match part {
            Part::Points(task) | Part::Program(task) => task,
            Part::Parameters | Part::Easy | Part::Palletizing(_) => 1,
        };
        let steps = content.steps();
        let mut tables: Vec<Table> = content.tables(steps).into_iter().flatten().collect();
        let frames = frames::<Toyo>(&mut tables)?;
        let texts = frames.iter().filter_map(|frame| frame["text"].as_str()?.strip_prefix('@'));
        start = start.with_written(task, texts.filter(|text| text.starts_with('W'))).map_err(refused)?;
    }
    match controller.speed_override_percent {
        Some(percent) => start.with_written(1, [&format!("WOVR OV={percent:03}")[..]]).map_err(refused),
        None => Ok(start),
    }
}

/// First model that has exactly the parameters in the backup.
fn model(manifest: &Manifest) -> &'static str {
    let entry = manifest.entry(&Part::Parameters.to_string());
    let left_out = entry.map_or(&[][..], |entry| &entry.left_out);
    let version = manifest.controller.version.replace('.', "").parse().unwrap_or_default();
    // Rows of tables have names such as T5.1.
    let is_missing = |row: &Parameter| {
        left_out.iter().any(|item| item.key == row.name || item.key.split('.').next() == Some(row.id))
    };
    let fits = |model: &&str| PARAMETERS.iter().all(|row| is_missing(row) != supports(row.only_on, model, version));
    KCA.iter().copied().chain(["other"]).find(fits).unwrap_or(KCA[2])
}

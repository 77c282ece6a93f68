//! Start state of a simulator from a backup.

use std::fmt::Write as _;

use super::content::{Controller, load};
use super::parts::Part;
use crate::prelude::*;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Words};
use armctl_controller::yrcx::simulator::Start;
use armctl_controller::yrcx::table::Row;
use armctl_frame::backup::manifest::{self, Manifest};
use armctl_frame::backup::parts::Table;
use armctl_frame::backup::twin::{frames, impossible};
use armctl_frame::text_files;

/// What a backup does not contain.
pub const UNKNOWN: &str = "a backup contains no programs, arms, pulses per mm, positions of the axes, signals and alarms; \
                           the twin has those of a new simulator";

/// Start state with the data of a backup.
pub fn start(folder: &Path) -> Result<Start> {
    let manifest: Manifest<Controller> = manifest::open_existing(folder)?;
    let saved = |part: &Part| manifest.entry(&part.to_string()).is_some_and(|entry| entry.copy.is_some());
    let refused = |why: String| impossible(folder, &why);
    let mut state = String::from("stock = false\n");
    if saved(&Part::Info) {
        let text = text_files::read(&folder.join(Part::Info.file()))?;
        state.push_str(&versions(&String::from_utf8_lossy(&text)).map_err(refused)?);
    }
    for (robot, number) in manifest.controller.robots.iter().zip(1..) {
        let count = robot.axes.len();
        if robot.robot != number || !robot.axes.iter().copied().eq((1..).take(count)) {
            return Err(impossible(folder, "the simulator has no robots or axes with a gap before them"));
        }
        writeln!(state, "[[robot]]\naxes = {count}\nmodel = {}", robot.robot_type).expect("text grows");
    }
    let start = Start::parse(&state).map_err(refused)?;
    let parts = Part::in_order_of_writing().filter(saved).map(|part| load(part, folder));
    let mut tables = parts.filter_map(Result::transpose).collect::<Result<Vec<Table<Yrcx>>>>()?;
    let frames = frames(&mut tables)?;
    let words: Vec<Words> = frames.iter().filter_map(|frame| words(&frame["wi"])).collect();
    let writes = |words: &&Words| Row::from_word(words[0]).is_some_and(|row| row.risk > Risk::Read);
    start.with_written(words.iter().filter(writes)).map_err(refused)
}

/// Command words of a planned frame.
fn words(frame: &Value) -> Option<Words> {
    let mut words = [0; COMMAND_WORDS];
    let texts = frame.as_array().filter(|texts| texts.len() == COMMAND_WORDS)?;
    for (word, text) in words.iter_mut().zip(texts) {
        *word = u16::from_str_radix(text.as_str()?.strip_prefix("0x")?, 16).ok()?;
    }
    Some(words)
}

/// Versions and option slots of the information in a backup, as a part of a start state.
fn versions(info: &str) -> Result<String, String> {
    let info: toml::Table = info.parse().map_err(|error: toml::de::Error| error.to_string())?;
    let text = |key: &str| info.get(key).and_then(toml::Value::as_str);
    let four = |name: &str| (1..=4).map(|number| text(&format!("{name}_{number}"))).collect::<Option<Vec<_>>>();
    let revision = text("host_revision").and_then(|revision| revision.strip_prefix('R')?.parse::<u16>().ok());
    let mut versions = Vec::new();
    versions.extend(text("host_version").map(|host| format!("host = {host:?}")));
    versions.extend(revision.map(|revision| format!("revision = {revision}")));
    versions.extend(text("fpga_version").map(|fpga| format!("fpga = {fpga:?}")));
    versions.extend(four("driver_version").map(|drivers| format!("drivers = {drivers:?}")));
    let slots = four("slot").map_or_else(String::new, |slots| format!("slots = {{ 1 = {slots:?} }}\n"));
    Ok(format!("versions = {{ {} }}\n{slots}", versions.join(", ")))
}

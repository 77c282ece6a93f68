//! Valid inputs: golden bytes, files of the tests, and traffic of the simulators.

use std::path::PathBuf;

use armctl_controller::text::unhex;
use serde_json::Value;

use crate::links::Disturbance;

fn path(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

/// A file below `tests/`.
pub fn file(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// All files of a folder below `tests/` with this end of their names.
pub fn folder(name: &str, end: &str) -> Vec<Vec<u8>> {
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(path(name)).expect("the folder is there").flatten().map(|entry| entry.path()).collect();
    paths.retain(|path| path.to_string_lossy().ends_with(end));
    paths.sort();
    paths.iter().map(|path| std::fs::read(path).expect("the file is readable")).collect()
}

fn json(name: &str) -> Value {
    serde_json::from_slice(&file(name)).expect("it is JSON")
}

/// Frames of the YERC manuals.
pub fn yerc() -> Vec<Vec<u8>> {
    json("data/yerc-frames.json")
        .as_array()
        .into_iter()
        .flatten()
        .filter_map(|frame| unhex(frame["hex"].as_str()?))
        .collect()
}

/// Data of these frames, without their headers.
pub fn yerc_data() -> Vec<Vec<u8>> {
    yerc().into_iter().filter_map(|frame| Some(frame.get(32..)?.to_vec())).collect()
}

/// Lines of the TOYO manual, without line ends.
pub fn toyo() -> Vec<Vec<u8>> {
    let pairs = json("data/toyo-transcripts.json");
    let lines = pairs["pairs"].as_array().into_iter().flatten().flat_map(|pair| [&pair["tx"], &pair["rx"]]);
    lines.filter_map(|line| Some(line.as_str()?.as_bytes().to_vec())).collect()
}

/// Words of the YRCX manual, as bytes of images: command, then answer.
pub fn yrcx() -> Vec<Vec<u8>> {
    let bytes = |words: &Value| -> Vec<u8> {
        let words = words.as_array().into_iter().flatten().filter_map(Value::as_str);
        let word = |text: &str| u16::from_str_radix(text.trim_start_matches("0x"), 16).unwrap_or_default();
        words.flat_map(|text| word(text).to_le_bytes()).collect()
    };
    let examples = json("data/yrcx-examples.json");
    let pairs = examples.as_array().into_iter().flatten().map(|example| {
        let mut pair = bytes(&example["wi"]);
        pair.resize(32, 0);
        pair.extend(bytes(&example["wo"]));
        pair.resize(64, 0);
        pair
    });
    pairs.collect()
}

/// Messages of an undisturbed link.
pub fn traffic(link: fn(&mut Disturbance<'_>)) -> Vec<Vec<u8>> {
    let mut undisturbed = Disturbance::new(&[]);
    link(&mut undisturbed);
    undisturbed.sent
}

/// Disturbances: none, and one of each kind at some messages.
pub fn disturbances() -> Vec<Vec<u8>> {
    let kinds: [&[u8]; 7] = [
        &[0x83, 4, 0, 0xFF, 9, 0, 0, 20, 0, 0x80, 30, 0, 1],
        &[0xB0, 20, 0],
        &[0xC0, 4, 1, 2, 3, 4],
        &[0xD0, 12, 0, 2, 0xFF, 0xFF],
        &[0xE0, 3, 1, 2, 3],
        &[0xF0],
        &[0xF8],
    ];
    let at = [0, 1, 2, 3, 5, 8, 12, 20, 40_u8];
    let disturbed = kinds.iter().flat_map(|kind| at.iter().map(move |skip| [&[*skip], *kind].concat()));
    std::iter::once(Vec::new()).chain(disturbed).collect()
}

/// Messages as pieces of a script (see `targets::pieces`), with this control byte.
pub fn script(control: u8, messages: &[Vec<u8>]) -> Vec<u8> {
    let mut script = Vec::new();
    for message in messages {
        let length = u16::try_from(message.len()).expect("a message is short");
        script.push(control);
        script.extend(length.to_le_bytes());
        script.extend(message);
    }
    script
}

//! Files of the user, captures, and what is typed.

use std::path::PathBuf;
use std::sync::Mutex;

use armctl_controller::findings::Findings;
use armctl_controller::sheet::{self, Column, Dialect, Sheet};
use armctl_controller::text::{Encoding, hex};
use armctl_controller::{toyo, user_input, yerc, yrcx};
use armctl_frame::condition::Comparison;
use armctl_frame::decode::capture::CaptureDecoder;
use armctl_frame::decode::field_table;
use armctl_frame::output::render;
use armctl_frame::output::view::View;
use armctl_frame::settings::document::Document;
use armctl_frame::settings::duration;
use armctl_frame::settings::inventory::Inventory;
use armctl_frame::settings::target::Target;
use armctl_transport::capture::{self, parse_hex};
use armctl_transport::fault::{FaultSpec, LineFaultSpec};
use sha2::{Digest as _, Sha256};

use super::{seen, text_of};
use crate::seeds;

#[path = "../../../src/app/line_words.rs"]
mod line_words;

/// A capture, read by the decoders of all families and shown.
pub fn capture(data: &[u8]) {
    let mut heard = 0;
    if let Ok(summary) = capture::read(data, |message| heard += message.bytes.len()) {
        seen(summary.damage.map(|damage| damage.to_string()));
    }
    // No packet is read twice, and a byte of a text is at most a byte.
    assert!(heard <= data.len());
    decode(data, armctl_yerc::decode::FrameDecoder::default());
    decode(data, armctl_toyo::decode::LineDecoder::default());
    decode(data, armctl_yrcx::decode::ImageDecoder::new(true));
}

fn decode<D: CaptureDecoder>(data: &[u8], mut decoder: D) {
    if capture::read(data, |message| decoder.take(message)).is_err() {
        return;
    }
    decoder.finish();
    for message in &decoder.decoded().messages {
        assert!(!message.text.contains('\n'), "{}", message.text);
        seen(serde_json::to_string(&message.fields).expect("it is JSON"));
        seen(render::text(&View { sections: vec![field_table(&message.fields)] }, 80, false));
    }
}

pub fn captures() -> Vec<Vec<u8>> {
    let mut captures = [seeds::folder("cli/files", ".pcap"), seeds::folder("cli/files", ".pcapng")].concat();
    let candump: Vec<String> = (0..9).map(|time| format!("(17.{time}) can0 42D#050{time}\n")).collect();
    captures.push(candump.concat().into());
    captures.push(seeds::traffic(crate::links::profibus).concat());
    captures
}

pub fn inventory(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    match Inventory::parse(text, "robots.toml") {
        Err(failure) => seen(failure.to_string()),
        Ok(inventory) => {
            let document = Document::parse(text).expect("an inventory is TOML");
            let whole = text.trim_start_matches('\u{FEFF}').trim_end();
            // Lines that end in two ways get the end of the first line.
            let is_mixed = whole.contains("\r\n") && whole.replace("\r\n", "").contains('\n');
            let kept = |text: &str| if is_mixed { text.replace("\r\n", "\n") } else { text.to_owned() };
            let written = document.to_string();
            assert_eq!(kept(written.trim_end()), kept(whole), "an unchanged document keeps its text");
            seen(format!("{inventory:?}"));
            seen(inventory.matching("cell*").count());
        }
    }
}

pub fn inventories() -> Vec<Vec<u8>> {
    vec![
        seeds::file("data/contract/robots.toml"),
        seeds::file("cli/files/robots.toml"),
        b"[[robot]]\nname = \"cell3\"\nfamily = \"yrcx\"\ntarget = \"eip://192.0.2.3?rpi=20ms\"\ntags = [\"a\"]\nread_only = true\n".to_vec(),
    ]
}

pub fn table(data: &[u8]) {
    let columns = ["number", "x", "y", "comment"];
    let mut findings = Findings::default();
    if let Some(sheet) = Sheet::read(data, "columns", &mut findings) {
        let places = sheet.columns(&columns, "columns", &mut findings);
        for row in sheet.rows() {
            for place in places.iter().flatten() {
                seen((row.text(*place).len(), row.string(*place).len(), sheet.number(row, *place).is_ok()));
                assert!(row.place(*place).line >= 1 && row.place(*place).column >= 1);
            }
        }
    }
    findings.sorted().iter().for_each(|finding| seen(finding.to_string()));
    let columns = [Column::number("number"), Column::text("comment")];
    let rows = vec![vec!["1".to_owned(), "=1+1".to_owned()], vec!["77".to_owned(), "a;\"b\", ".to_owned()]];
    let mut findings = Findings::default();
    if let Some(updated) = sheet::update(data, &columns, &rows, str::to_owned, &mut findings) {
        let mut findings = Findings::default();
        let again = sheet::update(updated.as_bytes(), &columns, &rows, str::to_owned, &mut findings);
        assert_eq!(again.as_deref(), Some(&*updated), "a second update changes nothing");
    }
    seen(sheet::write(Dialect::DECIMAL_COMMA, &columns, &rows));
}

pub fn tables() -> Vec<Vec<u8>> {
    let mut tables = [seeds::folder("cli/files", ".csv"), seeds::folder("data/path", ".csv")].concat();
    tables.push(b"number;x;y;comment\r\n# a remark\r\n1;1,5;-2,25;\"a \"\"b\"\"; c\"\r\n\r\n2;;0;'=1\r\n".to_vec());
    tables.push("\u{FEFF}number,comment\n1,\n".into());
    tables
}

/// A file for `armctl sim`: the family by the first byte, then TOML.
pub fn simulator_file(data: &[u8]) {
    let Some((family, data)) = data.split_first() else { return };
    let Some(text) = text_of(data) else { return };
    match family % 3 {
        0 => seen(yerc::simulator::Start::parse(text, |_| Err("no files".to_owned())).is_ok()),
        1 => seen(toyo::simulator::Start::parse(text).is_ok()),
        _ => seen(yrcx::simulator::Start::parse(text).is_ok()),
    }
}

pub fn simulator_files() -> Vec<Vec<u8>> {
    let mut files = vec![
        [b"\0", yerc::simulator::EXAMPLE.as_bytes()].concat(),
        [b"\x01", toyo::simulator::EXAMPLE.as_bytes()].concat(),
        [b"\x02", yrcx::simulator::EXAMPLE.as_bytes()].concat(),
    ];
    for file in seeds::folder("cli/files", ".toml") {
        files.extend([b"\0", b"\x01", b"\x02"].map(|family| [&family[..], &file].concat()));
    }
    files
}

/// One file of a backup: its number, then its content. The manifest gets the hash of the content.
pub fn backup(data: &[u8]) {
    static FOLDERS: Mutex<Vec<(PathBuf, Vec<String>)>> = Mutex::new(Vec::new());
    let Some((number, content)) = data.split_first() else { return };
    // A panic of an earlier input leaves the files as they should be: each input writes its own.
    let mut folders = FOLDERS.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if folders.is_empty() {
        folders.extend(BACKUPS.map(copy_of));
    }
    let all = folders.iter().flat_map(|(folder, files)| files.iter().map(move |file| (folder, file)));
    let all: Vec<(&PathBuf, &String)> = all.collect();
    let (folder, file) = all[usize::from(*number) % all.len()];
    let path = folder.join(file);
    let old = std::fs::read(&path).expect("the copy is there");
    let manifest = folder.join("manifest.json");
    let old_manifest = std::fs::read_to_string(&manifest).expect("the copy is there");
    if *file != "manifest.json" {
        let sum = |bytes: &[u8]| hex(&Sha256::digest(bytes));
        let size = |bytes: &[u8]| format!("\"bytes\": {},\n      \"sha256\": \"{}\"", bytes.len(), sum(bytes));
        std::fs::write(&manifest, old_manifest.replace(&size(&old), &size(content))).expect("it works here");
    }
    std::fs::write(&path, content).expect("it works here");
    let result = std::panic::catch_unwind(|| match folder.file_name().and_then(|name| name.to_str()) {
        Some("backup-yerc") => armctl_yerc::file::twin::start(folder).map(seen),
        Some("backup-toyo") => armctl_toyo::backup::twin::start(folder).map(seen),
        _ => armctl_yrcx::backup::twin::start(folder).map(seen),
    });
    std::fs::write(&path, old).expect("it works here");
    std::fs::write(&manifest, old_manifest).expect("it works here");
    match result {
        Ok(started) => seen(started.map_err(|failure| failure.to_string())),
        Err(panic) => std::panic::resume_unwind(panic),
    }
}

const BACKUPS: [&str; 3] = ["backup-yerc", "backup-toyo", "backup-yrcx"];

fn copy_of(name: &str) -> (PathBuf, Vec<String>) {
    let from = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../data/contract").join(name);
    let folder = tempfile::tempdir().expect("a folder").keep().join(name);
    std::fs::create_dir(&folder).expect("it works here");
    let mut files: Vec<String> = Vec::new();
    for entry in std::fs::read_dir(from).expect("the backup is there").flatten() {
        let file = entry.file_name().into_string().expect("names are UTF-8");
        std::fs::copy(entry.path(), folder.join(&file)).expect("it works here");
        files.push(file);
    }
    files.sort();
    (folder, files)
}

pub fn backups() -> Vec<Vec<u8>> {
    let mut seeds = Vec::new();
    for (folder, files) in BACKUPS.map(copy_of) {
        for file in files {
            let number = u8::try_from(seeds.len()).expect("they are few");
            seeds.push([&[number], &*std::fs::read(folder.join(file)).expect("the copy is there")].concat());
        }
        // The copies above stay for the runs; this one does not.
        seen(std::fs::remove_dir_all(folder));
    }
    seeds
}

pub fn batch_line(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    for line in text.lines() {
        for word in line_words::split(line).unwrap_or_default() {
            seen(line_words::expand_variables(&word, |name| (name == "robot").then_some("cell3")).is_ok());
        }
    }
}

pub fn batch_lines() -> Vec<Vec<u8>> {
    vec![
        seeds::file("cli/files/morning.armctl"),
        b"armctl -r ${robot} yerc var set B0=1 # a comment\nyerc job select 'A B' \"$${c}\" d\\ e\n".to_vec(),
    ]
}

pub fn typed_text(data: &[u8]) {
    let Some(text) = text_of(data) else { return };
    match text.parse::<Target>() {
        Err(failure) => seen(failure.to_string()),
        Ok(target) => assert_eq!(target.to_string().parse::<Target>().expect("a shown target"), target),
    }
    // A whole condition is a filter, which runs in another process of armctl.
    seen(Comparison::parse(text).is_some());
    if let Ok(faults) = text.parse::<FaultSpec>() {
        assert_eq!(faults.to_string().parse(), Ok(faults));
    }
    if let Ok(faults) = text.parse::<LineFaultSpec>() {
        assert_eq!(faults.to_string().parse(), Ok(faults));
    }
    seen((duration::parse(text), parse_hex(text), user_input::integer(text), user_input::code::<u32>(text)));
    if let Ok(name) = Encoding::default().encode_name(text) {
        seen(Encoding::default().name(&name));
    }
}

pub fn typed_texts() -> Vec<Vec<u8>> {
    const TEXTS: [&str; 16] = [
        "udp://192.0.2.1:10040",
        "serial:///dev/ttyS0?baud=9600",
        "tcp://192.0.2.1:4001",
        "eip://192.0.2.3:44818?in=100&out=150&config=1&rpi=20ms&key=636:43:5:1.2&role=input_only",
        "slcan:///dev/ttyACM0?mac=5&bitrate=500k&master=1",
        "can://can0?mac=5&cycle=20ms",
        "profibus:///dev/ttyUSB0?station=5&baud=500k&config=C0D7D7&prm=000000",
        "profinet://eth0/yrcx-sim?ip=192.0.2.5/24",
        "sim:?bus=profinet&fault=mute",
        "running",
        "SO(27)=on",
        ".data.held and .data.position_deg[0] > 5",
        "loss=1%,delay=10..20ms,seed=7",
        "1h30m",
        "59 45 52:43 0x00",
        "\u{30C6}\u{30B9}\u{30C8}.JBI",
    ];
    TEXTS.map(|text| text.as_bytes().to_vec()).to_vec()
}

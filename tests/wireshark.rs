//! `armctl wireshark`: tshark shows of a capture what `armctl decode` shows. Skipped without tshark.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::collections::BTreeMap;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use armctl_controller::yrcx::image::Image;
use armctl_transport::capture::LINKTYPE_CAN;
use armctl_transport::devicenet::can::Frame;
use armctl_transport::devicenet::wire::{Id, Mac};
use armctl_transport::eip::wire::{Cyclic, RUN};
use armctl_transport::tap::{CaptureWriter, Direction, LINKTYPE_PROFIBUS_DL};
use serde_json::Value;

const SKIPPED: &str = "skipped: tshark is not installed";
const CLIENT: &str = "192.0.2.9:50000";
const CONTROLLER: &str = "192.0.2.31";

/// Folder with the dissectors and the captures of a test.
struct Bench {
    folder: tempfile::TempDir,
}

/// What tshark shows of a packet: the column Info, and the labels of the tree.
#[derive(Debug, Default)]
struct Packet {
    info: String,
    labels: Vec<String>,
}

impl Bench {
    fn new() -> Option<Self> {
        let found = Command::new("tshark").arg("--version").output().is_ok_and(|output| output.status.success());
        assert!(found || std::env::var_os("CI").is_none(), "tshark belongs to the set-up of .ci/run");
        if !found {
            return None;
        }
        let bench = Self { folder: tempfile::tempdir().unwrap() };
        let written = armctl(&["wireshark", bench.folder.path().to_str().unwrap()]);
        assert!(written.contains("armctl.lua"), "{written}");
        Some(bench)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn tshark(&self, capture: &Path, arguments: &[&str]) -> String {
        let script = format!("lua_script:{}", self.path("armctl.lua").display());
        let mut tshark = Command::new("tshark");
        let output = tshark.args(["-n", "-X", &script, "-r"]).arg(capture).args(arguments).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(!stderr.contains("Lua") && output.status.success(), "{}: {stderr}", capture.display());
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn packets(&self, capture: &Path) -> BTreeMap<u64, Packet> {
        let mut packets = BTreeMap::<u64, Packet>::new();
        for line in self.tshark(capture, &["-T", "fields", "-e", "frame.number", "-e", "_ws.col.Info"]).lines() {
            let (number, info) = line.split_once('\t').unwrap();
            packets.entry(number.parse().unwrap()).or_default().info = info.replace("\\\"", "\"");
        }
        let pdml = self.tshark(capture, &["-T", "pdml"]);
        for (packet, text) in packets.values_mut().zip(pdml.split("<packet>").skip(1)) {
            let labels = text.split("showname=\"").skip(1).filter_map(|rest| rest.split('"').next());
            // The text of an item without a field.
            let texts = text.split("name=\"\" show=\"").skip(1).filter_map(|rest| rest.split('"').next());
            packet.labels = labels.chain(texts).map(plain).collect();
        }
        packets
    }

    /// Compares every packet with `armctl decode`. Returns the number of compared messages.
    fn compare(&self, family: &str, capture: &Path) -> usize {
        let decoded: Value = serde_json::from_str(&armctl(&["decode", family, "--json", &name_of(capture)])).unwrap();
        let mut expected = BTreeMap::<u64, Vec<&Value>>::new();
        for message in decoded["data"]["messages"].as_array().unwrap() {
            let text = message["text"].as_str().unwrap();
            // Wireshark itself decodes the other messages of a fieldbus.
            let is_image = ["WI ", "WO ", "SI(", "SO("].iter().any(|start| text.starts_with(start));
            if family != "yrcx" || is_image {
                expected.entry(message["number"].as_u64().unwrap()).or_default().push(message);
            }
        }
        let packets = self.packets(capture);
        let failed =
            packets.values().find(|packet| packet.labels.iter().any(|label| label.contains("Dissector failed")));
        assert!(failed.is_none(), "{}: {failed:?}", capture.display());
        for (number, messages) in &expected {
            let packet = &packets[number];
            let name = format!("{} packet {number}: {packet:?}", capture.display());
            let texts: Vec<&str> = messages.iter().map(|message| message["text"].as_str().unwrap()).collect();
            let info = texts.join("; ");
            match info.split_once("no valid ") {
                // The texts of problems differ.
                Some((before, _)) => assert!(packet.info.starts_with(&format!("{before}no valid ")), "{info}\n{name}"),
                None => assert!(packet.info.starts_with(&info), "{info}\n{name}"),
            }
            for field in messages.iter().flat_map(|message| message["fields"].as_array().unwrap()) {
                let (label, is_text) = label_of(family, field);
                let is_shown = packet.labels.iter().any(|shown| is_text(shown, &label));
                assert!(is_shown || field["name"] == "not used", "{label}\n{name}");
            }
        }
        expected.values().map(Vec::len).sum()
    }

    /// Cuts and damages every packet of a capture. No dissector may fail.
    fn damage(&self, capture: &Path) {
        let path = self.path("damaged.pcapng");
        for options in [["-s", "29"], ["-s", "47"], ["-s", "61"], ["-E", "0.02"]] {
            // The program that comes with tshark. The headers stay, so that the dissectors find their packets.
            let mut editcap = Command::new("editcap");
            editcap.args(["-o", "32", "--seed", "7"]).args(options).args([capture, path.as_path()]);
            assert!(editcap.output().unwrap().status.success(), "{options:?}");
            let failed = "armctl_yerc.failed || armctl_toyo.failed || armctl_yrcx.failed";
            assert_eq!(self.tshark(&path, &["-Y", failed]), "", "{} {options:?}", capture.display());
        }
        // With two passes, each packet is dissected again.
        self.tshark(&path, &["-2", "-V"]);
    }
}

/// Label of a field of `armctl decode`, and how tshark's label must match it.
fn label_of(family: &str, field: &Value) -> (String, fn(&str, &str) -> bool) {
    let text = |key: &str| field[key].as_str().unwrap_or_default();
    let (name, meaning) = (text("name"), text("meaning"));
    // Wireshark cuts labels after 240 bytes.
    let whole: fn(&str, &str) -> bool =
        |shown, label| shown == label || shown.len() > 200 && label.starts_with(&shown[..200]);
    let start: fn(&str, &str) -> bool = |shown, label| shown.starts_with(label);
    match family {
        // Parts of the header have numbers and the names of values in Wireshark's own form.
        "yerc" if field["offset"].as_u64() < Some(32) => (format!("{name}: "), start),
        "yerc" if field["size"] == 0 => (String::new(), start),
        "yrcx" if field["key"].is_null() => match name {
            "status" | "command code" | "alarm group" => (name.replace(" code", "") + ": ", start),
            signal if signal.starts_with(['S']) && meaning.is_empty() => (String::new(), start),
            signal if signal.starts_with(['S']) => {
                (format!("{signal} {}: {meaning}", if text("raw") == "1" { "on" } else { "off" }), whole)
            }
            _ => (format!("{name}: {meaning}"), whole),
        },
        _ => (format!("{name}: {meaning}"), whole),
    }
}

fn plain(text: &str) -> String {
    let text = text
        .trim_start_matches([' '])
        .trim_start_matches("[truncated]")
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&quot;", "\"")
        .replace("&apos;", "'");
    // Wireshark escapes the quotes and backslashes of a label once more.
    text.replace("&#x27;", "'").replace("&amp;", "&")
}

fn name_of(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

fn armctl(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_armctl")).args(arguments).output().unwrap();
    // A damaged capture has another exit code, but is decoded.
    assert!(!output.stdout.is_empty(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn data(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(name);
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

fn from_hex(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).unwrap()).collect()
}

fn ends(port: u16) -> (SocketAddr, SocketAddr) {
    (CLIENT.parse().unwrap(), format!("{CONTROLLER}:{port}").parse().unwrap())
}

fn at(number: usize) -> Duration {
    Duration::from_millis(u64::try_from(number).unwrap())
}

#[test]
fn frames_of_the_manuals_and_of_a_controller() {
    let Some(bench) = Bench::new() else { return println!("{SKIPPED}") };
    let path = bench.path("yerc.pcapng");
    let mut writer = CaptureWriter::append(&path).unwrap();
    let frames = data("yerc-frames.json");
    let frames = frames.as_array().unwrap();
    for (number, frame) in frames.iter().enumerate() {
        let (own, controller) = ends(u16::try_from(frame["port"].as_u64().unwrap_or(10040)).unwrap());
        let is_sent = frame["direction"] == "client->controller";
        let (from, to) = if is_sent { (own, controller) } else { (controller, own) };
        writer.datagram(at(number), from, to, &from_hex(frame["hex"].as_str().unwrap())).unwrap();
    }
    let mut pairs = 0;
    if let Some(path) = std::env::var_os("ARMCTL_YERC_CAPTURES") {
        let captured: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
        let (own, controller) = ends(10040);
        for pair in captured["pairs"].as_array().unwrap() {
            pairs += 2;
            writer.datagram(at(pairs), own, controller, &from_hex(pair["tx"].as_str().unwrap())).unwrap();
            writer.datagram(at(pairs), controller, own, &from_hex(pair["rx"].as_str().unwrap())).unwrap();
        }
    }
    assert!(bench.compare("yerc", &path) >= 100 + pairs);
    let filter = "armctl_yerc.command == 0x72 && armctl_yerc.instance == 1 && armctl_yerc.request_in";
    assert!(!bench.tshark(&path, &["-Y", filter]).is_empty(), "an answer has the command of its request");
    assert!(!bench.tshark(&path, &["-2", "-Y", "armctl_yerc.response_in && armctl_yerc.service == 1"]).is_empty());
    bench.damage(&path);
}

#[test]
fn lines_of_the_toyo_manual() {
    let Some(bench) = Bench::new() else { return println!("{SKIPPED}") };
    let pairs = data("toyo-transcripts.json");
    for is_serial in [false, true] {
        let path = bench.path(&format!("toyo-{is_serial}.pcapng"));
        let mut writer = CaptureWriter::append_streams(&path).unwrap();
        let (own, controller) = ends(4001);
        for (number, pair) in pairs["pairs"].as_array().unwrap().iter().enumerate() {
            let line = |key: &str| format!("{}\r\n", pair[key].as_str().unwrap_or_default());
            if is_serial {
                writer.line(at(number), Direction::Sent, line("tx").as_bytes()).unwrap();
                // A line can come in pieces.
                let answer = line("rx");
                let (first, rest) = answer.split_at(answer.len() / 2);
                writer.line(at(number), Direction::Received, first.as_bytes()).unwrap();
                writer.line(at(number), Direction::Received, rest.as_bytes()).unwrap();
            } else {
                writer.segment(at(number), own, controller, line("tx").as_bytes()).unwrap();
                writer.segment(at(number), controller, own, line("rx").as_bytes()).unwrap();
            }
        }
        assert!(bench.compare("toyo", &path) > 150, "{is_serial}");
        bench.damage(&path);
    }
}

/// Images of the examples of the manual: command, then answer.
fn images() -> Vec<(Direction, Image)> {
    let mut images = Vec::new();
    for example in data("yrcx-examples.json").as_array().unwrap() {
        for (key, direction) in [("wi", Direction::Sent), ("wo", Direction::Received)] {
            let Some(words) = example[key].as_array() else { continue };
            let mut image = Image::default();
            for (word, text) in image.0.iter_mut().zip(words) {
                // The manual has a few words with five digits.
                let text = text.as_str().unwrap();
                *word = u16::from_str_radix(&text[text.len() - 4..], 16).unwrap();
            }
            image.0[16] = 0x0041 + u16::try_from(images.len() % 3).unwrap() * 2;
            images.push((direction, image));
            images.push((Direction::Sent, Image::default()));
        }
    }
    images
}

#[test]
fn images_on_every_bus() {
    let Some(bench) = Bench::new() else { return println!("{SKIPPED}") };
    let images = images();
    let [line, eip, can, profibus] =
        ["line", "eip", "can", "profibus"].map(|name| bench.path(&format!("{name}.pcapng")));
    let mut lines = CaptureWriter::append_streams(&line).unwrap();
    let mut datagrams = CaptureWriter::append(&eip).unwrap();
    let mut frames = CaptureWriter::append_packets(&can, LINKTYPE_CAN).unwrap();
    let mut telegrams = CaptureWriter::append_packets(&profibus, LINKTYPE_PROFIBUS_DL).unwrap();
    for (number, (direction, image)) in images.iter().enumerate() {
        let (is_sent, bytes) = (*direction == Direction::Sent, image.to_bytes());
        lines.line(at(number), *direction, &bytes).unwrap();
        let sequence = u32::try_from(number).unwrap();
        let cyclic = Cyclic { id: 7, sequence, count: 0, body: &bytes };
        let (own, controller) = ends(2222);
        let (from, to) = if is_sent { (own, controller) } else { (controller, own) };
        datagrams.datagram(at(number), from, to, &cyclic.emit(is_sent.then_some(RUN))).unwrap();
        let mac = Mac::new(5).unwrap();
        let id = if is_sent { Id::Poll(mac) } else { Id::PollAnswer(mac) };
        for (fragment, part) in bytes.chunks(7).enumerate() {
            let kind = if fragment == 0 {
                0
            } else if fragment == 6 {
                0x80
            } else {
                0x40
            };
            let data = [&[kind | u8::try_from(fragment).unwrap()], part].concat();
            frames.frame(at(number), &Frame::new(id.emit(), &data).unwrap().to_capture()).unwrap();
        }
        let body = [&if is_sent { [5, 2, 0x5D] } else { [2, 5, 0x08] }[..], &bytes].concat();
        let sum = body.iter().fold(0u8, |sum, byte| sum.wrapping_add(*byte));
        let len = u8::try_from(body.len()).unwrap();
        let telegram = [&[0x68, len, len, 0x68], &body[..], &[sum, 0x16]].concat();
        telegrams.frame(at(number), &telegram).unwrap();
        telegrams.frame(at(number), &telegram[..=number % telegram.len()]).unwrap();
    }
    for path in [line, eip, can, profibus] {
        assert!(bench.compare("yrcx", &path) > 200, "{}", path.display());
        // editcap cannot write the link type of PROFIBUS.
        if !path.ends_with("profibus.pcapng") {
            bench.damage(&path);
        }
    }
    for name in ["speed.pcapng", "profinet.pcapng"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/files").join(name);
        assert!(bench.compare("yrcx", &path) > 5, "{name}");
        bench.damage(&path);
    }
}

/// Wireshark decodes the messages. The image from the controller is in its input assembly, the other in its output assembly.
#[test]
fn images_in_explicit_messages() {
    let Some(bench) = Bench::new() else { return println!("{SKIPPED}") };
    let path = bench.path("explicit.pcapng");
    let mut writer = CaptureWriter::append_streams(&path).unwrap();
    let (own, controller) = ends(44818);
    let mut image = Image::default();
    (image.0[0], image.0[16]) = (0x0200, 2);
    for (number, instance) in [100, 150].into_iter().enumerate() {
        let context = u8::try_from(number).unwrap();
        let ask = encapsulated(context, &[0x0E, 3, 0x20, 4, 0x24, instance, 0x30, 3]);
        let answer = encapsulated(context, &[&[0x8E, 0, 0, 0], &image.to_bytes()[..]].concat());
        writer.segment(at(number), own, controller, &ask).unwrap();
        writer.segment(at(number), controller, own, &answer).unwrap();
    }
    let shown = |filter: &str| bench.tshark(&path, &["-Y", filter, "-T", "fields", "-e", "frame.number"]);
    assert_eq!(shown("armctl_yrcx.status == 0x200 && armctl_yrcx.so_cpu_ok == 1"), "2\n");
    assert_eq!(shown("armctl_yrcx.command == 0x200 && armctl_yrcx.si_servo_on == 1"), "4\n");
}

/// A message of `SendRRData`: header, interface and time-out, a null address, and the data.
fn encapsulated(context: u8, data: &[u8]) -> Vec<u8> {
    let [len, whole] = [data.len(), data.len() + 16].map(|len| u8::try_from(len).unwrap());
    let header = [&[0x6F, 0, whole, 0, 1, 0, 0, 0, 0, 0, 0, 0, context][..], &[0; 11]].concat();
    [&header[..], &[0; 6], &[2, 0, 0, 0, 0, 0, 0xB2, 0, len, 0], data].concat()
}

#[test]
fn traces_of_the_simulators() {
    let Some(bench) = Bench::new() else { return println!("{SKIPPED}") };
    for (family, lines) in [
        ("yerc", &["status", "position", "var get B0..B9 P0 R1 S2", "alarm history", "io get 1001", "file list"][..]),
        ("toyo", &["status", "point list", "param list", "alarm history"]),
        ("yrcx", &["info servo", "point get 0", "alarm list", "status"]),
    ] {
        for (number, line) in lines.iter().enumerate() {
            let path = bench.path(&format!("{family}{number}.pcapng"));
            let words: Vec<&str> = line.split(' ').collect();
            armctl(&[&["--sim", "--yes", "--trace", &name_of(&path), family], &words[..]].concat());
            assert!(bench.compare(family, &path) > 0, "{family} {line}");
        }
    }
}

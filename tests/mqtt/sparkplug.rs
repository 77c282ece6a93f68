//! Sparkplug messages through a real broker, decoded by another implementation.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use super::broker::{self, Listener, Mosquitto, NOT_INSTALLED, ReceivedMessage};
use super::{Publisher, fleet};

fn peers_folder() -> Option<PathBuf> {
    std::env::var_os("ARMCTL_SPARKPLUG_PEERS").map(PathBuf::from)
}

const NO_FOLDER: &str = "skipped: ARMCTL_SPARKPLUG_PEERS does not name a folder of tests/mqtt/peers/install";

/// Payloads of these messages, decoded by the package sparkplug-payload.
fn decoded(folder: &Path, heard: &[ReceivedMessage]) -> Vec<Value> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mqtt/peers/decode.js");
    let mut command = Command::new("node");
    command.arg(script).env("NODE_PATH", folder.join("node_modules")).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut process = command.spawn().expect("node runs");
    let lines: String = heard.iter().map(|heard| format!("{}\n", heard.payload)).collect();
    process.stdin.take().unwrap().write_all(lines.as_bytes()).unwrap();
    let output = process.wait_with_output().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// The next message with this type and device in its topic.
fn next(listener: &mut Listener, what: &str) -> ReceivedMessage {
    loop {
        let heard = listener.next();
        if heard.topic == what {
            return heard;
        }
    }
}

fn metric<'a>(payload: &'a Value, name: &str) -> &'a Value {
    payload["metrics"].as_array().unwrap().iter().find(|metric| metric["name"] == name).unwrap_or(&Value::Null)
}

#[test]
fn another_decoder_reads_births_data_and_deaths() {
    let (true, Some(folder)) = (broker::is_installed(), peers_folder()) else {
        return eprintln!("{NOT_INSTALLED}, or {NO_FOLDER}");
    };
    let broker = Mosquitto::start();
    let workspace = fleet();
    let mut listener = broker.listen_hex("spBv1.0/Plant/#");
    let words = ["-r", "press", "publish", &broker.url(), "--sparkplug", "--group", "Plant", "--node", "Cell7"];
    let also = ["--also", "parts=yerc var get B0", "--watch", "50ms", "--every", "100ms", "-v"];
    let mut publisher = Publisher::start(workspace.command(&[&words[..], &also].concat()));
    let heard = ["NBIRTH/Cell7", "DBIRTH/Cell7/press", "DDATA/Cell7/press"]
        .map(|what| next(&mut listener, &format!("spBv1.0/Plant/{what}")));
    assert!(heard.iter().all(|heard| !heard.is_kept));
    let payloads = decoded(&folder, &heard);
    let [node, birth, data] = &payloads[..] else { panic!("three payloads") };
    assert_eq!((&node["seq"], &birth["seq"], &data["seq"]), (&json!(0), &json!(1), &json!(2)));
    let rebirth = metric(node, "Node Control/Rebirth");
    assert_eq!((&rebirth["type"], &rebirth["value"]), (&json!("Boolean"), &json!(false)));
    assert_eq!((&metric(node, "bdSeq")["type"], &metric(node, "bdSeq")["value"]), (&json!("Int64"), &json!(0)));
    let x = metric(birth, "position/x_mm");
    assert_eq!((&x["type"], &x["properties"]["engUnit"]["value"]), (&json!("Double"), &json!("mm")));
    assert_eq!(metric(birth, "status/mode")["type"], "String");
    assert_eq!(metric(birth, "status/servo_on")["type"], "Boolean");
    let part = metric(birth, "parts/items/B0");
    assert_eq!(part["properties"]["kind"]["value"], "variable");
    assert!(part["type"] == "Int64" && part["value"].is_number(), "{birth}");
    let by_alias = data["metrics"].as_array().unwrap();
    assert!(by_alias.iter().all(|metric| metric["name"].is_null() && metric["alias"].is_number()), "{data}");
    let sent = by_alias.iter().find(|metric| metric["alias"] == x["alias"]).unwrap();
    assert_eq!((&sent["value"], &sent["type"]), (&x["value"], &json!("Double")));

    // A host can request the births again. All other commands of a host are ignored.
    let rebirth = b"\x12\x1a\x0a\x14Node Control/Rebirth\x20\x0b\x70\x01";
    broker.send("spBv1.0/Plant/NCMD/Cell7", b"\x12\x08\x0a\x02xx\x20\x0b\x70\x01", false);
    publisher.wait_for_message("armctl only publishes");
    // A request directly after a birth is delayed, and not ignored.
    broker.send("spBv1.0/Plant/NCMD/Cell7", rebirth, false);
    let second_birth = next(&mut listener, "spBv1.0/Plant/NBIRTH/Cell7");
    let second_birth = decoded(&folder, &[second_birth]).remove(0);
    assert_eq!((&second_birth["seq"], &metric(&second_birth, "bdSeq")["value"]), (&json!(0), &json!(0)));
    publisher.signal("-TERM");
    let death = next(&mut listener, "spBv1.0/Plant/NDEATH/Cell7");
    let death = &decoded(&folder, &[death])[0];
    assert_eq!(metric(death, "bdSeq")["value"], 0);
    assert_eq!(publisher.end().0, Some(0));

    // The next process uses the next number (bdSeq). When it is killed, the broker publishes its will.
    let publisher = Publisher::start(workspace.command(&words));
    let birth = next(&mut listener, "spBv1.0/Plant/NBIRTH/Cell7");
    publisher.signal("-KILL");
    let death = next(&mut listener, "spBv1.0/Plant/NDEATH/Cell7");
    let payloads = decoded(&folder, &[birth, death]);
    assert_eq!(
        (&metric(&payloads[0], "bdSeq")["value"], &metric(&payloads[1], "bdSeq")["value"]),
        (&json!(1), &json!(1))
    );
}

#[test]
fn waits_for_the_primary_host() {
    let (true, Some(folder)) = (broker::is_installed(), peers_folder()) else {
        return eprintln!("{NOT_INSTALLED}, or {NO_FOLDER}");
    };
    let broker = Mosquitto::start();
    let workspace = fleet();
    let mut listener = broker.listen_hex("spBv1.0/Plant/#");
    let words = ["-r", "press", "publish", &broker.url(), "--sparkplug", "--group", "Plant", "--node", "Cell7"];
    let host = ["--host", "SCADA", "--watch", "50ms", "--every", "50ms"];
    broker.send("spBv1.0/STATE/SCADA", b"{\"online\":false,\"timestamp\":1}", true);
    let mut publisher = Publisher::start(workspace.command(&[&words[..], &host].concat()));
    publisher.wait_for_message("waiting for the primary host SCADA");
    broker.send("spBv1.0/STATE/SCADA", b"{\"online\":true,\"timestamp\":2}", true);
    let first = listener.next();
    assert_eq!(first.topic, "spBv1.0/Plant/NBIRTH/Cell7");
    publisher.wait_for_message("is online");
    broker.send("spBv1.0/STATE/SCADA", b"{\"online\":false,\"timestamp\":3}", true);
    publisher.wait_for_message("is offline");
    let death = next(&mut listener, "spBv1.0/Plant/NDEATH/Cell7");
    assert_eq!(metric(&decoded(&folder, &[death])[0], "bdSeq")["value"], 0);
    publisher.wait_for_message("waiting for the primary host SCADA");
    broker.send("spBv1.0/STATE/SCADA", b"{\"online\":true,\"timestamp\":4}", true);
    // Death messages that arrive before this birth belong to the previous connection.
    let birth = next(&mut listener, "spBv1.0/Plant/NBIRTH/Cell7");
    let data = next(&mut listener, "spBv1.0/Plant/DDATA/Cell7/press");
    let payloads = decoded(&folder, &[birth, data]);
    assert_eq!(metric(&payloads[0], "bdSeq")["value"], 1);
    assert!(payloads[1]["metrics"].as_array().unwrap().iter().all(|metric| metric["isHistorical"] == true));
}

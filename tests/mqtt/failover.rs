//! A list of two real brokers.

use std::process::Output;

use serde_json::Value;

use super::broker::{self, Listener, Mosquitto, NOT_INSTALLED};
use super::{Publisher, Workspace, fleet, stderr};

/// Times of the messages up to the first one after `end`.
fn times_until(listener: &mut Listener, end: jiff::Timestamp) -> Vec<jiff::Timestamp> {
    let mut times: Vec<jiff::Timestamp> = Vec::new();
    while times.last().is_none_or(|last| *last < end) {
        let envelope: Value = serde_json::from_str(&listener.next().payload).unwrap();
        times.push(envelope["time"].as_str().unwrap().parse().unwrap());
    }
    times
}

fn publish(workspace: &Workspace, words: &[&str]) -> Output {
    workspace
        .run(&[&["-r", "press", "publish", "--node", "cell7", "--kinds", "status", "--count", "1"], words].concat())
}

#[test]
fn messages_go_to_the_broker_that_is_there() {
    let Some(mut first) = Mosquitto::start_if_installed() else { return };
    let mut second = Mosquitto::start();
    let (workspace, urls) = (fleet(), [first.url(), second.url()]);
    let words = ["-r", "press", "publish", &urls[0], &urls[1], "--node", "cell7", "--kinds", "status"];
    let often = ["--watch", "50ms", "--every", "1ms", "-v", "--json"];
    first.kill();
    let mut listener = second.listen("armctl/press/status");
    let mut publisher = Publisher::start(workspace.command(&[&words[..], &often].concat()));
    publisher.wait_for_message(&format!("; next broker: {}", urls[1]));
    publisher.wait_for_message(&format!("connected to {}", urls[1]));
    listener.next();
    // The second broker dies. The first one comes back, and gets what the second one did not acknowledge.
    second.kill();
    publisher.wait_for_message("next try in");
    first.start_again();
    let (mut listener, restarted) = (first.listen("armctl/press/status"), jiff::Timestamp::now());
    publisher.wait_for_message(&format!("connected to {} after", urls[0]));
    assert!(times_until(&mut listener, restarted).is_sorted());
    // Both are away at the end. The next process sends the stored messages, also with another order of the list.
    first.kill();
    publisher.wait_for_message("next try in");
    // The next round is a second later, so the robot was polled in the meantime.
    publisher.wait_for_message("next try in");
    publisher.signal("-TERM");
    publisher.wait_for_message("stored on disk");
    let (code, report) = publisher.end();
    assert_eq!((code, &report["data"]["dropped"]), (Some(0), &0.into()));
    let ended = jiff::Timestamp::now();
    second.start_again();
    let mut listener = second.listen("armctl/press/status");
    let output = publish(&workspace, &[&urls[1]]);
    assert!(output.status.success(), "{}", stderr(&output));
    assert_eq!(times_until(&mut listener, ended).len(), 1, "one broker alone is another list");
    let output = publish(&workspace, &[&urls[1], &urls[0]]);
    assert!(output.status.success(), "{}", stderr(&output));
    let times = times_until(&mut listener, ended);
    assert!(times.len() > 1 && times.is_sorted(), "{times:?}");
}

#[test]
fn second_broker_helps_if_the_first_refuses_the_password() {
    if !broker::is_installed() {
        return eprintln!("{NOT_INSTALLED}");
    }
    let (first, second) = (Mosquitto::with("allow_anonymous false\n", |_| {}), Mosquitto::start());
    let workspace = fleet();
    let output = publish(&workspace, &[&first.url(), &second.url(), "--json"]);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((output.status.code(), &report["data"]["broker"]), (Some(0), &second.url().into()));
    assert!(stderr(&output).contains("not authorized to connect (check --user"), "{}", stderr(&output));
    // A second process with the same node must not use one of the brokers.
    let mut publisher = Publisher::start(workspace.command(&["publish", &second.url(), "--node", "cell7"]));
    publisher.wait_for_message("connected to");
    let output = publish(&workspace, &[&first.url(), &second.url()]);
    assert!(stderr(&output).contains("another armctl publishes as 'cell7'"), "{}", stderr(&output));
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn sparkplug_node_follows_its_primary_host() {
    let Some(first) = Mosquitto::start_if_installed() else { return };
    let (second, workspace) = (Mosquitto::start(), fleet());
    let state = |broker: &Mosquitto, state: &str| broker.send("spBv1.0/STATE/SCADA", state.as_bytes(), true);
    state(&first, "{\"online\":false,\"timestamp\":100}");
    state(&second, "{\"online\":true,\"timestamp\":1}");
    let mut listeners = [&first, &second].map(|broker| broker.listen_hex("spBv1.0/Plant/#"));
    let (first_url, second_url) = (first.url(), second.url());
    let words = ["-r", "press", "publish", &first_url, &second_url, "--sparkplug", "--group", "Plant"];
    let host = ["--node", "Cell7", "--host", "SCADA", "--watch", "50ms", "--every", "50ms"];
    let publisher = Publisher::start(workspace.command(&[&words[..], &host].concat()));
    assert_eq!(listeners[1].next().topic, "spBv1.0/Plant/NBIRTH/Cell7");
    state(&first, "{\"online\":true,\"timestamp\":101}");
    state(&second, "{\"online\":false,\"timestamp\":2}");
    // The first broker has got no message before. The second one publishes one death message, and no last will.
    assert_eq!(listeners[0].next().topic, "spBv1.0/Plant/NBIRTH/Cell7");
    listeners[1].wait_for("spBv1.0/Plant/NDEATH/Cell7", |_| true);
    second.send("spBv1.0/Plant/end", b"x", false);
    assert_eq!(listeners[1].next().topic, "spBv1.0/Plant/end");
    publisher.signal("-TERM");
    listeners[0].wait_for("spBv1.0/Plant/NDEATH/Cell7", |_| true);
    assert_eq!(publisher.end().0, Some(0));
}

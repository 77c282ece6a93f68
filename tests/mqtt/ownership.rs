//! Which broker gets a stored message, and who clears a retained one.

use std::path::Path;

use serde_json::Value;

use super::broker::{self, Listener, Mosquitto, NOT_INSTALLED, ReceivedMessage};
use super::{Publisher, Workspace, fleet, stderr};

fn envelope(received: &ReceivedMessage) -> Value {
    serde_json::from_str(&received.payload).unwrap_or_default()
}

fn time(received: &ReceivedMessage) -> jiff::Timestamp {
    envelope(received)["time"].as_str().unwrap().parse().unwrap()
}

/// Number of records in the segments of all spools in this folder. A record has its length, a checksum, and its fields.
fn records_on_disk(root: &Path) -> usize {
    let mut count = 0;
    for folder in std::fs::read_dir(root).unwrap() {
        for file in std::fs::read_dir(folder.unwrap().path()).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|suffix| suffix != "spool") {
                continue;
            }
            let bytes = std::fs::read(path).unwrap();
            let mut rest = &bytes[..];
            while let Some((len, _)) = rest.split_first_chunk::<4>() {
                rest = &rest[12 + usize::try_from(u32::from_le_bytes(*len)).unwrap()..];
                count += 1;
            }
        }
    }
    count
}

/// Retained messages of these topics, for the user `reader`.
fn retained(broker: &Mosquitto, topics: &str) -> Vec<ReceivedMessage> {
    let mut listener = Listener::new(broker.port, topics, "%r %t %p", &["-u", "reader"]);
    // The broker sends this message after all retained messages.
    let end = topics.replace('#', "the/end");
    broker.send(&end, b"x", false);
    std::iter::from_fn(|| Some(listener.next()).filter(|received| received.topic != end)).collect()
}

fn topics(received: &[ReceivedMessage]) -> Vec<&str> {
    let mut topics: Vec<&str> = received.iter().map(|received| &received.topic[..]).collect();
    topics.sort_unstable();
    topics
}

/// The broker is away from the start, or it is lost while messages are on their way.
#[test]
fn killed_publisher_loses_no_message_and_sends_none_to_another_broker() {
    if !broker::is_installed() {
        return eprintln!("{NOT_INSTALLED}");
    }
    for is_lost in [false, true] {
        let (mut broker, other) = (Mosquitto::start(), Mosquitto::start());
        let (workspace, url) = (fleet(), broker.url());
        let root = workspace.folder.path().join("buffers");
        let buffer = ["--node", "cell7", "--kinds", "status", "--buffer-dir", root.to_str().unwrap()];
        let words = ["-r", "press", "publish", &url, "--watch", "50ms", "--every", "1ms", "-v"];
        if !is_lost {
            broker.kill();
        }
        let mut publisher = Publisher::start(workspace.command(&[&words[..], &buffer].concat()));
        if is_lost {
            publisher.wait_for_message("connected to");
            broker.listen("armctl/press/status").next();
            broker.kill();
        }
        publisher.wait_for_message("next try in");
        // The second try is a second later, so the robots were polled in the meantime.
        publisher.wait_for_message("next try in");
        publisher.signal("-KILL");
        assert_eq!(publisher.end().0, None);
        let killed = jiff::Timestamp::now();
        let stored = records_on_disk(&root);
        assert!(stored > 5, "{stored}");

        let mut listener = other.listen("armctl/press/status");
        let words = ["-r", "press", "publish", &other.url(), "--count", "1"];
        let output = workspace.run(&[&words[..], &buffer].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        assert!(time(&listener.next()) > killed, "the other broker gets only new messages");
        assert_eq!(records_on_disk(&root), stored);

        broker.start_again();
        let mut listener = broker.listen("armctl/press/status");
        let words = ["-r", "press", "publish", &url, "--count", "1"];
        let output = workspace.run(&[&words[..], &buffer].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let mut times = vec![time(&listener.next())];
        while times.last().is_none_or(|last| *last < killed) {
            times.push(time(&listener.next()));
        }
        assert!(times.is_sorted(), "{times:?}");
        assert_eq!(times.len(), stored + 1);
        assert_eq!(records_on_disk(&root), 0);
    }
}

#[test]
fn reports_a_spool_without_a_broker_and_never_sends_it() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let workspace = fleet();
    let root = workspace.folder.path().join("buffers");
    let old = root.join("armctl-cell7/00000001099511627776.spool");
    std::fs::create_dir_all(old.parent().unwrap()).unwrap();
    std::fs::write(&old, b"records").unwrap();
    let words = ["publish", &broker.url(), "--node", "cell7", "--count", "1", "--buffer-dir", root.to_str().unwrap()];
    let output = workspace.run(&words);
    let warning = format!("{}: messages of an earlier version", old.parent().unwrap().display());
    assert!(output.status.success() && stderr(&output).contains(&warning), "{}", stderr(&output));
    assert_eq!(std::fs::read(&old).unwrap(), b"records");
}

#[test]
fn next_start_clears_what_it_no_longer_publishes() {
    if !broker::is_installed() {
        return eprintln!("{NOT_INSTALLED}");
    }
    for protocol in ["5", "3.1.1"] {
        let broker = Mosquitto::start();
        let workspace = fleet();
        let url = broker.url();
        let publish = ["publish", &url, "--kinds", "status", "--protocol", protocol, "--node"];
        let run = |options: &[&str], more: &[&str]| {
            let output = workspace.run(&[options, &publish, more].concat());
            assert!(output.status.success(), "{}", stderr(&output));
        };
        let mut listener = broker.listen("armctl/picker/status");
        let publisher = Publisher::start(workspace.command(&[&publish[..], &["cell7"]].concat()));
        let status = listener.next();
        assert_eq!(envelope(&status)["node"], "cell7");
        publisher.signal("-KILL");
        assert_eq!(publisher.end().0, None);
        // The robot left the inventory of this node, and another node publishes it.
        run(&["-r", "picker"], &["cell8", "--count", "1"]);
        let robots = [("press", "yerc", "sim:"), ("loader", "toyo", "sim:")];
        workspace.write(&robots);
        run(&[], &["cell7", "--count", "1"]);
        let all = ["cell7/state", "cell8/state", "loader/status", "picker/status", "press/status"];
        let left = retained(&broker, "armctl/#");
        assert_eq!(topics(&left), all.map(|topic| format!("armctl/{topic}")));
        let picker = left.iter().find(|received| received.topic == "armctl/picker/status").unwrap();
        assert_eq!(envelope(picker)["node"], "cell8");
        // The robot left the selection, then the prefix and the template changed.
        run(&["-r", "press"], &["cell7", "--count", "1"]);
        assert!(!topics(&retained(&broker, "armctl/#")).contains(&"armctl/loader/status"));
        let template = ["cell7", "--count", "1", "--prefix", "plant", "--topic", "{prefix}/{node}/{robot}/{kind}"];
        run(&[], &template);
        let left = ["armctl/cell8/state", "armctl/picker/status"];
        assert_eq!(topics(&retained(&broker, "armctl/#")), left);
        let new = ["plant/cell7/loader/status", "plant/cell7/press/status", "plant/cell7/state"];
        assert_eq!(topics(&retained(&broker, "plant/#")), new);
    }
}

#[test]
fn clears_topics_that_it_may_not_read() {
    if !broker::is_installed() {
        return eprintln!("{NOT_INSTALLED}");
    }
    let broker = Mosquitto::with("allow_anonymous true\nacl_file FOLDER/acl\n", |folder| {
        std::fs::write(folder.join("acl"), "topic write armctl/#\nuser reader\ntopic read #\n").unwrap();
    });
    let (workspace, url) = (fleet(), broker.url());
    let publish = ["publish", &url, "--kinds", "status", "--node", "cell7", "--count", "1"];
    for (options, robots) in [(&["-r", "press,loader"][..], &["loader", "press"][..]), (&["-r", "press"], &["press"])] {
        let output = workspace.run(&[options, &publish].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let expected: Vec<String> = robots.iter().map(|robot| format!("armctl/{robot}/status")).collect();
        assert_eq!(topics(&retained(&broker, "armctl/#"))[1..], expected);
    }
}

#[test]
fn retained_messages_of_robots_expire() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let workspace = Workspace::new(&[("press", "yerc", "sim:")]);
    let mut listener = Listener::new(broker.port, "armctl/#", "%r %t %E", &["-V", "5"]);
    let words = ["publish", &broker.url(), "--node", "cell7", "--count", "1", "--kinds", "status", "--every", "2m"];
    let output = workspace.run(&words);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut expiry = |topic: &str| listener.wait_for(topic, |_| true).payload;
    assert_eq!([expiry("armctl/cell7/state"), expiry("armctl/press/status")], ["", "360"]);
}

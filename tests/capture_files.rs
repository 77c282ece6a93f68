//! Capture files: cut files, and comparison with tshark if it is installed. The files in
//! `tests/cli/files/` were written by hand from the specifications of the formats. The transcript `captures` shows
//! their content.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use armctl_transport::capture::{Carrier, OpenError, read};

const FILES: [&str; 3] = ["vlan.pcap", "lines.pcapng", "speed.pcapng"];

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli/files").join(name)
}

fn file(name: &str) -> Vec<u8> {
    std::fs::read(path(name)).expect("the file is in the repository")
}

/// Packet number and bytes of all datagrams.
fn datagrams(file: &[u8]) -> Vec<(u64, Vec<u8>)> {
    let mut all = Vec::new();
    let messages = read(file, |message| {
        if let Carrier::Datagram { .. } = message.carrier {
            all.push((message.number, message.bytes.to_vec()));
        }
    });
    assert_eq!(messages.expect("it is a capture").damage, None);
    all
}

#[test]
fn reads_times_of_every_clock() {
    let mut times = Vec::new();
    let summary = read(&*file("lines.pcapng"), |message| times.push((message.number, message.time.as_secs_f64())));
    let first = summary.expect("it is a capture").first.as_secs_f64();
    times.sort_by_key(|(number, _)| *number);
    // The interfaces of the file count time in nanoseconds, 1/1024 s and microseconds. One packet has no time.
    let expected = [(3, 0.002), (5, 4.0 / 1024.0), (6, 0.006), (7, 0.005), (8, 1.0), (9, 1.01), (10, 1.01), (11, 1.03)];
    for ((number, time), (expected_number, expected)) in times.iter().zip(expected) {
        assert_eq!(*number, expected_number);
        assert!((time - first - expected).abs() < 1e-6, "packet {number} at {}", time - first);
    }
    assert_eq!(times.len(), expected.len());
}

#[test]
fn tshark_finds_the_same_datagrams() {
    for name in FILES {
        let fields = ["-T", "fields", "-e", "frame.number", "-e", "udp.payload"];
        let Ok(output) = Command::new("tshark").arg("-r").arg(path(name)).args(fields).output() else {
            return;
        };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let text = String::from_utf8_lossy(&output.stdout);
        let tshark_datagrams: Vec<(u64, String)> = text
            .lines()
            .filter_map(|line| line.split_once('\t').filter(|(_, payload)| !payload.is_empty()))
            .map(|(number, payload)| (number.parse().expect("a number"), payload.to_owned()))
            .collect();
        let hex = |bytes: Vec<u8>| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
        let own_datagrams: Vec<(u64, String)> =
            datagrams(&file(name)).into_iter().map(|(number, bytes)| (number, hex(bytes))).collect();
        assert_eq!(own_datagrams, tshark_datagrams, "{name}");
    }
}

#[test]
fn truncated_file_yields_the_messages_before_the_cut() {
    for name in FILES {
        let complete = file(name);
        let all = datagrams(&complete);
        let mut problems = BTreeSet::new();
        for end in 0..complete.len() {
            let mut part = Vec::new();
            let heard = read(&complete[..end], |message| {
                if let Carrier::Datagram { .. } = message.carrier {
                    part.push((message.number, message.bytes.to_vec()));
                }
            });
            match heard {
                Ok(summary) => {
                    assert_eq!(part, all[..part.len()], "{name} cut at {end}");
                    if let Some(damage) = summary.damage {
                        assert!(damage.offset <= end, "{damage} in {end} bytes of {name}");
                        problems.insert(damage.problem);
                    }
                }
                Err(error) => assert!(end < 24 && error == OpenError::Other, "{name} cut at {end}: {error}"),
            }
        }
        assert!(problems.iter().all(|problem| problem.starts_with("the file ends inside")), "{problems:?}");
    }
}

//! Tests of every command line of the family at the gate: its risk, and the risk in a dry run.

use super::testing::{Bench, DX200, dry_run, resolve_robot};
use crate::face::FACE;
use crate::prelude::basics::*;
use armctl_controller::Risk::{self, Destroy, Motion, Read, Write};
use armctl_controller::text::unhex;
use armctl_controller::yerc::wire::RequestFrame;
use armctl_frame::testing;

/// Commands that send no frames.
const LOCAL_COMMANDS: [&str; 1] = ["names forget"];

/// Lines for each command, by their first word, with files in `DIR`, and their risk.
const LINES: &[(&str, Risk, &[&str])] = &[
    ("status", Read, &[""]),
    ("alarm", Read, &["list", "watch", "history"]),
    ("alarm", Write, &["reset", "cancel"]),
    ("job", Read, &["show", "list", "show --source", "show --path", "show A --path", "search A", "calls", "check"]),
    ("job", Write, &["select A", "stop"]),
    ("job", Destroy, &["edit A"]),
    ("job", Motion, &["start", "start --wait", "start A --repeat 3 --stats"]),
    ("file", Read, &["list", "get A.JBI --dir DIR/new", "diff A.JBI DIR/A.JBI"]),
    ("file", Write, &["cmos --start-only"]),
    ("file", Destroy, &["put DIR/A.JBI", "put DIR/A.JBI --replace --verify", "delete A.JBI"]),
    ("backup", Read, &["DIR/new"]),
    ("restore", Destroy, &["DIR/backup --force"]),
    ("diff", Read, &["DIR/backup"]),
    ("position", Read, &[""]),
    ("axes", Read, &[""]),
    ("position-error", Read, &[""]),
    ("torque", Read, &[""]),
    ("teach", Destroy, &["P5"]),
    ("var", Read, &["get B0", "watch B0", "list B0..B9", "dump DIR/new.csv"]),
    ("var", Write, &["set B0=1"]),
    ("var", Destroy, &["set B0=1 P1.tool=2", "set EX1=pulse:1=5", "copy P1 P2"]),
    ("io", Read, &["get 10010", "watch 10010", "list"]),
    ("io", Write, &["set 27010=on"]),
    ("register", Read, &["get 1", "watch 1", "list", "dump DIR/registers.csv"]),
    ("register", Write, &["set 1=1", "copy 1 2", "restore DIR/words.csv"]),
    ("names", Read, &["get", "forget"]),
    ("servo", Motion, &["on", "off"]),
    ("hold", Write, &["on", "off"]),
    ("stop", Write, &[""]),
    ("hlock", Write, &["on"]),
    ("cycle", Write, &["once"]),
    ("say", Write, &["HELLO"]),
    (
        "move",
        Motion,
        &[
            "joint --to 1,2,3,4,5,6 --speed 1%",
            "linear --to 1,2,3,4,5,6 --speed 1mm/s",
            "joint --to P2 --speed 1%",
            "linear --to EX1 --group S1 --speed 1mm/s",
            "relative --z 1 --speed 1mm/s",
            "pulse joint --pulses 1,2,3,4,5,6 --speed 1%",
            "pulse linear --pulses 1,2,3,4,5,6 --speed 1mm/s",
        ],
    ),
    ("hours", Read, &[""]),
    ("info", Read, &[""]),
    ("raw", Read, &["--command 0x72 --instance 1 --service 0x01"]),
    ("raw", Write, &["--command 0x7A --instance 1 --attribute 1 --service 0x10 --data 01"]),
    (
        "raw",
        Destroy,
        &[
            "--command 0x7F --instance 1 --attribute 3 --service 0x10 --data 01000000",
            "--file --service 0x09 --data 412e4a4249",
        ],
    ),
    ("raw", Motion, &["--command 0x90 --instance 1 --service 0x01"]),
];

/// Lines whose frames have a lower risk, because the row or the file determines the requests.
const BY_ROWS: [&str; 2] = ["var copy B0 B1", "var restore DIR/dump.csv"];

/// Creates the files that the lines use.
fn prepare(folder: &Path) {
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    std::fs::write(path("A.JBI"), "/JOB\r\n//NAME A\r\nNOP\r\nEND\r\n").unwrap();
    std::fs::write(path("dump.csv"), "name,value\nB0,7\n").unwrap();
    std::fs::write(path("words.csv"), "name,value\nM1,7\n").unwrap();
    Bench::new("sim:").data(&["backup", &path("backup")]);
}

/// Risk of a frame. Bytes that depend on an answer count as 0.
fn risk_of(frame: &Value) -> Risk {
    let bytes = unhex(&frame["hex"].as_str().expect("hexadecimal").replace("??", "00")).expect("hexadecimal");
    let frame = RequestFrame::parse(&bytes).expect("a request");
    Request::from(frame).risk()
}

#[test]
fn every_command_passes_the_gate_according_to_its_risk() {
    let folder = tempfile::tempdir().unwrap();
    prepare(folder.path());
    let folder = folder.path().to_str().unwrap();
    let mut tested = BTreeSet::new();
    let lines = LINES
        .iter()
        .flat_map(|(word, risk, rests)| rests.iter().map(move |rest| (format!("{word} {rest}"), *risk, *risk)));
    for (line, risk, most) in lines.chain(BY_ROWS.map(|line| (line.to_owned(), Destroy, Write))) {
        let line = line.trim_end().replace("DIR", folder);
        let words: Vec<&str> = line.split(' ').collect();
        let (robot, command) = resolve_robot(DX200, &words).unwrap();
        tested.insert(command.id().to_owned());
        let intent = command.intent(Some(&robot));
        assert_eq!(intent.risk, risk, "{line}");
        assert!(risk < Destroy || !intent.text.is_empty(), "{line}: what is asked says what will happen");
        assert_eq!(intent.is_stop, ["hold on", "stop", "job stop"].contains(&line.as_str()), "{line}");

        let frames = dry_run(DX200, &words).unwrap_or_else(|failure| panic!("{line}: {failure:?}"));
        let shown = frames.iter().map(risk_of).max();
        // A command that changes only data on this computer does not affect other clients.
        let expected = Some(most).filter(|_| !LOCAL_COMMANDS.contains(&line.as_str()));
        assert_eq!(shown, expected, "{line}: {frames:?}");
    }
    let mut leaves = BTreeSet::new();
    collect(&testing::family(&FACE), "yerc", &mut leaves);
    // `job show` with --path has its own report.
    leaves.insert("yerc.job.path".to_owned());
    assert_eq!(tested, leaves);
}

fn collect(command: &clap::Command, id: &str, all: &mut BTreeSet<String>) {
    let mut subcommands =
        command.get_subcommands().filter(|sub| !["repl", "help"].contains(&sub.get_name())).peekable();
    if subcommands.peek().is_none() {
        all.insert(id.to_owned());
    }
    for sub in subcommands {
        collect(sub, &format!("{id}.{}", sub.get_name()), all);
    }
}

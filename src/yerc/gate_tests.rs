//! Tests of every command line of the family at the gate: its risk, read-only robots, and the risk in a dry run.

use std::collections::BTreeSet;

use serde_json::Value;

use super::testing::{Bench, DX200, dry_run, resolve_robot};
use crate::link::Yerc;
use armctl_controller::Risk::{self, Destroy, Motion, Read, Write};
use armctl_controller::text::unhex;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::RequestFrame;
use armctl_frame::face::registration::Registered;
use armctl_frame::failure::Kind;
use armctl_frame::gate::Gate;
use armctl_frame::testing;
use armctl_frame::testing::QUIET;

/// Commands that send no frames.
const LOCAL_COMMANDS: [&str; 1] = ["names forget"];

/// A line for each command, with files in `DIR`. Each has its risk and the maximum risk of its frames.
const LINES: &[(&str, Risk, Risk)] = &[
    ("status", Read, Read),
    ("alarm list", Read, Read),
    ("alarm watch", Read, Read),
    ("alarm history", Read, Read),
    ("alarm reset", Write, Write),
    ("alarm cancel", Write, Write),
    ("job show", Read, Read),
    ("job select A", Write, Write),
    ("job start", Motion, Motion),
    ("job start --wait", Motion, Motion),
    ("job start A --repeat 3 --stats", Motion, Motion),
    ("job list", Read, Read),
    ("job show --source", Read, Read),
    ("job stop", Write, Write),
    ("job edit A", Destroy, Destroy),
    ("file list", Read, Read),
    ("file get A.JBI --dir DIR/new", Read, Read),
    ("file put DIR/A.JBI", Destroy, Destroy),
    ("file put DIR/A.JBI --replace --verify", Destroy, Destroy),
    ("file delete A.JBI", Destroy, Destroy),
    ("file diff A.JBI DIR/A.JBI", Read, Read),
    ("backup DIR/new", Read, Read),
    ("restore DIR/backup --force", Destroy, Destroy),
    ("diff DIR/backup", Read, Read),
    ("file cmos --start-only", Write, Write),
    ("position", Read, Read),
    ("axes", Read, Read),
    ("position-error", Read, Read),
    ("torque", Read, Read),
    ("teach P5", Destroy, Destroy),
    ("var get B0", Read, Read),
    ("var watch B0", Read, Read),
    ("var list B0..B9", Read, Read),
    ("var set B0=1", Write, Write),
    ("var set B0=1 P1.tool=2", Destroy, Destroy),
    ("var set EX1=pulse:1=5", Destroy, Destroy),
    ("var dump DIR/new.csv", Read, Read),
    ("var copy B0 B1", Destroy, Write),
    ("var copy P1 P2", Destroy, Destroy),
    // The rows of the file determine the requests.
    ("var restore DIR/dump.csv", Destroy, Write),
    ("io get 10010", Read, Read),
    ("io watch 10010", Read, Read),
    ("io list", Read, Read),
    ("io set 27010=on", Write, Write),
    ("register get 1", Read, Read),
    ("register set 1=1", Write, Write),
    ("register watch 1", Read, Read),
    ("register list", Read, Read),
    ("register copy 1 2", Write, Write),
    ("register dump DIR/registers.csv", Read, Read),
    ("register restore DIR/words.csv", Write, Write),
    ("names get", Read, Read),
    ("names forget", Read, Read),
    ("servo on", Motion, Motion),
    ("servo off", Motion, Motion),
    ("hold on", Write, Write),
    ("stop", Write, Write),
    ("hold off", Write, Write),
    ("hlock on", Write, Write),
    ("cycle once", Write, Write),
    ("say HELLO", Write, Write),
    ("move joint --to 1,2,3,4,5,6 --speed 1%", Motion, Motion),
    ("move linear --to 1,2,3,4,5,6 --speed 1mm/s", Motion, Motion),
    ("move joint --to P2 --speed 1%", Motion, Motion),
    ("move linear --to EX1 --group S1 --speed 1mm/s", Motion, Motion),
    ("move relative --z 1 --speed 1mm/s", Motion, Motion),
    ("move pulse joint --pulses 1,2,3,4,5,6 --speed 1%", Motion, Motion),
    ("move pulse linear --pulses 1,2,3,4,5,6 --speed 1mm/s", Motion, Motion),
    ("hours", Read, Read),
    ("info", Read, Read),
    ("raw --command 0x72 --instance 1 --service 0x01", Read, Read),
    ("raw --command 0x7A --instance 1 --attribute 1 --service 0x10 --data 01", Write, Write),
    ("raw --command 0x7F --instance 1 --attribute 3 --service 0x10 --data 01000000", Destroy, Destroy),
    ("raw --file --service 0x09 --data 412e4a4249", Destroy, Destroy),
    ("raw --command 0x90 --instance 1 --service 0x01", Motion, Motion),
];

/// Creates the files that the lines use.
fn prepare(folder: &std::path::Path) {
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
    for (line, risk, most) in LINES {
        let line = line.replace("DIR", folder);
        let words: Vec<&str> = line.split(' ').collect();
        let (mut robot, command) = resolve_robot(DX200, &words).unwrap();
        tested.insert(command.id().to_owned());
        let intent = command.intent(Some(&robot));
        assert_eq!(intent.risk, *risk, "{line}");
        assert!(*risk < Destroy || !intent.text.is_empty(), "{line}: what is asked says what will happen");
        assert_eq!(intent.is_stop, ["hold on", "stop", "job stop"].contains(&line.as_str()), "{line}");

        robot.read_only.value = true;
        let passed = Gate { yes: true, ..Gate::default() }.must_ask(&QUIET, &robot, &intent);
        if *risk == Read || intent.is_stop {
            assert_eq!(passed, Ok(false), "{line}");
        } else {
            assert_eq!(passed.unwrap_err().kind, Kind::Rejected, "{line}");
        }

        let frames = dry_run(DX200, &words).unwrap_or_else(|failure| panic!("{line}: {failure:?}"));
        let shown = frames.iter().map(risk_of).max();
        // A command that changes only data on this computer does not affect other clients.
        let expected = Some(*most).filter(|_| !LOCAL_COMMANDS.contains(&line.as_str()));
        assert_eq!(shown, expected, "{line}: {frames:?}");
    }
    let mut leaves = BTreeSet::new();
    collect(&testing::family(&Registered::<Yerc>::FACE), "yerc", &mut leaves);
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

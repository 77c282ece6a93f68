//! Tests of every command: its risk, a missing confirmation, and whether a dry run shows the blocks that are sent.

use std::sync::OnceLock;

use serde_json::Value;

use super::testing::{Bench, Fault, ReceivedBlocks, gate_input, plan, text};
use crate::prelude::*;
use armctl_controller::Risk::{Destroy, Motion, Read, Write};
use armctl_controller::toyo::table::commands::Row;
use armctl_frame::CommandSet as _;
use armctl_frame::testing::complete_frames;

/// Every command with its highest risk. `FOLDER` stands for a folder with the files of [`prepared`].
#[rustfmt::skip]
const LINES: &[(&str, Risk)] = &[
    ("status", Read), ("home", Motion), ("home --sync 1 --no-wait", Motion), ("position", Read), ("host on", Write),
    ("mode program", Write), ("servo off", Motion), ("stop", Write), ("stop --jog", Write), ("reset", Write),
    ("alarm list", Read), ("alarm watch", Read), ("alarm history", Read), ("alarm reset", Write), ("alarm point", Read),
    ("run sequential 1", Motion), ("run palletizing --program 1", Motion), ("run easy --program 1", Motion),
    ("run point 1", Motion), ("jog X + inch", Motion), ("jog 2 - low --for 500ms", Motion),
    ("param list", Read), ("param get P01", Read), ("param watch P01", Read), ("param dump FOLDER/p.csv", Read),
    ("param set P01 ax2=150", Destroy), ("param set P01 1 2 3 4", Destroy), ("param set E22 1000 0 0 0", Destroy),
    ("param restore FOLDER/parameters.csv", Destroy),
    ("point get 1", Read), ("point list", Read), ("point watch 1", Read), ("teach 1", Destroy), ("point set 1 z=5", Destroy), ("point set 1 1 2 3 4", Destroy),
    ("point get 1 --task 2", Write), ("point copy 1 2", Destroy), ("point dump FOLDER/taught.csv 1-2", Read),
    ("point restore FOLDER/points.csv --task 2", Destroy),
    ("speed-table get 1", Read), ("speed-table watch 1", Read), ("speed-table set 1 77", Destroy), ("speed-table list", Read), ("speed-table dump FOLDER/speed.csv", Read),
    ("speed-table copy 2 3", Destroy), ("speed-table restore FOLDER/rows.csv", Destroy),
    ("accel-table get 1", Read), ("accel-table watch 1", Read), ("accel-table set 1 0.77", Destroy), ("accel-table list", Read), ("accel-table dump FOLDER/accel.csv", Read),
    ("accel-table copy 2 1", Destroy), ("accel-table restore FOLDER/times.csv", Destroy),
    ("torque-table get 1", Read), ("torque-table watch 1", Read), ("torque-table set 1 load=1", Destroy), ("torque-table list", Read), ("torque-table dump FOLDER/torque.csv", Read),
    ("torque-table copy 1 2", Destroy), ("torque-table restore FOLDER/limits.csv", Destroy),
    ("mvm get 1", Read), ("mvm watch 1", Read), ("mvm set 1 pieces1=9 approach-z=1", Destroy), ("mvm list", Read), ("mvm copy 1 2", Destroy),
    ("mvm dump FOLDER/mvm.csv 1", Read), ("mvm restore FOLDER/groups.csv", Destroy),
    ("program list", Read), ("program get", Read), ("program diff FOLDER/program.txt", Read), ("program show", Read), ("program show --path", Read), ("program show 2 --path", Write), ("program search 5", Write), ("program search MOVP", Read), ("program search MOVP --task 2", Write),
    ("program calls", Read), ("program check", Read),
    ("program put FOLDER/program.txt", Destroy), ("program put FOLDER/program.txt --keep-rest", Destroy),
    ("program insert 1 HOME --task 2", Destroy), ("program delete 1", Destroy), ("program delete 1 --to 2", Destroy),
    ("program copy 1 2 --at 3", Destroy), ("program copy 1 2 --at 3 --from-task 1 --to-task 2", Destroy),
    ("palletizing get 1", Read), ("palletizing set 1 end 7", Destroy), ("palletizing set 1 start tag=7", Destroy),
    ("palletizing list 1", Read), ("palletizing dump FOLDER/pallet.csv 1", Read), ("palletizing restore FOLDER/records.csv 1", Destroy),
    ("palletizing copy 2 1", Destroy), ("palletizing select 1", Write), ("palletizing progress", Read),
    ("easy get 1", Read), ("easy set 1 1 2 3", Destroy), ("easy set 1 loop=9", Destroy), ("easy copy 2 1", Destroy),
    ("easy list", Read), ("easy dump FOLDER/easy.csv", Read), ("easy restore FOLDER/programs.csv", Destroy),
    ("easy select 1", Write), ("easy progress", Read),
    ("backup FOLDER/new", Write), ("restore FOLDER/backup --only easy,palletizing-1 --force", Destroy),
    ("restore FOLDER/backup --only points-1 --force", Destroy), ("diff FOLDER/backup", Write),
    ("io get IN1.1", Read), ("io list", Read), ("io watch", Read), ("io set OUT1.1=on", Write), ("io direct 1", Write),
    ("counter get 1", Read), ("counter watch 1", Read), ("counter set 1 5", Write), ("counter list", Read),
    ("counter dump FOLDER/counter.csv", Read), ("counter copy 1 2", Write), ("counter restore FOLDER/counts.csv", Write),
    ("timer get 1", Read), ("timer list", Read), ("timer watch 1", Read),
    ("override get", Read), ("override set 50", Write), ("task get", Read), ("task set 1", Write),
    ("offset", Read), ("coordinate set 0 0 0 0", Motion), ("bus", Read), ("card read", Destroy), ("card write", Destroy),
    ("init points", Destroy), ("robot-type 1 0", Destroy), ("info", Read),
    ("raw @MTSK", Read), ("raw @HSON", Write), ("raw @DSTX~0001", Destroy), ("raw @HOME", Motion),
];

/// Start state of the controller, with programs and points of a user.
const STATE: &str = "origin = true\nhost = false\ncard = \"empty\"\n\
    points = { 1 = { 1 = [10.0, 20.0, 0.0, 0.0] }, 2 = { 1 = [1.0, 0.0, 0.0, 0.0] } }\n\
    steps = { 1 = [\"TAG TAG=005\", \"SPD V=05\", \"SPD V=06\", \"END\"], \
    2 = [\"HOME\", \"SPD V=01\", \"SPD V=02\", \"END\", \"END\"] }\n";

/// Command lines that add data to the start state.
const BEFORE: [&str; 10] = [
    "point set 2 7 7 7 7",
    "mvm set 2 pieces1=4",
    "torque-table set 2 load=2",
    "counter set 1 3",
    "easy set 1 5 6 7",
    "easy set 2 5 6 8",
    "palletizing set 1 end 5",
    "palletizing set 2 end 6",
    "mvm set 1 pieces1=3 approach-z=5",
    "point set 1 9 9 9 9",
];

/// A controller with user data, a folder with files, and the blocks that the controller receives from now on.
fn prepared(line: &str) -> (Bench, ReceivedBlocks, tempfile::TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("parameters.csv", "name,value\nM09,J\nE06,ax1=900 ax2=900 ax3=900 ax4=900\n");
    write("points.csv", "name,x_mm,y_mm,z_mm,r_mm\n1,5,5,5,5\n2,6,6,6,6\n");
    write("rows.csv", "name,speed_mm_s\n1,77\n");
    write("times.csv", "name,time_s\n1,0.77\n");
    write("groups.csv", "name,pieces1\n1,9\n");
    write("records.csv", "name,value\nend,7\n");
    write("limits.csv", "name,load\n1,1\n");
    write("programs.csv", "name,loops\n1,9\n");
    write("counts.csv", "name,count\nCN01,5\n");
    write("program.txt", "TAG TAG=005\nSPD V=05\nEND\n");
    if !line.starts_with("restore") && !line.starts_with("diff") {
        let (bench, received) = Bench::after(STATE, changes());
        return (bench, received, folder);
    }
    let (mut bench, received) = Bench::with_faults(STATE, |_, _| Fault::None);
    let backup = folder.path().join("backup");
    bench.data(&["backup", backup.to_str().unwrap()]);
    change(&mut bench);
    received.borrow_mut().clear();
    (bench, received, folder)
}

fn change(bench: &mut Bench) {
    for line in BEFORE {
        bench.data(&line.split(' ').collect::<Vec<_>>());
    }
    bench.end();
}

/// Blocks that write the data of [`BEFORE`].
fn changes() -> &'static [String] {
    static BLOCKS: OnceLock<Vec<String>> = OnceLock::new();

    BLOCKS.get_or_init(|| {
        let (mut bench, received) = Bench::with_faults(STATE, |_, _| Fault::None);
        change(&mut bench);
        let received = received.borrow();
        received.iter().filter(|block| risk(block) >= Write).cloned().collect()
    })
}

fn words(line: &str, folder: &tempfile::TempDir) -> Vec<String> {
    let folder = folder.path().to_str().unwrap();
    line.split(' ').map(|word| word.replace("FOLDER", folder).replace('~', " ")).collect()
}

/// Risk of a block. The block can contain `?`.
fn risk(block: &str) -> Risk {
    if block.starts_with("@JGST") {
        let moves = ["+", "-", "?"].iter().any(|way| block.contains(way));
        return if moves { Motion } else { Write };
    }
    let word = block.trim_start_matches('@').split(' ').next().unwrap();
    Request::parse(block).map_or_else(|_| Row::named(word).map_or(Write, |row| row.risk), |request| request.risk())
}

#[test]
fn the_table_has_every_command() {
    let listed: BTreeSet<&str> = {
        let (_, _, folder) = prepared("");
        let id = |line: &str| {
            let words = words(line, &folder);
            gate_input(&words.iter().map(String::as_str).collect::<Vec<_>>()).1
        };
        LINES.iter().map(|(line, _)| id(line)).collect()
    };
    // The editor has a separate transcript.
    let offline = ["toyo.ports", "toyo.program.edit", "toyo.sim.run"];
    let missing: Vec<&str> = super::commands::Commands::schemas().iter().map(|entry| entry.id).collect();
    let missing: Vec<&str> = missing.into_iter().filter(|id| !listed.contains(id) && !offline.contains(id)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn without_confirmation_no_command_changes_anything() {
    let mut wrong = Vec::new();
    for (line, expected_risk) in LINES {
        let (mut bench, received, folder) = prepared(line);
        let words = words(line, &folder);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let (intent, _) = gate_input(&words);
        assert_eq!(intent.risk, *expected_risk, "{line}");
        let outcome = bench.run_without_confirmation(&words);
        bench.end();
        let destructive_blocks: Vec<String> =
            received.borrow().iter().filter(|block| risk(block) >= Destroy).cloned().collect();
        if *expected_risk >= Destroy {
            let kind = outcome.as_ref().err().map(|failure| failure.kind);
            // A block beyond the end is always refused.
            let is_expected =
                |message: &str| message.starts_with("not confirmed: ") || message.contains("would be lost");
            if kind != Some(Kind::Rejected) || !outcome.as_ref().is_err_and(|failure| is_expected(&failure.message)) {
                wrong.push(format!("{line}: {outcome:?}"));
            }
            if intent.confirmation != Confirmation::WhenKnown && !received.borrow().is_empty() {
                wrong.push(format!("{line}: sent before it was asked: {:?}", received.borrow()));
            }
        }
        if !destructive_blocks.is_empty() {
            wrong.push(format!("{line}: sent {destructive_blocks:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_dry_run_shows_the_blocks_that_are_sent() {
    let mut wrong = Vec::new();
    for (line, expected_risk) in LINES {
        let (mut bench, received, folder) = prepared(line);
        let words = words(line, &folder);
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let report = match plan(&words) {
            Ok(report) => report,
            Err(failure) => {
                wrong.push(format!("{line}: {failure}"));
                continue;
            }
        };
        let planned = complete_frames(&report);
        if !planned.iter().any(|frame| risk(&text(frame)) == *expected_risk) {
            wrong.push(format!("{line}: no frame has the risk of the command: {planned:?}"));
        }
        // The simulator refuses some commands. The blocks that were sent before the refusal count.
        let is_complete = bench.run(&words).is_ok_and(|(_, failure)| failure.is_none());
        bench.end();
        if let Err(why) = follows(&planned, &received.borrow(), is_complete && report["complete"] == true) {
            wrong.push(format!("{line}: {why}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Checks that the sent blocks match the plan. `?` matches any text, a block that depends on an answer can be absent,
/// and a block with "until" can repeat.
fn follows(planned: &[Value], sent: &[String], is_complete: bool) -> Result<(), String> {
    let is_open = |frame: &Value| frame["depends_on"].is_string();
    let is_poll = |frame: &Value| frame["about"].as_str().is_some_and(|about| about.contains("until"));
    let reachable = |mut at: usize| {
        let mut all = vec![at];
        while planned.get(at).is_some_and(is_open) {
            at += 1;
            all.push(at);
        }
        all
    };
    let mut positions = BTreeSet::from([0]);
    for (index, block) in sent.iter().enumerate() {
        let mut next = BTreeSet::new();
        for at in positions.iter().flat_map(|at| reachable(*at)) {
            if planned.get(at).is_some_and(|frame| fits(&text(frame), block)) {
                next.insert(at + 1);
            }
            if planned[..at].iter().any(|frame| is_poll(frame) && fits(&text(frame), block)) {
                next.insert(at);
            }
        }
        if next.is_empty() {
            let planned: Vec<String> = planned.iter().map(text).collect();
            return if is_complete {
                Err(format!("block {index}, {block}, was not planned\n  sent {sent:?}\n  planned {planned:?}"))
            } else {
                Ok(())
            };
        }
        positions = next;
    }
    let is_end = |at: &usize| reachable(*at).contains(&planned.len());
    if is_complete && !positions.iter().any(is_end) {
        let planned: Vec<String> = planned.iter().map(text).collect();
        return Err(format!("more was planned than sent\n  sent {sent:?}\n  planned {planned:?}"));
    }
    Ok(())
}

fn fits(planned: &str, sent: &str) -> bool {
    let mut rest = sent;
    let parts: Vec<&str> = planned.split('?').collect();
    let [first, middle @ ..] = &parts[..] else { return false };
    let Some(remaining) = rest.strip_prefix(first) else { return false };
    rest = remaining;
    for part in middle {
        // Each `?` stands for at least one character.
        let Some(at) = rest.get(1..).and_then(|rest| if part.is_empty() { Some(rest.len()) } else { rest.find(part) })
        else {
            return false;
        };
        rest = &rest[1 + at + part.len()..];
    }
    rest.is_empty()
}

#[test]
fn a_confirmation_shows_old_and_new_and_empty_cells_need_none() {
    let (mut bench, received, _folder) = prepared("");
    let mut question_of = |line: &str| {
        let words: Vec<&str> = line.split(' ').collect();
        let failure = bench.run_without_confirmation(&words).expect_err(line);
        assert_eq!(failure.kind, Kind::Rejected, "{line}");
        failure.message.split(" this would ").nth(1).unwrap_or_default().to_owned()
    };
    for (line, question) in [
        ("param set P01 ax2=150", "overwrite a parameter (P01 (soft-limit-plus): ax2=1000.00 mm -> ax2=150.00 mm)"),
        ("point set 1 z=5", "overwrite a point of task 1 (point 1: z=9.00 mm -> z=5.00 mm)"),
        ("speed-table set 1 77", "overwrite a speed-table row (speed-table row 1: 10.0 mm/s -> 77.0 mm/s)"),
        ("easy set 1 loop=9", "overwrite an easy program (easy program 1: loops=6 -> loops=9)"),
        ("palletizing set 1 end 7", "overwrite a record of palletizing program 1 (end: 5 -> 7)"),
        (
            "program insert 1 HOME",
            "insert a step before step 1 of task 1 (step 1 (TAG TAG=005) and later steps move by one)",
        ),
        ("program delete 1", "delete a step of task 1 (step 1: TAG TAG=005)"),
        ("program delete 1 --to 3", "delete 3 steps of task 1 (step 1: TAG TAG=005, and 2 more)"),
        ("program delete 8", "delete a step of task 1 (step 8: NOP)"),
        ("program copy 2 2 --at 3", "overwrite a step of task 1 (step 3: SPD V=06 -> SPD V=05)"),
    ] {
        assert_eq!(question_of(line), question, "{line}");
    }
    let sent = received.borrow().iter().filter(|block| risk(block) >= Destroy).count();
    assert_eq!(sent, 0);
    // No confirmation is needed for values that are already equal, and for empty cells.
    for line in ["param set P01 ax2=1000", "point set 4 1 2 3 4", "point set 1 9 9 9 9", "easy set 5 1 2 3"] {
        let words: Vec<&str> = line.split(' ').collect();
        if let Err(failure) = bench.run_without_confirmation(&words) {
            panic!("{line}: {failure}");
        }
    }
    bench.wait(Duration::from_millis(1));
}

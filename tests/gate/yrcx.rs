//! Rules for YRCX controllers.

use super::workspace::Workspace;
use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

fn entry(url: &str, more: &str) -> String {
    format!("[[robot]]\nname = \"cell\"\ntarget = \"{url}\"\n{more}\n")
}

/// Creates an environment with a controller and an open session.
fn stored_point(controller: &Simulator) -> Workspace {
    let desk = Workspace::new(&entry(&controller.url, ""));
    assert_eq!(desk.run("-r cell session open --background").exit, Some(0));
    desk
}

#[test]
fn question_of_a_motion_through_a_session_has_numbers() {
    let controller = Simulator::start("yrcx");
    let desk = stored_point(&controller);
    assert_eq!(desk.run("-r cell yrcx point set 19 mm=30,40,0,90 --yes").exit, Some(0));
    assert_eq!(desk.run("-r cell yrcx origin --yes").exit, Some(0));
    for (line, said) in [
        ("move --point 19 --speed 20", &["axis 1: 0.000 -> 30.000 mm", "The target is 50.000 mm away."][..]),
        ("drive --axis 3 --to 10.5", &["axis 3: 0.000 -> 10.500 mm"]),
        ("move --point 77", &["The point could not be read."]),
        ("movei --by 1,2,3,4", &["This will move robot 1 by axis 1: 1 mm, axis 2: 2 mm"]),
    ] {
        desk.fails(&format!("-r cell yrcx {line}"), 7, "would move ");
        let mut terminal = Terminal::start(desk.command(&format!("-r cell yrcx {line}")), 100, 24).unwrap();
        terminal.wait_for_text("REAL CONTROLLER: cell (yrcx, ");
        for said in said {
            terminal.wait_for_text(said);
        }
        terminal.wait_for_text("Continue?");
        terminal.press("n\n");
        assert_eq!(terminal.end().code(), Some(7), "{line}");
    }
    // Another command writes the point during the question. If the new point differs, the answer is invalid.
    for (x, exit) in [("30", 0), ("31", 7)] {
        let mut terminal = Terminal::start(desk.command("-r cell yrcx move --point 19"), 100, 24).unwrap();
        terminal.wait_for_text("Continue?");
        assert_eq!(desk.run(&format!("-r cell yrcx point set 19 mm={x},40,0,90 --yes")).exit, Some(0));
        terminal.press("y\n");
        assert_eq!(terminal.end().code(), Some(exit), "{}", String::from_utf8_lossy(&terminal.written));
    }
    assert_eq!(desk.run("session close cell").exit, Some(0));
}

#[test]
fn asks_before_overwriting_taught_points() {
    let controller = Simulator::start("yrcx");
    let desk = stored_point(&controller);
    let point = || desk.data("-r cell yrcx point get 1")["items"][0]["value"]["text"].to_string();
    let before = point();
    for (order, old_and_new) in [
        ("point set 1 --mm 1,2,3,4", "point 1: 100.000, 100.000, 0.000, 0.000 mm -> 1.000, 2.000, 3.000, 4.000 mm"),
        ("teach --point 1 --in mm", "point 1: 100.000, 100.000, 0.000, 0.000 mm -> "),
        ("point-calc copy 3 --to 1", "100.000, 100.000, 0.000, 0.000 mm -> 200.000, -100.000, 0.000, 0.000 mm"),
        ("point-calc element 1 --element 1 --mm 5", "0.000 mm -> 5.000, 100.000, 0.000, 0.000 mm"),
        ("comment set 50 NEW", "comment of point 50: WAIT ORG -> NEW"),
        ("pallet-data set 10 2 2 1 1", "pallet 10: nx=10 ny=15 first_point=110 -> nx=2 ny=2 first_point=1"),
        ("shift-data set 4 1 2 3 4", "shift 4: axis_1_mm=10.000 axis_2_mm=0.000 axis_3_mm=0.000 axis_4_mm=0.000 -> "),
        ("hand-data set 1 1 1 2 3 0", "data_1=10000 data_2_mm=-2.000 data_3_mm=5.000 -> data_1=1 data_2_mm=2.000"),
        ("param set TOLE.1 100", "TOLE.1: 80 pulses -> 100 pulses"),
        ("raw --wi 0x100,1,1", "point 1: 100.000, 100.000, 0.000, 0.000 mm -> 0.000"),
    ] {
        desk.fails(&format!("-r cell yrcx {order}"), 7, old_and_new);
    }
    assert_eq!(point(), before);
    let stored = desk.data("-r cell yrcx point set 1 --mm 1,2,3,4 --yes");
    let old = "--mm 100.000,100.000,0.000,0.000".into();
    let stored = &stored["items"][0];
    assert_eq!((&stored["written"], &stored["old"]["text"]), (&true.into(), &old));
    // Equal data and new points need no confirmation.
    let again = desk.data("-r cell yrcx point set 1 --mm 1,2,3,4");
    assert_eq!(again["items"][0]["written"], false, "{again}");
    assert_eq!(desk.data("-r cell yrcx point set 7 --mm 1,2,3,4")["old"], serde_json::Value::Null);
    assert_eq!(desk.run("session close cell").exit, Some(0));
}

#[test]
fn typed_word_also_confirms_the_connection() {
    let desk = Workspace::new(&entry("eip://127.0.0.1:1", ""));
    let refused = desk.run("-r cell yrcx abs-reset --axis 2");
    assert_eq!(refused.exit, Some(7));
    for part in
        ["set the current position of axis 2 of robot 1 as its reset position", "and open the command connection"]
    {
        assert!(refused.stderr.contains(part), "{refused:?}");
    }
}

#[test]
fn restore_asks_once_with_old_and_new() {
    let controller = Simulator::start("yrcx");
    let desk = stored_point(&controller);
    desk.data("-r cell yrcx backup saved --only shifts,pallets");
    assert_eq!(desk.run("-r cell yrcx restore saved").exit, Some(0), "nothing differs");
    desk.data("-r cell yrcx shift-data set 4 1 2 3 4 --yes");
    desk.data("-r cell yrcx pallet-data set 10 2 2 1 1 --yes");
    for restore in ["yrcx restore saved", "restore saved"] {
        desk.fails(&format!("-r cell {restore}"), 7, "this would overwrite ");
    }
    desk.fails("-r cell yrcx restore saved", 7, "overwrite 2 values with the values in saved (shifts, shift 4: ");
    let restored = desk.data("-r cell yrcx restore saved --yes");
    let written: Vec<u64> =
        restored["files"].as_array().unwrap().iter().map(|item| item["written"].as_u64().unwrap()).collect();
    assert_eq!(written, [1, 1]);
    assert_eq!(desk.run("session close cell").exit, Some(0));
}

#[test]
fn reset_does_not_repeat() {
    let controller = Simulator::start("yrcx");
    let desk = Workspace::new(&entry(&controller.url, ""));
    // The command is refused before the connection is opened.
    desk.fails("-r cell yrcx alarm reset", 7, "alarm 12.551 (`armctl session open` keeps a connection open)");
    assert_eq!(desk.run("-r cell yrcx alarm reset --yes").exit, Some(0));
    let again = desk.run("-r cell yrcx alarm reset --yes");
    assert!(again.stderr.contains("raises alarm 12.551 again") && again.stderr.contains("`yrcx recover`"), "{again:?}");
    assert_eq!(desk.run("-r cell session open --background").exit, Some(0));
    let reset = desk.run("-r cell yrcx alarm reset");
    assert!(reset.exit == Some(0) && reset.stderr.contains("`yrcx recover`"), "{reset:?}");
    assert_eq!(desk.run("-r cell yrcx recover --yes").exit, Some(0));
    let status = desk.data("-r cell yrcx status");
    assert_eq!((&status["alarm"], &status["servo_on"]), (&false.into(), &true.into()));
    assert_eq!(desk.run("session close cell").exit, Some(0));
}

#[test]
fn read_only_controller_accepts_stops_and_reads() {
    let controller = Simulator::start("yrcx");
    let desk = Workspace::new(&entry(&controller.url, "read_only = true"));
    for order in ["info version", "alarm reset", "var set SGI1 1", "teach --point 1 --in mm", "run", "status --full"] {
        desk.fails(&format!("-r cell yrcx {order} --yes"), 7, "is read-only");
    }
    for look in ["status", "io get", "eip identity"] {
        assert_eq!(desk.run(&format!("-r cell yrcx {look}")).exit, Some(0), "{look}");
    }
    for stop in ["stop", "emergency-stop"] {
        assert_eq!(desk.run(&format!("-r cell yrcx {stop}")).exit, Some(0), "{stop}");
    }
}

#[test]
fn refuses_effects_that_end_with_the_connection_before_the_question() {
    let desk = Workspace::new(&entry("eip://127.0.0.1:1", ""));
    desk.fails("-r cell yrcx move --point 1 --no-wait", 2, "the connection ends with this command");
}

#[test]
fn dry_runs_plan_to_the_end() {
    let desk = Workspace::new(&entry("eip://127.0.0.1:1", ""));
    let set = desk.data("-r cell yrcx point set 7 --mm 1,2,3,4 --dry-run");
    let codes: Vec<&str> =
        set["frames"].as_array().unwrap().iter().map(|frame| frame["wi"][0].as_str().unwrap()).collect();
    assert_eq!(codes, ["0x0101", "0x0100"]);
    assert!(set["frames"][1]["depends_on"].as_str().unwrap().contains("written if different"));
    let run = desk.data("-r cell yrcx recover --dry-run");
    let edges: Vec<&str> =
        run["frames"].as_array().unwrap().iter().map(|frame| frame["about"].as_str().unwrap()).collect();
    assert_eq!(edges.len(), 5, "{edges:?}");
    let backup = desk.data("-r cell yrcx backup new --dry-run");
    assert_eq!(backup["complete"], false);
    assert!(backup["then"].as_str().unwrap().contains("comments"), "{}", backup["then"]);
}

//! Rules for Toyo controllers: an overwrite needs a confirmation, dry runs reach their end, and a stop is always
//! allowed.

use super::workspace::Workspace;
use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

fn desk(controller: &Simulator, more: &str) -> Workspace {
    Workspace::new(&format!("[[robot]]\nname = \"cell\"\ntarget = \"{}\"\n{more}\n", controller.url))
}

/// Returns the blocks of a dry run.
fn blocks(desk: &Workspace, line: &str) -> Vec<String> {
    let data = desk.data(&format!("-r cell toyo {line} --dry-run"));
    let frames = data["frames"].as_array().expect("frames").iter();
    frames.map(|frame| frame["text"].as_str().expect("a line").to_owned()).collect()
}

#[test]
fn overwriting_user_data_needs_confirmation() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "");
    for line in ["point set 7 1 2 3 4", "easy set 1 5 6 7", "program insert 1 TAG TAG=005 --yes"] {
        let output = desk.run(&format!("-r cell toyo {line}"));
        assert_eq!(output.exit, Some(0), "an empty cell needs no confirmation: {line}: {output:?}");
    }
    for (line, part) in [
        ("point set 7 z=5", "overwrite a point of task 1 (point 7: z=3.00 mm -> z=5.00 mm)"),
        ("easy set 1 loop=9", "overwrite an easy program (easy program 1: loops=6 -> loops=9)"),
        ("program insert 1 HOME", "insert a step before step 1 of task 1 (step 1 (TAG TAG=005) and"),
        ("program delete 1", "delete a step of task 1 (step 1: TAG TAG=005)"),
        ("param set P01 ax2=150", "overwrite a parameter (P01 (soft-limit-plus): ax2="),
        ("init points", "clear the coordinate table"),
        ("card write", "overwrite the content of the memory card"),
        ("raw @DSTX=0001", "send @DSTX=0001"),
    ] {
        desk.fails(&format!("-r cell toyo {line}"), 7, part);
        desk.fails(&format!("-r cell toyo {line}"), 7, "this would");
    }
    assert_eq!(desk.data("-r cell toyo point get 7")["items"][0]["value"]["z_mm"], 3.0);
    assert_eq!(desk.data("-r cell toyo easy get 1")["items"][0]["value"]["loops"], 6);
    assert!(desk.run("-r cell toyo program get --to 1").stdout.contains("TAG TAG=005"));
    // Writing equal values needs no confirmation.
    assert_eq!(desk.run("-r cell toyo point set 7 1 2 3 4").exit, Some(0));
    assert_eq!(desk.run("-r cell toyo point set 7 z=5 --yes").exit, Some(0));
    assert_eq!(desk.run("-r cell toyo program delete 1 --yes").exit, Some(0));
}

#[test]
fn the_confirmation_of_a_move_shows_positions_and_speed() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "");
    assert_eq!(desk.run("-r cell toyo point set 7=90,20,5,0 --yes").exit, Some(0));
    desk.fails("-r cell toyo run point 7", 7, "would move the axes to point 7 of the coordinate table");
    for (key, exit) in [("n\n", 7), ("y\n", 3)] {
        let mut terminal = Terminal::start(desk.command("-r cell toyo run point 7"), 80, 24).unwrap();
        for text in
            ["REAL CONTROLLER: cell", "X: 0.00 -> 90.00 mm", "Z: 0.00 -> 5.00 mm", "The speed override is 100 %."]
        {
            terminal.wait_for_text(text);
        }
        terminal.wait_for_text("Continue?");
        terminal.press(key);
        // The origin is not set, so the controller refuses a confirmed motion.
        assert_eq!(terminal.end().code(), Some(exit), "{}", String::from_utf8_lossy(&terminal.written));
    }
}

#[test]
fn an_offline_run_ends_at_its_time_limit() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "");
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("loop.toyo");
    std::fs::write(&program, "TAG TAG=001\nTIM TM=001.0\nJMP TAG=001\nEND\n").unwrap();
    let output = desk.run(&format!("toyo sim run {} --for 5s", program.display()));
    assert_eq!(output.exit, Some(8), "{output:?}");
    assert!(output.stderr.contains("after 5.000 s, the program still runs"), "{output:?}");
}

#[test]
fn the_confirmation_of_a_start_shows_program_step_position_and_speed() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "");
    for line in ["program insert 1 TAG TAG=005", "palletizing select 3", "easy select 2"] {
        assert_eq!(desk.run(&format!("-r cell --yes toyo {line}")).exit, Some(0), "{line}");
    }
    for (line, which) in [
        ("run sequential 1", "The program of task 1 begins at step 1: TAG TAG=005."),
        ("run sequential", "The program of task 1 begins at step 1: TAG TAG=005."),
        ("run palletizing", "It is palletizing program 3, at step"),
        ("run palletizing 4", "It is palletizing program 4; now the controller is at program 3, step"),
        ("run easy", "It is easy program 2, at step"),
    ] {
        let mut terminal = Terminal::start(desk.command(&format!("-r cell toyo {line}")), 100, 24).unwrap();
        terminal.wait_for_text(which);
        terminal.wait_for_text("The axes are at X 0.00, Y 0.00, Z 0.00, R 0.00 (mm).");
        terminal.wait_for_text("The speed override is 100 %.");
        terminal.wait_for_text("Continue?");
        terminal.press("n\n");
        assert_eq!(terminal.end().code(), Some(7), "{line}");
    }
}

#[test]
fn dry_runs_plan_to_the_end() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "read_only = true");
    assert_eq!(
        blocks(&desk, "param set P01 ax2=150"),
        [
            "@RPAR P01",
            "@STAS SNO=2",
            "@HSON",
            "@STAS SNO=0",
            "@WPAR P01 AX1=? AX2=+0150.00 AX3=? AX4=?",
            "@RPAR P01",
            "@HSOF"
        ]
    );
    assert_eq!(blocks(&desk, "status"), [0, 1, 2, 3, 4].map(|page| format!("@STAS SNO={page}")));
    for (line, block) in [
        ("point set 7 z=1", "@WPAR T1 PT=007 X=? Y=? Z=+0001.00 R=?"),
        ("palletizing set 1 start tag=7", "@WPLT 01 SNO=01 TAG=007 MOD=?"),
        ("mvm set 1 pieces1=9", "@WPAR T4 S2 GRP=01 P1=0009 P2=? P3=?"),
        ("easy set 1 loop=9", "@WESY PNO=01 ST=000 START=? LOOP=0009 END=?"),
        ("program insert 1 HOME", "@WSTX 0001 HOME"),
        ("program delete 1", "@DSTX 0001"),
        ("program search 5", "@SSTG TAG=005"),
        ("robot-type 1 7", "@TYPE AX1 RTYP=000007"),
        ("run point 1", "@EXTP PT=001"),
        ("home", "@HOME"),
        ("jog 2 + inch", "@JGST X=SP Y=+C Z=SP R=SP"),
    ] {
        let blocks = blocks(&desk, line);
        let at = blocks.iter().position(|sent| sent == block).unwrap_or_else(|| panic!("{line}: {blocks:?}"));
        assert!(blocks[..at].ends_with(&["@STAS SNO=0".to_owned()]) || line != "program search 5", "{blocks:?}");
        assert_eq!(blocks.last().unwrap(), "@HSOF", "{line}: it goes to the end");
    }
}

#[test]
fn stop_is_allowed_on_a_read_only_robot() {
    let controller = Simulator::start("toyo");
    let desk = desk(&controller, "read_only = true");
    assert_eq!(desk.run("-r cell toyo stop").exit, Some(0));
    assert_eq!(desk.run("-r cell toyo stop --jog").exit, Some(0));
    for order in ["point set 7 1 2 3 4 --yes", "host on", "home --yes", "jog X + inch --yes"] {
        desk.fails(&format!("-r cell toyo {order}"), 7, "is read-only");
    }
}

#[test]
fn without_a_terminal_a_jog_is_rejected_before_any_block_is_sent() {
    let desk = Workspace::new("[[robot]]\nname = \"cell\"\ntarget = \"tcp://127.0.0.1:1\"\n");
    desk.fails("-r cell toyo jog 2 + inch", 7, "move axis 2 by an inching step in plus direction");
}

//! Rules for Yaskawa controllers.

use serde_json::Value;

use super::workspace::Workspace;
use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

const JOB: &str = "/JOB\r\n//NAME NEW\r\n//POS\r\n///NPOS 0,0,0,0,0,0\r\n//INST\r\nNOP\r\nEND\r\n";

fn desk(controller: &Simulator) -> Workspace {
    let desk = Workspace::new(&format!("[[robot]]\nname = \"cell\"\ntarget = \"{}\"\n", controller.url));
    std::fs::write(desk.folder.path().join("NEW.JBI"), JOB).expect("it is written");
    std::fs::write(desk.folder.path().join("HOME.JBI"), JOB.replace("NEW", "HOME")).expect("it is written");
    desk
}

/// Returns the names of the jobs on the controller.
fn jobs(desk: &Workspace) -> Vec<String> {
    let data = desk.data("-r cell yerc file list");
    data["files"]
        .as_array()
        .expect("of the report")
        .iter()
        .map(|file| file["name"].as_str().expect("of the report").to_owned())
        .collect()
}

/// Frames of a dry run: command, instance and service of each frame, and whether the frame depends on an answer.
fn frames(desk: &Workspace, line: &str) -> Vec<(String, bool)> {
    let data = desk.data(&format!("-r cell yerc {line} --dry-run"));
    assert_eq!(data["complete"], true, "{line}");
    let head = |frame: &Value| {
        let hex = frame["hex"].as_str().expect("bytes");
        (format!("{} {} {}", &hex[48..52], &hex[52..56], &hex[58..60]), frame["depends_on"].is_string())
    };
    data["frames"].as_array().expect("frames").iter().map(head).collect()
}

#[test]
fn overwrites_and_deletes_files_only_after_confirmation() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    let before = jobs(&desk);
    desk.fails("-r cell yerc file delete HOME.JBI NONE.JBI", 7, "would delete 1 file on the controller (HOME.JBI)");
    desk.fails(
        "-r cell yerc file put HOME.JBI --replace",
        7,
        "would overwrite 1 file on the controller (HOME.JBI, with the ",
    );
    assert_eq!(jobs(&desk), before, "nothing was done");

    // A missing file is reported. A new file overwrites nothing, so it needs no confirmation.
    desk.fails("-r cell yerc file delete NONE.JBI", 3, "the file does not exist on the controller");
    assert_eq!(desk.run("-r cell yerc file put NEW.JBI").exit, Some(0));
    assert_eq!(desk.run("-r cell yerc file put HOME.JBI --replace --yes").exit, Some(0));
    assert_eq!(desk.run("-r cell yerc file delete NEW.JBI --yes").exit, Some(0));
    assert_eq!(jobs(&desk), before);
}

#[test]
fn restore_asks_only_about_differences() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    assert_eq!(desk.run("-r cell yerc backup saved").exit, Some(0));
    for restore in ["-r cell restore saved", "-r cell restore saved --machine"] {
        assert_eq!(desk.run(restore).exit, Some(0), "{restore}: nothing differs, so nothing is overwritten");
    }
    assert_eq!(desk.run("-r cell yerc file put HOME.JBI --replace --yes").exit, Some(0));
    for restore in ["-r cell restore saved", "-r cell restore saved --machine", "-r cell yerc restore saved"] {
        desk.fails(restore, 7, "would overwrite 1 file on the controller (HOME.JBI, with the ");
    }
    desk.fails("-r cell yerc restore saved --machine", 7, "would overwrite ");
    assert_eq!(desk.run("-r cell restore saved --yes").exit, Some(0));
    assert_eq!(desk.run("-r cell restore saved").exit, Some(0), "it is as it was");
}

/// No command sends the parameters of one controller to another controller.
#[test]
fn both_commands_refuse_parameters_of_another_controller() {
    let [one, other] = [Simulator::start("yerc"), Simulator::start("yerc")];
    let desk = desk(&one);
    assert_eq!(desk.run("-r cell yerc backup saved").exit, Some(0));
    let url = &other.url;
    for restore in ["restore saved --machine", "yerc restore saved --machine"] {
        desk.fails(&format!("-t {url} {restore} --yes"), 7, "the backup is from ");
    }
}

#[test]
fn restores_variables_after_a_question_with_old_and_new() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    assert_eq!(desk.run("-r cell yerc var set B7=7 R3=1.5").exit, Some(0), "to set one is a write");
    assert_eq!(desk.run("-r cell yerc var set P7=pulse:s=1,l=2,u=3,r=4,b=5,t=6").exit, Some(0), "nothing was taught");
    assert_eq!(desk.run("-r cell yerc var dump saved.csv B,R,P7").exit, Some(0));
    let written = |data: &Value| {
        let items = data["items"].as_array().unwrap().iter().filter(|item| item["written"] == true);
        items.map(|item| item["name"].as_str().unwrap().to_owned()).collect::<Vec<_>>()
    };
    let data = desk.data("-r cell yerc var restore saved.csv");
    assert_eq!((data["items"].as_array().unwrap().len(), written(&data)), (201, vec![]));
    assert_eq!(desk.run("-r cell yerc var set B7=9").exit, Some(0));
    assert_eq!(written(&desk.data("-r cell yerc var restore saved.csv")), ["B7"]);
    assert_eq!(desk.run("-r cell yerc var set B7=9 P7.axis1=9 --yes").exit, Some(0));
    desk.fails("-r cell yerc var restore saved.csv", 7, "would overwrite a variable (P7: pulse:s=9,");
    let data = desk.data("-r cell yerc var restore saved.csv --yes");
    assert_eq!(written(&data), ["B7", "P7"]);
}

#[test]
fn every_verb_asks_before_overwriting_a_taught_position() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    let sets = "-r cell yerc var set";
    let setup = desk.run(&format!("{sets} P9=pulse:s=1,l=2,u=3,r=4,b=5,t=6 BP6=pulse:1=1 EX3=pulse:1=9"));
    assert_eq!(setup.exit, Some(0), "nobody taught what is there: {setup:?}");
    let stored = || desk.data("-r cell yerc var get P9 BP6 EX3")["items"].to_string();
    let before = stored();
    let variable = "07000000";
    for (line, old_and_new) in [
        ("var set P9=pulse:s=7,l=2,u=3,r=4,b=5,t=6".to_owned(), "(P9: pulse:s=1,l=2,u=3,r=4,b=5,t=6"),
        ("var set B1=1 P9.tool=3".to_owned(), "tool=0,user=0 -> pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=3"),
        ("var set BP6.axis1=7".to_owned(), "(BP6: pulse:1=1 -> pulse:1=7)"),
        ("var set EX3=pulse:1=7".to_owned(), "(EX3: pulse:1=9 -> pulse:1=7)"),
        ("teach P9".to_owned(), "overwrite P9"),
        (format!("raw --command 0x7F --instance 9 --attribute 6 --service 0x10 --data {variable}"), "-> pulse:s=7"),
        (
            format!("raw --command 0x81 --instance 3 --service 0x02 --data 00000000{}", variable.repeat(8)),
            "(EX3: pulse:1=9",
        ),
        (
            format!("raw --command 0x309 --instance 3 --service 0x34 --data 0100000000000000{}", variable.repeat(8)),
            "(EX3: ",
        ),
        // If a request cannot be decoded, the question is about the request as a whole.
        ("raw --command 0x309 --instance 3 --service 0x34 --data 01".to_owned(), "send a raw request"),
    ] {
        desk.fails(&format!("-r cell yerc {line}"), 7, old_and_new);
    }
    assert_eq!(stored(), before);
    assert_eq!(desk.data("-r cell yerc var get B1")["items"][0]["value"], 0, "nothing of the line was written");
    // Data that is equal or new needs no confirmation.
    for line in ["P9=pulse:s=1,l=2,u=3,r=4,b=5,t=6", "P9.tool=0 BP6.axis1=1", "EX4=pulse:1=9"] {
        assert_eq!(desk.run(&format!("{sets} {line}")).exit, Some(0), "{line}");
    }
    let data = desk.data(&format!("{sets} BP6.axis1=7 --yes"));
    let pulses = |side: &str| &data["items"][0][side]["axis_1_pulses"];
    assert_eq!((pulses("old"), pulses("new")), (&1.into(), &7.into()));
    assert_eq!(
        desk.run(&format!(
            "-r cell yerc raw --command 0x7F --instance 9 --attribute 6 --service 0x10 --data {variable} --yes"
        ))
        .exit,
        Some(0)
    );
    assert_eq!(desk.data("-r cell yerc var get P9")["items"][0]["value"]["s_pulses"], 7);
}

#[test]
fn starts_a_job_by_its_name() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    desk.fails("-r cell yerc job start", 7, "would start the selected job");
    assert_eq!(desk.run("-r cell yerc servo on --yes").exit, Some(0));
    assert_eq!(desk.run("-r cell yerc job select TESTJOB").exit, Some(0));
    assert_eq!(desk.data("-r cell yerc job start --yes")["program"], "TESTJOB");
    assert_eq!(frames(&desk, "job start"), [("7300 0100 01".to_owned(), false), ("8600 0100 10".to_owned(), false)]);
}

/// The job that starts must be the job in the question.
#[test]
fn does_not_start_a_job_that_changed_during_the_question() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    assert_eq!(desk.run("-r cell yerc servo on --yes").exit, Some(0));
    for (meanwhile, exit) in [("MAIN", 7), ("COUNT", 0)] {
        assert_eq!(desk.run("-r cell yerc job select COUNT").exit, Some(0));
        let mut terminal = Terminal::start(desk.command("-r cell yerc job start"), 100, 30).unwrap();
        terminal.wait_for_text("This will start job COUNT.");
        terminal.wait_for_text("Continue?");
        assert_eq!(desk.run(&format!("-r cell yerc job select {meanwhile}")).exit, Some(0));
        terminal.press("y\n");
        assert_eq!(terminal.end().code(), Some(exit), "{}", String::from_utf8_lossy(&terminal.written));
    }
}

/// The question shows the start and target of each axis. If the robot moves during the question, the answer is invalid.
#[test]
fn question_of_a_motion_has_numbers() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    assert_eq!(desk.run("-r cell yerc servo on --yes").exit, Some(0));
    let line = "-r cell yerc move linear --to 1030,40,1200,180,0,0 --speed 200mm/s";
    desk.fails(line, 7, "would move R1 in a straight line to x=1030.000 y=40.000 ");
    for (key, meanwhile, exit) in [
        ("n\n", None, 7),
        ("y\n", Some("-r cell yerc move relative --z 10 --speed 200mm/s --yes"), 7),
        ("y\n", Some("-r cell yerc move relative --z -10 --speed 200mm/s --yes --no-wait --dry-run"), 0),
    ] {
        let mut terminal = Terminal::start(desk.command(line), 80, 30).unwrap();
        terminal.wait_for_text("REAL CONTROLLER: cell (yerc, udp://127.0.0.1:");
        terminal.wait_for_text("This will move R1 in a straight line at 200.0 mm/s:");
        terminal.wait_for_text("X: 1000.000 -> 1030.000 mm");
        terminal.wait_for_text("Y: 0.000 -> 40.000 mm");
        terminal.wait_for_text("s at least.");
        terminal.wait_for_text("In base coordinates, tool 0, form ");
        terminal.wait_for_text("Continue?");
        if let Some(meanwhile) = meanwhile {
            assert_eq!(desk.run(meanwhile).exit, Some(0));
        }
        terminal.press(key);
        let exit_code = terminal.end().code();
        let written = String::from_utf8_lossy(&terminal.written).into_owned();
        assert_eq!(exit_code, Some(exit), "{written}");
        assert!(written.contains("\u{1b}[1;31mREAL CONTROLLER:\u{1b}[0m"), "{written}");
        assert_eq!(written.contains(" moved after the confirmation"), exit == 7 && meanwhile.is_some(), "{written}");
    }
    assert_eq!(desk.data("-r cell yerc position --coordinates base")["positions"][0]["y_mm"], 40.0);
}

#[test]
fn dry_run_plans_to_the_end() {
    let controller = Simulator::start("yerc");
    let desk = desk(&controller);
    let shown = |line: &str| {
        let purposes = |(head, depends): (String, bool)| if depends { format!("{head}?") } else { head };
        frames(&desk, line).into_iter().map(purposes).collect::<Vec<_>>().join(", ")
    };
    let heads = [
        ("status", "7200 0100 01, 0a03 0100 01?"),
        ("position", "7500 0100 01, 7500 6500 01, 7400 0100 01?, 7400 6500 01?"),
        ("torque", "7700 0100 01, 7400 0100 01?"),
        (
            "move linear --to 1,2,3,4,5,6 --speed 1mm/s",
            "7500 0b00 01, 7400 0b00 01?, 7500 6500 01, 7400 6500 01?, 8a00 0200 02, 7200 0100 01, 7500 6500 01, \
             7000 0100 01?",
        ),
        ("io set 27010=on", "7800 8d0a 0e, 7800 8d0a 10?"),
        ("var set P1.tool=2", "7f00 0100 01, 7f00 0100 02?"),
        ("register set 1=1", "7900 0100 0e, 7900 0100 10?"),
        ("file put NEW.JBI", "0000 0000 32, 0000 0000 32?, 0000 0000 15, 0000 0000 15, 0000 0000 32?, 0000 0000 32?"),
        ("file delete HOME.JBI", "0000 0000 32, 0000 0000 32?, 0000 0000 09?"),
    ];
    for (line, expected) in heads {
        assert_eq!(shown(line), expected, "{line}");
    }
    assert!(jobs(&desk).contains(&"HOME.JBI".to_owned()), "nothing was sent");
}

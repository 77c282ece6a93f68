use serde_json::Value;
use tempfile::TempDir;

use crate::prelude::basics::*;
use crate::testing::{Bench, blocks, without_robot};

/// The program in the sample session of the manual (TO 3-1).
const SAMPLE: &str = "SPD V=5\nMOVP a PT=1 CN=0 S V=0 POST\nOUT STN=0 PN1=.......1\nEND\n";

/// A controller, and a folder for its programs.
struct Workspace {
    bench: Bench,
    folder: TempDir,
}

impl Workspace {
    fn new() -> Self {
        Self::with("")
    }

    fn with(state: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("state.toml");
        std::fs::write(&path, state).unwrap();
        Self { bench: Bench::new(&format!("sim:?state={}", path.display())), folder }
    }

    fn file(&self, text: &str) -> String {
        let path: PathBuf = self.folder.path().join("program.txt");
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    }

    fn put(&mut self, text: &str, more: &[&str]) -> Result<Value> {
        let file = self.file(text);
        self.bench.run(&[&["program", "put", &file], more].concat()).map(|(data, _)| data)
    }

    fn text(&mut self, more: &[&str]) -> String {
        let data = self.bench.data(&[&["program", "get"], more].concat());
        data["text"].as_str().unwrap().to_owned()
    }

    fn failure(&mut self, words: &[&str]) -> Failure {
        self.bench.run(&[&["program"], words].concat()).expect_err("it fails")
    }
}

#[test]
fn a_program_is_stored_and_read_back() {
    let mut workspace = Workspace::new();
    let stored = workspace.put(SAMPLE, &[]).unwrap();
    assert_eq!((&stored["cells_written"], &stored["cells_unchanged"]), (&4.into(), &1996.into()));
    assert_eq!(
        workspace.text(&[]),
        "SPD V=05\nMOVP a PT=001 CN=00 S V=00 POST\nOUT STN=0 PN01=.......1\nEND\n# 1996 NOP at the end of the \
         program are omitted\n"
    );
    assert_eq!(workspace.bench.data(&["status"])["mode"], "automatic", "the mode is as it was found");
    let again = workspace.put(SAMPLE, &[]).unwrap();
    assert_eq!((&again["cells_written"], &again["cells_unchanged"]), (&0.into(), &2000.into()));
}

#[test]
fn the_sample_session_of_the_manual_ends_at_its_place_with_its_output_on() {
    let mut workspace = Workspace::with("points = { 1 = { 1 = [100.0, 20.0, 0.0, 0.0] } }");
    workspace.put(SAMPLE, &[]).unwrap();
    workspace.bench.data(&["home"]);
    let ran = workspace.bench.data(&["run", "sequential", "1", "--wait"]);
    assert_eq!(ran["position"]["text"], "x=100.00 y=20.00 z=0.00 r=0.00");
    let out = workspace.bench.data(&["raw", "@MOUT SNO=0 GN=1"]);
    assert!(out["answer"].as_str().unwrap().contains("PN01=00000001"), "{out}");
}

#[test]
fn clears_the_rest_of_a_longer_program() {
    let mut workspace = Workspace::new();
    workspace.put("a: NOP\nJMP TAG=a\nTAG TAG=9\nEND\n", &[]).unwrap();
    let stored = workspace.put("SPD V=1\nEND\n", &[]).unwrap();
    assert_eq!((&stored["cells_written"], &stored["cleared_steps"]), (&5.into(), &3.into()));
    assert_eq!(workspace.text(&["--to", "6", "--numbers"]).lines().nth(2), Some("0003  NOP"));
    let stored = workspace.put("SPD V=2\n", &["--keep-rest"]).unwrap();
    assert_eq!(stored["cleared_steps"], 0);
    assert!(workspace.text(&[]).starts_with("SPD V=02\nEND\n"));
}

#[test]
fn a_part_takes_tags_that_are_free() {
    let mut workspace = Workspace::new();
    workspace.put("TAG TAG=1\nNOP\nNOP\nNOP\nTAG TAG=2\nEND\n", &[]).unwrap();
    let stored = workspace.put("x: CNT+ CN1=1\nJMPC TAG=x CN1<5\n", &["--at", "2"]).unwrap();
    assert_eq!(stored["labels"][0], serde_json::json!({ "name": "x", "tag": 3, "step": 2, "line": 1 }));
    let text = workspace.text(&[]);
    let steps: Vec<&str> = text.lines().take(6).map(|line| line.split("  #").next().unwrap()).collect();
    assert_eq!(
        steps,
        ["TAG TAG=001", "TAG TAG=003", "CNT+ CN01=0001", "JMPC TAG=003 CN01< 0005", "TAG TAG=002", "END"]
    );
    let failure = workspace.put("TAG TAG=2\n", &["--at", "2"]).unwrap_err();
    assert_eq!(failure.kind, Kind::Usage);
    assert!(
        failure.message.contains("tag 002 already exists in a step before or after the steps of this file"),
        "{}",
        failure.message
    );
    assert!(workspace.put("JMP TAG=7\n", &["--at", "2"]).is_err(), "there is no such tag around it");
    assert!(workspace.put("JMP TAG=2\n", &["--at", "2"]).is_ok());
}

#[test]
fn a_program_must_fit_its_task() {
    let mut workspace = Workspace::new();
    let failure = workspace.put(SAMPLE, &["--task", "2"]).unwrap_err();
    assert_eq!(
        (failure.kind, failure.message.as_str()),
        (Kind::Usage, "task 2 has no steps, but the command needs step 4")
    );
    let failure = workspace.put(SAMPLE, &["--at", "1998"]).unwrap_err();
    assert_eq!(failure.message, "task 1 has 2000 steps, but the command needs step 2001");
}

#[test]
fn selects_another_task_temporarily() {
    let mut workspace = Workspace::with("steps = { 2 = [\"NOP\", \"NOP\", \"NOP\", \"NOP\", \"NOP\"] }");
    workspace.put(SAMPLE, &["--task", "2"]).unwrap();
    assert!(workspace.text(&["--task", "2"]).starts_with("SPD V=05\n"));
    assert!(workspace.text(&[]).starts_with("NOP\n"), "task 1 is the current one again");
    let listed = workspace.bench.data(&["program", "list", "--used"]);
    let task = |index: usize| (&listed["tasks"][index]["used_steps"], &listed["tasks"][index]["room_steps"]);
    assert_eq!(task(1), (&4.into(), &5.into()));
    assert_eq!(task(2), (&Value::Null, &0.into()));
    assert_eq!(listed["tasks"][0]["current"], true);
    assert_eq!(workspace.bench.data(&["program", "show"])["task"], 1);
}

#[test]
fn steps_are_inserted_and_deleted() {
    let mut workspace = Workspace::new();
    workspace.put(SAMPLE, &[]).unwrap();
    let inserted = workspace.bench.data(&["program", "insert", "2", "acc", "a=1"]);
    assert_eq!(inserted["inserted"], serde_json::json!({ "step": 2, "instruction": "ACC A=01", "in_manual": true }));
    assert!(workspace.text(&[]).starts_with("SPD V=05\nACC A=01\nMOVP"));
    let deleted = workspace.bench.data(&["program", "delete", "1", "--to", "2"]);
    assert_eq!(deleted["deleted"][1]["instruction"], "ACC A=01");
    workspace.bench.data(&["program", "delete", "1"]);
    assert!(workspace.text(&[]).starts_with("OUT STN=0 PN01=.......1\nEND\n"));
}

#[test]
fn insert_loses_no_step_at_the_end() {
    let mut workspace = Workspace::with("steps = { 2 = [\"NOP\", \"END\"] }");
    let failure = workspace.failure(&["insert", "1", "--task", "2"]);
    assert_eq!(failure.kind, Kind::Rejected);
    assert_eq!(failure.message, "step 2, the last step of task 2, would be lost: END");
    assert_eq!(workspace.text(&["--task", "2"]), "NOP\nEND\n");
}

#[test]
fn steps_are_copied_and_tags_found() {
    let mut workspace = Workspace::with("steps = { 2 = [\"NOP\", \"NOP\", \"NOP\", \"NOP\", \"NOP\"] }");
    workspace.put("NOP\nTAG TAG=7\nHOME\nEND\n", &[]).unwrap();
    let copied = workspace.bench.data(&["program", "copy", "2", "4", "--at", "3", "--to-task", "2"]);
    assert_eq!(copied["was_there"], false);
    assert_eq!(workspace.text(&["--task", "2"]), "NOP\nNOP\nTAG TAG=007\nHOME\nEND\n");
    let again = workspace.bench.data(&["program", "copy", "2", "4", "--at", "3", "--to-task", "2"]);
    assert_eq!(again["was_there"], true);
    let found = workspace.bench.data(&["program", "search", "7", "--task", "2"]);
    assert_eq!((&found["task"], &found["step"]), (&2.into(), &3.into()));
    let failure = workspace.failure(&["search", "8"]);
    assert_eq!((failure.kind, failure.message.as_str()), (Kind::Refused, "task 1 has no tag 008 (@NG)"));
    assert_eq!(workspace.failure(&["copy", "2", "4", "--at", "4"]).kind, Kind::Usage);
}

#[test]
fn writes_nothing_during_a_run() {
    let mut workspace = Workspace::with(
        "origin = true\nsteps = { 1 = [\"TAG TAG=001\", \"JMP TAG=001\"] }\nevent = [{ at_ms = 0, do = \"start\" }]",
    );
    let failure = workspace.put(SAMPLE, &[]).unwrap_err();
    assert_eq!(failure.kind, Kind::Rejected);
    assert!(failure.message.starts_with("the controller executes a program"), "{}", failure.message);
    assert_eq!(workspace.failure(&["search", "1"]).kind, Kind::Rejected);
}

#[test]
fn failure_reports_written_steps() {
    // The fourth write to a cell is lost. Three programs are written, and the fourth fails at its first step.
    let mut workspace = Workspace::with("eeprom_limit = 1");
    workspace.put("SPD V=1\nEND\n", &[]).unwrap();
    let failure = workspace.put("SPD V=1\nNOP\nHOME\nEND\n", &[]).unwrap_err();
    assert_eq!(failure.kind, Kind::Malformed);
    assert!(failure.message.contains("; step 1 equals "), "{}", failure.message);
    assert!(failure.message.ends_with("3 steps are still to be written"), "{}", failure.message);
    assert!(failure.hint.unwrap().contains("use --resume=2 to continue at that step"));
    assert_eq!(workspace.bench.data(&["status"])["mode"], "automatic", "the mode is put back after a failure, too");
    let stored = workspace.put("SPD V=1\nNOP\nHOME\nEND\n", &["--resume=3"]).unwrap();
    assert_eq!(stored["cells_written"], 2);
}

#[test]
fn names_of_table_rows_are_explained() {
    let mut workspace = Workspace::with("points = { 1 = { 1 = [100.0, 20.0, 0.0, 0.0] } }");
    workspace.put(SAMPLE, &[]).unwrap();
    let text = workspace.text(&["--explain", "--until-end"]);
    assert!(text.contains("# point 1: x 100.00 mm, y 20.00 mm"), "{text}");
}

#[test]
fn a_file_that_was_read_writes_nothing_when_put_back() {
    let mut workspace = Workspace::new();
    workspace.put("start: SPD V=1\nJMPC TAG=start CN1<=3\nEND\n", &[]).unwrap();
    let path = workspace.folder.path().join("read.txt");
    let path = path.to_str().unwrap();
    workspace.bench.data(&["program", "get", path]);
    let stored = workspace.bench.data(&["program", "put", path]);
    assert_eq!(stored["cells_written"], 0);
    assert_eq!(workspace.failure(&["get", path]).kind, Kind::Local);
}

#[test]
fn blocks_are_those_of_the_manual() {
    let edit = |words: &[&str]| {
        let blocks = blocks(&[&["program"], words].concat()).unwrap();
        blocks
            .into_iter()
            .filter(|block| block.starts_with("@I") || block.starts_with("@D") || block.starts_with("@CP"))
            .collect::<Vec<_>>()
    };
    assert_eq!(edit(&["insert", "1"]), ["@ISTX 0001"]);
    assert_eq!(edit(&["delete", "1"]), ["@DSTX 0001"]);
    assert_eq!(edit(&["delete", "1", "--to", "2"]), ["@DSTL STA=0001 END=0002"]);
    assert_eq!(
        edit(&["copy", "1", "1", "--at", "1", "--from-task", "2", "--to-task", "1"]),
        ["@CPSS TASK=02 STA=0001 END=0001 TASK=01 TOP=0001"]
    );
}

#[test]
fn a_missing_file_is_a_local_failure() {
    assert_eq!(blocks(&["program", "put", "/nowhere/x.txt"]).unwrap_err().kind, Kind::Local);
}

/// Programs of two tasks, with their points and the speed table.
fn backup() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let program = "SPD V=5\nnext: MOVP a PT=1 CN=0 S V=0 POST\nOUT STN=0 PN1=.....1.1\nTSTR TASK=2\nCAL TAG=sub\n\
                   JMPC TAG=next CN1<3\nEND\nsub: CNT+ CN1=1\nCALI TAG=sub2 STN=0 PN1=.......1\nRET\nsub2: MOVP a PT=2 \
                   CN=0 S V=3 POST\nRET\n";
    for (name, text) in [
        ("program-1.txt", program),
        ("program-2.txt", "JMP TAG=gone\nEND\n"),
        ("points-1.csv", "name,x_mm,y_mm,z_mm,r_mm\n1,100.00,0.00,0.00,0.00\n2,0.00,0.05,0.00,0.00\n"),
        ("parameters.csv", "name,value\nT2.3,100.0\nT2.5,250.0\n"),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

#[test]
fn a_folder_of_programs_is_searched_and_checked() {
    let folder = backup();
    let run = |words: &str| {
        let words: Vec<&str> =
            words.split_ascii_whitespace().chain(["--from", folder.path().to_str().unwrap()]).collect();
        without_robot(&words).unwrap()
    };
    let found = |words: &str| -> Vec<Value> {
        let (data, _) = run(&format!("program search {words}"));
        data["matches"].as_array().unwrap().iter().map(|one| one["line"].clone()).collect()
    };
    assert_eq!(found("--uses OUT1.3"), [3]);
    assert_eq!(found("--uses cn1"), [6, 8]);
    assert_eq!(found("--uses T2.3"), [11]);
    assert_eq!(found("--uses next"), [2, 6]);
    assert_eq!(found("--calls sub2"), [9]);
    assert_eq!(found("5"), [1], "without a robot, a number is a text");
    assert_eq!(found("^MOVP"), [0; 0]);

    let rules = |words: &str| -> Vec<String> {
        let (data, _) = run(&format!("program check {words}"));
        let files = data["files"].as_array().unwrap().iter();
        let findings = files.flat_map(|file| file["findings"].as_array().unwrap());
        let findings = findings.filter(|one| one["severity"] != "note");
        findings.map(|one| format!("{} {}", one["rule"].as_str().unwrap(), one["line"])).collect()
    };
    let old = backup();
    let points = "name,x_mm,y_mm,z_mm,r_mm\n1,100.00,0.00,0.00,0.00\n2,0.00,0.00,0.00,0.00\n";
    std::fs::write(old.path().join("points-1.csv"), points).unwrap();
    let compare = format!("--max-speed 200mm/s --compare {}", old.path().display());
    assert_eq!(rules(&compare), ["speed-limit 1", "moved-position 11", "missing-label 1"]);
    assert_eq!(rules(&format!("{compare} --tolerance 0.1")), ["speed-limit 1", "missing-label 1"]);
    std::fs::write(folder.path().join(".armctl-check.toml"), "[rules]\nmissing-label = false\n").unwrap();
    assert_eq!(rules(""), [""; 0]);

    let swapped = "name,x_mm,y_mm,z_mm,r_mm\n1,0.00,0.05,0.00,0.00\n2,100.00,0.00,0.00,0.00\n";
    std::fs::write(old.path().join("points-1.csv"), swapped).unwrap();
    assert_eq!(rules(&compare), ["speed-limit 1", "moved-position 2", "moved-position 11"], "points have numbers");
    let more = "name,x_mm,y_mm,z_mm,r_mm\n1,0,0,0,0\n2,0,0,0,0\n3,5,0,0,0\n4,0,0,0,0\n";
    std::fs::write(folder.path().join("points-1.csv"), more).unwrap();
    assert_eq!(rules(""), ["unused-position 1"], "a point of zeros is not taught");

    std::fs::write(folder.path().join("program-2.txt"), "END\n").unwrap();
    let (data, _) = run("program calls");
    let names: Vec<&str> =
        data["programs"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["program-1", "program-1/sub", "program-1/sub2", "program-2"]);
    assert_eq!(data["programs"][0]["calls"], serde_json::json!(["program-2", "program-1/sub"]));
}

#[test]
fn a_program_of_the_controller_is_checked_with_its_data() {
    let old = backup();
    let points = "name,x_mm,y_mm,z_mm,r_mm\n1,9.00,0.00,0.00,0.00\n";
    std::fs::write(old.path().join("points-1.csv"), points).unwrap();
    let folder = old.path().to_str().unwrap();
    let mut workspace = Workspace::with("points = { 1 = { 1 = [100.0, 20.0, 0.0, 0.0], 7 = [1.0, 0.0, 0.0, 0.0] } }");
    workspace.put("MOVP a PT=1 CN=0 S V=3 POST\nEND\n", &[]).unwrap();
    let words = ["program", "check", "--max-speed", "20mm/s", "--compare", folder];
    let (data, _) = workspace.bench.run(&words).unwrap();
    let findings = data["files"][0]["findings"].as_array().unwrap().iter();
    let messages: Vec<&str> = findings.map(|one| one["message"].as_str().unwrap()).collect();
    assert_eq!(messages[1], "50mm/s is above the limit 20mm/s");
    assert!(
        messages[0].starts_with("PT001 is 100.00,20.00,0.00,0.00, and was 9.00,0.00,0.00,0.00 in "),
        "{messages:?}"
    );
}

#[test]
fn a_program_of_another_task_is_drawn_with_the_axes_of_the_task() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        // Two axes for task 1, two for task 2.
        ("parameters.csv", "name,value\ntask-axes,2200\n"),
        ("program-2.txt", "MOVP a PT=1 CN=0 S V=3 POST\nMOVP a PT=2 CN=0 S V=3 POST\nEND\n"),
        ("points-2.csv", "name,x_mm,y_mm,z_mm,r_mm\n1,10.00,20.00,30.00,40.00\n2,0.00,0.00,50.00,0.00\n"),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let words = ["program", "show", "2", "--path", "--from", folder.path().to_str().unwrap()];
    let (data, _) = without_robot(&words).unwrap();
    let targets: Vec<&Value> = data["steps"].as_array().unwrap().iter().map(|step| &step["target"]).collect();
    assert_eq!(
        targets,
        [&serde_json::json!([0.0, 0.0, 30.0, 40.0]), &serde_json::json!([0.0, 0.0, 50.0, 0.0])],
        "{data}"
    );
}

//! Programs of a Toyo controller, tested with the binary and a served simulator: names in their text, stored source
//! texts, and the number of steps that a `put` reads.

#![cfg(unix)]

use std::collections::BTreeMap;
use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use crate::support::simulator::Simulator;

const NAMED: &str = "# pick and place\nSPD V=5            # slow\nnext: MOVP pick\nTIMP dwell=1.5\n\
                     JMPC TAG=next parts>=5\nEND\n";

/// A controller with the name `cell` in the inventory, and an inventory with names for points, timers and counters.
struct Workspace {
    folder: TempDir,
    _controller: Simulator,
}

impl Workspace {
    fn new() -> Self {
        let (folder, controller) = (tempfile::tempdir().expect("a folder"), Simulator::start("toyo"));
        let url = &controller.url;
        let inventory = format!(
            "[[robot]]\nname = \"cell\"\nfamily = \"toyo\"\ntarget = \"{url}\"\n\n\
             [robot.names]\npick = \"PT12\"\ndwell = \"TN2\"\nparts = \"CN3\"\n"
        );
        std::fs::write(folder.path().join("robots.toml"), inventory).expect("a file");
        Self { folder, _controller: controller }
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        let inventory = self.folder.path().join("robots.toml");
        command.env_clear().env("HOME", self.folder.path()).env("ARMCTL_CONFIG", inventory);
        command.args(["-r", "cell", "--yes", "toyo", "program"]).args(words);
        command.stdin(Stdio::null()).current_dir(self.folder.path());
        command
    }

    #[track_caller]
    fn run(&self, words: &[&str]) -> Output {
        let output = self.command(words).output().expect("armctl runs");
        assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
        output
    }

    #[track_caller]
    fn text(&self, words: &[&str]) -> String {
        String::from_utf8(self.run(words).stdout).expect("UTF-8")
    }

    #[track_caller]
    fn put(&self, text: &str, words: &[&str]) -> Put {
        std::fs::write(self.folder.path().join("program.toyo"), text).expect("a file");
        let output = self.run(&[&["put", "program.toyo", "-vv", "--json"], words].concat());
        let envelope: Value = serde_json::from_slice(&output.stdout).expect("UTF-8");
        let blocks = String::from_utf8(output.stderr).expect("UTF-8");
        Put { data: envelope["data"].clone(), blocks }
    }

    /// Writes steps as a person at the pendant does: the files of this user have no record of them.
    #[track_caller]
    fn write_at_pendant(&self, step: &str, text: &str) {
        let state = tempfile::tempdir().expect("a folder");
        let file = state.path().join("part.toyo");
        std::fs::write(&file, text).expect("a file");
        let mut command = self.command(&["put", "--at", step]);
        let output = command.arg(file).env("XDG_STATE_HOME", state.path()).output().expect("armctl runs");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

/// Result of a `put` command.
struct Put {
    data: Value,
    blocks: String,
}

impl Put {
    /// Sent blocks that begin with this word, each with the number of times that it was sent.
    fn sent(&self, word: &str) -> BTreeMap<&str, usize> {
        let mut sent = BTreeMap::new();
        for (_, block) in self.blocks.lines().filter_map(|line| line.split_once("-> ")) {
            if block.starts_with(word) {
                let text = block.split_once("  #").map_or(block, |(text, _)| text);
                *sent.entry(text).or_default() += 1;
            }
        }
        sent
    }

    /// Returns the number of steps that armctl read.
    fn read(&self) -> usize {
        self.sent("@RSTX").len()
    }
}

#[test]
fn names_replace_numbers_in_program_text() {
    let workspace = Workspace::new();
    let put = workspace.put(NAMED, &[]);
    let written: Vec<&str> = put.sent("@WSTX").into_keys().collect();
    assert_eq!(
        written,
        [
            "@WSTX 0001 SPD V=05",
            "@WSTX 0002 TAG TAG=001",
            "@WSTX 0003 MOVP a PT=012 CN=00 S V=00 POST",
            "@WSTX 0004 TIMP TN2=001.5",
            "@WSTX 0005 JMPC TAG=001 CN03>=0005",
            "@WSTX 0006 END",
        ]
    );
    let inserted = workspace.text(&["insert", "2", "MOVP", "pick"]);
    assert_eq!(inserted, "inserted in task 1: 0002  MOVP a PT=012 CN=00 S V=00 POST\n");
    let inserted = workspace.text(&["insert", "2", "CNT+", "parts=1"]);
    assert_eq!(inserted, "inserted in task 1: 0002  CNT+ CN03=0001\n");
    let wrong = workspace.command(&["insert", "2", "MOVP", "pikc"]).output().expect("armctl runs");
    assert_eq!(wrong.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&wrong.stderr).contains("no point has the name 'pikc'\n\nhint: did you mean pick?"),
        "{wrong:?}"
    );
}

#[test]
fn get_returns_the_source_text_while_the_steps_are_unchanged() {
    let workspace = Workspace::new();
    workspace.put(NAMED, &[]);
    assert_eq!(workspace.text(&["get"]), NAMED);
    assert_eq!(
        workspace.text(&["diff", "program.toyo"]),
        "the program of task 1 and program.toyo are equal, 6 steps\n"
    );
    workspace.write_at_pendant("4", "TIMP TN2=3.5\n");
    let text = workspace.text(&["get"]);
    assert!(text.contains("TIMP TN2=003.5") && !text.contains("pick and place"), "{text}");
    let differs = workspace.command(&["diff", "program.toyo"]).output().expect("armctl runs");
    let shown = String::from_utf8(differs.stdout).expect("UTF-8");
    assert_eq!(differs.status.code(), Some(8));
    assert!(shown.contains("-TIMP TN2=003.5\n+TIMP TN2=001.5\n"), "{shown}");
    // When the steps are the same as before, the source text is returned again.
    workspace.write_at_pendant("4", "TIMP TN2=1.5\n");
    assert_eq!(workspace.text(&["get"]), NAMED);
}

#[test]
fn put_reads_only_the_steps_that_it_needs() {
    let workspace = Workspace::new();
    assert_eq!(workspace.put(NAMED, &[]).read(), 2000, "no step is known");
    let changed = NAMED.replace("1.5", "2.5");
    let put = workspace.put(&changed, &[]);
    assert_eq!((put.read(), put.sent("@WSTX").len()), (7, 1), "the steps of the program, and the next one");
    assert_eq!((&put.data["unread_steps"], &put.data["cells_unchanged"]), (&1993.into(), &6.into()));
    assert_eq!(workspace.put(&changed, &["--read-all"]).read(), 2000);
    // A `put` of a part reads only the steps of this part.
    assert_eq!(workspace.put("SPD V=3\n", &["--at", "1"]).read(), 1);
    assert_eq!(workspace.put(&changed, &[]).read(), 2000, "a command changed steps after that");
}

#[test]
fn put_finds_steps_from_the_pendant_that_affect_the_program() {
    let workspace = Workspace::new();
    let base = "next: SPD V=5\nJMP TAG=next\n";
    workspace.put(base, &[]);
    // The person at the pendant has added a routine that no program calls yet.
    workspace.write_at_pendant("5", "TAG TAG=7\nEND\n");
    let put = workspace.put(&base.replace('5', "6"), &[]);
    assert_eq!(put.read(), 4, "its tags are unchanged, and its end does not run into the next steps");
    // The person at the pendant has made the program longer.
    workspace.write_at_pendant("4", "SPD V=1\n");
    let put = workspace.put(base, &[]);
    assert_eq!((put.read(), &put.data["cleared_steps"]), (2000, &3.into()));
    for program in [
        // One program per case: a tag that may exist twice, a last step that continues with the next step, and a
        // computed jump.
        "next: SPD V=5\nJMP TAG=next\nTAG TAG=7\nEND\n",
        "next: SPD V=5\nJMPC TAG=next CN1<3\n",
        "next: SPD V=5\nBRAC CN=1 OFS=1\nJMP TAG=next\n",
    ] {
        workspace.put(base, &["--read-all"]);
        workspace.write_at_pendant("100", "TAG TAG=7\nHOME\n");
        let put = workspace.put(program, &[]);
        assert_eq!((put.read(), &put.data["cleared_steps"]), (2000, &2.into()), "{program}");
    }
    let text = workspace.text(&["get"]);
    assert!(!text.contains("HOME"), "{text}");
}

//! Every sentence of `docs/safety.md` has a test. This file contains the tests that are in no other file.

use std::collections::BTreeSet;
use std::path::Path;

use super::workspace::Workspace;
use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

/// Returns the names of the tests in a Rust file.
fn tests_of(code: &str) -> impl Iterator<Item = &str> {
    code.split("#[test]").skip(1).filter_map(|rest| {
        let (_, named) = rest.split_once("fn ")?;
        Some(named.split_once('(')?.0)
    })
}

/// Collects all tests below a folder.
fn collect(folder: &Path, found: &mut BTreeSet<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let code = std::fs::read_to_string(&path).expect("a text");
            found.extend(tests_of(&code).map(str::to_owned));
        }
    }
}

/// Returns the numbered sentences of the page, each with its number.
fn sentences(page: &str) -> Vec<(usize, String)> {
    let mut found: Vec<(usize, String)> = Vec::new();
    let mut goes_on = false;
    for line in page.lines() {
        let number = line.split_once(". ").and_then(|(number, text)| Some((number.parse().ok()?, text)));
        if let Some((number, text)) = number {
            found.push((number, text.to_owned()));
            goes_on = true;
        } else if goes_on && line.starts_with("   ") {
            let (_, sentence) = found.last_mut().expect("a sentence");
            sentence.push(' ');
            sentence.push_str(line.trim());
        } else {
            goes_on = false;
        }
    }
    found
}

#[test]
fn every_sentence_of_the_page_has_a_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/safety.md")).unwrap();
    let mut tests = BTreeSet::new();
    collect(&root.join("tests"), &mut tests);
    collect(&root.join("src"), &mut tests);
    let sentences = sentences(&page);
    let mut wrong = Vec::new();
    for (index, (number, sentence)) in sentences.iter().enumerate() {
        if *number != index + 1 {
            wrong.push(format!("{number} stands where {} should", index + 1));
        }
        let Some((_, rest)) = sentence.split_once("<!-- test: ") else {
            wrong.push(format!("{number} has no test: {sentence}"));
            continue;
        };
        let names = rest.trim_end().strip_suffix(" -->").unwrap_or_default();
        let missing = names.split(", ").filter(|name| !tests.contains(*name));
        wrong.extend(missing.map(|name| format!("{number}: there is no test '{name}'")));
    }
    // Each rule must have a number, so a list without numbers is an error.
    wrong.extend(page.lines().filter(|line| line.trim_start().starts_with(['-', '*'])).map(str::to_owned));
    assert_eq!(page.matches("<!-- test: ").count(), sentences.len(), "a marker behind no sentence");
    assert!(sentences.len() > 30 && wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn each_risk_needs_the_documented_confirmation() {
    let controller = Simulator::start("yerc");
    let desk = Workspace::new("");
    let run = |words: &str| desk.run(&format!("-t {} yerc {words}", controller.url)).exit;
    let jobs = || desk.data(&format!("-t {} yerc file list", controller.url)).to_string();
    for (words, needs_yes) in [
        ("status", false),
        ("var set B0=1", false),
        ("job select COUNT", false),
        ("file delete HOME.JBI", true),
        ("servo on", true),
    ] {
        if needs_yes {
            let before = jobs();
            assert_eq!(run(words), Some(7), "{words}");
            assert_eq!(jobs(), before, "{words}");
            assert_eq!(run(&format!("{words} --yes")), Some(0), "{words}");
        } else {
            assert_eq!(run(words), Some(0), "{words}");
        }
    }
    assert!(!jobs().contains("HOME.JBI"), "with a yes it is done");
}

/// Runs a command line on a terminal.
fn at_terminal(desk: &Workspace, line: &str) -> Terminal {
    let mut command = desk.command(line);
    command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
    Terminal::start(command, 200, 30).expect("it starts")
}

#[test]
fn question_names_robot_and_action_and_no_sends_nothing() {
    let controller = Simulator::start("yerc");
    let desk = Workspace::new(&format!("[[robot]]\nname = \"cell3\"\ntarget = \"{}\"\n", controller.url));
    let position = || desk.data("-r cell3 yerc position")["positions"][1].clone();
    let before = position();
    for (answer, exit) in [("n\r", 7), ("yo\r", 7), ("\r", 7), ("\x04", 7), ("y\r", 0)] {
        let mut question_text = at_terminal(&desk, "-r cell3 yerc move relative --z -5 --speed 100mm/s");
        question_text.wait_for_text("REAL CONTROLLER: cell3");
        question_text.wait_for_text(controller.url.as_str());
        question_text.wait_for_text("100.0 mm/s");
        question_text.wait_for_text("Z: 1200.000 -> 1195.000 mm");
        question_text.wait_for_text("Continue? [y/N]");
        question_text.press(answer);
        assert_eq!(question_text.end().code(), Some(exit), "{answer:?}");
        assert_eq!(position() != before, exit == 0, "{answer:?}");
    }
}

#[test]
fn clearing_memory_needs_a_typed_word() {
    let controllers = [Simulator::start("toyo"), Simulator::start("yrcx")];
    let desk = Workspace::new("");
    let [toyo, yrcx] = [0, 1].map(|index| controllers[index].url.as_str());
    for line in [
        format!("-t {toyo} toyo init points"),
        format!("-t {toyo} toyo robot-type 1 0"),
        format!("-t {yrcx} yrcx abs-reset --axis 2"),
    ] {
        let mut asked = at_terminal(&desk, &line);
        asked.wait_for_text("REAL CONTROLLER");
        // This is also required if the risk is in the connection itself.
        asked.wait_for_text("Type '");
        asked.press("y\r");
        assert_eq!(asked.end().code(), Some(7), "{line}");
    }
}

#[test]
fn built_in_simulator_never_asks() {
    let served = Simulator::start("yerc");
    let desk = Workspace::new("[[robot]]\nname = \"desk\"\ntarget = \"sim:\"\nfamily = \"yerc\"\n");
    for order in ["servo on", "file delete COUNT.JBI"] {
        for sim in ["--sim", "-t sim:", "-r desk"] {
            assert_eq!(desk.run(&format!("{sim} yerc {order}")).exit, Some(0), "{sim} {order}");
        }
        desk.fails(&format!("-t {} yerc {order}", served.url), 7, "not confirmed");
    }
}

#[test]
fn stop_is_always_allowed() {
    for (family, stop, other) in
        [("yerc", "hold on", "servo on"), ("toyo", "stop", "home"), ("yrcx", "stop", "servo on")]
    {
        let controller = Simulator::start(family);
        let desk =
            Workspace::new(&format!("[[robot]]\nname = \"r\"\ntarget = \"{}\"\nread_only = true\n", controller.url));
        assert_eq!(desk.run(&format!("-r r {family} {stop}")).exit, Some(0), "{family}");
        desk.fails(&format!("-r r {family} {other} --yes"), 7, "is read-only");
    }
}

#[test]
fn dry_run_shows_the_frame_of_the_command() {
    let desk = Workspace::new("[[robot]]\nname = \"r\"\ntarget = \"udp://127.0.0.1:1\"\nread_only = true\n");
    let plan = desk.data("-r r yerc servo on --dry-run");
    // The frame ends with command 0x83, instance 2, attribute 1, service 0x10 and the value 1.
    let frames = plan["frames"].as_array().unwrap();
    let is_order = |frame: &serde_json::Value| frame["hex"].as_str().unwrap().ends_with("830002000110000001000000");
    assert!(frames.iter().any(is_order), "{plan}");
    let home = desk.data("-t tcp://127.0.0.1:1 toyo home --dry-run");
    let texts: Vec<&str> =
        home["frames"].as_array().unwrap().iter().filter_map(|frame| frame["text"].as_str()).collect();
    let at = |text: &str| texts.iter().position(|known| *known == text);
    assert!(at("@HSON") < at("@HOME") && at("@HOME") < at("@HSOF") && at("@HSON").is_some(), "{home}");
}

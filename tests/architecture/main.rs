//! Holds the architecture: who may use whom, who may print, how long a file and how large a circle of modules may get,
//! and that generated files are current. A failure names file and line. `ARMCTL_BLESS=1 cargo test --test architecture`
//! rewrites `man/` and `docs/schemas/`.

mod circles;
mod concepts;
mod contract;
mod generated;
mod loopback;
mod source;

use source::{Source, committed, has_word, root, sources};

use armctl::settings::target::BUSES;
use armctl::settings::target::bus::Scheme;

/// A part of `src/` (a folder or a file) and the paths that must not occur in it.
const BORDERS: [(&str, &[&str]); 7] = [
    // Bytes and meaning: no sockets, no clock, no command line, no files, no printing.
    (
        "controller/",
        &[
            "crate::app",
            "crate::cli",
            "crate::client",
            "crate::command",
            "crate::failure",
            "crate::gate",
            "crate::output",
            "crate::settings",
            "crate::transport",
            "clap",
            "tokio",
            "std::env",
            "std::fs",
            "std::net",
            "std::process",
            "std::thread",
            "std::time::Instant",
            "std::time::SystemTime",
        ],
    ),
    // Clients are a library: typed errors instead of prose, no command line, no printing, no files.
    (
        "client/",
        &[
            "crate::app",
            "crate::cli",
            "crate::command",
            "crate::failure",
            "crate::files",
            "crate::gate",
            "crate::output",
            "crate::settings",
            "clap",
            "std::env",
            "std::fs",
            "std::process",
        ],
    ),
    // Bytes without meaning.
    (
        "transport/",
        &[
            "crate::app",
            "crate::cli",
            "crate::client",
            "crate::command",
            "crate::controller",
            "crate::failure",
            "crate::gate",
            "crate::output",
            "crate::settings",
            "clap",
            "std::time::SystemTime",
        ],
    ),
    (
        "output/",
        &[
            "crate::app",
            "crate::cli",
            "crate::client",
            "crate::command",
            "crate::controller",
            "crate::gate",
            "crate::transport",
            "tokio",
        ],
    ),
    (
        "settings/",
        &[
            "crate::app",
            "crate::cli",
            "crate::client",
            "crate::command",
            "crate::gate",
            "crate::output",
            "crate::transport",
            "tokio",
        ],
    ),
    // Everything may fail: this one knows nobody.
    (
        "failure.rs",
        &[
            "crate::app",
            "crate::cli",
            "crate::client",
            "crate::command",
            "crate::controller",
            "crate::gate",
            "crate::output",
            "crate::settings",
            "crate::transport",
            "clap",
            "tokio",
        ],
    ),
    // Commands talk through the link of their family; only that one opens something.
    ("command/", &["crate::app", "tokio::net", "std::net::UdpSocket", "std::net::TcpStream", "std::process"]),
];

/// Commands that touch a transport: the link of a family with its trace and its face, what reads captures, sessions, the
/// simulators' servers, the list of ports, the connection to a broker, and the peer of tests.
const LINKS: [&str; 45] = [
    "command/decode/capture/mod.rs",
    "command/decode/capture/report.rs",
    "command/decode/capture/stream.rs",
    "command/face/declared.rs",
    "command/face/mod.rs",
    "command/fleet/metrics/mod.rs",
    "command/fleet/publish/uplink.rs",
    "command/fleet/service.rs",
    "command/fleet/session/close.rs",
    "command/fleet/session/host.rs",
    "command/fleet/session/list.rs",
    "command/fleet/session/open.rs",
    "command/frame/attach.rs",
    "command/frame/background.rs",
    "command/frame/trace.rs",
    "command/toyo/decode/capture.rs",
    "command/toyo/face.rs",
    "command/toyo/link/observer.rs",
    "command/toyo/ports.rs",
    "command/toyo/connect.rs",
    "command/toyo/serve.rs",
    "command/toyo/simulated.rs",
    "command/toyo/testing.rs",
    "command/toyo/trace.rs",
    "command/yerc/decode/capture.rs",
    "command/yerc/face.rs",
    "command/yerc/link.rs",
    "command/yerc/connect.rs",
    "command/yerc/serve.rs",
    "command/yerc/simulated.rs",
    "command/yerc/trace.rs",
    "command/yrcx/connect.rs",
    "command/yrcx/decode/capture.rs",
    "command/yrcx/decode/images.rs",
    "command/yrcx/fieldbus.rs",
    "command/yrcx/link_error.rs",
    "command/yrcx/face.rs",
    "command/yrcx/gate.rs",
    "command/yrcx/hold.rs",
    "command/yrcx/link.rs",
    "command/yrcx/link/board.rs",
    "command/yrcx/link/onlooker.rs",
    "command/yrcx/simulated.rs",
    "command/yrcx/testing.rs",
    "command/yrcx/trace.rs",
];

/// Words that write to the terminal or end the process, and the only folder that may have them.
const PRINTING: [&str; 8] = ["stdout()", "stderr()", "println!", "eprintln!", "print!", "eprint!", "Stdout", "Stderr"];
const EXITING: [&str; 3] = ["process::exit", "process::abort", "ExitCode::from("];

/// Ways to read a file, and the only places that may have them: with a limit, and regular files only. A lock is a file
/// that is read, but not for what it says; the last one is a test.
const READING: [&str; 5] = ["fs::read(", "read_to_string(", "File::open(", "File::options(", ".read(true)"];
const READERS: [&str; 3] = ["files/mod.rs", "transport/session/socket.rs", "command/yerc/var/lines.rs"];

/// Longest source file; a longer one is usually two.
const LONGEST: usize = 700;

#[test]
fn dependencies_run_one_way() {
    let wrong: Vec<String> = sources().iter().flat_map(trespasses).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn trespasses_are_found() {
    let found = |name: &str, text: &str| trespasses(&Source::new(name, text)).len();
    assert_eq!(found("controller/x.rs", "use {crate::text, armctl_transport::udp::Udp};"), 1);
    assert_eq!(found("controller/yerc/x.rs", "fn now() { super::super::super::output::say() }"), 1);
    assert_eq!(
        found("controller/x.rs", "use std::time::{Duration, Instant};\nlet t = std::time::SystemTime::now();"),
        2
    );
    assert_eq!(found("transport/x.rs", "use armctl_controller::Now;"), 1);
    assert_eq!(found("command/yerc/x.rs", "use crate::transport::udp::Udp;"), 1);
    assert_eq!(found("command/yerc/link.rs", "use crate::transport::udp::Udp;"), 0);
}

#[test]
fn only_output_prints() {
    let mut wrong = Vec::new();
    // A test that is skipped says so.
    for source in
        sources().iter().filter(|source| !source.name.starts_with("output/") && !source.name.contains("/tests/"))
    {
        for (line, text) in source.code.lines().enumerate() {
            for word in PRINTING.iter().filter(|word| has_word(text, word)) {
                wrong.push(format!("src/{}:{}: {word} outside output/", source.name, line + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn only_failure_has_exit_numbers() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.name != "failure.rs") {
        for (line, text) in source.code.lines().enumerate() {
            for word in EXITING {
                for (at, _) in text.match_indices(word) {
                    let number = text[at + word.len()..].starts_with(|next: char| next.is_ascii_digit());
                    if number || word != "ExitCode::from(" {
                        wrong.push(format!("src/{}:{}: {word} with a number of its own", source.name, line + 1));
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn local_files_are_read_in_one_place() {
    let mut wrong = Vec::new();
    let is_test = |name: &str| name.contains("test") || READERS.contains(&name);
    for source in sources().iter().filter(|source| !is_test(&source.name)) {
        // Some have a condition before their tests.
        let code = source.code.split("#[cfg(test)]").next().unwrap_or_default();
        let code = code.split("#[cfg(all(test").next().unwrap_or_default();
        for (line, text) in code.lines().enumerate() {
            for word in READING.iter().filter(|word| text.contains(**word)) {
                wrong.push(format!("src/{}:{}: {word}…) outside files/", source.name, line + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn files_stay_readable() {
    let long = sources().into_iter().filter_map(|source| {
        let lines = source.text.lines().count();
        (lines > LONGEST).then(|| format!("src/{} has {lines} lines, more than {LONGEST}", source.name))
    });
    let long: Vec<String> = long.collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn nothing_knows_a_machine_of_ours() {
    // Put together here, so that this file does not find itself.
    let marks = ["home", "root", "work", "Users"].map(|folder| format!("/{folder}/"));
    let mut wrong = Vec::new();
    for file in committed(&root()) {
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        for (number, line) in text.lines().enumerate() {
            for mark in marks.iter().filter(|mark| line.contains(mark.as_str())) {
                wrong.push(format!("{}:{}: {mark}", file.display(), number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn both_licences_are_there() {
    for (file, words) in [("LICENSE-MIT", "MIT License"), ("LICENSE-APACHE", "Apache License")] {
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_default();
        assert!(text.contains(words), "{file} is missing or no {words}");
    }
}

/// Where what follows a mistake says more than a hint could: the usage, the caller, each use of a helper.
const HINT_ELSEWHERE: [&str; 3] = ["app/repl.rs", "command/yrcx/backup/content.rs", "settings/inventory.rs"];

#[test]
fn every_mistake_has_a_hint() {
    let mut wrong = Vec::new();
    for source in sources() {
        let is_test = source.name.contains("test") || HINT_ELSEWHERE.contains(&source.name.as_str());
        let code = source.code.split("#[cfg(test)]").next().unwrap_or_default();
        for (at, _) in code.match_indices("Failure::usage(").filter(|_| !is_test) {
            let rest: String = code[at..].chars().take(500).collect();
            if !rest.contains(".hint(") {
                wrong.push(format!("src/{}:{}: what can be done about it?", source.name, code[..at].lines().count()));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// What a source mentions beyond its borders.
fn trespasses(source: &Source) -> Vec<String> {
    let mut wrong = Vec::new();
    for (line, path) in source.paths() {
        let place = format!("src/{}:{line}", source.name);
        for (part, forbidden) in BORDERS.iter().filter(|(part, _)| source.name.starts_with(part)) {
            if forbidden.iter().any(|forbidden| is_within(&path, forbidden)) {
                wrong.push(format!("{place}: {part} must not mention {path}"));
            }
        }
        // The folder of a fieldbus has its name.
        let in_bus = |scheme: &Scheme| source.name.starts_with(&format!("command/yrcx/{}/", scheme.bus));
        let is_link = LINKS.contains(&source.name.as_str()) || BUSES.iter().any(in_bus);
        if source.name.starts_with("command/") && !is_link && is_within(&path, "crate::transport") {
            wrong.push(format!("{place}: {path} belongs behind the family's link"));
        }
    }
    wrong
}

/// Whether `path` is `prefix`, or something within it.
fn is_within(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

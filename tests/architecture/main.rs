//! Rules of the architecture: allowed dependencies, printing, maximum size of files and of module cycles, and current
//! generated files. A failure names the file and the line. `ARMCTL_BLESS=1 cargo test --test architecture` rewrites
//! `man/` and `docs/schemas/`.

mod circles;
mod concepts;
mod contract;
mod generated;
mod loopback;
mod source;

use source::{Source, committed, has_word, root, sources};

use armctl::settings::target::BUSES;
use armctl::settings::target::bus::Scheme;

/// Parts of `src/` (folders or files), each with the paths that it must not use.
const BORDERS: [(&str, &[&str]); 7] = [
    // Bytes and their meaning: this part uses no sockets, clock, command line, files or printing.
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
    // Clients are a library with typed errors. They use no texts for users, command line, printing or files.
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
    // Transports move bytes and do not know their meaning.
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
    // Every module can use this module, so it must not use any other.
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
    // Commands use the link of their family. Only the link opens connections.
    ("command/", &["crate::app", "tokio::net", "std::net::UdpSocket", "std::net::TcpStream", "std::process"]),
];

/// Modules below `command/` that may use a transport: links with their traces and faces, capture readers, sessions,
/// simulator servers, the list of ports, the broker connection, and test peers.
const LINKS: [&str; 45] = [
    "command/decode/capture/mod.rs",
    "command/decode/capture/report.rs",
    "command/decode/capture/stream.rs",
    "command/face/registration.rs",
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
    "command/yerc/simulator_start.rs",
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

/// Words that write to the terminal, which only `output/` may contain, and words that end the process with an exit
/// code.
const PRINTING: [&str; 8] = ["stdout()", "stderr()", "println!", "eprintln!", "print!", "eprint!", "Stdout", "Stderr"];
const EXITING: [&str; 3] = ["process::exit", "process::abort", "ExitCode::from("];

/// Ways to read a file, and the only modules that may contain them. The first module checks size and file type, the
/// second one reads a lock file, and the third one is a test.
const READING: [&str; 5] = ["fs::read(", "read_to_string(", "File::open(", "File::options(", ".read(true)"];
const READERS: [&str; 3] = ["files/mod.rs", "transport/session/socket.rs", "command/yerc/var/command_tests.rs"];

/// Maximum number of lines of a source file.
const LONGEST: usize = 700;

#[test]
fn dependencies_have_one_direction() {
    let wrong: Vec<String> = sources().iter().flat_map(forbidden_paths).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn finds_forbidden_dependencies() {
    let found = |name: &str, text: &str| forbidden_paths(&Source::new(name, text)).len();
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
    // Tests may print, because a skipped test must print a message.
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
fn only_failure_has_exit_codes() {
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
fn local_files_are_read_by_one_module() {
    let mut wrong = Vec::new();
    let is_test = |name: &str| name.contains("test") || READERS.contains(&name);
    for source in sources().iter().filter(|source| !is_test(&source.name)) {
        // Some modules have an additional condition on their tests.
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
fn limits_the_length_of_files() {
    let long = sources().into_iter().filter_map(|source| {
        let lines = source.text.lines().count();
        (lines > LONGEST).then(|| format!("src/{} has {lines} lines, more than {LONGEST}", source.name))
    });
    let long: Vec<String> = long.collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn no_file_names_a_development_machine() {
    // The paths are assembled here, so that this file does not contain them.
    let machine_names = ["home", "root", "work", "Users"].map(|folder| format!("/{folder}/"));
    let mut wrong = Vec::new();
    for file in committed(&root()) {
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        for (number, line) in text.lines().enumerate() {
            for mark in machine_names.iter().filter(|mark| line.contains(mark.as_str())) {
                wrong.push(format!("{}:{}: {mark}", file.display(), number + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn both_licences_exist() {
    for (file, words) in [("LICENSE-MIT", "MIT License"), ("LICENSE-APACHE", "Apache License")] {
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_default();
        assert!(text.contains(words), "{file} is missing or no {words}");
    }
}

/// Files in which a usage failure may have no hint. There, the usage follows the failure, or the caller or a helper
/// adds the hint.
const HINT_ELSEWHERE: [&str; 2] = ["app/repl.rs", "settings/inventory.rs"];

#[test]
fn every_usage_failure_has_a_hint() {
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

/// Forbidden paths that a source file uses.
fn forbidden_paths(source: &Source) -> Vec<String> {
    let mut wrong = Vec::new();
    for (line, path) in source.paths() {
        let place = format!("src/{}:{line}", source.name);
        for (part, forbidden) in BORDERS.iter().filter(|(part, _)| source.name.starts_with(part)) {
            if forbidden.iter().any(|forbidden| is_within(&path, forbidden)) {
                wrong.push(format!("{place}: {part} must not mention {path}"));
            }
        }
        // The folder of a fieldbus has the name of this fieldbus.
        let in_bus = |scheme: &Scheme| source.name.starts_with(&format!("command/yrcx/{}/", scheme.bus));
        let is_link = LINKS.contains(&source.name.as_str()) || BUSES.iter().any(in_bus);
        if source.name.starts_with("command/") && !is_link && is_within(&path, "crate::transport") {
            wrong.push(format!("{place}: {path} belongs behind the family's link"));
        }
    }
    wrong
}

/// Whether `path` equals `prefix` or is inside it.
fn is_within(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

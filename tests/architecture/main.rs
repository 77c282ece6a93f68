//! Rules of the architecture: allowed dependencies, printing, size of files and of module cycles, and current generated
//! files. A failure has file and line. `ARMCTL_BLESS=1 cargo test --test architecture` rewrites `man/`,
//! `docs/schemas/` and `docs/surface.txt`.

mod concepts;
mod generated;
mod library;
mod loopback;
mod module_cycles;
mod old_files;
mod source;
mod surface;

use source::{Source, committed, has_word, root, sources};

use armctl_frame::settings::target::BUSES;
use armctl_frame::settings::target::bus::Scheme;

/// Crates of the workspace, lowest first, with the crates of the workspace that each one may depend on.
const CRATES: [(&str, &[&str]); 9] = [
    ("files", &[]),
    ("controller", &[]),
    ("transport", &["files"]),
    ("client", &["controller", "transport"]),
    ("frame", &["client", "controller", "files", "transport"]),
    ("yerc", FAMILY),
    ("yrcx", FAMILY),
    ("toyo", FAMILY),
    ("", &["client", "controller", "files", "frame", "toyo", "transport", "yerc", "yrcx"]),
];

/// Dependencies of a family: never another family.
const FAMILY: &[&str] = &["client", "controller", "files", "frame", "transport"];

/// A part of `src/` (a folder or a file) and its forbidden paths.
const BORDERS: [(&str, &[&str]); 9] = [
    // Bytes and their meaning: no sockets, clock, files or processes.
    (
        "controller/",
        &[
            "std::env",
            "std::fs",
            "std::net",
            "std::process",
            "std::thread",
            "std::time::Instant",
            "std::time::SystemTime",
        ],
    ),
    // Clients are a library: no files and no environment.
    ("client/", &["std::env", "std::fs", "std::process"]),
    ("transport/", &["std::time::SystemTime"]),
    ("frame/output/", &["crate::client", "crate::controller", "crate::transport", "tokio"]),
    ("frame/settings/", &["crate::client", "crate::transport", "tokio"]),
    // Every module can use this module, so this module uses none of them.
    ("frame/failure.rs", &["crate::client", "crate::controller", "crate::transport", "clap", "tokio"]),
    // Commands use the link of their family; only the link opens connections.
    ("frame/", CONNECTIONS),
    ("command/", CONNECTIONS),
    ("command/", &["crate::app"]),
];

/// Paths with which code could reach another machine or process without the link of a family.
const CONNECTIONS: &[&str] = &["tokio::net", "std::net::UdpSocket", "std::net::TcpStream", "std::process"];

/// Parts of the frame that end the process, or start others: the guardian, editor, pager and jq.
const PROCESSES: [&str; 3] = ["frame/failure.rs", "frame/guardian.rs", "frame/output/"];

/// Lower modules of the frame, and the modules of the frame that each of them may use.
const FRAME: [(&str, &[&str]); 5] = [
    ("failure", &[]),
    ("settings", &["failure"]),
    ("output", &["failure", "settings"]),
    ("gate", &["failure", "output", "settings"]),
    ("guardian", &["failure", "output", "settings"]),
];

/// Commands that use a transport: links with their traces and faces, capture readers, sessions, simulator servers, the
/// list of ports, the broker connection, and test peers.
const LINKS: [&str; 50] = [
    "frame/decode/capture/mod.rs",
    "frame/decode/capture/report.rs",
    "frame/decode/capture/stream.rs",
    "frame/face/registration.rs",
    "frame/face/mod.rs",
    "command/fleet/metrics/mod.rs",
    "command/fleet/metrics/page_cache.rs",
    "command/fleet/publish/uplink.rs",
    "command/fleet/report.rs",
    "command/fleet/service.rs",
    "command/fleet/session/close.rs",
    "command/fleet/session/host.rs",
    "command/fleet/session/list.rs",
    "command/fleet/session/open.rs",
    "frame/session_client.rs",
    "frame/session_manager.rs",
    "frame/background.rs",
    "frame/guardian.rs",
    "frame/trace.rs",
    "toyo/decode/capture.rs",
    "toyo/face.rs",
    "toyo/link/observer.rs",
    "toyo/ports.rs",
    "toyo/connect.rs",
    "toyo/serve.rs",
    "toyo/simulated.rs",
    "toyo/testing.rs",
    "toyo/trace.rs",
    "yerc/decode/capture.rs",
    "yerc/face.rs",
    "yerc/link.rs",
    "yerc/connect.rs",
    "yerc/serve.rs",
    "yerc/simulator_start.rs",
    "yerc/trace.rs",
    "yrcx/connect.rs",
    "yrcx/decode/capture.rs",
    "yrcx/decode/images.rs",
    "yrcx/fieldbus.rs",
    "yrcx/link_error.rs",
    "yrcx/face.rs",
    "yrcx/wireshark.rs",
    "yrcx/gate.rs",
    "yrcx/session_link.rs",
    "yrcx/link.rs",
    "yrcx/link/board.rs",
    "yrcx/link/observer.rs",
    "yrcx/simulated.rs",
    "yrcx/testing.rs",
    "yrcx/trace.rs",
];

/// Parts of `src/` with commands.
const COMMANDS: [&str; 5] = ["command/", "frame/", "toyo/", "yerc/", "yrcx/"];

/// Words that write to the terminal or end the process, and the only folder that can contain them.
const PRINTING: [&str; 8] = ["stdout()", "stderr()", "println!", "eprintln!", "print!", "eprint!", "Stdout", "Stderr"];
const EXITING: [&str; 3] = ["process::exit", "process::abort", "ExitCode::from("];

/// Ways to read a file, and the only modules that can contain them, because they check size and file type. The second
/// and third modules read a lock file, and the last module is a test.
const READING: [&str; 5] = ["fs::read(", "read_to_string(", "File::open(", "File::options(", ".read(true)"];
const READERS: [&str; 4] =
    ["files/mod.rs", "transport/session/socket.rs", "transport/session/pipe.rs", "yerc/var/command_tests.rs"];

/// Maximum lines of a source file.
const MAX_FILE_LINES: usize = 700;

#[test]
fn dependencies_have_one_direction() {
    let wrong: Vec<String> = sources().iter().flat_map(forbidden_paths).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn crates_depend_on_lower_crates() {
    for (name, allowed) in CRATES {
        let manifest =
            root().join(if name.is_empty() { String::new() } else { format!("src/{name}") }).join("Cargo.toml");
        let text = std::fs::read_to_string(&manifest).expect("each crate has a manifest");
        let all = text.split("\n[dependencies]\n").nth(1).expect("there are dependencies");
        let own = all.lines().take_while(|line| !line.starts_with('['));
        let used: Vec<&str> = own
            .filter_map(|line| line.strip_prefix("armctl-"))
            .filter_map(|line| line.split([' ', '.']).next())
            .filter(|used| !allowed.contains(used))
            .collect();
        assert_eq!(used, [""; 0], "{}", manifest.display());
    }
}

#[test]
fn finds_forbidden_dependencies() {
    let found = |name: &str, text: &str| forbidden_paths(&Source::new(name, text)).len();
    assert_eq!(found("frame/output/x.rs", "use {crate::settings, armctl_transport::udp::Udp};"), 1);
    assert_eq!(found("frame/output/jq/x.rs", "fn now() { super::super::super::gate::ask() }"), 1);
    assert_eq!(found("frame/settings/x.rs", "use crate::failure::Failure;\nuse crate::run::Run;"), 1);
    assert_eq!(
        found("controller/x.rs", "use std::time::{Duration, Instant};\nlet t = std::time::SystemTime::now();"),
        2
    );
    assert_eq!(found("yerc/x.rs", "use armctl_transport::udp::Udp;"), 1);
    assert_eq!(found("yerc/link.rs", "use armctl_transport::udp::Udp;"), 0);
}

#[test]
fn only_output_prints() {
    let mut wrong = Vec::new();
    // Tests may print, because a skipped test must print a message.
    for source in
        sources().iter().filter(|source| !source.name.starts_with("frame/output/") && !source.name.contains("/tests/"))
    {
        for (line, text) in source.code.lines().enumerate() {
            for word in PRINTING.iter().filter(|word| has_word(text, word)) {
                wrong.push(format!("src/{}:{}: {word} outside frame/output/", source.name, line + 1));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn only_failure_has_exit_codes() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| source.name != "frame/failure.rs") {
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
        (lines > MAX_FILE_LINES).then(|| format!("src/{} has {lines} lines, more than {MAX_FILE_LINES}", source.name))
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

/// A shell creates the output file of a background command late, and an old file can have the text.
#[test]
fn scripts_wait_for_output_with_one_function() {
    let files = ["tests", "benches"].into_iter().flat_map(|folder| committed(&root().join(folder)));
    let waiting: Vec<_> = files
        .filter(|file| !file.ends_with("namespaces.rs"))
        .filter(|file| std::fs::read_to_string(file).is_ok_and(|text| text.contains(concat!("until ", "grep"))))
        .collect();
    assert!(waiting.is_empty(), "use `wait_for` of tests/profinet/namespaces.rs: {waiting:?}");
}

#[test]
fn both_licences_exist() {
    for (file, words) in [("LICENSE-MIT", "MIT License"), ("LICENSE-APACHE", "Apache License")] {
        let text = std::fs::read_to_string(root().join(file)).unwrap_or_default();
        assert!(text.contains(words), "{file} is missing or no {words}");
    }
}

/// Places where the text after a failure replaces a hint: the usage, the caller, each use of a helper.
const HINT_IN_CALLER: [&str; 2] = ["app/repl.rs", "frame/settings/inventory.rs"];

#[test]
fn every_usage_failure_has_a_hint() {
    let mut wrong = Vec::new();
    for source in sources() {
        let is_test = source.name.contains("test") || HINT_IN_CALLER.contains(&source.name.as_str());
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

/// Forbidden paths that a source uses.
fn forbidden_paths(source: &Source) -> Vec<String> {
    let mut wrong = Vec::new();
    for (line, path) in source.paths() {
        let place = format!("src/{}:{line}", source.name);
        for (part, forbidden) in BORDERS.iter().filter(|(part, _)| source.name.starts_with(part)) {
            let is_process =
                is_within(&path, "std::process") && PROCESSES.iter().any(|part| source.name.starts_with(part));
            if !is_process && forbidden.iter().any(|forbidden| is_within(&path, forbidden)) {
                wrong.push(format!("{place}: {part} must not mention {path}"));
            }
        }
        for (module, allowed) in FRAME.iter().filter(|(module, _)| in_frame(&source.name, module)) {
            let used = path.strip_prefix("crate::frame::").and_then(|path| path.split("::").next());
            if used.is_some_and(|used| used != *module && used != "*" && !allowed.contains(&used)) {
                wrong.push(format!("{place}: {module} must not use {path}"));
            }
        }
        // The folder of a fieldbus has the name of this fieldbus.
        let in_bus = |scheme: &Scheme| source.name.starts_with(&format!("yrcx/{}/", scheme.bus));
        let is_link = LINKS.contains(&source.name.as_str()) || BUSES.iter().any(in_bus);
        let has_border = BORDERS
            .iter()
            .any(|(part, forbidden)| source.name.starts_with(part) && forbidden.contains(&"crate::transport"));
        let is_command = COMMANDS.iter().any(|part| source.name.starts_with(part)) && !has_border;
        if is_command && !is_link && is_within(&path, "crate::transport") {
            wrong.push(format!("{place}: {path} belongs behind the family's link"));
        }
    }
    wrong
}

/// Whether a source belongs to a module of the frame.
fn in_frame(name: &str, module: &str) -> bool {
    let name = name.strip_prefix("frame/").unwrap_or_default();
    name.strip_prefix(module).is_some_and(|rest| rest == ".rs" || rest.starts_with('/'))
}

/// Whether `path` is `prefix`, or inside it.
fn is_within(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

//! Holds the house in order: who may use whom, who may print, how long a file may get, and that generated files are
//! current. A failure names file and line. `ARMCTL_BLESS=1 cargo test --test house` rewrites `man/` and
//! `docs/schemas/`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use clap::{CommandFactory as _, ValueEnum as _};

/// A part of `src/` (a folder or a file) and the paths that must not occur in it.
const BORDERS: [(&str, &[&str]); 6] = [
    // Bytes and meaning: no sockets, no clock, no command line, no files, no printing.
    (
        "controller/",
        &[
            "crate::app",
            "crate::cli",
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
    // Bytes without meaning.
    (
        "transport/",
        &[
            "crate::app",
            "crate::cli",
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
            "crate::command",
            "crate::controller",
            "crate::gate",
            "crate::transport",
            "tokio",
        ],
    ),
    (
        "settings/",
        &["crate::app", "crate::cli", "crate::command", "crate::gate", "crate::output", "crate::transport", "tokio"],
    ),
    // Everything may fail: this one knows nobody.
    (
        "failure.rs",
        &[
            "crate::app",
            "crate::cli",
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

/// Commands that touch a transport: the link of a family with its trace, what reads captures, sessions, the simulators'
/// servers, the list of ports, and the peer of tests.
const LINKS: [&str; 39] = [
    "command/attach.rs",
    "command/holding.rs",
    "command/trace.rs",
    "command/yerc/link.rs",
    "command/yerc/reach.rs",
    "command/yerc/simulated.rs",
    "command/yerc/trace.rs",
    "command/toyo/link.rs",
    "command/toyo/ports.rs",
    "command/toyo/reach.rs",
    "command/toyo/simulated.rs",
    "command/toyo/testing.rs",
    "command/toyo/trace.rs",
    "command/yrcx/eip/board.rs",
    "command/yrcx/gate.rs",
    "command/yrcx/hold.rs",
    "command/yrcx/link.rs",
    "command/yrcx/link/board.rs",
    "command/yrcx/link/driver.rs",
    "command/yrcx/link/shared.rs",
    "command/yrcx/reach.rs",
    "command/yrcx/simulated.rs",
    "command/yrcx/testing.rs",
    "command/yrcx/trace.rs",
    "command/yrcx/decode/cip.rs",
    "command/decode/capture/mod.rs",
    "command/decode/capture/report.rs",
    "command/decode/capture/stream.rs",
    "command/toyo/decode/capture.rs",
    "command/yerc/decode/capture.rs",
    "command/yrcx/decode/capture.rs",
    "command/common/robots/discover.rs",
    "command/common/session/close.rs",
    "command/common/session/list.rs",
    "command/common/session/mod.rs",
    "command/common/session/open.rs",
    "command/toyo/serve.rs",
    "command/yerc/serve.rs",
    "command/yrcx/serve.rs",
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
    let wrong: Vec<String> = sources().iter().flat_map(Source::trespasses).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn trespasses_are_found() {
    let found = |name: &str, text: &str| Source::new(name, text).trespasses().len();
    assert_eq!(found("controller/x.rs", "use crate::{controller::text, transport::udp::Udp};"), 1);
    assert_eq!(found("controller/yerc/x.rs", "fn now() { super::super::super::output::say() }"), 1);
    assert_eq!(
        found("controller/x.rs", "use std::time::{Duration, Instant};\nlet t = std::time::SystemTime::now();"),
        2
    );
    assert_eq!(found("transport/x.rs", "use crate::controller::Now;"), 1);
    assert_eq!(found("command/yerc/x.rs", "use crate::transport::udp::Udp;"), 1);
    assert_eq!(found("command/yerc/link.rs", "use crate::transport::udp::Udp;"), 0);
}

#[test]
fn only_output_prints() {
    let mut wrong = Vec::new();
    for source in sources().iter().filter(|source| !source.name.starts_with("output/")) {
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
                wrong.push(format!("src/{}:{}: {word}…) outside files.rs", source.name, line + 1));
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

#[test]
fn completions_are_for_all_names_of_the_program() {
    use armctl::command::common::completions::Shell;

    assert_eq!(names(&root().join("completions")).len(), Shell::value_variants().len(), "completions/");
    for shell in Shell::value_variants() {
        for name in ["armctl", "yerc", "yrcx", "toyo", "ARMCTL_COMPLETE"] {
            assert!(has_word(shell.script(), name), "{shell:?}: {name}");
        }
    }
}

#[test]
fn man_pages_are_current() {
    let pages = armctl::command::common::man::pages().expect("the man pages render");
    is_current("man", &pages.into_iter().collect());
}

#[test]
fn schemas_are_current() {
    let made = armctl::command::common::schema::all().into_iter().map(|entry| {
        let text = serde_json::to_string_pretty(&(entry.schema)()).expect("a schema is JSON");
        (format!("{}.json", entry.id), format!("{text}\n").into_bytes())
    });
    is_current("docs/schemas", &made.collect());
}

#[test]
fn schemas_are_schemas() {
    for entry in armctl::command::common::schema::all() {
        let schema = (entry.schema)().to_value();
        if let Err(why) = jsonschema::draft202012::meta::validate(&schema) {
            panic!("{}: {why}", entry.id);
        }
    }
}

#[test]
fn every_robot_command_has_a_schema_and_help() {
    let ids: Vec<&str> = armctl::command::common::schema::all().iter().map(|entry| entry.id).collect();
    let known: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(known.len(), ids.len(), "an id is there twice: {ids:?}");
    let root = armctl::cli::Cli::command();
    let mut words = BTreeSet::new();
    for (family, _) in CONTRACT {
        leaves(root.find_subcommand(family).expect("the family is there"), family, &mut words);
    }
    // At a prompt each line reports for itself.
    let is_known = |word: &str| known.contains(word) || word.rsplit('.').next() == Some("repl");
    let without: Vec<&String> = words.iter().filter(|word| !is_known(word)).collect();
    assert!(without.is_empty(), "commands without a schema of their name: {without:?}");
}

#[test]
fn no_flag_of_a_command_is_that_of_every_command() {
    // `--all` of a command would choose all robots as well. `--for` is how long, whatever it is that lasts.
    fn look(command: &clap::Command, known: &BTreeSet<String>, path: &str, found: &mut Vec<String>) {
        let own = || command.get_arguments().filter_map(|argument| Some((argument.get_long()?, argument)));
        let shadowed = own().filter(|(long, _)| known.contains(*long) && *long != "for");
        found.extend(shadowed.map(|(long, _)| format!("{path} --{long}")));
        let global = own().filter(|(_, argument)| argument.is_global_set()).map(|(long, _)| long.to_owned());
        let known: BTreeSet<String> = known.iter().cloned().chain(global).collect();
        for verb in command.get_subcommands() {
            look(verb, &known, &format!("{path} {}", verb.get_name()), found);
        }
    }
    let mut found = Vec::new();
    look(&armctl::cli::Cli::command(), &BTreeSet::new(), "armctl", &mut found);
    assert_eq!(found, Vec::<String>::new());
}

#[test]
fn schemas_describe_reports() {
    for entry in armctl::command::common::schema::all() {
        let schema = (entry.schema)();
        let says_what = ["properties", "$ref", "oneOf", "anyOf", "items"].iter().any(|key| schema.get(*key).is_some());
        assert!(says_what, "the schema of {} says nothing: {schema:?}", entry.id);
        assert!(schema.get("title").is_some(), "the schema of {} has no title", entry.id);
    }
}

/// Every command that the contract names, by family. An entry leaves this list only with a new major version.
const CONTRACT: [(&str, &[&str]); 3] = [("yerc", &YERC), ("toyo", &TOYO), ("yrcx", YRCX)];

const YERC: [&str; 41] = [
    "status",
    "alarm list",
    "alarm history",
    "alarm reset",
    "alarm cancel",
    "job show",
    "job select",
    "job start",
    "file list",
    "file get",
    "file put",
    "file delete",
    "file diff",
    "file backup",
    "file restore",
    "file cmos",
    "position",
    "axes",
    "position-error",
    "torque",
    "var get",
    "var set",
    "var dump",
    "var restore",
    "io get",
    "io set",
    "register get",
    "register set",
    "servo",
    "hold",
    "hlock",
    "cycle",
    "say",
    "move joint",
    "move linear",
    "move relative",
    "move pulse joint",
    "move pulse linear",
    "hours",
    "info",
    "raw",
];

const TOYO: [&str; 73] = [
    "status",
    "home",
    "position",
    "host",
    "mode",
    "servo",
    "stop",
    "reset",
    "error show",
    "error history",
    "error cancel",
    "error point",
    "run sequential",
    "run palletizing",
    "run easy",
    "run point",
    "jog",
    "param get",
    "param set",
    "param list",
    "param dump",
    "param restore",
    "point get",
    "point set",
    "point list",
    "speed-table get",
    "speed-table set",
    "accel-table get",
    "accel-table set",
    "mvm get",
    "mvm set",
    "torque-table get",
    "torque-table set",
    "backup",
    "restore",
    "program list",
    "program get",
    "program put",
    "program insert",
    "program delete",
    "program copy",
    "program search",
    "program check",
    "palletizing get",
    "palletizing set",
    "palletizing copy",
    "palletizing progress",
    "easy get",
    "easy set",
    "easy copy",
    "easy progress",
    "io in",
    "io out",
    "io internal",
    "io set",
    "io direct",
    "counter get",
    "counter set",
    "timer get",
    "override get",
    "override set",
    "task get",
    "task set",
    "offset",
    "coordinate set",
    "bus",
    "card read",
    "card write",
    "init",
    "info",
    "raw",
    "ports",
    "sim run",
];

const YRCX: &[&str] = &[
    "status",
    "move",
    "movei",
    "movet",
    "drive",
    "drivei",
    "pallet",
    "push",
    "jog",
    "inch",
    "inch-distance",
    "teach",
    "origin",
    "abs-reset",
    "speed",
    "shift select",
    "hand select",
    "arm select",
    "torque-limit",
    "servo",
    "motor",
    "info version",
    "info position",
    "info servo",
    "info alarm",
    "alarm reset",
    "io get",
    "io set",
    "io pulse",
    "io watch",
    "io map",
    "power-on",
    "run",
    "stop",
    "reset",
    "raw",
];

#[test]
fn the_contract_is_kept() {
    let root = armctl::cli::Cli::command();
    let missing = CONTRACT.iter().flat_map(|(family, all)| all.iter().map(move |words| (*family, *words)));
    let missing: Vec<(&str, &str)> = missing
        .filter(|(family, words)| {
            let mut command = root.find_subcommand(family);
            for word in words.split(' ') {
                command = command.and_then(|command| command.find_subcommand(word));
            }
            command.is_none()
        })
        .collect();
    assert!(missing.is_empty(), "no such commands: {missing:?}");
}

/// The ids of all commands below one: its words, joined by dots.
fn leaves(command: &clap::Command, id: &str, all: &mut BTreeSet<String>) {
    if !command.has_subcommands() {
        assert!(command.get_about().is_some(), "{id} has no line of help");
        all.insert(id.to_owned());
    }
    for sub in command.get_subcommands().filter(|sub| sub.get_name() != "help") {
        leaves(sub, &format!("{id}.{}", sub.get_name()), all);
    }
}

/// Compares a folder with what it should hold, or rewrites it where `ARMCTL_BLESS` is set.
fn is_current(folder: &str, made: &BTreeMap<String, Vec<u8>>) {
    let path = root().join(folder);
    if std::env::var_os("ARMCTL_BLESS").is_some() {
        std::fs::create_dir_all(&path).expect("the folder can be made");
        for (name, content) in made {
            std::fs::write(path.join(name), content).expect("the file can be written");
        }
        // Pages of commands that are gone go too.
        for name in names(&path).difference(&made.keys().cloned().collect()) {
            std::fs::remove_file(path.join(name)).expect("the old file can go");
        }
        return;
    }
    let there = names(&path);
    let stale: Vec<&String> = made
        .keys()
        .chain(&there)
        .filter(|name| std::fs::read(path.join(name)).ok().as_ref() != made.get(*name))
        .collect();
    assert!(stale.is_empty(), "{folder}/ is not current; run `ARMCTL_BLESS=1 cargo test --test house`: {stale:?}");
}

fn names(folder: &Path) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}

/// Whether `path` is `prefix`, or something within it.
fn is_within(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

/// Whether the word stands in the text and is no end of a longer one.
fn has_word(text: &str, word: &str) -> bool {
    let ends = |at: usize| text[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
    text.match_indices(word).any(|(at, _)| !ends(at))
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Every file that is ours: not what cargo and git keep.
fn committed(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder is readable").filter_map(Result::ok) {
        let (path, name) = (entry.path(), entry.file_name());
        if path.is_dir() {
            if name != "target" && name != ".git" {
                files.extend(committed(&path));
            }
        } else if name != ".git" {
            files.push(path);
        }
    }
    files
}

/// A source file.
struct Source {
    /// Its path below `src/`, with slashes.
    name: String,
    /// As it is.
    text: String,
    /// Without comments and the insides of strings, line for line.
    code: String,
}

fn sources() -> Vec<Source> {
    let src = root().join("src");
    let mut sources: Vec<Source> = committed(&src)
        .into_iter()
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .map(|path| {
            let text = std::fs::read_to_string(&path).expect("sources are UTF-8");
            let name = path.strip_prefix(&src).expect("it is below src").to_string_lossy().replace('\\', "/");
            Source::new(&name, &text)
        })
        .collect();
    sources.sort_by(|one, other| one.name.cmp(&other.name));
    assert!(sources.len() > 50, "the sources are found");
    sources
}

impl Source {
    fn new(name: &str, text: &str) -> Self {
        Self { name: name.to_owned(), text: text.to_owned(), code: bare(text) }
    }

    /// What it mentions beyond its borders.
    fn trespasses(&self) -> Vec<String> {
        let mut wrong = Vec::new();
        for (line, path) in self.paths() {
            let place = format!("src/{}:{line}", self.name);
            for (part, forbidden) in BORDERS.iter().filter(|(part, _)| self.name.starts_with(part)) {
                if forbidden.iter().any(|forbidden| is_within(&path, forbidden)) {
                    wrong.push(format!("{place}: {part} must not mention {path}"));
                }
            }
            let is_link = LINKS.contains(&self.name.as_str());
            if self.name.starts_with("command/") && !is_link && is_within(&path, "crate::transport") {
                wrong.push(format!("{place}: {path} belongs behind the family's link"));
            }
        }
        wrong
    }

    /// Every path of two or more words that the code mentions, with its line; `use` trees are spread, `super` and
    /// `self` resolved as far as the file's place tells.
    fn paths(&self) -> Vec<(usize, String)> {
        let module = self.module();
        let mut paths = Vec::new();
        let mut rest = self.code.as_str();
        let mut line = 1;
        while let Some(start) = rest.find(is_word) {
            line += rest[..start].matches('\n').count();
            rest = &rest[start..];
            let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
            let (word, after) = rest.split_at(end);
            let consumed = if word == "use" {
                let end = after.find(';').unwrap_or(after.len());
                spread(&after[..end], "", &mut |path| paths.push((line, resolve(&module, path))));
                end
            } else {
                let mut path = word.to_owned();
                let mut at = 0;
                while let Some(next) = after[at..].strip_prefix("::") {
                    let end = next.find(|c| !is_word(c)).unwrap_or(next.len());
                    if end == 0 {
                        break;
                    }
                    path.push_str("::");
                    path.push_str(&next[..end]);
                    at += 2 + end;
                }
                if at > 0 {
                    paths.push((line, resolve(&module, &path)));
                }
                at
            };
            line += after[..consumed].matches('\n').count();
            rest = &after[consumed..];
        }
        paths
    }

    /// `crate::output::jq` for `output/jq.rs`, `crate::output` for `output/mod.rs`.
    fn module(&self) -> Vec<String> {
        let stem = self.name.trim_end_matches(".rs");
        let stem = stem.strip_suffix("/mod").unwrap_or(stem);
        std::iter::once("crate").chain(stem.split('/')).map(str::to_owned).collect()
    }
}

fn is_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Takes `a::{b, c::{d}}` apart into `a::b` and `a::c::d`.
fn spread(tree: &str, prefix: &str, take: &mut impl FnMut(&str)) {
    let tree = tree.trim();
    let Some(open) = tree.find('{') else {
        let path = tree.split(" as ").next().unwrap_or_default();
        let path: String = path.chars().filter(|c| !c.is_whitespace()).collect();
        return take(&format!("{prefix}{}", path.trim_start_matches("::")));
    };
    let prefix = format!("{prefix}{}", tree[..open].trim().trim_start_matches("::"));
    let inside = tree[open + 1..].rsplit_once('}').map_or(&tree[open + 1..], |(inside, _)| inside);
    let (mut depth, mut start) = (0usize, 0);
    for (at, c) in inside.char_indices().chain([(inside.len(), ',')]) {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 0 => {
                if !inside[start..at].trim().is_empty() {
                    spread(&inside[start..at], &prefix, take);
                }
                start = at + 1;
            }
            _ => {}
        }
    }
}

/// A path from the root of the crate, where the file's place tells.
fn resolve(module: &[String], path: &str) -> String {
    let mut module = module.to_vec();
    let mut words = path.split("::").peekable();
    let mut is_relative = false;
    while let Some(word) = words.next_if(|word| matches!(*word, "super" | "self")) {
        is_relative = true;
        if word == "super" && module.len() > 1 {
            module.pop();
        }
    }
    if !is_relative {
        return path.to_owned();
    }
    module.extend(words.map(str::to_owned));
    module.join("::")
}

/// Code without comments and without the insides of string and character literals; every line stays where it is.
fn bare(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skipped = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if let Some(fence) = raw_fence(rest, &out) {
            let open = fence.len() + 1;
            let close = format!("\"{}", &fence[1..]);
            rest[open..].find(&close).map_or(rest.len(), |at| open + at + close.len())
        } else if c == '"' {
            closing(rest, '"')
        } else if c == '\'' && is_character(rest) {
            closing(rest, '\'')
        } else {
            out.push(c);
            rest = &rest[c.len_utf8()..];
            continue;
        };
        out.extend(rest[..skipped].chars().filter(|c| *c == '\n'));
        rest = &rest[skipped..];
    }
    out
}

/// `r##` of a raw string that begins here.
fn raw_fence<'a>(rest: &'a str, before: &str) -> Option<&'a str> {
    let hashes = rest.strip_prefix('r')?;
    let count = hashes.len() - hashes.trim_start_matches('#').len();
    let is_start = hashes[count..].starts_with('"') && !before.ends_with(|c: char| is_word(c) && c != 'b');
    is_start.then(|| &rest[..=count])
}

/// Length of a literal that begins here, its ends included.
fn closing(rest: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            _ if c == quote => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Whether a character literal begins here, not a lifetime.
fn is_character(rest: &str) -> bool {
    let mut next = rest.chars().skip(1);
    match next.next() {
        Some('\\') => true,
        Some(_) => next.next() == Some('\''),
        None => false,
    }
}

#[test]
fn the_reader_of_sources_finds_paths() {
    let text =
        "use crate::{a, b::{self, c as d}};\n// use crate::no;\nlet s = \"crate::no\"; let q = '\"';\nsuper::x::y();\n";
    let paths = Source::new("one/two.rs", text).paths();
    let expected = [(1, "crate::a"), (1, "crate::b::self"), (1, "crate::b::c"), (4, "crate::one::x::y")];
    assert_eq!(paths, expected.map(|(line, path)| (line, path.to_owned())));
}

//! Runs the console blocks of the README and of `docs/` with the built binary, and compares the output.
//!
//! The blocks below one `##` heading, and those before the first heading, are one shell session. A session has its own
//! folder and home, and no `ARMCTL_…` variables. `...` on a separate line matches any lines, and `[..]` matches any
//! text within a line. A command may fail only if the next command is `echo $?`. Envelopes must match their schemas.
//! Sections with `udp://127.0.0.1:10040`, `tcp://127.0.0.1:4001` or `eip://127.0.0.1:44818` get a simulator on free
//! ports. TOML blocks that begin with `# NAME.toml` become files in the folders of the page's sessions. Blocks with the
//! language `sh` (installation, real controllers) are not run.
//!
//! `ARMCTL_BLESS=1 cargo test --test terminal readme::` writes the output into the blocks that differ.
#![cfg(unix)]

use std::fmt::Write as _;
use std::io::{BufRead as _, BufReader};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

use snapbox::IntoData as _;

use crate::support::schemas;

/// Families, and the addresses that the blocks show for their simulators.
const DOCUMENTED: [(&str, &str); 3] =
    [("yerc", "udp://127.0.0.1:10040"), ("toyo", "tcp://127.0.0.1:4001"), ("yrcx", "eip://127.0.0.1:44818")];
/// Separator in the output of the shell, between two commands of a block.
const MARK: &str = "\u{1}--next--";
/// Pages with console blocks.
const PAGES: [&str; 14] = [
    "README.md",
    "docs/tasks.md",
    "docs/yerc.md",
    "docs/toyo.md",
    "docs/yrcx.md",
    "docs/repl.md",
    "docs/backups.md",
    "docs/cell.md",
    "docs/scripting.md",
    "docs/watching.md",
    "docs/sessions.md",
    "docs/monitoring/README.md",
    "docs/monitoring/mqtt.md",
    "docs/safety.md",
];

#[test]
fn console_blocks_match_the_output() {
    let bless = std::env::var_os("ARMCTL_BLESS").is_some();
    let mut pages: Vec<Page> = PAGES.iter().map(|name| Page::read(name)).collect();
    let sessions: Vec<Session> = pages.iter().flat_map(Page::sessions).collect();
    let outcomes = run_in_parallel(&sessions, |session| run(&session.shown, &session.files));
    let mut wrong = Vec::new();
    // Starts with the last section, so that a rewritten section does not move the sections before it.
    for (session, ended) in sessions.iter().zip(outcomes).rev() {
        let place = format!("{}, {}", PAGES[session.page], session.heading);
        let printed = match ended {
            Ok(printed) => printed,
            Err(why) => {
                wrong.push(format!("{place}: {why}"));
                continue;
            }
        };
        let broken = printed.iter().flat_map(|printed| printed.lines()).filter_map(|line| check_promise(line).err());
        wrong.extend(broken.map(|why| format!("{place}: {why}")));
        for ((range, shown), printed) in session.blocks.iter().zip(&session.shown).zip(printed).rev() {
            let assert = snapbox::Assert::new().normalize_paths(false);
            match assert.try_eq(Some(&place), printed.as_str().into_data(), shown.as_str().into_data()) {
                Ok(()) => {}
                Err(_) if bless => pages[session.page].text.replace_range(range.clone(), &printed),
                Err(difference) => wrong.push(format!("{place}:\n{difference}")),
            }
        }
    }
    for page in pages.iter().filter(|_| bless) {
        std::fs::write(&page.path, &page.text).expect("the page is writable");
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A page with console blocks.
struct Page {
    number: usize,
    path: PathBuf,
    text: String,
}

/// The blocks below one heading, which form a shell session.
struct Session {
    page: usize,
    heading: String,
    blocks: Vec<Range<usize>>,
    shown: Vec<String>,
    files: Vec<(String, String)>,
}

impl Page {
    fn read(name: &str) -> Self {
        let path = root().join(name);
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
        let number = PAGES.iter().position(|page| *page == name).expect("it is one of them");
        Self { number, path, text }
    }

    fn sessions(&self) -> Vec<Session> {
        let session = |section: Range<usize>| {
            let is_in_block = &self.text[section.clone()];
            let absolute_range = |block: Range<usize>| section.start + block.start..section.start + block.end;
            let blocks: Vec<Range<usize>> = blocks(is_in_block, "console").into_iter().map(absolute_range).collect();
            Session {
                page: self.number,
                heading: is_in_block.lines().next().unwrap_or_default().to_owned(),
                shown: blocks.iter().map(|block| self.text[block.clone()].to_owned()).collect(),
                blocks,
                files: files(&self.text),
            }
        };
        sections(&self.text).into_iter().map(session).collect()
    }
}

/// Calls `work` for each item, in three threads per core, because the work mostly waits.
fn run_in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, usize::from) * 3;
    let run_workers = || {
        let mut done = Vec::new();
        while let Some((number, item)) =
            Some(next.fetch_add(1, Ordering::Relaxed)).and_then(|n| Some((n, items.get(n)?)))
        {
            done.push((number, work(item)));
        }
        done
    };
    let mut done: Vec<(usize, R)> = std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(run_workers)).collect();
        running.into_iter().flat_map(|thread| thread.join().expect("a session does not panic")).collect()
    });
    done.sort_unstable_by_key(|(number, _)| *number);
    done.into_iter().map(|(_, result)| result).collect()
}

#[test]
fn every_link_has_a_target() {
    let anchor = |heading: &str| -> String {
        let anchors = heading.to_lowercase();
        anchors
            .chars()
            .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
            .collect::<String>()
            .replace(' ', "-")
    };
    let mut wrong = Vec::new();
    for page in PAGES.iter().chain(&["CONTRIBUTING.md", "CHANGELOG.md", "docs/architecture.md"]) {
        let path = root().join(page);
        let text = std::fs::read_to_string(&path).expect("the page is there");
        let links = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link);
        for link in links.filter(|link| !link.contains("://")) {
            let (file, place) = link.split_once('#').map_or((link, None), |(file, place)| (file, Some(place)));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
            let exists = place.map_or(target.exists(), |place| {
                let page = std::fs::read_to_string(&target).unwrap_or_default();
                page.lines()
                    .filter(|line| line.starts_with('#'))
                    .any(|line| anchor(line.trim_start_matches('#').trim()) == place)
            });
            if !exists {
                wrong.push(format!("{page}: {link}"));
            }
        }
    }
    assert_eq!(wrong, [""; 0], "links that lead nowhere");
}

/// Every path of a file in the pages for developers must exist. A placeholder such as NAME is not a path.
#[test]
fn every_path_in_the_developer_pages_exists() {
    let mut missing = Vec::new();
    for page in ["CONTRIBUTING.md", "docs/architecture.md"] {
        let text = std::fs::read_to_string(root().join(page)).expect("the page exists");
        // Code in a block is an example, so its paths are not checked.
        let prose: String = text.split("```").step_by(2).collect();
        for path in prose.split('`').skip(1).step_by(2).filter(|word| word.contains('/')) {
            let is_path = path.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || "_-./".contains(c));
            let folders = ["", "src", "src/command", "src/frame", "tests"];
            if is_path && !folders.iter().any(|folder| root().join(folder).join(path).exists()) {
                missing.push(format!("{page}: {path}"));
            }
        }
    }
    assert_eq!(missing, [""; 0]);
}

#[test]
fn recipes_work_with_jq() {
    const PAGE: &str = "docs/scripting.md";
    if Command::new("jq").arg("--version").stdout(Stdio::null()).status().is_err() {
        // `.ci/run` installs jq. On other machines, the recipes run only with `--jq`.
        return;
    }
    let text = std::fs::read_to_string(root().join(PAGE)).expect("the page is there");
    let files = files(&text);
    let mut recipes = 0;
    for section in sections(&text) {
        let section = &text[section];
        let typed = blocks(section, "console").into_iter().map(|block| section[block].to_owned());
        let with_jq: Vec<String> = typed
            .clone()
            .map(|block| {
                let (block, found) = with_pipes(&block);
                recipes += found;
                block
            })
            .collect();
        let ours: Vec<String> = typed.collect();
        let outputs = |blocks| run(blocks, &files).map(|pages| pages.iter().map(|page| print_output(page)).collect());
        let (ours, theirs): (Result<Vec<_>, _>, Result<Vec<_>, _>) = (outputs(&ours), outputs(&with_jq));
        assert_eq!(theirs, ours, "{PAGE}, {}", section.lines().next().unwrap_or_default());
    }
    assert!(recipes > 10, "{PAGE} has only {recipes} recipes");
}

/// Replaces `--jq FILTER` in a block by `--json | jq -rc FILTER`. Returns the block and the number of replacements.
fn with_pipes(block: &str) -> (String, usize) {
    let mut parts = block.split(" --jq ");
    let mut produced_size = parts.next().unwrap_or_default().to_owned();
    let mut found = 0;
    for part in parts {
        // A quoted filter ends with its quote. Another filter ends with the word.
        let end = match part.strip_prefix('\'') {
            Some(quoted) => quoted.find('\'').map(|end| end + 2),
            None => part.find(|c: char| c.is_whitespace() || c == ')'),
        };
        let (filter, rest) = part.split_at(end.unwrap_or(part.len()));
        write!(produced_size, " --json | jq -rc {filter}{rest}").expect("strings take text");
        found += 1;
    }
    (produced_size, found)
}

/// Output of the commands of a page, without times and with the same notation for equal numbers.
fn print_output(page: &str) -> String {
    let lines = page.lines().filter(|line| !line.starts_with("$ ") && !line.starts_with("> "));
    let mut printed: String = lines.flat_map(|line| [line, "\n"]).collect();
    for end in [",", " ", "\n"] {
        printed = printed.replace(&format!(".0{end}"), end);
    }
    let untimed = printed.lines().map(|line| line.split_once("Z\",").map_or(line, |(_, rest)| rest));
    untimed.flat_map(|line| [line, "\n"]).collect()
}

/// Checks all envelopes in a line against the schemas.
fn check_promise(line: &str) -> Result<(), String> {
    let envelopes = match serde_json::from_str(line) {
        Ok(serde_json::Value::Array(several)) => several,
        Ok(one) => vec![one],
        Err(_) => return Ok(()),
    };
    let mut envelopes = envelopes.iter().filter(|value| value.get("ok").is_some());
    envelopes.try_for_each(|envelope| schemas::check(envelope).map_err(|why| format!("{why} in\n{line}")))
}

/// Commands in the first block below a heading of the README.
fn first_block(heading: &str) -> Vec<String> {
    let readme = std::fs::read_to_string(root().join("README.md")).expect("README.md");
    let (_, after) = readme.split_once(heading).expect("a section that says how to start");
    let block = after.split("```").nth(1).expect("the section has a block");
    let typed = block.lines().skip(1).map(|line| line.split('#').next().unwrap_or_default().trim().to_owned());
    typed.filter(|line| !line.is_empty()).collect()
}

#[test]
fn readme_starts_with_two_commands_and_reaches_a_robot_with_three() {
    assert_eq!(first_block("## Try it"), ["cargo run -- --sim yerc status", "cargo test"]);
    assert_eq!(first_block("## Get started"), ["armctl setup", "armctl status", "armctl top"]);
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// Range of each section, with the heading of the section.
fn sections(text: &str) -> Vec<Range<usize>> {
    let headings = text.match_indices("\n## ").map(|(at, _)| at + 1);
    let starts: Vec<usize> = std::iter::once(0).chain(headings).collect();
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// Names and contents of the files on a page.
fn files(text: &str) -> Vec<(String, String)> {
    let named = |block: &str| Some((block.lines().next()?.strip_prefix("# ")?.to_owned(), block.to_owned()));
    blocks(text, "toml").into_iter().filter_map(|range| named(&text[range])).collect()
}

/// Byte ranges of the contents of all blocks with this language.
fn blocks(text: &str, language: &str) -> Vec<Range<usize>> {
    let mut blocks = Vec::new();
    let mut inside = None;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        match (inside, line.trim_end()) {
            (None, fence) if fence.strip_prefix("```") == Some(language) => inside = Some(at + line.len()),
            (Some(start), "```") => {
                blocks.push(start..at);
                inside = None;
            }
            _ => {}
        }
        at += line.len();
    }
    assert!(inside.is_none(), "a {language} block does not end");
    blocks
}

/// Runs the commands of all blocks of a section in one session. Returns the blocks with their output.
fn run(blocks: &[String], files: &[(String, String)]) -> Result<Vec<String>, String> {
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    for (name, content) in files {
        std::fs::write(folder.path().join(name), content).map_err(|error| format!("{name}: {error}"))?;
    }
    let needed = DOCUMENTED.iter().filter(|(_, target)| blocks.iter().any(|block| block.contains(target)));
    let simulators: Vec<Simulator> = needed.map(|(family, target)| Simulator::start(family, target)).collect();
    let blocks: Vec<Vec<String>> = blocks.iter().map(|block| commands(block)).collect();
    let mut script = String::from("exec 2>&1\n");
    for command in blocks.iter().flatten() {
        let command = simulators.iter().fold(command.clone(), |command, simulator| simulator.reached(&command));
        writeln!(script, "{command}\nlast=$?\nprintf '{MARK} %s\\n' $last\n(exit $last)").expect("strings take text");
    }
    let output = shell(&script, folder.path())?;
    let output = simulators.iter().fold(output, |output, simulator| simulator.documented(&output));
    // The output of a command comes before its mark, and its exit code comes after the mark.
    let mut rest = output.as_str();
    let mut pages = Vec::new();
    for block in &blocks {
        let mut page = String::new();
        for (index, command) in block.iter().enumerate() {
            let ended = rest.split_once(MARK).and_then(|(printed, after)| Some((printed, after.split_once('\n')?)));
            let (printed, (code, after)) = ended.ok_or_else(|| format!("the shell ended in `{command}`: {rest}"))?;
            let is_shown = block.get(index + 1).is_some_and(|next| next == "echo $?");
            if code.trim() != "0" && !is_shown {
                return Err(format!("`{command}` ended with {} and printed\n{printed}", code.trim()));
            }
            write!(page, "$ {}\n{printed}", command.replace('\n', "\n> ")).expect("strings take text");
            rest = after;
        }
        pages.push(page);
    }
    Ok(pages)
}

/// Commands of a block. A command begins with `$ `, and its continuation lines begin with `> `.
fn commands(block: &str) -> Vec<String> {
    let mut commands: Vec<String> = Vec::new();
    for line in block.lines() {
        if let Some(command) = line.strip_prefix("$ ") {
            commands.push(command.to_owned());
        } else if let (Some(more), Some(last)) = (line.strip_prefix("> "), commands.last_mut()) {
            last.push('\n');
            last.push_str(more);
        }
    }
    commands
}

fn shell(script: &str, folder: &Path) -> Result<String, String> {
    let binary = Path::new(env!("CARGO_BIN_EXE_armctl"));
    let tools = binary.parent().expect("the binary is in a folder");
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(tools.to_owned()).chain(std::env::split_paths(&path)));
    let mut command = Command::new("sh");
    command.arg("-c").arg(script).current_dir(folder).stdin(Stdio::null());
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("ARMCTL_")) {
        command.env_remove(name);
    }
    command.env("PATH", path.map_err(|error| error.to_string())?);
    command.env("HOME", folder).env("XDG_CONFIG_HOME", folder.join(".config")).env("NO_COLOR", "1").env("TZ", "UTC");
    command.env("XDG_STATE_HOME", folder.join(".state"));
    let output = command.output().map_err(|error| format!("sh: {error}"))?;
    String::from_utf8(output.stdout).map_err(|error| error.to_string())
}

/// A simulator on free ports. It ends with the shell session.
struct Simulator {
    process: Child,
    target: String,
    documented: &'static str,
}

impl Simulator {
    fn start(family: &str, documented: &'static str) -> Self {
        let mut process = Command::new(env!("CARGO_BIN_EXE_armctl"))
            .args(["sim", family, "--bind", "127.0.0.1:0", "--jq", ".data.target"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("the simulator starts");
        let mut target = String::new();
        let stdout = process.stdout.take().expect("stdout is a pipe");
        BufReader::new(stdout).read_line(&mut target).expect("the simulator says where it is");
        Self { process, target: target.trim_end().to_owned(), documented }
    }

    fn reached(&self, command: &str) -> String {
        command.replace(self.documented, &format!("'{}'", self.target))
    }

    fn documented(&self, output: &str) -> String {
        // Messages can also contain an address without its scheme.
        let address = |url: &str| url.split_once("://").map_or_else(String::new, |(_, address)| address.to_owned());
        output.replace(&self.target, self.documented).replace(&address(&self.target), &address(self.documented))
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

//! Runs every example line of the help with a controller that records requests. On a read-only robot, without a
//! confirmation, and in a dry run, no dangerous request may be sent. This is tested on every link, directly and through
//! a session.

#[cfg(target_os = "linux")]
mod network;
mod relays;
mod yrcx;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use armctl::command::example_lines::robot_lines;
use armctl_controller::Risk;

use super::workspace::{CommandResult, Workspace, result_of};
use crate::support::terminal::Terminal;

/// Effect of a recorded request. A later variant is more severe.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Effect {
    /// A link opens or closes without a request. A session process does this by itself.
    Link,
    /// Nothing changes.
    Read,
    /// The robot stops.
    Stop,
    /// A setting changes, but it can be set again.
    Write,
    /// User data is overwritten or deleted, or something moves.
    Danger,
}

/// A controller that records requests.
pub trait Recorder {
    /// Family of the controller.
    fn family(&self) -> &'static str;
    /// Target URL of the controller.
    fn url(&self) -> &str;
    /// Effects of the requests since the last call, each with the request as text.
    fn take_effect(&mut self) -> Vec<(Effect, String)>;
}

const STOPS: [&str; 7] =
    ["stop", "yerc hold on", "yerc job stop", "yerc stop", "yrcx emergency-stop", "yrcx stop", "toyo stop"];

/// An example line of the help, in the form in which this test runs it.
#[derive(Debug)]
struct Line {
    words: Vec<String>,
    risk: Risk,
    is_stop: bool,
}

/// Lines of a family: all lines that change something, and one line of each read command. Endless lines get a limit,
/// and names of robots and formats are removed. Stops are last, because the controller refuses many requests after a
/// stop.
fn lines(family: &str) -> Vec<Line> {
    let mut seen = BTreeSet::new();
    let mut lines = Vec::new();
    for (line, risk) in robot_lines() {
        let words = bounded(&split(line.split("  #").next().unwrap_or(&line)));
        let is_other = ["yerc", "yrcx", "toyo"].iter().any(|other| *other != family && words[0] == *other);
        let is_name = |word: &&String| word.chars().all(|char| char.is_ascii_lowercase() || char == '-');
        let command = || words.iter().take_while(is_name).cloned().collect();
        if !is_other && seen.insert(if risk == Risk::Read { command() } else { words.clone() }) {
            let is_stop = STOPS.iter().any(|stop| line.starts_with(stop));
            lines.push(Line { words, risk, is_stop });
        }
    }
    lines.sort_by_key(|line| line.is_stop);
    assert!(lines.len() > 60, "{family}: {} lines", lines.len());
    lines
}

/// Words of a line. A quoted text is one word.
fn split(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut is_quoted = false;
    for char in line.chars() {
        match char {
            '\'' => is_quoted = !is_quoted,
            ' ' if !is_quoted => words.push(String::new()),
            _ => words.last_mut().expect("there is one").push(char),
        }
    }
    words
}

/// Removes `-r`, `-t`, `--all` and `--dry-run`. An endless line gets a limit of its time or count.
fn bounded(words: &[String]) -> Vec<String> {
    let mut bounded: Vec<String> = Vec::new();
    let mut rest = words.iter();
    while let Some(word) = rest.next() {
        match word.as_str() {
            "-r" | "-t" | "--for" => drop(rest.next()),
            "--all" | "--dry-run" | "--json" => {}
            "--watch" => {
                rest.next();
                bounded.extend(["--watch", "100ms", "--count", "1"].map(str::to_owned));
            }
            _ => bounded.push(word.clone()),
        }
    }
    if bounded.iter().any(|word| ["watch", "wait", "--continuous", "jog"].contains(&word.as_str())) {
        bounded.extend(["--for", "100ms"].map(str::to_owned));
    }
    bounded
}

/// How the lines are run: on a read-only robot, without a confirmation, or as a dry run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum RunMode {
    ReadOnly,
    WithoutYes,
    DryRun,
}

impl RunMode {
    fn max_effect(self) -> &'static [&'static str] {
        match self {
            Self::ReadOnly => &["--yes"],
            Self::WithoutYes => &[],
            Self::DryRun => &["--yes", "--dry-run"],
        }
    }

    /// Whether a line belongs to this run. A line that temporarily gives a station another name or address is left out,
    /// because the station would not be found again.
    fn has(self, line: &Line) -> bool {
        let is_renamed = || line.words.iter().any(|word| word == "--temporary");
        self != Self::WithoutYes || line.risk > Risk::Read && !is_renamed()
    }

    /// The most severe effect that a line may have; `None` if it may have no effect.
    fn declared_risk(self, line: &Line, in_session: bool) -> Option<Effect> {
        match self {
            Self::DryRun => in_session.then_some(Effect::Link),
            _ if line.is_stop => Some(Effect::Stop),
            Self::ReadOnly => Some(Effect::Read),
            Self::WithoutYes if line.risk > Risk::Destroy => Some(Effect::Read),
            Self::WithoutYes => Some(Effect::Write),
        }
    }
}

/// Divides the lines among controllers that run at the same time, because a line waits most of its time for its link.
/// The argument of `hold` is the number of the part, from 0, and the number of parts.
fn in_parts(parts: usize, hold: impl Fn((usize, usize)) + Sync) {
    std::thread::scope(|scope| {
        let hold = &hold;
        for part in 0..parts {
            scope.spawn(move || hold((part, parts)));
        }
    });
}

/// An environment with a robot. Its backup `press` differs from the controller.
pub struct Bench<'a> {
    desk: Workspace,
    recorder: &'a mut dyn Recorder,
    wrong: String,
    /// Part of the lines that this bench runs, counted from 0, and the number of parts.
    part: (usize, usize),
}

impl<'a> Bench<'a> {
    /// A bench that runs one part of the lines. `part` is the number of the part, from 0, and the number of parts.
    pub fn new(recorder: &'a mut dyn Recorder, part: (usize, usize)) -> Self {
        let bench = Self { desk: Workspace::new(""), recorder, wrong: String::new(), part };
        bench.is_read_only(false);
        bench.recorder.take_effect();
        bench
    }

    fn is_read_only(&self, is_so: bool) {
        let url = self.recorder.url();
        let entry = format!("[[robot]]\nname = \"cell\"\ntarget = \"{url}\"\nread_only = {is_so}\n");
        std::fs::write(self.desk.folder.path().join("robots.toml"), entry).expect("the inventory is written");
    }

    fn run(&self, words: &[&str]) -> CommandResult {
        let mut command = self.desk.command("-r cell --timeout 500ms");
        // This editor does not change the file, and it ends at once.
        command.env("EDITOR", "true");
        result_of(&command.args(words).output().expect("armctl starts"))
    }

    /// Runs a command that prepares the test and must succeed. On a very busy computer, a fieldbus can lose its
    /// connection; the command then runs again.
    #[track_caller]
    pub fn prepare(&mut self, line: &str) {
        const CONNECTION_LOST: Option<i32> = Some(4);

        let words: Vec<&str> = line.split(' ').collect();
        let mut result = self.run(&words);
        for _ in 0..2 {
            if result.exit == CONNECTION_LOST {
                result = self.run(&words);
            }
        }
        assert_eq!(result.exit, Some(0), "{line}: {result:?}");
        self.recorder.take_effect();
    }

    /// Creates a file that the lines use.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.desk.folder.path().join(name), text).expect("the file is written");
    }

    /// Runs all lines in one mode. `by` names the kind of connection.
    fn run_mode(&mut self, pass: RunMode, by: &str, in_session: bool) {
        self.is_read_only(pass == RunMode::ReadOnly);
        let (part, parts) = self.part;
        for line in lines(self.recorder.family()).iter().skip(part).step_by(parts).filter(|line| pass.has(line)) {
            let words: Vec<&str> =
                line.words.iter().map(String::as_str).chain(pass.max_effect().iter().copied()).collect();
            let came = self.run(&words);
            let wrong = self.check_effect(pass.declared_risk(line, in_session), &came);
            if let Some(wrong) = wrong.or_else(|| refusal(pass, line, &came)) {
                writeln!(self.wrong, "{by}, {pass:?}: {}: {wrong}", words.join(" ")).expect("text grows");
            }
        }
        self.is_read_only(false);
    }

    /// Checks that no recorded effect of a line is more severe than `most`. Returns the mistake, if any.
    fn check_effect(&mut self, most: Option<Effect>, came: &CommandResult) -> Option<String> {
        let sent = self.recorder.take_effect();
        let is_known = came.exit.is_some_and(|exit| (0..=9).contains(&exit));
        match sent.iter().find(|(effect, _)| most.is_none_or(|most| *effect > most)) {
            Some((effect, what)) => Some(format!("{effect:?} was sent: {what}; all: {sent:?}; {came:?}")),
            None => (!is_known).then(|| format!("{came:?}")),
        }
    }

    /// Runs `setup` and `teach`, which ask questions on a terminal.
    fn run_panels(&mut self, by: &str) {
        let url = self.recorder.url().to_owned();
        for pass in [RunMode::ReadOnly, RunMode::WithoutYes, RunMode::DryRun] {
            self.is_read_only(pass == RunMode::ReadOnly);
            let words = [&["teach"], pass.max_effect()].concat();
            let came = self.run(&words);
            let wrong = self.check_effect(Some(Effect::Read).filter(|_| pass != RunMode::DryRun), &came);
            // There is no terminal, so `teach` must end with exit code 2.
            if let Some(wrong) = wrong.or_else(|| (came.exit != Some(2)).then(|| format!("{came:?}"))) {
                writeln!(self.wrong, "{by}, {pass:?}: teach: {wrong}").expect("text grows");
            }
        }
        for is_read_only in [true, false] {
            self.is_read_only(is_read_only);
            let mut teach = Terminal::start(self.desk.command("-r cell teach"), 100, 30).expect("a terminal");
            let asks = teach.wait_for_one_of(&["is read-only", "Continue?"]) == 1;
            if asks {
                teach.press("n\r");
            }
            if asks == is_read_only {
                writeln!(self.wrong, "{by}: teach: read-only {is_read_only}, asks {asks}").expect("text grows");
            }
            assert_eq!(teach.end().code(), Some(7), "{by}: teach");
        }

        let mut command = self.desk.command("--config new.toml setup");
        command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
        let mut setup = Terminal::start(command, 100, 30).expect("a terminal");
        setup.wait_for_text("Where is the robot?");
        setup.press("\r");
        setup.wait_for_text("a URL:");
        setup.press(&format!("{url}\r"));
        // If a layer fails, for example because a session holds the port, `setup` asks a question.
        for _ in 0..8 {
            match setup.wait_for_one_of(&["What now?", "Name [", "Which controller"]) {
                // The keys select the third entry of the list. Each key draws the list again.
                0 => {
                    setup.press("\x1b[B\x1b[B\r");
                    setup.wait_for_text("What now?: continue anyway");
                }
                1 => break,
                _ => {
                    setup.press("\r");
                    setup.wait_for_text("Which controller is it?: ");
                }
            }
        }
        setup.press("\r");
        setup.wait_for_text("Read-only");
        setup.press("\r");
        setup.wait_for_text("Write this");
        setup.press("n\r");
        assert_eq!(setup.end().code(), Some(7), "{by}: setup");
        let came = CommandResult { exit: Some(7), stdout: String::new(), stderr: String::new() };
        if let Some(wrong) = self.check_effect(Some(Effect::Read), &came) {
            writeln!(self.wrong, "{by}: teach with a no, setup: {wrong}").expect("text grows");
        }
    }

    /// Runs all modes, directly and through a session.
    pub fn hold_all(mut self) {
        for by in ["directly", "in a session"] {
            let in_session = by == "in a session";
            if in_session {
                // If the link accepts only one client, a watch in an earlier run has opened a session by itself.
                self.desk.run("session close --all");
                self.prepare("session open --background --yes");
                // When this read has ended, the session has received its first image.
                let read = if self.recorder.family() == "yrcx" { "yrcx io get" } else { "status" };
                self.prepare(read);
            }
            for pass in [RunMode::DryRun, RunMode::ReadOnly, RunMode::WithoutYes] {
                self.run_mode(pass, by, in_session);
            }
            if in_session {
                self.desk.run("session close --all");
            }
            self.recorder.take_effect();
            if self.part.0 == 0 {
                self.run_panels(by);
            }
        }
        assert!(self.wrong.is_empty(), "{}", self.wrong);
    }
}

/// Checks that a line is refused if it must be: a change of a read-only robot, and a motion, end with exit code 7. A
/// command of another fieldbus is a usage error. A missing file is also accepted as a reason.
fn refusal(pass: RunMode, line: &Line, came: &CommandResult) -> Option<String> {
    // On a read-only robot, `backup` and `diff` are not refused: they read the data that needs no selection.
    let depends = line.words.iter().any(|word| ["backup", "diff"].contains(&word.as_str()));
    let must = match pass {
        RunMode::ReadOnly => line.risk > Risk::Read && !line.is_stop && !depends,
        RunMode::WithoutYes => line.risk == Risk::Motion,
        RunMode::DryRun => false,
    };
    let is_refused = matches!(came.exit, Some(7 | 2)) || came.stderr.contains("no such file");
    (must && !is_refused).then(|| format!("not refused: {came:?}"))
}

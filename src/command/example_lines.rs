//! Example lines of every command, for its help. Lines for robots have their maximum risk. Tests compare this risk with
//! the gate, and suggestions use it to avoid dangerous commands.

mod toyo;
mod without_robot;
mod yerc;
mod yrcx;

use armctl_controller::Risk::{self, Destroy, Read, Write};

/// Examples of a command: its words, the maximum risk of these lines, and the arguments of each line. The gate tests
/// mark the lines that stop a robot.
pub type Examples = (&'static str, Risk, &'static [&'static str]);

/// Example lines of the commands for robots of any family.
const COMMON: &[Examples] = &[
    ("status", Read, &["", "--watch 5s", "-r 'cell*' --json"]),
    ("alarm list", Read, &["", "--all -o csv"]),
    ("alarm history", Read, &["", "-r cell3"]),
    ("alarm watch", Read, &["", "-r cell3 --for 8h"]),
    ("alarm reset", Write, &["-r cell3", "--tag line1"]),
    ("wait", Read, &["idle -r cell3", "servo-on --tag line1 --for 30s"]),
    ("position", Read, &["", "-r cell3,cell4 -o csv"]),
    ("io get", Read, &["clamp -r cell3", "clamp --tag line1 -o csv"]),
    ("io list", Read, &["", "--out"]),
    ("io watch", Read, &["clamp", "clamp -r cell3,cell4"]),
    ("stop", Write, &["-r cell3", "--all"]),
    ("backup", Write, &["press -r press", "nightly --all"]),
    ("restore", Destroy, &["press -r press", "press -r press --dry-run"]),
    ("diff", Write, &["press -r press", "monday tuesday", "cell3 cell4 --only '*.JBI'"]),
];

/// All example lines for robots, with their maximum risk: the usual lines of every command, and one line per effect if
/// the words of the command decide its effect.
pub fn robot_lines() -> impl Iterator<Item = (String, Risk)> {
    let families = [("", COMMON), ("yerc", yerc::EXAMPLES), ("yrcx", yrcx::EXAMPLES), ("toyo", toyo::EXAMPLES)];
    families.into_iter().flat_map(|(family, commands)| {
        commands
            .iter()
            .flat_map(move |(words, risk, all)| all.iter().map(move |one| (line([family, words, one]), *risk)))
    })
}

/// Joins the parts that are not empty to a command line.
fn line(parts: [&str; 3]) -> String {
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Example lines of the command with these words.
pub fn examples(path: &[&str]) -> impl Iterator<Item = String> {
    all().filter(move |line| starts_with_words(line, path))
}

/// All example lines.
pub fn all() -> impl Iterator<Item = String> {
    let alone = without_robot::EXAMPLES.iter().flat_map(|(words, all)| all.iter().map(|one| line(["", words, one])));
    robot_lines().map(|(line, _)| line).chain(alone)
}

/// Whether a command can move a robot, or delete or overwrite user data. For a noun: whether all its verbs can. `path`
/// has the words of the command.
pub fn is_dangerous(path: &[&str], is_noun: bool) -> bool {
    let mut lines = robot_lines().filter(|(line, _)| starts_with_words(line, path)).peekable();
    let is_one = |(_, risk): (String, Risk)| risk >= Destroy;
    lines.peek().is_some() && if is_noun { lines.all(is_one) } else { lines.any(is_one) }
}

/// Whether a list of missing values may preselect the first value. A list may not preselect a value if Enter alone
/// would then delete something, or move or stop a robot.
pub fn preselects(path: &[&str]) -> bool {
    !is_dangerous(path, false)
        && !without_robot::NO_DEFAULT.iter().any(|words| words.split(' ').eq(path.iter().copied()))
}

fn starts_with_words(line: &str, path: &[&str]) -> bool {
    path.iter().copied().eq(line.split(' ').take(path.len()))
}

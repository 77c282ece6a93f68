//! Example lines of every command, for its help. Lines for robots have their maximum risk. Tests compare this risk with
//! the gate, and suggestions use it to avoid dangerous commands.

mod toyo;
mod without_robot;
mod yerc;
mod yrcx;

use armctl_controller::Risk::{self, Destroy, Read, Write};

/// An example line and its maximum risk. The gate tests mark the lines that stop a robot.
pub type ExampleLine = (&'static str, Risk);

/// Example lines of the commands for robots of any family.
const COMMON: &[ExampleLine] = &[
    ("status", Read),
    ("status --watch 5s", Read),
    ("status -r 'cell*' --json", Read),
    ("alarm list", Read),
    ("alarm list --all -o csv", Read),
    ("alarm history", Read),
    ("alarm history -r cell3", Read),
    ("alarm watch", Read),
    ("alarm watch -r cell3 --for 8h", Read),
    ("alarm reset -r cell3", Write),
    ("alarm reset --tag line1", Write),
    ("wait idle -r cell3", Read),
    ("wait servo-on --tag line1 --for 30s", Read),
    ("position", Read),
    ("position -r cell3,cell4 -o csv", Read),
    ("io get clamp -r cell3", Read),
    ("io get clamp --tag line1 -o csv", Read),
    ("io list", Read),
    ("io list --out", Read),
    ("io watch clamp", Read),
    ("io watch clamp -r cell3,cell4", Read),
    ("stop -r cell3", Write),
    ("stop --all", Write),
    ("backup press -r press", Write),
    ("backup nightly --all", Write),
    ("restore press -r press", Destroy),
    ("restore press -r press --dry-run", Destroy),
    ("diff press -r press", Write),
    ("diff monday tuesday", Write),
    ("diff cell3 cell4 --only '*.JBI'", Write),
];

/// All example lines for robots: the usual lines of every command, and one line per effect if the words of the command
/// decide its effect.
pub fn robot_lines() -> impl Iterator<Item = &'static ExampleLine> {
    [COMMON, yerc::LINES, yrcx::LINES, toyo::LINES].into_iter().flatten()
}

/// Example lines of the command with these words.
pub fn examples(path: &[&str]) -> impl Iterator<Item = &'static str> {
    all().filter(move |line| starts_with_words(line, path))
}

/// All example lines.
pub fn all() -> impl Iterator<Item = &'static str> {
    robot_lines().map(|(line, _)| *line).chain(without_robot::LINES.iter().copied())
}

/// Whether a command can move a robot, or delete or overwrite user data. For a noun: whether all its verbs can. `path`
/// has the words of the command.
pub fn is_dangerous(path: &[&str], is_noun: bool) -> bool {
    let mut lines = robot_lines().filter(|(line, _)| starts_with_words(line, path)).peekable();
    let is_one = |(_, risk): &ExampleLine| *risk >= Destroy;
    lines.peek().is_some() && if is_noun { lines.all(is_one) } else { lines.any(is_one) }
}

/// Whether a list of missing values may preselect the first value. It may not if Enter alone would then delete
/// something, or move or stop a robot.
pub fn preselects(path: &[&str]) -> bool {
    !is_dangerous(path, false)
        && !without_robot::NO_DEFAULT.iter().any(|words| words.split(' ').eq(path.iter().copied()))
}

fn starts_with_words(line: &str, path: &[&str]) -> bool {
    path.iter().copied().eq(line.split(' ').take(path.len()))
}

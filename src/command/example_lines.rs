//! Lines of every command: the examples of its help. Those for robots come with what they do at most, are held against the
//! gate by tests, and are the reason why no tip proposes a dangerous one.

mod toyo;
mod without_robot;
mod yerc;
mod yrcx;

use armctl_controller::Risk::{self, Destroy, Read, Write};

/// A line, and what it does at most. What stops the robot is marked by its own test.
pub type ExampleLine = (&'static str, Risk);

/// Lines of the commands for robots of any family.
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

/// All lines for robots: of every command the usual ones, and where its words decide what it does, one of each.
pub fn robot_lines() -> impl Iterator<Item = &'static ExampleLine> {
    [COMMON, yerc::LINES, yrcx::LINES, toyo::LINES].into_iter().flatten()
}

/// The lines of the command of these words.
pub fn examples(path: &[&str]) -> impl Iterator<Item = &'static str> {
    all().filter(move |line| starts_with_words(line, path))
}

/// Every line.
pub fn all() -> impl Iterator<Item = &'static str> {
    robot_lines().map(|(line, _)| *line).chain(without_robot::LINES.iter().copied())
}

/// Whether a command can move a robot, or delete or overwrite what a person wrote; of a noun, whether all of its verbs
/// can. `path` are its words.
pub fn is_dangerous(path: &[&str], is_noun: bool) -> bool {
    let mut lines = robot_lines().filter(|(line, _)| starts_with_words(line, path)).peekable();
    let is_one = |(_, risk): &ExampleLine| *risk >= Destroy;
    lines.peek().is_some() && if is_noun { lines.all(is_one) } else { lines.any(is_one) }
}

/// Whether a list of the values that a command lacks may preselect the first: not where Enter alone would delete
/// something, or move or stop a robot.
pub fn preselects(path: &[&str]) -> bool {
    !is_dangerous(path, false)
        && !without_robot::NO_DEFAULT.iter().any(|words| words.split(' ').eq(path.iter().copied()))
}

fn starts_with_words(line: &str, path: &[&str]) -> bool {
    path.iter().copied().eq(line.split(' ').take(path.len()))
}

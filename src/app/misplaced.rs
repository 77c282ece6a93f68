//! Words that are right, and stand in the wrong place: `armctl job select`, `armctl status yerc`, `armctl yerc select`.

use std::collections::BTreeSet;
use std::ffi::OsString;

use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use super::leaves::is_dangerous;
use crate::settings::target::Family;

/// More ways than this help nobody.
const MOST: usize = 3;

/// The error, with the command lines that the word it is about belongs to, where there are some. What moves a robot, or
/// deletes or overwrites something, is never proposed: it is too easily typed again.
pub fn explained(mut error: clap::Error, args: &[OsString], whole: &Command) -> clap::Error {
    let kind = match error.kind() {
        ErrorKind::InvalidSubcommand => ContextKind::InvalidSubcommand,
        ErrorKind::UnknownArgument => ContextKind::InvalidArg,
        _ => return error,
    };
    let Some(ContextValue::String(word)) = error.get(kind) else { return error };
    let word = word.clone();
    leave_out_dangerous(&mut error, &path(&word, args, whole), whole);
    let (safe, dangerous): (Vec<Line>, Vec<Line>) =
        lines(&word, args, whole).into_iter().partition(|line| !may_do_harm(&words_of(&line.0), whole));
    let families: BTreeSet<String> =
        dangerous.iter().filter_map(|line| Some(format!("`armctl {} -h`", words_of(&line.0).first()?))).collect();
    let mut lines: Vec<String> = safe.into_iter().map(|line| line.shown()).collect();
    lines.extend(families.into_iter().map(|help| format!("one that {help} lists")));
    if lines.is_empty() || lines.len() > MOST {
        return error;
    }
    // What is spelled right is not meant to be a word that only looks like it.
    error.remove(ContextKind::SuggestedSubcommand);
    let tip = format!("the command is {}", lines.join(" or "));
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    error
}

/// The words of the command that a wrong word stands behind.
fn path<'a>(word: &str, args: &'a [OsString], whole: &Command) -> Vec<&'a str> {
    let mut command = whole;
    let mut path = Vec::new();
    for arg in args.iter().skip(1).filter_map(|arg| arg.to_str()).take_while(|arg| *arg != word) {
        if let Some(below) = command.find_subcommand(arg) {
            command = below;
            path.push(arg);
        }
    }
    path
}

/// Whether the command that these words begin is a dangerous one.
fn may_do_harm(words: &[&str], whole: &Command) -> bool {
    let command = words.iter().try_fold(whole, |command, word| command.find_subcommand(word));
    is_dangerous(words, command.is_some_and(Command::has_subcommands))
}

/// Takes out of the similar words those of dangerous commands.
fn leave_out_dangerous(error: &mut clap::Error, path: &[&str], whole: &Command) {
    let Some(similar) = error.remove(ContextKind::SuggestedSubcommand) else { return };
    let is_safe = |word: &String| !may_do_harm(&[path, &[word.as_str()]].concat(), whole);
    let safe = match similar {
        ContextValue::String(word) => Some(ContextValue::String(word)).filter(|value| {
            let ContextValue::String(word) = value else { return false };
            is_safe(word)
        }),
        ContextValue::Strings(words) => {
            let words: Vec<String> = words.into_iter().filter(is_safe).collect();
            (!words.is_empty()).then_some(ContextValue::Strings(words))
        }
        other => Some(other),
    };
    if let Some(safe) = safe {
        error.insert(ContextKind::SuggestedSubcommand, safe);
    }
}

/// A command line in which a word has its place, and what follows it there.
struct Line(String, &'static str);

impl Line {
    fn shown(&self) -> String {
        format!("`armctl {}`{}", self.0, self.1)
    }
}

fn words_of(line: &str) -> Vec<&str> {
    line.split(' ').filter(|word| *word != "…").collect()
}

/// Command lines with the word in its place.
fn lines(word: &str, args: &[OsString], whole: &Command) -> Vec<Line> {
    let words: Vec<&str> = args.iter().skip(1).filter_map(|word| word.to_str()).collect();
    if word.parse::<Family>().is_ok() {
        let others = words.iter().filter(|other| **other != word && !other.starts_with('-'));
        let others: Vec<&str> = others.copied().collect();
        let family = whole.find_subcommand(word);
        let exists =
            others.first().is_some_and(|first| family.is_some_and(|family| family.find_subcommand(first).is_some()));
        return if exists { vec![Line(format!("{word} {}", others.join(" ")), "")] } else { Vec::new() };
    }
    let family = words.iter().find_map(|word| word.parse::<Family>().ok());
    if family.is_some() && whole.find_subcommand(word).is_some() {
        return vec![Line(word.to_owned(), ", which is for all families")];
    }
    let families = Family::ALL.into_iter().filter(|other| family.is_none_or(|family| family == *other));
    let families = families.filter_map(|family| whole.find_subcommand(family.name()));
    families.flat_map(|family| below(family, word)).collect()
}

/// Where a word is a command of a family, or the verb of one of its nouns.
fn below(family: &Command, word: &str) -> Vec<Line> {
    let name = family.get_name();
    if let Some(command) = family.find_subcommand(word) {
        let more = if command.has_subcommands() { " …" } else { "" };
        return vec![Line(format!("{name} {word}{more}"), "")];
    }
    let nouns = family.get_subcommands().filter(|noun| noun.find_subcommand(word).is_some());
    nouns.map(|noun| Line(format!("{name} {} {word}", noun.get_name()), "")).collect()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;
    use crate::cli::Cli;

    fn tip(line: &str) -> Option<String> {
        let args: Vec<OsString> = line.split(' ').map(Into::into).collect();
        let mut whole = Cli::command();
        let error = whole.try_get_matches_from_mut(&args).unwrap_err();
        let text = explained(error, &args, &whole).render().to_string();
        text.lines().find_map(|line| line.trim().strip_prefix("tip: ").map(ToOwned::to_owned))
    }

    #[test]
    fn words_in_the_wrong_place_are_shown_in_theirs() {
        for (line, expected) in [
            ("armctl alarm list", "the command is `armctl yerc alarm …` or `armctl yrcx alarm …`"),
            ("armctl hlock on", "the command is `armctl yerc hlock`"),
            (
                "armctl servo on",
                "the command is one that `armctl toyo -h` lists or one that `armctl yerc -h` lists or one that `armctl yrcx -h` lists",
            ),
            ("armctl status yerc", "the command is `armctl yerc status`"),
            ("armctl --sim status toyo", "the command is `armctl toyo status`"),
            ("armctl yerc select WELD", "the command is `armctl yerc job select`"),
            ("armctl yerc robots list", "the command is `armctl robots`, which is for all families"),
            ("armctl stats", "a similar subcommand exists: 'status'"),
            ("armctl yerc jop", "a similar subcommand exists: 'job'"),
        ] {
            assert_eq!(tip(line).as_deref(), Some(expected), "{line}");
        }
        assert_eq!(tip("armctl toyo get"), None);
        assert_eq!(tip("armctl status nonsense"), None);
    }
}

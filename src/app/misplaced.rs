//! Words that are right, and stand in the wrong place: `armctl job select`, `armctl status yerc`, `armctl yerc select`.

use std::ffi::OsString;

use clap::Command;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::settings::target::Family;

/// More ways than this help nobody.
const MOST: usize = 3;

/// The error, with the command lines that the word it is about belongs to, where there are some.
pub fn explained(mut error: clap::Error, args: &[OsString], whole: &Command) -> clap::Error {
    let kind = match error.kind() {
        ErrorKind::InvalidSubcommand => ContextKind::InvalidSubcommand,
        ErrorKind::UnknownArgument => ContextKind::InvalidArg,
        _ => return error,
    };
    let Some(ContextValue::String(word)) = error.get(kind) else { return error };
    let lines = lines(word, args, whole);
    if lines.is_empty() || lines.len() > MOST {
        return error;
    }
    // What is spelled right is not meant to be a word that only looks like it.
    error.remove(ContextKind::SuggestedSubcommand);
    let tip = format!("the command is {}", lines.join(" or "));
    error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    error
}

/// Command lines with the word in its place.
fn lines(word: &str, args: &[OsString], whole: &Command) -> Vec<String> {
    let words: Vec<&str> = args.iter().skip(1).filter_map(|word| word.to_str()).collect();
    if word.parse::<Family>().is_ok() {
        let others = words.iter().filter(|other| **other != word && !other.starts_with('-'));
        let others: Vec<&str> = others.copied().collect();
        let family = whole.find_subcommand(word);
        let exists =
            others.first().is_some_and(|first| family.is_some_and(|family| family.find_subcommand(first).is_some()));
        return if exists { vec![format!("`armctl {word} {}`", others.join(" "))] } else { Vec::new() };
    }
    let family = words.iter().find_map(|word| word.parse::<Family>().ok());
    if family.is_some() && whole.find_subcommand(word).is_some() {
        return vec![format!("`armctl {word}`, which is for all families")];
    }
    let families = Family::ALL.into_iter().filter(|other| family.is_none_or(|family| family == *other));
    let families = families.filter_map(|family| whole.find_subcommand(family.name()));
    families.flat_map(|family| below(family, word)).collect()
}

/// Where a word is a command of a family, or the verb of one of its nouns.
fn below(family: &Command, word: &str) -> Vec<String> {
    let name = family.get_name();
    if let Some(command) = family.find_subcommand(word) {
        let more = if command.has_subcommands() { " …" } else { "" };
        return vec![format!("`armctl {name} {word}{more}`")];
    }
    let nouns = family.get_subcommands().filter(|noun| noun.find_subcommand(word).is_some());
    nouns.map(|noun| format!("`armctl {name} {} {word}`", noun.get_name())).collect()
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
            ("armctl job list", "the command is `armctl yerc job …`"),
            ("armctl hlock on", "the command is `armctl yerc hlock`"),
            ("armctl servo on", "the command is `armctl yerc servo` or `armctl yrcx servo` or `armctl toyo servo`"),
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

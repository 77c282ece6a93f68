//! Suggestions for mistyped command lines. They cover words in the wrong place or order (`armctl job select`, `armctl
//! get file`), synonyms, missing values, and wrong separators.

mod synonyms;

use std::ffi::OsString;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, Command};

use super::spellings::families_with;
use super::typed_line::TypedLine;
use crate::command::example_lines::{self, is_dangerous};
use armctl_frame::failure::decimal_point;
use armctl_frame::prelude::*;

/// Maximum number of suggestions.
const MAX_SUGGESTIONS: usize = 4;

/// Adds a suggestion to the error, if there is one. A command that moves a robot, deletes or overwrites is never
/// suggested, because the user could repeat the line without thinking.
pub fn add_suggestion(mut error: clap::Error, args: &[OsString], whole: &Command) -> clap::Error {
    let typed = TypedLine::new(args, whole);
    let tip = match error.kind() {
        ErrorKind::InvalidSubcommand => suggest_alternative(&mut error, &typed)
            .or_else(|| suggest_families(&error, &typed))
            .or_else(|| suggest_place(&mut error, ContextKind::InvalidSubcommand, &typed, whole)),
        ErrorKind::UnknownArgument => {
            // A flag is never meant as a value, so this suggestion is removed. A negative number may be meant as a
            // value.
            let is_flag = |value: &ContextValue| matches!(value, ContextValue::String(word) if word.starts_with("--"));
            if error.get(ContextKind::InvalidArg).is_some_and(is_flag) {
                error.remove(ContextKind::Suggested);
            }
            remove_unlike_flag(&mut error, &typed, whole);
            let tip = suggest_alternative(&mut error, &typed)
                .or_else(|| suggest_format(&mut error))
                .or_else(|| suggest_range(args, &typed, whole))
                .or_else(|| suggest_place(&mut error, ContextKind::InvalidArg, &typed, whole))
                .or_else(|| suggest_needed_flag(&error, args, &typed, whole))
                .or_else(|| suggest_quotes(&error, args, &typed, whole))
                .or_else(|| suggest_flag_or_value(&mut error, &typed, whole));
            let has_tip = error.get(ContextKind::SuggestedArg).or(error.get(ContextKind::Suggested)).is_some();
            tip.or_else(|| suggest_example(&typed.path, None).filter(|_| !has_tip))
        }
        ErrorKind::MissingRequiredArgument if typed.path == ["robots", "discover"] => {
            // The flag `--for` limits a condition, and this command has no condition.
            error = clap::Error::new(ErrorKind::UnknownArgument);
            error.insert(ContextKind::InvalidArg, ContextValue::String("--for".to_owned()));
            plain_usage(&mut error, &typed, whole);
            Some("robots discover ends by itself: remove --for".to_owned())
        }
        ErrorKind::MissingRequiredArgument => {
            suggest_pattern(args, &typed).or_else(|| suggest_value(&error, &typed, whole))
        }
        ErrorKind::InvalidValue => suggest_folder(&error, &typed, whole),
        ErrorKind::ValueValidation => std::error::Error::source(&error)
            .and_then(|why| suggest_number(&why.to_string()))
            .or_else(|| suggest_quoted_text(&error, args)),
        _ => None,
    };
    if let Some(tip) = tip {
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![tip.into()]));
    }
    error
}

/// Suggests an alternative for a feature that a family does not have.
fn suggest_alternative(error: &mut clap::Error, typed: &TypedLine<'_>) -> Option<String> {
    let path = typed.path.join(" ");
    let invalid = match error.get(ContextKind::InvalidArg) {
        Some(ContextValue::String(word)) => Some(word.as_str()),
        _ => None,
    };
    let is_meant = |word: &&str| Some(*word) == invalid || Some(word) == typed.rest.first();
    let (.., instead) = synonyms::ABSENT.iter().find(|(of, words, _)| *of == path && words.iter().any(is_meant))?;
    error.remove(ContextKind::SuggestedSubcommand);
    Some((*instead).to_owned())
}

/// Suggests the families that have a code, if the line contains a code but no family.
fn suggest_families(error: &clap::Error, typed: &TypedLine<'_>) -> Option<String> {
    let Some(ContextValue::String(code)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    if typed.path != ["explain"] || !code.chars().any(|one| one.is_ascii_digit()) {
        return None;
    }
    let of = families_with(code);
    let named = if of.is_empty() { Family::ALL.to_vec() } else { of };
    let lines: Vec<String> = named.iter().map(|family| format!("`armctl explain {family} {code}`")).collect();
    Some(format!("add the family of the code: {}", lines.join(" or ")))
}

/// Suggestion for a format that is typed as a flag.
fn suggest_format(error: &mut clap::Error) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else { return None };
    let format = ["csv", "jsonl", "table"].into_iter().find(|format| word.strip_prefix("--") == Some(format))?;
    error.remove(ContextKind::SuggestedArg);
    Some(format!("use -o {format}"))
}

/// Suggestion for numbers that are selected with `--from` and `--to`.
fn suggest_range(args: &[OsString], typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    let has = |flag: &str| command.get_arguments().any(|argument| argument.get_long() == Some(flag));
    let words = args.iter().rev().map_while(|word| word.to_str()?.parse::<u32>().ok());
    let numbers: Vec<u32> = words.collect();
    let (from, to) = (numbers.iter().min()?, numbers.iter().max()?);
    (has("from") && has("to")).then(|| {
        format!(
            "type the first and the last number with flags: --from {from} --to \
                                                {to}"
        )
    })
}

/// Suggests the correct form for a flag that is a plain value here, or for a value that belongs to a flag.
fn suggest_flag_or_value(error: &mut clap::Error, typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else { return None };
    let word = word.clone();
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    if let Some(flag) = word.strip_prefix("--") {
        let flag = flag.split('=').next().unwrap_or(flag);
        if command.get_positionals().any(|argument| argument.get_id() == "settings") {
            if error.remove(ContextKind::SuggestedArg).is_some() {
                plain_usage(error, typed, whole);
            }
            return Some(format!("type settings without --: {}=VALUE", flag.replace('-', "_")));
        }
        let is_named = |argument: &&Arg| argument.get_id().as_str().eq_ignore_ascii_case(flag);
        command.get_positionals().find(is_named)?;
        if error.remove(ContextKind::SuggestedArg).is_some() {
            plain_usage(error, typed, whole);
        }
        return Some(format!("type {} without --{flag}", flag.to_uppercase()));
    }
    if command.get_positionals().next().is_some() || word.starts_with('-') {
        return None;
    }
    let takes_value = |argument: &&Arg| argument.get_action().takes_values() && !argument.is_global_set();
    let accepts_word = |argument: &&Arg| {
        let values = argument.get_possible_values();
        values.is_empty() || values.iter().any(|value| value.matches(&word, true))
    };
    let flags = needed_flags(command).unwrap_or_else(|| {
        let flags = command.get_arguments().filter(takes_value).filter(accepts_word);
        flags.filter_map(|argument| Some(format!("--{}", argument.get_long()?))).collect()
    });
    if flags.len() > MAX_SUGGESTIONS {
        return Some(format!("type the value after its flag: see `armctl {} -h`", typed.path.join(" ")));
    }
    after_flag(&flags)
}

/// Suggests a flag for a value that the user typed without a flag, if the command needs one of several flags.
fn suggest_needed_flag(
    error: &clap::Error,
    args: &[OsString],
    typed: &TypedLine<'_>,
    whole: &Command,
) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else { return None };
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    let flags = needed_flags(command)?;
    let is_typed = |flag: &String| args.iter().any(|word| word.to_str().is_some_and(|word| word.starts_with(flag)));
    if word.starts_with("--") || flags.iter().any(is_typed) {
        return None;
    }
    after_flag(&flags)
}

/// Flags with a value, if the command needs one of these flags; `None` if the command has no such flags.
fn needed_flags(command: &Command) -> Option<Vec<String>> {
    let needed: Vec<_> = command.get_groups().filter(|group| group.is_required_set()).collect();
    let is_needed = |argument: &&Arg| needed.iter().any(|group| group.get_args().any(|id| id == argument.get_id()));
    let takes_value = |argument: &&Arg| argument.get_action().takes_values();
    let flags = command.get_arguments().filter(is_needed).filter(takes_value);
    let flags: Vec<String> = flags.filter_map(|argument| Some(format!("--{}", argument.get_long()?))).collect();
    (!flags.is_empty()).then_some(flags)
}

fn after_flag(flags: &[String]) -> Option<String> {
    (!flags.is_empty()).then(|| format!("type the value after its flag: {}", flags.join(", ")))
}

/// Suggests the correct place for the wrong word.
fn suggest_place(error: &mut clap::Error, kind: ContextKind, typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(kind) else { return None };
    let word = word.clone();
    remove_dangerous(error, &typed.path, whole);
    if kind == ContextKind::InvalidArg && (word.starts_with('-') || typed.path.len() > 1) {
        return None;
    }
    // A suggestion that only repeats the path without the wrong word is of no use.
    let leads_further = |line: &Suggestion| typed.path.is_empty() || parse_words(&line.0) != typed.path;
    let lines = lines(&word, typed, whole).into_iter().filter(leads_further);
    let (safe, dangerous): (Vec<Suggestion>, Vec<Suggestion>) = lines.partition(|line| risk(&line.0, whole).is_none());
    let mut commands_by_risk: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    for line in &dangerous {
        let words = parse_words(&line.0);
        let is_noun = find_command(&words, whole).0.is_some_and(Command::has_subcommands);
        let noun = if is_noun { &words[..] } else { &words[..words.len().saturating_sub(1)] };
        if let Some(risk) = risk(&line.0, whole) {
            commands_by_risk.entry(risk).or_default().insert(format!("`armctl {} -h`", noun.join(" ")));
        }
    }
    let dangerous = commands_by_risk
        .into_iter()
        .map(|(risk, helps)| format!("one that {risk}: see {}", helps.into_iter().collect::<Vec<_>>().join(", ")));
    let mut lines: Vec<String> = safe.into_iter().map(|line| line.format_line()).collect();
    lines.extend(dangerous);
    if lines.is_empty() || lines.len() > MAX_SUGGESTIONS {
        return None;
    }
    // The word is a correct command word, so the suggestion of a similar word is removed.
    error.remove(ContextKind::SuggestedSubcommand);
    Some(format!("the command is {}", lines.join(" or ")))
}

/// Returns the effect of a dangerous command; `None` for all other commands.
fn risk(line: &str, whole: &Command) -> Option<&'static str> {
    let words = parse_words(line);
    if !may_do_harm(&words, whole) {
        return None;
    }
    let (_, words) = find_command(&words, whole);
    let most =
        example_lines::robot_lines().filter(|(line, _)| line.split(' ').take(words.len()).eq(words.iter().copied()));
    Some(match most.map(|(_, risk)| risk).max() {
        Some(Risk::Destroy) => "deletes or overwrites",
        _ => "moves or powers the robot",
    })
}

/// Suggests quotes for a value with blanks, or a comma for numbers that are separated by blanks.
fn suggest_quotes(error: &clap::Error, args: &[OsString], typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidArg) else { return None };
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    let has_values = command
        .get_arguments()
        .any(|argument| argument.is_positional() || argument.get_action().takes_values() && !argument.is_global_set());
    if word.starts_with("--") || command.has_subcommands() || !has_values {
        return None;
    }
    let words: Vec<&str> = args.iter().filter_map(|word| word.to_str()).collect();
    let at = words.iter().rposition(|other| other == word)?;
    let is_number = |word: &&str| word.parse::<f64>().is_ok();
    let is_value = |word: &&str| !word.starts_with('-') || is_number(word);
    let first = words[..at].iter().rposition(|word| !is_value(word) || typed.typed_path.contains(word))? + 1;
    // Only the last argument may be a value with blanks.
    let is_of_flag = words[first - 1].starts_with('-');
    let others = if is_of_flag { 0 } else { command.get_positionals().count().saturating_sub(1) };
    let values: Vec<&str> = words[first..].iter().copied().take_while(is_value).skip(others).collect();
    if values.len() < 2 {
        return None;
    }
    // A value with a range is not part of a text.
    if values.iter().any(|value| value.contains("..")) {
        return None;
    }
    let takes_numbers =
        is_of_flag || command.get_positionals().last().is_some_and(|last| last.get_value_delimiter().is_some());
    if values.iter().all(is_number) && !takes_numbers {
        return None;
    }
    Some(if values.iter().all(is_number) {
        format!("write the numbers with commas and without spaces: {}", values.join(","))
    } else {
        let quote = if values.concat().contains('\'') { '"' } else { '\'' };
        format!("put a value with spaces in quotes: {quote}{}{quote}", values.join(" "))
    })
}

/// Suggests quotes for `NAME=VALUE` with a text of several words, for example `S1=HELLO WORLD`.
fn suggest_quoted_text(error: &clap::Error, args: &[OsString]) -> Option<String> {
    let Some(ContextValue::String(word)) = error.get(ContextKind::InvalidValue) else { return None };
    let words: Vec<&str> = args.iter().filter_map(|word| word.to_str()).collect();
    let at = words.iter().position(|other| other == word).filter(|_| !word.contains('='))?;
    let pair = words[..at].last().filter(|before| before.contains('=') && !before.starts_with('-'))?;
    let quote = if pair.contains('\'') || word.contains('\'') { '"' } else { '\'' };
    Some(format!("put a value with spaces in quotes: {quote}{pair} {word}{quote}"))
}

/// Suggests the folder flag if the user typed the format flag with a folder.
fn suggest_folder(error: &clap::Error, typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg) else { return None };
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    let has_folder = command.get_arguments().any(|argument| argument.get_long() == Some("dir"));
    (has_folder && flag.starts_with("--output")).then(|| "use --dir for the folder; --output is the format".to_owned())
}

/// Returns a suggestion for an invalid number.
fn suggest_number(why: &str) -> Option<String> {
    if let Some((least, most)) = why.split_once(" is not in ").and_then(|(_, range)| range.split_once("..=")) {
        return Some(format!("write a number from {least} to {most}"));
    }
    if why.ends_with(" given") {
        return Some("separate the numbers with commas, and use a decimal point: 1.5,20".to_owned());
    }
    let is_std = ["invalid digit found", "number too large", "number too small"].iter().any(|it| why.starts_with(it));
    decimal_point(why).or_else(|| is_std.then(|| "write a whole number".to_owned()))
}

/// Suggests a pattern if the user asks for all files, because `--all` selects robots.
fn suggest_pattern(args: &[OsString], typed: &TypedLine<'_>) -> Option<String> {
    let is_meant = typed.path == ["yerc", "file", "get"] && args.iter().any(|word| word == "--all");
    is_meant
        .then(|| "use '*' for all files, '*.JBI' for all jobs; --all selects all robots in the inventory".to_owned())
}

/// Returns a suggestion for a missing value.
fn suggest_value(error: &clap::Error, typed: &TypedLine<'_>, whole: &Command) -> Option<String> {
    let Some(ContextValue::Strings(missing)) = error.get(ContextKind::InvalidArg) else { return None };
    let command = typed.path.iter().try_fold(whole, |command, word| command.find_subcommand(word))?;
    let is_missing = |argument: &&Arg| missing.first().is_some_and(|first| *first == argument.to_string());
    let argument = command.get_arguments().find(is_missing);
    if missing.iter().any(|argument| argument.starts_with("--until")) {
        return Some("add a condition, for example --until idle; --for sets the longest wait".to_owned());
    }
    let values = argument?.get_possible_values();
    let names: Vec<&str> = values.iter().map(clap::builder::PossibleValue::get_name).collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => Some(format!("use {} or {last}", others.join(", "))),
        _ => suggest_example(&typed.path, argument?.get_long()),
    }
}

/// Returns an example of the command, with the missing flag if possible. There is no example of a dangerous command.
fn suggest_example(path: &[&str], missing: Option<&str>) -> Option<String> {
    let lines: Vec<String> = example_lines::examples(path).filter(|_| example_lines::preselects(path)).collect();
    let has_flag = |line: &&String| line.split(' ').any(|word| word.strip_prefix("--") == missing);
    let line = lines.iter().find(has_flag).or(lines.first())?;
    Some(format!("example: `armctl {line}`"))
}

/// Removes the suggestion of a flag that does not resemble the typed flag enough.
fn remove_unlike_flag(error: &mut clap::Error, typed: &TypedLine<'_>, whole: &Command) {
    let (Some(ContextValue::String(word)), Some(ContextValue::String(similar))) =
        (error.get(ContextKind::InvalidArg), error.get(ContextKind::SuggestedArg))
    else {
        return;
    };
    let [word, similar] = [word, similar].map(|flag| flag.trim_start_matches('-').to_owned());
    let is_alike = word.starts_with(&similar) && similar.len() > 1 || nearest(&word, [similar.as_str()]).is_some();
    if !is_alike {
        error.remove(ContextKind::SuggestedArg);
        plain_usage(error, typed, whole);
    }
}

/// Replaces the usage text by the usage of the command alone, without flags that the user did not mean.
fn plain_usage(error: &mut clap::Error, typed: &TypedLine<'_>, whole: &Command) {
    let mut whole = whole.clone();
    whole.build();
    let command = typed.path.iter().try_fold(&mut whole, |command, word| command.find_subcommand_mut(word));
    if let Some(command) = command {
        error.insert(ContextKind::Usage, ContextValue::StyledStr(command.render_usage()));
    }
}

/// Whether the words lead to a dangerous command. Aliases are included.
fn may_do_harm(words: &[&str], whole: &Command) -> bool {
    let (command, path) = find_command(words, whole);
    is_dangerous(&path, command.is_some_and(Command::has_subcommands))
}

/// Returns the command of these words, and the words with the primary names of the commands.
fn find_command<'a>(words: &[&'a str], whole: &'a Command) -> (Option<&'a Command>, Vec<&'a str>) {
    let mut command = Some(whole);
    let path = words.iter().map(|word| {
        command = command.and_then(|command| command.find_subcommand(word));
        command.map_or(*word, Command::get_name)
    });
    let path = path.collect();
    (command, path)
}

/// Verbs that read. A verb that reads is never suggested as a correction of a verb that writes, for example `get` for
/// `set`.
const READS: [&str; 5] = ["get", "list", "show", "read", "ls"];

/// Removes dangerous commands from the suggested similar words.
fn remove_dangerous(error: &mut clap::Error, path: &[&str], whole: &Command) {
    let Some(similar) = error.remove(ContextKind::SuggestedSubcommand) else { return };
    let typed = match error.get(ContextKind::InvalidSubcommand) {
        Some(ContextValue::String(typed)) => typed.clone(),
        _ => String::new(),
    };
    let reads = READS.contains(&typed.as_str());
    let is_safe = |word: &String| {
        let writes = reads && matches!(word.as_str(), "set" | "put");
        !writes && !may_do_harm(&[path, &[word.as_str()]].concat(), whole)
    };
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
    match safe {
        Some(safe) => error.insert(ContextKind::SuggestedSubcommand, safe),
        // The list of other suggestions is empty. clap would print it as a blank line.
        None => error.remove(ContextKind::Suggested),
    };
}

/// A suggested command line, and the text that follows it.
struct Suggestion(String, &'static str);

impl Suggestion {
    fn new(line: impl Into<String>) -> Self {
        Self(line.into(), "")
    }

    fn format_line(&self) -> String {
        format!("`armctl {}`{}", self.0, self.1)
    }
}

fn parse_words(line: &str) -> Vec<&str> {
    line.split(' ').filter(|word| *word != "…" && !word.starts_with('-')).collect()
}

/// Command lines in which the word is in its correct place.
fn lines(word: &str, typed: &TypedLine<'_>, whole: &Command) -> Vec<Suggestion> {
    let words = typed.words();
    if word.parse::<Family>().is_ok() {
        let others: Vec<&str> = words.iter().copied().filter(|other| *other != word).collect();
        let family = whole.find_subcommand(word);
        let exists =
            others.first().is_some_and(|first| family.is_some_and(|family| family.find_subcommand(first).is_some()));
        return if exists { vec![Suggestion::new(format!("{word} {}", others.join(" ")))] } else { Vec::new() };
    }
    let family = words.iter().find_map(|word| word.parse::<Family>().ok());
    if family.is_some() && whole.find_subcommand(word).is_some() {
        return vec![Suggestion(word.to_owned(), ", a command for all families")];
    }
    let words: Vec<&str> = words.into_iter().filter(|word| word.parse::<Family>().is_err()).collect();
    let families = Family::ALL.into_iter().filter(|other| family.is_none_or(|family| family == *other));
    let families: Vec<&Command> = families.filter_map(|family| whole.find_subcommand(family.name())).collect();
    let all = |find: &dyn Fn(&Command) -> Vec<Suggestion>| {
        families.iter().flat_map(|family| find(family)).collect::<Vec<_>>()
    };
    [
        all(&|family| reverse_words(family, &words)),
        replace_synonym(&words, family),
        all(&|family| find_sibling_verbs(family, &words)),
        all(&|family| collect_subcommands(family, word)),
    ]
    .into_iter()
    .find(|lines| !lines.is_empty())
    .map(|lines| common_lines(lines, whole))
    .unwrap_or_default()
}

/// If a command for all families exists, replaces the suggestions for the single families by this command.
fn common_lines(lines: Vec<Suggestion>, whole: &Command) -> Vec<Suggestion> {
    let shared = match &lines[..] {
        [Suggestion(first, _), _, ..] => first.split_once(' ').map(|(_, words)| words.to_owned()),
        _ => None,
    };
    let Some(shared) = shared else { return lines };
    let is_same = |line: &Suggestion| line.0.split_once(' ').is_some_and(|(_, words)| words == shared);
    let exists = parse_words(&shared).iter().try_fold(whole, |command, word| command.find_subcommand(word)).is_some();
    if exists && lines.iter().all(is_same) { vec![Suggestion::new(shared)] } else { lines }
}

/// Suggests the correct order if the verb comes before its noun.
fn reverse_words(family: &Command, words: &[&str]) -> Vec<Suggestion> {
    let [verb, noun, ..] = words else { return Vec::new() };
    let exists = family.find_subcommand(noun).is_some_and(|noun| noun.find_subcommand(verb).is_some());
    if exists { vec![Suggestion::new(format!("{} {noun} {verb}", family.get_name()))] } else { Vec::new() }
}

/// Returns suggestions from the table of synonyms. The entry that matches the most words is used.
fn replace_synonym(words: &[&str], family: Option<Family>) -> Vec<Suggestion> {
    let typed = |entry: &&(&str, &[&str])| words.starts_with(&entry.0.split(' ').collect::<Vec<_>>());
    let Some((_, ways)) = synonyms::LINES.iter().filter(typed).max_by_key(|(words, _)| words.len()) else {
        return Vec::new();
    };
    let of = |way: &str| way.split(' ').next().and_then(|word| word.parse::<Family>().ok());
    let fits = |way: &&&str| of(way).is_none_or(|other| family.is_none_or(|family| family == other));
    ways.iter().filter(fits).map(|way| Suggestion::new(*way)).collect()
}

/// Suggests the verbs of a noun if the user typed a synonym of a verb.
fn find_sibling_verbs(family: &Command, words: &[&str]) -> Vec<Suggestion> {
    let [noun, verb, ..] = words else { return Vec::new() };
    let Some(command) = family.find_subcommand(noun) else { return Vec::new() };
    let Some((_, verbs)) = synonyms::VERBS.iter().find(|(other, _)| other == verb) else { return Vec::new() };
    let found = verbs.iter().find(|verb| command.find_subcommand(verb).is_some());
    found.map(|verb| Suggestion::new(format!("{} {noun} {verb}", family.get_name()))).into_iter().collect()
}

/// Suggests a line for a word that is a command of a family, or a verb of one of its nouns.
fn collect_subcommands(family: &Command, word: &str) -> Vec<Suggestion> {
    let name = family.get_name();
    if let Some(command) = family.find_subcommand(word) {
        let more = if command.has_subcommands() { " …" } else { "" };
        return vec![Suggestion::new(format!("{name} {word}{more}"))];
    }
    let nouns = family.get_subcommands().filter(|noun| noun.find_subcommand(word).is_some());
    nouns.map(|noun| Suggestion::new(format!("{name} {} {word}", noun.get_name()))).collect()
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
        let text = add_suggestion(error, &args, &whole).render().to_string();
        text.lines().find_map(|line| line.trim().strip_prefix("tip: ").map(ToOwned::to_owned))
    }

    #[test]
    fn suggests_the_right_place_of_a_word() {
        for (line, expected) in [
            ("armctl hlock on", "the command is `armctl yerc hlock`"),
            (
                "armctl servo on",
                "the command is one that moves or powers the robot: see `armctl toyo -h`, `armctl yerc -h`, `armctl yrcx -h`",
            ),
            ("armctl status yerc", "the command is `armctl yerc status`"),
            ("armctl --sim status toyo", "the command is `armctl toyo status`"),
            ("armctl yerc select WELD", "the command is `armctl yerc job select`"),
            ("armctl yerc robots list", "the command is `armctl robots`, a command for all families"),
            ("armctl stats", "a similar subcommand exists: 'status'"),
            ("armctl yerc jop", "some similar subcommands exist: 'stop', 'job'"),
        ] {
            assert_eq!(tip(line).as_deref(), Some(expected), "{line}");
        }
        assert_eq!(tip("armctl toyo get"), None);
        assert_eq!(tip("armctl toyo run 1"), None, "the path so far leads no further");
        assert_eq!(tip("armctl status nonsense").as_deref(), Some("example: `armctl status`"));
    }

    #[test]
    fn suggests_commands_for_synonyms_and_other_word_orders() {
        for (line, expected) in [
            ("armctl get file", "`armctl yerc file get`"),
            ("armctl yerc get file A.JBI", "`armctl yerc file get`"),
            ("armctl list alarm", "`armctl alarm list`"),
            ("armctl yerc file ls", "`armctl yerc file list`"),
            ("armctl yerc io read 1", "`armctl yerc io get`"),
            ("armctl yerc start COUNT", "one that moves or powers the robot: see `armctl yerc job -h`"),
            ("armctl yerc job run", "one that moves or powers the robot: see `armctl yerc job -h`"),
            ("armctl job run", "one that moves or powers the robot: see `armctl yerc job -h`"),
            ("armctl yerc file rm A.JBI", "one that deletes or overwrites: see `armctl yerc file -h`"),
            ("armctl yrcx error", "`armctl yrcx alarm list`"),
            ("armctl error", "`armctl alarm list`"),
            (
                "armctl version",
                "`armctl --version` or `armctl yerc info` or `armctl yrcx info version` or `armctl toyo info`",
            ),
            ("armctl toyo version", "`armctl --version` or `armctl toyo info`"),
            ("armctl pause", "`armctl yerc hold on` or `armctl yrcx stop` or `armctl toyo stop`"),
        ] {
            assert_eq!(tip(line), Some(format!("the command is {expected}")), "{line}");
        }
    }

    #[test]
    fn never_suggests_an_alias_of_a_motion_command() {
        for line in ["armctl toyo origi", "armctl toyo hom", "armctl yrcx hom", "armctl yrcx origi"] {
            let tip = tip(line).unwrap_or_default();
            assert!(!tip.contains("home") && !tip.contains("origin"), "{line}: {tip}");
        }
        let absent = tip("armctl yerc origin").unwrap();
        assert!(
            absent.starts_with("the protocol has no command for a return to origin") && !absent.contains("job start"),
            "{absent}"
        );
    }

    #[test]
    fn every_synonym_leads_to_a_command() {
        let whole = Cli::command();
        let exists = |words: &[&str]| {
            words
                .iter()
                .try_fold(&whole, |command, word| command.find_subcommand(word).or((*word == "on").then_some(command)))
        };
        for (_, ways) in synonyms::LINES {
            for way in *ways {
                assert!(exists(&parse_words(way)).is_some(), "{way}");
            }
        }
        let words: Vec<&str> = synonyms::LINES.iter().map(|(words, _)| *words).collect();
        assert!(words.is_sorted() && synonyms::VERBS.is_sorted_by_key(|(verb, _)| *verb));
    }

    #[test]
    fn suggests_the_typed_form_of_values() {
        for (line, expected) in [
            ("armctl yerc servo", "use on or off"),
            ("armctl yerc cycle", "use step, once or continuous"),
            ("armctl yerc job select", "example: `armctl yerc job select WELD`"),
            ("armctl yerc say BACK AT NOON", "put a value with spaces in quotes: 'BACK AT NOON'"),
            ("armctl yrcx comment set 100 WAIT ORG", "put a value with spaces in quotes: 'WAIT ORG'"),
            (
                "armctl yerc move joint --to 400 0 300 180 0 0 --speed 10%",
                "write the numbers with commas and without spaces: 400,0,300,180,0,0",
            ),
            ("armctl yerc move relative --z 2,5 --speed 1mm/s", "use a decimal point: 2.5"),
            ("armctl yerc var set S1=HELLO WORLD", "put a value with spaces in quotes: 'S1=HELLO WORLD'"),
            (
                "armctl yerc move linear --to 1,5,2,3,4,5,6 --speed 1mm/s",
                "separate the numbers with commas, and use a decimal point: 1.5,20",
            ),
            ("armctl yerc var set R1=2,5", "use a decimal point: 2.5"),
            ("armctl --timeout 1,5s yerc status", "use a decimal point: 1.5s"),
            ("armctl --count 1,5 yerc status", "write a whole number"),
            ("armctl yerc file get A.JBI --output saved", "use --dir for the folder; --output is the format"),
            ("armctl yerc job start --name WELD", "type NAME without --name"),
            ("armctl yrcx point set 19 1,2,3,4", "type the value after its flag: --mm, --pulse, --position"),
            ("armctl yrcx move 19", "type the value after its flag: --point, --to, --to-pulse"),
            ("armctl robots discover --for 3s", "robots discover ends by itself: remove --for"),
            (
                "armctl toyo run point 1 --speed 10",
                "no command sets the speed of one move; the stored override scales all of them: `armctl toyo override set 10`",
            ),
            ("armctl toyo program get 5 6 7", "type the first and the last number with flags: --from 5 --to 7"),
            ("armctl yerc move joint P2", "type the value after its flag: see `armctl yerc move joint -h`"),
            ("armctl alarm history --csv", "use -o csv"),
            ("armctl compare a b", "the command is `armctl diff`"),
            ("armctl yerc names set clamp B9", "the command is `armctl names set NAME ADDRESS -r ROBOT`"),
            ("armctl yerc info position", "the command is `armctl yerc position`"),
            ("armctl names add clamp 27010", "the command is `armctl names set NAME ADDRESS -r ROBOT`"),
            ("armctl toyo program run", "the command is one that moves or powers the robot: see `armctl toyo run -h`"),
            ("armctl toyo io in", "the command is `armctl toyo io list`"),
            ("armctl explain 28", "add the family of the code: `armctl explain yerc 28` or `armctl explain toyo 28`"),
        ] {
            assert_eq!(tip(line).as_deref(), Some(expected), "{line}");
        }
        assert_eq!(tip("armctl yerc file delete"), None, "it deletes");
        let args = ["armctl", "yrcx", "program", "lst"].map(OsString::from);
        let error = Cli::command().try_get_matches_from_mut(&args).unwrap_err();
        let text = add_suggestion(error, &args, &Cli::command()).render().to_string();
        assert!(!text.contains("\n\n\n"), "a tip that was removed leaves no blank line: {text}");
    }

    #[test]
    fn suggests_an_example_unless_it_is_dangerous() {
        for (line, expected) in [
            ("armctl yerc status x", "example: `armctl yerc status`"),
            ("armctl yerc var get B0 --bananas", "example: `armctl yerc var get B0`"),
            ("armctl robots list --bananas", "example: `armctl robots list`"),
        ] {
            assert_eq!(tip(line).as_deref(), Some(expected), "{line}");
        }
        for line in
            ["armctl yerc move joint --bananas", "armctl yerc move joint --xyzzy 3", "armctl robots remove --bananas"]
        {
            assert_eq!(tip(line), None, "{line}");
        }
    }

    #[test]
    fn usage_names_only_typed_flags() {
        for (line, expected) in [
            ("armctl yerc job start --name X", "Usage: armctl yerc job start [OPTIONS] [NAME]"),
            ("armctl robots discover --for 3s", "Usage: armctl robots discover [OPTIONS] [ADDRESS[:PORT]]..."),
        ] {
            let args: Vec<OsString> = line.split(' ').map(Into::into).collect();
            let mut whole = Cli::command();
            let error = whole.try_get_matches_from_mut(&args).unwrap_err().format(&mut whole);
            let text = add_suggestion(error, &args, &whole).render().to_string();
            assert!(text.contains(expected) && !text.contains("--until"), "{text}");
        }
    }
}

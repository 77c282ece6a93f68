//! Adapter for clap's completion engine. The interface of the engine is unstable, so only this file uses it.
//!
//! The engine builds the whole command tree, and interprets every word before the cursor as a subcommand. Therefore
//! clap's own parser first finds the command of the line. The engine gets only this command.

use std::ffi::{OsStr, OsString};
use std::sync::Arc;
use std::time::Duration;

use clap::{Arg, ArgAction, ArgMatches, Command, CommandFactory as _};
use clap_complete::engine::{ArgValueCompleter, CompletionCandidate};

use super::values::{self, Context};
use crate::cli::Cli;
use armctl_frame::{Candidate, ValueKind};

/// Tag of candidates after which the user must type more text.
const INCOMPLETE_TAG: &str = "begun";

/// Returns candidates for the word `current` after the words `before`. `None` if the line cannot be parsed. `is_among`
/// is `true` if this process also runs other lines. `connects` is `true` if a connection to a robot is allowed.
pub(super) fn complete(
    mut before: Vec<OsString>,
    current: &OsStr,
    (is_among, connects): (bool, bool),
    time_limit: Duration,
) -> Option<Vec<Candidate>> {
    let mut root = Cli::command().ignore_errors(true);
    let matches = root.try_get_matches_from_mut(&before).ok()?;
    let path = path(&matches);
    let context = Arc::new(Context::new(&matches, (is_among, connects), time_limit));
    let mut reduced = narrow(&root, &path, &context)?;
    if !is_among {
        // The tree is leaked: freeing its thousands of parts takes time, and the process is about to exit.
        std::mem::forget(root);
    }
    for word in &mut before {
        // The engine would interpret a negative number as a flag.
        if word.to_str().is_some_and(is_negative) {
            *word = "0".into();
        }
    }
    let own = own_flags(&reduced, &path);
    before.push(current.to_owned());
    let index = before.len() - 1;
    let found = clap_complete::engine::complete(&mut reduced, before, index, None).ok()?;
    let mut found: Vec<Candidate> = found.iter().filter_map(candidate).collect();
    if current.is_empty() {
        // For an empty word, the forty global flags are not offered, because such a long list does not help the user.
        let is_flag = |candidate: &Candidate| candidate.value.starts_with('-') && candidate.value != "-";
        let has_others = found.iter().any(|candidate| !is_flag(candidate));
        found.retain(|candidate| if has_others { !is_flag(candidate) } else { own.contains(&candidate.value) });
    }
    Some(found)
}

fn candidate(found: &CompletionCandidate) -> Option<Candidate> {
    let help = found.get_help().map(|help| help.to_string().lines().next().unwrap_or_default().to_owned());
    let value = found.get_value().to_str()?.to_owned();
    // More text must follow a folder, and a flag that has its value after `=`.
    let is_begun = found.get_tag().is_some_and(|tag| tag.to_string() == INCOMPLETE_TAG) || value.ends_with(['/', '=']);
    Some(Candidate { value, help, is_incomplete: is_begun })
}

/// Returns the subcommands in the line.
fn path(matches: &ArgMatches) -> Vec<String> {
    let mut path = Vec::new();
    let mut next = matches.subcommand();
    while let Some((name, matches)) = next {
        path.push(name.to_owned());
        next = matches.subcommand();
    }
    path
}

/// Reduces the command tree to the command at `path` and the words that can follow it.
fn narrow(command: &Command, path: &[String], context: &Arc<Context>) -> Option<Command> {
    let narrowed = Command::new(command.get_name().to_owned())
        .disable_help_flag(true)
        .disable_version_flag(true)
        .disable_help_subcommand(true)
        .groups(command.get_groups().cloned())
        .args(command.get_arguments().map(|argument| with_values(argument, context)));
    Some(match path.split_first() {
        Some((name, rest)) => narrowed.subcommand(narrow(command.find_subcommand(name)?, rest, context)?),
        None => narrowed.subcommands(command.get_subcommands().map(|verb| {
            let about = verb.get_about().cloned().unwrap_or_default();
            Command::new(verb.get_name().to_owned()).about(about).hide(verb.is_hide_set()).disable_help_flag(true)
        })),
    })
}

/// Adds the candidates to an argument that has a kind of value.
fn with_values(argument: &Arg, context: &Arc<Context>) -> Arg {
    let argument = argument.clone();
    // The engine would panic if an unknown flag precedes such an argument.
    let argument = if argument.is_positional() { argument.allow_hyphen_values(false) } else { argument };
    let shows = matches!(argument.get_action(), ArgAction::Help | ArgAction::HelpShort | ArgAction::Version);
    let argument = if shows { argument.action(ArgAction::SetTrue) } else { argument };
    let Some(kind) = argument.get::<ValueKind>().copied() else { return argument };
    // On a command line, any folder is valid. Only a selection list is restricted to backups.
    if matches!(kind, ValueKind::Backup) && !context.connects() {
        return argument;
    }
    let context = Arc::clone(context);
    argument.add(ArgValueCompleter::new(move |current: &OsStr| {
        let found = current.to_str().map_or_else(Vec::new, |current| values::of(kind, current, &context));
        let found = found.into_iter().enumerate().map(|(order, Candidate { value, help, is_incomplete: is_begun })| {
            let tag = is_begun.then(|| INCOMPLETE_TAG.into());
            CompletionCandidate::new(value).help(help.map(Into::into)).display_order(Some(order)).tag(tag)
        });
        found.collect()
    }))
}

/// Returns the flags that belong only to the command at the end of `path`.
fn own_flags(root: &Command, path: &[String]) -> Vec<String> {
    let command = path.iter().fold(root, |command, name| command.find_subcommand(name).unwrap_or(command));
    let own = command.get_arguments().filter(|argument| !argument.is_global_set());
    own.filter_map(Arg::get_long).filter(|long| *long != "help").map(|long| format!("--{long}")).collect()
}

fn is_negative(word: &str) -> bool {
    word.strip_prefix('-').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '.'))
}

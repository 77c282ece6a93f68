//! Completion protocol of the shells.
//!
//! The scripts in `completions/` set `ARMCTL_COMPLETE` to the name of the shell, and pass `--` and the words up to the
//! cursor. Bash also splits words at `=` and `:`. The bash script therefore passes the whole line and the part at the
//! cursor. The variable then also contains the type of display and the width.

use std::ffi::OsString;

use clap::ValueEnum as _;

use super::complete;
use crate::command::about::completions::Shell;
use armctl_frame::Candidate;

/// Environment variable that requests a completion.
const SHELL_VARIABLE: &str = "ARMCTL_COMPLETE";

/// Returns the answer to a completion request; `None` if this process was not started for a completion.
pub fn answer(args: &[OsString]) -> Option<String> {
    let shell_name = std::env::var(SHELL_VARIABLE).ok()?;
    let mut asked = shell_name.split_whitespace();
    let shell = Shell::from_str(asked.next()?, false).ok()?;
    let [_, dashes, words @ ..] = args else { return None };
    if dashes != "--" {
        return None;
    }
    let mut number = || asked.next().and_then(|number| number.parse().ok());
    Some(match (shell, words) {
        (Shell::Bash, [line, piece]) => {
            let is_list = number().is_some_and(|how: usize| LISTING.contains(&how));
            let width = number().filter(|_| is_list);
            bash(&line.to_string_lossy(), &piece.to_string_lossy(), width)
        }
        (Shell::Bash, _) | (_, []) => String::new(),
        (Shell::Powershell, [before @ .., last]) => {
            let last = last.to_str().and_then(|last| last.strip_prefix('+')).unwrap_or_default();
            let words: Vec<OsString> = before.iter().cloned().chain([last.into()]).collect();
            lines(&complete(&words, before.len(), false), with_description)
        }
        (Shell::Fish, words) => lines(&complete(words, words.len() - 1, false), with_description),
        (Shell::Zsh, words) => lines(&complete(words, words.len() - 1, false), |found| {
            format!("{}{}", separator(found), with_description(found))
        }),
        (Shell::Elvish, words) => lines(&complete(words, words.len() - 1, false), |found| found.value.clone()),
    })
}

/// Values of `COMP_TYPE` for which bash shows a list. Only a list can contain descriptions.
const LISTING: [usize; 2] = ['?' as usize, '!' as usize];

fn lines(found: &[Candidate], line: impl Fn(&Candidate) -> String) -> String {
    found.iter().map(|found| line(found) + "\n").collect()
}

fn with_description(found: &Candidate) -> String {
    match &found.help {
        Some(help) => format!("{}\t{help}", found.value),
        None => found.value.clone(),
    }
}

/// Returns the character that follows a candidate: a blank, unless the user must type more text.
fn separator(found: &Candidate) -> char {
    if found.is_incomplete { '-' } else { '+' }
}

/// Returns the candidates at the end of `line`, in the form with which bash replaces `piece`.
fn bash(line: &str, piece: &str, width: Option<usize>) -> String {
    let Split { words, quote } = Split::of(line);
    let index = words.len() - 1;
    let current = words[index].to_string_lossy().into_owned();
    let words: Vec<OsString> = words.into_iter().collect();
    let found = complete(&words, index, false);
    // bash has split the word, and `piece` is only its last part.
    let piece = if quote.is_some() { piece.trim_start_matches(['"', '\'']) } else { piece };
    let unchanged = Split::of(piece).words.pop().map_or(0, |piece| piece.len());
    let before = current.len().saturating_sub(unchanged);
    let longest = found.iter().map(|found| found.value.chars().count()).max().unwrap_or(0);
    let width = width.filter(|_| found.len() > 1);
    lines(&found, |found| {
        let value = found.value.get(before..).unwrap_or(&found.value);
        let value = if quote.is_some() { value.to_owned() } else { escape(value) };
        let sign = separator(found);
        match (&found.help, width) {
            (Some(help), Some(width)) => {
                let room = width.saturating_sub(longest + 6);
                let help: String = help.chars().take(room).collect();
                format!("{sign}{value:longest$}  ({help})")
            }
            _ => format!("{sign}{value}"),
        }
    })
}

/// Escapes a value for bash.
fn escape(value: &str) -> String {
    let mut escaped = String::new();
    for (index, c) in value.char_indices() {
        let is_special = " \t'\"\\$`&|;<>()*?[]{}!".contains(c) || (index == 0 && "~#".contains(c));
        escaped.extend(is_special.then_some('\\'));
        escaped.push(c);
    }
    escaped
}

/// An incomplete line, split into words like in a shell.
struct Split {
    /// Words of the line. The last word is at the cursor and can be empty.
    words: Vec<OsString>,
    /// Quote that is still open at the end.
    quote: Option<char>,
}

impl Split {
    fn of(line: &str) -> Self {
        let mut words = Vec::new();
        let mut word = String::new();
        let mut is_begun = false;
        let mut quote = None;
        let mut chars = line.chars();
        while let Some(c) = chars.next() {
            match (c, quote) {
                (_, Some(open)) if c == open => quote = None,
                ('\\', None | Some('"')) => word.extend(chars.next()),
                ('"' | '\'', None) => quote = Some(c),
                (' ' | '\t' | '\n', None) => {
                    if is_begun {
                        words.push(std::mem::take(&mut word).into());
                    }
                    is_begun = false;
                    continue;
                }
                _ => word.push(c),
            }
            is_begun = true;
        }
        words.push(word.into());
        Self { words, quote }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splits_incomplete_lines() {
        let split = |line: &str| {
            let Split { words, quote } = Split::of(line);
            let words: Vec<String> = words.into_iter().map(|word| word.into_string().unwrap()).collect();
            (words.join("|"), quote)
        };
        assert_eq!(split("armctl yerc "), ("armctl|yerc|".to_owned(), None));
        assert_eq!(split("armctl -t sim: yerc st"), ("armctl|-t|sim:|yerc|st".to_owned(), None));
        assert_eq!(split(r#"armctl file get "A B" 'C D"#), ("armctl|file|get|A B|C D".to_owned(), Some('\'')));
        assert_eq!(split(r"a\ b ''"), ("a b|".to_owned(), None));
        assert_eq!(split(""), (String::new(), None));
        assert_eq!(split("\\"), (String::new(), None));
    }

    #[test]
    fn bash_replaces_the_current_piece() {
        assert_eq!(bash("armctl yerc job sel", "sel", None), "+select\n");
        assert_eq!(bash("yerc job sel", "sel", None), "+select\n");
        assert_eq!(bash("armctl --output=js", "js", None), "+json\n+jsonl\n");
        assert_eq!(bash("armctl -t si", "si", None), "-sim:\n");
        assert_eq!(bash("armctl -t sim: yerc sta", "sta", None), "+status\n");
        assert_eq!(bash("armctl explain y", "y", Some(80)).lines().count(), 2);
        assert!(bash("armctl explain toyo 2", "2", Some(40)).lines().all(|line| line.chars().count() <= 40));
        assert_eq!(escape("A B(1)"), r"A\ B\(1\)");
    }
}

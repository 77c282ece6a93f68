//! Completion, hints and colors for the line that the user types.

use std::borrow::Cow;
use std::cell::RefCell;
use std::ffi::OsString;

use rustyline::completion::{Completer, Pair};
use rustyline::highlight::Highlighter;
use rustyline::hint::{Hinter, HistoryHinter};
use rustyline::validate::Validator;
use rustyline::{Context, Helper};

use super::line_parser::LineParser;
use crate::app::complete::complete;
use crate::app::line_words;
use armctl_frame::flags::Globals;

/// Assistant of the line editor.
pub struct Assistant {
    line_parser: RefCell<LineParser>,
    /// Flags of the REPL that select the robots for all lines.
    flags: Vec<OsString>,
    hinter: HistoryHinter,
    colour: bool,
}

impl Assistant {
    /// Creates an assistant for lines that are parsed with this parser and these flags.
    pub fn new(line_parser: &LineParser, globals: &Globals) -> Self {
        Self {
            line_parser: RefCell::new(LineParser::new(line_parser.prefix().to_vec())),
            flags: globals.robot_words().into_iter().map(OsString::from).collect(),
            hinter: HistoryHinter::new(),
            colour: globals.screen().stdout_color(),
        }
    }

    /// Returns the start of the last word, and its candidates.
    fn candidates(&self, line: &str) -> (usize, Vec<Pair>) {
        let start = word_start(line);
        let (before, typed) = line.split_at(start);
        let Ok(before) = line_words::split(before) else { return (start, Vec::new()) };
        let typed = typed.trim_start_matches(['\'', '"']).replace('\\', "");
        let mut found: Vec<Pair> = Vec::new();
        let mut is_whole = false;
        for mut words in self.line_parser.borrow_mut().beginnings(&before) {
            words.splice(1..1, self.flags.iter().cloned());
            words.push(OsString::from(&typed));
            for candidate in complete(&words, words.len() - 1, true) {
                let Some(replacement) = quote(&candidate.value) else { continue };
                if found.iter().all(|other| other.replacement != replacement) {
                    is_whole = !candidate.is_incomplete;
                    found.push(Pair { display: candidate.value, replacement });
                }
            }
        }
        if let [only] = &mut found[..]
            && is_whole
        {
            only.replacement.push(' ');
        }
        (start, found)
    }
}

/// Quotes a word if necessary. Returns `None` if the word cannot be typed.
fn quote(word: &str) -> Option<String> {
    let is_plain = |c: char| c.is_alphanumeric() || "-_=.,:/+@%".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return Some(word.to_owned());
    }
    shlex::try_quote(word).ok().map(Cow::into_owned)
}

/// Returns the start of the last word, including its quote.
fn word_start(line: &str) -> usize {
    let (mut start, mut quote, mut escaped) = (0, None, false);
    for (at, c) in line.char_indices() {
        match (quote, c) {
            _ if escaped => escaped = false,
            (None | Some('"'), '\\') => escaped = true,
            (Some(open), c) if c == open => quote = None,
            (None, '\'' | '"') => quote = Some(c),
            (None, c) if c.is_whitespace() => start = at + c.len_utf8(),
            _ => {}
        }
    }
    start
}

impl Helper for Assistant {}

impl Validator for Assistant {}

impl Completer for Assistant {
    type Candidate = Pair;

    fn complete(&self, line: &str, at: usize, _: &Context<'_>) -> rustyline::Result<(usize, Vec<Pair>)> {
        Ok(self.candidates(&line[..at]))
    }
}

impl Hinter for Assistant {
    type Hint = String;

    fn hint(&self, line: &str, at: usize, context: &Context<'_>) -> Option<String> {
        self.hinter.hint(line, at, context)
    }
}

impl Highlighter for Assistant {
    fn highlight_hint<'h>(&self, hint: &'h str) -> Cow<'h, str> {
        if self.colour { Cow::Owned(format!("\x1b[2m{hint}\x1b[0m")) } else { Cow::Borrowed(hint) }
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser as _;

    use super::*;
    use crate::cli::Cli;

    fn completed(prefix: &[&str], line: &str) -> Vec<String> {
        let globals = Cli::parse_from(["armctl", "--sim", "repl"]).globals;
        let prefix = prefix.iter().map(ToString::to_string).collect();
        let (start, found) = Assistant::new(&LineParser::new(prefix), &globals).candidates(line);
        found.iter().map(|pair| format!("{}{}", &line[..start], pair.replacement)).collect()
    }

    #[test]
    fn completes_words_at_the_cursor() {
        assert_eq!(completed(&["yerc"], "hlo"), ["hlock "]);
        assert_eq!(completed(&["yerc"], "rob"), ["robots "]);
        assert_eq!(completed(&["yerc"], "servo o"), ["servo on", "servo off"]);
        assert_eq!(completed(&["yerc"], "toyo ho"), ["toyo host", "toyo home"]);
        assert_eq!(completed(&[], "expl"), ["explain "]);
        assert!(completed(&["yerc"], "servo 'x y").is_empty());
    }

    #[test]
    fn word_starts_after_an_unquoted_space() {
        for (line, start) in [("", 0), ("a b", 2), ("a ", 2), ("say 'x y", 4), ("say \"x' y", 4), ("say x\\ y", 4)] {
            assert_eq!(word_start(line), start, "{line}");
        }
    }
}

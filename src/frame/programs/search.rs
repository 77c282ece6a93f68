//! Search in programs: a text, an object, or calls.

use regex_bites::{Regex, RegexBuilder, escape};

use super::Program;
use crate::items::{self, ItemError};
use crate::prelude::basics::*;
use armctl_controller::references::{Reference, Role};

/// Arguments of a search.
#[derive(Debug, Args)]
#[group(skip)]
pub struct SearchArguments {
    /// Text or regular expression, as for grep: . * [] ^ $ are special, () + ? | {} are not
    #[arg(value_name = "PATTERN", required_unless_present_any = ["uses", "calls"])]
    pattern: Option<String>,
    /// Extended regular expression, as for grep -E: () + ? | {} are special too
    #[arg(short = 'E', long, requires = "pattern")]
    extended: bool,
    /// Ignore upper and lower case in PATTERN
    #[arg(short, long, requires = "pattern")]
    ignore_case: bool,
    /// Lines that use this object: an address, or a name of the robot
    #[arg(long, value_name = "OBJECT")]
    pub uses: Option<String>,
    /// Lines that call or start this program
    #[arg(long, value_name = "NAME")]
    calls: Option<String>,
}

impl SearchArguments {
    /// The pattern, if it is the only condition and has no options.
    pub fn only_pattern(&self) -> Option<&str> {
        let has_more = self.extended || self.ignore_case || self.uses.is_some() || self.calls.is_some();
        self.pattern.as_deref().filter(|_| !has_more)
    }

    /// Finds the lines that meet all conditions. `objects` are the names of the object of `--uses` in references.
    ///
    /// # Errors
    /// The pattern is not valid.
    pub fn search(&self, programs: &[Program], objects: &[String], unread: Vec<ItemError>) -> Result<Matches> {
        let regex = self.regex()?;
        let mut matches = Vec::new();
        for program in programs {
            for line in &program.lines {
                let has_text = regex.as_ref().is_none_or(|regex| regex.is_match(&line.text));
                let mut references = line.references.iter();
                let is_used = |one: &Reference| one.role != Role::Word && objects.contains(&one.name);
                let uses = self.uses.is_none() || references.clone().any(is_used);
                let calls = self.calls.as_ref().is_none_or(|name| {
                    references.any(|one| matches!(one.role, Role::Call | Role::Start | Role::Word) && one.name == *name)
                });
                if has_text && uses && calls {
                    let Program { name, file, .. } = program;
                    let text = line.text.trim().to_owned();
                    matches.push(Match { program: name.clone(), file: file.clone(), line: line.number, text });
                }
            }
        }
        Ok(Matches { programs: programs.len(), matches, unread })
    }

    fn regex(&self) -> Result<Option<Regex>> {
        let Some(pattern) = &self.pattern else { return Ok(None) };
        let source = if self.extended { pattern.clone() } else { from_basic(pattern) };
        let regex = RegexBuilder::new(&source).case_insensitive(self.ignore_case).build();
        regex.map(Some).map_err(|error| {
            Failure::usage(format!("'{pattern}' is not a valid regular expression: {error}"))
                .hint("put \\ before special characters, such as \\[ and \\*")
        })
    }
}

/// Converts a basic regular expression of grep. In it, `( ) { } + ? |` are text, and special only after a backslash. A
/// `*` at the start is text.
fn from_basic(pattern: &str) -> String {
    let mut regex = String::with_capacity(pattern.len() + 8);
    let mut chars = pattern.chars().peekable();
    let mut is_start = true;
    while let Some(c) = chars.next() {
        match c {
            '\\' => match chars.next() {
                Some(special) if "(){}+?|".contains(special) => regex.push(special),
                Some(other) => regex.extend(['\\', other]),
                None => regex.push_str("\\\\"),
            },
            '[' => {
                // The characters of a class have their own rules, which are the same in both notations.
                regex.push('[');
                regex.extend(chars.next_if_eq(&'^'));
                regex.extend(chars.next_if_eq(&']').map(|_| "\\]").into_iter().flat_map(str::chars));
                for c in chars.by_ref() {
                    regex.push(c);
                    if c == ']' {
                        break;
                    }
                }
            }
            '*' if is_start => regex.push_str("\\*"),
            '^' if is_start => regex.push(c),
            '$' if chars.peek().is_none() => regex.push(c),
            '.' | '*' => regex.push(c),
            _ => regex.push_str(&escape(c.encode_utf8(&mut [0; 4]))),
        }
        is_start &= c == '^';
    }
    regex
}

/// Lines that a search found.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Matches {
    /// Number of programs that were searched.
    programs: usize,
    /// Lines in the order of the programs.
    matches: Vec<Match>,
    /// Programs that could not be read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unread: Vec<ItemError>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Match {
    /// Name of the program.
    program: String,
    /// File in the folder, or on the controller.
    file: String,
    /// Line of the file, from 1.
    line: usize,
    /// Text of the line.
    text: String,
}

impl Report for Matches {
    const ROWS: RowsOf = RowsOf::List("matches");

    fn view(&self) -> View {
        let mut table = Table::new(&["file", "line", "text"], "no line found");
        for Match { file, line, text, .. } in &self.matches {
            table.row([file.as_str().into(), (*line).into(), text.as_str().into()]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.programs + self.unread.len(), self.unread.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pattern_has_the_notation_of_grep() {
        for (pattern, text, is_match) in [
            ("OT#(1)", "DOUT OT#(1) ON", true),
            ("OT#.1", "DOUT OT#(1) ON", true),
            ("^MOV[JL] .*VJ=9", "MOVJ C00000 VJ=90.00", true),
            ("*AGAIN", "JUMP *AGAIN IF B000<3", true),
            ("^*AGAIN", "*AGAIN", true),
            ("A+B", "A+B", true),
            ("A+B", "AAB", false),
            ("A\\+B", "AAB", true),
            ("[]x]", "P[I000]", true),
            ("B00\\(1\\|2\\)$", "INC B002", true),
            ("again", "*AGAIN", false),
        ] {
            let regex = Regex::new(&from_basic(pattern)).unwrap();
            assert_eq!(regex.is_match(text), is_match, "{pattern} in {text}");
        }
    }
}

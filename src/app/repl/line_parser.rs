//! Conversion of a line at the prompt to a command line.

use std::ffi::OsString;

use crate::app::parser::{Owner, Parser};
use armctl_frame::settings::target::Family;

/// Converter that inserts the family before the commands of the family.
#[derive(Debug, Default)]
pub struct LineParser {
    prefix: Vec<String>,
    /// Parser for command lines.
    pub parser: Parser,
}

impl LineParser {
    /// Creates a converter with the words to insert. The first word is the family.
    pub fn new(prefix: Vec<String>) -> Self {
        Self { prefix, parser: Parser::default() }
    }

    /// The words to insert.
    pub fn prefix(&self) -> &[String] {
        &self.prefix
    }

    fn family(&self) -> Option<Family> {
        self.prefix.first()?.parse().ok()
    }

    /// Returns the command line for the words of a prompt line.
    pub fn args(&mut self, words: &[String]) -> Vec<OsString> {
        if let [word] = words
            && matches!(word.as_str(), "help" | "?" | "-h" | "--help")
        {
            return family_help(&self.prefix);
        }
        let family = self.family();
        // Flags may precede the command. An unknown word is passed to the family, and the family reports the error.
        let owner = words.iter().map(|word| self.parser.owner(word, family)).find(|owner| *owner != Owner::None);
        let prefix = self.prefix.iter().filter(|_| owner != Some(Owner::All));
        std::iter::once("armctl").chain(prefix.chain(words).map(String::as_str)).map(OsString::from).collect()
    }

    /// Returns the possible command lines for an incomplete line. Without a command word, the line may become a command
    /// of the family or a common command.
    pub fn beginnings(&mut self, words: &[String]) -> Vec<Vec<OsString>> {
        let family = self.family();
        let mut beginnings = vec![self.args(words)];
        if family.is_some() && words.iter().all(|word| self.parser.owner(word, family) == Owner::None) {
            beginnings
                .push(std::iter::once("armctl").chain(words.iter().map(String::as_str)).map(OsString::from).collect());
        }
        beginnings
    }
}

/// Returns the command line that lists the commands of a family. Without a family, it lists all commands.
pub fn family_help(prefix: &[String]) -> Vec<OsString> {
    std::iter::once("armctl").chain(prefix.iter().map(String::as_str)).chain(["-h"]).map(OsString::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse_line(prefix: &[&str], line: &str) -> String {
        let prefix = prefix.iter().map(ToString::to_string).collect();
        let words: Vec<String> = line.split(' ').map(ToOwned::to_owned).collect();
        let args = LineParser::new(prefix).args(&words);
        args.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn line_belongs_to_the_family_or_is_common() {
        assert_eq!(parse_line(&["yerc"], "status"), "armctl yerc status");
        assert_eq!(parse_line(&["yerc"], "-o json status"), "armctl yerc -o json status");
        assert_eq!(parse_line(&["yerc"], "robots list"), "armctl robots list");
        assert_eq!(parse_line(&["yerc"], "toyo status"), "armctl toyo status");
        assert_eq!(parse_line(&["yerc"], "yerc status"), "armctl yerc status");
        assert_eq!(parse_line(&["yerc"], "satus"), "armctl yerc satus");
        assert_eq!(parse_line(&["yrcx", "--unit", "2"], "servo on"), "armctl yrcx --unit 2 servo on");
        assert_eq!(parse_line(&["yrcx"], "help"), "armctl yrcx -h");
        assert_eq!(parse_line(&[], "status"), "armctl status");
        assert_eq!(parse_line(&[], "?"), "armctl -h");
    }
}

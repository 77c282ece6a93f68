//! Which command line a line at the prompt stands for.

use std::ffi::OsString;

use crate::app::parser::{Owner, Parser};
use crate::settings::target::Family;

/// Puts the family before lines that are commands of it.
#[derive(Debug, Default)]
pub struct Meaning {
    prefix: Vec<String>,
    /// Reads the command lines.
    pub parser: Parser,
}

impl Meaning {
    /// With these words before commands of the family, which is the first of them.
    pub fn new(prefix: Vec<String>) -> Self {
        Self { prefix, parser: Parser::default() }
    }

    /// The words before commands of the family.
    pub fn prefix(&self) -> &[String] {
        &self.prefix
    }

    fn family(&self) -> Option<Family> {
        self.prefix.first()?.parse().ok()
    }

    /// The command line of a line.
    pub fn args(&mut self, words: &[String]) -> Vec<OsString> {
        if let [word] = words
            && matches!(word.as_str(), "help" | "?" | "-h" | "--help")
        {
            return family_help(&self.prefix);
        }
        let family = self.family();
        // Flags may stand before the command. What is neither of the family nor of all is the family's to refuse.
        let owner = words.iter().map(|word| self.parser.owner(word, family)).find(|owner| *owner != Owner::Nobody);
        let prefix = self.prefix.iter().filter(|_| owner != Some(Owner::All));
        std::iter::once("armctl").chain(prefix.chain(words).map(String::as_str)).map(OsString::from).collect()
    }

    /// The command lines that a line can become by another word, which is not typed yet: where it has no command, both of
    /// the family and of all.
    pub fn beginnings(&mut self, words: &[String]) -> Vec<Vec<OsString>> {
        let family = self.family();
        let mut beginnings = vec![self.args(words)];
        if family.is_some() && words.iter().all(|word| self.parser.owner(word, family) == Owner::Nobody) {
            beginnings
                .push(std::iter::once("armctl").chain(words.iter().map(String::as_str)).map(OsString::from).collect());
        }
        beginnings
    }
}

/// The command line that lists the commands of a family, or of all.
pub fn family_help(prefix: &[String]) -> Vec<OsString> {
    std::iter::once("armctl").chain(prefix.iter().map(String::as_str)).chain(["-h"]).map(OsString::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meant(prefix: &[&str], line: &str) -> String {
        let prefix = prefix.iter().map(ToString::to_string).collect();
        let words: Vec<String> = line.split(' ').map(ToOwned::to_owned).collect();
        let args = Meaning::new(prefix).args(&words);
        args.iter().map(|word| word.to_str().unwrap()).collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn a_line_is_of_the_family_or_of_all() {
        assert_eq!(meant(&["yerc"], "status"), "armctl yerc status");
        assert_eq!(meant(&["yerc"], "-o json status"), "armctl yerc -o json status");
        assert_eq!(meant(&["yerc"], "robots list"), "armctl robots list");
        assert_eq!(meant(&["yerc"], "toyo status"), "armctl toyo status");
        assert_eq!(meant(&["yerc"], "yerc status"), "armctl yerc status");
        assert_eq!(meant(&["yerc"], "satus"), "armctl yerc satus");
        assert_eq!(meant(&["yrcx", "--unit", "2"], "servo on"), "armctl yrcx --unit 2 servo on");
        assert_eq!(meant(&["yrcx"], "help"), "armctl yrcx -h");
        assert_eq!(meant(&[], "status"), "armctl status");
        assert_eq!(meant(&[], "?"), "armctl -h");
    }
}

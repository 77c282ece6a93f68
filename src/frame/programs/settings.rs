//! Settings of a check: rules that are off, limits, and programs that are ignored, in `.armctl-check.toml`.

use std::io::ErrorKind;

use serde::Deserialize;
use toml::Spanned;

use super::check::SpeedLimit;
use crate::backup::tolerance::Limit;
use crate::prelude::basics::*;
use crate::settings::inventory::{line_and_column, matches_pattern, suggestion};
use armctl_controller::findings::{Finding, Rule};

/// Name of the file. It is searched in the folder that is checked, then in the current folder.
pub const FILE: &str = ".armctl-check.toml";
/// Maximum size of the file.
const MAX_SIZE: u64 = 1 << 20;

/// Help text about the rules and the file.
pub fn help() -> String {
    let rules: Vec<String> = Rule::all().map(|(_, name, about)| format!("  {name:<17} {about}")).collect();
    format!(
        "Rules:\n{}\n\nSettings are in {FILE}, in the folder that is checked or in the current folder:\n\n  \
         max-speed = [\"500mm/s\", \"50%\"]\n  tolerance = [\"0.1mm\"]\n  master = [\"MAIN\"]   # jobs that a person \
         or a PLC starts\n  [rules]\n  never-read = false\n  [ignore]\n  \"TEST*\" = [\"unused-position\"]",
        rules.join("\n")
    )
}

/// Settings of a check.
#[derive(Debug, Clone, Default)]
pub struct CheckSettings {
    /// The file; `None` if there is none.
    pub path: Option<PathBuf>,
    /// Limits of speeds.
    pub max_speed: Vec<SpeedLimit>,
    /// Tolerances of positions.
    pub tolerance: Vec<Limit>,
    /// Programs that a person or a PLC starts: names or patterns.
    pub master: Vec<String>,
    rules: Vec<(Rule, bool)>,
    ignore: Vec<(String, Vec<Rule>)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct RawFile {
    #[serde(default)]
    max_speed: Vec<Spanned<String>>,
    #[serde(default)]
    tolerance: Vec<Spanned<String>>,
    #[serde(default)]
    master: Vec<String>,
    #[serde(default)]
    rules: BTreeMap<Spanned<String>, bool>,
    #[serde(default)]
    ignore: BTreeMap<String, Vec<Spanned<String>>>,
}

impl CheckSettings {
    /// Reads the file in `folder`, or else in the current folder.
    ///
    /// # Errors
    /// The file cannot be read, or has a mistake.
    pub fn load(folder: Option<&Path>) -> Result<Self> {
        for path in folder.into_iter().chain([Path::new("")]).map(|folder| folder.join(FILE)) {
            match files::text(&path, MAX_SIZE) {
                Ok(text) => {
                    return Ok(Self { path: Some(path.clone()), ..Self::parse(&text, &path.display().to_string())? });
                }
                Err(error) if error.kind() == ErrorKind::NotFound => {}
                Err(error) => return Err(Failure::io(path.display(), &error)),
            }
        }
        Ok(Self::default())
    }

    fn parse(text: &str, name: &str) -> Result<Self> {
        let at = |start: usize, what: &str| {
            let (line, column) = line_and_column(text, start);
            Failure::usage(format!("{name}:{line}:{column}: {what}"))
        };
        let raw: RawFile = toml::from_str(text).map_err(|error| {
            let failure = at(error.span().unwrap_or_default().start, error.message());
            match suggestion(error.message()) {
                Some(word) => failure.hint(format!("did you mean `{word}`?")),
                None => failure.hint("the help of the command shows an example of the file"),
            }
        })?;
        let rule = |text: &Spanned<String>| {
            let name = text.get_ref();
            Rule::all().find(|(_, known, _)| known == name).map(|(rule, ..)| rule).ok_or_else(|| {
                let names = || Rule::all().map(|(_, name, _)| name);
                let failure = at(text.span().start, &format!("there is no rule '{name}'"));
                failure.hint(match nearest(name, names()) {
                    Some(near) => format!("did you mean {near}?"),
                    None => format!("the rules are {}", names().collect::<Vec<_>>().join(", ")),
                })
            })
        };
        let mut settings = Self { master: raw.master, ..Self::default() };
        for text in &raw.max_speed {
            settings.max_speed.push(SpeedLimit::parse(text.get_ref()).map_err(|why| at(text.span().start, &why))?);
        }
        for text in &raw.tolerance {
            settings.tolerance.push(Limit::parse(text.get_ref()).map_err(|why| at(text.span().start, &why))?);
        }
        for (name, is_on) in &raw.rules {
            settings.rules.push((rule(name)?, *is_on));
        }
        for (program, rules) in raw.ignore {
            settings.ignore.push((program, rules.iter().map(rule).collect::<Result<_, _>>()?));
        }
        Ok(settings)
    }

    /// Whether a finding of a program is shown. An invalid text is always shown. An empty list of rules ignores all
    /// other rules.
    pub fn shows(&self, program: &str, finding: &Finding) -> bool {
        let is_off = self.rules.iter().any(|(rule, is_on)| *rule == finding.rule && !is_on);
        let is_ignored = self.ignore.iter().any(|(pattern, rules)| {
            matches_pattern(pattern, program) && (rules.is_empty() || rules.contains(&finding.rule))
        });
        finding.rule == Rule::Syntax || !(is_off || is_ignored)
    }

    /// Whether a person or a PLC starts a program.
    pub fn is_master(&self, program: &str) -> bool {
        self.master.iter().any(|pattern| matches_pattern(pattern, program))
    }
}

#[cfg(test)]
mod tests {
    use armctl_controller::findings::Severity;

    use super::*;

    #[test]
    fn mistakes_have_their_place_and_a_hint() {
        for (text, message, hint) in [
            ("[rules]\nnever-raed = false", "f:2:1: there is no rule 'never-raed'", "did you mean never-read?"),
            ("[ignore]\nA = [\"xyz\"]", "f:2:6: there is no rule 'xyz'", "the rules are syntax, missing-label"),
            ("max-sped = []", "f:1:1: unknown field `max-sped`, expected one of", "did you mean `max-speed`?"),
            ("max-speed = [\"fast\"]", "f:1:14: 'fast' is not a valid speed limit", ""),
        ] {
            let failure = CheckSettings::parse(text, "f").unwrap_err();
            assert!(failure.message.starts_with(message), "{failure}");
            assert!(failure.hint.unwrap_or_default().starts_with(hint), "{text}");
        }
    }
    #[test]
    fn a_rule_is_off_in_all_programs_or_ignored_in_some() {
        let settings =
            CheckSettings::parse("[rules]\nnever-read = false\n[ignore]\n\"T*\" = [\"unused-position\"]\nX = []", "f");
        let settings = settings.unwrap();
        let finding = |rule| Finding {
            rule,
            severity: Severity::Warning,
            line: 1,
            column: 1,
            message: String::new(),
            hint: None,
        };
        for (program, rule, is_shown) in [
            ("A", Rule::NeverRead, false),
            ("A", Rule::UnusedPosition, true),
            ("T1", Rule::UnusedPosition, false),
            ("T1", Rule::MissingLabel, true),
            ("X", Rule::MissingLabel, false),
            ("X", Rule::Syntax, true),
        ] {
            assert_eq!(settings.shows(program, &finding(rule)), is_shown, "{rule:?} in {program}");
        }
    }
}

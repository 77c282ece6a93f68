//! `alarms.toml` next to `robots.toml`: the meaning of alarm codes at this site.
//!
//! ```toml
//! [[alarm]]
//! family = "yerc"
//! code = 4315
//! text = "Collision detected"
//! cause = "the gripper touched the fixture"
//! remedy = "release hold, jog away by hand, look at the fixture"
//! robot = "cell3"
//! ```
//!
//! `robot` and `model` restrict an entry. If several entries match an alarm, the most specific entry is used. A mistake
//! in the file is an error with the line and a suggestion.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::Robot;
use super::inventory::{line_and_column, suggestion};
use super::target::Family;
use crate::failure::{Failure, plain};
use armctl_controller::yerc::Model;
use armctl_files as files;

const FILE_NAME: &str = "alarms.toml";

/// Explanation of an alarm, from the file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Explanation {
    /// Meaning of the alarm.
    pub text: String,
    /// Usual cause of the alarm.
    pub cause: Option<String>,
    /// Remedy for the alarm.
    pub remedy: Option<String>,
}

/// Robot that raised an alarm, as far as known.
#[derive(Debug, Clone, Copy)]
pub struct Origin<'a> {
    /// Family.
    pub family: Family,
    /// Name of the robot.
    pub robot: Option<&'a str>,
    /// Model of the controller, if known.
    pub model: Option<Model>,
}

impl Explanation {
    /// Returns all parts of the explanation in one line.
    pub fn line(&self) -> String {
        let parts = [Some(&self.text), self.cause.as_ref(), self.remedy.as_ref()].into_iter().flatten();
        parts.map(String::as_str).collect::<Vec<_>>().join("; ")
    }

    /// Returns the explanation as a field of a report for people, if there is an explanation.
    pub fn field<C: From<String>>(explained: Option<&Self>) -> Option<(&'static str, C)> {
        explained.map(|explained| ("alarms.toml", explained.line().into()))
    }
}

impl<'a> Origin<'a> {
    /// Returns the origin for any robot of a family.
    pub fn any(family: Family) -> Self {
        Self { family, robot: None, model: None }
    }

    /// Returns the origin for this robot.
    pub fn of(robot: &'a Robot) -> Self {
        let model = (robot.family == Family::Yerc).then(|| robot.likely_model()).flatten();
        Self { robot: Some(&robot.name), model, ..Self::any(robot.family) }
    }
}

/// Path of the alarm file of an inventory. The file may be missing.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Alarms(Option<PathBuf>);

impl Alarms {
    /// Returns the alarm file next to this inventory.
    pub fn load_beside(inventory: Option<&Path>) -> Self {
        Self(inventory.map(|path| path.with_file_name(FILE_NAME)))
    }

    /// Returns the explanation of an alarm; `None` if there is no file or no matching entry.
    pub fn find(&self, origin: Origin<'_>, code: &str) -> Result<Option<Explanation>, Failure> {
        let Some(path) = &self.0 else { return Ok(None) };
        let text = match files::text(path, files::SETTINGS) {
            Ok(text) => text,
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            Err(error) => {
                return Err(Failure::usage(format!("{}: {}", path.display(), plain(&error)))
                    .hint("correct the file, or move it to another folder: armctl works without it"));
            }
        };
        Ok(Table::parse(&text, &path.display().to_string())?.find(origin, code))
    }
}

/// Returns the explanation of an alarm of a robot, from the alarm file of the robot's inventory.
pub fn find(robot: &Robot, code: &str) -> Result<Option<Explanation>, Failure> {
    robot.alarms.find(Origin::of(robot), code)
}

#[derive(Debug)]
struct Table(Vec<Entry>);

#[derive(Debug)]
struct Entry {
    family: Family,
    code: String,
    robot: Option<String>,
    model: Option<Model>,
    explanation: Explanation,
}

impl Table {
    /// Parses the text of a file. `name` is the file name for error messages.
    fn parse(text: &str, name: &str) -> Result<Self, Failure> {
        let at = |start: usize, what: &str| {
            let (line, column) = line_and_column(text, start);
            Failure::usage(format!("{name}:{line}:{column}: {what}")).hint("`armctl help inventory` describes the file")
        };
        let file: RawFile = toml::from_str(text).map_err(|error| {
            let failure = at(error.span().unwrap_or_default().start, error.message());
            match suggestion(error.message()) {
                Some(word) => failure.hint(format!("did you mean `{word}`?")),
                None => failure.hint("see `armctl help inventory`"),
            }
        })?;
        let entry = |raw: RawEntry| {
            let wrong = |span: &Spanned<String>, why: &str| at(span.span().start, why);
            let family = raw.family.as_ref().parse::<Family>();
            let family = family.map_err(|why| wrong(&raw.family, &why).hint("use yerc, yrcx or toyo"))?;
            let model = raw.model.as_ref().map(|model| {
                let parsed = model.as_ref().parse::<Model>();
                parsed.map_err(|why| wrong(model, &why).hint("use fs100, dx100, dx200 or yrc1000"))
            });
            let model = model.transpose()?;
            let RawEntry { code, robot, text, cause, remedy, .. } = raw;
            Ok(Entry { family, code: code.text(), robot, model, explanation: Explanation { text, cause, remedy } })
        };
        file.alarm.into_iter().map(entry).collect::<Result<_, Failure>>().map(Self)
    }

    /// Returns the most specific matching entry.
    fn find(&self, origin: Origin<'_>, code: &str) -> Option<Explanation> {
        let code = normalize(code);
        let fits = |entry: &&Entry| {
            entry.family == origin.family
                && normalize(&entry.code) == code
                && entry.robot.as_deref().is_none_or(|robot| Some(robot) == origin.robot)
                && entry.model.is_none_or(|model| Some(model) == origin.model)
        };
        let specificity = |entry: &&Entry| (entry.robot.is_some(), entry.model.is_some());
        // If several entries are equally specific, the first of them is used.
        let found = self.0.iter().rev().filter(fits).max_by_key(specificity);
        found.map(|entry| entry.explanation.clone())
    }
}

/// Converts a code to a form in which equal codes have equal text.
fn normalize(code: &str) -> String {
    let code = code.trim().to_ascii_lowercase();
    let digits = code.strip_prefix("0x").unwrap_or(&code).trim_start_matches('0');
    if digits.is_empty() { "0".to_owned() } else { digits.to_owned() }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    #[serde(default)]
    alarm: Vec<RawEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawEntry {
    family: Spanned<String>,
    code: Code,
    text: String,
    cause: Option<String>,
    remedy: Option<String>,
    robot: Option<String>,
    model: Option<Spanned<String>>,
}

/// A code: a number, or a text such as `12.600` or `A1`.
#[derive(Deserialize)]
#[serde(untagged)]
enum Code {
    Number(u32),
    Text(String),
}

impl Code {
    fn text(self) -> String {
        match self {
            Self::Number(number) => number.to_string(),
            Self::Text(text) => text,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILE: &str = "[[alarm]]\nfamily = \"yerc\"\ncode = 4315\ntext = \"any\"\n\
                        [[alarm]]\nfamily = \"yerc\"\ncode = \"4315\"\ntext = \"cell3\"\nremedy = \"look\"\nrobot = \"cell3\"\n\
                        [[alarm]]\nfamily = \"toyo\"\ncode = \"0xA1\"\ntext = \"axis\"\n";

    #[test]
    fn narrowest_entry_wins() {
        let table = Table::parse(FILE, "alarms.toml").unwrap();
        let find =
            |family, robot, code| table.find(Origin { family, robot, model: None }, code).map(|found| found.text);
        assert_eq!(find(Family::Yerc, None, "4315").as_deref(), Some("any"));
        assert_eq!(find(Family::Yerc, Some("cell3"), "04315").as_deref(), Some("cell3"));
        assert_eq!(find(Family::Toyo, None, "a1").as_deref(), Some("axis"));
        assert_eq!(find(Family::Toyo, None, "4315"), None);
    }

    #[test]
    fn mistakes_have_line_and_suggestion() {
        for (text, place, hint) in [
            ("[[alarm]]\nfamily = \"yerc\"\ncode = 1\ntexts = \"x\"\n", "alarms.toml:", "`text`"),
            ("[[alarm]]\nfamily = \"yerk\"\ncode = 1\ntext = \"x\"\n", "alarms.toml:2:10", "yerc"),
            ("[[alarm]]\nfamily = \"yerc\"\ncode = 1\ntext = \"x\"\nmodel = \"f\"\n", "alarms.toml:5:9", "fs100"),
        ] {
            let failure = Table::parse(text, "alarms.toml").unwrap_err();
            assert!(failure.message.starts_with(place), "{place}: {}", failure.message);
            assert!(failure.hint.as_ref().unwrap().contains(hint), "{hint}: {failure:?}");
        }
    }
}

//! `robots.toml`: the robots of a site, by name.
//!
//! ```toml
//! default = "cell3"
//!
//! [defaults]
//! timeout = "3s"
//!
//! [[robot]]
//! name = "cell3"
//! target = "udp://192.168.1.31?model=dx200"
//! tags = ["welding"]
//! line = "3"
//! read_only = true
//!
//! [robot.names]
//! clamp = 27010
//! parts = "B5"
//! ```
//!
//! The message for an error in the file contains the line, the column and a suggestion. armctl does not guess what is
//! meant.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use etcetera::BaseStrategy as _;
use serde::Deserialize;
use toml::Spanned;

use super::duration;
use super::model::ModelSetting;
use super::names::grammar;
use super::place::{self, Place};
use super::target::{Family, Target, TargetArgument};
use crate::failure::{Failure, plain};
use armctl_controller::names::{Name, Source, unusable};
use armctl_controller::similar_word::nearest;
use armctl_controller::text::Encoding;
use armctl_controller::yerc::payload::MAX_AXES;
use armctl_files as files;

/// Name of the file, in the folder `armctl/` of the platform's configuration folder.
const FILE_NAME: &str = "robots.toml";

/// Settings that can come from a robot, from the `[defaults]` of the file, from a flag or from the environment.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// Time limit of one attempt.
    pub timeout: Option<Duration>,
    /// Number of retries of a read.
    pub retries: Option<u32>,
    /// Encoding of names and texts on the controller.
    pub encoding: Option<Encoding>,
    /// Whether only reads and stops are accepted.
    pub read_only: Option<bool>,
    /// Whether the first command that requires a control connection opens a session (yrcx).
    pub hold: Option<bool>,
    /// Controller model (yerc).
    pub model: Option<ModelSetting>,
}

/// A robot of the inventory.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// Name of the robot, which is unique in the file.
    pub name: String,
    /// Target.
    pub target: Target,
    /// Family.
    pub family: Family,
    /// Settings of this robot.
    pub options: Options,
    /// Pulses per degree of each axis.
    pub pulses_per_degree: Vec<f64>,
    /// Tags.
    pub tags: Vec<String>,
    /// Place in the plant.
    pub place: Place,
    /// Names of the robot's signals, variables and registers.
    pub names: Arc<[Name]>,
}

/// Content of the inventory file.
#[derive(Debug, Clone, Default)]
pub struct Inventory {
    /// Path of the file, even if the file does not exist.
    pub path: Option<PathBuf>,
    /// Name of the default robot.
    pub default: Option<String>,
    /// Settings for all robots.
    pub defaults: Options,
    /// Robots in the order of the file.
    pub robots: Vec<Entry>,
}

/// Path of the inventory. It comes from a flag or the environment, or is in the configuration folder of the platform.
#[derive(Debug, Clone)]
pub enum Location {
    /// Path that the user named. The file must exist.
    Named(PathBuf),
    /// Path in the configuration folder of the platform. The file may be missing.
    Default(PathBuf),
    /// There is no path, because the user has no home folder.
    Nowhere,
}

impl Location {
    /// Selects the location. `named` is the path from a flag or the environment.
    pub fn find(named: Option<PathBuf>) -> Self {
        match (named, etcetera::choose_base_strategy()) {
            (Some(path), _) => Self::Named(path),
            (None, Ok(folders)) => Self::Default(folders.config_dir().join("armctl").join(FILE_NAME)),
            (None, Err(_)) => Self::Nowhere,
        }
    }

    /// The path, if there is one.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Named(path) | Self::Default(path) => Some(path),
            Self::Nowhere => None,
        }
    }
}

impl Entry {
    /// Whether the robot has a tag: one of its own, or a level of its place such as `line=3`.
    pub fn has_tag(&self, tag: &str) -> bool {
        self.all_tags().any(|known| known == tag)
    }

    /// Tags of the robot, and the levels of its place as tags.
    pub fn all_tags(&self) -> impl Iterator<Item = String> {
        self.tags.iter().cloned().chain(self.place.tags())
    }
}

impl Inventory {
    /// Reads the file. If the file in the configuration folder is missing, the inventory is empty.
    pub fn load(location: &Location) -> Result<Self, Failure> {
        let Some(path) = location.path() else { return Ok(Self::default()) };
        let text = match files::text(path, files::SETTINGS) {
            Ok(text) => text,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound && matches!(location, Location::Default(_)) => {
                return Ok(Self { path: Some(path.to_owned()), ..Self::default() });
            }
            Err(error) => {
                return Err(Failure::usage(format!("inventory {}: {}", path.display(), plain(&error)))
                    .hint("check --config and ARMCTL_CONFIG; `armctl robots add` makes a new file"));
            }
        };
        let mut inventory = Self::parse(&text, &path.display().to_string())?;
        inventory.path = Some(path.to_owned());
        Ok(inventory)
    }

    /// Parses the text of a file. `name` is the file name for error messages.
    pub fn parse(text: &str, name: &str) -> Result<Self, Failure> {
        let at = |span: std::ops::Range<usize>, what: &str| {
            let (line, column) = line_and_column(text, span.start);
            Failure::usage(format!("{name}:{line}:{column}: {what}"))
        };
        let file: RawFile = toml::from_str(text).map_err(|error| {
            let failure = at(error.span().unwrap_or_default(), error.message());
            match suggestion(error.message()) {
                Some(word) => failure.hint(format!("did you mean `{word}`?")),
                None => failure.hint("see `armctl help inventory`"),
            }
        })?;
        let mut robots: Vec<Entry> = Vec::with_capacity(file.robot.len());
        for raw in file.robot {
            let robot = raw.name.as_ref();
            if !is_name(robot) {
                return Err(at(raw.name.span(), &format!("'{robot}' is not a valid robot name"))
                    .hint("use letters, digits, '-', '_' and '.'"));
            }
            if robots.iter().any(|known| known.name == *robot) {
                return Err(at(raw.name.span(), &format!("two robots have the name '{robot}'"))
                    .hint("give each robot a different name"));
            }
            let mut span = raw.target.span();
            let invalid = |failure: Failure| {
                let hint = failure.hint.clone().unwrap_or_default();
                at(raw.target.span(), &failure.message).hint(hint)
            };
            let url_text: TargetArgument = raw.target.as_ref().parse().map_err(invalid)?;
            let named = match &raw.family {
                None => None,
                Some(family) => {
                    span = family.span();
                    Some(family.as_ref().parse::<Family>().map_err(|why| at(span.clone(), &why))?)
                }
            };
            let target = url_text.resolve(named).map_err(invalid)?;
            let Some(family) = named.or(target.family()) else {
                return Err(at(span, "armctl cannot infer the family from this URL")
                    .hint("add family = \"yerc\" or family = \"toyo\""));
            };
            target.check(family).map_err(|why| at(span, &why).hint("correct `target` or `family`"))?;
            if let Some(model) = raw.model.as_ref().filter(|_| !family.has_model()) {
                return Err(
                    at(model.span(), &format!("a {family} robot has no `model` setting")).hint("remove `model`")
                );
            }
            for value in &raw.pulses_per_degree {
                let is_number = value.as_ref().is_finite() && *value.as_ref() > 0.0;
                if family != Family::Yerc || !is_number || raw.pulses_per_degree.len() > MAX_AXES {
                    let why = "pulses_per_degree is a list of up to 8 numbers above 0, one per axis of a yerc robot";
                    return Err(
                        at(value.span(), why).hint("example: pulses_per_degree = [1360, 1360, 1360, 1000, 1000, 500]")
                    );
                }
            }
            let own_names = raw.names.iter().map(|(name, address)| named_address(family, name, address, &at));
            robots.push(Entry {
                names: own_names.collect::<Result<_, Failure>>()?,
                name: robot.clone(),
                target,
                family,
                options: Options {
                    timeout: raw.timeout,
                    retries: raw.retries,
                    encoding: parsed(raw.encoding, &at)?,
                    read_only: raw.read_only,
                    hold: raw.hold,
                    model: parsed(raw.model, &at)?,
                },
                pulses_per_degree: raw.pulses_per_degree.into_iter().map(Spanned::into_inner).collect(),
                tags: raw.tags,
                place: Place {
                    site: level(raw.site, &at)?,
                    area: level(raw.area, &at)?,
                    line: level(raw.line, &at)?,
                    cell: level(raw.cell, &at)?,
                },
            });
        }
        if let Some(default) = &file.default
            && !robots.iter().any(|robot| robot.name == *default.as_ref())
        {
            return Err(at(default.span(), &format!("there is no robot '{}'", default.as_ref()))
                .hint("set `default` to the name of a robot in this file"));
        }
        let defaults = file.defaults;
        Ok(Self {
            path: None,
            default: file.default.map(Spanned::into_inner),
            defaults: Options {
                timeout: defaults.timeout,
                retries: defaults.retries,
                encoding: parsed(defaults.encoding, &at)?,
                read_only: defaults.read_only,
                hold: None,
                model: None,
            },
            robots,
        })
    }

    /// Returns the robots whose name matches a pattern with `*` and `?`.
    pub fn matching<'a>(&'a self, pattern: &'a str) -> impl Iterator<Item = &'a Entry> {
        self.robots.iter().filter(move |robot| matches_pattern(pattern, &robot.name))
    }
}

/// Whether `name` is a valid robot name. Robot names are used in tables, file names and patterns, so few characters are
/// allowed.
pub fn is_name(name: &str) -> bool {
    let plain = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    !name.is_empty() && name.len() <= 64 && name.chars().all(plain)
}

/// Whether a name matches a pattern with `*` and `?`.
pub fn matches_pattern(pattern: &str, name: &str) -> bool {
    let mut pattern_chars = pattern.chars();
    match pattern_chars.next() {
        None => name.is_empty(),
        Some('*') => {
            let rest = pattern_chars.as_str();
            let mut starts = name.char_indices().map(|(index, _)| index).chain([name.len()]);
            starts.any(|index| matches_pattern(rest, &name[index..]))
        }
        Some(expected) => {
            let mut chars = name.chars();
            chars.next().is_some_and(|c| expected == '?' || expected == c)
                && matches_pattern(pattern_chars.as_str(), chars.as_str())
        }
    }
}

/// Parses a value of the file. An error contains the position of the value.
fn parsed<T: std::str::FromStr<Err: std::fmt::Display>>(
    raw: Option<Spanned<String>>,
    at: &dyn Fn(std::ops::Range<usize>, &str) -> Failure,
) -> Result<Option<T>, Failure> {
    raw.map(|word| word.as_ref().parse::<T>().map_err(|why| at(word.span(), &why.to_string()))).transpose()
}

/// Checks a level of a place. An error contains the position of the value.
fn level(
    raw: Option<Spanned<String>>,
    at: &dyn Fn(std::ops::Range<usize>, &str) -> Failure,
) -> Result<Option<String>, Failure> {
    let Some(value) = raw else { return Ok(None) };
    place::check(value.as_ref()).map_err(|why| at(value.span(), &why))?;
    Ok(Some(value.into_inner()))
}

/// Parses a name and its address.
fn named_address(
    family: Family,
    name: &str,
    address: &Spanned<toml::Value>,
    at: &dyn Fn(std::ops::Range<usize>, &str) -> Failure,
) -> Result<Name, Failure> {
    let text = match address.as_ref() {
        toml::Value::String(text) => text.clone(),
        toml::Value::Integer(number) => number.to_string(),
        other => other.to_string(),
    };
    named(family, name, &text).map_err(|failure| {
        let hint = failure.hint.clone().unwrap_or_default();
        at(address.span(), &failure.message).hint(hint)
    })
}

/// Checks a name and its address.
pub fn named(family: Family, name: &str, address: &str) -> Result<Name, Failure> {
    let examples = match family {
        Family::Yerc => "examples: clamp = 27010, parts = \"B5\", speed = \"M10\"",
        Family::Yrcx => "examples: clamp = \"SI(20)\", parts = \"SGI5\", lamp = \"DO2.1\"",
        Family::Toyo => "examples: clamp = \"OUT1.3\", part = \"IN2.1\", parts = \"CN05\"",
    };
    if let Some(why) = unusable(grammar(family), name) {
        return Err(Failure::usage(format!("'{name}' cannot be a name: {why}")).hint(examples));
    }
    match (grammar(family).address)(address) {
        Some((kind, address)) => Ok(Name { kind, address, name: name.to_owned(), source: Source::Inventory }),
        None => {
            Err(Failure::usage(format!("'{address}' is not a valid address for a name on a {family} robot"))
                .hint(examples))
        }
    }
}

/// Line and column of a byte offset. Both start with 1.
pub(crate) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

/// Returns the most similar word in a message of serde such as "unknown field `x`, expected one of `a`, `b`".
pub(crate) fn suggestion(message: &str) -> Option<String> {
    let (_, rest) = message.split_once("unknown field `")?;
    let (word, rest) = rest.split_once('`')?;
    let is_known = rest.split('`').skip(1).step_by(2);
    nearest(word, is_known).map(ToOwned::to_owned)
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawFile {
    default: Option<Spanned<String>>,
    #[serde(default)]
    defaults: RawDefaults,
    #[serde(default)]
    robot: Vec<RawRobot>,
}

#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
struct RawDefaults {
    #[serde(default, deserialize_with = "duration::field::deserialize")]
    timeout: Option<Duration>,
    retries: Option<u32>,
    encoding: Option<Spanned<String>>,
    read_only: Option<bool>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRobot {
    name: Spanned<String>,
    target: Spanned<String>,
    family: Option<Spanned<String>>,
    model: Option<Spanned<String>>,
    read_only: Option<bool>,
    hold: Option<bool>,
    #[serde(default)]
    pulses_per_degree: Vec<Spanned<f64>>,
    encoding: Option<Spanned<String>>,
    #[serde(default, deserialize_with = "duration::field::deserialize")]
    timeout: Option<Duration>,
    retries: Option<u32>,
    #[serde(default)]
    tags: Vec<String>,
    site: Option<Spanned<String>>,
    area: Option<Spanned<String>>,
    line: Option<Spanned<String>>,
    cell: Option<Spanned<String>>,
    #[serde(default)]
    names: BTreeMap<String, Spanned<toml::Value>>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_a_complete_file() {
        let inventory = Inventory::parse(
            "default = \"b\"\n[defaults]\ntimeout = \"2s\"\n[[robot]]\nname = \"a\"\ntarget = \"udp://h\"\n\
             [[robot]]\nname = \"b\"\ntarget = \"sim:\"\nfamily = \"yerc\"\nread_only = true\ntags = [\"x\"]\n",
            "robots.toml",
        )
        .unwrap();
        assert_eq!(inventory.robots.len(), 2);
        assert_eq!(inventory.defaults.timeout, Some(Duration::from_secs(2)));
        assert_eq!(inventory.robots[1].options.read_only, Some(true));
    }

    #[test]
    fn mistakes_have_line_and_suggestion() {
        for (text, place, hint) in [
            ("[[robot]]\nname = \"a\"\ntagret = \"udp://h\"\n", "robots.toml:3:1", "`target`"),
            ("[[robot]]\nname = \"a\"\ntarget = \"udp:/h\"\n", "robots.toml:3:10", "udp://"),
            ("[[robot]]\nname = \"a\"\ntarget = \"sim:\"\n", "robots.toml:3:10", "family"),
            ("[[robot]]\nname = \"a b\"\ntarget = \"udp://h\"\n", "robots.toml:2:8", "letters"),
            ("default = \"z\"\n", "robots.toml:1:11", "default"),
            ("[[robot]\n", "robots.toml:1:", "inventory"),
            ("[[robot]]\nname = \"a\"\ntarget = \"serial://dev/tty\"\n", "robots.toml:3:10", "serial:///dev"),
            ("[[robot]]\nname = \"a\"\ntarget = \"tcp://h:1\"\nmodel = \"fs100\"\n", "robots.toml:4:9", "`model`"),
            (
                "[[robot]]\nname = \"a\"\ntarget = \"sim:?axes=2\"\nfamily = \"yerc\"\n",
                "robots.toml:4:10: 'axes'",
                "correct `target`",
            ),
            (
                "[[robot]]\nname=\"a\"\ntarget=\"udp://h\"\n[[robot]]\nname=\"a\"\ntarget=\"udp://h\"\n",
                ":5:6",
                "a different name",
            ),
        ] {
            let failure = Inventory::parse(text, "robots.toml").unwrap_err();
            assert!(failure.message.contains(place), "{place}: {}", failure.message);
            assert!(failure.hint.as_ref().unwrap().contains(hint), "{hint}: {failure:?}");
        }
    }

    #[test]
    fn parses_names_of_a_robot() {
        let parse = |names: &str| {
            let text = format!("[[robot]]\nname = \"a\"\ntarget = \"udp://h\"\n\n[robot.names]\n{names}\n");
            Inventory::parse(&text, "robots.toml")
        };
        let inventory = parse("clamp = 27010\n\"FILTER CLEAN\" = \"#10011\"\nparts = \"b5\"\nspeed = \"M10\"").unwrap();
        let names = inventory.robots[0].names.iter().map(|name| format!("{}={}", name.name, name.address));
        assert_eq!(names.collect::<Vec<_>>(), ["FILTER CLEAN=#10011", "clamp=#27010", "parts=B5", "speed=M10"]);
        for (names, place, why) in [
            ("clamp = 27018", ":6:9:", "'27018' is not a valid address for a name on a yerc robot"),
            ("clamp = \"SO(20)\"", ":6:9:", "yerc"),
            ("B5 = 27010", ":6:6:", "'B5' cannot be a name: it has the form of an address"),
            ("clamp = true", ":6:9:", "'true'"),
            ("\"a,b\" = 27010", ":6:9:", "comma"),
        ] {
            let failure = parse(names).unwrap_err();
            assert!(failure.message.contains(place) && failure.message.contains(why), "{names}: {}", failure.message);
            assert!(failure.hint.unwrap().contains("clamp = 27010"));
        }
    }

    #[test]
    fn globs() {
        assert!(
            matches_pattern("cell*", "cell3")
                && matches_pattern("*3", "cell3")
                && matches_pattern("c?ll3", "cell3")
                && matches_pattern("*", "")
        );
        assert!(!matches_pattern("cell", "cell3") && !matches_pattern("?", ""));
    }
}

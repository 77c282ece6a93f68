//! Topics of robots, and names as topic levels.
//!
//! A level is the name of a robot or node. Characters with a special meaning in topics, and characters that are not
//! allowed, are written as `%` and the hex digits of each byte, as in URLs: `+`, `#`, `/`, `%`, control characters, and
//! a leading `$`. Two names therefore never have the same topic, and the name can be decoded.

use std::str::FromStr;

use armctl_frame::prelude::*;
use armctl_frame::settings::place::Place;

/// Topic levels of robots. If several robots have the same name, as simulators do, the family is appended.
#[derive(Debug, Clone, Default)]
pub struct Levels {
    shared: BTreeSet<String>,
}

impl Levels {
    /// Levels for these robots, and for later robots.
    pub fn new(robots: &[Robot]) -> Self {
        let (mut seen, mut shared) = (BTreeSet::new(), BTreeSet::new());
        for robot in robots {
            if !seen.insert(&robot.name) {
                shared.insert(robot.name.clone());
            }
        }
        Self { shared }
    }

    /// Level of a robot.
    pub fn level_of(&self, robot: &Robot) -> Result<String> {
        if self.shared.contains(&robot.name) {
            return level(&format!("{}-{}", robot.name, robot.family));
        }
        level(&robot.name)
    }
}

/// Template of the topics of robots, such as `{site}/{area}/{line}/{robot}/{kind}`: one part for each level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Template(Vec<Part>);

/// Level of a template. A placeholder is a whole level, so that two robots never share a topic.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    Text(String),
    /// The prefix of all topics.
    Prefix,
    Robot,
    /// Name of the publisher.
    Node,
    Family,
    /// What is published: `status`, `alarms`, `position`, or the name of an extra command.
    Kind,
    /// A level of the place.
    Place(&'static str),
}

/// Placeholders of a template.
const KNOWN: &str = "{robot}, {kind}, {node}, {family}, {prefix}, {site}, {area}, {line}, {cell}";

impl Default for Template {
    fn default() -> Self {
        Self(vec![Part::Prefix, Part::Robot, Part::Kind])
    }
}

impl FromStr for Template {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split('/').map(str::parse).collect::<Result<Vec<Part>, String>>()?;
        if !parts.contains(&Part::Robot) || !parts.contains(&Part::Kind) {
            return Err("the topic needs the levels {robot} and {kind}".to_owned());
        }
        Ok(Self(parts))
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(level: &str) -> Result<Self, String> {
        if !level.contains(['{', '}']) {
            return prefix(level).map(Self::Text);
        }
        match level.strip_prefix('{').and_then(|rest| rest.strip_suffix('}')) {
            Some("prefix") => Ok(Self::Prefix),
            Some("robot") => Ok(Self::Robot),
            Some("node") => Ok(Self::Node),
            Some("family") => Ok(Self::Family),
            Some("kind") => Ok(Self::Kind),
            name => match Place::KEYS.into_iter().find(|key| Some(*key) == name) {
                Some(key) => Ok(Self::Place(key)),
                None => Err(format!("'{level}' is not a level; known: {KNOWN}")),
            },
        }
    }
}

/// Topics of the robots.
#[derive(Debug, Clone, Default)]
pub struct Topics {
    /// First levels of all topics.
    pub prefix: String,
    /// Level of the publisher.
    pub node: String,
    /// Template of the topics.
    pub template: Template,
    /// Topic levels of the robots.
    pub levels: Levels,
}

impl Topics {
    /// Topic of a robot for data of this kind, which is a topic level.
    ///
    /// # Errors
    /// If the template needs a level of the place that the robot does not have.
    pub fn topic_of(&self, robot: &Robot, kind: &str) -> Result<String> {
        let level_of = |part: &Part| match part {
            Part::Text(text) => Ok(text.clone()),
            Part::Prefix => Ok(self.prefix.clone()),
            Part::Robot => self.levels.level_of(robot),
            Part::Node => Ok(self.node.clone()),
            Part::Family => Ok(robot.family.name().to_owned()),
            Part::Kind => Ok(kind.to_owned()),
            Part::Place(key) => match robot.place.get(key) {
                Some(value) => level(value),
                None => {
                    Err(Failure::usage(format!("the topic has the level {{{key}}}, but {} has no {key}", robot.name))
                        .hint(format!("set it: `armctl robots set {} {key}=NAME`", robot.name)))
                }
            },
        };
        Ok(self.template.0.iter().map(level_of).collect::<Result<Vec<_>>>()?.join("/"))
    }
}

/// Longest level in bytes. A topic can have 65,535 bytes, but many brokers allow fewer.
const MAX_LEVEL_BYTES: usize = 200;

/// Encodes a name as a level.
pub fn level(name: &str) -> Result<String> {
    let mut level = String::with_capacity(name.len());
    for (at, c) in name.char_indices() {
        if matches!(c, '+' | '#' | '/' | '%') || c.is_control() || (at == 0 && c == '$') || is_empty_level(c) {
            let mut bytes = [0; 4];
            level.extend(c.encode_utf8(&mut bytes).bytes().map(|byte| format!("%{byte:02X}")));
        } else {
            level.push(c);
        }
    }
    if level.is_empty() || level.len() > MAX_LEVEL_BYTES {
        let shown: String = name.chars().take(40).collect();
        let why = if level.is_empty() { "is empty" } else { "is too long for a topic" };
        return Err(Failure::usage(format!("the name '{shown}' {why}"))
            .hint(format!("change the name in robots.toml: a name in a topic has 1 to {MAX_LEVEL_BYTES} bytes")));
    }
    Ok(level)
}

/// Unicode noncharacters; the standard does not allow them in topics.
fn is_empty_level(c: char) -> bool {
    matches!(c, '\u{fdd0}'..='\u{fdef}') || u32::from(c) & 0xfffe == 0xfffe
}

/// Checks a topic prefix: levels separated by `/`, used unchanged.
pub fn prefix(text: &str) -> Result<String, String> {
    if text.is_empty() || text.len() > MAX_LEVEL_BYTES {
        return Err(format!("a prefix has 1 to {MAX_LEVEL_BYTES} bytes"));
    }
    if text.starts_with('$') {
        return Err("topics that begin with $ are reserved for the broker".to_owned());
    }
    if text.split('/').any(str::is_empty) {
        return Err("each level of the prefix needs a name, for example armctl or plant/line1".to_owned());
    }
    if text.chars().any(|c| matches!(c, '+' | '#') || c.is_control() || is_empty_level(c)) {
        return Err("a prefix has no +, no # and no control characters".to_owned());
    }
    Ok(text.to_owned())
}

/// Checks a Sparkplug identifier: no `+`, `#` or `/`.
pub fn identifier(text: &str) -> Result<String, String> {
    if text.is_empty() || text.len() > MAX_LEVEL_BYTES {
        return Err(format!("an identifier has 1 to {MAX_LEVEL_BYTES} bytes"));
    }
    if text.chars().any(|c| matches!(c, '+' | '#' | '/') || c.is_control() || is_empty_level(c)) {
        return Err("an identifier has no +, no #, no / and no control characters".to_owned());
    }
    Ok(text.to_owned())
}

#[cfg(test)]
mod tests {
    use armctl_frame::settings::Sources;
    use armctl_frame::settings::target::{Target, TargetArgument};
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn escapes_unusual_names_reversibly() {
        for (name, expected) in [
            ("cell3", "cell3"),
            ("日本-1.b_c", "日本-1.b_c"),
            ("/dev/ttyUSB0", "%2Fdev%2FttyUSB0"),
            ("a+b#c", "a%2Bb%23c"),
            ("100%", "100%25"),
            ("$SYS", "%24SYS"),
            ("a$b", "a$b"),
            ("a\0\n", "a%00%0A"),
            ("\u{ffff}", "%EF%BF%BF"),
        ] {
            assert_eq!(level(name).unwrap(), expected);
        }
        assert!(level("").is_err() && level(&"x".repeat(201)).is_err() && level(&"/".repeat(67)).is_err());
    }

    #[test]
    fn fills_templates_with_encoded_levels() {
        let mut robot = test_robot("a/b");
        robot.place.site = Some("Werk #1".to_owned());
        let topic = |template: &str, robot: &Robot| {
            let template = template.parse().unwrap();
            let node = "cell7".to_owned();
            Topics { prefix: "armctl".to_owned(), node, template, ..Topics::default() }.topic_of(robot, "status")
        };
        assert_eq!(topic("{prefix}/{robot}/{kind}", &robot).unwrap(), "armctl/a%2Fb/status");
        assert_eq!(topic("{site}/x/{family}/{robot}/{kind}", &robot).unwrap(), "Werk %231/x/toyo/a%2Fb/status");
        assert_eq!(topic("{prefix}/{node}/{robot}/{kind}", &robot).unwrap(), "armctl/cell7/a%2Fb/status");
        let failure = topic("{line}/{robot}/{kind}", &robot).unwrap_err();
        assert_eq!(failure.hint.as_deref(), Some("set it: `armctl robots set a/b line=NAME`"));
        assert_eq!("{prefix}/{robot}/{kind}".parse(), Ok(Template::default()));
        for wrong in [
            "{robot}",
            "{kind}/x",
            "{robot}//{kind}",
            "{robot}/{kind}/#",
            "/{robot}/{kind}",
            "{robto}/{kind}",
            "x{robot}/{kind}",
            "{nodes}/{robot}/{kind}",
        ] {
            assert!(wrong.parse::<Template>().is_err(), "{wrong}");
        }
    }

    fn test_robot(name: &str) -> Robot {
        let target: Target =
            "tcp://127.0.0.1:9".parse::<TargetArgument>().unwrap().resolve(Some(Family::Toyo)).unwrap();
        Robot { name: name.to_owned(), ..Sources::default().at(&target, Family::Toyo).unwrap() }
    }

    #[test]
    fn checks_prefixes_and_identifiers() {
        assert_eq!(prefix("plant/line 1"), Ok("plant/line 1".to_owned()));
        for wrong in ["", "/", "a/", "/a", "a//b", "a/+", "#", "$SYS/x", "a\0"] {
            assert!(prefix(wrong).is_err(), "{wrong:?}");
        }
        assert!(identifier("Plant 1").is_ok());
        for wrong in ["", "a/b", "a+", "#", "a\n"] {
            assert!(identifier(wrong).is_err(), "{wrong:?}");
        }
    }

    /// Decodes a level.
    fn name(level: &str) -> String {
        let mut bytes = Vec::new();
        let mut rest = level.bytes();
        while let Some(byte) = rest.next() {
            if byte == b'%' {
                let digits = [rest.next().unwrap(), rest.next().unwrap()];
                bytes.push(u8::from_str_radix(std::str::from_utf8(&digits).unwrap(), 16).unwrap());
            } else {
                bytes.push(byte);
            }
        }
        String::from_utf8(bytes).unwrap()
    }

    proptest! {
        #[test]
        fn maps_different_names_to_different_levels(text in "\\PC{1,20}|[+#/%$\0-\x1f]{1,9}") {
            let level = level(&text).unwrap();
            prop_assert_eq!(name(&level), text);
            prop_assert!(!level.contains(['+', '#', '/', '\0']) && !level.starts_with('$'));
        }
    }
}

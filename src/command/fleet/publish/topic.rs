//! Names as topic levels.
//!
//! A level is the name of a robot or node. Characters with a special meaning in topics, and characters that are not
//! allowed, are written as `%` and the hex digits of each byte, as in URLs: `+`, `#`, `/`, `%`, control characters, and
//! a leading `$`. Two names therefore never have the same topic, and the name can be decoded.

use std::collections::BTreeSet;

use armctl_frame::prelude::*;

/// Topic levels of robots. If several robots have the same name, as simulators do, the family is appended.
#[derive(Debug, Clone, Default)]
pub struct Levels {
    shared: BTreeSet<String>,
}

impl Levels {
    /// Levels for these robots, and for later ones.
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
    pub fn level_of(&self, robot: &Robot) -> Result<String, Failure> {
        if self.shared.contains(&robot.name) {
            return level(&format!("{}-{}", robot.name, robot.family));
        }
        level(&robot.name)
    }
}

/// Longest level in bytes. A topic can have 65,535 bytes, but many brokers allow fewer.
const LONGEST: usize = 200;

/// Encodes a name as a level.
pub fn level(name: &str) -> Result<String, Failure> {
    let mut level = String::with_capacity(name.len());
    for (at, c) in name.char_indices() {
        if matches!(c, '+' | '#' | '/' | '%') || c.is_control() || (at == 0 && c == '$') || is_empty_level(c) {
            let mut bytes = [0; 4];
            level.extend(c.encode_utf8(&mut bytes).bytes().map(|byte| format!("%{byte:02X}")));
        } else {
            level.push(c);
        }
    }
    if level.is_empty() || level.len() > LONGEST {
        let shown: String = name.chars().take(40).collect();
        let why = if level.is_empty() { "is empty" } else { "is too long for a topic" };
        return Err(Failure::usage(format!("the name '{shown}' {why}"))
            .hint(format!("change the name in robots.toml: a name in a topic has 1 to {LONGEST} bytes")));
    }
    Ok(level)
}

/// Unicode noncharacters; the standard does not allow them in topics.
fn is_empty_level(c: char) -> bool {
    matches!(c, '\u{fdd0}'..='\u{fdef}') || u32::from(c) & 0xfffe == 0xfffe
}

/// Checks a topic prefix: levels separated by `/`, used unchanged.
pub fn prefix(text: &str) -> Result<String, String> {
    if text.is_empty() || text.len() > LONGEST {
        return Err(format!("a prefix has 1 to {LONGEST} bytes"));
    }
    if text.starts_with('$') {
        return Err("topics that begin with $ are reserved for the broker".to_owned());
    }
    if text.split('/').any(str::is_empty) {
        return Err("each level needs a name: armctl, plant/line1".to_owned());
    }
    if text.chars().any(|c| matches!(c, '+' | '#') || c.is_control() || is_empty_level(c)) {
        return Err("a prefix has no +, no # and no control characters".to_owned());
    }
    Ok(text.to_owned())
}

/// Checks a Sparkplug identifier: no `+`, `#` or `/`.
pub fn identifier(text: &str) -> Result<String, String> {
    if text.is_empty() || text.len() > LONGEST {
        return Err(format!("an identifier has 1 to {LONGEST} bytes"));
    }
    if text.chars().any(|c| matches!(c, '+' | '#' | '/') || c.is_control() || is_empty_level(c)) {
        return Err("an identifier has no +, no #, no / and no control characters".to_owned());
    }
    Ok(text.to_owned())
}

#[cfg(test)]
mod tests {
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

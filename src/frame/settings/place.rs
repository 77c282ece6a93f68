//! Place of a robot in a plant, in four levels as in the equipment hierarchy of ISA-95.

use schemars::JsonSchema;
use serde::Serialize;

/// Longest value of a level, in characters.
const LONGEST: usize = 64;

/// Place of a robot. A level is null if `robots.toml` does not set it.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Place {
    /// Site, such as a plant or a town.
    pub site: Option<String>,
    /// Area of the site, such as a hall.
    pub area: Option<String>,
    /// Production line in the area.
    pub line: Option<String>,
    /// Cell of the line.
    pub cell: Option<String>,
}

impl Place {
    /// Keys of the levels, from the largest to the smallest.
    pub const KEYS: [&str; 4] = ["site", "area", "line", "cell"];

    /// Key and value of each level.
    pub fn levels(&self) -> [(&'static str, Option<&str>); 4] {
        let values = [&self.site, &self.area, &self.line, &self.cell];
        std::array::from_fn(|at| (Self::KEYS[at], values[at].as_deref()))
    }

    /// Value of the level with this key.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.levels().into_iter().find(|(known, _)| *known == key)?.1
    }

    /// Whether no level is set.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The levels in the form of tags, such as `line=3`.
    pub fn tags(&self) -> impl Iterator<Item = String> {
        self.levels().into_iter().filter_map(|(key, value)| Some(format!("{key}={}", value?)))
    }

    /// The levels that are set, joined by `/`.
    pub fn path(&self) -> String {
        self.levels().into_iter().filter_map(|(_, value)| value).collect::<Vec<_>>().join("/")
    }
}

/// Checks the value of a level.
///
/// # Errors
/// If the value is empty, too long, or has control characters.
pub fn check(value: &str) -> Result<(), String> {
    let is_valid = !value.trim().is_empty() && value.chars().count() <= LONGEST && !value.chars().any(char::is_control);
    if is_valid { Ok(()) } else { Err(format!("a place has 1 to {LONGEST} characters")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_the_levels_that_are_set() {
        let place = Place { site: Some("Berlin".into()), line: Some("3".into()), ..Place::default() };
        assert_eq!(place.tags().collect::<Vec<_>>(), ["site=Berlin", "line=3"]);
        assert_eq!((place.path().as_str(), place.get("line"), place.get("area")), ("Berlin/3", Some("3"), None));
        assert!(!place.is_empty() && Place::default().is_empty());
        for (value, is_valid) in [("3", true), ("", false), (" ", false), ("a\n", false)] {
            assert_eq!(check(value).is_ok(), is_valid, "{value:?}");
        }
        assert!(check(&"x".repeat(65)).is_err());
    }
}

//! User-defined names of signals, variables, registers and other objects, with their addresses.
//!
//! A text is looked up as a name only if it is not an address, so a name never hides an address. Names of the inventory
//! have priority over names of the controller. Upper and lower case matter only if two names are otherwise equal.

use std::collections::HashMap;
use std::fmt;

/// Kind of a named object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Kind {
    /// A signal, or a word of signals.
    Signal,
    /// A variable.
    Variable,
    /// A register.
    Register,
    /// A port, or a bit of a port.
    Port,
    /// A bit of an input port.
    Input,
    /// A bit of an output port.
    Output,
    /// A counter.
    Counter,
    /// A timer.
    Timer,
    /// A row of the coordinate table.
    Point,
}

impl Kind {
    /// Word in messages and reports.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Signal => "signal",
            Self::Variable => "variable",
            Self::Register => "register",
            Self::Port => "port",
            Self::Input => "input",
            Self::Output => "output",
            Self::Counter => "counter",
            Self::Timer => "timer",
            Self::Point => "point",
        }
    }
}

/// Origin of a name.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// `robots.toml`.
    Inventory,
    /// A file of the controller.
    File(String),
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Inventory => f.write_str("robots.toml"),
            Self::File(file) => f.write_str(file),
        }
    }
}

/// A name and its address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Name {
    /// Kind of the object.
    pub kind: Kind,
    /// Address in the notation of the family, for example `#27010`, `B5` or `SO(20)`.
    pub address: String,
    /// The name.
    pub name: String,
    /// Origin of the name.
    pub source: Source,
}

/// Address notation of a family.
#[derive(Debug, Clone, Copy)]
pub struct Grammar {
    /// Parses an address and returns it in the notation of the family; `None` for other text.
    pub address: fn(&str) -> Option<(Kind, String)>,
    /// Prefixes with which an address of the family can begin.
    pub prefixes: &'static [&'static str],
}

impl Grammar {
    /// Whether a text has the form of an address, even if no such address exists. A name must not have this form.
    pub fn is_shaped(self, text: &str) -> bool {
        let text = text.trim_start_matches('#');
        let digits = text.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(text.len());
        let (letters, rest) = text.split_at(digits);
        let is_prefix = letters.is_empty() || self.prefixes.iter().any(|prefix| prefix.eq_ignore_ascii_case(letters));
        let is_number = rest.contains(|c: char| c.is_ascii_digit())
            && rest.chars().all(|c| c.is_ascii_digit() || "().-:#".contains(c));
        is_prefix && is_number || (self.address)(text).is_some()
    }
}

/// Maximum length of a name in bytes. This is four times the maximum length on a pendant.
pub const MAX_NAME_BYTES: usize = 128;

/// Returns the reason why a text cannot be used as a name, or `None` if it can be used.
pub fn unusable(grammar: Grammar, text: &str) -> Option<&'static str> {
    if text.trim().is_empty() || text.trim() != text {
        Some("it is empty, or begins or ends with a blank")
    } else if text.len() > MAX_NAME_BYTES {
        Some("it is too long")
    } else if text.contains([',', '=']) || text.chars().any(char::is_control) {
        Some("it contains a comma, an equals sign or a control character")
    } else if text.starts_with('-') {
        Some("it begins with a dash, like a flag")
    } else if grammar.is_shaped(text) {
        Some("it has the form of an address")
    } else {
        None
    }
}

/// Result of a name lookup.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NameMatch<'a> {
    /// One match.
    One(&'a Name),
    /// Several matches.
    Several(Vec<&'a Name>),
    /// No match.
    None,
}

/// All names of a robot.
#[derive(Debug, Clone, Default)]
pub struct Names {
    all: Vec<Name>,
    /// The first name of each address.
    by_address: HashMap<(Kind, String), usize>,
    /// Indexes by lower-case name.
    by_name: HashMap<String, Vec<usize>>,
}

impl Names {
    /// Creates a collection and keeps the order of the names. The label of an address is the first name of this
    /// address.
    pub fn new(all: Vec<Name>) -> Self {
        let mut by_address = HashMap::with_capacity(all.len());
        let mut by_name: HashMap<String, Vec<usize>> = HashMap::with_capacity(all.len());
        for (at, name) in all.iter().enumerate() {
            by_address.entry((name.kind, name.address.clone())).or_insert(at);
            by_name.entry(name.name.to_lowercase()).or_default().push(at);
        }
        Self { all, by_address, by_name }
    }

    /// All names, in order.
    pub fn iter(&self) -> impl Iterator<Item = &Name> {
        self.all.iter()
    }

    /// Whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The name of an address in the notation of the family.
    pub fn label(&self, kind: Kind, address: &str) -> Option<&str> {
        if self.all.is_empty() {
            return None;
        }
        let at = self.by_address.get(&(kind, address.to_owned()))?;
        self.all.get(*at).map(|name| name.name.as_str())
    }

    /// Looks up a name among the objects of these kinds.
    pub fn find(&self, kinds: &[Kind], text: &str) -> NameMatch<'_> {
        let alike = self.by_name.get(&text.to_lowercase()).map(Vec::as_slice).unwrap_or_default();
        let alike = || alike.iter().filter_map(|at| self.all.get(*at)).filter(|name| kinds.contains(&name.kind));
        let is_own = |name: &Name| name.source == Source::Inventory;
        // Pairs of (inventory name, exact case), in the order of the search. Names of the inventory come first. Within
        // each source, names with exact case come first.
        let steps = [(true, true), (true, false), (false, true), (false, false)];
        for (own, exact) in steps {
            let mut found: Vec<&Name> = Vec::new();
            for name in alike().filter(|name| is_own(name) == own && (!exact || name.name == text)) {
                if !found.iter().any(|other| (other.kind, &other.address) == (name.kind, &name.address)) {
                    found.push(name);
                }
            }
            match found[..] {
                [] => {}
                [one] => return NameMatch::One(one),
                _ => return NameMatch::Several(found),
            }
        }
        NameMatch::None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn name(kind: Kind, address: &str, name: &str, source: Source) -> Name {
        Name { kind, address: address.to_owned(), name: name.to_owned(), source }
    }

    fn names() -> Names {
        let file = || Source::File("IONAME.DAT".to_owned());
        Names::new(vec![
            name(Kind::Signal, "#27010", "clamp", Source::Inventory),
            name(Kind::Signal, "#27011", "clamp", Source::Inventory),
            name(Kind::Signal, "#27012", "Lamp", Source::Inventory),
            name(Kind::Signal, "#00010", "LAMP", file()),
            name(Kind::Signal, "#00011", "Door", file()),
            name(Kind::Signal, "#10011", "DOOR", file()),
            name(Kind::Signal, "#27012", "Lamp", Source::Inventory),
            name(Kind::Variable, "B5", "DOOR", file()),
        ])
    }

    fn found(kinds: &[Kind], text: &str) -> String {
        match names().find(kinds, text) {
            NameMatch::One(name) => name.address.clone(),
            NameMatch::Several(names) => names.iter().map(|name| name.address.as_str()).collect::<Vec<_>>().join("+"),
            NameMatch::None => "-".to_owned(),
        }
    }

    #[test]
    fn inventory_names_come_first_and_controller_names_are_case_sensitive() {
        let signal = |text| found(&[Kind::Signal], text);
        assert_eq!(signal("clamp"), "#27010+#27011");
        assert_eq!(signal("lamp"), "#27012");
        assert_eq!(signal("LAMP"), "#27012", "that of the file is hidden");
        assert_eq!(
            (signal("Door"), signal("DOOR"), signal("door")),
            ("#00011".into(), "#10011".into(), "#00011+#10011".into())
        );
        assert_eq!(signal("nothing"), "-");
        assert_eq!(found(&[Kind::Variable], "door"), "B5");
    }

    #[test]
    fn an_address_shows_its_first_name() {
        assert_eq!(names().label(Kind::Signal, "#27012"), Some("Lamp"));
        assert_eq!(names().label(Kind::Variable, "#27012"), None);
    }

    #[test]
    fn rejects_names_that_look_like_addresses() {
        const GRAMMAR: Grammar = Grammar { address: |_| None, prefixes: &["B", "SO"] };
        for text in ["27018", "#9", "B300", "b5", "SO(05)", "SO20..27", "1.3", "", " x", "a,b", "a=b", "x\u{1b}", "-x"]
        {
            assert!(unusable(GRAMMAR, text).is_some(), "{text:?}");
        }
        for text in ["clamp", "VAC1", "B", "FILTER CLEAN", "2ND_PICK", "扉", "a.b", "B5X"] {
            assert_eq!(unusable(GRAMMAR, text), None, "{text}");
        }
    }
}

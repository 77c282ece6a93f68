//! Names instead of addresses: `io get clamp`, `io set clamp=on`, `var get PARTS`.
//!
//! Arguments are parsed before their robots are known, and the risk of a line depends on addresses. For this reason, a
//! line that may contain a name is parsed twice. The first parse replaces the name by any valid address, to find the
//! robots of the line. In the second parse, the names of these robots are known, and the word is replaced by its
//! address, or rejected. A valid address is never looked up as a name.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};

use jiff::Timestamp;
use jiff::tz::TimeZone;

use super::value_kind::Candidate;
use crate::prelude::basics::*;
use crate::settings::names::{KeptFile, RobotNames, grammar};
use armctl_controller::names::{Grammar, Kind, Name, NameMatch, Names, unusable};

/// What the parser does with a word that is not an address.
#[derive(Debug, Clone, Default)]
enum Mode {
    /// Rejects the word.
    #[default]
    Off,
    /// Accepts the word as a possible name.
    Asking,
    /// Looks up the word in the names of these robots.
    Known(Rc<NameLookup>),
}

#[derive(Debug)]
struct NameLookup {
    family: Family,
    robots: Vec<(String, RobotNames)>,
}

thread_local! {
    /// The mode is thread-local, because value parsers receive no context. A line is parsed in one call on one thread.
    static MODE: RefCell<Mode> = const { RefCell::new(Mode::Off) };
    static NAME_FOUND: RefCell<bool> = const { RefCell::new(false) };
}

/// Restores the previous mode when dropped, even if a parser panics.
struct Restore(Mode);

impl Drop for Restore {
    fn drop(&mut self) {
        MODE.replace(std::mem::take(&mut self.0));
    }
}

/// Parses and accepts possible names. Also returns whether there were any.
pub fn detect_names<T>(parse: impl FnOnce() -> T) -> (T, bool) {
    let _restore = Restore(MODE.replace(Mode::Asking));
    NAME_FOUND.replace(false);
    let parsed = parse();
    (parsed, NAME_FOUND.replace(false))
}

/// Parses with the names of the robots for which the line is.
pub fn with_names<T>(family: Family, robots: &[Robot], parse: impl FnOnce() -> T) -> T {
    let robots = robots.iter().map(|robot| (robot.name.clone(), robot.names.clone())).collect();
    let _restore = Restore(MODE.replace(Mode::Known(Rc::new(NameLookup { family, robots }))));
    parse()
}

/// Parses an argument: a value that `parse` accepts, or a name of these kinds. `any` is some address that `parse`
/// accepts; its value does not matter.
pub fn parse_or_name<T>(
    kinds: &[Kind],
    any: &str,
    text: &str,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Result<T, String> {
    parse_or_name_marked(kinds, any, text, parse).map(|(value, _)| value)
}

/// Parses an argument. Also returns whether `any` replaces a name that is not resolved yet. In that case, nothing else
/// about the argument can be checked.
pub fn parse_or_name_marked<T>(
    kinds: &[Kind],
    any: &str,
    text: &str,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Result<(T, bool), String> {
    let error = match parse(text) {
        Ok(value) => return Ok((value, false)),
        Err(wrong) => wrong,
    };
    match MODE.with_borrow(Clone::clone) {
        Mode::Off => Err(error),
        Mode::Asking => {
            NAME_FOUND.replace(true);
            parse(any).map(|value| (value, true)).map_err(|_| error)
        }
        Mode::Known(known) if grammar(known.family).is_shaped(text) => Err(error),
        Mode::Known(known) => match known.address(kinds, text) {
            Ok(Some(address)) => {
                parse(&address).map(|value| (value, false)).map_err(|why| format!("{text} is {address}: {why}"))
            }
            Ok(None) => match known.suggest(kinds, text) {
                Some(near) => Err(format!("{error}; did you mean '{near}'?")),
                None if known.has_missing_names() => {
                    Err(format!("{error}; read the names of the controller with `yerc names get`"))
                }
                None => Err(error),
            },
            Err(why) => Err(why),
        },
    }
}

impl NameLookup {
    /// Address of a name. All robots must have the same address for it. `None` if no robot has the name.
    fn address(&self, kinds: &[Kind], text: &str) -> Result<Option<String>, String> {
        let mut addresses: Vec<(&str, Option<String>)> = Vec::new();
        for (robot, names) in &self.robots {
            addresses.push((
                robot,
                match names.all().names.find(kinds, text) {
                    NameMatch::One(name) => Some(name.address.clone()),
                    NameMatch::None => None,
                    NameMatch::Several(several) => return Err(ambiguous(text, &several)),
                },
            ));
        }
        let Some((first, address)) = addresses.iter().find(|(_, address)| address.is_some()) else { return Ok(None) };
        match addresses.iter().find(|(_, other)| other != address) {
            None => Ok(address.clone()),
            Some((other, Some(other_address))) => Err(format!(
                "'{text}' is {} on {first} and {other_address} on {other}; select one robot, or type the address",
                address.as_deref().unwrap_or_default()
            )),
            Some((other, None)) => Err(format!("'{text}' is a name of {first}, but not of {other}; select one robot")),
        }
    }

    fn suggest(&self, kinds: &[Kind], text: &str) -> Option<String> {
        let grammar = grammar(self.family);
        let names = self.robots.iter().flat_map(|(_, names)| names.all().names.iter());
        let names = names.filter(|name| kinds.contains(&name.kind)).map(|name| name.name.as_str());
        // A name with control characters cannot be typed, so it is not suggested.
        nearest(text, names.filter(|name| unusable(grammar, name).is_none())).map(ToOwned::to_owned)
    }

    /// Whether a controller may have names that are not stored on this computer.
    fn has_missing_names(&self) -> bool {
        self.robots.iter().any(|(_, names)| names.cache_file().is_some() && names.all().kept.is_none())
    }
}

/// Message: several addresses have the same name.
fn ambiguous(text: &str, several: &[&Name]) -> String {
    /// Maximum number of addresses that the message lists. Further addresses are only counted.
    const SHOWN: usize = 6;

    let describe = |name: &&Name| format!("{} ({} of {})", name.address, name.name, name.source);
    let mut described: Vec<String> = several.iter().take(SHOWN).map(describe).collect();
    if several.len() > SHOWN {
        described.push(format!("{} more", several.len() - SHOWN));
    }
    format!("'{text}' is the name of {}; type the address", described.join(" and of "))
}

/// Last message about names that could not be read.
static LAST_MESSAGE: Mutex<String> = Mutex::new(String::new());

/// Names of a robot for a report. If the stored names cannot be read, the error is printed once, and the report is
/// still made.
pub fn of_robot<'a>(robot: &'a Robot, screen: &Screen) -> &'a Names {
    let all = robot.names.all();
    if let Some(damage) = &all.damage {
        let text = format!("{}; {}", damage.message, damage.hint.as_deref().unwrap_or_default());
        let mut last_message = LAST_MESSAGE.lock().unwrap_or_else(PoisonError::into_inner);
        if *last_message != text {
            screen.note(&text);
            *last_message = text;
        }
    }
    &all.names
}

/// Name for an address, for a report.
pub fn label(names: &Names, kind: Kind, address: &str) -> Option<String> {
    names.label(kind, address).map(ToOwned::to_owned)
}

/// Names for completion, with their addresses.
pub fn candidates(robots: &[Robot], kinds: &[Kind], ending: &str) -> Vec<Candidate> {
    let [robot] = robots else { return Vec::new() };
    let grammar = grammar(robot.family);
    let names = robot.names.all().names.iter();
    let names = names.filter(|name| kinds.contains(&name.kind) && unusable(grammar, &name.name).is_none());
    names.map(|name| Candidate::new(format!("{}{ending}", name.name), name.address.clone())).collect()
}

/// Names of a robot that contain a text, or all names of the robot.
pub fn list(robot: &Robot, filter: Option<&str>) -> Result<Listing> {
    let all = robot.names.all();
    if let Some(damage) = &all.damage {
        return Err(damage.clone());
    }
    let grammar = grammar(robot.family);
    let filter = filter.map(str::to_lowercase);
    let is_wanted = |name: &&Name| {
        let fits = |text: &str| filter.as_ref().is_none_or(|filter| text.to_lowercase().contains(filter));
        fits(&name.name) || fits(&name.address) || fits(name.kind.word()) || fits(&name.source.to_string())
    };
    let listed = |name: &Name| Listed {
        name: name.name.clone(),
        kind: name.kind.word(),
        address: name.address.clone(),
        source: name.source.to_string(),
        not_typed: not_typed(grammar, &all.names, name),
    };
    let names = all.names.iter().filter(is_wanted).map(listed).collect();
    let kept = all.kept.as_ref();
    let seconds = |read_at: Timestamp| Timestamp::now().as_second().saturating_sub(read_at.as_second());
    Ok(Listing {
        names,
        read_at: kept.map(|kept| kept.read_at),
        age_s: kept.map(|kept| seconds(kept.read_at)),
        files: kept.map(|kept| kept.files.clone()).unwrap_or_default(),
        is_all: filter.is_none(),
    })
}

/// Reason why the user cannot type a name instead of its address; `None` if the user can.
fn not_typed(grammar: Grammar, names: &Names, name: &Name) -> Option<String> {
    if let Some(why) = unusable(grammar, &name.name) {
        return Some(why.to_owned());
    }
    match names.find(&[name.kind], &name.name) {
        NameMatch::One(found) if found.address == name.address => None,
        NameMatch::One(found) => Some(format!("the name belongs to {} in {}", found.address, found.source)),
        NameMatch::Several(several) => {
            let other = several.iter().find(|other| other.address != name.address);
            Some(format!("the name also belongs to {}", other.map_or("another address", |other| &other.address)))
        }
        NameMatch::None => None,
    }
}

/// Names of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listing {
    names: Vec<Listed>,
    /// Time at which the names were read from the controller; null if none are stored.
    #[schemars(with = "Option<String>", extend("format" = "date-time"))]
    read_at: Option<Timestamp>,
    /// Age of the stored names in seconds.
    age_s: Option<i64>,
    /// Files that contain the stored names.
    files: Vec<KeptFile>,
    #[serde(skip)]
    is_all: bool,
}

/// A name and its address.
#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    name: String,
    /// `signal`, `variable`, `register`, `port`, `input`, `output` or `counter`.
    kind: &'static str,
    /// Address, such as `#27010`, `B5`, `SO(20)`.
    address: String,
    /// `robots.toml`, or the file of the controller.
    source: String,
    /// Reason why the name cannot be typed instead of the address; null if it can be typed.
    not_typed: Option<String>,
}

impl Report for Listing {
    const ROWS: RowsOf = RowsOf::List("names");

    fn view(&self) -> View {
        let empty = if self.is_all { "no names" } else { "no matching names" };
        let mut table = Table::new(&["name", "kind", "address", "from", "cannot be typed"], empty);
        for Listed { name, kind, address, source, not_typed } in &self.names {
            let not_typed = Cell::optional(not_typed.as_deref());
            table.row([
                name.as_str().into(),
                (*kind).into(),
                address.as_str().into(),
                source.as_str().into(),
                not_typed,
            ]);
        }
        let view = View::table(table.without_blank("cannot be typed"));
        let Some((read_at, age)) = self.read_at.zip(self.age_s) else { return view };
        let read_at = read_at.to_zoned(TimeZone::system()).strftime("%Y-%m-%d %H:%M:%S");
        view.append(Section::Text(format!("read from the controller on {read_at}, {} ago", describe_age(age))))
    }
}

/// Duration in its largest unit, for example `3 days`.
fn describe_age(seconds: i64) -> String {
    let units = [(86_400, "day"), (3_600, "hour"), (60, "minute"), (1, "second")];
    let (size, unit) = units.into_iter().find(|(size, _)| seconds >= *size).unwrap_or((1, "second"));
    let count = seconds.max(0) / size;
    format!("{count} {unit}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::names::Source;

    fn robot(name: &str, names: &[(&str, &str)]) -> Robot {
        let sources = crate::settings::Sources {
            inventory: crate::settings::inventory::Inventory::parse(
                &format!(
                    "[[robot]]\nname = \"{name}\"\ntarget = \"udp://127.0.0.1:1\"\n[robot.names]\n{}",
                    names.iter().map(|(name, address)| format!("\"{name}\" = \"{address}\"\n")).collect::<String>()
                ),
                "robots.toml",
            )
            .unwrap(),
            ..crate::settings::Sources::default()
        };
        sources.resolve(&sources.inventory.robots[0], None).unwrap()
    }

    fn number(text: &str) -> Result<u32, String> {
        text.trim_start_matches('#').parse().map_err(|_| format!("'{text}' is no number"))
    }

    fn read_signal(text: &str) -> Result<u32, String> {
        parse_or_name(&[Kind::Signal], "27010", text, number)
    }

    #[test]
    fn parses_a_name_twice_and_an_address_once() {
        assert_eq!(read_signal("clamp").unwrap_err(), "'clamp' is no number");
        assert_eq!(detect_names(|| read_signal("27011")), (Ok(27011), false));
        assert_eq!(detect_names(|| read_signal("clamp")), (Ok(27010), true));
        let robots = [robot("a", &[("clamp", "27015"), ("lamp", "27016")])];
        let known = |text: &str| with_names(Family::Yerc, &robots, || read_signal(text));
        assert_eq!((known("clamp"), known("CLAMP"), known("27011")), (Ok(27015), Ok(27015), Ok(27011)));
        assert_eq!(known("clanp").unwrap_err(), "'clanp' is no number; did you mean 'clamp'?");
        let unknown = known("door").unwrap_err();
        assert_eq!(unknown, "'door' is no number; read the names of the controller with `yerc names get`");
        assert_eq!(known("#9x").unwrap_err().split(';').next(), Some("'#9x' is no number"));
        assert_eq!(read_signal("clamp").unwrap_err(), "'clamp' is no number", "it is as it was");
    }

    #[test]
    fn requires_the_same_address_on_several_robots() {
        let robots = [
            robot("a", &[("clamp", "27015"), ("lamp", "27016"), ("door", "27017")]),
            robot("b", &[("clamp", "27015"), ("lamp", "27026")]),
        ];
        let known = |text: &str| with_names(Family::Yerc, &robots, || read_signal(text));
        assert_eq!(known("clamp"), Ok(27015));
        assert!(known("lamp").unwrap_err().starts_with("'lamp' is #27016 on a and #27026 on b"));
        assert!(known("door").unwrap_err().starts_with("'door' is a name of a, but not of b"));
    }

    #[test]
    fn describes_ages_in_their_largest_unit() {
        let told = [0, 1, 59, 60, 7_199, 90_000, -5].map(describe_age);
        assert_eq!(told, ["0 seconds", "1 second", "59 seconds", "1 minute", "1 hour", "1 day", "0 seconds"]);
    }

    #[test]
    fn lists_the_addresses_of_an_ambiguous_name() {
        let name = |address: &str, source| Name {
            kind: Kind::Signal,
            address: address.to_owned(),
            name: "DOOR".to_owned(),
            source,
        };
        let names = [name("#00010", Source::File("IONAME.DAT".to_owned())), name("#10010", Source::Inventory)];
        let told = ambiguous("door", &names.iter().collect::<Vec<_>>());
        assert_eq!(
            told,
            "'door' is the name of #00010 (DOOR of IONAME.DAT) and of #10010 (DOOR of robots.toml); type the address"
        );
    }
}

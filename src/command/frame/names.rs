//! Names in place of addresses: `io get clamp`, `io set clamp=on`, `var get PARTS`.
//!
//! Arguments are parsed before it is known whose they are, and must be addresses before anything decides what a line
//! may do. So a line with a word that may be a name is read twice: at first any address stands for it, which tells which
//! robots the line is for; then their names are known, and the word is the address that it stands for, or a mistake. What
//! is an address is never looked up.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Mutex, PoisonError};

use jiff::Timestamp;
use jiff::tz::TimeZone;
use schemars::JsonSchema;
use serde::Serialize;

use super::kind::Candidate;
use super::report::Report;
use crate::controller::names::{Found, Grammar, Kind, Name, Names, unusable};
use crate::controller::nearest::nearest;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, Table, View};
use crate::settings::Robot;
use crate::settings::names::{KeptFile, RobotNames, grammar};
use crate::settings::target::Family;

/// What becomes of a word that is no address.
#[derive(Debug, Clone, Default)]
enum Mode {
    /// It is a mistake.
    #[default]
    Off,
    /// It may be a name.
    Asking,
    /// It is a name of these robots, or a mistake.
    Known(Rc<Known>),
}

#[derive(Debug)]
struct Known {
    family: Family,
    robots: Vec<(String, RobotNames)>,
}

thread_local! {
    /// Parsing is one call on one thread, which hands nothing of its caller to the parsers of values.
    static MODE: RefCell<Mode> = const { RefCell::new(Mode::Off) };
    static ASKED: RefCell<bool> = const { RefCell::new(false) };
}

/// Puts things back as they were, also where a parser panics.
struct Restore(Mode);

impl Drop for Restore {
    fn drop(&mut self) {
        MODE.replace(std::mem::take(&mut self.0));
    }
}

/// Parses where words may be names, and says whether there were some.
pub fn asking<T>(parse: impl FnOnce() -> T) -> (T, bool) {
    let _restore = Restore(MODE.replace(Mode::Asking));
    ASKED.replace(false);
    let parsed = parse();
    (parsed, ASKED.replace(false))
}

/// Parses with the names of the robots that the line is for.
pub fn known<T>(family: Family, robots: &[Robot], parse: impl FnOnce() -> T) -> T {
    let robots = robots.iter().map(|robot| (robot.name.clone(), robot.names.clone())).collect();
    let _restore = Restore(MODE.replace(Mode::Known(Rc::new(Known { family, robots }))));
    parse()
}

/// Reads an argument: what `parse` takes, or the name of something of these kinds. `any` is an address that `parse`
/// takes, of whichever.
pub fn read<T>(kinds: &[Kind], any: &str, text: &str, parse: impl Fn(&str) -> Result<T, String>) -> Result<T, String> {
    read_marked(kinds, any, text, parse).map(|(value, _)| value)
}

/// The same, and whether `any` stands for a name that is yet to be looked up: nothing can be said yet of what is typed
/// beside it.
pub fn read_marked<T>(
    kinds: &[Kind],
    any: &str,
    text: &str,
    parse: impl Fn(&str) -> Result<T, String>,
) -> Result<(T, bool), String> {
    let wrong = match parse(text) {
        Ok(value) => return Ok((value, false)),
        Err(wrong) => wrong,
    };
    match MODE.with_borrow(Clone::clone) {
        Mode::Off => Err(wrong),
        Mode::Asking => {
            ASKED.replace(true);
            parse(any).map(|value| (value, true)).map_err(|_| wrong)
        }
        Mode::Known(known) if grammar(known.family).is_shaped(text) => Err(wrong),
        Mode::Known(known) => match known.address(kinds, text) {
            Ok(Some(address)) => {
                parse(&address).map(|value| (value, false)).map_err(|why| format!("{text} is {address}: {why}"))
            }
            Ok(None) => match known.near(kinds, text) {
                Some(near) => Err(format!("{wrong}; did you mean '{near}'?")),
                None if known.has_unread() => {
                    Err(format!("{wrong}; names that the controller has are read by `yerc names get`"))
                }
                None => Err(wrong),
            },
            Err(why) => Err(why),
        },
    }
}

impl Known {
    /// What all robots mean by a name; `None` where no robot has it.
    fn address(&self, kinds: &[Kind], text: &str) -> Result<Option<String>, String> {
        let mut meant: Vec<(&str, Option<String>)> = Vec::new();
        for (robot, names) in &self.robots {
            meant.push((
                robot,
                match names.all().names.find(kinds, text) {
                    Found::One(name) => Some(name.address.clone()),
                    Found::None => None,
                    Found::Several(several) => return Err(ambiguous(text, &several)),
                },
            ));
        }
        let Some((first, address)) = meant.iter().find(|(_, address)| address.is_some()) else { return Ok(None) };
        match meant.iter().find(|(_, other)| other != address) {
            None => Ok(address.clone()),
            Some((other, Some(there))) => Err(format!(
                "'{text}' is {} on {first} and {there} on {other}; ask one robot at a time, or type the address",
                address.as_deref().unwrap_or_default()
            )),
            Some((other, None)) => {
                Err(format!("'{text}' is a name of {first}, but not of {other}; ask one robot at a time"))
            }
        }
    }

    fn near(&self, kinds: &[Kind], text: &str) -> Option<String> {
        let grammar = grammar(self.family);
        let names = self.robots.iter().flat_map(|(_, names)| names.all().names.iter());
        let names = names.filter(|name| kinds.contains(&name.kind)).map(|name| name.name.as_str());
        // What could do something to the terminal can be typed by nobody.
        nearest(text, names.filter(|name| unusable(grammar, name).is_none())).map(ToOwned::to_owned)
    }

    /// Whether a controller may have names of which none is kept.
    fn has_unread(&self) -> bool {
        self.robots.iter().any(|(_, names)| names.place().is_some() && names.all().kept.is_none())
    }
}

/// Addresses that have one name: which to type.
fn ambiguous(text: &str, several: &[&Name]) -> String {
    /// More are counted.
    const SHOWN: usize = 6;

    let told = |name: &&Name| format!("{} ({} of {})", name.address, name.name, name.source);
    let mut told: Vec<String> = several.iter().take(SHOWN).map(told).collect();
    if several.len() > SHOWN {
        told.push(format!("{} more", several.len() - SHOWN));
    }
    format!("'{text}' is the name of {}; type the address", told.join(" and of "))
}

/// What was said last of names that cannot be read.
static TOLD: Mutex<String> = Mutex::new(String::new());

/// The names of a robot for a report. What keeps those of its controller from being read is said once, and hides no
/// report.
pub fn of<'a>(robot: &'a Robot, screen: &Screen) -> &'a Names {
    let all = robot.names.all();
    if let Some(damage) = &all.damage {
        let text = format!("{}; {}", damage.message, damage.hint.as_deref().unwrap_or_default());
        let mut told = TOLD.lock().unwrap_or_else(PoisonError::into_inner);
        if *told != text {
            screen.note(&text);
            *told = text;
        }
    }
    &all.names
}

/// The name of an address, for a report.
pub fn label(names: &Names, kind: Kind, address: &str) -> Option<String> {
    names.label(kind, address).map(ToOwned::to_owned)
}

/// Names that can be typed, with what they stand for.
pub fn candidates(robots: &[Robot], kinds: &[Kind], ending: &str) -> Vec<Candidate> {
    let [robot] = robots else { return Vec::new() };
    let grammar = grammar(robot.family);
    let names = robot.names.all().names.iter();
    let names = names.filter(|name| kinds.contains(&name.kind) && unusable(grammar, &name.name).is_none());
    names.map(|name| Candidate::new(format!("{}{ending}", name.name), name.address.clone())).collect()
}

/// The names of a robot that have a text in them; all of them without one.
pub fn list(robot: &Robot, filter: Option<&str>) -> Result<Listing, Failure> {
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

/// Why a name cannot be typed for its address; `None` where it can.
fn not_typed(grammar: Grammar, names: &Names, name: &Name) -> Option<String> {
    if let Some(why) = unusable(grammar, &name.name) {
        return Some(why.to_owned());
    }
    match names.find(&[name.kind], &name.name) {
        Found::One(found) if found.address == name.address => None,
        Found::One(found) => Some(format!("it is the name of {} in {}", found.address, found.source)),
        Found::Several(several) => {
            let other = several.iter().find(|other| other.address != name.address);
            Some(format!("it is the name of {}, too", other.map_or("another one", |other| &other.address)))
        }
        Found::None => None,
    }
}

/// Names of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listing {
    names: Vec<Listed>,
    /// When those of the controller were read; null where none are kept.
    #[schemars(with = "Option<String>", extend("format" = "date-time"))]
    read_at: Option<Timestamp>,
    /// How long ago that was.
    age_s: Option<i64>,
    /// The files they were in.
    files: Vec<KeptFile>,
    #[serde(skip)]
    is_all: bool,
}

/// A name.
#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    name: String,
    /// `signal`, `variable`, `register`, `port`, `input`, `output` or `counter`.
    kind: &'static str,
    /// `#27010`, `B5`, `SO(20)`.
    address: String,
    /// `robots.toml`, or the file of the controller.
    source: String,
    /// Why it cannot be typed in place of the address; null where it can.
    not_typed: Option<String>,
}

impl Report for Listing {
    fn view(&self) -> View {
        let empty = if self.is_all { "no names" } else { "no names that fit" };
        let mut table = Table::new(&["name", "kind", "address", "from", "cannot be typed"], empty);
        for Listed { name, kind, address, source, not_typed } in &self.names {
            let not_typed = Cell::maybe(not_typed.as_deref());
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
        view.and(Section::Text(format!("read from the controller on {read_at}, {} ago", in_words(age))))
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("names")
    }
}

/// A time in its largest unit: `3 days`.
fn in_words(seconds: i64) -> String {
    let units = [(86_400, "day"), (3_600, "hour"), (60, "minute"), (1, "second")];
    let (size, unit) = units.into_iter().find(|(size, _)| seconds >= *size).unwrap_or((1, "second"));
    let count = seconds.max(0) / size;
    format!("{count} {unit}{}", if count == 1 { "" } else { "s" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::names::Source;

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
        sources.resolved(&sources.inventory.robots[0], None).unwrap()
    }

    fn number(text: &str) -> Result<u32, String> {
        text.trim_start_matches('#').parse().map_err(|_| format!("'{text}' is no number"))
    }

    fn read_signal(text: &str) -> Result<u32, String> {
        read(&[Kind::Signal], "27010", text, number)
    }

    #[test]
    fn a_name_is_read_twice_and_an_address_once() {
        assert_eq!(read_signal("clamp").unwrap_err(), "'clamp' is no number");
        assert_eq!(asking(|| read_signal("27011")), (Ok(27011), false));
        assert_eq!(asking(|| read_signal("clamp")), (Ok(27010), true));
        let robots = [robot("a", &[("clamp", "27015"), ("lamp", "27016")])];
        let known = |text: &str| known(Family::Yerc, &robots, || read_signal(text));
        assert_eq!((known("clamp"), known("CLAMP"), known("27011")), (Ok(27015), Ok(27015), Ok(27011)));
        assert_eq!(known("clanp").unwrap_err(), "'clanp' is no number; did you mean 'clamp'?");
        let unknown = known("door").unwrap_err();
        assert_eq!(unknown, "'door' is no number; names that the controller has are read by `yerc names get`");
        assert_eq!(known("#9x").unwrap_err().split(';').next(), Some("'#9x' is no number"));
        assert_eq!(read_signal("clamp").unwrap_err(), "'clamp' is no number", "it is as it was");
    }

    #[test]
    fn several_robots_must_mean_the_same() {
        let robots = [
            robot("a", &[("clamp", "27015"), ("lamp", "27016"), ("door", "27017")]),
            robot("b", &[("clamp", "27015"), ("lamp", "27026")]),
        ];
        let known = |text: &str| known(Family::Yerc, &robots, || read_signal(text));
        assert_eq!(known("clamp"), Ok(27015));
        assert!(known("lamp").unwrap_err().starts_with("'lamp' is #27016 on a and #27026 on b"));
        assert!(known("door").unwrap_err().starts_with("'door' is a name of a, but not of b"));
    }

    #[test]
    fn ages_are_told_in_their_largest_unit() {
        let told = [0, 1, 59, 60, 7_199, 90_000, -5].map(in_words);
        assert_eq!(told, ["0 seconds", "1 second", "59 seconds", "1 minute", "1 hour", "1 day", "0 seconds"]);
    }

    #[test]
    fn what_has_several_addresses_says_which_to_type() {
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

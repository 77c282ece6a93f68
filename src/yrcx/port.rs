//! `yrcx port` (4.5.1): ports of eight signals, read and written with remote commands.

use super::number_arguments::{Series, named, single};
use super::read_requests::ask_each;
use super::single_command::one_row;
use crate::prelude::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::yrcx::names::signal_of_port;
use armctl_frame::robot::item::{Columns, Item, Items, Written, WrittenItems};

commands! {
    /// Commands for ports.
    pub enum Port {
        /// Read ports or signals, for example DI2, DO12 or DO2.1
        Get(Get),
        /// Switch a port or a signal, for example `DO12 7` or `DO2.1 on`
        Set(Set),
        /// Print each change of ports
        Watch(Watch<Get>),
    }
}

/// Port names, for the help of get and set.
const NAMES: &str = "DO12 is a port; DO2.1 and 'DO(21)' are bit 1 of port DO2. DI, DO, MO, SI and SO have ports 0-7, \
                     10-17 and 20-27, LO has 0 and 1, TO has 0. DO, MO, LO, TO and SO are writable; DO, MO and SO are \
                     writable from port 2. `yrcx io` reads and switches SI and SO without remote commands.";

/// A port, or one signal of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct PortSignal {
    /// Number of the port type.
    kind: i32,
    port: i32,
    bit: Option<i32>,
}

/// Parses a port or a signal, for example `DO12`, `DO12()`, `DO2.1`, `DO(21)`.
fn place(text: &str) -> Result<PortSignal, String> {
    let wrong = || format!("'{text}' is not a valid port, such as DO12, or signal, such as DO2.1");
    let (kind, rest) = text.split_at_checked(2).ok_or_else(wrong)?;
    let kind = single(table::Command::PortGet, Key::PortType, kind).map_err(|_| wrong())?;
    let (port, bit) = match rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')) {
        Some(digits) => {
            let (port, bit) = digits.split_at_checked(digits.len().saturating_sub(1)).ok_or_else(wrong)?;
            (if port.is_empty() { "0" } else { port }, Some(bit))
        }
        None => match rest.split_once('.') {
            Some((port, bit)) => (port, Some(bit)),
            None => (rest.strip_suffix("()").unwrap_or(rest), None),
        },
    };
    let number = |text: &str| {
        let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if is_number { text.parse().map_err(|_| wrong()) } else { Err(wrong()) }
    };
    let place = PortSignal { kind, port: number(port)?, bit: bit.map(number).transpose()? };
    place.order(table::Command::PortGet.order()).map(|_| place)
}

/// Parses a port, a range of ports, or a name that the user assigned.
fn places(text: &str) -> Result<Series<PortSignal>, String> {
    names::parse_or_name(KINDS, "DO2", text, Series::reader(place))
}

/// Kinds of names that are allowed. User names of SI and SO can name one signal of a port.
const KINDS: &[Kind] = &[Kind::Port, Kind::Signal];

fn signal_or_port(text: &str) -> Result<PortSignal, String> {
    names::parse_or_name(KINDS, "DO2.1", text, settable)
}

fn settable(text: &str) -> Result<PortSignal, String> {
    let place = place(text)?;
    let draft = table::Command::PortSet.order().with(Key::Value, 0);
    place.order(draft).map(|_| place)
}

impl PortSignal {
    /// Builds the command from `draft` for this port.
    fn order(self, draft: Draft) -> Result<Order, String> {
        if let Some(bit) = self.bit.filter(|bit| *bit > 7) {
            return Err(format!("a port has bits 0 to 7, not {bit}"));
        }
        let order = draft.with(Key::PortType, self.kind).with(Key::Port, self.port).build();
        order.map_err(|error| match error.place.key {
            Some(Key::PortType) => format!("{} are inputs and cannot be switched", self.kind_name()),
            _ => format!("{}: {}", self.port_name(), error.problem),
        })
    }

    fn kind_name(self) -> String {
        named(table::Command::PortGet, Key::PortType, self.kind)
    }

    fn port_name(self) -> String {
        format!("{}{}", self.kind_name(), self.port)
    }

    fn describe(self) -> String {
        match self.bit {
            Some(bit) => format!("{}.{bit}", self.port_name()),
            None => self.port_name(),
        }
    }
}

/// Reads ports one after the other.
#[derive(Debug, Args)]
#[command(after_help = NAMES)]
pub struct Get {
    /// Ports or signals; DO2..DO5 is a range
    #[arg(required = true, value_name = "PORT", value_delimiter = ',', value_parser = places, add = complete::PORT)]
    places: Vec<Series<PortSignal>>,
}

impl Watchable for Get {
    type Value = Level;

    const WATCH: &'static str = "yrcx.port.watch";
    const WATCHED: Watched = Watched::ITEMS;
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Items<Level, Bits>;
    const ID: &'static str = "yrcx.port.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Items<Level, Bits>> {
        let Context { link, robot, screen, .. } = context;
        let called = names::of_robot(robot, screen);
        let places: Vec<PortSignal> = Series::all(&self.places).copied().collect();
        let order = |place: &PortSignal| place.order(link.draft(table::Command::PortGet)?).map_err(Failure::usage);
        let orders = places.iter().map(order).collect::<Result<Vec<Order>>>()?;
        let answers = ask_each(link, screen, "reading ports", &orders).await?;
        let items = places.iter().zip(answers.outcomes).map(|(place, outcome)| {
            let state = outcome.map(|values| Some(values.int(Key::Value).unwrap_or_default()));
            place.item(called, state)
        });
        let columns = Columns { name: "port", values: vec!["value", "bits 7 - 0"], empty: "no ports" };
        Items::new(columns, items.collect()).asked(answers.asked).single_failure()
    }
}

/// State of a port or a signal.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Level {
    /// State of a signal.
    Signal(bool),
    /// Value of a port, 0 to 255.
    Port(i32),
}

/// Attributes of a port.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Bits {
    /// Bits of the port, bit 7 first, for example `00000111`; null for a signal.
    bits: Option<String>,
}

impl PortSignal {
    fn item(self, names: &Names, state: Result<Option<i32>>) -> Item<Level, Bits> {
        let name = self.describe();
        let port = state.as_ref().ok().copied().flatten().filter(|_| self.bit.is_none());
        let level = |value: i32| match self.bit {
            Some(bit) => Level::Signal(value >> bit & 1 == 1),
            None => Level::Port(value),
        };
        let (kind, more) = (if self.bit.is_some() { "signal" } else { "port" }, Bits { bits: port.map(bits) });
        let label = label(names, &name);
        let cells = |level: &Level| match level {
            Level::Signal(on) => vec![i32::from(*on).into(), "-".into()],
            Level::Port(value) => vec![(*value).into(), bits(*value).into()],
        };
        Item::with(kind, name, more, state.map(|value| value.map(level))).labelled(label).with_cells(cells)
    }
}

fn bits(value: i32) -> String {
    format!("{value:08b}")
}

fn label(names: &Names, port: &str) -> Option<String> {
    let of_signal = || names::label(names, Kind::Signal, &signal_of_port(port)?);
    names::label(names, Kind::Port, port).or_else(of_signal)
}

one_row! {
    /// Switches all signals of a port, or one signal.
    #[command(after_help = NAMES)]
    Set(self) "yrcx.port.set" -> WrittenItems<Level, Bits> {
        /// Port or signal
        #[arg(value_name = "PORT", value_parser = signal_or_port, add = complete::OUTPUT_PORT)]
        place: PortSignal,
        /// New value. For a port: 0 to 255, also written as 0x07 or 0b00000111; for a signal: on or off
        #[arg(value_name = "VALUE", value_parser = value)]
        value: u8,
    }
    gives if self.place.bit.is_some() { table::Command::PortSetBit } else { table::Command::PortSet },
    with draft => {
        let PortSignal { kind, port, bit } = self.place;
        let draft = draft.with(Key::PortType, kind).with(Key::Port, port).with_some(Key::PortBit, bit);
        draft.with(Key::Value, i32::from(self.value))
    },
    done as answer => {
        let place = self.place.describe();
        let words = if self.place.bit.is_some() {
            format!("switched {place} {}", if self.value == 1 { "on" } else { "off" })
        } else {
            format!("{place} = {} ({:08b})", self.value, self.value)
        };
        let new = self.place.item(&Names::default(), Ok(Some(i32::from(self.value) << self.place.bit.unwrap_or(0))));
        let old = answer.old.value().and_then(|old| old.as_i64()).map(|old| match self.place.bit {
            Some(_) => Level::Signal(old == 1),
            None => Level::Port(i32::try_from(old).unwrap_or_default()),
        });
        WrittenItems::describe(words, vec![Written::new(new, old, true)])
    };
}

fn value(text: &str) -> Result<u8, String> {
    let wrong = || format!("'{text}' must be on, off, or a number from 0 to 255 such as 7, 0x07 or 0b00000111");
    let digits = |text: &str, radix| {
        let text = text.replace('_', "");
        let is_number = text.bytes().all(|byte| byte.is_ascii_alphanumeric());
        u8::from_str_radix(&text, radix).ok().filter(|_| is_number).ok_or_else(wrong)
    };
    match text {
        "on" => Ok(1),
        "off" => Ok(0),
        _ => match (text.strip_prefix("0x"), text.strip_prefix("0b")) {
            (Some(hex), _) => digits(hex, 16),
            (_, Some(binary)) => digits(binary, 2),
            _ => digits(text, 10),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::{place, value};
    use crate::testing::{Reply, Scripted, run_on};
    use armctl_frame::failure::Kind;

    #[test]
    fn rejects_the_answer_for_another_port() {
        let mut end = [0; 16];
        (end[0], end[2]) = (0x0200, 0x1020);
        let (outcome, _) = run_on(Scripted::new([Reply::AddressPair(1, end)]), &["port", "get", "DO12"]);
        assert_eq!(outcome.unwrap_err().kind, Kind::Malformed);
    }

    #[test]
    fn signals_have_two_spellings() {
        assert_eq!(place("DO(21)"), place("do2.1"));
        assert_eq!(place("MO(107)"), place("MO10.7"));
        assert_eq!(place("LO(0)"), place("LO0.0"));
        for wrong in
            ["", "D", "DO", "XO1", "DO8", "DO30", "DO2.8", "DO(28)", "LO2", "TO1", "DO+1", "DO()", "DO1.", "DOé"]
        {
            assert!(place(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn values_are_decimal_hexadecimal_or_binary() {
        assert_eq!([value("7"), value("0x07"), value("0b0000_0111")], [Ok(7), Ok(7), Ok(7)]);
        assert_eq!((value("on"), value("off"), value("255")), (Ok(1), Ok(0), Ok(255)));
        for wrong in ["256", "-1", "+1", "", "0x", "0b2", "maybe"] {
            assert!(value(wrong).is_err(), "{wrong}");
        }
    }
}

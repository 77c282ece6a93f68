//! `toyo io set|direct`.

use std::str::FromStr;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::link::{Link, wrong};
use super::super::numbers::{not_held, number, read_back};
use super::super::{items, refusal};
use super::{OUTPUTS, Port, label_of, listed, name, names_of, numbers, ports_of};
use crate::command::frame::names;
use crate::command::frame::orders::{Done, New, Old};
use crate::command::toyo::complete;
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::names::{Kind as NameKind, Names};
use crate::controller::toyo::field::{Field, Mask, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::controller::typed;
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Table, Tone, View};

/// Sets outputs. All bits of a port change at once; ports follow each other as they are typed.
#[derive(Debug, Args)]
#[command(
    after_help = "A whole port is eight characters for the bits 8 to 1, so that the rightmost one is bit 1: 1 is on, 0 \
                        is off, a dot leaves the bit alone. Each port is read back behind its order; only the ports \
                        that `io out` shows can be. A running program may set the same outputs."
)]
pub struct Set {
    /// Such as 1.3=on (port 1, bit 3), 1=.......1 (port 1, bits 8 to 1), or NAME=on
    #[arg(required = true, value_name = "PORT[.BIT]=VALUE", add = complete::OUTPUT_STATE)]
    assignments: Vec<Assignment>,
    /// I/O station: 0 the controller itself, 1 to 4 its slaves
    #[arg(long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u8).range(0..=4))]
    station: u8,
}

/// Orders one of the direct outputs F1 to F4.
#[derive(Debug, Args)]
#[command(
    after_help = "Parameter M12 (direct-outputs) has four bits, which are taken for those of F1 to F4: the manual does \
                        not say it in words, nor whether a bit is switched on or over. Look at `toyo io out` after it."
)]
pub struct Direct {
    /// 1 to 4
    #[arg(value_name = "1..4", value_parser = clap::value_parser!(u8).range(1..=4))]
    number: u8,
}

/// Bits of a port, and what they shall be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Assignment {
    port: u8,
    mask: Mask,
    /// Whether a name was typed: names are those of station 0.
    is_named: bool,
}

/// A port, or a bit of it, as typed.
#[derive(Debug, Clone, Copy)]
struct Spot {
    port: u8,
    bit: Option<u8>,
}

/// `1`, `PN01`, `1.3`, `OUT1.3`.
fn spot(text: &str) -> Result<Spot, String> {
    let (port, bit) = text.split_once('.').map_or((text, None), |(port, bit)| (port, Some(bit)));
    let prefix = ["PN", "pn", "OUT", "out"].into_iter().find_map(|prefix| port.strip_prefix(prefix));
    let port = u8::try_from(number(&fields()[1], prefix.unwrap_or(port))?).map_err(|error| error.to_string())?;
    let wrong = |bit: &str| format!("'{bit}' is not a valid bit; a port has the bits 1 to 8");
    let number = |bit: &str| bit.parse().ok().filter(|number| (1..=8).contains(number)).ok_or_else(|| wrong(bit));
    Ok(Spot { port, bit: bit.map(number).transpose()? })
}

/// The fields of DOUT STN=0 PN01=........
fn fields() -> &'static [Field] {
    table::Command::Dout.row().requests[0].fields
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, value) = typed::setting(text, "a port", "a value", "1.3=on")?;
        let Spot { port, bit } = names::read(&[NameKind::Output], "OUT1.1", place, spot)?;
        let mask = match bit {
            Some(bit) => one_bit(bit, value)?,
            None => match fields()[2].read(value) {
                Ok(Value::Mask(mask)) => mask,
                _ => {
                    return Err(format!(
                        "'{value}' is not a valid port: eight of 0, 1 and . are expected, for the bits 8 to 1; \
                         one bit is set by {port}.1=on"
                    ));
                }
            },
        };
        Ok(Self { port, mask, is_named: spot(place).is_err() })
    }
}

fn one_bit(number: u8, value: &str) -> Result<Mask, String> {
    let care = 1 << (number - 1);
    Ok(Mask { care, bits: if typed::state(value)? { care } else { 0 } })
}

impl Set {
    /// What each port gets, in the order of the first mention. A bit that is given twice is a mistake.
    fn orders(&self) -> Result<Vec<Assignment>, Failure> {
        let mut orders: Vec<Assignment> = Vec::new();
        for assignment in &self.assignments {
            let Some(known) = orders.iter_mut().find(|order| order.port == assignment.port) else {
                orders.push(*assignment);
                continue;
            };
            let (one, other) = (known.mask, assignment.mask);
            let twice = one.care & other.care;
            if twice != 0 {
                let message = format!("bit {} of port {} is given twice", twice.trailing_zeros() + 1, known.port);
                return Err(Failure::usage(message).hint("give each bit one state"));
            }
            known.mask = Mask { care: one.care | other.care, bits: one.bits | other.bits };
        }
        Ok(orders)
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = Outputs;
    const ID: &'static str = "toyo.io.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Outputs, Failure> {
        let station = self.station;
        if station != 0 && self.assignments.iter().any(|assignment| assignment.is_named) {
            return Err(Failure::usage("names are those of the controller's own ports, of station 0")
                .hint("type port and bit, as in 1.3=on"));
        }
        let orders = self.orders()?;
        let names = names::of(context.robot, context.screen);
        let mut outputs = Vec::with_capacity(orders.len());
        for (done, order) in orders.iter().enumerate() {
            let output = order.set(context.link, station).await;
            let output = output.map(|output| output.labelled(names, station));
            outputs.push(output.map_err(|failure| account(failure, &orders, done))?);
        }
        Ok(Outputs { station, outputs })
    }
}

impl Assignment {
    /// Sets it, and reads it back where that can be.
    async fn set(&self, link: &mut Link, station: u8) -> Result<Output, Failure> {
        let order = self.order(station)?;
        let Some(screen) = OUTPUTS.screen_of(station, self.port) else {
            link.ask(&order).await?;
            return Ok(Output::new(self, None, None));
        };
        let read = OUTPUTS.request(station, screen);
        let own = |answer: &Record| ports_of(answer).into_iter().find(|port| port.port == Some(self.port));
        let old = link.before(&read).await?.as_ref().and_then(own);
        link.ask(&order).await?;
        if link.is_dry() {
            link.plan(&read, "the port as it is then");
            return Ok(Output::new(self, None, None));
        }
        let answer = read_back(link, &order, &read).await?;
        let found = own(&answer);
        let Some(found) = found else {
            let message =
                format!("{} was accepted, but {} is not in '{}'", order.text(), name(self.port), answer.written());
            return Err(Failure::new(Kind::OutcomeUnknown, message).hint(refusal::verification_hint(order.command())));
        };
        let mut output = Output::new(self, old.as_ref(), Some(&found));
        if found.byte() & self.mask.care != self.mask.bits {
            output.ok = false;
            output.error = Some(
                not_held(&order, &format!("{} reads {}", found.name, found.raw))
                    .hint("a program that runs may set the same outputs; `toyo io out` tells how they are now"),
            );
        }
        Ok(output)
    }

    /// As it is sent.
    fn order(&self, station: u8) -> Result<Request, Failure> {
        let values = vec![Value::Number(station.into()), Value::Number(self.port.into()), Value::Mask(self.mask)];
        Request::new(table::Command::Dout, values).map_err(|error| wrong(&error))
    }
}

/// The failure of an order, with what became of the others; `done` of them were accepted.
fn account(failure: Failure, orders: &[Assignment], done: usize) -> Failure {
    if orders.len() == 1 {
        return failure;
    }
    let names = |orders: &[Assignment]| orders.iter().map(|order| name(order.port)).collect::<Vec<_>>().join(", ");
    let (before, rest) = orders.split_at(done);
    let (failed, after) = rest.split_at(1.min(rest.len()));
    let mut message = format!("{}: {}", names(failed), failure.message);
    for (words, orders) in [("set before that", before), ("not set", after)] {
        if !orders.is_empty() {
            message.push_str(&format!("; {words}: {}", names(orders)));
        }
    }
    Failure { message, ..failure }
}

impl Command for Direct {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.io.direct";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let values = vec![Value::Number(self.number.into())];
        let request = Request::in_form(table::Command::Dout, 1, values).map_err(|error| wrong(&error))?;
        context.link.ask(&request).await?;
        let words = format!("direct output F{}", self.number);
        Ok(New::of("direct_output", self.number, words).replaces(Old::UNREAD))
    }
}

/// What the controller accepted, and what it tells of it then.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Outputs {
    /// 0 is the controller itself.
    station: u8,
    outputs: Vec<Output>,
}

/// Bits of a port that were set.
#[derive(Debug, Serialize, JsonSchema)]
struct Output {
    /// Whether the port reads as it was set, or cannot be read.
    ok: bool,
    /// `PN01`.
    name: String,
    port: u8,
    /// As it was sent: bits 8 to 1, a dot for those left alone.
    requested: String,
    /// As the controller told it before; null where it was not told.
    old: Old,
    /// What `read` says.
    new: Option<String>,
    /// As the controller tells it behind the order; null for a port that it does not tell of.
    read: Option<String>,
    /// Bits that were switched on.
    on: Vec<u8>,
    /// Bits that were switched off.
    off: Vec<u8>,
    /// What people call the bits, bit 1 first; null where one has no name.
    labels: [Option<String>; 8],
    /// What is not as it was set.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Failure>,
}

impl Output {
    fn new(Assignment { port, mask, .. }: &Assignment, old: Option<&Port>, found: Option<&Port>) -> Self {
        let read = found.map(|found| found.raw.clone());
        Self {
            ok: true,
            name: name(*port),
            port: *port,
            requested: mask.to_string(),
            old: Old::read(old.map(|old| old.raw.as_str())),
            new: read.clone(),
            read,
            on: numbers(mask.bits),
            off: numbers(mask.care & !mask.bits),
            labels: Default::default(),
            error: None,
        }
    }

    /// With the names of the bits that were set.
    fn labelled(mut self, names: &Names, station: u8) -> Self {
        for bit in self.on.iter().chain(&self.off).copied().filter(|_| station == 0) {
            if let Some(label) = self.labels.get_mut(usize::from(bit) - 1) {
                *label = names::label(names, NameKind::Output, &names_of::output(self.port, bit));
            }
        }
        self
    }
}

impl Report for Outputs {
    fn view(&self) -> View {
        let mut table = Table::new(&["port", "8 to 1", "on", "off", "label", "read back"], "no ports");
        for output in &self.outputs {
            let tone = if output.ok { Tone::Plain } else { Tone::Bad };
            table.row([
                output.name.as_str().into(),
                output.requested.as_str().into(),
                listed(&output.on).into(),
                listed(&output.off).into(),
                Cell::maybe(label_of(&output.labels)),
                Cell::maybe(output.read.as_deref()).tone(tone),
            ]);
        }
        View::table(table.without_blank("label"))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure(self.outputs.len(), self.outputs.iter().map(|output| output.error.as_ref()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::toyo::testing::{Bench, Fault, all_blocks, blocks, objection};

    #[test]
    fn bits_and_whole_ports() {
        let read = "@MOUT SNO=0 GN=1";
        assert_eq!(blocks(&["io", "set", "1=.......1"]).unwrap(), ["@DOUT STN=0 PN01=.......1", read]);
        assert_eq!(blocks(&["io", "set", "1.3=on"]).unwrap(), ["@DOUT STN=0 PN01=.....1..", read]);
        assert_eq!(
            blocks(&["io", "set", "PN99.8=off", "2=10101010", "99.1=1", "--station", "4"]).unwrap(),
            ["@DOUT STN=4 PN99=0......1", "@DOUT STN=4 PN02=10101010", "@MOUT SNO=4 GN=1"],
            "no port 99 can be read"
        );
        assert_eq!(
            all_blocks(&["io", "direct", "4"]).unwrap(),
            ["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@DOUT 4", "@STAS SNO=0", "@HSOF"],
            "the host is taken and given back"
        );
    }

    #[test]
    fn mistakes_are_told_before_anything_is_sent() {
        for (words, why) in [
            (["io", "set", "1"], "as in 1.3=on"),
            (["io", "set", "1.9=on"], "bits 1 to 8"),
            (["io", "set", "1.0=on"], "bits 1 to 8"),
            (["io", "set", "1.1=yes"], "on and off"),
            (["io", "set", "100=........"], "1 to 99"),
            (["io", "set", "1=.1"], "eight of 0, 1 and ."),
            (["io", "set", "1=on"], "1.1=on"),
            (["io", "direct", "5"], "1..=4"),
        ] {
            assert!(objection(&words).contains(why), "{words:?}: {}", objection(&words));
        }
        let twice = blocks(&["io", "set", "1.3=on", "1=00000000"]).unwrap_err();
        assert_eq!(twice.message, "bit 3 of port 1 is given twice");
    }

    #[test]
    fn a_failure_tells_what_became_of_each_port() {
        let orders: Vec<Assignment> = ["1=......01", "2.1=on", "3.1=on"].map(|text| text.parse().unwrap()).into();
        let message = |orders: &[Assignment], done| account(Failure::local("no"), orders, done).message;
        assert_eq!(message(&orders[..1], 0), "no");
        assert_eq!(message(&orders, 1), "PN02: no; set before that: PN01; not set: PN03");
        let output = Output::new(&orders[0], None, None);
        assert_eq!((output.on, output.off), (vec![1], vec![2]));
    }

    #[test]
    fn what_was_set_is_read_back() {
        let set = Bench::new("sim:").data(&["io", "set", "1.3=on", "18.1=on"]);
        let outputs = &set["outputs"];
        assert_eq!((&outputs[0]["requested"], &outputs[0]["read"]), (&".....1..".into(), &"00000100".into()), "{set}");
        assert_eq!((&outputs[1]["ok"], &outputs[1]["read"]), (&true.into(), &"00000001".into()), "{set}");
        // A bit that was left alone may be anything.
        let odd = |block: &str, _| match block {
            "@MOUT SNO=0 GN=1" => {
                Fault::Answered("@MOUT SNO=0 GN=1 SY01=00000000 PN01=10000000 PN02=10000001 PN03=00000000")
            }
            _ => Fault::None,
        };
        let (set, failure) = Bench::with_faults("", odd).0.run(&["io", "set", "1.3=on"]).unwrap();
        let output = &set["outputs"][0];
        assert_eq!((&output["ok"], &output["read"]), (&false.into(), &"10000000".into()), "{set}");
        let failure = failure.unwrap();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(failure.message, "the controller accepted @DOUT STN=0 PN01=.....1.., but PN01 reads 10000000");
        let (set, failure) = Bench::with_faults("", odd).0.run(&["io", "set", "1.3=on", "2.1=on"]).unwrap();
        assert_eq!((&set["outputs"][1]["ok"], failure.unwrap().kind), (&true.into(), Kind::Mixed));
        let silent =
            |block: &str, count| if block.starts_with("@MOUT") && count > 1 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults("", silent).0.run(&["io", "set", "1.3=on", "2.1=on"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert!(failure.message.contains("DOUT STN=0 PN01=.....1.. was accepted, but not read back"), "{failure}");
        assert!(failure.message.ends_with("; not set: PN02"), "{failure}");
    }
}

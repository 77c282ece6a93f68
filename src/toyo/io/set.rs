//! `toyo io set|direct`.

use std::str::FromStr;

use super::super::number_arguments::{number, read_back, read_back_mismatch};
use super::super::refusal;
use super::Station;
use super::port::{OUTPUTS, Signal, name, ports_of};
use crate::prelude::*;
use armctl_controller::names::{Kind as NameKind, Names};
use armctl_controller::toyo::field::{Field, Mask};
use armctl_frame::robot::io::{IoValue, WrittenSignal, WrittenSignals};

/// Set outputs. All bits of a port change at once; ports change in the typed order.
#[derive(Debug, Args)]
#[command(
    after_help = "A whole port is eight characters for bits 8 to 1; the rightmost character is bit 1. 1 is on, 0 is \
                  off, and a dot keeps the bit. armctl reads back each port that `io list` shows. A running program \
                  can set the same outputs."
)]
pub struct Set {
    /// Outputs with states, for example OUT1.3=on (port 1, bit 3), OUT1=.......1 (port 1, bits 8 to 1), or NAME=on
    #[arg(required = true, value_name = "PORT[.BIT]=VALUE", add = complete::OUTPUT_STATE)]
    assignments: Vec<Assignment>,
    #[command(flatten)]
    station: Station,
}

/// Switch one of the direct outputs F1 to F4.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl uses the four bits of parameter M12 (direct-outputs) for F1 to F4. The manual does not describe the \
                        bits, or whether a bit is set or toggled. Check the result with `toyo io list --out`."
)]
pub struct Direct {
    /// Number of the output, 1 to 4
    #[arg(value_name = "1..4", value_parser = clap::value_parser!(u8).range(1..=4))]
    number: u8,
}

/// Bits of a port with their new states.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Assignment {
    port: u8,
    mask: Mask,
    /// Whether the user typed a name. Names apply only to station 0.
    is_named: bool,
}

/// A port or a bit of a port, as typed.
#[derive(Debug, Clone, Copy)]
struct Target {
    port: u8,
    bit: Option<u8>,
}

/// Parses `OUT1.3`, `OUT1`; also `PN01`, `1.3` and `1`.
fn place_of(text: &str) -> Result<Target, String> {
    let (port, bit) = text.split_once('.').map_or((text, None), |(port, bit)| (port, Some(bit)));
    let prefix = ["PN", "pn", "OUT", "out"].into_iter().find_map(|prefix| port.strip_prefix(prefix));
    let port = u8::try_from(number(&fields()[1], prefix.unwrap_or(port))?).map_err(|error| error.to_string())?;
    let wrong = |bit: &str| format!("'{bit}' is not a valid bit; a port has the bits 1 to 8");
    let number = |bit: &str| bit.parse().ok().filter(|number| (1..=8).contains(number)).ok_or_else(|| wrong(bit));
    Ok(Target { port, bit: bit.map(number).transpose()? })
}

/// Fields of DOUT STN=0 PN01=........
fn fields() -> &'static [Field] {
    table::Command::Dout.row().requests[0].fields
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, value) = user_input::split_setting(text, "a port", "a value", "OUT1.3=on")?;
        let Target { port, bit } = names::parse_or_name(&[NameKind::Output], "OUT1.1", place, place_of)?;
        let mask = match bit {
            Some(bit) => one_bit(bit, value)?,
            None => match fields()[2].read(value) {
                Ok(Value::Mask(mask)) => mask,
                _ => {
                    return Err(format!(
                        "'{value}' is not a valid port value: type eight characters (0, 1 or a dot) for bits 8 to 1; \
                         for a single bit, type OUT{port}.1=on"
                    ));
                }
            },
        };
        Ok(Self { port, mask, is_named: place_of(place).is_err() })
    }
}

fn one_bit(number: u8, value: &str) -> Result<Mask, String> {
    let care = 1 << (number - 1);
    Ok(Mask { care, bits: if user_input::state(value)? { care } else { 0 } })
}

impl Set {
    /// One assignment for each port, in the order in which the ports first occur. It is an error if a bit occurs twice.
    fn orders(&self) -> Result<Vec<Assignment>> {
        let mut orders: Vec<Assignment> = Vec::new();
        for assignment in &self.assignments {
            let Some(first_order) = orders.iter_mut().find(|order| order.port == assignment.port) else {
                orders.push(*assignment);
                continue;
            };
            let (first, added) = (first_order.mask, assignment.mask);
            let twice = first.care & added.care;
            if twice != 0 {
                let message = format!("bit {} of port {} appears twice", twice.trailing_zeros() + 1, first_order.port);
                return Err(Failure::usage(message).hint("type one state for each bit"));
            }
            first_order.mask = Mask { care: first.care | added.care, bits: first.bits | added.bits };
        }
        Ok(orders)
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = WrittenSignals;
    const ID: &'static str = "toyo.io.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<WrittenSignals> {
        let Station { station } = self.station;
        if station != 0 && self.assignments.iter().any(|assignment| assignment.is_named) {
            return Err(Failure::usage("names belong to ports of station 0, the controller itself")
                .hint("type the port and the bit, such as OUT1.3=on"));
        }
        let orders = self.orders()?;
        let names = names::of_robot(context.robot, context.screen);
        let mut written = Vec::new();
        for (done, order) in orders.iter().enumerate() {
            let port =
                order.set(context.link, station).await.map_err(|failure| with_results(failure, &orders, done))?;
            written.extend(order.bits().map(|signal| port.of(signal, order, station, names)));
        }
        Ok(WrittenSignals::new(written))
    }
}

/// A port before and after a command; `None` if it was not read.
struct PortChange {
    old: Option<u8>,
    now: Option<u8>,
    /// Failure, if the bits differ from the command.
    failure: Option<Failure>,
}

impl PortChange {
    const UNREAD: Self = Self { old: None, now: None, failure: None };

    fn of(&self, signal: Signal, order: &Assignment, station: u8, names: &Names) -> WrittenSignal {
        let state = |byte: u8| IoValue::State(signal.is_on(byte));
        let new = state(order.mask.bits);
        let written = WrittenSignal::new(signal.item(station, names), self.old.map(state), new);
        match (self.now.map(state), &self.failure) {
            (Some(now), Some(failure)) if now != new => written.with_error(now, failure.clone()),
            _ => written,
        }
    }
}

impl Assignment {
    /// Returns the signals that the assignment sets.
    fn bits(&self) -> impl Iterator<Item = Signal> {
        let Self { port, mask, .. } = *self;
        let signals = (1..=8).map(move |bit| Signal { bank: OUTPUTS, port, bit });
        signals.filter(move |signal| signal.is_on(mask.care))
    }

    /// Sets the port. Reads it back, if this is possible.
    async fn set(&self, link: &mut Link, station: u8) -> Result<PortChange> {
        let order = self.order(station)?;
        let Some(screen) = OUTPUTS.screen_of(station, self.port) else {
            link.ask(&order).await?;
            return Ok(PortChange::UNREAD);
        };
        let read = OUTPUTS.request(station, screen);
        let own = |answer: &Record| ports_of(answer).into_iter().find(|port| port.number == self.port);
        let old = link.before(&read).await?.as_ref().and_then(own).map(|port| port.byte);
        link.ask(&order).await?;
        if link.is_dry_run() {
            link.plan(&read, "the port after the change");
            return Ok(PortChange::UNREAD);
        }
        let answer = read_back(link, &order, &read).await?;
        let Some(written) = own(&answer) else {
            let message = format!(
                "the controller accepted {}, but {} is not in its answer '{}'",
                order.text(),
                name(self.port),
                answer.written()
            );
            return Err(Failure::new(Kind::OutcomeUnknown, message).hint(refusal::verification_hint(order.command())));
        };
        let reads = format!("{} reads {:08b}", written.name, written.byte);
        let failure = read_back_mismatch(&order, &reads)
            .hint("use `toyo io list --out` to see the outputs; a running program can set the same outputs");
        Ok(PortChange { old, now: Some(written.byte), failure: Some(failure) })
    }

    /// Request that sets the port.
    fn order(&self, station: u8) -> Result<Request> {
        let values = vec![Value::Number(station.into()), Value::Number(self.port.into()), Value::Mask(self.mask)];
        Request::new(table::Command::Dout, values).map_err(|error| wrong(&error))
    }
}

/// Failure of a command, with the results of the other commands. The controller accepted `done` of them.
fn with_results(failure: Failure, orders: &[Assignment], done: usize) -> Failure {
    if orders.len() == 1 {
        return failure;
    }
    let names = |orders: &[Assignment]| orders.iter().map(|order| name(order.port)).collect::<Vec<_>>().join(", ");
    let (done_orders, rest) = orders.split_at(done);
    let (failed, after) = rest.split_at(1.min(rest.len()));
    let mut message = format!("{}: {}", names(failed), failure.message);
    for (words, orders) in [("set before that", done_orders), ("not set", after)] {
        if !orders.is_empty() {
            message.push_str(&format!("; {words}: {}", names(orders)));
        }
    }
    Failure { message, ..failure }
}

impl Command for Direct {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.io.direct";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let values = vec![Value::Number(self.number.into())];
        let request = Request::in_form(table::Command::Dout, 1, values).map_err(|error| wrong(&error))?;
        context.link.ask(&request).await?;
        let words = format!("direct output F{}", self.number);
        Ok(NewValue::of("direct_output", self.number, words).replaces(Old::UNREAD))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::testing::{Bench, Fault};

    #[test]
    fn a_failure_reports_the_result_of_each_port() {
        let orders: Vec<Assignment> = ["1=......01", "2.1=on", "3.1=on"].map(|text| text.parse().unwrap()).into();
        let message = |orders: &[Assignment], done| with_results(Failure::local("no"), orders, done).message;
        assert_eq!(message(&orders[..1], 0), "no");
        assert_eq!(message(&orders, 1), "PN02: no; set before that: PN01; not set: PN03");
        let bits: Vec<u8> = orders[0].bits().map(|signal| signal.bit).collect();
        assert_eq!(bits, [1, 2]);
    }

    #[test]
    fn set_outputs_are_read_back() {
        let set = Bench::new("sim:").data(&["io", "set", "OUT1.3=on", "18.1=on"]);
        let keys = |item: &Value| [item["name"].clone(), item["old"].clone(), item["value"].clone()];
        assert_eq!(keys(&set["items"][0]), [Value::from("OUT1.3"), false.into(), true.into()], "{set}");
        assert_eq!(keys(&set["items"][1]), [Value::from("OUT18.1"), false.into(), true.into()], "{set}");
        // The command does not set a bit that is marked with a dot, so the bit can have any state.
        let odd = |block: &str, _| match block {
            "@MOUT SNO=0 GN=1" => {
                Fault::Answered("@MOUT SNO=0 GN=1 SY01=00000000 PN01=10000000 PN02=10000001 PN03=00000000")
            }
            _ => Fault::None,
        };
        let (set, failure) = Bench::with_faults("", odd).0.run(&["io", "set", "1.3=on"]).unwrap();
        let item = &set["items"][0];
        assert_eq!((&item["ok"], &item["value"], &item["new"]), (&false.into(), &false.into(), &true.into()), "{set}");
        let failure = failure.unwrap();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(
            failure.message,
            "OUT1.3: the controller accepted @DOUT STN=0 PN01=.....1.., but PN01 reads 10000000"
        );
        let (set, failure) = Bench::with_faults("", odd).0.run(&["io", "set", "1.3=on", "2.1=on"]).unwrap();
        assert_eq!((&set["items"][1]["ok"], failure.unwrap().kind), (&true.into(), Kind::Mixed));
        let silent =
            |block: &str, count| if block.starts_with("@MOUT") && count > 1 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults("", silent).0.run(&["io", "set", "1.3=on", "2.1=on"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert!(
            failure.message.contains("DOUT STN=0 PN01=.....1.., but the value could not be read back"),
            "{failure}"
        );
        assert!(failure.message.ends_with("; not set: PN02"), "{failure}");
    }
}

//! `toyo io set|direct`.

use std::str::FromStr;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::Family;
use super::super::link::wrong;
use super::super::numbers::number;
use super::{listed, name, numbers};
use crate::command::orders::Done;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::field::{Field, Mask, Value};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::controller::typed;
use crate::failure::Failure;
use crate::output::view::{Table, View};

/// Sets outputs. All bits of a port change at once; ports follow each other as they are typed.
#[derive(Debug, Args)]
#[command(
    after_help = "A whole port is eight characters for the bits 8 to 1, so that the rightmost one is bit 1: 1 is on, 0 \
                        is off, a dot leaves the bit alone. A running program may set the same outputs."
)]
pub struct Set {
    /// Such as 1.3=on (port 1, bit 3) or 1=.......1 (port 1, bits 8 to 1)
    #[arg(required = true, value_name = "PORT[.BIT]=VALUE")]
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
}

/// The fields of DOUT STN=0 PN01=........
fn fields() -> &'static [Field] {
    table::Command::Dout.row().requests[0].fields
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (place, value) = typed::setting(text, "a port", "a value", "1.3=on")?;
        let (port, bit) = place.split_once('.').map_or((place, None), |(port, bit)| (port, Some(bit)));
        let digits = port.strip_prefix("PN").or_else(|| port.strip_prefix("pn")).unwrap_or(port);
        let port = u8::try_from(number(&fields()[1], digits)?).map_err(|error| error.to_string())?;
        let mask = match bit {
            Some(bit) => one_bit(bit, value)?,
            None => match fields()[2].read(value) {
                Ok(Value::Mask(mask)) => mask,
                _ => {
                    return Err(format!(
                        "'{value}' is no port: eight of 0, 1 and . are expected, for the bits 8 to 1; \
                         one bit is set by {port}.1=on"
                    ));
                }
            },
        };
        Ok(Self { port, mask })
    }
}

fn one_bit(bit: &str, value: &str) -> Result<Mask, String> {
    let number = bit.parse().ok().filter(|number| (1..=8).contains(number));
    let number: u8 = number.ok_or_else(|| format!("'{bit}' is no bit; a port has the bits 1 to 8"))?;
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
    type Family = Family;
    type Report = Outputs;
    const ID: &'static str = "toyo.io.set";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Outputs, Failure> {
        let station = self.station;
        let orders = self.orders()?;
        for (done, Assignment { port, mask }) in orders.iter().enumerate() {
            let values = vec![Value::Number(station.into()), Value::Number((*port).into()), Value::Mask(*mask)];
            let request = Request::new(table::Command::Dout, values).map_err(|error| wrong(&error))?;
            let ordered = context.link.order(&request).await;
            ordered.map_err(|failure| account(failure, &orders, done))?;
        }
        Ok(Outputs { station, outputs: orders.iter().map(Output::from).collect() })
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
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "toyo.io.direct";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        let values = vec![Value::Number(self.number.into())];
        let request = Request::in_form(table::Command::Dout, 1, values).map_err(|error| wrong(&error))?;
        context.link.order(&request).await?;
        Ok(Done::new(format!("direct output F{}", self.number)))
    }
}

/// What the controller accepted.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Outputs {
    /// 0 is the controller itself.
    station: u8,
    outputs: Vec<Output>,
}

/// Bits of a port that were set.
#[derive(Debug, Serialize, JsonSchema)]
struct Output {
    /// `PN01`.
    name: String,
    port: u8,
    /// As it was sent: bits 8 to 1, a dot for those left alone.
    raw: String,
    /// Bits that were switched on.
    on: Vec<u8>,
    /// Bits that were switched off.
    off: Vec<u8>,
}

impl From<&Assignment> for Output {
    fn from(Assignment { port, mask }: &Assignment) -> Self {
        let off = numbers(mask.care & !mask.bits);
        Self { name: name(*port), port: *port, raw: mask.to_string(), on: numbers(mask.bits), off }
    }
}

impl Report for Outputs {
    fn view(&self) -> View {
        let mut table = Table::new(&["port", "8 to 1", "on", "off"], "no ports");
        for output in &self.outputs {
            let Output { name, raw, on, off, .. } = output;
            table.row([name.as_str().into(), raw.as_str().into(), listed(on).into(), listed(off).into()]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::toyo::testing::{all_blocks, blocks, objection};

    #[test]
    fn bits_and_whole_ports() {
        assert_eq!(blocks(&["io", "set", "1=.......1"]).unwrap(), ["@DOUT STN=0 PN01=.......1"]);
        assert_eq!(blocks(&["io", "set", "1.3=on"]).unwrap(), ["@DOUT STN=0 PN01=.....1.."]);
        assert_eq!(
            blocks(&["io", "set", "PN99.8=off", "2=10101010", "99.1=1", "--station", "4"]).unwrap(),
            ["@DOUT STN=4 PN99=0......1", "@DOUT STN=4 PN02=10101010"]
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
        let output = Output::from(&orders[0]);
        assert_eq!((output.on, output.off), (vec![1], vec![2]));
    }
}

//! `yerc register`: 16-bit words that the ladder program and a PC can both use.

use std::collections::HashSet;
use std::str::FromStr;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::batch_split::{BatchSplit, read_in_batches};
use super::complete;
use super::link::Yerc;
use super::switch_commands::usage;
use super::write_all::{WriteOrder, old_value, write_all};
use crate::command::frame::items;
use crate::command::frame::names;
use crate::command::frame::watch::{Watch, Watchable, Watched};
use crate::command::robot::item::{Columns, Item, Items, Written, WrittenItems};
use crate::command::{Command, Context, commands};
use crate::controller::Risk;
use crate::controller::names::{Kind, Names};
use crate::controller::typed;
use crate::controller::yerc::names::{register, register_address};
use crate::controller::yerc::variables::{WriteRegisterStep, parse_numbers, plan_register_reads, plan_register_writes};
use crate::failure::Failure;

commands! {
    /// Commands for registers.
    pub enum Register {
        /// Read registers: 0 to 999
        Get(Get),
        /// Write registers: 0 to 559
        Set(Set),
        /// Print each change of registers
        Watch(Watch<Get>),
    }
}

/// Reads registers.
#[derive(Debug, Args)]
pub struct Get {
    /// Registers, such as 5, M5 or 0..20, or a name
    #[arg(required = true, value_name = "N", value_delimiter = ',', value_parser = Numbers::parse, add = complete::REGISTER)]
    registers: Vec<Numbers>,
}

#[derive(Debug, Clone)]
struct Numbers(Vec<u16>);

impl Numbers {
    fn parse(text: &str) -> Result<Self, String> {
        numbers(text).map(Self)
    }
}

/// Parses register numbers: `5`, `M5`, `0..20`, or a name.
fn numbers(text: &str) -> Result<Vec<u16>, String> {
    names::parse_or_name(&[Kind::Register], "0", text, |text| match register(text) {
        Some(number) => Ok(vec![number]),
        None => parse_numbers(text).map_err(|error| error.to_string()),
    })
}

/// Writes registers.
#[derive(Debug, Args)]
#[command(
    after_help = "The ladder program can overwrite a register immediately after the write. To be sure, read the \
                  register back."
)]
pub struct Set {
    /// 5=1000 or 5=0x03E8, or NAME=1000
    #[arg(required = true, value_name = "N=VALUE", add = complete::REGISTER_VALUE)]
    assignments: Vec<Assignment>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Assignment {
    number: u16,
    value: u16,
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (number, value) = typed::setting(text, "a number", "a value", "5=1000")?;
        let numbers = numbers(number)?;
        let [number] = numbers[..] else {
            return Err(format!("'{number}' is a range; type a value for each register"));
        };
        let value = typed::unsigned(value)
            .ok_or_else(|| format!("'{value}' is not a number from 0 to 65535 (0x0000 to 0xFFFF)"))?;
        Ok(Self { number, value })
    }
}

impl Command for Get {
    type Family = Yerc;
    type Report = Items<u16, Word>;
    const ID: &'static str = "yerc.register.get";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Items<u16, Word>, Failure> {
        let numbers = typed::once(self.registers.iter().flat_map(|numbers| numbers.0.iter().copied()));
        let Context { link, robot, screen, .. } = context;
        let names = names::of_robot(robot, screen);
        let model = link.model_for(|model| plan_register_reads(model, &numbers)).await?;
        let plan = |numbers: &[u16]| plan_register_reads(model, numbers).map_err(usage);
        let mut outcomes = read_in_batches(link, plan, &numbers, |_| BatchSplit::Halves, |_, _| {}).await?;
        let words = numbers.into_iter().filter_map(|number| {
            let outcome = outcomes.remove(&number)?;
            Some(item(number, names, outcome.map_err(Failure::from)))
        });
        let report = Items::new(columns(), words.collect());
        items::all_failed(report.items.len(), report.errors())?;
        Ok(report)
    }
}

impl Watchable for Get {
    const WATCH: &'static str = "yerc.register.watch";
    const WATCHED: Watched = Watched::ITEMS;
}

impl Command for Set {
    type Family = Yerc;
    type Report = WrittenItems<u16, Word>;
    const ID: &'static str = "yerc.register.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<WrittenItems<u16, Word>, Failure> {
        let Context { link, robot, screen, .. } = context;
        let names = names::of_robot(robot, screen);
        let mut seen_numbers = HashSet::new();
        if let Some(twice) = self.assignments.iter().find(|assignment| !seen_numbers.insert(assignment.number)) {
            return Err(Failure::usage(format!("register {} appears twice", twice.number))
                .hint("type one value for the register"));
        }
        let values: Vec<(u16, u16)> = self.assignments.iter().map(|it| (it.number, it.value)).collect();
        let steps = link.by_model(|model| plan_register_writes(model, &values)).await?;
        let numbers: Vec<u16> = values.iter().map(|(number, _)| *number).collect();
        let reads = link.by_model(|model| plan_register_reads(model, &numbers)).await?;
        let old = old_value(link, &reads).await?;
        write_all(link, screen, &steps).await?;
        let written = values
            .into_iter()
            .map(|(number, value)| Written::new(item(number, names, Ok(value)), old.get(&number).copied(), true));
        Ok(WrittenItems::new(columns(), written.collect()))
    }
}

impl WriteOrder for WriteRegisterStep {
    type Item = u16;

    fn items(&self) -> Vec<u16> {
        self.written().to_vec()
    }

    fn listed(items: Vec<u16>) -> String {
        format!("register {}", typed::runs(&items, ".."))
    }
}

/// Family-specific fields of a register.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Word {
    number: u16,
    /// Value in hexadecimal, such as `0x03e8`; null if the register was not read.
    value_hex: Option<String>,
}

fn item(number: u16, names: &Names, value: Result<u16, Failure>) -> Item<u16, Word> {
    let hex = |value: u16| format!("{value:#06x}");
    let name = register_address(number);
    let (label, more) =
        (names::label(names, Kind::Register, &name), Word { number, value_hex: value.as_ref().ok().copied().map(hex) });
    Item::with("register", name, more, value.map(Some))
        .labelled(label)
        .with_cells(|value| vec![(*value).into(), hex(*value).into()])
}

fn columns() -> Columns {
    Columns { name: "register", values: vec!["value", "hex"], empty: "no registers" }
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;
    use crate::command::yerc::testing::Bench;

    #[test]
    fn parses_values_in_decimal_and_hexadecimal() {
        assert_eq!("10=0x1234".parse(), Ok(Assignment { number: 10, value: 0x1234 }));
        assert_eq!("559=65535".parse(), Ok(Assignment { number: 559, value: 65535 }));
        for wrong in ["5", "5=", "5=0x", "5=-1", "5=65536", "5=0x10000", "5=1_0", "5=+1", "-1=0", "1..2=0", "=1"] {
            assert!(wrong.parse::<Assignment>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn reads_many_registers() {
        let mut bench = Bench::new("sim:");
        bench.data(&["register", "set", "5=0xFFFF", "6=1"]);
        let data = bench.data(&["register", "get", "6", "5..6"]);
        let numbers: Vec<&Value> = data["items"].as_array().unwrap().iter().map(|word| &word["value"]).collect();
        assert_eq!(numbers, [&Value::from(1), &Value::from(0xFFFF)]);
    }
}

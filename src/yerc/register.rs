//! `yerc register`: 16-bit words that the ladder program and a PC can both use.

use std::collections::HashSet;
use std::str::FromStr;

use super::batch_split::{BatchSplit, read_in_batches};
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::yerc::names::{register, register_address};
use armctl_controller::yerc::query::Query as _;
use armctl_controller::yerc::variables::{parse_numbers, plan_register_reads, plan_register_writes};
use armctl_frame::failure::Kind as FailureKind;
use armctl_frame::settings_report::{IF_DIFFERENT, OLD_VALUE};
use armctl_frame::store::{Copy, Dump, Get, List, Restore, Row, TableWrite, WrittenOf, write};

commands! {
    /// Commands for registers.
    pub enum Register {
        /// Read registers 0 to 999
        Get(Get<Registers>),
        /// Write registers 0 to 559
        Set(Set),
        /// List the registers that are not 0
        List(List<Registers>),
        /// Print each change of registers
        Watch(Watch<Get<Registers>>),
        /// Copy a register to other registers, for example `5 6..8`
        Copy(Copy<Registers>),
        /// Save registers to a CSV file
        Dump(Dump<Registers>),
        /// Write registers from a CSV file
        Restore(Restore<Registers>),
    }
}

/// Writes registers.
#[derive(Debug, Args)]
#[command(after_help = WRITING)]
pub struct Set {
    /// Registers with their new values, for example 5=1000, 5=0x03E8 or NAME=1000
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
        let (number, value) = user_input::split_setting(text, "a number", "a value", "5=1000")?;
        let numbers = names::parse_or_name(&[Kind::Register], &Registers::any(), number, Registers::keys)?;
        let [number] = numbers[..] else {
            return Err(format!("'{number}' is a range; type a value for each register"));
        };
        Ok(Self { number, value: parse_word(value)? })
    }
}

fn parse_word(text: &str) -> Result<u16, String> {
    user_input::unsigned(text).ok_or_else(|| format!("'{text}' is not a number from 0 to 65535 (0x0000 to 0xFFFF)"))
}

impl Command for Set {
    type Family = Yerc;
    type Report = WrittenOf<Registers>;
    const ID: &'static str = Registers::IDS.set;
    const RISK: Risk = Registers::RISK;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<WrittenOf<Registers>> {
        let Context { link, screen, robot, confirmer, .. } = context;
        let mut seen_numbers = HashSet::new();
        if let Some(twice) = self.assignments.iter().find(|assignment| !seen_numbers.insert(assignment.number)) {
            return Err(Failure::usage(format!("register {} appears twice", twice.number))
                .hint("type one value for the register"));
        }
        let numbers: Vec<u16> = self.assignments.iter().map(|it| it.number).collect();
        let mut table = Registers::open(link, &Single {}).await?;
        table.prepare(link, &numbers).await?;
        let values: Vec<(u16, u16)> = self.assignments.iter().map(|it| (it.number, it.value)).collect();
        link.by_model(|model| plan_register_writes(model, &values)).await?;
        let rows = values.into_iter().map(|(number, value)| (number, Some(value))).collect();
        write(TableWrite { table, robot, link, screen, confirmer }, rows).await?.or_only_failure()
    }
}

/// The registers of a controller.
#[derive(Debug)]
pub struct Registers {
    /// Model, once it is known; needed only if the models have different registers.
    model: Model,
}

/// Family-specific fields of a register.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Word {
    number: u16,
    /// Value in hexadecimal, such as `0x03e8`; null if the register was not read.
    value_hex: Option<String>,
}

const WRITING: &str = "armctl does not write a register that already has the value. The ladder program can overwrite \
                       a register immediately after the write. If that matters, read the register again.";
/// Last register (DX200 manual, 3.3.10).
const LAST: u16 = 999;

fn hex(value: u16) -> String {
    format!("{value:#06x}")
}

impl Store for Registers {
    type Family = Yerc;
    type Key = u16;
    type Wire = u16;
    type Value = u16;
    type More = Word;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["register", "registers"],
        placeholder: "N",
        range: "Registers, such as 5, M5 or 0..20, or a name",
        reading: None,
        writing: Some(WRITING),
    };
    const IDS: Ids = ids!("yerc.register");
    const LABELS: Option<Kind> = Some(Kind::Register);
    const COMPLETE: ValueKind = complete::REGISTER;

    fn keys(text: &str) -> Result<Vec<u16>, String> {
        match register(text) {
            Some(number) => Ok(vec![number]),
            None => parse_numbers(text).map_err(|error| error.to_string()),
        }
    }

    fn all() -> Vec<u16> {
        (0..=LAST).collect()
    }

    /// Registers that `restore` can write.
    fn saved() -> Vec<u16> {
        Self::all().into_iter().filter(|number| plan_register_writes(Model::Dx200, &[(*number, 0)]).is_ok()).collect()
    }

    fn name(number: u16) -> String {
        register_address(number)
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self { model: Model::Dx200 })
    }

    async fn prepare(&mut self, link: &mut Link, numbers: &[u16]) -> Result<()> {
        self.model = link.model_for(|model| plan_register_reads(model, numbers)).await?;
        Ok(())
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::number("value", "value")]
    }

    fn texts(&self, value: &u16) -> Vec<String> {
        vec![value.to_string()]
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["value", "hex"]
    }

    fn cells(&self, _number: u16, value: &u16) -> Vec<Cell> {
        vec![(*value).into(), hex(*value).into()]
    }

    fn value(&self, value: &u16) -> Option<u16> {
        Some(*value)
    }

    fn more(&self, number: u16, value: Option<&u16>) -> Word {
        Word { number, value_hex: value.copied().map(hex) }
    }

    fn is_blank(&self, value: &u16) -> bool {
        *value == 0
    }

    async fn read(&self, link: &mut Link, _screen: &Screen, numbers: &[u16]) -> Result<Answers<u16>> {
        let plan = |numbers: &[u16]| plan_register_reads(self.model, numbers).map_err(usage);
        let answers = read_in_batches(link, plan, numbers, |_| BatchSplit::Halves, |_, _| {}).await?;
        let row = |number: &u16| match answers.get(number) {
            Some(Ok(value)) => Ok(*value),
            Some(Err(denied)) => Err(read_failure(denied.clone())),
            None => Err(Failure::new(FailureKind::Malformed, "the answer does not have this register")),
        };
        Ok(Answers::of(numbers.iter().map(row).collect()))
    }
}

impl Writable for Registers {
    /// New value; `None` in the dry run of a copy, in which the value is unknown.
    type Draft = Option<u16>;

    const RISK: Risk = Risk::Write;

    fn draft(&self, number: u16, texts: &[Option<&str>]) -> Result<Option<u16>, String> {
        plan_register_writes(self.model, &[(number, 0)]).map_err(|error| error.to_string())?;
        texts.first().copied().flatten().map(parse_word).transpose()
    }

    fn complete_draft(&self, number: u16, draft: &Option<u16>, _old: Option<&u16>) -> Result<u16> {
        let missing = || Failure::usage(format!("{}: the value is missing", Self::name(number)));
        draft.ok_or_else(|| missing().hint("write a number from 0 to 65535 in column `value`"))
    }

    async fn read_old(&self, link: &mut Link, screen: &Screen, rows: &[Row<Self>]) -> Result<Answers<u16>> {
        let numbers: Vec<u16> = rows.iter().map(|(number, _)| *number).collect();
        self.read(link.for_purpose(OLD_VALUE), screen, &numbers).await
    }

    /// Consecutive registers are written with one request.
    fn blocks(&self, rows: &[RowDifference<'_, Self>]) -> Vec<Vec<usize>> {
        let values: Vec<(u16, u16)> = rows.iter().map(|(number, _, new)| (*number, **new)).collect();
        let index_of = |number: &u16| rows.iter().position(|(key, ..)| key == number);
        match plan_register_writes(self.model, &values) {
            Ok(steps) => steps.iter().map(|step| step.written().iter().filter_map(index_of).collect()).collect(),
            Err(_) => (0..rows.len()).map(|index| vec![index]).collect(),
        }
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        let values = |unknown: u16| rows.iter().map(move |(number, value)| (*number, value.unwrap_or(unknown)));
        let steps = |unknown| plan_register_writes(self.model, &values(unknown).collect::<Vec<_>>()).map_err(usage);
        for (step, other) in steps(0)?.iter().zip(steps(u16::MAX)?) {
            let about = format!("writes register {}", user_input::format_ranges(step.written(), ".."));
            let reason = Reason::about(&about).depending_on(IF_DIFFERENT);
            link.plan_depending(&step.request(), &other.request(), reason);
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        let values: Vec<(u16, u16)> = rows.iter().map(|(number, _, new)| (*number, **new)).collect();
        for step in plan_register_writes(self.model, &values).map_err(usage)? {
            link.ask(&step).await?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::testing::Bench;

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
        let listed = bench.data(&["register", "list"]);
        let names: Vec<&Value> = listed["items"].as_array().unwrap().iter().map(|word| &word["name"]).collect();
        assert_eq!(names, ["M5", "M6"]);
    }

    #[test]
    fn dump_restores_the_registers_that_can_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("registers.csv").to_str().unwrap().to_owned();
        let mut bench = Bench::new("sim:");
        bench.data(&["register", "set", "5=0xFFFF", "559=1"]);
        bench.data(&["register", "copy", "5", "7..8"]);
        assert_eq!(bench.data(&["register", "dump", &file])["saved"], 4);
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "name,value\nM5,65535\nM7,65535\nM8,65535\nM559,1\n");
        let mut other = Bench::new("sim:");
        other.data(&["register", "set", "7=0xFFFF"]);
        let items = other.data(&["register", "restore", &file])["items"].clone();
        let written: Vec<&Value> = items.as_array().unwrap().iter().map(|item| &item["written"]).collect();
        assert_eq!(written, [true, false, true, true]);
        let failure = other.run(&["register", "copy", "5", "560"]).unwrap_err();
        assert!(failure.message.contains("0-559"), "{failure}");
    }
}

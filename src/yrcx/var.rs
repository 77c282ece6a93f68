//! `yrcx var` (4.4.1): static variables.

use serde_json::{Number, Value as Json};

use super::link;
use super::number_arguments::{named, single};
use super::numbered_tables::{Kind, Numbered};
use super::single_command::{SingleCommand, single_command};
use crate::prelude::*;
use armctl_controller::names;
use armctl_controller::yrcx::value::Value;
use armctl_frame::names as labels;
use armctl_frame::robot::item::{Item, Written, WrittenItems};
use armctl_frame::settings_report;
use armctl_frame::store::{Copy, Dump, Get, List, Restore};

commands! {
    /// Commands for static variables.
    pub enum Var {
        /// Read variables, for example SGI1, SGI0..SGI31 or SGR5
        Get(Get<Numbered<Variables>>),
        /// List the variables that are not 0
        List(List<Numbered<Variables>>),
        /// Set a variable to a number or to another variable, for example `SGI1 10000`
        Set(Set),
        /// Print each change of variables
        Watch(Watch<Get<Numbered<Variables>>>),
        /// Copy a variable to other variables, for example `SGI1 SGI2..SGI5`
        Copy(Copy<Numbered<Variables>>),
        /// Save variables to a CSV file
        Dump(Dump<Numbered<Variables>>),
        /// Write variables from a CSV file
        Restore(Restore<Numbered<Variables>>),
        /// Add a number or a variable to a variable
        Add(Add),
        /// Subtract a number or a variable from a variable
        Sub(Sub),
        /// Multiply a variable by a number or a variable
        Mul(Mul),
        /// Divide a variable by a number or a variable
        Div(Div),
    }
}

/// The static variables of the controller.
#[derive(Debug)]
pub struct Variables;

impl Kind for Variables {
    type Value = Number;
    const WORDS: TableWords = TableWords {
        nouns: ["variable", "variables"],
        placeholder: "VARIABLE",
        range: "SGI0 to SGI31 are whole numbers, SGR0 to SGR31 real numbers; SGI0..SGI5 is a range",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.var");
    const READ: (table::Command, Key) = (table::Command::VarGet, Key::Variable);
    const WRITE: table::Command = table::Command::VarSet;
    const NUMBERS: &'static [&'static str] = &["SGI0..SGI31", "SGR0..SGR31"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[("value", Key::Value, "value")];
    const RISK: Risk = Risk::Write;
    const LABELS: Option<names::Kind> = Some(names::Kind::Variable);
    const COMPLETE: ValueKind = complete::VARIABLE;

    fn value(values: &Values) -> Option<Number> {
        number(values.value(Key::Value))
    }

    fn is_blank(values: &Values) -> bool {
        number(values.value(Key::Value)).is_some_and(|number| number.as_f64() == Some(0.0))
    }
}

/// Returns the value of a variable; `None` if the value is not a number.
fn number(value: Option<&Value>) -> Option<Number> {
    match value {
        Some(Value::Int(number)) => Some(Number::from(*number)),
        // The conversion uses the decimal digits of the number: a cast to double precision would add digits.
        Some(Value::Real(number)) => real(*number),
        Some(Value::Text(_)) | None => None,
    }
}

/// Returns the value of a variable as JSON; null if the value is not a number.
pub fn held(value: Option<&Value>) -> Json {
    number(value).map_or(Json::Null, Json::Number)
}

/// Converts a single-precision number with exactly the digits that it prints.
fn real(number: f32) -> Option<Number> {
    match serde_json::from_str(&number.to_string()) {
        Ok(Json::Number(number)) => Some(number),
        _ => None,
    }
}

/// Operand of a change.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Operand {
    /// A number as the user typed it.
    Number(String),
    /// Number of a variable.
    Variable(i32),
}

fn variable(text: &str) -> Result<i32, String> {
    labels::parse_or_name(&[names::Kind::Variable], "SGI0", text, variable_by_address)
}

fn variable_by_address(text: &str) -> Result<i32, String> {
    single(table::Command::VarGet, Key::Variable, text)
}

fn operand(text: &str) -> Result<Operand, String> {
    if text.starts_with(char::is_alphabetic) {
        return variable(text).map(Operand::Variable);
    }
    Ok(Operand::Number(text.to_owned()))
}

fn divisor(text: &str) -> Result<Operand, String> {
    match operand(text)? {
        Operand::Number(text) if text.parse() == Ok(0.0) => Err("division by 0 is not possible".to_owned()),
        operand => Ok(operand),
    }
}

fn name(number: i32) -> String {
    named(table::Command::VarGet, Key::Variable, number)
}

impl Operand {
    fn put(&self, draft: Draft) -> Draft {
        match self {
            Self::Number(text) => draft.with(Key::Value, text.as_str()),
            Self::Variable(number) => draft.with(Key::Variable2, *number),
        }
    }

    /// Report of an assignment or a calculation.
    fn report(&self, variable: String, operation: &'static str, words: String, done: &link::CommandResult) -> Changed {
        let operand = match self {
            Self::Number(text) => settings_report::number(text),
            Self::Variable(number) => name(*number).into(),
        };
        // armctl does not read the variable back, so the new value is known only for an assignment of a number.
        let new = Some(operand.clone()).filter(|_| operation == "set" && matches!(self, Self::Number(_)));
        let item = Item::with("variable", variable, Operation { operation, operand }, Ok(new));
        WrittenItems::describe(words, vec![Written::new(item, done.old.value(), true)])
    }

    fn describe(&self) -> String {
        match self {
            Self::Number(text) => text.clone(),
            Self::Variable(number) => name(*number),
        }
    }
}

/// Report of a changed variable.
type Changed = WrittenItems<Json, Operation>;

/// Operation that changed a variable.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Operation {
    /// Operation: `set`, `add`, `sub`, `mul` or `div`.
    operation: &'static str,
    /// A number, or the name of a variable.
    operand: Json,
}

/// Declares the commands that change a variable. Their operand is a number or another variable.
macro_rules! changes {
    ($($(#[$meta:meta])* $name:ident $id:literal $by_number:ident $by_variable:ident $operand:ident $does:literal $told:literal;)*) => {
        $(
            $(#[$meta])*
            #[derive(Debug, Args)]
            pub struct $name {
                /// Variable to change: SGI0 to SGI31 are whole numbers, SGR0 to SGR31 real numbers
                #[arg(value_name = "VARIABLE", value_parser = variable, add = complete::VARIABLE)]
                variable: i32,
                /// Number, or a variable, for example SGI2
                #[arg(value_name = "VALUE", allow_negative_numbers = true, value_parser = $operand, add = complete::VARIABLE)]
                operand: Operand,
            }

            impl SingleCommand for $name {
                type Report = Changed;
                const ID: &'static str = $id;

                fn command(&self) -> table::Command {
                    match self.operand {
                        Operand::Number(_) => table::Command::$by_number,
                        Operand::Variable(_) => table::Command::$by_variable,
                    }
                }

                fn fill(&self, draft: Draft) -> Draft {
                    self.operand.put(draft.with(Key::Variable, self.variable))
                }

                fn report(&self, done: &link::CommandResult) -> Result<Changed> {
                    let (variable, operand) = (name(self.variable), self.operand.describe());
                    let words = format!($told, variable = variable, operand = operand);
                    Ok(self.operand.report(variable, $does, words, done))
                }
            }

            single_command!($name);
        )*
    };
}

changes! {
    /// Sets a variable to a number or to the value of another variable.
    Set "yrcx.var.set" VarSet VarSetVar operand "set" "{variable} = {operand}";
    /// Adds a number or a variable to a variable.
    Add "yrcx.var.add" VarAdd VarAddVar operand "add" "{variable} = {variable} + {operand}";
    /// Subtracts a number or a variable from a variable.
    Sub "yrcx.var.sub" VarSub VarSubVar operand "sub" "{variable} = {variable} - {operand}";
    /// Multiplies a variable by a number or a variable.
    Mul "yrcx.var.mul" VarMul VarMulVar operand "mul" "{variable} = {variable} * {operand}";
    /// Divides a variable by a number or a variable.
    Div "yrcx.var.div" VarDiv VarDivVar divisor "div" "{variable} = {variable} / {operand}";
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, run_on, words};

    #[test]
    fn real_variables_have_single_precision() {
        // As a single-precision number, 1.1 is 0x3F8CCCCD.
        let sent = words(&["var", "set", "sgr1", "1.1"]).unwrap();
        assert_eq!(sent[0][2..6], ["0x0101", "0x0000", "0xCCCD", "0x3F8C"]);
        let answered = |low, high| {
            let mut words = [0; 16];
            (words[0], words[2], words[4], words[5]) = (0x0200, 0x0101, low, high);
            run_on(Scripted::new([Reply::AddressPair(1, words)]), &["var", "get", "SGR1"]).0.unwrap()
        };
        assert_eq!(answered(0xCCCD, 0x3F8C)["items"][0]["value"].to_string(), "1.1");
        assert_eq!(answered(0, 0x7FC0)["items"][0]["value"], json!(null), "not a number");
        assert_eq!(words(&["var", "sub", "SGR0", "-0.5"]).unwrap()[0][5], "0xBF00");
    }
}

//! `yrcx var` (4.4.1): static variables.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Number, Value as Json};

use super::link;
use super::link::Yrcx;
use super::numbers::{Numbers, named, single};
use super::several::{Rows, Several, ask_each};
use super::single::Single;
use crate::command::frame::names;
use crate::command::frame::orders::{self, Done, New};
use crate::command::frame::watch::{Watch, Watchable, Watched};
use crate::command::yrcx::complete;
use crate::command::{Command, Context, Report, commands};
use crate::controller::names::Kind;
use crate::controller::yrcx::order::{Draft, Order};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Value};
use crate::failure::Failure;
use crate::output::view::{Cell, View};

commands! {
    /// What can be done with static variables.
    pub enum Var {
        /// Read variables: SGI1, SGI0..SGI31, SGR5
        Get(Get),
        /// Set a variable: SGI1 10000, or SGI1 SGI2
        Set(Set),
        /// Print each change of variables
        Watch(Watch<Get>),
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

/// Reads static variables, one after the other.
#[derive(Debug, Args)]
pub struct Get {
    /// Variables: SGI0 to SGI31 are whole numbers, SGR0 to SGR31 real ones; SGI0..SGI5 is a range
    #[arg(required = true, value_name = "VARIABLE", value_delimiter = ',',
        value_parser = variables, add = complete::VARIABLE)]
    variables: Vec<Numbers>,
}

/// Variables as typed, a range of them, or the name of one.
fn variables(text: &str) -> Result<Numbers, String> {
    names::read(&[Kind::Variable], ANY, text, |text| Numbers::parse(table::Command::VarGet, Key::Variable, text))
}

/// Stands for a name that is not known yet.
const ANY: &str = "SGI0";

impl Watchable for Get {
    const WATCH: &'static str = "yrcx.var.watch";
    const WATCHED: Watched = Watched {
        list: "variables",
        name: "variable",
        prefix: "",
        label: "",
        value: Some("value"),
        empty: "no variables",
    };
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Variables;
    const ID: &'static str = "yrcx.var.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Variables, Failure> {
        let Context { link, robot, screen, .. } = context;
        let called = names::of(robot, screen);
        let numbers = Numbers::of(&self.variables);
        let order = |number: &i32| Ok(link.draft(table::Command::VarGet)?.with(Key::Variable, *number).build()?);
        let orders = numbers.iter().map(order).collect::<Result<Vec<Order>, Failure>>()?;
        let answers = ask_each(link, screen, "reading variables", &orders).await?;
        let names = || numbers.iter().map(|number| name(*number));
        let held = Several::of(names(), answers, |_, values| Held::of(values.value(Key::Value)))?;
        Ok(Variables {
            variables: held.rows(
                names().map(|variable| Which { label: names::label(called, Kind::Variable, &variable), variable }),
            ),
        })
    }
}

/// Static variables.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Variables {
    variables: Rows<Which, Held>,
}

/// Which variable.
#[derive(Debug, Serialize, JsonSchema)]
struct Which {
    /// `SGI1`, `SGR1`.
    variable: String,
    /// What people call it; null where they gave it no name.
    label: Option<String>,
}

/// What a variable holds.
#[derive(Debug, Serialize, JsonSchema)]
struct Held {
    /// A whole or a real number; null where the controller holds what is no number.
    value: Option<Number>,
    #[serde(skip)]
    text: String,
}

impl Held {
    fn of(value: Option<&Value>) -> Self {
        let (value, text) = match value {
            Some(Value::Int(number)) => (Some(Number::from(*number)), number.to_string()),
            // By its digits: as a double it would get more than it has.
            Some(Value::Real(number)) => (real(*number), number.to_string()),
            Some(Value::Text(_)) | None => (None, "-".to_owned()),
        };
        Self { value, text }
    }
}

/// What a variable holds, for programs; null where that is no number.
pub fn held(value: Option<&Value>) -> Json {
    Held::of(value).value.map_or(Json::Null, Json::Number)
}

/// A single-precision number with its own digits.
fn real(number: f32) -> Option<Number> {
    match serde_json::from_str(&number.to_string()) {
        Ok(Json::Number(number)) => Some(number),
        _ => None,
    }
}

impl Report for Variables {
    fn view(&self) -> View {
        let name = |which: &Which| [which.variable.as_str().into(), Cell::maybe(which.label.as_deref())];
        let value = |held: &Held| [Cell::number(held.text.as_str())];
        let table = self.variables.table(["variable", "label"], ["value"], "no variables", name, value);
        View::table(table.without_blank("label"))
    }

    fn failure(&self) -> Option<Failure> {
        self.variables.failure()
    }
}

/// What stands on the right side.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Operand {
    /// As typed.
    Number(String),
    /// The number of a variable.
    Variable(i32),
}

fn variable(text: &str) -> Result<i32, String> {
    names::read(&[Kind::Variable], ANY, text, variable_by_address)
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
        Operand::Number(text) if text.parse() == Ok(0.0) => Err("nothing can be divided by 0".to_owned()),
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

    /// What was assigned, or computed from what was there.
    fn done(&self, variable: String, does: &str, words: String) -> New {
        let operand = match self {
            Self::Number(text) => orders::number(text),
            Self::Variable(number) => name(*number).into(),
        };
        let new = match (does, self) {
            ("set", Self::Number(_)) => operand.clone(),
            _ => Json::Null,
        };
        New::of(variable, new, words).with("operation", does).with("operand", operand)
    }

    fn describe(&self) -> String {
        match self {
            Self::Number(text) => text.clone(),
            Self::Variable(number) => name(*number),
        }
    }
}

/// Declares the commands that change a variable: by a number, or by a variable.
macro_rules! changes {
    ($($(#[$meta:meta])* $name:ident $id:literal $by_number:ident $by_variable:ident $operand:ident $does:literal $told:literal;)*) => {
        $(
            $(#[$meta])*
            #[derive(Debug, Args)]
            pub struct $name {
                /// Variable that changes: SGI0 to SGI31 are whole numbers, SGR0 to SGR31 real ones
                #[arg(value_name = "VARIABLE", value_parser = variable, add = complete::VARIABLE)]
                variable: i32,
                /// A number, or a variable such as SGI2
                #[arg(value_name = "VALUE", allow_negative_numbers = true, value_parser = $operand, add = complete::VARIABLE)]
                operand: Operand,
            }

            impl Single for $name {
                type Report = Done;
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

                fn report(&self, done: &link::Done) -> Result<Done, Failure> {
                    let (variable, operand) = (name(self.variable), self.operand.describe());
                    let words = format!($told, variable = variable, operand = operand);
                    Ok(self.operand.done(variable, $does, words).replaces(done.old.clone()))
                }
            }
        )*
    };
}

changes! {
    /// Sets a variable to a number or to a variable.
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

    use crate::command::yrcx::testing::{Reply, Scripted, example, objection, read_example, risk, run_on, words};
    use crate::controller::Risk;

    #[test]
    fn the_examples_of_the_manual() {
        for (id, line, (operand, new)) in [
            ("4.4.1-assign-value", ["var", "set", "SGI1", "10000"], (json!(10_000), json!(10_000))),
            ("4.4.1-assign-variable", ["var", "set", "SGI1", "SGI2"], (json!("SGI2"), json!(null))),
            ("4.4.1-arith-value", ["var", "add", "SGI1", "10000"], (json!(10_000), json!(null))),
            ("4.4.1-arith-variable", ["var", "mul", "SGI1", "SGI2"], (json!("SGI2"), json!(null))),
        ] {
            assert_eq!(words(&line).unwrap(), [example(id)], "{id}");
            let done = json!({"set": "SGI1", "operation": line[1], "operand": operand, "old": null, "new": new});
            assert_eq!(read_example(id, &line), done);
        }
        let read = read_example("4.4.1-reference", &["var", "get", "SGI5"]);
        assert_eq!(read, json!({"variables": [{"variable": "SGI5", "label": null, "ok": true, "value": 50}]}));
    }

    #[test]
    fn real_variables_have_single_precision() {
        // 1.1 is 0x3F8CCCCD.
        let sent = words(&["var", "set", "sgr1", "1.1"]).unwrap();
        assert_eq!(sent[0][2..6], ["0x0101", "0x0000", "0xCCCD", "0x3F8C"]);
        let answered = |low, high| {
            let mut words = [0; 16];
            (words[0], words[2], words[4], words[5]) = (0x0200, 0x0101, low, high);
            run_on(Scripted::new([Reply::Ends(1, words)]), &["var", "get", "SGR1"]).0.unwrap()
        };
        assert_eq!(answered(0xCCCD, 0x3F8C)["variables"][0]["value"].to_string(), "1.1");
        assert_eq!(answered(0, 0x7FC0)["variables"][0]["value"], json!(null), "not a number");
        assert_eq!(words(&["var", "sub", "SGR0", "-0.5"]).unwrap()[0][5], "0xBF00");
    }

    #[test]
    fn numbers_must_fit_their_variable() {
        assert!(words(&["var", "set", "SGI1", "1.5"]).unwrap_err().message.contains("value"));
        assert!(words(&["var", "set", "SGI1", "2147483648"]).is_err());
        assert!(words(&["var", "set", "SGR1", "inf"]).is_err());
        for (line, part) in [
            (["var", "set", "SGI32", "1"], "SGI32"),
            (["var", "div", "SGI1", "0"], "divided by 0"),
            (["var", "div", "SGR1", "-0.0"], "divided by 0"),
            (["var", "add", "SGI1", "SGX1"], "SGX1"),
        ] {
            assert!(objection(&line).contains(part), "{line:?}");
        }
        assert_eq!(words(&["var", "get", "SGI30..SGI31,SGR0"]).unwrap().len(), 3);
        assert_eq!((risk(&["var", "get", "SGI1"]), risk(&["var", "set", "SGI1", "1"])), (Risk::Read, Risk::Write));
    }
}

//! `toyo counter`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::complete;
use super::items::{self, Item, read_each};
use super::link::Toyo;
use super::numbers::{Numbers, not_held, number, read_back, small};
use crate::command::frame::names;
use crate::command::frame::orders::{Done, New, Old};
use crate::command::frame::watch::{Watch, Watchable, Watched};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::names::Kind;
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::names as names_of;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, View};

commands! {
    /// What can be done with counters.
    pub enum Counter {
        /// Read counters 1 to 99
        Get(Get),
        /// Set a counter
        Set(Set),
        /// Print each change of counters
        Watch(Watch<Get>),
    }
}

/// Reads counters; without a number, all 99.
#[derive(Debug, Args)]
pub struct Get {
    /// Such as 5, CN05 or 1-10, or a name
    #[arg(value_name = "N", value_delimiter = ',', value_parser = numbers, add = complete::COUNTER)]
    counters: Vec<Numbers>,
}

/// Sets a counter, also while a program runs.
#[derive(Debug, Args)]
pub struct Set {
    /// 1 to 99, or a name
    #[arg(value_name = "N", value_parser = one, add = complete::COUNTER)]
    counter: i32,
    /// 0 to 9999
    #[arg(value_name = "VALUE", value_parser = |text: &str| number(&fields()[1], text))]
    value: i32,
}

/// Stands for a name that is not known yet.
const ANY: &str = "CN01";

fn numbers(text: &str) -> Result<Numbers, String> {
    names::read(&[Kind::Counter], ANY, text, |text| Numbers::parse(&fields()[0], bare(text)))
}

fn one(text: &str) -> Result<i32, String> {
    names::read(&[Kind::Counter], ANY, text, |text| number(&fields()[0], bare(text)))
}

/// The number of `CN05`.
fn bare(text: &str) -> &str {
    text.strip_prefix("CN").or_else(|| text.strip_prefix("cn")).unwrap_or(text)
}

/// Number and count, as in MCST CN01=0000.
fn fields() -> &'static [Field] {
    table::Command::Mcst.row().requests[0].fields
}

impl Command for Get {
    type Family = Toyo;
    type Report = Counters;
    const ID: &'static str = "toyo.counter.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Counters, Failure> {
        let numbers = Numbers::of(&self.counters, &fields()[0]);
        let requests = numbers.iter().map(|number| Request::of(table::Command::Mcnt, [Value::Number(*number)]));
        let requests: Vec<Request> = requests.collect();
        let answers = read_each(context.link, context.screen, "reading counters", &requests).await?;
        let names = names::of(context.robot, context.screen);
        let count = |answer: &Record| {
            let counter = small(answer, "counter");
            let label = names::label(names, Kind::Counter, &names_of::counter(counter));
            Count { counter, label, count: answer.number("count").unwrap_or(0) }
        };
        let counters = numbers.iter().zip(&answers).map(|(number, answer)| Item::of("counter", *number, answer, count));
        Ok(Counters { counters: counters.collect() })
    }
}

impl Watchable for Get {
    const WATCH: &'static str = "toyo.counter.watch";
    const WATCHED: Watched = Watched {
        list: "counters",
        name: "counter",
        prefix: "counter ",
        label: "",
        value: Some("count"),
        empty: "no counters",
    };
}

impl Command for Set {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.counter.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let Self { counter, value } = *self;
        let values = [Value::Number(counter), Value::Number(value)];
        let (link, order) = (context.link, Request::of(table::Command::Mcst, values));
        let read = Request::of(table::Command::Mcnt, [Value::Number(counter)]);
        let old = Old::read(link.before(&read).await?.and_then(|record| record.number("count")));
        link.ask(&order).await?;
        let found = read_back(link, &order, &read).await?.number("count");
        if found.is_some_and(|found| found != value) {
            return Err(not_held(&order, &format!("it stands at {}", found.unwrap_or_default()))
                .hint("a program that runs may count on it meanwhile"));
        }
        let new = New::of("count", value, format!("counter {counter} set to {value}"));
        Ok(new.with("counter", counter).with("count", value).replaces(old))
    }
}

/// Counters in the order they were asked for.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Counters {
    counters: Vec<Item<Count>>,
}

/// A counter and what it stands at.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Count {
    counter: u8,
    /// What people call it; null where it has no name.
    label: Option<String>,
    count: i32,
}

impl Report for Counters {
    fn view(&self) -> View {
        let mut table = Table::new(&["counter", "count", "label"], "no counters");
        for counter in &self.counters {
            counter.show(&mut table, |Count { counter, label, count }| {
                vec![(*counter).into(), (*count).into(), Cell::maybe(label.as_deref())]
            });
        }
        View::table(table.without_blank("label"))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.counters)
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{Bench, Fault, all_blocks, blocks, objection};
    use crate::failure::Kind;

    #[test]
    fn counters_have_their_blocks() {
        assert_eq!(
            all_blocks(&["counter", "get", "1", "98-99"]).unwrap(),
            ["@MCNT CN=01", "@MCNT CN=98", "@MCNT CN=99"]
        );
        assert_eq!(all_blocks(&["counter", "get"]).unwrap().len(), 99);
        assert_eq!(blocks(&["counter", "set", "1", "1"]).unwrap(), ["@MCST CN01=0001", "@MCNT CN=01"]);
    }

    #[test]
    fn a_counter_that_was_set_is_read_back() {
        let mut bench = Bench::new("sim:");
        assert_eq!(bench.data(&["counter", "set", "5", "7"])["count"], 7);
        let other =
            |block: &str, _| if block == "@MCNT CN=05" { Fault::Answered("@MCNT CN05=0008") } else { Fault::None };
        let failure = Bench::with_faults("", other).0.run(&["counter", "set", "5", "7"]).unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(failure.message, "the controller accepted @MCST CN05=0007, but it stands at 8");
        let silent = |block: &str, count| if block == "@MCNT CN=05" && count > 1 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults("", silent).0.run(&["counter", "set", "5", "7"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
    }

    #[test]
    fn what_is_replaced_is_told() {
        let mut bench = Bench::new("sim:");
        bench.data(&["counter", "set", "5", "7"]);
        let set = bench.data(&["counter", "set", "5", "8"]);
        assert_eq!((&set["old"], &set["new"]), (&7.into(), &8.into()), "{set}");
        // A controller that does not tell it takes it nevertheless; one that is not there is not written to.
        let refuses = |block: &str, count| {
            if block == "@MCNT CN=05" && count == 1 { Fault::Answered("@NG") } else { Fault::None }
        };
        assert_eq!(
            Bench::with_faults("", refuses).0.data(&["counter", "set", "5", "7"])["old"],
            serde_json::Value::Null
        );
        let silent = |block: &str, _| if block.starts_with("@MC") { Fault::Lost } else { Fault::None };
        let (mut bench, heard) = Bench::with_faults("", silent);
        assert_eq!(bench.run(&["counter", "set", "5", "7"]).unwrap_err().kind, Kind::NoAnswer);
        assert!(!heard.borrow().iter().any(|block| block.starts_with("@MCST")), "nothing was written");
    }

    #[test]
    fn a_stale_ok_is_not_taken_for_that_of_an_order() {
        // The order before was given up, and its @OK comes when nobody waits for it any more.
        let late = |block: &str, _| match block {
            "@MCST CN05=0007" => Fault::Late(std::time::Duration::from_millis(3010)),
            "@MCST CN06=0001" => Fault::Lost,
            _ => Fault::None,
        };
        let (mut bench, heard) = Bench::with_faults("host = true\n", late);
        assert_eq!(bench.run(&["counter", "set", "5", "7"]).unwrap_err().kind, Kind::OutcomeUnknown);
        heard.borrow_mut().clear();
        // No `@OK` of its own came: whether it was done is open, not done.
        assert_eq!(bench.run(&["counter", "set", "6", "1"]).unwrap_err().kind, Kind::OutcomeUnknown);
        assert_eq!(heard.borrow()[..2], ["@MCNT CN=06", "@MCST CN06=0001"], "something harmless is asked first");
    }

    #[test]
    fn ranges_are_checked() {
        assert!(objection(&["counter", "get", "0"]).contains("1 to 99"));
        assert!(objection(&["counter", "set", "1", "10000"]).contains("0 to 9999"));
        assert!(objection(&["counter", "set", "1"]).contains("VALUE"));
    }
}

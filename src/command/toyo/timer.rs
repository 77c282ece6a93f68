//! `toyo timer`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::complete;
use super::items::{self, Item, read_each};
use super::link::Toyo;
use super::numbers::{Numbers, named, small};
use crate::command::frame::names;
use crate::command::{Command, Context, Report, commands};
use crate::controller::names::Kind;
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::names as names_of;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, View};

commands! {
    /// What can be done with timers: the protocol only reads them.
    pub enum Timer {
        /// Read timers 1 to 9
        Get(Get),
    }
}

/// Reads timers; without a number, all nine.
#[derive(Debug, Args)]
pub struct Get {
    /// Such as 5, TN5 or 1-3, or a name
    #[arg(value_name = "N", value_delimiter = ',', value_parser = numbers, add = complete::TIMER)]
    timers: Vec<Numbers>,
}

fn numbers(text: &str) -> Result<Numbers, String> {
    named(Kind::Timer, text, |text| Numbers::parse(field(), text))
}

/// Number of a timer, as in MTMR TN=1.
fn field() -> &'static Field {
    &table::Command::Mtmr.row().requests[0].fields[0]
}

impl Command for Get {
    type Family = Toyo;
    type Report = Timers;
    const ID: &'static str = "toyo.timer.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Timers, Failure> {
        let numbers = Numbers::of(&self.timers, field());
        let requests = numbers.iter().map(|number| Request::of(table::Command::Mtmr, [Value::Number(*number)]));
        let requests: Vec<Request> = requests.collect();
        let answers = read_each(context.link, context.screen, "reading timers", &requests).await?;
        let names = names::of(context.robot, context.screen);
        let time = |answer: &Record| {
            let timer = small(answer, "timer");
            let label = names::label(names, Kind::Timer, &names_of::timer(timer));
            Time { timer, label, time_s: f64::from(answer.number("time").unwrap_or(0)) / 10.0 }
        };
        let timers = numbers.iter().zip(&answers).map(|(number, answer)| Item::of("timer", *number, answer, time));
        Ok(Timers { timers: timers.collect() })
    }
}

/// Timers in the order they were asked for.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Timers {
    timers: Vec<Item<Time>>,
}

/// A timer and what it stands at.
#[derive(Debug, Serialize, JsonSchema)]
struct Time {
    timer: u8,
    /// What people call it; null where it has no name.
    label: Option<String>,
    time_s: f64,
}

impl Report for Timers {
    fn view(&self) -> View {
        let mut table = Table::new(&["timer", "time (s)", "label"], "no timers");
        for timer in &self.timers {
            timer.show(&mut table, |Time { timer, label, time_s }| {
                vec![(*timer).into(), Cell::number(format!("{time_s:.1}")), Cell::maybe(label.as_deref())]
            });
        }
        View::table(table.without_blank("label"))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.timers)
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{all_blocks, objection};

    #[test]
    fn timers_have_their_blocks() {
        assert_eq!(all_blocks(&["timer", "get", "9"]).unwrap(), ["@MTMR TN=9"]);
        let all: Vec<String> = (1..=9).map(|timer| format!("@MTMR TN={timer}")).collect();
        assert_eq!(all_blocks(&["timer", "get"]).unwrap(), all);
        assert!(objection(&["timer", "get", "10"]).contains("1 to 9"));
    }
}

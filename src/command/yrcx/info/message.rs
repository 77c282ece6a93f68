//! `yrcx info message` (4.7.7): messages of the alarm history.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::alarm::AlarmReport;
use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::Numbers;
use crate::command::yrcx::several::{Rows, read_numbers};
use crate::command::{Command, Context, Report};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::{Cell, Table, View};

/// Reads messages of the alarm history, one after the other.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx info alarm` tells the latest alarm of a remote command, and what to do about it; so does \
    `armctl explain yrcx CODE`."
)]
pub struct Message {
    /// Numbers in the history, 1 (the latest) to 500: 10, or 1..50
    #[arg(value_name = "N", value_delimiter = ',', default_value = "1..10",
        value_parser = |text: &str| Numbers::parse(table::Command::AlarmHistory, Key::History, text))]
    numbers: Vec<Numbers>,
}

impl Message {
    /// Reads them.
    pub async fn read(&self, context: Context<'_, Yrcx>) -> Result<Past, Failure> {
        let nouns = ["message", "messages"];
        let field = (table::Command::AlarmHistory, Key::History);
        let (numbers, messages) = read_numbers(context, nouns, field, &self.numbers, AlarmReport::of).await?;
        let mut messages = messages.rows(numbers.into_iter().map(|number| Which { number }));
        messages.retain(|_, alarm| alarm.code.is_some());
        Ok(messages)
    }
}

impl Command for Message {
    type Family = Yrcx;
    type Report = Messages;
    const ID: &'static str = "yrcx.info.message";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Messages, Failure> {
        Ok(Messages { messages: self.read(context).await? })
    }
}

/// Messages that are there.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Messages {
    messages: Past,
}

/// What the history tells.
pub type Past = Rows<Which, AlarmReport>;

/// Which message.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Which {
    /// Its number in the history.
    pub number: i32,
}

/// A row each.
pub fn rows(messages: &Past) -> Table {
    let cells = |AlarmReport { code, meaning, place, part, .. }: &AlarmReport| {
        let [code, place, part] = [code, place, part].map(|text| Cell::maybe(text.as_deref()));
        [code, Cell::maybe(*meaning), place, part]
    };
    let columns = ["alarm", "meaning", "place", "part"];
    messages.table(["number"], columns, "no alarms", |which| [which.number.into()], cells)
}

impl Report for Messages {
    fn view(&self) -> View {
        View::table(rows(&self.messages))
    }

    fn failure(&self) -> Option<Failure> {
        self.messages.failure()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{Reply, Scripted, example, objection, read_example, run_on, words};

    #[test]
    fn the_example_of_the_manual() {
        let line = ["info", "message", "10"];
        assert_eq!(words(&line).unwrap(), [example("4.7.7-reference")]);
        let message = &read_example("4.7.7-reference", &line)["messages"][0];
        assert_eq!((&message["number"], &message["code"]), (&json!(10), &json!("12.551")));
        assert_eq!((&message["place"], &message["part"]), (&json!("controller 1"), &json!("option slot 1")));
    }

    #[test]
    fn ten_are_read_unless_said_otherwise_and_empty_ones_left_out() {
        assert_eq!(words(&["info", "message"]).unwrap().len(), 10);
        assert!(objection(&["info", "message", "0"]).contains("allowed: 1 to 500"));
        let mut end = [0; 16];
        end[0] = 0x0200;
        let (read, _) = run_on(Scripted::new([Reply::Ends(1, end)]), &["info", "message", "1"]);
        assert_eq!(read.unwrap()["messages"], json!([]));
    }
}

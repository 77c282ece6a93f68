//! `yrcx info message` (4.7.7): messages of the alarm history.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::alarm::AlarmReport;
use crate::command::yrcx::Family;
use crate::command::yrcx::numbers::Numbers;
use crate::command::yrcx::several::{Refused, read_numbers};
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
    /// Numbers in the history, 1 to 500: 10, or 1..50
    #[arg(value_name = "N", value_delimiter = ',', default_value = "1..10",
        value_parser = |text: &str| Numbers::parse(table::Command::AlarmHistory, Key::History, text))]
    numbers: Vec<Numbers>,
}

impl Command for Message {
    type Family = Family;
    type Report = Messages;
    const ID: &'static str = "yrcx.info.message";

    async fn run(&self, context: Context<'_, Family>) -> Result<Messages, Failure> {
        let found =
            read_numbers(context, "messages", (table::Command::AlarmHistory, Key::History), &self.numbers).await?;
        let rows = found.entries.iter().map(|(number, values)| Row { number: *number, alarm: AlarmReport::of(values) });
        let messages = rows.filter(|row| row.alarm.code.is_some()).collect();
        Ok(Messages { messages, refused: found.refused })
    }
}

/// Messages that are there.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Messages {
    messages: Vec<Row>,
    /// Numbers that the controller refused to tell.
    refused: Vec<Refused>,
}

/// A message.
#[derive(Debug, Serialize, JsonSchema)]
struct Row {
    /// Its number in the history.
    number: i32,
    #[serde(flatten)]
    alarm: AlarmReport,
}

impl Report for Messages {
    fn view(&self) -> View {
        let mut table = Table::new(&["number", "alarm", "meaning", "place", "part"], "no alarms");
        for Row { number, alarm } in &self.messages {
            let AlarmReport { code, meaning, place, part, .. } = alarm;
            table.row([
                (*number).into(),
                Cell::maybe(code.as_deref()),
                Cell::maybe(*meaning),
                Cell::maybe(place.as_deref()),
                Cell::maybe(part.as_deref()),
            ]);
        }
        View::table(table)
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

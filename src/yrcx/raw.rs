//! `yrcx raw`: sends the words of any remote command, and decodes the answer.

use super::field_row::FieldRow;
use super::refusal::refused;
use super::{confirmed_write, link};
use crate::prelude::*;
use armctl_client::yrcx::Reply;
use armctl_controller::yrcx::answer::Answer;
use armctl_controller::yrcx::describe;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Words};
use armctl_frame::decode::{field_table, problem_lines};

/// Sends the words of a remote command, if the manual allows them.
#[derive(Debug, Args)]
#[command(after_help = "Missing words are 0. If the controller refuses the command, the exit code is 3. `armctl \
                        decode yrcx` explains words without sending them.")]
pub struct Raw {
    /// WI0 to WI15, for example 0x0001,0x0004,0,0x0032,0x0013
    #[arg(long, value_name = "WORDS", value_parser = order)]
    wi: Box<Order>,
}

fn order(text: &str) -> Result<Box<Order>, String> {
    Order::parse(&words(text)?).map(Box::new).map_err(|error| match error.alarm {
        Some(alarm) => format!("{error} (alarm {alarm}, {})", alarm.text()),
        None => error.to_string(),
    })
}

/// Parses up to 16 words, decimal or hexadecimal with 0x, with commas or spaces between them; missing words are 0.
pub fn words(text: &str) -> Result<Words, String> {
    let mut words = [0; COMMAND_WORDS];
    let pieces: Vec<&str> = text.split([',', ' ']).filter(|piece| !piece.is_empty()).collect();
    if pieces.is_empty() || pieces.len() > COMMAND_WORDS {
        return Err(format!("expected 1 to {COMMAND_WORDS} words, got {}", pieces.len()));
    }
    for (word, piece) in words.iter_mut().zip(pieces) {
        *word = user_input::unsigned(piece)
            .ok_or_else(|| format!("'{piece}' is not a valid word, such as 0x0032 or 50"))?;
    }
    Ok(words)
}

impl Command for Raw {
    type Family = Yrcx;
    type Report = Exchange;
    const ID: &'static str = "yrcx.raw";

    fn risk(&self) -> Risk {
        self.wi.risk()
    }

    fn intent(&self) -> String {
        format!("send {}: {}", self.wi.row().id, self.wi.row().name)
    }

    fn confirmation(&self) -> Confirmation {
        confirmed_write::confirmation(self.wi.command())
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Exchange> {
        context.link.reject_unit("the words contain the robot number")?;
        if self.confirmation() == Confirmation::WhenKnown {
            confirmed_write::confirm(context.link, &context.confirmer, &self.wi).await?;
        }
        let reply = context.link.raw(&self.wi).await?;
        Ok(Exchange::of(&self.wi, &reply))
    }
}

/// A command and its answer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Exchange {
    /// WI0 to WI15.
    wi: Vec<String>,
    /// WO0 to WO15.
    wo: Vec<String>,
    /// Title of the decoded answer.
    title: String,
    /// Decoded fields of the answer.
    fields: Vec<FieldRow>,
    /// Problems found in the answer.
    problems: Vec<String>,
    elapsed_ms: u64,
    #[serde(skip)]
    refusal: Option<Failure>,
}

impl Exchange {
    fn of(order: &Order, reply: &Reply) -> Self {
        let description = describe::answer(&reply.words, Some(order.words()));
        let refusal = match reply.answer {
            Answer::Refused { alarm, .. } => Some(refused(order.row(), alarm)),
            Answer::Done(_) | Answer::Running(_) => None,
        };
        Self {
            wi: link::hex(order.words()),
            wo: link::hex(&reply.words),
            title: description.title,
            fields: description.fields.into_iter().map(FieldRow).collect(),
            problems: description.problems,
            elapsed_ms: u64::try_from(reply.elapsed.as_millis()).unwrap_or(u64::MAX),
            refusal,
        }
    }
}

impl Report for Exchange {
    fn view(&self) -> View {
        let problems = problem_lines(&self.problems);
        let view = View::text(format!("{}\n{}{problems}", self.wo.join(" "), self.title));
        view.append(field_table(&self.fields))
    }

    fn failure(&self) -> Option<Failure> {
        self.refusal.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::words as read;

    #[test]
    fn words_are_decimal_or_hexadecimal() {
        assert_eq!(read("0x0001,4, 0 0x32 19").unwrap()[..6], [1, 4, 0, 50, 19, 0]);
        for wrong in ["", ",", "0x", "65536", "-1", "+1", "0x+1", "0x10000", "a"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
        assert!(read(&"1,".repeat(17)).is_err());
    }
}

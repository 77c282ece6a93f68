//! `toyo init`: clears memory.

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::task;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::gate::Demand;
use crate::output::view::View;

/// Clears memory. There is no way back but a backup.
#[derive(Debug, Args)]
#[command(
    after_help = "Sequential programs and coordinate tables are cleared for the current task only (`toyo task get`). On a \
                        real controller the word has to be typed once more, or --yes given. `toyo backup` saves what \
                        there is."
)]
pub struct Init {
    /// What to clear
    what: What,
}

/// What can be cleared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum What {
    /// The whole memory
    Everything,
    /// The sequential program of the current task
    Sequential,
    /// All palletizing programs
    Palletizing,
    /// The sequential program of the current task, and all palletizing programs
    Programs,
    /// All easy programs, and the coordinate table
    Easy,
    /// The coordinate table of the current task
    Points,
}

impl What {
    /// As typed, as on the line (TO 2-3, MINT), and in words.
    const fn row(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Everything => {
                ("everything", "0", "the whole memory: every program, table and, for all that is known, parameter")
            }
            Self::Sequential => ("sequential", "1", "the sequential program of the current task"),
            Self::Palletizing => ("palletizing", "2", "all palletizing programs"),
            Self::Programs => {
                ("programs", "3", "the sequential program of the current task and all palletizing programs")
            }
            Self::Easy => ("easy", "4", "all easy programs and the coordinate table"),
            Self::Points => ("points", "6", "the coordinate table of the current task"),
        }
    }
}

impl Command for Init {
    type Family = Family;
    type Report = Cleared;
    const ID: &'static str = "toyo.init";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    fn intent(&self) -> String {
        let (_, _, words) = self.what.row();
        format!("clear {words}, for good")
    }

    fn demand(&self) -> Demand {
        Demand::Word(self.what.row().0)
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Cleared, Failure> {
        let link = context.link;
        let (name, number, words) = self.what.row();
        let clear = Request::of(table::Command::Mint, [Value::Word(number)]);
        // A question would end a dry run.
        let task = if link.is_dry() {
            link.foresee(&Request::bare(table::Command::Mtsk), "which task it is about");
            None
        } else {
            Some(task::current(link).await?)
        };
        link.order(&clear).await?;
        Ok(Cleared { cleared: name, about: words, task })
    }
}

/// What was cleared.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Cleared {
    /// As typed: `points`.
    cleared: &'static str,
    /// In words.
    about: &'static str,
    /// The current task.
    task: Option<u8>,
}

impl Report for Cleared {
    fn view(&self) -> View {
        let task = self.task.map(|task| format!(" (task {task})")).unwrap_or_default();
        View::text(format!("cleared: {}{task}", self.about))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::toyo::testing::{blocks, intent, objection};
    use crate::controller::toyo::table::commands::CLEARS;

    #[test]
    fn every_word_clears_what_the_manual_has() {
        let typed: Vec<(&str, &str)> = What::value_variants().iter().map(|what| (what.row().0, what.row().1)).collect();
        assert_eq!(
            typed.iter().map(|(_, number)| *number).collect::<Vec<_>>(),
            CLEARS.iter().map(|word| word.text).collect::<Vec<_>>()
        );
        for (word, number) in typed {
            assert_eq!(blocks(&["init", word]).unwrap(), ["@MTSK".to_owned(), format!("@MINT PR={number}")], "{word}");
        }
        assert!(objection(&["init"]).contains("<WHAT>"));
        assert_eq!(intent(&["init", "points"]), "clear the coordinate table of the current task, for good");
    }

    #[test]
    fn the_word_is_that_of_the_command_line() {
        for what in What::value_variants() {
            let value = what.to_possible_value().unwrap();
            assert_eq!(Command::demand(&Init { what: *what }), Demand::Word(what.row().0));
            assert_eq!(value.get_name(), what.row().0);
        }
    }
}

//! `yrcx comment` (4.3.2).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::orders::Done;
use crate::command::yrcx::numbers::{Numbers, single};
use crate::command::yrcx::several::{Refused, read_numbers};
use crate::command::yrcx::single::Single;
use crate::command::yrcx::{Family, link};
use crate::command::{Command, Context, Report, commands};
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::output::view::{Table, View};

commands! {
    /// What can be done with comments of points.
    pub enum Comment of Family {
        /// Read the comments of points: 100, 0..29
        Get(Get),
        /// Write the comment of a point: 100 'WAIT ORG'
        Set(Set),
    }
}

/// Reads the comments of points, one after the other.
#[derive(Debug, Args)]
pub struct Get {
    /// Points, 0 to 29999: 100, 0..29 or 0..29,100
    #[arg(required = true, value_name = "POINT", value_delimiter = ',',
        value_parser = |text: &str| Numbers::parse(table::Command::CommentGet, Key::Point, text))]
    points: Vec<Numbers>,
}

impl Command for Get {
    type Family = Family;
    type Report = Comments;
    const ID: &'static str = "yrcx.comment.get";

    async fn run(&self, context: Context<'_, Family>) -> Result<Comments, Failure> {
        let found = read_numbers(context, "comments", (table::Command::CommentGet, Key::Point), &self.points).await?;
        let row = |(point, values): &(i32, Values)| Row {
            point: *point,
            comment: values.text(Key::Comment).unwrap_or_default().to_owned(),
        };
        Ok(Comments { comments: found.entries.iter().map(row).collect(), refused: found.refused })
    }
}

/// Comments of points.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Comments {
    comments: Vec<Row>,
    /// Points that the controller has not.
    refused: Vec<Refused>,
}

/// The comment of a point.
#[derive(Debug, Serialize, JsonSchema)]
struct Row {
    point: i32,
    /// Up to 16 characters; empty if there is none.
    comment: String,
}

impl Report for Comments {
    fn view(&self) -> View {
        let mut table = Table::new(&["point", "comment"], "no comments");
        for Row { point, comment } in &self.comments {
            table.row([(*point).into(), comment.as_str().into()]);
        }
        View::table(table)
    }
}

/// Writes the comment of a point.
#[derive(Debug, Args)]
pub struct Set {
    /// Point, 0 to 29999
    #[arg(value_name = "POINT", value_parser = |text: &str| single(table::Command::CommentSet, Key::Point, text))]
    point: i32,
    /// Up to 16 ASCII characters; '' for none
    #[arg(value_name = "TEXT", allow_hyphen_values = true)]
    comment: String,
}

impl Single for Set {
    type Report = Done;
    const ID: &'static str = "yrcx.comment.set";

    fn command(&self) -> table::Command {
        table::Command::CommentSet
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::Point, self.point).with(Key::Comment, self.comment.as_str())
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        Ok(Done::new(match &self.comment[..] {
            "" => format!("removed the comment of point {}", self.point),
            comment => format!("comment of point {}: {comment}", self.point),
        }))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["comment", "set", "100", "WAIT ORG"];
        assert_eq!(words(&set).unwrap(), [example("4.3.2-define")]);
        assert_eq!(read_example("4.3.2-define", &set)["done"], "comment of point 100: WAIT ORG");
        let read = read_example("4.3.2-reference", &["comment", "get", "50"]);
        assert_eq!(read["comments"], json!([{"point": 50, "comment": "WAIT ORG"}]));
    }

    #[test]
    fn comments_have_sixteen_characters_that_print() {
        assert!(words(&["comment", "set", "1", "0123456789ABCDEF"]).is_ok());
        assert_eq!(words(&["comment", "set", "1", ""]).unwrap()[0][4], "0x0000");
        for wrong in ["0123456789ABCDEFG", "Größe", "a\tb"] {
            let failure = words(&["comment", "set", "1", wrong]).unwrap_err();
            assert!(failure.message.ends_with("allowed: up to 16 ASCII characters"), "{failure}");
        }
    }
}

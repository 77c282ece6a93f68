//! `yrcx comment` (4.3.2).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::yrcx::link::Yrcx;
use crate::command::yrcx::numbers::{Numbers, single};
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::several::{Rows, read_numbers};
use crate::command::yrcx::single::one_row;
use crate::command::{Command, Context, Report, commands};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::output::view::View;

commands! {
    /// What can be done with comments of points.
    pub enum Comment {
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
    type Family = Yrcx;
    type Report = Comments;
    const ID: &'static str = "yrcx.comment.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Comments, Failure> {
        let nouns = ["comment of point", "comments"];
        let field = (table::Command::CommentGet, Key::Point);
        let of = |values: &Values| Text { comment: values.text(Key::Comment).unwrap_or_default().to_owned() };
        let (numbers, comments) = read_numbers(context, nouns, field, &self.points, of).await?;
        Ok(Comments { comments: comments.rows(numbers.into_iter().map(|point| Which { point })) })
    }
}

/// Comments of points.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Comments {
    comments: Rows<Which, Text>,
}

/// Which point.
#[derive(Debug, Serialize, JsonSchema)]
struct Which {
    point: i32,
}

/// The comment of a point.
#[derive(Debug, Serialize, JsonSchema)]
struct Text {
    /// Up to 16 characters; empty if there is none.
    comment: String,
}

impl Report for Comments {
    fn view(&self) -> View {
        let name = |which: &Which| [which.point.into()];
        View::table(
            self.comments.table(["point"], ["comment"], "no comments", name, |text| [text.comment.as_str().into()]),
        )
    }

    fn failure(&self) -> Option<Failure> {
        self.comments.failure()
    }
}

one_row! {
    /// Writes the comment of a point.
    Set(self) "yrcx.comment.set" -> Stored {
        /// Point, 0 to 29999
        #[arg(value_name = "POINT", value_parser = |text: &str| single(table::Command::CommentSet, Key::Point, text))]
        point: i32,
        /// Up to 16 ASCII characters; '' for none
        #[arg(value_name = "TEXT", allow_hyphen_values = true)]
        comment: String,
    }
    gives table::Command::CommentSet,
    with draft => draft.with(Key::Point, self.point).with(Key::Comment, self.comment.as_str()),
    done match &self.comment[..] {
        "" => format!("removed the comment of point {}", self.point),
        comment => format!("comment of point {}: {comment}", self.point),
    };
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words, written};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["comment", "set", "100", "WAIT ORG"];
        assert_eq!(written(&set).unwrap(), [example("4.3.2-define")]);
        assert_eq!(read_example("4.3.2-define", &set)["done"], "comment of point 100: WAIT ORG");
        let read = read_example("4.3.2-reference", &["comment", "get", "50"]);
        assert_eq!(read["comments"], json!([{"point": 50, "ok": true, "comment": "WAIT ORG"}]));
    }

    #[test]
    fn comments_have_sixteen_characters_that_print() {
        assert!(words(&["comment", "set", "1", "0123456789ABCDEF"]).is_ok());
        assert_eq!(written(&["comment", "set", "1", ""]).unwrap()[0][4], "0x0000");
        for wrong in ["0123456789ABCDEFG", "Größe", "a\tb"] {
            let failure = words(&["comment", "set", "1", wrong]).unwrap_err();
            assert!(failure.message.ends_with("allowed: up to 16 ASCII characters"), "{failure}");
        }
    }
}

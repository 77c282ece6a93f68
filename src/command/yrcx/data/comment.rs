//! `yrcx comment` (4.3.2).

use crate::command::commands;
use crate::command::frame::store::{Copy, Dump, Get, Ids, List, Restore, TableWords, ids};
use crate::command::yrcx::backup::{COMMENTS, Records};
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::single::one_row;
use crate::command::yrcx::stores::{Kind, Numbered};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};

commands! {
    /// Commands for point comments.
    pub enum Comment {
        /// Read the comments of points: 100, 0..29
        Get(Get<Numbered<Comments>>),
        /// List the points that have a comment
        List(List<Numbered<Comments>>),
        /// Write the comment of a point: 100 'WAIT ORG'
        Set(Set),
        /// Copy a comment to other points
        Copy(Copy<Numbered<Comments>>),
        /// Save comments to a CSV file
        Dump(Dump<Numbered<Comments>>),
        /// Write comments from a CSV file
        Restore(Restore<Numbered<Comments>>),
    }
}

/// Comments of points.
#[derive(Debug)]
pub struct Comments;

impl Kind for Comments {
    type Value = String;
    const WORDS: TableWords = TableWords {
        nouns: ["comment of point", "comments"],
        placeholder: "POINT",
        range: "Points, 0 to 29999: 100, 0..29 or 0..29,100",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.comment");
    const RECORDS: &'static Records = &COMMENTS;
    const HEADINGS: &'static [&'static str] = &["comment"];
    const IS_SMALL: bool = false;

    fn value(values: &Values) -> Option<String> {
        Some(values.text(Key::Comment).unwrap_or_default().to_owned())
    }

    fn is_blank(values: &Values) -> bool {
        values.text(Key::Comment).is_none_or(str::is_empty)
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
        assert_eq!(read_example("4.3.2-define", &set)["items"][0]["new"], "WAIT ORG");
        let read = read_example("4.3.2-reference", &["comment", "get", "50"]);
        let (name, kind) = ("50", "comment of point");
        let item = json!({"name": name, "label": null, "kind": kind, "ok": true, "value": "WAIT ORG"});
        assert_eq!(read["items"], json!([item]));
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

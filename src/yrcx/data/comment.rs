//! `yrcx comment` (4.3.2).

use crate::numbered_tables::{Kind, Numbered};
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

table_commands! {
    /// Commands for point comments.
    Comment of Numbered<Comments> {}
}

/// Comments of points.
#[derive(Debug)]
pub struct Comments;

impl Kind for Comments {
    type Value = String;
    const WORDS: TableWords = TableWords {
        nouns: ["comment of point", "comments"],
        placeholder: "POINT",
        range: "Points (0 to 29999), such as 100, 0..29 or 0..29,100",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.comment");
    const READ: (Command, Key) = (Command::CommentGet, Key::Point);
    const WRITE: Command = Command::CommentSet;
    const NUMBERS: &'static [&'static str] = &["0..29999"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[("comment", Key::Comment, "comment")];
    const IS_SMALL: bool = false;
    const IS_TEXT: bool = true;

    fn value(values: &Values) -> Option<String> {
        Some(values.text(Key::Comment).unwrap_or_default().to_owned())
    }

    fn is_blank(values: &Values) -> bool {
        values.text(Key::Comment).is_none_or(str::is_empty)
    }
}

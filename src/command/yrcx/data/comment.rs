//! `yrcx comment` (4.3.2).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::commands;
use crate::command::yrcx::numbers::single;
use crate::command::yrcx::overwrite::Stored;
use crate::command::yrcx::several::by_number;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};

commands! {
    /// What can be done with comments of points.
    pub enum Comment {
        /// Read the comments of points: 100, 0..29
        Get(Get),
        /// Write the comment of a point: 100 'WAIT ORG'
        Set(Set),
    }
}

by_number! {
    /// Reads the comments of points, one after the other.
    Get "yrcx.comment.get" {
        /// Points, 0 to 29999: 100, 0..29 or 0..29,100
        comments "POINT"
    }
    gives CommentGet Point ["comment of point", "comments"],
    /// Comments of points.
    Comments,
    /// Which point.
    point of Text: |values: &Values| Text { comment: values.text(Key::Comment).unwrap_or_default().to_owned() },
    columns ["comment"],
    cells |text| [text.comment.as_str().into()];
}

/// The comment of a point.
#[derive(Debug, Serialize, JsonSchema)]
struct Text {
    /// Up to 16 characters; empty if there is none.
    comment: String,
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
        assert_eq!(read_example("4.3.2-define", &set)["new"], "WAIT ORG");
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

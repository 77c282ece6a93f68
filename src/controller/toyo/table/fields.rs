//! Fields and words that several tables use.

use crate::toyo::field::{Field, Form, Number, Word};

/// A word that needs no description: its text is also its description.
pub const fn plain(text: &'static str) -> Word {
    Word { text, about: text }
}

/// A word with its meaning.
pub const fn word(text: &'static str, about: &'static str) -> Word {
    Word { text, about }
}

/// An integer with this number of digits.
pub const fn digits(name: &'static str, width: u8, least: i32, most: i32, about: &'static str) -> Field {
    Field::new(name, Form::Number(Number::digits(width, least, most)), about)
}

/// A number with decimals. The range counts units of the last decimal.
pub const fn fixed(name: &'static str, shape: (u8, u8), least: i32, most: i32, about: &'static str) -> Field {
    Field::new(name, Form::Number(Number::fixed(shape.0, shape.1, least, most)), about)
}

/// One of several words.
pub const fn words(name: &'static str, words: &'static [Word], about: &'static str) -> Field {
    Field::new(name, Form::Word(words), about)
}

/// A coordinate of an axis, in the format `+0000.00`.
pub const fn place(name: &'static str, about: &'static str) -> Field {
    Field::new(name, Form::Number(Number::signed(4, 2, -800_000, 800_000)), about).unit("mm")
}

/// One field for each of the four axes.
pub const fn axes(form: Form, unit: &'static str, about: &'static str) -> [Field; 4] {
    let axis = Field::new("ax1", form, about).unit(unit);
    [axis, axis.named("ax2"), axis.named("ax3"), axis.named("ax4")]
}

pub const X: Field = place("x", "X coordinate");
pub const Y: Field = place("y", "Y coordinate");
pub const Z: Field = place("z", "Z coordinate");
pub const R: Field = place("r", "R coordinate");

pub const STATION: Field = digits("station", 1, 0, 4, "I/O station");
pub const PORT: Field = digits("port", 2, 1, 99, "port");
pub const BIT: Field = digits("bit", 1, 0, 8, "bit of the port; 0 means none");
pub const TASK: Field = digits("task", 2, 1, 4, "task");
pub const STEP: Field = digits("step", 4, 1, 5000, "step of the sequential program");
pub const TAG: Field = digits("tag", 3, 1, 999, "tag");
/// Tag field in which 0 means no tag (ambiguity R7).
pub const TAG_OR_NONE: Field = digits("tag", 3, 0, 999, "tag; 0 means none");
pub const COUNTER: Field = digits("counter", 2, 1, 99, "counter");
/// Counter field in which 0 means no counter (ambiguity R7).
pub const COUNTER_OR_NONE: Field = digits("counter", 2, 0, 99, "counter whose value is added; 0 means none");
pub const COUNT: Field = digits("count", 4, 0, 9999, "count");
pub const TIMER: Field = digits("timer", 1, 1, 9, "timer");
pub const TIME: Field = fixed("time", (3, 1), 0, 9999, "time").unit("s");
pub const GROUP: Field = digits("group", 2, 1, 32, "MVM group");
pub const POINT: Field = digits("point", 3, 1, 999, "row of the coordinate table");
/// Point field in which 0 means that only the counter gives the row (ambiguity R7).
pub const POINT_OR_COUNTER: Field =
    digits("point", 3, 0, 999, "row of the coordinate table; with 0, only the counter gives the row");
/// Speed field in which 0 means the speed of the last SPD (ambiguity R7). Rows above 10 cannot be written in this field
/// (ambiguity R6).
pub const SPEED: Field = digits("speed", 2, 0, 10, "row of the speed table; 0 means the row of the last SPD");
pub const MASK: Field = Field::new("data", Form::Mask, "bits 8 to 1; a dot leaves the bit unchanged");

pub const AIM: Field = words("aim", &[word("a", "absolute"), word("i", "incremental")], "absolute or incremental");
pub const COURSE: Field = words("course", &[word("S", "axis speed"), word("T", "line speed")], "type of the speed");
pub const ARRIVAL: Field =
    words("arrival", &[word("POST", "stop there"), word("PASS", "pass by")], "whether to stop at the position");
pub const SWITCH: &[Word] = &[word("ON", "on"), word("OFF", "off")];
pub const AXIS: &[Word] = &[plain("X"), plain("Y"), plain("Z"), plain("R")];
pub const CC_LINK_RATES: &[Word] = &[plain("156K"), plain("625K"), plain("2.5M"), plain("5M"), plain("10M")];
pub const VALID: &[Word] = &[word("I", "invalid"), word("E", "valid")];

/// Comparison, which always has two characters (ambiguity R2).
pub const COMPARE: Field = words(
    "compare",
    &[
        word("= ", "equal to"),
        word("< ", "less than"),
        word("> ", "greater than"),
        word("<=", "at most"),
        word(">=", "at least"),
    ],
    "comparison",
);
pub const SIDE: Field = words("compare", &[word("<=", "at most"), word(">=", "at least")], "comparison");

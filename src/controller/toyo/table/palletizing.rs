//! The 16 records of a palletizing program (TO 2-6).

use super::fields::{AIM, ARRIVAL, COURSE, R, SPEED, TAG_OR_NONE, X, Y, Z, digits, place, word, words};
use crate::toyo::field::Field;
use crate::toyo::layout::Layout;

/// A record of a palletizing program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Pallet {
    /// Number, 1 to 16.
    pub number: u8,
    /// Name for user input, for example `source-p0`.
    pub name: &'static str,
    /// Content.
    pub about: &'static str,
    /// Fields, without program and number.
    pub layout: Layout,
}

impl Pallet {
    /// The record with this number.
    pub fn numbered(number: i32) -> Option<&'static Self> {
        RECORDS.iter().find(|record| i32::from(record.number) == number)
    }

    /// The record with this name or number.
    pub fn named(name: &str) -> Option<&'static Self> {
        let number = name.parse::<u8>().ok();
        RECORDS.iter().find(|record| record.name == name || Some(record.number) == number)
    }
}

/// Selects the side that has a matrix of positions. The manual uses the words source and destination ambiguously.
pub const MODE: Field = words(
    "mode",
    &[
        word("M-1", "from a matrix to one position"),
        word("1-M", "from one position to a matrix"),
        word("M-M", "matrix to matrix"),
    ],
    "which side is a matrix",
);

const CORNER: Layout = Layout::new("X={} Y={} Z={}", &[X, Y, Z]);
const PIECES: Layout = Layout::new("P1={} P2={} P3={}", &[pieces("p1"), pieces("p2"), pieces("p3")]);
const APPROACH: Layout =
    Layout::new("{} {} APR={} V={} {} R={}", &[AIM, COURSE, place("approach", "approach point"), SPEED, ARRIVAL, R]);
const HAND: Layout = Layout::new("R={} TAG={}", &[R, TAG_OR_NONE]);

const fn pieces(name: &'static str) -> Field {
    digits(name, 4, 0, 9999, "pieces in this direction")
}

const fn record(number: u8, name: &'static str, layout: Layout, about: &'static str) -> Pallet {
    Pallet { number, name, about, layout }
}

/// All records, in their order.
pub static RECORDS: [Pallet; 16] = [
    record(1, "start", Layout::new("TAG={} MOD={}", &[TAG_OR_NONE, MODE]), "start program and mode"),
    record(2, "source-p0", CORNER, "source matrix: corner P0"),
    record(3, "source-p1", CORNER, "source matrix: corner P1"),
    record(4, "source-p2", CORNER, "source matrix: corner P2"),
    record(5, "source-p3", CORNER, "source matrix: corner P3"),
    record(6, "source-pieces", PIECES, "source matrix: pieces in each direction"),
    record(7, "source-approach", APPROACH, "source side: approach point"),
    record(8, "source-hand", HAND, "source side: hand program"),
    record(9, "destination-p0", CORNER, "destination matrix: corner P0"),
    record(10, "destination-p1", CORNER, "destination matrix: corner P1"),
    record(11, "destination-p2", CORNER, "destination matrix: corner P2"),
    record(12, "destination-p3", CORNER, "destination matrix: corner P3"),
    record(13, "destination-pieces", PIECES, "destination matrix: pieces in each direction"),
    record(14, "destination-approach", APPROACH, "destination side: approach point"),
    record(15, "destination-hand", HAND, "destination side: hand program"),
    record(16, "end", Layout::new("TAG={}", &[TAG_OR_NONE]), "end program"),
];

//! Which remote commands named command lines reach.

use std::collections::BTreeSet;

use super::testing::words;
use crate::controller::yrcx::table::{Command, ROWS, Row};

/// A command line for each row, in the order of the codes.
const LINES: &[&str] = &[
    "raw --wi 0",
    "move --point 19",
    "move --point 19 --arch 3:10",
    "move --point 19 --linear",
    "move --point 19,20 --circular",
    "move --to 1,2,3,4",
    "move --to-pulse 1,2,3,4",
    "servo on",
    "servo off",
    "servo free",
    "motor off",
    "motor on",
    "motor pwr",
    "info version",
    "info servo",
    "info position --report pulse",
    "info position",
    "info alarm --history 1",
    "info alarm",
    "alarm reset",
];

/// Rows that no named command line reaches yet. The list gets shorter until it is empty.
const MISSING: usize = 111 - 20;

#[test]
fn every_line_sends_the_row_it_is_for() {
    let mut reached = BTreeSet::new();
    for line in LINES {
        let sent = words(&line.split(' ').collect::<Vec<_>>()).unwrap();
        let code = u16::from_str_radix(sent[0][0].trim_start_matches("0x"), 16).unwrap();
        assert!(reached.insert(Row::of(code).unwrap().command), "{line}: {} has a line already", sent[0][0]);
    }
    let missing: Vec<Command> = ROWS.iter().map(|row| row.command).filter(|row| !reached.contains(row)).collect();
    assert_eq!(missing.len(), MISSING, "{missing:?}");
}

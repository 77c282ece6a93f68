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
    "movei --point 19",
    "movei --point 19 --linear",
    "movei --by 1,2,3,4",
    "movei --by-pulse 1,2,3,4",
    "drive --axis 3 --point 19",
    "drive --axis 3 --to 5",
    "drive --axis 3 --to-pulse 5",
    "drivei --axis 3 --point 19",
    "drivei --axis 3 --by 5",
    "drivei --axis 3 --by-pulse 5",
    "pallet --pallet 1 --position 21",
    "pallet --pallet 1 --position 21 --arch 3:10",
    "jog pulse 1 +",
    "jog cartesian 1 +",
    "jog tool 1 +",
    "inch pulse 1 +",
    "inch cartesian 1 +",
    "inch tool 1 +",
    "inch-distance 100",
    "teach --point 19 --in mm",
    "abs-reset --axis 2 --move +",
    "abs-reset --axis 2",
    "origin",
    "origin --axis 1",
    "servo on",
    "servo off",
    "servo free",
    "speed manual 20",
    "speed auto 80",
    "speed program 80",
    "shift select 4",
    "hand select 1",
    "arm select right",
    "motor off",
    "motor on",
    "motor pwr",
    "movet --point 19",
    "movet --point 19 --linear",
    "torque-limit --axis 1 50",
    "push --axis 3 --point 19",
    "push --axis 3 --to 10",
    "push --axis 3 --to-pulse 10",
    "info version",
    "info servo",
    "info position --report pulse",
    "info position",
    "info alarm --history 1",
    "info alarm",
    "alarm reset",
];

/// Rows that no named command line reaches yet. The list gets shorter until it is empty.
const MISSING: usize = 111 - 20 - 36;

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

//! Test: each remote command has a command line that sends it.

use std::collections::BTreeSet;

use super::testing::{words, written};
use armctl_controller::Risk;
use armctl_controller::yrcx::table::{Command, ROWS, Row};

/// A command line for each row of the command table, in the order of the codes.
const LINES: &[&str] = &[
    "status-reset",
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
    "point set 1 --mm 1,2,3,4",
    "point get 1",
    "comment set 1 text",
    "comment get 1",
    "pallet-data set 1 2 2 1 1",
    "pallet-data get 1",
    "shift-data set 1 1 2 3 4",
    "shift-data get 1",
    "hand-data set 1 0 1 2 3 0",
    "hand-data get 1",
    "var set SGI1 1",
    "var set SGI1 SGI2",
    "var add SGI1 1",
    "var add SGI1 SGI2",
    "var sub SGI1 1",
    "var sub SGI1 SGI2",
    "var mul SGI1 1",
    "var mul SGI1 SGI2",
    "var div SGI1 1",
    "var div SGI1 SGI2",
    "var get SGI1",
    "param set WEIGHT 1",
    "param get WEIGHT",
    "point-calc copy 1 --to 2",
    "point-calc add 1 --to 2",
    "point-calc sub 1 --from 2",
    "point-calc pallet 1 --place 1 --to 1",
    "point-calc element 1 --element 1 --pulse 1",
    "point-calc element 1 --element 1 --mm 1",
    "point-calc shift-element 1 --element 1 --mm 1",
    "port set DO2 1",
    "port set DO2.1 on",
    "port get DO2",
    "program select --program 1 --priority 32",
    "program run --all-programs",
    "program step --task 1",
    "program skip --task 1",
    "program next --task 1",
    "program reset --all-programs",
    "program show --task 1",
    "info version",
    "info system",
    "info servo",
    "position --report pulse",
    "position",
    "info tasks",
    "info line",
    "alarm history 1",
    "info speed",
    "info arm",
    "info origin",
    "info torque",
    "clock get",
    "info slots",
    "info inch",
    "info alarm",
    "info torque --of rated",
    "clock set 2026-03-01",
    "clock set 08:45",
    "alarm reset",
];

#[test]
fn every_line_sends_the_row_it_is_for() {
    let mut reached = BTreeSet::new();
    for line in LINES {
        let sent = words(&line.split(' ').collect::<Vec<_>>()).unwrap();
        let row = |words: &Vec<String>| Row::from_word(u16::from_str_radix(&words[0][2..], 16).unwrap()).unwrap();
        let written = written(&line.split(' ').collect::<Vec<_>>()).unwrap();
        let own = row(written.first().unwrap_or(&sent[0])).command;
        assert!(!reached.contains(&own) || own.row().risk == Risk::Read, "{line}: {own:?} has a line already");
        // A command line may send several commands.
        reached.extend(sent.iter().map(|words| row(words).command));
    }
    let missing: Vec<Command> = ROWS.iter().map(|row| row.command).filter(|row| !reached.contains(row)).collect();
    assert_eq!(missing, [], "no command line sends these");
}

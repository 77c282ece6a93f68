//! Test that each of the 62 protocol commands has a command line other than `raw`.

use std::collections::BTreeSet;

use super::testing::{Bench, Fault, all_blocks};
use armctl_controller::toyo::table::commands::{ROWS, Row};

/// Command lines, each with the protocol commands of its dry run in order.
#[rustfmt::skip]
const LINES: &[(&str, &[&str])] = &[
    ("status", &["STAS"]),
    ("home", &["HOME"]),
    ("home --sync 1", &["SORG"]),
    ("position", &["MPST"]),
    ("host on", &["HSON"]),
    ("host off", &["HSOF"]),
    ("mode program", &["MPRO"]),
    ("mode step", &["MSTP"]),
    ("mode auto", &["MAUT"]),
    ("mode sequential", &["MSEQ"]),
    ("mode palletizing", &["MPLE"]),
    ("servo on", &["SVON"]),
    ("servo off", &["SVOF"]),
    ("stop", &["STOP"]),
    ("reset", &["REST"]),
    ("alarm history", &["EHTR"]),
    ("alarm reset", &["CERR"]),
    ("alarm point", &["MERP"]),
    ("run sequential", &["SPST"]),
    ("run palletizing --program 1", &["SPLN", "PPST"]),
    ("run easy --program 1", &["SESN", "SESY"]),
    ("run point 1", &["EXTP"]),
    ("jog X + inch", &["JGST"]),
    ("param set pendant-language english", &["RPAR", "WPAR"]),
    ("palletizing set 1 end 5", &["RPLT", "WPLT"]),
    ("palletizing copy 1 2", &["CPPL"]),
    ("palletizing select 1", &["SPLN"]),
    ("palletizing progress", &["RPLD"]),
    ("easy set 1 1 2 3", &["RESY", "WESY"]),
    ("easy copy 1 2", &["CESY"]),
    ("easy select 1", &["SESN"]),
    ("easy progress", &["RESD"]),
    ("program get", &["RSTX"]),
    ("program insert 1 END", &["ISTX", "WSTX"]),
    ("program delete 1", &["DSTX"]),
    ("program delete 1 --to 2", &["DSTL"]),
    ("program copy 1 2 --at 5", &["CPSS"]),
    ("program search 1", &["SSTG"]),
    ("io list", &["MINP", "MOUT", "MNIN"]),
    ("io set 1.1=on", &["DOUT"]),
    ("io direct 1", &["DOUT"]),
    ("counter get 1", &["MCNT"]),
    ("counter set 1 0", &["MCST"]),
    ("timer get 1", &["MTMR"]),
    ("override get", &["ROVR"]),
    ("override set 1", &["ROVR", "WOVR"]),
    ("task get", &["MTSK"]),
    ("task set 1", &["CTSK"]),
    ("offset", &["MOFF"]),
    ("coordinate set 0 0 0 0", &["MRSS"]),
    ("card read", &["RMCA"]),
    ("card write", &["WMCA"]),
    ("bus", &["MBUS"]),
    ("init points", &["MINT"]),
    ("robot-type 1 0", &["TYPE"]),
    ("info", &["SYSP", "CVER", "MTSK", "ROVR"]),
];

#[test]
fn every_command_has_a_command_line() {
    let mut reached = BTreeSet::new();
    for (line, commands) in LINES {
        let words: Vec<&str> = line.split(' ').collect();
        let blocks = all_blocks(&words).unwrap_or_else(|failure| panic!("{line}: {failure}"));
        let sent: Vec<&str> = blocks.iter().filter_map(|block| block.get(1..5)).collect();
        for command in *commands {
            assert!(sent.contains(command), "{line}: {command} is not in {sent:?}");
            reached.insert(*command);
        }
    }
    let missing: Vec<&str> = ROWS.iter().map(|row| row.word).filter(|word| !reached.contains(word)).collect();
    assert!(missing.is_empty(), "no command line sends {missing:?}");
}

/// While the teach pendant is ON, commands that the manual does not mark "host ON" are still sent, and the controller
/// decides.
#[test]
fn with_pendant_on_only_commands_that_need_the_host_are_not_sent() {
    let needs_host = |command: &str| Row::named(command).is_none_or(|row| row.needs_host);
    for (line, commands) in LINES {
        let words: Vec<&str> = line.split(' ').collect();
        let (mut bench, received) = Bench::with_faults("pendant = true\n", |_, _| Fault::None);
        let outcome = bench.run(&words);
        let received = received.borrow();
        let sent: BTreeSet<&str> = received.iter().filter_map(|block| block.get(1..5)).collect();
        for command in *commands {
            let is_sent = sent.contains(command);
            // A value that is already equal is not written.
            let may_be = if needs_host(command) { !is_sent } else { is_sent || outcome.is_ok() };
            assert!(may_be, "{line}: {command}: {outcome:?}");
        }
    }
}

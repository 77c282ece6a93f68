//! Tests of command lines: the blocks that they send, the question that they ask, and the mistakes that they reject.
//! Each of the 62 protocol commands has a command line other than `raw`.

use std::collections::BTreeSet;

use super::testing::{Bench, Fault, all_blocks, blocks, intent, plan};
use armctl_controller::toyo::table::commands::{ROWS, Row};
use armctl_frame::testing::{for_lines, rejects};

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

/// Command lines with all blocks that they send.
#[rustfmt::skip]
const SENT: &[(&str, &[&str])] = &[
    ("bus", &["@MBUS C1", "@MBUS C2"]),
    (
        "card write",
        &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@WMCA", "@STAS SNO=3", "@STAS SNO=0", "@STAS SNO=1", "@STAS SNO=0",
          "@HSOF"],
    ),
    ("counter get 1 98-99", &["@MCNT CN=01", "@MCNT CN=98", "@MCNT CN=99"]),
    ("timer get 9", &["@MTMR TN=9"]),
    (
        "timer get",
        &["@MTMR TN=1", "@MTMR TN=2", "@MTMR TN=3", "@MTMR TN=4", "@MTMR TN=5", "@MTMR TN=6", "@MTMR TN=7",
          "@MTMR TN=8", "@MTMR TN=9"],
    ),
    (
        "home",
        &["@SYSP", "@RPAR E01", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@HOME", "@STAS SNO=0", "@MPST", "@STAS SNO=1",
          "@HSOF"],
    ),
    ("host on", &["@HSON", "@STAS SNO=2"]),
    (
        "info",
        &["@SYSP", "@CVER NO=0", "@CVER NO=1", "@CVER NO=2", "@CVER NO=3", "@CVER NO=4", "@MTSK", "@ROVR"],
    ),
    ("offset", &["@SYSP", "@RPAR E01", "@MOFF"]),
    ("servo on", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@SVON", "@STAS SNO=3", "@HSOF"]),
    ("mode program", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MPRO", "@STAS SNO=2", "@HSOF"]),
    ("mode step", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MSTP", "@STAS SNO=2", "@HSOF"]),
    ("mode auto", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MAUT", "@STAS SNO=2", "@HSOF"]),
    ("mode automatic", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MAUT", "@STAS SNO=2", "@HSOF"]),
    ("mode sequential", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MSEQ", "@STAS SNO=2", "@HSOF"]),
    ("mode palletizing", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@MPLE", "@STAS SNO=2", "@HSOF"]),
    // A stop needs no host and no fence. It takes the host only if a controller refuses to stop a jog without it.
    (
        "stop",
        &["@STOP", "@STAS SNO=0", "@JGST X=SP Y=SP Z=SP R=SP", "@STAS SNO=0", "@MPST", "@STAS SNO=2", "@HSON",
          "@JGST X=SP Y=SP Z=SP R=SP", "@SYSP", "@RPAR E01", "@HSOF"],
    ),
    (
        "stop --jog",
        &["@JGST X=SP Y=SP Z=SP R=SP", "@STAS SNO=0", "@MPST", "@STAS SNO=2", "@HSON", "@JGST X=SP Y=SP Z=SP R=SP",
          "@SYSP", "@RPAR E01", "@HSOF"],
    ),
    ("override get", &["@ROVR"]),
    ("override set 100", &["@ROVR", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@WOVR OV=100", "@ROVR", "@HSOF"]),
    ("raw '@STAS SNO=0'", &["@STAS SNO=0"]),
    ("raw @MTSK", &["@MTSK"]),
    // A question settles whether the stop was executed.
    ("raw @STOP", &["@STOP", "@STAS SNO=0"]),
    ("raw '@JGST X=SP Y=SP Z=SP R=SP'", &["@JGST X=SP Y=SP Z=SP R=SP", "@STAS SNO=0"]),
    ("task get", &["@MTSK"]),
    ("io list --station 1", &["@MINP SNO=1 GN=1", "@MOUT SNO=1 GN=1"]),
    ("io direct 4", &["@STAS SNO=2", "@HSON", "@STAS SNO=0", "@DOUT 4", "@STAS SNO=0", "@HSOF"]),
    // The controller reports which axis is X.
    (
        "jog X + low --for 500ms",
        &["@SYSP", "@RPAR E01", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@JGST X=RS Y=RS Z=RS R=RS", "@MPST",
          "@JGST X=? Y=? Z=? R=?", "@STAS SNO=0", "@MPST", "@JGST X=SP Y=SP Z=SP R=SP", "@STAS SNO=0", "@MPST",
          "@HSOF"],
    ),
    (
        "param set soft-limit-minus -100 -200.5 0 0",
        &["@RPAR P02", "@STAS SNO=2", "@HSON", "@STAS SNO=0",
          "@WPAR P02 AX1=-0100.00 AX2=-0200.50 AX3=+0000.00 AX4=+0000.00", "@RPAR P02", "@HSOF"],
    ),
    // Values that are kept are unknown in a dry run.
    (
        "param set p01 ax2=150",
        &["@RPAR P01", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@WPAR P01 AX1=? AX2=+0150.00 AX3=? AX4=?", "@RPAR P01",
          "@HSOF"],
    ),
    (
        "program get --task 2 --from 10",
        &["@MTSK", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@CTSK TASK=02", "@RPAR E22", "@RSTX 0010", "@CTSK TASK=?",
          "@STAS SNO=0", "@HSOF"],
    ),
    (
        "run sequential 12 --wait",
        &["@SYSP", "@RPAR E01", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@SPST 0012", "@STAS SNO=0", "@MPST",
          "@STAS SNO=4", "@RSTX 0000", "@STAS SNO=1", "@RSTX 0000", "@STAS SNO=2", "@RSTX ?", "@HSOF"],
    ),
];

/// Command lines with the blocks of the command itself, without the requests around every command.
#[rustfmt::skip]
const OWN: &[(&str, &[&str])] = &[
    ("alarm list", &["@STAS SNO=0", "@STAS SNO=1"]),
    ("alarm reset", &["@CERR", "@STAS SNO=0"]),
    ("alarm point", &["@MERP"]),
    ("alarm history --limit 2", &["@EHTR NO=01", "@EHTR NO=02"]),
    ("card read --no-wait", &["@RMCA"]),
    (
        "coordinate set 100 -20.5 0 0 --task 2 --speed-row 5",
        &["@MRSS TASK=02 X=+0100.00 Y=-0020.50 Z=+0000.00 R=+0000.00 V=05"],
    ),
    ("counter set 1 1", &["@MCNT CN=01", "@MCST CN01=0001", "@MCNT CN=01"]),
    ("home --no-wait", &["@HOME"]),
    ("home --sync 2 --no-wait", &["@SORG 2"]),
    ("position", &["@MPST"]),
    (
        "mvm get 3",
        &["@RPAR T4 S1 GRP=03", "@RPAR T4 S2 GRP=03", "@RPAR T4 S3 GRP=03", "@RPAR T4 S4 GRP=03",
          "@RPAR T4 S5 GRP=03"],
    ),
    ("servo off", &["@SVOF", "@STAS SNO=3"]),
    ("reset", &["@REST"]),
    ("override set 5%", &["@ROVR", "@WOVR OV=005", "@ROVR"]),
    ("robot-type 1 123", &["@TYPE AX1 RTYP=000123", "@STAS SNO=0"]),
    ("speed-table get 1-2,20", &["@RPAR T2 V01", "@RPAR T2 V02", "@RPAR T2 V20"]),
    ("speed-table set 5 250", &["@RPAR T2 V05", "@WPAR T2 V05=0250.0", "@RPAR T2 V05"]),
    ("accel-table set 5 time=0.25", &["@RPAR T3 A05", "@WPAR T3 A05=0.25", "@RPAR T3 A05"]),
    ("torque-table set 3 2.5 2", &["@RPAR T5 LIM03", "@WPAR T5 LIM03 T=2.50 L=2.00", "@RPAR T5 LIM03"]),
    ("torque-table set 3 load=2", &["@RPAR T5 LIM03", "@WPAR T5 LIM03 T=? L=2.00", "@RPAR T5 LIM03"]),
    ("task set 4", &["@CTSK TASK=04", "@MTSK"]),
    ("easy get 2", &["@RESY PNO=02 ST=000"]),
    ("easy progress", &["@RESD"]),
    ("easy select 3", &["@SESN PR=03", "@RESD"]),
    (
        "easy set 1 10 5 20",
        &["@RESY PNO=01 ST=000", "@WESY PNO=01 ST=000 START=010 LOOP=0005 END=020", "@RESY PNO=01 ST=000"],
    ),
    (
        "easy set 1 loop=7",
        &["@RESY PNO=01 ST=000", "@WESY PNO=01 ST=000 START=? LOOP=0007 END=?", "@RESY PNO=01 ST=000"],
    ),
    ("io set 1=.......1", &["@DOUT STN=0 PN01=.......1", "@MOUT SNO=0 GN=1"]),
    ("io set 1.3=on", &["@DOUT STN=0 PN01=.....1..", "@MOUT SNO=0 GN=1"]),
    // No port 99 can be read.
    (
        "io set PN99.8=off 2=10101010 99.1=1 --station 4",
        &["@DOUT STN=4 PN99=0......1", "@DOUT STN=4 PN02=10101010", "@MOUT SNO=4 GN=1"],
    ),
    ("palletizing get 3 source-p1 16", &["@RPLT 03 SNO=03", "@RPLT 03 SNO=16"]),
    ("palletizing progress", &["@RPLD"]),
    ("palletizing select 16", &["@SPLN PR=16", "@RPLD"]),
    (
        "palletizing set 1 Source-P1 1.5 -2 0",
        &["@RPLT 01 SNO=03", "@WPLT 01 SNO=03 X=+0001.50 Y=-0002.00 Z=+0000.00", "@RPLT 01 SNO=03"],
    ),
    (
        "palletizing set 1 1 5 m-m",
        &["@RPLT 01 SNO=01", "@WPLT 01 SNO=01 TAG=005 MOD=M-M", "@RPLT 01 SNO=01"],
    ),
    ("param get Soft-Limit-Plus p01 M09", &["@RPAR P01", "@RPAR M09"]),
    ("param list special", &["@RPAR U03", "@RPAR U21", "@RPAR U22"]),
    ("param set m09 english", &["@RPAR M09", "@WPAR M09 E", "@RPAR M09"]),
    ("param set m01 0/01/3", &["@RPAR M01", "@WPAR M01 0/01/3", "@RPAR M01"]),
    ("param set p13 '<=' -5 0/01/3", &["@RPAR P13", "@WPAR P13 AX1<=-0005.00 0/01/3", "@RPAR P13"]),
    // Each point of overlapping ranges is read once.
    ("point get 9-10,20 9", &["@MTSK", "@RPAR T1 PT=009", "@RPAR T1 PT=010", "@RPAR T1 PT=020"]),
    ("point get 1 --task 2", &["@MTSK", "@CTSK TASK=02", "@RPAR T1 PT=001", "@CTSK TASK=?"]),
    ("point list 998-999", &["@MTSK", "@RPAR T1 PT=998", "@RPAR T1 PT=999"]),
    (
        "point set 7 100 -20.5 0 0",
        &["@MTSK", "@RPAR T1 PT=007", "@WPAR T1 PT=007 X=+0100.00 Y=-0020.50 Z=+0000.00 R=+0000.00",
          "@RPAR T1 PT=007"],
    ),
    (
        "point set 7 z=1",
        &["@MTSK", "@RPAR T1 PT=007", "@WPAR T1 PT=007 X=? Y=? Z=+0001.00 R=?", "@RPAR T1 PT=007"],
    ),
    ("program get", &["@MTSK", "@RPAR E22", "@RSTX 0001"]),
    ("program search 1", &["@MTSK", "@STAS SNO=0", "@SSTG TAG=001", "@RSTX 0000"]),
    ("program show", &["@MTSK", "@RSTX 0000"]),
    ("run sequential", &["@SPST 0000"]),
    ("run palletizing --program 3 --no-wait", &["@SPLN PR=03", "@PPST"]),
    ("run palletizing --no-wait", &["@PPST"]),
    ("run easy --program 8 --no-wait", &["@SESN PR=08", "@SESY"]),
    ("run point 7 --no-wait", &["@EXTP PT=007"]),
];

#[test]
fn lines_send_these_blocks() {
    for_lines(SENT.iter().copied(), |line, words, sent| assert_eq!(all_blocks(words).unwrap(), sent, "{line}"));
    for_lines(OWN.iter().copied(), |line, words, own| assert_eq!(blocks(words).unwrap(), own, "{line}"));
}

/// Lines with several blocks, of which one shows how the arguments were read.
#[test]
fn arguments_decide_one_block() {
    let cases = [
        ("jog 2 - high --for 1s", (2, "@JGST X=SP Y=-H Z=SP R=SP")),
        ("jog 3 minus inch --steps 3", (2, "@JGST X=SP Y=SP Z=-C R=SP")),
        ("jog 4 plus low --for 60", (2, "@JGST X=SP Y=SP Z=SP R=+L")),
        ("palletizing copy 1 2", (32, "@CPPL STA=01 TOP=02")),
        ("palletizing set 1 7 aim=incremental", (2, "@RPLT 01 SNO=07")),
    ];
    for_lines(cases, |line, words, (at, block)| assert_eq!(blocks(words).unwrap()[at], block, "{line}"));
}

#[test]
fn ranges_send_a_block_for_each_row() {
    let cases = [
        ("alarm history", 20),
        ("counter get", 99),
        ("mvm get", 160),
        ("accel-table get", 20),
        ("torque-table get", 8),
        ("easy get", 8),
        ("palletizing get 3", 16),
        ("palletizing copy 1 2", 49),
        ("palletizing set 1 7 aim=incremental", 3),
        ("point list", 1 + 999),
    ];
    for_lines(cases, |line, words, count| assert_eq!(blocks(words).unwrap().len(), count, "{line}"));
}

#[test]
fn questions_name_what_will_happen() {
    let cases = [
        (
            "coordinate set 100 -20.5 0 0 --task 2 --speed-row 5",
            "move to X 100 mm, Y -20.5 mm, Z 0 mm, R 0 mm with the next RSMV step of task 2 at the speed of row 5",
        ),
        ("home", "move all axes to their origin"),
        ("host off", ""),
        ("init points", "clear the coordinate table of the current task permanently"),
        ("raw @XXXX", "send @XXXX (which is not in the manual)"),
        ("jog X + low --for 500ms", "move axis X slowly in plus direction for 500ms"),
        ("run easy --program 8", "run easy program 8"),
    ];
    for_lines(cases, |line, words, text| assert_eq!(intent(words), text, "{line}"));
    assert!(intent(&["servo", "off"]).contains("may sink"));
    assert!(intent(&["robot-type", "1", "123"]).contains("axis 1 to robot type 000123"));
}

#[test]
fn wrong_arguments_are_rejected_before_any_block_is_sent() {
    rejects(
        plan,
        [
            ("alarm history --limit 100", "1..=99"),
            ("coordinate set 1 2 3", "<R>"),
            ("coordinate set 8000.01 0 0 0", "-8000.00 to 8000.00 mm"),
            ("coordinate set 0.001 0 0 0", "has too many decimals"),
            ("coordinate set 0 0 0 0 --speed-row 11", "0 to 10"),
            ("counter get 0", "1 to 99"),
            ("counter set 1 10000", "0 to 9999"),
            ("counter set 1", "VALUE"),
            ("timer get 10", "1 to 9"),
            ("home --sync 4", "1..=3"),
            ("host maybe", "maybe"),
            ("init", "<WHAT>"),
            ("mvm get 33", "33 is out of range"),
            ("mvm set 1 origin=0", "group 1: origin: 0 is out of range (a number, 1 to 999)"),
            ("mvm set 1 orgin=1", "group 1: unknown value 'orgin'; did you mean origin?"),
            ("mvm set 1 p1=1 p1=2", "group 1: p1 appears twice"),
            ("mode easy", "palletizing"),
            ("override set 0", "1 to 100 %"),
            ("override set 101", "1 to 100 %"),
            ("override set x", "1 to 100 %"),
            ("override set 50.5", "1 to 100 %"),
            ("raw STAS", "begin with @"),
            ("raw '@STAS\tSNO=0'", "column 6"),
            ("raw '@HSON\r\n'", "line end"),
            ("robot-type 5 0", "1 to 4"),
            ("robot-type 1 1000000", "999999"),
            ("torque-table get 9", "9 is out of range (a number, 1 to 8)"),
            ("speed-table set 5 0.5", "speed-table row 5: speed: 0.5 is out of range (a number, 1.0 to 9999.9 mm/s)"),
            ("task set 0", "1 to 4"),
            ("easy get 9", "9 is out of range"),
            ("easy set 1 10 5 1000", "easy program 1: end: 1000 is out of range (a number, 0 to 999)"),
            ("io set 1", "for example OUT1.3=on"),
            ("io set 1.9=on", "bits 1 to 8"),
            ("io set 1.0=on", "bits 1 to 8"),
            ("io set 1.1=yes", "on or off"),
            ("io set 100=........", "1 to 99"),
            ("io set 1=.1", "eight characters (0, 1 or a dot)"),
            ("io set 1=on", "OUT1.1=on"),
            ("io set 1.3=on 1=00000000", "bit 3 of port 1 appears twice"),
            ("io direct 5", "1..=4"),
            ("jog X + low", "--for"),
            ("jog X + high --for 61s", "100ms to 1m"),
            ("jog X + high --for 50ms", "100ms to 1m"),
            ("jog A + inch", "X, Y, Z, R"),
            ("jog X + inch --steps 101", "1..=100"),
            ("jog X + inch --for 1s", ""),
            ("jog X + low --steps 2", ""),
            ("palletizing get 17", "17 is out of range (a number, 1 to 16)"),
            ("palletizing get 1 sorce-p1", "unknown record; did you mean source-p1?"),
            ("palletizing set 1 7 aim=x", "source-approach: aim: 'x' is not a (absolute) or i (incremental)"),
            ("param get soft-limit-pluss", "unknown parameter; did you mean soft-limit-plus?"),
            ("param get t4.s1", "mvm-points is a table; use `toyo mvm get` to read its rows"),
            ("param set p01 8000.01 0 0 0", "ax1: 8000.01 is out of range (a number, -8000.00 to 8000.00 mm)"),
            ("param set e22 4000 1000 1 0", "all tasks together would have 5001 steps; the limit is 5000"),
            ("param set e05 left 0 0 0", "motor-direction: ax1: 'left' is not 0 (clockwise) or 1 (counterclockwise)"),
            ("point get 1000", "1000 is out of range (a number, 1 to 999)"),
            ("point set 7 100 0 9000 0", "point 7: z: 9000.00 is out of range (a number, -8000.00 to 8000.00 mm)"),
            ("point set 7", "VALUE"),
            ("program get --from 0", "1..=5000"),
            ("program get --task 5", "1..=4"),
            ("program get --from 5 --to 4", ""),
            ("program insert 1 OUT STN=9", ""),
            ("program insert 1 JMP TAG=next", ""),
            ("program delete 5 --to 4", ""),
            ("program copy 5 4 --at 1", ""),
            ("program copy 1 2 --at 5000", ""),
            ("program copy 1 2 --at 2", ""),
            ("run sequential 5001", "1..=5000"),
            ("run point 0", "1 to 999"),
        ],
    );
}

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

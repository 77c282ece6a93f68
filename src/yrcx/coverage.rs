//! Tests of command lines: the words that they send, the question that they ask, and the mistakes that they reject.
//! Each remote command has a command line that sends it.

use std::collections::BTreeSet;

use super::testing::{example, intent, plan, read_in_turn, risk, words, written};
use armctl_controller::Risk;
use armctl_controller::yrcx::table::{Command, ROWS, Row};
use armctl_frame::testing::{for_lines, has_all, rejects, words_of};

/// Command lines of the worked examples of the manual: a line, the examples that it sends, and JSON that its report
/// contains. The examples of 4.2 are in `motion/tests.rs`.
#[rustfmt::skip]
const EXAMPLES: &[(&str, &[&str], &str)] = &[
    ("raw --wi 0x0001,0x0004,0,0x0032,0x0013", &["2-ptp-walkthrough"], ""),
    ("teach 4000 --in pulse", &["4.2.9-teach"], ""),
    ("point set 100 --pulse 10000,-20000,5000,-18000", &["4.3.1-define"],
        r#"{"items": [{"new": {"text": "--pulse 10000,-20000,5000,-18000"}}]}"#),
    ("point get 50", &["4.3.1-reference"], r#"{"items": [{"name": "50", "ok": true, "kind": "point", "value": {
        "text": "--mm 10.000,-20.000,5.000,-18.000", "x_mm": 10.0,
        "joints": [{"mm": 10.0}, {"mm": -20.0}, {"mm": 5.0}, {"mm": -18.0}]}}]}"#),
    ("comment set 100 'WAIT ORG'", &["4.3.2-define"], r#"{"items": [{"new": "WAIT ORG"}]}"#),
    ("comment get 50", &["4.3.2-reference"], r#"{"items": [
        {"name": "50", "label": null, "kind": "comment of point", "ok": true, "value": "WAIT ORG"}]}"#),
    ("pallet-data set 10 10 15 1 100", &["4.3.3-define"],
        r#"{"items": [{"new": {"nx": 10, "ny": 15, "nz": 1, "first_point": 100}}]}"#),
    ("pallet-data get 10", &["4.3.3-reference"],
        r#"{"items": [{"value": {"nx": 10, "ny": 15, "nz": 1, "first_point": 100}}]}"#),
    ("shift-data set 5 10 -20 5 -18", &["4.3.4-define"],
        r#"{"items": [{"new": {"shift_mm": [10.0, -20.0, 5.0, -18.0]}}]}"#),
    ("shift-data get 5", &["4.3.4-reference"], r#"{"items": [{"value": {"shift_mm": [10.0, -20.0, 5.0, -18.0]}}]}"#),
    ("hand-data set 1 0 10000 -2 5 0", &["4.3.5-define"], r#"{"items": [{"new": {"data_2_mm": -2.0}}]}"#),
    ("hand-data get 1", &["4.3.5-reference"], r#"{"items": [{"value":
        {"robot": 1, "data_1": 10000, "data_2_mm": -2.0, "data_3_mm": 5.0, "data_4": 0}}]}"#),
    ("var set SGI1 10000", &["4.4.1-assign-value"], r#"{"items": [{"name": "SGI1", "label": null, "kind": "variable",
        "operation": "set", "operand": 10000, "ok": true, "value": 10000, "old": null, "new": 10000,
        "written": true}]}"#),
    ("var set SGI1 SGI2", &["4.4.1-assign-variable"], r#"{"items": [{"name": "SGI1", "label": null, "kind": "variable",
        "operation": "set", "operand": "SGI2", "ok": true, "value": null, "old": null, "new": null,
        "written": true}]}"#),
    ("var add SGI1 10000", &["4.4.1-arith-value"], r#"{"items": [{"name": "SGI1", "label": null, "kind": "variable",
        "operation": "add", "operand": 10000, "ok": true, "value": null, "old": null, "new": null,
        "written": true}]}"#),
    ("var mul SGI1 SGI2", &["4.4.1-arith-variable"], r#"{"items": [{"name": "SGI1", "label": null, "kind": "variable",
        "operation": "mul", "operand": "SGI2", "ok": true, "value": null, "old": null, "new": null,
        "written": true}]}"#),
    ("var get SGI5", &["4.4.1-reference"],
        r#"{"items": [{"name": "SGI5", "label": null, "kind": "variable", "ok": true, "value": 50}]}"#),
    ("param set TOLE.3 1000", &["4.4.2-assign"], r#"{"items": [{"new": 1000}]}"#),
    ("param get outpos.1", &["4.4.2-reference"], r#"{"items": [{"name": "OUTPOS.1", "label": null, "kind": "parameter",
        "number": 260, "axis_number": 1, "unit": "pulses", "meaning": "OUT effective position", "ok": true,
        "value": 131071}]}"#),
    ("point-calc copy 100 --to 1", &["4.4.3-assign-point"], r#"{"items": [{"kind": "point", "name": "1"}]}"#),
    ("point-calc add 100 --to 1", &["4.4.3-add-point"], r#"{"items": [{"kind": "point", "name": "1"}]}"#),
    ("point-calc pallet 2 --place 133 --to 100", &["4.4.3-assign-pallet-point"],
        r#"{"items": [{"kind": "point", "name": "100"}]}"#),
    ("point-calc element 1 --element 4 --mm 1.000", &["4.4.4-point-element"],
        r#"{"items": [{"kind": "point", "name": "1"}]}"#),
    ("point-calc shift-element 1 --element 2 --mm 1", &["4.4.4-shift-element"],
        r#"{"items": [{"kind": "shift", "name": "1"}]}"#),
    ("port set DO12 7", &["4.5.1-assign-port"],
        r#"{"items": [{"name": "DO12", "kind": "port", "old": null, "new": 7}]}"#),
    ("port set 'DO(21)' 1", &["4.5.1-assign-bit"],
        r#"{"items": [{"name": "DO2.1", "kind": "signal", "old": null, "new": true}]}"#),
    ("port get 'DO12()'", &["4.5.1-reference-do12"],
        r#"{"items": [{"name": "DO12", "kind": "port", "value": 7, "bits": "00000111"}]}"#),
    ("port get DI2", &["4.5.1-reference-di2"],
        r#"{"items": [{"name": "DI2", "kind": "port", "value": 127, "bits": "01111111"}]}"#),
    ("port get di2.7", &["4.5.1-reference-di2"], r#"{"items": [{"name": "DI2.7", "kind": "signal", "value": false}]}"#),
    ("program select --program 1 --task 1 --priority 47", &["4.6.1-designate"], r#"{"set": "program_state",
        "old": null, "new": "registered", "program": 1, "task": 1, "priority": 47}"#),
    ("program run --program 1", &["4.6.2-execute"], r#"{"state": "running"}"#),
    // In this example, the manual prints WI1 as 0x0100, and prints the name without the spaces that its own text
    // requires.
    ("program reset --name ABC_DE", &["4.6.3-reset"], r#"{"name": "ABC_DE"}"#),
    ("program show --program 1", &["4.6.4-reference"], r#"{"program": "ABCDEFGH", "line": 101, "step": null,
        "state": null, "elapsed_ms": null, "cycles": [], "cycle_times": null, "number": 1, "task": 2, "priority": 32,
        "in_common": false}"#),
    ("info version", &["4.7.1-reference"], r#"{"host_version": "V1.08", "host_revision": "R0048",
        "fpga_version": "V1.001", "driver_versions": ["V1.01", "V1.01", "V1.01", "V1.01"]}"#),
    ("info system", &["4.7.2-reference"], r#"{"robot_type": 2000, "axis_types": [2000, 2000, 2000, 2000]}"#),
    ("info servo", &["4.7.3-reference"],
        r#"{"axes": [{"state": "servo"}, {"state": "servo"}, {"state": "free"}, {"state": "servo"}]}"#),
    ("info tasks 1..8", &["4.7.5-reference"], r#"{"items": [{"value": "execution"}, {"value": "execution"},
        {"value": null}, {"value": null}, {"value": "suspend"}, {"value": null}, {"value": null}, {"value": null}]}"#),
    ("info line 2-3,5", &["4.7.6-reference"], r#"{"items": [
        {"name": "2", "label": null, "kind": "task", "ok": true, "value": {"line": 19, "in_common": false}},
        {"name": "3", "label": null, "kind": "task", "ok": true, "value": null},
        {"name": "5", "label": null, "kind": "task", "ok": true, "value": {"line": 99, "in_common": false}}]}"#),
    ("info speed", &["4.7.8-reference"],
        r#"{"manual_speed_percent": 50, "auto_speed_percent": 50, "program_speed_percent": 50}"#),
    ("info arm", &["4.7.9-reference", "4.7.10-reference"], r#"{"selected": "left", "current": "left", "errors": []}"#),
    ("info origin --unit 1", &["4.7.11-reference"], r#"{"system": null, "axes": [
        {"state": "complete"}, {"state": "complete"}, {"state": "incomplete"}, {"state": "complete"}]}"#),
    ("info torque --axes 3", &["4.7.12-reference"],
        r#"{"of": "max", "axes": [{"axis_number": 3, "torque_percent": 20}]}"#),
    ("info torque --of rated --axes 3", &["4.7.18-reference"],
        r#"{"axes": [{"axis_number": 3, "torque_percent": 100}]}"#),
    ("clock get", &["4.7.13-reference", "4.7.14-reference"], r#"{"time": "2014-01-01T10:59:59"}"#),
    ("info slots", &["4.7.15-reference"], r#"{"slots": [{"slot": 1, "module": "EtherNet/IP", "code": "0x0401"},
        {"slot": 2, "module": "DIO NPN general-purpose input"}, {"slot": 3},
        {"slot": 4, "module": "none", "code": "0x0000"}]}"#),
    ("info slots --controller 1", &["4.7.15-reference"], ""),
    ("info inch", &["4.7.16-reference"], r#"{"amount_pulses": 100, "amount_mm": 0.1}"#),
    ("info alarm", &["4.7.17-reference"], r#"{"alarms": [{"code": "2.334", "place": "robot 1"}]}"#),
    ("clock set 2014-02-02", &["4.8.1-set"], r#"{"items": [{"name": "date", "new": "2014-02-02"}]}"#),
    ("clock set 08:45", &["4.8.2-set"], ""),
    ("clock set 2014-02-02T08:45:00", &["4.8.2-set", "4.8.1-set"], r#"{"items": [
        {"name": "date", "old": null, "new": "2014-02-02", "written": true},
        {"name": "time", "old": null, "new": "08:45:00", "written": true}]}"#),
    ("alarm reset", &["4.8.3-reset"], r#"{"alarm": false, "servo_on": false}"#),
];

/// Words that a command line sends, without the reads before a change.
fn sent(line: &[&str]) -> Vec<Vec<String>> {
    let written = written(line).unwrap();
    if written.is_empty() { words(line).unwrap() } else { written }
}

#[test]
fn lines_become_the_words_and_the_reports_of_the_examples() {
    let examples = EXAMPLES.iter().map(|(line, ids, report)| (*line, (*ids, *report)));
    for_lines(examples, |line, words, (ids, expected)| {
        assert_eq!(sent(words), ids.iter().copied().map(example).collect::<Vec<_>>(), "{line}");
        if !expected.is_empty() {
            let (report, expected) = (read_in_turn(ids, words), serde_json::from_str(expected).unwrap());
            assert!(has_all(&report, &expected), "{line}: {report}");
        }
    });
}

/// Command lines with the first words of each command that they send. `_` stands for any word.
const SENT: &[(&str, &[&str])] = &[
    ("speed auto 100% --unit 2", &["0x2039 0x0000 0x0064"]),
    ("torque-limit --axis 4 100% --unit 2", &["0x2048 0x0000 0x0008 0x0064"]),
    ("inch-distance 10000 --unit 4", &["0x4027 0x0000 0x2710"]),
    ("teach --point 29999 --in mm --unit 2", &["0x2028 0x0000 0x752F 0x0001"]),
    ("shift select 39 --unit 2", &["0x203B 0x0000 0x0027"]),
    ("hand select 31", &["0x003C 0x0000 0x001F"]),
    ("arm select left --unit 4", &["0x403D 0x0000 0x0001"]),
    ("servo on", &["0x0034 0x0000 0x0000"]),
    ("servo off --axis 3 --unit 2", &["0x2035 0x0000 0x0004"]),
    ("motor off", &["0x0041"]),
    ("motor pwr", &["0x0043"]),
    (
        "status-reset",
        &["0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 \
           0x0000"],
    ),
    (
        "param get TOLE.1,TOLE.4,260.1,260.4 --unit 2",
        &[
            "0x2224 0x0000 0x0103 0x0001",
            "0x2224 0x0000 0x0103 0x0008",
            "0x2224 0x0000 0x0104 0x0001",
            "0x2224 0x0000 0x0104 0x0008",
        ],
    ),
    ("param set 2 500", &["_ _ 0x0002 0x0000 0x01F4"]),
    ("point-calc sub 100 --from 1", &["0x0235 0x0000 0x0001 0x0064"]),
    ("point-calc element 7 --element 6 --pulse -1", &["0x0240 0x0000 0x0007 0x0020 0xFFFF 0xFFFF"]),
    ("program run --all-programs", &["0x0402 0x0000 0x0000 0x0000"]),
    ("program step --task 3", &["0x0403 0x0002 0x0000 0x0003"]),
    ("program skip --name A", &["0x0404 0x0004 0x0000 0x0000"]),
    ("program next --program 100", &["0x0405 0x0001 0x0064 0x0000"]),
    ("program reset --all-programs", &["0x0406 0x0000 0x0000 0x0000"]),
    ("program select --name A --priority 1", &["0x0401 0x0004 0x0000 0x0000"]),
    ("comment set 1 ''", &["_ _ _ _ 0x0000"]),
    ("hand-data set 1 3 10000 -2 5 1", &["0x3110 _ _ _ _ _ _ _ _ _ 0x0001"]),
    ("point set 0 --mm 1,-2.5,0,0 --hand left", &["0x0100 0x0005 0x0000 0x0000 0x03E8 0x0000 0xF63C 0xFFFF"]),
    ("info speed --unit 4", &["0x450A"]),
    ("info line 1..8", &["0x0508 0x0000 0x0000"]),
    ("info tasks", &["_ _ 0x0000", "_ _ 0x0001"]),
    ("info tasks 9", &["_ _ 0x0001"]),
    ("info line 8..9", &["_ _ 0x0000", "_ _ 0x0001"]),
    ("abs-reset --axis 3 --move + --unit 2", &["0x2030 0x0000 0x0004"]),
    ("abs-reset --axis 3 --unit 2", &["0x2031 0x0000 0x0004"]),
    ("drive --axis 4 --to -0.001 --unit 2 --speed-of-max 100", &["0x2012 0x0003 0x0008 0x2710 0xFFFF 0xFFFF"]),
    ("drivei --axis 1 --by-pulse -5", &["0x0017 0x0001 0x0001 0x0000 0xFFFB 0xFFFF"]),
    ("inch tool 4 minus --unit 2 --report pulse", &["0x2026 0x4000 0x0088 0x0000"]),
    // The numbers are in the order of the axes as typed: 1.5 is for axis 3.
    (
        "--unit 2 move --to 1.5,-2,3 --axes 3,1,2 --hand left",
        &["0x2006 0x0011 0x0007 0x0000 0xF830 0xFFFF 0x0BB8 0x0000 0x05DC 0x0000"],
    ),
    (
        "--unit 2 move --to 3=1.5,1=-2,2=3 --hand left",
        &["0x2006 0x0011 0x0007 0x0000 0xF830 0xFFFF 0x0BB8 0x0000 0x05DC 0x0000"],
    ),
    ("move --to-pulse 4=7", &["_ _ 0x0008 _ _ _ _ _ _ _ 0x0007"]),
    ("move --point 1 --unit=4 --speed-of-max 12.34", &["0x4001 0x0002 0x0000 0x04D2 0x0001"]),
    ("origin", &["0x0032 0x0000 0x0000"]),
    ("origin --unit 2 --only incremental", &["0x2032 0x0002 0x0000"]),
    ("origin --only absolute", &["0x0032 0x0004 0x0000"]),
    ("origin --only incomplete", &["0x0032 0x0008 0x0000"]),
    ("origin --axis 4 --unit 3", &["0x3033 0x0000 0x0008"]),
    (
        "pallet --pallet 39 --position 32767 --accel 1 --decel 100",
        &["0x0018 0x0060 0x0000 0x0000 0x0027 0x7FFF _ _ _ _ 0x0001 0x0064"],
    ),
    ("push --axis 2 --to 1", &["0x004C 0x0001 0x0002 0x0000"]),
    (
        "--unit 3 push --axis 2 --to-pulse -1 --force -1000 --time 32.767s --speed 1",
        &["0x304D 0x0185 0x0002 0x0001 0xFFFF 0xFFFF _ _ 0xFC18 0x7FFF"],
    ),
    (
        "movei --by -1 --axes 4 --hand right --unit 3",
        &["0x300E 0x0009 0x0008 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0x0000 0xFC18 0xFFFF"],
    ),
];

#[test]
fn lines_send_these_words() {
    for_lines(SENT.iter().copied(), |line, words, expected| {
        let sent = sent(words);
        assert_eq!(sent.len(), expected.len(), "{line}: {sent:?}");
        for (sent, expected) in sent.iter().zip(expected) {
            let fits = sent.iter().zip(expected.split(' ')).all(|(sent, word)| word == "_" || sent == word);
            assert!(fits, "{line}: {sent:?}, not {expected}");
        }
    });
}

#[test]
fn ranges_send_a_command_for_each_row() {
    let cases =
        [("param get TOLE", 4), ("param list", 1 + 12 * 4), ("point get 0..29", 30), ("var get SGI30..SGI31,SGR0", 3)];
    for_lines(cases, |line, line_words, count| assert_eq!(words(line_words).unwrap().len(), count, "{line}"));
}

#[test]
fn questions_name_robot_target_and_speed() {
    let cases = [
        ("servo on --unit 3", "switch the servos of all axes of robot 3 on"),
        ("run", "run the robot program"),
        ("program run --all-programs", "run all programs"),
        ("program step --task 3", "run one line of the program of task 3"),
        ("raw --wi 0x42", "send motor-on: switch motor power and servos on"),
        ("eip set 4 150 3 0xFF01", "set class 0x04 (assembly), instance 150, attribute 3 to ff 01"),
        ("io pulse origin", "switch origin (SI(14)) on and off again"),
        ("io set 20=on stop=off", "switch SI(20) on, stop (SI(06)) off"),
        ("io set SIW2=5 20=on", "switch SIW(2) = 5, SI(20) on"),
        ("abs-reset --axis 1 --move -", "move axis 1 of robot 1 in minus direction to the nearest reset position"),
        ("drive --axis 3 --to 5.000 --speed 50 --unit 4", "move axis 3 of robot 4 to 5.000 mm (at 50 %)"),
        ("drivei --axis 3 --point 7", "move axis 3 of robot 1 by the distance of point 7 (at the program speed)"),
        (
            "inch cartesian 2 +",
            "inch axis 2 of robot 1 in plus direction in Cartesian coordinates (by the inching distance, at the \
             manual speed)",
        ),
        ("move --point 19 --speed 50", "move robot 1 to point 19 (all axes, at 50 %)"),
        (
            "--unit 2 move --to 1,2 --axes 2,1",
            "move robot 2 to axis 2: 1 mm, axis 1: 2 mm (axes 2, 1 alone, at the program speed)",
        ),
        (
            "move --to 4=90",
            "move robot 1 to axis 4: 90 mm (axis 4 alone, axes 1 and 2 do not move, at the program speed)",
        ),
        (
            "move --point 3 --axes 4",
            "move robot 1 to point 3 (axis 4 alone, but a SCARA may also move axes 1 and 2 to the point, at the \
             program speed)",
        ),
        (
            "move --to-pulse 1,2,3,4",
            "move robot 1 to axis 1: 1 pulses, axis 2: 2 pulses, axis 3: 3 pulses, axis 4: 4 pulses (all axes, at \
             the program speed)",
        ),
        (
            "move --point 5 --arch 3:0 --arch-unit pulse --speed-of-max 0.5",
            "move robot 1 to point 5 in an arch over axis 3 at 0 pulses (all axes, at 0.5 % of the maximum)",
        ),
        (
            "move --point 1,2 --circular --speed 9mm/s",
            "move robot 1 over point 1 to point 2 in an arc (all axes, at 9 mm/s)",
        ),
        (
            "movei --by 1,-2 --axes 1,2 --speed 5 --unit 2",
            "move robot 2 by axis 1: 1 mm, axis 2: -2 mm (axes 1, 2 alone, at 5 %)",
        ),
        ("origin", "return all axes of all robots to origin"),
        ("origin --unit 2", "return all axes of robot 2 to origin"),
        ("origin --only incomplete", "return the axes without known origin of all robots to origin"),
        ("origin --axis 1", "return axis 1 of robot 1 to origin"),
        (
            "pallet --pallet 1 --position 21 --arch 3:-5 --speed 70",
            "move robot 1 to position 21 of pallet 1 in an arch over axis 3 at -5 mm (all axes, at 70 %)",
        ),
        (
            "push --axis 3 --to 10 --speed 50 --force 100 --time 100ms",
            "push with axis 3 of robot 1 towards 10 mm (at 50 %, with 100 % of the rated torque, for 100ms)",
        ),
        (
            "jog tool 3 + --for 1.5s --unit 2",
            "jog axis 3 of robot 2 in plus direction in tool coordinates (for 1500ms, at the manual speed)",
        ),
    ];
    for_lines(cases, |line, words, text| assert_eq!(intent(words), text, "{line}"));
    assert!(intent(&["abs-reset", "--axis", "1", "--unit", "3"]).contains("axis 1 of robot 3"));
    assert!(intent(&["jog", "pulse", "1", "-"]).contains("(until Ctrl-C, at the manual speed)"));
}

/// Lines whose risk depends on their arguments. `gate.rs` has the risk of each command.
#[test]
fn arguments_decide_the_risk() {
    let cases = [
        ("io set 20=on auto-start=on", Risk::Motion),
        ("io set auto-start=off", Risk::Write),
        ("io set SIW2=5", Risk::Write),
        ("io pulse origin", Risk::Motion),
        ("abs-reset --axis 1 --move -", Risk::Motion),
        ("eip set 4 150 3 00", Risk::Motion),
        ("eip get 4 150 3", Risk::Read),
    ];
    for_lines(cases, |line, words, expected| assert_eq!(risk(words), expected, "{line}"));
}

/// Command lines with a part of the message that rejects them.
const REJECTED: &[(&str, &str)] = &[
    ("speed manual 0", "speed_percent"),
    ("speed manual 101", "speed_percent"),
    ("speed manual 5.5", "speed_percent"),
    ("speed manual fast", "speed_percent"),
    ("speed jog 5", "manual, auto, program"),
    ("torque-limit --axis 1,2 50", "select exactly 1"),
    ("torque-limit --axis 1 0", "allowed: 1 to 100 %"),
    ("inch-distance 0", "inching_amount"),
    ("inch-distance 10001", "inching_amount"),
    ("inch-distance 0.1", "inching_amount"),
    ("inch-distance 1mm", "inching_amount"),
    ("teach --point 30000 --in mm", "0 to 29999"),
    ("teach", "POINT"),
    ("shift select 40", "allowed: 0 to 39"),
    ("hand select 32", "allowed: 0 to 31"),
    ("arm select both", "right, left"),
    ("servo on --axis 1,2", ""),
    ("servo brake", "free"),
    ("motor on --unit 1", "--unit"),
    ("run --unit 1", "--unit"),
    ("param set TOLE.3 16385", "16385 is out of range for TOLE; allowed: 1 to 16384 pulses"),
    ("param set PSHFRC.3 -1001", "allowed: -1000 to 1000"),
    ("param set TOLE.1 1.5", "value"),
    ("param set TOLE 1", "'TOLE' selects several parameters"),
    ("param set WEIGHT.1 1", "WEIGHT belongs to the robot, not to an axis"),
    ("param set TOLE.1-2 1", "selects several"),
    ("param get TOLL.1", "259 = TOLE"),
    ("param get 261", "261"),
    ("param get TOLE.5", "the axes are 1 to 4"),
    ("point-calc copy 1", "--to"),
    ("point-calc copy 30000 --to 1", "allowed: 0 to 29999"),
    ("point-calc pallet 40 --place 1 --to 1", "allowed: 0 to 39"),
    ("point-calc pallet 1 --place 0 --to 1", "allowed: 1 to 32767"),
    ("point-calc element 1 --element 7 --mm 1", "must be from 1 to 6"),
    ("point-calc element 1 --element 1,2 --mm 1", "select exactly 1"),
    ("point-calc element 1 --element 1", "--mm"),
    ("point-calc element 1 --element 1 --mm 1 --pulse 1", "cannot be used with"),
    ("point-calc element 1 --element 1 --pulse 1.5", "value"),
    ("point-calc shift-element 1 --element 5 --mm 1", "must be from 1 to 4"),
    ("port set DI2 1", "DI are inputs"),
    ("port set DO1 1", "DO1: 1 is out of range; allowed: 2 to 7, 10 to 17, 20 to 27"),
    ("port set DO2 256", "0 to 255"),
    ("port set DO2.9 1", "bits 0 to 7"),
    ("port set DO2.1 2", "allowed: 0 to 1"),
    ("program run", "--all-programs"),
    ("program step --all-programs", "--all-programs"),
    ("program run --program 1 --task 1", "cannot be used with"),
    ("program select --program 1", "--priority"),
    ("program select --task 1 --priority 1", "--program"),
    ("program select --program 1 --task 17 --priority 1", "1..=16"),
    ("program run --program 101", "allowed: 1 to 100"),
    ("program run --task 0", "allowed: 1 to 16"),
    ("program run --name abc", "A-Z, 0-9 and _"),
    ("program select --program 1 --priority 65", "allowed: 1 to 64"),
    ("raw --wi 0x501 --unit 1", ""),
    ("raw --wi 0x0999", "0x0999 is not a remote command code"),
    ("raw --wi 1,0xC000,0,0,19", "alarm 4.202"),
    ("raw --wi 0x406,0x100", "WI1"),
    ("var set SGI1 1.5", "value"),
    ("var set SGI1 2147483648", ""),
    ("var set SGR1 inf", ""),
    ("var set SGI32 1", "SGI32"),
    ("var div SGI1 0", "division by 0"),
    ("var div SGR1 -0.0", "division by 0"),
    ("var add SGI1 SGX1", "SGX1"),
    ("comment set 1 0123456789ABCDEFG", "allowed: up to 16 ASCII characters"),
    ("comment set 1 Größe", "allowed: up to 16 ASCII characters"),
    ("comment set 1 'a\tb'", "allowed: up to 16 ASCII characters"),
    ("hand-data get 1 --unit 3", ""),
    ("hand-data set 1 1 10.5 0 0 0", "data_1"),
    // Ambiguous: 10 or 10000.
    ("hand-data set 1 1 10.000 0 0 0", ""),
    ("pallet-data set 1 256 128 1 1", "X times Y times Z is 32768; a pallet has 1 to 32767"),
    ("pallet-data set 1 0 1 1 1", "X times Y times Z is 0"),
    ("pallet-data set 1 1 1 1 29996", "allowed: 0 to 29995"),
    ("pallet-data get 40", "allowed: 0 to 39"),
    ("point set 1", "--mm"),
    ("point set 1 --mm 1,2,3", "expected four numbers, one per axis, such as 10,-20,5,-18; 3 given"),
    ("point set 1 --mm 1,2,3,4 --pulse 1,2,3,4", "cannot be used with"),
    ("point set 1 --pulse 1,2,3,4 --hand left", "cannot be used with"),
    ("point set 30000 --mm 1,2,3,4", "allowed: 0 to 29999"),
    ("point set 1 --mm 1.0005,2,3,4", "axis_1"),
    ("point get 0..30000", "allowed: 0 to 29999"),
    ("point get 1 --unit 2", ""),
    ("shift-data set 40 1 2 3 4", "allowed: 0 to 39"),
    ("shift-data set 4 1", "4 values needed, but 1 typed"),
    ("info slots --controller 5", "allowed: 1 to 4"),
    ("info line 0", "[TASK]"),
    ("info line 17", "[TASK]"),
    ("info line 3..2", "[TASK]"),
    ("info line x", "[TASK]"),
    ("eip get 4", "INSTANCE"),
    ("eip get x 1 1", "not a number from 0 to 65535"),
    ("eip get 4 65536 1", "not a number from 0 to 65535"),
    ("eip get +4 1 1", "not a number"),
    ("eip get 4 150 3 --unit 1", "--unit"),
    ("eip set 4 1 3", "HEX"),
    ("eip set 4 1 3 0", "not valid hexadecimal data"),
    ("eip set 4 1 3 ''", "not valid hexadecimal data"),
    ("io set", "SIGNAL=STATE"),
    ("io set 20", "servo-on=on"),
    ("io set 20=maybe", "use on or off"),
    ("io set 'SI(02)=on'", "reserved"),
    ("io pulse cpu-ok", "is not a valid signal"),
    ("io set SOW2=5", "only the controller sets SOW(2)"),
    ("io set SIW1=5", "belong to remote commands"),
    ("io set SIW2=65536", "out of range for SIW(2)"),
    ("abs-reset --axis none", "select exactly 1"),
    ("abs-reset", "--axis"),
    ("drive --axis 1,2 --to 5", "axes: 2 selected; select exactly 1"),
    ("drive --axis 5 --to 5", "must be from 1 to 4"),
    ("drive --axis X --to 5", "'X' is not a valid list"),
    ("drive --axis 1 --point 30000", "allowed: 0 to 29999"),
    ("drive --axis 1 --to 3000000", "target"),
    ("drive --to 5", "error"),
    ("drive --axis 1", "error"),
    ("drivei --axis 1 --by 0.0001", "distance"),
    ("drivei --axis 1 --by 1 --speed 0", "allowed: 1 to 100 %"),
    ("drivei --axis 1 --by 1 --speed 10mm/s", "a linear or circular move"),
    ("drivei --axis 1 --to 5", "error"),
    ("inch pulse 1,2 +", "select exactly 1"),
    ("inch joint 1 +", "pulse, cartesian, tool"),
    ("move --to 1,2,3", "3 numbers for 4 axes"),
    ("move --to 1,2 --axes 1", "2 numbers for 1 axes"),
    ("move --to 1 --axes 5", "axes from 1 to 4"),
    ("move --to 1,2 --axes 1,1", "axis 1 appears twice"),
    ("move --to 1=1,1=2", "axis 1 appears twice"),
    ("move --to 1=1,2", "some numbers have an axis"),
    ("move --to 1=1 --axes 1", "typed twice: with --axes"),
    ("move --to 5=1", "'5' is not a valid axis"),
    ("move --to 1.0005,2,3,4", "axis_1"),
    ("move --point 30000", "point: 30000 is out of range; allowed: 0 to 29999"),
    ("move --point 1 --speed 101", "speed_percent: 101 is out of range; allowed: 1 to 100 %"),
    ("move --point 1 --speed-of-max 0.001", "speed_of_max_percent"),
    ("move --point 1 --speed 100mm/s", "needs a linear or circular move"),
    ("move --point 1 --linear --speed 1001mm/s", "allowed: 1 to 1000 mm/s"),
    ("move --point 1 --circular", "two points"),
    ("move --point 1,2", "one point"),
    ("move --point 1 --arch 1,2:5", "arch_axis"),
    ("move --point 1 --arch 1:5 --accel 5", "move-arch has neither --accel"),
    ("move --point 1 --accel 0", "accel_percent: 0 is out of range; allowed: 1 to 100 %"),
    ("move", "--point"),
    ("move --point 1 --to 1,2,3,4", "cannot be used with"),
    ("move --to 1,2,3,4 --linear", "cannot be used with"),
    ("move --to-pulse 1,2,3,4 --arch 1:1", "cannot be used with"),
    ("move --point 1 --linear --arch 1:1", "cannot be used with"),
    ("move --point 1,2 --circular --axes 1", "cannot be used with"),
    ("move --point 1 --arch-start 1", "--arch"),
    ("move --point 1 --arch 5", "such as 3:10.0"),
    ("move --point 1 --hand left", "cannot be used with"),
    ("move --point 1 --unit 5", "0..=4"),
    ("movei --by 1,2", "2 numbers for 4 axes"),
    ("movei --by-pulse 1.5,2,3,4", "axis_1"),
    ("movei --point 30000", "out of range"),
    ("movei --point 1 --speed 9mm/s", "a linear or circular move"),
    ("movei --by 1,2,3,4 --decel 10", "movei-mm has neither"),
    ("movei", "error"),
    ("movei --by 1 --linear", "error"),
    ("movei --point 1 --hand left", "error"),
    ("origin --axis 1,2", "select exactly 1"),
    ("origin --axis 1 --only absolute", "cannot be used with"),
    ("pallet --pallet 40 --position 1", "pallet: 40 is out of range; allowed: 0 to 39"),
    ("pallet --pallet 0 --position 0", "work_position: 0 is out of range; allowed: 1 to 32767"),
    ("pallet --pallet 0 --position 1 --arch 3:1 --accel 50", "pallet-arch has neither"),
    ("push --axis 1 --to 1 --force 1001", "push_force_percent: 1001 is out of range; allowed: -1000 to 1000 %"),
    ("push --axis 1,3 --to 1", "select exactly 1"),
    ("push --axis 1 --to 1 --time 100", "not 100s"),
    ("push --axis 1 --to 1 --time 0s", "not 0s"),
    ("push --axis 1 --to 1 --time 1.5ms", "not 0.0015s"),
    ("push --axis 1 --to 1 --time a", "is not a valid duration"),
    ("jog tool 5 +", "must be from 1 to 4"),
    ("jog tool 1,2 +", "select exactly 1"),
    ("jog pulse 1", "<DIRECTION>"),
    ("jog pulse 1 + --for 0s", "is zero"),
    ("jog pulse 1 + --no-wait", "--no-wait"),
];

#[test]
fn wrong_arguments_are_rejected_before_a_command_is_sent() {
    rejects(plan, REJECTED.iter().copied());
    assert!(words(&["comment", "set", "1", "0123456789ABCDEF"]).is_ok());
}

/// Command lines for the commands that no line of the other tables sends.
const OTHERS: &[&str] = &[
    "var add SGI1 SGI2",
    "var sub SGI1 1",
    "var sub SGI1 SGI2",
    "var mul SGI1 1",
    "var div SGI1 1",
    "var div SGI1 SGI2",
    "alarm history 1",
];

#[test]
fn every_remote_command_has_a_line() {
    let lines = EXAMPLES.iter().map(|(line, ..)| *line).chain(SENT.iter().map(|(line, _)| *line));
    let lines = lines.chain(OTHERS.iter().copied()).chain(super::motion::tests::EXAMPLES.iter().map(|(_, line)| *line));
    let row = |words: &[String]| Row::from_word(u16::from_str_radix(&words[0][2..], 16).unwrap()).unwrap();
    let mut reached = BTreeSet::new();
    for line in lines {
        let line = words_of(line);
        let line: Vec<&str> = line.iter().map(String::as_str).collect();
        reached.extend(words(&line).unwrap().iter().map(|words| row(words).command));
    }
    let missing: Vec<Command> = ROWS.iter().map(|row| row.command).filter(|row| !reached.contains(row)).collect();
    assert_eq!(missing, [], "no command line sends these");
}

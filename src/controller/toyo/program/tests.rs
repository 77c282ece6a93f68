use super::*;
use crate::toyo::request;
use crate::toyo::table::instructions::INSTRUCTIONS;

fn texts(text: &str) -> Vec<String> {
    let checked = check(text.as_bytes(), MAX_STEPS);
    let program = checked.program.unwrap_or_else(|| panic!("{text}: {:?}", checked.findings));
    program.steps.iter().map(Step::text).collect()
}

fn findings(text: impl AsRef<[u8]>) -> Vec<String> {
    check(text.as_ref(), MAX_STEPS).findings.iter().map(ToString::to_string).collect()
}

/// The only finding for a program of this line and END.
fn finding(line: &str) -> String {
    let found = findings(format!("{line}\nEND\n"));
    assert_eq!(found.len(), 1, "{found:?}");
    found.into_iter().next().unwrap()
}

#[test]
fn short_forms_become_protocol_text() {
    for (short, whole) in [
        ("MOVP a PT=1 CN=0 S V=0 POST", "MOVP a PT=001 CN=00 S V=00 POST"),
        ("movp A pt=1 cn=0 s v=0 post", "MOVP a PT=001 CN=00 S V=00 POST"),
        ("mov i x=1 y=-2.5 z=+0 r=0 T V=10 pass", "MOV i X=+0001.00 Y=-0002.50 Z=+0000.00 R=+0000.00 T V=10 PASS"),
        ("CWIT CN1=5", "CWIT CN01= 0005"),
        ("CWIT CN01 <= 5", "CWIT CN01<=0005"),
        ("CWIT CN1 > 5", "CWIT CN01> 0005"),
        ("IN STN = 0 PN1 = .......1 and", "IN STN=0 PN01=.......1 AND"),
        ("\tOUTS TA=0 STN=0 PN1=1....... X >= -5", "OUTS TA=0 STN=0 PN01=1....... X>=-0005.00"),
        ("CNT+ CN1=1", "CNT+ CN01=0001"),
        ("TIM TM=1.5", "TIM TM=001.5"),
        ("SVOF all", "SVOF ALL"),
        ("TLMV x TT=8 TM=1 TE=on LE=OFF AE=off DD=ON", "TLMV X TT=08 TM=001.0 TE=ON LE=OFF AE=OFF DD=ON"),
    ] {
        assert_eq!(texts(&format!("{short}\nEND"))[0], whole);
    }
}

#[test]
fn the_sample_of_the_manual_is_parsed() {
    let sample = "SPD V=05\nMOVP a PT=001 CN=00 S V=00 POST\nOUT STN=0 PN01=.......1\nEND\n";
    assert_eq!(texts(sample).join("\n") + "\n", sample);
    let numbered: String = sample.lines().enumerate().map(|(at, line)| format!("{:04} {line}\n", at + 1)).collect();
    assert_eq!(texts(&numbered), texts(sample));
}

#[test]
fn labels_get_free_tags_in_text_order() {
    let text = "
        # TAG 1 is taken by a jump, 2 by a label.
        start:  NOP
        calc=2: mid:  NOP
        JMPC TAG=Mid CN1=5      ; any case
        LOOP GRP=1 THEN=start ELSE=last
        TAG TAG=3
        tag tag=last
        CAL TAG=1
        END
        TAG TAG=1
        RET
    ";
    let checked = check(text.as_bytes(), 20);
    let program = checked.program.unwrap();
    assert_eq!(checked.findings, []);
    let texts: Vec<_> = program.steps.iter().map(Step::text).collect();
    assert_eq!(
        texts,
        [
            "TAG TAG=004",
            "NOP",
            "TAG TAG=002",
            "TAG TAG=005",
            "NOP",
            "JMPC TAG=005 CN01= 0005",
            "LOOP GRP=01 THEN=004 ELSE=006",
            "TAG TAG=003",
            "TAG TAG=006",
            "CAL TAG=001",
            "END",
            "TAG TAG=001",
            "RET",
        ]
    );
    let labels: Vec<_> = program.labels.iter().map(|label| (label.name.as_str(), label.tag, label.step)).collect();
    assert_eq!(labels, [("start", 4, 1), ("calc", 2, 3), ("mid", 5, 4), ("last", 6, 9)]);
    assert_eq!(program.steps[8].line, 8);
}

#[test]
fn errors_have_a_position_and_a_suggestion() {
    for (line, expected) in [
        ("MOVE a", "line 1, column 1: error: unknown instruction 'MOVE' (did you mean MOV?)"),
        ("  xyzzy", "line 1, column 3: error: unknown instruction 'xyzzy'"),
        (
            "MOVP a PT=1000 CN=0 S V=0 POST",
            "line 1, column 11: error: point: 1000 is out of range (a number, 0 to 999)",
        ),
        (
            "MOVP a XT=1 CN=0 S V=0 POST",
            "line 1, column 8: error: PT= is expected, not 'XT=1' (write MOVP a|i PT=<point> CN=<counter> S|T \
             V=<speed> POST|PASS)",
        ),
        ("CNT CN1", "line 1, column 8: error: = is missing (write CNT CN<counter>=<count>)"),
        ("CNT CN1=", "line 1, column 9: error: count is missing: a number, 0 to 9999 (write CNT CN<counter>=<count>)"),
        ("HOME now", "line 1, column 6: error: unexpected text 'now' (write HOME)"),
        ("SVON W", "line 1, column 6: error: axes: 'W' is not ALL, X, Y, Z or R"),
        (
            "OUT STN=0 PN1=.......2",
            "line 1, column 15: error: data: '.......2' is not eight characters, each 0, 1 or .",
        ),
        ("JMP TAG=", "line 1, column 9: error: tag is missing: a number, 1 to 999, or a label (write JMP TAG=<tag>)"),
        ("JMP TAG=7", "line 1, column 9: error: the program has no tag 007 (a controller stops with error A1)"),
        ("JMP TAG=7x", "line 1, column 9: error: tag: '7x' is neither a valid tag (001 to 999) nor a label"),
        ("JMP TAG=1000", "line 1, column 9: error: tag: 1000 is out of range (a number, 1 to 999)"),
        ("pick: JMP TAG=pikc", "line 1, column 15: error: unknown label 'pikc' (did you mean pick?)"),
        ("1st: NOP", "line 1, column 1: error: '1st:' is not a valid step number"),
        (
            "to do: NOP",
            "line 1, column 1: error: 'to do' is not a valid label (a label begins with a letter, and contains \
             letters, digits, _ and -)",
        ),
        ("a=1000: JMP TAG=a", "line 1, column 1: error: the tag of label a must be a number from 1 to 999"),
        ("a: JMP TAG=a\nA: NOP", "line 2, column 1: error: label A already exists in line 1"),
        (
            "TAG TAG=5\nb=5: NOP",
            "line 2, column 1: error: tag 005 already exists in line 1 (a controller stops with error A2)",
        ),
        ("0001", "line 1, column 5: error: an instruction is missing after the step number"),
        (
            "0001 NOP\n0003 NOP",
            "line 2, column 1: error: step number 3 must be 0002: step numbers increase by one (instructions need no \
             step numbers)",
        ),
        (
            "RSMV a X=0 Y=0 Z=0 R=0 S V=0 POST",
            "line 1, column 1: warning: RSMV never stops at its position: POST has the effect of PASS",
        ),
        (
            "NOP\n0007 NOP",
            "line 2, column 1: warning: the step numbers of the file begin with 6, but its first instruction becomes \
             step 1",
        ),
        (
            "0005 NOP",
            "line 1, column 1: warning: the step numbers of the file begin with 5, but its first instruction becomes \
             step 1",
        ),
        (
            "ｍOV",
            "line 1, column 1: error: character '\\u{ff4d}' is not allowed here (this is a wide character: write 'm')",
        ),
        ("NOP \u{b}", "line 1, column 5: error: character '\\u{b}' is not allowed here"),
    ] {
        assert_eq!(finding(line), expected);
    }
}

#[test]
fn all_errors_are_reported_in_text_order() {
    let text = "JMP TAG=nowhere\nACC A=21\nMOV a X=9000 Y=0 Z=0 R=0 Q V=11 POST\nEMD\n";
    let messages = findings(text);
    let places: Vec<_> = messages.iter().map(|finding| finding.split(": ").next().unwrap().to_owned()).collect();
    assert_eq!(
        places,
        [
            "line 1, column 9",
            "line 2, column 7",
            "line 3, column 9",
            "line 3, column 26",
            "line 3, column 30",
            "line 4, column 1"
        ],
        "{messages:?}"
    );
    assert!(check(text.as_bytes(), 10).program.is_none());
    let endless = findings("EMD\n".repeat(1000));
    assert_eq!(endless.len(), 100);
    assert!(endless[99].contains("more errors"));
}

#[test]
fn suspicious_text_is_a_warning() {
    assert_eq!(findings("a: NOP\nJMP TAG=a"), [] as [&str; 0]);
    assert_eq!(
        findings("a: END\n"),
        ["line 1, column 1: warning: no step jumps to label a (if another program uses the tag of this label, write \
          the tag after the label, such as a=10:)",]
    );
    assert_eq!(
        findings("a=5: SPD V=1\n"),
        ["line 1, column 6: warning: the program has no end: SPD is its last instruction (add END)"]
    );
    assert_eq!(
        findings("END\nNOP\nOUT STN=0 PN1=1.......\nTAG TAG=1\nRET"),
        ["line 3, column 1: warning: the program never reaches this step: it does not continue after END"]
    );
    assert_eq!(
        findings("DEC D=1\nDEC D=2\nBRAC CN=1 OFS=10\nPSEL"),
        [
            "line 1, column 1: note: only KCA-25-M10, KCA-25-M40, KCA-25-M80 have DEC",
            "line 3, column 1: note: the target of BRAC depends on counters and inputs, and is not checked; this \
             applies to 2 steps",
        ]
    );
}

#[test]
fn what_would_stop_a_controller_is_a_warning() {
    let port = "line 1, column 1: warning: internal port 5 may not exist";
    let warnings = findings("INSP PN5=.......1 AND\nIOUT PN5=.......1\nEND\n");
    assert!(warnings.len() == 2 && warnings[0].starts_with(port), "{warnings:?}");
    assert!(findings("IOUT PN4=.......1\nEND\n").is_empty());
    let warnings = findings("MINI GRP=1\nMVM S GRP=1 V=0 POST DIST\nMVM S GRP=2 V=0 POST DIST\nEND\n");
    assert!(warnings.len() == 1 && warnings[0].starts_with("line 3"), "{warnings:?}");
    // A conditional jump can go both ways, so nothing here is out of reach.
    assert!(findings("JMPC TAG=1 CN1=5\nNOP\nTAG TAG=1\nEND\n").is_empty());
    // And the RET behind such a jump can be reached without a call.
    let warnings = findings("JMPC TAG=1 CN1=5\nEND\nTAG TAG=1\nRET\n");
    assert!(warnings.len() == 1 && warnings[0].contains("without a call"), "{warnings:?}");
}

#[test]
fn references_say_how_a_step_uses_an_object() {
    let text = "CNT CN1=5\nINPC STN=0 PN=2 CN=3\nTIMP TN1=1.5\nCNT+ CN2=1\nCNT- CN2=1\nCWIT CN1=5\n\
                go: OUT STN=0 PN1=.......1\nJMP TAG=go\nEND\n";
    let checked = check(text.as_bytes(), MAX_STEPS);
    let program = checked.program.unwrap_or_else(|| panic!("{:?}", checked.findings));
    let found: Vec<String> = program
        .references()
        .flat_map(|(line, found)| found.into_iter().map(move |found| format!("{line} {:?} {}", found.role, found.name)))
        .collect();
    let expected = [
        "1 Write CN01",
        "2 Write CN03",
        "2 Read IN2",
        "3 Write TN1",
        "4 Update CN02",
        "5 Update CN02",
        "6 Read CN01",
        "7 Label go",
        "7 Write OUT1",
        "7 Write OUT1.1",
        "8 Jump go",
    ];
    assert_eq!(found, expected);
}

#[test]
fn objects_are_found_under_the_names_that_people_type() {
    for (typed, name) in [
        ("cn5", "CN05"),
        ("out1.3", "OUT1.3"),
        ("stn1.out2", "STN1.OUT2"),
        ("t2.5", "T2.5"),
        ("tag=5", "TAG=005"),
        ("TAG5", "TAG=005"),
        // A label keeps its letters.
        ("tank", "tank"),
        ("t.x", "t.x"),
    ] {
        assert_eq!(name_of(typed), name);
    }
}

#[test]
fn a_program_must_fit_its_task() {
    let text = "NOP\nHOME\nhere: END\n";
    let messages_for = |room| {
        let checked = check(text.as_bytes(), room);
        checked.errors().map(ToString::to_string).collect::<Vec<_>>()
    };
    assert_eq!(messages_for(4), [] as [&str; 0]);
    assert_eq!(
        messages_for(3),
        ["line 3, column 7: error: step 4 does not fit: the task can have at most 3 steps (the machine \
          parameter E22 (task-steps) sets this number)",]
    );
    assert_eq!(messages_for(0).len(), 1);
    let much = check("NOP\n".repeat(20_000).as_bytes(), usize::MAX);
    assert_eq!(much.errors().count(), 1);
}

#[test]
fn bytes_that_are_not_utf8_are_reported() {
    for (bytes, expected) in [
        (
            &b"END # \xE9t\xE9\nNOP # \xFF"[..],
            "line 1, column 7: error: byte E9 is not UTF-8; 2 lines have this error (save the file as UTF-8)",
        ),
        (b"NO\xE9", "line 1, column 3: error: byte E9 is not UTF-8 (save the file as UTF-8)"),
        (
            b"NOP\nE\0N\0D\0",
            "line 2, column 2: error: NUL character; the rest of the file is not read (this is not a text file, or \
             the file is UTF-16: save the file as UTF-8)",
        ),
        (b"\xFF\xFEE\0", "line 1, column 1: error: the file is UTF-16 (save the file as UTF-8)"),
        (b"\xEF\xBB\xBFEND", "line 1, column 1: note: the file begins with a byte order mark, which is ignored"),
        (b"HOME\r\nEND\r\n", "line 1, column 5: note: lines end with CR LF; the CR is ignored"),
        (b"HOME\rEND", "line 1, column 5: error: character '\\r' is not allowed here"),
        (b"", "line 1, column 1: error: the file contains no instruction"),
        (b"# nothing\n", "line 1, column 1: error: the file contains no instruction"),
    ] {
        assert_eq!(findings(bytes), [expected]);
    }
}

fn whole(is_numbered: bool) -> Style {
    Style { first: 1, is_whole: true, is_numbered }
}

#[test]
fn a_part_is_listed_with_its_numbers() {
    let steps = ["JMP TAG=003", "TAG TAG=003", "NOP"].map(|text| request::instruction(text).unwrap());
    let style = Style { first: 10, is_whole: false, is_numbered: true };
    let listing = listing(&steps, style, &Rows::new());
    assert_eq!(listing.text, "0010  JMP TAG=003  # tag 003 is step 11\n0011  TAG TAG=003\n0012  NOP\n");
    assert_eq!(listing.left_out, 0);
    let unread = Unread::from([(1, "no answer".to_owned()), (2, "no answer".to_owned())]);
    let text = listing_with(&steps, &unread, style, &Rows::new()).text;
    assert!(text.contains("# steps 11 to 12 were not read: no answer"), "{text}");
    let text = listing_with(&steps, &Unread::from([(2, "no answer".to_owned())]), style, &Rows::new()).text;
    assert!(text.contains("# step 12 was not read: no answer"), "{text}");
}

#[test]
fn a_listing_reads_back() {
    let steps: Vec<Record> = INSTRUCTIONS
        .iter()
        .map(|row| {
            let values = row.layout.fields.iter().map(least);
            row.layout.record(values.collect()).unwrap()
        })
        .chain(["END", "NOP", "NOP"].map(|text| request::instruction(text).unwrap()))
        .collect();
    for numbered in [false, true] {
        let listing = listing(&steps, whole(numbered), &Rows::new());
        assert_eq!(listing.left_out, 2);
        let program = check(listing.text.as_bytes(), MAX_STEPS).program.unwrap();
        assert_eq!(program.steps.len(), steps.len() - 2);
        let same = program.steps.iter().zip(&steps).filter(|(step, record)| step.record == **record).count();
        // All steps are equal except RSMV, whose arrival mode is always PASS.
        assert_eq!(same, program.steps.len() - 1);
    }
}

#[test]
fn a_step_outside_the_manual_keeps_its_number_and_is_not_valid() {
    let steps: Vec<Record> = ["SPD V=05", "END"].map(|text| request::instruction(text).unwrap()).into();
    let steps = [&steps[..1], &[Record::unlisted("FOO X=1 #2")], &steps[1..]].concat();
    let text = listing(&steps, whole(false), &Rows::new()).text;
    assert_eq!(text, "SPD V=05\nFOO X=1 #2  # not in the manual\nEND\n");
    assert_eq!(findings(&text).len(), 1, "what is put is strict");
    let program = check_kept(text.as_bytes(), 10).program.unwrap();
    assert_eq!(program.steps.iter().map(|step| step.record.clone()).collect::<Vec<_>>(), steps);
    assert!(program.steps[1].record.emit().is_err());
}

/// A valid value of a field.
fn least(field: &crate::toyo::field::Field) -> crate::toyo::field::Value {
    use crate::toyo::field::{Form, Mask, Value};
    match field.form {
        Form::Number(number) => Value::Number(number.least),
        Form::Word(words) => Value::Word(words[0].text),
        _ => Value::Mask(Mask::default()),
    }
}

#[test]
fn a_listing_has_comments_for_table_rows() {
    let steps = ["SPD V=05", "MOVP a PT=001 CN=00 S V=00 POST", "JMP TAG=003", "TAG TAG=003", "END"]
        .map(|text| request::instruction(text).unwrap());
    assert_eq!(uses(&steps).into_iter().collect::<Vec<_>>(), [("T1", 1), ("T2", 5)]);
    let mut rows = Rows::new();
    for (id, row, text) in
        [("T1", 1, "T1 PT=001 X=+0100.00 Y=+0020.00 Z=+0000.00 R=+0000.00"), ("T2", 5, "T2 V05=0250.0")]
    {
        rows.insert((id, row), crate::toyo::table::Parameter::named(id).unwrap().layout.parse(text).unwrap());
    }
    assert_eq!(
        listing(&steps, whole(true), &rows).text,
        "\
0001  SPD V=05                         # speed 5: 250.0 mm/s
0002  MOVP a PT=001 CN=00 S V=00 POST  # point 1: x 100.00 mm, y 20.00 mm, z 0.00 mm, r 0.00 mm
0003  JMP TAG=003                      # tag 003 is step 4
0004  TAG TAG=003
0005  END
"
    );
    let nops = ["NOP", "NOP"].map(|text| request::instruction(text).unwrap());
    let empty = listing(&nops, whole(false), &rows);
    assert_eq!((empty.text.lines().next(), empty.left_out), (Some("NOP"), 1));
    assert_eq!(listing(&[], whole(false), &rows).text, "");
}

#[test]
fn five_thousand_steps_are_parsed() {
    let mut text = String::new();
    for step in 0..999 {
        text.push_str(&format!("label{step}: MOV a X={step} Y=0 Z=0 R=0 S V=1 POST\nJMPC TAG=label{step} CN1>=5\n"));
    }
    text.push_str(&"JMP TAG=label998\nNOP\n".repeat(1001));
    text.push_str("END\n");
    let checked = check(text.as_bytes(), 5000);
    assert_eq!(checked.errors().count(), 0, "{:?}", checked.errors().next());
    assert_eq!(checked.program.unwrap().steps.len(), 5000);
    let much = text.replace("label5:", "label5: label5b:");
    assert!(check(much.as_bytes(), 5000).errors().any(|finding| finding.message.contains("no free tag")));
}

#[test]
fn a_part_is_checked_with_the_tags_outside_it() {
    let around = |tags: Option<&[i32]>| Part { first: 100, tags: tags.map(|tags| tags.iter().copied().collect()) };
    let part = |text: &str, tags| check_part(text.as_bytes(), 10, &around(tags));
    let text = "here: CAL TAG=5\nJMP TAG=here\n";
    // The findings contain no missing END, because the END is outside the part.
    let checked = part(text, Some(&[1, 2, 5]));
    assert_eq!(checked.findings, []);
    let program = checked.program.unwrap();
    let texts: Vec<_> = program.steps.iter().map(Step::text).collect();
    assert_eq!(texts, ["TAG TAG=003", "CAL TAG=005", "JMP TAG=003"]);
    assert_eq!((program.labels[0].tag, program.labels[0].step), (3, 100));
    let messages = |checked: Checked| checked.findings.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(
        messages(part(text, Some(&[]))),
        ["line 1, column 15: error: the program has no tag 005 (a controller stops with error A1)"]
    );
    assert_eq!(
        messages(part("TAG TAG=5", Some(&[5]))),
        ["line 1, column 9: error: tag 005 already exists in a step before or after the steps of this file (a \
          controller stops with error A2)"]
    );
    assert!(part("JMP TAG=7\nTAG TAG=8", None).program.is_some(), "any tag may be around");
    assert_eq!(
        messages(check_part(b"0100 NOP\n0101 NOP", 1, &around(None))),
        ["line 2, column 6: error: step 101 does not fit: the task can have at most 100 steps (the \
          machine parameter E22 (task-steps) sets this number)"]
    );
    assert!(messages(part("0001 NOP", None))[0].ends_with("its first instruction becomes step 100"));
}

#[test]
fn a_file_of_another_type_gives_one_error() {
    let points = format!("name,x_mm,y_mm,z_mm,r_mm\n{}", "1,2,3,4,5\n".repeat(50));
    assert_eq!(
        findings(points),
        ["line 1, column 1: error: this is a CSV table, not a program (use `toyo point restore FILE` or \
          `toyo param restore FILE` to write the table)"]
    );
    assert_eq!(findings("\u{FEFF}\"Name\";\"x_mm\"\n").len(), 1);
    assert_eq!(findings("name: NOP\nEND\n").len(), 1, "a label may be called so");
}

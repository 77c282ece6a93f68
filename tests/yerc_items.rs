//! The yerc commands, tested with the built binary and a controller that refuses or corrupts some answers. Each item
//! has its own result.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::net::UdpSocket;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::wire::{ANSWER_BIT, AnswerFrame, Division, LAST_BLOCK, RequestFrame, Status};
use serde_json::{Value, json};

/// Answer to a request that replaces the answer of the simulator; `None` keeps the simulated answer.
type Spoil = fn(&RequestFrame<'_>) -> Option<Vec<u8>>;

/// A simulated controller on real ports, with some corrupted answers. It runs until the end of the tests.
fn controller(state: &str, spoil: Spoil) -> String {
    recording(state, spoil).0
}

/// Requests that a controller received, in order.
type Received = Arc<Mutex<Vec<Vec<u8>>>>;

/// A controller that also stores the requests that it receives.
fn recording(state: &str, spoil: Spoil) -> (String, Received) {
    let received = Received::default();
    let record = Received::clone(&received);
    let mut simulator = Simulator::new(Start::parse(state, |_| Err(String::new())).unwrap());
    let sockets = [Division::Robot, Division::File].map(|division| (division, UdpSocket::bind("127.0.0.1:0").unwrap()));
    let [robot, file] = [0, 1].map(|index: usize| sockets[index].1.local_addr().unwrap().port());
    thread::spawn(move || {
        let began = Instant::now();
        let mut peers = [None, None];
        let mut buffer = [0; 2048];
        for (_, socket) in &sockets {
            socket.set_read_timeout(Some(Duration::from_millis(1))).unwrap();
        }
        loop {
            for (index, (division, socket)) in sockets.iter().enumerate() {
                // A shorter datagram is for the process that had this port before.
                if let Ok((len @ 32.., from)) = socket.recv_from(&mut buffer) {
                    peers[index] = Some(from);
                    record.lock().unwrap().push(buffer[..len].to_vec());
                    match RequestFrame::parse(&buffer[..len]).ok().and_then(|request| spoil(&request)) {
                        Some(answer) => drop(socket.send_to(&answer, from).unwrap()),
                        None => simulator.receive(began.elapsed(), *division, from.port().into(), &buffer[..len]),
                    }
                }
            }
            while let Some(out) = simulator.transmit(began.elapsed()) {
                let index = usize::from(out.division == Division::File);
                if let Some(peer) = peers[index] {
                    sockets[index].1.send_to(&out.bytes, peer).unwrap();
                }
            }
        }
    });
    (format!("udp://127.0.0.1:{robot}?file_port={file}"), received)
}

fn answer(request: &RequestFrame<'_>, block: u32, status: Status, data: &[u8]) -> Vec<u8> {
    let RequestFrame { division, id, service, .. } = *request;
    AnswerFrame { division, ack: true, id, block, service: service | ANSWER_BIT, status, data }.emit()
}

#[expect(clippy::unnecessary_wraps, reason = "it stands where an answer may be left as it is")]
fn refused(request: &RequestFrame<'_>, code: u16) -> Option<Vec<u8>> {
    Some(answer(request, LAST_BLOCK, Status::refused(code), &[]))
}

/// Runs a command line. Returns the exit code, stdout and stderr, as JSON if possible.
fn run(folder: &Path, target: &str, words: &str) -> (i32, Value, Value) {
    let output = Command::new(env!("CARGO_BIN_EXE_armctl"))
        .args(["-t", target, "--json", "--timeout", "2s", "yerc"])
        .args(words.split_ascii_whitespace().map(|word| if word == "''" { "" } else { word }))
        .current_dir(folder)
        .env_clear()
        .env("HOME", folder)
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let json = |bytes: &[u8]| {
        serde_json::from_slice(bytes).unwrap_or_else(|_| {
            let text = String::from_utf8_lossy(bytes);
            text.lines()
                .last()
                .map_or(Value::Null, |line| serde_json::from_str(line).unwrap_or_else(|_| text.clone().into()))
        })
    };
    (output.status.code().unwrap(), json(&output.stdout), json(&output.stderr))
}

fn at_target(target: &str, words: &str) -> (i32, Value, Value) {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), target, words)
}

#[test]
fn refused_alarm_does_not_hide_others() {
    let alarms = "alarm = [{ code = 4315 }, { code = 4107 }, { code = 1300 }]";
    let target = controller(alarms, |request| {
        let is_slot_2 = matches!((request.command, request.instance), (0x70 | 0x30A, 2) | (0x71 | 0x30B, 1002));
        if is_slot_2 { refused(request, 0x2010) } else { None }
    });
    let (exit, list, _) = at_target(&target, "alarm list");
    let error = &list["data"]["alarms"][1]["error"];
    assert_eq!((exit, &list["ok"], &error["asked"]), (9, &json!(false), &json!("alarm slot 2")), "{list}");
    assert!(error["message"].as_str().unwrap().contains("0x30A (instance 2)"), "{error}");
    assert_eq!(list["data"]["alarms"].as_array().unwrap().len(), 3, "{list}");
    assert_eq!(list["data"]["alarms"][0]["ok"], true);
    assert_eq!(list["error"]["exit"], 9);

    let (exit, history, _) = at_target(&target, "alarm history --limit 3");
    let failed: Vec<&Value> =
        history["data"]["alarms"].as_array().unwrap().iter().filter(|alarm| alarm["ok"] == false).collect();
    assert_eq!((exit, failed.len()), (9, 1), "{history}");
    assert_eq!((&failed[0]["list"], &failed[0]["index"]), (&json!("monitor"), &json!(2)));
    assert_eq!(failed[0]["error"]["asked"], "monitor alarm 2");
    assert!(failed[0]["error"]["message"].as_str().unwrap().contains("0x30B (instance 1002)"), "{history}");

    let (exit, nothing, error) = at_target(&target, "alarm history --class monitor --from 2 --limit 1");
    assert_eq!((exit, nothing, &error["error"]["code"]), (3, Value::Null, &json!("0x2010")), "{error}");
}

#[test]
fn every_refusal_of_30a_falls_back_to_70() {
    const UNSUPPORTED_ANSWERS: [(&str, Spoil); 4] = [
        ("A001", |request| if request.command == 0x30A { refused(request, 0xA001) } else { None }),
        ("A002", |request| if request.command == 0x30A { refused(request, 0xA002) } else { None }),
        ("0x28", |request| plain(request, 0x28)),
        ("0x01", |request| plain(request, 0x01)),
    ];
    fn plain(request: &RequestFrame<'_>, code: u8) -> Option<Vec<u8>> {
        let status = Status { code, added_size: 0, added: 0 };
        (request.command == 0x30A).then(|| answer(request, LAST_BLOCK, status, &[]))
    }
    for (way, spoil) in UNSUPPORTED_ANSWERS {
        let (exit, list, _) = at_target(&controller("alarm = [{ code = 4315 }]", spoil), "alarm list");
        assert_eq!((exit, &list["data"]["alarms"][0]["code"]), (0, &json!("4315")), "{way}: {list}");
        assert_eq!(list["data"]["with_texts"], false, "{way}");
    }
}

#[test]
fn positions_and_hours_keep_partial_answers() {
    let target = controller("", |request| match (request.command, request.instance) {
        (0x75, 101) | (0x88, 110) => refused(request, 0x2010),
        _ => None,
    });
    let (exit, position, _) = at_target(&target, "position");
    assert_eq!((exit, &position["data"]["positions"][0]["joints"][0]["pulses"]), (9, &json!(0)), "{position}");
    assert_eq!(position["data"]["positions"][1]["error"]["asked"], "position of R1 (base)");
    assert!(position["error"]["message"].as_str().unwrap().contains("0x75 (instance 101)"), "{position}");
    let (exit, hours, _) = at_target(&target, "hours");
    let ok: Vec<&Value> = hours["data"]["times"].as_array().unwrap().iter().map(|time| &time["ok"]).collect();
    assert_eq!((exit, ok), (9, vec![&json!(true), &json!(true), &json!(false), &json!(true)]), "{hours}");
    let (exit, ..) = at_target(&target, "position --coordinates base");
    assert_eq!(exit, 3);
}

#[test]
fn reports_variables_as_typed() {
    let target = controller("", |_| None);
    let (exit, two, _) = at_target(&target, "var get B0 B300");
    assert_eq!((exit, &two["error"]["exit"]), (9, &json!(9)));
    let message = two["error"]["message"].as_str().unwrap();
    assert!(message.starts_with("1 of 2 failed: B300: the controller refused 0x7A (instance 300)"), "{message}");
    assert_eq!((&two["data"]["items"][0]["ok"], &two["data"]["items"][1]["ok"]), (&json!(true), &json!(false)));
    let (exit, three, _) = at_target(&target, "var get B0 B99 B100");
    assert_eq!((exit, &three["data"]["items"][2]["error"]["asked"]), (9, &json!("B100")));
    let (exit, nothing, error) = at_target(&target, "var get B300");
    assert_eq!((exit, nothing), (3, Value::Null));
    assert!(error["error"]["message"].as_str().unwrap().starts_with("B300: "), "{error}");
    let (exit, all, _) = at_target(&target, "var get B300 I300");
    assert_eq!((exit, &all["error"]["kind"]), (3, &json!("refused")));
    assert_eq!((&all["data"]["items"][0]["ok"], &all["data"]["items"][1]["ok"]), (&json!(false), &json!(false)));
}

#[test]
fn falls_back_to_single_reads_of_registers_and_signals() {
    let target = controller("registers = { 10 = 4660 }\nio = { 10010 = true }", |request| {
        match (request.command, request.instance) {
            (0x300 | 0x301, _) => Some(answer(request, LAST_BLOCK, Status { code: 8, added_size: 0, added: 0 }, &[])),
            (0x79, 12) => refused(request, 0x2110),
            _ => None,
        }
    });
    let (exit, registers, _) = at_target(&target, "register get 10..11");
    assert_eq!((exit, &registers["data"]["items"][0]["value"]), (0, &json!(4660)), "{registers}");
    let (exit, some, _) = at_target(&target, "register get 0xA..0xC");
    assert_eq!((exit, &some["data"]["items"][2]["error"]["asked"]), (9, &json!("M12")), "{some}");
    assert!(some["error"]["message"].as_str().unwrap().contains("0x79 (instance 12)"), "{some}");
    let (exit, signals, _) = at_target(&target, "io get 10010..10027");
    assert_eq!((exit, &signals["data"]["items"][0]["value"]), (0, &json!(true)), "{signals}");
    let (exit, set, error) = at_target(&target, "io set 27010=on 27030=on");
    assert_eq!((exit, &set["data"]["items"][1]["value"]), (0, &json!(true)), "{set} {error}");
}

#[test]
fn reports_items_written_beside_a_refusal() {
    let target = controller("", |request| if request.instance == 20 { refused(request, 0x2110) } else { None });
    let (exit, set, _) = at_target(&target, "register set 1=1 20=2 30=3");
    let items = set["data"]["items"].as_array().unwrap();
    let written: Vec<&Value> = items.iter().map(|item| &item["written"]).collect();
    assert_eq!((exit, written), (9, vec![&json!(true), &json!(false), &json!(true)]), "{set}");
    assert_eq!(items[1]["error"]["asked"], "M20");
    let message = set["error"]["message"].as_str().unwrap();
    assert!(message.starts_with("1 of 3 failed: M20: ") && message.contains("0x79 (instance 20)"), "{message}");
}

#[test]
fn omits_missing_axes() {
    for (state, axes) in
        [("", 6), ("robot_axes = 7", 7), ("trim_axes = true", 6), ("trim_axes = false\nrobot_axes = 7", 7)]
    {
        let target = controller(state, |_| None);
        for (words, field) in [
            ("position", "/data/positions/0/joints"),
            ("torque", "/data/torque_raw"),
            ("position-error", "/data/error_pulses"),
        ] {
            let (exit, data, _) = at_target(&target, words);
            let found = data.pointer(field);
            let count = found.and_then(Value::as_object).map(serde_json::Map::len);
            let count = count.or(found.and_then(Value::as_array).map(Vec::len));
            assert_eq!((exit, count), (0, Some(axes)), "{state}: {words}: {data}");
            assert_eq!(
                data.pointer("/data/positions/1/re_deg").is_some_and(Value::is_number),
                axes == 7 && words == "position"
            );
        }
    }
    // If the controller does not report which axes exist, the report has all eight axes.
    let untold = controller("", |request| if request.command == 0x74 { refused(request, 0x2150) } else { None });
    let (exit, data, _) = at_target(&untold, "torque");
    assert_eq!((exit, data["data"]["torque_raw"].as_object().map(serde_json::Map::len)), (0, Some(8)));
}

#[test]
fn single_word_of_a_position_rewrites_the_position() {
    // The manual does not list the service 0x10 for P variables (3.3.16).
    let target = controller("", |request| {
        if request.command == 0x7F && request.service == 0x10 { refused(request, 0xA001) } else { None }
    });
    let (exit, set, error) = at_target(&target, "var set P1.tool=0x2 P1.axis1=5 --yes");
    assert_eq!(exit, 0, "{error}");
    // Both assignments of the line change the same position, which is one item.
    let items = set["data"]["items"].as_array().unwrap();
    assert_eq!((items.len(), &items[0]["name"]), (1, &json!("P1")), "{set}");
    assert_eq!((&items[0]["old"]["tool"], &items[0]["new"]["tool"]), (&json!(0), &json!(2)), "{set}");
    let (_, get, _) = at_target(&target, "var get P1");
    let position = &get["data"]["items"][0]["value"];
    let text = position["text"].as_str().unwrap();
    assert!(text.starts_with("pulse:s=5,l=-2000,") && text.contains("tool=2"), "{text}");
    let (exit, _, error) = at_target(&target, "var set B0=1 P100.tool=2");
    assert_eq!(exit, 3, "{error}");
    assert!(error["error"]["message"].as_str().unwrap().contains("nothing was written"), "{error}");
    let (_, get, _) = at_target(&target, "var get B0");
    assert_eq!(get["data"]["items"][0]["value"], 0);
}

#[test]
fn garbage_in_a_transfer_is_malformed() {
    let target = controller("", |request| {
        let is_ack = request.division == Division::File && request.ack && request.service == 0x16;
        is_ack.then(|| vec![0xFF; 40])
    });
    let (exit, _, error) = at_target(&target, "file get TESTJOB.JBI");
    assert_eq!((exit, &error["error"]["kind"]), (5, &json!("malformed")), "{error}");
}

#[test]
fn parses_unusual_file_lists() {
    let target = controller("", |request| {
        let data: &[u8] = match (request.division, request.ack, request.data) {
            (Division::File, false, b"*.JBI") => b"A.JBI\nB.JBI \r\nC.JBI\rD.JBI\0\0\r\n",
            (Division::File, false, b"*.DAT") => return Some(answer(request, 1, Status::OK, &[b'A'; 479])),
            (Division::File, true, _) if request.block == 1 => &[b'A'; 479],
            _ => return (request.division == Division::File && request.ack).then(Vec::new),
        };
        let block = if request.ack { LAST_BLOCK | 2 } else { LAST_BLOCK | 1 };
        Some(answer(request, block, Status::OK, data))
    });
    let (exit, list, error) = at_target(&target, "file list");
    let names: Vec<&Value> = list["data"]["files"].as_array().unwrap().iter().map(|file| &file["name"]).collect();
    assert_eq!(
        (exit, names),
        (0, ["A.JBI", "B.JBI", "C.JBI", "D.JBI"].iter().map(|name| json!(name)).collect::<Vec<_>>().iter().collect()),
        "{error}"
    );
    let (exit, _, error) = at_target(&target, "file list --type dat");
    assert_eq!(exit, 5, "{error}");
    assert!(error["error"]["message"].as_str().unwrap().contains("958 bytes"), "{error}");
}

#[test]
fn filters_and_names_match_the_protocol() {
    let target = controller("[[file]]\nname = 'CELL.XYZ'\ntext = 'x'", |_| None);
    let folder = tempfile::tempdir().unwrap();
    for filter in ["''", "*.*"] {
        let (exit, list, error) = run(folder.path(), &target, &format!("file list --filter {filter}"));
        assert_eq!(exit, 0, "{filter}: {error}");
        let has = |name: &str| list["data"]["files"].as_array().unwrap().iter().any(|file| file["name"] == name);
        assert!(has("TESTJOB.JBI") && !has("CELL.XYZ"), "{filter}: {list}");
    }
    let (exit, _, error) = run(folder.path(), &target, "file get CELL.XYZ");
    assert_eq!(exit, 0, "{error}");
    let long = format!("{}.ABCDEF", "N".repeat(470));
    let (exit, _, error) = run(folder.path(), &target, &format!("file get {long} --dir -"));
    assert_eq!(exit, 2, "stdout and --json do not go together: {error}");
    let (exit, frames, error) =
        run(folder.path(), &target, &format!("file get {} --dry-run", "N".repeat(200) + ".ABC"));
    assert_eq!((exit, frames["data"]["frames"].as_array().map(Vec::len)), (0, Some(2)), "{error}");
}

#[test]
fn warns_about_a_renamed_job_and_verifies_a_plain_last_ack() {
    let target = controller("plain_last_ack = true", |_| None);
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("NEW.JBI"), "/JOB\r\n//NAME NEW\r\nNOP\r\nEND\r\n").unwrap();
    std::fs::write(folder.path().join("B.JBI"), "/JOB\r\n//NAME OTHER\r\nNOP\r\nEND\r\n").unwrap();
    let (exit, put, error) = run(folder.path(), &target, "file put NEW.JBI");
    assert_eq!((exit, &put["data"]["files"][0]["state"]), (0, &json!("done")), "{error}");
    let output = Command::new(env!("CARGO_BIN_EXE_armctl"))
        .args(["-t", &target, "yerc", "file", "put", "B.JBI", "--dry-run"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(told.contains("B.JBI has //NAME OTHER, but armctl sends it as B"), "{told}");

    let unlisted = controller("plain_last_ack = true", |request| {
        let is_list = request.division == Division::File && request.service == 0x32;
        if is_list { refused(request, 0x2110) } else { None }
    });
    let (exit, _, error) = run(folder.path(), &unlisted, "file put NEW.JBI --yes");
    assert_eq!(exit, 6, "{error}");
}

#[test]
fn can_ignore_the_date_in_a_header() {
    let target = controller("", |_| None);
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(run(folder.path(), &target, "file get TESTJOB.JBI").0, 0);
    let path = folder.path().join("TESTJOB.JBI");
    let job = String::from_utf8(std::fs::read(&path).unwrap()).unwrap();
    let other = job.replace("///DATE 2026/03/14 08:00", "///DATE 2027/01/01 09:30");
    assert_ne!(job, other);
    std::fs::write(&path, other).unwrap();
    let (exit, diff, _) = run(folder.path(), &target, "file diff TESTJOB.JBI --exact");
    assert_eq!((exit, &diff["data"]["files"][0]["ignored"]), (8, &json!([])), "{diff}");
    for line in ["file diff TESTJOB.JBI", "file diff TESTJOB.JBI --ignore-header"] {
        let (exit, diff, _) = run(folder.path(), &target, line);
        assert_eq!(exit, 0, "{diff}");
        let ignored = &diff["data"]["files"][0]["ignored"];
        assert_eq!((&diff["data"]["equal"], ignored), (&json!(true), &json!(["///DATE"])), "{diff}");
    }
    std::fs::write(
        &path,
        job.replace("///DATE 2026/03/14 08:00", "///DATE 2027").replace("TIMER T=0.50", "TIMER T=0.60"),
    )
    .unwrap();
    let (exit, diff, _) = run(folder.path(), &target, "file diff TESTJOB.JBI");
    assert_eq!((exit, diff["data"]["files"][0]["hunks"].as_array().map(Vec::len)), (8, Some(1)), "{diff}");
}

/// Whether a frame matches a line of a dry run. The id of the request may differ.
fn frames_shown(line: &Value, frame: &[u8]) -> bool {
    let shown = line["hex"].as_str().unwrap();
    let byte = |index: usize| shown.get(2 * index..2 * index + 2);
    let is_same = |(index, sent): (usize, &u8)| {
        index == 11 || byte(index).is_some_and(|digits| digits == "??" || digits == format!("{sent:02x}"))
    };
    shown.len() == 2 * frame.len() && frame.iter().enumerate().all(is_same)
}

#[test]
fn dry_run_shows_acknowledgements_and_repeated_reads() {
    fn typed_names(_: &RequestFrame<'_>) -> Option<Vec<u8>> {
        None
    }
    fn several_unknown(request: &RequestFrame<'_>) -> Option<Vec<u8>> {
        if (0x300..0x30A).contains(&request.command) { refused(request, 0xA000) } else { None }
    }
    fn several_refused(request: &RequestFrame<'_>) -> Option<Vec<u8>> {
        if (0x300..0x30A).contains(&request.command) { refused(request, 0x2010) } else { None }
    }
    let folder = tempfile::tempdir().unwrap();
    let job = format!("/JOB\r\n//NAME LONG\r\nNOP\r\n{}END\r\n", "NOP\r\n".repeat(300));
    std::fs::write(folder.path().join("LONG.JBI"), &job).unwrap();
    let lines: [(&str, Spoil); 9] = [
        ("file list --type jbi,prm", typed_names),
        ("file get TESTJOB.JBI --force", typed_names),
        ("file put LONG.JBI --verify --ignore-header --yes", typed_names),
        ("file put LONG.JBI --replace --yes", typed_names),
        ("var get B0..B9 P0..P2", several_unknown),
        ("var get B0..B3", several_refused),
        ("register get 0..3", several_refused),
        ("io get --group 1..4", several_refused),
        ("io set 27010=on 27020=on", several_refused),
    ];
    for (line, spoil) in lines {
        let (target, received) = recording("plain_last_ack = true", spoil);
        let (exit, dry, error) = run(folder.path(), &target, &format!("{line} --dry-run"));
        assert_eq!((exit, &dry["data"]["complete"]), (0, &json!(true)), "{line}: {error}");
        assert_eq!(received.lock().unwrap().len(), 0, "{line}: a dry run sends nothing");
        let shown = dry["data"]["frames"].as_array().unwrap();
        run(folder.path(), &target, line);
        let sent = received.lock().unwrap().clone();
        for (at, frame) in sent.iter().enumerate() {
            assert!(
                shown.iter().any(|line| frames_shown(line, frame)),
                "{line}: frame {at} is not shown: {frame:02x?}"
            );
        }
        let mut rest = sent.iter();
        for certain in shown.iter().filter(|line| line["depends_on"].is_null()) {
            assert!(rest.any(|frame| frames_shown(certain, frame)), "{line}: not sent, or in another order: {certain}");
        }
        assert!(shown.iter().any(|line| line["depends_on"].is_string()) && sent.len() > 1, "{line}: {sent:02x?}");
    }
}

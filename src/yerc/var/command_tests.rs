//! Tests of whole command lines that read and write memory: golden frames, and results on a simulator.

use serde_json::Value;

use crate::testing::{Bench, DX200, FS100, dry_run, same, without_header};

/// Like [`same`], with generated words.
#[track_caller]
fn same_many(id: &str, target: &str, first: &[&str], rest: &[String]) {
    let words: Vec<&str> = first.iter().copied().chain(rest.iter().map(String::as_str)).collect();
    same(id, target, &words);
}

#[test]
fn single_writes_are_golden_frames() {
    same("R19", DX200, &["io", "set", "--group", "2956=0xA5"]);
    same("M03t", DX200, &["register", "set", "10=0x1234"]);
    same("R21", FS100, &["register", "set", "559=65535"]);
    same("R23", FS100, &["var", "set", "B99=255"]);
    same("R25", FS100, &["var", "set", "I5=-2"]);
    same("R27", FS100, &["var", "set", "R3=1.5"]);
    same("R29", FS100, &["var", "set", "S7=HELLO"]);
    same("R29", DX200, &["var", "set", "--s16", "S7=HELLO"]);
    same("R31", DX200, &["var", "set", "P1=pulse:s=1000,l=-2000,u=3000,r=-4000,b=5000,t=-6000"]);
    same("R33", DX200, &["var", "set", "P3=user:x=0.001,y=0.002,z=0.003,rx=0.0004,ry=0.0005,rz=0.0006,user=2"]);
    same("R35", DX200, &["var", "set", "BP5.axis1=-1"]);
    same("R37", DX200, &["var", "set", "EX10=pulse:1=100,2=200"]);
}

#[test]
fn plural_reads_and_writes_are_golden_frames() {
    same("R57", DX200, &["io", "get", "--group", "1..474"]);
    same("R59", FS100, &["io", "set", "--group", "2502=0x80", "--group", "2501=1"]);
    same("R61", DX200, &["register", "set", "100=100", "102=300", "101=200"]);
    same("R63", DX200, &["var", "get", "B10..B11"]);
    same("R71", DX200, &["var", "get", "EX0..EX12"]);
    let duplicates: Vec<String> = (0..118).map(|n| format!("D{n}={}", n * 1000)).collect();
    same_many("R65", DX200, &["var", "set"], &duplicates);
    let strings: Vec<String> = (0..29).map(|n| format!("S{n}=STR{n:02}")).collect();
    same_many("R67", DX200, &["var", "set", "--s16"], &strings);
    let strings: Vec<String> = (0..14).map(|n| format!("S{n}=LONG STRING {n:02}")).collect();
    same_many("R79", DX200, &["var", "set"], &strings);
    let pulses = (0..9).map(|n| format!("P{n}=pulse:s={n},l={},u={},r={},b={},t={}", -n, 2 * n, -2 * n, 3 * n, -3 * n));
    same_many("R69", DX200, &["var", "set"], &pulses.collect::<Vec<_>>());
}

#[test]
fn batches_many_variables_into_few_requests() {
    let commands = |words: &[&str]| {
        let frames = dry_run(DX200, words).unwrap();
        let certain = frames.iter().filter(|frame| frame["depends_on"].is_null());
        certain.map(|frame| without_header(frame)[..4].to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(commands(&["var", "get", "B0..B99", "I0..I99", "D0..D99"]), ["0203", "0303", "0403"]);
    assert_eq!(commands(&["var", "get", "D5", "B0", "B0"]), ["7a00", "7c00"]);
    assert_eq!(commands(&["var", "list", "P"]).len(), 15);
    assert_eq!(commands(&["var", "list", "s"]).len(), 8);
}

#[test]
fn rejects_invalid_assignments() {
    let failed = |words: &[&str]| {
        let failure = dry_run(DX200, words).unwrap_err();
        assert_eq!(failure.kind.exit(), 2, "{words:?}");
        format!("{} {}", failure.message, failure.hint.unwrap_or_default())
    };
    assert!(failed(&["var", "set", "I0=1", "B0=256"]).contains("'256' is not a number from 0 to 255"));
    assert!(failed(&["var", "set", "B0=1", "B0=2"]).contains("B0 appears twice"));
    assert!(failed(&["var", "set", "S0=123456789012345678901234567890123"]).contains("33 bytes"));
    assert!(failed(&["var", "set", "--s16", "S0=12345678901234567"]).contains("17 bytes"));
    assert!(failed(&["var", "set", "S0=한글"]).contains("shift_jis"));
    assert!(failed(&["io", "get", "9"]).contains("signal 9 does not exist"));
    assert!(failed(&["io", "get", "5200"]).contains("does not exist on a dx200"));
    assert!(failed(&["io", "set", "10010=on"]).contains("robot user output"));
    assert!(failed(&["register", "get", "1000"]).contains("allowed: 0-999"));
    assert!(failed(&["register", "set", "560=1"]).contains("0-559"));
    assert!(failed(&["raw", "--file", "--service", "0x15"]).contains("yerc file put"));
    assert!(failed(&["raw", "--command", "0x8D", "--instance", "1", "--service", "1", "--strict"]).contains("0x008d"));
}

#[test]
fn reports_each_undefined_position_of_a_range() {
    let mut bench = Bench::new("sim:");
    bench.data(&["var", "set", "P20=pulse:s=1,l=2,u=3,r=4,b=5,t=6", "EX3=pulse:1=9"]);
    let data = bench.data(&["var", "get", "P18..P22", "EX3", "P18", "B8"]);
    let entries = data["items"].as_array().unwrap();
    let shown: Vec<(&str, &Value)> =
        entries.iter().map(|entry| (entry["name"].as_str().unwrap(), &entry["value"]["text"])).collect();
    let text = |text: &str| Value::from(text);
    let (p20, ex3) = (text("pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=0,user=0"), text("pulse:1=9"));
    let null = &Value::Null;
    assert_eq!(
        shown,
        [("P18", null), ("P19", null), ("P20", &p20), ("P21", null), ("P22", null), ("EX3", &ex3), ("B8", null)]
    );
    assert_eq!((&entries[0]["value"], &entries[0]["ok"]), (null, &Value::from(true)));
    assert_eq!(entries[6]["value"], 0);
    let (_, failure) = bench.run(&["var", "get", "P18..P19"]).unwrap();
    assert_eq!(failure.unwrap().kind.exit(), 3);
}

#[test]
fn reports_numbers_beyond_the_last() {
    let (data, failure) = Bench::new("sim:").run(&["var", "get", "B90..B110"]).unwrap();
    assert_eq!(failure.unwrap().kind.exit(), 9);
    let values = data["items"].as_array().unwrap();
    assert_eq!(values.iter().filter(|entry| entry["value"] == 0).count(), 10);
    assert!(
        values[10..].iter().all(|entry| entry["ok"] == false && entry["error"]["asked"] == entry["name"]),
        "{data}"
    );
}

#[test]
fn restores_a_dump_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (first, second) = (path("first.csv"), path("second.csv"));
    let mut bench = Bench::new("sim:?model=dx200");
    let values = [
        "B0=255",
        "I99=-32768",
        "D5=-2147483648",
        "R3=1.1",
        "R4=-1e-40",
        "S7=\u{30c6}\u{30b9}\u{30c8} \\x80",
        "BP1=base:x=1.5,y=2,z=3",
        "P5=user:x=-0.001,y=0,z=2147483.647,rx=0.0001,ry=-180,rz=0,re=1,tool=63,user=2,form=back+noflip,ext=w-ge180",
    ];
    bench.data(&[&["var", "set"], &values[..]].concat());
    let summary = bench.data(&["var", "dump", &first]);
    assert_eq!(bench.run(&["var", "dump", &first]).unwrap_err().kind.exit(), 1);
    let mut other = Bench::new("sim:?model=dx200");
    let restored = other.data(&["var", "restore", &first]);
    let items = restored["items"].as_array().unwrap();
    assert_eq!(items.len(), usize::try_from(summary["saved"].as_u64().unwrap()).unwrap());
    let written = items.iter().filter(|item| item["written"] == true).map(|item| item["name"].as_str().unwrap());
    assert_eq!(written.collect::<Vec<_>>(), ["B0", "I99", "D5", "R3", "R4", "S7", "P5", "BP1"]);
    other.data(&["var", "dump", &second]);
    assert_eq!(std::fs::read_to_string(&first).unwrap(), std::fs::read_to_string(&second).unwrap());
    for name in ["P5", "R4", "S7", "BP1"] {
        assert_eq!(bench.data(&["var", "get", name]), other.data(&["var", "get", name]));
    }
    let only = other.data(&["var", "restore", &first, "B,S"]);
    let items = only["items"].as_array().unwrap();
    assert_eq!(items.len(), 200);
    assert!(items.iter().all(|item| item["written"] == false), "{only}");
}

#[test]
fn copies_a_variable_to_others_of_its_kind() {
    let mut bench = Bench::new("sim:");
    bench.data(&["var", "set", "B1=7", "P20=pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=3", "S1=a,\"b\""]);
    bench.data(&["var", "copy", "B1", "B2..B3"]);
    bench.data(&["var", "copy", "P20", "P21"]);
    bench.data(&["var", "copy", "S1", "S2"]);
    let data = bench.data(&["var", "get", "B3", "P21", "S2"]);
    let value = |index: usize| data["items"][index]["value"].clone();
    assert_eq!((value(0), value(2)), (Value::from(7), Value::from("a,\"b\"")));
    assert_eq!(value(1)["text"], "pulse:s=1,l=2,u=3,r=4,b=5,t=6,tool=3,user=0");
    assert_eq!(bench.run(&["var", "copy", "P20", "B1"]).unwrap_err().kind.exit(), 2);
}

#[test]
fn sets_a_position_from_a_file_of_var_get() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut bench = Bench::new("sim:");
    let shown = bench.data(&["var", "get", "P2"]);
    std::fs::write(file.path(), serde_json::json!({ "ok": true, "data": shown }).to_string()).unwrap();
    bench.data(&["var", "set", &format!("P9=@{}", file.path().display()), "P9.tool=7"]);
    let (p2, p9) = (&shown["items"][0]["value"], bench.data(&["var", "get", "P9"]));
    let p9 = &p9["items"][0]["value"];
    assert_eq!((&p9["x_mm"], &p9["tool"]), (&p2["x_mm"], &Value::from(7)));
    let failure = bench.run(&["var", "set", &format!("EX9=@{}", file.path().display())]).unwrap_err();
    assert_eq!(failure.kind.exit(), 2);
}

#[test]
fn writes_nothing_without_an_answer() {
    let mut bench = Bench::new("sim:?fault=drop=100%25");
    let failure = bench.run(&["var", "set", "B0=1", "I0=1"]).unwrap_err();
    // The old value is read first, and the controller does not answer this read.
    assert_eq!(failure.kind.exit(), 4);
    assert!(failure.message.ends_with("; nothing was written"), "{failure}");
}

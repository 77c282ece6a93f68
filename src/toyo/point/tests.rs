//! Tests of the blocks and results of `toyo point`.

use crate::testing::{Bench, Fault, blocks};

#[test]
fn points_are_dumped_and_restored() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (first, second) = (path("first.csv"), path("second.csv"));
    let text =
        "name,x_mm,y_mm,z_mm,r_mm\n1,100.00,20.00,0.00,-0.05\n2,0.00,0.00,0.00,0.00\n3,-8000.00,1.00,0.00,9.00\n";
    std::fs::write(&first, text).unwrap();
    let mut bench = Bench::new("sim:");
    let written = |report: serde_json::Value| {
        let items = report["items"].as_array().unwrap().iter();
        items.map(|item| item["written"].as_bool().unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(written(bench.data(&["point", "restore", &first])), [true, false, true]);
    let saved = bench.data(&["point", "dump", &second, "1,3"]);
    assert_eq!(saved["saved"], 2);
    let without_blank: String =
        text.lines().filter(|line| !line.starts_with("2,")).map(|line| format!("{line}\n")).collect();
    assert_eq!(std::fs::read_to_string(&second).unwrap(), without_blank);
    assert_eq!(bench.run(&["point", "dump", &second]).unwrap_err().kind.exit(), 1);
    assert_eq!(written(bench.data(&["point", "restore", &first, "3"])), [false]);
    assert_eq!(written(bench.data(&["point", "copy", "1", "5-6"])), [true, true]);
    assert_eq!(bench.data(&["point", "get", "6"])["items"][0]["value"]["x_mm"], 100.0);
}

#[test]
fn one_coordinate_can_be_changed_alone() {
    let mut bench = Bench::new("sim:");
    bench.data(&["point", "set", "5", "1", "2", "3", "4"]);
    let changed = bench.data(&["point", "set", "5", "Y=-7.5"]);
    assert_eq!(changed["items"][0]["new"]["y_mm"], -7.5);
    let read = bench.data(&["point", "get", "5"]);
    assert_eq!((&read["items"][0]["value"]["x_mm"], &read["items"][0]["value"]["y_mm"]), (&1.0.into(), &(-7.5).into()));
}

#[test]
fn all_errors_of_a_file_are_reported_and_nothing_is_sent() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), "name,x_mm,y_mm,z_mm,r_mm\n1,0,0,0\n1000,0,0,0,0\n").unwrap();
    let name = file.path().to_str().unwrap();
    let failure = blocks(&["point", "restore", name]).unwrap_err();
    assert_eq!(failure.kind.exit(), 2);
    let lines: Vec<&str> = failure.message.lines().collect();
    assert_eq!(lines.len(), 2);
    assert!(lines[0].ends_with(":2:1: the row has 4 cells, but the table has 5 columns"), "{}", lines[0]);
}

fn five_points() -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rows: String = (1..=5).map(|row| format!("{row},{row},0,0,0\n")).collect();
    std::fs::write(file.path(), format!("name,x_mm,y_mm,z_mm,r_mm\n{rows}")).unwrap();
    file
}

#[test]
fn a_failed_write_ends_the_restore_with_a_report() {
    let (mut bench, _) = Bench::with_faults("eeprom_limit = 1", |_, _| Fault::None);
    bench.data(&["point", "set", "3", "9", "9", "9", "9"]);
    let points = five_points();
    let (report, failure) = bench.run(&["point", "restore", points.path().to_str().unwrap()]).unwrap();
    let failure = failure.unwrap();
    assert_eq!(failure.kind.exit(), 9);
    assert!(failure.message.starts_with("3 of 5 failed: point 3: "), "{failure}");
    assert!(failure.message.contains("the stored value differs"), "{failure}");
    assert_eq!(outcomes(&report), [(true, true), (true, true), (false, false), (false, false), (false, false)]);
    let last = report["items"][4]["error"]["message"].as_str().unwrap();
    assert!(last.starts_with("not written: "), "{last}");
}

/// For each point: whether it has a result, and whether it was written.
fn outcomes(report: &serde_json::Value) -> Vec<(bool, bool)> {
    let flag = |item: &serde_json::Value, key: &str| item[key].as_bool().unwrap();
    report["items"].as_array().unwrap().iter().map(|item| (flag(item, "ok"), flag(item, "written"))).collect()
}

#[test]
fn a_refusal_during_a_restore_gives_the_reason_and_the_points_written() {
    let event = "[[event]]\nat_ms = 1200\ndo = \"pendant on\"\n";
    let (mut bench, _) = Bench::with_faults(event, |_, _| Fault::None);
    let points = five_points();
    let (report, failure) = bench.run(&["point", "restore", points.path().to_str().unwrap()]).unwrap();
    assert!(failure.unwrap().message.contains("the teach pendant is ON"));
    let written = outcomes(&report).iter().filter(|(_, is_written)| *is_written).count();
    assert!((1..5).contains(&written), "{report}");
}

#[test]
fn an_accepted_write_without_read_back_has_an_unknown_outcome() {
    let (mut bench, received) = Bench::with_faults("", |block, count| match block {
        "@RPAR T1 PT=003" if count > 1 => Fault::Lost,
        _ => Fault::None,
    });
    let points = five_points();
    let (report, failure) = bench.run(&["point", "restore", points.path().to_str().unwrap()]).unwrap();
    assert!(failure.unwrap().message.contains("but the value could not be read back: "));
    let kinds: Vec<_> = report["items"].as_array().unwrap().iter().map(|item| item["error"]["kind"].clone()).collect();
    assert_eq!(kinds[2..], ["outcome_unknown", "no_answer", "no_answer"]);
    assert_eq!(received.borrow().iter().filter(|block| block.starts_with("@WPAR")).count(), 3);
}

#[test]
fn without_an_answer_to_the_first_read_nothing_is_written() {
    let (mut bench, _) =
        Bench::with_faults("", |block, _| if block == "@RPAR T1 PT=001" { Fault::Lost } else { Fault::None });
    let points = five_points();
    let failure = bench.run(&["point", "restore", points.path().to_str().unwrap()]).unwrap_err();
    assert_eq!(failure.kind.exit(), 4);
    assert!(failure.message.ends_with("; nothing was written"), "{failure}");
}

#[test]
fn the_current_task_is_restored_after_the_command() {
    let mut bench = Bench::new("sim:");
    bench.data(&["task", "set", "3"]);
    assert_eq!(bench.data(&["point", "set", "1", "1", "2", "3", "4", "--task", "2"])["items"][0]["task"], 2);
    assert_eq!(bench.data(&["point", "get", "1", "--task", "2"])["items"][0]["value"]["x_mm"], 1.0);
    assert_eq!(bench.data(&["point", "get", "1"])["items"][0]["task"], 3);
}

/// The letters of axes 2 and 3 are exchanged, as on a machine whose second axis is vertical.
const CROSSED: &str = "write = [\"WPAR E01 AX1=X AX2=Z AX3=Y AX4=R\"]\norigin = true\n";

#[test]
fn all_commands_use_the_axis_letters_of_the_machine() {
    let (mut bench, received) = Bench::with_faults(CROSSED, |_, _| Fault::None);
    let stored = bench.data(&["point", "set", "1", "z=12.5"]);
    assert_eq!(
        (&stored["items"][0]["value"]["z_mm"], &stored["items"][0]["new"]["z_mm"]),
        (&12.5.into(), &12.5.into())
    );
    let last = |word: &str| received.borrow().iter().rfind(|block| block.starts_with(word)).cloned();
    assert_eq!(last("@WPAR").unwrap(), "@WPAR T1 PT=001 X=+0000.00 Y=+0012.50 Z=+0000.00 R=+0000.00");
    bench.data(&["point", "set", "1", "ax3=7"]);
    assert_eq!(bench.data(&["point", "get", "1"])["items"][0]["value"]["y_mm"], 7.0);
    let jogged = bench.data(&["jog", "Z", "+", "low", "--for", "1s"]);
    assert_eq!((&jogged["axis"], &jogged["axis_number"]), (&"Z".into(), &2.into()));
    let position = bench.data(&["position"]);
    let place = &position["positions"][0];
    assert_eq!((&place["z_mm"], &place["y_mm"]), (&jogged["position"]["z_mm"], &0.0.into()));
    let taught = bench.data(&["teach", "2"]);
    assert_eq!(taught["new"]["z_mm"], place["z_mm"]);
    bench.data(&["coordinate", "set", "x=1", "y=2", "z=3", "r=4"]);
    assert_eq!(last("@MRSS").unwrap(), "@MRSS TASK=01 X=+0001.00 Y=+0003.00 Z=+0002.00 R=+0004.00 V=00");
    bench.data(&["palletizing", "set", "1", "source-p0", "z=3"]);
    assert_eq!(last("@WPLT").unwrap(), "@WPLT 01 SNO=02 X=+0000.00 Y=+0003.00 Z=+0000.00");
}

#[test]
fn values_without_names_are_rejected_if_letters_are_not_in_default_order() {
    let (mut bench, received) = Bench::with_faults(CROSSED, |_, _| Fault::None);
    for words in [&["point", "set", "1", "1", "2", "3", "4"][..], &["coordinate", "set", "1", "2", "3", "4"]] {
        let failure = bench.run(words).unwrap_err();
        assert_eq!(failure.kind.exit(), 2);
        assert!(failure.message.ends_with("axes 1 to 4 have the letters X, Z, Y, R"), "{failure}");
        assert!(failure.hint.unwrap().starts_with("type the coordinates by name: x=… z=… y=… r=…"));
    }
    assert!(!received.borrow().iter().any(|block| block.starts_with("@WPAR T1") || block.starts_with("@MRSS")));
}

#[test]
fn without_reported_letters_axes_have_numbers() {
    let mute = |block: &str, _| match block {
        "@SYSP" | "@RPAR E01" => Fault::Answered("@NG"),
        _ => Fault::None,
    };
    let (mut bench, received) = Bench::with_faults("origin = true\n", mute);
    for words in [&["point", "set", "1", "z=12.5"][..], &["jog", "Z", "+", "low", "--for", "1s"]] {
        let failure = bench.run(words).unwrap_err();
        assert_eq!(failure.kind.exit(), 2, "{failure}");
        assert!(failure.message.contains("the axis of Z is unknown"), "{failure}");
    }
    assert!(!received.borrow().iter().any(|block| block.starts_with("@WPAR") || block.starts_with("@JGST")));
    assert_eq!(bench.data(&["point", "set", "1", "ax3=12.5"])["items"][0]["value"]["joints"][2]["mm"], 12.5);
    assert_eq!(bench.data(&["jog", "3", "+", "low", "--for", "1s"])["axis_number"], 3);
}

#[test]
fn a_dump_has_the_axis_letters_of_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (letters, numbers, saved) = (path("letters.csv"), path("numbers.csv"), path("saved.csv"));
    std::fs::write(&letters, "name,x_mm,y_mm,z_mm,r_mm\n1,1.00,2.00,3.00,4.00\n").unwrap();
    std::fs::write(&numbers, "name,ax3_mm\n1,9.00\n").unwrap();
    let (mut bench, _) = Bench::with_faults(CROSSED, |_, _| Fault::None);
    bench.data(&["point", "restore", &letters]);
    bench.data(&["point", "dump", &saved, "1"]);
    let text = std::fs::read_to_string(&saved).unwrap();
    assert_eq!(text, "name,x_mm,z_mm,y_mm,r_mm\n1,1.00,3.00,2.00,4.00\n");
    bench.data(&["point", "restore", &numbers]);
    assert_eq!(bench.data(&["point", "get", "1"])["items"][0]["value"]["y_mm"], 9.0);
}

#[test]
fn an_update_dumps_only_the_points_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv").to_str().unwrap().to_owned();
    std::fs::write(&path, "comment,name,x_mm,y_mm,z_mm,r_mm\ngate,7,,,,\nbin,3,1,1,1,1\n").unwrap();
    let (mut bench, received) = Bench::with_faults("", |_, _| Fault::None);
    bench.data(&["point", "set", "7", "1", "2", "3", "4"]);
    let asked = received.borrow().len();
    assert_eq!(bench.data(&["point", "dump", &path, "--update"])["saved"], 2);
    let text = "comment,name,x_mm,y_mm,z_mm,r_mm\ngate,7,1.00,2.00,3.00,4.00\nbin,3,0.00,0.00,0.00,0.00\n";
    assert_eq!(std::fs::read_to_string(&path).unwrap(), text);
    let reads = received.borrow()[asked..].iter().filter(|block| block.starts_with("@RPAR T1")).count();
    assert_eq!(reads, 2);
    bench.data(&["point", "dump", &path, "1-3", "--update"]);
    assert_eq!(std::fs::read_to_string(&path).unwrap().lines().count(), 5);
}

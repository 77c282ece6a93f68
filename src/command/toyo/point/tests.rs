//! What `toyo point` sends, and what becomes of it.

use crate::command::toyo::testing::{Bench, Fault, blocks, objection};

#[test]
fn points_and_ranges_are_read_once_each() {
    assert_eq!(
        blocks(&["point", "get", "9-10,20", "9"]).unwrap(),
        ["@SYSP", "@RPAR E01", "@MTSK", "@RPAR T1 PT=009", "@RPAR T1 PT=010", "@RPAR T1 PT=020"]
    );
    assert_eq!(
        blocks(&["point", "get", "1", "--task", "2"]).unwrap(),
        ["@SYSP", "@RPAR E01", "@MTSK", "@CTSK TASK=02", "@RPAR T1 PT=001", "@CTSK TASK=?"]
    );
    assert_eq!(blocks(&["point", "list"]).unwrap().len(), 3 + 999);
    assert_eq!(blocks(&["point", "list", "--from", "998"]).unwrap()[3..], ["@RPAR T1 PT=998", "@RPAR T1 PT=999"]);
    assert!(objection(&["point", "get", "1000"]).contains("1000 is out of range (a number, 1 to 999)"));
    assert_eq!(blocks(&["point", "list", "--from", "5", "--to", "4"]).unwrap_err().kind.exit(), 2);
}

#[test]
fn a_point_is_compared_before_it_is_written() {
    assert_eq!(
        blocks(&["point", "set", "7", "100", "-20.5", "0", "0"]).unwrap(),
        ["@MTSK", "@RPAR T1 PT=007", "@WPAR T1 PT=007 X=+0100.00 Y=-0020.50 Z=+0000.00 R=+0000.00", "@RPAR T1 PT=007"]
    );
    assert_eq!(
        blocks(&["point", "set", "7", "z=1"]).unwrap(),
        ["@MTSK", "@RPAR T1 PT=007", "@WPAR T1 PT=007 X=? Y=? Z=+0001.00 R=?", "@RPAR T1 PT=007"]
    );
    assert_eq!(
        blocks(&["point", "set", "7", "100", "0", "9000", "0"]).unwrap_err().message,
        "point 7: z: 9000.00 is out of range (a number, -8000.00 to 8000.00 mm)"
    );
    assert!(objection(&["point", "set", "7"]).contains("<MM>"));
    assert!(objection(&["point", "set", "7", "1", "2", "3", "4", "--resume=3"]).contains("cannot be used with"));
}

#[test]
fn points_go_through_a_file_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (first, second) = (path("first.csv"), path("second.csv"));
    let text =
        "point,x_mm,y_mm,z_mm,r_mm\n1,100.00,20.00,0.00,-0.05\n2,0.00,0.00,0.00,0.00\n3,-8000.00,1.00,0.00,9.00\n";
    std::fs::write(&first, text).unwrap();
    let mut bench = Bench::new("sim:");
    let stored = bench.data(&["point", "set", "--from", &first]);
    assert_eq!((&stored["cells_written"], &stored["cells_unchanged"]), (&2.into(), &1.into()), "{stored}");
    assert_eq!(
        (&stored["points"][0]["result"], &stored["points"][1]["result"]),
        (&"written".into(), &"unchanged".into())
    );
    let saved = bench.data(&["point", "list", "--to", "3", "--csv", &second]);
    assert_eq!((&saved["saved"], &saved["task"]), (&3.into(), &1.into()));
    assert_eq!(std::fs::read_to_string(&second).unwrap(), text);
    assert_eq!(bench.run(&["point", "list", "--csv", &second]).unwrap_err().kind.exit(), 1);
    let again = bench.data(&["point", "set", "--from", &first, "--resume=2"]);
    assert_eq!((&again["points"][0]["result"], &again["cells_unchanged"]), (&"left_out".into(), &2.into()));
    assert_eq!(bench.run(&["point", "set", "--from", &first, "--resume=9"]).unwrap_err().kind.exit(), 2);
}

#[test]
fn one_coordinate_is_changed_alone() {
    let mut bench = Bench::new("sim:");
    bench.data(&["point", "set", "5", "1", "2", "3", "4"]);
    let changed = bench.data(&["point", "set", "5", "Y=-7.5"]);
    assert_eq!(changed["points"][0]["y_mm"], -7.5);
    let read = bench.data(&["point", "get", "5"]);
    assert_eq!((&read["points"][0]["x_mm"], &read["points"][0]["y_mm"]), (&1.0.into(), &(-7.5).into()));
}

#[test]
fn every_mistake_of_a_file_is_told_and_nothing_sent() {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), "point,x_mm,y_mm,z_mm,r_mm\n1,0,0,0\n1000,0,0,0,0\n").unwrap();
    let name = file.path().to_str().unwrap();
    let failure = blocks(&["point", "set", "--from", name]).unwrap_err();
    assert_eq!(failure.kind.exit(), 2);
    let lines: Vec<&str> = failure.message.lines().collect();
    assert_eq!(lines.len(), 2);
    assert!(lines[0].ends_with(":2:1: 4 cells under 5 columns"), "{}", lines[0]);
}

fn five_points() -> tempfile::NamedTempFile {
    let file = tempfile::NamedTempFile::new().unwrap();
    let rows: String = (1..=5).map(|row| format!("{row},{row},0,0,0\n")).collect();
    std::fs::write(file.path(), format!("point,x_mm,y_mm,z_mm,r_mm\n{rows}")).unwrap();
    file
}

#[test]
fn a_worn_cell_ends_it_with_an_account() {
    let (mut bench, _) = Bench::with_faults("eeprom_limit = 1", |_, _| Fault::None);
    bench.data(&["point", "set", "3", "9", "9", "9", "9"]);
    let points = five_points();
    let failure = bench.run(&["point", "set", "--from", points.path().to_str().unwrap()]).unwrap_err();
    assert_eq!(failure.kind.exit(), 5);
    let (message, hint) = (failure.message, failure.hint.unwrap());
    assert!(message.contains("holds something else; done: points 1 to 2 (2 written, 0 unchanged)"), "{message}");
    assert!(message.ends_with("written or not: point 3; not written: points 4 to 5"), "{message}");
    assert!(hint.ends_with("then --resume=3 goes on there"), "{hint}");
}

#[test]
fn a_refusal_on_the_way_says_why_and_what_is_done() {
    let event = "[[event]]\nat_ms = 1200\ndo = \"pendant on\"\n";
    let (mut bench, _) = Bench::with_faults(event, |_, _| Fault::None);
    let points = five_points();
    let failure = bench.run(&["point", "set", "--from", points.path().to_str().unwrap()]).unwrap_err();
    assert_eq!(failure.kind.exit(), 3);
    assert!(failure.message.contains("the teach pendant is ON; done: points 1 to "), "{failure}");
}

#[test]
fn what_was_accepted_and_not_read_back_is_open() {
    let (mut bench, heard) = Bench::with_faults("", |block, count| match block {
        "@RPAR T1 PT=003" if count > 1 => Fault::Lost,
        _ => Fault::None,
    });
    let points = five_points();
    let failure = bench.run(&["point", "set", "--from", points.path().to_str().unwrap()]).unwrap_err();
    assert_eq!(failure.kind.exit(), 6);
    assert!(failure.message.contains("was accepted, but not read back: "), "{failure}");
    assert!(failure.message.ends_with("written or not: point 3; not written: points 4 to 5"), "{failure}");
    assert_eq!(heard.borrow().iter().filter(|block| block.starts_with("@WPAR")).count(), 3);
}

#[test]
fn a_silent_controller_had_nothing_written() {
    let (mut bench, _) =
        Bench::with_faults("", |block, _| if block == "@RPAR T1 PT=001" { Fault::Lost } else { Fault::None });
    let points = five_points();
    let failure = bench.run(&["point", "set", "--from", points.path().to_str().unwrap()]).unwrap_err();
    assert_eq!(failure.kind.exit(), 4);
    assert!(failure.message.ends_with("; nothing was written"), "{failure}");
}

#[test]
fn a_task_that_was_chosen_is_put_back() {
    let mut bench = Bench::new("sim:");
    bench.data(&["task", "set", "3"]);
    assert_eq!(bench.data(&["point", "set", "1", "1", "2", "3", "4", "--task", "2"])["task"], 2);
    assert_eq!(bench.data(&["point", "get", "1", "--task", "2"])["points"][0]["x_mm"], 1.0);
    assert_eq!(bench.data(&["point", "get", "1"])["task"], 3);
}

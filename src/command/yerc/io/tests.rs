//! Whole command lines about signals.

use serde_json::Value;

use crate::command::yerc::testing::{Bench, DX200, dry_run};

#[test]
fn a_change_of_one_signal_is_foreseen() {
    let plan = dry_run(DX200, &["io", "set", "27010=on", "27011=off"]).unwrap();
    let [read, write] = &plan[..] else { panic!("{plan:?}") };
    assert_eq!(read["about"], "reads group 2701");
    assert_eq!(&read["hex"].as_str().unwrap()[48..], "78008d0a010e0000");
    assert!(write["about"].as_str().unwrap().starts_with("writes group 2701"));
    assert_eq!(&write["hex"].as_str().unwrap()[48..], "78008d0a01100000??");
}

#[test]
fn one_signal_is_switched_and_the_others_stay() {
    let mut bench = Bench::new("sim:?model=fs100");
    bench.data(&["io", "set", "--group", "2501=0xF0"]);
    let data = bench.data(&["io", "set", "25010=on", "25017=off", "25020=on"]);
    assert_eq!((&data["groups"][0]["value"], &data["groups"][1]["value"]), (&Value::from(0x71), &Value::from(1)));
    let data = bench.data(&["io", "get", "25010..25013", "25010", "--group", "2501..2502"]);
    let on: Vec<bool> = data["signals"].as_array().unwrap().iter().map(|signal| signal["on"] == true).collect();
    assert_eq!(on, [true, false, false, false]);
    assert_eq!(data["groups"][0]["value_hex"], "0x71");
}

//! Tests of whole command lines for signals.

use serde_json::Value;

use crate::testing::{Bench, DX200, dry_run};

#[test]
fn plans_the_change_of_one_signal() {
    let plan = dry_run(DX200, &["io", "set", "27010=on", "27011=off"]).unwrap();
    let [write] = &plan[..] else { panic!("{plan:?}") };
    assert!(write["about"].as_str().unwrap().starts_with("writes group 2701"));
    assert_eq!(&write["hex"].as_str().unwrap()[48..], "78008d0a01100000??");
}

#[test]
fn equal_signals_are_not_written() {
    let mut bench = Bench::new("sim:");
    let written = |bench: &mut Bench| bench.data(&["io", "set", "27010=on"])["items"][0]["written"].clone();
    assert_eq!([written(&mut bench), written(&mut bench)], [Value::from(true), false.into()]);
}

#[test]
fn switches_one_signal_and_keeps_the_others() {
    let mut bench = Bench::new("sim:?model=fs100");
    bench.data(&["io", "set", "--group", "2501=0xF0"]);
    let data = bench.data(&["io", "set", "25010=on", "25017=off", "25020=on"]);
    let keys = |item: &Value| [item["name"].clone(), item["old"].clone(), item["new"].clone(), item["written"].clone()];
    assert_eq!(keys(&data["items"][0]), ["#25010".into(), Value::from(false), true.into(), true.into()]);
    let data = bench.data(&["io", "get", "25010..25013", "25010", "--group", "2501..2502"]);
    let values: Vec<&Value> = data["items"].as_array().unwrap().iter().map(|item| &item["value"]).collect();
    assert_eq!(values, [&true.into(), &false.into(), &false.into(), &false.into(), &0x71.into(), &Value::from(1)]);
    let data = bench.data(&["io", "list", "--in"]);
    let listed = |name: &str| data["items"].as_array().unwrap().iter().any(|item| item["name"] == name);
    assert!(listed("#25010") && !listed("#25011"), "{data}");
}

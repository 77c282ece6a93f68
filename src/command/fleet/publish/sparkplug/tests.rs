//! Tests of the Sparkplug node, message by message, against the expectations of hosts.

use std::cell::RefCell;
use std::rc::Rc;

use srad_types::payload::metric::Value;

use super::super::tests::{look, robot, silence};
use super::*;

/// A node of group Plant, and the connection numbers that it saves.
fn node(host: Option<&str>) -> (Node, Rc<RefCell<Vec<u8>>>) {
    let remembered: Rc<RefCell<Vec<u8>>> = Rc::default();
    let names = Names {
        group: "Plant".to_owned(),
        node: "Cell7".to_owned(),
        host: host.map(ToOwned::to_owned),
        levels: Levels::default(),
    };
    let remember = {
        let remembered = Rc::clone(&remembered);
        Box::new(move |next| remembered.borrow_mut().push(next))
    };
    let kinds = [Kind::Alarms, Kind::Position];
    (Node::new(names, (&kinds, Rc::from([])), 60_000, (254, remember)), remembered)
}

fn payload(message: &Message) -> Payload {
    Payload::decode(&message.payload[..]).unwrap()
}

/// Type, device and sequence number of each message.
fn heads(messages: &[Message]) -> Vec<String> {
    let head = |message: &Message| {
        let levels: Vec<&str> = message.topic.split('/').collect();
        assert_eq!((levels[0], levels[1], levels[3]), ("spBv1.0", "Plant", "Cell7"));
        let seq = payload(message).seq.map_or("-".to_owned(), |seq| seq.to_string());
        format!("{} {} {seq}", levels[2], levels.get(4).unwrap_or(&"-"))
    };
    messages.iter().map(head).collect()
}

fn bd_seq_of(message: &Message) -> Option<Value> {
    payload(message).metrics.into_iter().find(|metric| metric.name.as_deref() == Some("bdSeq"))?.value
}

/// Messages for an event, sent at once.
fn told(node: &mut Node, event: &Event, now_ms: u64) -> Vec<Message> {
    let records = node.found(event, now_ms);
    records.into_iter().flat_map(|record| node.told(record, now_ms)).collect()
}

/// A command of a host.
fn command(name: &str, value: Value) -> Message {
    let mut metric = Metric::new();
    metric.set_name(name.to_owned()).set_datatype(DataType::Boolean).set_value(value);
    let payload = Payload { timestamp: Some(1), metrics: vec![metric], seq: None, uuid: None, body: None };
    Message {
        topic: "spBv1.0/Plant/NCMD/Cell7".to_owned(),
        payload: payload.encode_to_vec(),
        retain: false,
        acknowledged: true,
    }
}

fn state(is_online: bool, timestamp: u64) -> Message {
    let payload = format!("{{\"online\":{is_online},\"timestamp\":{timestamp}}}").into_bytes();
    Message { topic: "spBv1.0/STATE/SCADA".to_owned(), payload, retain: true, acknowledged: true }
}

#[test]
fn births_have_types_units_and_aliases_and_data_comes_by_alias() {
    let (mut node, remembered) = node(None);
    let will = node.will(1);
    assert_eq!(
        (heads(std::slice::from_ref(&will)), will.acknowledged, will.retain),
        (vec!["NDEATH - -".to_owned()], true, false)
    );
    let births = node.connected(2);
    assert_eq!(heads(&births), ["NBIRTH - 0"]);
    assert!(births.iter().all(|message| !message.retain && !message.acknowledged));
    // The death has the number of its birth.
    assert_eq!((bd_seq_of(&will), bd_seq_of(&births[0])), (Some(Value::LongValue(254)), Some(Value::LongValue(254))));
    let press = robot("press");
    let messages = told(&mut node, &look(&press, 1.0, &[]), 10);
    assert_eq!(heads(&messages), ["DBIRTH press 1"]);
    let birth = payload(&messages[0]);
    let metric = |name: &str| birth.metrics.iter().find(|metric| metric.name.as_deref() == Some(name)).unwrap().clone();
    let x = metric("position/x_mm");
    let unit = x.properties.clone().unwrap();
    assert_eq!((x.datatype, unit.keys), (Some(DataType::Double as u32), vec!["engUnit".to_owned()]));
    let mut aliases: Vec<u64> = birth.metrics.iter().map(|metric| metric.alias.unwrap()).collect();
    aliases.dedup();
    assert_eq!(aliases.len(), birth.metrics.len());
    assert!(birth.metrics.iter().all(|metric| metric.timestamp == Some(10) && metric.datatype.is_some()));

    let messages = told(&mut node, &look(&press, 2.5, &["4315"]), 20);
    assert_eq!(heads(&messages), ["DDATA press 2"]);
    let data = payload(&messages[0]);
    let found: Vec<_> =
        data.metrics.iter().map(|metric| (metric.alias, metric.name.clone(), metric.is_historical)).collect();
    let expected = ["alarms/count", "alarms/codes", "position/x_mm"];
    assert_eq!(found, expected.map(|name| (metric(name).alias, None, None)));
    assert_eq!(data.metrics[2].value, Some(Value::DoubleValue(2.5)));
    assert!(told(&mut node, &look(&press, 2.5, &["4315"]), 30).is_empty(), "nothing has changed");
    // Once a minute, all metrics.
    let messages = told(&mut node, &look(&press, 2.5, &["4315"]), 60_010);
    assert_eq!(payload(&messages[0]).metrics.len(), birth.metrics.len());
    assert_eq!(*remembered.borrow(), [255]);
}

#[test]
fn a_robot_that_is_silent_dies_and_is_born_again() {
    let (mut node, _) = node(None);
    node.will(1);
    node.connected(1);
    let press = robot("press");
    told(&mut node, &look(&press, 1.0, &[]), 2);
    assert_eq!(heads(&told(&mut node, &silence(&press), 3)), ["DDEATH press 2"]);
    assert!(told(&mut node, &silence(&press), 4).is_empty());
    assert_eq!(heads(&told(&mut node, &look(&press, 1.0, &[]), 5)), ["DBIRTH press 3"]);
    assert_eq!(heads(&told(&mut node, &Event::Gone(press), 6)), ["DDEATH press 4"]);
}

#[test]
fn sequence_and_birth_numbers_go_round() {
    let (mut node, remembered) = node(None);
    for expected in [254, 255, 0] {
        let will = node.will(1);
        assert_eq!(bd_seq_of(&will), Some(Value::LongValue(expected)));
        assert_eq!(bd_seq_of(&node.connected(1)[0]), Some(Value::LongValue(expected)));
        node.lost();
    }
    assert_eq!(*remembered.borrow(), [255, 0, 1]);
    node.will(1);
    node.connected(1);
    let press = robot("press");
    let seqs: Vec<u64> = (0_u32..600)
        .flat_map(|at| told(&mut node, &look(&press, f64::from(at), &[]), 2))
        .map(|message| payload(&message).seq.unwrap())
        .collect();
    assert!((1..=600).map(|seq| seq % 256).eq(seqs));
}

#[test]
fn what_was_found_while_nobody_listened_is_told_as_history() {
    let (mut node, _) = node(None);
    node.will(1);
    node.connected(1);
    let (press, loader) = (robot("press"), robot("loader"));
    told(&mut node, &look(&press, 1.0, &[]), 2);
    told(&mut node, &look(&loader, 1.0, &[]), 2);
    node.lost();
    let mut waiting = node.found(&look(&press, 2.0, &[]), 3);
    waiting.extend(node.found(&look(&loader, 2.0, &[]), 3));
    waiting.extend(node.found(&look(&press, 3.0, &[]), 4));
    waiting.extend(node.found(&silence(&loader), 5));
    node.will(6);
    // A birth has the current values.
    let births = node.connected(7);
    assert_eq!(heads(&births), ["NBIRTH - 0", "DBIRTH press 1"]);
    let x = |message: &Message| {
        let metrics = payload(message).metrics;
        metrics.into_iter().find_map(|metric| match metric.value {
            Some(Value::DoubleValue(x)) if x > 1.9 => Some((x, metric.timestamp, metric.is_historical)),
            _ => None,
        })
    };
    assert_eq!(x(&births[1]), Some((3.0, Some(4), None)));
    let history: Vec<Message> = waiting.into_iter().flat_map(|record| node.told(record, 8)).collect();
    // The loader has history, but does not answer now.
    assert_eq!(
        heads(&history),
        ["DDATA press 2", "DBIRTH loader 3", "DDATA loader 4", "DDEATH loader 5", "DDATA press 6"]
    );
    assert_eq!(x(&history[0]), Some((2.0, Some(3), Some(true))));
    assert_eq!(x(&history[2]), Some((2.0, Some(3), Some(true))));
    // New data is not history.
    let now = told(&mut node, &look(&press, 4.0, &[]), 9);
    assert_eq!(x(&now[0]), Some((4.0, Some(9), None)));
}

#[test]
fn what_another_process_left_is_told_although_nobody_knows_the_robot_yet() {
    let (mut node, _) = node(None);
    let press = robot("press");
    let records = node.found(&look(&press, 1.0, &[]), 3);
    let [record] = &records[..] else { panic!("one record") };
    let (mut next, _) = self::node(None);
    next.will(4);
    next.connected(4);
    let messages = next.told(Record { epoch: 0, ..record.clone() }, 5);
    assert_eq!(heads(&messages), ["DBIRTH press 1", "DDATA press 2", "DDEATH press 3"]);
    let (birth, data) = (payload(&messages[0]), payload(&messages[1]));
    assert!(birth.metrics.iter().all(|metric| metric.is_null == Some(true) && metric.name.is_some()));
    assert!(data.metrics.iter().all(|metric| metric.is_historical == Some(true)));
}

#[test]
fn hosts_can_ask_for_births_and_for_nothing_else() {
    let (mut node, _) = node(None);
    node.will(1);
    node.connected(1);
    told(&mut node, &look(&robot("press"), 1.0, &[]), 2);
    let yes = Value::BooleanValue(true);
    // A second birth so soon would contain the same.
    assert_eq!(node.received(&command("Node Control/Rebirth", yes.clone()), 500).messages, []);
    let reborn = node.received(&command("Node Control/Rebirth", yes.clone()), 5000);
    assert_eq!(heads(&reborn.messages), ["NBIRTH - 0", "DBIRTH press 1"]);
    assert_eq!(bd_seq_of(&reborn.messages[0]), Some(Value::LongValue(254)), "the same connection");
    for message in [
        command("Node Control/Rebirth", Value::BooleanValue(false)),
        command("Node Control/Reboot", yes.clone()),
        command("status/servo_on", yes.clone()),
        Message { payload: b"\xff\xff garbage".to_vec(), ..command("x", yes.clone()) },
        Message { topic: "spBv1.0/Plant/DCMD/Cell7/press".to_owned(), ..command("Node Control/Rebirth", yes) },
    ] {
        let reaction = node.received(&message, 60_000);
        assert!(reaction.messages.is_empty() && !reaction.leaves, "{message:?}");
        assert!(matches!(reaction.note, Some((Level::Detail, _))), "said at -v: {:?}", reaction.note);
    }
}

#[test]
fn nothing_is_told_without_the_primary_host() {
    let (mut node, _) = node(Some("SCADA"));
    assert_eq!(node.topics(), ["spBv1.0/Plant/NCMD/Cell7", "spBv1.0/STATE/SCADA"]);
    node.will(1);
    assert_eq!(node.connected(1), []);
    assert!(!node.is_ready());
    let waiting = node.found(&look(&robot("press"), 1.0, &[]), 2);
    assert_eq!(node.received(&state(false, 50), 3).messages, []);
    let births = node.received(&state(true, 100), 4);
    assert_eq!(heads(&births.messages), ["NBIRTH - 0", "DBIRTH press 1"]);
    assert!(node.is_ready());
    let history: Vec<Message> = waiting.into_iter().flat_map(|record| node.told(record, 5)).collect();
    assert!(payload(&history[0]).metrics.iter().all(|metric| metric.is_historical == Some(true)));
    // A STATE message older than the last one is ignored: the host is back since then.
    assert!(!node.received(&state(false, 99), 6).leaves && node.is_ready());
    let death = node.received(&state(false, 101), 7);
    assert_eq!((heads(&death.messages), death.leaves, node.is_ready()), (vec!["NDEATH - -".to_owned()], true, false));
    for garbage in ["", "online", "{\"online\":1}", "[]"] {
        let message = Message { payload: garbage.as_bytes().to_vec(), ..state(true, 1) };
        assert_eq!(node.received(&message, 8).messages, [], "{garbage}");
    }
}

#[test]
fn farewell_is_the_death_of_the_node() {
    let (mut node, _) = node(None);
    assert_eq!(node.farewell(0), []);
    let will = node.will(1);
    node.connected(2);
    let farewell = node.farewell(3);
    assert_eq!(heads(&farewell), ["NDEATH - -"]);
    assert_eq!(bd_seq_of(&farewell[0]), bd_seq_of(&will));
}

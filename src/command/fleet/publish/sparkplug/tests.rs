//! Tests of the Sparkplug node, message by message, against the expectations of hosts.

use std::cell::RefCell;
use std::rc::Rc;

use srad_types::payload::metric::Value;

use super::super::tests::{look, robot, silence};
use super::*;

/// A node of group Plant without a primary host.
pub fn plain_node() -> Box<dyn MessageFormat> {
    Box::new(node(&[]).0)
}

/// A node of group Plant with the primary host SCADA.
pub fn hosted_node() -> Box<dyn MessageFormat> {
    Box::new(node(&["SCADA"]).0)
}

/// A node of group Plant, and the connection numbers that it saves.
fn node(hosts: &[&str]) -> (Node, Rc<RefCell<Vec<u8>>>) {
    let remembered: Rc<RefCell<Vec<u8>>> = Rc::default();
    let names = Names {
        group: "Plant".to_owned(),
        node: "Cell7".to_owned(),
        hosts: hosts.iter().map(|&host| host.to_owned()).collect(),
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
fn headers(messages: &[Message]) -> Vec<String> {
    let head = |message: &Message| {
        let levels: Vec<&str> = message.topic.split('/').collect();
        assert_eq!((levels[0], levels[1], levels[3]), ("spBv1.0", "Plant", "Cell7"));
        let seq = payload(message).seq.map_or("-".to_owned(), |seq| seq.to_string());
        format!("{} {} {seq}", levels[2], levels.get(4).unwrap_or(&"-"))
    };
    messages.iter().map(head).collect()
}

/// The `bdSeq` of a birth or death message.
pub fn bd_seq_of(message: &Message) -> Option<Value> {
    payload(message).metrics.into_iter().find(|metric| metric.name.as_deref() == Some("bdSeq"))?.value
}

/// Messages for an event, sent at once.
fn send_all(node: &mut Node, event: &Event, now_ms: u64) -> Vec<Message> {
    let records = node.convert_event(event, now_ms);
    records.into_iter().flat_map(|record| node.convert_record(record, now_ms)).collect()
}

/// A rebirth request of a host.
pub fn rebirth_request() -> Message {
    command(NODE_CONTROL_REBIRTH, Value::BooleanValue(true))
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
        expiry: None,
    }
}

/// A state of the host SCADA.
pub fn state(is_online: bool, timestamp: u64) -> Message {
    let payload = format!("{{\"online\":{is_online},\"timestamp\":{timestamp}}}").into_bytes();
    Message { topic: "spBv1.0/STATE/SCADA".to_owned(), payload, retain: true, acknowledged: true, expiry: None }
}

#[test]
fn births_define_aliases_that_data_uses() {
    let (mut node, remembered) = node(&[]);
    let will = node.will(1);
    assert_eq!(
        (headers(std::slice::from_ref(&will)), will.acknowledged, will.retain),
        (vec!["NDEATH - -".to_owned()], true, false)
    );
    let births = node.first_messages(2);
    assert_eq!(headers(&births), ["NBIRTH - 0"]);
    assert!(births.iter().all(|message| !message.retain && !message.acknowledged));
    // The death message has the number (`bdSeq`) of its birth message.
    assert_eq!((bd_seq_of(&will), bd_seq_of(&births[0])), (Some(Value::LongValue(254)), Some(Value::LongValue(254))));
    let press = robot("press");
    let messages = send_all(&mut node, &look(&press, 1.0, &[]), 10);
    assert_eq!(headers(&messages), ["DBIRTH press 1"]);
    let birth = payload(&messages[0]);
    let metric = |name: &str| birth.metrics.iter().find(|metric| metric.name.as_deref() == Some(name)).unwrap().clone();
    let x = metric("position/x_mm");
    let unit = x.properties.clone().unwrap();
    assert_eq!((x.datatype, unit.keys), (Some(DataType::Double as u32), vec!["engUnit".to_owned()]));
    let mut aliases: Vec<u64> = birth.metrics.iter().map(|metric| metric.alias.unwrap()).collect();
    aliases.dedup();
    assert_eq!(aliases.len(), birth.metrics.len());
    assert!(birth.metrics.iter().all(|metric| metric.timestamp == Some(10) && metric.datatype.is_some()));

    let messages = send_all(&mut node, &look(&press, 2.5, &["4315"]), 20);
    assert_eq!(headers(&messages), ["DDATA press 2"]);
    let data = payload(&messages[0]);
    let found: Vec<_> =
        data.metrics.iter().map(|metric| (metric.alias, metric.name.clone(), metric.is_historical)).collect();
    let expected = ["alarms/count", "alarms/codes", "position/x_mm"];
    assert_eq!(found, expected.map(|name| (metric(name).alias, None, None)));
    assert_eq!(data.metrics[2].value, Some(Value::DoubleValue(2.5)));
    assert!(send_all(&mut node, &look(&press, 2.5, &["4315"]), 30).is_empty(), "nothing has changed");
    // Once a minute, all metrics.
    let messages = send_all(&mut node, &look(&press, 2.5, &["4315"]), 60_010);
    assert_eq!(payload(&messages[0]).metrics.len(), birth.metrics.len());
    assert_eq!(*remembered.borrow(), [255]);
}

#[test]
fn silent_robot_gets_a_death_and_a_new_birth() {
    let (mut node, _) = node(&[]);
    node.will(1);
    node.first_messages(1);
    let press = robot("press");
    send_all(&mut node, &look(&press, 1.0, &[]), 2);
    assert_eq!(headers(&send_all(&mut node, &silence(&press), 3)), ["DDEATH press 2"]);
    assert!(send_all(&mut node, &silence(&press), 4).is_empty());
    assert_eq!(headers(&send_all(&mut node, &look(&press, 1.0, &[]), 5)), ["DBIRTH press 3"]);
    assert_eq!(headers(&send_all(&mut node, &Event::Gone(press), 6)), ["DDEATH press 4"]);
}

#[test]
fn sequence_and_birth_numbers_wrap() {
    let (mut node, remembered) = node(&[]);
    for expected in [254, 255, 0] {
        let will = node.will(1);
        assert_eq!(bd_seq_of(&will), Some(Value::LongValue(expected)));
        assert_eq!(bd_seq_of(&node.first_messages(1)[0]), Some(Value::LongValue(expected)));
        node.connection_lost();
    }
    assert_eq!(*remembered.borrow(), [255, 0, 1]);
    node.will(1);
    node.first_messages(1);
    let press = robot("press");
    let seqs: Vec<u64> = (0_u32..600)
        .flat_map(|at| send_all(&mut node, &look(&press, f64::from(at), &[]), 2))
        .map(|message| payload(&message).seq.unwrap())
        .collect();
    assert!((1..=600).map(|seq| seq % 256).eq(seqs));
}

#[test]
fn sends_records_of_an_outage_as_history() {
    let (mut node, _) = node(&[]);
    node.will(1);
    node.first_messages(1);
    let (press, loader) = (robot("press"), robot("loader"));
    send_all(&mut node, &look(&press, 1.0, &[]), 2);
    send_all(&mut node, &look(&loader, 1.0, &[]), 2);
    node.connection_lost();
    let mut waiting = node.convert_event(&look(&press, 2.0, &[]), 3);
    waiting.extend(node.convert_event(&look(&loader, 2.0, &[]), 3));
    waiting.extend(node.convert_event(&look(&press, 3.0, &[]), 4));
    waiting.extend(node.convert_event(&silence(&loader), 5));
    node.will(6);
    // A birth message has the current values.
    let births = node.first_messages(7);
    assert_eq!(headers(&births), ["NBIRTH - 0", "DBIRTH press 1"]);
    let x = |message: &Message| {
        let metrics = payload(message).metrics;
        metrics.into_iter().find_map(|metric| match metric.value {
            Some(Value::DoubleValue(x)) if x > 1.9 => Some((x, metric.timestamp, metric.is_historical)),
            _ => None,
        })
    };
    assert_eq!(x(&births[1]), Some((3.0, Some(4), None)));
    let history: Vec<Message> = waiting.into_iter().flat_map(|record| node.convert_record(record, 8)).collect();
    // The loader has history, but does not answer now.
    assert_eq!(
        headers(&history),
        ["DDATA press 2", "DBIRTH loader 3", "DDATA loader 4", "DDEATH loader 5", "DDATA press 6"]
    );
    assert_eq!(x(&history[0]), Some((2.0, Some(3), Some(true))));
    assert_eq!(x(&history[2]), Some((2.0, Some(3), Some(true))));
    // New data is not history.
    let now = send_all(&mut node, &look(&press, 4.0, &[]), 9);
    assert_eq!(x(&now[0]), Some((4.0, Some(9), None)));
}

#[test]
fn sends_spooled_records_of_unknown_robots() {
    let (mut node, _) = node(&[]);
    let press = robot("press");
    let records = node.convert_event(&look(&press, 1.0, &[]), 3);
    let [record] = &records[..] else { panic!("one record") };
    let (mut next, _) = self::node(&[]);
    next.will(4);
    next.first_messages(4);
    let messages = next.convert_record(Record { epoch: 0, ..record.clone() }, 5);
    assert_eq!(headers(&messages), ["DBIRTH press 1", "DDATA press 2", "DDEATH press 3"]);
    let (birth, data) = (payload(&messages[0]), payload(&messages[1]));
    assert!(birth.metrics.iter().all(|metric| metric.is_null == Some(true) && metric.name.is_some()));
    assert!(data.metrics.iter().all(|metric| metric.is_historical == Some(true)));
}

#[test]
fn accepts_only_rebirth_commands() {
    let (mut node, _) = node(&[]);
    node.will(1);
    node.first_messages(1);
    send_all(&mut node, &look(&robot("press"), 1.0, &[]), 2);
    let yes = Value::BooleanValue(true);
    // A request within a second of the births is delayed. A second request has the same answer.
    let delayed = node.handle_message(&command("Node Control/Rebirth", yes.clone()), 500);
    assert_eq!((&delayed.messages[..], delayed.delay), (&[][..], Some(Duration::from_millis(501))));
    assert!(!node.is_ready(), "no data before the rebirth");
    let again = node.handle_message(&command("Node Control/Rebirth", yes.clone()), 600);
    assert_eq!((&again.messages[..], again.delay), (&[][..], None));
    assert_eq!(headers(&node.delayed_messages(1001)), ["NBIRTH - 0", "DBIRTH press 1"]);
    assert!(node.is_ready());
    assert_eq!(node.delayed_messages(1002), [], "one rebirth answers both requests");
    // A lost connection ends the delay, because the next connection begins with births.
    node.handle_message(&command("Node Control/Rebirth", yes.clone()), 1003);
    node.connection_lost();
    assert_eq!(node.delayed_messages(2001), []);
    node.first_messages(2002);
    assert!(node.is_ready());
    let reborn = node.handle_message(&command("Node Control/Rebirth", yes.clone()), 5000);
    assert_eq!(headers(&reborn.messages), ["NBIRTH - 0", "DBIRTH press 1"]);
    assert_eq!(bd_seq_of(&reborn.messages[0]), Some(Value::LongValue(254)), "the same connection");
    for message in [
        command("Node Control/Rebirth", Value::BooleanValue(false)),
        command("Node Control/Reboot", yes.clone()),
        command("status/servo_on", yes.clone()),
        Message { payload: b"\xff\xff garbage".to_vec(), ..command("x", yes.clone()) },
        Message { topic: "spBv1.0/Plant/DCMD/Cell7/press".to_owned(), ..command("Node Control/Rebirth", yes) },
    ] {
        let reaction = node.handle_message(&message, 60_000);
        assert!(reaction.messages.is_empty() && !reaction.reconnects, "{message:?}");
        assert!(matches!(reaction.note, Some((Level::Detail, _))), "said at -v: {:?}", reaction.note);
    }
}

#[test]
fn waits_for_the_primary_host() {
    let (mut node, _) = node(&["SCADA"]);
    assert_eq!(node.topics(), ["spBv1.0/Plant/NCMD/Cell7", "spBv1.0/STATE/SCADA"]);
    node.will(1);
    assert_eq!(node.first_messages(1), []);
    assert!(!node.is_ready());
    let waiting = node.convert_event(&look(&robot("press"), 1.0, &[]), 2);
    assert_eq!(node.handle_message(&state(false, 50), 3).messages, []);
    let births = node.handle_message(&state(true, 100), 4);
    assert_eq!(headers(&births.messages), ["NBIRTH - 0", "DBIRTH press 1"]);
    assert!(node.is_ready());
    let history: Vec<Message> = waiting.into_iter().flat_map(|record| node.convert_record(record, 5)).collect();
    assert!(payload(&history[0]).metrics.iter().all(|metric| metric.is_historical == Some(true)));
    // A STATE message older than the last STATE message is ignored, because the host has come back since then.
    assert!(!node.handle_message(&state(false, 99), 6).reconnects && node.is_ready());
    let death = node.handle_message(&state(false, 101), 7);
    assert_eq!(
        (headers(&death.messages), death.reconnects, node.is_ready()),
        (vec!["NDEATH - -".to_owned()], true, false)
    );
    for garbage in ["", "online", "{\"online\":1}", "[]"] {
        let message = Message { payload: garbage.as_bytes().to_vec(), ..state(true, 1) };
        assert_eq!(node.handle_message(&message, 8).messages, [], "{garbage}");
    }
}

#[test]
fn sends_while_one_of_two_primary_hosts_is_online() {
    let (mut node, _) = node(&["SCADA", "SPARE"]);
    assert_eq!(node.topics().len(), 3);
    let spare = |is_online, time| Message { topic: "spBv1.0/STATE/SPARE".to_owned(), ..state(is_online, time) };
    node.will(1);
    node.first_messages(1);
    node.handle_message(&state(false, 50), 2);
    assert!(!node.is_ready());
    // Each host has its own clock.
    assert_eq!(headers(&node.handle_message(&spare(true, 10), 3).messages), ["NBIRTH - 0"]);
    assert_eq!(node.handle_message(&state(true, 60), 4), Reaction::default());
    assert_eq!(node.handle_message(&spare(false, 11), 5), Reaction::default());
    assert!(node.is_ready());
    assert!(node.handle_message(&state(false, 61), 6).reconnects && !node.is_ready());
    node.handle_message(&state(true, 62), 7);
    // A state from the last connection does not count.
    node.connection_lost();
    node.first_messages(8);
    node.handle_message(&spare(false, 12), 9);
    assert!(!node.is_ready());
}

#[test]
fn final_message_is_the_death_of_the_node() {
    let (mut node, _) = node(&[]);
    assert_eq!(node.final_messages(0), []);
    let will = node.will(1);
    node.first_messages(2);
    let farewell = node.final_messages(3);
    assert_eq!(headers(&farewell), ["NDEATH - -"]);
    assert_eq!(bd_seq_of(&farewell[0]), bd_seq_of(&will));
}

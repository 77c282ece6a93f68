//! A list of two brokers: which of them gets which messages, and when.

use srad_types::payload::metric::Value;

use super::super::sparkplug::tests::{bd_seq_of, hosted_node, state};
use super::*;

/// Two brokers of a list. A client may be connected to one of them at a time.
fn pair(first: BrokerBehavior, second: BrokerBehavior) -> [FakeUplink; 2] {
    let (first, mut second) = (FakeUplink::new(first), FakeUplink::new(second));
    second.url = "mqtt://spare".parse().unwrap();
    second.connections = Rc::clone(&first.connections);
    [first, second]
}

async fn pumped_to(
    [first, second]: &[FakeUplink; 2],
    script: impl AsyncFnOnce(mpsc::UnboundedSender<Found>),
) -> (Counts, Vec<String>) {
    let (counts, lines) = pumped_as(plain(), &[first, second], Outbox::new(MEMORY, None), script).await;
    (counts.unwrap(), lines)
}

#[tokio::test(start_paused = true)]
async fn goes_at_once_to_the_second_broker_if_the_first_fails() {
    for (behavior, why) in REFUSALS.into_iter().chain([(BrokerBehavior::Away, "closed the connection (")]) {
        let brokers = pair(behavior, BrokerBehavior::Works);
        let start = Instant::now();
        let (counts, log_lines) = pumped_to(&brokers, async |tell| {
            tell.send(look(&robot("press"), 1.0, &[])).unwrap();
            sleep(Duration::from_secs(3600)).await;
        })
        .await;
        assert_eq!((counts.published, brokers[1].places("press")), (3, vec![1.0]));
        let attempts = brokers.each_ref().map(|broker| broker.attempts.borrow().clone());
        assert_eq!(attempts.each_ref().map(Vec::len), [1, 1], "the client stays at the second broker");
        assert!(attempts[1][0] - start < Duration::from_millis(10));
        assert!(
            log_lines[0].contains(why) && log_lines[0].ends_with("; next broker: mqtt://spare:1883"),
            "{log_lines:?}"
        );
    }
}

#[tokio::test(start_paused = true)]
async fn other_broker_gets_what_the_last_one_did_not_acknowledge() {
    let brokers = pair(BrokerBehavior::Works, BrokerBehavior::Works);
    let (counts, log_lines) = pumped_to(&brokers, async |tell| {
        let (press, loader) = (robot("press"), robot("loader"));
        for second in 0..60 {
            match second {
                // The first broker acknowledges nothing, and then closes the connection.
                20 => brokers[0].set_behavior(BrokerBehavior::Hangs),
                25 => brokers[0].set_behavior(BrokerBehavior::Away),
                40 => {
                    brokers[0].set_behavior(BrokerBehavior::Works);
                    brokers[1].set_behavior(BrokerBehavior::Away);
                }
                _ => {}
            }
            tell.send(look(&press, f64::from(second), &[])).unwrap();
            tell.send(look(&loader, 0.0, &[])).unwrap();
            sleep(Duration::from_secs(1)).await;
        }
    })
    .await;
    let range = |range: std::ops::Range<u8>| range.map(f64::from).collect::<Vec<_>>();
    assert_eq!(brokers[0].places("press"), [range(0..20), range(40..60)].concat());
    assert_eq!(brokers[1].places("press"), range(20..40));
    // Each broker also gets the current data of a robot that has not changed.
    assert_eq!(brokers.each_ref().map(|broker| broker.places("loader").len()), [2, 1]);
    assert_eq!((counts.reconnects, counts.dropped, counts.undelivered), (2, 0, 0));
    let connected: Vec<&String> = log_lines.iter().filter(|line| line.starts_with("connected to")).collect();
    assert!(connected[1].starts_with("connected to mqtt://spare:1883 after 0s; "), "{connected:?}");
}

#[tokio::test(start_paused = true)]
async fn pauses_after_each_round_without_a_broker() {
    let brokers = pair(BrokerBehavior::Away, BrokerBehavior::Refuses(3));
    let (counts, log_lines) = pumped_to(&brokers, async |tell| {
        for second in 0..500 {
            tell.send(look(&robot("press"), f64::from(second), &[])).unwrap();
            sleep(Duration::from_secs(1)).await;
        }
        brokers[1].set_behavior(BrokerBehavior::Works);
    })
    .await;
    assert_eq!(brokers[1].places("press"), (0..500).map(f64::from).collect::<Vec<_>>());
    assert_eq!((counts.dropped, brokers[0].topics().len()), (0, 0));
    let attempts = brokers.each_ref().map(|broker| broker.attempts.borrow().clone());
    assert!((10..22).contains(&attempts[0].len()), "{attempts:?}");
    assert!(attempts[0].iter().zip(&attempts[1]).all(|(first, second)| first == second), "{attempts:?}");
    let failures = log_lines.iter().filter(|line| line.contains("; next ")).count();
    assert_eq!(failures, 2, "each broker once: {log_lines:?}");

    let list = [&brokers[0], &brokers[1]];
    brokers[1].set_behavior(BrokerBehavior::Away);
    let notes = LogRecorder::default();
    let mut pump = Delivery::new(&list, plain(), Outbox::new(MEMORY, None), (&notes, Backoff::new(7)), true);
    let failure = pump.run(async || pending().await, pending()).await.unwrap_err();
    assert!(failure.message.starts_with("mqtt://spare:1883: "), "a bounded run ends after one round: {failure}");
    assert_eq!(notes.log_lines.borrow().len(), 1);
}

#[tokio::test(start_paused = true)]
async fn clears_a_topic_at_each_broker_that_has_it() {
    let brokers = pair(BrokerBehavior::Works, BrokerBehavior::Works);
    pumped_to(&brokers, async |tell| {
        let (press, loader) = (robot("press"), robot("loader"));
        let swap = async |away: usize| {
            brokers[away].set_behavior(BrokerBehavior::Away);
            sleep(Duration::from_secs(20)).await;
            brokers[away].set_behavior(BrokerBehavior::Works);
        };
        tell.send(look(&press, 1.0, &[])).unwrap();
        tell.send(look(&loader, 1.0, &[])).unwrap();
        sleep(Duration::from_secs(20)).await;
        swap(0).await;
        tell.send(Found::Gone(press)).unwrap();
        sleep(Duration::from_secs(20)).await;
        swap(1).await;
    })
    .await;
    for broker in &brokers {
        let taken = broker.taken.borrow();
        let cleared: Vec<&str> =
            taken.iter().filter(|message| message.payload.is_empty()).map(|message| &message.topic[..]).collect();
        assert_eq!(cleared, ["armctl/press/alarms", "armctl/press/position", "armctl/press/status"], "{}", broker.url);
    }
}

/// Messages that the two brokers get from a Sparkplug node within a minute.
async fn node_messages(brokers: &[FakeUplink; 2]) -> [Vec<Message>; 2] {
    let (notes, list) = (LogRecorder::default(), [&brokers[0], &brokers[1]]);
    let outbox = Outbox::new(MEMORY, None);
    let mut pump = Delivery::new(&list, hosted_node(), outbox, (&notes, Backoff::new(7)), false);
    pump.run(async || pending().await, sleep(Duration::from_secs(60))).await.unwrap();
    brokers.each_ref().map(|broker| broker.taken.borrow().clone())
}

#[tokio::test(start_paused = true)]
async fn looks_for_the_primary_host_at_each_broker() {
    let types = |messages: &[Message]| -> Vec<String> {
        messages.iter().map(|message| message.topic.split('/').nth(2).unwrap().to_owned()).collect()
    };
    // Each broker has its own clock.
    let online = |broker: &FakeUplink| broker.retained.borrow_mut().push(state(true, 10));
    for is_offline in [true, false] {
        let brokers = pair(BrokerBehavior::Works, BrokerBehavior::Works);
        if is_offline {
            brokers[0].retained.borrow_mut().push(state(false, 50));
        }
        online(&brokers[1]);
        let messages = node_messages(&brokers).await;
        assert_eq!(messages.each_ref().map(|messages| types(messages)), [vec![], vec!["NBIRTH".to_owned()]]);
        let waited = brokers[1].attempts.borrow()[0] - brokers[0].attempts.borrow()[0];
        assert_eq!(waited.as_secs(), if is_offline { 0 } else { 30 });
        assert_eq!(brokers[1].attempts.borrow().len(), 1, "the node stays there");
    }
    // The host goes offline at the first broker.
    let brokers = pair(BrokerBehavior::Works, BrokerBehavior::Works);
    let changes = [state(true, 50), state(false, 51)].map(Event::Message);
    brokers[0].incoming.replace(changes.into());
    online(&brokers[1]);
    let [first, second] = node_messages(&brokers).await;
    assert_eq!((types(&first), types(&second)), (vec!["NBIRTH".into(), "NDEATH".into()], vec!["NBIRTH".into()]));
    let numbers: Vec<_> = first.iter().chain(&second).map(bd_seq_of).collect();
    assert_eq!(numbers, [254, 254, 255].map(|number| Some(Value::LongValue(number))));
}

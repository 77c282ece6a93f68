//! Tests of the pump in virtual time, with simulated polls and simulated brokers.

mod failover;

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::future::pending;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use tempfile::TempDir;
use tokio::sync::{Notify, mpsc};
use tokio::time::{Instant, sleep};

use super::announced::AnnouncedTopics;
use super::broker::Url;
use super::delivery::{Backoff, Broker, Counts, Delivery, Listener, Uplink};
use super::outbox::Outbox;
use super::plain_format::{PlainFormat, Times};
use super::sparkplug::tests::{plain_node, rebirth_request};
use super::spool::{Spool, SyncPolicy};
use super::topic::Topics;
use super::uplink::{Event, Loss, Message, Refusal, SendError, TlsError, Version, Will};
use super::{AlsoCommand, Kind, MessageFormat};
use crate::command::fleet::poll::{Event as Found, PollResult};
use crate::command::fleet::service::END_TIMEOUT;
use armctl_frame::face::{OverviewReport, Sample, Traffic};
use armctl_frame::failure::{self, Failure};
use armctl_frame::output::log::Level;
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::robot::state::{Mode, PositionMm, State};
use armctl_frame::settings::inventory::Inventory;
use armctl_frame::settings::{Robot, Selection, Sources};

/// A robot with this name.
pub fn robot(name: &str) -> Arc<Robot> {
    let text = format!("[[robot]]\nname = \"{name}\"\nfamily = \"yerc\"\ntarget = \"sim:\"\n");
    let inventory = Inventory::parse(&text, "robots.toml").unwrap();
    let selection = Selection { all: true, ..Selection::default() };
    let mut robots = Sources { selection, inventory, ..Sources::default() }.robots(None).unwrap();
    Arc::new(robots.remove(0))
}

/// A poll result with this position and these alarm codes.
pub fn look(robot: &Arc<Robot>, x_mm: f64, alarms: &[&str]) -> Found {
    let alarm = |code: &&str| Alarm { code: Some((*code).to_owned()), ..Alarm::default() };
    let state = State {
        reachable: true,
        mode: Some(Mode::Automatic),
        servo_on: Some(true),
        position: Some(PositionMm { x_mm, y_mm: 0.0, z_mm: 1.5 }),
        ..State::default()
    };
    let line = OverviewReport { state, ..OverviewReport::default() };
    let sample = Sample { line, alarms: alarms.iter().map(alarm).collect(), ..Sample::default() };
    Found::Polled(Arc::new(PollResult::new(Arc::clone(robot), sample)))
}

pub fn silence(robot: &Arc<Robot>) -> Found {
    let failure = Failure::new(failure::Kind::NoAnswer, "no answer");
    Found::Failed { robot: Arc::clone(robot), failure, pause: Duration::from_secs(1), traffic: Traffic::default() }
}

/// Behavior of the broker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum BrokerBehavior {
    Works,
    Away,
    /// Accepts messages and answers pings, but does not acknowledge.
    Hangs,
    Refuses(u8),
    Distrusted,
    /// Accepts a client and its first message, then breaks the protocol.
    Breaks,
    /// Accepts the connection but does not answer.
    Mute,
    /// Cannot be reached, and does not refuse.
    Lost,
}

#[derive(Debug)]
struct FakeUplink {
    behavior: RefCell<BrokerBehavior>,
    /// Events of the first connection after its acceptance.
    incoming: RefCell<VecDeque<Event>>,
    /// Acknowledged messages.
    taken: RefCell<Vec<Message>>,
    /// Messages of other nodes.
    retained: RefCell<Vec<Message>>,
    attempts: RefCell<Vec<Instant>>,
    changed: Notify,
    start: Instant,
    url: Url,
    /// Number of open connections to all brokers of the list.
    connections: Rc<Cell<usize>>,
}

impl FakeUplink {
    fn new(behavior: BrokerBehavior) -> Self {
        Self {
            behavior: RefCell::new(behavior),
            incoming: RefCell::default(),
            taken: RefCell::default(),
            retained: RefCell::default(),
            attempts: RefCell::default(),
            changed: Notify::new(),
            start: Instant::now(),
            url: "mqtt://broker".parse().unwrap(),
            connections: Rc::default(),
        }
    }

    fn set_behavior(&self, behavior: BrokerBehavior) {
        self.behavior.replace(behavior);
        self.changed.notify_waiters();
    }

    fn topics(&self) -> Vec<String> {
        self.taken.borrow().iter().map(|message| message.topic.clone()).collect()
    }

    /// Published positions of this robot, in order.
    fn places(&self, name: &str) -> Vec<f64> {
        let topic = format!("armctl/{name}/position");
        let taken = self.taken.borrow();
        let envelopes = taken.iter().filter(|message| message.topic == topic && !message.payload.is_empty());
        envelopes
            .map(|message| serde_json::from_slice::<serde_json::Value>(&message.payload).unwrap())
            .filter_map(|envelope| envelope["data"]["position"]["x_mm"].as_f64())
            .collect()
    }
}

struct Connection<'a> {
    fake_uplink: &'a FakeUplink,
    events: VecDeque<Event>,
    next: u64,
    pings: u64,
}

impl<'a> Connection<'a> {
    /// A client has one connection at a time.
    fn new(fake_uplink: &'a FakeUplink, events: VecDeque<Event>) -> Self {
        assert_eq!(fake_uplink.connections.replace(1), 0, "{}", fake_uplink.url);
        Self { fake_uplink, events, next: 1, pings: 0 }
    }
}

impl Drop for Connection<'_> {
    fn drop(&mut self) {
        self.fake_uplink.connections.set(0);
    }
}

impl<'a> Broker for &'a FakeUplink {
    type Uplink = Connection<'a>;

    fn url(&self) -> &Url {
        &self.url
    }

    async fn open(&self, _: String, will: Will) -> Result<Connection<'a>, Loss> {
        if will.topic != "spBv1.0/Plant/NDEATH/Cell7" {
            let expected = ("armctl/cell7/state", &b"offline"[..], true);
            assert_eq!((&will.topic[..], &will.payload[..], will.retain), expected);
        }
        self.attempts.borrow_mut().push(Instant::now());
        let behavior = *self.behavior.borrow();
        let first = match behavior {
            BrokerBehavior::Away => return Err(Loss::Closed),
            BrokerBehavior::Distrusted => return Err(Loss::Tls(TlsError::Expired)),
            BrokerBehavior::Refuses(code) => {
                Event::Refused(Refusal { version: Version::V3, code, reason: None, server: None })
            }
            BrokerBehavior::Works | BrokerBehavior::Hangs => Event::Connected,
            BrokerBehavior::Breaks => {
                let events = [Event::Connected, Event::Acknowledged(1, None), Event::Lost(Loss::Protocol("noise"))];
                return Ok(Connection::new(self, events.into()));
            }
            BrokerBehavior::Mute => return Ok(Connection::new(self, VecDeque::new())),
            BrokerBehavior::Lost => pending().await,
        };
        let incoming = std::mem::take(&mut *self.incoming.borrow_mut());
        Ok(Connection::new(self, std::iter::once(first).chain(incoming).collect()))
    }
}

impl Uplink for Connection<'_> {
    async fn next(&mut self) -> Event {
        loop {
            let changed = self.fake_uplink.changed.notified();
            if *self.fake_uplink.behavior.borrow() == BrokerBehavior::Away {
                return Event::Lost(Loss::Closed);
            }
            if let Some(event) = self.events.pop_front() {
                return event;
            }
            changed.await;
        }
    }

    fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError> {
        let id = self.next;
        self.next += 1;
        if *self.fake_uplink.behavior.borrow() == BrokerBehavior::Works {
            self.fake_uplink.taken.borrow_mut().push(message.clone());
            self.events.push_back(Event::Acknowledged(id, None));
        }
        Ok(Some(id))
    }

    /// The broker sends the retained messages of these topics.
    fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError> {
        self.events.push_back(Event::Subscribed(true));
        let retained = self.fake_uplink.retained.borrow();
        let messages = retained.iter().filter(|message| topics.contains(&message.topic));
        self.events.extend(messages.cloned().map(Event::Message));
        Ok(())
    }

    fn unsubscribe(&mut self, _: &[String]) -> Result<(), SendError> {
        Ok(())
    }

    fn ping(&mut self) -> u64 {
        self.pings += 1;
        self.events.push_back(Event::Pong(self.pings));
        self.pings
    }

    fn room(&self) -> Option<u16> {
        None
    }

    fn unsent(&mut self) -> usize {
        0
    }

    async fn close(self) {
        if *self.fake_uplink.behavior.borrow() == BrokerBehavior::Hangs {
            pending::<()>().await;
        }
    }
}

const KINDS: [Kind; 3] = [Kind::Status, Kind::Alarms, Kind::Position];

fn plain() -> Box<dyn MessageFormat> {
    plain_with(vec![AnnouncedTopics::default(), AnnouncedTopics::default()], &[])
}

fn plain_with(announced: Vec<AnnouncedTopics>, robots: &[Robot]) -> Box<dyn MessageFormat> {
    let also: Rc<[AlsoCommand]> = Rc::from([]);
    let topics = Topics { prefix: "armctl".to_owned(), node: "cell7".to_owned(), ..Topics::default() };
    let times = Times { every_ms: 60_000, expiry: Duration::from_secs(180) };
    Box::new(PlainFormat::new(topics, (&KINDS, also), times, (announced, robots)))
}

/// Records log messages, except those for `-v`.
#[derive(Debug, Default)]
struct LogRecorder {
    log_lines: RefCell<Vec<String>>,
    is_reached: Cell<bool>,
}

impl Listener for LogRecorder {
    fn log(&self, level: Level, text: &str) {
        if level != Level::Detail {
            self.log_lines.borrow_mut().push(text.to_owned());
        }
    }

    fn set_broker(&self, _: &Url, is_connected: bool) {
        self.is_reached.set(is_connected);
    }
}

/// Runs the pump with events from `script`. Returns the log and the counters.
async fn pumped(
    fake_uplink: &FakeUplink,
    outbox: Outbox,
    script: impl AsyncFnOnce(mpsc::UnboundedSender<Found>),
) -> (Result<Counts, Failure>, Vec<String>) {
    pumped_as(plain(), &[fake_uplink], outbox, script).await
}

async fn pumped_as(
    format: Box<dyn MessageFormat>,
    brokers: &[&FakeUplink],
    outbox: Outbox,
    script: impl AsyncFnOnce(mpsc::UnboundedSender<Found>),
) -> (Result<Counts, Failure>, Vec<String>) {
    let notes = LogRecorder::default();
    let (tell, mut found) = mpsc::unbounded_channel();
    let mut pump = Delivery::new(brokers, format, outbox, (&notes, Backoff::new(7)), false);
    let pumped = async {
        let ended = pump.run(async || found.recv().await, pending()).await;
        let counts = pump.end(false).await;
        ended.map(|()| counts)
    };
    let (counts, ()) = futures_util::future::join(pumped, script(tell)).await;
    (counts, notes.log_lines.into_inner())
}

const MEMORY: usize = 1 << 20;

#[tokio::test(start_paused = true)]
async fn publishes_changes_at_once_and_other_values_at_an_interval() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Works);
    let (counts, _) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        let press = robot("press");
        for x_mm in [1.0, 1.0, 2.0] {
            tell.send(look(&press, x_mm, &[])).unwrap();
        }
        tell.send(silence(&press)).unwrap();
        tell.send(silence(&press)).unwrap();
        tell.send(Found::Gone(press)).unwrap();
    })
    .await;
    let kinds = |kinds: [&str; 3]| kinds.map(|kind| format!("armctl/press/{kind}"));
    let mut expected = vec!["armctl/cell7/state".to_owned()];
    expected.extend(kinds(["status", "alarms", "position"]));
    expected.push("armctl/press/position".to_owned());
    // A silent robot is reported in all its topics at once. The topics of a removed robot are cleared.
    expected.extend(kinds(["status", "alarms", "position"]));
    expected.extend(kinds(["alarms", "position", "status"]));
    expected.push("armctl/cell7/state".to_owned());
    assert_eq!(fake_uplink.topics(), expected);
    assert_eq!(fake_uplink.places("press"), [1.0, 2.0]);
    let taken = fake_uplink.taken.borrow();
    assert!(taken.iter().all(|message| message.retain && message.acknowledged));
    assert_eq!((&taken[0].payload[..], &taken[11].payload[..]), (&b"online"[..], &b"offline"[..]));
    assert!(taken[8..11].iter().all(|message| message.payload.is_empty() && message.expiry.is_none()));
    assert!(taken[1..8].iter().all(|message| message.expiry == Some(Duration::from_secs(180))));
    assert_eq!((taken[0].expiry, taken[11].expiry), (None, None));
    let silent: serde_json::Value = serde_json::from_slice(&taken[5].payload).unwrap();
    assert_eq!(
        (&silent["ok"], &silent["data"]["reachable"], &silent["error"]["kind"], &silent["node"]),
        (&false.into(), &false.into(), &"no_answer".into(), &"cell7".into())
    );
    assert_eq!(counts.unwrap(), Counts { published: 10, ..Counts::default() });
}

#[tokio::test(start_paused = true)]
async fn clears_topics_of_the_previous_process_but_not_of_another_node() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("topics");
    let topics = ["armctl/press", "armctl/loader", "armctl/picker"].map(|robot| format!("{robot}/status"));
    let old = format!("old/cell7/state\n{}\n", topics.join("\n"));
    std::fs::write(&file, old).unwrap();
    let fake_uplink = FakeUplink::new(BrokerBehavior::Works);
    let retained = [("armctl/picker/status", "{\"node\":\"cell8\"}"), ("armctl/loader/status", "{\"node\":\"cell7\"}")];
    fake_uplink.retained.replace(
        retained
            .map(|(topic, payload)| Message {
                topic: topic.to_owned(),
                payload: payload.as_bytes().to_vec(),
                retain: true,
                acknowledged: true,
                expiry: None,
            })
            .to_vec(),
    );
    let press = robot("press");
    let format = plain_with(vec![AnnouncedTopics::open(Some(file.clone()))], &[(*press).clone()]);
    // Data of a previous process is still delivered, but not retained again.
    let mut outbox = Outbox::new(MEMORY, None);
    let key = "armctl/loader/status".to_owned();
    outbox.push(super::outbox::Record { kind: 0, time_ms: 1, key, body: b"{}".to_vec(), epoch: 0 });
    let (counts, log_lines) = pumped_as(format, &[&fake_uplink], outbox, async |tell| drop(tell)).await;
    let taken = fake_uplink.taken.borrow();
    let sent: Vec<_> = taken.iter().map(|sent| (&sent.topic[..], sent.payload.is_empty(), sent.retain)).collect();
    let expected = [
        ("armctl/cell7/state", false, true),
        ("armctl/loader/status", false, false),
        ("armctl/loader/status", true, true),
        ("old/cell7/state", true, true),
        ("armctl/cell7/state", false, true),
    ];
    assert_eq!(sent, expected, "{log_lines:?}");
    assert_eq!(counts.unwrap().published, 3);
    let left = "armctl/cell7/state\narmctl/press/alarms\narmctl/press/position\narmctl/press/status\n";
    assert_eq!(std::fs::read_to_string(&file).unwrap(), left);
}

#[tokio::test(start_paused = true)]
async fn writes_to_disk_only_while_the_broker_is_away() {
    let folder = TempDir::new().unwrap();
    let on_disk = || {
        let files = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().path());
        let spools = files.filter(|path| path.extension().is_some_and(|suffix| suffix == "spool"));
        spools.map(|path| path.metadata().unwrap().len()).sum::<u64>()
    };
    let spool = Spool::open(folder.path(), 1 << 20, SyncPolicy::Every(Duration::from_secs(1))).unwrap();
    let fake_uplink = FakeUplink::new(BrokerBehavior::Works);
    let (counts, _) = pumped(&fake_uplink, Outbox::new(MEMORY, Some(spool)), async |tell| {
        let press = robot("press");
        for second in 0..60 {
            match second {
                20 => fake_uplink.set_behavior(BrokerBehavior::Away),
                40 => fake_uplink.set_behavior(BrokerBehavior::Works),
                _ => {}
            }
            let before = on_disk();
            tell.send(look(&press, f64::from(second), &[])).unwrap();
            sleep(Duration::from_millis(100)).await;
            match second {
                0..20 => assert_eq!(on_disk(), 0, "{second}"),
                20..40 => assert!(on_disk() > before, "{second}: the first message is on disk at once"),
                _ => {}
            }
            sleep(Duration::from_millis(900)).await;
        }
        sleep(Duration::from_secs(60)).await;
        tell.send(look(&press, 60.0, &[])).unwrap();
        sleep(Duration::from_secs(1)).await;
        assert_eq!(on_disk(), 0);
    })
    .await;
    assert_eq!(fake_uplink.places("press"), (0..61).map(f64::from).collect::<Vec<_>>());
    assert_eq!(counts.unwrap().reconnects, 1);
}

#[tokio::test(start_paused = true)]
async fn writes_to_disk_while_the_broker_acknowledges_nothing() {
    let folder = TempDir::new().unwrap();
    let spool = Spool::open(folder.path(), 1 << 20, SyncPolicy::Every(Duration::from_secs(1))).unwrap();
    let fake_uplink = FakeUplink::new(BrokerBehavior::Hangs);
    let (counts, _) = pumped(&fake_uplink, Outbox::new(MEMORY, Some(spool)), async |tell| {
        tell.send(look(&robot("press"), 1.0, &[])).unwrap();
        sleep(Duration::from_secs(5)).await;
        let files = std::fs::read_dir(folder.path()).unwrap().count();
        assert!(files > 0);
        fake_uplink.set_behavior(BrokerBehavior::Works);
    })
    .await;
    assert_eq!((counts.unwrap().dropped, fake_uplink.places("press")), (0, vec![1.0]));
}

#[tokio::test(start_paused = true)]
async fn sends_a_delayed_rebirth() {
    let broker = FakeUplink::new(BrokerBehavior::Works);
    // The request arrives directly after the births.
    broker.incoming.borrow_mut().push_back(Event::Message(rebirth_request()));
    let (notes, brokers) = (LogRecorder::default(), [&broker]);
    let outbox = Outbox::new(MEMORY, None);
    let mut pump = Delivery::new(&brokers, plain_node(), outbox, (&notes, Backoff::new(7)), false);
    pump.run(async || pending().await, sleep(Duration::from_secs(2))).await.unwrap();
    assert_eq!(broker.topics(), ["spBv1.0/Plant/NBIRTH/Cell7"; 2]);
}

#[tokio::test(start_paused = true)]
async fn one_minute_without_broker_loses_nothing() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Works);
    let (counts, log_lines) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        let press = robot("press");
        for second in 0..90 {
            match second {
                15 => fake_uplink.set_behavior(BrokerBehavior::Away),
                75 => fake_uplink.set_behavior(BrokerBehavior::Works),
                _ => {}
            }
            tell.send(look(&press, f64::from(second), &[])).unwrap();
            sleep(Duration::from_secs(1)).await;
        }
    })
    .await;
    assert_eq!(fake_uplink.places("press"), (0..90).map(f64::from).collect::<Vec<_>>());
    assert_eq!(counts.unwrap(), Counts { published: 92, reconnects: 1, ..Counts::default() });
    assert!(
        log_lines.iter().any(|line| line.contains("again after") && line.contains("in the buffer")),
        "{log_lines:?}"
    );
    assert_eq!(log_lines.iter().filter(|line| line.contains("closed the connection")).count(), 1, "{log_lines:?}");
}

#[tokio::test(start_paused = true)]
async fn full_buffer_drops_and_reports_the_oldest_record() {
    let folder = TempDir::new().unwrap();
    let spool = Spool::open(folder.path(), 16 << 10, SyncPolicy::Never).unwrap();
    let fake_uplink = FakeUplink::new(BrokerBehavior::Away);
    let (counts, log_lines) = pumped(&fake_uplink, Outbox::new(4096, Some(spool)), async |tell| {
        let press = robot("press");
        for second in 0..300 {
            tell.send(look(&press, f64::from(second), &[])).unwrap();
        }
        sleep(Duration::from_secs(10)).await;
        fake_uplink.set_behavior(BrokerBehavior::Works);
    })
    .await;
    let counts = counts.unwrap();
    assert!(counts.dropped > 0 && counts.published > 20 && counts.published + counts.dropped == 302, "{counts:?}");
    let places = fake_uplink.places("press");
    let first = 300 - u32::try_from(places.len()).unwrap();
    assert_eq!(places, (first..300).map(f64::from).collect::<Vec<_>>());
    assert!(
        log_lines.iter().any(|line| line.contains(&format!("{} messages were dropped", counts.dropped))),
        "{log_lines:?}"
    );
}

#[tokio::test(start_paused = true)]
async fn retry_pauses_grow_to_a_minute_with_jitter() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Away);
    let (counts, _) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        sleep(Duration::from_secs(600)).await;
        fake_uplink.set_behavior(BrokerBehavior::Works);
        drop(tell);
    })
    .await;
    counts.unwrap();
    let attempts = fake_uplink.attempts.borrow();
    let pauses: Vec<f64> = attempts.windows(2).map(|pair| (pair[1] - pair[0]).as_secs_f64()).collect();
    assert!((0.7..1.3).contains(&pauses[0]) && (1.4..2.6).contains(&pauses[1]), "{pauses:?}");
    assert!(pauses[7..].iter().all(|pause| (44.0..76.0).contains(pause)), "{pauses:?}");
    assert!(pauses[7..].windows(2).all(|pair| (pair[0] - pair[1]).abs() > 1e-6), "{pauses:?}");
    assert!(attempts[0] - fake_uplink.start < Duration::from_millis(10), "the first one at once");
}

#[tokio::test(start_paused = true)]
async fn retry_pauses_grow_after_short_connections() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Breaks);
    let (counts, log_lines) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        sleep(Duration::from_secs(600)).await;
        fake_uplink.set_behavior(BrokerBehavior::Works);
        drop(tell);
    })
    .await;
    counts.unwrap();
    let attempts = fake_uplink.attempts.borrow();
    assert!((12..22).contains(&attempts.len()), "{attempts:?}");
    assert!(
        log_lines.iter().any(|line| line.contains("the broker does not follow the MQTT protocol: noise")),
        "{log_lines:?}"
    );
}

#[tokio::test(start_paused = true)]
async fn ends_within_a_second_in_every_state() {
    for behavior in [
        BrokerBehavior::Works,
        BrokerBehavior::Away,
        BrokerBehavior::Hangs,
        BrokerBehavior::Breaks,
        BrokerBehavior::Mute,
        BrokerBehavior::Lost,
    ] {
        let fake_uplink = FakeUplink::new(behavior);
        let (brokers, notes) = ([&fake_uplink], LogRecorder::default());
        let outbox = Outbox::new(MEMORY, None);
        let mut pump = Delivery::new(&brokers, plain(), outbox, (&notes, Backoff::new(7)), false);
        let mut looks = [1.0, 2.0].map(|x_mm| look(&robot("press"), x_mm, &[])).into_iter();
        let found = async || match looks.next() {
            Some(look) => Some(look),
            None => pending().await,
        };
        pump.run(found, sleep(Duration::from_millis(200))).await.unwrap();
        let stopped = Instant::now();
        pump.end(false).await;
        assert!(stopped.elapsed() <= END_TIMEOUT, "{behavior:?}: {:?}", stopped.elapsed());
    }
}

#[tokio::test(start_paused = true)]
async fn leaves_a_broker_that_acknowledges_nothing() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Hangs);
    let (counts, log_lines) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        let press = robot("press");
        for second in 0..100 {
            tell.send(look(&press, f64::from(second), &[])).unwrap();
            sleep(Duration::from_secs(1)).await;
            if second == 60 {
                fake_uplink.set_behavior(BrokerBehavior::Works);
            }
        }
    })
    .await;
    assert_eq!(fake_uplink.places("press"), (0..100).map(f64::from).collect::<Vec<_>>());
    assert!(counts.unwrap().reconnects >= 1);
    assert!(log_lines.iter().any(|line| line.contains("does not answer any longer")), "{log_lines:?}");
}

const REFUSALS: [(BrokerBehavior, &str); 4] = [
    (BrokerBehavior::Refuses(4), "wrong user name or password (check --user"),
    (BrokerBehavior::Refuses(5), "not authorized to connect (check --user"),
    (BrokerBehavior::Refuses(1), "this version of MQTT (try --protocol 5"),
    (
        BrokerBehavior::Distrusted,
        "the broker's certificate has expired (check the clock of this computer, or give the broker a new certificate)",
    ),
];

#[tokio::test(start_paused = true)]
async fn a_service_outlives_every_refusal() {
    for (behavior, why) in REFUSALS {
        for first in [behavior, BrokerBehavior::Works] {
            let fake_uplink = FakeUplink::new(first);
            let (counts, log_lines) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
                sleep(Duration::from_secs(1)).await;
                fake_uplink.set_behavior(BrokerBehavior::Away);
                sleep(Duration::from_millis(10)).await;
                fake_uplink.set_behavior(behavior);
                tell.send(look(&robot("press"), 1.0, &[])).unwrap();
                sleep(Duration::from_secs(1800)).await;
                fake_uplink.set_behavior(BrokerBehavior::Works);
            })
            .await;
            assert_eq!((counts.unwrap().published, fake_uplink.places("press")), (3, vec![1.0]));
            let attempts = fake_uplink.attempts.borrow().len();
            assert!((25..50).contains(&attempts), "{attempts} in half an hour");
            // Once at first, then every ten minutes.
            let lines = log_lines.iter().filter(|line| line.contains(why) && line.contains("next try in")).count();
            assert!((2..=4).contains(&lines), "{log_lines:?}");
        }
    }
}

#[tokio::test(start_paused = true)]
async fn a_bounded_run_ends_with_the_refusal() {
    for (behavior, why) in REFUSALS {
        let fake_uplink = FakeUplink::new(behavior);
        let (brokers, notes) = ([&fake_uplink], LogRecorder::default());
        let mut pump = Delivery::new(&brokers, plain(), Outbox::new(MEMORY, None), (&notes, Backoff::new(7)), true);
        let failure = pump.run(async || pending().await, pending()).await.unwrap_err();
        let (message, hint) = why.split_once(" (").unwrap();
        assert!(failure.message.contains(message) && failure.hint.unwrap().starts_with(hint.trim_end_matches(')')));
        assert_eq!((failure.kind, fake_uplink.attempts.borrow().len()), (failure::Kind::Usage, 1));
    }
}

#[tokio::test(start_paused = true)]
async fn waits_for_an_unavailable_broker() {
    let fake_uplink = FakeUplink::new(BrokerBehavior::Refuses(3));
    let (counts, _) = pumped(&fake_uplink, Outbox::new(MEMORY, None), async |tell| {
        tell.send(look(&robot("press"), 1.0, &[])).unwrap();
        sleep(Duration::from_secs(60)).await;
        fake_uplink.set_behavior(BrokerBehavior::Works);
    })
    .await;
    assert_eq!((counts.unwrap().published, fake_uplink.places("press")), (3, vec![1.0]));
}

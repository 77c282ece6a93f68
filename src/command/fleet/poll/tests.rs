//! Tests of the poller with in-process simulators, in virtual time.

use std::rc::Rc;

use futures_util::future::join;
use tempfile::TempDir;
use tokio::time::Instant;

use super::{Event, Extra, Poll, PollCounter, PollRequest, RobotId, Subscription};
use armctl_frame::face::sample::{Detail, Sample, Traffic};
use armctl_frame::prelude::*;
use armctl_frame::settings::inventory::{Inventory, Location};
use armctl_frame::settings::{Selection, Sources};

const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// An inventory in a temporary folder.
struct Plant {
    folder: TempDir,
}

impl Plant {
    fn new(robots: &[(&str, &str, &str)]) -> Self {
        let plant = Self { folder: tempfile::tempdir().unwrap() };
        plant.write(robots);
        plant
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("robots.toml")
    }

    /// Writes name, family and target of each robot, without retries.
    fn write(&self, robots: &[(&str, &str, &str)]) {
        let entry = |(name, family, target): &(&str, &str, &str)| {
            format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\nretries = 0\n")
        };
        self.write_text(&robots.iter().map(entry).collect::<String>());
    }

    fn write_text(&self, text: &str) {
        std::fs::write(self.path(), text).unwrap();
    }

    fn poll(&self, selection: Selection) -> Result<Poll> {
        let inventory = Inventory::load(&Location::Named(self.path())).unwrap();
        Poll::new(&Sources { selection, inventory, ..Sources::default() }, Screen::silent())
    }

    fn all(&self) -> Poll {
        self.poll(Selection { all: true, ..Selection::default() }).unwrap()
    }
}

fn fleet() -> Plant {
    Plant::new(&[("a", "yerc", "sim:"), ("b", "yrcx", "sim:"), ("c", "toyo", "sim:")])
}

/// Runs a poller for one consumer until `consume` returns.
async fn subscription<T>(mut poll: Poll, request: PollRequest, consume: impl AsyncFnOnce(&mut Subscription) -> T) -> T {
    let mut events = poll.subscribe(request);
    let received_events = async {
        let seen = consume(&mut events).await;
        drop(events);
        seen
    };
    join(poll.run(), received_events).await.1
}

/// Names of the next `count` events, with or without polls.
async fn received(events: &mut Subscription, count: usize, looks: bool) -> Vec<String> {
    let mut all = Vec::new();
    while all.len() < count {
        match events.next().await.expect("it goes on") {
            Event::Appeared(robot) => all.push(format!("appeared {}", robot.name)),
            Event::Polled(look) if looks => all.push(format!("looked {}", look.robot.name)),
            Event::Polled(_) => {}
            Event::Failed { robot, pause, .. } => all.push(format!("failed {} {}", robot.name, pause.as_secs())),
            Event::Gone(robot) => all.push(format!("gone {}", robot.name)),
            Event::Inventory(read) => all.push(match read {
                Ok(()) => "inventory".to_owned(),
                Err(failure) => format!("inventory {:?}", failure.kind),
            }),
        }
    }
    all
}

#[tokio::test(start_paused = true)]
async fn polls_every_family_in_each_detail() {
    let ids = ["a", "b", "c"];
    for (detail, whole) in [(Detail::Summary, None), (Detail::Axes, None), (Detail::Full, None)]
        .into_iter()
        .chain((0..3).map(|at| (Detail::Summary, Some(at))))
    {
        let plant = fleet();
        let poll = plant.all();
        let id = whole.map(|at: usize| RobotId::for_robot(&poll.robots()[at]));
        let request = PollRequest { detail, whole: id, ..PollRequest::every(POLL_INTERVAL) };
        let samples = subscription(poll, request, async |events: &mut Subscription| {
            let mut samples: BTreeMap<String, Vec<Sample>> = BTreeMap::new();
            while samples.len() < 3 || samples.values().any(|samples| samples.len() < 3) {
                if let Event::Polled(look) = events.next().await.expect("it goes on") {
                    samples.entry(look.robot.name.clone()).or_default().push(look.sample.clone());
                }
            }
            samples
        })
        .await;
        for (at, name) in ids.iter().enumerate() {
            let sample = samples[*name].last().unwrap();
            assert!(sample.line.state.mode.is_some() && sample.line.state.position.is_some());
            let full = detail == Detail::Full || whole == Some(at);
            assert_eq!(sample.full.is_some(), detail > Detail::Summary || full, "{name} {detail:?}");
            if let Some(found) = &sample.full {
                assert!(found.indicators.len() > 8 && found.axes.len() >= 4, "{found:?}");
                assert_eq!(found.axes.iter().any(|axis| axis.torque.is_some()), *name != "c", "{name}: {found:?}");
                assert_eq!(found.banks.len(), if full { 2 } else { 0 }, "{name}: {found:?}");
                assert!(found.banks.iter().all(|bank| !bank.groups.is_empty()), "{found:?}");
            }
        }
    }
}

/// A robot that answers gets no more polls than the slowest one.
#[tokio::test(start_paused = true)]
async fn counts_the_polls_of_each_robot() {
    let plant = Plant::new(&[("a", "yerc", "sim:"), ("b", "yerc", "sim:?fault=drop%3D100%25")]);
    let poll = plant.all();
    let ids: Vec<RobotId> = poll.robots().iter().map(RobotId::for_robot).collect();
    let polls = subscription(poll, PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let (mut counter, mut polls) = (PollCounter::new(&ids, Some(2)), Vec::new());
        while let Some(event) = counter.next(events).await {
            match event {
                Event::Polled(poll) => polls.push(poll.robot.name.clone()),
                Event::Failed { robot, .. } => polls.push(robot.name.clone()),
                _ => {}
            }
        }
        polls
    })
    .await;
    assert_eq!(polls, ["a", "a", "b", "b"]);
}

#[tokio::test(start_paused = true)]
async fn unreachable_robot_does_not_delay_others() {
    let plant = Plant::new(&[
        ("a", "yerc", "sim:"),
        ("b", "yrcx", "sim:"),
        ("c", "toyo", "sim:"),
        // All traffic to this robot is lost.
        ("d", "yerc", "sim:?fault=drop%3D100%25"),
    ]);
    let start = Instant::now();
    let counts = subscription(plant.all(), PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let mut counts = BTreeMap::new();
        loop {
            match events.next().await.expect("it goes on") {
                Event::Polled(look) => {
                    *counts.entry(look.robot.name.clone()).or_insert(0_u128) += 1;
                    // An in-process YRCX has no network.
                    let Traffic { sent, received, disturbances } = look.traffic;
                    assert!((sent > 0 && sent == received) || look.robot.name == "b", "{look:?}");
                    assert_eq!(disturbances, 0, "{look:?}");
                }
                Event::Failed { robot, failure, traffic, .. } => {
                    assert_eq!((robot.name.as_str(), failure.kind), ("d", Kind::NoAnswer));
                    assert_eq!((traffic.sent, traffic.received), (1, 0));
                    return counts;
                }
                _ => {}
            }
        }
    })
    .await;
    let polls = start.elapsed().as_millis() / POLL_INTERVAL.as_millis();
    assert!(polls >= 10, "it takes a timeout until one knows");
    assert_eq!(counts.len(), 3);
    assert!(counts.values().all(|count| count + 2 >= polls), "{counts:?} of {polls}");
}

#[tokio::test(start_paused = true)]
async fn backoff_of_a_silent_robot_grows() {
    let plant = Plant::new(&[("d", "yerc", "sim:?fault=drop%3D100%25")]);
    let request = PollRequest { longest_pause: Duration::from_secs(5), ..PollRequest::every(POLL_INTERVAL) };
    let events =
        subscription(plant.all(), request, async |events: &mut Subscription| received(events, 6, true).await).await;
    assert_eq!(events, ["appeared d", "failed d 1", "failed d 2", "failed d 4", "failed d 5", "failed d 5"]);
}

#[tokio::test(start_paused = true)]
async fn polls_a_slow_line_at_its_own_pace() {
    let plant = Plant::new(&[("slow", "yerc", "sim:?fault=delay%3D150ms"), ("fast", "yerc", "sim:")]);
    let looks = subscription(plant.all(), PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let mut looks = Vec::new();
        while looks.len() < 3 {
            if let Event::Polled(look) = events.next().await.expect("it goes on") {
                if look.robot.name == "slow" {
                    looks.push((look.took, look.missed));
                } else {
                    assert_eq!(look.missed, 0, "the other one is not held up");
                }
            }
        }
        looks
    })
    .await;
    let (took, missed) = looks[2];
    assert!(took > 2 * POLL_INTERVAL, "{took:?}");
    let intervals = u64::try_from(took.as_millis() / POLL_INTERVAL.as_millis()).unwrap();
    assert_eq!(missed, intervals, "what a look takes of the next ones is left out: {looks:?}");
}

#[tokio::test(start_paused = true)]
async fn consumers_share_polls_at_the_shortest_interval() {
    let plant = fleet();
    let mut poll = plant.all();
    let mut one = poll.subscribe(PollRequest { detail: Detail::Axes, ..PollRequest::every(Duration::from_secs(10)) });
    let mut other = poll.subscribe(PollRequest::every(POLL_INTERVAL));
    let began = Instant::now();
    let compared = async {
        let mut looks = 0;
        while looks < 30 {
            match (one.next().await.unwrap(), other.next().await.unwrap()) {
                (Event::Polled(one), Event::Polled(other)) => {
                    assert!(Arc::ptr_eq(&one, &other), "asked once, for both");
                    assert!(one.sample.full.is_some(), "with all that any of them wants");
                    looks += 1;
                }
                (Event::Appeared(one), Event::Appeared(other)) => assert!(Arc::ptr_eq(&one, &other)),
                (one, other) => panic!("{one:?} {other:?}"),
            }
        }
        let ten_looks = began.elapsed();
        assert!(ten_looks >= 9 * POLL_INTERVAL && ten_looks <= 11 * POLL_INTERVAL, "{ten_looks:?}");
        // One consumer is dropped, so only the other request counts.
        drop(other);
        let mut last = BTreeMap::new();
        for _ in 0..12 {
            if let Event::Polled(look) = one.next().await.unwrap() {
                last.insert(look.robot.name.clone(), Instant::now());
            }
        }
        assert!(began.elapsed() >= Duration::from_secs(20), "every ten seconds: {:?}", began.elapsed());
        drop(one);
    };
    join(poll.run(), compared).await;
}

#[tokio::test(start_paused = true)]
async fn runs_extra_commands_with_the_polls_of_their_family() {
    let plant = fleet();
    let extras = ["yerc var get B0..B1", "toyo counter get 1", "yerc var get B0"];
    let extras: Rc<[Rc<Extra>]> = extras.iter().map(|text| Rc::new(Extra::parse(text).unwrap())).collect();
    let request = PollRequest { extras, ..PollRequest::every(POLL_INTERVAL) };
    let extras = subscription(plant.all(), request, async |events: &mut Subscription| {
        let mut extras = BTreeMap::new();
        while extras.len() < 3 {
            if let Event::Polled(look) = events.next().await.expect("it goes on") {
                let told = look.extras.iter().map(|(text, told)| (text.to_string(), told.clone()));
                extras.insert(look.robot.name.clone(), told.collect::<Vec<_>>());
            }
        }
        extras
    })
    .await;
    let texts = |robot: &str| extras[robot].iter().map(|(text, _)| text.as_str()).collect::<Vec<_>>();
    assert_eq!(texts("a"), ["yerc var get B0..B1", "yerc var get B0"]);
    assert_eq!(texts("b"), Vec::<&str>::new());
    assert_eq!(texts("c"), ["toyo counter get 1"]);
    for (text, told) in extras.values().flatten() {
        let data = told.as_ref().unwrap_or_else(|failure| panic!("{text}: {failure:?}"));
        assert!(data.as_object().is_some_and(|data| !data.is_empty()), "{text}: {data}");
    }
}

#[tokio::test(start_paused = true)]
async fn resolves_names_of_extra_commands_per_robot() {
    let plant = fleet();
    let entry = |name: &str, names: &str| {
        format!("[[robot]]\nname = \"{name}\"\nfamily = \"yerc\"\ntarget = \"sim:\"\n{names}\n")
    };
    let named = |address: &str| format!("[robot.names]\nparts = \"{address}\"");
    plant.write_text(&[entry("a", &named("B5")), entry("b", &named("B6")), entry("c", "")].concat());
    let extra = Rc::new(Extra::parse("yerc var get parts").unwrap());
    let request = PollRequest { extras: Rc::from([extra]), ..PollRequest::every(POLL_INTERVAL) };
    let told = subscription(plant.all(), request, async |events: &mut Subscription| {
        let mut told = BTreeMap::new();
        while told.len() < 3 {
            if let Event::Polled(look) = events.next().await.expect("it goes on") {
                told.insert(look.robot.name.clone(), look.extras[0].1.clone());
            }
        }
        told
    })
    .await;
    let address = |robot: &str| told[robot].as_ref().unwrap()["items"][0]["name"].clone();
    assert_eq!((address("a"), address("b")), ("B5".into(), "B6".into()));
    let failure = told["c"].as_ref().unwrap_err();
    assert!(failure.message.contains("'parts' is not a variable"), "{failure}");
}

#[tokio::test(start_paused = true)]
async fn follows_robots_of_the_inventory() {
    let plant = fleet();
    let told = subscription(plant.all(), PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let mut all = received(events, 3, false).await;
        // One robot is removed, one is added, one has changed.
        plant.write(&[("a", "yerc", "sim:"), ("c", "yerc", "sim:"), ("d", "toyo", "sim:")]);
        all.extend(received(events, 5, false).await);
        // A file that cannot be read changes nothing, and is reported once.
        plant.write_text("[[robot]]\nname = ");
        all.extend(received(events, 1, false).await);
        let later = Instant::now() + Duration::from_secs(10);
        while Instant::now() < later {
            assert!(matches!(events.next().await, Some(Event::Polled(_))), "those that are known are looked at");
        }
        plant.write(&[("a", "yerc", "sim:?fault=delay%3D1ms")]);
        all.extend(received(events, 5, false).await);
        std::fs::remove_file(plant.path()).unwrap();
        all.extend(received(events, 1, false).await);
        plant.write(&[]);
        all.extend(received(events, 2, false).await);
        plant.write(&[("e", "yrcx", "sim:")]);
        all.extend(received(events, 2, false).await);
        all
    })
    .await;
    let expected = "appeared a, appeared b, appeared c, inventory, gone c, gone b, appeared c, appeared d, \
                    inventory Usage, inventory, gone d, gone c, gone a, appeared a, inventory Usage, inventory, gone a, \
                    inventory, appeared e";
    // Removals run in parallel, so their order varies.
    assert_eq!(sorted_runs(&told.join(", ")), sorted_runs(expected));
}

/// List of events in which simultaneous events are sorted.
fn sorted_runs(told: &str) -> Vec<String> {
    let mut runs: Vec<Vec<&str>> = Vec::new();
    for event in told.split(", ").map(str::trim) {
        let verb = |event: &str| event.split(' ').next().unwrap_or_default().to_owned();
        match runs.last_mut() {
            Some(run) if verb(run[0]) == verb(event) => run.push(event),
            _ => runs.push(vec![event]),
        }
    }
    for run in &mut runs {
        run.sort_unstable();
    }
    runs.concat().into_iter().map(ToOwned::to_owned).collect()
}

#[tokio::test(start_paused = true)]
async fn ignores_an_incomplete_inventory() {
    let plant = fleet();
    let told = subscription(plant.all(), PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let mut all = received(events, 3, false).await;
        // The file grows between two checks, as with a slow editor.
        let mut text = String::new();
        for number in 0..10 {
            text += &format!("[[robot]]\nname = \"r{number}\"\nfamily = \"toyo\"\ntarget = \"sim:\"\n");
            plant.write_text(&text);
            let later = Instant::now() + Duration::from_millis(700);
            while Instant::now() < later {
                match events.next().await {
                    Some(Event::Polled(_)) => {}
                    told => all.push(format!("{told:?}")),
                }
            }
        }
        all.extend(received(events, 1 + 3 + 10, false).await);
        all
    })
    .await;
    assert_eq!(told[3], "inventory");
    assert_eq!(told.iter().filter(|told| told.starts_with("appeared r")).count(), 10, "{told:?}");
}

#[tokio::test(start_paused = true)]
async fn follows_names_and_tags_of_the_inventory() {
    let text = |tagged: &[&str]| -> String {
        let entry = |name: &&str| {
            let tags = if tagged.contains(name) { "tags = [\"line1\"]\n" } else { "" };
            format!("[[robot]]\nname = \"{name}\"\nfamily = \"toyo\"\ntarget = \"sim:\"\n{tags}")
        };
        ["a1", "a2", "b1"].iter().map(entry).collect()
    };
    let robots = |patterns: &[&str], tags: &[&str]| Selection {
        robots: patterns.iter().map(|name| (*name).to_owned()).collect(),
        tags: tags.iter().map(|tag| (*tag).to_owned()).collect(),
        ..Selection::default()
    };
    for (selection, first, then) in [
        (robots(&["a*"], &[]), &["appeared a1", "appeared a2"][..], &["gone a1", "gone a2"][..]),
        (robots(&[], &["line1"]), &["appeared a1"], &["gone a1", "appeared b1"]),
        (robots(&["a*", "b1"], &["line1"]), &["appeared a1"], &["gone a1", "appeared b1"]),
    ] {
        let plant = Plant::new(&[]);
        plant.write_text(&text(&["a1"]));
        let is_by_tag = !selection.tags.is_empty();
        let poll = plant.poll(selection).unwrap();
        let told = subscription(poll, PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
            let mut all = received(events, first.len(), false).await;
            plant.write_text(&if is_by_tag { text(&["b1"]) } else { String::new() });
            all.extend(received(events, 1 + then.len(), false).await);
            all
        })
        .await;
        let expected: Vec<&str> = first.iter().chain(&["inventory"]).chain(then).copied().collect();
        assert_eq!(sorted_runs(&told.join(", ")), expected);
    }
}

#[tokio::test(start_paused = true)]
async fn polls_a_fixed_robot_until_all_subscriptions_end() {
    let plant = fleet();
    let robot = plant.all().robots()[0].clone();
    let poll = Poll::of(robot, Screen::silent());
    std::fs::remove_file(plant.path()).unwrap();
    let told = subscription(poll, PollRequest::every(POLL_INTERVAL), async |events: &mut Subscription| {
        let told = received(events, 100, true).await;
        assert!(told[1..].iter().all(|told| told == "looked a"), "{told:?}");
        told.len()
    })
    .await;
    assert_eq!(told, 100);
}

#[test]
fn rejects_an_empty_selection() {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let _inside = runtime.enter();
    let plant = Plant::new(&[]);
    let failure = plant.poll(Selection { all: true, ..Selection::default() }).unwrap_err();
    assert_eq!(failure.kind, Kind::Usage);
    assert!(failure.hint.is_some());
    let named = Selection { robots: vec!["x".to_owned()], ..Selection::default() };
    assert_eq!(plant.poll(named).unwrap_err().kind, Kind::Usage);
    assert!(Path::new(&plant.path()).exists());
}

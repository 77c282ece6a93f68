//! Recordings of simulators and their replays, in virtual time.

use std::fs;

use serde_json::json;
use tempfile::TempDir;

use super::*;
use crate::command::families::FAMILIES;
use armctl_frame::backup::recording::Recorded;
use armctl_frame::settings::inventory::{Inventory, Location};
use armctl_frame::settings::{Selection, Sources};

const INTERVAL: Duration = Duration::from_millis(200);
const POLLS: u64 = 30;

/// Start states that differ from the default, and change while they are recorded.
const STATES: [(&str, &str); 3] = [
    (
        "yerc",
        r#"
servo = false
positions = { R1 = [1000, -2000, 3000, 0, 500, 0], B1 = [0] }
variables = { B0 = 9, B1 = 8 }
job = "TESTJOB"
event = [
    { at_ms = 900, do = "servo on" },
    { at_ms = 1500, do = "alarm 4315 3 1 COLLISION" },
    { at_ms = 2300, do = "alarm clear" },
    { at_ms = 2500, do = "io 10 on" },
    { at_ms = 3100, do = "alarm 4315 3 1 COLLISION" },
    { at_ms = 3900, do = "alarm clear" },
    { at_ms = 4100, do = "mode teach" },
    { at_ms = 4500, do = "remote off" },
    { at_ms = 4900, do = "hold pendant on" },
]
"#,
    ),
    (
        "yrcx",
        r#"
servo = true
ports = { "SO2()" = 5 }
event = [
    { at_ms = 900, do = "SO3()=129" },
    { at_ms = 1500, do = "alarm 12.600" },
    { at_ms = 2500, do = "power" },
    { at_ms = 3100, do = "mode manual" },
    { at_ms = 4100, do = "warning on" },
]
[[robot]]
position = [12345, -2000, 0, 500]
load = [0, 0, 33, 0]
"#,
    ),
    (
        "toyo",
        r#"
origin = true
position = [80.0, 20.0, 0.0, 0.0]
points = { 1 = { 1 = [10.0, 20.0, 5.0, 0.0] } }
speeds = { 5 = 20.0 }
ramps = { 1 = 0.1 }
steps = { 1 = ["SPD V=05", "MOVP a PT=001 CN=00 S V=00 POST", "END"] }
counters = { 1 = 7 }
event = [
    { at_ms = 500, do = "input 0/01/3 on" },
    { at_ms = 900, do = "start" },
    { at_ms = 2900, do = "error 28" },
    { at_ms = 3900, do = "clear" },
    { at_ms = 4300, do = "servo off" },
    { at_ms = 4700, do = "pendant on" },
]
"#,
    ),
];

/// A folder with an inventory of one robot of each family.
struct Plant {
    folder: TempDir,
}

impl Plant {
    fn new() -> Self {
        let plant = Self { folder: tempfile::tempdir().unwrap() };
        for (family, state) in STATES {
            fs::write(plant.path(&format!("{family}.toml")), state).unwrap();
        }
        plant
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Poller for a robot of each family, at `sim:?KEY=FILE`.
    fn poll(&self, key: &str, file: impl Fn(&str) -> PathBuf) -> Poll {
        self.poll_some("*", key, file)
    }

    /// Poller for the robots that match a pattern.
    fn poll_some(&self, robots: &str, key: &str, file: impl Fn(&str) -> PathBuf) -> Poll {
        let entry = |(family, _): &(&str, &str)| {
            let target = format!("sim:?{key}={}", file(family).display());
            format!("[[robot]]\nname = \"{family}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\nretries = 0\n")
        };
        fs::write(self.path("robots.toml"), STATES.iter().map(entry).collect::<String>()).unwrap();
        let inventory = Inventory::load(&Location::Named(self.path("robots.toml"))).unwrap();
        let selection = Selection { robots: vec![robots.to_owned()], ..Selection::default() };
        Poll::new(&Sources { selection, inventory, ..Sources::default() }, Screen::silent()).unwrap()
    }

    /// Records the start states.
    async fn record(&self, folder: &str) -> RecordReport {
        let poll = self.poll("state", |family| self.path(&format!("{family}.toml")));
        record(&self.path(folder)).record(poll, (INTERVAL, Some(POLLS)), &Screen::silent()).await.unwrap()
    }

    fn file(&self, folder: &str, family: &str) -> PathBuf {
        self.path(folder).join(family).join(FILE)
    }

    /// Lines of a recording without the first one.
    fn lines(&self, folder: &str, family: &str) -> Vec<Value> {
        let text = fs::read_to_string(self.file(folder, family)).unwrap();
        text.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect()
    }
}

fn record(folder: &Path) -> Record {
    let also = ["yerc var get B0..B1", "yerc hours", "toyo counter get 1"].map(ToOwned::to_owned).into();
    Record { folder: folder.to_owned(), within: None, max_size: u64::MAX, also }
}

#[tokio::test(start_paused = true)]
async fn replay_gives_a_poller_what_was_recorded() {
    assert_eq!(STATES.len(), FAMILIES.len(), "each family has a start state here");
    let plant = Plant::new();
    for (family, states) in [("yerc", 8), ("yrcx", 5), ("toyo", 9)] {
        // A simulator in this process starts with its link. With one robot, both starts have the same phase.
        for (folder, key) in [("first", "state"), ("second", "replay")] {
            let file = |family: &str| match key {
                "state" => plant.path(&format!("{family}.toml")),
                _ => plant.file("first", family),
            };
            let poll = plant.poll_some(family, key, file);
            let settings = (INTERVAL, Some(POLLS));
            let report = record(&plant.path(folder)).record(poll, settings, &Screen::silent()).await.unwrap();
            assert_eq!((report.ended, report.robots.len()), (End::Count, 1));
        }
        let (first, second) = (plant.lines("first", family), plant.lines("second", family));
        assert_eq!((first.len(), second.len()), (30, 30));
        let keys = ["status", "alarms", "axes", "signals", "also", "error"];
        let mut different: Vec<&Value> = Vec::new();
        for (before, after) in first.iter().zip(&second) {
            for key in ["at_ms"].into_iter().chain(keys) {
                assert_eq!(before[key], after[key], "{family} at {} ms: {key}", before["at_ms"]);
            }
            if different.last().is_none_or(|last| keys.iter().any(|key| last[key] != before[key])) {
                different.push(before);
            }
        }
        assert!(different.len() >= states, "{family}: only {different:#?}");
    }
    let yerc = plant.lines("first", "yerc");
    let alarms = |line: &Value| line["alarms"].as_array().unwrap().len();
    assert_eq!(yerc.iter().filter(|line| alarms(line) == 1).count(), 8, "two alarms of 800 ms");
    assert_eq!(yerc[0]["also"]["yerc var get B0..B1"]["items"][0]["value"], json!(9));
    assert_eq!(yerc[29]["status"]["controller_mode"], json!("teach"));
    assert_eq!(yerc[0]["axes"][1]["position"], json!(-2000.0));
    assert!(yerc[1]["answers"].as_object().unwrap().len() < 4, "only the differences: {}", yerc[1]);
    let yrcx = plant.lines("first", "yrcx");
    assert_eq!(yrcx[0]["signals"]["outputs"]["SO20"], json!("10100000"));
    assert_eq!(yrcx[10]["status"]["fault_code"], json!("12.600"));
    let toyo = plant.lines("first", "toyo");
    let position = |line: &Value| line["axes"][0]["position"].as_f64().unwrap();
    assert!(position(&toyo[0]) > 79.9 && position(&toyo[29]) < 50.0, "the program moved");
}

#[tokio::test(start_paused = true)]
async fn existing_recording_is_not_overwritten() {
    let plant = Plant::new();
    plant.record("first").await;
    let before = fs::read(plant.file("first", "yrcx")).unwrap();
    let poll = plant.poll("state", |family| plant.path(&format!("{family}.toml")));
    let failure = record(&plant.path("first")).record(poll, (INTERVAL, Some(1)), &Screen::silent()).await.unwrap_err();
    assert!(failure.message.ends_with("already exists and was not changed"), "{failure:?}");
    assert!(failure.hint.is_some());
    assert_eq!(fs::read(plant.file("first", "yrcx")).unwrap(), before);
    fs::create_dir(plant.path("second")).unwrap();
    fs::rename(plant.path("first").join("toyo"), plant.path("second").join("toyo")).unwrap();
    let poll = plant.poll("state", |family| plant.path(&format!("{family}.toml")));
    record(&plant.path("second")).record(poll, (INTERVAL, Some(1)), &Screen::silent()).await.unwrap_err();
    assert!(!plant.file("second", "yerc").exists(), "no robot is recorded if one robot cannot be recorded");
}

#[tokio::test(start_paused = true)]
async fn recording_ends_at_its_time_or_size() {
    let plant = Plant::new();
    let poll = || plant.poll("state", |family| plant.path(&format!("{family}.toml")));
    let within = Record { within: Some(Duration::from_secs(2)), ..record(&plant.path("time")) };
    let report = within.record(poll(), (INTERVAL, None), &Screen::silent()).await.unwrap();
    assert_eq!(report.ended, End::Time);
    // The last status reset of the YRCX controller is confirmed before the connection closes.
    assert!((2000..2010).contains(&report.elapsed_ms), "{report:?}");
    assert!(report.robots.iter().all(|robot| (10..=11).contains(&robot.polls) && robot.failed == 0), "{report:?}");
    let small = Record { max_size: 20_000, ..record(&plant.path("size")) };
    let report = small.record(poll(), (INTERVAL, None), &Screen::silent()).await.unwrap();
    let bytes: u64 = report.robots.iter().map(|robot| robot.bytes).sum();
    assert_eq!(report.ended, End::Size);
    assert!((20_000..30_000).contains(&bytes), "{bytes}");
    let written = |family| fs::metadata(plant.file("size", family)).unwrap().len();
    assert_eq!(["yerc", "yrcx", "toyo"].map(written).iter().sum::<u64>(), bytes);
}

#[tokio::test(start_paused = true)]
async fn robot_without_an_answer_is_recorded() {
    let plant = Plant::new();
    for family in ["yerc", "toyo"] {
        let poll = plant.poll_some(family, "fault", |_| "drop=100%25".into());
        let report = record(&plant.path("silent")).record(poll, (INTERVAL, Some(2)), &Screen::silent()).await.unwrap();
        assert_eq!((report.robots[0].polls, report.robots[0].failed), (2, 2), "{report:?}");
        let lines = plant.lines("silent", family);
        assert_eq!((&lines[0]["answers"], &lines[0]["error"]["kind"]), (&Value::Null, &json!("no_answer")));
        let recorded = Recorded::read(&plant.file("silent", family)).unwrap();
        assert!(recorded.samples.iter().all(|sample| sample.answers.is_none()));
    }
}

#[tokio::test(start_paused = true)]
async fn silence_is_replayed() {
    let plant = Plant::new();
    plant.record("first").await;
    for (family, _) in STATES {
        let path = plant.file("first", family);
        let text = fs::read_to_string(&path).unwrap();
        let lines = text.lines().enumerate().map(|(number, line)| match number {
            ..11 => format!("{line}\n"),
            // Polls 11 and later have no answer.
            _ => format!("{}\n", json!({"at_ms": 200 * number, "answers": null})),
        });
        fs::write(&path, lines.collect::<String>()).unwrap();
        let poll = plant.poll_some(family, "replay", |family| plant.file("first", family));
        let recorder = record(&plant.path("second"));
        let report = recorder.record(poll, (INTERVAL, Some(12)), &Screen::silent()).await.unwrap();
        assert_eq!((report.robots[0].polls, report.robots[0].failed), (12, 1), "{report:?}");
        assert_eq!(plant.lines("second", family)[11]["answers"], Value::Null);
    }
}

#[tokio::test(start_paused = true)]
async fn torn_last_line_is_not_used() {
    let plant = Plant::new();
    plant.record("first").await;
    let path = plant.file("first", "toyo");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, &text[..text.len() - 20]).unwrap();
    let recorded = Recorded::read(&path).unwrap();
    assert_eq!((recorded.samples.len(), recorded.is_torn), (29, true));
    fs::write(&path, text.replacen("{\"at_ms\"", "{\"at", 1)).unwrap();
    let failure = Recorded::read(&path).unwrap_err();
    assert!(failure.message.contains("line 2: "), "{failure:?}");
    fs::write(&path, text.lines().next().unwrap()).unwrap();
    assert!(Recorded::read(&path).unwrap_err().message.ends_with("contains no complete poll"));
    fs::write(&path, "{}\n").unwrap();
    assert!(Recorded::read(&path).unwrap_err().message.contains("line 1: it is not the first line of a recording"));
}

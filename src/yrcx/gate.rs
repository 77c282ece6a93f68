//! Tests that run every subcommand through the confirmation gate: its risk, no terminal for a question. Also compares
//! each dry run with the frames that were sent.

use std::sync::Mutex;

use super::commands::Commands;
use super::simulated::in_process;
use super::testing::{planned_line, resolved};
use crate::prelude::*;
use armctl_controller::simulator::run_options::RunOptions;
use armctl_controller::yrcx::image::COMMAND_WORDS;
use armctl_controller::yrcx::signal::resting;
use armctl_controller::yrcx::table::Row;
use armctl_frame::gate::{Gate, Grant};
use armctl_frame::settings::target::Sim;
use armctl_frame::testing::{self, QUIET};
use armctl_frame::{AnyCommand, CommandSet as _};
use armctl_transport::image::ImagePeer;

/// Command lines with the same first word, and what follows it.
type Lines = (&'static str, &'static [&'static str]);

/// Command lines that read.
const READS: &[Lines] = &[
    ("status", &["", "--full"]),
    ("status-reset", &[""]),
    ("point", &["get 0..3", "dump @/new.csv 0..3", "list 0..3", "list 0..3 --path"]),
    ("comment", &["get 50", "list 0..3", "watch 50", "dump @/comments.csv 0..3"]),
    ("pallet-data", &["get 10", "list 0..3", "watch 10", "dump @/pallets.csv 0..3"]),
    ("shift-data", &["get 4,5", "list 0..3", "watch 4", "dump @/shifts.csv 0..3"]),
    ("hand-data", &["get 1", "list 0..3", "watch 1", "dump @/hands.csv 0..3"]),
    ("var", &["get SGI1", "list SGI0..SGI3", "dump @/vars.csv SGI0..SGI3", "watch SGI1"]),
    ("port", &["watch DO2", "get DO2"]),
    ("param", &["get WEIGHT", "list TOLE", "watch WEIGHT", "dump @/params.csv TOLE"]),
    ("program", &["show --task 1"]),
    (
        "info",
        &["version", "system", "servo", "tasks", "line", "alarm", "speed", "arm", "origin", "torque", "slots", "inch"],
    ),
    ("alarm", &["list", "watch", "history"]),
    ("position", &[""]),
    ("clock", &["get"]),
    ("io", &["get", "list", "watch"]),
    ("auto-mode", &[""]),
    ("backup", &["@/new --only info,settings,pallets,shifts,hands,variables"]),
    ("diff", &["@/saved"]),
    ("eip", &["identity", "probe", "get 1 1 7"]),
    ("devicenet", &["scan", "identity", "probe"]),
    ("profibus", &["scan", "probe", "diag"]),
    ("profinet", &["identify", "probe"]),
];

/// Command lines that change something that can be set again.
const WRITES: &[Lines] = &[
    ("inch-distance", &["100"]),
    ("speed", &["manual 20"]),
    ("shift", &["select 4"]),
    ("hand", &["select 1"]),
    ("arm", &["select right"]),
    ("torque-limit", &["--axis 1 50"]),
    (
        "var",
        &[
            "set SGI1 1",
            "copy SGI1 SGI2",
            "restore @/variables.csv",
            "add SGI1 1",
            "sub SGI1 1",
            "mul SGI1 1",
            "div SGI1 1",
        ],
    ),
    ("port", &["set DO2 1"]),
    ("program", &["select --program 1 --priority 32", "reset --all-programs"]),
    ("clock", &["set 2026-03-01"]),
    ("alarm", &["reset"]),
    ("io", &["set SI20=on", "pulse SI20"]),
    ("emergency-stop", &[""]),
    ("reset", &[""]),
    ("stop", &[""]),
    ("raw", &["--wi 0x604"]),
    ("profinet", &["blink", "set-name robot-7 --temporary", "set-ip 192.168.0.10/24 --temporary"]),
];

/// Command lines that change settings of the device on the fieldbus. They send no remote commands.
const BOARDS: [&str; 4] =
    ["eip set 0xF5 1 3 00", "profinet set-name robot-7", "profinet set-ip 192.168.0.10/24", "profinet reset"];

/// Pairs of command lines: the first stores data, the second overwrites the data.
const DESTROYS: &[(&str, &str)] = &[
    ("point set 7 --mm 9,9,9,9", "teach 7 --in mm"),
    ("point set 7 --mm 9,9,9,9", "point set 7 --mm 1,2,3,4"),
    ("comment set 7 OLD", "comment set 7 NEW"),
    ("pallet-data set 7 2 2 1 1", "pallet-data set 7 3 2 1 1"),
    ("shift-data set 7 1 2 3 4", "shift-data set 7 axis_4=5"),
    ("hand-data set 7 1 1 2 3 0", "hand-data set 7 1 1 2 4 0"),
    ("param set TOLE.1 100", "param set TOLE.1 101"),
    ("param set TOLE.1 100", "param copy TOLE.2 TOLE.1"),
    ("param set TOLE.1 100", "param restore @/params-7.csv"),
    ("point set 7 --mm 9,9,9,9", "point-calc copy 1 --to 7"),
    ("point set 7 --mm 9,9,9,9", "point-calc add 1 --to 7"),
    ("point set 7 --mm 9,9,9,9", "point-calc sub 1 --from 7"),
    ("point set 7 --mm 9,9,9,9", "point-calc pallet 10 --place 1 --to 7"),
    ("point set 7 --mm 9,9,9,9", "point-calc element 7 --element 1 --mm 1"),
    ("shift-data set 7 1 2 3 4", "point-calc shift-element 7 --element 1 --mm 9"),
    ("point set 7 --mm 9,9,9,9", "raw --wi 0x100,1,7,0,1"),
    ("pallet-data set 10 3 3 1 1", "restore @/saved"),
    ("point set 7 --mm 9,9,9,9", "point restore @/points.csv"),
    ("point set 7 --mm 9,9,9,9", "point copy 1 7"),
    ("comment set 7 OLD", "comment copy 50 7"),
    ("comment set 7 OLD", "comment restore @/comments-7.csv"),
    ("pallet-data set 7 2 2 1 1", "pallet-data copy 10 7"),
    ("pallet-data set 7 2 2 1 1", "pallet-data restore @/pallets-7.csv"),
    ("shift-data set 7 1 2 3 4", "shift-data copy 5 7"),
    ("shift-data set 7 1 2 3 4", "shift-data restore @/shifts-7.csv"),
    ("hand-data set 7 1 1 2 3 0", "hand-data copy 1 7"),
    ("hand-data set 7 1 1 2 3 0", "hand-data restore @/hands-7.csv"),
];

/// Command lines that move the robot, or give or take servo power.
const MOTIONS: &[Lines] = &[
    ("move", &["--point 19"]),
    ("movei", &["--point 19"]),
    ("movet", &["--point 19"]),
    ("drive", &["--axis 3 --point 19"]),
    ("drivei", &["--axis 3 --point 19"]),
    ("pallet", &["--pallet 1 --position 21"]),
    ("push", &["--axis 3 --point 19"]),
    ("jog", &["pulse 1 + --for 100ms"]),
    ("inch", &["pulse 1 +"]),
    ("origin", &[""]),
    ("servo", &["on", "off"]),
    ("motor", &["on", "off"]),
    ("program", &["run --all-programs", "run MAIN", "step --task 1", "skip --task 1", "next --task 1"]),
    ("power-on", &[""]),
    ("recover", &[""]),
    ("run", &[""]),
    ("raw", &["--wi 0x42"]),
    ("profinet", &["probe --try"]),
    ("eip", &["probe --try"]),
];

/// Commands without visible frames. `io watch` only reads. `status-reset` sends zeros, which are equal to the resting
/// image.
const SHOWN: [&str; 2] = ["io watch", "status-reset"];

/// Command line that the user must confirm with a word, because its effect cannot be undone.
const WORD: &str = "abs-reset --axis 2";

/// Folder with the backup files that the command lines name.
struct Workspace(tempfile::TempDir);

impl Workspace {
    fn new() -> Self {
        let workspace = Self(tempfile::tempdir().unwrap());
        let mut bench = Bench::new();
        bench.run(&workspace.line("backup @/saved --only pallets,shifts"), true).unwrap();
        for (name, text) in [
            ("points.csv", "name;unit;axis_2;comment\n7;mm;-2,5;SEVEN\n"),
            ("comments-7.csv", "name,comment\n7,NEW\n"),
            ("pallets-7.csv", "name,nx\n7,3\n"),
            ("shifts-7.csv", "name,axis_4_mm\n7,5\n"),
            ("params-7.csv", "name,value\nTOLE.1,101\n"),
            ("hands-7.csv", "name,data_3_mm\n7,4\n"),
            ("variables.csv", "name,value\nSGI1,1\n"),
        ] {
            std::fs::write(workspace.0.path().join(name), text).unwrap();
        }
        workspace
    }

    fn line(&self, line: &str) -> String {
        line.replace('@', self.0.path().to_str().unwrap())
    }
}

/// All command lines, with the expected risk of each.
fn lines() -> impl Iterator<Item = (String, Risk)> {
    let with = |lines: &'static [Lines], risk| {
        let lines = lines.iter().flat_map(|(word, rests)| rests.iter().map(move |rest| format!("{word} {rest}")));
        lines.map(move |line| (line.trim_end().to_owned(), risk))
    };
    let destroys = DESTROYS.iter().map(|(_, line)| *line).chain([WORD]).chain(BOARDS);
    let destroys = destroys.map(|line| (line.to_owned(), Risk::Destroy));
    with(READS, Risk::Read).chain(with(WRITES, Risk::Write)).chain(destroys).chain(with(MOTIONS, Risk::Motion))
}

/// Commands that need no connection to a robot.
const AT_DESK: [&str; 2] = ["yrcx.io.map", "yrcx.profinet.gsdml"];

/// Returns the command of a line, and a robot that the gate treats as a real controller.
fn real(line: &str) -> (Robot, Box<dyn AnyCommand>) {
    let words: Vec<&str> = line.split(' ').collect();
    resolved(url_for(line), &words).unwrap_or_else(|failure| panic!("{line:?}: {failure}"))
}

/// Whether a command line uses the explicit messaging client.
fn is_for_board(line: &str) -> bool {
    ["eip ", "profibus ", "profinet "].iter().any(|bus| line.starts_with(bus))
}

/// Returns a target URL for a command line. A command of a fieldbus needs a URL of that fieldbus.
fn url_for(line: &str) -> &'static str {
    match line.split(' ').next() {
        Some("profibus") => "profibus:///dev/null?station=5",
        Some("profinet") => "profinet://robot-1@eth0",
        _ => "eip://127.0.0.1",
    }
}

#[test]
fn every_command_has_its_expected_risk() {
    let mut seen: BTreeSet<&str> = AT_DESK.into();
    for (line, risk) in lines() {
        let (_, command) = real(&line);
        assert_eq!(command.intent(None).risk, risk, "{line}");
        seen.insert(command.id());
    }
    let all: BTreeSet<&str> = Commands::schemas().iter().map(|entry| entry.id).collect();
    assert_eq!(all.difference(&seen).collect::<Vec<_>>(), Vec::<&&str>::new(), "these have no line");
}

#[test]
fn overwrites_only_after_confirmation() {
    let workspace = Workspace::new();
    for (before, line) in DESTROYS {
        let mut bench = Bench::new();
        bench.run(before, true).unwrap();
        bench.sent();
        let failure = bench.run(&workspace.line(line), false).unwrap_err();
        assert_eq!((failure.kind.exit(), line), (7, line), "{failure}");
        assert!(failure.message.contains(" -> ") && failure.message.contains("would overwrite "), "{line}: {failure}");
        let risks = bench.sent().into_iter().map(|frame| frame.risk());
        assert!(risks.clone().all(|risk| risk == Risk::Read) && risks.count() > 0, "{line}");
        bench.run(&workspace.line(line), true).unwrap();
        assert_eq!(bench.sent().iter().map(Frame::risk).max(), Some(Risk::Destroy), "{line}");
        // The second run overwrites nothing, unless the command adds to a value or its result cannot be predicted.
        if !["add", "sub", "--place"].iter().any(|word| line.contains(word)) {
            bench.run(&workspace.line(line), false).unwrap();
        }
    }
    let motions = lines().filter(|(_, risk)| *risk == Risk::Motion).map(|(line, _)| line);
    for line in motions.chain([WORD.to_owned()]) {
        let (robot, command) = real(&line);
        let failure = Gate::default().must_ask(&QUIET, &robot, &command.intent(Some(&robot))).unwrap_err();
        assert_eq!(failure.kind.exit(), 7, "{line}");
    }
}

#[test]
fn new_data_needs_no_confirmation() {
    let workspace = Workspace::new();
    for line in [
        "teach --point 7 --in pulse",
        "point set 7 --mm 1,2,3,4",
        "comment set 7 NEW",
        "pallet-data set 7 3 2 1 1",
        "hand-data set 7 1 1 2 4 0",
        "point-calc copy 1 --to 7",
        "point-calc pallet 10 --place 1 --to 7",
        "restore @/saved",
    ] {
        let mut bench = Bench::new();
        bench.run(&workspace.line(line), false).unwrap_or_else(|failure| panic!("{line}: {failure}"));
    }
}

#[test]
fn a_dry_run_shows_a_frame_of_its_own_risk() {
    let workspace = Workspace::new();
    for (line, risk) in lines() {
        let plan =
            planned_line(url_for(&line), &workspace.line(&line)).unwrap_or_else(|failure| panic!("{line}: {failure}"));
        let risks: Vec<Risk> = frames(&plan).iter().map(|(frame, _)| frame.risk()).collect();
        if is_for_board(&line) {
            assert!(plan["frames"][0]["hex"].is_string() || plan["then"].is_string(), "{line}: {plan}");
        } else if risk > Risk::Read {
            assert_eq!(risks.iter().max(), Some(&risk), "{line}: {plan}");
        } else {
            assert!(risks.iter().all(|risk| *risk == Risk::Read), "{line}: {plan}");
        }
        let is_complete = plan["complete"] == true;
        assert_eq!(is_complete, plan["then"].is_null(), "{line}: {plan}");
    }
}

#[test]
fn a_dry_run_shows_what_is_sent() {
    let workspace = Workspace::new();
    let befores = DESTROYS.iter().map(|(before, line)| (Some(*before), (*line).to_owned()));
    let others = lines().filter(|(_, risk)| *risk != Risk::Destroy).map(|(line, _)| (None, line));
    for (before, line) in befores.chain(others).filter(|(_, line)| !is_for_board(line) && !SHOWN.contains(&&**line)) {
        let line = workspace.line(&line);
        let mut bench = Bench::new();
        if let Some(before) = before {
            bench.run(before, true).unwrap();
        }
        let plan = planned_line("sim:", &line).unwrap();
        bench.sent();
        let outcome = bench.run(&line, true);
        let mut sent = bench.sent().into_iter().peekable();
        for (frame, is_certain) in frames(&plan) {
            if sent.peek().is_some_and(|sent| frame.fits(sent)) {
                sent.next();
            } else if is_certain && outcome.is_ok() {
                panic!("{line}: {frame:?} is planned, {:?} is sent: {plan}", sent.peek());
            }
        }
        let rest: Vec<Frame> = sent.collect();
        assert!(rest.is_empty() || plan["complete"] == false, "{line}: {rest:?} is sent and not planned: {plan}");
    }
}

/// A frame: the words of a remote command, or the words of the signals.
#[derive(Debug, Clone, PartialEq)]
enum Frame {
    Words(Vec<String>),
    Bits(Vec<String>),
}

impl Frame {
    /// Whether this planned frame matches a sent frame. In a plan, `?` stands for a word that depends on a value read
    /// before.
    fn fits(&self, sent: &Self) -> bool {
        let ((Self::Words(planned), Self::Words(sent)) | (Self::Bits(planned), Self::Bits(sent))) = (self, sent) else {
            return false;
        };
        planned.len() == sent.len() && planned.iter().zip(sent).all(|(planned, sent)| planned == sent || planned == "?")
    }

    /// Returns the highest risk of the frame. For signals, this is the risk of the bits that differ from the resting
    /// image.
    fn risk(&self) -> Risk {
        match self {
            Self::Words(words) => Row::from_word(number(&words[0])).unwrap().risk,
            Self::Bits(bits) => risk_of(bits),
        }
    }
}

fn number(word: &str) -> u16 {
    u16::from_str_radix(word.trim_start_matches("0x"), 16).unwrap()
}

/// Returns the highest risk of the signals that differ from the resting image.
fn risk_of(bits: &[String]) -> Risk {
    let mut image = Image::default();
    for (word, text) in image.0[COMMAND_WORDS..].iter_mut().zip(bits) {
        *word = number(text);
    }
    let differ = Signal::all(Side::Input).filter(|signal| signal.is_on(&image) != signal.is_on(&resting()));
    differ.map(|signal| signal.risk(signal.is_on(&image))).max().unwrap_or(Risk::Write)
}

/// Returns the frames of a plan. The flag is `true` if the frame is sent in any case.
fn frames(plan: &Value) -> Vec<(Frame, bool)> {
    let texts =
        |value: &Value| value.as_array().map(|all| all.iter().map(|text| text.as_str().unwrap().to_owned()).collect());
    let frame = |frame: &Value| {
        let words = texts(&frame["wi"]).map(Frame::Words).or_else(|| texts(&frame["bits"]).map(Frame::Bits))?;
        let depends = frame["depends_on"].as_str();
        assert!(depends.is_none_or(|on| on.contains(" if ")), "{frame}");
        Some((words, depends.is_none()))
    };
    plan["frames"].as_array().unwrap().iter().filter_map(frame).collect()
}

/// Link to a simulated controller that records the frames that it receives.
struct Bench {
    runtime: tokio::runtime::Runtime,
    robot: Robot,
    link: Link,
    shown: Arc<Mutex<Vec<Frame>>>,
}

struct RecordingPeer<P>(P, Image, Arc<Mutex<Vec<Frame>>>);

impl<P: fmt::Debug> fmt::Debug for RecordingPeer<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<P: ImagePeer> ImagePeer for RecordingPeer<P> {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        if let Some(next) = image.and_then(Image::from_bytes) {
            let (was, is) = (self.1.0, next.0);
            let mut shown = self.2.lock().unwrap();
            if is[COMMAND_WORDS..] != was[COMMAND_WORDS..] {
                shown.push(Frame::Bits(super::link::hex(&is[COMMAND_WORDS..])));
            }
            if is[0] != 0 && is[..COMMAND_WORDS] != was[..COMMAND_WORDS] {
                shown.push(Frame::Words(super::link::hex(&is[..COMMAND_WORDS])));
            }
            self.1 = next;
        }
        self.0.input(now, image);
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.0.output(now)
    }

    fn wake(&self) -> Option<Duration> {
        self.0.wake()
    }
}

impl Bench {
    fn new() -> Self {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().start_paused(true).build().unwrap();
        let (simulated, _) = resolved("sim:", &["status"]).unwrap();
        let shown = Arc::default();
        let peer = RecordingPeer(
            in_process(&Sim::default(), RunOptions::default()).unwrap(),
            Image::default(),
            Arc::clone(&shown),
        );
        let access = Access::reading(ConnectMode::Control);
        let link = runtime.block_on(Link::to_peer(&simulated, &access, &QUIET, Box::new(peer))).unwrap();
        // The tests use the settings of a real controller, because the gate must treat the simulator as a real
        // controller.
        let (robot, _) = real("status");
        Self { runtime, robot, link, shown }
    }

    /// Runs a command line as `armctl_frame` does: with `--yes`, or without a terminal for the question.
    fn run(&mut self, line: &str, yes: bool) -> Result<Value> {
        let (_, command) = real(line);
        let intent = command.intent(Some(&self.robot));
        let gate = Gate { yes, ..Gate::default() };
        let grant = Grant::up_to(intent.initial_risk());
        let Self { runtime, robot, link, .. } = self;
        link.grant(grant.clone());
        let confirmer = Confirmer::new(gate, &QUIET, robot, intent.risk, grant);
        let context = Context { robot, link, screen: &QUIET, several: false, confirmer };
        let report = runtime.block_on(testing::run::<Yrcx>(&*command, context))?;
        report.failure().map_or_else(|| report.data(), Err)
    }

    /// Returns the frames that the controller received since the last call.
    fn sent(&mut self) -> Vec<Frame> {
        std::mem::take(&mut *self.shown.lock().unwrap())
    }
}

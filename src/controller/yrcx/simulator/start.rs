//! Start state from TOML.
//!
//! All keys have defaults: an empty file is a controller with four robots and servo power. The file adds to the content
//! of a new controller. Its robots replace the default robots. An error message gives the line.

mod initial_state;

use std::collections::BTreeMap;
use std::time::Duration;

use jiff::civil::DateTime;
use serde::Deserialize;
use toml::Spanned;

use super::defaults::{self, STOCK};
use super::geometry::Arm;
use super::request::Request;
use super::robot::{Method, Motor, Servo};
use super::task::State;
use super::world::{Mode, Switches, World};
use super::{commands, console};
use crate::Now;
use crate::simulator::recording::{Recording, Replayable};
use crate::simulator::run_options::RunOptions;
use crate::simulator::start::{self, Event, Source, Table, numbered};
use crate::simulator::with_defaults;
use crate::yrcx::image::Words;
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Value};

/// Start state of a simulated controller; [`Start::parse`] reads it (see [`EXAMPLE`]). [`Start::default`] has four
/// robots.
#[derive(Debug, Clone)]
pub struct Start {
    pub(super) world: World,
    pub(super) run_scans: u32,
    pub(super) seed: u64,
    pub(super) options: RunOptions,
    pub(super) recording: Recording,
}

/// A start state with all keys. Each key is optional.
pub const EXAMPLE: &str = r#"mode = "auto"                   # or "manual"
servo = true                    # motor power and servos; off at the start of a real controller
box = false                     # true: the programming box has control
inputs = true                   # false: a safety setting disables dedicated inputs and remote commands
sequence = false                # true: there is a sequence program for SI(10)
di17 = "abs"                    # or "abs/org": SI(17) returns incremental axes as well
movei_start = "keep"            # or "reset": a stopped relative motion starts again from its beginning
clock = "2026/03/14 08:00:00"
link_within_ms = 60000          # alarm if no master comes; without this key, none
run_scans = 0                   # quick commands show the run status for up to this number of scans, by the seed
seed = 0
versions = { host = "V1.08", revision = 48, fpga = "V1.001", drivers = ["V1.01", "V1.01", "V1.01", "V1.01"] }
slots = { 1 = ["EtherNet/IP", "DIO NPN general-purpose input", "none", "none"] }
variables = { SGI5 = 50, SGR0 = 1.5 }
ports = { "DI2()" = 127, "DO(20)" = 1 }
stock = true                    # false: only the points, programs and so on that are listed here

[[robot]]
kind = "cartesian"              # or "scara"; arms = [225, 175] in mm
axes = 4
model = 2000                    # its number in 4.7.2
pulses_per_unit = [1000, 1000, 1000, 1000]  # per mm or degree
limits = [[-1000000, 1000000], [-1000000, 1000000], [-500000, 500000], [-360000, 360000]]  # pulses
speeds = [1000, 1000, 500, 720] # mm or degrees a second
motors = ["absolute", "absolute", "absolute", "absolute"]  # incremental, semi-absolute
methods = ["mark", "mark", "mark", "mark"]  # sensor, stroke
origin = [true, true, true, true]
position = [0, 0, 0, 0]         # pulses
servos = ["servo", "servo", "servo", "servo"]  # brake, free; with servo = true
load = [0, 0, 20, 0]            # torque at rest, % of the maximum
obstacles = { 3 = 9000 }        # position in pulses where a push of that axis meets an obstacle
payload_g = 1000
max_payload_g = 10000
auto_speed = 100
manual_speed = 20
program_speed = 100
inching = 100
shift = 0
hand = 1                        # without this key, none
arm = "right"                   # or "left": what is selected
parameters = { OUTPOS = [131071, 2000, 2000, 2000] }

[points]
100 = { pulse = [123456, -123, 0, 0] }
50 = { mm = [10.0, -20.0, 5.0, -18.0], hand = "right" }

[comments]
50 = "WAIT ORG"

[pallets]
10 = { counts = [10, 15, 1], first = 100 }

[shifts]
5 = [10.0, -20.0, 5.0, -18.0]   # mm, degrees

[hands]
1 = { robot = 1, data = [10000, -2000, 5000, 0] }  # as they travel

[[program]]
number = 3
name = "BLINK"
text = """
*AGAIN:
SO(21)=1
DELAY 500
SO(21)=0
DELAY 500
GOTO *AGAIN"""

[[task]]
number = 3
program = 3
priority = 32
line = 1
state = "stop"                  # run, suspend

[[history]]                     # newest first
alarm = "12.551"
place = "C1O1"                  # C1, R1, R1A3, T1

[latest_remote]
alarm = "2.334"
place = "R1A1"

[[event]]
at_ms = 60000
do = "estop on"                 # any line of the console
"#;

impl Default for Start {
    fn default() -> Self {
        build(&Entries::default(), "").expect("the defaults are correct")
    }
}

impl Start {
    /// Parses a start state. An error message gives the problem and the line.
    pub fn parse(text: &str) -> Result<Self, String> {
        build(&start::parse(text)?, text)
    }

    /// Adds content with the command words of remote commands that write.
    pub fn with_written<'c>(mut self, commands: impl IntoIterator<Item = &'c Words>) -> Result<Self, String> {
        for words in commands {
            let written = Request::read(words).and_then(|request| commands::begin(&mut self.world, &request));
            written.map_err(|fault| fault.why)?;
        }
        Ok(self)
    }

    /// Sets the random seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Sets the speed of the simulated time, and the log of motions.
    #[must_use]
    pub fn with_options(self, options: RunOptions) -> Self {
        Self { options, ..self }
    }
}

impl Replayable for Start {
    fn with_recording(self, recording: Recording) -> Self {
        Self { recording, ..self }
    }
}

with_defaults! {
    #[derive(Debug, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct Entries {
        mode: Mode,
        servo: bool = true,
        r#box: bool,
        inputs: bool = true,
        sequence: bool,
        di17: Di17 = Di17::Abs,
        movei_start: MoveiStart = MoveiStart::Keep,
        clock: Option<Spanned<String>>,
        link_within_ms: Option<u64>,
        run_scans: u32,
        seed: u64,
        versions: Versions,
        slots: Table<[String; 4]>,
        variables: Table<Number>,
        ports: Table<u8>,
        stock: bool = true,
        #[serde(rename = "robot")]
        robots: Vec<Spanned<RobotEntry>>,
        points: Table<PointEntry>,
        comments: Table<String>,
        pallets: Table<PalletEntry>,
        shifts: Table<[f64; 4]>,
        hands: Table<HandEntry>,
        #[serde(rename = "program")]
        programs: Vec<Spanned<ProgramEntry>>,
        #[serde(rename = "task")]
        tasks: Vec<Spanned<TaskEntry>>,
        history: Vec<Spanned<AlarmEntry>>,
        latest_remote: Option<Spanned<AlarmEntry>>,
        #[serde(rename = "event")]
        events: Vec<Spanned<Event>>,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
enum Di17 {
    #[serde(rename = "abs")]
    Abs,
    #[serde(rename = "abs/org")]
    AbsOrg,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum MoveiStart {
    Keep,
    Reset,
}

#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Versions {
    host: Option<Spanned<String>>,
    revision: Option<Spanned<u16>>,
    fpga: Option<Spanned<String>>,
    drivers: Option<Spanned<[String; 4]>>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(untagged)]
enum Number {
    Whole(i32),
    Real(f64),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum KindEntry {
    Cartesian,
    Scara,
}

with_defaults! {
    #[derive(Debug, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct RobotEntry {
        kind: KindEntry = KindEntry::Cartesian,
        arms: [f64; 2] = defaults::ARMS,
        axes: usize = 4,
        model: u16 = 2000,
        pulses_per_unit: Vec<f64>,
        limits: Vec<[i32; 2]>,
        speeds: Vec<f64>,
        motors: Vec<Motor>,
        methods: Vec<Method>,
        origin: Vec<bool>,
        position: Vec<i32>,
        servos: Vec<Servo>,
        load: Vec<i32>,
        obstacles: BTreeMap<String, i32>,
        payload_g: i32 = 1000,
        max_payload_g: i32 = 10_000,
        auto_speed: i32 = 100,
        manual_speed: i32 = 20,
        program_speed: i32 = 100,
        inching: i32 = 100,
        shift: usize,
        hand: Option<usize>,
        arm: Arm,
        parameters: BTreeMap<String, Vec<i32>>,
    }
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PointEntry {
    pulse: Option<[i32; 4]>,
    mm: Option<[f64; 4]>,
    hand: Option<Arm>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PalletEntry {
    counts: [i32; 3],
    first: u16,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct HandEntry {
    robot: usize,
    data: [i32; 4],
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ProgramEntry {
    number: u8,
    name: String,
    text: String,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct TaskEntry {
    number: u8,
    program: u8,
    #[serde(default = "usual_priority")]
    priority: u8,
    #[serde(default = "first_line")]
    line: usize,
    #[serde(default)]
    state: State,
}

const fn usual_priority() -> u8 {
    32
}

const fn first_line() -> usize {
    1
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct AlarmEntry {
    alarm: String,
    #[serde(default)]
    place: String,
}

fn build(entries: &Entries, text: &str) -> Result<Start, String> {
    let source = Source { text };
    let (stock, stock_source): (Entries, _) = (start::parse(STOCK)?, Source { text: STOCK });
    let mut world = bare_world(entries, source)?;
    if entries.robots.is_empty() {
        initial_state::robots(&mut world, &stock.robots, entries.servo, stock_source)?;
    } else {
        initial_state::robots(&mut world, &entries.robots, entries.servo, source)?;
    }
    if entries.stock {
        initial_state::memory(&mut world, &stock, stock_source)?;
    }
    initial_state::memory(&mut world, entries, source)?;
    initial_state::check(&world, entries, source)?;
    // The check uses a copy, so that the world keeps its start state.
    let mut copy = world.clone();
    world.events = source.timeline(&entries.events, |line| console::execute(&mut copy, line))?;
    Ok(Start {
        world,
        run_scans: entries.run_scans,
        seed: entries.seed,
        options: RunOptions::default(),
        recording: Recording::default(),
    })
}

/// A controller without content.
fn bare_world(entries: &Entries, source: Source<'_>) -> Result<World, String> {
    let clock = match &entries.clock {
        Some(entry) => source.time(entry, "%Y/%m/%d %H:%M:%S", "2026/03/14 08:00:00")?,
        None => DateTime::constant(2026, 3, 14, 8, 0, 0, 0),
    };
    let mut slots = BTreeMap::from([(1, defaults::SLOTS)]);
    source.each_of(&entries.slots, |controller, names| {
        let controller = numbered("controllers", controller, 1..=4)?;
        let mut modules = [0; 4];
        for (module, name) in modules.iter_mut().zip(names) {
            *module = word(Command::Slots, Key::Slot1, name)?;
        }
        slots.insert(u8::try_from(controller).unwrap_or_default(), modules);
        Ok(())
    })?;
    Ok(World {
        switches: Switches {
            mode: entries.mode,
            boxed: entries.r#box,
            inputs: entries.inputs,
            estop: false,
            warning: false,
            sequence: entries.sequence,
            origin_both: entries.di17 == Di17::AbsOrg,
            keep: entries.movei_start == MoveiStart::Keep,
        },
        link_within: entries.link_within_ms.map(Duration::from_millis),
        motor: entries.servo,
        clock: (clock, Now::ZERO),
        versions: versions(&entries.versions, source)?,
        slots,
        ..World::default()
    })
}

fn versions(entry: &Versions, source: Source<'_>) -> Result<[u16; 7], String> {
    let mut words = defaults::VERSIONS;
    let version = |key| move |text: &String| word(Command::Versions, key, text);
    if let Some(text) = &entry.host {
        words[0] = source.read(text, version(Key::HostVersion))?;
    }
    if let Some(revision) = &entry.revision {
        words[1] = *revision.get_ref();
    }
    if let Some(text) = &entry.fpga {
        words[2] = source.read(text, version(Key::FpgaVersion))?;
    }
    source.each(&entry.drivers, |texts| {
        words[3..].iter_mut().zip(texts).try_for_each(|(driver, text)| {
            *driver = version(Key::DriverVersion1)(text)?;
            Ok(())
        })
    })?;
    Ok(words)
}

/// An answer word, parsed from its text with the table.
fn word(command: Command, key: Key, text: &str) -> Result<u16, String> {
    let field = command.row().answer().find(|field| field.key == key);
    match field.map(|field| field.parse(text)) {
        Some(Ok(Value::Int(number))) => u16::try_from(number).map_err(|_| format!("'{text}' is out of range")),
        Some(Err(what)) => Err(what),
        _ => Err(format!("'{text}' is not a valid value")),
    }
}

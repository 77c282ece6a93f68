//! Start state from TOML.
//!
//! All keys have defaults: an empty file is a DX200 in play mode with command remote and servo power. The file adds to
//! the content of a new controller. An error message gives the line.

use std::time::Duration;

use serde::Deserialize;
use toml::Spanned;

use super::alarms::{AlarmLog, Class, alarm, sjis};
use super::console;
use super::defaults;
use super::memory::{Kind, Memory};
use super::motion::{AXES, Arm, Family, Group};
use super::playback::Player;
use super::storage::{Content, Storage, check_stored_name};
use super::variable_file;
use super::world::{Holds, Meters, Mode, Switches, World};
use crate::Now;
use crate::simulator::recording::{Recording, Replayable};
use crate::simulator::run_options::RunOptions;
use crate::simulator::start::{self, Event, Source, Table, default_entry, default_text, numbered};
use crate::simulator::timeline::Timeline;
use crate::simulator::with_defaults;
use crate::yerc::Model;
use crate::yerc::payload::{Axes, BasePosition, ExtendedForm, ExternalPosition, Form, Position, PositionKind};

/// Start state of a simulated controller; [`Start::parse`] reads it (see [`EXAMPLE`]). [`Start::default`] is a DX200.
#[derive(Debug, Clone)]
pub struct Start {
    pub(super) world: World,
    pub(super) seed: u64,
    pub(super) answer_delay: Duration,
    pub(super) busy: f64,
    pub(super) backup_time: Duration,
    pub(super) backup_size: u64,
    pub(super) idle_limit: Duration,
    pub(super) options: RunOptions,
    pub(super) recording: Recording,
}

/// A start state with all keys. Each key is optional.
pub const EXAMPLE: &str = r#"model = "dx200"                 # or "fs100", "dx100", "yrc1000"
mode = "play"                   # or "teach"
remote = true                   # command remote (#82015)
servo = true
cycle = "once"                  # step, once, continuous
play_write = true               # S2C541 = 0: variables can be written in play mode
clock = "2026/03/14 08:00"
installed = "2025/10/10 15:49"  # start of the running times
hours = { control = 2345, servo = 1890, playback = 1234, motion = 987 }
software = "DN2.07.00A(JP/US)-00"
robot_model = "ES0165D-A0*"
application = "ARC WELDING"
parameter_version = "12.34"
groups = ["R1", "B1", "S1"]
robot_axes = 6                  # or 7
trim_axes = false               # true: no words for axes that are not fitted (default: 7 axes)
positions = { R1 = [0, 0, 0, 0, 0, 0], B1 = [0] }
user_frames = { 1 = [500.0, 0.0, 0.0, 0.0] }  # X, Y, Z in mm, turn about Z in degrees
job = "TESTJOB"                 # the job to execute

variables = { B0 = 7, I1 = -2, D2 = 100000, R3 = 1.5, S4 = "HELLO", P5 = { type = "pulse", axes = [1, 2, 3] } }
registers = { 10 = 4660 }
ladder_registers = [540, 541]   # writes to these are accepted, but do not last
io = { 10010 = true }

seed = 0
answer_delay_ms = 0             # 5 to 20 on a real controller
busy = 0.0                      # share of requests refused as busy
backup_seconds = 3              # 600 on a real controller
backup_size = 100000
transfer_timeout_ms = 5000
capacity = 268435456            # bytes for all files
replace_jobs = false            # true: loading replaces a job of the same name
plain_last_ack = false          # true: the last block of a load is acknowledged as 0x80000000
stock = true                    # false: only the files, variables and history that are listed here

alarm = [{ code = 4315, data = 3, type = 1 }]
history = [{ code = 9001, data = 5, type = 1, time = "2026/02/28 17:30", name = "PART MISSING", class = "user" }]

[[file]]
name = "BLINK.JBI"              # text, path, or size
text = """
/JOB
//NAME BLINK
//INST
NOP
DOUT OT#(1) ON
TIMER T=0.50
DOUT OT#(1) OFF
END
"""

[[file]]
name = "BIG.DAT"
size = 67108864                 # content is generated

[[event]]
at_ms = 60000
do = "alarm clear"              # any line of the console
"#;

impl Default for Start {
    fn default() -> Self {
        Self::for_model(Model::Dx200)
    }
}

impl Start {
    /// The default state of a model.
    ///
    /// # Panics
    /// Never: the defaults are valid.
    pub fn for_model(model: Model) -> Self {
        let entries = Entries { model, ..Entries::default() };
        build(&entries, "", &mut |_| Err(String::new())).expect("the defaults are correct")
    }

    /// Parses a start state. `read` loads the files that entries name with `path`.
    ///
    /// An error message gives the problem and the line.
    pub fn parse(text: &str, mut read: impl FnMut(&str) -> Result<Vec<u8>, String>) -> Result<Self, String> {
        build(&start::parse(text)?, text, &mut read)
    }

    /// Model of the controller in the start state.
    pub fn model(&self) -> Model {
        self.world.model
    }

    /// Adds a file of a real controller, with its name in the encoding of the controller. The file of variables also
    /// sets the variables, without positions in a form that only real controllers write.
    pub fn with_file(mut self, name: &[u8], content: Vec<u8>) -> Result<Self, String> {
        let positions = content.windows(6).position(|line| line == b"////P\r" || line == b"////P\n");
        let numbers = content.get(..positions.unwrap_or(content.len())).unwrap_or_default().to_vec();
        match install(&mut self.world, name, content.into()) {
            Err(_) if name == variable_file::NAME => install(&mut self.world, name, numbers.into())?,
            installed => installed?,
        }
        Ok(self)
    }

    /// Sets the random seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Sets the share of robot requests, from 0.0 to 1.0, that the simulator refuses as busy (D8FA) at random.
    #[must_use]
    pub fn with_busy(self, busy: f64) -> Self {
        Self { busy: busy.clamp(0.0, 1.0), ..self }
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
        #[serde(deserialize_with = "model")]
        model: Model = Model::Dx200,
        seed: u64,
        mode: Mode = Mode::Play,
        remote: bool = true,
        servo: bool = true,
        cycle: Spanned<String> = default_text("once"),
        /// Whether variables can be written in play mode (S2C541 = 0).
        play_write: bool = true,
        /// Date and time at the start.
        clock: Spanned<String> = default_text("2026/03/14 08:00"),
        /// Start of the operating-time counters.
        installed: Spanned<String> = default_text("2025/10/10 15:49"),
        software: Option<String>,
        robot_model: Option<String>,
        application: Option<String>,
        parameter_version: Option<String>,
        /// Control groups. `R1` must be the first.
        groups: Vec<Spanned<String>> = ["R1", "B1", "S1"].map(default_text).to_vec(),
        /// Number of axes of a robot: 6 or 7.
        robot_axes: Spanned<usize> = default_entry(6),
        trim_axes: Option<bool>,
        hours: Hours,
        answer_delay_ms: u64,
        busy: Spanned<f64> = default_entry(0.0),
        backup_seconds: u64 = 3,
        backup_size: u64 = 100_000,
        transfer_timeout_ms: u64 = 5_000,
        capacity: u64 = 256 << 20,
        replace_jobs: bool,
        plain_last_ack: bool,
        /// Name of the job to execute.
        job: Option<Spanned<String>>,
        ladder_registers: Vec<Spanned<u16>> = (540..550).map(default_entry).collect(),
        variables: Table<Value>,
        registers: Table<u16>,
        io: Table<bool>,
        /// Positions in pulses, by group.
        positions: Table<Vec<i32>>,
        /// User frames by number: X, Y, Z in mm, and a rotation about Z in degrees.
        user_frames: Table<[f64; 4]> = Table::from([("1".to_owned(), default_entry([500.0, 0.0, 0.0, 0.0]))]),
        #[serde(rename = "alarm")]
        alarms: Vec<AlarmEntry>,
        history: Option<Vec<AlarmEntry>>,
        #[serde(rename = "file")]
        files: Vec<Spanned<FileEntry>>,
        /// Whether to add the files, variables and alarms of a new controller.
        stock: bool = true,
        #[serde(rename = "event")]
        events: Vec<Spanned<Event>>,
    }
}

with_defaults! {
    /// Operating times before the start.
    #[derive(Debug, Clone, Copy, Deserialize)]
    #[serde(default, deny_unknown_fields)]
    struct Hours {
        control: u32 = 2345,
        servo: u32 = 1890,
        playback: u32 = 1234,
        motion: u32 = 987,
    }
}

#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
enum Value {
    Integer(i64),
    Real(f64),
    Text(String),
    Position(PositionEntry),
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct PositionEntry {
    /// Kind of position: `pulse`, `base`, `robot`, `user` or `tool`.
    #[serde(rename = "type")]
    kind: String,
    axes: Vec<i32>,
    #[serde(default)]
    form: u8,
    #[serde(default)]
    extended_form: u8,
    #[serde(default)]
    tool: u8,
    #[serde(default)]
    user: u8,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct AlarmEntry {
    code: u32,
    #[serde(default)]
    data: u32,
    #[serde(default, rename = "type")]
    kind: u32,
    time: Option<String>,
    name: Option<String>,
    class: Option<Class>,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileEntry {
    name: String,
    text: Option<String>,
    path: Option<String>,
    size: Option<u64>,
}

fn model<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Model, D::Error> {
    String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
}

fn build(
    entries: &Entries,
    text: &str,
    read: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<Start, String> {
    let source = Source { text };
    let busy = source.share("busy", &entries.busy)?;
    let mut world = bare_world(entries, source)?;
    if entries.stock {
        defaults::fill(&mut world);
    }
    memory(&mut world, entries, source)?;
    source.each_of(&entries.positions, |name, values| {
        let group = world.arm.groups.iter_mut().find(|group| group.name() == *name);
        let group = group.ok_or_else(|| format!("group '{name}' is not fitted"))?;
        if values.len() != group.axes {
            return Err(format!("{name} has {} axes, not {}", group.axes, values.len()));
        }
        group.pulses.iter_mut().zip(values).for_each(|(pulse, value)| *pulse = f64::from(*value));
        Ok(())
    })?;
    source.each(&entries.files, |entry| file(&mut world, entry, read))?;
    alarms(&mut world, entries);
    source.each(&entries.job, |job| {
        let name = sjis(job);
        let program = world.files.program(&name).ok_or_else(|| format!("no job '{job}'"))?;
        world.player.select(&name, program, 0);
        Ok(())
    })?;
    // The check uses a copy, so that the world keeps its start state.
    let mut copy = world.clone();
    world.events = source.timeline(&entries.events, |line| console::execute(&mut copy, line))?;
    Ok(Start {
        world,
        seed: entries.seed,
        answer_delay: Duration::from_millis(entries.answer_delay_ms),
        busy,
        backup_time: Duration::from_secs(entries.backup_seconds),
        backup_size: entries.backup_size,
        idle_limit: Duration::from_millis(entries.transfer_timeout_ms),
        options: RunOptions::default(),
        recording: Recording::default(),
    })
}

fn memory(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    source.each_of(&entries.variables, |name, value| {
        let (kind, index) = Kind::parse(name).ok_or_else(|| format!("'{name}' is not a valid variable"))?;
        let bytes = element(kind, value).map_err(|what| format!("{name}: {what}"))?;
        world.memory.store(kind, index, &bytes);
        Ok(())
    })?;
    source.each_of(&entries.registers, |name, value| {
        let written = name.parse().is_ok_and(|number| world.memory.force_register(number, *value));
        if written { Ok(()) } else { Err(format!("'{name}' is not a valid register (0 to 999)")) }
    })?;
    source.each_of(&entries.io, |name, on| {
        let written = name.parse().is_ok_and(|number| world.memory.set_signal(number, *on));
        if written { Ok(()) } else { Err(format!("'{name}' is not a signal of this model")) }
    })
}

/// A controller without content.
fn bare_world(entries: &Entries, source: Source<'_>) -> Result<World, String> {
    let [software, robot_model, application, parameter_version] = defaults::versions(entries.model);
    let or = |entry: &Option<String>, default: &str| entry.clone().unwrap_or_else(|| default.to_owned());
    let hours = |hours: u32| Duration::from_secs(3600 * u64::from(hours));
    let mut memory = Memory::new(entries.model);
    source.each(&entries.ladder_registers, |register| {
        memory.register(*register).ok_or("registers must be from 0 to 999")?;
        memory.ladder.push(*register);
        Ok(())
    })?;
    let mut user_frames = Vec::new();
    source.each_of(&entries.user_frames, |name, frame| {
        let number = numbered("user frames", name, 1..=63)?;
        user_frames.push((u32::try_from(number).unwrap_or_default(), *frame));
        Ok(())
    })?;
    let cycle = source.read(&entries.cycle, |name| {
        console::cycle(name).ok_or_else(|| "cycle must be step, once or continuous".to_owned())
    })?;
    let time = |entry| source.time(entry, "%Y/%m/%d %H:%M", "2026/03/14 08:00");
    Ok(World {
        model: entries.model,
        software: or(&entries.software, software),
        robot_model: or(&entries.robot_model, robot_model),
        application: or(&entries.application, application),
        parameter_version: or(&entries.parameter_version, parameter_version),
        clock: time(&entries.clock)?,
        installed: time(&entries.installed)?,
        now: Now::ZERO,
        switches: Switches {
            mode: entries.mode,
            remote: entries.remote,
            servo: entries.servo,
            cycle,
            hold: Holds::default(),
            guard: false,
            hlock: false,
            estop: false,
            editing: false,
            converting: false,
            play_lock: !entries.play_write,
            error: false,
            message: Vec::new(),
        },
        alarms: AlarmLog::default(),
        memory,
        arm: Arm::new(groups(entries, source)?),
        player: Player::default(),
        files: Storage::new(entries.capacity, entries.replace_jobs, entries.plain_last_ack),
        trim_axes: entries.trim_axes,
        meters: Meters {
            control: hours(entries.hours.control),
            servo: hours(entries.hours.servo),
            playback: hours(entries.hours.playback),
            motion: hours(entries.hours.motion),
        },
        user_frames,
        events: Timeline::default(),
        mode_changes: 0,
    })
}

fn groups(entries: &Entries, source: Source<'_>) -> Result<Vec<Group>, String> {
    let axes = source.read(&entries.robot_axes, |axes| {
        Some(*axes).filter(|axes| (6..=7).contains(axes)).ok_or_else(|| "robot_axes must be 6 or 7".to_owned())
    })?;
    let (robots, bases, stations) = crate::yerc::group::Group::counts(entries.model);
    let most = |family| match family {
        Family::Robot => u16::from(robots),
        Family::Base => bases.into(),
        Family::Station => stations.into(),
    };
    let mut groups = Vec::<Group>::new();
    source.each(&entries.groups, |name| {
        let group = Group::parse(name, axes).filter(|group| group.number <= most(group.family));
        let group = group.ok_or_else(|| format!("'{name}' is not a group of this model"))?;
        if groups.iter().any(|other| other.name() == group.name()) {
            return Err(format!("{} appears twice", group.name()));
        }
        groups.push(group);
        Ok(())
    })?;
    Ok(groups)
}

fn element(kind: Kind, value: &Value) -> Result<Vec<u8>, String> {
    let range = |text: &str| format!("the value must be {text}");
    match (kind, value) {
        (Kind::B, &Value::Integer(value)) => {
            u8::try_from(value).map(|value| vec![value]).map_err(|_| range("0 to 255"))
        }
        (Kind::I, &Value::Integer(value)) => {
            i16::try_from(value).map(|value| value.to_le_bytes().to_vec()).map_err(|_| range("-32768 to 32767"))
        }
        (Kind::D, &Value::Integer(value)) => {
            i32::try_from(value).map(|value| value.to_le_bytes().to_vec()).map_err(|_| range("32 bits, signed"))
        }
        (Kind::R, &Value::Real(value)) => Ok(single(value).to_le_bytes().to_vec()),
        (Kind::R, &Value::Integer(value)) => {
            i32::try_from(value).map(|value| single(value.into()).to_le_bytes().to_vec()).map_err(|_| range("smaller"))
        }
        (Kind::S, Value::Text(text)) => {
            let bytes = sjis(text);
            if bytes.len() > 32 { Err(range("at most 32 bytes")) } else { Ok(bytes) }
        }
        (Kind::P | Kind::Bp | Kind::Ex, Value::Position(entry)) => position(kind, entry),
        _ => Err("the value has the wrong type for this variable".into()),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "R variables hold single precision")]
fn single(value: f64) -> f32 {
    value as f32
}

fn position(kind: Kind, entry: &PositionEntry) -> Result<Vec<u8>, String> {
    let named = PositionKind::ALL.into_iter().find(|(_, _, name)| *name == entry.kind);
    let allowed = |known: PositionKind| match kind {
        Kind::P => true,
        Kind::Bp => matches!(known, PositionKind::Pulse | PositionKind::Base),
        _ => known == PositionKind::Pulse,
    };
    let Some((word, ..)) = named.filter(|(known, ..)| allowed(*known)) else {
        return Err(format!("the type '{}' is not possible here", entry.kind));
    };
    if entry.axes.len() > AXES || entry.tool > 63 || entry.user > 63 || entry.extended_form > 0x1F {
        return Err(
            "a position can have at most 8 axes, tool and user from 0 to 63, and extended_form from 0 to 31".into()
        );
    }
    let mut values = [0; AXES];
    values.iter_mut().zip(&entry.axes).for_each(|(value, axis)| *value = *axis);
    let axes = Axes::full(values);
    Ok(match kind {
        Kind::P => Position {
            kind: word,
            form: Form(entry.form.into()),
            tool: entry.tool.into(),
            user: entry.user.into(),
            extended: ExtendedForm(entry.extended_form.into()),
            axes,
        }
        .emit(),
        Kind::Bp => BasePosition { kind: word, axes }.emit(),
        _ => ExternalPosition { kind: word, axes }.emit(),
    })
}

fn file(
    world: &mut World,
    entry: &FileEntry,
    read: &mut dyn FnMut(&str) -> Result<Vec<u8>, String>,
) -> Result<(), String> {
    let name = sjis(&entry.name);
    let content = match (&entry.text, &entry.path, entry.size) {
        (Some(text), None, None) => sjis(&text.replace("\r\n", "\n").replace('\n', "\r\n")).into(),
        (None, Some(path), None) => read(path).map_err(|what| format!("{path}: {what}"))?.into(),
        (None, None, Some(size)) => Content::Generated { seed: size ^ name.len() as u64, size },
        _ => return Err("a file must have exactly one of text, path and size".to_owned()),
    };
    install(world, &name, content)
}

/// Adds a file.
fn install(world: &mut World, name: &[u8], content: Content) -> Result<(), String> {
    let wrong = |what: &str| Err(format!("'{}' {what}", encoding_rs::SHIFT_JIS.decode(name).0));
    if check_stored_name(name).is_err() {
        return wrong("is not a valid file name of a controller");
    }
    if name == variable_file::NAME {
        let bytes = content.piece(0, usize::try_from(content.size()).unwrap_or(usize::MAX));
        if !variable_file::load(&mut world.memory, &bytes) {
            return wrong("is not a file of variables");
        }
    }
    world.files.install(name, content);
    let stem = name.strip_suffix(b".JBI");
    if stem.is_some_and(|stem| world.files.program(stem).is_none()) {
        return wrong("does not contain a job with this name");
    }
    Ok(())
}

fn alarms(world: &mut World, entries: &Entries) {
    let now = world.timestamp();
    let make = |entry: &AlarmEntry| {
        let time = entry.time.as_deref().unwrap_or(&now);
        alarm(entry.code, entry.data, entry.kind, time, entry.name.as_deref())
    };
    if let Some(history) = &entries.history {
        world.alarms = AlarmLog::default();
        for entry in history {
            world.alarms.record(entry.class.unwrap_or_else(|| Class::from_code(entry.code)), make(entry));
        }
    }
    for entry in &entries.alarms {
        world.alarms.raise(make(entry));
    }
    if !entries.alarms.is_empty() {
        world.switches.servo = false;
    }
}

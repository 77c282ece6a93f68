//! Start state from TOML.
//!
//! All keys have defaults: an empty file is a new KCA-25-M10 with four axes in one task, directly after power on. An
//! error message gives the line.

use std::collections::BTreeMap;
use std::time::Duration;

use serde::Deserialize;
use toml::Spanned;

use super::arm::Arm;
use super::card::Card;
use super::console::ConsoleLine;
use super::edit;
use super::errors::{Entry, Errors};
use super::io::{Port, Ports};
use super::memory::{Content, MAX_STEPS, Memory, POINTS, STEPS_WITH_EASY, TASKS, Wear};
use super::motion::AXES;
use super::settings::{Machine, Settings};
use super::task::Task;
use super::trace::Trace;
use super::world::{COUNTERS, Mode, Switches, TIMERS, World};
use crate::simulator::console;
use crate::simulator::recording::{Recording, Replayable};
use crate::simulator::run_options::RunOptions;
use crate::simulator::start::{self, Event, Source, Table, default_entry, default_text};
use crate::simulator::timeline::Timeline;
use crate::simulator::with_defaults;
use crate::toyo::field::{Mask, Value};
use crate::toyo::layout::Record;
use crate::toyo::request::{Request, instruction};
use crate::toyo::table::{Command, KCA};
use crate::{Now, refuse_if};

/// Start state of a simulated controller; [`Start::parse`] reads it (see [`EXAMPLE`]).
#[derive(Debug, Clone)]
pub struct Start {
    pub(super) world: World,
    pub(super) seed: u64,
    pub(super) answer_delay: Duration,
    pub(super) busy: f64,
    pub(super) options: RunOptions,
    pub(super) recording: Recording,
}

/// A start state with all keys. Each key is optional.
pub const EXAMPLE: &str = r#"model = "KCA-25-M10"            # or KCA-20-M00 and so on, or "other": without the extras of some models
version = "4.00"
robot_types = [0]               # valid for TYPE; the first one is active
axes = 4                        # 1 to 4
mode = "automatic"              # step, program
palletizing = false
host = false
pendant = false
servo = true
origin = false                  # true: the origin is known
position = [0.0, 0.0, 0.0, 0.0] # mm from the origin

points = { 1 = { 1 = [100.0, 20.0, 0.0, 0.0] } }      # by task and row, mm
speeds = { 5 = 200.0 }          # mm/s, by row
ramps = { 1 = 0.1 }             # s, by row
counters = { 1 = 7 }
inputs = { "0/01" = "00000001" }
outputs = { "0/02" = "10000000" }
steps = { 1 = ["SPD V=05", "MOVP a PT=001 CN=00 S V=00 POST", "OUT STN=0 PN01=.......1", "END"] }  # by task
write = ["WPAR M13 0/01/8", "WPLT 01 SNO=01 TAG=000 MOD=M-1", "WESY PNO=01 ST=000 START=000 LOOP=0000 END=000"]

error = "13"                    # the active error
history = [{ code = "28", after_seconds = 45 }]       # newest first; { power_cut = true } is also an entry
hours = 123                     # power-on time before the start
card = "none"                   # empty, written
card_seconds = 2

seed = 0
answer_delay_ms = 0             # up to 1000 on a real controller
busy = 0.0                      # share of commands refused with @NG
instruction_us = 1000           # duration of an instruction
eeprom_limit = 0                # number of writes until a memory cell fails; 0 for no limit

[[event]]
at_ms = 2000
do = "input 0/01/3 on"          # any line of the console
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

    /// Sets the random seed.
    #[must_use]
    pub fn with_seed(self, seed: u64) -> Self {
        Self { seed, ..self }
    }

    /// Sets the share of commands, from 0.0 to 1.0, that the simulator refuses with `@NG` at random.
    #[must_use]
    pub fn with_busy(self, busy: f64) -> Self {
        Self { busy: busy.clamp(0.0, 1.0), ..self }
    }

    /// Sets the speed of the simulated time, and the log of motions.
    #[must_use]
    pub fn with_options(self, options: RunOptions) -> Self {
        Self { options, ..self }
    }

    /// Adds a program to a task, 1 to 4. The task gets as many steps as the program needs (E22).
    pub fn with_program(mut self, task: usize, steps: Vec<Record>) -> Result<Self, String> {
        program(&mut self.world, task, steps)?;
        Ok(self.stored())
    }

    /// Adds content with host write commands, for example `WPAR T2 V05=0200.0`, `WPLT …`, `WESY …` or `WSTX …`. Points
    /// and steps belong to `task`, 1 to 4.
    pub fn with_written<'c>(mut self, task: u8, commands: impl IntoIterator<Item = &'c str>) -> Result<Self, String> {
        let task = usize::from(task).checked_sub(1).filter(|task| *task < TASKS).ok_or("tasks must be from 1 to 4")?;
        let current = std::mem::replace(&mut self.world.current, task);
        for command in commands {
            write(&mut self.world, command).map_err(|why| format!("{command}: {why}"))?;
        }
        self.world.current = current;
        Ok(self.stored())
    }

    /// Treats the content as written before the last power on: the EEPROM has no wear, and all parameters are in
    /// effect.
    fn stored(mut self) -> Self {
        self.world.memory.wear.reset();
        self.world.load();
        self.world.settle();
        self
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
        model: Spanned<String> = default_text(KCA[2]),
        version: Spanned<String> = default_text("4.00"),
        robot_types: Spanned<Vec<i32>> = default_entry(vec![0]),
        axes: Spanned<usize> = default_entry(AXES),
        mode: Mode,
        palletizing: bool,
        host: bool,
        pendant: bool,
        servo: bool = true,
        origin: bool,
        position: Spanned<[f64; AXES]> = default_entry([0.0; AXES]),
        points: BTreeMap<String, Table<[f64; AXES]>>,
        speeds: Table<f64>,
        ramps: Table<f64>,
        counters: Table<u16>,
        inputs: Table<String>,
        outputs: Table<String>,
        steps: Table<Vec<Spanned<String>>>,
        /// Host commands, without `@`.
        write: Vec<Spanned<String>>,
        error: Option<Spanned<String>>,
        history: Vec<Spanned<HistoryEntry>>,
        hours: u32,
        card: Slot = Slot::None,
        card_seconds: u64 = 2,
        seed: u64,
        answer_delay_ms: u64,
        busy: Spanned<f64> = default_entry(0.0),
        instruction_us: Spanned<u64> = default_entry(1000),
        eeprom_limit: u64,
        #[serde(rename = "event")]
        events: Vec<Spanned<Event>>,
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Slot {
    None,
    Empty,
    Written,
}

#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
struct HistoryEntry {
    code: Option<String>,
    #[serde(default)]
    after_seconds: u64,
    #[serde(default)]
    power_cut: bool,
}

fn build(entries: &Entries, text: &str) -> Result<Start, String> {
    let source = Source { text };
    let busy = source.share("busy", &entries.busy)?;
    let mut world = bare_world(entries, source)?;
    programs(&mut world, entries, source)?;
    tables(&mut world, entries, source)?;
    source.each(&entries.write, |line| write(&mut world, line))?;
    // The content counts as written before the start. Therefore it has not worn the EEPROM, and parameters 2 are in
    // effect.
    world.memory.wear = Wear::new(Some(entries.eeprom_limit).filter(|limit| *limit > 0));
    world.power_up();
    world.switches.mode = entries.mode;
    world.switches.palletizing = entries.palletizing;
    world.switches.pendant = entries.pendant;
    world.switches.host = entries.host && !entries.pendant;
    if !entries.servo {
        world.switches.servo = [false; AXES];
    }
    source.each_of(&entries.counters, |number, count| {
        let counter = row(number, COUNTERS - 1)?;
        let value = Some(*count).filter(|count| *count <= 9999);
        world.counters[counter] = value.ok_or("counters must be from 0 to 9999")?;
        Ok(())
    })?;
    source.each_of(&entries.inputs, |name, bits| {
        let (port, mask) = port(name, bits)?;
        if world.ports.set_input(port, mask) { Ok(()) } else { Err(format!("no input port {name}")) }
    })?;
    source.each_of(&entries.outputs, |name, bits| {
        let (port, mask) = port(name, bits)?;
        if world.ports.set_output(port, mask) { Ok(()) } else { Err(format!("no output port {name}")) }
    })?;
    errors(&mut world, entries, source)?;
    if entries.card == Slot::Written {
        let content = world.memory.content.clone();
        world.card.fill(&content);
    }
    world.settle();
    world.events = source.timeline(&entries.events, ConsoleLine::parse)?;
    let answer_delay = Duration::from_millis(entries.answer_delay_ms);
    Ok(Start {
        world,
        seed: entries.seed,
        answer_delay,
        busy,
        options: RunOptions::default(),
        recording: Recording::default(),
    })
}

/// A controller without content.
fn bare_world(entries: &Entries, source: Source<'_>) -> Result<World, String> {
    let model = entries.model.get_ref();
    if model != "other" && !KCA.contains(&model.as_str()) {
        return Err(source.error(&entries.model, format!("model must be one of {}, or other", KCA.join(", "))));
    }
    let axes = *entries.axes.get_ref();
    refuse_if(!(1..=AXES).contains(&axes), source.error(&entries.axes, "axes must be from 1 to 4"))?;
    let version = source.read(&entries.version, |version| {
        hundredths(version).ok_or_else(|| "write a version, for example \"4.00\"".to_owned())
    })?;
    let types = entries.robot_types.get_ref();
    if types.is_empty() || types.iter().any(|number| !(0..=999_999).contains(number)) {
        return Err(source.error(&entries.robot_types, "robot_types must have at least one number, from 0 to 999999"));
    }
    let tick = *entries.instruction_us.get_ref();
    if !(1..=1_000_000).contains(&tick) {
        return Err(source.error(&entries.instruction_us, "instruction_us must be from 1 to 1000000"));
    }
    let position = *entries.position.get_ref();
    if !position.iter().all(|place| place.abs() <= 8000.0) {
        return Err(source.error(&entries.position, "coordinates must be within 8000 mm"));
    }
    let mut arm = Arm::default();
    // Without a known origin, an axis counts from its position at power on.
    arm.set_position(if entries.origin { position } else { [0.0; AXES] });
    arm.sensors = if entries.origin { [0.0; AXES] } else { position.map(|place| -place) };
    arm.known = [entries.origin; AXES];
    let content = Content::new(axes, types[0]);
    let (settings, machine) = (Settings::from_content(&content), Machine::from_content(&content));
    let memory = Memory::new(content);
    Ok(World {
        now: Now::ZERO,
        model: model.clone(),
        version,
        axes,
        robot_types: types.clone(),
        meter: Duration::from_secs(3600 * u64::from(entries.hours)),
        tick: Duration::from_micros(tick),
        memory,
        settings,
        machine,
        switches: Switches { slaves_ready: true, ..Switches::default() },
        ports: Ports::default(),
        arm,
        synchronized: false,
        tasks: std::array::from_fn(|_| Task::default()),
        stopped: false,
        pausing: false,
        allowance: None,
        jog: None,
        jog_ready: false,
        current: 0,
        pallet: 1,
        easy: 1,
        counters: [0; COUNTERS],
        timers: [None; TIMERS],
        errors: Errors::default(),
        card: Card::new(entries.card != Slot::None, Duration::from_secs(entries.card_seconds)),
        pulses: Vec::new(),
        outputs_at: Vec::new(),
        presses: [None; AXES],
        crossing: None,
        watched: 0,
        events: Timeline::default(),
        trace: Trace::default(),
        refusal: None,
    })
}

fn programs(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    for (task, lines) in &entries.steps {
        let mut steps = Vec::new();
        source.each(lines.get_ref(), |line| {
            steps.push(step(line)?);
            Ok(())
        })?;
        source.read(lines, |_| program(world, row(task, TASKS)?, steps))?;
    }
    Ok(())
}

fn step(line: &str) -> Result<Record, String> {
    let record = instruction(line).map_err(|error| error.to_string())?;
    record.emit().map_err(|error| error.to_string())?;
    Ok(record)
}

/// Stores a program in a task. The task gets as many steps as the program needs.
fn program(world: &mut World, task: usize, steps: Vec<Record>) -> Result<(), String> {
    refuse_if(!(1..=TASKS).contains(&task), "tasks must be from 1 to 4".to_owned())?;
    let mut sizes: [usize; TASKS] = std::array::from_fn(|index| world.memory.size(index));
    sizes[task - 1] = sizes[task - 1].max(steps.len());
    // At first, task 1 has all steps. The steps of the other tasks are taken from task 1, and not from the easy
    // programs.
    let others: usize = sizes[1..].iter().sum();
    sizes[0] = sizes[0].min(STEPS_WITH_EASY.saturating_sub(others)).max(world.memory.used(0));
    if task == 1 {
        sizes[0] = sizes[0].max(steps.len());
    }
    if sizes.iter().sum::<usize>() > MAX_STEPS {
        return Err(format!("all tasks together have at most {MAX_STEPS} steps"));
    }
    let sizes = sizes.map(|size| format!("{size:04}"));
    let [one, two, three, four] = &sizes;
    write(world, &format!("WPAR E22 TASK01={one} TASK02={two} TASK03={three} TASK04={four}"))?;
    let current = std::mem::replace(&mut world.current, task - 1);
    let written = (1..).zip(steps).try_for_each(|(number, step)| edit::write_step(world, number, step));
    world.current = current;
    written
}

fn tables(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    for (task, rows) in &entries.points {
        source.each_of(rows, |number, place| {
            let task = row(task, TASKS)?;
            let number = row(number, POINTS)?;
            let [x, y, z, r] = place.map(|place| format!("{place:+08.2}"));
            let current = std::mem::replace(&mut world.current, task - 1);
            let written = write(world, &format!("WPAR T1 PT={number:03} X={x} Y={y} Z={z} R={r}"));
            world.current = current;
            written
        })?;
    }
    source.each_of(&entries.speeds, |number, speed| {
        write(world, &format!("WPAR T2 V{:02}={speed:06.1}", row(number, 20)?))
    })?;
    source
        .each_of(&entries.ramps, |number, ramp| write(world, &format!("WPAR T3 A{:02}={ramp:04.2}", row(number, 20)?)))
}

/// Parses a key that is a number from 1 to `most`.
fn row(key: &str, most: usize) -> Result<usize, String> {
    console::number(key, 1..=most)
}

/// Applies a host write command.
fn write(world: &mut World, command: &str) -> Result<(), String> {
    let request = Request::parse(&format!("@{command}")).map_err(|error| error.to_string())?;
    request.check().map_err(|error| error.to_string())?;
    if !matches!(request.command(), Command::Wpar | Command::Wstx | Command::Wplt | Command::Wesy | Command::Wovr) {
        return Err("only WPAR, WSTX, WPLT, WESY and WOVR are possible".to_owned());
    }
    edit::execute(world, &request).map(|_| ())
}

fn errors(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    let code = |text: &str| u8::from_str_radix(text, 16).ok().filter(|code| *code > 0);
    source.each(entries.history.iter().rev(), |HistoryEntry { code: text, after_seconds, power_cut }| {
        let entry = match (text, power_cut) {
            (None, true) => Some(Entry::PowerCut),
            (Some(text), false) => {
                code(text).map(|code| Entry::Error { code, at: Duration::from_secs(*after_seconds) })
            }
            _ => None,
        };
        world.errors.record(entry.ok_or("an entry must have a code from 01 to FF, or power_cut")?);
        Ok(())
    })?;
    source.each(&entries.error, |error| {
        world.fail(code(error).ok_or("an error must have a code from 01 to FF")?);
        Ok(())
    })
}

/// Parses a port such as `0/01`, and its eight bits.
fn port(name: &str, bits: &str) -> Result<(Port, Mask), String> {
    let parts = name.split_once('/').and_then(|(station, port)| Some((station.parse().ok()?, port.parse().ok()?)));
    let (station, port) = parts.ok_or_else(|| format!("'{name}' is not a valid port, such as 0/01"))?;
    let eight = u8::from_str_radix(bits, 2).ok().filter(|_| bits.len() == 8);
    Ok((Port { station, port }, Mask::all(eight.ok_or("a port must have eight digits, each 0 or 1")?)))
}

/// Parses a version and returns it in hundredths, for example 400 for `4.00`.
fn hundredths(version: &str) -> Option<i32> {
    let field = Command::Cver.row().answers.first()?.fields.last()?;
    match field.read(version).ok()? {
        Value::Number(number) => Some(number),
        _ => None,
    }
}

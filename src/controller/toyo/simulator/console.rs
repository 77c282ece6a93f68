//! Console commands of an operator at the machine.

use super::action::axis;
use super::io::{Port, PortBit, Ports};
use super::memory::TASKS;
use super::world::{Kind, Mode, World};
use crate::simulator::console::{self, expected, number, on_off, unknown};
use crate::toyo::field::Mask;
use crate::toyo::layout::Record;

/// Lines of `help`.
const HELP: &[(&str, &str)] = &[
    ("input STATION/PORT/BIT on|off", "set an input: input 0/01/3 on"),
    ("input STATION/PORT BITS", "set all eight bits of a port: input 0/01 00000100"),
    ("input 0/SY/BIT on|off", "set a bit of the system port: 1 home, 2 start, 3 stop, 4 reset"),
    ("start [STEP]", "press START"),
    ("stop", "press STOP"),
    ("reset", "press RESET: set programs to their first step"),
    ("home", "press HOME: return to origin"),
    ("clear", "cancel the error"),
    ("servo on|off", "switch servo power"),
    ("pendant on|off", "switch the teach pendant"),
    ("estop [off]", "press or release the emergency stop"),
    ("error CODE", "raise an error: error 28"),
    ("power cycle", "switch the controller off and on"),
    ("card in|out", "insert or remove the memory card"),
    ("obstacle AXIS PLACE|off", "block an axis at a position in mm, or free it"),
    ("slave on|off", "set whether slave units are ready"),
    ("battery low|ok", "set the battery state"),
    ("why", "show the reason for the last refusal"),
];

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ConsoleLine {
    Help,
    State,
    /// Shows the last refusal.
    Why,
    Input(Port, Mask),
    /// Sets bits of the system port SY01.
    System(u8, bool),
    WallContact(Button),
    StartAt(usize),
    Clear,
    Servo(bool),
    Pendant(bool),
    EmergencyStop(bool),
    Error(u8),
    PowerCycle,
    Card(bool),
    Obstacle(usize, Option<f64>),
    Slave(bool),
    BatteryLow(bool),
}

/// A button with the same function as a host command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Button {
    Home,
    Start,
    Stop,
    Reset,
}

/// Bits of SY01 and their buttons. A rising edge of a bit presses its button.
const BUTTONS: [(u8, Button); 4] =
    [(0b0001, Button::Home), (0b0010, Button::Start), (0b0100, Button::Stop), (0b1000, Button::Reset)];

impl ConsoleLine {
    pub(super) fn parse(line: &str) -> Result<Self, String> {
        let words: Vec<&str> = line.split_whitespace().collect();
        Ok(match words.as_slice() {
            ["help"] => Self::Help,
            ["robot" | "state"] => Self::State,
            ["why"] => Self::Why,
            ["input", place, value] => input(place, value)?,
            ["start"] => Self::WallContact(Button::Start),
            ["start", step] => Self::StartAt(number(step, 1..=5000)?),
            ["stop"] => Self::WallContact(Button::Stop),
            ["reset"] => Self::WallContact(Button::Reset),
            ["home"] => Self::WallContact(Button::Home),
            ["clear"] => Self::Clear,
            ["servo", state] => Self::Servo(on_off(state)?),
            ["pendant", state] => Self::Pendant(on_off(state)?),
            ["estop"] => Self::EmergencyStop(true),
            ["estop", "off"] => Self::EmergencyStop(false),
            ["error", code] => {
                let code = u8::from_str_radix(code, 16).ok().filter(|code| *code > 0);
                Self::Error(code.ok_or("the code of an error must be from 01 to FF")?)
            }
            ["power", "cycle"] => Self::PowerCycle,
            ["card", "in"] => Self::Card(true),
            ["card", "out"] => Self::Card(false),
            ["obstacle", letter, place] => obstacle(letter, place)?,
            ["slave", state] => Self::Slave(on_off(state)?),
            ["battery", "low"] => Self::BatteryLow(true),
            ["battery", "ok"] => Self::BatteryLow(false),
            _ => return Err(unknown(line)),
        })
    }

    /// Executes the line and returns the output.
    pub(super) fn execute(self, world: &mut World) -> Result<String, String> {
        match self {
            Self::Help => return Ok(console::help(HELP)),
            Self::State => return Ok(console::table(&state(world))),
            Self::Why => {
                let last = world.refusal.as_ref();
                return Ok(last.map_or("no command was refused".into(), |(block, why)| format!("{block}: {why}")));
            }
            Self::Input(port, mask) => set_input(world, port, mask)?,
            Self::System(mask, on) => set_system(world, mask, on),
            Self::WallContact(button) => press(world, button)?,
            Self::StartAt(step) => {
                host_off(world)?;
                world.start_sequential(step)?;
            }
            Self::Clear => world.cancel_error()?,
            Self::Servo(on) => world.servo(on)?,
            Self::Pendant(on) => world.pendant(on),
            Self::EmergencyStop(pressed) => world.emergency_stop(pressed),
            Self::Error(code) => world.fail(code),
            Self::PowerCycle => world.power_cycle(),
            Self::Card(inserted) => world.insert_card(inserted),
            Self::Obstacle(axis, at) => world.arm.set_wall(axis, at, world.now),
            Self::Slave(ready) => world.switches.slaves_ready = ready,
            Self::BatteryLow(low) => world.switches.battery_low = low,
        }
        world.settle();
        Ok(summary(world))
    }
}

pub(super) fn execute(world: &mut World, line: &str) -> Result<String, String> {
    ConsoleLine::parse(line)?.execute(world)
}

/// Parses an input line, for example `0/01/3 on` or `0/01 00000100`. `0/SY/2 on` is a bit of the system port.
fn input(place: &str, value: &str) -> Result<ConsoleLine, String> {
    let parts: Vec<&str> = place.split('/').collect();
    let existing = |station: &str, port: &str| {
        let port = Port { station: number(station, 0..=4)?, port: number(port, 1..=99)? };
        let known = Ports::default().input(port).is_some();
        if known { Ok(port) } else { Err(format!("no input port {}/{:02}", port.station, port.port)) }
    };
    match parts.as_slice() {
        ["0", "SY", bit] => Ok(ConsoleLine::System(mask(bit)?, on_off(value)?)),
        [station, port, bit] => {
            let (port, care) = (existing(station, port)?, mask(bit)?);
            Ok(ConsoleLine::Input(port, Mask { care, bits: if on_off(value)? { care } else { 0 } }))
        }
        [station, port] => {
            let bits = u8::from_str_radix(value, 2).ok().filter(|_| value.len() == 8);
            let bits = bits.ok_or_else(|| expected(value, "eight digits, each 0 or 1"))?;
            Ok(ConsoleLine::Input(existing(station, port)?, Mask::all(bits)))
        }
        _ => Err(expected(place, "an address such as 0/01/3 or 0/01")),
    }
}

fn obstacle(letter: &str, place: &str) -> Result<ConsoleLine, String> {
    let axis = axis(letter).ok_or_else(|| expected(letter, "X, Y, Z or R"))?;
    let coordinate = || place.parse().ok().filter(|at: &f64| at.abs() <= 8000.0);
    Ok(ConsoleLine::Obstacle(
        axis,
        match place {
            "off" => None,
            _ => Some(coordinate().ok_or_else(|| expected(place, "a coordinate in mm, or off"))?),
        },
    ))
}

fn press(world: &mut World, button: Button) -> Result<(), String> {
    if button == Button::Start {
        host_off(world)?;
    }
    match (button, world.kind()) {
        (Button::Home, _) => world.home()?,
        (Button::Start, Kind::Sequential) => world.start_sequential(0)?,
        (Button::Start, Kind::Palletizing) => world.start_palletizing()?,
        (Button::Start, Kind::Easy) => world.start_easy()?,
        (Button::Start, Kind::Point) => return Err("only the host starts external points".into()),
        (Button::Stop, _) => world.stop(),
        (Button::Reset, _) => world.reset()?,
    }
    Ok(())
}

/// Refuses while the host is ON, because only the host can then start programs (TO 2-2, HSON).
fn host_off(world: &World) -> Result<(), String> {
    if world.switches.host { Err("the host is ON: only the host starts programs".into()) } else { Ok(()) }
}

/// Sets an input port. Edges of the servo input switch servo power (M21).
fn set_input(world: &mut World, port: Port, mask: Mask) -> Result<(), String> {
    let previous_inputs = world.ports.is_on(world.settings.servo_on);
    world.ports.set_input(port, mask);
    let servo = world.ports.is_on(world.settings.servo_on);
    if servo == previous_inputs { Ok(()) } else { world.servo(servo).map_err(str::to_owned) }
}

/// Sets bits of the system port SY01. A button is ignored if it is not allowed in the current state. The `why` command
/// shows the reason.
fn set_system(world: &mut World, mask: u8, on: bool) {
    let previous_inputs = world.ports.system;
    world.ports.system = if on { previous_inputs | mask } else { previous_inputs & !mask };
    let switched_on = world.ports.system & !previous_inputs;
    for (_, button) in BUTTONS.iter().filter(|(bit, _)| switched_on & bit != 0) {
        if let Err(why) = press(world, *button) {
            world.refusal = Some((format!("{button:?}").to_lowercase(), why));
        }
    }
}

/// One line with all states on which refusals depend.
fn summary(world: &World) -> String {
    let always = [
        match world.kind() {
            Kind::Sequential => "sequential",
            Kind::Palletizing => "palletizing",
            Kind::Point => "external point",
            Kind::Easy => "easy",
        },
        match world.switches.mode {
            Mode::Automatic => "automatic mode",
            Mode::Step => "step mode",
            Mode::Program => "program mode",
        },
        if world.switches.host { "host on" } else { "host off" },
        if world.has_servo() { "servo on" } else { "servo off" },
    ];
    let optional = [
        (!world.knows_origin(), "origin unknown"),
        (world.is_executing(), "executing"),
        (world.is_paused(), "paused"),
        (world.arm.homing.is_some(), "returning to origin"),
        (world.switches.pendant, "teach pendant on"),
        (world.switches.estop, "emergency stop"),
        (world.switches.machine_changed, "parameter 2 changed"),
        (world.card.is_busy(), "card busy"),
        (world.errors.current.is_some(), "error"),
    ];
    console::summary(&always, optional)
}

/// Summary, error, position, tasks and outputs.
fn state(world: &World) -> Vec<(String, String)> {
    let mut rows = vec![("now".to_owned(), summary(world))];
    if let Some(code) = world.errors.current {
        rows.push(("error".to_owned(), format!("{code:02X}")));
    }
    let [x, y, z, r] = world.arm.position(world.now);
    rows.push(("position".to_owned(), format!("X {x:.2}  Y {y:.2}  Z {z:.2}  R {r:.2} mm")));
    for index in (0..TASKS).filter(|&index| world.memory.size(index) > 0) {
        let task = &world.tasks[index];
        let step = world.memory.step(index, task.step).map(Record::written);
        let what = match (task.running, task.stopped || world.is_held()) {
            (true, false) => "runs",
            (true, true) => "stands",
            (false, _) => "is idle",
        };
        let state_text = format!("{what}, step {:04} {}", task.step, step.unwrap_or_default());
        rows.push((format!("task {}", index + 1), state_text));
    }
    for (port, bits) in world.ports.outputs().filter(|(_, bits)| *bits != 0) {
        rows.push((format!("output {}/{:02}", port.station, port.port), format!("{bits:08b}")));
    }
    rows.push(("EEPROM writes".to_owned(), world.memory.wear.total().to_string()));
    rows
}

/// Mask for a bit number. Bit numbers start at 1.
fn mask(bit: &str) -> Result<u8, String> {
    let bit = u8::try_from(number(bit, 1..=8)?).unwrap_or(1);
    Ok(PortBit { port: Port { station: 0, port: 1 }, bit }.mask())
}

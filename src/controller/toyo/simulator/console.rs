//! What somebody at the machine can do: one line, one action.

use super::action::axis;
use super::io::{Port, PortBit};
use super::memory::TASKS;
use super::world::{Kind, Mode, World};
use crate::controller::toyo::field::Mask;

/// The lines there are, as `help` shows them.
const USAGE: &str = "input STATION/PORT/BIT on|off | input STATION/PORT BITS | start [STEP] | stop | reset | \
home | clear | servo on|off | pendant on|off | estop [off] | error CODE | power cycle | card in|out | \
obstacle AXIS PLACE|off | slave on|off | battery low|ok | state | why";

/// Bits of SY01, rising edges of which do what the buttons do while the host is off.
const BUTTONS: [(u8, Button); 4] =
    [(0b0001, Button::Home), (0b0010, Button::Start), (0b0100, Button::Stop), (0b1000, Button::Reset)];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Button {
    Home,
    Start,
    Stop,
    Reset,
}

/// Carries out a line; the answer says what is now.
pub(super) fn execute(world: &mut World, line: &str) -> Result<String, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words.as_slice() {
        ["help"] => return Ok(USAGE.replace(" | ", "\n")),
        ["state"] => return Ok(state(world)),
        ["why"] => {
            let last = world.refusal.as_ref();
            return Ok(last.map_or("nothing was refused".into(), |(block, why)| format!("{block}: {why}")));
        }
        ["input", place, rest @ ..] => input(world, place, rest)?,
        ["start"] => press(world, Button::Start)?,
        ["start", step] => {
            host_off(world)?;
            world.start_sequential(number(step, 1, 5000)?)?;
        }
        ["stop"] => press(world, Button::Stop)?,
        ["reset"] => press(world, Button::Reset)?,
        ["home"] => press(world, Button::Home)?,
        ["clear"] => world.cancel_error()?,
        ["servo", state] => world.servo(on_off(state)?)?,
        ["pendant", state] => world.pendant(on_off(state)?),
        ["estop"] => world.emergency_stop(true),
        ["estop", "off"] => world.emergency_stop(false),
        ["error", code] => {
            let code = u8::from_str_radix(code, 16).ok().filter(|code| *code > 0);
            world.fail(code.ok_or("an error has a code from 01 to FF")?);
        }
        ["power", "cycle"] => world.power_cycle(),
        ["card", "in"] => world.insert_card(true),
        ["card", "out"] => world.insert_card(false),
        ["obstacle", letter, place] => obstacle(world, letter, place)?,
        ["slave", state] => world.switches.slaves_ready = on_off(state)?,
        ["battery", "low"] => world.switches.battery_low = true,
        ["battery", "ok"] => world.switches.battery_low = false,
        _ => return Err(format!("no such line: '{}'", line.trim())),
    }
    world.settle();
    Ok(summary(world))
}

/// Whether a line is one of those there are, whatever the state is in which it will be carried out.
pub(super) fn check(line: &str) -> Result<(), String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let known = USAGE.split(" | ").any(|usage| usage.split(' ').next() == words.first().copied());
    if known { Ok(()) } else { Err(format!("no such line: '{}'", line.trim())) }
}

/// What a button does: like the host's command, but by whoever stands there.
fn press(world: &mut World, button: Button) -> Result<(), String> {
    if button == Button::Start {
        host_off(world)?;
    }
    match (button, world.kind()) {
        (Button::Home, _) => world.home()?,
        (Button::Start, Kind::Sequential) => world.start_sequential(0)?,
        (Button::Start, Kind::Palletizing) => world.start_palletizing()?,
        (Button::Start, Kind::Easy) => world.start_easy()?,
        (Button::Start, Kind::Point) => return Err("external points are started by the host".into()),
        (Button::Stop, _) => world.stop(),
        (Button::Reset, _) => world.reset()?,
    }
    Ok(())
}

/// While the host is on, nobody else starts anything (TO 2-2, HSON).
fn host_off(world: &World) -> Result<(), String> {
    if world.switches.host { Err("the host is on: it alone starts programs".into()) } else { Ok(()) }
}

/// `0/01/3 on`, `0/01 00000100`; `0/SY/2 on` is a bit of the system port.
fn input(world: &mut World, place: &str, rest: &[&str]) -> Result<(), String> {
    let parts: Vec<&str> = place.split('/').collect();
    let servo_before = world.ports.is_on(world.settings.servo_on);
    match (parts.as_slice(), rest) {
        (["0", "SY", bit], [state]) => {
            let bit = PortBit { port: Port { station: 0, port: 1 }, bit: byte(bit, 1, 8)? };
            system(world, bit.mask(), on_off(state)?);
            return Ok(());
        }
        ([station, port, bit], [state]) => {
            let (port, bit) = (own(station, port)?, byte(bit, 1, 8)?);
            let mask = PortBit { port, bit }.mask();
            let bits = if on_off(state)? { mask } else { 0 };
            set(world, place, port, Mask { care: mask, bits })?;
        }
        ([station, port], [bits]) => {
            let eight = u8::from_str_radix(bits, 2).ok().filter(|_| bits.len() == 8);
            let eight = eight.ok_or_else(|| expected(bits, "eight of 0 and 1"))?;
            set(world, place, own(station, port)?, Mask::all(eight))?;
        }
        _ => return Err("input needs a place like 0/01/3 and on or off, or 0/01 and eight bits".into()),
    }
    // The servo input acts by its edges (M21).
    let servo = world.ports.is_on(world.settings.servo_on);
    if servo != servo_before {
        let _ = world.servo(servo);
    }
    Ok(())
}

fn set(world: &mut World, place: &str, port: Port, mask: Mask) -> Result<(), String> {
    if world.ports.set_input(port, mask) { Ok(()) } else { Err(format!("there is no input port {place}")) }
}

fn system(world: &mut World, mask: u8, on: bool) {
    let before = world.ports.system;
    world.ports.system = if on { before | mask } else { before & !mask };
    let risen = world.ports.system & !before;
    for (_, button) in BUTTONS.iter().filter(|(bit, _)| risen & bit != 0) {
        // What cannot be done now is not done, as with a button.
        let _ = press(world, *button);
    }
}

fn obstacle(world: &mut World, letter: &str, place: &str) -> Result<(), String> {
    let axis = axis(letter).ok_or_else(|| expected(letter, "X, Y, Z or R"))?;
    let coordinate = || place.parse().ok().filter(|at: &f64| at.abs() <= 8000.0);
    let at = match place {
        "off" => None,
        _ => Some(coordinate().ok_or_else(|| expected(place, "a coordinate in mm, or off"))?),
    };
    world.arm.set_wall(axis, at, world.now);
    Ok(())
}

/// One line about everything that decides what is refused.
fn summary(world: &World) -> String {
    let mut parts = vec![
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
        (world.is_held() && world.is_running(), "paused"),
        (world.arm.homing.is_some(), "returning to origin"),
        (world.switches.pendant, "teach pendant on"),
        (world.switches.estop, "emergency stop"),
        (world.switches.machine_changed, "parameter 2 changed"),
        (world.card.is_busy(), "card busy"),
        (world.errors.current().is_some(), "error"),
    ];
    parts.extend(optional.into_iter().filter_map(|(on, text)| on.then_some(text)));
    parts.join(", ")
}

/// The summary, then error, place, tasks and outputs.
fn state(world: &World) -> String {
    let mut lines = vec![summary(world)];
    if let Some(code) = world.errors.current() {
        lines.push(format!("error {code:02X}"));
    }
    let place = world.arm.position(world.now);
    lines.push(format!("X {:.2}  Y {:.2}  Z {:.2}  R {:.2} mm", place[0], place[1], place[2], place[3]));
    for index in (0..TASKS).filter(|&index| world.memory.size(index) > 0) {
        let task = &world.tasks[index];
        let step = world.memory.step(index, task.step).map(crate::controller::toyo::layout::Record::written);
        let what = match (task.running, task.stopped || world.is_held()) {
            (true, false) => "runs",
            (true, true) => "stands",
            (false, _) => "is idle",
        };
        lines.push(format!("task {} {what}, step {:04} {}", index + 1, task.step, step.unwrap_or_default()));
    }
    for (port, bits) in world.ports.outputs().filter(|(_, bits)| *bits != 0) {
        lines.push(format!("output {}/{:02} {bits:08b}", port.station, port.port));
    }
    lines.push(format!("{} EEPROM writes", world.memory.wear.total()));
    lines.join("\n")
}

fn own(station: &str, port: &str) -> Result<Port, String> {
    Ok(Port { station: number(station, 0, 4)?, port: number(port, 1, 99)? })
}

fn byte(word: &str, least: usize, most: usize) -> Result<u8, String> {
    number(word, least, most).map(|number| u8::try_from(number).unwrap_or_default())
}

fn on_off(word: &str) -> Result<bool, String> {
    match word {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(expected(word, "on or off")),
    }
}

fn number(word: &str, least: usize, most: usize) -> Result<usize, String> {
    let number = word.parse().ok().filter(|number| (least..=most).contains(number));
    number.ok_or_else(|| expected(word, &format!("a number from {least} to {most}")))
}

fn expected(word: &str, what: &str) -> String {
    format!("'{word}' is not {what}")
}

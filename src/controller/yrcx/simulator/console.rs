//! Console commands of an operator at the machine.

use super::alarms::{AlarmSource, Fault, NOT_AUTO};
use super::geometry::whole;
use super::memory::{PORT_NAMES, SI};
use super::program::assigned;
use super::robot::{Axis, Servo};
use super::world::{Mode, World};
use crate::simulator::console::{self, on_off, unknown};
use crate::yrcx::alarm::Alarm;

/// Lines of `help`.
const HELP: &[(&str, &str)] = &[
    ("estop on|off", "press or release the emergency stop"),
    ("mode auto|manual", "turn the mode key"),
    ("box on|off", "give control to the programming box, or take it back"),
    ("inputs on|off", "enable or disable the dedicated inputs"),
    ("warning on|off", "show a warning, or clear it"),
    ("alarm GROUP.CATEGORY [fatal]", "raise an alarm: alarm 12.600"),
    ("DI(20)=1, DO2()=255", "set a port, or a bit of a port"),
    ("obstacle R1A3 PULSES|off", "block an axis of a robot at a position, or free it"),
    ("load R1A3 PERCENT", "set the load of an axis"),
    ("power", "switch the controller off and on"),
    ("why", "show the reason for the last refusal"),
    ("journal", "list the images from masters since the last `journal`"),
];

pub(super) fn execute(world: &mut World, line: &str) -> Result<String, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words.as_slice() {
        ["help"] => return Ok(console::help(HELP)),
        ["robot" | "state"] => return Ok(console::table(&state(world))),
        ["why"] => {
            let why = world.why.as_ref().map(ToString::to_string);
            return Ok(why.unwrap_or_else(|| "no command was refused".to_owned()));
        }
        ["estop", on] => {
            world.switches.estop = on_off(on)?;
            world.check_emergency();
        }
        ["mode", "auto"] => set_mode(world, Mode::Auto),
        ["mode", "manual"] => set_mode(world, Mode::Manual),
        ["box", on] => world.switches.boxed = on_off(on)?,
        ["inputs", on] => world.switches.inputs = on_off(on)?,
        ["warning", on] => world.switches.warning = on_off(on)?,
        ["alarm", number] => raise(world, number, false)?,
        ["alarm", number, "fatal"] => raise(world, number, true)?,
        ["power"] => world.power_cycle(),
        ["obstacle", axis, "off"] => find_axis(world, axis)?.obstacle = None,
        ["obstacle", axis, place] => {
            let place = place.parse::<i32>().map_err(|_| format!("'{place}' is not a valid number of pulses"))?;
            find_axis(world, axis)?.obstacle = Some(place.into());
        }
        ["load", axis, load] => {
            let load = load.parse().ok().filter(|load| (-100..=100).contains(load));
            find_axis(world, axis)?.load = load.ok_or("a load must be from -100 to 100 %")?;
        }
        [port] if port.contains('=') => return set_port(world, port),
        _ => return Err(unknown(line)),
    }
    Ok(summary(world))
}

/// Sets the mode. Leaving AUTO mode stops programs.
fn set_mode(world: &mut World, mode: Mode) {
    if world.switches.mode != mode {
        world.switches.mode = mode;
        world.stop(&Fault::new(NOT_AUTO, AlarmSource::Controller, "the mode was changed"));
    }
}

fn raise(world: &mut World, number: &str, fatal: bool) -> Result<(), String> {
    let alarm = number.parse::<Alarm>().map_err(|error| error.to_string())?;
    world.raise(&Fault::new(alarm, AlarmSource::Controller, "raised at the console"), fatal);
    Ok(())
}

fn set_port(world: &mut World, text: &str) -> Result<String, String> {
    let found = assigned(text).filter(|(port, _)| port.kind != SI);
    let (port, value) =
        found.ok_or_else(|| format!("'{text}' is not a port that can be set here; the master sets SI"))?;
    world.memory.set_output(port, value);
    world.restless = true;
    let byte = world.memory.port(port.kind, port.port);
    Ok(format!("{}{}() is {byte}", PORT_NAMES[port.kind], port.port))
}

/// Finds an axis by its name, for example `R1A3`.
fn find_axis<'a>(world: &'a mut World, text: &str) -> Result<&'a mut Axis, String> {
    let numbers = text.strip_prefix('R').and_then(|rest| rest.split_once('A'));
    let index = |digits: &str| digits.parse::<usize>().ok()?.checked_sub(1);
    let place = numbers.and_then(|(robot, axis)| Some((index(robot)?, index(axis)?)));
    place
        .and_then(|(robot, axis)| world.robots.get_mut(robot)?.axes.get_mut(axis))
        .ok_or_else(|| format!("'{text}' is not a valid axis, such as R1A3"))
}

fn summary(world: &World) -> String {
    let mode = if world.switches.mode == Mode::Auto { "mode auto" } else { "mode manual" };
    let power = if world.motor { "motor power on" } else { "motor power off" };
    let optional = [
        (world.emergency(), "emergency stop"),
        (world.switches.boxed, "the programming box has control"),
        (!world.switches.inputs, "dedicated inputs disabled"),
        (world.is_running(), "a program runs"),
        (world.switches.warning, "warning"),
    ];
    let alarms = world.alarms.all_active().map(|alarm| format!(", alarm {alarm}"));
    console::summary(&[mode, power], optional) + &alarms.collect::<String>()
}

/// Summary, robots and tasks.
fn state(world: &World) -> Vec<(String, String)> {
    let mut rows = vec![("now".to_owned(), summary(world))];
    for (number, robot) in world.robots.iter().enumerate() {
        let places = robot.pulses().map(whole);
        let pulses: Vec<String> = places.iter().take(robot.axes.len()).map(ToString::to_string).collect();
        let servos: String = robot
            .axes
            .iter()
            .map(|axis| match axis.servo {
                Servo::Brake => '-',
                Servo::On => '+',
                Servo::Free => '~',
            })
            .collect();
        let moving = if robot.motion.is_some() { ", moving" } else { "" };
        let origin = if robot.is_at_home() { "" } else { ", origin incomplete" };
        let told = format!("{} pulses, servos {servos}{moving}{origin}", pulses.join(" "));
        rows.push((format!("robot {}", number + 1), told));
    }
    for task in &world.tasks {
        let state = ["stopped", "running", "suspended", "waiting"];
        let state = usize::try_from(task.status()).ok().and_then(|at| state.get(at)).unwrap_or(&"");
        let told = format!("program {}, line {}, {state}", task.program, world.line_of(task));
        rows.push((format!("task {}", task.number), told));
    }
    rows
}

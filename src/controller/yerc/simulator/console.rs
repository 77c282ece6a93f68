//! Console commands of an operator at the machine.

use super::alarms::Class;
use super::memory::io_class;
use super::world::{Mode, World};
use crate::refuse_if;
use crate::simulator::console::{self, expected, number, on_off, unknown};
use crate::yerc::payload::CycleMode;

/// Lines of `help`.
const HELP: &[(&str, &str)] = &[
    ("alarm CODE [DATA [TYPE]] [NAME]", "raise an alarm: alarm 4315 1 2 COLLISION DETECT"),
    ("alarm clear", "remove all alarms"),
    ("error on|off", "show an error, or clear it"),
    ("mode teach|play", "turn the mode key"),
    ("remote on|off", "accept remote commands, or reject them (CMD REMOTE)"),
    ("servo on|off", "switch servo power"),
    ("cycle step|once|continuous", "select how jobs run"),
    ("hold pendant|external on|off", "press or release a HOLD"),
    ("estop [off]", "press or release the emergency stop"),
    ("guard on|off", "in-guard safe operation"),
    ("edit on|off", "set whether a job is open for editing at the pendant"),
    ("convert on|off", "set whether a coordinate conversion runs"),
    ("io SIGNAL on|off", "set a signal: io 20010 on"),
    ("register NUMBER VALUE", "set a register: register 0 17"),
];

pub(super) fn execute(world: &mut World, line: &str) -> Result<String, String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    match words.as_slice() {
        ["help"] => return Ok(console::help(HELP)),
        ["robot" | "state"] => return Ok(console::table(&state(world))),
        ["alarm", "clear"] => world.alarms.clear(),
        ["alarm", rest @ ..] => return alarm(world, rest),
        ["error", state] => world.switches.error = on_off(state)?,
        ["mode", "teach"] => set_mode(world, Mode::Teach)?,
        ["mode", "play"] => set_mode(world, Mode::Play)?,
        ["remote", state] => {
            let mode = world.switches.mode;
            world.set_mode(mode, on_off(state)?);
        }
        ["servo", state] => servo(world, on_off(state)?)?,
        ["cycle", name] => {
            unlocked(world)?;
            world.switches.cycle = cycle(name).ok_or_else(|| expected(name, "step, once or continuous"))?;
        }
        ["hold", "pendant", state] => {
            let on = on_off(state)?;
            unlocked(world)?;
            world.switches.hold.pendant = on;
            if on {
                world.stop();
            }
        }
        ["hold", "external", state] => {
            world.switches.hold.external = on_off(state)?;
            if world.switches.hold.external {
                world.stop();
            }
        }
        ["estop"] => {
            world.switches.estop = true;
            world.power_off();
        }
        ["estop", "off"] => world.switches.estop = false,
        ["guard", state] => world.switches.guard = on_off(state)?,
        ["edit", state] => world.switches.editing = on_off(state)?,
        ["convert", state] => world.switches.converting = on_off(state)?,
        ["io", signal, state] => return io(world, signal, on_off(state)?),
        ["register", number, value] => return register(world, number, value),
        _ => return Err(unknown(line)),
    }
    Ok(summary(world))
}

fn alarm(world: &mut World, words: &[&str]) -> Result<String, String> {
    let [code, rest @ ..] = words else { return Err("alarm needs a number from 1 to 9999, or 'clear'".into()) };
    let code = number(code, 1..=9999)?;
    let (mut numbers, mut name) = ([0, 0], rest);
    for (place, most) in [0xFFFF_FFFF, 0xFF].into_iter().enumerate() {
        let Some((digits, tail)) =
            name.split_first().filter(|(text, _)| text.starts_with(|c: char| c.is_ascii_digit()))
        else {
            break;
        };
        numbers[place] = number(digits, 0..=most)?;
        name = tail;
    }
    let [data, kind] = numbers;
    let name = name.join(" ");
    world.raise(code, data, kind, Some(name.as_str()).filter(|name| !name.is_empty()));
    Ok(format!("alarm {code} raised ({:?})", Class::from_code(code)).to_lowercase())
}

fn set_mode(world: &mut World, mode: Mode) -> Result<(), String> {
    unlocked(world)?;
    let remote = world.switches.remote;
    world.set_mode(mode, remote);
    Ok(())
}

fn servo(world: &mut World, on: bool) -> Result<(), String> {
    if !on {
        world.power_off();
        return Ok(());
    }
    unlocked(world)?;
    if world.alarms.is_active() {
        return Err("servo power stays off while an alarm is active: 'alarm clear' first".into());
    }
    refuse_if(world.switches.estop, "servo power stays off during an emergency stop: 'estop off' first".to_owned())?;
    world.switches.servo = true;
    Ok(())
}

/// Refuses while HLOCK is on. HLOCK locks the pendant, except its emergency stop (DX 3.3.20).
fn unlocked(world: &World) -> Result<(), String> {
    if world.switches.hlock { Err("the pendant is locked by HLOCK".into()) } else { Ok(()) }
}

fn io(world: &mut World, signal: &str, on: bool) -> Result<String, String> {
    let number = number(signal, 0..=99_999)?;
    if world.memory.set_signal(number, on) {
        return Ok(format!("#{number:05} is {}", if on { "on" } else { "off" }));
    }
    let known = u16::try_from(number / 10).ok().and_then(|instance| io_class(world.model, instance));
    Err(match known {
        Some(class) => format!("#{number:05}: {} signals end in 0 to 7", class.meaning),
        None => format!("#{number:05} is not a signal of this controller"),
    })
}

fn register(world: &mut World, register: &str, value: &str) -> Result<String, String> {
    let (register, value) = (number(register, 0..=999)?, number(value, 0..=0xFFFF)?);
    let fits = u16::try_from(register).ok().zip(u16::try_from(value).ok());
    match fits {
        Some((register, value)) if world.memory.force_register(register, value) => {
            Ok(format!("register {register} is {value}"))
        }
        _ => Err(format!("no register {register}")),
    }
}

/// Formats one line with all states that can cause a refusal.
fn summary(world: &World) -> String {
    let switches = &world.switches;
    let always = [
        match switches.mode {
            Mode::Teach => "teach mode",
            Mode::Play => "play mode",
        },
        if switches.remote { "command remote" } else { "local" },
        if switches.servo { "servo on" } else { "servo off" },
        match switches.cycle {
            CycleMode::Step => "step",
            CycleMode::Once => "one cycle",
            CycleMode::Continuous => "continuous",
        },
    ];
    let optional = [
        (world.is_running(), "running"),
        (switches.hold.pendant, "held by pendant"),
        (switches.hold.external, "held by external signal"),
        (switches.hold.command, "held by command"),
        (switches.estop, "emergency stop"),
        (switches.guard, "in-guard safe operation"),
        (switches.hlock, "hlock"),
        (switches.editing, "editing"),
        (switches.converting, "converting coordinates"),
        (world.alarms.is_active(), "alarm"),
        (switches.error, "error"),
    ];
    console::summary(&always, optional)
}

/// Summary, job, alarms, message and positions.
fn state(world: &World) -> Vec<(String, String)> {
    let text = |bytes: &[u8]| encoding_rs::SHIFT_JIS.decode(bytes).0.into_owned();
    let mut rows = vec![("now".to_owned(), summary(world))];
    let job = world.player.info();
    let selected = format!("{}, line {}, step {}", text(job.name.as_bytes()), job.line, job.step);
    rows.push(("job".to_owned(), if job.name.is_empty() { "none selected".to_owned() } else { selected }));
    for alarm in world.alarms.active() {
        let told = format!("{} {} {}", alarm.code, text(alarm.name.as_bytes()), alarm.sub_code(world.model));
        rows.push(("alarm".to_owned(), told));
    }
    if !world.switches.message.is_empty() {
        rows.push(("message".to_owned(), format!("\"{}\"", text(&world.switches.message))));
    }
    for group in &world.arm.groups {
        let pulses: Vec<String> =
            group.pulses[..group.axes].iter().map(|&pulse| super::motion::whole(pulse).to_string()).collect();
        rows.push((group.name(), format!("{} pulses", pulses.join(" "))));
    }
    rows
}

pub(super) fn cycle(word: &str) -> Option<CycleMode> {
    match word {
        "step" => Some(CycleMode::Step),
        "once" => Some(CycleMode::Once),
        "continuous" => Some(CycleMode::Continuous),
        _ => None,
    }
}

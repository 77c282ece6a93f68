//! Robots and memory that a start state defines.

use std::collections::BTreeMap;

use toml::Spanned;

use super::{AlarmEntry, Entries, KindEntry, Number, PalletEntry, PointEntry, RobotEntry};
use crate::refuse_if;
use crate::simulator::start::{Source, numbered};
use crate::yrcx::alarm::Alarm;
use crate::yrcx::simulator::alarms::{AlarmSource, Entry};
use crate::yrcx::simulator::defaults::{CARTESIAN, PARAMETERS, SCARA};
use crate::yrcx::simulator::geometry::{Arm, Kind, STEPS, whole};
use crate::yrcx::simulator::memory::{HANDS, Hand, POINTS, Pallet, Point, PointUnit, SHIFTS};
use crate::yrcx::simulator::program::{Program, assigned};
use crate::yrcx::simulator::request::ROBOTS;
use crate::yrcx::simulator::robot::{AXES, Axis, FULL_TORQUE, Method, Motor, Robot, Servo};
use crate::yrcx::simulator::task::{TASKS, Task};
use crate::yrcx::simulator::world::World;
use crate::yrcx::table::parameter::PARAMETERS as KNOWN_PARAMETERS;
use crate::yrcx::table::{Charset, Field};
use crate::yrcx::value::{Key, Value};

/// Adds the robots.
pub(super) fn robots(
    world: &mut World,
    entries: &[Spanned<RobotEntry>],
    power: bool,
    source: Source<'_>,
) -> Result<(), String> {
    source.each(entries, |entry| {
        if world.robots.len() >= ROBOTS {
            return Err(format!("at most {ROBOTS} robots are possible"));
        }
        world.robots.push(robot(entry, power)?);
        Ok(())
    })
}

fn robot(entry: &RobotEntry, power: bool) -> Result<Robot, String> {
    if !(1..=AXES).contains(&entry.axes) {
        return Err(format!("a robot must have 1 to {AXES} axes"));
    }
    let longest = [
        entry.pulses_per_unit.len(),
        entry.limits.len(),
        entry.speeds.len(),
        entry.motors.len(),
        entry.methods.len(),
        entry.origin.len(),
        entry.position.len(),
        entry.servos.len(),
        entry.load.len(),
    ];
    if longest.iter().chain(entry.parameters.values().map(Vec::len).collect::<Vec<_>>().iter()).any(|n| *n > entry.axes)
    {
        return Err(format!("the list is longer than the {} axes of this robot", entry.axes));
    }
    let positive = |number: &f64| number.is_finite() && *number > 0.0;
    if !entry.pulses_per_unit.iter().chain(&entry.speeds).chain(&entry.arms).all(positive) {
        return Err("pulses_per_unit, speeds and arms must be above 0".to_owned());
    }
    let percents = [entry.auto_speed, entry.manual_speed, entry.program_speed];
    if !percents.iter().all(|percent| (1..=100).contains(percent)) || !(1..=10_000).contains(&entry.inching) {
        return Err("speeds must be from 1 to 100 %, inching from 1 to 10000".to_owned());
    }
    if entry.payload_g < 0 || entry.payload_g > entry.max_payload_g || entry.shift >= SHIFTS {
        return Err("payload_g must be from 0 to max_payload_g, shift from 0 to 39".to_owned());
    }
    let [first, second] = entry.arms;
    Ok(Robot {
        kind: if entry.kind == KindEntry::Scara { Kind::Scara { first, second } } else { Kind::Cartesian },
        model: entry.model,
        axes: (0..entry.axes).map(|number| axis(entry, number, power)).collect::<Result<_, String>>()?,
        max_payload_g: entry.max_payload_g,
        payload_g: entry.payload_g,
        auto_speed: entry.auto_speed,
        manual_speed: entry.manual_speed,
        program_speed: entry.program_speed,
        inching: entry.inching,
        shift: entry.shift,
        hand: entry.hand,
        arm: entry.arm,
        motion: None,
        ended: Vec::new(),
        pushing: None,
        homing: 0,
        kept: None,
        log: None,
    })
}

fn axis(entry: &RobotEntry, number: usize, power: bool) -> Result<Axis, String> {
    let usual = if entry.kind == KindEntry::Scara { SCARA[number] } else { CARTESIAN[number] };
    let limits = entry.limits.get(number).copied().unwrap_or([-usual.limit, usual.limit]);
    if limits[0] >= limits[1] {
        return Err(format!("the limits of axis {} are in the wrong order", number + 1));
    }
    let servo = entry.servos.get(number).copied().unwrap_or(Servo::On);
    let mut parameters: BTreeMap<u16, i32> = PARAMETERS.into();
    for (name, values) in &entry.parameters {
        let known = KNOWN_PARAMETERS.iter().find(|known| known.name == *name && known.per_axis);
        let known = known.ok_or_else(|| format!("'{name}' is not a valid parameter of an axis"))?;
        let Some(value) = values.get(number) else { continue };
        if !(known.span.0..=known.span.1).contains(value) {
            return Err(format!("{name} must be from {} to {}", known.span.0, known.span.1));
        }
        parameters.insert(known.number, *value);
    }
    Ok(Axis {
        model: entry.model,
        motor: entry.motors.get(number).copied().unwrap_or(Motor::Absolute),
        method: entry.methods.get(number).copied().unwrap_or(Method::Mark),
        per_unit: entry.pulses_per_unit.get(number).copied().unwrap_or(usual.per_unit),
        limits: (limits[0].into(), limits[1].into()),
        speed: entry.speeds.get(number).copied().unwrap_or(usual.speed),
        pulses: entry.position.get(number).copied().unwrap_or(0).into(),
        servo: if power { servo } else { Servo::Brake },
        origin: entry.origin.get(number).copied().unwrap_or(true),
        torque_limit: FULL_TORQUE,
        load: entry.load.get(number).copied().unwrap_or(0).clamp(-FULL_TORQUE, FULL_TORQUE),
        obstacle: entry.obstacles.get(&(number + 1).to_string()).map(|place| f64::from(*place)),
        parameters,
    })
}

/// Adds the entries to the existing content, except the robots.
pub(super) fn memory(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    let last_point = usize::from(POINTS) - 1;
    source.each_of(&entries.points, |number, entry| {
        let number = numbered("points", number, 0..=last_point)?;
        world.memory.set_point(number, point(entry)?);
        Ok(())
    })?;
    source.each_of(&entries.comments, |number, comment| {
        let number = numbered("points", number, 0..=last_point)?;
        let field = Field::text(Key::Comment, "comment", 4, Charset::Comment);
        field.accept(&Value::from(comment.as_str()))?;
        world.memory.comments.insert(u16::try_from(number).unwrap_or(u16::MAX), comment.clone());
        Ok(())
    })?;
    source.each_of(&entries.pallets, |number, &PalletEntry { counts, first }| {
        let number = numbered("pallets", number, 0..=SHIFTS - 1)?;
        let places: i64 = counts.iter().map(|count| i64::from(*count)).product();
        if counts.iter().any(|count| *count < 1) || places > 32_767 || first > POINTS - 5 {
            return Err("a pallet must have 1 to 32767 positions, and its last point must be at most 29999".to_owned());
        }
        world.memory.pallets[number] = Some(Pallet { counts, first });
        Ok(())
    })?;
    source.each_of(&entries.shifts, |number, shift| {
        world.memory.shifts[numbered("shifts", number, 0..=SHIFTS - 1)?] = shift.map(|place| whole(place * STEPS));
        Ok(())
    })?;
    source.each_of(&entries.hands, |number, hand| {
        let number = numbered("hands", number, 0..=HANDS - 1)?;
        let owner = hand.robot.checked_sub(1).filter(|owner| *owner < ROBOTS);
        let owner = owner.ok_or("robots must be from 1 to 4")?;
        world.memory.hands[number] = Some(Hand { owner, data: hand.data });
        Ok(())
    })?;
    source.each_of(&entries.variables, |name, number| {
        let variable = variable(name).ok_or_else(|| format!("'{name}' is not a valid variable"))?;
        let value = match *number {
            Number::Whole(value) => value.into(),
            Number::Real(value) => value,
        };
        world.memory.assign(variable, value).map_err(|fault| fault.why)
    })?;
    source.each_of(&entries.ports, |name, value| {
        let assigned = assigned(&format!("{name}={value}"));
        let (port, value) = assigned.ok_or_else(|| format!("'{name}' is not a valid port or signal"))?;
        world.memory.set_output(port, value);
        Ok(())
    })?;
    programs(world, entries, source)?;
    source.each(&entries.history, |entry| {
        world.alarms.fill(alarm(entry)?);
        Ok(())
    })?;
    source.each(&entries.latest_remote, |entry| {
        world.alarms.set_latest_remote(alarm(entry)?);
        Ok(())
    })
}

fn programs(world: &mut World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    source.each(&entries.programs, |program| {
        refuse_if(!(1..=100).contains(&program.number), "programs must be from 1 to 100".to_owned())?;
        let parsed = Program::parse(&program.name, program.text.trim_end())?;
        world.programs.insert(program.number, parsed);
        Ok(())
    })?;
    source.each(&entries.tasks, |task| {
        let program = world.programs.get(&task.program);
        let program = program.ok_or_else(|| format!("no program {}", task.program))?;
        let fits = (1..=TASKS).contains(&task.number) && (1..=64).contains(&task.priority);
        if !fits || !(1..=program.lines.len()).contains(&task.line) {
            return Err(
                "tasks must be from 1 to 16, priorities from 1 to 64, and lines must exist in the program".to_owned()
            );
        }
        let mut new = Task::new(task.number, task.program, task.priority);
        new.set_line(task.line - 1);
        new.state = task.state;
        world.tasks.retain(|other| other.number != task.number && other.program != task.program);
        world.tasks.push(new);
        Ok(())
    })
}

/// Checks constraints on several entries.
pub(super) fn check(world: &World, entries: &Entries, source: Source<'_>) -> Result<(), String> {
    let mut number = 0;
    source.each(&entries.robots, |robot| {
        number += 1;
        let Some(hand) = robot.hand else { return Ok(()) };
        let owner = world.memory.hands.get(hand).copied().flatten().map(|hand| hand.owner + 1);
        if owner == Some(number) { Ok(()) } else { Err(format!("hand {hand} is not defined for robot {number}")) }
    })
}

fn point(entry: &PointEntry) -> Result<Point, String> {
    let hand_system = entry.hand.map_or(0, Arm::hand_system);
    match (entry.pulse, entry.mm) {
        (Some(values), None) => Ok(Point { unit: PointUnit::Pulse, hand_system: 0, values }),
        (None, Some(values)) => {
            Ok(Point { unit: PointUnit::Mm, hand_system, values: values.map(|place| whole(place * STEPS)) })
        }
        _ => Err("a point must have either pulse or mm".to_owned()),
    }
}

fn variable(name: &str) -> Option<usize> {
    let index = |prefix| name.strip_prefix(prefix)?.parse().ok().filter(|index: &usize| *index < 32);
    index("SGI").or_else(|| index("SGR").map(|index| index + 256))
}

fn alarm(entry: &AlarmEntry) -> Result<Entry, String> {
    let alarm: Alarm = entry.alarm.parse().map_err(|error: crate::yrcx::alarm::AlarmError| error.to_string())?;
    let place = match entry.place.as_str() {
        "" | "C1" => Some(AlarmSource::Controller),
        "C1O1" => Some(AlarmSource::Slot),
        other => other_place(other),
    };
    Ok((alarm, place.ok_or_else(|| format!("'{}' is not a valid place, such as C1O1 or R1A3", entry.place))?))
}

fn other_place(text: &str) -> Option<AlarmSource> {
    let index = |digits: &str, most| digits.parse::<usize>().ok()?.checked_sub(1).filter(|index| *index < most);
    if let Some(task) = text.strip_prefix('T') {
        return task.parse().ok().filter(|task| (1..=TASKS).contains(task)).map(AlarmSource::Task);
    }
    match text.strip_prefix('R')?.split_once('A') {
        Some((robot, axis)) => Some(AlarmSource::Axis(index(robot, ROBOTS)?, index(axis, AXES)?)),
        None => index(text.strip_prefix('R')?, ROBOTS).map(AlarmSource::Robot),
    }
}

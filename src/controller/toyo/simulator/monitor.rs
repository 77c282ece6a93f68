//! Commands that read data.

use super::errors::Entry;
use super::io::Port;
use super::memory::index;
use super::reply::{Fields, Reply};
use super::routine::Routine;
use super::world::World;
use crate::toyo::field::Value;
use crate::toyo::layout::Record;
use crate::toyo::request::Request;
use crate::toyo::table::{Command, Pallet};

/// Answer to MERP (the point where the error occurred): no point (ambiguity C5).
const NO_POINT: &str = "         ";
/// Number of ports that one screen shows.
const SCREEN: i32 = 4;
/// The last screen that shows input ports of the controller itself (ambiguity C8).
const LAST_INPUT_SCREEN: i32 = 6;

pub(super) fn answer(world: &World, request: &Request) -> Result<Reply, String> {
    let fields = Fields(request.record());
    let mut form = 0;
    let values = match request.command() {
        Command::Sysp => system(world),
        Command::Stas => {
            let page = fields.number("page");
            vec![Value::Number(page), Value::Byte(world.status(page)), Value::Byte(0)]
        }
        Command::Cver => vec![Value::Number(fields.number("station")), Value::Number(world.version)],
        Command::Rpar => vec![Value::Text(parameter(world, request)?.written())],
        Command::Resy => {
            let program = fields.number("program");
            let easy = world.memory.content.easy(index(program));
            [program, 0, easy.start, easy.times, easy.end].map(Value::Number).to_vec()
        }
        Command::Rstx => step(world, fields.index("step"))?,
        Command::Rplt => {
            let record = Pallet::numbered(fields.number("record")).ok_or("no such record")?;
            let content = world.memory.content.pallet(fields.index("program"), record);
            let content = content.ok_or("no such program")?;
            vec![
                Value::Number(fields.number("program")),
                Value::Number(record.number.into()),
                Value::Text(content.written()),
            ]
        }
        Command::Rpld => palletizing(world)?,
        Command::Rovr => vec![Value::Number(world.memory.content.percent)],
        Command::Resd => easy(world),
        Command::Minp => {
            let (kind, values) = inputs(world, fields.number("station"), fields.number("screen"))?;
            form = kind;
            values
        }
        Command::Mout => {
            let (kind, values) = outputs(world, fields.number("station"), fields.number("screen"))?;
            form = kind;
            values
        }
        Command::Mnin => {
            let ports = (1..).zip(&world.ports.internal).take(4);
            let ports = ports.flat_map(|(port, bits)| [Value::Number(port), Value::Bits(*bits)]);
            [0, 1].map(Value::Number).into_iter().chain(ports).collect()
        }
        Command::Mpst => world.arm.position(world.now).map(hundredths).to_vec(),
        Command::Moff => world.offset().map(hundredths).to_vec(),
        Command::Mcnt => {
            let counter = fields.number("counter");
            vec![Value::Number(counter), Value::Number(world.counters[index(counter)].into())]
        }
        Command::Mtmr => {
            let timer = fields.number("timer");
            vec![Value::Number(timer), Value::Number(i32::try_from(world.timer(index(timer))).unwrap_or_default())]
        }
        Command::Merp => vec![Value::Text(NO_POINT.to_owned())],
        Command::Mtsk => vec![Value::Number(number(world.current + 1))],
        Command::Mbus => {
            form = usize::from(request.text().ends_with("C2"));
            bus(world, form)
        }
        Command::Ehtr => history(world, fields.number("number")),
        other => return Err(format!("{other:?} does not read data")),
    };
    Ok(Reply::Data(form, values))
}

fn system(world: &World) -> Vec<Value> {
    let letters = world.memory.content.single("E01").values();
    let language = Value::Word(if world.settings.japanese { "J" } else { "E" });
    let mut values = vec![Value::Number(world.memory.content.robot_types[0]), Value::Number(world.version), language];
    values.extend_from_slice(letters);
    // The manual does not explain this last value (ambiguity C11).
    values.push(Value::Text("N".to_owned()));
    values
}

fn parameter(world: &World, request: &Request) -> Result<Record, String> {
    let parameter = request.parameter().ok_or("no such parameter")?;
    if !world.supports(parameter.only_on) {
        return Err(format!("a {} does not have {}", world.model, parameter.id));
    }
    let key = request.content().map_err(|error| error.to_string())?.ok_or("the request contains no parameter")?;
    world.memory.parameter(parameter, &key, world.current).ok_or_else(|| "no such row".to_owned())
}

/// Values of a step of the current task. Step 0 is the current step.
fn step(world: &World, step: usize) -> Result<Vec<Value>, String> {
    let step = if step == 0 { world.tasks[world.current].step } else { step };
    let record = world.memory.step(world.current, step);
    let record = record.ok_or_else(|| format!("task {} has no step {step}", world.current + 1))?;
    Ok(vec![Value::Number(number(step)), Value::Text(record.written())])
}

fn palletizing(world: &World) -> Result<Vec<Value>, String> {
    let task = &world.tasks[0];
    let fresh;
    let (run, executed, done) = if let Some(Routine::Palletizing(run)) = &task.routine {
        let executed = if task.called { number(task.step) } else { 0 };
        (run.as_ref(), executed, run.side().piece.map(i32::from))
    } else {
        fresh = world.palletizing(world.pallet).ok_or("no such program")?;
        (&fresh, 0, [0; 3])
    };
    let mut values = vec![Value::Word(run.mode), Value::Word(run.state()), Value::Number(number(run.program))];
    for (done, pieces) in done.into_iter().zip(run.side().pieces()) {
        values.extend([Value::Number(done), Value::Number(pieces.into())]);
    }
    values.extend([Value::Number(run.hand), Value::Number(executed)]);
    Ok(values)
}

fn easy(world: &World) -> Vec<Value> {
    let task = &world.tasks[0];
    let (program, round, tag) = match &task.routine {
        Some(Routine::Easy { program, round, part }) => {
            (*program, *round, part.tag(world.memory.content.easy(*program)))
        }
        _ => (world.easy, 0, 0),
    };
    let (step, tag) = if task.called { (number(task.step), tag) } else { (0, 0) };
    [number(program), 0, step, tag, round].map(Value::Number).to_vec()
}

fn inputs(world: &World, station: i32, screen: i32) -> Result<(usize, Vec<Value>), String> {
    let ports = |ports: std::ops::Range<i32>| {
        ports.flat_map(|port| pair(port, world.ports.input(at(station, port)))).collect::<Vec<_>>()
    };
    let head = [station, screen].map(Value::Number).to_vec();
    match (station, screen) {
        (0, 1) => Ok((0, [head, vec![Value::Bits(world.ports.system)], ports(1..4)].concat())),
        (0, 2..=LAST_INPUT_SCREEN) => {
            let first = SCREEN * (screen - 1);
            Ok((1, [head, ports(first..first + SCREEN)].concat()))
        }
        (1.., 1) => Ok((2, [vec![Value::Number(station)], ports(1..4)].concat())),
        _ => Err("no such screen".to_owned()),
    }
}

fn outputs(world: &World, station: i32, screen: i32) -> Result<(usize, Vec<Value>), String> {
    let ports = |ports: std::ops::Range<i32>| {
        ports.flat_map(|port| pair(port, world.ports.output(at(station, port)))).collect::<Vec<_>>()
    };
    let head = [station, screen].map(Value::Number).to_vec();
    match (station, screen) {
        (0, 1) => Ok((0, [head, vec![Value::Bits(world.system_outputs())], ports(1..4)].concat())),
        (0, 2..=4) => {
            let first = SCREEN * (screen - 1);
            Ok((1, [head, ports(first..first + SCREEN)].concat()))
        }
        (0, 5) => Ok((2, [head, ports(16..19)].concat())),
        (1.., 1) => Ok((3, [vec![Value::Number(station)], ports(1..3)].concat())),
        _ => Err("no such screen".to_owned()),
    }
}

fn at(station: i32, port: i32) -> Port {
    Port { station: index(station), port: index(port) }
}

fn pair(port: i32, bits: Option<u8>) -> [Value; 2] {
    [Value::Number(port), Value::Bits(bits.unwrap_or_default())]
}

fn bus(world: &World, page: usize) -> Vec<Value> {
    if page == 1 {
        return vec![Value::Byte(0); 5];
    }
    let bus = world.memory.content.single("M17").values();
    vec![bus[0].clone(), bus[1].clone(), Value::Number(1)]
}

fn history(world: &World, entry: i32) -> Vec<Value> {
    let mut values = vec![Value::Number(entry)];
    values.extend(match world.errors.entry(index(entry)) {
        Some(Entry::PowerCut) => vec![Value::Stars; 5],
        Some(Entry::Error { code, at }) => {
            let seconds = at.as_secs();
            let part = |part: u64| Value::Number(i32::try_from(part).unwrap_or_default());
            vec![
                Value::Byte(code),
                Value::Byte(0),
                part((seconds / 3600).min(999)),
                part(seconds / 60 % 60),
                part(seconds % 60),
            ]
        }
        None => vec![Value::Byte(0), Value::Byte(0), Value::Number(0), Value::Number(0), Value::Number(0)],
    });
    values
}

/// Converts a coordinate in mm to the protocol value in 0.01 mm.
fn hundredths(coordinate: f64) -> Value {
    #[expect(clippy::cast_possible_truncation, reason = "coordinates must be within 8000 mm")]
    let hundredths = (coordinate * 100.0).round() as i32;
    Value::Number(hundredths)
}

fn number(index: usize) -> i32 {
    i32::try_from(index).unwrap_or_default()
}

//! Commands that store data, compute, or read data back (4.3, 4.4, 4.5).

use super::alarms::{AlarmSource, Fault, NO_HAND, PAYLOAD};
use super::commands::not_here;
use super::memory::{Hand, Number, Operation, Pallet, Point, PointUnit};
use super::motion_commands::axis;
use super::request::Request;
use super::world::World;
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Value, Values};

/// Numbers of the robot parameters, and of the payload of an axis (4.4.2).
const WEIGHT: i32 = 1;
const WEIGHT_G: i32 = 2;
const AXIS_WEIGHT: i32 = 262;
const GRAMS: i32 = 1000;

/// Executes a command and returns its answer.
pub(super) fn carry_out(world: &mut World, request: &Request) -> Result<Values, Fault> {
    let command = request.row.command;
    match request.row.section {
        "4.3.1" | "4.3.2" => point(world, request),
        "4.3.3" | "4.3.4" | "4.3.5" => frame(world, request),
        "4.4.1" => variable(world, request),
        "4.4.2" if command == Command::ParamGet => read_parameter(world, request),
        "4.4.2" => set_parameter(world, request).map(nothing),
        "4.4.3" | "4.4.4" => compute(world, request).map(nothing),
        "4.5.1" => Ok(port(world, request)),
        _ => Err(not_here(request)),
    }
}

fn nothing((): ()) -> Values {
    Values::default()
}

fn point(world: &mut World, request: &Request) -> Result<Values, Fault> {
    let number = request.index(Key::Point);
    let mut values = Values::default();
    match request.row.command {
        Command::PointSet => {
            let unit = PointUnit::from_code(request.int(Key::Unit));
            let point = Point { unit, hand_system: request.int(Key::HandSystem), values: request.axes() };
            world.memory.set_point(number, point);
        }
        Command::PointGet => {
            let point = world.memory.point(number)?;
            values = axes(point.values);
            values.set(Key::Unit, point.unit.code());
            values.set(Key::HandSystem, point.hand_system);
        }
        Command::CommentSet | Command::CommentGet => {
            let key = u16::try_from(number).unwrap_or_default();
            if request.row.command == Command::CommentSet {
                world.memory.comments.insert(key, request.text(Key::Comment).to_owned());
            } else {
                values.set(Key::Comment, world.memory.comments.get(&key).cloned().unwrap_or_default());
            }
        }
        _ => return Err(not_here(request)),
    }
    Ok(values)
}

fn frame(world: &mut World, request: &Request) -> Result<Values, Fault> {
    let memory = &mut world.memory;
    let (pallet, shift, hand) = (request.index(Key::Pallet), request.index(Key::Shift), request.index(Key::Hand));
    let mut values = Values::default();
    match request.row.command {
        Command::PalletSet => {
            let counts = [Key::CountX, Key::CountY, Key::CountZ].map(|key| request.int(key));
            let first = u16::try_from(request.int(Key::FirstPoint)).unwrap_or_default();
            memory.pallets[pallet] = Some(Pallet { counts, first });
        }
        Command::PalletGet => {
            let Pallet { counts, first } = memory.pallet(pallet)?;
            values = [Key::CountX, Key::CountY, Key::CountZ].into_iter().zip(counts).collect();
            values.set(Key::FirstPoint, first);
        }
        Command::ShiftSet => memory.shifts[shift] = request.axes(),
        Command::ShiftGet => values = axes(memory.shifts[shift]),
        Command::HandSet => {
            let owner = request.robot();
            let data = [Key::Data1, Key::Data2, Key::Data3, Key::Data4].map(|key| request.int(key));
            world.robot(owner)?;
            world.memory.hands[hand] = Some(Hand { owner, data });
        }
        Command::HandGet => {
            let none = || Fault::new(NO_HAND, AlarmSource::Controller, format!("hand {hand} is not defined"));
            let Hand { owner, data } = memory.hands[hand].ok_or_else(none)?;
            values = [Key::Data1, Key::Data2, Key::Data3, Key::Data4].into_iter().zip(data).collect();
            values.set(Key::Owner, i32::try_from(owner + 1).unwrap_or_default());
        }
        _ => return Err(not_here(request)),
    }
    Ok(values)
}

fn variable(world: &mut World, request: &Request) -> Result<Values, Fault> {
    let number = request.index(Key::Variable);
    let operation = match request.row.command {
        Command::VarSet | Command::VarSetVar => Operation::Assign,
        Command::VarAdd | Command::VarAddVar => Operation::Add,
        Command::VarSub | Command::VarSubVar => Operation::Subtract,
        Command::VarMul | Command::VarMulVar => Operation::Multiply,
        Command::VarDiv | Command::VarDivVar => Operation::Divide,
        Command::VarGet => {
            let value = match world.memory.variable(number) {
                Number::Whole(value) => Value::from(value),
                Number::Real(value) => Value::from(value),
            };
            return Ok([(Key::Value, value)].into_iter().collect());
        }
        _ => return Err(not_here(request)),
    };
    let operand = match request.value() {
        Some(Value::Int(value)) => Number::Whole(*value),
        Some(Value::Real(value)) => Number::Real(*value),
        _ => world.memory.variable(request.index(Key::Variable2)),
    };
    world.memory.compute(number, operation, operand)?;
    Ok(Values::default())
}

fn set_parameter(world: &mut World, request: &Request) -> Result<(), Fault> {
    let (number, parameter, value) = (request.robot(), request.int(Key::Parameter), request.int(Key::Value));
    let most = world.robot(number)?.max_payload_g;
    let grams = if parameter == WEIGHT_G { value } else { value.saturating_mul(GRAMS) };
    if matches!(parameter, WEIGHT | WEIGHT_G | AXIS_WEIGHT) && grams > most {
        let why = format!("robot {} can carry at most {most} g", number + 1);
        return Err(Fault::new(PAYLOAD, AlarmSource::Robot(number), why));
    }
    if request.int(Key::Axes) == 0 {
        world.robot_mut(number)?.payload_g = grams;
        return Ok(());
    }
    world.has_axes(number, 1 << axis(request))?;
    let parameter = u16::try_from(parameter).unwrap_or_default();
    world.robot_mut(number)?.axes[axis(request)].parameters.insert(parameter, value);
    Ok(())
}

fn read_parameter(world: &World, request: &Request) -> Result<Values, Fault> {
    let (number, parameter) = (request.robot(), request.int(Key::Parameter));
    let robot = world.robot(number)?;
    let value = match parameter {
        WEIGHT => robot.payload_g / GRAMS,
        WEIGHT_G => robot.payload_g,
        _ => {
            world.has_axes(number, 1 << axis(request))?;
            robot.axes[axis(request)].parameter(u16::try_from(parameter).unwrap_or_default())
        }
    };
    Ok([(Key::Value, value)].into_iter().collect())
}

fn compute(world: &mut World, request: &Request) -> Result<(), Fault> {
    let memory = &mut world.memory;
    let (number, value) = (request.index(Key::Point), request.int(Key::Value));
    let element = usize::try_from(request.int(Key::Element).trailing_zeros()).unwrap_or_default();
    match request.row.command {
        Command::PointCopy => {
            let point = memory.point(request.index(Key::Point2))?;
            memory.set_point(number, point);
        }
        Command::PointAdd => memory.combine_points(number, request.index(Key::Point2), 1)?,
        Command::PointSub => memory.combine_points(number, request.index(Key::Point2), -1)?,
        Command::PointPallet => {
            let point = memory.pallet_point(request.index(Key::Pallet), request.int(Key::WorkPosition))?;
            memory.set_point(number, point);
        }
        Command::PointElementPulse => memory.set_element(number, PointUnit::Pulse, element, value)?,
        Command::PointElementMm => memory.set_element(number, PointUnit::Mm, element, value)?,
        Command::ShiftElement => memory.shifts[request.index(Key::Shift)][element] = value,
        _ => return Err(not_here(request)),
    }
    Ok(())
}

fn port(world: &mut World, request: &Request) -> Values {
    let (kind, port) = (request.index(Key::PortType), request.index(Key::Port));
    let value = u8::try_from(request.int(Key::Value)).unwrap_or_default();
    match request.row.command {
        Command::PortSet => world.memory.set_port(kind, port, value),
        Command::PortSetBit => {
            let bit = u8::try_from(request.int(Key::PortBit)).unwrap_or_default();
            world.memory.set_bit(kind, port, bit, value == 1);
        }
        _ => return [(Key::Value, i32::from(world.memory.port(kind, port)))].into_iter().collect(),
    }
    // A program may wait for this port, so one more scan is needed.
    world.restless = true;
    Values::default()
}

fn axes(values: [i32; 4]) -> Values {
    Key::AXES.into_iter().zip(values).collect()
}

//! Commands that switch or select something (4.2, 4.6, 4.8).

use std::time::Duration;

use jiff::civil::{Date, Time};

use super::alarms::{AlarmSource, Fault, NO_ABSOLUTE_RESET, NO_HAND, NO_PROGRAM, NO_TASK};
use super::commands::{CommandProgress, not_here};
use super::geometry::{Arm, STEPS, whole};
use super::memory::{Point, PointUnit};
use super::motion_commands::axis;
use super::request::Request;
use super::robot::{Method, RESET_PITCH, Servo};
use super::task::{State, TASKS, Task};
use super::world::{Action, World};
use crate::refuse_if;
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Values};

/// Switching time of the servos. The constant below is the switching time of motor power.
const SERVO_TIME: Duration = Duration::from_millis(50);
pub(super) const MOTOR_TIME: Duration = Duration::from_millis(200);
/// Century that is added to two-digit years.
const CENTURY: i16 = 2000;

/// Starts to switch motor power or servos (4.2.13, 4.2.20).
pub(super) fn power(world: &mut World, request: &Request) -> Result<CommandProgress, Fault> {
    let robot = request.robot();
    let axes = u8::try_from(request.int(Key::Axes)).unwrap_or_default();
    let servo = |state| Action::Servo(robot, axes, state);
    let (action, time) = match request.row.command {
        Command::MotorOff => (Action::MotorOff, SERVO_TIME),
        Command::MotorOn => (Action::MotorOn, MOTOR_TIME),
        Command::MotorPower => (Action::MotorPower, MOTOR_TIME),
        Command::ServoOn => (servo(Servo::On), SERVO_TIME),
        Command::ServoOff => (servo(Servo::Brake), SERVO_TIME),
        Command::ServoFree => (servo(Servo::Free), SERVO_TIME),
        _ => return Err(not_here(request)),
    };
    match action {
        Action::Servo(..) => world.has_axes(robot, axes)?,
        Action::MotorOff => {}
        _ => world.may_power()?,
    }
    Ok(CommandProgress::Power(world.now.saturating_add(time), action))
}

/// Executes a command that selects or stores something (4.2.8 to 4.2.22).
pub(super) fn change(world: &mut World, request: &Request) -> Result<(), Fault> {
    let number = request.robot();
    let percent = request.int(Key::SpeedPercent);
    match request.row.command {
        // WI0 itself resets the status, so the command has no further effect.
        Command::StatusReset => {}
        Command::Teach => return teach(world, request),
        Command::AbsoluteReset => return absolute_reset(world, request),
        Command::InchAmountSet => world.robot_mut(number)?.inching = request.int(Key::InchingAmount),
        Command::SpeedManual => world.robot_mut(number)?.manual_speed = percent,
        Command::SpeedAuto => world.robot_mut(number)?.auto_speed = percent,
        Command::SpeedProgram => world.robot_mut(number)?.program_speed = percent,
        Command::ShiftSelect => world.robot_mut(number)?.shift = request.index(Key::Shift),
        Command::ArmSelect => world.robot_mut(number)?.arm = Arm::from_code(request.int(Key::Arm)),
        Command::HandSelect => {
            let hand = request.index(Key::Hand);
            let owner = world.memory.hands.get(hand).copied().flatten().map(|hand| hand.owner);
            if owner != Some(number) {
                let why = format!("hand {hand} is not defined for robot {}", number + 1);
                return Err(Fault::new(NO_HAND, AlarmSource::Robot(number), why));
            }
            world.robot_mut(number)?.hand = Some(hand);
        }
        Command::TorqueLimit => {
            world.has_axes(number, 1 << axis(request))?;
            world.robot_mut(number)?.axes[axis(request)].torque_limit = request.int(Key::Torque);
        }
        _ => return Err(not_here(request)),
    }
    Ok(())
}

/// Teach: stores the current position (4.2.9).
fn teach(world: &mut World, request: &Request) -> Result<(), Fault> {
    let number = request.robot();
    let (robot, unit) = (world.robot(number)?, PointUnit::from_code(request.int(Key::Unit)));
    let arm = world.geometry(number)?.arm(&robot.pulses());
    let point = match unit {
        PointUnit::Pulse => Point { unit, hand_system: 0, values: robot.pulses().map(whole) },
        PointUnit::Mm => Point {
            unit,
            hand_system: arm.map_or(0, Arm::hand_system),
            values: world.pose(number)?.map(|place| whole(place * STEPS)),
        },
    };
    world.memory.set_point(request.index(Key::Point), point);
    Ok(())
}

/// Absolute reset: the current position becomes the origin of an axis. The axis must be of the mark type (4.2.11).
fn absolute_reset(world: &mut World, request: &Request) -> Result<(), Fault> {
    let (number, at) = (request.robot(), axis(request));
    world.has_axes(number, 1 << at)?;
    let axis = &mut world.robot_mut(number)?.axes[at];
    refuse_if(axis.method != Method::Mark, no_mark(number, at))?;
    let turns = axis.pulses / RESET_PITCH;
    if (turns - turns.round()).abs() * RESET_PITCH > 1.0 {
        let why = format!("axis {} is not at a position for an absolute reset", at + 1);
        return Err(Fault::new(NO_ABSOLUTE_RESET, AlarmSource::Axis(number, at), why));
    }
    axis.origin = true;
    Ok(())
}

/// Fault for an axis that is not of the mark type and so cannot be reset absolutely.
pub(super) fn no_mark(number: usize, at: usize) -> Fault {
    let why = format!("axis {} is not of the mark type", at + 1);
    Fault::new(NO_ABSOLUTE_RESET, AlarmSource::Axis(number, at), why)
}

/// Program commands (4.6).
pub(super) fn program(world: &mut World, request: &Request) -> Result<Values, Fault> {
    match (request.row.command, chosen(world, request)?) {
        (Command::ProgramSelect, SelectedObject::Program(program)) => register(world, request, program)?,
        (Command::ProgramRun, SelectedObject::All) => world.start_all()?,
        (Command::ProgramReset, SelectedObject::All) => world.reset_programs()?,
        (command, chosen) => {
            let task = chosen.task(world)?;
            match command {
                Command::ProgramRun => world.start_task(task)?,
                Command::ProgramStep => world.step_task(task, false)?,
                Command::ProgramNext => world.step_task(task, true)?,
                Command::ProgramSkip => world.skip_line(task)?,
                Command::ProgramReset => world.reset_task(task)?,
                Command::ProgramShow => return show(world, task),
                _ => return Err(not_here(request)),
            }
        }
    }
    Ok(Values::default())
}

/// What a command of category 5 (programs) applies to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SelectedObject {
    All,
    Program(u8),
    Task(u8),
}

impl SelectedObject {
    /// Index of the task in which the program is registered.
    fn task(self, world: &World) -> Result<usize, Fault> {
        let at = world.tasks.iter().position(|task| match self {
            Self::All => false,
            Self::Program(program) => task.program == program,
            Self::Task(number) => task.number == number,
        });
        at.ok_or_else(|| Fault::new(NO_TASK, AlarmSource::Controller, "the program is not registered in a task"))
    }
}

fn chosen(world: &World, request: &Request) -> Result<SelectedObject, Fault> {
    let name = request.text(Key::ProgramName);
    let found = match request.int(Key::Selection) {
        0 => return Ok(SelectedObject::All),
        2 => return Ok(SelectedObject::Task(u8::try_from(request.int(Key::Task)).unwrap_or_default())),
        1 => u8::try_from(request.int(Key::Program)).ok().filter(|number| world.programs.contains_key(number)),
        // A command contains only the first 16 characters of a name. If several programs begin with these 16
        // characters, the program with the lowest number is selected.
        _ => world.programs.iter().find(|(_, program)| program.short_name() == name).map(|(number, _)| *number),
    };
    let none = || Fault::new(NO_PROGRAM, AlarmSource::Controller, "no such program");
    found.map(SelectedObject::Program).ok_or_else(none)
}

/// Registers a program in a task. Task 0 means the vacant task with the lowest number (4.6.1).
fn register(world: &mut World, request: &Request, program: u8) -> Result<(), Fault> {
    let priority = u8::try_from(request.int(Key::Priority)).unwrap_or_default();
    let taken = |number: u8| world.tasks.iter().find(|task| task.number == number);
    let number = match u8::try_from(request.int(Key::Task)).unwrap_or_default() {
        0 => (1..=TASKS).find(|number| taken(*number).is_none()),
        number => Some(number),
    };
    let full = || Fault::new(NO_TASK, AlarmSource::Controller, "every task has a program");
    let number = number.ok_or_else(full)?;
    if world.tasks.iter().any(|task| (task.number == number || task.program == program) && task.state == State::Running)
    {
        return Err(Fault::new(super::alarms::RUNNING, AlarmSource::Task(number), "the task or the program runs"));
    }
    // A program can be registered in only one task, so its number identifies the task. Earlier registrations are
    // removed.
    world.tasks.retain(|task| task.number != number && task.program != program);
    world.tasks.push(Task::new(number, program, priority));
    Ok(())
}

/// State of a stopped program (4.6.4).
fn show(world: &World, at: usize) -> Result<Values, Fault> {
    let none = || Fault::new(NO_TASK, AlarmSource::Controller, "the program is not registered in a task");
    let task = world.tasks.get(at).ok_or_else(none)?;
    if task.state == State::Running {
        return Err(Fault::new(super::alarms::RUNNING, AlarmSource::Task(task.number), "the program runs"));
    }
    let name = world.programs.get(&task.program).map_or("", |program| program.short_name());
    let mut values = Values::default();
    values.set(Key::Program, i32::from(task.program));
    values.set(Key::Task, i32::from(task.number));
    values.set(Key::Line, world.line_of(task));
    values.set(Key::Priority, i32::from(task.priority));
    values.set(Key::ProgramName, name);
    Ok(values)
}

/// Clock and alarm reset (4.8).
pub(super) fn utility(world: &mut World, request: &Request) -> Result<(), Fault> {
    let small = |key| i8::try_from(request.int(key)).unwrap_or_default();
    let (date, time) = (world.time().date(), world.time().time());
    let set = match request.row.command {
        Command::AlarmReset => return world.act(Action::AlarmReset),
        Command::DateSet => Date::new(CENTURY + i16::from(small(Key::Year)), small(Key::Month), small(Key::Day))
            .map(|date| date.to_datetime(time)),
        Command::TimeSet => {
            Time::new(small(Key::Hour), small(Key::Minute), small(Key::Second), 0).map(|time| date.to_datetime(time))
        }
        _ => return Err(not_here(request)),
    };
    world.clock = (set.map_err(|error| Fault::of_words(error.to_string()))?, world.now);
    Ok(())
}

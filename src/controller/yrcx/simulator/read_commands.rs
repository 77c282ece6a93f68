//! Commands that read data (4.7). For a robot that does not exist, the answer has no axes.

use super::alarms::{AlarmSource, Entry, Fault, NO_CONTROLLER};
use super::commands::not_here;
use super::geometry::{Arm, STEPS, whole};
use super::moves::Homing;
use super::request::Request;
use super::robot::{AXES, Axis, MAX_OF_RATED, Robot};
use super::task::TASKS;
use super::world::World;
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Values};

/// Value that an answer contains for a missing axis or task.
const NONE: i32 = 9;
/// Keys of the axis states: four axes and two reserved axes.
const SIX: [Key; 6] = [Key::Axis1, Key::Axis2, Key::Axis3, Key::Axis4, Key::Axis5, Key::Axis6];
const EIGHT: [Key; 8] =
    [Key::Task1, Key::Task2, Key::Task3, Key::Task4, Key::Task5, Key::Task6, Key::Task7, Key::Task8];

pub(super) fn answer(world: &World, request: &Request) -> Result<Values, Fault> {
    let number = request.robot();
    let robot = world.robots.get(number);
    let of_robot = |value: fn(&Robot) -> i32| robot.map_or(0, value);
    Ok(match request.row.command {
        Command::Versions => {
            let keys = [
                Key::HostVersion,
                Key::HostRevision,
                Key::FpgaVersion,
                Key::DriverVersion1,
                Key::DriverVersion2,
                Key::DriverVersion3,
                Key::DriverVersion4,
            ];
            keys.into_iter().zip(world.versions).collect()
        }
        Command::System => {
            let mut values = per_axis(robot, 0, |_, axis| i32::from(axis.model));
            values.set(Key::RobotType, of_robot(|robot| robot.model.into()));
            values
        }
        Command::ServoStatus => per_axis(robot, NONE, |_, axis| axis.servo.code()),
        Command::PositionPulse => axes(robot.map_or([0.0; 4], Robot::pulses).map(whole)),
        Command::PositionMm => {
            let mut values = axes(robot.map_or(Ok([0.0; 4]), |_| world.pose(number))?.map(|at| whole(at * STEPS)));
            values.set(Key::HandSystem, current_arm(world, number).map_or(0, Arm::hand_system));
            values
        }
        Command::TaskStatus => per_task(world, request, NONE, super::task::Task::status),
        Command::TaskLines => per_task(world, request, 0, |task| world.line_of(task)),
        Command::AlarmHistory => alarm(world.alarms.entry(request.index(Key::History))),
        Command::LatestAlarm => alarm(world.alarms.latest_remote),
        Command::SpeedStatus => [
            (Key::AutoSpeed, of_robot(|robot| robot.auto_speed)),
            (Key::ManualSpeed, of_robot(|robot| robot.manual_speed)),
            (Key::ProgramSpeed, of_robot(|robot| robot.program_speed)),
        ]
        .into_iter()
        .collect(),
        Command::ArmDesignation => [(Key::Arm, of_robot(|robot| robot.arm.code()))].into_iter().collect(),
        Command::ArmStatus => [(Key::Arm, current_arm(world, number).map_or(0, Arm::code))].into_iter().collect(),
        Command::OriginStatus if request.int(Key::Robot) == 0 => {
            [(Key::System, i32::from(world.robots.iter().all(Robot::is_at_home)))].into_iter().collect()
        }
        Command::OriginStatus => {
            let wanted = match request.int(Key::MotorType) {
                1 => Homing::Incremental,
                2 => Homing::Absolute,
                _ => Homing::All,
            };
            per_axis(robot, NONE, |at, axis| if wanted.includes(at, axis) { i32::from(axis.origin) } else { NONE })
        }
        Command::TorqueOfMax => torque(robot, request, 1),
        Command::TorqueOfRated => torque(robot, request, MAX_OF_RATED),
        Command::DateGet => {
            let date = world.time().date();
            let year = i32::from(date.year()).rem_euclid(100);
            [(Key::Year, year), (Key::Month, date.month().into()), (Key::Day, date.day().into())].into_iter().collect()
        }
        Command::TimeGet => {
            let time = world.time();
            [(Key::Hour, time.hour()), (Key::Minute, time.minute()), (Key::Second, time.second())]
                .into_iter()
                .map(|(key, number)| (key, i32::from(number)))
                .collect()
        }
        Command::Slots => {
            let controller = u8::try_from(request.int(Key::Controller)).unwrap_or_default();
            let none = || Fault::new(NO_CONTROLLER, AlarmSource::Controller, format!("no controller {controller}"));
            let slots = world.slots.get(&controller).ok_or_else(none)?;
            [Key::Slot1, Key::Slot2, Key::Slot3, Key::Slot4].into_iter().zip(*slots).collect()
        }
        Command::InchAmountGet => [(Key::InchingAmount, of_robot(|robot| robot.inching))].into_iter().collect(),
        _ => return Err(not_here(request)),
    })
}

/// Current arm side. `None` for a Cartesian robot; the answer then is right (4.7.10).
fn current_arm(world: &World, number: usize) -> Option<Arm> {
    let robot = world.robots.get(number)?;
    world.geometry(number).ok()?.arm(&robot.pulses())
}

/// State of each axis. For the two reserved axes, the state is `none`.
fn per_axis(robot: Option<&Robot>, none: i32, state: impl Fn(usize, &Axis) -> i32) -> Values {
    let axis = |at: usize| robot.and_then(|robot| robot.axes.get(at)).map_or(none, |axis| state(at, axis));
    SIX.into_iter().enumerate().map(|(at, key)| (key, axis(at))).collect()
}

fn torque(robot: Option<&Robot>, request: &Request, factor: i32) -> Values {
    let wanted = request.int(Key::Axes);
    let axis = |at: usize| {
        let is_wanted = wanted == 0 || wanted >> at & 1 == 1;
        robot.filter(|_| is_wanted).map_or(0, |robot| robot.torque(at) * factor)
    };
    axes(std::array::from_fn(axis))
}

fn per_task(world: &World, request: &Request, none: i32, state: impl Fn(&super::task::Task) -> i32) -> Values {
    let first = if request.int(Key::TaskRange) == 1 { TASKS / 2 } else { 0 };
    EIGHT
        .into_iter()
        .zip(first + 1..)
        .map(|(key, number)| {
            let task = world.tasks.iter().find(|task| task.number == number);
            (key, task.map_or(none, &state))
        })
        .collect()
}

/// An alarm with its source. Without an alarm, all values are 0.
fn alarm(entry: Option<Entry>) -> Values {
    let (group, category, [first, second]) =
        entry.map_or((0, 0, [0, 0]), |(alarm, place)| (alarm.group, alarm.category, place.words()));
    [
        (Key::AlarmGroup, group),
        (Key::AlarmCategory, category),
        (Key::Place1, first >> 8),
        (Key::Place1Number, first & 0xFF),
        (Key::Place2, second >> 8),
        (Key::Place2Number, second & 0xFF),
    ]
    .into_iter()
    .collect()
}

fn axes(values: [i32; AXES]) -> Values {
    Key::AXES.into_iter().zip(values).collect()
}

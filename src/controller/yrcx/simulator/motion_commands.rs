//! Motion commands (4.2).

use super::alarms::Fault;
use super::commands::{CommandProgress, not_here};
use super::geometry::{Arm, FourValues, Kind, STEPS};
use super::memory::PointUnit;
use super::motion::{End, Leg, Owner};
use super::moves::{Frame, Homing, Rate, Speed};
use super::request::Request;
use super::robot::{ALL, Method, RESET_PITCH, ResumableMotion};
use super::world::World;
use crate::refuse_if;
use crate::yrcx::table::Command;
use crate::yrcx::value::{Key, Values};

/// Numbers of the parameters for a push (4.4.2).
const PUSH_FORCE: u16 = 266;
const PUSH_TIME: u16 = 267;
const PUSH_SPEED: u16 = 270;

pub(super) fn begin(world: &mut World, request: &Request) -> Result<CommandProgress, Fault> {
    let robot = request.robot();
    match request.row.command {
        Command::OriginRobot | Command::OriginAxis => return origin(world, request),
        Command::PushPoint | Command::PushMm | Command::PushPulse => push(world, request)?,
        Command::JogPulse | Command::JogCartesian | Command::JogTool => {
            ready(world, request)?;
            let (leg, end) = world.jog(robot, frame(request), axis(request), sign(request))?;
            world.begin(robot, Owner::Remote, vec![leg], end)?;
        }
        Command::InchPulse | Command::InchCartesian | Command::InchTool => {
            ready(world, request)?;
            let amount = f64::from(world.robot(robot)?.inching) * sign(request);
            let leg = world.inch(robot, frame(request), axis(request), amount)?;
            world.begin(robot, Owner::Remote, vec![leg], End::Arrived)?;
        }
        Command::AbsoluteResetMove => {
            ready(world, request)?;
            let leg = to_reset_position(world, request)?;
            world.begin(robot, Owner::Remote, vec![leg], End::Arrived)?;
        }
        _ => travel(world, request)?,
    }
    Ok(CommandProgress::Motion(vec![robot]))
}

/// Final position in the unit of the command.
pub(super) fn positions(world: &World, request: &Request) -> Result<Values, Fault> {
    let robot = request.robot();
    let places = match request.int(Key::Report) {
        1 => world.robot(robot)?.pulses(),
        2 => world.pose(robot)?.map(|place| place * STEPS),
        _ => return Ok(Values::default()),
    };
    Ok(Key::AXES.into_iter().zip(places.map(super::geometry::whole)).collect())
}

/// Checks that the robot can start this motion.
fn ready(world: &World, request: &Request) -> Result<(), Fault> {
    let robot = request.robot();
    let axes = match request.row.command {
        Command::JogPulse | Command::InchPulse | Command::AbsoluteResetMove => {
            return world.may_move(robot, mask(request));
        }
        Command::DrivePoint
        | Command::DriveMm
        | Command::DrivePulse
        | Command::DriveiPoint
        | Command::DriveiMm
        | Command::DriveiPulse
        | Command::PushPoint
        | Command::PushMm
        | Command::PushPulse => mask(request),
        // For other motions, all axes must be ready: axes without motion must hold their position, and a jog along a
        // coordinate may move all axes.
        _ => {
            let named = request.maybe(Key::Axes).and_then(|axes| u8::try_from(axes).ok()).unwrap_or_default();
            world.has_axes(robot, named)?;
            world.robot(robot)?.mask()
        }
    };
    world.may_move(robot, axes)?;
    world.at_home(robot)
}

/// Executes a motion to a target.
fn travel(world: &mut World, request: &Request) -> Result<(), Fault> {
    ready(world, request)?;
    let robot = request.robot();
    let kept = world.robot(robot)?.kept.clone().filter(|kept| kept.words == request.words && world.switches.keep);
    let target = match kept {
        Some(kept) => kept.target,
        None => target(world, request)?,
    };
    let legs = legs(world, request, &target)?;
    world.begin(robot, Owner::Remote, legs, End::Arrived)?;
    if request.row.keeps_target() {
        world.robot_mut(robot)?.kept = Some(ResumableMotion { words: request.words, target });
    }
    Ok(())
}

/// Target in pulses.
fn target(world: &World, request: &Request) -> Result<FourValues, Fault> {
    let (robot, axes) = (request.robot(), mask(request));
    let point = || world.memory.point(request.index(Key::Point));
    let numbers = || request.axes().map(f64::from);
    let mm = || numbers().map(|step| step / STEPS);
    match request.row.command {
        Command::MovePtp | Command::MoveArch | Command::MoveLinear => world.point_target(robot, axes, &point()?),
        Command::MoveCircular => world.point_target(robot, axes, &world.memory.point(request.index(Key::Point2))?),
        Command::MoveMm => {
            let arm = Arm::of_hand_system(request.int(Key::HandSystem));
            // On a SCARA, axes 1 and 2 always move to the target, even if the command names only other axes (4.2.1).
            let along = if matches!(world.robot(robot)?.kind, Kind::Scara { .. }) { 0b0011 } else { 0 };
            world.pose_target(robot, axes | along, &mm(), arm)
        }
        Command::MovePulse => world.pulse_target(robot, axes, &numbers()),
        Command::MoveiPtp | Command::MoveiLinear => world.relative_target(robot, axes, &point()?),
        Command::MoveiMm => world.relative_pose(robot, axes, &mm()),
        Command::MoveiPulse => world.relative_pulses(robot, axes, &numbers()),
        Command::DrivePoint | Command::PushPoint => {
            let point = point()?;
            let place = point.numbers()[axis(request)];
            match point.unit {
                PointUnit::Pulse => world.pulse_target(robot, axes, &[place; 4]),
                PointUnit::Mm => world.axis_target(robot, axis(request), place),
            }
        }
        Command::DriveMm | Command::PushMm => {
            world.axis_target(robot, axis(request), f64::from(request.int(Key::Target)) / STEPS)
        }
        Command::DrivePulse | Command::PushPulse => {
            world.pulse_target(robot, axes, &[f64::from(request.int(Key::Target)); 4])
        }
        Command::DriveiPoint => {
            let point = point()?;
            drive_by(world, request, point.numbers()[axis(request)], point.unit)
        }
        Command::DriveiMm => drive_by(world, request, f64::from(request.int(Key::Distance)) / STEPS, PointUnit::Mm),
        Command::DriveiPulse => drive_by(world, request, request.int(Key::Distance).into(), PointUnit::Pulse),
        Command::PalletPtp | Command::PalletArch => {
            let point = world.memory.pallet_point(request.index(Key::Pallet), request.int(Key::WorkPosition))?;
            world.point_target(robot, axes, &point)
        }
        Command::MovetPtp | Command::MovetLinear => world.tool_target(robot, axes, &World::tool_way(&point()?)?),
        _ => Err(not_here(request)),
    }
}

/// Target of a relative motion of one axis.
fn drive_by(world: &World, request: &Request, way: f64, unit: PointUnit) -> Result<FourValues, Fault> {
    let (robot, axis) = (request.robot(), axis(request));
    let per_unit = match unit {
        PointUnit::Pulse => 1.0,
        PointUnit::Mm => world.geometry(robot)?.per_unit[axis],
    };
    world.relative_pulses(robot, 1 << axis, &[way * per_unit; 4])
}

/// Path segments to the target.
fn legs(world: &World, request: &Request, target: &FourValues) -> Result<Vec<Leg>, Fault> {
    let (robot, speed) = (request.robot(), speed(request));
    match request.row.command {
        Command::MoveLinear | Command::MoveiLinear | Command::MovetLinear => {
            Ok(vec![world.line_leg(robot, target, speed)?])
        }
        Command::MoveCircular => {
            let [via, to] = [Key::Point, Key::Point2].map(|key| world.memory.point(request.index(key)));
            Ok(vec![world.arc_leg(robot, &via?, &to?, speed)?])
        }
        Command::MoveArch | Command::PalletArch => {
            let over = usize::try_from(request.int(Key::ArchAxis).trailing_zeros()).unwrap_or_default();
            world.has_axes(robot, 1 << over)?;
            let height = f64::from(request.int(Key::ArchPosition));
            let height = match PointUnit::from_code(request.int(Key::ArchUnit)) {
                PointUnit::Pulse => height,
                PointUnit::Mm => height / STEPS * world.geometry(robot)?.per_unit[over],
            };
            world.arch_legs(robot, over, height, target, speed)
        }
        _ => {
            let from = world.robot(robot)?.pulses();
            Ok(vec![world.joint_leg(robot, &from, target, speed)?])
        }
    }
}

/// Moves toward a position, and pushes against an obstacle for the given time (4.2.23).
fn push(world: &mut World, request: &Request) -> Result<(), Fault> {
    ready(world, request)?;
    let (number, at) = (request.robot(), axis(request));
    let mut target = target(world, request)?;
    let robot = world.robot(number)?;
    let pushed = &robot.axes[at];
    let force = request.maybe(Key::PushForce).unwrap_or_else(|| pushed.parameter(PUSH_FORCE));
    let time = request.maybe(Key::PushTime).unwrap_or_else(|| pushed.parameter(PUSH_TIME));
    let share = pushed.parameter(PUSH_SPEED).clamp(1, 100);
    let from = robot.pulses();
    robot.check_limits(number, &target)?;
    let (low, high) = (from[at].min(target[at]), from[at].max(target[at]));
    let obstacle = pushed.obstacle.filter(|obstacle| (low..=high).contains(obstacle));
    if let Some(obstacle) = obstacle {
        target[at] = obstacle;
    }
    let speed = Speed { rate: slower(world.share(robot, speed(request).rate), share), ..Speed::default() };
    let mut legs = vec![world.joint_leg(number, &from, &target, speed)?];
    let mut end = End::Arrived;
    if obstacle.is_some() {
        legs.push(Leg::rest(target, std::time::Duration::from_millis(time.unsigned_abs().into())));
        end = End::Pushed;
    }
    world.begin(number, Owner::Remote, legs, end)?;
    world.robot_mut(number)?.pushing = Some((at, force));
    Ok(())
}

/// Speed of a push: a share of full speed, reduced by a percentage.
fn slower(share: f64, percent: i32) -> Rate {
    Rate::OfMax(super::geometry::whole(share * f64::from(percent) * 100.0).max(1))
}

fn to_reset_position(world: &World, request: &Request) -> Result<Leg, Fault> {
    let (number, at) = (request.robot(), axis(request));
    let robot = world.robot(number)?;
    refuse_if(robot.axes[at].method != Method::Mark, super::operation_commands::no_mark(number, at))?;
    let from = robot.pulses();
    let mut to = from;
    // The next reset position in this direction. An axis that is exactly at a reset position moves to the next one.
    let turns = from[at] / RESET_PITCH;
    to[at] = RESET_PITCH * if sign(request) < 0.0 { (turns - 1e-9).floor() } else { (turns + 1e-9).ceil() };
    world.joint_leg(number, &from, &to, Speed { rate: Rate::Manual, ..Speed::default() })
}

fn origin(world: &mut World, request: &Request) -> Result<CommandProgress, Fault> {
    let homing = match (request.row.command, request.int(Key::OriginAxes)) {
        (Command::OriginAxis, _) => Homing::Axis(axis(request)),
        (_, 1) => Homing::Incremental,
        (_, 2) => Homing::Absolute,
        (_, 4) => Homing::Incomplete,
        _ => Homing::All,
    };
    if let Homing::Axis(at) = homing {
        world.has_axes(request.robot(), 1 << at)?;
    }
    let robots = match (request.row.command, request.int(Key::Robot)) {
        // Robot 0 means all robots (4.2.12).
        (Command::OriginRobot, 0) => (0..world.robots.len()).collect(),
        _ => vec![request.robot()],
    };
    for robot in &robots {
        world.may_move(*robot, 0)?;
    }
    let mut moving = Vec::new();
    for robot in robots {
        match world.begin_origin(robot, &[homing], Owner::Remote) {
            Ok(true) => moving.push(robot),
            Ok(false) => {}
            Err(fault) => {
                // This loop checks all robots before any robot moves, so that either all robots start or none.
                for robot in moving {
                    let robot = world.robot_mut(robot)?;
                    robot.motion = None;
                    robot.homing = 0;
                }
                return Err(fault);
            }
        }
    }
    Ok(CommandProgress::Motion(moving))
}

fn speed(request: &Request) -> Speed {
    let rate = match (request.maybe(Key::SpeedOfMax), request.maybe(Key::SpeedPercent), request.maybe(Key::SpeedMmS)) {
        (Some(share), ..) => Rate::OfMax(share),
        (_, Some(percent), _) => Rate::Percent(percent),
        (.., Some(speed)) => Rate::MmS(speed),
        _ => Rate::Program,
    };
    Speed { rate, accel: request.maybe(Key::Accel), decel: request.maybe(Key::Decel) }
}

/// The axes that a command names; all axes if it names none.
fn mask(request: &Request) -> u8 {
    let axes = request.maybe(Key::Axes).and_then(|axes| u8::try_from(axes).ok()).unwrap_or(ALL);
    if axes == 0 { ALL } else { axes }
}

/// The single axis of a command, counted from 0.
pub(super) fn axis(request: &Request) -> usize {
    usize::try_from(mask(request).trailing_zeros()).unwrap_or_default()
}

fn sign(request: &Request) -> f64 {
    if request.int(Key::Direction) == 1 { -1.0 } else { 1.0 }
}

fn frame(request: &Request) -> Frame {
    match request.row.command {
        Command::JogPulse | Command::InchPulse => Frame::Axes,
        Command::JogTool | Command::InchTool => Frame::Tool,
        _ => Frame::Cartesian,
    }
}

//! Move commands: checks, coordinate systems, start of the motion (DX 3.3.39, 3.3.40).
//!
//! The checks are in the order of the words in the request. User frames have an origin and a rotation about Z.
//! Increments in tool coordinates use the orientation of the tool.

use super::motion::{AXES, Family, MAX_ANGULAR_DEG_S, MAX_LINEAR_MM_S, Pose, Pulses, Speed, forward, inverse};
use super::world::{Refusal, World, code};
use crate::refuse_if;
use crate::yerc::Model;
use crate::yerc::payload::{CartesianMove, MoveLayout, PositionKind, PulseMove, SpeedClass};

/// Instances of the move commands. 1 is a link move; 3 is a straight move by an increment.
const LINK: u16 = 1;
const INCREMENT: u16 = 3;
/// Maximum tool and user frame number.
const LAST_NUMBER: u32 = 63;
/// Form bits of a move. The manuals reserve the other bits.
const FORM_BITS: u32 = 0x3F;
const EXTENDED_FORM_BITS: u32 = 0x1F;
/// Maximum speed of a straight motion in guarded operation.
const GUARDED_MM_S: f64 = 250.0;

impl World {
    /// Executes a move to cartesian coordinates (command 0x8A).
    pub(super) fn move_cartesian(&mut self, instance: u16, data: &[u8]) -> Result<(), Refusal> {
        // The FS100 manual has only 25 words, but FS100 controllers are known to accept 26 words too.
        let layouts = match self.model {
            Model::Fs100 => &[MoveLayout::Words25, MoveLayout::Words26][..],
            Model::Dx100 | Model::Dx200 | Model::Yrc1000 => &[MoveLayout::Words26],
        };
        refuse_if(!layouts.iter().any(|layout| layout.size() == data.len()), Refusal::Added(code::REQUEST_SIZE))?;
        let order = CartesianMove::parse(data).map_err(|_| Refusal::Added(code::REQUEST_SIZE))?;
        self.may_move()?;
        let group = self.moved_group(order.robot, order.station)?;
        let speed = speed_of(instance, order.class, order.speed)?;
        let known = match order.coordinate {
            PositionKind::Base | PositionKind::Robot | PositionKind::User => true,
            // A target in tool coordinates is valid only as an increment.
            PositionKind::Tool => instance == INCREMENT,
            PositionKind::Pulse | PositionKind::Other(_) => false,
        };
        refuse_if(!known, Refusal::Added(code::COORDINATE))?;
        refuse_if(order.reserved != [0, 0], Refusal::Added(code::RANGE))?;
        if order.form.0 & !FORM_BITS != 0 || order.extended.0 & !EXTENDED_FORM_BITS != 0 {
            return Err(Refusal::Added(code::FORM));
        }
        check_tool(order.tool)?;
        let frame = self.user_frame(order.coordinate, order.user)?;
        if self.arm.groups[group].family == Family::Station {
            let targets = self.station_target(group, &order.station_axes, instance == INCREMENT)?;
            return self.go(&[targets], speed);
        }
        check_unused(&order.station_axes)?;
        let mut targets = Vec::new();
        let number = self.arm.groups[group].number;
        let base = self.base_target(number, &order.base.map(f64::from), instance == INCREMENT)?;
        let base_mm = base.map_or(0.0, |(_, pulses)| pulses[0] / 1000.0);
        let near = self.arm.groups[group].pulses;
        let pose = target_pose(&order, instance == INCREMENT, &forward(&near), base_mm, frame);
        targets.push((group, inverse(&pose, &near)));
        targets.extend(base);
        self.go(&targets, speed)?;
        let moved = &mut self.arm.groups[group];
        (moved.form, moved.extended_form, moved.tool) = (order.form.0, order.extended.0, order.tool);
        Ok(())
    }

    /// Executes a move to a position in pulses (command 0x8B).
    pub(super) fn move_pulse(&mut self, instance: u16, data: &[u8]) -> Result<(), Refusal> {
        refuse_if(data.len() != PulseMove::SIZE, Refusal::Added(code::REQUEST_SIZE))?;
        let order = PulseMove::parse(data).map_err(|_| Refusal::Added(code::REQUEST_SIZE))?;
        self.may_move()?;
        let group = self.moved_group(order.robot, order.station)?;
        let speed = speed_of(instance, order.class, order.speed)?;
        check_tool(order.tool)?;
        if self.arm.groups[group].family == Family::Station {
            let target = self.station_target(group, &order.station_axes, false)?;
            return self.go(&[target], speed);
        }
        check_unused(&order.station_axes)?;
        let mut targets = vec![(group, self.pulses(group, &order.axes)?)];
        let number = self.arm.groups[group].number;
        targets.extend(self.base_target(number, &order.base.map(f64::from), false)?);
        self.go(&targets, speed)?;
        self.arm.groups[group].tool = order.tool;
        Ok(())
    }

    fn go(&mut self, targets: &[(usize, Pulses)], speed: Ordered) -> Result<(), Refusal> {
        match speed {
            Ordered::Share(share) => self.arm.joint(self.now, targets, share),
            Ordered::Speed(speed) => {
                if targets.iter().any(|&(group, _)| self.arm.groups[group].family == Family::Station) {
                    // A station only rotates, so it cannot move along a line.
                    return Err(Refusal::Added(code::WRONG_GROUP));
                }
                let speed = match speed {
                    Speed::Linear(speed) if self.switches.guard => Speed::Linear(speed.min(GUARDED_MM_S)),
                    speed => speed,
                };
                self.arm.straight(self.now, targets, speed);
            }
        }
        Ok(())
    }

    /// The group to move. The request must name exactly one fitted robot or station.
    fn moved_group(&self, robot: u32, station: u32) -> Result<usize, Refusal> {
        let (family, number) = match (robot, station) {
            (1.., 0) => (Family::Robot, robot),
            (0, 1..) => (Family::Station, station),
            _ => return Err(Refusal::Added(code::GROUP)),
        };
        let number = u16::try_from(number).ok();
        number.and_then(|number| self.arm.find(family, number)).ok_or(Refusal::Added(code::GROUP))
    }

    /// Pulses of a group. Words of missing axes must be 0.
    fn pulses(&self, group: usize, words: &[i32]) -> Result<Pulses, Refusal> {
        let axes = self.arm.groups[group].axes;
        check_unused(words.get(axes..).unwrap_or_default())?;
        let mut pulses = [0.0; AXES];
        for (pulse, word) in pulses.iter_mut().zip(words) {
            *pulse = f64::from(*word);
        }
        Ok(pulses)
    }

    fn station_target(&self, group: usize, words: &[i32; 6], increment: bool) -> Result<(usize, Pulses), Refusal> {
        let mut to = self.pulses(group, words)?;
        if increment {
            to.iter_mut().zip(self.arm.groups[group].pulses).for_each(|(to, from)| *to += from);
        }
        Ok((group, to))
    }

    /// Target of the base of a robot in pulses (one pulse is 0.001 mm). `None` for a robot without a base.
    fn base_target(&self, robot: u16, words: &[f64; 3], increment: bool) -> Result<Option<(usize, Pulses)>, Refusal> {
        let base = self.arm.find(Family::Base, robot);
        let axes = base.map_or(0, |base| self.arm.groups[base].axes);
        refuse_if(words[axes.min(3)..].iter().any(|&word| word != 0.0), Refusal::Added(code::RANGE))?;
        Ok(base.map(|base| {
            let mut pulses = [0.0; AXES];
            for (pulse, (word, from)) in pulses.iter_mut().zip(words.iter().zip(self.arm.groups[base].pulses)) {
                *pulse = if increment { word + from } else { *word };
            }
            (base, pulses)
        }))
    }

    /// Origin and rotation of the user frame. All values are 0 for coordinate systems without a user frame.
    fn user_frame(&self, coordinate: PositionKind, number: u32) -> Result<[f64; 4], Refusal> {
        if number > LAST_NUMBER || coordinate == PositionKind::User && number == 0 {
            return Err(Refusal::Added(code::USER_FRAME));
        }
        if coordinate != PositionKind::User {
            return Ok([0.0; 4]);
        }
        let frame = self.user_frames.iter().find(|(known, _)| *known == number);
        frame.map(|(_, frame)| *frame).ok_or(Refusal::Added(code::USER_FRAME_NOT_TAUGHT))
    }
}

/// Commanded speed.
#[derive(Debug, Clone, Copy)]
enum Ordered {
    /// Share of the maximum joint speed.
    Share(f64),
    Speed(Speed),
}

/// Checks the speed: its class must fit the instance, and its value must be within the limits of the robot.
fn speed_of(instance: u16, class: SpeedClass, speed: u32) -> Result<Ordered, Refusal> {
    let (scale, most) = match class {
        SpeedClass::Percent if instance == LINK => (0.01, 100.0),
        SpeedClass::Linear if instance != LINK => (0.1, MAX_LINEAR_MM_S),
        SpeedClass::Angular if instance != LINK => (0.1, MAX_ANGULAR_DEG_S),
        _ => return Err(Refusal::Added(code::SPEED)),
    };
    let value = f64::from(speed) * scale;
    refuse_if(speed == 0 || value > most + 1e-9, Refusal::Added(code::SPEED))?;
    Ok(match class {
        SpeedClass::Linear => Ordered::Speed(Speed::Linear(value)),
        SpeedClass::Angular => Ordered::Speed(Speed::Angular(value)),
        SpeedClass::Percent | SpeedClass::Other(_) => Ordered::Share(value / 100.0),
    })
}

/// Checks that the words of missing axes are 0.
fn check_unused(words: &[i32]) -> Result<(), Refusal> {
    if words.iter().all(|&word| word == 0) { Ok(()) } else { Err(Refusal::Added(code::RANGE)) }
}

fn check_tool(tool: u32) -> Result<(), Refusal> {
    if tool > LAST_NUMBER { Err(Refusal::Added(code::TOOL)) } else { Ok(()) }
}

/// Target of a move, in robot coordinates.
fn target_pose(order: &CartesianMove, increment: bool, from: &Pose, base_mm: f64, frame: [f64; 4]) -> Pose {
    let words = order.target.map(f64::from);
    let (mut place, mut turn) = (
        [words[0] / 1000.0, words[1] / 1000.0, words[2] / 1000.0],
        [words[3] / 10_000.0, words[4] / 10_000.0, words[5] / 10_000.0],
    );
    match order.coordinate {
        PositionKind::User => {
            place = turned_about_z(place, frame[3]);
            if !increment {
                place = [place[0] + frame[0] - base_mm, place[1] + frame[1], place[2] + frame[2]];
                turn[2] += frame[3];
            }
        }
        PositionKind::Tool => place = rotated(place, from),
        PositionKind::Base if !increment => place[0] -= base_mm,
        _ => {}
    }
    if increment {
        for (i, value) in place.iter_mut().chain(&mut turn).enumerate() {
            *value += from[i];
        }
    }
    [place[0], place[1], place[2], turn[0], turn[1], turn[2], from[6]]
}

fn turned_about_z([x, y, z]: [f64; 3], degrees: f64) -> [f64; 3] {
    let (sin, cos) = degrees.to_radians().sin_cos();
    [x * cos - y * sin, x * sin + y * cos, z]
}

/// Converts a tool direction to robot coordinates: rotation about X, then Y, then Z.
fn rotated([x, y, z]: [f64; 3], pose: &Pose) -> [f64; 3] {
    let (sin, cos) = pose[3].to_radians().sin_cos();
    let (y, z) = (y * cos - z * sin, y * sin + z * cos);
    let (sin, cos) = pose[4].to_radians().sin_cos();
    let (x, z) = (x * cos + z * sin, z * cos - x * sin);
    turned_about_z([x, y, z], pose[5])
}

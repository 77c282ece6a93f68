//! Commands that read data.

use super::motion::{AXES, Family, Group, MAX_LINEAR_MM_S, whole};
use super::robot::{Answer, Store, command};
use super::world::{Refusal, World, code, format_time};
use crate::Now;
use crate::yerc::payload::{
    Alarm, Axes, AxisNames, ExtendedForm, Form, ManagementTime, Position, PositionKind, SystemInfo, Text,
};
use crate::yerc::table::Row;

/// Instances of groups: robots begin at 1, bases at 11, stations at 21. For cartesian coordinates, 100 is added.
const FIRST_BASE: u16 = 11;
const FIRST_STATION: u16 = 21;
const CARTESIAN: u16 = 100;
/// Number of axes of a robot with the usual number of axes.
const SIX: usize = 6;
/// Instance of the only task that can run.
const MASTER_TASK: u16 = 1;
/// Servo lag: pulses of lag at a speed of one pulse per second.
const SERVO_LAG_S: f64 = 0.02;
/// Axis names (DX 3.3.5). In the manual, the name of the seventh cartesian axis is a misprint.
const ROBOT_AXES: [&str; 7] = ["S", "L", "U", "R", "B", "T", "E"];
const CARTESIAN_AXES: [&str; 7] = ["X", "Y", "Z", "Rx", "Ry", "Rz", "Re"];
const OTHER_AXES: [&str; 7] = ["1", "2", "3", "4", "5", "6", "7"];

impl World {
    /// All fields of an instance.
    pub(super) fn read(&self, row: &Row, instance: u16) -> Answer {
        if let Some(store) = Store::from_number(row.number) {
            return self.read_element(store, instance, row.size());
        }
        match row.number {
            command::ALARM => short(self.alarms.current(instance)),
            command::HISTORY => short(self.alarms.past(instance)),
            command::ALARM_TEXTS => self.alarms.current(instance).ok_or(Refusal::Instance),
            command::HISTORY_TEXTS => self.alarms.past(instance).ok_or(Refusal::Instance),
            command::STATUS => Ok(self.status().emit()),
            command::JOB if instance == MASTER_TASK => Ok(self.player.info().emit()),
            command::AXES if self.switches.converting => Err(Refusal::Added(code::CONVERTING)),
            command::AXES => Ok(self.axis_names(instance)?.emit()),
            command::POSITION => Ok(self.position(instance)?.emit_fitted()),
            command::POSITION_ERROR => Ok(self.position_error(instance)?.emit()),
            command::TORQUE => Ok(self.torque(instance)?.emit()),
            command::TIMES => Ok(self.management_time(instance)?.emit()),
            command::SYSTEM => Ok(self.system(instance).emit()),
            // A controller gives this answer for tasks that are not set up. The simulator gives it for all other
            // instances that cannot be read.
            _ => Err(Refusal::Added(code::INSTANCE)),
        }
    }

    /// The fitted group for an instance, and whether the request is for cartesian coordinates.
    fn group(&self, instance: u16) -> Result<(usize, bool), Refusal> {
        let (place, cartesian) = match instance.checked_sub(CARTESIAN) {
            Some(place) if place > 0 => (place, true),
            _ => (instance, false),
        };
        let (family, number) = match place {
            FIRST_STATION.. => (Family::Station, place - FIRST_STATION + 1),
            FIRST_BASE.. => (Family::Base, place - FIRST_BASE + 1),
            _ => (Family::Robot, place),
        };
        let group = self.arm.find(family, number).ok_or(Refusal::Added(code::INSTANCE))?;
        Ok((group, cartesian))
    }

    fn axis_names(&self, instance: u16) -> Result<AxisNames, Refusal> {
        let (group, cartesian) = self.group(instance)?;
        let Group { family, axes, .. } = self.arm.groups[group];
        let names = match (family, cartesian) {
            (_, true) => CARTESIAN_AXES,
            (Family::Robot, false) => ROBOT_AXES,
            (Family::Base | Family::Station, false) => OTHER_AXES,
        };
        let mut answer = AxisNames::default();
        for (field, name) in answer.names.iter_mut().zip(names).take(axes) {
            *field = Text::cut(name.as_bytes());
        }
        Ok(answer)
    }

    fn position(&self, instance: u16) -> Result<Position, Refusal> {
        let (index, cartesian) = self.group(instance)?;
        let group = &self.arm.groups[index];
        let values: [i32; AXES] = if cartesian {
            let pose = self.arm.base_pose(index);
            std::array::from_fn(|i| pose.get(i).map_or(0, |value| whole(value * if i < 3 { 1000.0 } else { 10_000.0 })))
        } else {
            group.pulses.map(whole)
        };
        Ok(Position {
            kind: if cartesian { PositionKind::Base } else { PositionKind::Pulse },
            form: Form(group.form),
            tool: group.tool,
            user: 0,
            extended: ExtendedForm(group.extended_form),
            axes: self.answered(group, &values),
        })
    }

    /// Axis words of a group in an answer. Some controllers send only the words of existing axes. Others send a word
    /// for each possible axis.
    fn answered(&self, group: &Group, values: &[i32; AXES]) -> Axes {
        let is_trimmed = self.trim_axes.unwrap_or(group.family != Family::Robot || group.axes != SIX);
        if is_trimmed {
            return Axes::new(&values[..group.axes]).unwrap_or_default();
        }
        Axes::full(std::array::from_fn(|axis| if axis < group.axes { values[axis] } else { 0 }))
    }

    /// Servo lag of each moving axis.
    fn position_error(&self, instance: u16) -> Result<Axes, Refusal> {
        let (index, _) = self.group(instance)?;
        let lag = self.arm.velocity(index, self.now).map(|speed| whole(speed * SERVO_LAG_S));
        Ok(self.answered(&self.arm.groups[index], &lag))
    }

    /// Torque of each axis: a holding torque, plus a part that depends on the speed. The torque is 0 without servo
    /// power, because the brakes then hold the axes.
    fn torque(&self, instance: u16) -> Result<Axes, Refusal> {
        const HOLDING: [f64; AXES] = [0.0, 14.0, 9.0, 1.0, 2.0, 0.0, 0.0, 0.0];
        const FULL_SPEED: f64 = MAX_LINEAR_MM_S * 1000.0;
        let (index, _) = self.group(instance)?;
        let group = &self.arm.groups[index];
        let speed = self.arm.velocity(index, self.now);
        let torque: [i32; AXES] = std::array::from_fn(|i| {
            let holding = if group.family == Family::Robot { HOLDING[i] } else { 0.0 };
            let moving = (speed[i] / FULL_SPEED).clamp(-1.0, 1.0) * 30.0
                + if speed[i] == 0.0 { 0.0 } else { speed[i].signum() * 4.0 };
            if self.switches.servo { whole(holding + moving) } else { 0 }
        });
        Ok(self.answered(group, &torque))
    }

    fn management_time(&self, instance: u16) -> Result<ManagementTime, Refusal> {
        /// Place of the total. The hundreds of the instance select the counter, and the other digits select the group
        /// or the total.
        const TOTAL: u16 = 10;
        let (kind, place) = (instance / 100, instance % 100);
        let counted = if instance == 1 || kind == 3 || place == TOTAL {
            true
        } else {
            // In counter instances, robots count from 11. In position instances, 11 is the first base.
            let (family, number) = match place {
                FIRST_STATION.. => (Family::Station, place - FIRST_STATION + 1),
                _ => (Family::Robot, place.saturating_sub(TOTAL)),
            };
            let Some(group) = self.arm.find(family, number) else { return Err(Refusal::Added(code::INSTANCE)) };
            kind != 2 || self.arm.groups[group].family == Family::Robot
        };
        let elapsed = match (instance, kind) {
            _ if !counted => Now::ZERO,
            (1, _) => self.meters.control,
            (_, 0) => self.meters.servo,
            (_, 2) => self.meters.motion,
            // Application 1 runs with jobs. No other application is installed.
            (_, 1) | (301, _) => self.meters.playback,
            _ => Now::ZERO,
        };
        Ok(ManagementTime {
            start: Text::cut(format_time(self.installed).as_bytes()),
            elapsed: Text::cut(elapsed_text(elapsed).as_bytes()),
        })
    }

    /// For a missing group, the answer has empty names instead of a refusal (DX 3.3.26).
    fn system(&self, instance: u16) -> SystemInfo {
        let (name, parameters) = match instance {
            101 => (self.application.as_str(), ""),
            11..21 if self.arm.find(Family::Robot, instance - 10).is_some() => {
                (self.robot_model.as_str(), self.parameter_version.as_str())
            }
            _ => ("", ""),
        };
        SystemInfo {
            version: Text::cut(self.software.as_bytes()),
            name: Text::cut(name.as_bytes()),
            parameters: Text::cut(parameters.as_bytes()),
        }
    }
}

/// The data of an alarm without the sub-code texts.
fn short(alarm: Option<Vec<u8>>) -> Answer {
    let mut bytes = alarm.ok_or(Refusal::Instance)?;
    bytes.truncate(Alarm::SIZE);
    Ok(bytes)
}

/// Formats a time as `HHHHHH:MM'SS`.
fn elapsed_text(elapsed: Now) -> String {
    let seconds = elapsed.as_secs();
    format!("{:06}:{:02}'{:02}", seconds / 3600 % 1_000_000, seconds / 60 % 60, seconds % 60)
}

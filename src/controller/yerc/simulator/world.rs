//! Machine state: switches, power, alarms, permissions, time.

use jiff::SignedDuration;
use jiff::civil::DateTime;

use super::alarms::{AlarmLog, alarm, limit_data};
use super::console;
use super::memory::Memory;
use super::motion::{Arm, End, Family, Group};
use super::playback::Player;
use super::storage::Storage;
use crate::simulator::timeline::Timeline;
use crate::yerc::Model;
use crate::yerc::payload::{ControllerStatus, CycleMode, StatusBit};
use crate::yerc::wire::Status;
use crate::{Now, refuse_if};

/// Added status codes (DX chapter 4) that several modules use.
pub(super) mod code {
    pub(in super::super) const OPERAND_RANGE: u16 = 0x1012;
    pub(in super::super) const MOVING: u16 = 0x2010;
    pub(in super::super) const HOLD_PENDANT: u16 = 0x2020;
    pub(in super::super) const HOLD_EXTERNAL: u16 = 0x2040;
    pub(in super::super) const HOLD_COMMAND: u16 = 0x2050;
    pub(in super::super) const ALARM: u16 = 0x2060;
    pub(in super::super) const SERVO_OFF: u16 = 0x2070;
    pub(in super::super) const MODE: u16 = 0x2080;
    pub(in super::super) const FILE_IN_USE: u16 = 0x2090;
    pub(in super::super) const NOT_REMOTE: u16 = 0x2100;
    pub(in super::super) const NO_ACCESS: u16 = 0x2110;
    pub(in super::super) const NOT_LOADED: u16 = 0x2120;
    pub(in super::super) const EDITING: u16 = 0x2130;
    pub(in super::super) const CONVERTING: u16 = 0x2150;
    pub(in super::super) const USER_FRAME_NOT_TAUGHT: u16 = 0x3350;
    pub(in super::super) const WRONG_GROUP: u16 = 0x3370;
    pub(in super::super) const SERVO_REFUSED: u16 = 0x3450;
    pub(in super::super) const MEMORY_FULL: u16 = 0x4010;
    pub(in super::super) const JOB_EXISTS: u16 = 0x4030;
    pub(in super::super) const NO_SUCH_JOB: u16 = 0x4040;
    pub(in super::super) const NO_JOB_SET: u16 = 0x4060;
    pub(in super::super) const JOB_NAME: u16 = 0x4190;
    pub(in super::super) const OPERATING: u16 = 0x6010;
    pub(in super::super) const UNDEFINED_COMMAND: u16 = 0xA000;
    pub(in super::super) const INSTANCE: u16 = 0xA001;
    pub(in super::super) const ATTRIBUTE: u16 = 0xA002;
    pub(in super::super) const ANSWER_SIZE: u16 = 0xA101;
    pub(in super::super) const REQUEST_SIZE: u16 = 0xB003;
    pub(in super::super) const RANGE: u16 = 0xB004;
    pub(in super::super) const UNDEFINED_DATA: u16 = 0xB005;
    pub(in super::super) const GROUP: u16 = 0xB008;
    pub(in super::super) const SPEED: u16 = 0xB009;
    pub(in super::super) const COORDINATE: u16 = 0xB00B;
    pub(in super::super) const FORM: u16 = 0xB00C;
    pub(in super::super) const TOOL: u16 = 0xB00D;
    pub(in super::super) const USER_FRAME: u16 = 0xB00E;
    pub(in super::super) const BUSY: u16 = 0xD8FA;
    pub(in super::super) const BACKUP_MODE: u16 = 0xE250;
    pub(in super::super) const TIMED_OUT: u16 = 0xE28B;
    pub(in super::super) const NO_OVERWRITE: u16 = 0xE28C;
    pub(in super::super) const NO_DATA: u16 = 0xE29C;
    pub(in super::super) const PATH: u16 = 0xE2A0;
    pub(in super::super) const NO_MATCH: u16 = 0xE2A7;
    pub(in super::super) const NO_DELETE: u16 = 0xE2AF;
    pub(in super::super) const NO_SUCH_FILE: u16 = 0xE2B3;
    pub(in super::super) const PATH_LENGTH: u16 = 0xE2B4;
    pub(in super::super) const FILE_BUSY: u16 = 0xE444;
    pub(in super::super) const DATA_SIZE_ZERO: u16 = 0xE49D;
    pub(in super::super) const FRAME_TOO_LONG: u16 = 0xE49E;
    pub(in super::super) const BLOCK: u16 = 0xE4A1;
    pub(in super::super) const ACK: u16 = 0xE4A2;
    pub(in super::super) const DIVISION: u16 = 0xE4A3;
    pub(in super::super) const HEADER_SIZE: u16 = 0xE4A5;
    pub(in super::super) const IDENTIFIER: u16 = 0xE4A6;
    pub(in super::super) const SIZE_DIFFERS: u16 = 0xE4A7;
    pub(in super::super) const MODE_CHANGED: u16 = 0xFFFE;
}

/// Reason of a refusal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Refusal {
    /// Unknown command or service.
    Command,
    /// Unknown attribute.
    Attribute,
    /// Unknown instance.
    Instance,
    /// A refusal with an added status.
    Added(u16),
}

impl Refusal {
    /// Status that a model answers. The FS100 manual has only status 0x1F, so an FS100 answers with the added status
    /// A000 to A002.
    pub(super) fn status(self, model: Model) -> Status {
        let plain = |code| Status { code, ..Status::OK };
        match (self, model) {
            (Self::Command, Model::Fs100) => Status::refused(code::UNDEFINED_COMMAND),
            (Self::Attribute, Model::Fs100) => Status::refused(code::ATTRIBUTE),
            (Self::Instance, Model::Fs100) => Status::refused(code::INSTANCE),
            (Self::Command, _) => plain(0x08),
            (Self::Attribute, _) => plain(0x09),
            (Self::Instance, _) => plain(0x28),
            (Self::Added(added), _) => Status::refused(added),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Mode {
    Teach,
    Play,
}

/// Which sources have applied HOLD.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Holds {
    pub(super) pendant: bool,
    pub(super) external: bool,
    pub(super) command: bool,
}

impl Holds {
    /// Added status for the source of the HOLD.
    fn refusal(self) -> Option<u16> {
        [(self.pendant, code::HOLD_PENDANT), (self.external, code::HOLD_EXTERNAL), (self.command, code::HOLD_COMMAND)]
            .into_iter()
            .find_map(|(held, code)| held.then_some(code))
    }
}

/// Operator switches.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent switch")]
pub(super) struct Switches {
    pub(super) mode: Mode,
    /// Whether command remote is on (#82015).
    pub(super) remote: bool,
    pub(super) servo: bool,
    pub(super) cycle: CycleMode,
    pub(super) hold: Holds,
    pub(super) guard: bool,
    pub(super) hlock: bool,
    pub(super) estop: bool,
    /// Whether a job is being edited on the pendant.
    pub(super) editing: bool,
    /// Whether the pendant shows a screen that prevents the reading of axis names (DX 3.3.5).
    pub(super) converting: bool,
    /// Parameter S2C541: whether variables and I/O are locked against writing in play mode.
    pub(super) play_lock: bool,
    /// Whether the pendant displays an error (not an alarm).
    pub(super) error: bool,
    /// Message on the pendant. Command 0x85 sets it.
    pub(super) message: Vec<u8>,
}

/// Operating-time counters (DX 3.3.25).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Meters {
    pub(super) control: Now,
    pub(super) servo: Now,
    pub(super) playback: Now,
    pub(super) motion: Now,
}

#[derive(Debug, Clone)]
pub(super) struct World {
    pub(super) model: Model,
    /// System software version, for example `FS1.14.00A(JP/US)-00`.
    pub(super) software: String,
    pub(super) robot_model: String,
    pub(super) application: String,
    pub(super) parameter_version: String,
    /// Date and time at which `Now` is zero.
    pub(super) clock: DateTime,
    /// Start of the operating-time counters.
    pub(super) installed: DateTime,
    pub(super) now: Now,
    pub(super) switches: Switches,
    pub(super) alarms: AlarmLog,
    pub(super) memory: Memory,
    pub(super) arm: Arm,
    pub(super) player: Player,
    pub(super) files: Storage,
    /// Whether answers omit missing axes. If this is `None`, answers for all groups except robots with six axes omit
    /// them.
    pub(super) trim_axes: Option<bool>,
    /// Operating-time counters, including the time before the start.
    pub(super) meters: Meters,
    /// Taught user frames: number, origin, and rotation about Z.
    pub(super) user_frames: Vec<(u32, [f64; 4])>,
    pub(super) events: Timeline,
    /// Number of changes of the mode and of command remote. After each change, the file server drops its transfer.
    pub(super) mode_changes: u64,
}

/// Maximum number of steps in a call of [`World::advance`]. After these steps, the rest of the time is one step.
const MAX_STEPS: u32 = 1_000_000;

impl World {
    /// Advances the time to `to`.
    pub(super) fn advance(&mut self, to: Now) {
        for _ in 0..MAX_STEPS {
            let Some(next) = self.wake().filter(|&next| next <= to) else { break };
            self.pass(next.max(self.now));
            self.act();
        }
        self.pass(to.max(self.now));
        self.act();
    }

    /// Time of the next internal event.
    pub(super) fn wake(&self) -> Option<Now> {
        [self.arm.motion_end(), self.player.due(), self.events.due()].into_iter().flatten().min()
    }

    /// Advances the time from `now` to `to`, and counts the operating times. No switch changes during this time.
    fn pass(&mut self, to: Now) {
        let span = to.saturating_sub(self.now);
        self.meters.control += span;
        for (counts, meter) in [
            (self.switches.servo, &mut self.meters.servo),
            (self.player.is_running(), &mut self.meters.playback),
            (self.arm.is_moving(), &mut self.meters.motion),
        ] {
            if counts {
                *meter += span;
            }
        }
        self.now = to;
    }

    /// Handles the events that are due.
    fn act(&mut self) {
        match self.arm.advance(self.now) {
            Some(End::Arrived) => self.motion_done(),
            Some(End::Limit(group, axis)) => {
                let Group { family, number, pulses, .. } = &self.arm.groups[group];
                // Sub-codes of alarm type 21 contain the robot axes at the lower limit and at the upper limit.
                let (kind, data) = match family {
                    Family::Robot => (21, limit_data(*number, axis, pulses[axis] > 0.0)),
                    Family::Base | Family::Station => (0, 0),
                };
                self.raise(4416, data, kind, None);
            }
            Some(End::Stopped) | None => {}
        }
        self.play();
        while let Some(line) = self.events.take(self.now) {
            // The lines were checked when the start state was parsed. If a line is not possible in the current state,
            // it has no effect, as on a pendant.
            let _refused = console::execute(self, &line);
        }
    }

    /// Date and time in alarms.
    pub(super) fn timestamp(&self) -> String {
        let passed = SignedDuration::try_from(self.now).unwrap_or(SignedDuration::MAX);
        format_time(self.clock.saturating_add(passed))
    }

    /// Raises an alarm. It stops everything, and switches servo power off unless it is a user alarm.
    pub(super) fn raise(&mut self, code: u32, data: u32, kind: u32, name: Option<&str>) {
        self.alarms.raise(alarm(code, data, kind, &self.timestamp(), name));
        if code < 8000 {
            self.power_off();
        } else {
            self.stop();
        }
    }

    /// Decelerates the motion and stops the job at its line.
    pub(super) fn stop(&mut self) {
        self.arm.brake(self.now);
        self.player.stop();
    }

    /// Switches servo power off. The brakes hold the axes.
    pub(super) fn power_off(&mut self) {
        self.switches.servo = false;
        self.arm.halt(self.now);
        self.player.stop();
    }

    /// Whether a job or a motion runs.
    pub(super) fn is_running(&self) -> bool {
        self.player.is_running() || self.arm.is_moving()
    }

    /// Both status words of command 0x72.
    pub(super) fn status(&self) -> ControllerStatus {
        let Switches { mode, remote, servo, cycle, hold, guard, error, .. } = self.switches;
        [
            (StatusBit::Step, cycle == CycleMode::Step),
            (StatusBit::OneCycle, cycle == CycleMode::Once),
            (StatusBit::Continuous, cycle == CycleMode::Continuous),
            (StatusBit::Running, self.is_running()),
            (StatusBit::Guarded, guard),
            (StatusBit::Teach, mode == Mode::Teach),
            (StatusBit::Play, mode == Mode::Play),
            (StatusBit::CommandRemote, remote),
            (StatusBit::HoldPendant, hold.pendant),
            (StatusBit::HoldExternal, hold.external),
            (StatusBit::HoldCommand, hold.command),
            (StatusBit::Alarm, self.alarms.is_active()),
            (StatusBit::Error, error),
            (StatusBit::ServoOn, servo),
        ]
        .into_iter()
        .fold(ControllerStatus::default(), |status, (bit, on)| status.with(bit, on))
    }

    /// A byte of I/O. The system outputs show the state of the controller. Their positions are specific to this
    /// simulator, and are based on the usual ladder.
    pub(super) fn io(&self, instance: u16) -> u8 {
        let Switches { mode, remote, servo, hold, error, .. } = &self.switches;
        let signals: &[(u8, bool)] = match instance {
            5001 => &[
                (0, self.alarms.major_is_active()),
                (1, self.alarms.is_active() && !self.alarms.major_is_active()),
                (4, *error),
            ],
            5005 => &[(0, *remote), (3, *mode == Mode::Play), (4, *mode == Mode::Teach)],
            5007 => &[(0, self.is_running()), (1, hold.refusal().is_some()), (3, *servo)],
            8201 => &[(5, *remote)],
            _ => &[],
        };
        signals.iter().fold(self.memory.io(instance), |byte, &(bit, on)| byte & !(1 << bit) | u8::from(on) << bit)
    }

    /// Checks that the controller accepts changes at all.
    pub(super) fn may_command(&self) -> Result<(), Refusal> {
        if self.switches.remote { Ok(()) } else { Err(Refusal::Added(code::NOT_REMOTE)) }
    }

    /// Checks that variables, I/O and registers can be written.
    pub(super) fn may_write(&self) -> Result<(), Refusal> {
        self.may_command()?;
        let Switches { mode, editing, play_lock, .. } = self.switches;
        refuse_if(editing, Refusal::Added(code::EDITING))?;
        refuse_if(play_lock && mode == Mode::Play, Refusal::Added(code::NO_ACCESS))
    }

    /// Checks that a motion or a job can start.
    pub(super) fn may_move(&self) -> Result<(), Refusal> {
        let Switches { mode, servo, hold, editing, .. } = self.switches;
        refuse_if(mode == Mode::Teach, Refusal::Added(code::MODE))?;
        self.may_command()?;
        let obstacle = [
            (editing, code::EDITING),
            (self.alarms.is_active() || self.switches.error, code::ALARM),
            (!servo, code::SERVO_OFF),
        ]
        .into_iter()
        .find_map(|(obstacle, code)| obstacle.then_some(code))
        .or(hold.refusal())
        .or(self.is_running().then_some(code::MOVING));
        obstacle.map_or(Ok(()), |code| Err(Refusal::Added(code)))
    }

    /// Checks that servo power can be switched on.
    pub(super) fn may_power(&self) -> Result<(), Refusal> {
        refuse_if(self.alarms.is_active(), Refusal::Added(code::ALARM))?;
        refuse_if(self.switches.estop, Refusal::Added(code::SERVO_REFUSED))
    }

    /// Switches mode or remote. This stops jobs and drops transfers.
    pub(super) fn set_mode(&mut self, mode: Mode, remote: bool) {
        if (self.switches.mode, self.switches.remote) == (mode, remote) {
            return;
        }
        if self.switches.mode != mode {
            self.stop();
        }
        self.switches.mode = mode;
        self.switches.remote = remote;
        self.mode_changes += 1;
    }
}

/// Formats a time as `YYYY/MM/DD HH:MM`.
pub(super) fn format_time(time: DateTime) -> String {
    time.strftime("%Y/%m/%d %H:%M").to_string()
}

//! The commands of `yerc`, as its help lists them.

use super::{alarm, axes, file, hours, info, io, job, moves, orders, position, raw, register, status, var};
use crate::command::{Subcommands, commands};

commands! {
    /// What can be asked of an FS100 or DX200.
    pub enum Commands {
        /// Mode, cycle, servo, hold, alarm: every status bit
        Status(status::Status),
        /// Alarms: list, history, reset, cancel
        Alarm(Subcommands<alarm::Alarm>),
        /// Jobs: show, select, start
        Job(Subcommands<job::Job>),
        /// Files: list, get, put, delete, diff, backup, restore, cmos
        File(Subcommands<file::File>),
        /// Where a control group stands: pulses, base coordinates, form
        Position(position::Position),
        /// The axes of each control group
        Axes(axes::AxesOf),
        /// How far each axis is from where it should be
        PositionError(axes::PositionError),
        /// The torque of each axis
        Torque(axes::Torque),
        /// Variables: get, set, dump, restore
        Var(Subcommands<var::Var>),
        /// Signals: get, set
        Io(Subcommands<io::Io>),
        /// Registers: get, set
        Register(Subcommands<register::Register>),
        /// Switch servo power
        Servo(orders::Servo),
        /// Hold the robot, or let it go on
        Hold(orders::Hold),
        /// Lock or unlock the pendant and the operation signals
        Hlock(orders::Hlock),
        /// Choose step, one cycle or continuous
        Cycle(orders::Cycle),
        /// Show a message on the pendant
        Say(orders::Say),
        /// Move a robot or station
        Move(Subcommands<moves::Move>),
        /// Running times: power, servo, playback, motion, applications
        Hours(hours::Hours),
        /// Software version, robot models, parameters
        Info(info::Info),
        /// Send any request and explain the answer
        Raw(raw::Raw),
    }
}

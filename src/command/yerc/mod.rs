//! `yerc`: Yaskawa FS100 and DX200 over the high-speed Ethernet server.

mod alarm;
mod axes;
mod check;
mod chosen;
mod connect;
pub mod decode;
mod each;
pub mod explain;
pub mod file;
mod fitted;
#[cfg(test)]
mod gated;
mod hours;
mod info;
mod io;
mod job;
pub mod link;
mod motion;
mod moves;
mod numbers;
mod orders;
mod overview;
mod parts;
mod position;
mod raw;
mod refusal;
mod register;
pub mod serve;
pub mod simulated;
mod status;
#[cfg(test)]
mod testing;
pub mod top;
mod trace;
mod var;
mod writes;

pub use check::check;
pub use connect::hold;
pub use link::Yerc as Family;
pub use overview::overview;

use crate::command::{Verbs, commands};

commands! {
    /// What can be asked of an FS100 or DX200.
    pub enum Yerc of Family {
        /// Mode, cycle, servo, hold, alarm: every status bit
        Status(status::Status),
        /// Alarms: list, history, reset, cancel
        Alarm(Verbs<alarm::Alarm>),
        /// Jobs: show, select, start
        Job(Verbs<job::Job>),
        /// Files: list, get, put, delete, diff, backup, restore, cmos
        File(Verbs<file::File>),
        /// Where a control group stands: pulses, base coordinates, form
        Position(position::Position),
        /// The axes of each control group
        Axes(axes::AxesOf),
        /// How far each axis is from where it should be
        PositionError(axes::PositionError),
        /// The torque of each axis
        Torque(axes::Torque),
        /// Variables: get, set, dump, restore
        Var(Verbs<var::Var>),
        /// Signals: get, set
        Io(Verbs<io::Io>),
        /// Registers: get, set
        Register(Verbs<register::Register>),
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
        Move(Verbs<moves::Move>),
        /// Running times: power, servo, playback, motion, applications
        Hours(hours::Hours),
        /// Software version, robot models, parameters
        Info(info::Info),
        /// Send any request and explain the answer
        Raw(raw::Raw),
    }
}

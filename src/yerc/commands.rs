//! Commands of `yerc` in the order of its help.

use super::link::Yerc;
use super::{
    alarm, axes, control_commands, file, hours, info, io, job, moves, names, position, raw, register, status, teach,
    var,
};
use armctl_frame::backup::family_backup::{Backup, Diff, Restore};
use armctl_frame::{Subcommands, commands};

commands! {
    /// Commands for an FS100, DX100, DX200 or YRC1000.
    pub enum Commands {
        "Status and diagnosis":
        /// Show all status bits: mode, cycle, servo, hold, alarm
        Status(status::Status),
        /// Alarms
        Alarm(Subcommands<alarm::Alarm>),
        /// Current position of a control group
        Position(position::Position),
        /// List the axes of each control group
        Axes(axes::AxesOf),
        /// Position deviation (following error) per axis
        PositionError(axes::PositionError),
        /// Torque per axis
        Torque(axes::Torque),
        /// Operating hours: power, servo, playback, motion, applications
        Hours(hours::Hours),
        /// Software version, robot models, parameters
        Info(info::Info),
        "Power and operation":
        /// Switch servo power
        Servo(control_commands::Servo),
        /// Stop the running job and all motion: HOLD on
        Stop(job::Stop<false>),
        /// Apply (on) or release (off) HOLD
        Hold(control_commands::Hold),
        /// Lock or unlock the pendant and the operation signals
        Hlock(control_commands::Hlock),
        /// Select step, one cycle or continuous
        Cycle(control_commands::Cycle),
        /// Show a message on the pendant
        Say(control_commands::Say),
        "Motion":
        /// Move a robot or station
        Move(Subcommands<moves::Move>),
        "Programs":
        /// Jobs
        #[command(alias = "program")]
        Job(Subcommands<job::Job>),
        /// Files
        File(Subcommands<file::File>),
        "Data":
        /// Teach: store the current position in a variable
        Teach(teach::Teach),
        /// Variables
        Var(Subcommands<var::Var>),
        /// Save every file of the controller to a folder
        Backup(Backup<Yerc>),
        /// Restore a backup
        Restore(Restore<Yerc>),
        /// Compare a backup with another backup or with the controller
        Diff(Diff<Yerc>),
        "Signals":
        /// Signals
        Io(Subcommands<io::Io>),
        /// Registers
        Register(Subcommands<register::Register>),
        /// Names of signals, variables and registers
        Names(Subcommands<names::Names>),
        "Link":
        /// Send any request and decode the answer
        Raw(raw::Raw),
    }
}

//! `yerc`: Yaskawa FS100 and DX200 over the high-speed Ethernet server.

pub mod link;
mod orders;
pub mod overview;
mod status;
mod trace;

pub use link::Yerc as Family;

use crate::command::commands;

commands! {
    /// What can be asked of an FS100 or DX200.
    pub enum Yerc of Family {
        /// Mode, cycle, servo, hold, alarm: every status bit
        Status(status::Status),
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
    }
}

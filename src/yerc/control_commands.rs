//! Commands that send one request: servo, hold, hlock, cycle, say.

use super::link::Yerc;
use super::status::cycle_name;
use crate::prelude::basics::*;
use armctl_controller::yerc::payload::{ControllerStatus, CycleMode};
use armctl_controller::yerc::query::{self, Query};
use armctl_frame::settings_report::Switch;

/// Declares a command that sends one request. The parts are the type, its argument, the id, the request, the intent,
/// and the result.
macro_rules! order {
    (
        $(#[$doc:meta])*
        $name:ident { $(#[$arg:meta])* $field:ident: $type:ty }, $id:literal,
        |$this:ident| $query:expr, $intent:expr,
        $set:literal = $new:expr, $done:expr $(, was |$status:ident| $old:expr)? $(, stops if $is_stop:expr)?
    ) => {
        $(#[$doc])*
        #[derive(Debug, Args)]
        pub struct $name {
            $(#[$arg])*
            $field: $type,
        }

        impl Command for $name {
            type Family = Yerc;
            type Report = SetReport;
            const ID: &'static str = $id;

            fn risk(&self) -> Risk {
                let $this = self;
                $query.risk()
            }

            fn intent(&self) -> String {
                let $this = self;
                // Most requests do not use the arguments.
                let _ = $this;
                $intent.to_owned()
            }

            fn confirmation(&self) -> Confirmation {
                if self.is_stop() { Confirmation::Question } else { Confirmation::WhenKnown }
            }

            $(fn is_stop(&self) -> bool {
                let $this = self;
                $is_stop
            })?

            async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport> {
                let ($this, Context { link, confirmer, .. }) = (self, context);
                let new = NewValue::of($set, $new, $done);
                let old = Old::UNREAD;
                // A stop must not be delayed by a read, so its old value is not read.
                $(let old = if self.is_stop() {
                    old
                } else {
                    let $status = link.before(&query::ReadStatus).await?;
                    Old::read($old)
                };)?
                if !self.is_stop() {
                    confirmer.confirm(&new.question(self.intent(), &old)).await?;
                }
                if self.is_stop() {
                    link.stop().await?;
                } else {
                    link.ask(&$query).await?;
                }
                Ok(new.replaces(old))
            }
        }
    };
}

order! {
    /// Switches servo power (FS and DX 3.3.20).
    Servo {
        /// On or off
        #[arg(value_name = "on|off")]
        switch: Switch
    }, "yerc.servo",
    |this| query::Servo(this.switch == Switch::On),
    if this.switch == Switch::On { "switch servo power on" } else { "switch servo power off: an axis without brake may \
        sink" },
    "servo_on" = this.switch == Switch::On,
    if this.switch == Switch::On { "servo power is on" } else { "servo power is off" },
    was |status| status.map(ControllerStatus::servo_on)
}
impl Hold {
    /// The command that stops the robot.
    pub const fn on() -> Self {
        Self { switch: Switch::On }
    }
}

order! {
    /// Applies (on) or releases (off) HOLD (FS and DX 3.3.20).
    Hold {
        /// on applies HOLD, off releases it
        #[arg(value_name = "on|off")]
        switch: Switch
    }, "yerc.hold",
    |this| query::Hold(this.switch == Switch::On), "release the hold",
    "held" = this.switch == Switch::On,
    if this.switch == Switch::On { "HOLD is on" } else { "HOLD is off" },
    was |status| status.map(ControllerStatus::held),
    stops if this.switch == Switch::On
}
order! {
    /// Locks or unlocks the pendant and the I/O operation signals (FS and DX 3.3.20).
    Hlock {
        /// on locks, off unlocks
        #[arg(value_name = "on|off")]
        switch: Switch
    }, "yerc.hlock",
    |this| query::Hlock(this.switch == Switch::On), "",
    "hlock_on" = this.switch == Switch::On,
    if this.switch == Switch::On { "pendant and operation signals are locked" } else { "pendant and operation signals \
        are unlocked" }
}

/// Cycle modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CycleName {
    /// One step per start
    Step,
    /// One cycle per start
    Once,
    /// Continuous
    Continuous,
}

impl From<CycleName> for CycleMode {
    fn from(name: CycleName) -> Self {
        match name {
            CycleName::Step => Self::Step,
            CycleName::Once => Self::Once,
            CycleName::Continuous => Self::Continuous,
        }
    }
}

order! {
    /// Selects the cycle mode (FS and DX 3.3.21).
    Cycle {
        /// Cycle mode
        mode: CycleName
    }, "yerc.cycle",
    |this| query::SetCycle(this.mode.into()), "",
    "cycle" = cycle_name(this.mode.into()),
    match this.mode {
        CycleName::Step => "the cycle mode is step",
        CycleName::Once => "the cycle mode is one cycle",
        CycleName::Continuous => "the cycle mode is continuous",
    },
    was |status| status.and_then(ControllerStatus::cycle).map(cycle_name)
}

/// Shows a message on the pendant (FS and DX 3.3.22).
#[derive(Debug, Args)]
pub struct Say {
    /// At most 30 half-width or 15 full-width characters; an empty text clears the message
    text: String,
}

impl Command for Say {
    type Family = Yerc;
    type Report = SetReport;
    const ID: &'static str = "yerc.say";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport> {
        refuse_controls("the message", &self.text)?;
        let bytes = context.link.encode("the message", &self.text)?;
        context.link.ask(&query::Say::new(&bytes).map_err(usage)?).await?;
        let words = if self.text.is_empty() { "the message is cleared" } else { "the pendant shows the message" };
        Ok(NewValue::of("pendant_message", self.text.as_str(), words).replaces(Old::UNREAD))
    }
}

/// Rejects control characters in display texts and job names, because the effect of such characters on a controller is
/// unknown.
pub(super) fn refuse_controls(what: &str, text: &str) -> Result<()> {
    match text.chars().find(|c| c.is_control()) {
        None => Ok(()),
        Some(found) => {
            Err(Failure::usage(format!("{what} contains a control character: {}", found.escape_debug()))
                .hint("remove it"))
        }
    }
}

/// Failure: a request cannot be built from these arguments.
pub(super) fn usage(error: impl fmt::Display) -> Failure {
    Failure::usage(error.to_string()).hint("see `--help` of the command, or `armctl help yerc` for all commands")
}

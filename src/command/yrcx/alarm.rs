//! `yrcx alarm reset` (4.8.3).

use clap::Args;

use schemars::JsonSchema;
use serde::Serialize;

use super::link::Yrcx;
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::yrcx::signal::output;
use crate::controller::yrcx::table;
use crate::failure::Failure;
use crate::output::view::View;

commands! {
    /// What can be done about alarms.
    pub enum Alarm {
        /// Reset the alarm
        Reset(Reset),
    }
}

/// Resets the alarm.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx io pulse alarm-reset` does the same by a signal, also where remote commands are not taken."
)]
pub struct Reset {}

impl Command for Reset {
    type Family = Yrcx;
    type Report = WasReset;
    const ID: &'static str = "yrcx.alarm.reset";

    fn risk(&self) -> Risk {
        table::Command::AlarmReset.row().risk
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WasReset, Failure> {
        let Context { link, screen, .. } = context;
        let order = link.draft(table::Command::AlarmReset)?.build()?;
        link.ask(&order).await?;
        if link.is_dry() {
            return Ok(WasReset { alarm: false, servo_on: false });
        }
        let image = link.look().await?;
        let report = WasReset { alarm: output::ALARM.is_on(&image), servo_on: output::SERVO_ON.is_on(&image) };
        if !report.servo_on {
            if link.is_held() {
                screen.note(POWER_OFF);
            } else {
                let alarm = link.link_alarm();
                screen.note(&format!(
                    "hint: motor power is off, and the end of this connection raises alarm {alarm} again: keep one open with \
                     `armctl session open`, then `yrcx alarm reset` and `yrcx recover`"
                ));
            }
        }
        Ok(report)
    }
}

/// What comes next where an alarm has switched the motors off.
const POWER_OFF: &str = "hint: motor power is off: `yrcx recover` clears the emergency stop and switches the servos on";

/// An alarm that was reset.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WasReset {
    /// SO(03) after it: there is still one.
    alarm: bool,
    /// SO(02): motor power is on.
    servo_on: bool,
}

impl Report for WasReset {
    fn view(&self) -> View {
        View::text(if self.alarm { "alarm reset accepted; there is still an alarm" } else { "alarm reset" })
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["alarm", "reset"]).unwrap(), [example("4.8.3-reset")]);
        let read = read_example("4.8.3-reset", &["alarm", "reset"]);
        assert_eq!((&read["alarm"], &read["servo_on"]), (&false.into(), &false.into()));
    }
}

//! Procedures of the timing charts as commands (chapter 1, section 3).

use crate::prelude::*;
use armctl_controller::yrcx::procedure::Procedure;
use armctl_frame::face::shared_commands::CommonReport;

/// Declares a command for each procedure.
macro_rules! procedures {
    ($($(#[$meta:meta])* $name:ident $id:literal $procedure:ident $set:literal = $new:literal, $done:literal $(was $signal:ident)? $($is_stop:literal)?;)*) => {
        $(
            $(#[$meta])*
            #[derive(Debug, Args)]
            pub struct $name {}

            impl Command for $name {
                type Family = Yrcx;
                type Report = ProcedureReport;
                const ID: &'static str = $id;

                fn risk(&self) -> Risk {
                    Procedure::$procedure().risk
                }

                fn intent(&self) -> String {
                    Procedure::$procedure().intent
                }

                $(fn is_stop(&self) -> bool {
                    $is_stop
                })?

                fn connect_mode(&self) -> ConnectMode {
                    if Procedure::$procedure().only_awaits() { ConnectMode::Monitor } else { ConnectMode::Control }
                }

                async fn run(&self, context: Context<'_, Yrcx>) -> Result<ProcedureReport> {
                    let old = read_old_state(context.link, [$(output::$signal)?].into_iter().next()).await?;
                    let elapsed = context.link.execute(Procedure::$procedure()).await?;
                    let elapsed_ms = u64::try_from(elapsed.as_millis()).unwrap_or(u64::MAX);
                    Ok(ProcedureReport { done: NewValue::of($set, $new, $done).replaces(old), elapsed_ms })
                }
            }
        )*
    };
}

/// Reads the state of the signal before the procedure. A stop has no such signal, so it does not wait for a read.
async fn read_old_state(link: &mut Link, signal: Option<Signal>) -> Result<Old> {
    let Some(signal) = signal else { return Ok(Old::UNREAD) };
    let shown = link.look().await.known()?;
    Ok(Old::read(shown.map(|image| signal.is_on(&image))))
}

procedures! {
    /// Switches the servos on after power on. Sets SI(00) on, then SI(01) on, and waits until SO(02) confirms.
    PowerOn "yrcx.power-on" power_on "servo_on" = true, "servos are on" was SERVO_ON;
    /// Puts the controller into emergency stop. Sets SI(00) off, and waits until SO(00), SO(03) and SO(02) confirm. Use
    /// a session. Without a session, the connection ends, and the controller reports a link fault instead.
    EmergencyStop "yrcx.emergency-stop" emergency_stop "emergency_stop" = true, "the controller is in emergency stop" true;
    /// Ends the emergency stop and switches the servos on. Sets SI(00), SI(16) and SI(01), and waits for the
    /// confirmation of each.
    Recover "yrcx.recover" recover "servo_on" = true, "servos are on again" was SERVO_ON;
    /// Waits until the operator selects AUTO mode at the controller (SO(10)).
    AutoMode "yrcx.auto-mode" auto_mode "auto_mode" = true, "AUTO mode is selected" was AUTO_MODE;
    /// Resets the robot program to its first line. Sets SI(15) on, and waits until SO(14) confirms.
    Reset "yrcx.reset" program_reset "program_state" = "reset", "the robot program is reset";
    /// Starts or continues the robot program. Sets SI(06) on, then SI(12) on, and waits until SO(13) confirms.
    Run "yrcx.run" run "program_running" = true, "the robot program is running" was PROGRAM_RUNNING;
    /// Stops the robot program. Sets SI(06) off, and waits until SO(13) confirms. SI(06) stays off until the next run.
    Stop "yrcx.stop" stop "program_running" = false, "the robot program is stopped" true;
}

/// Result of a procedure.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProcedureReport {
    #[serde(flatten)]
    done: SetReport,
    /// Time from the first signal to the last confirmation, in ms.
    elapsed_ms: u64,
}

impl CommonReport for ProcedureReport {
    type Core = SetReport;

    fn core(&self) -> SetReport {
        self.done.clone()
    }
}

impl Report for ProcedureReport {
    fn view(&self) -> View {
        View::text(format!("{} ({}.{:03} s)", self.done.words(), self.elapsed_ms / 1000, self.elapsed_ms % 1000))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::frames;

    #[test]
    fn a_dry_run_shows_every_edge() {
        let noted = frames(&["power-on"]).unwrap();
        let shown: Vec<(&str, &str)> =
            noted.iter().map(|note| (note["bits"][0].as_str().unwrap(), note["about"].as_str().unwrap())).collect();
        // SI(00) and SI(06) are on at the start, unless a session has switched them off.
        let edges = [("0x0043", "servo-on (SI(01)) on"), ("0x0041", "servo-on (SI(01)) off")];
        assert_eq!(shown, [&[("0x0041", "emergency-stop (SI(00)) on")], &edges[..]].concat());
        assert_eq!(noted[0]["depends_on"], "the earlier signals: sent only if emergency-stop is off");
        assert_eq!(frames(&["stop"]).unwrap()[0]["bits"][0], "0x0001");
        assert_eq!(frames(&["auto-mode"]).unwrap(), Vec::<serde_json::Value>::new());
    }
}

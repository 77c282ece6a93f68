//! Commands that send one block: servo, mode, reset, stop.

use super::link::MotionKind;
use super::position::UNIT;
use super::wait::wait_for_status;
use crate::prelude::*;
use armctl_controller::toyo::status::{ProgramKind, RunMode};
use armctl_frame::face::shared_commands::CommonReport;
use armctl_frame::robot::position::Position;
use armctl_frame::settings_report::Switch;

/// Switch servo power of all axes (TO 2-7), and wait until the status confirms the state.
#[derive(Debug, Args)]
pub struct Servo {
    /// Servo power on or off
    #[arg(value_name = "on|off")]
    to: Switch,
}

impl Command for Servo {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.servo";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        match self.to {
            Switch::On => "switch servo power on".to_owned(),
            Switch::Off => "switch servo power off: an axis without brake may sink".to_owned(),
        }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let Context { link, confirmer, .. } = context;
        let (command, is_on, words) = match self.to {
            Switch::On => (table::Command::Svon, true, "servo power is on"),
            Switch::Off => (table::Command::Svof, false, "servo power is off"),
        };
        let (new, old) = (NewValue::of("servo_on", is_on, words), link.status_before(3).await?);
        let old = Old::read(old.map(Status::servo_on));
        confirmer.confirm(&new.question(self.intent(), &old)).await?;
        link.ask(&Request::bare(command)).await?;
        let done =
            wait_for_status(link, (3, "whether servo power has switched"), |status| status.servo_on() == is_on).await?;
        link.end_motion();
        if done {
            return Ok(new.replaces(old));
        }
        Err(no_effect("servo power").hint("use `toyo alarm list` and `toyo status` to see the reason"))
    }
}

/// A mode of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModeName {
    /// Edit programs
    Program,
    /// Run one step at each start
    Step,
    /// Run programs from step to step
    #[value(alias = "automatic")]
    Auto,
    /// Run sequential programs
    Sequential,
    /// Run palletizing programs
    Palletizing,
}

impl ModeName {
    const fn command(self) -> table::Command {
        match self {
            Self::Program => table::Command::Mpro,
            Self::Step => table::Command::Mstp,
            Self::Auto => table::Command::Maut,
            Self::Sequential => table::Command::Mseq,
            Self::Palletizing => table::Command::Mple,
        }
    }

    fn is_in_force(self, status: Status) -> bool {
        match self {
            Self::Program => status.run_mode() == Some(RunMode::Program),
            Self::Step => status.run_mode() == Some(RunMode::Step),
            Self::Auto => status.run_mode() == Some(RunMode::Automatic),
            Self::Sequential => status.program_kind() == ProgramKind::Sequential,
            Self::Palletizing => status.program_kind() == ProgramKind::Palletizing,
        }
    }

    /// The active mode in the words of `status`, if it differs from this mode.
    fn instead_of(self, status: Status) -> Option<&'static str> {
        match self {
            Self::Program | Self::Step | Self::Auto => status.run_mode().map(RunMode::name),
            Self::Sequential | Self::Palletizing => Some(status.program_kind().name()),
        }
    }

    /// Name and value as `status` shows them.
    const fn data(self) -> (&'static str, &'static str) {
        match self {
            Self::Program => ("run_mode", "program"),
            Self::Step => ("run_mode", "step"),
            Self::Auto => ("run_mode", "automatic"),
            Self::Sequential => ("program_kind", "sequential"),
            Self::Palletizing => ("program_kind", "palletizing"),
        }
    }

    const fn in_force(self) -> &'static str {
        match self {
            Self::Program => "the controller is in program mode",
            Self::Step => "the controller is in step mode",
            Self::Auto => "the controller is in automatic mode",
            Self::Sequential => "the controller is in sequential mode",
            Self::Palletizing => "the controller is in palletizing mode",
        }
    }
}

/// Select the run mode or the program type (TO 2-2).
#[derive(Debug, Args)]
#[command(after_help = "Parameter M10 selects easy mode and external point mode: `toyo param set M10 …`. `toyo \
                        status` shows the modes.")]
pub struct Mode {
    /// Run mode (`program`, `step` or `auto`), or program type (`sequential` or `palletizing`)
    mode: ModeName,
}

impl Command for Mode {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.mode";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let (link, mode) = (context.link, self.mode);
        let old = Old::read(link.status_before(2).await?.and_then(|status| mode.instead_of(status)));
        link.ask(&Request::bare(mode.command())).await?;
        if wait_for_status(link, (2, "whether the mode is active"), |status| mode.is_in_force(status)).await? {
            let (set, new) = mode.data();
            return Ok(NewValue::of(set, new, mode.in_force()).replaces(old));
        }
        Err(no_effect("the mode")
            .hint("check parameter M10, which selects easy or external point mode: `toyo param get M10`"))
    }
}

/// Failure: the controller accepted the command, but the command had no effect.
pub(super) fn no_effect(what: &str) -> Failure {
    Failure::new(
        Kind::ConditionNotMet,
        format!("the controller accepted the command, but {what} did not change within 1s"),
    )
}

/// Reset programs to the first step (TO 2-7).
#[derive(Debug, Args)]
pub struct Reset {}

impl Command for Reset {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.reset";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        context.link.ask(&Request::bare(table::Command::Rest)).await?;
        let words = "the controller was reset; `toyo alarm reset` cancels errors";
        Ok(NewValue::of("programs", "reset", words).replaces(Old::UNREAD))
    }
}

/// Stop the motion, and wait until the axes are at rest. armctl repeats the command until they are at rest.
///
/// Without --jog: stop a program, a return to origin, or an axis that moves without execution.
#[derive(Debug, Args)]
pub struct Stop {
    /// Stop a jog, for example if armctl was killed during a jog
    #[arg(long)]
    jog: bool,
}

impl Stop {
    /// Stops a program or any motion.
    pub const fn everything() -> Self {
        Self { jog: false }
    }
}

impl Command for Stop {
    type Family = Toyo;
    type Report = StopReport;
    const ID: &'static str = "toyo.stop";
    const RISK: Risk = Risk::Write;

    fn is_stop(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<StopReport> {
        let moving = if self.jog { MotionKind::Jog } else { MotionKind::Program };
        let record = context.link.stop(moving).await;
        if context.link.is_dry_run() {
            context.link.letters().await?;
        }
        let position = context.link.coordinates(&record?).await;
        let words = format!("the axes have stopped at {}", position.in_a_line());
        let position = position.position().of_group(UNIT);
        Ok(StopReport { done: NewValue::of("running", false, words).replaces(Old::UNREAD), position })
    }
}

/// Report of a stop.
#[derive(Debug, Serialize, JsonSchema)]
pub struct StopReport {
    #[serde(flatten)]
    done: SetReport,
    /// Position of the axes at rest.
    position: Position,
}

impl CommonReport for StopReport {
    type Core = SetReport;

    fn core(&self) -> SetReport {
        self.done.clone()
    }
}

impl Report for StopReport {
    fn view(&self) -> View {
        self.done.view()
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};
    use armctl_frame::failure::Kind;

    #[test]
    fn a_command_ends_when_the_status_shows_its_effect() {
        let (mut bench, _) = Bench::with_faults("", |_, _| Fault::None);
        for (words, field, value) in [
            (["servo", "off"], "servo_on", false.into()),
            (["servo", "on"], "servo_on", true.into()),
            (["mode", "program"], "controller_mode", "program".into()),
            (["mode", "auto"], "controller_mode", "automatic".into()),
            (["mode", "palletizing"], "program_kind", "palletizing".into()),
            (["mode", "sequential"], "program_kind", serde_json::Value::from("sequential")),
        ] {
            bench.data(&words);
            assert_eq!(bench.data(&["status"])[field], value, "{words:?}");
        }
    }

    #[test]
    fn an_accepted_order_without_effect_fails() {
        let (mut bench, _) =
            Bench::with_faults("", |block, _| if block == "@MPLE" { Fault::Answered("@OK") } else { Fault::None });
        let failure = bench.run(&["mode", "palletizing"]).unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert_eq!(failure.message, "the controller accepted the command, but the mode did not change within 1s");
        assert!(failure.hint.unwrap().contains("M10"));
    }

    #[test]
    fn an_accepted_order_without_status_has_an_unknown_outcome() {
        let loses_status =
            |block: &str, count| if block == "@STAS SNO=3" && count > 1 { Fault::Lost } else { Fault::None };
        let failure = Bench::with_faults("", loses_status).0.run(&["servo", "off"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown);
        assert!(failure.message.starts_with("the command was accepted, but its result is unknown: "));
        let busy = |block: &str, count| {
            if block == "@STAS SNO=3" && count < 4 { Fault::Answered("@NG") } else { Fault::None }
        };
        Bench::with_faults("", busy).0.data(&["servo", "off"]);
    }

    #[test]
    fn a_stop_ends_a_return_to_origin() {
        let (mut bench, received) = Bench::with_faults("position = [300.0, 0.0, 0.0, 0.0]\n", |_, _| Fault::None);
        bench.data(&["home", "--no-wait"]);
        bench.wait(std::time::Duration::from_secs(2));
        assert!(bench.data(&["stop"])["position"]["x_mm"].as_f64().unwrap() < -10.0);
        assert_eq!(bench.data(&["status"])["running"], false);
        // The status shows execution, so a jog is also stopped in the same round.
        let received = received.borrow();
        let stop = received.iter().position(|block| block == "@STOP").unwrap();
        assert_eq!(received[stop + 1..stop + 3], ["@STAS SNO=0", "@JGST X=SP Y=SP Z=SP R=SP"]);
    }

    #[test]
    fn stop_of_an_abandoned_jog_takes_the_host_only_if_refused() {
        let (mut bench, received) = Bench::with_faults("host = true\n", |_, _| Fault::None);
        bench.run_and_abandon(&["jog", "X", "+", "low", "--for", "60s"], std::time::Duration::from_secs(1));
        bench.data(&["stop", "--jog"]);
        assert_eq!(bench.data(&["status"])["running"], false);
        assert!(!received.borrow().iter().any(|block| block == "@HSON"));

        // Another client jogs. On this controller, JOG needs the host, and does not stop without it.
        let (mut bench, received) = Bench::with_faults("", |block, count| {
            if block.starts_with("@JGST") && count == 1 { Fault::Answered("@NG") } else { Fault::None }
        });
        bench.data(&["stop", "--jog"]);
        assert_eq!(received.borrow().iter().filter(|block| *block == "@HSON").count(), 1);
    }

    #[test]
    fn if_stop_does_not_end_a_jog_the_jog_stop_follows() {
        let ignores_stop = |block: &str, _| if block == "@STOP" { Fault::Answered("@OK") } else { Fault::None };
        let (mut bench, _) = Bench::with_faults("host = true\n", ignores_stop);
        bench.run_and_abandon(&["jog", "X", "+", "low", "--for", "60s"], std::time::Duration::from_secs(1));
        bench.data(&["stop"]);
        assert_eq!(bench.data(&["status"])["running"], false);
    }

    #[test]
    fn an_abandoned_jog_is_stopped_before_the_first_position_read() {
        let jog = "@JGST X=SP Y=SP Z=SP R=SP";
        for refuses in [false, true] {
            // STOP does not stop the jog. The host is OFF, so the first stop of the jog is refused.
            let (mut bench, received) = Bench::with_faults("host = true\n", move |block, count| match block {
                "@STOP" => Fault::Answered("@OK"),
                "@STAS SNO=2" if refuses && count == 1 => Fault::Answered("@STAS SNO=2 ST1=00 ST2=00"),
                _ if block == jog && refuses && count == 1 => Fault::Answered("@NG"),
                _ => Fault::None,
            });
            bench.run_and_abandon(&["jog", "X", "+", "low", "--for", "60s"], std::time::Duration::from_secs(1));
            received.borrow_mut().clear();
            bench.data(&["stop"]);
            assert_eq!(bench.data(&["status"])["running"], false);
            let received = received.borrow();
            let of = |block: &str| received.iter().position(|other| other == block).unwrap();
            assert!(of("@STOP") < of(jog) && of(jog) < of("@MPST"), "{received:#?}");
            let last = received.iter().rposition(|block| block == jog).unwrap();
            assert!(last < of("@MPST"), "the last jog stop precedes the first position read: {received:#?}");
        }
    }
}

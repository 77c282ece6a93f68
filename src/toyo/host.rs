//! Command `toyo host on|off`: takes or releases host control.

use super::control_commands::no_effect;
use super::wait::wait_for_status;
use crate::prelude::*;
use armctl_frame::settings_report::Switch;

/// Switch the host ON or OFF permanently.
///
/// Other commands do not need `host on`: they switch the host ON by themselves and then restore the previous state.
#[derive(Debug, Args)]
pub struct Host {
    /// `on`: the host has control and the start input is disabled; `off`: the start input has control
    #[arg(value_name = "on|off")]
    to: Switch,
}

impl Command for Host {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = "toyo.host";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let (command, is_on, done) = match self.to {
            Switch::On => (table::Command::Hson, true, "the host has control; the start input is disabled"),
            Switch::Off => (table::Command::Hsof, false, "the start input has control; the host is OFF"),
        };
        let old = Old::read(context.link.status_before(2).await?.map(Status::host_on));
        let ordered = context.link.ask(&Request::bare(command)).await;
        // If the answer was lost, the status shows whether the command was executed.
        ordered.map(|_| ()).or_else(
            |failure| {
                if failure.kind == Kind::OutcomeUnknown { Ok(()) } else { Err(failure) }
            },
        )?;
        context.link.choose_host(is_on);
        if wait_for_status(context.link, (2, "whether the host has switched"), |status| status.host_on() == is_on)
            .await?
        {
            return Ok(NewValue::of("host_on", is_on, done).replaces(old));
        }
        Err(no_effect("the host").hint("use `toyo status` to see whether the host is ON"))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};

    #[test]
    fn the_status_shows_the_outcome_of_an_unanswered_order() {
        let lost = |fault| move |block: &str, _| if block == "@HSON" { fault } else { Fault::None };
        // The command was executed, and the status confirms it.
        assert_eq!(Bench::with_faults("", lost(Fault::Unanswered)).0.data(&["host", "on"])["new"], true);
        let (mut bench, received) = Bench::with_faults("origin = true\n", lost(Fault::Unanswered));
        bench.data(&["counter", "set", "1", "5"]);
        bench.close().unwrap();
        assert_eq!(received.borrow().iter().filter(|block| *block == "@HSON").count(), 1);
        assert_eq!(received.borrow().last().unwrap(), "@HSOF", "it was taken, and is given back");
        let lost_end = |block: &str, _| if block == "@HSOF" { Fault::Unanswered } else { Fault::None };
        let (mut bench, received) = Bench::with_faults("origin = true\n", lost_end);
        bench.data(&["counter", "set", "1", "5"]);
        bench.close().unwrap();
        assert_eq!(received.borrow()[received.borrow().len() - 2..], ["@HSOF", "@STAS SNO=2"]);
        // The controller did not receive the command, and the client sent nothing else that changes something.
        let (mut bench, received) = Bench::with_faults("origin = true\n", lost(Fault::Lost));
        let failure = bench.run(&["home"]).unwrap_err();
        assert!(failure.message.starts_with("the command was not sent: "), "{failure}");
        assert!(!received.borrow().iter().any(|block| block == "@HOME"));
    }

    #[test]
    fn with_pendant_on_commands_that_need_no_host_are_sent() {
        let (mut bench, received) = Bench::with_faults("pendant = true\n", |_, _| Fault::None);
        bench.data(&["counter", "set", "1", "5"]);
        assert!(received.borrow().iter().any(|block| block.starts_with("@MCST")));
        assert!(bench.run(&["home"]).unwrap_err().message.contains("the teach pendant is ON"));
        assert!(!received.borrow().iter().any(|block| block == "@HOME" || block == "@HSON"));
    }

    #[test]
    fn the_host_keeps_its_state_after_the_command() {
        let mut bench = Bench::new("sim:");
        bench.data(&["host", "on"]);
        assert_eq!(bench.data(&["status"])["host_on"], true);
        bench.data(&["host", "off"]);
        assert_eq!(bench.data(&["status"])["host_on"], false);
    }
}

//! `toyo host on|off`: who commands the controller.

use clap::Args;

use super::link::Toyo;
use super::orders::not_so;
use super::waiting::becomes;
use crate::command::frame::orders::{Done, New, Old, Switch};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table;
use crate::failure::Failure;

/// Switches the host ON or OFF, and leaves it so.
///
/// Other commands need no `host on`: they take the host and give it back as they found it.
#[derive(Debug, Args)]
pub struct Host {
    /// on: the host commands, the start input does not; off: the other way round
    #[arg(value_name = "on|off")]
    to: Switch,
}

impl Command for Host {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.host";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let (command, is_on, done) = match self.to {
            Switch::On => (table::Command::Hson, true, "the host commands; the start input does not"),
            Switch::Off => (table::Command::Hsof, false, "the start input commands again; the host does not"),
        };
        let old = Old::read(context.link.status_before(2).await?.map(Status::host_on));
        context.link.ask(&Request::bare(command)).await?;
        context.link.choose_host(is_on);
        if becomes(context.link, (2, "whether it is"), |status| status.host_on() == is_on).await? {
            return Ok(New::of("host_on", is_on, done).replaces(old));
        }
        Err(not_so("the host").hint("`toyo status` tells who commands"))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{Bench, all_blocks, blocks, intent, objection};

    #[test]
    fn the_order_goes_out_alone() {
        assert_eq!(all_blocks(&["host", "on"]).unwrap(), ["@HSON", "@STAS SNO=2"]);
        assert_eq!(blocks(&["position"]).unwrap(), ["@SYSP", "@RPAR E01", "@MPST"]);
        assert!(objection(&["host", "maybe"]).contains("maybe"));
        assert_eq!(intent(&["host", "off"]), "");
    }

    #[test]
    fn the_host_stays_as_it_was_switched() {
        let mut bench = Bench::new("sim:");
        bench.data(&["host", "on"]);
        assert_eq!(bench.data(&["status"])["host_on"], true);
        bench.data(&["host", "off"]);
        assert_eq!(bench.data(&["status"])["host_on"], false);
    }
}

//! `toyo card read|write`: the memory card.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::waiting::{Accepted, Work};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::gate::Demand;
use crate::output::view::{Cell, Tone, View};

commands! {
    /// The memory card.
    pub enum Card of Family {
        /// Read everything from the card, over what the controller holds
        Read(Read),
        /// Write everything that the controller holds to the card
        Write(Write),
    }
}

/// Reads everything from the memory card, and waits until it is done (TO 2-3).
#[derive(Debug, Args)]
pub struct Read {
    /// Return as soon as the controller has accepted it
    #[arg(long)]
    no_wait: bool,
}

/// Writes everything to the memory card, over what is on it, and waits until it is done (TO 2-3).
#[derive(Debug, Args)]
pub struct Write {
    /// Return as soon as the controller has accepted it
    #[arg(long)]
    no_wait: bool,
}

impl Command for Read {
    type Family = Family;
    type Report = Transferred;
    const ID: &'static str = "toyo.card.read";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    fn intent(&self) -> String {
        "replace programs, tables and parameters of the controller by those on the memory card".to_owned()
    }

    fn demand(&self) -> Demand {
        Demand::Flag("programs, tables and parameters of the controller are replaced by those on the card".to_owned())
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Transferred, Failure> {
        let work = Accepted {
            work: Work::Card,
            order: table::Command::Rmca,
            done: "reading the card was accepted",
            doing: "reading the card",
        };
        transfer(context, work, self.no_wait).await
    }
}

impl Command for Write {
    type Family = Family;
    type Report = Transferred;
    const ID: &'static str = "toyo.card.write";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Transferred, Failure> {
        let work = Accepted {
            work: Work::Card,
            order: table::Command::Wmca,
            done: "writing the card was accepted",
            doing: "writing the card",
        };
        transfer(context, work, self.no_wait).await
    }
}

async fn transfer(context: Context<'_, Family>, work: Accepted, no_wait: bool) -> Result<Transferred, Failure> {
    let link = context.link;
    link.order(&Request::bare(work.order)).await?;
    if no_wait {
        return Ok(Transferred { accepted: true, elapsed_ms: None, needs_power_cycle: None });
    }
    let end = work.wait(link, context.screen).await?;
    let needs_power_cycle = link.status_of(&[0]).await?.needs_power_cycle();
    Ok(Transferred { accepted: true, elapsed_ms: Some(end.elapsed_ms), needs_power_cycle: Some(needs_power_cycle) })
}

/// What became of a transfer.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Transferred {
    /// The controller took the order.
    accepted: bool,
    /// From the acceptance to the end; null if nobody waited.
    elapsed_ms: Option<u64>,
    /// Parameter 2 was changed: nothing is executed until the power was off; null if nobody waited.
    needs_power_cycle: Option<bool>,
}

impl Report for Transferred {
    fn view(&self) -> View {
        let Some(ms) = self.elapsed_ms else { return View::fields([("memory card", "started".into())]) };
        let due = if self.needs_power_cycle == Some(true) { Cell::from("yes").tone(Tone::Bad) } else { "no".into() };
        View::fields([
            ("memory card", Cell::from("done").tone(Tone::Good)),
            ("power cycle due", due),
            ("elapsed (ms)", ms.into()),
        ])
    }
}

//! `toyo card read|write`: the memory card.

use super::wait::{AcceptedWork, Work};
use crate::prelude::*;
use armctl_frame::wait_arguments::MotionEnd;

commands! {
    /// Commands for the memory card.
    pub enum Card {
        /// Restore the controller from the memory card
        Read(Read),
        /// Save the controller to the memory card
        Write(Write),
    }
}

/// Read everything from the memory card, and wait for the end (TO 2-3).
#[derive(Debug, Args)]
pub struct Read {
    #[command(flatten)]
    end: MotionEnd,
}

/// Write everything to the memory card, and wait for the end (TO 2-3). This replaces the content of the card.
#[derive(Debug, Args)]
pub struct Write {
    #[command(flatten)]
    end: MotionEnd,
}

impl Command for Read {
    type Family = Toyo;
    type Report = TransferReport;
    const ID: &'static str = "toyo.card.read";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str =
        "replace programs, tables and parameters of the controller with the content of the memory card";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<TransferReport> {
        let work = AcceptedWork {
            work: Work::Card,
            order: table::Command::Rmca,
            done: "the controller accepted the card read",
            doing: "reading the card",
        };
        transfer(context, work, self.end.no_wait()).await
    }
}

impl Command for Write {
    type Family = Toyo;
    type Report = TransferReport;
    const ID: &'static str = "toyo.card.write";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite the content of the memory card";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<TransferReport> {
        let work = AcceptedWork {
            work: Work::Card,
            order: table::Command::Wmca,
            done: "the controller accepted the card write",
            doing: "writing the card",
        };
        transfer(context, work, self.end.no_wait()).await
    }
}

async fn transfer(context: Context<'_, Toyo>, work: AcceptedWork, no_wait: bool) -> Result<TransferReport> {
    let link = context.link;
    link.ask(&Request::bare(work.order)).await?;
    if no_wait {
        return Ok(TransferReport { accepted: true, elapsed_ms: None, needs_power_cycle: None });
    }
    let Some(end) = work.wait(link, context.screen, Letters::UNKNOWN).await.known()? else {
        link.status_of(&[0]).await?;
        return Err(unknown());
    };
    let needs_power_cycle = link.status_of(&[0]).await?.needs_power_cycle();
    Ok(TransferReport { accepted: true, elapsed_ms: end.elapsed_ms, needs_power_cycle: Some(needs_power_cycle) })
}

/// Report of a transfer from or to the card.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TransferReport {
    /// Whether the controller accepted the command.
    accepted: bool,
    /// Time from acceptance to end. Null if the command did not wait, or if the transfer ended before the first read.
    elapsed_ms: Option<u64>,
    /// Whether parameter 2 changed, so that the controller executes nothing before a restart. Null if the command did
    /// not wait.
    needs_power_cycle: Option<bool>,
}

impl Report for TransferReport {
    fn view(&self) -> View {
        let due = match self.needs_power_cycle {
            None => return View::fields([("memory card", "started".into())]),
            Some(true) => Cell::from("due").tone(Tone::Bad),
            Some(false) => "not due".into(),
        };
        View::fields([
            ("memory card", Cell::from("done").tone(Tone::Good)),
            ("power cycle", due),
            ("elapsed (ms)", Cell::optional(self.elapsed_ms)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};
    use armctl_frame::failure::Kind;

    #[test]
    fn card_write_waits_for_the_end_of_the_transfer() {
        let (mut bench, _) = Bench::with_faults("card = \"empty\"\n", |_, _| Fault::None);
        let failure = bench.run(&["card", "read"]).unwrap_err();
        assert!(failure.hint.unwrap().contains("check that the card contains data"));
        let data = bench.data(&["card", "write"]);
        let elapsed = data["elapsed_ms"].as_u64().unwrap();
        assert!((1800..2300).contains(&elapsed), "{elapsed}");
        assert_eq!(data["needs_power_cycle"], false);
        assert_eq!(bench.data(&["card", "read"])["accepted"], true);
    }

    #[test]
    fn an_absent_or_removed_card_is_an_error() {
        let failure = Bench::with_faults("", |_, _| Fault::None).0.run(&["card", "write"]).unwrap_err();
        assert_eq!(failure.message, "the controller refused WMCA (@NG): there is no memory card");
        let state = "card = \"written\"\n[[event]]\nat_ms = 1000\ndo = \"card out\"\n";
        let failure = Bench::with_faults(state, |_, _| Fault::None).0.run(&["card", "read"]).unwrap_err();
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("E0")));
        assert!(
            failure.message.starts_with("the controller accepted the card read, but an error occurred (E0"),
            "{}",
            failure.message
        );
    }
}

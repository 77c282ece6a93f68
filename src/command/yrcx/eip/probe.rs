//! `yrcx eip probe`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::{self, Probed, warned};
use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::{Failure, Kind};
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, Table, View};

/// Finds out what the board has: reads every assembly from 1 to 255, then asks for connections with sizes that no assembly
/// has, beginning with the instances of the URL.
#[derive(Debug, Args)]
#[command(
    after_help = "The board refuses those connections and says why, which tells instances and sizes. The target that \
                        comes out of it is for -t or `armctl robots add`."
)]
pub struct Probe {}

impl Command for Probe {
    type Family = Yrcx;
    type Report = ProbeReport;
    const ID: &'static str = "yrcx.eip.probe";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<ProbeReport, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context
            .link
            .then("messages that ask the board who it is, for its assemblies, and for connections that it refuses");
        let board = board_of(context.link)?;
        let identity = board.identity().await?;
        let probed = board.probe(identity.as_ref()).await?;
        Ok(ProbeReport { identity, probed })
    }
}

/// What a board has.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    /// Null where it does not say.
    identity: Option<board::Identity>,
    #[serde(flatten)]
    probed: Probed,
}

impl Report for ProbeReport {
    fn rows(&self) -> RowsOf {
        RowsOf::List("assemblies")
    }

    fn view(&self) -> View {
        let mut view = match &self.identity {
            Some(identity) => View::default().and(Section::Fields(identity.fields())),
            None => View::text("the board does not say who it is"),
        };
        let mut assemblies = Table::new(&["assembly", "bytes"], "no assembly can be read");
        for assembly in &self.probed.assemblies {
            assemblies.row([assembly.instance.into(), Cell::maybe(assembly.bytes)]);
        }
        let mut attempts = Table::new(&["in", "out", "config", "answer"], "no connection was asked for");
        for attempt in &self.probed.attempts {
            let config = Cell::maybe(attempt.config);
            attempts.row([attempt.input.into(), attempt.output.into(), config, attempt.answer.as_str().into()]);
        }
        view = view.and(Section::Table(assemblies)).and(Section::Table(attempts));
        let Some(found) = &self.probed.connectable else { return view };
        let bytes = |size: Option<u16>| Cell::maybe(size.map(|size| format!("{size} bytes")));
        let owner = if self.probed.owned { warned("another master, at present") } else { "free".into() };
        view.and(Section::Fields(vec![
            ("from the controller", bytes(found.in_size)),
            ("to the controller", bytes(found.out_size)),
            ("owner", owner),
            ("target", found.target.as_str().into()),
        ]))
    }

    fn failure(&self) -> Option<Failure> {
        self.probed.connectable.is_none().then(|| {
            Failure::new(Kind::ConditionNotMet, "no connection fits that board")
                .hint("its EDS file names the instances; write them into the URL as in, out and config")
        })
    }
}

//! `yrcx eip probe`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::{self, Probed, warned};
use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::controller::Risk;
use crate::failure::{Failure, Kind};
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, Table, View};

/// Finds out what the board has: reads every assembly from 1 to 255. No connection is asked for.
#[derive(Debug, Args)]
#[command(
    after_help = "The target that comes out of it is for -t or `armctl robots add`.\n\nWith --try it also asks for owner \
                        connections with sizes that no assembly has, beginning with the instances of the URL. The board \
                        refuses them and says why, which tells instances and sizes. A board that accepts one is commanded \
                        by this program until it is closed, and its end stops the robot."
)]
pub struct Probe {
    /// Ask for connections until one would fit
    #[arg(long = "try")]
    tries: bool,
}

impl Command for Probe {
    type Family = Yrcx;
    type Report = ProbeReport;
    const ID: &'static str = "yrcx.eip.probe";
    const INTENT: &'static str = "ask the board for owner connections that it should refuse; a board that accepts one is \
                                  commanded by this program, and the end of the connection stops the robot";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        // A board can accept a connection that it should refuse.
        if self.tries { Risk::Motion } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<ProbeReport, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("messages that ask the board who it is, and for its assemblies");
        if self.tries {
            context.link.then("requests for owner connections (ForwardOpen) with sizes that no assembly has");
            context.link.authorize(Self::ID, self.risk())?;
        }
        let board = board_of(context.link)?;
        let identity = board.identity().await?;
        let probed =
            if self.tries { board.probe(identity.as_ref()).await? } else { board.survey(identity.as_ref()).await? };
        Ok(ProbeReport { identity, probed, has_tried: self.tries })
    }
}

/// What a board has.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    /// Null where it does not say.
    identity: Option<board::Identity>,
    #[serde(flatten)]
    probed: Probed,
    #[serde(skip)]
    has_tried: bool,
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
        view = view.and(Section::Table(assemblies));
        if self.has_tried {
            view = view.and(Section::Table(attempts));
        }
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
            let failure = Failure::new(Kind::ConditionNotMet, "no connection fits that board");
            if self.has_tried {
                failure.hint("its EDS file names the instances; write them into the URL as in, out and config")
            } else {
                failure.hint("add --try to ask the board for connections, when nobody is in the cell")
            }
        })
    }
}

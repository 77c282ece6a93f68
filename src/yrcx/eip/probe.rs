//! `yrcx eip probe`.

use super::board::{Board, Identity, ProbeResult, warning_cell};
use crate::prelude::*;

/// Finds the assemblies of the board: armctl reads every assembly from 1 to 255. It requests no connection.
#[derive(Debug, Args)]
#[command(
    after_help = "Use the resulting target with -t or `armctl robots add`.\n\nWith --try, armctl also requests owner \
                  connections with invalid sizes, starting with the instances of the URL. The board refuses these \
                  connections with a reason that identifies instances and sizes. If the board accepts a connection, \
                  armctl commands the controller until the connection closes. Closing it stops the robot."
)]
pub struct Probe {
    /// Request connections to find the parameters that the board accepts
    #[arg(long = "try")]
    tries: bool,
}

impl Command for Probe {
    type Family = Yrcx;
    type Report = ProbeReport;
    const ID: &'static str = "yrcx.eip.probe";
    const INTENT: &'static str = "request owner connections that the board should refuse; if the board accepts a \
                                  connection, armctl commands the controller, and the end of the connection stops the \
                                  robot";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    fn risk(&self) -> Risk {
        // With --try, a board may accept a connection that it should refuse.
        if self.tries { Risk::Motion } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<ProbeReport> {
        context.link.reject_unit_of::<Board>()?;
        context.link.then("messages that read the identity and the assemblies of the board");
        if self.tries {
            context.link.then("requests for owner connections (ForwardOpen) with invalid sizes");
            context.link.authorize(Self::ID, self.risk())?;
        }
        let board: &mut Board = context.link.board()?;
        let identity = board.identity().await?;
        let probed =
            if self.tries { board.probe(identity.as_ref()).await? } else { board.survey(identity.as_ref()).await? };
        Ok(ProbeReport { identity, probed, has_tried: self.tries })
    }
}

/// Result of the probe.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    /// Identity of the board; null if the board does not report it.
    identity: Option<Identity>,
    #[serde(flatten)]
    probed: ProbeResult,
    #[serde(skip)]
    has_tried: bool,
}

impl Report for ProbeReport {
    const ROWS: RowsOf = RowsOf::List("assemblies");

    fn view(&self) -> View {
        let mut view = match &self.identity {
            Some(identity) => View::default().append(Section::Fields(identity.fields())),
            None => View::text("the board has no identity"),
        };
        let mut assemblies = Table::new(&["assembly", "bytes"], "no readable assembly");
        for assembly in &self.probed.assemblies {
            assemblies.row([assembly.instance.into(), Cell::optional(assembly.bytes)]);
        }
        let mut attempts = Table::new(&["in", "out", "config", "answer"], "no connection was requested");
        for attempt in &self.probed.attempts {
            let config = Cell::optional(attempt.config);
            attempts.row([attempt.input.into(), attempt.output.into(), config, attempt.answer.as_str().into()]);
        }
        view = view.append(Section::Table(assemblies));
        if self.has_tried {
            view = view.append(Section::Table(attempts));
        }
        let Some(found) = &self.probed.connectable else { return view };
        let bytes = |size: Option<u16>| Cell::optional(size.map(|size| format!("{size} bytes")));
        let owner = if self.probed.owned { warning_cell("another master") } else { "free".into() };
        view.append(Section::Fields(vec![
            ("from the controller", bytes(found.in_size)),
            ("to the controller", bytes(found.out_size)),
            ("owner", owner),
            ("target", found.target.as_str().into()),
        ]))
    }

    fn failure(&self) -> Option<Failure> {
        self.probed.connectable.is_none().then(|| {
            let failure = Failure::new(Kind::ConditionNotMet, "no connection parameters found for the board");
            if self.has_tried {
                failure
                    .hint("find the instances in the board's EDS file and set `in=`, `out=` and `config=` in the URL")
            } else {
                failure
                    .hint("add --try to request connections from the board, but only when the cell is clear of people")
            }
        })
    }
}

//! `yrcx profibus diag`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::Failure;
use crate::output::view::{Cell, Section, View};

/// Asks the station how it is doing (Slave_Diag), and tells all of it: the state, and what the unit says beyond that of
/// itself, its modules and channels. It is not owned, and nothing changes.
#[derive(Debug, Args)]
pub struct Diag {}

impl Command for Diag {
    type Family = Yrcx;
    type Report = Diagnosed;
    const ID: &'static str = "yrcx.profibus.diag";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Diagnosed, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("telegrams that ask the station for its state, diagnosis and configuration");
        let board = board_of(context.link)?;
        let diagnosis = board.diagnosis().await?;
        Ok(Diagnosed {
            station: board.settings().station,
            ident: format!("{:#06x}", diagnosis.ident),
            master: diagnosis.master,
            states: diagnosis.words().collect(),
            blocks: diagnosis.blocks.iter().map(ToString::to_string).collect(),
        })
    }
}

/// How a station is doing.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Diagnosed {
    /// Its address.
    station: u8,
    /// Which kind of slave it is, such as 0x1234.
    ident: String,
    /// The master that it belongs to; null where it has none.
    master: Option<u8>,
    /// What the flags of the standard say, those that are set.
    states: Vec<&'static str>,
    /// What it says beyond that, a block each, in its order.
    blocks: Vec<String>,
}

impl Report for Diagnosed {
    fn view(&self) -> View {
        let mut fields = vec![
            ("station", self.station.into()),
            ("ident", self.ident.as_str().into()),
            ("master", Cell::maybe(self.master)),
            ("state", Cell::maybe((!self.states.is_empty()).then(|| self.states.join(", ")))),
        ];
        fields.extend(self.blocks.iter().map(|block| ("block", block.as_str().into())));
        View::default().and(Section::Fields(fields))
    }
}

//! `yrcx profibus diag`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::Failure;
use armctl_frame::output::view::{Cell, Section, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Reads the diagnosis of the station (Slave_Diag): state, and the diagnostic blocks of the unit, its modules and
/// channels. The station is not locked and nothing changes.
#[derive(Debug, Args)]
pub struct Diag {}

impl Command for Diag {
    type Family = Yrcx;
    type Report = Diagnosed;
    const ID: &'static str = "yrcx.profibus.diag";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Diagnosed, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("telegrams that read state, diagnosis and configuration of the station");
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

/// Diagnosis of a station.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Diagnosed {
    /// Station address.
    station: u8,
    /// Ident number, such as 0x1234.
    ident: String,
    /// Master of the slave; null if it has none.
    master: Option<u8>,
    /// Standard diagnosis flags that are set.
    states: Vec<&'static str>,
    /// Extended diagnosis, one entry per block, in the order received.
    blocks: Vec<String>,
}

impl Report for Diagnosed {
    fn view(&self) -> View {
        let mut fields = vec![
            ("station", self.station.into()),
            ("ident", self.ident.as_str().into()),
            ("master", Cell::optional(self.master)),
            ("state", Cell::optional((!self.states.is_empty()).then(|| self.states.join(", ")))),
        ];
        fields.extend(self.blocks.iter().map(|block| ("block", block.as_str().into())));
        View::default().append(Section::Fields(fields))
    }
}

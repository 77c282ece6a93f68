//! `yrcx profibus scan`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Station;
use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::Failure;
use armctl_frame::output::view::{Cell, Table, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Asks every address of the line for its state when no other master is active. No station is locked and nothing
/// changes.
#[derive(Debug, Args)]
pub struct Scan {}

impl Command for Scan {
    type Family = Yrcx;
    type Report = Stations;
    const ID: &'static str = "yrcx.profibus.scan";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Stations, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("telegrams that read the state of every station, and diagnosis and configuration of slaves");
        Ok(Stations { stations: board_of(context.link)?.scan().await? })
    }
}

/// Stations that answered.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stations {
    /// Stations in the order of their addresses.
    stations: Vec<Station>,
}

impl Report for Stations {
    fn view(&self) -> View {
        let columns = ["station", "kind", "ident", "master", "configuration", "diagnosis"];
        let mut table = Table::new(&columns, "no station answered: check baud, wires A and B, and the terminators");
        for station in &self.stations {
            table.row([
                station.station.into(),
                station.kind.into(),
                Cell::optional(station.ident.clone()),
                Cell::optional(station.master),
                Cell::optional(station.configuration.clone()),
                station.diagnosis.as_str().into(),
            ]);
        }
        View::table(table)
    }
}

//! `yrcx profibus scan`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Station;
use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::Failure;
use crate::output::view::{Cell, Table, View};

/// Asks every address of the line who is there, once nobody else speaks. Nobody is owned, and nothing changes.
#[derive(Debug, Args)]
pub struct Scan {}

impl Command for Scan {
    type Family = Yrcx;
    type Report = Stations;
    const ID: &'static str = "yrcx.profibus.scan";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Stations, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("telegrams that ask every station for its state, and slaves for diagnosis and configuration");
        Ok(Stations { stations: board_of(context.link)?.scan().await? })
    }
}

/// Who answers.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stations {
    /// In the order of their addresses.
    stations: Vec<Station>,
}

impl Report for Stations {
    fn view(&self) -> View {
        let columns = ["station", "kind", "ident", "master", "configuration", "diagnosis"];
        let mut table = Table::new(&columns, "no station answers: check baud, A and B, and the terminators");
        for station in &self.stations {
            table.row([
                station.station.into(),
                station.kind.into(),
                Cell::maybe(station.ident.clone()),
                Cell::maybe(station.master),
                Cell::maybe(station.configuration.clone()),
                station.diagnosis.as_str().into(),
            ]);
        }
        View::table(table)
    }
}

//! `yrcx profibus scan`.

use super::board::{Board, Station};
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Stations that answered a request for their state. No other master is active then.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stations {
    /// Stations in the order of their addresses.
    stations: Vec<Station>,
}

impl BoardReport for Stations {
    type Board = Board;
    const ID: &'static str = "yrcx.profibus.scan";
    const MESSAGES: &'static str =
        "telegrams that read the state of every station, and diagnosis and configuration of slaves";

    async fn read(board: &mut Board) -> Result<Self> {
        Ok(Self { stations: board.scan().await? })
    }
}

impl Report for Stations {
    fn view(&self) -> View {
        let columns = ["station", "kind", "ident", "master", "configuration", "diagnosis"];
        let mut table = Table::new(&columns, "no station answered: check `baud=`, wires A and B, and the terminators");
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

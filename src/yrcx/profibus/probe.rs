//! `yrcx profibus probe`.

use super::board::{Board, Station};
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Identity, diagnosis and configuration of the station (Slave_Diag, Get_Cfg).
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProbeReport {
    #[serde(flatten)]
    station: Station,
}

impl BoardReport for ProbeReport {
    type Board = Board;
    const ID: &'static str = "yrcx.profibus.probe";
    const MESSAGES: &'static str = "telegrams that read state, diagnosis and configuration of the station";

    async fn read(board: &mut Board) -> Result<Self> {
        let (station, _) = board.station().await?.ok_or_else(|| board.silent())?;
        Ok(Self { station })
    }
}

impl Report for ProbeReport {
    fn view(&self) -> View {
        View::default().append(Section::Fields(self.station.fields()))
    }

    fn failure(&self) -> Option<Failure> {
        (!self.station.fits()).then(|| {
            Failure::new(Kind::ConditionNotMet, "the image size is not 48 bytes each way").hint(
                "check `station=` in the URL; if the slave does not report its configuration, set `cfg=` or `gsd=`",
            )
        })
    }
}

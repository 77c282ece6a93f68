//! `yrcx profibus diag`.

use super::board::Board;
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Diagnosis of a station (Slave_Diag): its state, and the blocks of the unit, its modules and channels.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DiagnosisReport {
    /// Address of the station.
    station: u8,
    /// Ident number, for example 0x1234.
    ident: String,
    /// Address of the slave's master; null if the slave has no master.
    master: Option<u8>,
    /// Flags of the standard diagnosis that are set.
    states: Vec<&'static str>,
    /// Extended diagnosis, one entry per block, in the order received.
    blocks: Vec<String>,
}

impl BoardReport for DiagnosisReport {
    type Board = Board;
    const ID: &'static str = "yrcx.profibus.diag";
    const MESSAGES: &'static str = "telegrams that read state, diagnosis and configuration of the station";

    async fn read(board: &mut Board) -> Result<Self> {
        let diagnosis = board.diagnosis().await?;
        Ok(Self {
            station: board.profibus.station,
            ident: format!("{:#06x}", diagnosis.ident),
            master: diagnosis.master,
            states: diagnosis.flag_texts().collect(),
            blocks: diagnosis.blocks.iter().map(ToString::to_string).collect(),
        })
    }
}

impl Report for DiagnosisReport {
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

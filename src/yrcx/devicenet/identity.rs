//! `yrcx devicenet identity`.

use super::board::{Board, Identity};
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Identity of the node. Its connections are allocated for the request and released; no polls are sent.
#[derive(Debug, Serialize, JsonSchema)]
pub struct IdentityReport {
    #[serde(flatten)]
    identity: Identity,
}

impl BoardReport for IdentityReport {
    type Board = Board;
    const ID: &'static str = "yrcx.devicenet.identity";
    const MESSAGES: &'static str = "messages that read the identity of the node";

    async fn read(board: &mut Board) -> Result<Self> {
        Ok(Self { identity: board.identity().await? })
    }
}

impl Report for IdentityReport {
    fn view(&self) -> View {
        View::default().append(Section::Fields(self.identity.fields()))
    }
}

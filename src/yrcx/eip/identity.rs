//! `yrcx eip identity`.

use super::board::{Board, Identity};
use crate::board_report::BoardReport;
use crate::prelude::*;

/// Identity and services of the board (ListIdentity, ListServices).
#[derive(Debug, Serialize, JsonSchema)]
pub struct IdentityReport {
    /// TCP address of the board.
    address: String,
    #[serde(flatten)]
    identity: Identity,
    /// Services that the board lists; null if it lists none.
    services: Option<Vec<&'static str>>,
}

impl BoardReport for IdentityReport {
    type Board = Board;
    const ID: &'static str = "yrcx.eip.identity";
    const MESSAGES: &'static str = "messages that read the identity and the services of the board";

    async fn read(board: &mut Board) -> Result<Self> {
        let address = board.address().to_string();
        let Some(identity) = board.identity().await? else {
            return Err(Failure::new(Kind::Malformed, format!("{}: the board has no identity", board.label))
                .hint("check that the address belongs to an EtherNet/IP board"));
        };
        Ok(Self { address, identity, services: board.services().await? })
    }
}

impl Report for IdentityReport {
    fn view(&self) -> View {
        let services = self.services.as_ref().map_or_else(|| "-".to_owned(), |services| services.join(", "));
        let mut fields = vec![("address", self.address.as_str().into())];
        fields.extend(self.identity.fields());
        fields.push(("services", services.into()));
        View::default().append(Section::Fields(fields))
    }
}

//! `yrcx eip identity`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board;
use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::{Failure, Kind};
use crate::output::view::{Section, View};

/// Reads the identity and the services of the board (ListIdentity, ListServices).
#[derive(Debug, Args)]
pub struct Identify {}

impl Command for Identify {
    type Family = Yrcx;
    type Report = Identified;
    const ID: &'static str = "yrcx.eip.identity";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Identified, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("messages that read the identity and the services of the board");
        let board = board_of(context.link)?;
        let address = board.address().to_string();
        let Some(identity) = board.identity().await? else {
            return Err(Failure::new(Kind::Malformed, format!("{}: the board has no identity", context.robot.label()))
                .hint("check that the address belongs to an EtherNet/IP board"));
        };
        Ok(Identified { address, identity, services: board.services().await? })
    }
}

/// Identity and services of the board.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Identified {
    /// TCP address of the board.
    address: String,
    #[serde(flatten)]
    identity: board::Identity,
    /// Services that the board lists; null if it lists none.
    services: Option<Vec<&'static str>>,
}

impl Report for Identified {
    fn view(&self) -> View {
        let services = self.services.as_ref().map_or_else(|| "-".to_owned(), |services| services.join(", "));
        let mut fields = vec![("address", self.address.as_str().into())];
        fields.extend(self.identity.fields());
        fields.push(("services", services.into()));
        View::default().append(Section::Fields(fields))
    }
}

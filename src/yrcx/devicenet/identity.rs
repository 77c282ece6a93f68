//! `yrcx devicenet identity`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board;
use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::Failure;
use armctl_frame::output::view::{Section, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Reads the identity of the node. Its connections are allocated for the request and released; no polls are sent.
#[derive(Debug, Args)]
pub struct Identify {}

impl Command for Identify {
    type Family = Yrcx;
    type Report = Identified;
    const ID: &'static str = "yrcx.devicenet.identity";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Identified, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("messages that read the identity of the node");
        Ok(Identified { identity: board_of(context.link)?.identity().await? })
    }
}

/// Identity of the node.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Identified {
    #[serde(flatten)]
    identity: board::Identity,
}

impl Report for Identified {
    fn view(&self) -> View {
        View::default().append(Section::Fields(self.identity.fields()))
    }
}

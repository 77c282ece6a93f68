//! `yrcx profinet identify`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::station::Station;
use super::{NO_UNIT, board_of, plan_search};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::Failure;
use crate::output::view::{Section, View};

/// Asks the station who it is (DCP Identify). It needs no address for that, and is not connected.
#[derive(Debug, Args)]
#[command(after_help = "A station without a name is reached by its card, profinet://02:00:00:00:00:01@eth0; `armctl \
                        robots discover --interface eth0` lists all.")]
pub struct Identify {}

impl Command for Identify {
    type Family = Yrcx;
    type Report = Identified;
    const ID: &'static str = "yrcx.profinet.identify";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Identified, Failure> {
        context.link.no_unit(NO_UNIT)?;
        plan_search(context.link, context.robot)?;
        let found = board_of(context.link)?.station().await?;
        Ok(Identified { station: Station::from(&found) })
    }
}

/// Who answers.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Identified {
    #[serde(flatten)]
    station: Station,
}

impl Report for Identified {
    fn view(&self) -> View {
        View::default().and(Section::Fields(self.station.fields()))
    }
}

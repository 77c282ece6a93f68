//! `yrcx profibus probe`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Station;
use super::{NO_UNIT, board_of};
use crate::command::yrcx::link::Yrcx;
use crate::command::{Command, ConnectMode, Context, Report};
use crate::failure::{Failure, Kind};
use crate::output::view::{Section, View};

/// Asks the station who it is, how it is doing, and which configuration it wants (Slave_Diag, Get_Cfg). It is not owned, and
/// nothing changes.
#[derive(Debug, Args)]
pub struct Probe {}

impl Command for Probe {
    type Family = Yrcx;
    type Report = Probed;
    const ID: &'static str = "yrcx.profibus.probe";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Probed, Failure> {
        context.link.no_unit(NO_UNIT)?;
        context.link.then("telegrams that ask the station for its state, diagnosis and configuration");
        let board = board_of(context.link)?;
        let Some((station, _)) = board.station().await? else {
            let message = format!("{}: station {} does not answer", context.robot.label(), board.settings().station);
            return Err(Failure::new(Kind::NoAnswer, message).hint("`yrcx profibus scan` lists who answers"));
        };
        Ok(Probed { station })
    }
}

/// What a station says of itself.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Probed {
    #[serde(flatten)]
    station: Station,
}

impl Report for Probed {
    fn view(&self) -> View {
        View::default().and(Section::Fields(self.station.fields()))
    }

    fn failure(&self) -> Option<Failure> {
        (!self.station.fits()).then(|| {
            Failure::new(Kind::ConditionNotMet, "its images do not have the 48 bytes of a controller")
                .hint("check station of the URL; where the slave does not say, set cfg= or gsd=")
        })
    }
}

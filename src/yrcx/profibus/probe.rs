//! `yrcx profibus probe`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::board::Station;
use super::{NO_UNIT, board_of};
use crate::link::Yrcx;
use armctl_frame::failure::{Failure, Kind};
use armctl_frame::output::view::{Section, View};
use armctl_frame::{Command, ConnectMode, Context, Report};

/// Reads identity, diagnosis and configuration of the station (Slave_Diag, Get_Cfg). The station is not locked and
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
        context.link.then("telegrams that read state, diagnosis and configuration of the station");
        let board = board_of(context.link)?;
        let (station, _) = board.station().await?.ok_or_else(|| board.silent())?;
        Ok(Probed { station })
    }
}

/// Result of the probe.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Probed {
    #[serde(flatten)]
    station: Station,
}

impl Report for Probed {
    fn view(&self) -> View {
        View::default().append(Section::Fields(self.station.fields()))
    }

    fn failure(&self) -> Option<Failure> {
        (!self.station.fits()).then(|| {
            Failure::new(Kind::ConditionNotMet, "the image size is not 48 bytes each way")
                .hint("check station of the URL; if the slave does not report its configuration, set cfg= or gsd=")
        })
    }
}

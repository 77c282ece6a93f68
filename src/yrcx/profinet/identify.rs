//! `yrcx profinet identify`.

use super::board::Board;
use super::plan_search;
use super::station::Station;
use crate::prelude::*;

/// Reads the identity of the station (DCP Identify). The station needs no IP address, and armctl opens no connection.
#[derive(Debug, Args)]
#[command(after_help = "Use the MAC address for a station without a name: profinet://02:00:00:00:00:01@eth0. `armctl \
                        robots discover --interface eth0` lists all stations.")]
pub struct Identify {}

impl Command for Identify {
    type Family = Yrcx;
    type Report = IdentityReport;
    const ID: &'static str = "yrcx.profinet.identify";
    const CONNECT_MODE: ConnectMode = ConnectMode::Explicit;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<IdentityReport> {
        context.link.reject_unit_of::<Board>()?;
        plan_search(context.link, context.robot)?;
        let found = context.link.board::<Board>()?.station().await?;
        Ok(IdentityReport { station: Station::from(&found) })
    }
}

/// Identity of the station.
#[derive(Debug, Serialize, JsonSchema)]
pub struct IdentityReport {
    #[serde(flatten)]
    station: Station,
}

impl Report for IdentityReport {
    fn view(&self) -> View {
        View::default().append(Section::Fields(self.station.fields()))
    }
}

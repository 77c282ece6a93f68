//! Implementation of the family interface for `yerc`.

use super::alarm;
use super::commands::Commands;
use super::control_commands::Hold;
use super::decode::Decode;
use super::explain::Explain;
use super::file::{Restore, back_up};
use super::serve::Serve;
use super::top::Poller;
use super::{check, connect, overview, teach_panel};
use crate::prelude::*;
use armctl_controller::yerc::{read_only_filter, simulator, status};
use armctl_frame::backup::family_backup::Backups;
use armctl_frame::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use armctl_frame::face::{Declaration, Face, HeldLink, Layer, OverviewReport, Panel, Traffic};
use armctl_frame::robot::alarm::Alarm;
use armctl_transport::session::host::Guard;

/// The family for the rest of the program. It is a static, so this crate compiles the code of its commands.
pub static FACE: Face = Face::of::<Yerc>();

impl Declaration for Yerc {
    type Commands = Commands;
    type Decode = Decode;
    type Explain = Explain;
    type Alarms = alarm::List;
    type AlarmHistory = alarm::History;
    type AlarmReset = alarm::Reset;
    type Position = super::position::Position;
    type Stop = Hold;
    type Serve = Serve;
    type Start = simulator::Start;
    type Poller = Poller;

    const NAME: Family = Family::Yerc;
    const TITLE: &'static str = "Yaskawa FS100, DX100, DX200, YRC1000";
    const ABOUT: &'static str = "Yaskawa FS100, DX100, DX200 and YRC1000 over the high-speed Ethernet server (UDP)";
    const AFTER_HELP: &'static str = "Settings and first contact: `armctl help yerc-setup`.";
    const SETUP: (&'static str, &'static str) = ("settings of a Yaskawa controller", include_str!("setup.txt"));
    const UNSAVED: &'static [&'static str] = &["register"];
    const START_STATE: &'static str = simulator::EXAMPLE;
    const PANEL: Panel = teach_panel::PANEL;
    const GUARD: Guard =
        Guard { is_harmless_data: read_only_filter::only_reads_or_stops, is_harmless_image: |_, _| false };

    fn urls() -> Vec<(String, &'static str)> {
        vec![("udp://".to_owned(), "yerc: name or address of the controller")]
    }

    fn codes() -> Vec<(String, String)> {
        let statuses = status::all_statuses().map(|row| (format!("0x{:02X}", row.code), row.name.to_owned()));
        statuses.chain(status::all_added().map(|row| (format!("0x{:04X}", row.code), row.name.to_owned()))).collect()
    }

    fn stop_command() -> Self::Stop {
        Hold::on()
    }

    fn dissector() -> String {
        super::wireshark::dissector()
    }

    fn twin(folder: &Path) -> Result<Self::Start> {
        super::file::twin::start(folder)
    }

    fn traffic(link: &Link) -> Traffic {
        link.traffic()
    }

    async fn alarms(link: &mut Link) -> Result<Vec<Alarm>> {
        alarm::present(link, &mut true, alarm::SLOTS).await
    }

    async fn overview(link: &mut Link) -> Result<OverviewReport> {
        overview::overview(link).await
    }

    async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>> {
        check::check(robot, access, screen).await
    }

    async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink> {
        connect::open_session_link(robot, access, screen).await
    }
}

impl Backups for Yerc {
    const IDS: [&'static str; 3] = ["yerc.backup", "yerc.restore", "yerc.diff"];

    async fn back_up(context: Context<'_, Self>, making: SaveOptions) -> Result<BackupReport> {
        back_up(context, making).await
    }

    async fn restore(context: Context<'_, Self>, restoring: &RestoreSelection) -> Result<RestoreReport> {
        Restore::of(restoring).run(context).await
    }
}

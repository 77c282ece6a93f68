//! Implementation of the family interface for `yrcx`.

use clap::{ArgMatches, Args as _, FromArgMatches as _};

use super::alarm as alarms;
use super::backup::{back_up, restore};
use super::commands::Commands;
use super::decode::Decode;
use super::explain::Explain;
use super::procedure_commands::Stop;
use super::serve::ServeArgs;
use super::top::Poller;
use super::unit_argument::Unit;
use super::{check, overview, session_link, teach_panel};
use crate::prelude::*;
use armctl_controller::yrcx::{alarm, read_only_filter, simulator};
use armctl_frame::FamilyArguments;
use armctl_frame::backup::family_backup::Backups;
use armctl_frame::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use armctl_frame::face::{Declaration, Face, HeldLink, Layer, OverviewReport, Panel, Traffic};
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::settings::target::BUSES;
use armctl_transport::session::host::Guard;

/// The family for the rest of the program. It is a static, so this crate compiles the code of its commands.
pub static FACE: Face = Face::of::<Yrcx>();

impl Declaration for Yrcx {
    type Commands = Commands;
    type Decode = Decode;
    type Explain = Explain;
    type Alarms = alarms::List;
    type AlarmHistory = alarms::History;
    type AlarmReset = alarms::Reset;
    type Position = super::info::PositionArguments;
    type Stop = Stop;
    type Serve = ServeArgs;
    type Start = simulator::Start;
    type Poller = Poller;

    const NAME: Family = Family::Yrcx;
    const TITLE: &'static str = "OMRON / Yamaha YRCX";
    const ABOUT: &'static str = "OMRON / Yamaha YRCX over a fieldbus";
    const AFTER_HELP: &'static str = "Settings and first contact: `armctl help yrcx-setup`.";
    const SETUP: (&'static str, &'static str) = ("settings of a YRCX", include_str!("setup.txt"));
    const UNSAVED: &'static [&'static str] = &[];
    const START_STATE: &'static str = simulator::EXAMPLE;
    const PANEL: Panel = teach_panel::PANEL;
    const GUARD: Guard = Guard { is_harmless_data: |_| false, is_harmless_image: read_only_filter::only_stops };
    const SESSION_RECORDS: bool = true;
    const SESSION_COMMANDS: bool = true;

    fn urls() -> Vec<(String, &'static str)> {
        BUSES.iter().map(|bus| (format!("{}://", bus.name), bus.about)).collect()
    }

    fn codes() -> Vec<(String, String)> {
        alarm::KNOWN.iter().map(|known| (known.alarm.to_string(), known.text.to_owned())).collect()
    }

    fn arguments(command: clap::Command) -> clap::Command {
        Unit::augment_args(command)
    }

    fn read_arguments(matches: &mut ArgMatches) -> Result<FamilyArguments, clap::Error> {
        Unit::from_arg_matches_mut(matches).map(FamilyArguments::of)
    }

    fn stop_command() -> Self::Stop {
        Stop {}
    }

    fn dissector() -> String {
        super::wireshark::dissector()
    }

    fn twin(folder: &Path) -> Result<Self::Start> {
        super::backup::twin::start(folder)
    }

    fn traffic(link: &Link) -> Traffic {
        link.traffic()
    }

    async fn alarms(link: &mut Link) -> Result<Vec<Alarm>> {
        overview::alarms(link).await
    }

    async fn overview(link: &mut Link) -> Result<OverviewReport> {
        overview::overview(link).await
    }

    async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>> {
        check::check(robot, access, screen).await
    }

    async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink> {
        session_link::open_session_link(robot, access, screen).await
    }
}

impl Backups for Yrcx {
    const IDS: [&'static str; 3] = ["yrcx.backup", "yrcx.restore", "yrcx.diff"];

    async fn back_up(context: Context<'_, Self>, making: SaveOptions) -> Result<BackupReport> {
        back_up(context, making).await
    }

    async fn restore(context: Context<'_, Self>, restoring: &RestoreSelection) -> Result<RestoreReport> {
        restore(context, restoring).await
    }
}

//! Implementation of the family interface for `toyo`.

use super::alarm;
use super::backup::{back_up, restore};
use super::commands::Commands;
use super::control_commands::Stop;
use super::decode::Decode;
use super::explain::Explain;
use super::instructions;
use super::serve::Serve;
use super::top::Poller;
use super::{check, connect, overview, teach_panel};
use crate::prelude::*;
use armctl_controller::toyo::table::instructions::INSTRUCTIONS;
use armctl_controller::toyo::{errors, read_only_filter, simulator};
use armctl_frame::backup::family_backup::Backups;
use armctl_frame::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use armctl_frame::face::{Declaration, Face, HeldLink, Layer, OverviewReport, Panel, Traffic};
use armctl_frame::robot::alarm::Alarm;
use armctl_transport::session::host::Guard;

/// The family for the rest of the program. It is a static, so this crate compiles the code of its commands.
pub static FACE: Face = Face::of::<Toyo>();

impl Declaration for Toyo {
    type Commands = Commands;
    type Decode = Decode;
    type Explain = Explain;
    type Alarms = alarm::List;
    type AlarmHistory = alarm::History;
    type AlarmReset = alarm::Reset;
    type Position = super::position::Position;
    type Stop = Stop;
    type Serve = Serve;
    type Start = simulator::Start;
    type Poller = Poller;

    const NAME: Family = Family::Toyo;
    const TITLE: &'static str = "Toyo";
    const ABOUT: &'static str = "Toyo over RS-232C host communication";
    const AFTER_HELP: &'static str =
        "Cable, settings and first contact: `armctl help toyo-setup`. Serial ports: `armctl toyo ports`.";
    const SETUP: (&'static str, &'static str) = ("cable and settings of a Toyo controller", include_str!("setup.txt"));
    const UNSAVED: &'static [&'static str] = &["counter", "timer"];
    const START_STATE: &'static str = simulator::EXAMPLE;
    const PANEL: Panel = teach_panel::PANEL;
    const GUARD: Guard =
        Guard { is_harmless_data: read_only_filter::only_reads_or_stops, is_harmless_image: |_, _| false };

    fn urls() -> Vec<(String, &'static str)> {
        vec![
            ("serial://".to_owned(), "toyo: a port of this machine, such as serial:///dev/ttyUSB0 or serial://COM3"),
            ("tcp://".to_owned(), "toyo: HOST:PORT of a serial device server"),
        ]
    }

    fn codes() -> Vec<(String, String)> {
        let codes = errors::all().map(|code| (format!("{:02X}", code.code), code.name.to_string()));
        codes.chain(INSTRUCTIONS.iter().map(|row| (row.word.to_owned(), row.about.to_owned()))).collect()
    }

    fn topics() -> Vec<(&'static str, &'static str, String)> {
        vec![instructions::topic()]
    }

    fn stop_command() -> Self::Stop {
        Stop::everything()
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
        alarm::present_alarms(link).await
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

impl Backups for Toyo {
    const IDS: [&'static str; 3] = ["toyo.backup", "toyo.restore", "toyo.diff"];
    const BACKUP_RISK: Risk = Risk::Write;

    fn backup_risk(robot: &Robot) -> Risk {
        if robot.read_only.value { Risk::Read } else { Self::BACKUP_RISK }
    }

    async fn back_up(context: Context<'_, Self>, making: SaveOptions) -> Result<BackupReport> {
        let current_task = context.robot.read_only.value;
        if current_task {
            context.screen.note(&format!(
                "{}: the robot is read-only, and selecting a task is a change; the backup contains only the points \
                 and program of the current task",
                context.robot.label()
            ));
        }
        back_up(context, making, current_task).await
    }

    async fn restore(context: Context<'_, Self>, restoring: &RestoreSelection) -> Result<RestoreReport> {
        restore(context, restoring).await
    }
}

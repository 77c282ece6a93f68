//! `armctl alarm list|history|watch|reset` for robots of any family.

use clap::Subcommand;

use super::SharedVerbCommands;
use super::line::SharedLine;
use crate::command::fleet::status::{Fleet, Link};
use armctl_frame::face::shared_commands::SharedVerb;
use armctl_frame::output::envelope::Envelope;
use armctl_frame::prelude::*;
use armctl_frame::robot::alarm::AllAlarms;
use armctl_frame::settings::alarms;
use armctl_frame::watch::Changes;
use armctl_frame::{AnyCommand, SchemaEntry};

/// Alarms of all robots.
#[derive(Debug, Subcommand)]
pub enum Alarm {
    /// Show the active alarms of robots
    List(List),
    /// Show the alarm history, newest first
    History,
    /// Print alarms as they appear and disappear
    Watch(Watch),
    /// Reset the alarms of robots
    Reset,
}

/// Prints the active alarms, and then each change, until Ctrl-C. With --for, it ends after this time. With --count, it
/// ends after this number of reports.
#[derive(Debug, Args)]
pub struct Watch {
    /// Time after which the watch ends
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
}

impl Alarm {
    /// Whether the command only reads. Such a command applies to all robots if none is selected.
    pub fn reads(&self) -> bool {
        !matches!(self, Self::Reset)
    }

    /// Command for robots of any family.
    ///
    /// # Errors
    /// If a family does not have this verb, which a test excludes.
    pub fn command(&self) -> Result<Box<dyn AnyCommand>> {
        Ok(match self {
            Self::List(_) => Box::new(List {}),
            Self::History => Box::new(SharedVerbCommands::new("alarm.history", SharedVerb::AlarmHistory)),
            Self::Watch(_) => Box::new(SharedLine::new("alarm.watch", ["alarm", "watch"].map(Into::into).into())?),
            Self::Reset => Box::new(SharedVerbCommands::new("alarm.reset", SharedVerb::AlarmReset)),
        })
    }
}

/// Schemas of the reports.
pub fn schemas() -> [SchemaEntry; 4] {
    [
        SchemaEntry::of::<ActiveAlarms>("alarm.list"),
        SchemaEntry::of::<AllAlarms>("alarm.history"),
        SchemaEntry::of::<Changes<bool>>("alarm.watch"),
        SchemaEntry::of::<SetReport>("alarm.reset"),
    ]
}

/// Shows the active alarms. armctl sends no read that takes control of a controller. Without a session, a YRCX
/// therefore reports no alarm code.
#[derive(Debug, Args)]
#[command(
    after_help = "`armctl explain FAMILY CODE` explains a code. `armctl FAMILY alarm list` shows all details of the \
                  controller."
)]
pub struct List {}

impl Command for List {
    type Family = Fleet;
    type Report = ActiveAlarms;
    const ID: &'static str = "alarm.list";
    const CONNECT_MODE: ConnectMode = ConnectMode::Monitor;

    async fn run(&self, context: Context<'_, Fleet>) -> Result<ActiveAlarms> {
        let Context { robot, link, screen, several, .. } = context;
        link.open_link(screen).await?;
        let found = match link {
            Link::Open(face, connection) => (face.alarms)(&mut **connection).await?,
            Link::Absent(absent) => return Err(absent.failure.clone()),
        };
        let mut alarms = Vec::with_capacity(found.len());
        for alarm in found {
            let site = alarm.code.as_deref().map(|code| alarms::find(robot, code)).transpose()?.flatten();
            alarms.push(alarm.with(site));
        }
        Ok(ActiveAlarms { alarms: AllAlarms::present(alarms), several })
    }

    /// Summary line: `3 robots, 1 with an alarm`.
    fn summary(&self, envelopes: &[Envelope]) -> Option<String> {
        let has_alarm = |envelope: &&Envelope| {
            envelope.data.as_ref().and_then(|data| data["alarms"].as_array()).is_some_and(|alarms| !alarms.is_empty())
        };
        let (robots, with) = (envelopes.len(), envelopes.iter().filter(has_alarm).count());
        let plural = if robots == 1 { "" } else { "s" };
        Some(format!("{robots} robot{plural}, {with} with an alarm"))
    }
}

/// The active alarms.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ActiveAlarms {
    #[serde(flatten)]
    alarms: AllAlarms,
    /// Whether the report has other robots too.
    #[serde(skip)]
    several: bool,
}

impl Report for ActiveAlarms {
    fn view(&self) -> View {
        if self.several { self.alarms.view() } else { self.alarms.for_robot() }
    }
}

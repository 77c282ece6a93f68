//! Commands for robots of any family, and commands without a robot.

use clap::Subcommand;

use super::about::{completions, help, man, schema, wireshark};
use super::fleet::common::{self, alarm, io};
use super::fleet::status::Overview;
use super::fleet::wait::Wait;
use super::fleet::{backup, names, record, report, robots, session, setup, tools, top};
#[cfg(feature = "plant")]
use super::fleet::{publish, serve};
use armctl_frame::run::{Run, RunError};

/// Commands without a family name.
#[derive(Debug, Subcommand)]
pub enum Common {
    /// Set up a robot step by step: address, check, name
    Setup(setup::Setup),
    /// Show a one-line status per robot
    Status(Overview),
    /// Alarms of robots: list, history, watch, reset
    #[command(subcommand)]
    Alarm(alarm::Alarm),
    /// Signals of robots: get, list, watch
    #[command(subcommand)]
    Io(io::Io),
    /// Show the positions of robots
    Position,
    /// Stop the motion of robots
    Stop,
    /// Wait for a condition of robots: idle, homed, faulted, and others
    Wait(Wait),
    /// Full-screen live monitor
    Top(top::Top),
    /// Publish the data of robots to an MQTT broker
    #[cfg(feature = "plant")]
    Publish(Box<publish::Publish>),
    /// Serve metrics of robots to other programs
    #[cfg(feature = "plant")]
    #[command(subcommand)]
    Serve(serve::Serve),
    /// Inventory: list, add, set, edit and more; check and discover
    #[command(subcommand)]
    Robots(robots::Robots),
    /// Names of signals, variables and registers: list, set
    #[command(subcommand)]
    Names(names::Names),
    /// Keep a connection open for later commands: open, list, close
    #[command(subcommand)]
    Session(session::Session),
    /// Save all data of a controller to a folder
    Backup(backup::Backup),
    /// Record what robots answer, for a replay by simulators
    Record(record::Record),
    /// Restore a backup
    Restore(backup::Restore),
    /// Compare backups or controllers with each other
    Diff(backup::Diff),
    /// Pack the data of a robot for a bug report
    Report(report::Pack),
    /// Run a simulator as a network or serial server
    Sim(tools::Sim),
    /// Decode protocol bytes or a capture file
    #[command(subcommand)]
    Decode(tools::Decode),
    /// Explain an error or alarm code: meaning, cause, remedy
    #[command(subcommand)]
    Explain(tools::Explain),
    /// Write Wireshark dissectors of all protocols to a folder
    Wireshark(wireshark::Wireshark),
    /// Print the completion script of a shell
    Completions(completions::Completions),
    /// Write the man pages to a folder
    Man(man::Man),
    /// Print the JSON Schema of a report
    Schema(schema::SchemaOf),
    /// Show help for a command or a topic
    Help(help::Help),
}

/// Groups of global flags that a command uses. All commands also use the output flags.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent group of flags")]
pub struct FlagGroups {
    /// Flags that select robots.
    pub robots: bool,
    /// Flags for the link, for example the timeout.
    pub link: bool,
    /// `--watch` and the other flags for repetition.
    pub repeat: bool,
    /// `--yes` and `--dry-run`.
    pub gate: bool,
}

impl FlagGroups {
    const ALL: Self = Self { robots: true, link: true, repeat: true, gate: true };
    const NONE: Self = Self { robots: false, link: false, repeat: false, gate: false };
}

/// Properties of a command that decide how it is prepared, and where it can run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Properties {
    /// Global flags that have an effect.
    pub flags: FlagGroups,
    /// Whether the command reads or lists robots, and therefore needs the inventory.
    pub is_about_robots: bool,
    /// Whether the command applies to all robots of the inventory if none is selected, and to the simulators of all
    /// families.
    pub is_for_all: bool,
    /// Whether the command can run in a rehearsal: it reaches only the selected robots, and changes no file of this
    /// computer except the files that it names.
    pub can_rehearse: bool,
    /// Reason why the command cannot be a line of a batch file: it would not end, or it prints text that is not a
    /// result.
    pub why_not_in_batch: Option<&'static str>,
}

impl Properties {
    /// A command that runs on the selected robots.
    pub const ROBOTS: Self = Self {
        flags: FlagGroups::ALL,
        is_about_robots: true,
        is_for_all: false,
        can_rehearse: true,
        why_not_in_batch: None,
    };
    /// A command without a robot.
    pub const ALONE: Self =
        Self { flags: FlagGroups::NONE, is_about_robots: false, can_rehearse: false, ..Self::ROBOTS };

    const fn not_in_batch(self, why: &'static str) -> Self {
        Self { why_not_in_batch: Some(why), ..self }
    }

    const fn not_rehearsed(self) -> Self {
        Self { can_rehearse: false, ..self }
    }
}

impl Common {
    /// Properties of the command with its arguments.
    pub fn properties(&self) -> Properties {
        const ALL: FlagGroups = FlagGroups::ALL;
        const NONE: FlagGroups = FlagGroups::NONE;
        const ROBOTS: Properties = Properties::ROBOTS;
        const ALONE: Properties = Properties::ALONE;
        const OF_ALL: Properties = Properties { is_for_all: true, ..ROBOTS };
        const LISTED: Properties = Properties { is_about_robots: true, ..ALONE };
        // A command that shows the settings of a link, or checks a connection, uses the link flags.
        const LINK: FlagGroups = FlagGroups { link: true, ..NONE };
        let flags = |flags, properties| Properties { flags, ..properties };
        match self {
            Self::Status(_) | Self::Io(_) | Self::Position => OF_ALL,
            Self::Alarm(alarm) => Properties { is_for_all: alarm.reads(), ..ROBOTS },
            Self::Stop | Self::Wait(_) | Self::Restore(_) => ROBOTS,
            Self::Top(_) => OF_ALL.not_rehearsed().not_in_batch("it is a full-screen display"),
            #[cfg(feature = "plant")]
            Self::Publish(_) => OF_ALL.not_rehearsed().not_in_batch("it publishes until you end it"),
            #[cfg(feature = "plant")]
            Self::Serve(_) => flags(FlagGroups { gate: false, ..ALL }, OF_ALL)
                .not_rehearsed()
                .not_in_batch("it serves until you end it"),
            Self::Record(_) => flags(FlagGroups { gate: false, ..ALL }, ROBOTS)
                .not_rehearsed()
                .not_in_batch("it records until you end it"),
            Self::Report(_) => flags(FlagGroups { repeat: false, ..ALL }, ROBOTS).not_rehearsed(),
            Self::Backup(backup) if backup.takes_robot() => ROBOTS,
            Self::Diff(diff) if diff.may_ask_robots() => ROBOTS,
            Self::Backup(_) | Self::Diff(_) | Self::Decode(_) => Properties { can_rehearse: true, ..ALONE },
            Self::Explain(_) => Properties { flags: FlagGroups { robots: true, ..LINK }, can_rehearse: true, ..ALONE },
            Self::Setup(_) => {
                flags(LINK, LISTED).not_in_batch("it asks questions at the terminal; use `robots add` instead")
            }
            Self::Robots(robots::Robots::Check(_)) => flags(ALL, LISTED),
            Self::Robots(robots::Robots::List) | Self::Names(_) => flags(FlagGroups { robots: true, ..NONE }, LISTED),
            Self::Robots(robots::Robots::Discover(_)) => flags(FlagGroups { gate: true, ..LINK }, LISTED),
            Self::Robots(robots::Robots::Show(_)) => flags(LINK, LISTED),
            Self::Robots(robots::Robots::Edit) => LISTED.not_in_batch("it opens an editor; use `robots set` instead"),
            Self::Robots(_) => LISTED,
            Self::Session(session) => Properties {
                flags: FlagGroups { repeat: false, ..ALL },
                why_not_in_batch: session
                    .stays()
                    .then_some("it keeps a connection open until you end it; add --background"),
                ..LISTED
            },
            Self::Sim(sim) if !sim.is_list() => ALONE.not_in_batch("it serves until you end it"),
            Self::Sim(_) | Self::Wireshark(_) => ALONE,
            Self::Completions(_) | Self::Man(_) | Self::Schema(_) | Self::Help(_) => {
                ALONE.not_in_batch("it prints a text, not a result")
            }
        }
    }

    /// Runs the command; `root` creates the whole command line.
    pub async fn run(self, run: &Run, root: fn() -> clap::Command) -> Result<(), RunError> {
        match self {
            Self::Setup(setup) => Box::pin(setup.run(run)).await,
            Self::Status(overview) => run.robots(&overview).await,
            Self::Alarm(alarm) => run.robots(&*alarm.command()?).await,
            Self::Io(io) => run.robots(&*io.command()?).await,
            Self::Position => run.robots(&common::position()).await,
            Self::Stop => run.robots(&common::stop()).await,
            Self::Wait(wait) => run.robots(&*wait.command()?).await,
            Self::Backup(backup) => backup.run(run).await,
            Self::Restore(restore) => run.robots(&restore).await,
            Self::Diff(diff) => backup::diff(diff, run).await,
            Self::Top(top) => Box::pin(top.run(run)).await,
            #[cfg(feature = "plant")]
            Self::Serve(serve) => Box::pin(serve.run(run)).await,
            #[cfg(feature = "plant")]
            Self::Publish(publish) => Box::pin(publish.run(run)).await,
            Self::Record(record) => Box::pin(record.run(run)).await,
            Self::Report(pack) => run.robots(&pack).await,
            Self::Sim(sim) => sim.run(run).await,
            Self::Session(session) => Box::pin(session.run(run)).await,
            Self::Robots(robots) => robots.run(run).await,
            Self::Names(names) => names.run(run),
            Self::Decode(decode) => decode.run(run).await,
            Self::Explain(explain) => explain.run(run).await,
            Self::Wireshark(wireshark) => wireshark.run(run),
            Self::Completions(completions) => Ok(completions.run(run)?),
            Self::Man(man) => Ok(man.run(run, root)?),
            Self::Schema(schema) => Ok(schema.run(run)?),
            Self::Help(help) => Ok(help.run(run, root)?),
        }
    }
}

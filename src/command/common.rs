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

impl Common {
    /// Whether the command reads or lists robots, and therefore needs the inventory.
    pub fn is_about_robots(&self) -> bool {
        match self {
            #[cfg(feature = "plant")]
            Self::Publish(_) => true,
            Self::Setup(_)
            | Self::Status(_)
            | Self::Alarm(_)
            | Self::Io(_)
            | Self::Position
            | Self::Stop
            | Self::Wait(_)
            | Self::Top(_)
            | Self::Robots(_)
            | Self::Names(_)
            | Self::Session(_)
            | Self::Record(_)
            | Self::Report(_)
            | Self::Restore(_) => true,
            #[cfg(feature = "plant")]
            Self::Serve(_) => true,
            Self::Backup(backup) => backup.takes_robot(),
            Self::Diff(diff) => diff.may_ask_robots(),
            _ => false,
        }
    }

    /// Whether the command applies to all robots of the inventory if none is selected, and to the simulators of all
    /// families.
    pub fn is_for_all(&self) -> bool {
        match self {
            Self::Status(_) | Self::Io(_) | Self::Position | Self::Top(_) => true,
            Self::Alarm(alarm) => alarm.reads(),
            #[cfg(feature = "plant")]
            Self::Serve(_) | Self::Publish(_) => true,
            _ => false,
        }
    }

    /// Reason why the command cannot be a line of a batch file: it would not end, or it prints text that is not a
    /// result.
    pub fn why_not_in_batch(&self) -> Option<&'static str> {
        match self {
            Self::Session(session) if session.stays() => {
                Some("it keeps a connection open until you end it; add --background")
            }
            Self::Sim(sim) if sim.is_list() => None,
            Self::Sim(_) => Some("it serves until you end it"),
            #[cfg(feature = "plant")]
            Self::Serve(_) => Some("it serves until you end it"),
            Self::Top(_) => Some("it is a full-screen display"),
            Self::Record(_) => Some("it records until you end it"),
            #[cfg(feature = "plant")]
            Self::Publish(_) => Some("it publishes until you end it"),
            Self::Setup(_) => Some("it asks questions at the terminal; use `robots add` instead"),
            Self::Robots(robots::Robots::Edit) => Some("it opens an editor; use `robots set` instead"),
            Self::Completions(_) | Self::Man(_) | Self::Schema(_) | Self::Help(_) => {
                Some("it prints a text, not a result")
            }
            Self::Status(_)
            | Self::Alarm(_)
            | Self::Io(_)
            | Self::Position
            | Self::Stop
            | Self::Wait(_)
            | Self::Robots(_)
            | Self::Names(_)
            | Self::Session(_)
            | Self::Decode(_)
            | Self::Explain(_)
            | Self::Backup(_)
            | Self::Restore(_)
            | Self::Diff(_)
            | Self::Report(_)
            | Self::Wireshark(_) => None,
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

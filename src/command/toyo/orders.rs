//! Orders of one block: servo, mode, reset; and the stop.

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::link::Moving;
use super::position::Place;
use super::waiting::becomes;
use crate::command::orders::{Done, Switch};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::{ProgramKind, RunMode, Status};
use crate::controller::toyo::table;
use crate::failure::{Failure, Kind};
use crate::output::view::View;

/// Switches servo power of all axes (TO 2-7), and waits until the status shows it.
#[derive(Debug, Args)]
pub struct Servo {
    /// On or off
    #[arg(value_name = "on|off")]
    to: Switch,
}

impl Command for Servo {
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "toyo.servo";

    fn risk(&self) -> Risk {
        Risk::Motion
    }

    fn intent(&self) -> String {
        match self.to {
            Switch::On => "switch servo power on".to_owned(),
            Switch::Off => "switch servo power off: an axis without brake may sink".to_owned(),
        }
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        let link = context.link;
        let (command, is_on) = match self.to {
            Switch::On => (table::Command::Svon, true),
            Switch::Off => (table::Command::Svof, false),
        };
        link.order(&Request::bare(command)).await?;
        let done = becomes(link, (3, "whether it is"), |status| status.servo_on() == is_on).await?;
        link.has_ended();
        match (done, is_on) {
            (true, true) => Ok(Done::new("servo power is on")),
            (true, false) => Ok(Done::new("servo power is off")),
            (false, _) => {
                Err(not_so("servo power").hint("`toyo error show` and `toyo status` tell what is in the way"))
            }
        }
    }
}

/// A mode of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ModeName {
    /// Programs are edited
    Program,
    /// Programs run a step at a start
    Step,
    /// Programs run from step to step
    #[value(alias = "automatic")]
    Auto,
    /// Sequential programs run
    Sequential,
    /// Palletizing programs run
    Palletizing,
}

impl ModeName {
    const fn command(self) -> table::Command {
        match self {
            Self::Program => table::Command::Mpro,
            Self::Step => table::Command::Mstp,
            Self::Auto => table::Command::Maut,
            Self::Sequential => table::Command::Mseq,
            Self::Palletizing => table::Command::Mple,
        }
    }

    fn is_in_force(self, status: Status) -> bool {
        match self {
            Self::Program => status.run_mode() == Some(RunMode::Program),
            Self::Step => status.run_mode() == Some(RunMode::Step),
            Self::Auto => status.run_mode() == Some(RunMode::Automatic),
            Self::Sequential => status.program_kind() == ProgramKind::Sequential,
            Self::Palletizing => status.program_kind() == ProgramKind::Palletizing,
        }
    }

    const fn in_force(self) -> &'static str {
        match self {
            Self::Program => "programs are edited (program mode)",
            Self::Step => "programs run a step at a start (step mode)",
            Self::Auto => "programs run from step to step (automatic mode)",
            Self::Sequential => "sequential programs run (sequential mode)",
            Self::Palletizing => "palletizing programs run (palletizing mode)",
        }
    }
}

/// Chooses how programs run, or which kind of them (TO 2-2).
#[derive(Debug, Args)]
#[command(after_help = "Easy and external point mode are chosen by a parameter: \
    `toyo param set M10 …`. `toyo status` shows the modes.")]
pub struct Mode {
    /// How: program, step or auto; which: sequential or palletizing
    mode: ModeName,
}

impl Command for Mode {
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "toyo.mode";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        let (link, mode) = (context.link, self.mode);
        link.order(&Request::bare(mode.command())).await?;
        if becomes(link, (2, "whether it is in force"), |status| mode.is_in_force(status)).await? {
            return Ok(Done::new(mode.in_force()));
        }
        Err(not_so("the mode").hint("parameter M10 may have chosen easy or external point mode: `toyo param get M10`"))
    }
}

/// Accepted, and yet not so.
fn not_so(what: &str) -> Failure {
    Failure::new(Kind::ConditionNotMet, format!("the order was accepted, but {what} has not changed within 1s"))
}

/// Puts programs back to their beginning (TO 2-7).
#[derive(Debug, Args)]
pub struct Reset {}

impl Command for Reset {
    type Family = Family;
    type Report = Done;
    const ID: &'static str = "toyo.reset";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Done, Failure> {
        context.link.order(&Request::bare(table::Command::Rest)).await?;
        Ok(Done::new("the controller was reset; errors are cancelled by `toyo error cancel`"))
    }
}

/// Stops what runs, and waits until the axes stand. The order is repeated until then.
///
/// Without --jog: a program, a return to origin; and an axis that moves although nothing is executed.
#[derive(Debug, Args)]
pub struct Stop {
    /// Stop a JOG, as after an `armctl` that was killed while an axis was jogged
    #[arg(long)]
    jog: bool,
}

impl Command for Stop {
    type Family = Family;
    type Report = Stopped;
    const ID: &'static str = "toyo.stop";

    fn risk(&self) -> Risk {
        Risk::Write
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Stopped, Failure> {
        let moving = if self.jog { Moving::Jog } else { Moving::Program };
        let place = context.link.stop(moving).await?;
        Ok(Stopped { position: Place::of(&place) })
    }
}

/// What was stopped stands.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stopped {
    /// Where the axes stand.
    position: Place,
}

impl Report for Stopped {
    fn view(&self) -> View {
        View::text(format!("the axes stand at {}", self.position.in_a_line()))
    }
}

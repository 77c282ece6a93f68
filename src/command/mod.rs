//! What the operator types. No bytes and no sockets in here: those are behind each family's link.
//!
//! A command is a struct of its arguments that implements [`Command`]; a noun with verbs is a clap enum. Both are
//! [`Noun`]s, and a line in the family's `commands!` list makes them part of the tool: command line, help, man page,
//! completion and schema follow from it.

pub mod attach;
pub mod authority;
pub mod backup;
pub mod checks;
pub mod common;
pub mod decode;
pub mod dry_run;
pub mod holding;
pub mod interrupt;
pub mod items;
mod kind;
pub mod line;
pub mod lines;
pub mod local;
pub mod manifest;
pub mod orders;
pub mod overview;
pub mod run;
pub mod sample;
pub mod serve;
pub mod terminal_link;
#[cfg(test)]
mod testing;
pub mod toyo;
pub mod trace;
pub mod yerc;
pub mod yrcx;

use std::future::Future;
use std::pin::Pin;
use std::sync::Arc;

pub use kind::ValueKind;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use serde_json::Value;

use self::authority::Authority;
use self::dry_run::Plan;
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Confirmation, Grant, Intent};
use crate::output::Screen;
use crate::output::view::View;
use crate::settings::{self, Robot};

/// What a command found out or did.
pub trait Report: Serialize + JsonSchema {
    /// As a person reads it.
    fn view(&self) -> View;

    /// Why the report is not a success although it is whole: a difference, a condition not met, a file that failed.
    fn failure(&self) -> Option<Failure> {
        None
    }
}

/// What a command line needs beside its own arguments.
#[derive(Debug)]
pub struct Context<'a, F: Family> {
    /// The robot.
    pub robot: &'a Robot,
    /// The connection to it.
    pub link: &'a mut F::Link,
    /// For progress and notes; reports go back to the caller.
    pub screen: &'a Screen,
    /// Whether other robots may run the same command, so that files need a folder for each.
    pub several: bool,
    /// Confirms what is deleted or overwritten, once that is known.
    pub authority: Authority<'a>,
}

/// How a link may be used.
#[derive(Debug, Clone)]
pub struct Access {
    /// Nothing riskier leaves: the last check, after the gate.
    pub granted: Grant,
    /// Note what would be sent instead of sending it.
    pub dry_run: bool,
    /// Where frames are recorded.
    pub trace: Option<std::path::PathBuf>,
    /// What the command wants of the connection.
    pub need: Need,
    /// The command line, where it is not that of the process.
    pub typed: Option<Arc<str>>,
    /// The robot of the controller that commands are for (yrcx), 1 to 4; 0 for the first, or for all.
    pub unit: u8,
}

impl Access {
    /// For what only looks.
    pub fn reading(need: Need) -> Self {
        Self { granted: Grant::of(Risk::Read), dry_run: false, trace: None, need, typed: None, unit: 0 }
    }
}

/// What a command wants of the connection. Where a controller takes the end of a connection for a fault, as YRCX does,
/// nothing is opened that is more than this.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Need {
    /// To ask and to command.
    #[default]
    Command,
    /// To see what the controller shows by itself.
    Sight,
    /// To ask its network board, which answers without a connection to the controller (yrcx).
    Messages,
}

/// What a connection does to a controller by being there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// Nothing.
    Harmless,
    /// Nothing, as a session holds it; another way would not be harmless.
    ThroughSession,
    /// It stops the robot when it ends; completes "This will …".
    Stops(String),
}

/// A controller family as the commands see it.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Family: Sized + 'static {
    /// Its name; `None` for what is for robots of any family.
    const FAMILY: Option<settings::target::Family>;
    /// A connection to one robot.
    type Link;

    /// Connects. With `dry_run` nothing is opened.
    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Self::Link, Failure>;

    /// Stops what this link set in motion, and says what was done: "the robot was stopped: HOLD is on".
    async fn halt(link: &mut Self::Link) -> Result<String, Failure>;

    /// Whether what this link set in motion is stopped even if `--on-interrupt` says to leave it.
    fn must_halt(_link: &Self::Link) -> bool {
        false
    }

    /// What a dry run would have sent, in the order of sending.
    fn rehearsed(link: &mut Self::Link) -> Plan;

    /// What a connection of this kind does to the controller by being opened, and closed at the end.
    fn entry(_robot: &Robot, _need: Need) -> Entry {
        Entry::Harmless
    }

    /// Closes the connection, and says at `-v` what it was like.
    async fn close(link: Self::Link, screen: &Screen) -> Result<(), Failure>;
}

/// A parsed command line for a robot.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Command {
    /// The family it is for.
    type Family: Family;
    /// What it reports.
    type Report: Report + 'static;
    /// `yerc.status`: its name in envelopes and schemas.
    const ID: &'static str;

    /// The most that it does.
    fn risk(&self) -> Risk {
        Risk::Read
    }

    /// The most that it does to this robot, where that depends on it; not more than [`risk`](Self::risk).
    fn risk_on(&self, _robot: &Robot) -> Risk {
        self.risk()
    }

    /// Completes "This will …" in the question before a motion.
    fn intent(&self) -> String {
        String::new()
    }

    /// How a yes is given to what moves, deletes or overwrites.
    fn confirmation(&self) -> Confirmation {
        Confirmation::Question
    }

    /// Whether it stops the robot, which is always allowed.
    fn is_stop(&self) -> bool {
        false
    }

    /// Whether it moves the robot until somebody ends it: a jog without `--for`.
    fn moves_until_stopped(&self) -> bool {
        false
    }

    /// Whether it is repeated until something ends it, each run waiting for the next thing to tell.
    fn is_endless(&self) -> bool {
        false
    }

    /// What it wants of the connection.
    fn need(&self) -> Need {
        Need::Command
    }

    /// Does it. In a dry run orders are noted and count as done; what reads ends in a failure that says its answer is not
    /// known ([`dry_run::unknown`]), behind which nothing can be foreseen unless the command does.
    async fn run(&self, context: Context<'_, Self::Family>) -> Result<Self::Report, Failure>;
}

/// A report, or why there is none.
pub type Outcome = Result<Box<dyn AnyReport>, Failure>;

/// [`Command`] without its types, for the one loop that runs them all.
pub trait AnyCommand<F: Family> {
    /// See [`Command::ID`].
    fn id(&self) -> &'static str;
    /// What the gate is told: of this robot, or at the most.
    fn intent(&self, robot: Option<&Robot>) -> Intent;
    /// Whether it is for a robot.
    fn takes_robot(&self) -> bool {
        true
    }
    /// What it reports, if it takes no robot to do it.
    fn without_robot(&self, screen: &Screen) -> Option<Outcome>;
    /// See [`Command::moves_until_stopped`].
    fn moves_until_stopped(&self) -> bool {
        false
    }
    /// See [`Command::is_endless`].
    fn is_endless(&self) -> bool {
        false
    }
    /// See [`Command::need`].
    fn need(&self) -> Need {
        Need::Command
    }
    /// See [`Command::run`].
    fn run<'a>(&'a self, context: Context<'a, F>) -> Pin<Box<dyn Future<Output = Outcome> + 'a>>;
}

/// [`Report`] without its type.
pub trait AnyReport {
    /// The `data` of the envelope.
    fn data(&self) -> Result<Value, Failure>;
    /// See [`Report::view`].
    fn view(&self) -> View;
    /// See [`Report::failure`].
    fn failure(&self) -> Option<Failure>;
}

impl<R: Report> AnyReport for R {
    fn data(&self) -> Result<Value, Failure> {
        serde_json::to_value(self).map_err(|error| Failure::local(format!("report as JSON: {error}")))
    }

    fn view(&self) -> View {
        Report::view(self)
    }

    fn failure(&self) -> Option<Failure> {
        Report::failure(self)
    }
}

impl<C: Command> AnyCommand<C::Family> for C {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, robot: Option<&Robot>) -> Intent {
        Intent {
            risk: robot.map_or_else(|| Command::risk(self), |robot| Command::risk_on(self, robot)),
            text: Command::intent(self),
            confirmation: Command::confirmation(self),
            is_stop: Command::is_stop(self),
        }
    }

    fn moves_until_stopped(&self) -> bool {
        Command::moves_until_stopped(self)
    }

    fn is_endless(&self) -> bool {
        Command::is_endless(self)
    }

    fn need(&self) -> Need {
        Command::need(self)
    }

    fn without_robot(&self, _screen: &Screen) -> Option<Outcome> {
        None
    }

    fn run<'a>(&'a self, context: Context<'a, C::Family>) -> Pin<Box<dyn Future<Output = Outcome> + 'a>> {
        Box::pin(async move {
            let report = Command::run(self, context).await?;
            Ok(Box::new(report) as Box<dyn AnyReport>)
        })
    }
}

/// A command of a family that takes no robot: it is about files, or about this machine.
pub trait Desk {
    /// What it reports.
    type Report: Report + 'static;
    /// `toyo.program.check`: its name in envelopes and schemas.
    const ID: &'static str;

    /// Does it.
    fn run(&self, screen: &Screen) -> Result<Self::Report, Failure>;
}

/// A [`Desk`] command among those for robots.
#[derive(Debug, clap::Args)]
pub struct AtDesk<C: clap::Args> {
    #[command(flatten)]
    command: C,
}

impl<C: Desk + clap::Args> AtDesk<C> {
    fn report(&self, screen: &Screen) -> Outcome {
        Ok(Box::new(self.command.run(screen)?))
    }
}

impl<F: Family, C: Desk + clap::Args + 'static> AnyCommand<F> for AtDesk<C> {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, _robot: Option<&Robot>) -> Intent {
        Intent { risk: Risk::Read, text: String::new(), confirmation: Confirmation::Question, is_stop: false }
    }

    fn takes_robot(&self) -> bool {
        false
    }

    fn without_robot(&self, screen: &Screen) -> Option<Outcome> {
        Some(self.report(screen))
    }

    fn run<'a>(&'a self, context: Context<'a, F>) -> Pin<Box<dyn Future<Output = Outcome> + 'a>> {
        Box::pin(async move { self.report(context.screen) })
    }
}

/// The schema of a report, by command.
#[derive(Debug, Clone, Copy)]
pub struct SchemaEntry {
    /// `yerc.status`.
    pub id: &'static str,
    /// Makes the schema of `data`.
    pub schema: fn() -> Schema,
}

impl SchemaEntry {
    /// The schema of a report as it is written: what may be left out is not required.
    pub fn of<R: JsonSchema>(id: &'static str) -> Self {
        Self {
            id,
            schema: || SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<R>(),
        }
    }
}

/// A command, or a noun that leads to commands by its verbs.
pub trait Noun<F: Family> {
    /// The command that was typed.
    fn command(self) -> Box<dyn AnyCommand<F>>;
    /// The schemas of all its reports.
    fn schemas() -> Vec<SchemaEntry>;
    /// Its part of the command line, as far as words are named: what a line does not name, it does not need.
    fn lay_out(command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command;
}

impl<C: Command + clap::Args + 'static> Noun<C::Family> for C {
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        C::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand<C::Family>> {
        Box::new(self)
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID)]
    }
}

impl<F: Family, C: Desk + clap::Args + 'static> Noun<F> for AtDesk<C> {
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        <Self as clap::Args>::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand<F>> {
        Box::new(self)
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID)]
    }
}

/// How a variant is typed: `PositionError` as `position-error`.
fn word(variant: &str) -> String {
    let mut word = String::with_capacity(variant.len() + 2);
    for (index, c) in variant.char_indices() {
        word.extend((index > 0 && c.is_ascii_uppercase()).then_some('-'));
        word.push(c.to_ascii_lowercase());
    }
    word
}

/// Declares a clap enum of nouns or verbs: doc comment, name, and the type that holds its arguments.
macro_rules! commands {
    ($(#[$meta:meta])* $visibility:vis enum $name:ident of $family:ty {
        $($(#[$doc:meta])* $variant:ident($arguments:ty),)*
    }) => {
        $(#[$meta])*
        #[derive(Debug, clap::Subcommand)]
        $visibility enum $name {
            $($(#[$doc])* $variant($arguments),)*
        }

        impl $crate::command::Noun<$family> for $name {
            fn lay_out(mut command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
                $(
                    let name = $crate::command::word(stringify!($variant));
                    if is_named(&name) {
                        let verb = clap::Command::new(name);
                        let verb = <$arguments as $crate::command::Noun<$family>>::lay_out(verb, is_named);
                        command = command.subcommand(verb);
                    }
                )*
                command
            }

            fn command(self) -> Box<dyn $crate::command::AnyCommand<$family>> {
                match self {
                    $(Self::$variant(arguments) => $crate::command::Noun::<$family>::command(arguments),)*
                }
            }

            fn schemas() -> Vec<$crate::command::SchemaEntry> {
                let mut all = Vec::new();
                $(all.extend(<$arguments as $crate::command::Noun<$family>>::schemas());)*
                all
            }
        }
    };
}
pub(crate) use commands;

/// A noun of verbs as an argument struct, so that it can stand in a `commands!` list.
#[derive(Debug, clap::Args)]
pub struct Verbs<V: clap::Subcommand> {
    #[command(subcommand)]
    verb: V,
}

impl<F: Family, V: Noun<F> + clap::Subcommand> Noun<F> for Verbs<V> {
    fn lay_out(command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        V::lay_out(command.subcommand_required(true), is_named)
    }

    fn command(self) -> Box<dyn AnyCommand<F>> {
        self.verb.command()
    }

    fn schemas() -> Vec<SchemaEntry> {
        V::schemas()
    }
}

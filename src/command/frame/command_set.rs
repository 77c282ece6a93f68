//! How commands become words of the command line: sets of them, sets within sets, and those that take no robot.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::command::{AnyCommand, AnyContext, Command};
use super::report::{Outcome, Report, SchemaEntry};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Confirmation, Intent};
use crate::output::Screen;
use crate::settings::Robot;

/// A command of a family that takes no robot: it is about files, or about this machine.
pub trait OfflineCommand {
    /// What it reports.
    type Report: Report + 'static;
    /// `toyo.program.check`: its name in envelopes and schemas.
    const ID: &'static str;

    /// Does it.
    fn run(&self, screen: &Screen) -> Result<Self::Report, Failure>;
}

/// A [`OfflineCommand`] command among those for robots.
#[derive(Debug, clap::Args)]
pub struct Offline<C: clap::Args> {
    #[command(flatten)]
    command: C,
}

impl<C: OfflineCommand + clap::Args> Offline<C> {
    fn report(&self, screen: &Screen) -> Outcome {
        Ok(Box::new(self.command.run(screen)?))
    }
}

impl<C: OfflineCommand + clap::Args + 'static> AnyCommand for Offline<C> {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, _robot: Option<&Robot>) -> Intent {
        Intent { risk: Risk::Read, text: String::new(), confirmation: Confirmation::Question, is_stop: false }
    }

    fn without_robot(&self, screen: &Screen) -> Option<Outcome> {
        Some(self.report(screen))
    }

    fn run<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        async move { self.report(context.screen) }.boxed_local()
    }
}

/// A command, or a noun that leads to commands by its verbs.
pub trait CommandSet {
    /// The command that was typed.
    fn command(self) -> Box<dyn AnyCommand>;
    /// The schemas of all its reports.
    fn schemas() -> Vec<SchemaEntry>;
    /// Its part of the command line, as far as words are named: what a line does not name, it does not need.
    fn lay_out(command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command;
    /// Its words in their order, the first below a heading of the help with that heading.
    fn headings() -> Vec<(Option<&'static str>, String)> {
        Vec::new()
    }
}

impl<C: Command + clap::Args + 'static> CommandSet for C {
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        C::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand> {
        Box::new(self)
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID)]
    }
}

impl<C: OfflineCommand + clap::Args + 'static> CommandSet for Offline<C> {
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        <Self as clap::Args>::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand> {
        Box::new(self)
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID)]
    }
}

/// How a variant is typed: `PositionError` as `position-error`.
pub fn word(variant: &str) -> String {
    let mut word = String::with_capacity(variant.len() + 2);
    for (index, c) in variant.char_indices() {
        word.extend((index > 0 && c.is_ascii_uppercase()).then_some('-'));
        word.push(c.to_ascii_lowercase());
    }
    word
}

/// Declares a clap enum of nouns or verbs: doc comment, name, and the type that holds its arguments. A text and a colon
/// before one is the heading in the help for it and those that follow.
macro_rules! commands {
    ($(#[$meta:meta])* $visibility:vis enum $name:ident {
        $($($heading:literal:)? $(#[$doc:meta])* $variant:ident($arguments:ty),)*
    }) => {
        $(#[$meta])*
        #[derive(Debug, clap::Subcommand)]
        $visibility enum $name {
            $($(#[$doc])* $variant($arguments),)*
        }

        impl $crate::command::frame::command_set::CommandSet for $name {
            fn lay_out(mut command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
                $(
                    let name = $crate::command::frame::command_set::word(stringify!($variant));
                    if is_named(&name) {
                        let verb = clap::Command::new(name);
                        let verb = <$arguments as $crate::command::frame::command_set::CommandSet>::lay_out(verb, is_named);
                        command = command.subcommand(verb);
                    }
                )*
                command
            }

            fn headings() -> Vec<(Option<&'static str>, String)> {
                vec![$((
                    [$($heading)?].first().copied(),
                    $crate::command::frame::command_set::word(stringify!($variant)),
                ),)*]
            }

            fn command(self) -> Box<dyn $crate::command::frame::command::AnyCommand> {
                match self {
                    $(Self::$variant(arguments) => $crate::command::frame::command_set::CommandSet::command(arguments),)*
                }
            }

            fn schemas() -> Vec<$crate::command::frame::report::SchemaEntry> {
                let mut all = Vec::new();
                $(all.extend(<$arguments as $crate::command::frame::command_set::CommandSet>::schemas());)*
                all
            }
        }
    };
}
pub(crate) use commands;

/// A noun of verbs as an argument struct, so that it can stand in a `commands!` list.
#[derive(Debug, clap::Args)]
pub struct Subcommands<V: clap::Subcommand> {
    #[command(subcommand)]
    verb: V,
}

impl<V: CommandSet + clap::Subcommand> CommandSet for Subcommands<V> {
    fn lay_out(command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        V::lay_out(command.subcommand_required(true), is_named)
    }

    fn command(self) -> Box<dyn AnyCommand> {
        self.verb.command()
    }

    fn schemas() -> Vec<SchemaEntry> {
        V::schemas()
    }
}

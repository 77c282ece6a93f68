//! Mapping of commands to the command line: command sets, nested sets, and commands without a robot.

use super::command::{AnyCommand, AnyContext, Command};
use super::report::{Outcome, SchemaEntry};
use crate::gate::Intent;
use crate::prelude::basics::*;

/// A command of a family that needs no robot. It uses only files or this computer.
pub trait OfflineCommand {
    /// Report type.
    type Report: Report + 'static;
    /// Name in envelopes and schemas, such as `toyo.program.check`.
    const ID: &'static str;

    /// Executes the command.
    fn run(&self, screen: &Screen) -> Result<Self::Report>;
}

/// An [`OfflineCommand`] as a member of a set of robot commands.
#[derive(Debug, clap::Args)]
pub struct Offline<C: Args> {
    #[command(flatten)]
    command: C,
}

impl<C: OfflineCommand + Args> Offline<C> {
    fn report(&self, screen: &Screen) -> Outcome {
        Ok(Box::new(self.command.run(screen)?))
    }
}

impl<C: OfflineCommand + Args + 'static> AnyCommand for Offline<C> {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, _robot: Option<&Robot>) -> Intent {
        Intent { risk: Risk::Read, text: String::new(), confirmation: Confirmation::Question, is_stop: false }
    }

    fn without_robot(&self, screen: &Screen) -> Option<Outcome> {
        Some(self.report(screen))
    }

    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        async move { self.report(context.screen) }.boxed_local()
    }
}

/// A command, or a group of subcommands.
pub trait CommandSet {
    /// Converts the parsed arguments to the command.
    fn command(self) -> Box<dyn AnyCommand>;
    /// Schemas of all reports.
    fn schemas() -> Vec<SchemaEntry>;
    /// Adds the subcommands that `is_named` accepts. If a command line does not contain the name of a subcommand, the
    /// parser of this subcommand is not needed.
    fn lay_out(command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command;
    /// Names of the subcommands in their order. The first subcommand below a heading also has the heading.
    fn headings() -> Vec<(Option<&'static str>, String)> {
        Vec::new()
    }
}

impl<C: Command + Args + 'static> CommandSet for C {
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

impl<C: OfflineCommand + Args + 'static> CommandSet for Offline<C> {
    fn lay_out(command: clap::Command, _is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        <Self as Args>::augment_args(command)
    }

    fn command(self) -> Box<dyn AnyCommand> {
        Box::new(self)
    }

    fn schemas() -> Vec<SchemaEntry> {
        vec![SchemaEntry::of::<C::Report>(C::ID)]
    }
}

/// Command-line name of a variant: `PositionError` becomes `position-error`.
pub fn word(variant: &str) -> String {
    let mut word = String::with_capacity(variant.len() + 2);
    for (index, c) in variant.char_indices() {
        word.extend((index > 0 && c.is_ascii_uppercase()).then_some('-'));
        word.push(c.to_ascii_lowercase());
    }
    word
}

/// Declares a clap enum of commands: doc comment, name, and argument type. A text with a colon is the help heading of
/// the commands after it.
#[macro_export]
macro_rules! commands {
    ($(#[$meta:meta])* $visibility:vis enum $name:ident {
        $($($heading:literal:)? $(#[$doc:meta])* $variant:ident($arguments:ty),)*
    }) => {
        $(#[$meta])*
        #[derive(Debug, clap::Subcommand)]
        $visibility enum $name {
            $($(#[$doc])* $variant($arguments),)*
        }

        impl $crate::command_set::CommandSet for $name {
            fn lay_out(mut command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
                $(
                    let name = $crate::command_set::word(stringify!($variant));
                    if is_named(&name) {
                        let verb = clap::Command::new(name);
                        let verb = <$arguments as $crate::command_set::CommandSet>::lay_out(verb, is_named);
                        command = command.subcommand(verb);
                    }
                )*
                command
            }

            fn headings() -> Vec<(Option<&'static str>, String)> {
                vec![$((
                    [$($heading)?].first().copied(),
                    $crate::command_set::word(stringify!($variant)),
                ),)*]
            }

            fn command(self) -> Box<dyn $crate::AnyCommand> {
                match self {
                    $(Self::$variant(arguments) => $crate::command_set::CommandSet::command(arguments),)*
                }
            }

            fn schemas() -> Vec<$crate::report::SchemaEntry> {
                let mut all = Vec::new();
                $(all.extend(<$arguments as $crate::command_set::CommandSet>::schemas());)*
                all
            }
        }
    };
}

/// A group of subcommands as an argument struct, for use in a `commands!` list.
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

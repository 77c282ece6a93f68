//! Commands that send one remote command each. Most commands are of this kind.

use super::confirmed_write::{self, StoredReport};
use super::link::CommandResult;
use crate::prelude::*;

/// A command line that sends one row of the command table.
pub trait SingleCommand {
    /// Report type.
    type Report: Report + 'static;
    /// Name in envelopes and schemas, for example `yrcx.servo`.
    const ID: &'static str;

    /// Row of the command table.
    fn command(&self) -> table::Command;

    /// Sets the fields from the arguments that the user typed.
    fn fill(&self, draft: Draft) -> Draft {
        draft
    }

    /// Returns the text that completes "This will …" in the confirmation question.
    fn intent(&self) -> String {
        String::new()
    }

    /// Report of the result. A dry run has no values.
    fn report(&self, done: &CommandResult) -> Result<Self::Report>;
}

/// Implements [`Command`] for commands with one remote command. A blanket implementation is not possible: the trait is
/// of another crate.
macro_rules! single_command {
    ($($name:ty),*) => {
        $(
        impl armctl_frame::Command for $name {
            type Family = $crate::link::Yrcx;
            type Report = <$name as $crate::single_command::SingleCommand>::Report;
            const ID: &'static str = <$name as $crate::single_command::SingleCommand>::ID;

            fn risk(&self) -> armctl_controller::Risk {
                $crate::single_command::SingleCommand::command(self).row().risk
            }

            fn intent(&self) -> String {
                $crate::single_command::SingleCommand::intent(self)
            }

            fn confirmation(&self) -> armctl_frame::gate::Confirmation {
                $crate::confirmed_write::confirmation($crate::single_command::SingleCommand::command(self))
            }

            async fn run(
                &self,
                context: armctl_frame::Context<'_, $crate::link::Yrcx>,
            ) -> Result<Self::Report, armctl_frame::failure::Failure> {
                $crate::single_command::run(self, context).await
            }
        }
        )*
    };
}
pub(super) use single_command;

/// Sends the command and reports the result.
pub async fn run<S: SingleCommand>(this: &S, context: Context<'_, Yrcx>) -> Result<S::Report> {
    let draft = context.link.draft(this.command())?;
    let order = this.fill(draft).valid_order()?;
    this.report(&confirmed_write::execute_confirmed(context.link, &context.confirmer, &order, this.intent()).await?)
}

/// Result of a row: a report, or a text of what was done.
pub trait IntoReport<R> {
    /// Converts the result to the report.
    fn report(self, done: &CommandResult) -> R;
}

impl<R: Report> IntoReport<R> for R {
    fn report(self, _done: &CommandResult) -> R {
        self
    }
}

impl IntoReport<SetReport> for NewValue {
    fn report(self, done: &CommandResult) -> SetReport {
        self.replaces(done.old.clone())
    }
}

impl IntoReport<StoredReport> for String {
    fn report(self, done: &CommandResult) -> StoredReport {
        confirmed_write::stored(self, done)
    }
}

/// Declares commands that send one remote command each. A declaration has the arguments, the row of the table, the
/// fields, and the confirmation question. It ends with the text of the result, or the report of the answer.
macro_rules! one_row {
    ($(
        $(#[$meta:meta])*
        $name:ident($self:ident) $id:literal -> $report:ty {
            $($(#[$arg:meta])* $field:ident: $type:ty,)*
        }
        gives $row:expr,
        $(with $draft:ident => $filled:expr,)?
        $(intent $intent:expr,)?
        done $(as $answer:ident =>)? $said:expr;
    )*) => {
        $(
            #[derive(Debug, clap::Args)]
            $(#[$meta])*
            pub struct $name {
                $($(#[$arg])* $field: $type,)*
            }

            impl $crate::single_command::SingleCommand for $name {
                type Report = $report;
                const ID: &'static str = $id;

                fn command(&$self) -> armctl_controller::yrcx::table::Command {
                    $row
                }

                $(fn fill(
                    &$self,
                    $draft: armctl_controller::yrcx::order::Draft,
                ) -> armctl_controller::yrcx::order::Draft {
                    $filled
                })?

                $(fn intent(&$self) -> String {
                    $intent.to_owned()
                })?

                fn report(
                    &$self,
                    done: &$crate::link::CommandResult,
                ) -> Result<$report, armctl_frame::failure::Failure> {
                    $(let $answer = done;)?
                    Ok($crate::single_command::IntoReport::report($said, done))
                }
            }

            $crate::single_command::single_command!($name);
        )*
    };
}
pub(super) use one_row;

/// Formats a field of an answer; `None` if the answer does not have the field.
pub fn format_field(command: table::Command, values: &Values, key: Key) -> Option<String> {
    let value = values.value(key)?;
    command.row().answer().find(|field| field.key == key).map(|field| field.show(value))
}

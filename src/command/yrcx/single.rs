//! Commands that send one remote command each. Most commands are of this kind.

use super::link::Done;
use super::link::Yrcx;
use super::overwrite::{self, Stored};
use crate::command::frame::settings_report;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::gate::Confirmation;

/// A command line that sends one row of the command table.
pub trait Single {
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
    fn report(&self, done: &Done) -> Result<Self::Report, Failure>;
}

impl<S: Single> Command for S {
    type Family = Yrcx;
    type Report = S::Report;
    const ID: &'static str = S::ID;

    fn risk(&self) -> Risk {
        Single::command(self).row().risk
    }

    fn intent(&self) -> String {
        Single::intent(self)
    }

    fn confirmation(&self) -> Confirmation {
        overwrite::confirmation(Single::command(self))
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<S::Report, Failure> {
        let draft = context.link.draft(Single::command(self))?;
        let order = self.fill(draft).build()?;
        self.report(&overwrite::give(context.link, &context.authority, &order, Single::intent(self)).await?)
    }
}

/// Result of a row: a report, or a text of what was done.
pub trait Said<R> {
    /// Converts the result to the report.
    fn report(self, done: &Done) -> R;
}

impl<R: Report> Said<R> for R {
    fn report(self, _done: &Done) -> R {
        self
    }
}

impl Said<settings_report::Done> for settings_report::NewValue {
    fn report(self, done: &Done) -> settings_report::Done {
        self.replaces(done.old.clone())
    }
}

impl Said<Stored> for String {
    fn report(self, done: &Done) -> Stored {
        overwrite::stored(self, done)
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

            impl $crate::command::yrcx::single::Single for $name {
                type Report = $report;
                const ID: &'static str = $id;

                fn command(&$self) -> $crate::controller::yrcx::table::Command {
                    $row
                }

                $(fn fill(
                    &$self,
                    $draft: $crate::controller::yrcx::order::Draft,
                ) -> $crate::controller::yrcx::order::Draft {
                    $filled
                })?

                $(fn intent(&$self) -> String {
                    $intent.to_owned()
                })?

                fn report(
                    &$self,
                    done: &$crate::command::yrcx::link::Done,
                ) -> Result<$report, $crate::failure::Failure> {
                    $(let $answer = done;)?
                    Ok($crate::command::yrcx::single::Said::report($said, done))
                }
            }
        )*
    };
}
pub(super) use one_row;

/// Formats a field of an answer; `None` if the answer does not have the field.
pub fn shown(command: table::Command, values: &Values, key: Key) -> Option<String> {
    let value = values.value(key)?;
    command.row().answer().find(|field| field.key == key).map(|field| field.show(value))
}

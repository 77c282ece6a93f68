//! Commands that give one remote command each: most of them do.

use super::link::Done;
use super::link::Yrcx;
use super::overwrite;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::gate::Confirmation;

/// A command line that is one row of the table.
pub trait Single {
    /// What it reports.
    type Report: Report + 'static;
    /// `yrcx.servo`: its name in envelopes and schemas.
    const ID: &'static str;

    /// The row.
    fn command(&self) -> table::Command;

    /// Fills in what was typed.
    fn fill(&self, draft: Draft) -> Draft {
        draft
    }

    /// Completes "This will …" in the question before a motion.
    fn intent(&self) -> String {
        String::new()
    }

    /// What came of it. In a dry run there are no values.
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
        self.report(&overwrite::give(context.link, &context.authority, &order).await?)
    }
}

/// What a field of an answer says, in words; nothing where the answer has no such field.
pub fn shown(command: table::Command, values: &Values, key: Key) -> Option<String> {
    let value = values.value(key)?;
    command.row().answer().find(|field| field.key == key).map(|field| field.show(value))
}

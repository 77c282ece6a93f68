//! `copy`: copies the content of a row to other rows.

use super::change::{TableWrite, confirmation, intent, write};
use super::get::Rows;
use super::{Writable, WrittenOf, read};
use crate::dry_run::Known as _;
use crate::prelude::basics::*;
use crate::robot::item::as_requested;
use crate::{Command, Context};

/// Copies a row to one or several other rows.
#[derive(Debug, Args)]
pub struct Copy<S: Writable> {
    /// Row to copy
    #[arg(value_name = "FROM", value_parser = Rows::<S>::parse)]
    from: Rows<S>,
    /// Rows that get the content of this row
    #[arg(required = true, value_name = "TO", value_delimiter = ',', value_parser = Rows::<S>::parse)]
    to: Vec<Rows<S>>,
    #[command(flatten)]
    options: S::Options,
}

impl<S: Writable> Command for Copy<S> {
    type Family = S::Family;
    type Report = WrittenOf<S>;
    const ID: &'static str = S::IDS.copy;
    const RISK: Risk = S::RISK;
    const CONFIRMATION: Confirmation = confirmation::<S>();

    fn intent(&self) -> String {
        intent::<S>()
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<WrittenOf<S>> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let copy_one = S::WORDS.nouns[0];
        let [from] = self.from.0[..] else {
            return Err(Failure::usage(format!("only one {copy_one} can be copied at a time"))
                .hint("type the row to copy, then the rows to write"));
        };
        let name = as_requested(copy_one, &S::name(from));
        let to = Rows::of(&self.to);
        if to.contains(&from) {
            return Err(Failure::usage(format!("{name} cannot be copied to itself")).hint("type another row"));
        }
        let mut table = S::open(link, &self.options).await?;
        table.prepare(link, &[&to[..], &[from]].concat()).await?;
        // In a dry run, the values of the row are unknown.
        let mut texts = vec![None; table.fields().len()];
        if let Some(answers) = read(&mut table, link, screen, &[from]).await.known()? {
            let stored = answers.rows.into_iter().next().transpose()?.flatten().ok_or_else(|| {
                let message = format!("{name} is not defined: there is nothing to copy");
                Failure::new(Kind::ConditionNotMet, message).hint("type a row that is defined; nothing was written")
            })?;
            texts = table.texts(&stored).into_iter().map(Some).collect();
        }
        let texts: Vec<Option<&str>> = texts.iter().map(Option::as_deref).collect();
        let draft = |key: S::Key| {
            Ok((
                key,
                table
                    .draft(key, &texts)
                    .map_err(|why| Failure::usage(why).hint("correct the command; nothing was written"))?,
            ))
        };
        let rows = to.into_iter().map(draft).collect::<Result<_>>()?;
        write(TableWrite { table, robot, link, screen, confirmer }, rows).await?.or_only_failure()
    }
}

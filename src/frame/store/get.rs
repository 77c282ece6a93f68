//! `get` and `list`. `watch` repeats `get`.

use super::{ItemsOf, Store, columns, item, read, read_keys};
use crate::items::ItemError;
use crate::names;
use crate::prelude::basics::*;
use crate::robot::item::{Item, Items};
use crate::watch::{Watchable, Watched};
use crate::{Command, Context};

/// Row arguments, after parsing.
#[derive(Debug)]
pub struct Rows<S: Store>(pub Vec<S::Key>);

impl<S: Store> Clone for Rows<S> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<S: Store> Rows<S> {
    /// Parses the arguments.
    ///
    /// # Errors
    /// If an argument is not a row.
    pub fn parse(text: &str) -> Result<Self, String> {
        read_keys::<S>(text).map(Self)
    }

    /// The rows that the user typed, without duplicates; all rows if the user typed none.
    pub fn of(given: &[Self]) -> Vec<S::Key> {
        if given.is_empty() {
            S::all()
        } else {
            user_input::without_duplicates(given.iter().flat_map(|rows| rows.0.iter().copied()))
        }
    }
}

/// Reads rows.
#[derive(Debug, Args)]
#[command(after_help = S::help().or(S::WORDS.reading))]
pub struct Get<S: Store> {
    #[command(flatten)]
    options: S::Options,
    #[arg(required = S::all().is_empty(), value_name = S::WORDS.placeholder, value_delimiter = ',',
        value_parser = Rows::<S>::parse, help = S::WORDS.range, add = S::COMPLETE)]
    rows: Vec<Rows<S>>,
}

impl<S: Store> Command for Get<S> {
    type Family = S::Family;
    type Report = ItemsOf<S>;
    const ID: &'static str = S::IDS.get;

    fn risk(&self) -> Risk {
        S::risk_of_reading(&self.options)
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<ItemsOf<S>> {
        let Context { robot, link, screen, .. } = context;
        let keys = Rows::of(&self.rows);
        let mut table = S::open(link, &self.options).await?;
        table.prepare(link, &keys).await?;
        let answers = read(&mut table, link, screen, &keys).await?;
        let names = names::of_robot(robot, screen);
        let mut undefined = Vec::new();
        let items = keys.iter().zip(answers.rows).map(|(key, outcome)| {
            let outcome = match outcome {
                Err(failure) if S::UNDEFINED_IS_NULL && S::is_undefined(&failure) => {
                    undefined.push(ItemError::new(S::asked(*key), failure));
                    Ok(None)
                }
                outcome => outcome,
            };
            item(&table, names, *key, outcome)
        });
        let items = items.collect();
        Items::new(columns(&table), items).asked(answers.asked).undefined(undefined).single_failure()
    }
}

impl<S: Store> Watchable for Get<S> {
    type Value = S::Value;

    const WATCH: &'static str = S::IDS.watch;
    const WATCHED: Watched = Watched::ITEMS;
}

/// Reads all rows, and shows the rows that are not empty.
#[derive(Debug, Args)]
pub struct List<S: Store> {
    #[command(flatten)]
    options: S::Options,
    #[arg(value_name = S::WORDS.placeholder, value_delimiter = ',', required = S::all().is_empty(),
        value_parser = Rows::<S>::parse,
        help = if S::all().is_empty() { S::WORDS.range } else { "Show only these rows" })]
    rows: Vec<Rows<S>>,
    /// Show empty rows too
    #[arg(long)]
    empty: bool,
}

impl<S: Store> List<S> {
    /// The rows that the user typed; all rows if the user typed none.
    pub fn keys(&self) -> Vec<S::Key> {
        Rows::of(&self.rows)
    }
}

impl<S: Store> Command for List<S> {
    type Family = S::Family;
    type Report = ItemsOf<S>;
    const ID: &'static str = S::IDS.list;

    fn risk(&self) -> Risk {
        S::risk_of_reading(&self.options)
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<ItemsOf<S>> {
        let Context { robot, link, screen, .. } = context;
        let keys = self.keys();
        let mut table = S::open(link, &self.options).await?;
        table.prepare(link, &keys).await?;
        let answers = read(&mut table, link, screen, &keys).await?;
        let names = names::of_robot(robot, screen);
        let rows = answers.rows.into_iter().map(defined::<S>);
        let stored = keys.into_iter().zip(rows).filter(|(_, outcome)| {
            let is_empty = |wire: &Option<S::Wire>| wire.as_ref().is_none_or(|wire| table.is_blank(wire));
            self.empty || !outcome.as_ref().is_ok_and(is_empty)
        });
        let items: Vec<Item<S::Value, S::More>> =
            stored.map(|(key, outcome)| item(&table, names, key, outcome)).collect();
        Ok(Items::new(columns(&table), items))
    }
}

/// Converts the refusal of a row that is not defined to `None`. In a list of all rows, such a row is not an error.
pub fn defined<S: Store>(outcome: Result<Option<S::Wire>>) -> Result<Option<S::Wire>> {
    match outcome {
        Err(failure) if S::is_undefined(&failure) => Ok(None),
        outcome => outcome,
    }
}

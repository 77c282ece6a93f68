//! `toyo mvm set`.

use clap::Args;

use super::{Group, SHEETS, VALUES, field, item, reads, sheet};
use crate::command::frame::dry_run::unknown;
use crate::command::robot::item::{Written, WrittenItems};
use crate::command::toyo::eeprom::THERE;
use crate::command::toyo::link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::{ask_all, number};
use crate::command::toyo::rows::Listed;
use crate::command::toyo::stores::{self, Store, StoreTask, parameter_cell, parameter_sketch};
use crate::command::toyo::values::{assignment, word};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::nearest::nearest;
use crate::controller::toyo::field::Value;
use crate::failure::Failure;
use crate::gate::Confirmation;

/// A group, and what shall change in it.
#[derive(Debug, Args)]
#[command(
    after_help = "Values: origin, p1, p2, p3 (rows of the coordinate table, 0 for none); pieces1 to pieces3; counter1 to \
                  counter3; approach (absolute or incremental), approach-z, approach-r, destination-r (mm). What is not \
                  named stays. What the controller holds already is not written: its EEPROM takes about a million \
                  rewrites."
)]
pub struct Set {
    /// Group, 1 to 32
    #[arg(value_name = "GROUP", value_parser = |text: &str| number(&field(), text))]
    group: i32,
    /// Such as origin=5, pieces1=10, approach=absolute
    #[arg(required = true, value_name = "NAME=VALUE")]
    values: Vec<String>,
}

/// What shall become of the values of a sheet.
type Changes = Vec<Option<Value>>;

const WORK: StoreTask = StoreTask { doing: "storing sheets", noun: "", things: ["a sheet", "sheets"], resumes: false };

impl Command for Set {
    type Family = Toyo;
    type Report = WrittenItems<Group, Listed>;
    const ID: &'static str = "toyo.mvm.set";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a matrix";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<WrittenItems<Group, Listed>, Failure> {
        let Context { link, screen, authority, .. } = context;
        let changes = self.changes()?;
        let reads = reads(self.group)?;
        if link.is_dry() {
            for read in &reads {
                link.plan(read, THERE);
            }
            for (index, changes) in
                changes.iter().enumerate().filter(|(_, changes)| changes.iter().any(Option::is_some))
            {
                link.plan_overwriting(&reads[index], &parameter_sketch(sheet(index), Some(self.group), changes))
                    .await?;
            }
            return Err(unknown());
        }
        let mut sheets = ask_all(link, screen, "reading sheets", &reads).await?;
        let old = Group::of(&sheets);
        let mut stores = Vec::new();
        for (index, changes) in changes.iter().enumerate().filter(|(_, changes)| changes.iter().any(Option::is_some)) {
            let found = sheets[index].values().get(1..).unwrap_or_default();
            let values = changes.iter().zip(found).map(|(change, found)| change.as_ref().unwrap_or(found).clone());
            let store = self.store(index, values.collect())?.over(Some(sheets[index].clone()));
            sheets[index] = store.cell.wanted.clone();
            stores.push(store);
        }
        let of = format!(" of group {}", self.group);
        authority.confirm(&stores::replacing(WORK, &stores, &of)).await?;
        let fates = stores::store_all(link, screen, WORK, &stores, 0).await?;
        let cells = stores::sum(&fates);
        let sheets: Vec<_> = sheets.into_iter().map(Ok).collect();
        let item = item(self.group, &sheets);
        let words = format!("group {}: {}\n{}", self.group, self.values.join(" "), cells.in_words());
        Ok(WrittenItems::said(words, vec![Written::new(item, Some(old), cells.cells_written > 0)]))
    }
}

impl Set {
    /// A sheet of the group, with all its values.
    fn store(&self, index: usize, values: Vec<Value>) -> Result<Store, Failure> {
        let values = std::iter::once(Value::Number(self.group)).chain(values).collect();
        let cell = parameter_cell(sheet(index), values).map_err(|error| link::wrong(&error))?;
        Ok(Store::new(sheet(index).name, cell))
    }

    /// What was typed, sheet by sheet.
    fn changes(&self) -> Result<Vec<Changes>, Failure> {
        let mut changes: Vec<Changes> =
            (0..SHEETS.len()).map(|index| vec![None; sheet(index).fields().len()]).collect();
        for text in &self.values {
            let wrong = |error: String| Failure::usage(error).hint("`toyo mvm set --help` names the values");
            let (name, value) = assignment(text).ok_or_else(|| wrong(format!("'{text}' is not NAME=VALUE")))?;
            let known = VALUES.iter().find(|(known, ..)| known.eq_ignore_ascii_case(name));
            let (name, index, place) = known.ok_or_else(|| {
                let near = nearest(name, VALUES.iter().map(|(known, ..)| *known));
                let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
                wrong(format!("there is no value '{}'{near}", name.escape_debug()))
            })?;
            let value = word(&sheet(*index).fields()[*place].named(name), value).map_err(wrong)?;
            if changes[*index][*place].replace(value).is_some() {
                return Err(wrong(format!("{name} is given twice")));
            }
        }
        Ok(changes)
    }
}

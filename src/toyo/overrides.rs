//! `toyo override`: speed override of programs.

use super::eeprom::{Cell, Cells};
use super::number_arguments::{number, saturated_byte};
use crate::prelude::*;
use armctl_controller::toyo::field::Field;
use armctl_frame::robot::item::{Columns, Item, Items, Written, WrittenItems};

commands! {
    /// Commands for the override.
    pub enum Override {
        /// Read the override
        Get(Get),
        /// Write the override to the EEPROM. Use it while no program runs
        Set(Set),
    }
}

/// Show the override.
#[derive(Debug, Args)]
pub struct Get {}

/// Write the override, if the new value differs.
#[derive(Debug, Args)]
#[command(after_help = "The controller stores the value in an EEPROM cell, which wears out after about a million \
                        writes: do not set the override in a loop. Set it while no program runs: a change has no effect on a running program.")]
pub struct Set {
    /// Override in percent, 1 to 100
    #[arg(value_name = "PERCENT", value_parser = percent)]
    percent: i32,
}

/// Field of WOVR OV=001.
fn field() -> &'static Field {
    &table::Command::Wovr.row().requests[0].fields[0]
}

fn percent(text: &str) -> Result<i32, String> {
    number(field(), text.strip_suffix('%').unwrap_or(text))
}

/// The override as an item.
fn item(percent: u8) -> Item<u8> {
    Item::new("override", "override", Ok(Some(percent))).with_cells(|percent| vec![(*percent).into()])
}

impl Command for Get {
    type Family = Toyo;
    type Report = Items<u8>;
    const ID: &'static str = "toyo.override.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Items<u8>> {
        let answer = context.link.ask(&Request::bare(table::Command::Rovr)).await?;
        let columns = Columns { name: "override", values: vec!["percent"], empty: "nothing stored" };
        Ok(Items::new(columns, vec![item(saturated_byte(&answer, field().name))]))
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = WrittenItems<u8>;
    const ID: &'static str = "toyo.override.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<WrittenItems<u8>> {
        let value = Value::Number(self.percent);
        let wanted = table::Command::Rovr.row().answers[0].record(vec![value.clone()]);
        let cell = Cell {
            read: Request::bare(table::Command::Rovr),
            write: Request::of(table::Command::Wovr, [value]),
            wanted: wanted.map_err(|error| wrong(&error))?,
        };
        let new = saturated_byte(&cell.wanted, field().name);
        let mut cells = Cells::default();
        let stored = context.link.store(context.screen, &cell, &mut cells).await?;
        let old = stored.map(|record| saturated_byte(&record, field().name));
        let written = Written::new(item(new), old, cells.cells_written > 0);
        Ok(WrittenItems::describe(format!("override {new} %: {}", cells.in_words()), vec![written]))
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::Bench;

    #[test]
    fn an_override_is_an_item_with_old_and_new_value() {
        let mut bench = Bench::new("sim:");
        let set = bench.data(&["override", "set", "50"])["items"][0].clone();
        assert_eq!((&set["old"], &set["new"], &set["written"]), (&100.into(), &50.into(), &true.into()), "{set}");
        assert_eq!(bench.data(&["override", "set", "50"])["items"][0]["written"], false);
        let read = bench.data(&["override", "get"])["items"][0].clone();
        assert_eq!((&read["kind"], &read["value"]), (&"override".into(), &50.into()), "{read}");
    }
}

//! `toyo override`: speed override of programs.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::eeprom::{Cell, Cells};
use super::link::Toyo;
use super::link::wrong;
use super::numbers::{number, small};
use crate::command::frame::settings_report::{Done, NewValue, Old};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::output::view::View;

commands! {
    /// Commands for the override.
    pub enum Override {
        /// Read the override
        Get(Get),
        /// Write the override to the EEPROM; takes effect while no program runs
        Set(Set),
    }
}

/// Show the override.
#[derive(Debug, Args)]
pub struct Get {}

/// Write the override if it differs.
#[derive(Debug, Args)]
#[command(after_help = "The controller stores the value in an EEPROM cell, which wears out after about a million \
                        writes: do not set the override in a loop. A running program keeps its override.")]
pub struct Set {
    /// 1 to 100
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

impl Command for Get {
    type Family = Toyo;
    type Report = Percent;
    const ID: &'static str = "toyo.override.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Percent, Failure> {
        let answer = context.link.ask(&Request::bare(table::Command::Rovr)).await?;
        Ok(Percent { speed_override_percent: small(&answer, field().name) })
    }
}

impl Command for Set {
    type Family = Toyo;
    type Report = WriteReport;
    const ID: &'static str = "toyo.override.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<WriteReport, Failure> {
        let value = Value::Number(self.percent);
        let wanted = table::Command::Rovr.row().answers[0].record(vec![value.clone()]);
        let cell = Cell {
            read: Request::bare(table::Command::Rovr),
            write: Request::of(table::Command::Wovr, [value]),
            wanted: wanted.map_err(|error| wrong(&error))?,
        };
        let mut cells = Cells::default();
        let stored = context.link.store(context.screen, &cell, &mut cells).await?;
        let old = Old::read(stored.and_then(|record| record.number(field().name)));
        let new = NewValue::of("override", self.percent, format!("override {} %: {}", self.percent, cells.in_words()));
        Ok(WriteReport { done: new.with("speed_override_percent", self.percent).replaces(old), cells })
    }
}

/// The override.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Percent {
    speed_override_percent: u8,
}

/// Result of a write.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WriteReport {
    #[serde(flatten)]
    done: Done,
    #[serde(flatten)]
    cells: Cells,
}

impl Report for Percent {
    fn view(&self) -> View {
        View::text(format!("{} %", self.speed_override_percent))
    }
}

impl Report for WriteReport {
    fn view(&self) -> View {
        self.done.view()
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{all_blocks, blocks, objection};

    #[test]
    fn an_equal_override_is_not_written() {
        assert_eq!(all_blocks(&["override", "get"]).unwrap(), ["@ROVR"]);
        assert_eq!(blocks(&["override", "set", "5%"]).unwrap(), ["@ROVR", "@WOVR OV=005", "@ROVR"]);
        assert_eq!(
            all_blocks(&["override", "set", "100"]).unwrap(),
            ["@ROVR", "@STAS SNO=2", "@HSON", "@STAS SNO=0", "@WOVR OV=100", "@ROVR", "@HSOF"]
        );
    }

    #[test]
    fn an_override_out_of_range_is_rejected() {
        for percent in ["0", "101", "x", "50.5"] {
            assert!(objection(&["override", "set", percent]).contains("1 to 100 %"), "{percent}");
        }
    }
}

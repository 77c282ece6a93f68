//! `toyo param set`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{machine, parse_name};
use crate::command::toyo::complete;
use crate::command::toyo::eeprom::Cells;
use crate::command::toyo::link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::stores::{self, Store, StoreTask, parameter_cell, parameter_sketch};
use crate::command::toyo::values::{self, Changes, Shown};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::{Group, Parameter};
use crate::failure::Failure;
use crate::gate::{Change, Confirmation};
use crate::output::csv::RowsOf;
use crate::output::view::View;

/// A parameter, and what it shall hold.
#[derive(Debug, Args)]
#[command(
    after_help = "All values in their order, or some by name, which keeps the others: `param set soft-limit-plus 100 \
                  200 0 0`, `param set P01 ax2=150`. Words as on the line or by what they mean: `param set \
                  pendant-language english`. A bit of a port is STATION/PORT/BIT: 0/01/3.\n\n\
                  What the controller holds already is not written: its EEPROM takes about a million rewrites. \
                  Machine parameters (E): after a change only communication works until the power was \
                  switched off and on."
)]
pub struct Set {
    /// Name or id in any case: soft-limit-plus, P01
    #[arg(value_name = "NAME", value_parser = parse_name, add = complete::PARAMETER)]
    parameter: &'static Parameter,
    /// All values in their order, or some as name=value
    #[arg(required = true, value_name = "VALUE", allow_negative_numbers = true)]
    values: Vec<String>,
}

const WORK: StoreTask =
    StoreTask { doing: "storing a parameter", noun: "", things: ["a parameter", "parameters"], resumes: false };

impl Command for Set {
    type Family = Toyo;
    type Report = Written;
    const ID: &'static str = "toyo.param.set";
    const RISK: Risk = Risk::Destroy;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        format!("overwrite parameter {} ({})", self.parameter.id, self.parameter.name)
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Written, Failure> {
        let Context { link, screen, authority, .. } = context;
        let parameter = self.parameter;
        let changes = Changes::read(parameter.name, &parameter.body(), &self.values)?;
        if let Some(values) = changes.whole() {
            machine::check(parameter, &values)?;
        }
        let read = Request::read_parameter(parameter, None).map_err(|error| link::wrong(&error))?;
        let sketch = |values: &[Option<Value>]| parameter_sketch(parameter, None, values);
        let (values, found) = changes.completed(link, &read, sketch).await?;
        machine::check(parameter, &values)?;
        let cell = parameter_cell(parameter, values).map_err(|error| {
            Failure::usage(format!("{}: {error}", parameter.name))
                .hint("the controller holds a value that may not be written; give all values")
        })?;
        for warning in machine::warnings(parameter, found.as_ref(), cell.wanted.values()) {
            screen.note(&warning);
        }
        let store = Store::new(parameter.id, cell).over(found);
        let change = stores::replacing(WORK, std::slice::from_ref(&store), "");
        authority.confirm(&machine::consequence(parameter).into_iter().fold(change, Change::note)).await?;
        let cells = stores::sum(&stores::store_all(link, screen, WORK, std::slice::from_ref(&store), 0).await?);
        Ok(Written {
            id: parameter.id,
            name: parameter.name,
            values: values::shown(&store.cell.wanted),
            items: stores::written(std::slice::from_ref(&store)),
            cells,
            needs_power_cycle: parameter.group() == Group::Machine && cells.cells_written > 0,
        })
    }
}

/// What a parameter holds now.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Written {
    /// `P01`.
    id: &'static str,
    /// `soft-limit-plus`.
    name: &'static str,
    values: Vec<Shown>,
    /// What it held and holds.
    items: stores::WrittenCells,
    #[serde(flatten)]
    cells: Cells,
    /// Nothing but communication works until the controller's power was switched off and on.
    needs_power_cycle: bool,
}

/// What to do after a machine parameter was changed.
pub const POWER_CYCLE: &str = "switch the controller's power off and on: until then only communication works";

impl Report for Written {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        let values = values::in_a_line(&self.values);
        let mut text = format!("{} {}: {values}\n{}", self.id, self.name, self.cells.in_words());
        if self.needs_power_cycle {
            text.push('\n');
            text.push_str(POWER_CYCLE);
        }
        View::text(text)
    }
}

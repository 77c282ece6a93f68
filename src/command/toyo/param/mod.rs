//! `toyo param`: parameters, one or all.

mod dump;
mod entry;
mod get;
mod list;
mod machine;
mod restore;
mod set;

pub use dump::{DumpReport, Failed, Unfit};
pub use machine::consequence_of;
pub use restore::store;

use crate::command::commands;
use crate::controller::nearest::nearest;
use crate::controller::toyo::table::Parameter;
use crate::controller::toyo::table::parameters::PARAMETERS;

commands! {
    /// What can be done with parameters.
    pub enum Param {
        /// Read parameters by name or id: soft-limit-plus P01 M09
        Get(get::Get),
        /// Change a parameter: soft-limit-plus 100 200 0 0
        Set(set::Set),
        /// Read all parameters
        List(list::List),
        /// Save all parameters and tables as TOML
        Dump(dump::Dump),
        /// Write parameters from a file
        Restore(restore::Restore),
    }
}

/// Parameters that have no rows.
fn singles() -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(|parameter| parameter.row().is_none())
}

/// A parameter by its name or id.
fn parse_name(name: &str) -> Result<&'static Parameter, String> {
    match Parameter::named(name) {
        Some(parameter) if parameter.row().is_some() => {
            Err(format!("{} is a table; `toyo {} get` reads its rows", parameter.name, command_of(parameter)))
        }
        Some(parameter) => Ok(parameter),
        None => {
            let known = singles().flat_map(|parameter| [parameter.name, parameter.id]);
            let near = nearest(name, known).map_or(String::new(), |near| format!("; did you mean {near}?"));
            Err(format!("there is no such parameter{near}"))
        }
    }
}

/// The noun that leads to the rows of a table.
fn command_of(table: &Parameter) -> &'static str {
    match &table.id[..2] {
        "T1" => "point",
        "T2" => "speed-table",
        "T3" => "accel-table",
        "T4" => "mvm",
        _ => "torque-table",
    }
}

#[cfg(test)]
mod tests;

//! `toyo param restore`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;

use super::dump::key_text;
use super::machine;
use super::set::POWER_CYCLE;
use crate::command::toyo::eeprom::{Cell, Cells};
use crate::command::toyo::link::Toyo;
use crate::command::toyo::stores::{self, CellState, Store, StoreResult, StoreTask};
use crate::command::toyo::{files, link};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::bulk::{Setting, parameters};
use crate::controller::toyo::table::Group;
use crate::failure::{Failure, Kind};
use crate::gate::Confirmation;
use crate::output::view::View;

/// Which file, and what of it.
#[derive(Debug, Args)]
#[command(
    after_help = "All of the file is checked before anything is sent. What the controller holds already is not written: \
                  its EEPROM takes about a million rewrites. If the work is cut off, it says what is done; the same \
                  command, or --resume, goes on.\n\n\
                  Machine parameters (E) and special ones (U) are left out unless --group names them. Machine parameters \
                  come last: after a change only communication works until the controller's power was switched off and \
                  on."
)]
pub struct Restore {
    /// What `param dump` wrote, or somebody with an editor; - is stdin
    file: PathBuf,
    /// Only these, such as machine,special [default: mode,axis,table]
    #[arg(long, value_name = "GROUP", value_delimiter = ',')]
    group: Vec<Part>,
    /// Go on with a file that was cut off; with a key, such as P05 or T2.7, those before it are not even compared
    #[arg(long, value_name = "KEY", num_args = 0..=1, require_equals = true, default_missing_value = "")]
    resume: Option<String>,
}

/// A part of a file of parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Part {
    /// M: how the controller is used
    Mode,
    /// P, parameter 1: axes
    Axis,
    /// T: tables
    Table,
    /// U, parameter 3: not for normal use
    Special,
    /// E, parameter 2: the machine
    Machine,
}

/// In the order of writing: after a machine parameter, a controller may take nothing else.
const ORDER: [(Part, Group); 5] = [
    (Part::Mode, Group::Mode),
    (Part::Axis, Group::Axis),
    (Part::Table, Group::Table),
    (Part::Special, Group::Special),
    (Part::Machine, Group::Machine),
];
/// What is written if nobody says which.
const USUAL: [Part; 3] = [Part::Mode, Part::Axis, Part::Table];

const WORK: StoreTask =
    StoreTask { doing: "storing parameters", noun: "", things: ["a parameter", "parameters"], resumes: true };

impl Command for Restore {
    type Family = Toyo;
    type Report = Restored;
    const ID: &'static str = "toyo.param.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite parameters by those of the file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Restored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let name = files::shown(&self.file);
        let read = parameters::read(&files::read(&self.file)?);
        let settings = read.map_err(|errors| files::faulty(&name, &errors))?;
        let (chosen, left): (Vec<Setting>, Vec<Setting>) =
            settings.into_iter().map(|(setting, _)| setting).partition(|setting| self.place(setting).is_some());
        let mut chosen = chosen;
        chosen.sort_by_key(|setting| self.place(setting));
        if chosen.is_empty() {
            return Err(Failure::usage(format!("{name} holds no parameters of the groups wanted"))
                .hint("--group chooses the groups: mode, axis, table, special, machine"));
        }
        let mut stores = chosen.iter().map(store).collect::<Result<Vec<Store>, Failure>>()?;
        let left_out = stores::left_out(&stores, self.resume.as_deref())?;
        let other_groups = left.iter().map(|setting| key_text((setting.parameter, setting.row()))).collect::<Vec<_>>();
        if self.group.is_empty() && !other_groups.is_empty() {
            let parameters = if other_groups.len() == 1 { "parameter" } else { "parameters" };
            let left = format!("{} machine or special {parameters} left out", other_groups.len());
            screen.note(&format!("{left} (--group machine,special)"));
        }
        let wanted = &mut stores[left_out..];
        stores::look(link, screen, wanted).await?;
        let (mut change, mut changed) = (stores::replacing(WORK, wanted, ""), Vec::new());
        for (setting, store) in chosen[left_out..].iter().zip(wanted) {
            let found = if let CellState::This(found) = &store.found { Some(found) } else { None };
            for warning in machine::warnings(setting.parameter, found, &setting.values) {
                screen.note(&warning);
            }
            if setting.parameter.group() == Group::Machine && store.differs() {
                changed.push(setting.parameter);
            }
        }
        if !changed.is_empty() {
            change = change.note(machine::consequence_of(&changed));
        }
        authority.confirm(&change).await?;
        let fates = stores::store_all(link, screen, WORK, &stores, left_out).await?;
        let is_machine = |setting: &Setting| setting.parameter.group() == Group::Machine;
        let needs_power_cycle =
            chosen.iter().zip(&fates).any(|(setting, fate)| is_machine(setting) && *fate == StoreResult::Written);
        let parameters = chosen.iter().zip(&stores).zip(&fates).map(|((setting, store), fate)| Row {
            key: store.key.clone(),
            name: setting.parameter.name,
            result: *fate,
        });
        Ok(Restored {
            file: name,
            parameters: parameters.collect(),
            other_groups,
            cells: stores::sum(&fates),
            needs_power_cycle,
        })
    }
}

impl Restore {
    /// Where in the order of writing a setting stands; `None` if its group is not wanted.
    fn place(&self, setting: &Setting) -> Option<usize> {
        let wanted = if self.group.is_empty() { &USUAL[..] } else { &self.group };
        ORDER.iter().position(|(part, group)| *group == setting.parameter.group() && wanted.contains(part))
    }
}

/// A setting as something that is stored.
pub fn store(setting: &Setting) -> Result<Store, Failure> {
    let wrong = |error| link::wrong(&error);
    let cell = Cell {
        read: setting.read().map_err(wrong)?,
        write: setting.write().map_err(wrong)?,
        wanted: setting.parameter.layout.record(setting.values.clone()).map_err(wrong)?,
    };
    let is_optional = !setting.parameter.only_on.is_empty();
    Ok(Store { is_optional, ..Store::new(key_text((setting.parameter, setting.row())), cell) })
}

/// Result of the parameters of a file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    file: String,
    parameters: Vec<Row>,
    /// In the file, but of groups that were not wanted.
    other_groups: Vec<String>,
    #[serde(flatten)]
    cells: Cells,
    /// Nothing but communication works until the controller's power was switched off and on.
    needs_power_cycle: bool,
}

/// A parameter or a row, and what became of it.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Row {
    /// `P01`, or a row as `T2.5`.
    key: String,
    /// `soft-limit-plus`.
    name: &'static str,
    result: StoreResult,
}

impl Restored {
    fn of(&self, fate: StoreResult) -> Vec<&str> {
        self.parameters.iter().filter(|row| row.result == fate).map(|row| &row.key[..]).collect()
    }
}

impl Report for Restored {
    fn view(&self) -> View {
        let mut lines = Vec::new();
        for (words, fate) in [("written", StoreResult::Written), ("not on this controller", StoreResult::NotThere)] {
            let keys = self.of(fate);
            if !keys.is_empty() {
                lines.push(format!("{words}: {}", keys.join(", ")));
            }
        }
        lines.push(self.cells.in_words());
        if self.needs_power_cycle {
            lines.push(POWER_CYCLE.to_owned());
        }
        View::text(lines.join("\n"))
    }

    fn failure(&self) -> Option<Failure> {
        let absent = self.of(StoreResult::NotThere);
        if absent.is_empty() {
            return None;
        }
        let message = format!("the controller does not have {}; the rest is stored", absent.join(", "));
        Some(Failure::new(Kind::Refused, message).code("NG").hint("the file is of another controller"))
    }
}

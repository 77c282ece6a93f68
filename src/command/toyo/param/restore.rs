//! `toyo param restore`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{About, Key, Parameters};
use crate::command::frame::store::{TableWrite, write};
use crate::command::robot::item::WrittenItems;
use crate::command::toyo::files;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::values::{Changes, Shown};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::bulk::{Setting, parameters};
use crate::controller::toyo::table::Group;
use crate::failure::Failure;
use crate::gate::Confirmation;

/// Write parameters from a file.
#[derive(Debug, Args)]
#[command(after_help = "The whole file is checked before anything is sent. Equal values are not written, because \
                  the EEPROM takes about a million rewrites. After an interruption, the same command continues.\n\n\
                  Machine parameters (E) and special ones (U) need --group. Machine parameters \
                  are written last: after a change the controller executes nothing before a \
                  restart.")]
pub struct Restore {
    /// File from `param dump` or an editor; - is stdin
    file: PathBuf,
    /// Groups to write, such as machine,special [default: mode,axis,table]
    #[arg(long, value_name = "GROUP", value_delimiter = ',')]
    group: Vec<Part>,
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

/// Order of the writes. After a machine parameter, a controller can refuse all others.
const ORDER: [(Part, Group); 5] = [
    (Part::Mode, Group::Mode),
    (Part::Axis, Group::Axis),
    (Part::Table, Group::Table),
    (Part::Special, Group::Special),
    (Part::Machine, Group::Machine),
];
/// Default groups.
const USUAL: [Part; 3] = [Part::Mode, Part::Axis, Part::Table];

impl Command for Restore {
    type Family = Toyo;
    type Report = WrittenItems<Vec<Shown>, About>;
    const ID: &'static str = "toyo.param.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite parameters with those of the file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Self::Report, Failure> {
        let Context { robot, link, screen, authority, .. } = context;
        let name = files::display_path(&self.file);
        let read = parameters::read(&files::read(&self.file)?);
        let settings = read.map_err(|errors| files::file_failure(&name, &errors))?;
        let settings = settings.into_iter().map(|(setting, _)| setting);
        let (mut chosen, left): (Vec<Setting>, Vec<Setting>) =
            settings.partition(|setting| self.place(setting).is_some());
        chosen.sort_by_key(|setting| self.place(setting));
        if chosen.is_empty() {
            return Err(Failure::usage(format!("{name} has no parameters of the selected groups"))
                .hint("select groups with --group: mode, axis, table, special, machine"));
        }
        if self.group.is_empty() && !left.is_empty() {
            let parameters = if left.len() == 1 { "parameter" } else { "parameters" };
            let left_out = format!("skipped {} machine or special {parameters}", left.len());
            screen.note(&format!("{left_out} (--group machine,special)"));
        }
        let row = |setting: Setting| {
            let keys = setting.parameter.key.fields.len();
            let values = setting.values[keys..].iter().cloned().map(Some).collect();
            (Key { parameter: setting.parameter, row: setting.row() }, Changes::of(values))
        };
        let rows = chosen.into_iter().map(row).collect();
        write(TableWrite { table: Parameters, robot, link, screen, authority }, rows).await
    }
}

impl Restore {
    /// Position of a setting in the order of the writes; `None` if its group is not selected.
    fn place(&self, setting: &Setting) -> Option<usize> {
        let wanted = if self.group.is_empty() { &USUAL[..] } else { &self.group };
        ORDER.iter().position(|(part, group)| *group == setting.parameter.group() && wanted.contains(part))
    }
}

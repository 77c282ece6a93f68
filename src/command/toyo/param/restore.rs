//! `toyo param restore`.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::{About, Key, Parameters};
use crate::command::frame::store::{Work, write};
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

/// Which file, and what of it.
#[derive(Debug, Args)]
#[command(
    after_help = "All of the file is checked before anything is sent. What the controller holds already is not written: \
                  its EEPROM takes about a million rewrites. If the work is cut off, the same command goes on.\n\n\
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

impl Command for Restore {
    type Family = Toyo;
    type Report = WrittenItems<Vec<Shown>, About>;
    const ID: &'static str = "toyo.param.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite parameters by those of the file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Self::Report, Failure> {
        let Context { robot, link, screen, authority, .. } = context;
        let name = files::shown(&self.file);
        let read = parameters::read(&files::read(&self.file)?);
        let settings = read.map_err(|errors| files::faulty(&name, &errors))?;
        let settings = settings.into_iter().map(|(setting, _)| setting);
        let (mut chosen, left): (Vec<Setting>, Vec<Setting>) =
            settings.partition(|setting| self.place(setting).is_some());
        chosen.sort_by_key(|setting| self.place(setting));
        if chosen.is_empty() {
            return Err(Failure::usage(format!("{name} holds no parameters of the groups wanted"))
                .hint("--group chooses the groups: mode, axis, table, special, machine"));
        }
        if self.group.is_empty() && !left.is_empty() {
            let parameters = if left.len() == 1 { "parameter" } else { "parameters" };
            let left_out = format!("{} machine or special {parameters} left out", left.len());
            screen.note(&format!("{left_out} (--group machine,special)"));
        }
        let row = |setting: Setting| {
            let keys = setting.parameter.key.fields.len();
            let values = setting.values[keys..].iter().cloned().map(Some).collect();
            (Key { parameter: setting.parameter, row: setting.row() }, Changes::of(values))
        };
        let rows = chosen.into_iter().map(row).collect();
        write(Work { table: Parameters, robot, link, screen, authority }, rows).await
    }
}

impl Restore {
    /// Where in the order of writing a setting stands; `None` if its group is not wanted.
    fn place(&self, setting: &Setting) -> Option<usize> {
        let wanted = if self.group.is_empty() { &USUAL[..] } else { &self.group };
        ORDER.iter().position(|(part, group)| *group == setting.parameter.group() && wanted.contains(part))
    }
}

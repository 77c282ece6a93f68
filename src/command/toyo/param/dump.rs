//! `toyo param dump`.

use std::path::PathBuf;

use clap::Args;
use jiff::Timestamp;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Key, read, singles};
use crate::command::toyo::link::Link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
use crate::command::toyo::values::{NOT_IN_MANUAL, in_a_line, named_values};
use crate::command::toyo::{files, items};
use crate::command::{Command, Context, Report};
use crate::controller::toyo::bulk::{Setting, parameters};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::table::parameters::PARAMETERS;
use crate::failure::{Failure, Kind};
use crate::output::view::View;
use crate::output::{Screen, escape};

/// Save all parameters and tables as TOML.
#[derive(Debug, Args)]
#[command(
    after_help = "The file has parameters and the tables of speeds, times, MVM groups and torque limits. `point dump` \
                        saves points. Each value has its name and unit, for \
                        people and for `param restore`. The command writes a complete file or none. It takes about 20 s at \
                        9600 baud."
)]
pub struct Dump {
    /// A new file; default: stdout
    file: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "file")]
    force: bool,
}

/// The table of points, which `point list` reads.
const POINTS: &str = "T1";

impl Command for Dump {
    type Family = Toyo;
    type Report = DumpFileReport;
    const ID: &'static str = "toyo.param.dump";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<DumpFileReport, Failure> {
        let Context { robot, link, screen, several, .. } = context;
        let target = files::target(self.file.as_deref(), self.force, several)?;
        let dump = DumpReport::read(link, screen).await?;
        let time = Timestamp::now();
        let taken_at = time.round(jiff::Unit::Second).unwrap_or(time).to_string();
        let text = format!(
            "# Parameters of a Toyo controller, saved by armctl; `toyo param restore` writes them back.\n# {}, {taken_at}\n\n{}",
            escape::line(&robot.label()),
            dump.text(),
        );
        let file = target.map(|target| files::write(&target, &text)).transpose()?;
        let DumpReport { settings, refused, unfit, failed } = dump;
        let text = file.is_none().then_some(text);
        Ok(DumpFileReport { saved: settings.len(), refused, unfit, failed, taken_at, file, text })
    }
}

/// All parameters, and all rows of the tables except points.
fn keys() -> Vec<Key> {
    let tables = PARAMETERS.iter().filter(|parameter| parameter.id != POINTS);
    let rows = tables.filter_map(|table| Some((table, table.row()?))).flat_map(|(table, field)| {
        Numbers::of(&[], field).into_iter().map(move |row| Key { parameter: table, row: Some(row) })
    });
    singles().map(Key::single).chain(rows).collect()
}

/// Result of the read.
#[derive(Debug, Default)]
pub struct DumpReport {
    /// Values that can be written back.
    pub settings: Vec<Setting>,
    /// Parameters that the controller refuses, usually because it does not have them.
    pub refused: Vec<String>,
    /// Values that cannot be written back.
    pub unfit: Vec<Unfit>,
    /// Parameters that could not be read.
    pub failed: Vec<Failed>,
}

/// A parameter or a row that could not be read.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Failed {
    /// `M17`, or a row as `T2.5`.
    pub key: String,
    /// Reason.
    pub error: Failure,
}

/// A stored value that cannot be written back.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Unfit {
    /// `M17`, or a row as `T2.5`.
    pub key: String,
    /// The stored value.
    pub value: String,
    /// Whether the manual lists it.
    pub in_manual: bool,
    /// Reason.
    pub why: String,
}

impl DumpReport {
    /// Reads all parameters, and all tables except points. A dry run records the requests and ends.
    pub async fn read(link: &mut Link, screen: &Screen) -> Result<Self, Failure> {
        let keys = keys();
        let contents = read(link, screen, &keys).await?;
        let mut dump = Self::default();
        for (key, content) in keys.into_iter().zip(contents) {
            dump.add(key, content);
        }
        Ok(dump)
    }

    /// The values as TOML, with comments about the others.
    pub fn text(&self) -> String {
        format!("{}{}", parameters::write(&self.settings), self.remarks())
    }

    fn add(&mut self, key: Key, answer: Result<Record, Failure>) {
        let (parameter, key) = (key.parameter, key_text(key));
        let content = match answer {
            Ok(content) => content,
            Err(failure) if failure.kind == Kind::Refused => return self.refused.push(key),
            Err(failure) => return self.failed.push(Failed { key, error: failure }),
        };
        if !content.is_listed() {
            let value = in_a_line(&named_values(&content));
            return self.unfit.push(Unfit { key, value, in_manual: false, why: NOT_IN_MANUAL.to_owned() });
        }
        let setting = Setting { parameter, values: content.values().to_vec() };
        match setting.write() {
            Ok(_) => self.settings.push(setting),
            Err(error) => {
                let body = parameter.body().record(setting.values[parameter.key.fields.len()..].to_vec());
                let value = body.map_or_else(|_| content.written(), |body| in_a_line(&named_values(&body)));
                self.unfit.push(Unfit { key, value, in_manual: true, why: error.to_string() });
            }
        }
    }

    /// Comments about parameters that are not in the file.
    fn remarks(&self) -> String {
        let mut text = String::new();
        if !self.refused.is_empty() {
            text.push_str(&format!("\n# Not on this controller: {}\n", self.refused.join(", ")));
        }
        for Failed { key, error } in &self.failed {
            text.push_str(&format!("\n# {key} was not read: {}\n", escape::line(&error.message)));
        }
        for Unfit { key, value, why, .. } in &self.unfit {
            text.push_str(&format!("\n# {key} is {value}, which cannot be written back: {why}\n"));
        }
        text
    }
}

/// `P01`, or a row as `T2.5`.
pub fn key_text(Key { parameter, row }: Key) -> String {
    match row {
        Some(row) => format!("{}.{row}", parameter.id),
        None => parameter.id.to_owned(),
    }
}

/// Result of a dump.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DumpFileReport {
    /// Path; null if the text went to stdout.
    file: Option<String>,
    /// Number of parameters and rows.
    saved: usize,
    /// Parameters that the controller refuses, usually because it does not have them.
    refused: Vec<String>,
    /// Parameters whose values cannot be written back.
    unfit: Vec<Unfit>,
    /// Parameters that could not be read.
    failed: Vec<Failed>,
    taken_at: String,
    /// TOML text if there is no file.
    text: Option<String>,
}

impl Report for DumpFileReport {
    fn view(&self) -> View {
        let Self { file, saved, refused, unfit, text, .. } = self;
        if let Some(text) = text {
            return View::text(text.as_str());
        }
        let unfit: Vec<&str> = unfit.iter().map(|unfit| &unfit.key[..]).collect();
        let listed = |keys: String| if keys.is_empty() { "none".to_owned() } else { keys };
        View::fields([
            ("file", file.as_deref().unwrap_or_default().into()),
            ("parameters and rows", (*saved).into()),
            ("not on this controller", listed(refused.join(", ")).into()),
            ("cannot be written back", listed(unfit.join(", ")).into()),
        ])
    }

    fn failure(&self) -> Option<Failure> {
        let all = self.saved + self.failed.len();
        items::failure(all, self.failed.iter().map(|failed| Some(&failed.error)))
    }
}

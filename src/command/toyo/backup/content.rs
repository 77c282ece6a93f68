//! The parts of a controller as texts, and texts as what is to be stored.

use std::path::Path;

use super::manifest::Controller;
use super::parts::Part;
use crate::client::toyo::{Letters, letters_request};
use crate::command::backup::manifest::LeftOut;
use crate::command::toyo::eeprom::Cell;
use crate::command::toyo::items::{Answers, read_each};
use crate::command::toyo::link::{Link, wrong};
use crate::command::toyo::program::{steps, text};
use crate::command::toyo::stores::{Store, StoreTask};
use crate::command::toyo::values::NOT_IN_MANUAL;
use crate::command::toyo::{easy, files, numbers, palletizing, param, point, tasks};
use crate::controller::toyo::bulk::{Setting, easy as easy_text, pallets, parameters, points};
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::program::{MOST_STEPS, Program, Rows, Style, check_kept, listing, used};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::controller::toyo::table::{Command, Group, Parameter};
use crate::failure::{Failure, Kind};
use crate::output::{Screen, escape};

/// A part as text.
pub struct Text {
    /// What its file holds.
    pub text: String,
    /// What it does not hold.
    pub left_out: Vec<LeftOut>,
}

/// A part that is to be restored.
pub enum Content {
    Parameters(Vec<Setting>),
    Points(Vec<Setting>),
    Program(Program),
    Palletizing(i32, Vec<pallets::Filled>),
    Easy(Vec<easy_text::Filled>),
}

/// Asks type and version of the controller.
pub async fn controller(link: &mut Link) -> Result<Controller, Failure> {
    let system = link.ask(&Request::bare(Command::Sysp)).await?;
    let shown = |name: &str, show: fn(&Field, &Value) -> String| {
        system
            .pairs()
            .find(|(field, _)| field.name == name)
            .map(|(field, value)| show(field, value))
            .unwrap_or_default()
    };
    let axes = link.ask(&task_axes()).await?;
    let letters = link.try_ask(&letters_request()).await?.ok();
    let speed = link.try_ask(&Request::bare(Command::Rovr)).await?.ok();
    Ok(Controller {
        robot_type: shown("robot_type", Field::written),
        version: shown("version", |field, value| field.meaning(value).into_owned()),
        // What the manual does not list is kept as it came.
        task_axes: axes.word("axes").or(axes.text("axes")).unwrap_or_default().to_owned(),
        axis_letters: letters.map(|record| written(&record)),
        task_steps: steps::rooms(link).await?,
        speed_override_percent: speed.map(|record| numbers::small(&record, "override")),
    })
}

/// What a dry run notes of [`controller`].
pub fn plan_controller(link: &mut Link) {
    link.plan(&Request::bare(Command::Sysp), "type and version of the controller");
    link.plan(&task_axes(), "which tasks have axes");
    link.plan(&letters_request(), "the letters of the axes");
    link.plan(&Request::bare(Command::Rovr), "the override");
    link.plan(&steps::rooms_request(), "number of steps of the tasks");
}

/// The values of a record in a line.
fn written(record: &Record) -> String {
    record.pairs().map(|(field, value)| field.written(value)).collect::<Vec<_>>().join(" ")
}

fn task_axes() -> Request {
    let parameter = Parameter::named("E19").expect("the table has E19");
    Request::read_parameter(parameter, None).expect("E19 has no rows")
}

impl Controller {
    /// The letters of its axes; unknown where it refused to tell.
    pub fn letters(&self) -> Letters {
        self.axis_letters.as_deref().map_or(Letters::UNKNOWN, Letters::of_words)
    }

    /// Tasks that have points.
    pub fn point_tasks(&self) -> Vec<u8> {
        (1..=4).zip(self.task_axes.chars()).filter(|(_, axes)| *axes != '0').map(|(task, _)| task).collect()
    }

    /// Tasks that have a program.
    pub fn program_tasks(&self) -> Vec<u8> {
        (1..=4).zip(self.task_steps).filter(|(_, steps)| *steps > 0).map(|(task, _)| task).collect()
    }
}

/// What reads a part first, for a dry run.
pub fn first_read(part: Part) -> Result<Request, Failure> {
    let request = match part {
        Part::Parameters => {
            let first = Parameter::named("M01").expect("the table has M01");
            Request::read_parameter(first, None)
        }
        Part::Easy => return easy::read(1),
        Part::Palletizing(number) => Request::read_pallet(number.into(), &RECORDS[0]),
        Part::Points(_) => Request::read_parameter(points::table(), Some(1)),
        Part::Program(_) => Request::read_step(1),
    };
    request.map_err(|error| wrong(&error))
}

/// Reads a part.
pub async fn read(link: &mut Link, screen: &Screen, part: Part, controller: &Controller) -> Result<Text, Failure> {
    match part {
        Part::Parameters => parameters_text(link, screen).await,
        Part::Easy => {
            let requests = (1..=8).map(easy::read).collect::<Result<Vec<_>, _>>()?;
            let answers = read_each(link, screen, "reading easy programs", &requests).await?;
            let (records, left_out) = sorted((1..).map(|program: i32| program.to_string()), answers)?;
            let values = |(key, record): (String, Record)| {
                (key.parse().unwrap_or_default(), record.values().get(2..).unwrap_or_default().to_vec())
            };
            let text = easy_text::write(&records.into_iter().map(values).collect::<Vec<_>>());
            Ok(Text { text: text + &remarks(&left_out), left_out })
        }
        Part::Palletizing(number) => {
            let all: Vec<_> = RECORDS.iter().collect();
            let requests = palletizing::reads(number.into(), &all)?;
            let answers = read_each(link, screen, "reading records", &requests).await?;
            let (records, left_out) = sorted(all.iter().map(|record| record.name.to_owned()), answers)?;
            let named = |name: &str| all.iter().find(|record| record.name == name).copied();
            let filled: Vec<_> = records.into_iter().filter_map(|(key, record)| Some((named(&key)?, record))).collect();
            Ok(Text { text: pallets::write(&filled) + &remarks(&left_out), left_out })
        }
        Part::Points(task) => {
            tasks::choose(link, Some(task)).await?;
            let answers = point::read(link, screen, &(1..=999).collect::<Vec<_>>()).await;
            let answers = tasks::done(link, answers).await?;
            let (records, left_out) = sorted((1..=999).map(|point: i32| point.to_string()), answers)?;
            let setting = |(_, record): &(String, Record)| Setting {
                parameter: points::table(),
                values: record.values().to_vec(),
            };
            let settings: Vec<Setting> = records.iter().map(setting).collect();
            // As columns of letters the file would mean other axes to `point set`.
            let is_usual = controller.letters().are_usual();
            let text = if is_usual { points::write(&settings, point::AXES) } else { points::write_numbered(&settings) };
            Ok(Text { text, left_out })
        }
        Part::Program(task) => {
            tasks::choose(link, Some(task)).await?;
            let room = controller.task_steps[usize::from(task) - 1];
            let read = steps::read_all(link, screen, 1..=room).await?;
            let text = listing(&read, Style { first: 1, is_whole: true, is_numbered: false }, &Rows::new()).text;
            let foreign = (1..).zip(&read).filter(|(_, record)| !record.is_listed());
            let left_out = foreign.map(|(step, record): (i32, _)| LeftOut {
                key: step.to_string(),
                why: format!(
                    "'{}' is {NOT_IN_MANUAL}; the backup has its text, but a restore cannot write it",
                    record.written()
                ),
            });
            Ok(Text { text, left_out: left_out.collect() })
        }
    }
}

async fn parameters_text(link: &mut Link, screen: &Screen) -> Result<Text, Failure> {
    let kept = param::DumpReport::read(link, screen).await?;
    let text = kept.text();
    let refused = kept.refused.into_iter().map(|key| LeftOut { key, why: "the controller refused it".to_owned() });
    let unfit = kept.unfit.into_iter().map(|param::Unfit { key, value, why, .. }| LeftOut {
        key,
        why: format!("its value {value} cannot be written back: {why}"),
    });
    let failed = kept.failed.into_iter().map(|param::Failed { key, error }| LeftOut { key, why: error.message });
    Ok(Text { text, left_out: refused.chain(unfit).chain(failed).collect() })
}

/// A record by its key.
type Keyed = (String, Record);

/// What was answered, each by its key, as far as it can be written again; and what is left out. That the line fell silent
/// is a failure of the whole part.
fn sorted(keys: impl IntoIterator<Item = String>, answers: Answers) -> Result<(Vec<Keyed>, Vec<LeftOut>), Failure> {
    let (mut kept, mut left_out) = (Vec::with_capacity(answers.len()), Vec::new());
    for (key, answer) in keys.into_iter().zip(answers) {
        match answer {
            Ok(record) if record.is_listed() => kept.push((key, record)),
            Ok(record) => left_out.push(LeftOut { key, why: format!("'{}' is {NOT_IN_MANUAL}", record.written()) }),
            Err(failure) if failure.kind == Kind::NoAnswer => return Err(failure),
            Err(failure) => left_out.push(LeftOut { key, why: failure.message }),
        }
    }
    Ok((kept, left_out))
}

/// What is not in a TOML file, as comments of it.
fn remarks(left_out: &[LeftOut]) -> String {
    left_out.iter().map(|LeftOut { key, why }| format!("\n# {key} is missing: {}\n", escape::line(why))).collect()
}

impl Content {
    /// Reads and checks the file of a part.
    pub fn load(part: Part, folder: &Path, screen: &Screen) -> Result<Self, Failure> {
        let path = folder.join(part.file());
        let (name, bytes) = (files::display_path(&path), files::read(&path)?);
        let settings = |read: Vec<(Setting, usize)>| read.into_iter().map(|(setting, _)| setting).collect();
        let faulty = |errors: Vec<_>| files::file_failure(&name, &errors);
        Ok(match part {
            Part::Parameters => Self::Parameters(parameters::read(&bytes).map(settings).map_err(faulty)?),
            Part::Points(_) => Self::Points(points::read(&bytes, point::AXES).map(settings).map_err(faulty)?),
            Part::Program(_) => {
                // What a backup has was on a controller: warnings are nothing new.
                Self::Program(text::program(&name, check_kept(&bytes, MOST_STEPS), &screen.silenced())?)
            }
            Part::Palletizing(number) => Self::Palletizing(number.into(), pallets::read(&bytes).map_err(faulty)?),
            Part::Easy => Self::Easy(easy_text::read(&bytes).map_err(faulty)?),
        })
    }

    /// Its cells; those of a program fill the room that the task has.
    pub fn stores(&self, room: u16) -> Result<Vec<Store>, Failure> {
        match self {
            Self::Parameters(settings) => {
                settings.iter().filter(|setting| !is_machine(setting)).map(of_setting).collect()
            }
            Self::Points(settings) => settings
                .iter()
                .map(|setting| {
                    let key = setting.row().unwrap_or_default().to_string();
                    Ok(Store { key, ..of_setting(setting)? })
                })
                .collect(),
            Self::Program(program) => {
                let wanted = program.steps.iter().map(|step| step.record.clone());
                let wanted = wanted.chain(std::iter::repeat_with(steps::nop));
                (1..=room)
                    .zip(wanted)
                    .filter(|(_, record)| record.is_listed())
                    .map(|(step, record)| stored(step.to_string(), steps::cell(step, &record)))
                    .collect()
            }
            Self::Palletizing(number, records) => {
                let store = |(record, values): &pallets::Filled| {
                    stored(record.name.to_owned(), palletizing::cell(*number, record, values.clone()))
                };
                records.iter().map(store).collect()
            }
            Self::Easy(programs) => {
                let cell = |(program, values): &easy_text::Filled| {
                    stored(program.to_string(), easy::cell(*program, values.clone()))
                };
                programs.iter().map(cell).collect()
            }
        }
    }

    /// The cells of machine parameters (E) and special ones (U), the latter first.
    pub fn machine_stores(&self) -> Result<Vec<Store>, Failure> {
        let Self::Parameters(settings) = self else { return Ok(Vec::new()) };
        let mut settings: Vec<&Setting> = settings.iter().filter(|setting| is_machine(setting)).collect();
        settings.sort_by_key(|setting| setting.parameter.group() == Group::Machine);
        settings.into_iter().map(of_setting).collect()
    }

    /// Steps that the manual does not list, which are never written: number and text.
    pub fn unlisted_steps(&self) -> Vec<(u16, String)> {
        let Self::Program(program) = self else { return Vec::new() };
        let steps = (1..).zip(&program.steps).filter(|(_, step)| !step.record.is_listed());
        steps.map(|(number, step)| (number, step.record.written())).collect()
    }

    /// The work in words.
    pub fn work(&self) -> StoreTask {
        let (doing, noun, things) = match self {
            Self::Parameters(_) => ("storing parameters", "", ["a parameter", "parameters"]),
            Self::Points(_) => ("storing points", "point", ["a point", "points"]),
            Self::Program(_) => ("storing steps", "step", ["a step", "steps"]),
            Self::Palletizing(..) => ("storing records", "", ["a record", "records"]),
            Self::Easy(_) => ("storing easy programs", "program", ["a program", "programs"]),
        };
        StoreTask { doing, noun, things }
    }

    /// The steps that it needs room for: up to the last that is no NOP.
    pub fn steps(&self) -> u16 {
        let Self::Program(program) = self else { return 0 };
        let records: Vec<Record> = program.steps.iter().map(|step| step.record.clone()).collect();
        u16::try_from(used(&records)).unwrap_or(u16::MAX)
    }
}

/// Whether a parameter makes the controller another machine.
fn is_machine(setting: &Setting) -> bool {
    matches!(setting.parameter.group(), Group::Machine | Group::Special)
}

/// A parameter, or a row of a table, as something that is stored.
fn of_setting(setting: &Setting) -> Result<Store, Failure> {
    let wrong = |error| wrong(&error);
    let cell = Cell {
        read: setting.read().map_err(wrong)?,
        write: setting.write().map_err(wrong)?,
        wanted: setting.parameter.layout.record(setting.values.clone()).map_err(wrong)?,
    };
    let key = param::Key { parameter: setting.parameter, row: setting.row() };
    let is_optional = !setting.parameter.only_on.is_empty();
    Ok(Store { is_optional, ..Store::new(param::key_text(key), cell) })
}

fn stored(key: String, cell: Result<Cell, Failure>) -> Result<Store, Failure> {
    Ok(Store::new(key, cell?))
}

//! The parts of a controller as texts, and texts as what is to be stored.

use std::path::Path;

use super::manifest::Controller;
use super::parts::Part;
use crate::command::manifest::LeftOut;
use crate::command::toyo::cells::Cell;
use crate::command::toyo::link::{Link, wrong};
use crate::command::toyo::program::{steps, text};
use crate::command::toyo::stores::{Store, Work};
use crate::command::toyo::{easy, files, numbers, palletizing, param, point, tasks};
use crate::controller::toyo::bulk::{Setting, easy as easy_text, pallets, parameters, points};
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::program::{MOST_STEPS, Program, Rows, Style, check, listing, used};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::controller::toyo::table::{Command, Group, Parameter};
use crate::failure::Failure;
use crate::output::Screen;

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

/// Asks what kind of controller it is.
pub async fn controller(link: &mut Link) -> Result<Controller, Failure> {
    let system = link.read(&Request::bare(Command::Sysp)).await?;
    let shown = |name: &str, show: fn(&Field, &Value) -> String| {
        system
            .pairs()
            .find(|(field, _)| field.name == name)
            .map(|(field, value)| show(field, value))
            .unwrap_or_default()
    };
    let axes = link.read_content(&task_axes()).await?;
    let speed = link.try_read(&Request::bare(Command::Rovr)).await?.ok();
    Ok(Controller {
        robot_type: shown("robot_type", Field::written),
        version: shown("version", |field, value| field.meaning(value).into_owned()),
        task_axes: axes.word("axes").unwrap_or_default().to_owned(),
        task_steps: steps::rooms(link).await?,
        override_percent: speed.map(|record| numbers::small(&record, "override")),
    })
}

/// What a dry run notes of [`controller`].
pub fn foresee_controller(link: &mut Link) {
    link.foresee(&Request::bare(Command::Sysp), "what kind of controller it is");
    link.foresee(&task_axes(), "which tasks have axes");
    link.foresee(&Request::bare(Command::Rovr), "the override");
    link.foresee(&steps::rooms_request(), "how many steps the tasks have");
}

fn task_axes() -> Request {
    let parameter = Parameter::named("E19").expect("the table has E19");
    Request::read_parameter(parameter, None).expect("E19 has no rows")
}

impl Controller {
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
    let text = match part {
        Part::Parameters => return parameters_text(link, screen).await,
        Part::Easy => {
            let requests = (1..=8).map(easy::read).collect::<Result<Vec<_>, _>>()?;
            let records = numbers::ask_all(link, screen, "reading easy programs", &requests).await?;
            let values = |record: &Record| record.values().get(2..).unwrap_or_default().to_vec();
            easy_text::write(&(1..).zip(records.iter().map(values)).collect::<Vec<_>>())
        }
        Part::Palletizing(number) => {
            let all: Vec<_> = RECORDS.iter().collect();
            let requests = palletizing::reads(number.into(), &all)?;
            let records = numbers::read_contents(link, screen, "reading records", &requests).await?;
            pallets::write(&all.into_iter().zip(records).collect::<Vec<_>>())
        }
        Part::Points(task) => {
            let (_, records) = point::read_all(link, screen, Some(task), &(1..=999).collect::<Vec<_>>()).await?;
            let setting = |record: &Record| Setting { parameter: points::table(), values: record.values().to_vec() };
            points::write(&records.iter().map(setting).collect::<Vec<_>>(), point::AXES)
        }
        Part::Program(task) => {
            tasks::choose(link, Some(task)).await?;
            let room = controller.task_steps[usize::from(task) - 1];
            let read = steps::read_all(link, screen, 1..=room).await?;
            listing(&read, Style { first: 1, is_whole: true, is_numbered: false }, &Rows::new()).text
        }
    };
    Ok(Text { text, left_out: Vec::new() })
}

async fn parameters_text(link: &mut Link, screen: &Screen) -> Result<Text, Failure> {
    let kept = param::Kept::read(link, screen).await?;
    let text = kept.text();
    let refused = kept.refused.into_iter().map(|key| LeftOut { key, why: "the controller refuses it".to_owned() });
    let unfit = kept.unfit.into_iter().map(|param::Unfit { key, value, why }| LeftOut {
        key,
        why: format!("it holds {value}, which may not be written: {why}"),
    });
    Ok(Text { text, left_out: refused.chain(unfit).collect() })
}

impl Content {
    /// Reads and checks the file of a part.
    pub fn load(part: Part, folder: &Path, screen: &Screen) -> Result<Self, Failure> {
        let path = folder.join(part.file());
        let (name, bytes) = (files::shown(&path), files::read(&path)?);
        let settings = |read: Vec<(Setting, usize)>| read.into_iter().map(|(setting, _)| setting).collect();
        let faulty = |errors: Vec<_>| files::faulty(&name, &errors);
        Ok(match part {
            Part::Parameters => Self::Parameters(parameters::read(&bytes).map(settings).map_err(faulty)?),
            Part::Points(_) => Self::Points(points::read(&bytes, point::AXES).map(settings).map_err(faulty)?),
            Part::Program(_) => {
                // What a backup has was on a controller: warnings are nothing new.
                Self::Program(text::program(&name, check(&bytes, MOST_STEPS), &screen.silenced())?)
            }
            Part::Palletizing(number) => Self::Palletizing(number.into(), pallets::read(&bytes).map_err(faulty)?),
            Part::Easy => Self::Easy(easy_text::read(&bytes).map_err(faulty)?),
        })
    }

    /// Its cells; those of a program fill the room that the task has.
    pub fn stores(&self, room: u16) -> Result<Vec<Store>, Failure> {
        match self {
            Self::Parameters(settings) => {
                settings.iter().filter(|setting| !is_machine(setting)).map(param::store).collect()
            }
            Self::Points(settings) => settings
                .iter()
                .map(|setting| {
                    let key = setting.row().unwrap_or_default().to_string();
                    Ok(Store { key, ..param::store(setting)? })
                })
                .collect(),
            Self::Program(program) => {
                let wanted = program.steps.iter().map(|step| step.record.clone());
                let wanted = wanted.chain(std::iter::repeat_with(steps::nop));
                (1..=room)
                    .zip(wanted)
                    .map(|(step, record)| stored(step.to_string(), steps::cell(step, &record)))
                    .collect()
            }
            Self::Palletizing(number, records) => {
                let store = |(record, values): &pallets::Filled| palletizing::store(*number, record, values.clone());
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
        settings.into_iter().map(param::store).collect()
    }

    /// The work in words.
    pub fn work(&self) -> Work {
        let (doing, noun) = match self {
            Self::Parameters(_) => ("storing parameters", ""),
            Self::Points(_) => ("storing points", "point"),
            Self::Program(_) => ("storing steps", "step"),
            Self::Palletizing(..) => ("storing records", ""),
            Self::Easy(_) => ("storing easy programs", "program"),
        };
        Work { doing, noun, resumes: false }
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

fn stored(key: String, cell: Result<Cell, Failure>) -> Result<Store, Failure> {
    Ok(Store { key, cell: cell?, is_optional: false })
}

//! Conversion between the data of a controller and the text files of a backup.

use super::manifest::Controller;
use super::parts::Part;
use crate::easy::Numbered;
use crate::eeprom_tables::Rows as TableRows;
use crate::field_values::NOT_IN_MANUAL;
use crate::palletizing::Records;
use crate::param::{Parameters, is_machine};
use crate::point::Points;
use crate::prelude::*;
use crate::program::table::Steps;
use crate::program::text;
use crate::{files, number_arguments};
use armctl_client::toyo::letters_request;
use armctl_controller::findings::Finding;
use armctl_controller::toyo::field::Field;
use armctl_controller::toyo::program::{MAX_STEPS, Program, Rows, Style, check_kept, listing, used};
use armctl_controller::toyo::table::Command;
use armctl_frame::backup::manifest::LeftOut;
use armctl_frame::backup::parts;
use armctl_frame::store;

/// Text of a part.
pub struct Text {
    /// Content of the file.
    pub text: String,
    /// Rows that are not in the file.
    pub left_out: Vec<LeftOut>,
}

/// Reads type and version of the controller.
pub async fn controller(link: &mut Link) -> Result<Controller> {
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
        // A value that the manual does not list is kept as received.
        task_axes: axes.word("axes").or(axes.text("axes")).unwrap_or_default().to_owned(),
        axis_letters: letters.map(|record| written(&record)),
        task_steps: steps::rooms(link).await?,
        speed_override_percent: speed.map(|record| number_arguments::saturated_byte(&record, "override")),
    })
}

/// In a dry run, records the requests of [`controller`].
pub fn plan_controller(link: &mut Link) {
    link.plan(&Request::bare(Command::Sysp), "type and version of the controller");
    link.plan(&task_axes(), "which tasks have axes");
    link.plan(&letters_request(), "the letters of the axes");
    link.plan(&Request::bare(Command::Rovr), "the override");
    link.plan(&steps::rooms_request(), "number of steps of the tasks");
}

/// The values of a record in one line.
fn written(record: &Record) -> String {
    record.pairs().map(|(field, value)| field.written(value)).collect::<Vec<_>>().join(" ")
}

fn task_axes() -> Request {
    let parameter = Parameter::named("E19").expect("the table has E19");
    Request::read_parameter(parameter, None).expect("E19 has no rows")
}

impl Controller {
    /// Letters of the axes; unknown if the controller refused to report them.
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

/// A table of rows.
pub type Table = parts::Table<Toyo>;

/// How armctl reads a part.
enum Source {
    Table(Table),
    /// Steps of a task, as text.
    Program(u8),
}

/// The source of a part, on a machine whose axes have these letters.
fn source(part: Part, letters: Letters) -> Source {
    // If the letters are unusual, the columns have axis numbers, because `point restore` would apply the letters to
    // other axes.
    let columns = if letters.are_usual() { Letters::USUAL } else { Letters::UNKNOWN };
    Source::Table(match part {
        Part::Parameters => Box::new(store::Part::new(Parameters, Vec::new())),
        Part::Easy => Box::new(store::Part::new(TableRows::<Numbered>::default(), Vec::new())),
        Part::Palletizing(number) => Box::new(store::Part::new(Records::new(number.into(), columns), Vec::new())),
        Part::Points(task) => Box::new(store::Part::new(Points::with_letters(task, columns), Vec::new())),
        Part::Program(task) => return Source::Program(task),
    })
}

/// Reads a part. A dry run records the requests.
pub async fn read(link: &mut Link, screen: &Screen, part: Part, controller: &Controller) -> Result<Text> {
    let task = match source(part, controller.letters()) {
        Source::Table(mut table) => {
            let store::Text { text, left_out, .. } = table.read(link, screen).await?;
            return Ok(Text { text, left_out: left_out.into_iter().map(LeftOut::from).collect() });
        }
        Source::Program(task) => task,
    };
    task_selection::select_task(link, Some(task)).await?;
    let room = controller.task_steps[usize::from(task) - 1];
    let read = steps::read_all(link, screen, 1..=room).await?;
    let text = listing(&read, Style { first: 1, is_whole: true, is_numbered: false }, &Rows::new()).text;
    let foreign = (1..).zip(&read).filter(|(_, record)| !record.is_listed());
    let left_out = foreign.map(|(step, record): (i32, _)| LeftOut {
        key: step.to_string(),
        why: format!(
            "'{}' is {NOT_IN_MANUAL}; the backup contains this text, but a restore cannot write it",
            record.written()
        ),
    });
    Ok(Text { text, left_out: left_out.collect() })
}

/// The content of the file for a part.
#[derive(Debug)]
pub enum Content {
    /// Rows of a table.
    Table(Table),
    /// Parameters of the machine itself, and all other parameters.
    Parameters([store::Part<Parameters>; 2]),
    /// Program of a task.
    Program(u8, Program),
}

impl Content {
    /// Reads and checks the file of a part. The axes of the machine have these letters.
    pub fn load(part: Part, folder: &Path, letters: Letters, screen: &Screen) -> Result<Self> {
        let path = folder.join(part.file());
        let (name, bytes) = (files::display_path(&path), files::read(&path)?);
        let file_failure = |errors: Vec<Finding>| files::file_failure(&name, &errors);
        Ok(match part {
            Part::Parameters => {
                let all = store::Part::parse(Parameters, &bytes).map_err(file_failure)?;
                Self::Parameters(all.split(Parameters, is_machine))
            }
            Part::Easy => {
                let table = TableRows::<Numbered>::default();
                Self::Table(Box::new(store::Part::parse(table, &bytes).map_err(file_failure)?))
            }
            Part::Palletizing(number) => {
                let table = Records::new(number.into(), letters);
                Self::Table(Box::new(store::Part::parse(table, &bytes).map_err(file_failure)?))
            }
            Part::Points(task) => {
                let table = Points::with_letters(task, letters);
                Self::Table(Box::new(store::Part::parse(table, &bytes).map_err(file_failure)?))
            }
            Part::Program(task) => {
                // The program in a backup was already on a controller, so its warnings are not shown again.
                Self::Program(task, text::program(&name, check_kept(&bytes, MAX_STEPS), &screen.silenced())?)
            }
        })
    }

    /// Number of steps that the program needs: up to the last step that is not a NOP.
    pub fn steps(&self) -> u16 {
        let Self::Program(_, program) = self else { return 0 };
        let records: Vec<Record> = program.steps.iter().map(|step| step.record.clone()).collect();
        u16::try_from(used(&records)).unwrap_or(u16::MAX)
    }

    /// Parameters of the machine itself, and the table of the part. The table of a program contains all steps of its
    /// task.
    pub fn tables(self, room: u16) -> [Option<Table>; 2] {
        match self {
            Self::Table(table) => [None, Some(table)],
            Self::Parameters([machine, rest]) => [Some(Box::new(machine)), Some(Box::new(rest))],
            Self::Program(task, program) => {
                let wanted = program.steps.into_iter().map(|step| step.record);
                let rows = (1..=room).zip(wanted.chain(std::iter::repeat_with(steps::nop))).collect();
                [None, Some(Box::new(store::Part::new(Steps::of_task(task), rows)))]
            }
        }
    }
}

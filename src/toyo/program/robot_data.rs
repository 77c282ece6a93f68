//! Points, groups and tables that programs use, of a backup or of the controller, as commands that write them.

use crate::eeprom_tables::{EepromRow as _, is_zero, texts};
use crate::item_reads::read_each;
use crate::point::{Points, table};
use crate::prelude::*;
use crate::sim::{in_file, parameter_writes};
use armctl_controller::names::Kind;
use armctl_controller::toyo::names;
use armctl_controller::toyo::program::{Program, uses};
use armctl_controller::toyo::table::parameters::PARAMETERS;
use armctl_frame::programs::Position;
use armctl_frame::store::rows_of_file;

/// Parameter of the speed table.
const SPEEDS: &str = "T2";
/// Parameter of the points of a group of the MVM table.
const GROUPS: &str = "T4.S1";
/// Number of axes of a point.
const AXES: usize = 4;

/// What programs use.
#[derive(Debug, Clone, Default)]
pub struct RobotData {
    /// Commands that write parameters and points.
    pub writes: Vec<String>,
    /// Values of the points by their numbers.
    pub points: BTreeMap<i32, Record>,
    /// Points of each group of the MVM table.
    pub groups: BTreeMap<i32, Vec<i32>>,
    /// Rows of the speed table, in mm/s.
    pub speeds: BTreeMap<i32, f64>,
}

impl RobotData {
    /// Reads the files of `point dump` and `param dump`.
    ///
    /// # Errors
    /// A file cannot be read or is invalid.
    pub fn of_files(points: Option<&Path>, parameters: Option<&Path>) -> Result<Self> {
        let mut data = Self::default();
        data.add(parameters.map(parameter_writes).transpose()?.unwrap_or_default());
        let table = Points::with_letters(1, Letters::USUAL);
        if let Some(path) = points {
            for (number, changes) in rows_of_file(&table, path)? {
                let values =
                    changes.whole().ok_or_else(|| in_file(path, &format!("point {number}: values are missing")))?;
                data.add(vec![table.cell(number, values)?.write.text()]);
            }
        }
        Ok(data)
    }

    fn add(&mut self, writes: Vec<String>) {
        let block = |text: &String| Request::parse(&format!("@{}", text.trim_start_matches('@'))).ok();
        for request in writes.iter().filter_map(block) {
            let Some(record) = request.content().ok().flatten() else { continue };
            let numbers = numbers_of(&record);
            match (request.parameter().map(|parameter| parameter.id), &numbers[..]) {
                (Some("T1"), [point, ..]) => drop(self.points.insert(*point, record)),
                (Some(GROUPS), [group, points @ ..]) => drop(self.groups.insert(*group, points.to_vec())),
                (Some(SPEEDS), [row, speed]) => drop(self.speeds.insert(*row, f64::from(*speed) / 10.0)),
                _ => {}
            }
        }
        self.writes.extend(writes);
    }

    /// Points in the notation of a position: `PT012=100.00,20.00`.
    pub fn positions(&self) -> Vec<Position> {
        let position = |(point, record): (&i32, &Record)| {
            let name = names::address_of(Kind::Point, *point)?;
            Some(Position { line: 1, text: format!("{name}={}", texts(record, AXES).join(",")), name })
        };
        self.points.iter().filter_map(position).collect()
    }

    /// Taught points that a program does not use. None if a counter selects a point, if a group is not known, or if the
    /// program uses no points: a host can also move to them.
    pub fn unused_points(&self, program: &Program) -> Vec<String> {
        let records = records_of(program);
        let is_known = |record: &Record| record.number("group").is_none_or(|group| self.groups.contains_key(&group));
        let used = points_of(&records, &self.groups).filter(|used| !used.is_empty() && records.iter().all(is_known));
        let Some(used) = used else { return Vec::new() };
        let unused = self.points.iter().filter(|(point, record)| !used.contains(point) && !is_zero(record, AXES));
        unused.filter_map(|(point, _)| names::address_of(Kind::Point, *point)).collect()
    }

    /// Why the target of a step is not known; `None` if it is known. The counter of the step has this value.
    pub fn missing(&self, step: &Record, counter: i32, has_all_points: bool) -> Option<String> {
        let is_known = |point: i32| has_all_points || self.points.contains_key(&point);
        if let Some(group) = step.number("group") {
            let Some(points) = self.groups.get(&group) else { return Some(format!("the group {group} is not known")) };
            let missing = points.iter().find(|point| **point > 0 && !is_known(**point))?;
            return Some(format!("the point {missing} of the group {group} is not known"));
        }
        let point = step.number("point")? + counter;
        (!is_known(point)).then(|| format!("the point {point} is not known"))
    }
}

fn records_of(program: &Program) -> Vec<Record> {
    program.steps.iter().map(|step| step.record.clone()).collect()
}

/// Points that steps use; `None` if a counter selects the point of a step.
fn points_of(records: &[Record], groups: &BTreeMap<i32, Vec<i32>>) -> Option<BTreeSet<i32>> {
    let is_computed = |record: &Record| record.number("counter").is_some_and(|counter| counter > 0);
    if records.iter().any(|record| record.number("point").is_some() && is_computed(record)) {
        return None;
    }
    let groups = records.iter().filter_map(|record| groups.get(&record.number("group")?)).flatten().copied();
    let points = uses(records).into_iter().filter(|(id, _)| *id == table().id).map(|(_, point)| point);
    Some(points.chain(groups).filter(|point| *point > 0).collect())
}

/// The numbers of a record, in their order.
fn numbers_of(record: &Record) -> Vec<i32> {
    record
        .values()
        .iter()
        .filter_map(|value| if let Value::Number(number) = value { Some(*number) } else { None })
        .collect()
}

/// What to read from the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// All parameters, and the rows and points that the program uses.
    Everything,
    /// The speeds, groups and points that the program uses.
    Used,
}

/// Reads what a program of a task needs.
///
/// # Errors
/// A parameter or a point cannot be read.
pub async fn read_data(
    link: &mut Link,
    screen: &Screen,
    task: Option<u8>,
    program: &Program,
    wanted: Wanted,
) -> Result<RobotData> {
    let mut data = RobotData::default();
    let records = records_of(program);
    let rows = uses(&records);
    // The rows of a table begin with the same two characters as its sheets.
    let used = |id: &'static str| rows.iter().filter(move |(table, _)| table[..2] == id[..2]).map(|(_, row)| *row);
    let is_wanted = |id: &str| wanted == Wanted::Everything || [SPEEDS, GROUPS].contains(&id);
    let tables = PARAMETERS
        .iter()
        .filter(|parameter| parameter.only_on.is_empty() && parameter.id != table().id && is_wanted(parameter.id));
    let parameters = tables.flat_map(|parameter| match parameter.row() {
        None => vec![(parameter, None)],
        Some(_) => used(parameter.id).map(|row| (parameter, Some(row))).collect(),
    });
    data.add(read_writes(link, screen, "reading parameters", parameters.collect()).await?);
    let points = points_of(&records, &data.groups).unwrap_or_else(|| Points::all().into_iter().collect());
    let points = points.into_iter().map(|point| (table(), Some(point))).collect();
    task_selection::select_task(link, task).await?;
    let read = read_writes(link, screen, "reading points", points).await;
    data.add(task_selection::restore_task(link, read).await?);
    Ok(data)
}

/// Reads parameters and rows. Returns the commands that write those that were read.
async fn read_writes(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    wanted: Vec<(&'static Parameter, Option<i32>)>,
) -> Result<Vec<String>> {
    let requests = wanted.iter().map(|(parameter, row)| Request::read_parameter(parameter, *row));
    let requests: Vec<Request> = requests.collect::<Result<_, _>>().map_err(|error| wrong(&error))?;
    let answers = read_each(link, screen, what, &requests).await?;
    let write = |((parameter, _), answer): ((&Parameter, _), Result<Record>)| {
        let record = answer.ok().filter(Record::is_listed)?;
        Request::write_parameter(parameter, record.values()).ok().map(|request| request.text())
    };
    Ok(wanted.into_iter().zip(answers).filter_map(write).collect())
}

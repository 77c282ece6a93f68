//! Memory of the controller: parameters, tables, programs, and the write count of each EEPROM cell.

use std::collections::BTreeMap;

use super::action::{Action, action, place};
use super::defaults;
use super::motion::{AXES, Coordinates};
use crate::refuse_if;
use crate::toyo::field::{Field, Form, Value};
use crate::toyo::layout::Record;
use crate::toyo::table::parameters::PARAMETERS;
use crate::toyo::table::{Group, Instruction, Op, Pallet, Parameter};

pub(super) const TASKS: usize = 4;
/// Number of rows in the coordinate table of each task.
pub(super) const POINTS: usize = 999;
/// Maximum total of steps of all tasks (TO 2-4, E22).
pub(super) const MAX_STEPS: usize = 5000;
/// Highest total of steps that leaves room for easy programs (TO 2-4, E22).
pub(super) const STEPS_WITH_EASY: usize = 2000;
const PALLETS: usize = 16;
pub(super) const EASY: usize = 8;
const TAGS: usize = 1000;
/// Tables except T1. Each task has its own T1.
pub(super) const TABLES: [&str; 8] = ["T2", "T3", "T4.S1", "T4.S2", "T4.S3", "T4.S4", "T4.S5", "T5"];

/// A part of the memory whose EEPROM writes are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cell {
    /// A parameter by its id.
    Parameter(&'static str),
    /// A row of a table, by id and row.
    Row(&'static str, i32),
    /// A row of the coordinate table of a task.
    Point {
        /// Task, 1 to 4.
        task: usize,
        /// Row, 1 to 999.
        row: usize,
    },
    /// A step of the program of a task.
    Step {
        /// Task, 1 to 4.
        task: usize,
        /// Step, from 1.
        step: usize,
    },
    /// A record of a palletizing program.
    Pallet {
        /// Palletizing program, 1 to 16.
        program: usize,
        /// Record of the program, 1 to 16.
        record: u8,
    },
    /// An easy program, 1 to 8.
    Easy(usize),
    /// The speed override.
    Override,
}

/// Write counts of EEPROM cells.
#[derive(Debug, Clone, Default)]
pub struct Wear {
    cells: BTreeMap<Cell, u64>,
    total: u64,
    /// Write endurance of a cell; `None` without a limit.
    limit: Option<u64>,
}

impl Wear {
    pub(super) fn new(limit: Option<u64>) -> Self {
        Self { limit, ..Self::default() }
    }

    /// Resets all counts.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.limit);
    }

    /// Total number of writes.
    pub const fn total(&self) -> u64 {
        self.total
    }

    /// Write counts of the cells.
    pub const fn cells(&self) -> &BTreeMap<Cell, u64> {
        &self.cells
    }

    /// Counts a write; `false` if the cell is worn out.
    fn write(&mut self, cell: Cell) -> bool {
        let count = self.cells.entry(cell).or_default();
        *count += 1;
        self.total += 1;
        self.limit.is_none_or(|limit| *count <= limit)
    }
}

/// Error: the content does not fit in the memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct NoRoom;

#[derive(Debug, Clone)]
struct Step {
    record: Record,
    action: Action,
}

/// An easy program (TO 2-3, WESY).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Easy {
    pub(super) start: i32,
    pub(super) times: i32,
    pub(super) end: i32,
}

/// Content that is also stored on a memory card.
#[derive(Debug, Clone)]
pub(super) struct Content {
    axes: usize,
    /// Parameters without rows, by id.
    singles: BTreeMap<&'static str, Record>,
    rows: BTreeMap<(&'static str, i32), Vec<Value>>,
    points: [Vec<[i32; AXES]>; TASKS],
    steps: [Vec<Step>; TASKS],
    pallets: Vec<[Vec<Value>; PALLETS]>,
    easy: [Easy; EASY],
    pub(super) percent: i32,
    pub(super) robot_types: [i32; AXES],
}

#[derive(Debug, Clone)]
pub(super) struct Memory {
    pub(super) content: Content,
    pub(super) wear: Wear,
    /// Step of each tag, by task. The last start of a program set these steps.
    tags: Vec<Vec<u16>>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum TagLookup {
    Step(usize),
    Nowhere,
    Twice,
}

const TWICE: u16 = u16::MAX;

impl Step {
    fn new(record: Record) -> Option<Self> {
        let word = record.layout().text.split(' ').next().unwrap_or_default();
        let action = action(Instruction::named(word)?, &record);
        Some(Self { record, action })
    }

    fn nothing() -> Self {
        let record = Op::Nop.row().layout.record(Vec::new()).expect("NOP has no fields");
        Self { record, action: Action::Nothing }
    }

    fn tag(&self) -> Option<usize> {
        (self.record.layout() == Op::Tag.row().layout).then(|| self.record.number("tag").map(index))?
    }

    fn is_nothing(&self) -> bool {
        self.record.layout() == Op::Nop.row().layout
    }
}

impl Content {
    /// Initial content of a controller.
    pub(super) fn new(axes: usize, robot_type: i32) -> Self {
        let mut content = Self {
            axes,
            singles: defaults::singles().collect(),
            rows: defaults::rows().collect(),
            points: std::array::from_fn(|_| vec![[0; AXES]; POINTS]),
            steps: Default::default(),
            pallets: vec![blank_pallet(); PALLETS],
            easy: Default::default(),
            percent: 100,
            robot_types: [robot_type; AXES],
        };
        content.put_single(
            combination(),
            combination().layout.record(vec![Value::Word(ALL_IN_ONE[axes - 1])]).expect("E19 has one field"),
        );
        content.fit_steps();
        content
    }

    /// Gives each task the number of steps in E22. Steps beyond this number are lost.
    fn fit_steps(&mut self) {
        let sizes = self.sizes();
        for (steps, size) in self.steps.iter_mut().zip(sizes) {
            steps.resize_with(size, Step::nothing);
        }
        if sizes.iter().sum::<usize>() > STEPS_WITH_EASY {
            self.easy = Default::default();
        }
    }

    fn sizes(&self) -> [usize; TASKS] {
        let sizes = self.single("E22").values();
        std::array::from_fn(|task| if let Some(Value::Number(size)) = sizes.get(task) { index(*size) } else { 0 })
    }

    /// A parameter without rows.
    ///
    /// # Panics
    /// If the parameter does not exist, which is an error of the caller.
    pub(super) fn single(&self, id: &str) -> &Record {
        self.singles.get(id).expect("a parameter of the table")
    }

    fn put_single(&mut self, parameter: &Parameter, record: Record) {
        if let Some(single) = self.singles.get_mut(parameter.id) {
            *single = record;
        }
    }

    pub(super) fn row(&self, id: &'static str, row: i32) -> &[Value] {
        self.rows.get(&(id, row)).map_or(&[], Vec::as_slice)
    }

    pub(super) fn numbers<const N: usize>(&self, id: &'static str, row: i32) -> [i32; N] {
        let mut numbers = self.row(id, row).iter().filter_map(|value| match value {
            Value::Number(number) => Some(*number),
            _ => None,
        });
        std::array::from_fn(|_| numbers.next().unwrap_or_default())
    }

    pub(super) fn point(&self, task: usize, row: i32) -> Option<Coordinates> {
        self.points[task].get(index(row).checked_sub(1)?).map(|point| place(*point))
    }

    pub(super) fn easy(&self, number: usize) -> Easy {
        number.checked_sub(1).and_then(|place| self.easy.get(place)).copied().unwrap_or_default()
    }

    pub(super) fn pallet(&self, program: usize, record: &Pallet) -> Option<Record> {
        let values = self.pallets.get(program.checked_sub(1)?)?.get(usize::from(record.number) - 1)?;
        record.layout.record(values.clone()).ok()
    }

    pub(super) fn differs(&self, other: &Self, group: Group) -> bool {
        let group_of = |id| Parameter::named(id).map(Parameter::group);
        self.singles.iter().any(|(id, record)| other.singles.get(id) != Some(record) && group_of(id) == Some(group))
    }
}

impl Memory {
    pub(super) fn new(content: Content) -> Self {
        Self { content, wear: Wear::default(), tags: vec![Vec::new(); TASKS] }
    }

    /// Number of steps that belong to a task, including NOPs.
    pub(super) fn size(&self, task: usize) -> usize {
        self.content.steps[task].len()
    }

    /// Number of steps up to the last that is not a NOP.
    pub(super) fn used(&self, task: usize) -> usize {
        self.content.steps[task].iter().rposition(|step| !step.is_nothing()).map_or(0, |place| place + 1)
    }

    pub(super) fn action(&self, task: usize, step: usize) -> Option<Action> {
        self.content.steps[task].get(step.checked_sub(1)?).map(|step| step.action)
    }

    pub(super) fn step(&self, task: usize, step: usize) -> Option<&Record> {
        self.content.steps[task].get(step.checked_sub(1)?).map(|step| &step.record)
    }

    pub(super) fn index_tags(&mut self) {
        for (tags, steps) in self.tags.iter_mut().zip(&self.content.steps) {
            tags.clear();
            tags.resize(TAGS, 0);
            for (number, tag) in (1..).zip(steps).filter_map(|(number, step)| step.tag().map(|tag| (number, tag))) {
                tags[tag] = if tags[tag] == 0 { number } else { TWICE };
            }
        }
    }

    /// Step of a tag. Only [`Memory::index_tags`] updates the steps of the tags.
    pub(super) fn tag(&self, task: usize, tag: usize) -> TagLookup {
        match self.tags[task].get(tag) {
            None | Some(0) => TagLookup::Nowhere,
            Some(&TWICE) => TagLookup::Twice,
            Some(step) => TagLookup::Step(usize::from(*step)),
        }
    }

    /// The first step with a tag, even if more steps have the same tag.
    pub(super) fn search(&self, task: usize, tag: usize) -> Option<usize> {
        self.content.steps[task].iter().position(|step| step.tag() == Some(tag)).map(|place| place + 1)
    }

    /// Reads a parameter, or a row of a table, by its key.
    pub(super) fn parameter(&self, parameter: &Parameter, key: &Record, task: usize) -> Option<Record> {
        let Some(Value::Number(row)) = key.values().first() else {
            return Some(self.content.single(parameter.id).clone());
        };
        let values = if parameter.id == "T1" {
            self.content.points[task].get(index(*row).checked_sub(1)?)?.map(Value::Number).to_vec()
        } else {
            self.content.row(TABLES.into_iter().find(|id| *id == parameter.id)?, *row).to_vec()
        };
        let all = std::iter::once(Value::Number(*row)).chain(values).collect();
        parameter.layout.record(all).ok()
    }

    pub(super) fn set_parameter(
        &mut self,
        parameter: &'static Parameter,
        record: Record,
        task: usize,
    ) -> Result<(), NoRoom> {
        let row = parameter.row().and_then(|field| record.number(field.name));
        let cell = match row {
            None => Cell::Parameter(parameter.id),
            Some(row) if parameter.id == "T1" => Cell::Point { task: task + 1, row: index(row) },
            Some(row) => Cell::Row(parameter.id, row),
        };
        if parameter.id == "E22" {
            let total: i32 = record.pairs().map(|(field, _)| record.number(field.name).unwrap_or_default()).sum();
            refuse_if(index(total) > MAX_STEPS, NoRoom)?;
        }
        if !self.wear.write(cell) {
            return Ok(());
        }
        let Some(row) = row else {
            self.content.put_single(parameter, record);
            self.content.fit_steps();
            return Ok(());
        };
        let values = &record.values()[1..];
        if parameter.id == "T1" {
            let point = index(row).checked_sub(1).and_then(|row| self.content.points[task].get_mut(row));
            let point = point.ok_or(NoRoom)?;
            point.iter_mut().zip(values).for_each(|(place, value)| {
                if let Value::Number(number) = value {
                    *place = *number;
                }
            });
        } else {
            self.content.rows.insert((parameter.id, row), values.to_vec());
        }
        Ok(())
    }

    pub(super) fn set_step(&mut self, task: usize, step: usize, record: Record) -> Result<(), NoRoom> {
        let new = Step::new(record).ok_or(NoRoom)?;
        self.store_step(task, step, new)
    }

    fn store_step(&mut self, task: usize, step: usize, new: Step) -> Result<(), NoRoom> {
        let place = step.checked_sub(1).and_then(|place| self.content.steps[task].get_mut(place)).ok_or(NoRoom)?;
        if self.wear.write(Cell::Step { task: task + 1, step }) {
            *place = new;
        }
        Ok(())
    }

    /// Inserts a step. The following steps move down, so the last step must be empty.
    pub(super) fn insert_step(&mut self, task: usize, step: usize) -> Result<(), NoRoom> {
        let size = self.size(task);
        let last = self.content.steps[task].last().ok_or(NoRoom)?;
        refuse_if(step > size || !last.is_nothing(), NoRoom)?;
        let mut rest = self.content.steps[task][step - 1..size - 1].to_vec();
        rest.insert(0, Step::nothing());
        self.replace(task, step, rest)
    }

    /// Deletes steps. The steps after the deleted steps move up.
    pub(super) fn delete_steps(&mut self, task: usize, first: usize, last: usize) -> Result<(), NoRoom> {
        let size = self.size(task);
        refuse_if(first > last || last > size, NoRoom)?;
        let mut rest = self.content.steps[task][last..].to_vec();
        rest.resize_with(size + 1 - first, Step::nothing);
        self.replace(task, first, rest)
    }

    /// Copies steps over other steps, also to another task.
    pub(super) fn copy_steps(&mut self, from: (usize, usize, usize), to: (usize, usize)) -> Result<(), NoRoom> {
        let (source, first, last) = from;
        let (task, top) = to;
        refuse_if(first > last || last > self.size(source) || top + (last - first) > self.size(task), NoRoom)?;
        let steps = self.content.steps[source][first - 1..last].to_vec();
        self.replace(task, top, steps)
    }

    /// Replaces steps. Writes only the steps that differ, to save EEPROM writes.
    fn replace(&mut self, task: usize, top: usize, steps: Vec<Step>) -> Result<(), NoRoom> {
        for (number, step) in (top..).zip(steps) {
            if self.step(task, number) != Some(&step.record) {
                self.store_step(task, number, step)?;
            }
        }
        Ok(())
    }

    pub(super) fn set_pallet(&mut self, program: usize, record: &Pallet, values: &[Value]) -> Result<(), NoRoom> {
        let place = program.checked_sub(1).and_then(|place| self.content.pallets.get_mut(place)).ok_or(NoRoom)?;
        if self.wear.write(Cell::Pallet { program, record: record.number }) {
            place[usize::from(record.number) - 1] = values.to_vec();
        }
        Ok(())
    }

    pub(super) fn copy_pallet(&mut self, from: usize, to: usize) -> Result<(), NoRoom> {
        let source = from.checked_sub(1).and_then(|place| self.content.pallets.get(place)).ok_or(NoRoom)?.clone();
        crate::toyo::table::palletizing::RECORDS
            .iter()
            .zip(&source)
            .try_for_each(|(record, values)| self.set_pallet(to, record, values))
    }

    pub(super) fn set_easy(&mut self, number: usize, easy: Easy) -> Result<(), NoRoom> {
        let full = self.content.sizes().iter().sum::<usize>() > STEPS_WITH_EASY;
        let place = number.checked_sub(1).and_then(|place| self.content.easy.get_mut(place));
        let place = place.filter(|_| !full).ok_or(NoRoom)?;
        if self.wear.write(Cell::Easy(number)) {
            *place = easy;
        }
        Ok(())
    }

    pub(super) fn set_percent(&mut self, percent: i32) {
        if self.wear.write(Cell::Override) {
            self.content.percent = percent;
        }
    }

    /// Sets the program of a task to NOP.
    pub(super) fn clear_steps(&mut self, task: usize) -> Result<(), NoRoom> {
        let size = self.size(task);
        if size == 0 { Ok(()) } else { self.delete_steps(task, 1, size) }
    }

    pub(super) fn clear_points(&mut self, task: usize) {
        for (row, point) in (1..).zip(self.content.points[task].iter_mut()) {
            if *point != [0; AXES] && self.wear.write(Cell::Point { task: task + 1, row }) {
                *point = [0; AXES];
            }
        }
    }

    pub(super) fn clear_pallets(&mut self) -> Result<(), NoRoom> {
        let blank = blank_pallet();
        for program in 1..=PALLETS {
            for (record, values) in crate::toyo::table::palletizing::RECORDS.iter().zip(&blank) {
                if self.content.pallets[program - 1][usize::from(record.number) - 1] != *values {
                    self.set_pallet(program, record, values)?;
                }
            }
        }
        Ok(())
    }

    pub(super) fn clear_easy(&mut self) -> Result<(), NoRoom> {
        (1..=EASY)
            .filter(|number| self.content.easy(*number) != Easy::default())
            .collect::<Vec<_>>()
            .into_iter()
            .try_for_each(|number| self.set_easy(number, Easy::default()))
    }

    /// Resets parameters and tables. Returns whether parameter 2 has changed.
    pub(super) fn clear_parameters(&mut self) -> Result<bool, NoRoom> {
        let fresh = Content::new(self.content.axes, 0);
        let machine = self.content.differs(&fresh, Group::Machine);
        for parameter in PARAMETERS.iter().filter(|parameter| parameter.row().is_none()) {
            let default = fresh.single(parameter.id);
            if self.content.single(parameter.id) != default {
                self.set_parameter(parameter, default.clone(), 0)?;
            }
        }
        for ((id, row), values) in fresh.rows {
            if self.content.row(id, row) != values && self.wear.write(Cell::Row(id, row)) {
                self.content.rows.insert((id, row), values);
            }
        }
        Ok(machine)
    }

    /// Sets the robot type of an axis, and resets parameter 2.
    pub(super) fn set_robot_type(&mut self, axis: usize, robot_type: i32) {
        self.content.robot_types[axis] = robot_type;
        let machine = PARAMETERS.iter().filter(|row| row.group() == Group::Machine && row.id != "E22");
        let fresh = Content::new(self.content.axes, 0);
        machine.for_each(|row| self.content.put_single(row, fresh.single(row.id).clone()));
    }
}

/// Values of E19 that assign all axes to one task, by the number of axes.
const ALL_IN_ONE: [&str; AXES] = ["1000", "2000", "4000", "5000"];

fn combination() -> &'static Parameter {
    Parameter::named("E19").expect("E19 is in the table")
}

/// Index from a number; 0 if the number is negative.
pub(super) fn index(number: i32) -> usize {
    usize::try_from(number).unwrap_or_default()
}

/// Last row of a table, from the field for the row number.
pub(super) fn last_row(field: &Field) -> i32 {
    if let Form::Number(number) = field.form { number.most } else { 0 }
}

/// A palletizing program with minimum values.
fn blank_pallet() -> [Vec<Value>; PALLETS] {
    std::array::from_fn(|place| {
        let record = &crate::toyo::table::palletizing::RECORDS[place];
        let least = |field: &Field| match field.form {
            Form::Number(number) => Value::Number(number.least.max(0)),
            Form::Word(words) => Value::Word(words[0].text),
            _ => Value::Number(0),
        };
        record.layout.fields.iter().map(least).collect()
    })
}

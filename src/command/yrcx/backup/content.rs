//! Conversion between the parts of a controller and the text files of a backup.

use std::collections::BTreeSet;
use std::path::Path;

use anyhow::Context as _;
use serde::{Deserialize, Serialize};

use super::parts::{Part, Records};
use crate::command::backup::manifest::{About, Entry, LeftOut};
use crate::command::frame::dry_run::Reason;
use crate::command::frame::store::Store as _;
use crate::command::yrcx::link::Link;
use crate::command::yrcx::numbers::{self, Numbers, runs};
use crate::command::yrcx::param::{Parameters, Setting};
use crate::command::yrcx::refusal::refused;
use crate::command::yrcx::several::{check_echo, is_about_commands};
use crate::command::yrcx::single::shown;
use crate::command::yrcx::stores::is_number;
use crate::controller::findings::{Finding, Findings};
use crate::controller::sheet::{self, Column, Dialect, Sheet};
use crate::controller::yrcx::alarm::Alarm;
use crate::controller::yrcx::order::{Draft, Order};
use crate::controller::yrcx::table::{Command, Field};
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::Failure;
use crate::files;
use crate::output::Screen;
use crate::output::progress::Progress;
use crate::settings::target::Family;

/// Cells of a line.
type Row = Vec<String>;

/// Controller model and its robots.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Controller {
    /// Host software version: `V1.08 R0048`.
    pub software: String,
    /// Robots of the controller.
    pub robots: Vec<Robot>,
}

/// A robot of the controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Robot {
    /// 1 to 4.
    pub robot: u8,
    /// The number of its model.
    pub robot_type: i32,
    /// Its axes, 1 to 4.
    pub axes: Vec<u8>,
}

impl About for Controller {
    const FAMILY: Option<Family> = Some(Family::Yrcx);

    fn check_entry(entry: &Entry) -> Result<(), String> {
        let part: Part = entry.name.parse()?;
        match &entry.copy {
            Some(copy) if copy.file != part.file() => {
                Err(format!("'{part}' is in {}, not in '{}'", part.file(), copy.file))
            }
            _ => Ok(()),
        }
    }
}

impl Controller {
    /// Reads it from the controller.
    pub async fn ask(link: &mut Link) -> Result<Self, Failure> {
        let versions = link.ask(&Command::Versions.order().build()?).await?.values;
        let told = |key| shown(Command::Versions, &versions, key).unwrap_or_default();
        let software = format!("{} {}", told(Key::HostVersion), told(Key::HostRevision));
        let mut robots = Vec::new();
        for robot in 1..=4_u8 {
            let Ok(servos) = ask(link, &of_robot(Command::ServoStatus, robot).build()?).await? else { continue };
            let has = |(axis, key): (u8, Key)| servos.int(key).filter(|state| *state != NO_AXIS).map(|_| axis);
            let axes: Vec<u8> = (1..).zip(Key::AXES).filter_map(has).collect();
            if axes.is_empty() {
                continue;
            }
            let system = link.ask(&of_robot(Command::System, robot).build()?).await?.values;
            robots.push(Robot { robot, robot_type: system.int(Key::RobotType).unwrap_or_default(), axes });
        }
        Ok(Self { software, robots })
    }

    /// Notes the requests of [`ask`](Self::ask) in a dry run.
    pub fn plan(link: &mut Link) -> Result<(), Failure> {
        link.plan(&Command::Versions.order().build()?, "versions");
        for robot in 1..=4_u8 {
            link.plan(&of_robot(Command::ServoStatus, robot).build()?, &format!("axes of robot {robot}"));
            let (order, about) = (of_robot(Command::System, robot).build()?, format!("type of robot {robot}"));
            plan_if(link, &order, &about, &format!("the axes: read only if there is a robot {robot}"));
        }
        Ok(())
    }

    /// Types of the robots as text.
    pub fn types(&self) -> String {
        let types = self.robots.iter().map(|robot| format!("{} (robot {})", robot.robot_type, robot.robot));
        types.collect::<Vec<_>>().join(", ")
    }
}

/// Notes a conditional request in a dry run.
fn plan_if(link: &mut Link, order: &Order, about: &str, depends_on: &str) {
    link.plan_depending(order, order, Reason::about(about).depending_on(depends_on));
}

/// Servo state of an axis that does not exist (4.7.3).
const NO_AXIS: i32 = 9;

/// A part as text.
pub struct Text {
    /// Content of the file.
    pub text: String,
    /// Numbers that were requested.
    pub numbers: Vec<i32>,
    /// Numbers that the controller refused, with the alarm.
    pub refused: Vec<(i32, Alarm)>,
    /// Items that are not in the file, with the reason.
    pub left_out: Vec<LeftOut>,
}

impl Text {
    /// Text for the list of items.
    pub fn holds(&self, part: Part) -> String {
        match part {
            Part::Points(_) | Part::Comments(_) => format!("{} {}", part.kind(), runs(&self.numbers)),
            _ => part.kind().to_owned(),
        }
    }

    /// Refused numbers, grouped by alarm.
    pub fn refusals(&self) -> Vec<LeftOut> {
        let mut alarms: Vec<Alarm> = self.refused.iter().map(|(_, alarm)| *alarm).collect();
        alarms.dedup();
        alarms.sort_unstable_by_key(ToString::to_string);
        alarms.dedup();
        let of = |alarm: Alarm| {
            let numbers = self.refused.iter().filter(|(_, own)| *own == alarm).map(|(number, _)| *number);
            LeftOut {
                key: runs(&numbers.collect::<Vec<_>>()),
                why: format!("refused with alarm {alarm}, {}", alarm.text()),
            }
        };
        alarms.into_iter().map(of).collect()
    }
}

/// A command for one robot of the controller.
fn of_robot(command: Command, robot: u8) -> Draft {
    command.order().with(Key::Robot, i32::from(robot))
}

/// Sends a request. A refusal is a result, unless the next command would be refused as well.
pub async fn ask(link: &mut Link, order: &Order) -> Result<Result<Values, Alarm>, Failure> {
    match link.try_ask(order).await? {
        Ok(done) => check_echo(order, &done.values).map(|()| Ok(done.values)),
        Err(refusal) if is_about_commands(refusal.alarm) => Err(refused(order.row(), refusal.alarm)),
        Err(refusal) => Ok(Err(refusal.alarm)),
    }
}

/// Number of consecutive undefined points that ends the search, if the user gives no range.
pub const GAP: usize = 100;

/// Selection of the record numbers to read.
pub struct Wanted {
    /// Numbers in the order of reading.
    pub numbers: Vec<i32>,
    /// Numbers that are always read.
    pub always: BTreeSet<i32>,
    /// Number of consecutive refusals that ends the search; `None` reads all.
    pub gap: Option<usize>,
    /// Refusals before the first number.
    pub gap_before: usize,
}

impl Wanted {
    /// Selects all of `numbers`.
    pub fn all(numbers: Vec<i32>) -> Self {
        Self { numbers, always: BTreeSet::new(), gap: None, gap_before: 0 }
    }
}

impl Records {
    /// All valid numbers.
    pub fn all(&self) -> Result<Vec<i32>, Failure> {
        let numbers = self.numbers.split(',').map(|text| self.parse(text)).collect::<Result<Vec<_>, _>>();
        Ok(Numbers::of(&numbers.map_err(Failure::local)?))
    }

    /// Parses a number or a range.
    pub fn parse(&self, text: &str) -> Result<Numbers, String> {
        Numbers::parse(self.read, self.columns[0].1, text)
    }

    /// Request that reads one record.
    pub fn read(&self, number: i32) -> Result<Order, Failure> {
        Ok(self.read.order().with(self.columns[0].1, number).build()?)
    }

    fn columns(&self) -> Vec<Column> {
        let column = |(name, key): &(&'static str, Key)| {
            if is_number(*key) { Column::number(*name) } else { Column::text(*name) }
        };
        self.columns.iter().map(column).collect()
    }

    /// Row of an answer, in the order of the columns.
    pub fn row(&self, number: i32, values: &Values) -> Row {
        let text = |(index, key): (usize, Key)| match values.value(key) {
            None if index == 0 => {
                let value = Value::Int(number);
                self.read.row().request().find(|field| field.key == key).map(|field| field.show(&value))
            }
            None => None,
            Some(value) => field(self.read.row().answer(), key, values).map(|field| field.show(value)),
        };
        self.columns.iter().map(|(_, key)| *key).enumerate().map(|column| text(column).unwrap_or_default()).collect()
    }

    /// Request that stores a row.
    pub fn store(&self, row: &Row) -> Result<Store, Failure> {
        let cells = || self.columns.iter().map(|(_, key)| *key).zip(row);
        // A hand is written to a robot, and its answer names that robot. No hand system is an empty text.
        let draft = cells().fold(self.write.order(), |draft, (key, text)| match key {
            Key::Owner => draft.with(Key::Robot, text.as_str()),
            Key::HandSystem if text.is_empty() => draft,
            _ => draft.with(key, text.as_str()),
        });
        let write = draft.build()?;
        let (key, number) = (row[0].clone(), write.values().int(self.columns[0].1).unwrap_or_default());
        Ok(Store { key, read: self.read(number)?, wanted: self.stored(write.values()), write })
    }

    /// Values that are read after a request with `values` stored them.
    pub fn stored(&self, values: &Values) -> Values {
        let stored = |key: Key| match key {
            // Robot 0 is the first.
            Key::Owner => (key, Value::Int(values.int(Key::Robot).unwrap_or_default().max(1))),
            key => (key, values.value(key).cloned().unwrap_or(Value::Int(0))),
        };
        self.columns[1..].iter().map(|(_, key)| stored(*key)).collect()
    }
}

/// Last field of a key, because a layout can have several.
fn field(mut layout: impl Iterator<Item = &'static Field>, key: Key, values: &Values) -> Option<&'static Field> {
    let counts = |field: &Field| {
        let other = |key| values.int(key).unwrap_or_default();
        field.when.is_none_or(|when| (when.least..=when.most).contains(&other(when.key)))
    };
    layout.find(|field| field.key == key && counts(field))
}

/// Settings of a robot: name, read command and key, write command and key (4.2.8, 4.2.14 to 16, 4.2.19; 4.7.8, 9,
/// 16).
const SETTINGS: [(&str, Command, Key, Command, Key); 5] = [
    ("auto_speed_percent", Command::SpeedStatus, Key::AutoSpeed, Command::SpeedAuto, Key::SpeedPercent),
    ("manual_speed_percent", Command::SpeedStatus, Key::ManualSpeed, Command::SpeedManual, Key::SpeedPercent),
    ("program_speed_percent", Command::SpeedStatus, Key::ProgramSpeed, Command::SpeedProgram, Key::SpeedPercent),
    ("inching_distance", Command::InchAmountGet, Key::InchingAmount, Command::InchAmountSet, Key::InchingAmount),
    ("hand_system", Command::ArmDesignation, Key::Arm, Command::ArmSelect, Key::Arm),
];
/// Columns of settings and parameters.
const OF_ROBOT: [&str; 3] = ["robot", "name", "value"];

/// Notes the read requests of a part in a dry run; `points` is the requested selection.
pub fn plan(link: &mut Link, part: Part, points: Option<&BTreeSet<i32>>) -> Result<(), Failure> {
    match (part, part.records()) {
        (Part::Points(_), Some(records)) => {
            // These are read in any case.
            let certain = || (0..).take(GAP).collect();
            let numbers = points.map_or_else(certain, |points| points.iter().copied().collect::<Vec<_>>());
            plan_records(link, records, numbers)?;
            let others =
                if points.is_some() { "" } else { "the other points, until 100 consecutive points are not defined, " };
            link.then(&format!("{others}the points of pallets, then the comments of the points that are defined"));
            Ok(())
        }
        (_, Some(records)) => plan_records(link, records, records.all()?),
        (Part::Settings, _) => {
            for robot in 1..=4_u8 {
                for (command, about) in [
                    (Command::SpeedStatus, "speeds"),
                    (Command::InchAmountGet, "inching distance"),
                    (Command::ArmDesignation, "hand system"),
                ] {
                    let (order, about) = (of_robot(command, robot).build()?, format!("{about} of robot {robot}"));
                    plan_if(link, &order, &about, &format!("the axes: read only if there is a robot {robot}"));
                }
            }
            Ok(())
        }
        (Part::Parameters, _) => {
            for robot in 1..=4 {
                let table = Parameters { robot };
                for key in Parameters::all() {
                    let (order, about) = (table.read_order(key)?, of_its_robot(&Parameters::name(key), robot));
                    plan_if(link, &order, &about, "the axes: read only if the robot has the axes");
                }
            }
            Ok(())
        }
        _ => {
            link.plan(&Command::Versions.order().build()?, "versions");
            link.plan(&Command::Slots.order().with(Key::Controller, 1).build()?, "option slots");
            Ok(())
        }
    }
}

fn plan_records(link: &mut Link, records: &Records, numbers: Vec<i32>) -> Result<(), Failure> {
    for number in numbers {
        let key = numbers::named(records.read, records.columns[0].1, number);
        link.plan(&records.read(number)?, &format!("{} {key}", records.kind));
    }
    Ok(())
}

/// Reads a part that is not made of records.
pub async fn read(link: &mut Link, screen: &Screen, part: Part, controller: &Controller) -> Result<Text, Failure> {
    let (text, left_out) = match part {
        Part::Settings => settings(link, controller).await?,
        Part::Parameters => parameters(link, screen, controller).await?,
        _ => (info(link, controller).await?, Vec::new()),
    };
    Ok(Text { text, numbers: Vec::new(), refused: Vec::new(), left_out })
}

/// Reads records.
pub async fn read_records(
    link: &mut Link,
    screen: &Screen,
    records: &Records,
    wanted: &Wanted,
) -> Result<Text, Failure> {
    let mut progress = bar(screen, records.kind, wanted.numbers.len());
    let (mut rows, mut refused, mut asked) = (Vec::new(), Vec::new(), Vec::new());
    let mut gap = wanted.gap_before;
    for number in &wanted.numbers {
        let is_over = wanted.gap.is_some_and(|most| gap >= most);
        if is_over && !wanted.always.contains(number) {
            continue;
        }
        match ask(link, &records.read(*number)?).await? {
            Ok(values) => {
                gap = if is_over { gap } else { 0 };
                // A point without a comment has an empty comment.
                if values.text(Key::Comment) != Some("") {
                    rows.push(records.row(*number, &values));
                }
            }
            Err(alarm) => {
                gap += usize::from(!is_over);
                refused.push((*number, alarm));
            }
        }
        asked.push(*number);
        progress.advance(1);
    }
    let mut left_out = Vec::new();
    keep_writable(&mut rows, &mut left_out, |row| records.store(row));
    Ok(Text { text: sheet::write(Dialect::COMMAS, &records.columns(), &rows), numbers: asked, refused, left_out })
}

/// Removes rows that the controller would refuse, such as a pallet without positions, and lists them.
fn keep_writable(rows: &mut Vec<Row>, left_out: &mut Vec<LeftOut>, store: impl Fn(&Row) -> Result<Store, Failure>) {
    rows.retain(|row| {
        let Err(failure) = store(row) else { return true };
        let why = format!("the value cannot be written back: {}", failure.message);
        left_out.push(LeftOut { key: row.join(" "), why });
        false
    });
}

fn bar(screen: &Screen, what: &str, count: usize) -> Progress {
    screen.items_progress(&format!("reading {what}"), count as u64)
}

async fn info(link: &mut Link, controller: &Controller) -> Result<String, Failure> {
    let mut text = String::from("# Information about the controller. It is not written back.\n");
    let mut add = |name: &str, value: String| text.push_str(&format!("{name} = {value:?}\n"));
    for (command, keys) in
        [(Command::Versions, &VERSIONS[..]), (Command::Slots, &[Key::Slot1, Key::Slot2, Key::Slot3, Key::Slot4][..])]
    {
        let draft = command.order();
        let order = if command == Command::Slots { draft.with(Key::Controller, 1) } else { draft }.build()?;
        match ask(link, &order).await? {
            Ok(values) => {
                for key in keys {
                    add(key.name(), shown(command, &values, *key).unwrap_or_default());
                }
            }
            Err(alarm) => add(order.row().id, format!("refused with alarm {alarm}")),
        }
    }
    for Robot { robot, robot_type, axes } in &controller.robots {
        let axes: Vec<String> = axes.iter().map(ToString::to_string).collect();
        text.push_str(&format!(
            "\n[[robot]]\nrobot = {robot}\nrobot_type = {robot_type}\naxes = [{}]\n",
            axes.join(", ")
        ));
    }
    Ok(text)
}

const VERSIONS: [Key; 7] = [
    Key::HostVersion,
    Key::HostRevision,
    Key::FpgaVersion,
    Key::DriverVersion1,
    Key::DriverVersion2,
    Key::DriverVersion3,
    Key::DriverVersion4,
];

async fn settings(link: &mut Link, controller: &Controller) -> Result<(String, Vec<LeftOut>), Failure> {
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    for Robot { robot, .. } in &controller.robots {
        let mut last: Option<(Command, Result<Values, Alarm>)> = None;
        for (name, command, key, ..) in SETTINGS {
            if last.as_ref().is_none_or(|(of, _)| *of != command) {
                last = Some((command, ask(link, &of_robot(command, *robot).build()?).await?));
            }
            match &last {
                Some((_, Ok(values))) => {
                    let value = shown(command, values, key).unwrap_or_default();
                    rows.push(vec![robot.to_string(), name.to_owned(), value]);
                }
                Some((_, Err(alarm))) => left_out.push(not_told(of_its_robot(name, robot), *alarm)),
                None => {}
            }
        }
    }
    keep_writable(&mut rows, &mut left_out, setting_store);
    Ok((sheet::write(Dialect::COMMAS, &OF_ROBOT.map(Column::text), &rows), left_out))
}

fn not_told(key: String, alarm: Alarm) -> LeftOut {
    LeftOut { key, why: format!("refused with alarm {alarm}, {}", alarm.text()) }
}

async fn parameters(
    link: &mut Link,
    screen: &Screen,
    controller: &Controller,
) -> Result<(String, Vec<LeftOut>), Failure> {
    let mut wanted = Vec::new();
    for Robot { robot, axes, .. } in &controller.robots {
        let exists = |key: &Setting| key.1.is_none_or(|axis| axes.contains(&axis));
        wanted.extend(Parameters::all().into_iter().filter(exists).map(|key| (*robot, key)));
    }
    let mut progress = bar(screen, "parameters", wanted.len());
    let (mut rows, mut left_out) = (Vec::new(), Vec::new());
    for (robot, key) in wanted {
        let name = Parameters::name(key);
        match ask(link, &Parameters { robot }.read_order(key)?).await? {
            Ok(values) => {
                let value = values.int(Key::Value).unwrap_or_default();
                rows.push(vec![robot.to_string(), name, value.to_string()]);
            }
            Err(alarm) => left_out.push(not_told(of_its_robot(&name, robot), alarm)),
        }
        progress.advance(1);
    }
    keep_writable(&mut rows, &mut left_out, parameter_store);
    Ok((sheet::write(Dialect::COMMAS, &OF_ROBOT.map(Column::text), &rows), left_out))
}

fn of_its_robot(name: &str, robot: impl std::fmt::Display) -> String {
    format!("{name} of robot {robot}")
}

/// A value to be written, unless the controller already has it.
#[derive(Debug, PartialEq)]
pub struct Store {
    /// Name of the value.
    pub key: String,
    /// Request that reads the current value.
    pub read: Order,
    /// Request that writes it.
    pub write: Order,
    /// Fields that an equal answer must contain.
    pub wanted: Values,
}

impl Store {
    /// Whether the value read equals the value to be written.
    pub fn is_there(&self, values: &Values) -> bool {
        self.wanted.iter().all(|(key, wanted)| values.value(key).unwrap_or(&Value::Int(0)) == wanted)
    }

    /// Text of the value read.
    pub fn describe(&self, values: &Values) -> String {
        let fields = self.wanted.iter().filter_map(|(key, _)| {
            let value = values.value(key)?;
            field(self.read.row().answer(), key, values).map(|field| field.show(value))
        });
        fields.collect::<Vec<_>>().join(" ")
    }

    /// Text of the value to be written.
    pub fn wanted(&self) -> String {
        self.describe(&self.wanted)
    }
}

/// Reads and checks the file of a part. Returns the values to be written.
pub fn load(part: Part, folder: &Path) -> Result<Vec<Store>, Failure> {
    let path = folder.join(part.file());
    let text = files::text(&path, files::SETTINGS).with_context(|| path.display().to_string())?;
    let wrong = |why: String| Failure::usage(format!("{}: {why}", path.display())).hint("make a new backup");
    let columns: Vec<&str> = match (part, part.records()) {
        (_, Some(records)) => records.columns.iter().map(|(name, _)| *name).collect(),
        (Part::Settings | Part::Parameters, _) => OF_ROBOT.into(),
        _ => return Ok(Vec::new()),
    };
    let store = |row: &Row| match part.records() {
        Some(records) => records.store(row),
        None if part == Part::Settings => setting_store(row),
        None => parameter_store(row),
    };
    let mut seen = BTreeSet::new();
    let mut stores = Vec::new();
    for (line, row) in rows(&columns, &text).map_err(wrong)? {
        let store = store(&row).map_err(|failure| wrong(format!("line {line}: {}", failure.message)))?;
        if !seen.insert(store.key.clone()) {
            return Err(wrong(format!("line {line}: {} is listed twice", store.key)));
        }
        stores.push(store);
    }
    Ok(stores)
}

/// Rows of a file that has all of these columns, each with its line.
fn rows(columns: &[&str], text: &str) -> Result<Vec<(usize, Row)>, String> {
    let mut findings = Findings::default();
    let expected = format!("the columns are {}", columns.join(", "));
    let sheet = Sheet::read(text.as_bytes(), &expected, &mut findings);
    let places = sheet.as_ref().map(|sheet| sheet.columns(columns, &expected, &mut findings));
    if let Some(Finding { line, message, .. }) = findings.into_errors().first() {
        return Err(format!("line {line}: {message}"));
    }
    let places: Option<Vec<usize>> = places.and_then(|places| places.into_iter().collect());
    let (sheet, places) = sheet.zip(places).ok_or(expected)?;
    let cells = |row: &sheet::Row| places.iter().map(|at| row.string(*at).to_owned()).collect();
    Ok(sheet.rows().iter().map(|row| (row.line, cells(row))).collect())
}

fn setting_store(row: &Row) -> Result<Store, Failure> {
    let [robot, name, value] = &row[..] else { return Err(Failure::usage("expected three cells")) };
    let setting = SETTINGS.iter().find(|(known, ..)| known == name);
    let (_, read, told, write, key) =
        setting.ok_or_else(|| Failure::usage(format!("setting '{name}' does not exist")))?;
    let write = write.order().with(Key::Robot, robot.as_str()).with(*key, value.as_str()).build()?;
    let wanted = Values::from_iter([(*told, write.values().value(*key).cloned().unwrap_or(Value::Int(0)))]);
    let read = read.order().with(Key::Robot, robot.as_str()).build()?;
    Ok(Store { key: of_its_robot(name, robot), read, write, wanted })
}

fn parameter_store(row: &Row) -> Result<Store, Failure> {
    let [robot, name, value] = &row[..] else { return Err(Failure::usage("expected three cells")) };
    let [key] = Parameters::keys(name).map_err(Failure::usage)?[..] else {
        return Err(Failure::usage(format!("'{name}' is not a single parameter")));
    };
    let number = robot.parse().ok().filter(|number| (1..=4).contains(number));
    let number = number.ok_or_else(|| Failure::usage(format!("robot '{robot}' does not exist")))?;
    let table = Parameters { robot: number };
    let write = table.write_order(key, value)?;
    let wanted = Values::from_iter([(Key::Value, write.values().int(Key::Value).unwrap_or_default())]);
    Ok(Store { key: of_its_robot(name, robot), read: table.read_order(key)?, write, wanted })
}

/// Numbers of the points in a file.
pub fn defined(part: Part, folder: &Path) -> Result<Vec<i32>, Failure> {
    let number = |store: &Store| store.write.values().int(Key::Point);
    Ok(load(part, folder)?.iter().filter_map(number).collect())
}

/// Points that the pallet file refers to: five for each pallet (4.3.3).
pub fn points_of_pallets(pallets: Part, folder: &Path) -> Result<BTreeSet<i32>, Failure> {
    let first = |store: &Store| store.write.values().int(Key::FirstPoint);
    Ok(load(pallets, folder)?.iter().filter_map(first).flat_map(|first| first..first + 5).collect())
}

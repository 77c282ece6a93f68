//! The parts of a controller as the text files of a backup.

use serde::Deserialize;

use super::parts::Part;
use super::save::{MAX_UNDEFINED_RUN, gap_after};
use crate::confirmed_write::read_current;
use crate::data::{Hands, Pallets, PointSheet, Points, Shifts};
use crate::number_arguments::runs;
use crate::numbered_tables::Numbered;
use crate::param::{Parameters, Setting};
use crate::prelude::*;
use crate::read_requests::{ask_each, is_undefined};
use crate::robot_settings::Settings;
use crate::single_command::format_field;
use crate::var::Variables;
use armctl_controller::yrcx::table::Command;
use armctl_frame::backup::manifest::{About, Entry};
use armctl_frame::backup::parts::Table;
use armctl_frame::store::{self, part_text};
use armctl_frame::text_files;

/// Host software of the controller, and its robots.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Controller {
    /// Version of the host software, for example `V1.08 R0048`.
    pub software: String,
    /// Robots of the controller.
    pub robots: Vec<Robot>,
}

/// A robot of the controller.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Robot {
    /// Robot number, 1 to 4.
    pub robot: u8,
    /// Number of the robot's model.
    pub robot_type: i32,
    /// Axes of the robot, 1 to 4.
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
    /// Reads the software version and the robots from the controller.
    pub async fn ask(link: &mut Link) -> Result<Self> {
        let versions = link.ask(&Command::Versions.order().valid_order()?).await?.values;
        let told = |key| format_field(Command::Versions, &versions, key).unwrap_or_default();
        let software = format!("{} {}", told(Key::HostVersion), told(Key::HostRevision));
        let mut robots = Vec::new();
        for robot in 1..=4_u8 {
            let Some(servos) = read_current(link, &of_robot(Command::ServoStatus, robot).valid_order()?, "").await?
            else {
                continue;
            };
            let has = |(axis, key): (u8, Key)| servos.int(key).filter(|state| *state != NO_AXIS).map(|_| axis);
            let axes: Vec<u8> = (1..).zip(Key::AXES).filter_map(has).collect();
            if axes.is_empty() {
                continue;
            }
            let system = link.ask(&of_robot(Command::System, robot).valid_order()?).await?.values;
            robots.push(Robot { robot, robot_type: system.int(Key::RobotType).unwrap_or_default(), axes });
        }
        Ok(Self { software, robots })
    }

    /// Notes the requests of [`ask`](Self::ask) in a dry run.
    pub fn plan(link: &mut Link) -> Result<()> {
        link.plan(&Command::Versions.order().valid_order()?, "versions");
        for robot in 1..=4_u8 {
            link.plan(&of_robot(Command::ServoStatus, robot).valid_order()?, &format!("axes of robot {robot}"));
            let (order, about) = (of_robot(Command::System, robot).valid_order()?, format!("type of robot {robot}"));
            plan_existing(link, &order, &about);
        }
        Ok(())
    }

    /// Lists the types of the robots.
    pub fn types(&self) -> String {
        let types = self.robots.iter().map(|robot| format!("{} (robot {})", robot.robot_type, robot.robot));
        types.collect::<Vec<_>>().join(", ")
    }
}

/// Servo state of an axis that does not exist (4.7.3).
const NO_AXIS: i32 = 9;

/// A part as text.
pub struct Text {
    /// Content of the file, and what is not in it.
    pub table: store::Text,
    /// Points that were requested: `0..107`.
    pub points: Option<String>,
}

/// Starts a request for one robot of the controller.
fn of_robot(command: Command, robot: u8) -> Draft {
    command.order().with(Key::Robot, i32::from(robot))
}

/// Notes a request in a dry run that is sent only if its robot exists.
fn plan_existing(link: &mut Link, order: &Order, about: &str) {
    let robot = order.values().int(Key::Robot).unwrap_or_default();
    let depends_on = format!("the axes: sent only if there is a robot {robot}");
    link.plan_depending(order, order, Reason::about(about).depending_on(&depends_on));
}

/// Notes the requests that read a part in a dry run. `points` are the points that the user selected.
pub async fn plan(link: &mut Link, screen: &Screen, part: Part, points: Option<&BTreeSet<i32>>) -> Result<()> {
    let orders = match part {
        Part::Settings(robot) => Settings { robot }.read_orders(&Settings::all())?,
        Part::Parameters(robot) => {
            let table = Parameters { robot };
            Parameters::all().into_iter().map(|key| table.read_order(key)).collect::<Result<_, _>>()?
        }
        Part::Info => {
            let [versions, slots] = info_orders()?;
            link.plan(&versions, "versions");
            link.plan(&slots, "option slots");
            return Ok(());
        }
        Part::Points(_) => {
            // These points are read in any case; the search cannot end earlier.
            let certain = || (0..).take(MAX_UNDEFINED_RUN).collect();
            let numbers = points.map_or_else(certain, |points| points.iter().copied().collect::<Vec<_>>());
            Numbered::<Points>::default().read(link, screen, &numbers).await.known()?;
            let others = if points.is_some() {
                ""
            } else {
                "the other points, until 100 consecutive points are not \
                                                            defined, "
            };
            link.then(&format!("{others}the points of pallets, then the comments of the points that are defined"));
            return Ok(());
        }
        Part::Variables | Part::Pallets | Part::Shifts | Part::Hands => {
            let none = Controller { software: String::new(), robots: Vec::new() };
            return read(link, screen, part, &none).await.known().map(|_| ());
        }
    };
    for order in orders {
        plan_existing(link, &order, order.row().name);
    }
    Ok(())
}

/// Reads a part, except points.
pub async fn read(link: &mut Link, screen: &Screen, part: Part, controller: &Controller) -> Result<store::Text> {
    match part {
        Part::Info => {
            let text = info(link, screen, controller).await?;
            Ok(store::Text { text, left_out: Vec::new(), undefined: Vec::new() })
        }
        Part::Settings(robot) => rows(link, screen, &Settings { robot }, &Settings::all()).await.map(all_omitted),
        Part::Parameters(robot) => {
            let axes = controller.robots.iter().find(|one| one.robot == robot).map_or(&[][..], |one| &one.axes);
            let exists = |(_, axis): &Setting| axis.is_none_or(|axis| axes.contains(&axis));
            let keys: Vec<Setting> = Parameters::all().into_iter().filter(exists).collect();
            rows(link, screen, &Parameters { robot }, &keys).await.map(all_omitted)
        }
        Part::Variables => all_rows(link, screen, Numbered::<Variables>::default()).await,
        Part::Pallets => all_rows(link, screen, Numbered::<Pallets>::default()).await,
        Part::Shifts => all_rows(link, screen, Numbered::<Shifts>::default()).await,
        Part::Hands => all_rows(link, screen, Numbered::<Hands>::default()).await,
        Part::Points(_) => Err(Failure::local("internal error: points are read by number")),
    }
}

async fn all_rows<S: Writable<Family = Yrcx>>(link: &mut Link, screen: &Screen, table: S) -> Result<store::Text> {
    rows(link, screen, &table, &S::all()).await
}

async fn rows<S: Writable<Family = Yrcx>>(
    link: &mut Link,
    screen: &Screen,
    table: &S,
    keys: &[S::Key],
) -> Result<store::Text> {
    part_text(table, keys, existing_rows(link, screen, table, keys).await?)
}

/// Returns the rows of a table, or the fact that they are not defined. Any other failure concerns all rows, so the part
/// is not complete.
async fn existing_rows<S: Writable<Family = Yrcx>>(
    link: &mut Link,
    screen: &Screen,
    table: &S,
    keys: &[S::Key],
) -> Result<Vec<Result<Option<S::Wire>>>> {
    let rows = table.read(link, screen, keys).await?.rows;
    let certain = rows.into_iter().map(|row| match row {
        Err(failure) if !S::is_undefined(&failure) => Err(failure),
        row => Ok(row),
    });
    certain.collect()
}

/// Every robot has all settings and parameters. A refused row is therefore not undefined, and the report lists it as
/// left out.
fn all_omitted(text: store::Text) -> store::Text {
    let store::Text { text, mut left_out, undefined } = text;
    left_out.extend(undefined);
    store::Text { text, left_out, undefined: Vec::new() }
}

/// Reads points with their comments. With `gap`, the number of undefined points before them, the search ends after
/// [`MAX_UNDEFINED_RUN`] undefined points in a row. After that, only the points in `always` are read.
pub async fn read_points(
    link: &mut Link,
    screen: &Screen,
    numbers: &[i32],
    always: &BTreeSet<i32>,
    mut gap: Option<usize>,
) -> Result<Text> {
    let table = PointSheet::default();
    // A backup reads the points of each file in turn.
    let (first, last) = (numbers.first().copied().unwrap_or_default(), numbers.last().copied().unwrap_or_default());
    let mut progress = screen.items_progress(&format!("reading points {first} to {last}"), numbers.len() as u64);
    let (mut asked, mut found, mut rest) = (Vec::new(), Vec::new(), numbers);
    while let Some(first) = rest.first() {
        let is_over = gap.is_some_and(|gap| gap >= MAX_UNDEFINED_RUN);
        let (block, others) =
            rest.split_at(rest.len().min(MAX_UNDEFINED_RUN - gap.filter(|_| !is_over).unwrap_or_default()));
        let block: Vec<i32> = block.iter().copied().filter(|number| !is_over || always.contains(number)).collect();
        let rows = existing_rows(link, &screen.silenced(), &table, &block).await?;
        let defined = block.iter().zip(&rows).filter(|(_, row)| row.is_ok()).map(|(number, _)| *number);
        let within = *first..*others.first().unwrap_or(first);
        gap = gap.map(|gap| gap_after(gap, within, &defined.collect::<Vec<_>>()));
        asked.extend(block);
        found.extend(rows);
        progress.advance((rest.len() - others.len()) as u64);
        rest = others;
    }
    Ok(Text { table: part_text(&table, &asked, found)?, points: Some(runs(&asked)) })
}

/// Requests of the information.
fn info_orders() -> Result<[Order; 2]> {
    Ok([Command::Versions.order().valid_order()?, Command::Slots.order().with(Key::Controller, 1).valid_order()?])
}

async fn info(link: &mut Link, screen: &Screen, controller: &Controller) -> Result<String> {
    let mut text = String::from("# Information about the controller. It is not written back.\n");
    let mut add = |name: &str, value: String| text.push_str(&format!("{name} = {value:?}\n"));
    let orders = info_orders()?;
    for (order, answer) in orders.iter().zip(ask_each(link, screen, "reading information", &orders).await?.outcomes) {
        match answer {
            Ok(values) => {
                for (key, _) in values.iter().filter(|(key, _)| order.values().value(*key).is_none()) {
                    add(key.name(), format_field(order.command(), &values, key).unwrap_or_default());
                }
            }
            Err(failure) if is_undefined(&failure) => add(order.row().id, failure.message),
            Err(failure) => return Err(failure),
        }
    }
    for Robot { robot, robot_type, axes } in &controller.robots {
        text.push_str(&format!("\n[[robot]]\nrobot = {robot}\nrobot_type = {robot_type}\naxes = {axes:?}\n"));
    }
    Ok(text)
}

/// Reads and checks the file of a part.
pub fn load(part: Part, folder: &Path) -> Result<Option<Table<Yrcx>>> {
    let path = folder.join(part.file());
    let bytes = text_files::read(&path)?;
    part.table(&bytes).map_err(|errors| text_files::file_failure(&text_files::display_path(&path), &errors))
}

/// Numbers of the points in a file.
pub fn defined(part: Part, folder: &Path) -> Result<Vec<i32>> {
    let path = folder.join(part.file());
    store::keys_of::<PointSheet>(&path, &text_files::read(&path)?)
}

/// Points that the pallet file refers to: five for each pallet (4.3.3).
pub fn points_of_pallets(folder: &Path) -> Result<BTreeSet<i32>> {
    let table = Numbered::<Pallets>::default();
    let rows = store::rows_of_file(&table, &folder.join(Part::Pallets.file()))?;
    let first = |(number, draft)| Ok(table.complete_draft(number, &draft, None)?.values().int(Key::FirstPoint));
    let first = rows.into_iter().map(first).collect::<Result<Vec<_>>>()?;
    Ok(first.into_iter().flatten().flat_map(|first| first..first + 5).collect())
}

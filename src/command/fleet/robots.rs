//! `armctl robots`: the inventory, and robots that are there.

pub mod check;
pub mod discover;

use anyhow::Context as _;
use clap::{Args, Subcommand};
use schemars::JsonSchema;
use serde::Serialize;
use toml_edit::{ArrayOfTables, DocumentMut, Item, value};

use crate::command::Report;
use crate::command::ValueKind;
use crate::command::frame::run::{Run, RunError};
use crate::controller::nearest::nearest;
use crate::failure::{Failure, Kind};
use crate::files;
use crate::output::busy::busy;
use crate::output::jq::after_a_change;
use crate::output::view::{Table, View};
use crate::settings::inventory::{Inventory, is_name};
use crate::settings::target::{Family, Given};
use crate::settings::{Setting, duration};

/// What can be done with the inventory.
#[derive(Debug, Subcommand)]
pub enum Robots {
    /// List the robots of the inventory
    List,
    /// Show the effective settings of a robot
    Show(Show),
    /// Add a robot
    Add(Add),
    /// Remove a robot
    Remove(Remove),
    /// Diagnose a connection step by step
    Check(check::Check),
    /// Which controllers answer on the network, and which serial ports are there
    Discover(discover::Discover),
}

/// Arguments of `robots show`.
#[derive(Debug, Args)]
pub struct Show {
    /// Its name
    #[arg(add = ValueKind::Robot)]
    name: String,
    /// Say where each value came from
    #[arg(long)]
    origin: bool,
}

/// Arguments of `robots add`.
#[derive(Debug, Args)]
pub struct Add {
    /// Its name
    name: String,
    /// Where it is, such as udp://192.168.1.31?model=dx200 or serial:///dev/ttyUSB0
    #[arg(add = ValueKind::Url)]
    url: Given,
    /// Its family, where the URL does not tell
    #[arg(long, add = ValueKind::Family)]
    family: Option<Family>,
    /// Take read commands only
    #[arg(long)]
    read_only: bool,
    /// Have the first command that needs a command connection open a session for it (yrcx)
    #[arg(long)]
    hold: bool,
    /// A word to choose it by (repeatable)
    #[arg(long = "with-tag", value_name = "TAG", add = ValueKind::Tag)]
    tags: Vec<String>,
    /// Make it the robot that is taken when none is named
    #[arg(long)]
    default: bool,
}

/// Arguments of `robots remove`.
#[derive(Debug, Args)]
pub struct Remove {
    /// Its name
    #[arg(add = ValueKind::Robot)]
    name: String,
}

impl Robots {
    /// Whether it makes the file where there is none.
    pub fn makes_inventory(&self) -> bool {
        matches!(self, Self::Add(_))
    }

    /// Does it.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        let inventory = &run.sources.inventory;
        match self {
            Self::List => run.local("robots.list", &List::of(inventory)),
            Self::Show(show) => show.run(run),
            Self::Add(add) => add.run(run),
            Self::Remove(remove) => remove.run(run),
            Self::Check(check) => run.robots(&check).await,
            Self::Discover(discover) => discover.run(run).await,
        }
    }
}

impl Show {
    fn run(&self, run: &Run) -> Result<(), RunError> {
        let entry = known(&run.sources.inventory, &self.name)?;
        let robot = run.sources.resolved(entry, None)?;
        let mut settings = vec![row("target", &robot.target, ToString::to_string)];
        if robot.family.has_model() {
            settings.push(row("model", &robot.model, ToString::to_string));
        }
        settings.extend([
            row("read_only", &robot.read_only, ToString::to_string),
            row("hold", &robot.hold, ToString::to_string),
            row("encoding", &robot.encoding, ToString::to_string),
            row("timeout", &robot.timeout, |timeout| duration::display(*timeout)),
            row("retries", &robot.retries, ToString::to_string),
        ]);
        let family = robot.family.name();
        run.local(
            "robots.show",
            &Shown { name: robot.name, family, tags: robot.tags, settings, with_origin: self.origin },
        )
    }
}

/// A setting as a row.
fn row<T>(name: &'static str, setting: &Setting<T>, show: impl Fn(&T) -> String) -> Value {
    Value { name, value: show(&setting.value), origin: setting.origin.to_string() }
}

impl Add {
    fn run(self, run: &Run) -> Result<(), RunError> {
        if !is_name(&self.name) {
            return Err(Failure::usage(format!("'{}' is not a valid robot name", self.name))
                .hint("use letters, digits, '-', '_' and '.'")
                .into());
        }
        if run.sources.inventory.robots.iter().any(|robot| robot.name == self.name) {
            return Err(Failure::usage(format!("there is a robot '{}' already", self.name))
                .hint(format!("`armctl robots remove {}` removes it", self.name))
                .into());
        }
        let url = self.url.of(self.family)?;
        let Some(family) = self.family.or(url.family()) else {
            let failure = Failure::usage(format!("'{url}' does not tell the family"));
            return Err(failure.hint("add --family yerc or --family toyo").into());
        };
        url.check(family)
            .map_err(|why| Failure::usage(why).hint("`armctl help targets` lists the URLs of each family"))?;
        let file = edit(run, |document| {
            let mut robot = toml_edit::Table::new();
            robot["name"] = value(&self.name);
            robot["target"] = value(url.url());
            if url.family().is_none() {
                robot["family"] = value(family.name());
            }
            if self.read_only {
                robot["read_only"] = value(true);
            }
            if self.hold {
                robot["hold"] = value(true);
            }
            if !self.tags.is_empty() {
                robot["tags"] = value(self.tags.iter().collect::<toml_edit::Array>());
            }
            let list = document.entry("robot").or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
            let list = list.as_array_of_tables_mut().ok_or("`robot` is no list of [[robot]] tables")?;
            list.push(robot);
            if self.default || list.len() == 1 {
                document["default"] = value(&self.name);
            }
            Ok(())
        })?;
        let target = url.url().to_owned();
        told(run.local("robots.add", &Changed { done: "added", name: self.name, target, file }))
    }
}

impl Remove {
    fn run(self, run: &Run) -> Result<(), RunError> {
        let target = known(&run.sources.inventory, &self.name)?.target.url().to_owned();
        let file = edit(run, |document| {
            let list = document.get_mut("robot").and_then(Item::as_array_of_tables_mut);
            let list = list.ok_or("`robot` is no list of [[robot]] tables")?;
            list.retain(|robot| robot.get("name").and_then(Item::as_str) != Some(&self.name));
            if document.get("default").and_then(Item::as_str) == Some(&self.name) {
                document.remove("default");
            }
            Ok(())
        })?;
        told(run.local("robots.remove", &Changed { done: "removed", name: self.name, target, file }))
    }
}

/// What was changed is changed, also where that could not be reported.
fn told(reported: Result<(), RunError>) -> Result<(), RunError> {
    reported.map_err(|stopped| RunError { failure: after_a_change(stopped.failure), ..stopped })
}

/// Changes the file and keeps its comments; it is written beside and renamed. What comes back is where it is.
fn edit(run: &Run, change: impl FnOnce(&mut DocumentMut) -> Result<(), &'static str>) -> Result<String, Failure> {
    let path = run.sources.inventory.path.as_deref().ok_or_else(|| {
        Failure::new(Kind::Usage, "there is no home folder to keep robots.toml in").hint("name a file with --config")
    })?;
    let _busy = busy();
    // Others may be changing it: what is read is what is replaced.
    let _turn = files::turn(path).with_context(|| path.display().to_string())?;
    let text = match files::text(path, files::SETTINGS) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => String::new(),
        text => text.with_context(|| path.display().to_string())?,
    };
    let wrong = |why: &dyn std::fmt::Display| {
        Failure::usage(format!("{}: {why}", path.display()))
            .hint("correct the file: `armctl help inventory` shows its form")
    };
    let mut document: DocumentMut = text.parse().map_err(|error| wrong(&error))?;
    change(&mut document).map_err(|why| wrong(&why))?;
    let text = document.to_string();
    // What would not be read again is not written.
    Inventory::parse(&text, &path.display().to_string())?;
    files::replace(path, text.as_bytes()).with_context(|| path.display().to_string())?;
    Ok(path.display().to_string())
}

fn known<'a>(inventory: &'a Inventory, name: &str) -> Result<&'a crate::settings::inventory::Entry, Failure> {
    inventory.robots.iter().find(|robot| robot.name == name).ok_or_else(|| {
        let failure = Failure::usage(format!("there is no robot '{name}' in the inventory"));
        match nearest(name, inventory.robots.iter().map(|robot| robot.name.as_str())) {
            Some(near) => failure.hint(format!("did you mean '{near}'?")),
            None => failure.hint("`armctl robots list` shows them, `armctl robots add` adds one"),
        }
    })
}

/// A robot that came into the inventory or left it.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Changed {
    /// `added` or `removed`.
    done: &'static str,
    name: String,
    target: String,
    /// The file that was changed.
    file: String,
}

impl Report for Changed {
    fn view(&self) -> View {
        View::text(format!("{} {} ({})", self.done, self.name, self.target))
    }
}

/// The inventory.
#[derive(Debug, Serialize, JsonSchema)]
pub struct List {
    /// The file, whether it exists or not.
    file: Option<String>,
    robots: Vec<Listed>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    name: String,
    family: &'static str,
    target: String,
    read_only: bool,
    /// Taken when no robot is named.
    default: bool,
    tags: Vec<String>,
}

impl List {
    fn of(inventory: &Inventory) -> Self {
        let robots = inventory.robots.iter().map(|robot| Listed {
            name: robot.name.clone(),
            family: robot.family.name(),
            target: robot.target.url().to_owned(),
            read_only: robot.options.read_only.or(inventory.defaults.read_only).unwrap_or(false),
            default: inventory.default.as_ref() == Some(&robot.name),
            tags: robot.tags.clone(),
        });
        Self { file: inventory.path.as_ref().map(|path| path.display().to_string()), robots: robots.collect() }
    }
}

impl Report for List {
    fn view(&self) -> View {
        let mut table = Table::new(
            &["name", "family", "target", "default", "read-only", "tags"],
            "no robots yet; `armctl robots add cell1 udp://192.168.1.31` adds one",
        );
        let mark = |on: bool| if on { "yes" } else { "" };
        for robot in &self.robots {
            table.row([
                robot.name.as_str().into(),
                robot.family.into(),
                robot.target.as_str().into(),
                mark(robot.default).into(),
                mark(robot.read_only).into(),
                robot.tags.join(" ").into(),
            ]);
        }
        View::table(table)
    }
}

/// One robot with every setting in force.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Shown {
    name: String,
    family: &'static str,
    tags: Vec<String>,
    settings: Vec<Value>,
    #[serde(skip)]
    with_origin: bool,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Value {
    name: &'static str,
    value: String,
    /// flag, environment, target URL, robot, defaults or built-in.
    origin: String,
}

impl Report for Shown {
    fn view(&self) -> View {
        let columns: &[&'static str] =
            if self.with_origin { &["setting", "value", "from"] } else { &["setting", "value"] };
        let mut table = Table::new(columns, "");
        let (tags, family) = (self.tags.join(" "), self.family.to_owned());
        let own = [("name", self.name.clone()), ("family", family), ("tags", tags)];
        let own = own.into_iter().map(|(name, value)| (name, value, "robot".to_owned()));
        let settings = self.settings.iter().map(|row| (row.name, row.value.clone(), row.origin.clone()));
        for (name, value, origin) in own.chain(settings) {
            let mut cells = vec![name.into(), value.into()];
            if self.with_origin {
                cells.push(origin.into());
            }
            table.rows.push(cells);
        }
        View::table(table)
    }
}

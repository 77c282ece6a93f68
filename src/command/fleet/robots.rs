//! `armctl robots`: commands for the inventory, and discovery of controllers.

pub mod check;
pub mod discover;
pub mod edit;
pub mod entry;
pub mod file;

use std::collections::HashSet;

use clap::Subcommand;

use self::entry::check_known;
use armctl_frame::prelude::*;
use armctl_frame::settings::inventory::{Entry, matches_pattern};
use armctl_frame::settings::model::ModelCache;
use armctl_frame::settings::place::Place;
use armctl_frame::settings::target::Address;
use armctl_frame::settings::{Origin, Setting};

/// Commands for the inventory.
#[derive(Debug, Subcommand)]
pub enum Robots {
    /// List the robots in the inventory
    List,
    /// Show the effective settings of a robot
    Show(Show),
    /// Add a robot; `armctl setup` asks for each setting
    Add(Box<entry::Add>),
    /// Change settings of a robot
    Set(entry::Set),
    /// Rename a robot
    Rename(entry::Rename),
    /// Set the default robot
    Default(entry::Default),
    /// Remove a robot
    Remove(entry::Remove),
    /// Edit the inventory in an editor, and check it
    Edit,
    /// Print the path of the inventory
    Path,
    /// Diagnose a connection step by step
    Check(check::Check),
    /// Find controllers on the network and list serial ports
    Discover(discover::Discover),
}

/// Arguments of `robots show`.
#[derive(Debug, Args)]
pub struct Show {
    /// Name of the robot
    #[arg(add = ValueKind::Robot)]
    name: String,
    /// Show the origin of each value
    #[arg(long)]
    origin: bool,
}

impl Robots {
    /// Whether the command creates a missing inventory file.
    pub fn makes_inventory(&self) -> bool {
        matches!(self, Self::Add(_))
    }

    /// Whether the command only uses the file, even if its content is not valid.
    pub fn is_about_file(&self) -> bool {
        matches!(self, Self::Edit | Self::Path)
    }

    /// Runs the command.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        let inventory = &run.sources.inventory;
        if let Some(path) = &inventory.path {
            armctl_files::sweep(&armctl_files::folder_of(path));
        }
        match self {
            Self::List => run.local("robots.list", &List::of(run)?),
            Self::Show(show) => show.run(run),
            Self::Add(add) => add.run(run),
            Self::Set(set) => set.run(run),
            Self::Rename(rename) => rename.run(run),
            Self::Default(default) => default.run(run),
            Self::Remove(remove) => remove.run(run),
            Self::Edit => edit::edit(run),
            Self::Path => edit::path(run),
            Self::Check(check) => run.robots(&check).await,
            Self::Discover(discover) => discover.run(run).await,
        }
    }
}

impl Show {
    fn run(&self, run: &Run) -> Result<(), RunError> {
        let entry = check_known(&run.sources.inventory, &self.name)?;
        let robot = run.sources.resolve(entry, None)?;
        run.local("robots.show", &Shown { with_origin: self.origin, ..Shown::of(&robot) })
    }
}

/// Model that the controller reported earlier, if no setting contains a model.
fn reported_model(robot: &Robot) -> Option<Value> {
    if robot.model.value.named().is_some() {
        return None;
    }
    let reported = ModelCache::of_user()?.find(&robot.target.value.address())?;
    let origin =
        format!("controller, {} ago", duration::display(Duration::from_secs(reported.age().as_secs() / 60 * 60)));
    Some(Value { name: "told_model", value: format!("{} ({})", reported.model(), reported.software()), origin })
}

/// A setting as a table row.
fn row<T>(name: &'static str, setting: &Setting<T>, show: impl Fn(&T) -> String) -> Value {
    Value { name, value: show(&setting.value), origin: setting.origin.to_string() }
}

/// The inventory.
#[derive(Debug, Serialize, JsonSchema)]
pub struct List {
    /// Path of the file, which may not exist.
    file: Option<String>,
    robots: Vec<Listed>,
    /// Whether the inventory has robots that are not selected.
    #[serde(skip)]
    has_others: bool,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    name: String,
    family: &'static str,
    target: String,
    read_only: bool,
    /// Whether commands use this robot if no robot is selected.
    default: bool,
    tags: Vec<String>,
    /// Place in the plant.
    place: Place,
}

impl List {
    /// Selected robots; all without a selection.
    fn of(run: &Run) -> Result<Self> {
        let (inventory, selection) = (&run.sources.inventory, &run.sources.selection);
        if selection.sim || selection.target.is_some() {
            return Err(Failure::usage("--sim and -t cannot select robots in the inventory")
                .hint("select robots with -r or --tag"));
        }
        let is_chosen = |robot: &&Entry| {
            let is_named = selection.from_environment
                || selection.robots.is_empty()
                || selection.robots.iter().any(|pattern| matches_pattern(pattern, &robot.name));
            is_named && selection.tags.iter().all(|tag| robot.has_tag(tag))
        };
        let robots: Vec<&Entry> = inventory.robots.iter().filter(is_chosen).collect();
        // A controller is read-only under every name that leads to it.
        let bound: HashSet<Address> = Family::ALL
            .into_iter()
            .flat_map(|family| run.sources.read_only(family))
            .filter(|(_, entry)| !entry.target.is_simulated())
            .map(|(address, _)| address)
            .collect();
        let has_others = robots.len() < inventory.robots.len();
        let robots = robots.into_iter().map(|robot| Listed {
            name: robot.name.clone(),
            family: robot.family.name(),
            target: robot.target.url().to_owned(),
            read_only: robot.options.read_only.or(inventory.defaults.read_only).unwrap_or(false)
                || bound.contains(&robot.target.address()),
            default: inventory.default.as_ref() == Some(&robot.name),
            tags: robot.tags.clone(),
            place: robot.place.clone(),
        });
        Ok(Self {
            file: inventory.path.as_ref().map(|path| path.display().to_string()),
            robots: robots.collect(),
            has_others,
        })
    }
}

impl Report for List {
    fn view(&self) -> View {
        let no_robots = if self.has_others {
            "no robot in the inventory has this name or tag"
        } else {
            "no robots yet; add one with `armctl setup`, or with `armctl robots add cell1 udp://192.168.1.31`"
        };
        let mut table = Table::new(&["name", "family", "target", "default", "read-only", "place", "tags"], no_robots);
        let mark = |on: bool| if on { "yes" } else { "" };
        for robot in &self.robots {
            table.row([
                robot.name.as_str().into(),
                robot.family.into(),
                robot.target.as_str().into(),
                mark(robot.default).into(),
                mark(robot.read_only).into(),
                robot.place.path().into(),
                robot.tags.join(" ").into(),
            ]);
        }
        View::table(table)
    }
}

/// One robot with its effective settings.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Shown {
    name: String,
    family: &'static str,
    tags: Vec<String>,
    /// Place in the plant.
    place: Place,
    settings: Vec<Value>,
    #[serde(skip)]
    with_origin: bool,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Value {
    name: &'static str,
    value: String,
    /// Origin of the value: flag, environment, target URL, robot, defaults or built-in.
    origin: String,
}

impl Shown {
    /// Settings of a robot.
    pub fn of(robot: &Robot) -> Self {
        let mut settings = vec![row("target", &robot.target, ToString::to_string)];
        if robot.family.has_model() {
            settings.push(row("model", &robot.model, ToString::to_string));
            settings.extend(reported_model(robot));
        }
        settings.extend([
            row("read_only", &robot.read_only, ToString::to_string),
            row("hold", &robot.hold, ToString::to_string),
            row("encoding", &robot.encoding, ToString::to_string),
            row("timeout", &robot.timeout, |timeout| duration::display(*timeout)),
            row("retries", &robot.retries, ToString::to_string),
        ]);
        if !robot.pulses_per_degree.is_empty() {
            let value = robot.pulses_per_degree.iter().map(f64::to_string).collect::<Vec<_>>().join(",");
            settings.push(Value { name: "pulses_per_degree", value, origin: Origin::Robot.to_string() });
        }
        Self {
            name: robot.name.clone(),
            family: robot.family.name(),
            tags: robot.tags.clone(),
            place: robot.place.clone(),
            settings,
            with_origin: false,
        }
    }

    /// Removes tags and place, which name parts of a plant.
    pub fn hide_places(&mut self) {
        (self.tags, self.place) = (Vec::new(), Place::default());
    }
}

impl Report for Shown {
    fn view(&self) -> View {
        let columns: &[&'static str] =
            if self.with_origin { &["setting", "value", "from"] } else { &["setting", "value"] };
        let mut table = Table::new(columns, "");
        let (tags, family) = (self.tags.join(" "), self.family.to_owned());
        let own = [("name", self.name.clone()), ("family", family), ("tags", tags)];
        let place = self.place.levels().into_iter().filter_map(|(key, value)| Some((key, value?.to_owned())));
        let own = own.into_iter().chain(place).map(|(name, value)| (name, value, "robot".to_owned()));
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

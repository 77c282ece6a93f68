//! Commands that add, change and remove inventory entries.

use toml_edit::{Array, Table, Value, value};

use super::file::change;
use armctl_controller::text::Encoding;
use armctl_controller::yerc::Model;
use armctl_frame::Candidate;
use armctl_frame::output::jq::failure_after_change;
use armctl_frame::output::view;
use armctl_frame::prelude::*;
use armctl_frame::settings::inventory::{Entry, Inventory, is_name, named};
use armctl_frame::settings::model::ModelSetting;
use armctl_frame::settings::place;
use armctl_frame::settings::target::{Target, TargetArgument};

/// Arguments of `robots add`.
#[derive(Debug, Args)]
pub struct Add {
    /// Name of the new robot
    name: String,
    /// URL of the robot, such as udp://192.168.1.31?model=dx200 or serial:///dev/ttyUSB0
    #[arg(add = ValueKind::Url)]
    url: TargetArgument,
    /// Family of the robot, if armctl cannot infer it from the URL
    #[arg(long, add = ValueKind::Family)]
    family: Option<Family>,
    /// Accept only reads and stop commands
    #[arg(long)]
    read_only: bool,
    /// Open a session with the first command that needs a connection (yrcx)
    #[arg(long)]
    hold: bool,
    /// A tag for --tag (repeatable)
    #[arg(long = "with-tag", value_name = "TAG", add = ValueKind::Tag)]
    tags: Vec<String>,
    /// Make this robot the default robot
    #[arg(long)]
    default: bool,
    /// Other settings, such as site=berlin or timeout=5s; `armctl robots set --help` lists them
    #[arg(value_name = "KEY=VALUE", add = ValueKind::Listed(candidates))]
    settings: Vec<String>,
}

/// A new inventory entry.
#[derive(Debug)]
pub struct NewRobot {
    /// Name.
    pub name: String,
    /// Target.
    pub target: Target,
    /// Family.
    pub family: Family,
    /// Whether the robot accepts only reads and stop commands.
    pub read_only: bool,
    /// Automatic session; see [`Entry`].
    pub hold: bool,
    /// Tags.
    pub tags: Vec<String>,
    /// Whether the robot becomes the default robot.
    pub is_default: bool,
}

impl NewRobot {
    /// Table of the entry.
    pub fn table(&self) -> Table {
        let mut table = Table::new();
        table["name"] = value(&self.name);
        table["target"] = value(self.target.url());
        if self.target.family().is_none() {
            table["family"] = value(self.family.name());
        }
        for (key, _) in [("read_only", self.read_only), ("hold", self.hold)].into_iter().filter(|(_, is_on)| *is_on) {
            table[key] = value(true);
        }
        if !self.tags.is_empty() {
            table["tags"] = value(self.tags.iter().collect::<Array>());
        }
        table
    }

    /// Writes the entry to the file, with other settings `KEY=VALUE`.
    pub fn add(self, run: &Run, id: &'static str, settings: &[String]) -> Result<(), RunError> {
        let settings = assignments(settings, self.family)?;
        let (address, is_simulated) = (self.target.address(), self.target.is_simulated());
        let same = run.sources.inventory.robots.iter().find(|entry| entry.target.address() == address);
        if let Some(other) = same.filter(|_| !is_simulated) {
            run.screen.note(&format!(
                "{} has the same address as {}; a controller is read-only under both names if it is under one",
                self.name, other.name
            ));
        }
        let file = change(run, |document| {
            document.add(self.table(), self.is_default)?;
            settings.into_iter().try_for_each(|(key, new)| document.set(&self.name, key, new).map(drop))
        })?;
        let target = self.target.url().to_owned();
        changes_text(run.local(id, &Changed { done: "added", name: self.name, target, file }))
    }
}

impl Add {
    pub(super) fn run(self, run: &Run) -> Result<(), RunError> {
        check_new(&run.sources.inventory, &self.name)?;
        let target = self.url.resolve(self.family)?;
        let Some(family) = self.family.or(target.family()).or_else(|| target.family_of_backup()) else {
            let failure = Failure::usage(format!("armctl cannot infer the family from '{target}'"));
            return Err(failure.hint("add --family yerc or --family toyo").into());
        };
        target
            .check(family)
            .map_err(|why| Failure::usage(why).hint("see `armctl help targets` for the URLs of each family"))?;
        let Self { name, read_only, hold, tags, default: is_default, settings, .. } = self;
        NewRobot { name, target, family, read_only, hold, tags, is_default }.add(run, "robots.add", &settings)
    }
}

/// Arguments of `robots remove`.
#[derive(Debug, Args)]
pub struct Remove {
    /// Name of the robot
    #[arg(add = ValueKind::Robot)]
    name: String,
}

impl Remove {
    pub(super) fn run(self, run: &Run) -> Result<(), RunError> {
        let target = check_known(&run.sources.inventory, &self.name)?.target.url().to_owned();
        let file = change(run, |document| document.remove(&self.name))?;
        changes_text(run.local("robots.remove", &Changed { done: "removed", name: self.name, target, file }))
    }
}

/// Changes settings of a robot; `KEY=` without a value removes a setting.
#[derive(Debug, Args)]
#[command(after_help = "Settings: target, family, model, read_only, hold, encoding, timeout, retries, \
                        pulses_per_degree=S,L,U,R,B,T (yerc), tags=A,B, and the place: site, \
                        area, line, cell. Names: names.NAME=ADDRESS, such as \
                        names.clamp=27010.")]
pub struct Set {
    /// Name of the robot
    #[arg(add = ValueKind::Robot)]
    name: String,
    /// A setting and its value, such as read_only=off or timeout=5s
    #[arg(required = true, value_name = "KEY=VALUE", add = ValueKind::Listed(candidates))]
    settings: Vec<String>,
}

/// Parses the typed text for a robot of a family into a TOML value.
type Parse = fn(&str, Family) -> Result<Value>;

/// Settings of an entry: key, description, parser.
const SETTINGS: [(&str, &str, Parse); 14] = [
    ("target", "target URL", |text, family| {
        let target = text.parse::<TargetArgument>()?.resolve(Some(family))?;
        Ok(target.url().into())
    }),
    ("family", "yerc, yrcx or toyo", |text, _| Ok(parsed::<Family>(text)?.name().into())),
    ("model", "auto, fs100, dx100, dx200 or yrc1000 (yerc)", |text, _| {
        Ok(parsed::<ModelSetting>(text)?.to_string().into())
    }),
    ("read_only", "on: accept only reads and stop commands; off: accept all commands", |text, _| {
        Ok(switch(text)?.into())
    }),
    ("hold", "on: open a session automatically (yrcx); off: do not open a session", |text, _| Ok(switch(text)?.into())),
    ("encoding", "encoding of names and texts on the controller", |text, _| {
        Ok(parsed::<Encoding>(text)?.to_string().into())
    }),
    ("timeout", "longest wait for an answer, per try, such as 5s", |text, _| {
        let timeout = duration::parse_some(text).map_err(|why| invalid(why, "example: timeout=5s"))?;
        Ok(duration::display(timeout).into())
    }),
    ("retries", "number of retries of a read without an answer", |text, _| {
        let retries = text.parse::<u32>();
        let why = format!("'{text}' is not a valid number of retries");
        Ok(i64::from(retries.map_err(|_| invalid(why, "example: retries=3"))?).into())
    }),
    ("pulses_per_degree", "pulses per degree of the axes S,L,U,R,B,T of R1 (yerc)", |text, _| {
        let values: Result<Vec<f64>, _> = text.split(',').map(|value| value.trim().parse::<f64>()).collect();
        let values = values.ok().filter(|values| values.iter().all(|value| value.is_finite() && *value > 0.0));
        let why = || {
            invalid(
                format!("'{text}' is not a list of numbers"),
                "example: pulses_per_degree=1360,1360,1360,1000,1000,500",
            )
        };
        Ok(Value::Array(values.ok_or_else(why)?.into_iter().collect()))
    }),
    ("tags", "tags for --tag, such as line1,welding", |text, _| {
        Ok(Value::Array(text.split(',').map(str::trim).filter(|tag| !tag.is_empty()).collect()))
    }),
    ("site", "place: site, such as berlin", level),
    ("area", "place: area of the site", level),
    ("line", "place: line of the area", level),
    ("cell", "place: cell of the line", level),
];

fn candidates() -> Vec<Candidate> {
    let keys = SETTINGS.iter().map(|(key, about, _)| Candidate::new(format!("{key}="), *about).incomplete());
    let models = Model::ALL.map(Model::name).into_iter().chain([ModelSetting::AUTO]);
    keys.chain(models.map(|model| Candidate::new(format!("model={model}"), "model of a yerc robot"))).collect()
}

fn parsed<T: std::str::FromStr<Err: fmt::Display>>(text: &str) -> Result<T> {
    text.parse::<T>().map_err(|why| invalid(why.to_string(), "see `armctl help inventory`"))
}

fn invalid(why: impl Into<String>, hint: &str) -> Failure {
    Failure::usage(why).hint(hint)
}

fn level(text: &str, _: Family) -> Result<Value> {
    place::check(text).map_err(|why| invalid(why, "example: line=3"))?;
    Ok(text.into())
}

fn switch(text: &str) -> Result<bool> {
    match text {
        "on" | "true" | "yes" => Ok(true),
        "off" | "false" | "no" => Ok(false),
        _ => Err(invalid(format!("'{text}' is not on or off"), "example: read_only=off")),
    }
}

impl Set {
    pub(super) fn run(self, run: &Run) -> Result<(), RunError> {
        set(run, "robots.set", self.name, &self.settings)
    }
}

/// Writes settings of a robot to the file.
pub fn set(run: &Run, id: &'static str, robot: String, settings: &[String]) -> Result<(), RunError> {
    let entry = check_known(&run.sources.inventory, &robot)?;
    let values = assignments(settings, entry.family)?;
    let mut changes = Vec::new();
    let file = change(run, |document| {
        for (key, new) in values {
            let report = new.as_ref().map(json);
            let old = document.set(&robot, key, new)?;
            changes.push(SettingChange { setting: key.to_owned(), old: old.as_ref().map(json), new: report });
        }
        Ok(())
    })?;
    changes_text(run.local(id, &WasSet { name: robot, changes, file }))
}

/// Address of a name, as a number if the text is a number, as in a hand-written file.
fn address(text: &str, family: Family) -> Result<Value> {
    named(family, "any", text)?;
    Ok(text.parse::<i64>().map_or_else(|_| text.into(), Value::from))
}

/// Parses typed settings for a robot of a family: keys, and new values; `None` removes a setting.
fn assignments(settings: &[String], family: Family) -> Result<Vec<(&str, Option<Value>)>> {
    let settings = settings.iter().map(|setting| assignment(setting)).collect::<Result<Vec<_>, _>>()?;
    // The meaning of an address without a scheme depends on the family, which can be set in the same command.
    let typed = settings.iter().find(|(key, ..)| *key == "family").and_then(|(_, text, _)| text.parse().ok());
    let family = typed.unwrap_or(family);
    let value = |(key, text, parse): (_, &str, Parse)| {
        let new = if text.is_empty() { None } else { Some(parse(text, family).map_err(|why| add_context(key, why))?) };
        if let (Some(name), Some(_)) = (key.strip_prefix("names."), &new) {
            named(family, name, text).map_err(|why| add_context(key, why))?;
        }
        Ok((key, new))
    };
    settings.into_iter().map(value).collect()
}

/// Splits a typed setting into its key and text, and finds its parser.
fn assignment(setting: &str) -> Result<(&str, &str, Parse)> {
    let Some((key, text)) = setting.split_once('=') else {
        return Err(Failure::usage(format!("'{setting}' is not KEY=VALUE"))
            .hint("type settings such as read_only=off or timeout=5s"));
    };
    if key.strip_prefix("names.").is_some_and(|name| !name.is_empty()) {
        return Ok((key, text.trim(), address));
    }
    if let Some((key, _, parse)) = SETTINGS.iter().find(|(known, ..)| *known == key) {
        return Ok((key, text.trim(), *parse));
    }
    let failure = Failure::usage(format!("a robot has no setting '{key}'"));
    Err(match (key, nearest(key, SETTINGS.iter().map(|(known, ..)| *known))) {
        ("name", _) => failure.hint("rename the robot with `armctl robots rename OLD NEW`"),
        ("default", _) => failure.hint("set the default with `armctl robots default NAME`"),
        (_, Some(near)) => failure.hint(format!("did you mean '{near}'?")),
        (_, None) => failure.hint(format!("known: {}", SETTINGS.map(|(known, ..)| known).join(", "))),
    })
}

fn add_context(key: &str, failure: Failure) -> Failure {
    Failure { message: format!("{key}: {}", failure.message), ..failure }
}

/// Converts a TOML value to JSON for the report.
fn json(value: &Value) -> serde_json::Value {
    match value {
        Value::Boolean(is_on) => (*is_on.value()).into(),
        Value::Integer(number) => (*number.value()).into(),
        Value::Array(list) => list.iter().map(json).collect(),
        Value::String(text) => text.value().as_str().into(),
        other => other.to_string().trim().into(),
    }
}

/// Changed settings of a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WasSet {
    name: String,
    changes: Vec<SettingChange>,
    /// The file that was changed.
    file: String,
}

#[derive(Debug, Serialize, JsonSchema)]
struct SettingChange {
    setting: String,
    /// Old value; null if there was none.
    old: Option<serde_json::Value>,
    /// New value; null if the setting was removed.
    new: Option<serde_json::Value>,
}

impl Report for WasSet {
    fn view(&self) -> View {
        let mut table = view::Table::new(&["setting", "old", "new"], "");
        for SettingChange { setting, old, new } in &self.changes {
            let shown = |value: &Option<serde_json::Value>| {
                Cell::optional(value.as_ref().map(|value| match value {
                    serde_json::Value::String(text) => text.clone(),
                    serde_json::Value::Array(list) => {
                        list.iter().filter_map(serde_json::Value::as_str).collect::<Vec<_>>().join(" ")
                    }
                    other => other.to_string(),
                }))
            };
            table.row([setting.as_str().into(), shown(old), shown(new)]);
        }
        View::table(table)
    }
}

/// Arguments of `robots rename`.
#[derive(Debug, Args)]
pub struct Rename {
    /// Current name of the robot
    #[arg(add = ValueKind::Robot)]
    old: String,
    /// New name of the robot
    new: String,
}

impl Rename {
    pub(super) fn run(self, run: &Run) -> Result<(), RunError> {
        let inventory = &run.sources.inventory;
        let target = check_known(inventory, &self.old)?.target.url().to_owned();
        check_new(inventory, &self.new)?;
        let file = change(run, |document| document.rename(&self.old, &self.new))?;
        let Self { old, new } = self;
        run.screen.note(&format!(
            "hint: rename the folders {old} in backups of several robots. An open session keeps the old name until it \
             is closed"
        ));
        changes_text(run.local("robots.rename", &Renamed { old, new, target, file }))
    }
}

/// A renamed robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Renamed {
    old: String,
    new: String,
    target: String,
    /// The file that was changed.
    file: String,
}

impl Report for Renamed {
    fn view(&self) -> View {
        View::text(format!("{} is now {} ({})", self.old, self.new, self.target))
    }
}

/// Arguments of `robots default`.
#[derive(Debug, Args)]
pub struct Default {
    /// Name of the robot
    #[arg(add = ValueKind::Robot)]
    name: String,
}

impl Default {
    pub(super) fn run(self, run: &Run) -> Result<(), RunError> {
        let inventory = &run.sources.inventory;
        let target = check_known(inventory, &self.name)?.target.url().to_owned();
        let file = change(run, |document| {
            document.set_default(&self.name);
            Ok(())
        })?;
        changes_text(
            run.local("robots.default", &WasChosen { old: inventory.default.clone(), new: self.name, target, file }),
        )
    }
}

/// The robot that is used if none is selected.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WasChosen {
    /// The earlier default; null if there was none.
    old: Option<String>,
    new: String,
    target: String,
    /// The file that was changed.
    file: String,
}

impl Report for WasChosen {
    fn view(&self) -> View {
        View::text(format!("{} is the default robot ({})", self.new, self.target))
    }
}

/// The change is done even if the report could not be written.
fn changes_text(reported: Result<(), RunError>) -> Result<(), RunError> {
    reported.map_err(|stopped| RunError { failure: failure_after_change(stopped.failure), ..stopped })
}

/// Checks that a name is valid and not in use.
pub fn check_new(inventory: &Inventory, name: &str) -> Result<()> {
    if !is_name(name) {
        return Err(
            Failure::usage(format!("'{name}' is not a valid robot name")).hint("use letters, digits, '-', '_' and '.'")
        );
    }
    if inventory.robots.iter().any(|robot| robot.name == name) {
        return Err(Failure::usage(format!("robot '{name}' already exists")).hint(format!(
            "change the robot with `armctl robots set {name} KEY=VALUE`, or remove it with `armctl robots remove \
             {name}`"
        )));
    }
    Ok(())
}

/// Entry with this name.
pub fn check_known<'a>(inventory: &'a Inventory, name: &str) -> Result<&'a Entry> {
    inventory.robots.iter().find(|robot| robot.name == name).ok_or_else(|| {
        let failure = Failure::usage(format!("there is no robot '{name}' in the inventory"));
        match nearest(name, inventory.robots.iter().map(|robot| robot.name.as_str())) {
            Some(near) => failure.hint(format!("did you mean '{near}'?")),
            None => failure.hint("list the robots with `armctl robots list`, or add one with `armctl robots add`"),
        }
    })
}

/// A robot that was added or removed.
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

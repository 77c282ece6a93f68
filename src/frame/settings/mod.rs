//! Settings: the selected robots, and every setting with its origin.
//!
//! If several sources contain a setting, the first of them is used: flag, environment, robot, `[defaults]` of the file,
//! built-in default.

pub mod alarms;
pub mod document;
pub mod duration;
pub mod inventory;
pub mod model;
pub mod names;
pub mod place;
pub mod rehearsal;
pub mod target;

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use etcetera::BaseStrategy as _;

use crate::failure::Failure;
use alarms::Alarms;
use armctl_controller::names::Name;
use armctl_controller::similar_word::nearest;
use armctl_controller::simulator::run_options::RunOptions;
use armctl_controller::text::Encoding;
use armctl_controller::yerc::Model;
use inventory::{Entry, Inventory, Options};
use model::{ModelCache, ModelSetting};
use names::RobotNames;
use place::Place;
use rehearsal::{Rehearsal, Rehearsals};
use target::{Address, Family, Target, TargetArgument};

/// Where a setting comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// Command line flag.
    Flag,
    /// Environment variable.
    Environment,
    /// Target URL.
    Url,
    /// Inventory entry of the robot.
    Robot,
    /// `[defaults]` of the inventory.
    Defaults,
    /// Built-in default.
    BuiltIn,
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Flag => "flag",
            Self::Environment => "environment",
            Self::Url => "target URL",
            Self::Robot => "robot",
            Self::Defaults => "defaults",
            Self::BuiltIn => "built-in",
        })
    }
}

/// A value with its origin.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Setting<T> {
    /// Value.
    pub value: T,
    /// Origin.
    pub origin: Origin,
}

/// A robot with all its settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// Name in the inventory. If the robot is not in the inventory, a short form of the target.
    pub name: String,
    /// Family.
    pub family: Family,
    /// Target.
    pub target: Setting<Target>,
    /// Time limit of one attempt.
    pub timeout: Setting<Duration>,
    /// Number of retries of a read.
    pub retries: Setting<u32>,
    /// Encoding of names and texts.
    pub encoding: Setting<Encoding>,
    /// Whether only reads and stops are accepted.
    pub read_only: Setting<bool>,
    /// Name of another inventory entry with the same address, if that entry makes the robot read-only.
    pub read_only_entry: Option<String>,
    /// Other addresses of the robot, if its network was queried.
    pub aliases: Vec<Address>,
    /// Whether the first command that requires a control connection opens a session.
    pub hold: Setting<bool>,
    /// Controller model (only yerc).
    pub model: Setting<ModelSetting>,
    /// Pulses per degree of each axis of robot R1 (only yerc). Empty if not set.
    pub pulses_per_degree: Vec<f64>,
    /// Tags.
    pub tags: Vec<String>,
    /// Place in the plant.
    pub place: Place,
    /// Whether the inventory names this robot as its default.
    pub is_default: bool,
    /// Sessions that commands of the robot use.
    pub sessions: Sessions,
    /// Alarm explanations of the robot's site.
    pub alarms: Alarms,
    /// Names of the robot's signals, variables and registers.
    pub names: RobotNames,
    /// Path of the inventory. A change of the inventory can make the robot read-only at any time.
    pub inventory: Option<PathBuf>,
    /// Record of a rehearsal, in which a simulator stands for the robot.
    pub rehearsal: Option<Rehearsal>,
}

/// Folder for persistent state of the user; `None` without a home folder.
pub fn state_folder() -> Option<PathBuf> {
    let folders = etcetera::choose_base_strategy().ok()?;
    Some(folders.state_dir().unwrap_or_else(|| folders.cache_dir()).join("armctl"))
}

impl Robot {
    /// Whether this is a known address of the robot.
    pub fn has_address(&self, address: &Address) -> bool {
        self.target.value.address().meets(address) || self.aliases.iter().any(|alias| alias.meets(address))
    }

    /// Probable model of the controller: the model in the settings, the model that the controller reported earlier, or
    /// the model of the simulator.
    pub fn likely_model(&self) -> Option<Model> {
        let target = &self.target.value;
        let cached = || ModelCache::of_user()?.find(&target.address()).map(|told| told.model());
        let simulated = || target.is_simulated().then_some(Model::Dx200);
        self.model.value.named().or_else(cached).or_else(simulated)
    }

    /// Options of the simulator, if the target is a simulator.
    pub fn simulator_options(&self) -> RunOptions {
        self.rehearsal.as_ref().map(Rehearsal::simulator_options).unwrap_or_default()
    }

    /// Name of the robot on a command line: its name in the inventory, or its URL.
    pub fn as_typed(&self) -> &str {
        if self.target.origin == Origin::Robot { &self.name } else { self.target.value.url() }
    }

    /// Label in messages, for example `cell3 (udp://192.168.1.31)`.
    pub fn label(&self) -> String {
        let url = self.target.value.url();
        if self.target.origin == Origin::Robot {
            format!("{} ({url})", self.name)
        } else {
            // The colon of `sim:` is removed, because a colon follows the label in messages.
            url.trim_end_matches(':').to_owned()
        }
    }
}

/// Robot selection, from flags and environment.
#[derive(Debug, Clone, Default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag, or a command's value for one")]
pub struct Selection {
    /// `--sim`.
    pub sim: bool,
    /// `--target`.
    pub target: Option<TargetArgument>,
    /// `--robot`: names or patterns. If no flag selects robots, the names or patterns of `ARMCTL_ROBOT`.
    pub robots: Vec<String>,
    /// Whether the value of `robots` comes from `ARMCTL_ROBOT`.
    pub from_environment: bool,
    /// `--tag`.
    pub tags: Vec<String>,
    /// `--all`.
    pub all: bool,
    /// `ARMCTL_TARGET`.
    pub environment: Option<TargetArgument>,
    /// Sessions that commands use.
    pub sessions: Sessions,
    /// Family of the simulator, if the command line names no family. `None` means the first family.
    pub simulated: Option<Family>,
    /// Whether `--sim` without a family selects the simulators of all families.
    pub every_simulator: bool,
}

/// Sessions that commands use.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sessions {
    /// Commands use no session (`--no-session`).
    #[default]
    None,
    /// Commands use the sessions of this user.
    Shared,
    /// Commands use only sessions of this user, and open no direct connection.
    Only,
    /// Commands use the sessions of this user, except for simulators. Simulators run in this process, which executes
    /// several command lines.
    OwnSimulators,
}

impl Selection {
    /// Whether neither a flag nor the environment selects a robot.
    pub fn is_empty(&self) -> bool {
        !self.has_flags() && self.environment.is_none() && self.robots.is_empty()
    }

    /// Whether flags select robots.
    pub fn has_flags(&self) -> bool {
        let by_name = !self.from_environment && !self.robots.is_empty();
        self.sim || self.all || self.target.is_some() || by_name || !self.tags.is_empty()
    }

    /// Whether a flag contains exactly this name. A name from the environment does not count, because it may be meant
    /// for another command.
    pub fn is_typed(&self, name: &str) -> bool {
        !self.from_environment && self.robots.iter().any(|robot| robot == name)
    }

    /// Whether the command line can select several robots. The output is then a list.
    pub fn is_plural(&self) -> bool {
        self.all
            || self.sim && self.every_simulator
            || self.robots.len() > 1
            || !self.tags.is_empty()
            || self.robots.iter().any(|name| name.contains(['*', '?']))
    }
}

/// All sources of settings.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    /// Selection of robots.
    pub selection: Selection,
    /// Settings from flags.
    pub flags: Options,
    /// Settings from environment variables.
    pub environment: Options,
    /// Inventory.
    pub inventory: Inventory,
    /// Records of a rehearsal. Only the robots of the rehearsal can then be selected.
    pub rehearsal: Option<Rehearsals>,
}

/// Default number of retries of a read.
const RETRIES: u32 = 3;

impl Sources {
    /// Returns the selected robots for a command of `family` (`None`: any family). There is at least one.
    pub fn robots(&self, family: Option<Family>) -> Result<Vec<Robot>, Failure> {
        let selection = &self.selection;
        if self.rehearsal.is_some() && (selection.sim || selection.target.is_some() || selection.environment.is_some())
        {
            return Err(Failure::usage("a rehearsal reaches only the robots of the backup, by name")
                .hint("select a robot with -r NAME instead of --sim, -t URL or ARMCTL_TARGET"));
        }
        if selection.from_environment && selection.environment.is_some() {
            return Err(Failure::usage("ARMCTL_TARGET and ARMCTL_ROBOT are both set, and each selects a robot")
                .hint("unset one of them, or select the robot with -r or -t"));
        }
        if selection.sim {
            let simulator = |family| self.robot_at(&TargetArgument::Url(Target::simulator()), Origin::Flag, family);
            if family.is_none() && selection.every_simulator {
                return Family::ALL.into_iter().map(|family| simulator(Some(family))).collect();
            }
            return Ok(vec![simulator(family)?]);
        }
        if let Some(target) = &selection.target {
            return Ok(vec![self.robot_at(target, Origin::Flag, family)?]);
        }
        if selection.all || !selection.robots.is_empty() || !selection.tags.is_empty() {
            return self.robots_by_name(family);
        }
        if let Some(target) = &selection.environment {
            return Ok(vec![self.robot_at(target, Origin::Environment, family)?]);
        }
        let default = self.inventory.default.as_ref();
        if let Some(entry) = default.and_then(|name| self.inventory.robots.iter().find(|robot| robot.name == *name)) {
            return Ok(vec![self.resolve(entry, family)?]);
        }
        let address = family.map_or("udp://HOST", Family::address);
        Err(Failure::usage("no robot selected").hint(format!(
            "use --sim (built-in simulator), -t {address} (address) or -r NAME (robot in the inventory), or set \
             ARMCTL_TARGET or ARMCTL_ROBOT{}",
            if self.inventory.robots.is_empty() { "; `armctl setup` adds a robot step by step" } else { "" }
        )))
    }

    /// Whether no flag and no variable selects a robot, so that the default robot is used.
    pub fn selects_default(&self) -> bool {
        let Selection { sim, target, all, robots, tags, environment, .. } = &self.selection;
        let is_selected = *sim || *all || target.is_some() || environment.is_some();
        !is_selected && robots.is_empty() && tags.is_empty()
    }

    /// Whether the robots come from the inventory. A change of the inventory can then change the robots.
    pub fn follows_inventory(&self) -> bool {
        let Selection { sim, target, all, robots, tags, environment, .. } = &self.selection;
        let by_entry = *all || !robots.is_empty() || !tags.is_empty();
        !*sim && target.is_none() && (by_entry || environment.is_none())
    }

    /// Returns the selected robots that the changed inventory still contains. The list may be empty.
    pub fn remaining_robots(&self) -> Result<Vec<Robot>, Failure> {
        let Selection { robots, tags, all, .. } = &self.selection;
        let is_named = |entry: &Entry| match &robots[..] {
            _ if *all => true,
            [] => !tags.is_empty() || self.inventory.default.as_ref() == Some(&entry.name),
            patterns => patterns.iter().any(|pattern| inventory::matches_pattern(pattern, &entry.name)),
        };
        let is_chosen = |entry: &&Entry| is_named(entry) && tags.iter().all(|tag| entry.has_tag(tag));
        self.inventory.robots.iter().filter(is_chosen).map(|entry| self.resolve(entry, None)).collect()
    }

    /// Alarm explanations of the site that the inventory describes.
    pub fn alarms(&self) -> Alarms {
        Alarms::load_beside(self.inventory.path.as_deref())
    }

    /// Selects all robots of the inventory if no robot was selected. Without this call, the default robot is selected.
    pub fn default_to_all(&mut self) {
        self.selection.all |= self.selection.is_empty() && !self.inventory.robots.is_empty();
    }

    /// Selects robots by name.
    ///
    /// # Errors
    /// If a flag also selects robots.
    pub fn choose_all(&mut self, names: &[String]) -> Result<(), Failure> {
        if self.selection.has_flags() {
            return Err(Failure::usage(format!("{} and a flag each select robots", names.join(" and ")))
                .hint("remove one of the two"));
        }
        (self.selection.robots, self.selection.from_environment) = (names.to_vec(), false);
        Ok(())
    }

    /// Selects a robot by name or URL.
    pub fn choose(&mut self, robot: &str) -> Result<(), Failure> {
        if self.selection.has_flags() {
            return Err(
                Failure::usage(format!("'{robot}' and a flag each select a robot")).hint("remove one of the two")
            );
        }
        let Selection { target, robots, from_environment, .. } = &mut self.selection;
        if std::mem::take(from_environment) {
            robots.clear();
        }
        if robot.contains(':') || TargetArgument::is_bare(robot) {
            *target = Some(robot.parse()?);
        } else {
            robots.push(robot.to_owned());
        }
        Ok(())
    }

    /// Creates the robot of an inventory entry, with all settings.
    pub fn resolve(&self, entry: &Entry, family: Option<Family>) -> Result<Robot, Failure> {
        if let Some(family) = family
            && family != entry.family
        {
            return Err(Failure::usage(format!("robot '{}' is a {} robot, not {family}", entry.name, entry.family))
                .hint(format!("use `armctl {} …` for this robot", entry.family)));
        }
        let target = Setting { value: entry.target.clone(), origin: Origin::Robot };
        let robot = self.robot(entry.name.clone(), entry.family, target, &entry.options, entry.tags.clone());
        let names = RobotNames::new(Arc::clone(&entry.names), entry.family, &entry.target.address());
        let (pulses_per_degree, place) = (entry.pulses_per_degree.clone(), entry.place.clone());
        let rehearsal = self.rehearsal.as_ref().and_then(|robots| robots.get(&entry.name)).cloned();
        let is_default = self.inventory.default.as_ref() == Some(&entry.name);
        Ok(Robot { pulses_per_degree, place, is_default, names, rehearsal, ..robot })
    }

    /// Returns the robot at a target, with all settings.
    pub fn at(&self, target: &Target, family: Family) -> Result<Robot, Failure> {
        self.robot_at(&TargetArgument::Url(target.clone()), Origin::Flag, Some(family))
    }

    fn robot_at(&self, given: &TargetArgument, origin: Origin, family: Option<Family>) -> Result<Robot, Failure> {
        let target = given.resolve(family)?;
        // A simulator without a family is a simulator of the first family.
        let simulated = target.is_simulated().then_some(self.selection.simulated.unwrap_or(Family::Yerc));
        let Some(family) = family.or(target.family()).or_else(|| target.family_of_backup()).or(simulated) else {
            return Err(Failure::usage(format!("armctl cannot infer the family from target '{target}'"))
                .hint("name the family: `armctl yerc …`"));
        };
        target
            .check(family)
            .map_err(|why| Failure::usage(why).hint("for the URLs of each family, see `armctl help targets`"))?;
        let name = target.short_name();
        Ok(self.robot(name, family, Setting { value: target, origin }, &Options::default(), Vec::new()))
    }

    fn robots_by_name(&self, family: Option<Family>) -> Result<Vec<Robot>, Failure> {
        let selection = &self.selection;
        let known = || self.inventory.robots.iter().map(|robot| robot.name.as_str());
        let mut chosen: Vec<&Entry> = Vec::new();
        for pattern in &selection.robots {
            let before = chosen.len();
            for entry in self.inventory.matching(pattern) {
                if !chosen.iter().any(|other| other.name == entry.name) {
                    chosen.push(entry);
                }
            }
            if chosen.len() == before && self.inventory.matching(pattern).next().is_none() {
                let set = if selection.from_environment { "ARMCTL_ROBOT: " } else { "" };
                let place = if self.rehearsal.is_some() { "backup" } else { "inventory" };
                let failure = Failure::usage(format!("{set}there is no robot '{pattern}' in the {place}"));
                if pattern.contains("://") || pattern.starts_with("sim:") {
                    return Err(failure.hint("use -t (--target) for a URL"));
                }
                return Err(match (nearest(pattern, known()), &self.inventory.path) {
                    (Some(name), _) => failure.hint(format!("did you mean '{name}'?")),
                    (None, _) if self.rehearsal.is_some() => {
                        let names: Vec<&str> = known().collect();
                        failure.hint(format!("the backup has {}", names.join(", ")))
                    }
                    (None, Some(path)) => {
                        failure.hint(format!("`armctl robots list` lists the robots in {}", path.display()))
                    }
                    (None, None) => {
                        failure.hint("set the file with --config: armctl finds no home folder for robots.toml")
                    }
                });
            }
        }
        if selection.all || (selection.robots.is_empty() && !selection.tags.is_empty()) {
            chosen = self.inventory.robots.iter().collect();
        }
        for tag in &selection.tags {
            let known: Vec<String> = self.inventory.robots.iter().flat_map(Entry::all_tags).collect();
            if !known.contains(tag) {
                let failure = Failure::usage(format!("no robot in the inventory has the tag '{tag}'"));
                return Err(match nearest(tag, known.iter().map(String::as_str)) {
                    Some(near) => failure.hint(format!("did you mean '{near}'?")),
                    None => failure.hint("`armctl robots list` shows the robots with their tags"),
                });
            }
        }
        chosen.retain(|robot| selection.tags.iter().all(|tag| robot.has_tag(tag)));
        // A command of a family applies only to the robots of this family in a mixed selection. A robot of another
        // family that the user named explicitly causes an error below.
        if selection.is_plural()
            && let Some(family) = family
        {
            chosen.retain(|robot| robot.family == family || selection.robots.contains(&robot.name));
        }
        if chosen.is_empty() {
            return Err(Failure::usage("no robot in the inventory matches")
                .hint("`armctl robots list` shows the robots with their tags"));
        }
        chosen.into_iter().map(|entry| self.resolve(entry, family)).collect()
    }

    /// Returns the addresses of the read-only robots of a family, with their entries. A controller is read-only under
    /// every name that leads to it.
    pub fn read_only(&self, family: Family) -> impl Iterator<Item = (Address, &Entry)> {
        let file = self.inventory.defaults.read_only;
        let entries = self.inventory.robots.iter();
        let binding_entry =
            entries.filter(move |entry| entry.family == family && entry.options.read_only.or(file) == Some(true));
        binding_entry.map(|entry| (entry.target.address(), entry))
    }

    /// Makes a robot read-only if an entry with one of the robot's addresses is read-only.
    pub fn apply_read_only(&self, robot: &mut Robot) {
        if robot.read_only.value || robot.target.value.is_simulated() {
            return;
        }
        let bound = self.read_only(robot.family).find(|(address, _)| robot.has_address(address));
        if let Some((_, entry)) = bound {
            robot.read_only = Setting { value: true, origin: Origin::Robot };
            robot.read_only_entry = Some(entry.name.clone());
        }
    }

    /// Returns the names in the entry with this address. Names belong to the controller, whatever form the target has.
    fn names_at(&self, family: Family, address: &Address) -> Arc<[Name]> {
        let mut named = self.inventory.robots.iter().filter(|entry| entry.family == family && !entry.names.is_empty());
        let entry = named.find(|entry| entry.target.address().meets(address));
        entry.map(|entry| Arc::clone(&entry.names)).unwrap_or_default()
    }

    fn robot(&self, name: String, family: Family, target: Setting<Target>, own: &Options, tags: Vec<String>) -> Robot {
        let file = &self.inventory.defaults;
        let (flags, environment) = (&self.flags, &self.environment);
        let url_model = target.value.traits().model.map(|value| Setting { value, origin: Origin::Url });
        macro_rules! setting {
            ($field:ident, $built_in:expr) => {
                first(
                    [
                        (flags.$field, Origin::Flag),
                        (environment.$field, Origin::Environment),
                        (own.$field, Origin::Robot),
                        (file.$field, Origin::Defaults),
                    ],
                    $built_in,
                )
            };
        }
        let address = target.value.address();
        let mut robot = Robot {
            names: RobotNames::new(self.names_at(family, &address), family, &address),
            read_only: setting!(read_only, false),
            read_only_entry: None,
            aliases: Vec::new(),
            hold: setting!(hold, false),
            name,
            family,
            target,
            timeout: setting!(timeout, family.timeout()),
            retries: setting!(retries, RETRIES),
            encoding: setting!(encoding, Encoding::default()),
            model: url_model.unwrap_or_else(|| setting!(model, ModelSetting::Auto)),
            pulses_per_degree: Vec::new(),
            tags,
            place: Place::default(),
            is_default: false,
            sessions: self.selection.sessions,
            alarms: self.alarms(),
            // The path is absolute, so that it stays valid in any folder.
            inventory: self.inventory.path.as_deref().and_then(|path| std::path::absolute(path).ok()),
            rehearsal: None,
        };
        self.apply_read_only(&mut robot);
        robot
    }
}

/// Returns the first candidate that has a value.
fn first<T>(candidates: [(Option<T>, Origin); 4], built_in: T) -> Setting<T> {
    let found = candidates.into_iter().find_map(|(value, origin)| value.map(|value| Setting { value, origin }));
    found.unwrap_or(Setting { value: built_in, origin: Origin::BuiltIn })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sources(selection: Selection) -> Sources {
        let text = "default = \"a\"\n[defaults]\nretries = 1\n[[robot]]\nname = \"a\"\ntarget = \"udp://h\"\nretries = 2\n\
                    [[robot]]\nname = \"b\"\ntarget = \"udp://i\"\ntags = [\"x\"]\n\
                    [[robot]]\nname = \"s\"\ntarget = \"serial://COM3\"\n";
        Sources { selection, inventory: Inventory::parse(text, "robots.toml").unwrap(), ..Sources::default() }
    }

    fn names(selection: Selection) -> Vec<String> {
        sources(selection).robots(Some(Family::Yerc)).unwrap().into_iter().map(|robot| robot.name).collect()
    }

    #[test]
    fn nearest_source_wins() {
        let mut sources = sources(Selection::default());
        let retries = |sources: &Sources| sources.robots(None).unwrap()[0].retries;
        assert_eq!(retries(&sources), Setting { value: 2, origin: Origin::Robot });
        sources.environment.retries = Some(7);
        assert_eq!(retries(&sources), Setting { value: 7, origin: Origin::Environment });
        sources.flags.retries = Some(9);
        assert_eq!(retries(&sources), Setting { value: 9, origin: Origin::Flag });
    }

    #[test]
    fn selects_robots_by_name_glob_tag_and_all() {
        assert_eq!(names(Selection::default()), ["a"]);
        assert_eq!(names(Selection { robots: vec!["b".into(), "a".into()], ..Selection::default() }), ["b", "a"]);
        assert_eq!(names(Selection { robots: vec!["*".into()], ..Selection::default() }), ["a", "b"]);
        assert_eq!(names(Selection { tags: vec!["x".into()], ..Selection::default() }), ["b"]);
        assert_eq!(names(Selection { all: true, ..Selection::default() }), ["a", "b"]);
    }

    #[test]
    fn refuses_a_robot_of_another_family() {
        let selection = Selection { robots: vec!["s".into()], ..Selection::default() };
        let failure = sources(selection).robots(Some(Family::Yerc)).unwrap_err();
        assert!(failure.message.contains("toyo"), "{failure:?}");
    }

    #[test]
    fn read_only_applies_to_every_name_of_a_controller() {
        let text = "[[robot]]\nname = \"line3\"\ntarget = \"udp://127.0.0.1\"\nread_only = true\n\
                    [[robot]]\nname = \"alias\"\ntarget = \"udp://localhost:10040\"\n\
                    [[robot]]\nname = \"free\"\ntarget = \"udp://127.0.0.1:10050\"\n";
        let inventory = Inventory::parse(text, "robots.toml").unwrap();
        let robot = |selection| {
            let sources = Sources { selection, inventory: inventory.clone(), ..Sources::default() };
            let robot = sources.robots(Some(Family::Yerc)).unwrap().remove(0);
            (robot.read_only.value, robot.read_only_entry)
        };
        let bound = (true, Some("line3".to_owned()));
        for url in ["udp://127.0.0.1", "udp://localhost", "udp://127.0.0.1:10040?model=fs100"] {
            let target = || Some(url.parse().unwrap());
            assert_eq!(robot(Selection { target: target(), ..Selection::default() }), bound, "-t {url}");
            assert_eq!(
                robot(Selection { environment: target(), ..Selection::default() }),
                bound,
                "ARMCTL_TARGET {url}"
            );
        }
        let named = |name: &str| Selection { robots: vec![name.to_owned()], ..Selection::default() };
        assert_eq!(robot(named("line3")), (true, None));
        assert_eq!(robot(named("alias")), bound);
        assert_eq!(robot(named("free")), (false, None));
        assert_eq!(robot(Selection { sim: true, ..Selection::default() }), (false, None));
    }

    #[test]
    fn refuses_url_parameters_of_another_family() {
        let target = || Some("sim:?axes=2".parse().unwrap());
        for selection in [
            Selection { target: target(), ..Selection::default() },
            Selection { environment: target(), ..Selection::default() },
        ] {
            let sources = Sources { selection, ..Sources::default() };
            let failure = sources.robots(Some(Family::Yerc)).unwrap_err();
            assert_eq!(failure.message, "'axes' in a sim: URL is for toyo, not for yerc");
            assert_eq!(sources.robots(Some(Family::Toyo)).unwrap()[0].name, "sim");
        }
    }

    #[test]
    fn hints_at_sim_first_without_a_robot() {
        let failure = Sources::default().robots(Some(Family::Yerc)).unwrap_err();
        assert!(failure.hint.unwrap().starts_with("use --sim"));
    }
}

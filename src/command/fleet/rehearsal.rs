//! Report of `armctl rehearse`: what commands changed on the simulators of a backup.

use armctl_controller::simulator::run_options::Motion;
use armctl_controller::text::Encoding;
use armctl_frame::SchemaEntry;
use armctl_frame::backup::Only;
use armctl_frame::backup::compare::{BackupSide, CompareOptions, Difference, Differences, State};
use armctl_frame::backup::manifest;
use armctl_frame::backup::text_diff::{MAX_TEXT, unified};
use armctl_frame::prelude::*;
use armctl_frame::settings::rehearsal::Question;

/// Name in envelopes and schemas.
pub const ID: &str = "rehearse";

/// Schema of the report.
pub fn schema() -> SchemaEntry {
    SchemaEntry::of::<RehearsalReport>(ID)
}

/// Effect of commands on the simulators of a backup.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RehearsalReport {
    /// Folder of the backup.
    pub folder: String,
    /// Simulated time that passes in one second.
    pub time_factor: f64,
    /// Results of the commands, in their order.
    pub lines: Vec<LineResult>,
    /// Robots that were rehearsed.
    pub robots: Vec<RehearsedRobot>,
    /// Failure of the commands.
    #[serde(skip)]
    pub failure: Option<Failure>,
}

/// Result of a command on a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct LineResult {
    /// Line of the command, from 1.
    pub line: usize,
    /// Command as it was typed.
    pub typed: String,
    /// Robot; null for a command without a robot.
    pub robot: Option<String>,
    /// Whether the command succeeded.
    pub ok: bool,
    /// Reason why it failed, as in the envelope of the command.
    pub error: Option<Value>,
}

/// Effect of commands on a robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RehearsedRobot {
    /// Name.
    pub robot: String,
    /// Family.
    pub family: &'static str,
    /// Changed variables, points and other values of files with a known form.
    pub changes: Vec<ValueChange>,
    /// Changed files and parts, as in `armctl diff`.
    pub files: Vec<Difference>,
    /// Changed signals.
    pub signals: Vec<ValueChange>,
    /// Motions, in the order of their ends.
    pub motions: Vec<MotionResult>,
    /// Confirmations.
    pub questions: Vec<Question>,
    /// Whether a motion or a program still runs; null if the state could not be read.
    pub running: Option<bool>,
}

/// Old and new value. A value is null if it did not exist.
#[derive(Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ValueChange {
    /// File or part of the value; null for a signal, and for a value that a backup does not contain.
    pub file: Option<String>,
    /// Name: `B005`, `CN01`, the number of a point, or the name of a signal.
    pub name: String,
    /// Value before the commands.
    pub old: Option<String>,
    /// Value after the commands.
    pub new: Option<String>,
}

/// A motion.
#[derive(Debug, Serialize, JsonSchema)]
pub struct MotionResult {
    /// `R1` (yerc), `robot 1` (yrcx), `task 1` or `host` (toyo).
    group: String,
    /// Start position: pulses of the axes (yerc), or coordinates in mm and degrees.
    from: Vec<f64>,
    /// End position.
    to: Vec<f64>,
    /// `pulses` or `mm`.
    unit: &'static str,
    /// Length of the path of the tool, with the kinematics of the simulator; null for an external axis.
    distance_mm: Option<f64>,
    /// Simulated time of the start, since the start of the simulator.
    began_ms: u64,
    /// Simulated duration.
    elapsed_ms: u64,
    /// Whether the motion reached its target.
    reached: bool,
}

impl From<Motion> for MotionResult {
    fn from(Motion { group, from, to, unit, distance_mm, began, took, reached }: Motion) -> Self {
        // The sum with 0.0 turns -0.0 into 0.0.
        let rounded = |value: f64| (value * 1000.0).round() / 1000.0 + 0.0;
        let ms = |time: Duration| u64::try_from(time.as_millis()).unwrap_or(u64::MAX);
        Self {
            group,
            from: from.into_iter().map(rounded).collect(),
            to: to.into_iter().map(rounded).collect(),
            unit,
            distance_mm: distance_mm.map(rounded),
            began_ms: ms(began),
            elapsed_ms: ms(took),
            reached,
        }
    }
}

/// Data of a robot at one time.
pub struct Snapshot {
    /// Folder of the backup.
    pub folder: PathBuf,
    /// Values that a backup does not contain, by name.
    pub values: BTreeMap<String, String>,
    /// Signals by name.
    pub signals: BTreeMap<String, String>,
}

impl RehearsedRobot {
    /// Compares two snapshots of a robot.
    pub fn compare(robot: &str, family: Family, [old, new]: [&Snapshot; 2]) -> Result<Self> {
        let side = |folder: &Path| {
            Ok::<_, Failure>(BackupSide {
                manifest: manifest::open_existing(folder)?,
                folder: folder.to_owned(),
                is_controller: true,
            })
        };
        let [before, after] = [side(&old.folder)?, side(&new.folder)?];
        let files = Differences::of(&before, &after, &Only::default(), CompareOptions::usual_tolerance())?.changed();
        let read = |side: &BackupSide, name: &str| {
            let copy = side.manifest.entry(name).and_then(|entry| entry.copy.as_ref());
            let bytes = copy.and_then(|copy| files::read(&side.folder.join(&copy.file), MAX_TEXT as u64).ok());
            let named = side.manifest.controller["encoding"].as_str().and_then(|name| name.parse::<Encoding>().ok());
            let text = |bytes: Vec<u8>| {
                String::from_utf8(bytes).unwrap_or_else(|error| named.unwrap_or_default().decode(error.as_bytes()))
            };
            copy.zip(bytes).and_then(|(copy, bytes)| named_values(&copy.file, &text(bytes)))
        };
        let changed = |file: &Difference| match (read(&before, &file.name), read(&after, &file.name)) {
            (Some(old), Some(new)) => changes(Some(&file.name), &old, &new),
            _ => Vec::new(),
        };
        Ok(Self {
            robot: robot.to_owned(),
            family: family.name(),
            changes: files.iter().flat_map(changed).chain(changes(None, &old.values, &new.values)).collect(),
            files,
            signals: changes(None, &old.signals, &new.signals),
            motions: Vec::new(),
            questions: Vec::new(),
            running: None,
        })
    }
}

/// Values that differ, by name.
fn changes(file: Option<&str>, old: &BTreeMap<String, String>, new: &BTreeMap<String, String>) -> Vec<ValueChange> {
    let missing = new.keys().filter(|name| !old.contains_key(*name));
    let names = old.keys().chain(missing).filter(|name| old.get(*name) != new.get(*name));
    let change = |name: &String| ValueChange {
        file: file.map(ToOwned::to_owned),
        name: name.clone(),
        old: old.get(name).cloned(),
        new: new.get(name).cloned(),
    };
    names.map(change).collect()
}

/// Number of values in a row of `VAR.DAT`.
const ROW: usize = 10;

/// Values of a file by name, if the file is a table whose first column is a key, or the variables of a yerc controller.
fn named_values(file: &str, text: &str) -> Option<BTreeMap<String, String>> {
    let mut values = BTreeMap::new();
    if file == "VAR.DAT" {
        let (mut section, mut index) = ("", 0);
        for line in text.lines() {
            if let Some(name) = line.strip_prefix("////") {
                (section, index) = (name, 0);
                continue;
            }
            if let Some((number, position)) = line.split_once('=').filter(|_| section != "S") {
                values.insert(format!("{section}{number}"), position.to_owned());
                continue;
            }
            let cells: Vec<&str> = if section == "S" { vec![line] } else { line.split(',').collect() };
            debug_assert!(cells.len() <= ROW || section.is_empty());
            for cell in cells.into_iter().filter(|_| !section.is_empty()) {
                values.insert(format!("{section}{index:03}"), cell.to_owned());
                index += 1;
            }
        }
        return Some(values);
    }
    if Path::new(file).extension().is_none_or(|ending| ending != "csv") {
        return None;
    }
    for line in text.lines().skip(1) {
        let (key, rest) = line.split_once(',')?;
        // A key that is not unique identifies no row.
        if values.insert(key.to_owned(), rest.trim_end_matches(',').to_owned()).is_some() {
            return None;
        }
    }
    Some(values)
}

impl Report for RehearsalReport {
    fn view(&self) -> View {
        let mut view = View::table(self.line_table());
        for robot in &self.robots {
            let parts = robot.sections();
            let title = format!("{} ({})", robot.robot, robot.family);
            if parts.is_empty() {
                view = view.append(Section::Text(format!("{title}: nothing changed, no motion")));
                continue;
            }
            view = view.append(Section::Text(title));
            view = parts.into_iter().fold(view, View::append);
        }
        view
    }

    fn failure(&self) -> Option<Failure> {
        self.failure.clone()
    }
}

impl RehearsalReport {
    fn line_table(&self) -> Table {
        let mut table = Table::new(&["line", "robot", "command", "result"], "no command ran");
        for LineResult { line, typed, robot, ok, error } in &self.lines {
            let text = |key: &str| error.as_ref().and_then(|error| error.get(key)).and_then(Value::as_str);
            let result = match (ok, text("message")) {
                (false, Some(message)) => {
                    let code = text("code").map_or(String::new(), |code| format!(" [{code}]"));
                    Cell::from(format!("{}{code}: {message}", text("kind").unwrap_or("failed"))).tone(Tone::Bad)
                }
                (false, None) => Cell::from("failed").tone(Tone::Bad),
                (true, _) => Cell::from("done").tone(Tone::Good),
            };
            table.row([(*line).into(), Cell::optional(robot.as_deref()), typed.as_str().into(), result]);
        }
        table
    }
}

impl RehearsedRobot {
    fn sections(&self) -> Vec<Section> {
        let mut sections = Vec::new();
        let mut changed = Table::new(&["changed", "old", "new"], "");
        for ValueChange { file, name, old, new } in &self.changes {
            let name = file.as_ref().map_or_else(|| name.clone(), |file| format!("{file} {name}"));
            changed.row([name.into(), Cell::optional(old.as_deref()), Cell::optional(new.as_deref())]);
        }
        for ValueChange { name, old, new, .. } in &self.signals {
            let name = format!("signal {name}");
            changed.row([name.into(), Cell::optional(old.as_deref()), Cell::optional(new.as_deref())]);
        }
        let has_values = |file: &Difference| self.changes.iter().any(|value| value.file.as_ref() == Some(&file.name));
        let unnamed: Vec<&Difference> = self.files.iter().filter(|file| !has_values(file)).collect();
        for file in &unnamed {
            let states = match file.more.state {
                State::OnlyOld => ["present", "deleted"],
                State::OnlyNew => ["-", "new file"],
                State::Unknown => ["-", "not compared"],
                _ => ["-", "changed"],
            };
            changed.row([file.name.as_str().into(), states[0].into(), states[1].into()]);
        }
        if !changed.rows.is_empty() {
            sections.push(Section::Table(changed));
        }
        for file in unnamed {
            let Some(hunks) = file.more.changes() else { continue };
            sections.push(Section::Lines(unified(&format!("{} (before)", file.name), &file.name, hunks)));
        }
        let mut moved = Table::new(&["moved", "from", "to", "distance", "time", "result"], "");
        for motion in &self.motions {
            let position = |values: &[f64]| values.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
            let seconds = Duration::from_millis(motion.elapsed_ms).as_secs_f64();
            moved.row([
                motion.group.as_str().into(),
                format!("{} {}", position(&motion.from), motion.unit).into(),
                position(&motion.to).into(),
                Cell::optional(motion.distance_mm.map(|mm| format!("{mm:.1} mm"))),
                format!("{seconds:.2} s").into(),
                if motion.reached { "reached".into() } else { Cell::from("stopped early").tone(Tone::Warning) },
            ]);
        }
        if !moved.rows.is_empty() {
            sections.push(Section::Table(moved));
        }
        let mut confirmed = Table::new(&["needs a confirmation", "confirmed by"], "");
        for Question { text, confirmed_by_yes } in &self.questions {
            let by = if *confirmed_by_yes { "--yes" } else { "a question at the terminal" };
            confirmed.row([text.as_str().into(), by.into()]);
        }
        if !confirmed.rows.is_empty() {
            sections.push(Section::Table(confirmed));
        }
        if self.running == Some(true) {
            sections
                .push(Section::Text("still running at the end of the rehearsal; wait longer with --settle".to_owned()));
        }
        sections
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_the_values_of_known_files() {
        let variables = "//VAR\r\n///SHARE\r\n////B\r\n0,7\r\n3\r\n////P\r\n002=1,2\r\n////S\r\nA=1,2\r\n";
        let values = named_values("VAR.DAT", variables).unwrap();
        let pairs: Vec<String> = values.iter().map(|(name, value)| format!("{name} {value}")).collect();
        assert_eq!(pairs, ["B000 0", "B001 7", "B002 3", "P002 1,2", "S000 A=1,2"]);
        let points = |row: &str| named_values("points-00000.csv", &format!("point,unit,1\n{row}\n")).unwrap();
        let [change] = &changes(Some("points"), &points("5,mm,1.0,"), &points("5,mm,2.0,"))[..] else { panic!() };
        assert_eq!((change.old.as_deref(), change.new.as_deref()), (Some("mm,1.0"), Some("mm,2.0")));
        assert_eq!(named_values("t.csv", "a,b\n1,2\n1,3\n"), None, "two rows with a key");
        assert_eq!(named_values("A.JBI", "x"), None);
    }
}

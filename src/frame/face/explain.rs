//! `armctl explain FAMILY CODE`: meaning of a code, and its occurrences on selected robots.

use super::registration::Declaration;
use super::shared_commands::default_arguments;
use crate::confirmation::Confirmer;
use crate::prelude::basics::*;
use crate::robot::alarm::{Alarm, AlarmEntry, Alarms, ExtraColumns, Row};
use crate::run::{Run, RunError};
use crate::settings::alarms::{self, Explanation, Origin};
use crate::{Access, Command, ConnectMode, ConnectionEffect, Context};

/// A parsed code of a family.
pub trait Explain {
    /// Report type.
    type Report: Report + 'static;
    /// Name in envelopes and schemas, such as `explain.yerc`.
    const ID: &'static str;

    /// Meaning of the code without reading a robot; `alarms` has the site's texts.
    fn explain(&self, alarms: &alarms::Alarms, origin: Origin<'_>) -> Result<Self::Report>;

    /// The alarm in the notation of controllers; `None` if the code is not an alarm.
    fn alarm(&self) -> Option<String>;
}

/// Meanings of a code.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Codes<T> {
    /// One meaning, or several for a short code that is in two tables.
    pub codes: Vec<Known<T>>,
}

/// Meaning of a code.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Known<T> {
    /// Whether this exact code is known.
    known: bool,
    #[serde(flatten)]
    alarm: Alarm,
    /// Usual causes.
    causes: Vec<String>,
    /// Remedies.
    remedies: Vec<String>,
    /// Family-specific fields.
    #[serde(flatten)]
    own: T,
}

impl<T> Known<T> {
    /// Built-in meaning of a code, and the text of `alarms.toml`, which has priority.
    pub fn new(known: bool, alarm: Alarm, [causes, remedies]: [&[&str]; 2], site: Option<Explanation>, own: T) -> Self {
        let listed = |site: Option<&String>, own: &[&str]| -> Vec<String> {
            site.cloned().into_iter().chain(own.iter().map(ToString::to_string)).collect()
        };
        let of = |part: fn(&Explanation) -> Option<&String>| site.as_ref().and_then(part);
        let causes = listed(of(|site| site.cause.as_ref()), causes);
        let remedies = listed(of(|site| site.remedy.as_ref()), remedies);
        let lines = |lines: &[String]| Some(lines.join("; ")).filter(|line| !line.is_empty());
        let known = known || site.is_some();
        let alarm = Alarm { cause: lines(&causes), remedy: lines(&remedies), ..alarm.with(site) };
        Self { known, alarm, causes, remedies, own }
    }
}

impl<T: ExtraColumns + Serialize + JsonSchema> Report for Codes<T> {
    const ROWS: RowsOf = RowsOf::List("codes");

    fn view(&self) -> View {
        let section = |Known { alarm, own, .. }: &Known<T>| {
            let Alarm { code, text, cause, remedy, .. } = alarm;
            let own = own.cells().into_iter().filter_map(|(name, told)| Some((name, told?)));
            let told = [("code", code), ("meaning", text), ("cause", cause), ("what to do", remedy)];
            let told = told.into_iter().filter_map(|(name, told)| Some((name, told.clone()?)));
            Section::Fields(told.chain(own).map(|(name, told)| (name, told.into())).collect())
        };
        View { sections: self.codes.iter().map(section).collect() }
    }
}

/// Report of active or past alarms.
pub trait RecordedAlarm {
    /// Each alarm with its data; `what` is the name of the list.
    fn recorded(&self, what: &str) -> Vec<Occurrence>;
}

impl<T: ExtraColumns, S> RecordedAlarm for Alarms<T, S> {
    fn recorded(&self, what: &str) -> Vec<Occurrence> {
        let of = |(row, entry): (&Row<T>, &AlarmEntry<T>)| {
            let place = match (what, row.list) {
                (PRESENT, _) => what.to_owned(),
                (_, list) => format!("{} {index}", list.unwrap_or(what), index = row.index),
            };
            let data: Vec<String> = entry.own.cells().into_iter().filter_map(|(_, told)| told).collect();
            let data = Some(data.join(", ")).filter(|data| !data.is_empty());
            Occurrence { place, data, alarm: entry.alarm.clone() }
        };
        self.known_alarms().map(of).collect()
    }
}

/// Name of the list of active alarms.
const PRESENT: &str = "present";

/// An alarm that a controller has or had.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Occurrence {
    /// `present`, or list and index of a past alarm, for example `major 3`.
    pub place: String,
    /// Alarm.
    #[serde(flatten)]
    pub alarm: Alarm,
    /// Additional data: a sub-code, an axis, a task; null if there is none.
    pub data: Option<String>,
}

/// Meaning of a code, and its occurrences on controllers.
#[derive(Debug, Serialize, JsonSchema)]
pub struct CodeExplanation<R> {
    #[serde(flatten)]
    known: R,
    /// Selected robots; absent if none was selected.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    robots: Vec<RobotOccurrences>,
}

/// Occurrences of a code on a robot.
#[derive(Debug, Serialize, JsonSchema)]
struct RobotOccurrences {
    robot: String,
    /// Occurrences in the robot's alarm list and history, the latest first.
    alarms: Vec<Occurrence>,
    /// Lists that were not read, and the reason.
    errors: Vec<String>,
}

impl<R: Report> Report for CodeExplanation<R> {
    const ROWS: RowsOf = R::ROWS;

    fn view(&self) -> View {
        self.robots.iter().fold(self.known.view(), |view, told| told.sections().into_iter().fold(view, View::append))
    }
}

impl RobotOccurrences {
    fn sections(&self) -> Vec<Section> {
        let mut table = Table::new(&["where", "text", "data", "time"], "");
        for Occurrence { place, data, alarm: Alarm { text, time, .. } } in &self.alarms {
            let [text, data, time] = [text, data, time].map(|text| Cell::optional(text.as_deref()));
            table.row([place.as_str().into(), text, data, time]);
        }
        let found = if self.alarms.is_empty() && self.errors.is_empty() {
            format!("This alarm is not present on {}, and is not in its recent history.", self.robot)
        } else if self.alarms.is_empty() {
            String::new()
        } else {
            format!("{} has it:", self.robot)
        };
        let errors = self.errors.iter().map(|why| format!("{}: {why}", self.robot));
        let text = |text: String| (!text.is_empty()).then_some(Section::Text(text));
        let table = (!self.alarms.is_empty()).then_some(Section::Table(table));
        text(found).into_iter().chain(table).chain(errors.filter_map(text)).collect()
    }
}

/// Runs `explain FAMILY`.
pub(super) async fn explain<F: Declaration>(code: F::Explain, run: &Run) -> Result<(), RunError> {
    let (id, sources) = (<F::Explain as Explain>::ID, &run.sources);
    let robots = if sources.selection.has_flags() { sources.robots(Some(F::NAME))? } else { Vec::new() };
    let origin = if let [robot] = &robots[..] { Origin::of(robot) } else { Origin::any(F::NAME) };
    let known = code.explain(&sources.alarms(), origin)?;
    let mut told = Vec::with_capacity(robots.len());
    for robot in &robots {
        let (alarms, errors) = match code.alarm() {
            Some(alarm) => recall::<F>(run, robot, &alarm).await,
            None => (Vec::new(), vec!["not read: the code is not an alarm number".to_owned()]),
        };
        told.push(RobotOccurrences { robot: robot.name.clone(), alarms, errors });
    }
    run.local(id, &CodeExplanation { known, robots: told })
}

/// Occurrences of an alarm on a controller, active and past, and the lists that were not read.
async fn recall<F: Declaration>(run: &Run, robot: &Robot, alarm: &str) -> (Vec<Occurrence>, Vec<String>) {
    let mut link = match connect::<F>(run, robot).await {
        Ok(link) => link,
        Err(why) => return (Vec::new(), vec![why]),
    };
    let mut recall = Recall { alarm, found: Vec::new(), errors: Vec::new() };
    recall.codes_of::<F::Alarms>(run, robot, &mut link, PRESENT, "its alarms").await;
    if recall.errors.is_empty() {
        recall.codes_of::<F::AlarmHistory>(run, robot, &mut link, "history", "its history").await;
    }
    if let Err(failure) = F::close(link, &run.screen.silenced()).await {
        run.screen.detail(1, &failure.message);
    }
    (recall.found, recall.errors)
}

/// Connects, unless the connection would affect the robot.
async fn connect<F: Declaration>(run: &Run, robot: &Robot) -> Result<F::Link, String> {
    if matches!(F::connection_effect(robot, ConnectMode::Control), ConnectionEffect::Stops(_)) {
        return Err("not read: the read needs a command connection, and the end of that connection stops the robot. \
                    Use `armctl session open` to keep a connection open"
            .to_owned());
    }
    let access = Access::reading(ConnectMode::Control);
    let access = match &run.line {
        Some(line) => line.connect(robot, access, &run.screen).await.map_err(not_asked)?,
        None => access,
    };
    F::connect(robot, access, &run.screen.silenced()).await.map_err(not_asked)
}

#[expect(clippy::needless_pass_by_value, reason = "made for map_err")]
fn not_asked(failure: Failure) -> String {
    format!("not read: {}", failure.message)
}

/// Occurrences of an alarm in lists.
struct Recall<'a> {
    alarm: &'a str,
    found: Vec<Occurrence>,
    errors: Vec<String>,
}

impl Recall<'_> {
    /// Reads a list with its command.
    async fn codes_of<C: Command<Report: RecordedAlarm> + Args>(
        &mut self,
        run: &Run,
        robot: &Robot,
        link: &mut <C::Family as crate::Family>::Link,
        list: &str,
        what: &str,
    ) {
        let screen = run.screen.silenced();
        let confirmer = Confirmer::reading(&screen, robot);
        let context = Context { robot, link, screen: &screen, several: false, confirmer };
        match default_arguments::<C>().run(context).await {
            Ok(report) => {
                let is_it = |found: &Occurrence| found.alarm.code.as_deref().is_some_and(|code| same(code, self.alarm));
                self.found.extend(report.recorded(list).into_iter().filter(is_it));
            }
            Err(failure) => self.errors.push(format!("{what} could not be read: {}", failure.message)),
        }
    }
}

/// Whether two codes are equal apart from leading zeros.
fn same(one: &str, other: &str) -> bool {
    let bare = |code: &str| code.trim_start_matches('0').to_ascii_uppercase();
    bare(one) == bare(other)
}

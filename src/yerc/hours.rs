//! `yerc hours`: running-time counters.

use super::axes::{Groups, groups_of};
use super::item_requests::{Outcome, ask_existing};
use super::number_arguments::parse_in_range;
use crate::prelude::*;
use armctl_controller::yerc::payload::ManagementTime;
use armctl_controller::yerc::query::{QueryError, ReadManagementTime, TimeCounter};
use armctl_frame::items;
use armctl_frame::items::{ItemError, ItemOutcome};

/// Reads the running-time counters (FS and DX 3.3.25).
#[derive(Debug, Args)]
pub struct Hours {
    /// Servo, playback and motion time of this robot or station, or `all` for every existing counter
    #[arg(long, value_name = "R1|all")]
    group: Option<Groups>,
    /// Operation time of the application with this number
    #[arg(long, value_name = "N", conflicts_with = "group", value_parser = parse_in_range::<u8>(1, 8))]
    application: Option<u8>,
}

/// Counters for the whole controller.
const TOTALS: [TimeCounter; 4] =
    [TimeCounter::ControlPower, TimeCounter::Servo(None), TimeCounter::Playback(None), TimeCounter::Motion(None)];
/// Number of applications that can have a counter.
const APPLICATIONS: u8 = 8;

impl Hours {
    fn counters(&self, model: Model) -> Vec<TimeCounter> {
        let of = |group| {
            [TimeCounter::Servo(Some(group)), TimeCounter::Playback(Some(group)), TimeCounter::Motion(Some(group))]
        };
        match (self.application, self.group) {
            (Some(application), _) => vec![TimeCounter::Application(application)],
            (None, Some(Groups::One(group))) => of(group).into(),
            (None, None) => TOTALS.into(),
            (None, Some(Groups::All)) => {
                let counted = groups_of(model).filter(|group| !matches!(group, Group::Base(_)));
                let applications = (1..=APPLICATIONS).map(TimeCounter::Application);
                TOTALS.into_iter().chain(counted.flat_map(of)).chain(applications).collect()
            }
        }
    }
}

impl Command for Hours {
    type Family = Yerc;
    type Report = Times;
    const ID: &'static str = "yerc.hours";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Times> {
        let link = context.link;
        let make = |model| {
            self.counters(model).into_iter().map(|it| ReadManagementTime::new(model, it)).collect::<Result<Vec<_>, _>>()
        };
        let (model, encoding) = (link.model_for(make).await?, link.encoding);
        let question = |counter| Ok((counter, ReadManagementTime::new(model, counter)?));
        let counters = self.counters(model).into_iter();
        let questions: Vec<_> = counters.map(question).collect::<Result<_, QueryError>>().map_err(usage)?;
        let outcomes = if self.group == Some(Groups::All) {
            let mut found = ask_existing(link, questions).await?;
            // For a counter that does not exist, a controller may answer with empty values.
            let is_empty = |time: &ManagementTime| time.start.is_empty() && time.elapsed.is_empty();
            found.retain(|(_, outcome)| !outcome.as_ref().is_ok_and(is_empty));
            found
        } else {
            let (counters, queries): (Vec<_>, Vec<_>) = questions.into_iter().unzip();
            counters.into_iter().zip(link.ask_each(&queries).await?).collect()
        };
        let time = |(counter, outcome): (_, Outcome<ManagementTime>)| {
            Time::new(counter, outcome.map_err(read_failure), encoding)
        };
        let report = Times { times: outcomes.into_iter().map(time).collect() };
        items::all_failed(report.times.len(), report.errors())?;
        Ok(report)
    }
}

/// Running-time counters.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Times {
    times: Vec<Time>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Time {
    /// Name of the counter: `control_power`, `servo`, `servo_R1`, `application_1`.
    name: String,
    /// Counter: `control_power`, `servo`, `playback`, `motion` or `application`.
    counter: &'static str,
    /// Control group; null for counters without a group.
    group: Option<String>,
    /// Number of the application that the counter belongs to; null for other counters.
    application: Option<u8>,
    #[serde(flatten)]
    outcome: ItemOutcome<Elapsed>,
}

#[derive(Debug, Serialize, JsonSchema)]
struct Elapsed {
    /// When counting started, as the controller reports it: `YYYY/MM/DD HH:MM`.
    since: String,
    /// Elapsed time as received, such as `000123:45'06`.
    elapsed: String,
    /// Elapsed seconds; null if the text has an unknown format.
    elapsed_s: Option<u64>,
}

impl Time {
    fn new(counter: TimeCounter, time: Result<ManagementTime>, encoding: Encoding) -> Self {
        let (name, group, application) = match counter {
            TimeCounter::ControlPower => ("control_power", None, None),
            TimeCounter::Servo(group) => ("servo", group, None),
            TimeCounter::Playback(group) => ("playback", group, None),
            TimeCounter::Motion(group) => ("motion", group, None),
            TimeCounter::Application(number) => ("application", None, Some(number)),
        };
        let group: Option<String> = group.map(|group: Group| group.to_string());
        let owner = group.clone().or_else(|| application.map(|number| number.to_string()));
        let item = owner.map_or_else(|| name.to_owned(), |owner| format!("{name}_{owner}"));
        let elapsed = time.map(|time| Elapsed {
            since: encoding.decode(time.start.as_bytes()),
            elapsed: encoding.decode(time.elapsed.as_bytes()),
            elapsed_s: time.seconds(),
        });
        let asked = format!("{} time of {}", name.replace('_', " "), of(name, group.as_deref(), application));
        Self { name: item, counter: name, group, application, outcome: ItemOutcome::new(asked, elapsed) }
    }
}

/// Name of the counter, with its group or application.
fn of(counter: &str, group: Option<&str>, application: Option<u8>) -> String {
    match (group, application) {
        (Some(group), _) => group.to_owned(),
        (None, Some(number)) => format!("application {number}"),
        (None, None) => if counter == "control_power" { "the controller" } else { "all" }.to_owned(),
    }
}

impl Times {
    fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.times.iter().filter_map(|time| time.outcome.error())
    }
}

impl Report for Times {
    fn view(&self) -> View {
        let mut table = Table::new(&["counter", "of", "since", "elapsed (h:m:s)"], "no counter");
        for time in &self.times {
            let of = match (&time.group, time.application) {
                (Some(group), _) => Cell::from(group.as_str()),
                (None, Some(number)) => number.to_string().into(),
                (None, None) => if time.counter == "control_power" { "controller" } else { "all" }.into(),
            };
            let since = time.outcome.data().map(|time| time.since.as_str());
            let elapsed = match (time.outcome.data(), time.outcome.error()) {
                (Some(Elapsed { elapsed_s: Some(s), .. }), _) => {
                    Cell::number(format!("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60))
                }
                (Some(time), _) => time.elapsed.as_str().into(),
                (None, error) => error.map_or_else(|| "-".into(), ItemError::cell),
            };
            table.row([time.counter.replace('_', " ").into(), of, Cell::optional(since), elapsed]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.times.len(), self.errors())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{error_text, frames, frames_on, golden};
    use armctl_controller::yerc::payload::Text;
    use armctl_frame::output::render;

    #[test]
    fn selects_counters_by_kind() {
        let instances = |words: &str| -> Vec<String> {
            frames(words).unwrap().into_iter().map(|frame| frame[4..8].to_owned()).collect()
        };
        assert_eq!(instances("hours"), ["0100", "0a00", "6e00", "d200"]);
        assert_eq!(instances("hours --group R1"), ["0b00", "6f00", "d300"]);
        assert_eq!(frames("hours --application 1").unwrap(), [golden("R53")]);
        assert_eq!(frames("hours --group all").unwrap().len(), 4 + 3 * (8 + 24) + 8);
        assert_eq!(frames_on("udp://h?model=fs100", "hours --group all").unwrap().len(), 4 + 3 * (2 + 3) + 8);
        assert_eq!(frames("hours --group B1").unwrap_err().kind, Kind::Usage);
        assert!(error_text("hours --application 9").contains("1..=8"));
    }

    #[test]
    fn formats_times_in_every_form() {
        let time =
            |elapsed: &[u8]| ManagementTime { start: Text::cut(b"2024/01/02 03:04"), elapsed: Text::cut(elapsed) };
        let times = Times {
            times: vec![
                Time::new(TimeCounter::ControlPower, Ok(time(b"000123:45'06")), Encoding::ShiftJis),
                Time::new(TimeCounter::Servo(Some(Group::R1)), Ok(time(b"18:19'02")), Encoding::ShiftJis),
                Time::new(TimeCounter::Application(2), Ok(time(b"?")), Encoding::ShiftJis),
            ],
        };
        assert_eq!(
            render::csv(&times.view()),
            "counter,of,since,elapsed_h_m_s\ncontrol power,controller,2024/01/02 03:04,123:45:06\n\
             servo,R1,2024/01/02 03:04,18:19:02\napplication,2,2024/01/02 03:04,?\n"
        );
        let json = serde_json::to_value(&times).unwrap();
        assert_eq!(json["times"][0]["elapsed_s"], 445_506);
        let names = [0, 1, 2].map(|at| json["times"][at]["name"].as_str().unwrap());
        assert_eq!(names, ["control_power", "servo_R1", "application_2"]);
        assert_eq!(json["times"][2]["elapsed_s"], Value::Null);
    }
}

//! Commands `toyo alarm list|history|watch|reset|point`.

use super::explain::alarm_from_code;
use super::wait::{status_page, wait_for_status};
use crate::prelude::*;
use armctl_controller::toyo::errors;
use armctl_frame::face::shared_commands::CommonReport;
use armctl_frame::robot::alarm::{Alarm as Told, AlarmEntry, Alarms, ExtraColumns, Nothing, Row, Source};
use armctl_frame::settings::alarms;

commands! {
    /// Commands for alarms.
    pub enum Alarm {
        /// Show the present alarm with cause and remedy
        #[command(alias = "show")]
        List(List),
        /// Show the alarm history, the latest first
        History(History),
        /// Print alarms when they occur and when they clear
        Watch(Watch<List>),
        /// Reset the alarm
        #[command(alias = "cancel")]
        Reset(Reset),
        /// Show the point of the alarm
        Point(Point),
    }
}

/// Show the present alarm (TO 2-2, 4-1).
#[derive(Debug, Args)]
pub struct List {}

impl Command for List {
    type Family = Toyo;
    type Report = Alarms<Axis>;
    const ID: &'static str = "toyo.alarm.list";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Alarms<Axis>> {
        let link = context.link;
        if link.is_dry_run() {
            link.plan(&status_page(0), "whether there is an error");
            link.plan(&status_page(1), "which");
            return Err(unknown());
        }
        let row =
            read_error_code(link).await?.map(|code| Row::new(1, "alarm", with_site_texts(entry(code), context.robot)));
        Ok(Alarms { alarms: row.into_iter().collect(), standing: Nothing {}, asked: 1 })
    }
}

impl Watchable for List {
    type Value = bool;

    const WATCH: &'static str = "toyo.alarm.watch";
    const WATCHED: Watched =
        Watched { list: "alarms", name: "code", prefix: "alarm ", label: "text", value: None, empty: "no alarm" };
}

/// Returns the code of the present error; `None` if there is no error. If the controller reports an error without a
/// code, the code is 00.
async fn read_error_code(link: &mut Link) -> Result<Option<u8>> {
    let status = link.status_of(&[0, 1]).await?;
    Ok((status.has_error() || status.error != errors::NONE).then_some(status.error))
}

/// Reads the present alarms as a list.
pub(super) async fn present_alarms(link: &mut Link) -> Result<Vec<Told>> {
    Ok(read_error_code(link).await?.map(alarm_from_code).into_iter().collect())
}

/// Fields that toyo adds to an alarm.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Axis {
    /// Axis that the alarm concerns; null if it concerns no axis.
    #[serde(rename = "axis_number")]
    axis: Option<u8>,
    /// Whether this entry of the history is a power-off, which has no alarm and no time.
    power_off: bool,
    /// In the history: the alarm field as received; normally 00.
    alarm: Option<String>,
}

impl ExtraColumns for Axis {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        // The text already contains the cause.
        Vec::new()
    }
}

/// Builds the entry for an alarm code, with its causes.
fn entry(code: u8) -> AlarmEntry<Axis> {
    let errors::Explanation { axis, .. } = errors::explain(code);
    AlarmEntry { alarm: alarm_from_code(code), own: Axis { axis, power_off: false, alarm: None } }
}

/// Adds the user's texts from `alarms.toml` to the entry.
fn with_site_texts(entry: AlarmEntry<Axis>, robot: &Robot) -> Result<AlarmEntry<Axis>> {
    let code = entry.alarm.code.clone().unwrap_or_default();
    Ok(AlarmEntry { alarm: entry.alarm.with(alarms::find(robot, &code)?), ..entry })
}

/// Show the alarm history (TO 2-8, EHTR; KCA-20 and KCA-25).
#[derive(Debug, Args)]
pub struct History {
    /// Maximum number of entries
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u8).range(1..=99))]
    limit: u8,
}

impl Command for History {
    type Family = Toyo;
    type Report = Alarms<Axis>;
    const ID: &'static str = "toyo.alarm.history";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Alarms<Axis>> {
        let link = context.link;
        let entry_request = |number: u8| Request::of(table::Command::Ehtr, [Value::Number(number.into())]);
        if link.is_dry_run() {
            for number in 1..=self.limit {
                match number {
                    1 => link.plan(&entry_request(number), "the latest"),
                    _ => link.plan_if(&entry_request(number), "whether there is an earlier entry"),
                }
            }
            return Err(unknown());
        }
        let progress = context.screen.spinner("error history");
        let mut alarms = Vec::new();
        for number in 1..=self.limit {
            progress.print_line(&format!("error history {number} of {} at most", self.limit));
            let record = match link.try_ask(&entry_request(number)).await? {
                Ok(record) => record,
                // A controller without a history refuses the first entry. A controller with a short history refuses an
                // entry beyond its end.
                Err(_) if number > 1 => break,
                Err(_) => link.ask(&entry_request(number)).await?,
            };
            let Some(entry) = history_entry(&record) else { break };
            alarms.push(Row::new(number.into(), format!("alarm {number}"), with_site_texts(entry, context.robot)));
        }
        Ok(Alarms { asked: alarms.len(), alarms, standing: Nothing {} })
    }
}

/// Entry of the history; `None` if the entry is empty.
fn history_entry(record: &Record) -> Option<AlarmEntry<Axis>> {
    if record.byte("error") == Some(errors::NONE) {
        return None;
    }
    let time = || {
        let [hours, minutes, seconds] = ["hours", "minutes", "seconds"].map(|part| record.number(part));
        Some(format!("{}:{:02}:{:02}", hours?, minutes?, seconds?))
    };
    let alarm = record.byte("alarm").map(|alarm| format!("{alarm:02X}"));
    Some(match record.byte("error").map(entry) {
        Some(error) => AlarmEntry { alarm: Told { time: time(), ..error.alarm }, own: Axis { alarm, ..error.own } },
        None => AlarmEntry {
            alarm: Told { text: Some("power was switched off".to_owned()), source: Source::Armctl, ..Told::default() },
            own: Axis { axis: None, power_off: true, alarm },
        },
    })
}

/// Reset the alarm, and check that no alarm is present any more (TO 2-7).
#[derive(Debug, Args)]
pub struct Reset {}

impl Command for Reset {
    type Family = Toyo;
    type Report = ResetReport;
    const ID: &'static str = "toyo.alarm.reset";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<ResetReport> {
        let link = context.link;
        let code = |status: &Status| (status.error != errors::NONE).then(|| format!("{:02X}", status.error));
        let old = Old::read(link.status_before(1).await?.as_ref().and_then(code));
        link.ask(&Request::bare(table::Command::Cerr)).await?;
        let has_ended = wait_for_status(link, (0, "whether the alarm has ended"), |status| !status.has_error()).await?;
        let remaining = if has_ended { None } else { read_error_code(link).await?.map(alarm_from_code) };
        let words = remaining
            .as_ref()
            .map_or_else(|| "the alarm has ended".to_owned(), |remaining| format!("still there: {}", remaining.line()));
        let new = NewValue::of("fault_code", remaining.as_ref().and_then(|remaining| remaining.code.clone()), words);
        Ok(ResetReport { done: new.replaces(old), alarms: remaining.into_iter().collect() })
    }
}

/// Report of an alarm reset.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ResetReport {
    #[serde(flatten)]
    done: SetReport,
    /// Alarms that are still present.
    alarms: Vec<Told>,
}

impl CommonReport for ResetReport {
    type Core = SetReport;

    fn core(&self) -> SetReport {
        self.done.clone()
    }
}

impl Report for ResetReport {
    fn view(&self) -> View {
        self.done.view()
    }

    fn failure(&self) -> Option<Failure> {
        let remaining = self.alarms.first()?;
        let message = format!("the controller accepted the reset, but error {} is still present", remaining.line());
        let failure = Failure::new(Kind::ConditionNotMet, message);
        Some(
            failure.hint(remaining.remedy.clone().unwrap_or_default()).code(remaining.code.clone().unwrap_or_default()),
        )
    }
}

/// Show the point at which the alarm occurred (TO 2-8, MERP). The manual does not define the form of the answer.
#[derive(Debug, Args)]
pub struct Point {}

impl Command for Point {
    type Family = Toyo;
    type Report = PointReport;
    const ID: &'static str = "toyo.alarm.point";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<PointReport> {
        let record = context.link.ask(&Request::bare(table::Command::Merp)).await?;
        let point = record.text("point").map(str::trim).filter(|point| !point.is_empty());
        Ok(PointReport { point: point.map(ToOwned::to_owned) })
    }
}

/// Report of the point at which the alarm occurred.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PointReport {
    /// Text from the controller; null if it sent none.
    point: Option<String>,
}

impl Report for PointReport {
    fn view(&self) -> View {
        View::text(self.point.as_deref().map_or("no point", |point| point).to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Bench, Fault};

    #[test]
    fn alarm_list_shows_an_error_and_alarm_reset_cancels_it() {
        let (mut bench, _) = Bench::with_faults("error = \"28\"\n", |_, _| Fault::None);
        let data = bench.data(&["error", "show"]);
        let error = &data["alarms"][0];
        assert_eq!((&error["code"], &error["axis_number"]), (&"28".into(), &1.into()));
        assert!(error["remedy"].as_str().unwrap().contains("toyo param get"));
        assert_eq!(bench.data(&["alarm", "reset"])["alarms"], serde_json::json!([]));
        assert_eq!(bench.data(&["alarm", "list"]), serde_json::json!({ "alarms": [] }));
        assert_eq!(bench.data(&["alarm", "point"])["point"], serde_json::Value::Null);
    }

    #[test]
    fn alarm_reset_fails_if_the_error_stays() {
        let stays = |block: &str, _| if block == "@CERR" { Fault::Answered("@OK") } else { Fault::None };
        let (data, failure) = Bench::with_faults("error = \"24\"\n", stays).0.run(&["alarm", "reset"]).unwrap();
        assert_eq!(data["alarms"][0]["code"], "24");
        let failure = failure.unwrap();
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("24")));
    }

    #[test]
    fn the_history_ends_at_its_first_empty_entry() {
        let state = "history = [{ code = \"13\", after_seconds = 3723 }, { power_cut = true }, { code = \"A1\" }]\n";
        let (mut bench, received) = Bench::with_faults(state, |_, _| Fault::None);
        let data = bench.data(&["alarm", "history"]);
        let entries = data["alarms"].as_array().unwrap();
        assert_eq!(entries.len(), 3, "{data}");
        assert_eq!(
            (&entries[0]["code"], &entries[0]["time"], &entries[0]["index"]),
            (&"13".into(), &"1:02:03".into(), &1.into())
        );
        assert_eq!((&entries[1]["power_off"], &entries[1]["code"]), (&true.into(), &serde_json::Value::Null));
        assert_eq!(received.borrow().iter().filter(|block| block.starts_with("@EHTR")).count(), 4);
        assert_eq!(bench.data(&["alarm", "history", "--limit", "1"])["alarms"].as_array().unwrap().len(), 1);
    }

    #[test]
    fn a_controller_without_history_has_a_clear_error() {
        let failure =
            Bench::with_faults("model = \"other\"\n", |_, _| Fault::None).0.run(&["alarm", "history"]).unwrap_err();
        assert_eq!(failure.kind, Kind::Refused);
        assert!(failure.hint.unwrap().contains("KCA-25"));
    }
}

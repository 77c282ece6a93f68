//! `toyo alarm list|history|cancel|point`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::link::Link;
use super::link::Toyo;
use super::status::ErrorCode;
use super::waiting::{becomes, status_page};
use crate::command::face::explain::{Occurrence, Recorded};
use crate::command::frame::dry_run::unknown;
use crate::command::frame::orders::{Done, New, Old};
use crate::command::frame::watch::{Watch, Watchable, Watched};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::toyo::errors;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table;
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Section, Table, Tone, View};
use crate::settings::alarms::{self, Explanation};

commands! {
    /// Alarms.
    pub enum Alarm {
        /// Show the present alarm with cause and remedy
        #[command(alias = "show")]
        List(List),
        /// Alarm history, the latest first
        History(History),
        /// Print alarms as they come and go
        Watch(Watch<List>),
        /// Reset the alarm
        #[command(alias = "cancel")]
        Reset(Reset),
        /// The point at which the alarm occurred
        Point(Point),
    }
}

/// The error that is present (TO 2-2, 4-1).
#[derive(Debug, Args)]
pub struct List {}

impl Command for List {
    type Family = Toyo;
    type Report = Present;
    const ID: &'static str = "toyo.alarm.list";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Present, Failure> {
        let link = context.link;
        if link.is_dry() {
            link.plan(&status_page(0), "whether there is an error");
            link.plan(&status_page(1), "which");
            return Err(unknown());
        }
        let mut error = present(link).await?.map(Explained::of);
        if let Some(error) = &mut error {
            error.explained = alarms::find(context.robot, &error.code.code)?;
        }
        Ok(Present { alarms: error.iter().cloned().collect(), error })
    }
}

impl Watchable for List {
    const WATCH: &'static str = "toyo.alarm.watch";
    const WATCHED: Watched =
        Watched { list: "alarms", name: "code", prefix: "alarm ", label: "meaning", value: None, empty: "no alarm" };
}

/// The code of the error that is present. One that has none is code 00.
async fn present(link: &mut Link) -> Result<Option<u8>, Failure> {
    let status = link.status_of(&[0, 1]).await?;
    Ok((status.has_error() || status.error != errors::NONE).then_some(status.error))
}

/// The error that is present.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Present {
    /// One at most.
    alarms: Vec<Explained>,
    /// The same one, as scripts know it that say `error show`; null if there is none.
    error: Option<Explained>,
}

/// An error with what may be behind it.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct Explained {
    #[serde(flatten)]
    code: ErrorCode,
    /// What may have happened.
    cause: &'static str,
    /// What to do.
    remedy: &'static str,
    /// What `alarms.toml` says of it; null where it says nothing, and where it was not asked.
    explained: Option<Explanation>,
}

impl Explained {
    fn of(code: u8) -> Self {
        let explanation = errors::explain(code);
        Self { code: ErrorCode::of(code), cause: explanation.cause, remedy: explanation.remedy, explained: None }
    }
}

impl Report for Present {
    fn view(&self) -> View {
        let Some(Explained { code: ErrorCode { code, meaning, .. }, cause, remedy, explained }) = self.alarms.first()
        else {
            return View::text("no alarm");
        };
        let mut fields = vec![
            ("alarm", Cell::from(format!("{code}: {meaning}")).tone(Tone::Bad)),
            ("cause", (*cause).into()),
            ("remedy", (*remedy).into()),
        ];
        fields.extend(Explanation::field(explained.as_ref()));
        View::default().and(Section::Fields(fields))
    }
}

/// The errors of the past (TO 2-8, EHTR; KCA-20 and KCA-25).
#[derive(Debug, Args)]
pub struct History {
    /// At most N entries
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(i32).range(1..=99))]
    limit: i32,
}

impl Command for History {
    type Family = Toyo;
    type Report = Past;
    const ID: &'static str = "toyo.alarm.history";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Past, Failure> {
        let link = context.link;
        let question = |number| Request::of(table::Command::Ehtr, [Value::Number(number)]);
        if link.is_dry() {
            for number in 1..=self.limit {
                match number {
                    1 => link.plan(&question(number), "the latest"),
                    _ => link.plan_if(&question(number), "whether there is one before"),
                }
            }
            return Err(unknown());
        }
        let progress = context.screen.spinner("error history");
        let mut entries = Vec::new();
        for number in 1..=self.limit {
            progress.say(&format!("error history {number} of {} at most", self.limit));
            let record = match link.try_ask(&question(number)).await? {
                Ok(record) => record,
                // A controller without history refuses the first entry; one with a short history, one beyond its end.
                Err(_) if number > 1 => break,
                Err(_) => link.ask(&question(number)).await?,
            };
            match Entry::of(number, &record) {
                Some(entry) => entries.push(entry),
                None => break,
            }
        }
        Ok(Past { entries })
    }
}

/// The errors of the past, the latest first.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Past {
    entries: Vec<Entry>,
}

/// An entry of the history.
#[derive(Debug, Serialize, JsonSchema)]
struct Entry {
    /// 1 is the latest.
    number: i32,
    /// Power went off here: there is no error and no time.
    power_off: bool,
    /// Null where power went off.
    error: Option<ErrorCode>,
    /// As it came; normally 00.
    alarm: Option<String>,
    /// The controller's own time of the error.
    hours: Option<i32>,
    minutes: Option<i32>,
    seconds: Option<i32>,
}

impl Entry {
    /// An entry as it came; `None` if it is empty.
    fn of(number: i32, record: &Record) -> Option<Self> {
        if record.byte("error") == Some(errors::NONE) {
            return None;
        }
        let error = record.byte("error").map(ErrorCode::of);
        Some(Self {
            number,
            power_off: error.is_none(),
            error,
            alarm: record.byte("alarm").map(|alarm| format!("{alarm:02X}")),
            hours: record.number("hours"),
            minutes: record.number("minutes"),
            seconds: record.number("seconds"),
        })
    }

    fn time(&self) -> Option<String> {
        Some(format!("{}:{:02}:{:02}", self.hours?, self.minutes?, self.seconds?))
    }
}

impl Report for Past {
    fn view(&self) -> View {
        let mut table = Table::new(&["#", "code", "error", "time (h:m:s)"], "no error in the history");
        for entry in &self.entries {
            let (code, meaning) = match &entry.error {
                Some(error) => (Cell::from(error.code.as_str()).tone(Tone::Bad), error.meaning.as_str().into()),
                None => ("-".into(), "power was switched off".into()),
            };
            table.row([entry.number.into(), code, meaning, Cell::maybe(entry.time()).whole()]);
        }
        View::table(table)
    }
}

impl Recorded for Present {
    fn recorded(&self) -> Vec<Occurrence> {
        let of = |error: &Explained| Occurrence {
            place: "present".to_owned(),
            code: error.code.code.clone(),
            data: error.code.axis.map(|axis| format!("axis {axis}")),
            ..Occurrence::default()
        };
        self.alarms.iter().map(of).collect()
    }
}

impl Recorded for Past {
    fn recorded(&self) -> Vec<Occurrence> {
        let of = |entry: &Entry| {
            let error = entry.error.as_ref()?;
            Some(Occurrence {
                place: format!("history {}", entry.number),
                code: error.code.clone(),
                text: None,
                data: error.axis.map(|axis| format!("axis {axis}")),
                time: entry.time(),
            })
        };
        self.entries.iter().filter_map(of).collect()
    }
}

/// Cancels the error, and looks whether it is gone (TO 2-7).
#[derive(Debug, Args)]
pub struct Reset {}

impl Command for Reset {
    type Family = Toyo;
    type Report = Cancelled;
    const ID: &'static str = "toyo.alarm.reset";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Cancelled, Failure> {
        let link = context.link;
        let code = |status: &Status| (status.error != errors::NONE).then(|| format!("{:02X}", status.error));
        let old = Old::read(link.status_before(1).await?.as_ref().and_then(code));
        link.ask(&Request::bare(table::Command::Cerr)).await?;
        let is_gone = becomes(link, (0, "whether it is gone"), |status| !status.has_error()).await?;
        let left = if is_gone { None } else { present(link).await?.map(Explained::of) };
        let words = match &left {
            None => "no error any more".to_owned(),
            Some(Explained { code, .. }) => format!("still there: {}: {}", code.code, code.meaning),
        };
        let new = New::of("fault_code", left.as_ref().map(|error| error.code.code.clone()), words);
        Ok(Cancelled { done: new.replaces(old), left })
    }
}

/// What is left after an error was cancelled.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Cancelled {
    #[serde(flatten)]
    done: Done,
    /// An error that is still present; null if there is none.
    #[serde(rename = "error")]
    left: Option<Explained>,
}

impl Report for Cancelled {
    fn view(&self) -> View {
        self.done.view()
    }

    fn failure(&self) -> Option<Failure> {
        let Explained { code, remedy, .. } = self.left.as_ref()?;
        let message = format!("the controller accepted it, but error {}: {} is present", code.code, code.meaning);
        Some(Failure::new(Kind::ConditionNotMet, message).hint(*remedy).code(code.code.clone()))
    }
}

/// The point at which the error came up (TO 2-8, MERP). The manual does not tell the form of the answer.
#[derive(Debug, Args)]
pub struct Point {}

impl Command for Point {
    type Family = Toyo;
    type Report = PointReport;
    const ID: &'static str = "toyo.alarm.point";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<PointReport, Failure> {
        let record = context.link.ask(&Request::bare(table::Command::Merp)).await?;
        let point = record.text("point").map(str::trim).filter(|point| !point.is_empty());
        Ok(PointReport { point: point.map(ToOwned::to_owned) })
    }
}

/// The point at which the error came up.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PointReport {
    /// As the controller writes it; null if there is none.
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
    use crate::command::toyo::testing::{Bench, Fault, blocks, objection};

    #[test]
    fn what_is_asked() {
        assert_eq!(blocks(&["alarm", "list"]).unwrap(), ["@STAS SNO=0", "@STAS SNO=1"]);
        assert_eq!(blocks(&["alarm", "reset"]).unwrap(), ["@CERR", "@STAS SNO=0"]);
        assert_eq!(blocks(&["alarm", "point"]).unwrap(), ["@MERP"]);
        assert_eq!(blocks(&["alarm", "history", "--limit", "2"]).unwrap(), ["@EHTR NO=01", "@EHTR NO=02"]);
        assert_eq!(blocks(&["alarm", "history"]).unwrap().len(), 20);
        assert!(objection(&["alarm", "history", "--limit", "100"]).contains("1..=99"));
    }

    #[test]
    fn an_error_is_shown_and_cancelled() {
        let (mut bench, _) = Bench::with_faults("error = \"28\"\n", |_, _| Fault::None);
        let data = bench.data(&["error", "show"]);
        let error = &data["error"];
        assert_eq!(data["alarms"], serde_json::json!([error]));
        assert_eq!((&error["code"], &error["axis"]), (&"28".into(), &1.into()));
        assert!(error["remedy"].as_str().unwrap().contains("toyo param get"));
        assert_eq!(bench.data(&["alarm", "reset"])["error"], serde_json::Value::Null);
        assert_eq!(bench.data(&["alarm", "list"]), serde_json::json!({ "alarms": [], "error": null }));
        assert_eq!(bench.data(&["alarm", "point"])["point"], serde_json::Value::Null);
    }

    #[test]
    fn an_error_that_stays_is_a_failure() {
        let stays = |block: &str, _| if block == "@CERR" { Fault::Answered("@OK") } else { Fault::None };
        let (data, failure) = Bench::with_faults("error = \"24\"\n", stays).0.run(&["alarm", "reset"]).unwrap();
        assert_eq!(data["error"]["code"], "24");
        let failure = failure.unwrap();
        assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("24")));
    }

    #[test]
    fn the_history_ends_where_it_is_empty() {
        let state = "history = [{ code = \"13\", after_seconds = 3723 }, { power_cut = true }, { code = \"A1\" }]\n";
        let (mut bench, heard) = Bench::with_faults(state, |_, _| Fault::None);
        let data = bench.data(&["alarm", "history"]);
        let entries = data["entries"].as_array().unwrap();
        assert_eq!(entries.len(), 3, "{data}");
        assert_eq!(
            (&entries[0]["error"]["code"], &entries[0]["hours"], &entries[0]["minutes"]),
            (&"13".into(), &1.into(), &2.into())
        );
        assert_eq!((&entries[1]["power_off"], &entries[1]["error"]), (&true.into(), &serde_json::Value::Null));
        assert_eq!(heard.borrow().iter().filter(|block| block.starts_with("@EHTR")).count(), 4);
        assert_eq!(bench.data(&["alarm", "history", "--limit", "1"])["entries"].as_array().unwrap().len(), 1);
    }

    #[test]
    fn a_controller_without_history_says_so() {
        let failure =
            Bench::with_faults("model = \"other\"\n", |_, _| Fault::None).0.run(&["alarm", "history"]).unwrap_err();
        assert_eq!(failure.kind, Kind::Refused);
        assert!(failure.hint.unwrap().contains("KCA-25"));
    }
}

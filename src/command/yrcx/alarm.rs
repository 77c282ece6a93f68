//! `yrcx alarm list|history|reset` (4.7.7, 4.8.3).

use clap::Args;

use schemars::JsonSchema;
use serde::Serialize;

use super::info::AlarmReport;
use super::info::message::{Message, Past, rows};
use super::link::Yrcx;
use crate::command::face::explain::{Occurrence, Recorded};
use crate::command::frame::dry_run::{Known as _, Reason, unknown};
use crate::command::frame::orders::{Done, New, Old};
use crate::command::frame::watch::{Watch, Watchable, Watched};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::yrcx::signal::output;
use crate::controller::yrcx::table::Command as Row;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::View;
use crate::settings::alarms;

commands! {
    /// Alarms.
    pub enum Alarm {
        /// Show the present alarm with what to do
        List(List),
        /// Alarm history, the latest first
        History(History),
        /// Print alarms as they come and go
        Watch(Watch<List>),
        /// Reset the alarm
        Reset(Reset),
    }
}

/// The alarm that is present: the latest of the history while SO(03) or SO(15) is on.
#[derive(Debug, Args)]
#[command(after_help = "`yrcx info alarm` tells the latest alarm of a remote command, which may be none any more.")]
pub struct List {}

impl Command for List {
    type Family = Yrcx;
    type Report = ActiveAlarms;
    const ID: &'static str = "yrcx.alarm.list";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<ActiveAlarms, Failure> {
        let link = context.link;
        let latest = link.draft(Row::AlarmHistory)?.with(Key::History, 1).build()?;
        if link.is_dry() {
            link.plan_depending(
                &latest,
                &latest,
                Reason::about("which").depending_on("the signals: it is asked if SO(03) or SO(15) is on"),
            );
        }
        let image = link.look().await?;
        let (alarm, warning) = (output::ALARM.is_on(&image), output::WARNING.is_on(&image));
        let mut alarms = Vec::new();
        if alarm || warning {
            alarms.push(AlarmReport::of(&link.ask(&latest).await?.values));
            alarms.retain(|alarm| alarm.code.is_some());
            for alarm in &mut alarms {
                let code = alarm.code.as_deref().unwrap_or_default();
                alarm.explained = alarms::find(context.robot, code)?;
            }
        }
        Ok(ActiveAlarms { alarm, warning, alarms })
    }
}

impl Watchable for List {
    const WATCH: &'static str = "yrcx.alarm.watch";
    const WATCHED: Watched =
        Watched { list: "alarms", name: "code", prefix: "alarm ", label: "meaning", value: None, empty: "no alarm" };
}

/// The alarm that is present.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ActiveAlarms {
    /// SO(03): there is an alarm.
    alarm: bool,
    /// SO(15): there is a warning.
    warning: bool,
    /// The latest; none where both signals are off.
    alarms: Vec<AlarmReport>,
}

impl Report for ActiveAlarms {
    fn view(&self) -> View {
        match (self.alarms.first(), self.alarm, self.warning) {
            (Some(alarm), ..) => alarm.view(),
            (None, true, _) => View::text("an alarm (SO(03) is on), of which the history tells nothing"),
            (None, false, true) => View::text("a warning (SO(15) is on), of which the history tells nothing"),
            (None, false, false) => View::text("no alarm"),
        }
    }
}

/// Reads alarms of the history, one after the other: what `yrcx info message` reads.
#[derive(Debug, Args)]
#[command(after_help = "`armctl explain yrcx CODE` says what to do about one.")]
pub struct History {
    #[command(flatten)]
    which: Message,
}

impl Command for History {
    type Family = Yrcx;
    type Report = PastAlarms;
    const ID: &'static str = "yrcx.alarm.history";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<PastAlarms, Failure> {
        Ok(PastAlarms { alarms: self.which.read(context).await? })
    }
}

/// Alarms of the history that are there.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PastAlarms {
    alarms: Past,
}

impl Report for PastAlarms {
    fn view(&self) -> View {
        View::table(rows(&self.alarms))
    }

    fn failure(&self) -> Option<Failure> {
        self.alarms.failure()
    }
}

impl Recorded for ActiveAlarms {
    fn recorded(&self) -> Vec<Occurrence> {
        self.alarms.iter().map(|alarm| alarm.occurrence("present".to_owned())).collect()
    }
}

impl Recorded for PastAlarms {
    fn recorded(&self) -> Vec<Occurrence> {
        let known = self.alarms.known();
        known.map(|(which, alarm)| alarm.occurrence(format!("history {}", which.number))).collect()
    }
}

/// Resets the alarm.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx io pulse alarm-reset` does the same by a signal, also where remote commands are not taken."
)]
pub struct Reset {}

impl Command for Reset {
    type Family = Yrcx;
    type Report = WasReset;
    const ID: &'static str = "yrcx.alarm.reset";

    fn risk(&self) -> Risk {
        Row::AlarmReset.row().risk
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WasReset, Failure> {
        let Context { link, screen, .. } = context;
        let order = link.draft(Row::AlarmReset)?.build()?;
        let old = Old::read(link.look().await.known()?.map(|image| output::ALARM.is_on(&image)));
        link.ask(&order).await?;
        let Some(image) = link.look().await.known()? else { return Err(unknown()) };
        let (alarm, servo_on) = (output::ALARM.is_on(&image), output::SERVO_ON.is_on(&image));
        let words = if alarm { "alarm reset accepted; there is still an alarm" } else { "alarm reset" };
        let report = WasReset { done: New::of("alarm", alarm, words).replaces(old), alarm, servo_on };
        if !report.servo_on {
            if link.is_held() {
                screen.note(POWER_OFF);
            } else {
                let alarm = link.link_alarm();
                screen.note(&format!(
                    "hint: motor power is off, and the end of this connection raises alarm {alarm} again: keep one open with \
                     `armctl session open`, then `yrcx alarm reset` and `yrcx recover`"
                ));
            }
        }
        Ok(report)
    }
}

/// What comes next where an alarm has switched the motors off.
const POWER_OFF: &str = "hint: motor power is off: `yrcx recover` clears the emergency stop and switches the servos on";

/// An alarm that was reset.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WasReset {
    #[serde(flatten)]
    done: Done,
    /// SO(03) after it: there is still one.
    alarm: bool,
    /// SO(02): motor power is on.
    servo_on: bool,
}

impl Report for WasReset {
    fn view(&self) -> View {
        self.done.view()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{Reply, Scripted, answer, example, read_example, run_on, words};
    use crate::controller::yrcx::signal::output;

    #[test]
    fn the_history_is_that_of_messages() {
        assert_eq!(words(&["alarm", "history", "10"]).unwrap(), [example("4.7.7-reference")]);
        let past = &read_example("4.7.7-reference", &["alarm", "history", "10"])["alarms"];
        let messages = &read_example("4.7.7-reference", &["info", "message", "10"])["messages"];
        assert_eq!((past, &past[0]["code"]), (messages, &json!("12.551")));
        assert_eq!(words(&["alarm", "history"]).unwrap().len(), 10);
    }

    #[test]
    fn what_is_present_is_the_latest_while_a_signal_says_so() {
        let none = json!({ "alarm": false, "warning": false, "alarms": [] });
        let (data, peer) = run_on(Scripted::new([]), &["alarm", "list"]);
        assert_eq!((data.unwrap(), peer.taken.len()), (none, 0), "nothing is asked");
        let mut shown = Scripted::new([Reply::Ends(1, answer("4.7.7-reference"))]);
        output::ALARM.set(&mut shown.image, true);
        let (data, peer) = run_on(shown, &["alarm", "list"]);
        let data = data.unwrap();
        assert_eq!((&data["alarm"], &data["alarms"][0]["code"]), (&json!(true), &json!("12.551")));
        assert_eq!(peer.taken[0][2], 1, "the latest");
    }

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["alarm", "reset"]).unwrap(), [example("4.8.3-reset")]);
        let read = read_example("4.8.3-reset", &["alarm", "reset"]);
        assert_eq!((&read["alarm"], &read["servo_on"]), (&false.into(), &false.into()));
    }
}

//! Commands `yrcx alarm list|history|watch|reset` (4.7.7, 4.8.3).

use super::info::{Part, entry};
use super::number_arguments::Numbers;
use super::read_requests::ask_each;
use crate::prelude::*;
use armctl_frame::face::shared_commands::CommonReport;
use armctl_frame::failure;
use armctl_frame::items::ItemOutcome;
use armctl_frame::robot::alarm::{AlarmEntry, AlarmState, Alarms, Kind, Nothing, Row};
use armctl_frame::settings::alarms;

commands! {
    /// Commands for alarms.
    pub enum Alarm {
        /// Show the present alarm and what to do
        List(List),
        /// Show the alarm history, latest first
        History(History),
        /// Print alarms when they occur and when they clear
        Watch(Watch<List>),
        /// Reset the alarm
        Reset(Reset),
    }
}

/// Shows the present alarm: the latest entry of the history while SO(03) or SO(15) is on.
#[derive(Debug, Args)]
#[command(
    after_help = "`yrcx info alarm` shows the latest alarm that a remote command caused. That alarm may have been \
                  reset since."
)]
pub struct List {}

impl Command for List {
    type Family = Yrcx;
    type Report = Alarms<Part, Signals>;
    const ID: &'static str = "yrcx.alarm.list";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Alarms<Part, Signals>> {
        let link = context.link;
        let latest = link.draft(table::Command::AlarmHistory)?.with(Key::History, 1).valid_order()?;
        if link.is_dry_run() {
            link.plan_depending(
                &latest,
                &latest,
                Reason::about("which").depending_on("the signals: sent only if SO(03) or SO(15) is on"),
            );
        }
        let image = link.look().await?;
        let (alarm, warning) = (output::ALARM.is_on(&image), output::WARNING.is_on(&image));
        let mut alarms = Vec::new();
        if alarm || warning {
            let kind = if alarm { Kind::Alarm } else { Kind::Warning };
            if let Some(entry) = entry(&link.ask(&latest).await?.values, kind) {
                alarms.push(Row::new(1, "alarm 1", explained(entry, context.robot)));
            }
        }
        Ok(Alarms { alarms, standing: Signals { alarm, warning }, asked: 1 })
    }
}

/// Reads the latest entry of the history; `None` if the history is empty or was not read. An entry has no time, so if
/// an alarm occurs a second time, its entry is equal to the first entry.
pub(super) async fn latest(link: &mut Link) -> Result<Option<AlarmEntry<Part>>> {
    let latest = link.draft(table::Command::AlarmHistory)?.with(Key::History, 1).valid_order()?;
    if link.is_dry_run() {
        link.plan(&latest, "latest alarm, to recognize a new alarm");
        return Ok(None);
    }
    match link.ask(&latest).await {
        Ok(answer) => Ok(entry(&answer.values, Kind::Alarm)),
        Err(failure) if failure.kind == failure::Kind::Refused => Ok(None),
        Err(failure) => Err(failure),
    }
}

/// Adds the text of `alarms.toml`.
fn explained(entry: AlarmEntry<Part>, robot: &Robot) -> Result<AlarmEntry<Part>> {
    let code = entry.alarm.code.clone().unwrap_or_default();
    Ok(AlarmEntry { alarm: entry.alarm.with(alarms::find(robot, &code)?), ..entry })
}

impl Watchable for List {
    type Value = bool;

    const WATCH: &'static str = "yrcx.alarm.watch";
    const WATCHED: Watched =
        Watched { list: "alarms", name: "code", prefix: "alarm ", label: "text", value: None, empty: "no alarm" };
}

/// Alarm signals.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Signals {
    /// Whether SO(03) is on: an alarm is present.
    alarm: bool,
    /// Whether SO(15) is on: a warning is present.
    warning: bool,
}

impl AlarmState for Signals {
    fn none(&self) -> &'static str {
        match (self.alarm, self.warning) {
            (true, _) => "an alarm (SO(03) is on) that is not in the history",
            (false, true) => "a warning (SO(15) is on) that is not in the history",
            (false, false) => "no alarm",
        }
    }
}

/// Reads entries of the alarm history, one request per entry (4.7.7).
#[derive(Debug, Args)]
#[command(after_help = "`armctl explain yrcx CODE` shows what to do about an alarm.")]
pub struct History {
    /// Numbers in the history, from 1 (the latest) to 500, for example 10 or 1..50
    #[arg(value_name = "N", value_delimiter = ',', default_value = "1..10",
        value_parser = |text: &str| Numbers::parse(table::Command::AlarmHistory, Key::History, text))]
    numbers: Vec<Numbers>,
}

impl Command for History {
    type Family = Yrcx;
    type Report = Alarms<Part>;
    const ID: &'static str = "yrcx.alarm.history";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Alarms<Part>> {
        let Context { link, screen, robot, .. } = context;
        let numbers = Numbers::of(&self.numbers);
        let order = |number: &i32| link.draft(table::Command::AlarmHistory)?.with(Key::History, *number).valid_order();
        let orders = numbers.iter().map(order).collect::<Result<Vec<Order>>>()?;
        let answers = ask_each(link, screen, "reading alarms", &orders).await?;
        let mut alarms = Vec::new();
        for (number, answer) in numbers.iter().zip(answers.outcomes) {
            let answer = answer.map(|values| entry(&values, Kind::Alarm));
            let outcome = ItemOutcome::new(format!("alarm {number}"), answer);
            if let (1, Some(error)) = (numbers.len(), outcome.error()) {
                return Err(error.failure());
            }
            let Some(mut outcome) = outcome.with_defaults() else { continue };
            if let Some(entry) = outcome.data_mut() {
                *entry = explained(entry.clone(), robot)?;
            }
            alarms.push(Row { list: None, index: u16::try_from(*number).unwrap_or(u16::MAX), outcome });
        }
        Ok(Alarms { asked: alarms.len(), alarms, standing: Nothing {} })
    }
}

/// Resets the alarm.
#[derive(Debug, Args)]
#[command(after_help = "`yrcx io pulse alarm-reset` resets the alarm with a dedicated input. This also works while \
                        the controller does not accept remote commands.")]
pub struct Reset {}

impl Command for Reset {
    type Family = Yrcx;
    type Report = WasReset;
    const ID: &'static str = "yrcx.alarm.reset";

    fn risk(&self) -> Risk {
        table::Command::AlarmReset.row().risk
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WasReset> {
        let Context { link, screen, .. } = context;
        let order = link.draft(table::Command::AlarmReset)?.valid_order()?;
        let old = Old::read(link.look().await.known()?.map(|image| output::ALARM.is_on(&image)));
        link.ask(&order).await?;
        let Some(image) = link.look().await.known()? else { return Err(unknown()) };
        let (alarm, servo_on) = (output::ALARM.is_on(&image), output::SERVO_ON.is_on(&image));
        let words = if alarm { "alarm reset accepted; an alarm is still present" } else { "alarm reset" };
        let report = WasReset { done: NewValue::of("alarm", alarm, words).replaces(old), alarm, servo_on };
        if !report.servo_on {
            if link.is_held() {
                screen.note(POWER_OFF);
            } else {
                let alarm = link.link_alarm();
                screen.note(&format!(
                    "hint: keep a connection open with `armctl session open`, then use `yrcx alarm reset` and `yrcx \
                     recover`. Motor power is off, and the close of this connection raises alarm {alarm} again"
                ));
            }
        }
        Ok(report)
    }
}

/// Hint for the case that an alarm has switched the motors off.
const POWER_OFF: &str = "hint: use `yrcx recover` to clear the emergency stop and switch the servos on. Motor power \
                         is off";

/// Result of an alarm reset.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WasReset {
    #[serde(flatten)]
    done: SetReport,
    /// Whether SO(03) is on after the reset: an alarm is still present.
    alarm: bool,
    /// Whether SO(02) is on: the motor power is on.
    servo_on: bool,
}

impl CommonReport for WasReset {
    type Core = SetReport;

    fn core(&self) -> SetReport {
        self.done.clone()
    }
}

impl Report for WasReset {
    fn view(&self) -> View {
        self.done.view()
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, answer, example, objection, read_example, run_on, words};
    use armctl_controller::yrcx::signal::output;

    #[test]
    fn the_history_is_asked_for_by_its_numbers() {
        assert_eq!(words(&["alarm", "history", "10"]).unwrap(), [example("4.7.7-reference")]);
        let past = &read_example("4.7.7-reference", &["alarm", "history", "10"])["alarms"];
        assert_eq!((&past[0]["index"], &past[0]["code"]), (&json!(10), &json!("12.551")));
        assert_eq!((&past[0]["place"], &past[0]["part"]), (&json!("controller 1"), &json!("option slot 1")));
        assert_eq!(words(&["alarm", "history"]).unwrap().len(), 10);
        assert!(objection(&["alarm", "history", "0"]).contains("allowed: 1 to 500"));
        let mut end = [0; 16];
        end[0] = 0x0200;
        let (read, _) = run_on(Scripted::new([Reply::AddressPair(1, end)]), &["alarm", "history", "1"]);
        assert_eq!(read.unwrap()["alarms"], json!([]), "an empty one is left out");
    }

    #[test]
    fn latest_alarm_is_active_while_its_signal_is_on() {
        let none = json!({ "alarm": false, "warning": false, "alarms": [] });
        let (data, peer) = run_on(Scripted::new([]), &["alarm", "list"]);
        assert_eq!((data.unwrap(), peer.taken.len()), (none, 0), "nothing is asked");
        let mut shown = Scripted::new([Reply::AddressPair(1, answer("4.7.7-reference"))]);
        output::ALARM.set(&mut shown.image, true);
        let (data, peer) = run_on(shown, &["alarm", "list"]);
        let data = data.unwrap();
        assert_eq!((&data["alarm"], &data["alarms"][0]["code"]), (&json!(true), &json!("12.551")));
        assert_eq!(peer.taken[0][2], 1, "the latest");
    }
}

//! `yerc alarm list|history|reset|cancel`.

mod report;

pub(super) use self::report::in_a_line;
use self::report::{WithTexts, YercAlarmFields, entry, explain, short};
use super::control_commands::usage;
use super::item_requests::{Batch, Outcome, ReadError};
use super::link::Link;
use super::link::Yerc;
use super::number_arguments::parse_in_range;
use crate::item_requests::read_failure;
use crate::prelude::basics::*;
use armctl_controller::yerc::payload;
use armctl_controller::yerc::query::{self, Query, ReadAlarm, ReadAlarmHistory};
use armctl_controller::yerc::wire::Status;
use armctl_frame::items;
use armctl_frame::robot::alarm::{self, Alarms, Row};

commands! {
    /// Alarms.
    pub enum Alarm {
        /// Show the present alarms
        List(List),
        /// Show the alarm history, with the latest entries of each class first
        History(History),
        /// Print alarms when they occur and when they clear
        Watch(Watch<List>),
        /// Reset the alarm
        Reset(Reset),
        /// Cancel the error
        Cancel(Cancel),
    }
}

/// Shows the present alarms, at most four (FS and DX 3.3.1, 3.3.37).
#[derive(Debug, Args)]
pub struct List {
    /// Read the codes and names without texts, with command 0x70. Use this option if the controller does not support
    /// command 0x30A
    #[arg(long)]
    no_texts: bool,
}

/// Maximum number of present alarms.
pub(super) const SLOTS: u8 = 4;

impl Command for List {
    type Family = Yerc;
    type Report = Alarms<YercAlarmFields, WithTexts>;
    const ID: &'static str = "yerc.alarm.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Alarms<YercAlarmFields, WithTexts>> {
        let link = context.link;
        let mut texts = !self.no_texts;
        let question = |slot, texts| ReadAlarm::new(slot, texts).map_err(usage);
        let all = (1..=SLOTS).map(|slot| question(slot, texts)).collect::<Result<Vec<_>, _>>()?;
        plan(link, &all, texts, &question(1, false)?)?;
        let mut alarms = Vec::new();
        let mut batch = Batch::default();
        for slot in 1..=SLOTS {
            // The manual does not say whether there can be gaps between slots, so all four slots are read.
            let outcome = match read(link, &mut batch, &mut texts, |texts| question(slot, texts)).await? {
                Ok(alarm) if alarm.is_none() => continue,
                Ok(alarm) => explain(entry(&alarm, link.encoding, link.model_for_display()), context.robot, link).await,
                Err(denied) => Err(read_failure(denied)),
            };
            alarms.push(Row::new(slot.into(), format!("alarm slot {slot}"), outcome));
        }
        let report = Alarms { alarms, standing: WithTexts { with_texts: texts }, asked: SLOTS.into() };
        items::all_failed(report.asked, report.errors())?;
        Ok(report)
    }
}

impl Watchable for List {
    type Value = bool;

    const WATCH: &'static str = "yerc.alarm.watch";
    const WATCHED: Watched =
        Watched { list: "alarms", name: "code", prefix: "alarm ", label: "text", value: None, empty: "no alarm" };
}

/// Class of past alarms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Class {
    /// Major failures
    Major,
    /// Monitor alarms
    Monitor,
    /// User alarms that the system defines
    System,
    /// User alarms that the user defines
    User,
    /// Off-line alarms
    Offline,
    /// Every class
    All,
}

/// Every class with its JSON name, in the order of the manual.
const CLASSES: [(Class, query::AlarmClass, &str); 5] = [
    (Class::Major, query::AlarmClass::Major, "major"),
    (Class::Monitor, query::AlarmClass::Monitor, "monitor"),
    (Class::System, query::AlarmClass::UserSystem, "system"),
    (Class::User, query::AlarmClass::User, "user"),
    (Class::Offline, query::AlarmClass::OffLine, "offline"),
];

/// Shows past alarms (FS and DX 3.3.2, 3.3.38).
#[derive(Debug, Args)]
pub struct History {
    /// Alarm class
    #[arg(long, value_enum, default_value = "all")]
    class: Class,
    /// Number of the first entry of each class. The latest entry has number 1
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = parse_in_range::<u8>(1, 100))]
    from: u8,
    /// Maximum number of entries of each class
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = parse_in_range::<u8>(1, 100))]
    limit: u8,
    /// Read the codes and names without texts, with command 0x71. Use this option if the controller does not support
    /// command 0x30B
    #[arg(long)]
    no_texts: bool,
}

/// Last entry of a list.
const HISTORY_SIZE: u8 = 100;

impl Command for History {
    type Family = Yerc;
    type Report = Alarms<YercAlarmFields, WithTexts>;
    const ID: &'static str = "yerc.alarm.history";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Alarms<YercAlarmFields, WithTexts>> {
        let link = context.link;
        let mut texts = !self.no_texts;
        let numbers = self.from..=self.from.saturating_add(self.limit - 1).min(HISTORY_SIZE);
        let classes = CLASSES.iter().filter(|row| self.class == Class::All || self.class == row.0);
        let question = |class, number, texts| ReadAlarmHistory::new(class, number, texts).map_err(usage);
        let all = classes.clone().flat_map(|row| numbers.clone().map(|number| question(row.1, number, texts)));
        let all = all.collect::<Result<Vec<_>, _>>()?;
        let first = classes.clone().next().map_or(query::AlarmClass::Major, |row| row.1);
        plan(link, &all, texts, &question(first, self.from, false)?)?;
        let mut alarms = Vec::new();
        let mut asked = 0;
        let mut batch = Batch::default();
        for &(_, list, class) in classes {
            for number in numbers.clone() {
                asked += 1;
                let outcome = match read(link, &mut batch, &mut texts, |texts| question(list, number, texts)).await? {
                    Ok(alarm) if alarm.is_none() => break,
                    Ok(alarm) => {
                        explain(entry(&alarm, link.encoding, link.model_for_display()), context.robot, link).await
                    }
                    Err(denied) => Err(read_failure(denied)),
                };
                let row = Row::new(number.into(), format!("{class} alarm {number}"), outcome);
                alarms.push(Row { list: Some(class), ..row });
            }
        }
        let report = Alarms { alarms, standing: WithTexts { with_texts: texts }, asked };
        items::all_failed(asked, report.errors())?;
        Ok(report)
    }
}

/// Alarms in the first `slots` slots, for a live view. If the controller has no texts, `texts` is set to false. An
/// alarm that cannot be read does not prevent the report of the others.
pub(super) async fn present(link: &mut Link, texts: &mut bool, slots: u8) -> Result<Vec<alarm::Alarm>> {
    let mut alarms = Vec::new();
    let mut batch = Batch::default();
    for slot in 1..=slots {
        let outcome = read(link, &mut batch, texts, |texts| ReadAlarm::new(slot, texts).map_err(usage)).await?;
        match outcome {
            Ok(alarm) if alarm.is_none() => {}
            Ok(alarm) => alarms.push(short(entry(&alarm, link.encoding, link.model_for_display()))),
            Err(denied) => {
                let failure = read_failure(denied);
                if failure.kind == Kind::NoAnswer {
                    return Err(failure);
                }
                let text = format!("slot {slot}: {}", items::shorten(&failure));
                alarms.push(alarm::Alarm {
                    text: Some(text),
                    kind: Some(alarm::Kind::Alarm),
                    ..alarm::Alarm::default()
                });
            }
        }
    }
    Ok(alarms)
}

/// In a dry run, records the request for the latest alarm.
pub(super) fn plan_latest(link: &mut Link) -> Result<()> {
    let request = ReadAlarm::new(1, true).map_err(usage)?.request();
    link.plan_if(&request, Reason::about("the latest alarm").depending_on("whether an alarm is present"));
    Ok(())
}

/// In a dry run, records all requests, and the first fallback request for an older controller.
fn plan<Q: Query>(link: &mut Link, all: &[Q], texts: bool, older: &Q) -> Result<()> {
    let item_name = link.plan_all(all);
    if texts && link.is_dry_run() {
        let about = "without alarm texts, if the controller has no texts; armctl then sends all later requests \
                     without texts";
        link.plan_if(
            &older.request(),
            Reason::about(about).depending_on("whether the controller refuses the previous request"),
        );
    }
    item_name
}

/// Reads an alarm with its texts. After the controller has shown that it does not support the command, reads alarms
/// without texts.
async fn read<Q: Query<Answer = payload::Alarm>>(
    link: &mut Link,
    batch: &mut Batch,
    texts: &mut bool,
    question: impl Fn(bool) -> Result<Q>,
) -> Result<Outcome<payload::Alarm>> {
    if *texts {
        match link.ask_in_batch(batch, &question(true)?).await? {
            Err(ReadError::Refused(refusal)) if is_possibly_unsupported(refusal.status) => *texts = false,
            outcome => return Ok(outcome),
        }
    }
    link.ask_in_batch(batch, &question(false)?).await
}

/// Whether a status can mean that the controller is older than FS1.14 and does not have 0x30A. The manuals do not
/// define this status, so each of these statuses selects the older command: "command error", "undefined command",
/// undefined instance or attribute.
fn is_possibly_unsupported(status: Status) -> bool {
    matches!(status.code, 0x01 | 0x08 | 0x09 | 0x28)
        || (status.added_size > 0 && matches!(status.added & 0xFFFF, 0x1010 | 0xA000..=0xA002))
}

macro_rules! order {
    ($(#[$doc:meta])* $name:ident, $id:literal, $query:expr, $set:literal = $new:literal, $done:literal) => {
        $(#[$doc])*
        #[derive(Debug, Args)]
        pub struct $name {}

        impl Command for $name {
            type Family = Yerc;
            type Report = SetReport;
            const ID: &'static str = $id;

            fn risk(&self) -> Risk {
                $query.risk()
            }

            async fn run(&self, context: Context<'_, Yerc>) -> Result<SetReport> {
                context.link.ask(&$query).await?;
                Ok(NewValue::of($set, $new, $done).replaces(Old::UNREAD))
            }
        }
    };
}

order! {
    /// Resets the alarm (FS and DX 3.3.19).
    Reset, "yerc.alarm.reset", query::ResetAlarm, "alarm" = "reset",
    "alarm reset accepted; use `yerc alarm list` to see the remaining alarms"
}
order! {
    /// Cancels the error (FS and DX 3.3.19).
    Cancel, "yerc.alarm.cancel", query::CancelError, "error" = "cancelled", "error cancelled"
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::testing::{error_text, frames, golden, reports};

    #[test]
    fn reads_present_alarms_with_texts_in_four_slots() {
        assert_eq!(
            frames("alarm list").unwrap(),
            ["0a03010000010000", "0a03020000010000", "0a03030000010000", "0a03040000010000", "7000010000010000"]
        );
        assert_eq!(frames("alarm list --no-texts").unwrap()[0], golden("R01"));
    }

    #[test]
    fn reads_the_history_of_each_class_from_a_number() {
        // The user-defined user alarm 100 is instance 3100 of command 0x71. Golden frame R05 reads one field of this
        // instance.
        assert_eq!(
            frames("alarm history --class user --from 99 --limit 5 --no-texts").unwrap(),
            ["71001b0c00010000", "71001c0c00010000"]
        );
        let all = frames("alarm history --limit 1").unwrap();
        assert_eq!(
            all,
            [
                "0b03010000010000",
                "0b03e90300010000",
                "0b03d10700010000",
                "0b03b90b00010000",
                "0b03a10f00010000",
                "7100010000010000"
            ]
        );
        assert_eq!(frames("alarm history").unwrap().len(), 51);
        assert!(error_text("alarm history --from 101").contains("1..=100"));
    }

    #[test]
    fn sends_reset_and_cancel_frames_of_the_manual() {
        assert_eq!(frames("alarm reset").unwrap(), ["820001000110000001000000"]);
        assert_eq!(frames("alarm cancel").unwrap(), [golden("R39")]);
    }

    #[test]
    fn falls_back_to_the_older_command_if_unsupported() {
        for code in [0x01, 0x08, 0x09, 0x28] {
            assert!(is_possibly_unsupported(Status { code, added_size: 0, added: 0 }), "{code:#x}");
        }
        for added in [0x1010, 0xA000, 0xA001, 0xA002] {
            assert!(is_possibly_unsupported(Status::refused(added)), "{added:#x}");
        }
        for status in [Status::refused(0x2010), Status::refused(0x2100), Status { code: 0x1F, ..Status::OK }] {
            assert!(!is_possibly_unsupported(status), "{status:?}");
        }
    }

    #[tokio::test(start_paused = true)]
    async fn reads_older_software_without_texts() {
        let alarm = "alarm = [{ code = 4315, data = 3, type = 1 }]\n";
        let lines = ["alarm list", "alarm list --no-texts", "alarm history --limit 2"];
        let [with, without, history] = reports(alarm, &lines).await.try_into().unwrap();
        let (with, without, history) = (with.unwrap(), without.unwrap(), history.unwrap());
        assert_eq!((&with["with_texts"], &with["alarms"][0]["board"]), (&json!(true), &json!("[SV#1]")));
        assert_eq!(without["alarms"][0]["board"], json!(null));
        let per_class =
            |class| history["alarms"].as_array().unwrap().iter().filter(|alarm| alarm["list"] == class).count();
        assert!(per_class("monitor") == 2 && per_class("major") == 1, "at most two, and no empty ones: {history}");

        let older = format!("model = \"fs100\"\nsoftware = \"FS1.03.00A(JP/US)-00\"\n{alarm}");
        let [old] = reports(&older, &["alarm list"]).await.try_into().unwrap();
        let old = old.unwrap();
        assert_eq!((&old["with_texts"], &old["alarms"][0]["code"]), (&json!(false), &json!("4315")));
    }

    #[tokio::test(start_paused = true)]
    async fn reset_clears_the_list() {
        let lines = ["alarm reset", "alarm list", "alarm cancel"];
        let [_, list, cancel] = reports("alarm = [{ code = 4315 }]", &lines).await.try_into().unwrap();
        assert_eq!(list.unwrap()["alarms"], json!([]));
        assert!(cancel.is_ok());
    }
}

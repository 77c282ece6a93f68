//! `yrcx info alarm` (4.7.7, 4.7.17).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::face::explain::Occurrence;
use crate::command::yrcx::single::{one_row, shown};
use crate::controller::yrcx::alarm;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::{Key, Values};
use crate::output::view::{Cell, Section, View};
use crate::settings::alarms::Explanation;

one_row! {
    /// Reads an alarm.
    Alarm(self) "yrcx.info.alarm" -> AlarmReport {
        /// Number in the history, 1 to 500; without it, the latest alarm of a remote command
        #[arg(long, value_name = "N")]
        history: Option<String>,
    }
    gives if self.history.is_some() { Command::AlarmHistory } else { Command::LatestAlarm },
    with draft => draft.with_some(Key::History, self.history.clone()),
    done as answer => AlarmReport::of(&answer.values);
}

/// An alarm and where it came up.
#[derive(Debug, Serialize, JsonSchema)]
pub struct AlarmReport {
    /// Group and category, as in `12.600`; null if there is none.
    pub code: Option<String>,
    /// What is known about it.
    pub meaning: Option<&'static str>,
    /// What to do, as far as known.
    pub remedies: &'static [&'static str],
    /// Robot, controller or task.
    pub place: Option<String>,
    /// Axis, motor, option slot or program task.
    pub part: Option<String>,
    /// What `alarms.toml` says of it; null where it says nothing, and where it was not asked.
    pub explained: Option<Explanation>,
}

impl AlarmReport {
    /// Of the values of an answer.
    pub fn of(values: &Values) -> Self {
        let number = |key| values.int(key).and_then(|number| u16::try_from(number).ok()).unwrap_or_default();
        let found = alarm::Alarm::new(number(Key::AlarmGroup), number(Key::AlarmCategory));
        if found == alarm::Alarm::new(0, 0) {
            return Self { code: None, meaning: None, remedies: &[], place: None, part: None, explained: None };
        }
        let place = |kind, count| {
            let kind = shown(Command::LatestAlarm, values, kind)?;
            match values.int(count) {
                // No number: all of them, or a task that has none.
                Some(0) | None => Some(kind),
                Some(number) => Some(format!("{kind} {number}")),
            }
        };
        Self {
            code: Some(found.to_string()),
            meaning: Some(found.text()),
            remedies: found.known().map_or(&[], |known| known.remedies),
            place: place(Key::Place1, Key::Place1Number),
            part: place(Key::Place2, Key::Place2Number),
            explained: None,
        }
    }
}

impl AlarmReport {
    /// The same as one of a list.
    pub fn occurrence(&self, place: String) -> Occurrence {
        // The words are this program's, not the controller's.
        let parts = [&self.place, &self.part].into_iter().flatten().map(String::as_str).collect::<Vec<_>>();
        let data = Some(parts.join(", ")).filter(|data| !data.is_empty());
        Occurrence { place, code: self.code.clone().unwrap_or_default(), text: None, data, time: None }
    }
}

impl Report for AlarmReport {
    fn view(&self) -> View {
        let Some(code) = &self.code else { return View::text("no alarm") };
        let mut fields = vec![
            ("alarm", code.as_str().into()),
            ("meaning", Cell::maybe(self.meaning)),
            ("place", Cell::maybe(self.place.as_deref())),
            ("part", Cell::maybe(self.part.as_deref())),
            ("what to do", if self.remedies.is_empty() { "-".into() } else { self.remedies.join("; ").into() }),
        ];
        fields.extend(Explanation::field(self.explained.as_ref()));
        View::default().and(Section::Fields(fields))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};
    use crate::failure::Kind;

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(words(&["info", "alarm", "--history", "10"]).unwrap(), [example("4.7.7-reference")]);
        assert_eq!(words(&["info", "alarm"]).unwrap(), [example("4.7.17-reference")]);
        let old = read_example("4.7.7-reference", &["info", "alarm", "--history", "10"]);
        assert_eq!((&old["code"], &old["part"]), (&json!("12.551"), &json!("option slot 1")));
        let latest = read_example("4.7.17-reference", &["info", "alarm"]);
        assert_eq!((&latest["code"], &latest["place"]), (&json!("2.334"), &json!("robot 1")));
        assert_eq!(words(&["info", "alarm", "--history", "501"]).unwrap_err().kind, Kind::Usage);
    }
}

//! The alarms of a controller as `explain` shows them.

use super::{ActiveAlarms, AlarmEntry, PastAlarm, PastAlarms};
use crate::command::face::explain::{Occurrence, Recorded};

impl AlarmEntry {
    fn occurrence(&self, place: String) -> Occurrence {
        let data = [self.sub_code.describe(), self.board.as_deref()];
        let data: Vec<&str> = data.into_iter().flatten().map(str::trim).filter(|part| !part.is_empty()).collect();
        Occurrence {
            place,
            code: self.code.to_string(),
            text: Some(self.name.clone()),
            data: Some(data.join(" ")).filter(|data| !data.is_empty()),
            time: Some(self.time.clone()),
        }
    }
}

impl Recorded for ActiveAlarms {
    fn recorded(&self) -> Vec<Occurrence> {
        let known = self.alarms.iter().filter_map(|alarm| alarm.outcome.data());
        known.map(|alarm| alarm.occurrence("present".to_owned())).collect()
    }
}

impl Recorded for PastAlarms {
    fn recorded(&self) -> Vec<Occurrence> {
        let of =
            |alarm: &PastAlarm| Some(alarm.outcome.data()?.occurrence(format!("{} {}", alarm.class, alarm.number)));
        self.alarms.iter().filter_map(of).collect()
    }
}

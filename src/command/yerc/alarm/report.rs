//! What the reports of alarms hold, and how it is shown.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::face::sample;
use crate::command::frame::items;
use crate::command::frame::items::{ItemError, ItemOutcome};
use crate::command::yerc::link::Link;
use crate::controller::text::Encoding;
use crate::controller::yerc::Model;
use crate::controller::yerc::payload;
use crate::failure::Failure;
use crate::output::view::{Cell, Section, Table, Tone, View};
use crate::settings::Robot;
use crate::settings::alarms::{Explanation, Origin};
use crate::settings::target::Family;

/// The alarms that are present, the latest first.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ActiveAlarms {
    pub(super) alarms: Vec<ActiveAlarm>,
    /// Whether sub-code texts were asked for and the controller has them.
    pub(super) with_texts: bool,
    #[serde(skip)]
    pub(super) asked: usize,
}

/// The alarms of the past.
#[derive(Debug, Serialize, JsonSchema)]
pub struct PastAlarms {
    pub(super) alarms: Vec<PastAlarm>,
    /// Whether sub-code texts were asked for and the controller has them.
    pub(super) with_texts: bool,
    #[serde(skip)]
    pub(super) asked: usize,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct ActiveAlarm {
    /// 1 is the latest.
    pub(super) slot: u8,
    #[serde(flatten)]
    pub(super) outcome: ItemOutcome<AlarmEntry>,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct PastAlarm {
    /// `major`, `monitor`, `system`, `user` or `offline`.
    pub(super) class: &'static str,
    /// 1 is the latest of its class.
    pub(super) number: u8,
    #[serde(flatten)]
    pub(super) outcome: ItemOutcome<AlarmEntry>,
}

/// An alarm in words.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct AlarmEntry {
    /// 1 to 9999.
    pub(super) code: u32,
    pub(super) name: String,
    /// As the controller shows it, `YYYY/MM/DD HH:MM`.
    pub(super) time: String,
    /// How to read the sub-code.
    #[serde(rename = "type")]
    kind: u32,
    /// The type in words.
    type_name: &'static str,
    pub(super) sub_code: SubCode,
    /// Where it comes from, such as `[SV#1]`; null without texts.
    pub(super) board: Option<String>,
    /// What `alarms.toml` says of it; null where it says nothing.
    explained: Option<Explanation>,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct SubCode {
    /// As received, 0 where there is none.
    raw: u32,
    /// In the form of the pendant; bytes in hexadecimal if `trust` is `raw`; empty where there is none.
    rendered: String,
    /// How far to trust `rendered`: `printed` in the manuals, `inferred`, or `raw`.
    trust: &'static str,
    /// What the pendant shows, by the controller itself; null without texts.
    text: Option<String>,
    /// A 1 for each character of the text that the pendant shows reversed; null without texts.
    reversed: Option<String>,
    /// `rendered` with the raw value wherever it is not certain.
    #[serde(skip)]
    shown: String,
}

impl SubCode {
    /// What the pendant shows, or the best that is known of it; nothing where there is none.
    pub(super) fn describe(&self) -> Option<&str> {
        let text = self.text.as_deref().filter(|text| !text.trim().is_empty());
        Some(text.unwrap_or(&self.shown)).filter(|told| !told.is_empty())
    }
}

impl AlarmEntry {
    pub(super) fn new(alarm: &payload::Alarm, encoding: Encoding, model: Model) -> Self {
        let rendered = alarm.sub_code(model);
        let texts = alarm.texts.as_ref();
        Self {
            code: alarm.code,
            name: encoding.decode(alarm.name.as_bytes()),
            time: encoding.decode(alarm.time.as_bytes()),
            kind: alarm.kind.0,
            type_name: rendered.type_name,
            sub_code: SubCode {
                raw: alarm.data,
                trust: rendered.trust.name(),
                text: texts.map(|texts| encoding.decode(texts.sub_code.as_bytes())),
                reversed: texts.map(|texts| encoding.decode(texts.reversed.as_bytes())),
                shown: rendered.to_string(),
                rendered: rendered.text,
            },
            board: texts.map(|texts| encoding.decode(texts.source.as_bytes())),
            explained: None,
        }
    }

    /// With what `alarms.toml` says of it.
    pub(super) async fn explained(mut self, robot: &Robot, link: &mut Link) -> Result<Self, Failure> {
        let code = self.code.to_string();
        let find = |model| {
            robot.alarms.find(Origin { family: Family::Yerc, robot: Some(&robot.name), model: Some(model) }, &code)
        };
        let model = link.model_for(find).await?;
        self.explained = find(model)?;
        Ok(self)
    }

    /// The same as a line below a table.
    fn explanation(&self) -> Option<String> {
        Some(format!("{}: {}", self.code, self.explained.as_ref()?.line()))
    }

    pub(super) fn sample(&self) -> sample::Alarm {
        let sub_code = self.sub_code.describe().unwrap_or_default();
        let text = [self.name.as_str(), sub_code].join(" ").trim_end().to_owned();
        sample::Alarm { code: self.code.to_string(), text, remedy: String::new() }
    }

    /// Code, name, sub-code, time, board. The type is in JSON alone: here it would leave no room for the name.
    fn cells(&self) -> [Cell; 5] {
        let given = |text: &str| (!text.is_empty()).then(|| Cell::from(text));
        [
            Cell::from(self.code).tone(Tone::Bad),
            self.name.as_str().into(),
            Cell::maybe(self.sub_code.describe().map(Cell::from)),
            Cell::from(self.time.as_str()).whole(),
            Cell::maybe(self.board.as_deref().and_then(given)),
        ]
    }
}

/// One line for messages: `alarm 4315 COLLISION DETECT [3]`.
pub(in crate::command::yerc) fn in_a_line(alarm: &payload::Alarm, encoding: Encoding, model: Model) -> String {
    let sub_code = alarm.sub_code(model).to_string();
    let words = [format!("alarm {}", alarm.code), encoding.decode(alarm.name.as_bytes()), sub_code];
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// The cells of an alarm, or of the reason why it is not there.
fn cells(outcome: &ItemOutcome<AlarmEntry>) -> [Cell; 5] {
    let blank = || Cell::maybe(None::<Cell>);
    match (outcome.data(), outcome.error()) {
        (Some(alarm), _) => alarm.cells(),
        (None, error) => [blank(), error.map_or_else(blank, ItemError::cell), blank(), blank(), blank()],
    }
}

impl ActiveAlarms {
    pub(super) fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.alarms.iter().filter_map(|alarm| alarm.outcome.error())
    }
}

impl PastAlarms {
    pub(super) fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.alarms.iter().filter_map(|alarm| alarm.outcome.error())
    }
}

impl Report for ActiveAlarms {
    fn view(&self) -> View {
        let mut table = Table::new(&["slot", "code", "name", "sub-code", "time", "board"], "no alarm");
        for ActiveAlarm { slot, outcome } in &self.alarms {
            let [code, name, sub_code, time, board] = cells(outcome);
            table.row([(*slot).into(), code, name, sub_code, time, board]);
        }
        let told = self.alarms.iter().filter_map(|alarm| alarm.outcome.data()?.explanation());
        let told: Vec<Cell> = told.map(Cell::from).collect();
        let view = View::table(table);
        if told.is_empty() { view } else { view.and(Section::Lines(told)) }
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.asked, self.errors())
    }
}

impl Report for PastAlarms {
    fn view(&self) -> View {
        let columns = ["class", "#", "code", "name", "sub-code", "time", "board"];
        let mut table = Table::new(&columns, "no alarm");
        for PastAlarm { class, number, outcome } in &self.alarms {
            let [code, name, sub_code, time, board] = cells(outcome);
            table.row([(*class).into(), (*number).into(), code, name, sub_code, time, board]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.asked, self.errors())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::yerc::payload::{AlarmKind, AlarmTexts, Text};
    use crate::output::render;

    fn entry(kind: u32, data: u32, texts: Option<AlarmTexts>) -> AlarmEntry {
        let alarm = payload::Alarm {
            code: 4315,
            data,
            kind: AlarmKind(kind),
            time: Text::cut(b"2026/01/02 03:04"),
            name: Text::cut(b"\x8F\xD5\x93\xCB"),
            texts,
        };
        AlarmEntry::new(&alarm, Encoding::ShiftJis, Model::Dx200)
    }

    #[test]
    fn a_sub_code_shows_how_far_it_can_be_trusted() {
        let alarm = entry(3, 3, None);
        let json = serde_json::to_value(&alarm).unwrap();
        assert_eq!(json["sub_code"]["raw"], 3);
        assert_eq!(json["sub_code"]["rendered"], "[SL]");
        assert_eq!(json["sub_code"]["trust"], "inferred");
        assert_eq!(json["type_name"], "user axes (SLURBT)");
        assert_eq!(json["name"], "衝突");
        assert_eq!(alarm.cells()[2].text, "[SL]? (3 = 0x3)");
    }

    #[test]
    fn the_text_of_the_controller_wins_in_the_table() {
        let texts =
            AlarmTexts { source: Text::cut(b"[SV#1]"), sub_code: Text::cut(b"[R1: S]"), reversed: Text::cut(b"0") };
        let outcome = ItemOutcome::new("alarm slot 1", Ok(entry(20, 1, Some(texts))));
        let alarms = ActiveAlarms { alarms: vec![ActiveAlarm { slot: 1, outcome }], with_texts: true, asked: 4 };
        let csv = render::csv(&alarms.view());
        assert_eq!(
            csv,
            "slot,code,name,sub_code,time,board\n\
             1,4315,衝突,[R1: S],2026/01/02 03:04,[SV#1]\n"
        );
    }

    #[test]
    fn nothing_is_said_as_such() {
        let none = ActiveAlarms { alarms: Vec::new(), with_texts: true, asked: 4 };
        assert_eq!(render::text(&none.view(), 80, false), "no alarm\n");
    }
}

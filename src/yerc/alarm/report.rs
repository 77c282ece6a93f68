//! Alarm reports and their display.

use crate::link::Link;
use crate::prelude::basics::*;
use armctl_controller::yerc::payload;
use armctl_frame::robot::alarm::{Alarm, AlarmEntry, AlarmState, ExtraColumns, Kind};
use armctl_frame::settings::alarms::Origin;

/// Whether the report contains the sub-code texts of the controller.
#[derive(Debug, Serialize, JsonSchema)]
pub struct WithTexts {
    /// Whether sub-code texts were requested, and the controller has such texts.
    pub with_texts: bool,
}

impl AlarmState for WithTexts {}

/// Family-specific fields of an alarm.
#[derive(Debug, Serialize, JsonSchema)]
pub struct YercAlarmFields {
    /// Type of the sub-code.
    #[serde(rename = "type")]
    kind: u32,
    /// Name of the sub-code type.
    type_name: &'static str,
    sub_code: SubCode,
    /// Source of the alarm, for example `[SV#1]`; null without texts.
    board: Option<String>,
}

#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct SubCode {
    /// Sub-code as a raw number; 0 if there is no sub-code.
    raw: u32,
    /// Sub-code as the pendant shows it. If `trust` is `raw`, these are hexadecimal bytes. The text is empty if there
    /// is no sub-code.
    rendered: String,
    /// How reliable `rendered` is: `printed` in the manuals, `inferred`, or `raw`.
    trust: &'static str,
    /// Text that the pendant shows, as the controller reports it; null without texts.
    text: Option<String>,
    /// A 1 for each character that the pendant shows in reverse video; null without texts.
    reversed: Option<String>,
    /// Text of `rendered`, with the raw value if the text is uncertain.
    #[serde(skip)]
    shown: String,
}

impl SubCode {
    /// Text on the pendant, or otherwise the best known form; `None` if there is no sub-code.
    pub(super) fn describe(&self) -> Option<&str> {
        let text = self.text.as_deref().filter(|text| !text.trim().is_empty());
        Some(text.unwrap_or(&self.shown)).filter(|rendered_text| !rendered_text.is_empty())
    }
}

/// Alarm for a report, from an answer of the controller.
pub(super) fn entry(alarm: &payload::Alarm, encoding: Encoding, model: Model) -> AlarmEntry<YercAlarmFields> {
    let rendered = alarm.sub_code(model);
    let texts = alarm.texts.as_ref();
    let own = YercAlarmFields {
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
    };
    let alarm = Alarm {
        code: Some(alarm.code.to_string()),
        text: Some(encoding.decode(alarm.name.as_bytes())),
        kind: Some(Kind::Alarm),
        time: Some(encoding.decode(alarm.time.as_bytes())),
        ..Alarm::default()
    };
    AlarmEntry { alarm, own }
}

/// Adds the user's texts from `alarms.toml` to alarms.
pub(super) async fn explain(
    entry: AlarmEntry<YercAlarmFields>,
    robot: &Robot,
    link: &mut Link,
) -> Result<AlarmEntry<YercAlarmFields>> {
    let code = entry.alarm.code.clone().unwrap_or_default();
    let find =
        |model| robot.alarms.find(Origin { family: Family::Yerc, robot: Some(&robot.name), model: Some(model) }, &code);
    let model = link.model_for(find).await?;
    Ok(AlarmEntry { alarm: entry.alarm.with(find(model)?), ..entry })
}

/// Short form for one line. The sub-code is a part of the text.
pub(super) fn short(AlarmEntry { alarm, own }: AlarmEntry<YercAlarmFields>) -> Alarm {
    let parts = [alarm.text.as_deref(), own.sub_code.describe()].into_iter().flatten();
    let text = parts.collect::<Vec<_>>().join(" ");
    Alarm { text: Some(text), ..alarm }
}

impl ExtraColumns for YercAlarmFields {
    // The type has no column, because the column would leave no space for the text. It is only in JSON.
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        let board = self.board.as_deref().map(str::trim).filter(|board| !board.is_empty());
        vec![("sub-code", self.sub_code.describe().map(ToOwned::to_owned)), ("board", board.map(ToOwned::to_owned))]
    }
}

/// Alarm in one line for messages, for example `alarm 4315 COLLISION DETECT [3]`.
pub(crate) fn in_a_line(alarm: &payload::Alarm, encoding: Encoding, model: Model) -> String {
    let sub_code = alarm.sub_code(model).to_string();
    let words = [format!("alarm {}", alarm.code), encoding.decode(alarm.name.as_bytes()), sub_code];
    words.into_iter().filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yerc::payload::{AlarmKind, AlarmTexts, Text};
    use armctl_frame::Report as _;
    use armctl_frame::output::render;
    use armctl_frame::robot::alarm::{Alarms, Row};

    fn collision(kind: u32, data: u32, texts: Option<AlarmTexts>) -> AlarmEntry<YercAlarmFields> {
        let alarm = payload::Alarm {
            code: 4315,
            data,
            kind: AlarmKind(kind),
            time: Text::cut(b"2026/01/02 03:04"),
            name: Text::cut(b"\x8F\xD5\x93\xCB"),
            texts,
        };
        entry(&alarm, Encoding::ShiftJis, Model::Dx200)
    }

    fn of(alarms: Vec<Row<YercAlarmFields>>) -> Alarms<YercAlarmFields, WithTexts> {
        Alarms { alarms, standing: WithTexts { with_texts: true }, asked: 4 }
    }

    #[test]
    fn shows_the_reliability_of_a_sub_code() {
        let alarm = collision(3, 3, None);
        let json = serde_json::to_value(&alarm).unwrap();
        assert_eq!(json["sub_code"]["raw"], 3);
        assert_eq!(json["sub_code"]["rendered"], "[SL]");
        assert_eq!(json["sub_code"]["trust"], "inferred");
        assert_eq!(json["type_name"], "user axes (SLURBT)");
        assert_eq!(json["text"], "衝突");
        assert_eq!(alarm.own.cells()[0].1.as_deref(), Some("[SL]? (3 = 0x3)"));
    }

    #[test]
    fn table_prefers_the_text_of_the_controller() {
        let texts =
            AlarmTexts { source: Text::cut(b"[SV#1]"), sub_code: Text::cut(b"[R1: S]"), reversed: Text::cut(b"0") };
        let alarms = of(vec![Row::new(1, "alarm slot 1", Ok(collision(20, 1, Some(texts))))]);
        let shown = render::text(&alarms.view(), 80, false);
        assert!(shown.contains("4315: 衝突") && shown.contains("[R1: S]") && shown.contains("[SV#1]"), "{shown}");
    }

    #[test]
    fn describes_an_empty_list() {
        assert_eq!(render::text(&of(Vec::new()).view(), 80, false), "no alarm\n");
    }
}

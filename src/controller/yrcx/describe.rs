//! Decoder of command and answer words into described fields. It uses the table and never fails: problems are listed
//! separately.

use schemars::JsonSchema;
use serde::{Serialize, Serializer};

use super::alarm::Alarm;
use super::answer::{Status, is_stopped_jog};
use super::codec::{self, Layout, Side};
use super::image::Words;
use super::order::Order;
use super::table::{Field, Form, ROWS, Row};
use super::value::{Key, Value, Values};

/// Decoded words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Description {
    /// One-line summary.
    pub title: String,
    /// Section of the manual in chapter 2; `None` for an unknown command.
    pub section: Option<&'static str>,
    /// Fields in their order. Unused words that are 0 are omitted.
    pub fields: Vec<FieldNote>,
    /// Problems of the words.
    pub problems: Vec<String>,
}

/// A field of words.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
#[schemars(rename = "FieldRow")]
pub struct FieldNote {
    /// Word and bits, for example `WI1 bits 2-1`; `-` for a part that is not in the words.
    pub place: String,
    /// Name of the field for programs; `None` for the code, the status and unused fields.
    #[serde(serialize_with = "key_name")]
    #[schemars(with = "Option<String>")]
    pub key: Option<Key>,
    /// Readable name of the field.
    pub name: String,
    /// Value in the words.
    pub raw: String,
    /// Meaning of the value.
    pub meaning: String,
}

impl FieldNote {
    /// Describes a part of a message that is not a field of a command.
    pub fn of_message(place: &str, name: &str, raw: String, meaning: &str) -> Self {
        Self { place: place.to_owned(), key: None, name: name.to_owned(), raw, meaning: meaning.to_owned() }
    }
}

#[expect(clippy::ref_option, reason = "serde passes it in this form")]
fn key_name<S: Serializer>(key: &Option<Key>, serializer: S) -> Result<S::Ok, S::Error> {
    key.map(Key::name).serialize(serializer)
}

/// Decodes WI0 to WI15.
pub fn command(words: &Words) -> Description {
    let mut notes = Notes { side: Side::Command, words, fields: Vec::new(), problems: Vec::new() };
    let Some(row) = Row::from_word(words[0]) else {
        notes.push(0, 0x0FFF, "command code", "unknown".to_owned());
        notes.rest(|_| 0);
        notes.problems.push(format!("{:#06X} is not a remote command code; known: {}", words[0], ROWS.len()));
        return notes.description("unknown command".to_owned(), None);
    };
    let code = if row.has_robot() { 0x0FFF } else { u16::MAX };
    notes.push(0, code, "command code", format!("{}: {}", row.id, row.name));
    notes.layout(row.request(), None);
    for (field, value) in codec::read(row.request(), words, None) {
        if let Err(problem) = field.accept(&value) {
            notes.problems.push(format!("WI{} {}: {problem}", field.word, field.key));
        }
    }
    if let (true, Err(error)) = (notes.problems.is_empty(), Order::parse(words)) {
        notes.problems.push(error.to_string());
    }
    notes.description(format!("{} {}", row.code_text(), row.name), Some(row.section))
}

/// Decodes WO0 to WO15. `request` contains the words of the command, if they are known.
pub fn answer(words: &Words, request: Option<&Words>) -> Description {
    let mut notes = Notes { side: Side::Answer, words, fields: Vec::new(), problems: Vec::new() };
    let status = Status::from_word(words[0]);
    notes.push(0, u16::MAX, "status", status.to_string());
    if let Status::Other(_) = status {
        notes.problems.push(format!("WO0: {status}"));
    }
    let known = request.and_then(|request| Some((Row::from_word(request[0])?, values_of(request)?)));
    let alarm = Alarm::new(words[1], words[2]);
    if status == Status::AbnormalEnd {
        notes.push(1, u16::MAX, "alarm group", alarm.group_text().unwrap_or("unknown").to_owned());
        notes.push(2, u16::MAX, "alarm category", format!("{alarm}: {}", alarm.text()));
    }
    let title = known.as_ref().map_or_else(|| status.to_string(), |(row, _)| format!("{status} of {}", row.name));
    match &known {
        Some((row, values)) => {
            let order = request.and_then(|request| Order::parse(request).ok());
            let stopped = order.as_ref().is_some_and(|order| is_stopped_jog(order, alarm));
            let running = order.as_ref().is_some_and(Order::is_continuous);
            match status {
                Status::NormalEnd => notes.layout(row.answer(), Some(values)),
                Status::AbnormalEnd if stopped => notes.layout(row.answer(), Some(values)),
                Status::Running if running => notes.layout(row.answer(), Some(values)),
                _ => notes.rest(|_| 0),
            }
        }
        None => notes.rest(|_| 0),
    }
    notes.description(title, known.map(|(row, _)| row.section))
}

/// One-line summary of a command, for traces.
pub fn command_summary(words: &Words) -> String {
    match Row::from_word(words[0]) {
        Some(row) => {
            let fields = codec::read(row.request(), words, None).filter(|(_, value)| *value != Value::Int(0));
            let shown = fields.map(|(field, value)| format!(" {}={}", field.key, field.show(&value)));
            format!("{}{}", row.id, shown.collect::<String>())
        }
        None => format!("unknown command {:#06X}", words[0]),
    }
}

/// One-line summary of an answer, for traces.
pub fn answer_summary(words: &Words) -> String {
    match Status::from_word(words[0]) {
        Status::AbnormalEnd => {
            let alarm = Alarm::new(words[1], words[2]);
            format!("abnormal end, {alarm} {}", alarm.text())
        }
        status => status.to_string(),
    }
}

/// Values of a command, which may be invalid. `None` if the command is unknown.
fn values_of(words: &Words) -> Option<Values> {
    let row = Row::from_word(words[0])?;
    Some(codec::read(row.request(), words, None).map(|(field, value)| (field.key, value)).collect())
}

/// Fields and problems that are collected for a description.
struct Notes<'a> {
    side: Side,
    words: &'a Words,
    fields: Vec<FieldNote>,
    problems: Vec<String>,
}

impl Notes<'_> {
    fn push(&mut self, word: usize, mask: u16, name: &str, meaning: String) {
        let raw = hex(self.words[word] & mask);
        let place = format!("{}{word}{}", self.side, bits(mask));
        self.fields.push(FieldNote { place, key: None, name: name.to_owned(), raw, meaning });
    }

    fn layout(&mut self, layout: impl Layout, context: Option<&Values>) {
        for (field, value) in codec::read(layout.clone(), self.words, context) {
            let note = self.note(field, &value);
            self.fields.push(note);
        }
        let strays: Vec<(usize, u16)> = codec::strays(layout, self.words, context).collect();
        self.rest(|word| strays.iter().find(|(at, _)| *at == word).map_or(u16::MAX, |(_, bits)| !bits));
    }

    /// Adds the words 1 to 15 that have set bits outside of the fields.
    fn rest(&mut self, accounted: impl Fn(usize) -> u16) {
        let alarm_words =
            if self.side == Side::Answer && Status::from_word(self.words[0]) == Status::AbnormalEnd { 3 } else { 1 };
        for word in alarm_words..self.words.len() {
            let left = self.words[word] & !accounted(word);
            if left != 0 {
                let place = format!("{}{word}", self.side);
                let meaning = "not a field".to_owned();
                self.fields.push(FieldNote { place, key: None, name: "not used".to_owned(), raw: hex(left), meaning });
            }
        }
    }

    fn note(&self, field: &Field, value: &Value) -> FieldNote {
        let words = &self.words[field.word..field.word + field.size()];
        let (place, raw) = match (field.form, words) {
            (Form::Bits { low, .. }, [word]) => {
                let raw = (word & field.mask()) >> low;
                (format!("{}{}{}", self.side, field.word, bits(field.mask())), hex(raw))
            }
            (_, [word]) => (format!("{}{}", self.side, field.word), hex(*word)),
            _ => {
                let (side, last) = (self.side, field.word + field.size() - 1);
                let raw = words.iter().map(|word| hex(*word)).collect::<Vec<_>>().join(" ");
                (format!("{side}{}-{side}{last}", field.word), raw)
            }
        };
        let meaning = format!("{} {}", field.show(value), field.symbol()).trim_end().to_owned();
        FieldNote { place, key: Some(field.key), name: field.name.to_owned(), raw, meaning }
    }

    fn description(mut self, title: String, section: Option<&'static str>) -> Description {
        let at = |note: &FieldNote| {
            let digits: String = note.place[2..].chars().take_while(char::is_ascii_digit).collect();
            digits.parse::<usize>().unwrap_or_default()
        };
        self.fields.sort_by_key(at);
        Description { title, section, fields: self.fields, problems: self.problems }
    }
}

/// Bits of a mask in the notation of the manual; empty if the mask is a whole word.
fn bits(mask: u16) -> String {
    match (mask.trailing_zeros(), mask.checked_ilog2().unwrap_or_default()) {
        (0, 15) => String::new(),
        (low, high) if low == high => format!(" bit {low}"),
        (low, high) => format!(" bits {high}-{low}"),
    }
}

fn hex(word: u16) -> String {
    format!("{word:#06X}").replacen("0X", "0x", 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(description: &Description) -> Vec<String> {
        description
            .fields
            .iter()
            .map(|note| format!("{}: {} {} = {}", note.place, note.name, note.raw, note.meaning))
            .collect()
    }

    fn words(head: &[u16]) -> Words {
        let mut words = [0; 16];
        words[..head.len()].copy_from_slice(head);
        words
    }

    #[test]
    fn a_command_is_explained_field_by_field() {
        // Example of 4.2.1, linear interpolation.
        let linear = command(&words(&[0x0003, 0x8026, 0, 0x00C8, 0x0064, 0, 0, 0, 0, 0, 0x0032]));
        assert_eq!(linear.title, "0xR003 move to a point on a straight line");
        assert_eq!(linear.section, Some("4.2.1"));
        assert_eq!(
            lines(&linear),
            [
                "WI0 bits 11-0: command code 0x0003 = move-linear: move to a point on a straight line",
                "WI0 bits 15-12: robot 0x0000 = none (robot 1)",
                "WI1 bit 0: axes flag 0x0000 = all axes",
                "WI1 bits 2-1: speed flag 0x0003 = mm/s",
                "WI1 bit 5: acceleration flag 0x0001 = given",
                "WI1 bit 6: deceleration flag 0x0000 = not given",
                "WI1 bits 15-14: position output 0x0002 = mm",
                "WI3: speed 0x00C8 = 200 mm/s",
                "WI4: point 0x0064 = 100",
                "WI10: acceleration 0x0032 = 50 %",
            ]
        );
        assert_eq!(linear.problems, Vec::<String>::new());
    }

    #[test]
    fn describes_problems() {
        let problems = |head: &[u16]| command(&words(head)).problems;
        assert_eq!(
            problems(&[0x0001, 0xC004, 0, 0x0032, 0x0013]),
            ["WI1 report: 3 is not defined; use 0 = none, 1 = pulse, 2 = mm"]
        );
        assert_eq!(
            problems(&[0x0001, 0x0004, 0, 101]),
            ["WI3 speed_percent: 101 is out of range; allowed: 1 to 100 %"]
        );
        assert_eq!(problems(&[0x0406, 0x0100]), ["WI1: bits 0x0100 must be 0 here, but are set"]);
        assert_eq!(problems(&[0x0999]), ["0x0999 is not a remote command code; known: 111"]);
    }

    #[test]
    fn answers_are_explained_by_their_command() {
        let request = words(&[0x0020, 0x4000, 0x0081]);
        let stopped = answer(&words(&[0x4000, 0x000C, 0x0190, 0, 0x3039]), Some(&request));
        assert_eq!(stopped.title, "abnormal end of jog an axis");
        assert_eq!(
            lines(&stopped)[..4],
            [
                "WO0: status 0x4000 = abnormal end",
                "WO1: alarm group 0x000C = option board",
                "WO2: alarm category 0x0190 = 12.400: stopped by the stop input",
                "WO4-WO5: axis 1 0x3039 0x0000 = 12345 pulses",
            ]
        );
        let alone = answer(&words(&[0x0200, 0, 7]), None);
        assert_eq!(lines(&alone), ["WO0: status 0x0200 = normal end", "WO2: not used 0x0007 = not a field"]);
        assert_eq!(answer(&words(&[0x0300]), None).problems, ["WO0: undocumented status 0x0300"]);
    }

    #[test]
    fn summaries_fit_a_line() {
        let line = command_summary(&words(&[0x1001, 0x0004, 0, 0x0032, 0x0013]));
        assert_eq!(line, "move-ptp robot=1 speed_mode=% speed_percent=50 point=19");
        assert_eq!(answer_summary(&words(&[0x4000, 2, 334])), "abnormal end, 2.334 over soft limit");
    }
}

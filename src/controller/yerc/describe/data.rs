//! Decoder of the data part, by the fields of its row.

use std::fmt;

use super::{Meaning, Notes, is_backup, little};
use crate::units::{self, Unit};
use crate::yerc::payload::PositionKind;
use crate::yerc::request::Request;
use crate::yerc::table::{Action, Bit, Field, Kind, Row, total};

impl Notes<'_> {
    /// Adds the data of a write request, or of a read answer.
    pub(super) fn payload(&mut self, row: &Row, request: &Request) {
        let Some(service) = row.service(request.service) else { return };
        if let Some(plural) = row.plural {
            self.take(4, "count", |bytes| match little(bytes) {
                count if count == 0 || count > u64::from(plural.max) => {
                    format!("{count}, not allowed: 1 to {}", plural.max)
                }
                count if plural.even && count % 2 == 1 => format!("{count}, not allowed: even counts only"),
                count => count.to_string(),
            });
            let mut number = u32::from(request.instance);
            let asks = service.action == Action::Read && self.is_request();
            while self.left() > 0 && !asks && self.problem.is_none() {
                self.element(row.fields, Some(number));
                number += 1;
            }
            return;
        }
        let fields = row.fields_of(service, request.attribute);
        let fields = row.alternative.filter(|other| total(other) == self.left()).unwrap_or(fields);
        self.element(fields, None);
    }

    fn is_request(&self) -> bool {
        self.frame.get(super::ACK_AT) == Some(&0)
    }

    /// Adds one element, with its number in a plural command. The element may end early after a complete field, because controllers omit missing axes.
    fn element(&mut self, fields: &[Field], number: Option<u32>) {
        let mut known = Meaning::default();
        for field in fields {
            let free = matches!(field.kind, Kind::FileName | Kind::Filter);
            let size = if free { self.left() } else { field.size() };
            if self.left() == 0 && !(free && size == 0) && !self.is_request() {
                return;
            }
            let name = FieldName { number, name: field.name };
            if !self.take(size, name, |bytes| words(field.kind, bytes, &mut known)) {
                return;
            }
        }
    }
}

/// Name of a field, with the number of its element.
struct FieldName {
    number: Option<u32>,
    name: &'static str,
}

impl fmt::Display for FieldName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.number {
            Some(number) => write!(f, "{number} {}", self.name),
            None => f.write_str(self.name),
        }
    }
}

fn words(kind: Kind, bytes: &[u8], known: &mut Meaning) -> String {
    let unsigned = little(bytes);
    let word = u32::try_from(unsigned).unwrap_or_default();
    let signed = word.cast_signed();
    match kind {
        Kind::U8 | Kind::U16 | Kind::U32 => unsigned.to_string(),
        Kind::Signals => format!("{word:08b}, highest signal first"),
        Kind::I16 => u16::try_from(unsigned).unwrap_or_default().cast_signed().to_string(),
        Kind::I32 => signed.to_string(),
        Kind::F32 => f32::from_bits(word).to_string(),
        Kind::Bits(bits) => flags(bits, word),
        Kind::Choice(choices) => {
            // Two fields set the unit of the fields after them. These are the data type of a position and the speed
            // class of a move.
            known.kind = Some(PositionKind::from_word(word));
            known.speed_class = Some(word);
            let meaning = choices.iter().find(|choice| choice.0 == word).map_or("not defined", |choice| choice.1);
            format!("{word}: {meaning}")
        }
        Kind::Scaled(unit) => in_unit(unit, signed),
        Kind::Axis(_) | Kind::BaseAxis if known.kind.is_none() => format!("{signed}, in the unit of the data type"),
        Kind::Axis(axis) => in_unit(known.kind.map_or(units::PULSE, |kind| kind.unit(axis)), signed),
        Kind::BaseAxis if known.kind == Some(PositionKind::Base) => in_unit(units::MILLIMETRE, signed),
        Kind::BaseAxis => in_unit(units::PULSE, signed),
        Kind::Speed => match known.speed_class {
            Some(0) => format!("{} %", units::PERCENT.show_unsigned(word)),
            Some(1) => format!("{} mm/s", units::MILLIMETRE_PER_SECOND.show_unsigned(word)),
            Some(2) => format!("{} deg/s", units::DEGREE_PER_SECOND.show_unsigned(word)),
            _ => word.to_string(),
        },
        Kind::Reserved => "reserved, 0".to_owned(),
        Kind::FileName if is_backup(bytes) => format!("{} (creates or reads the batch backup)", text(bytes)),
        Kind::Text(_) | Kind::FileName | Kind::Filter => text(bytes),
    }
}

fn in_unit(unit: Unit, value: i32) -> String {
    format!("{} {}", unit.show(value), unit.symbol)
}

/// Text up to the first NUL. Bytes other than printable ASCII are escaped.
fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    format!("\"{}\"", bytes[..end].escape_ascii())
}

fn flags(bits: &[Bit], word: u32) -> String {
    let mut words: Vec<String> =
        bits.iter().map(|bit| bit.word(word)).filter(|word| !word.is_empty()).map(str::to_owned).collect();
    let reserved = word & !bits.iter().fold(0, |mask, bit| mask | 1 << bit.bit);
    if reserved != 0 {
        words.push(format!("reserved {reserved:#x}"));
    }
    words.join(", ")
}

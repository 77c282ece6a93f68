//! Single words of positions. For a word of a BP or an EX there is a separate request (3.3.17, 3.3.18, service 0x10).
//! The manuals list no such request for a P: the position is read, changed and written back completely (3.3.16, service
//! 0x02).

use armctl_controller::yerc::payload::{Axes, ExtendedForm, Form, MAX_AXES, Position, PositionKind};
use armctl_controller::yerc::query::{QueryError, WriteField};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::variables::{Reference, Value, VariableKind};

/// A word of a position that can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Word {
    /// Tool number of a P.
    Tool(u32),
    /// User coordinate number of a P.
    User(u32),
    /// Axis (starting with 0), and its value in protocol units.
    Axis(u8, i32),
}

impl Word {
    /// Name of the word as typed.
    pub fn name(self) -> String {
        match self {
            Self::Tool(_) => "tool".to_owned(),
            Self::User(_) => "user".to_owned(),
            Self::Axis(axis, _) => format!("axis{}", axis + 1),
        }
    }

    /// Value to write.
    pub fn value(self) -> i64 {
        match self {
            Self::Tool(value) | Self::User(value) => value.into(),
            Self::Axis(_, value) => value.into(),
        }
    }

    /// Sets the word in a position.
    pub fn set(self, value: &mut Value) {
        match (self, value) {
            (Self::Tool(tool), Value::Position(position)) => position.tool = tool,
            (Self::User(user), Value::Position(position)) => position.user = user,
            (Self::Axis(axis, word), Value::Position(Position { axes, .. })) => set_axis(axes, axis, word),
            (Self::Axis(axis, word), Value::Base(position)) => set_axis(&mut position.axes, axis, word),
            (Self::Axis(axis, word), Value::External(position)) => set_axis(&mut position.axes, axis, word),
            _ => {}
        }
    }

    /// Request that writes only this axis of a BP or an EX; `None` for other words.
    pub fn field(self, variable: Reference) -> Option<Result<WriteField, QueryError>> {
        match self {
            // Attribute 1 is the type, so axis 0 has attribute 2.
            Self::Axis(axis, word) if is_single_word_write(variable) => {
                Some(WriteField::new(variable.kind, variable.number, 2 + axis, word.to_le_bytes()))
            }
            _ => None,
        }
    }

    /// The axis in which two positions of a BP or an EX differ; `None` if several axes differ, or if another word
    /// differs.
    pub fn only_difference(variable: Reference, old: &Value, new: &Value) -> Option<Self> {
        let axes = |value: &Value| match value {
            Value::Base(position) => Some((position.kind, position.axes.padded())),
            Value::External(position) => Some((position.kind, position.axes.padded())),
            _ => None,
        };
        let ((old_kind, old), (new_kind, new)) = (axes(old)?, axes(new)?);
        let mut differing = (0_u8..).zip(old.iter().zip(&new)).filter(|(_, (old, new))| old != new);
        match (differing.next(), differing.next()) {
            (Some((index, (_, new))), None) if old_kind == new_kind && is_single_word_write(variable) => {
                Some(Self::Axis(index, *new))
            }
            _ => None,
        }
    }
}

fn is_single_word_write(variable: Reference) -> bool {
    variable.kind.is_position() && variable.kind != VariableKind::P
}

fn set_axis(axes: &mut Axes, index: u8, value: i32) {
    let mut values: [i32; MAX_AXES] = axes.padded();
    if let Some(word) = values.get_mut(usize::from(index)) {
        *word = value;
    }
    *axes = Axes::full(values);
}

/// Position after a write of one field; `None` if there is no such field.
pub fn with_field(old: &Value, request: &Request) -> Option<Value> {
    let mut bytes = old.emit();
    let at = usize::from(request.attribute).checked_sub(1)? * 4;
    bytes.get_mut(at..at + 4)?.copy_from_slice(request.data.get(..4)?);
    Value::parse(old.kind(), &bytes).ok()
}

/// Two positions that differ in every byte. With them, a dry run can show which part of a position is known.
pub fn different_words() -> [Position; 2] {
    let position = |kind, word: u32, axis| Position {
        kind,
        form: Form(word),
        tool: word,
        user: word,
        extended: ExtendedForm(word),
        axes: Axes::full([axis; MAX_AXES]),
    };
    [position(PositionKind::Pulse, 0, 0), position(PositionKind::Base, u32::MAX, -1)]
}
